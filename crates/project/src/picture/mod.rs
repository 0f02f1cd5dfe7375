//! Pictures of a project: what a scene needs is loaded in one way ([`load`]) and drawn in one way
//! ([`Painter`]).

mod certainty;
mod horizon_distance;
pub mod load;
mod painter;
pub mod scene;
mod shown_candidates;

pub use certainty::SparseHorizon;
pub use painter::{Device, Painter, write_png};
pub use shown_candidates::ShownCandidates;
