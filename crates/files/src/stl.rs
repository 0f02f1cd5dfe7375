//! STL: triangles, as text or binary.
//!
//! Text: `solid NAME`, for each triangle `facet normal … / outer loop / vertex x y z` three times `/ endloop /
//! endfacet`, `endsolid`; each solid is a surface. Binary: 80 bytes of anything, a count, then for each triangle 12
//! floats of 4 bytes, little-endian, of which the first three are a normal, and 2 bytes. Normals are left out. Nothing
//! states unit or sign.

use super::binary::{BinaryCursor, Endian, Word};
use super::raw::{RawShape, RawSurface, ReadContext};
use super::text::{self, SourceFile};
use super::welded_mesh::WeldedMesh;
use super::{Codec, Format, FormatError};
use crate::number;
use glam::DVec3;

pub(super) const CODEC: Codec =
    Codec { read_horizon: Some(read), read_fault: Some(read), ..Codec::of(Format::Stl, "stl", "stl", detect) };

/// Bytes before the count.
const HEADER: usize = 80;
/// Bytes of a triangle.
const TRIANGLE: usize = 50;

/// Whether it is text: some programs begin binary files with the same word.
fn is_text(source: &SourceFile) -> bool {
    let start = String::from_utf8_lossy(&source.bytes[..source.bytes.len().min(1000)]).to_ascii_lowercase();
    start.trim_start().starts_with("solid") && (start.contains("facet") || start.contains("endsolid"))
}

fn triangles_announced(source: &SourceFile) -> Option<usize> {
    BinaryCursor::at(source, HEADER, Endian::Little).count(Word::U32).ok()
}

fn detect(source: &SourceFile) -> Option<String> {
    if is_text(source) {
        return Some("it begins with solid and has facets".to_owned());
    }
    let count = triangles_announced(source)?;
    if count > 0 && source.bytes.len() == HEADER + 4 + count * TRIANGLE {
        return Some(format!("it is as long as a binary STL of {count} triangles"));
    }
    let is_named = source.path.extension().is_some_and(|extension| extension.eq_ignore_ascii_case("stl"));
    is_named.then(|| "its name ends in .stl".to_owned())
}

fn read(source: &SourceFile, context: &ReadContext<'_>) -> Result<Vec<RawSurface>, FormatError> {
    let surfaces = if is_text(source) { of_text(source)? } else { vec![of_bytes(source)?] };
    let has_faces = |surface: &RawSurface| matches!(&surface.shape, RawShape::Mesh(mesh) if !mesh.triangles.is_empty());
    let surfaces: Vec<RawSurface> = surfaces.into_iter().filter(has_faces).collect();
    if surfaces.is_empty() {
        return Err(source.empty(context.kind, "it has no triangle with three different corners"));
    }
    Ok(surfaces)
}

fn of_text(source: &SourceFile) -> Result<Vec<RawSurface>, FormatError> {
    let text = source.text();
    let mut surfaces = Vec::new();
    let (mut name, mut solid, mut facets) = (None, WeldedMesh::default(), 0);
    let mut corners = Vec::new();
    for line in text::lines(&text) {
        let (keyword, rest) = line.text.split_once(char::is_whitespace).unwrap_or((line.text, ""));
        match keyword.to_ascii_lowercase().as_str() {
            "solid" => name = Some(rest.trim().to_owned()).filter(|name| !name.is_empty()),
            "vertex" => {
                let numbers: Vec<f64> = rest.split_whitespace().filter_map(number::plain).collect();
                let [x, y, z] = numbers[..] else { return Err(source.syntax(line.number, "vertex x y z", line.text)) };
                corners.push(DVec3::new(x, y, z));
            }
            "endfacet" | "endloop" if !corners.is_empty() => {
                if corners.len() < 3 {
                    return Err(source.syntax(line.number, "three vertices before it", line.text));
                }
                add(&mut solid, &corners);
                corners.clear();
                facets += 1;
            }
            "endsolid" => {
                surfaces.push(finished(name.take(), std::mem::take(&mut solid), std::mem::take(&mut facets)));
            }
            _ => {}
        }
    }
    let last = text::lines(&text).last().map_or(0, |line| line.number);
    if !corners.is_empty() || !solid.mesh.triangles.is_empty() {
        return Err(source.syntax(last, "endsolid at its end", "a file that was cut off"));
    }
    Ok(surfaces)
}

/// Adds a face; one with a corner that is no number is left out.
fn add(solid: &mut WeldedMesh, corners: &[DVec3]) {
    if corners.iter().all(|corner| corner.is_finite() && corner.abs().max_element() < 1e12) {
        solid.face(corners);
    }
}

/// The surface of a solid that has so many facets in its file.
fn finished(name: Option<String>, solid: WeldedMesh, facets: usize) -> RawSurface {
    let missing = facets.saturating_sub(solid.mesh.triangles.len());
    let fact = "triangles have no area, or a corner that is no number, and were left out";
    let note = (missing > 0).then(|| format!("{missing} {fact}"));
    RawSurface { notes: note.into_iter().collect(), ..RawSurface::new(name, RawShape::Mesh(solid.mesh)) }
}

fn of_bytes(source: &SourceFile) -> Result<RawSurface, FormatError> {
    let mut rest = BinaryCursor::at(source, HEADER, Endian::Little);
    let count = rest.count(Word::U32)?;
    let found = rest.rest.len() / TRIANGLE;
    if found < count {
        return Err(source.length("triangles", count, found));
    }
    let mut solid = WeldedMesh::default();
    for triangle in rest.rest.as_chunks::<TRIANGLE>().0.iter().take(count) {
        let numbers = Word::F32.values(&triangle[12..48], Endian::Little);
        let corners: Vec<DVec3> = numbers.as_chunks::<3>().0.iter().map(|corner| DVec3::from_array(*corner)).collect();
        add(&mut solid, &corners);
    }
    let mut surface = finished(None, solid, count);
    let RawShape::Mesh(mesh) = &surface.shape else { return Ok(surface) };
    let largest = mesh.vertices.iter().map(|v| v.truncate().abs().max_element()).fold(0.0, f64::max);
    let step = largest * f64::from(f32::EPSILON);
    if step > 0.01 {
        surface.notes.push(format!("its coordinates are floats of 4 bytes, which tell places {step:.2} m apart"));
    }
    Ok(surface)
}
