//! The start page: go on, open, begin.

use super::notices;
use crate::app::state::{Action, Choice, Dialogue, Place, State};
use crate::app::theme;
use crate::app::work::folder::Presence;
use eframe::egui::{Align, Button, Layout, RichText, ScrollArea, Ui, Vec2};
use std::path::Path;

/// Width of the column in the middle.
const WIDTH: f32 = 660.0;
/// Height of a button that begins something.
const TALL: f32 = 42.0;

/// Shows the page.
pub fn show(ui: &mut Ui, state: &State, present: &mut Presence, is_busy: bool, actions: &mut Vec<Action>) {
    ScrollArea::vertical().show(ui, |ui| {
        ui.vertical_centered(|ui| {
            ui.set_max_width(WIDTH.min(ui.available_width()));
            ui.with_layout(Layout::top_down(Align::Min), |ui| page(ui, state, present, is_busy, actions));
        });
    });
}

fn page(ui: &mut Ui, state: &State, present: &mut Presence, is_busy: bool, actions: &mut Vec<Action>) {
    ui.add_space((ui.ctx().content_rect().height() * 0.09).min(90.0));
    ui.label(RichText::new("Petroglyph").size(40.0).color(theme::accent(ui.visuals())));
    ui.label("From a seismic volume to a geological illustration");
    ui.add_space(22.0);
    notices::show(ui, state, Place::Start, actions);
    if let Some(left) = &state.remembered.left {
        recovery(ui, &left.root, is_busy, actions);
    }
    ui.add_enabled_ui(!is_busy, |ui| {
        let width = (ui.available_width() - 2.0 * ui.spacing().item_spacing.x) / 3.0;
        let begin = |ui: &mut Ui, name: &str, hint: &str, choice: Choice, actions: &mut Vec<Action>| {
            let button = Button::new(RichText::new(name).size(16.0)).min_size(Vec2::new(width, TALL));
            if ui.add(button).on_hover_text(hint).clicked() {
                actions.push(Action::Ask(Box::new(Dialogue::Choose(choice))));
            }
        };
        ui.horizontal(|ui| {
            begin(ui, "New from SEG-Y…", "Read a seismic volume into a new project", Choice::NewSurvey, actions);
            begin(ui, "Open project…", "Open a folder NAME.petro", Choice::Project, actions);
            let hint = "Makes a synthetic survey with its interpretation, to try everything on";
            begin(ui, "Try the demonstration…", hint, Choice::Demo, actions);
        });
    });
    ui.add_space(20.0);
    recent(ui, state, present, is_busy, actions);
}

fn recovery(ui: &mut Ui, root: &Path, is_busy: bool, actions: &mut Vec<Action>) {
    ui.group(|ui| {
        ui.set_width(ui.available_width());
        ui.strong(format!("{} was still open when Petroglyph ended", name(root)));
        ui.label("Every change to it had been saved. Go on with the same view?");
        ui.horizontal(|ui| {
            if ui.add_enabled(!is_busy, Button::new("Go on")).clicked() {
                actions.push(Action::Recover);
            }
            if ui.button("Not now").clicked() {
                actions.push(Action::Abandon);
            }
        });
    });
    ui.add_space(10.0);
}

fn recent(ui: &mut Ui, state: &State, present: &mut Presence, is_busy: bool, actions: &mut Vec<Action>) {
    ui.heading("Recent projects");
    if state.remembered.recent.is_empty() {
        ui.weak("Projects you open will be listed here.");
    }
    let present = present.of(ui.ctx(), &state.remembered.recent);
    for (root, there) in state.remembered.recent.iter().zip(present) {
        ui.horizontal(|ui| {
            let title = RichText::new(name(root)).size(16.0);
            let open = ui.add_enabled(there && !is_busy, Button::new(title).frame(false));
            let open = open.on_hover_text("Open this project").on_disabled_hover_text("It is not there any more");
            if open.clicked() {
                actions.push(Action::Open(root.clone()));
            }
            ui.weak(root.parent().map_or_else(String::new, |parent| parent.display().to_string()));
            ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
                let forget = ui.small_button("Forget").on_hover_text(format!("Take {} off this list", name(root)));
                if forget.clicked() {
                    actions.push(Action::Forget(root.clone()));
                }
            });
        });
    }
}

/// What a project is called.
fn name(root: &Path) -> String {
    root.file_stem().map_or_else(|| root.display().to_string(), |stem| stem.to_string_lossy().into_owned())
}
