//! Lengths and angles in metres, computed from voxel coordinates.
//!
//! With the voxel-to-metre matrix M, |M u|² = uᵀ G u for G = Mᵀ M. All that follows needs only G and its
//! inverse: the metric gradient of a function with voxel derivative c (a covector) is, as a voxel vector, G⁻¹
//! c.
//!
//! G is scaled by s² = |det M|^(2/3) so that f32 numbers stay near 1 for any bin size. A length in this
//! scaled metric times `unit_m` is in metres. Ratios of lengths do not depend on the scale.

use crate::ParamError;
use glam::{DMat3, DVec3, Mat3, Vec3};

/// The scaled metric tensor of voxel space.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Metric {
    g: Mat3,
    inverse: Mat3,
    map: DMat3,
    /// Metres per unit of the scaled metric.
    pub unit_m: f64,
}

impl Metric {
    /// From the linear part of the voxel-to-metre map; `exaggeration` stretches the vertical first.
    ///
    /// # Errors
    /// [`ParamError::DegenerateMetric`] when the matrix cannot be inverted.
    pub(crate) fn new(metres_from_voxel: DMat3, exaggeration: f64) -> Result<Self, ParamError> {
        let m = DMat3::from_diagonal(DVec3::new(1.0, 1.0, exaggeration)) * metres_from_voxel;
        let determinant = m.determinant();
        if !(determinant.abs() > 1e-12 && determinant.is_finite()) {
            return Err(ParamError::DegenerateMetric { determinant });
        }
        let unit_m = determinant.abs().cbrt();
        let g = m.transpose() * m * (1.0 / (unit_m * unit_m));
        Ok(Self { g: g.as_mat3(), inverse: g.inverse().as_mat3(), map: m * (1.0 / unit_m), unit_m })
    }

    /// The linear map from voxels to Cartesian coordinates in units of the scaled metric.
    pub(crate) fn scaled_from_voxel(&self) -> DMat3 {
        self.map
    }

    /// G u: the covector of voxel vector u.
    #[inline]
    pub(crate) fn lower(&self, u: Vec3) -> Vec3 {
        self.g * u
    }

    /// G⁻¹ c: the voxel vector of covector c.
    #[inline]
    pub(crate) fn raise(&self, c: Vec3) -> Vec3 {
        self.inverse * c
    }

    /// The first fundamental form of a surface with slopes (h_x, h_y): the products (xx, xy, yy) of the
    /// tangents (1, 0, h_x) and (0, 1, h_y).
    #[inline]
    pub(crate) fn tangents(&self, hx: f32, hy: f32) -> (f32, f32, f32) {
        let (x, y, z) = (self.g.x_axis, self.g.y_axis, self.g.z_axis);
        let (zx, zy) = (z.x + hx * z.z, z.y + hy * z.z);
        (x.x + hx * (z.x + zx), x.y + hx * z.y + hy * zx, y.y + hy * (z.y + zy))
    }

    /// The inverse of the metric tensor.
    pub(crate) fn inverse(&self) -> Mat3 {
        self.inverse
    }

    /// Squared scaled length of a voxel vector.
    #[inline]
    pub(crate) fn length_squared(&self, u: Vec3) -> f32 {
        u.dot(self.lower(u))
    }

    /// Scaled length of one voxel step along z.
    pub(crate) fn vertical_step(&self) -> f32 {
        self.g.z_axis.z.sqrt()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lengths_are_metres_in_a_sheared_survey() {
        let m = DMat3::from_cols(DVec3::new(12.0, 3.0, 0.0), DVec3::new(-5.0, 20.0, 0.0), DVec3::new(0.0, 0.0, 4.0));
        let metric = Metric::new(m, 1.0).unwrap();
        let u = Vec3::new(2.0, -3.0, 1.5);
        let expected = (m * u.as_dvec3()).length();
        let found = f64::from(metric.length_squared(u).sqrt()) * metric.unit_m;
        assert!((found - expected).abs() < 1e-4 * expected, "{found} m instead of {expected} m");
        assert!((metric.raise(metric.lower(u)) - u).length() < 1e-5);
    }

    #[test]
    fn a_flat_matrix_is_refused() {
        assert!(matches!(Metric::new(DMat3::ZERO, 1.0), Err(ParamError::DegenerateMetric { .. })));
    }
}
