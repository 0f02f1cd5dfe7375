//! The present state and the steps of the history, as far as they can be read.

use super::report::{CheckReport, Cure, Damage, Part, Unread};
use super::verify::Finding;
use crate::document::Document;
use crate::error::ProjectError;
use crate::folder::history::{self, Step};
use crate::folder::storage;
use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::io::ErrorKind;
use std::path::Path;
use system::file::{self, FileAction};

/// A file of a state that cannot be read.
#[derive(Debug)]
pub(super) struct Unreadable {
    /// Relative to the project.
    pub file: String,
    /// The step; `None` for the present state.
    pub number: Option<u32>,
    /// What is wrong with it.
    pub reason: String,
    /// Whether that is damage.
    pub trouble: Trouble,
    /// Its bytes, as far as they can be read: they show what it may name.
    pub text: Option<String>,
}

/// Why a file of a state is of no use.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Trouble {
    /// It is damaged.
    Damaged,
    /// A newer version of the program wrote it: that is no damage.
    Newer,
    /// It cannot be read now, and may be whole.
    Unread,
}

/// Everything that is known of a project's states.
#[derive(Debug)]
pub(super) struct States {
    /// Text and content of `project.toml`.
    present: Option<(String, Document)>,
    steps: BTreeMap<u32, (Step, Document)>,
    /// What cannot be read of the state and the history.
    pub unreadable: Vec<Unreadable>,
    /// What an earlier repair has set aside.
    pub set_aside: Vec<Unreadable>,
    /// What is wrong with the folder of the history, and what helps.
    pub history_trouble: Option<(String, Cure)>,
    /// Why the steps of the history cannot be listed now; they may name anything.
    history_unread: Option<String>,
}

impl States {
    /// Reads all states of the project in `root`.
    ///
    /// # Errors
    /// There is no project, or a newer version wrote it.
    pub(super) fn read(root: &Path) -> Result<Self, ProjectError> {
        let not_a_project = |fact| Err(ProjectError::NotAProject { path: root.to_owned(), fact });
        match fs::metadata(root) {
            Ok(facts) if facts.is_dir() => {}
            Ok(_) => return not_a_project("it is a file, a project is a folder"),
            Err(error) if file::says_nothing(&error) => return Err(ProjectError::io(FileAction::Read, root, error)),
            Err(_) => return Err(ProjectError::NotFound { path: root.to_owned() }),
        }
        let mut states = Self {
            present: None,
            steps: BTreeMap::new(),
            unreadable: Vec::new(),
            set_aside: Vec::new(),
            history_trouble: None,
            history_unread: None,
        };
        states.read_history(root);
        let has_state = match fs::symlink_metadata(root.join(storage::STATE)) {
            // Nothing in the folder can be looked at.
            Err(error) if file::says_nothing(&error) => return Err(ProjectError::io(FileAction::Read, root, error)),
            known => known.is_ok(),
        };
        if !has_state && states.steps.is_empty() && states.unreadable.is_empty() && states.history_unread.is_none() {
            return not_a_project("it has neither a project.toml nor a history");
        }
        states.read_present(root)?;
        let kept = storage::names_in(root).into_iter().filter(|name| name.starts_with(DAMAGED_STATE));
        let moved = storage::names_in(&root.join(DAMAGED)).into_iter().map(|name| format!("{DAMAGED}/{name}"));
        for file in kept.chain(moved) {
            let text = raw(&root.join(&file));
            let (reason, trouble) = (String::new(), Trouble::Damaged);
            states.set_aside.push(Unreadable { file, number: None, reason, trouble, text });
        }
        Ok(states)
    }

    fn read_history(&mut self, root: &Path) {
        self.history_trouble = match fs::symlink_metadata(root.join("history")) {
            Ok(facts) if facts.is_dir() => None,
            Ok(facts) if facts.is_symlink() => Some(("it is a link".to_owned(), Cure::ReplaceLink)),
            Ok(_) => Some(("it is no folder".to_owned(), Cure::ReplaceLink)),
            Err(error) if error.kind() == ErrorKind::NotFound => {
                Some(("it is missing: there is nothing to undo".to_owned(), Cure::MakeAgain))
            }
            Err(error) => {
                self.history_unread = Some(format!("it cannot be read: {error}"));
                return;
            }
        };
        if self.history_trouble.is_some() {
            return;
        }
        let numbers = match history::numbers(root) {
            Ok(numbers) => numbers,
            Err(error) => {
                self.history_unread = Some(format!("it cannot be read: {}", cause_of(&error)));
                return;
            }
        };
        for number in numbers.into_iter().collect::<BTreeSet<_>>() {
            let file = history::file_of(number);
            let path = root.join(&file);
            let step = plain_text(&path)
                .and_then(|text| {
                    toml::from_str::<Step>(&text).map_err(|error| Finding::Damaged(first_line(&error.to_string())))
                })
                .map_err(of_finding);
            let known = step.and_then(|step| match Document::from_text(&step.project, &path) {
                Ok(document) if document.step == number => Ok((step, document)),
                Ok(document) => Err((format!("it holds the state of step {}", document.step), Trouble::Damaged)),
                Err(error @ ProjectError::Newer { .. }) => Err((error.to_string(), Trouble::Newer)),
                Err(error) => Err((detail(&error), Trouble::Damaged)),
            });
            match known {
                Ok(known) => drop(self.steps.insert(number, known)),
                Err((reason, trouble)) => {
                    let text = raw(&path);
                    self.unreadable.push(Unreadable { file, number: Some(number), reason, trouble, text });
                }
            }
        }
    }

    fn read_present(&mut self, root: &Path) -> Result<(), ProjectError> {
        let path = root.join(storage::STATE);
        let read = plain_text(&path).and_then(|text| match Document::from_text(&text, &path) {
            Ok(document) => Ok(Ok((text, document))),
            Err(error @ ProjectError::Newer { .. }) => Ok(Err(error)),
            Err(error) => Err(Finding::Damaged(detail(&error))),
        });
        match read.map_err(of_finding) {
            Ok(known) => self.present = Some(known?),
            Err((reason, trouble)) => self.unreadable.push(Unreadable {
                file: storage::STATE.to_owned(),
                number: None,
                reason,
                trouble,
                text: raw(&path),
            }),
        }
        Ok(())
    }

    /// The present state, if it can be read.
    pub(super) fn present(&self) -> Option<&Document> {
        self.present.as_ref().map(|(_, document)| document)
    }

    /// The text of `project.toml`, if it can be read.
    pub(super) fn present_text(&self) -> Option<&str> {
        self.present.as_ref().map(|(text, _)| text.as_str())
    }

    /// Numbers of the steps that can be read, ascending.
    pub(super) fn numbers(&self) -> impl Iterator<Item = u32> {
        self.steps.keys().copied()
    }

    /// The steps that can be read, ascending.
    pub(super) fn documents(&self) -> impl DoubleEndedIterator<Item = (u32, &Document)> {
        self.steps.iter().map(|(number, (_, document))| (*number, document))
    }

    /// A step that can be read.
    pub(super) fn step(&self, number: u32) -> Option<&Step> {
        self.steps.get(&number).map(|(step, _)| step)
    }

    /// The state after a step that can be read.
    pub(super) fn document(&self, number: u32) -> Option<&Document> {
        self.steps.get(&number).map(|(_, document)| document)
    }

    /// The step from which a damaged `project.toml` can be restored: the one that it says it is, where its text still
    /// shows that, otherwise the newest.
    pub(super) fn restorable(&self) -> Option<u32> {
        let damaged = self.unreadable.iter().find(|unreadable| unreadable.number.is_none())?;
        if damaged.trouble != Trouble::Damaged {
            return None;
        }
        let said = damaged
            .text
            .iter()
            .flat_map(|text| text.lines())
            .find_map(|line| line.strip_prefix("step = ")?.trim().parse().ok());
        said.filter(|number| self.steps.contains_key(number)).or_else(|| self.numbers().last())
    }

    /// Whether the present state cannot be read now.
    pub(super) fn is_state_unread(&self) -> bool {
        self.unreadable.iter().any(|file| file.number.is_none() && file.trouble == Trouble::Unread)
    }

    /// The newest step that undo leads to from `present` and that is not among `without`: all steps on the way must be
    /// readable.
    pub(super) fn undo_without(&self, present: &Document, without: &[u32]) -> Option<u32> {
        self.way_back(present).skip(1).find(|number| !without.contains(number))
    }

    /// The steps that undo leads through, from the present one back.
    fn way_back(&self, present: &Document) -> impl Iterator<Item = u32> {
        (0..=present.step).rev().take_while(|number| self.steps.contains_key(number))
    }

    /// Whether a file that cannot be read may name `text`. One whose bytes cannot be read at all may name anything.
    pub(super) fn may_be_named(&self, text: &str) -> bool {
        let doubtful = self.unreadable.iter().chain(&self.set_aside);
        self.history_unread.is_some()
            || doubtful.into_iter().any(|unreadable| unreadable.text.as_ref().is_none_or(|all| all.contains(text)))
    }

    /// Whether another process has changed the project since it was read.
    pub(super) fn has_changed(&self, root: &Path) -> bool {
        self.present.as_ref().is_some_and(|(text, _)| raw(&root.join(storage::STATE)).as_ref() != Some(text))
    }
}

/// The folder to which a repair moves what cannot be read.
pub(super) const DAMAGED: &str = "damaged";

/// The name under which a repair keeps a damaged `project.toml`.
pub(super) const DAMAGED_STATE: &str = "project.toml.damaged";

/// Reports what is wrong with the states.
pub(super) fn report(states: &States, report: &mut CheckReport) {
    if let Some((reason, cure)) = &states.history_trouble {
        report.damage.push(Damage {
            part: Part::Step,
            what: "the history".to_owned(),
            cures: vec![cure.clone()],
            ..Damage::of("history", reason)
        });
    }
    if let Some(reason) = &states.history_unread {
        let (file, what) = ("history".to_owned(), "the history".to_owned());
        report.unread.push(Unread { file, what, reason: reason.clone() });
    }
    for unreadable in &states.unreadable {
        let what = match unreadable.number {
            Some(number) => format!("step {number} of the history"),
            None => "the present state".to_owned(),
        };
        match unreadable.trouble {
            Trouble::Damaged => {}
            Trouble::Newer => {
                let reason = &unreadable.reason;
                report.notes.push(format!("{reason}: undo and redo stop there, and whatever it may name is kept"));
                continue;
            }
            Trouble::Unread => {
                let (file, reason) = (unreadable.file.clone(), unreadable.reason.clone());
                report.unread.push(Unread { file, what, reason });
                continue;
            }
        }
        let damage = Damage { what, ..Damage::of(&unreadable.file, &unreadable.reason) };
        report.damage.push(match unreadable.number {
            Some(number) => Damage {
                part: Part::Step,
                dependants: lost_undo(states, number),
                steps: vec![number],
                cures: vec![Cure::SetAside],
                ..damage
            },
            None => Damage {
                part: Part::State,
                dependants: vec!["everything in the project".to_owned()],
                is_present: true,
                cures: vec![states.restorable().map_or(Cure::Backup, |step| Cure::Restore { step })],
                ..damage
            },
        });
    }
    if let Some(present) = states.present()
        && states.history_trouble.is_none()
        && states.history_unread.is_none()
        && !states.steps.contains_key(&present.step)
        && !states.unreadable.iter().any(|unreadable| unreadable.number == Some(present.step))
    {
        report.notes.push(format!(
            "the present state, step {}, is not in the history: a repair writes it there, so that the next command can \
             be undone",
            present.step
        ));
    }
    if let Some(present) = states.present()
        && let Some(last) = states.way_back(present).last()
        && states.numbers().next().is_some_and(|first| first < last)
    {
        report.notes.push(format!(
            "undo ends at step {last}, because the step before it is missing, damaged or cannot be read"
        ));
    }
    if !states.set_aside.is_empty() {
        let names: Vec<&str> = states.set_aside.iter().map(|aside| aside.file.as_str()).collect();
        report.notes.push(format!(
            "an earlier repair has set {} aside; data that they may name are kept for as long as they are there",
            names.join(", ")
        ));
    }
}

/// What a step that cannot be read costs.
fn lost_undo(states: &States, number: u32) -> Vec<String> {
    let Some(present) = states.present() else { return Vec::new() };
    vec![match number.cmp(&present.step) {
        std::cmp::Ordering::Less => format!("undo to step {number} and to those before it"),
        std::cmp::Ordering::Equal => "undo of the last command".to_owned(),
        std::cmp::Ordering::Greater => format!("redo to step {number} and to those after it"),
    }]
}

/// What the system said of a failure, without the path.
fn cause_of(error: &ProjectError) -> String {
    std::error::Error::source(error).map_or_else(|| error.to_string(), ToString::to_string)
}

/// What was found of a state's file.
fn of_finding(finding: Finding) -> (String, Trouble) {
    match finding {
        Finding::Damaged(reason) => (reason, Trouble::Damaged),
        Finding::Unread(reason) => (reason, Trouble::Unread),
    }
}

/// The reason of an error, without the path that is said anyway.
fn detail(error: &ProjectError) -> String {
    match error {
        ProjectError::Malformed { detail, .. } => first_line(detail),
        other => other.to_string(),
    }
}

/// A parser's message in one line.
fn first_line(text: &str) -> String {
    let lines: Vec<&str> = text.lines().map(str::trim).filter(|line| !line.is_empty()).collect();
    match (lines.first(), lines.last()) {
        (Some(first), Some(last)) if lines.len() > 1 => format!("{first}: {last}"),
        (Some(first), _) => (*first).to_owned(),
        _ => "it cannot be understood".to_owned(),
    }
}

/// The text of an ordinary file that is no link.
fn plain_text(path: &Path) -> Result<String, Finding> {
    match fs::symlink_metadata(path) {
        Ok(facts) if facts.is_symlink() => return Err(Finding::Damaged("it is a link".to_owned())),
        Err(error) if error.kind() == ErrorKind::NotFound => return Err(Finding::Damaged("it is missing".to_owned())),
        _ => {}
    }
    file::read_text(path, file::MAX_DOCUMENT_BYTES).map_err(|error| match error.kind() {
        ErrorKind::InvalidData => Finding::Damaged(format!("it is no text: {error}")),
        _ => Finding::of(&error),
    })
}

/// What an ordinary file that is no link holds, as far as it is text; nothing of one that is missing.
fn raw(path: &Path) -> Option<String> {
    match fs::symlink_metadata(path) {
        Ok(facts) if !facts.is_file() => return None,
        Err(error) if error.kind() == ErrorKind::NotFound => return Some(String::new()),
        _ => {}
    }
    let bytes = file::read(path, file::MAX_DOCUMENT_BYTES).ok()?;
    Some(String::from_utf8_lossy(&bytes).into_owned())
}
