//! NetCDF of the classic kind (`CDF` 1, 2 and 5): grids as GMT, GDAL and xarray write them.
//!
//! A header lists dimensions, attributes and variables; numbers are big-endian, names and values are filled up to 4
//! bytes. Every variable over two dimensions (further ones may have one value) that has coordinates is a horizon.
//! Coordinates are those of variables with the names of the dimensions; in the old format of GMT they are `x_range`,
//! `y_range`, `spacing` and `dimension`, with `z` in rows from the north. `scale_factor`, `add_offset`, `_FillValue`,
//! `missing_value`, `units` and `positive` of a variable are followed. Degrees are refused.
//!
//! # Memory
//! The file, and twice 8 bytes for each value.

use super::binary::{BinaryCursor, Endian, Word};
use super::grid::{Scan, even_steps};
use super::number;
use super::raw::{RawSurface, ReadContext};
use super::text::SourceFile;
use super::unit::{ZPositive, ZUnit};
use super::{Codec, Format, FormatError};
use glam::DVec2;

pub(super) const CODEC: Codec = Codec { read_horizon: Some(read), ..Codec::of(Format::NetCdf, "netcdf", "nc", detect) };

/// Marks of the lists of a header.
const DIMENSIONS: usize = 0x0A;
const VARIABLES: usize = 0x0B;
const ATTRIBUTES: usize = 0x0C;

fn detect(source: &SourceFile) -> Option<String> {
    let is_classic = matches!(source.bytes.get(..4), Some([b'C', b'D', b'F', 1 | 2 | 5]));
    is_classic.then(|| "it begins as a classic NetCDF file".to_owned())
}

/// An attribute: a text or numbers.
struct Attribute {
    name: String,
    text: String,
    numbers: Vec<f64>,
}

/// A variable as the header declares it.
struct Variable {
    name: String,
    /// Indices of its dimensions, the slowest first.
    dimensions: Vec<usize>,
    attributes: Vec<Attribute>,
    /// `None`: characters.
    word: Option<Word>,
    begin: usize,
}

impl Variable {
    fn attribute(&self, name: &str) -> Option<&Attribute> {
        self.attributes.iter().find(|attribute| attribute.name == name)
    }

    fn number(&self, name: &str) -> Option<f64> {
        self.attribute(name)?.numbers.first().copied()
    }

    fn text(&self, name: &str) -> Option<&str> {
        self.attribute(name).map(|attribute| attribute.text.trim()).filter(|text| !text.is_empty())
    }
}

/// The header of a file.
struct CdfHeader<'a> {
    source: &'a SourceFile,
    /// Name and length; that of records is 0 there.
    dimensions: Vec<(String, usize)>,
    records: usize,
    attributes: Vec<Attribute>,
    variables: Vec<Variable>,
}

/// The types of numbers by their codes; 2 are characters.
fn word_of(code: usize) -> Option<Option<Word>> {
    let words =
        [Word::I8, Word::I16, Word::I32, Word::F32, Word::F64, Word::U8, Word::U16, Word::U32, Word::I64, Word::U64];
    match code {
        1 => Some(Some(Word::I8)),
        2 => Some(None),
        3..=11 => words.get(code - 2).copied().map(Some),
        _ => None,
    }
}

/// Reads the header from its fifth byte on.
struct HeaderReader<'a> {
    source: &'a SourceFile,
    rest: BinaryCursor<'a>,
    /// The type of counts, and that of places in the file.
    count: Word,
    offset: Word,
}

impl<'a> HeaderReader<'a> {
    fn count(&mut self) -> Result<usize, FormatError> {
        self.rest.count(self.count)
    }

    fn filled(&mut self, bytes: usize) -> Result<&'a [u8], FormatError> {
        let taken = self.rest.take(bytes)?;
        // The last value may end with the file.
        let fill = bytes.next_multiple_of(4) - bytes;
        self.rest.take(fill.min(self.rest.rest.len()))?;
        Ok(taken)
    }

    fn name(&mut self) -> Result<String, FormatError> {
        let length = self.count()?;
        Ok(String::from_utf8_lossy(self.filled(length)?).into_owned())
    }

    /// The entries of a list, which may be absent.
    fn list<T>(
        &mut self,
        mark: usize,
        mut entry: impl FnMut(&mut Self) -> Result<T, FormatError>,
    ) -> Result<Vec<T>, FormatError> {
        let found = self.rest.count(Word::U32)?;
        let count = self.count()?;
        if found != mark && (found != 0 || count != 0) {
            return Err(self.source.bad_grid(format!("its header has the mark {found} where {mark} should stand")));
        }
        // Each entry takes bytes, so that a count that lies ends with the file.
        let mut entries = Vec::new();
        for _ in 0..count {
            entries.push(entry(self)?);
        }
        Ok(entries)
    }

    fn word(&mut self) -> Result<Option<Word>, FormatError> {
        let code = self.rest.count(Word::U32)?;
        word_of(code).ok_or_else(|| self.source.bad_grid(format!("numbers of type {code}, which are none of NetCDF's")))
    }

    fn attribute(&mut self) -> Result<Attribute, FormatError> {
        let (name, word, count) = (self.name()?, self.word()?, self.count()?);
        let bytes = self.filled(count.saturating_mul(word.map_or(1, Word::bytes)))?;
        let text =
            if word.is_none() { String::from_utf8_lossy(bytes).trim_matches('\0').to_owned() } else { String::new() };
        Ok(Attribute { name, text, numbers: word.map_or_else(Vec::new, |word| word.values(bytes, Endian::Big)) })
    }

    fn variable(&mut self) -> Result<Variable, FormatError> {
        let (name, axes) = (self.name()?, self.count()?);
        let mut dimensions = Vec::new();
        for _ in 0..axes {
            dimensions.push(self.count()?);
        }
        let attributes = self.list(ATTRIBUTES, Self::attribute)?;
        let word = self.word()?;
        // The size of the variable follows from its dimensions.
        self.count()?;
        let begin = self.rest.count(self.offset)?;
        Ok(Variable { name, dimensions, attributes, word, begin })
    }
}

impl<'a> CdfHeader<'a> {
    fn parse(source: &'a SourceFile) -> Result<Self, FormatError> {
        let (count, offset) = match source.bytes.get(3) {
            Some(1) => (Word::U32, Word::U32),
            Some(2) => (Word::U32, Word::U64),
            _ => (Word::U64, Word::U64),
        };
        let mut header = HeaderReader { source, rest: BinaryCursor::at(source, 4, Endian::Big), count, offset };
        // All ones stand for a file that is still being written.
        let records = header.count()?;
        let dimensions = header.list(DIMENSIONS, |header| Ok((header.name()?, header.count()?)))?;
        let attributes = header.list(ATTRIBUTES, HeaderReader::attribute)?;
        let variables: Vec<Variable> = header.list(VARIABLES, HeaderReader::variable)?;
        let is_known = |variable: &Variable| variable.dimensions.iter().all(|dimension| *dimension < dimensions.len());
        if !variables.iter().all(is_known) {
            return Err(source.bad_grid("a variable has dimensions that the header does not list"));
        }
        let found = Self { source, dimensions, records, attributes, variables };
        let bytes = |variable: &Variable| found.bytes(variable);
        let all = found.variables.iter().map(bytes).try_fold(0_usize, |sum, bytes| sum.checked_add(bytes?));
        // No two of them share bytes, which also bounds what is read.
        match all {
            Some(all) if all <= source.bytes.len() => Ok(found),
            all => Err(source.length("bytes of its variables", all.unwrap_or(usize::MAX), source.bytes.len())),
        }
    }

    fn variable(&self, name: &str) -> Option<&Variable> {
        self.variables.iter().find(|variable| variable.name == name)
    }

    fn is_of_records(&self, variable: &Variable) -> bool {
        variable.dimensions.first().is_some_and(|first| self.dimensions[*first].1 == 0)
    }

    /// The lengths of the axes of a variable.
    fn sides(&self, variable: &Variable) -> Vec<usize> {
        let side = |dimension: &usize| match self.dimensions[*dimension].1 {
            0 => self.records,
            length => length,
        };
        variable.dimensions.iter().map(side).collect()
    }

    fn bytes(&self, variable: &Variable) -> Option<usize> {
        let word = variable.word.map_or(1, Word::bytes);
        self.sides(variable).iter().try_fold(word, |product, side| product.checked_mul(*side))
    }

    /// The bytes of a variable in each record.
    fn record_bytes(&self, variable: &Variable) -> Option<usize> {
        let sides = self.sides(variable);
        let values = sides[1..].iter().try_fold(1_usize, |product, side| product.checked_mul(*side))?;
        values.checked_mul(variable.word.map_or(1, Word::bytes))
    }

    /// The numbers of a variable.
    fn values(&self, variable: &Variable) -> Result<Vec<f64>, FormatError> {
        let Some(word) = variable.word else { return Ok(Vec::new()) };
        let sides = self.sides(variable);
        let bytes = self.bytes(variable).unwrap_or(usize::MAX);
        let part = |at: usize, bytes: usize| {
            let rest = self.source.bytes.get(at..).unwrap_or_default();
            rest.get(..bytes).ok_or_else(|| self.source.length("bytes of a variable", bytes, rest.len()))
        };
        if !self.is_of_records(variable) {
            return Ok(word.values(part(variable.begin, bytes)?, Endian::Big));
        }
        let of_records: Vec<&Variable> = self.variables.iter().filter(|other| self.is_of_records(other)).collect();
        // A record of one variable is not filled up.
        let filled = |bytes: usize| if of_records.len() == 1 { bytes } else { bytes.next_multiple_of(4) };
        let sizes = of_records.iter().map(|other| self.record_bytes(other));
        let record = sizes.map(|size| size.filter(|size| *size < 1 << 40).map(filled)).sum::<Option<usize>>();
        let (Some(record), Some(own)) = (record, self.record_bytes(variable)) else {
            return Err(self.source.length("bytes of a record", usize::MAX, self.source.bytes.len()));
        };
        let mut values = Vec::new();
        for n in 0..sides[0] {
            let at = n.saturating_mul(record).saturating_add(variable.begin);
            values.extend(word.values(part(at, own)?, Endian::Big));
        }
        Ok(values)
    }
}

fn read(source: &SourceFile, context: &ReadContext<'_>) -> Result<Vec<RawSurface>, FormatError> {
    let header = CdfHeader::parse(source)?;
    let mut surfaces = Vec::new();
    let old = ["x_range", "y_range", "dimension", "z"].map(|name| header.variable(name));
    if let [Some(x), Some(y), Some(dimension), Some(z)] = old {
        let ranges = [header.values(x)?, header.values(y)?, header.values(dimension)?];
        for (axis, range) in [(x, &ranges[0]), (y, &ranges[1])] {
            refuse_degrees(source, axis, range, context)?;
        }
        surfaces.push(of_old_gmt(&header, z, &ranges)?);
    } else {
        for variable in header.variables.iter().filter(|variable| variable.word.is_some()) {
            surfaces.extend(of_coordinates(&header, variable, context)?);
        }
    }
    if surfaces.is_empty() {
        let names: Vec<&str> = header.variables.iter().map(|variable| variable.name.as_str()).collect();
        let why = format!("none of its variables has two dimensions with coordinates; it has {}", names.join(", "));
        return Err(source.empty(context.kind, why));
    }
    if let [only] = &mut surfaces[..]
        && only.name.as_deref().is_some_and(|name| ["z", "Band1"].contains(&name))
    {
        only.name = None;
    }
    Ok(surfaces)
}

fn refuse_degrees(
    source: &SourceFile,
    axis: &Variable,
    values: &[f64],
    context: &ReadContext<'_>,
) -> Result<(), FormatError> {
    let named = ["lon", "lat", "longitude", "latitude"].contains(&axis.name.to_ascii_lowercase().as_str());
    let words = axis.text("units").unwrap_or("").to_ascii_lowercase();
    let is_small = values.iter().all(|v| v.abs() <= 360.0);
    if words.contains("degree") || (named && is_small) {
        let evidence = if words.is_empty() { axis.name.clone() } else { format!("{} in {words}", axis.name) };
        return Err(source.degrees(context.kind, &evidence));
    }
    Ok(())
}

/// Sizes that are counts of nodes.
fn count_of(side: f64) -> usize {
    if side >= 1.0 && side.fract() == 0.0 { side as usize } else { 0 }
}

fn of_old_gmt(header: &CdfHeader<'_>, z: &Variable, ranges: &[Vec<f64>; 3]) -> Result<RawSurface, FormatError> {
    let [x, y, sides] = ranges.each_ref().map(Vec::as_slice);
    let ([x0, x1, ..], [y0, y1, ..], [nx, ny, ..]) = (x, y, sides) else {
        return Err(header.source.bad_grid("x_range, y_range or dimension has fewer than two numbers"));
    };
    // Where pixels are registered, the ranges are those of their borders.
    let is_pixel = z.number("node_offset") == Some(1.0);
    let intervals = if is_pixel { 0.0 } else { 1.0 };
    let step = DVec2::new((x1 - x0) / (nx - intervals), (y1 - y0) / (ny - intervals));
    let inwards = if is_pixel { 0.5 * step } else { DVec2::ZERO };
    let scan = Scan {
        first: DVec2::new(x0 + inwards.x, y1 - inwards.y),
        along: DVec2::new(step.x, 0.0),
        across: DVec2::new(0.0, -step.y),
        count: [count_of(*nx), count_of(*ny)],
    };
    surface(header, z, scan)
}

/// The surface of a variable whose last two dimensions have coordinates, and whose others have one value.
fn of_coordinates(
    header: &CdfHeader<'_>,
    variable: &Variable,
    context: &ReadContext<'_>,
) -> Result<Option<RawSurface>, FormatError> {
    let sides = header.sides(variable);
    let ([others @ .., ny, nx], [.., y, x]) = (&sides[..], &variable.dimensions[..]) else { return Ok(None) };
    let axis = |dimension: usize| {
        let own = header.variable(&header.dimensions[dimension].0);
        own.filter(|own| own.dimensions == [dimension] && own.word.is_some())
    };
    let (Some(y), Some(x)) = (axis(*y), axis(*x)) else { return Ok(None) };
    if others.iter().any(|side| *side != 1) {
        return Ok(None);
    }
    let mut steps = [(0.0, 0.0); 2];
    for (slot, axis) in steps.iter_mut().zip([x, y]) {
        let places = header.values(axis)?;
        refuse_degrees(header.source, axis, &places, context)?;
        *slot = even_steps(&places).ok_or_else(|| {
            let name = &axis.name;
            header.source.bad_grid(format!("its {name} are not evenly spaced: write x, y, z instead (grd2xyz)"))
        })?;
    }
    let [(x0, dx), (y0, dy)] = steps;
    let count = [*nx, *ny];
    let scan = Scan { first: DVec2::new(x0, y0), along: DVec2::new(dx, 0.0), across: DVec2::new(0.0, dy), count };
    let mut surface = surface(header, variable, scan)?;
    let unit = x.text("units").and_then(ZUnit::parse).filter(|unit| !unit.is_time());
    surface.horizontal = unit.map(|unit| (unit, format!("units of {}", x.name)));
    Ok(Some(surface))
}

fn surface(header: &CdfHeader<'_>, variable: &Variable, scan: Scan) -> Result<RawSurface, FormatError> {
    let nulls = ["_FillValue", "missing_value"].map(|name| variable.number(name));
    let [scale, offset] =
        [("scale_factor", 1.0), ("add_offset", 0.0)].map(|(name, or)| variable.number(name).unwrap_or(or));
    let mut values = header.values(variable)?;
    let is_null = |value: f64| nulls.iter().any(|null| number::is_null(value, *null));
    values.iter_mut().for_each(|value| *value = if is_null(*value) { f64::NAN } else { *value * scale + offset });
    let mut surface = scan.surface(header.source, Some(variable.name.clone()), values, f64::is_nan)?;
    if scale != 1.0 || offset != 0.0 {
        surface
            .notes
            .push(format!("values were multiplied by the file's scale {scale}, and its offset {offset} was added"));
    }
    surface.notes.extend(nulls.iter().flatten().take(1).map(|null| format!("the file's null is {null}")));
    let title = header.attributes.iter().find(|attribute| attribute.name == "title").map(|title| title.text.trim());
    surface.notes.extend(title.filter(|title| !title.is_empty()).map(|title| format!("the file's title is {title}")));
    let unit = variable.text("units").and_then(|words| Some((ZUnit::parse(words)?, format!("units {words}"))));
    surface.vertical.unit = unit;
    surface.vertical.positive = match variable.text("positive").map(str::to_ascii_lowercase).as_deref() {
        Some("up") => Some((ZPositive::Up, "positive: up".to_owned())),
        Some("down") => Some((ZPositive::Down, "positive: down".to_owned())),
        _ => None,
    };
    Ok(surface)
}
