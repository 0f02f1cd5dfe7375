//! Named scenes.

use super::{Effect, Noun, ProjectError};
use crate::document::{Id, SceneEntry};
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

impl AddScene {
    pub(super) fn execute(&self, draft: &mut Draft) -> Result<Effect, ProjectError> {
        draft.document.check_new_name(Noun::Scene, &self.name)?;
        self.scene.validate(draft.document.frame()?)?;
        draft.document.scenes.push(SceneEntry {
            id: Id::default(),
            name: self.name.clone(),
            scene: self.scene.clone(),
        });
        Ok(Effect::Changed { summary: format!("scene {}", self.name) })
    }
}
