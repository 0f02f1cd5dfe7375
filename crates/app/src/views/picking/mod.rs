//! The panel for interpreting: candidates, the selection, horizons with their picks, faults.

mod drawing;
mod faults;
mod horizons;
mod palette;

pub(super) use faults::in_words;
pub(super) use horizons::swatch;
pub(super) use palette::palette;

use super::candidates::CandidatesPanel;
use super::{notices, overlay::Overlay};
use crate::state::picking::voxel_of;
use crate::state::{Action, Look, PickingStep, Place, Session, State, Tool};
use crate::widgets::obstacle::{needs, unless};
use crate::work::RunningLine;
use eframe::egui::{Align, Button, Layout, ScrollArea, Ui, vec2};
use faults::FaultsPanel;
use horizons::HorizonList;
use render::FaceData;
use std::sync::Arc;
use survey::SurveyGeometry;

/// The panel, with the text being typed in it.
#[derive(Default)]
pub(crate) struct PickingPanel {
    candidates: CandidatesPanel,
    horizons: HorizonList,
    faults: FaultsPanel,
    /// Whether sticks were being drawn, and the number of proposed faults, in the previous frame.
    open: (bool, usize),
}

impl PickingPanel {
    /// Shows the panel.
    pub(crate) fn show(
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
            self.horizons.show(ui, session, shown, geometry, actions);
            ui.add_space(8.0);
            ui.heading("Faults");
            let faults = ui.scope(|ui| self.faults.show(ui, session, shown, running, geometry, actions)).response;
            // Scroll to the faults when drawing begins or proposals arrive.
            let open = (session.view.picking.tool == Tool::Sticks, shown.map_or(0, |shown| shown.proposals.len()));
            if open != self.open && (open.0 || open.1 > 0) {
                ui.scroll_to_rect(faults.rect, None);
            }
            self.open = open;
        });
    }
}

/// Moves the sections through a place given by line numbers and vertical value.
pub(super) fn go(geometry: &SurveyGeometry, place: [f64; 3], actions: &mut Vec<Action>) {
    actions.push(Action::Slices(voxel_of(geometry, place).to_array()));
}

/// Width of the column of labels in front of tools, points.
const TOOLS: f32 = 52.0;

/// Tools behind a label, in one column on all their lines.
fn tools(ui: &mut Ui, name: &str, content: impl FnOnce(&mut Ui)) {
    ui.horizontal_top(|ui| {
        let size = vec2(TOOLS, ui.spacing().interact_size.y);
        ui.allocate_ui_with_layout(size, Layout::left_to_right(Align::Center), |ui| {
            ui.set_min_width(TOOLS);
            ui.label(name);
        });
        ui.horizontal_wrapped(content);
    });
}

fn look(ui: &mut Ui, session: &Session, actions: &mut Vec<Action>) {
    let picking = &session.view.picking;
    tools(ui, "Pointer", |ui| {
        for (tool, name, hint) in [
            (Tool::Pick, "Pick", "Click a reflection: its leaf is selected"),
            (Tool::Lasso, "Lasso", "Drag around what is to be erased (or hold A and drag)"),
            (
                Tool::Time,
                "One click",
                "Click a reflection: the horizon of its geologic time, over the whole survey; a second click corrects it",
            ),
            (
                Tool::Draw,
                "Draw",
                "Click along a reflection on a section, or drag: a line of the horizon, by hand; Enter adds it (M)",
            ),
            (Tool::Track, "Track", "Click a reflection: it is followed from there, also without candidates (U)"),
            (
                Tool::Faults,
                "Faults",
                "Click a fault on a section, found or drawn: Enter accepts it, Delete dismisses it, Alt and a click cuts it, \
                 Shift and a click chooses several (Shift F)",
            ),
        ] {
            let can = tool != Tool::Time || session.document.geologic_time().is_some();
            let label = Button::selectable(picking.tool == tool, name);
            let button = unless(ui, needs(can, "Needs geologic time: compute it under Candidates"), label);
            if button.on_hover_text(hint).clicked() {
                actions.push(Action::Picking(PickingStep::Use(tool)));
            }
        }
    });
    drawing::show(ui, session, actions);
    tools(ui, "Block", |ui| {
        for (look, name, hint) in [
            (Look::Faces, "Faces", "The faces of the block, with the horizons in front of them"),
            (Look::VolumeRendering, "Volume rendering", "Strong reflections in white, shaded by occlusion (O)"),
        ] {
            if ui.selectable_label(picking.look == look, name).on_hover_text(hint).clicked() {
                actions.push(Action::Picking(PickingStep::Look(look)));
            }
        }
    });
    tools(ui, "Show", |ui| {
        for (show, name, hint) in [
            (FaceData::Rock, "Amplitudes", "The volume as it is"),
            (FaceData::Leaves, "Candidate pieces", "Each piece (leaf) of the candidates in a colour of its own"),
            (FaceData::Distance, "Distance to candidates", "White on a candidate, darker away from it"),
        ] {
            if ui.selectable_label(picking.show == show, name).on_hover_text(hint).clicked() {
                actions.push(Action::Picking(PickingStep::Show(show)));
            }
        }
    });
}

/// Why a leaf cannot be descended.
const AT_LEAF: &str =
    "This is a leaf, the smallest piece: take it out with Alt and a click, or extract with smaller leaves";

/// What helps against an overlap, so many levels above the leaf.
fn way_out(up: u32) -> &'static str {
    if up > 0 { "descend" } else { "deselect it, or draw the fault between both parts; a leaf cannot be descended" }
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
            format!(
                "Overlaps at {} traces, by up to {:.0} samples: {}.",
                overlap.traces,
                overlap.apart,
                way_out(pick.up)
            ),
        );
        if ui.button("Show where").clicked() {
            go(geometry, overlap.at, actions);
        }
    }
    ui.horizontal_wrapped(|ui| {
        let top = needs(pick.up < pick.levels, "This is the whole surface: there is nothing above it");
        if unless(ui, top, Button::new("Climb")).on_hover_text("Up arrow").clicked() {
            actions.push(step(PickingStep::Climb(1)));
        }
        if unless(ui, needs(pick.up > 0, AT_LEAF), Button::new("Descend")).on_hover_text("Down arrow").clicked() {
            actions.push(step(PickingStep::Climb(-1)));
        }
        let hint = "Climb to the highest node that is a single sheet (H)";
        if ui.button("Highest valid").on_hover_text(hint).clicked() {
            actions.push(step(PickingStep::HighestValid));
        }
        if ui.button("Add to horizon").on_hover_text("Enter").clicked() {
            actions.push(step(PickingStep::Accept));
        }
        if ui.button("Deselect").on_hover_text("Escape").clicked() {
            actions.push(step(PickingStep::GiveUp));
        }
    });
}
