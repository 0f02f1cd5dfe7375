//! Replacing a file or a folder so that a crash or a full disk never costs the last good state.
//!
//! What is written lies in a hidden file or folder beside the target, `.NAME.partial-PROCESS-COUNT`, is
//! synced, and takes the target's name by a rename at the very end. A file is thereby replaced in one step. A
//! folder that is already there is first moved to `.NAME.replaced`, and removed when the new one has its
//! name; should the program die between the two renames, [`settle`] moves it back. Nothing is ever
//! recognised, or removed, by a part of its name.

use super::error::StoreError;
use std::fs::{self, File};
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicU64, Ordering};
use system::file::FileAction;
use system::file::{create_folders, sync_folder};

/// A target that is being replaced. If it is dropped without [`Replacement::commit`], the target remains as
/// it was.
///
/// ```
/// # use std::fs;
/// let folder = tempfile::tempdir()?;
/// let path = folder.path().join("notes.txt");
/// store::replace_file(&path, b"first")?;
/// store::replace_file(&path, b"second")?;
/// assert_eq!(fs::read(&path)?, b"second");
/// assert_eq!(fs::read_dir(folder.path())?.count(), 1);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug)]
pub struct Replacement {
    target: PathBuf,
    partial: PathBuf,
}

impl Replacement {
    /// Prepares to replace `target`, a file or a folder; creates its parent folders.
    ///
    /// # Errors
    /// When the parent cannot be created.
    pub fn of(target: &Path) -> Result<Self, StoreError> {
        if let Some(parent) = target.parent() {
            create_folders(parent).map_err(|source| StoreError::io(FileAction::Written, parent, source))?;
        }
        Ok(Self { target: target.to_owned(), partial: partial_of(target) })
    }

    /// Where to write.
    pub fn path(&self) -> &Path {
        &self.partial
    }

    /// Gives what was written the target's name. Its files must be synced already.
    ///
    /// # Errors
    /// When a rename fails: the target is then what it was. When its folder cannot be flushed: the target is new then,
    /// but may be the old one again after a power cut.
    pub fn commit(self) -> Result<(), StoreError> {
        let fail = |source| StoreError::io(FileAction::Written, &self.target, source);
        sync_folders(&self.partial).map_err(fail)?;
        if self.target.is_dir() {
            let replaced = replaced_of(&self.target);
            // The target is there, so what a former crash left under this name has been replaced.
            remove(&replaced);
            fs::rename(&self.target, &replaced).map_err(fail)?;
            if let Err(source) = fs::rename(&self.partial, &self.target) {
                // Put the old one back; the first failure is the one to report.
                let _ = fs::rename(&replaced, &self.target);
                return Err(fail(source));
            }
            // The new state is complete. An old state that cannot be removed now is removed the next time.
            let _ = fs::remove_dir_all(&replaced);
        } else {
            fs::rename(&self.partial, &self.target).map_err(fail)?;
        }
        if let Some(parent) = self.target.parent() {
            sync_folder(parent).map_err(|source| StoreError::io(FileAction::Flushed, parent, source))?;
        }
        Ok(())
    }
}

impl Drop for Replacement {
    fn drop(&mut self) {
        // After a commit there is nothing under this name any more.
        remove(&self.partial);
    }
}

/// A hidden name beside `target` that no other writer uses.
fn partial_of(target: &Path) -> PathBuf {
    static COUNT: AtomicU64 = AtomicU64::new(0);
    let count = COUNT.fetch_add(1, Ordering::Relaxed);
    hidden_beside(target, &format!("partial-{}-{count}", std::process::id()))
}

/// Where the former folder is while the new one takes its name.
fn replaced_of(target: &Path) -> PathBuf {
    hidden_beside(target, "replaced")
}

fn hidden_beside(target: &Path, ending: &str) -> PathBuf {
    let mut name = std::ffi::OsString::from(".");
    name.push(target.file_name().unwrap_or_default());
    name.push(".");
    name.push(ending);
    target.with_file_name(name)
}

/// Removes a file or folder if it is there. What cannot be removed is garbage that nothing refers to.
fn remove(path: &Path) {
    let _ = if path.is_dir() { fs::remove_dir_all(path) } else { fs::remove_file(path) };
}

/// Flushes the entries of a folder and of all folders in it.
fn sync_folders(path: &Path) -> std::io::Result<()> {
    if path.is_dir() {
        for entry in fs::read_dir(path)? {
            sync_folders(&entry?.path())?;
        }
        sync_folder(path)?;
    }
    Ok(())
}

/// Brings back what a crash in the middle of a replacement left under another name. Called before anything is
/// opened.
pub(super) fn settle(target: &Path) {
    if !target.exists() {
        // Where nothing was left, nothing is to be brought back.
        let _ = fs::rename(replaced_of(target), target);
    }
}

/// Replaces a file by `bytes`; creates its parent folders.
///
/// # Errors
/// When it cannot be written; the file is then what it was.
pub fn replace_file(target: &Path, bytes: &[u8]) -> Result<(), StoreError> {
    use std::io::Write;
    let replacement = Replacement::of(target)?;
    File::create(replacement.path())
        .and_then(|mut file| file.write_all(bytes).and_then(|()| file.sync_all()))
        .map_err(|source| StoreError::io(FileAction::Written, target, source))?;
    replacement.commit()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn names(folder: &Path) -> Vec<String> {
        let mut names: Vec<String> =
            fs::read_dir(folder).unwrap().map(|e| e.unwrap().file_name().into_string().unwrap()).collect();
        names.sort();
        names
    }

    fn folder_with(path: &Path, text: &str) {
        fs::create_dir_all(path).unwrap();
        fs::write(path.join("data"), text).unwrap();
    }

    #[test]
    fn a_folder_is_replaced_whole_and_nothing_stays_beside_it() {
        let dir = tempfile::tempdir().unwrap();
        let target = dir.path().join("a.zarr");
        for text in ["old", "new"] {
            let replacement = Replacement::of(&target).unwrap();
            folder_with(replacement.path(), text);
            replacement.commit().unwrap();
            assert_eq!(fs::read_to_string(target.join("data")).unwrap(), text);
        }
        assert_eq!(names(dir.path()), ["a.zarr"]);
    }

    #[test]
    fn without_commit_the_old_state_stays() {
        let dir = tempfile::tempdir().unwrap();
        let target = dir.path().join("a.zarr");
        folder_with(&target, "old");
        let replacement = Replacement::of(&target).unwrap();
        folder_with(replacement.path(), "half");
        drop(replacement);
        assert_eq!(fs::read_to_string(target.join("data")).unwrap(), "old");
        assert_eq!(names(dir.path()), ["a.zarr"]);
    }

    #[test]
    fn a_name_lost_in_a_crash_is_given_back_and_no_other_is_touched() {
        let dir = tempfile::tempdir().unwrap();
        let at = |name: &str| dir.path().join(name);
        for ordinary in ["b.zarr.partial-stack", "b.zarr.replaced-2024", "far.partial-stack.zarr"] {
            folder_with(&at(ordinary), "data");
        }
        folder_with(&at(".b.zarr.replaced"), "good");
        settle(&at("b.zarr"));
        settle(&at("c.zarr"));
        assert_eq!(fs::read_to_string(at("b.zarr").join("data")).unwrap(), "good");
        let replacement = Replacement::of(&at("b.zarr")).unwrap();
        folder_with(replacement.path(), "new");
        replacement.commit().unwrap();
        assert_eq!(
            names(dir.path()),
            ["b.zarr", "b.zarr.partial-stack", "b.zarr.replaced-2024", "far.partial-stack.zarr"]
        );
    }

    #[test]
    fn a_parent_that_is_a_file_is_an_error_with_its_path() {
        let dir = tempfile::tempdir().unwrap();
        let file = dir.path().join("file");
        fs::write(&file, "").unwrap();
        let error = replace_file(&file.join("sub").join("x.json"), b"{}").unwrap_err();
        assert!(error.to_string().contains("file"), "{error}");
    }
}
