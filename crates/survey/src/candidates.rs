//! Horizon candidates as whoever finds them and whoever keeps them hand them to one another: for every voxel the
//! distance to the closest surface and its leaf, and the surfaces and their trees as tables.

use crate::progress::Progress;
use crate::source::SourceError;
use serde::{Deserialize, Serialize};

/// The distance that means "farther than the greatest distance".
pub const BEYOND: u8 = u8::MAX;

/// A box of candidates, `[inline][crossline][sample]`.
#[derive(Debug, Clone, PartialEq)]
pub struct CandidateBox {
    /// Voxels along each axis.
    pub size: [usize; 3],
    /// Coded distances; [`BEYOND`] = farther than the greatest.
    pub distance: Vec<u8>,
    /// Leaf ids, 0 = none.
    pub leaf: Vec<u32>,
}

/// What is known of candidates.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct CandidateInfo<R> {
    /// Identifies what they were computed from.
    pub key: String,
    /// `[inlines, crosslines, samples]`.
    pub size: [usize; 3],
    /// The distance that code 254 stands for, voxels.
    pub max_distance: f32,
    /// Leaves, which is the greatest leaf id.
    pub leaves: usize,
    /// What the one who made them reports, settings and counts.
    pub report: R,
}

/// Surfaces and trees as tables. What leaves and nodes mean is the business of those who made them.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct ForestTables {
    /// Inline and crossline index of each vertex.
    pub trace: Vec<[u16; 2]>,
    /// Fractional sample index of each vertex.
    pub z: Vec<f32>,
    /// Vertices of each triangle.
    pub triangles: Vec<[u32; 3]>,
    /// Kind, first vertex, end of vertices, first triangle, end of triangles of each surface.
    pub surfaces: Vec<[u32; 5]>,
    /// Parent, children, surface, first triangle, end of triangles of each node; all ones = none.
    pub nodes: Vec<[u32; 6]>,
}

/// Takes candidates slab by slab. Dropped without [`CandidateSink::finish`], it leaves nothing behind.
pub trait CandidateSink {
    /// Inlines of a slab but for the last.
    fn slab_inlines(&self) -> usize;

    /// Takes the inlines from `first`, a multiple of [`CandidateSink::slab_inlines`], `[inline][crossline][sample]`.
    ///
    /// # Errors
    /// What the sink says, or cancelled.
    fn write_slab(
        &mut self,
        first: usize,
        distance: &[u8],
        leaf: &[u32],
        progress: &Progress,
    ) -> Result<(), SourceError>;

    /// Takes facts and trees, and ends.
    ///
    /// # Errors
    /// What the sink says, or cancelled.
    fn finish<R: Serialize>(
        self,
        info: &CandidateInfo<R>,
        forest: &ForestTables,
        progress: &Progress,
    ) -> Result<(), SourceError>;
}
