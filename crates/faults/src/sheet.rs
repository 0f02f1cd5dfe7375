//! A fault surface as a height across strike over cells of strike and depth: it cannot fold back over itself.
//!
//! The height is a robust quadratic through its ridges plus what is left, smoothed. Space: voxels; cells are [`WIDTH`] traces
//! along strike by [`ROW`] samples.

use crate::ridges::Ridge;
use attribute::likelihood::{Plane, ROW};
use glam::DVec3;
use survey::{SurveyGeometry, TriangleMesh};

/// Traces of a cell along strike.
pub(crate) const WIDTH: f32 = 2.0;
/// Standard deviation of the smoothing of what the quadratic leaves, cells.
const SMOOTH: f32 = 3.0;
/// Distance from the quadratic at which a ridge counts half, traces.
const ROBUST: f64 = 2.0;
/// Rounds of reweighting.
const ROUNDS: usize = 5;
/// Terms of the quadratic.
const TERMS: usize = 6;

/// Where a sheet lies: directions along and across strike from an origin.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Frame {
    /// Lines of the origin.
    pub origin: [f32; 2],
    /// Along strike, a unit vector of traces.
    pub along: [f32; 2],
    /// Across strike, a quarter turn on.
    pub across: [f32; 2],
}

impl Frame {
    /// Along and across strike, traces.
    pub fn place(&self, at: [f32; 3]) -> [f32; 2] {
        let [x, y] = [at[0] - self.origin[0], at[1] - self.origin[1]];
        [x * self.along[0] + y * self.along[1], x * self.across[0] + y * self.across[1]]
    }

    /// Lines of a place along and across strike.
    pub fn lines(&self, u: f32, height: f32) -> [f32; 2] {
        [0, 1].map(|axis| self.origin[axis] + u * self.along[axis] + height * self.across[axis])
    }
}

/// Heights over cells.
#[derive(Debug, Clone, PartialEq)]
pub struct Sheet {
    /// Its place.
    pub frame: Frame,
    /// First cell along strike and first row.
    pub low: [i32; 2],
    /// Cells along strike and rows.
    pub cells: [usize; 2],
    /// Height of each cell, traces, `[along][row]`.
    pub height: Vec<f32>,
    /// Whether the fault is there.
    pub there: Vec<bool>,
}

impl Sheet {
    /// The frame of some ridges: their mean strike through their middle.
    pub(crate) fn frame(ridges: &[Ridge], members: &[usize]) -> Frame {
        // Strikes half a turn apart are one: their doubled angles are averaged.
        let (mut cos, mut sin, mut origin) = (0.0f64, 0.0f64, [0.0f64; 2]);
        for ridge in members.iter().map(|&n| &ridges[n]) {
            let [c, s] = ridge.plane.along.map(f64::from);
            cos += c * c - s * s;
            sin += 2.0 * c * s;
            origin = [origin[0] + f64::from(ridge.at[0]), origin[1] + f64::from(ridge.at[1])];
        }
        let angle = 0.5 * sin.atan2(cos);
        let (cos, sin) = (angle.cos() as f32, angle.sin() as f32);
        let origin = origin.map(|sum| (sum / members.len().max(1) as f64) as f32);
        Frame { origin, along: [cos, sin], across: [-sin, cos] }
    }

    /// The sheet through some ridges, with `margin` cells around them.
    pub(crate) fn through(frame: Frame, ridges: &[Ridge], members: &[usize], margin: i32) -> Self {
        let points: Vec<[f64; 4]> = members
            .iter()
            .map(|&n| {
                let [u, height] = frame.place(ridges[n].at);
                [f64::from(u), f64::from(ridges[n].at[2]), f64::from(height), f64::from(ridges[n].likelihood)]
            })
            .collect();
        let cell = |p: &[f64; 4]| [(p[0] / f64::from(WIDTH)).round() as i32, (p[1] / ROW as f64).round() as i32];
        let (mut low, mut high) = ([i32::MAX; 2], [i32::MIN; 2]);
        for [a, b] in points.iter().map(cell) {
            low = [low[0].min(a), low[1].min(b)];
            high = [high[0].max(a), high[1].max(b)];
        }
        let low = low.map(|n| n - margin);
        let cells = [0, 1].map(|axis| (high[axis] + margin - low[axis] + 1) as usize);
        let quadratic = Quadratic::through(&points);
        let count = cells[0] * cells[1];
        let (mut sums, mut weights) = (vec![0.0f32; count], vec![0.0f32; count]);
        let mut there = vec![false; count];
        for p in &points {
            let [a, b] = cell(p);
            let n = (a - low[0]) as usize * cells[1] + (b - low[1]) as usize;
            let left = p[2] - quadratic.at(p[0], p[1]);
            let weight = p[3] / (1.0 + (left / (2.0 * ROBUST)).powi(2));
            sums[n] += (left * weight) as f32;
            weights[n] += weight as f32;
            there[n] = true;
        }
        let (sums, weights) = (blurred(&sums, cells), blurred(&weights, cells));
        let height = (0..count)
            .map(|n| {
                let (a, b) = ((n / cells[1]) as i32 + low[0], (n % cells[1]) as i32 + low[1]);
                let left = sums[n] / (weights[n] + 0.02);
                quadratic.at(f64::from(a) * f64::from(WIDTH), f64::from(b) * ROW as f64) as f32 + left
            })
            .collect();
        Self { frame, low, cells, height, there }
    }

    /// The sheet of a mesh in world coordinates; `None` where none of it lies in the survey.
    pub fn of_mesh(mesh: &TriangleMesh, geometry: &SurveyGeometry) -> Option<Self> {
        let places: Vec<DVec3> = mesh.vertices.iter().map(|&p| geometry.voxel_from_world(p)).collect();
        // Points closer than half a cell, on every triangle.
        let mut points = Vec::new();
        for triangle in &mesh.triangles {
            let [a, b, c] = triangle.map(|n| places[n as usize]);
            let steps = ((b - a).length().max((c - a).length()).max((c - b).length()) + 1.0).min(256.0) as usize;
            for i in 0..=steps {
                for j in 0..=steps - i {
                    let [s, t] = [i, j].map(|n| n as f64 / steps as f64);
                    points.push(a + (b - a) * s + (c - a) * t);
                }
            }
        }
        let last = geometry.size().map(|count| count as f64 - 1.0);
        points.retain(|p| (0..3).all(|axis| p[axis] >= 0.0 && p[axis] <= last[axis]));
        let middle = points.iter().sum::<DVec3>() / points.len().max(1) as f64;
        // Along strike is where the points spread most.
        let (mut xx, mut xy, mut yy) = (0.0, 0.0, 0.0);
        for off in points.iter().map(|p| *p - middle) {
            (xx, xy, yy) = (xx + off.x * off.x, xy + off.x * off.y, yy + off.y * off.y);
        }
        let angle = 0.5 * (2.0 * xy).atan2(xx - yy);
        let along = [angle.cos() as f32, angle.sin() as f32];
        let plane = Plane { along, across: [-along[1], along[0]], run: 0.0 };
        let ridge = |p: &DVec3| Ridge { at: [p.x as f32, p.y as f32, p.z as f32], plane, likelihood: 1.0 };
        let ridges: Vec<Ridge> = points.iter().map(ridge).collect();
        let members: Vec<usize> = (0..ridges.len()).collect();
        (!members.is_empty()).then(|| Self::through(Self::frame(&ridges, &members), &ridges, &members, 1))
    }

    /// Traces that it leans across strike for a sample down, on average.
    pub(crate) fn lean(&self) -> f32 {
        let (mut sum, mut count) = (0.0f32, 0.0f32);
        for (heights, there) in self.height.chunks(self.cells[1]).zip(self.there.chunks(self.cells[1])) {
            for row in (1..heights.len()).filter(|&row| there[row] && there[row - 1]) {
                sum += heights[row] - heights[row - 1];
                count += ROW as f32;
            }
        }
        if count > 0.0 { sum / count } else { 0.0 }
    }

    /// The cell of a place along strike and a sample.
    pub(crate) fn cell(&self, u: f32, z: f32) -> Option<usize> {
        let (a, b) = ((u / WIDTH).round() as i32 - self.low[0], (z / ROW as f32).round() as i32 - self.low[1]);
        let inside = a >= 0 && b >= 0 && (a as usize) < self.cells[0] && (b as usize) < self.cells[1];
        inside.then(|| a as usize * self.cells[1] + b as usize)
    }

    /// The height at a place along strike and a sample, between cells; held at the edges.
    pub fn height_at(&self, u: f32, z: f32) -> f32 {
        let part = |at: f32, low: i32, count: usize| {
            let at = (at - low as f32).clamp(0.0, (count - 1) as f32);
            let n = (at as usize).min(count.saturating_sub(2));
            (n, (n + 1).min(count - 1), at - n as f32)
        };
        let (a, c, s) = part(u / WIDTH, self.low[0], self.cells[0]);
        let (b, d, t) = part(z / ROW as f32, self.low[1], self.cells[1]);
        let row = |a: usize| self.height[a * self.cells[1] + b] * (1.0 - t) + self.height[a * self.cells[1] + d] * t;
        row(a) * (1.0 - s) + row(c) * s
    }

    /// Whether the fault is at a place along strike and a sample.
    pub fn is_there(&self, u: f32, z: f32) -> bool {
        self.cell(u, z).is_some_and(|n| self.there[n])
    }

    /// Traces along strike and the sample of the middle of a cell.
    pub(crate) fn place(&self, n: usize) -> [f32; 2] {
        let (a, b) = ((n / self.cells[1]) as i32 + self.low[0], (n % self.cells[1]) as i32 + self.low[1]);
        [a as f32 * WIDTH, b as f32 * ROW as f32]
    }

    /// Lines of the middle of a cell, and its sample.
    pub fn voxel(&self, n: usize) -> [f32; 3] {
        let [u, z] = self.place(n);
        let [x, y] = self.frame.lines(u, self.height[n]);
        [x, y, z]
    }

    /// Area, traces times samples.
    pub fn area(&self) -> f32 {
        self.there.iter().filter(|there| **there).count() as f32 * WIDTH * ROW as f32
    }
}

/// A quadratic of place along strike and depth, about a middle.
pub(crate) struct Quadratic {
    middle: [f64; 2],
    scale: [f64; 2],
    terms: [f64; TERMS],
}

impl Quadratic {
    fn basis(&self, u: f64, z: f64) -> [f64; TERMS] {
        let (u, z) = ((u - self.middle[0]) / self.scale[0], (z - self.middle[1]) / self.scale[1]);
        [1.0, u, z, u * u, u * z, z * z]
    }

    pub(crate) fn at(&self, u: f64, z: f64) -> f64 {
        self.basis(u, z).iter().zip(self.terms).map(|(basis, term)| basis * term).sum()
    }

    /// The quadratic near most of the points `[u, z, height, weight]`.
    pub(crate) fn through(points: &[[f64; 4]]) -> Self {
        let count = points.len().max(1) as f64;
        let middle = [0, 1].map(|axis| points.iter().map(|p| p[axis]).sum::<f64>() / count);
        let scale = [0, 1].map(|axis| points.iter().map(|p| (p[axis] - middle[axis]).abs()).fold(1.0, f64::max));
        let mut fit = Self { middle, scale, terms: [0.0; TERMS] };
        let mut weights: Vec<f64> = points.iter().map(|p| p[3]).collect();
        for _ in 0..ROUNDS {
            let mut matrix = [[0.0; TERMS + 1]; TERMS];
            for (p, weight) in points.iter().zip(&weights) {
                let basis = fit.basis(p[0], p[1]);
                for a in 0..TERMS {
                    for b in 0..TERMS {
                        matrix[a][b] += weight * basis[a] * basis[b];
                    }
                    matrix[a][TERMS] += weight * basis[a] * p[2];
                }
            }
            for (n, row) in matrix.iter_mut().enumerate() {
                row[n] += count * if n >= 3 { 1e-3 } else { 1e-9 };
            }
            fit.terms = solved(matrix);
            for (p, weight) in points.iter().zip(&mut weights) {
                let left = (p[2] - fit.at(p[0], p[1])) / ROBUST;
                *weight = p[3] / (1.0 + left * left);
            }
        }
        fit
    }
}

/// Solves a symmetric positive system by elimination.
fn solved(mut matrix: [[f64; TERMS + 1]; TERMS]) -> [f64; TERMS] {
    for n in 0..TERMS {
        let pivot = matrix[n];
        for row in matrix.iter_mut().skip(n + 1) {
            let factor = row[n] / pivot[n];
            row.iter_mut().zip(pivot).for_each(|(value, above)| *value -= factor * above);
        }
    }
    let mut found = [0.0; TERMS];
    for n in (0..TERMS).rev() {
        let rest: f64 = (n + 1..TERMS).map(|m| matrix[n][m] * found[m]).sum();
        found[n] = (matrix[n][TERMS] - rest) / matrix[n][n];
    }
    found
}

/// Values smoothed by a Gaussian along both axes of cells.
pub(crate) fn blurred(values: &[f32], cells: [usize; 2]) -> Vec<f32> {
    let reach = (2.5 * SMOOTH) as usize;
    let weights: Vec<f32> = (0..=reach).map(|n| (-0.5 * (n as f32 / SMOOTH).powi(2)).exp()).collect();
    let total: f32 = 2.0 * weights.iter().sum::<f32>() - 1.0;
    let pass = |values: &[f32], count: usize, step: usize, first: &dyn Fn(usize) -> usize, lines: usize| {
        let mut out = vec![0.0f32; values.len()];
        for line in 0..lines {
            let first = first(line);
            for n in 0..count {
                let range = n.saturating_sub(reach)..(n + reach + 1).min(count);
                let sum: f32 = range.map(|m| weights[m.abs_diff(n)] * values[first + m * step]).sum();
                out[first + n * step] = sum / total;
            }
        }
        out
    };
    let down = pass(values, cells[1], 1, &|line| line * cells[1], cells[0]);
    pass(&down, cells[0], cells[1], &|line| line, cells[1])
}
