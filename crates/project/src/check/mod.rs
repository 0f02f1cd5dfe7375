//! Checks a project on disk, whatever has become of it, and repairs what can be repaired without losing anything.
//!
//! [`check`] reads the state and every step of the history, every data file that one of them names, and what is
//! derived. It compares recorded hashes and verifies checksums, and says what is damaged and what depends on it. What
//! cannot be read now is told apart from that. Where nothing that the present state needs is damaged, it makes sure that the
//! state can be drawn. It writes nothing, so it also works on a project that is read-only, that belongs to someone else, or
//! whose `project.toml` cannot be read.
//!
//! [`repair`] holds the project's lock meanwhile. It removes leftovers, data files that no state names and damaged
//! derived data, moves damaged steps to `damaged/`, and restores a damaged `project.toml` from the history. Data that a
//! readable state names are never deleted, damaged or not.
//!
//! | file | holds |
//! |---|---|
//! | `report` | what was found, and what can be done about it |
//! | `states` | the state and the steps, as far as they can be read |
//! | `objects` | the data files that they name |
//! | `verify` | whether one data file is what was written |
//! | `dependants` | what is made of a data file |
//! | `derived_data` | derived data |
//! | `leftovers` | what no state names |
//! | `repair` | everything that writes |
//! | `acquaint` | a project that is not known here, before it is changed |
//!
//! Before a project that is not known here is changed, `acquaint` does the quick part of a check.
//!
//! Deliberately absent: [`crate::Project`], which opens only what is whole.

pub(crate) mod acquaint;
mod dependants;
mod derived_data;
mod leftovers;
mod objects;
mod repair;
mod report;
mod states;
#[cfg(all(test, unix))]
mod tests;
mod verify;

pub use repair::repair;
pub use report::{CheckReport, Cure, Damage, Leftover, LeftoverKind, Outcome, Part, Repair, Unread};

use crate::document::Document;
use crate::error::ProjectError;
use crate::facts::Facts;
use crate::folder::{Lock, acquaintance, storage};
use crate::interpretation::drawable;
use crate::pictures::shown;
use objects::Object;
use states::States;
use std::path::Path;
use survey::Progress;
use ttf::TextureLibrary;
use verify::Finding;

/// Checks the project in the folder `root`; nothing is written.
///
/// ```
/// use project::check::check;
/// use project::Project;
/// use survey::{Progress, SurveyGeometry, VerticalUnit};
///
/// let folder = tempfile::tempdir()?;
/// let root = folder.path().join("north.petro");
/// let geometry = SurveyGeometry::regular([11, 11, 51], 25.0, 4.0, VerticalUnit::Milliseconds);
/// Project::create(&root, Some(geometry))?.publish()?;
/// assert!(check(&root, &Progress::silent())?.is_well());
///
/// std::fs::write(root.join("project.toml"), "damaged")?;
/// let report = check(&root, &Progress::silent())?;
/// assert_eq!(report.damage[0].file, "project.toml");
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// There is no project, it was written by a newer version, or the user cancelled. Damage is no error.
pub fn check(root: &Path, progress: &Progress) -> Result<CheckReport, ProjectError> {
    let (report, _) = examine(root, None, progress)?;
    // Whoever has read the report knows what the project is like.
    acquaintance::note(root);
    Ok(report)
}

/// The report, and the states it is based on; `lock` is that of the project, if it is held.
fn examine(root: &Path, lock: Option<&Lock>, progress: &Progress) -> Result<(CheckReport, States), ProjectError> {
    let states = States::read(root)?;
    let mut report = CheckReport {
        project: root.to_owned(),
        step: states.present().map(|document| document.step),
        steps: states.numbers().collect(),
        ..CheckReport::default()
    };
    states::report(&states, &mut report);
    if let Some(document) = states.present() {
        let patterns = TextureLibrary::builtin()?;
        report.notes.extend(document.dangling(|name| patterns.find(name).is_some()));
    }
    let objects = objects::of(&states);
    for object in &objects {
        progress.begin(&format!("checking {}", object.entry.file()), 1);
        match verify::verify(root, object, progress)? {
            Ok(()) => {}
            Err(Finding::Damaged(reason)) => report.damage.push(damage(object, reason, &states)),
            Err(Finding::Unread(reason)) => {
                let what = format!("{} \"{}\"", object.entry.noun(), object.entry.name());
                report.unread.push(Unread { file: object.entry.file().to_owned(), what, reason });
            }
        }
    }
    report.data_files = objects.len();
    // Of damaged data nothing can be drawn, and that is told.
    if let Some(document) = states.present().filter(|_| report.damage.iter().all(|damage| !damage.is_present)) {
        let facts = Facts::of(root, document);
        match drawable::check(facts, progress) {
            Ok(notes) => report.notes.extend(notes.iter().map(ToString::to_string)),
            Err(error @ ProjectError::Cancelled(_)) => return Err(error),
            Err(ProjectError::Model(error)) => report.undrawable.push(error.to_string()),
            // What is damaged is told elsewhere.
            Err(_) => {}
        }
        report.undrawable.extend(shown::refusals(facts));
    }
    derived_data::check(root, &states, &mut report, progress)?;
    leftovers::find(root, &states, lock, &mut report);
    find_links(root, &mut report);
    if states.has_changed(root) {
        report.notes.push("the project was changed while it was checked: check it again".to_owned());
    }
    Ok((report, states))
}

/// What is said of a damaged data file.
fn damage(object: &Object, reason: String, states: &States) -> Damage {
    Damage {
        part: Part::Data,
        file: object.entry.file().to_owned(),
        what: format!("{} \"{}\"", object.entry.noun(), object.entry.name()),
        reason,
        dependants: dependants::of(object.document, &object.entry),
        is_present: object.is_present,
        steps: object.steps.clone(),
        cures: cures(object, states),
        repaired: false,
    }
}

/// What can be done about a damaged data file.
fn cures(object: &Object, states: &States) -> Vec<Cure> {
    let restored = || states.restorable().and_then(|number| states.document(number));
    let newest = || newest(states).filter(|_| states.is_state_unread());
    let Some(base) = states.present().or_else(restored).or_else(newest) else { return vec![Cure::Backup] };
    let will_be_present = states.present().is_none() && object.steps.contains(&base.step);
    if !object.is_present && !will_be_present {
        return vec![Cure::Prune];
    }
    let undo = states.undo_without(base, &object.steps);
    let undo = undo.map(|step| Cure::Undo { step, times: base.step - step });
    undo.into_iter().chain([object.entry.way_back()]).collect()
}

/// Reports a link anywhere in the project that was not reported yet: no command writes while there is one.
fn find_links(root: &Path, report: &mut CheckReport) {
    let relative = |path: &Path| path.strip_prefix(root).unwrap_or(path).to_string_lossy().into_owned();
    let what = "a file or folder of the project".to_owned();
    let path = match storage::refuse_links(root) {
        Ok(()) => return,
        Err(ProjectError::Link { path }) => path,
        Err(ProjectError::Io { path, source, .. }) => {
            let file = relative(&path);
            if !report.unread.iter().any(|unread| file.starts_with(&unread.file)) {
                report.unread.push(Unread { file, what, reason: format!("it cannot be read: {source}") });
            }
            return;
        }
        Err(error) => return report.unread.push(Unread { file: String::new(), what, reason: error.to_string() }),
    };
    let (file, reason) = (relative(&path), "it is a link");
    if !report.damage.iter().any(|damage| !damage.file.is_empty() && file.starts_with(&damage.file)) {
        report.damage.push(Damage {
            part: Part::Folder,
            what,
            cures: vec![Cure::ReplaceLink],
            ..Damage::of(file, reason)
        });
    }
}

/// The present document, else that of the newest step: what is derived belongs to it.
fn newest(states: &States) -> Option<&Document> {
    states.present().or_else(|| states.documents().last().map(|(_, document)| document))
}
