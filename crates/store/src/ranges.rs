//! Least and greatest sample of each brick of a volume, found while it is written.

use super::array::write_array;
use super::error::StoreError;
use super::layout::{ArrayLayout, BRICK};
use super::sample::StoredSample;
use std::path::Path;
use survey::progress::Progress;
use survey::sample::Sample;

/// Least and greatest value of bricks, by their index; the least is above the greatest where there is no
/// value.
pub type IndexedRanges = Vec<(usize, [f32; 2])>;

/// A box of samples whose first voxel is `first`.
pub(super) struct SampleBox<'a, T> {
    pub values: &'a [T],
    pub first: [usize; 3],
    pub size: [usize; 3],
}

impl<T: StoredSample + Sample> SampleBox<'_, T> {
    /// Least and greatest live sample of each brick of the box from `start` of size `part`, with the brick's
    /// number in a volume of `volume` voxels; `start` is a multiple of the brick. NaN is ignored.
    pub(crate) fn ranges(
        &self,
        start: [usize; 3],
        part: [usize; 3],
        mask: &[bool],
        volume: [usize; 3],
    ) -> IndexedRanges {
        let counts = volume.map(|n| n.div_ceil(BRICK));
        let inside = part.map(|n| n.div_ceil(BRICK));
        let mut found = vec![Range::NONE; inside.iter().product()];
        for x in start[0]..start[0] + part[0] {
            for y in (start[1]..start[1] + part[1]).filter(|y| mask[x * volume[1] + y]) {
                let row = ((x - self.first[0]) * self.size[1] + y - self.first[1]) * self.size[2];
                let from = row + start[2] - self.first[2];
                let column = ((x - start[0]) / BRICK * inside[1] + (y - start[1]) / BRICK) * inside[2];
                let bricks = self.values[from..from + part[2]].chunks(BRICK);
                found[column..].iter_mut().zip(bricks).for_each(|(range, part)| range.add(part));
            }
        }
        let number = |n: usize| {
            let place = [n / (inside[1] * inside[2]), n / inside[2] % inside[1], n % inside[2]];
            let at = [0, 1, 2].map(|axis| start[axis] / BRICK + place[axis]);
            (at[0] * counts[1] + at[1]) * counts[2] + at[2]
        };
        found.into_iter().enumerate().map(|(n, range)| (number(n), range.ends())).collect()
    }
}

/// Samples handled side by side.
const LANES: usize = 16;

/// A range that grows, in lanes that become vector instructions; comparisons with NaN are false.
#[derive(Debug, Clone, Copy)]
struct Range {
    lows: [f32; LANES],
    highs: [f32; LANES],
}

impl Range {
    const NONE: Self = Self { lows: [f32::INFINITY; LANES], highs: [f32::NEG_INFINITY; LANES] };

    fn add<T: StoredSample + Sample>(&mut self, samples: &[T]) {
        let (chunks, rest) = samples.as_chunks::<LANES>();
        let (mut lows, mut highs) = (self.lows, self.highs);
        let mut widen = |lane: usize, value: f32| {
            lows[lane] = if value < lows[lane] { value } else { lows[lane] };
            highs[lane] = if value > highs[lane] { value } else { highs[lane] };
        };
        for chunk in chunks {
            chunk.iter().enumerate().for_each(|(lane, value)| widen(lane, value.to_f32()));
        }
        rest.iter().enumerate().for_each(|(lane, value)| widen(lane, value.to_f32()));
        (self.lows, self.highs) = (lows, highs);
    }

    fn ends(&self) -> [f32; 2] {
        [self.lows.into_iter().fold(f32::INFINITY, f32::min), self.highs.into_iter().fold(f32::NEG_INFINITY, f32::max)]
    }
}

/// Least and greatest value of each brick of a volume.
pub(super) struct BrickRanges {
    counts: [usize; 3],
    ranges: Vec<[f32; 2]>,
}

impl BrickRanges {
    pub(crate) fn of(size: [usize; 3]) -> Self {
        let counts = size.map(|n| n.div_ceil(BRICK));
        Self { counts, ranges: vec![[f32::NAN; 2]; counts.iter().product()] }
    }

    /// Takes in the ranges of some bricks; those without a value stay NaN.
    pub(crate) fn take(&mut self, found: IndexedRanges) {
        for (brick, [low, high]) in found.into_iter().filter(|(_, [low, high])| low <= high) {
            self.ranges[brick] = [low, high];
        }
    }

    pub(crate) fn write(&self, group: &Path, level: usize) -> Result<(), StoreError> {
        let [x, y, z] = self.counts;
        let layout = ArrayLayout::whole(&[x, y, z, 2], &["brick_inline", "brick_crossline", "brick_sample", "minmax"]);
        let values = self.ranges.as_flattened();
        write_array(group, &format!("minmax/{level}"), layout, f32::NAN, values, &Progress::silent())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ranges_pass_over_nan_and_dead_traces() {
        // Two bricks along z, the second of 6 samples; the last crossline is dead.
        let size = [2, 3, 70];
        let mut values = vec![1.0f32; 2 * 3 * 70];
        values[3] = -5.0;
        values[10] = f32::NAN;
        values[69] = 9.0;
        values[2 * 70 + 5] = 1000.0;
        let mask = [true, true, false, true, true, false];
        let found = SampleBox { values: &values, first: [0; 3], size }.ranges([0; 3], size, &mask, size);
        assert_eq!(found, [(0, [-5.0, 1.0]), (1, [1.0, 9.0])]);
        let dead = SampleBox { values: &values, first: [0; 3], size }.ranges([0; 3], size, &[false; 6], size);
        let mut all = BrickRanges::of(size);
        all.take(dead);
        assert!(all.ranges.as_flattened().iter().all(|v| v.is_nan()));
    }
}
