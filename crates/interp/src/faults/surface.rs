//! The smooth surface of a fault: the distance across strike as a quadratic of strike and depth.
//!
//! `c(s, z) = c₀ + c₁s + c₂z + c₃s² + c₄sz + c₅z²`, fitted by least squares, up to three times, each time
//! without the outliers. With pairs on fewer than three horizons c₅ is left out. With a single horizon c₄ is
//! left out too, and c₂ is the dip along which semblance is lowest, or else the median of heave over throw.
//! Metric space; s and z are measured from the middle.

use super::pairs::Pair;
use super::traces::across_m;
use super::{Evidence, ProposeSettings, metres};
use glam::{DVec2, DVec3};
use std::collections::BTreeMap;
use survey::{SurveyGeometry, TriangleMesh, Volume};

/// Points farther from the fit than this many times its RMS are left out of the next fit.
const OUTLIER: f64 = 2.5;
/// Distance between nodes of the mesh along strike, traces, and down dip, samples.
const MESH: [f64; 2] = [4.0, 6.0];
/// Distance from the outer boundary within which an end is extended to the boundary, traces.
const TO_BOUNDARY: f64 = 8.0;
/// Farthest extension of a fault beyond its last pair, in traces and as a share of its length.
const BEYOND: [f64; 2] = [30.0, 0.5];
/// The search for a dip in semblance: step between dips, degrees; samples above and below the horizon;
/// largest count of points.
const LEAN_STEP_DEG: f64 = 5.0;
const LEAN_REACH: i32 = 20;
const LEAN_PLACES: usize = 400;
/// Least difference between the lowest mean semblance and the mean over all dips.
const LEAN_CLEAR: f64 = 0.01;
/// Largest count of coefficients.
const TERMS: usize = 6;

/// The fitted surface of a fault.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct FittedFault {
    middle: DVec3,
    along: DVec2,
    across: DVec2,
    c: [f64; TERMS],
    /// Extent along strike and in depth, m from the middle.
    s: [f64; 2],
    z: [f64; 2],
    /// RMS distance of its points, m.
    pub misfit_m: f64,
}

impl FittedFault {
    /// Fits the pairs of a fault; `None` when the surface is flatter than [`ProposeSettings::min_dip_deg`] or
    /// the fit has no solution.
    pub(super) fn through(
        pairs: &[Pair],
        geometry: &SurveyGeometry,
        semblance: Option<&Volume<f32>>,
        settings: &ProposeSettings,
    ) -> Option<Self> {
        let metric = geometry.metric_from_voxel();
        let across = across_m(pairs, metric);
        let along = across.perp();
        let places: Vec<DVec3> = pairs.iter().map(|pair| metres(metric, pair.at)).collect();
        let middle = places.iter().copied().sum::<DVec3>() / places.len() as f64;
        let local = |p: &DVec3| {
            let q = (*p - middle).truncate();
            [q.dot(along), q.dot(across), p.z - middle.z]
        };
        let mut points: Vec<[f64; 3]> = places.iter().map(local).collect();
        let mut levels: Vec<usize> = pairs.iter().map(|pair| pair.horizon).collect();
        levels.sort_unstable();
        levels.dedup();
        let mut surface = Self { middle, along, across, c: [0.0; TERMS], s: [0.0; 2], z: [0.0; 2], misfit_m: 0.0 };
        surface.c[2] = run_of_pairs(pairs, metric);
        let used: &[usize] = match levels.len() {
            1 => &[0, 1, 3],
            2 => &[0, 1, 2, 3, 4],
            _ => &[0, 1, 2, 3, 4, 5],
        };
        if let (1, Some(volume)) = (levels.len(), semblance) {
            surface.lean(&points, used, geometry, volume, settings.min_dip_deg)?;
        }
        for _ in 0..3 {
            surface.fit(&points, used)?;
            let limit = OUTLIER * surface.misfit_m;
            let near: Vec<[f64; 3]> =
                points.iter().copied().filter(|p| (p[1] - surface.c_at(p[0], p[2])).abs() <= limit).collect();
            if near.len() == points.len() || near.len() < 3 * used.len() {
                break;
            }
            points = near;
        }
        for p in &points {
            surface.s = [surface.s[0].min(p[0]), surface.s[1].max(p[0])];
            surface.z = [surface.z[0].min(p[2]), surface.z[1].max(p[2])];
        }
        (surface.run().1 <= 1.0 / settings.min_dip_deg.to_radians().tan()).then_some(surface)
    }

    /// Sets c₂ of a fault on a single horizon to the dip on which the semblance around the horizon is lowest,
    /// of all dips to both sides. Where none stands out, c₂ stays what heave and throw make it. `None` when a
    /// fit has no solution.
    fn lean(
        &mut self,
        points: &[[f64; 3]],
        used: &[usize],
        geometry: &SurveyGeometry,
        semblance: &Volume<f32>,
        min_dip_deg: f64,
    ) -> Option<()> {
        let inverse = geometry.metric_from_voxel().inverse();
        let sample_m = geometry.sample_m();
        let every = points.len().div_ceil(LEAN_PLACES);
        let steps = ((90.0 - min_dip_deg) / LEAN_STEP_DEG) as i32;
        let known = self.c[2];
        let mut tried = Vec::new();
        for step in -steps..=steps {
            self.c[2] = (f64::from(step) * LEAN_STEP_DEG).to_radians().tan();
            self.fit(points, used)?;
            let around = |p: &[f64; 3]| {
                let [s, z] = [p[0], p[2]];
                (-LEAN_REACH..=LEAN_REACH).map(move |by| [s, z + f64::from(by) * sample_m])
            };
            let places = points.iter().step_by(every).flat_map(around).map(|[s, z]| inverse * self.at(s, z));
            let (sum, count) = places
                .filter_map(|voxel| value_near(semblance, voxel))
                .fold((0.0, 0usize), |(sum, count), value| (sum + value, count + 1));
            if count > 0 {
                tried.push((sum / count as f64, self.c[2]));
            }
        }
        let mean = tried.iter().map(|(value, _)| value).sum::<f64>() / tried.len().max(1) as f64;
        let least = tried.iter().min_by(|a, b| a.0.total_cmp(&b.0)).filter(|least| mean - least.0 >= LEAN_CLEAR);
        self.c[2] = least.map_or(known, |least| least.1);
        Some(())
    }

    fn fit(&mut self, points: &[[f64; 3]], used: &[usize]) -> Option<()> {
        // The terms are scaled, so that the normal equations are well conditioned.
        let scale = |axis: usize| points.iter().map(|p| p[axis].abs()).fold(1.0, f64::max);
        let scales = scales_of(scale(0), scale(2));
        let mut matrix = [[0.0; TERMS]; TERMS];
        let mut right = [0.0; TERMS];
        for p in points {
            let terms = terms_of(p[0], p[2]);
            let known: f64 = (0..TERMS).filter(|n| !used.contains(n)).map(|n| self.c[n] * terms[n]).sum();
            for (a, &i) in used.iter().enumerate() {
                right[a] += terms[i] / scales[i] * (p[1] - known);
                for (b, &j) in used.iter().enumerate() {
                    matrix[a][b] += terms[i] / scales[i] * (terms[j] / scales[j]);
                }
            }
        }
        // A weak regularisation where the points determine nothing; it affects quadratic terms first.
        for (a, &i) in used.iter().enumerate() {
            matrix[a][a] += points.len() as f64 * if i >= 3 { 1e-4 } else { 1e-9 };
        }
        let solution = solve(&mut matrix, &mut right, used.len())?;
        for (a, &i) in used.iter().enumerate() {
            self.c[i] = solution[a] / scales[i];
        }
        let sum: f64 = points.iter().map(|p| (p[1] - self.c_at(p[0], p[2])).powi(2)).sum();
        self.misfit_m = (sum / points.len() as f64).sqrt();
        Some(())
    }

    fn c_at(&self, s: f64, z: f64) -> f64 {
        terms_of(s, z).iter().zip(self.c).map(|(term, c)| term * c).sum()
    }

    /// The point of the surface at (s, z), metric.
    fn at(&self, s: f64, z: f64) -> DVec3 {
        self.middle + (self.along * s + self.across * self.c_at(s, z)).extend(z)
    }

    /// Whether it dips towards `across`, and cot(dip) at its middle.
    pub(super) fn run(&self) -> (bool, f64) {
        let [low, high] = self.z;
        let depth = (high - low).max(1.0);
        let run = (self.c_at(0.0, low + depth) - self.c_at(0.0, low)) / depth;
        // `across` is normal to the strike only at the middle of the fit.
        let strike = self.c[1];
        (run > 0.0, run.abs() / (1.0 + strike * strike).sqrt())
    }

    /// Horizontal direction of the strike.
    pub(super) fn strike(&self) -> DVec2 {
        (self.along + self.across * self.c[1]).normalize()
    }

    /// The throw of a pair, positive if the side towards which `across` points is deeper.
    pub(super) fn throw_across(&self, pair: &Pair) -> f64 {
        f64::from(pair.throw)
    }

    /// The area of the offset, m²: the mean throw in each bin along strike in which a horizon has pairs,
    /// times the bin's width, summed over bins and horizons.
    pub(super) fn offset_m2(&self, pairs: &[Pair], geometry: &SurveyGeometry) -> f64 {
        let metric = geometry.metric_from_voxel();
        let bin_m = 0.5 * (metric.x_axis.length() + metric.y_axis.length());
        let mut bins: BTreeMap<(usize, i64), (f64, f64)> = BTreeMap::new();
        for pair in pairs {
            let s = (metres(metric, pair.at) - self.middle).truncate().dot(self.along);
            let (sum, count) = bins.entry((pair.horizon, (s / bin_m).floor() as i64)).or_default();
            *sum += f64::from(pair.throw.abs()) * geometry.sample_m();
            *count += 1.0;
        }
        bins.values().map(|(sum, count)| sum / count * bin_m).sum()
    }

    /// The two ends at middle depth, metric.
    pub(super) fn ends(&self) -> [DVec3; 2] {
        let z = 0.5 * (self.z[0] + self.z[1]);
        self.s.map(|s| self.at(s, z))
    }

    /// Shallowest and deepest point, m.
    pub(super) fn depths_m(&self) -> [f64; 2] {
        self.z.map(|z| z + self.middle.z)
    }

    /// Extends the surface to where it ends. Along strike: to the outer boundary if its points nearly reach
    /// it, or to where the throw has decreased to 0. In depth: to the next unbroken horizon, or through the
    /// volume.
    pub(super) fn extended(mut self, pairs: &[Pair], horizons: &[Evidence], geometry: &SurveyGeometry) -> Self {
        let metric = geometry.metric_from_voxel();
        let bin_m = 0.5 * (metric.x_axis.length() + metric.y_axis.length());
        let inverse = metric.inverse();
        let [nx, ny, nz] = geometry.size();
        let inside = |p: DVec3| {
            let v = inverse * p;
            v.x >= 0.0 && v.y >= 0.0 && v.x <= (nx - 1) as f64 && v.y <= (ny - 1) as f64
        };
        let throw: Vec<(f64, f64)> = pairs
            .iter()
            .map(|pair| {
                ((metres(metric, pair.at) - self.middle).truncate().dot(self.along), f64::from(pair.throw.abs()))
            })
            .collect();
        let reach = self.s;
        for (end, sign) in [(0, -1.0), (1, 1.0)] {
            let last = reach[end];
            let z = 0.5 * (self.z[0] + self.z[1]);
            let at_boundary = (1..=TO_BOUNDARY as usize).any(|k| !inside(self.at(last + sign * k as f64 * bin_m, z)));
            let by = if at_boundary {
                2.0 * TO_BOUNDARY * bin_m
            } else {
                dies_out(&throw, reach, end).min(BEYOND[0] * bin_m).min(BEYOND[1] * (reach[1] - reach[0]))
            };
            self.s[end] = last + sign * by;
        }
        let mut used: Vec<usize> = pairs.iter().map(|pair| pair.horizon).collect();
        used.sort_unstable();
        used.dedup();
        let mut limits = [-self.middle.z, (nz - 1) as f64 * metric.z_axis.z - self.middle.z];
        for (h, horizon) in horizons.iter().enumerate() {
            if used.contains(&h) {
                continue;
            }
            if let Some(z) = self.unbroken(horizon, geometry) {
                if z < self.z[0] {
                    limits[0] = limits[0].max(0.5 * (z + self.z[0]));
                } else if z > self.z[1] {
                    limits[1] = limits[1].min(0.5 * (z + self.z[1]));
                }
            }
        }
        self.z = limits;
        self
    }

    /// The mean depth (m from the middle) at which a horizon passes the surface without an offset over most
    /// of its length; `None` if it does not.
    fn unbroken(&self, horizon: &Evidence, geometry: &SurveyGeometry) -> Option<f64> {
        const STATIONS: usize = 24;
        let metric = geometry.metric_from_voxel();
        let inverse = metric.inverse();
        let [nx, ny, _] = geometry.size();
        let sample = |p: DVec2| {
            let v = inverse * p.extend(0.0);
            let (x, y) = (v.x.round(), v.y.round());
            let inside = x >= 0.0 && y >= 0.0 && x < nx as f64 && y < ny as f64;
            let n = inside.then(|| x as usize * ny + y as usize)?;
            horizon.sheets.iter().map(|sheet| sheet.z[n]).find(|z| z.is_finite()).map(f64::from)
        };
        let bin_m = metric.x_axis.length();
        let (mut whole, mut depth) = (0, 0.0);
        for k in 0..STATIONS {
            let s = self.s[0] + (self.s[1] - self.s[0]) * (k as f64 + 0.5) / STATIONS as f64;
            // Find where the horizon meets the surface, by a few fixed-point iterations.
            let mut z = 0.0;
            let mut met = None;
            for _ in 0..6 {
                let Some(found) = sample(self.at(s, z).truncate()) else { break };
                z = found * metric.z_axis.z - self.middle.z;
                met = Some(found);
            }
            let Some(met) = met else { continue };
            let place = self.at(s, z).truncate();
            let side = |by: f64| sample(place + self.across * (by * bin_m));
            if let (Some(a), Some(b)) = (side(-3.0), side(3.0))
                && (0.5 * (a + b) - met).abs() < 1.5
            {
                whole += 1;
                depth += z;
            }
        }
        (2 * whole > STATIONS).then(|| depth / f64::from(whole as u32))
    }

    /// The surface as a mesh in world coordinates, in strips of equal steps along strike and in depth.
    pub(super) fn mesh(&self, geometry: &SurveyGeometry) -> TriangleMesh {
        let metric = geometry.metric_from_voxel();
        let bin_m = 0.5 * (metric.x_axis.length() + metric.y_axis.length());
        let count = |range: [f64; 2], step: f64| ((range[1] - range[0]) / step).ceil().max(1.0) as usize;
        let cells = [count(self.s, MESH[0] * bin_m), count(self.z, MESH[1] * metric.z_axis.z)];
        let inverse = metric.inverse();
        let mut mesh = TriangleMesh::default();
        for a in 0..=cells[0] {
            for b in 0..=cells[1] {
                let part =
                    |range: [f64; 2], n: usize, of: usize| range[0] + (range[1] - range[0]) * n as f64 / of as f64;
                let p = self.at(part(self.s, a, cells[0]), part(self.z, b, cells[1]));
                mesh.vertices.push(geometry.world_from_voxel(inverse * p));
            }
        }
        let row = cells[1] as u32 + 1;
        for a in 0..cells[0] as u32 {
            for b in 0..cells[1] as u32 {
                let corner = a * row + b;
                mesh.triangles.push([corner, corner + row, corner + 1]);
                mesh.triangles.push([corner + 1, corner + row, corner + row + 1]);
            }
        }
        mesh
    }
}

/// The value of the nearest voxel; `None` outside the volume and where the value is not finite.
fn value_near(volume: &Volume<f32>, voxel: DVec3) -> Option<f64> {
    let voxel = voxel.round();
    let inside = (0..3).all(|axis| voxel[axis] >= 0.0 && voxel[axis] < volume.size()[axis] as f64);
    let value = inside.then(|| volume.at(voxel.x as usize, voxel.y as usize, voxel.z as usize))?;
    value.is_finite().then_some(f64::from(value))
}

/// Mean semblance on the surface, and eight traces away from it on both sides.
pub(super) fn semblance_on(surface: &FittedFault, geometry: &SurveyGeometry, volume: &Volume<f32>) -> [f32; 2] {
    const STATIONS: usize = 64;
    const OFF_TRACES: f64 = 8.0;
    let metric = geometry.metric_from_voxel();
    let inverse = metric.inverse();
    let mut sums = [(0.0f64, 0usize); 2];
    for a in 0..STATIONS {
        for b in 0..STATIONS {
            let part =
                |range: [f64; 2], n: usize| range[0] + (range[1] - range[0]) * (n as f64 + 0.5) / STATIONS as f64;
            let p = surface.at(part(surface.s, a), part(surface.z, b));
            for (kind, off) in [(0, 0.0), (1, -OFF_TRACES), (1, OFF_TRACES)] {
                let q = inverse * (p + (surface.across * (off * metric.x_axis.length())).extend(0.0));
                if let Some(value) = value_near(volume, q) {
                    sums[kind].0 += value;
                    sums[kind].1 += 1;
                }
            }
        }
    }
    sums.map(|(sum, count)| (sum / count.max(1) as f64) as f32)
}

/// Distance (m) beyond an end of the trace at which the throw, extrapolated from the last third, is 0.
fn dies_out(throw: &[(f64, f64)], reach: [f64; 2], end: usize) -> f64 {
    let third = (reach[1] - reach[0]) / 3.0;
    let from_end = |s: f64| (s - reach[end]).abs();
    let near: Vec<(f64, f64)> =
        throw.iter().map(|&(s, t)| (from_end(s), t)).filter(|(distance, _)| *distance <= third).collect();
    let count = near.len() as f64;
    if count < 4.0 {
        return 0.0;
    }
    let (ms, mt) = near.iter().fold((0.0, 0.0), |sum, p| (sum.0 + p.0 / count, sum.1 + p.1 / count));
    let (ss, st) = near.iter().fold((0.0, 0.0), |sum, p| (sum.0 + (p.0 - ms).powi(2), sum.1 + (p.0 - ms) * (p.1 - mt)));
    let slope = st / ss.max(1e-9);
    let at_end = mt - slope * ms;
    // Where the throw does not decrease towards the end, its end is unknown.
    if slope <= 0.0 || at_end <= 0.0 { 0.0 } else { at_end / slope }
}

/// Median of heave over throw: the cotangent of the dip according to the rims of one horizon, positive for a
/// dip towards `across`.
fn run_of_pairs(pairs: &[Pair], metric: glam::DMat3) -> f64 {
    let bin_m = 0.5 * (metric.x_axis.length() + metric.y_axis.length());
    let mut runs: Vec<f64> = pairs
        .iter()
        .map(|pair| f64::from(pair.heave) * bin_m / (f64::from(pair.throw) * metric.z_axis.z))
        .filter(|run| run.is_finite())
        .collect();
    runs.sort_by(f64::total_cmp);
    runs.get(runs.len() / 2).copied().unwrap_or(0.0)
}

fn terms_of(s: f64, z: f64) -> [f64; TERMS] {
    [1.0, s, z, s * s, s * z, z * z]
}

fn scales_of(s: f64, z: f64) -> [f64; TERMS] {
    terms_of(s, z)
}

/// Gaussian elimination with pivots on the first `count` rows and columns; `None` for a singular matrix.
fn solve(matrix: &mut [[f64; TERMS]; TERMS], right: &mut [f64; TERMS], count: usize) -> Option<[f64; TERMS]> {
    for column in 0..count {
        let pivot = (column..count).max_by(|&a, &b| matrix[a][column].abs().total_cmp(&matrix[b][column].abs()))?;
        if matrix[pivot][column].abs() < 1e-12 {
            return None;
        }
        matrix.swap(column, pivot);
        right.swap(column, pivot);
        for row in column + 1..count {
            let factor = matrix[row][column] / matrix[column][column];
            let (above, below) = matrix.split_at_mut(row);
            for (value, pivot) in below[0][column..count].iter_mut().zip(&above[column][column..count]) {
                *value -= factor * pivot;
            }
            right[row] -= factor * right[column];
        }
    }
    let mut solution = [0.0; TERMS];
    for row in (0..count).rev() {
        let rest: f64 = (row + 1..count).map(|k| matrix[row][k] * solution[k]).sum();
        solution[row] = (right[row] - rest) / matrix[row][row];
    }
    Some(solution)
}
