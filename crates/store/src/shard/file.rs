//! One shard file: its index, and verified parts of its chunks.

use super::super::file_place::{ArrayFiles, PlacedBytes};
use super::super::sample::StoredSample;
use super::{CROSSLINES_TOGETHER, sums_of};
use bytemuck::cast_slice_mut;
use std::io::{self, ErrorKind};
use std::ops::Range;
use std::sync::Arc;

/// Bytes of a checksum.
pub(super) const CHECKSUM: usize = 4;

/// Bytes of an entry of the index.
pub(super) const ENTRY: usize = 16;

/// Offset and length of a chunk that is not there.
pub(super) const ABSENT: u64 = u64::MAX;

/// Bytes that are copied and verified in the time that another call takes.
const CALL_BYTES: usize = 4096;

/// What keeps a shard from being read.
pub(super) enum Trouble {
    /// The system's answer.
    Io(io::Error),
    /// The file is not what was written.
    Damage(String),
    /// The checksum of a chunk, by its number in the shard, does not fit.
    Chunk(usize),
}

impl From<io::Error> for Trouble {
    fn from(error: io::Error) -> Self {
        match error.kind() {
            ErrorKind::UnexpectedEof => Self::Damage("it was cut off while it was read".to_owned()),
            _ => Self::Io(error),
        }
    }
}

/// Where the chunks of a shard file are, and their checksums.
#[derive(Debug)]
pub(super) struct Shard {
    files: Arc<dyn ArrayFiles>,
    key: String,
    /// Edges of a chunk.
    edges: [usize; 3],
    /// Bytes of each chunk without its checksum; empty = only the fill value.
    chunks: Vec<Range<u64>>,
    /// Checksums of the planes of each chunk, as [`sums_of`] counts them, if the file has them.
    sums: Option<Vec<u32>>,
}

impl Shard {
    /// Reads the index of a file of `count` chunks of `edges` samples, each of `sample_bytes`.
    pub(super) fn open(
        files: &Arc<dyn ArrayFiles>,
        key: String,
        count: usize,
        edges: [usize; 3],
        sample_bytes: usize,
    ) -> Result<Self, Trouble> {
        let file = files.open(&key).map_err(Trouble::Io)?;
        let length = file.length().map_err(Trouble::Io)?;
        let index_bytes = count * ENTRY + CHECKSUM;
        let sums_bytes = count * sums_of(edges) * CHECKSUM + CHECKSUM;
        let Some(index_at) = length.checked_sub(index_bytes as u64) else {
            return Err(Trouble::Damage(format!("only {length} bytes are left of it")));
        };
        let mut end = vec![0; length.min((sums_bytes + index_bytes) as u64) as usize];
        file.read_exact_at(length - end.len() as u64, &mut end)?;
        let (before, index) = end.split_at(end.len() - index_bytes);
        let Some(index) = verified(index) else {
            return Err(Trouble::Damage("the checksum of its index does not fit".to_owned()));
        };
        let chunk_bytes = (edges.iter().product::<usize>() * sample_bytes) as u64;
        let mut chunks = Vec::with_capacity(count);
        for entry in index.chunks_exact(ENTRY) {
            let (offset, bytes) = (number(&entry[..8]), number(&entry[8..]));
            if (offset, bytes) == (ABSENT, ABSENT) {
                chunks.push(0..0);
                continue;
            }
            let fits =
                bytes == chunk_bytes + CHECKSUM as u64 && offset.checked_add(bytes).is_some_and(|end| end <= index_at);
            if !fits {
                return Err(Trouble::Damage("its index points beyond its chunks".to_owned()));
            }
            chunks.push(offset..offset + chunk_bytes);
        }
        let filled = chunks.iter().filter(|range| !range.is_empty()).map(|range| range.end + CHECKSUM as u64);
        let has_sums = filled.max().unwrap_or(0) + sums_bytes as u64 == index_at;
        let sums = match has_sums.then(|| verified(before)) {
            None => None,
            Some(Some(sums)) => Some(sums.chunks_exact(CHECKSUM).map(|sum| number(sum) as u32).collect()),
            Some(None) => return Err(Trouble::Damage("the checksum of its sums does not fit".to_owned())),
        };
        drop(file);
        Ok(Self { files: files.clone(), key, edges, chunks, sums })
    }

    /// Opens the file once more, to read chunks.
    pub(super) fn reader(&self) -> Result<ShardReader<'_>, Trouble> {
        Ok(ShardReader { shard: self, file: self.files.open(&self.key).map_err(Trouble::Io)? })
    }

    pub(super) fn is_absent(&self, chunk: usize) -> bool {
        self.chunks[chunk].is_empty()
    }

    /// Count of chunks.
    pub(super) fn count(&self) -> usize {
        self.chunks.len()
    }
}

/// Inlines and crosslines of a chunk, with all their samples.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct ChunkLines {
    pub x: Range<usize>,
    pub y: Range<usize>,
}

/// An open shard file.
pub(super) struct ShardReader<'a> {
    shard: &'a Shard,
    file: Box<dyn PlacedBytes + 'a>,
}

impl ShardReader<'_> {
    /// Reads and verifies at least the lines `wanted` of a chunk that is not absent into the beginning of
    /// `room`, `[x][y][z]`; returns the lines that are there.
    pub(super) fn read<T: StoredSample>(
        &self,
        chunk: usize,
        wanted: &ChunkLines,
        room: &mut Vec<T>,
    ) -> Result<ChunkLines, Trouble> {
        let [nx, ny, nz] = self.shard.edges;
        let (row, plane) = (nz * size_of::<T>(), ny * nz * size_of::<T>());
        let first = wanted.y.start / CROSSLINES_TOGETHER * CROSSLINES_TOGETHER;
        let fours = first..wanted.y.end.next_multiple_of(CROSSLINES_TOGETHER).min(ny);
        let costs = [wanted.x.len() * plane, nx * (CALL_BYTES + fours.len() * row), nx * plane];
        let lines = match &self.shard.sums {
            Some(_) if costs[0] < costs[1].min(costs[2]) => ChunkLines { x: wanted.x.clone(), y: 0..ny },
            Some(_) if costs[1] < costs[2] => ChunkLines { x: 0..nx, y: fours },
            _ => ChunkLines { x: 0..nx, y: 0..ny },
        };
        let samples = lines.x.len() * lines.y.len() * nz;
        if room.len() < samples {
            room.resize(samples, T::zeroed());
        }
        let bytes: &mut [u8] = cast_slice_mut(&mut room[..samples]);
        let start = self.shard.chunks[chunk].start;
        if lines.y == (0..ny) {
            self.file.read_exact_at(start + (lines.x.start * plane) as u64, bytes)?;
        } else {
            for (x, rows) in lines.x.clone().zip(bytes.chunks_exact_mut(lines.y.len() * row)) {
                self.file.read_exact_at(start + (x * plane + lines.y.start * row) as u64, rows)?;
            }
        }
        if self.is_whole(chunk, &lines, bytes, row)? { Ok(lines) } else { Err(Trouble::Chunk(chunk)) }
    }

    /// Whether the lines of a chunk are those that were written.
    fn is_whole(&self, chunk: usize, lines: &ChunkLines, bytes: &[u8], row: usize) -> Result<bool, Trouble> {
        let [nx, ny, _] = self.shard.edges;
        let whole = *lines == (ChunkLines { x: 0..nx, y: 0..ny });
        let Some(sums) = self.shard.sums.as_ref().filter(|_| !whole) else {
            return Ok(crc32c::crc32c(bytes) == self.checksum(chunk)?);
        };
        let sums = &sums[chunk * sums_of(self.shard.edges)..][..sums_of(self.shard.edges)];
        if lines.y == (0..ny) {
            let planes = bytes.chunks_exact(ny * row).zip(&sums[lines.x.clone()]);
            return Ok(planes.fold(true, |fits, (plane, sum)| fits & (crc32c::crc32c(plane) == *sum)));
        }
        let mut found = vec![0; lines.y.len().div_ceil(CROSSLINES_TOGETHER)];
        for rows in bytes.chunks_exact(lines.y.len() * row) {
            for (four, sum) in rows.chunks(CROSSLINES_TOGETHER * row).zip(&mut found) {
                *sum = crc32c::crc32c_append(*sum, four);
            }
        }
        let first = nx + lines.y.start / CROSSLINES_TOGETHER;
        Ok(found == sums[first..first + found.len()])
    }

    /// The stored checksum of a chunk; 0 for one that holds only the fill value.
    pub(super) fn checksum(&self, chunk: usize) -> Result<u32, Trouble> {
        let mut sum = [0; CHECKSUM];
        if !self.shard.is_absent(chunk) {
            self.file.read_exact_at(self.shard.chunks[chunk].end, &mut sum)?;
        }
        Ok(u32::from_le_bytes(sum))
    }
}

/// A table without the checksum at its end, if that fits.
fn verified(table: &[u8]) -> Option<&[u8]> {
    let (table, sum) = table.split_at_checked(table.len().checked_sub(CHECKSUM)?)?;
    (crc32c::crc32c(table).to_le_bytes() == sum).then_some(table)
}

/// A little-endian number.
fn number(bytes: &[u8]) -> u64 {
    bytes.iter().rev().fold(0u64, |value, byte| value << 8 | u64::from(*byte))
}
