//! An outcrop model whose truth is a closed form: nine horizons as scattered points with an overturned limb, and three
//! faults, of which one ends inside the block.
//!
//! ```text
//! age(p) = fold.age(p − d·Σ slip_f(p)),   slip_f = throw_f · [p in the hanging wall of f] · taper_f(y)
//! ```
//!
//! The faults are parallel planes and d lies in them, so slip moves no fault and its inverse is exact.

use super::SynthError;
use super::random::Draws;
use super::shapes::{RecumbentFold, extent_m, world};
use glam::{DVec2, DVec3};
use serde::{Deserialize, Serialize};
use survey::stratigraphy::{Contact, StratigraphicHorizon, Stratigraphy};
use survey::{Fault, Horizon, SurveyGeometry, TriangleMesh, VerticalUnit};

/// Fewest voxels along each axis.
const LEAST: [usize; 3] = [24; 3];
/// Horizons of the outcrop.
const HORIZONS: usize = 9;
/// Points of a horizon, at least and at most.
const POINTS: [f64; 2] = [50.0, 150.0];
/// Dip of the faults, degrees.
const DIP_DEG: f64 = 65.0;
/// Points nearer to a fault are not observed, m.
const SETBACK_M: f64 = 15.0;

/// A planar fault.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct OutcropFault {
    /// x where it meets z = 0, m.
    pub x: f64,
    /// Slip down its dip, m.
    pub slip_m: f64,
    /// It ends at this y, m, if it does: its slip dies out towards there.
    pub tip_y: Option<f64>,
}

/// The closed form of an outcrop.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct OutcropTruth {
    /// The beds before they were broken.
    pub fold: RecumbentFold,
    /// The ages of the horizons, youngest first, m.
    pub ages: Vec<f64>,
    /// The faults from low to high x.
    pub faults: Vec<OutcropFault>,
}

impl OutcropTruth {
    /// Down the dip of the faults.
    fn dip() -> DVec3 {
        DVec3::new(DIP_DEG.to_radians().cos(), 0.0, DIP_DEG.to_radians().sin())
    }

    /// Metres from a fault, positive in its hanging wall.
    pub fn side_m(&self, fault: usize, p: DVec3) -> f64 {
        let normal = DVec3::new(DIP_DEG.to_radians().sin(), 0.0, -DIP_DEG.to_radians().cos());
        (p - DVec3::new(self.faults[fault].x, 0.0, 0.0)).dot(normal)
    }

    /// Slip of a fault at y, m.
    pub(crate) fn slip_m(&self, fault: usize, y: f64) -> f64 {
        let OutcropFault { slip_m, tip_y, .. } = self.faults[fault];
        // As on an elliptic fault: vertical tangent at the tip.
        tip_y.map_or(slip_m, |tip| slip_m * (1.0 - y / tip).clamp(0.0, 1.0).sqrt())
    }

    /// Where the rock at a place was before the faults.
    pub fn restored(&self, p: DVec3) -> DVec3 {
        let slip: f64 = (0..self.faults.len()).filter(|&f| self.side_m(f, p) > 0.0).map(|f| self.slip_m(f, p.y)).sum();
        p - Self::dip() * slip
    }

    /// Where rock from before the faults is now.
    fn moved(&self, q: DVec3) -> DVec3 {
        let slip: f64 = (0..self.faults.len()).filter(|&f| self.side_m(f, q) > 0.0).map(|f| self.slip_m(f, q.y)).sum();
        q + Self::dip() * slip
    }

    /// The layer at a place in metres, 0 = deepest in age.
    pub fn layer(&self, p: DVec3) -> u16 {
        let age = self.fold.age(self.restored(p));
        (self.ages.len() - self.ages.iter().filter(|&&horizon| age >= horizon).count()) as u16
    }

    /// Metres from the nearest horizon, to first order.
    pub fn gap_m(&self, p: DVec3) -> f64 {
        let q = self.restored(p);
        let age = self.fold.age(q);
        let nearest = self.ages.iter().map(|horizon| (age - horizon).abs()).fold(f64::INFINITY, f64::min);
        nearest / self.fold.gradient(q).length()
    }

    /// Whether the bed at a place is upside down.
    pub fn is_overturned(&self, p: DVec3) -> bool {
        self.fold.gradient(self.restored(p)).z < 0.0
    }
}

/// An outcrop model: what was observed of it, and its truth.
#[derive(Debug, Clone, PartialEq)]
pub struct Overturned {
    /// The block.
    pub geometry: SurveyGeometry,
    /// The age order.
    pub stratigraphy: Stratigraphy,
    /// Scattered points, youngest first.
    pub horizons: Vec<Horizon>,
    /// The faults up to their tips.
    pub faults: Vec<Fault>,
    /// The closed form.
    pub truth: OutcropTruth,
}

impl Overturned {
    /// Makes an outcrop of `size` voxels of 10 m; the seed chooses points, faults and throws.
    ///
    /// # Errors
    /// [`SynthError::TooSmall`]
    pub fn generate(size: [usize; 3], seed: u64) -> Result<Self, SynthError> {
        if size.iter().zip(LEAST).any(|(&n, least)| n < least) {
            return Err(SynthError::TooSmall { size, least: LEAST });
        }
        let mut geometry = SurveyGeometry::regular(size, 10.0, 10.0, VerticalUnit::Metres);
        geometry.origin = DVec2::new(612_000.0, 5_178_000.0);
        let extent = extent_m(&geometry);
        let fold = RecumbentFold::fitting(&geometry);
        let mut draws = Draws::new(seed, 17);
        // Ages from corner to corner of the block, so that each horizon crosses it.
        let (top, base) =
            (fold.age(DVec3::new(0.8 * extent.x, 0.0, 0.0)), fold.age(DVec3::new(0.2 * extent.x, 0.0, extent.z)));
        let step = (base - top) / (HORIZONS as f64 + 1.0);
        let ages: Vec<f64> = (1..=HORIZONS).map(|n| top + step * (n as f64 + draws.between(-0.2, 0.2))).collect();
        let faults: Vec<OutcropFault> = [(0.12, None), (0.38, Some(0.62)), (0.62, None)]
            .into_iter()
            .map(|(x, tip)| OutcropFault {
                x: extent.x * (x + draws.between(-0.03, 0.03)),
                slip_m: extent.z * draws.between(0.04, 0.09),
                tip_y: tip.map(|share: f64| share * extent.y),
            })
            .collect();
        let truth = OutcropTruth { fold, ages, faults };
        let name = |n: usize| format!("H{}", n + 1);
        let horizons = (0..HORIZONS).map(|n| {
            let count = draws.between(POINTS[0], POINTS[1]) as usize;
            Horizon::of_surface(name(n), truth.points(&geometry, n, count, &mut draws))
        });
        let horizons = horizons.collect();
        let named = |n: usize| StratigraphicHorizon { name: name(n), contact: Contact::Conformable };
        let stratigraphy = Stratigraphy { horizons: (0..HORIZONS).map(named).collect(), layer_names: Vec::new() };
        let faults = (0..truth.faults.len()).map(|f| truth.mesh(&geometry, f)).collect();
        Ok(Self { geometry, stratigraphy, horizons, faults, truth })
    }
}

impl OutcropTruth {
    fn points(&self, geometry: &SurveyGeometry, horizon: usize, count: usize, draws: &mut Draws) -> TriangleMesh {
        let extent = extent_m(geometry);
        let mut vertices = Vec::new();
        // A horizon that hardly crosses the block has fewer.
        for _ in 0..200 * count {
            let (y, z) = (draws.between(0.0, extent.y), draws.between(-0.2 * extent.z, extent.z));
            let p = self.moved(DVec3::new(self.fold.x_of(self.ages[horizon], z), y, z));
            let inside = p.cmpge(DVec3::ZERO).all() && p.cmple(extent).all();
            let is_clear = (0..self.faults.len()).all(|f| self.side_m(f, p).abs() > SETBACK_M);
            if inside && is_clear {
                vertices.push(world(geometry, p));
            }
            if vertices.len() == count {
                break;
            }
        }
        TriangleMesh { vertices, triangles: Vec::new() }
    }

    /// The triangles of a fault, from the top to the bottom of the block, up to its tip.
    fn mesh(&self, geometry: &SurveyGeometry, fault: usize) -> Fault {
        let extent = extent_m(geometry);
        let end = self.faults[fault].tip_y.unwrap_or(1.05 * extent.y);
        let start = -0.05 * extent.y;
        let depth = 1.05 * extent.z / DIP_DEG.to_radians().sin();
        let place = |u: f64, v: f64| {
            let along = DVec3::new(self.faults[fault].x, start + u * (end - start), 0.0);
            world(geometry, along + Self::dip() * (v * 1.1 - 0.05) * depth)
        };
        Fault::new(format!("F{}", fault + 1), super::shapes::grid_mesh([24, 24], place))
    }
}
