//! Reading a file whole, whatever it is: ordinary files of a stated size only.
//!
//! Projects and the files around them may come from anyone. A pipe would wait for ever, a device such as
//! `/dev/zero` never ends, and a file may be larger than memory. [`read`] refuses all three before it takes
//! any memory.

use std::fs::{self, File};
use std::io::{self, Read};
use std::path::Path;

/// Most bytes of a document that people write or read: a project's state, a step of its history, a scene,
/// settings.
pub const MAX_DOCUMENT_BYTES: u64 = 64 << 20;

/// Most bytes of an interpretation: a horizon, a fault, a well, proposals.
pub const MAX_INTERPRETATION_BYTES: u64 = 1 << 30;

/// What the system knows of an ordinary file. It is told by its kind before it is opened, since opening a
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

/// The content of an ordinary file of at most `limit` bytes.
///
/// ```
/// let folder = std::env::temp_dir();
/// assert!(survey::file::read(&folder, 10).unwrap_err().to_string().contains("not an ordinary file"));
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

#[cfg(test)]
mod tests {
    use super::*;

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
