//! Finds the regular lattice that points lie on: a decimation of the survey's traces, or a lattice of its own in any
//! rotation.
//!
//! **Of the survey**: all points within 0.03 bins of traces; the step is the greatest common divisor of their
//! indices. **Own**: the most frequent vector to the nearest neighbour is the first axis, the most frequent
//! to the nearest one not in line with it the second. Integer coordinates are then given outwards from the
//! middle, with the axes fitted anew by least squares each time the number of points has doubled; every point
//! must end within 0.1 of a node.
//!
//! Either way the points must fill the lattice: on average at least half of a point's four neighbours must exist.
//! Points thinned at random lie on a lattice too, but as isolated nodes between holes they would be of no use: they
//! count as scattered.

use super::neighbours::PointGrid;
use glam::{DMat2, DVec2};
use std::collections::HashSet;
use survey::geometry::SurveyGeometry;
use survey::horizon::NodeGrid;

/// Share of a point's four neighbours that must exist on average.
const MIN_OCCUPANCY: f64 = 0.5;
/// Largest distance from a trace, in bins, of a point that lies on it; coordinates with two decimals stay far below.
const ON_TRACE: f64 = 0.03;
/// Largest final distance of a point from its node, in steps.
const ON_NODE: f64 = 0.1;

/// A lattice and the node of each point.
pub(super) struct FittedLattice {
    pub grid: NodeGrid,
    /// Node `[u, v]` per point; negative or beyond the count for points beside a survey grid.
    pub nodes: Vec<[i64; 2]>,
}

/// The decimation of the survey's traces that all points lie on; `None` if they do not lie on one or do not fill it.
///
/// At step 1 × 1 the grid is the survey's own; otherwise it reaches from the first to the last point.
pub(super) fn of_survey(voxels: &[DVec2], geometry: &SurveyGeometry) -> Option<(FittedLattice, [usize; 2])> {
    if voxels.iter().any(|v| !((*v - v.round()).abs().max_element() <= ON_TRACE && v.abs().max_element() < 1e9)) {
        return None;
    }
    let traces: Vec<[i64; 2]> = voxels.iter().map(|v| [v.x.round() as i64, v.y.round() as i64]).collect();
    let first = *traces.first()?;
    let low = traces.iter().fold(first, |l, t| [l[0].min(t[0]), l[1].min(t[1])]);
    let step = traces.iter().fold([0, 0], |g, t| [gcd(g[0], t[0] - low[0]), gcd(g[1], t[1] - low[1])]);
    let step = step.map(|s| s.max(1));
    let nodes: Vec<[i64; 2]> = traces.iter().map(|t| [(t[0] - low[0]) / step[0], (t[1] - low[1]) / step[1]]).collect();
    if !is_filled(&nodes) {
        return None;
    }
    let own = NodeGrid::of_survey(geometry);
    if step == [1, 1] {
        return Some((FittedLattice { grid: own, nodes: traces }, [1, 1]));
    }
    let grid = NodeGrid {
        origin: own.world_at(DVec2::new(low[0] as f64, low[1] as f64)),
        u_step: own.u_step * step[0] as f64,
        v_step: own.v_step * step[1] as f64,
        count: count_of(&nodes),
    };
    Some((FittedLattice { grid, nodes }, step.map(|s| s as usize)))
}

/// The greatest common divisor, never negative.
pub(crate) fn gcd(a: i64, b: i64) -> i64 {
    if b == 0 { a.abs() } else { gcd(b, a % b) }
}

fn count_of(nodes: &[[i64; 2]]) -> [usize; 2] {
    let high = nodes.iter().fold([0, 0], |h, n| [h[0].max(n[0]), h[1].max(n[1])]);
    high.map(|h| h as usize + 1)
}

/// Whether the nodes have enough neighbours to form a surface.
fn is_filled(nodes: &[[i64; 2]]) -> bool {
    let known: HashSet<[i64; 2]> = nodes.iter().copied().collect();
    let wide = |axis: usize| nodes.iter().any(|n| n[axis] != nodes[0][axis]);
    // A single line has two neighbours a node.
    let possible = 2.0 * (f64::from(u8::from(wide(0))) + f64::from(u8::from(wide(1))));
    let found: usize = known
        .iter()
        .map(|[u, v]| {
            [[u - 1, *v], [u + 1, *v], [*u, v - 1], [*u, v + 1]].iter().filter(|n| known.contains(*n)).count()
        })
        .sum();
    possible == 0.0 || found as f64 >= MIN_OCCUPANCY * possible * known.len() as f64
}

/// The lattice of points in world X, Y; `None` if there is none.
pub(super) fn of_points(points: &[DVec2], geometry: &SurveyGeometry) -> Option<FittedLattice> {
    let middle = points.iter().sum::<DVec2>() / points.len() as f64;
    let local: Vec<DVec2> = points.iter().map(|p| *p - middle).collect();
    let unique = distinct(&local);
    if unique.len() < 9 {
        return None;
    }
    let (a, b) = basis(&unique)?;
    let (origin, axes) = fit(&unique, a, b)?;
    let inverse = axes.inverse();
    let mut nodes = Vec::with_capacity(points.len());
    for p in &local {
        let n = inverse * (*p - origin);
        if (n - n.round()).abs().max_element() > ON_NODE || n.abs().max_element() > 1e6 {
            return None;
        }
        nodes.push([n.x.round() as i64, n.y.round() as i64]);
    }
    let (origin, axes, nodes) = turned(origin, axes, &nodes, geometry);
    if !is_filled(&nodes) {
        return None;
    }
    let count = count_of(&nodes);
    // A few far outliers on the lattice must not cause a huge grid.
    if count[0].checked_mul(count[1])? > 64 * points.len() + 4096 {
        return None;
    }
    let grid = NodeGrid { origin: origin + middle, u_step: axes.x_axis, v_step: axes.y_axis, count };
    Some(FittedLattice { grid, nodes })
}

fn distinct(points: &[DVec2]) -> Vec<DVec2> {
    let mut seen = HashSet::new();
    points
        .iter()
        .copied()
        .filter(|p| seen.insert(((p.x * 100.0).round() as i64, (p.y * 100.0).round() as i64)))
        .collect()
}

/// The two shortest vectors that most points have to a neighbour.
fn basis(points: &[DVec2]) -> Option<(DVec2, DVec2)> {
    let cells = PointGrid::of(points);
    let stride = (points.len() / 1000).max(1);
    let sample: Vec<usize> = (0..points.len()).step_by(stride).collect();
    let first: Vec<DVec2> = sample.iter().filter_map(|&n| cells.nearest(n, |_| true)).collect();
    let a = most_frequent(&first, sample.len())?;
    let off_line = |d: DVec2| a.perp_dot(d).abs() > 0.2 * a.length() * d.length();
    let second: Vec<DVec2> = sample.iter().filter_map(|&n| cells.nearest(n, off_line)).collect();
    let b = most_frequent(&second, sample.len())?;
    // Of two skew vectors the difference may be shorter.
    let b = b - a * (a.dot(b) / a.length_squared()).round();
    Some((a, b))
}

/// The mean of the largest group of vectors equal up to sign and a tenth of their length; at least 40 % of
/// all.
fn most_frequent(vectors: &[DVec2], of: usize) -> Option<DVec2> {
    let upward =
        |d: DVec2| if d.y < -1e-3 * d.length() || (d.y.abs() <= 1e-3 * d.length() && d.x < 0.0) { -d } else { d };
    let near = |a: DVec2, b: DVec2| (a - b).length() < 0.1 * a.length();
    let mut best: Option<(usize, DVec2)> = None;
    for candidate in vectors.iter().take(100).map(|d| upward(*d)) {
        let same = |d: &DVec2| near(candidate, *d) || near(candidate, -*d);
        let count = vectors.iter().filter(|d| same(d)).count();
        if best.is_none_or(|(most, _)| count > most) {
            best = Some((count, candidate));
        }
    }
    let (count, candidate) = best.filter(|(count, _)| count * 10 >= of * 4)?;
    let sum: DVec2 = vectors
        .iter()
        .map(|d| {
            if near(candidate, *d) {
                *d
            } else if near(candidate, -*d) {
                -*d
            } else {
                DVec2::ZERO
            }
        })
        .sum();
    Some(sum / count as f64)
}

/// Fits origin and axes so that every point is at integers, outwards from the point nearest the middle.
fn fit(points: &[DVec2], a: DVec2, b: DVec2) -> Option<(DVec2, DMat2)> {
    let mut order: Vec<DVec2> = points.to_vec();
    let seed = order.iter().copied().min_by(|p, q| p.length_squared().total_cmp(&q.length_squared()))?;
    order.sort_by(|p, q| p.distance_squared(seed).total_cmp(&q.distance_squared(seed)));
    let (mut origin, mut axes) = (seed, DMat2::from_cols(a, b));
    let mut used = 9;
    loop {
        used = used.min(order.len());
        let inverse = axes.inverse();
        // Normal equations of p = origin + u·a + v·b.
        let mut normal = glam::DMat3::ZERO;
        let (mut right_x, mut right_y) = (glam::DVec3::ZERO, glam::DVec3::ZERO);
        for p in &order[..used] {
            let n = (inverse * (*p - origin)).round().extend(1.0);
            normal += glam::DMat3::from_cols(n * n.x, n * n.y, n * n.z);
            right_x += n * p.x;
            right_y += n * p.y;
        }
        // A row of points does not fix both axes yet; go on with the old ones.
        if normal.determinant().abs() > 1e-6 {
            let inverse = normal.inverse();
            let (x, y) = (inverse * right_x, inverse * right_y);
            origin = DVec2::new(x.z, y.z);
            axes = DMat2::from_cols(DVec2::new(x.x, y.x), DVec2::new(x.y, y.y));
        }
        // NaN does not make a lattice either.
        if axes.determinant().is_nan() || axes.determinant().abs() <= 1e-9 {
            return None;
        }
        if used == order.len() {
            return Some((origin, axes));
        }
        used = used * 3 / 2 + 1;
    }
}

/// Turns the axes so that u runs most like the survey's inline index and v like its crossline index, and
/// starts nodes at 0.
fn turned(origin: DVec2, axes: DMat2, nodes: &[[i64; 2]], geometry: &SurveyGeometry) -> (DVec2, DMat2, Vec<[i64; 2]>) {
    let along = |axis: DVec2, like: DVec2| (axis.dot(like) / (axis.length() * like.length())).abs();
    let swap = along(axes.x_axis, geometry.inline_vector) + along(axes.y_axis, geometry.crossline_vector)
        < along(axes.y_axis, geometry.inline_vector) + along(axes.x_axis, geometry.crossline_vector);
    let (mut u, mut v) = if swap { (axes.y_axis, axes.x_axis) } else { (axes.x_axis, axes.y_axis) };
    let (su, sv) = (
        if u.dot(geometry.inline_vector) < 0.0 { -1 } else { 1 },
        if v.dot(geometry.crossline_vector) < 0.0 { -1 } else { 1 },
    );
    let turned: Vec<[i64; 2]> =
        nodes.iter().map(|n| if swap { [n[1] * su, n[0] * sv] } else { [n[0] * su, n[1] * sv] }).collect();
    u *= su as f64;
    v *= sv as f64;
    let low = turned.iter().fold([i64::MAX; 2], |l, n| [l[0].min(n[0]), l[1].min(n[1])]);
    let origin = origin + u * low[0] as f64 + v * low[1] as f64;
    (origin, DMat2::from_cols(u, v), turned.iter().map(|n| [n[0] - low[0], n[1] - low[1]]).collect())
}

#[cfg(test)]
mod tests {
    use super::*;
    use survey::geometry::VerticalUnit;

    fn survey() -> SurveyGeometry {
        SurveyGeometry::regular([100, 80, 50], 25.0, 4.0, VerticalUnit::Metres)
    }

    /// A rotated lattice of 40 × 30 with rounding to centimetres and a hole, in a scrambled order.
    fn rotated(degrees: f64, steps: [f64; 2]) -> Vec<DVec2> {
        let u = DVec2::from_angle(degrees.to_radians()) * steps[0];
        let v = DVec2::from_angle(degrees.to_radians()).perp() * steps[1];
        let mut points = Vec::new();
        for n in 0..1200usize {
            let n = n * 7 % 1200;
            let (i, j) = ((n / 30) as f64, (n % 30) as f64);
            if (i - 20.0).abs() < 4.0 && (j - 12.0).abs() < 3.0 {
                continue;
            }
            let p = DVec2::new(6.0e5, 6.1e6) + u * i + v * j;
            points.push((p * 100.0).round() / 100.0);
        }
        points
    }

    #[test]
    fn rotated_lattices_of_any_proportion_are_found() {
        for (degrees, steps) in
            [(0.0, [12.5, 18.75]), (27.6, [50.0, 25.0]), (-61.0, [10.0, 75.0]), (45.0, [20.0, 20.0])]
        {
            let points = rotated(degrees, steps);
            let lattice = of_points(&points, &survey()).unwrap_or_else(|| panic!("{degrees} {steps:?}"));
            let mut found = [lattice.grid.u_step.length(), lattice.grid.v_step.length()];
            found.sort_by(f64::total_cmp);
            let mut wanted = steps;
            wanted.sort_by(f64::total_cmp);
            assert!((found[0] - wanted[0]).abs() < 1e-3 && (found[1] - wanted[1]).abs() < 1e-3, "{found:?}");
            let mut counts = lattice.grid.count;
            counts.sort_unstable();
            assert_eq!(counts, [30, 40]);
            for (p, n) in points.iter().zip(&lattice.nodes) {
                assert!(lattice.grid.world_at(DVec2::new(n[0] as f64, n[1] as f64)).distance(*p) < 0.02);
            }
        }
    }

    #[test]
    fn a_decimation_of_the_survey_keeps_its_step() {
        let voxels: Vec<DVec2> =
            (0..600).map(|n| DVec2::new(5.0 + 2.0 * f64::from(n / 20), 1.004 + 3.0 * f64::from(n % 20))).collect();
        let (lattice, step) = of_survey(&voxels, &survey()).unwrap();
        assert_eq!((step, lattice.grid.count), ([2, 3], [30, 20]));
        assert_eq!(lattice.grid.origin, DVec2::new(125.0, 25.0));
        assert_eq!(lattice.nodes[21], [1, 1]);
    }

    #[test]
    fn scattered_and_thinned_points_have_no_lattice() {
        let mut state = 1u64;
        let mut random = || {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (state >> 33) as f64 / f64::from(u32::MAX / 2)
        };
        let free: Vec<DVec2> = (0..1000).map(|_| DVec2::new(random(), random()) * 2000.0).collect();
        assert!(of_points(&free, &survey()).is_none());
        let thinned: Vec<DVec2> =
            (0..500).map(|_| (DVec2::new(random(), random()) * DVec2::new(99.0, 79.0)).round()).collect();
        assert!(of_survey(&thinned, &survey()).is_none());
    }
}
