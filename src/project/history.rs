//! The commands of a project, each with the state it led to: what undo and redo walk along.
//!
//! `history/0007.toml` holds command 7 and the text of `project.toml` after it. Undo writes the text of step 6 back, redo that of
//! step 8, so both restore it byte for byte, from any process. Data files that a remembered state refers to stay where they are until the last
//! such state is forgotten: by a command given after an undo, by the limit on the length, or by [`super::Project::prune`].
//!
//! A step is written as `0007.toml.new` before `project.toml` is replaced and renamed after it; a writer that finds such a file
//! can tell by `project.toml` whether the command was completed ([`recover`]).

use super::document::Document;
use super::storage;
use crate::command::Command;
use crate::error::ProjectError;
use serde::{Deserialize, Serialize};
use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

/// Remembered steps; the oldest are forgotten first. Long enough for a day's work, short enough that removed volumes do not fill the disk for ever.
pub const HISTORY_LIMIT: u32 = 200;

/// One remembered command.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub struct Step {
    /// What happened, in a few words.
    pub summary: String,
    /// The text of `project.toml` after it.
    pub project: String,
    /// The command; absent for an edit by hand.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub command: Option<Command>,
}

fn folder(root: &Path) -> PathBuf {
    root.join("history")
}

fn path_of(root: &Path, number: u32) -> PathBuf {
    folder(root).join(format!("{number:04}.toml"))
}

/// Numbers of the remembered steps, ascending.
pub(crate) fn numbers(root: &Path) -> Vec<u32> {
    let number = |path: &PathBuf| path.file_name()?.to_str()?.strip_suffix(".toml")?.parse().ok();
    let mut numbers: Vec<u32> = storage::entries(&folder(root)).iter().filter_map(number).collect();
    numbers.sort_unstable();
    numbers
}

/// Reads step `number`; `None` when it is not remembered.
pub(crate) fn read(root: &Path, number: u32) -> Result<Option<Step>, ProjectError> {
    let path = path_of(root, number);
    if path.exists() { read_step(&path).map(Some) } else { Ok(None) }
}

fn read_step(path: &Path) -> Result<Step, ProjectError> {
    toml::from_str(&storage::read_text(path)?)
        .map_err(|error| ProjectError::Malformed { path: path.to_owned(), detail: error.to_string() })
}

/// Writes step `number` so that [`complete`] or [`recover`] can finish it.
pub(crate) fn prepare(root: &Path, number: u32, step: &Step) -> Result<(), ProjectError> {
    let path = path_of(root, number);
    let text = toml::to_string_pretty(step)
        .map_err(|error| ProjectError::Malformed { path: path.clone(), detail: error.to_string() })?;
    storage::write_durably(&storage::new_beside(&path), text.as_bytes())
}

/// Takes back [`prepare`].
pub(crate) fn abandon(root: &Path, number: u32) {
    storage::remove(&storage::new_beside(&path_of(root, number)));
}

/// Makes a prepared step the last one: what was undone before it is forgotten, and so are steps beyond the limit, with their data.
pub(crate) fn complete(root: &Path, number: u32) -> Result<(), ProjectError> {
    let forgotten: Vec<u32> =
        numbers(root).into_iter().filter(|&n| n >= number || n + HISTORY_LIMIT <= number).collect();
    let mut released = BTreeSet::new();
    for &old in &forgotten {
        released.extend(files_of(read(root, old)?));
        storage::remove(&path_of(root, old));
    }
    let path = path_of(root, number);
    storage::rename(&storage::new_beside(&path), &path)?;
    release(root, released)
}

/// Forgets everything but step `number`, and the data only that kept.
pub(crate) fn forget_all_but(root: &Path, number: u32) -> Result<(), ProjectError> {
    let mut released = BTreeSet::new();
    for old in numbers(root).into_iter().filter(|&n| n != number) {
        released.extend(files_of(read(root, old)?));
        storage::remove(&path_of(root, old));
    }
    release(root, released)
}

/// Cleans up after a writer that did not come to its end: a completed command gets its step, an incomplete one leaves nothing.
pub(crate) fn recover(root: &Path, project_text: &str) -> Result<(), ProjectError> {
    let is_new = |path: &PathBuf| path.extension().is_some_and(|extension| extension == storage::NEW);
    for path in storage::entries(&folder(root)).into_iter().filter(is_new) {
        let number = path.file_stem().and_then(|stem| stem.to_str()?.strip_suffix(".toml")?.parse().ok());
        match (number, read_step(&path)) {
            (Some(number), Ok(step)) if step.project == project_text => complete(root, number)?,
            (_, Ok(step)) => {
                storage::remove(&path);
                release(root, files_of(Some(step)))?;
            }
            // Written in part: no state was to be reached yet.
            (_, Err(_)) => storage::remove(&path),
        }
    }
    for folder in ["", "volumes", "horizons", "faults", "textures"] {
        let folder = root.join(folder);
        store::clean(&folder);
        storage::entries(&folder).iter().filter(|path| is_new(path)).for_each(|path| storage::remove(path));
    }
    Ok(())
}

/// Data files of a step's state.
fn files_of(step: Option<Step>) -> BTreeSet<String> {
    let document = step.and_then(|step| Document::from_text(&step.project, Path::new("project.toml")).ok());
    document.iter().flat_map(|document| document.files().map(str::to_owned)).collect()
}

/// Removes those of `files` that neither the present nor any remembered state refers to.
fn release(root: &Path, mut files: BTreeSet<String>) -> Result<(), ProjectError> {
    if files.is_empty() {
        return Ok(());
    }
    let path = root.join("project.toml");
    let present = Document::from_text(&storage::read_text(&path)?, &path)?;
    for file in present.files() {
        files.remove(file);
    }
    for number in numbers(root) {
        for file in files_of(read(root, number)?) {
            files.remove(&file);
        }
    }
    files.iter().for_each(|file| storage::remove(&root.join(file)));
    Ok(())
}
