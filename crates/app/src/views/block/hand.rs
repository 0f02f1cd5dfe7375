//! Handling the block with the pointer: turning, moving, zooming, cutting by its faces; and the dividing line of the
//! wipe.

use super::{REACH, dvec, screen};
use crate::state::faces::{self, Face, Handle};
use crate::state::{Action, Compare, Session, StandardView, camera};
use crate::widgets::event_order::wheel_lines;
use eframe::egui::{CursorIcon, Modifiers, PointerButton, Pos2, Rect, Response, Ui};
use glam::DVec2;
use render::Scene;

/// Change of the natural logarithm of the zoom for each point of wheel travel.
const WHEEL: f64 = 0.0022;

/// What the pointer drags.
enum Grab {
    Turn,
    Shift,
    Wipe,
    Face { handle: Handle, start: Box<Scene>, from: Pos2, size: DVec2 },
}

/// The state of dragging in the block view.
#[derive(Default)]
pub(super) struct Hand {
    grab: Option<Grab>,
    /// The part of a line of the wheel, over a handle, that has not moved its face yet.
    wheel: f32,
}

impl Hand {
    /// Whether something is dragged.
    pub(super) fn is_closed(&self) -> bool {
        self.grab.is_some()
    }

    /// The face that is dragged.
    pub(super) fn face(&self) -> Option<Face> {
        match &self.grab {
            Some(Grab::Face { handle, .. }) => Some(handle.face),
            _ => None,
        }
    }

    /// Turns, moves, zooms and cuts as the pointer does in one pane of the view.
    pub(super) fn touch(
        &mut self,
        ui: &Ui,
        response: &Response,
        session: &Session,
        [pane, whole]: [Rect; 2],
        handles: &[Handle],
        actions: &mut Vec<Action>,
    ) {
        let Some(geometry) = session.document.geometry.as_ref() else { return };
        let view = &session.view;
        let size = dvec(pane.size());
        let wipe_x = whole.left() + whole.width() * view.wipe;
        let modifiers = ui.input(|input| input.modifiers);
        if response.drag_started()
            && let Some(at) = ui.input(|input| input.pointer.press_origin())
        {
            let handle = handles.iter().find(|handle| (screen(pane, handle.at) - at).length() < REACH);
            self.grab = Some(match handle {
                _ if view.compare == Compare::Wipe && (at.x - wipe_x).abs() < REACH => Grab::Wipe,
                Some(handle) => Grab::Face { handle: *handle, start: Box::new(view.scene.clone()), from: at, size },
                None if modifiers.shift || !response.dragged_by(PointerButton::Primary) => Grab::Shift,
                None => Grab::Turn,
            });
        }
        let mut scene = view.scene.clone();
        let delta = dvec(response.drag_delta());
        if let (Some(grab), Some(at)) = (&self.grab, response.interact_pointer_pos()) {
            match grab {
                Grab::Turn => camera::orbit(&mut scene, geometry, size, delta),
                Grab::Shift => camera::pan(&mut scene, size, delta),
                Grab::Wipe => actions.push(Action::Wipe((at.x - whole.left()) / whole.width())),
                Grab::Face { handle, start, from, size } => {
                    scene = faces::pull(start, geometry, *size, handle, dvec(at - *from));
                }
            }
        }
        if response.drag_stopped() || !response.dragged() {
            self.grab = None;
        }
        if let Some(at) = response.hover_pos() {
            let (scroll, pinch) = ui.input(|input| (input.smooth_scroll_delta().y, input.zoom_delta()));
            let is_near = |handle: &&Handle| (screen(pane, handle.at) - at).length() < REACH;
            let factor = (f64::from(scroll) * WHEEL).exp() * f64::from(pinch);
            if let Some(handle) = handles.iter().find(is_near) {
                self.wheel += wheel_lines(ui);
                let steps = self.wheel.trunc();
                self.wheel -= steps;
                if steps != 0.0 {
                    scene = faces::move_face(&scene, geometry, size, handle.face, f64::from(steps));
                }
            } else if (factor - 1.0).abs() > 1e-6 {
                camera::zoom_at(&mut scene, size, dvec(at - pane.min), factor);
            }
            let on_wipe = view.compare == Compare::Wipe && (at.x - wipe_x).abs() < REACH;
            if on_wipe {
                ui.ctx().set_cursor_icon(CursorIcon::ResizeHorizontal);
            } else if handles.iter().any(|handle| is_near(&handle)) {
                ui.ctx().set_cursor_icon(CursorIcon::Grab);
            }
        }
        if response.double_clicked() && modifiers == Modifiers::NONE {
            actions.push(Action::Stand(StandardView::Block));
        }
        if scene != view.scene {
            actions.push(Action::Show(Box::new(scene)));
        }
    }
}
