//! The faces of a block that are seen, each with the section of the model on it: what labels are placed by.

use super::visible::{seen_faces, seen_pieces};
use crate::camera::View;
use crate::scene::Scene;
use crate::visible::Solid;
use glam::DVec2;
use model::StructuralModel;
use model::section::Section;
use rayon::prelude::*;
use survey::SurveyGeometry;

/// A face that looks at the camera, and what is on it.
#[derive(Debug, Clone)]
pub struct SeenSection {
    /// Axis nearest to its normal: 0 along inlines' numbers, 1 along crosslines', 2 = seen as a map.
    pub axis: usize,
    /// Layers and lines on the whole of its rectangle.
    pub section: Section,
    /// The part that no other face hides, in convex pieces that only share edges, pixels of the scene.
    pub pieces: Vec<Vec<DVec2>>,
}

/// The seen faces of a scene, back to front. What lies in the air above a ground counts as rock, so that a piece is
/// never larger than what is seen.
///
/// A block seen from a corner shows its upper face and two sides:
/// ```
/// use glam::DVec3;
/// use model::{ModelSettings, StructuralModel};
/// use render::{Scene, vector::seen_sections};
/// use survey::{Progress, SurveyGeometry, VerticalUnit};
/// use synth::closed_form::ClosedForm;
///
/// let geometry = SurveyGeometry::regular([11, 11, 40], 25.0, 10.0, VerticalUnit::Metres);
/// let form = ClosedForm::flat(&geometry, &[10.0]);
/// let (settings, progress) = (ModelSettings::default(), Progress::silent());
/// let model = StructuralModel::build(&geometry, &form.stratigraphy, &form.horizons, &[], &settings, &progress)?;
/// let seen = seen_sections(&Scene::default(), &geometry, &model);
/// assert_eq!(seen.len(), 3);
/// assert!(seen.iter().filter(|face| face.axis < 2).all(|face| face.section.layers.len() == 2));
/// # Ok::<(), model::ModelError>(())
/// ```
pub fn seen_sections(scene: &Scene, geometry: &SurveyGeometry, model: &StructuralModel) -> Vec<SeenSection> {
    sections_of(&scene.solid(geometry), &scene.view(geometry), model)
}

/// The same of a solid that a view looks at.
pub fn sections_of(solid: &Solid, view: &View, model: &StructuralModel) -> Vec<SeenSection> {
    let faces = seen_faces(solid, view);
    let seen = (0..faces.len()).into_par_iter().filter_map(|index| {
        let face = &faces[index];
        let pieces = seen_pieces(&faces, index, view, false).unwrap_or_else(|| face.quads(view));
        let section = || Section::new(model, &face.face.section_plane());
        (!pieces.is_empty()).then(|| SeenSection { axis: face.face.nearest_axis(), section: section(), pieces })
    });
    seen.collect()
}
