//! Zarr v3 arrays. Only this module and `sample` use the array library.
//!
//! An array is divided into chunks, the unit of compression (zstd with a checksum; chunks of volumes are not
//! compressed, see `shard`). Chunks are bundled into shards, each of which is a file, so that a large volume
//! is neither millions of files nor a single one. The order is C: the last axis is fastest. Every shard is
//! written, even if it holds only the fill value, so that a missing file is noticed and not read as empty.

use super::capacity;
use super::error::StoreError;
use super::file_place::ArrayFiles;
use super::layout::{ArrayLayout, gather, grid_index};
use super::sample::StoredSample;
use super::shard::{ShardGrid, Shards};
use rayon::prelude::*;
use serde_json::{Map, Value};
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};
use survey::progress::Progress;
use survey::sample::Sample;
use system::file::FileAction;
use zarrs::array::codec::{Crc32cCodec, ZstdCodec};
use zarrs::array::{
    Array, ArrayBuilder, ArrayCreateError, ArrayError, ArraySubset, BytesToBytesCodecTraits, CodecError, CodecOptions,
};
use zarrs::filesystem::FilesystemStore;
use zarrs::group::{Group, GroupBuilder, GroupCreateError};
use zarrs::storage::StorageError;

/// Compression level: the fast end, which on seismic samples loses 1 or 2 % of the size to the slow end.
const ZSTD_LEVEL: i32 = 1;

/// The attribute that states that every shard was written.
const COMPLETE: &str = "complete";

/// Converts an error of the library.
fn explain(error: &ArrayError, action: FileAction, group: &Path, array: &str) -> StoreError {
    let storage = match error {
        ArrayError::StorageError(storage) | ArrayError::CodecError(CodecError::StorageError(storage)) => storage,
        ArrayError::CodecError(CodecError::IOError(source)) => return io_error(source, action, group, array),
        ArrayError::CodecError(codec) if action == FileAction::Read => {
            return StoreError::damaged(group, array, codec.to_string());
        }
        other => {
            return StoreError::array(group, action, other.to_string());
        }
    };
    explain_storage(storage, action, group, array)
}

/// Converts an error of the library's file store.
fn explain_storage(error: &StorageError, action: FileAction, group: &Path, array: &str) -> StoreError {
    match error {
        StorageError::IOError(source) => io_error(source, action, group, array),
        StorageError::MissingMetadata(_) => {
            StoreError::MissingArray { path: group.to_owned(), array: array.to_owned() }
        }
        other if action == FileAction::Read => StoreError::damaged(group, array, other.to_string()),
        other => StoreError::array(group, action, other.to_string()),
    }
}

/// Converts a shared system error. An error without a system code while reading comes from a decoder: the
/// data are damaged.
fn io_error(source: &std::io::Error, action: FileAction, path: &Path, array: &str) -> StoreError {
    if let Some(code) = source.raw_os_error() {
        return StoreError::io(action, path, std::io::Error::from_raw_os_error(code));
    }
    if action == FileAction::Read {
        let reason = source.to_string();
        return StoreError::damaged(path, array, reason);
    }
    StoreError::io(action, path, std::io::Error::new(source.kind(), source.to_string()))
}

/// The library's view of a folder.
fn file_store(group: &Path, action: FileAction) -> Result<Arc<FilesystemStore>, StoreError> {
    FilesystemStore::new(group).map(Arc::new).map_err(|error| match group.to_str() {
        None => StoreError::NoText { path: group.to_owned() },
        Some(_) => StoreError::array(group, action, error.to_string()),
    })
}

/// Writes a group's metadata; `name` is empty for the folder itself.
pub(crate) fn write_group(group: &Path, name: &str, attributes: Map<String, Value>) -> Result<(), StoreError> {
    let store = file_store(group, FileAction::Written)?;
    let built = GroupBuilder::new().attributes(attributes).build(store, &format!("/{name}"));
    let fail = |reason: String| StoreError::array(group, FileAction::Written, reason);
    let built = built.map_err(|error| fail(error.to_string()))?;
    built.store_metadata().map_err(|error| explain_storage(&error, FileAction::Written, group, name))
}

/// Reads a group's attributes.
pub(crate) fn read_group(group: &Path) -> Result<Map<String, Value>, StoreError> {
    if !group.is_dir() {
        return Err(StoreError::Missing { path: group.to_owned() });
    }
    capacity::check_metadata(&group.join("zarr.json"))?;
    let opened = Group::open(file_store(group, FileAction::Read)?, "/");
    match opened {
        Ok(opened) => Ok(opened.attributes().clone()),
        Err(GroupCreateError::StorageError(StorageError::IOError(source))) => {
            Err(io_error(&source, FileAction::Read, group, ""))
        }
        Err(error) => Err(StoreError::wrong_kind(group, "a Zarr v3 group", error.to_string())),
    }
}

/// An array in the folder `group` whose chunks are coded by `codec`; nothing is written.
fn build<T: StoredSample>(
    group: &Path,
    name: &str,
    layout: &ArrayLayout,
    fill: T,
    codec: Arc<dyn BytesToBytesCodecTraits>,
    mut attributes: Map<String, Value>,
) -> Result<Array<FilesystemStore>, StoreError> {
    let wide = |shape: &[usize]| shape.iter().map(|&n| n as u64).collect::<Vec<u64>>();
    let mut builder = ArrayBuilder::new(wide(&layout.shape), wide(layout.file_shape()), T::data_type(), T::fill(fill));
    if layout.shard.is_some() {
        builder.subchunk_shape(wide(&layout.chunk));
    }
    builder.bytes_to_bytes_codecs(vec![codec]);
    builder.dimension_names(Some(layout.axes.iter().map(String::as_str)));
    attributes.insert(COMPLETE.to_owned(), Value::Bool(true));
    builder.attributes(attributes);
    builder
        .build(file_store(group, FileAction::Written)?, &format!("/{name}"))
        .map_err(|error| StoreError::array(group, FileAction::Written, error.to_string()))
}

/// Writes the metadata of an array whose chunks are coded by `codec`.
fn create<T: StoredSample>(
    group: &Path,
    name: &str,
    layout: &ArrayLayout,
    fill: T,
    codec: Arc<dyn BytesToBytesCodecTraits>,
    attributes: Map<String, Value>,
) -> Result<Array<FilesystemStore>, StoreError> {
    let array = build(group, name, layout, fill, codec, attributes)?;
    array.store_metadata().map_err(|error| explain_storage(&error, FileAction::Written, group, name))?;
    Ok(array)
}

/// Writes the metadata of a level of a volume whose shards are then written one by one (see `shard`): fill value 0.
pub(super) fn create_volume<T: StoredSample + Sample>(
    group: &Path,
    level: usize,
    size: [usize; 3],
    attributes: Map<String, Value>,
) -> Result<ShardGrid, StoreError> {
    let layout = ArrayLayout::level(size, level);
    create(group, &level.to_string(), &layout, T::from_f32(0.0), Arc::new(Crc32cCodec::new()), attributes)?;
    Ok(volume_grid(group, level, size))
}

/// How a level of a volume is cut into shards by [`create_volume`].
pub(super) fn volume_grid(group: &Path, level: usize, size: [usize; 3]) -> ShardGrid {
    let layout = ArrayLayout::level(size, level);
    let three = |shape: &[usize]| [shape[0], shape[1], shape[2]];
    ShardGrid {
        folder: group.join(level.to_string()),
        shape: size,
        chunk: three(&layout.chunk),
        shard: three(layout.file_shape()),
        beside_others: false,
    }
}

/// Whether the chunks of the array `name` are stored as [`create_volume`] stores them.
#[cfg(feature = "remote")]
pub(super) fn is_plain(group: &Path, name: &str) -> bool {
    plain_shards(group, name, &[0; 3]).is_some()
}

/// The division of the array `name` into shards, if its chunks are stored as [`create_volume`] stores them.
fn plain_shards(group: &Path, name: &str, shape: &[usize]) -> Option<ShardGrid> {
    let metadata: Value = serde_json::from_slice(&std::fs::read(group.join(name).join("zarr.json")).ok()?).ok()?;
    let edges = |value: &Value| -> Option<[usize; 3]> {
        let edges: Option<Vec<usize>> = value.as_array()?.iter().map(|n| Some(n.as_u64()? as usize)).collect();
        edges?.try_into().ok()
    };
    let names = |codecs: &Value| -> Option<Vec<String>> {
        codecs.as_array()?.iter().map(|codec| Some(codec["name"].as_str()?.to_owned())).collect()
    };
    let codecs = metadata["codecs"].as_array()?;
    let sharding = &codecs[0]["configuration"];
    let is_plain = codecs.len() == 1
        && codecs[0]["name"] == "sharding_indexed"
        && names(&sharding["codecs"])? == ["bytes", "crc32c"]
        && names(&sharding["index_codecs"])? == ["bytes", "crc32c"]
        && sharding["index_location"].as_str().is_none_or(|place| place == "end")
        && sharding["codecs"][0]["configuration"]["endian"].as_str().is_none_or(|endian| endian == "little");
    let shape: [usize; 3] = shape.try_into().ok()?;
    let shard = edges(&metadata["chunk_grid"]["configuration"]["chunk_shape"])?;
    let chunk = edges(&sharding["chunk_shape"])?;
    let is_cut = (0..3).all(|axis| chunk[axis] > 0 && shard[axis].is_multiple_of(chunk[axis]) && shard[axis] > 0);
    let folder = group.join(name);
    (is_plain && is_cut).then_some(ShardGrid { folder, shape, chunk, shard, beside_others: false })
}

/// An array that is being written, shard by shard, from any thread.
pub(crate) struct ArrayWriter<T> {
    group: PathBuf,
    name: String,
    layout: ArrayLayout,
    array: Array<FilesystemStore>,
    /// Where a file is written before it is moved to its place, if others write files of the array too.
    apart: Option<PathBuf>,
    of: std::marker::PhantomData<T>,
}

impl<T: StoredSample> ArrayWriter<T> {
    /// An array whose metadata are written already. Where other processes write files of it too, `apart` is a folder of
    /// this process: each file is written there, and moved to its place once it is complete.
    pub(crate) fn of_created(
        group: &Path,
        name: &str,
        layout: ArrayLayout,
        fill: T,
        apart: Option<&Path>,
    ) -> Result<Self, StoreError> {
        let folder = apart.unwrap_or(group);
        std::fs::create_dir_all(folder).map_err(|source| StoreError::io(FileAction::Written, folder, source))?;
        let array = build(folder, name, &layout, fill, codec(), Map::new())?;
        let (apart, of) = (apart.map(Path::to_owned), std::marker::PhantomData);
        Ok(Self { group: group.to_owned(), name: name.to_owned(), layout, array, apart, of })
    }

    /// Creates the array `name` (it may contain `/`) in the folder `group`; `fill` is the value of elements that were
    /// not written.
    pub(crate) fn create(group: &Path, name: &str, layout: ArrayLayout, fill: T) -> Result<Self, StoreError> {
        Self::described(group, name, layout, fill, Map::new())
    }

    /// The same, with attributes.
    fn described(
        group: &Path,
        name: &str,
        layout: ArrayLayout,
        fill: T,
        attributes: Map<String, Value>,
    ) -> Result<Self, StoreError> {
        let array = create(group, name, &layout, fill, codec(), attributes)?;
        let (apart, of) = (None, std::marker::PhantomData);
        Ok(Self { group: group.to_owned(), name: name.to_owned(), layout, array, apart, of })
    }

    /// The division into chunks and shards.
    pub(crate) fn layout(&self) -> &ArrayLayout {
        &self.layout
    }

    /// Writes the shard at `index`: `[…]` of the file's shape, padded where it reaches beyond the array.
    pub(crate) fn write_shard(&self, index: &[usize], values: Vec<T>) -> Result<(), StoreError> {
        let place: Vec<u64> = index.iter().map(|&n| n as u64).collect();
        // On one thread: the library writes the chunks of a shard in the order in which its threads finish them, and
        // the same input must give the same bytes. Shards are written in parallel instead.
        let options = CodecOptions::default().with_store_empty_chunks(true).with_concurrent_target(1);
        self.array
            .store_chunk_opt(&place, values, &options)
            .map_err(|error| explain(&error, FileAction::Written, &self.group, &self.name))?;
        self.apart.as_ref().map_or(Ok(()), |apart| self.move_into_place(apart, index))
    }

    fn move_into_place(&self, apart: &Path, index: &[usize]) -> Result<(), StoreError> {
        let key = index.iter().map(usize::to_string).collect::<Vec<_>>().join("/");
        let file = format!("{}/c/{key}", self.name);
        let target = self.group.join(&file);
        let parent = target.parent().unwrap_or(&self.group);
        std::fs::create_dir_all(parent)
            .and_then(|()| std::fs::rename(apart.join(&file), &target))
            .map_err(|source| StoreError::io(FileAction::Written, &target, source))
    }
}

/// Folder of a group for files that are not complete, where several processes write.
pub(super) const APART: &str = ".apart";

/// A folder for such files that no other writer uses.
pub(super) fn new_apart(group: &Path) -> PathBuf {
    static COUNT: AtomicU64 = AtomicU64::new(0);
    // Numbers of processes are those of a machine; the time tells machines apart.
    let now = std::time::SystemTime::now().duration_since(std::time::UNIX_EPOCH).unwrap_or_default().as_nanos();
    let own = format!("{}-{now:x}-{}", std::process::id(), COUNT.fetch_add(1, Ordering::Relaxed));
    group.join(APART).join(own)
}

/// How the chunks of everything but volumes are coded.
fn codec() -> Arc<dyn BytesToBytesCodecTraits> {
    Arc::new(ZstdCodec::new(ZSTD_LEVEL, true))
}

/// Writes a whole array, one file at a time on each thread. Memory: one file's elements per thread beside
/// `values`.
pub(crate) fn write_array<T: StoredSample>(
    group: &Path,
    name: &str,
    layout: ArrayLayout,
    fill: T,
    values: &[T],
    progress: &Progress,
) -> Result<(), StoreError> {
    write_described(group, name, (layout, Map::new()), fill, values, progress)
}

/// The same, with attributes beside the layout.
pub(super) fn write_described<T: StoredSample>(
    group: &Path,
    name: &str,
    (layout, attributes): (ArrayLayout, Map<String, Value>),
    fill: T,
    values: &[T],
    progress: &Progress,
) -> Result<(), StoreError> {
    let expected = layout.shape.iter().product();
    if values.len() != expected {
        return Err(StoreError::SizeMismatch { what: "the array", expected, found: values.len() });
    }
    let writer = ArrayWriter::described(group, name, layout, fill, attributes)?;
    let (counts, edge) = (writer.layout.file_counts(), writer.layout.file_shape());
    let count: usize = counts.iter().product();
    progress.begin(&format!("writing {name}"), count as u64);
    (0..count).into_par_iter().try_for_each(|n| {
        let index = grid_index(n, &counts);
        let start: Vec<usize> = index.iter().zip(edge).map(|(&i, &e)| i * e).collect();
        writer.write_shard(&index, gather(values, &writer.layout.shape, &start, edge))?;
        Ok(progress.step(1)?)
    })
}

/// An array that can be read, whole or by box.
pub(crate) struct StoredArray {
    group: PathBuf,
    name: String,
    shape: Vec<usize>,
    array: Array<FilesystemStore>,
    /// Its files, if they can be read without the library.
    shards: Option<Shards>,
}

impl StoredArray {
    /// Opens the array `name` of the folder `group`.
    pub(crate) fn open(group: &Path, name: &str) -> Result<Self, StoreError> {
        let opened = Self::of_metadata(group, name)?;
        let edge = opened.file_shape()?;
        let counts: Vec<usize> = opened.shape.iter().zip(&edge).map(|(&n, &edge)| n.div_ceil(edge)).collect();
        capacity::check_count(group, name, &opened.shape, &counts)?;
        let shards = plain_shards(group, name, &opened.shape).map(|grid| Shards::new(grid, group, name));
        Ok(Self { shards, ..opened })
    }

    /// Opens an array whose metadata lie in the folder `group` and whose files elsewhere; its bricks must be stored as
    /// this program stores them.
    pub(super) fn open_linked(group: &Path, name: &str, files: Arc<dyn ArrayFiles>) -> Result<Self, StoreError> {
        let opened = Self::of_metadata(group, name)?;
        let Some(grid) = plain_shards(group, name, &opened.shape) else {
            return Err(StoreError::OtherChunks { path: group.to_owned(), array: name.to_owned() });
        };
        Ok(Self { shards: Some(Shards::of_files(grid, files, group, name)), ..opened })
    }

    pub(super) fn of_metadata(group: &Path, name: &str) -> Result<Self, StoreError> {
        let missing = || StoreError::MissingArray { path: group.to_owned(), array: name.to_owned() };
        capacity::check_metadata(&group.join(name).join("zarr.json"))?;
        let array = match Array::open(file_store(group, FileAction::Read)?, &format!("/{name}")) {
            Ok(array) => array,
            Err(ArrayCreateError::MissingMetadata) => return Err(missing()),
            Err(ArrayCreateError::StorageError(error)) => {
                return Err(explain_storage(&error, FileAction::Read, group, name));
            }
            Err(error) => {
                return Err(StoreError::damaged(group, name, error.to_string()));
            }
        };
        let shape: Vec<usize> = array.shape().iter().map(|&n| n as usize).collect();
        Ok(Self { group: group.to_owned(), name: name.to_owned(), shape, array, shards: None })
    }

    /// Where it is, for errors.
    pub(super) fn path(&self) -> PathBuf {
        self.group.join(&self.name)
    }

    /// The group that it is in.
    pub(super) fn group(&self) -> &Path {
        &self.group
    }

    /// Its name in the group.
    pub(super) fn name(&self) -> &str {
        &self.name
    }

    /// Elements along each axis.
    pub(crate) fn shape(&self) -> &[usize] {
        &self.shape
    }

    /// Its files, if they are those of a volume.
    pub(super) fn shards(&self) -> Option<&Shards> {
        self.shards.as_ref()
    }

    /// The same array, read by the library alone.
    #[cfg(test)]
    pub(super) fn by_the_library(self) -> Self {
        Self { shards: None, ..self }
    }

    /// Name of the element type as Zarr spells it.
    pub(crate) fn type_name(&self) -> String {
        use zarrs::plugin::{ExtensionName, ZarrVersion};
        self.array
            .data_type()
            .name(ZarrVersion::V3)
            .map_or_else(|| "an unknown type".to_owned(), |name| name.into_owned())
    }

    /// Whether its elements are of type `T`.
    pub(crate) fn holds<T: StoredSample>(&self) -> bool {
        *self.array.data_type() == T::data_type()
    }

    /// Elements of a file along each axis.
    pub(super) fn file_shape(&self) -> Result<Vec<usize>, StoreError> {
        let first = vec![0; self.shape.len()];
        let shape = self
            .array
            .chunk_shape(&first)
            .map_err(|error| explain(&error, FileAction::Read, &self.group, &self.name))?;
        Ok(shape.iter().map(|n| n.get() as usize).collect())
    }

    /// Fails if a file that the box needs is missing, or too short for its content.
    fn check_files(&self, start: &[usize], size: &[usize], bytes_each: usize) -> Result<(), StoreError> {
        let edge = self.file_shape()?;
        let first: Vec<usize> = start.iter().zip(&edge).map(|(&s, &e)| s / e).collect();
        let counts: Vec<usize> =
            (0..edge.len()).map(|axis| (start[axis] + size[axis]).div_ceil(edge[axis]) - first[axis]).collect();
        for n in 0..counts.iter().product() {
            let index = grid_index(n, &counts);
            let key = index.iter().zip(&first).map(|(&i, &f)| (i + f).to_string()).collect::<Vec<_>>().join("/");
            let file = self.path().join("c").join(&key);
            let facts = match std::fs::metadata(&file) {
                Err(source) if system::file::says_nothing(&source) => {
                    return Err(StoreError::io(FileAction::Read, &file, source));
                }
                facts => facts.ok().filter(std::fs::Metadata::is_file),
            };
            let whole = facts.ok_or_else(|| "it is missing".to_owned());
            whole.and_then(|facts| capacity::check_content(facts.len(), &edge, bytes_each)).map_err(|fact| {
                let reason = format!("the file c/{key}: {fact}");
                StoreError::damaged(&self.group, &self.name, reason)
            })?;
        }
        Ok(())
    }

    /// The elements of a box, row-major. Files are decoded in parallel. Memory: the box twice.
    pub(crate) fn read_box<T: StoredSample>(&self, start: &[usize], size: &[usize]) -> Result<Vec<T>, StoreError> {
        if !self.holds::<T>() {
            return Err(StoreError::WrongType {
                path: self.group.clone(),
                array: self.name.clone(),
                expected: T::NAME,
                found: self.type_name(),
            });
        }
        let dimensions = self.shape.len();
        let inside = start.len() == dimensions
            && size.len() == dimensions
            && (0..dimensions)
                .all(|axis| start[axis].checked_add(size[axis]).is_some_and(|end| end <= self.shape[axis]));
        if !inside {
            return Err(StoreError::OutOfBounds {
                path: self.group.clone(),
                array: self.name.clone(),
                start: start.into(),
                size: size.into(),
                shape: self.shape.clone(),
            });
        }
        if size.contains(&0) {
            return Ok(Vec::new());
        }
        self.check_memory(size, size_of::<T>())?;
        if let (Some(shards), [x, y, z], [nx, ny, nz]) = (&self.shards, start, size) {
            return shards.read_box([*x, *y, *z], [*nx, *ny, *nz]);
        }
        self.check_files(start, size, size_of::<T>())?;
        let ranges: Vec<_> = start.iter().zip(size).map(|(&s, &n)| s as u64..(s + n) as u64).collect();
        self.array
            .retrieve_array_subset(&ArraySubset::new_with_ranges(&ranges))
            .map_err(|error| explain(&error, FileAction::Read, &self.group, &self.name))
    }

    /// All elements, row-major, a layer of files at a time. Memory: the array, and one layer of files.
    pub(crate) fn read<T: StoredSample>(&self, progress: &Progress) -> Result<Vec<T>, StoreError> {
        let edge = self.file_shape()?[0];
        let rows = self.shape[0];
        self.check_memory(&self.shape, size_of::<T>())?;
        let mut values = Vec::with_capacity(self.shape.iter().product());
        progress.begin(&format!("reading {}", self.name), rows.div_ceil(edge) as u64);
        for first in (0..rows).step_by(edge) {
            let (mut start, mut size) = (vec![0; self.shape.len()], self.shape.clone());
            start[0] = first;
            size[0] = edge.min(rows - first);
            values.append(&mut self.read_box(&start, &size)?);
            progress.step(1)?;
        }
        Ok(values)
    }
}
