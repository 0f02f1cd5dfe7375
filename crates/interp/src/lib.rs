//! Rapid interpretation: from a raw volume to interpreted horizons (P-horiz 4 and 5.3).
//!
//! Everything here is in voxel space: x = inline index, y = crossline index, z = sample index, z down; distances are in
//! voxels.
//!
//! A volume comes from any [`survey::source::SlabSource`], candidates go into any
//! [`survey::candidates::CandidateSink`].
//!
//! Deliberately absent: files, the store, projects, pictures.

pub mod assembly;
pub mod distance;
pub mod error;
pub mod evaluate;
pub mod extraction;
pub mod extrema;
pub mod faults;
pub mod forest;
pub mod grow;
pub mod holes;
mod lanes;
pub mod reassembly;
pub mod surfaces;

pub use distance::{CandidateColumns, DistanceSettings, LeafDistances};
pub use error::Error;
pub use evaluate::{EvaluateSettings, Evaluation, evaluate};
pub use extraction::{ExtractReport, ExtractSettings, Extraction, StageSeconds, extract, extract_into};
pub use extrema::Extrema;
pub use forest::{Forest, ForestSettings, Node, Subtree};
pub use grow::{GrowError, GrowSettings, Method, grow_slabs, grow_surfaces};
pub use surfaces::{Extremum, Surface, Surfaces, Vertex};
