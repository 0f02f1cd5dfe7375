//! Surfer grids (`.grd`): ASCII (`DSAA`), binary 6 (`DSBB`) and binary 7 (`DSRB`), rows from the south.
//!
//! `DSAA`, counts, ranges of X, Y and Z, values. `DSBB`, the same in little-endian 2-byte integers and doubles, values in
//! 4 bytes. `DSRB`, sections of a tag, a length and content: `GRID` has counts, the south-west node, steps, ranges,
//! rotation and the null, `DATA` the values in 8 bytes. Values from 1.70141e38 on are blank. The format states neither
//! unit nor sign.

use super::irap::transposed;
use super::number;
use super::raw::{RawShape, RawSurface, ReadContext};
use super::text::{self, SourceFile};
use super::zmap::unrotated;
use super::{Codec, Format, FormatError};
use survey::horizon::NodeGrid;

pub(super) const CODEC: Codec =
    Codec { read_horizon: Some(read), ..Codec::of(Format::Surfer, "surfer", "grd", detect) };

/// Bytes of the header of `DSBB`.
const HEADER_6: usize = 4 + 2 * 2 + 6 * 8;

fn detect(source: &SourceFile) -> Option<String> {
    let tag = ["DSAA", "DSBB", "DSRB"].into_iter().find(|tag| source.bytes.starts_with(tag.as_bytes()))?;
    Some(format!("it begins with {tag}"))
}

fn read(source: &SourceFile, _: &ReadContext<'_>) -> Result<Vec<RawSurface>, FormatError> {
    let (grid, values, null) = match source.bytes.get(..4) {
        Some(b"DSAA") => ascii(source)?,
        Some(b"DSBB") => binary_6(source)?,
        _ => binary_7(source)?,
    };
    source.check_values(grid.count, values.len())?;
    let holes: Vec<f64> = values.into_iter().map(|v| if number::is_null(v, null) { f64::NAN } else { v }).collect();
    Ok(vec![RawSurface::new(None, RawShape::Grid { grid, z: transposed(&holes, grid.count) })])
}

type Parts = (NodeGrid, Vec<f64>, Option<f64>);

fn ascii(source: &SourceFile) -> Result<Parts, FormatError> {
    let text = source.text();
    let tokens =
        text::lines(&text).skip(1).flat_map(|line| line.text.split_whitespace().map(move |t| (line.number, t)));
    let mut numbers = Vec::new();
    for (line, token) in tokens {
        numbers.push(source.grid_value(line, token)?);
    }
    let Some((&[nx, ny, x0, x1, y0, y1, _, _], values)) = numbers.split_first_chunk::<8>() else {
        return Err(source.length("header numbers", 8, numbers.len()));
    };
    Ok((unrotated(source, [nx, ny], [x0, x1], [y0, y1])?, values.to_vec(), None))
}

fn double(bytes: &[u8], at: usize) -> Option<f64> {
    Some(f64::from_le_bytes(bytes.get(at..)?.first_chunk().copied()?))
}

fn binary_6(source: &SourceFile) -> Result<Parts, FormatError> {
    let bytes = &source.bytes;
    let short = || source.length("bytes of the header", HEADER_6, bytes.len());
    let count = |at: usize| Some(f64::from(i16::from_le_bytes(bytes.get(at..)?.first_chunk().copied()?)));
    let range = |at: usize| Some([double(bytes, at)?, double(bytes, at + 8)?]);
    let (Some(nx), Some(ny), Some(x), Some(y)) = (count(4), count(6), range(8), range(24)) else { return Err(short()) };
    let values = bytes.get(HEADER_6..).ok_or_else(short)?.as_chunks::<4>().0;
    let values = values.iter().map(|word| f64::from(f32::from_le_bytes(*word))).collect();
    Ok((unrotated(source, [nx, ny], x, y)?, values, None))
}

fn binary_7(source: &SourceFile) -> Result<Parts, FormatError> {
    let mut rest = source.bytes.as_slice();
    let (mut header, mut data) = (None, None);
    while let Some((head, tail)) = rest.split_first_chunk::<8>() {
        let length = u32::from_le_bytes([head[4], head[5], head[6], head[7]]) as usize;
        let content = tail.get(..length).ok_or_else(|| source.length("bytes of a section", length, tail.len()))?;
        match &head[..4] {
            b"GRID" => header = Some(content),
            b"DATA" => data = Some(content),
            _ => {}
        }
        rest = &tail[length..];
    }
    let (Some(header), Some(data)) = (header, data) else {
        return Err(source.bad_grid("it has no section GRID, or no DATA"));
    };
    let count = |at: usize| Some(f64::from(i32::from_le_bytes(header.get(at..)?.first_chunk().copied()?)));
    let numbers = || {
        let [x, y, dx, dy] = [8, 16, 24, 32].map(|at| double(header, at));
        Some((count(0)?, count(4)?, [x?, y?, dx?, dy?], double(header, 56)?, double(header, 64)?))
    };
    let Some((rows, columns, [x, y, dx, dy], rotation, null)) = numbers() else {
        return Err(source.length("bytes of the section GRID", 72, header.len()));
    };
    if rotation != 0.0 {
        return Err(source.bad_grid(format!("it is rotated by {rotation} degrees, for which the format has no pivot")));
    }
    let far = |low: f64, count: f64, step: f64| [low, low + (count - 1.0) * step];
    let grid = unrotated(source, [columns, rows], far(x, columns, dx), far(y, rows, dy))?;
    let values = data.as_chunks::<8>().0.iter().map(|word| f64::from_le_bytes(*word)).collect();
    Ok((grid, values, Some(null)))
}
