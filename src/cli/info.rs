//! `petroglyph info`: what a file or a project holds.

use super::report::Report;
use super::{info_interpretation, option};
use files::ImportOptions;
use files::segy::{SegyFile, SegyOptions};
use project::Project;
use project::error::Noun;
use project::pictures::load::{self, Request};
use project::pictures::scene;
use render::{FaceData, Scene};
use serde_json::json;
use std::path::Path;
use survey::{Progress, SurveyGeometry};

/// Describes what is at `path`: a project if it is a folder, else a horizon, fault or well file, else a SEG-Y file.
pub(super) fn describe(
    path: &Path,
    with_distortion: bool,
    options: &SegyOptions,
    reading: &ImportOptions,
    progress: &Progress,
) -> anyhow::Result<Report> {
    let named_project = path.extension().is_some_and(|extension| extension == "petro");
    if path.is_dir() || (named_project && !path.exists()) {
        let opened = Project::open(path)?;
        let mut report = project(&opened)?;
        if with_distortion {
            distortion(&opened, &mut report, progress)?;
        }
        return Ok(report);
    }
    if with_distortion {
        anyhow::bail!("--distortion measures the pictures of a project; {} is none", path.display());
    }
    if let Some(report) = info_interpretation::describe(path, reading)? {
        return Ok(report);
    }
    let mut file = SegyFile::open(path, options, progress)?;
    option::name_in(file.notes_mut());
    let statistics = file.statistics(progress)?;
    let mut report = Report::text(file.page(&statistics).trim_end());
    report.fields(file.info());
    report.field("amplitudes", &statistics);
    Ok(report)
}

fn project(project: &Project) -> anyhow::Result<Report> {
    let document = project.document();
    let mut report = Report::default();
    report.say(format!("project {}", project.root().display()));
    report.field("project", project.root());
    report.field("version", document.version);
    if let Some(geometry) = &document.geometry {
        frame(geometry, &mut report);
    } else {
        report.say("no survey geometry yet: import a volume");
    }
    if let Some(text) = &document.geological_history {
        report
            .say("made from a geological history (geological_history in project.toml)")
            .field("geological_history", text);
    }
    if let (Some(restored), Some(geometry)) = (&document.restored, &document.geometry) {
        report.say(restored.words(geometry.vertical.unit)).field("restored", restored);
    }
    for noun in [Noun::Volume, Noun::Horizon, Noun::Fault, Noun::Well, Noun::Layer] {
        let names = document.names(noun);
        if !names.is_empty() {
            report.say(format!("{noun}s: {}", names.join(", ")));
        }
        report.field(&format!("{noun}s"), names);
    }
    report.field("origins", document.origins());
    let history = project.history();
    if let Some(last) = history.iter().rev().find(|line| line.in_effect) {
        report.say(format!("last change: {}", last.summary));
    }
    let taken = document.parameterization.as_ref();
    if let Some(taken) = taken {
        report.say(format!("i, j, k: {}", taken.origin));
    }
    report.field("parameterization", taken.map(|taken| &taken.name));
    report.field("history", history);
    Ok(report)
}

/// The distortion of patterns on the faces of the project's scene, as printed without exaggeration.
fn distortion(project: &Project, report: &mut Report, progress: &Progress) -> anyhow::Result<()> {
    let document = project.document();
    if document.horizons.is_empty() {
        anyhow::bail!("the project has no horizons, and so no layers with patterns; add a horizon");
    }
    let scene = scene::choose(document, None)?;
    let scene = Scene { exaggeration: 1.0, blend: 0.0, face_data: FaceData::Distortion, ..scene };
    let loaded = load::load(project.facts(), &Request::new(&scene), progress)?;
    super::distortion::say(document, &loaded.distortion(&scene, progress)?, report);
    Ok(())
}

/// The lattice and its place in the world.
fn frame(geometry: &SurveyGeometry, report: &mut Report) {
    let line = |axis: &survey::LineAxis| json!({ "first": axis.first, "last": axis.last(), "step": axis.step, "count": axis.count });
    let vertical = &geometry.vertical;
    let unit = vertical.unit.symbol();
    report
        .say(format!(
            "inlines {} to {} step {} ({}), crosslines {} to {} step {} ({})",
            geometry.inlines.first,
            geometry.inlines.last(),
            geometry.inlines.step,
            geometry.inlines.count,
            geometry.crosslines.first,
            geometry.crosslines.last(),
            geometry.crosslines.step,
            geometry.crosslines.count
        ))
        .say(format!(
            "{} samples, {} to {} {unit}, every {} {unit}",
            vertical.count,
            vertical.first,
            vertical.last(),
            vertical.interval
        ))
        .field("inlines", line(&geometry.inlines))
        .field("crosslines", line(&geometry.crosslines))
        .field("samples", vertical.count)
        .field("interval", vertical.interval)
        .field("first_sample", vertical.first)
        .field("vertical_unit", unit)
        .field("velocity_m_s", geometry.velocity_m_s)
        .field(
            "geometry",
            json!({
                "origin": geometry.origin,
                "inline_vector": geometry.inline_vector,
                "crossline_vector": geometry.crossline_vector,
            }),
        );
}
