//! GXF, the grid exchange format of Geosoft: lines `#KEY` with a value on the next line, then `#GRID` and the values.
//!
//! `#POINTS` values a row, `#ROWS` rows, `#PTSEPARATION` and `#RWSEPARATION` apart, `#XORIGIN` and `#YORIGIN` of the
//! lower left corner, `#ROTATION` of the grid's bottom in degrees anticlockwise, `#SENSE` for the corner of the first
//! value and the direction of rows, `#TRANSFORM` a scale and an offset, `#DUMMY` for none. Where `#GTYPE` is n, a value
//! is n characters of base 90 from `%` on; `!` is none, `"` before a count and a value repeats it. Nothing states the
//! sign.

use super::grid::Scan;
use super::number;
use super::raw::{RawSurface, ReadContext};
use super::text::{self, SourceFile};
use super::unit::ZUnit;
use super::{Codec, Format, FormatError};
use glam::DVec2;
use std::collections::HashMap;

pub(super) const CODEC: Codec = Codec { read_horizon: Some(read), ..Codec::of(Format::Gxf, "gxf", "gxf", detect) };

/// What a grid holds where its header names no dummy.
const USUAL_DUMMY: f64 = -1e12;
/// Characters of a value, at most: 90^8 is the largest that a float holds exactly.
const MOST_CHARACTERS: usize = 8;
/// More nodes than rows of one repeated value put into a byte.
const NODES_A_BYTE: usize = 700;
/// The first character of base 90.
const ZERO: u8 = b'%';

fn detect(source: &SourceFile) -> Option<String> {
    let start = String::from_utf8_lossy(&source.bytes[..source.bytes.len().min(4000)]).into_owned();
    let has = |key: &str| text::lines(&start).any(|line| line.text.to_ascii_uppercase().starts_with(key));
    (has("#POINTS") && has("#ROWS")).then(|| "its header has #POINTS and #ROWS".to_owned())
}

fn read(source: &SourceFile, _: &ReadContext<'_>) -> Result<Vec<RawSurface>, FormatError> {
    let text = source.text();
    let mut lines = text::lines(&text).peekable();
    let mut header: HashMap<String, &str> = HashMap::new();
    while let Some(line) = lines.next() {
        let Some(key) = line.text.strip_prefix('#') else { continue };
        let key = key.split_whitespace().next().unwrap_or("").to_ascii_uppercase();
        if key == "GRID" {
            header.insert(key, "");
            break;
        }
        if let Some(value) = lines.next_if(|next| !next.text.starts_with('#')) {
            header.insert(key, value.text);
        }
    }
    if !header.contains_key("GRID") {
        return Err(source.bad_grid("it has no #GRID"));
    }
    let words = |key: &str| {
        header.get(key).map(|text| text::fields(text, text.contains(',').then_some(','))).unwrap_or_default()
    };
    let nth = |key: &str, n: usize| words(key).get(n).and_then(|field| number::of(field.text));
    let number = |key: &str, or: f64| nth(key, 0).unwrap_or(or);
    let need = |key: &str| nth(key, 0).ok_or_else(|| source.bad_grid(format!("it has no number #{key}")));
    let (points, rows) = (need("POINTS")?, need("ROWS")?);
    let characters = number("GTYPE", 0.0);
    let is_usable = points >= 1.0 && rows >= 1.0 && points * rows < 4e9;
    if !is_usable || !(0.0..=MOST_CHARACTERS as f64).contains(&characters) {
        return Err(source.bad_grid(format!("{points} points, {rows} rows, values of {characters} characters")));
    }
    let (dummy, scale, offset) =
        (number("DUMMY", USUAL_DUMMY), nth("TRANSFORM", 0).unwrap_or(1.0), nth("TRANSFORM", 1).unwrap_or(0.0));
    let count = [points as usize, rows as usize];
    if count[0] * count[1] > NODES_A_BYTE * source.bytes.len() {
        return Err(source.length("bytes at least", count[0] * count[1] / NODES_A_BYTE, source.bytes.len()));
    }
    let mut values = match characters as usize {
        0 => source.grid_values(lines)?,
        characters => {
            let packed: Vec<u8> = lines.flat_map(|line| line.text.bytes()).collect();
            unpacked(source, &packed, characters, count[0] * count[1])?
        }
    };
    let is_dummy = |value: f64| number::is_null(value, Some(dummy)) && characters == 0.0;
    values.iter_mut().for_each(|value| *value = if is_dummy(*value) { f64::NAN } else { *value * scale + offset });
    let sense = number("SENSE", 1.0);
    let scan = scan(sense, count, [number("PTSEPARATION", 1.0), number("RWSEPARATION", 1.0)], number("ROTATION", 0.0));
    let scan =
        scan.ok_or_else(|| source.bad_grid(format!("#SENSE {sense}, which is none of 1 to 4 with either sign")))?;
    let origin = DVec2::new(number("XORIGIN", 0.0), number("YORIGIN", 0.0));
    let title =
        header.get("TITLE").map(|title| title.trim_matches(['"', ' ']).to_owned()).filter(|title| !title.is_empty());
    let mut surface = Scan { first: scan.first + origin, ..scan }.surface(source, title, values, f64::is_nan)?;
    if characters == 0.0 {
        surface.notes.push(format!("the file's null is {dummy}"));
    }
    let unit = words("UNIT_LENGTH").first().and_then(|field| ZUnit::parse(field.text)).filter(|unit| !unit.is_time());
    surface.horizontal = unit.map(|unit| (unit, "#UNIT_LENGTH".to_owned()));
    Ok(vec![surface])
}

/// How values run, by the sense of the grid, from its lower left corner at zero.
fn scan(sense: f64, count: [usize; 2], step: [f64; 2], rotation_deg: f64) -> Option<Scan> {
    let east = DVec2::from_angle(rotation_deg.to_radians());
    let north = east.perp();
    // From the corner on: along the bottom and up the left side, each in one direction or the other.
    let (a, b) = match sense.abs() as i32 {
        1 => (east, north),
        2 => (-north, east),
        3 => (-east, -north),
        4 => (north, -east),
        _ => return None,
    };
    let (along, across) = if sense > 0.0 { (a, b) } else { (b, a) };
    let (along, across) = (along * step[0], across * step[1]);
    let far = [along * (count[0] as f64 - 1.0), across * (count[1] as f64 - 1.0)];
    // What runs west or south begins at the other end.
    let back = |way: DVec2| if way.dot(east) + way.dot(north) < 0.0 { -way } else { DVec2::ZERO };
    Some(Scan { first: back(far[0]) + back(far[1]), along, across, count })
}

/// The values of a packed grid; NaN for dummies.
fn unpacked(source: &SourceFile, packed: &[u8], characters: usize, expected: usize) -> Result<Vec<f64>, FormatError> {
    let mut words = packed.chunks_exact(characters);
    let number = |word: &[u8]| {
        let digit = |byte: &u8| byte.checked_sub(ZERO).filter(|digit| *digit < 90).map(f64::from);
        word.iter().map(digit).try_fold(0.0, |sum, digit| Some(sum * 90.0 + digit?))
    };
    let value = |word: &[u8]| if word[0] == b'!' { Some(f64::NAN) } else { number(word) };
    let wrong = |word: &[u8]| source.syntax(0, "a value of base 90", &String::from_utf8_lossy(word));
    let mut values = Vec::new();
    while let Some(word) = words.next() {
        let (times, word) = match word[0] {
            b'"' => {
                let (Some(times), Some(word)) = (words.next(), words.next()) else { return Err(wrong(word)) };
                (number(times).ok_or_else(|| wrong(times))? as usize, word)
            }
            _ => (1, word),
        };
        let value = value(word).ok_or_else(|| wrong(word))?;
        // Repeated values may be more than there are nodes, but not in memory.
        if times > expected - values.len() {
            return Err(source.length("grid values", expected, values.len().saturating_add(times)));
        }
        values.extend(std::iter::repeat_n(value, times));
    }
    Ok(values)
}
