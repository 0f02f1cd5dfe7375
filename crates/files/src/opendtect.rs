//! OpendTect ASCII: horizons and fault sticks.
//!
//! The columns are listed on one line (`# "X" "Y" "Inline" "Crossline" "Z" …`), one a line (`# 1: X`), or
//! nowhere; a line of dashes ends the header. Rows are cut by tabs; a bulk export has the quoted name of the
//! horizon or fault before the columns, so one file may hold several. Magnitudes from 1e29 on are undefined
//! (the default is 1e30). Z is in the unit the exporter chose, which the file does not state. Fault sticks
//! have the stick's and the node's number after Z.

use super::columns::{self, ColumnLayout};
use super::mesh_sticks;
use super::raw::{RawSurface, ReadContext};
use super::table::{self, LineCut};
use super::text::{self, SourceFile};
use super::write::{self, TableNode, WriteFailure};
use super::{Codec, Format, FormatError, HorizonWriter};
use crate::number;
use std::io::Write;
use survey::fault::Fault;
use survey::geometry::SurveyGeometry;
use survey::horizon::Horizon;

pub(super) const CODEC: Codec = Codec {
    read_horizon: Some(read),
    read_fault: Some(read),
    write_horizon: Some(HorizonWriter::of(write_horizon)),
    write_fault: Some(write_fault),
    ..Codec::of(Format::OpendTect, "opendtect", "dat", detect)
};

fn detect(source: &SourceFile) -> Option<String> {
    let text = source.text();
    let first = text::lines(&text).next()?.text;
    if let Some(comment) = first.strip_prefix('#') {
        let comment = comment.trim();
        if comment.starts_with("1:") {
            return Some("its columns are listed one a line".into());
        }
        let fields = text::fields(comment, None);
        return (fields.len() >= 3 && fields.iter().all(|f| f.quoted))
            .then(|| "its header line lists quoted columns".into());
    }
    let cut = LineCut::of_line(first);
    let fields = cut.fields(first);
    let is_row = fields.len() >= 4 && fields[0].quoted && fields[1..].iter().all(|f| number::plain(f.text).is_some());
    (cut.delimiter == Some('\t') && is_row).then(|| "a quoted name stands before numbers cut by tabs".into())
}

/// The columns a header lists, in either style.
fn header_of(text: &str, context: &ReadContext<'_>) -> Option<ColumnLayout> {
    let comments: Vec<&str> = text::lines(text).map_while(|l| l.text.strip_prefix('#')).map(str::trim).collect();
    let listed: Vec<&str> = comments
        .iter()
        .filter_map(|c| c.split_once(':'))
        .filter(|(n, _)| n.trim().parse::<u32>().is_ok())
        .map(|(_, name)| name.trim())
        .collect();
    let layout = if listed.is_empty() {
        let line = comments.iter().find(|c| c.starts_with('"'))?;
        let names = text::fields(line, None);
        columns::from_header(&names.iter().map(|f| f.text).collect::<Vec<_>>(), context.domain())
    } else {
        columns::from_header(&listed, context.domain())
    };
    Some(layout)
}

fn read(source: &SourceFile, context: &ReadContext<'_>) -> Result<Vec<RawSurface>, FormatError> {
    let text = source.text();
    let rows: Vec<_> = text::lines(&text).filter(|l| !table::is_comment(l.text)).collect();
    if rows.is_empty() {
        return Err(source.empty(context.kind, "there are no rows"));
    }
    let cut = LineCut::of(&rows);
    let layout = table::settle_columns(source, context, header_of(&text, context), &rows, cut)?;
    table::surfaces(source, &rows, cut, layout, context)
}

fn write_horizon(out: &mut dyn Write, horizon: &Horizon, geometry: &SurveyGeometry) -> Result<(), WriteFailure> {
    writeln!(out, "# \"X\"\t\"Y\"\t\"Inline\"\t\"Crossline\"\t\"Z\"")?;
    if let Some(share) = write::unpicked(horizon) {
        writeln!(out, "# {share}")?;
    }
    writeln!(out, "# - - - - - - - - - -")?;
    for TableNode { lines, xy, z, .. } in write::nodes(horizon, geometry) {
        let [il, xl] = [lines.x, lines.y].map(write::line_number);
        writeln!(out, "{:.2}\t{:.2}\t{il}\t{xl}\t{z}", xy.x, xy.y)?;
    }
    Ok(())
}

fn write_fault(out: &mut dyn Write, fault: &Fault, geometry: &SurveyGeometry) -> Result<(), WriteFailure> {
    let sticks = mesh_sticks::cut(&fault.mesh, geometry.metres_per_vertical_unit());
    if sticks.len() < 2 {
        return Err(WriteFailure::NotRepresentable(
            "fewer than two sticks can be cut from it".into(),
            "write tsurf, which holds the triangles",
        ));
    }
    let name = fault.name.replace(['"', '\t', '\n', '\r'], " ");
    for (stick, nodes) in sticks.iter().enumerate() {
        for (node, p) in nodes.iter().enumerate() {
            writeln!(out, "\"{name}\"\t{:.3}\t{:.3}\t{:.4}\t{stick}\t{node}", p.x, p.y, p.z)?;
        }
    }
    Ok(())
}
