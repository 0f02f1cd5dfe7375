//! The minimum: conjugate gradients with Jacobi preconditioning, matrix-free.
//!
//! The unknown is s = τ − z at every voxel. The time of a hub is the weighted mean of τ at its vertices, which is put
//! into the sum, so that hubs are no unknowns: they spread every correction over their whole extent at once, as a coarse
//! grid would. One application of the matrix visits each link once. Links along inlines are visited pair by pair of
//! lines, first those from even lines, then those from odd ones, so that no two threads write to one line and sums have
//! one order on any number of threads.
//!
//! Memory: 20 bytes a voxel (s, residual, direction, its image, diagonal) beside the links.

use crate::hubs::Hubs;
use crate::links::{CUT_BELOW, DIP_STEP, Links, WEIGHT_STEP};
use crate::stencil::{Stencils, is_steep};
use crate::vectors::{advance, dot, turn};
use rayon::prelude::*;
use survey::{Cancelled, Progress};
use system::huge_pages;

/// Two points that have the same time: one on either side of a fault.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Tie {
    /// Traces (x·crosslines + y).
    pub trace: [u32; 2],
    /// Fractional samples.
    pub z: [f32; 2],
    /// Weight.
    pub weight: f32,
}

/// A point whose time is given.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct TimedPoint {
    /// Trace (x·crosslines + y).
    pub trace: u32,
    /// Fractional sample.
    pub z: f32,
    /// Its time.
    pub time: f32,
    /// Weight.
    pub weight: f32,
}

/// What a minimisation works in, kept for the next one. Fresh memory costs more than a step.
#[derive(Debug, Default)]
pub(crate) struct Room {
    /// Of every voxel.
    image: Vec<f32>,
    residual: Vec<f32>,
    direction: Vec<f32>,
    inverse: Vec<f32>,
    /// Of every vertex of the hubs.
    value: Vec<f32>,
}

impl Room {
    /// Makes room for so many voxels and vertices, where it is not there already.
    fn fit(&mut self, voxels: usize, vertices: usize) {
        for all in [&mut self.image, &mut self.residual, &mut self.direction, &mut self.inverse] {
            if all.len() != voxels {
                *all = huge_pages::zeroed(voxels);
            }
        }
        self.value.resize(vertices, 0.0);
    }
}

/// What is minimised.
pub(crate) struct System<'a> {
    /// Patches of one time.
    pub hubs: &'a Hubs,
    /// Dips between traces.
    pub links: &'a Links,
    /// Points of one time on both sides of faults.
    pub ties: &'a [Tie],
    /// Points of a given time.
    pub anchors: &'a [TimedPoint],
    /// e₁ and e₂: the weights of the first and the second difference along a trace, squared.
    pub smoothness: [f32; 2],
}

/// Lower node and share of the upper one for a fractional sample.
#[inline]
fn node(z: f32, nz: usize) -> (usize, f32) {
    let z = z.clamp(0.0, (nz - 1) as f32);
    let low = (z as usize).min(nz.saturating_sub(2));
    (low, z - low as f32)
}

/// The value of a trace at a fractional sample.
#[inline]
pub(crate) fn interpolate(trace: &[f32], z: f32) -> f32 {
    let (low, share) = node(z, trace.len());
    trace[low] + share * (trace[(low + 1).min(trace.len() - 1)] - trace[low])
}

/// Adds `value` at a fractional sample of a trace: the transpose of [`interpolate`].
#[inline]
fn spread(trace: &mut [f32], z: f32, value: f32) {
    let (low, share) = node(z, trace.len());
    trace[low] += (1.0 - share) * value;
    let high = (low + 1).min(trace.len() - 1);
    trace[high] += share * value;
}

/// One end of a link: the node above it, and its share of the node below.
#[derive(Clone, Copy)]
struct End {
    low: usize,
    share: f32,
}

impl End {
    /// The end at `fixed` halves of a [`DIP_STEP`], which lies in the trace.
    #[inline]
    fn new(fixed: u32, nz: usize) -> Self {
        let low = (fixed / HALF_STEPS).min(nz as u32 - 2);
        Self {
            low: low as usize,
            share: fixed.wrapping_sub(low << HALF_STEPS.ilog2()) as i32 as f32 * (0.5 * DIP_STEP),
        }
    }

    #[inline]
    fn of(self, trace: &[f32]) -> f32 {
        let pair = &trace[self.low..self.low + 2];
        pair[0] + self.share * (pair[1] - pair[0])
    }

    #[inline]
    fn spread(self, trace: &mut [f32], value: f32) {
        trace[self.low] += (1.0 - self.share) * value;
        trace[self.low + 1] += self.share * value;
    }

    #[inline]
    fn spread_square(self, trace: &mut [f32], weight: f32) {
        trace[self.low] += weight * (1.0 - self.share) * (1.0 - self.share);
        trace[self.low + 1] += weight * self.share * self.share;
    }
}

/// Halves of a [`DIP_STEP`] in a sample.
const HALF_STEPS: u32 = 512;

/// Visits the links of one pair of traces whose dip is `wanted`: `visit(end on a, end on b, dip, weight)`. Links with a
/// weight have both ends inside the traces.
#[inline]
fn each_link(dips: &[i16], weights: &[u8], wanted: impl Fn(i16) -> bool, mut visit: impl FnMut(End, End, f32, f32)) {
    let nz = dips.len();
    for (z, (&dip, &weight)) in dips.iter().zip(weights).enumerate() {
        let weight = weight & !CUT_BELOW;
        if weight != 0 && wanted(dip) {
            // Ends lie in the trace, so nothing overflows; a dip upwards wraps around and back.
            let (at, half) = ((z as u32) << HALF_STEPS.ilog2(), i32::from(dip) as u32);
            let (a, b) = (End::new(at.wrapping_sub(half), nz), End::new(at.wrapping_add(half), nz));
            visit(a, b, f32::from(dip) * DIP_STEP, f32::from(weight) * WEIGHT_STEP);
        }
    }
}

impl System<'_> {
    fn size(&self) -> [usize; 3] {
        self.hubs.size
    }

    /// Calls `first(room, line, its part of out)` for all inlines, then `pair(room, traces, dips, weights, trace a, trace b)` for
    /// all pairs of neighbouring traces: those of an inline right after it, while it is in the cache.
    fn each_line(
        &self,
        out: &mut [f32],
        first: impl Fn(&mut Stencils, usize, &mut [f32]) + Sync,
        pair: impl Fn(&mut Stencils, [usize; 2], &[i16], &[u8], &mut [f32], &mut [f32]) + Sync,
    ) {
        let [nx, ny, nz] = self.size();
        let line = ny * nz;
        out.par_chunks_mut(line).enumerate().for_each(|(x, out)| {
            let mut stencils = Stencils::new(nz);
            first(&mut stencils, x, out);
            for y in 0..ny - 1 {
                let at = (x * ny + y) * nz;
                let (a, b) = out.split_at_mut((y + 1) * nz);
                let (dips, weights) = (&self.links.dip[1][at..at + nz], &self.links.weight[1][at..at + nz]);
                pair(&mut stencils, [x * ny + y, x * ny + y + 1], dips, weights, &mut a[y * nz..], &mut b[..nz]);
            }
        });
        for first in [0, 1] {
            if nx <= first + 1 {
                continue;
            }
            out[first * line..].par_chunks_exact_mut(2 * line).enumerate().for_each(|(n, out)| {
                let x = first + 2 * n;
                let (a, b) = out.split_at_mut(line);
                let mut stencils = Stencils::new(nz);
                for y in 0..ny {
                    let at = (x * ny + y) * nz;
                    let (dips, weights) = (&self.links.dip[0][at..at + nz], &self.links.weight[0][at..at + nz]);
                    let own = y * nz..(y + 1) * nz;
                    pair(
                        &mut stencils,
                        [x * ny + y, (x + 1) * ny + y],
                        dips,
                        weights,
                        &mut a[own.clone()],
                        &mut b[own],
                    );
                }
            });
        }
    }

    /// τ at every vertex of the hubs.
    pub(crate) fn at_vertices(&self, s: &[f32]) -> Vec<f32> {
        let mut value = vec![0.0f32; self.hubs.z.len()];
        self.interpolate_vertices(s, 1.0, &mut value);
        value
    }

    /// s + offset z at every vertex of the hubs.
    fn interpolate_vertices(&self, s: &[f32], offset: f32, value: &mut [f32]) {
        let [_, ny, nz] = self.size();
        self.hubs.split_inlines(value).into_par_iter().enumerate().for_each(|(x, value)| {
            let first = self.hubs.on_inline(x).start;
            for y in 0..ny {
                let trace = x * ny + y;
                for v in self.hubs.on_trace(trace) {
                    let z = self.hubs.z[v];
                    value[v - first] = interpolate(&s[trace * nz..(trace + 1) * nz], z) + offset * z;
                }
            }
        });
    }

    /// Half the gradient of what is minimised at `s`; with `offset` 0 that of its quadratic part: the matrix times s.
    /// `value` is room for a number at every vertex.
    fn gradient(&self, s: &[f32], offset: f32, value: &mut [f32], out: &mut [f32]) {
        let [_, ny, nz] = self.size();
        self.interpolate_vertices(s, offset, value);
        let times = self.hubs.means(value);
        let along = |stencils: &mut Stencils, x: usize, out: &mut [f32]| {
            for y in 0..ny {
                let trace = x * ny + y;
                let own = trace * nz..(trace + 1) * nz;
                let out = &mut out[y * nz..(y + 1) * nz];
                stencils.along(self.smoothness, &s[own.clone()], &self.links.weight[1][own], out);
                for v in self.hubs.on_trace(trace) {
                    let off = value[v] - times[self.hubs.hub[v] as usize];
                    spread(out, self.hubs.z[v], self.hubs.weight[v] * off);
                }
            }
        };
        self.each_line(out, along, |stencils, [ta, tb], dips, weights, out_a, out_b| {
            let (a, b) = (&s[ta * nz..(ta + 1) * nz], &s[tb * nz..(tb + 1) * nz]);
            if stencils.add(offset, (dips, weights), [a, b], [&mut *out_a, &mut *out_b]) {
                each_link(dips, weights, is_steep, |at_a, at_b, p, weight| {
                    let e = weight * (at_b.of(b) - at_a.of(a) + offset * p);
                    at_a.spread(out_a, -e);
                    at_b.spread(out_b, e);
                });
            }
        });
        for tie in self.ties {
            let [a, b] = tie.trace.map(|trace| trace as usize * nz);
            let at = |from: usize, z: f32| interpolate(&s[from..from + nz], z) + offset * z;
            let e = tie.weight * (at(b, tie.z[1]) - at(a, tie.z[0]));
            spread(&mut out[a..a + nz], tie.z[0], -e);
            spread(&mut out[b..b + nz], tie.z[1], e);
        }
        for anchor in self.anchors {
            let from = anchor.trace as usize * nz;
            let e = interpolate(&s[from..from + nz], anchor.z) + offset * (anchor.z - anchor.time);
            spread(&mut out[from..from + nz], anchor.z, anchor.weight * e);
        }
    }

    /// The inverse of the diagonal of the matrix, without what the means of hubs take off it.
    fn inverse_diagonal(&self, out: &mut [f32]) {
        let [_, ny, nz] = self.size();
        let [e1, e2] = self.smoothness;
        let square = |out: &mut [f32], z: f32, weight: f32| {
            let (low, share) = node(z, nz);
            out[low] += weight * (1.0 - share) * (1.0 - share);
            out[(low + 1).min(nz - 1)] += weight * share * share;
        };
        let along = |_: &mut Stencils, x: usize, out: &mut [f32]| {
            for y in 0..ny {
                let trace = x * ny + y;
                let out = &mut out[y * nz..(y + 1) * nz];
                // A little more than there is, so that a voxel without any term has a diagonal.
                out.fill(2.0 * e1 + 6.0 * e2 + 1e-6);
                for v in self.hubs.on_trace(trace) {
                    square(out, self.hubs.z[v], self.hubs.weight[v]);
                }
            }
        };
        self.each_line(out, along, |_, _, dips, weights, a, b| {
            each_link(
                dips,
                weights,
                |_| true,
                |at_a, at_b, _, weight| {
                    at_a.spread_square(a, weight);
                    at_b.spread_square(b, weight);
                },
            );
        });
        for tie in self.ties {
            for side in [0, 1] {
                let from = tie.trace[side] as usize * nz;
                square(&mut out[from..from + nz], tie.z[side], tie.weight);
            }
        }
        for anchor in self.anchors {
            let from = anchor.trace as usize * nz;
            square(&mut out[from..from + nz], anchor.z, anchor.weight);
        }
        out.par_iter_mut().for_each(|d| *d = 1.0 / *d);
    }

    /// Moves `s` towards the minimum, until the residual has fallen to `tolerance` of what it was at s = 0 or after
    /// `most` steps; returns the count of steps.
    ///
    /// # Errors
    /// [`Cancelled`].
    pub(crate) fn minimise(
        &self,
        s: &mut [f32],
        room: &mut Room,
        most: usize,
        tolerance: f64,
        progress: &Progress,
    ) -> Result<usize, Cancelled> {
        let line = self.size()[1] * self.size()[2];
        room.fit(s.len(), self.hubs.z.len());
        let Room { image, residual, direction, inverse, value } = room;
        self.inverse_diagonal(inverse);
        // What the residual is at s = 0 measures how far the start is.
        residual.fill(0.0);
        self.gradient(residual, 1.0, value, image);
        let at_rest = dot(image, image, Some(inverse), line).sqrt();
        self.gradient(s, 1.0, value, residual);
        residual.par_iter_mut().for_each(|r| *r = -*r);
        turn(0.0, direction, [residual, inverse], line);
        let mut size = dot(residual, residual, Some(inverse), line);
        let mut steps = 0;
        while steps < most && size.sqrt() > tolerance * at_rest && size > 0.0 {
            progress.step(1)?;
            self.gradient(direction, 0.0, value, image);
            let along = dot(direction, image, None, line);
            if along <= 0.0 {
                break;
            }
            let step = (size / along) as f32;
            let next = advance(step, [&mut *s, &mut *residual], [&*direction, &*image, &*inverse], line);
            let keep = (next / size) as f32;
            turn(keep, direction, [residual, inverse], line);
            size = next;
            steps += 1;
        }
        Ok(steps)
    }
}
