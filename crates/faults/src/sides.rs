//! What lies on both sides of a fault, carried to it along the slopes of the reflections.
//!
//! Traces two and three off the fault are read where the reflection that they hold would meet it; the slope is taken at the
//! outer trace, clear of the fault. So both sides match without a shift where beds run through, and after one where they are
//! offset.

use attribute::DipVolumes;
use survey::Volume;

/// Distances of the traces that are read, traces.
pub(crate) const NEAR: [f32; 2] = [2.0, 3.0];
/// Those that are read to see whether a throw holds farther away.
pub(crate) const FAR: [f32; 2] = [4.0, 5.0];
/// Traces beyond a place that its near sides depend on.
pub(crate) const REACH: usize = 4;

/// A volume with its slopes.
#[derive(Clone, Copy)]
pub(crate) struct Sides<'a> {
    pub(crate) volume: &'a Volume<f32>,
    pub(crate) slopes: &'a DipVolumes,
    /// Distances of the traces that are read, traces.
    pub(crate) off: [f32; 2],
}

impl Sides<'_> {
    /// The amplitude beside a place on a fault, on the side to which `across` points; NaN where there is none.
    pub(crate) fn beside(&self, [x, y]: [f32; 2], across: [f32; 2], z: f32) -> f32 {
        let [nx, ny, nz] = self.volume.size();
        let row = ((z + 0.5).max(0.0) as usize).min(nz - 1);
        let trace = |off: f32| {
            let (i, j) = (x + off * across[0] + 0.5, y + off * across[1] + 0.5);
            let inside = i >= 0.0 && j >= 0.0 && i < nx as f32 && j < ny as f32;
            inside.then_some([i as usize, j as usize]).filter(|&[i, j]| self.volume.is_live(i, j))
        };
        let Some([ox, oy]) = trace(self.off[1]) else { return f32::NAN };
        let (p, q) = (self.slopes.inline.at(ox, oy, row), self.slopes.crossline.at(ox, oy, row));
        let (mut sum, mut count) = (0.0, 0.0);
        for off in self.off {
            let Some([i, j]) = trace(off) else { continue };
            let at = z + p * (i as f32 - x) + q * (j as f32 - y);
            if at < 0.0 || at > (nz - 1) as f32 {
                continue;
            }
            let trace = self.volume.trace(i, j);
            let n = (at as usize).min(nz.saturating_sub(2));
            let value = trace[n] + (at - n as f32) * (trace[(n + 1).min(nz - 1)] - trace[n]);
            if value.is_finite() {
                sum += value;
                count += 1.0;
            }
        }
        if count > 0.0 { sum / count } else { f32::NAN }
    }
}

/// Sums of pairs of amplitudes.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct PairSums {
    pub(crate) product: f32,
    pub(crate) left: f32,
    pub(crate) right: f32,
}

impl PairSums {
    /// −1 to 1.
    pub(crate) fn correlation(self) -> f32 {
        let power = (self.left * self.right).sqrt();
        if power > f32::MIN_POSITIVE { self.product / power } else { 0.0 }
    }
}
