//! Charisma: 3D horizon lines and fault sticks.
//!
//! Horizon: `INLINE : il XLINE : xl x y z`. Sticks: `INLINE- il xl x y z name stick` (or `CROSSLINE-`); il and xl may
//! be 0 if they are not known: the point is then placed by X, Y. The format states neither unit nor sign.

use super::raw::{RawPoint, RawShape, RawSurface, ReadContext};
use super::text::{self, Line, SourceFile};
use super::{Codec, Format, FormatError};
use crate::number;
use crate::number::UNDEFINED;
use glam::DVec2;
use indexmap::IndexMap;

pub(super) const CODEC: Codec = Codec {
    read_horizon: Some(read),
    read_fault: Some(read),
    ..Codec::of(Format::Charisma, "charisma", "dat", detect)
};

fn detect(source: &SourceFile) -> Option<String> {
    let text = source.text();
    let first = text::lines(&text).next()?.text;
    ["INLINE", "CROSSLINE", "XLINE"]
        .iter()
        .find(|w| first.starts_with(*w) && first[w.len()..].starts_with(['-', ' ', ':']))?;
    Some(format!("it begins with {}", text::excerpt(first.split_whitespace().next()?)))
}

fn read(source: &SourceFile, _: &ReadContext<'_>) -> Result<Vec<RawSurface>, FormatError> {
    let text = source.text();
    let mut by_name: IndexMap<Option<String>, Vec<RawPoint>> = IndexMap::new();
    for line in text::lines(&text).filter(|l| !l.text.starts_with(['#', '!'])) {
        let (name, point) = point_of(source, line)?;
        by_name.entry(name).or_default().push(point);
    }
    let surface = |(name, points)| RawSurface::new(name, RawShape::Points(points));
    Ok(by_name.into_iter().map(surface).collect())
}

fn point_of(source: &SourceFile, line: Line<'_>) -> Result<(Option<String>, RawPoint), FormatError> {
    let expected = "INLINE : il XLINE : xl x y z, or INLINE- il xl x y z name stick";
    let wrong = || source.syntax(line.number, expected, line.text);
    let fields = text::fields(line.text, None);
    let is_stick = fields[0].text.ends_with('-');
    // Words and colons only mark the order of the numbers.
    let numbers: Vec<f64> = fields
        .iter()
        .filter(|f| {
            !f.text.ends_with([':', '-'])
                && !f.text.eq_ignore_ascii_case("XLINE")
                && !f.text.eq_ignore_ascii_case("INLINE")
        })
        .map_while(|f| number::plain(f.text))
        .take(5)
        .collect();
    let &[il, xl, x, y, z] = numbers.as_slice() else { return Err(wrong()) };
    if [il, xl, x, y].iter().any(|v| !v.is_finite() || v.abs() > 1e12) {
        return Err(wrong());
    }
    let (il, xl) = if fields[0].text.starts_with("INLINE") { (il, xl) } else { (xl, il) };
    let known = il != 0.0 || xl != 0.0;
    let mut point = RawPoint {
        lines: known.then_some(DVec2::new(il, xl)),
        xy: Some(DVec2::new(x, y)),
        z: if z.abs() < UNDEFINED { z } else { f64::NAN },
        ..RawPoint::default()
    };
    if !is_stick {
        return Ok((None, point));
    }
    let [.., name, stick] = fields.get(6..).unwrap_or_default() else { return Err(wrong()) };
    point.stick = Some(number::plain(stick.text).filter(|v| v.is_finite()).ok_or_else(wrong)?);
    Ok((Some(name.text.to_string()), point))
}
