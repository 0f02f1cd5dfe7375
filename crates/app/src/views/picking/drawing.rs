//! What goes with drawing lines of a horizon and tracking from a click: the line under way, and how far is tracked.

use crate::state::{Action, PickingStep, Session, Tool};
use crate::widgets::obstacle::{needs, unless};
use eframe::egui::{Button, DragValue, Ui};
use interp::refine::TrackSettings;

/// Shows what the tool in hand needs; nothing with other tools.
pub(super) fn show(ui: &mut Ui, session: &Session, actions: &mut Vec<Action>) {
    match session.view.picking.tool {
        Tool::Draw => line(ui, session, actions),
        Tool::Track => window(ui, session, actions),
        Tool::Pick | Tool::Lasso | Tool::Sticks | Tool::Time | Tool::Faults => {}
    }
}

fn line(ui: &mut Ui, session: &Session, actions: &mut Vec<Action>) {
    let picking = &session.view.picking;
    let mut snap = picking.snap;
    let hint =
        "Lay the line on the nearest peak or trough, whichever the samples along it are; otherwise it stays as drawn";
    if ui.checkbox(&mut snap, "On the reflection").on_hover_text(hint).changed() {
        actions.push(Action::Picking(PickingStep::Snap(snap)));
    }
    let count = picking.line.len();
    ui.label(format!("{count} point{} on the line", if count == 1 { "" } else { "s" }));
    ui.horizontal(|ui| {
        let two = needs(count > 1, "Click at least two points along the reflection");
        if unless(ui, two, Button::new("Add line")).on_hover_text("Enter").clicked() {
            actions.push(Action::Picking(PickingStep::Accept));
        }
        let some = needs(count > 0, "No point is drawn");
        if unless(ui, some, Button::new("Take back last point")).on_hover_text("Backspace").clicked() {
            actions.push(Action::Picking(PickingStep::Backspace));
        }
    });
}

fn window(ui: &mut Ui, session: &Session, actions: &mut Vec<Action>) {
    let mut next = session.view.picking.window;
    ui.horizontal(|ui| {
        let most = TrackSettings::MOST;
        for (name, hint, value, most) in [
            ("Traces", "So many traces to each side of the click", &mut next.traces, most.traces),
            ("Samples", "So many samples above and below the click", &mut next.samples, most.samples),
        ] {
            let label = ui.label(name);
            ui.add(DragValue::new(value).range(1..=most)).labelled_by(label.id).on_hover_text(hint);
        }
    });
    if next != session.view.picking.window {
        actions.push(Action::Picking(PickingStep::Window(next)));
    }
}
