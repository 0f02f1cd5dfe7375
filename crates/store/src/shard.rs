//! Shards of volumes as they lie on disk, written and read without the array library: Zarr v3's
//! `sharding_indexed` codec with the inner codecs `bytes` (little-endian) and `crc32c`, and the index, with a
//! checksum of its own, at the end.
//!
//! ```text
//! chunk, crc32c, chunk, crc32c, …, sums, crc32c, (offset u64, length u64) for each place of the shard, crc32c
//! ```
//!
//! Chunks that hold only the fill value are left out (offset and length all ones). Chunks are **not
//! compressed**: zstd would take a tenth off real 16-bit volumes and a third off floats
//! (`docs/performance.md`), but a section through a volume then costs the decoding of every chunk it touches,
//! sixty-four times the data it needs.
//!
//! `sums` are ours, in a place that the index does not mention and other readers pass over: for each chunk the
//! crc32c (u32) of each of its planes of one inline, then of each four of its planes of one crossline, 0 for a
//! chunk that is left out. With them a section reads and verifies its own planes alone. Where a shard has none
//! (another program or an earlier version wrote it), whole chunks are read and verified.
//!
//! | wanted of a chunk | read | verified by |
//! |---|---|---|
//! | some inlines | their planes, one call | the sums of these planes |
//! | some crosslines | their rows in fours, a call for each inline of the chunk | the sums of these planes |
//! | a time slice, or most of it | all of it, one call | the chunk's checksum |
//!
//! A shard is written beside its place and renamed, so that a killed program leaves whole shards only.

mod boxes;
mod file;
#[cfg(test)]
mod tests;

pub(super) use boxes::Shards;

use super::error::StoreError;
use super::sample::StoredSample;
use bytemuck::cast_slice;
use file::{ABSENT, CHECKSUM, ENTRY};
use std::fs;
use std::io::ErrorKind;
use std::path::PathBuf;
use system::file::FileAction;

const _: () = assert!(cfg!(target_endian = "little"), "chunks are little-endian and read as they are");

/// Ending of a shard's name until it is complete.
pub(super) const PARTIAL: &str = "part";

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
    /// Whether other processes may write the same shard: each then writes under a name of its own before the rename.
    pub beside_others: bool,
}

impl ShardGrid {
    /// Shards along each axis.
    pub(crate) fn counts(&self) -> [usize; 3] {
        [0, 1, 2].map(|axis| self.shape[axis].div_ceil(self.shard[axis]))
    }

    /// Chunks of a shard along each axis.
    fn chunks(&self) -> [usize; 3] {
        [0, 1, 2].map(|axis| self.shard[axis] / self.chunk[axis])
    }

    fn samples_in_chunk(&self) -> usize {
        self.chunk.iter().product()
    }

    /// Bytes of a shard file of `T`s at most.
    pub(crate) fn file_bytes<T>(&self) -> usize {
        let chunk = self.samples_in_chunk() * size_of::<T>() + CHECKSUM + sums_of(self.chunk) * CHECKSUM + ENTRY;
        self.chunks().iter().product::<usize>() * chunk + 2 * CHECKSUM
    }

    /// Name of a shard below the array's folder.
    fn key([x, y, z]: [usize; 3]) -> String {
        format!("c/{x}/{y}/{z}")
    }

    /// First voxel of a shard, and its voxels inside the volume.
    pub(crate) fn extent(&self, index: [usize; 3]) -> ([usize; 3], [usize; 3]) {
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
    pub(crate) fn write<T: StoredSample>(
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
        let fail = |source| StoreError::io(FileAction::Written, &path, source);
        let own = self.beside_others.then(|| format!("{}.{PARTIAL}", std::process::id()));
        let partial = path.with_extension(own.as_deref().unwrap_or(PARTIAL));
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
        let mut sums: Vec<u32> = vec![0; nx * ny * nz * sums_of(self.chunk)];
        let advance = CrcAdvance::by(self.chunk[1] * self.chunk[2] * size_of::<T>());
        let chunk_bytes = self.samples_in_chunk() * size_of::<T>();
        let most = self.file_bytes::<T>();
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
            let planes = sums_of(self.chunk);
            let sum = sums_of_planes(chunk, self.chunk, &advance, &mut sums[n * planes..(n + 1) * planes]);
            checksum.copy_from_slice(&sum.to_le_bytes());
            entries.extend([end as u64, (chunk_bytes + CHECKSUM) as u64]);
            end += chunk_bytes + CHECKSUM;
        }
        for table in [cast_slice(&sums), cast_slice::<u64, u8>(&entries)] {
            bytes[end..end + table.len()].copy_from_slice(table);
            end += table.len();
            bytes[end..end + CHECKSUM].copy_from_slice(&crc32c::crc32c(table).to_le_bytes());
            end += CHECKSUM;
        }
        end
    }
}

/// Crosslines that have a sum together: a row of one is so short that its sum would cost twice as much.
const CROSSLINES_TOGETHER: usize = 4;

/// Sums of a chunk of `edges`.
fn sums_of(edges: [usize; 3]) -> usize {
    edges[0] + edges[1].div_ceil(CROSSLINES_TOGETHER)
}

/// The checksum of a chunk of `edges`; those of its planes of one inline, then of its crosslines, go to `sums`.
/// `advance` is by a plane.
fn sums_of_planes(chunk: &[u8], edges: [usize; 3], advance: &CrcAdvance, sums: &mut [u32]) -> u32 {
    let (of_x, of_y) = sums.split_at_mut(edges[0]);
    let plane_bytes = chunk.len() / edges[0];
    let rows_bytes = plane_bytes / edges[1] * CROSSLINES_TOGETHER;
    let mut whole = 0;
    // A plane stays in the processor's nearest cache while it is summed twice.
    for (plane, sum) in chunk.chunks_exact(plane_bytes).zip(of_x) {
        *sum = crc32c::crc32c(plane);
        whole = advance.apply(whole) ^ *sum;
        for (rows, sum) in plane.chunks(rows_bytes).zip(of_y.iter_mut()) {
            *sum = crc32c::crc32c_append(*sum, rows);
        }
    }
    whole
}

/// What a checksum becomes when a fixed count of bytes follows: crc(a, b) = M·crc(a) + crc(b) over the field of
/// two elements, where M depends on the length of b alone.
struct CrcAdvance([u32; 32]);

impl CrcAdvance {
    fn by(bytes: usize) -> Self {
        Self(std::array::from_fn(|bit| crc32c::crc32c_combine(1 << bit, 0, bytes)))
    }

    fn apply(&self, sum: u32) -> u32 {
        self.0.iter().enumerate().fold(0, |found, (bit, column)| found ^ (column & (sum >> bit & 1).wrapping_neg()))
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

    /// What the two have in common, along an axis.
    fn common(&self, other: &Self, axis: usize) -> std::ops::Range<usize> {
        self.start[axis].max(other.start[axis])..self.end(axis).min(other.end(axis))
    }
}
