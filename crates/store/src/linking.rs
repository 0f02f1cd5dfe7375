//! Makes links to volumes in object storage.

use super::error::StoreError;
#[cfg(feature = "remote")]
use super::linked;
#[cfg(feature = "remote")]
use super::replacement::Replacement;
use super::volume::StoredVolume;
use std::path::Path;
use survey::progress::Progress;

/// Makes the volume at `path` a link to the one at `url` in object storage: copies what is small. Its bricks are read
/// when they are needed.
///
/// # Errors
/// [`StoreError::Remote`] when the storage does not answer or has no volume there; `path` is then what it was before.
#[cfg(feature = "remote")]
pub fn link_volume(path: &Path, url: &str, progress: &Progress) -> Result<StoredVolume, StoreError> {
    let replacement = Replacement::of(path)?;
    linked::copy_small(replacement.path(), url, progress)?;
    // Whether it is a volume, of bricks that can be read.
    drop(StoredVolume::open(replacement.path())?);
    replacement.commit()?;
    StoredVolume::open(path)
}

/// Says that the program was built without object storage.
///
/// # Errors
/// [`StoreError::WithoutRemote`].
#[cfg(not(feature = "remote"))]
pub fn link_volume(_: &Path, url: &str, _: &Progress) -> Result<StoredVolume, StoreError> {
    Err(StoreError::WithoutRemote { url: url.to_owned() })
}
