//! The closest point of a sheet, exact on the bicubic surface.
//!
//! With u = p − (x, y, h(x, y)) and w = G u ([`crate::metric`]) the squared distance is F = u·w. Its
//! stationary points solve s_x·w = s_y·w = 0 with the tangents s_x = (1, 0, h_x) and s_y = (0, 1, h_y):
//!
//! ```text
//! ½ ∂F/∂a    = −s_a·w
//! ½ ∂²F/∂a∂b = s_aᵀ G s_b − h_ab w_z
//! ```
//!
//! Damped Newton's method solves them. Where the second derivative is not positive definite (beyond a centre
//! of curvature) the curvature of the surface is left out (Gauss–Newton, always positive definite). A step
//! that increases F is halved. The surface is C¹ and its second derivative jumps between cells; convergence
//! stays superlinear there.
//!
//! A [`Foot`] stores the closest point together with the jet of the surface there. Following a moving point
//! (along a column or a trace) then costs about one evaluation of the surface per move: the first Newton step
//! uses the stored jet, the second a fresh one, and a step shorter than [`CONVERGED`] is the last and uses
//! the second-order continuation of the jet.
//!
//! Newton's method finds a *local* minimum; [`crate::lattice`] finds the global one.

use crate::metric::Metric;
use crate::surface::{BicubicSheet, ColumnFrame, Jet};
use glam::{Vec2, Vec3};

/// A Newton step shorter than this (voxels) is the last: the error after it is of the order of its square. A
/// fifth of this value changes no figure of the accuracy tests and costs a quarter more evaluations.
const CONVERGED: f32 = 1e-2;
/// Most Newton steps. The limit is reached only on surfaces that are rough at the spacing of their nodes.
const MOST_STEPS: usize = 40;
/// Longest step, voxels. It keeps a bad start from jumping to another fold.
const LONGEST_STEP: f32 = 8.0;

/// The foot of a point on a sheet: the closest point of the sheet. Positions are relative to a
/// [`ColumnFrame`].
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub(crate) struct Foot {
    /// Voxel (x, y) of the foot, relative to the frame's column.
    pub at: Vec2,
    /// The jet of the surface at the foot.
    pub jet: Jet,
    /// Distance of the point from the foot, in units of the scaled metric.
    pub distance: f32,
}

impl Foot {
    /// A foot at `at`, from which [`Foot::follow`] can start.
    #[inline]
    pub(crate) fn start(surface: &BicubicSheet, frame: ColumnFrame, at: Vec2) -> Self {
        Self { at, jet: surface.jet(frame, at), distance: f32::INFINITY }
    }

    /// The upward unit normal of the sheet (−z is up) as a voxel vector, i.e. the metric gradient of the
    /// distance for points above the sheet. Unlike (p − c)/d it needs no division by a distance near 0.
    #[inline]
    pub(crate) fn upward_normal(&self, metric: &Metric) -> Vec3 {
        let covector = Vec3::new(self.jet.gradient.x, self.jet.gradient.y, -1.0);
        let raised = metric.raise(covector);
        raised * (1.0 / covector.dot(raised).sqrt())
    }

    /// The foot as a position relative to the frame.
    #[inline]
    pub(crate) fn position(&self) -> Vec3 {
        self.at.extend(self.jet.h)
    }

    /// Moves the foot from where it is to the local closest point of `p` (relative to the frame).
    #[inline]
    pub(crate) fn follow(&mut self, surface: &BicubicSheet, metric: &Metric, frame: ColumnFrame, p: Vec3) {
        let (mut at, mut jet) = (self.at, self.jet);
        let (mut last_at, mut last_f) = (at, f32::INFINITY);
        for step_index in 0..MOST_STEPS {
            let u = p - at.extend(jet.h);
            let w = metric.lower(u);
            let f = u.dot(w);
            if f > last_f * (1.0 + 1e-5) + 1e-10 {
                // The last step increased F: halve it. When no step descends, the foot stays where it was.
                let half = 0.5 * (at - last_at);
                at = last_at + half;
                if half.length_squared() < 1e-9 {
                    at = last_at;
                    jet = surface.jet(frame, at);
                    break;
                }
                jet = surface.jet(frame, at);
                continue;
            }
            let step = newton_step(&jet, w, metric);
            if step_index > 0 && step.length_squared() < CONVERGED * CONVERGED {
                jet = jet.moved(step);
                at += step;
                break;
            }
            (last_at, last_f) = (at, f);
            at += step;
            jet = surface.jet(frame, at);
        }
        let distance = metric.length_squared(p - at.extend(jet.h)).max(0.0).sqrt();
        *self = Self { at, jet, distance };
    }
}

/// The damped Newton step for the residual covector w at a jet.
#[inline]
fn newton_step(jet: &Jet, w: Vec3, metric: &Metric) -> Vec2 {
    let (hx, hy) = (jet.gradient.x, jet.gradient.y);
    let (gx, gy) = (w.x + hx * w.z, w.y + hy * w.z);
    let (axx, axy, ayy) = metric.tangents(hx, hy);
    let [hxx, hxy, hyy] = jet.hessian;
    let (mut xx, mut xy, mut yy) = (axx - hxx * w.z, axy - hxy * w.z, ayy - hyy * w.z);
    let mut determinant = xx * yy - xy * xy;
    if !(determinant > 1e-2 * (axx * ayy - axy * axy) && xx + yy > 0.0) {
        (xx, xy, yy) = (axx, axy, ayy);
        determinant = xx * yy - xy * xy;
    }
    let step = Vec2::new(yy * gx - xy * gy, xx * gy - xy * gx) * (1.0 / determinant);
    let length_sq = step.length_squared();
    if length_sq > LONGEST_STEP * LONGEST_STEP { step * (LONGEST_STEP / length_sq.sqrt()) } else { step }
}
