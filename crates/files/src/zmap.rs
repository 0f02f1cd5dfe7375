//! ZMAP+ grids: unrotated, column by column from the west, each from the north down.
//!
//! `@ NAME, GRID, n` / `width, null, null text, decimals, start column` /
//! `NROW, NCOL, XMIN, XMAX, YMIN, YMAX` / `0, 0, 0` / `@`, then values. Lines beginning with `!` or `+` are
//! comments. Values are cut by blanks; where fields of full width touch, by width.
//!
//! Written with fields of 20 characters and 7 decimals, null −99999 (or, where depths come near it,
//! −9.99e+29).

use super::grid::{self, NodeOrder};
use super::raw::{RawSurface, ReadContext};
use super::text::{self, Line, SourceFile};
use super::write::{self, WriteFailure};
use super::{Codec, Format, FormatError, HorizonWriter, SurfaceKind, irap};
use crate::number;
use std::io::Write;
use survey::geometry::SurveyGeometry;
use survey::horizon::{Horizon, NodeGrid};

pub(super) const CODEC: Codec = Codec {
    read_horizon: Some(read),
    write_horizon: Some(HorizonWriter { is_unrotated: true, ..HorizonWriter::of(write_horizon) }),
    ..Codec::of(Format::Zmap, "zmap", "zmap", detect)
};

fn is_comment(line: &str) -> bool {
    line.starts_with(['!', '+'])
}

fn detect(source: &SourceFile) -> Option<String> {
    let text = source.text();
    let first = text::lines(&text).find(|l| !is_comment(l.text))?.text;
    (first.starts_with('@') && first.to_ascii_uppercase().contains("GRID"))
        .then(|| "its header is @ … GRID".to_string())
}

/// The depths of a sheet on an unrotated grid in the order of ZMAP+ and CPS-3, column by column.
pub(super) fn in_columns(depth: &[f32], nv: usize) -> impl Iterator<Item = Vec<f32>> {
    depth.chunks(nv).map(|column| column.iter().rev().copied().collect())
}

/// Writes a horizon whose grid is unrotated.
fn write_horizon(out: &mut dyn Write, horizon: &Horizon, _: &SurveyGeometry) -> Result<(), WriteFailure> {
    let sheet = irap::only_sheet(horizon)?;
    let NodeGrid { origin, u_step, v_step, count: [nu, nv] } = sheet.grid;
    let far = origin + u_step * (nu as f64 - 1.0) + v_step * (nv as f64 - 1.0);
    let near_null = sheet.depth.iter().any(|z| (z + 99_999.0).abs() < 1.0);
    let null = if near_null { "-9.99e+29" } else { "-99999.0" };
    let name: String =
        horizon.name.chars().map(|c| if c.is_control() || ",@!+".contains(c) { ' ' } else { c }).collect();
    writeln!(out, "! written by Petroglyph: X and Y in m, depths or times positive down")?;
    if let Some(share) = write::unpicked(horizon) {
        writeln!(out, "! {share}")?;
    }
    writeln!(out, "@ {}, GRID, 5", name.trim())?;
    writeln!(out, "20, {null}, , 7, 1")?;
    writeln!(out, "{nv}, {nu}, {:.6}, {:.6}, {:.6}, {:.6}", origin.x, far.x, origin.y, far.y)?;
    writeln!(out, "0.0, 0.0, 0.0\n@")?;
    for column in in_columns(&sheet.depth, nv) {
        for line in column.chunks(5) {
            for z in line {
                if z.is_finite() { write!(out, "{z:>20.7}")? } else { write!(out, "{null:>20}")? }
            }
            writeln!(out)?;
        }
    }
    Ok(())
}

fn numbers(source: &SourceFile, line: Line<'_>) -> Result<Vec<Option<f64>>, FormatError> {
    line.text
        .trim_end_matches(',')
        .split(',')
        .map(str::trim)
        .map(|f| match f {
            "" => Ok(None),
            f => number::plain(f).map(Some).ok_or_else(|| source.syntax(line.number, "a number", f)),
        })
        .collect()
}

fn read(source: &SourceFile, _: &ReadContext<'_>) -> Result<Vec<RawSurface>, FormatError> {
    let text = source.text();
    let mut rows = text::lines(&text).filter(|l| !is_comment(l.text));
    let mut header = |what| rows.next().ok_or_else(|| source.syntax(0, what, ""));
    let title = header("@ NAME, GRID, n")?;
    if !title.text.to_ascii_uppercase().contains("GRID") {
        let why = format!("its header is {}, which is no grid", text::excerpt(title.text));
        return Err(source.empty(SurfaceKind::Horizon, why));
    }
    let line = header("width, null, null text, decimals, start column")?;
    // The second null is text and may be anything.
    let mut parts = line.text.split(',').map(str::trim);
    let width = parts.next().and_then(|w| w.parse::<usize>().ok());
    let null = parts.next().filter(|w| !w.is_empty()).or_else(|| parts.next()).and_then(number::plain);
    let line = header("NROW, NCOL, XMIN, XMAX, YMIN, YMAX")?;
    let &[Some(nrow), Some(ncol), Some(x0), Some(x1), Some(y0), Some(y1), ..] = numbers(source, line)?.as_slice()
    else {
        return Err(source.syntax(line.number, "NROW, NCOL, XMIN, XMAX, YMIN, YMAX", line.text));
    };
    let grid = grid::unrotated(source, [ncol, nrow], [x0, x1], [y0, y1])?;
    let data: Vec<Line<'_>> = rows.skip_while(|l| l.text != "@").skip(1).collect();
    let expected = grid.count[0] * grid.count[1];
    let values = match values(source, &data, None) {
        Ok(free) if free.len() == expected => free,
        free => match width.map(|w| values(source, &data, Some(w))) {
            Some(Ok(fixed)) if fixed.len() == expected => fixed,
            _ => return Err(source.length("grid values", expected, free?.len())),
        },
    };
    let name = title.text.trim_start_matches('@').split(',').next().unwrap_or("").trim();
    let name = name.trim_end_matches("HEADER").trim();
    let generic = name.is_empty() || name.eq_ignore_ascii_case("GRIDFILE");
    let name = (!generic).then(|| name.into());
    let is_null = |v| number::is_null(v, null);
    let mut surface = grid::surface(source, name, grid, (values, NodeOrder::ColumnsFromNorth), is_null)?;
    surface.notes.extend(null.map(|n| format!("the file's null is {n}")));
    Ok(vec![surface])
}

/// The values of all lines, cut by blanks or into fields of `width`.
fn values(source: &SourceFile, data: &[Line<'_>], width: Option<usize>) -> Result<Vec<f64>, FormatError> {
    let mut found = Vec::new();
    for line in data {
        let mut add = |token: &str| {
            found.push(source.grid_value(line.number, token)?);
            Ok::<(), FormatError>(())
        };
        match width {
            None => line.text.split([' ', '\t', ',']).filter(|t| !t.is_empty()).try_for_each(&mut add)?,
            // Leading blanks of the first field were trimmed with the line: fields are counted from its end.
            Some(width) if width > 0 && line.text.is_ascii() => {
                let first = match line.text.len() % width {
                    0 => width,
                    rest => rest,
                };
                let (head, tail) = line.text.split_at(first.min(line.text.len()));
                add(head)?;
                tail.as_bytes().chunks(width).try_for_each(|c| add(&String::from_utf8_lossy(c)))?;
            }
            Some(_) => return Err(source.syntax(line.number, "fields of a width", line.text)),
        }
    }
    Ok(found)
}
