//! Opening and removing inside a folder without ever following a link out of it.
//!
//! On Unix each step is made through a handle on the folder before it (`openat`), so that not even a link that
//! appears meanwhile is followed. Elsewhere each part is looked at before the step, and a link refused.

use std::fs::File;
use std::io;
use std::path::Path;

/// Removes the file or folder at `file` (parts separated by `/`) inside the folder `root`. Of a link the link
/// itself goes.
///
/// # Errors
/// A part of the way is a link or missing, or something cannot be removed.
pub(super) fn remove(root: &Path, file: &str) -> io::Result<()> {
    system::remove(root, file)
}

/// Opens the file `name` of the folder `root` for reading and writing; it is made if it is not there.
///
/// # Errors
/// It is a link, or cannot be opened.
pub(super) fn open(root: &Path, name: &str) -> io::Result<File> {
    system::open(root, name)
}

#[cfg(unix)]
mod system {
    use rustix::fs::{AtFlags, CWD, Dir, FileType, Mode, OFlags, openat, statat, unlinkat};
    use std::ffi::CStr;
    use std::fs::File;
    use std::io;
    use std::os::fd::{AsFd, BorrowedFd, OwnedFd};
    use std::path::Path;

    const FOLDER: OFlags = OFlags::RDONLY.union(OFlags::DIRECTORY).union(OFlags::CLOEXEC);

    pub(super) fn remove(root: &Path, file: &str) -> io::Result<()> {
        let mut folder = openat(CWD, root, FOLDER, Mode::empty())?;
        let mut parts = file.split('/').peekable();
        while let Some(part) = parts.next() {
            if parts.peek().is_some() {
                folder = openat(&folder, part, FOLDER | OFlags::NOFOLLOW, Mode::empty())?;
            } else {
                remove_entry(folder.as_fd(), &std::ffi::CString::new(part)?)?;
            }
        }
        Ok(())
    }

    fn remove_entry(folder: BorrowedFd<'_>, name: &CStr) -> io::Result<()> {
        let facts = statat(folder, name, AtFlags::SYMLINK_NOFOLLOW)?;
        if FileType::from_raw_mode(facts.st_mode) != FileType::Directory {
            return Ok(unlinkat(folder, name, AtFlags::empty())?);
        }
        let inner: OwnedFd = openat(folder, name, FOLDER | OFlags::NOFOLLOW, Mode::empty())?;
        // The names are gathered first: an entry removed while the folder is listed may hide another.
        let names: Vec<_> = Dir::read_from(&inner)?
            .map(|entry| entry.map(|entry| entry.file_name().to_owned()))
            .collect::<Result<_, _>>()?;
        // What cannot be removed keeps nothing else; what is gone already was removed by another program.
        let mut failure = None;
        for inside in names.iter().filter(|name| ![c".", c".."].contains(&name.as_c_str())) {
            match remove_entry(inner.as_fd(), inside) {
                Err(error) if error.kind() != io::ErrorKind::NotFound => failure = failure.or(Some(error)),
                _ => {}
            }
        }
        failure.map_or(Ok(()), Err)?;
        Ok(unlinkat(folder, name, AtFlags::REMOVEDIR)?)
    }

    pub(super) fn open(root: &Path, name: &str) -> io::Result<File> {
        let folder = openat(CWD, root, FOLDER, Mode::empty())?;
        let flags = OFlags::RDWR | OFlags::CREATE | OFlags::NOFOLLOW | OFlags::CLOEXEC;
        Ok(openat(&folder, name, flags, Mode::from_raw_mode(0o666))?.into())
    }
}

#[cfg(not(unix))]
mod system {
    use std::fs::{self, File, OpenOptions};
    use std::io;
    use std::path::Path;

    fn is_link(path: &Path) -> io::Result<bool> {
        match fs::symlink_metadata(path) {
            Ok(facts) => Ok(facts.is_symlink()),
            Err(error) if error.kind() == io::ErrorKind::NotFound => Ok(false),
            Err(error) => Err(error),
        }
    }

    fn refused() -> io::Error {
        io::Error::new(io::ErrorKind::InvalidInput, "it is a link")
    }

    pub fn remove(root: &Path, file: &str) -> io::Result<()> {
        let mut path = root.to_owned();
        let mut parts = file.split('/').peekable();
        while let Some(part) = parts.next() {
            path.push(part);
            if parts.peek().is_some() && is_link(&path)? {
                return Err(refused());
            }
        }
        let facts = fs::symlink_metadata(&path)?;
        if facts.is_dir() {
            fs::remove_dir_all(&path)
        } else {
            // A link to a folder is removed as a folder here.
            fs::remove_file(&path).or_else(|error| fs::remove_dir(&path).map_err(|_| error))
        }
    }

    pub fn open(root: &Path, name: &str) -> io::Result<File> {
        let path = root.join(name);
        if is_link(&path)? {
            return Err(refused());
        }
        OpenOptions::new().create(true).truncate(false).read(true).write(true).open(path)
    }
}

#[cfg(all(test, unix))]
mod tests {
    use super::*;
    use std::fs;

    #[test]
    fn two_that_remove_one_folder_leave_nothing_of_it() {
        let folder = tempfile::tempdir().unwrap();
        let root = folder.path();
        for round in 0..20 {
            let file = format!("derived/{round}");
            for inner in ["a", "b/c", "b/d"] {
                fs::create_dir_all(root.join(&file).join(inner)).unwrap();
                (0..20).for_each(|n| fs::write(root.join(&file).join(inner).join(n.to_string()), "").unwrap());
            }
            std::thread::scope(|scope| {
                (0..2).for_each(|_| drop(scope.spawn(|| remove(root, &file))));
            });
            assert!(!root.join(&file).exists(), "round {round}");
        }
    }
}
