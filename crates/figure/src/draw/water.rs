//! Water over the ground of a block: a translucent body from the ground up to the block's top.
//!
//! Water and rock together fill the block but for its cut-outs, so what is seen of the water's surface is the part of
//! the seen faces that lies in the air layer: the upper face over the sea, and strips of the sides above the ground.
//! Where the ground rises above the water's level, what lies behind it is left out, found by rays.
//! Everything behind is seen through it once, as through the body's nearest surface. Wells that stand before it, in
//! cut-outs, are drawn again over it: the picture without water, within their outlines.

use super::block::pixels_per_metre;
use super::sight::Sight;
use glam::{DVec2, DVec3};
use image::RgbaImage;
use model::StructuralModel;
use model::section::band;
use page::Rect;
use page::list::{
    DisplayList, Group, GroupKind, Ink, Item, POINTS_PER_INCH, Path, PathItem, Picture, Rule, Segment, Stroke,
};
use rayon::prelude::*;
use render::vector::{SeenSection, sections_of};
use render::visible::Solid;
use render::{DrawnWell, Inputs, Scene, Water};
use std::collections::HashSet;
use std::sync::Arc;
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
/// Longest part of a well that is before water or not as one, pixels.
const WELL_PX: f64 = 3.0;
/// Most parts that a straight piece of a well is divided into.
const MOST_PARTS: f64 = 2000.0;
/// How much narrower a well is drawn over water than it is, so that nothing beside it shows, pixels.
const WITHIN_PX: f64 = 0.5;

/// How much wider than the tube the ring of a top is, and half its height in radii of the tube (`render::wells`).
const TOP: [f64; 2] = [1.6, 0.6];

/// A picture of a scene at a resolution, dots an inch, with its water over it; without water, or where it is larger than
/// pages are, the picture as it is.
pub fn over(picture: RgbaImage, scene: &Scene, inputs: &Inputs, dpi: f64) -> RgbaImage {
    let (Some(model), true) = (inputs.model, scene.water.is_some() && scene.ground.is_some()) else {
        return picture;
    };
    let page = |px: DVec2| px * POINTS_PER_INCH / dpi;
    let Some(water) = drawn(scene, inputs.geometry, model, &page) else { return picture };
    let size = page(DVec2::new(f64::from(picture.width()), f64::from(picture.height())));
    let (picture, pane) = (Arc::new(picture), Rect::sized(DVec2::ZERO, size));
    let mut list = DisplayList { paper: None, ..DisplayList::new(size) };
    list.items.push(Picture::in_rect(Arc::clone(&picture), pane).into());
    list.items.push(water.into());
    let wells = wells_before(scene, inputs.geometry, model, inputs.wells, &page);
    list.items.extend(wells.map(|outline| again(&picture, pane, outline).into()));
    page::raster(&list, dpi).unwrap_or_else(|_| Arc::unwrap_or_clone(picture))
}

/// What of a picture lies within an outline, once more.
pub(super) fn again(picture: &Arc<RgbaImage>, pane: Rect, outline: Path) -> Group {
    let picture = Picture::in_rect(Arc::clone(picture), pane);
    Group::new(GroupKind::Part, "wells before water").clipped(outline).with([picture.into()])
}

/// The outlines of the parts of wells that stand before water; `None` where none does.
pub(super) fn wells_before(
    scene: &Scene,
    geometry: &SurveyGeometry,
    model: &StructuralModel,
    wells: &[DrawnWell],
    page: &dyn Fn(DVec2) -> DVec2,
) -> Option<Path> {
    let is_shown = |well: &&DrawnWell| scene.wells.radius > 0.0 && !scene.hides_well(well.name);
    let shown: Vec<&DrawnWell> = wells.iter().filter(is_shown).collect();
    if shown.is_empty() {
        return None;
    }
    let view = scene.view(geometry);
    let sight = Sight::new(scene, geometry, model);
    let (_, solid) = below_level(scene, geometry, &scene.water?);
    let [low, high] = [scene.box_in(geometry).low(), scene.box_in(geometry).high()];
    let sides = view.display_from_voxel() * (high - low);
    let radius_m = f64::from(scene.wells.radius) * sides.abs().max_element();
    let parts_of = |pair: &[DVec3]| {
        let [from, to] = [pair[0], pair[1]];
        let length_px = view.project(from).distance(view.project(to));
        let count = (length_px / WELL_PX).ceil().clamp(1.0, MOST_PARTS) as usize;
        let at = move |n: usize| from.lerp(to, n as f64 / count as f64);
        (0..count).map(move |n| ([at(n), at(n + 1)], 1.0))
    };
    let tubes = shown.iter().flat_map(|well| well.path.windows(2).flat_map(parts_of));
    // Rings at tops, across the piece of the path on which they lie.
    let rings = shown.iter().flat_map(|well| {
        well.tops.iter().filter_map(|top| {
            let off = |pair: &&[DVec3]| top.distance(pair[0]) + top.distance(pair[1]) - pair[0].distance(pair[1]);
            let pair = well.path.windows(2).min_by(|a, b| off(a).total_cmp(&off(b)))?;
            let along = view.display_from_voxel() * (pair[1] - pair[0]);
            let half = (pair[1] - pair[0]) * (radius_m * TOP[1] / along.length().max(f64::MIN_POSITIVE));
            Some(([*top - half, *top + half], TOP[0]))
        })
    });
    let mut outline = Path::default();
    for ([from, to], wide) in tubes.chain(rings) {
        let middle = 0.5 * (from + to);
        if !sight.is_before_water(&solid, middle) {
            continue;
        }
        let [a, b] = [from, to].map(|end| view.project(end));
        let half = (wide * radius_m * pixels_per_metre(&view, middle) - WITHIN_PX).max(0.5);
        // Parts overlap a little, so that no gaps are between them.
        let along = (b - a).normalize_or(DVec2::Y) * 0.1;
        let beside = along.perp().normalize() * half;
        outline.add_line(&[a - along - beside, b + along - beside, b + along + beside, a - along + beside].map(page));
        outline.segments.push(Segment::Close);
    }
    (!outline.segments.is_empty()).then_some(outline)
}

/// Whether the water ends below the top of the block, and what of the block lies below its level.
fn below_level(scene: &Scene, geometry: &SurveyGeometry, water: &Water) -> (bool, Solid) {
    let mut below = scene.box_in(geometry);
    let is_lower = water.level.is_some_and(|level| level > below.min[2]);
    below.min[2] = water.level.map_or(below.min[2], |level| level.max(below.min[2]));
    (is_lower, Scene { roaming_box: Some(below), ..scene.clone() }.solid(geometry))
}

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
    let (is_lower, solid) = below_level(scene, geometry, &water);
    if is_lower {
        group.clip = Some(before_ground(scene, geometry, model, &solid, page));
    }
    for face in sections_of(&solid, &view, model) {
        group.items.extend(on_face(&face, &water, render::ground::air_layer(model), &place, page));
    }
    (!group.items.is_empty()).then_some(group)
}

/// Whether any water is seen of a scene.
pub(crate) fn has_water(scene: &Scene, geometry: &SurveyGeometry, model: &StructuralModel) -> bool {
    let Some(water) = scene.water.filter(|_| scene.ground.is_some()) else { return false };
    let (_, solid) = below_level(scene, geometry, &water);
    let air = render::ground::air_layer(model);
    let is_wet = |face: &SeenSection| face.section.polygons.iter().any(|polygon| polygon.region.layer == air);
    sections_of(&solid, &scene.view(geometry), model).iter().any(is_wet)
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
