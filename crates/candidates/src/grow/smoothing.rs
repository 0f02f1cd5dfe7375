//! Binomial smoothing (1-2-1) over the surfaces: each extremum with those that it is linked to before and
//! behind it along an axis.
//!
//! Four numbers per extremum are smoothed together. A missing partner, or a link that must not be crossed,
//! contributes no weight, so one of the four numbers is the weight of the others. Rounds along y stay on one
//! inline and are done inline by inline while it is in the cache.

use super::links::{Links, NONE};
use crate::extrema::Extrema;
use rayon::prelude::*;
use survey::{Cancelled, Progress};

/// The numbers that are smoothed per extremum.
pub(crate) type Four = [f32; 4];

/// Two arrays for smoothing that are used again and again, because allocating fresh memory costs more than
/// the work itself. Memory: 32 bytes an extremum.
#[derive(Default)]
pub(crate) struct SmoothingScratch {
    /// The values to smooth, and afterwards the smoothed values.
    pub(crate) values: Vec<Four>,
    pub(crate) spare: Vec<Four>,
}

impl SmoothingScratch {
    /// Resizes both arrays to `count` extrema. Their contents are undefined.
    pub(crate) fn resize(&mut self, count: usize) {
        self.values.resize(count, [0.0; 4]);
        self.spare.resize(count, [0.0; 4]);
    }
}

/// Which links may be crossed, one entry an extremum: bit `direction` stands for [`Links::to`] of that
/// direction.
#[derive(Clone, Copy)]
pub(crate) enum Passable<'a> {
    /// All.
    All,
    /// Those whose bit is set.
    Marked(&'a [u8]),
}

/// The links of one axis, and which of them may be crossed.
#[derive(Clone, Copy)]
struct Steps<'a> {
    next: &'a [u32],
    back: &'a [u32],
    passable: Passable<'a>,
    axis: usize,
}

impl<'a> Steps<'a> {
    fn new(links: &'a Links, passable: Passable<'a>, axis: usize) -> Self {
        Self { next: &links.to[2 * axis], back: &links.to[2 * axis + 1], passable, axis }
    }

    /// The next and the previous extremum of `v`, or [`NONE`].
    #[inline(always)]
    fn around(&self, v: usize) -> [u32; 2] {
        let (next, back) = (self.next[v], self.back[v]);
        match self.passable {
            Passable::All => [next, back],
            Passable::Marked(marks) => {
                let marks = marks[v] >> (2 * self.axis);
                [if marks & 1 != 0 { next } else { NONE }, if marks & 2 != 0 { back } else { NONE }]
            }
        }
    }

    /// One round over the extrema from `first` on. `from` begins at extremum `start`.
    #[inline(always)]
    fn round(&self, first: usize, into: &mut [Four], from: &[Four], start: usize) {
        for (n, out) in into.iter_mut().enumerate() {
            let v = first + n;
            let mut sum = from[v - start].map(|value| 0.5 * value);
            for there in self.around(v) {
                // A missing partner has weight 0: cheaper than a branch.
                let (at, weight) = if there == NONE { (v, 0.0) } else { (there as usize, 0.25) };
                let value = from[at - start];
                for (sum, value) in sum.iter_mut().zip(value) {
                    *sum += weight * value;
                }
            }
            *out = sum;
        }
    }
}

/// `rounds` rounds of the binomial along `axis`, on `scratch.values`.
///
/// # Errors
/// [`Cancelled`] by the user; the values are then undefined.
pub(crate) fn along(
    extrema: &Extrema,
    links: &Links,
    axis: usize,
    rounds: usize,
    scratch: &mut SmoothingScratch,
    progress: &Progress,
) -> Result<(), Cancelled> {
    let steps = Steps::new(links, Passable::All, axis);
    if axis == 1 {
        extrema.split_inlines(&mut scratch.values).into_par_iter().enumerate().for_each_init(
            Vec::new,
            |other, (x, line)| {
                let first = extrema.on_inline(x).start;
                for _ in 0..rounds {
                    other.clear();
                    other.extend_from_slice(line);
                    steps.round(first, line, other, first);
                }
            },
        );
        return progress.check();
    }
    for _ in 0..rounds {
        progress.check()?;
        let SmoothingScratch { values, spare } = scratch;
        extrema.split_inlines(spare).into_par_iter().enumerate().for_each(|(x, line)| {
            steps.round(extrema.on_inline(x).start, line, values, 0);
        });
        std::mem::swap(values, spare);
    }
    Ok(())
}

/// One round along x, then one along y, on `scratch.values`.
pub(crate) fn across(extrema: &Extrema, links: &Links, passable: Passable<'_>, scratch: &mut SmoothingScratch) {
    let [along_x, along_y] = [0, 1].map(|axis| Steps::new(links, passable, axis));
    let SmoothingScratch { values, spare } = scratch;
    extrema.split_inlines(spare).into_par_iter().enumerate().for_each_init(Vec::new, |between, (x, line)| {
        let first = extrema.on_inline(x).start;
        between.resize(line.len(), [0.0; 4]);
        along_x.round(first, between, values, 0);
        along_y.round(first, line, between, first);
    });
    std::mem::swap(values, spare);
}
