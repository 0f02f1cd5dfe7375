//! What is written on and around a block: axes on its edges, names of layers along the layers, names and throws of
//! faults, wells and their tops.
//!
//! All labels share one `LabelRoom`: none lies over another or leaves the panel. Axes come first and the picture
//! shrinks until they stand beside it; then wells, half-arrows, names on the faces, and at last leaders to names that found no
//! place on their layer, of many layers in a column beside the block.

mod column;
mod edges;
mod faces;
mod faults;
mod names;
mod queries;
pub(crate) mod room;
mod wells;

pub(crate) use faces::{FaceLabels, FaceWriter, leader};
pub(crate) use names::turning;
pub(crate) use room::{LabelRoom, outlines};

use super::label_changes::ON_BLOCK;
use super::sight::Sight;
use super::vector_block::BlockNames;
use crate::annotation::Annotation;
use crate::convex::{area, within};
use glam::{DVec2, DVec3};
use model::StructuralModel;
use page::Rect;
use page::list::{Group, GroupKind, Item, POINTS_PER_INCH, Text};
use render::vector::seen_sections;
use render::{FaceData, Faces, Scene, Unpicked, View};
use survey::{SurveyGeometry, Well};

/// Most of its width and height that a picture gives up for labels beside it.
const MOST_SHRUNK: f64 = 0.55;
/// More room than labels were found to need: the picture is laid on whole pixels, points.
const SLACK_PT: f64 = 2.5;
/// How often room is made for labels: a picture in the middle of its room moves by half of what is taken off one side.
const ROUNDS: usize = 16;
/// Pieces of faces that are smaller than this are too thin to be written on, square pixels.
const LEAST_PIECE_PX: f64 = 0.5;
/// Pixels a point at which room is made.
const PROBE_PX: f64 = 8.0;

/// What is to be written on a block.
#[derive(Clone, Copy)]
pub(crate) struct BlockAnnotation<'a> {
    /// Which kinds.
    pub wanted: &'a [Annotation],
    /// Where its samples are.
    pub geometry: &'a SurveyGeometry,
    /// Its layers and faults; without a model there are axes alone.
    pub model: Option<&'a StructuralModel>,
    /// What they are called.
    pub names: BlockNames<'a>,
    /// The wells of the project.
    pub wells: &'a [Well],
}

/// A picture of a block in its place on the page.
struct Placed<'a> {
    scene: &'a Scene,
    view: View,
    /// The picture.
    pane: Rect,
    points_per_px: f64,
}

impl Placed<'_> {
    fn page(&self, px: DVec2) -> DVec2 {
        self.pane.min + px * self.points_per_px
    }

    fn page_from_voxel(&self, voxel: DVec3) -> DVec2 {
        self.page(self.view.project(voxel))
    }
}

impl BlockAnnotation<'_> {
    fn wants(&self, annotation: Annotation) -> bool {
        self.wanted.contains(&annotation)
    }

    /// Where in its room the picture of a block lies, so that axes stand beside it.
    pub(crate) fn pane(&self, room: Rect, scene: &Scene) -> Rect {
        let is_beside = [Annotation::Axes, Annotation::Layers, Annotation::Faults, Annotation::Heave]
            .into_iter()
            .any(|kind| self.wants(kind));
        if !is_beside {
            return room;
        }
        let mut pane = room;
        for _ in 0..ROUNDS {
            let size_px = (pane.size() * PROBE_PX).round().max(DVec2::ONE);
            let scene = Scene { size_px: [size_px.x as u32, size_px.y as u32], ..scene.clone() };
            let placed = Placed { view: scene.view(self.geometry), scene: &scene, pane, points_per_px: 1.0 / PROBE_PX };
            let mut anywhere = LabelRoom::new(room.grown(room.size().max_element()));
            let axes = self.axes(&placed, &mut anywhere);
            let Some(taken) = texts(&axes).map(Text::bounds).chain(self.beside(&placed)).reduce(joined) else { break };
            let over = [
                room.min.x - taken.min.x,
                room.min.y - taken.min.y,
                taken.max.x - room.max.x,
                taken.max.y - room.max.y,
            ]
            .map(|over| if over > 0.0 { over + SLACK_PT } else { 0.0 });
            if over == [0.0; 4] {
                break;
            }
            pane = pane.inside(over);
            if (pane.size() / room.size()).min_element() < 1.0 - MOST_SHRUNK || !pane.is_proper() {
                return room;
            }
        }
        pane
    }

    /// The room to the right of a block of many layers in which their names stand.
    fn beside(&self, placed: &Placed) -> Option<Rect> {
        let names = self.names.layers.iter().map(|style| style.layer.as_str());
        if !self.wants(Annotation::Layers) || self.model.is_none() || names.len() < faces::COLUMN_FROM {
            return None;
        }
        let block = placed.scene.box_in(self.geometry);
        let corners = [block.low(), block.high()];
        let edge = |n: usize| {
            let [x, y] = [corners[n & 1].x, corners[n >> 1].y];
            [0, 1].map(|end: usize| placed.page_from_voxel(DVec3::new(x, y, corners[end].z)))
        };
        let [upper, lower] = (0..4).map(edge).max_by(|a, b| a[0].x.total_cmp(&b[0].x))?;
        let margin = column::margin(names, upper.distance(lower));
        (margin > 0.0).then(|| Rect::new(upper.min(lower), upper.max(lower) + DVec2::X * margin))
    }

    /// Everything that is written, for a picture of `scene` that fills `pane` of a room.
    pub(crate) fn drawn(&self, room: Rect, pane: Rect, scene: &Scene, dpi: f64) -> Group {
        let view = scene.view(self.geometry);
        let placed = Placed { scene, view, pane, points_per_px: POINTS_PER_INCH / dpi };
        let mut free = LabelRoom::new(room);
        let mut group = Group::new(GroupKind::Annotation, ON_BLOCK);
        if self.wants(Annotation::Axes) {
            group.push(self.axes(&placed, &mut free));
        }
        let is_rock = scene.media.faces == Faces::All && scene.face_data == FaceData::Rock;
        if let Some(model) = self.model.filter(|_| is_rock) {
            let wanted = FaceLabels {
                layers: self.wants(Annotation::Layers) && scene.blend < 1.0,
                faults: self.wants(Annotation::Faults) || self.wants(Annotation::Heave),
                heave: self.wants(Annotation::Heave),
                queries: scene.outlines.unpicked == Unpicked::Dashed,
            };
            let mut faces = if wanted.any() { seen_sections(scene, self.geometry, model) } else { Vec::new() };
            // Of a block that is larger than its picture, what lies beyond is not seen.
            let picture = Rect::sized(DVec2::ZERO, DVec2::from(scene.size_px.map(f64::from)));
            for face in &mut faces {
                let seen = face.pieces.iter().filter_map(|piece| within(piece, picture));
                // Faces seen along their plane are not seen.
                face.pieces = seen.filter(|piece| area(piece) > LEAST_PIECE_PX).collect();
            }
            faces.retain(|face| !face.pieces.is_empty());
            if self.wants(Annotation::Wells) && scene.wells.radius > 0.0 {
                let sight = Sight::new(scene, self.geometry, model);
                let frame = (self.geometry, &model.stratigraphy().horizons[..]);
                let named = wells::drawn(self.wells, frame, &sight, &placed, &mut free);
                group.items.extend(named.into_iter().map(Item::from));
            }
            let covered = |piece: &Vec<DVec2>| piece.iter().map(|px| placed.page(*px)).collect();
            let writer = FaceWriter {
                model,
                geometry: self.geometry,
                names: self.names,
                air: scene.ground.map(|_| render::ground::air_layer(model)),
                page_from_voxel: &|voxel| placed.page_from_voxel(voxel),
                page: &|px| placed.page(px),
                covered: faces.iter().flat_map(|face| &face.pieces).map(covered).collect(),
            };
            group.items.extend(writer.written(&faces, wanted, &mut free));
        }
        group
    }

    fn axes(&self, placed: &Placed, room: &mut LabelRoom) -> Group {
        let block = placed.scene.box_in(self.geometry);
        let page = |voxel: DVec3| placed.page_from_voxel(voxel);
        let scene = placed.scene;
        let has_edges = scene.media.faces == Faces::All && scene.outlines.edges.width_px > 0.0;
        let solid = scene.solid(self.geometry);
        let ground = self.model.filter(|_| scene.ground.is_some());
        let is_rock = |p: DVec3| {
            let p = p.as_vec3();
            has_edges && solid.contains(p) && !ground.is_some_and(|model| render::ground::is_air(model, p))
        };
        edges::drawn(self.geometry, &placed.view, &block, placed.pane, &page, &is_rock, room)
    }
}

fn joined(one: Rect, other: Rect) -> Rect {
    one.around(other.min).around(other.max)
}

/// The texts of a group without groups.
fn texts(group: &Group) -> impl Iterator<Item = &Text> {
    group.items.iter().filter_map(|item| match item {
        Item::Text(text) => Some(text),
        _ => None,
    })
}
