//! A rectangle anywhere in the volume, with its own coordinates (s, t).

use glam::{DVec2, DVec3};

/// A rectangle on a plane: (s, t) in [0, extent] lies at voxel position origin + s·s_axis + t·t_axis.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SectionPlane {
    /// Voxel position of (s, t) = (0, 0).
    pub origin: DVec3,
    /// Voxels per unit of s.
    pub s_axis: DVec3,
    /// Voxels per unit of t.
    pub t_axis: DVec3,
    /// Largest s and t.
    pub extent: [f64; 2],
}

impl SectionPlane {
    /// The inline section at voxel x over the box from `low` to `high`: s = y − low.y, t = z − low.z.
    pub fn inline(x: f64, low: DVec3, high: DVec3) -> Self {
        let extent = [high.y - low.y, high.z - low.z];
        Self { origin: DVec3::new(x, low.y, low.z), s_axis: DVec3::Y, t_axis: DVec3::Z, extent }
    }

    /// The crossline section at voxel y over the box from `low` to `high`: s = x − low.x, t = z − low.z.
    pub fn crossline(y: f64, low: DVec3, high: DVec3) -> Self {
        let extent = [high.x - low.x, high.z - low.z];
        Self { origin: DVec3::new(low.x, y, low.z), s_axis: DVec3::X, t_axis: DVec3::Z, extent }
    }

    /// The horizontal section at voxel z over the box from `low` to `high`: s = x − low.x, t = y − low.y.
    pub fn slice(z: f64, low: DVec3, high: DVec3) -> Self {
        let extent = [high.x - low.x, high.y - low.y];
        Self { origin: DVec3::new(low.x, low.y, z), s_axis: DVec3::X, t_axis: DVec3::Y, extent }
    }

    /// Voxel position of (s, t).
    pub fn voxel(&self, st: DVec2) -> DVec3 {
        self.origin + self.s_axis * st.x + self.t_axis * st.y
    }

    /// Whether the rectangle is finite and has an area.
    pub fn is_proper(&self) -> bool {
        let area = (self.s_axis * self.extent[0]).cross(self.t_axis * self.extent[1]).length();
        self.origin.is_finite()
            && self.extent.iter().all(|e| *e > 0.0 && e.is_finite())
            && area > 0.0
            && area.is_finite()
    }

    /// Cells of about a voxel along s and t.
    pub(super) fn cells(&self) -> [usize; 2] {
        // At least 16, so that a curve stays a curve when a few voxels fill the page; at most 4096 for
        // memory's sake.
        let count = |axis: DVec3, extent: f64| (axis.length() * extent).ceil().clamp(16.0, 4096.0) as usize;
        [count(self.s_axis, self.extent[0]), count(self.t_axis, self.extent[1])]
    }
}
