//! Horizons drawn by hand and tracked from a click, in a project without candidates.

use super::driven::{Driven, click, document, open, wait};
use super::picking::{click_in, picking};
use eframe::egui::{Event, Key, Modifiers, PointerButton, Pos2, vec2};
use egui_kittest::kittest::Queryable;
use project::document::{Drawn, DrawnEntry};

fn parts(harness: &Driven) -> Vec<DrawnEntry> {
    let entry = document(harness).horizons.into_iter().find(|entry| entry.name == "Horizon 1");
    entry.and_then(|entry| entry.assembly).map_or_else(Vec::new, |log| log.drawn)
}

fn drag(harness: &mut Driven, places: &[Pos2]) {
    let button = |pos: Pos2, pressed| Event::PointerButton {
        pos,
        button: PointerButton::Primary,
        pressed,
        modifiers: Modifiers::default(),
    };
    harness.event(Event::PointerMoved(places[0]));
    harness.event(button(places[0], true));
    harness.run_steps(2);
    for place in places {
        harness.event(Event::PointerMoved(*place));
        harness.run_steps(1);
    }
    harness.event(button(places[places.len() - 1], false));
    harness.run_steps(3);
}

#[test]
fn a_horizon_is_drawn_by_clicks_and_freehand_and_tracked_without_candidates() {
    let folder = tempfile::tempdir().unwrap();
    let mut harness = open(folder.path());
    click(&mut harness, "Interpret");
    click(&mut harness, "Sections");
    harness.run_steps(3);
    click(&mut harness, "Draw");
    click(&mut harness, "On the reflection");
    for (off, count) in [([-40.0, 0.0], 1), ([0.0, 4.0], 2), ([40.0, 0.0], 3), ([60.0, 0.0], 4)] {
        click_in(&mut harness, "Inline section", off, Modifiers::NONE);
        assert_eq!(picking(&harness).line.len(), count);
    }
    harness.key_press(Key::Backspace);
    harness.run_steps(2);
    harness.get_by_label("3 points on the line");
    harness.key_press(Key::Enter);
    wait(&mut harness, "the line is there", |harness| parts(harness).len() == 1);
    let Drawn::Line { points, snap: true } = &parts(&harness)[0].part else { panic!("{:?}", parts(&harness)) };
    assert_eq!(points.len(), 3);

    // A drag draws, and does not move the section.
    let middle = harness.get_by_label("Crossline section").rect().center();
    let places: Vec<Pos2> =
        (0..12).map(|n| middle + vec2(8.0 * n as f32 - 40.0, if n < 6 { 0.0 } else { 6.0 })).collect();
    drag(&mut harness, &places);
    let bends = picking(&harness).line.len();
    assert!((3..=6).contains(&bends), "{bends} points");
    click(&mut harness, "Add line");
    wait(&mut harness, "the second line is there", |harness| parts(harness).len() == 2);

    // One click follows the reflection through the survey.
    click(&mut harness, "Track");
    harness.get_by_label("Traces");
    click_in(&mut harness, "Inline section", [-10.0, 30.0], Modifiers::NONE);
    wait(&mut harness, "it is tracked", |harness| parts(harness).len() == 3);
    wait(&mut harness, "the panel lists it", |harness| harness.query_by_label_contains("tracking 3").is_some());
    harness.query_all_by_label("Take out").next().unwrap().click_accesskit();
    wait(&mut harness, "the first line is taken out", |harness| parts(harness).len() == 2);
    harness.key_press_modifiers(Modifiers::COMMAND, Key::Z);
    wait(&mut harness, "and comes back", |harness| parts(harness).len() == 3);
}
