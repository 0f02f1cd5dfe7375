//! Attribute volumes that are computed from a volume.

use super::{Effect, Noun, ProjectError};
use crate::content;
use crate::content::volume_facts::{self, Facts};
use crate::derived::FaultBlocks;
pub use crate::document::AttributeKind;
use crate::document::{Origin, Polarity};
use crate::folder::Draft;
use crate::interpretation::times::time_volume;
use crate::memory_budget;
use ::time::Cut;
use attribute::blocks::{
    AttributeBlocks, dip_angle_blocks, dip_blocks, envelope_blocks, fault_likelihood_blocks, semblance_blocks,
};
use attribute::{AttributeError, DipSettings, SemblanceSettings};
use serde::{Deserialize, Serialize};
use std::path::Path;
use store::{StoreError, StoredVolume, VolumeInfo, write_blocks};
use survey::{Progress, SurveyGeometry};

/// Computes an attribute of a volume and adds it to the project.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct ComputeAttribute {
    /// What to compute.
    pub kind: AttributeKind,
    /// Name of the new volume. A dip is its angle from the horizontal in degrees, and `NAME-inline` and
    /// `NAME-crossline` are added, in samples a line.
    pub name: String,
    /// The volume to compute it from; `None`: the first.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub volume: Option<String>,
    /// Settings for finding dips.
    #[serde(default)]
    pub dip: DipSettings,
    /// Settings for computing semblance.
    #[serde(default)]
    pub semblance: SemblanceSettings,
    /// Memory to use, bytes; `None`: half of what is available. It is not recorded, since the result does not depend on
    /// it.
    #[serde(skip)]
    pub memory_bytes: Option<u64>,
}

/// The report of a computed attribute.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct AttributeComputed {
    /// The attribute.
    pub attribute: &'static str,
    /// The volume it was computed from.
    pub of: String,
    /// Names of the new volumes, with their units.
    pub volumes: Vec<(String, Option<String>)>,
}

impl ComputeAttribute {
    pub(super) fn execute(&self, draft: &mut Draft, progress: &Progress) -> Result<Effect, ProjectError> {
        let position = match &self.volume {
            Some(volume) => draft.document.position(Noun::Volume, volume)?,
            None if draft.document.volumes.is_empty() => return Err(ProjectError::NoVolume),
            None => 0,
        };
        let from = match self.kind {
            AttributeKind::Hiatus => time_volume(&draft.document)?.clone(),
            _ => draft.document.volumes[position].clone(),
        };
        let source = content::open_recorded(draft.root(), &from, draft.document.frame()?)?;
        let geometry =
            SurveyGeometry { velocity_m_s: draft.document.frame()?.velocity_m_s, ..source.info().geometry.clone() };
        let mut places = Vec::new();
        for (suffix, unit) in self.parts() {
            let name = format!("{}{suffix}", self.name);
            draft.document.check_new_name(Noun::Volume, &name)?;
            let (file, path) = draft.generation("volumes", &name, "zarr")?;
            let info = VolumeInfo {
                quantity: Some(format!("{}{}", self.kind.name(), suffix.replace('-', " ")).into()),
                unit: unit.map(str::to_owned),
                source: Some(format!("{} of {}", self.kind.name(), from.name)),
                ..VolumeInfo::of(geometry.clone())
            };
            places.push((name, file, path, info));
        }
        let memory_bytes = self.memory_bytes.unwrap_or_else(memory_budget::half_of_available);
        let out: Vec<(&Path, &VolumeInfo)> = places.iter().map(|(_, _, path, info)| (path.as_path(), info)).collect();
        match self.kind {
            AttributeKind::Envelope => write(out[0], envelope_blocks(&source), memory_bytes, progress)?,
            AttributeKind::Semblance => {
                write(out[0], semblance_blocks(&source, &self.dip, &self.semblance), memory_bytes, progress)?;
            }
            AttributeKind::FaultLikelihood => {
                write(out[0], fault_likelihood_blocks(&source, &geometry), memory_bytes, progress)?;
            }
            AttributeKind::Throw => write(out[0], faults::throw_blocks(&source, &geometry), memory_bytes, progress)?,
            AttributeKind::Dip => {
                let [inline, crossline] = dip_blocks(&source, &self.dip)?;
                write(out[1], inline, memory_bytes, progress)?;
                write(out[2], crossline, memory_bytes, progress)?;
                let [inline, crossline] = [StoredVolume::open(out[1].0)?, StoredVolume::open(out[2].0)?];
                write(out[0], dip_angle_blocks(&inline, &crossline, &out[0].1.geometry), memory_bytes, progress)?;
            }
            AttributeKind::Hiatus => {
                let frame = draft.document.frame()?;
                let tau = content::read_volume(draft.root(), &from, frame, progress)?;
                let network = draft.facts().get(&FaultBlocks, progress)?;
                let rates = ::time::rates(&tau, &Cut::of_network(&network, tau.size()));
                store::write_volume(out[0].0, &rates, out[0].1, progress)?;
            }
            AttributeKind::Flattened => {
                if from.geometry.is_some() {
                    return Err(ProjectError::OtherLattice { volume: from.name });
                }
                let frame = draft.document.frame()?;
                let times = time_volume(&draft.document)?;
                let tau = content::read_volume(draft.root(), times, frame, progress)?;
                let volume = content::read_volume(draft.root(), &from, frame, progress)?;
                store::write_volume(out[0].0, &::time::flattened(&tau, &volume), out[0].1, progress)?;
            }
        }
        let mut volumes = Vec::new();
        for (name, file, path, info) in places {
            let facts = Facts {
                name: name.clone(),
                file,
                polarity: Polarity::default(),
                origin: Origin::Attribute { attribute: self.kind, of: from.name.clone() },
                geometry: from.geometry.clone(),
            };
            draft.document.volumes.push(volume_facts::entry(&path, facts, progress)?);
            volumes.push((name, info.unit));
        }
        Ok(Effect::AttributeComputed(AttributeComputed { attribute: self.kind.name(), of: from.name, volumes }))
    }

    /// The volumes that it produces: the suffix of each name, and the unit.
    fn parts(&self) -> Vec<(&'static str, Option<&'static str>)> {
        match self.kind {
            AttributeKind::Dip => vec![
                ("", Some("degrees")),
                ("-inline", Some("samples per inline")),
                ("-crossline", Some("samples per crossline")),
            ],
            AttributeKind::Hiatus => vec![("", Some("times the median"))],
            AttributeKind::Throw => vec![("", Some("samples"))],
            AttributeKind::Semblance
            | AttributeKind::Envelope
            | AttributeKind::FaultLikelihood
            | AttributeKind::Flattened => vec![("", None)],
        }
    }
}

impl std::fmt::Display for AttributeComputed {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        writeln!(f, "{} of '{}':", self.attribute, self.of)?;
        self.volumes.iter().try_for_each(|(name, unit)| match unit {
            Some(unit) => writeln!(f, "  volume '{name}', {unit}"),
            None => writeln!(f, "  volume '{name}'"),
        })
    }
}

/// Computes an attribute block by block into the store.
fn write(
    (path, info): (&Path, &VolumeInfo),
    mut blocks: AttributeBlocks<'_>,
    memory_bytes: u64,
    progress: &Progress,
) -> Result<(), ProjectError> {
    let memory_bytes = blocks.share_memory(memory_bytes);
    write_blocks(path, &mut blocks, info, memory_bytes, progress).map(|_| ()).map_err(explain)
}

/// An error of the computation, which passes through the writer and is taken out again afterwards.
fn explain(error: StoreError) -> ProjectError {
    let StoreError::Source { path, source } = error else { return error.into() };
    match source.downcast::<AttributeError>() {
        Ok(own) => (*own).into(),
        Err(source) => match source.downcast::<StoreError>() {
            Ok(store) => (*store).into(),
            Err(source) => StoreError::Source { path, source }.into(),
        },
    }
}
