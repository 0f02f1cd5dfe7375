//! The search down the columns of a block, in runs of eight samples.
//!
//! Cells are searched in three rings. The four cells *around* a column give most answers. There, a triangle
//! at the depths of the run is tested, and one above or below it unless the bound of the nearest sample
//! excludes it (bounds of neighbouring samples differ by at most 1, so the nearest sample decides for the
//! others). The twelve cells *next* to those are at least 1 away, so only samples z whose closest triangle is
//! b > 1 away can be closer to them, and such samples reach the depths z ± √(b² − 1). Cells two or more away
//! are searched, brick by brick, for runs whose bound is above 2.

use super::index::{BRICK, Cell, CellIndex, INTERVAL};
use super::triangle::{CellTriangle, FromColumn, LANES, greater, lesser};
use super::{BEYOND, BlockRows, DistanceSettings};
use std::ops::Range;
use system::wide::Wide;

/// Samples that are searched together: one interval of the index.
const RUN: usize = INTERVAL;

const _: () = assert!(RUN == LANES);

/// Added to bounds, so that rounding never excludes the closest triangle. Voxels.
const SLACK: f32 = 1e-3;

/// The columns of a block, with the rows that receive their results.
pub(crate) struct ColumnBlock<'a, 'r> {
    pub(crate) size: [usize; 3],
    pub(crate) settings: &'a DistanceSettings,
    /// An index that covers everything within reach of the block.
    pub(crate) index: &'a CellIndex,
    pub(crate) x: Range<usize>,
    pub(crate) y: Range<usize>,
    pub(crate) rows: BlockRows<'r>,
}

impl Wide for ColumnBlock<'_, '_> {
    type Output = ();

    #[inline(always)]
    fn run(self) {
        let Self { size: [_, _, nz], settings, index, x, y, rows } = self;
        let mut column = ColumnSearch::new(index, settings.max_distance, nz);
        for (row, line) in rows.into_iter().zip(x) {
            for (n, crossline) in y.clone().enumerate() {
                column.search([line, crossline], if n == 0 { Neighbour::None } else { Neighbour::Before });
                let at = n * nz..(n + 1) * nz;
                column.write(settings, &mut row.0[at.clone()], &mut row.1[at]);
            }
        }
    }
}

/// The column that was searched before.
#[derive(Clone, Copy)]
enum Neighbour {
    /// No column, or none near.
    None,
    /// The neighbouring column.
    Before,
}

/// A cell and interval whose triangles are tested against a run.
struct CellVisit {
    column: [usize; 2],
    cell: [usize; 2],
    /// Squared horizontal distance of column and cell.
    h_sq: f32,
    run: usize,
    /// The interval of depth that contains the triangles, and the first one that is visited for this run.
    interval: usize,
    top: usize,
}

/// Horizontal distance, along one axis, of a column from the `count` cells that begin at `unit · count`.
#[inline(always)]
fn apart(at: usize, unit: usize, count: usize) -> f32 {
    (unit * count).saturating_sub(at).max(at.saturating_sub((unit + 1) * count)) as f32
}

/// A cell near a column: its triangles, and the column minus its near corner.
#[derive(Clone, Copy, Default)]
struct NearCell<'a> {
    cell: Cell<'a>,
    apart: [f32; 2],
    /// Squared horizontal distance of column and cell.
    h_sq: f32,
}

/// The column being searched. Arrays are padded to whole runs.
struct ColumnSearch<'a> {
    index: &'a CellIndex,
    max: f32,
    count: usize,
    /// Squared distance and leaf of the closest triangle so far; initially the squared bound and `u32::MAX`.
    best_sq: Vec<f32>,
    leaf: Vec<u32>,
    /// An upper bound of the distance of the closest triangle; differs by at most 1 from sample to sample.
    bound: Vec<f32>,
}

impl<'a> ColumnSearch<'a> {
    fn new(index: &'a CellIndex, max: f32, count: usize) -> Self {
        let padded = count.div_ceil(RUN).max(1) * RUN;
        Self {
            index,
            max,
            count,
            best_sq: vec![max * max; padded],
            leaf: vec![u32::MAX; padded],
            bound: vec![max; padded],
        }
    }

    /// Finds the closest leaf of every sample of a column. `neighbour` says which column was searched before.
    #[inline(always)]
    fn search(&mut self, column: [usize; 2], neighbour: Neighbour) {
        for (bound, best_sq) in self.bound.iter_mut().zip(&self.best_sq) {
            *bound = match neighbour {
                Neighbour::None => self.max,
                Neighbour::Before => best_sq.sqrt() + 1.0,
            };
        }
        let (around, next) = self.near(column);
        self.bound_by_extrema(&around);
        for (best_sq, bound) in self.best_sq.iter_mut().zip(&mut self.bound) {
            *bound = lesser(*bound + SLACK, self.max);
            *best_sq = *bound * *bound;
        }
        self.leaf.fill(u32::MAX);
        for run in 0..self.best_sq.len() / RUN {
            self.visit_around(&around, run);
            let reach = self.reach(run);
            if reach >= 1.0 {
                self.visit_next(&next, run);
            }
            if reach >= 2.0 {
                let reach = self.reach(run);
                if reach >= 2.0 {
                    self.visit_bricks(column, run, reach);
                }
            }
        }
    }

    /// The four cells around a column and the twelve next to those.
    #[inline(always)]
    fn near(&self, [x, y]: [usize; 2]) -> ([NearCell<'a>; 4], [NearCell<'a>; 12]) {
        let (mut around, mut next) = ([NearCell::default(); 4], [NearCell::default(); 12]);
        let (mut first, mut second) = (around.iter_mut(), next.iter_mut());
        for (far_x, far_y) in (0..4).flat_map(|far_x| (0..4).map(move |far_y| (far_x, far_y))) {
            let off = |far: usize| (far == 0 || far == 3) as usize;
            let ring = off(far_x) + off(far_y);
            let slot = if ring == 0 { first.next() } else { second.next() };
            let near = slot.expect("of 4 × 4 cells, four are inside and twelve on the rim");
            // Cells begin from two traces before the column to one trace behind it.
            if let (Some(cell_x), Some(cell_y)) = ((x + far_x).checked_sub(2), (y + far_y).checked_sub(2)) {
                let apart = [2.0 - far_x as f32, 2.0 - far_y as f32];
                *near = NearCell { cell: self.index.cell(cell_x, cell_y), apart, h_sq: ring as f32 };
            }
        }
        (around, next)
    }

    /// Upper bound of the distance of the closest triangle over the samples of a run.
    #[inline(always)]
    fn reach(&self, run: usize) -> f32 {
        let most_sq = self.best_sq[run * RUN..(run + 1) * RUN].iter().fold(0.0, |most, sq| greater(most, *sq));
        most_sq.sqrt() + SLACK
    }

    /// Lowers the bounds by the triangles' corners on this trace, and by the bounds of samples above and
    /// below.
    #[inline(always)]
    fn bound_by_extrema(&mut self, around: &[NearCell<'_>; 4]) {
        let last = self.bound.len() - 1;
        for near in around {
            let far = near.apart.map(|apart| apart as u32);
            for interval in 0..self.index.intervals() {
                for triangle in near.cell.within(interval) {
                    if let Some(z) = triangle.z_at(far) {
                        let above = ((z as i32).max(0) as usize).min(last);
                        for sample in [above, (above + 1).min(last)] {
                            let bound = &mut self.bound[sample];
                            *bound = lesser((z - sample as f32).abs(), *bound);
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

    /// Tests a run against the triangles of the four cells around the column.
    #[inline(always)]
    fn visit_around(&mut self, around: &[NearCell<'_>; 4], run: usize) {
        let [first, last] = [run * RUN, (run + 1) * RUN - 1];
        // The depths that the first sample reaches up to and the last one down to.
        let [up, down] = [first as f32 - self.bound[first], last as f32 + self.bound[last]];
        let [top, bottom] = [self.index.interval(up), self.index.interval(down)];
        for near in around {
            for interval in top..=bottom {
                let begin = if interval == top { f32::NEG_INFINITY } else { (interval * INTERVAL) as f32 };
                for triangle in near.cell.within(interval) {
                    let [high, low] = triangle.z_range();
                    // A triangle stored in several intervals is tested in the first.
                    if (low < up) | (high > down) | (high < begin) {
                        continue;
                    }
                    self.keep_closest(&FromColumn::new(triangle, near.apart), run, triangle.leaf());
                }
            }
        }
    }

    /// Tests a run against the triangles of the twelve cells that are one away.
    #[inline(always)]
    fn visit_next(&mut self, next: &[NearCell<'_>; 12], run: usize) {
        let begin = (run * RUN) as f32;
        // The depths that the samples reach at a horizontal distance of one cell.
        let [mut up, mut down] = [f32::INFINITY, f32::NEG_INFINITY];
        for (n, best_sq) in self.best_sq.as_chunks::<RUN>().0[run].iter().enumerate() {
            let left = best_sq - 1.0;
            let reach = if left > -SLACK { greater(left, 0.0).sqrt() + SLACK } else { f32::NEG_INFINITY };
            up = lesser(up, begin + n as f32 - reach);
            down = greater(down, begin + n as f32 + reach);
        }
        if up > down {
            return;
        }
        let [top, bottom] = [self.index.interval(up), self.index.interval(down)];
        for near in next {
            for interval in top..=bottom {
                let from = if interval == top { f32::NEG_INFINITY } else { (interval * INTERVAL) as f32 };
                for triangle in near.cell.within(interval) {
                    let [high, low] = triangle.z_range();
                    if (low < up) | (high > down) | (high < from) {
                        continue;
                    }
                    let best_sq = &self.best_sq.as_chunks::<RUN>().0[run];
                    if may_be_closer(best_sq, near.h_sq, [high - begin, low - begin]) {
                        self.keep_closest(&FromColumn::new(triangle, near.apart), run, triangle.leaf());
                    }
                }
            }
        }
    }

    /// Tests a run against the cells within `reach` that are two or more away.
    #[inline(always)]
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
                            let visit = CellVisit { column: [x, y], cell, h_sq, run, top: intervals.start, interval };
                            self.test(&visit, brick.in_cell(n));
                        }
                    }
                }
            }
        }
    }

    /// The intervals of depth within reach of a run at a horizontal distance.
    #[inline(always)]
    fn intervals(&self, run: usize, reach: f32, h_sq: f32) -> Range<usize> {
        let left = reach * reach - h_sq;
        if left < 0.0 {
            return 0..0;
        }
        let (down, top) = (left.sqrt(), (run * RUN) as f32);
        self.index.interval(top - down)..self.index.interval(top + (RUN - 1) as f32 + down) + 1
    }

    /// Tests a run against the triangles of a cell.
    #[inline(always)]
    fn test(&mut self, visit: &CellVisit, triangles: &[CellTriangle]) {
        let apart = [0, 1].map(|axis| visit.column[axis] as f32 - visit.cell[axis] as f32);
        let top = (visit.run * RUN) as f32;
        for triangle in triangles {
            let [high, low] = triangle.z_range();
            let best_sq = &self.best_sq.as_chunks::<RUN>().0[visit.run];
            if !may_be_closer(best_sq, visit.h_sq, [high - top, low - top]) {
                continue;
            }
            // A triangle stored in several intervals is tested in the first that is visited.
            if visit.interval > visit.top && self.index.interval(high) < visit.interval {
                continue;
            }
            self.keep_closest(&FromColumn::new(triangle, apart), visit.run, triangle.leaf());
        }
    }

    /// Keeps, for each sample of a run, the closer one of the known and the given triangle; at equal distance
    /// the lesser leaf.
    #[inline(always)]
    fn keep_closest(&mut self, triangle: &FromColumn, run: usize, leaf: u32) {
        let found = triangle.distances_sq((run * RUN) as f32);
        let best_sq = &mut self.best_sq.as_chunks_mut::<RUN>().0[run];
        let leaves = &mut self.leaf.as_chunks_mut::<RUN>().0[run];
        // Whole groups are read before any is written, so that the compiler keeps them in SIMD registers.
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

    /// Writes the results of the column.
    #[inline(always)]
    fn write(&self, settings: &DistanceSettings, distance: &mut [u8], leaf: &mut [u32]) {
        for n in 0..self.count {
            let found = self.leaf[n] != u32::MAX;
            leaf[n] = if found { self.leaf[n] } else { 0 };
            distance[n] = if found { settings.encode(self.best_sq[n].sqrt().min(self.max)) } else { BEYOND };
        }
    }
}

/// Whether a triangle at squared horizontal distance `h_sq`, from `high` to `low` below the first sample,
/// could be closer to one of the samples.
#[inline(always)]
fn may_be_closer<const N: usize>(best_sq: &[f32; N], h_sq: f32, [high, low]: [f32; 2]) -> bool {
    let mut may = false;
    for (n, best_sq) in best_sq.iter().enumerate() {
        let gap = greater(greater(high - n as f32, n as f32 - low), 0.0);
        may |= h_sq + gap * gap <= *best_sq + SLACK;
    }
    may
}
