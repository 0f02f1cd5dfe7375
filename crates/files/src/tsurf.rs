//! GOCAD TSurf: triangulated surfaces; VSet and PLine: points and lines.
//!
//! One or more objects `GOCAD TSurf 1 … END`; in each a `HEADER { name: … }`, an optional coordinate system
//! block (`AXIS_UNIT` and `ZPOSITIVE` state unit and sign), then `TFACE` parts of `VRTX id x y z` or
//! `PVRTX id x y z p…`, `ATOM id ref` (a vertex at the place of another) and `TRGL a b c`. Ids may start
//! anywhere. Everything else (`BSTONE`, `BORDER`, properties, colours) is ignored.
//!
//! A VSet is its vertices; a PLine has an `ILINE` before the vertices of each line, and each is a stick.
//!
//! Written with ZPOSITIVE Depth, one TFACE for each sheet, and CNXYZ at each vertex, which strict readers require.

use super::column::{self, Column};
use super::raw::{RawPoint, RawShape, RawSurface, ReadContext, VerticalFacts};
use super::text::{self, Line, SourceFile};
use super::unit::{Domain, ZPositive, ZUnit};
use super::write::WriteFailure;
use super::{Codec, Format, FormatError, HorizonWriter};
use crate::number;
use glam::{DVec2, DVec3};
use std::collections::HashMap;
use std::io::Write;
use survey::fault::Fault;
use survey::geometry::SurveyGeometry;
use survey::horizon::{Horizon, Sheet};
use survey::mesh::TriangleMesh;

pub(super) const CODEC: Codec = Codec {
    read_horizon: Some(read),
    read_fault: Some(read),
    write_horizon: Some(HorizonWriter { holds_any_shape: true, ..HorizonWriter::of(write_horizon) }),
    write_fault: Some(write_fault),
    ..Codec::of(Format::Tsurf, "tsurf", "ts", detect)
};

fn detect(source: &SourceFile) -> Option<String> {
    let start = String::from_utf8_lossy(&source.bytes[..source.bytes.len().min(400)]).into_owned();
    let first = text::lines(&start).find(|l| !l.text.starts_with('#'))?;
    let mut words = first.text.split_whitespace();
    let kind = (words.next()? == "GOCAD").then(|| words.next())??;
    ObjectKind::of(kind).map(|_| format!("it begins with GOCAD {kind}"))
}

/// The kinds of objects that are read.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
enum ObjectKind {
    #[default]
    Surface,
    Points,
    Lines,
}

impl ObjectKind {
    fn of(word: &str) -> Option<Self> {
        let named = [("TSurf", Self::Surface), ("VSet", Self::Points), ("PLine", Self::Lines)];
        named.into_iter().find(|(name, _)| name.eq_ignore_ascii_case(word)).map(|(_, kind)| kind)
    }
}

/// The state of the object being read.
#[derive(Default)]
struct GocadObject {
    kind: ObjectKind,
    /// The line of each vertex, of a PLine.
    lines: Vec<f64>,
    /// Names of the properties of a vertex, and of each vertex that which tells surfaces apart.
    properties: Vec<String>,
    levels: Vec<Option<f64>>,
    line: f64,
    name: Option<String>,
    mesh: TriangleMesh,
    index: HashMap<u64, u32>,
    vertical: VerticalFacts,
    in_coordinates: bool,
    axis_name: Option<String>,
}

impl GocadObject {
    /// Its surfaces: one, or those that a property of its points tells apart.
    fn surfaces(self) -> Vec<RawSurface> {
        let mut levels: Vec<f64> = self.levels.iter().copied().flatten().collect();
        levels.sort_by(f64::total_cmp);
        levels.dedup();
        let count = self.lines.len();
        let tells = self.kind == ObjectKind::Points
            && (2..=64).contains(&levels.len())
            && self.levels.len() == count
            && self.levels.iter().all(Option::is_some)
            && count >= 3 * levels.len();
        if !tells {
            return vec![self.surface()];
        }
        let of_points = self.levels.clone();
        let whole = self.surface();
        let RawShape::Points(points) = &whole.shape else { return vec![whole] };
        let of = |level: &f64| {
            let own = points.iter().zip(&of_points).filter(|(_, own)| **own == Some(*level)).map(|(point, _)| *point);
            let name = whole.name.as_deref().map_or_else(|| level.to_string(), |name| format!("{name} {level}"));
            let shape = RawShape::Points(own.collect());
            RawSurface { vertical: whole.vertical.clone(), ..RawSurface::new(Some(name), shape) }
        };
        levels.iter().map(of).collect()
    }

    fn surface(self) -> RawSurface {
        let shape = if self.kind == ObjectKind::Surface {
            RawShape::Mesh(self.mesh)
        } else {
            let stick = |n: usize| (self.kind == ObjectKind::Lines).then(|| self.lines[n]);
            let point = |(n, at): (usize, &DVec3)| RawPoint {
                xy: Some(at.truncate()),
                z: at.z,
                stick: stick(n),
                ..RawPoint::default()
            };
            RawShape::Points(self.mesh.vertices.iter().enumerate().map(point).collect())
        };
        RawSurface { vertical: self.vertical, ..RawSurface::new(self.name, shape) }
    }

    /// The name in a `HEADER {` block or line: `name: F5`, `name:F5`, `HEADER { name: F5 }`.
    fn read_name(&mut self, text: &str) {
        let inside =
            text.trim_start_matches("HEADER").trim_matches(|c: char| c.is_whitespace() || c == '{' || c == '}');
        if let Some(name) = inside.strip_prefix("name:").or_else(|| inside.strip_prefix("name :")) {
            let name = name.trim().trim_matches('"').trim();
            if !name.is_empty() && self.name.is_none() {
                self.name = Some(name.to_string());
            }
        }
    }

    fn read_coordinates(&mut self, keyword: &str, rest: &str) {
        let third = text::fields(rest, None).get(2).map(|f| f.text.to_string());
        match keyword {
            "AXIS_NAME" => self.axis_name = third,
            "AXIS_UNIT" => {
                if let Some(word) = third
                    && let Some(unit) = ZUnit::parse(&word)
                {
                    let axis = self.axis_name.as_deref().map_or_else(String::new, |n| format!(" (axis {n})"));
                    self.vertical.unit = Some((unit, format!("AXIS_UNIT {word}{axis}")));
                }
            }
            "ZPOSITIVE" => {
                let positive = match rest.trim().to_ascii_lowercase().as_str() {
                    "depth" => Some(ZPositive::Down),
                    "elevation" => Some(ZPositive::Up),
                    _ => None,
                };
                self.vertical.positive = positive.map(|p| (p, format!("ZPOSITIVE {}", rest.trim())));
            }
            _ => {}
        }
    }

    fn read_vertex(&mut self, source: &SourceFile, line: Line<'_>, rest: &str) -> Result<(), FormatError> {
        let mut words = rest.split_whitespace();
        let id = words.next().and_then(|w| w.parse().ok());
        let mut coordinate = || words.next().and_then(number::plain).filter(|v| v.is_finite() && v.abs() < 1e12);
        let (Some(id), Some(x), Some(y), Some(z)) = (id, coordinate(), coordinate(), coordinate()) else {
            return Err(source.syntax(line.number, "VRTX id x y z", line.text));
        };
        let level = self.properties.iter().position(|name| column::of_name(name).column == Column::Level);
        let level = level.and_then(|at| words.nth(at)).and_then(number::plain);
        self.add(id, DVec3::new(x, y, z));
        self.levels.push(level.filter(|v| v.is_finite()));
        Ok(())
    }

    fn add(&mut self, id: u64, position: DVec3) {
        self.index.insert(id, self.mesh.vertices.len() as u32);
        self.mesh.vertices.push(position);
        self.lines.push(self.line);
        // Atoms have none of their own.
        self.levels.resize(self.lines.len() - 1, None);
    }

    fn read_triangle(&mut self, source: &SourceFile, line: Line<'_>, rest: &str) -> Result<(), FormatError> {
        let mut corners = [0; 3];
        let mut words = rest.split_whitespace();
        for corner in &mut corners {
            let id = words.next().and_then(|w| w.parse::<u64>().ok());
            let id = id.ok_or_else(|| source.syntax(line.number, "TRGL with three vertex ids", line.text))?;
            *corner = *self
                .index
                .get(&id)
                .ok_or_else(|| source.syntax(line.number, format!("a vertex with id {id} before this"), line.text))?;
        }
        self.mesh.triangles.push(corners);
        Ok(())
    }
}

fn read(source: &SourceFile, context: &ReadContext<'_>) -> Result<Vec<RawSurface>, FormatError> {
    let text = source.text();
    let mut surfaces = Vec::new();
    let mut object: Option<GocadObject> = None;
    let mut other = None;
    for line in text::lines(&text) {
        let (keyword, rest) = line.text.split_once(char::is_whitespace).unwrap_or((line.text, ""));
        if keyword == "GOCAD" {
            // A file may end an object with the next one instead of END.
            surfaces.extend(object.take().into_iter().flat_map(GocadObject::surfaces));
            if let Some(word) = rest.split_whitespace().next() {
                match ObjectKind::of(word) {
                    Some(kind) => object = Some(GocadObject { kind, ..GocadObject::default() }),
                    None => other = Some(word.to_string()),
                }
            }
            continue;
        }
        let Some(o) = &mut object else { continue };
        match keyword {
            "END" => surfaces.extend(object.take().into_iter().flat_map(GocadObject::surfaces)),
            "GOCAD_ORIGINAL_COORDINATE_SYSTEM" => o.in_coordinates = true,
            "END_ORIGINAL_COORDINATE_SYSTEM" => o.in_coordinates = false,
            _ if o.in_coordinates => o.read_coordinates(keyword, rest),
            "VRTX" | "PVRTX" => o.read_vertex(source, line, rest)?,
            "ATOM" | "PATOM" => {
                let mut ids = rest.split_whitespace().map(|w| w.parse::<u64>().ok());
                let (Some(Some(id)), Some(Some(of))) = (ids.next(), ids.next()) else {
                    return Err(source.syntax(line.number, "ATOM id and the id it refers to", line.text));
                };
                let vertex = o.index.get(&of).map(|&n| o.mesh.vertices[n as usize]);
                let vertex = vertex.ok_or_else(|| {
                    source.syntax(line.number, format!("a vertex with id {of} before this"), line.text)
                })?;
                o.add(id, vertex);
            }
            "PROPERTIES" => o.properties = rest.split_whitespace().map(str::to_owned).collect(),
            "ILINE" => o.line += 1.0,
            "TRGL" => o.read_triangle(source, line, rest)?,
            _ => o.read_name(line.text),
        }
    }
    surfaces.extend(object.take().into_iter().flat_map(GocadObject::surfaces));
    let empty = |why: String| source.empty(context.kind, why);
    if surfaces.is_empty() {
        return Err(empty(other.map_or_else(
            || "there is no GOCAD TSurf, VSet or PLine".into(),
            |kind| format!("it holds a GOCAD {kind}, not a TSurf, VSet or PLine"),
        )));
    }
    for surface in &surfaces {
        if matches!(&surface.shape, RawShape::Mesh(mesh) if mesh.triangles.is_empty()) {
            let name = surface.name.as_deref().unwrap_or("(no name)");
            return Err(empty(format!("the TSurf '{name}' has no triangles")));
        }
    }
    Ok(surfaces)
}

fn write_head(out: &mut dyn Write, name: &str, geometry: &SurveyGeometry) -> std::io::Result<()> {
    let unit = geometry.vertical.unit.symbol();
    let domain = Domain::of(geometry.vertical.unit);
    let axis = if domain == Domain::Time { "TWT" } else { "Z" };
    writeln!(out, "GOCAD TSurf 1\nHEADER {{\nname:{}\n}}", name.replace(['\n', '\r', '{', '}'], " "))?;
    writeln!(out, "GOCAD_ORIGINAL_COORDINATE_SYSTEM\nNAME Default\nAXIS_NAME \"X\" \"Y\" \"{axis}\"")?;
    writeln!(out, "AXIS_UNIT \"m\" \"m\" \"{unit}\"\nZPOSITIVE Depth\nEND_ORIGINAL_COORDINATE_SYSTEM")
}

fn write_face(out: &mut dyn Write, mesh: &TriangleMesh, first_id: usize) -> std::io::Result<usize> {
    writeln!(out, "TFACE")?;
    for (n, v) in mesh.vertices.iter().enumerate() {
        writeln!(out, "VRTX {} {:.4} {:.4} {:.6} CNXYZ", first_id + n, v.x, v.y, v.z)?;
    }
    for [a, b, c] in mesh.triangles.iter().map(|t| t.map(|v| v as usize + first_id)) {
        writeln!(out, "TRGL {a} {b} {c}")?;
    }
    Ok(first_id + mesh.vertices.len())
}

/// The triangles of a sheet: two for each complete cell, one where a corner is missing.
pub(super) fn mesh_of(sheet: &Sheet) -> TriangleMesh {
    let [nu, nv] = sheet.grid.count;
    let mut mesh = TriangleMesh::default();
    let mut vertex = vec![None; nu * nv];
    for (n, z) in sheet.depth.iter().enumerate().filter(|(_, z)| z.is_finite()) {
        vertex[n] = Some(mesh.vertices.len() as u32);
        let xy = sheet.grid.world_at(DVec2::new((n / nv) as f64, (n % nv) as f64));
        mesh.vertices.push(xy.extend(f64::from(*z)));
    }
    for u in 1..nu {
        for v in 1..nv {
            let corner = |du: usize, dv: usize| vertex[(u - du) * nv + v - dv];
            match [corner(1, 1), corner(0, 1), corner(0, 0), corner(1, 0)] {
                [Some(a), Some(b), Some(c), Some(d)] => mesh.triangles.extend([[a, b, c], [a, c, d]]),
                corners => {
                    if let [a, b, c] = *corners.into_iter().flatten().collect::<Vec<_>>() {
                        mesh.triangles.push([a, b, c]);
                    }
                }
            }
        }
    }
    mesh
}

fn write_horizon(out: &mut dyn Write, horizon: &Horizon, geometry: &SurveyGeometry) -> Result<(), WriteFailure> {
    if let Some(surface) = horizon.any_shape().filter(|surface| !surface.triangles.is_empty()) {
        write_head(out, &horizon.name, geometry)?;
        write_face(out, surface, 1)?;
        writeln!(out, "END")?;
        return Ok(());
    }
    let meshes: Vec<_> = horizon.sheets.iter().map(mesh_of).filter(|m| !m.triangles.is_empty()).collect();
    if meshes.is_empty() {
        return Err(WriteFailure::NotRepresentable(
            "no three neighbouring nodes have a depth".into(),
            "write csv, which holds single nodes",
        ));
    }
    write_head(out, &horizon.name, geometry)?;
    let mut id = 1;
    for mesh in &meshes {
        id = write_face(out, mesh, id)?;
    }
    writeln!(out, "END")?;
    Ok(())
}

fn write_fault(out: &mut dyn Write, fault: &Fault, geometry: &SurveyGeometry) -> Result<(), WriteFailure> {
    write_head(out, &fault.name, geometry)?;
    write_face(out, &fault.mesh, 1)?;
    writeln!(out, "END")?;
    Ok(())
}
