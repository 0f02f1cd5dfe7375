//! The solid model of an interpretation, and the settings with which it is parameterized.

use crate::content;
use crate::derived;
use crate::document::Document;
use crate::error::{Noun, ProjectError};
use crate::facts::{Facts, Query};
use model::{ModelSettings, StructuralModel};
use param::ParamSettings;
use survey::{Progress, SurveyGeometry};
use system::memory;

/// Memory that the model takes at least for each horizon at each trace.
const MODEL_BYTES: usize = 32;

/// Printed length of the block's longer side for which patterns are sized, mm: a picture across a page.
const PRINTED_MM: f64 = 150.0;
/// Printed size of a pattern's tile, mm.
const TILE_MM: f64 = 20.0;

/// Voxels of the largest survey whose coordinates are kept at levels as close as by default. In larger ones levels are
/// farther apart, so that all surveys take at most some 6 GB: waves that the flow follows are as long as a tile, whose size is
/// a share of the survey's, so that they have as many levels as those of a small survey.
const FINE_VOXELS: f64 = (1u64 << 29) as f64;
/// Farthest levels, voxels: the settings allow no more.
const MOST_SPACING: f32 = 64.0;

/// Memory that coordinates take for each voxel, times the spacing of their levels.
const SPACED_BYTES: f64 = 36.0;

/// Checks that the coordinates of a survey's layers fit into memory.
///
/// # Errors
/// [`memory::NotEnough`].
pub(crate) fn check_coordinates(size: [usize; 3], settings: &ParamSettings) -> Result<u64, memory::NotEnough> {
    let voxels = size.iter().map(|&count| count as f64).product::<f64>();
    let bytes = voxels * SPACED_BYTES / f64::from(settings.level_spacing);
    memory::check("the coordinates of layers", &[bytes as usize], 1)
}

/// The settings with which a project is parameterized: the flow of layers does not follow what is smaller than a
/// pattern's tile, but for a geological history, whose horizons are as smooth as they are meant.
pub(crate) fn param_settings(document: &Document) -> ParamSettings {
    let picked = document.geometry.as_ref().filter(|_| document.geological_history.is_none());
    let flow_wave_m = picked.map_or(0.0, |geometry| TILE_MM * metres_per_mm(geometry));
    let voxels = document.geometry.as_ref().map_or(0.0, |geometry| geometry.size().iter().product::<usize>() as f64);
    let spacing = ParamSettings::default().level_spacing;
    let level_spacing = (spacing * (voxels / FINE_VOXELS) as f32).clamp(spacing, MOST_SPACING);
    ParamSettings { definitions: document.k_definitions(), flow_wave_m, level_spacing, ..ParamSettings::default() }
}

/// Metres of rock for a printed millimetre, when the block's longer side has its usual width on paper.
pub fn metres_per_mm(geometry: &SurveyGeometry) -> f64 {
    let [x_m, y_m] = extent_m(geometry);
    x_m.max(y_m) / PRINTED_MM
}

/// Lengths of the block along x and y, m.
pub(crate) fn extent_m(geometry: &SurveyGeometry) -> [f64; 2] {
    let [nx, ny, _] = geometry.size().map(|count| count.saturating_sub(1).max(1) as f64);
    [geometry.inline_vector.length() * nx, geometry.crossline_vector.length() * ny]
}

/// The model of an interpretation.
#[derive(Debug, Clone, Copy)]
pub(crate) struct SolidModel;

impl Query for SolidModel {
    const WHAT: &'static str = "model";
    type Answer = StructuralModel;

    fn key(&self, Facts { document, .. }: Facts<'_>) -> Result<String, ProjectError> {
        // What the model reports names horizons and faults.
        let names = [Noun::Horizon, Noun::Fault].map(|noun| document.names(noun));
        Ok(derived::key_of(&(derived::model_key(document, &ModelSettings::default()), names)))
    }

    fn compute(
        &self,
        Facts { root, document }: Facts<'_>,
        progress: &Progress,
    ) -> Result<StructuralModel, ProjectError> {
        if document.horizons.is_empty() {
            return Err(ProjectError::NoLayers);
        }
        let horizons = document.horizons.iter().map(|entry| content::read_horizon(root, entry, progress));
        let horizons = horizons.collect::<Result<Vec<_>, _>>()?;
        let faults = document.faults.iter().map(|entry| content::read_fault(root, entry));
        let faults = faults.collect::<Result<Vec<_>, _>>()?;
        let (geometry, settings) = (document.frame()?, ModelSettings::default());
        let [inlines, crosslines, _] = geometry.size();
        memory::check("the model of the survey", &[inlines, crosslines, horizons.len()], MODEL_BYTES)?;
        Ok(StructuralModel::build(geometry, &document.stratigraphy(), &horizons, &faults, &settings, progress)?)
    }

    fn bytes(model: &StructuralModel) -> usize {
        let [inlines, crosslines, _] = model.size();
        inlines * crosslines * model.layer_count() * model.block_count() * MODEL_BYTES
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use survey::VerticalUnit;

    #[test]
    fn coordinates_of_any_survey_take_as_much_as_those_of_half_a_billion_voxels() {
        let spacing = |size| {
            let geometry = SurveyGeometry::regular(size, 25.0, 4.0, VerticalUnit::Milliseconds);
            param_settings(&Document::empty(Some(geometry))).level_spacing
        };
        assert_eq!([spacing([20, 30, 40]), spacing([1024, 1024, 512])], [3.0; 2]);
        assert_eq!([spacing([1024; 3]), spacing([2048, 2048, 1024])], [6.0, 24.0]);
        assert_eq!(spacing([15_625, 15_625, 1024]), MOST_SPACING);
        let settings = |level_spacing| ParamSettings { level_spacing, ..ParamSettings::default() };
        let error = check_coordinates([100_000, 100_000, 10_000], &settings(64.0)).unwrap_err();
        assert!(error.to_string().contains("the coordinates of layers"), "{error}");
        assert!(check_coordinates([100; 3], &settings(3.0)).is_ok());
    }
}
