//! Horizon candidates: from a raw seismic volume to surfaces, their trees, and the closest leaf of every voxel.
//!
//! The method is that of D. Patel, S. Bruckner, I. Viola and M. E. Gröller, "Seismic volume visualization for
//! horizon extraction", IEEE Pacific Visualization, 2010, sections 4 and 5.3. It is cited as P-horiz below.
//!
//! # How candidates are found
//!
//! 1. [`extrema`] finds peaks, troughs or zero crossings of every trace, refined between samples.
//! 2. [`grow`] connects them to surfaces ([`Surfaces`]).
//! 3. [`Forest`] cuts each surface into a tree of ever flatter parts. Its leaves are the *candidates* that an
//!    interpreter picks from.
//! 4. [`LeafDistances`] computes, for every voxel, the closest leaf and its distance.
//!
//! [`extract`] does 1 to 4 in memory. [`bricks`] does the same brick by brick, in memory that is stated, and gives the
//! same bytes.
//!
//! # Space and units
//! All positions are voxels: x = inline index, y = crossline index, z = sample index, z down. Distances are
//! in voxels.
//!
//! A volume comes from any [`survey::source::SlabSource`] or [`survey::source::BoxSource`], candidates go into any
//! [`survey::candidates::CandidateSink`].
//!
//! Deliberately absent: what becomes of candidates (picks, sheets, faults), the store, projects, pictures.

pub mod bricks;
pub mod distance;
pub mod error;
pub mod extraction;
pub mod extrema;
pub mod forest;
pub mod grow;
pub mod surfaces;

pub use distance::{CandidateColumns, DistanceSettings, LeafDistances};
pub use error::InterpError;
pub use extraction::{ExtractReport, ExtractSettings, Extraction, StageSeconds, extract, extract_into};
pub use extrema::Extrema;
pub use forest::{Forest, ForestSettings, Node, Subtree};
pub use grow::{GrowError, GrowSettings, Method, UnionFind, grow_slabs, grow_surfaces};
pub use surfaces::{Extremum, Surface, Surfaces, Vertex};
