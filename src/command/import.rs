//! Bringing volumes in, and taking them out again.

use super::{Effect, Noun, ProjectError};
use crate::data;
use crate::project::document::{Polarity, VolumeEntry};
use crate::project::{Draft, placement};
use serde::{Deserialize, Serialize};
use std::path::PathBuf;
use survey::segy::{SegyFile, SegyOptions};
use survey::store::{self, VolumeInfo};
use survey::{Progress, SurveyGeometry, Volume};

/// Reads a SEG-Y volume into the project. The first one gives the survey frame; others must lie in it.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct ImportVolume {
    /// The file.
    pub path: PathBuf,
    /// Name of the volume; absent: "seismic" for the first one, else the file's name.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub name: Option<String>,
    /// What a positive amplitude means.
    #[serde(default)]
    pub polarity: Polarity,
    /// What the user states about the file.
    #[serde(default)]
    pub options: SegyOptions,
}

/// What an import did.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct VolumeImported {
    /// Name of the volume.
    pub volume: String,
    /// Counts of inlines, crosslines and samples.
    pub size: [usize; 3],
    /// Traces there are.
    pub traces: usize,
    /// Places of the lattice without a trace.
    pub missing_traces: usize,
    /// What a positive amplitude means.
    pub polarity: Polarity,
    /// Value at which colours are clipped.
    pub clip: f32,
    /// How geometry and units were found.
    pub evidence: Vec<String>,
    /// What had to be assumed.
    pub assumptions: Vec<String>,
}

/// Takes a volume away.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct RemoveVolume {
    /// Its name.
    pub name: String,
}

/// Share of the samples that a colour map shows unclipped.
const SHOWN_SHARE: f32 = 0.99;

impl ImportVolume {
    pub(super) fn execute(&self, draft: &mut Draft, progress: &Progress) -> Result<Effect, ProjectError> {
        let name = self.name_in(draft);
        draft.document.check_new_name(Noun::Volume, &name)?;
        let file = SegyFile::open(&self.path, &self.options, progress)?;
        let geometry = file.geometry()?;
        if let Some(frame) = &draft.document.geometry {
            placement::covers(frame, &geometry)
                .map_err(|source| ProjectError::Placement { name: name.clone(), source })?;
        }
        let read = file.read(progress)?;
        read.info.warnings.iter().for_each(|warning| progress.warn(warning));
        let hash = data::hash_volume(&read.volume, progress)?;
        let (file, new) = draft.generation("volumes", &name, "zarr");
        let info = VolumeInfo {
            polarity: Some(self.polarity.to_string()),
            source: Some(self.path.display().to_string()),
            ..VolumeInfo::of(geometry.clone())
        };
        store::write_volume(&new, &read.volume, &info, progress)?;
        let own = match &draft.document.geometry {
            None => {
                draft.document.geometry = Some(geometry);
                None
            }
            // The velocity is the project's to state, wherever the lattice is from.
            Some(frame) if is_same_lattice(frame, &geometry) => None,
            Some(_) => Some(geometry),
        };
        let clip = clip_of(&read.volume);
        draft.document.volumes.push(VolumeEntry {
            name: name.clone(),
            file,
            hash,
            polarity: self.polarity,
            clip,
            lowest: read.amplitudes.min,
            source: super::source_of(&self.path, reading(&read.info))?,
            geometry: own,
        });
        Ok(Effect::VolumeImported(VolumeImported {
            volume: name,
            size: read.volume.size(),
            traces: read.info.traces,
            missing_traces: read.info.missing_traces,
            polarity: self.polarity,
            clip,
            evidence: read.info.evidence,
            assumptions: read.info.assumptions,
        }))
    }

    fn name_in(&self, draft: &Draft) -> String {
        match &self.name {
            Some(name) => name.clone(),
            None if draft.document.volumes.is_empty() => "seismic".to_owned(),
            None => self.path.file_stem().map_or_else(String::new, |stem| stem.to_string_lossy().into_owned()),
        }
    }
}

/// Whether two lattices are one but for the velocity.
fn is_same_lattice(a: &SurveyGeometry, b: &SurveyGeometry) -> bool {
    let velocity_m_s = a.velocity_m_s;
    *a == (SurveyGeometry { velocity_m_s, ..b.clone() })
}

/// Byte positions and units in one line, for the record.
fn reading(info: &survey::segy::SegyInfo) -> String {
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

/// The value that most samples of live traces do not exceed in size; 1 where all are zero.
fn clip_of(volume: &Volume<f32>) -> f32 {
    let [inlines, crosslines, _] = volume.size();
    let live =
        (0..inlines * crosslines).map(|n| (n / crosslines, n % crosslines)).filter(|&(x, y)| volume.is_live(x, y));
    let mut samples: Vec<f32> = live.flat_map(|(x, y)| volume.trace(x, y)).copied().collect();
    if samples.len() > SAMPLES_ENOUGH {
        let step = samples.len() / SAMPLES_ENOUGH;
        samples = samples.into_iter().step_by(step).collect();
    }
    ttf::symmetric_clip(&samples, SHOWN_SHARE).unwrap_or(1.0)
}

/// So many samples give a percentile to three digits; more would only take longer.
const SAMPLES_ENOUGH: usize = 1 << 20;

impl RemoveVolume {
    pub(super) fn execute(&self, draft: &mut Draft) -> Result<Effect, ProjectError> {
        let index = draft.document.position(Noun::Volume, &self.name)?;
        let style = &mut draft.document.style;
        style.scalars.retain(|function| function.volume != self.name);
        style.raw = style.raw.take().filter(|raw| raw.volume != self.name);
        draft.document.volumes.remove(index);
        Ok(Effect::Changed { summary: format!("no volume {}", self.name) })
    }
}
