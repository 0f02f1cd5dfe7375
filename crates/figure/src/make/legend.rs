//! What a figure's legend lists: what is seen on it, and nothing else.

use super::Maker;
use super::contents::{Prepared, PreparedSection};
use crate::annotation::Annotation;
use crate::cut::CutLine;
use crate::draw::NamedColour;
use crate::draw::block::Comparison;
use crate::draw::legend::{Legend, LegendLine};
use crate::draw::section::{Zoom, contact_pt, quality_stroke};
use crate::draw::section_wells::TOP_PT;
use crate::draw::sight::{Seen, seen};
use crate::draw::water::{colour_on_paper, has_water};
use crate::spec::{BlockPart, Part};
use crate::style::{FAULT_PT, HORIZON_PT, INK};
use glam::DVec2;
use model::section::{LineKind, LineQuality};
use page::list::{GroupKind, Stroke};
use render::distortion::{self, Stretch};
use render::{FaceData, Faces, Scene, Unpicked};
use std::collections::BTreeSet;
use survey::Contact;
use ttf::{Colour, LayerStyle, TextureLibrary};

/// No line of a legend is finer, points.
const FINEST_PT: f64 = 0.35;
/// Half the length and the height of the ring that stands for a top on a block, widths of the well.
const RING: f64 = 0.8;

/// What a legend lists.
#[derive(Debug, Default)]
pub(super) struct Listed {
    layers: Vec<LayerStyle>,
    horizons: Vec<NamedColour>,
    lines: Vec<LegendLine>,
}

/// The colours of a picture of distortion, densest on top.
fn distortion_classes() -> Vec<LayerStyle> {
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
}

/// Whether a block shows the patterns of layers.
fn is_illustrated(block: &BlockPart) -> bool {
    let has_blend = match block.comparison {
        Comparison::None => block.scene.blend < 1.0,
        Comparison::SideBySide(blends) | Comparison::Wipe(blends, _) => blends.iter().any(|blend| *blend < 1.0),
    };
    has_blend && block.scene.media.faces != Faces::None
}

/// The layers without those that are a sliver above a layer of the same look, and called so ("Above Sand" on "Sand").
fn told_apart(layers: &[LayerStyle]) -> Vec<LayerStyle> {
    let is_same = |above: &LayerStyle, below: &LayerStyle| {
        above.layer.strip_prefix("Above ").is_some_and(|of| of == below.layer)
            && LayerStyle { layer: String::new(), ..above.clone() }
                == LayerStyle { layer: String::new(), ..below.clone() }
    };
    let is_kept = |layer: &LayerStyle| !layers.iter().any(|below| is_same(layer, below));
    layers.iter().filter(|layer| is_kept(layer)).cloned().collect()
}

/// Whether a place lies in the part of a section that is seen.
fn is_seen(st: DVec2, extent: DVec2, zoom: Zoom) -> bool {
    let reach = 0.5 / zoom.factor.max(1.0) + 1e-9;
    (st / extent - DVec2::from_array(zoom.middle)).abs().max_element() <= reach
}

/// The lines of a section that lie in the part of it that is seen.
fn seen_lines(section: &PreparedSection) -> Seen {
    let mut seen = Seen::default();
    let in_sight = |line: &&CutLine| line.points.iter().any(|st| is_seen(*st, section.extent, section.zoom));
    for line in section.lines.iter().filter(in_sight) {
        match line.kind {
            LineKind::Horizon { horizon } => {
                seen.horizons.insert(horizon);
                seen.qualities.insert(line.quality);
            }
            LineKind::Fault { fault, .. } => {
                seen.faults.insert(fault);
            }
            LineKind::Frame => {}
        }
    }
    seen
}

impl Listed {
    /// Adds lines that are not listed yet.
    fn add_lines(&mut self, lines: Vec<LegendLine>) {
        for line in lines {
            if !self.lines.contains(&line) {
                self.lines.push(line);
            }
        }
    }

    /// The legend; `None` where there is nothing to list.
    pub(super) fn legend<'a>(&'a self, maker: &Maker<'a>) -> Option<Legend<'a>> {
        self.drawn_with(maker.inputs.library, maker.figure.dpi)
    }

    /// The same with the library that has the patterns.
    pub(super) fn drawn_with<'a>(&'a self, library: Option<&'a TextureLibrary>, dpi: f64) -> Option<Legend<'a>> {
        let layers = library.map(|library| (&self.layers[..], library));
        let legend = Legend { layers, horizons: &self.horizons, lines: &self.lines, dpi };
        (!legend.is_empty()).then_some(legend)
    }

    /// Adds what another block of a series shows. A layer that is new stands above the one that it lies on there.
    pub(super) fn join(&mut self, other: Self) {
        let mut above = self.layers.len();
        for layer in other.layers.into_iter().rev() {
            match self.layers.iter().position(|known| known.layer == layer.layer) {
                Some(known) => above = known,
                None => self.layers.insert(above, layer),
            }
        }
        self.layers = told_apart(&self.layers);
        for horizon in other.horizons {
            if !self.horizons.iter().any(|known| known.name == horizon.name) {
                self.horizons.push(horizon);
            }
        }
        self.add_lines(other.lines);
    }
}

impl Maker<'_> {
    /// What the legend lists: layers where blocks and wells show them, or the colours of distortion; horizons where
    /// sections show their lines; contacts, faults and wells. `size` is about that of the parts.
    pub(super) fn listed(&self, prepared: &[Prepared], size: DVec2) -> Listed {
        let mut listed = Listed::default();
        if !self.figure.legend {
            return listed;
        }
        let mut layers: BTreeSet<usize> = BTreeSet::new();
        let mut horizons: BTreeSet<usize> = BTreeSet::new();
        for (part, prepared) in self.figure.parts.iter().zip(prepared) {
            match (part, prepared) {
                (Part::Block(_), _) if self.figure.interpretation => horizons.extend(self.picked()),
                (Part::Block(block), _) => self.list_block(block, size, &mut listed, &mut layers),
                (_, Prepared::Section(section)) => match &section.overlay {
                    Some(overlay) => horizons.extend(overlay.seen_horizons().filter_map(|name| self.horizon(name))),
                    None => self.list_section(section, &mut listed, &mut layers, &mut horizons),
                },
                (_, Prepared::Wells(columns, range)) => {
                    let own = columns.iter().flat_map(|column| column.intervals.iter().map(move |i| (column.shift, i)));
                    let own = own.filter(|(shift, i)| i.z[0] - shift < range[1] && i.z[1] - shift > range[0]);
                    layers.extend(own.map(|(_, interval)| interval.layer));
                }
                _ => {}
            }
        }
        let is_measured =
            |part: &Part| matches!(part, Part::Block(block) if block.scene.face_data == FaceData::Distortion);
        listed.layers = match self.figure.parts.iter().any(is_measured) {
            true => distortion_classes(),
            false => self
                .water()
                .into_iter()
                .chain(told_apart(
                    &layers.into_iter().filter_map(|layer| self.inputs.layers.get(layer).cloned()).collect::<Vec<_>>(),
                ))
                .collect(),
        };
        let named = horizons.into_iter().filter_map(|horizon| self.inputs.horizons.get(horizon).cloned());
        listed.horizons.extend(named);
        listed
    }

    /// Water, where a block shows it.
    fn water(&self) -> Option<LayerStyle> {
        let model = self.inputs.source.data.model?;
        let shown = self.figure.parts.iter().find_map(|part| match part {
            Part::Block(block) => block.scene.water.filter(|_| has_water(&block.scene, self.geometry, model)),
            _ => None,
        });
        shown.filter(|_| !self.figure.interpretation).map(|water| LayerStyle::plain("Water", colour_on_paper(&water)))
    }

    /// The horizons that an interpreter sees in front of a block.
    fn picked(&self) -> BTreeSet<usize> {
        let shown = self.inputs.interpretation.into_iter().flat_map(|shown| &shown.horizons);
        let has_sheets =
            shown.filter(|horizon| horizon.sheets.iter().any(|sheet| sheet.z.iter().any(|z| z.is_finite())));
        has_sheets.filter_map(|horizon| self.horizon(horizon.name)).collect()
    }

    /// The place of a horizon among all.
    fn horizon(&self, name: &str) -> Option<usize> {
        self.inputs.horizons.iter().position(|horizon| horizon.name == name)
    }

    /// What is seen of a section: its layers where it shows rock, and horizons by the colours of their lines, or contacts
    /// where all lines are of one ink.
    fn list_section(
        &self,
        section: &PreparedSection,
        listed: &mut Listed,
        layers: &mut BTreeSet<usize>,
        horizons: &mut BTreeSet<usize>,
    ) {
        let seen = seen_lines(section);
        if let (Some(model), true) = (self.inputs.source.data.model, section.blend < 1.0) {
            let youngest = model.layer_count() - 1;
            for ((station, _), cut) in section.planes.iter().zip(self.cuts(section)) {
                let place = |st: &DVec2| is_seen(*st + DVec2::new(*station, 0.0), section.extent, section.zoom);
                let own = cut.polygons.iter().filter(|polygon| polygon.rings.iter().flatten().any(place));
                layers.extend(own.map(|polygon| youngest - usize::from(polygon.region.layer)));
            }
        }
        let is_inked = section.blend <= 0.0;
        let pen = |width: f64, colour: Colour| Stroke::new(width, colour);
        let [contact, unconformity] = [false, true].map(|is_heavy| pen(contact_pt(is_heavy), INK));
        if is_inked {
            listed.add_lines(self.contacts(&seen, &contact, &unconformity));
        } else {
            horizons.extend(&seen.horizons);
        }
        if self.wants(Annotation::Quality) {
            listed.add_lines(qualities(&seen, &contact));
        }
        listed.add_lines(self.faults(&seen, |own| pen(FAULT_PT, own.unwrap_or(Colour::BLACK))));
        if section.has_wells() {
            let well = pen(HORIZON_PT, INK);
            listed.add_lines(vec![LegendLine::well("Well", well.clone())]);
            if section.tops().any(|st| is_seen(st, section.extent, section.zoom)) {
                listed.add_lines(vec![LegendLine::well_top(well.clone(), (TOP_PT, well))]);
            }
        }
    }

    /// What is seen of a block that is about so large, points.
    fn list_block(&self, block: &BlockPart, size: DVec2, listed: &mut Listed, layers: &mut BTreeSet<usize>) {
        let data = &self.inputs.source.data;
        for horizon in &block.scene.media.horizons {
            let Some(name) = &horizon.name else { continue };
            if !listed.horizons.iter().any(|known| known.name == *name) {
                listed.horizons.push(NamedColour { name: name.clone(), colour: horizon.colour });
            }
        }
        let Some(model) = data.model else { return };
        let size_px = (size * 4.0).round().clamp(DVec2::ONE, DVec2::splat(4000.0));
        let scene = Scene { size_px: [size_px.x as u32, size_px.y as u32], ..block.scene.clone() };
        let seen = seen(&scene, self.geometry, model, data.wells);
        if is_illustrated(block) {
            let youngest = model.layer_count() - 1;
            layers.extend(seen.layers.iter().map(|layer| youngest - usize::from(*layer)));
        }
        let points_per_px = size.min_element() / f64::from(render::NOMINAL_SIDE_PX);
        listed.add_lines(self.lines_of(&block.scene, &seen, points_per_px));
    }

    /// The contacts of horizons that are seen, unconformities by their names.
    fn contacts(&self, seen: &Seen, plain: &Stroke, unconformity: &Stroke) -> Vec<LegendLine> {
        let strata = || seen.horizons.iter().filter_map(|index| Some((index, self.inputs.strata.get(*index)?)));
        let has_plain = strata().any(|(_, horizon)| horizon.contact == Contact::Conformable);
        let mut lines = Vec::new();
        lines.extend(has_plain.then(|| LegendLine::new("Contact", GroupKind::Horizon, plain.clone())));
        for (index, horizon) in strata() {
            if self.inputs.outlined.contains(index) {
                lines.push(LegendLine::new(&horizon.name, GroupKind::Horizon, plain.clone()));
                continue;
            }
            let (contact, stroke) = match horizon.contact {
                Contact::Conformable => continue,
                // That it is cut off can be seen.
                Contact::Truncated => (Contact::Intrusive, plain),
                Contact::Erosional => (Contact::Erosional, unconformity),
                other => (other, plain),
            };
            let name = format!("{} ({})", horizon.name, contact.word());
            lines.push(LegendLine::new(&name, GroupKind::Horizon, stroke.clone()));
        }
        lines
    }

    /// The faults that are seen; those with a colour of their own by their names.
    fn faults(&self, seen: &Seen, pen: impl Fn(Option<Colour>) -> Stroke) -> Vec<LegendLine> {
        let line = |fault: &usize| {
            let own = self.inputs.fault_colours.get(*fault).copied().flatten();
            let name = own.and_then(|_| self.inputs.faults.get(*fault)).map_or("Fault", String::as_str);
            LegendLine::new(name, GroupKind::Fault, pen(own))
        };
        seen.faults.iter().map(line).collect()
    }

    /// The contacts, faults and wells that are seen of a block, drawn as they are on it.
    fn lines_of(&self, scene: &Scene, seen: &Seen, points_per_px: f64) -> Vec<LegendLine> {
        let outlines = scene.outlines;
        let pen = |stroke: render::Stroke| {
            Stroke::new((f64::from(stroke.width_px) * points_per_px).max(FINEST_PT), stroke.colour)
        };
        let mut lines = Vec::new();
        if outlines.horizons.width_px > 0.0 {
            let [plain, unconformity] = [false, true].map(|is_heavy| pen(outlines.of_horizon(is_heavy)));
            lines.extend(self.contacts(seen, &plain, &unconformity));
            if self.wants_dashes() || outlines.unpicked == Unpicked::Dashed {
                lines.extend(qualities(seen, &plain));
            }
        }
        if outlines.faults.width_px > 0.0 {
            lines.extend(self.faults(seen, |own| pen(outlines.of_fault(own.map(|own| scene.preset.line(own))))));
        }
        let well = Stroke::new(2.0 * HORIZON_PT, scene.wells.colour);
        let wells = seen.wells.iter().filter_map(|index| self.inputs.source.data.wells.get(*index));
        if self.wants(Annotation::Wells) && !seen.wells.is_empty() {
            // Each has its name beside it.
            lines.push(LegendLine::well("Well", well.clone()));
        } else {
            lines.extend(wells.map(|named| LegendLine::well(named.name, well.clone())));
        }
        let ring = (RING * well.width, Stroke::new(RING * well.width, scene.wells.top_colour));
        lines.extend(seen.has_tops.then(|| LegendLine::well_top(well, ring)));
        lines
    }
}

/// What dashes of horizons mean, where they are seen.
fn qualities(seen: &Seen, stroke: &Stroke) -> Vec<LegendLine> {
    let kinds = [(LineQuality::Approximate, "Contact, approximate"), (LineQuality::Inferred, "Contact, inferred")];
    let line = |(quality, name): &(LineQuality, &str)| {
        LegendLine::new(name, GroupKind::Horizon, quality_stroke(stroke.clone(), *quality))
    };
    kinds.iter().filter(|(quality, _)| seen.qualities.contains(quality)).map(line).collect()
}
