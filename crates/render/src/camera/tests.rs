//! Cameras and what they see.

use super::*;
use survey::VerticalUnit;

fn geometry() -> SurveyGeometry {
    SurveyGeometry::regular([41, 31, 21], 25.0, 10.0, VerticalUnit::Metres)
}

#[test]
fn a_pixels_ray_projects_back_to_it() {
    let block = VoxelBox::of_size([41, 31, 21]);
    for projection in [Projection::Orthographic, Projection::Perspective { fov_deg: 40.0 }] {
        let camera = Camera { azimuth_deg: Some(33.0), projection, zoom: 1.3, pan: [0.1, -0.05], ..Camera::default() };
        let view = View::new(&camera, &geometry(), &block, 2.5, [320, 200]);
        let pixel = DVec2::new(123.25, 77.5);
        let ray = view.ray(pixel);
        for t in [5.0, 40.0] {
            assert!((view.project(ray.origin + ray.direction * t) - pixel).length() < 1e-8);
        }
        let beside = view.ray(pixel + DVec2::X);
        assert!((beside.origin - ray.origin - ray.origin_step[0]).length() < 1e-9);
        let parallel = (ray.direction + ray.direction_step[0]).normalize();
        assert!((beside.direction - parallel).length() < 1e-9);
    }
}

#[test]
fn the_block_touches_its_margin_and_no_more() {
    let block = VoxelBox::of_size([41, 31, 21]);
    for projection in [Projection::Orthographic, Projection::Perspective { fov_deg: 60.0 }] {
        let camera = Camera { projection, margin: 0.1, ..Camera::default() };
        let view = View::new(&camera, &geometry(), &block, 1.0, [300, 200]);
        let pixels = block.corners().map(|c| view.project(c));
        let low = pixels.iter().copied().fold(DVec2::INFINITY, DVec2::min);
        let high = pixels.iter().copied().fold(DVec2::NEG_INFINITY, DVec2::max);
        let gaps = [low.x - 20.0, low.y - 20.0, 280.0 - high.x, 180.0 - high.y];
        assert!(gaps.iter().all(|g| *g > -1e-6), "{gaps:?}");
        assert!(gaps.iter().any(|g| g.abs() < 1e-6));
    }
}

/// East is right and north is away (up in the image), whichever way the survey's axes run.
#[test]
fn no_survey_comes_out_mirrored() {
    for inline in [DVec2::X, -DVec2::X, DVec2::Y, -DVec2::Y, DVec2::new(0.6, 0.8)] {
        for side in [1.0, -1.0] {
            let mut geometry = geometry();
            geometry.origin = DVec2::new(5000.0, -300.0);
            geometry.inline_vector = inline * 25.0;
            geometry.crossline_vector = inline.perp() * side * 12.5;
            let camera = Camera { azimuth_deg: Some(0.0), elevation_deg: 40.0, ..Camera::default() };
            let view = View::new(&camera, &geometry, &VoxelBox::of_size([41, 31, 21]), 1.0, [400, 300]);
            let at = |x: f64, y: f64, depth: f64| view.project(geometry.voxel_from_world(DVec3::new(x, y, depth)));
            let base = at(5000.0, -300.0, 100.0);
            let (east, north, deeper) =
                (at(5010.0, -300.0, 100.0), at(5000.0, -290.0, 100.0), at(5000.0, -300.0, 110.0));
            assert!(east.x > base.x && (east.y - base.y).abs() < 1e-9);
            assert!(north.y < base.y && (north.x - base.x).abs() < 1e-9);
            assert!(deeper.y > base.y && (deeper.x - base.x).abs() < 1e-9);
        }
    }
}

#[test]
fn the_automatic_view_looks_northwards_over_a_corner() {
    let camera = Camera::default();
    let bearing = camera.azimuth_for(&geometry(), &VoxelBox::of_size([41, 31, 21]));
    // The longer side runs along x (east), so its normal is north.
    assert!((bearing.abs() - 35.0).abs() < 1e-9);
}
