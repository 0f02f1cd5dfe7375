//! Convex polygons on a page: whether they meet, and what lies in them.

use glam::DVec2;

/// Whether two convex polygons have a place in common: no side of either, and no direction between, parts them.
pub(crate) fn meet(one: &[DVec2], other: &[DVec2]) -> bool {
    let span = |polygon: &[DVec2], axis: DVec2| {
        let along = polygon.iter().map(|corner| corner.dot(axis));
        along.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], at| [low.min(at), high.max(at)])
    };
    let is_between = |axis: DVec2| {
        let ([low, high], [other_low, other_high]) = (span(one, axis), span(other, axis));
        high < other_low || other_high < low
    };
    let has_between = |polygon: &[DVec2]| {
        let along = (0..polygon.len()).map(|n| polygon[(n + 1) % polygon.len()] - polygon[n]);
        along.flat_map(|side| [side.perp(), side]).any(is_between)
    };
    // Most polygons of a page are far apart.
    ![DVec2::X, DVec2::Y].into_iter().any(is_between) && !has_between(one) && !has_between(other)
}

/// Whether a place lies in a convex polygon.
pub(crate) fn holds(polygon: &[DVec2], place: DVec2) -> bool {
    let turns =
        (0..polygon.len()).map(|n| (polygon[(n + 1) % polygon.len()] - polygon[n]).perp_dot(place - polygon[n]));
    let (mut left, mut right) = (false, false);
    for turn in turns {
        left |= turn < 0.0;
        right |= turn > 0.0;
    }
    !(left && right)
}

/// The area of a polygon.
pub(crate) fn area(polygon: &[DVec2]) -> f64 {
    let twice: f64 = (0..polygon.len()).map(|n| polygon[n].perp_dot(polygon[(n + 1) % polygon.len()])).sum();
    0.5 * twice.abs()
}
