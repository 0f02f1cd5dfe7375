//! Named arrays in a folder: where a computation in bricks spills what does not fit into memory.
//!
//! ```text
//! FOLDER/ARRAY/PART     the bytes, and their crc32c
//! FOLDER/.system        the start of the system in which they were written
//! FOLDER/.packed        where it is there, the bytes are packed ([`crate::block_file`])
//! ```
//!
//! Packed parts take four fifths of the disk, and an extraction with them a quarter more processor time: they
//! are for disks that have no room for others. Which they are is chosen when the folder is made, and holds for all processes.
//!
//! A part is written beside its place and renamed, so that a killed program leaves whole parts only. Parts are not
//! flushed: after a power cut nothing of them is believed, which the number that the system gives itself at its start
//! tells.

use super::block_file::{self, PackedFile};
use super::error::StoreError;
use std::collections::VecDeque;
use std::fs;
use std::io::{self, ErrorKind};
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::time::{SystemTime, UNIX_EPOCH};
use survey::arrays::NamedArrays;
use survey::source::SourceError;
use system::file::FileAction;
use system::positional::PlacedFile;

/// Bytes of a checksum.
const CHECKSUM: usize = 4;

/// Files that stay open: tasks read many short stretches of the same few parts.
const OPEN_FILES: usize = 64;

/// The file that tells in which start of the system the folder was written.
const SYSTEM: &str = ".system";

/// The file that tells that parts are packed.
const PACKED: &str = ".packed";

/// Where Linux tells its present start.
const PRESENT_START: &str = "/proc/sys/kernel/random/boot_id";

/// Named arrays in a folder.
#[derive(Debug)]
pub struct FolderArrays {
    folder: PathBuf,
    is_packed: bool,
    /// When it was opened, nanoseconds: with the number of the process, no other one's on any machine.
    since: u128,
    opened: Mutex<VecDeque<OpenPart>>,
}

/// A part that was read.
#[derive(Debug)]
struct OpenPart {
    array: String,
    part: usize,
    content: Arc<Content>,
}

/// The bytes of a part.
#[derive(Debug)]
enum Content {
    Plain(PlacedFile),
    Packed(PackedFile),
}

impl Content {
    fn length(&self) -> io::Result<u64> {
        match self {
            Self::Plain(file) => {
                file.metadata()?.len().checked_sub(CHECKSUM as u64).ok_or_else(|| ErrorKind::UnexpectedEof.into())
            }
            Self::Packed(file) => Ok(file.length()),
        }
    }

    fn read_exact_at(&self, offset: u64, out: &mut [u8]) -> io::Result<()> {
        match self {
            Self::Plain(file) => file.read_exact_at(offset, out),
            Self::Packed(file) => file.read_exact_at(offset, out),
        }
    }
}

impl FolderArrays {
    /// Opens a folder, or makes it, with packed parts or others. What is there is kept, packed or not, if the system has not
    /// been started again since it was written.
    ///
    /// # Errors
    /// The folder cannot be made or emptied.
    pub fn open(folder: &Path, is_packed: bool) -> Result<Self, StoreError> {
        let fail = |source| StoreError::io(FileAction::Written, folder, source);
        // Where a system does not tell, nothing is kept.
        let present = fs::read_to_string(PRESENT_START).unwrap_or_default();
        let noted = fs::read_to_string(folder.join(SYSTEM)).unwrap_or_default();
        if folder.exists() && (present.is_empty() || present != noted) {
            fs::remove_dir_all(folder).map_err(fail)?;
        }
        if !folder.exists() {
            fs::create_dir_all(folder).map_err(fail)?;
            if is_packed {
                fs::write(folder.join(PACKED), "").map_err(fail)?;
            }
        }
        // Last: a folder without it is made anew.
        fs::write(folder.join(SYSTEM), present).map_err(fail)?;
        Ok(Self::at(folder))
    }

    /// The folder that another process has opened, perhaps on another machine.
    ///
    /// # Errors
    /// There is none.
    pub fn shared(folder: &Path) -> Result<Self, StoreError> {
        fs::read_dir(folder).map_err(|source| StoreError::io(FileAction::Read, folder, source))?;
        Ok(Self::at(folder))
    }

    fn at(folder: &Path) -> Self {
        let since = SystemTime::now().duration_since(UNIX_EPOCH).unwrap_or_default().as_nanos();
        let is_packed = folder.join(PACKED).exists();
        Self { folder: folder.to_owned(), is_packed, since, opened: Mutex::default() }
    }

    fn path(&self, array: &str, part: usize) -> PathBuf {
        let part = if part == usize::MAX { "all".to_owned() } else { part.to_string() };
        self.folder.join(array).join(part)
    }

    fn opened(&self) -> MutexGuard<'_, VecDeque<OpenPart>> {
        self.opened.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// The content of a part, which may be open already.
    fn content(&self, array: &str, part: usize) -> io::Result<Arc<Content>> {
        let mut opened = self.opened();
        if let Some(known) = opened.iter().find(|known| known.part == part && known.array == array) {
            return Ok(Arc::clone(&known.content));
        }
        let path = self.path(array, part);
        let content = Arc::new(if self.is_packed {
            Content::Packed(PackedFile::open(&path, CHECKSUM)?)
        } else {
            Content::Plain(PlacedFile::open(&path)?)
        });
        if opened.len() == OPEN_FILES {
            opened.pop_front();
        }
        opened.push_back(OpenPart { array: array.to_owned(), part, content: Arc::clone(&content) });
        Ok(content)
    }

    fn fail(&self, action: FileAction, array: &str, part: usize, source: io::Error) -> SourceError {
        if source.kind() == ErrorKind::UnexpectedEof || source.kind() == ErrorKind::NotFound {
            let reason = format!("its part {part} is missing or was cut off");
            return Box::new(StoreError::damaged(&self.folder, array, reason));
        }
        Box::new(StoreError::io(action, &self.path(array, part), source))
    }
}

impl NamedArrays for FolderArrays {
    fn write(&self, array: &str, part: usize, bytes: &[u8]) -> Result<(), SourceError> {
        static COUNT: AtomicU64 = AtomicU64::new(0);
        let path = self.path(array, part);
        let own = format!(".{}-{:x}-{}", std::process::id(), self.since, COUNT.fetch_add(1, Ordering::Relaxed));
        let partial = self.folder.join(array).join(own);
        let write = || -> io::Result<()> {
            use io::Write;
            let mut file = fs::File::create(&partial)?;
            if self.is_packed {
                return block_file::write(&mut file, bytes);
            }
            file.write_all(bytes)?;
            file.write_all(&crc32c::crc32c(bytes).to_le_bytes())
        };
        let written = match write() {
            Err(error) if error.kind() == ErrorKind::NotFound => {
                // Not the folder itself: a process that was thought lost must not make again what was removed.
                match fs::create_dir(self.folder.join(array)) {
                    Err(error) if error.kind() != ErrorKind::AlreadyExists => Err(error),
                    _ => write(),
                }
            }
            written => written,
        };
        written.and_then(|()| fs::rename(&partial, &path)).map_err(|source| {
            let _ = fs::remove_file(&partial);
            self.fail(FileAction::Written, array, part, source)
        })?;
        self.opened().retain(|known| known.part != part || known.array != array);
        Ok(())
    }

    fn is_whole(&self, array: &str, part: usize) -> bool {
        let Ok(bytes) = fs::read(self.path(array, part)) else { return false };
        let Some((content, sum)) = bytes.split_last_chunk::<CHECKSUM>() else { return false };
        crc32c::crc32c(content) == u32::from_le_bytes(*sum)
    }

    fn length(&self, array: &str, part: usize) -> Result<u64, SourceError> {
        self.content(array, part)
            .and_then(|content| content.length())
            .map_err(|source| self.fail(FileAction::Read, array, part, source))
    }

    fn read(&self, array: &str, part: usize, offset: u64, out: &mut [u8]) -> Result<(), SourceError> {
        self.content(array, part)
            .and_then(|content| content.read_exact_at(offset, out))
            .map_err(|source| self.fail(FileAction::Read, array, part, source))
    }

    fn remove(&self, array: &str) {
        self.opened().retain(|known| known.array != array);
        // What cannot be removed goes with the folder.
        let _ = fs::remove_dir_all(self.folder.join(array));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn parts_come_back_and_damage_is_noticed() {
        [false, true].into_iter().for_each(check_parts);
    }

    fn check_parts(is_packed: bool) {
        let folder = tempfile::tempdir().unwrap();
        let arrays = FolderArrays::open(&folder.path().join("spilled"), is_packed).unwrap();
        assert!(!arrays.is_whole("z-0", 3));
        arrays.write("z-0", 3, b"0123456789").unwrap();
        arrays.write("done", usize::MAX, b"").unwrap();
        let mut out = [0; 4];
        arrays.read("z-0", 3, 2, &mut out).unwrap();
        assert_eq!((&out, arrays.length("z-0", 3).unwrap()), (b"2345", 10));
        arrays.write("z-0", 3, b"9876543210").unwrap();
        arrays.read("z-0", 3, 2, &mut out).unwrap();
        assert_eq!(&out, b"7654");
        assert!(arrays.is_whole("z-0", 3) && arrays.is_whole("done", usize::MAX));
        let missing = arrays.read("z-0", 4, 0, &mut out).unwrap_err().to_string();
        assert!(missing.contains("z-0") && missing.contains("missing"), "{missing}");
        // Opened again it is still there, packed as it was; what was altered is not whole.
        let again = FolderArrays::open(&folder.path().join("spilled"), !is_packed).unwrap();
        assert_eq!(again.length("z-0", 3).ok(), Path::new(PRESENT_START).exists().then_some(10));
        assert_eq!(again.is_whole("z-0", 3), Path::new(PRESENT_START).exists());
        arrays.write("z-0", 3, b"0123456789").unwrap();
        let path = folder.path().join("spilled/z-0/3");
        let mut bytes = fs::read(&path).unwrap();
        bytes[1] ^= 1;
        fs::write(&path, bytes).unwrap();
        assert!(!again.is_whole("z-0", 3));
        again.remove("z-0");
        assert!(again.length("z-0", 3).is_err());
        arrays.remove("z-0");
        assert!(arrays.read("z-0", 3, 0, &mut out).is_err());
    }

    #[test]
    fn another_machine_sees_the_arrays_and_makes_no_folder_of_its_own() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("spilled");
        assert!(FolderArrays::shared(&path).is_err());
        FolderArrays::open(&path, false).unwrap().write("z", 0, b"1").unwrap();
        fs::write(path.join(SYSTEM), "another").unwrap();
        let shared = FolderArrays::shared(&path).unwrap();
        assert!(shared.is_whole("z", 0));
        shared.write("y", 4, b"23").unwrap();
        assert!(shared.is_whole("y", 4) && shared.length("y", 4).unwrap() == 2);
        fs::remove_dir_all(&path).unwrap();
        assert!(shared.write("x", 0, b"1").is_err() && !path.exists());
    }

    #[test]
    fn what_another_start_of_the_system_left_is_not_believed() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("spilled");
        FolderArrays::open(&path, false).unwrap().write("z", 0, b"1").unwrap();
        fs::write(path.join(SYSTEM), "another").unwrap();
        assert!(!FolderArrays::open(&path, false).unwrap().is_whole("z", 0));
    }
}
