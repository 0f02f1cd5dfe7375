//! Failures on the terminal: an error in one sentence, and a hint.

use super::plain::{plain, plain_json};
use super::report::write_out;
use super::run::Failure;
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
    /// What to do next.
    pub hint: String,
}

impl Refusal {
    /// What is wrong with the words of a command.
    pub(super) fn of_usage(told: &clap::Error) -> Self {
        let text = told.to_string();
        let reason = text.lines().next().unwrap_or_default().trim_start_matches("error: ").to_owned();
        Self { code: u8::try_from(told.exit_code()).unwrap_or(2), reason, hint: GENERAL_HINT.to_owned() }
    }
}

/// What the program says about an error: the error with its causes in one sentence, and what to do next.
pub fn explain(error: impl Error + Send + Sync + 'static) -> Refusal {
    refusal(&Failure::Failed(error.into()))
}

/// The same for a failure.
pub(super) fn refusal(failure: &Failure) -> Refusal {
    let (code, reason, hint) = match failure {
        Failure::Usage(reason) => (2, reason.clone(), GENERAL_HINT.to_owned()),
        Failure::Failed(error) => {
            let sentence = sentence(error);
            match hint::of(error.as_ref())
                .or_else(|| remedy_of(error.as_ref()).map(|ways| format!("state {}", option::remedy(&ways))))
            {
                Some(hint) => (1, sentence, hint),
                None => advice(sentence),
            }
        }
    };
    Refusal { code, reason, hint }
}

/// Prints a failure.
pub(super) fn print(failure: &Failure, json: bool) -> ExitCode {
    let Refusal { code, reason, hint } = refusal(failure);
    if json {
        // The exit code says that it failed, whether or not this can be written.
        let _ = write_out(&plain_json(&serde_json::json!({ "error": reason, "hint": hint }).to_string()));
    }
    let _ = write!(std::io::stderr(), "error: {}\nhint: {}\n", plain(&reason), plain(&hint));
    ExitCode::from(code)
}

/// The hint when nothing more specific is known.
const GENERAL_HINT: &str = "`petroglyph COMMAND --help` shows an example";

/// Splits an error of the other crates into the error and the hint: it ends with what to do, after a semicolon or in a
/// sentence of its own.
fn advice(sentence: String) -> (u8, String, String) {
    let own_sentence = |at: &usize| sentence[at + 2..].starts_with(char::is_uppercase);
    let stop = sentence.match_indices(". ").map(|(at, _)| at).filter(own_sentence).last();
    match stop.max(sentence.rfind("; ")) {
        Some(at) => (1, sentence[..at].to_owned(), sentence[at + 2..].to_owned()),
        None => (1, sentence, GENERAL_HINT.to_owned()),
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
        let parts = |text: &str| {
            let (_, reason, hint) = advice(text.to_owned());
            (reason, hint)
        };
        assert_eq!(parts("a.b is cut; in two; copy it"), ("a.b is cut; in two".into(), "copy it".into()));
        assert_eq!(parts("it is 3. at 4. Check the unit"), ("it is 3. at 4".into(), "Check the unit".into()));
        assert_eq!(parts("it is gone").1, GENERAL_HINT);
    }

    #[test]
    fn a_cause_that_is_already_quoted_is_not_said_twice() {
        let inner = anyhow::anyhow!("no space");
        assert_eq!(sentence(&inner.context("saving failed: no space")), "saving failed: no space");
        assert_eq!(sentence(&anyhow::anyhow!("no space").context("saving failed")), "saving failed: no space");
    }
}
