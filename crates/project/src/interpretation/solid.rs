//! The solid model of an interpretation, and the settings with which it is parameterized.

use crate::content;
use crate::document::Document;
use crate::error::ProjectError;
use model::{ModelSettings, StructuralModel};
use param::ParamSettings;
use std::path::Path;
use survey::{Progress, SurveyGeometry, memory};

/// Memory that the model takes at least for each horizon at each trace.
const MODEL_BYTES: usize = 32;

/// Printed length of the block's longer side for which patterns are sized, mm: a picture across a page.
const PRINTED_MM: f64 = 150.0;
/// Printed size of a pattern's tile, mm.
const TILE_MM: f64 = 20.0;

/// The settings with which a project is parameterized: the flow of layers does not follow what is smaller than a
/// pattern's tile.
pub fn param_settings(document: &Document) -> ParamSettings {
    let flow_wave_m = document.geometry.as_ref().map_or(0.0, |geometry| TILE_MM * metres_per_mm(geometry));
    ParamSettings { definitions: document.k_definitions(), flow_wave_m, ..ParamSettings::default() }
}

/// Metres of rock for a printed millimetre, when the block's longer side has its usual width on paper.
pub fn metres_per_mm(geometry: &SurveyGeometry) -> f64 {
    let [x_m, y_m] = extent_m(geometry);
    x_m.max(y_m) / PRINTED_MM
}

/// Lengths of the block along x and y, m.
pub fn extent_m(geometry: &SurveyGeometry) -> [f64; 2] {
    let [nx, ny, _] = geometry.size().map(|count| count.saturating_sub(1).max(1) as f64);
    [geometry.inline_vector.length() * nx, geometry.crossline_vector.length() * ny]
}

/// Builds the model of a state of the project in `root`; `None` without horizons.
///
/// # Errors
/// Data are damaged, the interpretation does not make a solid model, or the user cancelled.
pub fn structural_model(
    root: &Path,
    document: &Document,
    progress: &Progress,
) -> Result<Option<StructuralModel>, ProjectError> {
    if document.horizons.is_empty() {
        return Ok(None);
    }
    let horizons = document.horizons.iter().map(|entry| content::read_horizon(root, entry, progress));
    let horizons = horizons.collect::<Result<Vec<_>, _>>()?;
    let faults = document.faults.iter().map(|entry| content::read_fault(root, entry));
    let faults = faults.collect::<Result<Vec<_>, _>>()?;
    let (geometry, settings) = (document.frame()?, ModelSettings::default());
    let [inlines, crosslines, _] = geometry.size();
    memory::check("the model of the survey", &[inlines, crosslines, horizons.len()], MODEL_BYTES)?;
    let model = StructuralModel::build(geometry, &document.stratigraphy(), &horizons, &faults, &settings, progress)?;
    Ok(Some(model))
}
