//! Volumes on disk: `NAME.zarr`, a Zarr v3 group.
//!
//! | array | type | shape | what |
//! |---|---|---|---|
//! | `0` | the samples' own | `[inline][crossline][sample]` | the volume |
//! | `1`, `2`, … | the same | each half the one before, rounded up | the volume without what would alias; voxel m lies at m·2ᴸ |
//! | `live` | uint8 | `[inline][crossline]` | 1 = the trace was recorded |
//! | `minmax/0`, … | float32 | `[brick x][brick y][brick z][2]` | least and greatest sample of each 64³ brick, NaN where it has none |
//!
//! Geometry, quantity, unit, polarity and source are in the group's attribute `petroglyph`. The last level is the first that fits one brick.
//!
//! Writing takes the samples slab by slab (128 inlines at a time), so that a volume larger than memory can be stored. Memory while
//! writing: the slab, one shard (8 MiB of float32) a thread, and about 130 MiB for the levels, whatever the volume's size. A
//! volume that is in memory already is not copied. Reading: the box, and one layer of shards.

use super::array::{ArrayWriter, StoredArray, write_array, write_group};
use super::error::StoreError;
use super::header::{read_header, write_header};
use super::layout::{BRICK, Layout, gather, grid_index};
use super::pyramid::{halve, halved, needed};
use super::replacement::Replacement;
use super::sample::StoredSample;
use crate::geometry::SurveyGeometry;
use crate::progress::Progress;
use crate::volume::Volume;
use rayon::prelude::*;
use serde::{Deserialize, Serialize};
use std::borrow::Cow;
use std::ops::Range;
use std::path::{Path, PathBuf};

/// Kind of the group.
const KIND: &str = "volume";

/// What is known of a volume beside its samples.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct VolumeInfo {
    /// Its lattice.
    pub geometry: SurveyGeometry,
    /// What was measured: "amplitude", "acoustic impedance", …
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub quantity: Option<String>,
    /// Unit of the samples.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub unit: Option<String>,
    /// "normal" (SEG: more impedance below is positive) or "reverse".
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub polarity: Option<String>,
    /// Where it came from.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub source: Option<String>,
}

impl VolumeInfo {
    /// Nothing known but the lattice.
    pub fn of(geometry: SurveyGeometry) -> Self {
        Self { geometry, quantity: None, unit: None, polarity: None, source: None }
    }
}

/// A failure of whoever supplies samples.
pub type SourceError = Box<dyn std::error::Error + Send + Sync>;

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
    let slab = |lines: Range<usize>| Ok(Cow::Borrowed(&volume.samples()[lines.start * ny * nz..lines.end * ny * nz]));
    write_volume_slabs(path, volume.size(), volume.live(), info, slab, progress)
}

/// Stores a volume whose samples are supplied slab by slab: `slab` is asked for ranges of inlines in ascending order and answers
/// with their samples, `[inline][crossline][sample]`. `live` is the mask of recorded traces, `None` = all.
///
/// # Errors
/// [`StoreError`], [`StoreError::Source`] for what `slab` answers; `path` is then what it was before.
pub fn write_volume_slabs<'a, T: StoredSample>(
    path: &Path,
    size: [usize; 3],
    live: Option<&[bool]>,
    info: &VolumeInfo,
    slab: impl FnMut(Range<usize>) -> Result<Cow<'a, [T]>, SourceError>,
    progress: &Progress,
) -> Result<(), StoreError> {
    let fits = |what, expected: usize, found: usize| {
        if expected == found { Ok(()) } else { Err(StoreError::SizeMismatch { what, expected, found }) }
    };
    fits("the lattice", size.iter().product(), info.geometry.size().iter().product())?;
    let mut mask = match live {
        Some(live) => {
            fits("the live-trace mask", size[0] * size[1], live.len())?;
            live.to_vec()
        }
        None => vec![true; size[0] * size[1]],
    };
    let replacement = Replacement::of(path)?;
    let group = replacement.path();
    write_header(group, KIND, info)?;
    write_group(group, "minmax", serde_json::Map::new())?;
    let bytes: Vec<u8> = mask.iter().map(|&live| u8::from(live)).collect();
    write_array(group, "live", Layout::map([size[0], size[1]], ["inline", "crossline"]), 0, &bytes, progress)?;
    write_full(group, path, size, &mask, slab, progress)?;
    let (mut fine, mut level) = (size, 0);
    while fine.iter().any(|&n| n > BRICK) {
        level += 1;
        let coarse = halved(fine);
        let coarse_mask = every_second(&mask, [fine[0], fine[1]]);
        write_level::<T>(group, level, fine, &mask, &coarse_mask, progress)?;
        (fine, mask) = (coarse, coarse_mask);
    }
    replacement.commit()
}

/// Every second entry along both axes.
fn every_second(mask: &[bool], [nx, ny]: [usize; 2]) -> Vec<bool> {
    (0..nx).step_by(2).flat_map(|x| (0..ny).step_by(2).map(move |y| mask[x * ny + y])).collect()
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

    /// Takes in the finite samples of the live traces of a box of the volume; `at` is its first voxel, a multiple of the brick.
    fn take<T: StoredSample>(&mut self, samples: &[T], at: [usize; 3], size: [usize; 3], mask: &[bool], ny: usize) {
        for (n, trace) in samples.chunks(size[2].max(1)).enumerate() {
            let (x, y) = (at[0] + n / size[1], at[1] + n % size[1]);
            if !mask[x * ny + y] {
                continue;
            }
            for (b, part) in trace.chunks(BRICK).enumerate() {
                let index = ((x / BRICK) * self.counts[1] + y / BRICK) * self.counts[2] + at[2] / BRICK + b;
                let range = &mut self.ranges[index];
                for value in part {
                    // `min` and `max` pass over a NaN on either side.
                    let value = value.to_f32();
                    *range = [range[0].min(value), range[1].max(value)];
                }
            }
        }
    }

    fn write(&self, group: &Path, level: usize) -> Result<(), StoreError> {
        let [x, y, z] = self.counts;
        let layout = Layout::whole(&[x, y, z, 2], vec!["brick_inline", "brick_crossline", "brick_sample", "minmax"]);
        write_array(
            group,
            &format!("minmax/{level}"),
            layout,
            f32::NAN,
            self.ranges.as_flattened(),
            &Progress::silent(),
        )
    }
}

/// Writes level 0.
fn write_full<'a, T: StoredSample>(
    group: &Path,
    path: &Path,
    size: [usize; 3],
    mask: &[bool],
    mut slab: impl FnMut(Range<usize>) -> Result<Cow<'a, [T]>, SourceError>,
    progress: &Progress,
) -> Result<(), StoreError> {
    let writer = ArrayWriter::<T>::create(group, "0", Layout::volume(size), T::from_f32(0.0))?;
    let (edge, counts) = (writer.layout().file_shape().to_vec(), writer.layout().file_counts());
    let mut ranges = BrickRanges::of(size);
    progress.begin("storing the volume", counts.iter().product::<usize>() as u64);
    for x in 0..counts[0] {
        let lines = x * edge[0]..((x + 1) * edge[0]).min(size[0]);
        let samples = slab(lines.clone()).map_err(|source| StoreError::Source { path: path.to_owned(), source })?;
        let slab_size = [lines.len(), size[1], size[2]];
        let expected = slab_size.iter().product();
        if samples.len() != expected {
            return Err(StoreError::SizeMismatch { what: "a slab of samples", expected, found: samples.len() });
        }
        ranges.take(&samples, [lines.start, 0, 0], slab_size, mask, size[1]);
        (0..counts[1] * counts[2]).into_par_iter().try_for_each(|n| {
            let (y, z) = (n / counts[2], n % counts[2]);
            let shard = gather(&samples, &slab_size, &[0, y * edge[1], z * edge[2]], &edge);
            writer.write_shard(&[x, y, z], shard)?;
            Ok::<(), StoreError>(progress.step(1)?)
        })?;
    }
    ranges.write(group, 0)
}

/// Writes level `level` from the level before, of size `fine`.
fn write_level<T: StoredSample>(
    group: &Path,
    level: usize,
    fine: [usize; 3],
    fine_mask: &[bool],
    mask: &[bool],
    progress: &Progress,
) -> Result<(), StoreError> {
    let size = halved(fine);
    let source = StoredArray::open(group, &(level - 1).to_string())?;
    let writer = ArrayWriter::<T>::create(group, &level.to_string(), Layout::volume(size), T::from_f32(0.0))?;
    let (edge, counts) = (writer.layout().file_shape().to_vec(), writer.layout().file_counts());
    let count = counts.iter().product::<usize>();
    let mut ranges = BrickRanges::of(size);
    progress.begin(&format!("storing level {level}"), count as u64);
    // One shard at a time, each by all threads: memory stays bounded.
    for n in 0..count {
        let index = grid_index(n, &counts);
        let start = [0, 1, 2].map(|axis| index[axis] * edge[axis]);
        let part = [0, 1, 2].map(|axis| edge[axis].min(size[axis] - start[axis]));
        let need = [0, 1, 2].map(|axis| needed(start[axis], part[axis], fine[axis]));
        let (first, box_size) = (need.map(|n| n.0), need.map(|n| n.1));
        let samples = source.read_box::<T>(&first, &box_size)?;
        let values = live_values(&samples, first, box_size, fine_mask, fine[1]);
        drop(samples);
        let coarse: Vec<T> = halve(&values, box_size, first, start, part)
            .chunks(part[2])
            .enumerate()
            .flat_map(|(n, trace)| {
                let live = mask[(start[0] + n / part[1]) * size[1] + start[1] + n % part[1]];
                trace.iter().map(move |&value| T::from_f32(if live { value } else { 0.0 }))
            })
            .collect();
        ranges.take(&coarse, start, part, mask, size[1]);
        writer.write_shard(&index, gather(&coarse, &part, &[0; 3], &edge))?;
        progress.step(1)?;
    }
    ranges.write(group, level)
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

/// A volume on disk.
pub struct StoredVolume {
    path: PathBuf,
    info: VolumeInfo,
    levels: Vec<StoredArray>,
    live: Vec<bool>,
}

impl StoredVolume {
    /// Opens a volume; samples are read later. Memory: one byte a trace.
    ///
    /// # Errors
    /// [`StoreError`] when it is missing, of another kind, newer than this program or damaged.
    pub fn open(path: &Path) -> Result<Self, StoreError> {
        let info: VolumeInfo = read_header(path, KIND, "a volume")?;
        let mut levels = vec![StoredArray::open(path, "0")?];
        let damaged = |array: &str, reason: String| StoreError::Damaged {
            path: path.to_owned(),
            array: array.to_owned(),
            reason,
        };
        let full = info.geometry.size();
        if levels[0].shape() != full {
            return Err(damaged("0", format!("it has {:?}, the lattice {full:?}", levels[0].shape())));
        }
        let mut size = full;
        while size.iter().any(|&n| n > BRICK) {
            size = halved(size);
            let array = StoredArray::open(path, &levels.len().to_string())?;
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
        Ok(Self { path: path.to_owned(), info, levels, live })
    }

    /// What is known of it.
    pub fn info(&self) -> &VolumeInfo {
        &self.info
    }

    /// Where it is.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Count of levels, the full volume included.
    pub fn level_count(&self) -> usize {
        self.levels.len()
    }

    /// Voxels of a level.
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
    pub fn read<T: StoredSample>(&self, level: usize, progress: &Progress) -> Result<Volume<T>, StoreError> {
        let samples = self.array(level)?.read(progress)?;
        self.with_mask(level, [0; 3], self.size(level), samples)
    }

    /// A box of a level; `start` and `size` in voxels of that level.
    ///
    /// # Errors
    /// [`StoreError`], [`StoreError::OutOfBounds`] when the box is not inside the level.
    pub fn read_box<T: StoredSample>(
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
            return Err(StoreError::Damaged {
                path: self.path.clone(),
                array: format!("minmax/{level}"),
                reason: format!("it has {:?}", array.shape()),
            });
        }
        Ok((counts, ranges))
    }

    /// The array of a level.
    fn array(&self, level: usize) -> Result<&StoredArray, StoreError> {
        self.levels
            .get(level)
            .ok_or_else(|| StoreError::MissingArray { path: self.path.clone(), array: level.to_string() })
    }

    /// Adds the part of the mask that belongs to a box of a level.
    fn with_mask<T: StoredSample>(
        &self,
        level: usize,
        start: [usize; 3],
        size: [usize; 3],
        samples: Vec<T>,
    ) -> Result<Volume<T>, StoreError> {
        let mismatch = |error: crate::volume::SizeMismatch| StoreError::SizeMismatch {
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

/// Samples as floats.
fn as_f32<T: StoredSample>(samples: &[T]) -> Vec<f32> {
    samples.par_iter().map(|value| value.to_f32()).collect()
}
