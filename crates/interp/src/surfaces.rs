//! Grown surfaces: triangles over extrema of the traces (P-horiz 4).
//!
//! A vertex is an extremum of one trace, so its x and y are whole numbers and its z is refined below the sample. Triangles join
//! vertices of traces that are neighbours on the lattice; no triangle spans more than one cell of four traces. Space: voxels.

use serde::{Deserialize, Serialize};
use std::ops::Range;

/// What of a trace a surface follows.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Extremum {
    /// Positive maxima.
    Peak,
    /// Negative minima.
    Trough,
    /// Zero crossings, from negative above to positive below.
    Zero,
}

/// An extremum that a surface goes through.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Vertex {
    /// Inline index.
    pub x: u16,
    /// Crossline index.
    pub y: u16,
    /// Fractional sample index.
    pub z: f32,
}

/// One grown surface: ranges into the arrays of [`Surfaces`].
#[derive(Debug, Clone, PartialEq)]
pub struct Surface {
    /// What it follows.
    pub extremum: Extremum,
    /// Its vertices.
    pub vertices: Range<u32>,
    /// Its triangles.
    pub triangles: Range<u32>,
}

/// All surfaces grown in a volume. Memory: 8 bytes a vertex and 12 a triangle.
///
/// The order is part of the result: surfaces by their first vertex, vertices of a surface by (x, y, z), so the same volume gives
/// the same bytes at any number of threads or bricks.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Surfaces {
    /// `[inlines, crosslines, samples]` of the volume they were grown in.
    pub size: [usize; 3],
    /// Vertices, surface by surface.
    pub vertices: Vec<Vertex>,
    /// Indices into `vertices`, surface by surface.
    pub triangles: Vec<[u32; 3]>,
    /// The surfaces.
    pub surfaces: Vec<Surface>,
}
