//! Parts of remote objects, kept on disk as long as they fit.
//!
//! Objects are read in blocks of [`BLOCK`] bytes. A block that was read lies in the cache's folder, as a file of its own;
//! when all blocks together exceed the limit, those that were used longest ago go. Several programs may share a cache:
//! blocks are written beside their place and renamed, and one that is gone is read again. What is read out of it is
//! verified by the checksums of bricks like everything else.

use super::super::error::StoreError;
use super::super::file_place::{ArrayFiles, PlacedBytes};
use super::remote::Remote;
use rayon::prelude::*;
use std::collections::HashMap;
use std::fs;
use std::io;
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, PoisonError};
use std::time::SystemTime;
use system::file::FileAction;

/// Bytes of a block.
pub(super) const BLOCK: u64 = 256 << 10;

/// The variables that state the cache's folder, and its limit in bytes.
const FOLDER_VARIABLE: &str = "PETROGLYPH_CACHE";
const LIMIT_VARIABLE: &str = "PETROGLYPH_CACHE_BYTES";

/// The limit, if none is stated.
const LIMIT_BYTES: u64 = 10 << 30;

/// Bytes of blocks that are written between two counts of the whole cache.
const COUNT_EVERY: u64 = 64 << 20;

/// The folder of the cache.
fn cache_folder() -> PathBuf {
    let stated = |name: &str| std::env::var_os(name).filter(|value| !value.is_empty()).map(PathBuf::from);
    stated(FOLDER_VARIABLE)
        .or_else(|| stated("XDG_CACHE_HOME").map(|folder| folder.join("petroglyph")))
        .or_else(|| stated("HOME").map(|folder| folder.join(".cache/petroglyph")))
        .or_else(|| stated("LOCALAPPDATA").map(|folder| folder.join("petroglyph/cache")))
        .unwrap_or_else(|| std::env::temp_dir().join("petroglyph-cache"))
}

/// The objects of a volume, through the cache.
#[derive(Debug)]
pub(super) struct CachedObjects {
    remote: Remote,
    /// The cache, and this volume's part of it.
    all: PathBuf,
    folder: PathBuf,
    limit: u64,
    lengths: Mutex<HashMap<String, u64>>,
    /// Bytes written since the cache was last counted.
    written: Mutex<u64>,
}

impl CachedObjects {
    /// The cache for a volume that is identified by its address and `sums`.
    pub(super) fn new(remote: Remote, sums: &[u32]) -> Result<Self, StoreError> {
        let limit = std::env::var(LIMIT_VARIABLE).ok().and_then(|text| text.parse().ok()).unwrap_or(LIMIT_BYTES);
        Self::new_in(&cache_folder(), limit, remote, sums)
    }

    /// The cache in a folder, with a limit in bytes.
    pub(super) fn new_in(cache: &Path, limit: u64, remote: Remote, sums: &[u32]) -> Result<Self, StoreError> {
        let address = remote.url_of("");
        let plain: String = address.chars().map(|c| if c.is_ascii_alphanumeric() { c } else { '-' }).collect();
        let bytes: Vec<u8> = sums.iter().flat_map(|sum| sum.to_le_bytes()).chain(address.bytes()).collect();
        let all = cache.join("blocks");
        let tail: String = plain.chars().rev().take(60).collect::<Vec<_>>().into_iter().rev().collect();
        let folder =
            all.join(format!("{:08x}{:08x}-{tail}", crc32c::crc32c(&bytes), crc32c::crc32c(address.as_bytes())));
        fs::create_dir_all(&folder).map_err(|source| StoreError::io(FileAction::Written, &folder, source))?;
        Ok(Self { remote, all, folder, limit, lengths: Mutex::default(), written: Mutex::new(COUNT_EVERY) })
    }

    fn length(&self, key: &str) -> Result<u64, StoreError> {
        let known = || self.lengths.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(&length) = known().get(key) {
            return Ok(length);
        }
        let length = self.remote.length(key)?;
        known().insert(key.to_owned(), length);
        Ok(length)
    }

    /// Fills `out` with the bytes of an object from `offset` on.
    pub(super) fn read(&self, key: &str, offset: u64, out: &mut [u8]) -> io::Result<()> {
        let end = offset + out.len() as u64;
        if end > self.length(key).map_err(io::Error::other)? {
            return Err(io::ErrorKind::UnexpectedEof.into());
        }
        let blocks: Vec<u64> = (offset / BLOCK..end.div_ceil(BLOCK)).collect();
        let read = blocks.par_iter().map(|&number| self.block(key, number));
        let read: Vec<Vec<u8>> = read.collect::<Result<_, StoreError>>().map_err(io::Error::other)?;
        for (number, bytes) in blocks.into_iter().zip(read) {
            let start = number * BLOCK;
            let (from, to) = (offset.max(start), end.min(start + bytes.len() as u64));
            out[(from - offset) as usize..(to - offset) as usize]
                .copy_from_slice(&bytes[(from - start) as usize..(to - start) as usize]);
        }
        Ok(())
    }

    /// The bytes of a block.
    fn block(&self, key: &str, number: u64) -> Result<Vec<u8>, StoreError> {
        let file = self.folder.join(format!("{}.{number}", key.replace('/', "-")));
        let length = self.length(key)?;
        let range = number * BLOCK..((number + 1) * BLOCK).min(length);
        if let Ok(bytes) = fs::read(&file)
            && bytes.len() as u64 == range.end - range.start
        {
            // Only the order in which blocks go depends on it.
            let _ = fs::File::open(&file).and_then(|file| file.set_modified(SystemTime::now()));
            return Ok(bytes);
        }
        let bytes = self.remote.get_range(key, &range)?;
        // A cache that cannot be written, as on a full disk, is none.
        if self.keep(&file, &bytes).is_ok() {
            self.stay_below_limit(bytes.len() as u64);
        }
        Ok(bytes)
    }

    fn keep(&self, file: &Path, bytes: &[u8]) -> io::Result<()> {
        if bytes.len() as u64 > self.limit {
            return Err(io::ErrorKind::StorageFull.into());
        }
        let partial = file.with_extension(format!("part-{}-{:?}", std::process::id(), std::thread::current().id()));
        let written = fs::write(&partial, bytes).and_then(|()| fs::rename(&partial, file));
        if written.is_err() {
            let _ = fs::remove_file(&partial);
        }
        written
    }

    /// Removes the blocks that were used longest ago, now and then, while there are too many.
    fn stay_below_limit(&self, added: u64) {
        let mut written = self.written.lock().unwrap_or_else(PoisonError::into_inner);
        *written += added;
        if *written < COUNT_EVERY.min(self.limit / 8) {
            return;
        }
        *written = 0;
        let mut blocks: Vec<(SystemTime, u64, PathBuf)> = Vec::new();
        for folder in fs::read_dir(&self.all).into_iter().flatten().flatten() {
            for entry in fs::read_dir(folder.path()).into_iter().flatten().flatten() {
                if let Ok(facts) = entry.metadata() {
                    blocks.push((facts.modified().unwrap_or(SystemTime::UNIX_EPOCH), facts.len(), entry.path()));
                }
            }
        }
        let mut total: u64 = blocks.iter().map(|(_, bytes, _)| bytes).sum();
        // Room for what is written until the next count.
        let most = self.limit - self.limit / 8;
        blocks.sort();
        for (_, bytes, path) in blocks {
            if total <= most {
                break;
            }
            if fs::remove_file(&path).is_ok() {
                total -= bytes;
            }
        }
    }
}

/// The files of an array in object storage.
#[derive(Debug)]
pub(super) struct ArrayObjects {
    pub(super) objects: Arc<CachedObjects>,
    pub(super) array: String,
}

impl ArrayFiles for ArrayObjects {
    fn open(&self, key: &str) -> io::Result<Box<dyn PlacedBytes + '_>> {
        Ok(Box::new(CachedObject { objects: &self.objects, key: format!("{}/{key}", self.array) }))
    }

    fn place(&self, key: &str) -> PathBuf {
        PathBuf::from(self.objects.remote.url_of(&format!("{}/{key}", self.array)))
    }
}

/// An object that is read at places.
struct CachedObject<'a> {
    objects: &'a CachedObjects,
    key: String,
}

impl PlacedBytes for CachedObject<'_> {
    fn length(&self) -> io::Result<u64> {
        self.objects.length(&self.key).map_err(io::Error::other)
    }

    fn read_exact_at(&self, offset: u64, out: &mut [u8]) -> io::Result<()> {
        self.objects.read(&self.key, offset, out)
    }
}
