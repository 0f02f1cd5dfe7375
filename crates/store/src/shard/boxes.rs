//! Boxes of an array, out of its shard files.

use super::super::error::StoreError;
use super::super::file_place::{ArrayFiles, FolderFiles};
use super::super::sample::StoredSample;
use super::file::{ChunkLines, Shard, Trouble};
use super::{ShardGrid, Span};
use rayon::prelude::*;
use std::io::ErrorKind;
use std::path::{Path, PathBuf};
use std::sync::{Arc, OnceLock};
use system::file::FileAction;

/// Below so many samples a box is read by one thread.
const WORTH_THREADS: usize = 1 << 15;

/// The shards of an array. Whatever part of them is read is verified. Their indexes are kept once they were
/// read, 4 KiB for a file of 8 MiB; a file is open only while it is read, so that there may be any number.
#[derive(Debug)]
pub(in super::super) struct Shards {
    grid: ShardGrid,
    files: Arc<dyn ArrayFiles>,
    /// The group, and the array's name in it, for errors.
    group: PathBuf,
    name: String,
    known: Vec<OnceLock<Shard>>,
}

impl Shards {
    pub(crate) fn new(grid: ShardGrid, group: &Path, name: &str) -> Self {
        let files = Arc::new(FolderFiles(grid.folder.clone()));
        Self::of_files(grid, files, group, name)
    }

    /// The shards whose files lie elsewhere.
    pub(crate) fn of_files(grid: ShardGrid, files: Arc<dyn ArrayFiles>, group: &Path, name: &str) -> Self {
        let known = (0..grid.counts().iter().product()).map(|_| OnceLock::new()).collect();
        Self { grid, files, group: group.to_owned(), name: name.to_owned(), known }
    }

    fn shard<T: StoredSample>(&self, index: [usize; 3]) -> Result<&Shard, StoreError> {
        let [_, ny, nz] = self.grid.counts();
        let cell = &self.known[(index[0] * ny + index[1]) * nz + index[2]];
        if let Some(shard) = cell.get() {
            return Ok(shard);
        }
        let (key, count) = (ShardGrid::key(index), self.grid.chunks().iter().product());
        let opened = Shard::open(&self.files, key, count, self.grid.chunk, size_of::<T>());
        // Another thread may have been first; what it found is as good.
        opened.map(|shard| cell.get_or_init(|| shard)).map_err(|trouble| self.explain(index, trouble))
    }

    /// Says which file, and which brick of the array, cannot be read.
    fn explain(&self, index: [usize; 3], trouble: Trouble) -> StoreError {
        let key = ShardGrid::key(index);
        let reason = match trouble {
            Trouble::Io(error) if error.kind() == ErrorKind::NotFound => format!("the file {key} is missing"),
            // What object storage answers has its sentence already.
            Trouble::Io(error) if error.get_ref().is_some_and(|cause| cause.is::<StoreError>()) => {
                return error
                    .downcast()
                    .unwrap_or_else(|error| StoreError::io(FileAction::Read, &self.files.place(&key), error));
            }
            Trouble::Io(error) => return StoreError::io(FileAction::Read, &self.files.place(&key), error),
            Trouble::Damage(reason) => format!("the file {key}: {reason}"),
            Trouble::Chunk(number) => {
                let chunks = self.grid.chunks();
                let inner = [number / (chunks[1] * chunks[2]), number / chunks[2] % chunks[1], number % chunks[2]];
                let place = [0, 1, 2].map(|axis| index[axis] * chunks[axis] + inner[axis]);
                let extent = self.grid.chunk_extent(place);
                let [x, y, z] = [0, 1, 2].map(|axis| format!("{} to {}", extent.start[axis], extent.end(axis) - 1));
                format!(
                    "the file {key}: the checksum of the brick {place:?} does not fit: inlines {x}, crosslines {y}, samples {z}, counted from 0"
                )
            }
        };
        StoreError::damaged(&self.group, &self.name, reason)
    }

    /// Whether the shard is there and all its checksums fit.
    pub(crate) fn is_whole<T: StoredSample>(&self, index: [usize; 3]) -> bool {
        self.damage::<T>(index).is_empty()
    }

    /// Reads all of the shard and verifies every checksum in it; returns an error for each brick that does not fit, or
    /// one for the shard.
    pub(crate) fn damage<T: StoredSample>(&self, index: [usize; 3]) -> Vec<StoreError> {
        let all = ChunkLines { x: 0..self.grid.chunk[0], y: 0..self.grid.chunk[1] };
        let mut room = Vec::new();
        let shard = match self.shard::<T>(index) {
            Ok(shard) => shard,
            Err(error) => return vec![error],
        };
        let reader = match shard.reader() {
            Ok(reader) => reader,
            Err(trouble) => return vec![self.explain(index, trouble)],
        };
        let stored = (0..shard.count()).filter(|&chunk| !shard.is_absent(chunk));
        let troubles = stored.filter_map(|chunk| reader.read::<T>(chunk, &all, &mut room).err());
        troubles.map(|trouble| self.explain(index, trouble)).collect()
    }

    /// The stored checksum of every chunk, shard by shard; 0 for those that hold only the fill value. They
    /// identify the data.
    pub(crate) fn checksums<T: StoredSample>(&self) -> Result<Vec<u32>, StoreError> {
        let [nx, ny, nz] = self.grid.counts();
        let mut sums = Vec::new();
        for n in 0..nx * ny * nz {
            let index = [n / (ny * nz), n / nz % ny, n % nz];
            let explain = |trouble| self.explain(index, trouble);
            let shard = self.shard::<T>(index)?;
            let reader = shard.reader().map_err(explain)?;
            for chunk in 0..shard.count() {
                sums.push(reader.checksum(chunk).map_err(explain)?);
            }
        }
        Ok(sums)
    }

    /// The samples of a box that is inside the array. Large boxes are read by all threads.
    pub(crate) fn read_box<T: StoredSample>(&self, start: [usize; 3], size: [usize; 3]) -> Result<Vec<T>, StoreError> {
        let mut out = vec![T::zeroed(); size.iter().product()];
        if out.is_empty() {
            return Ok(out);
        }
        let whole = Span { start, size };
        if out.len() < WORTH_THREADS {
            self.copy(&whole, &mut out)?;
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
        parts.into_par_iter().try_for_each(|(span, part)| self.copy(&span, part))?;
        Ok(out)
    }

    /// Fills `out` with the samples of a box that is inside the array, on this thread.
    pub(crate) fn read_into<T: StoredSample>(
        &self,
        start: [usize; 3],
        size: [usize; 3],
        out: &mut [T],
    ) -> Result<(), StoreError> {
        self.copy(&Span { start, size }, out)
    }

    /// Copies a box to `out`. Memory: a chunk at most.
    fn copy<T: StoredSample>(&self, span: &Span, out: &mut [T]) -> Result<(), StoreError> {
        let grid = &self.grid;
        let mut room = Vec::new();
        for index in places(span, grid.shard) {
            let shard = self.shard::<T>(index)?;
            let explain = |trouble| self.explain(index, trouble);
            let reader = shard.reader().map_err(explain)?;
            let (start, size) = grid.extent(index);
            let part = Span { start, size };
            let inside = Span {
                start: [0, 1, 2].map(|axis| part.common(span, axis).start),
                size: [0, 1, 2].map(|axis| part.common(span, axis).len()),
            };
            let chunks = grid.chunks();
            for place in places(&inside, grid.chunk) {
                let inner = [0, 1, 2].map(|axis| place[axis] % chunks[axis]);
                let number = (inner[0] * chunks[1] + inner[1]) * chunks[2] + inner[2];
                let extent = grid.chunk_extent(place);
                let [x, y] = [0, 1].map(|axis| {
                    let common = extent.common(span, axis);
                    common.start - extent.start[axis]..common.end - extent.start[axis]
                });
                let wanted = ChunkLines { x, y };
                let lines = match shard.is_absent(number) {
                    false => reader.read(number, &wanted, &mut room).map_err(explain)?,
                    true => {
                        room.clear();
                        room.resize(wanted.x.len() * wanted.y.len() * grid.chunk[2], T::zeroed());
                        wanted
                    }
                };
                copy_lines(&room, &lines, grid.chunk[2], &extent, span, out);
            }
        }
        Ok(())
    }
}

/// Places of the cells of `edges` that a span touches.
fn places(span: &Span, edges: [usize; 3]) -> impl Iterator<Item = [usize; 3]> + use<> {
    let first = [0, 1, 2].map(|axis| span.start[axis] / edges[axis]);
    let last = [0, 1, 2].map(|axis| (span.end(axis) - 1) / edges[axis]);
    (first[0]..=last[0])
        .flat_map(move |x| (first[1]..=last[1]).flat_map(move |y| (first[2]..=last[2]).map(move |z| [x, y, z])))
}

/// Copies what a span has in common with a chunk at `extent`, of which `lines` were read, with `depth` samples
/// a trace.
fn copy_lines<T: StoredSample>(
    samples: &[T],
    lines: &ChunkLines,
    depth: usize,
    extent: &Span,
    span: &Span,
    out: &mut [T],
) {
    let [xs, ys, zs] = [0, 1, 2].map(|axis| extent.common(span, axis));
    for x in xs {
        let row = (x - extent.start[0] - lines.x.start) * lines.y.len() + ys.start - extent.start[1] - lines.y.start;
        let from = row * depth + zs.start - extent.start[2];
        let to =
            ((x - span.start[0]) * span.size[1] + ys.start - span.start[1]) * span.size[2] + zs.start - span.start[2];
        if zs.len() == 1 {
            let values = samples[from..].iter().step_by(depth).take(ys.len());
            out[to..].iter_mut().step_by(span.size[2]).zip(values).for_each(|(out, value)| *out = *value);
            continue;
        }
        for y in 0..ys.len() {
            let (from, to) = (from + y * depth, to + y * span.size[2]);
            out[to..to + zs.len()].copy_from_slice(&samples[from..from + zs.len()]);
        }
    }
}
