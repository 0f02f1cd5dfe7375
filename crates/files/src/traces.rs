//! Features of maps, lines and points with properties, as GeoJSON, shapefiles and GeoPackages hold them: traces of faults
//! with a dip, contacts, measurements of a dip.
//!
//! Features of one `name` (or `id`, `fault`, `formation` …) are one object. A line with heights is a stick. A line
//! without is the trace of a fault at sea level: with `dip` and `dip_dir` (or `azimuth`, or `strike`, a right angle
//! before) it becomes the surface that dips from there through the survey, and without them a vertical one, which is
//! said. Heights are those of the corners, or else of a property (`z`, `elevation`, `depth_m`). Lines and points of a
//! horizon with a dip and its direction have normals.

use super::column::{self, Column, NamedColumn};
use super::crs::Crs;
use super::number;
use super::raw::{RawPoint, RawShape, RawSurface, ReadContext, VerticalFacts};
use super::text::SourceFile;
use super::unit::ZPositive;
use super::{FormatError, SurfaceKind};
use glam::{DVec2, DVec3};
use indexmap::IndexMap;
use serde_json::{Map, Value};
use survey::geometry::SurveyGeometry;
use survey::mesh::TriangleMesh;

/// Properties that name a feature, the likeliest first.
const NAMES: [&str; 8] = ["name", "fault", "fault_name", "horizon", "formation", "surface", "id", "fid"];
/// Properties that tell how beds lie.
const DIPS: [&str; 2] = ["dip", "dip_angle"];
const DIRECTIONS: [&str; 5] = ["dip_dir", "dip_direction", "dipdir", "azimuth", "dip_azimuth"];
const STRIKE: &str = "strike";
const POLARITY: &str = "polarity";
/// Surfaces that are flatter than this are none that a trace tells.
const LEAST_DIP_DEG: f64 = 5.0;
/// Most corners of all lines.
const MOST_CORNERS: usize = 2_000_000;

/// A feature: its lines, of which points are those of one corner, and its properties.
#[derive(Debug, Default)]
pub(super) struct Feature {
    /// Corners; a height that is not there is NaN.
    pub lines: Vec<Vec<DVec3>>,
    pub properties: Map<String, Value>,
}

impl Feature {
    /// A property, whatever the case of its name.
    fn property(&self, key: &str) -> Option<&Value> {
        self.properties.iter().find(|(name, value)| name.eq_ignore_ascii_case(key) && !value.is_null()).map(|(_, v)| v)
    }

    pub(super) fn name(&self) -> Option<String> {
        NAMES.iter().filter_map(|key| self.property(key)).find_map(|value| match value {
            Value::String(text) => Some(text.trim().to_owned()).filter(|text| !text.is_empty()),
            Value::Number(number) => Some(number.to_string()),
            _ => None,
        })
    }

    fn number(&self, keys: &[&str]) -> Option<f64> {
        keys.iter().find_map(|key| self.property(key)).and_then(number_in)
    }

    fn attitude(&self) -> Attitude {
        Attitude {
            dip_deg: self.number(&DIPS),
            azimuth_deg: self.number(&DIRECTIONS).or_else(|| self.number(&[STRIKE]).map(|strike| strike + 90.0)),
            polarity: self.number(&[POLARITY]),
        }
    }

    /// A height among the properties, and what its name says.
    fn height(&self) -> Option<(f64, &str, NamedColumn)> {
        self.properties.iter().find_map(|(name, value)| {
            let named = column::of_name(name);
            let value = number_in(value).filter(|_| named.column == Column::Z)?;
            Some((value, name.as_str(), named))
        })
    }
}

/// Whether a property of that name is looked at.
pub(super) fn is_known(name: &str) -> bool {
    let mut known = NAMES.into_iter().chain(DIPS).chain(DIRECTIONS).chain([STRIKE, POLARITY]);
    known.any(|known| known.eq_ignore_ascii_case(name)) || column::of_name(name).column == Column::Z
}

/// Whether all corners have places, and there are any.
pub(super) fn is_line(line: &[DVec3]) -> bool {
    !line.is_empty() && line.iter().all(|p| p.truncate().is_finite() && p.truncate().abs().max_element() < 1e12)
}

/// What a note says of features that are left out.
pub(super) fn reason(error: &FormatError) -> String {
    match error {
        FormatError::Empty { why, .. } => why.clone(),
        other => other.to_string(),
    }
}

/// A number, which some programs write as a text.
fn number_in(value: &Value) -> Option<f64> {
    match value {
        Value::String(text) => number::of(text).filter(|number| number.is_finite()),
        other => other.as_f64(),
    }
}

/// How beds or a fault lie.
#[derive(Debug, Clone, Copy, Default)]
struct Attitude {
    dip_deg: Option<f64>,
    azimuth_deg: Option<f64>,
    polarity: Option<f64>,
}

/// Lines of one name, each with the attitude of its feature.
#[derive(Default)]
struct NamedLines {
    lines: Vec<(Vec<DVec3>, Attitude)>,
    vertical: VerticalFacts,
    notes: Vec<String>,
}

impl NamedLines {
    fn add(&mut self, feature: Feature) {
        let attitude = feature.attitude();
        let is_flat = feature.lines.iter().flatten().all(|corner| corner.z.is_nan());
        let height = feature.height().filter(|_| is_flat).map(|(height, name, named)| {
            let words = || format!("property {name}");
            self.vertical.unit = named.unit.map(|unit| (unit, words()));
            self.vertical.domain = named.domain.map(|domain| (domain, words()));
            self.vertical.positive = named.positive.map(|positive| (positive, words()));
            let note = format!("heights are those of the property {name}");
            if !self.notes.contains(&note) {
                self.notes.push(note);
            }
            height
        });
        for mut line in feature.lines {
            if let Some(height) = height {
                line.iter_mut().for_each(|corner| corner.z = height);
            }
            self.lines.push((line, attitude));
        }
    }
}

/// The surfaces of features, one for each name.
pub(super) fn surfaces(
    source: &SourceFile,
    features: Vec<Feature>,
    crs: &Crs,
    context: &ReadContext<'_>,
) -> Result<Vec<RawSurface>, FormatError> {
    crs.refuse_degrees(source, context.kind)?;
    let mut found: IndexMap<Option<String>, NamedLines> = IndexMap::new();
    let mut corners = 0;
    let mut all_small = true;
    for feature in features.into_iter().filter(|feature| !feature.lines.is_empty()) {
        corners += feature.lines.iter().map(Vec::len).sum::<usize>();
        if corners > MOST_CORNERS {
            return Err(source.empty(context.kind, format!("it has more than {MOST_CORNERS} corners")));
        }
        all_small &= feature.lines.iter().flatten().all(|p| p.x.abs() <= 360.0 && p.y.abs() <= 90.0);
        found.entry(feature.name()).or_default().add(feature);
    }
    if found.is_empty() {
        return Err(source.empty(context.kind, "its features hold no lines and no points"));
    }
    if all_small && *crs == Crs::Unknown {
        return Err(source.degrees(context.kind, "none is beyond 360 and 90"));
    }
    let mut surfaces = Vec::with_capacity(found.len());
    let (mut left_out, mut refused) = (Vec::new(), None);
    for (name, lines) in found {
        match surface(source, name.clone(), &lines, context) {
            Ok(mut made) => {
                crs.state(&mut made);
                surfaces.push(made);
            }
            Err(error) if name.as_deref().is_some_and(|name| context.asks_for(name)) => return Err(error),
            Err(error) => {
                let name = name.map_or_else(|| "what has no name".to_owned(), |name| format!("'{name}'"));
                left_out.push(format!("{name} is left out: {}", reason(&error)));
                refused.get_or_insert(error);
            }
        }
    }
    // A map has layers of several kinds: what is no horizon, or no fault, does not stand in the way of what is.
    match refused.filter(|_| surfaces.is_empty()) {
        Some(error) => Err(error),
        None => {
            left_out.truncate(4);
            surfaces.iter_mut().for_each(|surface| surface.notes.extend(left_out.iter().cloned()));
            Ok(surfaces)
        }
    }
}

fn surface(
    source: &SourceFile,
    name: Option<String>,
    found: &NamedLines,
    context: &ReadContext<'_>,
) -> Result<RawSurface, FormatError> {
    let heights = || found.lines.iter().flat_map(|(line, _)| line).map(|corner| corner.z);
    // Programs write zeros where they have no heights.
    let is_trace = heights().all(|z| z.is_nan() || z == 0.0);
    match (context.kind, context.geometry) {
        (SurfaceKind::Fault, Some(geometry)) if is_trace => return traced(source, name, found, geometry),
        (SurfaceKind::Horizon, _) if heights().all(f64::is_nan) => {
            return Err(source.empty(context.kind, "its lines and points have no heights"));
        }
        _ => {}
    }
    let is_line = found.lines.iter().any(|(line, _)| line.len() > 1);
    let corners = found.lines.iter().enumerate().flat_map(|(n, (line, beds))| line.iter().map(move |p| (n, p, beds)));
    let point = |(n, p, beds): (usize, &DVec3, &Attitude)| RawPoint {
        xy: Some(p.truncate()),
        z: p.z,
        stick: is_line.then_some(n as f64),
        dip: beds.dip_deg.zip(beds.azimuth_deg).map(|(dip, azimuth)| [dip, azimuth, beds.polarity.unwrap_or(1.0)]),
        ..RawPoint::default()
    };
    let shape = RawShape::Points(corners.map(point).collect());
    let (vertical, notes) = (found.vertical.clone(), found.notes.clone());
    Ok(RawSurface { vertical, notes, ..RawSurface::new(name, shape) })
}

/// The surface that dips from traces at sea level through the survey.
fn traced(
    source: &SourceFile,
    name: Option<String>,
    found: &NamedLines,
    geometry: &SurveyGeometry,
) -> Result<RawSurface, FormatError> {
    let axis = &geometry.vertical;
    let metres = geometry.metres_per_vertical_unit();
    let mut mesh = TriangleMesh::default();
    let mut notes: Vec<String> = Vec::new();
    for (line, beds) in found.lines.iter().filter(|(line, _)| line.len() > 1) {
        let dip = beds.dip_deg.filter(|dip| (LEAST_DIP_DEG..=90.0).contains(dip));
        let (slope, note) = match (dip, beds.azimuth_deg) {
            (Some(dip), Some(azimuth)) => {
                let (sin, cos) = azimuth.to_radians().sin_cos();
                let out = if dip < 90.0 { 1.0 / dip.to_radians().tan() } else { 0.0 };
                let note = format!("a trace at sea level that dips by {dip} degrees towards {azimuth}");
                (DVec2::new(sin, cos) * out, note)
            }
            _ => (DVec2::ZERO, "a trace at sea level without a dip and its direction: taken as vertical".to_owned()),
        };
        if !notes.contains(&note) && notes.len() < 4 {
            notes.push(note);
        }
        let first = mesh.vertices.len() as u32;
        for p in line {
            for z in [axis.first, axis.last()] {
                mesh.vertices.push((p.truncate() + slope * z * metres).extend(z));
            }
        }
        for n in 0..line.len() as u32 - 1 {
            let [a, b, c, d] = [0, 1, 2, 3].map(|k| first + 2 * n + k);
            mesh.triangles.extend([[a, b, c], [c, b, d]]);
        }
    }
    if mesh.triangles.is_empty() {
        return Err(source.empty(SurfaceKind::Fault, "its points have no heights, and there are no lines"));
    }
    let mut made = RawSurface { notes, ..RawSurface::new(name, RawShape::Mesh(mesh)) };
    made.vertical.positive = Some((ZPositive::Down, "made of its trace".to_owned()));
    Ok(made)
}
