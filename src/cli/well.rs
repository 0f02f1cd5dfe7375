//! Wells: turns their options into commands, and lists them.

use super::args::{WellAction, WellAddArgs};
use super::interpretation::word;
use super::report::Report;
use super::request::{Listing, Request, Usage, coloured, numbers, remove, rename};
use files::ZUnit;
use files::well::{WellColumn, WellFiles, WellOptions, WellReport};
use project::Project;
use project::command::{AddWell, Command, WellAdded};
use project::content;
use project::error::Noun;
use survey::Progress;

/// Turns the arguments into a request.
pub(super) fn well(action: WellAction) -> Result<Request, Usage> {
    Ok(match action {
        WellAction::Add(typed) => add(*typed)?,
        WellAction::List { project } => Request::List { project, what: Listing::Wells },
        WellAction::Show { project, name } => Request::List { project, what: Listing::Well(name) },
        WellAction::Colour { project, name, colour } => coloured(project, Noun::Well, name, &colour)?,
        WellAction::Rename { project, from, to } => rename(project, Noun::Well, from, to),
        WellAction::Remove { project, name } => remove(project, Noun::Well, name),
    })
}

fn add(typed: WellAddArgs) -> Result<Request, Usage> {
    let units = ZUnit::LENGTHS.map(|unit| (unit.symbol(), unit));
    if let Some(kb) = typed.datum_m.filter(|kb| !kb.is_finite()) {
        return Err(format!("--kb {kb}: expected a number of metres"));
    }
    let options = WellOptions {
        name: Some(typed.name.clone()),
        well_in_file: typed.well_in_file,
        head: typed.head.map(|text| numbers::<2>("--head", &text, ',')).transpose()?,
        datum_m: typed.datum_m,
        md_unit: typed.md_unit.as_deref().map(|t| word("--md-unit", t, &units)).transpose()?,
        xy_unit: typed.xy_unit.as_deref().map(|t| word("--xy-unit", t, &units)).transpose()?,
        columns: typed.columns.as_deref().map(WellColumn::parse_list).transpose().map_err(|unknown| {
            format!("--columns: \"{unknown}\" is no column; expected md, inc, dip, azi, x, y, dx, dy, tvd, tvdss, z, well or -")
        })?,
    };
    let files = WellFiles {
        deviation: typed.deviation,
        collar: typed.collar,
        tops: typed.tops,
        las: typed.las,
        checkshot: typed.checkshot,
    };
    let command = AddWell { name: typed.name, files, options };
    Ok(Request::Change { project: typed.project, command: Command::AddWell(command) })
}

/// Lists the wells.
pub(super) fn list(project: &Project) -> Report {
    let document = project.document();
    let mut report = Report::default();
    for entry in &document.wells {
        report.say(format!("{}: {}", entry.name, entry.origin));
    }
    if document.wells.is_empty() {
        report.say("no wells");
    }
    report.field("wells", &document.wells);
    report
}

/// Shows one well relative to the survey and its present horizons.
pub(super) fn show(project: &Project, name: &str) -> anyhow::Result<Report> {
    let document = project.document();
    let entry = &document.wells[document.position(Noun::Well, name)?];
    let well = content::read_well(project.root(), entry)?;
    let found = WellAdded::of(&well, project.root(), document, WellReport::default(), &Progress::silent())?;
    let mut report = Report::text(found.to_string().trim_end());
    report.fields(&found).field("stations", well.path.stations());
    if let Some(checkshot) = &well.checkshot {
        report.field("checkshot", checkshot.points());
    }
    Ok(report)
}
