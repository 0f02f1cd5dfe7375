//! GeoJSON: lines and points with their properties ([`traces`]).

use super::crs::Crs;
use super::raw::{RawSurface, ReadContext};
use super::text::SourceFile;
use super::traces::{self, Feature};
use super::{Codec, Format, FormatError};
use glam::DVec3;
use serde_json::Value;

pub(super) const CODEC: Codec = Codec {
    read_horizon: Some(read),
    read_fault: Some(read),
    ..Codec::of(Format::GeoJson, "geojson", "geojson", detect)
};

fn detect(source: &SourceFile) -> Option<String> {
    let start = String::from_utf8_lossy(&source.bytes[..source.bytes.len().min(2000)]).into_owned();
    let kinds =
        ["\"FeatureCollection\"", "\"Feature\"", "\"GeometryCollection\"", "\"LineString\"", "\"MultiLineString\""];
    let is_json = start.trim_start_matches(['\u{feff}', ' ', '\n', '\r', '\t']).starts_with('{');
    kinds.into_iter().find(|kind| is_json && start.contains(kind)).map(|kind| format!("it is JSON with {kind}"))
}

fn read(source: &SourceFile, context: &ReadContext<'_>) -> Result<Vec<RawSurface>, FormatError> {
    let text = source.text();
    let mut json: Value = serde_json::from_str(text.trim_start_matches('\u{feff}'))
        .map_err(|error| source.syntax(error.line(), "JSON", &error.to_string()))?;
    let features = match json.get_mut("features").map(Value::take) {
        Some(Value::Array(features)) => features,
        _ => vec![json],
    };
    let feature = |mut feature: Value| {
        let properties = match feature.get_mut("properties").map(Value::take) {
            Some(Value::Object(properties)) => properties,
            _ => serde_json::Map::new(),
        };
        let mut lines = Vec::new();
        gather(feature.get("geometry").unwrap_or(&feature), &mut lines);
        Feature { lines, properties }
    };
    traces::surfaces(source, features.into_iter().map(feature).collect(), &Crs::Unknown, context)
}

/// The lines of a geometry; points are lines of one corner.
fn gather(geometry: &Value, lines: &mut Vec<Vec<DVec3>>) {
    if let Some(parts) = geometry.get("geometries").and_then(Value::as_array) {
        parts.iter().for_each(|part| gather(part, lines));
    }
    if let Some(coordinates) = geometry.get("coordinates") {
        into_lines(coordinates, lines);
    }
}

fn corner(value: &Value) -> Option<DVec3> {
    let numbers = value.as_array()?;
    let number = |n: usize| numbers.get(n).and_then(Value::as_f64).filter(|v| v.is_finite() && v.abs() < 1e12);
    Some(DVec3::new(number(0)?, number(1)?, number(2).unwrap_or(f64::NAN)))
}

fn into_lines(value: &Value, lines: &mut Vec<Vec<DVec3>>) {
    let Some(parts) = value.as_array() else { return };
    if let Some(point) = corner(value) {
        lines.push(vec![point]);
    } else if parts.iter().all(|part| corner(part).is_some()) && !parts.is_empty() {
        lines.push(parts.iter().filter_map(corner).collect());
    } else {
        parts.iter().for_each(|part| into_lines(part, lines));
    }
}
