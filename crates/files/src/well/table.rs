//! A well's text tables: facts in comments (`# WELL DATUM: 25.0 (m)`), named columns, rows.
//!
//! The columns are named by a header line, by the last comment before the rows, or one a line between
//! `BEGIN HEADER` and `END HEADER` (Petrel). Fields are cut by `;`, tab, comma or blanks; quotes hold one
//! together.

use super::columns::{self, WellColumn};
use super::error::WellFileError;
use super::report::WellReport;
use crate::number::{self, NumberStyle};
use crate::table::{LineCut, is_comment};
use crate::text::{self, Field, Line, excerpt};
use crate::unit::ZUnit;
use crate::unit::words::{self, HeaderUnits, Quantity};
use std::path::{Path, PathBuf};
use survey::remedy::{Note, Setting};

/// A row and its line number.
pub(super) struct Row<'a> {
    pub line: Line<'a>,
    pub fields: Vec<Field<'a>>,
}

/// A table as in the file.
pub(super) struct Table<'a> {
    file: PathBuf,
    /// Comments and lines `KEY: value`: lower-case key and value.
    pub facts: Vec<(String, String)>,
    /// The names of the columns, as in the file.
    pub names: Vec<String>,
    /// The content of the columns; empty if nothing names them.
    pub columns: Vec<WellColumn>,
    /// The unit each column's name states.
    pub units: Vec<Option<ZUnit>>,
    pub rows: Vec<Row<'a>>,
    /// What the header states about units.
    header: HeaderUnits,
    /// A name alone on the line before the rows.
    pub title: Option<&'a str>,
    cut: LineCut,
}

/// A line `KEY: value` or `KEY = value`, comment marks left out.
fn fact(line: &str) -> Option<(String, String)> {
    let bare = line.trim_start_matches(['#', '!', '%', '/', ' ', '\t']);
    let (key, value) = bare.split_once(':').or_else(|| bare.split_once('='))?;
    let (key, value) = (key.trim(), value.trim());
    // A row of numbers or a time of day is not a fact.
    (!key.is_empty() && !value.is_empty() && key.chars().next().is_some_and(char::is_alphabetic))
        .then(|| (key.to_ascii_lowercase(), value.to_string()))
}

fn names_of(words: &str) -> Vec<String> {
    let cut = LineCut::of_line(words);
    // "MD (ft)" is one name although blanks cut it.
    let mut names: Vec<String> = Vec::new();
    for field in cut.fields(words) {
        match names.last_mut() {
            Some(last) if field.text.starts_with(['(', '[']) && cut.delimiter.is_none() => {
                last.push(' ');
                last.push_str(field.text);
            }
            _ => names.push(field.text.to_string()),
        }
    }
    names
}

fn known(names: &[String]) -> usize {
    names.iter().filter(|n| columns::of_name(n).0 != WellColumn::Other).count()
}

impl<'a> Table<'a> {
    /// Reads a table.
    pub(super) fn parse(file: &Path, text: &'a str) -> Self {
        let lines: Vec<Line<'a>> = text::lines(text).collect();
        let mut table = Self {
            file: file.to_owned(),
            facts: Vec::new(),
            names: Vec::new(),
            columns: Vec::new(),
            units: Vec::new(),
            rows: Vec::new(),
            header: HeaderUnits::default(),
            title: None,
            cut: LineCut { delimiter: None, style: NumberStyle::Point },
        };
        let begin = lines.iter().position(|l| l.text == "BEGIN HEADER");
        let end = lines.iter().position(|l| l.text == "END HEADER");
        let mut names: Vec<String> = Vec::new();
        let mut body = lines.as_slice();
        if let (Some(begin), Some(end)) = (begin, end)
            && begin < end
        {
            names = lines[begin + 1..end].iter().map(|l| l.text.to_string()).collect();
            table.header = HeaderUnits::of(lines[..begin].iter().map(|l| l.text));
            table.facts = lines[..begin].iter().filter_map(|l| fact(l.text)).collect();
            body = &lines[end + 1..];
        }
        let mut data: Vec<Line<'a>> = Vec::new();
        for line in body {
            let words = line.text.trim_start_matches(['#', '!', '%', '/', ' ']);
            let comment = is_comment(line.text);
            if comment && words.chars().all(|c| "=-*_ ".contains(c)) {
                continue;
            }
            if data.is_empty() && begin.is_none() {
                let found = names_of(words);
                let numbers = found.iter().filter(|w| number::plain(w).is_some()).count();
                let is_header = found.len() >= 2 && numbers == 0 && known(&found) >= 2;
                if is_header {
                    names = found;
                    continue;
                }
                if let Some(fact) = fact(line.text)
                    && (comment || numbers == 0 || number::of(&fact.1).is_some())
                {
                    table.facts.push(fact);
                    continue;
                }
            }
            if !comment {
                data.push(*line);
            }
        }
        if begin.is_none() {
            let before = data.first().map_or(usize::MAX, |first| first.number);
            table.header = HeaderUnits::of(
                body.iter().take_while(|l| l.number < before).map(|l| l.text).filter(|l| is_comment(l)),
            );
        }
        table.cut = LineCut::of(&data);
        // Wells of ResInsight and Eclipse begin with their name.
        let fields = |n: usize| data.get(n).map_or(0, |line: &Line<'_>| table.cut.fields(line.text).len());
        if names.is_empty() && fields(0) == 1 && fields(1) >= 3 {
            table.cut = LineCut::of(&data[1..]);
            table.title = Some(data.remove(0).text.trim_matches(['\'', '"']));
        }
        let cut = table.cut;
        table.rows = data.into_iter().map(|line| Row { line, fields: cut.fields(line.text) }).collect();
        for name in &names {
            let (column, unit) = columns::of_name(name);
            // Of several of a kind the first is meant.
            let again = table.columns.contains(&column);
            table.columns.push(if again { WellColumn::Other } else { column });
            table.units.push(unit);
        }
        table.names = names;
        table
    }

    /// Takes the columns that the user states; a line that names them is no row.
    pub(super) fn state(&mut self, columns: &[WellColumn]) {
        self.names.clear();
        self.assume(columns);
        let cut = self.cut;
        let is_row = |row: &Row<'_>| row.fields.iter().any(|field| cut.number(field.text).is_some());
        let first = self.rows.iter().position(is_row).unwrap_or(0);
        self.rows.drain(..first);
    }

    /// Names the columns of a table without names.
    pub(super) fn assume(&mut self, columns: &[WellColumn]) {
        self.columns = columns.to_vec();
        self.units = vec![None; columns.len()];
    }

    /// The position of a column.
    pub(super) fn position(&self, column: WellColumn) -> Option<usize> {
        self.columns.iter().position(|c| *c == column)
    }

    /// A fact by words its key must contain.
    pub(super) fn fact(&self, words: &[&str]) -> Option<&str> {
        let found = self.facts.iter().find(|(key, _)| words.iter().all(|w| key.contains(w)));
        found.map(|(_, value)| value.as_str())
    }

    /// A length among the facts, in m: the number in its unit, metres if it has none.
    pub(super) fn length_fact(&self, words: &[&str]) -> Option<f64> {
        let value = self.fact(words)?;
        let stated = words::statements(value).into_iter().find_map(|said| Some(said.number? * said.unit.in_survey()));
        stated.or_else(|| number::of(value.split([' ', '\t', '(', ';']).find(|w| !w.is_empty())?.trim_end_matches(',')))
    }

    /// The text of a field.
    pub(super) fn text(&self, row: &Row<'a>, at: usize) -> Result<&'a str, WellFileError> {
        let field = row.fields.get(at).map(|f| f.text).filter(|t| !t.is_empty());
        field.ok_or_else(|| self.syntax(row, &format!("{} fields", self.columns.len())))
    }

    /// The number in a field.
    pub(super) fn number(&self, row: &Row<'a>, at: usize) -> Result<f64, WellFileError> {
        let text = self.text(row, at)?;
        let number = self.cut.number(text).filter(|v| v.is_finite() && v.abs() < 1e12);
        number.ok_or_else(|| self.syntax(row, &format!("a number for column {}", at + 1)))
    }

    /// The number in a field; NaN where it is missing.
    pub(super) fn value(&self, row: &Row<'a>, at: usize) -> Result<f64, WellFileError> {
        let text = row.fields.get(at).map_or("", |field| field.text);
        let value = self.cut.value(text).filter(|v| v.is_nan() || v.abs() < 1e12);
        value.ok_or_else(|| self.syntax(row, &format!("a number for column {}", at + 1)))
    }

    /// The number in a field; None where it is missing or a usual null.
    pub(super) fn optional(&self, row: &Row<'a>, at: usize) -> Option<f64> {
        let number = self.cut.number(row.fields.get(at)?.text)?;
        (number.is_finite() && number.abs() < 1e12 && !number::is_usual_null(number)).then_some(number)
    }

    /// An error at a row.
    pub(super) fn syntax(&self, row: &Row<'a>, expected: &str) -> WellFileError {
        WellFileError::Syntax {
            file: self.file.clone(),
            line: row.line.number,
            expected: expected.to_string(),
            found: excerpt(row.line.text),
        }
    }

    /// Metres in one unit of a length column: as its name states, otherwise as the user states, otherwise as the header
    /// says, otherwise metres, reported among what is assumed.
    pub(super) fn length_to_m(
        &self,
        at: usize,
        told: Option<ZUnit>,
        report: &mut WellReport,
    ) -> Result<f64, WellFileError> {
        let is_place = matches!(self.columns[at], WellColumn::X | WellColumn::Y);
        let quantities: &[Quantity] = match self.columns[at] {
            WellColumn::X | WellColumn::Y => &[Quantity::Horizontal],
            WellColumn::Dx | WellColumn::Dy => &[Quantity::Offset],
            _ => &[Quantity::Depth, Quantity::Vertical],
        };
        let said = self.header.find(quantities).filter(|(said, _)| !said.unit.is_time());
        let unit = self.units[at].or(told).or(said.map(|(said, _)| said.unit));
        if let Some((first, other)) = said {
            let against = [Some(first), other].into_iter().flatten().find(|said| Some(said.unit) != unit);
            if let (Some(against), Some(unit), None) = (against, unit, told) {
                let name = self.names.get(at).map_or("its column", |name| name.trim());
                report.warn_once(Note::unless(
                    format!(
                        "{}: the unit of {name} is given twice: {} and {} ('{}'); {} is taken",
                        self.stem(),
                        unit.symbol(),
                        against.unit.symbol(),
                        against.quote,
                        unit.symbol()
                    ),
                    if is_place { Setting::XyUnit } else { Setting::MdUnit }.stated_as(against.unit.symbol()),
                ));
            }
        }
        if unit.is_none() {
            // X and Y are in the survey's metres unless something says otherwise.
            let (what, setting) = if is_place { ("X and Y", Setting::XyUnit) } else { ("lengths", Setting::MdUnit) };
            report
                .assume(Note::unless(format!("{}: {what} are taken as metres", self.stem()), setting.stated_as("ft")));
        }
        match unit.unwrap_or(ZUnit::Metres) {
            unit if unit.is_time() => Err(WellFileError::UnclearUnit {
                file: self.file.clone(),
                what: "a depth column named as a time".into(),
                candidates: "m or ft",
                header: "md_m",
            }),
            unit => Ok(unit.in_survey()),
        }
    }

    /// The unit of a column of times: as its name states, otherwise as the header says.
    pub(super) fn time_unit(&self, at: usize) -> Option<ZUnit> {
        let said = || self.header.find(&[Quantity::Time]).map(|(said, _)| said.unit);
        self.units[at].or_else(said).filter(|unit| unit.is_time())
    }

    fn stem(&self) -> String {
        self.file.file_name().map_or_else(String::new, |n| n.to_string_lossy().into_owned())
    }

    /// Keeps the rows of one well if a column names wells: the one that is given, otherwise one of `names`, otherwise
    /// the only one.
    ///
    /// # Errors
    /// [`WellFileError::NoSuchWell`] when it is not there or several are.
    pub(super) fn keep_well(&mut self, told: &Option<String>, names: &[&str]) -> Result<(), WellFileError> {
        let Some(at) = self.position(WellColumn::Well) else { return Ok(()) };
        let plain = |name: &str| name.chars().filter(|c| c.is_alphanumeric()).collect::<String>().to_lowercase();
        let of = |row: &Row<'a>| row.fields.get(at).map_or("", |f| f.text);
        let mut available: Vec<&str> = self.rows.iter().map(of).collect();
        available.sort_unstable();
        available.dedup();
        let candidates: Vec<String> =
            told.iter().map(|t| plain(t)).chain(names.iter().map(|n| plain(n))).filter(|n| !n.is_empty()).collect();
        let wanted = candidates.iter().take(if told.is_some() { 1 } else { usize::MAX });
        let found = wanted.into_iter().find(|w| available.iter().any(|a| plain(a) == **w)).cloned();
        let kept = match (found, available.as_slice()) {
            (Some(found), _) => found,
            (None, [only]) if told.is_none() => plain(only),
            _ => {
                let wanted = told.clone().or_else(|| names.first().map(|n| (*n).to_string())).unwrap_or_default();
                return Err(WellFileError::NoSuchWell {
                    file: self.file.clone(),
                    wanted,
                    available: available.join(", "),
                });
            }
        };
        self.rows.retain(|row| plain(row.fields.get(at).map_or("", |f| f.text)) == kept);
        Ok(())
    }
}
