//! Files of time–depth tables: CSV or blanks, with named columns or with two.
//!
//! If a table does not state whether it is in seconds or milliseconds, physics decides: only one of the two gives
//! interval velocities between 300 and 10 000 m/s.

use super::columns::WellColumn;
use super::error::WellFileError;
use super::options::WellOptions;
use super::report::WellReport;
use super::table::Table;
use std::path::Path;
use survey::well::{Checkshot, WellPath};

/// Reads a checkshot table: a depth (TVDSS, TVD, Z or MD along `path`) and a time (TWT, or OWT one-way) a
/// row. Without a header the columns are TVDSS and TWT.
///
/// # Errors
/// [`WellFileError`] with the line, or with the columns that are missing.
pub fn parse_checkshot(
    file: &Path,
    text: &str,
    path: &WellPath,
    options: &WellOptions,
    report: &mut WellReport,
) -> Result<Checkshot, WellFileError> {
    let mut table = Table::parse(file, text);
    if table.rows.is_empty() {
        return Err(WellFileError::Empty { file: file.to_owned(), what: "checkshots" });
    }
    if table.columns.is_empty() {
        table.assume(&[WellColumn::Tvdss, WellColumn::Twt]);
        report.note("checkshots: no header; columns taken as TVDSS, TWT");
    }
    table.keep_well(&options.well_in_file, &[])?;
    let time = [WellColumn::Twt, WellColumn::Owt].into_iter().find_map(|c| Some((c, table.position(c)?)));
    let depth = [WellColumn::Tvdss, WellColumn::Tvd, WellColumn::Z, WellColumn::Md]
        .into_iter()
        .find_map(|c| Some((c, table.position(c)?)));
    let (Some((time_column, time_at)), Some((depth_column, depth_at))) = (time, depth) else {
        return Err(WellFileError::Columns {
            file: file.to_owned(),
            why: "a depth and a time are needed".into(),
            example: "tvdss_m,twt_ms",
        });
    };
    let to_m = table.length_to_m(depth_at, options.md_unit, report)?;
    let ways = if time_column == WellColumn::Owt { 2.0 } else { 1.0 };
    let mut rows = Vec::with_capacity(table.rows.len());
    for row in &table.rows {
        let pair = [table.value(row, depth_at)? * to_m, table.value(row, time_at)? * ways];
        if pair.iter().all(|value| value.is_finite()) {
            rows.push(pair);
        }
    }
    if rows.len() < table.rows.len() {
        let missing = table.rows.len() - rows.len();
        report.warn_once(format!("checkshots: {missing} of {} rows lack a number and were left out", table.rows.len()));
    }
    // The sign of depths and times: both grow downwards in some files, both fall in others (elevations,
    // negative times).
    for (axis, what) in [(0, "depths"), (1, "times")] {
        if rows.first().zip(rows.last()).is_some_and(|(a, b)| b[axis] < a[axis] && b[axis] < 0.0) {
            rows.iter_mut().for_each(|r| r[axis] = -r[axis]);
            report.note(format!("checkshots: the {what} are negative and were turned positive down"));
        }
    }
    match depth_column {
        WellColumn::Tvd => rows.iter_mut().for_each(|r| r[0] -= path.datum_m()),
        WellColumn::Md => {
            for row in &mut rows {
                let place = path.position_at_md(row[0]);
                row[0] = place.map_or(f64::NAN, |p| p.z);
            }
            let before = rows.len();
            rows.retain(|r| r[0].is_finite());
            if rows.len() < before {
                report.note(format!("checkshots: {} of {before} lie beyond the well's path", before - rows.len()));
            }
        }
        _ => {}
    }
    rows.dedup();
    let unit = match table.time_unit(time_at) {
        Some(unit) => unit.in_survey(),
        None => {
            let (Some(a), Some(b)) = (rows.first(), rows.last()) else {
                return Err(WellFileError::Empty { file: file.to_owned(), what: "checkshots" });
            };
            let slope = 2.0 * (b[0] - a[0]) / (b[1] - a[1]);
            let fits = |v: f64| (300.0..=10_000.0).contains(&v);
            let (unit, word) = match (fits(1000.0 * slope), fits(slope)) {
                (true, false) => (1.0, "ms"),
                (false, true) => (1000.0, "s"),
                _ => {
                    return Err(WellFileError::UnclearUnit {
                        file: file.to_owned(),
                        what: format!("the times (mean slope 2·Δz/Δt = {slope:.3})"),
                        candidates: "ms or s",
                        header: "tvdss_m,twt_ms",
                    });
                }
            };
            report.note(format!(
                "checkshots: times are in {word}: only so the mean velocity, {:.0} m/s, is that of rock",
                if unit == 1.0 { 1000.0 * slope } else { slope }
            ));
            unit
        }
    };
    rows.iter_mut().for_each(|r| r[1] *= unit);
    Ok(Checkshot::new(rows)?)
}
