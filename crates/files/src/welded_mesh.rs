//! A mesh of faces whose corners are given by their places alone: equal places are one vertex.

use glam::DVec3;
use std::collections::HashMap;
use survey::mesh::TriangleMesh;

/// The mesh so far.
#[derive(Default)]
pub(super) struct WeldedMesh {
    pub mesh: TriangleMesh,
    index: HashMap<[u64; 3], u32>,
}

impl WeldedMesh {
    fn vertex(&mut self, at: DVec3) -> u32 {
        // Zero is one place, whatever its sign.
        let key = (at + DVec3::ZERO).to_array().map(f64::to_bits);
        *self.index.entry(key).or_insert_with(|| {
            self.mesh.vertices.push(at);
            self.mesh.vertices.len() as u32 - 1
        })
    }

    /// Adds a face of three corners or more, which is cut from its first one into triangles; those without three
    /// different corners are left out.
    pub(super) fn face(&mut self, corners: &[DVec3]) {
        let [first, rest @ ..] = corners else { return };
        let a = self.vertex(*first);
        let others: Vec<u32> = rest.iter().map(|corner| self.vertex(*corner)).collect();
        let triangles = others.windows(2).map(|pair| [a, pair[0], pair[1]]);
        self.mesh.triangles.extend(triangles.filter(|[a, b, c]| a != b && b != c && c != a));
    }
}
