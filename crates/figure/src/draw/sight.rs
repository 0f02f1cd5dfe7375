//! What of a block is seen: the layers, contacts, faults and wells that a legend has to explain.
//!
//! Layers are found by rays through a grid of places of the picture, and by the outlines of layers on the faces, whose
//! corners show also what is thinner than the grid. A line is seen where it runs over the part of its face that no other
//! face hides; a well where no rock lies before it.

use crate::convex::{area, holds};
use glam::{DVec2, DVec3, Vec3};
use model::StructuralModel;
use model::section::{LineKind, LineQuality};
use rayon::prelude::*;
use render::ground::Relief;
use render::vector::seen_sections;
use render::visible::{Ray, Solid};
use render::{DrawnWell, Faces, Scene};
use std::collections::BTreeSet;
use survey::SurveyGeometry;

/// Rays across the picture.
const COLUMNS: u32 = 160;
/// How far behind a face its layer is asked for, voxels.
const BEHIND: f32 = 0.02;
/// Faces that are seen smaller than this are seen edge on, square pixels.
const LEAST_PX: f64 = 1.0;
/// The farthest that is measured of how far rock lies before or behind water, voxels.
const FAR: f64 = 5.0;
/// Places of the ground this close on the map, as a share of the block's longest side, are neighbours.
const NEAR: f32 = 0.04;
/// How far below a line rock has to lie for it to be a line on rock, voxels.
const BELOW: f64 = 0.3;

/// What is seen of a block.
#[derive(Debug, Clone, Default, PartialEq)]
pub(crate) struct Seen {
    /// Layers, 0 = the deepest.
    pub layers: BTreeSet<u16>,
    /// Horizons whose lines are seen on faces.
    pub horizons: BTreeSet<usize>,
    /// How certain these lines are.
    pub qualities: BTreeSet<LineQuality>,
    /// Faults whose lines are seen on faces.
    pub faults: BTreeSet<usize>,
    /// Wells by their place among the wells.
    pub wells: BTreeSet<usize>,
    /// Whether tops of wells are.
    pub has_tops: bool,
}

/// What is seen of a scene, whose size is that of its picture.
pub(crate) fn seen(scene: &Scene, geometry: &SurveyGeometry, model: &StructuralModel, wells: &[DrawnWell]) -> Seen {
    let sight = Sight::new(scene, geometry, model);
    let mut seen = Seen::default();
    if sight.faces != Faces::None {
        seen.layers = sight.layers_on_rays();
        // The ground is known no closer than a ray meets it: just above lies air.
        seen.layers.retain(|layer| scene.ground.is_none() || *layer != render::ground::air_layer(model));
    }
    if sight.faces == Faces::All {
        sight.add_faces(scene, geometry, &mut seen);
        seen.faults.extend(sight.faults_on_ground());
    }
    if scene.wells.radius > 0.0 {
        seen.wells = (0..wells.len())
            .filter(|well| !scene.hides_well(wells[*well].name) && sight.sees_well(wells[*well].path))
            .collect();
        seen.has_tops = seen.wells.iter().any(|well| wells[*well].tops.iter().any(|top| sight.sees(*top)));
    }
    seen
}

/// A picture's eye and what it looks at.
pub(crate) struct Sight<'a> {
    model: &'a StructuralModel,
    view: render::View,
    solid: Solid,
    relief: Option<Relief>,
    faces: Faces,
    size: DVec2,
    /// Radius of wells, voxels.
    reach: f64,
}

impl<'a> Sight<'a> {
    /// What a picture of a scene looks at.
    pub(crate) fn new(scene: &Scene, geometry: &SurveyGeometry, model: &'a StructuralModel) -> Self {
        let block = scene.box_in(geometry);
        Self {
            model,
            view: scene.view(geometry),
            solid: scene.solid(geometry),
            relief: scene.ground.as_ref().map(|ground| Relief::new(ground, scene, geometry, model)),
            faces: scene.media.faces,
            size: DVec2::new(f64::from(scene.size_px[0]), f64::from(scene.size_px[1])),
            reach: f64::from(scene.wells.radius) * (block.high() - block.low()).max_element(),
        }
    }

    fn is_air(&self, p: Vec3) -> bool {
        self.relief.as_ref().is_some_and(|relief| relief.is_air(self.model, p))
    }

    /// How far behind the surface of water rock is met at a pixel, voxels, where `block` is the block without what rises
    /// above the water; far behind where there is none.
    pub(crate) fn behind_water(&self, block: &Solid, px: DVec2) -> f64 {
        let ray = Ray::from(self.view.ray(px));
        let water = block.next_span(&ray, f32::MIN).filter(|span| self.is_air(ray.at(span.entry.t + BEHIND)));
        let (Some(water), Some((rock, _))) = (water, self.rock(&ray)) else { return FAR };
        f64::from(rock - water.entry.t).clamp(-FAR, FAR)
    }

    /// Whether a place in the block stands before all water, where `block` is the block without what rises above it.
    pub(crate) fn is_before_water(&self, block: &Solid, p: DVec3) -> bool {
        let px = self.view.project(p);
        if !(self.is_within(p) && self.holds(px)) {
            return false;
        }
        let ray = Ray::from(self.view.ray(px));
        let own = (p - ray.origin.as_dvec3()).dot(ray.direction.as_dvec3());
        let mut from = f32::MIN;
        // Every stretch but the last ends at a cut-out.
        for _ in 0..=2 * block.cut_outs.len() + 1 {
            let Some(span) = block.next_span(&ray, from) else { return true };
            if self.is_air(ray.at(span.entry.t + BEHIND)) {
                return own < f64::from(span.entry.t);
            }
            from = span.end;
        }
        true
    }

    /// Where a ray meets rock, and just behind.
    fn rock(&self, ray: &Ray) -> Option<(f32, Vec3)> {
        let mut from = f32::MIN;
        // Every stretch but the last ends at a cut-out.
        for _ in 0..=2 * self.solid.cut_outs.len() + 1 {
            let span = self.solid.next_span(ray, from)?;
            let entered = span.entry.point + ray.direction * BEHIND;
            if !self.is_air(entered) {
                return Some((span.entry.t, entered));
            }
            let ground = self.relief.as_ref()?.march(self.model, ray, span.entry.t, span.end);
            if let Some(hit) = ground {
                return Some((hit.t, hit.point + ray.direction * BEHIND));
            }
            from = span.end;
        }
        None
    }

    /// Faults that run over the ground: between neighbouring rays that meet it on their two sides.
    fn faults_on_ground(&self) -> BTreeSet<usize> {
        let faults = self.model.faults();
        if self.relief.is_none() || faults.surfaces().is_empty() {
            return BTreeSet::new();
        }
        let [low, high] = self.solid.roaming_box;
        let near = NEAR * (high - low).max_element();
        let rows = (f64::from(COLUMNS) * self.size.y / self.size.x).ceil().clamp(1.0, 4.0 * f64::from(COLUMNS)) as u32;
        let row = |row: u32| {
            let (mut found, mut last) = (BTreeSet::new(), None::<Vec3>);
            for column in 0..COLUMNS {
                let share = DVec2::new(f64::from(column) + 0.5, f64::from(row) + 0.5);
                let pixel = share / DVec2::new(f64::from(COLUMNS), f64::from(rows)) * self.size;
                let met = self.rock(&Ray::from(self.view.ray(pixel))).map(|(_, p)| p);
                let ground = met.filter(|p| self.is_air(*p - BELOW as f32 * Vec3::Z));
                if let (Some(p), Some(q)) = (ground, last)
                    && p.truncate().distance(q.truncate()) < near
                {
                    let [a, b] = [p, q].map(|place| faults.bits_at(place));
                    let parted = (a ^ b) & faults.existing(a) & faults.existing(b);
                    let is_parted = |fault: &usize| parted >> fault & 1 == 1 && faults.is_real(*fault, 0.5 * (p + q));
                    found.extend((0..faults.surfaces().len()).filter(is_parted));
                }
                last = ground;
            }
            found
        };
        (0..rows).into_par_iter().map(row).reduce(BTreeSet::new, |mut one, other| {
            one.extend(other);
            one
        })
    }

    fn layers_on_rays(&self) -> BTreeSet<u16> {
        let rows = (f64::from(COLUMNS) * self.size.y / self.size.x).ceil().clamp(1.0, 4.0 * f64::from(COLUMNS)) as u32;
        let row = |row: u32| {
            let mut found = BTreeSet::new();
            for column in 0..COLUMNS {
                let share = DVec2::new(f64::from(column) + 0.5, f64::from(row) + 0.5);
                let pixel = share / DVec2::new(f64::from(COLUMNS), f64::from(rows)) * self.size;
                let ray = Ray::from(self.view.ray(pixel));
                match self.faces {
                    Faces::CutOuts => {
                        let backs = self.solid.cut_outs.iter().map(|cut| cut.cross(&ray));
                        let backs = backs.filter(|cut| cut.enter < cut.exit).map(|cut| ray.at(cut.exit + BEHIND));
                        let rock = backs.filter(|p| self.solid.contains(*p) && !self.is_air(*p));
                        found.extend(rock.map(|p| self.model.region_at(p).layer));
                    }
                    _ => found.extend(self.rock(&ray).map(|(_, p)| self.model.region_at(p).layer)),
                }
            }
            found
        };
        (0..rows).into_par_iter().map(row).reduce(BTreeSet::new, |mut one, other| {
            one.extend(other);
            one
        })
    }

    /// Adds what lies on the faces: layers by the corners of their outlines, and lines.
    fn add_faces(&self, scene: &Scene, geometry: &SurveyGeometry, seen: &mut Seen) {
        for face in seen_sections(scene, geometry, self.model) {
            let plane = face.section.plane;
            // A face that is seen edge on shows nothing.
            if face.pieces.iter().map(|piece| area(piece)).sum::<f64>() < LEAST_PX {
                continue;
            }
            let is_seen = |st: &DVec2| {
                let voxel = plane.voxel(*st);
                let px = self.view.project(voxel);
                let is_rock = !self.is_air((voxel + DVec3::Z * BELOW).as_vec3());
                is_rock && self.holds(px) && face.pieces.iter().any(|piece| holds(piece, px))
            };
            for polygon in &face.section.polygons {
                let is_air = self.relief.is_some() && polygon.region.layer == render::ground::air_layer(self.model);
                if !is_air
                    && !seen.layers.contains(&polygon.region.layer)
                    && polygon.rings.iter().flatten().any(is_seen)
                {
                    seen.layers.insert(polygon.region.layer);
                }
            }
            for line in &face.section.lines {
                match line.kind {
                    LineKind::Horizon { horizon }
                        if !(seen.horizons.contains(&horizon) && seen.qualities.contains(&line.quality))
                            && line.points.iter().any(is_seen) =>
                    {
                        seen.horizons.insert(horizon);
                        seen.qualities.insert(line.quality);
                    }
                    LineKind::Fault { fault, real: true } if !seen.faults.contains(&fault) => {
                        seen.faults.extend(line.points.iter().any(is_seen).then_some(fault));
                    }
                    _ => {}
                }
            }
        }
    }

    /// Whether a pixel lies in the picture.
    fn holds(&self, px: DVec2) -> bool {
        px.cmpge(DVec2::ZERO).all() && px.cmple(self.size).all()
    }

    /// Whether a place lies in the block.
    pub(crate) fn is_within(&self, p: DVec3) -> bool {
        let [low, high] = self.solid.roaming_box.map(Vec3::as_dvec3);
        p.cmpge(low).all() && p.cmple(high).all()
    }

    /// Whether a place lies in rock.
    pub(crate) fn is_rock(&self, p: DVec3) -> bool {
        self.solid.contains(p.as_vec3()) && !self.is_air(p.as_vec3())
    }

    /// Whether a place on a well lies in the block, in the picture, and before all rock.
    pub(crate) fn sees(&self, p: DVec3) -> bool {
        let px = self.view.project(p);
        if !(self.is_within(p) && self.holds(px)) {
            return false;
        }
        let ray = Ray::from(self.view.ray(px));
        let own = (p - ray.origin.as_dvec3()).dot(ray.direction.as_dvec3());
        self.faces == Faces::None || self.rock(&ray).is_none_or(|(t, _)| f64::from(t) > own - self.reach)
    }

    /// Whether something of a well is seen.
    fn sees_well(&self, path: &[DVec3]) -> bool {
        path.windows(2).any(|pair| (0..4).any(|n| self.sees(pair[0].lerp(pair[1], f64::from(n) / 4.0))))
    }
}
