//! Points of fault sticks, dragged in front of the block: each stays on the plane of its stick, as if it were dragged on
//! that section.

use super::{dvec, screen};
use crate::state::picking::voxel_of;
use crate::state::{Action, Panel, PickingStep, Session, StickPoint, Tool, camera};
use eframe::egui::{Color32, Pos2, Rect, Response, Stroke, Ui};
use glam::{DVec2, DVec3};
use render::View;

/// Distance within which the pointer catches a point, points.
const CATCH: f64 = 9.0;
/// Smallest share of a line of sight that leads through the plane of a stick; beside it a point would run away.
const LEAST_ACROSS: f64 = 0.08;

/// A point that is held, and the plane on which it moves: an axis and its voxel.
pub(super) struct Held {
    point: StickPoint,
    plane: (usize, f64),
}

/// All sticks, each with its fault and its number.
fn all(session: &Session) -> impl Iterator<Item = (Option<&str>, usize, &Vec<[f64; 3]>)> {
    let picking = &session.view.picking;
    let own = picking.sticks.iter().chain(std::iter::once(&picking.stick)).enumerate();
    let made = session.document.sticks.iter().flat_map(|fault| {
        fault.sticks.iter().enumerate().map(move |(index, stick)| (Some(fault.fault.as_str()), index, stick))
    });
    own.map(|(index, stick)| (None, index, stick)).chain(made)
}

/// The point within reach of a place of the pane, with the plane of its stick.
fn caught(session: &Session, view: &View, at: DVec2) -> Option<Held> {
    let geometry = session.document.geometry.as_ref()?;
    let ray = view.ray(at);
    let points = all(session).flat_map(|(fault, stick, places)| {
        let voxels: Vec<DVec3> = places.iter().map(|place| voxel_of(geometry, *place)).collect();
        let axis = plane_of(&voxels, ray.direction);
        voxels.into_iter().enumerate().map(move |(point, voxel)| {
            let held = StickPoint { fault: fault.map(str::to_owned), stick, point };
            (voxel, Held { point: held, plane: (axis, voxel[axis]) })
        })
    });
    let off = |voxel: &DVec3| view.project(*voxel).distance(at);
    let near = points.filter(|(voxel, _)| off(voxel) <= CATCH);
    near.min_by(|a, b| off(&a.0).total_cmp(&off(&b.0))).map(|(_, held)| held)
}

/// The axis across which a stick was drawn: along it its points differ least. A single point moves on the vertical
/// section that is seen best.
fn plane_of(voxels: &[DVec3], direction: DVec3) -> usize {
    if voxels.len() < 2 {
        return if direction.x.abs() >= direction.y.abs() { 0 } else { 1 };
    }
    let low = voxels.iter().copied().fold(DVec3::INFINITY, DVec3::min);
    let high = voxels.iter().copied().fold(DVec3::NEG_INFINITY, DVec3::max);
    let spread = (high - low).to_array();
    (0..3).min_by(|&a, &b| spread[a].total_cmp(&spread[b])).unwrap_or(0)
}

/// Where the line of sight meets a plane; `None` where it runs along it.
fn on_plane(view: &View, at: DVec2, (axis, value): (usize, f64)) -> Option<DVec3> {
    let ray = view.ray(at);
    let across = ray.direction[axis];
    let share = across.abs() / ray.direction.length().max(f64::MIN_POSITIVE);
    (share >= LEAST_ACROSS).then(|| ray.origin + ray.direction * ((value - ray.origin[axis]) / across))
}

/// Drags a point while sticks are drawn: one of a fault that exists is moved when it is let go. Returns whether a point is
/// held, so that nothing else is dragged.
pub(super) fn drag(
    held: &mut Option<Held>,
    ui: &Ui,
    session: &Session,
    response: &Response,
    pane: Rect,
    actions: &mut Vec<Action>,
) -> bool {
    let is_drawing = session.view.panel == Panel::Interpret && session.view.picking.tool == Tool::Sticks;
    let Some(geometry) = session.document.geometry.as_ref().filter(|_| is_drawing) else {
        *held = None;
        return false;
    };
    let view = camera::view(&session.view.scene, geometry, dvec(pane.size()));
    let place = |at: Pos2| dvec(at - pane.min);
    if response.drag_started()
        && let Some(at) = ui.input(|input| input.pointer.press_origin())
    {
        *held = caught(session, &view, place(at));
    }
    let Some(Held { point, plane }) = held.as_ref() else { return false };
    let last = DVec3::from_array(geometry.size().map(|count| count.saturating_sub(1) as f64));
    let to = response.interact_pointer_pos().and_then(|at| on_plane(&view, place(at), *plane));
    if let Some(to) = to.map(|to| to.clamp(DVec3::ZERO, last)) {
        if point.fault.is_none() || response.drag_stopped() {
            actions.push(Action::Picking(PickingStep::MovePoint(point.clone(), to)));
        } else {
            let at = screen(pane, view.project(to));
            ui.painter_at(pane).circle(at, 4.0, Color32::WHITE, Stroke::new(1.5, Color32::BLACK));
        }
    }
    if response.drag_stopped() || !response.dragged() {
        *held = None;
    }
    true
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_stick_moves_on_the_section_on_which_it_was_drawn() {
        let stick = [DVec3::new(6.0, 3.0, 2.0), DVec3::new(6.0, 5.0, 20.0)];
        assert_eq!(plane_of(&stick, DVec3::new(0.1, 1.0, 0.2)), 0);
        let on_slice = [DVec3::new(2.0, 3.0, 8.0), DVec3::new(9.0, 5.0, 8.0)];
        assert_eq!(plane_of(&on_slice, DVec3::new(0.1, 1.0, 0.2)), 2);
        assert_eq!(plane_of(&stick[..1], DVec3::new(0.1, 1.0, 0.2)), 1);
    }
}
