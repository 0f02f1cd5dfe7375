//! Geologic time in the window: computed by a button, a horizon by one click, layers by none.

use super::command::applied;
use super::driven::{Driven, click, document, state, wait};
use super::picking::{click_in, interpreting, picking};
use eframe::egui::Modifiers;
use egui_kittest::kittest::{NodeT, Queryable};
use project::command::{Command, Remove};
use project::error::Noun;
use state::Tool;

#[test]
fn one_click_makes_a_horizon_and_a_second_corrects_it() {
    let folder = tempfile::tempdir().unwrap();
    let mut harness = interpreting(folder.path());
    click(&mut harness, "Sections");
    harness.run_steps(3);
    for label in ["Lay beds flat", "Missing beds"] {
        assert!(harness.get_by_label(label).accesskit_node().is_disabled(), "{label} needs geologic time");
    }
    click(&mut harness, "Geologic time");
    wait(&mut harness, "time is a volume", |h| document(h).volumes.iter().any(|entry| entry.name == "time"));
    wait(&mut harness, "it can be computed again", |h| h.query_by_label("Geologic time again").is_some());
    assert_eq!(picking(&harness).tool, Tool::Time);
    click_in(&mut harness, "Inline section", [20.0, 10.0], Modifiers::NONE);
    wait(&mut harness, "a horizon is there", |harness| document(harness).horizons.len() == 3);
    let seeds = |harness: &Driven| document(harness).horizons.iter().map(|entry| entry.origin.seeds().len()).max();
    assert_eq!(seeds(&harness), Some(1));
    click_in(&mut harness, "Inline section", [60.0, 10.0], Modifiers::NONE);
    wait(&mut harness, "it is corrected", |harness| seeds(harness) == Some(2));
    assert_eq!(document(&harness).horizons.len(), 3);
    // The places that were clicked lead to their sections.
    wait(&mut harness, "both clicks are listed", |h| h.query_by_label_contains("click 2: ").is_some());
    harness.get_by_label_contains("click 1: ").click_accesskit();
    harness.run_steps(3);
    let seeds =
        document(&harness).horizons.iter().map(|entry| entry.origin.seeds().to_vec()).find(|seeds| !seeds.is_empty());
    let geometry = document(&harness).geometry.unwrap();
    let [inline, crossline, _] = seeds.unwrap()[0];
    let at = geometry.voxel_from_lines(inline, crossline);
    let slices = state(&harness).session.as_ref().unwrap().view.slices;
    assert!((slices[0] - at.x).abs() < 0.51 && (slices[1] - at.y).abs() < 0.51, "{slices:?} {at}");
    // The project has layers already: a button that says so.
    let button = harness.get_by_label("Illustrate now");
    assert!(button.accesskit_node().is_disabled());
    for (label, volume) in [("Lay beds flat", "flattened"), ("Missing beds", "missing beds")] {
        harness.get_by_label(label).click_accesskit();
        harness.run_steps(3);
        wait(&mut harness, label, |h| document(h).volumes.iter().any(|entry| entry.name == volume));
    }
    assert!(state(&harness).notices.iter().all(|notice| !notice.failed));
}

#[test]
fn a_volume_without_horizons_gets_layers_by_one_button() {
    let folder = tempfile::tempdir().unwrap();
    let mut harness = interpreting(folder.path());
    for name in ["Top", "Base"] {
        applied(&mut harness, &Command::Remove(Remove { noun: Noun::Horizon, name: name.to_owned() }));
    }
    wait(&mut harness, "they are gone", |h| document(h).horizons.is_empty());
    click(&mut harness, "Interpret");
    let can = |h: &Driven| h.query_by_label("Illustrate now").is_some_and(|b| !b.accesskit_node().is_disabled());
    wait(&mut harness, "nothing stands in the way of layers", can);
    click(&mut harness, "Illustrate now");
    let bounded = |h: &Driven| document(h).horizons.iter().any(|entry| entry.name == "Level 1");
    wait(&mut harness, "a level of geologic time bounds layers", bounded);
    assert!(document(&harness).volumes.iter().any(|entry| entry.name == "time"));
    assert!(state(&harness).notices.iter().all(|notice| !notice.failed));
}
