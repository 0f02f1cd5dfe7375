//! The legend: layers with their patterns, or horizons with their colours, youngest on top.

use super::{NamedColour, swatch};
use crate::error::FigureError;
use crate::style::{FRAME_PT, HORIZON_PT, INK, LEAST_TEXT_PT, TEXT_PT};
use glam::DVec2;
use page::Rect;
use page::list::{Across, Group, GroupKind, Path, PathItem, Stroke, Text, Upright, width_of};
use ttf::{LayerStyle, TextureLibrary};

/// Width and height of a swatch, points.
const SWATCH_PT: [f64; 2] = [30.0, 17.0];
/// From one swatch to the next, and from one line to the next, points.
const PITCH_PT: [f64; 2] = [22.5, 14.0];
/// Between a swatch and its name, points.
const GAP_PT: f64 = 6.0;
/// Least room for names, points, and for names in several columns, where they may be shortened.
const LEAST_NAME_PT: f64 = 36.0;
const SHORT_NAME_PT: f64 = 64.0;
/// Between columns, points.
const COLUMN_GAP_PT: f64 = 10.0;
/// Size of letters as a share of the height of an entry.
const LETTERS: f64 = 0.9;
/// In so many steps entries are set closer.
const SHARES: u32 = 12;
/// Heights that differ by less are the same, points.
const ROUNDING_PT: f64 = 1e-6;

/// Between layers and horizons, points.
const PARAGRAPH_PT: f64 = 9.0;

/// A line that a legend explains.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct LegendLine {
    /// What it stands for.
    pub name: String,
    /// What kind of thing that is.
    pub kind: GroupKind,
    /// How it is drawn.
    pub stroke: Stroke,
    /// How it stands in its place.
    pub stand: Stand,
}

/// How a line stands in its place in a legend.
#[derive(Debug, Clone, PartialEq)]
pub enum Stand {
    /// Across it.
    Across,
    /// Upright, as wells do.
    Upright,
    /// Upright, with a stroke across, of half a length in points.
    Crossed(f64, Stroke),
}

impl LegendLine {
    /// A line with its name.
    pub(crate) fn new(name: &str, kind: GroupKind, stroke: Stroke) -> Self {
        Self { name: name.to_owned(), kind, stroke, stand: Stand::Across }
    }

    /// A well.
    pub(crate) fn well(name: &str, stroke: Stroke) -> Self {
        Self { stand: Stand::Upright, ..Self::new(name, GroupKind::Well, stroke) }
    }

    /// The tops of wells, with half the length of their mark in points, and how that is drawn.
    pub(crate) fn well_top(well: Stroke, (half, mark): (f64, Stroke)) -> Self {
        Self { stand: Stand::Crossed(half, mark), ..Self::well("Well top", well) }
    }
}

/// What a legend lists.
#[derive(Clone, Copy)]
pub(crate) struct Legend<'a> {
    /// Layers, and the library that has their patterns.
    pub layers: Option<(&'a [LayerStyle], &'a TextureLibrary)>,
    /// Horizons, below the layers.
    pub horizons: &'a [NamedColour],
    /// Other lines, below the horizons: faults, wells, contacts.
    pub lines: &'a [LegendLine],
    /// Dots an inch that patterns are drawn at.
    pub dpi: f64,
}

/// Where the entries of a legend stand.
struct Arranged {
    /// Column and top of each entry that is listed.
    places: Vec<(usize, f64)>,
    columns: usize,
    /// Their heights as a share of what they are in ample room.
    share: f64,
}

impl Legend<'_> {
    fn styles(&self) -> &[LayerStyle] {
        self.layers.map_or(&[], |(styles, _)| styles)
    }

    /// Whether there is nothing to list.
    pub(crate) fn is_empty(&self) -> bool {
        self.styles().is_empty() && self.horizons.is_empty() && self.lines.is_empty()
    }

    fn names(&self) -> impl Iterator<Item = &str> {
        let layers = self.styles().iter().map(|style| style.layer.as_str());
        let horizons = self.horizons.iter().map(|horizon| horizon.name.as_str());
        layers.chain(horizons).chain(self.lines.iter().map(|line| line.name.as_str()))
    }

    /// Width of a column that shows all names in letters of a size.
    fn column(&self, size_pt: f64) -> f64 {
        let longest = self.names().map(|name| width_of(name, size_pt)).fold(LEAST_NAME_PT, f64::max);
        SWATCH_PT[0] + GAP_PT + longest + 1.0
    }

    /// What is free above each entry, and its height, in ample room.
    fn heights(&self) -> Vec<[f64; 2]> {
        let layers = self.styles().len();
        let lines = self.horizons.len() + self.lines.len();
        let height = |n: usize| {
            let above = if n == layers && n > 0 { PARAGRAPH_PT } else { 0.0 };
            [above, PITCH_PT[usize::from(n >= layers)]]
        };
        (0..layers + lines).map(height).collect()
    }

    /// The entries one below the other in so many columns of a height, as far as they fit.
    fn packed(&self, height: f64, columns: usize, share: f64) -> Arranged {
        let (mut column, mut top) = (0, 0.0);
        let mut places = Vec::new();
        for [above, own] in self.heights().into_iter().map(|heights| heights.map(|height| share * height)) {
            if top > 0.0 && top + above + own > height + ROUNDING_PT {
                (column, top) = (column + 1, 0.0);
            }
            if column >= columns || own > height + ROUNDING_PT {
                break;
            }
            let above = if top > 0.0 { above } else { 0.0 };
            places.push((column, top + above));
            top += above + own;
        }
        Arranged { places, columns, share }
    }

    /// In as few columns as hold all entries in letters that can be read; otherwise as many entries as fit.
    fn arranged(&self, size: DVec2) -> Arranged {
        let count = self.heights().len();
        let least = LEAST_TEXT_PT / (LETTERS * self.tightest());
        let shares = || (0..=SHARES).map(|n| 1.0 - (1.0 - least) * f64::from(n) / f64::from(SHARES));
        let narrowest = self.column(LEAST_TEXT_PT).min(SWATCH_PT[0] + GAP_PT + SHORT_NAME_PT);
        let most = ((size.x + COLUMN_GAP_PT) / (narrowest + COLUMN_GAP_PT)).floor().max(1.0) as usize;
        let all = (1..=most).flat_map(|columns| shares().map(move |share| (columns, share)));
        let mut all = all.map(|(columns, share)| self.packed(size.y, columns, share));
        all.find(|arranged| arranged.places.len() == count).unwrap_or_else(|| self.packed(size.y, most, least))
    }

    /// The height of the lowest entries in ample room.
    fn tightest(&self) -> f64 {
        PITCH_PT[usize::from(!(self.horizons.is_empty() && self.lines.is_empty()))]
    }

    /// The width that shows all names in a room of this size: for one column no more than `most`, for several no more than
    /// half of the room.
    pub(crate) fn width(&self, room: DVec2, most: f64) -> f64 {
        let widest = 0.5 * room.x;
        let columns = self.arranged(DVec2::new(widest, room.y)).columns as f64;
        let wanted = self.column(TEXT_PT) * columns + COLUMN_GAP_PT * (columns - 1.0);
        wanted.min(if columns > 1.0 { widest } else { most })
    }

    /// Columns across a room of this width, and the height of the legend in them. All names stand in letters of full size,
    /// or, where that would be one column, in the smallest, without what stands in brackets.
    pub(crate) fn across(&self, width: f64) -> (usize, f64) {
        let short = self.names().map(|name| width_of(name.split(" (").next().unwrap_or(name), LEAST_TEXT_PT));
        let short = SWATCH_PT[0] + GAP_PT + short.fold(LEAST_NAME_PT, f64::max) + 1.0;
        let columns = |own: f64| ((width + COLUMN_GAP_PT) / (own + COLUMN_GAP_PT)).floor() as usize;
        let columns = match columns(self.column(TEXT_PT)) {
            0 | 1 => columns(short).clamp(1, 2),
            several => several,
        };
        let heights = self.heights();
        let all: f64 = heights.iter().flatten().sum();
        // From equal columns on, an entry is added to their height until they hold all.
        let least = (all / columns as f64).max(self.tightest());
        let tried = (0..=heights.len()).map(|n| self.packed(least + n as f64 * self.tightest(), columns, 1.0));
        let held = tried.into_iter().find(|arranged| arranged.places.len() == heights.len());
        let bottoms = held.iter().flat_map(|held| held.places.iter().zip(&heights)).map(|((_, top), own)| top + own[1]);
        (columns, bottoms.reduce(f64::max).unwrap_or(all))
    }

    /// The legend in its room; entries that do not fit stand closer, then in several columns. What has no room then is
    /// counted in the last line.
    ///
    /// # Errors
    /// A pattern that does not draw.
    pub(crate) fn drawn(&self, room: Rect) -> Result<Group, FigureError> {
        self.arranged_as(self.arranged(room.size()), room)
    }

    /// The legend in a room of the height and with the columns that [`Self::across`] found.
    ///
    /// # Errors
    /// A pattern that does not draw.
    pub(crate) fn drawn_across(&self, room: Rect, columns: usize) -> Result<Group, FigureError> {
        self.arranged_as(self.packed(room.height(), columns, 1.0), room)
    }

    fn arranged_as(&self, mut arranged: Arranged, room: Rect) -> Result<Group, FigureError> {
        let mut group = Group::new(GroupKind::Annotation, "legend");
        let left_out = self.heights().len() - arranged.places.len();
        let width = (room.width() + COLUMN_GAP_PT) / arranged.columns as f64 - COLUMN_GAP_PT;
        let share = arranged.share;
        let place = |(column, top): (usize, f64), pitch: f64| {
            let left = column as f64 * (width + COLUMN_GAP_PT);
            Rect::sized(room.min + DVec2::new(left, top), DVec2::new(width, share * pitch))
        };
        let size = self.size_pt(width, share);
        let more = if left_out > 0 { arranged.places.pop() } else { None };
        let horizons = self
            .horizons
            .iter()
            .map(|named| LegendLine::new(&named.name, GroupKind::Horizon, Stroke::new(1.5 * HORIZON_PT, named.colour)));
        let lines: Vec<LegendLine> = horizons.chain(self.lines.iter().cloned()).collect();
        let layers = self.styles().len();
        for (n, at) in arranged.places.iter().enumerate() {
            match self.layers.and_then(|(styles, library)| Some((styles.get(n)?, library))) {
                Some((style, library)) => group.push(layer(style, library, place(*at, PITCH_PT[0]), size, self.dpi)?),
                None => {
                    let entry = lines.get(n - layers).cloned();
                    group.items.extend(entry.map(|entry| line(entry, place(*at, PITCH_PT[1]), size).into()));
                }
            }
        }
        if let Some(at) = more {
            let place = place(at, self.tightest());
            let said = format!("and {} more", left_out + 1);
            group.push(name(&said, DVec2::new(place.min.x + SWATCH_PT[0], place.centre().y), place, size));
        }
        Ok(group)
    }

    /// Size of all names in a column of a width, points: that of the one which needs the smallest.
    fn size_pt(&self, width: f64, share: f64) -> f64 {
        let largest = (LETTERS * share * self.tightest()).clamp(LEAST_TEXT_PT, TEXT_PT);
        let room = width - SWATCH_PT[0] - GAP_PT;
        let fitted = |name: &str| Text::new(DVec2::ZERO, name).sized(largest).fitted(room).size;
        self.names().map(fitted).fold(largest, f64::min)
    }
}

/// An entry of a line in its place.
fn line(entry: LegendLine, place: Rect, size_pt: f64) -> Group {
    let [left, right] = [0.0, SWATCH_PT[0]].map(|off| DVec2::new(place.min.x + off, place.centre().y));
    let about = |half: DVec2| [left.lerp(right, 0.5) - half, left.lerp(right, 0.5) + half];
    let ends = match entry.stand {
        Stand::Across => [left, right],
        Stand::Upright | Stand::Crossed(..) => about(DVec2::new(0.0, 0.4 * place.height())),
    };
    let group = Group::new(entry.kind, &entry.name).with([PathItem::stroked(Path::line(&ends), entry.stroke).into()]);
    let mark = match entry.stand {
        Stand::Crossed(half, mark) => Some(PathItem::stroked(Path::line(&about(DVec2::new(half, 0.0))), mark).into()),
        _ => None,
    };
    group.with(mark).with([name(&entry.name, right, place, size_pt).into()])
}

/// An entry of a layer in its place: a row of the legend.
fn layer(
    style: &LayerStyle,
    library: &TextureLibrary,
    place: Rect,
    size_pt: f64,
    dpi: f64,
) -> Result<Group, FigureError> {
    let rect = Rect::sized(place.min, DVec2::new(SWATCH_PT[0], SWATCH_PT[1].min(0.8 * place.height())));
    let swatch = swatch::shown(style, library, rect, dpi)?;
    let middle = DVec2::new(rect.max.x, rect.centre().y);
    Ok(Group::new(GroupKind::Layer, &style.layer).with(swatch).with([
        PathItem::stroked(Path::rect(rect), Stroke::new(FRAME_PT, INK)).into(),
        name(&style.layer, middle, place, size_pt).into(),
    ]))
}

fn name(name: &str, beside: DVec2, room: Rect, size_pt: f64) -> Text {
    let at = beside + DVec2::new(GAP_PT, 0.0);
    let text = |name: &str| Text::new(at, name).sized(size_pt).anchored(Across::Start, Upright::Middle);
    let fitted = |name: &str| text(name).fitted(room.max.x - at.x);
    let whole = fitted(name);
    // What stands in brackets goes first.
    let short = name.split_once(" (").map(|(short, _)| fitted(short)).filter(|text| !text.text.ends_with('…'));
    if whole.text.ends_with('…') { short.unwrap_or(whole) } else { whole }
}

#[cfg(test)]
mod tests;
