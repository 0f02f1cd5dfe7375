//! The panels and commands that the other tests leave out: each is used by its label and checked in the project.

use super::driven::{Driven, click, document, open, state, wait};
use super::picking::{picking, press};
use eframe::egui::{Key, Modifiers, Pos2, Rect, vec2};
use egui_kittest::kittest::{NodeT, Queryable};
use glam::DVec3;
use interp::faults::{Proposal, ProposeSettings};
use project::Project;
use project::command::{Command, PickFault, ProposeFaults, SetLayer};
use project::interpretation::proposals::{self, Proposals};
use state::{Action, ChosenFault, Dialogue, FaultStep, FileContent, Panel, PickingStep, Tool};
use survey::{Contact, Progress, TriangleMesh};

pub(crate) fn act(harness: &mut Driven, action: Action) {
    harness.state_mut().as_mut().unwrap().act(action);
    harness.run_steps(3);
}

/// Applies a command as another process would, and has the window read the project again.
pub(crate) fn applied(harness: &mut Driven, command: &Command) {
    let root = state(harness).session.as_ref().unwrap().root.clone();
    Project::open(&root).unwrap().apply(command, &Progress::silent()).unwrap();
    act(harness, Action::Open(root));
    let step = document(harness).step;
    wait(harness, "the window has read it", |harness| {
        state(harness).session.as_ref().is_some_and(|session| session.document.step == step)
    });
}

/// Chooses an entry of a list that opens under a label, by the pointer, whose click closes the list.
pub(crate) fn choose(harness: &mut Driven, list: &str, entry: &str) {
    click_last(harness, list);
    harness.get_by_label(entry).click();
    harness.run_steps(3);
}

/// Clicks the last of the buttons with a label.
pub(crate) fn click_last(harness: &mut Driven, label: &str) {
    // As a screen reader does, whether it is scrolled into view or not.
    harness.query_all_by_label(label).last().unwrap().click_accesskit();
    harness.run_steps(3);
}

fn fault() -> Command {
    let stick = |crossline: f64| vec![[9.0, crossline, 4.0], [13.0, crossline, 120.0]];
    Command::PickFault(PickFault { name: "East".into(), sticks: vec![stick(2.0), stick(18.0)] })
}

/// Two proposals and a minor one for the present horizons, as proposing faults leaves them.
fn proposed(project: &mut Project) {
    let mesh = |x: f64| {
        let corner = |y: f64, z: f64| DVec3::new(x + z, y, z);
        let vertices = vec![corner(-50.0, 0.0), corner(550.0, 0.0), corner(550.0, 124.0), corner(-50.0, 124.0)];
        TriangleMesh { vertices, triangles: vec![[0, 1, 2], [0, 2, 3]] }
    };
    let proposal = |id: u32, x: f64| Proposal {
        id,
        name: format!("Fault {id}"),
        mesh: mesh(x),
        strike_deg: 0.0,
        dip_deg: 45.0,
        reverse: false,
        throw: [12.0, 16.0],
        ends: [[x / 25.0, 1.0], [x / 25.0, 20.0]],
        depth: [0.0, 124.0],
        horizons: vec!["Top".into()],
        support: 40,
        misfit_m: 3.0,
        offset_m2: 6000.0,
        area_m2: 60_000.0,
        evidence: None,
        is_minor: id == 3,
        is_cut: false,
        semblance: None,
    };
    let horizons = project.document().horizons.iter().map(|entry| entry.hash.clone()).collect();
    let listed = vec![proposal(1, 150.0), proposal(2, 350.0), proposal(3, 450.0)];
    let found = Proposals { horizons, proposals: listed, repeats: Vec::new(), unit: "ms".into() };
    std::fs::create_dir_all(project.root().join("derived")).unwrap();
    // Proposals that exist already are not made again.
    let path = proposals::path(project.root(), project.document(), &ProposeSettings::default());
    std::fs::write(path, serde_json::to_string(&found).unwrap()).unwrap();
    project.apply(&Command::ProposeFaults(ProposeFaults::default()), &Progress::silent()).unwrap();
}

#[test]
fn proposed_faults_are_accepted_and_dismissed() {
    let folder = tempfile::tempdir().unwrap();
    let root = super::driven::project(folder.path());
    proposed(&mut Project::open(&root).unwrap());
    let mut harness = super::driven::driven(folder.path(), Some(root));
    wait(&mut harness, "the project is open", |harness| state(harness).session.is_some());
    click(&mut harness, "Interpret");
    wait(&mut harness, "both are listed", |harness| harness.query_all_by_label_contains("Proposal").count() == 2);
    harness.get_by_label("Name of proposal 1");
    click(&mut harness, "1 minor proposal");
    assert_eq!(harness.query_all_by_label_contains("Proposal").count(), 3);
    click(&mut harness, "1 minor proposal");
    click_last(&mut harness, "Dismiss");
    assert_eq!(harness.query_all_by_label_contains("Proposal").count(), 1);
    assert_eq!(state(&harness).session.as_ref().unwrap().view.picking.dismissed, [2]);
    click_last(&mut harness, "Go");
    assert_eq!(state(&harness).session.as_ref().unwrap().view.slices[0], 5.0);
    click_last(&mut harness, "Accept");
    wait(&mut harness, "the fault is there", |harness| document(harness).faults.len() == 1);
    assert_eq!(document(&harness).faults[0].name, "Fault 1");
    wait(&mut harness, "it is no proposal any more", |harness| {
        harness.query_all_by_label_contains("Proposal").count() == 0
    });
    // Proposing again makes another list, in which nothing is dismissed; flat horizons have no offset.
    click_last(&mut harness, "Propose faults");
    assert!(state(&harness).session.as_ref().unwrap().view.picking.dismissed.is_empty());
    wait(&mut harness, "it is said that there are none", |harness| !state(harness).notices.is_empty());
    assert!(state(&harness).notices[0].text.contains("no fault is proposed"), "{:?}", state(&harness).notices);
}

/// A place of the crossline section: inline index and sample of the test survey of 24 by 20 traces and 32 samples.
fn on_crossline(harness: &Driven, inline: f32, sample: f32) -> Pos2 {
    let whole = harness.get_by_label("Crossline section").rect();
    let body = Rect::from_min_max(whole.min + vec2(52.0, 20.0), whole.max - vec2(13.0, 4.0));
    body.min + vec2(inline / 23.0, sample / 31.0) * body.size()
}

#[test]
fn faults_are_chosen_on_sections_accepted_cut_and_merged() {
    let folder = tempfile::tempdir().unwrap();
    let root = super::driven::project(folder.path());
    proposed(&mut Project::open(&root).unwrap());
    let mut harness = super::driven::driven(folder.path(), Some(root));
    wait(&mut harness, "the project is open", |harness| state(harness).session.is_some());
    click(&mut harness, "Interpret");
    wait(&mut harness, "both are listed", |harness| harness.query_all_by_label_contains("Proposal").count() == 2);
    click(&mut harness, "Sections");
    harness.key_press_modifiers(Modifiers::SHIFT, Key::F);
    harness.run_steps(3);
    assert_eq!(picking(&harness).tool, Tool::Faults);
    // Both dip by one metre a millisecond; halfway down they are at 212 m and 412 m.
    let at = on_crossline(&harness, 212.0 / 25.0, 15.5);
    press(&mut harness, at, Modifiers::NONE);
    assert_eq!(picking(&harness).faults, [ChosenFault::Proposed(1, "Fault 1".into())]);
    let at = on_crossline(&harness, 412.0 / 25.0, 15.5);
    press(&mut harness, at, Modifiers::SHIFT);
    assert_eq!(picking(&harness).faults.len(), 2);
    // Two that run side by side are two: they are accepted, and not merged.
    harness.key_press_modifiers(Modifiers::SHIFT, Key::M);
    wait(&mut harness, "it is refused", |harness| {
        state(harness).notices.iter().any(|notice| notice.text.contains("run side by side"))
    });
    let named = |harness: &Driven| document(harness).faults.iter().map(|fault| fault.name.clone()).collect::<Vec<_>>();
    assert_eq!(named(&harness), ["Fault 1", "Fault 2"]);
    wait(&mut harness, "neither is proposed any more", |harness| {
        harness.query_all_by_label_contains("Proposal").count() == 0
    });
    // Alt and a click cuts; the parts continue one another.
    let at = on_crossline(&harness, 212.0 / 25.0, 15.5);
    press(&mut harness, at, Modifiers::ALT);
    wait(&mut harness, "it is in two", |harness| named(harness).len() == 3);
    wait(&mut harness, "both are drawn", |harness| {
        harness.state().as_ref().unwrap().is_settled() && harness.query_by_label("Fault 1 2").is_some()
    });
    act(
        &mut harness,
        Action::Picking(PickingStep::Fault(FaultStep::Choose(ChosenFault::Present("Fault 1".into()), false))),
    );
    act(
        &mut harness,
        Action::Picking(PickingStep::Fault(FaultStep::Choose(ChosenFault::Present("Fault 1 2".into()), true))),
    );
    click(&mut harness, "Merge");
    wait(&mut harness, "it is one", |harness| named(harness).len() == 2);
    // What was accepted and changed is no proposal again.
    wait(&mut harness, "the window is at rest", |harness| harness.state().as_ref().unwrap().is_settled());
    assert_eq!(harness.query_all_by_label_contains("Proposal").count(), 0);
    act(&mut harness, Action::Picking(PickingStep::Fault(FaultStep::Edit("Fault 2".into()))));
    wait(&mut harness, "it has sticks", |harness| {
        document(harness).sticks.iter().any(|drawn| drawn.fault == "Fault 2" && drawn.sticks.len() > 10)
    });
    assert_eq!((picking(&harness).tool, picking(&harness).fault.as_str()), (Tool::Sticks, "Fault 2"));
    act(&mut harness, Action::Picking(PickingStep::Use(Tool::Faults)));
    act(
        &mut harness,
        Action::Picking(PickingStep::Fault(FaultStep::Choose(ChosenFault::Present("Fault 2".into()), false))),
    );
    harness.key_press(Key::Delete);
    wait(&mut harness, "it is gone", |harness| named(harness) == ["Fault 1"]);
}

#[test]
fn data_are_renamed_removed_and_given_a_velocity() {
    let folder = tempfile::tempdir().unwrap();
    let mut harness = open(folder.path());
    applied(&mut harness, &fault());
    click(&mut harness, "Data");
    click(&mut harness, "Base");
    click(&mut harness, "Rename");
    harness.get_by_label("New name").type_text("ment");
    harness.run_steps(2);
    harness.key_press(Key::Enter);
    wait(&mut harness, "the horizon has another name", |harness| document(harness).horizons[1].name.contains("ment"));
    harness.get_by_label("East");
    harness.get_by_label("Extent of fault East").focus();
    harness.run_steps(2);
    for _ in 0..3 {
        harness.key_press(Key::ArrowUp);
        harness.run_steps(2);
    }
    harness.key_press(Key::Tab);
    wait(&mut harness, "the fault reaches farther", |harness| document(harness).faults[0].grown_m > 0.0);
    // Volume, two horizons, the fault.
    harness.query_all_by_label("Remove").nth(3).unwrap().click_accesskit();
    wait(&mut harness, "the fault is gone", |harness| document(harness).faults.is_empty());
    harness.query_all_by_label("Velocity").last().unwrap().focus();
    harness.run_steps(2);
    harness.key_press(Key::ArrowUp);
    harness.run_steps(2);
    harness.key_press(Key::Tab);
    wait(&mut harness, "the velocity is another", |harness| {
        document(harness).geometry.as_ref().is_some_and(|geometry| geometry.velocity_m_s != 2000.0)
    });
    harness.query_all_by_label("Remove").next().unwrap().click_accesskit();
    wait(&mut harness, "the volume is gone", |harness| document(harness).volumes.is_empty());
}

#[test]
fn a_fault_comes_in_through_its_dialogue() {
    let folder = tempfile::tempdir().unwrap();
    let mut harness = open(folder.path());
    let path = folder.path().join("west.csv");
    let mut text = "x,y,z\n".to_owned();
    for (n, y) in [0.0, 150.0, 300.0, 450.0].into_iter().enumerate() {
        for z in [0.0, 40.0, 80.0, 120.0] {
            text += &format!("{},{y},{z}\n", 250.0 + z + n as f64);
        }
    }
    std::fs::write(&path, text).unwrap();
    act(&mut harness, Action::Ask(Box::new(Dialogue::Interpretation { path, kind: FileContent::Fault })));
    for label in ["Name", "Vertical unit", "Sign", "Factor", "Ends at"] {
        assert!(harness.query_all_by_label(label).count() > 0, "{label}");
    }
    wait(&mut harness, "the file is read", |harness| {
        harness.query_by_label("Add").is_some_and(|add| !add.accesskit_node().is_disabled())
    });
    click(&mut harness, "Add");
    wait(&mut harness, "the fault is there", |harness| document(harness).faults.len() == 1);
    wait(&mut harness, "the dialogue has gone", |harness| state(harness).dialogue.is_none());
}

#[test]
fn contacts_beds_and_default_styles_are_set_in_the_column() {
    let folder = tempfile::tempdir().unwrap();
    let mut harness = open(folder.path());
    choose(&mut harness, "Contact of Base", "erosional");
    wait(&mut harness, "the contact is set", |harness| document(harness).horizons[1].contact == Contact::Erosional);
    click(&mut harness, "Layer Top - Base");
    choose(&mut harness, "Beds", "parallel to the base");
    wait(&mut harness, "the beds are set", |harness| !document(harness).k.is_empty());
    wait(&mut harness, "the window knows", |harness| !state(harness).session.as_ref().unwrap().document.k.is_empty());
    click(&mut harness, "Default style");
    wait(&mut harness, "they are as they were", |harness| document(harness).k.is_empty());
}

#[test]
fn layers_that_look_alike_are_told_with_a_button_that_helps_and_presets_are_chosen() {
    let folder = tempfile::tempdir().unwrap();
    let mut harness = open(folder.path());
    for layer in ["Top - Base", "below Base"] {
        let (colour, pattern) = (Some(ttf::Colour::new(200, 180, 120)), Some("sand".to_owned()));
        let look = SetLayer { layer: layer.to_owned(), colour, pattern, ..SetLayer::default() };
        applied(&mut harness, &Command::SetLayer(look));
    }
    let is_told = |harness: &Driven| harness.query_by_label("Hard to tell apart").is_some();
    act(&mut harness, Action::Panel(Panel::Layers));
    wait(&mut harness, "it is told", is_told);
    let told = "Top - Base and below Base are neighbours and cannot be told apart";
    assert_eq!(harness.query_all_by_label_contains(told).count(), 1);
    harness.get_by_label_contains("Give below Base").click_accesskit();
    wait(&mut harness, "nothing looks alike", |harness| !is_told(harness));
    choose(&mut harness, "Print in", "greyscale");
    wait(&mut harness, "the scene is printed in grey", |harness| {
        state(harness).session.as_ref().unwrap().view.scene.preset == ttf::Preset::Greyscale
    });
}

#[test]
fn raw_colours_and_textures_by_value_are_changed_and_taken_away() {
    let folder = tempfile::tempdir().unwrap();
    let mut harness = open(folder.path());
    click(&mut harness, "Volume display");
    choose(&mut harness, "Colours", "grey");
    wait(&mut harness, "the colours are set", |harness| document(harness).style.raw.is_some());
    click(&mut harness, "Textures by seismic");
    wait(&mut harness, "the textures are there", |harness| document(harness).style.scalars.len() == 1);
    wait(&mut harness, "they are listed", |harness| harness.query_by_label("Opacity of seismic 1").is_some());
    harness.get_by_label("Repeats along of seismic 1");
    click(&mut harness, "Split");
    wait(&mut harness, "there are two", |harness| document(harness).style.scalars[0].intervals.len() == 2);
    wait(&mut harness, "both are listed", |harness| harness.query_by_label("Opacity of seismic 2").is_some());
    harness.query_all_by_label("Remove").next().unwrap().click_accesskit();
    wait(&mut harness, "they are gone", |harness| document(harness).style.scalars.is_empty());
}

#[test]
fn a_tile_of_ones_own_is_added_and_a_scene_comes_and_goes() {
    let folder = tempfile::tempdir().unwrap();
    let mut harness = open(folder.path());
    let tile = folder.path().join("dots.png");
    image::RgbaImage::from_pixel(8, 8, image::Rgba([9, 9, 9, 255])).save(&tile).unwrap();
    act(&mut harness, Action::Ask(Box::new(Dialogue::Choose(state::Choice::Texture))));
    harness.get_by_label("Path").focus();
    harness.step();
    harness.key_press_modifiers(Modifiers::COMMAND, Key::A);
    harness.get_by_label("Path").type_text(&tile.display().to_string());
    harness.run_steps(2);
    click(&mut harness, "Add");
    wait(&mut harness, "the tile is there", |harness| document(harness).textures.len() == 1);
    harness.get_by_label("Scene name").focus();
    harness.step();
    harness.get_by_label("Scene name").type_text("plan");
    harness.run_steps(2);
    click_last(&mut harness, "Save scene");
    wait(&mut harness, "the view is kept", |harness| document(harness).scenes.len() == 1);
    click_last(&mut harness, "Rename");
    harness.key_press_modifiers(Modifiers::COMMAND, Key::A);
    harness.get_by_label("New name").type_text("map");
    harness.run_steps(2);
    harness.key_press(Key::Enter);
    wait(&mut harness, "it has its name", |harness| document(harness).scenes[0].name == "map");
    wait(&mut harness, "it is listed", |harness| harness.query_by_label("map").is_some());
    click_last(&mut harness, "Remove");
    wait(&mut harness, "it is gone", |harness| document(harness).scenes.is_empty());
}

#[test]
fn a_well_is_listed_and_removed() {
    let folder = tempfile::tempdir().unwrap();
    let mut harness = open(folder.path());
    let deviation = folder.path().join("W-1.csv");
    std::fs::write(&deviation, "md_m,x_m,y_m,tvdss_m\n0,250,250,0\n40,250,250,40\n100,260,250,99\n").unwrap();
    act(&mut harness, Action::Ask(Box::new(Dialogue::Well { path: deviation })));
    for label in ["Name", "Tops", "Logs", "Checkshots", "Datum above sea level, m", "Lengths along the well"] {
        assert!(harness.query_all_by_label(label).count() > 0, "{label}");
    }
    wait(&mut harness, "the files are read", |harness| {
        harness.query_by_label("Add").is_some_and(|add| !add.accesskit_node().is_disabled())
    });
    click(&mut harness, "Add");
    wait(&mut harness, "the well is there", |harness| document(harness).wells.len() == 1);
    act(&mut harness, Action::Panel(Panel::Data));
    wait(&mut harness, "it is listed", |harness| harness.query_by_label("W-1").is_some());
    click_last(&mut harness, "Remove");
    wait(&mut harness, "it is gone", |harness| document(harness).wells.is_empty());
}

#[test]
fn what_is_on_the_screen_is_exported_while_interpreting() {
    let folder = tempfile::tempdir().unwrap();
    let mut harness = open(folder.path());
    let export = |harness: &mut Driven, name: &str| {
        let path = folder.path().join(name);
        let form =
            state::ExportForm { size_cm: [10.0, 7.0], dpi: 60.0, ..state::ExportForm::new(path.display().to_string()) };
        act(harness, Action::Export(Box::new(form)));
        wait(harness, "it is written", |_| path.exists());
        image::open(&path).unwrap().to_rgb8()
    };
    let illustrated = export(&mut harness, "illustrated.png");
    click(&mut harness, "Interpret");
    act(&mut harness, Action::Picking(PickingStep::Look(state::Look::Faces)));
    wait(&mut harness, "the horizons are read", |harness| harness.query_all_by_label_contains("%").count() > 0);
    let faces = export(&mut harness, "faces.png");
    act(&mut harness, Action::Arrange(state::Layout::Sections));
    let sections = export(&mut harness, "sections.png");
    act(&mut harness, Action::Arrange(state::Layout::Map));
    let map = export(&mut harness, "map.png");
    act(&mut harness, Action::Picking(PickingStep::Look(state::Look::VolumeRendering)));
    let through = export(&mut harness, "through.png");
    let all = [&illustrated, &faces, &sections, &map, &through];
    for (n, picture) in all.iter().enumerate() {
        assert!(all[..n].iter().all(|other| other != picture), "picture {n} is as one before");
        assert_eq!(picture.get_pixel(230, 160).0, [255; 3], "paper in the corner of picture {n}");
    }
}
