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
//! Nodes lie on a lattice of columns ([`FlowLattice`]) and on levels evenly spaced in v.

use crate::metric::Metric;
use glam::{Mat3, Vec3};
use rayon::prelude::*;

/// A layer thinner than this (voxels) is taken to be as thick: it has no area, and its flow is that of its neighbours.
const THINNEST: f32 = 0.05;

/// Columns of nodes over a region.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct FlowLattice {
    /// Voxel column of node (0, 0).
    pub origin: [i32; 2],
    /// Voxels between nodes along x and y.
    pub spacing: [f32; 2],
    /// Counts of nodes along x and y, at least 3.
    pub size: [usize; 2],
}

impl FlowLattice {
    /// Nodes every `stride` voxels, from one column of nodes before a region's first voxel column to one after its last.
    pub(crate) fn new(first: [i32; 2], columns: [usize; 2], stride: usize) -> Self {
        Self {
            origin: first.map(|first| first - stride as i32),
            spacing: [stride as f32; 2],
            size: columns.map(|count| (count - 1).div_ceil(stride) + 3),
        }
    }

    /// A lattice over the same area with about `factor` times the spacing.
    pub(crate) fn coarser(self, factor: usize) -> Self {
        let size = self.size.map(|count| (count - 1).div_ceil(factor).max(2) + 1);
        let spacing = [0, 1].map(|n: usize| self.spacing[n] * (self.size[n] - 1) as f32 / (size[n] - 1) as f32);
        Self { size, spacing, ..self }
    }

    /// Voxel (x, y) of a node.
    pub(crate) fn place(&self, node: usize) -> [f32; 2] {
        let at = [node / self.size[1], node % self.size[1]];
        [0, 1].map(|n: usize| self.origin[n] as f32 + at[n] as f32 * self.spacing[n])
    }
}

/// A layer on the nodes of a lattice.
pub(crate) struct SigmaLayer {
    /// The columns of nodes.
    pub lattice: FlowLattice,
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
pub(crate) struct SigmaTerms {
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
    /// The layer between two sheets, given by voxel z at voxel (x, y).
    pub(crate) fn new(
        lattice: FlowLattice,
        levels: usize,
        [bottom, top]: [&(dyn Fn(f32, f32) -> f32 + Sync); 2],
        metric: &Metric,
    ) -> Self {
        let [hx, hy] = lattice.spacing;
        let pair = |node: usize| {
            let [x, y] = lattice.place(node);
            let jet = |height: &dyn Fn(f32, f32) -> f32| {
                let at = |a: f32, b: f32| height(x + a * hx, y + b * hy);
                let centre = at(0.0, 0.0);
                let (west, east, south, north) = (at(-1.0, 0.0), at(1.0, 0.0), at(0.0, -1.0), at(0.0, 1.0));
                let slope = [0.5 * (east - west) / hx, 0.5 * (north - south) / hy];
                let bend = [
                    ((east - centre) + (west - centre)) / (hx * hx),
                    0.25 * (at(1.0, 1.0) - at(1.0, -1.0) - at(-1.0, 1.0) + at(-1.0, -1.0)) / (hx * hy),
                    ((north - centre) + (south - centre)) / (hy * hy),
                ];
                (centre, slope, bend)
            };
            let (_, bottom_slope, bottom_bend) = jet(bottom);
            let (thickness, thickness_slope, thickness_bend) = jet(&|x, y| (bottom(x, y) - top(x, y)).max(THINNEST));
            SheetPair { thickness, bottom_slope, thickness_slope, bottom_bend, thickness_bend }
        };
        let columns = (0..lattice.size[0] * lattice.size[1]).into_par_iter().map(pair).collect();
        Self { lattice, levels, columns, inverse: metric.inverse() }
    }

    /// v of a level.
    pub(crate) fn v(&self, level: usize) -> f32 {
        level as f32 / (self.levels - 1) as f32
    }

    /// Thickness at a node, voxels.
    pub(crate) fn thickness(&self, node: usize) -> f32 {
        self.columns[node].thickness
    }

    /// Slopes of the thickness at a node.
    pub(crate) fn thickness_slope(&self, node: usize) -> [f32; 2] {
        self.columns[node].thickness_slope
    }

    /// The coefficients at a node and level.
    #[inline]
    pub(crate) fn terms(&self, node: usize, level: usize) -> SigmaTerms {
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
        let drift =
            h.x_axis.x * xx + 2.0 * h.x_axis.y * xy + h.y_axis.y * yy + 2.0 * (h.x_axis.z * xz + h.y_axis.z * yz);
        let cross = *h * slope;
        SigmaTerms { slope, cross, across: slope.dot(cross), drift }
    }

    /// ∇f, a covector of voxel space, of values at nodes `[x][y][level]`: central differences, one-sided at the borders.
    pub(crate) fn gradient(&self, f: &[f32], node: usize, level: usize) -> Vec3 {
        let at = |node: usize, level: usize| f[node * self.levels + level];
        let along = |axis: usize| self.difference(node, axis, |node| at(node, level));
        let rise = self.rise(level, |level| at(node, level));
        self.terms(node, level).slope * rise + Vec3::new(along(0), along(1), 0.0)
    }

    /// The difference of nodal values along x or y at constant v, per voxel.
    #[inline]
    pub(crate) fn difference(&self, node: usize, axis: usize, at: impl Fn(usize) -> f32) -> f32 {
        let (low, high, nodes) = match self.beside(node, axis) {
            [Some(low), Some(high)] => (low, high, 2.0),
            [None, Some(high)] => (node, high, 1.0),
            [Some(low), None] => (low, node, 1.0),
            [None, None] => return 0.0,
        };
        (at(high) - at(low)) / (nodes * self.lattice.spacing[axis])
    }

    /// The derivative along v of a column's values at a level.
    #[inline]
    pub(crate) fn rise(&self, level: usize, at: impl Fn(usize) -> f32) -> f32 {
        let per_level = (self.levels - 1) as f32;
        match level {
            0 => per_level * (-1.5 * at(0) + 2.0 * at(1) - 0.5 * at(2)),
            _ if level + 1 == self.levels => per_level * (1.5 * at(level) - 2.0 * at(level - 1) + 0.5 * at(level - 2)),
            _ => 0.5 * per_level * (at(level + 1) - at(level - 1)),
        }
    }

    /// The nodes next to `node` along an axis, before and after it; `None` outside.
    #[inline]
    pub(crate) fn beside(&self, node: usize, axis: usize) -> [Option<usize>; 2] {
        let [nx, ny] = self.lattice.size;
        let (at, count, step) = if axis == 0 { (node / ny, nx, ny) } else { (node % ny, ny, 1) };
        [(at > 0).then(|| node - step), (at + 1 < count).then(|| node + step)]
    }
}
