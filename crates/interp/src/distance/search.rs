//! The search down the columns of a block.

use super::index::{BRICK, CellIndex, INTERVAL, TriangleBins};
use super::triangle::{CellTriangle, FromColumn, LANES};
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
                    self.visit_cell([x, y], [cell_x, cell_y], 0.0, run, reach);
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
        let [cells_x, cells_y] = self.index.cells();
        let within = |at: usize, cells: &Range<usize>| {
            let first = at.saturating_sub(reach as usize + 1).max(cells.start);
            first..(at + reach as usize + 1).min(cells.end)
        };
        let (xs, ys) = (within(x, &cells_x), within(y, &cells_y));
        let apart =
            |at: usize, first: usize, last: usize| first.saturating_sub(at).max(at.saturating_sub(last + 1)) as f32;
        let mut brick_x = xs.start / BRICK * BRICK;
        while brick_x < xs.end {
            let mut brick_y = ys.start / BRICK * BRICK;
            while brick_y < ys.end {
                let h = [apart(x, brick_x, brick_x + BRICK - 1), apart(y, brick_y, brick_y + BRICK - 1)];
                let intervals = self.intervals(run, reach, h[0] * h[0] + h[1] * h[1]);
                let empty = intervals.clone().all(|n| self.index.is_brick_empty(brick_x, brick_y, n));
                if !intervals.is_empty() && !empty {
                    for cell_x in brick_x.max(xs.start)..(brick_x + BRICK).min(xs.end) {
                        let h_x = apart(x, cell_x, cell_x);
                        for cell_y in brick_y.max(ys.start)..(brick_y + BRICK).min(ys.end) {
                            let h_y = apart(y, cell_y, cell_y);
                            let h_sq = h_x * h_x + h_y * h_y;
                            if h_sq > 0.0 {
                                self.visit_cell([x, y], [cell_x, cell_y], h_sq, run, reach);
                            }
                        }
                    }
                }
                brick_y += BRICK;
            }
            brick_x += BRICK;
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

    /// Tests the triangles of a cell against a run.
    fn visit_cell(&mut self, [x, y]: [usize; 2], cell: [usize; 2], h_sq: f32, run: usize, reach: f32) {
        let index = self.index;
        let (top, bottom) = ((run * RUN) as f32, (run * RUN + RUN - 1) as f32);
        let [dx, dy] = [x as f32 - cell[0] as f32, y as f32 - cell[1] as f32];
        let intervals = self.intervals(run, reach, h_sq);
        for interval in intervals.clone() {
            for triangle in index.in_cell(cell[0], cell[1], interval) {
                let [high, low] = triangle.z_range();
                let gap = (high - bottom).max(top - low).max(0.0);
                if h_sq + gap * gap > reach * reach {
                    continue;
                }
                // One that stands in several intervals is taken in the first that is visited.
                if interval > intervals.start && index.interval(high) < interval {
                    continue;
                }
                self.test(triangle, dx, dy, h_sq, run);
            }
        }
    }

    /// Tests one triangle against a run, several samples at once.
    fn test(&mut self, triangle: &CellTriangle, dx: f32, dy: f32, h_sq: f32, run: usize) {
        let [high, low] = triangle.z_range();
        let seen = FromColumn::new(triangle, dx, dy);
        let leaf = triangle.leaf();
        for first in (run * RUN..(run + 1) * RUN).step_by(LANES) {
            let (top, bottom) = (first as f32, (first + LANES - 1) as f32);
            let gap = (high - bottom).max(top - low).max(0.0);
            let lanes = first..first + LANES;
            let (best_sq, leaves) = (&mut self.best_sq[lanes.clone()], &mut self.leaf[lanes]);
            let reach_sq = best_sq.iter().fold(0.0f32, |most, sq| most.max(*sq));
            if h_sq + gap * gap > reach_sq {
                continue;
            }
            let found = seen.distances_sq(top);
            for lane in 0..LANES {
                let closer = found[lane] < best_sq[lane] || (found[lane] == best_sq[lane] && leaf < leaves[lane]);
                best_sq[lane] = if closer { found[lane] } else { best_sq[lane] };
                leaves[lane] = if closer { leaf } else { leaves[lane] };
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
