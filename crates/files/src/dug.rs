//! DUG Insight horizons: rows of `inline crossline z` or `x y z`.
//!
//! `#` comments come first, among them `# subgrid=il:1272-3492[10]+cl:1320-3520[10]` and
//! `# vertical_dimension=time`. The extension names the columns (`.ilclt`, `.ilclz`, `.xyt`, `.xyz`). With
//! another extension, the first two columns are inline and crossline if all of their numbers are whole and
//! within the subgrid; otherwise the reading that fits the survey is taken.

use super::column::Column;
use super::columns::ColumnLayout;
use super::raw::{RawSurface, ReadContext};
use super::table::{self, LineCut};
use super::text::{self, Line, SourceFile};
use super::unit::Domain;
use super::{Codec, Format, FormatError};
use crate::number;

pub(super) const CODEC: Codec = Codec { read_horizon: Some(read), ..Codec::of(Format::Dug, "dug", "ilclt", detect) };

/// The columns and the domain that an extension names.
fn of_extension(source: &SourceFile) -> Option<([Column; 3], Domain)> {
    let extension = source.path.extension()?.to_str()?.to_ascii_lowercase();
    let lines = [Column::Inline, Column::Crossline, Column::Z];
    let world = [Column::X, Column::Y, Column::Z];
    match extension.as_str() {
        "ilclt" => Some((lines, Domain::Time)),
        "ilclz" => Some((lines, Domain::Depth)),
        "xyt" => Some((world, Domain::Time)),
        _ => None,
    }
}

fn detect(source: &SourceFile) -> Option<String> {
    if let Some(extension) = source.path.extension().filter(|_| of_extension(source).is_some()) {
        return Some(format!("its extension is .{}", extension.to_string_lossy()));
    }
    let text = source.text();
    text::lines(&text)
        .take_while(|l| l.text.starts_with('#'))
        .map(|l| l.text.trim_start_matches(['#', ' ']))
        .find(|c| c.starts_with("subgrid=") || c.starts_with("vertical_dimension="))
        .map(|c| format!("its header has '{c}'"))
}

/// Whether there is a subgrid of lines and the first two numbers of every row are whole and within it.
fn on_subgrid(text: &str, rows: &[Line<'_>], cut: LineCut) -> bool {
    let Some(subgrid) = text::lines(text)
        .find_map(|l| l.text.trim_start_matches(['#', ' ']).strip_prefix("subgrid=").map(str::to_string))
    else {
        return false;
    };
    let range = |word: &str| {
        let (first, last) = subgrid.split_once(word)?.1.split(['[', '+']).next()?.split_once('-')?;
        let (first, last) = (number::plain(first)?, number::plain(last)?);
        Some(first.min(last)..=first.max(last))
    };
    let (Some(inlines), Some(crosslines)) = (range("il:"), range("cl:")) else { return false };
    let (numbers, _) = table::sample_rows(rows, cut);
    let fits = |v: Option<&f64>, range: &std::ops::RangeInclusive<f64>| {
        v.is_some_and(|v| v.fract() == 0.0 && range.contains(v))
    };
    numbers.iter().all(|row| fits(row.first(), &inlines) && fits(row.get(1), &crosslines))
}

fn read(source: &SourceFile, context: &ReadContext<'_>) -> Result<Vec<RawSurface>, FormatError> {
    let text = source.text();
    let rows: Vec<_> = text::lines(&text).filter(|l| !table::is_comment(l.text)).collect();
    let named = of_extension(source);
    let cut = LineCut::of(&rows);
    let lines = || [Column::Inline, Column::Crossline, Column::Z];
    let columns = named.map(|(columns, _)| columns).or_else(|| on_subgrid(&text, &rows, cut).then(lines));
    let header = columns.map(|columns| ColumnLayout::plain(columns.to_vec()));
    let mut layout = table::settle_columns(source, context, header, &rows, cut)?;
    let stated = text::lines(&text).find_map(|l| {
        let word = l.text.trim_start_matches(['#', ' ']).strip_prefix("vertical_dimension=")?.trim().to_string();
        let domain = match word.to_ascii_lowercase().as_str() {
            "time" => Domain::Time,
            "depth" => Domain::Depth,
            _ => return None,
        };
        Some((domain, format!("vertical_dimension={word}")))
    });
    let by_name = named.map(|(_, domain)| (domain, "its extension".to_string()));
    layout.domain = stated.or(by_name).or(layout.domain);
    table::surfaces(source, &rows, cut, layout, context)
}
