//! A window in a test harness, the helpers of the other tests, and tests of the main workflow.

use crate::command::click_last;
use app::window::Window;
use eframe::egui::{Key, Modifiers};
use egui_kittest::Harness;
use egui_kittest::kittest::{NodeT, Queryable};
use files::ImportOptions;
use files::segy::WriteOptions;
use project::Project;
use project::command::{AddHorizon, Age, Command};
use state::{Compare, Dialogue, FileContent, Layout, State, Target};
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};
use survey::{Contact, Progress, SurveyGeometry, VerticalUnit, Volume};

/// Longest wait for a worker before a test gives up; far beyond what any needs.
const PATIENCE: Duration = Duration::from_secs(120);

pub(crate) type Driven = Harness<'static, Option<Window>>;

/// A window that keeps its settings in `folder`, with a project open if one is named.
pub(crate) fn driven(folder: &Path, project: Option<PathBuf>) -> Driven {
    let settings = folder.join("settings/window.toml");
    let show = move |ui: &mut eframe::egui::Ui, window: &mut Option<Window>| {
        let make = || Window::new(ui.ctx(), Some(settings.clone()), project.clone());
        window.get_or_insert_with(make).show(ui);
    };
    Harness::builder().with_size([1280.0, 800.0]).build_ui_state(show, None)
}

pub(crate) fn state(harness: &Driven) -> &State {
    harness.state().as_ref().unwrap().state()
}

/// Whether the window shows the latest step of its project: what a command wrote is seen on disk before the window has
/// read it, and rows that come or go meanwhile take the focus from what a test touches.
fn has_caught_up(harness: &Driven) -> bool {
    let session = state(harness).session.as_ref();
    session.is_none_or(|session| {
        Project::open(&session.root).is_ok_and(|on_disk| on_disk.document().step == session.document.step)
    })
}

/// Draws frames until something is so and the window shows it.
pub(crate) fn wait(harness: &mut Driven, what: &str, is_so: impl Fn(&Driven) -> bool) {
    let start = Instant::now();
    loop {
        harness.step();
        if is_so(harness) && has_caught_up(harness) {
            // A dialogue finds its place in the frames after its content is complete.
            harness.run_steps(3);
            return;
        }
        assert!(start.elapsed() < PATIENCE, "still not so: {what}; notices: {:?}", state(harness).notices);
        std::thread::sleep(Duration::from_millis(10));
    }
}

/// Clicks what has a label as a screen reader does: a pointer misses what a worker's result moves between its press and
/// its release.
pub(crate) fn click(harness: &mut Driven, label: &str) {
    harness.get_by_label(label).click_accesskit();
    // A dialogue is laid out unseen in its first frame.
    harness.run_steps(3);
}

pub(crate) fn geometry() -> SurveyGeometry {
    SurveyGeometry::regular([24, 20, 32], 25.0, 4.0, VerticalUnit::Milliseconds)
}

pub(crate) fn survey(folder: &Path) -> PathBuf {
    let path = folder.join("north.sgy");
    let samples = (0..24 * 20 * 32).map(|n| ((n % 32) as f32 * 0.7).sin()).collect();
    let volume = Volume::from_samples([24, 20, 32], samples).unwrap();
    files::segy::write(&path, &geometry(), &volume, &WriteOptions::default(), &Progress::silent()).unwrap();
    path
}

/// A horizon at one depth as inline, crossline, z.
fn horizon(folder: &Path, name: &str, z: f32) -> PathBuf {
    let path = folder.join(format!("{name}.csv"));
    let mut text = "inline,crossline,z\n".to_owned();
    for inline in 1..=24 {
        for crossline in 1..=20 {
            text += &format!("{inline},{crossline},{z}\n");
        }
    }
    std::fs::write(&path, text).unwrap();
    path
}

/// A project with a volume and two horizons.
pub(crate) fn project(folder: &Path) -> PathBuf {
    let root = folder.join("north.petro");
    let mut new = Project::create(&root, None).unwrap();
    let import = project::command::ImportVolume {
        path: survey(folder),
        name: None,
        polarity: Default::default(),
        options: Default::default(),
        memory_bytes: None,
        moved: false,
        origin: None,
    };
    let mut commands = vec![Command::Import(import)];
    for (name, z) in [("Top", 30.0), ("Base", 80.0)] {
        commands.push(Command::AddHorizon(AddHorizon {
            path: horizon(folder, name, z),
            name: name.into(),
            contact: Contact::Conformable,
            age: Age::ByDepth,
            options: ImportOptions::default(),
        }));
    }
    for command in commands {
        new.project().apply(&command, &Progress::silent()).unwrap();
    }
    new.publish().unwrap().root().to_owned()
}

pub(crate) fn open(folder: &Path) -> Driven {
    let root = project(folder);
    let mut harness = driven(folder, Some(root));
    wait(&mut harness, "the picture is drawn", |harness| {
        state(harness).session.is_some() && harness.state().as_ref().unwrap().is_settled()
    });
    harness
}

pub(crate) fn document(harness: &Driven) -> project::document::Document {
    Project::open(&state(harness).session.as_ref().unwrap().root).unwrap().document().clone()
}

#[test]
fn the_start_page_opens_begins_and_remembers() {
    let folder = tempfile::tempdir().unwrap();
    let root = project(folder.path());
    let mut harness = driven(folder.path(), None);
    harness.step();
    for label in ["New from SEG-Y…", "Open project…", "Try the demonstration…"] {
        harness.get_by_label(label);
    }
    click(&mut harness, "Open project…");
    harness.get_by_label("Path").focus();
    harness.step();
    harness.key_press_modifiers(Modifiers::COMMAND, Key::A);
    harness.get_by_label("Path").type_text(&root.display().to_string());
    harness.step();
    click(&mut harness, "Open");
    wait(&mut harness, "the project is open", |harness| state(harness).session.is_some());
    // While it is open, another window does not offer it.
    let mut second = driven(folder.path(), None);
    second.step();
    assert!(second.query_by_label("Continue").is_none());
    drop(second);
    drop(harness);
    let mut next = driven(folder.path(), None);
    next.step();
    // It was not closed, as after a crash: what was open is offered again.
    click(&mut next, "Continue");
    wait(&mut next, "the project is open again", |harness| state(harness).session.is_some());
}

#[test]
fn a_project_that_is_not_there_is_said_so_on_the_start_page() {
    let folder = tempfile::tempdir().unwrap();
    let mut harness = driven(folder.path(), Some(folder.path().join("gone.petro")));
    wait(&mut harness, "the failure is told", |harness| !state(harness).notices.is_empty());
    assert!(state(&harness).notices[0].text.contains("there is no project at"));
    assert!(state(&harness).notices[0].hint.is_some());
    click(&mut harness, "Dismiss");
    assert!(state(&harness).notices.is_empty());
}

#[test]
fn a_project_that_is_opened_has_nothing_of_the_one_before() {
    let (folder, beside) = (tempfile::tempdir().unwrap(), tempfile::tempdir().unwrap());
    let mut harness = open(folder.path());
    let shown = |harness: &Driven| harness.get_by_label("Scene name").accesskit_node().value().unwrap_or_default();
    harness.get_by_label("Scene name").focus();
    harness.step();
    harness.get_by_label("Scene name").type_text("plan");
    harness.run_steps(3);
    assert_eq!(shown(&harness), "plan");
    let other = project(beside.path());
    harness.state_mut().as_mut().unwrap().act(state::Action::Open(other.clone()));
    wait(&mut harness, "the other project is open", |harness| {
        state(harness).session.as_ref().is_some_and(|session| session.root == other)
    });
    assert_eq!(shown(&harness), "");
}

#[test]
fn a_survey_becomes_a_project_through_the_import_dialogue() {
    let folder = tempfile::tempdir().unwrap();
    let path = survey(folder.path());
    let mut harness = driven(folder.path(), None);
    harness.step();
    let ask = state::Action::Ask(Box::new(Dialogue::Survey { path, target: Target::NewProject }));
    harness.state_mut().as_mut().unwrap().act(ask);
    wait(&mut harness, "the headers are read", |harness| harness.query_by_label("Map of the traces").is_some());
    for label in ["Inline", "Crossline", "Polarity", "Middle inline"] {
        assert!(harness.query_all_by_label(label).count() > 0, "{label}");
    }
    click(&mut harness, "Create project");
    wait(&mut harness, "the project is open", |harness| state(harness).session.is_some());
    assert_eq!(document(&harness).volumes[0].name, "seismic");
    assert!(state(&harness).dialogue.is_none());
}

#[test]
fn a_horizon_comes_in_through_its_dialogue() {
    let folder = tempfile::tempdir().unwrap();
    let mut harness = open(folder.path());
    let path = horizon(folder.path(), "Middle", 55.0);
    let ask = state::Action::Ask(Box::new(Dialogue::Interpretation { path, kind: FileContent::Horizon }));
    harness.state_mut().as_mut().unwrap().act(ask);
    wait(&mut harness, "the file is read", |harness| {
        harness.query_by_label("Add").is_some_and(|add| !add.accesskit_node().is_disabled())
    });
    click(&mut harness, "Add");
    wait(&mut harness, "the horizon is there", |harness| document(harness).horizons.len() == 3);
    assert_eq!(document(&harness).horizons[1].name, "Middle");
}

#[test]
fn a_layer_gets_a_pattern_and_undo_takes_it_back() {
    let folder = tempfile::tempdir().unwrap();
    let mut harness = open(folder.path());
    click(&mut harness, "Layer Top - Base");
    click(&mut harness, "Name");
    let button = harness.query_all_by_label_contains("…").find(|node| {
        node.accesskit_node()
            .label()
            .is_some_and(|label| label.ends_with('…') && label.chars().next().is_some_and(char::is_lowercase))
    });
    button.expect("the present pattern can be changed").click_accesskit();
    harness.run_steps(3);
    wait(&mut harness, "the patterns are listed", |harness| harness.query_by_label("Pattern chalk").is_some());
    click_last(&mut harness, "Pattern chalk");
    wait(&mut harness, "the layer has it", |harness| {
        document(harness).style.layers.style("Top - Base").is_some_and(|style| style.texture_at(0.5) == Some("chalk"))
    });
    harness.key_press_modifiers(Modifiers::COMMAND, Key::Z);
    wait(&mut harness, "it is taken back", |harness| document(harness).style.layers.style("Top - Base").is_none());
    wait(&mut harness, "the window knows", |harness| state(harness).session.as_ref().unwrap().redoable().is_some());
    click(&mut harness, "Redo");
    wait(&mut harness, "it is back", |harness| document(harness).style.layers.style("Top - Base").is_some());
}

#[test]
fn views_are_arranged_and_compared_and_a_scene_is_saved() {
    let folder = tempfile::tempdir().unwrap();
    let mut harness = open(folder.path());
    click(&mut harness, "Sections");
    assert_eq!(state(&harness).session.as_ref().unwrap().view.layout, Layout::Sections);
    for label in ["Block", "Inline section", "Crossline section", "Slice section"] {
        assert!(harness.query_all_by_label(label).count() > 0, "{label}");
    }
    harness.key_press(Key::K);
    harness.run_steps(2);
    assert_eq!(state(&harness).session.as_ref().unwrap().view.slices[0], 13.0);
    click(&mut harness, "Wipe");
    assert_eq!(state(&harness).session.as_ref().unwrap().view.compare, Compare::Wipe);
    click(&mut harness, "From above");
    assert_eq!(state(&harness).session.as_ref().unwrap().view.scene.camera.elevation_deg, 90.0);
    harness.get_by_label("Scene name").focus();
    harness.step();
    harness.get_by_label("Scene name").type_text("plan");
    harness.run_steps(2);
    click_last(&mut harness, "Save scene");
    wait(&mut harness, "the scene is kept", |harness| document(harness).scenes.len() == 1);
    assert_eq!(document(&harness).scenes[0].scene.camera.elevation_deg, 90.0);
}

#[test]
fn a_picture_is_exported_at_its_printed_size() {
    let folder = tempfile::tempdir().unwrap();
    let mut harness = open(folder.path());
    click(&mut harness, "Export…");
    let path = folder.path().join("out.png");
    let Some(Dialogue::Export(form)) = &state(&harness).dialogue else { panic!("no dialogue") };
    let form = state::ExportForm { path: path.display().to_string(), size_cm: [6.0, 4.0], dpi: 60.0, ..form.clone() };
    let expected = form.size_px();
    harness.state_mut().as_mut().unwrap().act(state::Action::Ask(Box::new(Dialogue::Export(form))));
    harness.run_steps(2);
    click(&mut harness, "Export");
    wait(&mut harness, "it is written", |_| path.exists());
    let image = image::open(&path).unwrap();
    assert_eq!([image.width(), image.height()], expected);
}

#[test]
fn a_picture_is_exported_as_paths_by_its_files_name() {
    let folder = tempfile::tempdir().unwrap();
    let mut harness = open(folder.path());
    let name = |harness: &mut Driven, file: &str| {
        click(harness, "Export…");
        let path = folder.path().join(file);
        let Some(Dialogue::Export(form)) = &state(harness).dialogue else { panic!("no dialogue") };
        let form = state::ExportForm { path: path.display().to_string(), size_cm: [6.0, 4.0], ..form.clone() };
        harness.state_mut().as_mut().unwrap().act(state::Action::Ask(Box::new(Dialogue::Export(form))));
        harness.run_steps(2);
        path
    };
    name(&mut harness, "out.gif");
    assert!(harness.get_by_label("Export").accesskit_node().is_disabled());
    harness.get_by_label("The file's name must end in .png, .tif, .svg or .pdf");
    click(&mut harness, "Cancel");
    let path = name(&mut harness, "out.svg");
    click(&mut harness, "Export");
    wait(&mut harness, "it is written", |_| path.exists());
    let svg = std::fs::read_to_string(&path).unwrap();
    assert!(svg.contains("inkscape:label=\"Top\"") && svg.trim_end().ends_with("</svg>"));
}

#[test]
fn sections_are_exported_as_measured_data_or_as_rock() {
    let folder = tempfile::tempdir().unwrap();
    let mut harness = open(folder.path());
    click(&mut harness, "Export…");
    assert!(harness.query_by_label("Rock with patterns").is_none(), "a block alone has its blend");
    click(&mut harness, "Cancel");
    click(&mut harness, "Sections");
    let export = |harness: &mut Driven, fill: &str| {
        let path = folder.path().join(format!("{fill}.svg"));
        click(harness, "Export…");
        let Some(Dialogue::Export(form)) = &state(harness).dialogue else { panic!("no dialogue") };
        let form = state::ExportForm { path: path.display().to_string(), size_cm: [9.0, 7.0], ..form.clone() };
        harness.state_mut().as_mut().unwrap().act(state::Action::Ask(Box::new(Dialogue::Export(form))));
        harness.run_steps(4);
        click(harness, fill);
        click(harness, "Export");
        wait(harness, "it is written", |_| path.exists());
        std::fs::read_to_string(&path).unwrap()
    };
    let (measured, half) = (export(&mut harness, "Measured data"), export(&mut harness, "Half"));
    let rock = export(&mut harness, "Rock with patterns");
    let pictures = [&measured, &half, &rock].map(|svg| svg.matches("<image").count());
    assert!(pictures[0] >= 3 && pictures[1] == pictures[0] && pictures[2] + 3 == pictures[0], "{pictures:?}");
    assert!(half != measured);
}

#[test]
fn the_shortcuts_are_shown_on_a_question_mark() {
    let folder = tempfile::tempdir().unwrap();
    let mut harness = open(folder.path());
    harness.event(eframe::egui::Event::Text("?".into()));
    harness.run_steps(3);
    harness.get_by_label("Shortcuts");
    harness.key_press(Key::Escape);
    harness.run_steps(3);
    assert!(state(&harness).dialogue.is_none());
}

#[test]
fn data_is_listed_and_removed() {
    let folder = tempfile::tempdir().unwrap();
    let mut harness = open(folder.path());
    click(&mut harness, "Data");
    harness.get_by_label("seismic");
    let removes: Vec<_> = harness.query_all_by_label("Remove").collect();
    // The volume, then both horizons.
    removes[2].click_accesskit();
    harness.run_steps(2);
    wait(&mut harness, "a horizon is gone", |harness| document(harness).horizons.len() == 1);
    assert_eq!(document(&harness).horizons[0].name, "Top");
    wait(&mut harness, "it is no longer listed", |harness| harness.query_all_by_label("Remove").count() == 2);
    harness.query_all_by_label("Remove").next().unwrap().click_accesskit();
    harness.run_steps(2);
    wait(&mut harness, "the volume is gone", |harness| document(harness).volumes.is_empty());
    assert!(harness.query_by_label("seismic").is_none());
}

#[test]
fn values_have_a_histogram_and_get_textures() {
    let folder = tempfile::tempdir().unwrap();
    let mut harness = open(folder.path());
    click(&mut harness, "Volume display");
    harness.get_by_label("Histogram");
    click(&mut harness, "Textures by seismic");
    wait(&mut harness, "the textures are there", |harness| document(harness).style.scalars.len() == 1);
    wait(&mut harness, "they are listed", |harness| harness.query_by_label("Texture of seismic 1").is_some());
}

#[test]
fn a_horizon_is_mapped_and_the_block_cut_by_keys() {
    let folder = tempfile::tempdir().unwrap();
    let mut harness = open(folder.path());
    harness.key_press(Key::Num3);
    harness.run_steps(3);
    assert!(harness.query_all_by_label("Map of").count() > 0);
    let scene = |harness: &Driven| state(harness).session.as_ref().unwrap().view.scene.clone();
    assert_eq!(scene(&harness).cut_outs.len(), 1);
    harness.key_press(Key::C);
    harness.run_steps(2);
    assert!(scene(&harness).cut_outs.is_empty());
    harness.key_press(Key::X);
    harness.run_steps(2);
    let block = scene(&harness).roaming_box.expect("a side was moved");
    assert_eq!(block.max[1] - block.min[1], 19.0 - 4.0);
    scene(&harness).validate(&geometry()).unwrap();
}
