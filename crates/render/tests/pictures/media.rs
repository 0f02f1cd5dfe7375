//! Media whose pictures are known in closed form: absorption, layers, occlusion, emission.

use crate::block::Block;
use glam::DVec3;
use image::RgbaImage;
use render::media::{Colouring, EmptySpace, LayerOpacity, MediumColour, white_ramp};
use render::reference::render;
use render::{
    Background, Camera, CandidateVolume, Faces, Inputs, Media, Medium, NamedVolume, Occlusion, Outlines, PickedHorizon,
    Projection, Samples, Scene, Scope, Shading, VoxelBox,
};
use survey::{Progress, SurveyGeometry, VerticalUnit, Volume};
use synth::closed_form::ClosedForm;
use ttf::{
    Colour, DepthInterval, LayerStyle, LayerTtf, RgbaFunction, RgbaStop, TextureLibrary, TransferFunctions,
    srgb_from_linear,
};

/// A function with one colour and opacity for every value.
pub(crate) fn constant(colour: Colour, opacity: f32) -> RgbaFunction {
    let stop = |at: f32| RgbaStop { at, colour, opacity };
    RgbaFunction { domain: [0.0, 1.0], stops: vec![stop(0.0), stop(1.0)] }
}

/// A part of a layer by depth.
pub(crate) fn part(k: [f32; 2], colour: Colour, opacity: f32) -> DepthInterval {
    DepthInterval { k, texture: "limestone".into(), opacity, frequency: None, colour: Some(colour) }
}

pub(crate) fn medium(volume: &str, function: RgbaFunction) -> Medium {
    Medium { volume: volume.to_owned(), function, layers: LayerOpacity::Ignored, colour: MediumColour::Function }
}

pub(crate) fn cubic(side: usize) -> SurveyGeometry {
    SurveyGeometry::regular([side; 3], 10.0, 10.0, VerticalUnit::Metres)
}

/// A view along y from its small end: a pixel shows one x and one z, and the path is as long as the block.
pub(crate) fn head_on(size_px: [u32; 2], media: Media) -> Scene {
    let camera = Camera { azimuth_deg: Some(0.0), elevation_deg: 0.0, margin: 0.0, ..Camera::default() };
    Scene {
        size_px,
        samples: 1,
        camera,
        outlines: Outlines::none(),
        background: Background::Colour(Colour::BLACK),
        media,
        ..Scene::default()
    }
}

pub(crate) fn draw(scene: &Scene, inputs: &Inputs) -> RgbaImage {
    render(scene, inputs, &Progress::silent()).unwrap()
}

pub(crate) fn byte(linear: f64) -> f64 {
    f64::from(srgb_from_linear(linear as f32)) * 255.0
}

#[test]
fn a_homogeneous_medium_absorbs_one_minus_the_exponential() {
    let geometry = cubic(25);
    let volume = Volume::filled([25; 3], 0.3f32);
    let volumes = [NamedVolume::whole("v", &volume)];
    let inputs = Inputs::raw(&geometry, &volumes);
    for (opacity, samples) in [(0.02f32, 1.0f32), (0.1, 0.2), (0.1, 4.0)] {
        let media = Media {
            faces: Faces::None,
            samples_per_voxel: samples,
            surroundings: vec![medium("v", constant(Colour::WHITE, opacity))],
            ..Media::default()
        };
        let image = draw(&head_on([8, 8], media), &inputs);
        let expected = byte(1.0 - (1.0 - f64::from(opacity)).powi(24));
        let found = f64::from(image.get_pixel(4, 4).0[0]);
        assert!((found - expected).abs() <= 0.51, "{opacity} at {samples}: {found}, {expected}");
    }
}

#[test]
fn a_cut_out_and_its_surroundings_have_their_own_functions_and_its_back_face_stops() {
    let geometry = cubic(25);
    let volume = Volume::filled([25; 3], 0.5f32);
    let volumes = [NamedVolume::whole("v", &volume)];
    let inputs = Inputs::raw(&geometry, &volumes);
    let cut = VoxelBox { min: [0.0, 6.0, 0.0], max: [24.0, 16.0, 24.0] };
    let raw = ttf::RawColour::new("v", constant(Colour::new(0, 0, 255), 1.0));
    let media = |faces| Media {
        faces,
        surroundings: vec![medium("v", constant(Colour::new(255, 0, 0), 0.05))],
        cut_outs: vec![medium("v", constant(Colour::new(0, 255, 0), 0.1))],
        ..Media::default()
    };
    let pixel = |faces| {
        let scene = Scene { cut_outs: vec![cut], blend: 1.0, raw: Some(raw.clone()), ..head_on([8, 8], media(faces)) };
        draw(&scene, &inputs).get_pixel(4, 4).0.map(f64::from)
    };
    let before = 0.95f64.powi(6);
    let inside = 0.9f64.powi(10);
    let after = 0.95f64.powi(8);
    let near = |found: [f64; 4], expected: [f64; 3]| {
        for c in 0..3 {
            assert!((found[c] - byte(expected[c])).abs() <= 1.0, "{found:?}, {:?}", expected.map(byte));
        }
    };
    near(pixel(Faces::CutOuts), [1.0 - before, before * (1.0 - inside), before * inside]);
    let both = 1.0 - before + before * inside * (1.0 - after);
    near(pixel(Faces::None), [both, before * (1.0 - inside), 0.0]);
    near(pixel(Faces::All), [0.0, 0.0, 1.0]);
    // With the cut-out open to the viewer, the medium in it is in front of the faces.
    let open = VoxelBox { min: [0.0; 3], max: [24.0, 16.0, 24.0] };
    let scene =
        Scene { cut_outs: vec![open], blend: 1.0, raw: Some(raw.clone()), ..head_on([8, 8], media(Faces::All)) };
    let passes = 0.9f64.powi(16);
    near(draw(&scene, &inputs).get_pixel(4, 4).0.map(f64::from), [0.0, 1.0 - passes, passes]);
    // The same with a single medium.
    let alone = Scene { media: Media { surroundings: Vec::new(), ..scene.media.clone() }, ..scene };
    near(draw(&alone, &inputs).get_pixel(4, 4).0.map(f64::from), [0.0, 1.0 - passes, passes]);
}

#[test]
fn volumes_of_any_size_and_extent_mix_by_their_extinction_and_no_data_is_clear() {
    let geometry = cubic(25);
    let whole = Volume::filled([25; 3], 0.5f32);
    let mut part = Volume::filled([4, 5, 6], 0.5f32);
    part.samples_mut()[..60].fill(f32::NAN);
    let covers = VoxelBox { min: [0.0, 4.0, 0.0], max: [24.0, 14.0, 24.0] };
    let volumes = [NamedVolume::whole("a", &whole), NamedVolume { name: "b", volume: Samples::Whole(&part), covers }];
    let inputs = Inputs::raw(&geometry, &volumes);
    let media = Media {
        faces: Faces::None,
        samples_per_voxel: 8.0,
        surroundings: vec![
            medium("a", constant(Colour::new(255, 0, 0), 0.02)),
            medium("b", constant(Colour::new(0, 255, 0), 0.06)),
        ],
        ..Media::default()
    };
    let image = draw(&head_on([64, 64], media), &inputs);
    let (a, b) = (-(0.98f64.ln()), -(0.94f64.ln()));
    let first = 1.0 - (-4.0 * a).exp();
    let both = (-4.0 * a).exp() * (1.0 - (-10.0 * (a + b)).exp());
    let last = (-4.0 * a - 10.0 * (a + b)).exp() * (1.0 - (-10.0 * a).exp());
    let right = image.get_pixel(60, 32).0.map(f64::from);
    assert!((right[0] - byte(first + both * a / (a + b) + last)).abs() <= 1.5, "{right:?}");
    assert!((right[1] - byte(both * b / (a + b))).abs() <= 1.5, "{right:?}");
    assert_eq!(image.get_pixel(4, 32).0[1], 0);
}

#[test]
fn skipping_changes_nothing_unshaded_or_shaded_by_gradients() {
    let geometry = cubic(40);
    let values = (0..40 * 40 * 40).map(|n| if (n / 160) % 97 == 3 { (n % 53) as f32 / 53.0 } else { 0.0 }).collect();
    let volume = Volume::from_samples([40; 3], values).unwrap();
    let volumes = [NamedVolume::whole("v", &volume)];
    let inputs = Inputs::raw(&geometry, &volumes);
    for projection in [Projection::Orthographic, Projection::Perspective { fov_deg: 50.0 }] {
        for shading in [Shading::Unshaded, Shading::Phong(render::Phong::default())] {
            let media = |empty_space| Media {
                faces: Faces::None,
                shading,
                empty_space,
                surroundings: vec![medium("v", white_ramp(1.0, 0.4))],
                ..Media::default()
            };
            let camera = Camera { azimuth_deg: Some(33.0), projection, ..Camera::default() };
            let picture = |empty_space| draw(&Scene { camera, ..head_on([90, 80], media(empty_space)) }, &inputs);
            let skipped = picture(EmptySpace::Skipped);
            assert!(skipped == picture(EmptySpace::Sampled));
            assert!(skipped.pixels().any(|p| p.0[0] > 100) && skipped.pixels().any(|p| p.0[0] == 0));
        }
    }
}

#[test]
fn a_layer_extrudes_into_the_cut_out_and_air_does_not() {
    let geometry = SurveyGeometry::regular([41, 31, 41], 10.0, 10.0, VerticalUnit::Metres);
    let closed = ClosedForm::flat(&geometry, &[10.0, 27.0]);
    let names = closed.stratigraphy.layer_names_bottom_up();
    let styles = names.iter().zip([0.0, 1.0, 0.0]).map(|(name, opacity)| {
        let mut style = LayerStyle::plain(name, Colour::WHITE);
        style.opacity = opacity;
        style
    });
    let functions = TransferFunctions { layers: LayerTtf { styles: styles.collect() }, ..TransferFunctions::default() };
    let block = Block::of(&closed, &functions, &TextureLibrary::builtin().unwrap());
    let volume = Volume::filled([41, 31, 41], 0.5f32);
    let volumes = [NamedVolume::whole("v", &volume)];
    let cut = VoxelBox { min: [0.0; 3], max: [40.0, 20.0, 40.0] };
    let followed = Medium { layers: LayerOpacity::Followed, ..medium("v", constant(Colour::new(200, 0, 0), 1.0)) };
    let media = Media { cut_outs: vec![followed], ..Media::default() };
    let scene = Scene { cut_outs: vec![cut], ..head_on([160, 160], media) };
    let image = draw(&scene, &block.inputs(&volumes));
    let view = scene.view(&geometry);
    for y in 0..160 {
        let [red, green, ..] = image.get_pixel(80, y).0;
        let z = 40.0 * (f64::from(y) + 0.5 - view.project(DVec3::new(20.0, 0.0, 0.0)).y)
            / (view.project(DVec3::new(20.0, 0.0, 40.0)).y - view.project(DVec3::new(20.0, 0.0, 0.0)).y);
        if (10.1..26.9).contains(&z) {
            assert_eq!([red, green], [200, 0], "row {y}, z {z}");
        } else if !(9.9..27.1).contains(&z) {
            assert_eq!([red, green], [255, 255], "row {y}, z {z}");
        }
    }
}

/// A layer whose lower half is red and whose upper half is green, with a boundary in the middle of its thickness.
#[test]
fn parts_of_a_layer_by_depth_have_their_own_colours_in_a_medium() {
    let geometry = SurveyGeometry::regular([41, 31, 41], 10.0, 10.0, VerticalUnit::Metres);
    let closed = ClosedForm::flat(&geometry, &[10.0, 27.0]);
    let names = closed.stratigraphy.layer_names_bottom_up();
    let (red, green) = (Colour::new(200, 0, 0), Colour::new(0, 150, 0));
    let styles = names.iter().enumerate().map(|(n, name)| {
        let mut style = LayerStyle::plain(name, Colour::new(10, 20, 30));
        if n == 1 {
            style.intervals = vec![part([0.0, 0.5], red, 0.0), part([0.5, 1.0], green, 0.0)];
        }
        style
    });
    let functions = TransferFunctions { layers: LayerTtf { styles: styles.collect() }, ..TransferFunctions::default() };
    let block = Block::of(&closed, &functions, &TextureLibrary::builtin().unwrap());
    let volume = Volume::filled([41, 31, 41], 0.5f32);
    let volumes = [NamedVolume::whole("v", &volume)];
    let rock = Medium { colour: MediumColour::Layers, ..medium("v", constant(Colour::WHITE, 1.0)) };
    let media = Media { faces: Faces::None, surroundings: vec![rock], ..Media::default() };
    let scene = head_on([160, 160], media);
    let image = draw(&scene, &block.inputs(&volumes));
    let view = scene.view(&geometry);
    let [top, bottom] = [0.0, 40.0].map(|z| view.project(DVec3::new(20.0, 0.0, z)).y);
    let mut seen = [0; 3];
    for y in 0..160 {
        let z = 40.0 * (f64::from(y) + 0.5 - top) / (bottom - top);
        let (n, expected) = match z {
            10.1..18.3 => (0, green.rgb),
            18.7..26.9 => (1, red.rgb),
            0.1..9.9 | 27.1..39.9 => (2, [10, 20, 30]),
            _ => continue,
        };
        let found = image.get_pixel(80, y).0;
        assert!((0..3).all(|c| found[c].abs_diff(expected[c]) <= 1), "row {y}, z {z}: {found:?}, {expected:?}");
        seen[n] += 1;
    }
    assert!(seen.iter().all(|rows| *rows > 20), "{seen:?}");
}

/// A medium that is transparent except in a thin plane of constant y at `at`, which is opaque for x below
/// `edge`.
fn half_plane(side: usize, at: usize, edge: usize, wall: usize) -> Volume<f32> {
    let mut volume = Volume::filled([side; 3], 0.0f32);
    for x in 0..side {
        for z in 0..side {
            let n = |y: usize| (x * side + y) * side + z;
            if x < edge {
                volume.samples_mut()[n(at)] = 1.0;
            }
            volume.samples_mut()[n(wall)] = 2.0;
            volume.samples_mut()[n(wall + 1)] = 2.0;
        }
    }
    volume
}

/// In a homogeneous medium O grows by α₀ per unit, so the light at depth s is 1/(1 + α₀·s).
#[test]
fn occlusion_in_a_homogeneous_medium_is_linear_in_depth() {
    let geometry = cubic(65);
    let volume = Volume::filled([65; 3], 0.5f32);
    let volumes = [NamedVolume::whole("v", &volume)];
    let inputs = Inputs::raw(&geometry, &volumes);
    let picture = |slices_per_voxel: f32, opacity: f32| {
        let shading = Shading::Occlusion(Occlusion { slices_per_voxel, spread: 0.5, ..Occlusion::default() });
        let media = Media {
            faces: Faces::None,
            shading,
            surroundings: vec![medium("v", constant(Colour::WHITE, opacity))],
            ..Media::default()
        };
        draw(&head_on([33, 33], media), &inputs)
    };
    for opacity in [0.03f32, 0.2] {
        let a = f64::from(opacity);
        let kappa = -(1.0 - a).ln();
        let steps = 100_000;
        let ds = 64.0 / f64::from(steps);
        let expected: f64 = (0..steps)
            .map(|n| (f64::from(n) + 0.5) * ds)
            .map(|s| kappa * (-kappa * s).exp() / (1.0 + a * s) * ds)
            .sum();
        let found = f64::from(picture(1.0, opacity).get_pixel(16, 16).0[0]);
        assert!((found - byte(expected)).abs() <= 1.5, "{opacity}: {found}, {}", byte(expected));
        let doubled = picture(2.0, opacity);
        let differ = picture(1.0, opacity);
        let worst = doubled.pixels().zip(differ.pixels()).map(|(a, b)| a.0[0].abs_diff(b.0[0])).max().unwrap();
        assert!(worst <= 2, "{opacity}: slices doubled differ by {worst}");
    }
}

/// Behind the edge of a plane that adds o, the occlusion at distance d is o·½·erfc(x/√(2d)·σ₀), as of any
/// blurred step.
#[test]
fn a_known_occluder_casts_a_known_shadow() {
    let side = 81;
    let geometry = cubic(side);
    let volume = half_plane(side, 20, 40, 60);
    let volumes = [NamedVolume::whole("v", &volume)];
    let inputs = Inputs::raw(&geometry, &volumes);
    let stop = |at: f32, opacity: f32| RgbaStop { at, colour: Colour::WHITE, opacity };
    // Values up to 1 have a low opacity; those of the background plane (2) are opaque.
    let function = RgbaFunction {
        domain: [0.0, 2.0],
        stops: vec![
            stop(0.0, 0.0),
            stop(0.3, 0.0),
            stop(0.45, 0.3),
            stop(0.55, 0.3),
            stop(0.7, 0.0),
            stop(0.9, 0.0),
            stop(0.95, 1.0),
            stop(1.0, 1.0),
        ],
    };
    let picture = |slices_per_voxel: f32| {
        let shading = Shading::Occlusion(Occlusion { slices_per_voxel, strength: 3.0, ..Occlusion::default() });
        let media = Media {
            faces: Faces::None,
            shading,
            samples_per_voxel: 8.0,
            surroundings: vec![medium("v", function.clone())],
            ..Media::default()
        };
        draw(&head_on([324, 324], media), &inputs)
    };
    let image = picture(8.0);
    let view = head_on([324, 324], Media::default()).view(&geometry);
    let light = |x: f64| {
        let px = view.project(DVec3::new(x, 0.0, 40.0));
        let byte = image.get_pixel(px.x as u32, px.y as u32).0[0];
        f64::from(ttf::linear_from_srgb(f32::from(byte) / 255.0))
    };
    let error_function = |x: f64| {
        let n = 2000;
        let h = x / f64::from(n);
        (0..n).map(|k| (-((f64::from(k) + 0.5) * h).powi(2)).exp() * h).sum::<f64>() * std::f64::consts::FRAC_2_SQRT_PI
    };
    let places = [40.6, 41.5, 43.0, 46.0, 50.0, 55.0, 60.0];
    // The background plane also shades itself, equally everywhere; far from the edge there is nothing else.
    let own = 1.0 / light(78.0) - 1.0;
    let found = places.map(|x| 1.0 / light(x) - 1.0 - own);
    // A cell of the slices cannot resolve the exact position of the edge. The best position within one cell
    // and the amount that the plane adds are fitted; the width is not.
    let worst = |sigma: f64| {
        let edges = (0..60).map(|n| 38.6 + 0.03 * f64::from(n));
        let residual = |edge: f64| {
            let shape = places.map(|x| 0.5 * (1.0 - error_function((x - edge) / (sigma * 2f64.sqrt()))));
            let product: f64 = shape.iter().zip(found).map(|(s, f)| s * f).sum();
            let amount = product / shape.iter().map(|s| s * s).sum::<f64>();
            shape.iter().zip(found).map(|(s, f)| (s * amount - f).abs()).fold(0.0, f64::max)
        };
        edges.map(residual).fold(f64::INFINITY, f64::min) / found[0]
    };
    let sigma = 40f64.sqrt();
    assert!(found[0] > 0.15 && worst(sigma) < 0.04, "{found:?}, {}", worst(sigma));
    assert!(
        worst(0.75 * sigma) > 0.05 && worst(1.33 * sigma) > 0.05,
        "{} {}",
        worst(0.75 * sigma),
        worst(1.33 * sigma)
    );
}

/// The light of an emitter on a white plane behind it has its colour; without blur it is exactly that colour.
#[test]
fn an_emitter_lights_a_white_wall_in_its_colour() {
    let side = 65;
    let geometry = cubic(side);
    let volume = half_plane(side, 5, 0, 40);
    let volumes = [NamedVolume::whole("v", &volume)];
    let (mut distance, mut leaf) = (vec![255u8; side * side * side], vec![0u32; side * side * side]);
    for x in 0..32 {
        for y in 10..31usize {
            for z in 0..side {
                let n = (x * side + y) * side + z;
                distance[n] = (y.abs_diff(20) * 25).min(255) as u8;
                leaf[n] = 7;
            }
        }
    }
    let candidates =
        CandidateVolume { size: [side; 3], distance: &distance, leaf: &leaf, voxels_per_step: 0.04, groups: None };
    let inputs = Inputs { candidates: Some(candidates), ..Inputs::raw(&geometry, &volumes) };
    let glowing = Colour::new(255, 128, 0);
    let media = |emission: f32, scope: Scope| Media {
        faces: Faces::None,
        samples_per_voxel: 4.0,
        shading: Shading::Occlusion(Occlusion { spread: 1.5, ..Occlusion::default() }),
        scope,
        surroundings: vec![medium("v", white_ramp(2.0, 0.5))],
        horizons: vec![PickedHorizon {
            name: None,
            leaves: vec![7],
            colour: glowing,
            colouring: Colouring::Own,
            opacity: 1.0,
            thickness: 1.0,
            emission,
            paint: None,
        }],
        ..Media::default()
    };
    let picture = |emission: f32, scope| draw(&head_on([130, 130], media(emission, scope)), &inputs);
    let linear = |image: &RgbaImage, x: u32| {
        image.get_pixel(x, 65).0.map(|byte| f64::from(ttf::linear_from_srgb(f32::from(byte) / 255.0)))
    };
    let (dark, lit) = (picture(0.0, Scope::Everywhere), picture(0.5, Scope::Everywhere));
    // On the emitter itself: its colour, plus half of it again.
    let (own, glow) = (linear(&dark, 20), linear(&lit, 20));
    assert!((own[0] - 1.0).abs() < 0.02 && own[2] == 0.0, "{own:?}");
    assert!(glow[1] > 1.4 * own[1], "{glow:?} {own:?}");
    // Beside it on the plane, the added light has the hue of the emitter: linear green over red as in its
    // colour.
    let hue = f64::from(ttf::linear_from_srgb(128.0 / 255.0));
    for x in [66, 70, 76] {
        let (before, after) = (linear(&dark, x), linear(&lit, x));
        let added = [0, 1, 2].map(|c| after[c] - before[c]);
        // Occlusion is the same, so red and green differ by the emitted light alone, and blue does not
        // differ.
        assert!(added[2].abs() < 0.01, "{added:?}");
        if after[0] < 0.99 {
            assert!(added[0] > 0.02 && (added[1] / added[0] - hue).abs() < 0.1, "{x}: {added:?}");
        }
    }
    // Near horizons only: the plane is 20 voxels behind and disappears. Away from them: both the horizon and
    // the plane stay.
    let near = picture(0.0, Scope::NearHorizons);
    assert_eq!(near.get_pixel(100, 65).0[0], 0);
    assert_eq!(picture(0.0, Scope::AwayFromHorizons).get_pixel(100, 65).0, dark.get_pixel(100, 65).0);
}
