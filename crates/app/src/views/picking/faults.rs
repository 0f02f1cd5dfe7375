//! The panel of faults: drawn from sticks, proposed, accepted.

use super::{go, palette};
use crate::state::{Action, ChosenFault, FaultStep, PickingStep, Session, Tool};
use crate::views::names::colour;
use crate::widgets::obstacle::{needs, unless};
use crate::work::{Interpreted, Job, RunningLine};
use eframe::egui::{Button, Label, RichText, Sense, TextEdit, Ui};
use interp::faults::Proposal;
use project::command::{AcceptFault, Command};
use project::error::Noun;
use std::collections::HashMap;
use survey::SurveyGeometry;

/// The texts being typed.
#[derive(Default)]
pub(super) struct FaultsPanel {
    /// Names for proposals, by the proposal's number.
    names: HashMap<u32, String>,
}

impl FaultsPanel {
    /// Shows the panel.
    pub(super) fn show(
        &mut self,
        ui: &mut Ui,
        session: &Session,
        shown: Option<&Interpreted>,
        running: &[RunningLine],
        geometry: &SurveyGeometry,
        actions: &mut Vec<Action>,
    ) {
        let picking = &session.view.picking;
        let step = |step| Action::Picking(step);
        sticks(ui, session, actions);
        present(ui, session, actions);
        let is_looking = running.iter().any(|line| line.job == Job::FaultProposals);
        let has_evidence = session.document.amplitudes().is_ok() || !session.document.horizons.is_empty();
        let can = has_evidence && !is_looking;
        let hint = "Faults are found in the volume, and where horizons are offset (Q)";
        let why = if is_looking { "Looking for faults already" } else { "Faults are found in a volume: add one first" };
        if unless(ui, needs(can, why), Button::new("Propose faults")).on_hover_text(hint).clicked() {
            actions.push(Action::ProposeFaults);
        }
        let Some(shown) = shown else { return };
        let open = || shown.proposals.iter().map(|(proposal, _)| proposal).filter(|proposal| picking.shows(proposal));
        for proposal in open().filter(|proposal| !proposal.is_minor) {
            self.proposal(ui, proposal, &shown.unit, geometry, &picking.faults, actions);
        }
        let dismissed = |id: u32| picking.dismissed.contains(&id);
        let minor = shown.proposals.iter().filter(|(proposal, _)| proposal.is_minor && !dismissed(proposal.id)).count();
        if minor > 0 {
            ui.separator();
            let text = format!("{minor} minor proposal{}", if minor == 1 { "" } else { "s" });
            let hint = "Small ones, together a fifth of the total offset or less, and those whose evidence \
                        scatters or shows no break in the data, and cuts without a throw";
            if ui.selectable_label(picking.minor, text).on_hover_text(hint).clicked() {
                actions.push(step(PickingStep::Minor(!picking.minor)));
            }
        }
        for proposal in open().filter(|proposal| proposal.is_minor) {
            self.proposal(ui, proposal, &shown.unit, geometry, &picking.faults, actions);
        }
    }

    fn proposal(
        &mut self,
        ui: &mut Ui,
        proposal: &Proposal,
        unit: &str,
        geometry: &SurveyGeometry,
        chosen: &[ChosenFault],
        actions: &mut Vec<Action>,
    ) {
        ui.separator();
        let name = self.names.entry(proposal.id).or_insert_with(|| proposal.name.clone());
        let is_chosen = |fault: &ChosenFault| matches!(fault, ChosenFault::Proposed(id, _) if *id == proposal.id);
        let text = marked(ui, RichText::new(in_words(proposal, unit)), chosen.iter().any(is_chosen));
        let label = ui.add(Label::new(text).wrap().sense(Sense::click())).on_hover_text(seen(proposal));
        if label.clicked() {
            choose(ui, ChosenFault::Proposed(proposal.id, name.clone()), actions);
        }
        ui.horizontal(|ui| {
            let label = format!("Name of proposal {}", proposal.id);
            ui.name_inputs(label, |ui| ui.add(TextEdit::singleline(name).desired_width(76.0)));
            if ui.button("Accept").on_hover_text(format!("Accept proposal {}", proposal.id)).clicked() {
                let command = AcceptFault { id: proposal.id, name: name.trim().to_owned() };
                actions.push(Action::Apply(Box::new(Command::AcceptFault(command))));
            }
            if ui.button("Dismiss").on_hover_text(format!("Dismiss proposal {}", proposal.id)).clicked() {
                actions.push(Action::Picking(PickingStep::Dismiss(proposal.id)));
            }
            if ui.button("Go").on_hover_text(format!("Go to proposal {}", proposal.id)).clicked() {
                let [a, b] = proposal.ends;
                let z = 0.5 * (proposal.depth[0] + proposal.depth[1]);
                go(geometry, [0.5 * (a[0] + b[0]), 0.5 * (a[1] + b[1]), z], actions);
            }
        });
    }
}

/// What goes with drawing sticks.
fn sticks(ui: &mut Ui, session: &Session, actions: &mut Vec<Action>) {
    let picking = &session.view.picking;
    let step = |step| Action::Picking(step);
    let is_drawing = picking.tool == Tool::Sticks;
    if ui
        .selectable_label(is_drawing, "Draw sticks")
        .on_hover_text("Click points along the fault on a section; Enter ends a stick (F)")
        .clicked()
    {
        actions.push(step(PickingStep::Use(if is_drawing { Tool::Pick } else { Tool::Sticks })));
    }
    if is_drawing || !picking.sticks.is_empty() {
        let complete = picking.sticks.len();
        ui.label(format!(
            "{complete} stick{} drawn, {} point{} on the next",
            if complete == 1 { "" } else { "s" },
            picking.stick.len(),
            if picking.stick.len() == 1 { "" } else { "s" }
        ));
        ui.horizontal(|ui| {
            let two = needs(picking.stick.len() > 1, "Click at least two points along the fault");
            if unless(ui, two, Button::new("End stick")).on_hover_text("Enter").clicked() {
                actions.push(step(PickingStep::EndStick));
            }
            let some = !(picking.stick.is_empty() && picking.sticks.is_empty());
            let none = needs(some, "No point is drawn");
            if unless(ui, none, Button::new("Remove last point")).on_hover_text("Backspace").clicked() {
                actions.push(step(PickingStep::Backspace));
            }
        });
        ui.horizontal(|ui| {
            let mut name = picking.fault.clone();
            let edit =
                ui.name_inputs("Name of the fault", |ui| ui.add(TextEdit::singleline(&mut name).desired_width(120.0)));
            if edit.changed() {
                actions.push(step(PickingStep::NameFault(name.clone())));
            }
            let can = !name.trim().is_empty() && (complete > 0 || picking.stick.len() > 1);
            if unless(ui, needs(can, "Draw a stick, and name the fault"), Button::new("Make fault")).clicked() {
                actions.push(step(PickingStep::MakeFault));
            }
        });
    }
    if is_drawing && picking.suggestion(&session.document, session.view.slices).is_some() {
        ui.weak("Enter takes the dashed stick.");
    }
}

/// The faults of the project, and what is done with those that are chosen.
fn present(ui: &mut Ui, session: &Session, actions: &mut Vec<Action>) {
    let picking = &session.view.picking;
    let step = |step| Action::Picking(step);
    for entry in &session.document.faults {
        ui.horizontal(|ui| {
            if let Some(chosen) = palette(ui, entry.ink(), &format!("Colour of fault {}", entry.name)) {
                actions.push(colour(Noun::Fault, &entry.name, chosen));
            }
            let hint = "Draw more sticks of it, or drag their points; one without sticks gets some";
            let edit = Button::new("Edit").small();
            if ui.add(edit).on_hover_text(format!("Edit fault {}: {hint}", entry.name)).clicked() {
                actions.push(step(PickingStep::Fault(FaultStep::Edit(entry.name.clone()))));
            }
            let fault = ChosenFault::Present(entry.name.clone());
            let text = marked(ui, RichText::new(&entry.name), picking.faults.contains(&fault));
            let name = ui.add(Label::new(text).truncate().sense(Sense::click()));
            if name.on_hover_text(format!("{}: {}", entry.name, entry.origin)).clicked() {
                choose(ui, fault, actions);
            }
        });
    }
    if picking.faults.len() > 1 {
        ui.horizontal(|ui| {
            ui.label(format!("{} faults are chosen", picking.faults.len()));
            let hint = "Make one fault of those that are chosen, which continue one another (Shift M)";
            if ui.button("Merge").on_hover_text(hint).clicked() {
                actions.push(step(PickingStep::Fault(FaultStep::Merge)));
            }
        });
    }
}

/// The text of what is chosen on the colour of a selection.
fn marked(ui: &Ui, text: RichText, is_chosen: bool) -> RichText {
    if is_chosen { text.background_color(ui.visuals().selection.bg_fill) } else { text }
}

/// Chooses a fault in the list, with Shift beside others.
fn choose(ui: &Ui, fault: ChosenFault, actions: &mut Vec<Action>) {
    let with_others = ui.input(|input| input.modifiers.shift);
    actions.push(Action::Picking(PickingStep::Use(Tool::Faults)));
    actions.push(Action::Picking(PickingStep::Fault(FaultStep::Choose(fault, with_others))));
}

/// A proposal in one sentence.
pub(in crate::views) fn in_words(proposal: &Proposal, unit: &str) -> String {
    let Proposal { id, dip_deg, strike_deg, .. } = proposal;
    format!("Proposal {id}: {}, dips {dip_deg:.0}°, strikes {strike_deg:.0}°", proposal.throw_in_words(unit))
}

/// The evidence for a proposal.
fn seen(proposal: &Proposal) -> String {
    let mut text = format!("{}; throw times length {:.0} m²", proposal.rests_on(), proposal.offset_m2);
    if let Some([on, beside]) = proposal.semblance {
        text += &format!("; semblance {on:.2} on it, {beside:.2} beside");
    }
    text
}
