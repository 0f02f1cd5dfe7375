//! Volumes whose bricks stay in object storage.

use super::{Effect, Noun, ProjectError};
use crate::content::volume_facts::{self, Facts};
use crate::document::{Origin, Polarity};
use crate::folder::Draft;
use crate::placement;
use serde::{Deserialize, Serialize};
use survey::{Progress, SurveyGeometry};

/// Takes a volume of this program in object storage into the project, without copying its bricks: they are read as they
/// are needed. The first volume defines the survey geometry; others must lie in it.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct LinkVolume {
    /// Its address, such as `s3://bucket/path/NAME.zarr`.
    pub url: String,
    /// Name of the volume; `None`: "seismic" for the first one, otherwise the last part of the address.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub name: Option<String>,
    /// What a positive amplitude means.
    #[serde(default)]
    pub polarity: Polarity,
}

impl LinkVolume {
    pub(super) fn execute(&self, draft: &mut Draft, progress: &Progress) -> Result<Effect, ProjectError> {
        let last = self.url.trim_end_matches('/').rsplit('/').next().unwrap_or_default();
        let name = match &self.name {
            Some(name) => name.clone(),
            None if draft.document.volumes.is_empty() => "seismic".to_owned(),
            None => last.trim_end_matches(".zarr").to_owned(),
        };
        draft.document.check_new_name(Noun::Volume, &name)?;
        let (file, path) = draft.generation("volumes", &name, "zarr")?;
        let linked = store::link_volume(&path, &self.url, progress)?;
        let geometry = linked.info().geometry.clone();
        let own = match &draft.document.geometry {
            None => {
                draft.document.geometry = Some(geometry);
                None
            }
            Some(frame) => {
                placement::covers(frame, &geometry)
                    .map_err(|source| ProjectError::Placement { name: name.clone(), source })?;
                // The project states the velocity, wherever the lattice comes from.
                let velocity_m_s = frame.velocity_m_s;
                (*frame != SurveyGeometry { velocity_m_s, ..geometry.clone() }).then_some(geometry)
            }
        };
        let facts = Facts {
            name: name.clone(),
            file,
            polarity: self.polarity,
            origin: Origin::Linked { url: self.url.clone() },
            geometry: own,
        };
        draft.document.volumes.push(volume_facts::entry(&path, facts, progress)?);
        Ok(Effect::Changed { summary: format!("linked volume {name} to {}", self.url) })
    }
}
