//! Propagates light from slice to slice on the CPU, and stores what [`super::light::LightVolume`] reads.
//!
//! One pass over a slice blurs the light of the slice before, stores λ and E, and adds what the slice itself
//! occludes and emits. Only the window of the slice ([`super::windows`]) is computed.
//!
//! If there is only one medium, a row of cells is a line through the volume. Cells whose whole slice lies in
//! the medium are processed in runs that skip empty bricks, and their values are read [`BATCH`] at a time.
//! Cells in which a stretch of the medium begins or ends inside the slice are processed one by one.

use super::Faces;
use super::bricks::SampleLine;
use super::field::{Matter, MediaField};
use super::light_grid::{Asked, LightGrid};
use super::medium::{FieldMedium, Zone};
use super::samples::{BATCH, IndexPositions, NO_DATA_BELOW, VolumeSamples};
use super::stretches::stretches;
use super::table::absorbed;
use super::windows::{CellWindow, windows};
use crate::camera::View;
use crate::visible::{Ray, Solid};
use glam::{DVec2, DVec3, Vec3};
use rayon::prelude::*;
use survey::block::VoxelBox;
use survey::{Cancelled, Progress};
use system::wide::{Wide, widest};

/// λ and E at the front of every slice, in its window: row by row, slice by slice.
pub(super) struct Carried {
    pub windows: Vec<CellWindow>,
    /// Index in the lists below at which each window begins.
    pub starts: Vec<usize>,
    pub lambda: Vec<f32>,
    pub emission: Option<Vec<Vec3>>,
}

/// A stretch of the ray through a cell that lies in one zone; distances in slices.
#[derive(Debug, Clone, Copy)]
struct Passage {
    between: [f32; 2],
    zone: Zone,
}

const NOTHING: Passage = Passage { between: [0.0; 2], zone: Zone::Surroundings };

/// The media in the grid.
struct BlockPassages<'c> {
    field: &'c MediaField<'c>,
    view: &'c View,
    grid: &'c LightGrid,
    /// The single medium and its samples, if there is only one.
    alone: Option<(&'c FieldMedium<'c>, VolumeSamples<'c>)>,
    /// The first stretch of each cell, then the second of each cell, and so on.
    passages: Vec<Vec<Passage>>,
}

/// Propagates light through a block.
pub(super) fn carry(
    field: &MediaField,
    view: &View,
    solid: &Solid,
    roaming_box: &VoxelBox,
    grid: &LightGrid,
    asked: Asked,
    progress: &Progress,
) -> Result<Carried, Cancelled> {
    let [nu, nv, slices] = grid.size;
    let emits = field.horizons.as_ref().is_some_and(|h| h.horizons.iter().any(|one| one.emission > 0.0));
    let block = BlockPassages::new(field, view, solid, grid);
    let windows = windows(grid, view, roaming_box, asked);
    let mut starts = Vec::with_capacity(windows.len());
    let mut count = 0;
    for window in &windows {
        starts.push(count);
        count += window.size()[0] * window.size()[1];
    }
    // Every value is written below, by several threads; zeroed memory costs nothing until then.
    let mut lambda = vec![0.0f32; count];
    let mut emission = emits.then(|| vec![Vec3::ZERO; count]);
    // Slices with a border of empty cells.
    let pitch = nu + 2;
    let padded = pitch * (nv + 2);
    let (mut before, mut after) = (vec![0.0f32; padded], vec![0.0f32; padded]);
    let glowing = if emits { padded } else { 0 };
    let (mut glow_before, mut glow_after) = (vec![Vec3::ZERO; glowing], vec![Vec3::ZERO; glowing]);
    progress.begin("light", slices as u64);
    for (front, (window, start)) in windows.iter().zip(&starts).enumerate() {
        let [width, height] = window.size();
        let pass =
            SlicePass { block: &block, window: *window, front, pitch, before: &before, glow_before: &glow_before };
        let rows = |first: usize| first * pitch..;
        let kept = &mut lambda[*start..start + width * height];
        let carried = &mut after[rows(window.low[1] + 1)][..height * pitch];
        if let Some(emission) = &mut emission {
            let kept_glow = &mut emission[*start..start + width * height];
            let carried_glow = &mut glow_after[rows(window.low[1] + 1)][..height * pitch];
            (kept.par_chunks_mut(width * ROWS), kept_glow.par_chunks_mut(width * ROWS))
                .into_par_iter()
                .zip((carried.par_chunks_mut(pitch * ROWS), carried_glow.par_chunks_mut(pitch * ROWS)))
                .enumerate()
                .for_each(|(n, ((kept, kept_glow), (carried, carried_glow)))| {
                    pass.rows(n * ROWS, kept, carried);
                    pass.glowing_rows(n * ROWS, kept_glow, carried, carried_glow);
                });
        } else {
            let chunks = kept.par_chunks_mut(width * ROWS).zip(carried.par_chunks_mut(pitch * ROWS));
            chunks.enumerate().for_each(|(n, (kept, carried))| {
                pass.rows(n * ROWS, kept, carried);
                pass.add_own(n * ROWS, carried);
            });
        }
        std::mem::swap(&mut before, &mut after);
        std::mem::swap(&mut glow_before, &mut glow_after);
        progress.step(1)?;
    }
    Ok(Carried { windows, starts, lambda, emission })
}

/// Number of rows that one task computes.
const ROWS: usize = 16;

impl<'c> BlockPassages<'c> {
    fn new(field: &'c MediaField<'c>, view: &'c View, solid: &Solid, grid: &'c LightGrid) -> Self {
        let [nu, nv, _] = grid.size;
        let alone = field.only_medium().filter(|medium| medium.volume.volume.all().len() < u32::MAX as usize);
        let most = solid.cut_outs.len() * 2 + 1;
        let rows: Vec<Vec<Vec<Passage>>> = (0..nv)
            .into_par_iter()
            .map(|v| {
                let mut ranks: Vec<Vec<Passage>> = Vec::new();
                for u in 0..nu {
                    let (origin, direction) = view.depth_ray(cell_middle(grid, u, v));
                    let norm = direction.length();
                    let ray = Ray { origin: origin.as_vec3(), direction: (direction / norm).as_vec3() };
                    let slice = |t: f32| ((f64::from(t) / norm - grid.near) / grid.slice) as f32;
                    let mut rank = 0;
                    stretches(solid, &ray, [f32::MIN, f32::INFINITY], |stretch| {
                        let seen_into = stretch.zone == Zone::CutOut || field.faces != Faces::All;
                        let asked = alone.is_none_or(|medium| medium.zone == stretch.zone);
                        if seen_into && asked && rank < most {
                            if rank == ranks.len() {
                                ranks.push(vec![NOTHING; nu]);
                            }
                            ranks[rank][u] = Passage { between: stretch.t.map(slice), zone: stretch.zone };
                            rank += 1;
                        }
                    });
                }
                ranks
            })
            .collect();
        let ranks = rows.iter().map(Vec::len).max().unwrap_or(0);
        let nothing = vec![NOTHING; nu];
        let passages = (0..ranks)
            .map(|rank| rows.iter().flat_map(|row| row.get(rank).unwrap_or(&nothing)).copied().collect())
            .collect();
        Self { field, view, grid, alone: alone.map(|medium| (medium, medium.samples())), passages }
    }

    /// Voxel position of the middle of a cell at a depth in slices.
    fn voxel(&self, u: usize, v: usize, slice: f64) -> DVec3 {
        let (origin, direction) = self.view.depth_ray(cell_middle(self.grid, u, v));
        origin + direction * (self.grid.near + slice * self.grid.slice)
    }

    /// What a slice adds in a cell, for any media: occlusion, opacity and emitted light.
    fn slice(&self, u: usize, v: usize, slice: usize) -> (f32, f32, Vec3) {
        let mut sum = (0.0, 0.0, Vec3::ZERO);
        for passages in &self.passages {
            let Passage { between: [from, to], zone } = passages[v * self.grid.size[0] + u];
            let (from, to) = (from.max(slice as f32), to.min((slice + 1) as f32));
            if to <= from {
                continue;
            }
            let p = self.voxel(u, v, f64::from(0.5 * (from + to))).as_vec3();
            let word = self.field.bricks.word(self.field.bricks.at(p));
            let shift = if zone == Zone::CutOut { 8 } else { 0 };
            if word >> shift & 255 != 0 {
                continue;
            }
            let (_, direction) = self.view.depth_ray(cell_middle(self.grid, u, v));
            let towards = -(self.field.display_from_voxel * direction.as_vec3()).normalize_or_zero();
            let Matter { extinction, emission, .. } = self.field.at(p, zone, word, towards);
            if extinction <= 0.0 {
                continue;
            }
            let length = self.grid.slice_units * (to - from);
            let alpha = absorbed(extinction * length);
            sum.0 += absorbed(extinction) * length;
            sum.1 += alpha * (1.0 - sum.1);
            sum.2 += emission * alpha;
        }
        sum
    }
}

fn cell_middle(grid: &LightGrid, u: usize, v: usize) -> DVec2 {
    grid.low + DVec2::new(u as f64 + 0.5, v as f64 + 0.5) * grid.cell
}

/// The pass over one slice.
struct SlicePass<'p> {
    block: &'p BlockPassages<'p>,
    window: CellWindow,
    front: usize,
    pitch: usize,
    before: &'p [f32],
    glow_before: &'p [Vec3],
}

impl SlicePass<'_> {
    /// Blurs rows of the window from row `first` on, stores λ, and leaves the blurred occlusion in `carried`
    /// for the slice to add to.
    fn rows(&self, first: usize, kept: &mut [f32], carried: &mut [f32]) {
        widest(Blurring { pass: self, first, kept, carried });
    }

    /// Adds what the slice itself occludes.
    fn add_own(&self, first: usize, carried: &mut [f32]) {
        let block = self.block;
        if self.front == block.grid.size[2] {
            return;
        }
        if let Some((medium, samples)) = &block.alone {
            widest(Occluding { pass: self, medium, samples, first, carried });
            return;
        }
        for (n, row) in carried.chunks_exact_mut(self.pitch).enumerate() {
            for u in self.window.low[0]..self.window.high[0] {
                row[u + 1] += block.slice(u, self.window.low[1] + first + n, self.front).0;
            }
        }
    }

    /// Blurs emission and adds both emission and occlusion, for scenes with emission.
    fn glowing_rows(&self, first: usize, kept: &mut [Vec3], carried: &mut [f32], glow: &mut [Vec3]) {
        let [low, high] = [self.window.low[0], self.window.high[0]];
        let side = self.block.grid.side_weight(self.front);
        let rows = kept.chunks_exact_mut(high - low).zip(carried.chunks_exact_mut(self.pitch));
        for (n, ((kept, carried), glow)) in rows.zip(glow.chunks_exact_mut(self.pitch)).enumerate() {
            let v = self.window.low[1] + first + n;
            blur_row(self.glow_before, glow, self.pitch, v, [low, high], side);
            kept.copy_from_slice(&glow[low + 1..high + 1]);
            if self.front < self.block.grid.size[2] {
                for u in low..high {
                    let (a, alpha, emitted) = self.block.slice(u, v, self.front);
                    carried[u + 1] += a;
                    glow[u + 1] = glow[u + 1] * (1.0 - alpha) + emitted;
                }
            }
        }
    }
}

/// Blurs rows of a slice.
struct Blurring<'p> {
    pass: &'p SlicePass<'p>,
    first: usize,
    kept: &'p mut [f32],
    carried: &'p mut [f32],
}

impl Wide for Blurring<'_> {
    type Output = ();

    #[inline(always)]
    fn run(self) {
        let Self { pass, first, kept, carried } = self;
        let (grid, between) = (pass.block.grid, [pass.window.low[0], pass.window.high[0]]);
        let side = grid.side_weight(pass.front);
        let rows = kept.chunks_exact_mut(between[1] - between[0]).zip(carried.chunks_exact_mut(pass.pitch));
        for (n, (kept, carried)) in rows.enumerate() {
            blur_row(pass.before, carried, pass.pitch, pass.window.low[1] + first + n, between, side);
            for (lambda, occluded) in kept.iter_mut().zip(&carried[between[0] + 1..]) {
                *lambda = 1.0 / (1.0 + grid.strength * occluded);
            }
        }
    }
}

/// Blurs a row of cells with the 3 × 3 kernel that has this weight on either side. Rows and slices have a
/// border of empty cells.
#[inline(always)]
fn blur_row<T>(from: &[T], to: &mut [T], pitch: usize, row: usize, [low, high]: [usize; 2], side: f32)
where
    T: Copy + Default + std::ops::Add<Output = T> + std::ops::Mul<f32, Output = T>,
{
    let middle = 1.0 - 2.0 * side;
    let cells = |row: usize| &from[row * pitch + low..][..high - low + 2];
    let (below, here, above) = (cells(row), cells(row + 1), cells(row + 2));
    // A part at a time, so that the blurred columns stay in the cache.
    const PART: usize = 128;
    let mut mixed = [T::default(); PART + 2];
    for start in (0..high - low).step_by(PART) {
        let count = PART.min(high - low - start);
        let part = start..start + count + 2;
        let columns = below[part.clone()].iter().zip(&here[part.clone()]).zip(&above[part]);
        for (mixed, ((below, here), above)) in mixed.iter_mut().zip(columns) {
            *mixed = *here * middle + (*below + *above) * side;
        }
        let to = &mut to[low + 1 + start..][..count];
        for (n, to) in to.iter_mut().enumerate() {
            *to = mixed[n + 1] * middle + (mixed[n] + mixed[n + 2]) * side;
        }
    }
}

/// Adds what a single medium occludes in rows of a slice.
struct Occluding<'p> {
    pass: &'p SlicePass<'p>,
    medium: &'p FieldMedium<'p>,
    samples: &'p VolumeSamples<'p>,
    first: usize,
    carried: &'p mut [f32],
}

/// Cells whose values are to be read together.
struct Waiting {
    places: IndexPositions,
    /// Index of each cell in the row buffer, and the length of the medium in the slice.
    cells: [usize; BATCH],
    lengths: [f32; BATCH],
    filled: usize,
}

impl Wide for Occluding<'_> {
    type Output = ();

    #[inline(always)]
    fn run(self) {
        let mut waiting =
            Waiting { places: IndexPositions::default(), cells: [0; BATCH], lengths: [0.0; BATCH], filled: 0 };
        let Self { pass, medium, samples, first, carried } = self;
        let (block, slice) = (pass.block, pass.front as f32);
        let [low, high] = [pass.window.low[0], pass.window.high[0]];
        let (nu, units) = (block.grid.size[0], block.grid.slice_units);
        let (scale, offset) = medium.index_from_voxel();
        let shift = if medium.zone == Zone::CutOut { 8 } else { 0 };
        let bricks = &block.field.bricks;
        for row in 0..carried.len() / pass.pitch {
            let v = pass.window.low[1] + first + row;
            let start = row * pass.pitch + 1;
            let middle = f64::from(slice) + 0.5;
            let at = block.voxel(low, v, middle);
            let line = SampleLine::new(at.as_vec3(), (block.voxel(low + 1, v, middle) - at).as_vec3());
            let (index, index_per) = (line.at * scale + offset, line.per * scale);
            for passages in &block.passages {
                let passages = &passages[v * nu..(v + 1) * nu];
                let whole = |u: usize| passages[u].between[0] <= slice && passages[u].between[1] >= slice + 1.0;
                let mut u = low;
                while u < high {
                    let [from, to] = passages[u].between;
                    let (from, to) = (from.max(slice), to.min(slice + 1.0));
                    if to <= from {
                        u += 1;
                    } else if to - from < 1.0 {
                        let p = block.voxel(u, v, f64::from(0.5 * (from + to))).as_vec3();
                        if bricks.word(bricks.at(p)) >> shift & 255 == 0 {
                            waiting.push(p * scale + offset, start + u, units * (to - from));
                            waiting.settle(medium, samples, carried);
                        }
                        u += 1;
                    } else {
                        let end = (u + 1..high).find(|&u| !whole(u)).unwrap_or(high);
                        let count = (end - low) as u32;
                        let mut n = bricks.first_shown(&line, (u - low) as u32, count, shift);
                        while n < count {
                            let run = n..count.min(n + LANES);
                            for n in run.clone() {
                                waiting.push(index + index_per * n as f32, start + low + n as usize, units);
                            }
                            waiting.settle(medium, samples, carried);
                            n = bricks.first_shown(&line, run.end, count, shift);
                        }
                        u = end;
                    }
                }
            }
        }
        waiting.read(medium, samples, carried);
    }
}

/// Number of cells of a run between two lookups of empty space.
const LANES: u32 = 8;

impl Waiting {
    #[inline(always)]
    fn push(&mut self, index: Vec3, cell: usize, length: f32) {
        let n = self.filled;
        [self.places.axes[0][n], self.places.axes[1][n], self.places.axes[2][n]] = index.to_array();
        (self.cells[n], self.lengths[n]) = (cell, length);
        self.filled += 1;
    }

    /// Makes room for a run.
    #[inline(always)]
    fn settle(&mut self, medium: &FieldMedium, samples: &VolumeSamples, carried: &mut [f32]) {
        if self.filled + LANES as usize > BATCH {
            self.read(medium, samples, carried);
        }
    }

    #[inline(always)]
    fn read(&mut self, medium: &FieldMedium, samples: &VolumeSamples, carried: &mut [f32]) {
        let (mut values, mut entries) = ([0.0; BATCH], [0; BATCH]);
        samples.values(&self.places, self.filled, &mut values);
        medium.table.entries_of(&values, &mut entries);
        for n in 0..self.filled {
            let opacity = medium.table.opacities[entries[n] as usize];
            carried[self.cells[n]] += if values[n] < NO_DATA_BELOW { 0.0 } else { opacity * self.lengths[n] };
        }
        self.filled = 0;
    }
}

#[cfg(test)]
mod tests;
