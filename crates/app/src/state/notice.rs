//! Messages: errors and notes, kept where they arose until the user has seen them.

use crate::{fields, hint};
use project::error::remedy_of;

/// The part of the window where a message is shown.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Place {
    /// The start page.
    Start,
    /// The block view.
    Block,
    /// The stratigraphic column and its styles.
    Layers,
    /// Volumes, horizons, faults.
    Data,
    /// Picks, faults, the extraction.
    Interpret,
    /// Named scenes and view settings.
    Scenes,
    /// The status bar: for what was done and shows nowhere else.
    Foot,
    /// The dialogue in front.
    Dialogue,
}

/// One message.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Notice {
    /// Where it is shown.
    pub place: Place,
    /// Whether something failed; otherwise the message is a note.
    pub failed: bool,
    /// What happened.
    pub text: String,
    /// What to do next.
    pub hint: Option<String>,
}

impl Notice {
    /// An error, with its chain of causes; a cause that the text already quotes is not repeated.
    pub fn failure(place: Place, error: &(dyn std::error::Error + 'static)) -> Self {
        let mut text = error.to_string();
        let hint = hint::of(error).or_else(|| remedy_of(error).map(|remedy| fields::advice(&remedy)));
        let mut cause = error.source();
        while let Some(inner) = cause {
            let said = inner.to_string();
            if !text.contains(&said) {
                text = format!("{text}: {said}");
            }
            cause = inner.source();
        }
        Self { place, failed: true, text, hint }
    }

    /// A note.
    pub fn note(place: Place, text: impl Into<String>) -> Self {
        Self { place, failed: false, text: text.into(), hint: None }
    }
}
