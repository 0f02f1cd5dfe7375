//! DXF drawings in ASCII: surfaces of 3DFACE and of meshes, lines of POLYLINE, LWPOLYLINE and LINE, single POINTs.
//!
//! The file is pairs of lines, a group code and its value. An entity begins with code 0; its layer is code 8, the
//! coordinates of its n-th corner are codes 10 + n, 20 + n, 30 + n. A POLYLINE is followed by a VERTEX for each place
//! and a SEQEND. Its flags (code 70) may make it a mesh: of m by n places (16; codes 71 and 72), or of places and then
//! faces, VERTEXes that hold numbers of places (64; codes 71 to 74, negative beside an edge that is not drawn). Each
//! layer is one surface: its faces a mesh, or its lines sticks. Drawings hold elevations as a rule,
//! but nothing in the file says so.

use super::raw::{RawPoint, RawShape, RawSurface, ReadContext};
use super::text::{self, SourceFile};
use super::welded_mesh::WeldedMesh;
use super::{Codec, Format, FormatError};
use crate::number;
use glam::DVec3;
use indexmap::IndexMap;

pub(super) const CODEC: Codec =
    Codec { read_horizon: Some(read), read_fault: Some(read), ..Codec::of(Format::Dxf, "dxf", "dxf", detect) };

/// The flag of a POLYLINE that is a mesh of rows and columns, and those of one that is closed along them.
const GRID: u32 = 16;
const CLOSED_ROWS: u32 = 1;
const CLOSED_COLUMNS: u32 = 32;
/// The flag of a POLYLINE that is a mesh of faces.
const FACES: u32 = 64;
/// The flag of a VERTEX that controls a smooth mesh and is no place of it.
const CONTROL: u32 = 16;
/// Flags of a VERTEX that is a place of a mesh; the second alone makes it a face.
const PLACE: u32 = 64;
const PART_OF_FACES: u32 = 128;

fn detect(source: &SourceFile) -> Option<String> {
    let start = String::from_utf8_lossy(&source.bytes[..source.bytes.len().min(4000)]).into_owned();
    let mut lines = text::lines(&start).map(|line| line.text).peekable();
    while lines.next_if_eq(&"999").is_some() {
        lines.next();
    }
    (lines.next()? == "0" && lines.next()? == "SECTION").then(|| "it begins with a DXF section".to_owned())
}

/// The entity being read.
#[derive(Default)]
struct Entity<'a> {
    kind: &'a str,
    /// Number of its line, from 1.
    line: usize,
    layer: &'a str,
    flags: u32,
    /// Codes 71 to 74: counts of a mesh, or numbers of places.
    numbers: [i64; 4],
    elevation: f64,
    /// Coordinates of the corners by axis; NaN = not given.
    corners: [[f64; 3]; 4],
    /// Places of an LWPOLYLINE, whose corner is given again and again.
    places: Vec<[f64; 2]>,
}

/// A layer of the drawing.
#[derive(Default)]
struct DxfLayer {
    faces: WeldedMesh,
    points: Vec<RawPoint>,
}

/// The layers in order of appearance, and the lines so far.
#[derive(Default)]
struct DxfDrawing {
    layers: IndexMap<String, DxfLayer>,
    /// Number of the line that places belong to.
    line: f64,
    /// The POLYLINE that is open.
    polyline: Option<DxfPolyline>,
}

/// A POLYLINE whose places are being read.
struct DxfPolyline {
    layer: String,
    flags: u32,
    /// Rows and columns of a mesh.
    counts: [usize; 2],
    /// Places of a mesh.
    places: Vec<DVec3>,
}

impl DxfPolyline {
    /// Corners of the faces of a mesh of rows and columns; none if it has another count of places.
    fn faces(&self) -> Option<Vec<[DVec3; 4]>> {
        let [rows, columns] = self.counts;
        if rows < 2 || columns < 2 || rows.checked_mul(columns) != Some(self.places.len()) {
            return None;
        }
        let last = |count: usize, closed: u32| if self.flags & closed != 0 { count } else { count - 1 };
        let place = |row: usize, column: usize| self.places[row % rows * columns + column % columns];
        let face = |row: usize, column: usize| {
            [place(row, column), place(row + 1, column), place(row + 1, column + 1), place(row, column + 1)]
        };
        let columns_of = |row: usize| (0..last(columns, CLOSED_COLUMNS)).map(move |column| (row, column));
        Some((0..last(rows, CLOSED_ROWS)).flat_map(columns_of).map(|(row, column)| face(row, column)).collect())
    }

    /// Corners of a face whose places have these numbers, from 1; none if it has fewer than three or unknown ones.
    fn face(&self, numbers: [i64; 4]) -> Option<[DVec3; 4]> {
        let place = |number: i64| {
            let index = usize::try_from(number.unsigned_abs()).ok()?.checked_sub(1)?;
            self.places.get(index).copied()
        };
        let [a, b, c] = [numbers[0], numbers[1], numbers[2]].map(place);
        let d = if numbers[3] == 0 { c } else { place(numbers[3]) };
        Some([a?, b?, c?, d?])
    }
}

impl DxfDrawing {
    fn layer(&mut self, name: &str) -> &mut DxfLayer {
        self.layers.entry(name.to_owned()).or_default()
    }

    fn place(&mut self, layer: &str, at: DVec3) {
        let stick = Some(self.line);
        self.layer(layer).points.push(RawPoint { xy: Some(at.truncate()), z: at.z, stick, ..RawPoint::default() });
    }

    /// Takes over a complete entity.
    fn add(&mut self, source: &SourceFile, entity: &Entity<'_>) -> Result<(), FormatError> {
        let corners = entity.corners.map(DVec3::from_array);
        let given = corners.iter().take_while(|corner| corner.is_finite()).count();
        let wrong = |expected: &str| Err(source.syntax(entity.line, expected, entity.kind));
        match entity.kind {
            "3DFACE" => match given {
                3 | 4 => self.layer(entity.layer).faces.face(&corners[..given]),
                _ => return wrong("a 3DFACE with three or four corners"),
            },
            "POLYLINE" => {
                self.line += 1.0;
                self.polyline = Some(DxfPolyline {
                    layer: entity.layer.to_owned(),
                    flags: entity.flags,
                    counts: [0, 1].map(|n| usize::try_from(entity.numbers[n]).unwrap_or(0)),
                    places: Vec::new(),
                });
            }
            "VERTEX" => return self.add_vertex(source, entity, (given > 0).then_some(corners[0])),
            "SEQEND" => {
                if let Some(polyline) = self.polyline.take().filter(|polyline| polyline.flags & GRID != 0) {
                    let Some(faces) = polyline.faces() else {
                        return wrong(
                            "as many VERTEXes as the mesh has rows times columns (codes 71 and 72) before it",
                        );
                    };
                    let layer = self.layer(&polyline.layer);
                    faces.iter().for_each(|face| layer.faces.face(face));
                }
            }
            "LWPOLYLINE" => {
                self.line += 1.0;
                for [x, y] in &entity.places {
                    self.place(entity.layer, DVec3::new(*x, *y, entity.elevation));
                }
            }
            "LINE" | "POINT" => {
                self.line += 1.0;
                corners[..given].iter().for_each(|corner| self.place(entity.layer, *corner));
            }
            _ => {}
        }
        Ok(())
    }
}

impl DxfDrawing {
    /// A place of a line or mesh, or a face of a mesh.
    fn add_vertex(&mut self, source: &SourceFile, entity: &Entity<'_>, at: Option<DVec3>) -> Result<(), FormatError> {
        let wrong = |expected: &str| Err(source.syntax(entity.line, expected, entity.kind));
        let mesh = self.polyline.as_mut().filter(|polyline| polyline.flags & (GRID | FACES) != 0);
        let is_face = entity.flags & (PLACE | PART_OF_FACES) == PART_OF_FACES;
        match (mesh, at) {
            (Some(mesh), _) if mesh.flags & FACES != 0 && is_face => {
                let Some(face) = mesh.face(entity.numbers) else {
                    return wrong("a face with three or four places of its mesh (codes 71 to 74)");
                };
                let layer = mesh.layer.clone();
                self.layer(&layer).faces.face(&face);
            }
            (_, None) => return wrong("a VERTEX with X, Y and Z"),
            (Some(mesh), Some(at)) if entity.flags & CONTROL == 0 => mesh.places.push(at),
            (Some(_), Some(_)) => {}
            (None, Some(at)) => {
                let layer = self.polyline.as_ref().map_or(entity.layer, |polyline| polyline.layer.as_str()).to_owned();
                self.place(&layer, at);
            }
        }
        Ok(())
    }
}

fn read(source: &SourceFile, context: &ReadContext<'_>) -> Result<Vec<RawSurface>, FormatError> {
    let text = source.text();
    // A value may be empty, so lines are not skipped here.
    let mut lines = text.lines().map(str::trim).enumerate();
    let mut drawing = DxfDrawing::default();
    let mut entity = Entity::default();
    while let (Some((number, code)), Some((_, value))) = (lines.next(), lines.next()) {
        let code: u32 = match code.parse() {
            Ok(code) => code,
            Err(_) if code.is_empty() => continue,
            Err(_) => return Err(source.syntax(number + 1, "a group code", code)),
        };
        let coordinate = || {
            let found = number::plain(value).filter(|v| v.is_finite() && v.abs() < 1e12);
            found.ok_or_else(|| source.syntax(number + 2, "a coordinate", value))
        };
        match code {
            0 => {
                drawing.add(source, &entity)?;
                entity = Entity { kind: value, line: number + 1, corners: [[f64::NAN; 3]; 4], ..Entity::default() };
            }
            8 => entity.layer = value,
            70 => entity.flags = value.parse().unwrap_or(0),
            71..=74 => entity.numbers[code as usize - 71] = value.parse().unwrap_or(0),
            38 => entity.elevation = coordinate()?,
            10 if entity.kind == "LWPOLYLINE" => entity.places.push([coordinate()?, f64::NAN]),
            20 if entity.kind == "LWPOLYLINE" => {
                let y = coordinate()?;
                entity.places.last_mut().into_iter().for_each(|place| place[1] = y);
            }
            10..=13 | 20..=23 | 30..=33 => {
                entity.corners[code as usize % 10][code as usize / 10 - 1] = coordinate()?;
            }
            _ => {}
        }
    }
    drawing.add(source, &entity)?;
    let mut surfaces = Vec::new();
    for (name, layer) in drawing.layers {
        let is_surface = !layer.faces.mesh.triangles.is_empty();
        let shape = if is_surface { RawShape::Mesh(layer.faces.mesh) } else { RawShape::Points(layer.points) };
        let name = Some(name).filter(|name| !name.is_empty());
        surfaces.push(RawSurface::new(name, shape));
    }
    if surfaces.is_empty() {
        return Err(source.empty(context.kind, "the drawing has no 3DFACE, POLYLINE, LWPOLYLINE, LINE or POINT"));
    }
    Ok(surfaces)
}
