//! Volume rendering of volumes and horizons, by labels.

use super::command::{choose, click_last};
use super::driven::{Driven, click, open, state, wait};
use egui_kittest::kittest::Queryable;
use render::{Media, Scene, Shading};
use state::volume_rendering::{Extent, extent};

fn scene(harness: &Driven) -> &Scene {
    &state(harness).session.as_ref().unwrap().view.scene
}

fn drawn(harness: &mut Driven) {
    wait(harness, "the picture is drawn", |harness| harness.state().as_ref().unwrap().is_settled());
    assert!(state(harness).notices.iter().all(|notice| !notice.failed), "{:?}", state(harness).notices);
}

#[test]
fn a_volume_fills_the_cut_outs_and_the_block() {
    let folder = tempfile::tempdir().unwrap();
    let mut harness = open(folder.path());
    click(&mut harness, "Volume display");
    click_last(&mut harness, "Cut-outs");
    drawn(&mut harness);
    assert_eq!(extent(scene(&harness)), Extent::CutOuts);
    assert_eq!(scene(&harness).media.cut_outs[0].volume, "seismic");
    harness.get_by_label("Opacity over the histogram");
    let stops = scene(&harness).media.cut_outs[0].function.stops.len();
    assert!(stops > 2);
    click_last(&mut harness, "Remove stop");
    assert_eq!(scene(&harness).media.cut_outs[0].function.stops.len(), stops - 1);
    click_last(&mut harness, "Only in layers left standing");
    drawn(&mut harness);
    click_last(&mut harness, "Whole block");
    assert_eq!(extent(scene(&harness)), Extent::Block);
    assert!(scene(&harness).ground.is_none() && scene(&harness).background != Scene::default().background);
    drawn(&mut harness);
    choose(&mut harness, "Light", "gradients");
    assert!(matches!(scene(&harness).media.shading, Shading::Phong(_)));
    drawn(&mut harness);
    click_last(&mut harness, "Nothing");
    assert_eq!(extent(scene(&harness)), Extent::Nowhere);
    assert_eq!(scene(&harness).background, Scene::default().background);
    assert!(scene(&harness).ground.is_some());
    drawn(&mut harness);
}

#[test]
fn a_horizon_is_shown_in_the_rendered_volume_with_fields_of_its_own() {
    let folder = tempfile::tempdir().unwrap();
    let mut harness = open(folder.path());
    click(&mut harness, "Volume display");
    assert_eq!(scene(&harness).media, Media::default());
    click_last(&mut harness, "Top");
    wait(&mut harness, "the horizon is seen", |harness| !scene(harness).media.horizons.is_empty());
    drawn(&mut harness);
    for label in ["Light of Top", "Top: opacity", "Top: thickness", "Top: glow"] {
        assert!(harness.query_all_by_label(label).next().is_some(), "{label}");
    }
    click_last(&mut harness, "near horizons");
    drawn(&mut harness);
    click_last(&mut harness, "Top");
    assert!(scene(&harness).media.horizons.is_empty());
    drawn(&mut harness);
}
