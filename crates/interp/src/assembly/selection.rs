//! A set of triangles as sorted, disjoint ranges. Nodes of trees are ranges, so a few ranges describe a
//! horizon.

use std::ops::Range;

/// A set of triangles of a forest.
///
/// ```
/// use interp::assembly::Selection;
///
/// let mut selection = Selection::default();
/// selection.insert(0..10);
/// selection.insert(20..30);
/// selection.remove(&(5..25));
/// assert_eq!(selection.ranges(), [0..5, 25..30]);
/// assert!(selection.contains(4) && !selection.contains(5));
/// ```
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Selection {
    /// Sorted, disjoint, not touching one another, none empty.
    ranges: Vec<Range<u32>>,
}

impl Selection {
    /// Adds a range of triangles.
    pub fn insert(&mut self, range: Range<u32>) {
        if range.is_empty() {
            return;
        }
        // Everything that overlaps or touches the new range is joined with it.
        let first = self.ranges.partition_point(|r| r.end < range.start);
        let last = self.ranges.partition_point(|r| r.start <= range.end);
        let (mut start, mut end) = (range.start, range.end);
        if first < last {
            start = start.min(self.ranges[first].start);
            end = end.max(self.ranges[last - 1].end);
        }
        self.ranges.splice(first..last, std::iter::once(start..end));
    }

    /// Removes a range of triangles.
    pub fn remove(&mut self, range: &Range<u32>) {
        if range.is_empty() {
            return;
        }
        let cut = |r: &Range<u32>| {
            let before = r.start..r.end.min(range.start);
            let after = r.start.max(range.end)..r.end;
            if r.end <= range.start || r.start >= range.end { [r.clone(), 0..0] } else { [before, after] }
        };
        self.ranges = self.ranges.iter().flat_map(cut).filter(|r| !r.is_empty()).collect();
    }

    /// Whether the set contains a triangle.
    pub fn contains(&self, triangle: u32) -> bool {
        let after = self.ranges.partition_point(|r| r.end <= triangle);
        self.ranges.get(after).is_some_and(|r| r.start <= triangle)
    }

    /// The ranges, ascending.
    pub fn ranges(&self) -> &[Range<u32>] {
        &self.ranges
    }

    /// All triangles, ascending.
    pub fn iter(&self) -> impl Iterator<Item = u32> + '_ {
        self.ranges.iter().cloned().flatten()
    }

    /// Count of triangles.
    pub fn len(&self) -> usize {
        self.ranges.iter().map(ExactSizeIterator::len).sum()
    }

    /// Whether the set is empty.
    pub fn is_empty(&self) -> bool {
        self.ranges.is_empty()
    }

    /// The triangles that are in both sets.
    pub fn intersection(&self, other: &Self) -> Self {
        let mut shared = Self::default();
        for range in &self.ranges {
            let first = other.ranges.partition_point(|r| r.end <= range.start);
            for r in other.ranges[first..].iter().take_while(|r| r.start < range.end) {
                shared.insert(r.start.max(range.start)..r.end.min(range.end));
            }
        }
        shared
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Against a set of single numbers, over a fixed sequence of pseudo-random ranges.
    #[test]
    fn ranges_behave_as_a_set_of_numbers() {
        let (mut ranges, mut other) = (Selection::default(), Selection::default());
        let (mut numbers, mut others) = (std::collections::BTreeSet::new(), std::collections::BTreeSet::new());
        let mut state = 7u32;
        let mut draw = |n: u32| {
            state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            (state >> 16) % n
        };
        for _ in 0..400 {
            let start = draw(100);
            let range = start..start + draw(12);
            match draw(3) {
                0 => {
                    ranges.remove(&range);
                    numbers.retain(|n| !range.contains(n));
                }
                1 => {
                    ranges.insert(range.clone());
                    numbers.extend(range);
                }
                _ => {
                    if others.len() > 60 {
                        (other, others) = Default::default();
                    }
                    other.insert(range.clone());
                    others.extend(range);
                }
            }
            assert!(ranges.iter().eq(numbers.iter().copied()));
            assert_eq!(ranges.len(), numbers.len());
            assert!((0..115).all(|n| ranges.contains(n) == numbers.contains(&n)));
            assert!(ranges.intersection(&other).iter().eq(numbers.intersection(&others).copied()));
            assert!(ranges.ranges().windows(2).all(|r| r[0].end < r[1].start));
        }
    }
}
