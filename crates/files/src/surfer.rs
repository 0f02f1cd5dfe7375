//! Surfer grids (`.grd`): ASCII (`DSAA`), binary 6 (`DSBB`) and binary 7 (`DSRB`), rows from the south.
//!
//! `DSAA`, counts, ranges of X, Y and Z, values. `DSBB`, the same in little-endian 2-byte integers and doubles, values in
//! 4 bytes. `DSRB`, sections of a tag, a length and content: `GRID` has counts, the south-west node, steps, ranges,
//! rotation and the null, `DATA` the values in 8 bytes. Values from 1.70141e38 on are blank. The format states neither
//! unit nor sign.

use super::binary::{BinaryCursor, Endian, Word};
use super::grid::{self, NodeOrder};
use super::number;
use super::raw::{RawSurface, ReadContext};
use super::text::{self, SourceFile};
use super::{Codec, Format, FormatError};
use survey::horizon::NodeGrid;

pub(super) const CODEC: Codec =
    Codec { read_horizon: Some(read), ..Codec::of(Format::Surfer, "surfer", "grd", detect) };

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
    Ok(vec![grid::surface(source, None, grid, (values, NodeOrder::Rows), |v| number::is_null(v, null))?])
}

type Parts = (NodeGrid, Vec<f64>, Option<f64>);

fn ascii(source: &SourceFile) -> Result<Parts, FormatError> {
    let text = source.text();
    let numbers = source.grid_values(text::lines(&text).skip(1))?;
    let Some((&[nx, ny, x0, x1, y0, y1, _, _], values)) = numbers.split_first_chunk::<8>() else {
        return Err(source.length("header numbers", 8, numbers.len()));
    };
    Ok((grid::unrotated(source, [nx, ny], [x0, x1], [y0, y1])?, values.to_vec(), None))
}

fn binary_6(source: &SourceFile) -> Result<Parts, FormatError> {
    let mut rest = BinaryCursor::at(source, 4, Endian::Little);
    let count = rest.numbers(Word::I16)?;
    let [x0, x1, y0, y1, _, _] = rest.numbers(Word::F64)?;
    let values = Word::F32.values(rest.rest, Endian::Little);
    Ok((grid::unrotated(source, count, [x0, x1], [y0, y1])?, values, None))
}

fn binary_7(source: &SourceFile) -> Result<Parts, FormatError> {
    let mut rest = BinaryCursor::at(source, 0, Endian::Little);
    let (mut header, mut data) = (None, None);
    while rest.rest.len() >= 8 {
        let tag = rest.take(4)?;
        let length = rest.count(Word::U32)?;
        let start = source.bytes.len() - rest.rest.len();
        let content = rest.take(length)?;
        match tag {
            b"GRID" => header = Some(start),
            b"DATA" => data = Some(content),
            _ => {}
        }
    }
    let (Some(header), Some(data)) = (header, data) else {
        return Err(source.bad_grid("it has no section GRID, or no DATA"));
    };
    let mut header = BinaryCursor::at(source, header, Endian::Little);
    let [rows, columns] = header.numbers(Word::I32)?;
    let [x, y, dx, dy, _, _, rotation, null] = header.numbers(Word::F64)?;
    if rotation != 0.0 {
        return Err(source.bad_grid(format!("it is rotated by {rotation} degrees, for which the format has no pivot")));
    }
    let far = |low: f64, count: f64, step: f64| [low, low + (count - 1.0) * step];
    let grid = grid::unrotated(source, [columns, rows], far(x, columns, dx), far(y, rows, dy))?;
    Ok((grid, Word::F64.values(data, Endian::Little), Some(null)))
}
