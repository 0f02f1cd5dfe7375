//! A horizon that was picked on less than half of its traces: the window asks before it shapes a figure, and shows on
//! the block where it was not picked.

use super::command::{act, applied};
use super::driven::{click, open, state, wait};
use eframe::egui::Key;
use eframe::egui::accesskit::Toggled;
use egui_kittest::kittest::{NodeT, Queryable};
use files::ImportOptions;
use project::command::{AddHorizon, Age, Command};
use render::Unpicked;
use state::{Action, Layout};
use survey::Contact;

#[test]
fn an_export_with_a_horizon_that_was_hardly_picked_is_asked_for() {
    let folder = tempfile::tempdir().unwrap();
    let mut harness = open(folder.path());
    let path = folder.path().join("few.csv");
    let rows = (1..=6).flat_map(|inline| (1..=20).map(move |crossline| format!("{inline},{crossline},55\n")));
    std::fs::write(&path, rows.fold("inline,crossline,z\n".to_owned(), |text, row| text + &row)).unwrap();
    let options = ImportOptions::default();
    let add = AddHorizon { path, name: "Few".into(), contact: Contact::Conformable, age: Age::ByDepth, options };
    applied(&mut harness, &Command::AddHorizon(add));
    wait(&mut harness, "the picture is drawn", |harness| harness.state().as_ref().unwrap().is_settled());
    // The layers' list says how much was picked, of this horizon alone.
    assert_eq!(harness.query_all_by_label_contains("% picked").count(), 1);
    harness.get_by_label("42 % picked");
    click(&mut harness, "Export…");
    wait(&mut harness, "it is said", |harness| {
        harness.query_by_label_contains("Horizon Few was picked on or near 42 % of its traces").is_some()
    });
    assert!(harness.get_by_label("Export").accesskit_node().is_disabled());
    // The block is dashed already, and that is said.
    let dashes = harness.get_by_label("Dashes and ? where not picked");
    let dashes = dashes.accesskit_node();
    assert!(dashes.is_disabled() && dashes.toggled() == Some(Toggled::True));
    harness.key_press(Key::Enter);
    harness.run_steps(3);
    assert!(harness.get_by_label("Export").accesskit_node().is_disabled(), "Enter does not answer it");
    click(&mut harness, "Draw it all the same");
    assert!(!harness.get_by_label("Export").accesskit_node().is_disabled());
    click(&mut harness, "Cancel");
    // So is sharing.
    click(&mut harness, "Share…");
    harness.get_by_label_contains("Horizon Few was picked on or near 42 % of its traces");
    let told = |harness: &super::driven::Driven| {
        let button = harness.get_by_label("Write the file");
        (button.accesskit_node().is_disabled(), button.accesskit_node().description())
    };
    assert_eq!(told(&harness), (true, Some("Tick the line above first".into())));
    click(&mut harness, "Share it all the same");
    assert!(!told(&harness).0);
    click(&mut harness, "Cancel");
    let unpicked =
        |harness: &super::driven::Driven| state(harness).session.as_ref().unwrap().view.scene.outlines.unpicked;
    assert_eq!(unpicked(&harness), Unpicked::Dashed);
    click(&mut harness, "Dashed where not picked");
    assert_eq!(unpicked(&harness), Unpicked::Solid);
    // While interpreting it is the same share, counted in the same way.
    click(&mut harness, "Interpret");
    wait(&mut harness, "it is listed", |harness| harness.query_by_label("42 % picked").is_some());
    click(&mut harness, "Layers");
    // No thickness is offered below the deepest horizon, and why.
    act(&mut harness, Action::Arrange(Layout::Map));
    harness.run_steps(3);
    act(&mut harness, Action::Horizon(Some("Base".into())));
    harness.run_steps(3);
    let thickness = harness.get_by_label("Thickness");
    let thickness = thickness.accesskit_node();
    assert!(thickness.is_disabled());
    assert_eq!(thickness.description().as_deref(), Some("There is no horizon below this one"));
}
