//! Wavefront OBJ: surfaces of faces, lines of sticks, points.
//!
//! `v x y z`, `f a b c …` with the numbers of places from 1, or from the last one back where negative, each perhaps
//! with those of texture and normal after slashes; `l` and `p` are lines and points. Each `o` is a surface, or each `g`
//! where there is no `o`. All else (normals, textures, materials) is left out. Nothing states unit or sign; elevations,
//! positive up, are usual, and Blender exports them along Y unless it is told otherwise.

use super::columns::is_inside;
use super::placement::voxel_xy;
use super::raw::{RawPoint, RawShape, RawSurface, ReadContext};
use super::text::{self, Line, SourceFile};
use super::{Codec, Format, FormatError};
use crate::number;
use glam::{DVec2, DVec3};
use indexmap::IndexMap;
use std::collections::HashMap;
use survey::geometry::SurveyGeometry;
use survey::mesh::TriangleMesh;

pub(super) const CODEC: Codec =
    Codec { read_horizon: Some(read), read_fault: Some(read), ..Codec::of(Format::Obj, "obj", "obj", detect) };

/// The words that lines of the format begin with.
const KEYWORDS: &str = "v vt vn vp f l p o g s mg usemtl mtllib usemap maplib cstype deg surf curv end parm lod bevel";

fn detect(source: &SourceFile) -> Option<String> {
    let start = String::from_utf8_lossy(&source.bytes[..source.bytes.len().min(4000)]).into_owned();
    // The last line may be cut.
    let whole =
        if source.bytes.len() > 4000 { start.rsplit_once(['\n', '\r']).map_or("", |(whole, _)| whole) } else { &start };
    let (mut has_place, mut goes_on) = (false, false);
    for line in text::lines(whole).filter(|line| !line.text.starts_with('#')) {
        if std::mem::replace(&mut goes_on, line.text.ends_with('\\')) {
            continue;
        }
        let mut words = line.text.split_whitespace();
        let keyword = words.next().filter(|word| KEYWORDS.split(' ').any(|known| known == *word))?;
        has_place |= keyword == "v" && words.filter_map(number::plain).count() >= 3;
    }
    has_place.then(|| "its lines are those of a Wavefront OBJ".to_owned())
}

/// One object: faces over places of the file, lines and single places.
#[derive(Default)]
struct ObjObject {
    triangles: Vec<[usize; 3]>,
    lines: Vec<Vec<usize>>,
}

fn read(source: &SourceFile, context: &ReadContext<'_>) -> Result<Vec<RawSurface>, FormatError> {
    let text = source.text();
    let is_of = |keyword: &str| text::lines(&text).any(|line| line.text.split_whitespace().next() == Some(keyword));
    let divider = if is_of("o") { "o" } else { "g" };
    let mut places: Vec<DVec3> = Vec::new();
    let mut objects: IndexMap<Option<String>, ObjObject> = IndexMap::new();
    let mut name = None;
    let mut continued = String::new();
    for line in text::lines(&text) {
        // A line may go on after a backslash.
        if let Some(part) = line.text.strip_suffix('\\') {
            continued += part;
            continued.push(' ');
            continue;
        }
        let whole = std::mem::take(&mut continued) + line.text;
        let (keyword, rest) = whole.split_once(char::is_whitespace).unwrap_or((&whole, ""));
        let rest = rest.split(" #").next().unwrap_or(rest).trim();
        match keyword {
            "v" => places.push(place(source, line, rest)?),
            "f" | "l" | "p" => {
                let corners = corners(source, line, rest, places.len())?;
                let object: &mut ObjObject = objects.entry(name.clone()).or_default();
                match (keyword, &corners[..]) {
                    ("f", [first, others @ .., _]) if corners.len() > 2 => {
                        object.triangles.extend((1..=others.len()).map(|n| [*first, corners[n], corners[n + 1]]));
                    }
                    ("f", _) => return Err(source.syntax(line.number, "a face of three corners or more", line.text)),
                    ("l", _) => object.lines.push(corners),
                    _ => object.lines.extend(corners.into_iter().map(|corner| vec![corner])),
                }
            }
            word if word == divider => name = Some(rest.to_owned()).filter(|name| !name.is_empty()),
            _ => {}
        }
    }
    if objects.is_empty() && !places.is_empty() {
        // Clouds of points have no faces.
        let lines = (0..places.len()).map(|n| vec![n]).collect();
        objects.insert(None, ObjObject { lines, ..ObjObject::default() });
    }
    if objects.is_empty() {
        return Err(source.empty(context.kind, "it has no places (v), and no faces (f)"));
    }
    if let Some(geometry) = context.geometry.filter(|geometry| is_turned(&places, geometry)) {
        let unit = geometry.vertical.unit.symbol();
        let why = format!(
            "its Y are heights in {unit} and its Z run against the north, as Blender exports by default: export it with \
             Forward Axis Y and Up Axis Z"
        );
        return Err(source.empty(context.kind, why));
    }
    Ok(objects.into_iter().map(|(name, object)| surface(name, &object, &places)).collect())
}

fn place(source: &SourceFile, line: Line<'_>, rest: &str) -> Result<DVec3, FormatError> {
    let mut numbers = rest.split_whitespace().map(number::plain);
    let mut number = || numbers.next().flatten().filter(|v| v.is_nan() || v.abs() < 1e12);
    match (number(), number(), number()) {
        (Some(x), Some(y), Some(z)) if x.is_finite() && y.is_finite() => Ok(DVec3::new(x, y, z)),
        _ => Err(source.syntax(line.number, "v x y z", line.text)),
    }
}

/// The indices of the places of a face or a line.
fn corners(source: &SourceFile, line: Line<'_>, rest: &str, known: usize) -> Result<Vec<usize>, FormatError> {
    let corner = |word: &str| {
        let number: i64 = word.split('/').next()?.parse().ok()?;
        let index = if number < 0 { known as i64 + number } else { number - 1 };
        usize::try_from(index).ok().filter(|index| *index < known)
    };
    let expected = || format!("numbers of places from 1 to {known}, the places before it");
    rest.split_whitespace()
        .map(|word| corner(word).ok_or_else(|| source.syntax(line.number, expected(), line.text)))
        .collect()
}

/// Whether places lie over a survey only when Y and Z are exchanged as Blender does.
fn is_turned(places: &[DVec3], geometry: &SurveyGeometry) -> bool {
    let inside =
        |of: fn(&DVec3) -> DVec2| places.iter().filter(|p| is_inside(voxel_xy(geometry, of(p)), geometry)).count();
    inside(|p| p.truncate()) == 0 && inside(|p| DVec2::new(p.x, -p.z)) * 2 > places.len()
}

/// The triangles of an object, over its own places; or its lines, where it has no faces.
fn surface(name: Option<String>, object: &ObjObject, places: &[DVec3]) -> RawSurface {
    if object.triangles.is_empty() {
        let is_line = object.lines.iter().any(|line| line.len() > 1);
        let corners = object.lines.iter().enumerate().flat_map(|(n, line)| line.iter().map(move |corner| (n, *corner)));
        let point = |(n, corner): (usize, usize)| {
            let (at, stick) = (places[corner], is_line.then_some(n as f64));
            RawPoint { xy: Some(at.truncate()), z: at.z, stick, ..RawPoint::default() }
        };
        return RawSurface::new(name, RawShape::Points(corners.map(point).collect()));
    }
    let mut mesh = TriangleMesh::default();
    let mut own: HashMap<usize, u32> = HashMap::new();
    let is_whole = |triangle: &&[usize; 3]| triangle.iter().all(|corner| places[*corner].is_finite());
    for triangle in object.triangles.iter().filter(is_whole) {
        let corners = triangle.map(|corner| {
            *own.entry(corner).or_insert_with(|| {
                mesh.vertices.push(places[corner]);
                mesh.vertices.len() as u32 - 1
            })
        });
        mesh.triangles.push(corners);
    }
    let missing = object.triangles.len() - mesh.triangles.len();
    let note = (missing > 0).then(|| format!("{missing} triangles have a corner without a height and were left out"));
    RawSurface { notes: note.into_iter().collect(), ..RawSurface::new(name, RawShape::Mesh(mesh)) }
}
