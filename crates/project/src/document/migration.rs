//! Documents of older versions, as tables of the present one.
//!
//! | version | where something came from |
//! |---|---|
//! | 1 | `source`: a path, a length in bytes and a sentence, `reading`; `seeds` of a horizon by time |
//! | 2 | `origin`, see [`Origin`], and the `quantity` that a volume measures |
//!
//! The sentences of version 1 are read here and nowhere else.

use super::Document;
use super::origin::{AttributeKind, Chooser, Origin};
use serde::Deserialize;
use serde::de::Error;
use std::path::{Path, PathBuf};
use store::VolumeInfo;
use survey::Quantity;
use toml::{Table, Value};

/// Reads the text of an older version; the data of the project lie beside `path`.
///
/// # Errors
/// A sentence about what is malformed.
pub(super) fn read(text: &str, path: &Path) -> Result<Document, String> {
    let mut table: Table = toml::from_str(text).map_err(|error| error.to_string())?;
    from_version_1(&mut table, path.parent().unwrap_or(Path::new(""))).map_err(|error| error.to_string())?;
    Document::deserialize(table).map_err(|error| error.to_string())
}

/// Turns a document of version 1 into one of version 2.
fn from_version_1(document: &mut Table, root: &Path) -> Result<(), toml::de::Error> {
    document.insert("version".to_owned(), Value::Integer(2));
    let volumes = document.get("volumes").cloned();
    for (kind, found) in document.iter_mut() {
        let entries = match found {
            Value::Array(all) => all.iter_mut().collect(),
            one => vec![one],
        };
        for entry in entries.into_iter().filter_map(Value::as_table_mut) {
            let Some(source) = entry.remove("source") else { continue };
            let source = Source::deserialize(source)?;
            let origin = match kind.as_str() {
                "volumes" => {
                    let quantity = source.quantity(&root.join(entry.get("file").and_then(Value::as_str).unwrap_or("")));
                    entry.extend(quantity.map(|quantity| ("quantity".to_owned(), Value::String(quantity.to_string()))));
                    source.of_volume()
                }
                "horizons" => source.of_horizon(entry)?,
                "faults" => source.of_fault(),
                "parameterization" => source.of_parameterization(volumes.as_ref()),
                _ => source.imported(),
            };
            entry.insert("origin".to_owned(), Value::try_from(origin).map_err(toml::de::Error::custom)?);
        }
    }
    Ok(())
}

/// What version 1 said of where something came from.
#[derive(Deserialize)]
struct Source {
    path: PathBuf,
    bytes: u64,
    reading: String,
}

impl Source {
    fn imported(self) -> Origin {
        Origin::Imported { path: self.path, bytes: self.bytes, reading: self.reading }
    }

    /// What was computed of which volume.
    fn computed(&self) -> Option<(&str, String)> {
        self.reading.split_once(" of the volume ").map(|(what, of)| (what, of.to_owned()))
    }

    /// What the samples of the volume in `folder` measure. Of a volume that was computed elsewhere only its own header
    /// says it.
    fn quantity(&self, folder: &Path) -> Option<Quantity> {
        let computed = self.computed().map(|(what, _)| Quantity::from(what.to_owned()));
        VolumeInfo::read(folder).map_or(computed, |info| info.quantity)
    }

    fn of_volume(self) -> Origin {
        let kind = |what: &str| AttributeKind::ALL.into_iter().find(|kind| kind.name() == what);
        match self.computed() {
            Some(("geologic time", of)) => Origin::GeologicTime { of },
            Some((what, of)) if let Some(attribute) = kind(what) => Origin::Attribute { attribute, of },
            _ if self.reading.starts_with("linked: ") => Origin::Linked { url: self.path.display().to_string() },
            _ => self.imported(),
        }
    }

    fn of_horizon(mut self, entry: &mut Table) -> Result<Origin, toml::de::Error> {
        let mut refined = Vec::new();
        while let Some((reading, done)) = self.reading.rsplit_once("; ") {
            let done = match done {
                "holes filled" => "filled",
                "smoothed" => "smoothed",
                _ => break,
            };
            refined.insert(0, Value::String(done.to_owned()));
            self.reading = reading.to_owned();
        }
        if !refined.is_empty() {
            entry.insert("refined".to_owned(), Value::Array(refined));
        }
        if let Some(seeds) = entry.remove("seeds") {
            return Ok(Origin::ByTime { seeds: Vec::deserialize(seeds)?, queries: Vec::new() });
        }
        if let Some(log) = entry.get("assembly") {
            let has_picks = log.get("picks").and_then(Value::as_array).is_some_and(|picks| !picks.is_empty());
            return Ok(if has_picks { Origin::Picked } else { Origin::Drawn });
        }
        // The levels that a person stated are not told from those that the program chose.
        let level = self.reading.strip_prefix("geologic time ").and_then(|time| time.parse().ok());
        if let Some(time) = level {
            return Ok(Origin::Level { time, chosen_by: Chooser::Program });
        }
        let top = self.path.display().to_string();
        let between = format!(" % of the thickness from {top} to ");
        Ok(match self.reading.split_once(&between).and_then(|(share, base)| Some((share.parse::<f32>().ok()?, base))) {
            Some((percent, base)) => Origin::Share { share: percent / 100.0, between: [top, base.to_owned()] },
            None => self.imported(),
        })
    }

    fn of_fault(self) -> Origin {
        let offset = self.reading.strip_prefix("proposed from the offsets of ");
        match self.path.to_str() {
            Some("picks") => Origin::Drawn,
            Some("proposal") => Origin::Proposed {
                horizons: offset.map_or_else(Vec::new, |names| names.split(", ").map(str::to_owned).collect()),
            },
            _ => self.imported(),
        }
    }

    fn of_parameterization(self, volumes: Option<&Value>) -> Origin {
        if !self.reading.starts_with("k by geologic time") {
            return self.imported();
        }
        let is_it = |entry: &&Value| entry.get("file").and_then(Value::as_str).map(Path::new) == Some(&self.path);
        let found = volumes.and_then(Value::as_array).and_then(|all| all.iter().find(is_it));
        let name = found.and_then(|entry| entry.get("name")?.as_str());
        Origin::TimeFraction { of: name.unwrap_or("time").to_owned() }
    }
}

#[cfg(test)]
mod tests;
