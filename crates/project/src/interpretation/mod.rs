//! The interpretation service: from a volume to horizon candidates, from picks to a horizon, from horizons to
//! proposed faults.
//!
//! Commands, the window and the demonstration make horizons from picks only through [`assembly`].

pub mod assembly;
mod bricks;
pub mod candidates;
pub(crate) mod drawable;
pub mod extraction;
pub(crate) mod finish;
pub(crate) mod order;
pub mod proposals;
pub(crate) mod scattered;
mod sheets;
pub mod solid;
pub mod times;
pub(crate) mod told;

pub use sheets::HorizonSheets;
