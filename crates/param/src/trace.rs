//! Following an isocurve to the middle of its layer (P-illus 3.1).
//!
//! dp/dk = ∇k/|∇k|² is integrated from (p₀, k₀) to k = 0.5 by the third-order Runge–Kutta pair of P. Bogacki
//! and L. F. Shampine ("A 3(2) pair of Runge–Kutta formulas", Applied Mathematics Letters 2, 1989) with its
//! embedded error estimate. A gently curved layer takes one or two steps. The last evaluation of a step is
//! the first of the next and gives the true k there, so a deviation from the parameter of the curve is
//! corrected by the remaining steps.
//!
//! # Creases
//! Where the closest point of a sheet jumps (on its medial axis) ∇k jumps too. Within a step both feet are
//! followed continuously. After each step the lattice of closest points says whether another branch is
//! nearer. If so the trace continues from there with short steps: it crosses the crease, or slides along it
//! where both sides lead towards it. Such a trace is flagged. A trace that has not arrived after
//! [`MOST_STEPS`] steps ends where it is.

use crate::lattice::FootLattice;
use crate::layer::{Feet, Layer, RatioSample};
use crate::surface::ColumnFrame;
use glam::Vec3;

/// Most steps of a trace.
const MOST_STEPS: usize = 48;
/// Longest step, voxels.
const LONGEST_STEP: f32 = 24.0;
/// Longest step after the trace has met a crease, voxels. It doubles with every step that meets none.
const CREASE_STEP: f32 = 1.5;

/// Where a trace ended.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct TraceEnd {
    /// Where the trace crosses k = 0.5, relative to the frame.
    pub at: Vec3,
    /// Whether a closest point jumped on the way, or the trace did not arrive.
    pub crease: bool,
}

/// What the traces of one region share.
pub(crate) struct Tracer<'a> {
    /// The sheets.
    pub layer: &'a Layer,
    /// Global closest points, bottom and top.
    pub lattices: [&'a FootLattice; 2],
    /// Count of levels of the region's grid less one: k times this is about the level of a point.
    pub top_level: f32,
    /// Largest error estimate of a step, voxels.
    pub tolerance: f32,
}

impl Tracer<'_> {
    /// Tries the feet of both lattices for `p`; returns whether a foot moved to another branch.
    #[inline]
    pub(crate) fn try_lattice(&self, frame: ColumnFrame, p: Vec3, level: f32, feet: &mut Feet) -> bool {
        let Layer { bottom, top, metric, .. } = self.layer;
        let below = self.lattices[0].try_lattice(&mut feet.bottom, bottom, metric, frame, p, level);
        let above = self.lattices[1].try_lattice(&mut feet.top, top, metric, frame, p, level);
        below | above
    }

    /// Traces from `start`, where the field is `sample` and the feet are `feet`. Positions are relative to
    /// `frame`.
    pub(crate) fn trace(&self, frame: ColumnFrame, start: Vec3, sample: RatioSample, feet: &Feet) -> TraceEnd {
        let (mut p, mut sample, mut feet) = (start, sample, *feet);
        let mut crease = false;
        let mut longest = LONGEST_STEP;
        let mut trial = f32::INFINITY;
        for _ in 0..MOST_STEPS {
            let rest = 0.5 - sample.k;
            let speed = sample.velocity.length();
            if !(speed > 0.0 && speed.is_finite()) {
                return TraceEnd { at: p, crease: true };
            }
            if rest.abs() * speed < 4.0 * self.tolerance {
                return TraceEnd { at: p + sample.velocity * rest, crease };
            }
            let h = rest.abs().min(trial).min(longest / speed).copysign(rest);
            let before = feet;
            let v1 = sample.velocity;
            let v2 = self.layer.follow(frame, p + v1 * (0.5 * h), &mut feet).velocity;
            let v3 = self.layer.follow(frame, p + v2 * (0.75 * h), &mut feet).velocity;
            let next = p + (v1 * (2.0 / 9.0) + v2 * (1.0 / 3.0) + v3 * (4.0 / 9.0)) * h;
            let arrived = self.layer.follow(frame, next, &mut feet);
            let error = (v1 * (-5.0 / 72.0) + v2 * (1.0 / 12.0) + v3 * (1.0 / 9.0) - arrived.velocity * 0.125) * h;
            let error = error.truncate().length();
            let grow = 0.9 * (self.tolerance / error.max(1e-9)).cbrt();
            if error > self.tolerance && h.abs() * speed > 0.25 {
                trial = h.abs() * grow.clamp(0.2, 0.9);
                feet = before;
                continue;
            }
            trial = h.abs() * grow.clamp(0.5, 5.0);
            (p, sample) = (next, arrived);
            if self.try_lattice(frame, p, sample.k * self.top_level, &mut feet) {
                sample = self.layer.ratio(&feet);
                (crease, longest, trial) = (true, CREASE_STEP, f32::INFINITY);
            } else {
                longest = (2.0 * longest).min(LONGEST_STEP);
            }
        }
        TraceEnd { at: p, crease: true }
    }
}
