//! Doing what was meant.

use super::info;
use super::report::Report;
use super::request::{Request, Usage};
use super::terminal::Terminal;
use crate::project::Project;

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
            let effect = Project::open(&project)?.apply(&command, &progress)?;
            let mut report = Report::line(effect.summary());
            report.fields(&effect);
            report
        }
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
