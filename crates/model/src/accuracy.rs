//! Measures how far the boundaries in a picture are from the true ones.
//!
//! A section is sampled at a number of pixels per voxel. Between any two neighbouring pixels with different
//! labels (layers, for example), bisection finds where the label changes, and rays in 32 directions measure
//! the distance from there to the nearest change of the true labels in the plane. The same is done from the
//! truth to the picture, so that a missing boundary counts too. Distances are in voxels and at most
//! [`FARTHEST`].

use crate::section::SectionPlane;
use glam::{DVec2, DVec3};
use rayon::prelude::*;

/// Largest distance that is measured, voxels. Farther boundaries count as this far.
pub const FARTHEST: f64 = 4.0;
/// Directions in which the nearest boundary is searched: the error is at most 0.5 % for a straight boundary.
const DIRECTIONS: usize = 32;
/// Length of the steps in which a ray searches for a change, voxels.
const STEP: f64 = 0.02;
/// Bisections that locate a change between two pixels or steps.
const BISECTIONS: usize = 12;

/// Distances between boundaries, voxels.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BoundaryAccuracy {
    /// Count of measured distances.
    pub count: usize,
    /// Median of the distances.
    pub median: f64,
    /// 95th percentile.
    pub percentile_95: f64,
    /// 99th percentile.
    pub percentile_99: f64,
    /// Largest distance.
    pub worst: f64,
}

impl BoundaryAccuracy {
    /// The statistics of distances; `None` if there are none.
    fn of(mut distances: Vec<f64>) -> Option<Self> {
        distances.sort_by(f64::total_cmp);
        let last = distances.len().checked_sub(1)?;
        let at = |share: f64| distances[(share * last as f64).round() as usize];
        let [median, percentile_95, percentile_99] = [0.5, 0.95, 0.99].map(at);
        Some(Self { count: distances.len(), median, percentile_95, percentile_99, worst: distances[last] })
    }
}

/// Measures the boundaries of `picture` against those of `truth` on a plane, sampled at a number of pixels
/// per voxel. Both functions return the label of a voxel position. Returns `None` if neither has a boundary.
///
/// ```
/// use glam::DVec3;
/// let plane = model::section::SectionPlane::inline(0.0, DVec3::ZERO, DVec3::splat(10.0));
/// let found = model::accuracy::boundaries(&plane, 4.0, |p| u32::from(p.z > 5.05), |p| u32::from(p.z > 5.0)).unwrap();
/// assert!((found.worst - 0.05).abs() < 1e-3);
/// ```
pub fn boundaries(
    plane: &SectionPlane,
    pixels_per_voxel: f64,
    picture: impl Fn(DVec3) -> u32 + Sync,
    truth: impl Fn(DVec3) -> u32 + Sync,
) -> Option<BoundaryAccuracy> {
    let mut distances = distances(plane, pixels_per_voxel, &picture, &truth);
    distances.extend(self::distances(plane, pixels_per_voxel, &truth, &picture));
    BoundaryAccuracy::of(distances)
}

/// Distances from the changes of `from` to those of `to`.
fn distances(
    plane: &SectionPlane,
    pixels_per_voxel: f64,
    from: &(impl Fn(DVec3) -> u32 + Sync),
    to: &(impl Fn(DVec3) -> u32 + Sync),
) -> Vec<f64> {
    let scale = DVec2::new(plane.s_axis.length(), plane.t_axis.length()) * pixels_per_voxel;
    let counts = [plane.extent[0] * scale.x, plane.extent[1] * scale.y].map(|n| n.floor() as usize);
    // Pixel centres in (s, t).
    let centre = |x: usize, y: usize| (DVec2::new(x as f64, y as f64) + 0.5) / scale;
    let label = |st: DVec2| from(plane.voxel(st));
    (0..counts[0])
        .into_par_iter()
        .flat_map_iter(|x| {
            let mut found = Vec::new();
            for y in 0..counts[1] {
                let here = centre(x, y);
                for beside in [[x + 1, y], [x, y + 1]] {
                    if beside[0] < counts[0] && beside[1] < counts[1] {
                        let there = centre(beside[0], beside[1]);
                        if label(here) != label(there) {
                            found.push(nearest(plane, change(here, there, label), to));
                        }
                    }
                }
            }
            found
        })
        .collect()
}

/// Where the label changes between two positions with different labels.
fn change(mut here: DVec2, mut there: DVec2, label: impl Fn(DVec2) -> u32) -> DVec2 {
    let first = label(here);
    for _ in 0..BISECTIONS {
        let middle = (here + there) * 0.5;
        if label(middle) == first { here = middle } else { there = middle }
    }
    (here + there) * 0.5
}

/// Distance in the plane to the nearest change of label, voxels.
fn nearest(plane: &SectionPlane, at: DVec2, label: &impl Fn(DVec3) -> u32) -> f64 {
    let here = label(plane.voxel(at));
    let mut best = FARTHEST;
    for n in 0..DIRECTIONS {
        let angle = DVec2::from_angle(std::f64::consts::TAU * n as f64 / DIRECTIONS as f64);
        // A step of one voxel in this direction.
        let step = angle / (plane.s_axis * angle.x + plane.t_axis * angle.y).length();
        let changed = |distance: f64| label(plane.voxel(at + step * distance)) != here;
        let mut distance = STEP;
        while distance - STEP < best {
            if changed(distance) {
                let (mut low, mut high) = (distance - STEP, distance);
                for _ in 0..BISECTIONS {
                    let middle = 0.5 * (low + high);
                    if changed(middle) { high = middle } else { low = middle }
                }
                best = best.min(high);
                break;
            }
            distance += STEP;
        }
    }
    best
}

#[cfg(test)]
mod tests {
    use super::*;

    fn plane() -> SectionPlane {
        SectionPlane::inline(0.0, DVec3::ZERO, DVec3::splat(10.0))
    }

    #[test]
    fn a_slanted_boundary_is_measured_across_it() {
        let slanted = |p: DVec3, shift: f64| u32::from(0.6 * p.y + 0.8 * p.z > 7.0 + shift);
        let found = boundaries(&plane(), 4.0, |p| slanted(p, 0.3), |p| slanted(p, 0.0)).unwrap();
        assert!((found.median - 0.3).abs() < 3e-3 && found.worst < 0.305, "{found:?}");
    }

    #[test]
    fn a_missing_boundary_is_noticed() {
        let found = boundaries(&plane(), 4.0, |_| 0, |p| u32::from(p.z > 5.0)).unwrap();
        assert_eq!(found.worst, FARTHEST);
        assert!(boundaries(&plane(), 4.0, |_| 0, |_| 1).is_none());
    }
}
