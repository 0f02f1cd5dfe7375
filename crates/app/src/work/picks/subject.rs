//! The project that is being interpreted: what was read of it, and what a selection covers in it.

use super::ShownPick;
use crate::state::picking::Pick;
use interp::ExtractReport;
use interp::assembly::{ClimbSettings, Occupancy, Overlap, Selection, node_above};
use interp::reassembly::{VoxelSheet, reassemble};
use model::FaultNetwork;
use project::Facts;
use project::derived::FaultBlocks;
use project::document::Document;
use project::error::ProjectError;
use project::interpretation::assembly::{self, ReportedOverlap};
use project::interpretation::candidates::Candidates;
use project::interpretation::{HorizonSheets, extraction};
use std::path::PathBuf;
use std::sync::Arc;
use survey::{Progress, SurveyGeometry};

/// The project that is being interpreted, and what was read of it.
pub(super) struct Followed {
    pub(super) root: PathBuf,
    pub(super) document: Document,
    pub(super) geometry: SurveyGeometry,
    pub(super) candidates: Option<Arc<Candidates>>,
    /// The report of the extraction.
    pub(super) extraction: Option<ExtractReport>,
    pub(super) blocks: Arc<FaultNetwork>,
    /// The sheets of each horizon.
    pub(super) sheets: Vec<Arc<Vec<VoxelSheet>>>,
}

impl Followed {
    /// Reads what a state of the project in `root` needs and is not in memory.
    ///
    /// # Errors
    /// Data are damaged, or the user cancelled.
    pub(super) fn read(root: PathBuf, document: Document, progress: &Progress) -> Result<Self, ProjectError> {
        let facts = Facts::of(&root, &document);
        let geometry = document.frame()?.clone();
        // Candidates that cannot be opened are damaged; this is an error, and not an extraction that is absent.
        let extraction = match extraction::open(&root, &document) {
            Err(ProjectError::NotExtracted) => None,
            opened => Some(opened?),
        };
        let candidates = extraction.as_ref().map(|_| Candidates::load(facts, progress)).transpose()?;
        let extraction = extraction.and_then(|stored| extraction::report(&stored));
        let blocks = facts.get(&FaultBlocks, progress)?;
        let sheets = document.horizons.iter().map(|entry| facts.get(&HorizonSheets(entry), progress));
        let sheets = sheets.collect::<Result<_, _>>()?;
        Ok(Self { root, document, geometry, candidates, extraction, blocks, sheets })
    }

    /// The candidates, if there is an extraction.
    pub(super) fn candidates(&self) -> Result<&Candidates, ProjectError> {
        self.candidates.as_deref().ok_or(ProjectError::NotExtracted)
    }

    /// The nodes that the picks of a horizon have selected.
    pub(super) fn chosen(&self, horizon: Option<&str>) -> Selection {
        let entry = self.document.horizons.iter().find(|entry| Some(entry.name.as_str()) == horizon);
        let log = entry.and_then(|entry| Some((entry, entry.assembly.as_ref()?)));
        log.zip(self.candidates.as_deref())
            .and_then(|((entry, log), candidates)| assembly::selection(&entry.name, log, candidates).ok())
            .unwrap_or_default()
    }

    /// A selection as sheets; `None` where the extraction has changed and the selection no longer means anything.
    pub(super) fn show(&self, pick: Pick, horizon: Option<&str>) -> Result<Option<ShownPick>, ProjectError> {
        let candidates = self.candidates()?;
        let forest = &candidates.forest;
        if pick.leaf == 0 || pick.leaf as usize > forest.leaves.len() {
            return Ok(None);
        }
        let Ok(node) = node_above(forest, pick.leaf, pick.up) else { return Ok(None) };
        let range = forest.nodes[node as usize].triangles.clone();
        let mut own = Selection::default();
        own.insert(range.clone());
        let seed = forest.nodes[forest.leaves[pick.leaf as usize - 1] as usize].triangles.start;
        let sheets = reassemble(forest, &own, &[seed], &self.blocks).sheets;
        let mut occupancy = Occupancy::new(&forest.surfaces, &self.blocks);
        for range in self.chosen(horizon).ranges() {
            occupancy.add(range.clone());
        }
        let before = (occupancy.vertices(), occupancy.overlap().traces);
        occupancy.add(range.clone());
        let overlap = occupancy.overlap();
        let (vertices, traces) = (occupancy.vertices() - before.0, overlap.traces - before.1);
        let is_wrong = traces as f64 > ClimbSettings::default().tolerated_share * vertices as f64;
        let overlap = ReportedOverlap::new(Overlap { traces, ..overlap }, &self.geometry);
        let leaves = forest.leaves_under(node).collect();
        Ok(Some(ShownPick { pick, sheets, triangles: range.len(), leaves, overlap, is_wrong }))
    }
}
