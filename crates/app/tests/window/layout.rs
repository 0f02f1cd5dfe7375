//! Panels keep one height of buttons and one column of fields, and names of any length stay inside them.

use super::command::{act, applied};
use super::driven::{Driven, open, state, wait};
use eframe::egui::accesskit::Role;
use eframe::egui::{Event, Rect};
use egui_kittest::kittest::{NodeT, Queryable};
use project::command::{AddScene, Command, PickFault, Rename};
use project::error::Noun;
use state::{Action, Panel};
use std::collections::BTreeMap;

/// Where the panels on the left and on the right lie, and their rows begin.
const PANELS: [([f32; 2], f32); 2] = [([0.0, 316.0], 16.0), ([965.0, 1280.0], 981.0)];
/// A label and the gap beside it.
const COLUMN: f32 = 108.0;
const FIELDS: [Role; 6] =
    [Role::SpinButton, Role::Slider, Role::TextInput, Role::ComboBox, Role::CheckBox, Role::ColorWell];
const LONG: &str = "Upper Jurassic Kimmeridge Clay, amplitudes preserved, full stack 2026";

/// What has that role, with its name, below the toolbar.
fn placed(harness: &Driven, role: Role) -> Vec<(String, Rect)> {
    let nodes = harness.query_all_by_role(role);
    let named = nodes.map(|node| {
        let known = node.accesskit_node();
        (known.label().or_else(|| known.value()).unwrap_or_default(), node.rect())
    });
    named.filter(|(_, rect)| rect.top() > 95.0 && rect.bottom() < 1170.0).collect()
}

/// The first field of each row that begins with a label: its label, and how far it is from there.
fn columns(harness: &Driven) -> BTreeMap<String, f32> {
    let fields: Vec<Rect> = FIELDS.into_iter().flat_map(|role| placed(harness, role)).map(|(_, rect)| rect).collect();
    let mut found = BTreeMap::new();
    for (range, begin) in PANELS {
        let begins = |rect: &Rect| (rect.left() - begin).abs() < 1.0 && rect.width() < COLUMN;
        for (name, label) in placed(harness, Role::Label).into_iter().filter(|(_, rect)| begins(rect)) {
            let beside = |rect: &&Rect| {
                (rect.center().y - label.center().y).abs() < 6.0
                    && rect.left() >= label.right()
                    && rect.right() < range[1]
            };
            let first = fields.iter().filter(beside).map(|rect| rect.left()).reduce(f32::min);
            found.extend(first.map(|left| (name, left - begin)));
        }
    }
    found
}

/// Opens every panel, with what it can show.
fn panels(harness: &mut Driven, mut look: impl FnMut(&mut Driven, Panel)) {
    for panel in [Panel::Layers, Panel::Data, Panel::Values, Panel::Interpret] {
        act(harness, Action::Panel(panel));
        if panel == Panel::Layers {
            let layer = state(harness).session.as_ref().unwrap().document.layers()[1].clone();
            act(harness, Action::Layer(Some(layer)));
        }
        if panel == Panel::Values {
            harness.get_by_label("Cut-outs").click_accesskit();
        }
        // What is computed for a panel makes rows higher when it is there.
        wait(harness, "all is drawn", |harness| harness.state().as_ref().unwrap().is_settled());
        harness.run_steps(4);
        look(harness, panel);
    }
}

#[test]
fn buttons_have_one_height_and_fields_one_column() {
    let folder = tempfile::tempdir().unwrap();
    let mut harness = open(folder.path());
    harness.set_size([1280.0, 1180.0].into());
    harness.run_steps(3);
    let mut fields = 0;
    panels(&mut harness, |harness, panel| {
        for role in [Role::Button, Role::ComboBox, Role::SpinButton] {
            // A layer's row is as high as its pattern.
            let all = placed(harness, role).into_iter().filter(|(name, _)| !name.starts_with("Layer "));
            let odd: Vec<_> = all.filter(|(_, rect)| (rect.height() - 25.0).abs() > 0.5).collect();
            assert!(odd.is_empty(), "{panel:?} {role:?}: {odd:?}");
        }
        // Nothing runs out of its panel.
        for role in [Role::Button, Role::ComboBox, Role::SpinButton, Role::CheckBox, Role::Label] {
            let outside = placed(harness, role).into_iter().filter(|(_, rect)| {
                PANELS.iter().any(|([from, to], _)| rect.left() >= *from && rect.left() < *to && rect.right() > *to)
            });
            let outside: Vec<_> = outside.collect();
            assert!(outside.is_empty(), "{panel:?} {role:?}: {outside:?}");
        }
        let columns = columns(harness);
        fields += columns.len();
        let odd: Vec<_> = columns.iter().filter(|(_, off)| (*off - COLUMN).abs() > 1.0).collect();
        assert!(odd.is_empty(), "{panel:?}: {odd:?} of {columns:?}");
    });
    assert!(fields > 25, "{fields}");
}

#[test]
fn long_names_stay_inside_the_panels_and_are_read_whole_under_the_pointer() {
    let folder = tempfile::tempdir().unwrap();
    let mut harness = open(folder.path());
    let stick = |crossline: f64| vec![[9.0, crossline, 4.0], [13.0, crossline, 120.0]];
    let name = |what: &str| format!("{what} {LONG}");
    let scene = state(&harness).session.as_ref().unwrap().view.scene.clone();
    for command in [
        Command::Rename(Rename { noun: Noun::Volume, from: "seismic".into(), to: name("Volume") }),
        Command::Rename(Rename { noun: Noun::Horizon, from: "Top".into(), to: name("Horizon") }),
        Command::PickFault(PickFault { name: name("Fault"), sticks: vec![stick(2.0), stick(18.0)] }),
        Command::AddScene(AddScene { name: name("Scene"), scene }),
    ] {
        applied(&mut harness, &command);
    }
    harness.set_size([1280.0, 1180.0].into());
    harness.run_steps(3);
    let mut count = 0;
    panels(&mut harness, |harness, panel| {
        let mut hovered = Vec::new();
        for role in [Role::Button, Role::ComboBox, Role::CheckBox, Role::Label] {
            for (name, rect) in placed(harness, role).into_iter().filter(|(name, _)| name.contains(LONG)) {
                let (range, _) = PANELS[usize::from(rect.left() > 600.0)];
                assert!(rect.right() <= range[1], "{panel:?} {role:?} {name}: {rect:?}");
                // A sentence on several lines is not cut off, and a box or a swatch stands beside the name.
                if rect.height() < 30.0 && rect.width() > 30.0 {
                    hovered.push(rect);
                }
            }
        }
        count += hovered.len();
        for rect in hovered {
            harness.event(Event::PointerMoved(rect.center()));
            // A tooltip waits for the pointer to rest.
            harness.run_steps(60);
            let told = harness.query_all_by_label_contains(LONG).filter(|node| node.rect().height() > 30.0).count();
            assert!(told > 0, "{panel:?}: nothing is told at {rect:?}");
            harness.event(Event::PointerMoved([640.0, 900.0].into()));
            harness.run_steps(10);
        }
    });
    assert!(count > 8, "{count}");
}
