//! Makes links to volumes in object storage, and volumes there.

use super::error::StoreError;
#[cfg(feature = "remote")]
use super::object_storage;
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
    object_storage::copy_small(replacement.path(), url, progress)?;
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

impl StoredVolume {
    /// Writes the volume under an address in object storage, where it is whole or not there; returns its bytes.
    ///
    /// # Errors
    /// It is damaged, or lies in object storage itself; [`StoreError::RemoteWrite`] when there is something under the
    /// address, or the storage does not take it. What was written is then removed again, as far as the storage answers.
    #[cfg(feature = "remote")]
    pub fn upload(&self, url: &str, progress: &Progress) -> Result<u64, StoreError> {
        if let Some(from) = self.linked_url() {
            let reason = format!("the volume lies in object storage itself; copy the objects from {from}");
            return Err(StoreError::RemoteWrite { url: url.to_owned(), reason });
        }
        self.verify(progress)?;
        object_storage::upload(self.path(), url.trim_end_matches('/'), progress)
    }

    /// Says that the program was built without object storage.
    ///
    /// # Errors
    /// [`StoreError::WithoutRemote`].
    #[cfg(not(feature = "remote"))]
    pub fn upload(&self, url: &str, _: &Progress) -> Result<u64, StoreError> {
        Err(StoreError::WithoutRemote { url: url.to_owned() })
    }
}
