//! The three sections along the lattice: which way they run, and the numbers that people know their places by.

use glam::{DVec2, DVec3};
use model::section::SectionPlane;
use serde::{Deserialize, Serialize};
use survey::SurveyGeometry;

/// A section along the lattice.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum SectionKind {
    /// Constant x.
    Inline,
    /// Constant y.
    Crossline,
    /// Constant z.
    Slice,
}

impl SectionKind {
    /// All three.
    pub const ALL: [Self; 3] = [Self::Inline, Self::Crossline, Self::Slice];

    /// What it is called.
    pub fn name(self) -> &'static str {
        match self {
            Self::Inline => "Inline",
            Self::Crossline => "Crossline",
            Self::Slice => "Slice",
        }
    }

    /// The voxel axis that is constant.
    pub fn axis(self) -> usize {
        match self {
            Self::Inline => 0,
            Self::Crossline => 1,
            Self::Slice => 2,
        }
    }

    /// The voxel axes that run to the right and down.
    pub fn axes(self) -> [usize; 2] {
        match self {
            Self::Inline => [1, 2],
            Self::Crossline => [0, 2],
            Self::Slice => [0, 1],
        }
    }

    /// Largest s and t in a survey of this size; never 0, so that shares exist.
    pub fn extent(self, size: [usize; 3]) -> DVec2 {
        let [s, t] = self.axes().map(|axis| size[axis].saturating_sub(1).max(1) as f64);
        DVec2::new(s, t)
    }

    /// (s, t) of a voxel position.
    pub fn flat(self, voxel: DVec3) -> DVec2 {
        let [s, t] = self.axes();
        DVec2::new(voxel[s], voxel[t])
    }

    /// Voxel position of (s, t) on the section at `at`.
    pub fn voxel(self, at: f64, st: DVec2) -> DVec3 {
        match self {
            Self::Inline => DVec3::new(at, st.x, st.y),
            Self::Crossline => DVec3::new(st.x, at, st.y),
            Self::Slice => DVec3::new(st.x, st.y, at),
        }
    }

    /// Its plane over the whole survey.
    pub fn plane(self, at: f64, size: [usize; 3]) -> SectionPlane {
        let high = super::last_voxel(size);
        match self {
            Self::Inline => SectionPlane::inline(at, DVec3::ZERO, high),
            Self::Crossline => SectionPlane::crossline(at, DVec3::ZERO, high),
            Self::Slice => SectionPlane::slice(at, DVec3::ZERO, high),
        }
    }
}

/// The value that people know a place on a voxel axis by: inline, crossline or vertical value.
pub fn value_at(geometry: &SurveyGeometry, axis: usize, index: f64) -> f64 {
    match axis {
        0 => geometry.inlines.number_at(index),
        1 => geometry.crosslines.number_at(index),
        _ => geometry.vertical.value_at(index),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_section_runs_through_its_point() {
        for kind in SectionKind::ALL {
            let at = DVec3::new(3.0, 5.0, 7.0);
            assert_eq!(kind.voxel(at[kind.axis()], kind.flat(at)), at);
            let plane = kind.plane(at[kind.axis()], [10, 12, 14]);
            assert_eq!(plane.voxel(kind.flat(at)), at);
        }
    }
}
