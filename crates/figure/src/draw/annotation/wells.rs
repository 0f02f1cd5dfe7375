//! Wells on a block: a sign and a name where a well enters it, and the names of its tops where the well is seen.
//!
//! A well enters a block where its path first lies in it, or, below a ground, where it first lies in rock. That place is
//! seen on top faces as well as in cut-outs; tops are seen in cut-outs alone, or where nothing hides the well.

use super::Placed;
use super::room::LabelRoom;
use crate::draw::sight::Sight;
use crate::style::{FRAME_PT, INK, NUMBER_PT, TEXT_PT};
use glam::{DVec2, DVec3};
use page::list::{Across, Group, GroupKind, Ink, Path, PathItem, Stroke, Text, Upright};
use survey::well::is_same_surface;
use survey::{StratigraphicHorizon, SurveyGeometry, Well};
use ttf::Colour;

/// Radius of the sign of a well, points.
const SIGN_PT: f64 = 2.1;
/// From the sign to a name, and from a top to its name, points.
const OFF_PT: f64 = 4.0;
/// The rim of names, points, and its opacity.
const RIM_PT: f64 = 1.2;
const RIM_OPACITY: f32 = 0.9;
/// Where a name may stand about a place, the best direction first, x right and y down.
const ABOUT: [([f64; 2], Across); 6] = [
    ([0.0, -1.0], Across::Middle),
    ([0.8, -0.6], Across::Start),
    ([-0.8, -0.6], Across::End),
    ([1.0, 0.0], Across::Start),
    ([-1.0, 0.0], Across::End),
    ([0.0, 1.0], Across::Middle),
];
/// The longest distance of a name from its place, in steps of its height.
const STEPS: u32 = 3;

/// A group for each well that is seen.
pub(super) fn drawn(
    wells: &[Well],
    (geometry, horizons): (&SurveyGeometry, &[StratigraphicHorizon]),
    sight: &Sight,
    placed: &Placed,
    room: &mut LabelRoom,
) -> Vec<Group> {
    let sees = |voxel: DVec3| sight.sees(voxel) && placed.pane.contains(placed.page_from_voxel(voxel));
    // No letters on the wells themselves.
    for well in wells {
        for pair in well.path_in_voxels(geometry).windows(2).filter(|pair| pair.iter().all(|place| sees(*place))) {
            room.take_line(placed.page_from_voxel(pair[0]), placed.page_from_voxel(pair[1]));
        }
    }
    // The heads of all wells first: names of tops yield to them.
    let heads = wells.iter().map(|well| head(&well.path_in_voxels(geometry), sight, &sees));
    let heads: Vec<Option<DVec3>> = heads.collect();
    let mut groups: Vec<Group> = Vec::new();
    for (well, head) in wells.iter().zip(heads) {
        let mut group = Group::new(GroupKind::Well, &well.name);
        if let Some(head) = head {
            let at = placed.page_from_voxel(head);
            let name = Text::new(at, &well.name).sized(TEXT_PT);
            let is_on_rock = sight.is_rock(head + DVec3::Z);
            if let Some(name) = beside(at, &name, &ABOUT, if is_on_rock { SIGN_PT } else { 0.0 }, room) {
                if is_on_rock {
                    let ring = PathItem::filled(Path::circle(at, SIGN_PT), Colour::WHITE);
                    group.push(ring.outlined(Stroke::new(0.9, INK)));
                    group.push(PathItem::filled(Path::circle(at, 0.4 * SIGN_PT), INK));
                }
                room.take(&name);
                group.push(name);
            }
        }
        groups.push(group);
    }
    for (well, group) in wells.iter().zip(&mut groups) {
        for top in &well.tops {
            let Some(voxel) = well.voxel_at_md(top.md_m, geometry).filter(|voxel| sees(*voxel)) else { continue };
            let at = placed.page_from_voxel(voxel);
            let known = horizons.iter().find(|horizon| is_same_surface(&horizon.name, &top.name));
            let said = known.map_or(&top.name, |horizon| &horizon.name);
            let name = Text::new(at, said).sized(NUMBER_PT);
            let Some(name) = beside(at, &name, &ABOUT[3..5], 0.0, room) else { continue };
            room.take(&name);
            let foot = DVec2::new(name.at.x + if name.at.x > at.x { -1.0 } else { 1.0 }, name.at.y);
            let line = PathItem::stroked(Path::line(&[at, foot]), Stroke::new(FRAME_PT, INK));
            group.push(Group::new(GroupKind::Well, format!("{} {said}", well.name)).with([line.into(), name.into()]));
        }
    }
    groups.retain(|group| !group.items.is_empty());
    groups
}

/// Where a path enters the block, if that is seen.
fn head(path: &[DVec3], sight: &Sight, sees: &dyn Fn(DVec3) -> bool) -> Option<DVec3> {
    let places = path.windows(2).flat_map(|pair| (0..8).map(|n| pair[0].lerp(pair[1], f64::from(n) / 8.0)));
    let places: Vec<DVec3> = places.filter(|place| sight.is_within(*place)).collect();
    let entered = *places.first()?;
    let in_rock = places.iter().find(|place| sight.is_rock(**place)).copied();
    [Some(entered), in_rock].into_iter().flatten().find(|place| sees(*place))
}

/// A name about a place where there is room for it, no nearer than `sign`.
fn beside(at: DVec2, name: &Text, about: &[([f64; 2], Across)], sign: f64, room: &LabelRoom) -> Option<Text> {
    let name = name.clone().haloed(RIM_PT, Ink::glass(Colour::WHITE, RIM_OPACITY));
    let steps = (0..STEPS).flat_map(|step| about.iter().map(move |direction| (step, direction)));
    let mut placed = steps.map(|(step, (direction, across))| {
        let off = sign + OFF_PT + f64::from(step) * name.size;
        let place = at + DVec2::from_array(*direction) * off;
        // Words above and below stand clear of their place by half their height.
        let clear = DVec2::new(0.0, direction[1].signum() * 0.35 * name.size * direction[1].abs());
        Text { at: place + clear, ..name.clone() }.anchored(*across, Upright::Middle)
    });
    placed.find(|text| room.is_free(text))
}
