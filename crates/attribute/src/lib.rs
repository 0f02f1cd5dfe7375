//! Attributes: volumes that are computed from a volume of amplitudes. Each has the lattice and the mask of
//! its source.
//!
//! | attribute | says |
//! |---|---|
//! | [`dip()`] | how many samples deeper the reflections are on the next line |
//! | [`semblance()`] | how similar neighbouring traces are along the reflections: low at faults |
//! | [`fault_likelihood()`] | where a steep plane breaks the reflections, with its strike and dip |
//! | [`slopes()`] | as dips, but smooth past faults |
//! | [`envelope()`] | how strong the reflections are, whatever their phase |
//!
//! These functions work on a volume in memory. [`blocks`] computes the same attributes of a volume of any
//! size, part by part, wherever its parts come from and go to.
//!
//! Deliberately absent: files, the store, what an attribute is used for. No other crate uses the Fourier
//! transform.

pub mod blocks;
mod dip;
mod envelope;
mod error;
pub mod likelihood;
mod semblance;
mod slopes;
mod window;

#[cfg(test)]
mod tests;

pub use dip::{DipSettings, DipVolumes, dip};
pub use envelope::envelope;
pub use error::AttributeError;
pub use likelihood::{Likelihood, fault_likelihood, likelihood};
pub use semblance::{SemblanceSettings, semblance};
pub use slopes::slopes;
