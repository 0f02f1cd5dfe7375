//! A volume as objects: all of its files under an address, the metadata that make it a volume last.
//!
//! So it is whole or not there: a reader finds nothing that opens until everything else was taken. Whatever ends the
//! upload early, what was written is removed again, as far as the storage still answers.
//!
//! Memory: a file for each thread (128³ samples at most).

use super::super::error::StoreError;
use super::remote::Remote;
use rayon::prelude::*;
use std::fs;
use std::path::Path;
use std::sync::{Mutex, PoisonError};
use survey::progress::Progress;
use system::file::FileAction;

/// The object without which there is no volume.
const HEADER: &str = "zarr.json";

/// Writes the files of the folder `path` under `url`, from which nothing may be read as a volume before; returns their bytes.
pub(crate) fn upload(path: &Path, url: &str, progress: &Progress) -> Result<u64, StoreError> {
    let remote = Remote::open(url)?;
    if remote.is_there(HEADER)? {
        let reason = "there is something under this address; choose another one, or remove it first".to_owned();
        return Err(StoreError::RemoteWrite { url: url.to_owned(), reason });
    }
    let mut keys = Vec::new();
    keys_within(path, "", &mut keys)?;
    keys.retain(|key| key != HEADER);
    let taken = Mutex::new(Vec::new());
    progress.begin("writing to object storage", keys.len() as u64 + 1);
    let write = |key: &str| -> Result<u64, StoreError> {
        progress.check()?;
        let file = path.join(key);
        let bytes = fs::read(&file).map_err(|source| StoreError::io(FileAction::Read, &file, source))?;
        let length = bytes.len() as u64;
        // Noted before it is known: a request whose reply is lost may have been carried out.
        taken.lock().unwrap_or_else(PoisonError::into_inner).push(key.to_owned());
        remote.put(key, bytes)?;
        progress.step(1)?;
        Ok(length)
    };
    let written = keys.par_iter().map(|key| write(key)).try_reduce(|| 0, |a, b| Ok(a + b));
    let outcome = written.and_then(|bytes| Ok(bytes + write(HEADER)?));
    if outcome.is_err() {
        let taken = taken.into_inner().unwrap_or_else(PoisonError::into_inner);
        // The header first. A storage that is out of reach is asked once.
        let left = taken.iter().rev().position(|key| remote.remove(key).is_err()).map(|done| taken.len() - done);
        if let Some(left) = left {
            progress
                .warn(format!("{left} objects could not be removed from {url}; they are no volume without {HEADER}"));
        }
    }
    outcome
}

/// Paths of all files in a folder, with `/`.
fn keys_within(folder: &Path, prefix: &str, found: &mut Vec<String>) -> Result<(), StoreError> {
    let fail = |source| StoreError::io(FileAction::Read, folder, source);
    for entry in fs::read_dir(folder).map_err(fail)? {
        let entry = entry.map_err(fail)?;
        let key = format!("{prefix}{}", entry.file_name().to_string_lossy());
        if entry.file_type().map_err(fail)?.is_dir() {
            keys_within(&entry.path(), &format!("{key}/"), found)?;
        } else {
            found.push(key);
        }
    }
    Ok(())
}
