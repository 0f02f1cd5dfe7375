//! CPS-3 ASCII grids: unrotated.
//!
//! `FSASCI 0 1 "COMPUTED" 0 null`, `FSATTR …`, `FSLIMI xmin xmax ymin ymax zmin zmax`, `FSNROW nrow ncol`,
//! `FSXINC dx dy`, `->name`, then values; `!` lines are comments.
//!
//! Most programs write columns from the west, each from the north down; some write rows from the south. The file does
//! not say which. The option `--value-order` states it; otherwise the smoother order is taken if it is at least twice
//! as smooth, and if not, the usual order with a warning. The report gives the evidence in either case.
//!
//! Written in columns from the north, five values per line.

use super::grid::{self, NodeOrder};
use super::options::ValueOrder;
use super::raw::{RawShape, RawSurface, ReadContext};
use super::text::{self, SourceFile};
use super::write::WriteFailure;
use super::zmap::in_columns;
use super::{Codec, Format, FormatError, HorizonWriter, irap};
use crate::number;
use std::io::Write;
use survey::geometry::SurveyGeometry;
use survey::horizon::{Horizon, NodeGrid};
use survey::remedy::{Note, Setting};

pub(super) const CODEC: Codec = Codec {
    read_horizon: Some(read),
    write_horizon: Some(HorizonWriter { is_unrotated: true, ..HorizonWriter::of(write_horizon) }),
    ..Codec::of(Format::Cps3, "cps3", "cps3", detect)
};

fn detect(source: &SourceFile) -> Option<String> {
    let text = source.text();
    let first = text::lines(&text).find(|l| !l.text.starts_with('!'))?.text;
    first.starts_with("FSASCI").then(|| "it begins with FSASCI".to_string())
}

fn read(source: &SourceFile, context: &ReadContext<'_>) -> Result<Vec<RawSurface>, FormatError> {
    let text = source.text();
    let (mut null, mut limits, mut counts, mut name) = (None, None, None, None);
    let mut values = Vec::new();
    for line in text::lines(&text).filter(|l| !l.text.starts_with('!')) {
        let fields = text::fields(line.text, None);
        let number = |n: usize| fields.get(n).and_then(|f| number::plain(f.text));
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
            _ => values.extend(source.grid_values(std::iter::once(line))?),
        }
    }
    let (Some([x, y]), Some(counts)) = (limits, counts) else {
        return Err(source.bad_grid("there is no FSLIMI or no FSNROW line"));
    };
    let grid = grid::unrotated(source, counts, x, y)?;
    source.check_values(grid.count, values.len())?;
    let file: Vec<f64> = values.into_iter().map(|v| if number::is_null(v, null) { f64::NAN } else { v }).collect();
    let columns = NodeOrder::ColumnsFromNorth.sorted(&file, grid.count);
    let rows = NodeOrder::Rows.sorted(&file, grid.count);
    let (usual, other) = (roughness(&columns, grid.count[1]), roughness(&rows, grid.count[1]));
    let evidence = format!(
        "the mean bend from node to node is {usual:.4} in columns from the north, {other:.4} in rows from the south"
    );
    let square =
        if grid.count[0] == grid.count[1] { " (the grid is square: its mirror image is as smooth)" } else { "" };
    let clear = usual.max(other) >= CLEAR * usual.min(other);
    let told = context.options.value_order;
    let order = told.unwrap_or(if clear && other < usual { ValueOrder::Rows } else { ValueOrder::Columns });
    let (z, word) = match order {
        ValueOrder::Columns => (columns, "columns from the north"),
        ValueOrder::Rows => (rows, "rows from the south"),
    };
    let (mut notes, mut warnings) = (Vec::new(), Vec::new());
    match told {
        Some(_) => notes.push(format!("values taken as {word}, as told: {evidence}")),
        None if clear => notes.push(format!("values taken as {word}, the smoother order: {evidence}")),
        None => warnings.push(Note::unless(
            format!(
                "the file does not say the order of its values and both are about as smooth: \
                 {evidence}{square}. Taken as {word}; look at the map"
            ),
            Setting::ValueOrder.stated_as("rows or columns"),
        )),
    }
    let shape = RawShape::Grid { grid, z };
    Ok(vec![RawSurface { notes, warnings, ..RawSurface::new(name, shape) }])
}

/// An order is accepted if it is this many times smoother than the other.
const CLEAR: f64 = 2.0;

/// Writes a horizon whose grid is unrotated.
fn write_horizon(out: &mut dyn Write, horizon: &Horizon, _: &SurveyGeometry) -> Result<(), WriteFailure> {
    let sheet = irap::only_sheet(horizon)?;
    let NodeGrid { origin, u_step, v_step, count: [nu, nv] } = sheet.grid;
    let far = origin + u_step * (nu as f64 - 1.0) + v_step * (nv as f64 - 1.0);
    let known = || sheet.depth.iter().copied().filter(|z| z.is_finite());
    let (low, high) = (known().fold(f32::INFINITY, f32::min), known().fold(f32::NEG_INFINITY, f32::max));
    let (low, high) = if low <= high { (low, high) } else { (0.0, 0.0) };
    writeln!(out, "FSASCI 0 1 \"COMPUTED\" 0 1.0000000E+30 0")?;
    writeln!(out, "FSATTR 0 0")?;
    writeln!(out, "FSLIMI {:.6} {:.6} {:.6} {:.6} {low:.6} {high:.6}", origin.x, far.x, origin.y, far.y)?;
    writeln!(out, "FSNROW {nv} {nu}")?;
    writeln!(out, "FSXINC {:.8} {:.8}", u_step.x, v_step.y)?;
    writeln!(out, "->{}", horizon.name.replace(['\n', '\r'], " "))?;
    for column in in_columns(&sheet.depth, nv) {
        for line in column.chunks(5) {
            let words: Vec<String> =
                line.iter().map(|z| if z.is_finite() { format!("{z:.7}") } else { "1.0000000E+30".into() }).collect();
            writeln!(out, "{}", words.join(" "))?;
        }
    }
    Ok(())
}

/// Mean second difference along rows and columns; infinite if no three consecutive nodes have values.
///
/// A plane that is read in the wrong order becomes a sawtooth, whose first differences are hardly larger, but whose
/// second differences are.
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
