//! Whether what a state shows can be drawn: the colours of its volumes, its styles, scenes and figures. A command refuses
//! what cannot; a check tells it of a state that was edited by hand.
//!
//! What renderers check before they draw is asked of the same functions here. Only what follows from a page itself, as
//! whether a figure has room for its parts, is left to the drawing.

use super::{figures, scene};
use crate::document::Document;
use crate::error::ProjectError;
use crate::facts::Facts;
use crate::interpretation::solid;
use crate::styles;
use render::Scene;
use survey::{Progress, SurveyGeometry};
use ttf::{BlockExtent, ColourMap, LayerExtent, TransferFunctions, TtfError, TtfTables};

/// What pictures of a state would refuse, each thing once.
pub(crate) fn refusals(facts: Facts<'_>) -> Vec<String> {
    let document = facts.document;
    let Some(geometry) = &document.geometry else { return Vec::new() };
    // A tile that cannot be read is told where data are.
    let Ok(library) = styles::pattern_library(facts.root, document) else { return Vec::new() };
    let mut found: Vec<String> = Vec::new();
    let mut note = |refusal: String| {
        if !found.contains(&refusal) {
            found.push(refusal);
        }
    };
    for entry in &document.volumes {
        if let Ok(raw) = styles::raw_colour(document, Some(&entry.name), ColourMap::Seismics, None)
            && let Err(error) = raw.function.validate(&place_of(&entry.name))
        {
            note(error.to_string());
        }
    }
    let functions = styles::transfer_functions(document);
    let compiled = |functions: &TransferFunctions| match document.horizons.is_empty() {
        true => functions.validate(&library),
        false => TtfTables::compile(functions, &thinnest(document, geometry), &library).map(drop),
    };
    if let Err(error) = compiled(&functions) {
        note(error.to_string());
    }
    let mut scenes: Vec<(String, Result<Scene, ProjectError>)> =
        document.scenes.iter().map(|entry| (format!("scene \"{}\": ", entry.name), Ok(entry.scene.clone()))).collect();
    if scenes.is_empty() {
        scenes.push(("the view by default: ".to_owned(), scene::choose(document, None)));
    }
    for (name, scene) in scenes {
        let drawn = scene.and_then(|mut scene| {
            scene::prepare(document, &mut scene, &Progress::silent())?;
            Ok(colours_of(&scene)?)
        });
        if let Err(error) = drawn {
            note(format!("{name}{error}"));
        }
    }
    if let Err(error) = figures::check_all(document) {
        note(error.to_string());
    }
    found
}

/// The block with the thinnest layers that are drawn: a sample.
fn thinnest(document: &Document, geometry: &SurveyGeometry) -> BlockExtent {
    let extent = solid::extent_m(geometry);
    let names = document.stratigraphy().layer_names_bottom_up();
    let thickness_m = geometry.sample_m() as f32;
    BlockExtent {
        extent_i_m: extent[0] as f32,
        extent_j_m: extent[1] as f32,
        layers: names.into_iter().map(|name| LayerExtent { name, thickness_m }).collect(),
        metres_per_mm: solid::metres_per_mm(geometry) as f32,
    }
}

/// Checks the colours that a scene states.
fn colours_of(scene: &Scene) -> Result<(), TtfError> {
    if let Some(raw) = &scene.raw {
        raw.function.validate(&place_of(&raw.volume))?;
    }
    scene.media.all().try_for_each(|medium| medium.function.validate(&format!("the medium `{}`", medium.volume)))
}

fn place_of(volume: &str) -> String {
    format!("the colours of `{volume}`")
}
