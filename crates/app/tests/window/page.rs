//! The page in the export dialogue: labels are dragged where they are printed, and kept in the scene.

use super::driven::{Driven, click, open, state, wait};
use app::state::Dialogue;
use eframe::egui::{Event, Modifiers, PointerButton, Pos2, vec2};
use egui_kittest::kittest::Queryable;
use render::LabelChange;

const PAGE: &str = "Page as it will be printed";

fn labels(harness: &Driven) -> Vec<LabelChange> {
    state(harness).session.as_ref().unwrap().view.scene.labels.clone()
}

fn press(harness: &mut Driven, at: Pos2, button: PointerButton, pressed: bool) {
    let events = &mut harness.input_mut().events;
    events.push(Event::PointerMoved(at));
    events.push(Event::PointerButton { pos: at, button, pressed, modifiers: Modifiers::default() });
    harness.run_steps(2);
}

#[test]
fn a_label_is_dragged_left_out_and_put_back() {
    let folder = tempfile::tempdir().unwrap();
    let mut harness = open(folder.path());
    click(&mut harness, "Export…");
    assert_eq!(harness.query_all_by_label(PAGE).count(), 0);
    click(&mut harness, "Preview");
    wait(&mut harness, "the page is laid out", |harness| harness.query_all_by_label(PAGE).count() == 1);
    let rect = harness.get_by_label(PAGE).rect();
    let Some(Dialogue::Export(form)) = &state(&harness).dialogue else { panic!("no dialogue") };
    let px_per_mm = rect.width() / (10.0 * form.size_cm[0] as f32);
    // The legend begins in the upper right corner of the page.
    let legend = pos(rect, 0.93, 0.07);
    press(&mut harness, legend, PointerButton::Primary, true);
    let by = vec2(-40.0, 25.0);
    harness.input_mut().events.push(Event::PointerMoved(legend + by * 0.5));
    harness.run_steps(2);
    press(&mut harness, legend + by, PointerButton::Primary, false);
    let moved = labels(&harness);
    assert_eq!((moved.len(), moved[0].label.as_str()), (1, "legend"), "{moved:?}");
    let expected = by / px_per_mm;
    let off = vec2(moved[0].moved_mm[0] as f32, moved[0].moved_mm[1] as f32) - expected;
    assert!(off.length() < 0.2, "moved by {:?} mm, the hand by {expected:?}", moved[0].moved_mm);
    // Where it stood there is nothing to take now; where it stands a right click leaves it out.
    press(&mut harness, pos(rect, 0.99, 0.02), PointerButton::Secondary, true);
    press(&mut harness, pos(rect, 0.99, 0.02), PointerButton::Secondary, false);
    assert_eq!(labels(&harness), moved);
    press(&mut harness, legend + by, PointerButton::Secondary, true);
    press(&mut harness, legend + by, PointerButton::Secondary, false);
    assert!(labels(&harness)[0].is_hidden, "{:?}", labels(&harness));
    click(&mut harness, "Reset labels");
    assert_eq!(labels(&harness), []);
}

fn pos(rect: eframe::egui::Rect, x: f32, y: f32) -> Pos2 {
    rect.min + rect.size() * vec2(x, y)
}
