//! Horizons and faults as triangles, decimated, with what that costs in metres.
//!
//! A horizon is sampled on a lattice in each fault block, where it bounds a layer. An edge of the lattice is halved while
//! the middle of it is too far from the horizon, whichever triangle asks, so that triangles meet without cracks; then
//! they are cut where the horizon ends, so that its rim lies on the fault. A surface of any shape, and a fault, keeps its
//! own triangles, or clusters of them.

use crate::model::{Mesh, Surface};
use crate::polygon::Welder;
use glam::{DVec2, DVec3, Vec3};
use model::StructuralModel;
use rayon::prelude::*;
use std::collections::HashMap;
use std::ops::{Add, Mul};
use survey::block::part_behind;
use survey::{Quality, SurveyGeometry, TriangleMesh};
use ttf::Colour;

/// Distance above and below a horizon at which the layers are compared, samples.
const BESIDE: f64 = 0.05;
/// Largest cube whose corners become one, voxels: the rim, which stays, may have more triangles than are wanted.
const COARSEST: f64 = 64.0;
/// Times that an edge is halved at most.
const FINEST: u32 = 5;
/// Weights of the corners at the places within a triangle at which it is compared with the horizon.
const WITHIN: [[f64; 3]; 4] = [[1.0 / 3.0; 3], [0.6, 0.2, 0.2], [0.2, 0.6, 0.2], [0.2, 0.2, 0.6]];
/// Longest edge of a triangle that is cut at the ground, voxels, and how far beside a fault rock is looked for.
const CUT_EDGE: f64 = 3.0;
/// Distance from a fault at which there is rock or air beside it, voxels.
const BESIDE_FAULT: f64 = 0.15;
/// Halvings with which the end of a horizon is found between two nodes.
const HALVINGS: usize = 8;

/// How finely a horizon is sampled.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Lattice {
    /// Nodes along an axis at first.
    pub nodes: usize,
    /// How far triangles may be from the horizon, samples.
    pub error: f64,
}

/// A horizon of a model.
pub(crate) fn horizon(
    model: &StructuralModel,
    geometry: &SurveyGeometry,
    (index, name, colour): (usize, &str, Colour),
    Lattice { nodes, error }: Lattice,
) -> Surface {
    let [nx, ny, nz] = model.size();
    let counts = [nx, ny].map(|size| size.min(nodes).max(2));
    let at = |n: usize, axis: usize| n as f64 * ([nx, ny][axis] - 1) as f64 / (counts[axis] - 1) as f64;
    let blocks: Vec<u16> = (0..model.block_count() as u16).filter(|b| model.level(index, *b).is_none()).collect();
    let parts = blocks.par_iter().map(|&block| {
        let place = |xy: DVec2| xy.extend(f64::from(model.horizon_z(index, block, xy.x as f32, xy.y as f32)));
        let is_there = |xy: DVec2| {
            let p = place(xy);
            if !(p.z >= 0.0 && p.z <= (nz - 1) as f64) {
                return false;
            }
            let beside = |off: f64| model.region_at((p + DVec3::Z * off).as_vec3());
            let [above, below] = [beside(-BESIDE), beside(BESIDE)];
            above.block == block && above.layer != below.layer
        };
        let is_off = |corners: &[DVec2]| {
            let z = |p: DVec2| place(p).z;
            let far = |weights: &[f64]| {
                let at: DVec2 = corners.iter().zip(weights).map(|(corner, weight)| *corner * *weight).sum();
                let flat: f64 = corners.iter().zip(weights).map(|(corner, weight)| z(*corner) * weight).sum();
                (z(at) - flat).abs() > error
            };
            let is_far = match corners {
                [a, b] => {
                    let count = (2.0 * a.distance(*b)).ceil().clamp(3.0, 11.0) as usize;
                    (1..=count).map(|n| n as f64 / (count + 1) as f64).any(|share| far(&[share, 1.0 - share]))
                }
                _ => WITHIN.iter().any(|weights| far(weights)),
            };
            let middle = corners.iter().sum::<DVec2>() / corners.len() as f64;
            is_far && (is_there(middle) || corners.iter().any(|corner| is_there(*corner)))
        };
        let (mut welder, mut deviations) = (Welder::default(), Vec::new());
        for x in 0..counts[0] - 1 {
            for y in 0..counts[1] - 1 {
                let node = |dx: usize, dy: usize| DVec2::new(at(x + dx, 0), at(y + dy, 1));
                let mut triangles = Vec::new();
                finer([node(0, 0), node(1, 0), node(1, 1)], FINEST, &is_off, &mut triangles);
                finer([node(0, 0), node(1, 1), node(0, 1)], FINEST, &is_off, &mut triangles);
                for corners in triangles {
                    let corners = corners.map(|corner| (corner, is_there(corner)));
                    let piece: Vec<DVec3> = cut(&corners, &is_there).into_iter().map(place).collect();
                    if piece.len() > 2 {
                        for n in 0..piece.len() {
                            let between = (piece[n] + piece[(n + 1) % piece.len()]) * 0.5;
                            deviations.push((place(between.truncate()).z - between.z).abs());
                        }
                        let middle: DVec3 = piece.iter().sum::<DVec3>() / piece.len() as f64;
                        deviations.push((place(middle.truncate()).z - middle.z).abs());
                        welder.add(&piece);
                    }
                }
            }
        }
        let quality = |p: &DVec3| model.quality_at(index, block, p.x as f32, p.y as f32);
        let is_picked: Vec<bool> =
            welder.mesh.points.iter().map(|p| matches!(quality(p), Quality::Picked | Quality::Tracked)).collect();
        (welder.mesh, is_picked, deviations)
    });
    let mut surface = Surface {
        name: name.to_owned(),
        colour,
        mesh: Mesh::default(),
        below: 0,
        is_picked: Vec::new(),
        picked_share: 1.0,
        deviation_m: 0.0,
        usual_deviation_m: 0.0,
    };
    let mut all = Vec::new();
    for (mesh, is_picked, deviations) in parts.collect::<Vec<_>>() {
        append(&mut surface.mesh, mesh);
        surface.is_picked.extend(is_picked);
        all.extend(deviations);
    }
    surface.below = surface.mesh.triangles.len();
    all.retain(|deviation| deviation.is_finite());
    all.sort_by(f64::total_cmp);
    let at = |share: f64| all.get((share * (all.len().max(1) - 1) as f64) as usize).copied().unwrap_or(0.0);
    surface.usual_deviation_m = at(0.99) * geometry.sample_m();
    surface.deviation_m = at(1.0) * geometry.sample_m();
    surface
}

fn append(mesh: &mut Mesh, other: Mesh) {
    let first = mesh.points.len() as u32;
    mesh.points.extend(other.points);
    mesh.triangles.extend(other.triangles.into_iter().map(|triangle| triangle.map(|n| n + first)));
}

/// The triangles of which one consists once each edge that is off is halved, at most `depth` times, and those whose middle
/// is off although their edges are not are divided there. `is_off` is asked of two corners or of three.
fn finer([a, b, c]: [DVec2; 3], depth: u32, is_off: &impl Fn(&[DVec2]) -> bool, triangles: &mut Vec<[DVec2; 3]>) {
    let halved = |p: DVec2, q: DVec2| (depth > 0 && is_off(&[p, q])).then(|| (p + q) * 0.5);
    let mut add = |triangle: [DVec2; 3]| finer(triangle, depth - 1, is_off, triangles);
    match [halved(a, b), halved(b, c), halved(c, a)] {
        [None, None, None] if depth > 0 && is_off(&[a, b, c]) => {
            let middle = (a + b + c) / 3.0;
            [[a, b, middle], [b, c, middle], [c, a, middle]].into_iter().for_each(add);
        }
        [None, None, None] => triangles.push([a, b, c]),
        [Some(u), Some(v), Some(w)] => [[a, u, w], [u, b, v], [w, v, c], [u, v, w]].into_iter().for_each(add),
        marks => {
            // Turned so that the first edge is halved, and the last is not.
            let corners = [a, b, c];
            let first = (0..3).find(|n| marks[*n].is_some() && marks[(n + 2) % 3].is_none()).unwrap_or(0);
            let [a, b, c] = [0, 1, 2].map(|n| corners[(first + n) % 3]);
            let u = (a + b) * 0.5;
            match marks[(first + 1) % 3] {
                Some(v) => [[u, b, v], [a, u, v], [a, v, c]].into_iter().for_each(add),
                None => [[a, u, c], [u, b, c]].into_iter().for_each(&mut add),
            }
        }
    }
}

/// The part of a triangle in which something is there.
fn cut<P: Point>(corners: &[(P, bool); 3], is_there: &impl Fn(P) -> bool) -> Vec<P> {
    let mut part = Vec::new();
    for n in 0..3 {
        let ((a, has_a), (b, has_b)) = (corners[n], corners[(n + 1) % 3]);
        if has_a {
            part.push(a);
        }
        if has_a != has_b {
            let (mut inside, mut outside) = if has_a { (a, b) } else { (b, a) };
            for _ in 0..HALVINGS {
                let middle = (inside + outside) * 0.5;
                if is_there(middle) { inside = middle } else { outside = middle }
            }
            part.push(inside);
        }
    }
    part
}

/// A point of the map or of space.
trait Point: Copy + Add<Output = Self> + Mul<f64, Output = Self> {}

impl Point for DVec2 {}
impl Point for DVec3 {}

/// A surface of triangles in world coordinates, inside the survey, with at most about so many triangles.
pub(crate) fn triangles(
    geometry: &SurveyGeometry,
    (name, colour): (&str, Colour),
    world: &TriangleMesh,
    most: usize,
) -> Surface {
    let last = geometry.size().map(|n| n.saturating_sub(1) as f64);
    let mut welder = Welder::default();
    for n in 0..world.triangles.len() {
        let mut piece = world.corners(n).map(|p| geometry.voxel_from_world(p)).to_vec();
        for axis in 0..3 {
            piece = part_behind(&part_behind(&piece, |p| -p[axis]), |p| p[axis] - last[axis]);
        }
        if piece.len() > 2 {
            welder.add(&piece);
        }
    }
    let whole = welder.mesh;
    let (mut mesh, mut deviation_m, mut side) = (whole.clone(), 0.0, 1.0);
    while mesh.triangles.len() > most && side < COARSEST {
        (mesh, deviation_m) = clustered(&whole, geometry, side);
        side *= 1.3;
    }
    let is_picked = vec![true; mesh.points.len()];
    Surface {
        name: name.to_owned(),
        colour,
        below: mesh.triangles.len(),
        mesh,
        is_picked,
        picked_share: 1.0,
        deviation_m,
        usual_deviation_m: deviation_m,
    }
}

/// Cuts a fault at the ground: its triangles below, where there is rock on either side, come first.
pub(crate) fn cut_at_ground(surface: &mut Surface, is_rock: impl Fn(DVec3) -> bool) {
    let (mut below, mut above) = (Welder::default(), Welder::default());
    for triangle in &surface.mesh.triangles {
        let corners = triangle.map(|n| surface.mesh.points[n as usize]);
        let [a, b, c] = corners;
        let across = (b - a).cross(c - a).normalize_or_zero() * BESIDE_FAULT;
        let is_below = |p: DVec3| is_rock(p + across) || is_rock(p - across);
        let mut pieces = vec![corners];
        while let Some([a, b, c]) = pieces.pop() {
            let has = [a, b, c].map(is_below);
            let longest = (a - b).length().max((b - c).length()).max((c - a).length());
            if has[0] == has[1] && has[1] == has[2] {
                if has[0] { below.add(&[a, b, c]) } else { above.add(&[a, b, c]) }
            } else if longest > CUT_EDGE {
                let [u, v, w] = [(a + b) * 0.5, (b + c) * 0.5, (c + a) * 0.5];
                pieces.extend([[a, u, w], [u, b, v], [w, v, c], [u, v, w]]);
            } else {
                let corners = [(a, has[0]), (b, has[1]), (c, has[2])];
                below.add(&cut(&corners, &is_below));
                above.add(&cut(&corners.map(|(p, has)| (p, !has)), &|p| !is_below(p)));
            }
        }
    }
    surface.below = below.mesh.triangles.len();
    surface.mesh = below.mesh;
    append(&mut surface.mesh, above.mesh);
    surface.is_picked = vec![true; surface.mesh.points.len()];
}

/// A mesh whose inner corners within a cube of so many voxels are one, in their middle; and the farthest that one was moved
/// off the surface, m. Corners of the rim stay where they are.
fn clustered(mesh: &Mesh, geometry: &SurveyGeometry, side: f64) -> (Mesh, f64) {
    let metric = geometry.metric_from_voxel();
    let mut edges: HashMap<[u32; 2], u32> = HashMap::new();
    let mut normals = vec![DVec3::ZERO; mesh.points.len()];
    for triangle in &mesh.triangles {
        let [a, b, c] = triangle.map(|n| metric * mesh.points[n as usize]);
        for n in 0..3 {
            normals[triangle[n] as usize] += (b - a).cross(c - a);
            let [p, q] = [triangle[n], triangle[(n + 1) % 3]];
            *edges.entry([p.min(q), p.max(q)]).or_default() += 1;
        }
    }
    let mut is_rim = vec![false; mesh.points.len()];
    edges.iter().filter(|(_, count)| **count == 1).flat_map(|(ends, _)| ends).for_each(|n| is_rim[*n as usize] = true);
    // A corner of the rim is by itself, any other with those of its cube.
    let mut cells: HashMap<(bool, [i64; 3]), (u32, DVec3, f64)> = HashMap::new();
    let mut of_point = Vec::with_capacity(mesh.points.len());
    for (n, p) in mesh.points.iter().enumerate() {
        let next = cells.len() as u32;
        let cube = (*p / side).floor().to_array().map(|n| n as i64);
        let key = if is_rim[n] { (true, [n as i64, 0, 0]) } else { (false, cube) };
        let cell = cells.entry(key).or_insert((next, DVec3::ZERO, 0.0));
        cell.1 += *p;
        cell.2 += 1.0;
        of_point.push(cell.0);
    }
    let mut points = vec![DVec3::ZERO; cells.len()];
    for (n, sum, count) in cells.into_values() {
        points[n as usize] = sum / count;
    }
    let off = |n: usize| {
        let moved = metric * (mesh.points[n] - points[of_point[n] as usize]);
        moved.dot(normals[n].normalize_or_zero()).abs()
    };
    let deviation = (0..mesh.points.len()).map(off).fold(0.0, f64::max);
    let kept = mesh.triangles.iter().map(|triangle| triangle.map(|n| of_point[n as usize]));
    let mut triangles: Vec<[u32; 3]> = kept.filter(|[a, b, c]| a != b && b != c && c != a).collect();
    triangles.sort_unstable();
    triangles.dedup();
    (Mesh { points, triangles }, deviation)
}

/// Whether a point lies in a survey of this size.
pub(crate) fn is_inside(p: DVec3, size: [usize; 3]) -> bool {
    let last = Vec3::from_array(size.map(|n| n.saturating_sub(1) as f32)).as_dvec3();
    p.cmpge(DVec3::splat(-1e-6)).all() && p.cmple(last + 1e-6).all()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Triangles that were made finer cover the same area, and meet at common corners.
    #[test]
    fn finer_triangles_meet_without_cracks() {
        let height = |p: DVec2| (p - 3.0).length().min(2.0);
        let is_off = |corners: &[DVec2]| {
            let count = corners.len() as f64;
            let middle = corners.iter().sum::<DVec2>() / count;
            (height(middle) - corners.iter().map(|corner| height(*corner)).sum::<f64>() / count).abs() > 0.02
        };
        let (mut triangles, corner) = (Vec::new(), |x: usize, y: usize| DVec2::new(2.0 * x as f64, 2.0 * y as f64));
        for (x, y) in (0..9).map(|n| (n / 3, n % 3)) {
            let [a, b, c, d] = [corner(x, y), corner(x + 1, y), corner(x + 1, y + 1), corner(x, y + 1)];
            finer([a, b, c], FINEST, &is_off, &mut triangles);
            finer([a, c, d], FINEST, &is_off, &mut triangles);
        }
        let area: f64 = triangles.iter().map(|[a, b, c]| 0.5 * (*b - *a).perp_dot(*c - *a)).sum();
        assert!((area - 36.0).abs() < 1e-9 && triangles.len() > 60, "{area} {}", triangles.len());
        let key = |p: DVec2| [p.x, p.y].map(|c| (c * 1e6).round() as i64);
        let mut edges: HashMap<[[i64; 2]; 2], usize> = HashMap::new();
        for triangle in &triangles {
            for n in 0..3 {
                let mut ends = [key(triangle[n]), key(triangle[(n + 1) % 3])];
                ends.sort_unstable();
                *edges.entry(ends).or_default() += 1;
            }
        }
        let is_rim =
            |ends: &[[i64; 2]; 2]| (0..2).any(|n| ends[0][n] == ends[1][n] && [0, 6_000_000].contains(&ends[0][n]));
        assert!(edges.iter().all(|(ends, count)| *count == if is_rim(ends) { 1 } else { 2 }));
    }

    #[test]
    fn a_fault_is_cut_at_the_ground() {
        let corner = |x: f64, z: f64| DVec3::new(x, 0.3 * z, z);
        let points = vec![corner(0.0, 0.0), corner(20.0, 0.0), corner(20.0, 16.0), corner(0.0, 16.0)];
        let mesh = Mesh { points, triangles: vec![[0, 1, 2], [0, 2, 3]] };
        let mut surface = Surface {
            name: String::new(),
            colour: Colour::WHITE,
            below: 2,
            mesh,
            is_picked: vec![true; 4],
            picked_share: 1.0,
            deviation_m: 0.0,
            usual_deviation_m: 0.0,
        };
        let area = |surface: &Surface, triangles: &[[u32; 3]]| -> f64 {
            let corner = |n: u32| surface.mesh.points[n as usize];
            triangles
                .iter()
                .map(|[a, b, c]| 0.5 * (corner(*b) - corner(*a)).cross(corner(*c) - corner(*a)).length())
                .sum()
        };
        let whole = area(&surface, surface.shown(false));
        // The ground is at 6 on one side and at 4 on the other: the fault stands bare between them.
        cut_at_ground(&mut surface, |p| p.z > if p.y > 0.3 * p.z { 6.0 } else { 4.0 });
        assert!((area(&surface, surface.shown(false)) - whole).abs() < 2e-3 * whole);
        let share = area(&surface, surface.shown(true)) / whole;
        assert!((share - 0.75).abs() < 0.01, "{share}");
    }
}
