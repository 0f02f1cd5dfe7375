//! Following an isocurve to the middle of its layer (P-illus 3.1).
//!
//! dp/dk = ∇k/|∇k|² from (p₀, k₀) to k = 0.5, by the third-order Runge–Kutta pair of Bogacki and Shampine (A 3(2) pair of
//! Runge–Kutta formulas, 1989) with its embedded error; a gently curved layer takes one or two steps. The last evaluation
//! of a step is the first of the next and tells the true k there, so a drift off the curve's parameter is taken up by
//! what is left to go.
//!
//! # Creases
//! Where the closest point of a sheet jumps (its medial axis) ∇k jumps too. Within a step both feet are followed
//! continuously; after each step the lattice tells whether another branch is nearer. If so the curve goes on from there
//! with short steps: it crosses the crease, or slides along it when both sides push towards it. Such a trace is flagged; one
//! that has not arrived after [`MOST_STEPS`] steps ends where it is.

use crate::lattice::FootLattice;
use crate::layer::{Feet, Layer, RatioSample};
use crate::surface::Frame;
use glam::Vec3;

/// Steps after which a trace ends wherever it is.
const MOST_STEPS: usize = 48;
/// Longest step, voxels.
const LONGEST_STEP: f32 = 24.0;
/// Longest step after the trace met a crease, voxels; it doubles with every step that meets none.
const CREASE_STEP: f32 = 1.5;

/// Where a trace ended.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Crossing {
    /// The crossing of k = 0.5, relative to the frame.
    pub at: Vec3,
    /// Whether a closest point jumped on the way, or the trace could not arrive.
    pub crease: bool,
}

/// What traces of one region share.
pub struct Tracer<'a> {
    /// The sheets.
    pub layer: &'a Layer,
    /// Global closest points, bottom and top.
    pub lattices: [&'a FootLattice; 2],
    /// Levels of the region's grid less one: k times this is about the level a point is at.
    pub top_level: f32,
    /// Error allowed per step, voxels.
    pub tolerance: f32,
}

impl Tracer<'_> {
    /// Lets the lattices challenge both feet at `p`; whether one changed its branch.
    #[inline]
    pub fn challenge(&self, frame: Frame, p: Vec3, level: f32, feet: &mut Feet) -> bool {
        let Layer { bottom, top, metric, .. } = self.layer;
        let below = self.lattices[0].challenge(&mut feet.bottom, bottom, metric, frame, p, level);
        let above = self.lattices[1].challenge(&mut feet.top, top, metric, frame, p, level);
        below | above
    }

    /// Traces from `start`, where the field is `sample` and the feet are `feet`.
    pub fn trace(&self, frame: Frame, start: Vec3, sample: RatioSample, feet: &Feet) -> Crossing {
        let (mut p, mut sample, mut feet) = (start, sample, *feet);
        let mut crease = false;
        let mut longest = LONGEST_STEP;
        let mut trial = f32::INFINITY;
        for _ in 0..MOST_STEPS {
            let rest = 0.5 - sample.k;
            let speed = sample.velocity.length();
            if !(speed > 0.0 && speed.is_finite()) {
                return Crossing { at: p, crease: true };
            }
            if rest.abs() * speed < 4.0 * self.tolerance {
                return Crossing { at: p + sample.velocity * rest, crease };
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
            if self.challenge(frame, p, sample.k * self.top_level, &mut feet) {
                sample = self.layer.ratio(&feet);
                (crease, longest, trial) = (true, CREASE_STEP, f32::INFINITY);
            } else {
                longest = (2.0 * longest).min(LONGEST_STEP);
            }
        }
        Crossing { at: p, crease: true }
    }
}
