//! Bytes of a file, read at a place.
//!
//! Files that other programs may change, and files on drives that may be lost, are read by calls that fail and
//! not through a memory map: the system ends a program that reads a mapped page whose bytes are gone. A call
//! costs less than half a microsecond beside the copy of its bytes, so that readers ask for as many neighbouring
//! bytes at once as they can use.

use std::fs::{File, Metadata};
use std::io;
use std::path::Path;

/// A file that is read at places, from any thread.
///
/// ```
/// use system::positional::PlacedFile;
///
/// let path = std::env::temp_dir().join(format!("petroglyph-positional-{}", std::process::id()));
/// std::fs::write(&path, "0123456789")?;
/// let file = PlacedFile::open(&path)?;
/// let mut bytes = [0; 3];
/// file.read_exact_at(4, &mut bytes)?;
/// assert_eq!((&bytes, file.metadata()?.len()), (b"456", 10));
/// assert!(file.read_exact_at(8, &mut bytes).is_err());
/// # std::fs::remove_file(path)?;
/// # Ok::<(), std::io::Error>(())
/// ```
#[derive(Debug)]
pub struct PlacedFile(File);

impl PlacedFile {
    /// Opens an ordinary file for reading.
    ///
    /// # Errors
    /// Those of [`crate::file::ordinary`] and of opening.
    pub fn open(path: &Path) -> io::Result<Self> {
        crate::file::ordinary(path)?;
        File::open(path).map(Self)
    }

    /// What the system says about the open file now, even if another one has taken its name.
    ///
    /// # Errors
    /// Those of the system.
    pub fn metadata(&self) -> io::Result<Metadata> {
        self.0.metadata()
    }

    /// Fills `out` with the bytes of the file from `offset` on.
    ///
    /// # Errors
    /// [`io::ErrorKind::UnexpectedEof`] where the file ends before, otherwise those of the system. The content of
    /// `out` is then undefined.
    pub fn read_exact_at(&self, offset: u64, out: &mut [u8]) -> io::Result<()> {
        #[cfg(unix)]
        {
            std::os::unix::fs::FileExt::read_exact_at(&self.0, out, offset)
        }
        #[cfg(windows)]
        {
            let (mut offset, mut rest) = (offset, out);
            while !rest.is_empty() {
                match std::os::windows::fs::FileExt::seek_read(&self.0, rest, offset) {
                    Ok(0) => return Err(io::ErrorKind::UnexpectedEof.into()),
                    Ok(count) => {
                        rest = &mut rest[count..];
                        offset += count as u64;
                    }
                    Err(error) if error.kind() == io::ErrorKind::Interrupted => {}
                    Err(error) => return Err(error),
                }
            }
            Ok(())
        }
    }
}
