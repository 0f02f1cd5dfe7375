//! Filling the holes of a horizon, assembled or imported.

use super::{Effect, Noun, ProjectError};
use crate::content;
use crate::folder::Draft;
use crate::interpretation::assembly::{self, AssemblyReport, put, rebuild, report_on};
use crate::interpretation::candidates::Candidates;
use interp::holes::{FillSettings, fill_holes};
use interp::reassembly::{from_horizon, to_horizon};
use serde::{Deserialize, Serialize};
use survey::Progress;

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

/// The report of a horizon whose holes were filled.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct HorizonFilled {
    /// Its name.
    pub horizon: String,
    /// Its present state.
    pub result: AssemblyReport,
}

impl std::fmt::Display for HorizonFilled {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "{}: {}", self.horizon, self.result)
    }
}

impl FillHorizon {
    pub(super) fn execute(&self, draft: &mut Draft, progress: &Progress) -> Result<Effect, ProjectError> {
        let index = draft.document.position(Noun::Horizon, &self.name)?;
        let blocks = assembly::blocks(draft.root(), &draft.document, progress)?;
        let result = match draft.document.horizons[index].assembly.clone() {
            Some(mut log) => {
                let candidates = Candidates::load(draft.root(), &draft.document, progress)?;
                log.fill = Some(self.settings);
                rebuild(draft, &candidates, &blocks, &self.name, log, progress)?
            }
            None => {
                let geometry = draft.document.frame()?.clone();
                let horizon = content::read_horizon(draft.root(), &draft.document.horizons[index], progress)?;
                let mut sheets = from_horizon(&horizon, &geometry, &blocks);
                let [nx, ny, _] = geometry.size();
                let filled = fill_holes(&mut sheets, [nx, ny], &blocks, &self.settings, progress)?;
                put(draft, &to_horizon(&self.name, &sheets, &geometry), None, progress)?;
                AssemblyReport { filled: Some(filled), ..report_on(&sheets, &geometry) }
            }
        };
        Ok(Effect::HorizonFilled(Box::new(HorizonFilled { horizon: self.name.clone(), result })))
    }
}
