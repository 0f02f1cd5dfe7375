//! Panes of compared blocks, and the pictures that are asked for.

use super::*;
use render::Projection;
use survey::VerticalUnit;

#[test]
fn panes_stand_beside_one_another_where_there_is_room() {
    let broad = Rect::sized(DVec2::ZERO, DVec2::new(300.0, 100.0));
    let narrow = Rect::sized(DVec2::ZERO, DVec2::new(100.0, 100.0));
    let both = Comparison::SideBySide([0.0, 1.0]);
    assert_eq!(both.panes(broad)[1].min, DVec2::new(150.0, 0.0));
    assert_eq!(both.panes(narrow)[1].min, DVec2::new(0.0, 50.0));
    let wipe = Comparison::Wipe([0.0, 1.0], 0.25);
    assert_eq!(wipe.seen(0, broad).max.x, 75.0);
    assert_eq!(wipe.seen(1, broad).min.x, 75.0);
}

#[test]
fn a_picture_is_asked_for_in_its_own_pixels_and_laid_on_them() {
    let geometry = SurveyGeometry::regular([9, 9, 9], 25.0, 4.0, VerticalUnit::Milliseconds);
    let scene = Scene::default();
    let panel = BlockPanel {
        scene: &scene,
        geometry: &geometry,
        comparison: Comparison::SideBySide([0.0, 1.0]),
        interpretation: None,
        has_surfaces: true,
        dpi: 144.0,
        model: None,
        wells: &[],
        annotation: None,
        names: BlockNames::default(),
    };
    let mut asked = Vec::new();
    let mut paint = |scene: &Scene| {
        asked.push((scene.size_px, scene.blend));
        Ok(RgbaImage::new(scene.size_px[0], scene.size_px[1]))
    };
    let room = Rect::sized(DVec2::new(0.26, 0.0), DVec2::new(100.0, 40.0));
    let drawn = panel.drawn(room, &mut paint).unwrap();
    assert_eq!(asked, [([100, 80], 0.0), ([100, 80], 1.0)]);
    assert!(drawn.points_per_m > 0.0);
    assert_eq!(drawn.group.items.len(), 3);
}

#[test]
fn scales_of_both_projections_agree_in_the_middle_of_a_distant_block() {
    let geometry = SurveyGeometry::regular([41, 41, 41], 25.0, 25.0, VerticalUnit::Metres);
    let scale = |projection| {
        let mut scene = Scene::default();
        scene.camera.projection = projection;
        let middle = scene.box_in(&geometry).centre();
        pixels_per_metre(&scene.view(&geometry), middle)
    };
    let ratio = scale(Projection::Perspective { fov_deg: 0.5 }) / scale(Projection::Orthographic);
    assert!((ratio - 1.0).abs() < 0.02, "{ratio}");
}
