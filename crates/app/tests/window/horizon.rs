//! The list of horizons while interpreting: colours, names, holes, picks moved and made again, by labels.

use super::command::{applied, click_last};
use super::driven::{Driven, click, document, open, state, wait};
use super::picking::{act, interpreting, on_a_trough, picking};
use eframe::egui::{Event, Key, Modifiers};
use egui_kittest::kittest::Queryable;
use files::ImportOptions;
use glam::DVec3;
use interp::ExtractSettings;
use project::command::{AddHorizon, Age, Command};
use project::document::{HorizonEntry, PickEntry};
use state::{Action, How, PickingStep};
use survey::Contact;

fn entry(harness: &Driven) -> Option<HorizonEntry> {
    document(harness).horizons.into_iter().find(|entry| entry.name == "Horizon 1")
}

fn log(harness: &Driven) -> Vec<PickEntry> {
    entry(harness).and_then(|entry| entry.assembly).map_or_else(Vec::new, |log| log.picks)
}

/// Picks a place for the horizon, so many levels above its leaf; beyond the root, the root.
fn pick(harness: &mut Driven, at: DVec3, up: i32) {
    let before = log(harness).len();
    act(harness, PickingStep::At(at, How::Replace));
    wait(harness, "a leaf is selected", |harness| picking(harness).pick.is_some());
    act(harness, PickingStep::Climb(up));
    act(harness, PickingStep::Accept);
    wait(harness, "it is part of the horizon", |harness| log(harness).len() == before + 1);
    wait(harness, "the list shows it", |harness| harness.query_all_by_label("Highest").count() == before + 1);
}

/// Extracts with leaves of another size, from the panel's own action.
fn extract_again(harness: &mut Driven, min_leaf_triangles: u32) {
    let mut settings = ExtractSettings::default();
    settings.forest.min_leaf_triangles = min_leaf_triangles;
    harness.state_mut().as_mut().unwrap().act(Action::Extract(None, Box::new(settings)));
    wait(harness, "the picks are known to be outdated", |harness| {
        harness.query_by_label_contains("picks were made on another extraction").is_some()
    });
}

#[test]
fn a_horizon_gets_another_colour_from_its_palette() {
    let folder = tempfile::tempdir().unwrap();
    let mut harness = interpreting(folder.path());
    pick(&mut harness, on_a_trough(), 0);
    let before = entry(&harness).unwrap().assembly.unwrap().colour;
    click_last(&mut harness, "Colour of Horizon 1");
    click_last(&mut harness, "Colour 12");
    wait(&mut harness, "it has another colour", |harness| {
        entry(harness).is_some_and(|entry| entry.assembly.unwrap().colour != before)
    });
    assert_eq!(entry(&harness).unwrap().assembly.unwrap().colour, ttf::Colour::new(0x30, 0x30, 0x30));
}

#[test]
fn picks_of_a_former_extraction_are_made_again() {
    let folder = tempfile::tempdir().unwrap();
    let mut harness = interpreting(folder.path());
    pick(&mut harness, on_a_trough(), i32::MAX);
    let former = log(&harness);
    let sheets = entry(&harness).unwrap().hash;
    extract_again(&mut harness, 40);
    click_last(&mut harness, "Pick again");
    wait(&mut harness, "the pick is of the present extraction", |harness| {
        log(harness)[0].extraction != former[0].extraction
    });
    wait(&mut harness, "nothing is outdated", |harness| harness.query_by_label("Pick again").is_none());
    // The same surface, whatever its leaves are.
    assert_eq!(log(&harness)[0].node.triangles, former[0].node.triangles);
    assert_eq!(entry(&harness).unwrap().hash, sheets);
}

#[test]
fn picks_that_no_longer_fit_are_named_and_left_out_where_that_is_asked_for() {
    let folder = tempfile::tempdir().unwrap();
    let mut harness = interpreting(folder.path());
    pick(&mut harness, on_a_trough(), i32::MAX);
    // One leaf of the trough below; surfaces will be of one leaf each.
    pick(&mut harness, on_a_trough() + DVec3::Z * std::f64::consts::TAU / 0.7, 0);
    extract_again(&mut harness, 100_000);
    click_last(&mut harness, "Pick again");
    wait(&mut harness, "it is said", |harness| state(harness).notices.iter().any(|notice| notice.failed));
    let notice = state(&harness).notices.iter().find(|notice| notice.failed).unwrap().clone();
    assert!(notice.text.contains("no longer fit"), "{notice:?}");
    assert!(notice.hint.as_ref().is_some_and(|hint| hint.contains("Pick again what fits")), "{notice:?}");
    assert_eq!(log(&harness).len(), 2);
    click_last(&mut harness, "Pick again what fits");
    wait(&mut harness, "what fits is left", |harness| log(harness).len() == 1);
    wait(&mut harness, "nothing is outdated", |harness| harness.query_by_label("Pick again").is_none());
}

#[test]
fn a_pick_descends_and_climbs_as_high_as_it_can() {
    let folder = tempfile::tempdir().unwrap();
    let mut harness = interpreting(folder.path());
    pick(&mut harness, on_a_trough(), 1);
    assert_eq!(log(&harness)[0].up, 1);
    click_last(&mut harness, "Down");
    wait(&mut harness, "it is at its leaf", |harness| log(harness)[0].up == 0);
    wait(&mut harness, "the list knows", |harness| harness.query_by_label("level 0").is_some());
    click_last(&mut harness, "Highest");
    wait(&mut harness, "it is as high as can be", |harness| log(harness)[0].up > 1);
}

#[test]
fn a_horizon_is_renamed_filled_and_removed_in_the_panel() {
    let folder = tempfile::tempdir().unwrap();
    let mut harness = open(folder.path());
    let path = folder.path().join("holed.csv");
    let mut text = "inline,crossline,z\n".to_owned();
    for (inline, crossline) in (1..=24).flat_map(|inline| (1..=20).map(move |crossline| (inline, crossline))) {
        if !((9..13).contains(&inline) && (8..11).contains(&crossline)) {
            text += &format!("{inline},{crossline},55\n");
        }
    }
    std::fs::write(&path, text).unwrap();
    applied(
        &mut harness,
        &Command::AddHorizon(AddHorizon {
            path,
            name: "Middle".into(),
            contact: Contact::Conformable,
            age: Age::ByDepth,
            options: ImportOptions::default(),
        }),
    );
    click(&mut harness, "Interpret");
    wait(&mut harness, "the horizons are read", |harness| harness.query_all_by_label_contains("%").count() == 3);
    click_last(&mut harness, "Middle");
    wait(&mut harness, "its hole is told", |harness| harness.query_by_label("1 hole with 12 traces").is_some());
    click_last(&mut harness, "12 traces");
    let slices = state(&harness).session.as_ref().unwrap().view.slices;
    assert!((8.0..12.0).contains(&slices[0]) && (7.0..10.0).contains(&slices[1]), "{slices:?}");
    // A smooth surface is no pick: 12 of 480 traces.
    click_last(&mut harness, "Fill holes");
    let filled = |harness: &Driven| harness.query_by_label_contains("12 nodes filled").is_some();
    wait(&mut harness, "it is said how much is filled", filled);
    harness.key_press_modifiers(Modifiers::COMMAND, Key::Z);
    wait(&mut harness, "the hole is back", |harness| harness.query_by_label("1 hole with 12 traces").is_some());
    click_last(&mut harness, "Along the reflection");
    click_last(&mut harness, "Fill holes");
    wait(&mut harness, "it has no hole", |harness| harness.query_by_label("no holes").is_some());
    click_last(&mut harness, "Rename…");
    harness.event(Event::Text("Chalk".into()));
    harness.run_steps(2);
    harness.key_press(Key::Enter);
    wait(&mut harness, "it has another name", |harness| {
        document(harness).horizons.iter().any(|entry| entry.name.contains("Chalk"))
    });
    let renamed = document(&harness).horizons[1].name.clone();
    wait(&mut harness, "picks still go to it", |harness| picking(harness).horizon.as_deref() == Some(&renamed));
    click_last(&mut harness, "Remove");
    wait(&mut harness, "it is gone", |harness| document(harness).horizons.len() == 2);
}

#[test]
fn a_horizon_is_smoothed_and_that_is_taken_back() {
    let folder = tempfile::tempdir().unwrap();
    let mut harness = interpreting(folder.path());
    pick(&mut harness, on_a_trough(), 0);
    let smoothing = |harness: &Driven| entry(harness).and_then(|entry| entry.assembly.unwrap().smooth);
    click_last(&mut harness, "Smooth");
    wait(&mut harness, "it is smoothed", |harness| smoothing(harness).is_some_and(|smooth| smooth.radius == 3));
    wait(&mut harness, "the list says so", |harness| {
        harness.query_by_label("Smoothed over 3 traces, passes: 1").is_some()
    });
    click_last(&mut harness, "Not smoothed");
    wait(&mut harness, "it is as picked", |harness| smoothing(harness).is_none());
}

/// Of many horizons those on which nothing is left to do are folded away, and none of a few.
#[test]
fn finished_horizons_are_folded_where_there_are_many() {
    let folder = tempfile::tempdir().unwrap();
    let mut harness = interpreting(folder.path());
    assert!(harness.query_by_label("Top").is_some() && harness.query_by_label_contains("finished horizons").is_none());
    for (n, z) in [40, 50, 60, 70, 90].into_iter().enumerate() {
        // The last has a hole, so that there is something to do.
        let is_hole =
            |inline: i32, crossline: i32| n == 4 && (10..13).contains(&inline) && (8..11).contains(&crossline);
        let rows = (1..=24).flat_map(|inline| (1..=20).map(move |crossline| (inline, crossline)));
        let rows = rows.filter(|(inline, crossline)| !is_hole(*inline, *crossline));
        let text = rows.fold("inline,crossline,z\n".to_owned(), |text, (inline, crossline)| {
            text + &format!("{inline},{crossline},{z}\n")
        });
        let path = folder.path().join("h.csv");
        std::fs::write(&path, text).unwrap();
        let command = AddHorizon {
            path,
            name: format!("H{n}"),
            contact: Contact::Conformable,
            age: Age::ByDepth,
            options: ImportOptions::default(),
        };
        applied(&mut harness, &Command::AddHorizon(command));
    }
    // Opening the project anew led to the layers.
    click(&mut harness, "Interpret");
    let folded = |harness: &Driven| harness.query_by_label_contains("finished horizons").is_some();
    wait(&mut harness, "some are folded", |harness| folded(harness) && harness.query_by_label("H0").is_none());
    assert!(harness.query_by_label("H4").is_some(), "it has a hole");
    let fold = |harness: &mut Driven| {
        // What is chosen takes room: the list may have moved out of sight.
        harness.get_by_label_contains("finished horizons").scroll_to_me();
        harness.run_steps(5);
        harness.get_by_label_contains("finished horizons").click_accesskit();
        harness.run_steps(20);
    };
    fold(&mut harness);
    click(&mut harness, "H0");
    assert_eq!(picking(&harness).horizon.as_deref(), Some("H0"));
    // The one that picks go to is not folded.
    fold(&mut harness);
    let is_folded = |harness: &Driven| harness.query_by_label("H0").is_some() && harness.query_by_label("H1").is_none();
    wait(&mut harness, "the others are folded", is_folded);
}
