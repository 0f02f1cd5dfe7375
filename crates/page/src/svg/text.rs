//! Lines of text, which stay text.

use super::attribute;
use super::numbers::number;
use crate::list::{DisplayList, Text};
use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use glam::DVec2;
use std::fmt::Write;
use ttf::subset::used;
use ttf::text::set;

/// The embedded face by name, and what stands in for it where it is not installed: faces of like width and weight first,
/// since programs that read no fonts in files often set text at its own length too. They come before given faces, which
/// often have figures and commas as well; those at the end have other scripts too.
const FACE: &str = "Ubuntu Light";
const LIKE: &str = "Ubuntu, 'Noto Sans Display', 'Noto Sans', 'Open Sans'";
const OTHERS: &str = "'DejaVu Sans', sans-serif";
/// The weight that is asked for. The face is light by its own name; asked for light, fontconfig takes any other light
/// face before those that stand in.
const WEIGHT: &str = "400";

/// Adds the faces with what the page needs of them; returns the list of their names.
pub(super) fn faces(into: &mut String, list: &DisplayList) -> String {
    let mut names = vec![format!("'{FACE}'"), LIKE.to_owned()];
    let lines = list.lines();
    for used in used(lines.iter().map(String::as_str)) {
        let Some(subset) = used.file_to_set_text() else { continue };
        let (name, weight) = match used.number {
            0 => (FACE.to_owned(), WEIGHT),
            // Of faces of one family each keeps its own letters.
            number if names.iter().any(|known| known.trim_matches('\'') == used.face.family()) => {
                (format!("{} {number}", used.face.family()), "100 900")
            }
            _ => (used.face.family().to_owned(), "100 900"),
        };
        let file = STANDARD.encode(&subset.file);
        let _ = writeln!(
            into,
            "<style>@font-face {{ font-family: '{name}'; font-weight: {weight}; \
             src: url('data:font/ttf;base64,{file}') format('truetype'); }}</style>"
        );
        if used.number > 0 {
            names.push(format!("'{name}'"));
        }
    }
    format!("{}, {OTHERS}", names.join(", "))
}

/// Adds a line of text: its left end on its baseline, at the length that the page gives it.
///
/// A place and a turn for each character would part letters that are joined, and scripts that run from right to left:
/// a bent line of such is a text for each of its pieces, in a group that says the whole.
pub(super) fn text(into: &mut String, line: &Text, families: &str) {
    let is_plain = line.letters.is_empty() || set(&line.text).is_plain;
    if is_plain {
        return whole(into, line, families);
    }
    let _ = writeln!(into, "<g aria-label=\"{}\">", escaped(&line.text));
    for piece in line.straight().iter().filter(|piece| !piece.text.trim().is_empty()) {
        whole(into, piece, families);
    }
    let _ = writeln!(into, "</g>");
}

/// A straight line, or a bent one whose characters each have a letter.
fn whole(into: &mut String, line: &Text, families: &str) {
    let start = line.baseline_start();
    // A bent line is written as turned altogether, so that programs that place the first letter alone set it along its
    // chord.
    let chord = match &line.letters[..] {
        [first, .., last] => (last.at - first.at).normalize_or(DVec2::X),
        _ => DVec2::X,
    };
    let letters: Vec<(DVec2, f64)> = line
        .letters
        .iter()
        .map(|letter| {
            let at = start + DVec2::new(chord.x, -chord.y).rotate(letter.at - start);
            (at, (letter.turn_deg - chord.to_angle().to_degrees() + 540.0).rem_euclid(360.0) - 180.0)
        })
        .collect();
    let each = |of: fn(&(DVec2, f64)) -> f64| letters.iter().map(|l| number(of(l))).collect::<Vec<_>>().join(" ");
    let (place, turn_deg) = match line.letters.is_empty() {
        true => (format!("x=\"{}\" y=\"{}\"", number(start.x), number(start.y)), line.turn_deg),
        false => {
            let [x, y, turn] = [each(|(at, _)| at.x), each(|(at, _)| at.y), each(|(_, turn)| *turn)];
            (format!("x=\"{x}\" y=\"{y}\" rotate=\"{turn}\""), chord.to_angle().to_degrees())
        }
    };
    let pivot = if line.letters.is_empty() { line.at } else { start };
    let _ = write!(
        into,
        "<text {place} font-family=\"{families}\" font-weight=\"{WEIGHT}\" font-size=\"{}\" xml:space=\"preserve\"",
        number(line.size)
    );
    if line.letters.is_empty() {
        let _ = write!(into, " textLength=\"{}\" lengthAdjust=\"spacingAndGlyphs\"", number(line.width()));
    }
    if set(&line.text).is_right_to_left {
        // The end of such a line is its left end.
        let _ = write!(into, " direction=\"rtl\" text-anchor=\"end\"");
    }
    attribute(into, "fill", line.ink);
    if turn_deg != 0.0 {
        let _ = write!(into, " transform=\"rotate({} {} {})\"", number(turn_deg), number(pivot.x), number(pivot.y));
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
