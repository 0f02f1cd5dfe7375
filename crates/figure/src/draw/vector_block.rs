//! The paths of a block on a page: a group for each layer, horizon and fault.

use super::NamedColour;
use crate::convex::common;
use glam::DVec2;
use image::RgbaImage;
use page::Rect;
use page::list::{Cap, Group, GroupKind, Ink, Item, Path, PathItem, Picture, Rule, Segment, Stroke};
use render::vector::{AreaFill, PatternPaint, PatternPart, Polyline, VectorArea, VectorBlock, VectorLineKind};
use std::sync::Arc;
use ttf::{Colour, LayerStyle};

/// A line of its own colour around an area, so that no ground shows between neighbours, points.
const BLEED_PT: f64 = 0.12;

/// Contacts of very many layers are drawn finer, at most this share of what a layer has of the height on average: they would
/// be all that is seen.
const LAYER_SHARE: f64 = 0.25;

/// What the parts of a block are called, youngest first.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct BlockNames<'a> {
    /// Layers.
    pub layers: &'a [LayerStyle],
    /// Horizons.
    pub horizons: &'a [NamedColour],
    /// Faults, by their number in the model.
    pub faults: &'a [String],
}

impl BlockNames<'_> {
    /// The name of a layer counted from the deepest.
    pub(super) fn layer(&self, layer: u16) -> String {
        self.style(layer).map_or_else(|| format!("layer {}", layer + 1), |style| style.layer.clone())
    }

    /// How a layer counted from the deepest is drawn.
    pub(super) fn style(&self, layer: u16) -> Option<&LayerStyle> {
        let from_top = self.layers.len().checked_sub(1 + usize::from(layer));
        from_top.and_then(|index| self.layers.get(index))
    }

    /// The name of a fault.
    pub(super) fn fault(&self, fault: usize) -> String {
        self.faults.get(fault).cloned().unwrap_or_else(|| format!("fault {}", fault + 1))
    }
}

/// Where a block lies on its page, and what its parts are called there.
pub(super) struct OnPage<'a> {
    /// The painted picture, where it is needed.
    pub picture: Option<&'a Arc<RgbaImage>>,
    /// What the picture fills.
    pub pane: Rect,
    /// Names of layers, horizons and faults.
    pub names: &'a BlockNames<'a>,
    /// From pixels of the picture to the page.
    pub page: &'a dyn Fn(DVec2) -> DVec2,
}

impl OnPage<'_> {
    fn points_per_px(&self) -> f64 {
        (self.page)(DVec2::X).x - (self.page)(DVec2::ZERO).x
    }

    fn picture_of(&self, picture: &Arc<RgbaImage>) -> Picture {
        Picture::in_rect(Arc::clone(picture), self.pane)
    }
}

/// Whether the painted picture is needed as well.
pub(super) fn needs_picture(block: &VectorBlock) -> bool {
    let is_painted = |area: &VectorArea| matches!(area.fill, AreaFill::Picture);
    !block.has_areas || block.areas.iter().any(is_painted)
}

/// The items of a block.
pub(super) fn items(block: &VectorBlock, on_page: &OnPage) -> Vec<Item> {
    let OnPage { names, page, .. } = *on_page;
    let mut items: Vec<Item> = Vec::new();
    if let Some(picture) = on_page.picture.filter(|_| !block.has_areas) {
        let mut group = Group::new(GroupKind::Data, "picture");
        group.push(on_page.picture_of(picture));
        items.push(group.into());
    }
    items.extend(layers(block, on_page));
    if let Some(over) = &block.over {
        let mut group = Group::new(GroupKind::Data, "ground and wells");
        group.push(on_page.picture_of(over));
        items.push(group.into());
    }
    let contacts = block.lines.iter().filter(|line| matches!(line.kind, VectorLineKind::Horizon(Some(_)))).count();
    let widest = LAYER_SHARE * on_page.pane.height() / contacts.max(1) as f64;
    for line in &block.lines {
        let (kind, name) = match line.kind {
            VectorLineKind::Horizon(Some(index)) => {
                let name = names.horizons.get(index).map(|horizon| horizon.name.clone());
                (GroupKind::Horizon, name.unwrap_or_else(|| format!("horizon {}", index + 1)))
            }
            VectorLineKind::Horizon(None) => (GroupKind::Horizon, "contacts and crests".to_owned()),
            VectorLineKind::Fault(index) => (GroupKind::Fault, names.fault(index)),
            VectorLineKind::Edge => (GroupKind::Annotation, "edges".to_owned()),
        };
        let mut path = Path::default();
        for part in &line.parts {
            let is_ring = part.len() > 2 && part.first() == part.last();
            let points = if is_ring { &part[..part.len() - 1] } else { &part[..] };
            append(&mut path, points, is_ring, page);
        }
        let width = line.width_px * on_page.points_per_px();
        let width = if kind == GroupKind::Horizon { width.min(widest) } else { width };
        let stroke = Stroke::new(width, line.colour).round();
        let mut group = Group::new(kind, name);
        group.push(PathItem::stroked(path, stroke));
        items.push(group.into());
    }
    items
}

/// What a layer has on one face after the other: the number of the face, and items.
type OnFaces = Vec<(usize, Vec<Item>)>;

/// A group for each layer: what is seen of two areas of different layers or faces does not overlap.
fn layers(block: &VectorBlock, on_page: &OnPage) -> Vec<Item> {
    let mut layers: Vec<(u16, OnFaces)> = Vec::new();
    // Plain colours first: where facets of a wall meet, their bleed would cover patterns.
    let (colours, others): (Vec<_>, Vec<_>) = block.areas.iter().partition(|area| is_plain(area));
    for area in colours.into_iter().chain(others) {
        let place = layers.iter().position(|(layer, _)| *layer == area.layer).unwrap_or_else(|| {
            layers.push((area.layer, Vec::new()));
            layers.len() - 1
        });
        let item = filled(area, on_page);
        let faces = &mut layers[place].1;
        match faces.last_mut().filter(|(face, _)| *face == area.face) {
            Some((_, items)) => items.push(item),
            None => faces.push((area.face, vec![item])),
        }
    }
    let group = |(layer, faces): (u16, OnFaces)| {
        let seen = |(face, items): (usize, Vec<Item>)| {
            let hidden = block.hidden.get(face).map_or(&[][..], Vec::as_slice);
            hidden.iter().fold(items, |items, hidden| {
                let rest = less(hidden, on_page);
                vec![Group::new(GroupKind::Part, "seen").clipped(rest).with(items).into()]
            })
        };
        Group::new(GroupKind::Layer, on_page.names.layer(layer)).with(faces.into_iter().flat_map(seen)).into()
    };
    layers.into_iter().map(group).collect()
}

/// Whether an area is all of one colour.
fn is_plain(area: &VectorArea) -> bool {
    matches!(area.fill, AreaFill::Colour(_)) && area.band.is_none()
}

/// All of the pane less what is hidden: by the non-zero rule rings that turn against its own turn are holes.
fn less(hidden: &[Vec<DVec2>], on_page: &OnPage) -> Path {
    let Rect { min, max } = on_page.pane;
    let corners = [min, DVec2::new(max.x, min.y), max, DVec2::new(min.x, max.y)];
    let mut path = Path::default();
    append(&mut path, &corners, true, &|at| at);
    let is_alike = hidden.iter().map(|ring| twice_area(ring)).sum::<f64>() > 0.0;
    for ring in hidden {
        let against: Vec<DVec2> = if is_alike { ring.iter().rev().copied().collect() } else { ring.clone() };
        append(&mut path, &against, true, on_page.page);
    }
    path
}

/// An area, within the part of its face that is seen.
fn filled(area: &VectorArea, on_page: &OnPage) -> Item {
    let page = on_page.page;
    if let (AreaFill::Colour(colour), None, Some(pieces)) = (&area.fill, &area.band, &area.seen) {
        return seen_colour(area, *colour, pieces, page);
    }
    let mut outline = Path::default();
    area.rings.iter().for_each(|ring| append(&mut outline, ring, true, page));
    let mut band = Path::default();
    area.band.iter().flatten().for_each(|ring| append(&mut band, ring, true, page));
    let item: Item = match &area.fill {
        // Over the layer's own colour, up to whose edge it reaches.
        AreaFill::Colour(colour) if area.band.is_some() => {
            let filled = PathItem::filled(band.clone(), *colour);
            Group::new(GroupKind::Part, "interval").clipped(outline).with([filled.into()]).into()
        }
        AreaFill::Colour(colour) => {
            let filled = PathItem { rule: Rule::EvenOdd, ..PathItem::filled(outline, *colour) };
            filled.outlined(Stroke::new(BLEED_PT, *colour)).into()
        }
        AreaFill::Pattern(parts) => {
            let drawn = parts.iter().map(|part| part_item(part, page, on_page.points_per_px()).into());
            Group::new(GroupKind::Part, "pattern").clipped(outline).with(drawn).into()
        }
        AreaFill::Picture => {
            let painted = on_page.picture.map(|picture| on_page.picture_of(picture).into());
            Group::new(GroupKind::Part, "painted").clipped(outline).with(painted).into()
        }
    };
    let item = match area.band {
        Some(_) => Group::new(GroupKind::Part, "interval").clipped(band).with([item]).into(),
        None => item,
    };
    match &area.seen {
        None => item,
        Some(pieces) => {
            let mut seen = Path::default();
            pieces.iter().for_each(|piece| append(&mut seen, &same_turn(piece), true, page));
            Group::new(GroupKind::Part, "seen").clipped(seen).with([item]).into()
        }
    }
}

/// The seen part of an area in one colour: cut, not clipped, so that it bleeds as others do and no seam shows between the
/// facets of a curved wall.
fn seen_colour(area: &VectorArea, colour: Colour, pieces: &[Vec<DVec2>], page: &dyn Fn(DVec2) -> DVec2) -> Item {
    let bounds = |polygon: &[DVec2]| {
        let ends = |fold: fn(DVec2, DVec2) -> DVec2, from: DVec2| polygon.iter().copied().fold(from, fold);
        Rect::new(ends(DVec2::min, DVec2::INFINITY), ends(DVec2::max, DVec2::NEG_INFINITY))
    };
    let mut path = Path::default();
    for piece in pieces {
        let around = bounds(piece);
        for ring in area.rings.iter().filter(|ring| bounds(ring).meets(&around)) {
            common(ring, piece).into_iter().for_each(|part| append(&mut path, &part, true, page));
        }
    }
    let filled = PathItem { rule: Rule::EvenOdd, ..PathItem::filled(path, colour) };
    filled.outlined(Stroke::new(BLEED_PT, colour)).into()
}

/// A polygon that turns clockwise on the page: pieces side by side fill as one.
fn same_turn(piece: &[DVec2]) -> Vec<DVec2> {
    if twice_area(piece) < 0.0 { piece.iter().rev().copied().collect() } else { piece.to_vec() }
}

/// Twice the area of a polygon, with the sign of its turn.
fn twice_area(polygon: &[DVec2]) -> f64 {
    (0..polygon.len()).map(|n| polygon[n].perp_dot(polygon[(n + 1) % polygon.len()])).sum()
}

fn part_item(part: &PatternPart, page: &dyn Fn(DVec2) -> DVec2, points_per_px: f64) -> PathItem {
    let mut path = Path::default();
    for Polyline { points, closed } in &part.lines {
        append(&mut path, points, *closed, page);
    }
    let ink = Ink::glass(part.colour, part.opacity);
    match &part.paint {
        PatternPaint::Area { even_odd } => {
            let rule = if *even_odd { Rule::EvenOdd } else { Rule::NonZero };
            PathItem { rule, ..PathItem::filled(path, ink) }
        }
        PatternPaint::Line { width_px, dashes_px, round } => {
            let stroke = Stroke {
                dashes: dashes_px.iter().map(|dash| dash * points_per_px).collect(),
                cap: if *round { Cap::Round } else { Cap::Butt },
                ..Stroke::new(width_px * points_per_px, ink)
            };
            PathItem::stroked(path, stroke)
        }
    }
}

fn append(path: &mut Path, points: &[DVec2], closed: bool, page: &dyn Fn(DVec2) -> DVec2) {
    for (n, point) in points.iter().enumerate() {
        let at = page(*point);
        path.segments.push(if n == 0 { Segment::Move(at) } else { Segment::Line(at) });
    }
    if closed && !points.is_empty() {
        path.segments.push(Segment::Close);
    }
}
