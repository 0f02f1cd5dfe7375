//! A well from its files: deviation, tops, checkshots, logs.

use super::checkshot::parse_checkshot;
use super::collar::parse_collar;
use super::deviation::deviation_of;
use super::error::WellFileError;
use super::las::{Las, parse_las};
use super::las_tops;
use super::options::WellOptions;
use super::report::WellReport;
use super::rms;
use super::tops::{on_path, parse_tops};
use crate::unit::ZUnit;
use crate::unit::words;
use serde::{Deserialize, Serialize};
use std::path::{Path, PathBuf};
use survey::well::{Checkshot, Curve, LogSet, Well, WellPath};

/// The files of a well.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct WellFiles {
    /// The deviation, which gives the path.
    pub deviation: PathBuf,
    /// Collars of holes, where the deviation is a survey of them.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub collar: Option<PathBuf>,
    /// Tops.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub tops: Option<PathBuf>,
    /// Logs.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub las: Vec<PathBuf>,
    /// Time–depth table.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub checkshot: Option<PathBuf>,
}

fn text_of(file: &Path) -> Result<String, WellFileError> {
    let bytes = system::file::read(file, system::file::MAX_INTERPRETATION_BYTES)
        .map_err(|source| WellFileError::Io { file: file.to_owned(), source })?;
    Ok(String::from_utf8_lossy(&bytes).into_owned())
}

/// Reads a well.
///
/// # Errors
/// [`WellFileError`]; the text says what to do.
pub fn read_well(files: &WellFiles, options: &WellOptions) -> Result<(Well, WellReport), WellFileError> {
    let text = text_of(&files.deviation)?;
    let mut of_collar = WellReport::default();
    let collar = match &files.collar {
        Some(file) => Some(parse_collar(file, &text_of(file)?, options, &mut of_collar)?),
        None => None,
    };
    let stem = || files.deviation.file_stem().map_or_else(|| "well".into(), |s| s.to_string_lossy().into_owned());
    let (mut well, mut report) = if rms::is_rms(&text) {
        rms::parse_rms(&files.deviation, &text, options)?
    } else {
        let deviation = deviation_of(&files.deviation, &text, collar.as_ref(), options)?;
        (Well::new(deviation.name.unwrap_or_else(stem), deviation.path), deviation.report)
    };
    of_collar.assumptions.into_iter().for_each(|note| report.assume(note));
    let name = options.name.clone().unwrap_or_else(|| well.name.clone());
    well.name.clone_from(&name);
    let options = WellOptions { name: Some(name), ..options.clone() };
    if let Some(file) = &files.checkshot {
        let checkshot = parse_checkshot(file, &text_of(file)?, &well.path, &options, &mut report)?;
        let [low, high] = checkshot.velocity_range_m_s();
        let line = format!("{} checkshots, interval velocities {low:.0} to {high:.0} m/s", checkshot.points().len());
        if low < 300.0 || high > 10_000.0 {
            report.warnings.push(format!("{line}, which no rock has; check units and datum of the table").into());
        } else {
            report.notes.push(line.into());
        }
        well.checkshot = Some(checkshot);
    }
    if let Some(file) = &files.tops {
        let rows = parse_tops(file, &text_of(file)?, &well.path, &options, &mut report)?;
        well.tops = on_path(rows, &well.path, &mut report);
        report.notes.push(format!("{} tops", well.tops.len()).into());
    }
    for file in &files.las {
        let text = text_of(file)?;
        let las = parse_las(file, &text)?;
        if files.tops.is_none() && las_tops::table_of(&text).is_some() {
            let rows = parse_tops(file, &text, &well.path, &options, &mut report)?;
            well.tops.extend(on_path(rows, &well.path, &mut report));
            report.notes.push(format!("{} tops of {}", well.tops.len(), file.display()).into());
        }
        if let Some(inside) = las.well_name()
            && !same_name(inside, &well.name)
        {
            report.warn_once(format!("{} says that it is of well '{inside}'", file.display()));
        }
        if las.missing > 0 {
            let n = las.missing;
            report.warn_once(format!("{}: {n} values are no numbers (stars, words) and are missing", file.display()));
        }
        let set = log_set(file, &las, &well.path, well.checkshot.as_ref(), &mut report)?;
        let names: Vec<&str> = set.curves.iter().map(|c| c.name.as_str()).collect();
        report.notes.push(
            format!(
                "{}: {} curves ({}), {} samples from MD {:.1} to {:.1} m",
                set.source,
                set.curves.len(),
                names.join(", "),
                set.md_m.len(),
                set.md_m.first().unwrap_or(&f64::NAN),
                set.md_m.last().unwrap_or(&f64::NAN)
            )
            .into(),
        );
        well.logs.push(set);
    }
    Ok((well, report))
}

fn same_name(a: &str, b: &str) -> bool {
    let plain = |name: &str| name.chars().filter(|c| c.is_alphanumeric()).collect::<String>().to_lowercase();
    plain(a) == plain(b)
}

/// The curves of a LAS file on the well's measured depth.
fn log_set(
    file: &Path,
    las: &Las,
    path: &WellPath,
    checkshot: Option<&Checkshot>,
    report: &mut WellReport,
) -> Result<LogSet, WellFileError> {
    let mut md_m = index_md(file, las, path, checkshot, report)?;
    let falling = md_m.iter().rev().find(|v| v.is_finite()) < md_m.iter().find(|v| v.is_finite());
    let mut order: Vec<usize> = (0..md_m.len()).filter(|&n| md_m[n].is_finite()).collect();
    if falling {
        order.reverse();
    }
    // Measured depths that do not increase would make the axis ambiguous.
    let mut last = f64::NEG_INFINITY;
    let all = order.len();
    order.retain(|&n| {
        let on = md_m[n] > last;
        if on {
            last = md_m[n];
        }
        on
    });
    if order.len() < all {
        report.warnings.push(
            format!("{}: {} samples whose depth does not increase were left out", file.display(), all - order.len())
                .into(),
        );
    }
    if order.is_empty() {
        return Err(WellFileError::Empty { file: file.to_owned(), what: "samples along the well" });
    }
    let [first, end] = path.md_range_m();
    let beyond = order.iter().filter(|&&n| !(first..=end).contains(&md_m[n])).count();
    if beyond > 0 {
        report.warnings.push(
            format!(
                "{}: {beyond} of {} samples lie beyond the path, MD {first:.1} to {end:.1} m",
                file.display(),
                order.len()
            )
            .into(),
        );
    }
    check_limits(file, las, report);
    let curves = las.curves.iter().zip(&las.data).skip(1).map(|(item, values)| Curve {
        name: item.mnemonic.clone(),
        unit: item.unit.clone(),
        description: item.description.clone(),
        values: order.iter().map(|&n| values[n] as f32).collect(),
    });
    let curves = curves.collect();
    md_m = order.iter().map(|&n| md_m[n]).collect();
    let source = file.file_name().map_or_else(|| "log".into(), |n| n.to_string_lossy().into_owned());
    Ok(LogSet { source, md_m, curves })
}

/// Measured depth of every sample of a log, m; NaN where the index does not meet the well.
fn index_md(
    file: &Path,
    las: &Las,
    path: &WellPath,
    checkshot: Option<&Checkshot>,
    report: &mut WellReport,
) -> Result<Vec<f64>, WellFileError> {
    let index = &las.curves[0];
    let unusable = |instead, needs_checkshot| WellFileError::LasIndex {
        file: file.to_owned(),
        mnemonic: index.mnemonic.clone(),
        unit: index.unit.clone(),
        instead,
        needs_checkshot,
    };
    let word = index.mnemonic.to_ascii_uppercase();
    let vertical = ["TVD", "TVDSS"].iter().any(|w| word == *w);
    let unit = words::multiple_of(&index.unit);
    let of =
        |is_time: bool| unit.filter(|(_, unit)| unit.is_time() == is_time).map(|(n, unit)| n * ZUnit::in_survey(unit));
    let (to_m, to_ms) = (of(false), of(true));
    let axis = &las.data[0];
    Ok(if let Some(to_m) = to_m {
        let lengths = axis.iter().map(|v| v * to_m);
        if vertical {
            report.notes.push(format!("{word} of the log was laid onto the path").into());
            let datum = if word == "TVD" { path.datum_m() } else { 0.0 };
            lengths.map(|v| path.mds_at_tvdss(v - datum).first().copied().unwrap_or(f64::NAN)).collect()
        } else {
            lengths.collect()
        }
    } else if let Some(to_ms) = to_ms {
        if !word.contains("TWT") && word != "TIME" {
            return Err(unusable("only depths and two-way times can be laid along a well", false));
        }
        let Some(checkshot) = checkshot else {
            return Err(unusable("a log in two-way time needs the well's checkshots", true));
        };
        report.notes.push("the log's two-way times were laid onto the path through the checkshots".into());
        let md = |t: f64| path.mds_at_tvdss(checkshot.tvdss_at_twt(t * to_ms)).first().copied().unwrap_or(f64::NAN);
        axis.iter().map(|t| md(*t)).collect()
    } else {
        return Err(unusable("an index in M, FT, MS or S is expected: export the log again", false));
    })
}

/// Whether STRT and STOP are those of the data.
fn check_limits(file: &Path, las: &Las, report: &mut WellReport) {
    let axis = &las.data[0];
    for (mnemonic, found) in [("STRT", axis.first()), ("STOP", axis.last())] {
        if let (Some((said, _)), Some(found)) = (las.number(mnemonic), found)
            && (said - found).abs() > 1e-3 * (1.0 + said.abs())
        {
            report.warn_once(format!("{}: {mnemonic} says {said} but the data has {found}", file.display()));
        }
    }
}
