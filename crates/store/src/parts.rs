//! A volume that several processes write together, each file by the process that it is assigned to: the bytes are those of
//! [`write_blocks`](super::write_blocks), whoever writes what, in whatever order and however often.
//!
//! ```text
//! create   header, mask, coordinates, the empty arrays of all levels, and the mark `unfinished`
//! write    a file of level 0 from its samples           any process, any order; returns the ranges of its bricks
//! halve    a file of a further level from the one before  after the files of that level that it reaches into
//! finish   the ranges of all bricks; the mark goes
//! ```
//!
//! A file has its name only when it is complete, and what was written twice is the same twice: a worker may be lost at
//! any moment, and its files are written again by another. Ranges are a set that is merged in any order. Memory: a file
//! (128³ samples) and its bytes; for a further level, what `LEVEL_BYTES` of `ingest` says. Every call works on one
//! thread.

use super::array::{StoredArray, create_volume, volume_grid};
use super::coordinates;
use super::error::StoreError;
use super::ingest::{LevelRoom, MARKER, every_second, is_unfinished, mask_of, write_frame, write_shard};
use super::layout::{BRICK, grid_index};
use super::pyramid::halved;
use super::ranges::{BrickRanges, IndexedRanges, SampleBox};
use super::sample::StoredSample;
use super::shard::{PARTIAL, ShardGrid, Shards};
use super::volume_info::VolumeInfo;
use std::fs;
use std::path::{Path, PathBuf};
use survey::progress::Progress;
use survey::sample::{Sample, SampleType};
use system::file::FileAction;

/// Calls a function for the type of samples that is only known while the program runs.
macro_rules! of_type {
    ($type:expr, $function:ident($($argument:expr),*)) => {
        match $type {
            SampleType::Int8 => $function::<i8>($($argument),*),
            SampleType::Uint8 => $function::<u8>($($argument),*),
            SampleType::Int16 => $function::<i16>($($argument),*),
            SampleType::Uint16 => $function::<u16>($($argument),*),
            SampleType::Int32 => $function::<i32>($($argument),*),
            SampleType::Uint32 => $function::<u32>($($argument),*),
            SampleType::Float32 => $function::<f32>($($argument),*),
        }
    };
}

/// A volume that is being written file by file.
#[derive(Debug)]
pub struct VolumeParts {
    path: PathBuf,
    sample_type: SampleType,
    /// Size and mask of each level.
    levels: Vec<([usize; 3], Vec<bool>)>,
}

impl VolumeParts {
    /// Begins a volume in a new folder. `live` is the mask `[inline][crossline]`; `None`: every trace is live.
    ///
    /// # Errors
    /// [`StoreError::Io`] when there is something at `path`; the disk is full or read-only; a mask of another size.
    pub fn create(
        path: &Path,
        info: &VolumeInfo,
        live: Option<&[bool]>,
        sample_type: SampleType,
    ) -> Result<Self, StoreError> {
        info.geometry.validate().map_err(|source| StoreError::Geometry { path: path.to_owned(), source })?;
        let parts = Self::of(path, info, mask_of(info.geometry.size(), live, info)?, sample_type);
        let fail = |source| StoreError::io(FileAction::Written, path, source);
        fs::create_dir(path).map_err(fail)?;
        fs::write(path.join(MARKER), "parts").map_err(fail)?;
        write_frame(path, info, &parts.levels[0].1, &Progress::silent())?;
        for (level, (size, _)) in parts.levels.iter().enumerate() {
            of_type!(sample_type, create_volume(path, level, *size, coordinates::attributes(level, info)))?;
        }
        Ok(parts)
    }

    /// Opens a volume that another process has begun.
    ///
    /// # Errors
    /// There is none, it is complete already, or its parts do not fit together.
    pub fn open(path: &Path) -> Result<Self, StoreError> {
        let info = VolumeInfo::read(path)?;
        info.geometry.validate().map_err(|source| StoreError::Geometry { path: path.to_owned(), source })?;
        if !is_unfinished(path) {
            return Err(StoreError::wrong_kind(path, "a volume that is being written", "it is complete"));
        }
        let size = info.geometry.size();
        // Its files are still to be written, so none of them may be there.
        let full = StoredArray::of_metadata(path, "0")?;
        let sample_type = type_of(path, &full)?;
        let live = StoredArray::open(path, "live")?.read::<u8>(&Progress::silent())?;
        let parts = Self::of(path, &info, live.into_iter().map(|live| live != 0).collect(), sample_type);
        if full.shape() != size || parts.levels[0].1.len() != size[0] * size[1] {
            return Err(StoreError::damaged(path, "0", format!("it has {:?}, the lattice {size:?}", full.shape())));
        }
        Ok(parts)
    }

    fn of(path: &Path, info: &VolumeInfo, mask: Vec<bool>, sample_type: SampleType) -> Self {
        let mut levels = vec![(info.geometry.size(), mask)];
        loop {
            let (size, mask) = &levels[levels.len() - 1];
            if size.iter().all(|&n| n <= BRICK) {
                return Self { path: path.to_owned(), sample_type, levels };
            }
            let next = (halved(*size), every_second(mask, [size[0], size[1]]));
            levels.push(next);
        }
    }

    /// The folder.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Type of the samples.
    pub fn sample_type(&self) -> SampleType {
        self.sample_type
    }

    /// Levels, the full volume included.
    pub fn level_count(&self) -> usize {
        self.levels.len()
    }

    /// Voxels of a level along each axis; `None` where there is no such level.
    pub fn size(&self, level: usize) -> Option<[usize; 3]> {
        self.levels.get(level).map(|(size, _)| *size)
    }

    /// Every file of a level, as its place among the files along each axis, its first voxel and its voxels.
    pub fn files(&self, level: usize) -> Vec<([usize; 3], [usize; 3], [usize; 3])> {
        let Some((size, _)) = self.levels.get(level) else { return Vec::new() };
        let grid = volume_grid(&self.path, level, *size);
        let counts = grid.counts();
        let place = |n: usize| -> [usize; 3] {
            let index = grid_index(n, &counts);
            [index[0], index[1], index[2]]
        };
        (0..counts.iter().product()).map(place).map(|at| (at, grid.extent(at).0, grid.extent(at).1)).collect()
    }

    /// Writes the file at `place` of level 0 from its samples, and returns the ranges of its bricks.
    ///
    /// # Errors
    /// Samples of another type or count, no such place, or the disk does not take it.
    pub fn write<T: StoredSample + Sample>(
        &self,
        place: [usize; 3],
        samples: &[T],
    ) -> Result<IndexedRanges, StoreError> {
        if T::TYPE != self.sample_type {
            return Err(StoreError::WrongType {
                path: self.path.clone(),
                array: "0".to_owned(),
                expected: self.sample_type.name(),
                found: T::NAME.to_owned(),
            });
        }
        let grid = self.grid(0, place)?;
        let (first, size) = grid.extent(place);
        let expected = size.iter().product();
        if samples.len() != expected {
            return Err(StoreError::SizeMismatch { what: "a file of the volume", expected, found: samples.len() });
        }
        write_shard(&grid, place, &SampleBox { values: samples, first, size }, &self.levels[0].1, &mut Vec::new())
    }

    /// Makes the file at `place` of a further level from the level before, and returns the ranges of its bricks.
    ///
    /// # Errors
    /// No such place, a file of the level before is missing or damaged, or the disk does not take it.
    pub fn halve(&self, level: usize, place: [usize; 3]) -> Result<IndexedRanges, StoreError> {
        of_type!(self.sample_type, halve_as(self, level, place))
    }

    /// Completes the volume, of which `ranges` are those of every level's bricks, merged in any order.
    ///
    /// # Errors
    /// A file was not written, or the disk does not take it.
    pub fn finish(self, ranges: Vec<IndexedRanges>) -> Result<(), StoreError> {
        let fail = |source| StoreError::io(FileAction::Written, &self.path, source);
        let mut ranges = ranges.into_iter();
        for (level, (size, _)) in self.levels.iter().enumerate() {
            let grid = volume_grid(&self.path, level, *size);
            for (place, ..) in self.files(level) {
                let [x, y, z] = place;
                let row = grid.folder.join(format!("c/{x}/{y}"));
                if !row.join(z.to_string()).is_file() {
                    return Err(StoreError::Unfinished { path: self.path.clone() });
                }
                // What a lost worker left behind.
                for entry in fs::read_dir(&row).map_err(fail)? {
                    let path = entry.map_err(fail)?.path();
                    if path.extension().is_some_and(|ending| ending == PARTIAL) {
                        fs::remove_file(path).map_err(fail)?;
                    }
                }
            }
            let mut all = BrickRanges::of(*size);
            let bricks: usize = size.iter().map(|n| n.div_ceil(BRICK)).product();
            all.take(ranges.next().unwrap_or_default().into_iter().filter(|(brick, _)| *brick < bricks).collect());
            all.write(&self.path, level)?;
        }
        system::file::sync_folder(&self.path).map_err(fail)?;
        fs::remove_file(self.path.join(MARKER)).map_err(fail)
    }

    /// The division of a level into files, of which `place` is one.
    fn grid(&self, level: usize, place: [usize; 3]) -> Result<ShardGrid, StoreError> {
        let (size, _) = self
            .levels
            .get(level)
            .ok_or_else(|| StoreError::MissingArray { path: self.path.clone(), array: level.to_string() })?;
        let grid = ShardGrid { beside_others: true, ..volume_grid(&self.path, level, *size) };
        let counts = grid.counts();
        if (0..3).any(|axis| place[axis] >= counts[axis]) {
            return Err(StoreError::OutOfBounds {
                path: self.path.clone(),
                array: format!("{level}, counted in files,"),
                start: place.into(),
                size: vec![1; 3],
                shape: counts.into(),
            });
        }
        Ok(grid)
    }
}

/// The type of an array's samples.
fn type_of(path: &Path, array: &StoredArray) -> Result<SampleType, StoreError> {
    use SampleType::{Float32, Int8, Int16, Int32, Uint8, Uint16, Uint32};
    let name = array.type_name();
    let known = [Int8, Uint8, Int16, Uint16, Int32, Uint32, Float32].into_iter().find(|known| known.name() == name);
    known.ok_or(StoreError::WrongType {
        path: path.to_owned(),
        array: "0".to_owned(),
        expected: "numbers of up to four bytes",
        found: name,
    })
}

fn halve_as<T: StoredSample + Sample>(
    parts: &VolumeParts,
    level: usize,
    place: [usize; 3],
) -> Result<IndexedRanges, StoreError> {
    let finer = level
        .checked_sub(1)
        .ok_or_else(|| StoreError::MissingArray { path: parts.path.clone(), array: "a level before 0".to_owned() })?;
    let grid = parts.grid(level, place)?;
    let ((fine_size, fine_mask), (size, mask)) = (&parts.levels[finer], &parts.levels[level]);
    let source = Shards::new(volume_grid(&parts.path, finer, *fine_size), &parts.path, &finer.to_string());
    let (start, part) = grid.extent(place);
    let mut room = LevelRoom::<T>::default();
    room.fill(&source, [*fine_size, *size], [start, part], [fine_mask, mask])?;
    let samples = SampleBox { values: &room.coarse, first: start, size: part };
    write_shard(&grid, place, &samples, mask, &mut room.bytes)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{StoredVolume, write_volume};
    use std::collections::BTreeMap;
    use survey::{SurveyGeometry, VerticalUnit, Volume};

    fn contents(folder: &Path, of: &Path, found: &mut BTreeMap<PathBuf, Vec<u8>>) {
        for path in fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path()) {
            if path.is_dir() {
                contents(&path, of, found);
            } else {
                found.insert(path.strip_prefix(of).unwrap().to_owned(), fs::read(&path).unwrap());
            }
        }
    }

    #[test]
    fn files_written_by_anyone_in_any_order_are_the_volume_written_at_once() {
        let folder = tempfile::tempdir().unwrap();
        let size = [133, 70, 260];
        let count: usize = size.iter().product();
        let samples: Vec<i16> = (0..count).map(|n| (n * 7919 % 20011) as i16 - 9000).collect();
        let mut volume = Volume::from_samples(size, samples).unwrap();
        let live: Vec<bool> = (0..size[0] * size[1]).map(|n| n % 53 != 7).collect();
        volume.set_live(Some(live.clone())).unwrap();
        let info = VolumeInfo::of(SurveyGeometry::regular(size, 25.0, 4.0, VerticalUnit::Metres));
        let (whole, parted) = (folder.path().join("whole.zarr"), folder.path().join("parted.zarr"));
        write_volume(&whole, &volume, &info, &Progress::silent()).unwrap();

        let parts = VolumeParts::create(&parted, &info, Some(&live), SampleType::Int16).unwrap();
        assert!(matches!(StoredVolume::open(&parted), Err(StoreError::Unfinished { .. })));
        let mut ranges = vec![Vec::new(); parts.level_count()];
        for (level, ranges) in ranges.iter_mut().enumerate() {
            let mut files = parts.files(level);
            files.reverse();
            // One is written twice, and a lost worker has left a piece of another.
            files.push(files[0]);
            for (place, start, part) in files {
                let worker = VolumeParts::open(&parted).unwrap();
                let found = if level == 0 {
                    let trace = |x: usize, y: usize| volume.trace(x, y)[start[2]..start[2] + part[2]].to_vec();
                    let places = (start[0]..start[0] + part[0])
                        .flat_map(|x| (start[1]..start[1] + part[1]).map(move |y| (x, y)));
                    worker.write::<i16>(place, &places.flat_map(|(x, y)| trace(x, y)).collect::<Vec<_>>()).unwrap()
                } else {
                    worker.halve(level, place).unwrap()
                };
                ranges.extend(found);
            }
        }
        fs::write(parted.join("0/c/0/0/1.77.part"), "half").unwrap();
        parts.finish(ranges).unwrap();
        let (mut one, mut other) = (BTreeMap::new(), BTreeMap::new());
        contents(&whole, &whole, &mut one);
        contents(&parted, &parted, &mut other);
        assert_eq!(one.keys().collect::<Vec<_>>(), other.keys().collect::<Vec<_>>());
        assert!(one == other, "the same bytes");
        assert!(StoredVolume::open(&parted).unwrap().verify(&Progress::silent()).is_ok());
    }

    #[test]
    fn a_volume_of_many_files_is_opened_before_any_is_written() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.zarr");
        let size = [300, 270, 400];
        let info = VolumeInfo::of(SurveyGeometry::regular(size, 25.0, 4.0, VerticalUnit::Metres));
        VolumeParts::create(&path, &info, None, SampleType::Float32).unwrap();
        let worker = VolumeParts::open(&path).unwrap();
        assert_eq!((worker.size(0), worker.files(0).len()), (Some(size), 36));
        assert!(StoredVolume::open(&path).is_err(), "it is no volume yet");
    }

    #[test]
    fn what_does_not_fit_is_refused_and_a_missing_file_is_noticed() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.zarr");
        let info = VolumeInfo::of(SurveyGeometry::regular([3, 4, 5], 25.0, 4.0, VerticalUnit::Metres));
        assert!(matches!(VolumeParts::open(&path), Err(StoreError::Missing { .. })));
        assert!(VolumeParts::create(&path, &info, Some(&[true]), SampleType::Float32).is_err());
        assert!(!path.exists(), "nothing half-written");
        let parts = VolumeParts::create(&path, &info, None, SampleType::Float32).unwrap();
        assert!(VolumeParts::create(&path, &info, None, SampleType::Float32).is_err());
        assert!(matches!(parts.write([0; 3], &[1.0f32; 7]), Err(StoreError::SizeMismatch { .. })));
        assert!(matches!(parts.write([0, 0, 0], &[1i16; 60]), Err(StoreError::WrongType { .. })));
        assert!(matches!(parts.write([1, 0, 0], &[1.0f32; 60]), Err(StoreError::OutOfBounds { .. })));
        assert!(parts.halve(1, [0; 3]).is_err());
        let unfinished = VolumeParts::open(&path).unwrap();
        assert!(matches!(unfinished.finish(Vec::new()), Err(StoreError::Unfinished { .. })));
        let found = parts.write([0, 0, 0], &[1.0f32; 60]).unwrap();
        assert_eq!(found, [(0, [1.0, 1.0])]);
        parts.finish(vec![found]).unwrap();
        assert!(matches!(VolumeParts::open(&path), Err(StoreError::WrongKind { .. })));
    }
}
