//! Moving the camera by hand: orbit, pan, zoom about the cursor.
//!
//! [`render::Camera`] is fitted to the block: its scale follows the block's outline, which changes with every turn.
//! While the user turns the block it must neither grow nor drift, so [`hold`] corrects zoom and pan until one anchor
//! point keeps its pixel and the scale there stays the same ([`pixels_per_metre`]).

use super::view::StandardView;
use figure::draw::block::pixels_per_metre;
use glam::{DVec2, DVec3};
use render::{Scene, View};
use survey::SurveyGeometry;

/// Degrees of rotation for each point of mouse travel: half a turn across a view of 1000 points.
const DEG_PER_POINT: f64 = 0.25;
/// The zoom stays in this range, so that the block is never lost.
const ZOOM: [f64; 2] = [0.2, 60.0];

/// The view of a scene in a picture of this size, points.
pub fn view(scene: &Scene, geometry: &SurveyGeometry, size: DVec2) -> View {
    let size_px = [size.x.max(1.0) as u32, size.y.max(1.0) as u32];
    View::new(&scene.camera, geometry, &scene.box_in(geometry), scene.exaggeration, size_px)
}

/// Keeps `anchor` (voxel) at the pixel where `before` shows it, and keeps the scale there.
pub fn hold(before: &View, scene: &mut Scene, geometry: &SurveyGeometry, size: DVec2, anchor: DVec3) {
    let factor = pixels_per_metre(before, anchor) / pixels_per_metre(&view(scene, geometry, size), anchor);
    scene.camera.zoom = (scene.camera.zoom * factor).clamp(ZOOM[0], ZOOM[1]);
    let off = before.project(anchor) - view(scene, geometry, size).project(anchor);
    let pan = DVec2::from_array(scene.camera.pan) + off / size;
    scene.camera.pan = pan.to_array();
}

/// Turns the block by a drag of `delta` points: a drag to the right turns it to the right, a drag up tips it towards
/// the viewer.
///
/// ```
/// use state::camera;
/// use glam::DVec2;
/// use render::Scene;
/// use survey::{SurveyGeometry, VerticalUnit};
///
/// let geometry = SurveyGeometry::regular([61, 41, 51], 25.0, 8.0, VerticalUnit::Metres);
/// let size = DVec2::new(640.0, 420.0);
/// let mut scene = Scene::default();
/// let middle = scene.box_in(&geometry).centre();
/// let before = camera::view(&scene, &geometry, size).project(middle);
/// camera::orbit(&mut scene, &geometry, size, DVec2::new(100.0, 0.0));
/// let after = camera::view(&scene, &geometry, size).project(middle);
/// assert!((after - before).length() < 1e-6, "the middle of the block keeps its pixel");
/// ```
pub fn orbit(scene: &mut Scene, geometry: &SurveyGeometry, size: DVec2, delta: DVec2) {
    let before = view(scene, geometry, size);
    let block = scene.box_in(geometry);
    let azimuth = scene.camera.azimuth_for(geometry, &block) + delta.x * DEG_PER_POINT;
    scene.camera.azimuth_deg = Some((azimuth + 540.0).rem_euclid(360.0) - 180.0);
    scene.camera.elevation_deg = (scene.camera.elevation_deg + delta.y * DEG_PER_POINT).clamp(-89.0, 90.0);
    hold(&before, scene, geometry, size, block.centre());
}

/// Pans the picture.
pub fn pan(scene: &mut Scene, size: DVec2, delta: DVec2) {
    scene.camera.pan = (DVec2::from_array(scene.camera.pan) + delta / size).to_array();
}

/// Zooms about a point of the picture.
pub fn zoom_at(scene: &mut Scene, size: DVec2, at: DVec2, factor: f64) {
    let zoom = (scene.camera.zoom * factor).clamp(ZOOM[0], ZOOM[1]);
    let factor = zoom / scene.camera.zoom;
    scene.camera.zoom = zoom;
    let centre = size * (DVec2::splat(0.5) + DVec2::from_array(scene.camera.pan));
    let moved = at - (at - centre) * factor;
    scene.camera.pan = (moved / size - DVec2::splat(0.5)).to_array();
}

/// Moves the camera to a standard position; the projection stays.
pub(crate) fn stand(scene: &mut Scene, place: StandardView) {
    let usual = render::Camera::default();
    let (azimuth_deg, elevation_deg) = match place {
        StandardView::Block => (None, usual.elevation_deg),
        StandardView::Top => (Some(0.0), 90.0),
        StandardView::North => (Some(0.0), 0.0),
        StandardView::East => (Some(90.0), 0.0),
        StandardView::South => (Some(180.0), 0.0),
        StandardView::West => (Some(-90.0), 0.0),
    };
    scene.camera = render::Camera { azimuth_deg, elevation_deg, projection: scene.camera.projection, ..usual };
}

#[cfg(test)]
mod tests {
    use super::*;
    use render::Projection;
    use survey::VerticalUnit;

    const SIZE: DVec2 = DVec2::new(640.0, 420.0);

    fn scenes() -> Vec<(Scene, SurveyGeometry)> {
        let geometry = SurveyGeometry::regular([61, 41, 51], 25.0, 8.0, VerticalUnit::Metres);
        [Projection::Orthographic, Projection::Perspective { fov_deg: 35.0 }]
            .map(|projection| {
                let mut scene = Scene { exaggeration: 2.0, ..Scene::default() };
                scene.camera.projection = projection;
                (scene, geometry.clone())
            })
            .into()
    }

    #[test]
    fn the_block_neither_wanders_nor_grows_while_it_turns() {
        for (mut scene, geometry) in scenes() {
            let middle = scene.box_in(&geometry).centre();
            let before = view(&scene, &geometry, SIZE);
            for step in 0..40 {
                orbit(&mut scene, &geometry, SIZE, DVec2::new(17.0, f64::from(step % 7) - 3.0));
            }
            let after = view(&scene, &geometry, SIZE);
            assert!((after.project(middle) - before.project(middle)).length() < 1e-6);
            assert!((pixels_per_metre(&after, middle) / pixels_per_metre(&before, middle) - 1.0).abs() < 1e-6);
        }
    }

    #[test]
    fn a_drag_and_its_way_back_end_where_they_began() {
        for (mut scene, geometry) in scenes() {
            scene.camera.azimuth_deg = Some(20.0);
            let before = scene.camera;
            orbit(&mut scene, &geometry, SIZE, DVec2::new(120.0, 40.0));
            orbit(&mut scene, &geometry, SIZE, DVec2::new(-120.0, -40.0));
            assert!((scene.camera.azimuth_deg.unwrap() - before.azimuth_deg.unwrap()).abs() < 1e-9);
            assert!((scene.camera.zoom - before.zoom).abs() < 1e-9);
            assert!((scene.camera.elevation_deg - before.elevation_deg).abs() < 1e-9);
        }
    }

    #[test]
    fn what_is_under_the_cursor_stays_there_while_zooming() {
        for (mut scene, geometry) in scenes() {
            let at = DVec2::new(211.0, 133.0);
            let ray = view(&scene, &geometry, SIZE).ray(at);
            let point = ray.origin + ray.direction * 30.0;
            for factor in [1.7, 0.4, 3.0] {
                zoom_at(&mut scene, SIZE, at, factor);
                assert!((view(&scene, &geometry, SIZE).project(point) - at).length() < 1e-6);
            }
        }
    }

    #[test]
    fn zoom_has_ends_and_panning_is_exact() {
        let (mut scene, geometry) = scenes().remove(0);
        for _ in 0..100 {
            zoom_at(&mut scene, SIZE, DVec2::ZERO, 2.0);
        }
        assert_eq!(scene.camera.zoom, ZOOM[1]);
        stand(&mut scene, StandardView::Top);
        let point = DVec3::new(3.0, 4.0, 5.0);
        let before = view(&scene, &geometry, SIZE).project(point);
        pan(&mut scene, SIZE, DVec2::new(12.0, -7.0));
        assert!((view(&scene, &geometry, SIZE).project(point) - before - DVec2::new(12.0, -7.0)).length() < 1e-9);
    }
}
