//! The position of the lattice in the world: `[X Y]ᵀ = origin + i·a + j·b`, least squares over the traces' X
//! and Y.
//!
//! With a bar for the mean, the deviations satisfy `S [a b] = [Σ(i-ī)(X-X̄) …]`, S the 2 × 2 matrix of second
//! moments of i and j. Coordinates are stored as integers, so the fit is also more precise than any single
//! coordinate. While some traces lie more than half a bin and three medians off, the fit is repeated without
//! them.

use glam::{DMat2, DVec2};
use rayon::prelude::*;

use super::lines::{LineLattice, NO_TRACE};

/// Half a bin: beyond it a trace would be nearer to another lattice position.
pub(super) const MAX_RESIDUAL_BINS: f64 = 0.5;

/// The fit takes every n-th trace of files that have more than this: 1 ‰ of a bin needs far fewer.
const MAX_POINTS: usize = 1 << 16;

/// Places that are looked at one after the other.
const RUN: usize = 1 << 13;

/// A fitted place, in the unit of the coordinates.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct FittedPlace {
    pub origin: DVec2,
    pub inline_vector: DVec2,
    pub crossline_vector: DVec2,
    /// Root mean square distance of the traces that were used from their place, in bins.
    pub rms_bins: f64,
    /// Largest distance among all traces, in bins, and the trace.
    pub max_bins: f64,
    pub worst_trace: usize,
    /// Traces with coordinates.
    pub traces: usize,
    /// Traces that lie off by more than half a bin and were left out of the fit.
    pub outliers: usize,
    /// Traces whose X and Y are both 0.
    pub without: usize,
}

impl FittedPlace {
    /// Fits X and Y, as `world_of` gives them for a trace; none if those traces, or their coordinates, lie on
    /// a line.
    pub(super) fn fit(lattice: &LineLattice, world_of: impl Fn(usize) -> Option<DVec2> + Sync) -> Option<Self> {
        // In runs of places whose results are put together in order: the same on any number of threads.
        let runs = || {
            lattice.trace_of.par_chunks(RUN).enumerate().map(|(run, traces)| {
                let first = run * RUN;
                let filled = traces.iter().enumerate().filter(|(_, trace)| **trace != NO_TRACE);
                filled.map(move |(n, &trace)| (lattice.index_at(first + n), trace as usize))
            })
        };
        let located: Vec<usize> =
            runs().map(|run| run.filter(|(_, trace)| world_of(*trace).is_some()).count()).collect();
        let total: usize = located.iter().sum();
        let step = total.div_ceil(MAX_POINTS).max(1);
        let before: Vec<usize> =
            located.iter().scan(0, |sum, count| Some(std::mem::replace(sum, *sum + count))).collect();
        let sample: Vec<Vec<(DVec2, DVec2)>> = runs()
            .zip(&before)
            .map(|(run, &before)| {
                let points = run.filter_map(|(at, trace)| Some((at, world_of(trace)?)));
                points.skip((step - before % step) % step).step_by(step).collect()
            })
            .collect();
        let affine = robust_fit(&sample.concat())?;
        let residuals: Vec<Residuals> = runs()
            .map(|run| {
                let points = run.filter_map(|(at, trace)| Some((at, world_of(trace)?, trace)));
                let residuals = points.map(|(at, world, trace)| (affine.residual_bins(at, world), trace));
                residuals.fold(Residuals::default(), Residuals::with)
            })
            .collect();
        let all = residuals.into_iter().fold(Residuals::default(), Residuals::and);
        Some(Self {
            origin: affine.origin,
            inline_vector: affine.linear.x_axis,
            crossline_vector: affine.linear.y_axis,
            rms_bins: (all.sum_sq / all.used.max(1) as f64).sqrt(),
            max_bins: all.max,
            worst_trace: all.worst_trace,
            traces: total,
            outliers: total - all.used,
            without: lattice.filled() - total,
        })
    }

    /// Whether few traces lie off by more than half a bin.
    pub(super) fn agrees(&self) -> bool {
        self.outliers * 10 <= self.traces
    }

    /// |cos| of the angle between inlines and crosslines: 0 if orthogonal.
    pub(super) fn skew(&self) -> f64 {
        self.inline_vector.dot(self.crossline_vector).abs()
            / (self.inline_vector.length() * self.crossline_vector.length())
    }
}

/// Distances of traces from their places, in bins.
#[derive(Debug, Clone, Copy, Default)]
struct Residuals {
    /// Of those that are used.
    sum_sq: f64,
    used: usize,
    max: f64,
    worst_trace: usize,
}

impl Residuals {
    fn with(mut self, (bins, trace): (f64, usize)) -> Self {
        if bins > self.max {
            (self.max, self.worst_trace) = (bins, trace);
        }
        if bins <= MAX_RESIDUAL_BINS {
            self.sum_sq += bins * bins;
            self.used += 1;
        }
        self
    }

    fn and(self, later: Self) -> Self {
        let worst = if later.max > self.max { later } else { self };
        Self { sum_sq: self.sum_sq + later.sum_sq, used: self.used + later.used, ..worst }
    }
}

/// Least squares, repeated without the points that lie far off, until none is left out anew.
fn robust_fit(points: &[(DVec2, DVec2)]) -> Option<Affine> {
    /// Rounds; gross errors are gone after one or two.
    const ROUNDS: usize = 6;
    /// Points beyond this many times the median residual are left out.
    const MEDIANS: f64 = 3.0;
    let mut kept: Vec<(DVec2, DVec2)> = points.to_vec();
    let mut affine = Affine::fit(&kept)?;
    for _ in 0..ROUNDS {
        let mut residuals: Vec<f64> = points.iter().map(|&(at, world)| affine.residual_bins(at, world)).collect();
        if residuals.iter().all(|&r| r <= MAX_RESIDUAL_BINS) {
            break;
        }
        let middle = residuals.len() / 2;
        let median = *residuals.select_nth_unstable_by(middle, f64::total_cmp).1;
        let limit = MAX_RESIDUAL_BINS.max(MEDIANS * median);
        let near: Vec<_> =
            points.iter().copied().filter(|&(at, world)| affine.residual_bins(at, world) <= limit).collect();
        if near.len() == kept.len() {
            break;
        }
        let Some(better) = Affine::fit(&near) else { break };
        (kept, affine) = (near, better);
    }
    Some(affine)
}

/// World from index.
#[derive(Debug, Clone, Copy)]
pub(super) struct Affine {
    origin: DVec2,
    pub linear: DMat2,
    inverse: DMat2,
}

impl Affine {
    /// From the place of index 0, 0 and the two steps, which must span an area.
    pub(super) fn new(origin: DVec2, linear: DMat2) -> Self {
        Self { origin, linear, inverse: linear.inverse() }
    }

    /// The fractional index of a place.
    pub(super) fn index_of(&self, world: DVec2) -> DVec2 {
        self.inverse * (world - self.origin)
    }

    /// Least squares over (index, world).
    pub(super) fn fit(points: &[(DVec2, DVec2)]) -> Option<Self> {
        let mut count = 0.0;
        let (mut mean_at, mut mean_world) = (DVec2::ZERO, DVec2::ZERO);
        for &(at, world) in points {
            count += 1.0;
            mean_at += (at - mean_at) / count;
            mean_world += (world - mean_world) / count;
        }
        let (mut moment, mut mixed) = (DMat2::ZERO, DMat2::ZERO);
        for &(at, world) in points {
            let (at, world) = (at - mean_at, world - mean_world);
            moment += DMat2::from_cols(at * at.x, at * at.y);
            mixed += DMat2::from_cols(world * at.x, world * at.y);
        }
        let scale = moment.x_axis.x * moment.y_axis.y;
        if count < 3.0 || moment.determinant() <= 1e-9 * scale || scale <= 0.0 {
            return None;
        }
        let linear = mixed * moment.inverse();
        let sides = linear.x_axis.length() * linear.y_axis.length();
        let is_proper = linear.determinant().abs() > 1e-6 * sides;
        is_proper.then(|| Self::new(mean_world - linear * mean_at, linear))
    }

    /// Distance from the lattice place along its farther axis, in bins.
    fn residual_bins(&self, at: DVec2, world: DVec2) -> f64 {
        (self.index_of(world) - at).abs().max_element()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_exact_affine_map_is_found() {
        let map = |at: DVec2| {
            DVec2::new(605_000.0, 6_073_000.0) + DVec2::new(12.0, 5.0) * at.x + DVec2::new(-4.0, 24.0) * at.y
        };
        let points: Vec<_> =
            (0..20).map(|k| DVec2::new(f64::from(k % 5), f64::from(k / 5))).map(|at| (at, map(at))).collect();
        let affine = Affine::fit(&points).unwrap();
        assert!((affine.origin - map(DVec2::ZERO)).length() < 1e-6);
        assert!((affine.linear.x_axis - DVec2::new(12.0, 5.0)).length() < 1e-9);
        assert!((affine.linear.y_axis - DVec2::new(-4.0, 24.0)).length() < 1e-9);
        assert!((affine.residual_bins(DVec2::ONE, map(DVec2::new(1.0, 1.75))) - 0.75).abs() < 1e-6);
    }

    #[test]
    fn a_line_of_points_has_no_fit() {
        let points: Vec<_> = (0..9).map(|k| (DVec2::splat(f64::from(k)), DVec2::new(f64::from(k), 0.0))).collect();
        assert!(Affine::fit(&points).is_none());
    }
}
