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
pub(crate) const BRICK: [usize; 3] = [8, 8, 16];

/// Width of a histogram's bin, samples.
const BIN: f32 = 0.25;

/// Count of bins: jumps from −4 to 4 samples.
pub(crate) const BINS: usize = 32;

/// Coarse dips at the centres of bricks.
pub(crate) struct DipField {
    count: [usize; 3],
    dips: Vec<[f32; 2]>,
}

/// Histograms of the jumps along x and along y in one brick.
pub(crate) type Histograms = [[f32; BINS]; 2];

impl DipField {
    /// Finds the dips from the links of all kinds of extrema.
    pub(crate) fn new(size: [usize; 3], kinds: &[(&Extrema, &Links)]) -> Self {
        let count = counts(size);
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
        let row = |bx: usize| (bx < count[0]).then(|| &bricks[bx * slab..(bx + 1) * slab]);
        let dips = (0..count[0])
            .into_par_iter()
            .flat_map_iter(|bx| {
                dips_of_row([count[1], count[2]], [bx.checked_sub(1).and_then(row), row(bx), row(bx + 1)])
            })
            .collect();
        Self { count, dips }
    }

    /// The field whose dips, `[x][y][z]`, were found before.
    pub(crate) fn of_dips(size: [usize; 3], dips: Vec<[f32; 2]>) -> Self {
        Self { count: counts(size), dips }
    }

    /// Dips at each extremum, interpolated linearly between the centres of bricks. The extrema are those of the
    /// traces from `first` on.
    pub(crate) fn at_extrema(&self, extrema: &Extrema, [first_x, first_y]: [usize; 2]) -> Vec<[f32; 2]> {
        let mut dips = vec![[0.0; 2]; extrema.len()];
        let ny = extrema.size[1];
        extrema.split_inlines(&mut dips).into_par_iter().enumerate().for_each(|(x, line)| {
            let first = extrema.on_inline(x).start;
            let across = self.between(0, (first_x + x) as f32);
            for y in 0..ny {
                let along = self.between(1, (first_y + y) as f32);
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

/// Counts of bricks of a volume of `size`.
pub(crate) fn counts(size: [usize; 3]) -> [usize; 3] {
    [0, 1, 2].map(|axis| size[axis].div_ceil(BRICK[axis]).max(1))
}

/// Dips of a row of bricks, `[y][z]`, from the histograms of the rows before, here and after.
pub(crate) fn dips_of_row([ny, nz]: [usize; 2], rows: [Option<&[Histograms]>; 3]) -> Vec<[f32; 2]> {
    let around = |at: usize, count: usize| at.saturating_sub(1)..(at + 2).min(count);
    let pooled_at = |y: usize, z: usize| {
        let mut pooled: Histograms = [[0.0; BINS]; 2];
        for row in rows.iter().flatten() {
            for (by, bz) in around(y, ny).flat_map(|by| around(z, nz).map(move |bz| (by, bz))) {
                let brick = row[by * nz + bz].as_flattened();
                pooled.as_flattened_mut().iter_mut().zip(brick).for_each(|(sum, weight)| *sum += weight);
            }
        }
        pooled.map(|histogram| mode(&histogram))
    };
    (0..ny * nz).map(|at| pooled_at(at / nz, at % nz)).collect()
}

/// Adds the jumps of a trace to its column of bricks.
pub(crate) fn add_trace(extrema: &Extrema, links: &Links, trace: std::ops::Range<usize>, column: &mut [Histograms]) {
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
pub(crate) fn along_surfaces(
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
