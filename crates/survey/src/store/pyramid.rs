//! Halving a volume without aliasing.
//!
//! Every axis is low-passed by the half-band filter (−1, 0, 9, 16, 9, 0, −1)/32 and every second sample is kept, so that voxel m of
//! level L lies exactly at voxel m·2ᴸ of the full volume. What is missing (NaN: a dead trace, a sample beyond the wall) is left
//! out and the remaining weights are normalised; where the middle itself is missing, the result is.

use rayon::prelude::*;

/// Weights for lags −3 … 3.
const HALF_BAND: [f32; 7] = [-1.0, 0.0, 9.0, 16.0, 9.0, 0.0, -1.0];

/// Reach of the filter.
const REACH: usize = 3;

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

/// A box of the coarser level from the box of the finer level that [`needed`] names; `first` and `start` are their first
/// voxels, each in its own level.
pub(super) fn halve(
    fine: &[f32],
    fine_size: [usize; 3],
    first: [usize; 3],
    start: [usize; 3],
    size: [usize; 3],
) -> Vec<f32> {
    let [nx, ny, nz] = fine_size;
    let middle = |axis: usize, n: usize| 2 * (start[axis] + n) - first[axis];
    // Along z, trace by trace.
    let mut along_z = vec![0.0f32; nx * ny * size[2]];
    along_z.par_chunks_mut(size[2]).zip(fine.par_chunks(nz)).for_each(|(out, trace)| {
        for (n, value) in out.iter_mut().enumerate() {
            *value = weighted(middle(2, n), nz, |at| trace[at]);
        }
    });
    // Along y, slab by slab.
    let row = size[2];
    let mut along_y = vec![0.0f32; nx * size[1] * row];
    along_y.par_chunks_mut(size[1] * row).zip(along_z.par_chunks(ny * row)).for_each(|(out, slab)| {
        for (n, value) in out.iter_mut().enumerate() {
            *value = weighted(middle(1, n / row), ny, |at| slab[at * row + n % row]);
        }
    });
    // Along x, across slabs.
    let slab = size[1] * row;
    let mut coarse = vec![0.0f32; size[0] * slab];
    coarse.par_chunks_mut(slab).enumerate().for_each(|(x, out)| {
        for (n, value) in out.iter_mut().enumerate() {
            *value = weighted(middle(0, x), nx, |at| along_y[at * slab + n]);
        }
    });
    coarse
}

/// The filter at position `middle` of `count` values.
fn weighted(middle: usize, count: usize, value_at: impl Fn(usize) -> f32) -> f32 {
    if value_at(middle).is_nan() {
        return f32::NAN;
    }
    let (mut sum, mut weights) = (0.0, 0.0);
    for (lag, weight) in HALF_BAND.iter().enumerate() {
        let at = (middle + lag).wrapping_sub(REACH);
        if *weight != 0.0 && at < count {
            let value = value_at(at);
            if !value.is_nan() {
                sum += weight * value;
                weights += weight;
            }
        }
    }
    sum / weights
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f32::consts::PI;

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
