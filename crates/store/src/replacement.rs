//! Replacing a file or a folder so that a crash or a full disk never costs the last good state.
//!
//! What is written goes to `NAME.partial-<something>` beside the target, is synced, and takes its name by a rename at the very
//! end. A file is thereby replaced in one step. A folder that is already there is first moved to `NAME.replaced-<something>`, and
//! removed when the new one has its name; should the program die between the two renames, [`settle`] moves it back.

use super::error::StoreError;
use std::fs::{self, File};
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicU64, Ordering};

/// Follows the name of what is being written.
const PARTIAL: &str = ".partial-";

/// Follows the name of what is being replaced.
const REPLACED: &str = ".replaced-";

/// A target that is being written anew. Dropped without [`Replacement::commit`], it leaves nothing behind.
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
            fs::create_dir_all(parent).map_err(|source| StoreError::io("written", parent, source))?;
        }
        Ok(Self { target: target.to_owned(), partial: beside(target, PARTIAL) })
    }

    /// Where to write.
    pub fn path(&self) -> &Path {
        &self.partial
    }

    /// Gives what was written the target's name. Its files must be synced already.
    ///
    /// # Errors
    /// When a rename fails; the target is then what it was.
    pub fn commit(self) -> Result<(), StoreError> {
        let fail = |source| StoreError::io("written", &self.target, source);
        sync_folders(&self.partial).map_err(fail)?;
        if self.target.is_dir() {
            let replaced = beside(&self.target, REPLACED);
            fs::rename(&self.target, &replaced).map_err(fail)?;
            if let Err(source) = fs::rename(&self.partial, &self.target) {
                // Put the old one back; the first failure is the one to report.
                let _ = fs::rename(&replaced, &self.target);
                return Err(fail(source));
            }
            // The new state is complete; an old one that cannot be removed is garbage for `clean`.
            let _ = fs::remove_dir_all(&replaced);
        } else {
            fs::rename(&self.partial, &self.target).map_err(fail)?;
        }
        if let Some(parent) = self.target.parent() {
            sync_folder(parent);
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

/// A name beside `target` that nobody else uses.
fn beside(target: &Path, mark: &str) -> PathBuf {
    static COUNT: AtomicU64 = AtomicU64::new(0);
    let count = COUNT.fetch_add(1, Ordering::Relaxed);
    let mut name = target.file_name().unwrap_or_default().to_owned();
    name.push(format!("{mark}{}-{count}", std::process::id()));
    target.with_file_name(name)
}

/// Removes a file or folder if it is there. What cannot be removed is garbage that nothing refers to.
fn remove(path: &Path) {
    let _ = if path.is_dir() { fs::remove_dir_all(path) } else { fs::remove_file(path) };
}

/// Flushes a folder's entries. Some file systems cannot; a rename is still atomic there.
fn sync_folder(folder: &Path) {
    if let Ok(handle) = File::open(folder) {
        let _ = handle.sync_all();
    }
}

/// Flushes the entries of a folder and of all folders in it.
fn sync_folders(path: &Path) -> std::io::Result<()> {
    if path.is_dir() {
        for entry in fs::read_dir(path)? {
            sync_folders(&entry?.path())?;
        }
        sync_folder(path);
    }
    Ok(())
}

/// Entries of `folder` whose name contains `mark`, with the path they stand in for.
fn marked(folder: &Path, mark: &str) -> Vec<(PathBuf, PathBuf)> {
    let entries = fs::read_dir(folder).into_iter().flatten().flatten();
    let found = entries.filter_map(|entry| {
        let name = entry.file_name();
        let (target, _) = name.to_str()?.split_once(mark)?;
        Some((entry.path(), folder.join(target)))
    });
    found.collect()
}

/// Brings back what a crash in the middle of a replacement left under another name. Called before anything is opened.
pub(super) fn settle(target: &Path) {
    if target.exists() {
        return;
    }
    if let Some(parent) = target.parent()
        && let Some((replaced, _)) = marked(parent, REPLACED).into_iter().find(|(_, of)| of == target)
    {
        let _ = fs::rename(replaced, target);
    }
}

/// Cleans a folder of what crashes left in it and returns what was removed or brought back. Nobody may be writing
/// to the folder meanwhile: call it with the project's lock held.
pub fn clean(folder: &Path) -> Vec<PathBuf> {
    let mut touched = Vec::new();
    for (replaced, target) in marked(folder, REPLACED) {
        if target.exists() {
            remove(&replaced);
            touched.push(replaced);
        } else {
            settle(&target);
            touched.push(target);
        }
    }
    for (partial, _) in marked(folder, PARTIAL) {
        remove(&partial);
        touched.push(partial);
    }
    touched
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
        .map_err(|source| StoreError::io("written", target, source))?;
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
    fn leftovers_of_a_crash_are_cleaned_and_a_lost_name_is_given_back() {
        let dir = tempfile::tempdir().unwrap();
        let at = |name: &str| dir.path().join(name);
        folder_with(&at("a.zarr"), "good");
        folder_with(&at("a.zarr.partial-1-0"), "half");
        folder_with(&at("a.zarr.replaced-1-1"), "older");
        folder_with(&at("b.zarr.replaced-1-2"), "good");
        fs::write(at("c.json.partial-1-3"), "half").unwrap();
        assert_eq!(clean(dir.path()).len(), 4);
        assert_eq!(names(dir.path()), ["a.zarr", "b.zarr"]);
        assert_eq!(fs::read_to_string(at("b.zarr").join("data")).unwrap(), "good");
        assert_eq!(clean(dir.path()), Vec::<PathBuf>::new());
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
