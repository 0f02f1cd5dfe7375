//! Reading a file whole, whatever it is: ordinary files of a stated size only. And making sure that what was written
//! is there after a power cut.
//!
//! Projects and the files around them may come from anyone. A pipe would wait for ever, a device such as
//! `/dev/zero` never ends, and a file may be larger than memory. [`read`] refuses all three before it takes
//! any memory.
//!
//! A file that was made or renamed is there after a power cut when the folder that names it was flushed
//! ([`sync_folder`]), and that folder is there when the folder above it was ([`create_folders`]).

use crate::memory;
use std::fmt;
use std::fs::{self, File};
use std::io::{self, Read};
use std::path::Path;

/// Most bytes of a document that people write or read: a project's state, a step of its history, a scene,
/// settings.
pub const MAX_DOCUMENT_BYTES: u64 = 64 << 20;

/// Most bytes of an interpretation: a horizon, a fault, a well, proposals.
pub const MAX_INTERPRETATION_BYTES: u64 = 1 << 30;

/// What was being done with a file when it failed.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum FileAction {
    /// It was read, or asked for.
    Read,
    /// It was made, written, renamed or removed.
    Written,
    /// It was made sure that a power cut would not undo what was written.
    Flushed,
    /// It was locked against other programs.
    Locked,
}

impl fmt::Display for FileAction {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Read => "read",
            Self::Written => "written",
            Self::Flushed => "flushed to the disk",
            Self::Locked => "locked",
        })
    }
}

/// What the system knows of an ordinary file. Its kind is known before it is opened, since opening a
/// pipe waits.
///
/// # Errors
/// [`io::ErrorKind::InvalidInput`] for anything but an ordinary file, and those of asking.
pub fn ordinary(path: &Path) -> io::Result<fs::Metadata> {
    let facts = fs::metadata(path)?;
    if facts.is_file() {
        return Ok(facts);
    }
    let kind = if facts.is_dir() { "a folder" } else { "a pipe or device" };
    Err(io::Error::new(io::ErrorKind::InvalidInput, format!("it is {kind}, not an ordinary file")))
}

/// Whether a failure to read says nothing of what a file holds: it could not be looked at now, for want of a permission,
/// of handles or of memory, or because the disk or the network failed. That something is missing, of another kind or cut
/// off is known.
///
/// ```
/// use std::io::{Error, ErrorKind};
/// assert!(system::file::says_nothing(&Error::from(ErrorKind::PermissionDenied)));
/// # #[cfg(unix)]
/// assert!(system::file::says_nothing(&Error::from_raw_os_error(24)), "too many open files");
/// assert!(!system::file::says_nothing(&Error::from(ErrorKind::NotFound)));
/// assert!(!system::file::says_nothing(&Error::other("a checksum does not fit")));
/// ```
pub fn says_nothing(error: &io::Error) -> bool {
    use io::ErrorKind::{IsADirectory, NotADirectory, NotFound, OutOfMemory, PermissionDenied, UnexpectedEof};
    match error.kind() {
        NotFound | NotADirectory | IsADirectory | UnexpectedEof => false,
        PermissionDenied | OutOfMemory => true,
        // What only a decoder or this program says has no code of the system.
        _ => error.raw_os_error().is_some(),
    }
}

/// Bytes that whoever runs this may still write to the disk of a folder, which may yet have to be made; `None` where the
/// system does not tell.
#[cfg(unix)]
pub fn room(folder: &Path) -> Option<u64> {
    let here = folder.ancestors().find(|folder| folder.exists()).unwrap_or(Path::new("."));
    let disk = rustix::fs::statvfs(here).ok().filter(|disk| disk.f_blocks > 0)?;
    disk.f_bavail.checked_mul(disk.f_frsize)
}

/// The system is not asked.
#[cfg(not(unix))]
pub fn room(_folder: &Path) -> Option<u64> {
    None
}

/// Checks that so many bytes fit on the disk of a folder.
///
/// ```
/// let folder = std::env::temp_dir();
/// assert!(system::file::check_room(&folder, 1).is_ok());
/// # #[cfg(unix)]
/// assert!(system::file::check_room(&folder, u64::MAX).unwrap_err().to_string().contains("room for"));
/// ```
///
/// # Errors
/// [`io::ErrorKind::StorageFull`].
pub fn check_room(folder: &Path, bytes: u64) -> io::Result<()> {
    match room(folder) {
        Some(room) if room < bytes => {
            let [bytes, room] = [bytes, room].map(|bytes| memory::size(Some(bytes)));
            let message = format!("it takes {bytes}, and the disk has room for {room}");
            Err(io::Error::new(io::ErrorKind::StorageFull, message))
        }
        _ => Ok(()),
    }
}

/// The content of an ordinary file of at most `limit` bytes.
///
/// ```
/// let folder = std::env::temp_dir();
/// assert!(system::file::read(&folder, 10).unwrap_err().to_string().contains("not an ordinary file"));
/// ```
///
/// # Errors
/// [`io::ErrorKind::InvalidInput`] for anything but an ordinary file, [`io::ErrorKind::FileTooLarge`] above
/// the limit, and those of reading.
pub fn read(path: &Path, limit: u64) -> io::Result<Vec<u8>> {
    let facts = ordinary(path)?;
    let too_large = |bytes: u64| {
        let message = format!("it has {bytes} bytes, more than the {limit} that such a file may have");
        Err(io::Error::new(io::ErrorKind::FileTooLarge, message))
    };
    if facts.len() > limit {
        return too_large(facts.len());
    }
    let mut content = Vec::new();
    content.try_reserve(facts.len() as usize)?;
    // A file may grow after it was looked at.
    File::open(path)?.take(limit + 1).read_to_end(&mut content)?;
    if content.len() as u64 > limit { too_large(content.len() as u64) } else { Ok(content) }
}

/// The text of an ordinary file of at most `limit` bytes.
///
/// # Errors
/// As [`read`], and [`io::ErrorKind::InvalidData`] for what is not UTF-8.
pub fn read_text(path: &Path, limit: u64) -> io::Result<String> {
    String::from_utf8(read(path, limit)?)
        .map_err(|error| io::Error::new(io::ErrorKind::InvalidData, error.utf8_error()))
}

/// Flushes the entries of a folder to the disk: what was made, renamed or deleted in it is so after a power cut.
///
/// Nothing is done where this is impossible, which is known of some systems and file systems: they call it invalid or
/// unsupported for a folder, or the folder may be written but not opened. Every other failure means that the disk may
/// not have what was written.
///
/// # Errors
/// The disk fails, or there is no such folder.
pub fn sync_folder(folder: &Path) -> io::Result<()> {
    if !cfg!(unix) {
        return Ok(());
    }
    let flushed = match File::open(or_here(folder)) {
        Ok(handle) => handle.sync_all(),
        Err(error) if error.kind() == io::ErrorKind::PermissionDenied => return Ok(()),
        Err(error) => return Err(error),
    };
    match flushed {
        Err(error) if is_impossible(&error) => Ok(()),
        flushed => flushed,
    }
}

/// Whether an error says that a folder cannot be flushed at all. Some network file systems know the handle of a folder
/// for no handle to flush.
fn is_impossible(error: &io::Error) -> bool {
    const BAD_HANDLE: i32 = 9;
    matches!(error.kind(), io::ErrorKind::InvalidInput | io::ErrorKind::Unsupported)
        || error.raw_os_error() == Some(BAD_HANDLE)
}

/// Makes a folder and those above it that are missing. Those that were made are there after a power cut.
///
/// # Errors
/// One of them cannot be made, or the disk fails.
pub fn create_folders(folder: &Path) -> io::Result<()> {
    let folder = or_here(folder);
    if folder.is_dir() {
        return Ok(());
    }
    let above = folder.parent().unwrap_or(folder);
    if above != folder {
        create_folders(above)?;
    }
    match fs::create_dir(folder) {
        // Another process was quicker.
        Err(_) if folder.is_dir() => {}
        made => made?,
    }
    sync_folder(above)
}

/// The folder, or the present one where a name alone has none.
fn or_here(folder: &Path) -> &Path {
    if folder.as_os_str().is_empty() { Path::new(".") } else { folder }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn folders_are_made_and_flushed_and_only_what_is_impossible_is_no_failure() {
        let top = std::env::temp_dir().join(format!("petroglyph-folders-{}", std::process::id()));
        create_folders(&top.join("a/b")).unwrap();
        create_folders(&top.join("a/b")).unwrap();
        assert!(top.join("a/b").is_dir());
        for folder in [top.as_path(), Path::new(""), Path::new(".")] {
            sync_folder(folder).unwrap();
        }
        #[cfg(unix)]
        assert_eq!(sync_folder(&top.join("none")).unwrap_err().kind(), io::ErrorKind::NotFound);
        fs::write(top.join("file"), "").unwrap();
        assert!(create_folders(&top.join("file/c")).is_err());
        fs::remove_dir_all(&top).unwrap();
        #[cfg(target_os = "linux")]
        for (number, expected) in [(22, true), (95, true), (9, true), (5, false), (28, false), (116, false)] {
            assert_eq!(is_impossible(&io::Error::from_raw_os_error(number)), expected, "{number}");
        }
    }

    #[test]
    #[cfg(unix)]
    fn what_never_ends_is_refused_before_it_is_read() {
        let error = read(Path::new("/dev/zero"), 10).unwrap_err();
        assert_eq!(error.kind(), io::ErrorKind::InvalidInput);
    }

    #[test]
    fn the_limit_is_the_last_size_that_is_read() {
        let path = std::env::temp_dir().join(format!("petroglyph-file-{}", std::process::id()));
        fs::write(&path, "twelve bytes").unwrap();
        assert_eq!(read(&path, 12).unwrap(), b"twelve bytes");
        assert_eq!(read_text(&path, 12).unwrap(), "twelve bytes");
        assert_eq!(read(&path, 11).unwrap_err().kind(), io::ErrorKind::FileTooLarge);
        fs::remove_file(&path).unwrap();
    }
}
