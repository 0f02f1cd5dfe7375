//! Where the restored horizon lies afterwards: a plane, level or with a dip.
//!
//! Spaces: voxels; z = level + slope · (x, y).

use glam::{DMat3, DVec2, DVec3};
use serde::{Deserialize, Serialize};
use survey::SurveyGeometry;

/// How the restored horizon lies.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Datum {
    /// Level.
    #[default]
    Flat,
    /// As the plane that fits the horizon best, by least squares.
    Regional,
    /// With a stated dip.
    Dipping {
        /// Its dip, degrees.
        dip: f64,
        /// The direction in which it deepens, degrees clockwise from north (Y).
        direction: f64,
    },
}

/// A plane in voxels: z = level + slope · (x, y).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct DatumPlane {
    /// Depth at voxel (0, 0).
    pub level: f64,
    /// Its gradient, voxels per voxel.
    pub slope: DVec2,
}

impl DatumPlane {
    /// Its depth at voxel (x, y).
    pub fn z_at(&self, at: DVec2) -> f64 {
        self.level + self.slope.dot(at)
    }

    /// The plane that a horizon is laid on, whose nodes (voxels) are given, or `None` without any. It passes through the mean of
    /// the nodes, or through `depth` (voxels) in the middle of the survey.
    ///
    /// ```
    /// use glam::{DVec2, DVec3};
    /// use restore::{Datum, DatumPlane};
    /// use survey::{SurveyGeometry, VerticalUnit};
    ///
    /// let geometry = SurveyGeometry::regular([11, 11, 51], 10.0, 10.0, VerticalUnit::Metres);
    /// let nodes: Vec<DVec3> = (0..121).map(|n| DVec3::new((n / 11) as f64, (n % 11) as f64, 20.0 + 0.5 * (n / 11) as f64)).collect();
    /// let flat = DatumPlane::of(Datum::Flat, &geometry, &nodes, None).unwrap();
    /// assert!((flat.level - 22.5).abs() < 1e-9 && flat.slope == DVec2::ZERO);
    /// let regional = DatumPlane::of(Datum::Regional, &geometry, &nodes, None).unwrap();
    /// assert!((regional.level - 20.0).abs() < 1e-9 && (regional.slope - DVec2::new(0.5, 0.0)).length() < 1e-9);
    /// let east = Datum::Dipping { dip: 45.0, direction: 90.0 };
    /// let dipping = DatumPlane::of(east, &geometry, &nodes, Some(30.0)).unwrap();
    /// assert!((dipping.z_at(DVec2::new(6.0, 0.0)) - 31.0).abs() < 1e-9);
    /// ```
    pub fn of(datum: Datum, geometry: &SurveyGeometry, nodes: &[DVec3], depth: Option<f64>) -> Option<Self> {
        if nodes.is_empty() {
            return None;
        }
        let mean = nodes.iter().sum::<DVec3>() / nodes.len() as f64;
        let slope = match datum {
            Datum::Flat => DVec2::ZERO,
            Datum::Regional => least_squares(nodes, mean),
            Datum::Dipping { dip, direction } => {
                let down = DVec2::from_angle((90.0 - direction).to_radians()) * dip.to_radians().tan();
                DVec2::new(down.dot(geometry.inline_vector), down.dot(geometry.crossline_vector)) / geometry.sample_m()
            }
        };
        let [nx, ny, _] = geometry.size().map(|count| count.saturating_sub(1) as f64);
        let (at, z) = depth.map_or((mean.truncate(), mean.z), |depth| (0.5 * DVec2::new(nx, ny), depth));
        Some(Self { level: z - slope.dot(at), slope })
    }
}

/// The gradient of the plane through nodes that fits them best.
fn least_squares(nodes: &[DVec3], mean: DVec3) -> DVec2 {
    let mut moments = DMat3::ZERO;
    for node in nodes {
        let off = *node - mean;
        moments += DMat3::from_cols(off * off.x, off * off.y, off * off.z);
    }
    let (xx, yy, xy) = (moments.x_axis.x, moments.y_axis.y, moments.x_axis.y);
    let (xz, yz) = (moments.x_axis.z, moments.y_axis.z);
    let determinant = xx * yy - xy * xy;
    // Nodes on one line have no slope across it.
    if determinant <= 1e-9 * xx.max(yy).powi(2) {
        return if xx >= yy { DVec2::new(xz / xx.max(1e-12), 0.0) } else { DVec2::new(0.0, yz / yy) };
    }
    DVec2::new(yy * xz - xy * yz, xx * yz - xy * xz) / determinant
}
