//! The links of a pair of traces, all at once.
//!
//! The ends of a link lie half its dip above and below its sample. Where that is no more than a sample, an end is a stencil
//! of three samples, and the sums over all links are sums over slices, which the compiler turns into instructions on
//! several samples at a time; steeper links are left to be visited one by one.

use crate::links::{CUT_BELOW, DIP_STEP, WEIGHT_STEP};

/// The steepest dip of which both ends are stencils, in [`DIP_STEP`]: two samples from trace to trace.
const STEEPEST: i16 = 512;

/// Room for what the links of a pair of traces add to each sample: of either end its share of the link's own sample, and of
/// the samples that lie a dip downwards and upwards.
pub struct Stencils {
    level: Vec<f32>,
    down: Vec<f32>,
    up: Vec<f32>,
}

/// Whether a link is visited by itself.
#[inline]
pub fn is_steep(dip: i16) -> bool {
    !(-STEEPEST..=STEEPEST).contains(&dip)
}

impl Stencils {
    /// For traces of `nz` samples.
    pub fn new(nz: usize) -> Self {
        let room = || vec![0.0; nz];
        Self { level: room(), down: room(), up: room() }
    }

    /// Adds half the gradient of Σ weight (b(z + p/2) − a(z − p/2) + offset p)², with p the dip, over all links that are
    /// not steep; returns whether others have a weight. Every slice is a trace; links with a weight have both ends inside.
    pub fn add(
        &mut self,
        offset: f32,
        (dips, weights): (&[i16], &[u8]),
        [a, b]: [&[f32]; 2],
        [out_a, out_b]: [&mut [f32]; 2],
    ) -> bool {
        let nz = dips.len();
        let links = dips.iter().zip(weights);
        let has_steep = links.fold(false, |found, (dip, weight)| found | is_steep(*dip) & (weight & !CUT_BELOW != 0));
        // At the ends of a trace only level links have both ends inside.
        for z in [0, nz - 1] {
            self.level[z] = weight_of(0, weights[z]) * (b[z] - a[z]);
            (self.down[z], self.up[z]) = (0.0, 0.0);
        }
        if nz > 2 {
            self.differences(offset, (dips, weights), [a, b]);
            spread(&self.level, &self.down, &self.up, out_b, 1.0);
            spread(&self.level, &self.up, &self.down, out_a, -1.0);
        } else {
            for z in 0..nz {
                out_b[z] += self.level[z];
                out_a[z] -= self.level[z];
            }
        }
        has_steep
    }

    /// The weighed differences of all samples but the first and the last, in the shares of their ends.
    fn differences(&mut self, offset: f32, (dips, weights): (&[i16], &[u8]), [a, b]: [&[f32]; 2]) {
        let n = dips.len() - 2;
        let (a, b) = (beside(a), beside(b));
        let (dips, weights) = (&dips[1..=n], &weights[1..=n]);
        let (level, down, up) = (&mut self.level[1..=n], &mut self.down[1..=n], &mut self.up[1..=n]);
        for z in 0..n {
            let p = f32::from(dips[z]) * DIP_STEP;
            let (falls, rises) = (0.5 * p.max(0.0), 0.5 * (-p).max(0.0));
            let on_b = b[1][z] + falls * (b[2][z] - b[1][z]) + rises * (b[0][z] - b[1][z]);
            let on_a = a[1][z] + rises * (a[2][z] - a[1][z]) + falls * (a[0][z] - a[1][z]);
            let e = weight_of(dips[z], weights[z]) * (on_b - on_a + offset * p);
            (down[z], up[z]) = (falls * e, rises * e);
            level[z] = e - down[z] - up[z];
        }
    }
}

/// The sample before, the sample itself and the next, of all samples but the first and the last.
fn beside(trace: &[f32]) -> [&[f32]; 3] {
    let n = trace.len() - 2;
    [&trace[..n], &trace[1..=n], &trace[2..n + 2]]
}

/// The weight of a link, none of a steep one.
#[inline]
fn weight_of(dip: i16, weight: u8) -> f32 {
    let weight = f32::from(weight & !CUT_BELOW) * WEIGHT_STEP;
    if is_steep(dip) { 0.0 } else { weight }
}

/// Adds what every sample has for itself, for the next and for the one before, with a sign.
fn spread(level: &[f32], next: &[f32], before: &[f32], out: &mut [f32], sign: f32) {
    let n = out.len() - 2;
    out[0] += sign * (level[0] + before[1]);
    out[n + 1] += sign * (level[n + 1] + next[n]);
    let (level, next, before, out) = (&level[1..=n], &next[..n], &before[2..n + 2], &mut out[1..=n]);
    for z in 0..n {
        out[z] += sign * (level[z] + next[z] + before[z]);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Adds `value` to the two samples around a place by their shares.
    fn put(trace: &mut [f64], z: f64, value: f64) {
        let low = (z.floor() as usize).min(trace.len() - 2);
        trace[low] += (1.0 - (z - low as f64)) * value;
        trace[low + 1] += (z - low as f64) * value;
    }

    #[test]
    fn stencils_add_what_links_one_by_one_do() {
        for nz in [2, 3, 4, 61] {
            let noise = |n: usize, most: i64| (n as i64 * 7919 + 13) % 1009 % (2 * most + 1) - most;
            let trace =
                |seed: usize| -> Vec<f32> { (0..nz).map(|z| noise(31 * z + seed, 400) as f32 / 100.0).collect() };
            let (a, b) = (trace(1), trace(2));
            let dips: Vec<i16> = (0..nz).map(|z| if z % 3 == 0 { 0 } else { noise(z, 512) as i16 }).collect();
            let ends = |z: usize| [-0.5, 0.5].map(|half| z as f64 + half * f64::from(dips[z]) / 256.0);
            let is_inside = |z: &usize| ends(*z).iter().all(|end| (0.0..=(nz - 1) as f64).contains(end));
            let weight = |z: usize| if is_inside(&z) { (z * 37 % 128) as u8 } else { 0 };
            // A cut below a sample is no part of the weight.
            let weights: Vec<u8> = (0..nz).map(|z| weight(z) | if z % 5 == 0 { CUT_BELOW } else { 0 }).collect();
            let mut found = [vec![0.25f32; nz], vec![-0.5f32; nz]];
            let [on_a, on_b] = &mut found;
            assert!(!Stencils::new(nz).add(0.7, (&dips, &weights), [&a, &b], [on_a, on_b]));
            let mut meant = [vec![0.25f64; nz], vec![-0.5f64; nz]];
            for z in (0..nz).filter(is_inside) {
                let at = |trace: &[f32], place: f64| {
                    let low = (place.floor() as usize).min(nz - 2);
                    let share = place - low as f64;
                    (1.0 - share) * f64::from(trace[low]) + share * f64::from(trace[low + 1])
                };
                let [up, down] = ends(z);
                let difference = at(&b, down) - at(&a, up) + 0.7 * f64::from(dips[z]) / 256.0;
                let e = f64::from(weights[z] & 127) / 127.0 * difference;
                put(&mut meant[0], up, -e);
                put(&mut meant[1], down, e);
            }
            for (found, meant) in found.iter().flatten().zip(meant.iter().flatten()) {
                assert!((f64::from(*found) - meant).abs() < 1e-5, "{nz}: {found} {meant}");
            }
        }
    }

    #[test]
    fn steep_links_are_left_and_told() {
        let (dips, weights) = ([0i16, 0, 513, 0, 0], [0u8, 0, 127, 0, 0]);
        let (a, b) = ([0.0f32; 5], [1.0f32, 2.0, 3.0, 4.0, 5.0]);
        let [mut on_a, mut on_b] = [[0.0f32; 5]; 2];
        assert!(Stencils::new(5).add(1.0, (&dips, &weights), [&a, &b], [&mut on_a, &mut on_b]));
        assert_eq!([on_a, on_b], [[0.0; 5]; 2]);
        assert!(!Stencils::new(5).add(1.0, (&dips, &[CUT_BELOW; 5]), [&a, &b], [&mut on_a, &mut on_b]));
    }
}
