//! Horizons where there is no candidate: lines drawn by hand, and reflections tracked from one place.

use super::{Effect, ProjectError};
use crate::derived::FaultBlocks;
use crate::document::{Drawn, DrawnEntry};
use crate::folder::Draft;
use crate::interpretation::assembly::{self, AssemblyReport, rebuild};
use serde::{Deserialize, Serialize};
use survey::{Progress, SurveyGeometry};
use ttf::Colour;

/// Draws a line of a horizon, or tracks it from a place. It needs no candidates.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct DrawHorizon {
    /// The horizon; it is created if it does not exist.
    pub horizon: String,
    /// Colour of the horizon; `None`: its present one, or the next of the palette.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub colour: Option<Colour>,
    /// What is drawn.
    pub part: Drawn,
}

/// The report of a part that was drawn or tracked.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct HorizonDrawn {
    /// Its number, which no pick has.
    pub pick: u32,
    /// The horizon.
    pub horizon: String,
    /// What was drawn.
    pub part: Drawn,
    /// Number of nodes that it made.
    pub nodes: usize,
    /// The present state of the horizon.
    pub result: AssemblyReport,
}

impl HorizonDrawn {
    /// The report in a few words, for the history.
    pub fn summary(&self) -> String {
        format!("{} {} of {}", self.part.noun(), self.pick, self.horizon)
    }
}

impl std::fmt::Display for HorizonDrawn {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let [inline, crossline, z] = self.part.place();
        let what = match &self.part {
            Drawn::Line { points, snap } => {
                let on = if *snap { ", laid on the reflection" } else { "" };
                format!("a line of {} points from {inline},{crossline},{z}{on}", points.len())
            }
            Drawn::Tracked { .. } => format!("tracked from {inline},{crossline},{z}"),
        };
        write!(f, "{} of \"{}\": {what}, {} nodes\n  {}", self.pick, self.horizon, self.nodes, self.result)
    }
}

impl DrawHorizon {
    pub(super) fn execute(&self, draft: &mut Draft, progress: &Progress) -> Result<Effect, ProjectError> {
        self.check(draft.document.frame()?)?;
        let mut log = assembly::log_or_new(draft, &self.horizon)?;
        let candidates = assembly::needed(draft, &log, progress)?;
        let blocks = draft.facts().get(&FaultBlocks, progress)?;
        let id = draft.document.next_pick_id();
        if let Some(colour) = self.colour {
            log.colour = colour;
        }
        log.drawn.push(DrawnEntry { id, part: self.part.clone() });
        let result = match rebuild(draft, candidates.as_deref(), &blocks, &self.horizon, log, progress) {
            // A first tracking that found nothing leaves nothing.
            Err(ProjectError::NothingLeft { .. }) => return Err(self.nothing()),
            result => result?,
        };
        let nodes = result.drawn;
        if nodes <= 1 && matches!(self.part, Drawn::Tracked { .. }) {
            return Err(self.nothing());
        }
        let (horizon, part) = (self.horizon.clone(), self.part.clone());
        Ok(Effect::HorizonDrawn(Box::new(HorizonDrawn { pick: id, horizon, part, nodes, result })))
    }

    fn nothing(&self) -> ProjectError {
        ProjectError::NothingTracked { at: self.part.place() }
    }

    /// Refuses a line of one point, and places outside of the survey.
    fn check(&self, geometry: &SurveyGeometry) -> Result<(), ProjectError> {
        let size = geometry.size();
        let check = |place: &[f64; 3]| {
            let voxel = geometry.voxel_from_lines(place[0], place[1]).extend(geometry.vertical.index_of(place[2]));
            let is_inside = |axis: usize| voxel[axis] >= -0.5 && voxel[axis] <= size[axis] as f64 - 0.5;
            if (0..3).all(is_inside) { Ok(()) } else { Err(ProjectError::outside(*place, geometry)) }
        };
        match &self.part {
            Drawn::Line { points, .. } if points.len() < 2 => Err(ProjectError::ShortLine),
            Drawn::Line { points, .. } => points.iter().try_for_each(check),
            Drawn::Tracked { at, .. } => check(at),
        }
    }
}
