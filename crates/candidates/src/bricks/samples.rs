//! Exact quantiles of samples that do not fit into memory.
//!
//! Samples are stored by every brick, each with its class. Whoever wants the value at a rank counts them twice: first by
//! the upper 16 bits of their order, then, among those with the same upper bits as the value, by the lower 16. Counts of
//! bricks add up, so neither the bricks nor their order matter.

use super::Bricks;
use crate::error::InterpError;
use std::collections::BTreeMap;

/// A sample: its class, and its place in the order of all numbers.
type Record = [u32; 2];

/// Records read at a time.
const TOGETHER: usize = 1 << 16;

/// Samples of a brick, before they are stored.
#[derive(Default)]
pub(crate) struct Samples(Vec<Record>);

impl Samples {
    pub(crate) fn push(&mut self, class: usize, value: f32) {
        self.0.push([class as u32, order(value)]);
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

/// Counts of one class by 16 bits of the order.
type Histogram = Vec<u64>;

impl Bricks<'_> {
    pub(crate) fn keep_samples(&self, array: &str, brick: usize, samples: &Samples) -> Result<(), InterpError> {
        self.write(array, brick, &samples.0)
    }

    /// The values at ranks of each class, ascending from 0. `ranks` tells, for a class with so many samples, which ones
    /// are wanted; the result has, for each class that has samples, their count and the values.
    pub(crate) fn at_ranks(
        &self,
        array: &str,
        ranks: impl Fn(usize) -> Vec<usize>,
    ) -> Result<BTreeMap<u32, (usize, Vec<f32>)>, InterpError> {
        let mut upper: BTreeMap<u32, Histogram> = BTreeMap::new();
        self.each_sample(array, |[class, order]| {
            upper.entry(class).or_insert_with(|| vec![0; 1 << 16])[(order >> 16) as usize] += 1;
        })?;
        // For each class and rank: the upper bits, and the rank among the samples that share them.
        let mut wanted: BTreeMap<u32, (usize, Vec<(u32, u64)>)> = BTreeMap::new();
        let mut lower: BTreeMap<(u32, u32), Histogram> = BTreeMap::new();
        for (&class, counts) in &upper {
            let count = counts.iter().sum::<u64>() as usize;
            let places: Vec<(u32, u64)> =
                ranks(count).into_iter().filter(|&rank| rank < count).map(|rank| find(counts, rank as u64)).collect();
            for &(bits, _) in &places {
                lower.insert((class, bits), vec![0; 1 << 16]);
            }
            wanted.insert(class, (count, places));
        }
        drop(upper);
        self.each_sample(array, |[class, order]| {
            if let Some(counts) = lower.get_mut(&(class, order >> 16)) {
                counts[(order & 0xffff) as usize] += 1;
            }
        })?;
        let value = |class: u32, (bits, rank): (u32, u64)| number(bits << 16 | find(&lower[&(class, bits)], rank).0);
        let found = wanted.into_iter().map(|(class, (count, places))| {
            (class, (count, places.into_iter().map(|place| value(class, place)).collect()))
        });
        Ok(found.collect())
    }

    fn each_sample(&self, array: &str, mut found: impl FnMut(Record)) -> Result<(), InterpError> {
        let mut room: Vec<Record> = Vec::new();
        for brick in 0..self.tiles.count() {
            let count = self.count::<Record>(array, brick)?;
            for first in (0..count).step_by(TOGETHER) {
                room.resize(TOGETHER.min(count - first), [0; 2]);
                self.read_at(array, brick, first, &mut room)?;
                room.iter().copied().for_each(&mut found);
            }
        }
        Ok(())
    }
}

/// The place of the sample at a rank, and its rank among those of that place.
fn find(counts: &[u64], mut rank: u64) -> (u32, u64) {
    for (place, &count) in counts.iter().enumerate() {
        if rank < count {
            return (place as u32, rank);
        }
        rank -= count;
    }
    (counts.len() as u32 - 1, 0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_keep_their_order() {
        let mut values = [0.0, -0.0, 1.5, -3.0, f32::MAX, f32::MIN, f32::MIN_POSITIVE, f32::INFINITY, 2.0];
        values.sort_unstable_by(f32::total_cmp);
        assert!(values.is_sorted_by_key(|&value| order(value)));
        assert!(values.iter().all(|&value| number(order(value)).to_bits() == value.to_bits()));
    }

    #[test]
    fn a_rank_is_found_among_counts() {
        assert_eq!(find(&[0, 2, 0, 3], 0), (1, 0));
        assert_eq!(find(&[0, 2, 0, 3], 1), (1, 1));
        assert_eq!(find(&[0, 2, 0, 3], 4), (3, 2));
    }
}
