//! The nouns of a seismic survey and its interpretation.
//!
//! The other crates share these types:
//!
//! - the position of a sample: [`geometry`];
//! - measurements: [`volume`] and what it measures, [`quantity`]; [`well`];
//! - the interpretation: [`horizon`], [`fault`], [`stratigraphy`];
//! - the surfaces on which it is evaluated: [`height_field`], [`mesh`];
//! - the part of the volume that is drawn, and what is cut out of it: [`block`];
//! - horizon candidates extracted from a volume: [`candidates`];
//! - progress and cancellation of long computations: [`progress`];
//! - what a user can state about a file: [`remedy`];
//! - volumes that do not fit into memory: [`source`], [`sparse_volume`].
//!
//! Deliberately absent: formats of files, the store, and any algorithm that combines several of these types.
//!
//! # Spaces
//!
//! | space | axes | unit |
//! |---|---|---|
//! | voxel | x = inline index, y = crossline index, z = sample index, z down | samples, fractional |
//! | line numbers | inline, crossline | survey numbers |
//! | world | X east, Y north, vertical value positive down | m, and ms (TWT) or m (depth) |
//! | metric | world offset from the survey origin, depth | m |
//!
//! Only [`geometry::SurveyGeometry`] converts between them.

pub mod arrays;
pub mod block;
pub mod candidates;
pub mod fault;
pub mod geometry;
pub mod height_field;
pub mod horizon;
mod level_field;
pub mod mesh;
pub mod progress;
pub mod quantity;
pub mod remedy;
pub mod sample;
pub mod source;
pub mod sparse_volume;
pub mod stratigraphy;
pub mod topology;
pub mod volume;
pub mod well;

pub use candidates::{CandidateBox, CandidateInfo, ForestTables};
pub use fault::Fault;
pub use geometry::{LineAxis, SurveyGeometry, VerticalAxis, VerticalUnit};
pub use height_field::HeightField;
pub use horizon::{Horizon, NodeGrid, Quality, Sheet};
pub use level_field::LevelField;
pub use mesh::TriangleMesh;
pub use progress::{Cancelled, Progress};
pub use quantity::Quantity;
pub use remedy::{Note, Remedy, Setting};
pub use sparse_volume::SparseVolume;
pub use stratigraphy::{Contact, LayerOrigin, StratigraphicHorizon, Stratigraphy};
pub use volume::Volume;
pub use well::Well;
