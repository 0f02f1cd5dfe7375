//! What the hand does while a frame is slow: several events arrive at once, and each counts where and when it was made.

use super::driven::{Driven, click, open, state};
use super::picking::{act, interpreting, picking};
use eframe::egui::{
    Event, Key, Modifiers, MouseWheelSource, MouseWheelUnit, PointerButton, Pos2, Role, TouchPhase, vec2,
};
use egui_kittest::kittest::Queryable;
use state::{Dialogue, PickingStep, Tool};

fn button(pos: Pos2, pressed: bool) -> Event {
    Event::PointerButton { pos, button: PointerButton::Primary, pressed, modifiers: Modifiers::default() }
}

fn clicked(at: Pos2) -> Vec<Event> {
    vec![Event::PointerMoved(at), button(at, true), button(at, false)]
}

/// All events in one frame, as after a slow one.
fn at_once(harness: &mut Driven, events: impl IntoIterator<Item = Event>) {
    harness.input_mut().events.extend(events);
    harness.run_steps(12);
}

#[test]
fn a_click_counts_where_it_was_made_although_the_pointer_has_gone_on() {
    let folder = tempfile::tempdir().unwrap();
    let mut harness = open(folder.path());
    click(&mut harness, "Sections");
    harness.run_steps(3);
    let slices = |harness: &Driven| state(harness).session.as_ref().unwrap().view.slices;
    let middle = harness.get_by_label("Inline section").rect().center();
    let [near, far] = [middle - vec2(60.0, 20.0), middle + vec2(90.0, 40.0)];
    at_once(&mut harness, clicked(near));
    let expected = slices(&harness);
    at_once(&mut harness, clicked(far));
    assert_ne!(slices(&harness), expected);
    at_once(&mut harness, [clicked(near), vec![Event::PointerMoved(far)]].concat());
    assert_eq!(slices(&harness), expected);
    // A button is not pressed by a click that was made elsewhere.
    let next = harness.query_all_by_label("›").next().unwrap().rect().center();
    let before = expected;
    at_once(&mut harness, [clicked(near), vec![Event::PointerMoved(next)]].concat());
    assert_eq!(slices(&harness), before);
    // Each of two clicks counts.
    at_once(&mut harness, [clicked(next), clicked(next)].concat());
    let moved: f64 = slices(&harness).iter().zip(before).map(|(now, before)| now - before).sum();
    assert_eq!(moved, 2.0);
}

#[test]
fn words_around_a_tab_stay_in_their_fields() {
    let folder = tempfile::tempdir().unwrap();
    let mut harness = open(folder.path());
    click(&mut harness, "Export…");
    harness.run_steps(3);
    harness.get_by_label("Title").focus();
    harness.run_steps(2);
    let text = |words: &str| Event::Text(words.to_owned());
    let tab = |pressed| Event::Key {
        key: Key::Tab,
        physical_key: None,
        pressed,
        repeat: false,
        modifiers: Modifiers::default(),
    };
    at_once(&mut harness, [text("Top"), text(" Chalk"), tab(true), tab(false), text("in depth")]);
    let Some(Dialogue::Export(form)) = &state(&harness).dialogue else { panic!("the dialogue is open") };
    assert_eq!((form.title.as_str(), form.caption.as_str()), ("Top Chalk", "in depth"));
}

#[test]
fn points_of_a_stick_are_where_they_were_clicked_and_enter_ends_it_after_them() {
    let folder = tempfile::tempdir().unwrap();
    let mut harness = interpreting(folder.path());
    click(&mut harness, "Sections");
    act(&mut harness, PickingStep::Use(Tool::Sticks));
    let middle = harness.get_by_label("Inline section").rect().center();
    let places = [vec2(-40.0, -30.0), vec2(0.0, 0.0), vec2(30.0, 35.0)].map(|off| middle + off);
    let key = |pressed| Event::Key {
        key: Key::Enter,
        physical_key: None,
        pressed,
        repeat: false,
        modifiers: Modifiers::default(),
    };
    let events: Vec<Event> = places.into_iter().flat_map(clicked).chain([key(true), key(false)]).collect();
    at_once(&mut harness, events);
    let sticks = picking(&harness).sticks.clone();
    assert_eq!((sticks.len(), sticks[0].len()), (1, 3));
    assert!(sticks[0].windows(2).all(|pair| pair[0][2] < pair[1][2]), "{sticks:?}");
}

/// A point of a stick follows the hand; the section stays where it is.
#[test]
fn a_point_of_a_stick_is_dragged() {
    let folder = tempfile::tempdir().unwrap();
    let mut harness = interpreting(folder.path());
    click(&mut harness, "Sections");
    act(&mut harness, PickingStep::Use(Tool::Sticks));
    let middle = harness.get_by_label("Inline section").rect().center();
    let places = [vec2(-40.0, -30.0), vec2(0.0, 0.0)].map(|off| middle + off);
    at_once(&mut harness, places.into_iter().flat_map(clicked));
    let before = picking(&harness).stick.clone();
    assert_eq!(before.len(), 2);
    let drop = places[1] + vec2(30.0, 20.0);
    at_once(&mut harness, [Event::PointerMoved(places[1]), button(places[1], true)]);
    at_once(&mut harness, [Event::PointerMoved(places[1] + vec2(15.0, 10.0))]);
    at_once(&mut harness, [Event::PointerMoved(drop)]);
    at_once(&mut harness, [button(drop, false)]);
    let after = picking(&harness).stick.clone();
    assert_eq!((after.len(), after[0]), (2, before[0]));
    assert!(after[1][1] > before[1][1] && after[1][2] > before[1][2], "{before:?} {after:?}");
}

#[test]
fn a_notch_of_the_wheel_is_one_line() {
    let folder = tempfile::tempdir().unwrap();
    let mut harness = open(folder.path());
    click(&mut harness, "Sections");
    harness.run_steps(3);
    let at = harness.get_by_label("Inline section").rect().center();
    let inline = |harness: &Driven| state(harness).session.as_ref().unwrap().view.slices[0];
    let before = inline(&harness);
    let notch = Event::MouseWheel {
        unit: MouseWheelUnit::Line,
        delta: vec2(0.0, -1.0),
        phase: TouchPhase::Move,
        source: MouseWheelSource::Wheel,
        modifiers: Modifiers::default(),
    };
    at_once(&mut harness, [Event::PointerMoved(at), notch.clone()]);
    assert_eq!(inline(&harness), before + 1.0);
    at_once(&mut harness, [notch.clone(), notch.clone(), notch]);
    assert_eq!(inline(&harness), before + 4.0);
}

/// In front of the block a point stays on the section on which its stick was drawn.
#[test]
fn a_point_of_a_stick_is_dragged_in_front_of_the_block() {
    let folder = tempfile::tempdir().unwrap();
    let mut harness = interpreting(folder.path());
    act(&mut harness, PickingStep::Use(Tool::Sticks));
    for (crossline, z) in [(4.0, 6.0), (16.0, 24.0)] {
        act(&mut harness, PickingStep::Stick(glam::DVec3::new(6.0, crossline, z)));
    }
    let before = picking(&harness).stick.clone();
    let pane = harness.get_by_role_and_label(Role::Image, "Block").rect();
    let session = state(&harness).session.as_ref().unwrap();
    let geometry = session.document.geometry.clone().unwrap();
    let size = glam::DVec2::new(f64::from(pane.width()), f64::from(pane.height()));
    let view = state::camera::view(&session.view.scene, &geometry, size);
    let at = view.project(glam::DVec3::new(6.0, 16.0, 24.0));
    let from = pane.min + vec2(at.x as f32, at.y as f32);
    let camera = session.view.scene.camera;
    at_once(&mut harness, [Event::PointerMoved(from), button(from, true)]);
    at_once(&mut harness, [Event::PointerMoved(from + vec2(12.0, -20.0))]);
    at_once(&mut harness, [Event::PointerMoved(from + vec2(20.0, -40.0))]);
    at_once(&mut harness, [button(from + vec2(20.0, -40.0), false)]);
    let after = picking(&harness).stick.clone();
    assert_eq!((after.len(), after[0], after[1][0]), (2, before[0], before[1][0]));
    assert!(after[1][1..] != before[1][1..] && after[1][2] < before[1][2], "{before:?} {after:?}");
    assert_eq!(state(&harness).session.as_ref().unwrap().view.scene.camera, camera, "the block is not turned");
}
