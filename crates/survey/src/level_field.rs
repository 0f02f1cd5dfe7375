//! A function over a box of the voxel lattice whose level surfaces are horizons of any shape: overturned limbs, closed
//! bodies.
//!
//! It increases towards what is older, or into a body. Between nodes it is interpolated trilinearly: a surface of
//! curvature κ (1/voxel) is met within h²κ/8 voxels at a node spacing of h. Outside the box it has the value of the
//! nearest place of the box. Everything that needs the surface (regions, sections, the parameterization, the GPU) uses
//! this one definition.

use glam::Vec3;

/// Values at the nodes of a box. Memory: 4 bytes per node.
///
/// ```
/// use glam::Vec3;
/// use survey::LevelField;
/// // The distance from a sphere of 6 voxels, positive inside.
/// let ball = LevelField::from_fn(Vec3::splat(-10.0), Vec3::ONE, [21; 3], |p| 6.0 - p.length());
/// assert_eq!(ball.value(Vec3::new(0.0, 0.0, 4.0)), 2.0);
/// assert!(ball.value(Vec3::new(4.2, 0.0, 4.2)).abs() < 0.1);
/// assert!(ball.value(Vec3::new(100.0, 0.0, 0.0)) < 0.0);
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct LevelField {
    /// Voxel position of node (0, 0, 0).
    pub origin: Vec3,
    /// Voxels between nodes along x, y and z.
    pub step: Vec3,
    /// Counts along x, y and z, at least 2 each.
    pub size: [usize; 3],
    /// Value per node, `[x][y][z]`, all finite.
    pub values: Vec<f32>,
}

impl LevelField {
    /// The values of a function of the voxel position at the nodes of a box.
    pub fn from_fn(origin: Vec3, step: Vec3, size: [usize; 3], f: impl Fn(Vec3) -> f32) -> Self {
        let [nx, ny, nz] = size;
        let node = |n: usize| Vec3::new((n / (ny * nz)) as f32, (n / nz % ny) as f32, (n % nz) as f32);
        Self { origin, step, size, values: (0..nx * ny * nz).map(|n| f(origin + node(n) * step)).collect() }
    }

    /// Voxel position of a node.
    pub fn place(&self, node: usize) -> Vec3 {
        let [_, ny, nz] = self.size;
        let index = [node / (ny * nz), node / nz % ny, node % nz];
        self.origin + Vec3::from_array(index.map(|n| n as f32)) * self.step
    }

    /// First node of the cell around a voxel position, and the fractions inside the cell.
    #[inline]
    fn cell(&self, p: Vec3) -> (usize, Vec3) {
        let last = Vec3::from_array(self.size.map(|n| (n - 1) as f32));
        let at = ((p - self.origin) / self.step).clamp(Vec3::ZERO, last);
        let index = |axis: usize| (at[axis] as usize).min(self.size[axis] - 2);
        let [x, y, z] = [index(0), index(1), index(2)];
        let fraction = at - Vec3::new(x as f32, y as f32, z as f32);
        ((x * self.size[1] + y) * self.size[2] + z, fraction)
    }

    /// The values at the eight corners of the cell at `node`: index 4·x + 2·y + z.
    #[inline]
    fn corners(&self, node: usize) -> [f32; 8] {
        let (x, y) = (self.size[1] * self.size[2], self.size[2]);
        let v = &self.values;
        let pair = |n: usize| [v[n], v[n + 1]];
        let ([a, b], [c, d]) = (pair(node), pair(node + y));
        let ([e, f], [g, h]) = (pair(node + x), pair(node + x + y));
        [a, b, c, d, e, f, g, h]
    }

    /// The value at a voxel position.
    #[inline]
    pub fn value(&self, p: Vec3) -> f32 {
        let (node, f) = self.cell(p);
        let c = self.corners(node);
        let mix = |low: f32, high: f32, t: f32| low + (high - low) * t;
        let low = mix(mix(c[0], c[1], f.z), mix(c[2], c[3], f.z), f.y);
        let high = mix(mix(c[4], c[5], f.z), mix(c[6], c[7], f.z), f.y);
        mix(low, high, f.x)
    }

    /// Bounds of the values in a box of voxel positions, smallest first: those of the nodes of all cells that it meets.
    pub fn range(&self, low: Vec3, high: Vec3) -> [f32; 2] {
        let last = Vec3::from_array(self.size.map(|n| (n - 1) as f32));
        let first = ((low - self.origin) / self.step).floor().clamp(Vec3::ZERO, last);
        let end = ((high - self.origin) / self.step).ceil().clamp(Vec3::ZERO, last);
        let mut range = [f32::INFINITY, f32::NEG_INFINITY];
        for x in first.x as usize..=end.x as usize {
            for y in first.y as usize..=end.y as usize {
                let row = (x * self.size[1] + y) * self.size[2];
                for value in &self.values[row + first.z as usize..=row + end.z as usize] {
                    range = [range[0].min(*value), range[1].max(*value)];
                }
            }
        }
        range
    }

    /// The value at a voxel position and its derivatives per voxel.
    #[inline]
    pub fn sample(&self, p: Vec3) -> (f32, Vec3) {
        let (node, f) = self.cell(p);
        let c = self.corners(node);
        let mix = |low: f32, high: f32, t: f32| low + (high - low) * t;
        let along_z = [mix(c[0], c[1], f.z), mix(c[2], c[3], f.z), mix(c[4], c[5], f.z), mix(c[6], c[7], f.z)];
        let (low, high) = (mix(along_z[0], along_z[1], f.y), mix(along_z[2], along_z[3], f.y));
        let slope_y = mix(along_z[1] - along_z[0], along_z[3] - along_z[2], f.x);
        let slope_z = mix(mix(c[1] - c[0], c[3] - c[2], f.y), mix(c[5] - c[4], c[7] - c[6], f.y), f.x);
        (mix(low, high, f.x), Vec3::new(high - low, slope_y, slope_z) / self.step)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_linear_function_comes_back_with_its_slopes() {
        let f = |p: Vec3| 3.0 + 0.5 * p.x - 0.25 * p.y + 2.0 * p.z;
        let field = LevelField::from_fn(Vec3::new(-2.0, 3.0, 1.5), Vec3::new(0.5, 1.0, 2.0), [9, 5, 7], f);
        for p in [Vec3::new(0.3, 4.1, 9.0), Vec3::new(-2.0, 3.0, 1.5), Vec3::new(2.0, 7.0, 13.5)] {
            let (value, slopes) = field.sample(p);
            assert!((value - f(p)).abs() < 1e-4 && (field.value(p) - f(p)).abs() < 1e-4, "{p}: {value}");
            assert!(slopes.abs_diff_eq(Vec3::new(0.5, -0.25, 2.0), 1e-4), "{p}: {slopes}");
        }
        // Outside, the nearest place of the box.
        assert_eq!(field.value(Vec3::new(-9.0, 4.0, 5.0)), field.value(Vec3::new(-2.0, 4.0, 5.0)));
        assert_eq!(field.place(8), Vec3::new(-2.0, 4.0, 3.5));
    }

    #[test]
    fn values_in_a_box_lie_in_its_range() {
        let wave = |p: Vec3| (0.9 * p.x).sin() + (0.7 * p.y).cos() * p.z;
        let field = LevelField::from_fn(Vec3::splat(-1.0), Vec3::new(0.5, 1.0, 2.0), [13, 9, 5], wave);
        let boxes = [[Vec3::new(0.2, 0.4, 0.1), Vec3::new(1.7, 3.2, 4.4)], [Vec3::splat(-5.0), Vec3::splat(-0.9)]];
        for [low, high] in boxes {
            let [smallest, largest] = field.range(low, high);
            for n in 0..1000 {
                let part = Vec3::new((n % 10) as f32, (n / 10 % 10) as f32, (n / 100) as f32) / 9.0;
                let value = field.value(low + (high - low) * part);
                assert!(value >= smallest - 1e-5 && value <= largest + 1e-5, "{value} {smallest} {largest}");
            }
        }
    }
}
