//! CPS-3 ASCII grids: unrotated.
//!
//! `FSASCI 0 1 "COMPUTED" 0 null`, `FSATTR …`, `FSLIMI xmin xmax ymin ymax zmin zmax`, `FSNROW nrow ncol`, `FSXINC dx dy`,
//! `->name`, then values; `!` lines are comments. Most programs write columns from the west, each from the north down; some write
//! rows from the south. The file does not say which: the usual order is taken unless the other is at least
//! three times smoother, and the report says so.

use super::raw::{RawShape, RawSurface, ReadContext, VerticalFacts};
use super::text::{self, SourceFile};
use super::zmap::{from_columns, unrotated};
use super::{Codec, Format, FormatError};

pub(super) const CODEC: Codec = Codec {
    format: Format::Cps3,
    name: "cps3",
    extension: "cps3",
    detect,
    read_horizon: Some(read),
    read_fault: None,
    write_horizon: None,
    write_fault: None,
};

fn detect(source: &SourceFile) -> Option<String> {
    let text = source.text();
    let first = text::lines(&text).find(|l| !l.text.starts_with('!'))?.text;
    first.starts_with("FSASCI").then(|| "it begins with FSASCI".to_string())
}

fn read(source: &SourceFile, _: &ReadContext<'_>) -> Result<Vec<RawSurface>, FormatError> {
    let text = source.text();
    let (mut null, mut limits, mut counts, mut name) = (None, None, None, None);
    let mut values = Vec::new();
    for line in text::lines(&text).filter(|l| !l.text.starts_with('!')) {
        let fields = text::fields(line.text, None);
        let number = |n: usize| fields.get(n).and_then(|f| text::number(f.text));
        match fields.first().map_or("", |f| f.text) {
            "FSASCI" => null = number(5),
            "FSLIMI" => {
                let found = (number(1), number(2), number(3), number(4));
                let (Some(x0), Some(x1), Some(y0), Some(y1)) = found else {
                    return Err(source.syntax(line.number, "FSLIMI xmin xmax ymin ymax", line.text));
                };
                limits = Some([[x0, x1], [y0, y1]]);
            }
            "FSNROW" => {
                let (Some(rows), Some(columns)) = (number(1), number(2)) else {
                    return Err(source.syntax(line.number, "FSNROW rows columns", line.text));
                };
                counts = Some([columns, rows]);
            }
            word if word.starts_with("FS") => {}
            word if word.starts_with("->") => name = Some(line.text[2..].trim().to_string()),
            _ => {
                for field in &fields {
                    let value = text::number(field.text);
                    values.push(value.ok_or_else(|| source.syntax(line.number, "a grid value", field.text))?);
                }
            }
        }
    }
    let (Some([x, y]), Some(counts)) = (limits, counts) else {
        return Err(source.bad_grid("there is no FSLIMI or no FSNROW line"));
    };
    let grid = unrotated(source, counts, x, y)?;
    let expected = grid.count[0] * grid.count[1];
    if values.len() != expected {
        return Err(source.length("grid values", expected, values.len()));
    }
    let is_null =
        |v: f64| v.abs() >= super::table::UNDEFINED || null.is_some_and(|n| (v - n).abs() <= 1e-6 * n.abs().max(1.0));
    let file: Vec<f64> = values.into_iter().map(|v| if is_null(v) { f64::NAN } else { v }).collect();
    let columns = from_columns(&file, grid.count);
    let rows = super::irap::transposed(&file, grid.count);
    let (usual, other) = (roughness(&columns, grid.count[1]), roughness(&rows, grid.count[1]));
    let (z, order, so, otherwise) = if 3.0 * other < usual {
        (rows, "rows from the south", other, usual)
    } else {
        (columns, "columns from the north", usual, other)
    };
    let notes = vec![format!(
        "values taken as {order}: the mean bend from node to node is {so:.3}, read the other way {otherwise:.3}"
    )];
    let shape = RawShape::Grid { grid, z };
    Ok(vec![RawSurface { name, shape, vertical: VerticalFacts::default(), notes }])
}

/// Mean second difference along rows and columns; infinite when no three nodes in line have values.
///
/// A plane read in the wrong order is a sawtooth: its first differences are hardly larger, its second ones are.
fn roughness(z: &[f64], nv: usize) -> f64 {
    let (mut sum, mut count) = (0.0, 0u64);
    for n in 0..z.len() {
        let in_row = n % nv >= 1 && n % nv + 1 < nv;
        let in_column = n >= nv && n + nv < z.len();
        for (inside, step) in [(in_row, 1), (in_column, nv)] {
            if inside {
                let bend = z[n - step] - 2.0 * z[n] + z[n + step];
                if bend.is_finite() {
                    sum += bend.abs();
                    count += 1;
                }
            }
        }
    }
    if count == 0 { f64::INFINITY } else { sum / count as f64 }
}
