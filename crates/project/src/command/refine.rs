//! Filling the holes of a horizon, assembled or imported, and smoothing it.

use super::{Effect, Noun, ProjectError};
use crate::content;
use crate::derived::FaultBlocks;
use crate::document::{Assembly, Refinement};
use crate::folder::Draft;
use crate::interpretation::assembly::{self, AssemblyReport, put, rebuild, report_on};
use crate::interpretation::finish;
use interp::holes::FillSettings;
use interp::reassembly::{from_horizon, to_horizon};
use interp::refine::SmoothSettings;
use serde::{Deserialize, Serialize};
use survey::{Horizon, Progress};

/// Fills holes with the surface of least curvature, never across a fault. An assembled horizon stays filled
/// when its picks change.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct FillHorizon {
    /// Name of the horizon.
    pub name: String,
    /// Which holes are filled.
    #[serde(default)]
    pub settings: FillSettings,
}

/// Smooths a horizon, never across a fault. An assembled horizon stays smoothed when its picks change; a radius of 0 takes
/// that back.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct SmoothHorizon {
    /// Name of the horizon.
    pub name: String,
    /// How it is smoothed.
    #[serde(default)]
    pub settings: SmoothSettings,
}

/// The report of a horizon that was filled or smoothed.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct HorizonRefined {
    /// Its name.
    pub horizon: String,
    /// Its present state.
    pub result: AssemblyReport,
}

impl std::fmt::Display for HorizonRefined {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "{}: {}", self.horizon, self.result)
    }
}

impl FillHorizon {
    pub(super) fn execute(&self, draft: &mut Draft, progress: &Progress) -> Result<Effect, ProjectError> {
        let change = |log: &mut Assembly| log.fill = Some(self.settings);
        refine(draft, &self.name, change, (Some(&self.settings), None, Refinement::Filled), progress)
    }
}

impl SmoothHorizon {
    pub(super) fn execute(&self, draft: &mut Draft, progress: &Progress) -> Result<Effect, ProjectError> {
        let change = |log: &mut Assembly| log.smooth = (self.settings.radius > 0).then_some(self.settings);
        refine(draft, &self.name, change, (None, Some(&self.settings), Refinement::Smoothed), progress)
    }
}

/// Changes the log of an assembled horizon and makes it again, or fills or smooths an imported one and says so in its
/// record.
fn refine(
    draft: &mut Draft,
    name: &str,
    change: impl FnOnce(&mut Assembly),
    (fill, smooth, done): (Option<&FillSettings>, Option<&SmoothSettings>, Refinement),
    progress: &Progress,
) -> Result<Effect, ProjectError> {
    let index = draft.document.position(Noun::Horizon, name)?;
    let blocks = draft.facts().get(&FaultBlocks, progress)?;
    let result = match draft.document.horizons[index].assembly.clone() {
        Some(mut log) => {
            let candidates = assembly::needed(draft, &log, progress)?;
            change(&mut log);
            rebuild(draft, candidates.as_deref(), &blocks, name, log, progress)?
        }
        None => {
            let geometry = draft.document.frame()?.clone();
            let horizon = content::read_horizon(draft.root(), &draft.document.horizons[index], progress)?;
            let mut sheets = from_horizon(&horizon, &geometry, &blocks);
            let (filled, smoothed) = finish::refine(draft, &mut sheets, &blocks, fill, smooth, progress)?;
            // Its points are kept: they are fitted again when the faults change.
            let refined = Horizon { surface: horizon.surface, ..to_horizon(name, &sheets, &geometry) };
            put(draft, &refined, None, Some(done), progress)?;
            AssemblyReport { filled, smoothed, ..report_on(&sheets, &geometry) }
        }
    };
    Ok(Effect::HorizonRefined(Box::new(HorizonRefined { horizon: name.to_owned(), result })))
}
