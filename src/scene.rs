//! Which view of a project is drawn when nothing else is said.

use crate::error::{Noun, ProjectError};
use crate::project::Document;
use render::{Ground, Scene};

/// The scene of that name; without a name the project's first scene, or else the default view.
///
/// # Errors
/// No such scene, or no survey frame to draw in.
pub fn choose(document: &Document, name: Option<&str>) -> Result<Scene, ProjectError> {
    match (name, document.scenes.first()) {
        (Some(name), _) => {
            let index = document.position(Noun::Scene, name)?;
            Ok(document.scenes[index].scene.clone())
        }
        (None, Some(first)) => Ok(first.scene.clone()),
        (None, None) => default_view(document),
    }
}

/// A three-quarter view with the nearest corner cut off, exaggerated so that flat surveys read as blocks; the topmost of several horizons
/// as ground. Without a volume it is illustrative, without horizons raw.
///
/// # Errors
/// [`ProjectError::NoGeometry`].
pub fn default_view(document: &Document) -> Result<Scene, ProjectError> {
    let geometry = document.frame()?;
    let mut scene = Scene::default();
    let [inlines, crosslines, samples] = geometry.size().map(|count| count.saturating_sub(1).max(1) as f64);
    let width_m = (geometry.inline_vector.length() * inlines).max(geometry.crossline_vector.length() * crosslines);
    let height_m = geometry.sample_m() * samples;
    scene.exaggeration = whole_exaggeration(TARGET_HEIGHT * width_m / height_m);
    if document.horizons.is_empty() {
        scene.blend = 1.0;
    } else {
        // Above a single horizon is half of what there is to see.
        scene.ground = (document.horizons.len() > 1).then(Ground::default);
        let block = scene.box_in(geometry);
        let corner = scene.view(geometry).nearest_corner(&block);
        scene.cut_outs = vec![block.corner_cut(corner, CUT_SHARE)];
    }
    Ok(scene)
}

/// Height of the drawn block over its longer side that the exaggeration aims at: a block, neither a tile nor a tower.
const TARGET_HEIGHT: f64 = 0.45;
/// Shares of the block along inlines and crosslines that the default corner cut takes.
const CUT_SHARE: [f64; 2] = [0.45, 0.45];

/// The nearest exaggeration that is easily said: 1, 1.5, 2, 3, 4, 5, 8, 10 ... never less than 1.
fn whole_exaggeration(wanted: f64) -> f64 {
    const STEPS: [f64; 10] = [1.0, 1.5, 2.0, 2.5, 3.0, 4.0, 5.0, 6.0, 8.0, 10.0];
    let decade = 10f64.powf(wanted.max(1.0).log10().floor());
    let ratio = wanted.max(1.0) / decade;
    let nearest = STEPS.into_iter().min_by(|a, b| (a / ratio).ln().abs().total_cmp(&(b / ratio).ln().abs()));
    decade * nearest.unwrap_or(1.0)
}

#[cfg(test)]
mod tests {
    use super::*;
    use survey::{SurveyGeometry, VerticalUnit};

    #[test]
    fn exaggerations_are_round() {
        for (wanted, said) in [(0.2, 1.0), (1.2, 1.0), (1.3, 1.5), (2.8, 3.0), (9.5, 10.0), (23.0, 25.0), (70.0, 80.0)]
        {
            assert_eq!(whole_exaggeration(wanted), said, "{wanted}");
        }
    }

    #[test]
    fn any_frame_has_a_valid_default_view() {
        for size in [[101, 101, 101], [2, 300, 2], [500, 3, 40]] {
            let geometry = SurveyGeometry::regular(size, 25.0, 4.0, VerticalUnit::Milliseconds);
            let scene = default_view(&Document::empty(Some(geometry.clone()))).unwrap();
            scene.validate(&geometry).unwrap();
            assert_eq!(scene.blend, 1.0);
        }
        assert!(matches!(default_view(&Document::empty(None)), Err(ProjectError::NoGeometry)));
    }
}
