//! The Catmull–Rom tricubic of a field on the nodes of a box, and its derivatives: smooth to the first derivative, where
//! trilinear interpolation turns by h/2R between nodes at a spacing h on a surface of radius R.
//!
//! Nodes beyond the box continue the last two. Outside the box a place has the value of the nearest place of the box.

use glam::Vec3;
use survey::LevelField;

/// First node of a cell along an axis, and the weights of four nodes around it in the value and in the derivative per
/// cell.
struct Weights {
    nodes: [usize; 4],
    value: [f32; 4],
    slope: [f32; 4],
}

impl Weights {
    #[inline]
    fn of(at: f32, count: usize) -> Self {
        let at = at.clamp(0.0, (count - 1) as f32);
        let cell = (at as usize).min(count - 2);
        let t = at - cell as f32;
        let (t2, t3) = (t * t, t * t * t);
        let value = [
            0.5 * (2.0 * t2 - t - t3),
            0.5 * (3.0 * t3 - 5.0 * t2 + 2.0),
            0.5 * (4.0 * t2 + t - 3.0 * t3),
            0.5 * (t3 - t2),
        ];
        let slope = [
            0.5 * (4.0 * t - 1.0 - 3.0 * t2),
            0.5 * (9.0 * t2 - 10.0 * t),
            0.5 * (8.0 * t + 1.0 - 9.0 * t2),
            0.5 * (3.0 * t2 - 2.0 * t),
        ];
        // A node beyond the box: 2 · border − the one inside.
        let at_border = |[a, b, c, d]: [f32; 4]| {
            let [b, c] = if cell == 0 { [b + 2.0 * a, c - a] } else { [b, c] };
            let [b, c] = if cell + 2 == count { [b - d, c + 2.0 * d] } else { [b, c] };
            [if cell == 0 { 0.0 } else { a }, b, c, if cell + 2 == count { 0.0 } else { d }]
        };
        let nodes = [cell.saturating_sub(1), cell, cell + 1, (cell + 2).min(count - 1)];
        Self { nodes, value: at_border(value), slope: at_border(slope) }
    }
}

/// The value at a voxel position and its derivatives per voxel.
pub(crate) fn sample(field: &LevelField, p: Vec3) -> (f32, Vec3) {
    let at = (p - field.origin) / field.step;
    let [x, y, z] = [0, 1, 2].map(|axis: usize| Weights::of(at[axis], field.size[axis]));
    let [_, ny, nz] = field.size;
    let (mut value, mut slope) = (0.0, Vec3::ZERO);
    for a in 0..4 {
        // Value, and derivatives along y and z, of a plane.
        let mut plane = [0.0f32; 3];
        for b in 0..4 {
            let row = (x.nodes[a] * ny + y.nodes[b]) * nz;
            let node = z.nodes.map(|n| field.values[row + n]);
            let dot = |w: &[f32; 4]| w[0] * node[0] + w[1] * node[1] + w[2] * node[2] + w[3] * node[3];
            let (at, rise) = (dot(&z.value), dot(&z.slope));
            plane = [plane[0] + y.value[b] * at, plane[1] + y.slope[b] * at, plane[2] + y.value[b] * rise];
        }
        value += x.value[a] * plane[0];
        slope += Vec3::new(x.slope[a] * plane[0], x.value[a] * plane[1], x.value[a] * plane[2]);
    }
    (value, slope / field.step)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn field(f: impl Fn(Vec3) -> f32) -> LevelField {
        LevelField::from_fn(Vec3::new(-2.0, 3.0, 1.5), Vec3::new(0.5, 1.0, 2.0), [9, 6, 7], f)
    }

    #[test]
    fn what_is_linear_comes_back_to_the_border() {
        let f = |p: Vec3| 3.0 + 0.5 * p.x - 0.25 * p.y + 2.0 * p.z;
        let field = field(f);
        for p in [Vec3::new(0.3, 4.1, 9.0), Vec3::new(-2.0, 3.0, 1.5), Vec3::new(2.0, 8.0, 13.5)] {
            let (value, slopes) = sample(&field, p);
            assert!((value - f(p)).abs() < 1e-4, "{p}: {value}");
            assert!(slopes.abs_diff_eq(Vec3::new(0.5, -0.25, 2.0), 1e-4), "{p}: {slopes}");
        }
        assert_eq!(sample(&field, Vec3::splat(-9.0)).0, sample(&field, Vec3::new(-2.0, 3.0, 1.5)).0);
    }

    #[test]
    fn what_is_quadratic_comes_back_inside_with_its_derivatives() {
        let f = |p: Vec3| 0.3 * p.x * p.x - 0.2 * p.y * p.z + 0.1 * p.z * p.z;
        let field = field(f);
        for p in [Vec3::new(0.3, 5.1, 7.0), Vec3::new(-0.9, 4.6, 5.2)] {
            let (value, slopes) = sample(&field, p);
            let exact = Vec3::new(0.6 * p.x, -0.2 * p.z, 0.2 * p.z - 0.2 * p.y);
            assert!((value - f(p)).abs() < 1e-4 && slopes.abs_diff_eq(exact, 1e-4), "{p}: {value} {slopes}");
        }
    }
}
