//! Where the files of an array lie: a folder, or another place that answers the same two questions.

use std::fmt::Debug;
use std::io;
use std::path::PathBuf;
use system::positional::PlacedFile;

/// Bytes that are read at places.
pub(super) trait PlacedBytes {
    /// How many there are.
    fn length(&self) -> io::Result<u64>;

    /// Fills `out` with the bytes from `offset` on.
    fn read_exact_at(&self, offset: u64, out: &mut [u8]) -> io::Result<()>;
}

impl PlacedBytes for PlacedFile {
    fn length(&self) -> io::Result<u64> {
        Ok(self.metadata()?.len())
    }

    fn read_exact_at(&self, offset: u64, out: &mut [u8]) -> io::Result<()> {
        Self::read_exact_at(self, offset, out)
    }
}

/// The files of an array, by their names below it.
pub(super) trait ArrayFiles: Debug + Send + Sync {
    /// Opens a file.
    fn open(&self, key: &str) -> io::Result<Box<dyn PlacedBytes + '_>>;

    /// Where it is, for errors.
    fn place(&self, key: &str) -> PathBuf;
}

/// Files in a folder.
#[derive(Debug)]
pub(super) struct FolderFiles(pub(super) PathBuf);

impl ArrayFiles for FolderFiles {
    fn open(&self, key: &str) -> io::Result<Box<dyn PlacedBytes + '_>> {
        Ok(Box::new(PlacedFile::open(&self.0.join(key))?))
    }

    fn place(&self, key: &str) -> PathBuf {
        self.0.join(key)
    }
}
