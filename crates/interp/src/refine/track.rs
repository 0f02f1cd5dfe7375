//! Tracking from one place: along the reflection from trace to trace, always on where neighbours are most alike, within
//! a window around the place and inside its fault block.

use crate::reassembly::VoxelSheet;
use crate::refine::line::sheet_of;
use crate::refine::reflection::{
    MOST_SEAM, MOST_STEP, TraceBox, TraceStep, WINDOW, Window, correlation, neighbours, summit,
};
use glam::Vec3;
use model::FaultNetwork;
use serde::{Deserialize, Serialize};
use std::collections::BinaryHeap;
use survey::{Quality, Volume};

/// Correlation from which neighbouring traces show the same reflection. There is no guide as in a hole, so it is stricter
/// than there: in noise, of five shifts one is often alike by chance.
const ALIKE: f32 = 0.85;
/// Correlation with the place that was picked, below which the reflection is no longer that one.
const LIKE_SEED: f32 = 0.5;
/// Samples from one trace to the next beyond which two nodes are no dip, but lie on different reflections.
const STEEPEST: f32 = 6.0;
/// Samples within which the place that was picked finds its extremum.
const SNAP: f32 = 4.0;

/// The window in which a reflection is tracked.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct TrackSettings {
    /// Traces to each side of the place.
    pub traces: u32,
    /// Samples above and below it.
    pub samples: u32,
}

impl Default for TrackSettings {
    fn default() -> Self {
        Self { traces: 60, samples: 60 }
    }
}

impl TrackSettings {
    /// The largest window; what is beyond counts as this.
    pub const MOST: Self = Self { traces: 1000, samples: 1000 };
}

/// Tracks the reflection at a place, a voxel of a survey of this size, and puts its nodes ([`Quality::Tracked`], the place
/// itself [`Quality::Picked`]) where the sheet of its fault block has none yet. Returns the number of nodes made. `read`
/// gives the samples of a box of voxels by its first corner and its size; one is read, the window.
///
/// # Errors
/// Those of `read`.
pub fn track<E>(
    sheets: &mut Vec<VoxelSheet>,
    at: Vec3,
    size: [usize; 3],
    blocks: &FaultNetwork,
    settings: &TrackSettings,
    read: impl FnOnce([usize; 3], [usize; 3]) -> Result<Volume<f32>, E>,
) -> Result<usize, E> {
    let [nx, ny, nz] = size;
    let within = settings.traces.min(TrackSettings::MOST.traces) as usize;
    let deep = settings.samples.min(TrackSettings::MOST.samples) as usize + (WINDOW + MOST_STEP + 2) as usize;
    let [x, y, z] = [at.x.round() as usize, at.y.round() as usize, at.z.round() as usize];
    if x >= nx || y >= ny || z >= nz {
        return Ok(0);
    }
    let first = [x.saturating_sub(within), y.saturating_sub(within), z.saturating_sub(deep)];
    let last = [(x + within).min(nx - 1), (y + within).min(ny - 1), (z + deep).min(nz - 1)];
    let samples = TraceBox {
        samples: read(first, std::array::from_fn(|axis| last[axis] + 1 - first[axis]))?,
        first,
        crosslines: ny,
    };
    let seed = x * ny + y;
    let z = samples.extremum(seed, at.z);
    let block = blocks.block_at(Vec3::new(x as f32, y as f32, z));
    let Some(like) = samples.window(seed, z) else { return Ok(0) };
    let deepest = settings.samples as f32;
    let growth = Growth { samples, like, block, blocks, plane: [nx, ny], depths: [z - deepest, z + deepest] };
    Ok(growth.grow(sheet_of(sheets, block, nx * ny), seed, z))
}

/// What growing from a place needs.
struct Growth<'a> {
    samples: TraceBox,
    /// What the reflection looks like at the place.
    like: Window,
    block: u16,
    blocks: &'a FaultNetwork,
    plane: [usize; 2],
    depths: [f32; 2],
}

impl Growth<'_> {
    fn grow(&self, sheet: &mut VoxelSheet, seed: usize, z: f32) -> usize {
        let (mut made, mut torn) = (Vec::new(), Vec::new());
        // A line that was drawn stays, but what is beside it is tracked from the place all the same.
        if sheet.z[seed].is_nan() {
            (sheet.z[seed], sheet.quality[seed]) = (z, Quality::Picked);
            made.push(seed);
        }
        let beside = neighbours(seed, self.plane).filter(|next| sheet.z[*next].is_nan());
        let mut front: BinaryHeap<TraceStep> = beside.filter_map(|next| self.step(sheet, (seed, z), next)).collect();
        while let Some(TraceStep { to, z, .. }) = front.pop() {
            if sheet.z[to].is_finite() {
                // Another way led to another cycle of the wave; no one knows which is right.
                if (sheet.z[to] - z).abs() > MOST_SEAM {
                    torn.push(to);
                }
                continue;
            }
            (sheet.z[to], sheet.quality[to]) = (z, Quality::Tracked);
            made.push(to);
            for next in neighbours(to, self.plane).filter(|next| sheet.z[*next].is_nan()) {
                front.extend(self.step(sheet, (to, z), next));
            }
        }
        torn.sort_unstable();
        torn.dedup();
        let is_torn = |n: usize| n != seed && torn.binary_search(&n).is_ok();
        let torn: Vec<usize> = made.iter().copied().filter(|&n| is_torn(n)).collect();
        for &n in &torn {
            (sheet.z[n], sheet.quality[n]) = (f32::NAN, Quality::Hole);
        }
        made.len() - torn.len()
    }

    /// The reflection on a neighbouring trace, expected where the dip of the last step leads.
    fn step(&self, sheet: &VoxelSheet, (from, z): (usize, f32), to: usize) -> Option<TraceStep> {
        let before = (2 * from).checked_sub(to).filter(|&n| neighbours(from, self.plane).any(|beside| beside == n));
        let dip = before.map(|n| z - sheet.z[n]).filter(|dip| dip.abs() <= STEEPEST).unwrap_or(0.0);
        let found = self.samples.step((from, z), to, z + dip, ALIKE)?;
        let place = Vec3::new((to / self.plane[1]) as f32, (to % self.plane[1]) as f32, found.z);
        let is_inside = (self.depths[0]..=self.depths[1]).contains(&found.z) && self.blocks.holds(self.block, place);
        let is_like = || self.samples.window(to, found.z).is_some_and(|own| correlation(&own, &self.like) >= LIKE_SEED);
        (is_inside && is_like()).then_some(found)
    }
}

impl TraceBox {
    /// The peak or trough nearest to a place of a trace, or the place where there is none close by.
    fn extremum(&self, n: usize, z: f32) -> f32 {
        let Some(around) = self.window(n, z) else { return z };
        let found = around.windows(3).enumerate().filter_map(|(k, three)| {
            let [before, at, after] = [three[0], three[1], three[2]];
            let is_extremum = at != 0.0 && (before - at) * (after - at) > 0.0 && (before - at) * at < 0.0;
            is_extremum.then(|| z + (k as i32 + 1 - WINDOW) as f32 + summit([before, at, after]))
        });
        let off = |place: f32| (place - z).abs();
        found.filter(|place| off(*place) <= SNAP).min_by(|a, b| off(*a).total_cmp(&off(*b))).unwrap_or(z)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::convert::Infallible;

    const SIZE: [usize; 3] = [40, 36, 90];

    /// A plane with a step where x is 28, of which nobody drew the fault.
    fn event(x: usize, y: usize) -> f32 {
        30.0 + 0.6 * x as f32 + 0.2 * y as f32 + if x >= 28 { 5.0 } else { 0.0 }
    }

    fn tracked(settings: &TrackSettings, at: Vec3) -> (usize, Vec<VoxelSheet>) {
        let read = |first: [usize; 3], size: [usize; 3]| -> Result<Volume<f32>, Infallible> {
            let mut part = Volume::filled(size, 0.0);
            for (x, y) in (0..size[0]).flat_map(|x| (0..size[1]).map(move |y| (x, y))) {
                let middle = event(first[0] + x, first[1] + y);
                for (k, sample) in part.trace_mut(x, y).iter_mut().enumerate() {
                    let off = ((first[2] + k) as f32 - middle) / 3.0;
                    *sample = -(1.0 - 2.0 * off * off) * (-off * off).exp();
                }
            }
            Ok(part)
        };
        let mut sheets = Vec::new();
        let made = track(&mut sheets, at, SIZE, &FaultNetwork::none(), settings, read).unwrap();
        (made, sheets)
    }

    #[test]
    fn a_reflection_is_tracked_from_one_place_and_not_over_a_step() {
        let (made, sheets) = tracked(&TrackSettings::default(), Vec3::new(10.0, 12.0, event(10, 12) + 1.4));
        assert_eq!(made, 28 * SIZE[1], "all of its side, nothing beyond the step");
        for (n, z) in sheets[0].z.iter().enumerate().filter(|(_, z)| z.is_finite()) {
            let truth = event(n / SIZE[1], n % SIZE[1]);
            assert!((z - truth).abs() < 0.3, "{z} is not {truth}");
        }
        assert_eq!(sheets[0].quality[10 * SIZE[1] + 12], Quality::Picked);
        assert_eq!(sheets[0].quality[11 * SIZE[1] + 12], Quality::Tracked);
    }

    #[test]
    fn tracking_stays_in_its_window() {
        let at = Vec3::new(10.0, 12.0, event(10, 12));
        let (made, _) = tracked(&TrackSettings { traces: 3, samples: 60 }, at);
        assert_eq!(made, 49);
        let (made, sheets) = tracked(&TrackSettings { traces: 60, samples: 2 }, at);
        let off = sheets[0].z.iter().filter(|z| z.is_finite()).map(|z| (z - at.z).abs()).fold(0.0, f32::max);
        assert!(made > 20 && off <= 2.05, "{made} nodes, {off} samples off");
        let (made, _) = tracked(&TrackSettings::default(), Vec3::new(10.0, 12.0, 5.0));
        assert_eq!(made, 0, "nothing is there to be followed, and the place is too near the top");
    }
}
