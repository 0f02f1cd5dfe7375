//! Pictures of every panel of the window, without a display: found and clicked by their labels, laid out by egui,
//! painted by the processor.
//!
//! ```text
//! screenshots DEMONSTRATION OUT [WIDTHxHEIGHT] [light|dark] [NAME…]
//! ```
//!
//! DEMONSTRATION is the folder that `petroglyph demo --out` made; its project is changed on the way, so give a copy.
//! With names, only these pictures are made.

use anyhow::{Context as _, bail};
use app::Window;
use app::widgets::raster::Raster;
use eframe::egui::{self, Event, Key, Modifiers, PointerButton, Pos2, TexturesDelta, vec2};
use egui_kittest::kittest::Queryable;
use egui_kittest::{Harness, TestRenderer};
use files::well::WellFiles;
use glam::DVec3;
use image::{Rgba, RgbaImage};
use project::command::{AddNote, AddScene, AddWell, Command};
use project::document::NoteEntry;
use render::{FaceData, Scene};
use state::picking::voxel_of;
use state::{
    Action, Appearance, Choice, Compare, Dialogue, ExportForm, FileContent, How, Layout, Look, Notice, Panel,
    PickingStep, Place, ShareForm, Target,
};
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, PoisonError};
use std::time::{Duration, Instant};
use survey::SurveyGeometry;

/// Margin that the harness leaves around the window, points.
const MARGIN: f32 = 8.0;
/// Longest wait for a picture to be drawn.
const PATIENCE: Duration = Duration::from_secs(300);
/// Time for work that is not listed as under way: sections, maps, swatches.
const SOON: Duration = Duration::from_millis(1500);

/// Keeps the textures until a picture is wanted.
struct Keep(Arc<Mutex<Raster>>);

impl TestRenderer for Keep {
    fn handle_delta(&mut self, delta: &mut TexturesDelta) {
        self.0.lock().unwrap_or_else(PoisonError::into_inner).receive(delta);
    }
}

/// The window, and where its pictures go.
struct Tour {
    harness: Harness<'static, Option<Window>>,
    raster: Arc<Mutex<Raster>>,
    folder: PathBuf,
    out: PathBuf,
    size: [u32; 2],
    suffix: String,
    names: Vec<String>,
}

impl Tour {
    fn begin(folder: PathBuf, out: PathBuf, size: [u32; 2], appearance: Appearance, names: Vec<String>) -> Self {
        let raster = Arc::new(Mutex::new(Raster::default()));
        let settings = out.join("window.toml");
        let mut window = None;
        let show = move |ui: &mut egui::Ui, state: &mut Option<Window>| {
            state.get_or_insert_with(|| Window::new(ui.ctx(), Some(settings.clone()), window.take())).show(ui);
        };
        let builder = Harness::builder().with_size(vec2(size[0] as f32, size[1] as f32) + vec2(MARGIN, MARGIN) * 2.0);
        let harness = builder.renderer(Keep(raster.clone())).build_ui_state(show, None);
        let suffix = format!("{}x{}-{}", size[0], size[1], appearance.name().to_lowercase());
        let mut tour = Self { harness, raster, folder, out, size, suffix, names };
        tour.act(Action::Appear(appearance));
        tour
    }

    fn window(&mut self) -> &mut Window {
        self.harness.step();
        self.harness.state_mut().as_mut().expect("made by the first frame")
    }

    fn act(&mut self, action: Action) {
        self.window().act(action);
        self.harness.run_steps(3);
    }

    fn picking(&mut self, step: PickingStep) {
        self.act(Action::Picking(step));
    }

    /// Draws frames until nothing is under way.
    fn settle(&mut self) {
        let (start, mut calm) = (Instant::now(), Instant::now());
        while calm.elapsed() < SOON && start.elapsed() < PATIENCE {
            if !self.window().is_settled() {
                calm = Instant::now();
            }
            std::thread::sleep(Duration::from_millis(20));
        }
    }

    fn geometry(&mut self) -> SurveyGeometry {
        let session = self.window().state().session.as_ref().expect("a project is open");
        session.document.geometry.clone().expect("it has a frame")
    }

    /// Clicks the widget with a label, the last if there are several.
    fn click(&mut self, label: &str) {
        let at = match self.harness.query_all_by_label(label).last() {
            Some(node) => node.rect().center(),
            None => return eprintln!("no widget has the label {label}"),
        };
        self.press(at);
    }

    fn press(&mut self, at: Pos2) {
        self.harness.event(Event::PointerMoved(at));
        self.harness.run_steps(2);
        for pressed in [true, false] {
            let modifiers = Modifiers::NONE;
            self.harness.event(Event::PointerButton { pos: at, button: PointerButton::Primary, pressed, modifiers });
            self.harness.run_steps(1);
        }
        self.harness.run_steps(3);
    }

    fn key(&mut self, key: Key) {
        self.harness.key_press(key);
        self.harness.run_steps(3);
    }

    /// Takes a picture of the window once nothing is under way.
    fn shoot(&mut self, name: &str) -> anyhow::Result<()> {
        if !self.is_wanted(name) {
            return Ok(());
        }
        self.settle();
        let ctx = self.harness.ctx.clone();
        let points_px = ctx.pixels_per_point();
        let primitives = ctx.tessellate(self.harness.output().shapes.clone(), points_px);
        let margin = MARGIN as u32;
        let [width, height] = self.size.map(|side| side + 2 * margin);
        let mut image = RgbaImage::from_pixel(width, height, Rgba([0, 0, 0, 255]));
        self.raster.lock().unwrap_or_else(PoisonError::into_inner).paint(&primitives, points_px, &mut image);
        let image = image::imageops::crop_imm(&image, margin, margin, self.size[0], self.size[1]).to_image();
        let path = self.out.join(format!("{name}-{}.png", self.suffix));
        image.save(&path).with_context(|| format!("{} could not be written", path.display()))?;
        println!("{}", path.display());
        Ok(())
    }

    /// What is on the screen as it is exported.
    fn print(&mut self, name: &str) {
        if self.is_wanted(name) {
            self.settle();
            let path = self.out.join(format!("{name}-{}.png", self.suffix));
            let form = ExportForm { dpi: 150.0, ..ExportForm::new(path.display().to_string()) };
            self.act(Action::Export(Box::new(form)));
            self.settle();
            println!("{}", path.display());
        }
    }

    fn is_wanted(&self, name: &str) -> bool {
        self.names.is_empty() || self.names.iter().any(|wanted| wanted == name)
    }

    fn ask(&mut self, dialogue: Dialogue) {
        self.act(Action::Ask(Box::new(dialogue)));
    }

    fn start(&mut self) -> anyhow::Result<()> {
        self.shoot("start")?;
        self.ask(Dialogue::Choose(Choice::NewSurvey));
        self.shoot("choose")?;
        self.ask(Dialogue::Survey { path: self.folder.join("survey/survey.sgy"), target: Target::NewProject });
        self.shoot("import")?;
        self.act(Action::Answered);
        self.act(Action::Open(self.folder.join("no-such.petro")));
        self.shoot("start-error")?;
        self.act(Action::Open(self.folder.join("demo.petro")));
        self.settle();
        Ok(())
    }

    fn views(&mut self) -> anyhow::Result<()> {
        self.shoot("block")?;
        self.act(Action::Compare(Compare::SideBySide));
        self.shoot("side-by-side")?;
        self.print("print-side-by-side");
        self.act(Action::Compare(Compare::Wipe));
        self.shoot("wipe")?;
        self.act(Action::Compare(Compare::Blend));
        self.act(Action::Arrange(Layout::Sections));
        self.shoot("sections")?;
        self.print("print-sections");
        self.act(Action::Proportions(Some(1.0)));
        self.shoot("sections-true")?;
        self.act(Action::Proportions(None));
        self.act(Action::Arrange(Layout::Map));
        self.shoot("map")?;
        self.click("Thickness");
        self.shoot("isochore")?;
        self.click("Structure");
        self.act(Action::Arrange(Layout::Fence));
        self.shoot("fence-begun")?;
        let [nx, ny, _] = self.geometry().size().map(|count| count as f64);
        self.act(Action::Fence(vec![[0.1 * nx, 0.2 * ny], [0.5 * nx, 0.7 * ny], [0.9 * nx, 0.3 * ny]]));
        self.shoot("fence")?;
        self.print("print-fence");
        self.act(Action::Arrange(Layout::Block));
        Ok(())
    }

    fn styles(&mut self) -> anyhow::Result<()> {
        let layer =
            self.window().state().session.as_ref().and_then(|session| session.document.layers().get(2).cloned());
        let layer = layer.context("the demonstration has layers")?;
        self.act(Action::Layer(Some(layer.clone())));
        self.harness.run_steps(30);
        self.shoot("layer")?;
        self.click("Split");
        self.settle();
        self.shoot("layer-split")?;
        self.act(Action::Undo);
        self.ask(Dialogue::Patterns { layer, interval: None });
        self.shoot("patterns")?;
        self.act(Action::Answered);
        self.act(Action::Panel(Panel::Data));
        self.shoot("data")?;
        self.act(Action::Panel(Panel::Values));
        self.settle();
        self.click("Textures by impedance");
        self.shoot("values")?;
        self.act(Action::Undo);
        let before = self.window().state().session.as_ref().map(|session| session.view.scene.clone());
        self.click("Cut-outs");
        self.settle();
        self.glow("Charlie");
        self.shoot("seen")?;
        self.click("Whole block");
        self.shoot("seen-block")?;
        if let Some(scene) = before {
            self.act(Action::Show(Box::new(scene)));
        }
        self.act(Action::Panel(Panel::Layers));
        Ok(())
    }

    /// Makes a horizon in the volume rendering give off light.
    fn glow(&mut self, name: &str) {
        let Some(mut scene) = self.window().state().session.as_ref().map(|session| session.view.scene.clone()) else {
            return;
        };
        let colour = ttf::Colour::new(0xf2, 0xc1, 0x2e);
        state::volume_rendering::show_horizon(&mut scene, name, colour, true);
        scene.media.horizons.iter_mut().for_each(|horizon| horizon.emission = 0.5);
        self.act(Action::Show(Box::new(scene)));
    }

    fn dialogues(&mut self) -> anyhow::Result<()> {
        let horizon = std::fs::read_dir(self.folder.join("survey/horizons"))?
            .filter_map(|entry| Some(entry.ok()?.path()))
            .filter(|path| path.extension().is_some_and(|ending| ending == "csv"))
            .min();
        if let Some(path) = horizon {
            self.ask(Dialogue::Interpretation { path, kind: FileContent::Horizon });
            self.shoot("add-horizon")?;
        }
        let path = self.well()?;
        self.ask(Dialogue::Well { path });
        self.settle();
        for (label, file) in [("Tops", "tops.csv"), ("Logs", "log.las")] {
            let path = self.out.join(file).display().to_string();
            let field = self.harness.query_all_by_label(label).last();
            let field = field.with_context(|| format!("the dialogue has no {label}"))?;
            field.focus();
            self.harness.step();
            self.harness.query_all_by_label(label).last().context("it is still there")?.type_text(&path);
            self.harness.run_steps(3);
        }
        self.shoot("add-well")?;
        self.click("Add");
        self.settle();
        self.act(Action::Answered);
        self.act(Action::Panel(Panel::Data));
        self.shoot("well")?;
        self.act(Action::Undo);
        self.act(Action::Panel(Panel::Layers));
        self.harness.key_press_modifiers(Modifiers::COMMAND, Key::E);
        self.harness.run_steps(3);
        self.shoot("export")?;
        self.act(Action::Answered);
        self.share()?;
        self.ask(Dialogue::Shortcuts);
        self.shoot("shortcuts")?;
        self.act(Action::Answered);
        let text = "the horizon could not be read: line 12 has two numbers where three are expected";
        let hint = "say which columns hold inline, crossline and z, or give the file a header";
        for place in [Place::Block, Place::Layers, Place::Scenes] {
            let notice = Notice { failed: true, hint: Some(hint.to_owned()), ..Notice::note(place, text) };
            self.act(Action::Tell(notice));
        }
        self.shoot("notices")?;
        for _ in 0..3 {
            self.act(Action::Dismiss(0));
        }
        Ok(())
    }

    /// The page and the model as they are shared, with a note.
    fn share(&mut self) -> anyhow::Result<()> {
        if !self.is_wanted("share") && !self.is_wanted("share-model") {
            return Ok(());
        }
        let text = "The reverse fault repeats the limestone here".to_owned();
        let note = NoteEntry { text, at: [174.0, 640.0, 700.0], scene: None };
        self.act(Action::Apply(Box::new(Command::AddNote(AddNote { note }))));
        self.click("Share…");
        // Names without the folder in which the pictures are made.
        let form = ShareForm::new(Path::new("demo.petro"));
        self.ask(Dialogue::Share(form));
        // The dialogue finds its place.
        self.settle();
        self.click("Preview");
        self.shoot("share")?;
        self.click("Model for slides");
        self.shoot("share-model")?;
        self.act(Action::Answered);
        self.act(Action::Undo);
        Ok(())
    }

    /// A well through the middle of the survey, with tops and a log beside it.
    fn well(&mut self) -> anyhow::Result<PathBuf> {
        let geometry = self.geometry();
        let [nx, ny, nz] = geometry.size().map(|count| count as f64);
        let deepest_m = 0.9 * nz * geometry.sample_m();
        let (mut path, mut log) = ("md_m,x_m,y_m,tvdss_m\n".to_owned(), String::new());
        for step in 0..=20 {
            let share = f64::from(step) / 20.0;
            let at = geometry.world_from_voxel(DVec3::new(nx * (0.49 + 0.02 * share), ny * 0.5, 0.0));
            path += &format!("{},{:.1},{:.1},{}\n", share * deepest_m, at.x, at.y, share * deepest_m * 0.99);
            log += &format!("{:.1} {:.2}\n", share * deepest_m, 60.0 + 30.0 * (share * 9.0).sin());
        }
        std::fs::write(self.out.join("tops.csv"), format!("md_m,name\n{:.0},Chalk\n", 0.4 * deepest_m))?;
        let las = format!(
            "~V\nVERS. 2.0 :\nWRAP. NO :\n~W\nSTRT.M 0 :\nSTOP.M {deepest_m:.1} :\nSTEP.M 0 :\nNULL. -999.25 :\
             \n~C\nDEPT.M :\nGR.API :\n~A\n{log}"
        );
        std::fs::write(self.out.join("log.las"), las)?;
        let file = self.out.join("W-1.csv");
        std::fs::write(&file, path)?;
        Ok(file)
    }

    fn interpretation(&mut self) -> anyhow::Result<()> {
        self.act(Action::Panel(Panel::Interpret));
        self.act(Action::Arrange(Layout::Block));
        self.shoot("interpret")?;
        let session = self.window().state().session.as_ref().context("a project is open")?;
        let entry = session.document.horizons.get(1).context("the demonstration has horizons")?;
        let name = entry.name.clone();
        let at = entry.assembly.as_ref().and_then(|log| log.picks.first()).context("it was picked")?.at;
        let at = voxel_of(&self.geometry(), at);
        self.picking(PickingStep::Choose(name));
        self.act(Action::Arrange(Layout::Sections));
        self.act(Action::Slices(at.to_array()));
        self.shoot("interpret-sections")?;
        self.print("print-interpret-sections");
        self.picking(PickingStep::Begin);
        self.settle();
        self.picking(PickingStep::At(at, How::Replace));
        self.settle();
        self.key(Key::ArrowUp);
        self.shoot("interpret-selected")?;
        self.picking(PickingStep::GiveUp);
        self.picking(PickingStep::Show(FaceData::Leaves));
        self.shoot("interpret-leaves")?;
        self.picking(PickingStep::Show(FaceData::Distance));
        self.shoot("interpret-distances")?;
        self.picking(PickingStep::Show(FaceData::Rock));
        self.picking(PickingStep::Look(Look::Faces));
        self.act(Action::Arrange(Layout::Map));
        let session = self.window().state().session.as_ref().context("a project is open")?;
        let holed = session.document.horizons.get(3).map(|entry| entry.name.clone());
        self.act(Action::Horizon(holed));
        self.shoot("interpret-map")?;
        self.print("print-interpret-map");
        self.act(Action::Arrange(Layout::Fence));
        self.shoot("interpret-fence")?;
        self.sticks()?;
        self.act(Action::Arrange(Layout::Sections));
        self.act(Action::ProposeFaults);
        self.settle();
        self.harness.event(Event::PointerMoved(egui::pos2(160.0, 0.6 * self.size[1] as f32)));
        let delta = vec2(0.0, -20_000.0);
        let unit = egui::MouseWheelUnit::Point;
        let (phase, modifiers, source) = (egui::TouchPhase::Move, Modifiers::NONE, egui::MouseWheelSource::Unknown);
        self.harness.event(Event::MouseWheel { unit, delta, phase, modifiers, source });
        self.harness.run_steps(20);
        self.shoot("interpret-proposals")?;
        self.picking(PickingStep::Look(Look::VolumeRendering));
        self.act(Action::Panel(Panel::Layers));
        Ok(())
    }

    fn well_on_sections(&mut self) -> anyhow::Result<()> {
        let deviation = self.well()?;
        let beside = |name: &str| deviation.with_file_name(name);
        let files = WellFiles {
            tops: Some(beside("tops.csv")),
            las: vec![beside("log.las")],
            deviation: deviation.clone(),
            checkshot: None,
            collar: None,
        };
        let command = AddWell { name: "W-1".to_owned(), files, options: Default::default() };
        self.act(Action::Apply(Box::new(Command::AddWell(command))));
        self.settle();
        let geometry = self.geometry();
        let lines = geometry.size().map(|count| (count / 2) as f64);
        self.act(Action::Slices(lines));
        self.act(Action::Arrange(Layout::Sections));
        self.shoot("sections-well")
    }

    fn presentation(&mut self) -> anyhow::Result<()> {
        self.act(Action::Arrange(Layout::Block));
        let Some(scene) = self.window().state().session.as_ref().map(|session| session.view.scene.clone()) else {
            bail!("a project is open");
        };
        for (name, blend, turn) in [("Overview", 0.0, 0.0), ("Half-way, from the other side", 0.5, 120.0)] {
            let mut scene = Scene { blend, ..scene.clone() };
            scene.camera.azimuth_deg = scene.camera.azimuth_deg.map(|azimuth| azimuth + turn);
            let command = Command::AddScene(AddScene { name: name.to_owned(), scene });
            self.act(Action::Apply(Box::new(command)));
            self.settle();
        }
        self.act(Action::Present(Some(0)));
        self.settle();
        self.key(Key::ArrowRight);
        self.shoot("presenting")?;
        self.key(Key::Escape);
        Ok(())
    }

    fn sticks(&mut self) -> anyhow::Result<()> {
        self.key(Key::F);
        let [nx, ny, nz] = self.geometry().size().map(|count| count as f64);
        for x in [0.45, 0.5, 0.55] {
            for (y, z) in [(0.4, 0.2), (0.45, 0.5), (0.5, 0.8)] {
                self.picking(PickingStep::Stick(DVec3::new(nx * x, ny * y, nz * z)));
            }
            self.picking(PickingStep::EndStick);
        }
        self.act(Action::Arrange(Layout::Fence));
        self.act(Action::Fence(vec![[0.5 * nx, 0.05 * ny], [0.5 * nx, 0.95 * ny]]));
        self.shoot("interpret-sticks")?;
        for _ in 0..9 {
            self.picking(PickingStep::Backspace);
        }
        self.key(Key::F);
        Ok(())
    }
}

fn main() -> anyhow::Result<()> {
    let mut words = std::env::args().skip(1);
    let (Some(folder), Some(out)) = (words.next(), words.next()) else {
        bail!("screenshots DEMONSTRATION OUT [WIDTHxHEIGHT] [light|dark] [NAME…]");
    };
    let size = words.next().unwrap_or_else(|| "1280x800".to_owned());
    let (width, height) = size.split_once('x').context("a size is WIDTHxHEIGHT")?;
    let size = [width.parse()?, height.parse()?];
    let appearance = match words.next().as_deref() {
        Some("dark") => Appearance::Dark,
        _ => Appearance::Light,
    };
    std::fs::create_dir_all(&out)?;
    let out = std::path::absolute(Path::new(&out))?;
    // Recent projects of an earlier run do not belong to this one.
    let _ = std::fs::remove_file(out.join("window.toml"));
    let folder = std::path::absolute(Path::new(&folder))?;
    let mut tour = Tour::begin(folder, out, size, appearance, words.collect());
    tour.start()?;
    tour.views()?;
    tour.styles()?;
    tour.dialogues()?;
    tour.interpretation()?;
    tour.presentation()?;
    tour.well_on_sections()?;
    // Gone without being closed, as after a crash: the next window offers to continue.
    let Tour { harness, folder, out, size, names, .. } = tour;
    drop(harness);
    let mut next = Tour::begin(folder, out, size, appearance, names);
    next.shoot("recovery")
}
