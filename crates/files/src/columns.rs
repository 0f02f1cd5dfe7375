//! Assigns the columns of a table: by the names in its header, or by the reading that fits the survey.

use super::column::{Column, NamedColumn, of_name};
use super::raw::ReadContext;
use super::text::SourceFile;
use super::unit::{Domain, ZPositive, ZUnit};
use super::{FormatError, SurfaceKind};
use glam::{DVec2, DVec3};
use survey::geometry::SurveyGeometry;
use survey::horizon::Quality;

/// The qualities and their words in a table.
const QUALITIES: [(Quality, &str); 6] = [
    (Quality::Hole, "hole"),
    (Quality::Picked, "picked"),
    (Quality::Tracked, "tracked"),
    (Quality::Filled, "filled"),
    (Quality::Extrapolated, "extrapolated"),
    (Quality::Snapped, "snapped"),
];

/// The word for a quality.
pub(super) fn quality_word(quality: Quality) -> &'static str {
    QUALITIES.iter().find(|(q, _)| *q == quality).map_or("picked", |(_, word)| word)
}

/// The quality of a word.
pub(super) fn quality_of(word: &str) -> Option<Quality> {
    QUALITIES.iter().find(|(_, w)| w.eq_ignore_ascii_case(word)).map(|(q, _)| *q)
}

/// The assigned columns, with what their names state about the vertical axis.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct ColumnLayout {
    pub columns: Vec<Column>,
    /// What the file calls them; none without a header.
    pub names: Vec<String>,
    pub unit: Option<(ZUnit, String)>,
    pub domain: Option<(Domain, String)>,
    pub positive: Option<(ZPositive, String)>,
    /// The unit of X and Y.
    pub horizontal: Option<(ZUnit, String)>,
    pub notes: Vec<String>,
}

impl ColumnLayout {
    /// Columns whose names state nothing about the vertical axis.
    pub(crate) fn plain(columns: Vec<Column>) -> Self {
        let (names, notes) = (Vec::new(), Vec::new());
        Self { columns, names, unit: None, domain: None, positive: None, horizontal: None, notes }
    }

    /// Whether a point can be placed: Z, and lines or X, Y.
    pub(crate) fn is_complete(&self) -> bool {
        let has = |c| self.columns.contains(&c);
        has(Column::Z) && ((has(Column::X) && has(Column::Y)) || (has(Column::Inline) && has(Column::Crossline)))
    }
}

/// Assigns columns by the names of a header. Of several vertical columns the first in the survey's domain is taken.
pub(super) fn from_header(names: &[&str], domain: Option<Domain>) -> ColumnLayout {
    let named: Vec<_> = names.iter().map(|n| of_name(n)).collect();
    let fits = |n: &NamedColumn| {
        let own = n.domain.or(n.unit.map(Domain::of_unit));
        own == domain && own.is_some()
    };
    let vertical: Vec<_> = (0..named.len()).filter(|&n| named[n].column == Column::Z).collect();
    let z = vertical.iter().copied().find(|&n| fits(&named[n])).or(vertical.first().copied());
    let mut layout = ColumnLayout::plain(Vec::with_capacity(named.len()));
    for (n, name) in named.iter().enumerate() {
        let again = layout.columns.contains(&name.column);
        let other_z = name.column == Column::Z && Some(n) != z;
        layout.columns.push(if again || other_z { Column::Other } else { name.column });
    }
    layout.names = names.iter().map(|name| name.trim().trim_matches('"').to_owned()).collect();
    let x = layout.columns.iter().position(|column| *column == Column::X);
    layout.horizontal = x.and_then(|x| Some((named[x].unit?, format!("column '{}'", names[x].trim()))));
    if let Some(z) = z {
        let says = format!("column '{}'", names[z].trim());
        layout.unit = named[z].unit.map(|u| (u, says.clone()));
        layout.domain = named[z].domain.map(|d| (d, says.clone()));
        layout.positive = named[z].positive.map(|p| (p, says.clone()));
        if vertical.len() > 1 {
            layout.notes.push(format!("of {} vertical columns {says} was read", vertical.len()));
        }
    }
    layout
}

/// Assigns the columns of a table without a header: the only reading under which the points lie in the survey.
///
/// `rows` are numbers in file order, `named` states whether a name stands before them.
pub(super) fn by_fit(
    source: &SourceFile,
    context: &ReadContext<'_>,
    rows: &[Vec<f64>],
    named: bool,
) -> Result<ColumnLayout, FormatError> {
    use Column::{Crossline as Xl, Inline as Il, Node, Stick, X, Y, Z};
    let width = rows.iter().map(Vec::len).min().unwrap_or(0);
    let unclear = |why: String| FormatError::Columns {
        file: source.path.clone(),
        why,
        example: format!(
            "{}{}",
            if named { "name," } else { "" },
            if width >= 5 { "inline,crossline,x,y,z" } else { "x,y,z" }
        ),
    };
    if width < 3 {
        return Err(unclear(format!("there is no header and only {width} numbers a line")));
    }
    let tail: &[Column] = if context.kind == SurfaceKind::Fault { &[Stick, Node] } else { &[] };
    let candidates: [&[Column]; 4] = [&[Il, Xl, X, Y, Z], &[X, Y, Il, Xl, Z], &[X, Y, Z], &[Il, Xl, Z]];
    let fits: Vec<usize> = candidates
        .iter()
        .map(|c| match context.geometry {
            Some(geometry) if c.len() <= width => rows.iter().filter(|row| fits_survey(c, row, geometry)).count(),
            _ => 0,
        })
        .collect();
    let integers = rows.iter().all(|r| r[0].fract() == 0.0 && r[1].fract() == 0.0 && r[0].abs() < 1e5);
    let (chosen, note) = if fits[0] > 0 || fits[1] > 0 {
        (if fits[0] >= fits[1] { 0 } else { 1 }, "its numbers agree with the survey in that order".to_string())
    } else if fits[2] > 0 && fits[3] > 0 {
        return Err(unclear("there is no header, and the first two numbers may be X, Y or inline, crossline".into()));
    } else if fits[2] > 0 || fits[3] > 0 {
        let chosen = if fits[2] > 0 { 2 } else { 3 };
        (chosen, format!("{} of {} lines fall into the survey in that order", fits[chosen], rows.len()))
    } else if context.geometry.is_none()
        && integers
        && width >= 5
        && rows.iter().all(|r| r[2].abs() > 1e4 && r[3].abs() > 1e4)
    {
        (0, "their size: small whole numbers before large ones".to_string())
    } else if context.geometry.is_none() && integers {
        return Err(unclear("there is no header, and the first two numbers may be X, Y or inline, crossline".into()));
    } else {
        // No reading fits; the checks against the survey report that with the extents.
        (if integers { 3 } else { 2 }, "their size".to_string())
    };
    let mut columns = if named { vec![Column::Name] } else { Vec::new() };
    columns.extend(candidates[chosen]);
    columns.extend(tail.iter().take(width - candidates[chosen].len()));
    columns.resize(width + usize::from(named), Column::Other);
    let words: Vec<_> = columns.iter().map(|c| format!("{c:?}").to_lowercase()).collect();
    let mut layout = ColumnLayout::plain(columns);
    layout.notes.push(format!("no header; columns taken as {} from {note}", words.join(", ")));
    Ok(layout)
}

/// Whether a row read in this order lies over the survey; with both line numbers and X, Y also whether the two agree to
/// a bin.
fn fits_survey(columns: &[Column], row: &[f64], geometry: &SurveyGeometry) -> bool {
    let at = |c| columns.iter().position(|&k| k == c).map(|n| row[n]);
    let voxel_of_lines = at(Column::Inline).zip(at(Column::Crossline)).map(|(i, x)| geometry.voxel_from_lines(i, x));
    let voxel_of_xy =
        at(Column::X).zip(at(Column::Y)).map(|(x, y)| geometry.voxel_from_world(DVec3::new(x, y, 0.0)).truncate());
    match (voxel_of_lines, voxel_of_xy) {
        (Some(a), Some(b)) => is_inside(a, geometry) && (a - b).abs().max_element() < 1.0,
        (Some(a), None) | (None, Some(a)) => is_inside(a, geometry),
        (None, None) => false,
    }
}

/// Whether voxel x, y lies on the survey, with a tolerance of half a bin.
pub(super) fn is_inside(voxel: DVec2, geometry: &SurveyGeometry) -> bool {
    let [nx, ny, _] = geometry.size();
    voxel.x >= -0.5 && voxel.y >= -0.5 && voxel.x <= nx as f64 - 0.5 && voxel.y <= ny as f64 - 0.5
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_vertical_column_of_the_surveys_domain_is_taken() {
        let names = ["x", "y", "twt_ms", "depth_m"];
        let depth = from_header(&names, Some(Domain::Depth));
        assert_eq!(depth.columns, [Column::X, Column::Y, Column::Other, Column::Z]);
        assert_eq!(depth.unit.unwrap().0, ZUnit::Metres);
        assert_eq!(from_header(&names, Some(Domain::Time)).columns[2], Column::Z);
    }
}
