//! The panel of horizon candidates: extraction and its settings.

use crate::state::picking::{PickingStep, Tool, free_name};
use crate::state::{Action, Session};
use crate::widgets::form;
use crate::widgets::obstacle::{needs, unless};
use crate::work::{Interpreted, Job, RunningLine};
use eframe::egui::{Align, Button, ComboBox, DragValue, Grid, Layout, ProgressBar, Ui};
use interp::{ExtractSettings, Extremum, Method};
use project::command::{AttributeKind, Command, ComputeAttribute, ComputeTime};
use project::document::Document;
use project::error::Noun;
use time::TimeSettings;

/// The volume and the settings of the next extraction.
#[derive(Default)]
pub(crate) struct CandidatesPanel {
    settings: ExtractSettings,
    volume: Option<String>,
}

impl CandidatesPanel {
    /// Shows the panel.
    pub(crate) fn show(
        &mut self,
        ui: &mut Ui,
        session: &Session,
        shown: Option<&Interpreted>,
        running: &[RunningLine],
        actions: &mut Vec<Action>,
    ) {
        if let Some(line) = running.iter().find(|line| line.job == Job::Extraction) {
            ui.label(if line.stage.is_empty() { "extracting" } else { &line.stage });
            ui.horizontal(|ui| {
                ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
                    if ui.button("Stop extracting").clicked() {
                        line.progress.cancel();
                    }
                    ui.add(ProgressBar::new(line.share().unwrap_or(0.0)).show_percentage());
                });
            });
            ui.weak("You can go on working meanwhile.");
            return;
        }
        let found = shown.and_then(|shown| shown.extraction.as_ref());
        if found.is_none() {
            ui.label("Find every reflection that can be followed; horizons are then put together from them.");
        }
        let name = if found.is_some() { "Extract again" } else { "Extract" };
        let can = session.document.volumes.iter().any(|entry| entry.geometry.is_none());
        ui.horizontal_wrapped(|ui| {
            if let Some(report) = found {
                ui.label(format!("{} surfaces, {} leaves", report.surfaces, report.leaves));
            }
            if unless(ui, needs(can, "Needs a volume"), Button::new(name)).clicked() {
                actions.push(Action::Extract(self.volume.clone(), Box::new(self.settings.clone())));
            }
        });
        without_picks(ui, session, found.is_some(), can, actions);
        ui.collapsing("Settings", |ui| self.extraction_settings(ui, session));
    }

    fn extraction_settings(&mut self, ui: &mut Ui, session: &Session) {
        let settings = &mut self.settings;
        Grid::new("extraction").num_columns(2).show(ui, |ui| {
            let own = || session.document.volumes.iter().filter(|entry| entry.geometry.is_none());
            if own().count() > 1 {
                let first = own().next().map_or_else(String::new, |entry| entry.name.clone());
                let text = self.volume.clone().unwrap_or(first);
                let combo = ComboBox::from_id_salt("extracted").selected_text(text).truncate();
                let choices = own().map(|entry| (Some(entry.name.clone()), &entry.name));
                form::chosen(ui, "Volume", combo, &mut self.volume, choices);
            }
            ui.label("Method");
            ui.horizontal(|ui| {
                ui.selectable_value(&mut settings.grow.method, Method::Ours, "Accurate")
                    .on_hover_text("Follows reflections with their dips, and keeps side lobes apart");
                ui.selectable_value(&mut settings.grow.method, Method::Paper, "As published");
            });
            ui.end_row();
            ui.label("Follow");
            ui.vertical(|ui| {
                for (kind, name) in
                    [(Extremum::Peak, "Peaks"), (Extremum::Trough, "Troughs"), (Extremum::Zero, "Zero crossings")]
                {
                    let mut is_followed = settings.grow.extrema.contains(&kind);
                    if ui.checkbox(&mut is_followed, name).changed() {
                        settings.grow.extrema.retain(|known| *known != kind);
                        if is_followed {
                            settings.grow.extrema.push(kind);
                        }
                    }
                }
            });
            ui.end_row();
            let drag = DragValue::new(&mut settings.grow.min_front_width).range(2..=64).suffix(" traces");
            form::row(ui, "Minimum front width", |ui| ui.add(drag));
            let drag = DragValue::new(&mut settings.grow.fault_evidence).range(5.0..=10_000.0).speed(1.0);
            let hint = "More evidence gives fewer cuts: 25 for clean data, 100 to 200 for clipped samples or chaotic reflectors";
            form::row(ui, "Fault evidence", |ui| ui.add(drag)).on_hover_text(hint);
            let mut percent = 100.0 * settings.grow.join_share;
            let drag = DragValue::new(&mut percent).range(5.0..=101.0).speed(1.0).suffix(" %");
            let hint = "Share of the common boundary that must support joining two pieces; 101 joins none";
            if form::row(ui, "Join pieces from", |ui| ui.add(drag)).on_hover_text(hint).changed() {
                settings.grow.join_share = percent / 100.0;
            }
            let drag = DragValue::new(&mut settings.forest.min_leaf_triangles).range(1..=100_000).suffix(" triangles");
            form::row(ui, "Minimum leaf size", |ui| ui.add(drag));
            let drag = DragValue::new(&mut settings.distance.max_distance).range(1.0..=10.0).suffix(" voxels");
            form::row(ui, "Maximum distance", |ui| ui.add(drag));
        });
        if ui.button("Default settings").clicked() {
            *settings = ExtractSettings::default();
        }
    }
}

/// What needs no picks: geologic time, layers between its levels, and volumes that are made of it.
fn without_picks(ui: &mut Ui, session: &Session, is_extracted: bool, has_volume: bool, actions: &mut Vec<Action>) {
    ui.horizontal_wrapped(|ui| {
        let why = needs(is_extracted, "Needs candidates: extract them first");
        let name = if session.document.geologic_time().is_some() { "Geologic time again" } else { "Geologic time" };
        let hint = "The age of every voxel, from the candidates and the faults: then one click makes a horizon";
        if unless(ui, why, Button::new(name)).on_hover_text(hint).clicked() {
            let name = volume_name(&session.document, "time");
            let command = ComputeTime { name, settings: TimeSettings::default(), memory_bytes: None };
            actions.push(Action::Apply(Box::new(Command::Time(command))));
            actions.push(Action::Picking(PickingStep::Use(Tool::Time)));
        }
        let is_free = session.document.horizons.is_empty();
        let why = needs(has_volume, "Needs a volume")
            .or_else(|| needs(is_free, "The project has horizons, and so layers, already"));
        let hint =
            "Layers without a pick: candidates, faults, geologic time, its strongest levels. Undo takes each back";
        if unless(ui, why, Button::new("Illustrate now")).on_hover_text(hint).clicked() {
            actions.push(Action::Illustrate);
        }
    });
    ui.horizontal_wrapped(|ui| {
        let has_time = session.document.geologic_time().is_some();
        for (kind, label, volume, hint) in [
            (
                AttributeKind::Flattened,
                "Lay beds flat",
                "flattened",
                "A Wheeler diagram: a volume down which geologic time runs, empty where beds are missing. Show it under Data",
            ),
            (
                AttributeKind::Hiatus,
                "Missing beds",
                "missing beds",
                "How fast geologic time runs down the traces: a volume that is high at unconformities. Show it under Data",
            ),
        ] {
            let why = needs(has_time, "Needs geologic time: compute it first");
            if unless(ui, why, Button::new(label)).on_hover_text(hint).clicked() {
                let command = ComputeAttribute {
                    kind,
                    name: volume_name(&session.document, volume),
                    volume: None,
                    dip: Default::default(),
                    semblance: Default::default(),
                    memory_bytes: None,
                };
                actions.push(Action::Apply(Box::new(Command::Attribute(command))));
            }
        }
    });
}

/// A name for a volume: with a number where there is one of that name already.
fn volume_name(document: &Document, name: &str) -> String {
    let is_taken = document.volumes.iter().any(|entry| entry.name == name);
    if is_taken { free_name(document, Noun::Volume, name) } else { name.to_owned() }
}
