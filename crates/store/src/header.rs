//! The header of a stored object: its kind, version and facts, in one attribute of its Zarr group.

use super::array::{read_group, write_group};
use super::error::StoreError;
use super::replacement::settle;
use serde::Serialize;
use serde::de::DeserializeOwned;
use serde_json::{Map, Value, json};
use std::path::Path;
use system::file::FileAction;

/// The attribute.
const KEY: &str = "petroglyph";

/// The format version this program writes, and the newest it reads.
pub const VERSION: u64 = 1;

/// Writes the group's own metadata.
pub(super) fn write_header(group: &Path, kind: &str, facts: &impl Serialize) -> Result<(), StoreError> {
    let facts = serde_json::to_value(facts)
        .map_err(|error| StoreError::array(group, FileAction::Written, error.to_string()))?;
    let header = json!({ "kind": kind, "version": VERSION, "facts": facts });
    write_group(group, "", Map::from_iter([(KEY.to_owned(), header)]))
}

/// Reads the group's facts back, checking kind and version; `expected` names the kind with its article.
pub(super) fn read_header<F: DeserializeOwned>(
    group: &Path,
    kind: &str,
    expected: &'static str,
) -> Result<F, StoreError> {
    settle(group);
    let mut attributes = read_group(group)?;
    let wrong = |reason: String| StoreError::wrong_kind(group, expected, reason);
    let header = attributes.remove(KEY).ok_or_else(|| wrong(format!("it has no attribute {KEY:?}")))?;
    let found = header.get("kind").and_then(Value::as_str).unwrap_or("nothing");
    let version = header.get("version").and_then(Value::as_u64).unwrap_or(0);
    check_kind(group, expected, [kind, found], version)?;
    let facts = header.get("facts").cloned().unwrap_or_default();
    serde_json::from_value(facts).map_err(|error| wrong(error.to_string()))
}

/// Refuses what says that it is of another kind than the first of the two, and a version that is not known yet.
pub(super) fn check_kind(
    path: &Path,
    expected: &'static str,
    [kind, found]: [&str; 2],
    version: u64,
) -> Result<(), StoreError> {
    if found != kind {
        return Err(StoreError::wrong_kind(path, expected, format!("it says that it is {found:?}")));
    }
    if version > VERSION {
        return Err(StoreError::NewerVersion { path: path.to_owned(), found: version, known: VERSION });
    }
    Ok(())
}
