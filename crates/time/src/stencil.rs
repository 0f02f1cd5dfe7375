//! The links of a pair of traces, and the differences along one, all at once.
//!
//! The ends of a link lie half its dip above and below its sample. Where that is no more than a sample, an end is a stencil
//! of three samples, and the sums over all links are sums over slices, which the compiler turns into instructions on
//! several samples at a time; steeper links are left to be visited one by one.

use crate::links::{CUT_BELOW, DIP_STEP, WEIGHT_STEP};
use system::wide::{Wide, widest};

/// The steepest dip of which both ends are stencils, in [`DIP_STEP`]: two samples from trace to trace.
const STEEPEST: i16 = 512;

/// Room for what the links of a pair of traces add to each sample: of either end its share of the link's own sample, and of
/// the samples that lie a dip downwards and upwards.
pub(crate) struct Stencils {
    level: Vec<f32>,
    down: Vec<f32>,
    up: Vec<f32>,
}

/// Whether a link is visited by itself.
#[inline(always)]
pub(crate) fn is_steep(dip: i16) -> bool {
    !(-STEEPEST..=STEEPEST).contains(&dip)
}

impl Stencils {
    /// For traces of `nz` samples.
    pub(crate) fn new(nz: usize) -> Self {
        let room = || vec![0.0; nz];
        Self { level: room(), down: room(), up: room() }
    }

    /// Adds half the gradient of Σ weight (b(z + p/2) − a(z − p/2) + offset p)², with p the dip, over all links that are
    /// not steep; returns whether others have a weight. Every slice is a trace; links with a weight have both ends inside.
    pub(crate) fn add(
        &mut self,
        offset: f32,
        (dips, weights): (&[i16], &[u8]),
        ends: [&[f32]; 2],
        out: [&mut [f32]; 2],
    ) -> bool {
        widest(Between { room: self, offset, dips, weights, ends, out })
    }

    /// Half the gradient of e₁ Σ (first difference)² + e₂ Σ (second difference)² along a trace, but for the differences
    /// over a fault or an unconformity.
    pub(crate) fn along(&mut self, smoothness: [f32; 2], s: &[f32], weights: &[u8], out: &mut [f32]) {
        widest(Along { room: self, smoothness, s, weights, out });
    }
}

/// The links of a pair of traces.
struct Between<'a> {
    room: &'a mut Stencils,
    offset: f32,
    dips: &'a [i16],
    weights: &'a [u8],
    ends: [&'a [f32]; 2],
    out: [&'a mut [f32]; 2],
}

impl Wide for Between<'_> {
    type Output = bool;

    #[inline(always)]
    fn run(self) -> bool {
        let Self { room: Stencils { level, down, up }, offset, dips, weights, ends: [a, b], out: [out_a, out_b] } =
            self;
        let nz = dips.len();
        let links = dips.iter().zip(weights);
        let has_steep = links.fold(false, |found, (dip, weight)| found | is_steep(*dip) & (weight & !CUT_BELOW != 0));
        // At the ends of a trace only level links have both ends inside.
        for z in [0, nz - 1] {
            level[z] = weight_of(0, weights[z]) * (b[z] - a[z]);
            (down[z], up[z]) = (0.0, 0.0);
        }
        if nz > 2 {
            differences(offset, (dips, weights), [a, b], [&mut *level, &mut *down, &mut *up]);
            spread(level, down, up, out_b, 1.0);
            spread(level, up, down, out_a, -1.0);
        } else {
            for z in 0..nz {
                out_b[z] += level[z];
                out_a[z] -= level[z];
            }
        }
        has_steep
    }
}

/// The weighed differences of all samples but the first and the last, in the shares of their ends.
#[inline(always)]
fn differences(offset: f32, (dips, weights): (&[i16], &[u8]), [a, b]: [&[f32]; 2], [level, down, up]: [&mut [f32]; 3]) {
    let n = dips.len() - 2;
    let (a, b) = (beside(a), beside(b));
    let (dips, weights) = (&dips[1..=n], &weights[1..=n]);
    let (level, down, up) = (&mut level[1..=n], &mut down[1..=n], &mut up[1..=n]);
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

/// The sample before, the sample itself and the next, of all samples but the first and the last.
#[inline(always)]
fn beside(trace: &[f32]) -> [&[f32]; 3] {
    let n = trace.len() - 2;
    [&trace[..n], &trace[1..=n], &trace[2..n + 2]]
}

/// The weight of a link, none of a steep one.
#[inline(always)]
fn weight_of(dip: i16, weight: u8) -> f32 {
    let weight = f32::from(weight & !CUT_BELOW) * WEIGHT_STEP;
    if is_steep(dip) { 0.0 } else { weight }
}

/// Adds what every sample has for itself, for the next and for the one before, with a sign.
#[inline(always)]
fn spread(level: &[f32], next: &[f32], before: &[f32], out: &mut [f32], sign: f32) {
    let n = out.len() - 2;
    out[0] += sign * (level[0] + before[1]);
    out[n + 1] += sign * (level[n + 1] + next[n]);
    let (level, next, before, out) = (&level[1..=n], &next[..n], &before[2..n + 2], &mut out[1..=n]);
    for z in 0..n {
        out[z] += sign * (level[z] + next[z] + before[z]);
    }
}

/// The differences along a trace.
struct Along<'a> {
    room: &'a mut Stencils,
    smoothness: [f32; 2],
    s: &'a [f32],
    weights: &'a [u8],
    out: &'a mut [f32],
}

impl Wide for Along<'_> {
    type Output = ();

    #[inline(always)]
    fn run(self) {
        let Self { room: Stencils { level: steps, down: bends, .. }, smoothness: [e1, e2], s, weights, out } = self;
        let Some(n) = s.len().checked_sub(2) else { return out.fill(0.0) };
        let goes_on = |weights: u8| f32::from(u8::from(weights & CUT_BELOW == 0));
        for (((step, s), below), weight) in steps[..=n].iter_mut().zip(s).zip(&s[1..]).zip(weights) {
            *step = goes_on(*weight) * (below - s);
        }
        // No step and no bend lies beyond either end.
        (steps[n + 1], bends[0], bends[n + 1]) = (0.0, 0.0, 0.0);
        let changes = steps[..n].iter().zip(&steps[1..=n]).zip(weights.iter().zip(&weights[1..]));
        for (bend, ((above, below), (weight, next))) in bends[1..=n].iter_mut().zip(changes) {
            *bend = e2 * goes_on(weight | next) * (below - above);
        }
        out[0] = bends[1] - e1 * steps[0];
        out[n + 1] = bends[n] + e1 * steps[n];
        let steps = steps[..n].iter().zip(&steps[1..=n]);
        let bends = bends[..n].iter().zip(&bends[1..=n]).zip(&bends[2..]);
        for (out, ((above, below), ((before, bend), next))) in out[1..=n].iter_mut().zip(steps.zip(bends)) {
            *out = e1 * (above - below) + (before - 2.0 * bend + next);
        }
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

    #[test]
    fn differences_along_a_trace_are_those_of_single_terms() {
        for nz in [1, 2, 3, 4, 61] {
            let s: Vec<f32> = (0..nz).map(|z| (z * 7919 % 101) as f32 / 50.0).collect();
            let weights: Vec<u8> = (0..nz).map(|z| if z % 7 == 3 { CUT_BELOW | 5 } else { 5 }).collect();
            let (mut found, mut meant) = (vec![9.0f32; nz], vec![0.0f32; nz]);
            Stencils::new(nz).along([0.3, 0.7], &s, &weights, &mut found);
            let goes_on = |z: usize| weights[z] & CUT_BELOW == 0;
            for z in (0..nz - 1).filter(|&z| goes_on(z)) {
                let step = 0.3 * (s[z + 1] - s[z]);
                meant[z] -= step;
                meant[z + 1] += step;
                if z > 0 && goes_on(z - 1) {
                    let bend = 0.7 * (s[z + 1] - 2.0 * s[z] + s[z - 1]);
                    for (z, share) in [(z - 1, 1.0), (z, -2.0), (z + 1, 1.0)] {
                        meant[z] += share * bend;
                    }
                }
            }
            for (found, meant) in found.iter().zip(&meant) {
                assert!((found - meant).abs() < 1e-5, "{nz}: {found} {meant}");
            }
        }
    }
}
