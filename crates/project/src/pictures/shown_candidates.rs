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

use crate::derived;
use crate::error::{Noun, ProjectError};
use crate::facts::{Facts, Query};
use crate::interpretation::assembly::picked_leaves;
use crate::interpretation::extraction;
use crate::pictures::horizon_distance::{self, FARTHEST};
use crate::pictures::load::Rock;
use glam::Vec3;
use interp::Forest;
use render::media::Colouring;
use render::{CandidateVolume, FaceData, Scene};
use std::collections::BTreeMap;
use std::sync::Arc;
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
    voxels: Arc<CandidateBox>,
    /// A hash of what the voxels are made of.
    data_key: String,
    voxels_per_step: f32,
    /// Key of the extraction; `None` where sheets are shown instead.
    key: Option<String>,
    trees: Arc<Forest>,
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
pub(super) fn is_shown(scene: &Scene) -> bool {
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
    pub(crate) fn load(
        facts: Facts<'_>,
        scene: &Scene,
        rock: Option<&Rock>,
        progress: &Progress,
    ) -> Result<Option<Self>, ProjectError> {
        if !is_shown(scene) {
            return Ok(None);
        }
        let document = facts.document;
        let size = document.frame()?.size();
        let horizons = &scene.media.horizons;
        let mut named = Vec::new();
        for name in horizons.iter().filter_map(|horizon| horizon.name.as_deref()) {
            named.push(document.position(Noun::Horizon, name)?);
        }
        let asks_leaves = scene.face_data.shows_candidates() || horizons.iter().any(|horizon| horizon.name.is_none());
        let by_level = scene.tree_level > 0
            && (scene.face_data == FaceData::Leaves || horizons.iter().any(|h| h.colouring == Colouring::ByLeaf));
        let stored = match extraction::open(facts.root, document) {
            Err(ProjectError::NotExtracted) => None,
            found => Some(found?),
        };
        if stored.is_none() && (by_level || asks_leaves && rock.is_none()) {
            return Err(ProjectError::NotExtracted);
        }
        let trees = match &stored {
            Some(stored) => facts.get(&Trees(stored), progress)?,
            None => Arc::default(),
        };
        let key = stored.as_ref().map(|stored| stored.info().key.clone());
        let picked = key.as_ref().map(|key| picked_leaves(document, key, &trees)).unwrap_or_default();
        let is_picked = |index: &usize| picked.contains_key(&document.horizons[*index].name);
        let mut unpicked: Vec<usize> = named.iter().copied().filter(|index| !is_picked(index)).collect();
        let wanted = stored.as_ref().filter(|_| asks_leaves || unpicked.len() < named.len());
        if wanted.is_none() && asks_leaves {
            progress.warn(
                "no horizon candidates have been extracted; the horizons of the interpretation are shown in their place",
            );
            unpicked = (0..document.horizons.len()).collect();
        }
        let voxels_per_step = wanted.map_or(FARTHEST, |stored| stored.info().max_distance) / STEPS;
        let first_id = trees.leaf_count() as u32 + 1;
        let sheets = rock.filter(|_| !unpicked.is_empty()).map(|rock| Sheets { rock, which: &unpicked, first_id });
        let id = |index: &usize| (document.horizons[*index].name.clone(), first_id + *index as u32);
        let ids = sheets.iter().flat_map(|sheets| sheets.which.iter().map(id)).collect();
        let asked = ShownVoxels { extraction: wanted, sheets, size, farthest: voxels_per_step * STEPS };
        let mut shown = Self {
            voxels: facts.get(&asked, progress)?,
            data_key: asked.key(facts)?,
            voxels_per_step,
            level: 0,
            groups: None,
            key,
            trees,
            picked,
            sheets: ids,
        };
        shown.show_level(scene.tree_level);
        Ok(Some(shown))
    }

    /// Key of the extraction that the leaves belong to; `None` where sheets are shown instead.
    pub fn key(&self) -> Option<&str> {
        self.key.as_deref()
    }

    /// Distinguishes leaves by the nodes at a level of their trees; 0 = by themselves.
    fn show_level(&mut self, level: u32) {
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

    /// A hash of what the voxels are made of.
    pub(crate) fn data_key(&self) -> &str {
        &self.data_key
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
    pub(crate) fn leaves_of(&self, horizon: &str) -> Vec<u32> {
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

/// The trees of an extraction without vertices and triangles.
struct Trees<'a>(&'a StoredCandidates);

impl Query for Trees<'_> {
    const WHAT: &'static str = "trees of candidates";
    type Answer = Forest;

    fn key(&self, _: Facts<'_>) -> Result<String, ProjectError> {
        Ok(self.0.info().key.clone())
    }

    fn compute(&self, _: Facts<'_>, progress: &Progress) -> Result<Forest, ProjectError> {
        Ok(Forest::of_nodes(self.0.read_nodes(progress)?)?)
    }

    fn bytes(trees: &Forest) -> usize {
        size_of_val(&trees.nodes[..])
    }
}

/// Horizons that are shown by their sheets.
struct Sheets<'a> {
    rock: &'a Rock,
    /// Their numbers.
    which: &'a [usize],
    /// The id of the first horizon.
    first_id: u32,
}

/// Distances and leaves at every voxel: those of an extraction, and those of sheets.
struct ShownVoxels<'a> {
    extraction: Option<&'a StoredCandidates>,
    sheets: Option<Sheets<'a>>,
    size: [usize; 3],
    /// Largest distance, voxels.
    farthest: f32,
}

impl Query for ShownVoxels<'_> {
    const WHAT: &'static str = "distances and leaves";
    type Answer = CandidateBox;

    fn key(&self, _: Facts<'_>) -> Result<String, ProjectError> {
        let extraction = self.extraction.map(|stored| &stored.info().key);
        let sheets = self.sheets.as_ref().map(|sheets| (&sheets.rock.key, sheets.which, sheets.first_id));
        Ok(derived::key_of(&(extraction, sheets, self.size, self.farthest)))
    }

    fn compute(&self, _: Facts<'_>, progress: &Progress) -> Result<CandidateBox, ProjectError> {
        let mut voxels = match self.extraction {
            Some(stored) => {
                memory::check("horizon candidates at every sample", &self.size, CANDIDATE_BYTES)?;
                stored.read(0, progress)?
            }
            None => horizon_distance::nothing_near(self.size),
        };
        if let Some(Sheets { rock, which, first_id }) = &self.sheets {
            let model = &rock.model;
            horizon_distance::add_horizons(model, which, *first_id, self.farthest, &mut voxels, progress)?;
        }
        Ok(voxels)
    }

    fn bytes(voxels: &CandidateBox) -> usize {
        voxels.distance.len() + size_of_val(&voxels.leaf[..])
    }
}
