//! `petroglyph info` of horizon, fault and well files: what they hold before they are imported.

use super::option;
use super::report::Report;
use files::well::{self, WellFileDescription};
use files::{FileDescription, FormatError, ImportOptions, SurfaceDescription};
use std::fs::File;
use std::io::Read;
use std::path::Path;
use system::file;

/// Files longer than this are taken for volumes.
const LARGEST: u64 = file::MAX_INTERPRETATION_BYTES;

/// Describes a horizon, fault or well file; `None` if it is none of them (then it may be SEG-Y).
pub(super) fn describe(path: &Path, options: &ImportOptions) -> anyhow::Result<Option<Report>> {
    if let Some(error) = known_at_length(path) {
        return Err(error.into());
    }
    if options.format.is_none() && is_volume(path) {
        return Ok(None);
    }
    if options.format.is_none() {
        let unreadable = |source| FormatError::Io { action: "read", file: path.to_owned(), source };
        let bytes = file::read(path, LARGEST).map_err(unreadable)?;
        if let Some(error) = files::known_but_not_read(path, &bytes) {
            return Err(error.into());
        }
        let text = String::from_utf8_lossy(&bytes).into_owned();
        if let Some(found) = well::describe(path, &text)? {
            return Ok(Some(well_file(&found)));
        }
    }
    match files::describe(path, options) {
        Ok(mut found) => {
            found.surfaces.iter_mut().for_each(|surface| option::name_in(surface.notes_mut()));
            Ok(Some(interpretation(&found)))
        }
        Err(FormatError::UnknownFormat { is_named: false, .. }) if may_be_segy(path) => Ok(None),
        Err(error) => Err(error.into()),
    }
}

/// What a file too long for an interpretation is, if it is an archive or another kind that is known and not read.
fn known_at_length(path: &Path) -> Option<FormatError> {
    let mut start = vec![0; 1 << 16];
    file::ordinary(path).ok().filter(|facts| facts.len() > LARGEST)?;
    File::open(path).and_then(|mut file| file.read_exact(&mut start)).ok()?;
    files::known_but_not_read(path, &start)
}

/// Whether a file is a volume rather than an interpretation, judged by its extension, its length or the first bytes of
/// a text header.
fn is_volume(path: &Path) -> bool {
    let extension = path.extension().map(|e| e.to_string_lossy().to_ascii_lowercase()).unwrap_or_default();
    let long = std::fs::metadata(path).is_ok_and(|facts| facts.len() > LARGEST);
    files::segy::ENDINGS.contains(&extension.as_str()) || long || begin(path).is_some_and(|b| b[..2] == [0xC3, 0x40])
}

/// Whether a file is as long as the headers of SEG-Y at least; shorter ones get the error for interpretation files.
fn may_be_segy(path: &Path) -> bool {
    std::fs::metadata(path).is_ok_and(|facts| facts.len() >= 3600)
}

fn begin(path: &Path) -> Option<[u8; 4]> {
    let mut start = [0; 4];
    file::ordinary(path).ok()?;
    File::open(path).and_then(|mut file| file.read_exact(&mut start)).ok()?;
    Some(start)
}

fn interpretation(found: &FileDescription) -> Report {
    let mut report = Report::default();
    let evidence = match &found.format.source {
        files::Provenance::File(words) => words.as_str(),
        files::Provenance::Option | files::Provenance::Assumed => "as stated",
    };
    report.say(format!(
        "{}: {} file in the format {} ({evidence}), {} bytes",
        found.file.display(),
        found.kind,
        found.format.value,
        found.bytes
    ));
    for surface in &found.surfaces {
        say_surface(surface, &mut report);
    }
    report.fields(found);
    report
}

fn say_surface(surface: &SurfaceDescription, report: &mut Report) {
    let range = |word: &str, range: Option<[f64; 2]>, report: &mut Report| {
        if let Some([low, high]) = range {
            report.say(format!("  {word:<11} {low} to {high}"));
        }
    };
    report.say(format!("surface {}", surface.name.as_deref().map_or("without a name".into(), |n| format!("'{n}'"))));
    report.say(format!("  {:<11} {}", "shape", surface.shape));
    report.say(format!("  {:<11} {} values, {} of them holes", "nodes", surface.values, surface.nulls));
    range("X", surface.x, report);
    range("Y", surface.y, report);
    range("inlines", surface.inlines, report);
    range("crosslines", surface.crosslines, report);
    range("values", surface.range, report);
    report.say(format!("  {:<11} {}", "unit", surface.unit));
    report.say(format!("  {:<11} {}", "positive", surface.positive));
    for note in &surface.notes {
        report.say(format!("  {:<11} {note}", "note"));
    }
    for warning in &surface.warnings {
        report.say(format!("  {:<11} {warning}", "warning"));
    }
    if let Some([low, high]) = surface.range {
        let most = surface.histogram.iter().copied().max().unwrap_or(1).max(1);
        report.say("  histogram of the values");
        for (n, count) in surface.histogram.iter().enumerate() {
            let from = low + (high - low) * n as f64 / surface.histogram.len() as f64;
            report.say(format!("  {from:>14.3} {} {count}", "#".repeat((count * 40).div_ceil(most))));
        }
    }
    if !surface.map.is_empty() {
        report.say("  map, north up; from . for the lowest values to # for the highest");
        for row in &surface.map {
            report.say(format!("    {row}"));
        }
    }
}

fn well_file(found: &WellFileDescription) -> Report {
    let mut report = Report::default();
    let kind = format!("{:?}", found.kind).to_lowercase();
    report.say(format!("{}: {kind} of a well ({}), {} rows", found.file.display(), found.evidence, found.rows));
    for fact in &found.facts {
        report.say(format!("  {fact}"));
    }
    for column in &found.columns {
        let range = column.range.map_or("no numbers".into(), |[low, high]| format!("{low} to {high}"));
        let unit = if column.unit.is_empty() { String::new() } else { format!(" ({})", column.unit) };
        let about = if column.description.is_empty() { String::new() } else { format!("; {}", column.description) };
        report.say(format!("  {}{unit}: {} values, {range}{about}", column.name, column.values));
    }
    report.fields(found);
    report
}
