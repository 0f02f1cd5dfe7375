//! Messages: errors and notes, kept where they arose until the user has seen them.

use crate::fields;
use crate::hint;
use project::ProjectError;
use project::check::CheckReport;
use project::error::remedy_of;
use std::path::{Path, PathBuf};
use system::command_line::CommandLine;

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
    /// A project that may be damaged: a check of it is offered.
    pub suspect: Option<PathBuf>,
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
        Self { place, failed: true, text, hint, suspect: None }
    }

    /// A failure with a project, of which a check is offered where that may tell more.
    pub fn failure_with(place: Place, error: &ProjectError, root: &Path) -> Self {
        let suspect = may_be_damage(error).then(|| root.to_owned());
        Self { suspect, ..Self::failure(place, error) }
    }

    /// What a check found, in short.
    pub fn checked(place: Place, found: &CheckReport) -> Self {
        const TOLD: usize = 3;
        let damage: Vec<_> = found.damage.iter().filter(|damage| !damage.repaired).collect();
        if damage.is_empty() && !found.is_well() {
            let unread =
                found.unread.iter().map(|unread| format!("{} cannot be read now: {}", unread.what, unread.reason));
            let undrawn = found.undrawable.iter().map(|reason| format!("cannot be drawn: {reason}"));
            let told: Vec<String> = unread.chain(undrawn).take(TOLD).collect();
            return Self { failed: true, ..Self::note(place, format!("nothing is damaged, but {}", told.join("; "))) };
        }
        if damage.is_empty() {
            let count = found.data_files + found.derived_files;
            return Self::note(
                place,
                format!("nothing is damaged in {}: {count} files were checked", found.project.display()),
            );
        }
        let told: Vec<String> =
            damage.iter().take(TOLD).map(|damage| format!("{}: {}", damage.what, damage.reason)).collect();
        let more = damage.len().saturating_sub(TOLD);
        let rest = if more == 0 { String::new() } else { format!("; and {more} more") };
        let line = CommandLine::new("check").value(&found.project);
        let project = found.project.display();
        Self {
            failed: true,
            hint: Some(format!("`{line}` says what depends on it and what to do, and repairs with --repair")),
            ..Self::note(place, format!("{} damaged in {project}: {}{rest}", damage.len(), told.join("; ")))
        }
    }

    /// A note.
    pub fn note(place: Place, text: impl Into<String>) -> Self {
        Self { place, failed: false, text: text.into(), hint: None, suspect: None }
    }
}

/// Whether a check may tell more about an error.
fn may_be_damage(error: &ProjectError) -> bool {
    match error {
        ProjectError::Malformed { .. }
        | ProjectError::OtherContent { .. }
        | ProjectError::OtherSize { .. }
        | ProjectError::Unsound { .. }
        | ProjectError::Link { .. } => true,
        ProjectError::NotAProject { path, .. } => path.join("history").is_dir(),
        ProjectError::Store(_) => true,
        _ => false,
    }
}
