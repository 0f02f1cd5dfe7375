//! What is written on and around a block: axes on its edges, names of layers along the layers, names and throws of
//! faults, wells and their tops.
//!
//! All labels share one `LabelRoom`: none lies over another or leaves the panel. Axes come first and the picture
//! shrinks until they stand beside it; then wells, half-arrows, names on the faces, and at last leaders to names that found no
//! place on their layer.

mod edges;
mod faults;
mod names;
mod room;
mod wells;

use super::moved::ON_BLOCK;
use super::seen::Sight;
use super::vector_block::BlockNames;
use crate::Rect;
use crate::annotation::Annotation;
use crate::convex::meet;
use crate::list::{Across, Group, GroupKind, Ink, Item, POINTS_PER_INCH, Path, PathItem, Stroke, Text, Upright};
use crate::style::{FRAME_PT, INK, QUIET_INK, TEXT_PT};
use glam::{DVec2, DVec3};
use model::StructuralModel;
use render::vector::{SeenSection, seen_sections};
use render::{FaceData, Faces, Scene, View};
use room::LabelRoom;
use survey::{SurveyGeometry, Well};
use ttf::Colour;

/// Most of its width and height that a picture gives up for labels beside it.
const MOST_SHRUNK: f64 = 0.55;
/// More room than labels were found to need: the picture is laid on whole pixels, points.
const SLACK_PT: f64 = 2.5;
/// How often room is made for labels: a picture in the middle of its room moves by half of what is taken off one side.
const ROUNDS: usize = 16;
/// Pixels a point at which room is made.
const PROBE_PX: f64 = 8.0;
/// From one ring of places that are tried for a name beside the block to the next, points; how many rings there are, and
/// places on each.
const LEADER_STEP_PT: f64 = 6.0;
const LEADER_RINGS: u32 = 26;
const LEADER_TURNS: u32 = 36;
/// The length that a leader may be longer to cross no axis, points.
const CROSSED_PT: f64 = 60.0;
/// The rim of names on faces, points, and its opacity.
const RIM_PT: f64 = 1.2;
const RIM_OPACITY: f32 = 0.9;

/// What is to be written on a block.
#[derive(Clone, Copy)]
pub struct BlockAnnotation<'a> {
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

/// A name that found no place on the block: where its leader may end, the best place first, and what it says.
type Beside = (Vec<DVec2>, String);

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
    pub fn pane(&self, room: Rect, scene: &Scene) -> Rect {
        let is_beside =
            self.wants(Annotation::Axes) || self.wants(Annotation::Layers) || self.wants(Annotation::Faults);
        if !is_beside {
            return room;
        }
        let mut pane = room;
        for _ in 0..ROUNDS {
            let size_px = (pane.size() * PROBE_PX).round().max(DVec2::ONE);
            let scene = Scene { size_px: [size_px.x as u32, size_px.y as u32], ..scene.clone() };
            let placed = Placed { view: scene.view(self.geometry), scene: &scene, pane, points_per_px: 1.0 / PROBE_PX };
            let mut anywhere = LabelRoom::new(room.grown(room.size().max_element()));
            let Some(taken) = texts(&self.axes(&placed, &mut anywhere)).map(Text::bounds).reduce(joined) else { break };
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

    /// Everything that is written, for a picture of `scene` that fills `pane` of a room.
    pub fn drawn(&self, room: Rect, pane: Rect, scene: &Scene, dpi: f64) -> Group {
        let view = scene.view(self.geometry);
        let placed = Placed { scene, view, pane, points_per_px: POINTS_PER_INCH / dpi };
        let mut free = LabelRoom::new(room);
        let mut group = Group::new(GroupKind::Annotation, ON_BLOCK);
        if self.wants(Annotation::Axes) {
            group.push(self.axes(&placed, &mut free));
        }
        let is_rock = scene.media.faces == Faces::All && scene.face_data == FaceData::Rock;
        if let Some(model) = self.model.filter(|_| is_rock) {
            let has_names = self.wants(Annotation::Layers) && scene.blend < 1.0;
            let has_faults = self.wants(Annotation::Faults);
            let faces = if has_names || has_faults { seen_sections(scene, self.geometry, model) } else { Vec::new() };
            let (mut on_faces, mut beside) = (Vec::new(), Vec::new());
            if self.wants(Annotation::Wells) && scene.wells.radius > 0.0 {
                let sight = Sight::new(scene, self.geometry, model);
                let frame = (self.geometry, &model.stratigraphy().horizons[..]);
                let named = wells::drawn(self.wells, frame, &sight, &placed, &mut free);
                on_faces.extend(named.into_iter().map(Item::from));
            }
            if has_faults {
                self.faults(model, &placed, &faces, &mut free, &mut on_faces, &mut beside);
            }
            if has_names {
                self.layers(model, &placed, &faces, &mut free, &mut on_faces, &mut beside);
            }
            group.items.extend(on_faces);
            let covered = |piece: &Vec<DVec2>| piece.iter().map(|px| placed.page(*px)).collect();
            let covered: Vec<Vec<DVec2>> = faces.iter().flat_map(|face| &face.pieces).map(covered).collect();
            for (anchors, name) in beside {
                group.items.extend(leader(&anchors, &name, &covered, &mut free).map(Item::from));
            }
        }
        group
    }

    fn axes(&self, placed: &Placed, room: &mut LabelRoom) -> Group {
        let block = placed.scene.box_in(self.geometry);
        let page = |voxel: DVec3| placed.page_from_voxel(voxel);
        edges::drawn(self.geometry, &placed.view, &block, placed.pane, &page, room)
    }

    /// The layer that is left out where the ground is shown.
    fn air(&self, scene: &Scene, model: &StructuralModel) -> Option<u16> {
        scene.ground.map(|_| render::ground::air_layer(model))
    }

    fn faults(
        &self,
        model: &StructuralModel,
        placed: &Placed,
        faces: &[SeenSection],
        room: &mut LabelRoom,
        on_faces: &mut Vec<Item>,
        beside: &mut Vec<Beside>,
    ) {
        let page_from_voxel = |voxel: DVec3| placed.page_from_voxel(voxel);
        let page = |px: DVec2| placed.page(px);
        let air = self.air(placed.scene, model);
        let runs = faults::runs(model, faces, &page_from_voxel, &page, air);
        let lines: Vec<Vec<DVec2>> = runs.iter().map(faults::FaultRun::line).collect();
        let mut named = Vec::new();
        for run in &runs {
            let throw = run.throw(model, self.geometry);
            let name = self.names.fault(run.fault);
            let mut group = Group::new(GroupKind::Fault, name.clone());
            let arrows = throw.and_then(|throw| run.arrows(throw, &page_from_voxel, room));
            group.items.extend(arrows.map(Item::from));
            named.push((run, faults::said(&name, throw, self.geometry), group));
        }
        // Names yield to the arrows of all faults.
        for (run, said, mut group) in named {
            match run.named(&said, &lines, room) {
                Some(text) => {
                    room.take(&text);
                    group.push(text);
                }
                None => beside.push((run.anchors(), said)),
            }
            if !group.items.is_empty() {
                on_faces.push(group.into());
            }
        }
    }

    fn layers(
        &self,
        model: &StructuralModel,
        placed: &Placed,
        faces: &[SeenSection],
        room: &mut LabelRoom,
        on_faces: &mut Vec<Item>,
        beside: &mut Vec<Beside>,
    ) {
        let page_from_voxel = |voxel: DVec3| placed.page_from_voxel(voxel);
        let page = |px: DVec2| placed.page(px);
        let pieces = names::pieces(faces, &page_from_voxel, &page, self.air(placed.scene, model));
        for layer in (0..model.layer_count() as u16).rev() {
            let name = self.names.layer(layer);
            let ground = self.names.style(layer).map_or(Colour::WHITE, |style| {
                style.interval_at(0.5).and_then(|interval| interval.colour).unwrap_or(style.colour)
            });
            let rim = if ground.luminance() < 0.3 { Colour::WHITE } else { ground };
            let text = Text::new(DVec2::ZERO, name.clone()).inked(INK).haloed(RIM_PT, Ink::glass(rim, RIM_OPACITY));
            let own = || pieces.iter().filter(|piece| piece.layer == layer);
            let best = own().filter_map(|piece| piece.named(&text, room)).max_by(|a, b| a.1.total_cmp(&b.1));
            if let Some((text, _)) = best {
                room.take(&text);
                on_faces.push(Group::new(GroupKind::Layer, name).with([text.into()]).into());
                continue;
            }
            let mut anchors: Vec<(DVec2, f64)> = own().filter_map(names::LayerPiece::thickest).collect();
            anchors.sort_by(|a, b| b.1.total_cmp(&a.1));
            if !anchors.is_empty() {
                beside.push((anchors.into_iter().map(|(anchor, _)| anchor).collect(), name));
            }
        }
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

/// A name beside the block with a line from what it names; `None` where it finds no place. `faces` are the parts of the
/// page that the block covers.
///
/// Places in rings around each anchor are tried; short leaders are best, and those that run across rather than up.
fn leader(anchors: &[DVec2], name: &str, faces: &[Vec<DVec2>], room: &mut LabelRoom) -> Option<Group> {
    // The name right and left of (0, 0), and its outline there.
    let sides = [(Across::Start, 2.0), (Across::End, -2.0)].map(|(across, aside)| {
        let text = Text::new(DVec2::new(aside, 0.0), name).sized(TEXT_PT - 0.5).anchored(across, Upright::Middle);
        let outline: Vec<DVec2> = room::outlines(&text).flatten().collect();
        (text, outline)
    });
    let mut best: Option<(f64, &Text, [DVec2; 2])> = None;
    for (rank, anchor) in anchors.iter().enumerate() {
        for ring in 1..=LEADER_RINGS {
            let length = f64::from(ring) * LEADER_STEP_PT;
            for turn in 0..LEADER_TURNS {
                let direction = DVec2::from_angle(f64::from(turn) / f64::from(LEADER_TURNS) * std::f64::consts::TAU);
                let end = *anchor + direction * length;
                let crossed = CROSSED_PT * room.crossings(*anchor, end) as f64;
                let cost = length * (1.0 + 0.35 * direction.y.abs()) + crossed + 4.0 * rank as f64;
                if best.as_ref().is_some_and(|(known, ..)| *known <= cost) {
                    continue;
                }
                let (text, outline) = &sides[usize::from(direction.x < 0.0)];
                let outline: Vec<DVec2> = outline.iter().map(|corner| *corner + end).collect();
                let is_outside = || !faces.iter().any(|face| meet(&outline, face));
                if room.is_area_free(&outline) && room.is_clear(*anchor, end) && is_outside() {
                    best = Some((cost, text, [*anchor, end]));
                }
            }
        }
    }
    let (_, text, [anchor, end]) = best?;
    let text = Text { at: text.at + end, ..text.clone() };
    room.take(&text);
    room.take_area(&[anchor, end]);
    let line = Path::line(&[anchor, end]);
    let rim = Stroke::new(FRAME_PT + 1.4, Ink::glass(Colour::WHITE, RIM_OPACITY));
    Some(Group::new(GroupKind::Annotation, format!("leader to {name}")).with([
        PathItem::stroked(line.clone(), rim).into(),
        PathItem::stroked(line, Stroke::new(FRAME_PT, QUIET_INK)).into(),
        PathItem::filled(Path::circle(anchor, 1.3), INK).outlined(Stroke::new(0.6, Colour::WHITE)).into(),
        text.into(),
    ]))
}
