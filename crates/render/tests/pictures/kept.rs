//! What a renderer keeps of a model must not show: a picture is the one that a fresh renderer draws.

use crate::block::Block;
use render::reference::{CpuRenderer, render};
use render::{Corner, Ground, Inputs, Scene, VoxelBox};
use survey::{Progress, SurveyGeometry, VerticalUnit};
use synth::closed_form::ClosedForm;
use ttf::{Colour, LayerStyle, TextureLibrary, TransferFunctions};

fn block(depths: &[f64], throw: f64) -> Block {
    let geometry = SurveyGeometry::regular([31, 25, 41], 25.0, 10.0, VerticalUnit::Metres);
    let closed = ClosedForm::flat(&geometry, depths).with_fault(60.0, throw);
    Block::of(&closed, &TransferFunctions::default(), &TextureLibrary::builtin().unwrap())
}

/// After a change of styles alone, points that were found before are coloured again.
#[test]
fn points_that_are_coloured_again_are_those_of_a_fresh_picture() {
    let quiet = Progress::silent();
    let library = TextureLibrary::builtin().unwrap();
    let geometry = SurveyGeometry::regular([31, 25, 41], 25.0, 10.0, VerticalUnit::Metres);
    let closed = ClosedForm::flat(&geometry, &[8.0, 27.0]).with_fault(60.0, 60.0);
    let styled = |colour: Colour| {
        let mut functions = TransferFunctions::default();
        let name = &closed.stratigraphy.layer_names_bottom_up()[1];
        functions.layers.set(LayerStyle::textured(name, colour, "chalk"));
        Block::of(&closed, &functions, &library)
    };
    let blocks = [Colour::new(200, 40, 40), Colour::new(40, 160, 60)].map(styled);
    let scene = Scene { size_px: [90, 70], samples: 2, ground: Some(Ground::default()), ..Scene::default() };
    let dense = Scene { global_frequency: 2.0, ..scene.clone() };
    let mut turned = scene.clone();
    turned.camera.azimuth_deg = Some(70.0);
    // Room for two pictures, for one, and for none.
    for pictures in [2.2, 1.2, 0.5] {
        let mut renderer = CpuRenderer::keeping_points((pictures * 90.0 * 70.0 * 4.0 * 68.0) as usize);
        for (version, of, scene) in [(1, 0, &scene), (2, 1, &scene), (3, 0, &dense), (4, 1, &turned), (5, 0, &scene)] {
            let inputs = Inputs { data_key: 1, ..blocks[of].inputs(&[]) };
            let kept = renderer.render(scene, &inputs, &quiet).unwrap();
            assert!(kept == render(scene, &inputs, &quiet).unwrap(), "picture {version}, room for {pictures}");
        }
    }
}

#[test]
fn what_is_kept_between_pictures_does_not_show() {
    let quiet = Progress::silent();
    let blocks = [block(&[8.0, 27.0], 60.0), block(&[14.0, 30.0], 90.0)];
    let scene = Scene { size_px: [90, 70], samples: 1, ground: Some(Ground::default()), ..Scene::default() };
    let mut turned = scene.clone();
    turned.camera.azimuth_deg = Some(70.0);
    let smaller = VoxelBox { min: [4.0, 2.0, 0.0], max: [28.0, 22.0, 36.0] };
    let boxed = Scene { roaming_box: Some(smaller), ..turned.clone() };
    let cut = Scene { cut_outs: vec![smaller.corner_cut(Corner::MinMin, [0.5, 0.5])], ..boxed.clone() };
    let mut renderer = CpuRenderer::default();
    let mut pictures = Vec::new();
    // The second block comes as other data, once with a version of its own and once without any.
    for (of, version) in [(&blocks[0], 1), (&blocks[1], 2), (&blocks[0], 0), (&blocks[1], 0)] {
        let inputs = Inputs { data_key: version, ..of.inputs(&[]) };
        for scene in [&scene, &turned, &boxed, &cut, &turned] {
            let kept = renderer.render(scene, &inputs, &quiet).unwrap();
            assert!(kept == render(scene, &inputs, &quiet).unwrap(), "version {version}");
            pictures.push(kept);
        }
    }
    assert!(pictures[1] == pictures[4] && pictures[0] != pictures[1] && pictures[0] != pictures[5]);
}
