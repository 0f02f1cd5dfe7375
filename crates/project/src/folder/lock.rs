//! The lock that lets one process at a time change a project.
//!
//! It is a lock of the system on a file of the project, so that it ends with the process, however that ends.
//! While it is held, the file says who holds it, for those who wait.

use super::storage;
use crate::error::ProjectError;
use std::fs::{File, TryLockError};
use std::io::{Seek, Write};
use std::path::Path;
use std::thread;
use std::time::{Duration, Instant};
use survey::Progress;
use system::file;
use system::file::FileAction;

/// How long a command waits by default for another that is changing the project.
pub const DEFAULT_WAIT: Duration = Duration::from_secs(10);

/// Marks the folder of a project that is being created; locked by its creator.
pub(crate) const CREATING: &str = "creating";

/// Between two looks at a lock that is held.
const PAUSE: Duration = Duration::from_millis(50);

/// Most bytes that a holder is described by.
const MAX_HOLDER_BYTES: u64 = 200;

/// Keeps other writers out for as long as it lives.
#[derive(Debug)]
pub(crate) struct Lock {
    file: File,
}

impl Lock {
    /// Takes the lock of the project at `root`; waits for so long while another process holds it.
    ///
    /// # Errors
    /// [`ProjectError::Locked`] with the holder when it is still held then, [`ProjectError::Cancelled`], or a
    /// folder that cannot be written.
    pub(crate) fn take(root: &Path, wait: Duration, progress: &Progress) -> Result<Self, ProjectError> {
        let begun = Instant::now();
        loop {
            match Self::take_named(root, "lock") {
                Err(ProjectError::Locked { .. }) if begun.elapsed() < wait => thread::sleep(PAUSE.min(wait)),
                taken => return taken,
            }
            progress.check()?;
        }
    }

    /// Takes the lock in the file `name` of the folder `root`, or is refused at once.
    pub(crate) fn take_named(root: &Path, name: &str) -> Result<Self, ProjectError> {
        let path = root.join(name);
        let file =
            storage::open_own(root, name).map_err(|source| ProjectError::io(FileAction::Written, &path, source))?;
        match file.try_lock() {
            Ok(()) => {
                let mut lock = Self { file };
                lock.say(&format!("process {}{}", std::process::id(), command()));
                Ok(lock)
            }
            Err(TryLockError::WouldBlock) => Err(ProjectError::Locked { path: root.to_owned(), holder: holder(&path) }),
            Err(TryLockError::Error(source)) => Err(ProjectError::io(FileAction::Locked, &path, source)),
        }
    }

    /// Replaces what the file says. It only informs: a full disk is no reason to refuse the lock.
    fn say(&mut self, text: &str) {
        let _ =
            self.file.set_len(0).and_then(|()| self.file.rewind()).and_then(|()| self.file.write_all(text.as_bytes()));
    }
}

impl Drop for Lock {
    fn drop(&mut self) {
        self.say("");
    }
}

/// Removes the mark of a creation that was killed when its project already had its name; not that of one under way.
pub(crate) fn forget_creation(root: &Path) {
    let is_free = File::open(root.join(CREATING)).is_ok_and(|mark| mark.try_lock().is_ok());
    if is_free {
        storage::remove(root, CREATING);
    }
}

/// The command of this process, as in ` (petroglyph import)`.
fn command() -> String {
    let word = std::env::args().nth(1).filter(|word| !word.is_empty() && word.chars().all(|c| c.is_ascii_lowercase()));
    word.map(|word| format!(" (petroglyph {word})")).unwrap_or_default()
}

/// Who holds the lock in a file.
fn holder(path: &Path) -> Option<String> {
    let text = file::read_text(path, MAX_HOLDER_BYTES).ok()?;
    (text.starts_with("process ") && !text.chars().any(char::is_control)).then_some(text)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn take(root: &Path, wait_ms: u64) -> Result<Lock, ProjectError> {
        Lock::take(root, Duration::from_millis(wait_ms), &Progress::silent())
    }

    #[test]
    fn a_second_writer_is_kept_out_until_the_first_is_done() {
        let folder = tempfile::tempdir().unwrap();
        let first = take(folder.path(), 0).unwrap();
        let Err(ProjectError::Locked { holder, .. }) = take(folder.path(), 60) else { panic!("it is held") };
        assert!(holder.unwrap().starts_with(&format!("process {}", std::process::id())));
        drop(first);
        assert_eq!(std::fs::read(folder.path().join("lock")).unwrap(), b"");
        take(folder.path(), 0).unwrap();
    }

    #[test]
    fn who_waits_gets_the_lock_when_it_is_released() {
        let folder = tempfile::tempdir().unwrap();
        let first = take(folder.path(), 0).unwrap();
        let root = folder.path().to_owned();
        let second = thread::spawn(move || take(&root, 60_000).is_ok());
        thread::sleep(Duration::from_millis(120));
        drop(first);
        assert!(second.join().unwrap());
    }

    #[test]
    fn waiting_can_be_cancelled() {
        let folder = tempfile::tempdir().unwrap();
        let _first = take(folder.path(), 0).unwrap();
        let progress = Progress::silent();
        progress.cancel();
        let refused = Lock::take(folder.path(), Duration::from_secs(600), &progress);
        assert!(matches!(refused, Err(ProjectError::Cancelled(_))));
    }
}
