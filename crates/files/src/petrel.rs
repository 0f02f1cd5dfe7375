//! Petrel points with attributes, and well tops as points.
//!
//! `# Unit in depth: ms`, `VERSION 1`, `BEGIN HEADER`, a column name per line (some with a type,
//! `INT,Inline`), `END HEADER`, rows. Petrel usually writes Z negative downwards, which the file does not
//! state: the sign is an option. −999 is its null.

use super::columns;
use super::raw::{RawSurface, ReadContext};
use super::table::{self, LineCut};
use super::text::{self, SourceFile};
use super::{Codec, Format, FormatError};

pub(super) const CODEC: Codec =
    Codec { read_horizon: Some(read), read_fault: Some(read), ..Codec::of(Format::Petrel, "petrel", "txt", detect) };

fn detect(source: &SourceFile) -> Option<String> {
    let text = source.text();
    let header = text::lines(&text).take(20).find(|l| l.text.starts_with("# Petrel") || l.text == "BEGIN HEADER")?;
    Some(format!("line {} is '{}'", header.number, header.text))
}

fn read(source: &SourceFile, context: &ReadContext<'_>) -> Result<Vec<RawSurface>, FormatError> {
    let text = source.text();
    let all: Vec<_> = text::lines(&text).collect();
    let at = |words: &str| all.iter().position(|l| l.text == words);
    let (Some(begin), Some(end)) = (at("BEGIN HEADER"), at("END HEADER")) else {
        return Err(source.syntax(1, "BEGIN HEADER and END HEADER", all.first().map_or("", |l| l.text)));
    };
    let names: Vec<&str> = all.get(begin + 1..end).unwrap_or_default().iter().map(|l| l.text).collect();
    let layout = columns::from_header(&names, context.domain());
    let rows: Vec<_> = all[end + 1..].iter().copied().filter(|l| !table::is_comment(l.text)).collect();
    let cut = LineCut { delimiter: None, ..LineCut::of(&rows) };
    let mut surfaces = table::surfaces(source, &rows, cut, layout, context)?;
    for surface in &mut surfaces {
        let nulls = surface.shape.values_mut().filter(|z| **z == -999.0).map(|z| *z = f64::NAN).count();
        if nulls > 0 {
            surface.notes.push(format!("{nulls} values of -999, Petrel's null, are holes"));
        }
    }
    Ok(surfaces)
}
