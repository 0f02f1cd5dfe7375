//! What a check found, and what can be done about it. The words of a command line are absent: a [`Cure`] says what
//! helps, and whoever shows it knows how it is asked for.

use crate::error::Noun;
use serde::Serialize;
use std::fmt;
use std::path::PathBuf;

/// What a check found.
#[derive(Debug, Clone, Default, PartialEq, Eq, Serialize)]
pub struct CheckReport {
    /// The project's folder.
    pub project: PathBuf,
    /// Number of the present state; `None` if `project.toml` could not be read.
    pub step: Option<u32>,
    /// Numbers of the steps of the history that can be read.
    pub steps: Vec<u32>,
    /// Number of data files that states name.
    pub data_files: usize,
    /// Number of derived results.
    pub derived_files: usize,
    /// What is damaged.
    pub damage: Vec<Damage>,
    /// What cannot be read now, so that nothing can be said of it.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub unread: Vec<Unread>,
    /// What of the present state cannot be drawn, though nothing that it needs is damaged: what pictures of it would say.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub undrawable: Vec<String>,
    /// What no state names. It does no harm.
    pub leftovers: Vec<Leftover>,
    /// What else there is to know.
    pub notes: Vec<String>,
    /// What was repaired.
    pub repairs: Vec<Repair>,
}

impl CheckReport {
    /// Whether everything could be read, nothing is damaged any more, and the present state can be drawn.
    pub fn is_well(&self) -> bool {
        self.unread.is_empty() && self.undrawable.is_empty() && self.damage.iter().all(|damage| damage.repaired)
    }
}

/// The part of a project that is damaged.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Part {
    /// The present state, `project.toml`.
    State,
    /// A step of the history.
    Step,
    /// Data that a state names.
    #[default]
    Data,
    /// What was computed and can be computed again.
    Derived,
    /// A file or folder at a place where commands write.
    Folder,
}

/// Something that is damaged.
#[derive(Debug, Clone, Default, PartialEq, Eq, Serialize)]
pub struct Damage {
    /// The part of the project.
    pub part: Part,
    /// The file or folder, relative to the project.
    pub file: String,
    /// What it is, in words: `horizon "Top Chalk"`.
    pub what: String,
    /// What is wrong with it.
    pub reason: String,
    /// What is made of it.
    pub dependants: Vec<String>,
    /// Whether the present state needs it.
    pub is_present: bool,
    /// The steps of the history that need it.
    pub steps: Vec<u32>,
    /// What can be done about it, the best first.
    pub cures: Vec<Cure>,
    /// Whether it was repaired.
    pub repaired: bool,
}

impl Damage {
    /// Damage of which nothing more is known than what is wrong.
    pub(super) fn of(file: impl Into<String>, reason: impl Into<String>) -> Self {
        Self { file: file.into(), reason: reason.into(), ..Self::default() }
    }
}

/// Something that cannot be read now: for want of a permission, of handles or memory, because a disk or a network fails,
/// because a newer version wrote it, or in a folder whose path is no text. It may be whole.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
pub struct Unread {
    /// The file or folder, relative to the project.
    pub file: String,
    /// What it is, in words.
    pub what: String,
    /// Why it cannot be read.
    pub reason: String,
}

/// A result of a computation, which can be computed again.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Outcome {
    /// i, j, k, whole or in blocks or grids. They are computed again when they are needed.
    Parameterization,
    /// Horizon candidates.
    Candidates,
    /// Proposed faults.
    FaultProposals,
}

impl fmt::Display for Outcome {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Parameterization => "a part of the parameterization",
            Self::Candidates => "horizon candidates",
            Self::FaultProposals => "proposed faults",
        })
    }
}

/// What helps against damage.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
#[serde(tag = "do", rename_all = "kebab-case")]
pub enum Cure {
    /// A repair makes this step of the history the present state.
    Restore {
        /// The step.
        step: u32,
    },
    /// A repair moves it to `damaged/`.
    SetAside,
    /// A repair removes it, and it is computed again: by itself when it is needed, or by a command.
    Recompute {
        /// What was computed.
        result: Outcome,
    },
    /// A repair makes it again.
    MakeAgain,
    /// The present state can be undone to one that does not need it.
    Undo {
        /// The step to go back to.
        step: u32,
        /// How often to undo.
        times: u32,
    },
    /// It is removed from the project and read again from the file that it came from.
    Import {
        /// What it is.
        noun: Noun,
        /// Its name.
        name: String,
        /// The file.
        path: PathBuf,
    },
    /// It is removed from the project and made again.
    Remake {
        /// What it is.
        noun: Noun,
        /// Its name.
        name: String,
        /// How it was made.
        from: String,
    },
    /// Only the history needs it, and the history can be deleted.
    Prune,
    /// The link is replaced by a copy of what it points to, by someone who trusts it.
    ReplaceLink,
    /// A copy of the whole project from elsewhere.
    Backup,
}

/// What kind of leftover something is.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum LeftoverKind {
    /// What a command that did not finish was writing.
    Unfinished,
    /// An import that was interrupted; the same import continues from it.
    Import,
    /// Derived data that no state names.
    Derived,
    /// A data file that no state names.
    Orphan,
    /// A data file that only a step names which cannot be read any more. It is never removed.
    Doubtful,
}

/// Something that no state names.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
pub struct Leftover {
    /// What kind.
    pub kind: LeftoverKind,
    /// The file or folder, relative to the project.
    pub file: String,
    /// Bytes that it takes.
    pub bytes: u64,
}

/// Something that a repair did.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
#[serde(tag = "did", rename_all = "kebab-case")]
pub enum Repair {
    /// It was removed.
    Removed {
        /// The file or folder.
        file: String,
        /// Bytes that it took.
        bytes: u64,
    },
    /// It was moved.
    Moved {
        /// The file.
        file: String,
        /// Where it is now.
        to: String,
    },
    /// A step of the history is the present state now.
    Restored {
        /// The step.
        step: u32,
    },
    /// The present state was written to the history again.
    Recorded {
        /// Its number.
        step: u32,
    },
    /// A folder was made again.
    Made {
        /// The folder.
        folder: String,
    },
}

impl fmt::Display for Repair {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Removed { file, bytes } => write!(f, "removed {file} ({bytes} bytes)"),
            Self::Moved { file, to } => write!(f, "moved {file} to {to}"),
            Self::Restored { step } => write!(f, "restored project.toml from step {step} of the history"),
            Self::Recorded { step } => write!(f, "wrote the present state to the history again, as step {step}"),
            Self::Made { folder } => write!(f, "made the folder {folder} again"),
        }
    }
}
