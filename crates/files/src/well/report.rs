//! What was read of a well's files, what was assumed and what should be checked.

use serde::Serialize;
use survey::remedy::Note;

/// What was read and assumed.
#[derive(Debug, Clone, Default, PartialEq, Serialize)]
pub struct WellReport {
    /// Facts, one sentence each.
    pub notes: Vec<Note>,
    /// What was assumed, each with what to state otherwise.
    pub assumptions: Vec<Note>,
    /// What the user should check, one sentence each.
    pub warnings: Vec<Note>,
}

impl WellReport {
    /// Every note whose remedy a user interface may reword.
    pub fn notes_mut(&mut self) -> impl Iterator<Item = &mut Note> {
        self.notes.iter_mut().chain(&mut self.assumptions).chain(&mut self.warnings)
    }

    /// Adds a fact.
    pub(super) fn note(&mut self, fact: impl Into<Note>) {
        self.notes.push(fact.into());
    }

    /// Adds an assumption, once.
    pub(super) fn assume(&mut self, note: Note) {
        if !self.assumptions.contains(&note) {
            self.assumptions.push(note);
        }
    }

    /// Adds something to check, once.
    pub(super) fn warn_once(&mut self, note: impl Into<Note>) {
        let note = note.into();
        if !self.warnings.contains(&note) {
            self.warnings.push(note);
        }
    }
}
