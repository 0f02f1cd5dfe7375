//! The commands of a project, each with the state it led to: undo and redo move along them.
//!
//! `history/0007.toml` holds command 7 and the text of `project.toml` after it. Undo writes the text of step 6 back,
//! redo that of step 8, so both restore it byte for byte, from any process. Data files that a state of the history
//! refers to stay where they are until the last such state is dropped: by a command given after an undo, by the limit
//! on the length, or by [`super::Project::prune`].
//!
//! A step waits in `unfinished/` while `project.toml` is replaced and is moved to its place afterwards; a writer that
//! finds one there can tell from `project.toml` whether the command was completed ([`recover`]). A step that is to be
//! dropped is moved there, too, and is deleted after the data that only it refers to, so that a kill in between leaves
//! nothing behind.
//!
//! A step that can no longer be read is reported as such, but does not stop work. Whatever it may refer to is kept.

use super::storage;
use crate::document::{Document, data_file};
use crate::error::ProjectError;
use serde::{Deserialize, Serialize};
use std::collections::BTreeSet;
use std::fs;
use std::io::ErrorKind;
use std::path::Path;
use system::file::{self, FileAction};

/// Number of steps in the history; the oldest are dropped first. Long enough for a day's work, short enough that
/// removed volumes do not fill the disk for ever.
pub(crate) const HISTORY_LIMIT: u32 = 200;

/// One step of the history.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub struct Step {
    /// The effect, in a few words.
    pub summary: String,
    /// The text of `project.toml` after it.
    pub project: String,
    /// The command as data; `None` for an edit by hand.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub command: Option<toml::Value>,
}

/// The path of a step, relative to the project.
pub(crate) fn file_of(number: u32) -> String {
    format!("history/{number:04}.toml")
}

/// The path of a step that waits to be dropped, relative to the project.
fn forgotten_file_of(number: u32) -> String {
    format!("{}/forgotten/{number:04}.toml", storage::UNFINISHED)
}

/// The numbers of the steps in a folder, ascending. A folder that cannot be read is an error, and not one without steps:
/// what no step names is deleted.
fn numbers_in(folder: &Path) -> Result<Vec<u32>, ProjectError> {
    let number = |name: &String| name.strip_suffix(".toml")?.parse().ok();
    let names = storage::list(folder).map_err(|source| ProjectError::io(FileAction::Read, folder, source))?;
    let mut numbers: Vec<u32> = names.iter().filter_map(number).collect();
    numbers.sort_unstable();
    Ok(numbers)
}

/// The numbers of the steps in the history, ascending.
///
/// # Errors
/// It cannot be read.
pub(crate) fn numbers(root: &Path) -> Result<Vec<u32>, ProjectError> {
    numbers_in(&root.join("history"))
}

/// Reads step `number`; `None` if it is not in the history.
pub(crate) fn read(root: &Path, number: u32) -> Result<Option<Step>, ProjectError> {
    let path = root.join(file_of(number));
    match fs::symlink_metadata(&path) {
        Err(error) if error.kind() == ErrorKind::NotFound => Ok(None),
        _ => read_step(&path).map(Some),
    }
}

fn read_step(path: &Path) -> Result<Step, ProjectError> {
    toml::from_str(&storage::read_text(path)?)
        .map_err(|error| ProjectError::Malformed { path: path.to_owned(), detail: error.to_string() })
}

/// Writes step `number` so that [`complete`] or [`recover`] can finish it, also after a power cut: it is on the disk
/// before any data that it names.
pub(crate) fn prepare(root: &Path, number: u32, step: &Step) -> Result<(), ProjectError> {
    let text = toml::to_string_pretty(step)
        .map_err(|error| ProjectError::Malformed { path: root.join(file_of(number)), detail: error.to_string() })?;
    storage::leave_unfinished(root, &file_of(number), text.as_bytes())
}

/// Writes a step that is missing in the history; no other step changes.
pub(crate) fn record(root: &Path, number: u32, step: &Step) -> Result<(), ProjectError> {
    prepare(root, number, step)?;
    storage::rename(&storage::unfinished(root, &file_of(number)), &root.join(file_of(number)))?;
    storage::remove(root, storage::UNFINISHED);
    Ok(())
}

/// Makes a prepared step the last one: steps that were undone before it are dropped, and so are steps beyond the limit,
/// with their data.
pub(crate) fn complete(root: &Path, number: u32) -> Result<(), ProjectError> {
    forget(root, number, |old| old >= number || old.saturating_add(HISTORY_LIMIT) <= number)?;
    storage::rename(&storage::unfinished(root, &file_of(number)), &root.join(file_of(number)))?;
    release_forgotten(root)
}

/// Whether a step still waits to take its place, or to be deleted.
pub(crate) fn is_incomplete(root: &Path) -> bool {
    let waits = |folder| numbers_in(&storage::unfinished(root, folder)).map_or(true, |numbers| !numbers.is_empty());
    ["history", "forgotten"].into_iter().any(waits)
}

/// Drops everything but step `number`, and the data that only the dropped steps refer to.
pub(crate) fn forget_all_but(root: &Path, number: u32) -> Result<(), ProjectError> {
    forget(root, number, |old| old != number)?;
    release_forgotten(root)?;
    storage::remove(root, storage::UNFINISHED);
    Ok(())
}

/// Takes steps out of the history; their data stay until [`release_forgotten`]. Those furthest from the `present` step go
/// first, so that undo and redo still lead to all that are left after a kill.
fn forget(root: &Path, present: u32, which: impl Fn(u32) -> bool) -> Result<(), ProjectError> {
    let (before, after): (Vec<u32>, Vec<u32>) = numbers(root)?.into_iter().partition(|&old| old < present);
    for old in before.into_iter().chain(after.into_iter().rev()).filter(|&old| which(old)) {
        storage::rename(&root.join(file_of(old)), &root.join(forgotten_file_of(old)))?;
    }
    Ok(())
}

/// Deletes the dropped steps, after the data that only they refer to.
fn release_forgotten(root: &Path) -> Result<(), ProjectError> {
    for number in numbers_in(&storage::unfinished(root, "forgotten"))? {
        let file = forgotten_file_of(number);
        release(root, files_of(read_step(&root.join(&file)).ok().as_ref()))?;
        storage::remove(root, &file);
    }
    Ok(())
}

/// Cleans up after a writer that did not finish: a completed command gets its step, an incomplete one leaves nothing.
pub(crate) fn recover(root: &Path, project_text: &str) -> Result<(), ProjectError> {
    if !root.join(storage::UNFINISHED).exists() {
        return Ok(());
    }
    for number in numbers_in(&storage::unfinished(root, "history"))? {
        match read_step(&storage::unfinished(root, &file_of(number))) {
            Ok(step) if step.project == project_text => complete(root, number)?,
            Ok(step) => release(root, files_of(Some(&step)))?,
            Err(error) if error.says_nothing() => return Err(error),
            // It was written in part, so nothing of it was published yet.
            Err(_) => {}
        }
    }
    release_forgotten(root)?;
    storage::remove(root, storage::UNFINISHED);
    Ok(())
}

/// Whether the present state or any state of the history contains this text; this is how keys of derived data are
/// looked for.
pub(crate) fn is_named(root: &Path, text: &str) -> bool {
    // States that cannot be listed may name anything.
    let Ok(numbers) = numbers(root) else { return true };
    let states = numbers.into_iter().map(|number| root.join(file_of(number))).chain([root.join(storage::STATE)]);
    // A state that cannot be read may name anything.
    states
        .map(|state| file::read(&state, file::MAX_DOCUMENT_BYTES))
        .any(|bytes| bytes.map_or(true, |bytes| String::from_utf8_lossy(&bytes).contains(text)))
}

/// Data files of a step's state.
fn files_of(step: Option<&Step>) -> BTreeSet<String> {
    let document = step.and_then(|step| Document::from_text(&step.project, Path::new(storage::STATE)).ok());
    document.iter().flat_map(|document| document.files().map(str::to_owned)).collect()
}

/// Deletes those of `files` that neither the present state nor any state of the history refers to. What is not
/// `KIND/NAME` is no data of a project and stays. While the present state cannot be read, everything stays.
pub(crate) fn release(root: &Path, mut files: BTreeSet<String>) -> Result<(), ProjectError> {
    files.retain(|file| data_file::is_any_data_file(file));
    if files.is_empty() {
        return Ok(());
    }
    let path = root.join(storage::STATE);
    let present = Document::from_text(&storage::read_text(&path)?, &path)?;
    let mut kept: BTreeSet<String> = present.files().map(str::to_owned).collect();
    for number in numbers(root)? {
        match read_step(&root.join(file_of(number))) {
            Ok(step) => kept.append(&mut files_of(Some(&step))),
            Err(_) => keep_what_is_named_in(&root.join(file_of(number)), &mut files),
        }
    }
    files.difference(&kept).for_each(|file| storage::remove(root, file));
    Ok(())
}

/// Removes from `files` what a damaged step may still refer to: everything it names, or everything if it cannot be read
/// at all.
fn keep_what_is_named_in(step: &Path, files: &mut BTreeSet<String>) {
    match file::read(step, file::MAX_DOCUMENT_BYTES) {
        Ok(bytes) => {
            let text = String::from_utf8_lossy(&bytes);
            files.retain(|file| !text.contains(file.as_str()));
        }
        Err(_) => files.clear(),
    }
}
