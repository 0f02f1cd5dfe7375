//! Lines of text, which stay text.

use super::numbers::number;
use super::{attribute, base64};
use crate::list::{Letter, Text};
use std::collections::BTreeSet;
use std::fmt::Write;
use ttf::subset::font_of;

/// The face by name, and what stands in for it where it is not installed.
const FAMILY: &str = "'Ubuntu Light', Ubuntu, 'DejaVu Sans', sans-serif";

/// Adds the face with these characters; nothing without any.
pub(super) fn face(into: &mut String, characters: &BTreeSet<char>) {
    if !characters.is_empty() {
        let file = base64(&font_of(characters).file);
        let _ = writeln!(
            into,
            "<style>@font-face {{ font-family: 'Ubuntu Light'; font-weight: 300; \
             src: url('data:font/ttf;base64,{file}') format('truetype'); }}</style>"
        );
    }
}

/// Adds a line of text: its left end on its baseline, at the length that the page gives it.
pub(super) fn text(into: &mut String, line: &Text) {
    let start = line.baseline_start();
    let each =
        |of: fn(&Letter) -> f64| line.letters.iter().map(|letter| number(of(letter))).collect::<Vec<_>>().join(" ");
    let place = match line.letters.is_empty() {
        true => format!("x=\"{}\" y=\"{}\"", number(start.x), number(start.y)),
        false => {
            let [x, y, turn] = [each(|letter| letter.at.x), each(|letter| letter.at.y), each(|letter| letter.turn_deg)];
            format!("x=\"{x}\" y=\"{y}\" rotate=\"{turn}\"")
        }
    };
    let _ = write!(
        into,
        "<text {place} font-family=\"{FAMILY}\" font-weight=\"300\" font-size=\"{}\" xml:space=\"preserve\"",
        number(line.size)
    );
    if line.letters.is_empty() {
        let _ = write!(into, " textLength=\"{}\" lengthAdjust=\"spacingAndGlyphs\"", number(line.width()));
    }
    attribute(into, "fill", line.ink);
    if line.turn_deg != 0.0 && line.letters.is_empty() {
        let _ = write!(
            into,
            " transform=\"rotate({} {} {})\"",
            number(line.turn_deg),
            number(line.at.x),
            number(line.at.y)
        );
    }
    if let Some(halo) = line.halo {
        attribute(into, "stroke", halo.ink);
        let width = number(2.0 * halo.width);
        let _ = write!(into, " stroke-width=\"{width}\" stroke-linejoin=\"round\" paint-order=\"stroke\"");
    }
    let _ = writeln!(into, ">{}</text>", escaped(&line.text));
}

/// Text that an XML document may hold: markup escaped, and characters left out that XML does not know.
pub(super) fn escaped(text: &str) -> String {
    let mut escaped = String::with_capacity(text.len());
    for character in text.chars() {
        match character {
            '&' => escaped.push_str("&amp;"),
            '<' => escaped.push_str("&lt;"),
            '>' => escaped.push_str("&gt;"),
            '"' => escaped.push_str("&quot;"),
            '\t' | '\n' | '\r' => escaped.push(' '),
            '\u{0}'..='\u{1f}' | '\u{fffe}' | '\u{ffff}' => {}
            other => escaped.push(other),
        }
    }
    escaped
}
