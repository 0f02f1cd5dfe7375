//! Links between extrema of neighbouring traces that are each other's best match.
//!
//! An extremum at z on one trace is expected to continue on the next trace at z + dip. Of the extrema within
//! reach it chooses the one of least cost. A link is a pair of extrema that choose each other, so links do
//! not depend on any order.
//!
//! `cost = misfit² + (2·(a − b)/(a + b))²` with the misfit in samples and the amplitudes a and b. The second
//! term approximates the squared logarithm of their ratio while they are similar, and is at most 4.

use crate::extrema::Extrema;
use rayon::prelude::*;
use std::ops::Range;
use survey::{Cancelled, Progress};

/// No extremum.
pub(crate) const NONE: u32 = u32::MAX;

/// Indices into [`Links::to`].
pub(crate) const NEXT_X: usize = 0;
pub(crate) const BACK_X: usize = 1;
pub(crate) const NEXT_Y: usize = 2;
pub(crate) const BACK_Y: usize = 3;

/// Links of the extrema of one kind. Memory: 16 bytes an extremum.
pub(crate) struct Links {
    /// Partner of each extremum at x + 1, x − 1, y + 1, y − 1, or [`NONE`].
    pub(crate) to: [Vec<u32>; 4],
}

impl Links {
    /// The corners [a, x + 1, y + 1, both] of the cell that begins at `a`, if all four links exist and agree.
    #[inline]
    pub(crate) fn closed(&self, a: u32) -> Option<[u32; 4]> {
        let (b, c) = (self.to[NEXT_X][a as usize], self.to[NEXT_Y][a as usize]);
        if b == NONE || c == NONE {
            return None;
        }
        let (d, e) = (self.to[NEXT_Y][b as usize], self.to[NEXT_X][c as usize]);
        (d == e && d != NONE).then_some([a, b, c, d])
    }
}

/// The extrema of one of the two traces of a link, with their dips.
struct Side<'e> {
    z: &'e [f32],
    amplitude: &'e [f32],
    dips: &'e [[f32; 2]],
    first: usize,
}

impl<'e> Side<'e> {
    fn of(extrema: &'e Extrema, dips: &'e [[f32; 2]], range: Range<usize>) -> Self {
        Self {
            z: &extrema.z[range.clone()],
            amplitude: &extrema.amplitude[range.clone()],
            dips: if dips.is_empty() { &[] } else { &dips[range.clone()] },
            first: range.start,
        }
    }

    /// For each extremum its choice on the other trace, which lies in `direction` (±1) along `axis`.
    #[inline]
    fn choose(&self, other: &Self, axis: usize, direction: f32, reach: f32, chosen: &mut Vec<u32>) {
        chosen.clear();
        // The search begins close to where the previous extremum's began.
        let mut start = 0;
        for (here, (&z, &amplitude)) in self.z.iter().zip(self.amplitude).enumerate() {
            let expected = z + direction * self.dips.get(here).map_or(0.0, |dip| dip[axis]);
            let least = expected - reach;
            while start > 0 && other.z[start - 1] >= least {
                start -= 1;
            }
            while start < other.z.len() && other.z[start] < least {
                start += 1;
            }
            let mut best = (f32::INFINITY, NONE);
            for at in start..other.z.len() {
                let misfit = other.z[at] - expected;
                if misfit > reach {
                    break;
                }
                let there = other.amplitude[at];
                let contrast = 2.0 * (amplitude - there) / (amplitude + there);
                let cost = misfit * misfit + contrast * contrast;
                if cost < best.0 {
                    best = (cost, at as u32);
                }
            }
            chosen.push(best.1);
        }
    }
}

/// Links two traces. `next` and `back` begin at the first extremum of their trace.
fn link(
    from: &Side,
    to: &Side,
    axis: usize,
    reach: f32,
    next: &mut [u32],
    back: &mut [u32],
    scratch: &mut [Vec<u32>; 2],
) {
    let [forward, backward] = scratch;
    from.choose(to, axis, 1.0, reach, forward);
    to.choose(from, axis, -1.0, reach, backward);
    for (here, &there) in forward.iter().enumerate() {
        if there != NONE && backward[there as usize] == here as u32 {
            next[here] = to.first as u32 + there;
            back[there as usize] = (from.first + here) as u32;
        }
    }
}

/// All mutual links (see `find`).
pub(crate) fn mutual_links(
    extrema: &Extrema,
    dips: &[[f32; 2]],
    reach: f32,
    progress: &Progress,
) -> Result<Links, Cancelled> {
    let mut links = Links { to: [(); 4].map(|()| vec![NONE; extrema.len()]) };
    links.find(extrema, dips, reach, progress)?;
    Ok(links)
}

impl Links {
    /// Finds all mutual links. Continuations are expected along `dips` (samples a trace along x and y, one
    /// entry an extremum; empty for flat) and accepted within `reach` samples.
    fn find(&mut self, extrema: &Extrema, dips: &[[f32; 2]], reach: f32, progress: &Progress) -> Result<(), Cancelled> {
        let ny = extrema.size[1];
        let [next_x, back_x, next_y, back_y] = &mut self.to;
        let pairs: Vec<_> =
            extrema.split_inlines(next_x).into_iter().zip(extrema.split_inlines(back_x).into_iter().skip(1)).collect();
        pairs.into_par_iter().enumerate().try_for_each(|(x, (next, back))| {
            progress.check()?;
            let mut scratch = [Vec::new(), Vec::new()];
            let (first, second) = (extrema.on_inline(x).start, extrema.on_inline(x + 1).start);
            for y in 0..ny {
                let (from, to) = (extrema.on_trace(x, y), extrema.on_trace(x + 1, y));
                let (next, back) = (&mut next[from.start - first..], &mut back[to.start - second..]);
                link(&Side::of(extrema, dips, from), &Side::of(extrema, dips, to), 0, reach, next, back, &mut scratch);
            }
            Ok(())
        })?;
        let pairs: Vec<_> = extrema.split_inlines(next_y).into_iter().zip(extrema.split_inlines(back_y)).collect();
        pairs.into_par_iter().enumerate().try_for_each(|(x, (next, back))| {
            progress.check()?;
            let mut scratch = [Vec::new(), Vec::new()];
            let first = extrema.on_inline(x).start;
            for y in 1..ny {
                let (from, to) = (extrema.on_trace(x, y - 1), extrema.on_trace(x, y));
                let (next, back) = (&mut next[from.start - first..], &mut back[to.start - first..]);
                link(&Side::of(extrema, dips, from), &Side::of(extrema, dips, to), 1, reach, next, back, &mut scratch);
            }
            Ok(())
        })?;
        progress.step(extrema.size[0] as u64)
    }

    /// Finds all links again, in the same memory.
    pub(crate) fn renew(
        mut self,
        extrema: &Extrema,
        dips: &[[f32; 2]],
        reach: f32,
        progress: &Progress,
    ) -> Result<Self, Cancelled> {
        self.to.par_iter_mut().for_each(|to| to.fill(NONE));
        self.find(extrema, dips, reach, progress)?;
        Ok(self)
    }
}
