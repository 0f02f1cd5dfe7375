//! A project: a folder `NAME.petro` with what was imported and interpreted, how it is drawn, and the history of both.
//!
//! ```text
//! project.toml        the state (see [`project::document`]); replaced as a whole, never changed in place
//! history/NNNN.toml   each command with the state it led to (see [`project::folder`])
//! volumes/ horizons/ faults/ wells/ textures/   data, one new file or folder for each generation
//! derived/            what was computed; may be deleted
//! unfinished/         what a command under way is writing; removed by the next writer after a crash
//! importing/          an import that was killed, to go on with
//! damaged/            steps that a repair has set aside (see [`project::check`])
//! lock                held while a command runs
//! ```
//!
//! [`Project::apply`] is the only way to change a project. It takes the lock, reads the state again if another process
//! has changed it, lets the [`Command`] write new data and a new state, and then replaces `project.toml` by a rename.
//! Before that moment the old state is valid, after it the new one. If anything fails, what was written is removed. A
//! project may come from a stranger: before anything is read, no part of it may be a link, and every data file that a
//! state names must be `KIND/NAME`; one that was never used here is looked through before it is changed.
//!
//! Deliberately absent: no state is kept in memory that is not on disk, and nothing that is saved is edited
//! in place.

use crate::check::acquaint::refuse_unless_sound;
use crate::command::{Command, Effect};
use crate::derived;
use crate::document::{Document, data_file};
use crate::error::ProjectError;
use crate::facts::Facts;
use crate::folder::{
    self, CREATING, Draft, IMPORTING, Lock, Step, acquaintance, forget_creation, history, state, storage,
};
use crate::interpretation::drawable::refuse_undrawable;
use crate::interpretation::{extraction, proposals};
use std::fs;
use std::path::{Path, PathBuf};
use std::time::Duration;
use survey::{Progress, SurveyGeometry};
use system::file::FileAction;
use system::file::{create_folders, sync_folder};

/// An open project. It is changed by [`Command`]s, each of which can be undone.
///
/// ```
/// use project::command::SetVelocity;
/// use project::{Command, Project};
/// use survey::{Progress, SurveyGeometry, VerticalUnit};
///
/// let folder = tempfile::tempdir()?;
/// let geometry = SurveyGeometry::regular([11, 11, 51], 25.0, 4.0, VerticalUnit::Milliseconds);
/// let mut project = Project::create(&folder.path().join("north.petro"), Some(geometry))?.publish()?;
/// let command = Command::SetVelocity(SetVelocity { velocity_m_s: 2500.0 });
/// project.apply(&command, &Progress::silent())?;
///
/// let velocity = |project: &Project| project.document().geometry.as_ref().map(|geometry| geometry.velocity_m_s);
/// let mut again = Project::open(project.root())?;
/// assert_eq!(velocity(&again), Some(2500.0));
/// again.undo()?;
/// assert_eq!(velocity(&again), Some(2000.0));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug)]
pub struct Project {
    root: PathBuf,
    text: String,
    document: Document,
    wait: Duration,
}

/// A line of the history.
#[derive(Debug, Clone, PartialEq, Eq, serde::Serialize)]
pub struct HistoryLine {
    /// Number of the step.
    pub step: u32,
    /// What the command did.
    pub summary: String,
    /// Whether it is in effect (false: undone, can be redone).
    pub in_effect: bool,
}

impl Project {
    /// Opens the project in the folder `root`.
    ///
    /// # Errors
    /// The project is missing, is not a project, contains a link, was written by a newer version, or cannot be read.
    pub fn open(root: &Path) -> Result<Self, ProjectError> {
        let (text, document) = state::read(root)?;
        Ok(Self { root: root.to_owned(), text, document, wait: Duration::ZERO })
    }

    /// Starts a new project that will be at `root`; nothing is there before [`NewProject::publish`].
    ///
    /// # Errors
    /// Something exists at `root`, or its parent folder cannot be written.
    pub fn create(root: &Path, geometry: Option<SurveyGeometry>) -> Result<NewProject, ProjectError> {
        NewProject::begin(root, geometry)
    }

    /// What follows from the present state.
    pub fn facts(&self) -> Facts<'_> {
        Facts::of(&self.root, &self.document)
    }

    /// The same, but that changes wait for so long while another process is changing it, and are refused then. Without
    /// this they are refused at once.
    pub fn waiting(self, wait: Duration) -> Self {
        Self { wait, ..self }
    }

    /// The folder.
    pub fn root(&self) -> &Path {
        &self.root
    }

    /// What it is called: the name of its folder, without the ending.
    pub fn title(&self) -> String {
        let stem = self.root.file_stem().map(|stem| stem.to_string_lossy().into_owned());
        stem.unwrap_or_else(|| "Petroglyph".to_owned())
    }

    /// The state.
    pub fn document(&self) -> &Document {
        &self.document
    }

    /// Carries out a command and saves the project. One after which the project could not be drawn is refused, unless it
    /// could not be drawn before either.
    ///
    /// # Errors
    /// The reason why the command could not be carried out. The project is then as it was before, on disk and in
    /// memory.
    pub fn apply(&mut self, command: &Command, progress: &Progress) -> Result<Effect, ProjectError> {
        let computed = command.prepare(&self.root, &self.document, progress)?;
        let _lock = self.lock(progress)?;
        let mut draft = Draft::new(&self.root, self.document.clone());
        let effect = command.execute(&mut draft, progress)?.after_computing(computed);
        progress.check()?;
        refuse_undrawable(Facts::of(&self.root, &self.document), draft.facts(), progress)?;
        if effect.is_nothing_new() && draft.document == self.document {
            return Ok(effect);
        }
        self.commit(draft, effect.summary(), Some(command))?;
        Ok(effect)
    }

    /// Undoes the last command; returns what was undone.
    ///
    /// # Errors
    /// [`ProjectError::NothingToUndo`] at the beginning of the remembered history.
    pub fn undo(&mut self) -> Result<String, ProjectError> {
        let _lock = self.lock(&Progress::silent())?;
        let step = self.document.step;
        let undone = history::read(&self.root, step)?.ok_or(ProjectError::NothingToUndo)?;
        let before = step.checked_sub(1).map(|number| history::read(&self.root, number)).transpose()?.flatten();
        self.restore(before.ok_or(ProjectError::NothingToUndo)?)?;
        Ok(undone.summary)
    }

    /// Redoes the command that was undone last; returns what was redone.
    ///
    /// # Errors
    /// [`ProjectError::NothingToRedo`] when nothing was undone.
    pub fn redo(&mut self) -> Result<String, ProjectError> {
        let _lock = self.lock(&Progress::silent())?;
        let after =
            history::read(&self.root, self.document.step.saturating_add(1))?.ok_or(ProjectError::NothingToRedo)?;
        let summary = after.summary.clone();
        self.restore(after)?;
        Ok(summary)
    }

    /// Deletes the history and the data that only it refers to.
    ///
    /// # Errors
    /// The lock is taken or the folder cannot be read.
    pub fn prune(&mut self) -> Result<(), ProjectError> {
        let _lock = self.lock(&Progress::silent())?;
        history::forget_all_but(&self.root, self.document.step)?;
        derived::remove_resumable(&self.root);
        self.settle_derived();
        Ok(())
    }

    /// The steps of the history, oldest first; a step that cannot be read says so.
    pub fn history(&self) -> Vec<HistoryLine> {
        let mut lines = Vec::new();
        for step in history::numbers(&self.root).unwrap_or_default() {
            let summary = match history::read(&self.root, step) {
                Ok(Some(step)) => step.summary,
                Ok(None) => continue,
                Err(_) => "cannot be read any more; undo and redo stop here".to_owned(),
            };
            lines.push(HistoryLine { step, summary, in_effect: step <= self.document.step });
        }
        lines
    }

    fn lock(&mut self, progress: &Progress) -> Result<Lock, ProjectError> {
        storage::refuse_links(&self.root)?;
        let lock = Lock::take(&self.root, self.wait, progress)?;
        refuse_unless_sound(&self.root)?;
        forget_creation(&self.root);
        let path = self.root.join(storage::STATE);
        let text = storage::read_text(&path)?;
        history::recover(&self.root, &text)?;
        derived::remove_leftovers(&self.root);
        if text != self.text {
            self.document = Document::from_text(&text, &path)?;
            self.text = text;
        }
        self.adopt_edit()?;
        Ok(lock)
    }

    /// Makes an edit of `project.toml` by hand a step of its own, so that undoing a later command does not lose it.
    fn adopt_edit(&mut self) -> Result<(), ProjectError> {
        // A step that cannot be read does not show whether there was an edit.
        let known = history::read(&self.root, self.document.step).ok().flatten();
        if known.is_none_or(|step| step.project == self.text) {
            return Ok(());
        }
        let draft = Draft::new(&self.root, self.document.clone());
        self.commit(draft, "edited by hand".to_owned(), None)
    }

    fn commit(&mut self, mut draft: Draft, summary: String, command: Option<&Command>) -> Result<(), ProjectError> {
        let path = self.root.join(storage::STATE);
        let number = self.document.step + 1;
        draft.document.step = number;
        let text = draft.document.to_text_after(&self.text, &path)?;
        // A state that could not be read back must never be saved.
        let document = Document::from_text(&text, &path)?;
        let step = Step { summary, command: command.map(recorded).transpose()?, project: text.clone() };
        history::prepare(&self.root, number, &step)?;
        draft.publish()?;
        let saved = is_in_place(storage::replace(&self.root, storage::STATE, text.as_bytes()))?;
        self.text = text;
        self.document = document;
        // The new state is saved; if cleaning up fails, the next writer does it.
        let completed = is_in_place(history::complete(&self.root, number)).unwrap_or(Ok(()));
        draft.keep();
        self.settle_derived();
        saved.and(completed)
    }

    /// Moves the extraction that the state names to its place, and removes what no state of the history names.
    fn settle_derived(&self) {
        extraction::make_present(&self.root, &self.document);
        extraction::forget_unnamed(&self.root);
        proposals::forget_unnamed(&self.root);
    }

    fn restore(&mut self, step: Step) -> Result<(), ProjectError> {
        let path = self.root.join(storage::STATE);
        let document = Document::from_text(&step.project, &path)?;
        let saved = is_in_place(storage::replace(&self.root, storage::STATE, step.project.as_bytes()))?;
        storage::remove(&self.root, storage::UNFINISHED);
        self.document = document;
        self.text = step.project;
        self.settle_derived();
        saved
    }
}

/// Takes apart whether a file has its new content, and whether the disk has confirmed that: the work that follows is
/// finished in either case, so that state and history agree.
fn is_in_place(replaced: Result<(), ProjectError>) -> Result<Result<(), ProjectError>, ProjectError> {
    match replaced {
        Err(error @ ProjectError::NotFlushed { .. }) => Ok(Err(error)),
        replaced => replaced.map(Ok),
    }
}

/// A command in the form that the history keeps.
fn recorded(command: &Command) -> Result<toml::Value, ProjectError> {
    toml::Value::try_from(command)
        .map_err(|error| ProjectError::Malformed { path: PathBuf::from("history"), detail: error.to_string() })
}

/// The folder in which the project for `destination` is created: `.NAME.new` beside it.
fn in_the_making(destination: &Path) -> Result<PathBuf, ProjectError> {
    let name = destination.file_name().ok_or(ProjectError::NotFound { path: destination.to_owned() })?;
    let mut hidden = std::ffi::OsString::from(".");
    hidden.push(name);
    hidden.push(".new");
    Ok(destination.with_file_name(hidden))
}

/// A project that is being created, in a hidden folder beside its destination. If it is dropped without
/// [`NewProject::publish`], nothing remains.
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
        folder::refuse_inside_project(destination)?;
        let root = in_the_making(destination)?;
        let fail = |source| ProjectError::io(FileAction::Written, destination, source);
        let is_ours = root.join(CREATING).exists() || storage::names_in(&root).is_empty();
        if root.exists() && !is_ours {
            return Err(ProjectError::Exists { path: root });
        }
        create_folders(&root).map_err(fail)?;
        storage::refuse_links(&root)?;
        // Two processes may want to create the same project. The folder is locked under another name than the one that
        // the project's own commands use. Nothing is on the disk before the file that shows whose folder it is.
        let lock = Lock::take_named(&root, CREATING)?;
        sync_folder(&root).map_err(fail)?;
        let path = root.join(storage::STATE);
        let document = Document::empty(geometry);
        let text = document.to_text(&path)?;
        // From here on, any failure removes the folder.
        let begun = Self {
            project: Project { root, text: text.clone(), document: document.clone(), wait: Duration::ZERO },
            destination: destination.to_owned(),
            published: false,
            _lock: lock,
        };
        let root = &begun.project.root;
        // A creation that was killed left this behind; what it had imported is kept, so that the import can continue.
        for leftover in [storage::UNFINISHED, storage::DERIVED] {
            storage::remove(root, leftover);
        }
        for folder in ["history"].iter().chain(&data_file::KINDS) {
            storage::remove(root, folder);
            fs::create_dir(root.join(folder)).map_err(fail)?;
        }
        let step = Step {
            summary: "create".to_owned(),
            command: Some(recorded(&Command::Create { geometry: document.geometry })?),
            project: text.clone(),
        };
        history::prepare(root, 0, &step)?;
        storage::replace(root, storage::STATE, text.as_bytes())?;
        history::complete(root, 0)?;
        storage::remove(root, storage::UNFINISHED);
        Ok(begun)
    }

    /// The project, to which commands can be applied before it is visible.
    pub fn project(&mut self) -> &mut Project {
        &mut self.project
    }

    /// The same to look at.
    pub(crate) fn as_project(&self) -> &Project {
        &self.project
    }

    /// Moves the project to its destination.
    ///
    /// # Errors
    /// Something has appeared there in the meantime, or the folder cannot be renamed.
    pub fn publish(mut self) -> Result<Project, ProjectError> {
        if self.destination.exists() {
            return Err(ProjectError::Exists { path: self.destination.clone() });
        }
        // What a killed import had written for a project of this name.
        storage::remove(&self.project.root, IMPORTING);
        // The mark goes after the name was given: without it nobody would know whose folder it is after a kill.
        let named = is_in_place(storage::rename(&self.project.root, &self.destination))?;
        self.published = true;
        storage::remove(&self.destination, CREATING);
        acquaintance::note(&self.destination);
        named.and_then(|()| Project::open(&self.destination))
    }
}

impl Drop for NewProject {
    fn drop(&mut self) {
        if !self.published {
            // A folder that cannot be removed is recognised by its marker when a project of this name is created again.
            let _ = fs::remove_dir_all(&self.project.root);
        }
    }
}

#[cfg(test)]
mod tests;
