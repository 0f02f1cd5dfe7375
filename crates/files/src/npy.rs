//! NumPy arrays (`.npy`): horizons over the lattice of the survey, points, and volumes.
//!
//! `\x93NUMPY`, two bytes of version (1 to 3), the length of the header in 2 or 4 bytes, the header, which is a Python
//! dict with `descr` (byte order, kind and bytes of a number), `fortran_order` and `shape`, then the numbers. An array
//! has no places: one of two axes is a horizon, `[inline][crossline]` of the survey, one of rows of three is points X,
//! Y, Z, and one of three axes a volume ([`NpyVolume`]), `[inline][crossline][sample]` of the survey. NaN is a hole.
//!
//! # Memory
//! Of a horizon, the file and twice 8 bytes for each value; of a volume, what is asked for.

use super::binary::{Endian, Word};
use super::grid::{self, NodeOrder};
use super::number;
use super::raw::{RawPoint, RawShape, RawSurface, ReadContext};
use super::text::{SourceFile, excerpt};
use super::{Codec, Format, FormatError};
use glam::DVec2;
use std::path::Path;
use survey::horizon::NodeGrid;

pub(super) const CODEC: Codec =
    Codec { read_horizon: Some(read), read_fault: Some(read), ..Codec::of(Format::Npy, "npy", "npy", detect) };

/// The first bytes.
pub(super) const SIGNATURE: &[u8] = b"\x93NUMPY";
/// Bytes of a header, at most; NumPy itself reads 10 000.
pub(super) const LONGEST_HEADER: usize = 1 << 16;

fn detect(source: &SourceFile) -> Option<String> {
    source.bytes.starts_with(SIGNATURE).then(|| "it begins as an array of NumPy".to_owned())
}

/// What the header of an array states.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct ArrayHeader {
    pub shape: Vec<usize>,
    pub word: Word,
    pub endian: Endian,
    /// The order of the axes: the first one is the fastest.
    pub is_fortran: bool,
    /// Where the numbers begin.
    pub data_at: usize,
}

impl ArrayHeader {
    /// The header at the start of a file, of which these are the first bytes.
    pub(super) fn parse(path: &Path, start: &[u8]) -> Result<Self, FormatError> {
        let bad = |why: String| FormatError::BadGrid { file: path.to_owned(), why: format!("NumPy array: {why}") };
        let cut = || bad("its header is cut off".to_owned());
        let version = *start.get(SIGNATURE.len()).ok_or_else(cut)?;
        let (length, text_at) = match (version, start.get(8..12)) {
            (1, Some([a, b, ..])) => (usize::from(u16::from_le_bytes([*a, *b])), 10),
            (2 | 3, Some([a, b, c, d])) => (u32::from_le_bytes([*a, *b, *c, *d]) as usize, 12),
            (1..=3, None) => return Err(cut()),
            _ => return Err(bad(format!("version {version} of the format, of which 1 to 3 are read"))),
        };
        if length > LONGEST_HEADER {
            return Err(bad(format!("a header of {length} bytes")));
        }
        let text = String::from_utf8_lossy(start.get(text_at..text_at + length).ok_or_else(cut)?).into_owned();
        let value = |key: &str| {
            let at = text.find(&format!("'{key}'")).or_else(|| text.find(&format!("\"{key}\"")))?;
            Some(text[at..].split_once(':')?.1.trim_start())
        };
        let missing = |key: &str| bad(format!("its header has no {key}: {}", excerpt(&text)));
        let descr = value("descr").ok_or_else(|| missing("descr"))?;
        let (word, endian) = number_type(descr).ok_or_else(|| {
            bad(format!(
                "numbers of the kind {}: save it with astype('float32')",
                excerpt(&descr.chars().take(12).collect::<String>())
            ))
        })?;
        let shape = value("shape").and_then(|text| text.strip_prefix('(')?.split_once(')')).map(|(inside, _)| inside);
        let sides = shape.ok_or_else(|| missing("shape"))?.split(',').map(str::trim).filter(|side| !side.is_empty());
        // Python 2 wrote long integers with an L.
        let shape: Option<Vec<usize>> = sides.map(|side| side.trim_end_matches('L').parse().ok()).collect();
        let shape = shape.ok_or_else(|| missing("shape of whole numbers"))?;
        let is_fortran = value("fortran_order").is_some_and(|word| word.starts_with("True"));
        Ok(Self { shape, word, endian, is_fortran, data_at: text_at + length })
    }

    /// The bytes of all numbers.
    pub(super) fn bytes(&self) -> Option<usize> {
        self.shape.iter().chain([&self.word.bytes()]).try_fold(1_usize, |product, side| product.checked_mul(*side))
    }

    /// The sides of the array, without those of one value.
    pub(super) fn sides(&self) -> Vec<usize> {
        let long: Vec<usize> = self.shape.iter().copied().filter(|side| *side != 1).collect();
        if long.len() < 2 { self.shape.clone() } else { long }
    }
}

/// The type of numbers of a `descr` such as `'<f4'`.
fn number_type(descr: &str) -> Option<(Word, Endian)> {
    let name = descr.strip_prefix(['\'', '"'])?.split(['\'', '"']).next()?;
    let (order, kind) = if name.starts_with(['<', '>', '|', '=']) { name.split_at(1) } else { ("<", name) };
    let word = match kind {
        "i1" => Word::I8,
        "u1" => Word::U8,
        "i2" => Word::I16,
        "u2" => Word::U16,
        "i4" => Word::I32,
        "u4" => Word::U32,
        "i8" => Word::I64,
        "u8" => Word::U64,
        "f4" => Word::F32,
        "f8" => Word::F64,
        _ => return None,
    };
    Some((word, if order == ">" { Endian::Big } else { Endian::Little }))
}

fn read(source: &SourceFile, context: &ReadContext<'_>) -> Result<Vec<RawSurface>, FormatError> {
    let header = ArrayHeader::parse(&source.path, &source.bytes)?;
    let data = source.bytes.get(header.data_at..).unwrap_or_default();
    let expected = header.bytes().ok_or_else(|| source.bad_grid(format!("a shape of {:?}", header.shape)))?;
    if data.len() != expected {
        return Err(source.length("bytes of numbers", expected, data.len()));
    }
    let survey = context.geometry.map(|geometry| [geometry.size()[0], geometry.size()[1]]);
    let sides = match header.shape[..] {
        [a, b] => [a, b],
        _ => match header.sides()[..] {
            [a, b] => [a, b],
            [_, _, _] => {
                let why = "it has three axes, which is a volume: `petroglyph import` reads it into a project with its lattice";
                return Err(source.empty(context.kind, why));
            }
            _ => {
                let why = format!("its shape is {:?}: a horizon has two axes, inlines and crosslines", header.shape);
                return Err(source.bad_grid(why));
            }
        },
    };
    let values = header.word.values(data, header.endian);
    let values = if header.is_fortran { NodeOrder::Rows.sorted(&values, sides) } else { values };
    if sides[1] == 3 && survey != Some(sides) {
        let point = |row: &[f64; 3]| {
            let xy = DVec2::new(row[0], row[1]);
            RawPoint { xy: Some(xy), z: row[2], ..RawPoint::default() }
        };
        let is_place = |point: &RawPoint| point.xy.is_some_and(|xy| xy.is_finite() && xy.abs().max_element() < 1e12);
        let points = values.as_chunks::<3>().0.iter().map(point).filter(is_place).collect();
        let notes = vec!["its rows of three numbers are taken as X, Y, Z".to_owned()];
        return Ok(vec![RawSurface { notes, ..RawSurface::new(None, RawShape::Points(points)) }]);
    }
    let Some(geometry) = context.geometry else {
        let grid = NodeGrid { origin: DVec2::ZERO, u_step: DVec2::X, v_step: DVec2::Y, count: sides };
        let mut surface = grid::surface(source, None, grid, (values, NodeOrder::Columns), is_hole)?;
        surface.notes.push(
            "it has no places: X and Y are counted, and are the survey's inlines and crosslines on import".to_owned(),
        );
        return Ok(vec![surface]);
    };
    let [inlines, crosslines] = [geometry.size()[0], geometry.size()[1]];
    if sides != [inlines, crosslines] {
        let [a, b] = sides;
        let turned = if [b, a] == [inlines, crosslines] { "; transpose it" } else { "" };
        let why =
            format!("{a} by {b} values, where the survey has {inlines} inlines by {crosslines} crosslines{turned}");
        return Err(source.bad_grid(why));
    }
    let grid = NodeGrid::of_survey(geometry);
    let mut surface = grid::surface(source, None, grid, (values, NodeOrder::Columns), is_hole)?;
    surface
        .notes
        .push("taken as a value for each inline and crossline of the survey, which the file does not state".to_owned());
    Ok(vec![surface])
}

fn is_hole(value: f64) -> bool {
    number::is_null(value, None)
}
