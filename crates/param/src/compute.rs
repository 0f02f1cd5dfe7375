//! Fills the stratigraphic grid of one region.
//!
//! In each column the levels are visited from the bottom to the top while both feet follow. Every node then
//! starts its own trace to the middle. Columns share only the lattice of closest points, so the result does
//! not depend on the number of threads.
//!
//! Degenerate places: where the sheets are closer than a thousandth of a voxel or cross (at a pinch-out and
//! beyond its edge), a column takes the offsets of the nearest column within two that has a thickness, so
//! that a wedge keeps its k up to the edge; farther away offsets are 0. A node whose result is not finite
//! keeps offset 0 and is flagged.

use crate::closest::Foot;
use crate::columns::{Depths, RegionColumns};
use crate::grid::{PINCHED, RegionGrid};
use crate::lattice::{COLUMNS, FootLattice, LEVELS, LatticeShape};
use crate::layer::{Feet, Layer, LayerKind};
use crate::surface::ColumnFrame;
use crate::trace::Tracer;
use glam::{Vec2, Vec3};
use rayon::prelude::*;
use std::sync::atomic::{AtomicU64, Ordering};
use std::time::{Duration, Instant};
use survey::{Cancelled, Progress};

/// Processor time used, summed over threads.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct ComputeCost {
    /// Finding closest points, i.e. k (f_z of P-illus 3.1) at all nodes.
    pub closest_points: Duration,
    /// Tracing isocurves to the middle, i.e. i and j.
    pub traces: Duration,
}

/// A sum of nanoseconds over many threads.
#[derive(Default)]
struct Clock(AtomicU64);

impl Clock {
    fn add(&self, since: Instant) -> Instant {
        let now = Instant::now();
        self.0.fetch_add((now - since).as_nanos() as u64, Ordering::Relaxed);
        now
    }

    fn total(&self) -> Duration {
        Duration::from_nanos(self.0.load(Ordering::Relaxed))
    }
}

/// Isocurves of neighbouring columns that end farther apart than this (voxels) have a crease between them.
const JUMP: f32 = 3.0;

/// The part of the results that belongs to one column.
struct TraceColumn<'a> {
    offsets: &'a mut [[f32; 3]],
    creases: &'a mut [bool],
}

/// Fills `grid.offsets` and `grid.creases`. Levels outside the depths in which the region occupies the column
/// repeat the nearest computed level.
///
/// # Errors
/// [`Cancelled`].
pub(crate) fn fill(
    grid: &mut RegionGrid,
    layer: &Layer,
    touched: &RegionColumns,
    tolerance: f32,
    progress: &Progress,
) -> Result<ComputeCost, Cancelled> {
    let [nx, ny] = grid.size;
    let levels = grid.levels;
    let mut offsets = vec![[0.0f32; 3]; nx * ny * levels];
    let mut creases = vec![false; nx * ny * levels];
    let origin = grid.origin;
    let filler = Filler::new(layer, grid, touched, tolerance, progress)?;
    offsets.par_chunks_mut(ny * levels).zip(creases.par_chunks_mut(ny * levels)).enumerate().try_for_each(
        |(x, (offsets, creases))| {
            for (y, (offsets, creases)) in offsets.chunks_mut(levels).zip(creases.chunks_mut(levels)).enumerate() {
                let column = [origin[0] + x as i32, origin[1] + y as i32];
                let n = x * ny + y;
                if touched.is_wanted(n) && layer.thickness(column) >= PINCHED {
                    filler.column(column, touched.depths[n], TraceColumn { offsets, creases });
                }
            }
            progress.step(1)
        },
    )?;
    flag_jumps(touched, levels, &offsets, &mut creases);
    extend_over_pinch_outs(layer, touched, levels, &mut offsets);
    grid.creases = creases
        .par_chunks(64)
        .map(|bits| bits.iter().enumerate().fold(0, |word, (bit, &set)| word | u64::from(set) << bit))
        .collect();
    grid.offsets = offsets;
    Ok(ComputeCost { closest_points: filler.closest_points.total(), traces: filler.traces.total() })
}

struct Filler<'a> {
    layer: &'a Layer,
    levels: usize,
    tolerance: f32,
    bottom: Option<FootLattice>,
    top: Option<FootLattice>,
    closest_points: Clock,
    traces: Clock,
}

impl<'a> Filler<'a> {
    fn new(
        layer: &'a Layer,
        grid: &RegionGrid,
        touched: &RegionColumns,
        tolerance: f32,
        progress: &Progress,
    ) -> Result<Self, Cancelled> {
        let levels = grid.levels;
        let shape = lattice_shape(grid, touched);
        let place = |column: [i32; 2], level: usize| {
            let v = (level * LEVELS) as f32 / (levels - 1) as f32;
            (layer.frame(column), Vec3::new(0.0, 0.0, -v * layer.thickness(column)))
        };
        let clock = Instant::now();
        let make = |surface| FootLattice::new(&shape, surface, &layer.metric, place, progress).map(Some);
        let (bottom, top) = match layer.kind {
            LayerKind::Ratio => (make(&layer.bottom)?, make(&layer.top)?),
            LayerKind::AboveBottom(_) => (make(&layer.bottom)?, None),
            LayerKind::BelowTop(_) => (None, make(&layer.top)?),
            LayerKind::Vertical => (None, None),
        };
        let filler =
            Self { layer, levels, tolerance, bottom, top, closest_points: Clock::default(), traces: Clock::default() };
        let lattices = clock.elapsed() * rayon::current_num_threads() as u32;
        filler.closest_points.0.store(lattices.as_nanos() as u64, Ordering::Relaxed);
        Ok(filler)
    }

    fn column(&self, column: [i32; 2], depths: Depths, mut out: TraceColumn) {
        let (frame, thickness) = (self.layer.frame(column), self.layer.thickness(column));
        let (first, last) = level_range(self.levels, frame.z, thickness, depths);
        match (&self.bottom, &self.top) {
            (Some(bottom), Some(top)) => {
                let tracer = Tracer {
                    layer: self.layer,
                    lattices: [bottom, top],
                    top_level: (self.levels - 1) as f32,
                    tolerance: self.tolerance,
                };
                self.ratio_column(&tracer, frame, thickness, first..=last, &mut out);
                copy_outwards(out.offsets, first, last);
            }
            (Some(lattice), None) | (None, Some(lattice)) => {
                self.parallel_column(lattice, frame, thickness, first..=last, &mut out);
                copy_outwards(out.offsets, first, last);
            }
            (None, None) => debug_assert_eq!(self.layer.kind, LayerKind::Vertical, "every other kind has a lattice"),
        }
    }

    fn ratio_column(
        &self,
        tracer: &Tracer,
        frame: ColumnFrame,
        thickness: f32,
        levels: std::ops::RangeInclusive<usize>,
        out: &mut TraceColumn,
    ) {
        let layer = self.layer;
        let start = |lattice: &FootLattice, surface| {
            let level = *levels.start() as f32;
            let at = lattice.start(frame.column[0] as f32, frame.column[1] as f32, level);
            let origin = Vec2::new(frame.column[0] as f32, frame.column[1] as f32);
            // The lattice has no start where the sheet is not finite.
            Foot::start(surface, frame, at.map_or(Vec2::ZERO, |at| at - origin))
        };
        let mut feet =
            Feet { bottom: start(tracer.lattices[0], &layer.bottom), top: start(tracer.lattices[1], &layer.top) };
        // First k at every level, with the feet from which its trace starts; then the traces.
        let clock = Instant::now();
        let place = |level: usize| Vec3::new(0.0, 0.0, -(level as f32 / (self.levels - 1) as f32) * thickness);
        let first = *levels.start();
        let mut states = Vec::with_capacity(levels.end() - first + 1);
        let mut last_feet: Option<Feet> = None;
        for level in levels {
            let p = place(level);
            layer.follow(frame, p, &mut feet);
            let jumped = tracer.try_lattice(frame, p, level as f32, &mut feet) && last_feet.is_some();
            states.push((layer.ratio(&feet), feet));
            last_feet = Some(feet);
            out.creases[level] = jumped;
        }
        let clock = self.closest_points.add(clock);
        for (n, (sample, feet)) in states.iter().enumerate() {
            let level = first + n;
            let crossing = tracer.trace(frame, place(level), *sample, feet);
            let v = level as f32 / (self.levels - 1) as f32;
            let dk = if level == 0 || level == self.levels - 1 { 0.0 } else { sample.k - v };
            let offset = [crossing.at.x, crossing.at.y, dk];
            let finite = offset.iter().all(|value| value.is_finite());
            out.offsets[level] = if finite { offset } else { [0.0; 3] };
            out.creases[level] |= crossing.crease || !finite;
        }
        self.traces.add(clock);
    }

    fn parallel_column(
        &self,
        lattice: &FootLattice,
        frame: ColumnFrame,
        thickness: f32,
        levels: std::ops::RangeInclusive<usize>,
        out: &mut TraceColumn,
    ) {
        let layer = self.layer;
        let (surface, upwards, reference) = match layer.kind {
            LayerKind::AboveBottom(reference) => (&layer.bottom, true, reference),
            LayerKind::BelowTop(reference) => (&layer.top, false, reference),
            LayerKind::Ratio | LayerKind::Vertical => unreachable!("a parallel column belongs to a parallel layer"),
        };
        let clock = Instant::now();
        let mut foot = Foot::start(surface, frame, Vec2::ZERO);
        // Start next to the sheet, where the foot is in the column itself.
        let (first, last) = (*levels.start(), *levels.end());
        for n in 0..=last - first {
            let level = if upwards { first + n } else { last - n };
            let v = level as f32 / (self.levels - 1) as f32;
            let p = Vec3::new(0.0, 0.0, -v * thickness);
            foot.follow(surface, &layer.metric, frame, p);
            out.creases[level] = lattice.try_lattice(&mut foot, surface, &layer.metric, frame, p, level as f32);
            let ratio = foot.distance / reference;
            let k = if upwards { ratio } else { 1.0 - ratio };
            let offset = [foot.at.x, foot.at.y, k - v];
            let finite = offset.iter().all(|value| value.is_finite());
            out.offsets[level] = if finite { offset } else { [0.0; 3] };
        }
        self.closest_points.add(clock);
    }
}

/// The first and last level of a column with this bottom and thickness that lie in the wanted depths, and three more on
/// each side.
pub(crate) fn level_range(levels: usize, bottom: f32, thickness: f32, depths: Depths) -> (usize, usize) {
    let last = levels - 1;
    let scale = last as f32 / thickness;
    let lowest = ((bottom - depths[1]) * scale).floor() - 3.0;
    let highest = ((bottom - depths[0]) * scale).ceil() + 3.0;
    ((lowest.max(0.0) as usize).min(last), (highest.max(0.0) as usize).min(last))
}

/// Copies the first and last computed level to the levels outside them.
fn copy_outwards(offsets: &mut [[f32; 3]], first: usize, last: usize) {
    let (low, high) = (offsets[first], offsets[last]);
    offsets[..first].fill(low);
    offsets[last + 1..].fill(high);
}

fn lattice_shape(grid: &RegionGrid, touched: &RegionColumns) -> LatticeShape {
    let along = |count: usize, stride: usize| (count - 1).div_ceil(stride) + 1;
    let size = [along(grid.size[0], COLUMNS), along(grid.size[1], COLUMNS), along(grid.levels, LEVELS)];
    let mut wanted = vec![false; size[0] * size[1]];
    for (n, ..) in touched.columns() {
        let (x, y) = (n / grid.size[1], n % grid.size[1]);
        // All corners of the cell that contains the column.
        for (a, b) in [(0, 0), (0, 1), (1, 0), (1, 1)] {
            let (u, v) = ((x / COLUMNS + a).min(size[0] - 1), (y / COLUMNS + b).min(size[1] - 1));
            wanted[u * size[1] + v] = true;
        }
    }
    LatticeShape { origin: grid.origin, size, wanted }
}

/// Flags the nodes of neighbouring columns whose isocurves end farther apart than [`JUMP`].
fn flag_jumps(touched: &RegionColumns, levels: usize, offsets: &[[f32; 3]], creases: &mut [bool]) {
    let [nx, ny] = touched.size;
    for x in 0..nx {
        for (along_x, step) in [(1, ny), (0, 1)] {
            for y in 0..ny {
                let n = x * ny + y;
                let inside = if along_x == 1 { x + 1 < nx } else { y + 1 < ny };
                if !(inside && touched.is_wanted(n) && touched.is_wanted(n + step)) {
                    continue;
                }
                for level in 0..levels {
                    let (a, b) = (n * levels + level, (n + step) * levels + level);
                    let gap_x = offsets[b][0] - offsets[a][0] + along_x as f32;
                    let gap_y = offsets[b][1] - offsets[a][1] + (1 - along_x) as f32;
                    if gap_x.abs().max(gap_y.abs()) > JUMP {
                        creases[a] = true;
                        creases[b] = true;
                    }
                }
            }
        }
    }
}

/// Gives columns without thickness the offsets of the nearest column that has one, at most two columns away.
fn extend_over_pinch_outs(layer: &Layer, touched: &RegionColumns, levels: usize, offsets: &mut [[f32; 3]]) {
    let [nx, ny] = touched.size;
    let mut known = vec![false; nx * ny];
    for (n, column, _) in touched.columns() {
        known[n] = layer.thickness(column) >= PINCHED;
    }
    let mut near: Vec<(i32, i32)> = (-2..=2).flat_map(|a| (-2..=2).map(move |b| (a, b))).collect();
    near.sort_by_key(|&(a, b)| (a * a + b * b, a, b));
    for n in (0..nx * ny).filter(|&n| touched.is_wanted(n) && !known[n]) {
        let (x, y) = ((n / ny) as i32, (n % ny) as i32);
        let source = near.iter().find_map(|&(a, b)| {
            let (u, v) = (x + a, y + b);
            let inside = u >= 0 && v >= 0 && u < nx as i32 && v < ny as i32;
            let m = (u * ny as i32 + v) as usize;
            (inside && known[m]).then_some(m)
        });
        if let Some(m) = source {
            offsets.copy_within(m * levels..(m + 1) * levels, n * levels);
        }
    }
}
