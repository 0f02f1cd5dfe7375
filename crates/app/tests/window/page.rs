//! The page in the export dialogue: labels are dragged where they are printed.

use super::driven::{click, open, wait};
use app::widgets::page::PagePreview;
use eframe::egui::{Event, Key, Modifiers, PointerButton, Pos2, Rect, Ui, vec2};
use egui_kittest::Harness;
use egui_kittest::kittest::Queryable;
use figure::draw::label_changes::{changed, movable};
use glam::DVec2;
use page::DisplayList;
use page::list::{Group, GroupKind, Text};
use render::LabelChange;
use std::sync::Arc;
use ttf::Preset;

const PAGE: &str = "Page as it will be printed";

/// A page with a caption and a block whose layers have names.
fn page() -> DisplayList {
    let mut page = DisplayList::new(DVec2::new(400.0, 300.0));
    let named = |kind: GroupKind, name: &str, at: [f64; 2]| {
        Group::new(kind, name).with([Text::new(DVec2::from_array(at), name).into()])
    };
    let labels = Group::new(GroupKind::Annotation, "labels").with([
        named(GroupKind::Layer, "Chalk", [100.0, 80.0]).into(),
        named(GroupKind::Layer, "Shale", [100.0, 140.0]).into(),
    ]);
    page.items.push(Group::new(GroupKind::Panel, "block").with([labels.into()]).into());
    page.items.push(named(GroupKind::Annotation, "caption", [20.0, 280.0]).into());
    page
}

type Shown = Harness<'static, (PagePreview, Vec<LabelChange>)>;

fn press(harness: &mut Shown, at: Pos2, button: PointerButton, pressed: bool) {
    let events = &mut harness.input_mut().events;
    events.push(Event::PointerMoved(at));
    events.push(Event::PointerButton { pos: at, button, pressed, modifiers: Modifiers::default() });
    harness.run_steps(2);
}

#[test]
fn a_label_is_dropped_where_it_is_printed_and_a_right_click_leaves_it_out() {
    let mut preview = PagePreview::default();
    preview.set(Arc::new(page()), Preset::Colour);
    let show = |ui: &mut Ui, (preview, labels): &mut (PagePreview, Vec<LabelChange>)| {
        if let Some(changed) = preview.show(ui, vec2(600.0, 500.0), labels) {
            *labels = changed;
        }
    };
    let mut harness: Shown = Harness::builder().with_size([700.0, 600.0]).build_ui_state(show, (preview, Vec::new()));
    harness.run_steps(2);
    let rect: Rect = harness.get_by_label(PAGE).rect();
    let scale = rect.width() / 400.0;
    let on_screen = |at: DVec2| rect.min + vec2(at.x as f32, at.y as f32) * scale;
    let middle = |label: &str| {
        let found = movable(&page()).into_iter().find(|known| known.label == label);
        on_screen(found.unwrap().bounds.centre())
    };
    let (from, by) = (middle("Shale"), vec2(48.0, -30.0));
    press(&mut harness, from, PointerButton::Primary, true);
    harness.input_mut().events.push(Event::PointerMoved(from + by * 0.5));
    harness.run_steps(2);
    press(&mut harness, from + by, PointerButton::Primary, false);
    let moved = harness.state().1.clone();
    assert_eq!((moved.len(), moved[0].label.as_str()), (1, "Shale"), "{moved:?}");
    let expected = by / scale * 25.4 / 72.0;
    let off = vec2(moved[0].moved_mm[0] as f32, moved[0].moved_mm[1] as f32) - expected;
    assert!(off.length() < 0.15, "moved by {:?} mm, the hand by {expected:?}", moved[0].moved_mm);
    // Where it stood there is nothing to take now; where it was dropped it is taken again.
    press(&mut harness, from, PointerButton::Secondary, true);
    press(&mut harness, from, PointerButton::Secondary, false);
    assert_eq!(harness.state().1, moved);
    press(&mut harness, from + by, PointerButton::Secondary, true);
    press(&mut harness, from + by, PointerButton::Secondary, false);
    assert!(harness.state().1[0].is_hidden);
    // Labels beside blocks are labels too.
    let caption = middle("caption");
    press(&mut harness, caption, PointerButton::Secondary, true);
    press(&mut harness, caption, PointerButton::Secondary, false);
    assert_eq!(harness.state().1[1].label, "caption");
}

#[test]
fn the_letters_of_a_label_are_changed_where_it_is_clicked() {
    let mut preview = PagePreview::default();
    preview.set(Arc::new(page()), Preset::Colour);
    let show = |ui: &mut Ui, (preview, labels): &mut (PagePreview, Vec<LabelChange>)| {
        let dropped = preview.show(ui, vec2(600.0, 400.0), labels);
        *labels = dropped.or_else(|| preview.show_chosen(ui, labels)).unwrap_or_else(|| labels.clone());
    };
    let mut harness: Shown = Harness::builder().with_size([700.0, 600.0]).build_ui_state(show, (preview, Vec::new()));
    harness.run_steps(2);
    assert_eq!(harness.query_all_by_label("Leave out").count(), 0, "no label is chosen");
    let rect: Rect = harness.get_by_label(PAGE).rect();
    let labels = movable(&page());
    let shale = labels.iter().find(|known| known.label == "Shale").unwrap();
    let at = shale.bounds.centre() * f64::from(rect.width()) / 400.0;
    let at = rect.min + vec2(at.x as f32, at.y as f32);
    press(&mut harness, at, PointerButton::Primary, true);
    press(&mut harness, at, PointerButton::Primary, false);
    assert!(harness.state().1.is_empty(), "a click moves nothing");
    let size = shale.letters.unwrap().0;
    harness.get_by_label("Size of the letters").focus();
    harness.run_steps(2);
    harness.key_press(Key::ArrowUp);
    harness.run_steps(3);
    let larger = harness.state().1.clone();
    assert_eq!((larger.len(), larger[0].label.as_str(), larger[0].moved_mm), (1, "Shale", [0.0; 2]));
    assert!(larger[0].size_pt.unwrap() > size, "{larger:?} from {size}");
    let shown = movable(&changed(&page(), &larger, Preset::Colour));
    assert_eq!(
        shown.iter().find(|known| known.label == "Shale").unwrap().letters.unwrap().0,
        larger[0].size_pt.unwrap()
    );
    // What is left out is named, and comes back as it was.
    harness.get_by_label("Leave out").click_accesskit();
    harness.run_steps(3);
    assert!(harness.state().1[0].is_hidden);
    harness.get_by_label("Shale").click_accesskit();
    harness.run_steps(3);
    assert_eq!(harness.state().1, larger);
    harness.get_by_label("As it was").click_accesskit();
    harness.run_steps(3);
    assert!(harness.state().1.is_empty());
}

#[test]
fn the_export_dialogue_offers_a_preview() {
    let folder = tempfile::tempdir().unwrap();
    let mut harness = open(folder.path());
    click(&mut harness, "Export…");
    assert_eq!(harness.query_all_by_label(PAGE).count(), 0);
    // The dialogue finds its place.
    harness.run_steps(6);
    click(&mut harness, "Preview");
    wait(&mut harness, "the page is laid out", |harness| harness.query_all_by_label(PAGE).count() == 1);
    assert!(harness.query_all_by_label("Reset labels").count() == 1);
}
