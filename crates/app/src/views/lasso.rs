//! What the pointer does on sections and on the block: a click picks, a lasso erases.

use crate::state::{Action, How, Panel, PickingStep, Session, Tool};
use crate::widgets::event_order::moves;
use crate::widgets::theme;
use eframe::egui::{Color32, Key, Painter, Pos2, Response, Shape, Stroke, Ui};
use glam::DVec3;

/// Smallest distance between two corners, points.
const EVERY: f32 = 3.0;
/// Smallest number of corners of a lasso.
const FEWEST: usize = 4;

/// A line being drawn, points of the window.
#[derive(Default)]
pub(crate) struct LassoLine {
    corners: Vec<Pos2>,
}

impl LassoLine {
    /// Extends the line while it is dragged; returns it when the drag ends.
    pub(crate) fn draw(&mut self, ui: &Ui, painter: &Painter, response: &Response, is_held: bool) -> Option<Vec<Pos2>> {
        if is_held && (response.dragged() || response.drag_stopped()) {
            let begun = ui.input(|input| input.pointer.press_origin()).filter(|_| response.drag_started());
            for at in begun.into_iter().chain(moves(ui)) {
                if self.corners.last().is_none_or(|last| last.distance(at) > EVERY) {
                    self.corners.push(at);
                }
            }
        }
        if !self.corners.is_empty() {
            let accent = theme::accent(&response.ctx.global_style().visuals);
            let mut line = self.corners.clone();
            line.push(line[0]);
            painter.add(Shape::line(line.clone(), Stroke::new(3.5, Color32::from_white_alpha(200))));
            painter.add(Shape::dashed_line(&line, Stroke::new(2.0, accent), 6.0, 4.0));
        }
        if response.dragged() && is_held {
            return None;
        }
        let corners = std::mem::take(&mut self.corners);
        (corners.len() >= FEWEST && response.drag_stopped()).then_some(corners)
    }
}

/// The key that makes a drag draw a lasso.
pub(crate) const HELD: Key = Key::A;

/// Whether a drag draws a lasso: the lasso is the chosen tool, or its key is held.
pub(crate) fn is_held(ui: &Ui, session: &Session) -> bool {
    session.view.panel == Panel::Interpret
        && (session.view.picking.tool == Tool::Lasso
            || ui.input(|input| input.key_down(HELD)) && !ui.ctx().egui_wants_keyboard_input())
}

/// How a click picks, and where in the window; `None` where it does not pick.
pub(crate) fn pick_at(ui: &Ui, response: &Response, session: &Session) -> Option<(How, Pos2)> {
    let picks = response.clicked() && !matches!(session.view.picking.tool, Tool::Sticks | Tool::Draw | Tool::Faults);
    picks.then(|| response.interact_pointer_pos().map(|at| (how(ui), at))).flatten()
}

fn how(ui: &Ui) -> How {
    let modifiers = ui.input(|input| input.modifiers);
    match (modifiers.shift, modifiers.alt) {
        (_, true) => How::Remove,
        (true, _) => How::Extend,
        _ => How::Replace,
    }
}

/// What a click at a voxel position does.
pub(crate) fn click(ui: &Ui, response: &Response, session: &Session, voxel: DVec3, actions: &mut Vec<Action>) {
    let move_there = Action::Slices(voxel.to_array());
    if session.view.panel != Panel::Interpret {
        if response.clicked() {
            actions.push(move_there);
        }
        return;
    }
    if response.secondary_clicked() {
        actions.push(move_there);
    }
    if response.clicked() {
        let how = how(ui);
        actions.push(Action::Picking(match session.view.picking.tool {
            // Faults are chosen where their lines are.
            Tool::Faults => return,
            Tool::Sticks => PickingStep::Stick(voxel),
            Tool::Draw => PickingStep::Line(vec![voxel]),
            Tool::Pick | Tool::Lasso | Tool::Time | Tool::Track => PickingStep::At(voxel, how),
        }));
    }
}
