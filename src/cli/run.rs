//! Doing what was meant.

use super::report::Report;
use super::request::{Request, Usage};
use super::terminal::Terminal;
use super::{info, list};
use crate::command::{AddScene, Command, SetRaw};
use crate::project::Project;
use crate::{scene, style};
use anyhow::Context;
use render::Scene;
use std::path::Path;
use survey::Progress;

/// Why there is no answer.
#[derive(Debug)]
pub(super) enum Failure {
    /// The arguments make no sense.
    Usage(Usage),
    /// It could not be done.
    Failed(anyhow::Error),
}

impl<E: Into<anyhow::Error>> From<E> for Failure {
    fn from(error: E) -> Self {
        Self::Failed(error.into())
    }
}

/// Does it.
pub(super) fn run(request: Request) -> Result<Report, Failure> {
    let (terminal, progress) = Terminal::start();
    let mut report = match request {
        Request::Info(path) => info::describe(&path)?,
        Request::Create { project, geometry } => {
            Project::create(&project, geometry)?.publish()?;
            let mut report = Report::line(format!("created {}", project.display()));
            report.field("project", project);
            report
        }
        Request::Change { project, command } => {
            change(Project::open(&project)?, &command, &progress)?
        }
        Request::AddScene { project, name, from, view } => {
            let project = Project::open(&project)?;
            let mut scene = match from {
                Some(file) => scene_file(&file)?,
                None => scene::choose(project.document(), None)?,
            };
            view.change(&mut scene, project.document().frame()?);
            change(project, &Command::AddScene(AddScene { name, scene }), &progress)?
        }
        Request::SetRaw { project, volume, map, range } => {
            let project = Project::open(&project)?;
            let raw = style::raw_colour(project.document(), volume.as_deref(), map, range)?;
            change(project, &Command::SetRaw(SetRaw { raw }), &progress)?
        }
        Request::List { project, what } => list::list(&Project::open(&project)?, what)?,
        Request::Undo(project) => {
            let undone = Project::open(&project)?.undo()?;
            let mut report = Report::line(format!("undone: {undone}"));
            report.field("undone", undone);
            report
        }
        Request::Redo(project) => {
            let redone = Project::open(&project)?.redo()?;
            let mut report = Report::line(format!("done again: {redone}"));
            report.field("redone", redone);
            report
        }
        Request::Prune(project) => {
            Project::open(&project)?.prune()?;
            Report::line("the history is forgotten; only the present state is kept")
        }
    };
    let warnings = terminal.finish();
    if !warnings.is_empty() {
        report.field("warnings", warnings);
    }
    Ok(report)
}

/// Applies a command and tells what it did.
fn change(mut project: Project, command: &Command, progress: &Progress) -> anyhow::Result<Report> {
    let effect = project.apply(command, progress)?;
    let mut report = Report::line(effect.summary());
    report.fields(&effect);
    Ok(report)
}

/// Reads a scene that a person wrote.
fn scene_file(path: &Path) -> anyhow::Result<Scene> {
    let text = std::fs::read_to_string(path).with_context(|| format!("{} could not be read", path.display()))?;
    toml::from_str(&text).with_context(|| format!("{} is not a scene", path.display()))
}
