//! Colours of horizons, which lines are shown, and the positions of the other sections.

use crate::state::{Layout, SectionKind, Session};
use eframe::egui::{Align2, Color32, FontId, Rect, Ui, Vec2, pos2, vec2};
use figure::cut::CutLine;
use figure::draw::section::Marks;
use files::SurfaceKind;
use glam::DVec2;
use model::section::LineKind;
use project::document::HorizonEntry;
use std::borrow::Cow;
use survey::SurveyGeometry;

/// The colour of a horizon: its own, or else the default of its place in the list.
pub(crate) fn horizon_colour(own: Option<ttf::Colour>, index: usize) -> Color32 {
    let [r, g, b] = figure::style::horizon_colour(own, index).rgb;
    Color32::from_rgb(r, g, b)
}

/// The colour that an entry is drawn in.
pub(crate) fn entry_colour(entry: &HorizonEntry, index: usize) -> Color32 {
    horizon_colour(entry.own_colour(), index)
}

/// The positions of the other two sections, and on the slice also the fence.
pub(super) fn marks(session: &Session, kind: SectionKind) -> Marks {
    let [s, t] = kind.axes().map(|axis| session.view.slices[axis]);
    let has_fence = kind == SectionKind::Slice && session.view.layout == Layout::Fence;
    let fence = session.view.fence.iter().filter(|_| has_fence).map(|at| DVec2::from_array(*at));
    Marks { down: vec![s], across: vec![t], fence: fence.collect() }
}

/// The lines of what is not hidden.
pub(super) fn visible<'a>(session: &Session, lines: &'a [CutLine]) -> Cow<'a, [CutLine]> {
    let (hidden, document) = (&session.view.hidden, &session.document);
    if hidden.is_empty() {
        return Cow::Borrowed(lines);
    }
    let is_hidden = |line: &&CutLine| match line.kind {
        LineKind::Horizon { horizon } => {
            document.horizons.get(horizon).is_some_and(|entry| hidden.has(SurfaceKind::Horizon, &entry.name))
        }
        LineKind::Fault { fault, .. } => {
            document.faults.get(fault).is_some_and(|entry| hidden.has(SurfaceKind::Fault, &entry.name))
        }
        _ => false,
    };
    Cow::Owned(lines.iter().filter(|line| !is_hidden(line)).cloned().collect())
}

/// The name of the axis across, before its first number.
pub(crate) fn name_across(ui: &Ui, whole: Rect, body: Rect, name: &str) {
    let at = pos2(body.left() - 15.0, body.top() - 4.0);
    let colour = ui.visuals().text_color().gamma_multiply(0.8);
    ui.painter_at(whole).text(at, Align2::RIGHT_BOTTOM, name, FontId::proportional(9.5), colour);
}

/// Shares of a view that a section takes at the chosen proportions; a slice has the proportions of the map.
pub(super) fn fitted(session: &Session, geometry: &SurveyGeometry, kind: SectionKind, view: Vec2) -> Vec2 {
    let Some(factor) = session.view.proportions else { return Vec2::splat(1.0) };
    let spacing = [geometry.inline_vector.length(), geometry.crossline_vector.length(), geometry.sample_m() * factor];
    let [s, t] = kind.axes();
    let size = kind.extent(geometry.size()) * DVec2::new(spacing[s], spacing[t]);
    let room = DVec2::new(f64::from(view.x), f64::from(view.y));
    let scale = (room / size.max(DVec2::splat(1e-9))).min_element();
    let share = size * scale / room;
    vec2(share.x as f32, share.y as f32)
}
