//! ZMAP+ points and polygons.
//!
//! `@FREE POINT , DATA, 80, 1`, a line per column with its name first and its first and last character after
//! four numbers (`X (EASTING) , 1, 1, 1, 1, 20,, 1.0E+30,,, 4, 0`), `@`, then rows. A new `SEG I.D.` begins a
//! new polygon. Lines beginning with `!` or `+` are comments.

use super::raw::{RawPoint, RawShape, RawSurface, ReadContext};
use super::text::{self, Line, SourceFile};
use super::{Codec, Format, FormatError};
use crate::number::{self, NumberStyle};
use glam::DVec2;

pub(super) const CODEC: Codec = Codec {
    read_horizon: Some(read),
    read_fault: Some(read),
    ..Codec::of(Format::ZmapPoints, "zmappoints", "zmap", detect)
};

fn is_comment(line: &str) -> bool {
    line.starts_with(['!', '+'])
}

fn detect(source: &SourceFile) -> Option<String> {
    let text = source.text();
    let first = text::lines(&text).find(|l| !is_comment(l.text))?.text.to_ascii_uppercase();
    (first.starts_with('@') && first.contains("POINT") && first.contains("DATA"))
        .then(|| "its header is @ … POINT, DATA".to_string())
}

/// The position of a column in a row: characters from..to, and its null.
struct ColumnSpan {
    from: usize,
    to: usize,
    null: Option<f64>,
}

fn read(source: &SourceFile, context: &ReadContext<'_>) -> Result<Vec<RawSurface>, FormatError> {
    let text = source.text();
    // Columns are counted from the start of the line, so lines are taken untrimmed.
    let mut lines = text.split('\n').enumerate().map(|(n, text)| Line { number: n + 1, text: text.trim_end() });
    let mut columns: Vec<(String, ColumnSpan)> = Vec::new();
    let mut lines_of_header = lines.by_ref().filter(|l| !l.text.trim().is_empty() && !is_comment(l.text.trim_start()));
    lines_of_header.next();
    for line in lines_of_header {
        if line.text.trim() == "@" {
            break;
        }
        let fields: Vec<&str> = line.text.split(',').map(str::trim).collect();
        let character =
            |n: usize| fields.get(n).and_then(|f| f.parse::<usize>().ok()).filter(|c| (1..=10_000).contains(c));
        let (Some(from), Some(to)) = (character(4), character(5)) else {
            return Err(source.syntax(line.number, "a column with its first and last character", line.text));
        };
        let null = fields.get(7).and_then(|f| number::plain(f));
        columns.push((fields[0].to_ascii_uppercase(), ColumnSpan { from: from - 1, to, null }));
    }
    let column = |word: &str| columns.iter().find(|(name, _)| name.starts_with(word)).map(|(_, place)| place);
    let (Some(x), Some(y), Some(z)) = (column("X"), column("Y"), column("Z")) else {
        return Err(source.bad_grid("its header names no columns X, Y and Z"));
    };
    let segment = column("SEG");
    let mut points = Vec::new();
    for line in lines.filter(|l| !l.text.trim().is_empty() && !is_comment(l.text.trim_start())) {
        let text_of = |place: &ColumnSpan| line.text.get(place.from..place.to.min(line.text.len()));
        let number = |place: &ColumnSpan| text_of(place).and_then(number::plain);
        let wrong = |what: &str| source.syntax(line.number, format!("a number for {what}"), line.text);
        let coordinate = |place: &ColumnSpan, what: &str| {
            number(place).filter(|v| v.is_finite() && v.abs() < 1e12).ok_or_else(|| wrong(what))
        };
        let value =
            text_of(z).and_then(|text| number::or_missing(text, NumberStyle::Point)).ok_or_else(|| wrong("Z"))?;
        let is_null = number::is_null(value, z.null);
        points.push(RawPoint {
            xy: Some(DVec2::new(coordinate(x, "X")?, coordinate(y, "Y")?)),
            z: if is_null { f64::NAN } else { value },
            stick: segment.and_then(number).filter(|v| v.is_finite()),
            ..RawPoint::default()
        });
    }
    if points.is_empty() {
        return Err(source.empty(context.kind, "there are no rows after the header"));
    }
    Ok(vec![RawSurface::new(None, RawShape::Points(points))])
}
