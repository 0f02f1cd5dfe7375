//! The present extraction as picks need it: its trees and its key.
//!
//! A caller that makes several picks holds the result of [`Candidates::load`]. A single command takes
//! `Candidates::for_picks`: of a large extraction, the surfaces that were picked or lie near a place are read alone.
//! The others are empty there.

use super::extraction;
use crate::document::Document;
use crate::error::ProjectError;
use crate::facts::{Facts, Query};
use glam::{DVec2, Vec3};
use interp::Forest;
use interp::assembly::{AssemblyError, ClosestLeaf, leaf_at};
use std::collections::BTreeSet;
use std::sync::Arc;
use store::StoredCandidates;
use survey::candidates::ForestCounts;
use survey::{Progress, SurveyGeometry};

/// Candidates that take at most so many bytes are read whole by every command.
const FEW_BYTES: u64 = 512 << 20;

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

/// All candidates of an extraction that is open.
struct AllOf<'a>(&'a StoredCandidates);

impl Query for AllOf<'_> {
    const WHAT: &'static str = "horizon candidates";
    type Answer = Candidates;

    fn key(&self, _: Facts<'_>) -> Result<String, ProjectError> {
        Ok(self.0.info().key.clone())
    }

    fn compute(&self, _: Facts<'_>, progress: &Progress) -> Result<Candidates, ProjectError> {
        let (key, max_distance) = (self.0.info().key.clone(), self.0.info().max_distance);
        Ok(Candidates { forest: extraction::forest(self.0, progress)?, key, max_distance })
    }

    fn bytes(Candidates { forest: Forest { surfaces, nodes, .. }, .. }: &Candidates) -> usize {
        extraction::bytes_of(ForestCounts {
            vertices: surfaces.vertices.len(),
            triangles: surfaces.triangles.len(),
            surfaces: surfaces.surfaces.len(),
            nodes: nodes.len(),
        }) as usize
    }
}

impl Candidates {
    /// All candidates of a project's present extraction.
    ///
    /// # Errors
    /// [`ProjectError::NotExtracted`] if there are none; data are damaged, or the user cancelled.
    pub fn load(facts: Facts<'_>, progress: &Progress) -> Result<Arc<Self>, ProjectError> {
        let path = extraction::candidates_path(facts.root, facts.document)?;
        facts.get(&AllOf(&StoredCandidates::open(&path)?), progress)
    }

    /// The candidates that commands on picks need: all of them if they are in memory or few, otherwise the surfaces that
    /// any horizon was picked from, and those near `places`.
    ///
    /// # Errors
    /// As [`Candidates::load`].
    pub(crate) fn for_picks(
        facts: Facts<'_>,
        places: &[[f64; 3]],
        progress: &Progress,
    ) -> Result<Arc<Self>, ProjectError> {
        let stored = StoredCandidates::open(&extraction::candidates_path(facts.root, facts.document)?)?;
        match facts.held(&AllOf(&stored))? {
            Some(held) => Ok(held),
            None if extraction::forest_bytes(&stored)? <= FEW_BYTES => facts.get(&AllOf(&stored), progress),
            None => Ok(Arc::new(Self::part(&stored, facts.document, places, progress)?)),
        }
    }

    /// The surfaces that any horizon was picked from, and those near `places`.
    fn part(
        stored: &StoredCandidates,
        document: &Document,
        places: &[[f64; 3]],
        progress: &Progress,
    ) -> Result<Self, ProjectError> {
        let (key, max_distance) = (stored.info().key.clone(), stored.info().max_distance);
        let geometry = document.frame()?;
        let logs = document.horizons.iter().filter_map(|entry| entry.assembly.as_ref());
        let picks = logs.flat_map(|log| &log.picks).filter(|pick| pick.extraction == key);
        let mut leaves: BTreeSet<u32> = picks.map(|pick| pick.leaf).collect();
        for at in places {
            leaves.extend(near_leaves(stored, voxel_of(geometry, *at))?);
        }
        let trees = Forest::of_nodes(stored.read_nodes(progress)?)?;
        // A log may name a leaf that the extraction does not have.
        let nodes = leaves.iter().filter_map(|&leaf| trees.leaves.get((leaf as usize).checked_sub(1)?));
        let surfaces: BTreeSet<u32> = nodes.map(|&node| trees.nodes[node as usize].surface).collect();
        drop(trees);
        let tables = stored.read_forest_of(&surfaces, progress)?;
        Ok(Self { forest: Forest::from_tables(tables, stored.info().size)?, key, max_distance })
    }

    /// The leaf at a place given by line numbers and the vertical unit, within the largest distance of the extraction.
    ///
    /// # Errors
    /// The place lies outside the survey, or there is no candidate near it.
    pub fn leaf_near(&self, geometry: &SurveyGeometry, at: [f64; 3]) -> Result<ClosestLeaf, ProjectError> {
        leaf_at(&self.forest, voxel_of(geometry, at), self.max_distance).map_err(|error| match error {
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

/// The voxel position of a place given by line numbers and the vertical unit.
fn voxel_of(geometry: &SurveyGeometry, at: [f64; 3]) -> Vec3 {
    geometry.voxel_from_lines(at[0], at[1]).extend(geometry.vertical.index_of(at[2])).as_vec3()
}

/// The leaves that are the nearest of a sample around a place, within the largest distance of the extraction; where none
/// is, those of coarser and coarser levels.
fn near_leaves(stored: &StoredCandidates, voxel: Vec3) -> Result<BTreeSet<u32>, ProjectError> {
    let around = stored.info().max_distance.ceil() as usize + 2;
    for level in 0..stored.level_count() {
        let size = stored.size(level);
        let at = [0, 1, 2].map(|axis| (voxel[axis].max(0.0) as usize >> level).min(size[axis] - 1));
        let start = at.map(|at| at.saturating_sub(around));
        let part = [0, 1, 2].map(|axis| (at[axis] + around + 1).min(size[axis]) - start[axis]);
        let mut leaves: BTreeSet<u32> = stored.read_box(level, start, part)?.leaf.into_iter().collect();
        leaves.remove(&0);
        if !leaves.is_empty() {
            return Ok(leaves);
        }
    }
    Ok(BTreeSet::new())
}

#[cfg(test)]
mod tests;
