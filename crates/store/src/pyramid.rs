//! Halving a volume without aliasing.
//!
//! Every axis is low-passed by the half-band filter (−1, 0, 9, 16, 9, 0, −1)/32 and every second sample is
//! kept, so that voxel m of level L lies exactly at voxel m·2ᴸ of the full volume. Missing samples (NaN: a
//! dead trace, a sample outside the outer boundary) are left out and the remaining weights are normalised;
//! where the middle itself is missing, the result is.
//!
//! The axes are filtered one after the other, trace by trace and slab by slab (a slab is an inline of the
//! box): what is between two steps fits the processor's cache. Traces are nearly always there or missing as a
//! whole; rows of samples remember which, and the sums over whole rows are vector instructions. Every value
//! is summed in the order of the lags, so that a box is bit by bit a part of the whole.

/// Lags whose weights are not 0, counted from −[`REACH`], and the weights.
const TAPS: [(usize, f32); 5] = [(0, -1.0), (2, 9.0), (3, 16.0), (4, 9.0), (6, -1.0)];

/// The one of the middle.
const MIDDLE: usize = 2;

/// Their sum, a power of two.
const SUM: f32 = 32.0;

/// Reach of the filter.
const REACH: usize = 3;

/// Slabs that the filter across them needs at a time.
const WINDOW: usize = 2 * REACH + 1;

/// Size of the next level.
pub(super) fn halved(size: [usize; 3]) -> [usize; 3] {
    size.map(|n| n.div_ceil(2))
}

/// Samples of a finer level that a range of a coarser one is made from: first and count.
pub(super) fn needed(start: usize, count: usize, fine_count: usize) -> (usize, usize) {
    let first = (2 * start).saturating_sub(REACH);
    let last = (2 * (start + count - 1) + REACH).min(fine_count - 1);
    (first, last - first + 1)
}

/// What a row of samples holds.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum RowContent {
    /// Numbers throughout.
    Whole,
    /// Nothing; its values are not defined.
    Missing,
    /// Numbers and NaN.
    Mixed,
}

impl RowContent {
    fn of(values: &[f32]) -> Self {
        match values.iter().map(|value| u32::from(value.is_nan())).sum::<u32>() as usize {
            0 => Self::Whole,
            missing if missing == values.len() => Self::Missing,
            _ => Self::Mixed,
        }
    }
}

/// Rows of one length, and what each holds.
#[derive(Debug, Default)]
struct Rows {
    length: usize,
    values: Vec<f32>,
    kinds: Vec<RowContent>,
}

impl Rows {
    fn reset(&mut self, count: usize, length: usize) {
        self.length = length;
        self.values.resize(count * length, 0.0);
        self.kinds.resize(count, RowContent::Missing);
    }

    fn get(&self, row: usize) -> (&[f32], RowContent) {
        (&self.values[row * self.length..(row + 1) * self.length], self.kinds[row])
    }
}

/// Boxes of one level.
#[derive(Debug, Clone, Copy)]
pub(super) struct LevelBox {
    /// First voxel, in its own level.
    pub first: [usize; 3],
    /// Voxels along each axis.
    pub size: [usize; 3],
}

/// Makes boxes of a coarser level. Its memory is kept from one box to the next.
#[derive(Debug, Default)]
pub(super) struct Halving {
    trace: Vec<f32>,
    evens: Vec<f32>,
    odds: Vec<f32>,
    /// Traces of a slab, halved along z.
    along_z: Rows,
    /// Slabs halved along z and y: slab x of the finer box is entry x modulo the window.
    along_y: [Rows; WINDOW],
    slab: Vec<f32>,
}

impl Halving {
    /// Makes `coarse` from `fine`, the box that [`needed`] names. `supply` fills in the trace at x, y of the
    /// finer box, NaN where it has no sample, and returns whether there is any; `take` receives slab after
    /// slab of the coarser box.
    pub(crate) fn run(
        &mut self,
        fine: LevelBox,
        coarse: LevelBox,
        mut supply: impl FnMut(usize, usize, &mut [f32]) -> bool,
        mut take: impl FnMut(usize, &[f32]),
    ) {
        let [nx, ny, nz] = fine.size;
        let [_, rows, length] = coarse.size;
        let middle = |axis: usize, n: usize| 2 * (coarse.first[axis] + n) - fine.first[axis];
        self.trace.resize(nz, 0.0);
        self.slab.resize(rows * length, 0.0);
        self.along_z.reset(ny, length);
        let mut done = 0;
        for x in 0..nx {
            for y in 0..ny {
                let kind =
                    if supply(x, y, &mut self.trace) { RowContent::of(&self.trace) } else { RowContent::Missing };
                self.along_z.kinds[y] = kind;
                if kind != RowContent::Missing {
                    self.halve_trace(y, middle(2, 0), kind);
                }
            }
            let slab = &mut self.along_y[x % WINDOW];
            slab.reset(rows, length);
            for row in 0..rows {
                let out = &mut slab.values[row * length..(row + 1) * length];
                slab.kinds[row] = filter(out, taps(middle(1, row), ny).map(|at| at.map(|at| self.along_z.get(at))));
            }
            // Every slab of the coarser box that needs no later one.
            while done < coarse.size[0] && (middle(0, done) + REACH).min(nx - 1) == x {
                let taps = taps(middle(0, done), nx);
                for row in 0..rows {
                    let out = &mut self.slab[row * length..(row + 1) * length];
                    filter(out, taps.map(|at| at.map(|at| self.along_y[at % WINDOW].get(row))));
                }
                take(done, &self.slab);
                done += 1;
            }
        }
    }

    /// Halves the trace into row `y`; `first` is its sample at which the first one of the result lies.
    fn halve_trace(&mut self, y: usize, first: usize, kind: RowContent) {
        let length = self.along_z.length;
        let out = &mut self.along_z.values[y * length..(y + 1) * length];
        let trace = &self.trace;
        let single = |n: usize| weighted(taps(first + 2 * n, trace.len()).map(|at| at.map(|at| trace[at])));
        // Results whose samples are all there.
        let low = REACH.saturating_sub(first).div_ceil(2).min(length);
        let high = match trace.len().checked_sub(REACH + first) {
            Some(reached @ 1..) if kind == RowContent::Whole => ((reached - 1) / 2 + 1).clamp(low, length),
            _ => low,
        };
        out[..low].iter_mut().enumerate().for_each(|(n, out)| *out = single(n));
        out[high..].iter_mut().enumerate().for_each(|(n, out)| *out = single(high + n));
        if low < high {
            let (pairs, last) = trace[first + 2 * low - REACH..].as_chunks::<2>();
            self.evens.clear();
            self.odds.clear();
            self.evens.extend(pairs.iter().map(|pair| pair[0]).chain(last.iter().copied()));
            self.odds.extend(pairs.iter().map(|pair| pair[1]));
            let (evens, odds) = (&self.evens[..], &self.odds[1..]);
            let count = high - low;
            let even = |from: usize| &evens[from..from + count];
            let sides = even(0).iter().zip(even(1)).zip(even(2).iter().zip(even(3)));
            for ((out, middle), ((a, b), (d, e))) in out[low..high].iter_mut().zip(&odds[..count]).zip(sides) {
                *out = whole([*a, *b, *middle, *d, *e]);
            }
        }
        self.along_z.kinds[y] = if kind == RowContent::Whole { RowContent::Whole } else { RowContent::of(out) };
    }
}

/// Positions of the samples about `middle` that are among `count`.
fn taps(middle: usize, count: usize) -> [Option<usize>; 5] {
    TAPS.map(|(lag, _)| Some((middle + lag).wrapping_sub(REACH)).filter(|&at| at < count))
}

/// The filter on five numbers.
fn whole([a, b, c, d, e]: [f32; 5]) -> f32 {
    let [wa, wb, wc, wd, we] = TAPS.map(|(_, weight)| weight);
    (wa * a + wb * b + wc * c + wd * d + we * e) / SUM
}

/// The filter on what there is of five samples.
fn weighted(samples: [Option<f32>; 5]) -> f32 {
    if samples[MIDDLE].is_none_or(f32::is_nan) {
        return f32::NAN;
    }
    let (mut sum, mut weights) = (0.0, 0.0);
    for (sample, (_, weight)) in samples.into_iter().zip(TAPS) {
        if let Some(value) = sample.filter(|value| !value.is_nan()) {
            sum += weight * value;
            weights += weight;
        }
    }
    sum / weights
}

/// The filter across rows, those that there are; what the result holds.
fn filter(out: &mut [f32], rows: [Option<(&[f32], RowContent)>; 5]) -> RowContent {
    let rows = rows.map(|row| row.filter(|(_, kind)| *kind != RowContent::Missing));
    if rows[MIDDLE].is_none() {
        out.fill(f32::NAN);
        return RowContent::Missing;
    }
    if rows.iter().flatten().any(|(_, kind)| *kind == RowContent::Mixed) {
        for (n, out) in out.iter_mut().enumerate() {
            *out = weighted(rows.map(|row| row.map(|(values, _)| values[n])));
        }
        return RowContent::of(out);
    }
    if let [Some((a, _)), Some((b, _)), Some((c, _)), Some((d, _)), Some((e, _))] = rows {
        let sides = a.iter().zip(b).zip(d.iter().zip(e));
        for ((out, middle), ((a, b), (d, e))) in out.iter_mut().zip(c).zip(sides) {
            *out = whole([*a, *b, *middle, *d, *e]);
        }
        return RowContent::Whole;
    }
    out.fill(0.0);
    let mut weights = 0.0;
    for (values, weight) in rows.iter().zip(TAPS).filter_map(|(row, (_, weight))| Some((row.as_ref()?.0, weight))) {
        out.iter_mut().zip(values).for_each(|(out, value)| *out += weight * value);
        weights += weight;
    }
    out.iter_mut().for_each(|out| *out /= weights);
    RowContent::Whole
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f32::consts::PI;

    /// A box of the coarser level from the box of the finer one.
    fn halve(fine: &[f32], fine_size: [usize; 3], first: [usize; 3], start: [usize; 3], size: [usize; 3]) -> Vec<f32> {
        let [_, ny, nz] = fine_size;
        let mut coarse = Vec::new();
        Halving::default().run(
            LevelBox { first, size: fine_size },
            LevelBox { first: start, size },
            |x, y, trace| {
                trace.copy_from_slice(&fine[(x * ny + y) * nz..][..nz]);
                true
            },
            |_, slab| coarse.extend_from_slice(slab),
        );
        coarse
    }

    /// The same, one sample after the other, straight from the definition.
    fn halve_plainly(fine: &[f32], size: [usize; 3]) -> Vec<f32> {
        let mut values = fine.to_vec();
        let mut size = size;
        for axis in [2, 1, 0] {
            let stride: usize = size[axis + 1..].iter().product();
            let count = size[axis];
            let mut half = size;
            half[axis] = count.div_ceil(2);
            values = (0..half.iter().product())
                .map(|n: usize| {
                    let (before, m, after) = (n / stride / half[axis], n / stride % half[axis], n % stride);
                    let samples =
                        taps(2 * m, count).map(|at| at.map(|at| values[(before * count + at) * stride + after]));
                    weighted(samples)
                })
                .collect();
            size = half;
        }
        values
    }

    #[test]
    fn rows_give_what_single_samples_give_bit_by_bit() {
        let mut state = 1u32;
        for size in [[1, 1, 1], [2, 3, 4], [9, 8, 7], [13, 5, 40], [6, 11, 65]] {
            for holes in 0..4 {
                let [_, ny, nz] = size;
                let fine: Vec<f32> = (0..size.iter().product())
                    .map(|n: usize| {
                        state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
                        let column = n / nz;
                        // Missing traces, missing slabs, missing samples.
                        let is_missing = match holes {
                            1 => column % 5 == 2,
                            2 => column / ny % 3 == 1,
                            3 => state >> 28 == 0 || column % 7 == 3,
                            _ => false,
                        };
                        if is_missing { f32::NAN } else { (state >> 8) as f32 / 65_536.0 - 100.0 }
                    })
                    .collect();
                let rows = halve(&fine, size, [0; 3], [0; 3], halved(size));
                let bits = |values: &[f32]| -> Vec<Option<u32>> {
                    values.iter().map(|v| (!v.is_nan()).then(|| (v + 0.0).to_bits())).collect()
                };
                assert_eq!(bits(&rows), bits(&halve_plainly(&fine, size)), "{size:?} {holes}");
            }
        }
    }

    fn line(values: &[f32]) -> Vec<f32> {
        let n = values.len();
        halve(values, [1, 1, n], [0; 3], [0; 3], [1, 1, n.div_ceil(2)])
    }

    #[test]
    fn constants_and_linear_ramps_are_kept_away_from_the_ends() {
        assert!(line(&[4.0; 9]).iter().all(|&v| (v - 4.0).abs() < 1e-6));
        let ramp: Vec<f32> = (0..32).map(|n| n as f32).collect();
        for (m, value) in line(&ramp).iter().enumerate().skip(2).take(12) {
            assert!((value - 2.0 * m as f32).abs() < 1e-5);
        }
    }

    #[test]
    fn what_would_alias_is_suppressed_and_slow_waves_pass() {
        let wave = |period: f32| -> f32 {
            let values: Vec<f32> = (0..256).map(|n| (2.0 * PI * n as f32 / period).cos()).collect();
            line(&values)[8..120].iter().fold(0.0, |a, v| a.max(v.abs()))
        };
        assert!(wave(2.0) < 1e-5, "the highest frequency vanishes");
        assert!(wave(2.5) < 0.08);
        assert!(wave(12.0) > 0.97);
    }

    #[test]
    fn missing_values_neither_spread_nor_leak() {
        let mut values = [1.0f32; 17];
        values[6] = f32::NAN;
        values[9] = f32::NAN;
        let half = line(&values);
        assert!(half[3].is_nan(), "the kept sample itself is missing");
        assert!(half.iter().enumerate().all(|(m, v)| m == 3 || (v - 1.0).abs() < 1e-6));
    }

    #[test]
    fn boxes_agree_with_the_whole() {
        let size = [21, 14, 33];
        let count = size.iter().product::<usize>();
        let fine: Vec<f32> = (0..count).map(|n| ((n * 7919) % 101) as f32).collect();
        let coarse_size = halved(size);
        let whole = halve(&fine, size, [0; 3], [0; 3], coarse_size);
        let (start, part) = ([4, 2, 8], [5, 4, 7]);
        let mut first = [0; 3];
        let mut box_size = [0; 3];
        for axis in 0..3 {
            (first[axis], box_size[axis]) = needed(start[axis], part[axis], size[axis]);
        }
        let inner = super::super::layout::gather(&fine, &size, &first, &box_size);
        let half = halve(&inner, box_size, first, start, part);
        assert_eq!(half, super::super::layout::gather(&whole, &coarse_size, &start, &part));
    }
}
