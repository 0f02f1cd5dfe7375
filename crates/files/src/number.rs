//! Numbers as programs and languages write them, and words for a number that is missing.

/// A number: also with a Fortran exponent (`1.5D+03`), a decimal comma where nothing else is one (`0,5`) and separators
/// of thousands (`1,234,567.8`, `1.234.567,8`, `1'234`).
pub(crate) fn of(token: &str) -> Option<f64> {
    plain(token).or_else(|| grouped(token, ',', '.')).or_else(|| grouped(token, '.', ','))
}

/// A number with a decimal point, or with none.
pub(crate) fn plain(token: &str) -> Option<f64> {
    let token = token.trim();
    if let Ok(value) = token.parse() {
        return Some(value);
    }
    if token.bytes().any(|b| matches!(b, b'd' | b'D')) && token.bytes().all(|b| b"0123456789+-.dD".contains(&b)) {
        return token.replace(['d', 'D'], "e").parse().ok();
    }
    None
}

/// Marks that separate thousands in some language, besides the comma and the point.
const THOUSANDS: [char; 5] = [' ', '\u{a0}', '\u{202f}', '\'', '\u{2019}'];

/// A number whose groups of three digits `separator`, a blank or an apostrophe separates, with that decimal mark.
fn grouped(token: &str, separator: char, decimal: char) -> Option<f64> {
    let token = token.trim();
    let digits = token.strip_prefix(['+', '-']).unwrap_or(token);
    let (whole, rest) = digits.split_once(decimal).unwrap_or((digits, "0"));
    let is_separator = |c: char| c == separator || THOUSANDS.contains(&c);
    let groups: Vec<&str> = whole.split(is_separator).collect();
    let is_number = |text: &str| text.bytes().all(|b| b.is_ascii_digit());
    let first = *groups.first()?;
    let are_groups = groups[1..].iter().all(|group| group.len() == 3 && is_number(group))
        && is_number(first)
        && (groups.len() == 1 || (1..=3).contains(&first.len()) && !first.starts_with('0'));
    let (fraction, exponent) = rest.split_at(rest.find(['e', 'E', 'd', 'D']).unwrap_or(rest.len()));
    if !are_groups || (first.is_empty() && !digits.contains(decimal)) || !is_number(fraction) || fraction.is_empty() {
        return None;
    }
    let sign = if token.starts_with('-') { "-" } else { "" };
    plain(&format!("{sign}{}.{fraction}{exponent}", groups.concat()))
}

/// How the numbers of a table are written.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub(crate) enum NumberStyle {
    /// A decimal point; commas separate thousands.
    #[default]
    Point,
    /// A decimal comma; points separate thousands.
    Comma,
}

impl NumberStyle {
    /// The style of some numbers, by the first that leaves no choice: one with both marks, or with one mark twice, or with
    /// a comma that separates no thousands. What a comma alone separates is a fraction.
    pub(crate) fn among<'a>(tokens: impl Iterator<Item = &'a str>) -> Self {
        let mut has_comma = false;
        for token in tokens.filter(|token| token.contains(',')) {
            let point = grouped(token, ',', '.').is_some();
            let comma = grouped(token, '.', ',').is_some();
            match (point, comma) {
                (true, false) => return Self::Point,
                (false, true) => return Self::Comma,
                (true, true) => has_comma = true,
                (false, false) => {}
            }
        }
        if has_comma { Self::Comma } else { Self::Point }
    }

    /// A field as a number.
    pub(crate) fn number(self, field: &str) -> Option<f64> {
        match self {
            Self::Point => plain(field).or_else(|| grouped(field, ',', '.')),
            Self::Comma if field.contains([',', '.', ' ', '\'', '\u{a0}', '\u{202f}']) => {
                grouped(field, '.', ',').or_else(|| plain(field))
            }
            Self::Comma => plain(field),
        }
    }
}

/// Whether a field says that a number is missing: an empty cell, stars of a format that was too narrow, the words of C,
/// Fortran, Excel and databases for what is no number.
pub(crate) fn is_missing(field: &str) -> bool {
    let word = field.trim().trim_matches(['(', ')', '"', '\'', '<', '>']).to_ascii_lowercase();
    let bare = word.trim_start_matches(['+', '-']);
    bare.is_empty()
        || bare.bytes().all(|b| b == b'*')
        || bare.starts_with("1.#")
        || bare.starts_with("nan")
        || MISSING.split(' ').any(|one| one == bare)
}

/// Words for a number that is missing.
const MISSING: &str =
    "null none na n/a #n/a #nv #value! #num! #div/0! undef undefined missing inf infinity ind ? . -- nodata";

/// A field that may be missing: then it is NaN.
pub(crate) fn or_missing(field: &str, style: NumberStyle) -> Option<f64> {
    match style.number(field) {
        Some(value) if value.is_finite() => Some(value),
        Some(_) => Some(f64::NAN),
        None => is_missing(field).then_some(f64::NAN),
    }
}

/// The values that programs write for nothing.
const NULLS: [f64; 7] = [-999.0, -999.25, -9999.0, -9999.25, -99999.0, -999_999.0, -32768.0];

/// Whether a value is one that programs write for nothing in tables of wells.
pub(crate) fn is_usual_null(value: f64) -> bool {
    NULLS.contains(&value) || value.abs() >= UNDEFINED
}

/// From here on a magnitude means "undefined" in the formats that write 1e30 for it.
pub(crate) const UNDEFINED: f64 = 1e29;

/// Whether a value is the null of a file, stated as `null`, or undefined.
pub(crate) fn is_null(value: f64, null: Option<f64>) -> bool {
    value.is_nan()
        || value.abs() >= UNDEFINED
        || null.is_some_and(|null| (value - null).abs() <= 1e-6 * null.abs().max(1e-6))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_as_fortran_and_four_languages_write_them() {
        for (text, value) in [
            ("1.5D+03", 1500.0),
            (" -2e1 ", -20.0),
            ("1,234,567.8", 1_234_567.8),
            ("1.234.567,8", 1_234_567.8),
            ("1 234 567,8", 1_234_567.8),
            ("6\u{a0}000\u{a0}123,25", 6_000_123.25),
            ("1'234.5", 1234.5),
            ("-12,5", -12.5),
            ("0,004", 0.004),
            ("456.000,0", 456_000.0),
        ] {
            assert_eq!(of(text), Some(value), "{text}");
        }
        for text in ["d", "12a", "1,23,4", "", "-", "1 2 3", "a,b"] {
            assert_eq!(of(text), None, "{text}");
        }
        assert!(of("nan").unwrap().is_nan());
    }

    #[test]
    fn the_style_of_a_table_is_that_of_its_clearest_number() {
        let style = |tokens: &[&str]| NumberStyle::among(tokens.iter().copied());
        assert_eq!(style(&["1,234", "5,678.5"]), NumberStyle::Point);
        assert_eq!(style(&["1,234", "5.678,5"]), NumberStyle::Comma);
        assert_eq!(style(&["6,000,123", "1,5"]), NumberStyle::Point);
        assert_eq!(style(&["12,5"]), NumberStyle::Comma);
        assert_eq!(style(&["1,234"]), NumberStyle::Comma);
        assert_eq!(style(&["1.5", "a,b"]), NumberStyle::Point);
        assert_eq!(NumberStyle::Comma.number("1.234,5"), Some(1234.5));
        assert_eq!(NumberStyle::Point.number("1,234.5"), Some(1234.5));
    }

    #[test]
    fn what_is_missing_is_known_in_the_words_of_many_programs() {
        for word in [
            "", "********", "1.#QNAN", "-1.#IND", "1.#INF", "-nan", "NaN(ind)", "#N/A", "NULL", "-", "n/a", "-inf",
            "NaNQ",
        ] {
            assert!(is_missing(word), "{word}");
        }
        for word in ["1", "-5", "abc", "name", "0x"] {
            assert!(!is_missing(word), "{word}");
        }
        assert!(or_missing("1.#QNAN", NumberStyle::Point).unwrap().is_nan());
        assert_eq!(or_missing("abc", NumberStyle::Point), None);
    }
}
