//! Triangulated surfaces in world coordinates, as in faults and TSurf files.

use glam::DVec3;
use serde::{Deserialize, Serialize};

/// Triangles over shared vertices: world X, Y in m and the vertical value in the survey's unit, positive
/// down.
///
/// ```
/// # use glam::DVec3;
/// # use survey::TriangleMesh;
/// let vertices = vec![DVec3::ZERO, DVec3::X, DVec3::Z];
/// let mesh = TriangleMesh { vertices, triangles: vec![[0, 2, 1]] };
/// assert_eq!(mesh.corners(0), [DVec3::ZERO, DVec3::Z, DVec3::X]);
/// ```
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct TriangleMesh {
    /// Vertex positions in world space.
    pub vertices: Vec<DVec3>,
    /// Indices into `vertices`, three per triangle.
    pub triangles: Vec<[u32; 3]>,
}

impl TriangleMesh {
    /// The corners of triangle `index`.
    #[inline]
    pub fn corners(&self, index: usize) -> [DVec3; 3] {
        self.triangles[index].map(|v| self.vertices[v as usize])
    }
}
