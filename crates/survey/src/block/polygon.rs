//! Polygons of the map: whether one crosses itself, and its convex parts.

use glam::DVec2;

/// Twice the area, positive if the points run counter-clockwise.
pub(super) fn area(points: &[DVec2]) -> f64 {
    (0..points.len()).map(|n| points[n].perp_dot(points[(n + 1) % points.len()])).sum()
}

/// Whether two sides that are no neighbours meet, or neighbours lie on one another.
pub(super) fn crosses_itself(points: &[DVec2]) -> bool {
    let count = points.len();
    let side = |n: usize| (points[n], points[(n + 1) % count]);
    let turn = |a: DVec2, b: DVec2, c: DVec2| (b - a).perp_dot(c - a);
    let meet = |(a, b): (DVec2, DVec2), (c, d): (DVec2, DVec2)| {
        let (s, t) = (turn(a, b, c) * turn(a, b, d), turn(c, d, a) * turn(c, d, b));
        // Rounding may put parts of one straight line on both sides of each other.
        s <= 0.0 && t <= 0.0 && overlap(a, b, c, d)
    };
    let folds = |n: usize| {
        let ((a, b), (_, c)) = (side(n), side((n + 1) % count));
        turn(a, b, c).abs() < 1e-12 && (b - a).dot(c - b) < 0.0
    };
    (0..count).any(|n| folds(n) || (n + 2..count).any(|m| (m + 1) % count != n && meet(side(n), side(m))))
}

/// Whether the boxes around two segments meet.
fn overlap(a: DVec2, b: DVec2, c: DVec2, d: DVec2) -> bool {
    a.min(b).cmple(c.max(d)).all() && c.min(d).cmple(a.max(b)).all()
}

/// A polygon that turns counter-clockwise, in convex parts: corners by their index.
///
/// ```
/// use glam::DVec2;
/// let ell = [[0.0, 0.0], [2.0, 0.0], [2.0, 1.0], [1.0, 1.0], [1.0, 2.0], [0.0, 2.0]].map(DVec2::from_array);
/// assert_eq!(survey::block::convex_parts(&ell).len(), 2);
/// ```
pub fn convex_parts(points: &[DVec2]) -> Vec<Vec<usize>> {
    let turn = |a: usize, b: usize, c: usize| (points[b] - points[a]).perp_dot(points[c] - points[a]);
    let mut rest: Vec<usize> = (0..points.len()).collect();
    let mut parts: Vec<Vec<usize>> = Vec::new();
    while rest.len() > 3 {
        let count = rest.len();
        let corners = |n: usize| [rest[(n + count - 1) % count], rest[n], rest[(n + 1) % count]];
        let is_ear = |n: &usize| {
            let [a, b, c] = corners(*n);
            let inside = |p: &usize| {
                ![a, b, c].contains(p) && turn(a, b, *p) >= 0.0 && turn(b, c, *p) >= 0.0 && turn(c, a, *p) >= 0.0
            };
            turn(a, b, c) > 0.0 && !rest.iter().any(inside)
        };
        // The fattest ear, so that bodies are not slivers; a straight corner goes with its neighbours.
        let fatness = |n: &usize| {
            let [a, b, c] = corners(*n);
            turn(a, b, c) / (points[c] - points[a]).length_squared().max(f64::MIN_POSITIVE)
        };
        let best = (0..count).filter(is_ear).max_by(|a, b| fatness(a).total_cmp(&fatness(b)));
        let n = best.unwrap_or(0);
        parts.push(corners(n).to_vec());
        rest.remove(n);
    }
    parts.push(rest);
    join_convex(points, parts)
}

/// Joins parts over the sides that they share while they stay convex.
fn join_convex(points: &[DVec2], mut parts: Vec<Vec<usize>>) -> Vec<Vec<usize>> {
    let is_convex = |corners: &[usize]| {
        let count = corners.len();
        (0..count).all(|n| {
            let [a, b, c] = [corners[n], corners[(n + 1) % count], corners[(n + 2) % count]].map(|k| points[k]);
            (b - a).perp_dot(c - b) >= -1e-12
        })
    };
    let joined = |one: &[usize], other: &[usize]| {
        let (count, more) = (one.len(), other.len());
        let (n, m) = (0..count)
            .flat_map(|n| (0..more).map(move |m| (n, m)))
            .find(|&(n, m)| one[n] == other[(m + 1) % more] && one[(n + 1) % count] == other[m])?;
        let rest = (2..more).map(|k| other[(m + k) % more]);
        let corners: Vec<usize> = (1..=count).map(|k| one[(n + k) % count]).chain(rest).collect();
        is_convex(&corners).then_some(corners)
    };
    let mut n = 0;
    while n < parts.len() {
        match (n + 1..parts.len()).find_map(|m| joined(&parts[n], &parts[m]).map(|corners| (m, corners))) {
            Some((m, corners)) => {
                parts[n] = corners;
                parts.remove(m);
                n = 0;
            }
            None => n += 1,
        }
    }
    parts
}
