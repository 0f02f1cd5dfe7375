//! Textures of scalar volumes (P-illus 4.2) and the colours of raw data (P-illus 4.3).

use super::{Effect, Noun, ProjectError};
use crate::folder::Draft;
use crate::styles;
use serde::{Deserialize, Serialize};
use ttf::{RawColour, ScalarTtf};

/// Lays textures over the layers by the values of a volume; replaces the volume's present function.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct SetScalar {
    /// The function.
    pub function: ScalarTtf,
}

/// Removes the textures of a volume.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct RemoveScalar {
    /// Name of the volume.
    pub volume: String,
}

/// Sets which volume is shown as raw data, and in which colours.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct SetRaw {
    /// Volume and colours.
    pub raw: RawColour,
}

impl SetScalar {
    pub(super) fn execute(&self, draft: &mut Draft) -> Result<Effect, ProjectError> {
        draft.document.position(Noun::Volume, &self.function.volume)?;
        self.function.validate(&styles::pattern_library(draft.root(), &draft.document)?)?;
        let stack = &mut draft.document.style.scalars;
        match stack.iter_mut().find(|present| present.volume == self.function.volume) {
            Some(present) => *present = self.function.clone(),
            None => stack.push(self.function.clone()),
        }
        Ok(Effect::Changed { summary: format!("textures of volume {}", self.function.volume) })
    }
}

impl RemoveScalar {
    pub(super) fn execute(&self, draft: &mut Draft) -> Result<Effect, ProjectError> {
        draft.document.position(Noun::Volume, &self.volume)?;
        draft.document.style.scalars.retain(|present| present.volume != self.volume);
        Ok(Effect::Changed { summary: format!("removed the textures of volume {}", self.volume) })
    }
}

impl SetRaw {
    pub(super) fn execute(&self, draft: &mut Draft) -> Result<Effect, ProjectError> {
        draft.document.position(Noun::Volume, &self.raw.volume)?;
        self.raw.function.validate(&format!("the colours of `{}`", self.raw.volume))?;
        draft.document.style.raw = Some(self.raw.clone());
        Ok(Effect::Changed { summary: format!("raw data is volume {}", self.raw.volume) })
    }
}
