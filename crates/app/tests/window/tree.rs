//! The list of everything in the project: shown and hidden, renamed, written for other programs, by labels.

use super::command::{act, applied, choose, click_last};
use super::driven::{Driven, click, document, open, state, wait};
use eframe::egui::{Key, Modifiers};
use egui_kittest::kittest::{NodeT, Queryable};
use files::SurfaceKind;
use project::command::{AddScene, AddWell, Command, PickFault};
use state::Action;

fn type_path(harness: &mut Driven, path: &std::path::Path) {
    harness.get_by_label("File").focus();
    harness.step();
    harness.key_press_modifiers(Modifiers::COMMAND, Key::A);
    harness.get_by_label("File").type_text(&path.display().to_string());
    harness.run_steps(2);
}

/// A window on the data of a project that has a fault "East", drawn with two sticks.
fn with_fault(folder: &std::path::Path) -> Driven {
    let mut harness = open(folder);
    let stick = |crossline: f64| vec![[9.0, crossline, 4.0], [13.0, crossline, 120.0]];
    let fault = PickFault { name: "East".into(), sticks: vec![stick(2.0), stick(18.0)] };
    applied(&mut harness, &Command::PickFault(fault));
    click(&mut harness, "Data");
    harness
}

#[test]
fn horizons_and_faults_are_written_from_the_window() {
    let folder = tempfile::tempdir().unwrap();
    let mut harness = with_fault(folder.path());
    for (name, kind, format) in [("Base", "horizon", "irap"), ("East", "fault", "opendtect")] {
        click_last(&mut harness, name);
        click_last(&mut harness, "Export…");
        harness.get_by_label(&format!("Export {kind} {name}"));
        choose(&mut harness, "Format", format);
        // A place that cannot be written keeps the dialogue, which says why.
        type_path(&mut harness, &folder.path().join("nowhere").join(name));
        click_last(&mut harness, "Export");
        wait(&mut harness, "it is told", |harness| harness.query_by_label_contains("No such file").is_some());
        let out = folder.path().join(name);
        type_path(&mut harness, &out);
        click_last(&mut harness, "Export");
        wait(&mut harness, "it is written", |harness| out.exists() && state(harness).dialogue.is_none());
        assert!(std::fs::read_to_string(&out).unwrap().lines().count() > 3, "{name}");
        // Chosen no more, so that the next row's button is the last.
        click_last(&mut harness, name);
    }
}

/// A volume has another name where it is shown too, also after undo, and is written as SEG-Y.
#[test]
fn a_volume_is_renamed_and_written_from_the_window() {
    let folder = tempfile::tempdir().unwrap();
    let mut harness = open(folder.path());
    click(&mut harness, "Volume display");
    click_last(&mut harness, "Cut-outs");
    let shown = |harness: &Driven| state(harness).session.as_ref().unwrap().view.scene.media.cut_outs[0].volume.clone();
    let scene = state(&harness).session.as_ref().unwrap().view.scene.clone();
    let add = Command::AddScene(AddScene { name: "front".into(), scene });
    act(&mut harness, Action::Apply(Box::new(add)));
    wait(&mut harness, "the scene is saved", |harness| document(harness).scenes.len() == 1);
    click(&mut harness, "Data");
    click_last(&mut harness, "seismic");
    // The last one is that of the scene.
    harness.get_all_by_label("Rename").next().unwrap().click_accesskit();
    harness.run_steps(2);
    harness.key_press_modifiers(Modifiers::COMMAND, Key::A);
    harness.get_by_label("New name").type_text("Full stack");
    harness.run_steps(2);
    harness.key_press(Key::Enter);
    wait(&mut harness, "it has its name", |harness| document(harness).volumes[0].name == "Full stack");
    assert_eq!(shown(&harness), "Full stack");
    assert_eq!(document(&harness).scenes[0].scene.media.cut_outs[0].volume, "Full stack");
    wait(&mut harness, "it is drawn", |harness| harness.state().as_ref().unwrap().is_settled());
    assert!(state(&harness).notices.iter().all(|notice| !notice.failed), "{:?}", state(&harness).notices);
    click(&mut harness, "Undo");
    wait(&mut harness, "it has its old name", |harness| document(harness).volumes[0].name == "seismic");
    assert_eq!(shown(&harness), "seismic");
    click_last(&mut harness, "seismic");
    click_last(&mut harness, "Export…");
    harness.get_by_label("Export volume seismic");
    choose(&mut harness, "Format", "int16");
    let out = folder.path().join("out.sgy");
    type_path(&mut harness, &out);
    click_last(&mut harness, "Export");
    wait(&mut harness, "it is written", |harness| out.exists() && state(harness).dialogue.is_none());
    let options = files::segy::SegyOptions::default();
    let info = files::segy::scan(&out, &options, &survey::Progress::silent()).unwrap();
    let size = document(&harness).geometry.unwrap().size();
    assert_eq!((info.format_code, [info.inlines.count, info.crosslines.count, info.samples]), (3, size));
}

/// A name typed for a fault is followed by its sticks, and a horizon from a file has a colour to choose.
#[test]
fn faults_are_renamed_and_imported_horizons_coloured() {
    let folder = tempfile::tempdir().unwrap();
    let mut harness = with_fault(folder.path());
    click_last(&mut harness, "East");
    click_last(&mut harness, "Rename");
    harness.key_press_modifiers(Modifiers::COMMAND, Key::A);
    harness.get_by_label("New name").type_text("Border");
    harness.run_steps(2);
    harness.key_press(Key::Enter);
    wait(&mut harness, "it has its name", |harness| document(harness).faults[0].name == "Border");
    assert_eq!(document(&harness).sticks[0].fault, "Border");
    click_last(&mut harness, "Colour of Top");
    click_last(&mut harness, "Colour 12");
    let chosen = Some(ttf::Colour::new(0x30, 0x30, 0x30));
    wait(&mut harness, "it has its colour", |harness| document(harness).horizons[0].own_colour() == chosen);
    // A fault too, which its lines and sticks are drawn in.
    assert_eq!(document(&harness).faults[0].ink(), ttf::Colour::BLACK);
    click_last(&mut harness, "Colour of fault Border");
    click_last(&mut harness, "Colour 10");
    let red = ttf::Colour::new(0xc0, 0x18, 0x2c);
    wait(&mut harness, "the fault has its colour", |harness| document(harness).faults[0].ink() == red);
}

#[test]
fn a_well_is_hidden_in_the_scene() {
    let folder = tempfile::tempdir().unwrap();
    let mut harness = open(folder.path());
    let deviation = folder.path().join("w.csv");
    std::fs::write(&deviation, "md_m,x_m,y_m,tvdss_m\n0,50,50,0\n30,50,50,30\n").unwrap();
    let files = files::well::WellFiles { deviation, ..Default::default() };
    let well = AddWell { name: "W".to_owned(), files, options: Default::default() };
    applied(&mut harness, &Command::AddWell(well));
    click(&mut harness, "Data");
    let hidden = |harness: &Driven| state(harness).session.as_ref().unwrap().view.scene.hidden_wells.clone();
    click_last(&mut harness, "Show well W");
    assert_eq!(hidden(&harness), ["W"]);
    click_last(&mut harness, "Show well W");
    assert!(hidden(&harness).is_empty());
    // Its path has a colour of its own.
    click_last(&mut harness, "Colour of well W");
    click_last(&mut harness, "Colour 10");
    let red = Some(ttf::Colour::new(0xc0, 0x18, 0x2c));
    wait(&mut harness, "it has its colour", |harness| document(harness).wells[0].colour == red);
    // It stays hidden under another name.
    click_last(&mut harness, "Show well W");
    click_last(&mut harness, "W");
    click_last(&mut harness, "Rename");
    harness.key_press_modifiers(Modifiers::COMMAND, Key::A);
    harness.get_by_label("New name").type_text("F02-1");
    harness.run_steps(2);
    harness.key_press(Key::Enter);
    wait(&mut harness, "it has its name", |harness| document(harness).wells[0].name == "F02-1");
    assert_eq!(hidden(&harness), ["F02-1"]);
}

#[test]
fn a_horizon_is_hidden_and_shown_again() {
    let folder = tempfile::tempdir().unwrap();
    let mut harness = open(folder.path());
    click(&mut harness, "Data");
    let is_hidden =
        |harness: &Driven| state(harness).session.as_ref().unwrap().view.hidden.has(SurfaceKind::Horizon, "Top");
    click_last(&mut harness, "Show horizon Top");
    assert!(is_hidden(&harness));
    click_last(&mut harness, "Show horizon Top");
    assert!(!is_hidden(&harness));
    // What is removed is not remembered as hidden.
    click_last(&mut harness, "Show horizon Top");
    let removes: Vec<_> = harness.query_all_by_label("Remove").collect();
    assert_eq!(removes[1].accesskit_node().label().as_deref(), Some("Remove"));
    removes[1].click_accesskit();
    harness.run_steps(2);
    wait(&mut harness, "it is gone", |harness| document(harness).horizons.len() == 1);
    assert!(!is_hidden(&harness));
}

/// A row of tabs wider than the panel pushed the buttons at its right edge out of sight.
#[test]
fn tabs_and_the_buttons_of_rows_lie_inside_the_panel() {
    let folder = tempfile::tempdir().unwrap();
    let mut harness = open(folder.path());
    click(&mut harness, "Data");
    let tab = harness.get_by_label("Interpret").rect().right();
    let rows: Vec<f32> = harness.query_all_by_label("Remove").map(|button| button.rect().right()).collect();
    // As wide as the panel is when a window opens.
    let panel = 316.0;
    assert!(tab < panel && rows.len() > 2 && rows.iter().all(|right| *right < panel), "{tab} {rows:?}");
}

/// While a picture is drawn the foot says so, until it is sharp.
#[test]
fn a_picture_that_is_being_drawn_is_said_to_be() {
    let folder = tempfile::tempdir().unwrap();
    let mut harness = open(folder.path());
    assert!(harness.query_by_label("Drawing…").is_none());
    click(&mut harness, "From above");
    harness.get_by_label("Drawing…");
    wait(&mut harness, "it is sharp", |harness| harness.state().as_ref().unwrap().is_settled());
    assert!(harness.query_by_label("Drawing…").is_none());
}
