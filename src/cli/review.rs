//! `petroglyph review` and `petroglyph export --model`: blocks that leave the program.

use super::args::{ExportArgs, ReviewArgs};
use super::report::Report;
use super::request::{Usage, drawing};
use project::Project;
use project::folder::refuse_inside_project;
use project::memory_budget;
use project::pictures::Device;
use review::glb::TRIANGLES;
use review::html::SIZES_MB;
use review::{DENSITIES, MOST_SECTIONS, ReviewSettings, ShareKind, glb, html};
use std::path::{Path, PathBuf};
use std::time::Instant;
use survey::Progress;

/// A page that was asked for.
#[derive(Debug)]
pub(super) struct ReviewRequest {
    project: PathBuf,
    out: PathBuf,
    limit: u64,
    settings: ReviewSettings,
}

/// A model that was asked for.
#[derive(Debug)]
pub(super) struct ModelRequest {
    project: PathBuf,
    out: PathBuf,
    triangles: usize,
    settings: ReviewSettings,
}

impl TryFrom<ReviewArgs> for ReviewRequest {
    type Error = Usage;

    fn try_from(typed: ReviewArgs) -> Result<Self, Usage> {
        has_ending(&typed.out, ShareKind::Page, "a page")?;
        let [least, most] = SIZES_MB;
        if !(typed.size_limit >= least && typed.size_limit <= most) {
            return Err(format!("--size-limit {}: expected {least} to {most} MB", typed.size_limit));
        }
        if typed.sections > MOST_SECTIONS {
            return Err(format!("--sections {}: expected at most {MOST_SECTIONS}", typed.sections));
        }
        let (device, volume_bytes) = drawing(&typed.drawing)?;
        Ok(Self {
            project: typed.project,
            out: typed.out,
            limit: (typed.size_limit * 1e6) as u64,
            settings: settings((typed.density, typed.sections), typed.scene, device, volume_bytes)?,
        })
    }
}

impl TryFrom<ExportArgs> for ModelRequest {
    type Error = Usage;

    fn try_from(typed: ExportArgs) -> Result<Self, Usage> {
        has_ending(&typed.out, ShareKind::Model, "a model")?;
        let [least, most] = TRIANGLES;
        if !(least..=most).contains(&typed.triangles) {
            return Err(format!("--triangles {}: expected {least} to {most}", typed.triangles));
        }
        let (device, volume_bytes) = drawing(&typed.drawing)?;
        Ok(Self {
            project: typed.project,
            out: typed.out,
            triangles: typed.triangles,
            settings: settings((typed.density, 0), typed.scene.into_iter().collect(), device, volume_bytes)?,
        })
    }
}

fn has_ending(out: &Path, kind: ShareKind, what: &str) -> Result<(), Usage> {
    let told = || format!("{}: {what} has the ending .{}; name the file so", out.display(), kind.ending());
    kind.is_of(out).then_some(()).ok_or_else(told)
}

fn settings(
    (density, sections): (f64, usize),
    scenes: Vec<String>,
    device: Device,
    volume_bytes: Option<u64>,
) -> Result<ReviewSettings, Usage> {
    let [least, most] = DENSITIES;
    if !(density >= least && density <= most) {
        return Err(format!("--density {density}: expected {least} to {most} texels"));
    }
    let volume_bytes = volume_bytes.unwrap_or_else(memory_budget::half_of_available);
    Ok(ReviewSettings::new(density, sections, scenes, device, volume_bytes))
}

/// Writes a page.
pub(super) fn review(request: &ReviewRequest, progress: &Progress) -> anyhow::Result<Report> {
    let start = Instant::now();
    refuse_inside_project(&request.out)?;
    let project = Project::open(&request.project)?;
    let model = review::make(&project, &request.settings, progress)?;
    let written = html::write(&model, &request.out, request.limit, progress)?;
    let seconds = start.elapsed().as_secs_f64();
    let scenes = if written.scenes == 1 { "one scene".to_owned() } else { format!("{} scenes", written.scenes) };
    let mut report = Report::line(format!(
        "{}: {:.1} MB, {scenes}, {} triangles, {seconds:.1} s",
        request.out.display(),
        written.bytes as f64 / 1e6,
        written.triangles
    ));
    if let Some(warning) = &model.warning {
        report.say(format!("  {warning}"));
    }
    for surface in model.horizons.iter().filter(|surface| surface.picked_share < 0.995) {
        let percent = (100.0 * surface.picked_share).round();
        report.say(format!("  {}: {percent:.0} % picked; the rest is hatched", surface.name));
    }
    report.field("file", &request.out).fields(&written).field("seconds", seconds);
    Ok(report)
}

/// Writes a model.
pub(super) fn export_model(request: &ModelRequest, progress: &Progress) -> anyhow::Result<Report> {
    let start = Instant::now();
    refuse_inside_project(&request.out)?;
    let project = Project::open(&request.project)?;
    let written = glb::export(&project, &request.settings, request.triangles, &request.out, progress)?;
    let seconds = start.elapsed().as_secs_f64();
    let mut report = Report::line(format!(
        "{}: {:.1} MB, {} triangles in {} nodes, {seconds:.1} s",
        request.out.display(),
        written.bytes as f64 / 1e6,
        written.triangles,
        written.nodes
    ));
    report.say(format!(
        "  metres, Y up, X east, Z south; origin at {:.1}, {:.1}; vertical exaggeration {}",
        written.origin[0], written.origin[1], written.exaggeration
    ));
    report.say(format!(
        "  99 % of every surface is within {:.1} m of the interpretation, and all of it within {:.1} m",
        written.usual_deviation_m, written.deviation_m
    ));
    report.field("file", &request.out).fields(&written).field("seconds", seconds);
    Ok(report)
}
