//! Convex polygons on a page: whether they meet, and what lies in them.

use glam::DVec2;
use page::Rect;

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

/// The part of a polygon within a convex one; `None` where there is none. Where a polygon that is not convex falls into
/// parts, they are joined along the sides of the other, which fills the same by the even-odd rule.
pub(crate) fn common(polygon: &[DVec2], convex: &[DVec2]) -> Option<Vec<DVec2>> {
    let turns: f64 = (0..convex.len()).map(|n| convex[n].perp_dot(convex[(n + 1) % convex.len()])).sum();
    let mut kept = polygon.to_vec();
    for n in 0..convex.len() {
        let (corner, side) = (convex[n], (convex[(n + 1) % convex.len()] - convex[n]) * turns.signum());
        let inside = |place: DVec2| side.perp_dot(place - corner);
        let mut cut = Vec::with_capacity(kept.len() + 2);
        for (n, &from) in kept.iter().enumerate() {
            let to = kept[(n + 1) % kept.len()];
            let (here, there) = (inside(from), inside(to));
            if here >= 0.0 {
                cut.push(from);
            }
            if (here < 0.0) != (there < 0.0) {
                cut.push(from.lerp(to, here / (here - there)));
            }
        }
        kept = cut;
    }
    (kept.len() > 2 && area(&kept) > 0.0).then_some(kept)
}

/// The part of a polygon within a rectangle.
pub(crate) fn within(polygon: &[DVec2], rect: Rect) -> Option<Vec<DVec2>> {
    let [low, high] = [rect.min, rect.max];
    common(polygon, &[low, DVec2::new(high.x, low.y), high, DVec2::new(low.x, high.y)])
}

/// The area of a polygon.
pub(crate) fn area(polygon: &[DVec2]) -> f64 {
    let twice: f64 = (0..polygon.len()).map(|n| polygon[n].perp_dot(polygon[(n + 1) % polygon.len()])).sum();
    0.5 * twice.abs()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_polygon_is_cut_by_the_sides_that_it_crosses() {
        let rect = Rect::sized(DVec2::ZERO, DVec2::new(10.0, 6.0));
        let corners = |places: &[[f64; 2]]| places.iter().copied().map(DVec2::from_array).collect::<Vec<_>>();
        let inside = corners(&[[1.0, 1.0], [4.0, 1.0], [2.0, 5.0]]);
        assert_eq!(within(&inside, rect), Some(inside));
        // A diamond about the corner (10, 6): a quarter of it is left.
        let diamond = corners(&[[10.0, 4.0], [12.0, 6.0], [10.0, 8.0], [8.0, 6.0]]);
        let left = within(&diamond, rect).unwrap();
        assert!((area(&left) - 2.0).abs() < 1e-12 && left.iter().all(|place| rect.grown(1e-12).contains(*place)));
        // All of the rectangle lies in this one, and nothing of the rectangle in that one.
        let large = within(&corners(&[[-20.0, -20.0], [40.0, -20.0], [40.0, 40.0], [-20.0, 40.0]]), rect).unwrap();
        assert!((area(&large) - 60.0).abs() < 1e-9);
        // Either way round, and of a polygon that falls into two parts both are kept.
        let fork = corners(&[
            [1.0, -4.0],
            [9.0, -4.0],
            [9.0, 4.0],
            [7.0, 4.0],
            [7.0, -2.0],
            [3.0, -2.0],
            [3.0, 4.0],
            [1.0, 4.0],
        ]);
        let backwards: Vec<DVec2> = fork.iter().rev().copied().collect();
        for prongs in [fork, backwards] {
            assert!((area(&within(&prongs, rect).unwrap()) - 16.0).abs() < 1e-12);
        }
        assert_eq!(within(&corners(&[[11.0, 1.0], [14.0, 1.0], [12.0, 5.0]]), rect), None);
    }
}
