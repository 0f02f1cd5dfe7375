//! Links between extrema of neighbouring traces: each the other's best.
//!
//! The extremum at z on one trace expects its continuation on the next at z + dip. Of the extrema within reach
//! the one of least cost is its choice, `cost = (misfit/1 sample)² + (ln amplitude ratio)²`; a link is a pair of extrema that choose each other.
//! A relation, not a walk: nothing depends on order.

use crate::extrema::Extrema;
use rayon::prelude::*;

/// No extremum.
pub(super) const NONE: u32 = u32::MAX;

/// Links of the extrema of one kind, one entry an extremum. Memory: 16 bytes an extremum.
pub(super) struct Links {
    /// Partner at x + 1, x − 1, y + 1, y − 1, or [`NONE`].
    pub(super) to: [Vec<u32>; 4],
}

/// Indices into [`Links::to`].
pub(super) const NEXT_X: usize = 0;
pub(super) const BACK_X: usize = 1;
pub(super) const NEXT_Y: usize = 2;
pub(super) const BACK_Y: usize = 3;

impl Links {
    /// The corner of a closed cell opposite to `a`, if all four links are there and agree.
    pub(super) fn closed(&self, a: u32) -> Option<[u32; 4]> {
        let (b, c) = (self.to[NEXT_X][a as usize], self.to[NEXT_Y][a as usize]);
        if b == NONE || c == NONE {
            return None;
        }
        let (d, e) = (self.to[NEXT_Y][b as usize], self.to[NEXT_X][c as usize]);
        (d == e && d != NONE).then_some([a, b, c, d])
    }
}

/// Farthest that a continuation may lie from where it is expected, samples.
const REACH: f32 = 3.0;

/// Cost of a candidate.
fn cost(misfit: f32, from: f32, to: f32) -> f32 {
    let ratio = (to / from).ln();
    misfit * misfit + ratio * ratio
}

/// For each extremum of one trace its choice on another: index into `to`, or [`NONE`].
fn choices(from: (&[f32], &[f32]), to: (&[f32], &[f32]), chosen: &mut Vec<u32>) {
    chosen.clear();
    let mut first = 0;
    for (&z, &amplitude) in from.0.iter().zip(from.1) {
        while first < to.0.len() && to.0[first] < z - REACH {
            first += 1;
        }
        let mut best = (f32::INFINITY, NONE);
        for at in first..to.0.len() {
            let misfit = to.0[at] - z;
            if misfit > REACH {
                break;
            }
            let cost = cost(misfit, amplitude, to.1[at]);
            if cost < best.0 {
                best = (cost, at as u32);
            }
        }
        chosen.push(best.1);
    }
}

/// Links one trace with another: writes the partners of `from` to `next` and those of `to` to `back`, which start at the traces.
struct TracePair {
    forward: Vec<u32>,
    backward: Vec<u32>,
}

impl TracePair {
    fn link(
        &mut self,
        extrema: &Extrema,
        from: std::ops::Range<usize>,
        to: std::ops::Range<usize>,
        next: &mut [u32],
        back: &mut [u32],
    ) {
        let part = |range: &std::ops::Range<usize>| (&extrema.z[range.clone()], &extrema.amplitude[range.clone()]);
        choices(part(&from), part(&to), &mut self.forward);
        choices(part(&to), part(&from), &mut self.backward);
        for (here, &there) in self.forward.iter().enumerate() {
            if there != NONE && self.backward[there as usize] == here as u32 {
                next[here] = (to.start + there as usize) as u32;
                back[there as usize] = (from.start + here) as u32;
            }
        }
    }
}

/// All mutual links.
pub(super) fn mutual_links(extrema: &Extrema) -> Links {
    let [nx, ny, _] = extrema.size;
    let mut to = [(); 4].map(|()| vec![NONE; extrema.len()]);
    let [next_x, back_x, next_y, back_y] = &mut to;
    let lines = extrema.split_inlines(next_x).into_iter().zip(extrema.split_inlines(back_x).into_iter().skip(1));
    lines.enumerate().par_bridge().for_each(|(x, (next, back))| {
        let mut pair = TracePair { forward: Vec::new(), backward: Vec::new() };
        let (first, second) = (extrema.on_inline(x).start, extrema.on_inline(x + 1).start);
        for y in 0..ny {
            let (from, to) = (extrema.on_trace(x, y), extrema.on_trace(x + 1, y));
            let (next, back) = (&mut next[from.start - first..], &mut back[to.start - second..]);
            pair.link(extrema, from, to, next, back);
        }
    });
    let lines = extrema.split_inlines(next_y).into_iter().zip(extrema.split_inlines(back_y));
    lines.enumerate().par_bridge().for_each(|(x, (next, back))| {
        let mut pair = TracePair { forward: Vec::new(), backward: Vec::new() };
        let first = extrema.on_inline(x).start;
        for y in 1..ny {
            let (from, to) = (extrema.on_trace(x, y - 1), extrema.on_trace(x, y));
            let (next, back) = (&mut next[from.start - first..], &mut back[to.start - first..]);
            pair.link(extrema, from, to, next, back);
        }
    });
    debug_assert_eq!(nx, extrema.size[0]);
    Links { to }
}
