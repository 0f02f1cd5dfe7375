//! Pictures and figures of a project: what a scene needs is loaded in one way ([`load`]) and drawn in one way
//! ([`Painter`]); a figure is a page around such a picture ([`figures`]).
//!
//! | module | holds |
//! |---|---|
//! | [`load`] | what a scene needs, read once for every renderer |
//! | [`scene`] | the scenes of a project, and scenes by default |
//! | [`Motion`] | scenes that follow one another |
//! | [`Painter`] | the renderer that the device allows |
//! | [`figures`] | what a figure needs, loaded, and its page made |
//!
//! Deliberately absent: any change of a project, which is a `crate::Command`.

mod certainty;
pub mod figures;
mod horizon_distance;
mod lattice;
pub mod load;
mod motion;
mod painter;
pub mod scene;
pub(crate) mod shown;
mod shown_candidates;
mod volumes;
mod wells;

pub use certainty::{PickedShare, sparse_sentences};
pub use lattice::sampling_threads;
pub use motion::Motion;
pub use painter::{Device, Painter, write_png};
pub use shown_candidates::{LeafFacts, ShownCandidates};
