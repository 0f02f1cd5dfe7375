//! Horizon candidates in the form in which they pass from the extraction to the store: the distance from
//! every voxel to the closest surface, the leaf of that surface, and the surfaces and their trees as tables.

use crate::progress::Progress;
use crate::source::SourceError;
use serde::{Deserialize, Serialize};
use std::ops::Range;

/// The code for a distance greater than [`CandidateInfo::max_distance`].
pub const BEYOND: u8 = u8::MAX;

/// A box of candidates, `[inline][crossline][sample]`.
#[derive(Debug, Clone, PartialEq)]
pub struct CandidateBox {
    /// Voxels along each axis.
    pub size: [usize; 3],
    /// Coded distances; [`BEYOND`] is farther than the greatest distance.
    pub distance: Vec<u8>,
    /// Leaf ids; 0 means none.
    pub leaf: Vec<u32>,
}

/// Facts about a set of candidates.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct CandidateInfo<R> {
    /// Identifies the input of the extraction.
    pub key: String,
    /// `[inlines, crosslines, samples]`.
    pub size: [usize; 3],
    /// The distance that code 254 stands for, voxels.
    pub max_distance: f32,
    /// Count of leaves, which is also the greatest leaf id.
    pub leaves: usize,
    /// The report of the extraction: its settings and counts.
    pub report: R,
}

/// Surfaces and trees as tables. The extraction defines what leaves and nodes mean.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct ForestTables {
    /// Inline and crossline index of each vertex.
    pub trace: Vec<[u16; 2]>,
    /// Fractional sample index of each vertex.
    pub z: Vec<f32>,
    /// Vertices of each triangle.
    pub triangles: Vec<[u32; 3]>,
    /// Kind, first vertex, end of the vertices, first triangle and end of the triangles of each surface.
    pub surfaces: Vec<[u32; 5]>,
    /// Parent, two children, surface, first triangle and end of the triangles of each node; all ones mean
    /// none.
    pub nodes: Vec<[u32; 6]>,
}

/// Receives candidates slab by slab. If it is dropped without [`CandidateSink::finish`], nothing is kept.
pub trait CandidateSink {
    /// Count of inlines in every slab except the last.
    fn slab_inlines(&self) -> usize;

    /// Receives the slab that begins at inline `first`, a multiple of [`CandidateSink::slab_inlines`]. The
    /// order is `[inline][crossline][sample]`.
    ///
    /// # Errors
    /// An error of the sink, or [`Cancelled`](crate::Cancelled).
    fn write_slab(
        &mut self,
        first: usize,
        distance: &[u8],
        leaf: &[u32],
        progress: &Progress,
    ) -> Result<(), SourceError>;

    /// Receives the facts and the trees, and completes the candidates.
    ///
    /// # Errors
    /// An error of the sink, or [`Cancelled`](crate::Cancelled).
    fn finish<R: Serialize>(
        self,
        info: &CandidateInfo<R>,
        forest: &ForestTables,
        progress: &Progress,
    ) -> Result<(), SourceError>;
}

/// Counts of rows of the tables of surfaces and trees.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct ForestCounts {
    /// Vertices.
    pub vertices: usize,
    /// Triangles.
    pub triangles: usize,
    /// Surfaces.
    pub surfaces: usize,
    /// Nodes of their trees.
    pub nodes: usize,
}

/// Surfaces and trees as tables whose rows are read some at a time; see [`ForestTables`] for what they hold.
pub trait ForestRows: Sync {
    /// Counts of rows.
    fn counts(&self) -> ForestCounts;

    /// Rows of [`ForestTables::trace`].
    ///
    /// # Errors
    /// They cannot be read.
    fn trace(&self, rows: Range<usize>) -> Result<Vec<[u16; 2]>, SourceError>;

    /// Rows of [`ForestTables::z`].
    ///
    /// # Errors
    /// They cannot be read.
    fn z(&self, rows: Range<usize>) -> Result<Vec<f32>, SourceError>;

    /// Rows of [`ForestTables::triangles`].
    ///
    /// # Errors
    /// They cannot be read.
    fn triangles(&self, rows: Range<usize>) -> Result<Vec<[u32; 3]>, SourceError>;

    /// Rows of [`ForestTables::surfaces`].
    ///
    /// # Errors
    /// They cannot be read.
    fn surfaces(&self, rows: Range<usize>) -> Result<Vec<[u32; 5]>, SourceError>;

    /// Rows of [`ForestTables::nodes`].
    ///
    /// # Errors
    /// They cannot be read.
    fn nodes(&self, rows: Range<usize>) -> Result<Vec<[u32; 6]>, SourceError>;
}
