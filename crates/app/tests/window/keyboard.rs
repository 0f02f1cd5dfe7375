//! The keyboard: fields take it when they open, Enter and Escape do in every dialogue what they do in the others, and a
//! dialogue that fails stays and says why.

use super::driven::{Driven, click, document, driven, open, project, state, wait};
use super::picking::{act, interpreting, on_a_trough, picking};
use eframe::egui::{Event, Key, Modifiers, ViewportCommand};
use egui_kittest::kittest::Queryable;
use state::{Action, Choice, Dialogue, How, Panel, PickingStep};
use std::cell::RefCell;

fn type_text(harness: &mut Driven, text: &str) {
    // As a keyboard does it: each letter is a key and a text.
    for letter in text.chars() {
        let key = Key::from_name(&letter.to_uppercase().to_string()).unwrap();
        for pressed in [true, false] {
            let modifiers = Modifiers::default();
            harness.event(Event::Key { key, physical_key: None, pressed, repeat: false, modifiers });
            if pressed {
                harness.event(Event::Text(letter.to_string()));
            }
        }
    }
    harness.run_steps(3);
}

fn press(harness: &mut Driven, key: Key) {
    harness.key_press(key);
    harness.run_steps(3);
}

fn asks(harness: &Driven) -> bool {
    state(harness).dialogue.is_some()
}

#[test]
fn a_name_typed_after_rename_runs_no_shortcut() {
    let folder = tempfile::tempdir().unwrap();
    let mut harness = interpreting(folder.path());
    act(&mut harness, PickingStep::At(on_a_trough(), How::Replace));
    wait(&mut harness, "a leaf is selected", |harness| picking(harness).pick.is_some());
    press(&mut harness, Key::Enter);
    wait(&mut harness, "the horizon is there", |harness| document(harness).horizons.len() == 3);
    wait(&mut harness, "it is described", |harness| harness.query_by_label_contains("nodes on").is_some());
    let before = state(&harness).session.as_ref().unwrap().view.clone();
    click(&mut harness, "Rename…");
    type_text(&mut harness, "ochlwsvb");
    let after = state(&harness).session.as_ref().unwrap().view.clone();
    assert_eq!((after.panel, after.layout, after.compare), (before.panel, before.layout, before.compare));
    assert_eq!(after.picking.look, before.picking.look);
    // Escape keeps the old name, and deselects nothing.
    press(&mut harness, Key::Escape);
    assert!(harness.query_by_label("New name").is_none());
    assert!(document(&harness).horizons.iter().any(|entry| entry.name == "Horizon 1"));
    click(&mut harness, "Rename…");
    type_text(&mut harness, "b");
    press(&mut harness, Key::Enter);
    wait(&mut harness, "it has the new name", |harness| {
        document(harness).horizons.iter().any(|entry| entry.name == "Horizon 1b")
    });
}

#[test]
fn enter_and_escape_answer_every_dialogue() {
    let folder = tempfile::tempdir().unwrap();
    let mut harness = open(folder.path());
    for dialogue in [Dialogue::Shortcuts, Dialogue::Choose(Choice::Project), Dialogue::Choose(Choice::Texture)] {
        harness.state_mut().as_mut().unwrap().act(Action::Ask(Box::new(dialogue)));
        harness.run_steps(3);
        press(&mut harness, Key::Escape);
        assert!(!asks(&harness));
    }
    click(&mut harness, "Interpret");
    harness.event(Event::Text("?".into()));
    harness.run_steps(3);
    // No shortcut acts behind the page.
    press(&mut harness, Key::P);
    assert_eq!(state(&harness).session.as_ref().unwrap().view.panel, Panel::Interpret);
    press(&mut harness, Key::Enter);
    assert!(!asks(&harness));
}

#[test]
fn a_project_that_cannot_be_opened_is_told_in_the_chooser() {
    let folder = tempfile::tempdir().unwrap();
    let root = project(folder.path());
    let other = folder.path().join("gone.petro");
    let mut harness = driven(folder.path(), Some(root.clone()));
    wait(&mut harness, "the project is open", |harness| state(harness).session.is_some());
    harness.state_mut().as_mut().unwrap().act(Action::Ask(Box::new(Dialogue::Choose(Choice::Project))));
    harness.run_steps(3);
    harness.get_by_label("Path").focus();
    harness.step();
    harness.key_press_modifiers(Modifiers::COMMAND, Key::A);
    harness.event(Event::Text(other.display().to_string()));
    harness.run_steps(2);
    press(&mut harness, Key::Enter);
    wait(&mut harness, "the failure is told", |harness| {
        harness.query_by_label_contains("There is no project").is_some()
    });
    assert!(asks(&harness));
    assert_eq!(state(&harness).session.as_ref().unwrap().root, root);
}

#[test]
fn the_title_names_the_project_and_its_view_comes_back_when_it_is_opened_again() {
    let folder = tempfile::tempdir().unwrap();
    let root = project(folder.path());
    let mut harness = driven(folder.path(), Some(root.clone()));
    let titles = |harness: &Driven| -> Vec<String> {
        let commands = harness.output().viewport_output.values().flat_map(|viewport| viewport.commands.iter());
        let title = |command: &ViewportCommand| match command {
            ViewportCommand::Title(title) => Some(title.clone()),
            _ => None,
        };
        commands.filter_map(title).collect()
    };
    wait(&mut harness, "the project is open", |harness| state(harness).session.is_some());
    harness.state_mut().as_mut().unwrap().act(Action::Close);
    harness.step();
    assert_eq!(titles(&harness), ["Petroglyph"]);
    harness.state_mut().as_mut().unwrap().act(Action::Open(root.clone()));
    let seen = RefCell::new(Vec::new());
    wait(&mut harness, "the project is open", |harness| {
        seen.borrow_mut().extend(titles(harness));
        state(harness).session.is_some()
    });
    assert_eq!(seen.into_inner(), ["north – Petroglyph"]);
    // Closed and opened again, it is shown as it was left.
    press(&mut harness, Key::D);
    press(&mut harness, Key::T);
    harness.state_mut().as_mut().unwrap().act(Action::Close);
    harness.run_steps(2);
    harness.state_mut().as_mut().unwrap().act(Action::Open(root));
    wait(&mut harness, "the project is open again", |harness| state(harness).session.is_some());
    let view = &state(&harness).session.as_ref().unwrap().view;
    assert_eq!((view.panel, view.scene.camera.elevation_deg), (Panel::Data, 90.0));
}
