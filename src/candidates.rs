//! The present extraction as picks see it: the trees, and what identifies them.

use crate::error::ProjectError;
use crate::extraction;
use interp::Forest;
use std::path::Path;
use survey::Progress;
use survey::store::StoredCandidates;

/// Candidates to pick from.
#[derive(Debug)]
pub struct Candidates {
    /// Surfaces and trees.
    pub forest: Forest,
    /// Identifies volume and settings.
    pub key: String,
    /// Distance within which a place belongs to a leaf, voxels.
    pub max_distance: f32,
}

impl Candidates {
    /// Reads those of the project in `root`.
    ///
    /// # Errors
    /// [`ProjectError::NotExtracted`] when there are none; damaged data, or cancelled.
    pub fn load(root: &Path, progress: &Progress) -> Result<Self, ProjectError> {
        let path = extraction::candidates_path(root);
        if !path.exists() {
            return Err(ProjectError::NotExtracted);
        }
        let stored = StoredCandidates::open(&path)?;
        let forest = extraction::forest(&stored, progress)?;
        let info = stored.info();
        Ok(Self { forest, key: info.key.clone(), max_distance: info.max_distance })
    }
}
