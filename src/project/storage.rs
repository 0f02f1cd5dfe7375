//! Files of a project on disk: atomic replacement, new generations of data, and the lock between writers.
//!
//! Nothing that a saved state refers to is ever overwritten. A file is replaced by writing `NAME.new` beside it, flushing it to
//! the disk and renaming it; data sets (folders) are written as `NAME.new` too and get their name just before the project does.
//! Whatever ends in `.new` after a crash was never part of a project and is removed by the next writer.

use crate::error::ProjectError;
use std::fs::{self, File, TryLockError};
use std::io::Write;
use std::path::{Path, PathBuf};

/// Ending of what is not yet valid.
pub(crate) const NEW: &str = "new";

/// `path` with `.new` appended to its file name.
pub(crate) fn new_beside(path: &Path) -> PathBuf {
    let mut name = path.file_name().unwrap_or_default().to_owned();
    name.push(".");
    name.push(NEW);
    path.with_file_name(name)
}

/// Where data of that name lie now: what a command under way has written and not published yet is under its new name.
pub(crate) fn at_hand(path: PathBuf) -> PathBuf {
    let new = new_beside(&path);
    if !path.exists() && new.exists() { new } else { path }
}

/// Writes `bytes` to `path` and flushes them to the disk.
pub(crate) fn write_durably(path: &Path, bytes: &[u8]) -> Result<(), ProjectError> {
    let fail = |source| ProjectError::io("written", path, source);
    let mut file = File::create(path).map_err(fail)?;
    let written = file.write_all(bytes).and_then(|()| file.sync_all());
    drop(file);
    written.map_err(|source| {
        // A half-written file must not be found by anyone; the first failure is the one to report.
        let _ = fs::remove_file(path);
        fail(source)
    })
}

/// Replaces `path` by `bytes`: either the old or the new content is there, whatever happens.
pub(crate) fn replace(path: &Path, bytes: &[u8]) -> Result<(), ProjectError> {
    let new = new_beside(path);
    write_durably(&new, bytes)?;
    rename(&new, path)
}

/// Renames and flushes the folder entry.
pub(crate) fn rename(from: &Path, to: &Path) -> Result<(), ProjectError> {
    fs::rename(from, to).map_err(|source| ProjectError::io("written", to, source))?;
    if let Some(parent) = to.parent() {
        sync_folder(parent);
    }
    Ok(())
}

/// Flushes a folder's entries. Some file systems cannot; the rename itself is still atomic there.
fn sync_folder(folder: &Path) {
    if let Ok(handle) = File::open(folder) {
        let _ = handle.sync_all();
    }
}

/// Flushes a file or everything in a folder to the disk.
pub(crate) fn sync_tree(path: &Path) -> Result<(), ProjectError> {
    let fail = |source| ProjectError::io("written", path, source);
    if path.is_dir() {
        for entry in fs::read_dir(path).map_err(fail)? {
            sync_tree(&entry.map_err(fail)?.path())?;
        }
        sync_folder(path);
        Ok(())
    } else {
        File::open(path).and_then(|file| file.sync_all()).map_err(fail)
    }
}

/// Removes a file or a folder with its content, if it is there.
pub(crate) fn remove(path: &Path) {
    let removed = if path.is_dir() { fs::remove_dir_all(path) } else { fs::remove_file(path) };
    // What cannot be removed stays behind as garbage that no state refers to.
    let _ = removed;
}

/// Reads a text file.
pub(crate) fn read_text(path: &Path) -> Result<String, ProjectError> {
    fs::read_to_string(path).map_err(|source| ProjectError::io("read", path, source))
}

/// Entries of a folder by name; none when it is missing.
pub(crate) fn entries(folder: &Path) -> Vec<PathBuf> {
    let mut found: Vec<PathBuf> =
        fs::read_dir(folder).into_iter().flatten().filter_map(|entry| Some(entry.ok()?.path())).collect();
    found.sort();
    found
}

/// Keeps other writers out for as long as it lives. The system releases it when the process ends, however it ends.
#[derive(Debug)]
pub(crate) struct Lock {
    _file: File,
}

impl Lock {
    /// Takes the lock of the project at `root`.
    pub(crate) fn take(root: &Path) -> Result<Self, ProjectError> {
        Self::take_named(root, "lock")
    }

    /// Takes the lock in the file `name` of the folder `root`.
    pub(crate) fn take_named(root: &Path, name: &str) -> Result<Self, ProjectError> {
        let path = root.join(name);
        let file = File::options()
            .create(true)
            .truncate(false)
            .write(true)
            .open(&path)
            .map_err(|source| ProjectError::io("written", &path, source))?;
        match file.try_lock() {
            Ok(()) => Ok(Self { _file: file }),
            Err(TryLockError::WouldBlock) => Err(ProjectError::Locked { path: root.to_owned() }),
            Err(TryLockError::Error(source)) => Err(ProjectError::io("locked", &path, source)),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_second_writer_is_kept_out_until_the_first_is_done() {
        let folder = tempfile::tempdir().unwrap();
        let first = Lock::take(folder.path()).unwrap();
        assert!(matches!(Lock::take(folder.path()), Err(ProjectError::Locked { .. })));
        drop(first);
        Lock::take(folder.path()).unwrap();
    }

    #[test]
    fn replacing_leaves_no_second_file() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.toml");
        replace(&path, b"one").unwrap();
        replace(&path, b"two").unwrap();
        assert_eq!(read_text(&path).unwrap(), "two");
        assert_eq!(entries(folder.path()), [path]);
    }
}
