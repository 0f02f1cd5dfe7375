//! A file of bytes in blocks that are packed each on its own (zstd), so that any stretch of it can be read.
//!
//! ```text
//! the packed blocks | where each ends, u64 | length of what was packed, u64 | crc32c of all before it
//! ```

use std::cell::RefCell;
use std::io::{self, ErrorKind, Write};
use std::path::Path;
use std::sync::{Mutex, PoisonError};
use system::positional::PlacedFile;
use zstd::bulk::{Compressor, Decompressor};

/// Bytes of a block before it is packed: a short stretch that is read costs unpacking one.
const BLOCK: usize = 16 << 10;

/// The fastest level of zstd that saves something on coordinates.
const LEVEL: i32 = 1;

/// Bytes of a number at the end of the file.
const NUMBER: usize = size_of::<u64>();

/// Writes bytes in packed blocks, and their crc32c.
pub(crate) fn write(file: &mut impl Write, bytes: &[u8]) -> io::Result<()> {
    let mut packer = Compressor::new(LEVEL)?;
    let mut packed = Vec::with_capacity(zstd::zstd_safe::compress_bound(BLOCK));
    let (mut sum, mut end, mut tail) = (0, 0, Vec::new());
    for block in bytes.chunks(BLOCK) {
        packed.clear();
        end += packer.compress_to_buffer(block, &mut packed)? as u64;
        tail.extend(end.to_le_bytes());
        sum = crc32c::crc32c_append(sum, &packed);
        file.write_all(&packed)?;
    }
    tail.extend((bytes.len() as u64).to_le_bytes());
    sum = crc32c::crc32c_append(sum, &tail);
    tail.extend(sum.to_le_bytes());
    file.write_all(&tail)
}

/// A file in packed blocks that is read at places, from any thread.
#[derive(Debug)]
pub(crate) struct PackedFile {
    file: PlacedFile,
    length: u64,
    /// Where each block ends.
    ends: Vec<u64>,
    /// The block that was unpacked last, since readers mostly go on where they were.
    last: Mutex<(usize, Vec<u8>)>,
}

impl PackedFile {
    /// Opens a file, whose last `checksum` bytes are not looked at.
    ///
    /// # Errors
    /// Those of the file; [`ErrorKind::UnexpectedEof`] where it was cut off.
    pub(crate) fn open(path: &Path, checksum: usize) -> io::Result<Self> {
        let file = PlacedFile::open(path)?;
        let cut_off = || io::Error::from(ErrorKind::UnexpectedEof);
        let end = file.metadata()?.len().checked_sub((checksum + NUMBER) as u64).ok_or_else(cut_off)?;
        let mut number = [0; NUMBER];
        file.read_exact_at(end, &mut number)?;
        let length = u64::from_le_bytes(number);
        let table = length.div_ceil(BLOCK as u64).checked_mul(NUMBER as u64).ok_or_else(cut_off)?;
        let start = end.checked_sub(table).ok_or_else(cut_off)?;
        let mut bytes = vec![0; table as usize];
        file.read_exact_at(start, &mut bytes)?;
        let ends = bytes.as_chunks::<NUMBER>().0.iter().map(|end| u64::from_le_bytes(*end)).collect();
        Ok(Self { file, length, ends, last: Mutex::new((usize::MAX, Vec::new())) })
    }

    /// Count of bytes that were packed.
    pub(crate) fn length(&self) -> u64 {
        self.length
    }

    /// Fills `out` with the unpacked bytes from `offset` on.
    ///
    /// # Errors
    /// Those of the file; [`ErrorKind::UnexpectedEof`] where it was cut off or ends before that.
    pub(crate) fn read_exact_at(&self, offset: u64, out: &mut [u8]) -> io::Result<()> {
        if offset.checked_add(out.len() as u64).is_none_or(|end| end > self.length) {
            return Err(ErrorKind::UnexpectedEof.into());
        }
        let mut at = offset;
        let mut rest = out;
        while !rest.is_empty() {
            let (block, from) = ((at / BLOCK as u64) as usize, (at % BLOCK as u64) as usize);
            let whole = self.bytes_of(block);
            let count = rest.len().min(whole - from);
            let (now, later) = rest.split_at_mut(count);
            if count == whole {
                self.unpack(block, now)?;
            } else {
                let mut last = self.last.lock().unwrap_or_else(PoisonError::into_inner);
                if last.0 != block {
                    let (number, content) = &mut *last;
                    *number = usize::MAX;
                    content.resize(whole, 0);
                    self.unpack(block, content)?;
                    *number = block;
                }
                now.copy_from_slice(&last.1[from..from + count]);
            }
            at += count as u64;
            rest = later;
        }
        Ok(())
    }

    /// Bytes of a block before it was packed.
    fn bytes_of(&self, block: usize) -> usize {
        (self.length - (block * BLOCK) as u64).min(BLOCK as u64) as usize
    }

    /// Unpacks a block into a place of its size.
    fn unpack(&self, block: usize, out: &mut [u8]) -> io::Result<()> {
        thread_local! {
            /// Packed bytes, and what unpacks them: both are large to make.
            static UNPACKER: RefCell<Option<(Vec<u8>, Decompressor<'static>)>> = const { RefCell::new(None) };
        }
        let start = block.checked_sub(1).map_or(0, |before| self.ends[before]);
        let damaged = || io::Error::from(ErrorKind::UnexpectedEof);
        let most = zstd::zstd_safe::compress_bound(BLOCK);
        let count = self.ends[block].checked_sub(start).filter(|&count| count <= most as u64).ok_or_else(damaged)?;
        UNPACKER.with_borrow_mut(|kept| {
            let (packed, unpacker) = match kept {
                Some(kept) => kept,
                None => kept.insert((Vec::new(), Decompressor::new()?)),
            };
            packed.resize(count as usize, 0);
            self.file.read_exact_at(start, packed)?;
            let found = unpacker.decompress_to_buffer(packed, out).map_err(|_| damaged())?;
            if found == out.len() { Ok(()) } else { Err(damaged()) }
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Bytes of which some repeat.
    fn bytes(count: usize) -> Vec<u8> {
        (0..count as u64).map(|n| (n.wrapping_mul(0x9e37_79b9_7f4a_7c15) >> 40) as u8 & (n >> 12) as u8).collect()
    }

    #[test]
    fn any_stretch_comes_back() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("packed");
        for count in [0, 1, BLOCK - 1, BLOCK, BLOCK + 1, 5 * BLOCK + 77] {
            let bytes = bytes(count);
            let mut packed = Vec::new();
            write(&mut packed, &bytes).unwrap();
            let (content, sum) = packed.split_last_chunk::<4>().unwrap();
            assert_eq!(crc32c::crc32c(content), u32::from_le_bytes(*sum));
            std::fs::write(&path, &packed).unwrap();
            let file = PackedFile::open(&path, 4).unwrap();
            assert_eq!(file.length(), count as u64);
            for (from, to) in [(0, count), (count / 3, count / 2), (count.saturating_sub(3), count), (count / 2, count)]
            {
                let mut out = vec![0; to - from];
                file.read_exact_at(from as u64, &mut out).unwrap();
                assert_eq!(out, bytes[from..to], "{from} to {to} of {count}");
            }
            assert!(file.read_exact_at(count as u64, &mut [0]).is_err());
            assert!(file.read_exact_at(u64::MAX, &mut [0; 2]).is_err());
        }
    }

    #[test]
    fn repeated_bytes_take_less_and_what_is_cut_off_or_altered_is_told() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("packed");
        let bytes = bytes(3 * BLOCK);
        let mut packed = Vec::new();
        write(&mut packed, &bytes).unwrap();
        assert!(packed.len() < bytes.len());
        for count in 0..packed.len().min(100) {
            std::fs::write(&path, &packed[..count]).unwrap();
            let mut out = vec![0; bytes.len()];
            assert!(PackedFile::open(&path, 4).and_then(|file| file.read_exact_at(0, &mut out)).is_err(), "{count}");
        }
        for place in (0..packed.len() - 4).step_by(41) {
            let mut altered = packed.clone();
            altered[place] ^= 0x55;
            std::fs::write(&path, &altered).unwrap();
            // Told or read otherwise, never a panic: the checksum decides where it matters.
            let mut out = vec![0; bytes.len()];
            let _ = PackedFile::open(&path, 4).and_then(|file| file.read_exact_at(0, &mut out));
        }
    }
}
