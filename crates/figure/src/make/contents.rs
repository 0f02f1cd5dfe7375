//! What parts show, found before the page is laid out: the legend lists what is on them.

use super::Maker;
use super::rock::RockOnSection;
use crate::annotation::Annotation;
use crate::correlation::{self, Column, ColumnSource};
use crate::cut::{CutLine, FenceCut, SectionCut, SectionKind, legs, length_m, stations};
use crate::draw::axes::Axis;
use crate::draw::block::BlockPainter;
use crate::draw::overlay::{OverlayLines, SeenOn};
use crate::draw::scale;
use crate::draw::section::{Marks, SectionContents, SectionInk, SectionPanel, Zoom};
use crate::draw::section_wells::WellOnSection;
use crate::draw::throw_profile::FaultProfile;
use crate::error::FigureError;
use crate::spec::{FencePart, Part, SectionPart, ThrowPart};
use crate::style::INK;
use glam::DVec2;
use image::RgbaImage;
use model::section::{LineKind, SectionPlane};
use page::Rect;
use page::list::Group;
use std::sync::Arc;
use survey::Contact;

/// What a part shows.
pub(super) enum Prepared {
    /// A block or a map, which nothing else needs to know of.
    Later,
    /// A section or a fence.
    Section(Box<PreparedSection>),
    /// Wells, and the range of their axis.
    Wells(Vec<Column>, [f64; 2]),
    /// What is measured along a fault.
    Profile(Box<FaultProfile>),
}

/// A section or a fence.
pub(super) struct PreparedSection {
    title: String,
    /// Largest s and t.
    pub extent: DVec2,
    extent_m: DVec2,
    axes: [Axis; 2],
    /// Which part of it is seen.
    pub zoom: Zoom,
    /// Down to across.
    pub proportions: Option<f64>,
    wells: Vec<WellOnSection>,
    is_plan: bool,
    marks: Marks,
    on: Place,
    image: Arc<RgbaImage>,
    /// Lines of the model.
    pub lines: Vec<CutLine>,
    /// What an interpreter sees over it.
    pub overlay: Option<OverlayLines>,
    /// From 0, the rock with its patterns, to 1, the picture of samples.
    pub blend: f32,
    /// Its planes, and where each begins along it.
    pub planes: Vec<(f64, SectionPlane)>,
}

impl PreparedSection {
    /// Whether wells are drawn on it.
    pub(super) fn has_wells(&self) -> bool {
        !self.wells.is_empty()
    }

    /// The tops of its wells, (s, t).
    pub(super) fn tops(&self) -> impl Iterator<Item = DVec2> {
        self.wells.iter().flat_map(|well| well.tops.iter().map(|(_, st)| *st))
    }
}

/// Where a section lies.
pub(super) enum Place {
    Section(SectionKind, f64),
    Fence(Vec<DVec2>),
}

impl Place {
    fn seen_on(&self) -> SeenOn<'_> {
        match self {
            Self::Section(kind, at) => SeenOn::Section(*kind, *at),
            Self::Fence(corners) => SeenOn::Fence(corners),
        }
    }
}

impl Maker<'_> {
    /// Cuts sections and fences, and makes columns of wells.
    pub(super) fn prepared(&self, part: &Part) -> Result<Prepared, FigureError> {
        let mut section = match part {
            Part::Block(_) | Part::Map(_) => return Ok(Prepared::Later),
            Part::Section(part) => self.section(part)?,
            Part::Fence(part) => self.fence(part)?,
            Part::Throw(part) => return self.profile(part).map(|profile| Prepared::Profile(Box::new(profile))),
            Part::Correlation(part) => {
                let model = self.inputs.source.data.model.filter(|_| !self.figure.interpretation);
                let (wells, horizons) = (self.inputs.wells, self.inputs.strata);
                let source = ColumnSource { wells, geometry: self.geometry, horizons, model };
                let columns = correlation::columns(part, &source)?;
                let range = correlation::range(part, &columns)?;
                return Ok(Prepared::Wells(columns, range));
            }
        };
        let [nx, ny, _] = self.geometry.size();
        let shown = self.interpretation()?;
        if shown.is_some() || self.inputs.source.data.model.is_none() {
            section.blend = 1.0;
        }
        section.overlay = shown.map(|shown| OverlayLines::new(shown, [nx, ny], section.on.seen_on()));
        Ok(Prepared::Section(Box::new(section)))
    }

    fn profile(&self, part: &ThrowPart) -> Result<FaultProfile, FigureError> {
        let known = self.inputs.faults;
        let missing = || FigureError::NoFault { fault: part.fault.clone(), known: known.to_vec() };
        let fault = known.iter().position(|name| *name == part.fault).ok_or_else(missing)?;
        let none = || FigureError::NoThrow { fault: part.fault.clone() };
        let model = self.inputs.source.data.model.ok_or_else(none)?;
        FaultProfile::new(model, self.geometry, fault, part.fault.clone()).ok_or_else(none)
    }

    fn section(&self, part: &SectionPart) -> Result<PreparedSection, FigureError> {
        let (kind, at) = (part.kind, self.voxel_at(part.kind, part.at)?);
        let cut = SectionCut::new(&self.inputs.source, kind, at, part.show);
        let unit = if kind == SectionKind::Slice { self.geometry.vertical.unit.symbol() } else { "" };
        let title = format!("{} {} {unit}", kind.name(), part.at).trim_end().to_owned();
        let extent = kind.extent(self.geometry.size());
        let vectors =
            [self.geometry.inline_vector.length(), self.geometry.crossline_vector.length(), self.geometry.sample_m()];
        let [s, t] = kind.axes();
        Ok(PreparedSection {
            title,
            extent,
            extent_m: extent * DVec2::new(vectors[s], vectors[t]),
            axes: [self.axis(s, extent.x), self.axis(t, extent.y)],
            zoom: part.zoom,
            proportions: part.proportions,
            wells: self.wells_where(|well| WellOnSection::of(well, self.geometry, kind, at)),
            is_plan: kind == SectionKind::Slice,
            marks: self.marks_on(kind)?,
            on: Place::Section(kind, at),
            image: Arc::new(cut.image),
            lines: self.shown_lines(cut.lines),
            overlay: None,
            blend: part.blend.unwrap_or(1.0),
            planes: vec![(0.0, kind.plane(at, self.geometry.size()))],
        })
    }

    /// The erosional horizons.
    fn unconformities(&self) -> Vec<usize> {
        let strata = self.inputs.strata.iter().enumerate();
        strata.filter(|(_, horizon)| horizon.contact == Contact::Erosional).map(|(index, _)| index).collect()
    }

    /// The wells near a section or a fence, where wells are named.
    fn wells_where(&self, near: impl Fn(&survey::Well) -> Option<WellOnSection>) -> Vec<WellOnSection> {
        let is_hidden = |well: &&survey::Well| {
            let scenes = self.figure.parts.iter().filter_map(|part| match part {
                Part::Block(block) => Some(&block.scene),
                _ => None,
            });
            self.figure.hides(&well.name) || scenes.into_iter().any(|scene| scene.hides_well(&well.name))
        };
        let wells = self.inputs.wells.iter().filter(|well| self.wants(Annotation::Wells) && !is_hidden(well));
        let coloured = |well: WellOnSection| {
            let own = self.inputs.source.data.wells.iter().find(|drawn| drawn.name == well.name);
            WellOnSection { colour: own.and_then(|drawn| drawn.colour).unwrap_or(well.colour), ..well }
        };
        wells.filter_map(near).map(coloured).collect()
    }

    /// The lines of what is not hidden.
    fn shown_lines(&self, mut lines: Vec<CutLine>) -> Vec<CutLine> {
        let is_hidden = |name: Option<&str>| name.is_some_and(|name| self.figure.hides(name));
        lines.retain(|line| match line.kind {
            LineKind::Horizon { horizon } => {
                !is_hidden(self.inputs.horizons.get(horizon).map(|known| known.name.as_str()))
            }
            LineKind::Fault { fault, .. } => !is_hidden(self.inputs.faults.get(fault).map(String::as_str)),
            LineKind::Frame => true,
        });
        lines
    }

    fn fence(&self, part: &FencePart) -> Result<PreparedSection, FigureError> {
        let corners = self.fence_corners(part)?;
        let cut = FenceCut::new(&self.inputs.source, &corners, part.show);
        let along = stations(&corners);
        let depth = self.geometry.size()[2].saturating_sub(1).max(1) as f64;
        let extent = DVec2::new(along.last().copied().unwrap_or(1.0), depth);
        let length_m = length_m(self.geometry, &corners);
        let ground = Axis { name: "Distance (m)".into(), ends: [0.0, length_m], at: [0.0; 2], least_step: 0.0 };
        Ok(PreparedSection {
            title: "Fence".into(),
            extent,
            extent_m: DVec2::new(length_m, depth * self.geometry.sample_m()),
            axes: [ground, self.axis(2, depth)],
            zoom: Zoom::default(),
            proportions: None,
            wells: self.wells_where(|well| WellOnSection::on_fence(well, self.geometry, &corners)),
            is_plan: false,
            // Where it turns.
            marks: Marks { down: along[1..along.len() - 1].to_vec(), ..Marks::default() },
            planes: legs(&corners, depth).into_iter().zip(along).map(|(plane, along)| (along, plane)).collect(),
            on: Place::Fence(corners),
            image: Arc::new(cut.image),
            lines: self.shown_lines(cut.lines),
            overlay: None,
            blend: part.blend.unwrap_or(1.0),
        })
    }

    /// The panel of a section or a fence.
    pub(super) fn panel(
        &self,
        section: PreparedSection,
        room: Rect,
        painter: &mut dyn BlockPainter,
    ) -> Result<Group, FigureError> {
        let shown = self.interpretation()?;
        let cuts = self.cuts(&section);
        let on = match &section.on {
            Place::Section(kind, at) => Place::Section(*kind, *at),
            Place::Fence(corners) => Place::Fence(corners.clone()),
        };
        let mut rock = RockOnSection {
            maker: self,
            cuts: &cuts,
            planes: section.planes.clone(),
            extent: section.extent,
            blend: section.blend,
            on,
            painter,
        };
        let vertical = &self.geometry.vertical;
        let unit_m = self.geometry.sample_m() / vertical.interval.abs();
        let caption: Box<dyn Fn(f64) -> String> = Box::new(|factor| scale::exaggeration(factor, self.geometry));
        let drawn = SectionPanel {
            title: section.title,
            contents: SectionContents {
                image: &section.image,
                extent: section.extent,
                lines: &section.lines,
                horizons: self.inputs.horizons,
                faults: self.inputs.faults,
                fault_colours: self.inputs.fault_colours,
                interpretation: shown
                    .zip(section.overlay.as_ref())
                    .map(|(shown, overlay)| (shown, overlay, section.on.seen_on())),
                marks: section.marks,
            },
            wells: section.wells,
            axes: section.axes,
            zoom: section.zoom,
            proportions: section.proportions,
            extent_m: section.extent_m,
            is_plan: section.is_plan,
            caption: self.figure.scale_bar.then_some(caption),
            down: (!section.is_plan).then(|| (unit_m, vertical.unit.symbol())),
            ink: (section.blend <= 0.0).then(|| SectionInk { colour: INK, unconformities: self.unconformities() }),
        }
        .drawn(room, &mut rock)?;
        if drawn.items.is_empty() {
            return Err(self.no_room());
        }
        Ok(drawn)
    }
}
