//! Fits a triangulated surface to scattered fault points: the best plane, and a smoothed height above it.
//!
//! The plane is that of the two largest principal axes of the points in metric space. Points are averaged in
//! square cells of it (at most 40 along the longer side, none smaller than the points are apart); the height
//! at a cell's mean is that of the plane fitted there by least squares with Gaussian weights (moving least
//! squares, σ = 1 cell), which keeps planes exact and averages noise. The cells are joined by Delaunay
//! triangles; those with a side over three times the median are left out, so that the surface ends where the
//! points do.

use super::scatter;
use glam::{DMat3, DVec2, DVec3};
use std::collections::BTreeMap;
use survey::mesh::TriangleMesh;

/// Most cells along the longer side.
const CELLS: f64 = 40.0;

/// Principal axes of points: mean, directions by falling extent, variances along them.
pub(super) struct PrincipalFrame {
    pub mean: DVec3,
    pub axes: [DVec3; 3],
    pub variance: [f64; 3],
}

impl PrincipalFrame {
    /// The frame of points; the coordinate axes for none.
    pub(crate) fn of(points: &[DVec3]) -> Self {
        let count = points.len().max(1) as f64;
        let mean = points.iter().sum::<DVec3>() / count;
        let mut covariance = DMat3::ZERO;
        for d in points.iter().map(|p| *p - mean) {
            covariance += DMat3::from_cols(d * d.x, d * d.y, d * d.z);
        }
        let (values, vectors) = eigen(covariance * (1.0 / count));
        let mut order = [0, 1, 2];
        order.sort_by(|&a, &b| values[b].total_cmp(&values[a]));
        Self { mean, axes: order.map(|n| vectors[n]), variance: order.map(|n| values[n]) }
    }
}

/// Eigenvalues and unit eigenvectors of a symmetric matrix, by Jacobi rotations.
fn eigen(mut m: DMat3) -> ([f64; 3], [DVec3; 3]) {
    let mut v = DMat3::IDENTITY;
    for _ in 0..32 {
        let off = m.x_axis.y.powi(2) + m.x_axis.z.powi(2) + m.y_axis.z.powi(2);
        let on = m.x_axis.x.powi(2) + m.y_axis.y.powi(2) + m.z_axis.z.powi(2);
        if off <= 1e-30 * on || !off.is_finite() {
            break;
        }
        for (p, q) in [(0, 1), (0, 2), (1, 2)] {
            let pq = m.col(p)[q];
            if pq == 0.0 {
                continue;
            }
            let theta = 0.5 * (m.col(q)[q] - m.col(p)[p]) / pq;
            let t = theta.signum() / (theta.abs() + (theta * theta + 1.0).sqrt());
            let c = 1.0 / (t * t + 1.0).sqrt();
            let s = t * c;
            let mut turn = DMat3::IDENTITY;
            turn.col_mut(p)[p] = c;
            turn.col_mut(q)[q] = c;
            turn.col_mut(q)[p] = s;
            turn.col_mut(p)[q] = -s;
            m = turn.transpose() * m * turn;
            v *= turn;
        }
    }
    ([m.x_axis.x, m.y_axis.y, m.z_axis.z], [v.x_axis, v.y_axis, v.z_axis])
}

/// Fits a surface to points (world, vertical value; `metres` per vertical unit); also the RMS distance of the
/// points from it, m.
///
/// `None` for fewer than three points and for points along a line.
pub(super) fn fit(points: &[DVec3], metres: f64) -> Option<(TriangleMesh, f64)> {
    let metric: Vec<DVec3> = points.iter().map(|p| *p * DVec3::new(1.0, 1.0, metres)).collect();
    let frame = PrincipalFrame::of(&metric);
    let spans = frame.variance[1] > 1e-6 * frame.variance[0];
    if points.len() < 3 || !spans {
        return None;
    }
    let [u, v, n] = frame.axes;
    let local: Vec<DVec3> =
        metric.iter().map(|p| *p - frame.mean).map(|d| DVec3::new(d.dot(u), d.dot(v), d.dot(n))).collect();
    let low = local.iter().copied().reduce(DVec3::min)?;
    let size = local.iter().copied().reduce(DVec3::max)? - low;
    let side = (size.x.max(size.y) / CELLS).max((size.x * size.y / points.len() as f64).sqrt());
    let mut cells: BTreeMap<(i64, i64), Vec<usize>> = BTreeMap::new();
    for (k, p) in local.iter().enumerate() {
        cells.entry(cell_of(*p, low, side)).or_default().push(k);
    }
    let height = |at: DVec2| {
        let (x, y) = cell_of(at.extend(0.0), low, side);
        let near = (x - 3..=x + 3).flat_map(|i| (y - 3..=y + 3).map(move |j| (i, j)));
        moving_plane(near.filter_map(|key| cells.get(&key)).flatten().map(|&k| local[k]), at, side)
    };
    let places: Vec<DVec2> = cells
        .values()
        .map(|members| members.iter().map(|&k| local[k].truncate()).sum::<DVec2>() / members.len() as f64)
        .collect();
    let triangles = scatter::delaunay(&places);
    let longest = 3.0 * scatter::median_side(&places, &triangles);
    let vertices = places
        .iter()
        .map(|p| frame.mean + u * p.x + v * p.y + n * height(*p))
        .map(|p| DVec3::new(p.x, p.y, p.z / metres))
        .collect();
    let triangles: Vec<[u32; 3]> = triangles
        .into_iter()
        .filter(|t| (0..3).all(|k| places[t[k]].distance(places[t[(k + 1) % 3]]) <= longest))
        .map(|t| t.map(|k| k as u32))
        .collect();
    if triangles.is_empty() {
        return None;
    }
    let square: f64 = local.iter().map(|p| (p.z - height(p.truncate())).powi(2)).sum();
    Some((TriangleMesh { vertices, triangles }, (square / local.len() as f64).sqrt()))
}

fn cell_of(p: DVec3, low: DVec3, side: f64) -> (i64, i64) {
    (((p.x - low.x) / side).floor() as i64, ((p.y - low.y) / side).floor() as i64)
}

/// Height at `at` of the plane fitted to points with weights exp(−d²/2σ²), σ = `side`.
fn moving_plane(points: impl Iterator<Item = DVec3>, at: DVec2, side: f64) -> f64 {
    let mut normal = DMat3::ZERO;
    let mut right = DVec3::ZERO;
    for p in points {
        let d = (p.truncate() - at) / side;
        let weight = (-0.5 * d.length_squared()).exp();
        let row = d.extend(1.0);
        normal += DMat3::from_cols(row * row.x, row * row.y, row * row.z) * weight;
        right += row * (weight * p.z);
    }
    // A little damping of the slopes decides where points lie along a line; it changes planes by a millionth.
    let mean = normal.z_axis.z;
    normal.x_axis.x += 1e-6 * mean;
    normal.y_axis.y += 1e-6 * mean;
    (normal.inverse() * right).z
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn points_of_a_steep_plane_give_the_plane() {
        let plane = |s: f64, t: f64| {
            DVec3::new(1000.0 + 800.0 * s + 60.0 * t, 5000.0 + 900.0 * s - 40.0 * t, 200.0 + 900.0 * t)
        };
        let points: Vec<DVec3> =
            (0..400).map(|n| plane(f64::from(n % 23) / 22.0, f64::from(n * 7 % 31) / 30.0)).collect();
        let (mesh, rms) = fit(&points, 1.0).unwrap();
        let normal = (plane(1.0, 0.0) - plane(0.0, 0.0)).cross(plane(0.0, 1.0) - plane(0.0, 0.0)).normalize();
        assert!(rms < 0.01, "{rms}");
        assert!(mesh.vertices.iter().all(|v| (*v - plane(0.0, 0.0)).dot(normal).abs() < 0.01));
        let area: f64 = (0..mesh.triangles.len())
            .map(|t| mesh.corners(t))
            .map(|[a, b, c]| 0.5 * (b - a).cross(c - a).length())
            .sum();
        let whole = (plane(1.0, 0.0) - plane(0.0, 0.0)).cross(plane(0.0, 1.0) - plane(0.0, 0.0)).length();
        assert!((0.85..1.001).contains(&(area / whole)), "{}", area / whole);
    }

    #[test]
    fn noise_is_averaged_and_a_bend_is_kept() {
        let mut state = 3u64;
        let mut random = || {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (state >> 33) as f64 / f64::from(u32::MAX / 2)
        };
        let bend = |y: f64| 60.0 * (y / 400.0).sin();
        let points: Vec<DVec3> = (0..8000)
            .map(|_| {
                let (y, z) = (2000.0 * random(), 1000.0 * random());
                DVec3::new(0.3 * z + bend(y) + 10.0 * (random() - 0.5), y, z)
            })
            .collect();
        let (mesh, rms) = fit(&points, 1.0).unwrap();
        assert!(
            (2.0..3.5).contains(&rms),
            "{rms}: uniform noise of 10 m has 2.9 m across the vertical, 2.76 m across the fault"
        );
        let worst = mesh.vertices.iter().map(|v| (v.x - 0.3 * v.z - bend(v.y)).abs()).fold(0.0, f64::max);
        assert!(worst < 3.0, "{worst}");
    }

    #[test]
    fn a_line_is_no_surface() {
        let line: Vec<DVec3> = (0..20).map(|n| DVec3::new(1.0, 2.0, 3.0) * f64::from(n)).collect();
        assert!(fit(&line, 1.0).is_none());
    }
}
