//! The truth behind the synthetic survey: where every bed, fault and block is, in closed form.
//!
//! A point is brought back to where it was deposited in three steps: the throws of the faults in whose
//! hanging wall it lies are subtracted (they do not depend on depth, so their order does not matter), the
//! result is compared with the unconformity, and the folds of its sequence are undone. In the other
//! direction, the same steps give every horizon of every block as an explicit height function.
//!
//! Blocks are numbered from low x to high x: block b lies in the hanging walls of faults 0 … b − 1, which do
//! not meet inside the volume. Beyond its tip a fault is extended (with throw 0), so the blocks on both sides
//! keep their numbers there. Positions are fractional voxels; quantities that end in `_m` are metric.

use super::column::BedSequence;
use super::faulting::TruthFault;
use super::fold::FoldedBeds;
use super::shapes::Diapir;
use glam::{DVec2, DVec3};
use serde::{Deserialize, Serialize};

/// Acoustic impedance of salt, kg/(m²·s).
const SALT_IMPEDANCE: f64 = 9.7e6;

/// The sequence of beds that a horizon belongs to.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Sequence {
    /// Above the unconformity, the unconformity itself included.
    Young,
    /// Below the unconformity, which cuts it off.
    Old,
}

/// A named horizon: one of the reflectors.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct TruthHorizon {
    /// Unique name.
    pub name: String,
    /// The sequence it belongs to.
    pub sequence: Sequence,
    /// Stratigraphic depth, m.
    pub strat_m: f64,
}

/// The closed form of a synthetic survey.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct SynthTruth {
    /// Voxels, `[inlines, crosslines, samples]`.
    pub size: [usize; 3],
    /// Metres per voxel along each axis.
    pub step_m: DVec3,
    /// 1/f of the wavelet, m.
    pub wavelength_m: f64,
    /// Folds above the unconformity.
    pub young_beds: FoldedBeds,
    /// Folds below the unconformity.
    pub old_beds: FoldedBeds,
    /// Reflectors above the unconformity; the last one is the unconformity.
    pub young_column: BedSequence,
    /// Reflectors below the unconformity, and those that it has removed.
    pub old_column: BedSequence,
    /// Faults from low x to high x.
    pub faults: Vec<TruthFault>,
    /// Named horizons, youngest first.
    pub horizons: Vec<TruthHorizon>,
    /// Index of the unconformity in `horizons`.
    pub unconformity: usize,
    /// A body of salt that cuts everything, if there is one.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub salt: Option<Diapir>,
}

impl SynthTruth {
    /// Metric position of a voxel position.
    fn metric(&self, p: DVec3) -> DVec3 {
        p * self.step_m
    }

    /// Count of fault blocks.
    pub fn block_count(&self) -> usize {
        self.faults.len() + 1
    }

    /// Count of layers, that of the salt included.
    pub fn layer_count(&self) -> usize {
        self.horizons.len() + 1 + usize::from(self.salt.is_some())
    }

    /// Whether voxel `p` lies in salt.
    pub(crate) fn in_salt(&self, p: DVec3) -> bool {
        self.salt.is_some_and(|salt| salt.holds(self.metric(p)))
    }

    /// The fault block at voxel `p`.
    pub fn block_at(&self, p: DVec3) -> u16 {
        let p = self.metric(p);
        self.faults.iter().filter(|fault| fault.side_m(p) > 0.0).count() as u16
    }

    /// Downward displacement of `block` at metric (u, v), m.
    pub(super) fn displacement_m(&self, block: u16, place: DVec2) -> f64 {
        self.faults[..usize::from(block)].iter().map(|fault| fault.throw_at(place)).sum()
    }

    /// Folds of a sequence.
    fn beds(&self, sequence: Sequence) -> &FoldedBeds {
        match sequence {
            Sequence::Young => &self.young_beds,
            Sequence::Old => &self.old_beds,
        }
    }

    /// Voxel z of a horizon as it was before erosion, in one block continued everywhere.
    pub fn sheet_z(&self, horizon: usize, block: u16, x: f64, y: f64) -> f64 {
        let place = DVec2::new(x, y) * self.step_m.truncate();
        let horizon = &self.horizons[horizon];
        let depth_m = self.beds(horizon.sequence).depth_m(horizon.strat_m, place) + self.displacement_m(block, place);
        depth_m / self.step_m.z
    }

    /// Voxel z of a horizon with the contact rule applied: where it is eroded it runs along the unconformity.
    pub fn horizon_z(&self, horizon: usize, block: u16, x: f64, y: f64) -> f64 {
        self.sheet_z(horizon, block, x, y).max(match self.horizons[horizon].sequence {
            Sequence::Young => f64::NEG_INFINITY,
            Sequence::Old => self.sheet_z(self.unconformity, block, x, y),
        })
    }

    /// Metric slope (∂depth/∂u, ∂depth/∂v) of a horizon in one block, metres a metre.
    pub fn slope(&self, horizon: usize, block: u16, x: f64, y: f64) -> DVec2 {
        let place = DVec2::new(x, y) * self.step_m.truncate();
        let horizon = &self.horizons[horizon];
        let throws: DVec2 = self.faults[..usize::from(block)].iter().map(|fault| fault.throw_slope(place)).sum();
        self.beds(horizon.sequence).slope(horizon.strat_m, place) + throws
    }

    /// Whether a horizon really exists in `block` over (x, y): inside the block and the volume, and not
    /// eroded.
    pub fn exists(&self, horizon: usize, block: u16, x: f64, y: f64) -> bool {
        let z = self.sheet_z(horizon, block, x, y);
        let eroded =
            self.horizons[horizon].sequence == Sequence::Old && z <= self.sheet_z(self.unconformity, block, x, y);
        let inside = z >= 0.0 && z <= (self.size[2] - 1) as f64;
        let p = DVec3::new(x, y, z);
        !eroded && inside && self.block_at(p) == block && !self.in_salt(p)
    }

    /// The layer at voxel `p`, 0 = deepest.
    pub fn layer_at(&self, p: DVec3) -> u16 {
        if self.in_salt(p) {
            return 0;
        }
        let block = self.block_at(p);
        let above = (0..self.horizons.len()).filter(|&h| self.horizon_z(h, block, p.x, p.y) <= p.z).count();
        (self.horizons.len() - above + usize::from(self.salt.is_some())) as u16
    }

    /// Sequence and stratigraphic depth (m) of what lies at voxel `p`.
    pub fn restored(&self, p: DVec3) -> (Sequence, f64) {
        let block = self.block_at(p);
        let p = self.metric(p);
        self.restored_in(block, p.truncate(), p.z)
    }

    /// [`SynthTruth::restored`] at a metric place in a block that is known.
    fn restored_in(&self, block: u16, place: DVec2, depth_m: f64) -> (Sequence, f64) {
        let depth_m = depth_m - self.displacement_m(block, place);
        let base_m = self.horizons[self.unconformity].strat_m;
        let sequence = if depth_m < self.young_beds.depth_m(base_m, place) { Sequence::Young } else { Sequence::Old };
        (sequence, self.beds(sequence).strat_m(depth_m, place))
    }

    /// Acoustic impedance at voxel `p`, kg/(m²·s): of the bed, and a few per cent of slow change along it.
    pub(crate) fn impedance_at(&self, p: DVec3) -> f64 {
        if self.in_salt(p) {
            return SALT_IMPEDANCE;
        }
        let (sequence, strat_m) = self.restored(p);
        let column = match sequence {
            Sequence::Young => &self.young_column,
            Sequence::Old => &self.old_column,
        };
        // The change along a bed is the slope of its folds' own waves: it needs no further parameters.
        let place = DVec2::new(p.x, p.y) * self.step_m.truncate();
        column.impedance_at(strat_m) * (1.0 + 0.25 * self.old_beds.thickening.at(place))
    }

    /// Signed offset of voxel `p` from the extended surface of a fault, m: positive in the hanging wall.
    pub fn fault_side_m(&self, fault: usize, p: DVec3) -> f64 {
        self.faults[fault].side_m(self.metric(p))
    }

    /// Throw of a fault over (x, y), m; positive: hanging wall down.
    pub fn throw_m(&self, fault: usize, x: f64, y: f64) -> f64 {
        self.faults[fault].throw_at(DVec2::new(x, y) * self.step_m.truncate())
    }

    /// Whether a fault exists at voxel `p`'s crossline: false beyond its tip, where it is only extended.
    pub fn fault_is_real(&self, fault: usize, p: DVec3) -> bool {
        self.faults[fault].is_real(p.y * self.step_m.y)
    }
}
