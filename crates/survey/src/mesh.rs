//! Triangulated surfaces in world coordinates, as in faults and TSurf files.

use glam::DVec3;
use serde::{Deserialize, Serialize};
use std::collections::HashMap;

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

    /// Cuts the surface where `off`, a value for each vertex, changes its sign: the part where it is negative, and the part
    /// where it is not. Triangles on the cut are divided along it, linearly.
    ///
    /// ```
    /// # use glam::DVec3;
    /// # use survey::TriangleMesh;
    /// let vertices = vec![DVec3::ZERO, DVec3::X, DVec3::Z];
    /// let mesh = TriangleMesh { vertices, triangles: vec![[0, 1, 2]] };
    /// let [near, far] = mesh.parted(&[-0.25, 0.75, -0.25]);
    /// assert_eq!((near.triangles.len(), far.triangles.len()), (2, 1));
    /// assert!(near.vertices.iter().all(|v| v.x <= 0.25) && far.vertices.iter().all(|v| v.x >= 0.25));
    /// ```
    ///
    /// # Panics
    /// `off` has another length than [`Self::vertices`].
    pub fn parted(&self, off: &[f64]) -> [Self; 2] {
        assert_eq!(off.len(), self.vertices.len(), "a value for each vertex");
        [true, false].map(|is_negative| self.part(off, is_negative))
    }

    fn part(&self, off: &[f64], is_negative: bool) -> Self {
        let is_in = |v: u32| (off[v as usize] < 0.0) == is_negative;
        let mut part = Self::default();
        let mut known: HashMap<(u32, u32), u32> = HashMap::new();
        let mut vertex = |part: &mut Self, a: u32, b: u32| {
            let (a, b) = (a.min(b), a.max(b));
            *known.entry((a, b)).or_insert_with(|| {
                let [from, to] = [a, b].map(|v| self.vertices[v as usize]);
                let [near, far] = [a, b].map(|v| off[v as usize]);
                part.vertices.push(if a == b { from } else { from.lerp(to, near / (near - far)) });
                part.vertices.len() as u32 - 1
            })
        };
        for &[a, b, c] in &self.triangles {
            let mut corners = Vec::with_capacity(4);
            for (v, next) in [(a, b), (b, c), (c, a)] {
                if is_in(v) {
                    corners.push(vertex(&mut part, v, v));
                }
                if is_in(v) != is_in(next) {
                    corners.push(vertex(&mut part, v, next));
                }
            }
            for n in 2..corners.len() {
                part.triangles.push([corners[0], corners[n - 1], corners[n]]);
            }
        }
        part
    }
}
