//! Esri ASCII grids (`.asc`): unrotated, rows from the north.
//!
//! `ncols`, `nrows`, `xllcorner` or `xllcenter`, `yllcorner` or `yllcenter`, `cellsize` (or `dx` and `dy`) and
//! `NODATA_value`, a line each in any order, then the values. A value lies in the middle of its cell. The format states
//! neither unit nor sign: models of the ground are elevations, positive up.

use super::grid::{self, NodeOrder};
use super::number;
use super::raw::{RawSurface, ReadContext};
use super::text::{self, SourceFile};
use super::{Codec, Format, FormatError};
use std::collections::HashMap;

pub(super) const CODEC: Codec = Codec { read_horizon: Some(read), ..Codec::of(Format::Esri, "esri", "asc", detect) };

/// What a grid holds where its header names no null.
const USUAL_NULL: f64 = -9999.0;

fn detect(source: &SourceFile) -> Option<String> {
    let start = String::from_utf8_lossy(&source.bytes[..source.bytes.len().min(400)]).to_ascii_lowercase();
    let mut keys = text::lines(&start).filter_map(|line| line.text.split_whitespace().next());
    let known = ["ncols", "nrows", "xllcorner", "xllcenter", "yllcorner", "yllcenter"];
    let first = keys.next().filter(|key| known.contains(key))?;
    keys.next().filter(|key| known.contains(key)).map(|second| format!("it begins with {first} and {second}"))
}

fn read(source: &SourceFile, _: &ReadContext<'_>) -> Result<Vec<RawSurface>, FormatError> {
    let text = source.text();
    let mut header: HashMap<String, f64> = HashMap::new();
    let mut values = Vec::new();
    for line in text::lines(&text) {
        let mut tokens = line.text.split_whitespace();
        let first = line.text.chars().next().unwrap_or(' ');
        if values.is_empty() && first.is_ascii_alphabetic() && !number::is_missing(tokens.clone().next().unwrap_or(""))
        {
            let key = tokens.next().unwrap_or("").to_ascii_lowercase();
            let value = tokens.next().and_then(number::of);
            header.insert(key, value.ok_or_else(|| source.syntax(line.number, "a name and a number", line.text))?);
            continue;
        }
        values.extend(source.grid_values(std::iter::once(line))?);
    }
    let get = |key: &str| header.get(key).copied();
    let need = |key: &str| get(key).ok_or_else(|| source.bad_grid(format!("it has no {key}")));
    let counts = [need("ncols")?, need("nrows")?];
    let step = match get("cellsize") {
        Some(step) => [step; 2],
        None => [need("dx")?, need("dy")?],
    };
    let low = |axis: &str, step: f64| match get(&format!("{axis}llcenter")) {
        Some(centre) => Ok(centre),
        None => Ok(need(&format!("{axis}llcorner"))? + 0.5 * step),
    };
    let (x, y) = (low("x", step[0])?, low("y", step[1])?);
    let far = |low: f64, count: f64, step: f64| [low, low + (count - 1.0) * step];
    let grid = grid::unrotated(source, counts, far(x, counts[0], step[0]), far(y, counts[1], step[1]))?;
    let null = get("nodata_value").unwrap_or(USUAL_NULL);
    let is_null = |v| number::is_null(v, Some(null));
    let mut surface = grid::surface(source, None, grid, (values, NodeOrder::RowsFromNorth), is_null)?;
    surface.notes.push(format!("the file's null is {null}"));
    Ok(vec![surface])
}
