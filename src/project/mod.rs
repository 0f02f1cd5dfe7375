//! A project: a folder `NAME.petro` with what was imported, how it is to be drawn, and how that came about.
//!
//! ```text
//! project.toml        the state (see `document`); replaced as a whole, never changed in place
//! history/NNNN.toml   each command with the state it led to (see `history`)
//! volumes/ horizons/ faults/ wells/ textures/   data, one new file or folder for each generation
//! derived/            what was computed; may be deleted
//! lock                held while a command runs
//! ```
//!
//! [`Project::apply`] is the only way to change one. It takes the lock, reads the state again if another process has
//! changed it, lets the [`Command`] write new data and a new state, and then replaces `project.toml` by a rename: before that moment the old
//! state is valid, after it the new one. When anything fails, what was written is removed.
//!
//! Deliberately absent: no state is kept in memory that is not on disk, and nothing that is saved is edited in place.

pub mod document;
mod draft;
mod entries;
mod history;
mod layers;
mod picks;
pub mod placement;
mod storage;

pub use document::{Document, Polarity};
pub use draft::Draft;
pub use history::{HISTORY_LIMIT, Step};

pub(crate) use storage::at_hand;

use crate::command::{Command, Effect, IMPORTING};
use crate::error::ProjectError;
use std::fs;
use std::path::{Path, PathBuf};
use storage::Lock;
use survey::{Progress, SurveyGeometry};

/// An open project.
#[derive(Debug)]
pub struct Project {
    root: PathBuf,
    text: String,
    document: Document,
}

/// A line of the history.
#[derive(Debug, Clone, PartialEq, Eq, serde::Serialize)]
pub struct HistoryLine {
    /// Number of the step.
    pub step: u32,
    /// What happened.
    pub summary: String,
    /// Whether it is in effect (false: undone, can be redone).
    pub in_effect: bool,
}

impl Project {
    /// Opens the project in the folder `root`.
    ///
    /// # Errors
    /// Missing, not a project, written by a newer version, or unreadable.
    pub fn open(root: &Path) -> Result<Self, ProjectError> {
        let not_a_project = |fact| Err(ProjectError::NotAProject { path: root.to_owned(), fact });
        if !root.exists() {
            return Err(ProjectError::NotFound { path: root.to_owned() });
        }
        if !root.is_dir() {
            return not_a_project("it is a file, a project is a folder");
        }
        let path = root.join("project.toml");
        if !path.exists() {
            return not_a_project("it has no project.toml");
        }
        let text = storage::read_text(&path)?;
        let document = Document::from_text(&text, &path)?;
        Ok(Self { root: root.to_owned(), text, document })
    }

    /// Begins a new project that will be at `root`; nothing is there before [`NewProject::publish`].
    ///
    /// # Errors
    /// Something is at `root`, or the folder it would be in cannot be written.
    pub fn create(root: &Path, geometry: Option<SurveyGeometry>) -> Result<NewProject, ProjectError> {
        NewProject::begin(root, geometry)
    }

    /// The folder.
    pub fn root(&self) -> &Path {
        &self.root
    }

    /// The state.
    pub fn document(&self) -> &Document {
        &self.document
    }

    /// Carries out a command and saves the project.
    ///
    /// # Errors
    /// Whatever stands against it; the project is then as it was before, on disk and here.
    pub fn apply(&mut self, command: &Command, progress: &Progress) -> Result<Effect, ProjectError> {
        let _lock = self.lock()?;
        let mut draft = Draft::new(&self.root, self.document.clone());
        let effect = command.execute(&mut draft, progress)?;
        progress.check()?;
        self.commit(draft, effect.summary(), Some(command))?;
        Ok(effect)
    }

    /// Goes back by one command; answers what was undone.
    ///
    /// # Errors
    /// [`ProjectError::NothingToUndo`] at the beginning of what is remembered.
    pub fn undo(&mut self) -> Result<String, ProjectError> {
        let _lock = self.lock()?;
        let step = self.document.step;
        let undone = history::read(&self.root, step)?.ok_or(ProjectError::NothingToUndo)?;
        let before = step.checked_sub(1).map(|number| history::read(&self.root, number)).transpose()?.flatten();
        self.restore(before.ok_or(ProjectError::NothingToUndo)?)?;
        Ok(undone.summary)
    }

    /// Goes forward by one undone command; answers what was done again.
    ///
    /// # Errors
    /// [`ProjectError::NothingToRedo`] when nothing was undone.
    pub fn redo(&mut self) -> Result<String, ProjectError> {
        let _lock = self.lock()?;
        let after = history::read(&self.root, self.document.step + 1)?.ok_or(ProjectError::NothingToRedo)?;
        let summary = after.summary.clone();
        self.restore(after)?;
        Ok(summary)
    }

    /// Forgets the history and frees the data only it refers to.
    ///
    /// # Errors
    /// The lock is taken or the folder cannot be read.
    pub fn prune(&mut self) -> Result<(), ProjectError> {
        let _lock = self.lock()?;
        history::forget_all_but(&self.root, self.document.step)
    }

    /// What is remembered, oldest first.
    ///
    /// # Errors
    /// A step cannot be read.
    pub fn history(&self) -> Result<Vec<HistoryLine>, ProjectError> {
        let mut lines = Vec::new();
        for step in history::numbers(&self.root) {
            if let Some(Step { summary, .. }) = history::read(&self.root, step)? {
                lines.push(HistoryLine { step, summary, in_effect: step <= self.document.step });
            }
        }
        Ok(lines)
    }

    fn lock(&mut self) -> Result<Lock, ProjectError> {
        let lock = Lock::take(&self.root)?;
        let path = self.root.join("project.toml");
        let text = storage::read_text(&path)?;
        history::recover(&self.root, &text)?;
        if text != self.text {
            self.document = Document::from_text(&text, &path)?;
            self.text = text;
        }
        self.adopt_edit()?;
        Ok(lock)
    }

    /// An edit of `project.toml` by hand becomes a step of its own, so that undoing a later command does not lose it.
    fn adopt_edit(&mut self) -> Result<(), ProjectError> {
        let known = history::read(&self.root, self.document.step)?;
        if known.is_none_or(|step| step.project == self.text) {
            return Ok(());
        }
        let draft = Draft::new(&self.root, self.document.clone());
        self.commit(draft, "edited by hand".to_owned(), None)
    }

    fn commit(&mut self, mut draft: Draft, summary: String, command: Option<&Command>) -> Result<(), ProjectError> {
        let path = self.root.join("project.toml");
        let number = self.document.step + 1;
        draft.document.step = number;
        let text = draft.document.to_text(&path)?;
        // A state that could not be read back must never be saved.
        let document = Document::from_text(&text, &path)?;
        let step = Step { summary, command: command.cloned(), project: text.clone() };
        let saved = history::prepare(&self.root, number, &step)
            .and_then(|()| draft.publish())
            .and_then(|()| storage::replace(&path, text.as_bytes()));
        if let Err(error) = saved {
            history::abandon(&self.root, number);
            return Err(error);
        }
        draft.keep();
        self.text = text;
        self.document = document;
        // The new state is saved; if tidying up fails, the next writer does it.
        let _ = history::complete(&self.root, number);
        Ok(())
    }

    fn restore(&mut self, step: Step) -> Result<(), ProjectError> {
        let path = self.root.join("project.toml");
        let document = Document::from_text(&step.project, &path)?;
        storage::replace(&path, step.project.as_bytes())?;
        self.document = document;
        self.text = step.project;
        Ok(())
    }
}

/// A project in the making, in a hidden folder beside its destination. Dropped without [`NewProject::publish`], it leaves nothing.
#[derive(Debug)]
pub struct NewProject {
    project: Project,
    destination: PathBuf,
    published: bool,
    _lock: Lock,
}

impl NewProject {
    fn begin(destination: &Path, geometry: Option<SurveyGeometry>) -> Result<Self, ProjectError> {
        if destination.exists() {
            return Err(ProjectError::Exists { path: destination.to_owned() });
        }
        let mut name = std::ffi::OsString::from(".");
        name.push(destination.file_name().ok_or(ProjectError::NotFound { path: destination.to_owned() })?);
        let root = storage::new_beside(&destination.with_file_name(name));
        let fail = |source| ProjectError::io("written", destination, source);
        fs::create_dir_all(&root).map_err(fail)?;
        // Two processes may want to create the same project; the one in the making is locked under another name than its own commands use.
        let lock = Lock::take_named(&root, "creating")?;
        let path = root.join("project.toml");
        let document = Document::empty(geometry);
        let text = document.to_text(&path)?;
        // From here on, whatever fails removes the folder.
        let begun = Self {
            project: Project { root, text: text.clone(), document: document.clone() },
            destination: destination.to_owned(),
            published: false,
            _lock: lock,
        };
        for folder in ["history", "volumes", "horizons", "faults", "wells", "textures"] {
            let folder = begun.project.root.join(folder);
            storage::remove(&folder);
            fs::create_dir(folder).map_err(fail)?;
        }
        let step = Step {
            summary: "create".to_owned(),
            command: Some(Command::Create { geometry: document.geometry }),
            project: text.clone(),
        };
        history::prepare(&begun.project.root, 0, &step)?;
        storage::replace(&path, text.as_bytes())?;
        history::complete(&begun.project.root, 0)?;
        Ok(begun)
    }

    /// The project, to apply commands to before it is seen.
    pub fn project(&mut self) -> &mut Project {
        &mut self.project
    }

    /// Gives the project its name.
    ///
    /// # Errors
    /// Something has come to be there in the meantime, or the folder cannot be renamed.
    pub fn publish(mut self) -> Result<Project, ProjectError> {
        if self.destination.exists() {
            return Err(ProjectError::Exists { path: self.destination.clone() });
        }
        storage::remove(&self.project.root.join("creating"));
        // What an import that was killed had written to a project of this name.
        storage::remove(&self.project.root.join(IMPORTING));
        storage::rename(&self.project.root, &self.destination)?;
        self.published = true;
        Project::open(&self.destination)
    }
}

impl Drop for NewProject {
    fn drop(&mut self) {
        if !self.published {
            storage::remove(&self.project.root);
        }
    }
}

#[cfg(test)]
mod tests;
