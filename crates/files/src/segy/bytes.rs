//! The bytes of a SEG-Y file, read at a place, and whether they are still those that were there at the
//! beginning.
//!
//! The file is somebody else's: it may be cut off, written to or lost with its drive while it is read. Every
//! such access ends in an error that names the trace and the byte.

use super::error::SegyProblem;
use std::hash::Hasher;
use std::io;
use std::ops::Range;
use std::path::{Path, PathBuf};
use std::time::SystemTime;
use system::positional::PlacedFile;

/// Bytes that are read at once, at most, where a trace is shorter: they stay in the processor's cache while
/// they are decoded.
pub(super) const BYTES_TOGETHER: usize = 256 << 10;

/// Pieces of the file that its stamp is made of, and bytes of each.
const PIECES: u64 = 64;
const PIECE_BYTES: u64 = 4096;

/// What a file was like at a moment: two stamps are equal while nothing has written to it.
///
/// The sample of bytes notices writers that leave length and time as they are: programs that restore the
/// time, and file systems that note it late.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Stamp {
    /// Bytes of the file.
    pub length: u64,
    /// When it was last written to, if the system tells.
    pub modified: Option<SystemTime>,
    /// Hash of 64 pieces of 4096 bytes, spread evenly from its first to its last byte.
    pub sample: u64,
}

impl Stamp {
    fn of(file: &PlacedFile) -> io::Result<Self> {
        let metadata = file.metadata()?;
        let (length, modified) = (metadata.len(), metadata.modified().ok());
        let mut hash = Fnv::default();
        let mut piece = vec![0; PIECE_BYTES.min(length) as usize];
        let last = length - piece.len() as u64;
        for n in 0..PIECES {
            file.read_exact_at(last / (PIECES - 1) * n + last % (PIECES - 1) * n / (PIECES - 1), &mut piece)?;
            hash.write(&piece);
        }
        Ok(Self { length, modified, sample: hash.finish() })
    }

    /// What differs between two stamps of a file.
    fn difference(&self, now: &Self) -> Option<String> {
        if self.length != now.length {
            return Some(format!("it had {} bytes and has {} now", self.length, now.length));
        }
        if self.modified != now.modified {
            return Some("its time of modification is another one".to_owned());
        }
        (self.sample != now.sample).then(|| "its bytes are others".to_owned())
    }
}

/// The hash FNV-1a (Fowler, Noll and Vo), which is the same in every version of the program.
#[derive(Debug)]
struct Fnv(u64);

impl Default for Fnv {
    fn default() -> Self {
        Self(0xcbf2_9ce4_8422_2325)
    }
}

impl Hasher for Fnv {
    fn write(&mut self, bytes: &[u8]) {
        self.0 = bytes.iter().fold(self.0, |hash, &byte| (hash ^ u64::from(byte)).wrapping_mul(0x100_0000_01b3));
    }

    fn finish(&self) -> u64 {
        self.0
    }
}

/// Where the bytes of a file are.
#[derive(Debug)]
pub(super) enum Bytes {
    /// On disk.
    File { file: PlacedFile, path: PathBuf, stamp: Stamp },
    /// In memory.
    Held(Vec<u8>),
}

impl Bytes {
    /// Opens a file and stamps it.
    pub(super) fn open(path: &Path) -> Result<Self, SegyProblem> {
        let io = |doing, hint| move |source| SegyProblem::Io { doing, hint, source };
        let file = PlacedFile::open(path).map_err(|source| match source.kind() {
            io::ErrorKind::InvalidInput => io("read it", "give a file, not a folder or a device")(source),
            _ => io("open it", "check the name and that you may read it")(source),
        })?;
        let metadata = file.metadata().map_err(io("ask for its length", "check the disk"))?;
        if metadata.len() == 0 {
            return Err(SegyProblem::TooShort { bytes: 0 });
        }
        let stamp = Stamp::of(&file).map_err(io("read it", "check the disk or the network connection"))?;
        Ok(Self::File { file, path: path.to_owned(), stamp })
    }

    /// Count of bytes, when the file was opened.
    pub(super) fn len(&self) -> u64 {
        match self {
            Self::File { stamp, .. } => stamp.length,
            Self::Held(bytes) => bytes.len() as u64,
        }
    }

    /// The stamp of a file on disk when it was opened.
    pub(super) fn stamp(&self) -> Option<Stamp> {
        match self {
            Self::File { stamp, .. } => Some(*stamp),
            Self::Held(_) => None,
        }
    }

    /// Fails where the file, or the one that has its name now, is no longer what was opened.
    pub(super) fn check_unchanged(&self) -> Result<(), SegyProblem> {
        let Self::File { file, path, stamp } = self else { return Ok(()) };
        let changed = |what| SegyProblem::Changed { what };
        let now = Stamp::of(file).map_err(|error| changed(format!("it can no longer be read: {error}")))?;
        if let Some(what) = stamp.difference(&now) {
            return Err(changed(what));
        }
        let named = std::fs::metadata(path).map_err(|error| changed(format!("it is no longer there: {error}")))?;
        if named.len() != stamp.length || named.modified().ok() != stamp.modified {
            return Err(changed("another file has taken its name".to_owned()));
        }
        Ok(())
    }

    /// The bytes of `range`, those in memory as they are, those on disk by way of `room`. `trace` is the number
    /// in the file, from 0, of the first trace that they belong to, for errors.
    pub(super) fn read<'a>(
        &'a self,
        range: Range<u64>,
        room: &'a mut Vec<u8>,
        trace: Option<usize>,
    ) -> Result<&'a [u8], SegyProblem> {
        let count = (range.end - range.start) as usize;
        match self {
            Self::Held(bytes) => Ok(&bytes[range.start as usize..range.end as usize]),
            Self::File { .. } => {
                if room.len() < count {
                    room.resize(count, 0);
                }
                self.copy(range.start, &mut room[..count], trace)?;
                Ok(&room[..count])
            }
        }
    }

    /// `count` bytes from `offset` on; none where the file, as it was opened, ends before.
    pub(super) fn get(&self, offset: u64, count: usize, trace: Option<usize>) -> Result<Option<Vec<u8>>, SegyProblem> {
        if offset.checked_add(count as u64).is_none_or(|end| end > self.len()) {
            return Ok(None);
        }
        let mut out = vec![0; count];
        self.copy(offset, &mut out, trace)?;
        Ok(Some(out))
    }

    /// Fills `out` with the bytes from `offset` on; they must have been in the file when it was opened.
    pub(super) fn copy(&self, offset: u64, out: &mut [u8], trace: Option<usize>) -> Result<(), SegyProblem> {
        match self {
            Self::Held(bytes) => {
                out.copy_from_slice(&bytes[offset as usize..][..out.len()]);
                Ok(())
            }
            Self::File { file, stamp, .. } => file.read_exact_at(offset, out).map_err(|source| {
                let (byte, trace) = (offset + 1, trace.map(|trace| trace as u64 + 1));
                match file.metadata() {
                    Ok(now) if now.len() < stamp.length => {
                        SegyProblem::Shortened { trace, byte, before: stamp.length, now: now.len() }
                    }
                    _ => SegyProblem::Unreadable { trace, byte, source },
                }
            }),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::fs;

    #[test]
    fn a_stamp_notices_length_time_and_bytes() {
        let dir = tempfile::tempdir().unwrap();
        let path = dir.path().join("a.sgy");
        let content: Vec<u8> = (0..1_000_000_u32).map(|n| (n % 251) as u8).collect();
        let at_noon = SystemTime::UNIX_EPOCH + std::time::Duration::from_secs(1_000_000_000);
        let write = |bytes: &[u8], time: SystemTime| {
            fs::write(&path, bytes).unwrap();
            fs::File::options().write(true).open(&path).unwrap().set_modified(time).unwrap();
        };
        let whole = content.as_slice();
        let mut first = content.clone();
        first[0] ^= 1;
        let mut last = content.clone();
        last[999_999] ^= 1;
        write(whole, at_noon);
        let bytes = Bytes::open(&path).unwrap();
        bytes.check_unchanged().unwrap();
        let later = at_noon + std::time::Duration::from_nanos(100);
        for (changed, time, said) in [
            (&whole[..999_999], at_noon, "999999 now"),
            (whole, later, "time of modification"),
            (&first, at_noon, "bytes are others"),
            (&last, at_noon, "bytes are others"),
        ] {
            write(changed, time);
            let problem = bytes.check_unchanged().unwrap_err();
            assert!(matches!(&problem, SegyProblem::Changed { what } if what.contains(said)), "{said}: {problem}");
        }
        write(whole, at_noon);
        bytes.check_unchanged().unwrap();
        fs::rename(&path, dir.path().join("b.sgy")).unwrap();
        assert!(bytes.check_unchanged().unwrap_err().to_string().contains("no longer there"));
        write(&[1; 10], at_noon);
        assert!(bytes.check_unchanged().unwrap_err().to_string().contains("taken its name"));
    }

    #[test]
    fn bytes_that_are_gone_are_an_error_with_their_place() {
        let dir = tempfile::tempdir().unwrap();
        let path = dir.path().join("a.sgy");
        fs::write(&path, vec![7; 10_000]).unwrap();
        let bytes = Bytes::open(&path).unwrap();
        fs::File::options().write(true).open(&path).unwrap().set_len(5000).unwrap();
        let mut room = Vec::new();
        assert_eq!(bytes.read(4000..5000, &mut room, Some(1)).unwrap(), [7; 1000]);
        let problem = bytes.read(4500..5001, &mut room, Some(1)).unwrap_err();
        assert!(
            matches!(problem, SegyProblem::Shortened { trace: Some(2), byte: 4501, before: 10_000, now: 5000 }),
            "{problem}"
        );
    }

    #[test]
    fn pieces_of_a_stamp_reach_from_the_first_to_the_last_byte_of_any_file() {
        let dir = tempfile::tempdir().unwrap();
        let path = dir.path().join("a.sgy");
        for length in [1, 100, 4096, 4097, 70_000] {
            fs::write(&path, vec![1; length]).unwrap();
            let before = Stamp::of(&PlacedFile::open(&path).unwrap()).unwrap();
            let mut other = vec![1; length];
            other[length - 1] = 2;
            fs::write(&path, other).unwrap();
            assert_ne!(before.sample, Stamp::of(&PlacedFile::open(&path).unwrap()).unwrap().sample, "{length}");
        }
    }
}
