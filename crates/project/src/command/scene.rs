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

/// Gives a scene another name.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct RenameScene {
    /// Its name.
    pub from: String,
    /// Its new name.
    pub to: String,
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

impl RenameScene {
    pub(super) fn execute(&self, draft: &mut Draft) -> Result<Effect, ProjectError> {
        let Self { from, to } = self;
        let document = &mut draft.document;
        let index = document.position(Noun::Scene, from)?;
        // The scene's own name in another case is not a duplicate.
        if from.to_lowercase() != to.to_lowercase() {
            document.check_new_name(Noun::Scene, to)?;
        }
        document.scenes[index].name.clone_from(to);
        let notes = document.notes.iter_mut().filter_map(|note| note.scene.as_mut());
        let figures = document.figures.iter_mut().filter_map(|figure| figure.scene.as_mut());
        notes.chain(figures).filter(|name| *name == from).for_each(|name| name.clone_from(to));
        Ok(Effect::Changed { summary: format!("scene {from} is now {to}") })
    }
}

impl RemoveScene {
    pub(super) fn execute(&self, draft: &mut Draft) -> Result<Effect, ProjectError> {
        let index = draft.document.position(Noun::Scene, &self.name)?;
        draft.document.scenes.remove(index);
        Ok(Effect::Changed { summary: format!("removed scene {}", self.name) })
    }
}
