//! How large a file will be, told from one whose faces are coarser.

/// By which power of the density pictures of faces grow. It would be 2 if every texel took as much; patterns pack the
/// better the finer they are.
const GROWTH: f64 = 1.6;

/// About how many bytes a file has.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct SizeEstimate {
    /// Bytes that do not depend on the density of faces.
    fixed: u64,
    /// Bytes of the pictures of faces.
    pictures: u64,
}

impl SizeEstimate {
    /// Of a file with so many bytes, of which so many are pictures of faces.
    pub(crate) fn new(bytes: usize, pictures: usize) -> Self {
        Self { fixed: bytes.saturating_sub(pictures) as u64, pictures: pictures as u64 }
    }

    /// About how many bytes the file has with faces of `factor` times the density.
    pub fn at(&self, factor: f64) -> u64 {
        self.fixed + (self.pictures as f64 * factor.max(0.0).powf(GROWTH)) as u64
    }
}
