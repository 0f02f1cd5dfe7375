//! Wells on sections: the path where it lies near the section, its tops, and a log beside it.

use crate::state::{SectionKind, Session};
use eframe::egui::{Align2, Color32, FontId, Painter, Pos2, Rect, Stroke, vec2};
use figure::draw::section_wells::{self, runs};
use glam::{DVec2, DVec3};
use project::pictures::load::{LoadedLog, LoadedWell};

/// Width of a log beside its path, points.
const LOG: f32 = 34.0;
/// Half the length of the mark of a top, points.
const TOP: f32 = 6.0;
/// Of paths and their names.
const INK: Color32 = Color32::from_rgb(0x26, 0x26, 0x2a);
/// Of logs.
const LOG_INK: Color32 = Color32::from_rgb(0x0b, 0x6e, 0x4f);
/// Of tops, as in the block.
const TOP_INK: Color32 = Color32::from_rgb(0xc8, 0x2a, 0x1e);
/// Behind words and curves, so that they are read over amplitudes.
const RIM: Color32 = Color32::from_rgba_premultiplied(0xc8, 0xc8, 0xc8, 0xc8);

/// Draws the wells that lie near a section; a slice shows where they pass through it. `page` leads from (s, t) to the
/// window.
pub(super) fn draw(
    painter: &Painter,
    session: &Session,
    (kind, body): (SectionKind, Rect),
    wells: &[LoadedWell],
    page: impl Fn(DVec2) -> Pos2,
) {
    let at = session.view.slices[kind.axis()];
    let near = |voxel: DVec3| section_wells::near(voxel, kind, at).map(&page);
    for well in wells.iter().filter(|well| !session.view.scene.hides_well(&well.name)) {
        let parts = runs(well.path.iter().map(|voxel| near(*voxel)));
        let Some(head) = parts.iter().flatten().copied().next() else { continue };
        let ink = well.colour.map_or(INK, |own| Color32::from_rgb(own.rgb[0], own.rgb[1], own.rgb[2]));
        if kind == SectionKind::Slice {
            painter.circle(head, 3.5, Color32::WHITE, Stroke::new(1.5, ink));
        } else {
            for part in parts.into_iter().filter(|part| part.len() > 1) {
                painter.line(part.clone(), Stroke::new(4.0, RIM));
                painter.line(part, Stroke::new(2.0, ink));
            }
            for (top, name) in well.tops.iter().zip(&well.top_names) {
                let Some(at) = near(*top) else { continue };
                painter.hline(at.x - TOP..=at.x + TOP, at.y, Stroke::new(2.0, TOP_INK));
                words(painter, at - vec2(TOP + 3.0, 0.0), Align2::RIGHT_CENTER, name, TOP_INK);
            }
            if let Some(log) = &well.log {
                curve(painter, log, near);
            }
        }
        let above = head.clamp(body.min + vec2(0.0, 20.0), body.max);
        words(painter, above - vec2(0.0, 5.0), Align2::CENTER_BOTTOM, &well.name, INK);
    }
}

/// A log to the right of its path, from its smallest to its largest value.
fn curve(painter: &Painter, log: &LoadedLog, near: impl Fn(DVec3) -> Option<Pos2>) {
    let [low, high] = log.range;
    let place = |(voxel, value): &(DVec3, f32)| {
        let share = (value - low) / (high - low).max(f32::MIN_POSITIVE);
        near(*voxel).filter(|_| value.is_finite()).map(|at| at + vec2(5.0 + share * LOG, 0.0))
    };
    let parts = runs(log.points.iter().map(place));
    let Some(first) = parts.iter().flatten().copied().next() else { return };
    for part in parts.into_iter().filter(|part| part.len() > 1) {
        painter.line(part.clone(), Stroke::new(2.5, RIM));
        painter.line(part, Stroke::new(1.0, LOG_INK));
    }
    words(painter, first + vec2(3.0, 4.0), Align2::LEFT_TOP, &log.name, LOG_INK);
}

fn words(painter: &Painter, at: Pos2, align: Align2, words: &str, ink: Color32) {
    let galley = painter.layout_no_wrap(words.to_owned(), FontId::proportional(11.0), ink);
    let rect = align.anchor_size(at, galley.size());
    painter.rect_filled(rect.expand(1.0), 2.0, RIM);
    painter.galley(rect.min, galley, ink);
}
