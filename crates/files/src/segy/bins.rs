//! The lattice of bins found from X and Y alone, for files whose headers hold no line numbers.
//!
//! 1. The shortest step `a` is the typical difference between a trace and its nearest neighbour, the second
//!    `b` that to the nearest one off the line along `a`: medians and means over thousands of traces, so that
//!    gaps, irregular outlines and coordinates rounded to metres do not matter. The nearest lattice vectors
//!    make a reduced basis.
//! 2. Traces near one in the middle get their indices by rounding, an affine map is fitted to them, and the
//!    region doubles until it holds all: each fit is good enough to round the next ring.
//! 3. The step that most traces make to the next one in the file runs along an inline; the shortest step that
//!    completes it to a basis leads from one inline to the next. So skewed surveys get the axes they were
//!    stored by.
//!
//! It is a lattice if nearly all traces lie within a quarter of a bin; of random positions, one in four does.

use std::collections::HashMap;

use glam::{DMat2, DVec2, I64Vec2};

use super::SegyOptions;
use super::columns::{Columns, HeaderColumn};
use super::coordinates::{Coordinates, varying};
use super::header::NO_INTEGER;
use super::place::Affine;
use crate::lattice::gcd;
use crate::neighbours::PointGrid;

/// Least share of filled bins when the user asks for this lattice.
pub(super) const MIN_FILL_STATED: f64 = 0.05;

/// A trace within this many bins of a lattice position belongs to it.
const NEAR_BINS: f64 = 0.25;
/// Share of the traces that must lie near their bin.
const MIN_NEAR: f64 = 0.95;
/// Count of traces whose neighbours are sought: the steps are then known to a hundredth of the rounding of
/// coordinates.
const MAX_QUERIES: usize = 4096;
/// Differences within this many steps of the median one are the same step.
const SAME_STEP: f64 = 0.25;
/// A neighbour off the line by less than this many steps is on it. In a reduced basis the second vector is
/// √3/2 off at least.
const OFF_LINE: f64 = 0.5;
/// Indices beyond this are invalid.
const MAX_INDEX: f64 = (1 << 30) as f64;
/// A longer step than this many bins does not lead to the next trace.
const MAX_STEP: i64 = 1000;
/// Radius in bins of the first region.
const FIRST_REGION: f64 = 8.0;
/// Share of the traces whose step to the next one must be the same for the file to be in order.
const MIN_IN_ORDER: f64 = 0.4;

/// Indices of every trace on the lattice of X and Y, from 1; [`NO_INTEGER`] without X and Y.
#[derive(Debug)]
pub(super) struct TraceBins {
    /// Bytes of X and Y.
    pub bytes: [u16; 2],
    /// Which inline, if traces follow one another along inlines.
    pub along_inline: HeaderColumn,
    /// Which crossline.
    pub along_crossline: HeaderColumn,
    /// Whether the order of the traces tells the axes.
    pub is_in_order: bool,
    /// How well X and Y fit, as a clause: `holds 1200 of 1200 traces within …`.
    pub fit: String,
}

/// Finds the lattice. The error is the reason why there is none, or empty if there are no X and Y.
pub(super) fn find(columns: &Columns, options: &SegyOptions, min_fill: f64) -> Result<TraceBins, String> {
    let Some(coordinates) = varying(columns, options) else { return Err(String::new()) };
    let points = TracePoints::of(&coordinates, columns.count());
    let steps = points.steps()?;
    let affine = points.grow(steps);
    let (mut indices, near, mean_sq) = points.indices(&affine);
    let total = indices.len();
    if (near as f64) < MIN_NEAR * total as f64 {
        return Err(format!(
            "only {:.0} % of the traces lie within a quarter of a bin of the nearest one (bins of {:.2} by {:.2})",
            100.0 * near as f64 / total as f64,
            affine.linear.x_axis.length(),
            affine.linear.y_axis.length()
        ));
    }
    let axes = Axes::of(&indices, &affine);
    indices.iter_mut().for_each(|index| *index = axes.turn(*index));
    let lines = LineIndices::of(&indices, &points.traces, columns.count());
    let [inlines, crosslines] = lines.counts;
    let filled = lines.filled(&indices);
    let places = inlines.saturating_mul(crosslines);
    if inlines.min(crosslines) < 2 {
        return Err("the traces lie on one line".to_owned());
    }
    if (filled as f64) < min_fill * places as f64 || filled <= inlines.max(crosslines) {
        return Err(format!(
            "its {inlines} by {crosslines} places would hold {filled} traces: a line that bends, or places at random"
        ));
    }
    let [along_inline, along_crossline] = lines.columns;
    Ok(TraceBins {
        bytes: coordinates.bytes,
        along_inline,
        along_crossline,
        is_in_order: axes.is_in_order,
        fit: format!(
            "holds {near} of {total} traces within a quarter of a bin ({:.4} bin root mean square)",
            mean_sq.sqrt()
        ),
    })
}

/// X and Y of the traces that have them, from their mean.
struct TracePoints {
    at: Vec<DVec2>,
    traces: Vec<usize>,
}

impl TracePoints {
    fn of(coordinates: &Coordinates<'_>, count: usize) -> Self {
        let (mut at, mut traces) = (Vec::new(), Vec::new());
        for trace in 0..count {
            if let Some(world) = coordinates.of(trace) {
                at.push(world);
                traces.push(trace);
            }
        }
        let mean = at.iter().fold(DVec2::ZERO, |sum, &p| sum + p / at.len() as f64);
        at.iter_mut().for_each(|p| *p -= mean);
        Self { at, traces }
    }

    /// The two shortest steps that are not on one line.
    fn steps(&self) -> Result<DMat2, String> {
        let neighbours = PointGrid::of(&self.at);
        let queries = || (0..self.at.len()).step_by(self.at.len().div_ceil(MAX_QUERIES).max(1));
        let nearest: Vec<DVec2> = queries().filter_map(|q| neighbours.nearest(q, |_| true)).collect();
        let lengths = || nearest.iter().map(|d| d.length()).collect::<Vec<_>>();
        let Some(a) = typical(&nearest, lengths()) else {
            return Err("all traces have the same X and Y".to_owned());
        };
        let length = a.length();
        let off = |d: DVec2| (a.perp_dot(d) / length).abs();
        let beside: Vec<DVec2> = queries()
            .filter_map(|q| neighbours.nearest(q, |d| off(d) > OFF_LINE * length))
            .map(|d| d - a * (d.dot(a) / a.length_squared()).round())
            .map(|d| if a.perp_dot(d) < 0.0 { -d } else { d })
            // A step of half a bin to either side is one step.
            .map(|d| if d.dot(a) < -0.5 * SAME_STEP * length * length { d + a } else { d })
            .collect();
        let Some(b) = typical(&beside, beside.iter().map(|&d| off(d)).collect()) else {
            return Err("the traces lie on one line".to_owned());
        };
        Ok(DMat2::from_cols(a, b))
    }

    /// The affine map from indices to X and Y, fitted in regions that double.
    fn grow(&self, steps: DMat2) -> Affine {
        let seed = self.at.iter().copied().min_by(|p, q| p.length_squared().total_cmp(&q.length_squared()));
        let mut affine = Affine::new(seed.unwrap_or_default(), steps);
        let far = self.at.iter().map(|&p| affine.index_of(p).abs().max_element()).fold(0.0, f64::max);
        let mut region = FIRST_REGION;
        while region < 2.0 * MAX_INDEX {
            let placed: Vec<(DVec2, DVec2)> = self
                .at
                .iter()
                .map(|&p| (affine.index_of(p), p))
                .filter(|(index, _)| index.abs().max_element() <= region)
                .filter(|(index, _)| (*index - index.round()).abs().max_element() <= NEAR_BINS)
                .map(|(index, p)| (index.round(), p))
                .collect();
            if let Some(better) = Affine::fit(&placed) {
                affine = better;
            }
            if region > far {
                break;
            }
            region *= 2.0;
        }
        affine
    }

    /// The index of every point, the count of points near their lattice position, and the mean square
    /// distance in bins.
    fn indices(&self, affine: &Affine) -> (Vec<I64Vec2>, usize, f64) {
        let (mut near, mut sum_sq) = (0, 0.0);
        let indices = self
            .at
            .iter()
            .map(|&p| {
                let found = affine.index_of(p);
                let index = found.clamp(DVec2::splat(-MAX_INDEX), DVec2::splat(MAX_INDEX));
                let off = (found - index.round()).abs().max_element().min(1.0);
                near += usize::from(off <= NEAR_BINS);
                sum_sq += off * off;
                index.round().as_i64vec2()
            })
            .collect();
        (indices, near, sum_sq / self.at.len().max(1) as f64)
    }
}

/// The mean of the differences that are, up to their sign, the one of median length.
fn typical(differences: &[DVec2], mut lengths: Vec<f64>) -> Option<DVec2> {
    if differences.is_empty() {
        return None;
    }
    let measured = lengths.clone();
    let middle = lengths.len() / 2;
    let median = *lengths.select_nth_unstable_by(middle, f64::total_cmp).1;
    let index = measured.iter().position(|&length| length == median)?;
    let pivot = differences[index];
    let limit = SAME_STEP * pivot.length();
    let (mut sum, mut count) = (DVec2::ZERO, 0.0);
    for &d in differences {
        let d = if d.dot(pivot) < 0.0 { -d } else { d };
        if (d - pivot).length() <= limit {
            sum += d;
            count += 1.0;
        }
    }
    Some(sum / count)
}

/// Which steps of the found basis lead along and across inlines.
struct Axes {
    /// Inverse of the integer matrix with the columns across, along.
    rows: [I64Vec2; 2],
    is_in_order: bool,
}

impl Axes {
    fn of(indices: &[I64Vec2], affine: &Affine) -> Self {
        let is_step = |d: &I64Vec2| *d != I64Vec2::ZERO && d.abs().max_element() <= MAX_STEP;
        let steps = || indices.windows(2).map(|w| w[1] - w[0]).filter(is_step);
        let canonical = |d: I64Vec2| if (d.x, d.y) < (0, 0) { -d } else { d };
        let mut counts: HashMap<(i64, i64), usize> = HashMap::new();
        for d in steps().map(canonical) {
            *counts.entry((d.x, d.y)).or_default() += 1;
        }
        // The smaller step of two that are as frequent, so that the result does not depend on hashing.
        let common = counts.iter().max_by_key(|((x, y), count)| (**count, -(x.abs() + y.abs()), *x, *y));
        let total: usize = counts.values().sum();
        let in_order = common.filter(|(_, count)| **count as f64 >= MIN_IN_ORDER * total as f64);
        let (mut along, is_in_order) = match in_order {
            Some((&(x, y), _)) => (I64Vec2::new(x, y) / gcd(x, y).max(1), true),
            None => (I64Vec2::new(0, 1), false),
        };
        let mut across = complement(along, affine.linear);
        // Both count the way the file does.
        let votes = |axis: usize, along: I64Vec2, across: I64Vec2| {
            let rows = inverse(across, along);
            steps().map(|d| (rows[axis].x * d.x + rows[axis].y * d.y).signum()).sum::<i64>()
        };
        if is_in_order {
            if votes(1, along, across) < 0 {
                along = -along;
            }
            if votes(0, along, across) < 0 {
                across = -across;
            }
        }
        Self { rows: inverse(across, along), is_in_order }
    }

    /// Indices across and along inlines.
    fn turn(&self, index: I64Vec2) -> I64Vec2 {
        let [across, along] = self.rows;
        I64Vec2::new(across.x * index.x + across.y * index.y, along.x * index.x + along.y * index.y)
    }
}

/// `(x, y)` with a·x + b·y = gcd(a, b).
fn bezout(a: i64, b: i64) -> (i64, i64) {
    if b == 0 {
        return (a.signum(), 0);
    }
    let (x, y) = bezout(b, a % b);
    (y, x - a / b * y)
}

/// The shortest step that makes a basis of the lattice with `along`, whose indices have no common divisor.
fn complement(along: I64Vec2, linear: DMat2) -> I64Vec2 {
    // det(across, along) = across.x · along.y − across.y · along.x = 1
    let (x, y) = bezout(along.y, along.x);
    let across = I64Vec2::new(x, -y);
    let (f, w) = (linear * along.as_dvec2(), linear * across.as_dvec2());
    across - along * (w.dot(f) / f.length_squared()).round().clamp(-1e6, 1e6) as i64
}

/// Rows of the inverse of the matrix with the columns `across`, `along`, whose determinant is 1 or −1.
fn inverse(across: I64Vec2, along: I64Vec2) -> [I64Vec2; 2] {
    let determinant = across.x * along.y - across.y * along.x;
    [I64Vec2::new(along.y, -along.x) * determinant, I64Vec2::new(-across.y, across.x) * determinant]
}

/// Line numbers from 1.
struct LineIndices {
    columns: [HeaderColumn; 2],
    counts: [usize; 2],
}

impl LineIndices {
    fn of(indices: &[I64Vec2], traces: &[usize], count: usize) -> Self {
        let low = indices.iter().copied().fold(I64Vec2::MAX, I64Vec2::min);
        let high = indices.iter().copied().fold(I64Vec2::MIN, I64Vec2::max);
        let numbers = |axis: usize| {
            let mut values = vec![NO_INTEGER; count];
            for (&index, &trace) in indices.iter().zip(traces) {
                values[trace] = i32::try_from(index[axis] - low[axis] + 1).unwrap_or(NO_INTEGER);
            }
            HeaderColumn::of(&values)
        };
        let extent = |axis: usize| usize::try_from(high[axis] - low[axis] + 1).unwrap_or(usize::MAX);
        Self { columns: [numbers(0), numbers(1)], counts: [extent(0), extent(1)] }
    }

    /// Lattice positions that hold a trace.
    fn filled(&self, indices: &[I64Vec2]) -> usize {
        let mut places: Vec<(i64, i64)> = indices.iter().map(|index| (index.x, index.y)).collect();
        places.sort_unstable();
        places.dedup();
        places.len()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_step_is_completed_to_a_basis_by_the_shortest_one() {
        let linear = DMat2::from_cols(DVec2::new(25.0, 0.0), DVec2::new(0.0, 12.5));
        for (along, expected) in
            [((0, 1), (1, 0)), ((1, 0), (0, 1)), ((1, 1), (0, 1)), ((2, 1), (1, 0)), ((3, 2), (1, 1))]
        {
            let along = I64Vec2::new(along.0, along.1);
            let across = complement(along, linear);
            assert_eq!((across.x * along.y - across.y * along.x).abs(), 1, "{along}");
            let shortest = I64Vec2::new(expected.0, expected.1).as_dvec2();
            assert!((linear * across.as_dvec2()).length() <= (linear * shortest).length() + 1e-9, "{along} {across}");
            let [a, b] = inverse(across, along);
            assert_eq!((a.dot(across), a.dot(along), b.dot(across), b.dot(along)), (1, 0, 0, 1));
        }
    }

    #[test]
    fn the_typical_difference_ignores_sign_and_strays() {
        let mut differences: Vec<DVec2> =
            (0..50).map(|k| DVec2::new(12.0 + f64::from(k % 2), 0.0) * if k % 3 == 0 { -1.0 } else { 1.0 }).collect();
        differences.extend([DVec2::new(0.1, 0.0), DVec2::new(400.0, 3.0)]);
        let lengths = differences.iter().map(|d| d.length()).collect();
        let found = typical(&differences, lengths).unwrap();
        assert!((found.x.abs() - 12.5).abs() < 0.05 && found.y == 0.0, "{found}");
    }
}
