//! Maps on a page: a horizon's structure or the thickness below it, north up, with contours, hatching, a
//! colour bar, a north arrow.

use super::{map_lines, scale};
use crate::map::{self, HorizonMap, Mapped};
use crate::style::{ACCENT, FRAME_PT, INK, NUMBER_PT, QUIET_INK, RULE_INK, TEXT_PT, TITLE_PT};
use glam::DVec2;
use image::{Rgba, RgbaImage};
use page::Rect;
use page::list::{Across, Group, GroupKind, Ink, Item, Path, PathItem, Picture, Stroke, Text, Upright};
use survey::{SurveyGeometry, VerticalUnit};
use ttf::{Colour, ColourMap, RgbaFunction};

/// Height of the row with the title, points.
const TITLE_ROW_PT: f64 = 16.0;
/// Width of the column with north arrow and colour bar, points.
const COLUMN_PT: f64 = 52.0;
/// Height of the north arrow with its room, points.
const NORTH_PT: f64 = 36.0;
/// Width and greatest height of the colour bar, points.
const BAR_PT: [f64; 2] = [9.0, 170.0];
/// Colours of the bar.
const BAR_COLOURS: u32 = 128;
/// Width and opacity of hatching, points.
const HATCH: (f64, f32) = (0.45, 0.65);

/// From voxel x, y to the page: north up, one scale both ways.
#[derive(Debug, Clone, PartialEq)]
pub struct MapFrame {
    geometry: SurveyGeometry,
    middle: DVec2,
    centre: DVec2,
    scale: f64,
}

impl MapFrame {
    /// The whole survey within a body, `zoom` times larger and shifted.
    pub fn new(geometry: &SurveyGeometry, body: Rect, zoom: f64, shift: DVec2) -> Self {
        let [low, high] = bounds_m(geometry);
        let fit = (body.size() / extent_m(geometry)).min_element();
        Self {
            geometry: geometry.clone(),
            middle: (low + high) * 0.5,
            centre: body.centre() + shift,
            scale: fit * zoom,
        }
    }

    /// Points a metre.
    pub(crate) fn points_per_m(&self) -> f64 {
        self.scale
    }

    /// The place of voxel x, y on the page.
    ///
    /// ```
    /// use figure::draw::map::MapFrame;
    /// use page::Rect;
    /// use glam::DVec2;
    /// use survey::{SurveyGeometry, VerticalUnit};
    ///
    /// // Inlines run east, crosslines north: the first trace lies at the lower left.
    /// let geometry = SurveyGeometry::regular([11, 11, 9], 25.0, 4.0, VerticalUnit::Milliseconds);
    /// let frame = MapFrame::new(&geometry, Rect::sized(DVec2::ZERO, DVec2::splat(100.0)), 1.0, DVec2::ZERO);
    /// assert_eq!(frame.page(DVec2::ZERO), DVec2::new(0.0, 100.0));
    /// ```
    pub fn page(&self, voxel: DVec2) -> DVec2 {
        let world = self.geometry.inline_vector * voxel.x + self.geometry.crossline_vector * voxel.y;
        let off = (world - self.middle) * self.scale;
        self.centre + DVec2::new(off.x, -off.y)
    }

    /// The voxel x, y at a place of the page.
    pub fn voxel(&self, at: DVec2) -> DVec2 {
        let off = at - self.centre;
        let world = self.middle + DVec2::new(off.x, -off.y) / self.scale;
        self.geometry.voxel_from_world((world + self.geometry.origin).extend(0.0)).truncate()
    }
}

/// The smallest and largest place of the survey, metres east and north of its origin.
fn bounds_m(geometry: &SurveyGeometry) -> [DVec2; 2] {
    let corners = corners(geometry).map(|at| geometry.inline_vector * at.x + geometry.crossline_vector * at.y);
    let low = corners.into_iter().fold(DVec2::INFINITY, DVec2::min);
    [low, corners.into_iter().fold(DVec2::NEG_INFINITY, DVec2::max)]
}

/// The survey's extent to the east and to the north, metres; never 0.
fn extent_m(geometry: &SurveyGeometry) -> DVec2 {
    let [low, high] = bounds_m(geometry);
    (high - low).max(DVec2::splat(1e-6))
}

/// Voxel x, y of the survey's corners, around it.
fn corners(geometry: &SurveyGeometry) -> [DVec2; 4] {
    let [nx, ny, _] = geometry.size().map(|count| count.saturating_sub(1) as f64);
    [[0.0, 0.0], [nx, 0.0], [nx, ny], [0.0, ny]].map(DVec2::from_array)
}

/// Colours, hatching and contours with their values; nothing of what explains them. Values stand within `room`.
pub fn contents(shown: &HorizonMap, frame: &MapFrame, room: Rect) -> Group {
    let [first, across, _, along] = corners(&frame.geometry).map(|corner| frame.page(corner));
    let outline = corners(&frame.geometry).map(|corner| frame.page(corner));
    let mut group = Group::new(GroupKind::Data, "map");
    let picture = Picture::of_samples(shown.image.clone(), first, across - first, along - first);
    let data = Group::new(GroupKind::Data, "values").clipped(Path::polygon(&outline)).with([picture.into()]);
    group.push(data);
    if !shown.hatching.is_empty() {
        let mut path = Path::default();
        shown.hatching.iter().for_each(|ends| path.add_line(&ends.map(|end| frame.page(end))));
        let stroke = Stroke::new(HATCH.0, Ink::glass(Colour::BLACK, HATCH.1));
        let hatched = Group::new(GroupKind::Annotation, "not picked").clipped(Path::polygon(&outline));
        group.push(hatched.with([PathItem::stroked(path, stroke).into()]));
    }
    let [faults, contours] = map_lines::drawn(shown, |place| frame.page(place), room, &outline);
    group.push(contours);
    if !faults.items.is_empty() {
        group.push(faults);
    }
    group
}

/// Straight lines over a map: where sections and a fence run, voxel x and y.
pub fn marks(lines: &[Vec<DVec2>], frame: &MapFrame) -> Group {
    let mut group = Group::new(GroupKind::Annotation, "where sections run");
    for line in lines {
        let places: Vec<DVec2> = line.iter().map(|at| frame.page(*at)).collect();
        group.push(PathItem::stroked(Path::line(&places), Stroke::new(0.9, ACCENT)));
    }
    group
}

/// A map with all that explains it.
pub(crate) struct MapPanel<'a> {
    /// What it is called.
    pub title: String,
    /// What it shows.
    pub map: &'a HorizonMap,
    /// Where its traces are.
    pub geometry: &'a SurveyGeometry,
    /// Where sections run, voxel x and y.
    pub marks: Vec<Vec<DVec2>>,
    /// Whether a scale bar stands below.
    pub has_scale_bar: bool,
}

impl MapPanel<'_> {
    /// The panel in its room.
    pub(crate) fn drawn(&self, room: Rect) -> Group {
        let mut group = Group::new(GroupKind::Panel, &self.title);
        let body = room.inside([2.0, TITLE_ROW_PT + 2.0, COLUMN_PT, scale::STRIP_PT + 4.0]);
        if !body.is_proper() {
            return group;
        }
        // At the upper left, under its title; what explains it stands close by.
        let body = Rect::sized(body.min, body.fitted(extent_m(self.geometry)).size());
        let frame = MapFrame::new(self.geometry, body, 1.0, DVec2::ZERO);
        group.push(contents(self.map, &frame, body.grown(-2.0)));
        let outline = corners(self.geometry).map(|corner| frame.page(corner));
        let rim = PathItem::stroked(Path::polygon(&outline), Stroke::new(FRAME_PT, RULE_INK));
        group.push(Group::new(GroupKind::Annotation, "outline of the survey").with([rim.into()]));
        if !self.marks.is_empty() {
            group.push(marks(&self.marks, &frame).clipped(Path::polygon(&outline)));
        }
        let title = Text::new(DVec2::new(room.min.x + 2.0, room.min.y + TITLE_PT), &self.title).sized(TITLE_PT);
        group.push(Group::new(GroupKind::Annotation, "heading").with([title.fitted(room.width() - 2.0).into()]));
        let column =
            Rect::sized(DVec2::new(body.max.x + 14.0, body.min.y), DVec2::new(COLUMN_PT - 14.0, body.height()));
        explained(self.map, self.geometry, column).into_iter().for_each(|part| group.push(part));
        // Beside a low map the arrow reaches down to the strip.
        let top = body.max.y + 6.0;
        let right = if top < column.min.y + NORTH_PT + 6.0 { column.min.x - 4.0 } else { room.max.x };
        let strip = Rect::new(DVec2::new(room.min.x + 2.0, top), DVec2::new(right, room.max.y));
        let scale = self.has_scale_bar.then(|| frame.points_per_m());
        group.push(scale::drawn(strip, scale, None, &caption(self.map, self.geometry)));
        group
    }
}

/// North arrow and colour bar in a column beside a map.
pub fn explained(shown: &HorizonMap, geometry: &SurveyGeometry, column: Rect) -> [Group; 2] {
    let arrow = north(column.min + DVec2::new(0.5 * BAR_PT[0], 0.0));
    [arrow, bar(shown, geometry, column.inside([0.0, NORTH_PT + 12.0, 0.0, 0.0]))]
}

/// What the lines on a map mean.
pub fn caption(shown: &HorizonMap, geometry: &SurveyGeometry) -> String {
    let unit = geometry.vertical.unit.symbol();
    let contours = (!shown.contours.is_empty()).then(|| format!("contours every {} {unit}", shown.interval));
    let share = match 100.0 * shown.unpicked {
        few if few < 1.0 => "under 1".to_owned(),
        share => format!("{share:.0}"),
    };
    let hatching = (!shown.hatching.is_empty()).then(|| format!("hatched: not picked ({share} %)"));
    let faults = (!shown.faults.is_empty()).then(|| "heaviest lines: faults".to_owned());
    contours.into_iter().chain(faults).chain(hatching).collect::<Vec<_>>().join("; ")
}

/// An arrow to the north, its tip below `top`.
pub fn north(top: DVec2) -> Group {
    let at = |x: f64, y: f64| top + DVec2::new(x, y);
    let foot = 24.0;
    Group::new(GroupKind::Annotation, "north arrow").with([
        // Half filled, half open, as surveyors draw it.
        PathItem::filled(Path::polygon(&[at(0.0, 0.0), at(0.0, foot - 5.0), at(-5.0, foot)]), INK).into(),
        PathItem::filled(Path::polygon(&[at(0.0, 0.0), at(5.0, foot), at(0.0, foot - 5.0)]), Colour::WHITE).into(),
        PathItem::stroked(
            Path::polygon(&[at(0.0, 0.0), at(5.0, foot), at(0.0, foot - 5.0), at(-5.0, foot)]),
            Stroke::new(0.6, INK),
        )
        .into(),
        Text::new(at(0.0, foot + 3.0), "N").sized(TEXT_PT).anchored(Across::Middle, Upright::Top).into(),
    ])
}

/// Which colour is which value.
fn bar(shown: &HorizonMap, geometry: &SurveyGeometry, room: Rect) -> Group {
    let mut group = Group::new(GroupKind::Annotation, "colour bar");
    let height = (room.height() - 2.0).min(BAR_PT[1]);
    if height < 20.0 {
        return group;
    }
    let rect = Rect::sized(room.min, DVec2::new(BAR_PT[0], height));
    let colours = RgbaFunction::over(ColourMap::Strata, [0.0, 1.0]);
    let image = RgbaImage::from_fn(1, BAR_COLOURS, |_, y| {
        let [r, g, b] = map::tone(&colours, 1.0 - (f64::from(y) + 0.5) / f64::from(BAR_COLOURS)).rgb;
        Rgba([r, g, b, 255])
    });
    group.push(Picture::in_rect(image, rect));
    group.push(PathItem::stroked(Path::rect(rect), Stroke::new(FRAME_PT, QUIET_INK)));
    let unit = geometry.vertical.unit.symbol();
    group.push(Text::new(rect.min - DVec2::new(0.0, 4.0), unit).sized(NUMBER_PT).inked(QUIET_INK));
    group.items.extend(bar_numbers(shown, rect));
    group
}

/// Round values beside the bar, and its two ends where these have room.
fn bar_numbers(shown: &HorizonMap, rect: Rect) -> Vec<Item> {
    let [first, last] = shown.ends();
    let axis =
        super::axes::Axis { name: String::new(), ends: [first, last], at: [rect.min.y, rect.max.y], least_step: 0.0 };
    let ticks = axis.ticks([rect.min.y, rect.max.y], 22.0);
    let mut items = Vec::new();
    let mut marks = Path::default();
    for tick in ticks {
        let foot = DVec2::new(rect.max.x, tick.at);
        marks.add_line(&[foot, foot + DVec2::new(2.0, 0.0)]);
        let number = Text::new(foot + DVec2::new(4.0, 0.0), tick.text).sized(NUMBER_PT).inked(QUIET_INK);
        items.push(number.anchored(Across::Start, Upright::Middle).into());
    }
    items.push(PathItem::stroked(marks, Stroke::new(FRAME_PT, QUIET_INK)).into());
    items
}

/// The name of a map.
pub fn title(mapped: Mapped, name: impl Fn(usize) -> String, geometry: &SurveyGeometry) -> String {
    let unit = geometry.vertical.unit.symbol();
    let measured = match geometry.vertical.unit {
        VerticalUnit::Milliseconds => "Two-way time",
        VerticalUnit::Metres => "Depth",
    };
    match mapped {
        Mapped::Structure(horizon) => format!("{measured} of {} ({unit})", name(horizon)),
        Mapped::Thickness(upper, lower) => {
            format!("Thickness from {} down to {} ({unit})", name(upper), name(lower))
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn north_is_up_and_places_come_back_on_turned_and_mirrored_surveys() {
        for side in [1.0, -1.0] {
            let mut geometry = SurveyGeometry::regular([31, 21, 9], 25.0, 4.0, VerticalUnit::Milliseconds);
            geometry.origin = DVec2::new(4000.0, 7000.0);
            geometry.inline_vector = DVec2::from_angle(0.7) * 25.0;
            geometry.crossline_vector = geometry.inline_vector.perp() * side * 0.5;
            let body = Rect::sized(DVec2::new(10.0, 20.0), DVec2::new(200.0, 100.0));
            let frame = MapFrame::new(&geometry, body, 1.0, DVec2::ZERO);
            for corner in corners(&geometry) {
                let page = frame.page(corner);
                assert!(body.grown(1e-6).contains(page));
                assert!((frame.voxel(page) - corner).length() < 1e-9);
            }
            let world = |voxel: DVec2| geometry.world_from_voxel(voxel.extend(0.0)).truncate();
            let (a, b) = (DVec2::new(3.0, 4.0), DVec2::new(9.0, 11.0));
            let (page, ground) = (frame.page(b) - frame.page(a), world(b) - world(a));
            assert!((page - DVec2::new(ground.x, -ground.y) * frame.points_per_m()).length() < 1e-9);
        }
    }
}
