//! Volumes whose bricks lie in object storage.
//!
//! A linked volume is a folder like that of any volume, with all that is small: metadata, the mask of live traces, ranges
//! of bricks. The bricks themselves are read from where `link.json` says, as far as they are needed.
//!
//! ```text
//! volumes/NAME.zarr/link.json    { "url": "s3://bucket/path/NAME.zarr", "tags": […], "sums": […] }
//! ```
//!
//! `tags` are what the storage says of the metadata of each level when the volume is linked; they are asked for again
//! when it is opened, so that a volume that was replaced is not taken for the one that was linked. Addresses hold no
//! credentials; those come from the environment (`remote`) and are written nowhere.

#[cfg(feature = "remote")]
mod cache;
#[cfg(feature = "remote")]
mod remote;
#[cfg(all(test, feature = "remote"))]
mod tests;
#[cfg(feature = "remote")]
mod upload;

use super::error::StoreError;
use super::file_place::ArrayFiles;
use serde::{Deserialize, Serialize};
use std::io::ErrorKind;
use std::path::Path;
use std::sync::Arc;
#[cfg(feature = "remote")]
use survey::progress::Progress;
use system::file::FileAction;
#[cfg(feature = "remote")]
pub(super) use upload::upload;

/// The file that says where the bricks are.
const LINK: &str = "link.json";

/// What `link.json` says.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
struct Record {
    url: String,
    /// What the storage says of the metadata of each level.
    tags: Vec<String>,
    /// Checksums of all that was copied.
    sums: Vec<u32>,
}

/// Where the bricks of an opened volume are.
pub(super) struct Link {
    record: Record,
    #[cfg(feature = "remote")]
    objects: Arc<cache::CachedObjects>,
}

impl Link {
    /// The link of the volume at `path`, if it is a linked one; asks whether what was linked is still there.
    pub(super) fn read(path: &Path) -> Result<Option<Self>, StoreError> {
        let file = path.join(LINK);
        let text = match system::file::read_text(&file, system::file::MAX_DOCUMENT_BYTES) {
            Ok(text) => text,
            Err(error) if error.kind() == ErrorKind::NotFound => return Ok(None),
            Err(source) => return Err(StoreError::io(FileAction::Read, &file, source)),
        };
        let record: Record = serde_json::from_str(&text)
            .map_err(|error| StoreError::wrong_kind(&file, "a link to a volume", error.to_string()))?;
        Self::of(record).map(Some)
    }

    #[cfg(feature = "remote")]
    fn of(record: Record) -> Result<Self, StoreError> {
        let remote = remote::Remote::open(&record.url)?;
        let found = remote.tag("0/zarr.json")?;
        if record.tags.first().is_some_and(|known| *known != found) {
            return Err(StoreError::RemoteChanged { url: record.url });
        }
        let objects = Arc::new(cache::CachedObjects::new(remote, &record.sums)?);
        Ok(Self { record, objects })
    }

    #[cfg(not(feature = "remote"))]
    fn of(record: Record) -> Result<Self, StoreError> {
        Err(StoreError::WithoutRemote { url: record.url })
    }

    /// The files of an array.
    #[cfg(feature = "remote")]
    pub(super) fn files(&self, array: &str) -> Result<Arc<dyn ArrayFiles>, StoreError> {
        Ok(Arc::new(cache::ArrayObjects { objects: self.objects.clone(), array: array.to_owned() }))
    }

    #[cfg(not(feature = "remote"))]
    pub(super) fn files(&self, _: &str) -> Result<Arc<dyn ArrayFiles>, StoreError> {
        Err(StoreError::WithoutRemote { url: self.record.url.clone() })
    }

    /// The address of what was linked.
    #[cfg(feature = "remote")]
    pub(super) fn url(&self) -> &str {
        &self.record.url
    }

    /// Checksums of what was linked.
    pub(super) fn checksums(&self) -> Vec<u32> {
        let mut sums = self.record.sums.clone();
        sums.extend(self.record.tags.iter().map(|tag| crc32c::crc32c(tag.as_bytes())));
        sums
    }
}

/// Copies all of a volume but its bricks to the folder `group`, with a link to them.
#[cfg(feature = "remote")]
pub(super) fn copy_small(group: &Path, url: &str, progress: &Progress) -> Result<(), StoreError> {
    use serde_json::Value;
    let remote = remote::Remote::open(url)?;
    let mut sums = Vec::new();
    let mut copy = |key: &str| -> Result<Vec<u8>, StoreError> {
        progress.check()?;
        let bytes = remote.get(key)?;
        sums.push(crc32c::crc32c(&bytes));
        let file = group.join(key);
        let made = file.parent().map_or(Ok(()), std::fs::create_dir_all);
        made.and_then(|()| std::fs::write(&file, &bytes))
            .map_err(|source| StoreError::io(FileAction::Written, &file, source))?;
        Ok(bytes)
    };
    let document = |bytes: &[u8], key: &str| -> Result<Value, StoreError> {
        serde_json::from_slice(bytes).map_err(|error| StoreError::Remote {
            url: format!("{url}/{key}"),
            reason: format!(
                "it is no Zarr v3 metadata ({error}); give the address of a volume that this program wrote"
            ),
        })
    };
    let header = copy("zarr.json")?;
    if document(&header, "zarr.json")?["attributes"]["petroglyph"]["kind"] != super::volume_info::KIND {
        let reason = "it is no volume that this program wrote; import it from its own format instead".to_owned();
        return Err(StoreError::Remote { url: url.to_owned(), reason });
    }
    let edges = |metadata: &Value, what: &str| -> Option<Vec<u64>> {
        let list = if what == "shape" { &metadata["shape"] } else { &metadata["chunk_grid"]["configuration"][what] };
        list.as_array()?.iter().map(Value::as_u64).collect()
    };
    let mut level = 0;
    loop {
        let metadata = document(&copy(&format!("{level}/zarr.json"))?, "zarr.json")?;
        if !super::array::is_plain(group, &level.to_string()) {
            let reason =
                "its bricks are not stored as this program stores them (in shards, without compression); import \
                          the volume instead"
                    .to_owned();
            return Err(StoreError::Remote { url: url.to_owned(), reason });
        }
        copy(&format!("minmax/{level}/zarr.json"))?;
        copy(&format!("minmax/{level}/c/0/0/0/0"))?;
        level += 1;
        let shape = edges(&metadata, "shape").unwrap_or_default();
        if shape.iter().all(|&n| n <= super::layout::BRICK as u64) || level > 32 {
            break;
        }
    }
    copy("minmax/zarr.json")?;
    let live = document(&copy("live/zarr.json")?, "live/zarr.json")?;
    if let (Some(shape), Some(chunk)) = (edges(&live, "shape"), edges(&live, "chunk_shape"))
        && let ([nx, ny], [dx, dy]) = (shape.as_slice(), chunk.as_slice())
    {
        for (x, y) in (0..nx.div_ceil((*dx).max(1))).flat_map(|x| (0..ny.div_ceil((*dy).max(1))).map(move |y| (x, y))) {
            copy(&format!("live/c/{x}/{y}"))?;
        }
    }
    let tags = (0..level).map(|level| remote.tag(&format!("{level}/zarr.json"))).collect::<Result<_, _>>()?;
    let record = Record { url: url.trim_end_matches('/').to_owned(), tags, sums };
    let text = serde_json::to_string_pretty(&record).unwrap_or_default();
    let file = group.join(LINK);
    std::fs::write(&file, text).map_err(|source| StoreError::io(FileAction::Written, &file, source))
}
