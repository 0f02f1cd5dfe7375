//! Horizon candidates on disk: `candidates.zarr`, a Zarr v3 group.
//!
//! ```text
//! distance, leaf             [inline][crossline][sample]: uint8, 255 = beyond; uint16 (uint32 above 65 535 leaves), 0 = none
//! pyramid/L/distance, leaf   level L: half of level L − 1 along each axis
//! forest/trace               uint16 [vertex][2]: inline and crossline index
//! forest/z                   float32 [vertex]: fractional sample index
//! forest/triangles           uint32 [triangle][3]: vertices; triangles of a node follow one another
//! forest/surfaces            uint32 [surface][5]: kind, first vertex, end, first triangle, end
//! forest/nodes               uint32 [node][6]: parent, two children (all ones = none), surface, first triangle, end
//! ```
//!
//! A voxel of a level stands for the 2 × 2 × 2 voxels of the level before and takes the smallest of their distances
//! with its leaf (of equal distances the one with the smaller id), so that no surface is lost however coarse the level
//! is. Distances remain in voxels of level 0. The extraction defines what leaves and nodes mean; here they are only
//! tables.
//!
//! Memory while writing slabs: an eighth of the volume's voxels at 5 bytes each for the pyramid, and one file per
//! thread. Columns (`bricks`) need no more than themselves.

mod bricks;
mod parts;
mod rows;

pub use parts::CandidateParts;
pub use rows::surface_batches;

use super::array::{ArrayWriter, StoredArray, write_array, write_group};
use super::error::StoreError;
use super::header::{read_header, write_header};
use super::layout::{ArrayLayout, BRICK, gather};
use super::pyramid::halved;
use super::replacement::Replacement;
use super::sample::StoredSample;
use rayon::prelude::*;
use serde::Serialize;
use serde_json::Value;
use std::path::{Path, PathBuf};
use survey::candidates::{BEYOND, CandidateBox, CandidateInfo, CandidateSink, ForestTables};
use survey::progress::Progress;
use survey::source::SourceError;

/// Kind of the group.
const KIND: &str = "candidates";

/// Rows of a table in one file.
const ROWS: usize = 1 << 20;

/// Leaf ids while they are written, in as few bytes as they need.
enum LeafWriter {
    Narrow(ArrayWriter<u16>),
    Wide(ArrayWriter<u32>),
}

/// One level in memory.
struct StoredLevel {
    size: [usize; 3],
    distance: Vec<u8>,
    leaf: Vec<u32>,
}

/// Writes candidates slab by slab. If it is dropped without [`CandidateSink::finish`], nothing is kept.
pub struct CandidateWriter {
    replacement: Replacement,
    size: [usize; 3],
    distance: ArrayWriter<u8>,
    leaf: LeafWriter,
    /// Level 1, once there are slabs.
    half: Option<StoredLevel>,
}

impl CandidateWriter {
    /// Begins to replace what is at `path`; `leaves` is the largest id that will occur.
    ///
    /// # Errors
    /// [`StoreError`].
    pub fn create(path: &Path, size: [usize; 3], leaves: usize) -> Result<Self, StoreError> {
        let replacement = Replacement::of(path)?;
        let group = replacement.path();
        // This creates the folder; the facts are written at the end.
        write_group(group, "", serde_json::Map::new())?;
        let layout = ArrayLayout::volume(size);
        let distance = ArrayWriter::create(group, "distance", layout.clone(), BEYOND)?;
        let leaf = LeafWriter::create(group, "leaf", layout, leaves)?;
        Ok(Self { replacement, size, distance, leaf, half: None })
    }
}

impl CandidateSink for CandidateWriter {
    // As many as fill the files.
    fn slab_inlines(&self) -> usize {
        self.distance.layout().file_shape()[0]
    }

    fn write_slab(
        &mut self,
        first: usize,
        distance: &[u8],
        leaf: &[u32],
        progress: &Progress,
    ) -> Result<(), SourceError> {
        let [nx, ny, nz] = self.size;
        let lines = self.slab_inlines().min(nx.saturating_sub(first));
        let expected = lines * ny * nz;
        let found = if first.is_multiple_of(self.slab_inlines()) { distance.len().min(leaf.len()) } else { first };
        if found != expected {
            return Err(StoreError::SizeMismatch { what: "a slab of candidates", expected, found }.into());
        }
        let size = [lines, ny, nz];
        let (edge, counts) = (self.distance.layout().file_shape(), self.distance.layout().file_counts());
        (0..counts[1] * counts[2]).into_par_iter().try_for_each(|n| {
            let (y, z) = (n / counts[2], n % counts[2]);
            let (index, start) = ([first / edge[0], y, z], [0, y * edge[1], z * edge[2]]);
            self.distance.write_shard(&index, gather(distance, &size, &start, edge))?;
            self.leaf.write_shard(&index, gather(leaf, &size, &start, edge))?;
            Ok::<(), StoreError>(progress.check()?)
        })?;
        let half = self.half.get_or_insert_with(|| StoredLevel::empty(halved(self.size)));
        let row = half.size[1] * half.size[2];
        let part = first / 2 * row..(first / 2 + lines.div_ceil(2)) * row;
        halve(size, distance, leaf, &mut half.distance[part.clone()], &mut half.leaf[part]);
        Ok(())
    }

    // If it fails, the target is what it was before.
    fn finish<R: Serialize>(
        self,
        info: &CandidateInfo<R>,
        forest: &ForestTables,
        progress: &Progress,
    ) -> Result<(), SourceError> {
        let Self { replacement, size, half, .. } = self;
        let mut half = half.unwrap_or_else(|| StoredLevel::empty(halved(size)));
        let group = replacement.path();
        write_group(group, "pyramid", serde_json::Map::new())?;
        for level in 1..levels(size) {
            if level > 1 {
                half = half.halved();
            }
            write_group(group, &format!("pyramid/{level}"), serde_json::Map::new())?;
            let layout = ArrayLayout::volume(half.size);
            write_array(group, &level_name(level, "distance"), layout.clone(), BEYOND, &half.distance, progress)?;
            let name = level_name(level, "leaf");
            if info.leaves <= usize::from(u16::MAX) {
                write_array(group, &name, layout, 0, &narrow(&half.leaf), progress)?;
            } else {
                write_array(group, &name, layout, 0, &half.leaf, progress)?;
            }
        }
        write_group(group, "forest", serde_json::Map::new())?;
        write_table(group, "forest/trace", forest.trace.as_flattened(), 2, progress)?;
        write_table(group, "forest/z", &forest.z, 1, progress)?;
        write_table(group, "forest/triangles", forest.triangles.as_flattened(), 3, progress)?;
        write_table(group, "forest/surfaces", forest.surfaces.as_flattened(), 5, progress)?;
        write_table(group, "forest/nodes", forest.nodes.as_flattened(), 6, progress)?;
        write_header(group, KIND, info)?;
        Ok(replacement.commit()?)
    }
}

impl LeafWriter {
    fn create(group: &Path, name: &str, layout: ArrayLayout, leaves: usize) -> Result<Self, StoreError> {
        Ok(if leaves <= usize::from(u16::MAX) {
            Self::Narrow(ArrayWriter::create(group, name, layout, 0)?)
        } else {
            Self::Wide(ArrayWriter::create(group, name, layout, 0)?)
        })
    }

    /// The same once its metadata are written; for `apart` see [`ArrayWriter::of_created`].
    fn open(
        group: &Path,
        name: &str,
        layout: ArrayLayout,
        leaves: usize,
        apart: Option<&Path>,
    ) -> Result<Self, StoreError> {
        Ok(if leaves <= usize::from(u16::MAX) {
            Self::Narrow(ArrayWriter::of_created(group, name, layout, 0, apart)?)
        } else {
            Self::Wide(ArrayWriter::of_created(group, name, layout, 0, apart)?)
        })
    }

    fn write_shard(&self, index: &[usize], values: Vec<u32>) -> Result<(), StoreError> {
        match self {
            Self::Narrow(writer) => writer.write_shard(index, narrow(&values)),
            Self::Wide(writer) => writer.write_shard(index, values),
        }
    }
}

/// Ids in two bytes; the caller knows that they fit.
fn narrow(ids: &[u32]) -> Vec<u16> {
    ids.iter().map(|&id| id as u16).collect()
}

/// Levels of a volume, the full one included.
fn levels(mut size: [usize; 3]) -> usize {
    let mut count = 1;
    while size.iter().any(|&n| n > BRICK) {
        size = halved(size);
        count += 1;
    }
    count
}

fn level_name(level: usize, array: &str) -> String {
    if level == 0 { array.to_owned() } else { format!("pyramid/{level}/{array}") }
}

impl StoredLevel {
    fn empty(size: [usize; 3]) -> Self {
        let count = size.iter().product();
        Self { size, distance: vec![BEYOND; count], leaf: vec![0; count] }
    }

    fn halved(&self) -> Self {
        let mut half = Self::empty(halved(self.size));
        halve(self.size, &self.distance, &self.leaf, &mut half.distance, &mut half.leaf);
        half
    }
}

/// Takes the smallest of 2 × 2 × 2 distances with its leaf. The coarse arrays have half the size.
fn halve(size: [usize; 3], distance: &[u8], leaf: &[u32], half_distance: &mut [u8], half_leaf: &mut [u32]) {
    let [nx, ny, nz] = size;
    let [_, half_ny, half_nz] = halved(size);
    let row = half_ny * half_nz;
    if row == 0 {
        return;
    }
    half_distance.par_chunks_mut(row).zip(half_leaf.par_chunks_mut(row)).enumerate().for_each(|(x, (out, ids))| {
        for fine_x in 2 * x..(2 * x + 2).min(nx) {
            for fine_y in 0..ny {
                let from = (fine_x * ny + fine_y) * nz;
                let to = fine_y / 2 * half_nz;
                for z in 0..nz {
                    let found = (distance[from + z], leaf[from + z]);
                    let at = to + z / 2;
                    if found.0 != BEYOND && found < (out[at], ids[at]) {
                        (out[at], ids[at]) = found;
                    }
                }
            }
        }
    });
}

/// Writes a table of `columns`; one of a single column has one axis.
fn write_table<T: StoredSample>(
    group: &Path,
    name: &str,
    values: &[T],
    columns: usize,
    progress: &Progress,
) -> Result<(), StoreError> {
    write_array(group, name, table_layout(values.len() / columns, columns), T::FILL, values, progress)
}

/// The division of a table.
fn table_layout(rows: usize, columns: usize) -> ArrayLayout {
    let chunk = rows.clamp(1, ROWS);
    match columns {
        1 => ArrayLayout { shape: vec![rows], chunk: vec![chunk], shard: None, axes: vec!["row".into()] },
        _ => ArrayLayout {
            shape: vec![rows, columns],
            chunk: vec![chunk, columns],
            shard: None,
            axes: vec!["row".into(), "column".into()],
        },
    }
}

/// Candidates on disk.
pub struct StoredCandidates {
    path: PathBuf,
    info: CandidateInfo<Value>,
    levels: Vec<[StoredArray; 2]>,
}

impl StoredCandidates {
    /// Opens candidates; values are read later.
    ///
    /// # Errors
    /// [`StoreError`] when they are missing, of another kind, newer than this program or damaged.
    pub fn open(path: &Path) -> Result<Self, StoreError> {
        let info: CandidateInfo<Value> = read_header(path, KIND, "horizon candidates")?;
        let mut size = info.size;
        let mut opened = Vec::new();
        for level in 0..levels(info.size) {
            let open = |array: &str| {
                let name = level_name(level, array);
                let array = StoredArray::open(path, &name)?;
                if array.shape() != size {
                    let reason = format!("it has {:?}, not {size:?}", array.shape());
                    return Err(StoreError::damaged(path, &name, reason));
                }
                Ok(array)
            };
            opened.push([open("distance")?, open("leaf")?]);
            size = halved(size);
        }
        Ok(Self { path: path.to_owned(), info, levels: opened })
    }

    /// The path.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// The facts of the extraction.
    pub fn info(&self) -> &CandidateInfo<Value> {
        &self.info
    }

    /// Levels, the full one included.
    pub fn level_count(&self) -> usize {
        self.levels.len()
    }

    /// Voxels of a level.
    ///
    /// # Panics
    /// If there is no such level.
    pub fn size(&self, level: usize) -> [usize; 3] {
        let shape = self.levels[level][0].shape();
        [shape[0], shape[1], shape[2]]
    }

    /// The distance that a code stands for, voxels of level 0.
    pub fn distance(&self, code: u8) -> Option<f32> {
        (code != BEYOND).then(|| f32::from(code) * self.info.max_distance / f32::from(BEYOND - 1))
    }

    /// A whole level.
    ///
    /// # Errors
    /// [`StoreError`].
    pub fn read(&self, level: usize, progress: &Progress) -> Result<CandidateBox, StoreError> {
        let [distance, leaf] = self.level(level)?;
        let leaf =
            if leaf.holds::<u16>() { widened(&leaf.read::<u16>(progress)?) } else { leaf.read::<u32>(progress)? };
        Ok(CandidateBox { size: self.size(level), distance: distance.read(progress)?, leaf })
    }

    /// A box of a level; `start` and `size` in voxels of that level.
    ///
    /// # Errors
    /// [`StoreError`], [`StoreError::OutOfBounds`] when the box is not inside the level.
    pub fn read_box(&self, level: usize, start: [usize; 3], size: [usize; 3]) -> Result<CandidateBox, StoreError> {
        let [distance, leaf] = self.level(level)?;
        let leaf = if leaf.holds::<u16>() {
            widened(&leaf.read_box::<u16>(&start, &size)?)
        } else {
            leaf.read_box::<u32>(&start, &size)?
        };
        Ok(CandidateBox { size, distance: distance.read_box(&start, &size)?, leaf })
    }

    /// Surfaces and trees.
    ///
    /// # Errors
    /// [`StoreError`].
    pub fn read_forest(&self, progress: &Progress) -> Result<ForestTables, StoreError> {
        Ok(ForestTables {
            trace: self.table("trace", progress)?,
            z: self.table::<f32, 1>("z", progress)?.into_iter().map(|[z]| z).collect(),
            triangles: self.table("triangles", progress)?,
            surfaces: self.table("surfaces", progress)?,
            nodes: self.read_nodes(progress)?,
        })
    }

    /// The trees alone: rows of `forest/nodes`.
    ///
    /// # Errors
    /// [`StoreError`].
    pub fn read_nodes(&self, progress: &Progress) -> Result<Vec<[u32; 6]>, StoreError> {
        self.table("nodes", progress)
    }

    /// Reads all of it, every level and every table, and verifies every checksum.
    ///
    /// # Errors
    /// [`StoreError`] with the first file that is missing or damaged, or cancelled.
    pub fn verify(&self, progress: &Progress) -> Result<(), StoreError> {
        self.levels.iter().flatten().try_for_each(|array| array.verify(progress))?;
        for table in ["trace", "z", "triangles", "surfaces", "nodes"] {
            StoredArray::open(&self.path, &format!("forest/{table}"))?.verify(progress)?;
        }
        Ok(())
    }

    fn level(&self, level: usize) -> Result<&[StoredArray; 2], StoreError> {
        let missing = || StoreError::MissingArray { path: self.path.clone(), array: level_name(level, "distance") };
        self.levels.get(level).ok_or_else(missing)
    }
}

/// Widens ids of two bytes to four.
fn widened(ids: &[u16]) -> Vec<u32> {
    ids.iter().map(|&id| id.into()).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    pub(super) fn info(size: [usize; 3], leaves: usize) -> CandidateInfo<Value> {
        CandidateInfo {
            key: "k".into(),
            size,
            max_distance: 10.0,
            leaves,
            report: serde_json::json!({ "surfaces": 3 }),
        }
    }

    pub(super) fn tables() -> ForestTables {
        ForestTables {
            trace: vec![[0, 1], [65535, 2], [3, 4]],
            z: vec![0.5, 1.25, 7.0],
            triangles: vec![[0, 1, 2]],
            surfaces: vec![[1, 0, 3, 0, 1]],
            nodes: vec![[u32::MAX, u32::MAX, u32::MAX, 0, 0, 1]],
        }
    }

    /// A volume in which every value tells its place.
    pub(super) fn volume(size: [usize; 3], leaves: usize) -> (Vec<u8>, Vec<u32>) {
        let count = size.iter().product::<usize>();
        let codes: Vec<u8> = (0..count).map(|n| ((n * 7919) % 311).min(255) as u8).collect();
        let ids = codes.iter().enumerate();
        let ids = ids.map(|(n, &code)| if code == BEYOND { 0 } else { (n * 31 % leaves) as u32 + 1 }).collect();
        (codes, ids)
    }

    fn write(path: &Path, size: [usize; 3], leaves: usize) {
        let (distance, leaf) = volume(size, leaves);
        let silent = Progress::silent();
        let mut writer = CandidateWriter::create(path, size, leaves).unwrap();
        let row = size[1] * size[2];
        for first in (0..size[0]).step_by(writer.slab_inlines()) {
            let part = first * row..(first + writer.slab_inlines()).min(size[0]) * row;
            writer.write_slab(first, &distance[part.clone()], &leaf[part], &silent).unwrap();
        }
        writer.finish(&info(size, leaves), &tables(), &silent).unwrap();
    }

    #[test]
    fn candidates_come_back_in_two_and_in_four_bytes() {
        for (size, leaves, kind) in [([130, 20, 70], 900, "uint16"), ([5, 6, 7], 70_000, "uint32")] {
            let folder = tempfile::tempdir().unwrap();
            let path = folder.path().join("candidates.zarr");
            write(&path, size, leaves);
            let stored = StoredCandidates::open(&path).unwrap();
            let (distance, leaf) = volume(size, leaves);
            let silent = Progress::silent();
            assert_eq!(stored.info(), &info(size, leaves));
            assert_eq!(stored.read(0, &silent).unwrap(), CandidateBox { size, distance, leaf });
            assert_eq!(stored.read_forest(&silent).unwrap(), tables());
            assert_eq!(stored.levels[0][1].type_name(), kind);
            assert_eq!((stored.distance(254), stored.distance(BEYOND)), (Some(10.0), None));
            assert!(stored.read_box(0, [0; 3], [size[0] + 1, 1, 1]).is_err());
            assert!(stored.read(9, &silent).is_err());
        }
    }

    #[test]
    fn levels_have_the_least_distance_and_its_leaf() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("candidates.zarr");
        let size = [131, 9, 77];
        write(&path, size, 900);
        let (distance, leaf) = volume(size, 900);
        let stored = StoredCandidates::open(&path).unwrap();
        assert_eq!(stored.level_count(), 3);
        for level in 1..3 {
            let found = stored.read(level, &Progress::silent()).unwrap();
            let [nx, ny, nz] = found.size;
            let edge = 1 << level;
            assert_eq!(found.size, size.map(|n: usize| n.div_ceil(edge)));
            for n in 0..nx * ny * nz {
                let [x, y, z] = [n / nz / ny, n / nz % ny, n % nz];
                let mut best = (BEYOND, 0);
                for fine in 0..edge * edge * edge {
                    let at = [x * edge + fine / edge / edge, y * edge + fine / edge % edge, z * edge + fine % edge];
                    if (0..3).all(|axis| at[axis] < size[axis]) {
                        let of = (at[0] * size[1] + at[1]) * size[2] + at[2];
                        if distance[of] != BEYOND {
                            best = best.min((distance[of], leaf[of]));
                        }
                    }
                }
                assert_eq!((found.distance[n], found.leaf[n]), best, "level {level}, {x} {y} {z}");
            }
        }
    }

    #[test]
    fn an_empty_forest_and_an_abandoned_write_leave_what_they_should() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("candidates.zarr");
        let silent = Progress::silent();
        let mut writer = CandidateWriter::create(&path, [2, 2, 3], 0).unwrap();
        writer.write_slab(0, &[BEYOND; 12], &[0; 12], &silent).unwrap();
        assert!(writer.write_slab(0, &[BEYOND; 11], &[0; 12], &silent).is_err());
        drop(writer);
        assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 0);
        let mut writer = CandidateWriter::create(&path, [2, 2, 3], 0).unwrap();
        writer.write_slab(0, &[BEYOND; 12], &[0; 12], &silent).unwrap();
        writer.finish(&info([2, 2, 3], 0), &ForestTables::default(), &silent).unwrap();
        let stored = StoredCandidates::open(&path).unwrap();
        assert_eq!(stored.read_forest(&silent).unwrap(), ForestTables::default());
    }
}
