//! The reflectors of the synthetic survey along a vertical line. Each is named by its sequence and its place
//! in the column.
//!
//! A vertical line leaves hanging walls from high x to low x on its way down; in each block its reflectors
//! are those of the column, folded, moved by the faults, and cut at the unconformity. Positions are
//! fractional voxels.

use super::column::reflectivity;
use super::truth::{Sequence, SynthTruth};
use glam::{DVec2, DVec3};

/// Reflectivity where a vertical line enters salt; the other way round where it leaves.
const SALT_REFLECTIVITY: f64 = 0.12;
/// Step at which the outline of the salt is looked for along a vertical line, m.
const SALT_STEP_M: f64 = 2.0;

/// A reflector of the model.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct Reflector {
    /// Whether it belongs to the beds below the unconformity.
    pub old: bool,
    /// Its place in the column of its sequence, top first.
    pub index: u16,
}

/// A reflector over one trace.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ReflectorEvent {
    /// Fractional sample.
    pub z: f64,
    /// Reflectivity, positive: harder below.
    pub reflectivity: f64,
    /// Which reflector.
    pub reflector: Reflector,
    /// Fault block it lies in there.
    pub block: u16,
}

impl SynthTruth {
    /// The reflector that a named horizon is.
    pub fn reflector_of(&self, horizon: usize) -> Reflector {
        let horizon = &self.horizons[horizon];
        let old = horizon.sequence == Sequence::Old;
        let column = if old { &self.old_column } else { &self.young_column };
        Reflector { old, index: column.nearest(horizon.strat_m) as u16 }
    }

    /// The reflectors along a vertical line, from 1.5 wavelengths above the volume to as far below: (voxel z,
    /// reflectivity), top first.
    pub fn reflectors(&self, x: f64, y: f64) -> Vec<(f64, f64)> {
        let mut found: Vec<(f64, f64)> = self.events(x, y).iter().map(|event| (event.z, event.reflectivity)).collect();
        if let Some(salt) = &self.salt {
            found.retain(|&(z, _)| !self.in_salt(DVec3::new(x, y, z)));
            let place = DVec2::new(x, y) * self.step_m.truncate();
            let outline = salt.crossings(place.distance(salt.axis), SALT_STEP_M);
            found.extend(outline.map(|(z_m, enters)| {
                (z_m / self.step_m.z, if enters { SALT_REFLECTIVITY } else { -SALT_REFLECTIVITY })
            }));
            found.sort_by(|a, b| a.0.total_cmp(&b.0));
        }
        found
    }

    /// [`SynthTruth::reflectors`] with what each of them is.
    pub fn events(&self, x: f64, y: f64) -> Vec<ReflectorEvent> {
        let place = DVec2::new(x, y) * self.step_m.truncate();
        let margin_m = 1.5 * self.wavelength_m;
        let range = [-margin_m, (self.size[2] - 1) as f64 * self.step_m.z + margin_m];
        let crossings: Vec<f64> = self.faults.iter().map(|fault| fault.crossing_m(place)).collect();
        let mut found = Vec::new();
        for block in (0..self.block_count()).rev() {
            let top = crossings.get(block).map_or(range[0], |&z| z.max(range[0]));
            let bottom = if block == 0 { range[1] } else { crossings[block - 1].min(range[1]) };
            if top < bottom {
                self.events_in(block as u16, place, [top, bottom], &mut found);
            }
        }
        for event in &mut found {
            event.z /= self.step_m.z;
        }
        found
    }

    /// Adds the reflectors of one block between two depths; their z is still in m.
    fn events_in(&self, block: u16, place: DVec2, [top, bottom]: [f64; 2], found: &mut Vec<ReflectorEvent>) {
        let moved = self.displacement_m(block, place);
        let base_m = self.horizons[self.unconformity].strat_m;
        let base_depth = self.young_beds.depth_m(base_m, place) + moved;
        let (top_strat, base) = (self.young_beds.strat_m(top - moved, place), self.young_column.reflectors_m.len() - 1);
        let event = |old, index: usize, z, reflectivity| ReflectorEvent {
            z,
            reflectivity,
            reflector: Reflector { old, index: index as u16 },
            block,
        };
        for index in self.young_column.reflectors_m.partition_point(|&s| s < top_strat)..base {
            let depth = self.young_beds.depth_m(self.young_column.reflectors_m[index], place) + moved;
            if depth >= bottom {
                break;
            }
            found.push(event(false, index, depth, self.young_column.reflectivity(index)));
        }
        if base_depth >= top && base_depth < bottom {
            let strat_below = self.old_beds.strat_m(base_depth - moved, place);
            let below = self.old_column.impedance_at(strat_below);
            found.push(event(false, base, base_depth, reflectivity(self.young_column.impedance[base], below)));
        }
        let first_strat = self.old_beds.strat_m(top.max(base_depth) - moved, place);
        for index in
            self.old_column.reflectors_m.partition_point(|&s| s <= first_strat)..self.old_column.reflectors_m.len()
        {
            let depth = self.old_beds.depth_m(self.old_column.reflectors_m[index], place) + moved;
            if depth >= bottom {
                break;
            }
            found.push(event(true, index, depth, self.old_column.reflectivity(index)));
        }
    }
}
