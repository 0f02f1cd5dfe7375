//! EarthVision ASCII: points, scattered or from a grid.
//!
//! `# Field: n name unit` lines list the columns, `# Null_value:` the null, `# Z_units:` the unit; `# End:`
//! ends the header.

use super::column::{self, Column};
use super::columns::ColumnLayout;
use super::raw::{RawSurface, ReadContext};
use super::table::{self, LineCut};
use super::text::{self, SourceFile};
use super::unit::ZUnit;
use super::{Codec, Format, FormatError};
use crate::number;

pub(super) const CODEC: Codec = Codec {
    read_horizon: Some(read),
    read_fault: Some(read),
    ..Codec::of(Format::EarthVision, "earthvision", "dat", detect)
};

fn detect(source: &SourceFile) -> Option<String> {
    let text = source.text();
    let mut comments = text::lines(&text).map_while(|l| l.text.strip_prefix('#')).map(str::trim);
    comments
        .find(|c| c.starts_with("Type: scattered data") || c.starts_with("Grid_size:") || c.starts_with("Field: 1"))
        .map(|c| format!("its header has '{c}'"))
}

fn read(source: &SourceFile, context: &ReadContext<'_>) -> Result<Vec<RawSurface>, FormatError> {
    let text = source.text();
    let mut names: Vec<Column> = Vec::new();
    let mut layout = ColumnLayout::plain(Vec::new());
    let (mut null, mut title) = (None, None);
    for comment in text::lines(&text).map_while(|l| l.text.strip_prefix('#')) {
        let Some((key, value)) = comment.trim().split_once(':') else { continue };
        let value = value.trim();
        match key.trim() {
            "Field" => {
                let mut words = value.split_whitespace().skip(1);
                let column = words.next().map_or(Column::Other, |name| column::of_name(name).column);
                names.push(column);
                let unit = words.next().and_then(ZUnit::parse).filter(|_| column == Column::Z);
                layout.unit = unit.map(|u| (u, format!("Field: {value}"))).or(layout.unit);
            }
            "Null_value" => null = number::plain(value),
            "Description" => title = Some(value.to_string()),
            _ => {}
        }
    }
    layout.columns = if names.is_empty() { vec![Column::X, Column::Y, Column::Z] } else { names };
    let rows: Vec<_> = text::lines(&text).filter(|l| !table::is_comment(l.text)).collect();
    let mut surfaces = table::surfaces(source, &rows, LineCut::of(&rows), layout, context)?;
    for surface in &mut surfaces {
        surface.name = surface.name.take().or_else(|| title.clone());
        if let Some(null) = null {
            for z in surface.shape.values_mut().filter(|z| number::is_null(**z, Some(null))) {
                *z = f64::NAN;
            }
            surface.notes.push(format!("the file's null is {null}"));
        }
    }
    Ok(surfaces)
}
