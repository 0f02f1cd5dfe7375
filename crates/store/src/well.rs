//! Wells on disk: `NAME.json`, laid out to be read and compared as text. Each station, top, checkshot and
//! curve has a line of its own.

use super::error::StoreError;
use super::header::{VERSION, check_kind};
use super::replacement::{replace_file, settle};
use serde::Deserialize;
use serde_json::Value;
use std::fmt::Write;
use std::path::Path;
use survey::well::Well;
use system::file;
use system::file::FileAction;

/// Kind of the file.
const KIND: &str = "well";

/// The file's content.
#[derive(Deserialize)]
struct WellDocument {
    kind: String,
    version: u64,
    well: Well,
}

/// How deep lists are laid out with a line for each entry; the numbers of a curve stay on one.
const OPEN: usize = 3;

/// Stores a well.
///
/// # Errors
/// [`StoreError`]; `path` is then what it was before.
pub fn write_well(path: &Path, well: &Well) -> Result<(), StoreError> {
    let value =
        serde_json::to_value(well).map_err(|error| StoreError::wrong_kind(path, "a well", error.to_string()))?;
    let mut text = format!("{{\n\"kind\": \"{KIND}\",\n\"version\": {VERSION},\n\"well\": ");
    lay_out(&mut text, &value, 0);
    text += "\n}\n";
    replace_file(path, text.as_bytes())
}

/// Appends a value; objects and lists of objects or pairs get a line for each entry.
fn lay_out(text: &mut String, value: &Value, depth: usize) {
    let opens = depth < OPEN;
    // Writing to a string cannot fail.
    match value {
        Value::Object(fields) if opens => {
            text.push_str("{\n");
            for (n, (name, value)) in fields.iter().enumerate() {
                let _ = write!(text, "{}: ", Value::from(name.as_str()));
                lay_out(text, value, depth + 1);
                text.push_str(if n + 1 < fields.len() { ",\n" } else { "\n}" });
            }
        }
        Value::Array(entries) if entries.first().is_some_and(|e| e.is_object() || e.is_array()) => {
            text.push_str("[\n");
            for (n, entry) in entries.iter().enumerate() {
                // A set of logs opens once more, so that each of its curves has a line.
                if entry.get("curves").is_some() {
                    lay_out(text, entry, 0);
                } else {
                    let _ = write!(text, "{entry}");
                }
                text.push_str(if n + 1 < entries.len() { ",\n" } else { "\n]" });
            }
        }
        other => {
            let _ = write!(text, "{other}");
        }
    }
}

/// Reads a well back.
///
/// # Errors
/// [`StoreError`] when it is missing, of another kind, newer than this program or damaged.
pub fn read_well(path: &Path) -> Result<Well, StoreError> {
    settle(path);
    let text = file::read_text(path, file::MAX_INTERPRETATION_BYTES)
        .map_err(|source| StoreError::io(FileAction::Read, path, source))?;
    let wrong = |reason| StoreError::wrong_kind(path, "a well", reason);
    let document: WellDocument = serde_json::from_str(&text).map_err(|error| wrong(error.to_string()))?;
    check_kind(path, "a well", [KIND, &document.kind], document.version)?;
    if document.well.logs.iter().any(|set| set.curves.iter().any(|c| c.values.len() != set.md_m.len())) {
        return Err(wrong("a curve has not a value for each measured depth".into()));
    }
    Ok(document.well)
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::DVec2;
    use survey::well::{Checkshot, Curve, LogSet, Survey, Top, WellPath};

    #[test]
    fn a_well_comes_back_and_can_be_read_by_people() {
        let surveys = [0.0, 500.0, 900.0].map(|md_m| Survey { md_m, inclination_deg: md_m / 20.0, azimuth_deg: 33.0 });
        let path = WellPath::minimum_curvature(DVec2::new(5.0e5, 6.1e6), 25.0, &surveys).unwrap();
        let mut well = Well::new("A 1", path);
        well.tops.push(Top { name: "Top \"Chalk\"".into(), md_m: 400.5 });
        well.checkshot = Some(Checkshot::new(vec![[0.0, 0.0], [1000.0, 900.0]]).unwrap());
        let curve = |name: &str| Curve {
            name: name.into(),
            unit: "GAPI".into(),
            description: String::new(),
            values: vec![30.5, f32::NAN, 31.0],
        };
        let md_m = vec![400.0, 400.5, 401.0];
        well.logs.push(LogSet { source: "a.las".into(), md_m, curves: vec![curve("GR"), curve("X")] });
        let folder = tempfile::tempdir().unwrap();
        let file = folder.path().join("A.json");
        write_well(&file, &well).unwrap();
        let read = read_well(&file).unwrap();
        assert_eq!((&read.path, &read.tops, &read.checkshot), (&well.path, &well.tops, &well.checkshot));
        assert!(read.logs[0].curves[1].values[1].is_nan() && read.logs[0].curves[0].values[2] == 31.0);
        let text = std::fs::read_to_string(&file).unwrap();
        assert!(text.lines().count() > 20 && text.lines().count() < 60, "{text}");
        std::fs::write(&file, text.replace("[30.5,null,31.0]", "[30.5]")).unwrap();
        assert!(read_well(&file).is_err());
        std::fs::write(&file, text.replace("\"well\",", "\"fault\",")).unwrap();
        assert!(matches!(read_well(&file), Err(StoreError::WrongKind { .. })));
    }
}
