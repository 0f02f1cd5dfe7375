//! Water over the ground of a block: a translucent body from the ground up to the block's top.
//!
//! Water and rock together fill the block but for its cut-outs, so what is seen of the water's surface is the part of
//! the seen faces that lies in the air layer: the upper face over the sea, and strips of the sides above the ground.
//! Where the ground rises above the water's level, what lies behind it is left out, found by rays.
//! Everything behind is seen through it once, as through the body's nearest surface.

use super::seen::Sight;
use crate::list::{Group, GroupKind, Ink, Item, Path, PathItem, Rule, Segment, Stroke};
use glam::{DVec2, DVec3};
use model::StructuralModel;
use model::section::band;
use rayon::prelude::*;
use render::vector::{SeenSection, sections_of};
use render::visible::Solid;
use render::{Scene, Water};
use std::collections::HashSet;
use survey::SurveyGeometry;
use ttf::Colour;

/// How much more opaque sides are than the upper face, so that the body has a shape.
const SIDES: f32 = 1.35;
/// Places closer than a part in so many of a voxel are one.
const ALIKE: f64 = 1e4;
/// Places across the picture that are asked whether ground hides water.
const PROBES: f64 = 500.0;
/// Ground hides water where it is nearer by more than this, voxels.
const BEFORE: f64 = 0.05;
/// Width of its edges, points.
const EDGE_PT: f64 = 0.5;

/// The water of a scene on the page; `None` without water or ground. `page` takes pixels of the scene to the page.
pub(crate) fn drawn(
    scene: &Scene,
    geometry: &SurveyGeometry,
    model: &StructuralModel,
    page: &dyn Fn(DVec2) -> DVec2,
) -> Option<Group> {
    let water = scene.water.filter(|_| scene.ground.is_some())?;
    let view = scene.view(geometry);
    let place = |voxel: DVec3| page(view.project(voxel));
    let mut group = Group::new(GroupKind::Layer, "Water");
    let mut below = scene.box_in(geometry);
    let is_lower = water.level.is_some_and(|level| level > below.min[2]);
    below.min[2] = water.level.map_or(below.min[2], |level| level.max(below.min[2]));
    let solid = Scene { roaming_box: Some(below), ..scene.clone() }.solid(geometry);
    if is_lower {
        group.clip = Some(before_ground(scene, geometry, model, &solid, page));
    }
    for face in sections_of(&solid, &view, model) {
        group.items.extend(on_face(&face, &water, render::ground::air_layer(model), &place, page));
    }
    (!group.items.is_empty()).then_some(group)
}

/// Where no ground that rises above the water hides it.
fn before_ground(
    scene: &Scene,
    geometry: &SurveyGeometry,
    model: &StructuralModel,
    below: &Solid,
    page: &dyn Fn(DVec2) -> DVec2,
) -> Path {
    let sight = Sight::new(scene, geometry, model);
    let size = DVec2::new(f64::from(scene.size_px[0]), f64::from(scene.size_px[1]));
    let step = (size.max_element() / PROBES).max(1.0);
    let cells = (size / step).ceil();
    let [columns, rows] = [cells.x as usize, cells.y as usize];
    let probe = |n: usize| {
        let node = DVec2::new((n / (rows + 1)) as f64, (n % (rows + 1)) as f64);
        sight.behind_water(below, node * step)
    };
    let behind: Vec<f64> = (0..(columns + 1) * (rows + 1)).into_par_iter().map(probe).collect();
    let rings = band([columns, rows], |x, y| behind[x * (rows + 1) + y], |_, _| true, [-BEFORE, f64::MAX]);
    let mut clip = Path::default();
    for ring in rings {
        clip.add_line(&ring.iter().map(|node| page(*node * step)).collect::<Vec<_>>());
        clip.segments.push(Segment::Close);
    }
    clip
}

/// The water on a face, within the part of it that is seen.
fn on_face(
    face: &SeenSection,
    water: &Water,
    air: u16,
    place: &dyn Fn(DVec3) -> DVec2,
    page: &dyn Fn(DVec2) -> DVec2,
) -> Option<Item> {
    let plane = face.section.plane;
    let polygons = face.section.polygons.iter().filter(|polygon| polygon.region.layer == air);
    let rings: Vec<&Vec<DVec2>> = polygons.flat_map(|polygon| &polygon.rings).collect();
    // One path for all fault blocks, and edges where water ends alone: no seams between blocks.
    let (mut area, mut edges) = (Path::default(), Path::default());
    let sides = || rings.iter().flat_map(|ring| (0..ring.len()).map(|n| [ring[n], ring[(n + 1) % ring.len()]]));
    let key = |at: DVec2| ((at * ALIKE).round()).to_array().map(|place| place as i64);
    let known: HashSet<[[i64; 2]; 2]> = sides().map(|side| side.map(key)).collect();
    for [from, to] in sides().filter(|[from, to]| !known.contains(&[key(*to), key(*from)])) {
        edges.add_line(&[from, to].map(|st| place(plane.voxel(st))));
    }
    for ring in &rings {
        area.add_line(&ring.iter().map(|st| place(plane.voxel(*st))).collect::<Vec<_>>());
        area.segments.push(Segment::Close);
    }
    let mut seen = Path::default();
    for piece in &face.pieces {
        let mut piece: Vec<DVec2> = piece.iter().map(|px| page(*px)).collect();
        let turn: f64 = (0..piece.len()).map(|n| piece[n].perp_dot(piece[(n + 1) % piece.len()])).sum();
        if turn < 0.0 {
            piece.reverse();
        }
        seen.add_line(&piece);
        seen.segments.push(Segment::Close);
    }
    let opacity = if face.axis == 2 { water.opacity } else { (SIDES * water.opacity).min(1.0) };
    let edge = Stroke::new(EDGE_PT, Ink::glass(water.colour, (2.0 * water.opacity).min(1.0)));
    let is_there = !area.segments.is_empty();
    let filled = PathItem { rule: Rule::EvenOdd, ..PathItem::filled(area, Ink::glass(water.colour, opacity)) };
    let body = [filled.into(), PathItem::stroked(edges, edge).into()];
    is_there.then(|| Group::new(GroupKind::Part, "seen").clipped(seen).with(body).into())
}

/// The colour of water on white paper, for legends.
pub(crate) fn colour_on_paper(water: &Water) -> Colour {
    let mixed =
        |channel: u8| 255.0 + (f32::from(channel) - 255.0) * SIDES.min(1.0 / water.opacity.max(1e-3)) * water.opacity;
    Colour { rgb: water.colour.rgb.map(|channel| mixed(channel).round() as u8) }
}
