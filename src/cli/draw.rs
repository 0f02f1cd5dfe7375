//! `petroglyph render`: draws a picture, and reports the assumptions behind it.

use super::page::PageRequest;
use super::report::Report;
use super::request::RenderRequest;
use super::run::scene_file;
use project::Project;
use project::folder::refuse_inside_project;
use project::memory_budget;
use project::pictures::figures::NamedConfusion;
use project::pictures::load::{self, Extent, Request};
use project::pictures::scene;
use project::pictures::{Device, Painter, figures};
use render::{FaceData, Scene};
use std::path::{Path, PathBuf};
use survey::{Progress, VerticalUnit};
use system::command_line::CommandLine;
use system::memory;

/// Most layers that are named where a list of them is told.
const MOST_NAMED: usize = 12;

/// Memory that is needed for each pixel: its colour as floats and as bytes, and once more in the file.
const PIXEL_BYTES: usize = 24;

/// Millimetres in an inch.
const INCH_MM: f64 = 25.4;

/// Draws the picture.
pub(super) fn draw(request: &RenderRequest, progress: &Progress) -> anyhow::Result<Report> {
    // Said before the work, not after it.
    refuse_inside_project(&request.out)?;
    let project = Project::open(&request.project)?;
    let document = project.document();
    let mut scene = choose(&project, request.scene.as_deref())?;
    request.volume_rendering.change(&mut scene, document)?;
    let mut view = request.view.with_wells(&project)?;
    if request.scene.is_none() && document.scenes.is_empty() {
        view = view.with_nearest_cut(&scene);
    }
    view.change(&mut scene, document.frame()?)?;
    if document.volumes.is_empty() && document.horizons.is_empty() {
        anyhow::bail!(
            "the project has neither horizons nor a volume, so there is nothing to draw; add a horizon or import a volume"
        );
    }
    scene::prepare(document, &mut scene, progress)?;
    memory::check("the picture", &scene.size_px.map(|side| side as usize), PIXEL_BYTES)?;
    // Water is drawn by pages.
    let bare = PageRequest::default();
    if let Some(page) = request.figure.as_ref().or(scene.water.map(|_| &bare)) {
        return super::page::draw(request, page, &project, &scene, progress);
    }
    let volume_bytes = request.volume_bytes.unwrap_or_else(memory_budget::half_of_available);
    let mut painter = Painter::new(request.device, progress)?;
    let extent = if painter.is_processor() { Extent::Faces } else { Extent::Whole };
    let asked = Request::new(&scene).of(extent).within(volume_bytes);
    let ((image, stage), loaded) = load::drawn(project.facts(), &asked, progress, |loaded| {
        painter.draw(&scene, loaded, progress).map_err(anyhow::Error::from)
    })?;
    project::pictures::write_png(&request.out, &image, request.dpi)?;

    let distortion = match scene.face_data {
        FaceData::Distortion => loaded.distortion(&scene, progress)?,
        _ => Vec::new(),
    };
    let look_alikes = figures::confusions(project.root(), document, loaded.rock.as_deref(), &scene)?;
    let mut stages = loaded.rock.as_ref().map(|rock| rock.stages.clone()).unwrap_or_default();
    stages.push(stage);
    let mut report = Report::line(written(&request.out, scene.size_px, request.dpi));
    advise(&request.project, look_alikes, &mut report);
    super::distortion::say(document, &distortion, &mut report);
    let assumed = assumptions(&project, &scene);
    assumed.iter().for_each(|line| {
        report.say(format!("  {line}"));
    });
    report
        .field("file", &request.out)
        .field("size_px", scene.size_px)
        .field("dpi", request.dpi)
        .field("exaggeration", scene.exaggeration)
        .field("blend", scene.blend)
        .field("device", painter.device())
        .field("assumptions", assumed)
        .field("stages", stages);
    Ok(report)
}

/// Makes all figures of a project.
pub(super) fn figures(
    root: &Path,
    out: &Path,
    fonts: &[PathBuf],
    (device, volume_bytes): (Device, Option<u64>),
    progress: &Progress,
) -> anyhow::Result<Report> {
    let volume_bytes = volume_bytes.unwrap_or_else(memory_budget::half_of_available);
    let made = figures::make_all(&Project::open(root)?, out, (device, volume_bytes), fonts, progress)?;
    let mut report = Report::default();
    let mut pairs: Vec<NamedConfusion> = Vec::new();
    for figure in &made {
        report.say(written(&figure.file, figure.size_px, figure.dpi));
        let new: Vec<_> = figure.look_alikes.iter().filter(|pair| !pairs.contains(pair)).cloned().collect();
        pairs.extend(new);
    }
    advise(root, pairs, &mut report);
    report.field("figures", made);
    Ok(report)
}

/// Pairs of layers that are told; others are counted.
const TOLD: usize = 5;

/// Says which neighbouring layers cannot be told apart, and what helps.
pub(super) fn advise(project: &Path, pairs: Vec<NamedConfusion>, report: &mut Report) {
    for pair in pairs.iter().take(TOLD) {
        let remedy = pair.change.as_ref().zip(pair.confusion.remedy.as_ref());
        let help = remedy.map_or_else(String::new, |(layer, remedy)| {
            let line = CommandLine::new("layer set").value(project).value(layer);
            let line = remedy.pattern.iter().fold(line, |line, pattern| line.option("--pattern", pattern));
            format!("; `{}` tells them apart", line.option("--colour", remedy.colour.to_string()))
        });
        report.note(format!("{pair}{help}"));
    }
    if pairs.len() > TOLD {
        report.note(format!("{} more pairs of neighbours cannot be told apart", pairs.len() - TOLD));
    }
    report.field("look_alikes", pairs);
}

/// A file that was written, its size in pixels and on paper.
pub(super) fn written(file: &Path, [width, height]: [u32; 2], dpi: f64) -> String {
    let millimetres = |pixels: u32| f64::from(pixels) / dpi * INCH_MM;
    let (width_mm, height_mm) = (millimetres(width), millimetres(height));
    format!("{}: {width} x {height} pixels, {width_mm:.0} x {height_mm:.0} mm at {dpi} dpi", file.display())
}

/// The scene that was asked for: a named one, or one from a file.
pub(super) fn choose(project: &Project, wanted: Option<&str>) -> anyhow::Result<Scene> {
    match wanted {
        Some(file) if file.ends_with(".toml") => scene_file(Path::new(file)),
        name => Ok(scene::choose(project.document(), name)?),
    }
}

/// The assumptions that a reader of the picture must know.
pub(super) fn assumptions(project: &Project, scene: &Scene) -> Vec<String> {
    let document = project.document();
    let mut lines = Vec::new();
    for medium in scene.media.all() {
        lines.push(format!("volume rendering of {}", medium.volume));
    }
    let in_time = document.geometry.as_ref().filter(|frame| frame.vertical.unit == VerticalUnit::Milliseconds);
    match in_time {
        Some(frame) => lines.push(format!(
            "vertical exaggeration {} at {} m/s, the velocity that turns two-way time into metres",
            scene.exaggeration, frame.velocity_m_s
        )),
        None => lines.push(format!("vertical exaggeration {}", scene.exaggeration)),
    }
    if scene.blend > 0.0 || document.horizons.is_empty() {
        let shown = scene.raw.as_ref().or(document.style.raw.as_ref()).map(|raw| raw.volume.as_str());
        let entry = document.volumes.iter().find(|entry| shown.is_none_or(|name| name == entry.name));
        if let Some(entry) = entry {
            lines.push(format!("raw data: volume {}, {} polarity", entry.name, entry.polarity));
        }
    }
    let styled = |name: &String| document.style.layers.style(name).is_some();
    let by_default: Vec<String> = document.layers().into_iter().filter(|name| !styled(name)).collect();
    if !document.horizons.is_empty() && !by_default.is_empty() {
        let named = by_default.iter().take(MOST_NAMED).map(String::as_str).collect::<Vec<_>>().join(", ");
        let more = by_default.len().saturating_sub(MOST_NAMED);
        let more = if more > 0 { format!(" and {more} more") } else { String::new() };
        lines.push(format!("patterns chosen by default: {named}{more}"));
    }
    lines
}
