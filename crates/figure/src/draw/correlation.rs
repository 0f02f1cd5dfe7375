//! Wells side by side on a page: patterns of layers, curves, tops, and lines from well to well.
//!
//! Columns stand equally far apart, whatever lies between their heads; the distance is written between them. Each
//! surface is named once, at the rightmost well that meets it.

use super::axes::{self, Axis};
use super::words::broken;
use super::{NamedColour, swatch};
use crate::correlation::{Column, LogCurve, Marker, place_of_layer, place_of_surface};
use crate::error::FigureError;
use crate::style::{
    FRAME_PT, HORIZON_PT, INK, NUMBER_PT, QUIET_INK, RIM_OPACITY, RULE_INK, TEXT_PT, TITLE_PT, horizon_colour,
};
use glam::DVec2;
use page::Rect;
use page::list::{Across, Group, GroupKind, Ink, Item, Path, PathItem, Stroke, Text, Upright};
use ttf::{Colour, LayerStyle, TextureLibrary};

/// Least and largest width of a column of layers, and of a curve beside it, points.
const TRACK_PT: [f64; 2] = [9.0, 30.0];
const LOG_PT: [f64; 2] = [9.0, 34.0];
/// Share of the width that columns and curves may take; the rest lies between wells.
const TRACKS_SHARE: f64 = 0.6;
/// Height of the rows above the columns: the wells' names, their datums, names and ranges of curves, points.
const ROWS_PT: [f64; 3] = [13.0, 9.5, 19.0];
/// Opacity of layers between wells.
const BETWEEN: f32 = 0.4;
/// Dashes of what is not known from tops, points.
const DASHES_PT: [f64; 2] = [4.0, 2.5];
/// From one name of a surface to the next, as a share of the size of its letters.
const PITCH: f64 = 1.25;
/// Size of the names of surfaces, points, and the lines that one may take where there is little room.
const NAME_PT: f64 = TEXT_PT - 0.5;
const MOST_LINES: usize = 5;
/// Between a column and the names beside it, points.
const ASIDE_PT: f64 = 7.0;
/// Colours of curves, in their order.
const CURVES: [Colour; 3] =
    [Colour::new(0x1d, 0x6f, 0x42), Colour::new(0x9c, 0x1f, 0x2e), Colour::new(0x1f, 0x4e, 0x9c)];
/// Values beyond these shares of a curve's samples do not widen its scale: single spikes are no signal.
const SCALE: [f64; 2] = [0.005, 0.995];

/// Wells side by side.
pub(crate) struct CorrelationPanel<'a> {
    /// The wells from left to right.
    pub columns: &'a [Column],
    /// How layers are drawn, youngest first, and the library with their patterns.
    pub layers: &'a [LayerStyle],
    /// Patterns; without them layers are their colours.
    pub library: Option<&'a TextureLibrary>,
    /// Colours of horizons, youngest first.
    pub horizons: &'a [NamedColour],
    /// What the axis counts: "Depth (m)".
    pub axis: String,
    /// First and last value of the axis.
    pub range: [f64; 2],
    /// Whether what must be known to read it stands below; its words.
    pub caption: Option<String>,
    /// Dots an inch of patterns without a drawing.
    pub dpi: f64,
}

/// Where things of the panel stand.
struct Layout {
    /// Below the rows with names.
    body: Rect,
    /// Left ends of the columns.
    left: Vec<f64>,
    track: f64,
    log: f64,
    range: [f64; 2],
}

impl Layout {
    fn y(&self, value: f64) -> f64 {
        let [from, to] = self.range;
        self.body.min.y + (value - from) / (to - from) * self.body.height()
    }

    /// The column of layers of a well.
    fn track(&self, well: usize) -> [f64; 2] {
        [self.left[well], self.left[well] + self.track]
    }

    /// The right end of a well's last curve.
    fn right(&self, well: usize, logs: usize) -> f64 {
        self.left[well] + self.track + self.log * logs as f64
    }
}

impl CorrelationPanel<'_> {
    /// The panel in its room; without items where there is too little of it.
    ///
    /// # Errors
    /// A pattern that does not draw.
    pub(crate) fn drawn(&self, room: Rect) -> Result<Group, FigureError> {
        let mut group = Group::new(GroupKind::Panel, "correlation");
        let mut down = Axis { name: self.axis.clone(), ends: self.range, at: [0.0; 2], least_step: 0.0 };
        let surfaces = self.surfaces();
        let beside_last = surfaces.iter().filter(|(_, well)| well + 1 == self.columns.len());
        let longest = beside_last.map(|(surface, _)| label(&surface.name).width()).fold(0.0, f64::max);
        let logs = self.logs();
        let rows = ROWS_PT[0] + ROWS_PT[1] + if logs > 0 { ROWS_PT[2] } else { 3.0 };
        let below = if self.caption.is_some() { 13.0 } else { 2.0 };
        let names = (longest + ASIDE_PT + 2.0).min(0.3 * room.width());
        let body = room.inside([axes::left_margin(&down), rows, 2.0, below]);
        let Some(layout) = self.layout(body, names, logs).filter(|_| body.is_proper()) else { return Ok(group) };
        down.at = [body.min.y, body.max.y];
        let across = Axis { name: String::new(), ends: [0.0; 2], at: [body.min.x, body.max.x], least_step: 1.0 };
        let mut inside = Group::new(GroupKind::Part, "wells").clipped(Path::rect(body));
        self.layers_between(&layout, logs).into_iter().for_each(|layer| inside.push(layer));
        self.lines_between(&layout, logs, &surfaces).into_iter().for_each(|lines| inside.push(lines));
        for well in 0..self.columns.len() {
            inside.push(self.well(&layout, well, logs)?);
        }
        group.push(inside);
        group.push(axes::drawn(Rect::new(room.min, body.max), body, [&across, &down]));
        group.push(self.names(&layout, logs, &surfaces));
        group.push(self.heads(&layout, room, logs));
        if let Some(caption) = &self.caption {
            let at = DVec2::new(body.min.x, body.max.y + 6.0);
            let text =
                Text::new(at, caption).sized(NUMBER_PT).inked(QUIET_INK).anchored(Across::Start, Upright::Middle);
            group.push(Group::new(GroupKind::Annotation, "caption").with([text.fitted(body.width()).into()]));
        }
        Ok(group)
    }

    fn logs(&self) -> usize {
        self.columns.iter().map(|column| column.logs.len()).max().unwrap_or(0)
    }

    /// Where columns stand in a room, `names` of which is kept free at the right; `None` where there is too little.
    fn layout(&self, body: Rect, names: f64, logs: usize) -> Option<Layout> {
        let count = self.columns.len() as f64;
        let room = body.width() - names - ASIDE_PT;
        let unit = TRACK_PT[1] + LOG_PT[1] * logs as f64;
        let share = (TRACKS_SHARE * room / (count * unit)).min(1.0);
        let (track, log) = (share * TRACK_PT[1], share * LOG_PT[1]);
        if track < TRACK_PT[0] || log < LOG_PT[0] && logs > 0 {
            return None;
        }
        let unit = share * unit;
        let step = if self.columns.len() > 1 { (room - unit) / (count - 1.0) } else { 0.0 };
        let left = (0..self.columns.len()).map(|well| body.min.x + ASIDE_PT + step * well as f64).collect();
        Some(Layout { body, left, track, log, range: self.range })
    }

    /// Every surface that is met, with the rightmost well that meets it, from top to bottom.
    fn surfaces(&self) -> Vec<(Marker, usize)> {
        let mut found: Vec<(Marker, usize)> = Vec::new();
        for (well, column) in self.columns.iter().enumerate().rev() {
            for marker in &column.markers {
                let is_known = found.iter().any(|(known, _)| known.name == marker.name);
                let at = marker.z - column.shift;
                if !is_known && (self.range[0]..=self.range[1]).contains(&at) {
                    found.push((marker.clone(), well));
                }
            }
        }
        found.sort_by(|a, b| (a.1, a.0.z).partial_cmp(&(b.1, b.0.z)).unwrap_or(std::cmp::Ordering::Equal));
        found
    }

    fn colour(&self, surface: &Marker) -> Colour {
        match surface.horizon {
            Some(horizon) => horizon_colour(self.horizons.get(horizon).map(|known| known.colour), horizon),
            None => QUIET_INK,
        }
    }

    /// The layers between neighbouring wells, pale, a group for each.
    fn layers_between(&self, layout: &Layout, logs: usize) -> Vec<Group> {
        let mut groups = Vec::new();
        for (layer, style) in self.layers.iter().enumerate() {
            let mut group = Group::new(GroupKind::Layer, &style.layer);
            for (well, pair) in self.columns.windows(2).enumerate() {
                let is_own = |column: &Column| column.intervals.iter().any(|interval| interval.layer == layer);
                let (left, right) = (place_of_layer(&pair[0], layer), place_of_layer(&pair[1], layer));
                let (Some(left), Some(right), true) = (left, right, pair.iter().any(is_own)) else { continue };
                let x = [layout.right(well, logs), layout.left[well + 1]];
                let corner = |side: usize, value: f64| DVec2::new(x[side], layout.y(value));
                let area = [corner(0, left[0]), corner(1, right[0]), corner(1, right[1]), corner(0, left[1])];
                group.push(PathItem::filled(Path::polygon(&area), Ink::glass(style.colour, BETWEEN)));
            }
            groups.push(group);
        }
        groups.retain(|group| !group.items.is_empty());
        groups
    }

    /// The lines of surfaces from well to well, a group for each.
    fn lines_between(&self, layout: &Layout, logs: usize, surfaces: &[(Marker, usize)]) -> Vec<Group> {
        let line = |(surface, _): &(Marker, usize)| {
            let mut group = Group::new(GroupKind::Horizon, &surface.name);
            for (well, pair) in self.columns.windows(2).enumerate() {
                let [left, right] = [0, 1].map(|side| place_of_surface(&pair[side], surface));
                let (Some((left, is_left)), Some((right, is_right))) = (left, right) else { continue };
                if !(is_left || is_right) {
                    continue;
                }
                let ends = [
                    DVec2::new(layout.right(well, logs), layout.y(left)),
                    DVec2::new(layout.left[well + 1], layout.y(right)),
                ];
                let is_known = is_left && is_right && !pair.iter().any(|column| column.is_prognosis);
                group.push(PathItem::stroked(Path::line(&ends), self.stroke(surface, is_known)));
            }
            group
        };
        surfaces.iter().map(line).filter(|group| !group.items.is_empty()).collect()
    }

    fn stroke(&self, surface: &Marker, is_known: bool) -> Stroke {
        let width = if surface.horizon.is_some() { 0.8 * HORIZON_PT } else { FRAME_PT };
        let stroke = Stroke::new(width, self.colour(surface));
        if is_known { stroke } else { stroke.dashed(DASHES_PT[0], DASHES_PT[1]) }
    }

    /// A well: its layers, its tops across all its tracks, and its curves.
    fn well(&self, layout: &Layout, well: usize, logs: usize) -> Result<Group, FigureError> {
        let column = &self.columns[well];
        let mut group = Group::new(GroupKind::Well, &column.name);
        let y = |z: f64| layout.y(z - column.shift);
        let [left, right] = layout.track(well);
        let span = Rect::new(DVec2::new(left, y(column.span[0])), DVec2::new(right, y(column.span[1])));
        group.push(PathItem::filled(
            Path::rect(Rect::new(span.min, DVec2::new(layout.right(well, logs), span.max.y))),
            Colour::WHITE,
        ));
        for interval in &column.intervals {
            let [top, base] = interval.z.map(y);
            let rect =
                Rect::new(DVec2::new(left, top.max(layout.body.min.y)), DVec2::new(right, base.min(layout.body.max.y)));
            let Some(style) = self.layers.get(interval.layer).filter(|_| rect.is_proper()) else { continue };
            let items = match self.library {
                Some(library) => swatch::shown(style, library, rect, self.dpi)?,
                None => vec![PathItem::filled(Path::rect(rect), style.colour).into()],
            };
            group.push(Group::new(GroupKind::Layer, &style.layer).with(items));
        }
        group.push(PathItem::stroked(Path::rect(span), Stroke::new(FRAME_PT, INK)));
        for (n, log) in column.logs.iter().enumerate() {
            let left = right + layout.log * n as f64;
            let track = Rect::new(DVec2::new(left, span.min.y), DVec2::new(left + layout.log, span.max.y));
            group.push(self.log(layout, column, log.as_ref().zip(self.scale(n)), track, CURVES[n % CURVES.len()]));
        }
        for marker in &column.markers {
            let ends = [left, layout.right(well, logs)].map(|x| DVec2::new(x, y(marker.z)));
            let stroke = self.stroke(marker, !column.is_prognosis);
            let rim = Stroke::new(stroke.width + 1.0, Ink::glass(Colour::WHITE, RIM_OPACITY));
            group.push(PathItem::stroked(Path::line(&ends), rim));
            group.push(PathItem::stroked(Path::line(&ends), stroke));
        }
        Ok(group)
    }

    /// A curve in its track, with its frame.
    fn log(
        &self,
        layout: &Layout,
        column: &Column,
        log: Option<(&LogCurve, [f64; 2])>,
        track: Rect,
        colour: Colour,
    ) -> Group {
        let mut group =
            Group::new(GroupKind::Data, log.map_or("curve", |(log, _)| &log.name)).clipped(Path::rect(track));
        let mut grid = Path::default();
        for share in [0.25, 0.5, 0.75] {
            let x = track.min.x + share * track.width();
            grid.add_line(&[DVec2::new(x, track.min.y), DVec2::new(x, track.max.y)]);
        }
        group.push(PathItem::stroked(grid, Stroke::new(0.25, Ink::glass(RULE_INK, 0.6))));
        if let Some((log, [low, high])) = log {
            let place = |(z, value): &(f64, f32)| {
                let share = (f64::from(*value) - low) / (high - low);
                DVec2::new(track.min.x + share * track.width(), layout.y(z - column.shift))
            };
            let places: Vec<DVec2> = log.samples.iter().map(place).collect();
            group.push(PathItem::stroked(Path::line(&thinned(&places)), Stroke::new(0.55, colour).round()));
        }
        group.push(PathItem::stroked(Path::rect(track), Stroke::new(FRAME_PT, QUIET_INK)));
        group
    }

    /// The scale that a curve has in all wells: the least and the largest value without single spikes.
    fn scale(&self, log: usize) -> Option<[f64; 2]> {
        let curves = self.columns.iter().filter_map(|column| column.logs.get(log)?.as_ref());
        let mut values: Vec<f32> = curves.flat_map(|curve| curve.samples.iter().map(|(_, value)| *value)).collect();
        values.sort_by(f32::total_cmp);
        let at = |share: f64| values.get((share * values.len().saturating_sub(1) as f64).round() as usize);
        let [low, high] = [f64::from(*at(SCALE[0])?), f64::from(*at(SCALE[1])?)];
        if low >= high {
            return Some([low - 1.0, low + 1.0]);
        }
        let step = axes::round_step((high - low) / 20.0);
        Some([(low / step).floor() * step, (high / step).ceil() * step])
    }

    /// The names of surfaces, beside the rightmost well that meets each, none over another.
    fn names(&self, layout: &Layout, logs: usize, surfaces: &[(Marker, usize)]) -> Group {
        let mut group = Group::new(GroupKind::Annotation, "tops");
        let mut taken: Vec<(usize, f64)> = Vec::new();
        for (surface, well) in surfaces {
            let x = layout.right(*well, logs);
            let room = layout.left.get(well + 1).map_or(layout.body.max.x, |next| next - 2.0) - x - ASIDE_PT;
            let lines = broken(&surface.name, NAME_PT, room, MOST_LINES);
            let lines: Vec<Text> = lines.iter().map(|line| label(line).fitted(room)).collect();
            let pitch = PITCH * lines.iter().map(|line| line.size).fold(0.0, f64::max);
            let half = 0.5 * pitch * lines.len() as f64;
            let meant = layout.y(surface.z - self.columns[*well].shift);
            let own = taken.iter().filter(|(other, _)| other == well);
            let over = own.map(|(_, bottom)| bottom + half).fold(meant, f64::max);
            if lines.iter().all(|line| line.text.is_empty()) || over + half > layout.body.max.y {
                continue;
            }
            taken.push((*well, over + half));
            let (foot, head) = (DVec2::new(x, meant), DVec2::new(x + ASIDE_PT - 1.5, over));
            let stroke = Stroke::new(FRAME_PT, self.colour(surface));
            group.push(PathItem::stroked(Path::line(&[foot, head]), stroke));
            for (n, line) in lines.into_iter().enumerate() {
                let at = DVec2::new(x + ASIDE_PT, over - half + pitch * (n as f64 + 0.5));
                group.push(Text { at, ..line }.haloed(1.0, Ink::glass(Colour::WHITE, 0.85)));
            }
        }
        group
    }

    /// Above the columns: the wells' names, heights of their datums, the distance to the next, and the curves' scales.
    fn heads(&self, layout: &Layout, room: Rect, logs: usize) -> Group {
        let mut group = Group::new(GroupKind::Annotation, "heads of wells");
        let unit = layout.right(0, logs) - layout.left[0];
        let step = layout.left.get(1).map_or(layout.body.width(), |next| next - layout.left[0]);
        for (well, column) in self.columns.iter().enumerate() {
            let middle = layout.left[well] + 0.5 * unit;
            let centred = |text: Text, y: f64, most: f64| {
                let text = text.fitted(most);
                let half = 0.5 * text.width();
                let x = middle.clamp(room.min.x + half, (room.max.x - half).max(room.min.x + half));
                Text { at: DVec2::new(x, y), ..text }.anchored(Across::Middle, Upright::Baseline)
            };
            let name = Text::new(DVec2::ZERO, &column.name).sized(TITLE_PT).inked(INK);
            group.push(centred(name, room.min.y + TITLE_PT, 0.72 * step));
            let datum = format!("KB {} m", (10.0 * column.datum_m).round() / 10.0);
            let small = |text: String| Text::new(DVec2::ZERO, text).sized(NUMBER_PT).inked(QUIET_INK);
            let second = room.min.y + ROWS_PT[0] + NUMBER_PT;
            let datum = centred(small(datum), second, 0.5 * step);
            if let Some(next) = self.columns.get(well + 1) {
                let distance = super::scale::length_text((column.head.distance(next.head) / 10.0).round() * 10.0);
                let text = small(distance).anchored(Across::Middle, Upright::Baseline);
                let at = DVec2::new(0.5 * (layout.right(well, logs) + layout.left[well + 1]), second);
                let text = Text { at, ..text };
                let gap = layout.left[well + 1] - layout.right(well, logs) - (datum.width() - unit).max(0.0);
                if text.width() + 6.0 <= gap {
                    group.push(text);
                }
            }
            group.push(datum);
            for (n, log) in column.logs.iter().enumerate() {
                let (Some(log), Some(scale)) = (log, self.scale(n)) else { continue };
                let left = layout.left[well] + layout.track + layout.log * n as f64;
                group.items.extend(scale_items(
                    log,
                    scale,
                    [left, left + layout.log],
                    layout.body.min.y,
                    CURVES[n % CURVES.len()],
                ));
            }
        }
        group
    }
}

/// The name of a curve over its scale's ends.
fn scale_items(log: &LogCurve, scale: [f64; 2], x: [f64; 2], bottom: f64, colour: Colour) -> Vec<Item> {
    let width = x[1] - x[0];
    let named = |text: &str| {
        let text = Text::new(DVec2::new(0.5 * (x[0] + x[1]), bottom - 10.5), text).sized(NUMBER_PT).inked(colour);
        text.anchored(Across::Middle, Upright::Baseline)
    };
    let whole = named(&format!("{} ({})", log.name, log.unit));
    let name = if log.unit.is_empty() || whole.width() > width - 1.0 { named(&log.name) } else { whole };
    let mut items = vec![name.fitted(width - 1.0).into()];
    let number = |value: f64, at: f64, across: Across| {
        let said = format!("{}", (1000.0 * value).round() / 1000.0);
        let text = Text::new(DVec2::new(at, bottom - 2.5), said).sized(NUMBER_PT);
        text.inked(QUIET_INK).anchored(across, Upright::Baseline)
    };
    let ends = [number(scale[0], x[0] + 0.5, Across::Start), number(scale[1], x[1] - 0.5, Across::End)];
    if ends.iter().map(Text::width).sum::<f64>() + 2.5 <= width {
        items.extend(ends.map(Item::from));
    }
    items
}

fn label(name: &str) -> Text {
    Text::new(DVec2::ZERO, name).sized(NAME_PT).inked(INK).anchored(Across::Start, Upright::Middle)
}

/// A line with no more than four places in each third of a point down: where a curve comes in, its extremes, and where
/// it leaves.
fn thinned(places: &[DVec2]) -> Vec<DVec2> {
    let row = |place: &DVec2| (place.y * 3.0).floor();
    let mut kept = Vec::new();
    for part in places.chunk_by(|a, b| row(a) == row(b)) {
        if part.len() <= 4 {
            kept.extend_from_slice(part);
            continue;
        }
        let by_x = |a: &(usize, &DVec2), b: &(usize, &DVec2)| a.1.x.total_cmp(&b.1.x);
        let extremes = [part.iter().enumerate().min_by(by_x), part.iter().enumerate().max_by(by_x)];
        let mut chosen: Vec<usize> = extremes.into_iter().flatten().map(|(n, _)| n).collect();
        chosen.extend([0, part.len() - 1]);
        chosen.sort_unstable();
        chosen.dedup();
        kept.extend(chosen.into_iter().map(|n| part[n]));
    }
    kept
}

#[cfg(test)]
mod tests;
