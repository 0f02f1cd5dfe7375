//! Contact rules: what a horizon does to its neighbours.

use super::{Effect, Noun, ProjectError};
use crate::folder::Draft;
use serde::{Deserialize, Serialize};
use survey::Contact;

/// Sets the contact rule of a horizon.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct SetContact {
    /// Name of the horizon.
    pub horizon: String,
    /// The rule.
    pub contact: Contact,
}

impl SetContact {
    pub(super) fn execute(&self, draft: &mut Draft) -> Result<Effect, ProjectError> {
        let index = draft.document.position(Noun::Horizon, &self.horizon)?;
        draft.document.horizons[index].contact = self.contact;
        let contact = format!("{:?}", self.contact).to_lowercase();
        Ok(Effect::Changed { summary: format!("horizon {} is {contact}", self.horizon) })
    }
}
