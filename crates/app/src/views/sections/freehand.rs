//! A line of a horizon drawn by dragging: the way of the hand, with no more points than its bends need.

use crate::state::{Panel, Session, Tool};
use crate::widgets::event_order::moves;
use crate::widgets::theme;
use eframe::egui::{Painter, PointerButton, Pos2, Response, Shape, Stroke, Ui};

/// Distance of the hand from a line that is drawn through fewer points, points.
const OFF: f32 = 0.8;

/// The line under the hand, points of the window.
#[derive(Default)]
pub(super) struct Freehand {
    places: Vec<Pos2>,
}

impl Freehand {
    /// Whether a drag draws.
    pub(super) fn is_in_hand(session: &Session) -> bool {
        session.view.panel == Panel::Interpret && session.view.picking.tool == Tool::Draw
    }

    /// Extends the line while it is dragged; returns its bends when the drag ends.
    pub(super) fn draw(&mut self, ui: &Ui, painter: &Painter, response: &Response) -> Option<Vec<Pos2>> {
        let is_drawn = response.dragged_by(PointerButton::Primary) || response.drag_stopped_by(PointerButton::Primary);
        if is_drawn {
            let begun = ui.input(|input| input.pointer.press_origin()).filter(|_| response.drag_started());
            self.places.extend(begun.into_iter().chain(moves(ui)));
        }
        let accent = theme::accent(&response.ctx.global_style().visuals);
        painter.add(Shape::line(self.places.clone(), Stroke::new(2.0, accent)));
        if response.dragged() && !response.drag_stopped() {
            return None;
        }
        let places = std::mem::take(&mut self.places);
        (response.drag_stopped() && places.len() > 1).then(|| bends(&places))
    }
}

/// The places between which the hand went straight (Douglas and Peucker's way).
fn bends(places: &[Pos2]) -> Vec<Pos2> {
    let (Some(first), Some(last)) = (places.first(), places.last()) else { return Vec::new() };
    let along = *last - *first;
    let off = |place: &Pos2| {
        let to = *place - *first;
        if along.length() > 0.0 { (to.x * along.y - to.y * along.x).abs() / along.length() } else { to.length() }
    };
    let farthest = (1..places.len() - 1).max_by(|&a, &b| off(&places[a]).total_cmp(&off(&places[b])));
    match farthest.filter(|&n| off(&places[n]) > OFF) {
        Some(n) => {
            let mut kept = bends(&places[..=n]);
            kept.extend(bends(&places[n..]).into_iter().skip(1));
            kept
        }
        None => vec![*first, *last],
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use eframe::egui::pos2;

    #[test]
    fn a_line_keeps_its_bends_alone() {
        let straight: Vec<Pos2> = (0..100).map(|n| pos2(n as f32, 0.5 * n as f32)).collect();
        assert_eq!(bends(&straight), [straight[0], straight[99]]);
        let angle: Vec<Pos2> = (0..100).map(|n| pos2(n as f32, (n as f32 - 40.0).abs())).collect();
        assert_eq!(bends(&angle), [angle[0], angle[40], angle[99]]);
        assert_eq!(bends(&angle[..1]).len(), 2);
    }
}
