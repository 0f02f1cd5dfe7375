//! Tells which horizons are no height fields: triangles with an overturned limb or around a body, scattered points whose
//! neighbours on the map lie far from their neighbours in space, or that are a height field only as seen from aside.

use super::overturned_points::{self, SeenSideways};
use super::placement::world_xy;
use glam::{DVec2, DVec3};
use rayon::prelude::*;
use survey::geometry::SurveyGeometry;
use survey::mesh::TriangleMesh;
use survey::topology::OrientedMesh;

/// Corners at the same place, m.
const WELD: f64 = 1e-3;
/// Share of a mesh's area on the map that faces down, above which it is overturned; less is how triangles are noisy.
const OVERTURNED: f64 = 0.01;
/// Neighbours of a point that are compared.
const NEIGHBOURS: usize = 6;
/// How many times farther the neighbours on the map must lie than those in space, and for which share of the points.
const FARTHER: f64 = 2.5;
const SHARE: f64 = 0.08;
/// Points that are looked at, at most; every pair of them is compared.
const MOST_POINTS: usize = 2000;
/// Points that are looked at from every side, at most.
const MOST_SEEN: usize = 400;
/// Fewer points tell nothing.
const FEWEST_POINTS: usize = 12;

/// What a mesh is when it is no height field.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum MeshKind {
    /// It encloses a body.
    Body,
    /// A part of it lies above another.
    Overturned,
}

/// What triangles are, if no height field.
pub(super) fn of_mesh(mesh: &TriangleMesh) -> Option<MeshKind> {
    let oriented = OrientedMesh::of(mesh, WELD).ok()?;
    if oriented.is_closed() {
        Some(MeshKind::Body)
    } else {
        (oriented.overturned_share() > OVERTURNED).then_some(MeshKind::Overturned)
    }
}

/// Whether scattered points (voxel x and y, vertical value) are overturned: their neighbours on the map lie on other
/// limbs, or they are a height field as seen from aside that turns its underside up.
pub(super) fn of_points(points: &[(DVec2, f32)], geometry: &SurveyGeometry) -> SeenSideways {
    let vertical = geometry.metric_from_voxel().z_axis.length() / geometry.vertical.interval;
    let place = |(voxel, z): &(DVec2, f32)| world_xy(geometry, *voxel).extend(f64::from(*z) * vertical);
    let places =
        |most: usize| -> Vec<DVec3> { points.iter().step_by(points.len().div_ceil(most).max(1)).map(place).collect() };
    if points.len() < FEWEST_POINTS {
        SeenSideways::Map
    } else if is_torn(&places(MOST_POINTS)) {
        SeenSideways::Overturned
    } else {
        overturned_points::told(&places(MOST_SEEN))
    }
}

/// Whether the nearest points on the map are not about the nearest in space, as they are on a height field, whatever its
/// slope. A hundred points on a fold lie too far apart to tell.
fn is_torn(places: &[DVec3]) -> bool {
    let is_torn = |n: usize| {
        let nearest = |distance: &dyn Fn(DVec3) -> f64| {
            let mut others: Vec<(f64, usize)> =
                (0..places.len()).filter(|&m| m != n).map(|m| (distance(places[m] - places[n]), m)).collect();
            others.select_nth_unstable_by(NEIGHBOURS - 1, |a, b| a.partial_cmp(b).unwrap_or(a.1.cmp(&b.1)));
            let mut lengths: Vec<f64> =
                others[..NEIGHBOURS].iter().map(|&(_, m)| places[m].distance(places[n])).collect();
            lengths.sort_by(f64::total_cmp);
            lengths[NEIGHBOURS / 2 - 1]
        };
        let on_map = nearest(&|d| d.truncate().length());
        on_map > FARTHER * nearest(&|d| d.length())
    };
    let torn = (0..places.len()).into_par_iter().filter(|&n| is_torn(n)).count();
    torn as f64 > SHARE * places.len() as f64
}

#[cfg(test)]
mod tests {
    use super::*;
    use survey::VerticalUnit;
    use synth::shapes::RecumbentFold;

    fn geometry() -> SurveyGeometry {
        SurveyGeometry::regular([61, 51, 81], 25.0, 10.0, VerticalUnit::Metres)
    }

    /// Scattered over the survey by a low-discrepancy sequence.
    fn scattered(count: usize, z: impl Fn(f64, f64) -> f64) -> Vec<(DVec2, f32)> {
        let place = |n: usize| ((n as f64 * 0.754_877).fract() * 1500.0, (n as f64 * 0.569_840).fract() * 1250.0);
        (0..count).map(place).map(|(x, y)| (DVec2::new(x, y) / 25.0, z(x, y) as f32)).collect()
    }

    #[test]
    fn steep_and_faulted_points_are_height_fields_and_overturned_ones_are_not() {
        for count in [50, 90, 150, 600] {
            let is_map = |points: &[(DVec2, f32)]| of_points(points, &geometry()) == SeenSideways::Map;
            assert!(is_map(&scattered(count, |x, _| 100.0 + 1.7 * x)), "a dip of 60 degrees");
            let fault = |x: f64, y: f64| 300.0 + if x > 700.0 + 0.2 * y { 150.0 } else { 0.0 };
            assert!(is_map(&scattered(count, fault)), "a throw of 150 m");
            let folds = |x: f64, y: f64| 400.0 + 150.0 * (x / 90.0).sin() + 60.0 * (y / 150.0).cos();
            assert!(is_map(&scattered(count, folds)), "folds");
            let fold = RecumbentFold::fitting(&geometry());
            let point = |n: usize| {
                let (y, z) = ((n as f64 * 0.754_877).fract() * 1250.0, (n as f64 * 0.569_840).fract() * 800.0);
                (DVec2::new(fold.x_of(-250.0, z), y) / 25.0, z as f32)
            };
            let found = of_points(&(0..count).map(point).collect::<Vec<_>>(), &geometry());
            assert_eq!(found, SeenSideways::Overturned, "{count}");
        }
    }
}
