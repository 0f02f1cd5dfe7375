//! The line along which a surface of any shape turns away from a viewer.

use super::LevelSurface;
use glam::Vec3;
use rayon::prelude::*;

/// Side of the bricks that are looked through only where the surface may run, voxels.
const BRICK: usize = 4;
/// How far to both sides of a node the function is compared, voxels: the field is linear between its nodes, so its slope at
/// a place alone has steps.
const BESIDE: f32 = 1.5;
/// The corners of the six tetrahedra of a cell around its diagonal, as bits x = 4, y = 2, z = 1.
const TETRAHEDRA: [[usize; 4]; 6] =
    [[0, 1, 3, 7], [0, 1, 5, 7], [0, 2, 3, 7], [0, 2, 6, 7], [0, 4, 5, 7], [0, 4, 6, 7]];
/// The faces of a tetrahedron.
const FACES: [[usize; 3]; 4] = [[0, 1, 2], [0, 1, 3], [0, 2, 3], [1, 2, 3]];

impl LevelSurface {
    /// The line, in segments within cells of one voxel, along which the surface between `low` and `high` (voxels) faces
    /// neither to nor from the viewer. `towards` returns the direction to the viewer from a place, in voxels.
    pub fn silhouette(&self, low: Vec3, high: Vec3, towards: impl Fn(Vec3) -> Vec3 + Sync) -> Vec<[Vec3; 2]> {
        let first = low.floor();
        let cells = (high.ceil() - first).max(Vec3::ONE);
        let bricks = (cells / BRICK as f32).ceil().to_array().map(|n| n as usize);
        let of_brick = |n: usize| {
            let at = [n / (bricks[1] * bricks[2]), n / bricks[2] % bricks[1], n % bricks[2]];
            let corner = first + Vec3::from_array(at.map(|i| (i * BRICK) as f32));
            if self.may_cross(corner, corner + BRICK as f32) { self.in_brick(corner, &towards) } else { Vec::new() }
        };
        (0..bricks.iter().product()).into_par_iter().flat_map_iter(of_brick).collect()
    }

    /// The direction to the older side, or into the body, at a place near the surface: without the steps that the slope has
    /// between the nodes of the field.
    pub fn inwards(&self, p: Vec3) -> Vec3 {
        let along = |axis: Vec3| self.field.value(p + axis * BESIDE) - self.field.value(p - axis * BESIDE);
        Vec3::new(along(Vec3::X), along(Vec3::Y), along(Vec3::Z)).normalize_or_zero()
    }

    /// The segments in the cells of one brick.
    fn in_brick(&self, corner: Vec3, towards: &impl Fn(Vec3) -> Vec3) -> Vec<[Vec3; 2]> {
        const NODES: usize = BRICK + 1;
        let place =
            |n: usize| corner + Vec3::new((n / (NODES * NODES)) as f32, (n / NODES % NODES) as f32, (n % NODES) as f32);
        // Each node: the function, and how it grows towards the viewer.
        let both = |n: usize| {
            let p = place(n);
            let d = towards(p).normalize_or_zero() * BESIDE;
            [self.field.value(p) - self.at, self.field.value(p + d) - self.field.value(p - d)]
        };
        let nodes: Vec<[f32; 2]> = (0..NODES * NODES * NODES).map(both).collect();
        let mut segments = Vec::new();
        for cell in 0..BRICK * BRICK * BRICK {
            let [x, y, z] = [cell / (BRICK * BRICK), cell / BRICK % BRICK, cell % BRICK];
            let node = |bits: usize| ((x + bits / 4) * NODES + y + bits / 2 % 2) * NODES + z + bits % 2;
            let changes = |which: usize| {
                let below = (0..8).filter(|&bits| nodes[node(bits)][which] < 0.0).count();
                below > 0 && below < 8
            };
            if !changes(0) || !changes(1) {
                continue;
            }
            for corners in TETRAHEDRA.map(|tetrahedron| tetrahedron.map(node)) {
                let ends: Vec<Vec3> = FACES
                    .iter()
                    .filter_map(|face| {
                        let [a, b, c] = face.map(|n| corners[n]);
                        let weights = common_zero([nodes[a], nodes[b], nodes[c]])?;
                        Some(place(a) * weights.x + place(b) * weights.y + place(c) * weights.z)
                    })
                    .collect();
                // A line through an edge meets two faces in one place.
                let farthest =
                    |from: Vec3| ends.iter().copied().max_by(|p, q| from.distance(*p).total_cmp(&from.distance(*q)));
                let start = ends.first().and_then(|first| farthest(*first));
                if let Some((start, end)) =
                    start.and_then(|start| Some((start, farthest(start)?))).filter(|(a, b)| a != b)
                {
                    segments.push([start, end]);
                }
            }
        }
        segments
    }
}

/// Where on a triangle two linear functions, given at its corners, are both zero: the weights of the corners.
fn common_zero([a, b, c]: [[f32; 2]; 3]) -> Option<Vec3> {
    let across = |p: [f32; 2], q: [f32; 2]| p[0] * q[1] - p[1] * q[0];
    let weights = Vec3::new(across(b, c), across(c, a), across(a, b));
    let sum = weights.element_sum();
    let shares = weights / sum;
    let is_within = sum.abs() > f32::MIN_POSITIVE && shares.cmpge(Vec3::ZERO).all();
    is_within.then_some(shares)
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::sync::Arc;
    use survey::LevelField;

    #[test]
    fn the_silhouette_of_a_ball_is_the_circle_in_the_plane_across_the_view() {
        let (centre, radius) = (Vec3::new(10.2, 11.1, 9.7), 6.0);
        let field = LevelField::from_fn(Vec3::ZERO, Vec3::ONE, [22; 3], |p| radius - p.distance(centre));
        let ball = LevelSurface { field: Arc::new(field), at: 0.0, scale_m: 1.0, own: 0 };
        for towards in [Vec3::Z, Vec3::new(1.0, 2.0, -3.0), Vec3::new(-0.3, 0.1, 0.9)] {
            let segments = ball.silhouette(Vec3::ZERO, Vec3::splat(21.0), |_| towards);
            let length: f32 = segments.iter().map(|[a, b]| a.distance(*b)).sum();
            assert!((length / (std::f32::consts::TAU * radius) - 1.0).abs() < 0.03, "{towards}: {length}");
            for p in segments.iter().flatten().map(|p| *p - centre) {
                assert!((p.length() - radius).abs() < 0.08, "{towards}: {p} is {} from the centre", p.length());
                assert!(p.dot(towards.normalize()).abs() < 0.12, "{towards}: {p}");
            }
            // The line is closed: every end belongs to two segments.
            let mut ends: Vec<[i32; 3]> =
                segments.iter().flatten().map(|p| (*p * 1024.0).round().as_ivec3().to_array()).collect();
            ends.sort_unstable();
            let alone = ends.chunk_by(|a, b| a == b).filter(|group| group.len() == 1).count();
            assert!(alone * 50 < ends.len(), "{alone} of {} ends are open", ends.len());
        }
        assert!(ball.silhouette(Vec3::ZERO, Vec3::splat(3.0), |_| Vec3::Z).is_empty());
    }
}
