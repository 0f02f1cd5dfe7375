//! Triangulated surfaces in world coordinates, as faults and TSurf files have them.

use glam::DVec3;
use serde::{Deserialize, Serialize};

/// Triangles over shared vertices: world X, Y in m and the vertical value in the survey's unit, positive down.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct TriangleMesh {
    /// Vertex positions in world space.
    pub vertices: Vec<DVec3>,
    /// Indices into `vertices`, three a triangle.
    pub triangles: Vec<[u32; 3]>,
}

impl TriangleMesh {
    /// The corners of triangle `index`.
    #[inline]
    pub fn corners(&self, index: usize) -> [DVec3; 3] {
        self.triangles[index].map(|v| self.vertices[v as usize])
    }
}
