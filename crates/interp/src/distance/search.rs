//! The search down the columns of a block.
//!
//! Bounds are in three rings. The four cells *around* a column hold most answers: there a triangle is tested against the samples near its depth, and
//! against more as long as the bound does not exclude it (bounds of neighbouring samples differ by at most 1, so one sample beyond the
//! end speaks for all further ones). The twelve cells *next* to those are at least 1 away, so only samples z with a bound b > 1 can be closer to them: they
//! reach the depths z ± √(b² − h²), and running maxima and minima of these tell for any triangle whether one does. What is two or more away is asked
//! run by run, brick by brick, by the samples whose bound is beyond 2.

use super::index::{BRICK, CellIndex, INTERVAL, TriangleBins};
use super::triangle::{CellTriangle, FromColumn, LANES, greater, lesser};
use super::{BEYOND, BlockRows, DistanceSettings};
use crate::forest::Forest;
use crate::lanes::{Wide, widest};
use std::ops::Range;

/// Samples that are searched together: an interval of the index.
const RUN: usize = INTERVAL;

const _: () = assert!(RUN == LANES);

/// Added to bounds, so that rounding never excludes what is closest. Voxels.
const SLACK: f32 = 1e-3;

/// Where a block lies, and what is around it.
pub(super) struct Block<'a> {
    pub(super) forest: &'a Forest,
    pub(super) bins: &'a TriangleBins,
    pub(super) settings: &'a DistanceSettings,
    pub(super) x: Range<usize>,
    pub(super) y: Range<usize>,
}

/// Computes a block into its lines.
pub(super) fn block(block: Block<'_>, rows: &mut BlockRows<'_>) {
    let [nx, ny, _] = block.forest.surfaces.size;
    let reach = block.settings.max_distance.ceil() as usize + 1;
    // The last trace begins no cell, but is a column like any other.
    let around = |range: &Range<usize>, count: usize| range.start.saturating_sub(reach)..(range.end + reach).min(count);
    let index = CellIndex::new(block.forest, block.bins, around(&block.x, nx), around(&block.y, ny));
    widest(Columns { block, index: &index, rows });
}

/// The columns of a block.
struct Columns<'a, 'i, 'r, 'b> {
    block: Block<'a>,
    index: &'i CellIndex,
    rows: &'r mut BlockRows<'b>,
}

impl Wide for Columns<'_, '_, '_, '_> {
    #[inline(always)]
    fn run(self) {
        let Self { block: Block { forest, settings, x, y, .. }, index, rows } = self;
        let nz = forest.surfaces.size[2];
        let mut column = Column::new(index, settings.max_distance, nz);
        for (row, line) in rows.iter_mut().zip(x) {
            for (n, crossline) in y.clone().enumerate() {
                column.search([line, crossline], if n == 0 { Neighbour::None } else { Neighbour::Before });
                let at = n * nz..(n + 1) * nz;
                column.write(settings, &mut row.0[at.clone()], &mut row.1[at]);
            }
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
#[inline(always)]
fn apart(at: usize, unit: usize, count: usize) -> f32 {
    (unit * count).saturating_sub(at).max(at.saturating_sub((unit + 1) * count)) as f32
}

/// The last sample that is not below z; the first where all are.
#[inline(always)]
fn sample_above(z: f32) -> usize {
    (z as i32).max(0) as usize
}

/// What the samples of a column reach at a horizontal distance.
#[derive(Clone, Copy)]
struct Reached {
    /// Greatest depth that this sample or one above it reaches down to.
    down: f32,
    /// Least depth that this sample or one below it reaches up to.
    up: f32,
}

/// A column at work. Arrays are filled up to whole runs.
struct Column<'a> {
    index: &'a CellIndex,
    max: f32,
    count: usize,
    /// Squared distance and leaf of the closest so far; the bound and all ones before any.
    best_sq: Vec<f32>,
    leaf: Vec<u32>,
    /// A distance that the closest triangle is not beyond; differs by at most 1 from sample to sample.
    bound: Vec<f32>,
    /// What is reached one cell away along an axis, and along both; one entry more than samples, for "none below".
    reached: [Vec<Reached>; 2],
}

impl<'a> Column<'a> {
    fn new(index: &'a CellIndex, max: f32, count: usize) -> Self {
        let padded = count.div_ceil(RUN).max(1) * RUN;
        let nothing = Reached { down: f32::NEG_INFINITY, up: f32::INFINITY };
        Self {
            index,
            max,
            count,
            best_sq: vec![max * max; padded],
            leaf: vec![u32::MAX; padded],
            bound: vec![max; padded],
            reached: [vec![nothing; padded + 1], vec![nothing; padded + 1]],
        }
    }

    /// Finds the closest leaf of every sample of a column. `neighbour` says what was searched before.
    #[inline(always)]
    fn search(&mut self, column: [usize; 2], neighbour: Neighbour) {
        for (bound, best_sq) in self.bound.iter_mut().zip(&self.best_sq) {
            *bound = match neighbour {
                Neighbour::None => self.max,
                Neighbour::Before => best_sq.sqrt() + 1.0,
            };
        }
        self.bound_by_extrema(column);
        for (best_sq, bound) in self.best_sq.iter_mut().zip(&mut self.bound) {
            *bound = lesser(*bound + SLACK, self.max);
            *best_sq = *bound * *bound;
        }
        self.leaf.fill(u32::MAX);
        let [x, y] = column;
        for cell_x in x.saturating_sub(1)..x + 1 {
            for cell_y in y.saturating_sub(1)..y + 1 {
                self.visit_around(column, [cell_x, cell_y]);
            }
        }
        self.visit_next(column);
        for run in 0..self.best_sq.len() / RUN {
            let reach = self.reach(run);
            if reach >= 2.0 {
                self.visit_bricks(column, run, reach);
            }
        }
    }

    /// How far the closest triangle of any sample of a run can be.
    #[inline(always)]
    fn reach(&self, run: usize) -> f32 {
        let most_sq = self.best_sq[run * RUN..(run + 1) * RUN].iter().fold(0.0, |most, sq| greater(most, *sq));
        most_sq.sqrt() + SLACK
    }

    /// Bounds by the triangles' corners on this very trace, and by samples above and below.
    #[inline(always)]
    fn bound_by_extrema(&mut self, [x, y]: [usize; 2]) {
        let last = self.bound.len() - 1;
        for (cell_x, far_x) in [(x, 0), (x.wrapping_sub(1), 1)] {
            for (cell_y, far_y) in [(y, 0), (y.wrapping_sub(1), 1)] {
                for (_, triangles) in self.index.below(cell_x, cell_y) {
                    for triangle in triangles {
                        if let Some(z) = triangle.z_at([far_x, far_y]) {
                            let above = sample_above(z).min(last);
                            for sample in [above, (above + 1).min(last)] {
                                let bound = &mut self.bound[sample];
                                *bound = lesser((z - sample as f32).abs(), *bound);
                            }
                        }
                    }
                }
            }
        }
        let mut reached = f32::INFINITY;
        for bound in &mut self.bound {
            reached = lesser(*bound, reached + 1.0);
            *bound = reached;
        }
        for bound in self.bound.iter_mut().rev() {
            reached = lesser(*bound, reached + 1.0);
            *bound = reached;
        }
    }

    /// Tests the triangles of one of the four cells around the column.
    #[inline(always)]
    fn visit_around(&mut self, column: [usize; 2], cell: [usize; 2]) {
        let index = self.index;
        let [dx, dy] = [0, 1].map(|axis| (column[axis] - cell[axis]) as f32);
        let last = self.best_sq.len() - LANES;
        for (interval, triangles) in index.below(cell[0], cell[1]) {
            let top = if interval == 0 { f32::NEG_INFINITY } else { (interval * INTERVAL) as f32 };
            for triangle in triangles {
                let [high, low] = triangle.z_range();
                // One that stands in several intervals is taken in the first.
                if high < top {
                    continue;
                }
                let seen = FromColumn::new(triangle, dx, dy);
                let middle = sample_above(0.5 * (high + low)).saturating_sub(LANES / 2 - 1).min(last);
                self.keep_closest(&seen, middle, triangle.leaf());
                let mut first = middle;
                while first > 0 && high - (first - 1) as f32 <= self.bound[first - 1] {
                    first = first.saturating_sub(LANES);
                    self.keep_closest(&seen, first, triangle.leaf());
                }
                let mut end = middle + LANES;
                while end < self.count && end as f32 - low <= self.bound[end] {
                    self.keep_closest(&seen, end.min(last), triangle.leaf());
                    end += LANES;
                }
            }
        }
    }

    /// Tests the triangles of the twelve cells that are one away.
    #[inline(always)]
    fn visit_next(&mut self, column: [usize; 2]) {
        self.reach_out();
        let index = self.index;
        let [x, y] = column;
        let last = self.best_sq.len() - LANES;
        for cell_x in x.saturating_sub(2)..x + 2 {
            for cell_y in y.saturating_sub(2)..y + 2 {
                let ring =
                    usize::from(cell_x + 2 == x || cell_x == x + 1) + usize::from(cell_y + 2 == y || cell_y == y + 1);
                if ring == 0 {
                    continue;
                }
                let [dx, dy] = [x as f32 - cell_x as f32, y as f32 - cell_y as f32];
                for (interval, triangles) in index.below(cell_x, cell_y) {
                    let top = if interval == 0 { f32::NEG_INFINITY } else { (interval * INTERVAL) as f32 };
                    for triangle in triangles {
                        let [high, low] = triangle.z_range();
                        let reached = &self.reached[ring - 1];
                        let above = sample_above(low).min(last + LANES - 1);
                        let [from_above, from_below] = [reached[above].down >= high, reached[above + 1].up <= low];
                        if !(from_above | from_below) | (high < top) {
                            continue;
                        }
                        let seen = FromColumn::new(triangle, dx, dy);
                        let mut end = above + 1;
                        while end > 0 && self.reached[ring - 1][end - 1].down >= high {
                            let first = end.saturating_sub(LANES);
                            self.keep_closest(&seen, first, triangle.leaf());
                            end = first;
                        }
                        let mut first = above + 1;
                        while first < self.count && self.reached[ring - 1][first].up <= low {
                            self.keep_closest(&seen, first.min(last), triangle.leaf());
                            first += LANES;
                        }
                    }
                }
            }
        }
    }

    /// Brings up to date what the samples reach one cell away.
    #[inline(always)]
    fn reach_out(&mut self) {
        for (h_sq, reached) in [1.0, 2.0].into_iter().zip(&mut self.reached) {
            for (n, (reached, best_sq)) in reached.iter_mut().zip(&self.best_sq).enumerate() {
                let left = best_sq - h_sq;
                let reach = if left >= -SLACK { greater(left, 0.0).sqrt() + SLACK } else { f32::NEG_INFINITY };
                *reached = Reached { down: n as f32 + reach, up: n as f32 - reach };
            }
            let mut down = f32::NEG_INFINITY;
            for reached in reached.iter_mut() {
                down = greater(down, reached.down);
                reached.down = down;
            }
            let mut up = f32::INFINITY;
            for reached in reached.iter_mut().rev() {
                up = lesser(up, reached.up);
                reached.up = up;
            }
        }
    }

    /// Visits the cells that `reach` reaches and that are two or more away.
    #[inline(never)]
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
                        if h_sq >= 4.0 && h_sq <= reach_sq {
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

    /// Tests triangles of a cell against a run.
    #[inline(always)]
    fn test(&mut self, place: &Place, triangles: &[CellTriangle]) {
        let [dx, dy] = [0, 1].map(|axis| place.column[axis] as f32 - place.cell[axis] as f32);
        let top = (place.run * RUN) as f32;
        for triangle in triangles {
            let [high, low] = triangle.z_range();
            let best_sq = &self.best_sq.as_chunks::<RUN>().0[place.run];
            if !may_be_closer(best_sq, place.h_sq, [high - top, low - top]) {
                continue;
            }
            // One that stands in several intervals is taken in the first that is visited.
            if place.interval > place.top && self.index.interval(high) < place.interval {
                continue;
            }
            self.keep_closest(&FromColumn::new(triangle, dx, dy), place.run * RUN, triangle.leaf());
        }
    }

    /// Takes over, for the samples from `first` on, what is closer; of equals the lesser leaf.
    #[inline(always)]
    fn keep_closest(&mut self, triangle: &FromColumn, first: usize, leaf: u32) {
        let found = triangle.distances_sq(first as f32);
        let (Some(best_sq), Some(leaves)) =
            (self.best_sq[first..].first_chunk_mut::<LANES>(), self.leaf[first..].first_chunk_mut::<LANES>())
        else {
            return;
        };
        // Whole groups are read before any is written, so that the compiler keeps them in lanes.
        let (known_sq, known) = (*best_sq, *leaves);
        let (mut least_sq, mut closest) = ([0.0; LANES], [0; LANES]);
        for lane in 0..LANES {
            let is_closer = (found[lane] < known_sq[lane]) | ((found[lane] == known_sq[lane]) & (leaf < known[lane]));
            least_sq[lane] = if is_closer { found[lane] } else { known_sq[lane] };
            closest[lane] = if is_closer { leaf } else { known[lane] };
        }
        *best_sq = least_sq;
        *leaves = closest;
    }

    /// Writes the column down.
    #[inline(always)]
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
        may |= h_sq + gap * gap <= *best_sq + SLACK;
    }
    may
}
