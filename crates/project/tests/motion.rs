//! Motions between scenes.

use project::pictures::Motion;
use render::{Corner, Ground, Projection, Scene, VoxelBox};
use survey::{SurveyGeometry, VerticalUnit};

fn geometry() -> SurveyGeometry {
    SurveyGeometry::regular([61, 31, 21], 25.0, 10.0, VerticalUnit::Metres)
}

fn start() -> Scene {
    let block = VoxelBox { min: [5.0, 0.0, 0.0], max: [60.0, 30.0, 20.0] };
    let cut_outs = vec![block.corner_cut(Corner::MinMax, [0.4, 0.4])];
    Scene { roaming_box: Some(block), cut_outs, ground: Some(Ground::default()), ..Scene::default() }
}

fn end() -> Scene {
    let mut scene = Scene { blend: 1.0, exaggeration: 4.0, ground: Some(Ground::default()), ..Scene::default() };
    scene.camera.azimuth_deg = Some(-100.0);
    scene.camera.zoom = 2.0;
    scene.camera.elevation_deg = 60.0;
    scene.cut_outs = vec![VoxelBox::of_size([61, 31, 21]).corner_cut(Corner::MaxMin, [0.6, 0.5])];
    scene
}

fn motions() -> Vec<Motion> {
    let mut all = vec![Motion::Turntable { turn_deg: 360.0 }, Motion::Turntable { turn_deg: -90.0 }, Motion::Blend];
    all.extend((0..3).map(|axis| Motion::Section { axis }));
    all.push(Motion::To(Box::new(end())));
    all
}

#[test]
fn every_scene_of_every_motion_can_be_drawn() {
    for projection in [Projection::Orthographic, Projection::Perspective { fov_deg: 35.0 }] {
        let mut first = start();
        first.camera.projection = projection;
        for motion in motions() {
            for step in 0..=40 {
                let scene = motion.scene(&first, &geometry(), f64::from(step) / 40.0);
                scene.validate(&geometry()).unwrap_or_else(|error| panic!("{motion:?} at {step}: {error}"));
            }
        }
    }
}

#[test]
fn a_turn_keeps_the_scale_and_the_middle_and_closes() {
    let whole = Motion::Turntable { turn_deg: 360.0 };
    assert!(whole.is_closed() && !Motion::Turntable { turn_deg: 90.0 }.is_closed());
    let scenes: Vec<Scene> = (0..=24).map(|n| whole.scene(&start(), &geometry(), f64::from(n) / 24.0)).collect();
    let view = |scene: &Scene| scene.view(&geometry());
    let middle = start().box_in(&geometry()).centre();
    let block = start().box_in(&geometry());
    for scene in &scenes {
        let (seen, first) = (view(scene), view(&scenes[0]));
        assert!((seen.pixels_per_metre() / first.pixels_per_metre() - 1.0).abs() < 1e-9);
        assert!((seen.project(middle) - first.project(middle)).length() < 1e-6);
        for corner in block.corners() {
            let at = seen.project(corner);
            assert!(at.min_element() >= 0.0 && at.x <= 1600.0 && at.y <= 1200.0, "{at}");
        }
    }
    assert!((scenes[0].camera.azimuth_deg.unwrap() - scenes[24].camera.azimuth_deg.unwrap()).abs() < 1e-9);
}

#[test]
fn a_section_moves_from_the_nearer_side_to_the_far_one() {
    for axis in 0..3 {
        let motion = Motion::Section { axis };
        assert!(motion.scene(&start(), &geometry(), 0.0).cut_outs.is_empty());
        let cut = |share| motion.scene(&start(), &geometry(), share).cut_outs[0];
        let block = start().box_in(&geometry());
        let (early, late) = (cut(0.25), cut(1.0));
        assert!(late.extent().as_ref()[axis] > 3.9 * early.extent().as_ref()[axis]);
        assert!(late.extent().as_ref()[axis] < block.extent().as_ref()[axis]);
        // The part that is gone lies towards the viewer.
        let towards = start().view(&geometry()).towards_camera(block.centre());
        let gone = early.centre() - block.centre();
        assert!(gone.as_ref()[axis] * towards.as_ref()[axis] > 0.0, "axis {axis}");
    }
}

#[test]
fn between_two_scenes_the_ends_are_the_scenes_and_the_way_is_the_shorter_one() {
    let motion = Motion::To(Box::new(end()));
    let at = |share| motion.scene(&start(), &geometry(), share);
    let (first, last) = (at(0.0), at(1.0));
    assert_eq!((first.cut_outs, first.blend), (start().cut_outs, 0.0));
    assert_eq!((last.cut_outs, last.blend, last.exaggeration), (end().cut_outs, 1.0, 4.0));
    assert!((last.camera.zoom - 2.0).abs() < 1e-9 && last.camera.elevation_deg == 60.0);
    let turned: Vec<f64> = (0..=10).map(|n| at(f64::from(n) / 10.0).camera.azimuth_deg.unwrap()).collect();
    assert!((turned[10] - turned[0]).abs() <= 180.0);
    assert!(turned.windows(2).all(|pair| (pair[1] - pair[0]).abs() < 40.0), "{turned:?}");
}
