//! The dialogue that writes a volume, a horizon or a fault for other programs.

use super::notices;
use crate::state::{Action, DataForm, Dialogue, Place, State, Written};
use crate::widgets::dialogue;
use crate::widgets::form;
use crate::widgets::keyboard::is_entered;
use crate::widgets::obstacle::{needs, unless};
use eframe::egui::{Button, ComboBox, Context, Grid, TextEdit};
use files::segy::WriteFormat;
use files::{Format, SurfaceKind};

/// Shows the dialogue.
pub(crate) fn dialogue(ctx: &Context, state: &State, form: &DataForm, actions: &mut Vec<Action>) {
    let modal = dialogue::show(ctx, "data file", |ui| {
        ui.set_width(440.0);
        ui.heading(format!("Export {} {}", form.what.noun(), form.name));
        notices::show(ui, state, Place::Dialogue, actions);
        let mut next = form.clone();
        Grid::new("data file").num_columns(2).spacing([14.0, 10.0]).show(ui, |ui| {
            form::row(ui, "File", |ui| ui.add(TextEdit::singleline(&mut next.path).desired_width(320.0)));
            let label = ui.label("Format");
            ui.label_inputs_by(label.id, |ui| {
                ComboBox::from_id_salt("format").selected_text(format_name(form.what)).show_ui(ui, |ui| {
                    for what in formats_of(form.what) {
                        if ui.selectable_label(what == form.what, format_name(what)).clicked() {
                            next.choose(what);
                        }
                    }
                });
            });
            ui.end_row();
        });
        ui.weak(match form.what {
            Written::Surface(SurfaceKind::Horizon, format) if format.tells_quality() => {
                "The column quality says which nodes were filled or extrapolated."
            }
            Written::Surface(SurfaceKind::Horizon, _) => "Only csv says which nodes were filled or extrapolated.",
            Written::Surface(SurfaceKind::Fault, Format::OpendTect) => "Sticks that are cut from the fault's surface.",
            Written::Surface(SurfaceKind::Fault, _) => "The fault's triangles.",
            Written::Volume(_) => "SEG-Y; traces that were not recorded are left out.",
        });
        ui.horizontal(|ui| {
            let can = !next.path.trim().is_empty();
            let button = unless(ui, needs(can, "Name the file"), Button::new("Export")).on_hover_text("Enter");
            if button.clicked() || can && is_entered(ui) {
                actions.push(Action::ExportData(Box::new(next.clone())));
            }
            if ui.button("Cancel").clicked() {
                actions.push(Action::Answered);
            }
        });
        if next != *form {
            actions.push(Action::Ask(Box::new(Dialogue::Data(next))));
        }
    });
    if modal.should_close() {
        actions.push(Action::Answered);
    }
}

/// The formats in which the same can be written.
fn formats_of(what: Written) -> Vec<Written> {
    match what {
        Written::Surface(kind, _) => {
            Format::all().filter(|format| format.writes(kind)).map(|format| Written::Surface(kind, format)).collect()
        }
        Written::Volume(_) => {
            use WriteFormat::{Ibm32, Ieee32, Int8, Int16, Int32, Uint8, Uint16};
            let all = [Ieee32, Ibm32, Int32, Int16, Int8, Uint16, Uint8].map(Some);
            std::iter::once(None).chain(all).map(Written::Volume).collect()
        }
    }
}

/// What a format is called.
fn format_name(what: Written) -> &'static str {
    match what {
        Written::Surface(_, format) => format.name(),
        Written::Volume(None) => "samples as stored",
        Written::Volume(Some(format)) => format.sample_format().name(),
    }
}
