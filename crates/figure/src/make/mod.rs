//! From what a figure shows to its page: the one way that figures are made.

mod contents;
mod legend;
mod rock;
mod series;

use crate::annotation::Annotation;
use crate::correlation::{self, Column};
use crate::cut::{SectionKind, SectionSource, value_at};
use crate::draw::annotation::BlockAnnotation;
use crate::draw::axes::{Axis, axis_title};
use crate::draw::block::{BlockPainter, BlockPanel, Comparison, DrawnBlock};
use crate::draw::correlation::CorrelationPanel;
use crate::draw::map::{MapPanel, title};
use crate::draw::section::Marks;
use crate::draw::throw_profile::ThrowPanel;
use crate::draw::{NamedColour, colour_bar, label_changes, north, scale, words};
use crate::error::FigureError;
use crate::interpretation::DrawnInterpretation;
use crate::map::{HorizonMap, MapSource, Mapped};
use crate::spec::{BlockPart, CorrelationPart, FencePart, Figure, MapPart, Part, SectionPart};
use contents::Prepared;
use glam::DVec2;
use page::Rect;
use page::list::{DisplayList, Group, GroupKind, Ink, Item, POINTS_PER_INCH};
use render::{Background, FaceData, Faces, Scene, Unpicked};
pub use series::{SeriesLegend, SeriesPage, panel_letter};
use survey::{StratigraphicHorizon, SurveyGeometry, Well};
use ttf::{Colour, LayerStyle, RawColour, TextureLibrary};

/// Room around a page whose parts have text at their edges, points.
const MARGIN_PT: f64 = 8.0;
/// Room between parts, points.
const GAP_PT: f64 = 9.0;
/// Least width and height of what is left for the parts, points.
const LEAST_PT: f64 = 20.0;
/// The same of a block on which or below which something is written.
const LEAST_BLOCK_PT: f64 = 40.0;
/// Share of the page that a legend may take.
const LEGEND_SHARE: f64 = 0.36;
/// On pages higher than so many widths a legend of several columns stands below the parts.
const UPRIGHT: f64 = 1.1;
/// Share of their height that it may take.
const BELOW_SHARE: f64 = 0.48;
/// Contacts of more layers than this are not dashed.
const MOST_DASHED: usize = 150;
/// Two parts stand beside one another where the room is broader than so many heights, else one over the other.
const BROAD: f64 = 1.2;
/// The share that the first of two parts takes.
const FIRST: f64 = 0.42;

/// What figures are made from: borrowed data of a project.
#[derive(Clone, Copy)]
pub struct FigureInputs<'a> {
    /// Geometry, model, volumes, candidates, and how raw data are coloured.
    pub source: SectionSource<'a>,
    /// Horizons with their colours, youngest first.
    pub horizons: &'a [NamedColour],
    /// The same with what happens at each.
    pub strata: &'a [StratigraphicHorizon],
    /// Which of these outline a body that the program found: how it came there nobody has said.
    pub outlined: &'a [usize],
    /// Names of the faults.
    pub faults: &'a [String],
    /// The colours that they were given.
    pub fault_colours: &'a [Option<Colour>],
    /// The layers as they are drawn, youngest first.
    pub layers: &'a [LayerStyle],
    /// Patterns of the layers.
    pub library: Option<&'a TextureLibrary>,
    /// Wells, for correlation panels.
    pub wells: &'a [Well],
    /// What an interpreter sees.
    pub interpretation: Option<&'a DrawnInterpretation<'a>>,
    /// The program and the project, for the line of provenance.
    pub provenance: &'a str,
}

/// Makes the page of a figure; `painter` draws its blocks.
///
/// The page draws the same in every back end; at [`Figure::dpi`] its pictures lie on whole pixels.
///
/// # Errors
/// A page without room, places outside the survey, horizons that are not there, or what the painter says.
pub fn make(
    figure: &Figure,
    inputs: &FigureInputs,
    painter: &mut dyn BlockPainter,
) -> Result<DisplayList, FigureError> {
    if !(1..=4).contains(&figure.parts.len()) {
        return Err(FigureError::Parts { found: figure.parts.len() });
    }
    let mut list = DisplayList::new(figure.size_pt());
    page::raster::size_px(&list, figure.dpi)?;
    list.paper = paper(figure);
    let maker = Maker { figure, inputs, geometry: inputs.source.data.geometry };
    let prepared = figure.parts.iter().map(|part| maker.prepared(part)).collect::<Result<Vec<_>, _>>()?;
    let listed = maker.listed(&prepared, rooms(figure.parts.len(), list.bounds())[0].size());
    let legend = listed.legend(&maker);
    let mut room = list.bounds();
    // A block alone fills its page to the rim: it has its own margin.
    let provenance = maker.provenance();
    let colours = maker.shown_colours();
    let has_words = figure.title.is_some() || figure.caption.is_some() || provenance.is_some() || colours.is_some();
    let has_strip = figure.scale_bar || figure.north_arrow || !figure.annotate.is_empty();
    let is_bare = matches!(figure.parts[..], [Part::Block(_)]) && legend.is_none() && !has_strip && !has_words;
    if !is_bare {
        room = room.grown(-MARGIN_PT);
    }
    room = write_words(figure, provenance.as_ref(), &mut list, room);
    if !is_bare && room.size().min_element() < LEAST_PT {
        return Err(maker.no_room());
    }
    if let Some(raw) = colours {
        let [above, strip] = room.split_down(1.0 - colour_bar::STRIP_PT / room.height());
        list.items.push(colour_bar::drawn(strip, raw).into());
        room = above;
    }
    if !is_bare && room.size().min_element() < LEAST_PT {
        return Err(maker.no_room());
    }
    if let Some(legend) = &legend {
        let (columns, height) = legend.across(room.width());
        let is_upright = room.height() > UPRIGHT * room.width();
        if is_upright && columns > 1 && height < BELOW_SHARE * room.height() {
            let [above, below] = room.split_down(1.0 - height / room.height());
            list.items.push(legend.drawn_across(below, columns)?.into());
            room = above.inside([0.0, 0.0, 0.0, GAP_PT]);
        } else {
            let width = legend.width(room.size(), LEGEND_SHARE * room.width());
            let [left, right] = room.split_across(1.0 - width / room.width());
            list.items.push(legend.drawn(right.inside([0.0, 2.0, 0.0, 0.0]))?.into());
            room = left.inside([0.0, 0.0, GAP_PT, 0.0]);
        }
    }
    if !is_bare && room.size().min_element() < LEAST_PT {
        return Err(maker.no_room());
    }
    let rooms = rooms(figure.parts.len(), room);
    let mut panels: Vec<Item> = Vec::new();
    for ((part, prepared), room) in figure.parts.iter().zip(prepared).zip(rooms) {
        panels.push(maker.part(part, prepared, room, painter)?.into());
    }
    let labels = figure.all_labels();
    for panel in &mut panels {
        match panel {
            // A block was changed as its own scene says.
            Item::Group(panel) if panel.name != label_changes::BLOCK => label_changes::change_panel(panel, &labels),
            _ => {}
        }
    }
    label_changes::change(&mut list.items, &labels);
    // The legend explains what is drawn before it.
    panels.append(&mut list.items);
    list.items = panels;
    list.print(figure.printed_in());
    Ok(list)
}

/// Writes title, provenance and caption; returns the room that is left.
fn write_words(figure: &Figure, provenance: Option<&String>, list: &mut DisplayList, mut room: Rect) -> Rect {
    let words = [
        (figure.title.as_ref(), words::title as fn(Rect, &str) -> (Group, Rect)),
        (provenance, words::provenance),
        (figure.caption.as_ref(), words::caption),
    ];
    for (said, place) in words {
        if let Some(said) = said {
            let (group, rest) = place(room, said);
            list.items.push(group.into());
            room = rest;
        }
    }
    room
}

/// What the page is made of: the block's own background where that is a paper's, white where volumes lie on
/// a dark ground.
fn paper(figure: &Figure) -> Option<Ink> {
    let blocks = figure.parts.iter().find_map(|part| match part {
        Part::Block(block) => Some(block.scene.background),
        _ => None,
    });
    match blocks {
        Some(Background::Transparent) => None,
        Some(Background::Colour(colour)) if !is_dark(colour) => Some(Ink::solid(colour)),
        _ => Some(Ink::WHITE),
    }
}

/// Whether dark letters cannot be read on a colour.
fn is_dark(colour: Colour) -> bool {
    colour.luminance() < 0.25
}

/// Where the parts of a figure stand.
fn rooms(count: usize, room: Rect) -> Vec<Rect> {
    let half = 0.5 * GAP_PT;
    let across = |rect: Rect, share: f64| {
        let [a, b] = rect.split_across(share);
        [a.inside([0.0, 0.0, half, 0.0]), b.inside([half, 0.0, 0.0, 0.0])]
    };
    let down = |rect: Rect, share: f64| {
        let [a, b] = rect.split_down(share);
        [a.inside([0.0, 0.0, 0.0, half]), b.inside([0.0, half, 0.0, 0.0])]
    };
    match count {
        1 => vec![room],
        2 if room.width() > BROAD * room.height() => across(room, FIRST).to_vec(),
        2 => down(room, FIRST).to_vec(),
        _ => down(room, 0.5).into_iter().flat_map(|row| across(row, 0.5)).collect(),
    }
}

/// A figure being made.
struct Maker<'a> {
    figure: &'a Figure,
    inputs: &'a FigureInputs<'a>,
    geometry: &'a SurveyGeometry,
}

impl<'a> Maker<'a> {
    fn no_room(&self) -> FigureError {
        let size_cm = (self.figure.size_pt() / POINTS_PER_INCH * 2.54).to_array();
        FigureError::NoRoom { what: "the figure", size_cm }
    }

    fn interpretation(&self) -> Result<Option<&'a DrawnInterpretation<'a>>, FigureError> {
        match (self.figure.interpretation, self.inputs.interpretation) {
            (false, _) => Ok(None),
            (true, Some(shown)) => Ok(Some(shown)),
            (true, None) => Err(FigureError::NoInterpretation),
        }
    }

    fn wants(&self, annotation: Annotation) -> bool {
        self.figure.annotate.contains(&annotation)
    }

    /// Whether contacts of blocks are dashed where they were not picked. Dashes of very many make stripes across the layers.
    fn wants_dashes(&self) -> bool {
        let is_crowded = self.inputs.source.data.model.is_some_and(|model| model.layer_count() > MOST_DASHED);
        self.wants(Annotation::Quality) && !is_crowded
    }

    /// The line that says where the figure comes from.
    fn provenance(&self) -> Option<String> {
        let mut said = vec![self.inputs.provenance.to_owned()];
        said.extend(self.figure.credit.as_ref().map(|credit| format!("data: {credit}")));
        self.wants(Annotation::Provenance).then(|| said.join(" · "))
    }

    /// The colours of measured data, where they are seen and explained.
    fn shown_colours(&self) -> Option<&'a RawColour> {
        let shows = |part: &'a Part| match part {
            Part::Block(block) => {
                let is_raw = match block.comparison {
                    Comparison::None => block.scene.blend > 0.0,
                    Comparison::SideBySide(blends) | Comparison::Wipe(blends, _) => blends.iter().any(|b| *b > 0.0),
                };
                let own = block.scene.raw.as_ref().or(self.inputs.source.raw);
                own.filter(|_| is_raw && block.scene.face_data == FaceData::Rock)
            }
            Part::Section(SectionPart { blend, .. }) | Part::Fence(FencePart { blend, .. }) => {
                self.inputs.source.raw.filter(|_| *blend != Some(0.0))
            }
            Part::Map(_) | Part::Correlation(_) | Part::Throw(_) => None,
        };
        self.figure.parts.iter().find_map(shows).filter(|_| self.wants(Annotation::Colours))
    }

    fn part(
        &self,
        part: &Part,
        prepared: Prepared,
        room: Rect,
        painter: &mut dyn BlockPainter,
    ) -> Result<Group, FigureError> {
        match (part, prepared) {
            (Part::Block(part), _) => self.block(part, room, painter),
            (Part::Map(part), _) => self.map(part, room),
            (_, Prepared::Section(section)) => self.panel(*section, room, painter),
            (Part::Correlation(part), Prepared::Wells(columns, range)) => self.correlation(part, &columns, range, room),
            (Part::Throw(_), Prepared::Profile(profile)) => {
                let has_heave = self.wants(Annotation::Heave);
                let panel = ThrowPanel { profile: &profile, horizons: self.inputs.horizons, has_heave };
                let drawn = panel.drawn(room);
                if drawn.items.is_empty() { Err(self.no_room()) } else { Ok(drawn) }
            }
            // Every other part is prepared.
            _ => Err(self.no_room()),
        }
    }

    fn block(&self, part: &BlockPart, room: Rect, painter: &mut dyn BlockPainter) -> Result<Group, FigureError> {
        let body = room.inside([0.0, 0.0, 0.0, self.strip_pt()]);
        let mut drawn = self.block_alone(part, body, painter)?;
        let below = Rect::new(DVec2::new(room.min.x, body.max.y), room.max);
        drawn.group.items.extend(self.strip(part, below, &drawn));
        label_changes::change(&mut drawn.group.items, &part.scene.labels);
        Ok(drawn.group)
    }

    /// Height of the strip below a block that holds its scale bar and its north arrow, points.
    fn strip_pt(&self) -> f64 {
        match (self.figure.north_arrow, self.figure.scale_bar) {
            (true, _) => north::SIDE_PT,
            (false, true) => scale::STRIP_PT,
            (false, false) => 0.0,
        }
    }

    /// Scale bar and north arrow of a block, as far as they are wanted.
    fn strip(&self, part: &BlockPart, mut below: Rect, drawn: &DrawnBlock) -> Vec<Item> {
        let mut items = Vec::new();
        if self.figure.north_arrow {
            // At the right end, so that bar and caption keep their place.
            let left = (below.max.x - north::SIDE_PT).max(below.min.x);
            items.push(north::drawn(Rect::new(DVec2::new(left, below.min.y), below.max), drawn.compass).into());
            below.max.x = left;
        }
        if self.figure.scale_bar {
            let caption = scale::block_caption(&part.scene, self.geometry);
            let down = (drawn.points_down, self.geometry.vertical.unit.symbol());
            items.push(scale::drawn(below, Some(drawn.points_per_m), Some(down), &caption).into());
        }
        items
    }

    /// A block with what is written on it.
    fn block_alone(
        &self,
        part: &BlockPart,
        body: Rect,
        painter: &mut dyn BlockPainter,
    ) -> Result<DrawnBlock, FigureError> {
        let is_plain = self.strip_pt() == 0.0 && self.figure.annotate.is_empty();
        if body.size().min_element() < if is_plain { f64::MIN_POSITIVE } else { LEAST_BLOCK_PT } {
            return Err(self.no_room());
        }
        let names = self.block_names();
        let shown = |well: &&Well| !part.scene.hides_well(&well.name);
        let wells: Vec<Well> = self.inputs.wells.iter().filter(shown).cloned().collect();
        // Lines that were not picked say so.
        let mut scene = part.scene.clone();
        if self.wants_dashes() {
            scene.outlines.unpicked = Unpicked::Dashed;
        }
        let panel = BlockPanel {
            scene: &scene,
            geometry: self.geometry,
            comparison: part.comparison,
            interpretation: self.interpretation()?,
            has_surfaces: is_opaque(&part.scene),
            dpi: self.figure.dpi,
            model: self.inputs.source.data.model.filter(|_| !self.figure.interpretation),
            wells: self.inputs.source.data.wells,
            annotation: (!self.figure.annotate.is_empty()).then_some(BlockAnnotation {
                wanted: &self.figure.annotate,
                geometry: self.geometry,
                model: self.inputs.source.data.model.filter(|_| !self.figure.interpretation),
                names,
                wells: &wells,
            }),
            names,
        };
        panel.drawn(body, painter)
    }

    fn map(&self, part: &MapPart, room: Rect) -> Result<Group, FigureError> {
        let shown = self.interpretation()?;
        let horizons = self.inputs.horizons;
        let words = || match &part.thickness_to {
            None => format!("horizon {}", part.horizon),
            Some(lower) => format!("the thickness from {} down to {lower}", part.horizon),
        };
        let no_map = || FigureError::NoMap { what: words() };
        let find = |name: &str| horizons.iter().position(|horizon| horizon.name == name).ok_or_else(no_map);
        let upper = find(&part.horizon)?;
        let mapped = match &part.thickness_to {
            None => Mapped::Structure(upper),
            Some(lower) => Mapped::Thickness(upper, find(lower)?),
        };
        let source = match (shown, self.inputs.source.data.model) {
            (Some(shown), _) => MapSource::Sheets(shown),
            (None, Some(model)) => MapSource::Model(model),
            (None, None) => return Err(no_map()),
        };
        let map = HorizonMap::new(self.geometry, source, mapped).ok_or_else(no_map)?;
        let panel = MapPanel {
            title: title(mapped, |index| horizons[index].name.clone(), self.geometry),
            map: &map,
            geometry: self.geometry,
            marks: self.marks_on_map()?,
            has_scale_bar: self.figure.scale_bar,
        };
        let group = panel.drawn(room);
        if group.items.is_empty() { Err(self.no_room()) } else { Ok(Group { kind: GroupKind::Panel, ..group }) }
    }

    fn correlation(
        &self,
        part: &CorrelationPart,
        columns: &[Column],
        range: [f64; 2],
        room: Rect,
    ) -> Result<Group, FigureError> {
        let panel = CorrelationPanel {
            columns,
            layers: self.inputs.layers,
            library: self.inputs.library,
            horizons: self.inputs.horizons,
            axis: correlation::axis_name(&self.axis(2, 1.0).name, part, columns),
            range,
            caption: self.figure.scale_bar.then(|| correlation::caption(columns, self.geometry)),
            dpi: self.figure.dpi,
        };
        let drawn = panel.drawn(room)?;
        if drawn.items.is_empty() { Err(self.no_room()) } else { Ok(drawn) }
    }

    /// An axis of the survey from index 0 to `last`.
    fn axis(&self, axis: usize, last: f64) -> Axis {
        let name = axis_title(self.geometry, axis).into();
        let ends = [0.0, last].map(|index| value_at(self.geometry, axis, index));
        Axis { name, ends, at: [0.0; 2], least_step: if axis < 2 { 1.0 } else { 0.0 } }
    }

    /// Voxel position of a section, on the sample that is meant.
    fn voxel_at(&self, kind: SectionKind, value: f64) -> Result<f64, FigureError> {
        let geometry = self.geometry;
        let index = match kind {
            SectionKind::Inline => geometry.inlines.index_of(value),
            SectionKind::Crossline => geometry.crosslines.index_of(value),
            SectionKind::Slice => geometry.vertical.index_of(value),
        };
        let index = on_sample(index);
        let last = geometry.size()[kind.axis()].saturating_sub(1) as f64;
        if !(0.0..=last).contains(&index) {
            let what = match kind {
                SectionKind::Inline => "inline",
                SectionKind::Crossline => "crossline",
                SectionKind::Slice => "vertical value",
            };
            let [first, last] = [0.0, last].map(|index| value_at(geometry, kind.axis(), index));
            return Err(FigureError::Outside { what, asked: value, first, last });
        }
        Ok(index)
    }

    /// Corners of a fence, voxel x and y, without those that lie on the one before.
    fn fence_corners(&self, part: &FencePart) -> Result<Vec<DVec2>, FigureError> {
        let mut corners: Vec<DVec2> = Vec::new();
        for [inline, crossline] in &part.corners {
            let x = self.voxel_at(SectionKind::Inline, *inline)?;
            let y = self.voxel_at(SectionKind::Crossline, *crossline)?;
            corners.push(DVec2::new(x, y));
        }
        corners.dedup_by(|a, b| a.distance(*b) < 1e-6);
        if corners.len() < 2 {
            return Err(FigureError::ShortFence { corners: corners.len() });
        }
        Ok(corners)
    }

    /// Where the figure's other parts run on a section.
    fn marks_on(&self, kind: SectionKind) -> Result<Marks, FigureError> {
        let mut marks = Marks::default();
        let [s, t] = kind.axes();
        for part in &self.figure.parts {
            match part {
                Part::Section(other) if other.kind.axis() == s => marks.down.push(self.voxel_at(other.kind, other.at)?),
                Part::Section(other) if other.kind.axis() == t => {
                    marks.across.push(self.voxel_at(other.kind, other.at)?);
                }
                Part::Fence(fence) if kind == SectionKind::Slice => marks.fence = self.fence_corners(fence)?,
                _ => {}
            }
        }
        Ok(marks)
    }

    /// Where the figure's sections run on a map, voxel x and y.
    fn marks_on_map(&self) -> Result<Vec<Vec<DVec2>>, FigureError> {
        let [nx, ny, _] = self.geometry.size().map(|count| count.saturating_sub(1) as f64);
        let mut lines = Vec::new();
        for part in &self.figure.parts {
            match part {
                Part::Section(section) => {
                    let at = self.voxel_at(section.kind, section.at)?;
                    match section.kind {
                        SectionKind::Inline => lines.push(vec![DVec2::new(at, 0.0), DVec2::new(at, ny)]),
                        SectionKind::Crossline => lines.push(vec![DVec2::new(0.0, at), DVec2::new(nx, at)]),
                        SectionKind::Slice => {}
                    }
                }
                Part::Fence(fence) => lines.push(self.fence_corners(fence)?),
                _ => {}
            }
        }
        Ok(lines)
    }
}

/// Decimals as people type them mean the sample they name.
fn on_sample(index: f64) -> f64 {
    let near = index.round();
    if (index - near).abs() < 1e-6 { near } else { index }
}

/// Whether faces hide what lies behind them, so that surfaces are laid over the picture.
fn is_opaque(scene: &Scene) -> bool {
    scene.media.faces != Faces::None
}
