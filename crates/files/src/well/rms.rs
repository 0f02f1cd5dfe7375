//! RMS wells (`.rmswell`, `.w`): places and logs in one file.
//!
//! ```text
//! 1.0
//! EXPLORATION - DRILLED
//! NAME X Y [KB]
//! count of logs
//! MDepth UNK lin
//! Zone DISC 0 Above 1 A
//! X Y TVDSS value value …
//! ```
//!
//! −999 is undefined. A log of zones is the well's tops: where each zone begins.

use super::error::WellFileError;
use super::options::WellOptions;
use super::report::WellReport;
use crate::number::{self, NumberStyle};
use crate::text::{self, excerpt};
use glam::DVec3;
use std::collections::HashMap;
use std::path::Path;
use survey::remedy::{Note, Setting};
use survey::well::{Curve, LogSet, Top, Well, WellPath};

/// What stands for an undefined value.
const UNDEFINED: f64 = -999.0;
/// Logs of a file, at most.
const MOST_LOGS: usize = 10_000;

/// A log as the header declares it.
struct Log {
    name: String,
    unit: String,
    /// The names of codes, of a discrete log.
    codes: Option<HashMap<i64, String>>,
}

/// Whether a text is an RMS well: a version, words, a name with two or three numbers, a count.
pub(super) fn is_rms(text: &str) -> bool {
    let lines: Vec<&str> = text::lines(text).take(4).map(|line| line.text).collect();
    let [version, kind, head, count] = lines[..] else { return false };
    let version = version.parse::<f64>().is_ok_and(|version| (1.0..2.0).contains(&version));
    let is_kind = kind.chars().any(char::is_alphabetic) && number::plain(kind).is_none();
    version && is_kind && head_of(head, None).is_some() && count.parse::<usize>().is_ok()
}

/// Name and datum of the third line, whose X and Y are those of the first place: a name may end with a number.
fn head_of(line: &str, first: Option<DVec3>) -> Option<(String, Option<f64>)> {
    let fields: Vec<&str> = line.split_whitespace().collect();
    let numbers: Vec<f64> = fields.iter().rev().map_while(|field| number::plain(field)).take(3).collect();
    let name = |taken: usize| fields[..fields.len() - taken].join(" ");
    let off = |x: f64, y: f64| first.map_or(f64::INFINITY, |first| (x - first.x).abs() + (y - first.y).abs());
    match numbers[..numbers.len().min(fields.len().saturating_sub(1))] {
        [c, b, a] if off(b, c) < off(a, b) => Some((name(2), None)).filter(|_| a.is_finite()),
        [datum, ..] if numbers.len() == 3 && fields.len() > 3 => Some((name(3), Some(datum))),
        [_, _, ..] => Some((name(2), None)),
        _ => None,
    }
}

fn log_of(line: &str) -> Log {
    let mut fields = line.split_whitespace();
    let name = fields.next().unwrap_or("").to_owned();
    let unit = fields.next().unwrap_or("").to_owned();
    let is_discrete = unit.eq_ignore_ascii_case("DISC");
    let codes = is_discrete.then(|| {
        let rest: Vec<&str> = fields.collect();
        let pair = |pair: &[&str]| Some((pair[0].parse().ok()?, pair[1].to_owned()));
        rest.chunks_exact(2).filter_map(pair).collect()
    });
    let unit = if is_discrete || unit.starts_with("UNK") || unit.starts_with("CONT") { String::new() } else { unit };
    Log { name, unit, codes }
}

/// Reads an RMS well.
///
/// # Errors
/// [`WellFileError`] with the line.
pub fn parse_rms(file: &Path, text: &str, options: &WellOptions) -> Result<(Well, WellReport), WellFileError> {
    let mut lines = text::lines(text).skip(2);
    let empty = |what| WellFileError::Empty { file: file.to_owned(), what };
    let head = lines.next().map(|line| line.text).ok_or_else(|| empty("head of a well"))?;
    let count = lines.next().and_then(|line| line.text.parse().ok()).filter(|count: &usize| *count <= MOST_LOGS);
    let logs: Vec<Log> = (0..count.ok_or_else(|| empty("count of logs"))?)
        .map(|_| lines.next().map(|line| log_of(line.text)).ok_or_else(|| empty("logs as its header announces")))
        .collect::<Result<_, _>>()?;
    let mut report = WellReport::default();
    let (mut places, mut values) = (Vec::new(), vec![Vec::new(); logs.len()]);
    let mut missing = 0_usize;
    for line in lines {
        let fields: Vec<Option<f64>> =
            line.text.split_whitespace().map(|field| number::or_missing(field, NumberStyle::Point)).collect();
        if fields.len() != 3 + logs.len() || fields.contains(&None) {
            return Err(WellFileError::Syntax {
                file: file.to_owned(),
                line: line.number,
                expected: format!("X, Y, TVDSS and {} values", logs.len()),
                found: excerpt(line.text),
            });
        }
        let row: Vec<f64> = fields.into_iter().flatten().collect();
        let place = DVec3::new(row[0], row[1], row[2]);
        if !place.is_finite() {
            missing += 1;
            continue;
        }
        places.push(place);
        values
            .iter_mut()
            .zip(&row[3..])
            .for_each(|(log, value)| log.push(if *value == UNDEFINED { f64::NAN } else { *value }));
    }
    if missing > 0 {
        report.warn_once(format!("{missing} stations lack a number and were left out"));
    }
    if places.is_empty() {
        return Err(empty("places"));
    }
    let (name, datum) = head_of(head, places.first().copied()).ok_or_else(|| empty("head of a well"))?;
    let index = logs.iter().position(|log| ["mdepth", "md"].contains(&log.name.to_ascii_lowercase().as_str()));
    let md: Option<Vec<f64>> = index.map(|n| values[n].clone()).filter(|md| md.iter().all(|md| md.is_finite()));
    let at_zero = md.as_ref().and_then(|md| (md.first() == Some(&0.0)).then(|| -places[0].z));
    let datum_m = options.datum_m.or(datum).or(at_zero).unwrap_or_else(|| {
        report.warn_once(Note::unless(
            "no height of the datum (KB) is given: taken as 0 m above sea level",
            Setting::Datum.stated(),
        ));
        0.0
    });
    report.assume(Note::unless("lengths are taken as metres, in which RMS writes", Setting::MdUnit.stated_as("ft")));
    let scale = options.md_unit.map_or(1.0, |unit| unit.in_survey());
    let xy = options.xy_unit.map_or(1.0, |unit| unit.in_survey());
    let stations: Vec<(Option<f64>, DVec3)> = places
        .iter()
        .enumerate()
        .map(|(n, p)| (md.as_ref().map(|md| md[n] * scale), *p * DVec3::new(xy, xy, scale)))
        .collect();
    let path = WellPath::through(datum_m, &stations)?;
    report.note(format!("path straight between {} places of an RMS well", stations.len()));
    let mut well = Well::new(if name.is_empty() { "well".to_owned() } else { name }, path);
    let md_m: Vec<f64> = well.path.stations().iter().map(|station| station.md_m).collect();
    for (log, values) in logs.iter().zip(&values) {
        let Some(codes) = log.codes.as_ref().filter(|_| log.name.to_ascii_lowercase().contains("zone")) else {
            continue;
        };
        for n in 0..values.len() {
            let begins = values[n].is_finite() && (n == 0 || values[n] != values[n - 1]);
            if let Some(zone) = codes.get(&(values[n] as i64)).filter(|_| begins && n > 0) {
                well.tops.push(Top { name: zone.clone(), md_m: md_m[n] });
            }
        }
    }
    let curves: Vec<Curve> = logs
        .iter()
        .zip(&values)
        .enumerate()
        .filter(|(n, _)| Some(*n) != index)
        .map(|(_, (log, values))| Curve {
            name: log.name.clone(),
            unit: log.unit.clone(),
            description: String::new(),
            values: values.iter().map(|value| *value as f32).collect(),
        })
        .collect();
    if !curves.is_empty() {
        let source = file.file_name().map_or_else(|| "log".into(), |n| n.to_string_lossy().into_owned());
        report.note(format!("{} curves, {} tops by zones", curves.len(), well.tops.len()));
        well.logs.push(LogSet { source, md_m, curves });
    }
    Ok((well, report))
}
