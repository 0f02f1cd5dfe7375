//! From what a figure shows to its page: the one way that figures are made.

use crate::Rect;
use crate::annotation::Annotation;
use crate::cut::{FenceCut, SectionCut, SectionKind, SectionSource, length_m, stations, value_at};
use crate::draw::annotation::BlockAnnotation;
use crate::draw::axes::Axis;
use crate::draw::block::{BlockPainter, BlockPanel, Comparison};
use crate::draw::legend::{Legend, LegendLine};
use crate::draw::map::{MapPanel, title};
use crate::draw::overlay::{OverlayLines, SeenOn};
use crate::draw::section::{Marks, SectionContents, SectionPanel, Zoom};
use crate::draw::vector_block::BlockNames;
use crate::draw::{NamedColour, colour_bar, north, scale, words};
use crate::error::FigureError;
use crate::interpretation::DrawnInterpretation;
use crate::list::{DisplayList, Group, GroupKind, Ink, Item, POINTS_PER_INCH, Stroke};
use crate::map::{HorizonMap, MapSource, Mapped};
use crate::spec::{BlockPart, FencePart, Figure, MapPart, Part, SectionPart};
use crate::style::{FAULT_PT, HORIZON_PT};
use glam::DVec2;
use render::distortion::{self, Stretch};
use render::{Background, FaceData, Faces, Scene};
use std::sync::{Arc, OnceLock};
use survey::{Contact, SurveyGeometry, VerticalUnit};
use ttf::{Colour, LayerStyle, RawColour, TextureLibrary};

/// Room around a page whose parts have text at their edges, points.
const MARGIN_PT: f64 = 8.0;
/// Room between parts, points.
const GAP_PT: f64 = 9.0;
/// Least width and height of what is left for the parts, points.
const LEAST_PT: f64 = 20.0;
/// Share of the page that a legend may take.
const LEGEND_SHARE: f64 = 0.36;
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
    /// Names of the faults.
    pub faults: &'a [String],
    /// The layers as they are drawn, youngest first.
    pub layers: &'a [LayerStyle],
    /// Patterns of the layers.
    pub library: Option<&'a TextureLibrary>,
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
    crate::raster::size_px(&list, figure.dpi)?;
    list.paper = paper(figure);
    let maker = Maker { figure, inputs, geometry: inputs.source.data.geometry };
    let lines = maker.legend_lines();
    let legend = maker.legend(&lines);
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
    let words = [
        (&figure.title, words::title as fn(Rect, &str) -> (Group, Rect)),
        (&provenance, words::provenance),
        (&figure.caption, words::caption),
    ];
    for (said, place) in words {
        if let Some(said) = said {
            let (group, rest) = place(room, said);
            list.items.push(group.into());
            room = rest;
        }
    }
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
        let width = legend.width(LEGEND_SHARE * room.width());
        let [left, right] = room.split_across(1.0 - width / room.width());
        list.items.push(legend.drawn(right.inside([0.0, 2.0, 0.0, 0.0]))?.into());
        room = left.inside([0.0, 0.0, GAP_PT, 0.0]);
    }
    if !is_bare && room.size().min_element() < LEAST_PT {
        return Err(maker.no_room());
    }
    let rooms = rooms(figure.parts.len(), room);
    let mut panels: Vec<Item> = Vec::new();
    for (part, room) in figure.parts.iter().zip(rooms) {
        panels.push(maker.part(part, room, painter)?.into());
    }
    // The legend explains what is drawn before it.
    panels.append(&mut list.items);
    list.items = panels;
    list.print(figure.printed_in());
    Ok(list)
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

/// The colours of a picture of distortion, densest on top.
fn distortion_classes() -> &'static [LayerStyle] {
    static CLASSES: OnceLock<Vec<LayerStyle>> = OnceLock::new();
    CLASSES.get_or_init(|| {
        let classes = [
            (4.0, "4 × too dense"),
            (2.0, "2 × too dense"),
            (1.0, "undistorted"),
            (0.5, "2 × too sparse"),
            (0.25, "4 × too sparse"),
        ];
        let class = |(area, name): (f32, &str)| {
            let side = area.sqrt();
            let colour = distortion::tone(Stretch { densest: side, sparsest: side });
            LayerStyle::plain(name, Colour::from_unit(colour.to_array()))
        };
        classes.map(class).to_vec()
    })
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
            Part::Section(_) | Part::Fence(_) => self.inputs.source.raw,
            Part::Map(_) => None,
        };
        self.figure.parts.iter().find_map(shows).filter(|_| self.wants(Annotation::Colours))
    }

    /// Layers where blocks show them, or the colours of distortion; horizons where sections show their lines.
    fn legend<'b>(&'b self, lines: &'b [LegendLine]) -> Option<Legend<'b>> {
        let parts = &self.figure.parts;
        let is_illustrated = |block: &BlockPart| match block.comparison {
            Comparison::None => block.scene.blend < 1.0,
            Comparison::SideBySide(blends) | Comparison::Wipe(blends, _) => blends.iter().any(|blend| *blend < 1.0),
        };
        let has_layers = !self.figure.interpretation
            && parts.iter().any(|part| matches!(part, Part::Block(block) if is_illustrated(block)));
        let is_measured =
            |part: &Part| matches!(part, Part::Block(block) if block.scene.face_data == FaceData::Distortion);
        let swatches = if parts.iter().any(is_measured) { distortion_classes() } else { self.seen_layers() };
        let layers = self.inputs.library.filter(|_| has_layers).map(|library| (swatches, library));
        let has_lines = parts.iter().any(|part| matches!(part, Part::Section(_) | Part::Fence(_)));
        let horizons = if has_lines || layers.is_none() { self.inputs.horizons } else { &[] };
        let legend = Legend { layers, horizons, lines, dpi: self.figure.dpi };
        (self.figure.legend && !legend.is_empty()).then_some(legend)
    }

    /// The layers without the one that is left out as air wherever a ground is shown.
    fn seen_layers(&self) -> &'a [LayerStyle] {
        let layers = self.inputs.layers;
        let has_ground = |part: &Part| matches!(part, Part::Block(block) if block.scene.ground.is_some());
        let is_air = self.inputs.source.data.model.is_some_and(|model| model.layer_count() == layers.len())
            && self.figure.parts.iter().all(has_ground);
        if is_air { layers.get(1..).unwrap_or_default() } else { layers }
    }

    /// Faults, contacts and wells that blocks of the model show.
    fn legend_lines(&self) -> Vec<LegendLine> {
        let blocks = self.figure.parts.iter().find_map(|part| match part {
            Part::Block(block) => Some(&block.scene),
            _ => None,
        });
        let data = &self.inputs.source.data;
        let (Some(scene), Some(model), false) = (blocks, data.model, self.figure.interpretation) else {
            return Vec::new();
        };
        let mut lines = Vec::new();
        let mut add = |name: String, kind: GroupKind, width: f64, colour: Colour| {
            lines.push(LegendLine { name, kind, stroke: Stroke::new(width, colour) });
        };
        let outlines = scene.outlines;
        if outlines.horizons.width_px > 0.0 && scene.media.faces == Faces::All {
            for horizon in &model.stratigraphy().horizons {
                let contact = match horizon.contact {
                    Contact::Conformable => continue,
                    Contact::Erosional => "erosional",
                    Contact::Onlap => "onlap",
                    Contact::Intrusive => "intrusive",
                };
                let name = format!("{} ({contact})", horizon.name);
                add(name, GroupKind::Horizon, 0.7 * HORIZON_PT, outlines.horizons.colour);
            }
        }
        if outlines.faults.width_px > 0.0 && scene.media.faces == Faces::All && !self.inputs.faults.is_empty() {
            add("Fault".into(), GroupKind::Fault, FAULT_PT, outlines.faults.colour);
        }
        if scene.wells.radius > 0.0 {
            for well in data.wells {
                add(well.name.to_owned(), GroupKind::Well, 2.0 * HORIZON_PT, scene.wells.colour);
            }
        }
        lines
    }

    fn part(&self, part: &Part, room: Rect, painter: &mut dyn BlockPainter) -> Result<Group, FigureError> {
        match part {
            Part::Block(part) => self.block(part, room, painter),
            Part::Section(part) => self.section(part, room),
            Part::Fence(part) => self.fence(part, room),
            Part::Map(part) => self.map(part, room),
        }
    }

    fn block(&self, part: &BlockPart, room: Rect, painter: &mut dyn BlockPainter) -> Result<Group, FigureError> {
        let strip = match (self.figure.north_arrow, self.figure.scale_bar) {
            (true, _) => north::SIDE_PT,
            (false, true) => scale::STRIP_PT,
            (false, false) => 0.0,
        };
        let body = room.inside([0.0, 0.0, 0.0, strip]);
        if body.size().min_element() < 1.0 {
            return Err(self.no_room());
        }
        let names =
            BlockNames { layers: self.inputs.layers, horizons: self.inputs.horizons, faults: self.inputs.faults };
        let panel = BlockPanel {
            scene: &part.scene,
            geometry: self.geometry,
            comparison: part.comparison,
            interpretation: self.interpretation()?,
            has_surfaces: is_opaque(&part.scene),
            dpi: self.figure.dpi,
            annotation: (!self.figure.annotate.is_empty()).then_some(BlockAnnotation {
                wanted: &self.figure.annotate,
                geometry: self.geometry,
                model: self.inputs.source.data.model.filter(|_| !self.figure.interpretation),
                names,
            }),
            names,
        };
        let mut drawn = panel.drawn(body, painter)?;
        let mut below = Rect::new(DVec2::new(room.min.x, body.max.y), room.max);
        if self.figure.north_arrow {
            // At the right end, so that bar and caption keep their place.
            let left = (below.max.x - north::SIDE_PT).max(below.min.x);
            drawn.group.push(north::drawn(Rect::new(DVec2::new(left, below.min.y), below.max), drawn.compass));
            below.max.x = left;
        }
        if self.figure.scale_bar {
            let caption = scale::block_caption(&part.scene, self.geometry);
            drawn.group.push(scale::drawn(below, Some(drawn.points_per_m), &caption));
        }
        Ok(drawn.group)
    }

    fn section(&self, part: &SectionPart, room: Rect) -> Result<Group, FigureError> {
        let (kind, at) = (part.kind, self.voxel_at(part.kind, part.at)?);
        let cut = SectionCut::new(&self.inputs.source, kind, at, part.show);
        let unit = if kind == SectionKind::Slice { self.geometry.vertical.unit.symbol() } else { "" };
        let title = format!("{} {} {unit}", kind.name(), part.at).trim_end().to_owned();
        let extent = kind.extent(self.geometry.size());
        let vectors =
            [self.geometry.inline_vector.length(), self.geometry.crossline_vector.length(), self.geometry.sample_m()];
        let [s, t] = kind.axes();
        let panel = Panel {
            title,
            extent,
            extent_m: extent * DVec2::new(vectors[s], vectors[t]),
            axes: [self.axis(s, extent.x), self.axis(t, extent.y)],
            zoom: part.zoom,
            is_plan: kind == SectionKind::Slice,
            marks: self.marks_on(kind)?,
            on: SeenOn::Section(kind, at),
        };
        self.panel(panel, &Arc::new(cut.image), &cut.lines, room)
    }

    fn fence(&self, part: &FencePart, room: Rect) -> Result<Group, FigureError> {
        let corners = self.fence_corners(part)?;
        let cut = FenceCut::new(&self.inputs.source, &corners, part.show);
        let along = stations(&corners);
        let depth = self.geometry.size()[2].saturating_sub(1).max(1) as f64;
        let extent = DVec2::new(along.last().copied().unwrap_or(1.0), depth);
        let length_m = length_m(self.geometry, &corners);
        let ground = Axis { name: "distance (m)".into(), ends: [0.0, length_m], at: [0.0; 2], least_step: 0.0 };
        let panel = Panel {
            title: "Fence".into(),
            extent,
            extent_m: DVec2::new(length_m, depth * self.geometry.sample_m()),
            axes: [ground, self.axis(2, depth)],
            zoom: Zoom::default(),
            is_plan: false,
            // Where it turns.
            marks: Marks { down: along[1..along.len() - 1].to_vec(), ..Marks::default() },
            on: SeenOn::Fence(&corners),
        };
        self.panel(panel, &Arc::new(cut.image), &cut.lines, room)
    }

    fn panel(
        &self,
        panel: Panel,
        image: &Arc<image::RgbaImage>,
        lines: &[crate::cut::CutLine],
        room: Rect,
    ) -> Result<Group, FigureError> {
        let [nx, ny, _] = self.geometry.size();
        let shown = self.interpretation()?;
        let cut = shown.map(|shown| OverlayLines::new(shown, [nx, ny], panel.on));
        let caption: Box<dyn Fn(f64) -> String> = Box::new(|factor| scale::exaggeration(factor, self.geometry));
        let drawn = SectionPanel {
            title: panel.title,
            contents: SectionContents {
                image,
                extent: panel.extent,
                lines,
                horizons: self.inputs.horizons,
                faults: self.inputs.faults,
                interpretation: shown.zip(cut.as_ref()).map(|(shown, cut)| (shown, cut, panel.on)),
                marks: panel.marks,
            },
            axes: panel.axes,
            zoom: panel.zoom,
            extent_m: panel.extent_m,
            is_plan: panel.is_plan,
            caption: self.figure.scale_bar.then_some(caption),
        }
        .drawn(room);
        if drawn.items.is_empty() {
            return Err(self.no_room());
        }
        Ok(drawn)
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

    /// An axis of the survey from index 0 to `last`.
    fn axis(&self, axis: usize, last: f64) -> Axis {
        let name = match (axis, self.geometry.vertical.unit) {
            (0, _) => "inline",
            (1, _) => "crossline",
            (_, VerticalUnit::Milliseconds) => "two-way time (ms)",
            (_, VerticalUnit::Metres) => "depth (m)",
        };
        let ends = [0.0, last].map(|index| value_at(self.geometry, axis, index));
        Axis { name: name.into(), ends, at: [0.0; 2], least_step: if axis < 2 { 1.0 } else { 0.0 } }
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

/// What a section or a fence brings to its panel.
struct Panel<'a> {
    title: String,
    extent: DVec2,
    extent_m: DVec2,
    axes: [Axis; 2],
    zoom: Zoom,
    is_plan: bool,
    marks: Marks,
    on: SeenOn<'a>,
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
