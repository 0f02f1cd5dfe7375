//! The description of a well's file before its import.

use super::columns::WellColumn;
use super::deviation::resinsight;
use super::error::WellFileError;
use super::las::parse_las;
use super::las_tops;
use super::options::WellOptions;
use super::report::WellReport;
use super::rms;
use super::table::Table;
use serde::Serialize;
use std::path::{Path, PathBuf};

/// The kinds of well files.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum WellFileKind {
    /// The path of the well.
    Deviation,
    /// Named depths.
    Tops,
    /// Depths and times.
    Checkshot,
    /// Curves, LAS.
    Las,
}

/// A column or curve of a well's file.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct WellColumnDescription {
    /// Its name in the file.
    pub name: String,
    /// Its unit in the file; empty if none is stated.
    pub unit: String,
    /// Its description in the file.
    pub description: String,
    /// Number of values, without nulls.
    pub values: usize,
    /// Lowest and highest number.
    pub range: Option<[f64; 2]>,
}

/// The content of a well file.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct WellFileDescription {
    /// The file.
    pub file: PathBuf,
    /// Its kind.
    pub kind: WellFileKind,
    /// The evidence for the kind.
    pub evidence: String,
    /// Facts in its header.
    pub facts: Vec<String>,
    /// Count of rows.
    pub rows: usize,
    /// Columns or curves.
    pub columns: Vec<WellColumnDescription>,
}

fn column(name: &str, unit: &str, description: &str, values: impl Iterator<Item = f64>) -> WellColumnDescription {
    let (mut count, mut range) = (0, [f64::INFINITY, f64::NEG_INFINITY]);
    for value in values.filter(|v| v.is_finite()) {
        count += 1;
        range = [range[0].min(value), range[1].max(value)];
    }
    WellColumnDescription {
        name: name.into(),
        unit: unit.into(),
        description: description.into(),
        values: count,
        range: (count > 0).then_some(range),
    }
}

/// Describes a file if it belongs to a well: LAS, or a table whose columns are those of a deviation, of tops or of
/// checkshots. `None` for any other file.
///
/// # Errors
/// [`WellFileError`] for a LAS file that is broken.
pub fn describe(file: &Path, text: &str) -> Result<Option<WellFileDescription>, WellFileError> {
    let first = text.lines().map(str::trim).find(|l| !l.is_empty() && !l.starts_with('#')).unwrap_or("");
    if first.len() >= 2 && first.starts_with('~') && first[1..].starts_with(['V', 'v']) {
        let of_las = las_tops::table_of(text);
        let las = match (parse_las(file, text), of_las) {
            (Ok(las), _) => las,
            // A file may hold tops and no curves.
            (Err(_), Some(tops)) => return describe(file, &tops),
            (Err(error), None) => return Err(error),
        };
        let mut facts = vec![format!("LAS {:.1}{}", las.version, if las.wrapped { ", wrapped" } else { "" })];
        facts.extend(las.well.iter().filter(|i| !i.value.is_empty()).map(|i| {
            let unit = if i.unit.is_empty() { String::new() } else { format!(" {}", i.unit) };
            format!("{}: {}{unit}", i.mnemonic, i.value)
        }));
        facts.extend(
            las_tops::table_of(text)
                .map(|tops| format!("tops: {}", tops.lines().filter(|l| !l.is_empty()).count() - 1)),
        );
        let columns = las.curves.iter().zip(&las.data);
        return Ok(Some(WellFileDescription {
            file: file.to_owned(),
            kind: WellFileKind::Las,
            evidence: "it begins with a section ~V".into(),
            facts,
            rows: las.data.first().map_or(0, Vec::len),
            columns: columns
                .map(|(c, data)| column(&c.mnemonic, &c.unit, &c.description, data.iter().copied()))
                .collect(),
        }));
    }
    if rms::is_rms(text) {
        let (well, _) = rms::parse_rms(file, text, &WellOptions::default())?;
        let curves = well.logs.iter().flat_map(|set| &set.curves);
        return Ok(Some(WellFileDescription {
            file: file.to_owned(),
            kind: WellFileKind::Deviation,
            evidence: "its head is that of an RMS well".into(),
            facts: vec![format!("well: {}", well.name), format!("datum: {} m", well.path.datum_m())],
            rows: well.path.stations().len(),
            columns: curves.map(|c| column(&c.name, &c.unit, "", c.values.iter().map(|v| f64::from(*v)))).collect(),
        }));
    }
    let mut table = Table::parse(file, text);
    let is_titled = table.title.is_some()
        && table.columns.is_empty()
        && resinsight(file, &mut table, &mut WellReport::default()).is_ok();
    let has = |c: WellColumn| table.position(c).is_some();
    let depth = [WellColumn::Tvdss, WellColumn::Tvd, WellColumn::Z].into_iter().any(has);
    let angles = has(WellColumn::Md) && has(WellColumn::Inclination);
    let places = (has(WellColumn::X) && has(WellColumn::Y)) || (has(WellColumn::Dx) && has(WellColumn::Dy));
    let on_lines = table.names.iter().any(|n| {
        let name = n.to_ascii_lowercase();
        ["inline", "crossline", "iline", "xline"].iter().any(|w| name.contains(w))
    });
    let (kind, evidence) = if is_titled {
        (WellFileKind::Deviation, "a name stands alone before X, Y, TVDSS and MD, whose lengths agree")
    } else if angles || (has(WellColumn::Md) && places && depth) || (has(WellColumn::Dx) && depth) {
        (WellFileKind::Deviation, "its columns are those of a deviation")
    } else if has(WellColumn::Surface) && (has(WellColumn::Well) || has(WellColumn::Md)) && !on_lines {
        (WellFileKind::Tops, "its columns are a surface's name and a depth along a well")
    } else if !on_lines && !places && (depth || has(WellColumn::Md)) && (has(WellColumn::Twt) || has(WellColumn::Owt)) {
        (WellFileKind::Checkshot, "its columns are depth and time")
    } else {
        return Ok(None);
    };
    if is_titled {
        table.names = ["X", "Y", "TVDSS", "MD"].map(str::to_owned).to_vec();
    }
    let columns = table.names.iter().enumerate().map(|(n, name)| {
        let unit = table.units[n].map_or("", |u| u.symbol());
        column(name, unit, "", table.rows.iter().filter_map(|row| table.optional(row, n)))
    });
    Ok(Some(WellFileDescription {
        file: file.to_owned(),
        kind,
        evidence: evidence.into(),
        facts: table.facts.iter().map(|(key, value)| format!("{key}: {value}")).collect(),
        rows: table.rows.len(),
        columns: columns.collect(),
    }))
}
