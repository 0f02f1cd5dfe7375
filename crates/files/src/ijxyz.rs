//! IJXYZ of OpenWorks and DecisionSpace: `inline crossline x y z` a line, in any order, under `@` and `#`
//! comments.
//!
//! `#Horizon_name___-> name` and `#Export_Z_Unit___-> unit` state name and unit.

use super::column::Column;
use super::columns::ColumnLayout;
use super::raw::{RawSurface, ReadContext};
use super::table::{self, LineCut};
use super::text::{self, SourceFile};
use super::{Codec, Format, FormatError};

pub(super) const CODEC: Codec = Codec { read_horizon: Some(read), ..Codec::of(Format::Ijxyz, "ijxyz", "dat", detect) };

fn detect(source: &SourceFile) -> Option<String> {
    let text = source.text();
    let mut comments = text::lines(&text).take_while(|l| l.text.starts_with(['#', '@']));
    comments
        .find(|l| l.text.starts_with("#End_of_Horizon_ASCII_Header") || l.text.starts_with("#OpenWorks_Project"))
        .map(|l| format!("its header has '{}'", text::excerpt(l.text).trim_matches('\'')))
}

fn read(source: &SourceFile, context: &ReadContext<'_>) -> Result<Vec<RawSurface>, FormatError> {
    let text = source.text();
    let layout = ColumnLayout::plain(vec![Column::Inline, Column::Crossline, Column::X, Column::Y, Column::Z]);
    let mut name = None;
    for line in text::lines(&text).filter(|l| l.text.starts_with('#')) {
        let Some((key, value)) = line.text.split_once("->") else { continue };
        let value = value.trim().trim_matches('\'');
        if key.trim_start_matches('#').trim_end_matches('_') == "Horizon_name" {
            name = Some(value.to_string());
        }
    }
    let rows: Vec<_> = text::lines(&text).filter(|l| !table::is_comment(l.text)).collect();
    let cut = LineCut::of(&rows);
    let mut surfaces = table::surfaces(source, &rows, cut, layout, context)?;
    surfaces.iter_mut().for_each(|s| s.name = name.clone());
    Ok(surfaces)
}
