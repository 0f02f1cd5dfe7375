//! Writing volumes: level 0 block by block, then level after level, in memory that is bounded whatever the volume's size.
//!
//! A block is a range of inlines and of crosslines with all their samples, whole shards of them, as many as half the memory holds; its shards
//! are written by all threads. Each further level is made shard by shard from the level before. [`resume_volume`] keeps the shards that an
//! earlier call, ended by a kill or a power cut, left whole: shards get their names only when they are complete, and their
//! checksums are verified before they are kept.

use super::array::{StoredArray, create_volume, write_array, write_group};
use super::error::StoreError;
use super::header::write_header;
use super::layout::{BRICK, Layout};
use super::pyramid::{halve, halved, needed};
use super::replacement::Replacement;
use super::sample::StoredSample;
use super::shard::{ShardGrid, Shards};
use super::volume::{KIND, VolumeInfo};
use crate::progress::Progress;
use crate::volume::Volume;
use rayon::prelude::*;
use std::borrow::Cow;
use std::fs;
use std::ops::Range;
use std::path::Path;

/// Least and greatest value of bricks, by their index.
type IndexedRanges = Vec<(usize, [f32; 2])>;

/// Says in a folder what is being written to it; gone when the volume is complete.
const MARKER: &str = "unfinished";

/// Bytes that making one shard of a further level takes: 262³ samples and what they become.
const LEVEL_BYTES: u64 = 160 << 20;

/// Memory that is used where nobody says otherwise.
const DEFAULT_MEMORY: u64 = 2 << 30;

/// A failure of whoever supplies samples.
pub type SourceError = Box<dyn std::error::Error + Send + Sync>;

/// Which lines a source holds together; blocks span as many of them as memory allows.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum LineOrder {
    /// One inline after the other.
    #[default]
    Inlines,
    /// One crossline after the other.
    Crosslines,
}

/// How a volume is written.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct WriteSettings {
    /// Memory to use, bytes; what one column of shards needs (128 × 128 traces, twice) is used in any case. Default 2 GiB.
    pub memory_bytes: u64,
    /// How the source is ordered.
    pub order: LineOrder,
}

impl Default for WriteSettings {
    fn default() -> Self {
        Self { memory_bytes: DEFAULT_MEMORY, order: LineOrder::Inlines }
    }
}

/// A part of the lattice, with all its samples.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Block {
    /// Indices of its inlines.
    pub inlines: Range<usize>,
    /// Indices of its crosslines.
    pub crosslines: Range<usize>,
}

/// What writing a volume did.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Ingested {
    /// Shards of all levels.
    pub files: usize,
    /// Those of them that an earlier call had written.
    pub kept: usize,
}

/// Stores a volume that is in memory.
///
/// # Errors
/// [`StoreError`]; `path` is then what it was before.
pub fn write_volume<T: StoredSample>(
    path: &Path,
    volume: &Volume<T>,
    info: &VolumeInfo,
    progress: &Progress,
) -> Result<(), StoreError> {
    let [_, ny, nz] = volume.size();
    // Blocks of whole inlines are borrowed as they are.
    let settings = WriteSettings { memory_bytes: u64::MAX, order: LineOrder::Inlines };
    let block = |block: &Block| {
        Ok(Cow::Borrowed(&volume.samples()[block.inlines.start * ny * nz..block.inlines.end * ny * nz]))
    };
    write_volume_blocks(path, volume.size(), volume.live(), info, &settings, block, progress).map(|_| ())
}

/// Stores a volume whose samples are supplied block by block, `[inline][crossline][sample]`. `live` is the mask of recorded
/// traces, `None` = all.
///
/// # Errors
/// [`StoreError`], [`StoreError::Source`] for what `supply` answers; `path` is then what it was before.
pub fn write_volume_blocks<'a, T: StoredSample>(
    path: &Path,
    size: [usize; 3],
    live: Option<&[bool]>,
    info: &VolumeInfo,
    settings: &WriteSettings,
    supply: impl FnMut(&Block) -> Result<Cow<'a, [T]>, SourceError>,
    progress: &Progress,
) -> Result<Ingested, StoreError> {
    let mask = mask_of(size, live, info)?;
    let replacement = Replacement::of(path)?;
    let ingest = Ingest { group: replacement.path(), path, mask, settings, progress };
    let done = ingest.run(size, info, supply)?;
    replacement.commit()?;
    Ok(done)
}

/// Stores a volume as [`write_volume_blocks`] does, but into `path` itself, and goes on where an earlier call with the same
/// `fingerprint` was interrupted; what is there under another fingerprint is removed first. The fingerprint stands for the source and everything
/// that was said about it.
///
/// # Errors
/// [`StoreError`]; what was written then stays for the next call, and is no volume that [`super::StoredVolume::open`] opens.
#[expect(clippy::too_many_arguments, reason = "those of `write_volume_blocks`, and the fingerprint")]
pub fn resume_volume<'a, T: StoredSample>(
    path: &Path,
    fingerprint: &str,
    size: [usize; 3],
    live: Option<&[bool]>,
    info: &VolumeInfo,
    settings: &WriteSettings,
    supply: impl FnMut(&Block) -> Result<Cow<'a, [T]>, SourceError>,
    progress: &Progress,
) -> Result<Ingested, StoreError> {
    let mask = mask_of(size, live, info)?;
    let fail = |source| StoreError::io("written", path, source);
    let marker = path.join(MARKER);
    if path.exists() && fs::read_to_string(&marker).ok().as_deref() != Some(fingerprint) {
        fs::remove_dir_all(path).map_err(fail)?;
        progress.warn("an interrupted import of another file, or with other options, was found: starting anew");
    }
    fs::create_dir_all(path).map_err(fail)?;
    fs::write(&marker, fingerprint).map_err(fail)?;
    let ingest = Ingest { group: path, path, mask, settings, progress };
    let done = ingest.run(size, info, supply)?;
    fs::remove_file(&marker).map_err(fail)?;
    Ok(done)
}

/// Whether the folder holds a volume that was not written to its end.
pub(super) fn is_unfinished(group: &Path) -> bool {
    group.join(MARKER).exists()
}

fn mask_of(size: [usize; 3], live: Option<&[bool]>, info: &VolumeInfo) -> Result<Vec<bool>, StoreError> {
    let fits = |what, expected: usize, found: usize| {
        if expected == found { Ok(()) } else { Err(StoreError::SizeMismatch { what, expected, found }) }
    };
    fits("the lattice", size.iter().product(), info.geometry.size().iter().product())?;
    let Some(live) = live else { return Ok(vec![true; size[0] * size[1]]) };
    fits("the live-trace mask", size[0] * size[1], live.len())?;
    Ok(live.to_vec())
}

/// Every second entry along both axes.
fn every_second(mask: &[bool], [nx, ny]: [usize; 2]) -> Vec<bool> {
    (0..nx).step_by(2).flat_map(|x| (0..ny).step_by(2).map(move |y| mask[x * ny + y])).collect()
}

/// A volume that is being written.
struct Ingest<'a> {
    /// The folder to write into.
    group: &'a Path,
    /// The folder that the volume will be in, for errors.
    path: &'a Path,
    mask: Vec<bool>,
    settings: &'a WriteSettings,
    progress: &'a Progress,
}

impl Ingest<'_> {
    fn run<'b, T: StoredSample>(
        &self,
        size: [usize; 3],
        info: &VolumeInfo,
        supply: impl FnMut(&Block) -> Result<Cow<'b, [T]>, SourceError>,
    ) -> Result<Ingested, StoreError> {
        write_header(self.group, KIND, info)?;
        write_group(self.group, "minmax", serde_json::Map::new())?;
        let bytes: Vec<u8> = self.mask.iter().map(|&live| u8::from(live)).collect();
        let layout = Layout::map([size[0], size[1]], ["inline", "crossline"]);
        write_array(self.group, "live", layout, 0, &bytes, self.progress)?;
        let mut done = self.write_full(size, supply)?;
        let (mut fine, mut fine_mask, mut level) = (size, Cow::Borrowed(&self.mask), 0);
        while fine.iter().any(|&n| n > BRICK) {
            level += 1;
            let mask = every_second(&fine_mask, [fine[0], fine[1]]);
            let added = self.write_level::<T>(level, fine, &fine_mask, &mask)?;
            done = Ingested { files: done.files + added.files, kept: done.kept + added.kept };
            (fine, fine_mask) = (halved(fine), Cow::Owned(mask));
        }
        Ok(done)
    }

    /// Writes level 0.
    fn write_full<'b, T: StoredSample>(
        &self,
        size: [usize; 3],
        mut supply: impl FnMut(&Block) -> Result<Cow<'b, [T]>, SourceError>,
    ) -> Result<Ingested, StoreError> {
        let grid = create_volume::<T>(self.group, "0", size)?;
        let counts = grid.counts();
        let mut shards = Shards::new(grid.clone(), self.group, "0");
        let mut done = Ingested { files: counts.iter().product(), kept: 0 };
        let mut ranges = BrickRanges::of(size);
        self.progress.begin("storing the volume", done.files as u64);
        for [columns_x, columns_y] in column_blocks::<T>(&grid, self.settings) {
            let places: Vec<[usize; 3]> = columns_x
                .clone()
                .flat_map(|x| columns_y.clone().flat_map(move |y| (0..counts[2]).map(move |z| [x, y, z])))
                .collect();
            if places.par_iter().all(|&place| shards.is_whole::<T>(place)) {
                for &place in &places {
                    let (start, extent) = grid.extent(place);
                    ranges.take(brick_ranges(&shards.read_box::<T>(start, extent)?, start, extent, &self.mask, size));
                    self.progress.step(1)?;
                }
                done.kept += places.len();
                shards.release();
                continue;
            }
            shards.release();
            let span = |columns: &Range<usize>, axis: usize| {
                columns.start * grid.shard[axis]..(columns.end * grid.shard[axis]).min(size[axis])
            };
            let block = Block { inlines: span(&columns_x, 0), crosslines: span(&columns_y, 1) };
            let samples = supply(&block).map_err(|source| StoreError::Source { path: self.path.to_owned(), source })?;
            let first = [block.inlines.start, block.crosslines.start, 0];
            let block_size = [block.inlines.len(), block.crosslines.len(), size[2]];
            let expected = block_size.iter().product();
            if samples.len() != expected {
                return Err(StoreError::SizeMismatch { what: "a block of samples", expected, found: samples.len() });
            }
            let found: Vec<Vec<(usize, [f32; 2])>> = places
                .par_iter()
                .map_init(Vec::new, |bytes, &place| {
                    let (start, extent) = grid.extent(place);
                    let samples = Samples { values: &samples, first, size: block_size };
                    let ranges = samples.brick_ranges(start, extent, &self.mask, size);
                    grid.write(place, samples.values, first, block_size, bytes)?;
                    self.progress.step(1)?;
                    Ok(ranges)
                })
                .collect::<Result<_, StoreError>>()?;
            found.into_iter().for_each(|found| ranges.take(found));
        }
        ranges.write(self.group, 0)?;
        Ok(done)
    }

    /// Writes level `level` from the level before, of size `fine`.
    fn write_level<T: StoredSample>(
        &self,
        level: usize,
        fine: [usize; 3],
        fine_mask: &[bool],
        mask: &[bool],
    ) -> Result<Ingested, StoreError> {
        let size = halved(fine);
        let name = level.to_string();
        let mut source = StoredArray::open(self.group, &(level - 1).to_string())?;
        let grid = create_volume::<T>(self.group, &name, size)?;
        let shards = Shards::new(grid.clone(), self.group, &name);
        let counts = grid.counts();
        let mut done = Ingested { files: counts.iter().product(), kept: 0 };
        let mut ranges = BrickRanges::of(size);
        self.progress.begin(&format!("storing level {level}"), done.files as u64);
        let places: Vec<[usize; 3]> =
            (0..done.files).map(|n| [n / (counts[1] * counts[2]), n / counts[2] % counts[1], n % counts[2]]).collect();
        let together =
            (self.settings.memory_bytes / LEVEL_BYTES).clamp(1, rayon::current_num_threads() as u64) as usize;
        for group in places.chunks(together) {
            let found: Vec<(bool, IndexedRanges)> = group
                .par_iter()
                .map(|&place| {
                    let (start, part) = grid.extent(place);
                    if shards.is_whole::<T>(place) {
                        let samples = shards.read_box::<T>(start, part)?;
                        return Ok((true, brick_ranges(&samples, start, part, mask, size)));
                    }
                    let coarse = coarser::<T>(&source, [fine, size], [start, part], [fine_mask, mask])?;
                    let found = brick_ranges(&coarse, start, part, mask, size);
                    grid.write(place, &coarse, start, part, &mut Vec::new())?;
                    Ok((false, found))
                })
                .collect::<Result<_, StoreError>>()?;
            for (is_kept, found) in found {
                done.kept += usize::from(is_kept);
                ranges.take(found);
                self.progress.step(1)?;
            }
            source.release();
        }
        ranges.write(self.group, level)?;
        Ok(done)
    }
}

/// The box `[start, part]` of a level from the finer one; `[fine, size]` are their sizes, the masks likewise.
fn coarser<T: StoredSample>(
    source: &StoredArray,
    [fine, size]: [[usize; 3]; 2],
    [start, part]: [[usize; 3]; 2],
    [fine_mask, mask]: [&[bool]; 2],
) -> Result<Vec<T>, StoreError> {
    let need = [0, 1, 2].map(|axis| needed(start[axis], part[axis], fine[axis]));
    let (first, box_size) = (need.map(|n| n.0), need.map(|n| n.1));
    let samples = source.read_box::<T>(&first, &box_size)?;
    let values = live_values(&samples, first, box_size, fine_mask, fine[1]);
    drop(samples);
    let halves = halve(&values, box_size, first, start, part);
    drop(values);
    let mut coarse = vec![T::from_f32(0.0); halves.len()];
    let traces = coarse.par_chunks_mut(part[2]).zip(halves.par_chunks(part[2])).enumerate();
    traces
        .filter(|(n, _)| mask[(start[0] + n / part[1]) * size[1] + start[1] + n % part[1]])
        .for_each(|(_, (out, halves))| out.iter_mut().zip(halves).for_each(|(out, &half)| *out = T::from_f32(half)));
    Ok(coarse)
}

/// Columns of shards that are written together, `[along x, along y]`.
fn column_blocks<T>(grid: &ShardGrid, settings: &WriteSettings) -> Vec<[Range<usize>; 2]> {
    let [nx, ny, _] = grid.counts();
    let column = (grid.shard[0] * grid.shard[1] * grid.shape[2] * size_of::<T>()).max(1) as u64;
    let fit = usize::try_from((settings.memory_bytes / 2 / column).max(1)).unwrap_or(usize::MAX);
    let parts = |count: usize| {
        let parts = count.div_ceil(fit.min(count.max(1)));
        let each = count.div_ceil(parts.max(1)).max(1);
        (0..count).step_by(each).map(move |first| first..(first + each).min(count))
    };
    match settings.order {
        LineOrder::Inlines => (0..nx).flat_map(|x| parts(ny).map(move |part| [x..x + 1, part])).collect(),
        LineOrder::Crosslines => (0..ny).flat_map(|y| parts(nx).map(move |part| [part, y..y + 1])).collect(),
    }
}

/// Samples as floats, NaN where the trace is dead.
fn live_values<T: StoredSample>(
    samples: &[T],
    first: [usize; 3],
    size: [usize; 3],
    mask: &[bool],
    ny: usize,
) -> Vec<f32> {
    let mut values = vec![0.0f32; samples.len()];
    values.par_chunks_mut(size[2]).zip(samples.par_chunks(size[2])).enumerate().for_each(|(n, (out, trace))| {
        let live = mask[(first[0] + n / size[1]) * ny + first[1] + n % size[1]];
        for (value, sample) in out.iter_mut().zip(trace) {
            *value = if live { sample.to_f32() } else { f32::NAN };
        }
    });
    values
}

/// A box of samples whose first voxel is `first`.
struct Samples<'a, T> {
    values: &'a [T],
    first: [usize; 3],
    size: [usize; 3],
}

impl<T: StoredSample> Samples<'_, T> {
    /// Least and greatest live sample of each brick of the box from `start` of size `part`, with the brick's number in a volume of
    /// `volume` voxels; `start` is a multiple of the brick. NaN is passed over.
    fn brick_ranges(
        &self,
        start: [usize; 3],
        part: [usize; 3],
        mask: &[bool],
        volume: [usize; 3],
    ) -> Vec<(usize, [f32; 2])> {
        let counts = volume.map(|n| n.div_ceil(BRICK));
        let inside = part.map(|n| n.div_ceil(BRICK));
        let mut found = vec![[f32::INFINITY, f32::NEG_INFINITY]; inside.iter().product()];
        for x in start[0]..start[0] + part[0] {
            for y in (start[1]..start[1] + part[1]).filter(|y| mask[x * volume[1] + y]) {
                let row = ((x - self.first[0]) * self.size[1] + y - self.first[1]) * self.size[2];
                let from = row + start[2] - self.first[2];
                let column = ((x - start[0]) / BRICK * inside[1] + (y - start[1]) / BRICK) * inside[2];
                for (b, part) in self.values[from..from + part[2]].chunks(BRICK).enumerate() {
                    let range = &mut found[column + b];
                    *range = widened(*range, part);
                }
            }
        }
        let number = |n: usize| {
            let place = [n / (inside[1] * inside[2]), n / inside[2] % inside[1], n % inside[2]];
            let at = [0, 1, 2].map(|axis| start[axis] / BRICK + place[axis]);
            (at[0] * counts[1] + at[1]) * counts[2] + at[2]
        };
        found.into_iter().enumerate().map(|(n, range)| (number(n), range)).collect()
    }
}

/// [`Samples::brick_ranges`] of a box that is the part itself.
fn brick_ranges<T: StoredSample>(
    values: &[T],
    start: [usize; 3],
    part: [usize; 3],
    mask: &[bool],
    volume: [usize; 3],
) -> Vec<(usize, [f32; 2])> {
    Samples { values, first: start, size: part }.brick_ranges(start, part, mask, volume)
}

/// A range and the samples, in lanes that become vector instructions; comparisons with NaN are false.
fn widened<T: StoredSample>([low, high]: [f32; 2], samples: &[T]) -> [f32; 2] {
    const LANES: usize = 8;
    let (mut lows, mut highs) = ([low; LANES], [high; LANES]);
    let (chunks, rest) = samples.as_chunks::<LANES>();
    for chunk in chunks {
        for lane in 0..LANES {
            let value = chunk[lane].to_f32();
            lows[lane] = if value < lows[lane] { value } else { lows[lane] };
            highs[lane] = if value > highs[lane] { value } else { highs[lane] };
        }
    }
    let rest = rest.iter().map(|value| value.to_f32()).filter(|value| !value.is_nan());
    let low = rest.clone().chain(lows).fold(f32::INFINITY, f32::min);
    let high = rest.chain(highs).fold(f32::NEG_INFINITY, f32::max);
    [low, high]
}

/// Least and greatest value of each brick.
struct BrickRanges {
    counts: [usize; 3],
    ranges: Vec<[f32; 2]>,
}

impl BrickRanges {
    fn of(size: [usize; 3]) -> Self {
        let counts = size.map(|n| n.div_ceil(BRICK));
        Self { counts, ranges: vec![[f32::NAN; 2]; counts.iter().product()] }
    }

    /// Takes in the ranges of some bricks; those without a value stay NaN.
    fn take(&mut self, found: Vec<(usize, [f32; 2])>) {
        for (brick, [low, high]) in found.into_iter().filter(|(_, [low, high])| low <= high) {
            self.ranges[brick] = [low, high];
        }
    }

    fn write(&self, group: &Path, level: usize) -> Result<(), StoreError> {
        let [x, y, z] = self.counts;
        let layout = Layout::whole(&[x, y, z, 2], vec!["brick_inline", "brick_crossline", "brick_sample", "minmax"]);
        let values = self.ranges.as_flattened();
        write_array(group, &format!("minmax/{level}"), layout, f32::NAN, values, &Progress::silent())
    }
}
