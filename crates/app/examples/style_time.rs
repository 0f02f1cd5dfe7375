//! How long it takes from a change of style in the window to the sharp picture, without a display.
//!
//! ```text
//! style_time PROJECT [ROUNDS] [WIDTHxHEIGHT]
//! ```
//!
//! Opens a copy of the project, waits for the sharp block, then changes the colour of a layer and its pattern in turns,
//! as the panels do. For each change it prints the seconds until the project has it and the picture is sharp; then how many
//! pictures a second there are while the block is turned by the mouse, and the seconds of an export of the block in print
//! quality. Give a copy: the project is changed.

use anyhow::{Context as _, bail};
use app::Window;
use eframe::egui::{self, Event, Modifiers, PointerButton, pos2, vec2};
use egui_kittest::Harness;
use project::command::{Command, SetLayer};
use state::{Action, ExportForm};
use std::path::PathBuf;
use std::time::{Duration, Instant};
use ttf::Colour;

type Driven = Harness<'static, Option<Window>>;

/// Longest wait.
const PATIENCE: Duration = Duration::from_secs(300);
/// How long the block is turned.
const TURNING: Duration = Duration::from_secs(5);
/// Calm after which nothing more is to come.
const CALM: Duration = Duration::from_millis(700);

fn window(harness: &mut Driven) -> anyhow::Result<&mut Window> {
    harness.step();
    harness.state_mut().as_mut().context("the first frame makes the window")
}

/// Draws frames, as a display does, until something is so.
fn wait(harness: &mut Driven, is_so: impl Fn(&Window) -> bool) -> anyhow::Result<Duration> {
    let start = Instant::now();
    while !is_so(window(harness)?) {
        if start.elapsed() > PATIENCE {
            bail!("it took longer than {PATIENCE:?}");
        }
        std::thread::sleep(Duration::from_millis(5));
    }
    Ok(start.elapsed())
}

fn step_of(window: &Window) -> u64 {
    window.state().session.as_ref().map_or(0, |session| session.revision)
}

/// Seconds from a command to the sharp picture that shows it.
fn changed(harness: &mut Driven, command: SetLayer) -> anyhow::Result<f64> {
    let before = step_of(window(harness)?);
    let start = Instant::now();
    window(harness)?.act(Action::Apply(Box::new(Command::SetLayer(command))));
    wait(harness, |window| step_of(window) > before)?;
    Ok(last_work(harness, start)?.as_secs_f64())
}

/// How long after `start` work was seen last, before a while of calm: between two workers nothing is under way.
fn last_work(harness: &mut Driven, start: Instant) -> anyhow::Result<Duration> {
    let mut last = start.elapsed();
    while start.elapsed() < last + CALM {
        if !window(harness)?.is_settled() {
            last = start.elapsed();
        }
        if start.elapsed() > PATIENCE {
            bail!("it took longer than {PATIENCE:?}");
        }
        std::thread::sleep(Duration::from_millis(5));
    }
    Ok(last)
}

/// Pictures a second while the block is turned, from the middle of the window to the right and back.
fn turned(harness: &mut Driven, middle: egui::Pos2) -> anyhow::Result<f64> {
    let button = |pos, pressed| Event::PointerButton {
        pos,
        button: PointerButton::Primary,
        pressed,
        modifiers: Modifiers::NONE,
    };
    harness.event(Event::PointerMoved(middle));
    window(harness)?;
    harness.event(button(middle, true));
    let (start, mut pictures) = (Instant::now(), 0u32);
    let mut shown = window(harness)?.picture_number();
    let (mut at, mut steps) = (middle, 0);
    while start.elapsed() < TURNING {
        steps += 1;
        at.x += if steps / 40 % 2 == 0 { 3.0 } else { -3.0 };
        harness.event(Event::PointerMoved(at));
        let now = window(harness)?.picture_number();
        pictures += u32::from(now > shown);
        shown = now;
        std::thread::sleep(Duration::from_millis(5));
    }
    let seconds = start.elapsed().as_secs_f64();
    harness.event(button(pos2(at.x, at.y), false));
    Ok(f64::from(pictures) / seconds)
}

fn median(mut seconds: Vec<f64>) -> f64 {
    seconds.sort_by(f64::total_cmp);
    seconds[seconds.len() / 2]
}

fn main() -> anyhow::Result<()> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let project = PathBuf::from(arguments.first().context("name a project")?);
    let rounds: usize = arguments.get(1).map_or(Ok(5), |text| text.parse())?;
    let [width, height] = match arguments.get(2).and_then(|text| text.split_once('x')) {
        Some((width, height)) => [width.parse()?, height.parse()?],
        None => [1280.0, 800.0],
    };
    let folder = tempfile::tempdir()?;
    let (settings, opened) = (folder.path().join("window.toml"), project);
    let show = move |ui: &mut egui::Ui, window: &mut Option<Window>| {
        let make = || Window::new(ui.ctx(), Some(settings.clone()), Some(opened.clone()));
        window.get_or_insert_with(make).show(ui);
    };
    let mut harness = Harness::builder().with_size(vec2(width, height)).build_ui_state(show, None);
    let start = Instant::now();
    wait(&mut harness, |window| window.state().session.is_some())?;
    println!("opened, drawn           {:6.2} s", last_work(&mut harness, start)?.as_secs_f64());
    let layers = window(&mut harness)?.state().session.as_ref().map(|session| session.document.layers());
    let layer = layers.and_then(|layers| layers.get(1).cloned()).context("the project has no layers")?;
    let (mut colours, mut patterns) = (Vec::new(), Vec::new());
    for round in 0..rounds {
        let shade = 90 + (round % 8) as u8 * 20;
        let colour =
            SetLayer { layer: layer.clone(), colour: Some(Colour::new(shade, 150, 220)), ..SetLayer::default() };
        colours.push(changed(&mut harness, colour)?);
        let pattern = if round % 2 == 0 { "chalk" } else { "limestone" };
        let pattern = SetLayer { layer: layer.clone(), pattern: Some(pattern.to_owned()), ..SetLayer::default() };
        patterns.push(changed(&mut harness, pattern)?);
    }
    println!("colour to sharp picture {:6.2} s  (median of {rounds})", median(colours));
    println!("pattern to sharp picture{:6.2} s", median(patterns));
    let rate = turned(&mut harness, pos2(0.45 * width, 0.5 * height))?;
    println!("turning                 {rate:6.1} pictures a second");
    let out = folder.path().join("out.png");
    let form = ExportForm::new(out.display().to_string());
    let start = Instant::now();
    window(&mut harness)?.act(Action::Export(Box::new(form)));
    wait(&mut harness, |_| out.exists())?;
    println!("export, 16 × 11 cm      {:6.2} s", start.elapsed().as_secs_f64());
    Ok(())
}
