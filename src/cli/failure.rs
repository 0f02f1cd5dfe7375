//! Failures on the terminal: one sentence, a hint, an exit code.

use super::run::Failure;
use crate::error::ProjectError;
use std::process::ExitCode;

/// Prints a failure: the error's chain in one sentence and what to do next.
pub(super) fn print(failure: &Failure, json: bool) -> ExitCode {
    let (code, reason, hint) = match failure {
        Failure::Usage(reason) => (2, reason.clone(), Some("`petroglyph COMMAND --help` shows an example")),
        Failure::Failed(error) => (1, sentence(error), hint(error)),
    };
    if json {
        println!("{}", serde_json::json!({ "error": reason, "hint": hint }));
    }
    eprintln!("error: {reason}");
    if let Some(hint) = hint {
        eprintln!("hint: {hint}");
    }
    ExitCode::from(code)
}

/// The chain of causes, each said once: many errors already quote what caused them.
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

fn hint(error: &anyhow::Error) -> Option<&'static str> {
    error.chain().find_map(|cause| cause.downcast_ref::<ProjectError>()?.hint())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_cause_that_is_already_quoted_is_not_said_twice() {
        let inner = anyhow::anyhow!("no space");
        assert_eq!(sentence(&inner.context("saving failed: no space")), "saving failed: no space");
        assert_eq!(sentence(&anyhow::anyhow!("no space").context("saving failed")), "saving failed: no space");
    }
}
