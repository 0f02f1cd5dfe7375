//! PetroMod binary maps: a rotated regular grid.
//!
//! Four bytes `23 03 19 64`, then `Key=value` pairs cut by commas and ended by a zero byte (`GridNoX`,
//! `GridStepX`, `OriginX`, `RotationAngle`, `RotationOriginX`, `Undefined` …), then GridNoX·GridNoY
//! big-endian f32, Y fastest. The origin is turned about the rotation origin by the angle, degrees
//! anticlockwise. `DataUnitZ` is a code of the program's own and not interpreted.

use super::binary::{Endian, Word};
use super::grid::{self, GridHeader, NodeOrder};
use super::raw::{RawSurface, ReadContext};
use super::text::SourceFile;
use super::{Codec, Format, FormatError};
use crate::number;
use glam::DVec2;
use std::collections::HashMap;

pub(super) const CODEC: Codec =
    Codec { read_horizon: Some(read), ..Codec::of(Format::PetroMod, "petromod", "pmd", detect) };

const SIGNATURE: [u8; 4] = [0x23, 0x03, 0x19, 0x64];

fn detect(source: &SourceFile) -> Option<String> {
    let rest = source.bytes.strip_prefix(&SIGNATURE)?;
    rest.starts_with(b"Content=Map").then(|| "its header is that of a PetroMod map".to_string())
}

fn read(source: &SourceFile, _: &ReadContext<'_>) -> Result<Vec<RawSurface>, FormatError> {
    let body = source.bytes.strip_prefix(&SIGNATURE).unwrap_or(&source.bytes);
    let end = body.iter().position(|b| *b == 0).ok_or_else(|| source.bad_grid("its text has no end"))?;
    let text = String::from_utf8_lossy(&body[..end]).into_owned();
    let facts: HashMap<&str, &str> = text.split(',').filter_map(|pair| pair.split_once('=')).collect();
    let number = |key: &str| {
        let value = facts.get(key).and_then(|v| number::plain(v));
        value.ok_or_else(|| source.bad_grid(format!("it has no number {key}")))
    };
    let or = |key: &str, default: f64| facts.get(key).and_then(|v| number::plain(v)).unwrap_or(default);
    let origin = DVec2::new(number("OriginX")?, number("OriginY")?);
    let pivot = DVec2::new(or("RotationOriginX", origin.x), or("RotationOriginY", origin.y));
    let rotation_deg = or("RotationAngle", 0.0);
    let header = GridHeader {
        count: [number("GridNoX")?, number("GridNoY")?],
        step: [number("GridStepX")?, number("GridStepY")?],
        rotation_deg,
        origin: pivot + DVec2::from_angle(rotation_deg.to_radians()).rotate(origin - pivot),
    };
    let grid = header.grid(source)?;
    let values = Word::F32.values(&body[end + 1..], Endian::Big);
    let undefined = or("Undefined", 99_999.0);
    let is_undefined = |v: f64| (v - undefined).abs() <= 1e-6 * undefined.abs();
    let mut surface = grid::surface(source, None, grid, (values, NodeOrder::Columns), is_undefined)?;
    surface.notes.extend(facts.get("DataUnitZ").map(|code| format!("the file's DataUnitZ={code} is not interpreted")));
    Ok(vec![surface])
}
