//! Attributes: volumes computed from a volume of amplitudes, each on its lattice and with its mask.
//!
//! | attribute | says |
//! |---|---|
//! | [`dip()`] | how many samples deeper the reflections are one line further on |
//! | [`semblance()`] | how alike neighbouring traces are along the reflections: low at faults |
//! | [`envelope()`] | how strong the reflections are, whatever their phase |
//!
//! These work on a volume in memory; [`blocks`] does the same to a volume of any size, part by part, wherever its parts
//! come from and go to.
//!
//! Deliberately absent: files, the store, what an attribute is used for. No other crate knows the Fourier transform.

pub mod blocks;
mod dip;
mod envelope;
mod error;
mod semblance;
mod window;

#[cfg(test)]
mod tests;

pub use dip::{DipSettings, DipVolumes, dip};
pub use envelope::envelope;
pub use error::AttributeError;
pub use semblance::{SemblanceSettings, semblance};
