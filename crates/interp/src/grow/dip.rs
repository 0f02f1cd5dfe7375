//! The dip that guides the links.
//!
//! Two steps. First a coarse field ([`DipField`]): the jumps of unguided links are collected in histograms
//! over bricks of traces, pooled with their neighbours. The mode is the dip, so that neither a fault nor
//! links that skipped a cycle bias it. Then, link by link, a normalised convolution along the surfaces
//! ([`along_surfaces`]): p̄ = G∗(w·jump) / G∗w, with G a binomial of 7 × 7 traces that never crosses a link
//! that does not fit, and w decreasing with the misfit to the dip known so far. Unlike those of a structure
//! tensor, these dips do not alias where a reflector steps by more than half a period a trace. Unit: samples
//! a trace.

use super::links::{BACK_X, BACK_Y, Links, NEXT_X, NEXT_Y, NONE};
use super::smoothing::{self, Passable, SmoothingScratch};
use crate::extrema::Extrema;
use rayon::prelude::*;
use survey::{Cancelled, Progress};

/// Size of a brick: inlines, crosslines, samples.
const BRICK: [usize; 3] = [8, 8, 16];

/// Width of a histogram's bin, samples.
const BIN: f32 = 0.25;

/// Count of bins: jumps from −4 to 4 samples.
const BINS: usize = 32;

/// Coarse dips at the centres of bricks.
pub(super) struct DipField {
    count: [usize; 3],
    dips: Vec<[f32; 2]>,
}

/// Histograms of the jumps along x and along y in one brick.
type Histograms = [[f32; BINS]; 2];

impl DipField {
    /// Finds the dips from the links of all kinds of extrema.
    pub(super) fn new(size: [usize; 3], kinds: &[(&Extrema, &Links)]) -> Self {
        let count = [0, 1, 2].map(|axis| size[axis].div_ceil(BRICK[axis]).max(1));
        let slab = count[1] * count[2];
        let mut bricks: Vec<Histograms> = vec![[[0.0; BINS]; 2]; count[0] * slab];
        bricks.par_chunks_mut(slab).enumerate().for_each(|(bx, slab)| {
            for (extrema, links) in kinds {
                for x in bx * BRICK[0]..((bx + 1) * BRICK[0]).min(size[0]) {
                    for y in 0..size[1] {
                        add_trace(extrema, links, extrema.on_trace(x, y), &mut slab[y / BRICK[1] * count[2]..]);
                    }
                }
            }
        });
        let dips = (0..bricks.len())
            .into_par_iter()
            .map(|at| {
                let centre = [at / slab, at / count[2] % count[1], at % count[2]];
                let range = |axis: usize| centre[axis].saturating_sub(1)..(centre[axis] + 2).min(count[axis]);
                let mut pooled: Histograms = [[0.0; BINS]; 2];
                for bx in range(0) {
                    for by in range(1) {
                        for bz in range(2) {
                            let brick = &bricks[(bx * count[1] + by) * count[2] + bz];
                            for axis in 0..2 {
                                for (sum, weight) in pooled[axis].iter_mut().zip(&brick[axis]) {
                                    *sum += weight;
                                }
                            }
                        }
                    }
                }
                pooled.map(|histogram| mode(&histogram))
            })
            .collect();
        Self { count, dips }
    }

    /// Dips at each extremum, interpolated linearly between the centres of bricks.
    pub(super) fn at_extrema(&self, extrema: &Extrema) -> Vec<[f32; 2]> {
        let mut dips = vec![[0.0; 2]; extrema.len()];
        let ny = extrema.size[1];
        extrema.split_inlines(&mut dips).into_par_iter().enumerate().for_each(|(x, line)| {
            let first = extrema.on_inline(x).start;
            let across = self.between(0, x as f32);
            for y in 0..ny {
                let along = self.between(1, y as f32);
                for v in extrema.on_trace(x, y) {
                    let down = self.between(2, extrema.z[v]);
                    let mut dip = [0.0; 2];
                    for (bx, wx) in across {
                        for (by, wy) in along {
                            for (bz, wz) in down {
                                let at = self.dips[(bx * self.count[1] + by) * self.count[2] + bz];
                                dip[0] += wx * wy * wz * at[0];
                                dip[1] += wx * wy * wz * at[1];
                            }
                        }
                    }
                    line[v - first] = dip;
                }
            }
        });
        dips
    }

    /// The two bricks around position `at` along an axis, with their weights.
    fn between(&self, axis: usize, at: f32) -> [(usize, f32); 2] {
        let place = ((at + 0.5) / BRICK[axis] as f32 - 0.5).clamp(0.0, (self.count[axis] - 1) as f32);
        let low = place as usize;
        let share = place - low as f32;
        [(low, 1.0 - share), ((low + 1).min(self.count[axis] - 1), share)]
    }
}

/// Adds the jumps of a trace to its column of bricks.
fn add_trace(extrema: &Extrema, links: &Links, trace: std::ops::Range<usize>, column: &mut [Histograms]) {
    for v in trace {
        let brick = &mut column[extrema.z[v] as usize / BRICK[2]];
        for (axis, direction) in [NEXT_X, NEXT_Y].into_iter().enumerate() {
            let next = links.to[direction][v];
            if next != NONE {
                let jump = extrema.z[next as usize] - extrema.z[v];
                let bin = (jump / BIN + BINS as f32 / 2.0) as usize;
                brick[axis][bin.min(BINS - 1)] += extrema.amplitude[v].min(extrema.amplitude[next as usize]);
            }
        }
    }
}

/// The most frequent jump: the mean around the highest of the smoothed bins; 0 for an empty histogram.
fn mode(histogram: &[f32; BINS]) -> f32 {
    let at = |bin: usize| histogram[bin];
    let smoothed = |bin: usize| {
        let (below, above) = (at(bin.saturating_sub(1)), at((bin + 1).min(BINS - 1)));
        below + 2.0 * at(bin) + above
    };
    let mut top = 0;
    for bin in 1..BINS {
        if smoothed(bin) > smoothed(top) {
            top = bin;
        }
    }
    let (mut sum, mut weight) = (0.0, 0.0);
    for bin in top.saturating_sub(3)..(top + 4).min(BINS) {
        sum += at(bin) * ((bin as f32 + 0.5) - BINS as f32 / 2.0) * BIN;
        weight += at(bin);
    }
    if weight > 0.0 { sum / weight } else { 0.0 }
}

/// Rounds of the binomial 1-2-1 along x and y; 3 rounds cover 7 × 7 traces.
const ROUNDS: usize = 3;

/// Weight of the dip known so far, so that an extremum without links keeps it.
const PRIOR: f32 = 0.02;

/// Refines `dips` along the surfaces. A link has the weight `w = 1/(1 + (misfit/scale)²)²`. The convolution
/// crosses only links with a misfit below two scales.
///
/// # Errors
/// [`Cancelled`] by the user; the dips are then unchanged.
pub(super) fn along_surfaces(
    extrema: &Extrema,
    links: &Links,
    dips: &mut [[f32; 2]],
    scale: f32,
    scratch: &mut SmoothingScratch,
    progress: &Progress,
) -> Result<(), Cancelled> {
    let count = extrema.len();
    scratch.resize(count);
    let mut marks = vec![0u8; count];
    // The contribution of each link to the next trace: [w·jump_x, w, w·jump_y, w].
    (&mut scratch.spare, &mut marks).into_par_iter().with_min_len(GRAIN).enumerate().for_each(|(v, (said, marks))| {
        *said = [0.0; 4];
        *marks = 0;
        for (axis, direction) in [NEXT_X, NEXT_Y].into_iter().enumerate() {
            let next = links.to[direction][v];
            if next == NONE {
                continue;
            }
            let jump = extrema.z[next as usize] - extrema.z[v];
            let misfit = jump - 0.5 * (dips[v][axis] + dips[next as usize][axis]);
            let off = misfit / scale;
            let weight = 1.0 / (1.0 + off * off).powi(2);
            (said[2 * axis], said[2 * axis + 1]) = (weight * jump, weight);
            *marks |= u8::from(misfit.abs() < 2.0 * scale) << direction;
        }
    });
    // A link contributes to both of its ends.
    let SmoothingScratch { values, spare } = scratch;
    let forward = &marks;
    let passable: Vec<u8> = values
        .par_iter_mut()
        .with_min_len(GRAIN)
        .enumerate()
        .map(|(v, sum)| {
            let own = spare[v];
            let mut marks = forward[v];
            for (axis, direction) in [BACK_X, BACK_Y].into_iter().enumerate() {
                let back = links.to[direction][v];
                let mut said = [0.0; 2];
                if back != NONE {
                    said = [spare[back as usize][2 * axis], spare[back as usize][2 * axis + 1]];
                    marks |= (forward[back as usize] & 1 << (2 * axis)) << 1;
                }
                sum[2 * axis] = PRIOR * dips[v][axis] + own[2 * axis] + said[0];
                sum[2 * axis + 1] = PRIOR + own[2 * axis + 1] + said[1];
            }
            marks
        })
        .collect();
    for _ in 0..ROUNDS {
        progress.check()?;
        smoothing::across(extrema, links, Passable::Marked(&passable), scratch);
    }
    let smoothed = dips.par_iter_mut().with_min_len(GRAIN).zip(&scratch.values);
    smoothed.for_each(|(dip, &[x, wx, y, wy])| *dip = [x / wx, y / wy]);
    progress.step(extrema.size[0] as u64)
}

/// Count of extrema that one thread handles at a time.
const GRAIN: usize = 1 << 14;
