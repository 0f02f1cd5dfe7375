//! The report of a command: text for people, a JSON object for programs.

use serde_json::{Map, Value};
use std::io::Write;
use std::process::ExitCode;

/// A report.
#[derive(Debug, Default)]
pub(super) struct Report {
    lines: Vec<String>,
    object: Map<String, Value>,
}

impl Report {
    /// A report of one line.
    pub(super) fn line(line: impl Into<String>) -> Self {
        let mut report = Self::default();
        report.say(line);
        report
    }

    /// Adds a line for people.
    pub(super) fn say(&mut self, line: impl Into<String>) -> &mut Self {
        self.lines.push(line.into());
        self
    }

    /// Adds a field for programs.
    pub(super) fn field(&mut self, name: &str, value: impl serde::Serialize) -> &mut Self {
        // Only non-finite floats and maps with odd keys fail to serialise; neither is reported.
        self.object.insert(name.to_owned(), serde_json::to_value(value).unwrap_or(Value::Null));
        self
    }

    /// Adds the fields of a serialised struct.
    pub(super) fn fields(&mut self, value: impl serde::Serialize) -> &mut Self {
        if let Ok(Value::Object(fields)) = serde_json::to_value(value) {
            self.object.extend(fields);
        }
        self
    }

    /// Prints the report; a closed output is not an error.
    pub(super) fn print(self, json: bool) -> ExitCode {
        let text = if json { Value::Object(self.object).to_string() } else { self.lines.join("\n") };
        if !text.is_empty() {
            let _ = writeln!(std::io::stdout(), "{text}");
        }
        ExitCode::SUCCESS
    }
}
