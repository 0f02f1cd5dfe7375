//! Surfaces in media, where their pictures are known in closed form: opaque slices, isosurfaces, and what is under a pixel.

use crate::block::Block;
use crate::media::{byte, cubic, draw, head_on, medium};
use glam::{DVec2, DVec3};
use render::media::{EmptySpace, white_ramp};
use render::reference::render;
use render::{
    CandidateVolume, DrawnWell, Faces, Inputs, Isosurface, IsosurfaceSource, Media, NamedVolume, Occlusion, Outlines,
    PickedObject, Scene, Shading, pick,
};
use survey::{Progress, SurveyGeometry, VerticalUnit, Volume};
use synth::closed_form::ClosedForm;
use ttf::{Colour, RgbaFunction, RgbaStop, TextureLibrary, TransferFunctions};

#[test]
fn an_opaque_slice_hides_what_is_behind_and_shows_its_colour() {
    let geometry = cubic(33);
    let mut volume = Volume::filled([33; 3], 0.0f32);
    for x in 0..33 {
        for y in 8..11 {
            volume.trace_mut(x, y).fill(1.0);
        }
        for y in 20..24 {
            volume.trace_mut(x, y).fill(2.0);
        }
    }
    let volumes = [NamedVolume::whole("v", &volume)];
    let inputs = Inputs::raw(&geometry, &volumes);
    let stop = |at: f32, colour: Colour, opacity: f32| RgbaStop { at, colour, opacity };
    let (front, back) = (Colour::new(90, 160, 30), Colour::new(255, 0, 255));
    let stops = vec![
        stop(0.0, front, 0.0),
        stop(0.4, front, 0.0),
        stop(0.4, front, 1.0),
        stop(0.6, front, 1.0),
        stop(0.6, back, 1.0),
        stop(1.0, back, 1.0),
    ];
    for shading in [Shading::Unshaded, Shading::Occlusion(Occlusion::default())] {
        let media = Media {
            faces: Faces::None,
            shading,
            surroundings: vec![medium("v", RgbaFunction { domain: [0.0, 2.0], stops: stops.clone() })],
            ..Media::default()
        };
        let [r, g, b, a] = draw(&head_on([16, 16], media), &inputs).get_pixel(8, 8).0;
        // Nothing lies in front of the first opaque sample: λ = 1, except for the half step that is the depth
        // of the sample itself.
        assert!(r.abs_diff(90) <= 25 && g.abs_diff(160) <= 40 && b < 40 && a == 255, "{shading:?} {r} {g} {b}");
        if shading == Shading::Unshaded {
            assert_eq!([r, g, b], front.rgb);
        }
    }
}

#[test]
fn what_is_under_a_pixel_is_what_shows_there() {
    let geometry = cubic(33);
    let mut volume = Volume::filled([33; 3], 0.0f32);
    for x in 0..33 {
        for y in 12..16 {
            volume.trace_mut(x, y).fill(1.0);
        }
    }
    let volumes = [NamedVolume::whole("v", &volume)];
    let leaf: Vec<u32> = (0..33 * 33 * 33).map(|n| if n / 33 % 33 >= 11 { 9 } else { 0 }).collect();
    let distance = vec![25u8; leaf.len()];
    let candidates =
        CandidateVolume { size: [33; 3], distance: &distance, leaf: &leaf, voxels_per_step: 0.04, groups: None };
    let path = [DVec3::new(4.0, 3.0, -9.0), DVec3::new(4.0, 3.0, 40.0)];
    let wells = [DrawnWell { name: "A", colour: None, path: &path, tops: &path[..0] }];
    let inputs = Inputs { candidates: Some(candidates), wells: &wells, ..Inputs::raw(&geometry, &volumes) };
    let media = Media {
        faces: Faces::None,
        samples_per_voxel: 8.0,
        surroundings: vec![medium("v", white_ramp(1.0, 0.5))],
        ..Media::default()
    };
    let scene = head_on([66, 66], media);
    let view = scene.view(&geometry);
    let at = |x: f64| pick(&scene, &inputs, view.project(DVec3::new(x, 0.0, 16.0))).unwrap();
    let seen = at(20.0).unwrap();
    // Between the samples at 11 (transparent) and 12 (opaque) the value passes ½.
    assert_eq!(seen.what, PickedObject::Medium);
    assert!((seen.voxel.y - 11.6).abs() < 0.2 && (seen.voxel.x - 20.0).abs() < 0.3, "{seen:?}");
    assert_eq!((seen.leaf, seen.region), (Some(9), None));
    assert!((seen.leaf_distance.unwrap() - 1.0).abs() < 1e-4 && seen.values[0] > 0.5);
    let well = at(4.0).unwrap();
    assert_eq!((well.what, well.leaf), (PickedObject::Well(0), None));
    assert!((2.0..3.0).contains(&well.voxel.y), "{well:?}");
    assert_eq!(pick(&scene, &inputs, DVec2::new(-30.0, 5.0)).unwrap(), None);
    let raw = ttf::RawColour::new("v", white_ramp(1.0, 0.5));
    let faces = Scene { media: Media::default(), blend: 1.0, raw: Some(raw), ..scene.clone() };
    let face = pick(&faces, &inputs, view.project(DVec3::new(20.0, 0.0, 16.0))).unwrap().unwrap();
    assert_eq!((face.what, face.voxel.y, face.values[0]), (PickedObject::Face, 0.0, 0.0));
}

#[test]
fn an_isosurface_is_where_its_value_is_and_hides_what_is_behind() {
    // v = y: the isosurface v = 12 is the plane y = 12, seen at right angles behind an absorbing stretch of
    // known length.
    let side = 33;
    let geometry = cubic(side);
    let mut volume = Volume::filled([side; 3], 0.0f32);
    for x in 0..side {
        for y in 0..side {
            volume.trace_mut(x, y).fill(y as f32);
        }
    }
    let volumes = [NamedVolume::whole("v", &volume)];
    let inputs = Inputs::raw(&geometry, &volumes);
    let colour = Colour::new(200, 120, 40);
    let surface = |opacity: f32| Isosurface {
        of: IsosurfaceSource::Volume("v".into()),
        value: 12.0,
        colour,
        opacity,
        thickness: 1.0,
    };
    let media = |opacity: f32| Media {
        faces: Faces::None,
        samples_per_voxel: 8.0,
        isosurfaces: vec![surface(opacity)],
        ..Media::default()
    };
    let opaque = draw(&head_on([33, 33], media(1.0)), &inputs);
    assert_eq!(opaque.get_pixel(16, 16).0, [200, 120, 40, 255]);
    // A shell of two voxels, whose soft edges add half of their width on each side: 1 − (1 − α₀)².
    let thin = draw(&head_on([33, 33], media(0.3)), &inputs);
    let expected = byte((1.0 - 0.7f64.powi(2)) * f64::from(ttf::linear_from_srgb(200.0 / 255.0)));
    assert!((f64::from(thin.get_pixel(16, 16).0[0]) - expected).abs() < 2.0, "{:?} {expected}", thin.get_pixel(16, 16));
    let found = pick(&head_on([33, 33], media(1.0)), &inputs, DVec2::splat(16.5)).unwrap().unwrap();
    assert!((found.voxel.y - 11.0).abs() < 0.5 && found.what == PickedObject::Medium, "{found:?}");
    let sparse = Media { empty_space: EmptySpace::Sampled, ..media(0.3) };
    assert_eq!(draw(&head_on([33, 33], sparse), &inputs), thin);
    let missing = Media { isosurfaces: vec![Isosurface { of: IsosurfaceSource::Depth, ..surface(1.0) }], ..media(1.0) };
    let error = render(&head_on([9, 9], missing), &inputs, &Progress::silent()).unwrap_err();
    assert!(error.to_string().contains("k'"), "{error}");
}

#[test]
fn a_surface_of_k_lies_between_its_horizons() {
    let geometry = SurveyGeometry::regular([41, 31, 41], 25.0, 10.0, VerticalUnit::Metres);
    let closed = ClosedForm::dipping(&geometry, &[14.0, 27.0], 12.0, 30.0);
    let block = Block::of(&closed, &TransferFunctions::default(), &TextureLibrary::builtin().unwrap());
    let surface = Isosurface {
        of: IsosurfaceSource::Depth,
        value: 1.5,
        colour: Colour::new(250, 250, 250),
        opacity: 1.0,
        thickness: 1.0,
    };
    let media = Media { faces: Faces::None, isosurfaces: vec![surface], ..Media::default() };
    let scene = Scene { media, outlines: Outlines::none(), size_px: [60, 45], samples: 1, ..Scene::default() };
    let inputs = block.inputs(&[]);
    let mut found = 0;
    for n in 0..40 {
        let Some(hit) = pick(&scene, &inputs, DVec2::new(10.0 + f64::from(n), 22.0)).unwrap() else { continue };
        // Halfway between the two planes, within the half thickness of the shell and half a step of the ray.
        let z = |h: usize| block.model.horizon_z(h, 0, hit.voxel.x, hit.voxel.y);
        let away = (hit.voxel.z - 0.5 * (z(0) + z(1))).abs();
        assert!(away < 1.6, "{away} samples off at {}", hit.voxel);
        found += 1;
    }
    assert!(found > 10, "{found}");
}
