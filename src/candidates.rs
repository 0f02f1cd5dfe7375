//! The present extraction as picks see it: the trees, and what identifies them.
//!
//! Whoever makes several picks holds what [`Candidates::load`] gave: while that lives, those who ask for the same extraction get it without
//! reading anything but its facts.

use crate::error::ProjectError;
use crate::extraction;
use crate::held::Held;
use interp::Forest;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use store::StoredCandidates;
use survey::Progress;

/// By place and key.
static HELD: Held<(PathBuf, String), Candidates> = Held::nothing();

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
    /// Those of the project in `root`: the ones that someone holds, where they are the present extraction, or else read.
    ///
    /// # Errors
    /// [`ProjectError::NotExtracted`] when there are none; damaged data, or cancelled.
    pub fn load(root: &Path, progress: &Progress) -> Result<Arc<Self>, ProjectError> {
        let path = extraction::candidates_path(root);
        if !path.exists() {
            return Err(ProjectError::NotExtracted);
        }
        let stored = StoredCandidates::open(&path)?;
        let (key, max_distance) = (stored.info().key.clone(), stored.info().max_distance);
        HELD.get_or_make((path, key.clone()), || {
            Ok(Self { forest: extraction::forest(&stored, progress)?, key, max_distance })
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Project;
    use interp::ExtractSettings;

    #[test]
    fn what_is_held_is_not_read_again_until_another_extraction_is_there() {
        let folder = tempfile::tempdir().unwrap();
        let quiet = Progress::silent();
        let root = crate::app::tests::project(folder.path());
        let project = Project::open(&root).unwrap();
        let mut settings = ExtractSettings::default();
        extraction::extract(&project, None, &settings, &quiet).unwrap();
        let first = Candidates::load(&root, &quiet).unwrap();
        assert!(Arc::ptr_eq(&first, &Candidates::load(&root, &quiet).unwrap()));
        settings.forest.min_leaf_triangles = 80;
        extraction::extract(&project, None, &settings, &quiet).unwrap();
        let second = Candidates::load(&root, &quiet).unwrap();
        assert_ne!(first.key, second.key);
        assert!(second.forest.leaf_count() > first.forest.leaf_count());
        // Of another project nothing is taken, whatever its key.
        let elsewhere = tempfile::tempdir().unwrap();
        let other = crate::app::tests::project(elsewhere.path());
        extraction::extract(&Project::open(&other).unwrap(), None, &settings, &quiet).unwrap();
        assert!(!Arc::ptr_eq(&second, &Candidates::load(&other, &quiet).unwrap()));
    }
}
