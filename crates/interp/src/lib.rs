//! Rapid interpretation: from a raw seismic volume to interpreted horizons and proposed faults.
//!
//! The method is that of D. Patel, S. Bruckner, I. Viola and M. E. Gröller, "Seismic volume visualization for
//! horizon extraction", IEEE Pacific Visualization, 2010, sections 4 and 5.3. It is cited as P-horiz below.
//!
//! # How horizons are found
//!
//! 1. [`extrema`] finds peaks, troughs or zero crossings of every trace, refined between samples.
//! 2. [`grow`] connects them to surfaces ([`Surfaces`]).
//! 3. [`Forest`] cuts each surface into a tree of ever flatter parts. Its leaves are the *candidates* that an
//!    interpreter picks from.
//! 4. [`LeafDistances`] computes, for every voxel, the closest leaf and its distance.
//! 5. [`assembly`] turns picks into a set of triangles, [`reassembly`] turns the triangles into sheets on the
//!    survey's lattice, and [`holes`] fills holes on request.
//! 6. [`faults`] proposes faults from the assembled horizons.
//!
//! [`extract`] does 1 to 4. [`evaluate()`] measures the result against a synthetic survey's truth.
//!
//! # Space and units
//! All positions are voxels: x = inline index, y = crossline index, z = sample index, z down. Distances are
//! in voxels.
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
mod sheet;
pub mod surfaces;

pub use distance::{CandidateColumns, DistanceSettings, LeafDistances};
pub use error::InterpError;
pub use evaluate::{EvaluateSettings, Evaluation, evaluate};
pub use extraction::{ExtractReport, ExtractSettings, Extraction, StageSeconds, extract, extract_into};
pub use extrema::Extrema;
pub use forest::{Forest, ForestSettings, Node, Subtree};
pub use grow::{GrowError, GrowSettings, Method, UnionFind, grow_slabs, grow_surfaces};
pub use surfaces::{Extremum, Surface, Surfaces, Vertex};
