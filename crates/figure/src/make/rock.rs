//! The rock on a section or a fence, as patterns or half of them, and what is written on it.

use super::Maker;
use super::contents::{Place, PreparedSection};
use crate::annotation::Annotation;
use crate::cut::station_of;
use crate::draw::annotation::room::LabelRoom;
use crate::draw::annotation::{FaceLabels, FaceWriter};
use crate::draw::block::{BlockPainter, painted};
use crate::draw::rock_section::{SectionRange, scene};
use crate::draw::section::SectionPainter;
use crate::draw::vector_block::BlockNames;
use crate::error::FigureError;
use crate::spec::Part;
use glam::{DVec2, DVec3};
use model::section::{Section, SectionPlane};
use page::Rect;
use page::list::{Group, GroupKind, Item, POINTS_PER_INCH, Path};
use render::Scene;
use render::vector::SeenSection;

/// Draws the rock of a section.
pub(super) struct RockOnSection<'a, 'p> {
    pub maker: &'a Maker<'a>,
    /// The model on each plane, where it is asked for.
    pub cuts: &'a [Section],
    /// The planes, and where each begins along the section.
    pub planes: Vec<(f64, SectionPlane)>,
    /// Largest s and t.
    pub extent: DVec2,
    pub blend: f32,
    pub on: Place,
    pub painter: &'p mut dyn BlockPainter,
}

impl Maker<'_> {
    /// What is written on sections.
    fn section_labels(&self, blend: f32) -> FaceLabels {
        FaceLabels {
            layers: self.wants(Annotation::Layers) && blend < 1.0,
            faults: self.wants(Annotation::Faults) || self.wants(Annotation::Heave),
            heave: self.wants(Annotation::Heave),
            queries: self.wants(Annotation::Quality),
        }
    }

    /// The model on the planes of a section, where something is drawn or written by it.
    pub(super) fn cuts(&self, section: &PreparedSection) -> Vec<Section> {
        let is_asked = section.blend < 1.0 || self.section_labels(section.blend).any();
        let model = self.inputs.source.data.model.filter(|_| is_asked && !self.figure.interpretation);
        let cut = |model| section.planes.iter().map(|(_, plane)| Section::new(model, plane)).collect();
        model.map_or_else(Vec::new, cut)
    }

    /// The scene whose look the rock has: that of the figure's block.
    fn rock_scene(&self) -> Scene {
        let block = self.figure.parts.iter().find_map(|part| match part {
            Part::Block(block) => Some(block.scene.clone()),
            _ => None,
        });
        Scene { preset: self.figure.printed_in(), ..block.unwrap_or_default() }
    }

    pub(super) fn block_names(&self) -> BlockNames<'_> {
        BlockNames { layers: self.inputs.layers, horizons: self.inputs.horizons, faults: self.inputs.faults }
    }
}

impl RockOnSection<'_, '_> {
    /// The part of a plane that is seen in `body`, and where it lies on the page.
    fn seen(&self, (station, plane): &(f64, SectionPlane), body: Rect, image: Rect) -> Option<(SectionRange, Rect)> {
        let from_page = |page: DVec2| (page - image.min) / image.size() * self.extent;
        let (low, high) = (from_page(body.min), from_page(body.max));
        let [s, t] = [0, 1].map(|axis| {
            let start = if axis == 0 { *station } else { 0.0 };
            [low[axis].max(start) - start, high[axis].min(start + plane.extent[axis]) - start]
        });
        if !(s[1] > s[0] && t[1] > t[0]) {
            return None;
        }
        let page = |s: f64, t: f64| image.min + DVec2::new(station + s, t) / self.extent * image.size();
        Some((SectionRange { s, t }, Rect::new(page(s[0], t[0]), page(s[1], t[1]))))
    }
}

impl SectionPainter for RockOnSection<'_, '_> {
    fn below(&mut self, body: Rect, image: Rect) -> Result<Option<Vec<Item>>, FigureError> {
        if self.blend >= 1.0 || self.cuts.is_empty() {
            return Ok(None);
        }
        let dpi = self.maker.figure.dpi;
        let (like, names) = (self.maker.rock_scene(), self.maker.block_names());
        let mut items = Vec::new();
        for plane in self.planes.clone() {
            let Some((part, pane)) = self.seen(&plane, body, image) else { continue };
            let size_px = (pane.size() * dpi / POINTS_PER_INCH).round().max(DVec2::ONE);
            let size_px = [size_px.x as u32, size_px.y as u32];
            let Some(scene) = scene(&plane.1, part, self.maker.geometry, &like, size_px) else { continue };
            let scene = Scene { blend: self.blend, ..scene };
            let (drawn, _) = painted(&scene, pane, dpi, &names, self.painter)?;
            items.push(Group::new(GroupKind::Part, "rock").clipped(Path::rect(pane)).with(drawn).into());
        }
        Ok(Some(items))
    }

    fn names(&mut self, body: Rect, image: Rect, room: &mut LabelRoom) -> Vec<Item> {
        let Some(model) = self.maker.inputs.source.data.model.filter(|_| !self.cuts.is_empty()) else {
            return Vec::new();
        };
        let axis = match &self.on {
            Place::Section(kind, _) => kind.axis(),
            Place::Fence(_) => 0,
        };
        let faces = self.planes.iter().zip(self.cuts).filter_map(|(plane, cut)| {
            let (_, pane) = self.seen(plane, body, image)?;
            let corners = [pane.min, DVec2::new(pane.max.x, pane.min.y), pane.max, DVec2::new(pane.min.x, pane.max.y)];
            Some(SeenSection { axis, section: cut.clone(), pieces: vec![corners.to_vec()] })
        });
        let faces: Vec<SeenSection> = faces.collect();
        let place = |voxel: DVec3| match &self.on {
            Place::Section(kind, _) => kind.flat(voxel),
            Place::Fence(corners) => {
                DVec2::new(station_of(corners, voxel.truncate()).map_or(0.0, |(station, _)| station), voxel.z)
            }
        };
        let writer = FaceWriter {
            model,
            geometry: self.maker.geometry,
            names: self.maker.block_names(),
            air: None,
            page_from_voxel: &|voxel| image.min + place(voxel) / self.extent * image.size(),
            page: &|place| place,
            covered: Vec::new(),
        };
        writer.written(&faces, self.maker.section_labels(self.blend), room)
    }
}
