//! The horizons with their coverage; below the one that picks go to, its picks and holes.

use super::go;
use super::palette::palette;
use crate::state::{Action, PickingStep, Session};
use crate::views::names::{NameField, colour, remove};
use crate::widgets::obstacle::{needs, unless};
use crate::work::{Interpreted, InterpretedHorizon};
use eframe::egui::{Button, CollapsingHeader, DragValue, RichText, TextEdit, Ui};
use interp::assembly::Operation;
use interp::holes::FillSettings;
use interp::refine::SmoothSettings;
use project::command::{Command, FillHorizon, Move, MovePick, RemovePick, ReplayPicks, SmoothHorizon, Unfit};
use project::document::HorizonEntry;
use project::error::Noun;
use survey::SurveyGeometry;

/// Largest number of holes that are listed.
const HOLES: usize = 5;
/// Number of horizons from which those that are finished are folded away.
const MANY: usize = 6;

/// The list, with the text being typed in it.
#[derive(Default)]
pub(super) struct HorizonList {
    renaming: NameField,
    max_traces: usize,
    along_reflection: bool,
    smoothing: SmoothSettings,
}

impl HorizonList {
    /// Shows the list.
    pub(super) fn show(
        &mut self,
        ui: &mut Ui,
        session: &Session,
        shown: Option<&Interpreted>,
        geometry: &SurveyGeometry,
        actions: &mut Vec<Action>,
    ) {
        let picking = &session.view.picking;
        let document = &session.document;
        if ui.button("New horizon").on_hover_text("The next pick starts another horizon (N)").clicked() {
            actions.push(Action::Picking(PickingStep::Begin));
        }
        let facts_of = |entry: &HorizonEntry| {
            shown.and_then(|shown| shown.horizons.iter().find(|horizon| horizon.name == entry.name))
        };
        let is_current = |entry: &HorizonEntry| picking.horizon.as_deref() == Some(&entry.name);
        let is_folded = |entry: &HorizonEntry| {
            document.horizons.len() >= MANY && !is_current(entry) && facts_of(entry).is_some_and(is_finished)
        };
        let (folded, open): (Vec<_>, Vec<_>) =
            document.horizons.iter().enumerate().partition(|(_, entry)| is_folded(entry));
        for (index, entry) in open {
            let facts = facts_of(entry);
            row(ui, entry, (index, is_current(entry)), facts, actions);
            if is_current(entry) {
                ui.indent("current", |ui| self.current(ui, session, entry, facts, geometry, actions));
            }
        }
        if !folded.is_empty() {
            let title = format!("{} finished horizons", folded.len());
            let fold = CollapsingHeader::new(title).id_salt("finished").show(ui, |ui| {
                for (index, entry) in folded {
                    row(ui, entry, (index, false), facts_of(entry), actions);
                }
            });
            fold.header_response
                .on_hover_text("On all traces of their blocks, without a hole, an overlap or a conflict");
        }
        if let Some(name) =
            picking.horizon.as_ref().filter(|name| !document.horizons.iter().any(|entry| entry.name == **name))
        {
            self.begun(ui, session, name, actions);
        }
    }

    /// The row of a horizon that does not exist yet.
    fn begun(&self, ui: &mut Ui, session: &Session, name: &str, actions: &mut Vec<Action>) {
        let picking = &session.view.picking;
        ui.horizontal(|ui| {
            let chosen = picking.colour_in(&session.document);
            if let Some(colour) = palette(ui, chosen, "Colour of the new horizon") {
                actions.push(Action::Picking(PickingStep::Tint(colour)));
            }
            let mut text = name.to_owned();
            let edit = ui.name_inputs("Name of the new horizon", |ui| {
                ui.add(TextEdit::singleline(&mut text).desired_width(150.0))
            });
            if edit.changed() {
                actions.push(Action::Picking(PickingStep::Name(text)));
            }
        });
        ui.weak("New: it is created with the first pick that you add.");
    }

    fn current(
        &mut self,
        ui: &mut Ui,
        session: &Session,
        entry: &HorizonEntry,
        facts: Option<&InterpretedHorizon>,
        geometry: &SurveyGeometry,
        actions: &mut Vec<Action>,
    ) {
        ui.horizontal(|ui| {
            if self.renaming.show(ui, 140.0, (Noun::Horizon, &entry.name), actions).is_none() {
                if ui.button("Rename…").clicked() {
                    self.renaming.begin(Noun::Horizon, &entry.name);
                }
                if ui.button("Remove").on_hover_text(format!("Remove horizon {}", entry.name)).clicked() {
                    actions.push(remove(Noun::Horizon, &entry.name));
                }
            }
        });
        let Some(facts) = facts else { return };
        let report = &facts.report;
        let plural = |count: usize| if count == 1 { "" } else { "s" };
        let filled = match facts.filled {
            0 => String::new(),
            count => format!(", {count} node{} filled", plural(count)),
        };
        ui.label(format!(
            "{} nodes on {:.1} % of the traces, {} sheet{}{filled}",
            report.nodes,
            100.0 * report.share,
            report.sheets,
            plural(report.sheets)
        ));
        if facts.outdated {
            ui.colored_label(ui.visuals().warn_fg_color, "Its picks were made on another extraction.");
            ui.horizontal_wrapped(|ui| {
                for (name, unfit, hint) in [
                    ("Pick again", Unfit::Refuse, "Make the same picks on the present extraction"),
                    (
                        "Pick again what fits",
                        Unfit::Drop,
                        "Make the same picks, without those whose nodes no longer exist",
                    ),
                ] {
                    if ui.button(name).on_hover_text(hint).clicked() {
                        let command = ReplayPicks { horizon: Some(entry.name.clone()), unfit };
                        actions.push(apply(Command::ReplayPicks(command)));
                    }
                }
            });
        }
        if let Some(overlap) = &report.overlap {
            ui.colored_label(
                ui.visuals().warn_fg_color,
                format!(
                    "Overlaps itself at {}, by up to {}.",
                    counted(overlap.traces, "trace"),
                    counted(overlap.apart.round() as usize, "sample")
                ),
            );
            if ui.button("Show the overlap").clicked() {
                go(geometry, overlap.at, actions);
            }
        }
        for conflict in &facts.conflicts {
            ui.colored_label(ui.visuals().warn_fg_color, format!("Conflict: {conflict}."));
        }
        picks(ui, entry, geometry, actions);
        drawn(ui, entry, geometry, actions);
        self.holes(ui, session, entry, facts, actions);
        self.smooth(ui, entry, actions);
    }

    fn holes(
        &mut self,
        ui: &mut Ui,
        session: &Session,
        entry: &HorizonEntry,
        facts: &InterpretedHorizon,
        actions: &mut Vec<Action>,
    ) {
        let holes = &facts.holes;
        let traces: usize = holes.iter().map(|hole| hole.traces).sum();
        if holes.is_empty() {
            ui.weak("no holes");
            return;
        }
        let counted = |count: usize, noun: &str| format!("{count} {noun}{}", if count == 1 { "" } else { "s" });
        ui.label(format!("{} with {}", counted(holes.len(), "hole"), counted(traces, "trace")));
        ui.horizontal_wrapped(|ui| {
            for hole in holes.iter().take(HOLES) {
                let hint = "Move the sections through this hole";
                if ui.button(counted(hole.traces, "trace")).on_hover_text(hint).clicked() {
                    let [x, y] = hole.at.map(|at| at as f64);
                    actions.push(Action::Slices([x, y, session.view.slices[2]]));
                }
            }
            if holes.len() > HOLES {
                ui.weak(format!("and {} smaller", holes.len() - HOLES));
            }
        });
        let along = ui.checkbox(&mut self.along_reflection, "Along the reflection");
        along.on_hover_text("Where neighbouring traces in a hole show it; the smoothest surface fills the rest");
        ui.horizontal(|ui| {
            if ui.button("Fill holes").on_hover_text("With the smoothest surface, never across a fault").clicked() {
                let max_traces = (self.max_traces > 0).then_some(self.max_traces);
                let settings = FillSettings { max_traces, along_reflection: self.along_reflection };
                let command = FillHorizon { name: entry.name.clone(), settings };
                actions.push(Action::Apply(Box::new(Command::FillHorizon(command))));
            }
            let drag = DragValue::new(&mut self.max_traces).range(0..=1_000_000).custom_formatter(|value, _| {
                if value == 0.0 { "of any size".to_owned() } else { format!("up to {value:.0} traces") }
            });
            ui.name_inputs("Largest hole to fill", |ui| ui.add(drag));
        });
    }

    /// Smoothing, which stays with a horizon that was assembled until it is taken back.
    fn smooth(&mut self, ui: &mut Ui, entry: &HorizonEntry, actions: &mut Vec<Action>) {
        let mut order = |settings: SmoothSettings| {
            actions.push(apply(Command::SmoothHorizon(SmoothHorizon { name: entry.name.clone(), settings })));
        };
        ui.horizontal(|ui| {
            if ui.button("Smooth").on_hover_text("By planes through the nodes around, never across a fault").clicked() {
                order(self.smoothing);
            }
            let SmoothSettings { radius, passes } = SmoothSettings::MOST;
            let drag = DragValue::new(&mut self.smoothing.radius).range(1..=radius);
            ui.name_inputs("Radius of smoothing", |ui| ui.add(drag)).on_hover_text("More takes out longer waves");
            ui.weak("traces,");
            let drag = DragValue::new(&mut self.smoothing.passes).range(1..=passes);
            ui.name_inputs("Passes of smoothing", |ui| ui.add(drag));
            ui.weak("passes");
        });
        if let Some(SmoothSettings { radius, passes }) = entry.assembly.as_ref().and_then(|log| log.smooth) {
            ui.horizontal(|ui| {
                ui.weak(format!("Smoothed over {radius} traces, passes: {passes}"));
                if ui.button("Not smoothed").on_hover_text("Show it as it was picked").clicked() {
                    order(SmoothSettings { radius: 0, passes: 1 });
                }
            });
        }
    }
}

/// The colour of a horizon, which can be changed.
pub(crate) fn swatch(ui: &mut Ui, entry: &HorizonEntry, index: usize, actions: &mut Vec<Action>) {
    let present = figure::style::horizon_colour(entry.own_colour(), index);
    if let Some(chosen) = palette(ui, present, &format!("Colour of {}", entry.name)) {
        actions.push(colour(Noun::Horizon, &entry.name, chosen));
    }
}

/// The picks of a horizon, first to last, or the clicks that it was found by in geologic time.
fn picks(ui: &mut Ui, entry: &HorizonEntry, geometry: &SurveyGeometry, actions: &mut Vec<Action>) {
    let unit = geometry.vertical.unit.symbol();
    let Some(log) = &entry.assembly else {
        if entry.origin.seeds().is_empty() {
            ui.weak("Not picked: it was imported or computed.");
        }
        for (index, &at) in entry.origin.seeds().iter().enumerate() {
            let ([inline, crossline, z], number) = (at, index + 1);
            let text = format!("click {number}: {inline:.0}, {crossline:.0}, {z:.0} {unit}");
            let hint = format!("Go to click {number}: inline, crossline, {unit}");
            if ui.selectable_label(false, text).on_hover_text(hint).clicked() {
                go(geometry, at, actions);
            }
        }
        return;
    };
    let only = log.picks.len() + log.drawn.len() == 1;
    for pick in &log.picks {
        let [inline, crossline, z] = pick.at;
        let sign = if pick.operation == Operation::Add { "+" } else { "−" };
        ui.horizontal(|ui| {
            let text = format!("{sign} {}: {inline:.0}, {crossline:.0}, {z:.0} {unit}", pick.id);
            let hint = format!("Go to pick {}: inline, crossline, {unit}", pick.id);
            if ui.selectable_label(false, text).on_hover_text(hint).clicked() {
                go(geometry, pick.at, actions);
            }
            ui.weak(format!("level {}", pick.up));
        });
        ui.horizontal_wrapped(|ui| {
            ui.add_space(8.0);
            let mut button = |ui: &mut Ui, name: &str, hint: &str, can: bool, command: Command| {
                let why = if name == "Down" {
                    "It is a leaf already"
                } else {
                    "The horizon has no other pick: remove it instead"
                };
                let button = unless(ui, needs(can, why), Button::new(name));
                if button.on_hover_text(format!("{hint} pick {}", pick.id)).clicked() {
                    actions.push(apply(command));
                }
            };
            let to = |to: Move| Command::MovePick(MovePick { id: pick.id, to });
            button(ui, "Up", "Climb with", true, to(Move::Up(1)));
            button(ui, "Down", "Descend with", pick.up > 0, to(Move::Down(1)));
            button(ui, "Highest", "Highest valid for", true, to(Move::HighestValid));
            button(ui, "Unpick", "Remove", !only, Command::RemovePick(RemovePick { id: pick.id }));
        });
    }
}

/// What was drawn and tracked of a horizon, first to last.
fn drawn(ui: &mut Ui, entry: &HorizonEntry, geometry: &SurveyGeometry, actions: &mut Vec<Action>) {
    let Some(log) = &entry.assembly else { return };
    let only = log.picks.len() + log.drawn.len() == 1;
    for drawn in &log.drawn {
        let [inline, crossline, z] = drawn.part.place();
        let (noun, unit) = (drawn.part.noun(), geometry.vertical.unit.symbol());
        ui.horizontal(|ui| {
            let text = format!("{noun} {}: {inline:.0}, {crossline:.0}, {z:.0} {unit}", drawn.id);
            let hint = format!("Go to the beginning of {noun} {}", drawn.id);
            if ui.selectable_label(false, text).on_hover_text(hint).clicked() {
                go(geometry, drawn.part.place(), actions);
            }
            let why = needs(!only, "The horizon has nothing else: remove it instead");
            let button = unless(ui, why, Button::new("Take out"));
            if button.on_hover_text(format!("Remove {noun} {}", drawn.id)).clicked() {
                actions.push(apply(Command::RemovePick(RemovePick { id: drawn.id })));
            }
        });
    }
}

/// Whether nothing is left to do on a horizon: no hole, no overlap, no conflict, picks on the present extraction.
fn is_finished(facts: &InterpretedHorizon) -> bool {
    facts.holes.is_empty() && facts.report.overlap.is_none() && facts.conflicts.is_empty() && !facts.outdated
}

/// The row of a horizon: colour, name, coverage, and a sign where something is wrong.
fn row(
    ui: &mut Ui,
    entry: &HorizonEntry,
    (index, is_current): (usize, bool),
    facts: Option<&InterpretedHorizon>,
    actions: &mut Vec<Action>,
) {
    ui.horizontal(|ui| {
        swatch(ui, entry, index, actions);
        // Room for the coverage and the sign that something is wrong.
        let room = (ui.available_width() - 112.0).max(40.0);
        let label = Button::selectable(is_current, RichText::new(&entry.name).strong()).truncate();
        let label = ui.scope(|ui| {
            ui.set_max_width(room);
            ui.add(label)
        });
        if label.inner.on_hover_text(format!("{}: picks go to this horizon", entry.name)).clicked() {
            actions.push(Action::Picking(PickingStep::Choose(entry.name.clone())));
        }
        if let Some(facts) = facts {
            ui.weak(format!("{} picked", facts.picked.percent())).on_hover_text(facts.picked.sentence());
            if facts.report.overlap.is_some() || !facts.conflicts.is_empty() || facts.outdated {
                let colour = ui.visuals().warn_fg_color;
                let hint = "It overlaps itself or conflicts with another horizon; choose it to see where";
                ui.colored_label(colour, "!").on_hover_text(hint);
            }
        }
    });
}

/// A number of things, in words.
fn counted(count: usize, noun: &str) -> String {
    format!("{count} {noun}{}", if count == 1 { "" } else { "s" })
}

fn apply(command: Command) -> Action {
    Action::Apply(Box::new(command))
}
