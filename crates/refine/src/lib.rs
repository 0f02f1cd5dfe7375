//! What makes a horizon better after it was picked or imported.
//!
//! | function | does |
//! |---|---|
//! | [`smooth`] | takes the roughness out of the sheets of a horizon |
//! | [`fill_along`] | fills holes along the reflection, where the samples show one, and smoothly elsewhere |
//!
//! Sheets end at faults, and both functions work on one sheet at a time, so neither carries anything across a fault.
//! Space: voxels.
//!
//! Deliberately absent: files, projects, candidates; what a hole is (`interp::holes` says it).

mod follow;
mod smoothing;

pub use follow::fill_along;
pub use smoothing::{SmoothSettings, smooth};
