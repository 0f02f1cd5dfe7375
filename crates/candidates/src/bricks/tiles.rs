//! The division of a survey's traces into bricks.
//!
//! A brick is a rectangle of traces with all their samples: extrema, side lobes and runs of extrema are found along
//! whole traces. What a stage needs of the traces around a brick is its *halo*. Space: indices of inlines and
//! crosslines.

use std::ops::Range;

/// A rectangle of traces.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct Area {
    pub(crate) x: Range<usize>,
    pub(crate) y: Range<usize>,
}

impl Area {
    /// Count of traces.
    pub(crate) fn traces(&self) -> usize {
        self.x.len() * self.y.len()
    }

    pub(crate) fn contains(&self, x: usize, y: usize) -> bool {
        self.x.contains(&x) && self.y.contains(&y)
    }
}

/// How many traces a stage needs before and behind a brick, along x and along y.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Halo {
    pub(crate) before: [usize; 2],
    pub(crate) behind: [usize; 2],
}

impl Halo {
    pub(crate) fn around(traces: usize) -> Self {
        Self { before: [traces; 2], behind: [traces; 2] }
    }

    pub(crate) fn behind(traces: usize) -> Self {
        Self { before: [0; 2], behind: [traces; 2] }
    }
}

/// The bricks of a survey, numbered along y first.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct Tiling {
    /// Inlines and crosslines.
    pub(crate) size: [usize; 2],
    /// Traces of a brick along x and y; the last ones may have fewer.
    pub(crate) edge: [usize; 2],
}

impl Tiling {
    /// Bricks along x and y.
    pub(crate) fn counts(&self) -> [usize; 2] {
        [0, 1].map(|axis| self.size[axis].div_ceil(self.edge[axis]))
    }

    pub(crate) fn count(&self) -> usize {
        self.counts().iter().product()
    }

    /// The traces of a brick.
    pub(crate) fn area(&self, brick: usize) -> Area {
        let along_y = self.counts()[1];
        let span = |at: usize, axis: usize| at * self.edge[axis]..((at + 1) * self.edge[axis]).min(self.size[axis]);
        Area { x: span(brick / along_y, 0), y: span(brick % along_y, 1) }
    }

    /// The brick that holds a trace.
    pub(crate) fn brick_of(&self, x: usize, y: usize) -> usize {
        x / self.edge[0] * self.counts()[1] + y / self.edge[1]
    }

    /// An area with what lies around it; it begins at even lines, so that cells of two traces are whole.
    pub(crate) fn with_halo(&self, area: &Area, halo: Halo) -> Area {
        let span = |range: &Range<usize>, axis: usize| {
            let start = range.start.saturating_sub(halo.before[axis]);
            start - start % 2..(range.end + halo.behind[axis]).min(self.size[axis])
        };
        Area { x: span(&area.x, 0), y: span(&area.y, 1) }
    }

    /// The units of `edge` traces whose first trace lies in an area, along each axis.
    pub(crate) fn units(area: &Area, edge: [usize; 2]) -> [Range<usize>; 2] {
        [&area.x, &area.y]
            .map(|range| range.clone())
            .into_iter()
            .zip(edge)
            .map(|(range, edge)| range.start.div_ceil(edge)..range.end.div_ceil(edge))
            .collect::<Vec<_>>()
            .try_into()
            .expect("two axes")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_trace_and_every_unit_is_in_one_brick() {
        for edge in [[1, 1], [3, 5], [7, 64], [100, 100]] {
            let tiles = Tiling { size: [23, 41], edge };
            let mut seen = vec![0; 23 * 41];
            let mut units = [[0; 6]; 3];
            for brick in 0..tiles.count() {
                let area = tiles.area(brick);
                for (x, y) in area.x.clone().flat_map(|x| area.y.clone().map(move |y| (x, y))) {
                    assert_eq!(tiles.brick_of(x, y), brick);
                    seen[x * 41 + y] += 1;
                }
                let [x, y] = Tiling::units(&area, [8, 8]);
                x.for_each(|x| y.clone().for_each(|y| units[x][y] += 1));
            }
            assert!(seen.iter().all(|&count| count == 1), "{edge:?}");
            assert!(units.as_flattened().iter().all(|&count| count == 1), "{edge:?}: {units:?}");
        }
    }
}
