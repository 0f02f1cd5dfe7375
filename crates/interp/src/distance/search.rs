//! The search down the columns of a block.

use super::index::{BRICK, CellIndex, INTERVAL, TriangleBins};
use super::triangle::{CellTriangle, FromColumn, LANES, greater};
use super::{BEYOND, BlockRows, DistanceSettings};
use crate::forest::Forest;
use std::ops::Range;

/// Samples that are searched together: an interval of the index.
const RUN: usize = INTERVAL;

/// Added to bounds, so that rounding never excludes what is closest. Voxels.
const SLACK: f32 = 1e-3;

/// Computes the block `x`, `y` into its lines.
pub(super) fn block(
    forest: &Forest,
    bins: &TriangleBins,
    settings: &DistanceSettings,
    x: Range<usize>,
    y: Range<usize>,
    rows: &mut BlockRows<'_>,
) {
    let [nx, ny, nz] = forest.surfaces.size;
    let reach = settings.max_distance.ceil() as usize + 1;
    // The last trace begins no cell, but is a column like any other.
    let around = |range: &Range<usize>, count: usize| range.start.saturating_sub(reach)..(range.end + reach).min(count);
    let index = CellIndex::new(forest, bins, around(&x, nx), around(&y, ny));
    let mut column = Column::new(&index, settings.max_distance, nz);
    for (row, line) in rows.iter_mut().zip(x) {
        for (n, crossline) in y.clone().enumerate() {
            column.search(line, crossline, if n == 0 { Neighbour::None } else { Neighbour::Before });
            let at = n * nz..(n + 1) * nz;
            column.write(settings, &mut row.0[at.clone()], &mut row.1[at]);
        }
    }
}

/// What was searched before a column.
#[derive(Clone, Copy)]
enum Neighbour {
    /// Nothing near.
    None,
    /// The column next to it.
    Before,
}

/// Where triangles are tested.
struct Place {
    column: [usize; 2],
    cell: [usize; 2],
    /// Squared horizontal distance of the two.
    h_sq: f32,
    run: usize,
    /// The interval of depth that the triangles stand in, and the first that is visited for this run.
    interval: usize,
    top: usize,
}

/// Horizontal distance, along one axis, of a column to the `count` cells from `unit · count`.
fn apart(at: usize, unit: usize, count: usize) -> f32 {
    (unit * count).saturating_sub(at).max(at.saturating_sub((unit + 1) * count)) as f32
}

/// A column at work. Arrays are filled up to whole runs.
struct Column<'a> {
    index: &'a CellIndex,
    max: f32,
    count: usize,
    /// Squared distance and leaf of the closest so far; the bound and all ones before any.
    best_sq: Vec<f32>,
    leaf: Vec<u32>,
    /// A distance that the closest triangle is not beyond.
    bound: Vec<f32>,
}

impl<'a> Column<'a> {
    fn new(index: &'a CellIndex, max: f32, count: usize) -> Self {
        let padded = count.div_ceil(RUN) * RUN;
        Self {
            index,
            max,
            count,
            best_sq: vec![max * max; padded],
            leaf: vec![u32::MAX; padded],
            bound: vec![max; padded],
        }
    }

    /// Finds the closest leaf of every sample of the column (x, y). `neighbour` says what was searched before.
    fn search(&mut self, x: usize, y: usize, neighbour: Neighbour) {
        for (bound, best_sq) in self.bound.iter_mut().zip(&self.best_sq) {
            *bound = match neighbour {
                Neighbour::None => self.max,
                Neighbour::Before => best_sq.sqrt() + 1.0,
            };
        }
        self.bound_by_extrema(x, y);
        for (best_sq, bound) in self.best_sq.iter_mut().zip(&self.bound) {
            let bound = (bound + SLACK).min(self.max);
            *best_sq = bound * bound;
        }
        self.leaf.fill(u32::MAX);
        for run in 0..self.best_sq.len() / RUN {
            let reach = self.reach(run);
            for cell_x in x.saturating_sub(1)..x + 1 {
                for cell_y in y.saturating_sub(1)..y + 1 {
                    self.visit_cell([x, y], [cell_x, cell_y], run, reach);
                }
            }
            let reach = self.reach(run);
            if reach >= 1.0 {
                self.visit_bricks([x, y], run, reach);
            }
        }
    }

    /// How far the closest triangle of any sample of a run can be.
    fn reach(&self, run: usize) -> f32 {
        let most_sq = self.best_sq[run * RUN..(run + 1) * RUN].iter().fold(0.0f32, |most, sq| most.max(*sq));
        most_sq.sqrt() + SLACK
    }

    /// Bounds by the triangles' corners on this very trace, and by samples above and below.
    fn bound_by_extrema(&mut self, x: usize, y: usize) {
        for (cell_x, far_x) in [(x, 0), (x.wrapping_sub(1), 1)] {
            for (cell_y, far_y) in [(y, 0), (y.wrapping_sub(1), 1)] {
                if cell_x == usize::MAX || cell_y == usize::MAX {
                    continue;
                }
                for interval in 0..self.index.counts[2] {
                    for triangle in self.index.in_cell(cell_x, cell_y, interval) {
                        if let Some(z) = triangle.z_at([far_x, far_y]) {
                            let above = (z as usize).min(self.bound.len() - 1);
                            let below = (above + 1).min(self.bound.len() - 1);
                            for sample in [above, below] {
                                let bound = &mut self.bound[sample];
                                *bound = bound.min((z - sample as f32).abs());
                            }
                        }
                    }
                }
            }
        }
        for n in 1..self.bound.len() {
            self.bound[n] = self.bound[n].min(self.bound[n - 1] + 1.0);
        }
        for n in (1..self.bound.len()).rev() {
            self.bound[n - 1] = self.bound[n - 1].min(self.bound[n] + 1.0);
        }
    }

    /// Visits the cells that `reach` reaches but for the four around the column.
    fn visit_bricks(&mut self, [x, y]: [usize; 2], run: usize, reach: f32) {
        let index = self.index;
        let [bricks_x, bricks_y] = index.bricks_within([x, y], reach as usize + 1);
        let (top, reach_sq) = ((run * RUN) as f32, reach * reach);
        for brick_x in bricks_x {
            let h_x = apart(x, brick_x, BRICK);
            for brick_y in bricks_y.clone() {
                let h_y = apart(y, brick_y, BRICK);
                let h_sq = h_x * h_x + h_y * h_y;
                let intervals = self.intervals(run, reach, h_sq);
                for interval in intervals.clone() {
                    let brick = index.brick(brick_x, brick_y, interval);
                    let Some([high, low]) = brick.z_range else { continue };
                    if !may_be_closer(&self.best_sq.as_chunks::<RUN>().0[run], h_sq, [high - top, low - top]) {
                        continue;
                    }
                    for n in 0..BRICK * BRICK {
                        let cell = [brick_x * BRICK + n / BRICK, brick_y * BRICK + n % BRICK];
                        let h = [apart(x, cell[0], 1), apart(y, cell[1], 1)];
                        let h_sq = h[0] * h[0] + h[1] * h[1];
                        if h_sq > 0.0 && h_sq <= reach_sq {
                            let place = Place { column: [x, y], cell, h_sq, run, top: intervals.start, interval };
                            self.test(&place, brick.in_cell(n));
                        }
                    }
                }
            }
        }
    }

    /// Intervals of depth within reach of a run, at a horizontal distance.
    fn intervals(&self, run: usize, reach: f32, h_sq: f32) -> Range<usize> {
        let left = reach * reach - h_sq;
        if left < 0.0 {
            return 0..0;
        }
        let (down, top) = (left.sqrt(), (run * RUN) as f32);
        self.index.interval(top - down)..self.index.interval(top + (RUN - 1) as f32 + down) + 1
    }

    /// Tests the triangles of one of the four cells around the column against a run.
    fn visit_cell(&mut self, column: [usize; 2], cell: [usize; 2], run: usize, reach: f32) {
        let index = self.index;
        let intervals = self.intervals(run, reach, 0.0);
        for interval in intervals.clone() {
            let place = Place { column, cell, h_sq: 0.0, run, top: intervals.start, interval };
            self.test(&place, index.in_cell(cell[0], cell[1], interval));
        }
    }

    /// Tests triangles of a cell against a run.
    fn test(&mut self, place: &Place, triangles: &[CellTriangle]) {
        let [dx, dy] = [0, 1].map(|axis| place.column[axis] as f32 - place.cell[axis] as f32);
        let top = (place.run * RUN) as f32;
        let best_sq = &mut self.best_sq.as_chunks_mut::<RUN>().0[place.run];
        let leaves = &mut self.leaf.as_chunks_mut::<RUN>().0[place.run];
        for triangle in triangles {
            let [high, low] = triangle.z_range();
            if !may_be_closer(best_sq, place.h_sq, [high - top, low - top]) {
                continue;
            }
            // One that stands in several intervals is taken in the first that is visited.
            if place.interval > place.top && self.index.interval(high) < place.interval {
                continue;
            }
            let seen = FromColumn::new(triangle, dx, dy);
            let groups = best_sq.as_chunks_mut::<LANES>().0.iter_mut().zip(leaves.as_chunks_mut::<LANES>().0);
            for (group, (best_sq, leaves)) in groups.enumerate() {
                let first = top + (group * LANES) as f32;
                if may_be_closer(best_sq, place.h_sq, [high - first, low - first]) {
                    keep_closest(best_sq, leaves, seen.distances_sq(first), triangle.leaf());
                }
            }
        }
    }

    /// Writes the column down.
    fn write(&self, settings: &DistanceSettings, distance: &mut [u8], leaf: &mut [u32]) {
        for n in 0..self.count {
            let found = self.leaf[n] != u32::MAX;
            leaf[n] = if found { self.leaf[n] } else { 0 };
            distance[n] = if found { settings.encode(self.best_sq[n].sqrt().min(self.max)) } else { BEYOND };
        }
    }
}

/// Whether a triangle `h` away horizontally and from `high` to `low` below the first sample could be closer to one of the samples.
#[inline(always)]
fn may_be_closer<const N: usize>(best_sq: &[f32; N], h_sq: f32, [high, low]: [f32; 2]) -> bool {
    let mut may = false;
    for (n, best_sq) in best_sq.iter().enumerate() {
        let gap = greater(greater(high - n as f32, n as f32 - low), 0.0);
        may |= h_sq + gap * gap <= *best_sq;
    }
    may
}

/// Takes over what is closer; of equals the lesser leaf.
#[inline(always)]
fn keep_closest(best_sq: &mut [f32; LANES], leaves: &mut [u32; LANES], found: [f32; LANES], leaf: u32) {
    for lane in 0..LANES {
        let closer = found[lane] < best_sq[lane] || (found[lane] == best_sq[lane] && leaf < leaves[lane]);
        best_sq[lane] = if closer { found[lane] } else { best_sq[lane] };
        leaves[lane] = if closer { leaf } else { leaves[lane] };
    }
}
