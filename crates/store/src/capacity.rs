//! What the files of an array can hold: a shape is believed only where the files for it are there.
//!
//! The shape of an array stands in a small text that anyone can write. Every file of an array is written, so
//! there must be about as many as the shape needs; and what a file holds is limited by its length, since zstd makes
//! of a byte at most [`MOST_FROM_A_BYTE`].

use super::array::StoredArray;
use super::error::StoreError;
use std::fs;
use std::io::{self, ErrorKind};
use std::path::Path;
use system::file::FileAction;

/// Bytes that zstd makes of one byte at most: a block of 128 KiB takes four.
const MOST_FROM_A_BYTE: u64 = 32 << 10;

/// So many missing files are no sign of a wrong shape.
const FEW: u64 = 8;

/// Bytes of a file that stand for nothing: headers and checksums.
const ALWAYS: u64 = 1 << 16;

/// Checks that about as many files lie in the folder `c` of the array `name` as `counts` along its axes say.
pub(super) fn check_count(group: &Path, name: &str, shape: &[usize], counts: &[usize]) -> Result<(), StoreError> {
    let damaged = |reason| StoreError::damaged(group, name, reason);
    let needed = counts.iter().try_fold(1u64, |product, &count| product.checked_mul(count as u64));
    let elements = shape.iter().try_fold(1usize, |product, &count| product.checked_mul(count));
    let (Some(needed), Some(_)) = (needed, elements) else {
        return Err(damaged(format!("its shape {shape:?} is beyond counting")));
    };
    // A few may be missing, which is said when they are needed; most of them may not.
    let most_missing = needed / 2 + FEW;
    let files = group.join(name).join("c");
    let found = match count_files(&files, counts.len(), needed.saturating_sub(most_missing)) {
        Err(source) if system::file::says_nothing(&source) => {
            return Err(StoreError::io(FileAction::Read, &files, source));
        }
        // There is no such folder.
        found => found.unwrap_or(0),
    };
    if found < needed.saturating_sub(most_missing) {
        return Err(damaged(format!("its shape {shape:?} needs {needed} files, and {found} are there")));
    }
    Ok(())
}

/// Checks that metadata, where they are there, are an ordinary file of a size that people would read.
pub(super) fn check_metadata(path: &Path) -> Result<(), StoreError> {
    let facts = match system::file::ordinary(path) {
        Ok(facts) => facts,
        // That they are missing is said by those who need them.
        Err(error) if error.kind() == ErrorKind::NotFound => return Ok(()),
        Err(source) => return Err(StoreError::io(FileAction::Read, path, source)),
    };
    if facts.len() <= system::file::MAX_DOCUMENT_BYTES {
        return Ok(());
    }
    Err(StoreError::io(FileAction::Read, path, ErrorKind::FileTooLarge.into()))
}

/// Counts the files `depth` folders down, up to `most`.
fn count_files(folder: &Path, depth: usize, most: u64) -> io::Result<u64> {
    let mut found = 0;
    for entry in fs::read_dir(folder)? {
        if found >= most {
            break;
        }
        let path = entry?.path();
        if depth <= 1 {
            found += 1;
            continue;
        }
        found += match count_files(&path, depth - 1, most - found) {
            Err(error) if !system::file::says_nothing(&error) => 0,
            counted => counted?,
        };
    }
    Ok(found)
}

/// Checks that a file of so many bytes can hold a chunk of `shape` with elements of `bytes_each`.
pub(super) fn check_content(length: u64, shape: &[usize], bytes_each: usize) -> Result<(), String> {
    let needed = shape.iter().chain([&bytes_each]).try_fold(1u64, |product, &count| product.checked_mul(count as u64));
    match needed {
        Some(needed) if needed <= ALWAYS.saturating_add(length.saturating_mul(MOST_FROM_A_BYTE)) => Ok(()),
        _ => Err(format!("its {length} bytes cannot hold {shape:?} elements")),
    }
}

impl StoredArray {
    /// Checks that so many elements of `bytes_each` fit into memory.
    pub(super) fn check_memory(&self, size: &[usize], bytes_each: usize) -> Result<(), StoreError> {
        system::memory::check("reading it", size, bytes_each)
            .map(|_| ())
            .map_err(|source| StoreError::Memory { path: self.path(), source })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn files_are_counted_down_to_the_depth_of_the_axes() {
        let folder = tempfile::tempdir().unwrap();
        for file in ["a/c/0/0", "a/c/0/1", "a/c/1/0", "a/c/1/1"] {
            let path = folder.path().join(file);
            fs::create_dir_all(path.parent().unwrap()).unwrap();
            fs::write(path, "").unwrap();
        }
        check_count(folder.path(), "a", &[20, 20], &[2, 2]).unwrap();
        check_count(folder.path(), "a", &[0, 20], &[0, 2]).unwrap();
        for (shape, counts) in [([300, 20], [30, 2]), ([usize::MAX, 20], [2, 2]), ([20, 20], [usize::MAX, 3])] {
            assert!(check_count(folder.path(), "a", &shape, &counts).is_err(), "{shape:?}");
        }
    }

    #[test]
    fn a_few_bytes_cannot_hold_a_terabyte() {
        check_content(40, &[64, 64, 64], 4).unwrap();
        assert!(check_content(40, &[10_000, 10_000, 10_000], 1).is_err());
        assert!(check_content(u64::MAX, &[usize::MAX, 2], 8).is_err());
    }
}
