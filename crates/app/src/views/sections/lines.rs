//! Lines over a section: horizons, faults, the fence, the other two sections.

use super::axes::axes;
use crate::state::{Layout, Session, SliceKind};
use crate::theme;
use eframe::egui::{Color32, Painter, Pos2, Rect, Shape, Stroke, Ui};
use glam::DVec2;
use model::section::{LineKind, LineQuality};
use project::document::HorizonEntry;

/// Colours of horizons, youngest first, told apart by most eyes and on grey.
const HORIZON_COLOURS: [Color32; 8] = [
    Color32::from_rgb(0x00, 0x9e, 0x73),
    Color32::from_rgb(0xe6, 0x9f, 0x00),
    Color32::from_rgb(0x00, 0x72, 0xb2),
    Color32::from_rgb(0xcc, 0x79, 0xa7),
    Color32::from_rgb(0x56, 0xb4, 0xe9),
    Color32::from_rgb(0xd5, 0x5e, 0x00),
    Color32::from_rgb(0xb8, 0xa8, 0x00),
    Color32::from_rgb(0x66, 0x33, 0x99),
];

/// The colour of a horizon: its own, or else that of its place.
pub fn horizon_colour(own: Option<ttf::Colour>, index: usize) -> Color32 {
    match own {
        Some(colour) => Color32::from_rgb(colour.rgb[0], colour.rgb[1], colour.rgb[2]),
        None => HORIZON_COLOURS[index % HORIZON_COLOURS.len()],
    }
}

/// The colour that an entry is drawn in.
pub fn entry_colour(entry: &HorizonEntry, index: usize) -> Color32 {
    horizon_colour(entry.assembly.as_ref().map(|log| log.colour), index)
}

/// Solid where picked, dashed where filled, dotted where extrapolated; on a light halo, so that it is seen on any amplitude.
pub(in crate::views) fn draw_line(
    painter: &Painter,
    points: Vec<Pos2>,
    kind: LineKind,
    quality: LineQuality,
    session: &Session,
) {
    let own = |horizon: usize| session.document.horizons.get(horizon)?.assembly.as_ref().map(|log| log.colour);
    let (colour, width) = match kind {
        LineKind::Horizon { horizon } => (horizon_colour(own(horizon), horizon), 2.0),
        LineKind::Fault { .. } => (Color32::BLACK, 2.2),
        LineKind::Frame => return,
    };
    painter.add(Shape::line(points.clone(), Stroke::new(width + 2.0, Color32::from_white_alpha(150))));
    let stroke = Stroke::new(width, colour);
    match quality {
        LineQuality::Certain => drop(painter.add(Shape::line(points, stroke))),
        LineQuality::Approximate => drop(painter.add(Shape::dashed_line(&points, stroke, 8.0, 5.0))),
        LineQuality::Inferred => drop(painter.add(Shape::dashed_line(&points, stroke, 2.5, 4.0))),
    }
}

/// Where the fence runs, on the slice.
pub(super) fn fence_line(
    ui: &Ui,
    painter: &Painter,
    session: &Session,
    kind: SliceKind,
    to_screen: &impl Fn(DVec2) -> Pos2,
) {
    if kind != SliceKind::Slice || session.view.layout != Layout::Fence {
        return;
    }
    let points: Vec<Pos2> = session.view.fence.iter().map(|at| to_screen(DVec2::from_array(*at))).collect();
    let accent = theme::accent(ui.visuals());
    painter.add(Shape::line(points.clone(), Stroke::new(5.0, Color32::from_white_alpha(180))));
    painter.add(Shape::line(points.clone(), Stroke::new(2.5, accent)));
    for point in points {
        painter.circle(point, 4.0, Color32::WHITE, Stroke::new(2.0, accent));
    }
}

/// Where the other two sections run.
pub(super) fn cross(
    ui: &Ui,
    painter: &Painter,
    session: &Session,
    kind: SliceKind,
    body: Rect,
    to_screen: &impl Fn(DVec2) -> Pos2,
) {
    let [s, t] = axes(kind).map(|axis| session.view.slices[axis]);
    let at = to_screen(DVec2::new(s, t));
    let stroke = Stroke::new(1.0, theme::accent(ui.visuals()).gamma_multiply(0.8));
    painter.vline(at.x, body.y_range(), stroke);
    painter.hline(body.x_range(), at.y, stroke);
}
