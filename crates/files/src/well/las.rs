//! LAS 1.2, 2.0 and 3.0: curves by depth or time.
//!
//! Sections begin with `~` and a letter: V (version, wrap), W (well: STRT, STOP, STEP, NULL …), C (curves), P
//! (parameters), O (other), A (data). Lines are `MNEM.UNIT value : description`, cut at the first dot, the first blank
//! after it and the last colon. In wrapped files the values of a depth run over several lines. LAS 3.0 names its
//! sections (`~Log_Definition`, `~Log_Data`) and what separates values (`DLM. COMMA`), so that a value may be empty;
//! its curves of words are missing values, its tops are read as a table of tops ([`las_tops`](super::las_tops)), and
//! its other tables are left out.

use super::error::WellFileError;
use crate::number::{self, NumberStyle};
use crate::text::{self, Line, excerpt};
use std::path::Path;

/// A line of a LAS header.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct LasItem {
    /// Short name.
    pub mnemonic: String,
    /// Unit.
    pub unit: String,
    /// Value (of a curve: its API code).
    pub value: String,
    /// What it is.
    pub description: String,
}

/// A LAS file.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Las {
    /// 1.2, 2.0 or 3.0.
    pub version: f64,
    /// What separates values, where empty ones are kept.
    pub delimiter: Option<char>,
    /// Whether the values of a depth run over several lines.
    pub wrapped: bool,
    /// The null value.
    pub null: Option<f64>,
    /// Values that are missing for another reason: stars, words, `1.#QNAN`.
    pub missing: usize,
    /// Section W.
    pub well: Vec<LasItem>,
    /// Section P.
    pub parameters: Vec<LasItem>,
    /// Section C; the first is the index.
    pub curves: Vec<LasItem>,
    /// Values, `[curve][row]`; NaN where null.
    pub data: Vec<Vec<f64>>,
}

/// `MNEM.UNIT value : description`; None without a dot.
pub(super) fn item(text: &str) -> Option<LasItem> {
    let (mnemonic, rest) = text.split_once('.')?;
    let unit_end = rest.find(char::is_whitespace).unwrap_or(rest.len());
    let (mut unit, mut tail) = rest.split_at(unit_end);
    // `STRT.M: 12` and `DEPT.:` have the colon where a blank should be.
    if let Some(colon) = unit.find(':')
        && !unit[..colon].contains(|c: char| c.is_ascii_digit())
    {
        (unit, tail) = rest.split_at(colon);
    }
    let (value, description) = tail.rsplit_once(':').unwrap_or((tail, ""));
    Some(LasItem {
        mnemonic: mnemonic.trim().to_string(),
        unit: unit.trim().to_string(),
        value: value.trim().to_string(),
        description: description.trim().to_string(),
    })
}

impl Las {
    /// A line of section W by its mnemonic.
    pub(crate) fn well_item(&self, mnemonic: &str) -> Option<&LasItem> {
        self.well.iter().find(|i| i.mnemonic.eq_ignore_ascii_case(mnemonic))
    }

    /// A header number by its mnemonic, from sections W and P, in its own unit.
    pub fn number(&self, mnemonic: &str) -> Option<(f64, &str)> {
        let items = self.well.iter().chain(&self.parameters);
        let found = items.filter(|i| i.mnemonic.eq_ignore_ascii_case(mnemonic));
        found.filter_map(|i| Some((number::plain(i.value.split_whitespace().next()?)?, i.unit.as_str()))).next()
    }

    /// The well's name in the header.
    pub(crate) fn well_name(&self) -> Option<&str> {
        let item = self.well_item("WELL")?;
        // LAS 1.2 has text where 2.0 has its description.
        let text = if self.version < 2.0 && !item.description.is_empty() { &item.description } else { &item.value };
        Some(text.as_str()).filter(|t| !t.is_empty())
    }
}

/// The letter of a section by its title; that of LAS 3.0's log is that of LAS 2.0.
fn section_of(title: &str) -> char {
    let title = title.trim().to_ascii_lowercase();
    match title.as_str() {
        word if word.starts_with("log_def") => 'C',
        word if word.starts_with("log_data") => 'A',
        word if word.starts_with("log_par") => 'P',
        // Tables of its own: cores, tops, perforations, and their second parts.
        word if word.split(['|', '[']).next().is_some_and(|name| name.contains('_')) => 'O',
        word => word.chars().next().map_or('\0', |c| c.to_ascii_uppercase()),
    }
}

/// Reads a LAS file.
///
/// # Errors
/// [`WellFileError::LasVersion`], [`WellFileError::Las`], [`WellFileError::Syntax`].
///
/// ```
/// # use files::well::parse_las;
/// let text = "~V\nVERS. 2.0 :\nWRAP. NO :\n~W\nNULL. -999.25 :\n~C\nDEPT.M :\nGR.GAPI : Gamma\n~A\n1 30\n2 -999.25\n";
/// let las = parse_las("a.las".as_ref(), text)?;
/// assert_eq!((las.data[0][1], las.data[1][0], las.data[1][1].is_nan()), (2.0, 30.0, true));
/// # Ok::<(), files::well::WellFileError>(())
/// ```
pub fn parse_las(file: &Path, text: &str) -> Result<Las, WellFileError> {
    let bad = |why: String| WellFileError::Las { file: file.to_owned(), why };
    let mut las = Las::default();
    let mut section = '\0';
    let (mut seen_version, mut seen_data) = (false, false);
    let mut rows: Vec<Line<'_>> = Vec::new();
    for line in text::lines(text).filter(|l| !l.text.starts_with('#')) {
        if let Some(title) = line.text.strip_prefix('~') {
            section = section_of(title);
            seen_data |= section == 'A';
            continue;
        }
        match section {
            '\0' => return Err(bad(format!("it begins with {}, not with a section ~V", excerpt(line.text)))),
            'A' => rows.push(line),
            'V' => {
                let Some(item) = item(line.text) else { continue };
                match item.mnemonic.to_ascii_uppercase().as_str() {
                    "VERS" => {
                        seen_version = true;
                        las.version = item.value.split_whitespace().next().and_then(number::plain).unwrap_or(f64::NAN);
                        if !(las.version >= 1.0 && las.version < 4.0) {
                            return Err(WellFileError::LasVersion { file: file.to_owned(), version: item.value });
                        }
                    }
                    "DLM" if las.version >= 3.0 => {
                        let named = [("COMMA", ','), ("TAB", '\t')].into_iter();
                        let mut own = named.filter(|(word, _)| item.value.eq_ignore_ascii_case(word));
                        las.delimiter = own.next().map(|(_, delimiter)| delimiter);
                    }
                    "WRAP" => las.wrapped = item.value.eq_ignore_ascii_case("YES"),
                    _ => {}
                }
            }
            'W' | 'P' | 'C' => {
                let Some(item) = item(line.text) else { continue };
                match section {
                    'W' => las.well.push(item),
                    'P' => las.parameters.push(item),
                    _ => las.curves.push(item),
                }
            }
            _ => {}
        }
    }
    if !seen_version {
        return Err(bad("there is no VERS line in a section ~V".into()));
    }
    if las.curves.is_empty() {
        return Err(bad("there is no section ~C with curves".into()));
    }
    if !seen_data || rows.is_empty() {
        return Err(bad("there is no section ~A with data".into()));
    }
    las.null = las.well_item("NULL").and_then(|i| number::plain(&i.value));
    (las.data, las.missing) = data(file, &rows, &las)?;
    Ok(las)
}

/// The values, `[curve][row]`, and how many are missing but for the null.
fn data(file: &Path, rows: &[Line<'_>], las: &Las) -> Result<(Vec<Vec<f64>>, usize), WellFileError> {
    let count = las.curves.len();
    let mut data = vec![Vec::new(); count];
    let syntax = |line: &Line<'_>, expected: String| WellFileError::Syntax {
        file: file.to_owned(),
        line: line.number,
        expected,
        found: excerpt(line.text),
    };
    let (mut filled, mut missing) = (0, 0);
    for line in rows {
        let tokens: Vec<&str> = match las.delimiter {
            Some(delimiter) => line.text.split(delimiter).collect(),
            None => line.text.split([' ', '\t', ',', ';']).filter(|t| !t.is_empty()).collect(),
        };
        let before = filled;
        for token in tokens {
            let is_word = las.curves.get(filled).is_some_and(|curve| curve.description.contains("{S"));
            let value = number::or_missing(token, NumberStyle::Point).or(is_word.then_some(f64::NAN));
            let value = value.ok_or_else(|| syntax(line, "a number".into()))?;
            if filled == count {
                return Err(syntax(line, format!("{count} values, one a curve")));
            }
            missing += usize::from(value.is_nan());
            // The index may hold any number.
            data[filled].push(if filled > 0 && number::is_null(value, las.null) { f64::NAN } else { value });
            filled += 1;
        }
        if !las.wrapped && filled < count {
            return Err(syntax(line, format!("{count} values, one a curve")));
        }
        // In a wrapped file the index stands alone on the first line of its depth.
        debug_assert!(filled >= before);
        if filled == count {
            filled = 0;
        }
    }
    if filled != 0 {
        let why = format!("the last depth has {filled} values of {count}");
        return Err(WellFileError::Las { file: file.to_owned(), why });
    }
    Ok((data, missing))
}
