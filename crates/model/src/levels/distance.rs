//! The signed distance from a triangulated surface at the nodes of a box.
//!
//! The sign is that of the normal at the closest point, which at edges and corners is the mean of the faces weighted by
//! their angles (J. A. Bærentzen and H. Aanæs, "Signed distance computation using the angle weighted pseudonormal",
//! IEEE TVCG 11(3), 2005). Where the closest point lies on the border of an open surface, the value is the distance from
//! its tangent plane there, so that the surface continues straight on.
//!
//! Near the surface the closest triangle is looked for in a tree, elsewhere only at every [`COARSE`]th node, because far
//! from a flat surface a tree has to look at all triangles that are nearly as close. Between coarse nodes whose gradients
//! g are alike the distance d is
//!
//! ```text
//! d(p) = Σ wₙ (dₙ + ½ gₙ·(p − pₙ)),   w: trilinear weights
//! ```
//!
//! which is exact where d is quadratic. Where they are not (around a crease), the closest triangle is followed downhill
//! on the surface from those of the coarse nodes around.

use super::tree::Tree;
use glam::{DMat3, DVec3, Vec3};
use rayon::prelude::*;
use std::collections::HashMap;
use survey::LevelField;
use survey::progress::{Cancelled, Progress};
use survey::topology::OrientedMesh;

/// Nodes from one for which the closest triangle is looked for in the tree to the next, along each axis.
const COARSE: usize = 4;
/// Nodes that may be nearer to the surface than so many diagonals of a cell are looked for in the tree, too.
const NEAR: f64 = 1.5;
/// Least cosine between the gradients at the corners of a coarse cell in which distances are interpolated.
const ALIKE: f64 = 0.999;

/// A surface in metric space, ready for closest points.
pub(super) struct DistanceSurface {
    corners: Vec<[DVec3; 3]>,
    /// Unit normal per triangle.
    normals: Vec<DVec3>,
    /// Pseudonormals at the corners of each triangle, then at its edges (0, 1), (1, 2), (2, 0); not of unit length.
    around: Vec<[DVec3; 6]>,
    /// Bit n: the corner (0 … 2) or edge (3 … 5) n lies on the border.
    border: Vec<u8>,
    /// The triangles around each corner of the mesh, and the corners of each triangle.
    fans: Vec<Vec<u32>>,
    triangles: Vec<[u32; 3]>,
}

/// The closest point of a surface.
#[derive(Debug, Clone, Copy)]
struct Closest {
    point: DVec3,
    /// 0 … 2 a corner, 3 … 5 an edge, 6 the face.
    feature: usize,
}

impl DistanceSurface {
    /// The triangles of a mesh in metric space.
    pub(super) fn of(oriented: &OrientedMesh) -> Self {
        let mesh = &oriented.mesh;
        let corners: Vec<[DVec3; 3]> = (0..mesh.triangles.len()).map(|n| mesh.corners(n)).collect();
        let normals: Vec<DVec3> = corners.iter().map(|[a, b, c]| (*b - *a).cross(*c - *a).normalize()).collect();
        let mut at_corner = vec![DVec3::ZERO; mesh.vertices.len()];
        let mut at_edge: HashMap<[u32; 2], DVec3> = HashMap::new();
        let edge = |a: u32, b: u32| [a.min(b), a.max(b)];
        for (n, &triangle) in mesh.triangles.iter().enumerate() {
            for i in 0..3 {
                let [a, b, c] = [0, 1, 2].map(|k| corners[n][(i + k) % 3]);
                at_corner[triangle[i] as usize] += normals[n] * (b - a).angle_between(c - a);
                *at_edge.entry(edge(triangle[i], triangle[(i + 1) % 3])).or_default() += normals[n];
            }
        }
        let mut on_border = vec![false; mesh.vertices.len()];
        oriented.border.iter().flatten().for_each(|&v| on_border[v as usize] = true);
        let around = |&[a, b, c]: &[u32; 3]| {
            let [p, q, r] = [a, b, c].map(|v| at_corner[v as usize]);
            [p, q, r, at_edge[&edge(a, b)], at_edge[&edge(b, c)], at_edge[&edge(c, a)]]
        };
        let borders = |&[a, b, c]: &[u32; 3]| {
            let corners = [a, b, c].map(|v| on_border[v as usize]);
            let edges = [(a, b), (b, c), (c, a)].map(|(a, b)| oriented.border.binary_search(&edge(a, b)).is_ok());
            corners.into_iter().chain(edges).enumerate().map(|(n, on)| u8::from(on) << n).sum()
        };
        let mut fans = vec![Vec::new(); mesh.vertices.len()];
        for (n, triangle) in mesh.triangles.iter().enumerate() {
            triangle.iter().for_each(|&v| fans[v as usize].push(n as u32));
        }
        let (around, border) = (mesh.triangles.iter().map(around), mesh.triangles.iter().map(borders));
        let (around, border) = (around.collect(), border.collect());
        Self { around, border, corners, normals, fans, triangles: mesh.triangles.clone() }
    }

    /// Square of the distance of a point from a triangle.
    fn distance_squared(&self, triangle: usize, p: DVec3) -> f64 {
        self.closest(triangle, p).point.distance_squared(p)
    }

    /// From a triangle downhill to the one that is closer to `p` than all around it. A point inside a triangle is the
    /// closest one of its surroundings; from one on an edge or corner the triangles that share it are looked at.
    fn descend(&self, mut triangle: usize, p: DVec3) -> usize {
        let mut here = self.closest(triangle, p);
        loop {
            // The triangle across an edge is around its first corner.
            let shared = match here.feature {
                6 => return triangle,
                edge @ 3..=5 => self.triangles[triangle][edge - 3],
                corner => self.triangles[triangle][corner],
            };
            let least = here.point.distance_squared(p);
            let mut best = (least, triangle, here);
            for &n in &self.fans[shared as usize] {
                let found = self.closest(n as usize, p);
                let distance = found.point.distance_squared(p);
                if distance < best.0 {
                    best = (distance, n as usize, found);
                }
            }
            if best.0 >= least {
                return triangle;
            }
            (_, triangle, here) = best;
        }
    }

    /// The closest point of a triangle (C. Ericson, "Real-Time Collision Detection", 2005, 5.1.5).
    fn closest(&self, triangle: usize, p: DVec3) -> Closest {
        let [a, b, c] = self.corners[triangle];
        let (ab, ac, ap) = (b - a, c - a, p - a);
        let (d1, d2) = (ab.dot(ap), ac.dot(ap));
        let at = |point, feature| Closest { point, feature };
        if d1 <= 0.0 && d2 <= 0.0 {
            return at(a, 0);
        }
        let bp = p - b;
        let (d3, d4) = (ab.dot(bp), ac.dot(bp));
        if d3 >= 0.0 && d4 <= d3 {
            return at(b, 1);
        }
        let vc = d1 * d4 - d3 * d2;
        if vc <= 0.0 && d1 >= 0.0 && d3 <= 0.0 {
            return at(a + ab * (d1 / (d1 - d3)), 3);
        }
        let cp = p - c;
        let (d5, d6) = (ab.dot(cp), ac.dot(cp));
        if d6 >= 0.0 && d5 <= d6 {
            return at(c, 2);
        }
        let vb = d5 * d2 - d1 * d6;
        if vb <= 0.0 && d2 >= 0.0 && d6 <= 0.0 {
            return at(a + ac * (d2 / (d2 - d6)), 5);
        }
        let va = d3 * d6 - d5 * d4;
        if va <= 0.0 && d4 - d3 >= 0.0 && d5 - d6 >= 0.0 {
            return at(b + (c - b) * ((d4 - d3) / ((d4 - d3) + (d5 - d6))), 4);
        }
        let scale = 1.0 / (va + vb + vc);
        at(a + ab * (vb * scale) + ac * (vc * scale), 6)
    }

    /// The gradient of the signed distance at a point whose closest point lies on a triangle.
    fn gradient(&self, triangle: usize, p: DVec3) -> DVec3 {
        let Closest { point, feature } = self.closest(triangle, p);
        let normal = if feature == 6 { self.normals[triangle] } else { self.around[triangle][feature] };
        let away = p - point;
        let is_border = feature < 6 && self.border[triangle] >> feature & 1 == 1;
        if is_border || away.length_squared() == 0.0 {
            return -normal.normalize_or_zero();
        }
        away.normalize_or_zero() * if away.dot(normal) > 0.0 { -1.0 } else { 1.0 }
    }

    /// Metres from a point to its closest point on a triangle, positive on the side that the normals point away from.
    fn signed(&self, triangle: usize, p: DVec3) -> f64 {
        let Closest { point, feature } = self.closest(triangle, p);
        let normal = if feature == 6 { self.normals[triangle] } else { self.around[triangle][feature] };
        let inside = (point - p).dot(normal);
        let is_border = feature < 6 && self.border[triangle] >> feature & 1 == 1;
        if is_border {
            return inside / normal.length().max(f64::MIN_POSITIVE);
        }
        let distance = point.distance(p);
        if inside >= 0.0 { distance } else { -distance }
    }
}

/// A place where the sides of a surface contradict each other, because it neither is closed nor reaches the edge of the
/// volume there, or crosses itself.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Contradiction {
    /// Voxel position.
    pub at: Vec3,
}

/// The box of a level field.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct NodeBox {
    /// Voxel position of the first node.
    pub origin: Vec3,
    /// Voxels between nodes.
    pub step: Vec3,
    /// Counts along x, y, z.
    pub size: [usize; 3],
}

impl NodeBox {
    /// The nodes at a spacing that cover the box from `low` to `high`.
    pub(crate) fn covering(low: Vec3, high: Vec3, step: Vec3) -> Self {
        let counts = ((high - low) / step).ceil().to_array().map(|n| n.max(1.0) as usize + 1);
        Self { origin: low, step, size: counts }
    }

    /// Number of nodes.
    pub fn count(&self) -> usize {
        self.size.iter().product()
    }

    /// Indices of a node along x, y, z.
    pub fn index(&self, node: usize) -> [usize; 3] {
        [node / (self.size[1] * self.size[2]), node / self.size[2] % self.size[1], node % self.size[2]]
    }

    /// The neighbours of a node along the axes.
    pub fn beside(&self, node: usize) -> impl Iterator<Item = usize> + use<> {
        let (index, size) = (self.index(node), self.size);
        let strides = [size[1] * size[2], size[2], 1];
        (0..3).flat_map(move |axis| {
            let before = (index[axis] > 0).then(|| node - strides[axis]);
            let after = (index[axis] + 1 < size[axis]).then(|| node + strides[axis]);
            before.into_iter().chain(after)
        })
    }

    /// The corners of the cell around a voxel position, or of the cell nearest to it.
    pub fn around(&self, p: Vec3) -> impl Iterator<Item = usize> + use<> {
        let size = self.size;
        let at = ((p - self.origin) / self.step).max(Vec3::ZERO);
        let [x, y, z] = [0, 1, 2].map(|axis: usize| (at[axis] as usize).min(size[axis].saturating_sub(2)));
        (0..8).map(move |n| ((x + (n >> 2)) * size[1] + y + (n >> 1 & 1)) * size[2] + z + (n & 1))
    }

    /// Voxel position of a node.
    pub fn place(&self, node: usize) -> Vec3 {
        self.origin + Vec3::from_array(self.index(node).map(|n| n as f32)) * self.step
    }
}

/// The signed distance in metres at the nodes of a box, positive where the normals point away from; and the worst place
/// inside `volume` (voxels) where the sides contradict each other.
pub(super) fn signed_distance(
    surface: &DistanceSurface,
    nodes: NodeBox,
    metric: DMat3,
    volume: Vec3,
    progress: &Progress,
) -> Result<(LevelField, Option<Contradiction>), Cancelled> {
    let tree = Tree::of(&surface.corners);
    let exact = |p: DVec3, guess: usize| tree.closest(p, guess, |n| surface.distance_squared(n, p));
    let coarse = Coarse::of(nodes, metric, surface, exact, progress)?;
    let mut values = vec![0.0f32; nodes.count()];
    let height = nodes.size[2];
    values.par_chunks_mut(height).enumerate().try_for_each(|(column, values)| {
        progress.check()?;
        let mut triangle = 0;
        for (z, value) in values.iter_mut().enumerate() {
            let node = column * height + z;
            let p = metric * nodes.place(node).as_dvec3();
            let index = nodes.index(node);
            if let Some(between) = coarse.between(index, p) {
                *value = between as f32;
                continue;
            }
            let around = coarse.around(index, p);
            triangle = surface.descend(around.best(surface, triangle, p), p);
            let mut signed = surface.signed(triangle, p);
            // Far from the surface a node lies on the side of the nodes around it; if not, it was followed to a wrong
            // place, such as the far side of a thin body.
            if around.least <= coarse.near || (signed < 0.0) != around.is_negative {
                triangle = exact(p, triangle);
                signed = surface.signed(triangle, p);
            }
            *value = signed as f32;
        }
        Ok(())
    })?;
    let found = contradiction(&values, nodes, metric, volume);
    Ok((LevelField { origin: nodes.origin, step: nodes.step, size: nodes.size, values }, found))
}

/// The closest triangles of some nodes of a box.
struct Coarse {
    /// Its nodes along each axis, as indices of the box, the last of it among them.
    lines: [Vec<usize>; 3],
    /// Metric place, closest triangle and signed distance of each, `[x][y][z]`.
    found: Vec<(DVec3, usize, f64)>,
    /// The gradient of the signed distance at each.
    gradients: Vec<DVec3>,
    /// Whether the distance in the cell that begins at each is interpolated.
    is_smooth: Vec<bool>,
    /// Metres within which the surface is near.
    near: f64,
}

/// What the coarse nodes around a place tell of it.
struct Around {
    /// Their closest triangles, each once.
    triangles: [usize; 8],
    count: usize,
    /// The surface is not nearer than this, m.
    least: f64,
    /// The side of the nearest of them.
    is_negative: bool,
}

impl Around {
    /// Of the triangles of the coarse nodes and one other, the closest to a place.
    fn best(&self, surface: &DistanceSurface, other: usize, p: DVec3) -> usize {
        let known = self.triangles[..self.count].iter().map(|&n| (surface.distance_squared(n, p), n));
        let other = (surface.distance_squared(other, p), other);
        known.fold(other, |best, found| if found.0 < best.0 { found } else { best }).1
    }
}

impl Coarse {
    fn of(
        nodes: NodeBox,
        metric: DMat3,
        surface: &DistanceSurface,
        exact: impl Fn(DVec3, usize) -> usize + Sync,
        progress: &Progress,
    ) -> Result<Self, Cancelled> {
        let lines = nodes.size.map(|count| {
            let inner = (0..count - 1).step_by(COARSE);
            inner.chain([count - 1]).collect::<Vec<_>>()
        });
        let height = lines[2].len();
        let mut found = vec![(DVec3::ZERO, 0, 0.0); lines[0].len() * lines[1].len() * height];
        found.par_chunks_mut(height).enumerate().try_for_each(|(column, found)| {
            progress.check()?;
            let (x, y) = (lines[0][column / lines[1].len()], lines[1][column % lines[1].len()]);
            let mut triangle = 0;
            for (&z, found) in lines[2].iter().zip(found) {
                let p = metric * nodes.place((x * nodes.size[1] + y) * nodes.size[2] + z).as_dvec3();
                // The triangle of the node above is a good first guess.
                triangle = exact(p, surface.descend(triangle, p));
                *found = (p, triangle, surface.signed(triangle, p));
            }
            Ok(())
        })?;
        let cell = [0, 1, 2].map(|axis| metric.col(axis) * f64::from(nodes.step[axis]));
        let diagonal = cell.map(|edge| edge.length_squared()).iter().sum::<f64>().sqrt();
        let gradients = found.par_iter().map(|&(p, triangle, _)| surface.gradient(triangle, p)).collect();
        let mut coarse = Self { lines, found, gradients, is_smooth: Vec::new(), near: NEAR * diagonal };
        coarse.is_smooth = (0..coarse.found.len()).into_par_iter().map(|first| coarse.is_smooth_cell(first)).collect();
        Ok(coarse)
    }

    /// Whether the corners of the cell that begins at a coarse node lie away from the surface, on one side of it, with
    /// gradients that are alike.
    fn is_smooth_cell(&self, first: usize) -> bool {
        let [nx, ny, nz] = [0, 1, 2].map(|axis: usize| self.lines[axis].len());
        let at = [first / (ny * nz), first / nz % ny, first % nz];
        if (0..3).any(|axis| at[axis] + 1 == [nx, ny, nz][axis]) {
            return false;
        }
        let corners = [0, 1, nz, nz + 1, ny * nz, ny * nz + 1, (ny + 1) * nz, (ny + 1) * nz + 1].map(|n| first + n);
        let (_, _, distance) = self.found[first];
        let is_away = |n: &usize| self.found[*n].2.abs() > self.near && (self.found[*n].2 < 0.0) == (distance < 0.0);
        let mean = corners.iter().map(|&n| self.gradients[n]).sum::<DVec3>().normalize_or_zero();
        corners.iter().all(is_away) && corners.iter().all(|&n| self.gradients[n].dot(mean) > ALIKE)
    }

    /// The first coarse node of the cell around the node `index` of the box.
    fn cell(&self, index: [usize; 3]) -> [usize; 3] {
        [0, 1, 2].map(|axis: usize| (index[axis] / COARSE).min(self.lines[axis].len() - 2))
    }

    /// The distance of the node `index` of the box, at the metric place `p`, from those of the coarse nodes around; `None`
    /// where these are no smooth function.
    fn between(&self, index: [usize; 3], p: DVec3) -> Option<f64> {
        let low = self.cell(index);
        let [_, ny, nz] = [0, 1, 2].map(|axis: usize| self.lines[axis].len());
        let first = (low[0] * ny + low[1]) * nz + low[2];
        if !self.is_smooth[first] {
            return None;
        }
        let share = |axis: usize| {
            let [from, to] = [0, 1].map(|n| self.lines[axis][low[axis] + n] as f64);
            (index[axis] as f64 - from) / (to - from)
        };
        let shares = [share(0), share(1), share(2)];
        let weight = |corner: usize| {
            let of = |axis: usize| if corner >> (2 - axis) & 1 == 1 { shares[axis] } else { 1.0 - shares[axis] };
            of(0) * of(1) * of(2)
        };
        let term = |corner: usize| {
            let n = first + ((corner >> 2) * ny + (corner >> 1 & 1)) * nz + (corner & 1);
            let (at, _, distance) = self.found[n];
            weight(corner) * (distance + 0.5 * self.gradients[n].dot(p - at))
        };
        Some((0..8).map(term).sum())
    }

    /// What the nodes around the node `index` of the box, at the metric place `p`, tell of it.
    fn around(&self, index: [usize; 3], p: DVec3) -> Around {
        let [_, ny, nz] = [0, 1, 2].map(|axis: usize| self.lines[axis].len());
        let low = self.cell(index);
        let node = |corner: usize| {
            let [x, y, z] = [low[0] + (corner >> 2), low[1] + (corner >> 1 & 1), low[2] + (corner & 1)];
            &self.found[(x * ny + y) * nz + z]
        };
        let is_second = |axis: usize| usize::from(index[axis] - self.lines[axis][low[axis]] > COARSE / 2);
        let &(at, _, distance) = node(is_second(0) << 2 | is_second(1) << 1 | is_second(2));
        let mut around =
            Around { triangles: [0; 8], count: 0, least: distance.abs() - at.distance(p), is_negative: distance < 0.0 };
        for corner in 0..8 {
            let triangle = node(corner).1;
            if !around.triangles[..around.count].contains(&triangle) {
                around.triangles[around.count] = triangle;
                around.count += 1;
            }
        }
        around
    }
}

/// The worst place inside the volume where the sign changes between two nodes that are both farther from the surface
/// than from each other.
fn contradiction(values: &[f32], nodes: NodeBox, metric: DMat3, volume: Vec3) -> Option<Contradiction> {
    let apart = [0, 1, 2].map(|axis| (metric.col(axis).length() * f64::from(nodes.step[axis])) as f32);
    let strides = [nodes.size[1] * nodes.size[2], nodes.size[2], 1];
    let mut worst: Option<(f32, usize)> = None;
    for node in 0..nodes.count() {
        let index = nodes.index(node);
        for axis in (0..3).filter(|&axis| index[axis] + 1 < nodes.size[axis]) {
            let (a, b) = (values[node], values[node + strides[axis]]);
            let gap = a.abs().min(b.abs()) / apart[axis];
            if (a >= 0.0) != (b >= 0.0) && gap > 1.0 && worst.is_none_or(|(least, _)| gap > least) {
                let p = nodes.place(node);
                if p.cmpge(Vec3::ZERO).all() && p.cmple(volume).all() {
                    worst = Some((gap, node));
                }
            }
        }
    }
    worst.map(|(_, node)| Contradiction { at: nodes.place(node) })
}

#[cfg(test)]
mod tests {
    use super::*;
    use survey::TriangleMesh;

    /// A sphere of triangles around `centre`.
    pub(super) fn ball(centre: DVec3, radius: f64, rings: u32) -> TriangleMesh {
        let columns = 2 * rings;
        let place = |ring: u32, column: u32| {
            let (polar, turn) = (
                f64::from(ring) / f64::from(rings) * std::f64::consts::PI,
                f64::from(column) / f64::from(columns) * std::f64::consts::TAU,
            );
            centre + radius * DVec3::new(polar.sin() * turn.cos(), polar.sin() * turn.sin(), polar.cos())
        };
        let vertices = (0..=rings).flat_map(|ring| (0..columns).map(move |column| place(ring, column))).collect();
        let at = |ring: u32, column: u32| ring * columns + column % columns;
        let cell = |ring: u32, c: u32| {
            [[at(ring, c), at(ring + 1, c), at(ring + 1, c + 1)], [at(ring, c), at(ring + 1, c + 1), at(ring, c + 1)]]
        };
        let triangles = (0..rings).flat_map(|ring| (0..columns).flat_map(move |c| cell(ring, c))).collect();
        TriangleMesh { vertices, triangles }
    }

    fn field(mesh: &TriangleMesh, low: f32, high: f32) -> (LevelField, Option<Contradiction>) {
        let surface = DistanceSurface::of(&OrientedMesh::of(mesh, 1e-6).unwrap());
        let nodes = NodeBox::covering(Vec3::splat(low), Vec3::splat(high), Vec3::ONE);
        signed_distance(&surface, nodes, DMat3::IDENTITY, Vec3::splat(high), &Progress::silent()).unwrap()
    }

    #[test]
    fn every_node_has_its_distance_from_a_sphere() {
        let (found, contradiction) = field(&ball(DVec3::splat(15.3), 9.0, 48), 0.0, 30.0);
        assert_eq!(contradiction, None);
        let off = |n: usize| (found.values[n] - (9.0 - found.place(n).distance(Vec3::splat(15.3)))).abs();
        let worst = (0..found.values.len()).map(off).fold(0.0, f32::max);
        // The triangles lie up to 9·(π/48)²/8 inside the sphere. In its middle all are nearly as close.
        assert!(worst < 0.03, "{worst}");
    }

    #[test]
    fn no_other_triangle_is_closer() {
        let mesh = ball(DVec3::new(11.0, 14.2, 9.7), 6.0, 9);
        let surface = DistanceSurface::of(&OrientedMesh::of(&mesh, 1e-6).unwrap());
        let (found, _) = field(&mesh, 0.0, 24.0);
        for n in (0..found.values.len()).step_by(37) {
            let p = found.place(n).as_dvec3();
            let distances = (0..surface.corners.len()).map(|t| surface.closest(t, p).point.distance(p));
            let least = distances.fold(f64::INFINITY, f64::min) as f32;
            assert!((found.values[n].abs() - least).abs() < 1e-4, "{p}: {} {least}", found.values[n]);
        }
    }

    #[test]
    fn what_is_followed_between_coarse_nodes_is_the_closest_point_of_a_rough_sheet() {
        // Picks jump by up to a voxel and a half from one corner to the next, on a fold.
        let (count, noise) = (41u32, |n: u32| f64::from(n.wrapping_mul(2_654_435_761) >> 16) / 65_536.0 - 0.5);
        let corner = |n: u32| {
            let (x, y) = (f64::from(n / count), f64::from(n % count));
            DVec3::new(x, y, 20.0 + 6.0 * (0.3 * x).sin() + 3.0 * (0.25 * y).cos() + 1.5 * noise(n))
        };
        let cell = |n: u32| {
            let a = n / (count - 1) * count + n % (count - 1);
            [[a, a + count, a + count + 1], [a, a + count + 1, a + 1]]
        };
        let mesh = TriangleMesh {
            vertices: (0..count * count).map(corner).collect(),
            triangles: (0..(count - 1) * (count - 1)).flat_map(cell).collect(),
        };
        let surface = DistanceSurface::of(&OrientedMesh::of(&mesh, 1e-6).unwrap());
        let (found, _) = field(&mesh, 0.0, 40.0);
        let mut off = Vec::new();
        for n in (0..found.values.len()).step_by(53) {
            let p = found.place(n).as_dvec3();
            let all = (0..surface.corners.len()).map(|t| (surface.distance_squared(t, p), t));
            let (least, closest) = all.fold((f64::INFINITY, 0), |best, t| if t.0 < best.0 { t } else { best });
            // At the border the distance is that from a plane, which is less.
            if surface.border[closest] == 0 {
                off.push((f64::from(found.values[n].abs()) - least.sqrt()).abs());
            }
        }
        off.sort_by(f64::total_cmp);
        let (most, nearly_all) = (off[off.len() - 1], off[off.len() * 99 / 100]);
        assert!(off.len() > 1000 && most < 0.2 && nearly_all < 0.03, "{} places: {nearly_all} {most}", off.len());
    }

    #[test]
    fn an_open_sheet_continues_straight_on() {
        let slope = |x: f64, y: f64| DVec3::new(x, y, 8.0 + 0.3 * x);
        let vertices = vec![slope(4.0, 4.0), slope(14.0, 4.0), slope(14.0, 14.0), slope(4.0, 14.0)];
        let sheet = TriangleMesh { vertices, triangles: vec![[0, 1, 2], [0, 2, 3]] };
        let (found, contradiction) = field(&sheet, 0.0, 18.0);
        assert_eq!(contradiction, None);
        let exact = |p: Vec3| (p.z - 8.0 - 0.3 * p.x) / 1.09f32.sqrt();
        assert!((0..found.values.len()).all(|n| (found.values[n] - exact(found.place(n))).abs() < 1e-3));
    }
}
