//! Horizon candidates of a project: `derived/candidates.zarr`, extracted once for a volume and settings.
//!
//! The key is the BLAKE3 hash of all the result depends on: the version of the program, the volume's samples, the settings; how many lines are read at a
//! time is not among them. What has another key is not used. Candidates lie on the project's own lattice, so that a
//! voxel of theirs is one of the project's.

use crate::Project;
use crate::derived::Scratch;
use crate::document::VolumeEntry;
use crate::error::ProjectError;
use interp::{ExtractReport, ExtractSettings, Forest, extract_into};
use serde::Serialize;
use std::fmt;
use std::fs::File;
use std::io::{BufWriter, Write};
use std::path::{Path, PathBuf};
use store::{CandidateWriter, Replacement, StoredCandidates, StoredVolume};
use survey::Progress;

/// Inlines of a stored volume that are read at a time: an edge of its bricks.
const SLAB_INLINES: usize = 64;

/// What an extraction did.
#[derive(Debug, Clone, Serialize)]
pub struct Extracted {
    /// Where the candidates are.
    pub file: PathBuf,
    /// The volume they are of.
    pub volume: String,
    /// Identifies volume and settings.
    pub key: String,
    /// Whether anything had to be computed.
    pub computed: bool,
    /// What was found.
    #[serde(flatten)]
    pub report: ExtractReport,
}

impl fmt::Display for Extracted {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(f, "horizon candidates of volume {} in {}", self.volume, self.file.display())?;
        write!(f, "{}", self.report)?;
        if !self.computed {
            writeln!(f, "nothing has changed since they were extracted; the times are those of then")?;
        }
        Ok(())
    }
}

/// The candidates, in `derived/`.
const CANDIDATES: &str = "candidates.zarr";

/// Where a project's candidates are.
pub fn candidates_path(root: &Path) -> PathBuf {
    root.join("derived").join(CANDIDATES)
}

/// The candidates of a project.
///
/// # Errors
/// [`ProjectError::NotExtracted`] when there are none, or damaged data.
pub fn open(project: &Project) -> Result<StoredCandidates, ProjectError> {
    let path = candidates_path(project.root());
    if !path.exists() {
        return Err(ProjectError::NotExtracted);
    }
    Ok(StoredCandidates::open(&path)?)
}

/// What the extraction that made these candidates reported; none where that cannot be read.
pub fn report(candidates: &StoredCandidates) -> Option<ExtractReport> {
    serde_json::from_value(candidates.info().report.clone()).ok()
}

/// Surfaces and trees of a project's candidates.
///
/// # Errors
/// Damaged data, or cancelled.
pub fn forest(candidates: &StoredCandidates, progress: &Progress) -> Result<Forest, ProjectError> {
    Ok(Forest::from_tables(candidates.read_forest(progress)?, candidates.info().size)?)
}

/// The volume to extract from: the one that was named, else the first on the project's lattice.
fn choose<'a>(project: &'a Project, volume: Option<&str>) -> Result<&'a VolumeEntry, ProjectError> {
    let document = project.document();
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

/// Identifies candidates by what they are extracted from.
fn key(entry: &VolumeEntry, settings: &ExtractSettings) -> String {
    // These types hold numbers and strings only, which always serialise.
    let text = serde_json::to_vec(&(env!("CARGO_PKG_VERSION"), &entry.hash, settings)).unwrap_or_default();
    blake3::hash(&text).to_hex()[..32].to_owned()
}

/// Extracts the candidates of a volume of the project, unless they are there.
///
/// # Errors
/// No such volume, settings that make no sense, damaged data, a full disk, or cancelled; former candidates are then still there.
pub fn extract(
    project: &Project,
    volume: Option<&str>,
    settings: &ExtractSettings,
    progress: &Progress,
) -> Result<Extracted, ProjectError> {
    let entry = choose(project, volume)?;
    let mut settings = settings.clone();
    settings.grow.slab_inlines = SLAB_INLINES;
    let (file, key) = (candidates_path(project.root()), key(entry, &settings));
    let answer = |report, computed| Extracted {
        file: file.clone(),
        volume: entry.name.clone(),
        key: key.clone(),
        computed,
        report,
    };
    if let Ok(stored) = StoredCandidates::open(&file)
        && stored.info().key == key
        && let Some(report) = report(&stored)
    {
        return Ok(answer(report, false));
    }
    let source = StoredVolume::open(&project.root().join(&entry.file))?;
    let scratch = Scratch::begin(project.root())?;
    let begin = |size, leaves| Ok(CandidateWriter::create(&scratch.path(CANDIDATES), size, leaves)?);
    let report = extract_into(begin, &key, &source, &settings, progress)?;
    scratch.publish(CANDIDATES)?;
    if let Some(sentence) = report.nothing_found() {
        progress.warn(&sentence);
    }
    Ok(answer(report, true))
}

/// Writes all candidates as points: inline, crossline, z in the vertical unit, leaf and surface, both numbered from 1. A point on the border of
/// leaves is told once, with the least of them. Answers the count of points.
///
/// # Errors
/// No candidates, damaged data, a file that cannot be written, or cancelled.
pub fn export_points(project: &Project, out: &Path, progress: &Progress) -> Result<usize, ProjectError> {
    let forest = forest(&open(project)?, progress)?;
    let frame = project.document().frame()?;
    let mut leaf_of = vec![0u32; forest.surfaces.vertices.len()];
    for (n, &node) in forest.leaves.iter().enumerate() {
        let range = &forest.nodes[node as usize].triangles;
        for &vertex in forest.surfaces.triangles[range.start as usize..range.end as usize].as_flattened() {
            let leaf = &mut leaf_of[vertex as usize];
            if *leaf == 0 {
                *leaf = n as u32 + 1;
            }
        }
    }
    let fail = |source| ProjectError::io("written", out, source);
    let replacement = Replacement::of(out)?;
    let mut file = BufWriter::new(File::create(replacement.path()).map_err(fail)?);
    writeln!(file, "inline,crossline,z,leaf,surface").map_err(fail)?;
    progress.begin("writing candidates", forest.surfaces.surfaces.len() as u64);
    let mut count = 0;
    for (surface, part) in forest.surfaces.surfaces.iter().enumerate() {
        let own = part.vertices.start as usize..part.vertices.end as usize;
        for (vertex, &leaf) in forest.surfaces.vertices[own.clone()].iter().zip(&leaf_of[own]) {
            if leaf != 0 {
                let inline = frame.inlines.number_at(vertex.x.into());
                let crossline = frame.crosslines.number_at(vertex.y.into());
                let z = frame.vertical.value_at(vertex.z.into());
                writeln!(file, "{inline},{crossline},{z:.3},{leaf},{}", surface + 1).map_err(fail)?;
                count += 1;
            }
        }
        progress.step(1)?;
    }
    file.into_inner().map_err(std::io::IntoInnerError::into_error).and_then(|file| file.sync_all()).map_err(fail)?;
    replacement.commit()?;
    Ok(count)
}
