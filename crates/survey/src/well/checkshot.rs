//! Time–depth tables of a well: TVDSS (m) against two-way time (ms), and what a survey in time uses without one.
//!
//! Between shots time is linear in depth; beyond the first and last it goes on at the nearest interval's velocity. Whether
//! a table is in seconds or milliseconds, if it does not say, is settled by physics: only one of the two gives interval
//! velocities between 300 and 10 000 m/s.

use super::WellError;
use super::columns::WellColumn;
use super::path::WellPath;
use super::read::WellOptions;
use super::table::Table;
use crate::formats::ZUnit;
use crate::remedy::Note;
use serde::{Deserialize, Serialize};
use std::path::Path;

/// A time–depth table, both increasing.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(try_from = "Vec<[f64; 2]>", into = "Vec<[f64; 2]>")]
pub struct Checkshot {
    /// (TVDSS in m, TWT in ms), at least two.
    points: Vec<[f64; 2]>,
}

impl TryFrom<Vec<[f64; 2]>> for Checkshot {
    type Error = WellError;

    fn try_from(points: Vec<[f64; 2]>) -> Result<Self, WellError> {
        Self::new(points)
    }
}

impl From<Checkshot> for Vec<[f64; 2]> {
    fn from(checkshot: Checkshot) -> Self {
        checkshot.points
    }
}

/// How depths along a well become vertical values of a survey.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum TimeDepth {
    /// The survey is in depth: TVDSS as it is.
    Depth,
    /// Through the well's checkshots.
    Checkshot,
    /// Through a constant velocity, m/s, from mean sea level.
    ConstantVelocity(f64),
}

impl std::fmt::Display for TimeDepth {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Depth => f.write_str("depth below sea level"),
            Self::Checkshot => f.write_str("time through the well's checkshots"),
            Self::ConstantVelocity(v) => {
                write!(f, "time through a constant {v} m/s from sea level, because the well has no checkshots")
            }
        }
    }
}

impl Checkshot {
    /// A table of (TVDSS in m, TWT in ms).
    ///
    /// # Errors
    /// [`WellError::NotIncreasing`] in either column, [`WellError::TooShort`], [`WellError::NotANumber`].
    pub fn new(points: Vec<[f64; 2]>) -> Result<Self, WellError> {
        if points.len() < 2 {
            return Err(WellError::TooShort { stations: points.len() });
        }
        if points.iter().flatten().any(|v| !v.is_finite() || v.abs() > 1e9) {
            return Err(WellError::NotANumber);
        }
        for (axis, what) in ["checkshot depth", "checkshot time"].into_iter().enumerate() {
            if let Some(pair) = points.windows(2).find(|w| w[1][axis] <= w[0][axis]) {
                return Err(WellError::NotIncreasing { what, before: pair[0][axis], after: pair[1][axis] });
            }
        }
        Ok(Self { points })
    }

    /// The table: TVDSS in m, TWT in ms.
    pub fn points(&self) -> &[[f64; 2]] {
        &self.points
    }

    /// TWT (ms) at a TVDSS (m).
    pub fn twt_at_tvdss(&self, tvdss_m: f64) -> f64 {
        self.along(tvdss_m, 0, 1)
    }

    /// TVDSS (m) at a TWT (ms).
    pub fn tvdss_at_twt(&self, twt_ms: f64) -> f64 {
        self.along(twt_ms, 1, 0)
    }

    fn along(&self, value: f64, from: usize, to: usize) -> f64 {
        let after = self.points.partition_point(|p| p[from] <= value).clamp(1, self.points.len() - 1);
        let (a, b) = (self.points[after - 1], self.points[after]);
        a[to] + (value - a[from]) * (b[to] - a[to]) / (b[from] - a[from])
    }

    /// Lowest and highest interval velocity, m/s.
    pub fn velocity_range_m_s(&self) -> [f64; 2] {
        let none = [f64::INFINITY, f64::NEG_INFINITY];
        let of = |w: &[[f64; 2]]| 2000.0 * (w[1][0] - w[0][0]) / (w[1][1] - w[0][1]);
        self.points.windows(2).map(of).fold(none, |r, v| [r[0].min(v), r[1].max(v)])
    }
}

/// Reads a checkshot table: a depth (TVDSS, TVD, Z or MD along `path`) and a time (TWT, or OWT one-way) a row.
/// Without a header the columns are TVDSS and TWT.
///
/// # Errors
/// [`WellError`] with the line, or with the columns that are missing.
pub fn parse_checkshot(
    file: &Path,
    text: &str,
    path: &WellPath,
    options: &WellOptions,
    notes: &mut Vec<Note>,
) -> Result<Checkshot, WellError> {
    let mut table = Table::parse(file, text);
    if table.rows.is_empty() {
        return Err(WellError::Empty { file: file.to_owned(), what: "checkshots" });
    }
    if table.columns.is_empty() {
        table.assume(&[WellColumn::Tvdss, WellColumn::Twt]);
        notes.push("checkshots: no header; columns taken as TVDSS, TWT".into());
    }
    table.keep_well(&options.well_in_file, &[])?;
    let time = [WellColumn::Twt, WellColumn::Owt].into_iter().find_map(|c| Some((c, table.position(c)?)));
    let depth = [WellColumn::Tvdss, WellColumn::Tvd, WellColumn::Z, WellColumn::Md]
        .into_iter()
        .find_map(|c| Some((c, table.position(c)?)));
    let (Some((time_column, time_at)), Some((depth_column, depth_at))) = (time, depth) else {
        return Err(WellError::Columns {
            file: file.to_owned(),
            why: "a depth and a time are needed".into(),
            example: "tvdss_m,twt_ms",
        });
    };
    let to_m = table.length_to_m(depth_at, options.md_unit, notes)?;
    let ways = if time_column == WellColumn::Owt { 2.0 } else { 1.0 };
    let mut rows = Vec::with_capacity(table.rows.len());
    for row in &table.rows {
        rows.push([table.number(row, depth_at)? * to_m, table.number(row, time_at)? * ways]);
    }
    // The sign of depths and times: both grow downwards in some files, both fall in others (elevations, negative times).
    for (axis, what) in [(0, "depths"), (1, "times")] {
        if rows.first().zip(rows.last()).is_some_and(|(a, b)| b[axis] < a[axis] && b[axis] < 0.0) {
            rows.iter_mut().for_each(|r| r[axis] = -r[axis]);
            notes.push(format!("checkshots: the {what} are negative and were turned positive down").into());
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
                notes
                    .push(format!("checkshots: {} of {before} lie beyond the well's path", before - rows.len()).into());
            }
        }
        _ => {}
    }
    rows.dedup();
    let unit = match table.units[time_at] {
        Some(ZUnit::Seconds) => 1000.0,
        Some(_) => 1.0,
        None => {
            let (Some(a), Some(b)) = (rows.first(), rows.last()) else {
                return Err(WellError::Empty { file: file.to_owned(), what: "checkshots" });
            };
            let slope = 2.0 * (b[0] - a[0]) / (b[1] - a[1]);
            let fits = |v: f64| (300.0..=10_000.0).contains(&v);
            let (unit, word) = match (fits(1000.0 * slope), fits(slope)) {
                (true, false) => (1.0, "ms"),
                (false, true) => (1000.0, "s"),
                _ => {
                    return Err(WellError::UnclearUnit {
                        file: file.to_owned(),
                        what: format!("the times (mean slope 2·Δz/Δt = {slope:.3})"),
                        candidates: "ms or s",
                        header: "tvdss_m,twt_ms",
                    });
                }
            };
            notes.push(
                format!(
                    "checkshots: times are in {word}: only so the mean velocity, {:.0} m/s, is that of rock",
                    if unit == 1.0 { 1000.0 * slope } else { slope }
                )
                .into(),
            );
            unit
        }
    };
    rows.iter_mut().for_each(|r| r[1] *= unit);
    Checkshot::new(rows)
}
