//! The volumes, horizons, faults and wells of the project.

use super::names::{self, NameField, colour};
use super::notices;
use super::picking::{palette, swatch};
use crate::state::{Action, Blended, Choice, DataForm, Dialogue, Place, SectionVolumes, Session, State, Written};
use crate::widgets::form;
use crate::widgets::keyboard::Renamed;
use crate::widgets::obstacle::{needs, unless};
use crate::widgets::percent;
use eframe::egui::{
    Align, Button, ComboBox, DragValue, Id, Label, Layout, Response, ScrollArea, Ui, UiBuilder, WidgetInfo,
};
use files::SurfaceKind;
use project::command::{Command, SetFaultExtent, SetRaw, SetVelocity};
use project::document::{FaultEntry, VolumeEntry};
use project::error::Noun;
use project::styles;
use render::Scene;
use std::fmt::Display;
use survey::VerticalUnit;
use ttf::ColourMap;

/// Room at the right for the scroll bar, points.
const BESIDE_BAR: f32 = 8.0;

/// The panel, with the text being typed in it.
#[derive(Default)]
pub struct Data {
    renaming: NameField,
    /// The volume whose buttons are shown.
    volume: Option<String>,
    /// The fault whose buttons are shown.
    fault: Option<String>,
    /// The well whose buttons are shown.
    well: Option<String>,
    velocity: Option<f64>,
    /// The fault whose extent is being changed, and the metres so far.
    extent: Option<(String, f64)>,
}

impl Data {
    /// Shows the panel.
    pub fn show(&mut self, ui: &mut Ui, state: &State, session: &Session, actions: &mut Vec<Action>) {
        notices::show(ui, state, Place::Data, actions);
        ScrollArea::vertical().auto_shrink([false, true]).show(ui, |ui| {
            // Buttons at the right end of rows keep clear of the scroll bar.
            ui.set_max_width(ui.available_width() - BESIDE_BAR);
            ui.heading("Volumes");
            self.volumes(ui, session, actions);
            ui.add_space(10.0);
            ui.heading("Horizons");
            self.horizons(ui, session, actions);
            ui.add_space(10.0);
            ui.heading("Faults");
            self.faults(ui, session, actions);
            ui.add_space(10.0);
            self.wells(ui, session, actions);
            self.survey(ui, session, actions);
        });
    }

    fn volumes(&mut self, ui: &mut Ui, session: &Session, actions: &mut Vec<Action>) {
        let document = &session.document;
        let raw = styles::transfer_functions(document).raw;
        for entry in &document.volumes {
            let is_raw = raw.as_ref().is_some_and(|raw| raw.volume == entry.name);
            let is_chosen = self.volume.as_ref() == Some(&entry.name);
            ui.horizontal(|ui| {
                on_sections(ui, session, entry, is_raw, actions);
                if let Some(renamed) = self.renaming.show(ui, 150.0, (Noun::Volume, &entry.name), actions) {
                    if let Renamed::To(to) = renamed {
                        self.volume = Some(to);
                    }
                    return;
                }
                let row = named(ui, &entry.name, Some(is_raw), &format!("Remove volume {}", entry.name));
                let hint = format!("{}: show as raw data; {} polarity; {}", entry.name, entry.polarity, entry.origin);
                if row.name.on_hover_text(hint).clicked() {
                    self.volume = (!is_chosen).then(|| entry.name.clone());
                    if !is_raw
                        && let Ok(raw) = styles::raw_colour(document, Some(&entry.name), ColourMap::Seismics, None)
                    {
                        actions.push(Action::Apply(Box::new(Command::SetRaw(SetRaw { raw }))));
                    }
                }
                if row.is_removed {
                    actions.push(names::remove(Noun::Volume, &entry.name));
                }
            });
            if is_chosen {
                ui.indent("chosen", |ui| {
                    ui.horizontal(|ui| {
                        let rename = ui.button("Rename").on_hover_text(format!("Rename volume {}", entry.name));
                        if rename.clicked() {
                            self.renaming.begin(Noun::Volume, &entry.name);
                        }
                        export(ui, session, Written::Volume(None), &entry.name, actions);
                    });
                });
            }
            if let Some(over) = session.view.volumes.over.as_ref().filter(|over| over.volume == entry.name) {
                ui.indent("over", |ui| blended(ui, session, over, actions));
            }
        }
        add(ui, "Add a volume…", Choice::MoreSurvey, true, actions);
    }

    fn horizons(&mut self, ui: &mut Ui, session: &Session, actions: &mut Vec<Action>) {
        for (index, entry) in session.document.horizons.iter().enumerate() {
            let is_chosen = session.view.horizon.as_deref() == Some(&entry.name);
            ui.horizontal(|ui| {
                eye(ui, session, SurfaceKind::Horizon, &entry.name, actions);
                swatch(ui, entry, index, actions);
                if self.renaming.show(ui, 150.0, (Noun::Horizon, &entry.name), actions).is_some() {
                    return;
                }
                let row = named(ui, &entry.name, Some(is_chosen), &format!("Remove horizon {}", entry.name));
                if row.name.on_hover_text(format!("{}: {}", entry.name, entry.history())).clicked() {
                    actions.push(Action::Horizon((!is_chosen).then(|| entry.name.clone())));
                }
                if row.is_removed {
                    actions.push(names::remove(Noun::Horizon, &entry.name));
                }
            });
            if is_chosen {
                ui.indent("chosen", |ui| {
                    ui.horizontal(|ui| {
                        let rename = ui.button("Rename").on_hover_text(format!("Rename horizon {}", entry.name));
                        if rename.clicked() {
                            self.renaming.begin(Noun::Horizon, &entry.name);
                        }
                        export(ui, session, Written::surface(SurfaceKind::Horizon), &entry.name, actions);
                    });
                });
            }
        }
        add(ui, "Add a horizon…", Choice::Horizon, session.document.geometry.is_some(), actions);
    }

    fn faults(&mut self, ui: &mut Ui, session: &Session, actions: &mut Vec<Action>) {
        for entry in &session.document.faults {
            let is_chosen = self.fault.as_ref() == Some(&entry.name);
            ui.horizontal(|ui| {
                eye(ui, session, SurfaceKind::Fault, &entry.name, actions);
                if let Some(chosen) = palette(ui, entry.ink(), &format!("Colour of fault {}", entry.name)) {
                    actions.push(colour(Noun::Fault, &entry.name, chosen));
                }
                let (renaming, what) = (&mut self.renaming, (Noun::Fault, entry.name.as_str()));
                choosable(ui, renaming, &mut self.fault, what, &entry.origin, actions);
            });
            if let Some(other) = &entry.truncated_by {
                ui.indent("ends", |ui| ui.weak(format!("ends at {other}")));
            }
            // The identity is fixed, as that of the velocity.
            let row = UiBuilder::new().scope_id(Id::unique(("extent", &entry.name)));
            ui.scope_builder(row, |ui| ui.horizontal(|ui| self.extent(ui, entry, actions)));
            if is_chosen {
                ui.indent("chosen", |ui| {
                    ui.horizontal(|ui| {
                        if ui.button("Rename").on_hover_text(format!("Rename fault {}", entry.name)).clicked() {
                            self.renaming.begin(Noun::Fault, &entry.name);
                        }
                        export(ui, session, Written::surface(SurfaceKind::Fault), &entry.name, actions);
                    });
                });
            }
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

    fn wells(&mut self, ui: &mut Ui, session: &Session, actions: &mut Vec<Action>) {
        ui.heading("Wells");
        for entry in &session.document.wells {
            let is_chosen = self.well.as_ref() == Some(&entry.name);
            ui.horizontal(|ui| {
                let hidden = &session.view.scene.hidden_wells;
                let mut is_shown = !hidden.contains(&entry.name);
                let shown = ui.name_inputs(format!("Show well {}", entry.name), |ui| ui.checkbox(&mut is_shown, ""));
                if shown.on_hover_text("Its path in the block, and its name on figures").changed() {
                    let mut hidden: Vec<String> = hidden.iter().filter(|name| **name != entry.name).cloned().collect();
                    hidden.extend((!is_shown).then(|| entry.name.clone()));
                    let scene = Scene { hidden_wells: hidden, ..session.view.scene.clone() };
                    actions.push(Action::Show(Box::new(scene)));
                }
                let ink = entry.colour.unwrap_or(session.view.scene.wells.colour);
                if let Some(chosen) = palette(ui, ink, &format!("Colour of well {}", entry.name)) {
                    actions.push(colour(Noun::Well, &entry.name, chosen));
                }
                let (renaming, what) = (&mut self.renaming, (Noun::Well, entry.name.as_str()));
                choosable(ui, renaming, &mut self.well, what, &entry.origin, actions);
            });
            if is_chosen {
                ui.indent("chosen", |ui| {
                    if ui.button("Rename").on_hover_text(format!("Rename well {}", entry.name)).clicked() {
                        self.renaming.begin(Noun::Well, &entry.name);
                    }
                });
            }
        }
        add(ui, "Add a well…", Choice::Well, session.document.geometry.is_some(), actions);
        ui.add_space(10.0);
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
                    let label = form::label(ui, "Velocity").on_hover_text("Turns two-way time into metres");
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
    ui.with_layout(Layout::right_to_left(Align::Center), |ui| ui.button("Remove").on_hover_text(hint).clicked()).inner
}

/// The name of a row, and whether it is to be removed.
pub(super) struct Row {
    name: Response,
    pub(super) is_removed: bool,
}

/// A name that is cut off where there is no room, and can be chosen where that means something, and a button to remove it at the end of the row.
pub(super) fn named(ui: &mut Ui, name: &str, is_chosen: Option<bool>, hint: &str) -> Row {
    ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
        let is_removed = ui.button("Remove").on_hover_text(hint).clicked();
        let name = ui.with_layout(Layout::left_to_right(Align::Center), |ui| match is_chosen {
            Some(is_chosen) => ui.add(Button::selectable(is_chosen, name).truncate()),
            None => ui.add(Label::new(name).truncate()),
        });
        let name = name.inner;
        Row { name, is_removed }
    })
    .inner
}

/// The name of a fault or well, which can be chosen, renamed and removed.
fn choosable(
    ui: &mut Ui,
    renaming: &mut NameField,
    chosen: &mut Option<String>,
    (noun, name): (Noun, &str),
    origin: &impl Display,
    actions: &mut Vec<Action>,
) {
    if let Some(renamed) = renaming.show(ui, 150.0, (noun, name), actions) {
        if let Renamed::To(to) = renamed {
            *chosen = Some(to);
        }
        return;
    }
    let is_chosen = chosen.as_deref() == Some(name);
    let row = named(ui, name, Some(is_chosen), &format!("Remove {noun} {name}"));
    if row.name.on_hover_text(format!("{name}: {origin}")).clicked() {
        *chosen = (!is_chosen).then(|| name.to_owned());
    }
    if row.is_removed {
        actions.push(names::remove(noun, name));
    }
}

/// A box that shows or hides the lines and surfaces of a horizon or fault.
fn eye(ui: &mut Ui, session: &Session, kind: SurfaceKind, name: &str, actions: &mut Vec<Action>) {
    let mut is_shown = !session.view.hidden.has(kind, name);
    let shown = ui.name_inputs(format!("Show {kind} {name}"), |ui| ui.checkbox(&mut is_shown, ""));
    if shown.on_hover_text("Its lines on sections, and its surface while interpreting").changed() {
        actions.push(Action::Hide { kind, name: name.to_owned(), hidden: !is_shown });
    }
}

/// A button that asks how to write a volume, a horizon or a fault.
fn export(ui: &mut Ui, session: &Session, what: Written, name: &str, actions: &mut Vec<Action>) {
    if ui.button("Export…").on_hover_text(format!("Write {} {name} for other programs", what.noun())).clicked() {
        let form = DataForm::new(what, name, session.root.parent());
        actions.push(Action::Ask(Box::new(Dialogue::Data(form))));
    }
}

/// Why nothing can be placed yet.
pub(super) const NO_SURVEY: &str = "Add a volume first: it says where everything is";

fn add(ui: &mut Ui, name: &str, choice: Choice, can: bool, actions: &mut Vec<Action>) {
    if unless(ui, needs(can, NO_SURVEY), Button::new(name)).clicked() {
        actions.push(Action::Ask(Box::new(Dialogue::Choose(choice))));
    }
}

/// A box that shows a volume on the sections: the raw data, or another one over them.
fn on_sections(ui: &mut Ui, session: &Session, entry: &VolumeEntry, is_raw: bool, actions: &mut Vec<Action>) {
    let volumes = &session.view.volumes;
    let is_over = volumes.over.as_ref().is_some_and(|over| over.volume == entry.name);
    let before = if is_raw { !volumes.without_raw } else { is_over };
    let mut is_shown = before;
    let has_own = entry.geometry.is_some();
    let shown = ui.name_inputs(format!("Show volume {}", entry.name), |ui| {
        ui.add_enabled_ui(!has_own || is_raw, |ui| ui.checkbox(&mut is_shown, "")).inner
    });
    let hint = if is_raw {
        "The raw data of the sections"
    } else {
        "Over the raw data of the sections, in colours of its own"
    };
    shown.on_hover_text(hint).on_disabled_hover_text("It has traces of its own and cannot be laid over the raw data");
    if is_shown != before {
        actions.push(Action::Volumes(match is_raw {
            true => SectionVolumes { without_raw: !is_shown, ..volumes.clone() },
            false => SectionVolumes { over: is_shown.then(|| Blended::new(&entry.name)), ..volumes.clone() },
        }));
    }
}

/// Colours and opacity of the volume over the raw data.
fn blended(ui: &mut Ui, session: &Session, over: &Blended, actions: &mut Vec<Action>) {
    let mut next = over.clone();
    ui.horizontal(|ui| {
        let colours =
            ComboBox::from_id_salt("colours of the second volume").width(110.0).selected_text(next.map.name());
        ui.name_inputs(format!("Colours of {}", over.volume), |ui| {
            colours
                .show_ui(ui, |ui| {
                    for map in ColourMap::ALL {
                        ui.selectable_value(&mut next.map, map, map.name());
                    }
                })
                .response
        });
        ui.name_inputs(format!("Opacity of {}", over.volume), |ui| ui.add(percent::drag(&mut next.opacity)))
            .on_hover_text("How much of the raw data it covers");
    });
    if next != *over {
        actions.push(Action::Volumes(SectionVolumes { over: Some(next), ..session.view.volumes.clone() }));
    }
}
