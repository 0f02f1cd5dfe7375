//! Panels and dialogues by their labels: every field has a name of its own, every hint names a field that is there.

use super::command::{act, applied, choose, click_last};
use super::driven::{Driven, click, document, driven, open, project, state, survey, wait};
use eframe::egui::accesskit::Role;
use eframe::egui::{Event, Key, Modifiers, PointerButton, vec2};
use egui_kittest::kittest::{NodeT, Queryable};
use project::command::{Command, SetLayer, SetScalar};
use render::Projection;
use state::{Action, Appearance, Choice, Dialogue, ExportForm, FileContent, Layout, Panel, PickingStep, Target, Tool};
use std::collections::HashSet;
use std::path::Path;
use ttf::{ScalarInterval, ScalarTtf};

/// Fields of a form.
const FIELDS: [Role; 6] =
    [Role::SpinButton, Role::Slider, Role::TextInput, Role::ComboBox, Role::CheckBox, Role::ColorWell];
/// What a field that is named after its unit is called.
const UNITS: [&str; 9] = ["m/s", "dpi", "ms", "traces", "triangles", "voxels", "cm", "as the file says", "level"];

fn ask(harness: &mut Driven, dialogue: Dialogue) {
    act(harness, Action::Ask(Box::new(dialogue)));
}

/// What is wrong with the names of the fields that are seen.
fn misnamed(harness: &Driven) -> Vec<String> {
    let mut known = HashSet::new();
    let mut wrong = Vec::new();
    for role in FIELDS {
        for node in harness.query_all_by_role(role) {
            let name = node.accesskit_node().label().unwrap_or_default();
            let is_word = name.chars().filter(|c| c.is_alphabetic()).count() > 1 || name == "X" || name == "Y";
            if !is_word || UNITS.contains(&name.trim()) || !known.insert((role, name.clone())) {
                wrong.push(format!("{role:?} {name:?}"));
            }
        }
    }
    assert!(!known.is_empty(), "nothing was looked at");
    wrong
}

/// All words on the screen.
fn words(harness: &Driven) -> Vec<String> {
    let nodes = harness.query_all_by_label_contains("").map(|node| node.accesskit_node());
    nodes.flat_map(|node| [node.label(), node.value()]).flatten().collect()
}

fn field_is_there(harness: &Driven, name: &str) -> bool {
    FIELDS.into_iter().any(|role| harness.query_all_by_role_and_label(role, name).count() > 0)
}

#[test]
fn every_field_of_a_panel_has_a_name_of_its_own() {
    let folder = tempfile::tempdir().unwrap();
    let mut harness = open(folder.path());
    let interval = |range: [f32; 2]| ScalarInterval {
        range,
        texture: "chalk".into(),
        factor: [1.0; 2],
        opacity: 1.0,
        colour: None,
        ink: None,
    };
    let function = ScalarTtf { volume: "seismic".into(), intervals: vec![interval([-1.0, 0.2]), interval([0.2, 0.9])] };
    applied(&mut harness, &Command::SetScalar(SetScalar { function }));
    let pattern = SetLayer { layer: "Top - Base".into(), pattern: Some("chalk".into()), ..SetLayer::default() };
    applied(&mut harness, &Command::SetLayer(pattern));
    click(&mut harness, "Layer Top - Base");
    for label in ["Split", "Own", "Ink"] {
        click_last(&mut harness, label);
        harness.run_steps(3);
    }
    wait(&mut harness, "the layer has two patterns", |harness| field_is_there(harness, "Base of pattern 2"));
    assert_eq!(misnamed(&harness), [""; 0], "layers");
    assert!(field_is_there(&harness, "Colour") && field_is_there(&harness, "Ink"));
    for panel in [Panel::Data, Panel::Values, Panel::Interpret] {
        act(&mut harness, Action::Panel(panel));
        if panel == Panel::Interpret {
            click_last(&mut harness, "Settings");
            act(&mut harness, Action::Picking(PickingStep::Begin));
            act(&mut harness, Action::Picking(PickingStep::Use(Tool::Sticks)));
            wait(&mut harness, "sticks can be drawn", |harness| field_is_there(harness, "Name of the fault"));
        }
        assert_eq!(misnamed(&harness), [""; 0], "{panel:?}");
    }
    for layout in [Layout::Sections, Layout::Map, Layout::Fence] {
        act(&mut harness, Action::Arrange(layout));
        assert_eq!(misnamed(&harness), [""; 0], "{layout:?}");
    }
}

#[test]
fn every_field_of_a_dialogue_has_a_name_of_its_own() {
    let folder = tempfile::tempdir().unwrap();
    let mut harness = open(folder.path());
    let path = folder.path().join("A.csv");
    std::fs::write(&path, "md_m,x_m,y_m,tvdss_m\n0,250,250,0\n40,250,250,40\n").unwrap();
    let form = ExportForm::new(folder.path().join("a.png").display().to_string());
    let survey = survey(folder.path());
    for dialogue in [
        Dialogue::Choose(Choice::Project),
        Dialogue::Survey { path: survey, target: Target::NewProject },
        Dialogue::Interpretation { path: path.clone(), kind: FileContent::Horizon },
        Dialogue::Interpretation { path: path.clone(), kind: FileContent::Fault },
        Dialogue::Well { path },
        Dialogue::Patterns { layer: "Top - Base".into(), interval: None },
        Dialogue::Export(form),
    ] {
        let name = format!("{dialogue:?}");
        let panels: Vec<String> = fields(&harness);
        ask(&mut harness, dialogue);
        if harness.query_by_label("More").is_some() {
            click_last(&mut harness, "More");
            harness.run_steps(8);
        }
        assert!(fields(&harness).len() > panels.len(), "{name} has no field");
        let wrong: Vec<String> = misnamed_but(&harness, &panels);
        assert_eq!(wrong, [""; 0], "{name}");
        act(&mut harness, Action::Answered);
    }
}

/// The fields that are seen, by role and name.
fn fields(harness: &Driven) -> Vec<String> {
    let of = |role| harness.query_all_by_role(role).map(move |node| (role, node.accesskit_node().label()));
    FIELDS.into_iter().flat_map(of).map(|(role, name)| format!("{role:?} {:?}", name.unwrap_or_default())).collect()
}

/// What is wrong in front of the panels, whose fields may have the names of a dialogue's.
fn misnamed_but(harness: &Driven, panels: &[String]) -> Vec<String> {
    misnamed(harness).into_iter().filter(|wrong| !panels.contains(wrong)).collect()
}

#[test]
fn what_a_well_lacks_is_asked_for_by_its_field_and_helps() {
    let folder = tempfile::tempdir().unwrap();
    let mut harness = open(folder.path());
    let path = folder.path().join("W-2.csv");
    std::fs::write(&path, "md,inc,azi\n0,0,0\n100,0,0\n").unwrap();
    ask(&mut harness, Dialogue::Well { path });
    let is_asked = |harness: &Driven, words: &str| harness.query_all_by_label_contains(words).count() > 0;
    wait(&mut harness, "the head is asked for", |harness| is_asked(harness, "“Head X, Y, m”"));
    assert!(words(&harness).iter().all(|text| !text.contains("--")), "{:?}", words(&harness));
    harness.get_by_role_and_label(Role::TextInput, "Head X, Y, m").focus();
    harness.step();
    harness.get_by_role_and_label(Role::TextInput, "Head X, Y, m").type_text("250, 250");
    wait(&mut harness, "the datum is assumed", |harness| is_asked(harness, "“Datum above sea level, m”"));
    wait(&mut harness, "the unit is assumed", |harness| is_asked(harness, "ft under “Lengths along the well”"));
    assert!(words(&harness).iter().all(|text| !text.contains("--")), "{:?}", words(&harness));
    for name in ["Datum above sea level, m", "Lengths along the well"] {
        assert!(field_is_there(&harness, name), "{name}");
    }
    click(&mut harness, "Add");
    wait(&mut harness, "the well is there", |harness| document(harness).wells.len() == 1);
}

#[test]
fn what_is_typed_and_is_no_number_is_said() {
    let folder = tempfile::tempdir().unwrap();
    let mut harness = open(folder.path());
    let path = folder.path().join("W-3.csv");
    std::fs::write(&path, "md_m,x_m,y_m,tvdss_m\n0,250,250,0\n40,250,250,40\n").unwrap();
    ask(&mut harness, Dialogue::Well { path });
    harness.get_by_role_and_label(Role::TextInput, "Datum above sea level, m").focus();
    harness.step();
    harness.get_by_role_and_label(Role::TextInput, "Datum above sea level, m").type_text("25 ft");
    wait(&mut harness, "it is said", |harness| harness.query_all_by_label_contains("“25 ft” is no").count() > 0);
    assert!(harness.get_by_label("Add").accesskit_node().is_disabled());
}

#[test]
fn a_horizon_upside_down_is_told_which_field_turns_it() {
    let folder = tempfile::tempdir().unwrap();
    let mut harness = open(folder.path());
    let path = folder.path().join("up.csv");
    let mut text = "inline,crossline,z\n".to_owned();
    for (inline, crossline) in (1..=24).flat_map(|inline| (1..=20).map(move |crossline| (inline, crossline))) {
        text += &format!("{inline},{crossline},-{}\n", 50.0 + f64::from(inline) + 0.01 * f64::from(crossline));
    }
    std::fs::write(&path, text).unwrap();
    ask(&mut harness, Dialogue::Interpretation { path, kind: FileContent::Horizon });
    wait(&mut harness, "the sign is asked for", |harness| {
        harness.query_all_by_label_contains("state up under “Sign”").count() > 0
    });
    // What may have to be stated is in sight.
    for name in ["Sign", "Columns", "Value of holes", "Placed by", "Order of values", "Format"] {
        wait(&mut harness, "the field is there", |harness| field_is_there(harness, name));
    }
    assert!(words(&harness).iter().all(|text| !text.contains("--")), "{:?}", words(&harness));
    choose(&mut harness, "Sign", "positive up");
    wait(&mut harness, "it can be added", |harness| {
        harness.query_by_label("Add").is_some_and(|add| !add.accesskit_node().is_disabled())
    });
}

#[test]
fn a_volume_is_added_to_the_open_project_under_its_name() {
    let folder = tempfile::tempdir().unwrap();
    let mut harness = open(folder.path());
    let path = survey(folder.path());
    ask(&mut harness, Dialogue::Survey { path, target: Target::OpenProject });
    wait(&mut harness, "the headers are read", |harness| harness.query_by_label("Map of the traces").is_some());
    for name in
        ["Sample interval", "First sample", "Coordinate scalar", "Square bins, m", "Repeated traces", "Vertical unit"]
    {
        if !field_is_there(&harness, name) {
            click_last(&mut harness, "More");
            harness.run_steps(8);
        }
        assert!(field_is_there(&harness, name), "{name}");
    }
    harness.query_all_by_role_and_label(Role::TextInput, "Name").last().unwrap().focus();
    harness.step();
    harness.query_all_by_role_and_label(Role::TextInput, "Name").last().unwrap().type_text("again");
    harness.run_steps(2);
    click(&mut harness, "Import");
    wait(&mut harness, "the volume is there", |harness| document(harness).volumes.len() == 2);
    assert_eq!(document(&harness).volumes[1].name, "again");
}

fn settings_of(folder: &Path) -> Driven {
    let root = project(folder);
    let mut harness = driven(folder, Some(root));
    wait(&mut harness, "the project is open", |harness| state(harness).session.is_some());
    harness
}

#[test]
fn the_project_menu_changes_the_look_and_closes_the_project() {
    let folder = tempfile::tempdir().unwrap();
    let mut harness = settings_of(folder.path());
    click(&mut harness, "Project");
    click_last(&mut harness, "Dark appearance");
    assert_eq!(state(&harness).remembered.appearance, Appearance::Dark);
    click_last(&mut harness, "Larger");
    assert!(state(&harness).remembered.scale.is_some_and(|scale| scale > 1.05));
    click_last(&mut harness, "Smaller");
    click_last(&mut harness, "Close");
    assert!(state(&harness).session.is_none());
    wait(&mut harness, "it is a recent project", |harness| harness.query_by_label("Forget").is_some());
    // A click anywhere in its row opens it.
    wait(&mut harness, "it is found there", |harness| !harness.get_by_label("north").accesskit_node().is_disabled());
    let beside = harness.get_by_label("Forget").rect().left_center() - vec2(40.0, 0.0);
    assert!(harness.get_by_label("north").rect().right() < beside.x);
    for pressed in [true, false] {
        let modifiers = Modifiers::default();
        harness.input_mut().events.push(Event::PointerMoved(beside));
        let button = PointerButton::Primary;
        harness.input_mut().events.push(Event::PointerButton { pos: beside, button, pressed, modifiers });
        harness.run_steps(2);
    }
    wait(&mut harness, "it is open", |harness| state(harness).session.is_some());
    click(&mut harness, "Project");
    click_last(&mut harness, "Close");
    wait(&mut harness, "it is listed again", |harness| harness.query_by_label("Forget").is_some());
    click(&mut harness, "Forget");
    assert!(state(&harness).remembered.recent.is_empty());
}

#[test]
fn a_project_left_open_can_be_let_go_and_one_that_is_gone_is_not_opened() {
    let folder = tempfile::tempdir().unwrap();
    let harness = settings_of(folder.path());
    drop(harness);
    std::fs::rename(folder.path().join("north.petro"), folder.path().join("moved.petro")).unwrap();
    let mut next = driven(folder.path(), None);
    next.step();
    click(&mut next, "Not now");
    assert!(state(&next).remembered.left.is_none() && next.query_by_label("Continue").is_none());
    wait(&mut next, "it is known to be gone", |next| next.get_by_label("north").accesskit_node().is_disabled());
}

#[test]
fn the_controls_set_projection_cut_outs_box_and_ground_and_choose_the_map() {
    let folder = tempfile::tempdir().unwrap();
    let mut harness = open(folder.path());
    let scene = |harness: &Driven| state(harness).session.as_ref().unwrap().view.scene.clone();
    click(&mut harness, "Perspective");
    assert!(matches!(scene(&harness).camera.projection, Projection::Perspective { .. }));
    click(&mut harness, "Parallel");
    assert_eq!(scene(&harness).camera.projection, Projection::Orthographic);
    click_last(&mut harness, "No cut-outs");
    assert!(scene(&harness).cut_outs.is_empty());
    click_last(&mut harness, "Stair");
    assert_eq!(scene(&harness).cut_outs.len(), 3);
    click_last(&mut harness, "No cut-outs");
    click_last(&mut harness, "Cut nearest corner");
    assert_eq!(scene(&harness).cut_outs.len(), 1);
    click_last(&mut harness, "Round shaft");
    click_last(&mut harness, "Sloping plane");
    assert_eq!(scene(&harness).cut_shapes.len(), 2);
    assert!(harness.get_by_label("Cut along fence").accesskit_node().is_disabled(), "there is no fence");
    harness.get_by_role_and_label(Role::SpinButton, "Plane 2 dip").focus();
    harness.run_steps(2);
    harness.key_press(Key::ArrowUp);
    harness.run_steps(2);
    let geometry = state(&harness).session.as_ref().unwrap().document.geometry.clone().unwrap();
    let dip = scene(&harness).cut_shapes[1].bearing_and_dip(&geometry).unwrap()[1];
    assert!((dip - 36.0).abs() < 1e-6, "{dip}");
    click_last(&mut harness, "Remove");
    assert!(matches!(scene(&harness).cut_shapes.as_slice(), [render::CutShape::Outline { .. }]));
    act(&mut harness, Action::Fence(vec![[2.0, 3.0], [9.0, 5.0], [14.0, 12.0]]));
    click_last(&mut harness, "Cut along fence");
    assert!(matches!(&scene(&harness).cut_shapes[1], render::CutShape::Fence { fence, .. } if fence.len() == 3));
    click_last(&mut harness, "curve");
    assert!(matches!(scene(&harness).cut_shapes[1], render::CutShape::Fence { smooth: true, depth: None, .. }));
    click_last(&mut harness, "only between");
    harness.get_by_role_and_label(Role::SpinButton, "Fence 2 from").focus();
    harness.run_steps(2);
    harness.key_press(Key::ArrowUp);
    harness.run_steps(2);
    let render::CutShape::Fence { depth: Some([top, base]), .. } = scene(&harness).cut_shapes[1] else {
        panic!("it is bounded")
    };
    assert!(top > 0.0 && base > top, "{top} {base}");
    harness.get_by_role_and_label(Role::SpinButton, "Inlines from").focus();
    harness.run_steps(2);
    harness.key_press(Key::ArrowUp);
    harness.run_steps(2);
    assert_eq!(scene(&harness).roaming_box.map(|block| block.min[0]), Some(1.0));
    click_last(&mut harness, "Whole survey");
    assert!(scene(&harness).roaming_box.is_none());
    click_last(&mut harness, "Handles to drag faces (Shift H)");
    assert!(!state(&harness).session.as_ref().unwrap().view.handles);
    click_last(&mut harness, "Ground: topmost horizon as relief");
    assert!(scene(&harness).ground.is_none());
    act(&mut harness, Action::Arrange(Layout::Map));
    click_last(&mut harness, "Thickness");
    harness.get_by_role_and_label(Role::Image, "Map");
    click_last(&mut harness, "Map of");
    click_last(&mut harness, "Base");
    assert_eq!(state(&harness).session.as_ref().unwrap().view.horizon.as_deref(), Some("Base"));
}

#[test]
fn a_layer_is_named_repeated_and_inked_in_its_editor() {
    let folder = tempfile::tempdir().unwrap();
    let mut harness = open(folder.path());
    click(&mut harness, "Layer Top - Base");
    let style = |harness: &Driven| document(harness).style.layers.style("Top - Base").cloned();
    click_last(&mut harness, "Own");
    wait(&mut harness, "it has repeats of its own", |harness| {
        style(harness).is_some_and(|style| style.frequency.is_some())
    });
    click_last(&mut harness, "Ink");
    wait(&mut harness, "it has ink of its own", |harness| style(harness).is_some_and(|style| style.ink.is_some()));
    harness.get_by_role_and_label(Role::TextInput, "Name").focus();
    harness.step();
    harness.get_by_role_and_label(Role::TextInput, "Name").type_text("Chalk ");
    harness.run_steps(2);
    harness.key_press(Key::Enter);
    wait(&mut harness, "it has another name", |harness| {
        document(harness).layers().iter().any(|name| name.contains("Chalk"))
    });
}

/// Controls that can do nothing now and do not say why, to those who cannot see a tooltip either.
fn silent(harness: &Driven) -> Vec<String> {
    let nodes = [Role::Button, Role::CheckBox].map(|role| harness.query_all_by_role(role).collect::<Vec<_>>());
    let disabled = nodes.iter().flatten().map(|node| node.accesskit_node()).filter(|node| node.is_disabled());
    let silent = disabled.filter(|node| node.description().is_none_or(|why| why.is_empty()));
    silent.map(|node| node.label().unwrap_or_default()).collect()
}

#[test]
fn what_can_do_nothing_says_why() {
    let folder = tempfile::tempdir().unwrap();
    let mut harness = open(folder.path());
    let why = |harness: &Driven, label: &str| {
        let node = harness.query_all_by_label(label).last().unwrap().accesskit_node();
        node.is_disabled().then(|| node.description()).flatten()
    };
    for panel in [Panel::Layers, Panel::Data, Panel::Values, Panel::Interpret] {
        act(&mut harness, Action::Panel(panel));
        assert_eq!(silent(&harness), Vec::<String>::new(), "{panel:?}");
    }
    assert_eq!(why(&harness, "Redo").as_deref(), Some("Nothing to redo"));
    act(&mut harness, Action::Picking(PickingStep::Use(Tool::Sticks)));
    assert!(why(&harness, "End stick").unwrap().contains("two points"));
    assert_eq!(silent(&harness), Vec::<String>::new());
    act(&mut harness, Action::Panel(Panel::Layers));
    act(&mut harness, Action::Arrange(Layout::Fence));
    assert!(why(&harness, "New line").is_some() && silent(&harness).is_empty());
    act(&mut harness, Action::Ask(Box::new(Dialogue::Choose(Choice::Well))));
    // Shares are shown in percent wherever they are.
    act(&mut harness, Action::Answered);
    act(&mut harness, Action::Layer(Some("Top - Base".into())));
    let shown = |label: &str| harness.query_all_by_label(label).last().unwrap().accesskit_node().value().unwrap();
    for label in ["In cut-outs", "Opacity of pattern 1", "to raw"] {
        assert!(shown(label).ends_with('%'), "{label}: {}", shown(label));
    }
}
