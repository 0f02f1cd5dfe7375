//! The GPU draws what the CPU reference draws: at most 2/255 apart off the edges.
//!
//! `PETROGLYPH_GPU_TESTS=skip` leaves these tests out; otherwise they fail on a machine without a graphics
//! driver.

use crate::block::Block;
use crate::compare::compare;
use glam::DVec3;
use render::{
    Background, Camera, CutShape, Ground, Inputs, Lookup, NamedVolume, Outlines, PatternSize, Projection, RenderError,
    Renderer, Samples, Scene, Side, VoxelBox,
};
use survey::Progress;
use synth::{SynthSettings, Synthetic};
use ttf::{
    Colour, ColourMap, RawColour, RgbaFunction, ScalarInterval, ScalarTtf, TextureLibrary, TransferFunctions,
    symmetric_clip,
};

pub(crate) fn skipped() -> bool {
    let skip = std::env::var("PETROGLYPH_GPU_TESTS").is_ok_and(|value| value == "skip");
    if skip {
        eprintln!("skipped: PETROGLYPH_GPU_TESTS=skip");
    }
    skip
}

fn functions(synthetic: &Synthetic) -> TransferFunctions {
    let clip = symmetric_clip(synthetic.seismic.samples(), 0.99).unwrap();
    let mut values = synthetic.attribute.volume.samples().to_vec();
    values.sort_by(f32::total_cmp);
    let middle = values[values.len() / 2];
    TransferFunctions {
        raw: Some(RawColour::new("seismic", RgbaFunction::centred(ColourMap::Grey, clip))),
        scalars: vec![ScalarTtf {
            volume: "impedance".to_owned(),
            intervals: vec![ScalarInterval {
                range: [middle, f32::INFINITY],
                texture: "dolostone".to_owned(),
                factor: [1.5, 0.7],
                opacity: 0.8,
                colour: Some(Colour::new(220, 120, 110)),
                ink: None,
            }],
        }],
        ..TransferFunctions::default()
    }
}

fn scenes(base: &Scene, whole: &VoxelBox, corner: render::Corner) -> Vec<(&'static str, Scene)> {
    let cut = whole.corner_cut(corner, [0.45, 0.5]);
    let perspective = Camera {
        projection: Projection::Perspective { fov_deg: 45.0 },
        azimuth_deg: Some(130.0),
        elevation_deg: 50.0,
        ..Camera::default()
    };
    // Half-way between two frequencies.
    let between = Camera { zoom: 2f64.powf(0.75), ..base.camera };
    let clear = Scene { background: Background::Transparent, outlines: Outlines::none(), ..base.clone() };
    vec![
        ("exact", Scene { cut_outs: vec![cut], ..base.clone() }),
        ("packed", Scene { cut_outs: vec![cut], lookup: Lookup::Packed, ..base.clone() }),
        ("pattern size", Scene { pattern_size: PatternSize::Paper, in_motion: true, camera: between, ..base.clone() }),
        ("half raw", Scene { blend: 0.5, camera: perspective, face_tone: 0.2, ..clear.clone() }),
        ("raw", Scene { blend: 1.0, cut_outs: whole.stair(corner, [0.6, 0.7], 0.8, 3), ..clear }),
        ("ground", Scene { cut_outs: vec![cut], ground: Some(Ground::default()), ..base.clone() }),
        ("shapes", Scene { cut_shapes: shapes(), face_tone: 0.2, ..base.clone() }),
        ("shapes and ground", Scene { cut_shapes: shapes(), ground: Some(Ground::default()), ..base.clone() }),
        ("raw ground", Scene { blend: 1.0, ground: Some(Ground::default()), camera: perspective, ..base.clone() }),
    ]
}

/// A curved fence and a sloping plane.
fn shapes() -> Vec<CutShape> {
    let fence = vec![[2.0, 25.0], [11.0, 14.0], [20.0, 12.0], [33.0, 3.0]];
    vec![
        CutShape::Fence { fence, side: Side::Left, smooth: true, depth: Some([0.0, 30.0]) },
        CutShape::Plane { through: [30.0, 8.0, 20.0], normal: [1.0, -0.4, -0.6] },
    ]
}

#[test]
fn gpu_and_cpu_agree() {
    if skipped() {
        return;
    }
    let quiet = Progress::silent();
    let settings = SynthSettings { size: [36, 32, 48], ..SynthSettings::default() };
    let synthetic = Synthetic::generate(&settings, &quiet).unwrap();
    let library = TextureLibrary::builtin().unwrap();
    let block = Block::new(
        &synthetic.geometry,
        &synthetic.stratigraphy,
        &synthetic.horizons,
        &synthetic.faults,
        &functions(&synthetic),
        &library,
    );
    let covers = VoxelBox {
        min: synthetic.attribute.origin.to_array(),
        max: (synthetic.attribute.origin + synthetic.attribute.extent).to_array(),
    };
    let volumes = [
        NamedVolume::whole("seismic", &synthetic.seismic),
        NamedVolume { name: "impedance", volume: Samples::Whole(&synthetic.attribute.volume), covers },
    ];
    let inputs = block.inputs(&volumes);
    let whole = VoxelBox::of_size(synthetic.geometry.size());
    let base = Scene { size_px: [160, 120], samples: 2, ..Scene::default() };
    let corner = base.view(&synthetic.geometry).nearest_corner(&whole);
    let mut renderer = Renderer::headless().expect("a Vulkan driver, or PETROGLYPH_GPU_TESTS=skip");
    let mut earlier = Vec::new();
    for (name, scene) in scenes(&base, &whole, corner) {
        let reference = render::reference::render(&scene, &inputs, &quiet).unwrap();
        let picture = renderer.render(&scene, &inputs, &quiet).unwrap();
        let found = compare(&reference, &picture).unwrap();
        assert!(found.agrees(), "{name}: {found:?}");
        // The comparison would notice another scene's picture.
        for other in &earlier {
            assert!(!compare(&reference, other).unwrap().agrees(), "{name}");
        }
        earlier.push(picture);
    }
    // The same picture from data that are already uploaded, pixel for pixel.
    let (_, first) = scenes(&base, &whole, corner).swap_remove(0);
    assert!(renderer.render(&first, &inputs, &quiet).unwrap() == earlier[0]);
    cancelled_and_new_data(&mut renderer, &base, &inputs, &synthetic);
}

/// Cancelling ends the drawing of a picture, and a new version of the data is uploaded.
fn cancelled_and_new_data(renderer: &mut Renderer, base: &Scene, inputs: &Inputs, synthetic: &Synthetic) {
    let quiet = Progress::silent();
    quiet.cancel();
    assert!(matches!(renderer.render(base, inputs, &quiet), Err(RenderError::Cancelled(_))));
    let raw = Scene { blend: 1.0, ..base.clone() };
    let before = renderer.render(&raw, inputs, &Progress::silent()).unwrap();
    let mut upside_down = synthetic.seismic.clone();
    upside_down.samples_mut().iter_mut().for_each(|value| *value = -*value);
    let volumes = [NamedVolume::whole("seismic", &upside_down), inputs.volumes[1]];
    let changed = Inputs { volumes: &volumes, data_key: 2, ..*inputs };
    let after = renderer.render(&raw, &changed, &Progress::silent()).unwrap();
    assert!(!compare(&before, &after).unwrap().agrees());
}

#[test]
fn a_model_without_horizons_or_faults_and_an_odd_size() {
    if skipped() {
        return;
    }
    let quiet = Progress::silent();
    let geometry = survey::SurveyGeometry::regular([12, 9, 15], 25.0, 10.0, survey::VerticalUnit::Metres);
    let library = TextureLibrary::builtin().unwrap();
    let block =
        Block::new(&geometry, &survey::Stratigraphy::default(), &[], &[], &TransferFunctions::default(), &library);
    let inputs = block.inputs(&[]);
    let roaming_box = VoxelBox { min: [1.5, 0.0, 2.25], max: [9.75, 7.0, 14.0] };
    let camera = Camera { target: Some(DVec3::splat(6.0).to_array()), zoom: 1.7, ..Camera::default() };
    let scene = Scene { size_px: [131, 77], samples: 3, roaming_box: Some(roaming_box), camera, ..Scene::default() };
    let reference = render::reference::render(&scene, &inputs, &quiet).unwrap();
    let picture = Renderer::headless().unwrap().render(&scene, &inputs, &quiet).unwrap();
    let found = compare(&reference, &picture).unwrap();
    assert!(found.agrees(), "{found:?}");
}

#[test]
fn a_volume_without_an_interpretation() {
    if skipped() {
        return;
    }
    let quiet = Progress::silent();
    let geometry = survey::SurveyGeometry::regular([14, 11, 12], 25.0, 10.0, survey::VerticalUnit::Metres);
    let values = (0..14 * 11 * 12).map(|n| (n as f32 * 0.37).sin()).collect();
    let volume = survey::Volume::from_samples(geometry.size(), values).unwrap();
    let volumes = [NamedVolume::whole("seismic", &volume)];
    let raw = RawColour::new("seismic", RgbaFunction::centred(ColourMap::Grey, 1.0));
    let scene = Scene { size_px: [120, 90], samples: 2, blend: 1.0, raw: Some(raw), ..Scene::default() };
    let inputs = Inputs::raw(&geometry, &volumes);
    let reference = render::reference::render(&scene, &inputs, &quiet).unwrap();
    let picture = Renderer::headless().unwrap().render(&scene, &inputs, &quiet).unwrap();
    let found = compare(&reference, &picture).unwrap();
    assert!(found.agrees(), "{found:?}");
    assert!(found.edge_share > 0.05, "the data shows: {found:?}");
}
