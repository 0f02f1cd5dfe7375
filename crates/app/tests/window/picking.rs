//! Interpreting in the window, by labels, keys and clicks: what is done becomes the commands that the command line
//! gives.

use super::driven::{Driven, click, document, driven, project, state, wait};
use eframe::egui::{Event, Key, Modifiers, PointerButton, Pos2, pos2, vec2};
use egui_kittest::kittest::{NodeT, Queryable};
use glam::DVec3;
use interp::ExtractSettings;
use interp::assembly::Operation;
use project::Project;
use project::command::{Climb, Command, Extract, PickNode};
use state::{Action, How, Layout, Panel, PickingStep, Tool};
use std::path::Path;
use survey::Progress;

/// Leaves small enough that surfaces of 24 × 20 traces have several.
const LEAF: u32 = 80;

fn extract(project: &mut Project, settings: &ExtractSettings) {
    let extract = Extract { volume: None, settings: settings.clone(), memory_bytes: None, just_stored: false };
    project.apply(&Command::Extract(extract), &Progress::silent()).unwrap();
}

/// A window on a project with candidates, its interpretation read.
pub(crate) fn interpreting(folder: &Path) -> Driven {
    let root = project(folder);
    let mut settings = ExtractSettings::default();
    settings.forest.min_leaf_triangles = LEAF;
    extract(&mut Project::open(&root).unwrap(), &settings);
    let mut harness = driven(folder, Some(root));
    wait(&mut harness, "the project is open", |harness| state(harness).session.is_some());
    click(&mut harness, "Interpret");
    wait(&mut harness, "the candidates are read", |harness| {
        harness.query_by_label_contains("surfaces,").is_some() && harness.state().as_ref().unwrap().is_settled()
    });
    harness
}

pub(crate) fn act(harness: &mut Driven, step: PickingStep) {
    harness.state_mut().as_mut().unwrap().act(Action::Picking(step));
    harness.run_steps(2);
}

pub(crate) fn picking(harness: &Driven) -> &state::Picking {
    &state(harness).session.as_ref().unwrap().view.picking
}

/// A click into the middle of what has a label, moved by points.
pub(crate) fn click_in(harness: &mut Driven, label: &str, off: [f32; 2], modifiers: Modifiers) {
    let at = harness.get_by_label(label).rect().center() + vec2(off[0], off[1]);
    press(harness, at, modifiers);
}

pub(crate) fn press(harness: &mut Driven, at: Pos2, modifiers: Modifiers) {
    harness.event(Event::PointerMoved(at));
    harness.run_steps(2);
    for pressed in [true, false] {
        harness.event_modifiers(
            Event::PointerButton { pos: at, button: PointerButton::Primary, pressed, modifiers },
            modifiers,
        );
        harness.run_steps(1);
    }
    harness.run_steps(2);
}

/// A voxel on a strong reflection of the test survey, sin(0.7 z): its first trough is at z = 3π/2/0.7.
pub(crate) fn on_a_trough() -> DVec3 {
    DVec3::new(12.0, 10.0, 1.5 * std::f64::consts::PI / 0.7)
}

#[test]
fn candidates_are_extracted_from_the_panel() {
    let folder = tempfile::tempdir().unwrap();
    let root = project(folder.path());
    let mut harness = driven(folder.path(), Some(root.clone()));
    wait(&mut harness, "the project is open", |harness| state(harness).session.is_some());
    harness.key_press(Key::P);
    harness.run_steps(3);
    assert_eq!(state(&harness).session.as_ref().unwrap().view.panel, Panel::Interpret);
    click(&mut harness, "Settings");
    for label in
        ["Minimum front width", "Fault evidence", "Join pieces from", "Minimum leaf size", "Maximum distance", "Peaks"]
    {
        assert!(harness.query_all_by_label(label).count() > 0, "{label}");
    }
    click(&mut harness, "Extract");
    wait(&mut harness, "the surfaces are counted", |harness| harness.query_by_label_contains("surfaces,").is_some());
    assert!(project::interpretation::extraction::present_path(&root).exists());
    harness.get_by_label("Extract again");
}

#[test]
fn a_click_on_a_section_selects_climbs_and_becomes_a_horizon_as_the_command_makes_it() {
    let folder = tempfile::tempdir().unwrap();
    let mut harness = interpreting(folder.path());
    click(&mut harness, "Sections");
    assert_eq!(state(&harness).session.as_ref().unwrap().view.layout, Layout::Sections);
    harness.run_steps(3);
    click_in(&mut harness, "Inline section", [20.0, 10.0], Modifiers::NONE);
    wait(&mut harness, "a leaf is selected", |harness| picking(harness).pick.is_some());
    assert_eq!(picking(&harness).horizon.as_deref(), Some("Horizon 1"));
    let levels = picking(&harness).pick.as_ref().unwrap().levels;
    assert!(levels > 0);
    harness.key_press(Key::ArrowUp);
    harness.run_steps(2);
    assert_eq!(picking(&harness).pick.as_ref().unwrap().up, 1);
    wait(&mut harness, "the node is described", |harness| harness.query_all_by_label_contains("triangles").count() > 0);
    harness.key_press(Key::ArrowDown);
    harness.run_steps(2);
    harness.key_press(Key::H);
    wait(&mut harness, "it is as high as can be", |harness| {
        picking(harness).pick.as_ref().is_some_and(|pick| pick.up == levels)
    });
    let pick = picking(&harness).pick.clone().unwrap();
    harness.key_press(Key::Enter);
    wait(&mut harness, "the horizon is there", |harness| document(harness).horizons.len() == 3);
    wait(&mut harness, "nothing is selected", |harness| harness.query_by_label_contains("nodes on").is_some());

    // The same by the command, on a project of its own.
    let other = tempfile::tempdir().unwrap();
    let root = project(other.path());
    let mut settings = ExtractSettings::default();
    settings.forest.min_leaf_triangles = LEAF;
    let quiet = Progress::silent();
    let mut by_command = Project::open(&root).unwrap();
    extract(&mut by_command, &settings);
    let command = PickNode {
        at: pick.at,
        horizon: "Horizon 1".into(),
        operation: Operation::Add,
        colour: None,
        climb: Climb::HighestValid,
    };
    by_command.apply(&Command::Pick(command), &quiet).unwrap();
    assert_eq!(document(&harness).horizons[1], by_command.document().horizons[1]);

    // Undo takes it back, redo brings it again.
    harness.key_press_modifiers(Modifiers::COMMAND, Key::Z);
    wait(&mut harness, "it is taken back", |harness| document(harness).horizons.len() == 2);
}

#[test]
fn a_click_where_nothing_is_near_says_so() {
    let folder = tempfile::tempdir().unwrap();
    let root = project(folder.path());
    let distance = interp::DistanceSettings { max_distance: 1.0 };
    let settings = ExtractSettings { distance, ..ExtractSettings::default() };
    extract(&mut Project::open(&root).unwrap(), &settings);
    let mut harness = driven(folder.path(), Some(root));
    wait(&mut harness, "the project is open", |harness| state(harness).session.is_some());
    click(&mut harness, "Interpret");
    wait(&mut harness, "candidates are read", |harness| harness.query_by_label_contains("surfaces,").is_some());
    // A zero crossing between trough and peak.
    let voxel = DVec3::new(12.0, 10.0, 2.0 * std::f64::consts::PI / 0.7);
    act(&mut harness, PickingStep::At(voxel, How::Replace));
    wait(&mut harness, "it is said", |harness| !state(harness).notices.is_empty());
    let notice = &state(&harness).notices[0];
    assert!(notice.failed && notice.text.contains("candidate"), "{notice:?}");
    assert!(picking(&harness).pick.is_none());
}

#[test]
fn shift_adds_alt_takes_out_and_the_pick_list_moves_and_takes_back() {
    let folder = tempfile::tempdir().unwrap();
    let mut harness = interpreting(folder.path());
    act(&mut harness, PickingStep::At(on_a_trough(), How::Replace));
    wait(&mut harness, "a leaf is selected", |harness| picking(harness).pick.is_some());
    let first = picking(&harness).pick.clone().unwrap();
    let elsewhere = DVec3::new(3.0, 3.0, on_a_trough().z);
    act(&mut harness, PickingStep::At(elsewhere, How::Extend));
    wait(&mut harness, "the first is accepted", |harness| document(harness).horizons.len() == 3);
    wait(&mut harness, "another leaf is selected", |harness| {
        picking(harness).pick.as_ref().is_some_and(|pick| pick.leaf != first.leaf)
    });
    harness.key_press(Key::Enter);
    let log = |harness: &Driven| {
        let document = document(harness);
        let entry = document.horizons.iter().find(|entry| entry.name == "Horizon 1");
        entry.and_then(|entry| entry.assembly.clone()).map_or_else(Vec::new, |log| log.picks)
    };
    wait(&mut harness, "both are in the log", |harness| log(harness).len() == 2);
    wait(&mut harness, "the list shows them", |harness| harness.query_all_by_label("Unpick").count() == 2);
    harness.query_all_by_label("Up").next().unwrap().click_accesskit();
    harness.run_steps(2);
    wait(&mut harness, "the first pick is higher", |harness| log(harness)[0].up == 1);
    wait(&mut harness, "the list knows", |harness| harness.query_by_label("level 1").is_some());
    harness.query_all_by_label("Unpick").next().unwrap().click_accesskit();
    harness.run_steps(2);
    wait(&mut harness, "one pick is left", |harness| log(harness).len() == 1);
    // What is not part of the horizon cannot be taken out, and this is said.
    act(&mut harness, PickingStep::At(DVec3::new(22.0, 18.0, on_a_trough().z), How::Remove));
    wait(&mut harness, "it is said", |harness| !state(harness).notices.is_empty());
    assert!(state(&harness).notices[0].text.contains("contains nothing of"), "{:?}", state(&harness).notices);
}

#[test]
fn a_lasso_on_a_slice_erases_part_of_a_horizon_in_one_step() {
    let folder = tempfile::tempdir().unwrap();
    let mut harness = interpreting(folder.path());
    act(&mut harness, PickingStep::At(on_a_trough(), How::Replace));
    wait(&mut harness, "a leaf is selected", |harness| picking(harness).pick.is_some());
    let levels = picking(&harness).pick.as_ref().unwrap().levels;
    act(&mut harness, PickingStep::Climb(levels as i32));
    act(&mut harness, PickingStep::Accept);
    wait(&mut harness, "the horizon is there", |harness| document(harness).horizons.len() == 3);
    let nodes = |harness: &Driven| {
        let text = harness.query_by_label_contains("nodes on")?.accesskit_node().value()?;
        text.split(' ').next()?.parse::<usize>().ok()
    };
    wait(&mut harness, "its nodes are counted", |harness| nodes(harness).is_some());
    let before = (nodes(&harness).unwrap(), document(&harness).step);
    let z = on_a_trough().z.round();
    let corners = [[-1.0, -1.0], [12.0, -1.0], [12.0, 30.0], [-1.0, 30.0]].map(glam::DVec2::from_array).to_vec();
    let on = state::LassoOn::Section(state::SectionKind::Slice, z);
    act(&mut harness, PickingStep::Erase(state::Lasso { on, corners }));
    wait(&mut harness, "part of it is gone", |harness| nodes(harness).is_some_and(|now| now < before.0));
    assert_eq!(document(&harness).step, before.1 + 1);
    let told = harness.query_all_by_label_contains("farther than the lasso").count();
    assert_eq!(told, 1, "leaves across its edge stay, and that is said: {:?}", state(&harness).notices);
}

#[test]
fn a_fault_is_drawn_with_sticks_by_clicks_and_keys() {
    let folder = tempfile::tempdir().unwrap();
    let mut harness = interpreting(folder.path());
    click(&mut harness, "Sections");
    harness.run_steps(3);
    harness.key_press(Key::F);
    harness.run_steps(2);
    assert_eq!(picking(&harness).tool, Tool::Sticks);
    for slice in [6.0, 18.0] {
        harness.state_mut().as_mut().unwrap().act(Action::Slices([slice, 10.0, 16.0]));
        harness.run_steps(2);
        for (off, count) in [([-30.0, -60.0], 1), ([0.0, 0.0], 2), ([30.0, 60.0], 3)] {
            click_in(&mut harness, "Inline section", off, Modifiers::NONE);
            assert_eq!(picking(&harness).stick.len(), count);
        }
        harness.key_press(Key::Backspace);
        harness.run_steps(2);
        assert_eq!(picking(&harness).stick.len(), 2);
        harness.key_press(Key::Enter);
        harness.run_steps(2);
        assert!(picking(&harness).stick.is_empty());
    }
    // Between two sticks a third is suggested, which Enter takes.
    harness.state_mut().as_mut().unwrap().act(Action::Slices([12.0, 10.0, 16.0]));
    harness.run_steps(2);
    harness.get_by_label("Enter takes the dashed stick.");
    harness.key_press(Key::Enter);
    harness.run_steps(2);
    let sticks = picking(&harness).sticks.clone();
    assert_eq!(sticks.len(), 3);
    for n in 0..2 {
        assert!((sticks[2][n][0] - 0.5 * (sticks[0][n][0] + sticks[1][n][0])).abs() < 0.01, "{sticks:?}");
        assert!((sticks[2][n][2] - 0.5 * (sticks[0][n][2] + sticks[1][n][2])).abs() < 0.01, "{sticks:?}");
    }
    assert!(harness.query_by_label("Enter takes the dashed stick.").is_none());
    click(&mut harness, "Make fault");
    wait(&mut harness, "the fault is there", |harness| document(harness).faults.len() == 1);
    assert_eq!(document(&harness).sticks[0].sticks.len(), 3);
}

#[test]
fn a_new_horizon_is_named_coloured_and_a_selection_outlives_the_window() {
    let folder = tempfile::tempdir().unwrap();
    let mut harness = interpreting(folder.path());
    harness.key_press(Key::N);
    harness.run_steps(3);
    harness.get_by_label("Name of the new horizon").focus();
    harness.step();
    harness.key_press_modifiers(Modifiers::COMMAND, Key::A);
    harness.get_by_label("Name of the new horizon").type_text("Chalk");
    harness.run_steps(2);
    assert_eq!(picking(&harness).horizon.as_deref(), Some("Chalk"));
    act(&mut harness, PickingStep::Tint(ttf::Colour::new(1, 2, 3)));
    act(&mut harness, PickingStep::At(on_a_trough(), How::Replace));
    wait(&mut harness, "a leaf is selected", |harness| picking(harness).pick.is_some());
    // Written down at once, not only every few seconds; then the window is gone, as after a crash.
    harness.run_steps(2);
    let pick = picking(&harness).pick.clone();
    drop(harness);
    let mut next = driven(folder.path(), None);
    next.step();
    click(&mut next, "Continue");
    wait(&mut next, "the selection is back", |harness| {
        state(harness).session.as_ref().is_some_and(|session| session.view.picking.pick == pick)
    });
    next.key_press(Key::Enter);
    wait(&mut next, "it becomes the horizon", |harness| {
        document(harness).horizons.iter().any(|entry| entry.name == "Chalk")
    });
    let document = document(&next);
    let entry = document.horizons.iter().find(|entry| entry.name == "Chalk").unwrap();
    assert_eq!(entry.assembly.as_ref().unwrap().colour, ttf::Colour::new(1, 2, 3));
}

#[test]
fn a_key_switches_between_volume_rendering_and_faces() {
    let folder = tempfile::tempdir().unwrap();
    let mut harness = interpreting(folder.path());
    let is_clear = |harness: &Driven| {
        let scene = state::showing::scene(state(harness).session.as_ref().unwrap(), None);
        matches!(scene.media.shading, render::Shading::Occlusion(_))
    };
    assert!(is_clear(&harness));
    for expected in [false, true] {
        harness.key_press(Key::O);
        harness.run_steps(2);
        assert_eq!(is_clear(&harness), expected);
    }
    wait(&mut harness, "the picture is drawn", |harness| harness.state().as_ref().unwrap().is_settled());
    press(&mut harness, pos2(640.0, 420.0), Modifiers::NONE);
    assert!(state(&harness).notices.iter().all(|notice| !notice.failed), "{:?}", state(&harness).notices);
}

#[test]
fn corners_clicked_on_the_slice_make_a_fence_that_takes_picks() {
    let folder = tempfile::tempdir().unwrap();
    let mut harness = interpreting(folder.path());
    harness.key_press(Key::Num4);
    harness.run_steps(3);
    assert_eq!(state(&harness).session.as_ref().unwrap().view.layout, Layout::Fence);
    click_in(&mut harness, "Slice section", [-60.0, -80.0], Modifiers::NONE);
    click_in(&mut harness, "Slice section", [70.0, 20.0], Modifiers::NONE);
    click_in(&mut harness, "Slice section", [20.0, 90.0], Modifiers::NONE);
    assert_eq!(state(&harness).session.as_ref().unwrap().view.fence.len(), 3);
    wait(&mut harness, "the fence is cut", |harness| harness.query_by_label("Fence section").is_some());
    click(&mut harness, "Remove last corner");
    assert_eq!(state(&harness).session.as_ref().unwrap().view.fence.len(), 2);
    // What is clicked on the fence is picked as on any section.
    wait(&mut harness, "the shorter fence is cut", |harness| harness.query_by_label("Fence section").is_some());
    click_in(&mut harness, "Fence section", [10.0, 10.0], Modifiers::NONE);
    wait(&mut harness, "a leaf is selected", |harness| picking(harness).pick.is_some());
}

#[test]
fn a_well_comes_in_through_its_dialogue() {
    let folder = tempfile::tempdir().unwrap();
    let root = project(folder.path());
    let path = folder.path().join("W-1.csv");
    std::fs::write(&path, "md_m,x_m,y_m,tvdss_m\n0,250,250,0\n40,250,250,40\n100,260,250,99\n").unwrap();
    let mut harness = driven(folder.path(), Some(root));
    wait(&mut harness, "the project is open", |harness| state(harness).session.is_some());
    let ask = Action::Ask(Box::new(state::Dialogue::Well { path }));
    harness.state_mut().as_mut().unwrap().act(ask);
    wait(&mut harness, "the files are read", |harness| {
        harness.query_by_label("Add").is_some_and(|add| !add.accesskit_node().is_disabled())
    });
    click(&mut harness, "Add");
    wait(&mut harness, "the well is there", |harness| document(harness).wells.len() == 1);
    assert_eq!(document(&harness).wells[0].name, "W-1");
}

#[test]
fn going_back_to_the_layers_draws_without_complaint() {
    let folder = tempfile::tempdir().unwrap();
    let mut harness = interpreting(folder.path());
    assert!(state(&harness).session.as_ref().unwrap().view.scene.ground.is_some());
    click(&mut harness, "Layers");
    wait(&mut harness, "the picture is drawn", |harness| harness.state().as_ref().unwrap().is_settled());
    assert!(state(&harness).notices.is_empty(), "{:?}", state(&harness).notices);
}
