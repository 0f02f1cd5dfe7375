//! The place where derived data are written until they are complete: `derived/unfinished/`, with a folder for each
//! writer.
//!
//! Derived data are stored without the project's lock, and several programs may do so at once. Each writer therefore
//! has a folder of its own, beside a lock file that the system releases however the program ends. The next writer
//! removes the folders whose lock is free. The folder of work in bricks has a name that tells the work: when the same
//! work is asked for again, it goes on with what is there.

use crate::error::ProjectError;
use crate::folder::storage;
use std::fs::{self, File};
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicU64, Ordering};
use system::file::FileAction;

/// Folder of all writers, relative to the project.
const UNFINISHED: &str = "derived/unfinished";

/// The folder of one writer. When it is dropped, what was not published is removed.
#[derive(Debug)]
pub(crate) struct Scratch {
    root: PathBuf,
    name: String,
    _lock: File,
    is_left: bool,
}

impl Scratch {
    /// Makes a new folder, after removing those that killed programs left behind.
    ///
    /// # Errors
    /// The project contains a link, or cannot be written.
    pub(crate) fn begin(root: &Path) -> Result<Self, ProjectError> {
        static COUNT: AtomicU64 = AtomicU64::new(0);
        storage::refuse_links(root)?;
        let all = root.join(UNFINISHED);
        let fail = |source| ProjectError::io(FileAction::Written, &all, source);
        remove_leftovers(root);
        let name = format!("{}-{}", std::process::id(), COUNT.fetch_add(1, Ordering::Relaxed));
        let made = || fs::create_dir_all(&all).and_then(|()| File::create(all.join(lock_of(&name))));
        // Another writer that has finished may remove the parent folder at this moment.
        let lock = made().or_else(|_| made()).map_err(fail)?;
        lock.lock().map_err(fail)?;
        fs::create_dir_all(all.join(&name)).map_err(fail)?;
        Ok(Self { root: root.to_owned(), name, _lock: lock, is_left: false })
    }

    /// The folder of the work that `name` identifies: that of a program that was stopped, or a new one; after removing
    /// those of other work. `None` while another program does the same work.
    ///
    /// # Errors
    /// As [`Scratch::begin`].
    pub(crate) fn resume(root: &Path, name: &str) -> Result<Option<Self>, ProjectError> {
        storage::refuse_links(root)?;
        let all = root.join(UNFINISHED);
        let fail = |source| ProjectError::io(FileAction::Written, &all, source);
        for file in abandoned(root).into_iter().filter(|file| !is_of(file, name)) {
            storage::remove(root, &file);
        }
        let made = || fs::create_dir_all(&all).and_then(|()| File::create(all.join(lock_of(name))));
        let lock = made().or_else(|_| made()).map_err(fail)?;
        match lock.try_lock() {
            Ok(()) => {}
            Err(fs::TryLockError::WouldBlock) => return Ok(None),
            Err(fs::TryLockError::Error(source)) => return Err(fail(source)),
        }
        fs::create_dir_all(all.join(name)).map_err(fail)?;
        Ok(Some(Self { root: root.to_owned(), name: name.to_owned(), _lock: lock, is_left: false }))
    }

    /// Leaves what was written for the next call of [`Scratch::resume`].
    pub(crate) fn leave(mut self) {
        self.is_left = true;
    }

    /// The path at which to write what will become `derived/FILE`.
    pub(crate) fn path(&self, file: &str) -> PathBuf {
        self.root.join(UNFINISHED).join(&self.name).join(file)
    }

    /// Moves what was written to its place; what was there before is replaced.
    ///
    /// # Errors
    /// The file cannot be renamed.
    pub(crate) fn publish(&self, file: &str) -> Result<(), ProjectError> {
        let target = self.root.join(storage::DERIVED).join(file);
        if target.is_dir() {
            storage::rename(&target, &self.path("replaced"))?;
        }
        storage::rename(&self.path(file), &target)
    }
}

impl Drop for Scratch {
    fn drop(&mut self) {
        if self.is_left {
            return;
        }
        storage::remove(&self.root, &format!("{UNFINISHED}/{}", self.name));
        storage::remove(&self.root, &format!("{UNFINISHED}/{}", lock_of(&self.name)));
        // This succeeds only when no other writer is at work.
        let _ = fs::remove_dir(self.root.join(UNFINISHED));
    }
}

fn lock_of(name: &str) -> String {
    format!("{name}.lock")
}

/// What the name of the folder of work begins with that a later program may go on with.
pub(crate) const RESUMABLE: &str = "bricks-";

/// Removes the folders of writers that no longer run, but for work that may be gone on with.
pub(crate) fn remove_leftovers(root: &Path) {
    let resumable = format!("{UNFINISHED}/{RESUMABLE}");
    for file in abandoned(root).into_iter().filter(|file| !file.starts_with(&resumable)) {
        storage::remove(root, &file);
    }
}

/// Removes the folders of work that was stopped and may be gone on with.
pub(crate) fn remove_resumable(root: &Path) {
    abandoned(root).iter().for_each(|file| storage::remove(root, file));
    // This succeeds only when no other writer is at work.
    let _ = fs::remove_dir(root.join(UNFINISHED));
}

/// Removes the folders of work in bricks under a key whose result is stored: a program that was killed between storing it and
/// cleaning up leaves one, which nothing goes on with any more.
pub(crate) fn remove_finished(root: &Path, key: &str) {
    let of_key = format!("{UNFINISHED}/{RESUMABLE}{key}-");
    let finished: Vec<String> = abandoned(root).into_iter().filter(|file| file.starts_with(&of_key)).collect();
    if finished.is_empty() {
        return;
    }
    finished.iter().for_each(|file| storage::remove(root, file));
    // This succeeds only when no other writer is at work.
    let _ = fs::remove_dir(root.join(UNFINISHED));
}

/// Whether a file of [`abandoned`] belongs to the work that `name` identifies.
fn is_of(file: &str, name: &str) -> bool {
    let entry = file.rsplit('/').next().unwrap_or(file);
    entry == name || entry == lock_of(name)
}

/// Folders and lock files of writers that no longer run, relative to the project.
pub(crate) fn abandoned(root: &Path) -> Vec<String> {
    let all = root.join(UNFINISHED);
    // A folder without a lock file has no writer either: the lock is made first and removed last.
    let is_free = |entry: &String| {
        let writer = entry.strip_suffix(".lock").unwrap_or(entry);
        File::open(all.join(lock_of(writer))).map_or(true, |file| file.try_lock().is_ok())
    };
    // Names of folders sort before those of their locks, which keep them from other writers until then.
    storage::names_in(&all).into_iter().filter(is_free).map(|entry| format!("{UNFINISHED}/{entry}")).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn names(root: &Path) -> Vec<String> {
        storage::names_in(&root.join(UNFINISHED))
    }

    #[test]
    fn what_is_published_stays_and_the_rest_goes() {
        let folder = tempfile::tempdir().unwrap();
        let root = folder.path();
        for text in ["one", "two"] {
            let scratch = Scratch::begin(root).unwrap();
            fs::create_dir(scratch.path("a.zarr")).unwrap();
            fs::write(scratch.path("a.zarr").join("0"), text).unwrap();
            fs::write(scratch.path("other"), text).unwrap();
            scratch.publish("a.zarr").unwrap();
        }
        assert_eq!(fs::read_to_string(root.join("derived/a.zarr/0")).unwrap(), "two");
        assert_eq!(names(root), Vec::<String>::new());
        assert!(!root.join("derived/other").exists());
    }

    #[test]
    fn work_in_bricks_goes_on_where_it_was_stopped() {
        let folder = tempfile::tempdir().unwrap();
        let root = folder.path();
        let scratch = Scratch::resume(root, "bricks-a").unwrap().unwrap();
        fs::write(scratch.path("part"), "1").unwrap();
        assert!(Scratch::resume(root, "bricks-a").unwrap().is_none(), "another one does it");
        scratch.leave();
        // Neither another writer nor another command takes it away; the same work finds it.
        drop(Scratch::begin(root).unwrap());
        remove_leftovers(root);
        let again = Scratch::resume(root, "bricks-a").unwrap().unwrap();
        assert_eq!(fs::read_to_string(again.path("part")).unwrap(), "1");
        again.leave();
        // Other work does not.
        drop(Scratch::resume(root, "bricks-b").unwrap());
        assert_eq!(names(root), Vec::<String>::new());
    }

    #[test]
    fn work_whose_result_is_stored_is_not_kept() {
        let folder = tempfile::tempdir().unwrap();
        let root = folder.path();
        let begun = |key: &str| Scratch::resume(root, &format!("bricks-{key}-64x64-9")).unwrap().unwrap();
        let write = |scratch: Scratch| {
            fs::create_dir_all(scratch.path("arrays/z")).unwrap();
            fs::write(scratch.path("arrays/z/0"), "1").unwrap();
            scratch.leave();
        };
        write(begun("a"));
        remove_finished(root, "b");
        assert_eq!(names(root), ["bricks-a-64x64-9", "bricks-a-64x64-9.lock"]);
        // Another program that does it again keeps it.
        let again = begun("a");
        remove_finished(root, "a");
        assert!(again.path("arrays/z/0").exists());
        again.leave();
        remove_finished(root, "a");
        assert!(!root.join(UNFINISHED).exists());
    }

    #[test]
    fn leftovers_go_and_the_work_of_others_stays() {
        let folder = tempfile::tempdir().unwrap();
        let root = folder.path();
        let all = root.join(UNFINISHED);
        fs::create_dir_all(all.join("7-0/a.zarr")).unwrap();
        fs::create_dir_all(all.join("8-0")).unwrap();
        fs::write(all.join("8-0.lock"), "").unwrap();
        fs::create_dir_all(all.join("9-0")).unwrap();
        let held = File::create(all.join("9-0.lock")).unwrap();
        held.lock().unwrap();
        drop(Scratch::begin(root).unwrap());
        assert_eq!(names(root), ["9-0", "9-0.lock"]);
        drop(held);
        drop(Scratch::begin(root).unwrap());
        assert_eq!(names(root), Vec::<String>::new());
    }
}
