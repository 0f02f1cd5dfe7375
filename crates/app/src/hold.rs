//! Which window has a project open: a lock that ends with its process, however that ends.
//!
//! The file `window.lock` in the project says whose it is; what counts is the lock on it, since a number outlives its process. A project that cannot be
//! written to is held by nobody.

use project::folder::open_own;
use std::fs::{File, TryLockError};
use std::io::{Read, Seek, Write};
use std::path::Path;

/// Name of the file.
const NAME: &str = "window.lock";

/// Keeps a project as open in this window.
#[derive(Debug)]
pub struct Hold {
    _file: File,
}

/// What came of taking hold of a project.
#[derive(Debug)]
pub enum Taken {
    /// It is this window's, or cannot be anybody's.
    Here(Option<Hold>),
    /// Another window has it, of this process if it is known.
    Elsewhere(Option<u32>),
}

impl Hold {
    /// Takes hold of the project in the folder `root`.
    pub fn take(root: &Path) -> Taken {
        let Ok(mut file) = open_own(root, NAME) else { return Taken::Here(None) };
        match file.try_lock() {
            Ok(()) => {
                // Told to people only: without it the lock holds all the same.
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
    pub fn is_elsewhere(root: &Path) -> bool {
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
    fn where_nothing_can_be_written_nobody_holds_anything() {
        assert!(matches!(Hold::take(Path::new("/nowhere/at/all")), Taken::Here(None)));
    }
}
