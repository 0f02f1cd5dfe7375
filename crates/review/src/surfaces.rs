//! Horizons and faults as triangles, decimated, with what that costs in metres.
//!
//! A horizon is sampled on a lattice in each fault block, where it bounds a layer; its triangles are cut where it ends, so
//! that its rim lies on the fault. A surface of any shape, and a fault, keeps its own triangles, or clusters of them.

use crate::model::{Mesh, Surface};
use crate::polygon::Welder;
use glam::{DVec2, DVec3, Vec3};
use model::StructuralModel;
use rayon::prelude::*;
use std::collections::HashMap;
use survey::block::part_behind;
use survey::{Quality, SurveyGeometry, TriangleMesh};
use ttf::Colour;

/// Distance above and below a horizon at which the layers are compared, samples.
const BESIDE: f64 = 0.05;
/// Halvings with which the end of a horizon is found between two nodes.
const HALVINGS: usize = 8;

/// A horizon of a model on a lattice of at most `nodes` along an axis.
pub(crate) fn horizon(
    model: &StructuralModel,
    geometry: &SurveyGeometry,
    (index, name, colour): (usize, &str, Colour),
    nodes: usize,
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
        let there: Vec<bool> = (0..counts[0] * counts[1])
            .map(|n| is_there(DVec2::new(at(n / counts[1], 0), at(n % counts[1], 1))))
            .collect();
        let (mut welder, mut deviations) = (Welder::default(), Vec::new());
        for x in 0..counts[0] - 1 {
            for y in 0..counts[1] - 1 {
                let node = |dx: usize, dy: usize| {
                    let own = there[(x + dx) * counts[1] + y + dy];
                    (DVec2::new(at(x + dx, 0), at(y + dy, 1)), own)
                };
                for corners in [[node(0, 0), node(1, 0), node(1, 1)], [node(0, 0), node(1, 1), node(0, 1)]] {
                    let piece: Vec<DVec3> = cut(&corners, &is_there).into_iter().map(place).collect();
                    if piece.len() > 2 {
                        let middle: DVec3 = piece.iter().sum::<DVec3>() / piece.len() as f64;
                        deviations.push((place(middle.truncate()).z - middle.z).abs());
                        for n in 0..piece.len() {
                            let between = (piece[n] + piece[(n + 1) % piece.len()]) * 0.5;
                            deviations.push((place(between.truncate()).z - between.z).abs());
                        }
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

/// The part of a triangle of the map in which a horizon is there.
fn cut(corners: &[(DVec2, bool); 3], is_there: &impl Fn(DVec2) -> bool) -> Vec<DVec2> {
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
    while mesh.triangles.len() > most {
        (mesh, deviation_m) = clustered(&whole, geometry, side);
        side *= 1.3;
    }
    let is_picked = vec![true; mesh.points.len()];
    Surface {
        name: name.to_owned(),
        colour,
        mesh,
        is_picked,
        picked_share: 1.0,
        deviation_m,
        usual_deviation_m: deviation_m,
    }
}

/// A mesh whose corners within a cube of so many voxels are one, in their middle; and the farthest that one was moved, m.
fn clustered(mesh: &Mesh, geometry: &SurveyGeometry, side: f64) -> (Mesh, f64) {
    let mut cells: HashMap<[i64; 3], (u32, DVec3, f64)> = HashMap::new();
    let key = |p: DVec3| (p / side).floor().to_array().map(|n| n as i64);
    let mut of_point = Vec::with_capacity(mesh.points.len());
    for p in &mesh.points {
        let next = cells.len() as u32;
        let cell = cells.entry(key(*p)).or_insert((next, DVec3::ZERO, 0.0));
        cell.1 += *p;
        cell.2 += 1.0;
        of_point.push(cell.0);
    }
    let mut points = vec![DVec3::ZERO; cells.len()];
    for (n, sum, count) in cells.into_values() {
        points[n as usize] = sum / count;
    }
    let metric = geometry.metric_from_voxel();
    let moved = mesh.points.iter().zip(&of_point).map(|(p, n)| (metric * (*p - points[*n as usize])).length());
    let deviation = moved.fold(0.0, f64::max);
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
