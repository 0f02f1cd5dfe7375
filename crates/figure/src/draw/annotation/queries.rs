//! Question marks on the lines of horizons where they were neither picked nor filled but only continued: such a line is
//! queried, as on geological maps.

use super::faces::FaceWriter;
use super::room::LabelRoom;
use crate::convex::holds;
use crate::style::{INK, TEXT_PT};
use glam::{DVec2, DVec3};
use model::section::{LineKind, LineQuality};
use page::list::{Across, Group, GroupKind, Ink, Text, Upright};
use render::vector::SeenSection;
use survey::StratigraphicHorizon;
use ttf::Colour;

/// Lines that are seen shorter than this carry no question mark, points.
const SHORTEST_PT: f64 = 24.0;
/// From one question mark to the next along a line, points.
const EVERY_PT: f64 = 110.0;
/// How far along its line a question mark may stand from where it would be best, points.
const ASIDE_PT: [f64; 5] = [0.0, 7.0, -7.0, 14.0, -14.0];
/// The rim of a question mark, points, and its opacity.
const RIM_PT: f64 = 1.2;
const RIM_OPACITY: f32 = 0.9;
/// How far below a line rock has to lie for it to be a line on rock, voxels.
const BELOW: f32 = 0.3;

/// A group for each horizon that has some.
pub(super) fn drawn(
    faces: &[SeenSection],
    horizons: &[StratigraphicHorizon],
    writer: &FaceWriter,
    room: &mut LabelRoom,
) -> Vec<Group> {
    let mut groups: Vec<Group> =
        horizons.iter().map(|horizon| Group::new(GroupKind::Horizon, format!("{}?", horizon.name))).collect();
    for face in faces {
        let seen: Vec<Vec<DVec2>> =
            face.pieces.iter().map(|piece| piece.iter().map(|px| (writer.page)(*px)).collect()).collect();
        for line in face.section.lines.iter().filter(|line| line.quality == LineQuality::Inferred) {
            let LineKind::Horizon { horizon } = line.kind else { continue };
            let Some(group) = groups.get_mut(horizon) else { continue };
            let place = |st: &DVec2| {
                let voxel: DVec3 = face.section.plane.voxel(*st);
                let at = (writer.page_from_voxel)(voxel);
                let below = voxel.as_vec3() + glam::Vec3::Z * BELOW;
                let is_rock = writer.air.is_none_or(|air| writer.model.region_at(below).layer != air);
                (is_rock && seen.iter().any(|piece| holds(piece, at))).then_some(at)
            };
            let places: Vec<Option<DVec2>> = line.points.iter().map(place).collect();
            for run in places.split(Option::is_none) {
                let run: Vec<DVec2> = run.iter().flatten().copied().collect();
                marks(&run, room).into_iter().for_each(|mark| group.push(mark));
            }
        }
    }
    groups.retain(|group| !group.items.is_empty());
    groups
}

/// The question marks along a line.
fn marks(run: &[DVec2], room: &mut LabelRoom) -> Vec<Text> {
    let length: f64 = run.windows(2).map(|pair| pair[0].distance(pair[1])).sum();
    if length < SHORTEST_PT {
        return Vec::new();
    }
    let count = (length / EVERY_PT).round().max(1.0);
    let mark = |n: usize| {
        let best = (n as f64 + 0.5) / count * length;
        let text = |aside: f64| {
            Text::new(along(run, best + aside), "?")
                .sized(TEXT_PT)
                .inked(INK)
                .haloed(RIM_PT, Ink::glass(Colour::WHITE, RIM_OPACITY))
                .anchored(Across::Middle, Upright::Middle)
        };
        ASIDE_PT.into_iter().map(text).find(|text| room.try_take(text))
    };
    (0..count as usize).filter_map(mark).collect()
}

/// The place this far along a line.
fn along(run: &[DVec2], length: f64) -> DVec2 {
    let mut left = length.max(0.0);
    for pair in run.windows(2) {
        let step = pair[0].distance(pair[1]);
        if left <= step {
            return pair[0].lerp(pair[1], if step > 0.0 { left / step } else { 0.0 });
        }
        left -= step;
    }
    run.last().copied().unwrap_or_default()
}

#[cfg(test)]
mod tests {
    use super::*;
    use page::Rect;

    #[test]
    fn long_lines_are_queried_again_and_again_and_short_ones_not_at_all() {
        let mut room = LabelRoom::new(Rect::sized(DVec2::ZERO, DVec2::new(500.0, 100.0)));
        let line = |to: f64| [DVec2::new(20.0, 50.0), DVec2::new(0.5 * (20.0 + to), 50.0), DVec2::new(to, 50.0)];
        assert!(marks(&line(40.0), &mut room).is_empty());
        let found = marks(&line(350.0), &mut room);
        assert_eq!(
            found.iter().map(|text| text.at).collect::<Vec<_>>(),
            [75.0, 185.0, 295.0].map(|x| { DVec2::new(x, 50.0) })
        );
        // Where something stands already, beside it.
        let again = marks(&line(350.0), &mut room);
        assert!(again.len() == 3 && again.iter().all(|text| text.at.x.rem_euclid(110.0) != 75.0));
    }
}
