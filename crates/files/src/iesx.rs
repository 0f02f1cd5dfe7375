//! GeoFrame IESX (3d_ci7m): horizons as card images.
//!
//! `PROFILE name … TYPE 1  4 … 3d_ci7m.ifdf     m ms` begins a horizon and states the units of X, Y and Z; `SNAPPING
//! PARAMETERS …` is ignored; `EOD` ends the horizon. Rows have fixed columns `X Y (16 each) 3 3 Z (9) 10 10 crossline
//! (5) value (14)`, then ` I` and the inline; fields of full width touch. Magnitudes from 1e29 on are undefined.
//!
//! OpendTect writes an undefined Z with all its 39 digits, so that the row grows, and in some versions puts a line of the
//! row's own numbers behind it and `EOD` before the next.

use super::raw::{RawPoint, RawShape, RawSurface, ReadContext, VerticalFacts};
use super::text::{self, Line, SourceFile};
use super::unit::ZUnit;
use super::{Codec, Format, FormatError};
use crate::number;
use crate::number::UNDEFINED;
use glam::DVec2;

pub(super) const CODEC: Codec = Codec { read_horizon: Some(read), ..Codec::of(Format::Iesx, "iesx", "iesx", detect) };

/// Widths of the columns before the mark of the inline.
const WIDTHS: [usize; 9] = [16, 16, 3, 3, 9, 10, 10, 5, 14];

fn detect(source: &SourceFile) -> Option<String> {
    let start = String::from_utf8_lossy(&source.bytes[..source.bytes.len().min(2000)]).into_owned();
    text::lines(&start)
        .any(|l| l.text.starts_with("PROFILE ") && l.text.contains("TYPE"))
        .then(|| "a line begins with PROFILE and has a TYPE".to_string())
}

fn read(source: &SourceFile, _: &ReadContext<'_>) -> Result<Vec<RawSurface>, FormatError> {
    let text = source.text();
    let mut surfaces: Vec<(RawSurface, Vec<RawPoint>)> = Vec::new();
    for line in text::lines(&text) {
        // Some exports put the end of the last part before a row.
        let words = line.text.strip_prefix("EOD").unwrap_or(line.text).trim_start();
        if words.is_empty() || words.starts_with("SNAPPING") || words.starts_with(['!', '#']) {
            continue;
        }
        if let Some(rest) = words.strip_prefix("PROFILE") {
            surfaces.push((begin(rest), Vec::new()));
            continue;
        }
        let Some((_, points)) = surfaces.last_mut() else {
            return Err(source.syntax(line.number, "PROFILE before rows", line.text));
        };
        if !points.is_empty() && is_echo(words) {
            continue;
        }
        points.push(point(source, Line { text: words, ..line }, line.text.len() - words.len())?);
    }
    Ok(surfaces.into_iter().map(|(s, points)| RawSurface { shape: RawShape::Points(points), ..s }).collect())
}

/// Whether a line repeats numbers of the row before: it is too short for a row, and has no mark of an inline.
fn is_echo(words: &str) -> bool {
    let numbers: Option<Vec<f64>> = words.split_whitespace().map(number::plain).collect();
    numbers.is_some_and(|numbers| numbers.len() < WIDTHS.len())
}

fn begin(rest: &str) -> RawSurface {
    let (name, tail) = rest.split_once("TYPE").unwrap_or((rest, ""));
    // The last word is the unit of Z.
    let unit = tail.split_whitespace().last().and_then(|w| Some((ZUnit::parse(w)?, format!("PROFILE … {w}"))));
    let name = name.trim();
    let name = (!name.is_empty()).then(|| name.to_string());
    let vertical = VerticalFacts { unit, ..VerticalFacts::default() };
    RawSurface { vertical, ..RawSurface::new(name, RawShape::Points(Vec::new())) }
}

fn point(source: &SourceFile, line: Line<'_>, indent: usize) -> Result<RawPoint, FormatError> {
    let wrong =
        || source.syntax(line.number, "X, Y, two counts, Z, three crosslines, a value, I and the inline", line.text);
    let (left, right) = line.text.split_once(" I").ok_or_else(wrong)?;
    let inline = right.split_whitespace().next().and_then(number::plain).ok_or_else(wrong)?;
    let free: Vec<f64> = left.split_whitespace().map_while(number::plain).collect();
    let numbers = if free.len() == WIDTHS.len() { Some(free) } else { fixed(left, indent).or_else(|| overflown(left)) };
    let numbers = numbers.ok_or_else(wrong)?;
    let [x, y, z, crossline] = [0, 1, 4, 7].map(|n| numbers[n]);
    if [x, y, crossline, inline].iter().any(|v| !v.is_finite() || v.abs() > 1e12) {
        return Err(wrong());
    }
    Ok(RawPoint {
        lines: Some(DVec2::new(inline, crossline)),
        xy: Some(DVec2::new(x, y)),
        z: if z.abs() < UNDEFINED { z } else { f64::NAN },
        ..RawPoint::default()
    })
}

/// The numbers of fixed columns whose leading blanks were trimmed; they are cut from the end, where the widths are
/// valid.
fn fixed(left: &str, indent: usize) -> Option<Vec<f64>> {
    if !left.is_ascii() {
        return None;
    }
    let total: usize = WIDTHS.iter().sum();
    let padded = format!("{left:>total$}");
    let from = padded.len().checked_sub(total).filter(|extra| *extra <= indent)?;
    let mut at = from;
    WIDTHS
        .iter()
        .map(|width| {
            let field = padded.get(at..at + width)?;
            at += width;
            number::plain(field)
        })
        .collect()
}

/// The numbers of a row whose Z is wider than its column: X ends with its exponent, and what follows Z is cut from the
/// end.
fn overflown(left: &str) -> Option<Vec<f64>> {
    if !left.is_ascii() {
        return None;
    }
    let after_x = left.find('E')? + 4;
    let before_z = after_x + WIDTHS[1..4].iter().sum::<usize>();
    let after_z = left.len().checked_sub(WIDTHS[5..].iter().sum())?;
    let mut numbers = vec![number::plain(left.get(..after_x)?)?];
    let mut at = after_x;
    for (n, width) in WIDTHS.iter().enumerate().skip(1) {
        let end = if n == 4 { after_z } else { at + width };
        numbers.push(number::plain(left.get(at..end)?)?);
        at = end;
    }
    (before_z < after_z).then_some(numbers)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_row_with_an_undefined_z_of_all_its_digits_is_a_hole() {
        let undefined = "340282346638528859811704183484516925440.00";
        let x = format!("{:>16}{:>16}", "6.20986880E+05", "6.08088236E+06");
        let left =
            format!("{x}{:>3}{:>3}{undefined}{:>10}{:>10}{:>5}{:>14}", 0, 14, "914.00", "914.00", 914, "3.4028235E+38");
        let numbers = overflown(left.trim()).unwrap();
        assert_eq!((numbers[0], numbers[1], numbers[7]), (620986.88, 6080882.36, 914.0));
        assert!(numbers[4] > UNDEFINED);
        assert!(
            is_echo("376\t914\t648.62")
                && is_echo("648.62")
                && !is_echo(&format!("{left} I    376 XX"))
                && !is_echo("EOD")
        );
    }
}
