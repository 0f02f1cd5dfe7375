//! Everything that changes a project, as one serialisable enum: what was asked for, not how it is done.
//!
//! A command reads files and the present state, writes new data through the [`Draft`] and leaves the new state in it. It
//! overwrites nothing and can fail at any point: [`crate::Project::apply`] discards the draft then. Undo needs nothing
//! from a command, because every state is remembered.

mod contact;
mod survey_frame;

pub use contact::SetContact;
pub use survey_frame::SetVelocity;

use crate::error::{Noun, ProjectError};
use crate::project::Draft;
use serde::{Deserialize, Serialize};
use survey::{Progress, SurveyGeometry};

/// A change to a project.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Command {
    /// Begin a project, with a survey frame or without.
    Create {
        /// The lattice that everything is placed in.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        geometry: Option<SurveyGeometry>,
    },
    /// State the velocity that turns two-way time into metres.
    SetVelocity(SetVelocity),
    /// Say what a horizon does to its neighbours.
    SetContact(SetContact),
}

/// What a command did: the facts to tell the user.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[serde(tag = "effect", rename_all = "kebab-case")]
pub enum Effect {
    /// The project exists.
    Created,
    /// Something small changed.
    Changed {
        /// What, in a few words.
        summary: String,
    },
}

impl Command {
    /// Does what it says to the draft.
    pub(crate) fn execute(&self, draft: &mut Draft, _progress: &Progress) -> Result<Effect, ProjectError> {
        match self {
            Self::Create { .. } => Err(ProjectError::Exists { path: draft.root().to_owned() }),
            Self::SetVelocity(change) => change.execute(draft),
            Self::SetContact(change) => change.execute(draft),
        }
    }
}

impl Effect {
    /// What happened, in a few words for the history.
    pub fn summary(&self) -> String {
        match self {
            Self::Created => "create".to_owned(),
            Self::Changed { summary } => summary.clone(),
        }
    }
}
