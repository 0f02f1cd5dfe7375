//! GeoPackages: lines and points of their layers with their properties ([`traces`]).
//!
//! A GeoPackage is a database of SQLite ([`sqlite`]). `gpkg_contents` names its layers, `gpkg_geometry_columns` the column of
//! the geometries of each and its coordinate system, and `gpkg_spatial_ref_sys` has these as well-known text. A geometry
//! has a head of its own (`GP`) and then well-known binary, of the kinds of ISO (1001 is a point with Z) or with the
//! flags of PostGIS.

use super::binary::{BinaryCursor, Endian, Word};
use super::crs::Crs;
use super::raw::{RawSurface, ReadContext};
use super::sqlite::{self, Cell, Database, Row, Table};
use super::text::SourceFile;
use super::traces::{self, Feature};
use super::{Codec, Format, FormatError};
use glam::DVec3;
use indexmap::IndexMap;
use serde_json::{Map, Value};
use std::collections::HashMap;
use std::path::Path;

pub(super) const CODEC: Codec = Codec {
    read_horizon: Some(read),
    read_fault: Some(read),
    ..Codec::of(Format::GeoPackage, "geopackage", "gpkg", detect)
};

/// The most geometries within geometries.
const MOST_NESTED: usize = 8;
/// Coordinate systems that every GeoPackage has: X and Y of an unknown place, and angles of an unknown ellipsoid.
const UNDEFINED_CARTESIAN: i64 = -1;
const UNDEFINED_GEOGRAPHIC: i64 = 0;

fn detect(source: &SourceFile) -> Option<String> {
    is_one(&source.path, &source.bytes).then(|| "it is a database of a GeoPackage".to_owned())
}

/// Whether the first bytes of a file are those of a GeoPackage; early ones have only its extension.
pub(super) fn is_one(path: &Path, bytes: &[u8]) -> bool {
    let application = bytes.get(68..72).unwrap_or_default();
    let is_named = path.extension().is_some_and(|extension| extension.eq_ignore_ascii_case("gpkg"));
    bytes.starts_with(sqlite::MAGIC) && (is_named || application == b"GPKG" || application.starts_with(b"GP1"))
}

fn read(source: &SourceFile, context: &ReadContext<'_>) -> Result<Vec<RawSurface>, FormatError> {
    let log = unread_log(source);
    let mut surfaces = read_layers(source, context).map_err(|error| match (error, &log) {
        (FormatError::Empty { file, kind, why }, Some(log)) => {
            FormatError::Empty { file, kind, why: format!("{why}; {log}") }
        }
        (error, _) => error,
    })?;
    surfaces.iter_mut().for_each(|surface| surface.notes.extend(log.clone()));
    Ok(surfaces)
}

/// What is to be said of changes that are not in the file yet.
fn unread_log(source: &SourceFile) -> Option<String> {
    let mut path = source.path.clone().into_os_string();
    path.push("-wal");
    let length = std::fs::metadata(&path).map_or(0, |log| log.len());
    (length > 0).then(|| {
        "a log of changes (-wal) is beside it, which is not read: close the program that has it open, or save it again"
            .to_owned()
    })
}

/// A layer: the table of its features, the column of their geometries, and the number of their coordinate system.
struct Layer {
    table: String,
    geometry: String,
    system: i64,
}

fn read_layers(source: &SourceFile, context: &ReadContext<'_>) -> Result<Vec<RawSurface>, FormatError> {
    let mut database = Database::open(source)?;
    let layers = layers(&mut database, source, context)?;
    let systems = coordinate_systems(&mut database)?;
    let mut groups: Vec<(Crs, Vec<Feature>)> = Vec::new();
    let mut notes = Vec::new();
    for layer in layers {
        let table = database.table(&layer.table);
        let Some((table, column)) = table.and_then(|table| table.column(&layer.geometry).map(|column| (table, column)))
        else {
            notes.push(format!("layer '{}' is left out: it is a view, or has no column of geometries", layer.table));
            continue;
        };
        let features = features(&mut database, source, &layer, &table, column)?;
        if layer.system == UNDEFINED_GEOGRAPHIC && !features.is_empty() {
            notes.push(format!(
                "the coordinate system of layer '{}' is undefined: its places are taken as X and Y",
                layer.table
            ));
        }
        let crs = match layer.system {
            UNDEFINED_CARTESIAN => Crs::Projected(None, "undefined Cartesian".to_owned()),
            // Programs state it where they know none: the places tell whether they can be angles.
            UNDEFINED_GEOGRAPHIC => Crs::Unknown,
            system => systems.get(&system).cloned().unwrap_or_default(),
        };
        match groups.iter_mut().find(|(other, _)| *other == crs) {
            Some((_, all)) => all.extend(features),
            None => groups.push((crs, features)),
        }
    }
    groups.retain(|(_, features)| features.iter().any(|feature| !feature.lines.is_empty()));
    let mut surfaces = Vec::new();
    let mut refused = None;
    for (crs, features) in groups {
        let names: Vec<Option<String>> = features.iter().map(Feature::name).collect();
        match traces::surfaces(source, features, &crs, context) {
            Ok(made) => surfaces.extend(made),
            Err(error) if names.iter().flatten().any(|name| context.asks_for(name)) => return Err(error),
            Err(error) => {
                notes.push(format!("some layers are left out: {}", traces::reason(&error)));
                refused.get_or_insert(error);
            }
        }
    }
    if surfaces.is_empty() {
        let none = || {
            notes.insert(0, "its layers hold no lines and no points".to_owned());
            source.empty(context.kind, notes.join("; "))
        };
        return Err(refused.unwrap_or_else(none));
    }
    surfaces.iter_mut().for_each(|surface| surface.notes.extend(notes.iter().cloned()));
    Ok(surfaces)
}

/// The layers of features, each table once.
fn layers(
    database: &mut Database<'_>,
    source: &SourceFile,
    context: &ReadContext<'_>,
) -> Result<Vec<Layer>, FormatError> {
    let (Some(contents), Some(geometries)) = (database.table("gpkg_contents"), database.table("gpkg_geometry_columns"))
    else {
        let why = "it has no tables gpkg_contents and gpkg_geometry_columns, and so no layers of lines and points";
        return Err(source.empty(context.kind, why));
    };
    let mut kinds: IndexMap<String, String> = IndexMap::new();
    let (name, kind) = (contents.column("table_name"), contents.column("data_type"));
    database.rows(&contents, &mut |row| {
        if let (Some(name), Some(kind)) = (row.at(name).text(), row.at(kind).text()) {
            kinds.insert(name.to_ascii_lowercase(), kind.to_ascii_lowercase());
        }
        Ok(())
    })?;
    let mut found: IndexMap<String, Layer> = IndexMap::new();
    let [name, column, system] = ["table_name", "column_name", "srs_id"].map(|name| geometries.column(name));
    database.rows(&geometries, &mut |row| {
        if let (Some(table), Some(geometry)) = (row.at(name).text(), row.at(column).text())
            && kinds.get(&table.to_ascii_lowercase()).is_some_and(|kind| kind == "features")
        {
            let system = row.at(system).integer().unwrap_or(UNDEFINED_GEOGRAPHIC);
            let layer = Layer { table: table.to_owned(), geometry: geometry.to_owned(), system };
            found.entry(table.to_ascii_lowercase()).or_insert(layer);
        }
        Ok(())
    })?;
    if found.is_empty() {
        let mut others: Vec<&str> = kinds.values().map(String::as_str).collect();
        others.sort_unstable();
        others.dedup();
        others.truncate(4);
        let others = if others.is_empty() { "nothing".to_owned() } else { others.join(", ") };
        return Err(source.empty(context.kind, format!("its layers are {others}, and none is of lines or points")));
    }
    Ok(found.into_values().collect())
}

/// The coordinate systems by their numbers.
fn coordinate_systems(database: &mut Database<'_>) -> Result<HashMap<i64, Crs>, FormatError> {
    let mut systems = HashMap::new();
    let Some(table) = database.table("gpkg_spatial_ref_sys") else { return Ok(systems) };
    let [number, first, second] = ["srs_id", "definition", "definition_12_063"].map(|name| table.column(name));
    database.rows(&table, &mut |row| {
        let crs = [first, second].map(|column| row.at(column).text().map(Crs::of_wkt)).into_iter().flatten();
        if let Some(number) = row.at(number).integer() {
            systems.insert(number, crs.into_iter().find(|crs| *crs != Crs::Unknown).unwrap_or_default());
        }
        Ok(())
    })?;
    Ok(systems)
}

fn features(
    database: &mut Database<'_>,
    source: &SourceFile,
    layer: &Layer,
    table: &Table,
    geometry: usize,
) -> Result<Vec<Feature>, FormatError> {
    // The number of a row, which is called fid or id, is no name.
    let is_told = |(n, name): &(usize, &String)| Some(*n) != table.key && traces::is_known(name);
    let columns: Vec<(usize, &String)> = table.columns.iter().enumerate().filter(is_told).collect();
    let mut found = Vec::new();
    database.rows(table, &mut |row| {
        let Cell::Blob(blob) = row.at(Some(geometry)) else { return Ok(()) };
        let lines = lines_of(source, blob)?;
        if !lines.is_empty() {
            let properties = columns.iter().map(|(n, name)| ((*name).clone(), value(row, *n))).collect::<Map<_, _>>();
            let mut feature = Feature { lines, properties };
            if feature.name().is_none() {
                feature.properties.insert("name".to_owned(), Value::from(layer.table.clone()));
            }
            found.push(feature);
        }
        Ok(())
    })?;
    Ok(found)
}

fn value(row: &Row<'_>, column: usize) -> Value {
    match row.at(Some(column)) {
        Cell::Integer(number) => Value::from(*number),
        Cell::Real(number) => Value::from(*number),
        Cell::Text(text) => Value::from(text.as_ref()),
        Cell::Null | Cell::Blob(_) => Value::Null,
    }
}

/// The lines of a geometry; points are lines of one corner.
fn lines_of(source: &SourceFile, blob: &[u8]) -> Result<Vec<Vec<DVec3>>, FormatError> {
    let mut rest = BinaryCursor::at(source, 0, Endian::Little);
    rest.rest = blob;
    let head = rest.take(8)?;
    let flags = head[3];
    if !head.starts_with(b"GP") || flags & 0x20 != 0 {
        return Err(source.damaged("a geometry is none of the kinds that the standard has (it begins with no GP)"));
    }
    let envelope = match (flags >> 1) & 7 {
        0 => 0,
        1 => 32,
        2 | 3 => 48,
        4 => 64,
        other => return Err(source.damaged(format!("a geometry has an envelope of kind {other}"))),
    };
    rest.take(envelope)?;
    let mut lines = Vec::new();
    if flags & 0x10 == 0 {
        gather(source, &mut rest, 0, &mut lines)?;
    }
    lines.retain(|line| traces::is_line(line));
    Ok(lines)
}

/// The lines of well-known binary.
fn gather(
    source: &SourceFile,
    rest: &mut BinaryCursor<'_>,
    depth: usize,
    lines: &mut Vec<Vec<DVec3>>,
) -> Result<(), FormatError> {
    rest.endian = if rest.take(1)?[0] == 0 { Endian::Big } else { Endian::Little };
    let code = rest.count(Word::U32)?;
    let (kind, thousands) = ((code & 0x0fff_ffff) % 1000, (code & 0x0fff_ffff) / 1000);
    if code & 0x2000_0000 != 0 {
        rest.take(4)?;
    }
    let has_z = code & 0x8000_0000 != 0 || matches!(thousands, 1 | 3);
    let has_m = code & 0x4000_0000 != 0 || matches!(thousands, 2 | 3);
    let line = |rest: &mut BinaryCursor<'_>, count: usize| {
        let numbers = 2 + usize::from(has_z) + usize::from(has_m);
        let values = Word::F64.values(rest.take(count.saturating_mul(8 * numbers))?, rest.endian);
        let corner = |c: &[f64]| DVec3::new(c[0], c[1], if has_z { c[2] } else { f64::NAN });
        Ok::<_, FormatError>(values.chunks_exact(numbers).map(corner).collect::<Vec<_>>())
    };
    match kind {
        _ if thousands > 3 || depth > MOST_NESTED => {
            return Err(source.damaged(format!("a geometry of code {code}, {depth} deep in others")));
        }
        1 => lines.push(line(rest, 1)?),
        2 => {
            let count = rest.count(Word::U32)?;
            lines.push(line(rest, count)?);
        }
        // Areas and triangles are their rings.
        3 | 17 => {
            for _ in 0..rest.count(Word::U32)? {
                let count = rest.count(Word::U32)?;
                lines.push(line(rest, count)?);
            }
        }
        4..=7 | 9..=12 | 15 | 16 => {
            for _ in 0..rest.count(Word::U32)? {
                gather(source, rest, depth + 1, lines)?;
            }
        }
        8 => return Err(source.damaged("it has arcs: make lines of them (ogr2ogr -nlt CONVERT_TO_LINEAR)")),
        other => {
            return Err(source.damaged(format!("a geometry of kind {other}, which is none of lines, points and areas")));
        }
    }
    Ok(())
}
