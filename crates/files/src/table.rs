//! Reads the rows of a text table as points, once its columns are known.

use super::FormatError;
use super::column::{self, Column};
use super::columns::{self, ColumnLayout};
use super::raw::{RawPoint, RawShape, RawSurface, ReadContext, VerticalFacts};
use super::text::{self, Field, Line, SourceFile};
use crate::number::{self, NumberStyle};
use glam::{DVec2, DVec3};
use indexmap::IndexMap;
use std::collections::{HashMap, HashSet};

/// How the lines of a table are cut into numbers.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct LineCut {
    /// The delimiter; `None` = blanks.
    pub delimiter: Option<char>,
    /// How numbers are written.
    pub style: NumberStyle,
}

impl LineCut {
    /// How lines are cut: by `;`, tab or comma, whichever the first has, in this order, else by blanks.
    ///
    /// How numbers are written is seen from up to 2000 lines: commas of a table that they do not cut are decimal commas
    /// or separate thousands.
    pub(crate) fn of(rows: &[Line<'_>]) -> Self {
        let first = rows.first().map_or("", |line| line.text);
        // A tab next to blanks belongs to a table with blanks; OpendTect separates by tabs alone.
        let delimiter = [';', '\t', ','].into_iter().find(|&d| first.contains(d));
        let is_blank = delimiter == Some('\t') && !first.contains("\t\t") && !first.contains('"');
        let delimiter = if is_blank { None } else { delimiter };
        // Numbers with a decimal comma between blanks.
        let are_numbers = |first: &str| {
            let mut tokens = first.split_whitespace();
            tokens.clone().count() > 2 && tokens.all(|token| NumberStyle::Comma.number(token).is_some())
        };
        let delimiter = if delimiter == Some(',') && are_numbers(first) { None } else { delimiter };
        let stride = (rows.len() / 2000).max(1);
        let has_comma = delimiter != Some(',') && rows.iter().step_by(stride).any(|line| line.text.contains(','));
        let style = if has_comma {
            let fields: Vec<Field<'_>> =
                rows.iter().step_by(stride).flat_map(|line| text::fields(line.text, delimiter)).collect();
            NumberStyle::among(fields.iter().map(|field| field.text))
        } else {
            NumberStyle::Point
        };
        Self { delimiter, style }
    }

    /// How one line is cut.
    pub(crate) fn of_line(line: &str) -> Self {
        Self::of(&[Line { number: 1, text: line }])
    }

    /// The fields of a line.
    pub(crate) fn fields<'a>(&self, line: &'a str) -> Vec<Field<'a>> {
        text::fields(line, self.delimiter)
    }

    /// A field as a number.
    pub(crate) fn number(&self, field: &str) -> Option<f64> {
        self.style.number(field)
    }

    /// A field as a value that may be missing: NaN then.
    pub(crate) fn value(&self, field: &str) -> Option<f64> {
        number::or_missing(field, self.style)
    }
}

/// Whether a line declares an attribute of RMS points, such as `Float VerticalSep`.
fn is_attribute(line: &str) -> bool {
    let mut words = line.split_whitespace();
    matches!(words.next(), Some("Discrete" | "Float" | "Integer" | "String"))
        && words.next().is_some()
        && words.next().is_none()
}

/// Whether a line is a comment, an end mark or the declaration of an attribute.
pub(crate) fn is_comment(line: &str) -> bool {
    is_attribute(line)
        || line.starts_with(['#', '!', '%', '@'])
        || line.starts_with("//")
        || matches!(line, "END" | "EOD" | "EOB" | "EOF")
}

/// The numbers of up to 2000 rows spread over the table, to identify columns, and whether a name precedes them.
pub(super) fn sample_rows(rows: &[Line<'_>], cut: LineCut) -> (Vec<Vec<f64>>, bool) {
    let stride = (rows.len() / 2000).max(1);
    let mut named = false;
    let numbers = rows
        .iter()
        .step_by(stride)
        .map(|line| {
            let fields = cut.fields(line.text);
            let name = fields.first().is_some_and(|f| f.quoted || cut.number(f.text).is_none());
            named |= name;
            fields.iter().skip(usize::from(name)).map_while(|f| cut.number(f.text)).collect()
        })
        .collect();
    (numbers, named)
}

/// Reads rows into points, grouped by name in order of first appearance.
pub(super) fn surfaces(
    source: &SourceFile,
    rows: &[Line<'_>],
    cut: LineCut,
    mut layout: ColumnLayout,
    context: &ReadContext<'_>,
) -> Result<Vec<RawSurface>, FormatError> {
    if context.kind == super::SurfaceKind::Horizon {
        // The polygons of a horizon are its points.
        let polygons = layout.columns.iter_mut().filter(|column| **column == Column::Polygon);
        polygons.for_each(|column| *column = Column::Other);
    }
    settle_names(rows, cut, &mut layout);
    if !layout.is_complete() {
        return Err(FormatError::Columns {
            file: source.path.clone(),
            why: format!("the columns {} hold no Z with X, Y or inline, crossline", called(&layout).join(", ")),
            example: example_of(&layout),
        });
    }
    let last = layout.columns.iter().rposition(|&c| c != Column::Other).unwrap_or(0);
    let mut by_name: IndexMap<Option<String>, Vec<RawPoint>> = IndexMap::new();
    let mut separators = 0usize;
    let mut breaks = 0.0;
    let mut polygons = HashMap::new();
    let mut misplaced = 0_usize;
    for line in rows {
        let mut fields = cut.fields(line.text);
        if is_separator(&fields, cut) {
            separators += 1;
            breaks += 1.0;
            continue;
        }
        if let Some(delimiter) = cut.delimiter.filter(|delimiter| line.text.ends_with(*delimiter)) {
            // Cells at the end of a line are empty.
            let cells = 1 + line.text.matches(delimiter).count();
            fields.resize(cells.max(fields.len()), Field { text: "", quoted: false });
        }
        let is_place = |c: &Column| matches!(c, Column::X | Column::Y | Column::Inline | Column::Crossline);
        let lacks_place = fields.iter().zip(&layout.columns).any(|(f, c)| is_place(c) && number::is_missing(f.text));
        if fields.len() > last && lacks_place {
            misplaced += 1;
            continue;
        }
        if fields.len() <= last {
            let expected = format!("at least {} fields", last + 1);
            return Err(source.syntax(line.number, expected, line.text));
        }
        let (name, mut point) = point_of(source, line, &fields, cut, &layout.columns, &mut polygons)?;
        if separators > 0 || context.kind == super::SurfaceKind::Fault {
            point.stick = point.stick.or((separators > 0).then_some(breaks));
        }
        by_name.entry(name).or_default().push(point);
    }
    if separators > 0 {
        // Points before the first separator belong to the first part.
        by_name.values_mut().flatten().for_each(|p| p.stick = p.stick.or(Some(0.0)));
    }
    if misplaced > 0 {
        layout.notes.push(format!("{misplaced} rows have no place and were left out"));
    }
    let vertical = VerticalFacts { unit: layout.unit, domain: layout.domain, positive: layout.positive };
    Ok(by_name
        .into_iter()
        .map(|(name, points)| RawSurface {
            vertical: vertical.clone(),
            horizontal: layout.horizontal.clone(),
            notes: layout.notes.clone(),
            ..RawSurface::new(name, RawShape::Points(points))
        })
        .collect())
}

/// Most surfaces that a column tells apart, and fewest points of each on average.
const MOST_LEVELS: usize = 64;
const POINTS_OF_LEVEL: usize = 3;

/// What the name of a column begins with, or one of its words, where it tells surfaces apart.
const TELLING: [&str; 20] = [
    "strat", "form", "surf", "horiz", "layer", "marker", "lith", "feature", "unit", "zone", "series", "sequence",
    "event", "object", "label", "group", "bed", "schicht", "couche", "capa",
];

/// Whether the columns that may name a surface, or number it, tell surfaces apart: few words or numbers, each of many rows.
/// Where rows have names, numbers are levels of them, unless there is one alone for each name.
fn settle_names(rows: &[Line<'_>], cut: LineCut, layout: &mut ColumnLayout) {
    let find = |layout: &ColumnLayout, wanted| layout.columns.iter().position(|column| *column == wanted);
    if let Some(at) = find(layout, Column::Level).filter(|&at| !holds_numbers(rows, cut, at)) {
        layout.columns[at] = Column::Other;
        name_by(at, rows, cut, layout, true);
    }
    for at in 0..layout.columns.len().min(layout.names.len()) {
        let name = layout.names[at].to_lowercase();
        let is_telling = name
            .split(|c: char| !c.is_alphanumeric())
            .any(|word| matches!(word, "fm" | "top" | "pick") || TELLING.iter().any(|stem| word.starts_with(stem)));
        match (layout.columns[at], holds_numbers(rows, cut, at)) {
            (Column::Other, false) => name_by(at, rows, cut, layout, is_telling),
            (Column::Other, true) if is_telling && find(layout, Column::Level).is_none() => {
                layout.columns[at] = Column::Level;
            }
            _ => {}
        }
    }
    let Some(at) = find(layout, Column::Level) else { return };
    let named = find(layout, Column::Name);
    let pairs = words_of(rows, cut, &[named, Some(at)]);
    let names: HashSet<&str> = pairs.keys().map(|pair| pair[0]).collect();
    if !(pairs.len() > names.len() && are_few(pairs.len(), rows.len())) {
        layout.columns[at] = Column::Other;
    } else if named.is_none() {
        let levels: HashSet<&str> = pairs.keys().map(|pair| pair[1]).collect();
        layout.notes.push(format!("a column of {} numbers tells its surfaces apart", levels.len()));
    }
}

/// Takes a column of words as names, where they are few and none is known; what is not taken is said.
fn name_by(at: usize, rows: &[Line<'_>], cut: LineCut, layout: &mut ColumnLayout, is_telling: bool) {
    if layout.columns.contains(&Column::Name) {
        return;
    }
    let found = words_of(rows, cut, &[Some(at)]);
    let mut words: Vec<&str> = found.keys().map(|word| word[0]).filter(|word| !number::is_missing(word)).collect();
    if words.len() < 2 || !are_few(words.len(), rows.len()) || words.iter().any(|w| columns::quality_of(w).is_some()) {
        return;
    }
    words.sort_unstable();
    words.truncate(4);
    let (column, words) = (layout.names.get(at).map_or("", String::as_str), words.join(", "));
    if is_telling {
        layout.notes.push(format!("the column '{column}' tells its surfaces apart: {words}"));
        layout.columns[at] = Column::Name;
    } else {
        let mut stated = layout.columns.clone();
        stated[at] = Column::Name;
        let stated = ColumnLayout { columns: stated, ..layout.clone() };
        layout.notes.push(format!(
            "the words of the column '{column}' ({words}) are not read; where they are names of surfaces, state the columns as {}",
            example_of(&stated)
        ));
    }
}

/// Whether so many surfaces are few for so many rows.
fn are_few(surfaces: usize, rows: usize) -> bool {
    surfaces <= MOST_LEVELS && rows >= POINTS_OF_LEVEL * surfaces
}

/// Whether a column has numbers alone, and missing values.
fn holds_numbers(rows: &[Line<'_>], cut: LineCut, at: usize) -> bool {
    rows.iter().step_by((rows.len() / 2000).max(1)).all(|line| {
        let fields = cut.fields(line.text);
        fields.get(at).is_none_or(|field| !field.quoted && cut.value(field.text).is_some())
    })
}

/// What stands in some columns together, and how often; more than [`MOST_LEVELS`] are not counted.
fn words_of<'a>(rows: &[Line<'a>], cut: LineCut, columns: &[Option<usize>]) -> HashMap<Vec<&'a str>, usize> {
    let mut found: HashMap<Vec<&str>, usize> = HashMap::new();
    for line in rows {
        let fields = cut.fields(line.text);
        let text = |at: &Option<usize>| at.and_then(|at| fields.get(at)).map_or("", |field| field.text);
        *found.entry(columns.iter().map(text).collect()).or_default() += 1;
        if found.len() > MOST_LEVELS {
            break;
        }
    }
    found
}

/// The columns as the file calls them, otherwise what they are.
fn called(layout: &ColumnLayout) -> Vec<String> {
    let kinds = || layout.columns.iter().map(|c| format!("{c:?}").to_lowercase()).collect();
    if layout.names.len() == layout.columns.len() { layout.names.clone() } else { kinds() }
}

/// A list of columns that reads the file: its own, with one that is not known as Z: the last whose name has a word for depth
/// or time in it, otherwise the last.
fn example_of(layout: &ColumnLayout) -> String {
    let columns = &layout.columns;
    let mut words: Vec<String> = columns
        .iter()
        .map(|c| if *c == Column::Other { "-".to_owned() } else { format!("{c:?}").to_lowercase() })
        .collect();
    let has = |c| columns.contains(&c);
    let is_unknown = |n: &usize| columns[*n] == Column::Other;
    let is_vertical = |n: &usize| {
        let name = layout.names.get(*n).map_or("", String::as_str);
        name.split(|c: char| !c.is_alphanumeric()).any(|word| column::of_name(word).column == Column::Z)
    };
    let unknown = || (0..columns.len()).rev().filter(is_unknown);
    if !has(Column::Z)
        && let Some(vertical) = unknown().find(is_vertical).or(unknown().next())
    {
        words[vertical] = "z".to_owned();
    }
    let placed = (has(Column::X) && has(Column::Y)) || (has(Column::Inline) && has(Column::Crossline));
    if placed && words.contains(&"z".to_owned()) { words.join(",") } else { "x,y,z".to_owned() }
}

/// RMS ends each part of a points file with a row of three 999.0.
fn is_separator(fields: &[Field<'_>], cut: LineCut) -> bool {
    fields.len() == 3 && fields.iter().all(|f| cut.number(f.text) == Some(999.0))
}

/// The name and the point of a row. Polygons are numbered as they appear: each is a surface of its own, or, where rows
/// have a name, a stick of the surface of that name.
fn point_of(
    source: &SourceFile,
    line: &Line<'_>,
    fields: &[Field<'_>],
    cut: LineCut,
    columns: &[Column],
    polygons: &mut HashMap<String, f64>,
) -> Result<(Option<String>, RawPoint), FormatError> {
    let (mut inline, mut crossline, mut x, mut y) = (None, None, None, None);
    let (mut name, mut polygon) = (None, None);
    let mut normal = DVec3::NAN;
    let (mut level, mut dip) = (None, [f64::NAN, f64::NAN, 1.0]);
    let mut point = RawPoint { z: f64::NAN, ..RawPoint::default() };
    for (field, column) in fields.iter().zip(columns) {
        let finite = |what: &str| {
            cut.number(field.text)
                .filter(|v| v.is_finite())
                .ok_or_else(|| source.syntax(line.number, format!("a number for the {what}"), field.text))
        };
        let measured = |what: &str| {
            let value = cut.value(field.text);
            value.ok_or_else(|| source.syntax(line.number, format!("a number for the {what}"), field.text))
        };
        match column {
            Column::Inline => inline = Some(finite("inline")?),
            Column::Crossline => crossline = Some(finite("crossline")?),
            Column::X => x = Some(finite("X")?),
            Column::Y => y = Some(finite("Y")?),
            Column::Z => {
                let value = cut.value(field.text);
                let value = value.ok_or_else(|| source.syntax(line.number, "a number for Z", field.text))?;
                point.z = if value.abs() < number::UNDEFINED { value } else { f64::NAN };
            }
            Column::Name => name = Some(field.text.to_string()),
            Column::Stick => point.stick = Some(finite("stick")?),
            Column::Polygon => {
                let next = polygons.len() as f64;
                point.stick = Some(*polygons.entry(field.text.to_string()).or_insert(next));
                polygon = Some(field.text.to_string());
            }
            Column::Node => point.node = Some(finite("node")?),
            Column::Sheet => point.sheet = Some(finite("sheet")?),
            Column::Nx => normal.x = measured("normal")?,
            Column::Ny => normal.y = measured("normal")?,
            Column::Nz => normal.z = measured("normal")?,
            Column::Level => level = cut.number(field.text).filter(|v| v.is_finite()).map(|v| v.to_string()),
            Column::Dip => dip[0] = measured("dip")?,
            Column::Azimuth => dip[1] = measured("azimuth")?,
            Column::Polarity => dip[2] = measured("polarity")?,
            Column::Quality => point.quality = columns::quality_of(field.text),
            Column::Other => {}
        }
    }
    point.lines = inline.zip(crossline).map(|(a, b)| DVec2::new(a, b));
    // Beyond any coordinate system the arithmetic would overflow.
    if let Some(far) = [inline, crossline, x, y].into_iter().flatten().find(|v| v.abs() > 1e12) {
        return Err(source.syntax(line.number, "a coordinate below 1e12", &far.to_string()));
    }
    point.normal = normal.is_finite().then_some(normal);
    point.dip = dip.iter().all(|v| v.is_finite()).then_some(dip);
    point.xy = x.zip(y).map(|(a, b)| DVec2::new(a, b));
    let named = match (name, level) {
        (Some(name), Some(level)) => Some(format!("{name} {level}")),
        (name, level) => name.or(level),
    };
    Ok((named.or(polygon), point))
}

/// The columns the user gave, the header's, or those that fit the survey.
pub(super) fn settle_columns(
    source: &SourceFile,
    context: &ReadContext<'_>,
    header: Option<ColumnLayout>,
    rows: &[Line<'_>],
    cut: LineCut,
) -> Result<ColumnLayout, FormatError> {
    if let Some(columns) = &context.options.columns {
        return Ok(ColumnLayout::plain(columns.clone()));
    }
    let (numbers, named) = sample_rows(rows, cut);
    match header {
        Some(mut layout) => {
            // OpendTect's bulk export puts a name before the columns that its header lists.
            let width = rows.first().map_or(0, |line| cut.fields(line.text).len());
            if named && !layout.columns.contains(&Column::Name) && width == layout.columns.len() + 1 {
                layout.columns.insert(0, Column::Name);
                layout.names.insert(0, "name".to_owned());
            }
            Ok(layout)
        }
        None => columns::by_fit(source, context, &numbers, named),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_cut_is_seen_in_the_line() {
        assert_eq!(LineCut::of_line("1;2;3").delimiter, Some(';'));
        assert_eq!(LineCut::of_line("1, 2, 3").delimiter, Some(','));
        assert_eq!(LineCut::of_line("1 2\t3").delimiter, None);
        let german = LineCut::of_line("1,5;2,25;3");
        assert_eq!(german.number("2,25"), Some(2.25));
        assert_eq!(LineCut::of_line("456.000,5;6.000.123;1.234").number("1.234"), Some(1234.0));
        assert_eq!(LineCut::of_line("456000,5 6000123,25 -1234,5").number("-1234,5"), Some(-1234.5));
        assert_eq!(LineCut::of_line("1,5").delimiter, Some(','));
    }
}
