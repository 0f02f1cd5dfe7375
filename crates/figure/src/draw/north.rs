//! The north arrow of a block: a needle that lies flat in the block's middle and is drawn as the block is.

use crate::style::{INK, TEXT_PT};
use glam::{DVec2, DVec3};
use page::Rect;
use page::list::{Across, Group, GroupKind, Path, PathItem, Stroke, Text, Upright};
use render::View;
use survey::SurveyGeometry;
use ttf::Colour;

/// Side of the square that holds an arrow, points.
pub(crate) const SIDE_PT: f64 = 36.0;
/// From the middle of the square to the farthest point of the needle, and to the middle of its letter, points.
const NEEDLE_PT: f64 = 9.0;
const LETTER_PT: f64 = 13.2;
/// A needle that is seen shorter than this share of its length points at the reader, and says nothing.
const LEAST: f64 = 0.02;
/// Step over which directions are measured, voxels.
const STEP: f64 = 0.01;

/// East and north at a place of a block as they lie on the page: pixels a metre, y down.
///
/// The map's axes are taken through the survey's own, so that mirrored and turned surveys point right.
pub(crate) fn compass(view: &View, geometry: &SurveyGeometry, voxel: DVec3) -> [DVec2; 2] {
    let origin = geometry.voxel_from_world(geometry.world_from_voxel(DVec3::ZERO));
    [DVec3::X, DVec3::Y].map(|metre| {
        let step = geometry.voxel_from_world(geometry.world_from_voxel(DVec3::ZERO) + metre) - origin;
        let length = step.length().max(f64::MIN_POSITIVE);
        let step = step * (STEP / length);
        (view.project(voxel + step) - view.project(voxel - step)) * (0.5 * length / STEP)
    })
}

/// The arrow in a square room; nothing where north points at the reader.
pub fn drawn(room: Rect, [east, north]: [DVec2; 2]) -> Group {
    let mut group = Group::new(GroupKind::Annotation, "north arrow");
    // Tip, barb, notch, barb; east and north of the middle.
    let needle = [[0.0, 1.0], [0.42, -0.9], [0.0, -0.5], [-0.42, -0.9]].map(|[x, y]| x * east + y * north);
    let longest = needle.iter().map(|p| p.length()).fold(0.0, f64::max);
    let seen = needle[0].length();
    if !(longest.is_finite() && seen > LEAST * east.length().max(north.length())) {
        return group;
    }
    let middle = room.centre();
    let [tip, right, notch, left] = needle.map(|p| middle + p * (NEEDLE_PT / longest));
    let half = |barb: DVec2, colour: Colour| {
        PathItem::filled(Path::polygon(&[tip, barb, notch]), colour).outlined(Stroke::new(0.5, INK))
    };
    group.push(half(right, Colour::WHITE));
    group.push(half(left, INK));
    let letter = Text::new(middle + needle[0] / seen * LETTER_PT, "N").sized(TEXT_PT);
    group.push(letter.anchored(Across::Middle, Upright::Middle));
    group
}

#[cfg(test)]
mod tests {
    use super::*;
    use page::list::Item;
    use render::{Projection, Scene};
    use survey::VerticalUnit;

    fn survey(inline: DVec2, crossline: DVec2) -> SurveyGeometry {
        let mut geometry = SurveyGeometry::regular([41, 31, 21], 25.0, 10.0, VerticalUnit::Metres);
        (geometry.inline_vector, geometry.crossline_vector) = (inline, crossline);
        geometry
    }

    fn view(geometry: &SurveyGeometry, azimuth_deg: f64, elevation_deg: f64, projection: Projection) -> View {
        let mut scene = Scene::default();
        scene.camera.azimuth_deg = Some(azimuth_deg);
        scene.camera.elevation_deg = elevation_deg;
        scene.camera.projection = projection;
        scene.view(geometry)
    }

    /// Seen from above and towards north, a map has north upwards and east to the right, however the lines run.
    #[test]
    fn maps_have_north_upwards_on_mirrored_and_turned_surveys_too() {
        let turn = DVec2::from_angle(0.7);
        let surveys = [
            (DVec2::new(25.0, 0.0), DVec2::new(0.0, 25.0)),
            (DVec2::new(0.0, 12.5), DVec2::new(25.0, 0.0)),
            (DVec2::new(25.0, 0.0), DVec2::new(0.0, -25.0)),
            (turn * 20.0, -turn.perp() * 12.5),
        ];
        for (inline, crossline) in surveys {
            let geometry = survey(inline, crossline);
            let at = DVec3::new(20.0, 15.0, 10.0);
            for azimuth in [0.0, 90.0, 215.0] {
                let view = view(&geometry, azimuth, 90.0, Projection::Orthographic);
                let [east, north] = compass(&view, &geometry, at).map(DVec2::normalize);
                // Clockwise from upwards on the page: north lies as far to the left as the reader looks to the right.
                let bearing = north.x.atan2(-north.y).to_degrees();
                assert!(((bearing + azimuth + 180.0).rem_euclid(360.0) - 180.0).abs() < 1e-3, "{bearing} at {azimuth}");
                assert!(north.perp_dot(east) > 0.999, "east is right of north: {north} {east}");
            }
        }
    }

    /// The arrow points where a place a little further north is drawn.
    #[test]
    fn perspective_is_that_of_the_place() {
        let geometry = survey(DVec2::new(20.0, 10.0), DVec2::new(10.0, -20.0));
        let view = view(&geometry, 30.0, 25.0, Projection::Perspective { fov_deg: 60.0 });
        let directions = [DVec3::new(2.0, 3.0, 5.0), DVec3::new(38.0, 28.0, 5.0)].map(|at| {
            let north = compass(&view, &geometry, at)[1];
            let further = geometry.voxel_from_world(geometry.world_from_voxel(at) + DVec3::Y);
            assert!((view.project(further) - view.project(at) - north).length() < 1e-2 * north.length());
            north.normalize()
        });
        assert!(directions[0].angle_to(directions[1]).abs() > 0.02, "perspective turns it from place to place");
    }

    #[test]
    fn the_letter_stands_at_the_tip_within_the_room() {
        let room = Rect::sized(DVec2::new(100.0, 50.0), DVec2::splat(SIDE_PT));
        for n in 0..72 {
            let turn = DVec2::from_angle(f64::from(n) / 72.0 * std::f64::consts::TAU);
            let group = drawn(room, [turn.perp(), turn * DVec2::new(1.0, 0.4)]);
            let Some(Item::Text(letter)) = group.items.last() else { panic!("no letter") };
            let bounds = letter.bounds();
            assert!(room.min.cmple(bounds.min).all() && bounds.max.cmple(room.max).all(), "{bounds:?}");
            let off = letter.bounds().centre() - room.centre();
            assert!(off.dot(turn * DVec2::new(1.0, 0.4)) > 0.0);
        }
        assert!(drawn(room, [DVec2::X, DVec2::Y * 1e-9]).items.is_empty());
        assert!(drawn(room, [DVec2::NAN; 2]).items.is_empty());
    }
}
