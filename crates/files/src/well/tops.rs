//! Tops: the name of a surface and the depth at which the well penetrates it, as MD, TVD, TVDSS or Z.
//!
//! CSV or blanks with a header, Petrel well tops (`BEGIN HEADER` … `END HEADER`), or two columns without a header,
//! depth and name (taken as measured depth), intervals of rocks (from, to), or the tops of LAS 3.0. Vertical depths are
//! placed on the path where it first crosses that depth.

use super::columns::WellColumn;
use super::error::WellFileError;
use super::las_tops;
use super::options::WellOptions;
use super::report::WellReport;
use super::table::Table;
use crate::number;
use std::path::Path;
use survey::well::{Top, WellPath};

/// A top as in the file.
#[derive(Debug, Clone, PartialEq)]
pub struct TopRow {
    /// Name of the surface.
    pub name: String,
    /// Measured depth, m, where the file has it or the path gives it.
    pub md_m: Option<f64>,
    /// Line of the file.
    pub line: usize,
}

/// Reads tops and puts them on the path. Also says what was read and left out.
///
/// # Errors
/// [`WellFileError`] with the line or the columns that are missing.
pub fn parse_tops(
    file: &Path,
    text: &str,
    path: &WellPath,
    options: &WellOptions,
    report: &mut WellReport,
) -> Result<Vec<TopRow>, WellFileError> {
    let of_las = las_tops::table_of(text);
    if of_las.is_none() && las_tops::is_las(text) {
        return Err(WellFileError::Empty {
            file: file.to_owned(),
            what: "tops (sections ~Tops_Definition and ~Tops_Data)",
        });
    }
    let mut table = Table::parse(file, of_las.as_deref().unwrap_or(text));
    if table.rows.is_empty() {
        return Err(WellFileError::Empty { file: file.to_owned(), what: "tops" });
    }
    if table.columns.is_empty() {
        let number_first = table.rows[0].fields.first().is_some_and(|f| number::plain(f.text).is_some());
        let columns = [WellColumn::Md, WellColumn::Surface];
        table.assume(&if number_first { columns } else { [columns[1], columns[0]] });
        report.note("tops: no header; columns taken as measured depth and name");
    }
    let names: Vec<&str> = options.name.as_deref().into_iter().collect();
    table.keep_well(&options.well_in_file, &names)?;
    let depth = [WellColumn::Md, WellColumn::From, WellColumn::Tvdss, WellColumn::Z, WellColumn::Tvd]
        .into_iter()
        .filter_map(|c| Some((c, table.position(c)?)))
        .collect::<Vec<_>>();
    let (Some(name_at), false) = (table.position(WellColumn::Surface), depth.is_empty()) else {
        return Err(WellFileError::Columns {
            file: file.to_owned(),
            why: "a name and a depth are needed".into(),
            example: "surface,md_m",
        });
    };
    let to_m: Vec<f64> =
        depth.iter().map(|(_, at)| table.length_to_m(*at, options.md_unit, report)).collect::<Result<_, _>>()?;
    let is_interval = table.position(WellColumn::From).is_some() && table.position(WellColumn::Md).is_none();
    let mut tops: Vec<TopRow> = Vec::with_capacity(table.rows.len());
    let (mut twice, mut negative, mut missing) = (Vec::new(), 0usize, 0usize);
    for row in &table.rows {
        let name = table.text(row, name_at)?.to_string();
        // Of intervals, from and to, the top of each run of one rock is a top.
        if is_interval && tops.last().is_some_and(|top: &TopRow| top.name == name) {
            continue;
        }
        // Petrel leaves MD empty where only a place was picked: the first depth that is given counts.
        let known = depth.iter().zip(&to_m).find_map(|((c, at), f)| Some((*c, table.optional(row, *at)? * f)));
        let md_m = match known {
            None => {
                missing += 1;
                continue;
            }
            Some((WellColumn::Md | WellColumn::From, md)) => Some(md),
            Some((column, depth)) => {
                let tvdss = match column {
                    WellColumn::Tvd => depth - path.datum_m(),
                    _ if depth < 0.0 && path.mds_at_tvdss(depth).is_empty() => {
                        negative += 1;
                        -depth
                    }
                    _ => depth,
                };
                let crossings = path.mds_at_tvdss(tvdss);
                if crossings.len() > 1 {
                    twice.push(name.clone());
                }
                crossings.first().copied()
            }
        };
        tops.push(TopRow { name, md_m, line: row.line.number });
    }
    if missing > 0 {
        report.warn_once(format!("tops: {missing} have no depth and were left out"));
    }
    if negative > 0 {
        report.note(format!("tops: {negative} negative depths were turned positive down (elevations)"));
    }
    if !twice.is_empty() {
        report.note(format!(
            "tops: the hole crosses the depth of {} more than once; the first is taken",
            twice.join(", ")
        ));
    }
    Ok(tops)
}

/// The tops on the path, in order; notes name those that are not on it.
pub(super) fn on_path(rows: Vec<TopRow>, path: &WellPath, report: &mut WellReport) -> Vec<Top> {
    let [first, last] = path.md_range_m();
    let mut tops = Vec::with_capacity(rows.len());
    let mut off = Vec::new();
    for row in rows {
        match row.md_m.filter(|md| (first..=last).contains(md)) {
            Some(md_m) => tops.push(Top { name: row.name, md_m }),
            None => off.push(match row.md_m {
                Some(md) => format!("{} (MD {md:.1} m)", row.name),
                None => format!("{} (line {})", row.name, row.line),
            }),
        }
    }
    if !off.is_empty() {
        report.warn_once(format!(
            "{} tops lie beyond the path, which runs from MD {first:.1} to {last:.1} m, and were left out: {}",
            off.len(),
            off.join(", ")
        ));
    }
    tops.sort_by(|a, b| a.md_m.total_cmp(&b.md_m));
    tops
}
