//! Interpreting: horizons and their picks, holes; around them candidates and faults.

use super::candidates::CandidatesPanel;
use super::faults::FaultsPanel;
use super::sections::horizon_colour;
use super::{notices, overlay::Overlay};
use crate::app::state::picking::voxel_of;
use crate::app::state::{Action, Look, PickingStep, Place, Session, State, Tool};
use crate::app::work::{Interpreted, RunningLine, ShownHorizon};
use crate::command::assembly::HORIZON_COLOURS;
use crate::command::{
    Command, FillHorizon, Move, MovePick, RemoveHorizon, RemovePick, RenameHorizon, SetHorizonColour,
};
use crate::project::document::HorizonEntry;
use eframe::egui::{Button, Color32, DragValue, Grid, RichText, ScrollArea, Sense, Stroke, TextEdit, Ui, vec2};
use interp::assembly::Operation;
use interp::holes::FillSettings;
use render::FaceData;
use std::sync::Arc;
use survey::SurveyGeometry;
use ttf::Colour;

/// Colours offered for horizons beside those that they get in turn.
const MORE_COLOURS: [[u8; 3]; 4] = [[0xb8, 0xa8, 0x00], [0xc0, 0x18, 0x2c], [0x1b, 0x78, 0x37], [0x30, 0x30, 0x30]];

/// Holes listed at most.
const HOLES: usize = 5;

/// The panel, and what is being typed in it.
#[derive(Default)]
pub struct PickingPanel {
    candidates: CandidatesPanel,
    faults: FaultsPanel,
    /// A horizon and its new name.
    renaming: Option<(String, String)>,
    max_traces: usize,
    /// Whether sticks were being drawn, and how many faults were proposed, in the frame before.
    open: (bool, usize),
}

impl PickingPanel {
    /// Shows the panel.
    pub fn show(
        &mut self,
        ui: &mut Ui,
        state: &State,
        session: &Session,
        overlay: &Overlay,
        running: &[RunningLine],
        actions: &mut Vec<Action>,
    ) {
        notices::show(ui, state, Place::Interpret, actions);
        let Some(geometry) = &session.document.geometry else {
            ui.label("There is nothing to interpret yet: add a volume.");
            return;
        };
        ScrollArea::vertical().show(ui, |ui| {
            let shown = overlay.interpreted().map(Arc::as_ref);
            ui.heading("Candidates");
            self.candidates.show(ui, session, shown, running, actions);
            ui.add_space(8.0);
            look(ui, session, actions);
            if shown.is_some_and(|shown| shown.extraction.is_some()) {
                ui.add_space(8.0);
                ui.heading("Selected");
                selected(ui, session, overlay, geometry, actions);
            }
            ui.add_space(8.0);
            ui.heading("Horizons");
            self.horizons(ui, session, shown, geometry, actions);
            ui.add_space(8.0);
            ui.heading("Faults");
            let faults = ui.scope(|ui| self.faults.show(ui, session, shown, running, geometry, actions)).response;
            // Who begins to draw, or is proposed something, need not look for where.
            let open = (session.view.picking.tool == Tool::Sticks, shown.map_or(0, |shown| shown.proposals.len()));
            if open != self.open && (open.0 || open.1 > 0) {
                ui.scroll_to_rect(faults.rect, None);
            }
            self.open = open;
        });
    }

    fn horizons(
        &mut self,
        ui: &mut Ui,
        session: &Session,
        shown: Option<&Interpreted>,
        geometry: &SurveyGeometry,
        actions: &mut Vec<Action>,
    ) {
        let picking = &session.view.picking;
        let document = &session.document;
        if ui.button("New horizon").on_hover_text("What you pick next becomes another horizon (N)").clicked() {
            actions.push(Action::Picking(PickingStep::Begin));
        }
        for (index, entry) in document.horizons.iter().enumerate() {
            let facts = shown.and_then(|shown| shown.horizons.iter().find(|horizon| horizon.name == entry.name));
            let is_current = picking.horizon.as_deref() == Some(&entry.name);
            ui.horizontal(|ui| {
                swatch(ui, entry, index, actions);
                let label = ui.selectable_label(is_current, RichText::new(&entry.name).strong());
                if label.on_hover_text("Picks go to this horizon").clicked() {
                    actions.push(Action::Picking(PickingStep::Choose(entry.name.clone())));
                }
                if let Some(facts) = facts {
                    ui.weak(format!("{:.0} %", 100.0 * facts.report.share)).on_hover_text("Of the traces");
                    if facts.report.overlap.is_some() || !facts.conflicts.is_empty() || facts.outdated {
                        let colour = ui.visuals().warn_fg_color;
                        let hint = "It overlaps or contradicts; choose it to see where";
                        ui.colored_label(colour, "!").on_hover_text(hint);
                    }
                }
            });
            if is_current {
                ui.indent("current", |ui| self.current(ui, session, entry, facts, geometry, actions));
            }
        }
        if let Some(name) =
            picking.horizon.as_ref().filter(|name| !document.horizons.iter().any(|entry| entry.name == **name))
        {
            self.begun(ui, session, name, actions);
        }
    }

    /// A horizon that does not exist yet.
    fn begun(&mut self, ui: &mut Ui, session: &Session, name: &str, actions: &mut Vec<Action>) {
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
        ui.weak("New: it begins with the first pick that you accept.");
    }

    fn current(
        &mut self,
        ui: &mut Ui,
        session: &Session,
        entry: &HorizonEntry,
        facts: Option<&ShownHorizon>,
        geometry: &SurveyGeometry,
        actions: &mut Vec<Action>,
    ) {
        let apply = |command: Command| Action::Apply(Box::new(command));
        ui.horizontal(|ui| {
            if let Some((_, text)) = self.renaming.as_mut().filter(|(name, _)| *name == entry.name) {
                let edit = ui.name_inputs("New name", |ui| ui.add(TextEdit::singleline(text).desired_width(140.0)));
                if ui.small_button("Rename").clicked() || edit.lost_focus() {
                    let to = text.trim().to_owned();
                    if !to.is_empty() && to != entry.name {
                        actions.push(apply(Command::RenameHorizon(RenameHorizon { from: entry.name.clone(), to })));
                    }
                    self.renaming = None;
                }
            } else {
                if ui.small_button("Rename…").clicked() {
                    self.renaming = Some((entry.name.clone(), entry.name.clone()));
                }
                if ui.small_button("Remove").on_hover_text(format!("Remove horizon {}", entry.name)).clicked() {
                    let command = RemoveHorizon { name: entry.name.clone() };
                    actions.push(apply(Command::RemoveHorizon(command)));
                }
            }
        });
        let Some(facts) = facts else { return };
        let report = &facts.report;
        let plural = |count: usize| if count == 1 { "" } else { "s" };
        ui.label(format!(
            "{} nodes on {:.1} % of the traces, {} sheet{}",
            report.nodes,
            100.0 * report.share,
            report.sheets,
            plural(report.sheets)
        ));
        if facts.outdated {
            ui.colored_label(ui.visuals().warn_fg_color, "Its picks are of another extraction.");
            if ui.button("Pick again").on_hover_text("Make the same picks on the present extraction").clicked() {
                let command =
                    crate::command::ReplayPicks { horizon: Some(entry.name.clone()), unfit: Default::default() };
                actions.push(apply(Command::ReplayPicks(command)));
            }
        }
        if let Some(overlap) = &report.overlap {
            ui.colored_label(
                ui.visuals().warn_fg_color,
                format!("Overlaps itself at {} traces, by up to {:.0} samples.", overlap.traces, overlap.apart),
            );
            if ui.small_button("Show the overlap").clicked() {
                go(geometry, overlap.at.map(f64::from), actions);
            }
        }
        for conflict in &facts.conflicts {
            ui.colored_label(ui.visuals().warn_fg_color, format!("Conflict: {conflict}."));
        }
        picks(ui, entry, geometry, actions);
        self.holes(ui, session, entry, facts, actions);
    }

    fn holes(
        &mut self,
        ui: &mut Ui,
        session: &Session,
        entry: &HorizonEntry,
        facts: &ShownHorizon,
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
                if ui.small_button(counted(hole.traces, "trace")).on_hover_text(hint).clicked() {
                    let [x, y] = hole.at.map(|at| at as f64);
                    actions.push(Action::Slices([x, y, session.view.slices[2]]));
                }
            }
            if holes.len() > HOLES {
                ui.weak(format!("and {} smaller", holes.len() - HOLES));
            }
        });
        ui.horizontal(|ui| {
            if ui.button("Fill holes").on_hover_text("With the smoothest surface, never across a fault").clicked() {
                let settings = FillSettings { max_traces: (self.max_traces > 0).then_some(self.max_traces) };
                let command = FillHorizon { name: entry.name.clone(), settings };
                actions.push(Action::Apply(Box::new(Command::FillHorizon(command))));
            }
            let drag = DragValue::new(&mut self.max_traces).range(0..=1_000_000).custom_formatter(|value, _| {
                if value == 0.0 { "of any size".to_owned() } else { format!("up to {value:.0} traces") }
            });
            ui.name_inputs("Largest hole to fill", |ui| ui.add(drag));
        });
    }
}

/// Moves the sections through a place in line numbers.
pub(super) fn go(geometry: &SurveyGeometry, place: [f64; 3], actions: &mut Vec<Action>) {
    actions.push(Action::Slices(voxel_of(geometry, place).to_array()));
}

fn look(ui: &mut Ui, session: &Session, actions: &mut Vec<Action>) {
    let picking = &session.view.picking;
    ui.horizontal_wrapped(|ui| {
        ui.label("Pointer");
        for (tool, name, hint) in [
            (Tool::Pick, "Pick", "Click a reflection: its leaf is selected"),
            (Tool::Lasso, "Lasso", "Draw around what is to be erased (or hold A)"),
        ] {
            if ui.selectable_label(picking.tool == tool, name).on_hover_text(hint).clicked() {
                actions.push(Action::Picking(PickingStep::Use(tool)));
            }
        }
    });
    ui.horizontal_wrapped(|ui| {
        ui.label("Block");
        for (look, name, hint) in [
            (Look::Faces, "Faces", "The faces of the block, with the horizons before them"),
            (Look::SeeThrough, "See through", "Strong reflections in white, shaded by what lies before them (O)"),
        ] {
            if ui.selectable_label(picking.look == look, name).on_hover_text(hint).clicked() {
                actions.push(Action::Picking(PickingStep::Look(look)));
            }
        }
    });
    ui.horizontal_wrapped(|ui| {
        ui.label("Show");
        for (show, name, hint) in [
            (FaceData::Rock, "Amplitudes", "The volume as it is"),
            (FaceData::Leaves, "Leaves", "Candidates, each leaf in a colour of its own"),
            (FaceData::Distance, "Distances", "White on a candidate, darker away from it"),
        ] {
            if ui.selectable_label(picking.show == show, name).on_hover_text(hint).clicked() {
                actions.push(Action::Picking(PickingStep::Show(show)));
            }
        }
    });
}

fn selected(ui: &mut Ui, session: &Session, overlay: &Overlay, geometry: &SurveyGeometry, actions: &mut Vec<Action>) {
    let step = |step| Action::Picking(step);
    let Some(pick) = &session.view.picking.pick else {
        ui.weak("Click a reflection, on a section or on the block.");
        ui.weak("Shift adds to what is selected, Alt takes a leaf out.");
        return;
    };
    let facts = overlay.selected().filter(|shown| shown.pick == *pick);
    let [inline, crossline, z] = pick.at;
    ui.label(format!("inline {inline:.0}, crossline {crossline:.0}, {z:.1} {}", geometry.vertical.unit.symbol()));
    let size = facts.map_or_else(String::new, |shown| format!(", {} triangles", shown.triangles));
    ui.label(format!("level {} of {}{size}", pick.up, pick.levels)).on_hover_text(format!("leaf {}", pick.leaf));
    if let Some(overlap) = facts.filter(|shown| shown.is_wrong).and_then(|shown| shown.overlap.as_ref()) {
        ui.colored_label(
            ui.visuals().warn_fg_color,
            format!("Lies twice over {} traces, up to {:.0} samples apart: descend.", overlap.traces, overlap.apart),
        );
        if ui.small_button("Show where").clicked() {
            go(geometry, overlap.at.map(f64::from), actions);
        }
    }
    ui.horizontal_wrapped(|ui| {
        if ui.add_enabled(pick.up < pick.levels, Button::new("Climb")).on_hover_text("Up arrow").clicked() {
            actions.push(step(PickingStep::Climb(1)));
        }
        if ui.add_enabled(pick.up > 0, Button::new("Descend")).on_hover_text("Down arrow").clicked() {
            actions.push(step(PickingStep::Climb(-1)));
        }
        let hint = "As high as it does not lie twice over a trace (H)";
        if ui.button("Highest valid").on_hover_text(hint).clicked() {
            actions.push(step(PickingStep::HighestValid));
        }
        if ui.button("Add to horizon").on_hover_text("Enter").clicked() {
            actions.push(step(PickingStep::Accept));
        }
        if ui.button("Let go").on_hover_text("Escape").clicked() {
            actions.push(step(PickingStep::GiveUp));
        }
    });
}

/// The colour of a horizon, to be changed where it was assembled here.
fn swatch(ui: &mut Ui, entry: &HorizonEntry, index: usize, actions: &mut Vec<Action>) {
    match &entry.assembly {
        Some(log) => {
            if let Some(colour) = palette(ui, log.colour, &format!("Colour of {}", entry.name)) {
                let command = SetHorizonColour { horizon: entry.name.clone(), colour };
                actions.push(Action::Apply(Box::new(Command::SetHorizonColour(command))));
            }
        }
        None => {
            let (rect, _) = ui.allocate_exact_size(vec2(16.0, 16.0), Sense::hover());
            ui.painter().circle_filled(rect.center(), 6.0, horizon_colour(None, index));
        }
    }
}

/// A button in a colour that offers others.
fn palette(ui: &mut Ui, colour: Colour, name: &str) -> Option<Colour> {
    let paint = |rgb: [u8; 3]| Color32::from_rgb(rgb[0], rgb[1], rgb[2]);
    let mut chosen = None;
    let button = Button::new("").fill(paint(colour.rgb)).min_size(vec2(16.0, 16.0));
    let named = ui.name_inputs(name, |ui| {
        eframe::egui::containers::menu::MenuButton::from_button(button)
            .ui(ui, |ui| {
                Grid::new("colours").num_columns(4).spacing([4.0, 4.0]).show(ui, |ui| {
                    for (n, rgb) in HORIZON_COLOURS.into_iter().chain(MORE_COLOURS).enumerate() {
                        let button = Button::new("").fill(paint(rgb)).stroke(Stroke::NONE).min_size(vec2(26.0, 20.0));
                        if ui.add(button).clicked() {
                            chosen = Some(Colour::new(rgb[0], rgb[1], rgb[2]));
                            ui.close();
                        }
                        if n % 4 == 3 {
                            ui.end_row();
                        }
                    }
                });
            })
            .0
    });
    named.on_hover_text(name);
    chosen
}

/// The picks of a horizon, first to last.
fn picks(ui: &mut Ui, entry: &HorizonEntry, geometry: &SurveyGeometry, actions: &mut Vec<Action>) {
    let Some(log) = &entry.assembly else {
        ui.weak("Imported: it has no picks.");
        return;
    };
    let apply = |command: Command| Action::Apply(Box::new(command));
    let unit = geometry.vertical.unit.symbol();
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
        ui.horizontal(|ui| {
            ui.add_space(16.0);
            let mut button = |ui: &mut Ui, name: &str, hint: &str, can: bool, command: Command| {
                let button = ui.add_enabled(can, Button::new(name).small());
                if button.on_hover_text(format!("{hint} pick {}", pick.id)).clicked() {
                    actions.push(apply(command));
                }
            };
            let to = |to: Move| Command::MovePick(MovePick { id: pick.id, to });
            button(ui, "Up", "Climb with", true, to(Move::Up(1)));
            button(ui, "Down", "Descend with", pick.up > 0, to(Move::Down(1)));
            button(ui, "Highest", "Highest valid for", true, to(Move::HighestValid));
            let only = log.picks.len() == 1;
            button(ui, "Take back", "Take back", !only, Command::RemovePick(RemovePick { id: pick.id }));
        });
    }
}
