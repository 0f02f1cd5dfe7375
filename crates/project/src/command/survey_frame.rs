//! Changes to the survey geometry.

use super::{Effect, ProjectError};
use crate::folder::Draft;
use serde::{Deserialize, Serialize};

/// Sets the velocity that turns two-way time into metres.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct SetVelocity {
    /// Velocity in m/s. The wave travels the depth twice.
    pub velocity_m_s: f64,
}

impl SetVelocity {
    pub(super) fn execute(self, draft: &mut Draft) -> Result<Effect, ProjectError> {
        let mut geometry = draft.document.frame()?.clone();
        geometry.velocity_m_s = self.velocity_m_s;
        geometry.validate()?;
        draft.document.geometry = Some(geometry);
        Ok(Effect::Changed { summary: format!("velocity is {} m/s", self.velocity_m_s) })
    }
}
