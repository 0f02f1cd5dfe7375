//! CSV and XYZ: a table with or without a header line.
//!
//! The header names the columns (`inline`, `crossline`, `x`, `y`, `z`, `twt_ms`, `depth (ft)` …, in any order and
//! case); fields are separated by `;`, tab, comma or blanks. Without a header, the reading is taken under which the
//! points lie in the survey; if two readings fit, the user must state the columns. Lines beginning with `#`, `!`, `%`,
//! `@` or `//` are comments; the last one before the data may be the header.
//!
//! Written: `inline,crossline,x,y,twt_ms,sheet,quality` (or `depth_m`), a row per node with a depth.

use super::column::{Column, of_name};
use super::columns::{self, ColumnLayout};
use super::raw::{RawSurface, ReadContext};
use super::table::{self, LineCut};
use super::text::{self, Line, SourceFile};
use super::write::{self, TableNode};
use super::{Codec, Format, FormatError, HorizonWriter};
use std::io::Write;
use survey::geometry::{SurveyGeometry, VerticalUnit};
use survey::horizon::Horizon;

pub(super) const CODEC: Codec = Codec {
    read_horizon: Some(read),
    read_fault: Some(read),
    write_horizon: Some(HorizonWriter {
        holds_any_shape: true,
        tells_quality: true,
        ..HorizonWriter::of(write_horizon)
    }),
    ..Codec::of(Format::Csv, "csv", "csv", detect)
};

fn detect(source: &SourceFile) -> Option<String> {
    let text = source.text();
    let rows: Vec<_> = text::lines(&text).filter(|l| !table::is_comment(l.text)).take(6).collect();
    let first = rows.first()?;
    let cut = LineCut::of(&rows);
    let numbers = |line: &Line<'_>| cut.fields(line.text).iter().filter(|f| cut.number(f.text).is_some()).count();
    if rows.iter().skip(1).chain((rows.len() == 1).then_some(first)).all(|line| numbers(line) < 3) {
        return None;
    }
    Some(if is_header(first.text, cut) { "a table with a header line" } else { "a table of numbers" }.into())
}

/// Whether a line is a header: it has at least two fields that are not numbers. (A row may have a name and words for
/// "nothing".)
fn is_header(line: &str, cut: LineCut) -> bool {
    let fields = cut.fields(line);
    let words = fields.iter().filter(|f| cut.number(f.text).is_none() && f.text.chars().any(char::is_alphabetic));
    let known = words.clone().filter(|f| of_name(f.text).column != Column::Other).count();
    known >= 2 || words.count() > fields.len() / 2
}

/// The header line, or the last comment if its words name columns.
fn header_of(all: &[Line<'_>], rows: &[Line<'_>], cut: LineCut, context: &ReadContext<'_>) -> Option<ColumnLayout> {
    let first = rows.first()?;
    if is_header(first.text, cut) {
        let names = cut.fields(first.text);
        return Some(columns::from_header(&names.iter().map(|f| f.text).collect::<Vec<_>>(), context.domain()));
    }
    let comment = all.iter().take_while(|l| l.number < first.number).last()?;
    let words = comment.text.trim_start_matches(['#', '!', '%', '@', '/', ' ']);
    let names = LineCut::of_line(words).fields(words);
    let layout = columns::from_header(&names.iter().map(|f| f.text).collect::<Vec<_>>(), context.domain());
    (layout.is_complete() && names.len() <= cut.fields(first.text).len()).then_some(layout)
}

fn read(source: &SourceFile, context: &ReadContext<'_>) -> Result<Vec<RawSurface>, FormatError> {
    let text = source.text();
    let all: Vec<_> = text::lines(&text).collect();
    let mut rows: Vec<_> = all.iter().copied().filter(|l| !table::is_comment(l.text)).collect();
    let Some(first) = rows.first() else {
        return Err(source.empty(context.kind, "there are no rows"));
    };
    let cut = LineCut::of(&rows);
    let header = header_of(&all, &rows, cut, context);
    if is_header(first.text, cut) {
        rows.remove(0);
    }
    if rows.is_empty() {
        return Err(source.empty(context.kind, "there is a header but no rows"));
    }
    let layout = table::settle_columns(source, context, header, &rows, cut)?;
    table::surfaces(source, &rows, cut, layout, context)
}

fn write_horizon(out: &mut dyn Write, horizon: &Horizon, geometry: &SurveyGeometry) -> Result<(), write::WriteFailure> {
    let z = match geometry.vertical.unit {
        VerticalUnit::Milliseconds => "twt_ms",
        VerticalUnit::Metres => "depth_m",
    };
    writeln!(out, "inline,crossline,x,y,{z},sheet,quality")?;
    for TableNode { lines, xy, z, sheet, quality } in write::nodes(horizon, geometry) {
        let quality = columns::quality_word(quality);
        let [il, xl] = [lines.x, lines.y].map(write::line_number);
        writeln!(out, "{il},{xl},{:.4},{:.4},{z},{sheet},{quality}", xy.x, xy.y)?;
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn headers_and_rows_are_told_apart() {
        for (line, header) in [
            ("X;Y;Z;Strati;Cutoff", true),
            ("inline,crossline,x,y,twt_ms", true),
            ("1 2 3", false),
            ("\"green event\"\t1\t2\t3", false),
            ("1,2,nan", false),
        ] {
            assert_eq!(is_header(line, LineCut::of_line(line)), header, "{line}");
        }
    }
}
