//! Interpolates scattered points onto the survey's traces, over the Delaunay triangles of the points.
//!
//! Inside a triangle the surface is the cubic with the values and gradients of its corners (Bézier form; the
//! middle coefficient ¼ of the edges' sum − ⅙ of the corners' keeps quadratics exact). It is continuous
//! everywhere and smooth at the points, so that no facets show. A point's gradient is the plane through it
//! that fits its neighbours best by the sum of distances (weighted 1/d², reweighted by the residual):
//! neighbours beyond a fault are outvoted instead of averaged in. Planes are reproduced exactly.
//!
//! A triangle whose circumcircle is larger than `gap` in radius is left out (an alpha shape; Edelsbrunner,
//! Kirkpatrick & Seidel 1983): so are bays of the points' outline, and gaps in their middle, and the slivers
//! along their convex hull. Nothing is extrapolated. A trace with a point within half a bin is `Picked`,
//! others are `Filled`. The default gap is twice the median length of a triangle's side, which bridges random
//! thinning and keeps real gaps.

use super::placement::{voxel_xy, world_xy};
use super::raster;
use super::sheets::{self, Crowded, NodeValues};
use delaunator::{Point, triangulate};
use glam::{DMat2, DVec2, DVec3};
use rayon::prelude::*;
use std::collections::HashMap;
use survey::geometry::{SurveyGeometry, VerticalUnit};
use survey::horizon::{NodeGrid, Quality, Sheet};

/// How far the surface may leave the range of a triangle's corners, as a share of that range: enough for the
/// crest of a fold, and no ringing beside a fault.
const OVERSHOOT: f64 = 0.25;

/// Depths at one place that differ by less than this, in samples, are the same depth given twice.
pub(super) const SAME_DEPTH: f64 = 0.05;

/// Points gridded onto the survey's traces.
pub(super) struct Gridded {
    pub sheets: Vec<Sheet>,
    pub gap_m: f64,
    /// Points that share their place with another of clearly different depth.
    pub multivalued: usize,
    /// Points that repeat another's place and depth.
    pub repeated: usize,
    /// Points that stand out from their neighbours; they are kept.
    pub outliers: Option<Outliers>,
}

/// Points that stand out from their neighbours.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Outliers {
    pub count: usize,
    /// World X, Y, depth and height above its neighbours' median of the one that stands out most.
    pub worst: [f64; 4],
    /// The height from which a point stands out.
    pub limit: f64,
}

impl Outliers {
    /// The warning for the user.
    pub(crate) fn sentence(&self, unit: VerticalUnit) -> String {
        let [x, y, z, off] = self.worst;
        let unit = unit.symbol();
        format!(
            "{} points lie more than {:.1} {unit} off their neighbours, where most lie within a tenth of that: \
             mis-picks? The worst, {off:+.1} {unit}, is {z:.1} at {x:.1}, {y:.1}. They were kept",
            self.count, self.limit
        )
    }
}

/// How many times the usual deviation (1.4826 · median |residual|) makes an outlier.
const OUTLIER: f64 = 10.0;

/// The points that are farther from the median of their neighbours than [`OUTLIER`] times the usual deviation and than
/// ten tolerances.
fn outliers(world: &[DVec2], values: &NodeValues, neighbours: &[Vec<usize>], tolerance: f32) -> Option<Outliers> {
    let z = |n: usize| f64::from(values.z[values.offsets[n] as usize]);
    let residual = |n: usize| {
        let mut near: Vec<f64> = neighbours[n].iter().map(|&m| z(m)).collect();
        if near.len() < 6 || values.offsets[n + 1] - values.offsets[n] != 1 {
            return 0.0;
        }
        near.sort_by(f64::total_cmp);
        z(n) - 0.5 * (near[(near.len() - 1) / 2] + near[near.len() / 2])
    };
    let residuals: Vec<f64> = (0..world.len()).into_par_iter().map(residual).collect();
    let mut sizes: Vec<f64> = residuals.iter().map(|r| r.abs()).filter(|r| *r > 0.0).collect();
    if sizes.len() < 30 {
        return None;
    }
    sizes.sort_by(f64::total_cmp);
    let limit = (OUTLIER * 1.4826 * sizes[sizes.len() / 2]).max(10.0 * f64::from(tolerance));
    let count = sizes.iter().filter(|r| **r > limit).count();
    let worst = (0..world.len()).max_by(|a, b| residuals[*a].abs().total_cmp(&residuals[*b].abs()))?;
    (count > 0).then(|| Outliers { count, worst: [world[worst].x, world[worst].y, z(worst), residuals[worst]], limit })
}

/// The radius of the circle through three points; infinite for points in line.
pub(super) fn circumradius([a, b, c]: [DVec2; 3]) -> f64 {
    let area = 0.5 * (b - a).perp_dot(c - a).abs();
    a.distance(b) * b.distance(c) * c.distance(a) / (4.0 * area)
}

/// Points with the same place, to a hundredth of a bin, as one node.
struct MergedPoints {
    voxels: Vec<DVec2>,
    node: Vec<usize>,
}

impl MergedPoints {
    fn of(voxels: &[DVec2]) -> Self {
        let mut places = Self { voxels: Vec::new(), node: Vec::with_capacity(voxels.len()) };
        let mut known = HashMap::new();
        for v in voxels {
            let key = ((v.x * 100.0).round() as i64, (v.y * 100.0).round() as i64);
            let node = *known.entry(key).or_insert_with(|| {
                places.voxels.push(*v);
                places.voxels.len() - 1
            });
            places.node.push(node);
        }
        places
    }
}

/// Delaunay triangles of places, in metres relative to the first.
pub(super) fn delaunay(places: &[DVec2]) -> Vec<[usize; 3]> {
    let origin = places.first().copied().unwrap_or_default();
    let points: Vec<_> = places.iter().map(|p| Point { x: p.x - origin.x, y: p.y - origin.y }).collect();
    triangulate(&points).triangles.chunks_exact(3).map(|t| [t[0], t[1], t[2]]).collect()
}

/// The median length of the triangles' sides; 0 without triangles.
pub(super) fn median_side(places: &[DVec2], triangles: &[[usize; 3]]) -> f64 {
    let mut sides: Vec<f64> = triangles
        .iter()
        .flat_map(|&[a, b, c]| [(a, b), (b, c), (c, a)])
        .map(|(a, b)| places[a].distance(places[b]))
        .collect();
    sides.sort_by(f64::total_cmp);
    sides.get(sides.len() / 2).copied().unwrap_or(0.0)
}

/// Grids points (voxel x, y; depth) onto the survey's traces.
///
/// Depths at one place closer than `tolerance` are averaged; others are split into sheets by continuity.
///
/// # Errors
/// [`Crowded`] when a place has too many depths.
pub(super) fn grid(
    points: &[(DVec2, f32)],
    geometry: &SurveyGeometry,
    gap_m: Option<f64>,
    tolerance: f32,
) -> Result<Gridded, Crowded> {
    let voxels: Vec<DVec2> = points.iter().map(|p| p.0).collect();
    let places = MergedPoints::of(&voxels);
    let world: Vec<DVec2> = places.voxels.iter().map(|v| world_xy(geometry, *v)).collect();
    let triangles = delaunay(&world);
    let gap_m = gap_m.unwrap_or_else(|| 2.0 * median_side(&world, &triangles));

    let pairs: Vec<(usize, f32)> = places.node.iter().zip(points).map(|(&n, p)| (n, p.1)).collect();
    let (values, _) = NodeValues::group(places.voxels.len(), &pairs, tolerance)?;
    let repeated = pairs.len() - values.z.len();
    let neighbours = neighbours(places.voxels.len(), &triangles);
    let outliers = outliers(&world, &values, &neighbours, tolerance);
    let sheet = sheets::split(&values, &|n| neighbours[n].clone());
    let count = sheet.iter().max().map_or(1, |&s| usize::from(s) + 1);
    let sheets = (0..count)
        .map(|s| {
            let own: Vec<(DVec2, f32)> = (0..places.voxels.len())
                .flat_map(|n| (values.offsets[n]..values.offsets[n + 1]).map(move |e| (n, e as usize)))
                .filter(|&(_, e)| usize::from(sheet[e]) == s)
                .map(|(n, e)| (places.voxels[n], values.z[e]))
                .collect();
            interpolate(&own, geometry, gap_m)
        })
        .collect();
    Ok(Gridded { sheets, gap_m, multivalued: values.multivalued(), repeated, outliers })
}

/// The sheets of scattered points (world X, Y, vertical value) as they are without faults; empty where a place has too many
/// depths.
///
/// ```
/// use glam::DVec3;
/// use survey::{SurveyGeometry, VerticalUnit};
///
/// let geometry = SurveyGeometry::regular([11, 11, 50], 10.0, 4.0, VerticalUnit::Metres);
/// let points = [(3.0, 4.0), (97.0, 2.0), (5.0, 93.0), (94.0, 96.0)].map(|(x, y)| DVec3::new(x, y, 50.0 + 0.5 * x));
/// let sheets = files::grid_points(&points, &geometry, Some(100.0));
/// assert!((sheets[0].depth[5 * 11 + 5] - 75.0).abs() < 1e-3);
/// ```
pub fn grid_points(points: &[DVec3], geometry: &SurveyGeometry, gap_m: Option<f64>) -> Vec<Sheet> {
    let tolerance = (SAME_DEPTH * geometry.vertical.interval) as f32;
    let pairs: Vec<_> = points.iter().map(|p| (voxel_xy(geometry, p.truncate()), p.z as f32)).collect();
    grid(&pairs, geometry, gap_m, tolerance).map_or_else(|_| Vec::new(), |gridded| gridded.sheets)
}

/// The points of one fault block that stand out from their neighbours there.
pub(super) fn outliers_of(points: &[(DVec2, f32)], geometry: &SurveyGeometry) -> Option<Outliers> {
    let tolerance = (SAME_DEPTH * geometry.vertical.interval) as f32;
    let world: Vec<DVec2> = points.iter().map(|p| world_xy(geometry, p.0)).collect();
    let pairs: Vec<(usize, f32)> = points.iter().enumerate().map(|(n, p)| (n, p.1)).collect();
    let (values, _) = NodeValues::group(points.len(), &pairs, tolerance).ok()?;
    outliers(&world, &values, &neighbours(points.len(), &delaunay(&world)), tolerance)
}

/// The other corners of the triangles around each point, one that two triangles share twice.
fn neighbours(points: usize, triangles: &[[usize; 3]]) -> Vec<Vec<usize>> {
    let mut neighbours = vec![Vec::new(); points];
    for t in triangles {
        (0..3).for_each(|n| neighbours[t[n]].extend([t[(n + 1) % 3], t[(n + 2) % 3]]));
    }
    neighbours
}

/// A gradient per point, m⁻¹, from its neighbours along triangle sides no longer than `gap_m`; 0 without
/// neighbours.
fn gradients(world: &[DVec2], z: &[f32], triangles: &[[usize; 3]], gap_m: f64) -> Vec<DVec2> {
    let neighbours = neighbours(world.len(), triangles);
    let gradient = |n: usize| {
        let mut near = neighbours[n].clone();
        near.sort_unstable();
        near.dedup();
        let rows: Vec<(DVec2, f64)> = near
            .iter()
            .map(|&m| (world[m] - world[n], f64::from(z[m]) - f64::from(z[n])))
            .filter(|(d, _)| d.length() <= gap_m)
            .collect();
        let mut weights: Vec<f64> = rows.iter().map(|(d, _)| d.length_squared().recip()).collect();
        let mut found = DVec2::ZERO;
        for _ in 0..8 {
            let (mut normal, mut right) = (DMat2::ZERO, DVec2::ZERO);
            for ((d, rise), weight) in rows.iter().zip(&weights) {
                normal += DMat2::from_cols(*d * d.x, *d * d.y) * *weight;
                right += *d * (*rise * *weight);
            }
            // With weights of 1/d² the sum of squares is about the number of neighbours; along a line the slope across
            // it stays 0.
            if normal.determinant() <= 1e-4 * (normal.x_axis.x + normal.y_axis.y).powi(2) {
                return DVec2::ZERO;
            }
            found = normal.inverse() * right;
            let slopes: Vec<f64> = rows.iter().map(|(d, rise)| (rise - found.dot(*d)).abs() / d.length()).collect();
            let mean = slopes.iter().sum::<f64>() / slopes.len() as f64;
            if mean <= 1e-12 {
                break;
            }
            for ((weight, slope), (d, _)) in weights.iter_mut().zip(&slopes).zip(&rows) {
                *weight = (d.length_squared() * (slope + 0.1 * mean) / mean).recip();
            }
        }
        found
    };
    (0..world.len()).into_par_iter().map(gradient).collect()
}

/// The cubic over a triangle with corner values `z` and gradients, at barycentric coordinates `b`.
fn cubic(corners: [DVec2; 3], z: [f64; 3], gradients: [DVec2; 3], b: [f64; 3]) -> f64 {
    let (mut edges, mut sum) = (0.0, 0.0);
    for n in 0..3 {
        sum += z[n] * b[n].powi(3);
        for m in [(n + 1) % 3, (n + 2) % 3] {
            let control = z[n] + gradients[n].dot(corners[m] - corners[n]) / 3.0;
            edges += control;
            sum += 3.0 * control * b[n] * b[n] * b[m];
        }
    }
    let middle = edges / 4.0 - (z[0] + z[1] + z[2]) / 6.0;
    sum + 6.0 * middle * b[0] * b[1] * b[2]
}

/// Grids one single-valued set of points onto the survey's traces.
fn interpolate(points: &[(DVec2, f32)], geometry: &SurveyGeometry, gap_m: f64) -> Sheet {
    let grid = NodeGrid::of_survey(geometry);
    let [nu, nv] = grid.count;
    let mut depth = vec![f32::NAN; nu * nv];
    let mut quality = vec![Quality::Hole; nu * nv];
    let world: Vec<DVec2> = points.iter().map(|p| world_xy(geometry, p.0)).collect();
    let z: Vec<f32> = points.iter().map(|p| p.1).collect();
    let triangles = delaunay(&world);
    let gradients = gradients(&world, &z, &triangles, gap_m);
    for t in triangles {
        let (places, values) = (t.map(|n| world[n]), t.map(|n| f64::from(z[n])));
        if circumradius(places) > gap_m {
            continue;
        }
        let area = (places[1] - places[0]).perp_dot(places[2] - places[0]);
        // This only determines which traces lie in the triangle.
        let corners = t.map(|n| points[n].0.extend(0.0));
        raster::triangle(corners, grid.count, &mut |u, v, _| {
            let here = grid.world_at(DVec2::new(u as f64, v as f64));
            let share = |a: DVec2, b: DVec2| (a - here).perp_dot(b - here) / area;
            let b = [share(places[1], places[2]), share(places[2], places[0]), share(places[0], places[1])];
            let (low, high) = values.iter().fold((f64::MAX, f64::MIN), |(l, h), &z| (l.min(z), h.max(z)));
            let room = OVERSHOOT * (high - low);
            let z = cubic(places, values, t.map(|n| gradients[n]), b).clamp(low - room, high + room);
            depth[u * nv + v] = z as f32;
            quality[u * nv + v] = Quality::Filled;
        });
    }
    for (voxel, z) in points {
        let near = voxel.round();
        if near.x >= 0.0 && near.y >= 0.0 && near.x < nu as f64 && near.y < nv as f64 {
            let node = near.x as usize * nv + near.y as usize;
            // A point without a triangle (few points, or a point on the rim) still marks its trace.
            if depth[node].is_nan() {
                depth[node] = *z;
            }
            quality[node] = Quality::Picked;
        }
    }
    Sheet { block: None, grid, depth, quality }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn random_points(count: usize) -> Vec<DVec2> {
        let mut state = 11u64;
        let mut random = || {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (state >> 33) as f64 / f64::from(u32::MAX / 2)
        };
        (0..count).map(|_| DVec2::new(random(), random()) * 99.0).collect()
    }

    /// Largest and mean error of gridding `f` from 900 points, away from the rim.
    fn errors(f: impl Fn(f64, f64) -> f64) -> (f64, f64) {
        let geometry = SurveyGeometry::regular([100, 100, 100], 10.0, 1.0, VerticalUnit::Metres);
        let points: Vec<_> = random_points(900).into_iter().map(|p| (p, f(p.x, p.y) as f32)).collect();
        let gridded = grid(&points, &geometry, None, 1e-3).unwrap();
        let sheet = &gridded.sheets[0];
        let (mut largest, mut sum, mut count) = (0.0f64, 0.0, 0.0);
        for x in 8..92 {
            for y in 8..92 {
                let n = x * 100 + y;
                if sheet.quality[n] == Quality::Filled {
                    let error = (f64::from(sheet.depth[n]) - f(x as f64, y as f64)).abs();
                    largest = largest.max(error);
                    sum += error;
                    count += 1.0;
                }
            }
        }
        assert!(count > 4000.0);
        (largest, sum / count)
    }

    #[test]
    fn planes_are_exact_and_a_dome_is_round() {
        let (largest, _) = errors(|x, y| 500.0 + 2.0 * x - 3.0 * y);
        assert!(largest < 1e-3, "{largest}");
        let dome = |x: f64, y: f64| 500.0 - 100.0 * (-((x - 50.0).powi(2) + (y - 45.0).powi(2)) / 800.0).exp();
        let (largest, mean) = errors(dome);
        // Flat triangles miss this dome by 0.33 on average.
        assert!(mean < 0.15 && largest < 3.0, "{mean} {largest}");
    }

    #[test]
    fn a_step_does_not_ring() {
        // A fault at x = 50 with a throw of 30: only the triangles across it may leave the two levels, by a
        // quarter of the throw.
        let step = |x: f64, _: f64| if x < 50.0 { 400.0 } else { 430.0 };
        let geometry = SurveyGeometry::regular([100, 100, 100], 10.0, 1.0, VerticalUnit::Metres);
        let points: Vec<_> = random_points(900).into_iter().map(|p| (p, step(p.x, p.y) as f32)).collect();
        let gridded = grid(&points, &geometry, None, 1e-3).unwrap();
        for (n, z) in gridded.sheets[0].depth.iter().enumerate().filter(|(_, z)| z.is_finite()) {
            let x = (n / 100) as f64;
            assert!((392.0..438.0).contains(z), "{z}");
            assert!((x - 50.0).abs() < 12.0 || f64::from(*z) == step(x, 0.0), "{z} at {x}");
        }
    }
}
