//! What can be done with anything that has a name: give it another, remove it, colour it.

use super::{Effect, Noun, ProjectError, SetLayer};
use crate::folder::Draft;
use crate::interpretation::assembly::rebuild_all;
use serde::{Deserialize, Serialize};
use survey::Progress;
use ttf::Colour;

/// Gives something another name. Whatever refers to it does so by its id, so nothing else changes and nothing is computed
/// anew.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct Rename {
    /// What it is.
    pub noun: Noun,
    /// Its name.
    pub from: String,
    /// Its new name.
    pub to: String,
}

/// Removes something. References to it are dropped with what hangs on them: a map of a horizon goes with the horizon.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct Remove {
    /// What it is.
    pub noun: Noun,
    /// Its name; that of a note is its number in the list, from 1, and that of a figure its file.
    pub name: String,
}

/// Gives something another colour.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct SetColour {
    /// What it is.
    pub noun: Noun,
    /// Its name.
    pub name: String,
    /// Its colour: of a fault's lines and sticks, of a well's path, of a layer under its pattern.
    pub colour: Colour,
}

/// What the noun cannot do.
fn refused(noun: Noun, name: &str, fact: &'static str) -> ProjectError {
    ProjectError::Refused { noun, name: name.to_owned(), fact }
}

impl Rename {
    pub(super) fn execute(&self, draft: &mut Draft) -> Result<Effect, ProjectError> {
        let Self { noun, from, to } = self;
        let index = draft.document.position(*noun, from)?;
        // Its own name in another case is not a duplicate.
        if from.to_lowercase() != to.to_lowercase() {
            draft.document.check_new_name(*noun, to)?;
            let is_pattern = || Ok::<_, ProjectError>(ttf::TextureLibrary::builtin()?.find(to).is_some());
            if *noun == Noun::Texture && is_pattern()? {
                return Err(ProjectError::Duplicate { noun: *noun, name: to.clone() });
            }
        }
        let document = &mut draft.document;
        match noun {
            Noun::Layer => document.name_layer(index, to)?,
            Noun::Figure => document.figures[index].file.clone_from(to),
            Noun::Parameterization => return Err(refused(*noun, from, "is called after its file")),
            Noun::Note => return Err(refused(*noun, from, "is called by its number")),
            Noun::Volume | Noun::Horizon | Noun::Fault | Noun::Well | Noun::Texture | Noun::Scene => {
                document.by_ids(|document| document.name_entry(*noun, index, to));
            }
        }
        Ok(Effect::Changed { summary: format!("{noun} {from} is now {to}") })
    }
}

impl Remove {
    pub(super) fn execute(&self, draft: &mut Draft, progress: &Progress) -> Result<Effect, ProjectError> {
        let Self { noun, name } = self;
        let index = draft.document.position(*noun, name)?;
        if *noun == Noun::Layer {
            return Err(refused(*noun, name, "lies between two horizons: remove the one at its base"));
        }
        let ((), lost) = draft.document.by_ids(|document| match noun {
            Noun::Volume => drop(document.volumes.remove(index)),
            Noun::Horizon => drop(document.take_out(index)),
            Noun::Fault => drop(document.faults.remove(index)),
            Noun::Well => drop(document.wells.remove(index)),
            Noun::Texture => drop(document.textures.remove(index)),
            Noun::Parameterization => document.parameterization = None,
            Noun::Scene => drop(document.scenes.remove(index)),
            Noun::Note => drop(document.notes.remove(index)),
            Noun::Figure => drop(document.figures.remove(index)),
            Noun::Layer => {}
        });
        let fitted = if *noun == Noun::Fault { rebuild_all(draft, progress)? } else { Vec::new() };
        let with_it = if lost.is_empty() { String::new() } else { format!("; changed with it: {}", lost.join(", ")) };
        Ok(Effect::changed(format!("removed {noun} {name}{with_it}"), fitted))
    }
}

impl SetColour {
    pub(super) fn execute(&self, draft: &mut Draft) -> Result<Effect, ProjectError> {
        let Self { noun, name, colour } = self;
        let index = draft.document.position(*noun, name)?;
        let document = &mut draft.document;
        match noun {
            Noun::Horizon => document.horizons[index].set_colour(*colour),
            Noun::Fault => document.faults[index].colour = Some(*colour),
            Noun::Well => document.wells[index].colour = Some(*colour),
            Noun::Layer => {
                let style = SetLayer { layer: name.clone(), colour: Some(*colour), ..SetLayer::default() };
                return style.execute(draft);
            }
            _ => return Err(refused(*noun, name, "has no colour of its own")),
        }
        Ok(Effect::Changed { summary: format!("colour of {noun} {name}") })
    }
}
