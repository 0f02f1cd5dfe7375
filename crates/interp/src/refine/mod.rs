//! What makes a horizon better after it was picked or imported, and what is drawn of it by hand.
//!
//! | function | does |
//! |---|---|
//! | [`smooth`] | takes the roughness out of the sheets of a horizon |
//! | [`fill_along`] | fills holes along the reflection, where the samples show one, and smoothly elsewhere |
//! | [`nodes_along`], [`snap`], [`lay`] | make nodes of a line drawn by hand, lay them on an extremum, put them into sheets |
//! | [`track`] | grows from one place along the reflection, within a window |
//!
//! Sheets end at faults: smoothing, filling and tracking work on one sheet at a time, and nodes of a line go to the sheet
//! of the block in which they lie, so nothing is carried across a fault. Space: voxels.
//!
//! Deliberately absent: files, projects, candidates; what a hole is (`crate::holes` says it).

mod follow;
mod line;
mod reflection;
mod smoothing;
mod track;

pub use follow::fill_along;
pub use line::{lay, nodes_along, snap};
pub use smoothing::{SmoothSettings, smooth};
pub use track::{TrackSettings, track};
