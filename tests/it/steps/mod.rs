//! Every step of every command: the program is killed before each system call that changes files, each of these calls
//! is made to fail, and the disk is made full from each of them on.
//!
//! After each of them `check` finds nothing damaged, a repair leaves the state before the command or the one after it,
//! byte for byte, and where it is the one before, the same command now succeeds with the same bytes as if nothing had
//! happened.

mod commands;
mod flush;
mod power_cut;
mod supervised;

use crate::program::{Run, command, copy, words};
use commands::Scenario;
use project::check::{Part, check, repair};
use std::cell::RefCell;
use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};
use std::process::Command;
use std::time::Duration;
use supervised::{Call, Verdict};
use survey::Progress;
use tempfile::TempDir;

/// What happens to a command at one of its steps.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Disturbance {
    /// It is killed before the step.
    Kill,
    /// The step fails, once.
    Fail,
    /// From the step on there is no room on the disk; only deleting works.
    Full,
}

impl Disturbance {
    const ALL: [Self; 3] = [Self::Kill, Self::Fail, Self::Full];

    /// One step in so many is disturbed so: a disk that is full from one step on leaves what it leaves from the next.
    fn stride(self) -> usize {
        if self == Self::Full { 4 } else { 1 }
    }

    /// What becomes of call `number`, where `step` is disturbed.
    fn verdict(self, step: usize, number: usize, call: &Call) -> Verdict {
        let frees = ["unlink", "unlinkat", "rmdir"].contains(&call.name());
        match self {
            Self::Kill if number == step => Verdict::Kill,
            Self::Fail if number == step => Verdict::Fail(libc::EIO),
            Self::Full if number >= step && !frees => Verdict::Fail(libc::ENOSPC),
            _ => Verdict::Go,
        }
    }
}

/// A folder of one's own, in memory where there is such a place: the calls are what is tested, not the disk.
fn empty_folder() -> TempDir {
    let memory = Path::new("/dev/shm");
    let made = if memory.is_dir() { tempfile::tempdir_in(memory) } else { tempfile::tempdir() };
    made.expect("a temporary folder")
}

/// The same with a copy of what lies in `start`.
fn folder_with(start: &Path) -> TempDir {
    let folder = empty_folder();
    copy(start, folder.path());
    folder
}

/// The program with the words of a line, on one thread: then its steps come in the same order each time.
fn program(at: &Path, line: &str) -> Command {
    let mut program = command();
    program.current_dir(at).args(words(line)).env("RAYON_NUM_THREADS", "1");
    // No projects are remembered: each folder is another one.
    program.env("XDG_STATE_HOME", "/dev/null");
    program
}

fn run_once(at: &Path, line: &str) -> Run {
    Run::of(&program(at, line).output().expect("the program runs"))
}

/// Every file below a folder, but for locks and what a killed writer left: beside its target as
/// `.NAME.partial-PROCESS-COUNT` or `NAME.PROCESS.part`, and in `derived/unfinished`, which the next writer there removes.
fn files(at: &Path) -> BTreeMap<PathBuf, Vec<u8>> {
    let is_beside = |path: &PathBuf| {
        let name = path.file_name().unwrap_or_default().to_string_lossy();
        let is_derived = path.ancestors().any(|folder| folder.ends_with("derived/unfinished"));
        is_derived || name.ends_with(".part") || name.starts_with('.') && name.contains(".partial-")
    };
    everything(at).into_iter().filter(|(path, _)| !is_beside(path)).collect()
}

/// Every file below a folder, but for locks.
fn everything(at: &Path) -> BTreeMap<PathBuf, Vec<u8>> {
    let below = |path: PathBuf| path.strip_prefix(at).expect("it lies below").to_owned();
    crate::program::bytes(at).into_iter().map(|(path, content)| (below(path), content)).collect()
}

/// Every folder below a folder.
fn folders(at: &Path) -> BTreeSet<PathBuf> {
    let (mut found, mut open) = (BTreeSet::new(), vec![PathBuf::new()]);
    while let Some(next) = open.pop() {
        let entries = std::fs::read_dir(at.join(&next)).expect("a folder").map(|entry| entry.expect("an entry").path());
        for path in entries.filter(|path| path.is_dir()) {
            let inside = next.join(path.file_name().unwrap_or_default());
            open.push(inside.clone());
            found.insert(inside);
        }
    }
    found
}

/// The files of a project without what can be computed again.
fn saved(root: &Path) -> BTreeMap<PathBuf, Vec<u8>> {
    files(root).into_iter().filter(|(path, _)| !path.starts_with("derived")).collect()
}

/// A scenario, the folder that it begins in, and what comes of it when nothing disturbs it.
struct Undisturbed {
    scenario: Scenario,
    start: TempDir,
    /// The project before and after the command; none before it was created.
    before: Option<BTreeMap<PathBuf, Vec<u8>>>,
    after: Option<BTreeMap<PathBuf, Vec<u8>>>,
    /// All files afterwards.
    all: BTreeMap<PathBuf, Vec<u8>>,
    /// The names of the calls.
    calls: Vec<&'static str>,
    /// What was left behind and was gone on with already: a failed call leaves the same as others, mostly.
    seen: RefCell<Vec<Left>>,
}

/// What a disturbed command leaves: files, folders and whether it said that it succeeded.
type Left = (BTreeMap<PathBuf, Vec<u8>>, BTreeSet<PathBuf>, bool);

impl Undisturbed {
    /// `None` where calls cannot be watched.
    fn of(scenario: Scenario) -> Option<Self> {
        let start = folder_with(scenario.start.folder());
        (scenario.prepare)(start.path());
        let state = |at: &Path| Some(at.join(scenario.project)).filter(|root| root.exists()).map(|root| saved(&root));
        // Some begin with what a killed command or damage has left behind.
        let begun = folder_with(start.path());
        let root = begun.path().join(scenario.project);
        if root.exists() {
            repair(&root, Duration::ZERO, &Progress::silent()).expect("it can be repaired");
        }
        let before = state(begun.path());
        let folder = folder_with(start.path());
        let mut calls = Vec::new();
        let run = supervised::run(program(folder.path(), scenario.line), |_, call| {
            calls.push(call.name());
            Verdict::Go
        })?;
        assert_eq!(run.code, 0, "{}: {}{}", scenario.line, run.stdout, run.stderr);
        let (after, all) = (state(folder.path()), files(folder.path()));
        Some(Self { scenario, start, before, after, all, calls, seen: RefCell::default() })
    }

    /// Carries out the command, disturbed at a step; panics if anything is lost.
    fn disturb(&self, disturbance: Disturbance, step: usize) {
        let what = format!("`{}`, {disturbance:?} at step {step} ({})", self.scenario.line, self.calls[step]);
        let folder = folder_with(self.start.path());
        let at = folder.path();
        let run =
            supervised::run(program(at, self.scenario.line), |number, call| disturbance.verdict(step, number, call));
        let run = run.expect("it was possible before");
        assert!(!run.stderr.contains("panicked"), "{what}: {}", run.stderr);
        match disturbance {
            Disturbance::Kill => assert_eq!(run.code, -1, "{what}: it was not killed"),
            _ if run.code == 0 => {}
            _ => assert!(run.code == 1 && run.stderr.contains("error: "), "{what}: {}{}", run.stdout, run.stderr),
        }
        let left = (everything(at), folders(at), run.code == 0);
        if self.seen.borrow().contains(&left) {
            return;
        }
        let is_done = self.settled(&at.join(self.scenario.project), &what);
        self.seen.borrow_mut().push(left);
        assert!(run.code != 0 || is_done, "{what}: it says that it succeeded");
        if !is_done || self.before == self.after {
            let again = run_once(at, self.scenario.line);
            assert_eq!(again.code, 0, "{what}, then again: {}{}", again.stdout, again.stderr);
            let (found, wanted) = (files(at), &self.all);
            assert!(found == *wanted, "{what}, then again: other bytes: {:?}", difference(&found, wanted));
        }
    }

    /// Checks a project after a command that was disturbed; returns whether the state is the one after the command.
    fn settled(&self, root: &Path, what: &str) -> bool {
        if !root.exists() {
            assert!(self.before.is_none(), "{what}: the project is gone");
            return self.after.is_none();
        }
        let silent = Progress::silent();
        let found = check(root, &silent).unwrap_or_else(|error| panic!("{what}: {error}"));
        let damage: Vec<_> = found.damage.iter().filter(|damage| damage.part != Part::Derived).collect();
        // A repair begins with damage.
        assert!(damage.is_empty() || self.scenario.line.contains("--repair"), "{what}: {damage:#?}");
        let (present, is_clean) = (saved(root), found.leftovers.is_empty() && found.notes.is_empty());
        if is_clean && [&self.before, &self.after].contains(&&Some(present.clone())) {
            return self.after.as_ref() == Some(&present);
        }
        // Only a copy is repaired: whoever goes on without a repair must get on as well.
        let copied = folder_with(root);
        let repaired =
            repair(copied.path(), Duration::ZERO, &silent).unwrap_or_else(|error| panic!("{what}, repair: {error}"));
        assert!(repaired.is_well(), "{what}, repaired: {:#?}", repaired.damage);
        let (found, none) = (saved(copied.path()), BTreeMap::new());
        let is_after = Some(&found) == self.after.as_ref();
        let differences = |state: &Option<_>| difference(&found, state.as_ref().unwrap_or(&none));
        let (before, after) = (differences(&self.before), differences(&self.after));
        let is_between = self.scenario.line.starts_with("prune") && self.is_between(&found);
        let is_one = is_after || before.is_empty() || is_between;
        assert!(is_one, "{what}: a third state: to before {before:?}, to after {after:?}");
        is_after
    }
}

impl Undisturbed {
    /// Deleting the history step by step, a command leaves all that the state needs, and some of the rest.
    fn is_between(&self, found: &BTreeMap<PathBuf, Vec<u8>>) -> bool {
        let (Some(before), Some(after)) = (&self.before, &self.after) else { return false };
        let is_in = |file: (&PathBuf, &Vec<u8>), all: &BTreeMap<PathBuf, Vec<u8>>| all.get(file.0) == Some(file.1);
        after.iter().all(|file| is_in(file, found)) && found.iter().all(|file| is_in(file, before))
    }
}

/// Where two folders differ, for the message of a failed test.
fn difference(found: &BTreeMap<PathBuf, Vec<u8>>, wanted: &BTreeMap<PathBuf, Vec<u8>>) -> Vec<String> {
    let names = found.keys().chain(wanted.keys()).collect::<BTreeSet<_>>();
    let word = |path: &PathBuf| match (found.get(path), wanted.get(path)) {
        (Some(a), Some(b)) if a == b => None,
        (Some(a), Some(b)) => Some(format!("{} has {} bytes, not {}", path.display(), a.len(), b.len())),
        (Some(_), None) => Some(format!("{} is new", path.display())),
        _ => Some(format!("{} is missing", path.display())),
    };
    names.into_iter().filter_map(word).collect()
}

/// Disturbs the commands of a group at every step.
fn disturb_all(scenarios: &[Scenario]) {
    for scenario in scenarios {
        let Some(undisturbed) = Undisturbed::of(*scenario) else { return };
        let count = undisturbed.calls.len();
        assert!(count > 0, "`{}` changes no file", scenario.line);
        let began = std::time::Instant::now();
        let mut runs = 0;
        for disturbance in Disturbance::ALL {
            for step in (0..count).step_by(disturbance.stride()) {
                undisturbed.disturb(disturbance, step);
                runs += 1;
            }
        }
        let different = undisturbed.seen.borrow().len();
        let seconds = began.elapsed().as_secs_f64();
        eprintln!("{count:4} steps, {runs:4} runs, {different:4} folders, {seconds:5.1} s: {}", scenario.line);
    }
}

#[test]
fn what_makes_files_and_projects_is_disturbed_at_every_step() {
    disturb_all(&commands::MAKING);
}

#[test]
fn what_changes_an_interpretation_is_disturbed_at_every_step() {
    disturb_all(&commands::INTERPRETING);
}

#[test]
fn picks_and_proposals_are_disturbed_at_every_step() {
    disturb_all(&commands::PICKING);
}

#[test]
fn the_look_is_disturbed_at_every_step() {
    disturb_all(&commands::LOOKING);
}

#[test]
fn what_is_computed_and_exported_is_disturbed_at_every_step() {
    disturb_all(&commands::COMPUTING);
}

#[test]
fn undo_and_repairs_are_disturbed_at_every_step() {
    disturb_all(&commands::MENDING);
}
