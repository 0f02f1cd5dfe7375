//! Volumes on disk: `NAME.zarr`, a Zarr v3 group.
//!
//! | array | type | shape | what |
//! |---|---|---|---|
//! | `0` | the samples' own | `[inline][crossline][sample]` | the volume |
//! | `1`, `2`, … | the same | each half the one before, rounded up | the volume, low-passed against aliasing; voxel m lies at m·2ᴸ |
//! | `live` | uint8 | `[inline][crossline]` | 1 = the trace was recorded |
//! | `inline`, `crossline`, `sample`, `cdp_x`, `cdp_y` | int32, float64 | one axis; `cdp_x` and `cdp_y` `[inline][crossline]` | coordinates, for programs that label arrays (see `coordinates`) |
//! | `minmax/0`, … | float32 | `[brick x][brick y][brick z][2]` | least and greatest sample of each 64³ brick, NaN where it has none |
//!
//! Geometry, quantity, unit, polarity and source are in the group's attribute `petroglyph`. The last level is
//! the first that fits one brick.
//!
//! The live mask of level L is every 2ᴸth entry of `live`. The module `ingest` writes volumes, and `shard`
//! defines how samples are laid out in files. An inline, a crossline or a box costs about what its own samples
//! cost, a time slice all bricks that it touches. Whatever is read is verified by checksums, and damage is an
//! error that names the file and the brick.

use super::array::StoredArray;
use super::coordinates;
use super::error::StoreError;
use super::ingest::is_unfinished;
use super::layout::BRICK;
use super::object_storage;
use super::pyramid::halved;
use super::sample::StoredSample;
use super::verify::DamageFindings;
use super::volume_info::VolumeInfo;
use rayon::prelude::*;
use std::ops::Range;
use std::path::{Path, PathBuf};
use survey::geometry::SurveyGeometry;
use survey::progress::Progress;
use survey::sample::Sample;
use survey::source::{BoxSource, SlabSource, SourceError};
use survey::volume::Volume;

/// A volume on disk.
pub struct StoredVolume {
    path: PathBuf,
    info: VolumeInfo,
    levels: Vec<StoredArray>,
    live: Vec<bool>,
    /// Where its bricks lie, if not beside the rest.
    link: Option<object_storage::Link>,
}

impl StoredVolume {
    /// Opens a volume; samples are read later. Memory: one byte per trace.
    ///
    /// # Errors
    /// [`StoreError`] when it is missing, of another kind, newer than this program or damaged.
    pub fn open(path: &Path) -> Result<Self, StoreError> {
        if is_unfinished(path) {
            return Err(StoreError::Unfinished { path: path.to_owned() });
        }
        let info = VolumeInfo::read(path)?;
        info.geometry.validate().map_err(|source| StoreError::Geometry { path: path.to_owned(), source })?;
        let link = object_storage::Link::read(path)?;
        let array = |name: &str| match &link {
            Some(link) => StoredArray::open_linked(path, name, link.files(name)?),
            None => StoredArray::open(path, name),
        };
        let mut levels = vec![array("0")?];
        let damaged = |array: &str, reason: String| StoreError::damaged(path, array, reason);
        let full = info.geometry.size();
        if levels[0].shape() != full {
            return Err(damaged("0", format!("it has {:?}, the lattice {full:?}", levels[0].shape())));
        }
        let mut size = full;
        while size.iter().any(|&n| n > BRICK) {
            size = halved(size);
            let array = array(&levels.len().to_string())?;
            if array.shape() != size {
                return Err(damaged(&levels.len().to_string(), format!("it has {:?}, not {size:?}", array.shape())));
            }
            levels.push(array);
        }
        let mask = StoredArray::open(path, "live")?;
        if mask.shape() != [full[0], full[1]] {
            return Err(damaged("live", format!("it has {:?}", mask.shape())));
        }
        let live = mask.read::<u8>(&Progress::silent())?.into_iter().map(|live| live != 0).collect();
        Ok(Self { path: path.to_owned(), info, levels, live, link })
    }

    /// Facts about the volume.
    pub fn info(&self) -> &VolumeInfo {
        &self.info
    }

    /// The path of the volume.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Whether its bricks lie in object storage.
    pub fn is_linked(&self) -> bool {
        self.link.is_some()
    }

    /// Where its bricks lie in object storage.
    #[cfg(feature = "remote")]
    pub(super) fn linked_url(&self) -> Option<&str> {
        self.link.as_ref().map(object_storage::Link::url)
    }

    /// Count of levels, the full volume included.
    pub fn level_count(&self) -> usize {
        self.levels.len()
    }

    /// Count of voxels of a level along each axis.
    ///
    /// # Panics
    /// When there is no such level.
    pub fn size(&self, level: usize) -> [usize; 3] {
        let shape = self.levels[level].shape();
        [shape[0], shape[1], shape[2]]
    }

    /// The lattice of a level: every 2ᴸth line and sample.
    pub fn geometry(&self, level: usize) -> SurveyGeometry {
        let mut geometry = self.info.geometry.clone();
        let step = 1usize << level;
        let size = self.size(level);
        geometry.inlines.step *= step as i32;
        geometry.crosslines.step *= step as i32;
        geometry.inline_vector *= step as f64;
        geometry.crossline_vector *= step as f64;
        geometry.vertical.interval *= step as f64;
        (geometry.inlines.count, geometry.crosslines.count, geometry.vertical.count) = (size[0], size[1], size[2]);
        geometry
    }

    /// Type of the samples as Zarr spells it: `float32`, `int16`, …
    pub fn type_name(&self) -> String {
        self.levels[0].type_name()
    }

    /// A whole level.
    ///
    /// # Errors
    /// [`StoreError`], [`StoreError::WrongType`] when the samples are not `T`s.
    pub fn read<T: StoredSample + Sample>(&self, level: usize, progress: &Progress) -> Result<Volume<T>, StoreError> {
        let samples = self.array(level)?.read(progress)?;
        self.with_mask(level, [0; 3], self.size(level), samples)
    }

    /// A box of a level; `start` and `size` in voxels of that level.
    ///
    /// # Errors
    /// [`StoreError`], [`StoreError::OutOfBounds`] when the box is not inside the level.
    pub fn read_box<T: StoredSample + Sample>(
        &self,
        level: usize,
        start: [usize; 3],
        size: [usize; 3],
    ) -> Result<Volume<T>, StoreError> {
        let samples = self.array(level)?.read_box(&start, &size)?;
        self.with_mask(level, start, size, samples)
    }

    /// A box of a level as floats, whatever the samples' type.
    ///
    /// # Errors
    /// [`StoreError`].
    pub fn read_box_f32(&self, level: usize, start: [usize; 3], size: [usize; 3]) -> Result<Volume<f32>, StoreError> {
        let array = self.array(level)?;
        let samples = match array.type_name().as_str() {
            "int8" => as_f32(&array.read_box::<i8>(&start, &size)?),
            "uint8" => as_f32(&array.read_box::<u8>(&start, &size)?),
            "int16" => as_f32(&array.read_box::<i16>(&start, &size)?),
            "uint16" => as_f32(&array.read_box::<u16>(&start, &size)?),
            "int32" => as_f32(&array.read_box::<i32>(&start, &size)?),
            "uint32" => as_f32(&array.read_box::<u32>(&start, &size)?),
            _ => array.read_box::<f32>(&start, &size)?,
        };
        self.with_mask(level, start, size, samples)
    }

    /// A whole level as floats, whatever the samples' type.
    ///
    /// # Errors
    /// [`StoreError`].
    pub fn read_f32(&self, level: usize, progress: &Progress) -> Result<Volume<f32>, StoreError> {
        if self.array(level)?.holds::<f32>() {
            return self.read(level, progress);
        }
        self.read_box_f32(level, [0; 3], self.size(level))
    }

    /// Checksums of the samples of level 0, brick by brick, which change when the samples do. They are read
    /// from the files and not computed. Of a linked volume they are those of what was linked, which is compared when
    /// it is opened.
    ///
    /// # Errors
    /// [`StoreError`] when a file is missing or damaged.
    pub fn checksums(&self) -> Result<Vec<u32>, StoreError> {
        if let Some(link) = &self.link {
            return Ok(link.checksums());
        }
        let array = self.array(0)?;
        let of = |sums: Option<Result<Vec<u32>, StoreError>>| sums.unwrap_or(Ok(Vec::new()));
        match array.type_name().as_str() {
            "int8" | "uint8" => of(array.shards().map(|shards| shards.checksums::<u8>())),
            "int16" | "uint16" => of(array.shards().map(|shards| shards.checksums::<u16>())),
            _ => of(array.shards().map(|shards| shards.checksums::<f32>())),
        }
    }

    /// Live traces, `[inline][crossline]`, of level 0.
    pub fn live(&self) -> &[bool] {
        &self.live
    }

    /// The mask of live traces of a level; `None` where all are live.
    pub fn live_at(&self, level: usize) -> Option<Vec<bool>> {
        let ([nx, ny, _], full_y) = (self.size(level), self.info.geometry.crosslines.count);
        let at = |n: usize| self.live[((n / ny) << level) * full_y + ((n % ny) << level)];
        let mask: Vec<bool> = (0..nx * ny).map(at).collect();
        mask.contains(&false).then_some(mask)
    }

    /// Least and greatest sample of each 64³ brick of a level, and the counts of bricks: `[x][y][z]`.
    ///
    /// # Errors
    /// [`StoreError`].
    pub fn brick_ranges(&self, level: usize) -> Result<([usize; 3], Vec<[f32; 2]>), StoreError> {
        let array = StoredArray::open(&self.path, &format!("minmax/{level}"))?;
        let counts = self.size(level).map(|n| n.div_ceil(BRICK));
        let values = array.read::<f32>(&Progress::silent())?;
        let ranges: Vec<[f32; 2]> = values.as_chunks::<2>().0.to_vec();
        if ranges.len() != counts.iter().product::<usize>() {
            return Err(StoreError::damaged(
                &self.path,
                &format!("minmax/{level}"),
                format!("it has {:?}", array.shape()),
            ));
        }
        Ok((counts, ranges))
    }

    /// Reads all of it, every level, the mask and the ranges of bricks, and verifies every checksum. Memory: one file
    /// for each thread.
    ///
    /// # Errors
    /// [`StoreError::Damaged`] with all that is missing or damaged, of which the first is named; or cancelled.
    ///
    /// Of a linked volume only what lies here is read.
    pub fn verify(&self, progress: &Progress) -> Result<(), StoreError> {
        let mut findings = DamageFindings::default();
        if self.link.is_none() {
            self.levels.iter().try_for_each(|array| array.find_damage(&mut findings, progress))?;
        }
        StoredArray::open(&self.path, "live")?.find_damage(&mut findings, progress)?;
        coordinates::stored(&self.path)?.iter().try_for_each(|array| array.find_damage(&mut findings, progress))?;
        findings.into_result(&self.path)?;
        (0..self.levels.len()).try_for_each(|level| self.brick_ranges(level).map(drop))
    }

    /// The array of a level.
    fn array(&self, level: usize) -> Result<&StoredArray, StoreError> {
        self.levels
            .get(level)
            .ok_or_else(|| StoreError::MissingArray { path: self.path.clone(), array: level.to_string() })
    }

    /// Adds the part of the mask that belongs to a box of a level.
    fn with_mask<T: StoredSample + Sample>(
        &self,
        level: usize,
        start: [usize; 3],
        size: [usize; 3],
        samples: Vec<T>,
    ) -> Result<Volume<T>, StoreError> {
        let mismatch = |error: survey::volume::SizeMismatch| StoreError::SizeMismatch {
            what: "the box",
            expected: error.expected,
            found: error.found,
        };
        let mut volume = Volume::from_samples(size, samples).map_err(mismatch)?;
        let full_y = self.info.geometry.crosslines.count;
        let live_at = |x: usize, y: usize| self.live[(x << level) * full_y + (y << level)];
        let columns = |x: usize| (start[1]..start[1] + size[1]).map(move |y| live_at(x, y));
        let mask: Vec<bool> = (start[0]..start[0] + size[0]).flat_map(columns).collect();
        if mask.contains(&false) {
            volume.set_live(Some(mask)).map_err(mismatch)?;
        }
        Ok(volume)
    }
}

impl SlabSource for StoredVolume {
    type Error = StoreError;

    fn size(&self) -> [usize; 3] {
        Self::size(self, 0)
    }

    fn read(&self, inlines: Range<usize>, visit: &mut dyn FnMut(usize, usize, &[f32])) -> Result<(), StoreError> {
        let [_, ny, nz] = Self::size(self, 0);
        let slab = self.read_box_f32(0, [inlines.start, 0, 0], [inlines.len(), ny, nz])?;
        for x in 0..inlines.len() {
            for y in 0..ny {
                if slab.is_live(x, y) {
                    visit(inlines.start + x, y, slab.trace(x, y));
                }
            }
        }
        Ok(())
    }
}

impl BoxSource for StoredVolume {
    fn size(&self) -> [usize; 3] {
        Self::size(self, 0)
    }

    fn live(&self) -> Option<&[bool]> {
        Some(Self::live(self))
    }

    fn read_box(&self, start: [usize; 3], size: [usize; 3]) -> Result<Volume<f32>, SourceError> {
        Ok(self.read_box_f32(0, start, size)?)
    }
}

/// Samples as floats.
fn as_f32<T: StoredSample + Sample>(samples: &[T]) -> Vec<f32> {
    samples.par_iter().map(|value| value.to_f32()).collect()
}
