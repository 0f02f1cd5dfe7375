//! What is written on faces of rock, of a block or of a section: names of layers along the layers, names and throws of
//! faults, question marks on lines that are only continued, and leaders to names that found no place.

use super::column::{self, LayerEnd};
use super::room::LabelRoom;
use super::{faults, names, queries, room};
use crate::convex::meet;
use crate::draw::vector_block::BlockNames;
use crate::style::{FRAME_PT, INK, QUIET_INK, TEXT_PT};
use glam::{DVec2, DVec3};
use model::{FaultThrows, StructuralModel};
use page::list::{Across, Group, GroupKind, Ink, Item, Path, PathItem, Stroke, Text, Upright};
use rayon::prelude::*;
use render::vector::SeenSection;
use std::collections::HashSet;
use survey::SurveyGeometry;
use ttf::Colour;

/// From one ring of places that are tried for a name beside the block to the next, points; how many rings there are, and
/// places on each.
const LEADER_STEP_PT: f64 = 6.0;
const LEADER_RINGS: u32 = 26;
const LEADER_TURNS: u32 = 36;
/// The length that a leader may be longer to cross no axis, points.
const CROSSED_PT: f64 = 60.0;
/// From so many names without a place on their layer they stand in a column beside the block.
pub(super) const COLUMN_FROM: usize = 5;
/// Most names of layers with leaders of their own: more are a tangle, and the legend lists them.
const MOST_LEADERS: usize = 8;
/// The rim of names on faces, points, and its opacity.
const RIM_PT: f64 = 1.2;
const RIM_OPACITY: f32 = 0.9;
/// The rim of names that stand on a pattern hides it whole: what is left of it between letters looks like dirt.
const ON_PATTERN_RIM_PT: f64 = 1.7;
/// Radius of the dot at the end of a leader, points.
const DOT_PT: f64 = 1.3;

/// What is written on faces.
#[derive(Debug, Clone, Copy)]
pub(crate) struct FaceLabels {
    /// Names along layers.
    pub layers: bool,
    /// Names, throws and half-arrows of faults.
    pub faults: bool,
    /// Their heave, too.
    pub heave: bool,
    /// Question marks on lines of horizons that are only continued.
    pub queries: bool,
}

impl FaceLabels {
    /// Whether there is anything to write.
    pub(crate) fn any(self) -> bool {
        self.layers || self.faults || self.queries
    }
}

/// Writes on faces of a model.
pub(crate) struct FaceWriter<'a> {
    /// Its layers and faults.
    pub model: &'a StructuralModel,
    /// Where its samples are.
    pub geometry: &'a SurveyGeometry,
    /// What they are called.
    pub names: BlockNames<'a>,
    /// The layer that is left out, where the ground is shown.
    pub air: Option<u16>,
    /// Takes voxels to the page.
    pub page_from_voxel: &'a dyn Fn(DVec3) -> DVec2,
    /// Takes places of the faces' seen pieces to the page.
    pub page: &'a dyn Fn(DVec2) -> DVec2,
    /// The parts of the page on which no leader ends.
    pub covered: Vec<Vec<DVec2>>,
}

/// A name that found no place on the faces.
struct Beside {
    /// Where its leader may end, the best place first.
    anchors: Vec<DVec2>,
    /// What is named.
    name: String,
    /// What is written.
    said: String,
}

impl FaceWriter<'_> {
    /// Everything that is written on faces.
    pub(crate) fn written(&self, faces: &[SeenSection], wanted: FaceLabels, room: &mut LabelRoom) -> Vec<Item> {
        let (mut written, mut beside) = (Vec::new(), Vec::new());
        let mut faults = Vec::new();
        if wanted.faults {
            faults = self.faults(faces, wanted.heave, room, &mut written, &mut beside);
        }
        if wanted.layers {
            self.layers(faces, room, &mut written, &mut beside);
        }
        // Leaders cross no fault where they can help it.
        for pair in faults.iter().flat_map(|line| line.windows(2)) {
            room.take_line(pair[0], pair[1]);
        }
        for Beside { anchors, name, said } in beside {
            let led = leader(&anchors, &said, &self.covered, room);
            written.extend(led.map(|group| Group { name, ..group }.into()));
        }
        if wanted.queries {
            let horizons = &self.model.stratigraphy().horizons;
            written.extend(queries::drawn(faces, horizons, self, room).into_iter().map(Item::from));
        }
        written
    }

    /// Writes what is said of faults, and returns their lines on the page.
    fn faults(
        &self,
        faces: &[SeenSection],
        has_heave: bool,
        room: &mut LabelRoom,
        written: &mut Vec<Item>,
        beside: &mut Vec<Beside>,
    ) -> Vec<Vec<DVec2>> {
        let runs = faults::runs((self.model, self.geometry), faces, self.page_from_voxel, self.page, self.air);
        let lines: Vec<Vec<DVec2>> = runs.iter().map(faults::FaultRun::line).collect();
        let mut named = Vec::new();
        let throw = |run: &faults::FaultRun| {
            let sense = FaultThrows::new(self.model, run.fault).sense()?;
            run.throw((self.model, self.geometry), sense)
        };
        let throws: Vec<Option<faults::FaceThrow>> = runs.par_iter().map(throw).collect();
        for (run, throw) in runs.iter().zip(throws) {
            let name = self.names.fault(run.fault);
            let mut group = Group::new(GroupKind::Fault, name.clone());
            let arrows = throw.and_then(|throw| run.arrows(throw, self.page_from_voxel, room));
            group.items.extend(arrows.map(Item::from));
            named.push((run, faults::said(&name, throw, self.geometry, has_heave), group));
        }
        // Names yield to the arrows of all faults.
        for (run, said, mut group) in named {
            match run.named(&said, &lines, room) {
                Some(text) => {
                    room.take(&text);
                    group.push(text);
                }
                None => beside.push(Beside { anchors: run.anchors(&lines), name: group.name.clone(), said }),
            }
            if !group.items.is_empty() {
                written.push(group.into());
            }
        }
        lines
    }

    fn layers(&self, faces: &[SeenSection], room: &mut LabelRoom, written: &mut Vec<Item>, beside: &mut Vec<Beside>) {
        let (mut ends, mut thin): (Vec<LayerEnd>, Vec<(f64, Beside)>) = (Vec::new(), Vec::new());
        let pieces = names::pieces(faces, self.page_from_voxel, self.page, self.air);
        let edge = names::right_edge(&pieces);
        for layer in (0..self.model.layer_count() as u16).rev() {
            let name = self.names.layer(layer);
            let ground = self.names.style(layer).map_or(Colour::WHITE, |style| {
                style.interval_at(0.5).and_then(|interval| interval.colour).unwrap_or(style.colour)
            });
            let rim = if ground.luminance() < 0.3 { Colour::WHITE } else { ground };
            let text = Text::new(DVec2::ZERO, name.clone()).inked(INK).haloed(ON_PATTERN_RIM_PT, rim);
            let own = || pieces.iter().filter(|piece| piece.layer == layer);
            let best = own().filter_map(|piece| piece.named(&text, room)).max_by(|a, b| a.1.total_cmp(&b.1));
            if let Some((text, _)) = best {
                room.take(&text);
                written.push(Group::new(GroupKind::Layer, name).with([text.into()]).into());
                continue;
            }
            let end = own().filter_map(|piece| piece.before(edge)).max_by(|a, b| a.1.total_cmp(&b.1));
            ends.extend(end.map(|(at, thick)| LayerEnd { at, thick, name: name.clone() }));
            let mut anchors: Vec<(DVec2, f64)> = own().filter_map(names::LayerPiece::thickest).collect();
            anchors.sort_by(|a, b| b.1.total_cmp(&a.1));
            if let Some((_, thick)) = anchors.first().copied() {
                let anchors = anchors.into_iter().map(|(anchor, _)| anchor).collect();
                thin.push((thick, Beside { anchors, said: name.clone(), name }));
            }
        }
        if thin.len() >= COLUMN_FROM && ends.len() >= COLUMN_FROM {
            let names: HashSet<String> = ends.iter().map(|end| end.name.clone()).collect();
            let column = column::placed(ends, edge, room);
            if !column.is_empty() {
                thin.retain(|(_, beside)| !names.contains(&beside.name));
            }
            written.extend(column.into_iter().map(Item::from));
        }
        thin.sort_by(|a, b| b.0.total_cmp(&a.0));
        beside.extend(thin.into_iter().take(MOST_LEADERS).map(|(_, name)| name));
    }
}

/// A name beside the block with a line from what it names; `None` where it finds no place. `faces` are the parts of the
/// page that the block covers.
///
/// Places in rings around each anchor are tried; short leaders are best, and those that run across rather than up.
pub(crate) fn leader(anchors: &[DVec2], name: &str, faces: &[Vec<DVec2>], room: &mut LabelRoom) -> Option<Group> {
    // The name right and left of (0, 0), and its outline there.
    let sides = [(Across::Start, 2.0), (Across::End, -2.0)].map(|(across, aside)| {
        let text = Text::new(DVec2::new(aside, 0.0), name).sized(TEXT_PT - 0.5).anchored(across, Upright::Middle);
        let text = text.haloed(RIM_PT, Ink::glass(Colour::WHITE, RIM_OPACITY));
        let outline: Vec<DVec2> = room::outlines(&text).flatten().collect();
        (text, outline)
    });
    let mut best: Option<(f64, &Text, [DVec2; 2])> = None;
    // The dots of two leaders touch neither one another nor the other's line.
    let is_dot_free = |anchor: &DVec2| {
        let [a, b, c, d] = dot(*anchor);
        room.is_clear(a, c) && room.is_clear(b, d)
    };
    for (rank, anchor) in anchors.iter().enumerate().filter(|(_, anchor)| is_dot_free(anchor)) {
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
    room.take_area(&dot(anchor));
    Some(led([anchor, end], DOT_PT, name, text))
}

/// The square around a leader's dot.
fn dot(at: DVec2) -> [DVec2; 4] {
    let half = DOT_PT + 0.5;
    [[-half, -half], [half, -half], [half, half], [-half, half]].map(|off| at + DVec2::from_array(off))
}

/// A name with a line from a dot on what it names.
pub(super) fn led([anchor, end]: [DVec2; 2], dot: f64, name: &str, text: Text) -> Group {
    let line = Path::line(&[anchor, end]);
    // In proportion to the dot, so that leaders side by side do not cover the edge behind them.
    let rim = Stroke::new(FRAME_PT + 1.4 * (dot / DOT_PT).powi(4), Ink::glass(Colour::WHITE, RIM_OPACITY));
    Group::new(GroupKind::Leader, name).with([
        PathItem::stroked(line.clone(), rim).into(),
        PathItem::stroked(line, Stroke::new(FRAME_PT, QUIET_INK)).into(),
        PathItem::filled(Path::circle(anchor, dot), INK)
            .outlined(Stroke::new(0.6 * dot / DOT_PT, Colour::WHITE))
            .into(),
        text.into(),
    ])
}
