//! The volumes, horizons, faults and wells of the project.

use super::notices;
use super::sections::entry_colour;
use crate::state::{Action, Choice, Dialogue, Place, Session, State};
use eframe::egui::{
    Align, Button, DragValue, Id, Layout, Response, ScrollArea, Sense, Ui, UiBuilder, WidgetInfo, vec2,
};
use project::command::{
    Command, RemoveFault, RemoveHorizon, RemoveVolume, RemoveWell, RenameHorizon, SetFaultExtent, SetRaw, SetVelocity,
};
use project::document::FaultEntry;
use project::styles;
use survey::VerticalUnit;
use ttf::ColourMap;
use widgets::keyboard::{Renamed, Renaming};

/// The panel, with the text being typed in it.
#[derive(Default)]
pub struct Data {
    renaming: Option<Renaming>,
    velocity: Option<f64>,
    /// The fault whose extent is being changed, and the metres so far.
    extent: Option<(String, f64)>,
}

impl Data {
    /// Shows the panel.
    pub fn show(&mut self, ui: &mut Ui, state: &State, session: &Session, actions: &mut Vec<Action>) {
        notices::show(ui, state, Place::Data, actions);
        ScrollArea::vertical().show(ui, |ui| {
            ui.heading("Volumes");
            volumes(ui, session, actions);
            ui.add_space(10.0);
            ui.heading("Horizons");
            self.horizons(ui, session, actions);
            ui.add_space(10.0);
            ui.heading("Faults");
            self.faults(ui, session, actions);
            ui.add_space(10.0);
            wells(ui, session, actions);
            self.survey(ui, session, actions);
        });
    }

    fn horizons(&mut self, ui: &mut Ui, session: &Session, actions: &mut Vec<Action>) {
        for (index, entry) in session.document.horizons.iter().enumerate() {
            ui.horizontal(|ui| {
                let (rect, _) = ui.allocate_exact_size(vec2(12.0, 12.0), Sense::hover());
                ui.painter().circle_filled(rect.center(), 5.0, entry_colour(entry, index));
                if let Some(renaming) = self.renaming.as_mut().filter(|renaming| renaming.is_of(&entry.name)) {
                    let renamed = renaming.show(ui, 150.0);
                    if let Renamed::To(to) = &renamed {
                        let command = RenameHorizon { from: entry.name.clone(), to: to.clone() };
                        actions.push(Action::Apply(Box::new(Command::RenameHorizon(command))));
                    }
                    if renamed != Renamed::Typing {
                        self.renaming = None;
                    }
                    return;
                }
                let is_chosen = session.view.horizon.as_deref() == Some(&entry.name);
                let label = ui.selectable_label(is_chosen, &entry.name);
                if label.on_hover_text(&entry.source.reading).clicked() {
                    actions.push(Action::Horizon((!is_chosen).then(|| entry.name.clone())));
                }
                if is_chosen
                    && ui.small_button("Rename").on_hover_text(format!("Rename horizon {}", entry.name)).clicked()
                {
                    self.renaming = Some(Renaming::of(&entry.name));
                }
                if remove(ui, &format!("Remove horizon {}", entry.name)) {
                    let command = RemoveHorizon { name: entry.name.clone() };
                    actions.push(Action::Apply(Box::new(Command::RemoveHorizon(command))));
                }
            });
        }
        add(ui, "Add a horizon…", Choice::Horizon, session.document.geometry.is_some(), actions);
    }

    fn faults(&mut self, ui: &mut Ui, session: &Session, actions: &mut Vec<Action>) {
        for entry in &session.document.faults {
            ui.horizontal(|ui| {
                ui.label(&entry.name).on_hover_text(&entry.source.reading);
                if let Some(other) = &entry.truncated_by {
                    ui.weak(format!("ends at {other}"));
                }
                if remove(ui, &format!("Remove fault {}", entry.name)) {
                    let command = RemoveFault { name: entry.name.clone() };
                    actions.push(Action::Apply(Box::new(Command::RemoveFault(command))));
                }
            });
            // The identity is fixed, as that of the velocity.
            let row = UiBuilder::new().scope_id(Id::unique(("extent", &entry.name)));
            ui.scope_builder(row, |ui| ui.horizontal(|ui| self.extent(ui, entry, actions)));
        }
        add(ui, "Add a fault…", Choice::Fault, session.document.geometry.is_some(), actions);
    }

    /// By how much a fault reaches beyond what was drawn.
    fn extent(&mut self, ui: &mut Ui, entry: &FaultEntry, actions: &mut Vec<Action>) {
        ui.add_space(12.0);
        ui.weak("reaches farther by");
        let held = self.extent.take_if(|(name, _)| *name == entry.name);
        let mut metres = held.map(|(_, metres)| metres);
        let (response, settled) = settled(ui, &mut metres, entry.grown_m, |metres| {
            DragValue::new(metres).speed(5.0).range(0.0..=100_000.0).suffix(" m").max_decimals(1)
        });
        let label = Some(format!("Extent of fault {}", entry.name));
        let now = metres.unwrap_or(entry.grown_m);
        response.widget_info(|| WidgetInfo { label: label.clone(), ..WidgetInfo::drag_value(true, now) });
        response.on_hover_text("A fault ends where it was drawn, unless it was drawn too short");
        if let Some(metres) = metres {
            self.extent = Some((entry.name.clone(), metres));
        }
        if let Some(grown_m) = settled {
            let command = SetFaultExtent { fault: entry.name.clone(), grown_m };
            actions.push(Action::Apply(Box::new(Command::SetFaultExtent(command))));
        }
    }

    fn survey(&mut self, ui: &mut Ui, session: &Session, actions: &mut Vec<Action>) {
        let Some(geometry) = &session.document.geometry else { return };
        ui.heading("Survey");
        let [inlines, crosslines, samples] = geometry.size();
        ui.label(format!("{inlines} inlines, {crosslines} crosslines, {samples} samples"));
        let [x, y] = [geometry.inline_vector, geometry.crossline_vector].map(|vector| vector.length());
        ui.label(format!(
            "bins of {x:.2} × {y:.2} m, {} {} apart",
            geometry.vertical.interval,
            geometry.vertical.unit.symbol()
        ));
        if geometry.vertical.unit == VerticalUnit::Milliseconds {
            // The identity is fixed, so that a row that comes or goes above takes no focus from a value half typed.
            let row = UiBuilder::new().scope_id(Id::unique("velocity of the survey"));
            ui.scope_builder(row, |ui| {
                ui.horizontal(|ui| {
                    let label = ui.label("Velocity").on_hover_text("Turns two-way time into metres");
                    let (response, settled) = settled(ui, &mut self.velocity, geometry.velocity_m_s, |velocity| {
                        DragValue::new(velocity).speed(10.0).range(300.0..=9000.0).suffix(" m/s").max_decimals(0)
                    });
                    response.labelled_by(label.id);
                    if let Some(velocity_m_s) = settled {
                        actions.push(Action::Apply(Box::new(Command::SetVelocity(SetVelocity { velocity_m_s }))));
                    }
                })
            });
        }
    }
}

/// A number that is changed by dragging or typing, and held meanwhile; returned once when that is done and it is another
/// than `now`.
fn settled(
    ui: &mut Ui,
    held: &mut Option<f64>,
    now: f64,
    drag: impl FnOnce(&mut f64) -> DragValue<'_>,
) -> (Response, Option<f64>) {
    let mut value = held.unwrap_or(now);
    let response = ui.add(drag(&mut value));
    if response.changed() {
        *held = Some(value);
    }
    let is_done = !response.dragged() && !response.has_focus();
    let settled = if is_done { held.take() } else { None };
    (response, settled.filter(|value| *value != now))
}

/// A button at the right end of a row; returns whether it was clicked.
pub(super) fn remove(ui: &mut Ui, hint: &str) -> bool {
    ui.with_layout(Layout::right_to_left(Align::Center), |ui| ui.small_button("Remove").on_hover_text(hint).clicked())
        .inner
}

fn add(ui: &mut Ui, name: &str, choice: Choice, can: bool, actions: &mut Vec<Action>) {
    if ui.add_enabled(can, Button::new(name)).clicked() {
        actions.push(Action::Ask(Box::new(Dialogue::Choose(choice))));
    }
}

fn volumes(ui: &mut Ui, session: &Session, actions: &mut Vec<Action>) {
    let document = &session.document;
    let raw = styles::transfer_functions(document).raw;
    for entry in &document.volumes {
        ui.horizontal(|ui| {
            let is_raw = raw.as_ref().is_some_and(|raw| raw.volume == entry.name);
            let radio = ui.radio(is_raw, &entry.name);
            if radio
                .on_hover_text(format!("Show as raw data; {} polarity; {}", entry.polarity, entry.source.reading))
                .clicked()
                && let Ok(raw) = styles::raw_colour(document, Some(&entry.name), ColourMap::Seismics, None)
            {
                actions.push(Action::Apply(Box::new(Command::SetRaw(SetRaw { raw }))));
            }
            if remove(ui, &format!("Remove volume {}", entry.name)) {
                let command = RemoveVolume { name: entry.name.clone() };
                actions.push(Action::Apply(Box::new(Command::RemoveVolume(command))));
            }
        });
    }
    add(ui, "Add a volume…", Choice::MoreSurvey, true, actions);
}

fn wells(ui: &mut Ui, session: &Session, actions: &mut Vec<Action>) {
    ui.heading("Wells");
    for entry in &session.document.wells {
        ui.horizontal(|ui| {
            ui.label(&entry.name).on_hover_text(&entry.source.reading);
            if remove(ui, &format!("Remove well {}", entry.name)) {
                let command = RemoveWell { name: entry.name.clone() };
                actions.push(Action::Apply(Box::new(Command::RemoveWell(command))));
            }
        });
    }
    add(ui, "Add a well…", Choice::Well, session.document.geometry.is_some(), actions);
    ui.add_space(10.0);
}
