//! Blocks told as events: ten lines of text become a block whose every grain knows where it was laid down.
//!
//! [`History::from_toml`] reads the text (`docs/history.md` has all kinds and keys), [`History::stage`] is the block after
//! some of its events, [`Stage::place`] what is at a place: the unit of rock, (i, j, k) where it was made, and the sides of
//! the faults that came later. Each event is an invertible map in closed form or by a monotone solve in one dimension
//! ([`Deformation`]), a surface above which everything is gone, or rock that fills what was air or takes the place of other
//! rock. Going back through them from the youngest answers every question exactly, at any zoom.
//!
//! # Spaces
//! m east, north and down from the block's south-west corner at depth 0, which is the world's origin too. Directions are
//! degrees clockwise from north.
//!
//! Deliberately absent: files, pictures, projects, and any lattice but that of carved ground.

mod caption;
mod column;
mod context;
mod deformation;
mod error;
mod fields;
mod frame;
mod history;
mod kinds;
mod names;
mod noise;
mod place;
mod rock;
mod seismic;
mod solve;
mod stage;
mod surfaces;

pub use column::Stretch;
pub use context::KnownRocks;
pub use deformation::Deformation;
pub use error::{HistoryError, Problem};
pub use history::{Event, History, Unit};
pub use kinds::{
    Act, Bed, Beds, Body, Dominoes, Dyke, Erosion, Facies, Fault, Fold, IntrusiveSheet, Metamorphism, Salt, Sea,
    SheetKind, Terrain, Tilt, Uplift, Volcano,
};
pub use place::{MOST_ACTS, Place, Rock, Sides};
pub use rock::impedance;
pub use stage::Stage;
pub use surfaces::{FaultBlocks, Interpretation};
