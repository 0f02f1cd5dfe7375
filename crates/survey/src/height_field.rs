//! A single-valued C¹ surface z = h(x, y) over the voxel lattice, on which an extended horizon sheet is
//! evaluated.
//!
//! Nodes lie at integer voxel (x, y). Between them the surface is the Catmull–Rom bicubic through the nodes:
//! its normal is continuous, and it reproduces planes and the nodes themselves exactly. Outside the grid the
//! border cell is continued linearly. Everything that needs the position of a horizon (regions, sections, the
//! parameterization, the GPU) uses this one definition.

use glam::Vec2;

/// Nodes and origins lie nearer than this to voxel 0, so that their differences fit 32 bits.
pub const FAR: i32 = 1 << 29;

/// Heights in voxel z at integer lattice positions, `[x][y]`. Memory: 4 bytes per node.
#[derive(Debug, Clone, PartialEq)]
pub struct HeightField {
    /// Voxel (x, y) of node (0, 0); negative when the grid has a margin around the survey.
    pub origin: [i32; 2],
    /// Counts along x and y, at least 2 each.
    pub size: [usize; 2],
    /// Voxel z per node, `[x][y]`, all finite.
    pub z: Vec<f32>,
}

/// Value and derivatives of a height field at one position.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct HeightSample {
    /// h, voxel z.
    pub z: f32,
    /// (∂h/∂x, ∂h/∂y), voxels per voxel.
    pub gradient: Vec2,
    /// (∂²h/∂x², ∂²h/∂x∂y, ∂²h/∂y²); it jumps at cell borders.
    pub hessian: [f32; 3],
}

/// Catmull–Rom weights of the four nodes around a cell, with first and second derivatives, at fraction t.
#[inline]
fn cubic(t: f32) -> [[f32; 4]; 3] {
    let (t2, t3) = (t * t, t * t * t);
    [
        [
            0.5 * (-t3 + 2.0 * t2 - t),
            0.5 * (3.0 * t3 - 5.0 * t2 + 2.0),
            0.5 * (-3.0 * t3 + 4.0 * t2 + t),
            0.5 * (t3 - t2),
        ],
        [
            0.5 * (-3.0 * t2 + 4.0 * t - 1.0),
            0.5 * (9.0 * t2 - 10.0 * t),
            0.5 * (-9.0 * t2 + 8.0 * t + 1.0),
            0.5 * (3.0 * t2 - 2.0 * t),
        ],
        [-3.0 * t + 2.0, 9.0 * t - 5.0, -9.0 * t + 4.0, 3.0 * t - 1.0],
    ]
}

impl HeightField {
    /// A height field whose nodes are the values of a function of the integer voxel (x, y).
    ///
    /// ```
    /// # use survey::HeightField;
    /// let dipping = HeightField::from_fn([-2, -2], [20, 20], |x, y| 10.0 + 0.5 * x as f32 - 0.25 * y as f32);
    /// assert!((dipping.z_at(3.3, 7.7) - (10.0 + 0.5 * 3.3 - 0.25 * 7.7)).abs() < 1e-5);
    /// ```
    pub fn from_fn(origin: [i32; 2], size: [usize; 2], f: impl Fn(i32, i32) -> f32) -> Self {
        let z = (0..size[0] * size[1])
            .map(|n| f(origin[0] + (n / size[1]) as i32, origin[1] + (n % size[1]) as i32))
            .collect();
        Self { origin, size, z }
    }

    /// Height of the node at integer voxel (x, y), continued linearly outside the grid.
    #[inline]
    pub fn node(&self, x: i32, y: i32) -> f32 {
        let (u, v) = (x - self.origin[0], y - self.origin[1]);
        let (nu, nv) = (self.size[0] as i32, self.size[1] as i32);
        if u >= 0 && v >= 0 && u < nu && v < nv {
            return self.z[u as usize * self.size[1] + v as usize];
        }
        let (cu, cv) = (u.clamp(0, nu - 1), v.clamp(0, nv - 1));
        let at = |u: i32, v: i32| self.z[u as usize * self.size[1] + v as usize];
        // The slope between the border node and the next one inwards continues the surface.
        let iu = if u < 0 {
            1
        } else if u >= nu {
            nu - 2
        } else {
            cu
        };
        let iv = if v < 0 {
            1
        } else if v >= nv {
            nv - 2
        } else {
            cv
        };
        let slope_u = if iu == cu { 0.0 } else { (at(cu, cv) - at(iu, cv)) / (cu - iu) as f32 };
        let slope_v = if iv == cv { 0.0 } else { (at(cu, cv) - at(cu, iv)) / (cv - iv) as f32 };
        at(cu, cv) + slope_u * (u - cu) as f32 + slope_v * (v - cv) as f32
    }

    /// The 4 × 4 nodes around voxel (x, y) and the fractions inside the cell.
    #[inline]
    fn patch(&self, x: f32, y: f32) -> ([[f32; 4]; 4], f32, f32) {
        let (x0, y0) = (x.floor(), y.floor());
        let (fx, fy) = (x - x0, y - y0);
        // What is not a number, or far beyond any lattice, must not overflow below.
        let (x0, y0) = ((x0 as i32).clamp(-FAR, FAR), (y0 as i32).clamp(-FAR, FAR));
        let (u, v) = (x0 - 1 - self.origin[0], y0 - 1 - self.origin[1]);
        let mut patch = [[0.0; 4]; 4];
        if u >= 0 && v >= 0 && u + 4 <= self.size[0] as i32 && v + 4 <= self.size[1] as i32 {
            for (a, row) in patch.iter_mut().enumerate() {
                let start = (u as usize + a) * self.size[1] + v as usize;
                row.copy_from_slice(&self.z[start..start + 4]);
            }
        } else {
            for (a, row) in patch.iter_mut().enumerate() {
                for (b, value) in row.iter_mut().enumerate() {
                    *value = self.node(x0 - 1 + a as i32, y0 - 1 + b as i32);
                }
            }
        }
        (patch, fx, fy)
    }

    /// Whether nodes surround voxel (x, y): its height is a mean of these, in which some weights are below 0.
    #[inline]
    pub fn surrounds(&self, x: f32, y: f32) -> bool {
        let is_within = |at: f32, axis: usize| {
            let at = at - self.origin[axis] as f32;
            at >= 1.0 && at < self.size[axis] as f32 - 2.0
        };
        is_within(x, 0) && is_within(y, 1)
    }

    /// Height at voxel (x, y), voxel z.
    #[inline]
    pub fn z_at(&self, x: f32, y: f32) -> f32 {
        let (patch, fx, fy) = self.patch(x, y);
        let (wx, wy) = (cubic(fx)[0], cubic(fy)[0]);
        let row = |r: &[f32; 4]| r[0] * wy[0] + r[1] * wy[1] + r[2] * wy[2] + r[3] * wy[3];
        row(&patch[0]) * wx[0] + row(&patch[1]) * wx[1] + row(&patch[2]) * wx[2] + row(&patch[3]) * wx[3]
    }

    /// Height and its first and second derivatives at voxel (x, y).
    ///
    /// ```
    /// # use survey::HeightField;
    /// let dipping = HeightField::from_fn([0, 0], [8, 8], |x, y| 10.0 + 0.5 * x as f32 - 0.25 * y as f32);
    /// let sample = dipping.sample(3.5, 2.0);
    /// assert!((sample.z - 11.25).abs() < 1e-5);
    /// assert!((sample.gradient - glam::Vec2::new(0.5, -0.25)).length() < 1e-5);
    /// assert!(sample.hessian.iter().all(|second| second.abs() < 1e-5));
    /// ```
    #[inline]
    pub fn sample(&self, x: f32, y: f32) -> HeightSample {
        let (patch, fx, fy) = self.patch(x, y);
        let (wx, wy) = (cubic(fx), cubic(fy));
        let mut rows = [[0.0f32; 4]; 3];
        for (d, weights) in wy.iter().enumerate() {
            for (a, row) in patch.iter().enumerate() {
                rows[d][a] = row[0] * weights[0] + row[1] * weights[1] + row[2] * weights[2] + row[3] * weights[3];
            }
        }
        let dot = |w: &[f32; 4], r: &[f32; 4]| w[0] * r[0] + w[1] * r[1] + w[2] * r[2] + w[3] * r[3];
        HeightSample {
            z: dot(&wx[0], &rows[0]),
            gradient: Vec2::new(dot(&wx[1], &rows[0]), dot(&wx[0], &rows[1])),
            hessian: [dot(&wx[2], &rows[0]), dot(&wx[1], &rows[1]), dot(&wx[0], &rows[2])],
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn planes_are_exact_inside_and_outside() {
        let plane = |x: f32, y: f32| 40.0 + 0.7 * x - 0.3 * y;
        let field = HeightField::from_fn([-3, 2], [8, 9], |x, y| plane(x as f32, y as f32));
        for (x, y) in [(0.0, 5.0), (1.37, 6.21), (-2.9, 2.1), (4.0, 10.0), (-7.5, 15.25)] {
            let s = field.sample(x, y);
            assert!((s.z - plane(x, y)).abs() < 1e-4, "at {x}, {y}: {}", s.z);
            assert!((s.gradient - Vec2::new(0.7, -0.3)).length() < 1e-4);
            assert!((field.z_at(x, y) - s.z).abs() < 1e-5);
        }
    }

    #[test]
    fn derivatives_match_differences_on_a_quadratic() {
        let field = HeightField::from_fn([0, 0], [12, 12], |x, y| {
            0.05 * (x * x) as f32 + 0.02 * (x * y) as f32 - 0.03 * (y * y) as f32
        });
        let s = field.sample(5.4, 6.3);
        assert!((s.gradient - Vec2::new(0.1 * 5.4 + 0.02 * 6.3, 0.02 * 5.4 - 0.06 * 6.3)).length() < 1e-3);
        assert!(
            (s.hessian[0] - 0.1).abs() < 1e-3
                && (s.hessian[1] - 0.02).abs() < 1e-3
                && (s.hessian[2] + 0.06).abs() < 1e-3
        );
    }
}
