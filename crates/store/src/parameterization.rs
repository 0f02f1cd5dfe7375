//! Parameterizations on disk: `parameterization.zarr`, a Zarr v3 group. Its arrays are `i`, `j`, `k`
//! (float32, unpacked, NaN outside) and `layer`, `block` (uint8, or uint16 where an id needs it; all ones =
//! none), all `[inline][crossline][sample]`.
//!
//! Memory: 16 bytes per voxel for the volumes themselves, one shard per thread while writing, and one layer
//! of shards while reading.

use super::array::{StoredArray, write_array};
use super::error::StoreError;
use super::header::{read_header, write_header};
use super::layout::ArrayLayout;
use super::replacement::Replacement;
use serde::{Deserialize, Serialize};
use std::path::Path;
use survey::progress::Progress;
use survey::volume::Volume;

/// The id that stands for "none".
pub const NO_ID: u16 = u16::MAX;

/// Kind of the group.
const KIND: &str = "parameterization";

/// Facts of a parameterization.
#[derive(Serialize, Deserialize)]
struct Header {
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
    /// Layer, 0 = deepest; [`NO_ID`] = none.
    pub layer: Volume<u16>,
    /// Fault block; [`NO_ID`] = none.
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
    let size = volumes.i.size();
    let replacement = Replacement::of(path)?;
    let group = replacement.path();
    write_header(group, KIND, &Header { size, key: key.to_owned() })?;
    for (name, volume) in [("i", &volumes.i), ("j", &volumes.j), ("k", &volumes.k)] {
        write_array(group, name, ArrayLayout::volume(size), f32::NAN, volume.samples(), progress)?;
    }
    for (name, volume) in [("layer", &volumes.layer), ("block", &volumes.block)] {
        write_ids(group, name, size, volume.samples(), progress)?;
    }
    replacement.commit()
}

/// Writes ids in one byte where they fit.
fn write_ids(group: &Path, name: &str, size: [usize; 3], ids: &[u16], progress: &Progress) -> Result<(), StoreError> {
    let narrow = ids.iter().all(|&id| id == NO_ID || id < u16::from(u8::MAX));
    if !narrow {
        return write_array(group, name, ArrayLayout::volume(size), NO_ID, ids, progress);
    }
    // The low byte of "none" is "none".
    let bytes: Vec<u8> = ids.iter().map(|&id| id as u8).collect();
    write_array(group, name, ArrayLayout::volume(size), u8::MAX, &bytes, progress)
}

/// A parameterization on disk.
pub struct StoredParameterization {
    header: Header,
    fields: [StoredArray; 3],
    ids: [StoredArray; 2],
}

impl StoredParameterization {
    /// Opens a parameterization; values are read later.
    ///
    /// # Errors
    /// [`StoreError`] when it is missing, of another kind, newer than this program or damaged.
    pub fn open(path: &Path) -> Result<Self, StoreError> {
        let header: Header = read_header(path, KIND, "a parameterization")?;
        let open = |name: &str| {
            let array = StoredArray::open(path, name)?;
            if array.shape() != header.size {
                return Err(StoreError::Damaged {
                    path: path.to_owned(),
                    array: name.to_owned(),
                    reason: format!("it has {:?}, not {:?}", array.shape(), header.size),
                });
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
        let wrong = |reason: String| StoreError::WrongKind {
            path: path.to_owned(),
            expected: "a Zarr v3 group with arrays i, j, k, layer and block",
            reason,
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
        Ok(Self { header: Header { size, key: String::new() }, fields, ids })
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
