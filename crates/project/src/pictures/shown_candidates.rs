//! Horizon candidates in the form that pictures show: the project's extraction with the horizons picked from it, and
//! the sheets of horizons without picks.
//!
//! | a scene shows | drawn from |
//! |---|---|
//! | a horizon whose picks are of the extraction at hand | the leaves under the nodes picked |
//! | any other horizon by its name | distances to its sheets, added to the extraction's under ids above the last leaf |
//! | leaves, distances | the extraction; without one the sheets of all horizons |
//!
//! In memory: five bytes a voxel, and the trees without their triangles.

use crate::Project;
use crate::document::Document;
use crate::document::PickEntry;
use crate::error::{Noun, ProjectError};
use crate::interpretation::assembly::picked_selection;
use crate::interpretation::extraction;
use crate::pictures::horizon_distance::{self, FARTHEST};
use glam::Vec3;
use interp::Forest;
use interp::assembly::selected_leaves;
use model::StructuralModel;
use render::media::Colouring;
use render::{CandidateVolume, FaceData, Scene};
use std::collections::BTreeMap;
use store::StoredCandidates;
use survey::CandidateBox;
use survey::Progress;
use system::memory;

/// The code of the largest distance.
const STEPS: f32 = 254.0;

/// Memory that distances and leaves take for each sample while they are read.
const CANDIDATE_BYTES: usize = 8;

/// What a scene shows of candidates and horizons.
pub struct ShownCandidates {
    voxels: CandidateBox,
    voxels_per_step: f32,
    /// Key of the extraction; `None` where sheets are shown instead.
    key: Option<String>,
    trees: Forest,
    level: u32,
    groups: Option<Vec<u32>>,
    /// Ids by the name of the horizon.
    picked: BTreeMap<String, Vec<u32>>,
    sheets: BTreeMap<String, u32>,
}

/// A leaf and the tree that it belongs to.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct LeafFacts {
    /// Its number.
    pub leaf: u32,
    /// Its triangles.
    pub triangles: usize,
    /// Levels from it up to its whole surface.
    pub levels: u32,
}

/// Whether a scene shows any of this.
pub fn is_shown(scene: &Scene) -> bool {
    !scene.media.horizons.is_empty() || scene.face_data.shows_candidates()
}

impl ShownCandidates {
    /// The leaf that is nearest to a place, voxel; `None` where none is near, or where sheets stand in for leaves.
    pub fn leaf_at(&self, voxel: Vec3) -> Option<LeafFacts> {
        self.key.as_ref().filter(|_| !self.voxels.leaf.is_empty())?;
        let leaf = self.candidates().leaf_at(voxel);
        let node = *self.trees.leaves.get(leaf.checked_sub(1)? as usize)?;
        let parent = |node: &u32| self.trees.nodes.get(*node as usize).and_then(|node| node.parent);
        let levels = std::iter::successors(Some(node), parent).count() as u32 - 1;
        let triangles = self.trees.nodes.get(node as usize)?.triangles.len();
        Some(LeafFacts { leaf, triangles, levels })
    }

    /// Reads what `scene` shows; `None` if that is nothing.
    ///
    /// # Errors
    /// [`ProjectError::NotExtracted`] if there is neither an extraction nor a horizon to show instead; a horizon is
    /// unknown, data are damaged, or the user cancelled.
    pub fn load(
        project: &Project,
        scene: &Scene,
        model: Option<&StructuralModel>,
        progress: &Progress,
    ) -> Result<Option<Self>, ProjectError> {
        if !is_shown(scene) {
            return Ok(None);
        }
        let document = project.document();
        let size = document.frame()?.size();
        let horizons = &scene.media.horizons;
        let mut named = Vec::new();
        for name in horizons.iter().filter_map(|horizon| horizon.name.as_deref()) {
            named.push(document.position(Noun::Horizon, name)?);
        }
        let asks_leaves = scene.face_data.shows_candidates() || horizons.iter().any(|horizon| horizon.name.is_none());
        let by_level = scene.tree_level > 0
            && (scene.face_data == FaceData::Leaves || horizons.iter().any(|h| h.colouring == Colouring::ByLeaf));
        let stored = stored(project, size, progress)?;
        if stored.is_none() && (by_level || asks_leaves && model.is_none()) {
            return Err(ProjectError::NotExtracted);
        }
        let mut shown = Self {
            voxels: CandidateBox { size, distance: Vec::new(), leaf: Vec::new() },
            voxels_per_step: FARTHEST / STEPS,
            key: None,
            trees: Forest::default(),
            level: 0,
            groups: None,
            picked: BTreeMap::new(),
            sheets: BTreeMap::new(),
        };
        if let Some(stored) = &stored {
            shown.trees = Forest::of_nodes(stored.read_nodes(progress)?)?;
            shown.key = Some(stored.info().key.clone());
            shown.take_picks(document);
        }
        let is_picked = |index: &usize| shown.picked.contains_key(&document.horizons[*index].name);
        let mut unpicked: Vec<usize> = named.iter().copied().filter(|index| !is_picked(index)).collect();
        let wanted = stored.filter(|_| asks_leaves || unpicked.len() < named.len());
        shown.voxels = match &wanted {
            Some(stored) => {
                memory::check("horizon candidates at every sample", &size, CANDIDATE_BYTES)?;
                shown.voxels_per_step = stored.info().max_distance / STEPS;
                stored.read(0, progress)?
            }
            None => {
                if asks_leaves {
                    progress.warn(
                        "no horizon candidates have been extracted; the horizons of the interpretation are shown in their place",
                    );
                    unpicked = (0..document.horizons.len()).collect();
                }
                horizon_distance::nothing_near(size)
            }
        };
        if let (Some(model), false) = (model, unpicked.is_empty()) {
            let first_id = shown.trees.leaf_count() as u32 + 1;
            let farthest = shown.voxels_per_step * STEPS;
            horizon_distance::add_horizons(model, &unpicked, first_id, farthest, &mut shown.voxels, progress)?;
            let id = |index: usize| (document.horizons[index].name.clone(), first_id + index as u32);
            shown.sheets = unpicked.into_iter().map(id).collect();
        }
        shown.show_level(scene.tree_level);
        Ok(Some(shown))
    }

    /// Key of the extraction that the leaves belong to; `None` where sheets are shown instead.
    pub fn key(&self) -> Option<&str> {
        self.key.as_deref()
    }

    /// Takes over the picks of a project's state; the voxels stay as they are. Picks made on another extraction are
    /// left out.
    pub fn take_picks(&mut self, document: &Document) {
        self.picked.clear();
        let Some(key) = &self.key else { return };
        for entry in &document.horizons {
            let Some(log) = &entry.assembly else { continue };
            let of_this = |pick: &PickEntry| {
                pick.extraction == *key && (1..=self.trees.leaf_count()).contains(&(pick.leaf as usize))
            };
            if !log.picks.iter().all(of_this) {
                continue;
            }
            let Ok(selection) = picked_selection(log, &self.trees) else { continue };
            let leaves = selected_leaves(&self.trees, &selection);
            if !leaves.is_empty() {
                self.picked.insert(entry.name.clone(), leaves);
            }
        }
    }

    /// Distinguishes leaves by the nodes at a level of their trees; 0 = by themselves.
    pub fn show_level(&mut self, level: u32) {
        self.level = level;
        self.groups = (level > 0 && self.trees.leaf_count() > 0).then(|| {
            let mut groups = self.trees.nodes_at_level(level);
            // Sheets have no tree; their ids follow those of the nodes.
            let last = self.sheets.values().copied().max().unwrap_or(0) as usize;
            let nodes = self.trees.nodes.len() as u32;
            groups.extend((groups.len()..=last).map(|id| nodes + id as u32));
            groups
        });
    }

    /// The level that is shown.
    pub fn level(&self) -> u32 {
        self.level
    }

    /// The trees without vertices and triangles; empty where sheets are shown instead of an extraction.
    pub fn trees(&self) -> &Forest {
        &self.trees
    }

    /// Ids of the leaves of a horizon, or of its sheets; empty for a horizon that was not asked for.
    pub fn leaves_of(&self, horizon: &str) -> Vec<u32> {
        let picked = self.picked.get(horizon).cloned();
        picked.unwrap_or_else(|| self.sheets.get(horizon).copied().into_iter().collect())
    }

    /// The candidates in the form that renderers take.
    pub fn candidates(&self) -> CandidateVolume<'_> {
        CandidateVolume {
            size: self.voxels.size,
            distance: &self.voxels.distance,
            leaf: &self.voxels.leaf,
            voxels_per_step: self.voxels_per_step,
            groups: self.groups.as_deref(),
        }
    }

    /// Resolves the names of a scene's horizons to leaves, and removes horizons of which there is nothing to show.
    pub fn complete(&self, scene: &mut Scene) {
        for horizon in &mut scene.media.horizons {
            if let Some(name) = &horizon.name {
                horizon.leaves = self.leaves_of(name);
            }
        }
        scene.media.horizons.retain(|horizon| horizon.name.is_none() || !horizon.leaves.is_empty());
    }
}

/// The project's extraction, if there is one on its lattice.
fn stored(project: &Project, size: [usize; 3], progress: &Progress) -> Result<Option<StoredCandidates>, ProjectError> {
    let stored = match extraction::open(project.root(), project.document()) {
        Ok(stored) => stored,
        Err(ProjectError::NotExtracted) => return Ok(None),
        Err(error) => return Err(error),
    };
    if stored.info().size != size {
        progress.warn("the horizon candidates are of another lattice and are not shown; extract them again");
        return Ok(None);
    }
    Ok(Some(stored))
}
