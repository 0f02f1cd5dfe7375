//! Reads the keys of one table of a history's text: numbers within what makes sense, words out of a list, and the line of
//! each in an error.

use crate::error::{HistoryError, Problem};
use crate::names::alike;
use glam::{DVec2, DVec3};
use std::cell::RefCell;
use std::ops::Range;
use toml::Spanned;
use toml::de::{DeTable, DeValue};

/// Largest number that a history may state: beyond it metres of a block make no sense.
const MOST: f64 = 1e7;

/// A text, and where its lines begin.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Text<'t>(pub &'t str);

impl Text<'_> {
    /// The line of a place in the text, counted from 1.
    pub(crate) fn line(self, at: usize) -> usize {
        1 + self.0.as_bytes().iter().take(at).filter(|&&byte| byte == b'\n').count()
    }
}

/// A number may not be everything: which it may be, and why.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Within {
    /// Any number.
    Any,
    /// Above 0.
    Positive,
    /// 0 or more.
    NotNegative,
    /// From one number to another.
    Between(f64, f64),
}

impl Within {
    fn refusal(self, value: f64) -> Option<String> {
        match self {
            Self::Any => None,
            Self::Positive => (value <= 0.0).then(|| "must be above 0".to_owned()),
            Self::NotNegative => (value < 0.0).then(|| "must not be negative".to_owned()),
            Self::Between(low, high) => {
                (value < low || value > high).then(|| format!("must lie between {low} and {high}"))
            }
        }
    }
}

/// The keys of one table, each asked for by name. [`Fields::finish`] refuses those that nobody asked for.
pub(crate) struct Fields<'t> {
    text: Text<'t>,
    table: &'t DeTable<'t>,
    of: String,
    line: usize,
    asked: RefCell<Vec<&'static str>>,
}

type Value<'t> = Spanned<DeValue<'t>>;

impl<'t> Fields<'t> {
    /// Of a table that lies at `span` and is called `of` in errors.
    pub(crate) fn new(text: Text<'t>, table: &'t DeTable<'t>, span: Range<usize>, of: impl Into<String>) -> Self {
        Self { text, table, of: of.into(), line: text.line(span.start), asked: RefCell::new(Vec::new()) }
    }

    /// The line at which the table begins.
    pub(crate) fn line(&self) -> usize {
        self.line
    }

    /// Calls the table otherwise in errors from now on.
    pub(crate) fn called(&mut self, of: impl Into<String>) {
        self.of = of.into();
    }

    fn value(&self, key: &'static str) -> Option<&'t Value<'t>> {
        self.asked.borrow_mut().push(key);
        self.table.get(key)
    }

    /// Whether a key is there.
    pub(crate) fn has(&self, key: &'static str) -> bool {
        self.value(key).is_some()
    }

    /// The line of a key, or of the table where the key is missing.
    pub(crate) fn line_of(&self, key: &str) -> usize {
        self.table.get(key).map_or(self.line, |value| self.text.line(value.span().start))
    }

    /// An error at a key.
    pub(crate) fn wrong(&self, key: &str, problem: Problem) -> HistoryError {
        problem.at(self.line_of(key))
    }

    /// A number that does not fit to another one, at its key.
    pub(crate) fn unfit(&self, key: &str, said: impl Into<String>) -> HistoryError {
        self.wrong(key, Problem::Unfit { said: said.into() })
    }

    fn missing(&self, key: &'static str, meaning: &'static str) -> HistoryError {
        Problem::Missing { of: self.of.clone(), key, meaning }.at(self.line)
    }

    fn mistyped(&self, key: &str, wanted: &'static str, value: &Value<'_>) -> HistoryError {
        let found = match value.get_ref() {
            DeValue::String(text) => format!("the text \"{text}\""),
            DeValue::Integer(number) => number.as_str().to_owned(),
            DeValue::Float(number) => number.as_str().to_owned(),
            DeValue::Boolean(is) => is.to_string(),
            DeValue::Datetime(when) => when.to_string(),
            DeValue::Array(list) => format!("a list of {}", list.len()),
            DeValue::Table(_) => "a table".to_owned(),
        };
        Problem::Type { key: key.to_owned(), wanted, found }.at(self.text.line(value.span().start))
    }

    fn read(&self, key: &'static str, value: &Value<'_>, within: Within) -> Result<f64, HistoryError> {
        let number = match value.get_ref() {
            DeValue::Integer(number) if number.radix() == 10 => number.as_str().parse::<f64>().ok(),
            DeValue::Float(number) => number.as_str().parse::<f64>().ok(),
            _ => None,
        };
        let number = number.ok_or_else(|| self.mistyped(key, "a number", value))?;
        let refusal = if number.is_finite() && number.abs() <= MOST {
            within.refusal(number)
        } else {
            Some(format!("must lie between {:e} and {MOST:e}", -MOST))
        };
        refusal
            .map_or(Ok(number), |why| Err(self.wrong(key, Problem::Range { key: key.to_owned(), found: number, why })))
    }

    /// A number, if it is there.
    pub(crate) fn maybe(&self, key: &'static str, within: Within) -> Result<Option<f64>, HistoryError> {
        self.value(key).map(|value| self.read(key, value, within)).transpose()
    }

    /// A number with a default.
    pub(crate) fn or(&self, key: &'static str, within: Within, default: f64) -> Result<f64, HistoryError> {
        Ok(self.maybe(key, within)?.unwrap_or(default))
    }

    /// A number that must be there.
    pub(crate) fn number(&self, key: &'static str, within: Within, meaning: &'static str) -> Result<f64, HistoryError> {
        self.maybe(key, within)?.ok_or_else(|| self.missing(key, meaning))
    }

    /// A whole number with a default.
    pub(crate) fn count(&self, key: &'static str, most: usize, default: usize) -> Result<usize, HistoryError> {
        let Some(value) = self.value(key) else { return Ok(default) };
        let number = self.read(key, value, Within::Between(0.0, most as f64))?;
        if number.fract() == 0.0 { Ok(number as usize) } else { Err(self.mistyped(key, "a whole number", value)) }
    }

    /// Some numbers in a list, as many as one of `counts` says.
    pub(crate) fn numbers(
        &self,
        key: &'static str,
        counts: &[usize],
        wanted: &'static str,
    ) -> Result<Option<Vec<f64>>, HistoryError> {
        let Some(value) = self.value(key) else { return Ok(None) };
        let DeValue::Array(list) = value.get_ref() else { return Err(self.mistyped(key, wanted, value)) };
        if !counts.contains(&list.len()) {
            return Err(self.mistyped(key, wanted, value));
        }
        list.iter().map(|value| self.read(key, value, Within::Any)).collect::<Result<_, _>>().map(Some)
    }

    /// A place `[east, north]` or `[east, north, depth]`; what is not stated is that of `default`.
    pub(crate) fn place(&self, key: &'static str, default: DVec3) -> Result<DVec3, HistoryError> {
        let found = self.numbers(key, &[2, 3], "[east, north, depth] in m")?;
        Ok(found.map_or(default, |of| DVec3::new(of[0], of[1], of.get(2).copied().unwrap_or(default.z))))
    }

    /// Two numbers, or one for both.
    pub(crate) fn pair(&self, key: &'static str, within: Within) -> Result<Option<DVec2>, HistoryError> {
        let Some(value) = self.value(key) else { return Ok(None) };
        if !matches!(value.get_ref(), DeValue::Array(_)) {
            return self.read(key, value, within).map(|number| Some(DVec2::splat(number)));
        }
        let found = self.numbers(key, &[2], "a number, or two in a list")?;
        let Some(found) = found else { return Ok(None) };
        for &number in &found {
            if let Some(why) = within.refusal(number) {
                return Err(self.wrong(key, Problem::Range { key: key.to_owned(), found: number, why }));
            }
        }
        Ok(Some(DVec2::new(found[0], found[1])))
    }

    /// A text that is not empty, if it is there.
    pub(crate) fn maybe_text(&self, key: &'static str) -> Result<Option<String>, HistoryError> {
        let Some(value) = self.value(key) else { return Ok(None) };
        match value.get_ref() {
            DeValue::String(text) if !text.trim().is_empty() => Ok(Some(text.trim().to_owned())),
            _ => Err(self.mistyped(key, "a text in quotation marks", value)),
        }
    }

    /// A text that must be there.
    pub(crate) fn text(&self, key: &'static str, meaning: &'static str) -> Result<String, HistoryError> {
        self.maybe_text(key)?.ok_or_else(|| self.missing(key, meaning))
    }

    /// One of some words; the first where none is stated.
    pub(crate) fn word<T: Copy>(&self, key: &'static str, words: &[(&'static str, T)]) -> Result<T, HistoryError> {
        let Some(found) = self.maybe_text(key)? else { return Ok(words[0].1) };
        let known = words.iter().map(|(word, _)| *word);
        words.iter().find(|(word, _)| *word == found).map(|(_, meant)| *meant).ok_or_else(|| {
            let alike = alike(&found, known.clone());
            let known = known.map(str::to_owned).collect();
            self.wrong(key, Problem::UnknownWord { what: format!("`{key}`"), found, alike, known })
        })
    }

    /// The tables of a list, each called `of` in errors.
    pub(crate) fn tables(&self, key: &'static str, of: &str) -> Result<Vec<Fields<'t>>, HistoryError> {
        let wanted = "a list of tables in braces";
        let Some(value) = self.value(key) else { return Ok(Vec::new()) };
        let DeValue::Array(list) = value.get_ref() else { return Err(self.mistyped(key, wanted, value)) };
        let table = |value: &'t Value<'t>| match value.get_ref() {
            DeValue::Table(table) => Ok(Fields::new(self.text, table, value.span(), of)),
            _ => Err(self.mistyped(key, wanted, value)),
        };
        list.iter().map(table).collect()
    }

    /// Refuses a key that nobody asked for.
    pub(crate) fn finish(&self) -> Result<(), HistoryError> {
        let mut asked = self.asked.borrow().clone();
        asked.sort_unstable();
        asked.dedup();
        let Some(key) = self.table.keys().find(|key| !asked.contains(&key.get_ref().as_ref())) else { return Ok(()) };
        let found = key.get_ref().to_string();
        let alike = alike(&found, asked.iter().copied());
        let keys = asked.into_iter().map(str::to_owned).collect();
        Err(Problem::UnknownKey { of: self.of.clone(), found, alike, keys }.at(self.text.line(key.span().start)))
    }
}
