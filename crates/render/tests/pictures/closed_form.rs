//! Pictures in which the colour of every pixel is known.

use crate::block::Block;
use glam::{DVec2, DVec3, Vec3};
use image::{Rgba, RgbaImage};
use model::accuracy::boundaries;
use model::section::SectionPlane;
use model::{ModelSettings, StructuralModel};
use render::reference::render;
use render::{Camera, Corner, Inputs, Lookup, NamedVolume, Outlines, PatternSize, Scene, VoxelBox};
use survey::{Progress, SurveyGeometry, VerticalUnit, Volume};
use synth::closed_form::ClosedForm;
use synth::{SynthSettings, Synthetic};
use ttf::{
    Colour, ColourMap, DepthInterval, Frequency, LayerStyle, LayerTtf, RawColour, RgbaFunction, TextureLibrary,
    TransferFunctions,
};

const RED: Colour = Colour::new(220, 40, 40);
const GREEN: Colour = Colour::new(40, 200, 60);
const BLUE: Colour = Colour::new(40, 60, 210);
/// Green of ink is less.
const INK_BELOW: u8 = 128;
/// Pixels of the smallest piece of a pattern that counts.
const SPECK: i32 = 5;

fn geometry() -> SurveyGeometry {
    SurveyGeometry::regular([41, 31, 41], 25.0, 10.0, VerticalUnit::Metres)
}

/// Layers of plain colours, the deepest first.
fn plain(closed: &ClosedForm, colours: &[Colour]) -> TransferFunctions {
    let names = closed.stratigraphy.layer_names_bottom_up();
    let styles = names.iter().zip(colours).map(|(name, &colour)| LayerStyle::plain(name, colour)).collect();
    TransferFunctions { layers: LayerTtf { styles }, ..TransferFunctions::default() }
}

/// A view from the south, at right angles to the face of smallest y.
fn from_the_side(size_px: [u32; 2]) -> Scene {
    let camera = Camera { azimuth_deg: Some(0.0), elevation_deg: 0.0, margin: 0.1, ..Camera::default() };
    Scene { size_px, samples: 4, camera, outlines: Outlines::none(), ..Scene::default() }
}

fn draw(scene: &Scene, inputs: &Inputs) -> RgbaImage {
    render(scene, inputs, &Progress::silent()).unwrap()
}

#[test]
fn flat_layers_lie_where_the_projection_says() {
    let closed = ClosedForm::flat(&geometry(), &[10.0, 27.0]);
    let library = TextureLibrary::builtin().unwrap();
    let block = Block::of(&closed, &plain(&closed, &[RED, GREEN, BLUE]), &library);
    let scene = Scene { exaggeration: 1.7, ..from_the_side([200, 160]) };
    let image = draw(&scene, &block.inputs(&[]));
    let view = scene.view(&closed.geometry);
    let row = |z: f64| view.project(DVec3::new(20.0, 0.0, z)).y;
    // Bins of 25 m and samples of 10 m, with exaggeration.
    let per_sample = (row(40.0) - row(0.0)) / 40.0;
    let per_inline = (view.project(DVec3::new(40.0, 0.0, 0.0)) - view.project(DVec3::ZERO)).x / 40.0;
    assert!((per_sample / per_inline - 10.0 * 1.7 / 25.0).abs() < 1e-9);
    for y in 0..160 {
        let middle = f64::from(y) + 0.5;
        let expected = [(0.0, 10.0, BLUE), (10.0, 27.0, GREEN), (27.0, 40.0, RED)]
            .into_iter()
            .find(|(top, base, _)| middle - 0.5 >= row(*top) && middle + 0.5 <= row(*base));
        let found = image.get_pixel(100, y).0;
        match expected {
            Some((_, _, colour)) => assert_eq!(found[..3], colour.rgb, "row {y}"),
            None if middle + 0.5 <= row(0.0) || middle - 0.5 >= row(40.0) => assert_eq!(found, [255; 4], "row {y}"),
            None => {}
        }
    }
}

#[test]
fn a_striped_tile_repeats_as_often_as_its_frequency_says() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("stripes.png");
    let stripes = RgbaImage::from_fn(64, 64, |x, _| Rgba(if x < 32 { [0, 0, 0, 255] } else { [255; 4] }));
    stripes.save(&path).unwrap();
    let mut library = TextureLibrary::builtin().unwrap();
    library.add_user(&path).unwrap();
    let closed = ClosedForm::flat(&geometry(), &[8.0, 32.0]);
    let mut functions = plain(&closed, &[RED, GREEN, BLUE]);
    functions.layers.styles[1].intervals = vec![DepthInterval {
        k: [0.0, 1.0],
        texture: "stripes".to_owned(),
        frequency: Some(Frequency { horizontal: 10.0, vertical: 1.0 }),
        opacity: 1.0,
        colour: None,
    }];
    let block = Block::of(&closed, &functions, &library);
    let changes = |scene: &Scene| {
        let image = draw(scene, &block.inputs(&[]));
        let row = scene.view(&closed.geometry).project(DVec3::new(20.0, 0.0, 20.0)).y as u32;
        let dark: Vec<bool> = (0..image.width()).map(|x| image.get_pixel(x, row).0[1] < 128).collect();
        dark.windows(2).filter(|pair| pair[0] != pair[1]).count()
    };
    let scene = from_the_side([420, 200]);
    // White, ten dark stripes, white.
    assert_eq!(changes(&scene), 20);
    assert_eq!(changes(&Scene { global_frequency: 1.5, ..scene.clone() }), 30);
    assert_eq!(changes(&Scene { lookup: Lookup::Packed, ..scene.clone() }), 20);
    // Zooming in by a factor of 64 on the middle of the layer: fixed to the rock, one stripe fills the picture in the
    // end; fixed to the paper, there are as many as before, as exactly as the steps allow.
    let zoomed = |pattern_size: PatternSize, zoom: f64| {
        let camera = Camera { zoom, target: Some([20.0, 0.0, 20.0]), ..scene.camera };
        changes(&Scene { pattern_size, camera, ..scene.clone() })
    };
    assert!(zoomed(PatternSize::Rock, 64.0) <= 2);
    let whole = zoomed(PatternSize::Paper, 1.0);
    assert_eq!(whole, zoomed(PatternSize::Rock, 1.0));
    for step in 1..=12 {
        // The whole block takes a part of the width, a close-up all of it.
        let seen = zoomed(PatternSize::Paper, 2f64.powf(0.5 * f64::from(step))) as f64;
        let fits = whole as f64 / (1.0 - 2.0 * scene.camera.margin * 200.0 / 420.0);
        assert!((seen - fits).abs() <= 2.0, "{seen} changes of {fits} at step {step}");
    }
}

/// Pieces of ink and of the ground between, but for specks, for each thousand pixels of a layer.
fn pieces_per_area(image: &RgbaImage, is_layer: impl Fn(&Rgba<u8>) -> bool) -> f64 {
    let [width, height] = [image.width() as usize, image.height() as usize];
    // Of each pixel of the layer, whether it is ink.
    let is_ink: Vec<Option<bool>> =
        image.pixels().map(|pixel| is_layer(pixel).then_some(pixel.0[1] < INK_BELOW)).collect();
    let mut seen = vec![false; width * height];
    let mut pieces = 0;
    for start in (0..width * height).filter(|&n| is_ink[n].is_some()) {
        let (mut stack, mut pixels) = (vec![start], 0);
        while let Some(n) = stack.pop() {
            if std::mem::replace(&mut seen[n], true) {
                continue;
            }
            pixels += 1;
            let (x, y) = (n % width, n / width);
            let columns = [(x > 0).then(|| n - 1), (x + 1 < width).then_some(n + 1)];
            let rows = [(y > 0).then(|| n - width), (y + 1 < height).then_some(n + width)];
            stack.extend(columns.into_iter().chain(rows).flatten().filter(|&m| !seen[m] && is_ink[m] == is_ink[n]));
        }
        pieces += i32::from(pixels >= SPECK);
    }
    1000.0 * f64::from(pieces) / is_ink.iter().flatten().count() as f64
}

#[test]
fn dots_dashes_and_bricks_are_as_many_for_an_area_of_paper_over_a_zoom_of_64() {
    let library = TextureLibrary::builtin().unwrap();
    let closed = ClosedForm::folded(&geometry(), &[12.0, 30.0], 20.0, 0.1);
    for pattern in ["sandstone-bedded", "shale", "limestone"] {
        let mut functions = plain(&closed, &[RED, GREEN, RED]);
        functions.layers.styles[1].intervals = vec![DepthInterval {
            k: [0.0, 1.0],
            texture: pattern.to_owned(),
            frequency: None,
            opacity: 1.0,
            colour: None,
        }];
        let block = Block::of(&closed, &functions, &library);
        let counted = |zoom: f64| {
            let camera = Camera { zoom, target: Some([20.0, 0.0, 21.0]), ..from_the_side([1; 2]).camera };
            let scene =
                Scene { pattern_size: PatternSize::Paper, global_frequency: 0.4, camera, ..from_the_side([600, 420]) };
            // Neither the layers around nor the paper.
            let is_layer = |pixel: &Rgba<u8>| pixel.0[..3] != RED.rgb && pixel.0[..3] != [255; 3];
            pieces_per_area(&draw(&scene, &block.inputs(&[])), is_layer)
        };
        let found = [1.0, 2.4, 5.7, 10.0, 19.0, 37.0, 64.0].map(counted);
        println!("{pattern}: {found:.2?}");
        let (least, most) = found.iter().fold((f64::INFINITY, 0.0f64), |(a, b), &n| (a.min(n), b.max(n)));
        assert!(least > 0.5 && most < 2.0 * least, "{pattern}: {found:?}");
    }
}

fn ramp_along_x(geometry: &SurveyGeometry) -> Volume<f32> {
    let [nx, ny, nz] = geometry.size();
    Volume::from_samples(geometry.size(), (0..nx * ny * nz).map(|n| (n / (ny * nz)) as f32).collect()).unwrap()
}

fn grey(high: f32) -> RawColour {
    RawColour::new("ramp", RgbaFunction::over(ColourMap::Grey, [0.0, high]))
}

#[test]
fn the_ends_of_the_blend_are_pure() {
    let closed = ClosedForm::dipping(&geometry(), &[14.0, 27.0], 12.0, 30.0);
    let library = TextureLibrary::builtin().unwrap();
    let illustrated = TransferFunctions::default();
    let both = TransferFunctions { raw: Some(grey(40.0)), ..illustrated.clone() };
    let volume = ramp_along_x(&closed.geometry);
    let volumes = [NamedVolume::whole("ramp", &volume)];
    let scene = Scene { size_px: [120, 100], outlines: Outlines::none(), ..Scene::default() };
    let (block, without_raw) = (Block::of(&closed, &both, &library), Block::of(&closed, &illustrated, &library));
    assert!(draw(&scene, &block.inputs(&volumes)) == draw(&scene, &without_raw.inputs(&[])));
    let raw_only = Scene { raw: Some(grey(40.0)), ..scene.clone() };
    let raw = draw(&raw_only, &Inputs::raw(&closed.geometry, &volumes));
    assert!(draw(&Scene { blend: 1.0, ..scene.clone() }, &block.inputs(&volumes)) == raw);
    let half = draw(&Scene { blend: 0.5, ..scene.clone() }, &block.inputs(&volumes));
    let illustration = draw(&scene, &without_raw.inputs(&[]));
    for ((half, a), b) in half.pixels().zip(illustration.pixels()).zip(raw.pixels()) {
        for n in 0..4 {
            assert!((f32::from(half.0[n]) - 0.5 * (f32::from(a.0[n]) + f32::from(b.0[n]))).abs() <= 1.0);
        }
    }
}

#[test]
fn a_cut_out_shows_its_back_faces() {
    let geometry = geometry();
    let volume = ramp_along_x(&geometry);
    let volumes = [NamedVolume::whole("ramp", &volume)];
    let inputs = Inputs::raw(&geometry, &volumes);
    // The view from the west shows faces of constant x: each has one grey.
    let camera = Camera { azimuth_deg: Some(90.0), elevation_deg: 0.0, ..Camera::default() };
    let whole = VoxelBox::of_size(geometry.size());
    let mut scene = Scene {
        size_px: [100, 80],
        camera,
        raw: Some(grey(40.0)),
        outlines: Outlines::none(),
        cut_outs: vec![whole.corner_cut(Corner::MinMin, [0.25, 0.5])],
        ..Scene::default()
    };
    let at = |scene: &Scene, y: f64| {
        let p = scene.view(&geometry).project(DVec3::new(0.0, y, 20.0));
        draw(scene, &inputs).get_pixel(p.x as u32, p.y as u32).0[0]
    };
    // The map runs from white to black.
    let grey_of = |x: f32| ((1.0 - x / 40.0) * 255.0 + 0.5) as u8;
    assert_eq!([at(&scene, 7.0), at(&scene, 22.0)], [grey_of(10.0), grey_of(0.0)]);
    // A second cut-out behind the first moves the back face.
    scene.cut_outs.push(VoxelBox { min: [10.0, 0.0, 0.0], max: [30.0, 10.0, 40.0] });
    assert_eq!([at(&scene, 7.0), at(&scene, 12.0)], [grey_of(30.0), grey_of(10.0)]);
}

#[test]
fn one_place_looks_the_same_in_a_mirrored_and_in_an_exchanged_survey() {
    let straight = SurveyGeometry::regular([31, 31, 21], 20.0, 10.0, VerticalUnit::Metres);
    let value = |world: DVec3| (0.002 * world.x + 0.004 * world.y + 0.5 * (0.01 * world.z).sin()) as f32;
    let picture = |geometry: &SurveyGeometry| {
        let [nx, ny, nz] = geometry.size();
        let samples = (0..nx * ny * nz).map(|n| {
            let voxel = DVec3::new((n / (ny * nz)) as f64, (n / nz % ny) as f64, (n % nz) as f64);
            value(geometry.world_from_voxel(voxel))
        });
        let volume = Volume::from_samples(geometry.size(), samples.collect()).unwrap();
        let volumes = [NamedVolume::whole("field", &volume)];
        let raw = RawColour::new("field", RgbaFunction::over(ColourMap::Seismics, [-0.5, 4.0]));
        let camera = Camera { azimuth_deg: Some(30.0), ..Camera::default() };
        let scene =
            Scene { size_px: [120, 90], camera, raw: Some(raw), outlines: Outlines::none(), ..Scene::default() };
        draw(&scene, &Inputs::raw(geometry, &volumes))
    };
    let expected = picture(&straight);
    let mut mirrored = straight.clone();
    mirrored.origin = DVec2::new(600.0, 0.0);
    mirrored.inline_vector = DVec2::new(-20.0, 0.0);
    let mut swapped = straight.clone();
    (swapped.inline_vector, swapped.crossline_vector) = (straight.crossline_vector, straight.inline_vector);
    for geometry in [mirrored, swapped] {
        let found = crate::compare::compare(&expected, &picture(&geometry)).unwrap();
        assert!(found.agrees(), "{found:?}");
    }
    let flipped = image::imageops::flip_horizontal(&expected);
    assert!(!crate::compare::compare(&expected, &flipped).unwrap().agrees());
}

#[test]
fn boundaries_at_four_pixels_a_voxel_are_within_a_tenth_of_a_voxel() {
    let closed = ClosedForm::dipping(&geometry(), &[12.0, 28.0], 14.0, 0.0).with_fault(60.0, 5.0);
    let library = TextureLibrary::builtin().unwrap();
    let block = Block::of(&closed, &plain(&closed, &[RED, GREEN, BLUE]), &library);
    let [low, high] = [DVec3::new(4.0, 11.3, 4.0), DVec3::new(36.0, 11.3, 36.0)];
    let plane = SectionPlane::crossline(11.3, low, high);
    let truth = |p: DVec3| u32::from(closed.layer_at(p)) | u32::from(closed.block_at(p)) << 16;
    // The blocks of the model may be numbered in the opposite order.
    let swap = block.model.block_at(Vec3::new(36.0, 11.0, 4.0)) != closed.block_at(DVec3::new(36.0, 11.0, 4.0));
    let label = |layer: u16, b: u16| u32::from(layer) | u32::from(if swap { 1 - b } else { b }) << 16;
    let exact = |p: DVec3| {
        let region = block.model.region_at(p.as_vec3());
        label(region.layer, region.block)
    };
    let packed = |p: DVec3| {
        let region = block.packed.lookup_extrapolated(p.as_vec3()).region;
        label(region.layer, region.block)
    };
    let ours = boundaries(&plane, 4.0, exact, truth).unwrap();
    let papers = boundaries(&plane, 4.0, packed, truth).unwrap();
    println!("exact {ours:?}\npacked {papers:?}");
    assert!(ours.worst <= 0.1, "{ours:?}");
    assert!(papers.worst > 0.3, "{papers:?}");
}

/// The same in a picture: the position of the fault in each row of pixels follows from their coverage.
#[test]
fn boundaries_of_folds_and_of_the_synthetic_survey_are_within_a_tenth_of_a_voxel() {
    let quiet = Progress::silent();
    let size = [64; 3];
    let geometry = SurveyGeometry::regular(size, 25.0, 20.0, VerticalUnit::Metres);
    let folds = ClosedForm::folded(&geometry, &[18.0, 33.0, 48.0], 32.0, 0.3).with_fault(60.0, 5.0);
    let made = Synthetic::generate(&SynthSettings { size, ..SynthSettings::default() }, &quiet).unwrap();
    let build = |geometry, stratigraphy, horizons, faults| {
        StructuralModel::build(geometry, stratigraphy, horizons, faults, &ModelSettings::default(), &quiet).unwrap()
    };
    let of_folds = build(&folds.geometry, &folds.stratigraphy, &folds.horizons, &folds.faults);
    let of_made = build(&made.geometry, &made.stratigraphy, &made.horizons, &made.faults);
    let high = DVec3::splat(63.0);
    for plane in [SectionPlane::crossline(23.3, DVec3::ZERO, high), SectionPlane::inline(38.4, DVec3::ZERO, high)] {
        let layer = |model: &StructuralModel, p: DVec3| u32::from(model.region_at(p.as_vec3()).layer);
        let folded = boundaries(&plane, 4.0, |p| layer(&of_folds, p), |p| folds.layer_at(p).into()).unwrap();
        let synthetic = boundaries(&plane, 4.0, |p| layer(&of_made, p), |p| made.truth.layer_at(p).into()).unwrap();
        println!("folds {folded:?}\nsynthetic {synthetic:?}");
        assert!(folded.worst <= 0.1 && synthetic.percentile_99 <= 0.1, "{folded:?} {synthetic:?}");
    }
}

#[test]
fn a_fault_in_a_picture_is_where_it_is_in_truth() {
    let closed = ClosedForm::flat(&geometry(), &[20.0]).with_fault(60.0, 19.0);
    let library = TextureLibrary::builtin().unwrap();
    let block = Block::of(&closed, &plain(&closed, &[RED, GREEN]), &library);
    // Red rock of the footwall on the left, green rock of the hanging wall on the right; nothing else at
    // these depths.
    let roaming_box = VoxelBox { min: [14.0, 0.0, 24.0], max: [30.0, 30.0, 38.0] };
    let mut scene = Scene { roaming_box: Some(roaming_box), samples: 8, ..from_the_side([64, 64]) };
    scene.camera.margin = 0.0;
    let image = draw(&scene, &block.inputs(&[]));
    let view = scene.view(&closed.geometry);
    let corner = view.project(DVec3::new(14.0, 0.0, 24.0));
    let pixel = (view.project(DVec3::new(15.0, 0.0, 25.0)) - corner).recip();
    assert!((pixel.x - 0.25).abs() < 1e-9, "four pixels a voxel");
    let red_share = |x: u32, y: u32| {
        let [_, green, ..] = image.get_pixel(x, y).0.map(f64::from);
        (green - f64::from(GREEN.rgb[1])) / (f64::from(RED.rgb[1]) - f64::from(GREEN.rgb[1]))
    };
    let rows = corner.y.ceil() as u32..(corner.y + 14.0 / pixel.y).floor() as u32;
    for y in rows {
        let z = 24.0 + (f64::from(y) + 0.5 - corner.y) * pixel.y;
        let found = 14.0 + (0..64).map(|x| red_share(x, y)).sum::<f64>() * pixel.x;
        let (mut footwall, mut hanging) = (14.0, 30.0);
        for _ in 0..40 {
            let middle = 0.5 * (footwall + hanging);
            let is_hanging = closed.block_at(DVec3::new(middle, 0.0, z)) == 1;
            if is_hanging { hanging = middle } else { footwall = middle }
        }
        assert!((found - footwall).abs() <= 0.1, "row {y}: {found}, truth {footwall}");
    }
}
