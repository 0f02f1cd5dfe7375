//! The dialogue that writes a horizon or fault for other programs.

use super::notices;
use crate::state::{Action, Dialogue, Place, State, SurfaceForm};
use eframe::egui::{Button, ComboBox, Context, Grid, TextEdit};
use formats::{Format, SurfaceKind};
use widgets::dialogue;
use widgets::keyboard::is_entered;
use widgets::obstacle::{needs, unless};

/// Shows the dialogue.
pub fn dialogue(ctx: &Context, state: &State, form: &SurfaceForm, actions: &mut Vec<Action>) {
    let modal = dialogue::show(ctx, "surface", |ui| {
        ui.set_width(440.0);
        ui.heading(format!("Export {} {}", form.kind, form.name));
        notices::show(ui, state, Place::Dialogue, actions);
        let mut next = form.clone();
        Grid::new("surface").num_columns(2).spacing([14.0, 10.0]).show(ui, |ui| {
            let label = ui.label("File");
            ui.add(TextEdit::singleline(&mut next.path).desired_width(320.0)).labelled_by(label.id);
            ui.end_row();
            let label = ui.label("Format");
            ui.label_inputs_by(label.id, |ui| {
                ComboBox::from_id_salt("format").selected_text(form.format.name()).show_ui(ui, |ui| {
                    for format in Format::all().filter(|format| format.writes(form.kind)) {
                        if ui.selectable_label(format == form.format, format.name()).clicked() {
                            next.choose(format);
                        }
                    }
                });
            });
            ui.end_row();
        });
        ui.weak(match (form.kind, form.format) {
            (SurfaceKind::Horizon, Format::Csv) => "The column quality says which nodes were filled or extrapolated.",
            (SurfaceKind::Horizon, _) => "Only csv says which nodes were filled or extrapolated.",
            (SurfaceKind::Fault, Format::OpendTect) => "Sticks that are cut from the fault's surface.",
            (SurfaceKind::Fault, _) => "The fault's triangles.",
        });
        ui.horizontal(|ui| {
            let can = !next.path.trim().is_empty();
            let button = unless(ui, needs(can, "Name the file"), Button::new("Export")).on_hover_text("Enter");
            if button.clicked() || can && is_entered(ui) {
                actions.push(Action::ExportSurface(Box::new(next.clone())));
            }
            if ui.button("Cancel").clicked() {
                actions.push(Action::Answered);
            }
        });
        if next != *form {
            actions.push(Action::Ask(Box::new(Dialogue::Surface(next))));
        }
    });
    if modal.should_close() {
        actions.push(Action::Answered);
    }
}
