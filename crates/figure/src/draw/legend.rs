//! The legend: layers with their patterns, or horizons with their colours, youngest on top.

use super::{NamedColour, swatch};
use crate::Rect;
use crate::error::FigureError;
use crate::list::{Across, Group, GroupKind, Path, PathItem, Stroke, Text, Upright, width_of};
use crate::style::{FRAME_PT, HORIZON_PT, INK, TEXT_PT};
use glam::DVec2;
use ttf::{LayerStyle, TextureLibrary};

/// Width and height of a swatch, points.
const SWATCH_PT: [f64; 2] = [30.0, 17.0];
/// From one swatch to the next, and from one line to the next, points.
const PITCH_PT: [f64; 2] = [22.5, 14.0];
/// Between a swatch and its name, points.
const GAP_PT: f64 = 6.0;
/// Least room for names, points.
const LEAST_NAME_PT: f64 = 36.0;

/// Between layers and horizons, points.
const PARAGRAPH_PT: f64 = 9.0;

/// A line that a legend explains.
#[derive(Debug, Clone, PartialEq)]
pub struct LegendLine {
    /// What it stands for.
    pub name: String,
    /// What kind of thing that is.
    pub kind: GroupKind,
    /// How it is drawn.
    pub stroke: Stroke,
}

/// What a legend lists.
#[derive(Clone, Copy)]
pub struct Legend<'a> {
    /// Layers, and the library that has their patterns.
    pub layers: Option<(&'a [LayerStyle], &'a TextureLibrary)>,
    /// Horizons, below the layers.
    pub horizons: &'a [NamedColour],
    /// Other lines, below the horizons: faults, wells, contacts.
    pub lines: &'a [LegendLine],
    /// Dots an inch that patterns are drawn at.
    pub dpi: f64,
}

impl Legend<'_> {
    fn styles(&self) -> &[LayerStyle] {
        self.layers.map_or(&[], |(styles, _)| styles)
    }

    /// Whether there is nothing to list.
    pub fn is_empty(&self) -> bool {
        self.styles().is_empty() && self.horizons.is_empty() && self.lines.is_empty()
    }

    /// The width that shows all names, but no more than `most`, points.
    pub fn width(&self, most: f64) -> f64 {
        let longest = self.names().map(|name| width_of(name, TEXT_PT)).fold(LEAST_NAME_PT, f64::max);
        (SWATCH_PT[0] + GAP_PT + longest + 1.0).min(most)
    }

    fn names(&self) -> impl Iterator<Item = &str> {
        let layers = self.styles().iter().map(|style| style.layer.as_str());
        let horizons = self.horizons.iter().map(|horizon| horizon.name.as_str());
        layers.chain(horizons).chain(self.lines.iter().map(|line| line.name.as_str()))
    }

    /// Size of all names in a legend of a width, points: that of the one which needs the smallest.
    fn size_pt(&self, width: f64, share: f64) -> f64 {
        let pitch = if self.horizons.is_empty() && self.lines.is_empty() { PITCH_PT[0] } else { PITCH_PT[1] };
        let largest = TEXT_PT.min(0.9 * share * pitch);
        let room = width - SWATCH_PT[0] - GAP_PT;
        let fitted = |name: &str| Text::new(DVec2::ZERO, name).sized(largest).fitted(room).size;
        self.names().map(fitted).fold(largest, f64::min)
    }

    /// The legend in its room; entries that do not fit stand closer.
    ///
    /// # Errors
    /// A pattern that does not draw.
    pub fn drawn(&self, room: Rect) -> Result<Group, FigureError> {
        let mut group = Group::new(GroupKind::Annotation, "legend");
        let counts = [self.styles().len(), self.horizons.len() + self.lines.len()];
        let between = if counts.contains(&0) { 0.0 } else { PARAGRAPH_PT };
        let needed = counts[0] as f64 * PITCH_PT[0] + counts[1] as f64 * PITCH_PT[1] + between;
        let share = (room.height() / needed.max(1.0)).min(1.0);
        let place = |top: f64, pitch: f64| {
            Rect::sized(room.min + DVec2::new(0.0, share * top), DVec2::new(room.width(), share * pitch))
        };
        let size = self.size_pt(room.width(), share);
        let mut top = 0.0;
        if let Some((styles, library)) = self.layers {
            for style in styles {
                group.push(layer(style, library, place(top, PITCH_PT[0]), size, self.dpi)?);
                top += PITCH_PT[0];
            }
        }
        top += between;
        let horizons = self.horizons.iter().map(|named| LegendLine {
            name: named.name.clone(),
            kind: GroupKind::Horizon,
            stroke: Stroke::new(1.5 * HORIZON_PT, named.colour),
        });
        for entry in horizons.chain(self.lines.iter().cloned()) {
            group.push(line(entry, place(top, PITCH_PT[1]), size));
            top += PITCH_PT[1];
        }
        Ok(group)
    }
}

/// An entry of a line in its place.
fn line(entry: LegendLine, place: Rect, size_pt: f64) -> Group {
    let middle = DVec2::new(place.min.x, place.centre().y);
    let path = Path::line(&[middle, middle + DVec2::new(SWATCH_PT[0], 0.0)]);
    Group::new(entry.kind, &entry.name).with([
        PathItem::stroked(path, entry.stroke).into(),
        name(&entry.name, middle + DVec2::new(SWATCH_PT[0], 0.0), place, size_pt).into(),
    ])
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
    let text = Text::new(at, name).sized(size_pt).anchored(Across::Start, Upright::Middle);
    text.fitted(room.max.x - at.x)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::list::Item;
    use ttf::Colour;

    fn texts(group: &Group, into: &mut Vec<Text>) {
        for item in &group.items {
            match item {
                Item::Text(text) => into.push(text.clone()),
                Item::Group(group) => texts(group, into),
                _ => {}
            }
        }
    }

    #[test]
    fn names_stay_in_the_room_and_apart_however_many_there_are() {
        let library = TextureLibrary::builtin().unwrap();
        for count in [1, 5, 60] {
            let style = |n: usize| {
                let name = if n == 0 { "Top".to_owned() } else { format!("layer {n} of a long and winding name") };
                LayerStyle::textured(&name, Colour::WHITE, "shale")
            };
            let styles: Vec<LayerStyle> = (0..count).map(style).collect();
            let legend = Legend { layers: Some((&styles, &library)), horizons: &[], lines: &[], dpi: 100.0 };
            let room = Rect::sized(DVec2::new(300.0, 10.0), DVec2::new(legend.width(110.0), 200.0));
            let mut found = Vec::new();
            texts(&legend.drawn(room).unwrap(), &mut found);
            assert_eq!(found.len(), count);
            for pair in found.windows(2) {
                assert!(pair[1].at.y - pair[0].at.y >= pair[0].size, "{count}");
            }
            assert!(found.iter().all(|text| text.size == found[0].size), "one size for all, also beside short names");
            assert!(found.iter().all(|text| text.bounds().max.x <= room.max.x + 0.1));
        }
    }
}
