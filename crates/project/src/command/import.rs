//! Importing and removing volumes.

use super::{Effect, Noun, ProjectError, array_volume, stored_volume};
use crate::content::volume_facts::{self, Facts};
use crate::document::{Origin, Polarity};
use crate::folder::{Draft, IMPORTING};
use crate::memory_budget;
use crate::placement;
use files::NpyVolume;
use files::segy::{SegyFile, SegyOptions};
use serde::{Deserialize, Serialize};
use std::fs;
use std::path::{Path, PathBuf};
use store::{Ingested, StoreError, VolumeInfo, resume_blocks};
use survey::{Note, Progress, SurveyGeometry};
use system::file::FileAction;

/// Reads a volume into the project: a SEG-Y file, or a folder in which a volume is stored as this program stores them
/// (see `stored_volume.rs`), or a NumPy array on the lattice of the project (`array_volume.rs`). The first volume defines the survey geometry; others must lie in it.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct ImportVolume {
    /// The file or folder.
    pub path: PathBuf,
    /// Name of the volume; `None`: "seismic" for the first one, otherwise the file's name.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub name: Option<String>,
    /// What a positive amplitude means.
    #[serde(default)]
    pub polarity: Polarity,
    /// What the user states about the file.
    #[serde(default)]
    pub options: SegyOptions,
    /// Where a stored volume came from, if whoever stored it says so; `None`: from its folder.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub origin: Option<Origin>,
    /// Memory to use, bytes; `None`: half of what is available. It is not recorded, since the result does not depend on
    /// it.
    #[serde(skip)]
    pub memory_bytes: Option<u64>,
    /// Move a stored volume instead of copying it: whoever wrote it did so for this project alone. It lies on the
    /// project's disk.
    #[serde(skip)]
    pub moved: bool,
}

/// The report of an import.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct VolumeImported {
    /// Name of the volume.
    pub volume: String,
    /// Counts of inlines, crosslines and samples.
    pub size: [usize; 3],
    /// Number of traces.
    pub traces: usize,
    /// Number of places of the lattice without a trace.
    pub missing_traces: usize,
    /// Type that the samples are stored in.
    pub sample_type: String,
    /// Number of the volume's files that an interrupted import of the same file had written already.
    pub kept_files: usize,
    /// What a positive amplitude means.
    pub polarity: Polarity,
    /// Value at which colours are clipped.
    pub clip: f32,
    /// How geometry and units were detected.
    pub evidence: Vec<Note>,
    /// What was assumed.
    pub assumptions: Vec<Note>,
}

impl ImportVolume {
    pub(super) fn execute(&self, draft: &mut Draft, progress: &Progress) -> Result<Effect, ProjectError> {
        let name = self.name_in(draft);
        draft.document.check_new_name(Noun::Volume, &name)?;
        if self.path.is_dir() {
            return stored_volume::execute(self, name, draft, progress);
        }
        if NpyVolume::is_one(&self.path) {
            return array_volume::execute(self, name, draft, progress);
        }
        let file = SegyFile::open(&self.path, &self.options, progress)?;
        let geometry = file.geometry()?;
        if let Some(frame) = &draft.document.geometry {
            placement::covers(frame, &geometry)
                .map_err(|source| ProjectError::Placement { name: name.clone(), source })?;
        }
        file.info().warnings.iter().for_each(|warning| progress.warn(warning.clone()));
        let (stored_as, new) = draft.generation("volumes", &name, "zarr")?;
        let folder = draft.root().join(IMPORTING);
        let ingested = self.ingest(&file, &geometry, &folder, &new, progress);
        if ingested.is_err() {
            // Only an import whose program was killed leaves files with which the next one can continue; an import that
            // was cancelled or ran out of space leaves none.
            let _ = fs::remove_dir_all(&folder);
        }
        let ingested = ingested?;
        let own = own_lattice(draft, geometry);
        let info = file.info();
        let facts = Facts {
            name: name.clone(),
            file: stored_as,
            polarity: self.polarity,
            origin: super::imported(&self.path, reading(info))?,
            geometry: own,
        };
        let entry = volume_facts::entry(&new, facts, progress)?;
        let clip = entry.clip;
        draft.document.volumes.push(entry);
        Ok(Effect::VolumeImported(VolumeImported {
            volume: name,
            size: file.size(),
            traces: info.traces,
            missing_traces: info.missing_traces,
            sample_type: file.sample_type().name().to_owned(),
            kept_files: ingested.kept,
            polarity: self.polarity,
            clip,
            evidence: info.evidence.clone(),
            assumptions: info.assumptions.clone(),
        }))
    }

    /// Writes the file's samples to the store at `new`, through the folder `folder`.
    fn ingest(
        &self,
        file: &SegyFile,
        geometry: &SurveyGeometry,
        folder: &Path,
        new: &Path,
        progress: &Progress,
    ) -> Result<Ingested, ProjectError> {
        let partial = folder.join(new.file_name().unwrap_or_default());
        keep_only(folder, &partial);
        let done = self.ingest_into(file, geometry, &partial, progress)?;
        fs::rename(&partial, new).map_err(|source| ProjectError::io(FileAction::Written, new, source))?;
        // The folder is empty now; leaving it behind does no harm.
        let _ = fs::remove_dir(folder);
        Ok(done)
    }

    fn ingest_into(
        &self,
        file: &SegyFile,
        geometry: &SurveyGeometry,
        partial: &Path,
        progress: &Progress,
    ) -> Result<Ingested, ProjectError> {
        let info = VolumeInfo {
            polarity: Some(self.polarity.to_string()),
            source: Some(self.path.display().to_string()),
            ..VolumeInfo::of(geometry.clone())
        };
        let memory_bytes = self.memory_bytes.unwrap_or_else(memory_budget::half_of_available);
        let fingerprint = self.fingerprint(file)?;
        let mut blocks = file.blocks();
        let done = resume_blocks(partial, &fingerprint, &mut blocks, &info, memory_bytes, progress)
            .map_err(cancelled_within)?;
        // What was read before a change of the file and after it is no one volume.
        file.check_unchanged()?;
        let non_finite = blocks.non_finite();
        if done.kept > 0 {
            progress.warn(format!(
                "continued an interrupted import of this file: {} of {} files were complete already",
                done.kept, done.files
            ));
        }
        if non_finite > 0 {
            progress.warn(format!("{non_finite} samples are not numbers (NaN or infinite): no data"));
        }
        Ok(done)
    }

    /// Stands for the file as it was when it was opened, and for what was said about it.
    fn fingerprint(&self, file: &SegyFile) -> Result<String, ProjectError> {
        let path =
            fs::canonicalize(&self.path).map_err(|source| ProjectError::io(FileAction::Read, &self.path, source))?;
        let stamp = file.stamp();
        let modified = stamp.and_then(|stamp| stamp.modified?.duration_since(std::time::UNIX_EPOCH).ok());
        Ok(serde_json::json!({
            "path": path,
            "bytes": stamp.map(|stamp| stamp.length),
            "modified_ns": modified.map(|time| time.as_nanos().to_string()),
            "sample_of_bytes": stamp.map(|stamp| stamp.sample),
            "options": self.options,
            "polarity": self.polarity,
            "size": file.size(),
            "type": file.sample_type().name(),
        })
        .to_string())
    }

    fn name_in(&self, draft: &Draft) -> String {
        match &self.name {
            Some(name) => name.clone(),
            None if draft.document.volumes.is_empty() => "seismic".to_owned(),
            None => self.path.file_stem().map_or_else(String::new, |stem| stem.to_string_lossy().into_owned()),
        }
    }
}

/// The lattice of a new volume where it is not the project's, which is taken from the first volume.
pub(super) fn own_lattice(draft: &mut Draft, geometry: SurveyGeometry) -> Option<SurveyGeometry> {
    match &draft.document.geometry {
        None => {
            draft.document.geometry = Some(geometry);
            None
        }
        // The project states the velocity, wherever the lattice comes from.
        Some(frame) if is_same_lattice(frame, &geometry) => None,
        Some(_) => Some(geometry),
    }
}

/// Whether two lattices agree in everything but the velocity.
fn is_same_lattice(a: &SurveyGeometry, b: &SurveyGeometry) -> bool {
    let velocity_m_s = a.velocity_m_s;
    *a == (SurveyGeometry { velocity_m_s, ..b.clone() })
}

/// Byte positions and units in one line, for the record of the source.
fn reading(info: &files::segy::SegyInfo) -> String {
    let bytes = &info.byte_positions;
    let place = match (bytes.x, bytes.y) {
        (Some(x), Some(y)) => format!("X at {x}, Y at {y}"),
        _ => "no coordinates".to_owned(),
    };
    let lines = match (bytes.inline, bytes.crossline) {
        (Some(inline), Some(crossline)) => format!("inline at {inline}, crossline at {crossline}"),
        _ => "lines numbered by X and Y".to_owned(),
    };
    format!("SEG-Y format code {}, {lines}, {place}, vertical in {}", info.format_code, info.vertical_unit.symbol())
}

/// Removes what other imports left in the folder.
fn keep_only(folder: &Path, wanted: &Path) {
    for entry in fs::read_dir(folder).into_iter().flatten().flatten().filter(|entry| entry.path() != wanted) {
        // What cannot be removed is garbage that nothing refers to.
        let _ = fs::remove_dir_all(entry.path());
    }
}

/// Turns a cancellation that the reader noticed into a cancellation, instead of a failure of the source.
pub(super) fn cancelled_within(error: StoreError) -> ProjectError {
    match error {
        StoreError::Source { path, source } => match source.downcast::<files::segy::SegyError>() {
            Ok(segy) => (*segy).into(),
            Err(source) => StoreError::Source { path, source }.into(),
        },
        other => other.into(),
    }
}
