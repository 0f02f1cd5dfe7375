//! A layer between two sheets in (x, y, v), with v = (bottom − z)/thickness, and the Laplacian there.
//!
//! With the thickness t = bottom − top in voxels, derivatives at constant z are ∂ₐ + vₐ ∂ᵥ for a = x, y, and vz ∂ᵥ, where
//!
//! ```text
//! vₐ = (∂ₐ bottom − v ∂ₐt)/t        vz = −1/t        v_ab = (∂ₐ∂_b bottom − v ∂ₐ∂_b t − vₐ ∂_b t − v_b ∂ₐt)/t
//! ```
//!
//! With H, the inverse of the metric tensor, the Laplacian of f(x, y, v) is
//!
//! ```text
//! Σ H_ab f_ab + 2 Σ Cₐ f_av + D f_vv + F f_v        C = H∇v,  D = ∇v·H∇v,  F = Σ H_ab v_ab
//! ```
//!
//! Nodes are voxel columns every `stride` voxels, from one column of nodes outside the region's grid, and levels evenly
//! spaced in v.

use crate::metric::Metric;
use glam::{Mat3, Vec3};

/// A layer thinner than this (voxels) is taken to be as thick: it has no area, and its flow is that of its neighbours.
const THINNEST: f32 = 0.05;

/// A layer on the nodes of a lattice.
pub struct SigmaLayer {
    /// Voxel column of node (0, 0).
    pub origin: [i32; 2],
    /// Voxels between nodes.
    pub stride: usize,
    /// Counts of nodes along x and y.
    pub size: [usize; 2],
    /// Count of levels, odd.
    pub levels: usize,
    /// The sheets at each node `[x][y]`.
    columns: Vec<SheetPair>,
    /// H.
    pub inverse: Mat3,
}

/// Both sheets at one node: thickness, and derivatives of the bottom and of the thickness, per voxel.
#[derive(Debug, Clone, Copy)]
struct SheetPair {
    thickness: f32,
    bottom_slope: [f32; 2],
    thickness_slope: [f32; 2],
    /// xx, xy, yy.
    bottom_bend: [f32; 3],
    thickness_bend: [f32; 3],
}

/// ∇v, and the coefficients of the Laplacian, at a node and level.
#[derive(Debug, Clone, Copy)]
pub struct SigmaTerms {
    /// ∇v, a covector of voxel space.
    pub slope: Vec3,
    /// C = H∇v.
    pub cross: Vec3,
    /// D.
    pub across: f32,
    /// F.
    pub drift: f32,
}

impl SigmaLayer {
    /// The layer over `size` voxel columns from `origin` between two sheets, given by voxel z at a voxel column.
    pub fn new(
        [origin, end]: [[i32; 2]; 2],
        stride: usize,
        levels: usize,
        bottom: impl Fn(i32, i32) -> f32,
        top: impl Fn(i32, i32) -> f32,
        metric: &Metric,
    ) -> Self {
        let step = stride as i32;
        let origin = origin.map(|first| first - step);
        let size: [usize; 2] = std::array::from_fn(|n| ((end[n] - origin[n]) as usize).div_ceil(stride) + 2);
        let column = |n: usize| [origin[0] + (n / size[1]) as i32 * step, origin[1] + (n % size[1]) as i32 * step];
        let pair = |n: usize| {
            let [x, y] = column(n);
            let jet = |height: &dyn Fn(i32, i32) -> f32| {
                let at = |a: i32, b: i32| height(x + a * step, y + b * step);
                let (h, centre) = (stride as f32, at(0, 0));
                let slope = [(at(1, 0) - at(-1, 0)) / (2.0 * h), (at(0, 1) - at(0, -1)) / (2.0 * h)];
                let bend = [
                    ((at(1, 0) - centre) + (at(-1, 0) - centre)) / (h * h),
                    (at(1, 1) - at(1, -1) - at(-1, 1) + at(-1, -1)) / (4.0 * h * h),
                    ((at(0, 1) - centre) + (at(0, -1) - centre)) / (h * h),
                ];
                (centre, slope, bend)
            };
            let thickness = |x: i32, y: i32| (bottom(x, y) - top(x, y)).max(THINNEST);
            let (_, bottom_slope, bottom_bend) = jet(&bottom);
            let (thickness, thickness_slope, thickness_bend) = jet(&thickness);
            SheetPair { thickness, bottom_slope, thickness_slope, bottom_bend, thickness_bend }
        };
        let columns = (0..size[0] * size[1]).map(pair).collect();
        Self { origin, stride, size, levels, columns, inverse: metric.inverse() }
    }

    /// v of a level.
    pub fn v(&self, level: usize) -> f32 {
        level as f32 / (self.levels - 1) as f32
    }

    /// Thickness at a node, voxels.
    pub fn thickness(&self, node: usize) -> f32 {
        self.columns[node].thickness
    }

    /// Slopes of the thickness at a node.
    pub fn thickness_slope(&self, node: usize) -> [f32; 2] {
        self.columns[node].thickness_slope
    }

    /// The coefficients at a node and level.
    #[inline]
    pub fn terms(&self, node: usize, level: usize) -> SigmaTerms {
        let pair = &self.columns[node];
        let v = self.v(level);
        let inverse = 1.0 / pair.thickness;
        let [vx, vy] = [0, 1].map(|a| (pair.bottom_slope[a] - v * pair.thickness_slope[a]) * inverse);
        let slope = Vec3::new(vx, vy, -inverse);
        let [tx, ty] = pair.thickness_slope;
        let bend = |n: usize, mixed: f32| (pair.bottom_bend[n] - v * pair.thickness_bend[n] - mixed) * inverse;
        let (xx, xy, yy) = (bend(0, 2.0 * vx * tx), bend(1, vx * ty + vy * tx), bend(2, 2.0 * vy * ty));
        let (xz, yz) = (tx * inverse * inverse, ty * inverse * inverse);
        let h = &self.inverse;
        let drift = h.x_axis.x * xx
            + 2.0 * h.x_axis.y * xy
            + h.y_axis.y * yy
            + 2.0 * (h.x_axis.z * xz + h.y_axis.z * yz);
        let cross = *h * slope;
        SigmaTerms { slope, cross, across: slope.dot(cross), drift }
    }

    /// The nodes next to `node` along an axis, before and after it; `None` outside.
    #[inline]
    pub fn beside(&self, node: usize, axis: usize) -> [Option<usize>; 2] {
        let [nx, ny] = self.size;
        let (at, count, step) = if axis == 0 { (node / ny, nx, ny) } else { (node % ny, ny, 1) };
        [(at > 0).then(|| node - step), (at + 1 < count).then(|| node + step)]
    }
}
