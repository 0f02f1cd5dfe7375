//! Faults on disk: `NAME.json`, laid out to be read and compared as text. Each vertex (world X, Y in m and
//! the vertical value) and each triangle (indices of vertices from 0) has a line of its own.

use super::error::StoreError;
use super::header::{VERSION, check_kind};
use super::replacement::{replace_file, settle};
use glam::DVec3;
use serde::Deserialize;
use std::fmt::Write;
use std::path::Path;
use survey::fault::Fault;
use survey::geometry::MAX_COORDINATE;
use survey::mesh::TriangleMesh;
use system::file;
use system::file::FileAction;

/// Kind of the file.
const KIND: &str = "fault";

/// The file's content.
#[derive(Deserialize)]
struct FaultDocument {
    kind: String,
    version: u64,
    name: String,
    #[serde(default)]
    truncated_by: Option<String>,
    #[serde(default)]
    grown_m: f64,
    vertices: Vec<[f64; 3]>,
    triangles: Vec<[u32; 3]>,
}

/// Stores a fault.
///
/// ```
/// # use glam::DVec3;
/// # use survey::{Fault, TriangleMesh};
/// let folder = tempfile::tempdir()?;
/// let path = folder.path().join("F1.json");
/// let mesh = TriangleMesh { vertices: vec![DVec3::ZERO, DVec3::X, DVec3::Z], triangles: vec![[0, 1, 2]] };
/// let fault = Fault::new("F1", mesh);
/// store::write_fault(&path, &fault)?;
/// assert_eq!(store::read_fault(&path)?, fault);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// [`StoreError`]; `path` then remains as it was. A coordinate that is not finite, or lies beyond any
/// survey, is refused.
pub fn write_fault(path: &Path, fault: &Fault) -> Result<(), StoreError> {
    let is_place = |vertex: &&DVec3| vertex.abs().max_element() <= MAX_COORDINATE && vertex.is_finite();
    if let Some(vertex) = fault.mesh.vertices.iter().find(|vertex| !is_place(vertex)) {
        return Err(StoreError::wrong_kind(path, "a fault", format!("the vertex {vertex} is not a place")));
    }
    let quoted = |text: &str| serde_json::Value::from(text).to_string();
    let mut text = format!("{{\n\"kind\": \"{KIND}\",\n\"version\": {VERSION},\n\"name\": {},\n", quoted(&fault.name));
    if let Some(other) = &fault.truncated_by {
        text += &format!("\"truncated_by\": {},\n", quoted(other));
    }
    if fault.grown_m != 0.0 {
        text += &format!("\"grown_m\": {:?},\n", fault.grown_m);
    }
    let vertices = fault.mesh.vertices.iter().map(|v| format!("[{:?}, {:?}, {:?}]", v.x, v.y, v.z));
    list(&mut text, "vertices", vertices);
    text += ",\n";
    list(&mut text, "triangles", fault.mesh.triangles.iter().map(|[a, b, c]| format!("[{a}, {b}, {c}]")));
    text += "\n}\n";
    replace_file(path, text.as_bytes())
}

/// Appends a list with a line for each entry.
fn list(text: &mut String, name: &str, entries: impl Iterator<Item = String>) {
    let lines = entries.collect::<Vec<_>>().join(",\n");
    // Writing to a string cannot fail.
    let _ = write!(text, "\"{name}\": [\n{lines}\n]");
}

/// Reads a fault back.
///
/// # Errors
/// [`StoreError`] when it is missing, of another kind, newer than this program or damaged.
pub fn read_fault(path: &Path) -> Result<Fault, StoreError> {
    settle(path);
    let text = file::read_text(path, file::MAX_INTERPRETATION_BYTES)
        .map_err(|source| StoreError::io(FileAction::Read, path, source))?;
    let wrong = |reason| StoreError::wrong_kind(path, "a fault", reason);
    let document: FaultDocument = serde_json::from_str(&text).map_err(|error| wrong(error.to_string()))?;
    check_kind(path, "a fault", [KIND, &document.kind], document.version)?;
    let is_place = |vertex: &&[f64; 3]| vertex.iter().all(|at| at.abs() <= MAX_COORDINATE);
    if let Some(vertex) = document.vertices.iter().find(|vertex| !is_place(vertex)) {
        return Err(wrong(format!("the vertex {vertex:?} lies beyond any survey")));
    }
    let count = document.vertices.len();
    if let Some(triangle) = document.triangles.iter().find(|t| t.iter().any(|&v| v as usize >= count)) {
        return Err(wrong(format!("triangle {triangle:?} names a vertex beyond the last, {count}")));
    }
    Ok(Fault {
        name: document.name,
        mesh: TriangleMesh {
            vertices: document.vertices.into_iter().map(DVec3::from_array).collect(),
            triangles: document.triangles,
        },
        truncated_by: document.truncated_by,
        grown_m: document.grown_m,
    })
}
