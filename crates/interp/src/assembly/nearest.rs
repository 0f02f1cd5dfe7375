//! The leaf closest to a picked point, by the exact distance to the triangles.
//!
//! The distance volume gives the same answer for voxels within its range. This search also finds the nearest
//! leaf when none is within range, needs no volume, and takes milliseconds: a triangle is within one cell of
//! its first vertex, so most triangles are excluded by that vertex alone.

use super::error::AssemblyError;
use super::leaf_of;
use crate::forest::Forest;
use glam::Vec3;
use rayon::prelude::*;

/// The leaf closest to a point.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ClosestLeaf {
    /// Leaf id, from 1.
    pub leaf: u32,
    /// Index of the triangle.
    pub triangle: u32,
    /// Distance of the point, voxels.
    pub distance: f32,
    /// The closest point of the triangle, voxels.
    pub nearest: Vec3,
}

/// Count of triangles that one task searches.
const CHUNK: usize = 1 << 16;

/// The leaf closest to the voxel position `at`, no farther than `max_distance` voxels; of equal distances the
/// first triangle. A position up to half a voxel outside the volume counts as inside.
///
/// # Errors
/// [`AssemblyError::Outside`], [`AssemblyError::Empty`] or [`AssemblyError::NothingNear`].
pub fn leaf_at(forest: &Forest, at: Vec3, max_distance: f32) -> Result<ClosestLeaf, AssemblyError> {
    let size = forest.surfaces.size;
    let inside = |c: f32, n: usize| c >= -0.5 && c <= n as f32 - 0.5;
    if !(inside(at.x, size[0]) && inside(at.y, size[1]) && inside(at.z, size[2])) {
        return Err(AssemblyError::Outside { at, size });
    }
    let vertices = &forest.surfaces.vertices;
    let closest = forest
        .surfaces
        .triangles
        .par_chunks(CHUNK)
        .enumerate()
        .filter_map(|(chunk, triangles)| {
            let mut best: Option<(f32, u32, Vec3)> = None;
            for (n, corners) in triangles.iter().enumerate() {
                let first = &vertices[corners[0] as usize];
                // The triangle reaches at most one trace beyond its first vertex.
                let off = (f32::from(first.x) - at.x).abs().max((f32::from(first.y) - at.y).abs()) - 1.0;
                if best.is_some_and(|(least, ..)| off > least) {
                    continue;
                }
                let place = |v: u32| {
                    let v = &vertices[v as usize];
                    Vec3::new(f32::from(v.x), f32::from(v.y), v.z)
                };
                let nearest = closest_point(corners.map(place), at);
                let distance = nearest.distance(at);
                if best.is_none_or(|(least, ..)| distance < least) {
                    best = Some((distance, (chunk * CHUNK + n) as u32, nearest));
                }
            }
            best
        })
        .min_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
    let (distance, triangle, nearest) = closest.ok_or(AssemblyError::Empty)?;
    let leaf = leaf_of(forest, triangle);
    if distance > max_distance {
        return Err(AssemblyError::NothingNear { at, max_distance, leaf, distance, nearest });
    }
    Ok(ClosestLeaf { leaf, triangle, distance, nearest })
}

/// The point of a triangle closest to `p`, by the region of the triangle's plane into which `p` projects.
fn closest_point([a, b, c]: [Vec3; 3], p: Vec3) -> Vec3 {
    let (ab, ac, ap) = (b - a, c - a, p - a);
    let (d1, d2) = (ab.dot(ap), ac.dot(ap));
    if d1 <= 0.0 && d2 <= 0.0 {
        return a;
    }
    let bp = p - b;
    let (d3, d4) = (ab.dot(bp), ac.dot(bp));
    if d3 >= 0.0 && d4 <= d3 {
        return b;
    }
    let cp = p - c;
    let (d5, d6) = (ab.dot(cp), ac.dot(cp));
    if d6 >= 0.0 && d5 <= d6 {
        return c;
    }
    let on_ab = d1 * d4 - d3 * d2;
    if on_ab <= 0.0 && d1 >= 0.0 && d3 <= 0.0 {
        return a + ab * (d1 / (d1 - d3));
    }
    let on_ac = d5 * d2 - d1 * d6;
    if on_ac <= 0.0 && d2 >= 0.0 && d6 <= 0.0 {
        return a + ac * (d2 / (d2 - d6));
    }
    let on_bc = d3 * d6 - d5 * d4;
    if on_bc <= 0.0 && d4 >= d3 && d5 >= d6 {
        return b + (c - b) * ((d4 - d3) / ((d4 - d3) + (d5 - d6)));
    }
    let sum = on_ab + on_ac + on_bc;
    a + ab * (on_ac / sum) + ac * (on_ab / sum)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_closest_point_is_no_farther_than_any_sample_of_the_triangle() {
        let corners = [Vec3::new(0.0, 0.0, 1.0), Vec3::new(1.0, 0.0, 2.5), Vec3::new(0.0, 1.0, -0.5)];
        for n in 0..2000u32 {
            let coordinate = |k: u32| (n.wrapping_mul(2_654_435_761).rotate_left(8 * k) % 1000) as f32 / 200.0 - 2.0;
            let p = Vec3::new(coordinate(0), coordinate(1), coordinate(2));
            let nearest = closest_point(corners, p);
            let least = (0..=40)
                .flat_map(|i| (0..=40 - i).map(move |j| (i as f32 / 40.0, j as f32 / 40.0)))
                .map(|(s, t)| (corners[0] + (corners[1] - corners[0]) * s + (corners[2] - corners[0]) * t).distance(p))
                .fold(f32::INFINITY, f32::min);
            let found = nearest.distance(p);
            assert!(found <= least + 1e-5 && found >= least - 0.06, "{p}: {found}, sampled {least}");
        }
    }
}
