//! Named scenes.

use super::{Effect, Noun, ProjectError};
use crate::document::SceneEntry;
use crate::folder::Draft;
use render::Scene;
use serde::{Deserialize, Serialize};

/// Saves a scene under a name.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct AddScene {
    /// Its name.
    pub name: String,
    /// The scene.
    pub scene: Scene,
}

/// Removes a scene.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct RemoveScene {
    /// Its name.
    pub name: String,
}

impl AddScene {
    pub(super) fn execute(&self, draft: &mut Draft) -> Result<Effect, ProjectError> {
        draft.document.check_new_name(Noun::Scene, &self.name)?;
        self.scene.validate(draft.document.frame()?)?;
        draft.document.scenes.push(SceneEntry { name: self.name.clone(), scene: self.scene.clone() });
        Ok(Effect::Changed { summary: format!("scene {}", self.name) })
    }
}

impl RemoveScene {
    pub(super) fn execute(&self, draft: &mut Draft) -> Result<Effect, ProjectError> {
        let index = draft.document.position(Noun::Scene, &self.name)?;
        draft.document.scenes.remove(index);
        Ok(Effect::Changed { summary: format!("removed scene {}", self.name) })
    }
}
