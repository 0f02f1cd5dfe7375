//! Named arrays in parts: where a computation in bricks puts what one stage hands to the next.
//!
//! A part is the share of one brick, or of a whole survey where there is a single one. Tasks read parts that were
//! written before and write parts of their own, so that a task can run in any process that sees the same arrays, and a
//! part that is there whole need not be computed again.

use crate::source::SourceError;

/// Named arrays in parts. A part is written as a whole or not at all, however the writer ends.
pub trait NamedArrays: Sync {
    /// Writes a part; what was there is replaced.
    ///
    /// # Errors
    /// It cannot be written, as on a full disk.
    fn write(&self, array: &str, part: usize, bytes: &[u8]) -> Result<(), SourceError>;

    /// Whether a part was written to its end and is undamaged.
    fn is_whole(&self, array: &str, part: usize) -> bool;

    /// Length of a part, bytes.
    ///
    /// # Errors
    /// It was not written.
    fn length(&self, array: &str, part: usize) -> Result<u64, SourceError>;

    /// Fills `out` with the bytes of a part from `offset` on.
    ///
    /// # Errors
    /// It was not written, or ends before that.
    fn read(&self, array: &str, part: usize, offset: u64, out: &mut [u8]) -> Result<(), SourceError>;

    /// Removes an array with all its parts, if it is there.
    fn remove(&self, array: &str);
}

impl<A: NamedArrays + ?Sized> NamedArrays for &A {
    fn write(&self, array: &str, part: usize, bytes: &[u8]) -> Result<(), SourceError> {
        (**self).write(array, part, bytes)
    }

    fn is_whole(&self, array: &str, part: usize) -> bool {
        (**self).is_whole(array, part)
    }

    fn length(&self, array: &str, part: usize) -> Result<u64, SourceError> {
        (**self).length(array, part)
    }

    fn read(&self, array: &str, part: usize, offset: u64, out: &mut [u8]) -> Result<(), SourceError> {
        (**self).read(array, part, offset, out)
    }

    fn remove(&self, array: &str) {
        (**self).remove(array);
    }
}
