//! What lies in a project and is named by no state: leftovers of programs that were killed, and orphaned data.

use super::report::{CheckReport, Leftover, LeftoverKind};
use super::states::States;
use crate::derived;
use crate::document::data_file::{KINDS, is_any_data_file};
use crate::folder::{IMPORTING, Lock, history, storage};
use std::collections::BTreeSet;
use std::fs::{self, File};
use std::path::Path;

/// Lists everything that no state names. What another process is writing at the moment is not listed; whoever holds the
/// `lock` knows that there is none.
pub(super) fn find(root: &Path, states: &States, lock: Option<&Lock>, report: &mut CheckReport) {
    if lock.is_none() && is_held(root) {
        report.notes.push("another process is changing the project: what it is writing is not listed".to_owned());
    } else {
        for (folder, kind) in [(storage::UNFINISHED, LeftoverKind::Unfinished), (IMPORTING, LeftoverKind::Import)] {
            if !storage::names_in(&root.join(folder)).is_empty() {
                add(root, folder.to_owned(), kind, report);
            }
        }
    }
    find_in_derived(root, states, report);
    let named: BTreeSet<&str> = states
        .present()
        .into_iter()
        .chain(states.documents().map(|(_, document)| document))
        .flat_map(|d| d.files())
        .collect();
    let is_state_known = states.present().is_some();
    for kind in KINDS {
        for name in storage::names_in(&root.join(kind)) {
            let file = format!("{kind}/{name}");
            if named.contains(file.as_str()) {
                continue;
            }
            let is_doubtful = is_any_data_file(&file) && (!is_state_known || states.may_be_named(&file));
            add(root, file, if is_doubtful { LeftoverKind::Doubtful } else { LeftoverKind::Orphan }, report);
        }
    }
}

fn find_in_derived(root: &Path, states: &States, report: &mut CheckReport) {
    for writer in derived::abandoned(root) {
        add(root, writer, LeftoverKind::Unfinished, report);
    }
    for name in storage::names_in(&root.join(storage::DERIVED)) {
        let key = |start: &str, end: &str| name.strip_prefix(start)?.strip_suffix(end);
        let key = key("candidates-", ".zarr").or(key("fault-proposals-", ".json"));
        let is_unnamed = key.is_some_and(|key| !history::is_named(root, key) && !states.may_be_named(key));
        // A hidden name is what the store writes to before it is complete.
        if is_unnamed || name.starts_with('.') {
            add(root, format!("{}/{name}", storage::DERIVED), LeftoverKind::Derived, report);
        }
    }
}

fn add(root: &Path, file: String, kind: LeftoverKind, report: &mut CheckReport) {
    let bytes = size_of(&root.join(&file));
    report.leftovers.push(Leftover { kind, file, bytes });
}

/// Bytes of a file, or of all files in a folder; links are not followed.
pub(super) fn size_of(path: &Path) -> u64 {
    match fs::symlink_metadata(path) {
        Ok(facts) if facts.is_dir() => {
            let entries = fs::read_dir(path).into_iter().flatten().flatten();
            entries.map(|entry| size_of(&entry.path())).sum()
        }
        Ok(facts) => facts.len(),
        Err(_) => 0,
    }
}

/// Whether another process holds the project's lock. Nothing is written to find out.
fn is_held(root: &Path) -> bool {
    let path = root.join("lock");
    let is_file = fs::symlink_metadata(&path).is_ok_and(|facts| facts.is_file());
    is_file && File::open(path).is_ok_and(|file| matches!(file.try_lock(), Err(fs::TryLockError::WouldBlock)))
}
