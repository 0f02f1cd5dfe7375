//! Horizon candidates of a project, extracted once for a volume and settings and stored in `derived/` for as long as a
//! state of the history names them: `candidates.zarr` is the present extraction, `candidates-KEY.zarr` are those that
//! undo and redo lead to.
//!
//! The key is the BLAKE3 hash of everything the result depends on: the revision of the method, the volume's
//! samples, the settings. The number of inlines that are read at a time is not part of it. Candidates lie on
//! the project's own lattice, so that their voxels are the project's voxels.

use super::bricks::BrickedExtraction;
pub use super::bricks::{ExtractionPlan, SharedExtraction};
use crate::content;
use crate::derived::{Scratch, key_of, remove_finished, remove_resumable, revision};
use crate::document::{Document, VolumeEntry};
use crate::error::ProjectError;
use crate::folder::{history, storage};
use crate::memory_budget;
use interp::{ExtractReport, ExtractSettings, Forest, Method, extract_into};
use reference::growing;
use serde::Serialize;
use std::fmt;
use std::path::{Path, PathBuf};
use store::{CandidateWriter, StoreError, StoredCandidates, StoredVolume};
use survey::Progress;
use survey::candidates::ForestCounts;
use system::file::FileAction;

/// Number of inlines of a stored volume that are read at a time: the edge length of its bricks.
const SLAB_INLINES: usize = 64;

/// The report of an extraction.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Extracted {
    /// The path of the candidates.
    pub file: PathBuf,
    /// The volume that they were extracted from.
    pub volume: String,
    /// Key: identifies volume, settings and method.
    pub key: String,
    /// Whether anything had to be computed.
    pub computed: bool,
    /// The facts of the extraction.
    #[serde(flatten)]
    pub report: ExtractReport,
}

impl fmt::Display for Extracted {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(f, "horizon candidates of volume {} in {}", self.volume, self.file.display())?;
        write!(f, "{}", self.report)?;
        if !self.computed {
            writeln!(f, "nothing has changed since they were extracted")?;
        }
        Ok(())
    }
}

/// The path in `derived/` of the extraction that the present state names.
const PRESENT: &str = "candidates.zarr";

/// The path in `derived/` of another extraction that a state of the history names.
fn parked(key: &str) -> String {
    format!("candidates-{key}.zarr")
}

/// The key of the candidates stored at a path; `None` if there are none that can be read.
fn key_at(path: &Path) -> Option<String> {
    StoredCandidates::open(path).ok().map(|stored| stored.info().key.clone())
}

/// The path of the extraction that a state names: the present one, or one that waits for an undo. A project from before
/// extractions were part of the history names none and has the one that is stored.
///
/// # Errors
/// [`ProjectError::NotExtracted`] if the state names none or it is missing, [`ProjectError::Store`] if it is damaged.
pub(crate) fn candidates_path(root: &Path, document: &Document) -> Result<PathBuf, ProjectError> {
    let present = root.join(storage::DERIVED).join(PRESENT);
    let Some(entry) = &document.extraction else {
        return if present.exists() { Ok(present) } else { Err(ProjectError::NotExtracted) };
    };
    let waiting = root.join(storage::DERIVED).join(parked(&entry.key));
    if waiting.exists() {
        return Ok(waiting);
    }
    if !present.exists() {
        return Err(ProjectError::NotExtracted);
    }
    // Candidates that cannot be opened are damaged, not absent.
    let stored = StoredCandidates::open(&present)?;
    if stored.info().key == entry.key { Ok(present) } else { Err(ProjectError::NotExtracted) }
}

/// Moves the extraction that the state names to the path of the present one; the former one is stored under its key.
/// Called by whoever holds the project's lock. If it fails, the extraction is still found by its key.
pub(crate) fn make_present(root: &Path, document: &Document) {
    let present = root.join(storage::DERIVED).join(PRESENT);
    let wanted = document.extraction.as_ref().map(|entry| entry.key.as_str());
    let now = key_at(&present);
    if now.as_deref() == wanted {
        return;
    }
    if let Some(now) = now {
        let _ = storage::rename(&present, &root.join(storage::DERIVED).join(parked(&now)));
    }
    if let Some(wanted) = wanted {
        let waiting = root.join(storage::DERIVED).join(parked(wanted));
        if waiting.exists() && !present.exists() {
            let _ = storage::rename(&waiting, &present);
        }
    }
}

/// Removes extractions that no state of the history names any more.
pub(crate) fn forget_unnamed(root: &Path) {
    for file in storage::names_in(&root.join(storage::DERIVED)) {
        let key = file.strip_prefix("candidates-").and_then(|rest| rest.strip_suffix(".zarr"));
        if let Some(key) = key.filter(|key| !history::is_named(root, key)) {
            storage::remove(root, &format!("{}/{}", storage::DERIVED, parked(key)));
        }
    }
}

/// The path of the present extraction.
pub fn present_path(root: &Path) -> PathBuf {
    root.join(storage::DERIVED).join(PRESENT)
}

/// The candidates that a state names.
///
/// # Errors
/// [`ProjectError::NotExtracted`] if there are none, or data are damaged.
pub fn open(root: &Path, document: &Document) -> Result<StoredCandidates, ProjectError> {
    let stored = StoredCandidates::open(&candidates_path(root, document)?)?;
    let (found, expected) = (stored.info().size, document.frame()?.size());
    if found != expected {
        return Err(ProjectError::OtherSize { name: "horizon candidates".to_owned(), expected, found });
    }
    Ok(stored)
}

/// The report of the extraction that made these candidates, without times; `None` if it cannot be read.
pub fn report(candidates: &StoredCandidates) -> Option<ExtractReport> {
    let report: ExtractReport = serde_json::from_value(candidates.info().report.clone()).ok()?;
    // Earlier versions stored the times of then.
    Some(ExtractReport { seconds: None, ..report })
}

/// Memory that all surfaces and trees of candidates take while they are read, bytes.
pub(crate) fn forest_bytes(candidates: &StoredCandidates) -> Result<u64, ProjectError> {
    Ok(bytes_of(candidates.forest_counts()?))
}

/// Memory that surfaces and trees of these counts take, bytes.
pub(crate) fn bytes_of(ForestCounts { vertices, triangles, surfaces, nodes }: ForestCounts) -> u64 {
    (16 * vertices + 12 * triangles + 40 * surfaces + 64 * nodes) as u64
}

/// Surfaces and trees of a project's candidates.
///
/// # Errors
/// They do not fit into memory, data are damaged, or the user cancelled.
pub fn forest(candidates: &StoredCandidates, progress: &Progress) -> Result<Forest, ProjectError> {
    let bytes = usize::try_from(forest_bytes(candidates)?).unwrap_or(usize::MAX);
    system::memory::check("all surfaces of the horizon candidates", &[bytes], 1)?;
    Ok(Forest::from_tables(candidates.read_forest(progress)?, candidates.info().size)?)
}

/// Checks that surfaces and trees hang together, without holding their vertices and triangles.
///
/// # Errors
/// Data are damaged, or the user cancelled.
pub(crate) fn check_forest(candidates: &StoredCandidates, progress: &Progress) -> Result<(), ProjectError> {
    let (surfaces, nodes) = (candidates.read_surfaces(progress)?, candidates.read_nodes(progress)?);
    Forest::check_tables(candidates.forest_counts()?, surfaces, nodes, |rows| {
        progress.check()?;
        Ok(candidates.read_triangles(rows)?)
    })
}

/// The volume to extract from: the one that is named, otherwise the first on the project's lattice.
fn choose<'a>(document: &'a Document, volume: Option<&str>) -> Result<&'a VolumeEntry, ProjectError> {
    let entry = match volume {
        Some(name) => &document.volumes[document.position(crate::error::Noun::Volume, name)?],
        None => {
            let mut own = document.volumes.iter().filter(|entry| entry.geometry.is_none());
            own.next().ok_or(ProjectError::NoVolume)?
        }
    };
    if entry.geometry.is_some() {
        return Err(ProjectError::OtherLattice { volume: entry.name.clone() });
    }
    Ok(entry)
}

/// The key of candidates: a hash of everything that they are extracted from.
fn key(entry: &VolumeEntry, settings: &ExtractSettings) -> String {
    key_of(&(revision::EXTRACTION, &entry.hash, settings))
}

/// Whether stored candidates are read whole before they are used again.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Stored {
    /// They are, and damaged ones are extracted again.
    Verified,
    /// They were a moment ago.
    Trusted,
}

/// The stored candidates of a key with their path and report; `None` if there are none, or they are damaged.
fn find_stored(
    root: &Path,
    key: &str,
    how: Stored,
    progress: &Progress,
) -> Result<Option<(PathBuf, ExtractReport)>, ProjectError> {
    for file in [parked(key), PRESENT.to_owned()] {
        let path = root.join(storage::DERIVED).join(&file);
        let Ok(stored) = StoredCandidates::open(&path) else { continue };
        let Some(report) = report(&stored).filter(|_| stored.info().key == key) else { continue };
        let verified = if how == Stored::Verified { stored.verify(progress) } else { Ok(()) };
        match verified {
            Ok(()) => return Ok(Some((path, report))),
            Err(StoreError::Cancelled(cancelled)) => return Err(cancelled.into()),
            Err(error) => progress.warn(format!("stored candidates are damaged and are extracted again: {error}")),
        }
        if file != PRESENT {
            storage::remove(root, &format!("{}/{file}", storage::DERIVED));
        }
    }
    Ok(None)
}

/// Takes the place of damaged present candidates with those that were extracted again under the same key. Called by
/// whoever holds the project's lock.
pub(crate) fn replace_damaged(root: &Path, document: &Document) {
    let Some(entry) = &document.extraction else { return };
    let again = root.join(storage::DERIVED).join(parked(&entry.key)).exists();
    if again && key_at(&present_path(root)).as_ref() == Some(&entry.key) {
        storage::remove(root, &format!("{}/{PRESENT}", storage::DERIVED));
        make_present(root, document);
    }
}

/// Bytes that an extraction in one piece takes for each voxel.
const BYTES_A_VOXEL: u64 = 31;

/// Whether an extraction takes more memory in one piece than is stated, or, if none is, than half of what is available.
/// Only our own method can be done in bricks.
fn needs_bricks(size: [usize; 3], settings: &ExtractSettings, memory_bytes: Option<u64>) -> bool {
    let needed = size.iter().fold(BYTES_A_VOXEL, |bytes, &n| bytes.saturating_mul(n as u64));
    match memory_bytes {
        Some(stated) => needed > stated,
        None => settings.grow.method == Method::Ours && needed > memory_budget::half_of_available(),
    }
}

/// What is to be extracted.
struct Job<'a> {
    entry: &'a VolumeEntry,
    settings: ExtractSettings,
    key: String,
    source: StoredVolume,
}

impl<'a> Job<'a> {
    fn of(
        root: &Path,
        document: &'a Document,
        volume: Option<&str>,
        settings: &ExtractSettings,
    ) -> Result<Self, ProjectError> {
        let entry = choose(document, volume)?;
        let mut settings = settings.clone();
        settings.grow.slab_inlines = SLAB_INLINES;
        // Before anything that was extracted from these samples is found again by their hash.
        let source = content::open_recorded(root, entry, document.frame()?)?;
        Ok(Self { entry, key: key(entry, &settings), settings, source })
    }
}

/// Begins an extraction whose tasks other processes do; `None` when its candidates are stored, undamaged, already.
/// Bricks have as many traces as fit in `memory_bytes` of one process, and at most `edge` along both axes; an extraction
/// that was interrupted and took as much memory goes on with its own.
///
/// # Errors
/// There is no such volume, the settings are invalid, the memory is too little, or another program does the same.
pub fn share(
    (root, document): (&Path, &Document),
    (volume, settings): (Option<&str>, &ExtractSettings),
    (memory_bytes, edge): (u64, usize),
    progress: &Progress,
) -> Result<Option<SharedExtraction>, ProjectError> {
    let root = std::path::absolute(root).map_err(|source| ProjectError::io(FileAction::Read, root, source))?;
    let job = Job::of(&root, document, volume, settings)?;
    if find_stored(&root, &job.key, Stored::Verified, progress)?.is_some() {
        remove_finished(&root, &job.key);
        return Ok(None);
    }
    let (key, file) = (job.key.as_str(), parked(&job.key));
    let work = BrickedExtraction { root: &root, key, file: &file, source: &job.source, settings: &job.settings };
    work.share(&root.join(&job.entry.file), memory_bytes, edge).map(Some)
}

/// Extracts the candidates of a volume, unless they exist undamaged, and stores them under their key;
/// [`crate::command::Extract`] makes the state that names them. Needs no lock. Takes at most `memory_bytes`, or half of
/// what is available: in bricks, where one piece would take more.
///
/// # Errors
/// There is no such volume, the settings are invalid, data are damaged, the disk is full, or the user cancelled; former
/// candidates are then still there.
pub(crate) fn compute(
    root: &Path,
    document: &Document,
    volume: Option<&str>,
    settings: &ExtractSettings,
    (how, memory_bytes): (Stored, Option<u64>),
    progress: &Progress,
) -> Result<Extracted, ProjectError> {
    let Job { entry, settings, key, source } = Job::of(root, document, volume, settings)?;
    let answer = |file: PathBuf, report, computed| Extracted {
        file,
        volume: entry.name.clone(),
        key: key.clone(),
        computed,
        report,
    };
    if let Some((file, report)) = find_stored(root, &key, how, progress)? {
        // Whoever stored them may have been killed before it had cleaned up.
        remove_finished(root, &key);
        return Ok(answer(file, report, false));
    }
    let size = source.info().geometry.size();
    let file = parked(&key);
    let report = if needs_bricks(size, &settings, memory_bytes) {
        let work = BrickedExtraction { root, key: &key, file: &file, source: &source, settings: &settings };
        work.run(memory_bytes.unwrap_or_else(memory_budget::half_of_available), progress)?
    } else {
        // What an extraction in bricks left is not gone on with any more.
        remove_resumable(root);
        let scratch = Scratch::begin(root)?;
        let begin = |size, leaves| Ok(CandidateWriter::create(&scratch.path(&file), size, leaves)?);
        let report = extract_into(begin, &key, &source, &settings, growing::method(settings.grow.method), progress)?;
        scratch.publish(&file)?;
        report
    };
    if let Some(sentence) = report.nothing_found() {
        progress.warn(&sentence);
    }
    Ok(answer(root.join(storage::DERIVED).join(file), report, true))
}
