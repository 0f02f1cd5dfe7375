//! Shapefiles: lines and points of the `.shp` with their properties of the `.dbf` beside it ([`traces`]).
//!
//! The `.shp` has 100 bytes of header and then records: a number and a length in 2-byte words, big-endian, and a shape,
//! little-endian, whose kind tells whether it has Z (1z) or measures (2z). The `.dbf` has a table of columns and rows of
//! text. The `.prj` names the coordinate system: degrees are refused, feet converted.

use super::binary::{BinaryCursor, Endian, Word};
use super::crs::Crs;
use super::raw::{RawSurface, ReadContext};
use super::text::SourceFile;
use super::traces::{self, Feature};
use super::{Codec, Format, FormatError};
use crate::number;
use glam::DVec3;
use serde_json::{Map, Value};

pub(super) const CODEC: Codec = Codec {
    read_horizon: Some(read),
    read_fault: Some(read),
    ..Codec::of(Format::Shapefile, "shapefile", "shp", detect)
};

/// Where records begin.
const FIRST_RECORD: usize = 100;
/// Values below mean that there is none.
const NO_DATA: f64 = -1e38;

fn detect(source: &SourceFile) -> Option<String> {
    source.bytes.starts_with(&[0, 0, 0x27, 0x0a]).then(|| "it begins as a shapefile".to_owned())
}

fn read(source: &SourceFile, context: &ReadContext<'_>) -> Result<Vec<RawSurface>, FormatError> {
    let crs = beside(source, "prj").map_or(Crs::Unknown, |prj| Crs::of_wkt(&prj.text()));
    let table = beside(source, "dbf");
    let table = table.as_ref().map(DbfTable::parse).transpose()?;
    let mut rest = BinaryCursor::at(source, FIRST_RECORD, Endian::Big);
    let mut features = Vec::new();
    for n in 0.. {
        if rest.rest.is_empty() {
            break;
        }
        rest.take(4)?;
        let length = rest.count(Word::U32)?.saturating_mul(2);
        let start = source.bytes.len() - rest.rest.len();
        rest.take(length)?;
        let lines = shape(source, &mut BinaryCursor::at(source, start, Endian::Little), length)?;
        if !lines.is_empty() {
            let properties = table.as_ref().map(|table| table.row(n)).unwrap_or_default();
            features.push(Feature { lines, properties });
        }
    }
    let mut surfaces = traces::surfaces(source, features, &crs, context)?;
    if table.is_none() {
        let note = "there is no .dbf of properties beside it: names and dips are not known".to_owned();
        surfaces.iter_mut().for_each(|surface| surface.notes.push(note.clone()));
    }
    Ok(surfaces)
}

/// The file of the same name with another extension, in either case.
fn beside(source: &SourceFile, extension: &str) -> Option<SourceFile> {
    let upper = extension.to_ascii_uppercase();
    [extension, &upper].into_iter().find_map(|extension| SourceFile::open(&source.path.with_extension(extension)).ok())
}

/// The lines of a record; points are lines of one corner.
fn shape(source: &SourceFile, rest: &mut BinaryCursor<'_>, length: usize) -> Result<Vec<Vec<DVec3>>, FormatError> {
    let kind = rest.count(Word::I32)?;
    let has_z = (11..=18).contains(&kind) || kind == 31;
    let (parts, count) = match kind % 10 {
        0 => return Ok(Vec::new()),
        1 if kind != 31 => {
            let [x, y] = rest.numbers(Word::F64)?;
            let z = if has_z { rest.number(Word::F64)? } else { f64::NAN };
            return Ok(vec![vec![corner(x, y, z)]].into_iter().filter(|line| traces::is_line(line)).collect());
        }
        // Patches of triangles have a kind for each part.
        1 | 3 | 5 => {
            rest.take(32)?;
            let (parts, count) = (rest.count(Word::U32)?, rest.count(Word::U32)?);
            let starts = Word::U32.values(rest.take(parts.saturating_mul(4))?, Endian::Little);
            rest.take(if kind == 31 { parts.saturating_mul(4) } else { 0 })?;
            (starts.into_iter().map(|start| start as usize).collect(), count)
        }
        8 => {
            rest.take(32)?;
            let count = rest.count(Word::U32)?;
            // More points than the record has bytes are refused before they are counted.
            ((0..count.min(length)).collect::<Vec<usize>>(), count)
        }
        _ => return Err(source.bad_grid(format!("a shape of kind {kind}, which is none of lines, points and areas"))),
    };
    if !parts.is_sorted() {
        return Err(source.bad_grid("the parts of a shape do not follow one another"));
    }
    let xy = Word::F64.values(rest.take(count.saturating_mul(16))?, Endian::Little);
    let heights = match has_z {
        true => {
            rest.take(16)?;
            Word::F64.values(rest.take(count.saturating_mul(8))?, Endian::Little)
        }
        false => vec![f64::NAN; xy.len() / 2],
    };
    let pairs = xy.as_chunks::<2>().0.iter().zip(&heights);
    let corners: Vec<DVec3> = pairs.map(|([x, y], z)| corner(*x, *y, *z)).collect();
    let ends = parts.iter().skip(1).copied().chain([count]);
    let line = |(start, end): (&usize, usize)| corners.get(*start..end).unwrap_or_default().to_vec();
    Ok(parts.iter().zip(ends).map(line).filter(|line| traces::is_line(line)).collect())
}

fn corner(x: f64, y: f64, z: f64) -> DVec3 {
    DVec3::new(x, y, if z > NO_DATA { z } else { f64::NAN })
}

/// The columns of a `.dbf` that say something of a feature, and its rows.
struct DbfTable<'a> {
    columns: Vec<DbfColumn>,
    width: usize,
    rows: &'a [u8],
}

struct DbfColumn {
    name: String,
    kind: u8,
    place: std::ops::Range<usize>,
}

impl<'a> DbfTable<'a> {
    fn parse(source: &'a SourceFile) -> Result<Self, FormatError> {
        let mut head = BinaryCursor::at(source, 4, Endian::Little);
        let count = head.count(Word::U32)?;
        let (first, width) = (head.count(Word::U16)?, head.count(Word::U16)?);
        let table = source.bytes.get(32..first).unwrap_or_default();
        // The first byte of a row tells whether it is deleted.
        let (mut columns, mut at) = (Vec::new(), 1);
        for field in table.as_chunks::<32>().0.iter().take_while(|field| field[0] != 0x0d) {
            let name = field[..11].split(|byte| *byte == 0).next().unwrap_or_default();
            let place = at..at + usize::from(field[16]);
            at = place.end;
            columns.push(DbfColumn { name: String::from_utf8_lossy(name).trim().to_owned(), kind: field[11], place });
        }
        let rows = source.bytes.get(first..).unwrap_or_default();
        if at > width || rows.len() / width < count {
            return Err(source.length("rows of its table", count, rows.len() / width.max(1)));
        }
        columns.retain(|column| !column.place.is_empty() && traces::is_known(&column.name));
        Ok(Self { columns, width, rows })
    }

    fn row(&self, n: usize) -> Map<String, Value> {
        let row = self.rows.chunks_exact(self.width).nth(n).unwrap_or_default();
        let cell = |column: &DbfColumn| Some((column.name.clone(), value(column.kind, row.get(column.place.clone())?)));
        self.columns.iter().filter_map(cell).collect()
    }
}

/// A cell by the kind of its column.
fn value(kind: u8, cell: &[u8]) -> Value {
    let text = String::from_utf8_lossy(cell);
    let text = text.trim_matches(['\0', ' ']);
    let number = match kind {
        b'N' | b'F' => number::plain(text),
        b'I' | b'+' => Word::I32.values(cell, Endian::Little).first().copied(),
        b'O' | b'B' if cell.len() == 8 => Word::F64.values(cell, Endian::Little).first().copied(),
        _ => return if text.is_empty() { Value::Null } else { Value::from(text) },
    };
    match number.filter(|number| number.is_finite() && *number > NO_DATA) {
        Some(whole) if whole.fract() == 0.0 && whole.abs() < 1e15 => Value::from(whole as i64),
        Some(number) => Value::from(number),
        None => Value::Null,
    }
}
