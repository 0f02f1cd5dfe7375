//! What a figure's legend lists: what is seen on it, and nothing else.

use super::Maker;
use super::prepared::Prepared;
use crate::annotation::Annotation;
use crate::cut::CutLine;
use crate::draw::NamedColour;
use crate::draw::block::Comparison;
use crate::draw::legend::{Legend, LegendLine};
use crate::draw::section::Zoom;
use crate::draw::seen::{Seen, seen};
use crate::draw::water::colour_on_paper;
use crate::list::{GroupKind, Stroke};
use crate::spec::{BlockPart, Part};
use crate::style::{FAULT_PT, HORIZON_PT};
use glam::DVec2;
use model::section::LineKind;
use render::distortion::{self, Stretch};
use render::{FaceData, Faces, Scene};
use std::collections::BTreeSet;
use survey::Contact;
use ttf::{Colour, LayerStyle};

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

/// The horizons whose lines lie in the part of a section that is seen.
fn horizons_on(lines: &[CutLine], extent: DVec2, zoom: Zoom) -> BTreeSet<usize> {
    let middle = DVec2::from_array(zoom.middle);
    let reach = 0.5 / zoom.factor.max(1.0) + 1e-9;
    let is_seen = |st: &DVec2| (*st / extent - middle).abs().max_element() <= reach;
    let seen = lines.iter().filter_map(|line| match line.kind {
        LineKind::Horizon { horizon } => line.points.iter().any(is_seen).then_some(horizon),
        _ => None,
    });
    seen.collect()
}

impl Listed {
    /// The legend; `None` where there is nothing to list.
    pub(super) fn legend<'a>(&'a self, maker: &Maker<'a>) -> Option<Legend<'a>> {
        let layers = maker.inputs.library.map(|library| (&self.layers[..], library));
        let legend = Legend { layers, horizons: &self.horizons, lines: &self.lines, dpi: maker.figure.dpi };
        (!legend.is_empty()).then_some(legend)
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
                    None => horizons.extend(horizons_on(&section.lines, section.extent, section.zoom)),
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
                .chain(layers.into_iter().filter_map(|layer| self.inputs.layers.get(layer).cloned()))
                .collect(),
        };
        let named = horizons.into_iter().filter_map(|horizon| self.inputs.horizons.get(horizon).cloned());
        listed.horizons.extend(named);
        listed
    }

    /// Water, where a block shows it.
    fn water(&self) -> Option<LayerStyle> {
        let shown = self.figure.parts.iter().find_map(|part| match part {
            Part::Block(block) => block.scene.water.filter(|_| block.scene.ground.is_some()),
            _ => None,
        });
        let is_modelled = self.inputs.source.data.model.is_some() && !self.figure.interpretation;
        shown.filter(|_| is_modelled).map(|water| LayerStyle::plain("Water", colour_on_paper(&water)))
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

    /// What is seen of a block.
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
        for line in self.lines_of(&block.scene, &seen) {
            if !listed.lines.contains(&line) {
                listed.lines.push(line);
            }
        }
    }

    /// The contacts, faults and wells that are seen.
    fn lines_of(&self, scene: &Scene, seen: &Seen) -> Vec<LegendLine> {
        let mut lines = Vec::new();
        let mut add = |name: String, kind: GroupKind, width: f64, colour: Colour| {
            lines.push(LegendLine { name, kind, stroke: Stroke::new(width, colour) });
        };
        let outlines = scene.outlines;
        if outlines.horizons.width_px > 0.0 {
            let strata = || seen.horizons.iter().filter_map(|index| self.inputs.strata.get(*index));
            if strata().any(|horizon| horizon.contact == Contact::Conformable) {
                add("Contact".into(), GroupKind::Horizon, 0.7 * HORIZON_PT, outlines.horizons.colour);
            }
            for horizon in strata() {
                let contact = match horizon.contact {
                    Contact::Conformable => continue,
                    // That it is cut off can be seen.
                    Contact::Truncated => Contact::Intrusive,
                    other => other,
                };
                let name = format!("{} ({})", horizon.name, contact.word());
                add(name, GroupKind::Horizon, 0.7 * HORIZON_PT, outlines.horizons.colour);
            }
        }
        if outlines.faults.width_px > 0.0 && !seen.faults.is_empty() {
            add("Fault".into(), GroupKind::Fault, FAULT_PT, outlines.faults.colour);
        }
        if self.wants(Annotation::Wells) && !seen.wells.is_empty() {
            // Each has its name beside it.
            add("Well".into(), GroupKind::Well, 2.0 * HORIZON_PT, scene.wells.colour);
            return lines;
        }
        for well in seen.wells.iter().filter_map(|index| self.inputs.source.data.wells.get(*index)) {
            add(well.name.to_owned(), GroupKind::Well, 2.0 * HORIZON_PT, scene.wells.colour);
        }
        lines
    }
}
