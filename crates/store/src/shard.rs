//! Shards of volumes as they lie on disk, written and read without copies: Zarr v3's `sharding_indexed` codec
//! with the inner codecs `bytes` (little-endian) and `crc32c`, and the index, with a checksum of its own, at
//! the end.
//!
//! ```text
//! chunk, crc32c, chunk, crc32c, …, (offset u64, length u64) for each place of the shard, crc32c
//! ```
//!
//! Chunks that hold only the fill value are left out (offset and length all ones). Chunks are **not
//! compressed**: zstd would take a tenth off real 16-bit volumes and a third off floats
//! (`docs/performance.md`), but a section through a volume then costs the decoding of every chunk it touches,
//! sixty-four times the data it needs. Uncompressed chunks are mapped into memory, and a section copies only
//! its own samples.
//!
//! A shard is written beside its place and renamed, so that a killed program leaves whole shards only.
//! Reading a whole chunk checks its checksum; reading a part of one does not.

use super::error::StoreError;
use super::sample::StoredSample;
use bytemuck::{cast_slice, try_cast_slice};
use memmap2::Mmap;
use rayon::prelude::*;
use std::fs::{self, File};
use std::io::ErrorKind;
use std::ops::Range;
use std::path::{Path, PathBuf};
use std::sync::OnceLock;

const _: () = assert!(cfg!(target_endian = "little"), "chunks are little-endian and mapped as they are");

/// Bytes of a checksum.
const CHECKSUM: usize = 4;

/// Bytes of an entry of the index.
const ENTRY: usize = 16;

/// Offset and length of a chunk that is not there.
const ABSENT: u64 = u64::MAX;

/// Below so many samples a box is read by one thread.
const WORTH_THREADS: usize = 1 << 15;

/// How a volume is cut into shards, and where they are.
#[derive(Debug, Clone)]
pub(super) struct ShardGrid {
    /// Folder of the array.
    pub folder: PathBuf,
    /// Voxels along each axis.
    pub shape: [usize; 3],
    /// Edges of a chunk.
    pub chunk: [usize; 3],
    /// Edges of a shard, multiples of the chunk's.
    pub shard: [usize; 3],
}

impl ShardGrid {
    /// Shards along each axis.
    pub fn counts(&self) -> [usize; 3] {
        [0, 1, 2].map(|axis| self.shape[axis].div_ceil(self.shard[axis]))
    }

    /// Chunks of a shard along each axis.
    fn chunks(&self) -> [usize; 3] {
        [0, 1, 2].map(|axis| self.shard[axis] / self.chunk[axis])
    }

    fn samples_in_chunk(&self) -> usize {
        self.chunk.iter().product()
    }

    /// Name of a shard below the array's folder.
    fn key([x, y, z]: [usize; 3]) -> String {
        format!("c/{x}/{y}/{z}")
    }

    /// First voxel of a shard, and its voxels inside the volume.
    pub fn extent(&self, index: [usize; 3]) -> ([usize; 3], [usize; 3]) {
        let start = [0, 1, 2].map(|axis| index[axis] * self.shard[axis]);
        (start, [0, 1, 2].map(|axis| self.shard[axis].min(self.shape[axis] - start[axis])))
    }

    /// Voxels of the chunk at `place` that are inside the volume.
    fn chunk_extent(&self, place: [usize; 3]) -> Span {
        let start = [0, 1, 2].map(|axis| place[axis] * self.chunk[axis]);
        Span { start, size: [0, 1, 2].map(|axis| self.chunk[axis].min(self.shape[axis] - start[axis])) }
    }

    /// Writes the shard at `index` from `samples` of `size` whose first voxel is `first`; they hold at least
    /// what of the shard is inside the volume. `bytes` is room, kept between calls. `visit` sees the first
    /// voxel and the size of every chunk just before its samples are copied, which then are in the
    /// processor's cache.
    pub fn write<T: StoredSample>(
        &self,
        index: [usize; 3],
        samples: &[T],
        first: [usize; 3],
        size: [usize; 3],
        bytes: &mut Vec<u8>,
        visit: impl FnMut([usize; 3], [usize; 3]),
    ) -> Result<(), StoreError> {
        let length = self.encode(index, samples, first, size, bytes, visit);
        let path = self.folder.join(Self::key(index));
        let fail = |source| StoreError::io("written", &path, source);
        let partial = path.with_extension("part");
        let written = match fs::write(&partial, &bytes[..length]) {
            Err(error) if error.kind() == ErrorKind::NotFound => {
                let parent = partial.parent().unwrap_or(&self.folder);
                fs::create_dir_all(parent).and_then(|()| fs::write(&partial, &bytes[..length]))
            }
            written => written,
        };
        written.and_then(|()| fs::rename(&partial, &path)).map_err(fail)
    }

    /// Lays the shard out in `bytes`, and returns its length.
    fn encode<T: StoredSample>(
        &self,
        index: [usize; 3],
        samples: &[T],
        first: [usize; 3],
        size: [usize; 3],
        bytes: &mut Vec<u8>,
        mut visit: impl FnMut([usize; 3], [usize; 3]),
    ) -> usize {
        let [nx, ny, nz] = self.chunks();
        let (start, _) = self.extent(index);
        let mut entries: Vec<u64> = Vec::with_capacity(2 * nx * ny * nz);
        let chunk_bytes = self.samples_in_chunk() * size_of::<T>();
        let most = nx * ny * nz * (chunk_bytes + CHECKSUM + ENTRY) + CHECKSUM;
        if bytes.len() < most {
            bytes.resize(most, 0);
        }
        let mut end = 0;
        for n in 0..nx * ny * nz {
            let place = [n / (ny * nz), n / nz % ny, n % nz];
            let from = [0, 1, 2].map(|axis| start[axis] + place[axis] * self.chunk[axis]);
            let inside = [0, 1, 2].map(|axis| self.chunk[axis].min(self.shape[axis].saturating_sub(from[axis])));
            if inside.contains(&0) {
                entries.extend([ABSENT; 2]);
                continue;
            }
            visit(from, inside);
            let (chunk, checksum) = bytes[end..end + chunk_bytes + CHECKSUM].split_at_mut(chunk_bytes);
            if inside != self.chunk {
                chunk.fill(0);
            }
            // Whether any bit is set: then the chunk is not the fill value throughout.
            let mut is_filled = false;
            for x in 0..inside[0] {
                for y in 0..inside[1] {
                    let at =
                        ((from[0] - first[0] + x) * size[1] + from[1] - first[1] + y) * size[2] + from[2] - first[2];
                    let to = (x * self.chunk[1] + y) * self.chunk[2] * size_of::<T>();
                    let row: &[u8] = cast_slice(&samples[at..at + inside[2]]);
                    is_filled = is_filled || row.iter().any(|byte| *byte != 0);
                    chunk[to..to + row.len()].copy_from_slice(row);
                }
            }
            if !is_filled {
                entries.extend([ABSENT; 2]);
                continue;
            }
            checksum.copy_from_slice(&crc32c::crc32c(chunk).to_le_bytes());
            entries.extend([end as u64, (chunk_bytes + CHECKSUM) as u64]);
            end += chunk_bytes + CHECKSUM;
        }
        let index: &[u8] = cast_slice(&entries);
        bytes[end..end + index.len()].copy_from_slice(index);
        end += index.len();
        bytes[end..end + CHECKSUM].copy_from_slice(&crc32c::crc32c(index).to_le_bytes());
        end + CHECKSUM
    }
}

/// A shard file, mapped, its index checked.
#[derive(Debug)]
struct Shard {
    map: Mmap,
    /// Bytes of each chunk without its checksum; empty = only the fill value.
    chunks: Vec<Range<usize>>,
}

impl Shard {
    fn open(path: &Path, chunk_count: usize, chunk_bytes: usize) -> Result<Self, Trouble> {
        // Asked before it is opened, since opening a pipe waits.
        survey::file::ordinary(path).map_err(Trouble::Io)?;
        let file = File::open(path).map_err(Trouble::Io)?;
        let length = file.metadata().map_err(Trouble::Io)?.len() as usize;
        let index_bytes = chunk_count * ENTRY;
        let Some(index_at) = length.checked_sub(index_bytes + CHECKSUM) else {
            return Err(Trouble::Damage(format!("only {length} bytes are left of it")));
        };
        #[expect(
            unsafe_code,
            reason = "a file can be mapped in no other way; files of the store are replaced, never changed. A crossline of 512³ samples lies in \
                      4096 pieces of 256 bytes, each of which positional reads would pay a call for"
        )]
        let map = unsafe { Mmap::map(&file) }.map_err(Trouble::Io)?;
        let index = &map[index_at..index_at + index_bytes];
        if crc32c::crc32c(index).to_le_bytes() != map[index_at + index_bytes..] {
            return Err(Trouble::Damage("the checksum of its index does not fit".to_owned()));
        }
        let number = |bytes: &[u8]| bytes.iter().rev().fold(0u64, |value, byte| value << 8 | u64::from(*byte));
        let mut chunks = Vec::with_capacity(chunk_count);
        for entry in index.chunks_exact(ENTRY) {
            let (offset, bytes) = (number(&entry[..8]), number(&entry[8..]));
            if (offset, bytes) == (ABSENT, ABSENT) {
                chunks.push(0..0);
                continue;
            }
            let fits = bytes == (chunk_bytes + CHECKSUM) as u64
                && offset.checked_add(bytes).is_some_and(|end| end <= index_at as u64);
            if !fits {
                return Err(Trouble::Damage("its index points beyond its chunks".to_owned()));
            }
            chunks.push(offset as usize..offset as usize + chunk_bytes);
        }
        Ok(Self { map, chunks })
    }

    fn is_whole(&self, chunk: usize) -> bool {
        let range = self.chunks[chunk].clone();
        range.is_empty()
            || crc32c::crc32c(&self.map[range.clone()]).to_le_bytes() == self.map[range.end..range.end + CHECKSUM]
    }
}

/// What keeps a shard from being read.
enum Trouble {
    Io(std::io::Error),
    Damage(String),
}

/// The shards of an array, mapped when they are first needed.
#[derive(Debug)]
pub(super) struct Shards {
    grid: ShardGrid,
    /// The group, and the array's name in it, for errors.
    group: PathBuf,
    name: String,
    open: Vec<OnceLock<Shard>>,
}

impl Shards {
    pub fn new(grid: ShardGrid, group: &Path, name: &str) -> Self {
        let open = (0..grid.counts().iter().product()).map(|_| OnceLock::new()).collect();
        Self { grid, group: group.to_owned(), name: name.to_owned(), open }
    }

    /// Unmaps what was mapped.
    pub fn release(&mut self) {
        self.open.iter_mut().for_each(|shard| drop(shard.take()));
    }

    fn damaged(&self, index: [usize; 3], reason: &str) -> StoreError {
        StoreError::Damaged {
            path: self.group.clone(),
            array: self.name.clone(),
            reason: format!("the file {}: {reason}", ShardGrid::key(index)),
        }
    }

    fn shard<T: StoredSample>(&self, index: [usize; 3]) -> Result<&Shard, StoreError> {
        let [_, ny, nz] = self.grid.counts();
        let cell = &self.open[(index[0] * ny + index[1]) * nz + index[2]];
        if let Some(shard) = cell.get() {
            return Ok(shard);
        }
        let path = self.grid.folder.join(ShardGrid::key(index));
        let chunk_bytes = self.grid.samples_in_chunk() * size_of::<T>();
        let opened = Shard::open(&path, self.grid.chunks().iter().product(), chunk_bytes);
        match opened {
            // Another thread may have been first; its map is as good.
            Ok(shard) => Ok(cell.get_or_init(|| shard)),
            Err(Trouble::Io(error)) if error.kind() == ErrorKind::NotFound => Err(StoreError::Damaged {
                path: self.group.clone(),
                array: self.name.clone(),
                reason: format!("the file {} is missing", ShardGrid::key(index)),
            }),
            Err(Trouble::Io(error)) => Err(StoreError::io("read", &path, error)),
            Err(Trouble::Damage(reason)) => Err(self.damaged(index, &reason)),
        }
    }

    /// Whether the shard is there and all its checksums fit.
    pub fn is_whole<T: StoredSample>(&self, index: [usize; 3]) -> bool {
        self.shard::<T>(index).is_ok_and(|shard| (0..shard.chunks.len()).all(|chunk| shard.is_whole(chunk)))
    }

    /// The stored checksum of every chunk, shard by shard; 0 for those that hold only the fill value. They
    /// identify the data.
    pub fn checksums<T: StoredSample>(&self) -> Result<Vec<u32>, StoreError> {
        let [nx, ny, nz] = self.grid.counts();
        let mut sums = Vec::new();
        for n in 0..nx * ny * nz {
            let shard = self.shard::<T>([n / (ny * nz), n / nz % ny, n % nz])?;
            sums.extend(shard.chunks.iter().map(|range| match range.is_empty() {
                true => 0,
                false => {
                    shard.map[range.end..range.end + CHECKSUM].iter().rev().fold(0, |sum, b| sum << 8 | u32::from(*b))
                }
            }));
        }
        Ok(sums)
    }

    /// The samples of a box that is inside the array. Large boxes are read by all threads.
    pub fn read_box<T: StoredSample>(&self, start: [usize; 3], size: [usize; 3]) -> Result<Vec<T>, StoreError> {
        let mut out = vec![T::from_f32(0.0); size.iter().product()];
        if out.is_empty() {
            return Ok(out);
        }
        let whole = Span { start, size };
        if out.len() < WORTH_THREADS {
            self.copy::<T>(&whole, &whole, &mut out)?;
            return Ok(out);
        }
        // The longest of the two slow axes is cut at the edges of chunks, so that a thread has chunks of its
        // own.
        let axis = if size[0] > 1 { 0 } else { 1 };
        let row: usize = size[axis + 1..].iter().product();
        let edge = self.grid.chunk[axis];
        let mut parts = Vec::new();
        let (mut rest, mut from) = (out.as_mut_slice(), start[axis]);
        while from < start[axis] + size[axis] {
            let to = ((from / edge + 1) * edge).min(start[axis] + size[axis]);
            let (part, after) = rest.split_at_mut((to - from) * row);
            let mut span = whole;
            (span.start[axis], span.size[axis]) = (from, to - from);
            parts.push((span, part));
            (rest, from) = (after, to);
        }
        parts.into_par_iter().try_for_each(|(span, part)| self.copy::<T>(&whole, &span, part))?;
        Ok(out)
    }

    /// A box whose traces are read one by one from the mapped chunks; the checksums of chunks that are wholly
    /// inside are verified.
    pub fn view<T: StoredSample>(&self, start: [usize; 3], size: [usize; 3]) -> Result<BoxView<'_, T>, StoreError> {
        let grid = &self.grid;
        let span = Span { start, size };
        let chunks = grid.chunks();
        let first = [0, 1, 2].map(|axis| start[axis] / grid.chunk[axis]);
        let counts = [0, 1, 2].map(|axis| (span.end(axis) - 1) / grid.chunk[axis] + 1 - first[axis]);
        let mut views = Vec::with_capacity(counts.iter().product());
        for n in 0..counts.iter().product() {
            let inside = [n / (counts[1] * counts[2]), n / counts[2] % counts[1], n % counts[2]];
            let place = [0, 1, 2].map(|axis| first[axis] + inside[axis]);
            let index = [0, 1, 2].map(|axis| place[axis] / chunks[axis]);
            let inner = [0, 1, 2].map(|axis| place[axis] % chunks[axis]);
            let shard = self.shard::<T>(index)?;
            let number = (inner[0] * chunks[1] + inner[1]) * chunks[2] + inner[2];
            if span.covers(&grid.chunk_extent(place)) && !shard.is_whole(number) {
                return Err(self.damaged(index, "the checksum of a chunk does not fit"));
            }
            let range = shard.chunks[number].clone();
            match try_cast_slice::<u8, T>(&shard.map[range]) {
                Ok(samples) => views.push(samples),
                Err(_) => return Err(self.damaged(index, "its chunks are not aligned")),
            }
        }
        Ok(BoxView { chunk: grid.chunk, start, first, counts, chunks: views })
    }

    /// Copies the part `span` of the box `whole`; `out` is that part.
    fn copy<T: StoredSample>(&self, whole: &Span, span: &Span, out: &mut [T]) -> Result<(), StoreError> {
        let grid = &self.grid;
        let chunks = grid.chunks();
        let first = [0, 1, 2].map(|axis| span.start[axis] / grid.chunk[axis]);
        let last = [0, 1, 2].map(|axis| (span.start[axis] + span.size[axis] - 1) / grid.chunk[axis]);
        for cx in first[0]..=last[0] {
            for cy in first[1]..=last[1] {
                for cz in first[2]..=last[2] {
                    let place = [cx, cy, cz];
                    let index = [0, 1, 2].map(|axis| place[axis] / chunks[axis]);
                    let inner = [0, 1, 2].map(|axis| place[axis] % chunks[axis]);
                    let shard = self.shard::<T>(index)?;
                    let number = (inner[0] * chunks[1] + inner[1]) * chunks[2] + inner[2];
                    let range = shard.chunks[number].clone();
                    if range.is_empty() {
                        continue;
                    }
                    let extent = grid.chunk_extent(place);
                    if whole.covers(&extent) && !shard.is_whole(number) {
                        return Err(self.damaged(index, "the checksum of a chunk does not fit"));
                    }
                    let Ok(samples) = try_cast_slice::<u8, T>(&shard.map[range]) else {
                        return Err(self.damaged(index, "its chunks are not aligned"));
                    };
                    copy_chunk(samples, grid.chunk, &extent, span, out);
                }
            }
        }
        Ok(())
    }
}

/// A box of a volume, in the chunks that hold it.
pub(super) struct BoxView<'a, T> {
    chunk: [usize; 3],
    start: [usize; 3],
    /// The first chunk, and how many there are.
    first: [usize; 3],
    counts: [usize; 3],
    /// Their samples; none where they are the fill value.
    chunks: Vec<&'a [T]>,
}

impl<T: StoredSample> BoxView<'_, T> {
    /// The samples of the trace at x, y of the box, as floats.
    pub fn read_trace(&self, x: usize, y: usize, out: &mut [f32]) {
        let at = [self.start[0] + x, self.start[1] + y];
        let place = [0, 1].map(|axis| at[axis] / self.chunk[axis] - self.first[axis]);
        let row = (at[0] % self.chunk[0] * self.chunk[1] + at[1] % self.chunk[1]) * self.chunk[2];
        let column = (place[0] * self.counts[1] + place[1]) * self.counts[2];
        let mut from = self.start[2] % self.chunk[2];
        let mut rest = out;
        for chunk in &self.chunks[column..column + self.counts[2]] {
            let (part, after) = rest.split_at_mut(rest.len().min(self.chunk[2] - from));
            match chunk.get(row + from..) {
                Some(samples) if !chunk.is_empty() => {
                    part.iter_mut().zip(samples).for_each(|(out, sample)| *out = sample.to_f32());
                }
                _ => part.fill(0.0),
            }
            (rest, from) = (after, 0);
        }
    }
}

/// A box of voxels.
#[derive(Debug, Clone, Copy)]
struct Span {
    start: [usize; 3],
    size: [usize; 3],
}

impl Span {
    fn end(&self, axis: usize) -> usize {
        self.start[axis] + self.size[axis]
    }

    fn covers(&self, other: &Self) -> bool {
        (0..3).all(|axis| self.start[axis] <= other.start[axis] && self.end(axis) >= other.end(axis))
    }
}

/// Copies what a chunk of edges `chunk` and a span have in common.
fn copy_chunk<T: StoredSample>(samples: &[T], chunk: [usize; 3], extent: &Span, span: &Span, out: &mut [T]) {
    let low = [0, 1, 2].map(|axis| extent.start[axis].max(span.start[axis]));
    let count = [0, 1, 2].map(|axis| extent.end(axis).min(span.end(axis)) - low[axis]);
    for x in low[0]..low[0] + count[0] {
        let from = ((x - extent.start[0]) * chunk[1] + low[1] - extent.start[1]) * chunk[2] + low[2] - extent.start[2];
        let to = ((x - span.start[0]) * span.size[1] + low[1] - span.start[1]) * span.size[2] + low[2] - span.start[2];
        if count[2] == 1 {
            let values = samples[from..].iter().step_by(chunk[2]).take(count[1]);
            out[to..].iter_mut().step_by(span.size[2]).zip(values).for_each(|(out, value)| *out = *value);
            continue;
        }
        for y in 0..count[1] {
            let (from, to) = (from + y * chunk[2], to + y * span.size[2]);
            out[to..to + count[2]].copy_from_slice(&samples[from..from + count[2]]);
        }
    }
}
