//! i, j, k from another program in place of those computed here.

use super::{Effect, ProjectError};
use crate::content;
use crate::derived;
use crate::document::ParameterizationEntry;
use crate::folder::Draft;
use crate::interpretation::solid;
use param::Parameterization;
use serde::{Deserialize, Serialize};
use std::path::PathBuf;
use store::{ParameterizationVolumes, StoredParameterization};
use survey::Progress;

/// Takes i, j, k from a file, or computes them here again.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct SetParameterization {
    /// A Zarr v3 group with arrays i, j, k, layer and block; `None`: computed here.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub from: Option<PathBuf>,
}

impl SetParameterization {
    pub(super) fn execute(&self, draft: &mut Draft, progress: &Progress) -> Result<Effect, ProjectError> {
        let Some(path) = &self.from else {
            draft.document.parameterization = None;
            return Ok(Effect::Changed { summary: "i, j, k computed here".to_owned() });
        };
        let volumes = StoredParameterization::open_foreign(path)?.read(progress)?;
        let hash = content::hash_parameterization(&volumes);
        let arrays = derived::voxels_of(volumes);
        // Tried on the interpretation before anything is written.
        let Some(model) = solid::structural_model(draft.root(), &draft.document, progress)? else {
            return Err(ProjectError::NoLayers);
        };
        let settings = solid::param_settings(&draft.document);
        let (_, taken) = Parameterization::of_volumes(&model, &arrays, &settings, progress)?;
        let name = path.file_stem().map_or_else(String::new, |stem| stem.to_string_lossy().into_owned());
        let (file, new) = draft.generation("parameterizations", &name, "zarr")?;
        let size = arrays.size;
        let volumes =
            ParameterizationVolumes { i: arrays.i, j: arrays.j, k: arrays.k, layer: arrays.layer, block: arrays.block };
        store::write_parameterization(&new, &volumes, &hash, progress)?;
        let reading = format!("i, j, k, layer and block at {} x {} x {}", size[0], size[1], size[2]);
        let source = super::source_of(path, reading)?;
        draft.document.parameterization = Some(ParameterizationEntry { name, file, hash, source });
        let summary = format!(
            "i, j, k of {}: {:.1} % of its samples lie in the same layer, {:.1} % of the nodes beside one",
            path.display(),
            100.0 * taken.agreeing,
            100.0 * taken.covered
        );
        Ok(Effect::Changed { summary })
    }
}
