//! Sharing the block: the page and the model, what is shown of them before, and notes.

use super::command::act;
use super::driven::{Driven, click, document, open, state, wait};
use eframe::egui::{Event, Modifiers, PointerButton};
use egui_kittest::kittest::{NodeT, Queryable};
use state::picking::place_of;
use state::{Action, Dialogue, Place, ShareForm};
use std::fs;
use std::path::Path;

const SEEN: &str = "What a reader will see";

/// Opens the dialogue with small files.
fn ask(harness: &mut Driven, change: impl FnOnce(&mut ShareForm)) {
    click(harness, "Share…");
    let Some(Dialogue::Share(form)) = &state(harness).dialogue else { panic!("no dialogue") };
    let mut form = ShareForm { density: 80.0, sections: 1, ..form.clone() };
    change(&mut form);
    act(harness, Action::Ask(Box::new(Dialogue::Share(form))));
    harness.run_steps(3);
}

fn is_idle(harness: &Driven) -> bool {
    harness.state().as_ref().unwrap().is_settled()
}

fn write_to(harness: &mut Driven, path: &Path) {
    click(harness, "Write the file");
    wait(harness, "it is written", |harness| path.exists() && state(harness).dialogue.is_none());
}

#[test]
fn a_page_and_a_model_are_previewed_and_written() {
    let folder = tempfile::tempdir().unwrap();
    let mut harness = open(folder.path());
    ask(&mut harness, |_| ());
    assert_eq!(harness.query_all_by_label(SEEN).count(), 0);
    click(&mut harness, "Preview");
    wait(&mut harness, "the page is shown", |harness| {
        harness.query_all_by_label(SEEN).count() == 1 && is_idle(harness)
    });
    assert_eq!(harness.query_all_by_label_contains("About ").count(), 1, "its size is told");
    let page = folder.path().join("north.html");
    write_to(&mut harness, &page);
    let text = fs::read_to_string(&page).unwrap();
    assert!(text.ends_with("</html>\n") && text.contains("default-src 'none'"));
    assert!(state(&harness).notices_at(Place::Foot).any(|(_, notice)| notice.text.contains("MB")));
    ask(&mut harness, |_| ());
    click(&mut harness, "Preview");
    wait(&mut harness, "the page is shown", |harness| {
        harness.query_all_by_label(SEEN).count() == 1 && is_idle(harness)
    });
    // The other kind is shown without another order.
    click(&mut harness, "Model for slides");
    wait(&mut harness, "the model is told of", |harness| {
        is_idle(harness) && harness.query_all_by_label_contains("triangles; 99 %").count() == 1
    });
    harness.get_by_label("Most triangles");
    let model = folder.path().join("north.glb");
    write_to(&mut harness, &model);
    assert!(fs::read(&model).unwrap().starts_with(b"glTF"));
}

#[test]
fn notes_are_pointed_at_places_listed_and_removed() {
    let folder = tempfile::tempdir().unwrap();
    let mut harness = open(folder.path());
    ask(&mut harness, |_| ());
    assert!(harness.get_by_label("Add note").accesskit_node().is_disabled(), "it says nothing yet");
    click(&mut harness, "Preview");
    wait(&mut harness, "the page is shown", |harness| {
        harness.query_all_by_label(SEEN).count() == 1 && is_idle(harness)
    });
    // A press on the near side of the block.
    let at = harness.get_by_label(SEEN).rect().center() + eframe::egui::vec2(0.0, 60.0);
    for pressed in [true, false] {
        harness.input_mut().events.push(Event::PointerMoved(at));
        let (button, modifiers) = (PointerButton::Primary, Modifiers::default());
        harness.input_mut().events.push(Event::PointerButton { pos: at, button, pressed, modifiers });
        harness.run_steps(2);
    }
    harness.get_by_label("New note").focus();
    harness.run_steps(2);
    harness.get_by_label("New note").type_text("Gas chimney?");
    harness.run_steps(2);
    click(&mut harness, "Add note");
    wait(&mut harness, "the note is there", |harness| document(harness).notes.len() == 1);
    let note = document(&harness).notes[0].clone();
    assert_eq!((note.text.as_str(), note.scene), ("Gas chimney?", None));
    // Unless a place is pressed, a note points at where the sections meet.
    let session = state(&harness).session.as_ref().unwrap();
    let meet = place_of(session.document.geometry.as_ref().unwrap(), session.view.slices.into());
    assert!(note.at != meet && note.at[2] > 0.0 && note.at[2] < 124.0, "{:?} {meet:?}", note.at);
    harness.get_by_label("1. Gas chimney?");
    assert!(harness.get_by_label("Add note").accesskit_node().is_disabled(), "the next one is empty");
    // The preview stays: a note changes nothing on the block.
    assert_eq!(harness.query_all_by_label(SEEN).count(), 1);
    click(&mut harness, "Remove note 1");
    wait(&mut harness, "the note is gone", |harness| document(harness).notes.is_empty());
    assert!(matches!(state(&harness).dialogue, Some(Dialogue::Share(_))));
}

#[test]
fn what_cannot_be_written_is_said_in_the_dialogue_and_a_stop_leaves_nothing() {
    let folder = tempfile::tempdir().unwrap();
    let mut harness = open(folder.path());
    ask(&mut harness, |form| form.page = "north.pdf".to_owned());
    harness.get_by_label("The file's name must end in .html");
    assert!(harness.get_by_label("Write the file").accesskit_node().is_disabled());
    let inside = folder.path().join("north.petro/a.html");
    let Some(Dialogue::Share(form)) = &state(&harness).dialogue else { panic!("no dialogue") };
    let form = ShareForm { page: inside.display().to_string(), ..form.clone() };
    act(&mut harness, Action::Ask(Box::new(Dialogue::Share(form.clone()))));
    harness.run_steps(3);
    click(&mut harness, "Write the file");
    wait(&mut harness, "the failure is told", |harness| state(harness).notices_at(Place::Dialogue).count() == 1);
    assert!(matches!(state(&harness).dialogue, Some(Dialogue::Share(_))), "it stays");
    assert!(!inside.exists());
    let page = folder.path().join("slow.html");
    let form = ShareForm { page: page.display().to_string(), density: 4096.0, sections: 40, ..form };
    act(&mut harness, Action::Ask(Box::new(Dialogue::Share(form))));
    harness.run_steps(3);
    click(&mut harness, "Write the file");
    wait(&mut harness, "it is under way", |harness| harness.query_all_by_label("Stop").count() > 0);
    harness.query_all_by_label("Stop").last().unwrap().click_accesskit();
    wait(&mut harness, "it is stopped", is_idle);
    assert!(matches!(state(&harness).dialogue, Some(Dialogue::Share(_))), "it stays");
    let left: Vec<_> = fs::read_dir(folder.path()).unwrap().map(|entry| entry.unwrap().file_name()).collect();
    assert!(!left.iter().any(|name| name.to_string_lossy().contains("slow")), "{left:?}");
}
