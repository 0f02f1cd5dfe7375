//! Panels keep one height of buttons and one column of fields, and names of any length stay inside them.

use super::command::{act, applied};
use super::driven::{Driven, open, state, wait};
use eframe::egui::Rect;
use eframe::egui::accesskit::Role;
use egui_kittest::kittest::{NodeT, Queryable};
use state::{Action, Panel};

#[test]
fn measured() {
    let folder = tempfile::tempdir().unwrap();
    let mut harness = open(folder.path());
    for panel in [Panel::Layers, Panel::Data, Panel::Values, Panel::Interpret] {
        act(&mut harness, Action::Panel(panel));
        if panel == Panel::Layers {
            act(&mut harness, Action::Layer(Some("Top - Base".into())));
        }
        for role in [
            Role::Button,
            Role::ComboBox,
            Role::SpinButton,
            Role::Slider,
            Role::TextInput,
            Role::CheckBox,
            Role::RadioButton,
            Role::ColorWell,
            Role::Label,
        ] {
            for node in harness.query_all_by_role(role) {
                let rect = node.rect();
                println!(
                    "{panel:?} {role:?} {:?} {:.1}..{:.1} y {:.1} h {:.1}",
                    node.accesskit_node().label(),
                    rect.left(),
                    rect.right(),
                    rect.center().y,
                    rect.height()
                );
            }
        }
    }
}
