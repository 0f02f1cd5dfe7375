//! Every step of every command: the program is killed before each system call that changes files, each of these calls
//! is made to fail, the disk is made full from each of them on, and the power is cut before each of them.
//!
//! Calls that fail take most of the time: only one in three is made to fail, unless `PETROGLYPH_EVERY_STEP` is set.
//!
//! After each of them `check` finds nothing damaged, a repair leaves the state before the command or the one after it,
//! byte for byte, and where it is the one before, the same command now succeeds with the same bytes as if nothing had
//! happened.
//!
//! Kills and power cuts need no run of their own: in one run that nothing disturbs, the folder is taken down before
//! each call ([`disk`]). Calls that fail do need one. What is left is often the same: each folder is gone on with once,
//! each project in it checked once.

mod commands;
mod disk;
mod flush;
mod prune;
mod supervised;
mod tree;

use crate::program::{Run, command, copy, words};
use commands::Scenario;
use disk::{Disk, Kept};
use project::check::{Part, check, repair};
use rayon::prelude::*;
use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};
use std::process::Command;
use std::sync::Mutex;
use std::time::Duration;
use supervised::{Call, Verdict};
use survey::Progress;
use tempfile::TempDir;
use tree::{Files, Tree, difference, is_beside};

/// What happens to a command at one of its steps.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Disturbance {
    /// The step fails, once.
    Fail,
    /// From the step on there is no room on the disk; only deleting works.
    Full,
}

impl Disturbance {
    const ALL: [Self; 2] = [Self::Fail, Self::Full];

    /// The steps of a command that are disturbed so. A disk that is full from one step on leaves what it leaves from the
    /// next, and commands share most of their steps: by default some of them suffice, others for each command.
    fn steps(self, line: &str, count: usize) -> impl Iterator<Item = usize> {
        let of_each = if std::env::var_os("PETROGLYPH_EVERY_STEP").is_some() { 1 } else { 3 };
        let stride = of_each * if self == Self::Full { 4 } else { 1 };
        (line.len() % of_each..count).step_by(stride)
    }

    /// What becomes of call `number`, where `step` is disturbed.
    fn verdict(self, step: usize, number: usize, call: &Call) -> Verdict {
        let frees = ["unlink", "unlinkat", "rmdir"].contains(&call.name());
        match self {
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

/// The files of a project without what can be computed again.
fn saved(project: &Tree) -> Files {
    project.files(|path| is_beside(path) || path.starts_with("derived"))
}

/// What can be left before a call, or at the end.
struct Moment {
    /// By a kill.
    killed: Tree,
    /// By a power cut.
    cut: [(Kept, Tree); 3],
}

impl Moment {
    fn of(disk: &Disk, step: usize) -> Self {
        let cut = [Kept::Nothing, Kept::Names, Kept::Some(step as u64)].map(|kept| (kept, disk.after_a_cut(kept)));
        Self { killed: disk.after_a_kill(), cut }
    }
}

/// How long a lock is waited for: a program that another test starts holds it for a moment, until it is loaded.
const PATIENCE: Duration = Duration::from_secs(60);

/// One folder in so many, of those that a power cut leaves, is gone on with: the command is given again.
const AGAIN: usize = 5;

/// A scenario, the folder that it begins in, and what comes of it when nothing disturbs it.
struct Undisturbed {
    scenario: Scenario,
    start: Tree,
    /// The project before and after the command; none before it was created.
    before: Option<Files>,
    after: Option<Files>,
    /// All files afterwards.
    all: Files,
    /// The names of the calls.
    calls: Vec<&'static str>,
    /// What can be left before each call, and after the last.
    moments: Vec<Moment>,
    /// Folders that were gone on with, and whether the command had said that it succeeded.
    seen: Mutex<BTreeSet<(Tree, bool)>>,
    /// Projects that were checked, and whether each is in the state after the command.
    checked: Mutex<BTreeMap<Tree, bool>>,
}

impl Undisturbed {
    /// `None` where calls cannot be watched.
    fn of(scenario: Scenario) -> Option<Self> {
        let folder = folder_with(scenario.start.folder());
        (scenario.prepare)(folder.path());
        let start = Tree::of(folder.path(), &Tree::default());
        let state = |at: &Tree| at.below(scenario.project).map(|project| saved(&project));
        // Some begin with what a killed command or damage has left behind.
        let begun = start.written();
        let root = begun.path().join(scenario.project);
        if root.exists() {
            repair(&root, PATIENCE, &Progress::silent()).expect("it can be repaired");
        }
        let before = state(&Tree::of(begun.path(), &start));
        let folder = start.written();
        let (mut disk, mut calls, mut moments) = (Disk::of(folder.path()), Vec::new(), Vec::new());
        let run = supervised::run(program(folder.path(), scenario.line), |step, call| {
            disk.next(Some(call));
            calls.push(call.name());
            moments.push(Moment::of(&disk, step));
            Verdict::Go
        })?;
        assert_eq!(run.code, 0, "{}: {}{}", scenario.line, run.stdout, run.stderr);
        assert!(!calls.is_empty(), "`{}` changes no file", scenario.line);
        disk.next(None);
        moments.push(Moment::of(&disk, calls.len()));
        let end = disk.after_a_kill();
        let (after, all) = (state(&end), end.files(is_beside));
        let (seen, checked) = (Mutex::default(), Mutex::default());
        Some(Self { scenario, start, before, after, all, calls, moments, seen, checked })
    }

    /// Whether nobody has gone on with this yet; from now on somebody has.
    fn is_new(&self, left: &Tree, has_succeeded: bool) -> bool {
        self.seen.lock().unwrap().insert((left.without_locks(), has_succeeded))
    }

    /// A kill before a step, or at the end.
    fn kill(&self, step: usize) {
        let has_succeeded = step == self.calls.len();
        self.go_on(
            &self.moments[step].killed,
            has_succeeded,
            &format!("`{}`, killed {}", self.scenario.line, self.before(step)),
        );
    }

    /// Carries out the command, disturbed at a step.
    fn disturb(&self, disturbance: Disturbance, step: usize) {
        let what = format!("`{}`, {disturbance:?} {}", self.scenario.line, self.before(step));
        let folder = self.start.written();
        let decide = |number, call: &_| disturbance.verdict(step, number, call);
        let run = supervised::run(program(folder.path(), self.scenario.line), decide).expect("it was possible before");
        assert!(!run.stderr.contains("panicked"), "{what}: {}", run.stderr);
        let is_told = run.code == 0 || run.code == 1 && run.stderr.contains("error: ");
        assert!(is_told, "{what}: {}{}", run.stdout, run.stderr);
        self.go_on(&Tree::of(folder.path(), &self.start), run.code == 0, &what);
    }

    /// The program had said that it succeeded, or the command is given again; panics if anything is lost.
    fn go_on(&self, left: &Tree, has_succeeded: bool, what: &str) {
        if !self.is_new(left, has_succeeded) {
            return;
        }
        let is_done = self.settled(left, has_succeeded, what);
        if !is_done || self.before == self.after {
            let folder = left.written();
            let again = run_once(folder.path(), self.scenario.line);
            assert_eq!(again.code, 0, "{what}, then again: {}{}", again.stdout, again.stderr);
            let found = Tree::of(folder.path(), left).files(is_beside);
            assert!(found == self.all, "{what}, then again: other bytes: {:?}", difference(&found, &self.all));
        }
    }

    /// A power cut before a step; after the command has said that it succeeded, only its result is right.
    fn cut(&self, step: usize, kept: Kept, left: &Tree) {
        let has_succeeded = step == self.calls.len();
        if !self.is_new(left, has_succeeded) {
            return;
        }
        let what = format!("`{}`, power cut {}, {kept:?} kept", self.scenario.line, self.before(step));
        self.settled(left, has_succeeded, &what);
        let state = Path::new(self.scenario.project).join("project.toml");
        let found = left.files(is_unfinished);
        let is_done = self.before != self.after && found.get(&state) == self.all.get(&state);
        if !has_succeeded && !is_done && self.seen.lock().unwrap().len().is_multiple_of(AGAIN) {
            let folder = left.written();
            let again = run_once(folder.path(), self.scenario.line);
            assert_eq!(again.code, 0, "{what}, then again: {}{}", again.stdout, again.stderr);
            let found = Tree::of(folder.path(), left).files(|path| is_beside(path) || is_unfinished(path));
            assert!(found == self.all, "{what}, then again: other bytes: {:?}", difference(&found, &self.all));
        }
    }

    /// The words for a step.
    fn before(&self, step: usize) -> String {
        self.calls.get(step).map_or("at the end".to_owned(), |name| format!("before step {step} ({name})"))
    }

    /// Checks what is left; returns whether the project is in the state after the command.
    fn settled(&self, left: &Tree, has_succeeded: bool, what: &str) -> bool {
        let is_done = self.is_settled(left, what);
        assert!(is_done || !has_succeeded, "{what}: what the command had done is lost");
        // What was written elsewhere is whole or not there under its name.
        let is_inside = |path: &Path| path.starts_with(self.scenario.project) || is_unfinished(path);
        let found = left.files(is_inside);
        for (path, content) in &found {
            assert!(self.all.get(path) == Some(content), "{what}: {} is not whole", path.display());
        }
        if has_succeeded {
            let lost: Vec<_> = self.all.keys().filter(|path| !is_inside(path) && !found.contains_key(*path)).collect();
            assert!(lost.is_empty(), "{what}: {lost:?} is lost");
        }
        is_done
    }

    /// Checks the project in what is left; returns whether its state is the one after the command.
    fn is_settled(&self, left: &Tree, what: &str) -> bool {
        let Some(project) = left.below(self.scenario.project).map(|project| project.without_locks()) else {
            assert!(self.before.is_none(), "{what}: the project is gone");
            return self.after.is_none();
        };
        if let Some(is_after) = self.checked.lock().unwrap().get(&project) {
            return *is_after;
        }
        let is_after = self.is_after(&project, what);
        self.checked.lock().unwrap().insert(project, is_after);
        is_after
    }

    /// Checks a project; returns whether its state is the one after the command.
    fn is_after(&self, project: &Tree, what: &str) -> bool {
        let (silent, folder) = (Progress::silent(), project.written());
        let found = check(folder.path(), &silent).unwrap_or_else(|error| panic!("{what}: {error}"));
        let damage: Vec<_> = found.damage.iter().filter(|damage| damage.part != Part::Derived).collect();
        // A repair begins with damage.
        assert!(damage.is_empty() || self.scenario.line.contains("--repair"), "{what}: {damage:#?}");
        let (present, is_clean) = (saved(project), found.leftovers.is_empty() && found.notes.is_empty());
        if is_clean && [&self.before, &self.after].contains(&&Some(present.clone())) {
            return self.after.as_ref() == Some(&present);
        }
        // Whoever goes on does so without a repair, and must get on as well.
        let repaired =
            repair(folder.path(), PATIENCE, &silent).unwrap_or_else(|error| panic!("{what}, repair: {error}"));
        assert!(repaired.is_well(), "{what}, repaired: {:#?}", repaired.damage);
        let (found, none) = (saved(&Tree::of(folder.path(), project)), BTreeMap::new());
        let is_after = Some(&found) == self.after.as_ref();
        let differences = |state: &Option<_>| difference(&found, state.as_ref().unwrap_or(&none));
        let (before, after) = (differences(&self.before), differences(&self.after));
        let is_between = self.scenario.line.starts_with("prune") && self.is_between(&found);
        let is_one = is_after || before.is_empty() || is_between;
        assert!(is_one, "{what}: a third state: to before {before:?}, to after {after:?}");
        is_after
    }

    /// Deleting the history step by step, a command leaves all that the state needs, and some of the rest.
    fn is_between(&self, found: &Files) -> bool {
        let (Some(before), Some(after)) = (&self.before, &self.after) else { return false };
        let is_in = |file: (&PathBuf, &tree::Content), all: &Files| all.get(file.0) == Some(file.1);
        after.iter().all(|file| is_in(file, found)) && found.iter().all(|file| is_in(file, before))
    }
}

/// A file that is renamed to its target when it is whole: `NAME.PROCESS.part`, or hidden.
fn is_unfinished(path: &Path) -> bool {
    path.extension().is_some_and(|extension| extension == "part")
        || path.components().any(|part| part.as_os_str().to_string_lossy().starts_with('.'))
}

/// Disturbs the commands of a group at every step.
fn disturb_all(scenarios: &[Scenario]) {
    for scenario in scenarios {
        let Some(undisturbed) = Undisturbed::of(*scenario) else { return };
        let (count, began) = (undisturbed.calls.len(), std::time::Instant::now());
        (0..=count).into_par_iter().for_each(|step| undisturbed.kill(step));
        let steps =
            |disturbance: Disturbance| disturbance.steps(scenario.line, count).map(move |step| (disturbance, step));
        let failures: Vec<_> = Disturbance::ALL.into_iter().flat_map(steps).collect();
        failures.par_iter().for_each(|(disturbance, step)| undisturbed.disturb(*disturbance, *step));
        // A repair that is cut off may set the same damaged step aside twice: both are what it was.
        if !scenario.line.contains("--repair") {
            let cut = |(step, moment): (usize, &Moment)| {
                moment.cut.iter().for_each(|(kept, left)| undisturbed.cut(step, *kept, left));
            };
            undisturbed.moments.par_iter().enumerate().for_each(cut);
        }
        let [folders, projects] = [undisturbed.seen.lock().unwrap().len(), undisturbed.checked.lock().unwrap().len()];
        let (runs, seconds) = (failures.len(), began.elapsed().as_secs_f64());
        eprintln!(
            "{count:4} steps, {runs:4} failing, {folders:4} folders, {projects:4} projects, {seconds:5.1} s: {}",
            scenario.line
        );
    }
}

/// The program is really killed here: what it leaves is what is taken down before the call.
#[test]
fn a_kill_leaves_what_lies_in_the_folder_before_the_call() {
    let Some(undisturbed) = Undisturbed::of(commands::LOOKING[0]) else { return };
    for (step, moment) in undisturbed.moments.iter().enumerate().take(undisturbed.calls.len()) {
        let folder = undisturbed.start.written();
        let decide = |number, _: &_| if number == step { Verdict::Kill } else { Verdict::Go };
        let run = supervised::run(program(folder.path(), undisturbed.scenario.line), decide);
        let what = undisturbed.before(step);
        assert_eq!(run.expect("it was possible before").code, -1, "{what}: it was not killed");
        let left = Tree::of(folder.path(), &moment.killed);
        assert!(left.without_locks() == moment.killed.without_locks(), "{what}");
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
