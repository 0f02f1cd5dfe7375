//! A sheet prepared for fast evaluation: value, slope and curvature of the Catmull–Rom bicubic in one pass.
//!
//! The surface is that of [`survey::HeightField`] (same nodes, same weights). Two things are added. A border
//! of linearly continued nodes keeps evaluations past the outer boundary on the fast path. Evaluation is
//! *relative* to a column and a height ([`ColumnFrame`]), so that f32 keeps its precision far from the
//! origin: differences of nearby numbers are formed first, on the nodes, where they are exact.

use glam::{Mat4, Vec2, Vec4};
use survey::HeightField;

/// Width of the border of continued nodes on each side of the height field, voxels.
const BORDER: i32 = 32;

/// Origin of relative coordinates: an integer voxel column and a height.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct ColumnFrame {
    /// Voxel x, y.
    pub column: [i32; 2],
    /// Voxel z.
    pub z: f32,
}

/// The 2-jet of a surface at one place: its height, slope and curvature. The height is relative to the frame.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub(crate) struct Jet {
    /// h − frame.z, voxels.
    pub h: f32,
    /// (h_x, h_y).
    pub gradient: Vec2,
    /// (h_xx, h_xy, h_yy).
    pub hessian: [f32; 3],
}

impl Jet {
    /// The second-order continuation of this jet by `step` voxels.
    #[inline]
    pub(crate) fn moved(&self, step: Vec2) -> Self {
        let [xx, xy, yy] = self.hessian;
        let curve = Vec2::new(xx * step.x + xy * step.y, xy * step.x + yy * step.y);
        Self {
            h: self.h + step.dot(self.gradient + 0.5 * curve),
            gradient: self.gradient + curve,
            hessian: self.hessian,
        }
    }
}

/// A sheet as a bicubic surface with a border, shifted vertically. Memory: 4 bytes a node.
#[derive(Debug, Clone)]
pub(crate) struct BicubicSheet {
    origin: [i32; 2],
    size: [i32; 2],
    /// Counts of 4 × 4 patches along x and y.
    inner: [u32; 2],
    z: Vec<f32>,
    field: HeightField,
    shift: f32,
}

/// Catmull–Rom weights and their first two derivatives at fraction t.
#[inline]
fn weights(t: f32) -> [Vec4; 3] {
    let (a, b, c, d) = (
        Vec4::new(0.0, 1.0, 0.0, 0.0),
        Vec4::new(-0.5, 0.0, 0.5, 0.0),
        Vec4::new(1.0, -2.5, 2.0, -0.5),
        Vec4::new(-0.5, 1.5, -1.5, 0.5),
    );
    [a + t * (b + t * (c + t * d)), b + t * (2.0 * c + (3.0 * t) * d), 2.0 * c + (6.0 * t) * d]
}

/// Largest integer not above `value`, and the rest in [0, 1). Values beyond ±10⁶ saturate.
#[inline]
fn split(value: f32) -> (i32, f32) {
    let value = value.clamp(-1e6, 1e6);
    let truncated = value as i32;
    let floor = truncated - i32::from((truncated as f32) > value);
    (floor, value - floor as f32)
}

impl BicubicSheet {
    /// Copies a sheet, lowered by `shift` voxels of z.
    pub(crate) fn new(field: &HeightField, shift: f32) -> Self {
        let origin = [field.origin[0] - BORDER, field.origin[1] - BORDER];
        let size = field.size.map(|n| n as i32 + 2 * BORDER);
        let z = (0..size[0])
            .flat_map(|x| (0..size[1]).map(move |y| field.node(origin[0] + x, origin[1] + y) + shift))
            .collect();
        let inner = size.map(|n| (n - 3) as u32);
        Self { origin, size, inner, z, field: field.clone(), shift }
    }

    /// Voxel z of the node at an integer column.
    pub(crate) fn node(&self, x: i32, y: i32) -> f32 {
        let (u, v) = (x - self.origin[0], y - self.origin[1]);
        if u >= 0 && v >= 0 && u < self.size[0] && v < self.size[1] {
            self.z[(u * self.size[1] + v) as usize]
        } else {
            self.field.node(x, y) + self.shift
        }
    }

    /// Extent of the height field's own nodes: first column and counts.
    pub(crate) fn extent(&self) -> ([i32; 2], [usize; 2]) {
        (self.field.origin, self.field.size)
    }

    /// The jet at `at`, voxels from the frame's column.
    #[inline]
    pub(crate) fn jet(&self, frame: ColumnFrame, at: Vec2) -> Jet {
        let ((cell_x, fx), (cell_y, fy)) = (split(at.x), split(at.y));
        let (u, v) = (frame.column[0] + cell_x - 1 - self.origin[0], frame.column[1] + cell_y - 1 - self.origin[1]);
        let inside = (u as u32) < self.inner[0] && (v as u32) < self.inner[1];
        let rows = if inside {
            let stride = self.size[1] as usize;
            let nodes = &self.z[u as usize * stride + v as usize..];
            // Four loads of four nodes; loading the last row first leaves one bounds check.
            let row = |a: usize| Vec4::from_slice(&nodes[a * stride..]);
            let last = row(3);
            [row(0), row(1), row(2), last]
        } else {
            self.outer_rows(u + self.origin[0], v + self.origin[1])
        };
        let base = Vec4::splat(frame.z);
        let rows = [rows[0] - base, rows[1] - base, rows[2] - base, rows[3] - base];
        let (wx, wy) = (weights(fx), weights(fy));
        let along = |w: Vec4| rows[0] * w.x + rows[1] * w.y + rows[2] * w.z + rows[3] * w.w;
        let (value, slope, curve) = (along(wx[0]), along(wx[1]), along(wx[2]));
        // Six sums over four products each; a transposition turns four of them into three additions.
        let sums = Mat4::from_cols(value * wy[0], slope * wy[0], value * wy[1], curve * wy[0]).transpose();
        let first = (sums.x_axis + sums.y_axis) + (sums.z_axis + sums.w_axis);
        Jet {
            h: first.x,
            gradient: Vec2::new(first.y, first.z),
            hessian: [first.w, slope.dot(wy[1]), value.dot(wy[2])],
        }
    }

    #[cold]
    fn outer_rows(&self, x: i32, y: i32) -> [Vec4; 4] {
        [0, 1, 2, 3].map(|a| Vec4::from_array([0, 1, 2, 3].map(|b| self.node(x + a, y + b))))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_surface_is_the_height_fields() {
        let field = HeightField::from_fn([-3, 4], [30, 25], |x, y| {
            600.0 + 8.0 * (0.3 * x as f32).sin() + 5.0 * (0.2 * (x + 2 * y) as f32).cos()
        });
        let surface = BicubicSheet::new(&field, 1.5);
        let frame = ColumnFrame { column: [7, 11], z: 590.0 };
        for (x, y) in [(7.0, 11.0), (3.25, 8.75), (11.9, 20.1), (-20.5, 11.3), (-200.5, 400.25), (26.4, 28.9)] {
            let jet = surface.jet(frame, Vec2::new(x - 7.0, y - 11.0));
            let sample = field.sample(x, y);
            assert!((jet.h + frame.z - sample.z - 1.5).abs() < 5e-3, "height at {x}, {y}");
            assert!((jet.gradient - sample.gradient).length() < 2e-3, "slope at {x}, {y}");
            for d in 0..3 {
                assert!((jet.hessian[d] - sample.hessian[d]).abs() < 2e-3, "curvature at {x}, {y}");
            }
        }
    }

    #[test]
    fn a_moved_jet_is_the_quadratic() {
        let field = HeightField::from_fn([0, 0], [20, 20], |x, y| 0.05 * (x * x) as f32 + 0.02 * (x * y) as f32);
        let surface = BicubicSheet::new(&field, 0.0);
        let frame = ColumnFrame { column: [8, 8], z: 0.0 };
        let moved = surface.jet(frame, Vec2::new(0.2, 0.3)).moved(Vec2::new(0.3, -0.1));
        let there = surface.jet(frame, Vec2::new(0.5, 0.2));
        assert!((moved.h - there.h).abs() < 1e-4 && (moved.gradient - there.gradient).length() < 1e-4);
    }
}
