//! Derived data: results that were computed and can be computed again. They carry hashes, checksums or keys of their
//! own.

use super::newest;
use super::report::{CheckReport, Cure, Damage, Outcome, Part, Unread};
use super::states::States;
use super::verify::{Finding, confirmed, is_there, outcome};
use crate::derived;
use crate::document::Document;
use crate::error::ProjectError;
use crate::folder::storage;
use crate::interpretation::{extraction, proposals};
use std::path::Path;
use store::{StoredCandidates, StoredParameterization};
use survey::Progress;
use system::file::{self, FileAction};

/// A kind of derived data, by its name.
enum Computed<'a> {
    /// Blocks, found faults or grids, in a file with its own hash.
    Hashed,
    Parameterization,
    /// Candidates; those that wait for an undo have their key in the name.
    Candidates(Option<&'a str>),
    Proposals,
}

impl<'a> Computed<'a> {
    /// What a file of `derived/` is; `None` for one that is not ours.
    fn of(name: &'a str) -> Option<Self> {
        let between = |start: &str, end: &str| name.strip_prefix(start)?.strip_suffix(end);
        if ["blocks-", "found-faults-", "grids-"].into_iter().any(|kind| between(kind, ".bin").is_some()) {
            return Some(Self::Hashed);
        }
        if between("fault-proposals-", ".json").is_some() {
            return Some(Self::Proposals);
        }
        match name {
            "parameterization.zarr" => Some(Self::Parameterization),
            "candidates.zarr" => Some(Self::Candidates(None)),
            _ => between("candidates-", ".zarr").map(|key| Self::Candidates(Some(key))),
        }
    }

    fn result(&self) -> Outcome {
        match self {
            Self::Hashed | Self::Parameterization => Outcome::Parameterization,
            Self::Candidates(_) => Outcome::Candidates,
            Self::Proposals => Outcome::FaultProposals,
        }
    }

    fn is_folder(&self) -> bool {
        matches!(self, Self::Parameterization | Self::Candidates(_))
    }

    /// Reads all of it.
    fn verify(&self, path: &Path, progress: &Progress) -> Result<(), ProjectError> {
        let malformed = |detail: String| ProjectError::Malformed { path: path.to_owned(), detail };
        match self {
            Self::Hashed => derived::verify_kept(path).map_err(|error| match file::says_nothing(&error) {
                true => ProjectError::io(FileAction::Read, path, error),
                false => malformed(error.to_string()),
            }),
            Self::Parameterization => Ok(StoredParameterization::open(path)?.verify(progress)?),
            Self::Candidates(key) => {
                let stored = StoredCandidates::open(path)?;
                stored.verify(progress)?;
                // The trees must hang together, too.
                extraction::check_forest(&stored, &progress.muted())?;
                match key.filter(|key| *key != stored.info().key) {
                    None => Ok(()),
                    Some(_) => Err(malformed(format!("it holds the extraction {}", stored.info().key))),
                }
            }
            Self::Proposals => proposals::verify(path),
        }
    }
}

/// Verifies everything in `derived/`, and reports what a state needs there and does not find.
pub(super) fn check(
    root: &Path,
    states: &States,
    report: &mut CheckReport,
    progress: &Progress,
) -> Result<(), ProjectError> {
    let document = newest(states);
    let names = match storage::list(&root.join(storage::DERIVED)) {
        Ok(names) => names,
        // Which of them is there cannot be told either.
        Err(error) => {
            let (file, what) = (storage::DERIVED.to_owned(), "what was computed".to_owned());
            report.unread.push(Unread { file, what, reason: format!("it cannot be read: {error}") });
            return Ok(());
        }
    };
    for name in names {
        let Some(computed) = Computed::of(&name) else { continue };
        let file = format!("{}/{name}", storage::DERIVED);
        report.derived_files += 1;
        progress.begin(&format!("checking {file}"), 1);
        let path = root.join(&file);
        let found = confirmed(&path, || match is_there(root, &file, computed.is_folder()) {
            Ok(()) => outcome(computed.verify(&path, progress)),
            Err(finding) => Ok(Err(finding)),
        })?;
        let what = computed.result().to_string();
        match found {
            Ok(()) => {}
            Err(Finding::Unread(reason)) => report.unread.push(Unread { file, what, reason }),
            Err(Finding::Damaged(reason)) => report.damage.push(Damage {
                part: Part::Derived,
                what,
                dependants: document.map(|document| dependants(&computed, document)).unwrap_or_default(),
                cures: vec![Cure::Recompute { result: computed.result() }],
                ..Damage::of(file, reason)
            }),
        }
    }
    let is_missing = |document: &Document| {
        document.extraction.is_some()
            && matches!(extraction::candidates_path(root, document), Err(ProjectError::NotExtracted))
    };
    if states.present().is_some_and(is_missing) {
        report.notes.push("the horizon candidates of the present state are not there: extract them again".to_owned());
    }
    Ok(())
}

/// What cannot be done until derived data are computed again.
fn dependants(computed: &Computed, document: &Document) -> Vec<String> {
    let Computed::Candidates(key) = computed else { return Vec::new() };
    let present = document.extraction.as_ref().map(|entry| entry.key.as_str());
    let wanted = key.or(present);
    let picked = document.horizons.iter().filter(|entry| {
        let mut picks = entry.assembly.iter().flat_map(|log| &log.picks);
        picks.any(|pick| Some(pick.extraction.as_str()) == wanted)
    });
    picked.map(|entry| format!("the picks of horizon \"{}\"", entry.name)).collect()
}
