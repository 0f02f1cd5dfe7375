//! Parameterizations on disk: `parameterization.zarr`, a Zarr v3 group. Its arrays are `i`, `j`, `k`
//! (float32, unpacked, NaN outside) and `layer`, `block` (uint8, or uint16 where an id needs it; all ones =
//! none), all `[inline][crossline][sample]`.
//!
//! Memory: 16 bytes per voxel for the volumes themselves, or for the box that is written at a time, one shard per thread
//! while writing, and one layer of shards while reading.

use super::array::{APART, ArrayWriter, StoredArray, new_apart};
use super::error::StoreError;
use super::header::{read_header, write_header};
use super::layout::{ArrayLayout, gather, grid_index};
use super::replacement::Replacement;
use rayon::prelude::*;
use serde::{Deserialize, Serialize};
use std::path::{Path, PathBuf};
use survey::progress::Progress;
use survey::volume::Volume;

/// The id that stands for "none".
pub(crate) const NO_ID: u16 = u16::MAX;

/// Kind of the group.
const KIND: &str = "parameterization";

/// Its arrays.
const ARRAYS: [&str; 5] = ["i", "j", "k", "layer", "block"];

/// Facts of a parameterization.
#[derive(Serialize, Deserialize)]
struct ParameterizationHeader {
    size: [usize; 3],
    key: String,
}

/// i, j, k, layer and block for each voxel.
#[derive(Debug, Clone, PartialEq)]
pub struct ParameterizationVolumes {
    /// i; NaN outside.
    pub i: Volume<f32>,
    /// j; NaN outside.
    pub j: Volume<f32>,
    /// k, 0 on a layer's bottom and 1 on its top; NaN outside.
    pub k: Volume<f32>,
    /// Layer, 0 = deepest; `u16::MAX` = none.
    pub layer: Volume<u16>,
    /// Fault block; `u16::MAX` = none.
    pub block: Volume<u16>,
}

/// Stores a parameterization; `key` identifies the input that it was computed from.
///
/// # Errors
/// [`StoreError`], [`StoreError::SizeMismatch`] when the volumes differ in size; `path` is then what it was
/// before.
pub fn write_parameterization(
    path: &Path,
    volumes: &ParameterizationVolumes,
    key: &str,
    progress: &Progress,
) -> Result<(), StoreError> {
    let replacement = Replacement::of(path)?;
    let counts = [&volumes.layer, &volumes.block].map(|ids| {
        let most = ids.samples().iter().filter(|&&id| id != NO_ID).max();
        most.map_or(0, |&most| usize::from(most) + 1)
    });
    let writer = ParameterizationWriter::create(replacement.path(), volumes.i.size(), counts, key)?;
    progress.begin("writing i, j, k", writer.file_counts().iter().product::<usize>() as u64);
    writer.write([0; 3], volumes, progress)?;
    replacement.commit()
}

/// A parameterization that is being written in boxes of whole files, by one process or several: the bytes are the same
/// whatever the boxes and whoever writes them.
///
/// Memory: a file of an array for each thread, before and after compression.
pub struct ParameterizationWriter {
    group: PathBuf,
    size: [usize; 3],
    layout: ArrayLayout,
    fields: [ArrayWriter<f32>; 3],
    ids: [IdWriter; 2],
    /// Folder for files that are not complete, where other processes write, too.
    apart: Option<PathBuf>,
}

/// Layers or blocks, in one byte where they fit.
enum IdWriter {
    Narrow(ArrayWriter<u8>),
    Wide(ArrayWriter<u16>),
}

impl ParameterizationWriter {
    /// Begins one in the folder `group`, of so many layers and fault blocks.
    ///
    /// # Errors
    /// The disk does not take it.
    pub fn create(group: &Path, size: [usize; 3], counts: [usize; 2], key: &str) -> Result<Self, StoreError> {
        write_header(group, KIND, &ParameterizationHeader { size, key: key.to_owned() })?;
        let layout = ArrayLayout::volume(size);
        let field = |name| ArrayWriter::create(group, name, layout.clone(), f32::NAN);
        let ids = |name, count| -> Result<IdWriter, StoreError> {
            Ok(if count <= usize::from(u8::MAX) {
                IdWriter::Narrow(ArrayWriter::create(group, name, layout.clone(), u8::MAX)?)
            } else {
                IdWriter::Wide(ArrayWriter::create(group, name, layout.clone(), NO_ID)?)
            })
        };
        let fields = [field("i")?, field("j")?, field("k")?];
        let ids = [ids("layer", counts[0])?, ids("block", counts[1])?];
        Ok(Self { group: group.to_owned(), size, layout, fields, ids, apart: None })
    }

    /// One that was begun, to write some of its files while other processes write others.
    ///
    /// # Errors
    /// It was not begun, or its metadata are damaged.
    pub fn open(group: &Path) -> Result<Self, StoreError> {
        let ParameterizationHeader { size, .. } = read_header(group, KIND, "a parameterization")?;
        let (layout, apart) = (ArrayLayout::volume(size), new_apart(group));
        let field = |name| ArrayWriter::of_created(group, name, layout.clone(), f32::NAN, Some(&apart));
        let ids = |name| -> Result<IdWriter, StoreError> {
            Ok(if StoredArray::of_metadata(group, name)?.holds::<u8>() {
                IdWriter::Narrow(ArrayWriter::of_created(group, name, layout.clone(), u8::MAX, Some(&apart))?)
            } else {
                IdWriter::Wide(ArrayWriter::of_created(group, name, layout.clone(), NO_ID, Some(&apart))?)
            })
        };
        let fields = [field("i")?, field("j")?, field("k")?];
        let ids = [ids("layer")?, ids("block")?];
        Ok(Self { group: group.to_owned(), size, layout, fields, ids, apart: Some(apart) })
    }

    /// Samples along each axis.
    pub fn size(&self) -> [usize; 3] {
        self.size
    }

    /// Files of an array along each axis.
    pub fn file_counts(&self) -> [usize; 3] {
        let counts = self.layout.file_counts();
        [counts[0], counts[1], counts[2]]
    }

    /// Samples of a file along each axis.
    pub fn file_shape(&self) -> [usize; 3] {
        let shape = self.layout.file_shape();
        [shape[0], shape[1], shape[2]]
    }

    /// Where the box of `files` files from file `place` begins, and its samples, cut at the end of the arrays.
    pub fn samples_of(&self, place: [usize; 3], files: [usize; 3]) -> ([usize; 3], [usize; 3]) {
        let (edge, size) = (self.file_shape(), self.size);
        let start: [usize; 3] = std::array::from_fn(|axis| place[axis] * edge[axis]);
        let part = |axis: usize| (files[axis] * edge[axis]).min(size[axis].saturating_sub(start[axis]));
        (start, std::array::from_fn(part))
    }

    /// Writes a box of whole files whose first one is at `place` among the files, in parallel; `progress` takes a step for
    /// each file.
    ///
    /// # Errors
    /// The volumes are no such box, the disk does not take them, or the user cancelled.
    pub fn write(
        &self,
        place: [usize; 3],
        volumes: &ParameterizationVolumes,
        progress: &Progress,
    ) -> Result<(), StoreError> {
        let (found, edge) = (volumes.i.size(), self.file_shape());
        let files: [usize; 3] = std::array::from_fn(|axis| found[axis].div_ceil(edge[axis]));
        let (_, expected) = self.samples_of(place, files);
        let sizes = [volumes.j.size(), volumes.k.size(), volumes.layer.size(), volumes.block.size()];
        if let Some(wrong) = sizes.into_iter().chain([found]).find(|&size| size != expected) {
            let [expected, found] = [expected, wrong].map(|size| size.iter().product());
            return Err(StoreError::SizeMismatch { what: "a box of the parameterization", expected, found });
        }
        let count: usize = files.iter().product();
        let arrays = self.fields.len() + self.ids.len();
        (0..count * arrays).into_par_iter().try_for_each(|n| {
            progress.check()?;
            let (array, inside) = (n % arrays, grid_index(n / arrays, &files));
            let index: [usize; 3] = std::array::from_fn(|axis| place[axis] + inside[axis]);
            let start: [usize; 3] = std::array::from_fn(|axis| inside[axis] * edge[axis]);
            match array {
                0 => self.fields[0].write_shard(&index, gather(volumes.i.samples(), &found, &start, &edge))?,
                1 => self.fields[1].write_shard(&index, gather(volumes.j.samples(), &found, &start, &edge))?,
                2 => self.fields[2].write_shard(&index, gather(volumes.k.samples(), &found, &start, &edge))?,
                3 => self.ids[0].write_shard(&index, gather(volumes.layer.samples(), &found, &start, &edge))?,
                _ => self.ids[1].write_shard(&index, gather(volumes.block.samples(), &found, &start, &edge))?,
            }
            if array + 1 == arrays { Ok(progress.step(1)?) } else { Ok(()) }
        })
    }

    /// Makes sure that every file was written, and removes what lost processes left.
    ///
    /// # Errors
    /// [`StoreError::Unfinished`].
    pub fn finish(&self) -> Result<(), StoreError> {
        let counts = self.file_counts();
        for n in 0..counts.iter().product() {
            let key = grid_index(n, &counts).iter().map(usize::to_string).collect::<Vec<_>>().join("/");
            if !ARRAYS.iter().all(|array| self.group.join(array).join("c").join(&key).is_file()) {
                return Err(StoreError::Unfinished { path: self.group.clone() });
            }
        }
        let _ = std::fs::remove_dir_all(self.group.join(APART));
        Ok(())
    }
}

impl Drop for ParameterizationWriter {
    fn drop(&mut self) {
        if let Some(apart) = &self.apart {
            // What cannot be removed now is removed at the end.
            let _ = std::fs::remove_dir_all(apart);
        }
    }
}

impl IdWriter {
    fn write_shard(&self, index: &[usize], ids: Vec<u16>) -> Result<(), StoreError> {
        match self {
            // The low byte of "none" is "none".
            Self::Narrow(writer) => writer.write_shard(index, ids.iter().map(|&id| id as u8).collect()),
            Self::Wide(writer) => writer.write_shard(index, ids),
        }
    }
}

/// A parameterization on disk.
pub struct StoredParameterization {
    header: ParameterizationHeader,
    fields: [StoredArray; 3],
    ids: [StoredArray; 2],
}

impl StoredParameterization {
    /// Opens a parameterization; values are read later.
    ///
    /// # Errors
    /// [`StoreError`] when it is missing, of another kind, newer than this program or damaged.
    pub fn open(path: &Path) -> Result<Self, StoreError> {
        let header: ParameterizationHeader = read_header(path, KIND, "a parameterization")?;
        let open = |name: &str| {
            let array = StoredArray::open(path, name)?;
            if array.shape() != header.size {
                return Err(StoreError::damaged(
                    path,
                    name,
                    format!("it has {:?}, not {:?}", array.shape(), header.size),
                ));
            }
            Ok(array)
        };
        Ok(Self { fields: [open("i")?, open("j")?, open("k")?], ids: [open("layer")?, open("block")?], header })
    }

    /// Opens a group that another program wrote: arrays `i`, `j`, `k` (float32) and `layer`, `block` (uint8 or uint16),
    /// all of one size; values are read later.
    ///
    /// # Errors
    /// [`StoreError`] when an array is missing, damaged, or of another size than `i`.
    pub fn open_foreign(path: &Path) -> Result<Self, StoreError> {
        let wrong = |reason: String| {
            StoreError::wrong_kind(path, "a Zarr v3 group with arrays i, j, k, layer and block", reason)
        };
        if !path.is_dir() {
            return Err(StoreError::Missing { path: path.to_owned() });
        }
        let open = |name: &str| StoredArray::open(path, name);
        let fields = [open("i")?, open("j")?, open("k")?];
        let ids = [open("layer")?, open("block")?];
        let size: [usize; 3] = fields[0].shape().try_into().map_err(|_| {
            wrong(format!("i has {} axes; it needs inline, crossline and sample", fields[0].shape().len()))
        })?;
        if let Some(other) = fields.iter().chain(&ids).find(|array| array.shape() != size) {
            return Err(wrong(format!("{} has {:?} samples, i has {size:?}", other.name(), other.shape())));
        }
        Ok(Self { header: ParameterizationHeader { size, key: String::new() }, fields, ids })
    }

    /// Voxels.
    pub fn size(&self) -> [usize; 3] {
        self.header.size
    }

    /// The key of the input that it was computed from.
    pub fn key(&self) -> &str {
        &self.header.key
    }

    /// Reads all of it.
    ///
    /// # Errors
    /// [`StoreError`].
    pub fn read(&self, progress: &Progress) -> Result<ParameterizationVolumes, StoreError> {
        let field = |n: usize| volume(self.header.size, self.fields[n].read::<f32>(progress)?);
        let ids = |n: usize| {
            let array = &self.ids[n];
            let ids = if array.holds::<u8>() { widened(&array.read::<u8>(progress)?) } else { array.read(progress)? };
            volume(self.header.size, ids)
        };
        Ok(ParameterizationVolumes { i: field(0)?, j: field(1)?, k: field(2)?, layer: ids(0)?, block: ids(1)? })
    }

    /// Reads all of it and verifies every checksum. Memory: one file for each thread.
    ///
    /// # Errors
    /// [`StoreError`] with the first file that is missing or damaged, or cancelled.
    pub fn verify(&self, progress: &Progress) -> Result<(), StoreError> {
        self.fields.iter().chain(&self.ids).try_for_each(|array| array.verify(progress))
    }

    /// Reads a box of it.
    ///
    /// # Errors
    /// [`StoreError`], [`StoreError::OutOfBounds`] when the box is not inside.
    pub fn read_box(&self, start: [usize; 3], size: [usize; 3]) -> Result<ParameterizationVolumes, StoreError> {
        let field = |n: usize| volume(size, self.fields[n].read_box::<f32>(&start, &size)?);
        let ids = |n: usize| {
            let array = &self.ids[n];
            let ids = if array.holds::<u8>() {
                widened(&array.read_box::<u8>(&start, &size)?)
            } else {
                array.read_box(&start, &size)?
            };
            volume(size, ids)
        };
        Ok(ParameterizationVolumes { i: field(0)?, j: field(1)?, k: field(2)?, layer: ids(0)?, block: ids(1)? })
    }
}

/// Widens ids of one byte to two.
fn widened(bytes: &[u8]) -> Vec<u16> {
    bytes.iter().map(|&id| if id == u8::MAX { NO_ID } else { id.into() }).collect()
}

/// Values as a volume.
fn volume<T: Copy>(size: [usize; 3], values: Vec<T>) -> Result<Volume<T>, StoreError> {
    Volume::from_samples(size, values).map_err(|error| StoreError::SizeMismatch {
        what: "a parameterization volume",
        expected: error.expected,
        found: error.found,
    })
}
