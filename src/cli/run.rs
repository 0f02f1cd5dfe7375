//! Carries out requests.

use super::report::Report;
use super::request::{Request, Usage};
use super::terminal::Terminal;
use super::{animate, assembly, check, draw, info, list, option, review, series};
use crate::bench;
use anyhow::Context;
use files::{ExportOptions, Format, SurfaceKind};
use project::Project;
use project::ProjectError;
use project::chains::demo::{self, survey_files};
use project::chains::illustrate;
use project::command::{AddScene, Command, Effect, ProposeFaults, Restore, SetParameterization, SetRaw, TellHistory};
use project::folder::refuse_inside_project;
use project::pictures::load::Stage;
use project::pictures::{load, scene};
use project::{derived, styles};
use render::Scene;
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};
use survey::{Progress, SurveyGeometry};
use synth::SynthSettings;
use system::file;
use ttf::{TextureLibrary, contact_sheet};

/// Why a request failed.
#[derive(Debug)]
pub(super) enum Failure {
    /// The arguments are contradictory or out of range.
    Usage(Usage),
    /// It could not be carried out.
    Failed(anyhow::Error),
}

impl<E: Into<anyhow::Error>> From<E> for Failure {
    fn from(error: E) -> Self {
        Self::Failed(error.into())
    }
}

/// Opens the window, which shows progress itself; Ctrl-C ends it at once.
#[cfg(feature = "window")]
fn open_window(project: Option<PathBuf>, frame_times: Option<&Path>) -> anyhow::Result<Report> {
    app::run(project, frame_times)?;
    Ok(Report::default())
}

/// Reports that there is no window.
#[cfg(not(feature = "window"))]
fn open_window(_: Option<PathBuf>, _: Option<&Path>) -> anyhow::Result<Report> {
    anyhow::bail!(
        "this program was built without its window; build it with the feature `window`, which is on by default"
    )
}

/// Carries out a request, with progress on the terminal. Changes of a project wait for so long while another process is
/// changing it.
pub(super) fn run(request: Request, wait: Duration) -> Result<Report, Failure> {
    if let Request::Window { project, frame_times } = request {
        return Ok(open_window(project, frame_times.as_deref())?);
    }
    let (terminal, progress) = Terminal::start();
    let mut report = carry_out(request, wait, &progress)?;
    let warnings = terminal.finish();
    if !warnings.is_empty() {
        report.field("warnings", warnings);
    }
    Ok(report)
}

/// The same, with progress to wherever it is wanted.
pub(super) fn carry_out(request: Request, wait: Duration, progress: &Progress) -> Result<Report, Failure> {
    let open = |path: &Path| Project::open(path).map(|project| project.waiting(wait));
    Ok(match request {
        Request::Window { project, frame_times } => open_window(project, frame_times.as_deref())?,
        Request::Demo { out } => told({
            refuse_inside_project(&out)?;
            demo::run(&out, progress)?
        }),
        Request::Illustrate { survey, out, project, settings } => {
            told(illustrate::run(&survey, &out, &project, &settings, progress)?)
        }
        Request::Synth { out, settings } => synth(&out, &settings, progress)?,
        Request::SynthOutcrop { out, settings } => outcrop(&out, &settings, progress)?,
        Request::Info { path, distortion, segy, reading } => {
            info::describe(&path, distortion, &segy, &reading, progress)?
        }
        Request::Import { project, command } => import(&project, wait, &command, progress)?,
        Request::Export { project, out, surface: (kind, name), format, options } => {
            export(&project, &out, (kind, &name), format, &options, progress)?
        }
        Request::Extract { project, extract } => {
            let extract = Command::Extract(extract);
            match open(&project)?.apply(&extract, progress)? {
                Effect::Extracted(done) => told(done),
                other => told(other),
            }
        }
        Request::ExportCandidates { project, out } => {
            let count = project::exports::candidates::write(&open(&project)?, &out, progress)?;
            let mut report = Report::line(format!("{}: {count} points of horizon candidates", out.display()));
            report.field("file", &out).field("points", count);
            report
        }
        Request::ExportValues { project, out, horizon, values, window } => {
            let project = open(&project)?;
            let done = project::exports::surface::write_values(&project, &out, (&horizon, &values), window, progress)?;
            let mut report = Report::line(format!("{}: {} nodes of {horizon}", out.display(), done.nodes));
            report.field("file", &out).field("nodes", done.nodes);
            report
        }
        Request::ExportVolume { project, out, volume, format } => {
            told(project::exports::volume::write(&open(&project)?, &out, &volume, format, progress)?)
        }
        Request::UploadVolume { project, url, volume } => {
            told(project::exports::volume::upload(&open(&project)?, &url, &volume, progress)?)
        }
        Request::Parameterize { project, size, change, memory } => {
            parameterize(open(&project)?, (size, memory), change, progress)?
        }
        Request::Render(request) => draw::draw(&request, progress)?,
        Request::Series(request) => series::draw(&request, progress)?,
        Request::Animate(request) => animate::animate(&request, progress)?,
        Request::Review(request) => review::review(&request, progress)?,
        Request::ExportModel(request) => review::export_model(&request, progress)?,
        Request::Figures { project, out, fonts, device, volume_bytes } => {
            draw::figures(&project, &out, &fonts, (device, volume_bytes), progress)?
        }
        Request::Patterns { out, project } => patterns(&out, project.as_deref())?,
        Request::BenchSegy { side, folder } => told(bench::segy::run(side, &folder, progress)?),
        Request::Bench { sizes, dump } => told(bench::run(sizes, dump.as_deref(), progress)?),
        Request::Create { project, geometry, history } => create(project, geometry, history.as_deref(), progress)?,
        Request::Restore { out, restore } => restored(&out, restore, progress)?,
        Request::Change { project, command } => change(open(&project)?, &command, progress)?,
        Request::Evaluate { project, truth } => assembly::evaluate(&project, &truth, progress)?,
        Request::ProposeFaults { project, settings } => {
            let propose = Command::ProposeFaults(ProposeFaults { settings });
            match open(&project)?.apply(&propose, progress)? {
                Effect::FaultsProposed(done) => told(done),
                other => told(other),
            }
        }
        Request::AddScene { project, name, from, view } => {
            let project = open(&project)?;
            let mut scene = match from {
                Some(file) => scene_file(&file)?,
                None => scene::choose(project.document(), None)?,
            };
            view.with_wells(&project)?.change(&mut scene, project.document().frame()?)?;
            change(project, &Command::AddScene(AddScene { name, scene }), progress)?
        }
        Request::SetRaw { project, volume, map, range } => {
            let project = open(&project)?;
            let raw = styles::raw_colour(project.document(), volume.as_deref(), map, range)?;
            change(project, &Command::SetRaw(SetRaw { raw }), progress)?
        }
        Request::List { project, what } => list::list(&open(&project)?, what)?,
        Request::Undo(project) => step("undone", open(&project)?.undo()?),
        Request::Redo(project) => step("redone", open(&project)?.redo()?),
        Request::Check(project) => check::report(&project::check::check(&project, progress)?),
        Request::Repair(project) => check::report(&project::check::repair(&project, wait, progress)?),
        Request::Prune(project) => {
            open(&project)?.prune()?;
            Report::line("the history was deleted; only the present state is kept")
        }
    })
}

fn synth(out: &Path, settings: &SynthSettings, progress: &Progress) -> anyhow::Result<Report> {
    refuse_inside_project(out)?;
    Ok(told(survey_files::write(out, settings, progress)?))
}

fn outcrop(out: &Path, settings: &SynthSettings, progress: &Progress) -> anyhow::Result<Report> {
    refuse_inside_project(out)?;
    Ok(told(survey_files::write_outcrop(out, settings.size, settings.seed, progress)?))
}

/// Applies a command and reports what it did.
fn change(mut project: Project, command: &Command, progress: &Progress) -> anyhow::Result<Report> {
    let mut effect = project.apply(command, progress)?;
    option::name_in(effect.notes_mut());
    let mut report = Report::text(effect.to_string().trim_end());
    report.fields(&effect);
    Ok(report)
}

/// Creates a project; with the file of a history, the block that it tells of.
fn create(
    path: PathBuf,
    geometry: Option<SurveyGeometry>,
    history: Option<&Path>,
    progress: &Progress,
) -> anyhow::Result<Report> {
    // What is wrong with the text is known before anything is written.
    let text = history.map(|file| {
        let text = file::read_text(file, file::MAX_DOCUMENT_BYTES);
        text.with_context(|| format!("{} could not be read", file.display()))
    });
    let text = text.transpose()?;
    let mut new = Project::create(&path, geometry)?;
    let told = text
        .map(|text| {
            new.project().apply(&Command::TellHistory(TellHistory { text, ..TellHistory::default() }), progress)
        })
        .transpose();
    let told = told.with_context(|| history.map_or_else(String::new, |file| file.display().to_string()))?;
    new.publish()?;
    let mut report = Report::line(format!("created {}", path.display()));
    if let Some(effect) = told {
        report.say_text(effect.to_string().trim_end());
        report.fields(&effect);
    }
    report.field("project", path);
    Ok(report)
}

/// Restores a project into a new one, which appears only when that has succeeded.
fn restored(out: &Path, restore: Restore, progress: &Progress) -> anyhow::Result<Report> {
    let mut new = Project::create(out, None)?;
    let effect = new.project().apply(&Command::Restore(restore), progress)?;
    new.publish()?;
    let mut report = Report::line(format!("created {}", out.display()));
    report.say_text(effect.to_string().trim_end()).fields(&effect).field("project", out);
    Ok(report)
}

/// Reports a step back or forth in the history: the command that was `what`.
fn step(what: &str, summary: String) -> Report {
    let mut report = Report::line(format!("{what}: {summary}"));
    report.field(what, summary);
    report
}

/// Reads a scene file.
pub(super) fn scene_file(path: &Path) -> anyhow::Result<Scene> {
    let text = file::read_text(path, file::MAX_DOCUMENT_BYTES)
        .with_context(|| format!("{} could not be read", path.display()))?;
    toml::from_str(&text).with_context(|| format!("{} is not a scene", path.display()))
}

/// The report of an effect: its text for people, its fields for programs.
fn told(done: impl std::fmt::Display + serde::Serialize) -> Report {
    let mut report = Report::text(done.to_string().trim_end());
    report.fields(done);
    report
}

/// Imports or links a volume. A project that does not exist is created, and appears only when the import has succeeded.
fn import(path: &Path, wait: Duration, command: &Command, progress: &Progress) -> anyhow::Result<Report> {
    if path.exists() {
        return change(Project::open(path)?.waiting(wait), command, progress);
    }
    let mut project = Project::create(path, None)?;
    let mut effect = project.project().apply(command, progress)?;
    option::name_in(effect.notes_mut());
    project.publish()?;
    let mut report = Report::line(format!("created {}", path.display()));
    report.say_text(effect.to_string().trim_end()).fields(&effect).field("project", path);
    Ok(report)
}

fn export(
    project: &Path,
    out: &Path,
    surface: (SurfaceKind, &str),
    format: Format,
    options: &ExportOptions,
    progress: &Progress,
) -> anyhow::Result<Report> {
    let written =
        project::exports::surface::write(&Project::open(project)?, out, surface, (format, options), progress)?;
    let mut report = Report::line(format!("{} written as {format}", out.display()));
    for note in &written.notes {
        report.say(format!("  {note}"));
    }
    let (kind, name) = surface;
    let field = if kind == SurfaceKind::Horizon { "horizon" } else { "fault" };
    report.field("file", out).field("format", format.name()).field(field, name).fields(&written);
    Ok(report)
}

/// Computes i, j, k and keeps them, for lookups and as arrays for other programs.
fn parameterize(
    mut project: Project,
    (size, memory): (Option<[usize; 3]>, Option<u64>),
    change: Option<SetParameterization>,
    progress: &Progress,
) -> anyhow::Result<Report> {
    let mut report = Report::default();
    let size = match size {
        Some(size) => size,
        None => project.document().frame()?.size(),
    };
    project::pictures::sampling_threads(size, memory).map_err(ProjectError::from)?;
    if let Some(change) = change {
        report.say(project.apply(&Command::SetParameterization(change), progress)?.summary());
    }
    let Some(rock) = load::rock(project.facts(), progress)? else {
        return Err(ProjectError::NoLayers.into());
    };
    let fresh = !derived::holds_volumes(project.root(), &rock.key, size, progress);
    let mut stages = rock.stages.clone();
    if fresh {
        let start = Instant::now();
        rock.keep_voxels(&project, size, memory, progress)?;
        stages.push(Stage::new("sampling", start.elapsed()));
    }
    let out = derived::volumes_path(project.root());
    let (model, parameterization) = (&rock.model, &rock.parameterization);
    report.say(format!(
        "{} layers in {} fault blocks, i, j, k at {} x {} x {} in {}",
        model.layer_count(),
        model.block_count(),
        size[0],
        size[1],
        size[2],
        out.display()
    ));
    // What contradicts itself has been said as a warning.
    for note in model.report().notes.iter().filter(|note| !note.is_contradiction()) {
        report.say(format!("  {note}"));
    }
    for stage in &stages {
        report.say(format!("  {}: {:.2} s", stage.stage, stage.seconds));
    }
    if !fresh {
        report.say("nothing has changed since it was last computed");
    }
    let notes: Vec<String> = model.report().notes.iter().map(ToString::to_string).collect();
    report
        .field("file", out)
        .field("size", size)
        .field("layers", model.layer_count())
        .field("blocks", model.block_count())
        .field("bytes", parameterization.bytes())
        .field("key", &rock.key)
        .field("computed", fresh)
        .field("stages", stages)
        .field("notes", notes);
    Ok(report)
}

/// Draws the sheet of patterns.
fn patterns(out: &Path, project: Option<&Path>) -> anyhow::Result<Report> {
    let library = match project {
        Some(path) => {
            let project = Project::open(path)?;
            styles::pattern_library(project.root(), project.document())?
        }
        None => TextureLibrary::builtin()?,
    };
    project::pictures::write_png(out, &contact_sheet(&library)?, SHEET_DPI)?;
    let names: Vec<&str> = library.patterns().map(|pattern| pattern.name.as_str()).collect();
    let mut report = Report::line(format!("{} patterns drawn in {}", names.len(), out.display()));
    report.field("file", out).field("patterns", names);
    Ok(report)
}

/// Resolution that the sheet of patterns is drawn at.
const SHEET_DPI: f64 = 220.0;
