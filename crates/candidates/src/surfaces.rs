//! Grown surfaces: triangles over the extrema of traces (P-horiz 4).
//!
//! A vertex is an extremum of one trace, so its x and y are integers and its z lies between samples.
//! Triangles join vertices of neighbouring traces; no triangle spans more than one cell of four traces.
//! Space: voxels.

use serde::{Deserialize, Serialize};
use std::ops::Range;

/// The feature of a trace that a surface follows.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Extremum {
    /// Positive maxima.
    Peak,
    /// Negative minima.
    Trough,
    /// Zero crossings from negative above to positive below.
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

/// One grown surface, as ranges of the arrays of [`Surfaces`].
#[derive(Debug, Clone, PartialEq)]
pub struct Surface {
    /// The kind of extremum that it follows.
    pub extremum: Extremum,
    /// Its range of [`Surfaces::vertices`].
    pub vertices: Range<u32>,
    /// Its range of [`Surfaces::triangles`].
    pub triangles: Range<u32>,
}

/// All surfaces grown in a volume. Memory: 8 bytes a vertex and 12 a triangle.
///
/// The order is part of the result: surfaces are ordered by their first vertex, and the vertices of a surface
/// by (x, y, z). The same volume therefore gives the same bytes at any number of threads or slabs.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Surfaces {
    /// `[inlines, crosslines, samples]` of the volume they were grown in.
    pub size: [usize; 3],
    /// Vertices, in the order of the surfaces.
    pub vertices: Vec<Vertex>,
    /// Triangles as indices into `vertices`, in the order of the surfaces.
    pub triangles: Vec<[u32; 3]>,
    /// The surfaces.
    pub surfaces: Vec<Surface>,
}
