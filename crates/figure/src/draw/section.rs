//! Sections and fences on a page: the raster, lines of horizons and faults over it, axes, title, caption.
//!
//! Solid where picked, dashed where filled, dotted where extrapolated; on a light rim, so that lines are
//! seen on any amplitude.

use super::annotation::room::LabelRoom;
use super::axes::{self, Axis};
use super::overlay::{self, OverlayLines, SeenOn};
use super::section_wells::WellOnSection;
use super::{NamedColour, scale};
use crate::cut::CutLine;
use crate::error::FigureError;
use crate::interpretation::DrawnInterpretation;
use crate::style::{ACCENT, FAULT_PT, HORIZON_PT, INK, NUMBER_PT, QUIET_INK, RIM_OPACITY, RIM_PT, TITLE_PT};
use glam::DVec2;
use image::RgbaImage;
use model::section::{LineKind, LineQuality};
use page::Rect;
use page::list::{Across, Group, GroupKind, Ink, Item, Path, PathItem, Picture, Stroke, Text, Upright};
use std::sync::Arc;
use ttf::Colour;

/// Height of the row with the title, points.
const TITLE_ROW_PT: f64 = 15.0;
/// Free at the right, points.
const RIGHT_PT: f64 = 5.0;

/// What a section shows.
pub struct SectionContents<'a> {
    /// A pixel a sample.
    pub image: &'a Arc<RgbaImage>,
    /// Largest s and t.
    pub extent: DVec2,
    /// Lines of the model.
    pub lines: &'a [CutLine],
    /// Colours of horizons, by index.
    pub horizons: &'a [NamedColour],
    /// Names of faults, by index.
    pub faults: &'a [String],
    /// Their colours; as all lines, or black, where there is none.
    pub fault_colours: &'a [Option<Colour>],
    /// What an interpreter sees over it.
    pub interpretation: Option<(&'a DrawnInterpretation<'a>, &'a OverlayLines, SeenOn<'a>)>,
    /// Where other sections run.
    pub marks: Marks,
}

/// Where other sections and the fence run on a section, (s, t).
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Marks {
    /// Straight down, at s.
    pub down: Vec<f64>,
    /// Straight across, at t.
    pub across: Vec<f64>,
    /// The line of a fence.
    pub fence: Vec<DVec2>,
}

impl SectionContents<'_> {
    /// Everything within `body`; the whole section, from its first sample to its last, lies on `image`,
    /// which may be larger.
    pub fn drawn(&self, body: Rect, image: Rect) -> Group {
        let [right, down] = [DVec2::new(image.width(), 0.0), DVec2::new(0.0, image.height())];
        let picture = Picture::of_samples(self.image.clone(), image.min, right, down);
        self.drawn_over(body, image, vec![picture.into()], None)
    }

    /// The same over other items than the picture; `ink` is the colour of all horizons, absent: each has its own.
    fn drawn_over(&self, body: Rect, image: Rect, below: Vec<Item>, ink: Option<&SectionInk>) -> Group {
        let page = |st: DVec2| image.min + st / self.extent * image.size();
        let mut group = Group::new(GroupKind::Data, "section").clipped(Path::rect(body)).with(below);
        match self.interpretation {
            None => {
                let lines = model_lines(self.lines, (self.horizons, ink), (self.faults, self.fault_colours), page);
                lines.into_iter().for_each(|line| group.push(line));
            }
            Some((shown, lines, on)) => {
                lines.drawn(page).into_iter().for_each(|lines| group.push(lines));
                overlay::sticks(shown, on, page).into_iter().for_each(|stick| group.push(stick));
            }
        }
        group.push(self.marks.drawn(body, page));
        group
    }
}

/// Lines of the model on a page, a group for each horizon and fault, rims under all of them.
fn model_lines(
    lines: &[CutLine],
    (horizons, ink): (&[NamedColour], Option<&SectionInk>),
    (faults, fault_colours): (&[String], &[Option<Colour>]),
    page: impl Fn(DVec2) -> DVec2,
) -> Vec<Group> {
    let mut rims = Group::new(GroupKind::Annotation, "rims");
    let mut kinds: Vec<LineKind> = lines.iter().map(|line| line.kind).collect();
    kinds.sort();
    kinds.dedup();
    let mut groups = Vec::new();
    for kind in kinds {
        let (group, colour, width) = match kind {
            LineKind::Frame => continue,
            LineKind::Horizon { horizon } => {
                let known = horizons.get(horizon);
                let own = || crate::style::horizon_colour(known.map(|known| known.colour), horizon);
                let (colour, width) = match ink {
                    // Lines between patterns are as thin as on blocks.
                    Some(ink) => (ink.colour, contact_pt(ink.unconformities.contains(&horizon))),
                    None => (own(), HORIZON_PT),
                };
                (Group::new(GroupKind::Horizon, known.map_or("", |known| &known.name)), colour, width)
            }
            LineKind::Fault { fault, .. } => {
                let name = faults.get(fault).map_or("", String::as_str);
                let own = fault_colours.get(fault).copied().flatten();
                let colour = own.unwrap_or_else(|| ink.map_or(Colour::BLACK, |ink| ink.colour));
                (Group::new(GroupKind::Fault, name), colour, FAULT_PT)
            }
        };
        let own = lines.iter().filter(|line| line.kind == kind);
        let mut group = group;
        for line in own {
            let path = Path::line(&line.points.iter().map(|st| page(*st)).collect::<Vec<_>>());
            // Light rims are for lines on amplitudes.
            if ink.is_none() {
                let light = Ink::glass(Colour::WHITE, RIM_OPACITY);
                rims.push(PathItem::stroked(path.clone(), Stroke::new(width + RIM_PT, light).round()));
            }
            group.push(PathItem::stroked(path, quality_stroke(Stroke::new(width, colour), line.quality)));
        }
        groups.push(group);
    }
    if !rims.items.is_empty() {
        groups.insert(0, rims);
    }
    groups
}

/// A line as its quality has it.
pub(crate) fn quality_stroke(stroke: Stroke, quality: LineQuality) -> Stroke {
    match quality {
        LineQuality::Certain => stroke.round(),
        LineQuality::Approximate => stroke.dashed(5.0, 3.0),
        LineQuality::Inferred => stroke.dashed(1.5, 2.5),
    }
}

impl Marks {
    fn drawn(&self, body: Rect, page: impl Fn(DVec2) -> DVec2) -> Group {
        let mut group = Group::new(GroupKind::Annotation, "where other sections run");
        let line = |path: Path| PathItem::stroked(path, Stroke::new(0.6, Ink::glass(ACCENT, 0.85)));
        for s in &self.down {
            let x = page(DVec2::new(*s, 0.0)).x;
            group.push(line(Path::line(&[DVec2::new(x, body.min.y), DVec2::new(x, body.max.y)])));
        }
        for t in &self.across {
            let y = page(DVec2::new(0.0, *t)).y;
            group.push(line(Path::line(&[DVec2::new(body.min.x, y), DVec2::new(body.max.x, y)])));
        }
        if self.fence.len() > 1 {
            let places: Vec<DVec2> = self.fence.iter().map(|at| page(*at)).collect();
            group.items.extend(fence_line(&places));
        }
        group
    }
}

/// Where a fence runs, seen from above.
pub(crate) fn fence_line(places: &[DVec2]) -> Vec<Item> {
    let path = Path::line(places);
    let rim = Stroke::new(2.8, Ink::glass(Colour::WHITE, 0.7)).round();
    let mut items = vec![
        PathItem::stroked(path.clone(), rim).into(),
        PathItem::stroked(path, Stroke::new(1.4, ACCENT).round()).into(),
    ];
    for place in places {
        let dot = PathItem::filled(Path::circle(*place, 2.2), Colour::WHITE);
        items.push(dot.outlined(Stroke::new(1.1, ACCENT)).into());
    }
    items
}

/// Which part of a section is seen: how many times it is larger than its room, and which share of it lies
/// in the middle.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize, serde::Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct Zoom {
    /// Times larger than the room, 1 or more.
    pub factor: f64,
    /// Shares of the section's width and height that lie in the middle of the room.
    pub middle: [f64; 2],
}

impl Default for Zoom {
    fn default() -> Self {
        Self { factor: 1.0, middle: [0.5; 2] }
    }
}

impl Zoom {
    /// Where the whole section lies when it is seen in `body`.
    pub(crate) fn image_in(&self, body: Rect) -> Rect {
        let size = body.size() * self.factor.max(1.0);
        Rect::sized(body.centre() - DVec2::from_array(self.middle) * size, size)
    }
}

/// A section with all that explains it.
pub(crate) struct SectionPanel<'a> {
    /// What it is called: "Inline 1250".
    pub title: String,
    /// What it shows.
    pub contents: SectionContents<'a>,
    /// Wells that lie near it.
    pub wells: Vec<WellOnSection>,
    /// Name, values at the ends and least step of the axes across and down; their places are found here.
    pub axes: [Axis; 2],
    /// Which part is seen.
    pub zoom: Zoom,
    /// How many times longer a metre down is than one across; absent: the section fills its room.
    pub proportions: Option<f64>,
    /// Length across and down, metres.
    pub extent_m: DVec2,
    /// Whether the two axes are both horizontal and so share one scale.
    pub is_plan: bool,
    /// Whether scale bar and caption stand below; the caption's words.
    pub caption: Option<Box<dyn Fn(f64) -> String + 'a>>,
    /// Length of a unit of the vertical axis down the section, with its symbol; of a section from above there is none.
    pub down: Option<(f64, &'a str)>,
    /// The ink of horizons between patterns; absent: each has its own colour.
    pub ink: Option<SectionInk>,
}

/// How horizons are drawn between patterns.
#[derive(Debug, Clone)]
pub(crate) struct SectionInk {
    /// Their colour.
    pub colour: Colour,
    /// Those that are erosional and so drawn heavier.
    pub unconformities: Vec<usize>,
}

/// Width of contacts and unconformities between patterns, points.
pub(crate) fn contact_pt(is_unconformity: bool) -> f64 {
    if is_unconformity { 0.95 * HORIZON_PT } else { 0.65 * HORIZON_PT }
}

/// What is drawn of rock below the lines of a section, and written on it: from where the section is seen, and where the
/// whole of it lies.
pub(crate) trait SectionPainter {
    /// What lies below the lines; `None`: the picture of samples.
    ///
    /// # Errors
    /// What a painter of blocks says.
    fn below(&mut self, body: Rect, image: Rect) -> Result<Option<Vec<Item>>, FigureError>;

    /// The names on it.
    fn names(&mut self, body: Rect, image: Rect, room: &mut LabelRoom) -> Vec<Item>;
}

impl SectionPanel<'_> {
    /// The panel in its room.
    ///
    /// # Errors
    /// What the painter says.
    pub(crate) fn drawn(mut self, room: Rect, painter: &mut dyn SectionPainter) -> Result<Group, FigureError> {
        let below = if self.caption.is_some() { scale::STRIP_PT } else { 3.0 };
        let margins = [axes::left_margin(&self.axes[1]), TITLE_ROW_PT + axes::top_margin(), RIGHT_PT, below];
        let mut body = room.inside(margins);
        let mut group = Group::new(GroupKind::Panel, &self.title);
        if !body.is_proper() {
            return Ok(group);
        }
        let proportions = self.proportions.filter(|factor| factor.is_finite() && *factor > 0.0 && !self.is_plan);
        if proportions.is_some() || self.is_plan && self.zoom == Zoom::default() {
            let fitted = body.fitted(self.extent_m * DVec2::new(1.0, proportions.unwrap_or(1.0)));
            // At the upper left, under its title.
            body = Rect::sized(body.min, fitted.size());
        }
        let image = self.zoom.image_in(body);
        self.axes[0].at = [image.min.x, image.max.x];
        self.axes[1].at = [image.min.y, image.max.y];
        group.push(match painter.below(body, image)? {
            Some(below) => self.contents.drawn_over(body, image, below, self.ink.as_ref()),
            None => self.contents.drawn(body, image),
        });
        let page = |st: DVec2| image.min + st / self.contents.extent * image.size();
        let mut free = LabelRoom::new(body.grown(-1.0));
        let wells = self.wells.iter().filter_map(|well| well.drawn(body, self.is_plan, &page, &mut free));
        wells.for_each(|well| group.push(well));
        group.items.extend(painter.names(body, image, &mut free));
        let whole = Rect::new(room.min, DVec2::new(room.max.x.min(body.max.x + RIGHT_PT), room.max.y));
        group.push(axes::drawn(whole, body, [&self.axes[0], &self.axes[1]]));
        let baseline = room.min.y + TITLE_PT;
        let across = Text::new(DVec2::new(body.max.x, baseline), &self.axes[0].name).sized(NUMBER_PT);
        let across = across.inked(QUIET_INK).anchored(Across::End, Upright::Baseline);
        let title = Text::new(DVec2::new(body.min.x, baseline), &self.title).sized(TITLE_PT).inked(INK);
        // In little room the title says enough.
        let mut heading = Group::new(GroupKind::Annotation, "heading");
        if title.width() + across.width() + 8.0 <= body.width() {
            heading.push(across);
        }
        heading.push(title.fitted(body.width()));
        group.push(heading);
        if let Some(caption) = &self.caption {
            let points_per_m = image.size() / self.extent_m;
            let strip = Rect::new(DVec2::new(body.min.x, body.max.y + 3.0), DVec2::new(body.max.x, room.max.y));
            let text = if self.is_plan { String::new() } else { caption(points_per_m.y / points_per_m.x) };
            let down = self.down.map(|(unit_m, symbol)| (points_per_m.y * unit_m, symbol));
            group.push(scale::drawn(strip, Some(points_per_m.x), down, &text));
        }
        Ok(group)
    }
}
