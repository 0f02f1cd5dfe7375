//! One fault as a height field over its best-fit plane, continued through the whole volume.
//!
//! w = g(u, v) in metric space, with g the Catmull–Rom bicubic of a regular grid (the same kernel as
//! horizons), so the side of the fault that a place lies on is the sign of w − g(u, v). A second grid holds
//! the signed distance to the rim of the interpreted extent. Beyond its tip a fault is virtual: it shapes the
//! parameterization and is never drawn.

use glam::{DMat3, DVec3};
use survey::height_field::HeightField;

/// Width of the rim of a fault's extent, cells: places on a stick are on it in spite of rounding.
const RIM_CELLS: f64 = 0.1;

/// One fault, continued through the whole volume.
///
/// `frame_from_voxel · p + frame_offset` is (u, v, w) of voxel position p: u and v in cells of the grids, w
/// in metres along the plane's normal.
#[derive(Debug, Clone, PartialEq)]
pub struct FaultSurface {
    /// Name of the fault.
    pub name: String,
    /// Linear part of voxel → (u cells, v cells, w m).
    pub frame_from_voxel: DMat3,
    /// Constant part of voxel → (u cells, v cells, w m).
    pub frame_offset: DVec3,
    /// Metres between grid nodes.
    pub spacing_m: f64,
    /// g at the grid nodes, m.
    pub surface: HeightField,
    /// Signed distance to the rim of the interpreted extent at the same nodes, m; positive inside (real),
    /// negative beyond the tip.
    pub extent: HeightField,
}

impl FaultSurface {
    /// (u cells, v cells, w m) of a voxel position.
    pub fn frame(&self, p: DVec3) -> DVec3 {
        self.frame_from_voxel * p + self.frame_offset
    }

    /// Signed offset of a voxel position from the extended surface along the plane's normal, m.
    pub fn side(&self, p: DVec3) -> f64 {
        let q = self.frame(p);
        q.z - f64::from(self.surface.z_at(q.x as f32, q.y as f32))
    }

    /// Gradient of [`Self::side`] in voxel space, m per voxel.
    pub fn side_gradient(&self, p: DVec3) -> DVec3 {
        let q = self.frame(p);
        let slope = self.surface.sample(q.x as f32, q.y as f32).gradient;
        self.frame_from_voxel.transpose() * DVec3::new(-f64::from(slope.x), -f64::from(slope.y), 1.0)
    }

    /// Signed distance to the rim of the interpreted extent, m, positive inside; of the place reached along
    /// the plane's normal.
    pub fn extent_at(&self, p: DVec3) -> f64 {
        let q = self.frame(p);
        f64::from(self.extent.z_at(q.x as f32, q.y as f32))
    }

    /// Whether the fault was interpreted at the place that is reached along the plane's normal: within its rim, which
    /// counts as part of it, so that a section through the last stick shows the fault.
    pub(crate) fn is_interpreted_at(&self, p: DVec3) -> bool {
        self.extent_at(p) >= -RIM_CELLS * self.spacing_m
    }

    /// An upper bound of |∂g| along the plane, m per m.
    pub(super) fn steepest(&self) -> f64 {
        let [nu, nv] = self.surface.size;
        let z = &self.surface.z;
        let mut worst = 0.0f32;
        for i in 0..nu {
            for j in 0..nv {
                let n = i * nv + j;
                let du = if i + 1 < nu { (z[n + nv] - z[n]).abs() } else { 0.0 };
                let dv = if j + 1 < nv { (z[n + 1] - z[n]).abs() } else { 0.0 };
                worst = worst.max(du.hypot(dv));
            }
        }
        // A Catmull–Rom cubic is at most 1.5 times as steep as the steepest of its three chords (with their
        // signs mixed).
        2.0 * f64::from(worst) / self.spacing_m
    }
}
