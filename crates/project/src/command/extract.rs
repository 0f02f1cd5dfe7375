//! Extraction of horizon candidates and the proposal of faults, as changes of a project: undo restores what was there
//! before.
//!
//! Long computations run in `prepare`, before the project is locked, and their result is stored under a key. `execute`
//! then only records the key.

use super::Effect;
use crate::document::{Document, ExtractionEntry, ProposalsEntry};
use crate::error::ProjectError;
use crate::folder::Draft;
use crate::interpretation::extraction::{self, Stored};
use crate::interpretation::proposals;
use interp::faults::ProposeSettings;
use interp::{ExtractSettings, StageSeconds};
use serde::{Deserialize, Serialize};
use std::path::Path;
use survey::Progress;

/// Extracts horizon candidates from a volume; picks are made from them.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Extract {
    /// The volume; `None`: the first on the project's own lattice.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub volume: Option<String>,
    /// The settings of the extraction.
    #[serde(default)]
    pub settings: ExtractSettings,
    /// Memory to use, bytes; `None`: half of what is available. What takes more in one piece is done in bricks. It is not
    /// recorded, since the result does not depend on it.
    #[serde(skip)]
    pub memory_bytes: Option<u64>,
    /// Whether this program has stored the candidates a moment ago, so that they are not read whole to verify them. Not
    /// recorded.
    #[serde(skip)]
    pub just_stored: bool,
}

impl Extract {
    /// Computes the candidates, unless they exist; returns how long that took if it had to.
    pub(super) fn prepare(
        &self,
        root: &Path,
        document: &Document,
        progress: &Progress,
    ) -> Result<Option<StageSeconds>, ProjectError> {
        let volume = self.volume.as_deref();
        let extracted = extraction::compute(
            root,
            document,
            volume,
            &self.settings,
            (if self.just_stored { Stored::Trusted } else { Stored::Verified }, self.memory_bytes),
            progress,
        )?;
        Ok(extracted.report.seconds.filter(|_| extracted.computed))
    }

    pub(super) fn execute(&self, draft: &mut Draft, progress: &Progress) -> Result<Effect, ProjectError> {
        let (root, volume) = (draft.root().to_owned(), self.volume.as_deref());
        let mut extracted = extraction::compute(
            &root,
            &draft.document,
            volume,
            &self.settings,
            (Stored::Trusted, self.memory_bytes),
            progress,
        )?;
        // They are renamed when the state that names them is saved.
        extracted.file = extraction::present_path(&root);
        draft.document.extraction =
            Some(ExtractionEntry { key: extracted.key.clone(), volume: extracted.volume.clone() });
        extraction::replace_damaged(&root, &draft.document);
        Ok(Effect::Extracted(Box::new(extracted)))
    }
}

/// Proposes faults from the offsets and bends of the project's horizons or, while there are none, from where the
/// candidates end.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct ProposeFaults {
    /// The settings of the proposal.
    #[serde(default)]
    pub settings: ProposeSettings,
}

impl ProposeFaults {
    /// Computes the proposals, unless they exist.
    pub(super) fn prepare(&self, root: &Path, document: &Document, progress: &Progress) -> Result<(), ProjectError> {
        proposals::compute(root, document, &self.settings, progress).map(drop)
    }

    pub(super) fn execute(&self, draft: &mut Draft, progress: &Progress) -> Result<Effect, ProjectError> {
        let root = draft.root().to_owned();
        let (key, found) = proposals::compute(&root, &draft.document, &self.settings, progress)?;
        draft.document.fault_proposals = Some(ProposalsEntry { key });
        Ok(Effect::FaultsProposed(Box::new(found)))
    }
}
