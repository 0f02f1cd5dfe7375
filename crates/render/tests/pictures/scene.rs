//! Scenes as text, without colours, and what of them is refused.

use render::camera::{Camera, Projection};
use render::error::SceneError;
use render::{Background, Corner, Ground, Lookup, Scene, VoxelBox};
use survey::{SurveyGeometry, VerticalUnit};
use ttf::{Colour, ColourMap, Preset, RawColour, RgbaFunction};

fn geometry() -> SurveyGeometry {
    SurveyGeometry::regular([40, 30, 20], 25.0, 10.0, VerticalUnit::Metres)
}

fn full() -> Scene {
    let block = VoxelBox { min: [1.0, 2.0, 3.0], max: [30.0, 20.0, 15.5] };
    Scene {
        size_px: [64, 48],
        background: Background::Transparent,
        lookup: Lookup::Packed,
        roaming_box: Some(block),
        ground: Some(Ground::default()),
        raw: Some(RawColour::new("seismic", RgbaFunction::centred(ColourMap::Grey, 2.0))),
        camera: Camera {
            azimuth_deg: Some(20.0),
            projection: Projection::Perspective { fov_deg: 30.0 },
            target: Some([1.0, 2.0, 3.0]),
            ..Camera::default()
        },
        cut_outs: vec![block.corner_cut(Corner::MinMax, [0.5, 0.5])],
        ..Scene::default()
    }
}

#[test]
fn toml_round_trips_and_an_empty_file_is_the_default() {
    for scene in [full(), Scene::default()] {
        let text = toml::to_string(&scene).unwrap();
        assert_eq!(toml::from_str::<Scene>(&text).unwrap(), scene, "{text}");
    }
    assert_eq!(toml::from_str::<Scene>("").unwrap(), Scene::default());
    assert!(toml::from_str::<Scene>("exageration = 2.0").is_err());
    let coloured: Scene = toml::from_str("background = '#ffeedd'").unwrap();
    assert_eq!(coloured.background, Background::Colour(Colour::new(0xff, 0xee, 0xdd)));
}

#[test]
fn a_scene_without_colours_has_none_of_its_own() {
    let printed = |preset: Preset| Scene { preset, face_tone: 0.2, ..full() }.printed();
    let line = Scene::default().wells.top_colour;
    assert_eq!(printed(Preset::Colour), Scene { face_tone: 0.2, ..full() });
    let black = printed(Preset::BlackAndWhite);
    assert_eq!((black.wells.top_colour, black.outlines.faults.colour), (Colour::BLACK, Colour::BLACK));
    assert_eq!(black.face_tone, 0.0);
    let grey = printed(Preset::Greyscale);
    assert_eq!((grey.wells.top_colour, grey.face_tone), (Preset::Greyscale.line(line), 0.2));
}

#[test]
fn what_has_no_picture_is_refused() {
    full().validate(&geometry()).unwrap();
    let refused = |change: fn(&mut Scene)| {
        let mut scene = full();
        change(&mut scene);
        scene.validate(&geometry()).unwrap_err()
    };
    assert!(matches!(refused(|s| s.size_px = [0, 10]), SceneError::ImageSize { .. }));
    assert!(matches!(refused(|s| s.size_px = [10, 1 << 20]), SceneError::ImageSize { .. }));
    assert!(matches!(refused(|s| s.exaggeration = f64::NAN), SceneError::OutOfRange { .. }));
    assert!(matches!(refused(|s| s.camera.zoom = 0.0), SceneError::OutOfRange { .. }));
    assert!(matches!(refused(|s| s.camera.target = Some([f64::NAN; 3])), SceneError::OutOfRange { .. }));
    assert!(matches!(refused(|s| s.roaming_box.as_mut().unwrap().max[0] = 1.0), SceneError::EmptyBox { .. }));
    assert!(matches!(refused(|s| s.roaming_box.as_mut().unwrap().max[0] = 99.0), SceneError::OutsideSurvey { .. }));
    assert!(matches!(refused(|s| s.cut_outs[0].min[2] = f64::NAN), SceneError::EmptyBox { .. }));
    assert!(matches!(
        refused(|s| s.cut_outs[0] = VoxelBox { min: [31.0; 3], max: [35.0; 3] }),
        SceneError::CutOutOutside { index: 1, .. }
    ));
}
