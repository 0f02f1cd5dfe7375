//! The toolbar at the top: project menu, undo and redo, views, comparison of raw and illustrated, export.

use crate::state::{
    Action, Appearance, Choice, Compare, Dialogue, ExportForm, Layout as Arrangement, Panel, Session, ShareForm, State,
};
use crate::widgets::obstacle::{needs, unless};
use crate::widgets::percent;
use eframe::egui::{Align, Button, Label, Layout, RichText, Ui};
use page::FileFormat;
use render::Scene;

/// Width of everything but the project's name and the comparison, points.
const OTHERS: f32 = 680.0;
/// Width of the button that shares the block beyond the others; without room for it, it is in the menu alone.
const SHARE: f32 = 62.0;
/// Width of the comparison, points.
const COMPARISON: f32 = 440.0;
/// Width of the menu that the comparison folds into, points.
const MENU: f32 = 110.0;
/// Smallest and largest width of the project's name, points.
const NAME: [f32; 2] = [60.0, 280.0];

/// Shows the toolbar.
pub fn show(ui: &mut Ui, state: &State, session: &Session, actions: &mut Vec<Action>) {
    // Interpreting is done on the raw volume: there is nothing to compare it with.
    let compares = session.view.panel != Panel::Interpret;
    let folds = ui.available_width() < OTHERS + NAME[0] + COMPARISON;
    let comparison_room = match (compares, folds) {
        (false, _) => 0.0,
        (true, false) => COMPARISON,
        (true, true) => MENU,
    };
    let has_share = ui.available_width() >= OTHERS + SHARE + NAME[0] + comparison_room;
    let share_room = if has_share { SHARE } else { 0.0 };
    let name_room = (ui.available_width() - OTHERS - share_room - comparison_room).clamp(NAME[0], NAME[1]);
    ui.horizontal(|ui| {
        menu(ui, state, session, actions);
        ui.scope(|ui| {
            ui.set_max_width(name_room);
            let name = Label::new(RichText::new(session.name()).strong().size(16.0)).truncate();
            ui.add(name).on_hover_text(session.root.display().to_string());
        });
        ui.separator();
        history(ui, session, actions);
        ui.separator();
        for (layout, name, hint) in [
            (Arrangement::Block, "Block", "The block alone (1)"),
            (Arrangement::Sections, "Sections", "The block and three sections through one point (2)"),
            (Arrangement::Map, "Map", "A horizon as a map with contours (3)"),
            (Arrangement::Fence, "Fence", "A section along a line drawn on the slice (4)"),
        ] {
            if ui.selectable_label(session.view.layout == layout, name).on_hover_text(hint).clicked() {
                actions.push(Action::Arrange(layout));
            }
        }
        if compares {
            ui.separator();
            if folds {
                ui.menu_button("Compare", |ui| comparison(ui, session, actions));
            } else {
                comparison(ui, session, actions);
            }
        }
        ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
            if ui.button("?").on_hover_text("Shortcuts (?)").clicked() {
                actions.push(Action::Ask(Box::new(Dialogue::Shortcuts)));
            }
            let nothing = needs(session.is_drawable(), NOTHING);
            if unless(ui, nothing, Button::new("Copy")).on_hover_text("Copy the picture (Ctrl Shift C)").clicked() {
                actions.push(Action::Copy);
            }
            let form = ExportForm::new(session.root.with_extension(FileFormat::usual().ending()).display().to_string());
            let export = unless(ui, nothing, Button::new("Export…")).on_hover_text("Export the picture (Ctrl E)");
            if export.clicked() {
                actions.push(Action::Ask(Box::new(Dialogue::Export(form))));
            }
            if has_share {
                let share = unless(ui, nothing, Button::new("Share…"));
                if share.on_hover_text("A page for browsers, or a model for slides").clicked() {
                    actions.push(Action::Ask(Box::new(Dialogue::Share(ShareForm::new(&session.root)))));
                }
            }
        });
    });
}

/// Why there is no picture.
const NOTHING: &str = "There is nothing to draw yet: add a volume or a horizon";

fn menu(ui: &mut Ui, state: &State, session: &Session, actions: &mut Vec<Action>) {
    ui.menu_button("Project", |ui| {
        let ask = |choice: Choice| Action::Ask(Box::new(Dialogue::Choose(choice)));
        let has_frame = session.document.geometry.is_some();
        for (name, action, can) in [
            ("Open…", ask(Choice::Project), true),
            ("New from SEG-Y…", ask(Choice::NewSurvey), true),
            ("Add a volume…", ask(Choice::MoreSurvey), true),
            ("Add a horizon…", ask(Choice::Horizon), has_frame),
            ("Add a fault…", ask(Choice::Fault), has_frame),
            ("Add a well…", ask(Choice::Well), has_frame),
            ("Add a tile…", ask(Choice::Texture), true),
            ("Close", Action::Close, true),
        ] {
            if unless(ui, needs(can, super::data::NO_SURVEY), Button::new(name)).clicked() {
                actions.push(action);
                ui.close();
            }
        }
        let nothing = needs(session.is_drawable(), NOTHING);
        if unless(ui, nothing, Button::new("Share…")).clicked() {
            actions.push(Action::Ask(Box::new(Dialogue::Share(ShareForm::new(&session.root)))));
            ui.close();
        }
        ui.separator();
        let appearance = state.remembered.appearance;
        for choice in [Appearance::System, Appearance::Light, Appearance::Dark] {
            if ui.radio(appearance == choice, format!("{} appearance", choice.name())).clicked() {
                actions.push(Action::Appear(choice));
            }
        }
        ui.separator();
        let scale = state.remembered.scale.unwrap_or(1.0);
        for (name, factor) in [("Larger", 1.1), ("Smaller", 1.0 / 1.1)] {
            if ui.button(name).clicked() {
                actions.push(Action::Scale(scale * factor));
            }
        }
    });
}

fn history(ui: &mut Ui, session: &Session, actions: &mut Vec<Action>) {
    for (name, what, keys, action) in [
        ("Undo", session.undoable(), "Ctrl Z", Action::Undo),
        ("Redo", session.redoable(), "Ctrl Shift Z", Action::Redo),
    ] {
        let hint = what.map_or_else(String::new, |what| format!("{name}: {what} ({keys})"));
        let nothing = format!("Nothing to {}", name.to_lowercase());
        let button = unless(ui, needs(what.is_some(), &nothing), Button::new(name)).on_hover_text(hint);
        if button.clicked() {
            actions.push(action);
        }
    }
}

fn comparison(ui: &mut Ui, session: &Session, actions: &mut Vec<Action>) {
    let document = &session.document;
    let both = !document.horizons.is_empty() && !document.volumes.is_empty();
    ui.add_enabled_ui(both, |ui| {
        for (compare, name, hint) in [
            (Compare::Blend, "Blend", "One picture, blended from illustrated to raw"),
            (Compare::SideBySide, "Side by side", "Illustrated and raw beside each other"),
            (Compare::Wipe, "Wipe", "Illustrated over raw, divided by a line to drag"),
        ] {
            let label = ui.selectable_label(session.view.compare == compare, name).on_hover_text(hint);
            if label.clicked() {
                actions.push(Action::Compare(compare));
            }
        }
        if session.view.compare == Compare::Blend {
            let mut blend = session.view.scene.blend;
            let name = ui.weak("to raw");
            ui.spacing_mut().slider_width = 62.0;
            let slider = ui.add(percent::slider(&mut blend));
            if slider.labelled_by(name.id).on_hover_text("0 % is illustrated, 100 % is raw").changed() {
                actions.push(Action::Show(Box::new(Scene { blend, ..session.view.scene.clone() })));
            }
        }
    })
    .response
    .on_disabled_hover_text("Needs a volume and horizons");
}
