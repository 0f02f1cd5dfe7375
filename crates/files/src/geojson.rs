//! GeoJSON: lines and points with their properties: traces of faults with a dip, contacts.
//!
//! Features of one `name` (or `id`, `fault`, `formation` …) are one object. A line with heights is a stick. A line without
//! is the trace of a fault at sea level: with `dip` and `dip_dir` (or `azimuth`) it becomes the surface that dips from
//! there through the survey, and without them a vertical one, which is said.

use super::raw::{RawPoint, RawShape, RawSurface, ReadContext};
use super::text::SourceFile;
use super::unit::ZPositive;
use super::{Codec, Format, FormatError, SurfaceKind};
use glam::{DVec2, DVec3};
use indexmap::IndexMap;
use serde_json::Value;
use survey::geometry::SurveyGeometry;
use survey::mesh::TriangleMesh;

pub(super) const CODEC: Codec = Codec {
    read_horizon: Some(read),
    read_fault: Some(read),
    ..Codec::of(Format::GeoJson, "geojson", "geojson", detect)
};

/// Properties that name a feature, the likeliest first.
const NAMES: [&str; 8] = ["name", "fault", "fault_name", "horizon", "formation", "surface", "id", "fid"];
/// Surfaces that are flatter than this are none that a trace tells.
const LEAST_DIP_DEG: f64 = 5.0;
/// Most corners of all lines.
const MOST_CORNERS: usize = 2_000_000;

fn detect(source: &SourceFile) -> Option<String> {
    let start = String::from_utf8_lossy(&source.bytes[..source.bytes.len().min(2000)]).into_owned();
    let kinds =
        ["\"FeatureCollection\"", "\"Feature\"", "\"GeometryCollection\"", "\"LineString\"", "\"MultiLineString\""];
    let is_json = start.trim_start_matches(['\u{feff}', ' ', '\n', '\r', '\t']).starts_with('{');
    kinds.into_iter().find(|kind| is_json && start.contains(kind)).map(|kind| format!("it is JSON with {kind}"))
}

/// The features of one name.
#[derive(Default)]
struct Features {
    lines: Vec<Vec<DVec3>>,
    dip_deg: Option<f64>,
    azimuth_deg: Option<f64>,
}

fn read(source: &SourceFile, context: &ReadContext<'_>) -> Result<Vec<RawSurface>, FormatError> {
    let text = source.text();
    let json: Value = serde_json::from_str(text.trim_start_matches('\u{feff}'))
        .map_err(|error| source.syntax(error.line(), "JSON", &error.to_string()))?;
    let mut found: IndexMap<Option<String>, Features> = IndexMap::new();
    let mut corners = 0;
    let alone = [json.clone()];
    let features = json.get("features").and_then(Value::as_array).map_or(&alone[..], Vec::as_slice);
    for feature in features {
        let properties = feature.get("properties").unwrap_or(&Value::Null);
        let named = NAMES.iter().find_map(|key| property(properties, key));
        let own = found.entry(named.and_then(word)).or_default();
        let number = |keys: &[&str]| keys.iter().find_map(|key| property(properties, key)).and_then(Value::as_f64);
        own.dip_deg = own.dip_deg.or(number(&["dip", "dip_angle"]));
        own.azimuth_deg = own.azimuth_deg.or(number(&["dip_dir", "dip_direction", "dipdir", "azimuth", "dip_azimuth"]));
        own.azimuth_deg = own.azimuth_deg.or(number(&["strike"]).map(|strike| strike + 90.0));
        gather(feature.get("geometry").unwrap_or(feature), &mut own.lines, &mut corners);
        if corners > MOST_CORNERS {
            return Err(source.empty(context.kind, format!("it has more than {MOST_CORNERS} corners")));
        }
    }
    found.retain(|_, features| !features.lines.is_empty());
    if found.is_empty() {
        return Err(source.empty(context.kind, "its features hold no lines and no points"));
    }
    let all = || found.values().flat_map(|features| &features.lines).flatten();
    if all().all(|p| p.x.abs() <= 360.0 && p.y.abs() <= 90.0) {
        let why = "its coordinates are degrees: project them to the survey's coordinate system".to_owned();
        return Err(source.empty(context.kind, why));
    }
    found.into_iter().map(|(name, features)| surface(source, name, &features, context)).collect()
}

/// A property, whatever the case of its name.
fn property<'a>(properties: &'a Value, key: &str) -> Option<&'a Value> {
    let own = properties.as_object()?;
    own.iter().find(|(name, value)| name.eq_ignore_ascii_case(key) && !value.is_null()).map(|(_, value)| value)
}

fn word(value: &Value) -> Option<String> {
    match value {
        Value::String(text) => Some(text.clone()).filter(|text| !text.trim().is_empty()),
        Value::Number(number) => Some(number.to_string()),
        _ => None,
    }
}

/// The lines of a geometry; points are lines of one corner.
fn gather(geometry: &Value, lines: &mut Vec<Vec<DVec3>>, corners: &mut usize) {
    if let Some(parts) = geometry.get("geometries").and_then(Value::as_array) {
        parts.iter().for_each(|part| gather(part, lines, corners));
    }
    if let Some(coordinates) = geometry.get("coordinates") {
        into_lines(coordinates, lines, corners);
    }
}

fn corner(value: &Value) -> Option<DVec3> {
    let numbers = value.as_array()?;
    let number = |n: usize| numbers.get(n).and_then(Value::as_f64).filter(|v| v.is_finite() && v.abs() < 1e12);
    Some(DVec3::new(number(0)?, number(1)?, number(2).unwrap_or(f64::NAN)))
}

fn into_lines(value: &Value, lines: &mut Vec<Vec<DVec3>>, corners: &mut usize) {
    let Some(parts) = value.as_array() else { return };
    if let Some(point) = corner(value) {
        *corners += 1;
        lines.push(vec![point]);
    } else if parts.iter().all(|part| corner(part).is_some()) && !parts.is_empty() {
        *corners += parts.len();
        lines.push(parts.iter().filter_map(corner).collect());
    } else {
        parts.iter().for_each(|part| into_lines(part, lines, corners));
    }
}

fn surface(
    source: &SourceFile,
    name: Option<String>,
    features: &Features,
    context: &ReadContext<'_>,
) -> Result<RawSurface, FormatError> {
    let has_heights = features.lines.iter().flatten().all(|p| p.z.is_finite());
    if has_heights || context.kind == SurfaceKind::Horizon || context.geometry.is_none() {
        if context.kind == SurfaceKind::Horizon && !has_heights {
            return Err(source.empty(context.kind, "its lines and points have no heights"));
        }
        let is_line = features.lines.iter().any(|line| line.len() > 1);
        let lines = features.lines.iter().enumerate().flat_map(|(n, line)| line.iter().map(move |p| (n, p)));
        let point = |(n, p): (usize, &DVec3)| RawPoint {
            xy: Some(p.truncate()),
            z: p.z,
            stick: is_line.then_some(n as f64),
            ..RawPoint::default()
        };
        return Ok(RawSurface::new(name, RawShape::Points(lines.map(point).collect())));
    }
    let Some(geometry) = context.geometry else { return Err(source.empty(context.kind, "there is no survey")) };
    let (mesh, note) = dipping(features, geometry);
    let mut found = RawSurface::new(name, RawShape::Mesh(mesh));
    found.vertical.positive = Some((ZPositive::Down, "made of its trace".to_owned()));
    found.notes.push(note);
    Ok(found)
}

/// The surface that dips from traces at sea level through the survey.
fn dipping(features: &Features, geometry: &SurveyGeometry) -> (TriangleMesh, String) {
    let axis = &geometry.vertical;
    let dip = features.dip_deg.filter(|dip| (LEAST_DIP_DEG..=90.0).contains(dip));
    let (slope, note) = match (dip, features.azimuth_deg) {
        (Some(dip), Some(azimuth)) => {
            let (sin, cos) = azimuth.to_radians().sin_cos();
            let out = if dip < 90.0 { 1.0 / dip.to_radians().tan() } else { 0.0 };
            (DVec2::new(sin, cos) * out, format!("a trace at sea level that dips by {dip} degrees towards {azimuth}"))
        }
        _ => (DVec2::ZERO, "a trace at sea level without a dip and its direction: taken as vertical".to_owned()),
    };
    let metres = geometry.metres_per_vertical_unit();
    let mut mesh = TriangleMesh::default();
    for line in features.lines.iter().filter(|line| line.len() > 1) {
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
    (mesh, note)
}
