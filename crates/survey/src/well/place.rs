//! A well in a survey: its path in voxels, and its position relative to the survey.

use super::Well;
use super::checkshot::TimeDepth;
use crate::geometry::{SurveyGeometry, VerticalUnit};
use glam::DVec3;
use serde::Serialize;

/// Longest step between points of a path that is drawn, m. An arc of 3°/30 m departs from such a chord by a
/// centimetre.
const STEP_M: f64 = 10.0;

/// A point of a well in line numbers and vertical values of the survey.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct TopPlace {
    /// Measured depth, m.
    pub md_m: f64,
    /// X, Y and TVDSS, m.
    pub position: DVec3,
    /// Inline and crossline number, fractional.
    pub lines: [f64; 2],
    /// Vertical value, in the survey's unit.
    pub z: f64,
    /// Whether it lies inside the survey.
    pub inside: bool,
}

/// The position of a well relative to a survey.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct WellPlacement {
    /// Its first station.
    pub head: TopPlace,
    /// Its last station.
    pub total_depth: TopPlace,
    /// First and last measured depth inside the survey, m; `None` when the well passes beside it.
    pub inside_md_m: Option<[f64; 2]>,
    /// Share of its length inside the survey.
    pub inside_share: f64,
    /// How depths were converted to vertical values.
    pub time_depth: TimeDepth,
}

impl Well {
    /// X, Y and TVDSS (m) at a measured depth (m); None outside the surveyed range.
    pub fn position_at_md(&self, md_m: f64) -> Option<DVec3> {
        self.path.position_at_md(md_m)
    }

    /// How its depths become vertical values of the survey.
    pub fn time_depth(&self, geometry: &SurveyGeometry) -> TimeDepth {
        match (geometry.vertical.unit, &self.checkshot) {
            (VerticalUnit::Metres, _) => TimeDepth::Depth,
            (VerticalUnit::Milliseconds, Some(_)) => TimeDepth::Checkshot,
            (VerticalUnit::Milliseconds, None) => TimeDepth::ConstantVelocity(geometry.velocity_m_s),
        }
    }

    /// Vertical value of the survey at a TVDSS (m).
    pub(crate) fn vertical_at_tvdss(&self, tvdss_m: f64, geometry: &SurveyGeometry) -> f64 {
        match (geometry.vertical.unit, &self.checkshot) {
            (VerticalUnit::Metres, _) => tvdss_m,
            (VerticalUnit::Milliseconds, Some(checkshot)) => checkshot.twt_at_tvdss(tvdss_m),
            (VerticalUnit::Milliseconds, None) => tvdss_m / geometry.metres_per_vertical_unit(),
        }
    }

    /// Voxel position at a measured depth (m); None outside the surveyed range. It may lie outside the
    /// volume.
    pub fn voxel_at_md(&self, md_m: f64, geometry: &SurveyGeometry) -> Option<DVec3> {
        self.position_at_md(md_m).map(|p| self.voxel_of(p, geometry))
    }

    fn voxel_of(&self, position: DVec3, geometry: &SurveyGeometry) -> DVec3 {
        let z = self.vertical_at_tvdss(position.z, geometry);
        geometry.voxel_from_world(position.truncate().extend(z))
    }

    /// The path as a polyline in voxels from the head down: every station, and at most 10 m of hole between
    /// points.
    pub fn path_in_voxels(&self, geometry: &SurveyGeometry) -> Vec<DVec3> {
        self.path.mds_by_step(STEP_M).into_iter().filter_map(|md| self.voxel_at_md(md, geometry)).collect()
    }

    /// The samples of a curve that have a value, at their voxel positions along the path; `None` when there
    /// is no such curve.
    pub fn log_in_voxels(&self, curve: &str, geometry: &SurveyGeometry) -> Option<Vec<(DVec3, f32)>> {
        let (set, curve) = self.logs.iter().find_map(|set| Some((set, set.curve(curve)?)))?;
        let known = set.md_m.iter().zip(&curve.values).filter(|(_, v)| v.is_finite());
        Some(known.filter_map(|(md, v)| Some((self.voxel_at_md(*md, geometry)?, *v))).collect())
    }

    /// A point of the well in line numbers and vertical values of the survey; `None` outside the surveyed
    /// range.
    pub fn place_at_md(&self, md_m: f64, geometry: &SurveyGeometry) -> Option<TopPlace> {
        let position = self.position_at_md(md_m)?;
        let voxel = self.voxel_of(position, geometry);
        let lines = geometry.lines_from_voxel(voxel.truncate());
        Some(TopPlace {
            md_m,
            position,
            lines: lines.to_array(),
            z: geometry.vertical.value_at(voxel.z),
            inside: is_inside(voxel, geometry),
        })
    }

    /// The position of the well relative to the survey.
    pub fn placement(&self, geometry: &SurveyGeometry) -> WellPlacement {
        let [first, last] = self.path.md_range_m();
        let mds = self.path.mds_by_step(STEP_M);
        let inside: Vec<bool> = mds
            .iter()
            .map(|md| self.voxel_at_md(*md, geometry).is_some_and(|voxel| is_inside(voxel, geometry)))
            .collect();
        let known: Vec<f64> = mds.iter().zip(&inside).filter(|(_, inside)| **inside).map(|(md, _)| *md).collect();
        let length: f64 = mds.windows(2).zip(&inside).filter(|(_, i)| **i).map(|(w, _)| w[1] - w[0]).sum();
        // Both ends are on the path by construction.
        let none = TopPlace { md_m: f64::NAN, position: DVec3::NAN, lines: [f64::NAN; 2], z: f64::NAN, inside: false };
        WellPlacement {
            head: self.place_at_md(first, geometry).unwrap_or(none),
            total_depth: self.place_at_md(last, geometry).unwrap_or(none),
            inside_md_m: known.first().zip(known.last()).map(|(a, b)| [*a, *b]),
            inside_share: length / (last - first),
            time_depth: self.time_depth(geometry),
        }
    }
}

/// Whether a voxel position lies inside the survey, with a tolerance of half a voxel.
fn is_inside(voxel: DVec3, geometry: &SurveyGeometry) -> bool {
    let [nx, ny, nz] = geometry.size().map(|n| n as f64 - 0.5);
    voxel.cmpge(DVec3::splat(-0.5)).all() && voxel.cmple(DVec3::new(nx, ny, nz)).all()
}
