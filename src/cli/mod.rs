//! The command line: parses the arguments, turns them into a request, carries it out and reports the result.
//!
//! Results go to stdout, progress and warnings to stderr; with `--json` stdout holds exactly one object. Exit codes:
//! 0 success, 1 failure, 2 wrong usage. An answer that cannot be written is a failure; a reader that goes away is none.
//! Control characters in names and files reach no terminal (`plain`).

mod animate;
mod args;
mod assembly;
mod check;
mod cuts;
mod distortion;
mod draw;
mod extraction;
mod failure;
mod frame;
mod hint;
mod info;
mod info_interpretation;
mod interpretation;
mod list;
mod option;
mod page;
mod plain;
mod report;
mod request;
mod review;
mod run;
mod segy;
mod series;
mod subject;
mod terminal;
mod through_time;
mod view;
mod well;
mod words;

pub use failure::{Refusal, explain};
pub use words::{CommandWords, OptionWords, commands};

use clap::Parser;
use std::ffi::OsString;
use std::io::Write;
use std::process::ExitCode;
use subject::Asked;
use survey::Progress;

/// Runs the program with the arguments of this process.
pub fn main() -> ExitCode {
    let typed = match args::Arguments::try_parse() {
        Ok(typed) => typed,
        Err(told) => return help(&told),
    };
    let json = typed.json;
    let outcome = request::seconds("--wait", typed.wait)
        .and_then(|wait| Ok((request::Request::try_from(typed.action)?, wait)))
        .map_err(run::Failure::Usage)
        .and_then(|(request, wait)| run::run(request, wait));
    match outcome {
        Ok(report) => report.print(json),
        Err(failure) => {
            let words: Vec<OsString> = std::env::args_os().skip(1).collect();
            failure::print(&failure, &Asked::of(&words), json)
        }
    }
}

/// Carries out a command of which `typed` are the words, without the program's name in front. It prints nothing; the
/// answer is the object of `--json`, without warnings, which go to `progress`.
///
/// # Errors
/// The words are no command, or it could not be carried out.
pub fn answer(typed: &[OsString], progress: &Progress) -> Result<serde_json::Value, Refusal> {
    // Whoever calls has no shell before it, and other functions know no project: their hints are the same.
    let asked = Asked { project: Asked::default().project, ..Asked::of(typed) };
    let line = [OsString::from("petroglyph")].into_iter().chain(typed.iter().cloned());
    let typed = args::Arguments::try_parse_from(line).map_err(|told| Refusal::of_usage(&told, &asked))?;
    let outcome = request::seconds("--wait", typed.wait)
        .and_then(|wait| Ok((request::Request::try_from(typed.action)?, wait)))
        .map_err(run::Failure::Usage)
        .and_then(|(request, wait)| run::carry_out(request, wait, progress));
    Ok(outcome.map_err(|failure| failure::refusal(&failure, &asked))?.into_object())
}

/// Prints the help, the version, or what is wrong with the usage.
fn help(told: &clap::Error) -> ExitCode {
    let printed = told.print().and_then(|()| std::io::stdout().flush());
    let code = u8::try_from(told.exit_code()).unwrap_or(2);
    if told.use_stderr() { ExitCode::from(code) } else { report::printed(printed, ExitCode::from(code)) }
}
