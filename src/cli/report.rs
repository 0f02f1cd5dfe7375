//! The report of a command: text for people, a JSON object for programs.

use super::plain::{plain, plain_json};
use serde_json::{Map, Value};
use std::io::{self, Write};
use std::process::ExitCode;

/// A report.
#[derive(Debug, Default)]
pub(super) struct Report {
    lines: Vec<String>,
    /// Advice, which is printed on stderr.
    notes: Vec<String>,
    object: Map<String, Value>,
    /// Whether the answer is that something is wrong: exit code 1.
    is_bad: bool,
}

impl Report {
    /// A report of one line.
    pub(super) fn line(line: impl Into<String>) -> Self {
        let mut report = Self::default();
        report.say(line);
        report
    }

    /// A report of a text with several lines.
    pub(super) fn text(text: impl Into<String>) -> Self {
        let mut report = Self::default();
        report.say_text(text);
        report
    }

    /// Adds a line for people. A line end in it comes from a name, which must not look like a line of ours: it is shown
    /// as `\n`.
    pub(super) fn say(&mut self, line: impl Into<String>) -> &mut Self {
        self.lines.push(line.into().replace('\n', "\\n"));
        self
    }

    /// Adds a text with several lines.
    pub(super) fn say_text(&mut self, text: impl Into<String>) -> &mut Self {
        self.lines.push(text.into());
        self
    }

    /// Adds a piece of advice, which people see on stderr.
    pub(super) fn note(&mut self, line: impl Into<String>) -> &mut Self {
        self.notes.push(line.into().replace('\n', "\\n"));
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

    /// The same, with the exit code of a failure if `is_bad`.
    pub(super) fn bad(self, is_bad: bool) -> Self {
        Self { is_bad, ..self }
    }

    /// The object for programs; an answer without fields has its text.
    pub(super) fn into_object(mut self) -> Value {
        if self.object.is_empty() && !self.lines.is_empty() {
            let text = self.lines.join("\n");
            self.field("text", text);
        }
        Value::Object(self.object)
    }

    /// Prints the report.
    pub(super) fn print(self, json: bool) -> ExitCode {
        for note in &self.notes {
            let _ = writeln!(io::stderr(), "note: {}", plain(note));
        }
        let written = if json {
            write_out(&plain_json(&Value::Object(self.object).to_string()))
        } else {
            write_out(&plain(&self.lines.join("\n")))
        };
        printed(written, if self.is_bad { ExitCode::FAILURE } else { ExitCode::SUCCESS })
    }
}

/// Writes a text and a line end to stdout, all of it; nothing for an empty text.
pub(super) fn write_out(text: &str) -> io::Result<()> {
    if text.is_empty() {
        return Ok(());
    }
    let mut out = io::stdout().lock();
    writeln!(out, "{text}")?;
    out.flush()
}

/// The exit code of an answer: that of a failure where it could not be written. A reader that has gone away, as `head` does, is no failure
/// of ours.
pub(super) fn printed(written: io::Result<()>, code: ExitCode) -> ExitCode {
    match written {
        Err(error) if error.kind() != io::ErrorKind::BrokenPipe => {
            let _ = writeln!(io::stderr(), "error: the answer could not be written to the standard output: {error}");
            let _ = writeln!(
                io::stderr(),
                "hint: what was asked for is done; free some space where the output goes, and ask again"
            );
            ExitCode::FAILURE
        }
        _ => code,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_name_with_a_line_end_makes_no_line_of_its_own() {
        let mut report = Report::line("Top\nnothing is damaged: conformable");
        report.say_text("one\ntwo");
        assert_eq!(report.lines, ["Top\\nnothing is damaged: conformable", "one\ntwo"]);
    }
}
