//! The present extraction as picks need it: its trees and its key.
//!
//! A caller that makes several picks holds the result of [`Candidates::load`]. While it lives, callers that ask for the
//! same extraction get it without reading anything but its report.

use super::extraction;
use crate::document::{Document, VolumeEntry};
use crate::error::ProjectError;
use crate::weak_cache::WeakCache;
use glam::DVec2;
use interp::Forest;
use interp::assembly::{AssemblyError, ClosestLeaf, leaf_at};
use std::path::{Path, PathBuf};
use std::sync::Arc;
use store::StoredCandidates;
use survey::{Progress, SurveyGeometry};

/// Key of the weak cache: path and key of the extraction.
static HELD: WeakCache<(PathBuf, String), Candidates> = WeakCache::nothing();

/// Candidates to pick from.
#[derive(Debug)]
pub struct Candidates {
    /// Surfaces and trees.
    pub forest: Forest,
    /// Key: identifies volume, settings and method.
    pub key: String,
    /// Largest distance of a place from the leaf that it belongs to, voxels.
    pub max_distance: f32,
}

impl Candidates {
    /// The candidates of the project in `root`: those that someone holds, if they are of the present extraction,
    /// otherwise read from disk.
    ///
    /// # Errors
    /// [`ProjectError::NotExtracted`] if there are none; data are damaged, or the user cancelled.
    pub fn load(root: &Path, document: &Document, progress: &Progress) -> Result<Arc<Self>, ProjectError> {
        let path = extraction::candidates_path(root, document)?;
        let stored = StoredCandidates::open(&path)?;
        let (key, max_distance) = (stored.info().key.clone(), stored.info().max_distance);
        HELD.get_or_make((path, key.clone()), || {
            Ok(Self { forest: extraction::forest(&stored, progress)?, key, max_distance })
        })
    }

    /// The leaf at a place given by line numbers and the vertical unit, within the largest distance of the extraction.
    ///
    /// # Errors
    /// The place lies outside the survey, or there is no candidate near it.
    pub fn leaf_near(&self, geometry: &SurveyGeometry, at: [f64; 3]) -> Result<ClosestLeaf, ProjectError> {
        let place = geometry.voxel_from_lines(at[0], at[1]);
        let voxel = place.extend(geometry.vertical.index_of(at[2])).as_vec3();
        leaf_at(&self.forest, voxel, self.max_distance).map_err(|error| match error {
            AssemblyError::Outside { .. } => ProjectError::outside(at, geometry),
            AssemblyError::NothingNear { distance, nearest, max_distance, .. } => {
                let lines = geometry.lines_from_voxel(DVec2::new(f64::from(nearest.x), f64::from(nearest.y)));
                let z = geometry.vertical.value_at(f64::from(nearest.z));
                ProjectError::NoCandidate { at, nearest: [lines.x, lines.y, z], distance, max_distance }
            }
            other => ProjectError::Assembly(other),
        })
    }

    /// Number of levels from a leaf to the root of its tree.
    pub fn levels(&self, leaf: u32) -> u32 {
        let mut node = self.forest.leaves[leaf as usize - 1];
        let mut levels = 0;
        while let Some(parent) = self.forest.nodes[node as usize].parent {
            (node, levels) = (parent, levels + 1);
        }
        levels
    }
}

/// The volume that the present extraction is of; the first on the project's lattice where that is not recorded.
pub(crate) fn amplitudes(document: &Document) -> Result<&VolumeEntry, ProjectError> {
    let extracted = document.extraction.as_ref().map(|entry| entry.volume.as_str());
    let named = document.volumes.iter().find(|entry| extracted == Some(entry.name.as_str()));
    named.or_else(|| document.volumes.iter().find(|entry| entry.geometry.is_none())).ok_or(ProjectError::NoVolume)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Project;
    use crate::command::{Command, Extract, ImportVolume};
    use crate::document::Polarity;
    use interp::ExtractSettings;
    use segy::{SegyOptions, WriteOptions};
    use survey::{VerticalUnit, Volume};

    /// A project with a small volume.
    fn imported(folder: &Path) -> PathBuf {
        let geometry = SurveyGeometry::regular([24, 20, 32], 25.0, 4.0, VerticalUnit::Milliseconds);
        let samples = (0..24 * 20 * 32).map(|n| ((n % 32) as f32 * 0.7).sin()).collect();
        let volume = Volume::from_samples([24, 20, 32], samples).unwrap();
        let path = folder.join("north.sgy");
        segy::write(&path, &geometry, &volume, &WriteOptions::default(), &Progress::silent()).unwrap();
        let mut new = Project::create(&folder.join("north.petro"), None).unwrap();
        let import = ImportVolume {
            path,
            name: None,
            polarity: Polarity::default(),
            options: SegyOptions::default(),
            memory_bytes: None,
            moved: false,
        };
        new.project().apply(&Command::Import(import), &Progress::silent()).unwrap();
        new.publish().unwrap().root().to_owned()
    }

    fn extract(project: &mut Project, settings: &ExtractSettings) {
        let extract = Extract { volume: None, settings: settings.clone(), memory_bytes: None, just_stored: false };
        project.apply(&Command::Extract(extract), &Progress::silent()).unwrap();
    }

    #[test]
    fn what_is_held_is_not_read_again_until_another_extraction_is_there() {
        let folder = tempfile::tempdir().unwrap();
        let quiet = Progress::silent();
        let root = imported(folder.path());
        let mut project = Project::open(&root).unwrap();
        let mut settings = ExtractSettings::default();
        extract(&mut project, &settings);
        let first = Candidates::load(&root, project.document(), &quiet).unwrap();
        assert!(Arc::ptr_eq(&first, &Candidates::load(&root, project.document(), &quiet).unwrap()));
        settings.forest.min_leaf_triangles = 80;
        extract(&mut project, &settings);
        let second = Candidates::load(&root, project.document(), &quiet).unwrap();
        assert_ne!(first.key, second.key);
        assert!(second.forest.leaf_count() > first.forest.leaf_count());
        // Of another project nothing is taken, whatever its key.
        let elsewhere = tempfile::tempdir().unwrap();
        let other = imported(elsewhere.path());
        let mut elsewhere = Project::open(&other).unwrap();
        extract(&mut elsewhere, &settings);
        assert!(!Arc::ptr_eq(&second, &Candidates::load(&other, elsewhere.document(), &quiet).unwrap()));
    }
}
