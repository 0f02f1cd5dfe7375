//! Failures on the terminal: an error in one sentence, and a hint.

use super::plain::{plain, plain_json};
use super::report::write_out;
use super::run::Failure;
use super::subject::Asked;
use super::{hint, option};
use project::error::remedy_of;
use std::error::Error;
use std::io::Write;
use std::process::ExitCode;

/// Why a command was not carried out: one sentence, and what to do next.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Refusal {
    /// The exit code of the program: 1 a failure, 2 wrong usage.
    pub code: u8,
    /// What is wrong.
    pub reason: String,
    /// What to do next; empty where nothing is known that helps.
    pub hint: String,
}

impl Refusal {
    /// What is wrong with the words of a command.
    pub(super) fn of_usage(told: &clap::Error, asked: &Asked) -> Self {
        let text = told.to_string();
        let reason = text.lines().next().unwrap_or_default().trim_start_matches("error: ").to_owned();
        Self { code: u8::try_from(told.exit_code()).unwrap_or(2), reason, hint: example_of(&asked.command) }
    }
}

/// What the program says about an error: the error with its causes in one sentence, and what to do next.
pub fn explain(error: impl Error + Send + Sync + 'static) -> Refusal {
    failed(&error.into(), &Asked::default())
}

/// The same for a failure of a command.
pub(super) fn refusal(failure: &Failure, asked: &Asked) -> Refusal {
    match failure {
        Failure::Usage(reason) => Refusal { code: 2, reason: reason.clone(), hint: example_of(&asked.command) },
        Failure::Failed(error) => match failed(error, asked) {
            refusal if refusal.hint.is_empty() => Refusal { hint: example_of(&asked.command), ..refusal },
            refusal => refusal,
        },
    }
}

/// What is said about an error: what its kind or its remedy says, what its own sentence ends with, or what the file
/// system's answer tells.
fn failed(error: &anyhow::Error, asked: &Asked) -> Refusal {
    let sentence = sentence(error);
    let known = hint::of(error.as_ref(), &asked.project)
        .or_else(|| remedy_of(error.as_ref()).map(|ways| format!("state {}", option::remedy(&ways))));
    let (reason, hint) = match known {
        Some(hint) => (sentence, Some(hint)),
        None => advice(sentence),
    };
    let hint = hint.or_else(|| error.chain().find_map(hint::of_files).map(str::to_owned));
    Refusal { code: 1, reason, hint: hint.unwrap_or_default() }
}

/// Prints a failure.
pub(super) fn print(failure: &Failure, asked: &Asked, json: bool) -> ExitCode {
    let Refusal { code, reason, hint } = refusal(failure, asked);
    if json {
        // The exit code says that it failed, whether or not this can be written.
        let _ = write_out(&plain_json(&serde_json::json!({ "error": reason, "hint": hint }).to_string()));
    }
    let _ = write!(std::io::stderr(), "error: {}\nhint: {}\n", plain(&reason), plain(&hint));
    ExitCode::from(code)
}

/// The hint when nothing more specific is known: where there is an example of the command.
fn example_of(command: &str) -> String {
    match command {
        "" => "`petroglyph --help` lists the commands".to_owned(),
        _ => format!("`petroglyph {command} --help` shows an example"),
    }
}

/// Splits an error of the other crates into the error and the hint, if it ends with what to do, after a semicolon or in a
/// sentence of its own.
fn advice(sentence: String) -> (String, Option<String>) {
    let own_sentence = |at: &usize| sentence[at + 2..].starts_with(char::is_uppercase);
    let stop = sentence.match_indices(". ").map(|(at, _)| at).filter(own_sentence).last();
    match stop.max(sentence.rfind("; ")) {
        Some(at) => (sentence[..at].to_owned(), Some(sentence[at + 2..].to_owned())),
        None => (sentence, None),
    }
}

/// The error with its chain of causes; a cause that is already quoted is not repeated.
fn sentence(error: &anyhow::Error) -> String {
    let mut sentence = String::new();
    for cause in error.chain() {
        let cause = cause.to_string();
        if sentence.is_empty() {
            sentence = cause;
        } else if !sentence.contains(&cause) {
            sentence = format!("{sentence}: {cause}");
        }
    }
    sentence
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn advice_is_told_from_the_reason() {
        let parts = |text: &str| advice(text.to_owned());
        assert_eq!(parts("a.b is cut; in two; copy it"), ("a.b is cut; in two".into(), Some("copy it".into())));
        assert_eq!(parts("it is 3. at 4. Check the unit"), ("it is 3. at 4".into(), Some("Check the unit".into())));
        assert_eq!(parts("it is gone").1, None);
    }

    #[test]
    fn without_a_remedy_the_file_system_or_the_command_itself_tells_what_to_do() {
        let asked = Asked { command: "horizon add".to_owned(), ..Asked::default() };
        let gone = anyhow::Error::from(std::io::Error::from(std::io::ErrorKind::NotFound)).context("reading a.csv");
        assert_eq!(refusal(&Failure::Failed(gone), &asked).hint, "check the path: there is no such file or folder");
        let other = refusal(&Failure::Failed(anyhow::anyhow!("it is gone")), &asked);
        assert_eq!(other.hint, "`petroglyph horizon add --help` shows an example");
        // Where there is no command, as in Python, nothing is said that does not help.
        assert_eq!(failed(&anyhow::anyhow!("it is gone"), &Asked::default()).hint, "");
    }

    #[test]
    fn a_cause_that_is_already_quoted_is_not_said_twice() {
        let inner = anyhow::anyhow!("no space");
        assert_eq!(sentence(&inner.context("saving failed: no space")), "saving failed: no space");
        assert_eq!(sentence(&anyhow::anyhow!("no space").context("saving failed")), "saving failed: no space");
    }
}
