//! A file in memory, its lines and their fields.
//!
//! Lines may end in LF, CRLF or CR and in blanks; text that is not UTF-8 is read with replacement characters,
//! so that a stray byte in a comment does no harm and one in a number is reported with its line.

use super::number::{self, NumberStyle};
use super::{FormatError, SurfaceKind};
use std::borrow::Cow;
use std::path::{Path, PathBuf};
use system::file;

/// A file's bytes and where they come from.
pub(crate) struct SourceFile {
    /// The file.
    pub path: PathBuf,
    /// All of it.
    pub bytes: Vec<u8>,
}

/// One line of text.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Line<'a> {
    /// Number, from 1.
    pub number: usize,
    /// Text without its end and without surrounding blanks.
    pub text: &'a str,
}

impl SourceFile {
    /// Reads a whole file, an ordinary one of at most [`file::MAX_INTERPRETATION_BYTES`].
    pub(crate) fn open(path: &Path) -> Result<Self, FormatError> {
        let bytes = file::read(path, file::MAX_INTERPRETATION_BYTES).map_err(|source| FormatError::Io {
            action: "read",
            file: path.to_path_buf(),
            source,
        })?;
        Ok(Self { path: path.to_path_buf(), bytes })
    }

    /// The file as text.
    pub(crate) fn text(&self) -> Cow<'_, str> {
        String::from_utf8_lossy(&self.bytes)
    }

    /// The file name without its extension.
    pub(crate) fn stem(&self) -> String {
        self.path.file_stem().map_or_else(|| "unnamed".into(), |s| s.to_string_lossy().into_owned())
    }

    /// An error at a line.
    pub(crate) fn syntax(&self, line: usize, expected: impl Into<String>, found: &str) -> FormatError {
        FormatError::Syntax { file: self.path.clone(), line, expected: expected.into(), found: excerpt(found) }
    }

    /// A value of a grid; NaN where it is missing.
    pub(crate) fn grid_value(&self, line: usize, token: &str) -> Result<f64, FormatError> {
        let value =
            [NumberStyle::Point, NumberStyle::Comma].into_iter().find_map(|style| number::or_missing(token, style));
        value.ok_or_else(|| self.syntax(line, "a grid value", token))
    }

    /// The values of a grid in the fields of lines; NaN where they are missing.
    pub(crate) fn grid_values<'a>(&self, lines: impl Iterator<Item = Line<'a>>) -> Result<Vec<f64>, FormatError> {
        let mut values = Vec::new();
        for line in lines {
            for token in line.text.split_whitespace() {
                values.push(self.grid_value(line.number, token)?);
            }
        }
        Ok(values)
    }

    /// An error of counts.
    pub(crate) fn length(&self, what: &'static str, expected: usize, found: usize) -> FormatError {
        FormatError::Length { file: self.path.clone(), what, expected, found }
    }

    /// An error unless a grid has a value for each node.
    pub(crate) fn check_values(&self, count: [usize; 2], found: usize) -> Result<(), FormatError> {
        let expected = count[0] * count[1];
        if found == expected { Ok(()) } else { Err(self.length("grid values", expected, found)) }
    }

    /// An error where nothing of the kind is in the file.
    pub(crate) fn empty(&self, kind: SurfaceKind, why: impl Into<String>) -> FormatError {
        FormatError::Empty { file: self.path.clone(), kind, why: why.into() }
    }

    /// An error in a grid header.
    pub(crate) fn bad_grid(&self, why: impl Into<String>) -> FormatError {
        FormatError::BadGrid { file: self.path.clone(), why: why.into() }
    }

    /// An error of a file that contradicts itself.
    pub(crate) fn damaged(&self, why: impl Into<String>) -> FormatError {
        FormatError::Damaged { file: self.path.clone(), why: why.into() }
    }

    /// An error where places are angles; the evidence says why.
    pub(crate) fn degrees(&self, kind: SurfaceKind, evidence: &str) -> FormatError {
        self.empty(
            kind,
            format!("its coordinates are degrees ({evidence}): project them to the survey's coordinate system"),
        )
    }
}

/// The lines of a text, trimmed and without blank ones.
pub(crate) fn lines(text: &str) -> impl Iterator<Item = Line<'_>> {
    // A CR alone ends a line too; in a CRLF file the empty piece between the two must not count as a line.
    let lone_cr = text.contains('\r') && !text.contains('\n');
    text.split(if lone_cr { '\r' } else { '\n' })
        .enumerate()
        .map(|(n, text)| Line {
            number: n + 1,
            text: text.trim_matches(|c: char| c.is_whitespace() || c == '\u{feff}'),
        })
        .filter(|line| !line.text.is_empty())
}

/// The beginning of a text, in quotes, for an error message.
pub(crate) fn excerpt(text: &str) -> String {
    let text = text.trim();
    if text.is_empty() {
        return "nothing".into();
    }
    let mut short: String = text.chars().take(60).map(|c| if c.is_control() { '\u{fffd}' } else { c }).collect();
    if text.chars().count() > 60 {
        short.push('…');
    }
    format!("'{short}'")
}

/// Splits a line at a delimiter, or at blanks; double quotes hold a field together.
///
/// Quoted fields come without their quotes. Blanks around a field are left out.
pub(crate) fn fields(text: &str, delimiter: Option<char>) -> Vec<Field<'_>> {
    let mut fields = Vec::new();
    let mut rest = text.trim();
    while !rest.is_empty() {
        if let Some(inside) = rest.strip_prefix('"') {
            let end = inside.find('"').unwrap_or(inside.len());
            fields.push(Field { text: inside[..end].trim(), quoted: true });
            rest = inside.get(end + 1..).unwrap_or("").trim_start_matches([' ', '\r']);
            rest = match delimiter {
                Some(d) => rest.strip_prefix(d).unwrap_or(rest),
                None => rest.trim_start(),
            };
            rest = rest.trim_start_matches(' ');
            continue;
        }
        let end = match delimiter {
            Some(d) => rest.find(d),
            None => rest.find(char::is_whitespace),
        };
        let Some(end) = end else {
            fields.push(Field { text: rest.trim(), quoted: false });
            break;
        };
        fields.push(Field { text: rest[..end].trim(), quoted: false });
        let step = rest[end..].chars().next().map_or(1, char::len_utf8);
        rest = if delimiter.is_some() { rest[end + step..].trim_start_matches(' ') } else { rest[end..].trim_start() };
    }
    fields
}

/// One field of a line.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Field<'a> {
    /// Its text, unquoted and trimmed.
    pub text: &'a str,
    /// Whether it was quoted.
    pub quoted: bool,
}

#[cfg(test)]
mod tests {
    use super::*;

    fn texts(line: &str, delimiter: Option<char>) -> Vec<&str> {
        fields(line, delimiter).into_iter().map(|f| f.text).collect()
    }

    #[test]
    fn fields_with_quotes_tabs_and_blanks() {
        assert_eq!(texts("\"green event\"\t1.5\t 2\t\t3 ", Some('\t')), ["green event", "1.5", "2", "", "3"]);
        assert_eq!(texts("\"a b\" 1   2\t3", None), ["a b", "1", "2", "3"]);
        assert_eq!(texts("1; 2 ;3", Some(';')), ["1", "2", "3"]);
        assert_eq!(texts("\"never closed", None), ["never closed"]);
        assert!(fields("\"a\" 1", None)[0].quoted && !fields("\"a\" 1", None)[1].quoted);
    }

    #[test]
    fn line_ends_of_three_systems() {
        for text in ["a\nb\n\nc", "a\r\nb\r\n\r\nc\r\n", "a\rb\r\rc"] {
            let found: Vec<_> = lines(text).map(|l| (l.number, l.text)).collect();
            assert_eq!(found, [(1, "a"), (2, "b"), (4, "c")]);
        }
    }
}
