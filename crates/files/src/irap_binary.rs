//! Irap (RMS) binary: the same rotated grid as Irap ASCII, in big-endian Fortran records.
//!
//! Records `[length][payload][length]`: 32 bytes `i −996, i NROW, f XORI, XMAX, YORI, YMAX, XINC, YINC`; 16
//! bytes `i NCOL, f ROTATION, X0, Y0`; 28 bytes of zeros; then values as f32, i fastest, in records of any
//! length. Undefined from 1e30 on.

use super::binary::{BinaryCursor, Endian, Word};
use super::grid::{self, GridHeader, NodeOrder};
use super::raw::{RawSurface, ReadContext};
use super::text::SourceFile;
use super::{Codec, Format, FormatError};
use crate::number::UNDEFINED;
use glam::DVec2;

pub(super) const CODEC: Codec =
    Codec { read_horizon: Some(read), ..Codec::of(Format::IrapBinary, "irapbin", "gri", detect) };

/// A record of 32 bytes that begins with −996.
const SIGNATURE: [u8; 8] = [0, 0, 0, 32, 0xff, 0xff, 0xfc, 0x1c];

fn detect(source: &SourceFile) -> Option<String> {
    source.bytes.starts_with(&SIGNATURE).then(|| "a record of 32 bytes that begins with -996".to_string())
}

/// The next record.
fn record<'a>(source: &SourceFile, rest: &mut BinaryCursor<'a>) -> Result<&'a [u8], FormatError> {
    let length = rest.count(Word::U32)?;
    let payload = rest.take(length)?;
    let end = rest.count(Word::U32)?;
    if end == length {
        return Ok(payload);
    }
    Err(source.syntax(0, format!("the record length {length} again at its end"), &end.to_string()))
}

fn read(source: &SourceFile, _: &ReadContext<'_>) -> Result<Vec<RawSurface>, FormatError> {
    let mut rest = BinaryCursor::at(source, 0, Endian::Big);
    let mut header = |words: usize| {
        let payload = record(source, &mut rest)?;
        let is_whole = payload.len() == 4 * words;
        let found = || source.length("bytes of a header record", 4 * words, payload.len());
        is_whole.then(|| [Word::I32, Word::F32].map(|word| word.values(payload, Endian::Big))).ok_or_else(found)
    };
    let ([int, float], [more_int, more_float]) = (header(8)?, header(4)?);
    header(7)?;
    if int[0] != -996.0 {
        return Err(source.syntax(0, "-996, the mark of an Irap grid", &int[0].to_string()));
    }
    let header = GridHeader {
        count: [more_int[0], int[1]],
        step: [float[6], float[7]],
        rotation_deg: more_float[1],
        origin: DVec2::new(more_float[2], more_float[3]),
    };
    let grid = header.grid(source)?;
    let mut values = Vec::new();
    while !rest.rest.is_empty() {
        values.extend(Word::F32.values(record(source, &mut rest)?, Endian::Big));
    }
    Ok(vec![grid::surface(source, None, grid, (values, NodeOrder::Rows), |v| v.abs() >= UNDEFINED)?])
}
