//! Irap (RMS) binary: the same rotated grid as Irap ASCII, in big-endian Fortran records.
//!
//! Records `[length][payload][length]`: 32 bytes `i −996, i NROW, f XORI, XMAX, YORI, YMAX, XINC, YINC`; 16
//! bytes `i NCOL, f ROTATION, X0, Y0`; 28 bytes of zeros; then values as f32, i fastest, in records of any
//! length. Undefined from 1e30 on.

use super::irap::{IrapHeader, transposed};
use super::raw::{RawShape, RawSurface, ReadContext};
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

/// The records of a file, one after the other.
struct Records<'a> {
    source: &'a SourceFile,
    rest: &'a [u8],
}

impl<'a> Records<'a> {
    fn next(&mut self) -> Result<&'a [u8], FormatError> {
        let broken = |found: usize| self.source.length("bytes of a record", found + 8, self.rest.len());
        let (head, tail) = self.rest.split_first_chunk::<4>().ok_or_else(|| broken(0))?;
        let length = u32::from_be_bytes(*head) as usize;
        let payload = tail.get(..length).ok_or_else(|| broken(length))?;
        let (end, rest) = tail[length..].split_first_chunk::<4>().ok_or_else(|| broken(length))?;
        if u32::from_be_bytes(*end) as usize != length {
            let expected = format!("the record length {length} again at its end");
            return Err(self.source.syntax(0, expected, &u32::from_be_bytes(*end).to_string()));
        }
        self.rest = rest;
        Ok(payload)
    }

    fn header<const WORDS: usize>(&mut self) -> Result<[[u8; 4]; WORDS], FormatError> {
        let payload = self.next()?;
        let words = payload.as_chunks::<4>().0;
        words.try_into().map_err(|_| self.source.length("bytes of a header record", 4 * WORDS, payload.len()))
    }
}

fn read(source: &SourceFile, _: &ReadContext<'_>) -> Result<Vec<RawSurface>, FormatError> {
    let mut records = Records { source, rest: &source.bytes };
    let (int, float) = (|w: [u8; 4]| i64::from(i32::from_be_bytes(w)), |w: [u8; 4]| f64::from(f32::from_be_bytes(w)));
    let first: [[u8; 4]; 8] = records.header()?;
    let second: [[u8; 4]; 4] = records.header()?;
    records.header::<7>()?;
    if int(first[0]) != -996 {
        return Err(source.syntax(0, "-996, the mark of an Irap grid", &int(first[0]).to_string()));
    }
    let header = IrapHeader {
        count: [int(second[0]), int(first[1])],
        step: [float(first[6]), float(first[7])],
        rotation_deg: float(second[1]),
        origin: DVec2::new(float(second[2]), float(second[3])),
    };
    let grid = header.grid(source)?;
    let mut values = Vec::new();
    while !records.rest.is_empty() {
        let payload = records.next()?;
        values.extend(payload.as_chunks::<4>().0.iter().map(|w| {
            let value = float(*w);
            if value.abs() >= UNDEFINED { f64::NAN } else { value }
        }));
    }
    source.check_values(grid.count, values.len())?;
    let shape = RawShape::Grid { grid, z: transposed(&values, grid.count) };
    Ok(vec![RawSurface::new(None, shape)])
}
