//! A section along a line of straight legs.
//!
//! Space: s, voxels along the line from its beginning; t, samples down. A leg is a plane of its own; the
//! lines of all are put one after the other.

use super::{CutLine, SectionSource, lines_of, pixels};
use glam::{DVec2, DVec3};
use image::RgbaImage;
use model::section::SectionPlane;
use render::FaceData;
use survey::SurveyGeometry;

/// A leg shorter than this is none, voxels.
const SHORTEST: f64 = 1e-6;

/// A fence.
#[derive(Debug, Clone, PartialEq)]
pub struct FenceCut {
    /// Its corners, voxel x and y.
    pub corners: Vec<DVec2>,
    /// A pixel a sample, s to the right, t down.
    pub image: RgbaImage,
    /// Horizons and faults.
    pub lines: Vec<CutLine>,
}

impl FenceCut {
    /// Cuts along a line of two corners or more; `show` says what of the candidates lies over the amplitudes.
    pub fn new(source: &SectionSource, corners: &[DVec2], show: FaceData) -> Self {
        let depth = source.data.geometry.size()[2].saturating_sub(1).max(1) as f64;
        let stations = stations(corners);
        let length = stations.last().copied().unwrap_or(0.0);
        let width = length.ceil().max(1.0) as u32 + 1;
        let step = length / f64::from(width - 1);
        let image = pixels::raster(source, [width, depth as u32 + 1], show, |column, row| {
            place(corners, f64::from(column) * step).extend(f64::from(row)).as_vec3()
        });
        let mut lines = Vec::new();
        for (plane, station) in legs(corners, depth).into_iter().zip(stations) {
            if plane.extent[0] < SHORTEST {
                continue;
            }
            let shift = DVec2::new(station, 0.0);
            lines.extend(lines_of(source, &plane).into_iter().map(|mut line| {
                line.points.iter_mut().for_each(|point| *point += shift);
                line
            }));
        }
        Self { corners: corners.to_vec(), image, lines }
    }
}

/// The planes of the legs of a line.
pub fn legs(corners: &[DVec2], depth: f64) -> Vec<SectionPlane> {
    let leg = |pair: &[DVec2]| {
        let length = pair[0].distance(pair[1]);
        SectionPlane {
            origin: pair[0].extend(0.0),
            s_axis: (pair[1] - pair[0]).normalize_or_zero().extend(0.0),
            t_axis: DVec3::Z,
            extent: [length, depth],
        }
    };
    corners.windows(2).map(leg).collect()
}

/// Where each corner lies along the line, voxels.
pub fn stations(corners: &[DVec2]) -> Vec<f64> {
    let mut at = 0.0;
    let mut stations = vec![0.0];
    for pair in corners.windows(2) {
        at += pair[0].distance(pair[1]);
        stations.push(at);
    }
    stations
}

/// Length of a line in metres on the ground.
pub fn length_m(geometry: &SurveyGeometry, corners: &[DVec2]) -> f64 {
    let legs = corners.windows(2).map(|pair| {
        let step = pair[1] - pair[0];
        (geometry.inline_vector * step.x + geometry.crossline_vector * step.y).length()
    });
    legs.sum()
}

/// The place at `s` along the line, voxel x and y.
pub fn place(corners: &[DVec2], s: f64) -> DVec2 {
    let stations = stations(corners);
    let leg = stations.windows(2).position(|ends| s <= ends[1]).unwrap_or(corners.len().saturating_sub(2));
    let [Some(from), Some(to)] = [corners.get(leg), corners.get(leg + 1)] else {
        return corners.first().copied().unwrap_or_default();
    };
    let length = (stations[leg + 1] - stations[leg]).max(f64::MIN_POSITIVE);
    from.lerp(*to, ((s - stations[leg]) / length).clamp(0.0, 1.0))
}

/// Length along a fence of the place on it nearest to a point, and how far that is, voxels.
pub(crate) fn station_of(corners: &[DVec2], point: DVec2) -> Option<(f64, f64)> {
    let legs = corners.windows(2).zip(stations(corners)).map(|(leg, station)| {
        let (step, off) = (leg[1] - leg[0], point - leg[0]);
        let share = (step.dot(off) / step.length_squared().max(f64::MIN_POSITIVE)).clamp(0.0, 1.0);
        (station + share * step.length(), off.distance(step * share))
    });
    legs.min_by(|a, b| a.1.total_cmp(&b.1))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn places_run_along_the_legs() {
        let corners = [[0.0, 0.0], [3.0, 4.0], [3.0, 10.0]].map(DVec2::from_array);
        assert_eq!(stations(&corners), [0.0, 5.0, 11.0]);
        for (s, at) in [(0.0, [0.0, 0.0]), (2.5, [1.5, 2.0]), (5.0, [3.0, 4.0]), (8.0, [3.0, 7.0]), (99.0, [3.0, 10.0])]
        {
            assert!(place(&corners, s).distance(DVec2::from_array(at)) < 1e-9, "{s}");
        }
    }

    #[test]
    fn a_place_beside_a_fence_has_its_length_along_it() {
        let corners = [[0.0, 0.0], [4.0, 0.0], [4.0, 2.0]].map(DVec2::from_array);
        assert_eq!(station_of(&corners, DVec2::new(1.0, -2.0)), Some((1.0, 2.0)));
        assert_eq!(station_of(&corners, DVec2::new(5.0, 1.5)), Some((5.5, 1.0)));
        assert_eq!(station_of(&corners[..1], DVec2::ZERO), None);
    }
}
