//! Rapid interpretation: from a raw seismic volume to interpreted horizons and proposed faults.
//!
//! The method is that of D. Patel, S. Bruckner, I. Viola and M. E. Gröller, "Seismic volume visualization for
//! horizon extraction", IEEE Pacific Visualization, 2010, sections 4 and 5.3. It is cited as P-horiz below.
//!
//! # How horizons are found
//!
//! 1. The crate `candidates`, whose names are handed on here, grows surfaces, cuts each into a tree of ever flatter
//!    parts ([`Forest`]), and computes the closest leaf of every voxel.
//! 2. [`assembly`] turns picks into a set of triangles, [`reassembly`] turns the triangles into sheets on the
//!    survey's lattice, and [`holes`] fills holes on request.
//! 3. [`faults`] proposes faults from the assembled horizons.
//!
//! # Space and units
//! All positions are voxels: x = inline index, y = crossline index, z = sample index, z down. Distances are
//! in voxels.
//!
//! Deliberately absent: files, the store, projects, pictures.

pub mod assembly;
pub mod faults;
pub mod holes;
pub mod reassembly;
pub mod refine;
mod sheet;

pub use candidates::{bricks, distance, error, extraction, extrema, forest, grow, surfaces};

pub use candidates::{
    CandidateColumns, DistanceSettings, ExtractReport, ExtractSettings, Extraction, Extrema, Extremum, Forest,
    ForestSettings, GrowError, GrowSettings, InterpError, LeafDistances, Method, Node, StageSeconds, Subtree, Surface,
    Surfaces, UnionFind, Vertex, extract, extract_into, grow_slabs, grow_surfaces,
};
