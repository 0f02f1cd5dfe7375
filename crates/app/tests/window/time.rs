//! Geologic time in the window: computed by a button, a horizon by one click, layers by none.

use super::driven::{Driven, click, document, state, wait};
use super::picking::{click_in, interpreting, picking};
use eframe::egui::Modifiers;
use egui_kittest::kittest::{NodeT, Queryable};
use state::Tool;

#[test]
fn one_click_makes_a_horizon_and_a_second_corrects_it() {
    let folder = tempfile::tempdir().unwrap();
    let mut harness = interpreting(folder.path());
    click(&mut harness, "Sections");
    harness.run_steps(3);
    click(&mut harness, "Geologic time");
    wait(&mut harness, "time is a volume", |h| document(h).volumes.iter().any(|entry| entry.name == "time"));
    wait(&mut harness, "it can be computed again", |h| h.query_by_label("Geologic time again").is_some());
    assert_eq!(picking(&harness).tool, Tool::Time);
    click_in(&mut harness, "Inline section", [20.0, 10.0], Modifiers::NONE);
    wait(&mut harness, "a horizon is there", |harness| document(harness).horizons.len() == 3);
    let seeds = |harness: &Driven| document(harness).horizons.iter().map(|entry| entry.seeds.len()).max();
    assert_eq!(seeds(&harness), Some(1));
    click_in(&mut harness, "Inline section", [60.0, 10.0], Modifiers::NONE);
    wait(&mut harness, "it is corrected", |harness| seeds(harness) == Some(2));
    assert_eq!(document(&harness).horizons.len(), 3);
    // The project has layers already: a button that says so.
    let button = harness.get_by_label("Illustrate now");
    assert!(button.accesskit_node().is_disabled());
    assert!(state(&harness).notices.iter().all(|notice| !notice.failed));
}
