//! Everything that a repair writes. It holds the project's lock, and it deletes only through the two functions of
//! `folder` that the whole program deletes with.

use super::examine;
use super::leftovers::size_of;
use super::report::{CheckReport, Cure, Damage, Leftover, LeftoverKind, Part, Repair};
use super::states::{DAMAGED, DAMAGED_STATE, States, Trouble};
use crate::document::data_file;
use crate::error::ProjectError;
use crate::folder::{Lock, Step, acquaintance, forget_creation, history, storage};
use std::fs;
use std::io::ErrorKind;
use std::path::Path;
use std::time::Duration;
use survey::Progress;
use system::file::FileAction;

/// Checks the project in the folder `root` and repairs what can be repaired. Waits for so long while another process
/// is changing the project.
///
/// # Errors
/// There is no project, a part of it is a link, another process holds it, it cannot be written, or the user cancelled:
/// then nothing was changed, or everything up to the failure.
pub fn repair(root: &Path, wait: Duration, progress: &Progress) -> Result<CheckReport, ProjectError> {
    // Says that there is no project before a lock is made in a folder that is none.
    let before = States::read(root)?;
    storage::refuse_links(root)?;
    let lock = Lock::take(root, wait, progress)?;
    forget_creation(root);
    let mut repairs = Vec::new();
    if before.present().is_some() {
        // A command that was killed after its state was saved still gets its step.
        let bytes = size_of(&root.join(storage::UNFINISHED));
        let was_there = root.join(storage::UNFINISHED).exists();
        history::recover(root, &storage::read_text(&root.join(storage::STATE))?)?;
        if was_there {
            repairs.push(Repair::Removed { file: storage::UNFINISHED.to_owned(), bytes });
        }
    }
    let (mut report, states) = examine(root, Some(&lock), progress)?;
    progress.check()?;
    if states.is_state_unread() {
        // What it names is not known, and nothing is known to be left over.
        report.repairs = repairs;
        return Ok(report);
    }
    mend_state(root, &states, &mut report, &mut repairs)?;
    mend_history(root, &states, &mut report, &mut repairs)?;
    remove_derived(root, &mut report, &mut repairs);
    remove_leftovers(root, &states, &mut report, &mut repairs)?;
    // Succeeds only if nothing is in it.
    let _ = fs::remove_dir(root.join(storage::UNFINISHED));
    report.repairs = repairs;
    acquaintance::note(root);
    Ok(report)
}

/// Restores a damaged `project.toml` from the history, and keeps the damaged one beside it.
fn mend_state(
    root: &Path,
    states: &States,
    report: &mut CheckReport,
    repairs: &mut Vec<Repair>,
) -> Result<(), ProjectError> {
    let Some(number) = states.restorable() else { return Ok(()) };
    let Some(step) = states.step(number) else { return Ok(()) };
    let path = root.join(storage::STATE);
    if fs::symlink_metadata(&path).is_ok() {
        let to = free_name(root, DAMAGED_STATE);
        // A copy, so that there is a project.toml at every moment; what cannot be copied is moved.
        if fs::copy(&path, root.join(&to)).is_err() {
            storage::rename(&path, &root.join(&to))?;
        }
        repairs.push(Repair::Moved { file: storage::STATE.to_owned(), to });
    }
    storage::replace(root, storage::STATE, step.project.as_bytes())?;
    repairs.push(Repair::Restored { step: number });
    report.step = Some(number);
    repaired(report, |damage| damage.part == Part::State);
    Ok(())
}

/// Makes a missing `history/` again, moves damaged steps to `damaged/`, and writes the present state to the history
/// where its own step is missing, so that the next command can be undone.
fn mend_history(
    root: &Path,
    states: &States,
    report: &mut CheckReport,
    repairs: &mut Vec<Repair>,
) -> Result<(), ProjectError> {
    let folder = root.join("history");
    if matches!(fs::symlink_metadata(&folder), Err(error) if error.kind() == ErrorKind::NotFound) {
        fs::create_dir(&folder).map_err(|source| ProjectError::io(FileAction::Written, &folder, source))?;
        repairs.push(Repair::Made { folder: "history".to_owned() });
        repaired(report, |damage| damage.file == "history");
    }
    for unreadable in states.unreadable.iter().filter(|file| file.trouble == Trouble::Damaged) {
        let Some(number) = unreadable.number else { continue };
        let to = free_name(root, &format!("{DAMAGED}/{number:04}.toml"));
        storage::rename(&root.join(&unreadable.file), &root.join(&to))?;
        repairs.push(Repair::Moved { file: unreadable.file.clone(), to });
        repaired(report, |damage| damage.file == unreadable.file);
    }
    let (Some(text), Some(document)) = (states.present_text(), states.present()) else { return Ok(()) };
    let number = document.step;
    let is_there = fs::symlink_metadata(root.join(history::file_of(number))).is_ok();
    if folder.is_dir() && states.step(number).is_none() && !is_there {
        let summary = "recorded again by a repair".to_owned();
        let step = Step { summary, project: text.to_owned(), command: None };
        history::record(root, number, &step)?;
        repairs.push(Repair::Recorded { step: number });
    }
    Ok(())
}

/// Removes damaged derived data.
fn remove_derived(root: &Path, report: &mut CheckReport, repairs: &mut Vec<Repair>) {
    let files: Vec<String> = report.damage.iter().filter(|d| is_derived(d)).map(|d| d.file.clone()).collect();
    for file in files {
        if remove(root, &file, repairs) {
            repaired(report, |damage| damage.file == file);
        }
    }
}

fn is_derived(damage: &Damage) -> bool {
    damage.part == Part::Derived && damage.cures.iter().any(|cure| matches!(cure, Cure::Recompute { .. }))
}

/// Removes what no state names, but for what a damaged step may name.
fn remove_leftovers(
    root: &Path,
    states: &States,
    report: &mut CheckReport,
    repairs: &mut Vec<Repair>,
) -> Result<(), ProjectError> {
    for Leftover { kind, file, bytes } in std::mem::take(&mut report.leftovers) {
        let is_gone = match kind {
            LeftoverKind::Doubtful => false,
            // What the last command was writing may be newer than the step that was restored.
            LeftoverKind::Unfinished if states.present().is_none() && file == storage::UNFINISHED => {
                let to = free_name(root, &format!("{DAMAGED}/{file}"));
                storage::rename(&root.join(&file), &root.join(&to))?;
                repairs.push(Repair::Moved { file: file.clone(), to });
                true
            }
            LeftoverKind::Orphan if data_file::is_any_data_file(&file) => {
                // It asks every state once more.
                history::release(root, [file.clone()].into())?;
                let is_gone = fs::symlink_metadata(root.join(&file)).is_err();
                if is_gone {
                    repairs.push(Repair::Removed { file: file.clone(), bytes });
                }
                is_gone
            }
            _ => remove(root, &file, repairs),
        };
        if !is_gone {
            report.leftovers.push(Leftover { kind, file, bytes });
        }
    }
    Ok(())
}

/// Removes a file or folder that is no data of any state; says whether it is gone.
fn remove(root: &Path, file: &str, repairs: &mut Vec<Repair>) -> bool {
    let bytes = size_of(&root.join(file));
    storage::remove(root, file);
    let is_gone = fs::symlink_metadata(root.join(file)).is_err();
    // Of several things in one folder the first may have taken the others along.
    if is_gone {
        repairs.push(Repair::Removed { file: file.to_owned(), bytes });
    }
    is_gone
}

fn repaired(report: &mut CheckReport, which: impl Fn(&Damage) -> bool) {
    report.damage.iter_mut().filter(|damage| which(damage)).for_each(|damage| damage.repaired = true);
}

/// The name, with a number where it is taken.
fn free_name(root: &Path, name: &str) -> String {
    let is_taken = |name: &String| fs::symlink_metadata(root.join(name)).is_ok();
    let numbered = (2..).map(|number| format!("{name}-{number}"));
    std::iter::once(name.to_owned()).chain(numbered).find(|name| !is_taken(name)).unwrap_or_else(|| name.to_owned())
}
