//! Attributes: volumes computed from a volume of amplitudes, each on its lattice and with its mask.
//!
//! | attribute | says |
//! |---|---|
//! | [`dip()`] | how many samples deeper the reflections are one line further on |
//! | [`semblance()`] | how alike neighbouring traces are along the reflections: low at faults |
//! | [`envelope()`] | how strong the reflections are, whatever their phase |
//!
//! These work on a volume in memory; [`stored`] does the same to a stored volume of any size.

mod dip;
mod envelope;
mod error;
mod semblance;
pub mod stored;

mod window;

#[cfg(test)]
mod tests;

pub use dip::{DipSettings, DipVolumes, dip};
pub use envelope::envelope;
pub use error::AttributeError;
pub use semblance::{SemblanceSettings, semblance};
