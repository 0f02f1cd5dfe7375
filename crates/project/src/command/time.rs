//! Geologic time as a volume of the project.

use super::{Effect, Noun, ProjectError};
use crate::content;
use crate::content::volume_facts::{self, Facts};
use crate::document::{Document, Polarity, Source, VolumeEntry};
use crate::folder::Draft;
use crate::interpretation::assembly;
use crate::interpretation::candidates::{Candidates, amplitudes};
use ::time::{Cut, TimeSettings, find_faults, geologic_time};
use serde::{Deserialize, Serialize};
use std::path::{Path, PathBuf};
use store::VolumeInfo;
use survey::{Progress, Volume};

/// What a volume of geologic time says that it holds.
const QUANTITY: &str = "geologic time";

/// Computes geologic time from the present extraction, its volume and the faults, and adds it to the project.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct ComputeTime {
    /// Name of the new volume.
    pub name: String,
    /// The settings.
    #[serde(default)]
    pub settings: TimeSettings,
}

/// The report of computed geologic time.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct TimeComputed {
    /// The new volume.
    pub volume: String,
    /// The volume of amplitudes.
    pub of: String,
    /// Number of drawn faults that cut it.
    pub faults: usize,
    /// Number of faults that were found, where none is drawn, and cut it.
    pub found: usize,
    /// Share of the voxels at which time is known, 0 to 1.
    pub known: f64,
}

impl std::fmt::Display for TimeComputed {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let Self { volume, of, faults, found, known } = self;
        let (faults, what) = if *faults > 0 { (faults, "drawn") } else { (found, "found") };
        write!(
            f,
            "volume '{volume}': geologic time of '{of}' across {faults} faults that were {what}, known at {:.1} % of the voxels",
            100.0 * known
        )?;
        if *known == 0.0 {
            write!(f, "; there are no candidates to find it from")?;
        }
        Ok(())
    }
}

impl ComputeTime {
    pub(super) fn execute(&self, draft: &mut Draft, progress: &Progress) -> Result<Effect, ProjectError> {
        draft.document.check_new_name(Noun::Volume, &self.name)?;
        let candidates = Candidates::load(draft.root(), &draft.document, progress)?;
        let from = amplitudes(&draft.document)?.clone();
        let geometry = draft.document.frame()?.clone();
        let volume = content::read_volume(draft.root(), &from, &geometry, progress)?;
        let network = assembly::blocks(draft.root(), &draft.document, progress)?;
        let drawn = Cut::of_network(&network, volume.size());
        let found_faults: Vec<Cut> = if drawn.is_empty() {
            let found = find_faults(&volume, &candidates.forest.surfaces, self.settings.fewest_vertices, progress)?;
            found.into_iter().map(|fault| fault.cut).collect()
        } else {
            Vec::new()
        };
        let (faults, found_count) = (drawn.len(), found_faults.len());
        let cuts = if drawn.is_empty() { found_faults } else { drawn };
        let found = geologic_time(&volume, &candidates.forest.surfaces, &cuts, &self.settings, progress)?;
        let (file, path) = draft.generation("volumes", &self.name, "zarr")?;
        let info = VolumeInfo {
            quantity: Some(QUANTITY.to_owned()),
            unit: Some("samples".to_owned()),
            source: Some(format!("{QUANTITY} of {}", from.name)),
            ..VolumeInfo::of(geometry)
        };
        store::write_volume(&path, &found.tau, &info, progress)?;
        let facts = Facts {
            name: self.name.clone(),
            file,
            polarity: Polarity::default(),
            source: Source {
                path: PathBuf::from(&from.file),
                bytes: from.source.bytes,
                reading: format!("{QUANTITY} of the volume {}", from.name),
            },
            geometry: None,
        };
        draft.document.volumes.push(volume_facts::entry(&path, facts, progress)?);
        Ok(Effect::TimeComputed(TimeComputed {
            volume: self.name.clone(),
            of: from.name,
            faults,
            found: found_count,
            known: found.known,
        }))
    }
}

/// Whether a project has a volume of geologic time, by its record alone.
pub fn has_time(document: &Document) -> bool {
    document.volumes.iter().any(|entry| entry.source.reading.starts_with(QUANTITY))
}

/// The newest volume of geologic time.
pub(super) fn time_volume(root: &Path, document: &Document) -> Result<VolumeEntry, ProjectError> {
    for entry in document.volumes.iter().rev().filter(|entry| entry.geometry.is_none()) {
        let stored = content::open_volume(root, entry, document.frame()?)?;
        if stored.info().quantity.as_deref() == Some(QUANTITY) {
            return Ok(entry.clone());
        }
    }
    Err(ProjectError::NoTime)
}

/// Reads the newest geologic time and the amplitudes that it is of.
///
/// # Errors
/// [`ProjectError::NoTime`], data are damaged, or the user cancelled.
pub fn read_time(
    root: &Path,
    document: &Document,
    progress: &Progress,
) -> Result<(Volume<f32>, Volume<f32>), ProjectError> {
    let frame = document.frame()?;
    let tau = content::read_volume(root, &time_volume(root, document)?, frame, progress)?;
    Ok((tau, content::read_volume(root, amplitudes(document)?, frame, progress)?))
}
