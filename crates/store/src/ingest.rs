//! Writing volumes: level 0 block by block, then level after level, in memory that is bounded whatever the
//! volume's size.
//!
//! A block is a range of inlines and of crosslines with all their samples. It consists of whole shards, as many as fit
//! into half the memory; as many threads write them as the other half has room for. Each further level is made shard by
//! shard from the level before, of which a few inlines are read at a time. [`resume_blocks`] keeps the intact shards of
//! an earlier call that was ended by a kill or a power cut: shards get their names only when they are complete, and
//! their checksums are verified before they are kept.

use super::array::{create_volume, write_array, write_group};
use super::coordinates;
use super::error::StoreError;
use super::header::write_header;
use super::layout::{ArrayLayout, BRICK};
use super::pyramid::{Halving, LevelBox, halved, needed};
use super::ranges::{BrickRanges, IndexedRanges, SampleBox};
use super::replacement::Replacement;
use super::sample::StoredSample;
use super::shard::{ShardGrid, Shards};
use super::volume_info::{KIND, VolumeInfo};
use rayon::prelude::*;
use std::borrow::Cow;
use std::fs;
use std::ops::Range;
use std::path::Path;
use std::sync::Mutex;
use survey::progress::Progress;
use survey::sample::Sample;
use survey::sample::SampleType;
use survey::source::{Block, BlockSource, LineOrder, SourceError};
use survey::volume::Volume;
use system::file::FileAction;
use system::huge_pages::zeroed;

/// The file that marks a folder as being written; it is removed when the volume is complete.
pub(super) const MARKER: &str = "unfinished";

/// Inlines of a finer level that are read at once.
const INLINES_TOGETHER: usize = 8;

/// Bytes that making one shard of a further level takes at most: 8 planes of 262² samples of the finer one, what
/// is between two steps of halving, 128³ samples and the file that they become, and a brick while it is read.
const LEVEL_BYTES: u64 = 22 << 20;

/// Default memory for writing a volume, bytes.
pub const MEMORY_BYTES: u64 = 2 << 30;

/// How a volume is written.
#[derive(Debug, Clone, Copy)]
struct WriteSettings {
    /// Memory to use, bytes; a column of shards (128 × 128 traces) and a shard are used in any case.
    memory_bytes: u64,
    /// The order in which the source delivers samples.
    order: LineOrder,
}

impl WriteSettings {
    /// How many shards may be made at a time, where each takes so many bytes.
    fn together(&self, bytes: u64) -> usize {
        let fit = usize::try_from((self.memory_bytes / bytes.max(1)).max(1)).unwrap_or(usize::MAX);
        // Where memory sets no limit, the threads do, and none has to wait for the others.
        if fit < rayon::current_num_threads() { fit } else { usize::MAX }
    }
}

/// The result of writing a volume.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Ingested {
    /// Count of shards of all levels.
    pub files: usize,
    /// Count of those that an earlier call had written already.
    pub kept: usize,
}

/// Stores a volume that is in memory.
///
/// # Errors
/// [`StoreError`]; `path` is then what it was before.
pub fn write_volume<T: StoredSample + Sample>(
    path: &Path,
    volume: &Volume<T>,
    info: &VolumeInfo,
    progress: &Progress,
) -> Result<(), StoreError> {
    let size = volume.size();
    let [_, ny, nz] = size;
    let mask = mask_of(size, volume.live(), info)?;
    // Blocks of whole inlines are borrowed without a copy.
    let settings = WriteSettings { memory_bytes: u64::MAX, order: LineOrder::Inlines };
    let block = |block: &Block, _| {
        Ok(Cow::Borrowed(&volume.samples()[block.inlines.start * ny * nz..block.inlines.end * ny * nz]))
    };
    let replacement = Replacement::of(path)?;
    Ingest { group: replacement.path(), path, mask, settings, progress }.run(size, info, block)?;
    replacement.commit()
}

/// Stores the volume of a source block by block, in its own order and type. It uses at most `memory_bytes`,
/// unless a single column of shards needs more.
///
/// # Errors
/// [`StoreError`]; [`StoreError::Source`] for an error of the source. `path` then remains as it was.
pub fn write_blocks(
    path: &Path,
    source: &mut dyn BlockSource,
    info: &VolumeInfo,
    memory_bytes: u64,
    progress: &Progress,
) -> Result<Ingested, StoreError> {
    let replacement = Replacement::of(path)?;
    let done = ingest_blocks(replacement.path(), path, source, info, memory_bytes, progress)?;
    replacement.commit()?;
    Ok(done)
}

/// Stores the volume of a source as [`write_blocks`] does, but directly in `path`, and continues where an
/// earlier call with the same `fingerprint` was interrupted. Content with another fingerprint is removed
/// first. The fingerprint identifies the source and everything that was stated about it.
///
/// # Errors
/// [`StoreError`]; what was written then remains for the next call. [`super::StoredVolume::open`] refuses to
/// open it.
pub fn resume_blocks(
    path: &Path,
    fingerprint: &str,
    source: &mut dyn BlockSource,
    info: &VolumeInfo,
    memory_bytes: u64,
    progress: &Progress,
) -> Result<Ingested, StoreError> {
    resume(path, fingerprint, progress, || ingest_blocks(path, path, source, info, memory_bytes, progress))
}

/// Writes a source's blocks to the folder `group`, which is to become `path`.
fn ingest_blocks(
    group: &Path,
    path: &Path,
    source: &mut dyn BlockSource,
    info: &VolumeInfo,
    memory_bytes: u64,
    progress: &Progress,
) -> Result<Ingested, StoreError> {
    // The type is chosen here, so that the code for it is compiled with this crate's optimisations whoever calls.
    let ingest = match source.sample_type() {
        SampleType::Int8 => ingest_as::<i8>,
        SampleType::Uint8 => ingest_as::<u8>,
        SampleType::Int16 => ingest_as::<i16>,
        SampleType::Uint16 => ingest_as::<u16>,
        SampleType::Int32 => ingest_as::<i32>,
        SampleType::Uint32 => ingest_as::<u32>,
        SampleType::Float32 => ingest_as::<f32>,
    };
    ingest(group, path, source, info, memory_bytes, progress)
}

fn ingest_as<T: StoredSample + Sample>(
    group: &Path,
    path: &Path,
    source: &mut dyn BlockSource,
    info: &VolumeInfo,
    memory_bytes: u64,
    progress: &Progress,
) -> Result<Ingested, StoreError> {
    let size = source.size();
    let mask = mask_of(size, source.live().as_deref(), info)?;
    let settings = WriteSettings { memory_bytes, order: source.order() };
    let supply = |block: &Block, mut room: Vec<T>| {
        let count = block.inlines.len() * block.crosslines.len() * size[2];
        if room.capacity() < count {
            // Given back first, so that the two are not held at once.
            drop(std::mem::take(&mut room));
            room = zeroed(count);
        }
        room.resize(count, T::default());
        source.read_block(block, T::slots(&mut room), progress)?;
        Ok(Cow::Owned(room))
    };
    Ingest { group, path, mask, settings, progress }.run(size, info, supply)
}

/// Lets `write` write into `path` itself, with a mark that says that it is being written.
fn resume(
    path: &Path,
    fingerprint: &str,
    progress: &Progress,
    write: impl FnOnce() -> Result<Ingested, StoreError>,
) -> Result<Ingested, StoreError> {
    let fail = |source| StoreError::io(FileAction::Written, path, source);
    let marker = path.join(MARKER);
    if path.exists() && fs::read_to_string(&marker).ok().as_deref() != Some(fingerprint) {
        fs::remove_dir_all(path).map_err(fail)?;
        progress.warn("an interrupted import of another file, or with other options, was found: starting anew");
    }
    fs::create_dir_all(path).map_err(fail)?;
    fs::write(&marker, fingerprint).map_err(fail)?;
    let done = write()?;
    fs::remove_file(&marker).map_err(fail)?;
    Ok(done)
}

/// Whether the folder holds a volume that was not completed.
pub(super) fn is_unfinished(group: &Path) -> bool {
    group.join(MARKER).exists()
}

pub(super) fn mask_of(size: [usize; 3], live: Option<&[bool]>, info: &VolumeInfo) -> Result<Vec<bool>, StoreError> {
    let fits = |what, expected: usize, found: usize| {
        if expected == found { Ok(()) } else { Err(StoreError::SizeMismatch { what, expected, found }) }
    };
    fits("the lattice", size.iter().product(), info.geometry.size().iter().product())?;
    let Some(live) = live else { return Ok(vec![true; size[0] * size[1]]) };
    fits("the live-trace mask", size[0] * size[1], live.len())?;
    Ok(live.to_vec())
}

/// Writes what a volume's group holds beside samples and their ranges.
pub(super) fn write_frame(
    group: &Path,
    info: &VolumeInfo,
    mask: &[bool],
    progress: &Progress,
) -> Result<(), StoreError> {
    let size = info.geometry.size();
    write_header(group, KIND, info)?;
    write_group(group, "minmax", serde_json::Map::new())?;
    let bytes: Vec<u8> = mask.iter().map(|&live| u8::from(live)).collect();
    let layout = ArrayLayout::map([size[0], size[1]], ["inline", "crossline"]);
    write_array(group, "live", layout, 0, &bytes, progress)?;
    coordinates::write(group, &info.geometry, progress)
}

/// Every second entry along both axes.
pub(super) fn every_second(mask: &[bool], [nx, ny]: [usize; 2]) -> Vec<bool> {
    (0..nx).step_by(2).flat_map(|x| (0..ny).step_by(2).map(move |y| mask[x * ny + y])).collect()
}

/// A volume that is being written.
struct Ingest<'a> {
    /// The folder to write into.
    group: &'a Path,
    /// The folder of the complete volume, for errors.
    path: &'a Path,
    mask: Vec<bool>,
    settings: WriteSettings,
    progress: &'a Progress,
}

impl Ingest<'_> {
    fn run<'b, T: StoredSample + Sample>(
        &self,
        size: [usize; 3],
        info: &VolumeInfo,
        supply: impl FnMut(&Block, Vec<T>) -> Result<Cow<'b, [T]>, SourceError>,
    ) -> Result<Ingested, StoreError> {
        write_frame(self.group, info, &self.mask, self.progress)?;
        let (mut done, mut grid) = self.write_full(size, info, supply)?;
        let (mut fine, mut fine_mask, mut level) = (size, Cow::Borrowed(&self.mask), 0);
        while fine.iter().any(|&n| n > BRICK) {
            level += 1;
            let mask = every_second(&fine_mask, [fine[0], fine[1]]);
            let (added, coarse) = self.write_level::<T>(level, grid, &fine_mask, &mask)?;
            grid = coarse;
            done = Ingested { files: done.files + added.files, kept: done.kept + added.kept };
            (fine, fine_mask) = (halved(fine), Cow::Owned(mask));
        }
        Ok(done)
    }

    /// Writes level 0.
    fn write_full<'b, T: StoredSample + Sample>(
        &self,
        size: [usize; 3],
        info: &VolumeInfo,
        mut supply: impl FnMut(&Block, Vec<T>) -> Result<Cow<'b, [T]>, SourceError>,
    ) -> Result<(Ingested, ShardGrid), StoreError> {
        let grid = create_volume::<T>(self.group, 0, size, coordinates::attributes(0, info))?;
        let counts = grid.counts();
        let shards = Shards::new(grid.clone(), self.group, "0");
        let mut done = Ingested { files: counts.iter().product(), kept: 0 };
        let mut ranges = BrickRanges::of(size);
        let rooms = Rooms::<Vec<u8>>::default();
        let together = self.settings.together(2 * grid.file_bytes::<T>() as u64);
        let mut spare = Vec::new();
        self.progress.begin("storing the volume", done.files as u64);
        for [columns_x, columns_y] in column_blocks::<T>(&grid, &self.settings) {
            let places: Vec<[usize; 3]> = columns_x
                .clone()
                .flat_map(|x| columns_y.clone().flat_map(move |y| (0..counts[2]).map(move |z| [x, y, z])))
                .collect();
            if places.par_iter().all(|&place| shards.is_whole::<T>(place)) {
                for &place in &places {
                    let (start, extent) = grid.extent(place);
                    let values = shards.read_box::<T>(start, extent)?;
                    ranges.take(
                        SampleBox { values: &values, first: start, size: extent }
                            .ranges(start, extent, &self.mask, size),
                    );
                    self.progress.step(1)?;
                }
                done.kept += places.len();
                continue;
            }
            let span = |columns: &Range<usize>, axis: usize| {
                columns.start * grid.shard[axis]..(columns.end * grid.shard[axis]).min(size[axis])
            };
            let block = Block { inlines: span(&columns_x, 0), crosslines: span(&columns_y, 1) };
            let supplied = supply(&block, std::mem::take(&mut spare));
            let values = supplied.map_err(|source| StoreError::Source { path: self.path.to_owned(), source })?;
            let first = [block.inlines.start, block.crosslines.start, 0];
            let block_size = [block.inlines.len(), block.crosslines.len(), size[2]];
            let expected = block_size.iter().product();
            if values.len() != expected {
                return Err(StoreError::SizeMismatch { what: "a block of samples", expected, found: values.len() });
            }
            let samples = SampleBox { values: &values, first, size: block_size };
            for places in places.chunks(together) {
                let found: Vec<IndexedRanges> = places
                    .par_iter()
                    .map(|&place| {
                        let found = rooms.with(|bytes| write_shard(&grid, place, &samples, &self.mask, bytes))?;
                        self.progress.step(1)?;
                        Ok(found)
                    })
                    .collect::<Result<_, StoreError>>()?;
                found.into_iter().for_each(|found| ranges.take(found));
            }
            if let Cow::Owned(values) = values {
                spare = values;
            }
        }
        ranges.write(self.group, 0)?;
        Ok((done, grid))
    }

    /// Writes level `level` from the level before, whose files are `fine`.
    fn write_level<T: StoredSample + Sample>(
        &self,
        level: usize,
        fine: ShardGrid,
        fine_mask: &[bool],
        mask: &[bool],
    ) -> Result<(Ingested, ShardGrid), StoreError> {
        let size = halved(fine.shape);
        let name = level.to_string();
        let fine_size = fine.shape;
        let source = Shards::new(fine, self.group, &(level - 1).to_string());
        let grid = create_volume::<T>(self.group, level, size, serde_json::Map::new())?;
        let shards = Shards::new(grid.clone(), self.group, &name);
        let counts = grid.counts();
        let mut done = Ingested { files: counts.iter().product(), kept: 0 };
        let mut ranges = BrickRanges::of(size);
        let rooms = Rooms::<LevelRoom<T>>::default();
        self.progress.begin(&format!("storing level {level}"), done.files as u64);
        let places: Vec<[usize; 3]> =
            (0..done.files).map(|n| [n / (counts[1] * counts[2]), n / counts[2] % counts[1], n % counts[2]]).collect();
        for group in places.chunks(self.settings.together(LEVEL_BYTES)) {
            let found: Vec<(bool, IndexedRanges)> = group
                .par_iter()
                .map(|&place| {
                    self.progress.check()?;
                    let (start, part) = grid.extent(place);
                    if shards.is_whole::<T>(place) {
                        let values = shards.read_box::<T>(start, part)?;
                        let samples = SampleBox { values: &values, first: start, size: part };
                        return Ok((true, samples.ranges(start, part, mask, size)));
                    }
                    let found = rooms.with(|room| {
                        room.fill(&source, [fine_size, size], [start, part], [fine_mask, mask])?;
                        let samples = SampleBox { values: &room.coarse, first: start, size: part };
                        write_shard(&grid, place, &samples, mask, &mut room.bytes)
                    });
                    Ok((false, found?))
                })
                .collect::<Result<_, StoreError>>()?;
            for (is_kept, found) in found {
                done.kept += usize::from(is_kept);
                ranges.take(found);
                self.progress.step(1)?;
            }
        }
        ranges.write(self.group, level)?;
        Ok((done, grid))
    }
}

/// Writes a shard from samples that contain all of it, and determines the ranges of its bricks.
pub(super) fn write_shard<T: StoredSample + Sample>(
    grid: &ShardGrid,
    place: [usize; 3],
    samples: &SampleBox<'_, T>,
    mask: &[bool],
    bytes: &mut Vec<u8>,
) -> Result<IndexedRanges, StoreError> {
    let mut found = Vec::new();
    grid.write(place, samples.values, samples.first, samples.size, bytes, |from, inside| {
        found.extend(samples.ranges(from, inside, mask, grid.shape));
    })?;
    Ok(found)
}

/// Buffers that threads reuse: allocating fresh memory costs more than the work done in it.
struct Rooms<R>(Mutex<Vec<R>>);

impl<R> Default for Rooms<R> {
    fn default() -> Self {
        Self(Mutex::default())
    }
}

impl<R: Default> Rooms<R> {
    fn with<T>(&self, work: impl FnOnce(&mut R) -> T) -> T {
        // The lock is held for a push or a pop, which cannot panic half way.
        let locked = || self.0.lock().unwrap_or_else(std::sync::PoisonError::into_inner);
        let mut room = locked().pop().unwrap_or_default();
        let result = work(&mut room);
        locked().push(room);
        result
    }
}

/// The buffers for making a shard of a further level.
pub(super) struct LevelRoom<T> {
    halving: Halving,
    fine: Vec<T>,
    /// The samples of the box that was made last.
    pub coarse: Vec<T>,
    /// Room for the file.
    pub bytes: Vec<u8>,
}

impl<T> Default for LevelRoom<T> {
    fn default() -> Self {
        Self { halving: Halving::default(), fine: Vec::new(), coarse: Vec::new(), bytes: Vec::new() }
    }
}

impl<T: StoredSample + Sample> LevelRoom<T> {
    /// Makes the box `[start, part]` of a level from the finer one; `[fine, size]` are their sizes, and the masks are
    /// given in the same way.
    pub(crate) fn fill(
        &mut self,
        source: &Shards,
        [fine, size]: [[usize; 3]; 2],
        [start, part]: [[usize; 3]; 2],
        [fine_mask, mask]: [&[bool]; 2],
    ) -> Result<(), StoreError> {
        let need = [0, 1, 2].map(|axis| needed(start[axis], part[axis], fine[axis]));
        let (first, box_size) = (need.map(|n| n.0), need.map(|n| n.1));
        let mut inlines = Inlines { source, first, size: box_size, read: 0..0, samples: &mut self.fine, failed: None };
        let coarse = &mut self.coarse;
        coarse.resize(part.iter().product(), T::from_f32(0.0));
        let is_live = |x: usize, y: usize| fine_mask[(first[0] + x) * fine[1] + first[1] + y];
        self.halving.run(
            LevelBox { first, size: box_size },
            LevelBox { first: start, size: part },
            |x, y, trace| {
                let live = is_live(x, y);
                if live {
                    inlines.read_trace(x, y, trace);
                }
                live
            },
            |x, slab| {
                let out = coarse[x * slab.len()..(x + 1) * slab.len()].chunks_exact_mut(part[2]);
                for (y, (out, halves)) in out.zip(slab.chunks_exact(part[2])).enumerate() {
                    if mask[(start[0] + x) * size[1] + start[1] + y] {
                        out.iter_mut().zip(halves).for_each(|(out, &half)| *out = T::from_f32(half));
                    } else {
                        out.fill(T::from_f32(0.0));
                    }
                }
            },
        );
        inlines.failed.map_or(Ok(()), Err)
    }
}

/// A box of a level whose inlines are read one after the other, a few at a time.
struct Inlines<'a, T> {
    source: &'a Shards,
    first: [usize; 3],
    size: [usize; 3],
    /// The inlines of the box that are in `samples`.
    read: Range<usize>,
    samples: &'a mut Vec<T>,
    /// Why inlines could not be read; nothing is read then any more.
    failed: Option<StoreError>,
}

impl<T: StoredSample + Sample> Inlines<'_, T> {
    /// The trace at x, y of the box; undefined once reading has failed.
    fn read_trace(&mut self, x: usize, y: usize, out: &mut [f32]) {
        if self.failed.is_some() {
            return;
        }
        let [nx, ny, nz] = self.size;
        if !self.read.contains(&x) {
            self.read = x..(x + INLINES_TOGETHER).min(nx);
            self.samples.resize(INLINES_TOGETHER * ny * nz, T::from_f32(0.0));
            let start = [self.first[0] + x, self.first[1], self.first[2]];
            let samples = &mut self.samples[..self.read.len() * ny * nz];
            self.failed = self.source.read_into(start, [self.read.len(), ny, nz], samples).err();
        }
        let from = ((x - self.read.start) * ny + y) * nz;
        out.iter_mut().zip(&self.samples[from..from + nz]).for_each(|(out, sample)| *out = sample.to_f32());
    }
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
