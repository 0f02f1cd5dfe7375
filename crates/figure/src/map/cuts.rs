//! Where faults cut a horizon off: the lines at which its part in each fault block ends.
//!
//! On the block's sheet of the horizon the signed distance to the fault is zero there; the zeros are found cell by cell, as
//! contours are, and kept where the block ends: of two places beside the line one alone lies in it. The two lines of a
//! normal fault enclose the gap in the horizon, those of a reverse fault the strip where it lies over itself.

use super::Mapped;
use super::contours::{Crossing, crossings, joined};
use glam::{DVec2, DVec3};
use model::StructuralModel;
use rayon::prelude::*;
use survey::SurveyGeometry;

/// How far beside a line the blocks on its sides are looked up, voxels: farther than a curved fault deviates from a straight
/// piece.
const ACROSS: f64 = 0.12;
/// The horizon is covered where it lies over itself by more than this, samples.
const OVER: f32 = 0.5;

/// A line along which a horizon ends at a fault.
#[derive(Debug, Clone, PartialEq)]
pub struct FaultCut {
    /// The fault, by its number in the model.
    pub fault: usize,
    /// What it is called.
    pub name: String,
    /// Its places, voxel x and y.
    pub line: Vec<DVec2>,
    /// Whether a shallower part of the horizon lies over it.
    pub is_covered: bool,
}

/// All lines along which what is mapped ends at faults, by fault.
pub(super) fn cuts(geometry: &SurveyGeometry, model: &StructuralModel, mapped: Mapped) -> Vec<FaultCut> {
    let horizons = match mapped {
        Mapped::Structure(horizon) => vec![horizon],
        Mapped::Thickness(upper, lower) => vec![upper, lower],
    };
    let (faults, blocks) = (model.faults().surfaces().len(), model.block_count() as u16);
    let sheets = |fault: usize| {
        let horizons = horizons.iter().copied();
        horizons
            .flat_map(move |horizon| (0..blocks).map(move |block| (fault, Sheet { geometry, model, horizon, block })))
    };
    let sheets: Vec<(usize, Sheet)> = (0..faults).flat_map(sheets).collect();
    sheets.par_iter().flat_map_iter(|(fault, sheet)| sheet.cuts(*fault)).collect()
}

/// A horizon in one fault block.
struct Sheet<'a> {
    geometry: &'a SurveyGeometry,
    model: &'a StructuralModel,
    horizon: usize,
    block: u16,
}

impl Sheet<'_> {
    fn place(&self, xy: DVec2) -> DVec3 {
        xy.extend(f64::from(self.model.horizon_z(self.horizon, self.block, xy.x as f32, xy.y as f32)))
    }

    fn cuts(&self, fault: usize) -> Vec<FaultCut> {
        let surface = &self.model.faults().surfaces()[fault];
        let [nx, ny, _] = self.geometry.size();
        let side = |x: usize, y: usize| surface.side(self.place(DVec2::new(x as f64, y as f64)));
        let sides: Vec<f64> = (0..nx * ny).map(|n| side(n / ny, n % ny)).collect();
        let mut pieces: [Vec<[(Crossing, DVec2); 2]>; 2] = Default::default();
        for x in 0..nx.saturating_sub(1) {
            for y in 0..ny.saturating_sub(1) {
                let corners = [[x, y], [x + 1, y], [x + 1, y + 1], [x, y + 1]];
                let found = crossings([x, y], ny, corners.map(|[x, y]| sides[x * ny + y]), 0.0);
                for pair in found.chunks_exact(2) {
                    let middle = self.place(pair[0].1.lerp(pair[1].1, 0.5));
                    if self.ends_at(fault, middle) {
                        pieces[usize::from(self.is_covered(middle))].push([pair[0], pair[1]]);
                    }
                }
            }
        }
        let cut = |line, is_covered| FaultCut { fault, name: surface.name.clone(), line, is_covered };
        let [seen, covered] = pieces.map(|pieces| joined(&pieces));
        let seen = seen.into_iter().map(|line| cut(line, false));
        seen.chain(covered.into_iter().map(|line| cut(line, true))).collect()
    }

    /// Whether the horizon's part in this block ends at the interpreted part of a fault here.
    fn ends_at(&self, fault: usize, p: DVec3) -> bool {
        let faults = self.model.faults();
        let last = self.geometry.vertical.count.saturating_sub(1) as f64;
        if !(0.0..=last).contains(&p.z) || !faults.is_real(fault, p.as_vec3()) {
            return false;
        }
        let surface = &faults.surfaces()[fault];
        let normal = surface.frame_from_voxel.row(2).normalize();
        let gradient = surface.side_gradient(p);
        let p = p - gradient * (surface.side(p) / gradient.length_squared());
        let inside = [ACROSS, -ACROSS].map(|aside| (p + normal * aside).as_vec3());
        let [ahead, behind] = inside.map(|place| self.model.block_at(place) == self.block);
        let within = if ahead { inside[0] } else { inside[1] };
        let is_whole = || self.model.is_body(self.horizon) || self.model.body_at(within, self.block).is_none();
        ahead != behind && is_whole()
    }

    fn is_covered(&self, p: DVec3) -> bool {
        let others = (0..self.model.block_count() as u16).filter(|block| *block != self.block);
        others.into_iter().any(|block| {
            let over = Sheet { block, ..*self }.place(p.truncate()).as_vec3();
            over.z >= 0.0 && over.z + OVER < p.z as f32 && self.model.block_at(over) == block
        })
    }
}
