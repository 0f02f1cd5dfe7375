//! The command line: parses the arguments, turns them into a request, carries it out and reports the result.
//!
//! Results go to stdout, progress and warnings to stderr; with `--json` stdout holds exactly one object. Exit codes:
//! 0 success, 1 failure, 2 wrong usage.

mod args;
mod assembly;
mod draw;
mod extraction;
mod failure;
mod hint;
mod info;
mod info_interpretation;
mod interpretation;
mod list;
mod option;
mod page;
mod report;
mod request;
mod run;
mod segy;
mod terminal;
mod view;
mod well;

use clap::Parser;
use std::process::ExitCode;

/// Runs the program with the arguments of this process.
pub fn main() -> ExitCode {
    let typed = args::Arguments::parse();
    let json = typed.json;
    let outcome = request::Request::try_from(typed.action).map_err(run::Failure::Usage).and_then(run::run);
    match outcome {
        Ok(report) => report.print(json),
        Err(failure) => failure::print(&failure, json),
    }
}
