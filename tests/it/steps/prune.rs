//! A killed `prune`: what is left of the history is whole, and a later one finishes.

use super::commands::LONG_PRUNE;
use super::tree::{Tree, is_beside};
use super::{PATIENCE, Undisturbed, run_once};
use project::check::check;
use project::{Project, ProjectError};
use std::collections::BTreeSet;
use std::path::Path;
use survey::Progress;

/// The states of the history that can be shown in turn, from the newest on: how many undo steps there are, and how
/// many redo steps. After each one, everything in the project is there and undamaged.
fn walk(root: &Path, what: &str) -> [usize; 2] {
    let mut project = Project::open(root).unwrap_or_else(|error| panic!("{what}: {error}")).waiting(PATIENCE);
    let is_well = |moved: usize| {
        let report = check(root, &Progress::silent()).unwrap_or_else(|error| panic!("{what}: {error}"));
        assert!(report.damage.is_empty(), "{what}, after {moved} steps: {:#?}", report.damage);
    };
    is_well(0);
    let mut undone = 0;
    let end = loop {
        match project.undo() {
            Ok(_) => undone += 1,
            Err(end) => break end,
        }
        is_well(undone);
    };
    assert!(matches!(end, ProjectError::NothingToUndo), "{what}, after {undone} times undo: {end}");
    let mut redone = 0;
    let end = loop {
        match project.redo() {
            Ok(_) => redone += 1,
            Err(end) => break end,
        }
        is_well(undone + redone);
    };
    assert!(matches!(end, ProjectError::NothingToRedo), "{what}, after {redone} times redo: {end}");
    assert!(redone >= undone, "{what}: {undone} times undo, and redo only {redone} times");
    [undone, redone - undone]
}

/// The steps that a folder remembers.
fn remembered(project: &Tree) -> Vec<u32> {
    let history = project.below("history").unwrap_or_default().files(|_| false);
    history.keys().filter_map(|path| path.to_string_lossy().strip_suffix(".toml")?.parse().ok()).collect()
}

#[test]
fn a_killed_prune_leaves_whole_states_and_a_later_one_finishes() {
    let scenario = LONG_PRUNE;
    let Some(undisturbed) = Undisturbed::of(scenario) else { return };
    let mut seen = BTreeSet::new();
    for (step, moment) in undisturbed.moments.iter().enumerate() {
        let what = format!("`{}`, killed {}", scenario.line, undisturbed.before(step));
        let project = moment.killed.below(scenario.project).expect("the project");
        let numbers = remembered(&project);
        if !undisturbed.is_new(&moment.killed, false) {
            continue;
        }
        let folder = project.written();
        let [undone, redone] = walk(folder.path(), &what);
        // Undo and redo lead to every state that is remembered.
        assert_eq!(undone + redone + 1, numbers.len(), "{what}: {undone} back and {redone} on among {numbers:?}");
        let folder = moment.killed.written();
        run_once(folder.path(), scenario.line).done();
        let found = Tree::of(folder.path(), &moment.killed).files(is_beside);
        assert!(found == undisturbed.all, "{what}: a later one does not finish");
        seen.insert(numbers);
    }
    // From the whole history to the present state alone.
    let counts: Vec<usize> = seen.iter().map(Vec::len).collect();
    assert!(counts.contains(&1) && counts.iter().any(|count| *count > 5), "{seen:?}");
}
