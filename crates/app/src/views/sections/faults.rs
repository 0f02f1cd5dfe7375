//! Faults under the pointer on a section: what they are, and what a click does with them.

use crate::state::{Action, ChosenFault, FaultStep, PickingStep, SectionKind, Session};
use crate::views::overlay::Overlay;
use crate::views::picking::in_words;
use eframe::egui::{Response, Ui};
use glam::{DVec2, DVec3};
use project::command::CutAlong;

/// Marks the fault under the pointer and says what it is; a click chooses it, with Shift beside others, and with Alt cuts it
/// there.
pub(super) fn touch(
    ui: &Ui,
    response: &Response,
    session: &Session,
    overlay: &Overlay,
    (kind, voxel): (SectionKind, DVec3),
    page: impl Fn(DVec2) -> DVec2,
    actions: &mut Vec<Action>,
) {
    if response.secondary_clicked() {
        actions.push(Action::Slices(voxel.to_array()));
    }
    let Some((fault, proposal)) = response.hover_pos().and_then(|at| overlay.fault_at(kind, at, &page)) else {
        return;
    };
    overlay.mark(&ui.painter_at(response.rect), kind, &fault, &page);
    let unit = overlay.interpreted().map_or("", |shown| shown.unit.as_str());
    let text = match (&fault, proposal) {
        (_, Some(proposal)) => {
            in_words(proposal, unit) + "\nClick, then Enter accepts it, Delete dismisses it; Alt and a click cuts it"
        }
        (ChosenFault::Present(name) | ChosenFault::Proposed(_, name), None) => {
            format!("{name}\nClick, then Delete removes it; Alt and a click cuts it")
        }
    };
    response.clone().on_hover_text_at_pointer(text);
    if response.clicked() {
        let modifiers = ui.input(|input| input.modifiers);
        let along = if modifiers.shift { CutAlong::Strike } else { CutAlong::Dip };
        let is_known = session.view.picking.faults.contains(&fault);
        actions.push(Action::Picking(if modifiers.alt {
            PickingStep::Fault(FaultStep::Cut(fault, voxel, along))
        } else {
            PickingStep::Fault(FaultStep::Choose(
                fault,
                modifiers.shift && !(is_known && session.view.picking.faults.len() == 1),
            ))
        }));
    }
}
