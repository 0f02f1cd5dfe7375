//! Exact quantiles of samples that do not fit into memory.
//!
//! Every brick stores its samples in their order, class by class, and beside them where each class begins and every
//! 256th sample of it. Whoever wants the value at a rank reads these marks of all bricks. They bound the value from
//! below and above, so that of each brick a few hundred samples around it are read, and counted exactly. So neither the
//! bricks nor their order matter, and little is read where a survey has many.

use super::Bricks;
use crate::error::InterpError;
use std::collections::BTreeMap;
use std::ops::Range;

/// Samples from a mark to the next.
const STRIDE: usize = 256;

/// Samples of a brick, before they are stored: the class, and below it the place in the order of all numbers.
#[derive(Default)]
pub(crate) struct Samples(Vec<u64>);

impl Samples {
    pub(crate) fn push(&mut self, class: usize, value: f32) {
        self.0.push((class as u64) << 32 | u64::from(order(value)));
    }
}

/// The place of a number in the order of [`f32::total_cmp`], and back.
fn order(value: f32) -> u32 {
    let bits = value.to_bits();
    if bits >> 31 == 1 { !bits } else { bits | 1 << 31 }
}

fn number(order: u32) -> f32 {
    f32::from_bits(if order >> 31 == 1 { order & !(1 << 31) } else { !order })
}

/// The samples of a class in a brick: where they are, and every 256th of them.
struct Run {
    brick: usize,
    first: usize,
    end: usize,
    marks: Vec<u32>,
}

impl Run {
    /// The places of samples with all those above `low` and below `high`; all before them are at most `low`, and all behind
    /// them at least `high`.
    fn between(&self, low: u32, high: u32) -> Range<usize> {
        let place = |mark: usize| (self.first + mark * STRIDE).min(self.end);
        let from = place(self.marks.partition_point(|&mark| mark <= low).saturating_sub(1));
        from..place(self.marks.partition_point(|&mark| mark < high)).max(from)
    }
}

impl Bricks<'_> {
    pub(crate) fn keep_samples(&self, array: &str, brick: usize, mut samples: Samples) -> Result<(), InterpError> {
        samples.0.sort_unstable();
        let mut marks: Vec<u32> = Vec::new();
        for class in samples.0.chunk_by(|a, b| a >> 32 == b >> 32) {
            marks.extend([(class[0] >> 32) as u32, class.len() as u32]);
            marks.extend(class.iter().step_by(STRIDE).map(|&sample| sample as u32));
        }
        let orders: Vec<u32> = samples.0.iter().map(|&sample| sample as u32).collect();
        self.write(&marks_of(array), brick, &marks)?;
        self.write(array, brick, &orders)
    }

    /// The values at ranks of each class, ascending from 0. `ranks` tells, for a class with so many samples, which ones
    /// are wanted; the result has, for each class that has samples, their count and the values.
    pub(crate) fn at_ranks(
        &self,
        array: &str,
        ranks: impl Fn(usize) -> Vec<usize>,
    ) -> Result<BTreeMap<u32, (usize, Vec<f32>)>, InterpError> {
        let mut classes: BTreeMap<u32, Vec<Run>> = BTreeMap::new();
        for brick in 0..self.tiles.count() {
            let marks: Vec<u32> = self.read(&marks_of(array), brick)?;
            let (mut rest, mut first) = (marks.as_slice(), 0);
            while let [class, count, more @ ..] = rest {
                let end = first + *count as usize;
                let damaged = || InterpError::DamagedArray { array: marks_of(array) };
                let (own, next) = more.split_at_checked((*count as usize).div_ceil(STRIDE)).ok_or_else(damaged)?;
                classes.entry(*class).or_default().push(Run { brick, first, end, marks: own.to_vec() });
                (rest, first) = (next, end);
            }
        }
        let mut found = BTreeMap::new();
        for (class, runs) in classes {
            let count = runs.iter().map(|run| run.end - run.first).sum();
            let mut marks: Vec<u32> = runs.iter().flat_map(|run| run.marks.iter().copied()).collect();
            marks.sort_unstable();
            let mut values = Vec::new();
            for rank in ranks(count).into_iter().filter(|&rank| rank < count) {
                values.push(number(self.at_rank(array, &runs, &marks, rank)?));
            }
            found.insert(class, (count, values));
        }
        Ok(found)
    }

    /// The sample of a class at a rank; `marks` are those of all bricks in their order.
    fn at_rank(&self, array: &str, runs: &[Run], marks: &[u32], rank: usize) -> Result<u32, InterpError> {
        // At most 256 samples for each mark below it are less than a mark, and at least 256 for each mark up to it, but 255
        // in each brick, are not greater. So the sample is not less than `low` and not greater than `high`.
        let low = marks[(rank / STRIDE).min(marks.len() - 1)];
        let enough = (rank + 1 + runs.len() * (STRIDE - 1)).div_ceil(STRIDE);
        let high = marks.get(enough - 1).copied().unwrap_or(u32::MAX);
        let (mut near, mut before): (Vec<u32>, usize) = (Vec::new(), 0);
        for run in runs {
            let places = run.between(low, high);
            let reached = near.len();
            near.resize(reached + places.len(), 0);
            self.read_at(array, run.brick, places.start, &mut near[reached..])?;
            before += places.start - run.first;
        }
        // Where many samples are equal they are not read.
        let found = match rank.checked_sub(before) {
            None => low,
            Some(at) if at < near.len() => *near.select_nth_unstable(at).1,
            Some(_) => high,
        };
        Ok(found.clamp(low, high))
    }
}

/// The array of the marks.
fn marks_of(array: &str) -> String {
    format!("marks-{array}")
}

#[cfg(test)]
mod tests {
    use super::super::tests::Held;
    use super::super::{BrickSettings, Bricks};
    use super::*;
    use crate::ExtractSettings;
    use survey::Volume;

    #[test]
    fn numbers_keep_their_order() {
        let mut values = [0.0, -0.0, 1.5, -3.0, f32::MAX, f32::MIN, f32::MIN_POSITIVE, f32::INFINITY, 2.0];
        values.sort_unstable_by(f32::total_cmp);
        assert!(values.is_sorted_by_key(|&value| order(value)));
        assert!(values.iter().all(|&value| number(order(value)).to_bits() == value.to_bits()));
    }

    #[test]
    fn values_at_ranks_are_those_of_all_samples_in_order() {
        let volume = Volume::filled([4, 5, 8], 0.0f32);
        let mut state = 9u32;
        let mut random = move |below: u32| {
            state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            (state >> 8) % below
        };
        // Many different values, and few; bricks with many samples, with one and with none.
        for distinct in [1 << 20, 7, 1] {
            let held = Held::default();
            let cut = BrickSettings { edge: [1, 2], triangles_together: 1, workers: 1 };
            let bricks = Bricks::new(&volume, &held, &ExtractSettings::default(), &cut).unwrap();
            let mut all: BTreeMap<u32, Vec<f32>> = BTreeMap::new();
            for brick in 0..bricks.tiles.count() {
                let mut samples = Samples::default();
                for _ in 0..[0, 1, 255, 256, 257, 3000][brick % 6] {
                    let (class, value) = (random(3), random(distinct) as f32 - 3.0);
                    samples.push(class as usize, value);
                    all.entry(class).or_default().push(value);
                }
                bricks.keep_samples("s", brick, samples).unwrap();
            }
            let ranks = |count: usize| vec![0, 1, count / 4, count / 2, count - 2, count - 1, count];
            let found = bricks.at_ranks("s", ranks).unwrap();
            assert_eq!(found.len(), 3);
            for (class, mut values) in all {
                values.sort_unstable_by(f32::total_cmp);
                let wanted = ranks(values.len()).into_iter().filter_map(|rank| values.get(rank).copied()).collect();
                assert_eq!(found[&class], (values.len(), wanted), "{distinct} {class}");
            }
        }
    }
}
