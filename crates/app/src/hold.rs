//! Which window has a project open: a file lock, which the system releases when the process ends, however it ends.
//!
//! The file `window.lock` in the project holds the id of the process. The lock on the file decides, not the id: an id
//! outlives its process. A project that cannot be written to is held by no window.

use project::folder::open_own;
use std::fs::{File, TryLockError};
use std::io::{Read, Seek, Write};
use std::path::Path;

/// Name of the lock file.
const NAME: &str = "window.lock";

/// Marks a project as open in this window for as long as the value lives.
#[derive(Debug)]
pub(crate) struct Hold {
    _file: File,
}

/// The outcome of taking the lock.
#[derive(Debug)]
pub(crate) enum Taken {
    /// This window holds the lock, or no window can.
    Here(Option<Hold>),
    /// Another window holds the lock; with the id of its process, if known.
    Elsewhere(Option<u32>),
}

impl Hold {
    /// Takes the lock of the project in the folder `root`.
    pub(crate) fn take(root: &Path) -> Taken {
        let Ok(mut file) = open_own(root, NAME) else { return Taken::Here(None) };
        match file.try_lock() {
            Ok(()) => {
                // The id is only for messages: without it the lock is held all the same.
                let _ = file.set_len(0).and_then(|()| file.rewind());
                let _ = write!(file, "{}", std::process::id());
                Taken::Here(Some(Self { _file: file }))
            }
            Err(TryLockError::WouldBlock) => {
                let mut text = String::new();
                let _ = file.read_to_string(&mut text);
                Taken::Elsewhere(text.trim().parse().ok())
            }
            Err(TryLockError::Error(_)) => Taken::Here(None),
        }
    }

    /// Whether a window that still runs has the project open.
    pub(crate) fn is_elsewhere(root: &Path) -> bool {
        let Ok(file) = File::options().read(true).write(true).open(root.join(NAME)) else { return false };
        matches!(file.try_lock(), Err(TryLockError::WouldBlock))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_project_is_open_in_one_window_and_free_when_that_ends() {
        let folder = tempfile::tempdir().unwrap();
        assert!(!Hold::is_elsewhere(folder.path()));
        let Taken::Here(Some(first)) = Hold::take(folder.path()) else { panic!("it was free") };
        assert!(Hold::is_elsewhere(folder.path()));
        assert!(matches!(Hold::take(folder.path()), Taken::Elsewhere(Some(id)) if id == std::process::id()));
        drop(first);
        assert!(!Hold::is_elsewhere(folder.path()));
    }

    #[test]
    fn a_folder_that_does_not_exist_is_held_by_nobody() {
        assert!(matches!(Hold::take(Path::new("/nowhere/at/all")), Taken::Here(None)));
    }
}
