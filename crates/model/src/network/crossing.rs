//! Faults that cross in an X: both were drawn on both sides of the other.
//!
//! Each fault is looked at at some thousand nodes of its grid where it is real. One goes through another where, beside
//! what is real of that one, its nodes lie on both of its sides by more than a few voxels, and one of them close to it.

use super::{FaultNetwork, FaultSurface, blocks, build};
use crate::report::{ModelError, ModelNote};
use glam::{DVec3, Vec3};
use rayon::prelude::*;
use survey::fault::Fault;
use survey::geometry::SurveyGeometry;

/// Nodes of a fault that are looked at along each side of its grid, about.
const NODES: usize = 64;
/// A fault that ends within so many cells of another one's far side ends at it.
const BEYOND_CELLS: f64 = 4.0;

/// The share of a fault, percent, that is left out without a word: what ends at another fault just before its tip.
const LEAST_LEFT_OUT: f64 = 5.0;

/// Two faults that cross, and where.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FaultCrossing {
    /// Indices of the faults, the first given one first.
    pub faults: [usize; 2],
    /// A place where they do, voxels.
    pub at: Vec3,
}

/// A place of a fault, voxels, and the faults that exist there, one bit each.
#[derive(Debug, Clone, Copy)]
struct RealPlace {
    p: DVec3,
    existing: u64,
}

impl FaultNetwork {
    /// The pairs of faults that cross inside a volume of `size` voxels and go on beyond. A fault that is said to end at
    /// another does not cross it.
    pub fn crossings(&self, size: [usize; 3]) -> Vec<FaultCrossing> {
        let count = self.surfaces.len();
        if count < 2 {
            return Vec::new();
        }
        let places: Vec<Vec<RealPlace>> = (0..count).into_par_iter().map(|f| self.real_places(f, size)).collect();
        let pairs: Vec<[usize; 2]> = (0..count).flat_map(|a| (a + 1..count).map(move |b| [a, b])).collect();
        let crossing = |&[a, b]: &[usize; 2]| {
            let at = self.place_through(&places[a], a, b)?;
            self.place_through(&places[b], b, a)?;
            Some(FaultCrossing { faults: [a, b], at: at.as_vec3() })
        };
        pairs.par_iter().filter_map(crossing).collect()
    }

    /// The first of [`Self::crossings`] in words, with the number of the others.
    pub(crate) fn crossing_note(&self, geometry: &SurveyGeometry) -> Option<ModelNote> {
        note(&self.crossings(geometry.size()), &self.surfaces, geometry)
    }

    /// The fault of which the largest share does not divide the volume, where there are so many faults that some do not.
    pub(crate) fn left_out_note(&self, size: [usize; 3]) -> Option<ModelNote> {
        if !self.in_parts {
            return None;
        }
        let share = |f: usize| {
            let (mut all, mut left_out) = (0, 0);
            for p in self.places(f, size).filter(|&p| self.surfaces[f].extent_at(p) >= 0.0) {
                let bits = self.bits_at(p.as_vec3());
                let is_meant = blocks::existing(&self.truncation, &self.order, bits) >> f & 1 == 1;
                all += usize::from(is_meant);
                left_out += usize::from(is_meant && self.existing(bits) >> f & 1 == 0);
            }
            100.0 * left_out as f64 / all.max(1) as f64
        };
        let shares: Vec<f64> = (0..self.surfaces.len()).into_par_iter().map(share).collect();
        let worst = (0..shares.len())
            .filter(|&f| shares[f] >= LEAST_LEFT_OUT)
            .max_by(|&a, &b| shares[a].total_cmp(&shares[b]))?;
        Some(ModelNote::FaultLeftOut {
            fault: self.surfaces[worst].name.clone(),
            percent: shares[worst],
            others: shares.iter().filter(|share| **share >= LEAST_LEFT_OUT).count() - 1,
        })
    }

    /// Nodes of a fault where it is real and inside the volume.
    fn real_places(&self, fault: usize, size: [usize; 3]) -> Vec<RealPlace> {
        let real = |p: DVec3| {
            let at = p.as_vec3();
            self.is_real(fault, at).then(|| RealPlace { p, existing: self.existing(self.bits_at(at)) })
        };
        self.places(fault, size).filter_map(real).collect()
    }

    /// Some thousand nodes of a fault that are inside the volume, voxels.
    fn places(&self, fault: usize, size: [usize; 3]) -> impl Iterator<Item = DVec3> {
        let surface = &self.surfaces[fault];
        let [nu, nv] = surface.surface.size;
        let voxel_from_frame = surface.frame_from_voxel.inverse();
        let last = DVec3::from_array(size.map(|n| n as f64 - 1.0));
        let step = nu.max(nv).div_ceil(NODES);
        let nodes = (0..nu).step_by(step).flat_map(move |i| (0..nv).step_by(step).map(move |j| (i, j)));
        nodes.filter_map(move |(i, j)| {
            let [u, v] = [i as i32 + surface.surface.origin[0], j as i32 + surface.surface.origin[1]];
            let on_it = DVec3::new(f64::from(u), f64::from(v), f64::from(surface.surface.z[i * nv + j]));
            let p = voxel_from_frame * (on_it - surface.frame_offset);
            (p.cmpge(DVec3::ZERO).all() && p.cmple(last).all()).then_some(p)
        })
    }

    /// Where fault `a`, by its places, passes through what is real of `b` and goes on beyond.
    fn place_through(&self, places: &[RealPlace], a: usize, b: usize) -> Option<DVec3> {
        let other = &self.surfaces[b];
        let (mut least, mut most) = (0.0f64, 0.0f64);
        let mut closest: Option<(f64, DVec3)> = None;
        let is_real = |at: &&RealPlace| at.existing >> b & 1 == 1 && other.extent_at(at.p.as_vec3().as_dvec3()) >= 0.0;
        for &RealPlace { p, .. } in places.iter().filter(is_real) {
            let side = other.side(p);
            // Beside the rim of a surface that is not continued there is no side.
            if side.is_nan() {
                continue;
            }
            (least, most) = (least.min(side), most.max(side));
            if closest.is_none_or(|(distance, _)| side.abs() < distance) {
                closest = Some((side.abs(), p));
            }
        }
        let (distance, at) = closest?;
        let [nu, nv] = self.surfaces[a].surface.size;
        let step = nu.max(nv).div_ceil(NODES) as f64 * self.surfaces[a].spacing_m;
        (most.min(-least) > BEYOND_CELLS * other.spacing_m && distance < 2.0 * step).then_some(at)
    }
}

fn note(crossings: &[FaultCrossing], surfaces: &[FaultSurface], geometry: &SurveyGeometry) -> Option<ModelNote> {
    let first = crossings.first()?;
    Some(ModelNote::FaultsCross {
        faults: first.faults.map(|f| surfaces[f].name.clone()),
        lines: geometry.lines_from_voxel(first.at.as_dvec3().truncate()).to_array(),
        others: crossings.len() - 1,
    })
}

/// The note that a fault crosses others, where it does: each as it was drawn, before any of them is continued. Those at
/// which one ends are to be left out.
///
/// # Errors
/// [`ModelError`] for a fault without area, or one that folds over itself.
pub fn drawn_crossing(
    geometry: &SurveyGeometry,
    fault: &Fault,
    others: &[Fault],
) -> Result<Option<ModelNote>, ModelError> {
    let drawn = |fault: &Fault| Ok::<_, ModelError>(build::drawn(geometry, fault)?.0.surface);
    let surfaces = others.par_iter().chain(rayon::iter::once(fault)).map(drawn).collect::<Vec<_>>();
    let surfaces = surfaces.into_iter().collect::<Result<Vec<_>, _>>()?;
    let count = surfaces.len();
    let network = FaultNetwork {
        surfaces,
        truncation: vec![None; count],
        order: (0..count).collect(),
        signatures: Vec::new(),
        in_parts: false,
        table: Vec::new(),
    };
    let mut own = network.crossings(geometry.size());
    own.retain(|crossing| crossing.faults[1] == others.len());
    Ok(note(&own, &network.surfaces, geometry))
}
