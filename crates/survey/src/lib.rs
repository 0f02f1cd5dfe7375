//! Nouns and files of a seismic survey and its interpretation.
//!
//! Everything the other crates share lives here: where a sample is ([`geometry`]), what was measured
//! ([`volume`]), what was interpreted ([`horizon`], [`fault`], [`stratigraphy`]), and the surfaces they are
//! evaluated on ([`height_field`], [`mesh`]).
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

pub mod attribute;
pub mod fault;
pub mod formats;
pub mod geometry;
pub mod height_field;
pub mod horizon;
mod huge_pages;
pub mod mesh;
pub mod model;
pub mod progress;
pub mod remedy;
pub mod section;
pub mod segy;
pub mod store;
pub mod stratigraphy;
pub mod synth;
pub mod volume;
pub mod well;

pub use fault::Fault;
pub use geometry::{LineAxis, SurveyGeometry, VerticalAxis, VerticalUnit};
pub use height_field::HeightField;
pub use horizon::{Horizon, NodeGrid, Quality, Sheet};
pub use mesh::TriangleMesh;
pub use progress::{Cancelled, Progress};
pub use remedy::{Note, Remedy, Setting};
pub use stratigraphy::{Contact, StratigraphicHorizon, Stratigraphy};
pub use volume::Volume;
pub use well::Well;
