//! How the triangles of a mesh hang together: shared corners, a common orientation, borders, whether it encloses a body.
//!
//! Files repeat corners (one part per sheet, one triangle soup), and their triangles may turn either way. Corners at the
//! same place become one, and every connected part is turned as a whole: a closed one outwards, another so that most of
//! its area, seen from above, faces up.

use crate::mesh::TriangleMesh;
use glam::DVec3;
use std::collections::HashMap;

/// What keeps triangles from being a surface.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
pub enum TopologyError {
    /// There is no triangle with an area and finite corners.
    #[error("it has no triangle with an area and finite corners")]
    Empty,
    /// More than two triangles share an edge.
    #[error("more than two of its triangles share an edge; keep one surface there")]
    Branched {
        /// A corner of that edge.
        at: DVec3,
    },
    /// Its sides cannot be told apart, as those of a Möbius strip.
    #[error("its two sides cannot be told apart, it is twisted like a Möbius strip; cut it there")]
    Twisted {
        /// A corner of an edge where both sides meet.
        at: DVec3,
    },
}

impl TopologyError {
    /// Where, in the mesh's own space.
    pub fn place(&self) -> Option<DVec3> {
        match self {
            Self::Empty => None,
            Self::Branched { at } | Self::Twisted { at } => Some(*at),
        }
    }
}

/// A mesh whose triangles share their corners and turn the same way.
///
/// ```
/// use glam::DVec3;
/// use survey::TriangleMesh;
/// use survey::topology::OrientedMesh;
/// // A tetrahedron, with one triangle turned inwards; z points down.
/// let vertices = vec![DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z];
/// let triangles = vec![[0, 1, 2], [0, 1, 3], [1, 2, 3], [0, 3, 2]];
/// let body = OrientedMesh::of(&TriangleMesh { vertices, triangles }, 1e-9)?;
/// assert!(body.is_closed());
/// assert!((body.volume() - 1.0 / 6.0).abs() < 1e-12);
/// # Ok::<(), survey::topology::TopologyError>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct OrientedMesh {
    /// The triangles with shared corners. Normals (b − a) × (c − a) point out of a closed part and otherwise, by area on
    /// the map, up (z is positive down).
    pub mesh: TriangleMesh,
    /// The connected part of each triangle.
    pub part: Vec<u32>,
    /// Whether each part has no border.
    pub closed: Vec<bool>,
    /// Edges of one triangle alone, lower corner first.
    pub border: Vec<[u32; 2]>,
}

impl OrientedMesh {
    /// Puts corners closer than about `weld` together and turns the triangles. Triangles without an area are left out.
    ///
    /// # Errors
    /// [`TopologyError`]
    pub fn of(mesh: &TriangleMesh, weld: f64) -> Result<Self, TopologyError> {
        let mut mesh = welded(mesh, weld);
        if mesh.triangles.is_empty() {
            return Err(TopologyError::Empty);
        }
        let edges = edges(&mesh);
        if let Some((edge, _)) = edges.iter().filter(|(_, of)| of.len() > 2).min_by_key(|(edge, _)| **edge) {
            return Err(TopologyError::Branched { at: mesh.vertices[edge[0] as usize] });
        }
        let part = turn_alike(&mut mesh, &edges)?;
        let parts = part.iter().max().map_or(0, |&last| last as usize + 1);
        let mut closed = vec![true; parts];
        let mut border: Vec<[u32; 2]> = Vec::new();
        for (&edge, of) in edges.iter().filter(|(_, of)| of.len() == 1) {
            closed[part[of[0] as usize] as usize] = false;
            border.push(edge);
        }
        border.sort_unstable();
        let mut oriented = Self { mesh, part, closed, border };
        oriented.turn_parts();
        Ok(oriented)
    }

    /// Whether every part encloses a body.
    pub fn is_closed(&self) -> bool {
        self.closed.iter().all(|&closed| closed)
    }

    /// The enclosed volume of a closed mesh, in its own units.
    pub fn volume(&self) -> f64 {
        (0..self.mesh.triangles.len()).map(|n| self.cone(n)).sum()
    }

    /// The largest share of a part's area on the map that faces down: 0 for a height field.
    pub fn overturned_share(&self) -> f64 {
        let mut areas = vec![[0.0f64; 2]; self.closed.len()];
        for (n, &part) in self.part.iter().enumerate() {
            let area = self.area_up(n);
            areas[part as usize][usize::from(area < 0.0)] += area.abs();
        }
        areas.iter().map(|[up, down]| down / (up + down).max(f64::MIN_POSITIVE)).fold(0.0, f64::max)
    }

    /// The signed volume between a triangle and the first corner of the mesh.
    fn cone(&self, triangle: usize) -> f64 {
        let origin = self.mesh.vertices[0];
        let [a, b, c] = self.mesh.corners(triangle).map(|p| p - origin);
        a.dot(b.cross(c)) / 6.0
    }

    /// Twice the area of a triangle on the map, positive if it faces up.
    fn area_up(&self, triangle: usize) -> f64 {
        let [a, b, c] = self.mesh.corners(triangle);
        -(b - a).cross(c - a).z
    }

    /// Turns each part as a whole.
    fn turn_parts(&mut self) {
        let mut sums = vec![0.0; self.closed.len()];
        for (n, &part) in self.part.iter().enumerate() {
            let part = part as usize;
            sums[part] += if self.closed[part] { self.cone(n) } else { self.area_up(n) };
        }
        for (triangle, &part) in self.mesh.triangles.iter_mut().zip(&self.part) {
            if sums[part as usize] < 0.0 {
                triangle.swap(1, 2);
            }
        }
    }
}

/// The mesh with one corner for each place, without triangles that have no area.
fn welded(mesh: &TriangleMesh, weld: f64) -> TriangleMesh {
    let mut known: HashMap<[i64; 3], u32> = HashMap::new();
    let mut out = TriangleMesh::default();
    let index: Vec<u32> = mesh
        .vertices
        .iter()
        .map(|&vertex| {
            let key = (vertex / weld).round().to_array().map(|c| c as i64);
            *known.entry(key).or_insert_with(|| {
                out.vertices.push(vertex);
                out.vertices.len() as u32 - 1
            })
        })
        .collect();
    for triangle in &mesh.triangles {
        let [a, b, c] = triangle.map(|corner| index[corner as usize]);
        let [p, q, r] = [a, b, c].map(|corner| out.vertices[corner as usize]);
        let has_area = a != b && b != c && c != a && (q - p).cross(r - p).length_squared() > 0.0;
        if has_area && [p, q, r].iter().all(|p| p.is_finite()) {
            out.triangles.push([a, b, c]);
        }
    }
    out
}

/// The triangles at each edge (lower corner first).
fn edges(mesh: &TriangleMesh) -> HashMap<[u32; 2], Vec<u32>> {
    let mut edges: HashMap<[u32; 2], Vec<u32>> = HashMap::with_capacity(mesh.triangles.len() * 2);
    for (n, &[a, b, c]) in mesh.triangles.iter().enumerate() {
        for (from, to) in [(a, b), (b, c), (c, a)] {
            edges.entry([from.min(to), from.max(to)]).or_default().push(n as u32);
        }
    }
    edges
}

/// Turns triangles so that neighbours pass their common edge in opposite directions; returns the part of each.
fn turn_alike(mesh: &mut TriangleMesh, edges: &HashMap<[u32; 2], Vec<u32>>) -> Result<Vec<u32>, TopologyError> {
    const NONE: u32 = u32::MAX;
    let passes = |[a, b, c]: [u32; 3], from: u32, to: u32| [(a, b), (b, c), (c, a)].contains(&(from, to));
    let mut part = vec![NONE; mesh.triangles.len()];
    let mut parts = 0;
    for first in 0..part.len() {
        if part[first] != NONE {
            continue;
        }
        part[first] = parts;
        let mut open = vec![first];
        while let Some(n) = open.pop() {
            let [a, b, c] = mesh.triangles[n];
            for (from, to) in [(a, b), (b, c), (c, a)] {
                for &m in edges[&[from.min(to), from.max(to)]].iter().filter(|&&m| m as usize != n) {
                    let m = m as usize;
                    let same_way = passes(mesh.triangles[m], from, to);
                    if part[m] == NONE {
                        part[m] = parts;
                        if same_way {
                            mesh.triangles[m].swap(1, 2);
                        }
                        open.push(m);
                    } else if same_way {
                        return Err(TopologyError::Twisted { at: mesh.vertices[from as usize] });
                    }
                }
            }
        }
        parts += 1;
    }
    Ok(part)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A strip of squares along x whose far ends may be joined, straight or twisted.
    fn band(count: u32, twisted: bool) -> TriangleMesh {
        let place = |n: u32, side: f64| {
            let turn = f64::from(n) / f64::from(count) * std::f64::consts::TAU;
            let tilt = if twisted { 0.5 * turn } else { 0.0 };
            let radius = 10.0 + side * tilt.sin();
            DVec3::new(radius * turn.cos(), radius * turn.sin(), side * tilt.cos())
        };
        let vertices = (0..count).flat_map(|n| [place(n, -1.0), place(n, 1.0)]).collect();
        let triangles = (0..count).flat_map(|n| {
            let (a, b) = (2 * n, 2 * n + 1);
            let (mut c, mut d) = ((2 * n + 2) % (2 * count), (2 * n + 3) % (2 * count));
            if twisted && n + 1 == count {
                (c, d) = (d, c);
            }
            [[a, c, b], [b, c, d]]
        });
        TriangleMesh { vertices, triangles: triangles.collect() }
    }

    #[test]
    fn a_ring_has_two_sides_and_a_moebius_strip_one() {
        let ring = OrientedMesh::of(&band(24, false), 1e-6).unwrap();
        assert_eq!((ring.is_closed(), ring.closed.len(), ring.border.len()), (false, 1, 48));
        assert!(matches!(OrientedMesh::of(&band(24, true), 1e-6), Err(TopologyError::Twisted { .. })));
    }

    #[test]
    fn parts_are_welded_and_turned_up() {
        // Two triangles of a square that repeat their corners; the second is turned down.
        let corners = [DVec3::ZERO, DVec3::X, DVec3::new(1.0, 1.0, 0.0), DVec3::Y];
        let vertices = vec![corners[0], corners[1], corners[2], corners[0], corners[2], corners[3]];
        let square = TriangleMesh { vertices, triangles: vec![[0, 1, 2], [3, 5, 4]] };
        let found = OrientedMesh::of(&square, 1e-6).unwrap();
        assert_eq!((found.mesh.vertices.len(), found.border.len(), found.part.as_slice()), (4, 4, &[0, 0][..]));
        assert_eq!(found.overturned_share(), 0.0);
        assert!((0..2).all(|n| found.area_up(n) == 1.0));
    }

    #[test]
    fn three_triangles_at_an_edge_are_no_surface() {
        let vertices = vec![DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z, -DVec3::Y];
        let fan = TriangleMesh { vertices, triangles: vec![[0, 1, 2], [0, 1, 3], [0, 1, 4]] };
        assert_eq!(OrientedMesh::of(&fan, 1e-6), Err(TopologyError::Branched { at: DVec3::ZERO }));
        let point = TriangleMesh { vertices: vec![DVec3::ZERO; 3], triangles: vec![[0, 1, 2]] };
        assert_eq!(OrientedMesh::of(&point, 1e-6), Err(TopologyError::Empty));
    }
}
