//! `petroglyph animate`: draws the frames of a motion, one after the other, into an animated file or a folder.
//!
//! A frame is written before the next one is drawn, into a hidden file or folder that gets its name at the end: whoever
//! stops it finds nothing half-written.

use super::args::AnimateArgs;
use super::draw::choose;
use super::report::Report;
use super::request::{Usage, drawing};
use super::through_time::Passage;
use super::view::ViewChanges;
use anyhow::Context;
use image::RgbaImage;
use page::FileFormat;
use page::animation::{AnimationShape, AnimationWriter};
use project::folder::refuse_inside_project;
use project::pictures::load::{self, Request};
use project::pictures::{Device, Motion, Painter, scene, write_png};
use project::{Project, memory_budget};
use render::Scene;
use std::fs::{self, File};
use std::io::{BufWriter, Write};
use std::path::{Path, PathBuf};
use std::time::Instant;
use store::Replacement;
use survey::Progress;

/// Limits of the number of frames.
const FRAMES: [u32; 2] = [2, 2000];
/// Limits of the frames a second.
const RATES: [f64; 2] = [0.1, 50.0];
/// Largest side of a frame, pixels: what viewers of animations play.
const LARGEST_SIDE: u32 = 4096;
/// Largest side of a frame where nothing is said about it.
const USUAL_SIDE: u32 = 800;
/// Resolution of numbered frames, dots an inch.
const FRAME_DPI: f64 = 150.0;

/// Where frames go.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Target {
    File(&'static FileFormat),
    Folder,
}

/// What moves.
#[derive(Debug, Clone, PartialEq)]
enum Moving {
    Turntable {
        turn_deg: f64,
    },
    Blend,
    Section {
        axis: usize,
    },
    /// Through the geological history.
    History,
    /// To a scene of the project or of a file.
    Scenes {
        to: String,
    },
}

/// An animation that was asked for.
#[derive(Debug)]
pub(super) struct AnimateRequest {
    project: PathBuf,
    out: PathBuf,
    scene: Option<String>,
    moving: Moving,
    frames: u32,
    rate: f64,
    is_once: bool,
    has_size: bool,
    device: Device,
    volume_bytes: Option<u64>,
    view: ViewChanges,
    target: Target,
}

impl TryFrom<AnimateArgs> for AnimateRequest {
    type Error = Usage;

    fn try_from(typed: AnimateArgs) -> Result<Self, Usage> {
        let axis = match typed.along.as_str() {
            "inline" => 0,
            "crossline" => 1,
            "slice" => 2,
            other => return Err(format!("--along {other}: expected inline, crossline or slice")),
        };
        if !(typed.turn.abs() <= 36_000.0 && typed.turn != 0.0) {
            return Err(format!("--turn {}: expected degrees other than 0, at most 36000", typed.turn));
        }
        let moving = match (typed.motion.as_str(), typed.to) {
            ("turntable" | "scenes", Some(to)) => Moving::Scenes { to },
            (other, Some(_)) => return Err(format!("--motion {other}: --to names a scene for --motion scenes")),
            ("turntable", None) => Moving::Turntable { turn_deg: typed.turn },
            ("blend", None) => Moving::Blend,
            ("section", None) => Moving::Section { axis },
            ("history", None) => Moving::History,
            ("scenes", None) => return Err("--motion scenes: name the scene that it leads to with --to".to_owned()),
            (other, None) => {
                return Err(format!("--motion {other}: expected turntable, blend, section, history or scenes"));
            }
        };
        if !(FRAMES[0]..=FRAMES[1]).contains(&typed.frames) {
            return Err(format!("--frames {}: expected {} to {}", typed.frames, FRAMES[0], FRAMES[1]));
        }
        if !(typed.rate >= RATES[0] && typed.rate <= RATES[1]) {
            return Err(format!("--rate {}: expected {} to {} frames a second", typed.rate, RATES[0], RATES[1]));
        }
        let (device, volume_bytes) = drawing(&typed.drawing)?;
        Ok(Self {
            target: target(&typed.out)?,
            project: typed.project,
            out: typed.out,
            scene: typed.scene,
            moving,
            frames: typed.frames,
            rate: typed.rate,
            is_once: typed.once,
            has_size: typed.view.size.is_some(),
            device,
            volume_bytes,
            view: typed.view.try_into()?,
        })
    }
}

/// Where frames go, by the name of what is written.
fn target(out: &Path) -> Result<Target, Usage> {
    if let Some(format) = FileFormat::of_animation(out) {
        return Ok(Target::File(format));
    }
    let usual = page::endings(FileFormat::animations());
    let ending = out.extension().and_then(|ending| ending.to_str()).map(str::to_ascii_lowercase);
    match ending.as_deref() {
        None => Ok(Target::Folder),
        Some("webp" | "mp4" | "webm" | "avif" | "mov" | "avi" | "mkv") => Err(format!(
            "{}: films and animated WebP or AVIF are not written; write {usual}, or a folder of numbered frames and \
             make the film from it, for example with `ffmpeg -framerate 12 -i FOLDER/%04d.png film.mp4`",
            out.display()
        )),
        Some(_) => Err(format!(
            "{}: animations are written as {usual}, or as numbered frames into a folder whose name has no ending",
            out.display()
        )),
    }
}

/// The share of the way at which a frame is.
fn share(frame: u32, frames: u32, is_closed: bool, is_once: bool) -> f64 {
    let (frame, frames) = (f64::from(frame), f64::from(frames));
    match (is_closed, is_once) {
        // The first frame follows the last.
        (true, _) => frame / frames,
        (false, true) => frame / (frames - 1.0),
        (false, false) => 1.0 - (1.0 - 2.0 * frame / frames).abs(),
    }
}

/// Draws and writes the animation.
pub(super) fn animate(request: &AnimateRequest, progress: &Progress) -> anyhow::Result<Report> {
    let started = Instant::now();
    refuse_inside_project(&request.out)?;
    if request.target == Target::Folder && holds_something(&request.out)? {
        anyhow::bail!(
            "{} is there already and not empty; name a new folder for the frames, or empty this one",
            request.out.display()
        );
    }
    let project = Project::open(&request.project)?;
    let document = project.document();
    let geometry = document.frame()?;
    if document.volumes.is_empty() && document.horizons.is_empty() {
        anyhow::bail!(
            "the project has neither horizons nor a volume, so there is nothing to draw; add a horizon or import a volume"
        );
    }
    let start = prepared(request, &project, progress)?;
    let motion = match &request.moving {
        Moving::History => return animate_history(request, &project, &start, started, progress),
        Moving::Turntable { turn_deg } => Motion::Turntable { turn_deg: *turn_deg },
        Moving::Section { axis } => Motion::Section { axis: *axis },
        Moving::Scenes { to } => {
            let mut end = choose(&project, Some(to))?;
            scene::prepare(document, &mut end, progress)?;
            Motion::To(Box::new(end))
        }
        Moving::Blend if document.volumes.is_empty() || document.horizons.is_empty() => {
            anyhow::bail!(
                "there is nothing to blend: the project needs a volume and horizons; add what is missing, or choose another --motion"
            )
        }
        Moving::Blend => Motion::Blend,
    };
    // A blend in between needs everything that any blend needs.
    let is_blended = start.blend > 0.0 || !matches!(motion, Motion::Turntable { .. } | Motion::Section { .. });
    let blend = if is_blended && !document.volumes.is_empty() { 0.5 } else { 0.0 };
    let mut needed = Scene { blend, ..start.clone() };
    if let Motion::To(end) = &motion {
        load::add_needs(&mut needed, end);
    }
    let volume_bytes = request.volume_bytes.unwrap_or_else(memory_budget::half_of_available);
    let loaded = load::load(project.facts(), &Request::new(&needed).within(volume_bytes), progress)?;
    let mut painter = Painter::new(request.device, progress)?;
    let draw = |frame: u32| -> anyhow::Result<RgbaImage> {
        let at = share(frame, request.frames, motion.is_closed(), request.is_once);
        let scene = motion.scene(&start, geometry, at);
        // The bar counts frames, not what is drawn in one.
        Ok(painter.picture(&scene, &loaded, FRAME_DPI, &progress.muted())?)
    };
    progress.begin("frames", u64::from(request.frames));
    let shape = AnimationShape { size_px: start.size_px, frames: request.frames, rate: request.rate };
    let bytes = write(&request.out, request.target, shape, draw, progress)?;
    Ok(told(request, shape, bytes, painter.device(), started))
}

/// Draws and writes the frames of a block that goes through its geological history.
fn animate_history(
    request: &AnimateRequest,
    project: &Project,
    start: &Scene,
    started: Instant,
    progress: &Progress,
) -> anyhow::Result<Report> {
    let volume_bytes = request.volume_bytes.unwrap_or_else(memory_budget::half_of_available);
    let pace = (request.frames, request.rate);
    let mut passage = Passage::new(project, start, pace, (volume_bytes, FRAME_DPI), progress)?;
    let mut painter = Painter::new(request.device, progress)?;
    progress.begin("frames", u64::from(request.frames));
    let shape = AnimationShape { size_px: start.size_px, frames: request.frames, rate: request.rate };
    let draw = |frame: u32| passage.draw(frame, &mut painter, &progress.muted());
    let bytes = write(&request.out, request.target, shape, draw, progress)?;
    let mut report = told(request, shape, bytes, painter.device(), started);
    passage.note().into_iter().for_each(|note| {
        report.note(note);
    });
    Ok(report)
}

/// The scene that the motion starts from.
fn prepared(request: &AnimateRequest, project: &Project, progress: &Progress) -> anyhow::Result<Scene> {
    let mut start = choose(project, request.scene.as_deref())?;
    if !request.has_size {
        // Scenes are as large as figures for print; animations are looked at on a screen.
        let largest = start.size_px[0].max(start.size_px[1]).max(1);
        let scale = f64::from(USUAL_SIDE.min(largest)) / f64::from(largest);
        start.size_px = start.size_px.map(|side| ((f64::from(side) * scale).round() as u32).max(1));
    }
    request.view.change(&mut start, project.document().frame()?)?;
    let [width, height] = start.size_px;
    if width.max(height) > LARGEST_SIDE {
        anyhow::bail!(
            "frames of {width} x {height} pixels are too large for an animation; choose a --size of at most {LARGEST_SIDE} pixels a side"
        );
    }
    scene::prepare(project.document(), &mut start, progress)?;
    Ok(start)
}

/// Whether there is a file of this name, or a folder with something in it.
fn holds_something(out: &Path) -> anyhow::Result<bool> {
    if !out.exists() {
        return Ok(false);
    }
    if !out.is_dir() {
        return Ok(true);
    }
    let mut entries = fs::read_dir(out).with_context(|| format!("{} could not be read", out.display()))?;
    Ok(entries.next().is_some())
}

/// Writes all frames, completely or not at all. Returns how many bytes were written.
fn write(
    out: &Path,
    target: Target,
    shape: AnimationShape,
    mut draw: impl FnMut(u32) -> anyhow::Result<RgbaImage>,
    progress: &Progress,
) -> anyhow::Result<u64> {
    let replacement = Replacement::of(out)?;
    let cannot = || format!("{} could not be written", out.display());
    let bytes = match target {
        Target::File(format) => {
            let file = File::create(replacement.path()).with_context(cannot)?;
            let mut buffer = BufWriter::new(&file);
            let mut writer = AnimationWriter::new(&mut buffer, format, shape).with_context(cannot)?;
            for frame in 0..shape.frames {
                writer.add(&draw(frame)?).with_context(cannot)?;
                progress.step(1)?;
            }
            writer.finish().and_then(|()| buffer.flush()).and_then(|()| file.sync_all()).with_context(cannot)?;
            file.metadata().with_context(cannot)?.len()
        }
        Target::Folder => {
            fs::create_dir(replacement.path()).with_context(cannot)?;
            let mut bytes = 0;
            for frame in 0..shape.frames {
                let path = replacement.path().join(format!("{:04}.{}", frame + 1, FileFormat::usual().ending()));
                write_png(&path, &draw(frame)?, FRAME_DPI)?;
                bytes += fs::metadata(&path).with_context(cannot)?.len();
                progress.step(1)?;
            }
            bytes
        }
    };
    replacement.commit()?;
    Ok(bytes)
}

fn told(request: &AnimateRequest, shape: AnimationShape, bytes: u64, device: &str, started: Instant) -> Report {
    let [width, height] = shape.size_px;
    let seconds = f64::from(shape.frames) / shape.rate;
    let (out, megabytes) = (request.out.display(), bytes as f64 / 1e6);
    let mut report = Report::line(format!(
        "{out}: {} frames of {width} x {height} pixels, {seconds:.1} s at {} a second, {megabytes:.1} MB",
        shape.frames, shape.rate
    ));
    report
        .field("file", &request.out)
        .field("frames", shape.frames)
        .field("size_px", shape.size_px)
        .field("rate", shape.rate)
        .field("bytes", bytes)
        .field("device", device)
        .field("seconds", started.elapsed().as_secs_f64());
    report
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_name_says_what_is_written_and_films_are_refused_with_a_way_out() {
        let of = |name: &str| target(Path::new(name));
        assert_eq!(of("a.PNG"), Ok(Target::File(FileFormat::of_animation("a.png".as_ref()).unwrap())));
        assert_eq!(of("out/a.gif"), Ok(Target::File(FileFormat::of_animation("a.gif".as_ref()).unwrap())));
        assert_eq!(of("out/frames"), Ok(Target::Folder));
        for film in ["a.webp", "a.mp4", "a.avif"] {
            assert!(of(film).unwrap_err().contains("numbered frames"), "{film}");
        }
        assert!(of("a.svg").unwrap_err().contains(&page::endings(FileFormat::animations())));
    }

    #[test]
    fn frames_lead_there_and_back_or_around_or_once() {
        let all = |is_closed, is_once| (0..4).map(|frame| share(frame, 4, is_closed, is_once)).collect::<Vec<_>>();
        assert_eq!(all(true, false), [0.0, 0.25, 0.5, 0.75]);
        assert_eq!(all(false, false), [0.0, 0.5, 1.0, 0.5]);
        assert_eq!(all(false, true), [0.0, 1.0 / 3.0, 2.0 / 3.0, 1.0]);
    }

    #[test]
    fn a_file_that_is_stopped_leaves_nothing() {
        let folder = tempfile::tempdir().unwrap();
        let shape = AnimationShape { size_px: [5, 4], frames: 3, rate: 10.0 };
        for (name, kind) in [("a.gif", target(Path::new("a.gif")).unwrap()), ("frames", Target::Folder)] {
            let out = folder.path().join(name);
            let progress = Progress::silent();
            let stopped = |frame: u32| {
                if frame == 1 {
                    progress.cancel();
                }
                Ok(RgbaImage::new(5, 4))
            };
            write(&out, kind, shape, stopped, &progress).unwrap_err();
            assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 0, "{name}");
            let bytes = write(&out, kind, shape, |_| Ok(RgbaImage::new(5, 4)), &Progress::silent()).unwrap();
            assert!(out.exists() && bytes > 0);
            assert!(holds_something(&out).unwrap());
            if out.is_dir() { fs::remove_dir_all(&out).unwrap() } else { fs::remove_file(&out).unwrap() }
        }
    }
}
