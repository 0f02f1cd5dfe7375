//! Presenting scenes, and how sections are shown, by labels and keys.

use super::command::{act, click_last};
use super::driven::{Driven, click, open, state, wait};
use super::picking::{interpreting, on_a_trough};
use eframe::egui::{Event, Key, Vec2, ViewportCommand};
use egui_kittest::kittest::{NodeT, Queryable};
use project::command::{AddScene, Command};
use render::Scene;
use state::Action;

fn shown(harness: &Driven) -> Scene {
    state(harness).session.as_ref().unwrap().view.scene.clone()
}

/// What the next frames ask for: the whole screen, or not.
fn full_screen(harness: &mut Driven) -> Vec<bool> {
    let mut asked = Vec::new();
    for _ in 0..4 {
        harness.step();
        let commands = harness.output().viewport_output.values().flat_map(|viewport| &viewport.commands);
        asked.extend(commands.filter_map(|command| match command {
            ViewportCommand::Fullscreen(is_full) => Some(*is_full),
            _ => None,
        }));
    }
    asked
}

#[test]
fn scenes_are_presented_by_keys_and_escape_leads_back() {
    let folder = tempfile::tempdir().unwrap();
    let mut harness = open(folder.path());
    let present = harness.get_by_label("Present");
    assert!(present.accesskit_node().is_disabled(), "there is no scene");
    let before = shown(&harness);
    for (name, exaggeration) in [("one", 2.0), ("two", 3.0)] {
        let scene = Scene { exaggeration, ..before.clone() };
        act(&mut harness, Action::Apply(Box::new(Command::AddScene(AddScene { name: name.into(), scene }))));
        wait(&mut harness, "the scene is kept", |harness| harness.query_by_label(name).is_some());
    }
    harness.key_press(Key::F5);
    assert_eq!(full_screen(&mut harness), [true], "the window fills the screen");
    assert_eq!(shown(&harness).exaggeration, 2.0);
    assert!(harness.query_by_label("Layers").is_none(), "nothing but scenes is shown");
    harness.get_by_label("Scene one");
    harness.key_press(Key::ArrowRight);
    harness.run_steps(3);
    assert_eq!(shown(&harness).exaggeration, 3.0);
    // There is none after the last.
    harness.key_press(Key::Space);
    harness.run_steps(3);
    assert_eq!(shown(&harness).exaggeration, 3.0);
    harness.key_press(Key::ArrowLeft);
    harness.run_steps(3);
    assert_eq!(shown(&harness).exaggeration, 2.0);
    click_last(&mut harness, "Scene two");
    assert_eq!(shown(&harness).exaggeration, 3.0);
    // By buttons too, which end where the scenes do.
    assert!(harness.get_by_label("Next").accesskit_node().is_disabled());
    click(&mut harness, "Previous");
    assert_eq!(shown(&harness).exaggeration, 2.0);
    assert!(harness.get_by_label("Previous").accesskit_node().is_disabled());
    harness.key_press(Key::Escape);
    assert_eq!(full_screen(&mut harness), [false]);
    assert_eq!(shown(&harness), before);
    harness.get_by_label("Layers");
}

/// Proportions are those of all sections; a view that is filled again is as before.
#[test]
fn sections_have_the_proportions_that_are_chosen() {
    let folder = tempfile::tempdir().unwrap();
    let mut harness = open(folder.path());
    click(&mut harness, "Sections");
    let chosen = |harness: &Driven| state(harness).session.as_ref().unwrap().view.proportions;
    assert_eq!(harness.query_all_by_label("Fill").count(), 3);
    harness.query_all_by_label("Fill").next().unwrap().click_accesskit();
    harness.run_steps(3);
    click_last(&mut harness, "5 : 1");
    assert_eq!(chosen(&harness), Some(5.0));
    assert_eq!(harness.query_all_by_label("5 : 1").count(), 3);
    act(&mut harness, Action::Proportions(None));
    assert_eq!(harness.query_all_by_label("Fill").count(), 3);
}

#[test]
fn the_foot_says_what_a_click_would_select() {
    let folder = tempfile::tempdir().unwrap();
    let mut harness = interpreting(folder.path());
    click(&mut harness, "Sections");
    act(&mut harness, Action::Slices(on_a_trough().to_array()));
    let says = |harness: &Driven, words: &str| harness.query_by_label_contains(words).is_some();
    wait(&mut harness, "the section is there", |harness| harness.query_by_label("Inline section").is_some());
    let rect = harness.get_by_label("Inline section").rect();
    harness.event(Event::PointerMoved(rect.center() + Vec2::new(10.0, 5.0)));
    wait(&mut harness, "it is said", |harness| {
        says(harness, "a click selects leaf") || says(harness, "no leaf is near")
    });
}
