//! Links between neighbouring traces: the dip p of the layering at every sample, and how far it can be trusted.
//!
//! A hub that is on both traces gives the dip at its depth. Between two such depths the dip is interpolated; far from
//! them it is taken from the closest and counts little. A link at sample z joins z − p/2 on the first trace with z + p/2
//! on the second. Where a fault lies between its ends the link has no weight. Memory: 6 bytes a voxel.

use crate::cuts::Cut;
use crate::hubs::Hubs;
use crate::interpretation::KnownHorizon;
use rayon::prelude::*;
use system::huge_pages;

/// Dips are stored in steps of this part of a sample.
pub(crate) const DIP_STEP: f32 = 1.0 / 256.0;
/// Weights are stored in steps of this part.
pub(crate) const WEIGHT_STEP: f32 = 1.0 / 127.0;
/// Bit of the weight along inlines that says that a fault lies between this sample and the next of its trace; in the
/// weight along crosslines, that a fault or an unconformity does.
pub(crate) const CUT_BELOW: u8 = 1 << 7;
/// What is left of the weight of a link through an unconformity: without any the beds that it leaves as islands would
/// have no time.
pub(crate) const THROUGH: f32 = 0.05;

/// Widest gap between two hubs across which the dip is interpolated with full weight, samples.
const FULL_GAP: f32 = 16.0;
/// Distance from a hub up to which its dip has full weight, samples.
const FULL_REACH: f32 = 4.0;
/// Weight of a dip that is taken from farther away.
const FAR_WEIGHT: f32 = 0.15;
/// Weight of a link of traces that share no hub: flat, and next to nothing.
const BLIND_WEIGHT: f32 = 0.02;
/// Traces beside a fault, plus half the dip, within which the ends of links are compared with it.
const NEAR_FAULT: f32 = 6.0;

/// Dips and weights of the links of all traces, `[inline][crossline][sample]`.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Links {
    /// Dip to the next inline and to the next crossline, in [`DIP_STEP`].
    pub dip: [Vec<i16>; 2],
    /// Weight of the same links in [`WEIGHT_STEP`]; 0 on the last lines. Both have [`CUT_BELOW`] too.
    pub weight: [Vec<u8>; 2],
}

/// The depths at which two traces share a hub: (middle depth, dip).
fn shared(hubs: &Hubs, a: usize, b: usize, by_hub: &mut Vec<(u32, usize)>, out: &mut Vec<(f32, f32)>) {
    out.clear();
    by_hub.clear();
    by_hub.extend(hubs.on_trace(b).map(|v| (hubs.hub[v], v)));
    by_hub.sort_unstable();
    let mut last = f32::NEG_INFINITY;
    for v in hubs.on_trace(a) {
        let from = by_hub.partition_point(|&(hub, _)| hub < hubs.hub[v]);
        let same = by_hub[from..].iter().take_while(|&&(hub, _)| hub == hubs.hub[v]);
        let next = same.map(|&(_, w)| hubs.z[w]).min_by(|p, q| (p - hubs.z[v]).abs().total_cmp(&(q - hubs.z[v]).abs()));
        // Hubs that cross between the traces contradict each other: the upper one stays.
        if let Some(z) = next.filter(|&z| z > last) {
            last = z;
            out.push((0.5 * (hubs.z[v] + z), z - hubs.z[v]));
        }
    }
}

/// Dip and weight at sample `z`; `below` is the index of the first shared depth not above it.
fn dip_at(shared: &[(f32, f32)], below: usize, z: f32) -> (f32, f32) {
    let before = below.checked_sub(1).map(|n| shared[n]);
    match (before, shared.get(below).copied()) {
        (Some((za, pa)), Some((zb, pb))) => {
            let share = (z - za) / (zb - za).max(1e-3);
            let near = (z - za).min(zb - z);
            let weight = if zb - za <= FULL_GAP || near <= FULL_REACH { 1.0 } else { FAR_WEIGHT };
            (pa + share * (pb - pa), weight)
        }
        (Some((at, p)), None) | (None, Some((at, p))) => {
            (p, if (z - at).abs() <= FULL_REACH { 1.0 } else { FAR_WEIGHT })
        }
        (None, None) => (0.0, BLIND_WEIGHT),
    }
}

impl Links {
    /// Links along the dips of the hubs, cut at faults, and weak through unconformities.
    pub(crate) fn new(hubs: &Hubs, cuts: &[Cut], horizons: &[KnownHorizon]) -> Self {
        let [nx, ny, nz] = hubs.size;
        let extents: Vec<Vec<[f32; 2]>> = cuts.iter().map(Cut::extents).collect();
        // Whether a fault comes within a distance of a trace, at any depth.
        let is_near = |n: usize, trace: [usize; 2], distance: f32| {
            let [across, line] = cuts[n].split(trace);
            let [least, most] = extents[n][line];
            across as f32 >= least - distance && across as f32 <= most + distance
        };
        let jumps: Vec<Vec<f32>> = horizons.iter().filter_map(|horizon| jumps(horizon, hubs.size)).collect();
        let line = |axis: usize| -> (Vec<i16>, Vec<u8>) {
            let (mut dips, mut weights) = (huge_pages::zeroed(nx * ny * nz), huge_pages::zeroed(nx * ny * nz));
            let lines = dips.par_chunks_mut(ny * nz).zip(weights.par_chunks_mut(ny * nz)).enumerate();
            lines.for_each(|(x, (dips, weights))| {
                let (mut by_hub, mut depths) = (Vec::new(), Vec::new());
                for y in 0..ny {
                    let range = y * nz..(y + 1) * nz;
                    let (dips, weights) = (&mut dips[range.clone()], &mut weights[range]);
                    let next = if axis == 0 { [x + 1, y] } else { [x, y + 1] };
                    if next[0] < nx && next[1] < ny {
                        shared(hubs, x * ny + y, next[0] * ny + next[1], &mut by_hub, &mut depths);
                        fill(&depths, dips, weights);
                        let steepest = dips.iter().map(|dip| dip.unsigned_abs()).max().unwrap_or(0);
                        let reach = NEAR_FAULT + 0.5 * f32::from(steepest) * DIP_STEP;
                        for (n, cut) in cuts.iter().enumerate() {
                            if is_near(n, [x, y], reach) || is_near(n, next, reach) {
                                cut_links(cut, [x, y], next, dips, weights);
                            }
                        }
                        let traces = [x * ny + y, next[0] * ny + next[1]];
                        jumps.iter().for_each(|jump| weaken(traces.map(|trace| jump[trace]), dips, weights));
                    }
                    let near = cuts.iter().enumerate().filter(|(n, _)| is_near(*n, [x, y], 1.0));
                    near.for_each(|(_, cut)| mark_below(cut, [x, y], weights));
                    if axis == 1 {
                        jumps.iter().for_each(|jump| mark_jump(jump[x * ny + y], weights));
                    }
                }
            });
            (dips, weights)
        };
        let ((dip_x, weight_x), (dip_y, weight_y)) = (line(0), line(1));
        Self { dip: [dip_x, dip_y], weight: [weight_x, weight_y] }
    }

    /// Whether a fault lies between the voxel of this index and the next of its trace.
    #[inline]
    pub(crate) fn is_cut_below(&self, voxel: usize) -> bool {
        self.weight[0][voxel] & CUT_BELOW != 0
    }

    /// Whether a fault or an unconformity lies between the voxel of this index and the next of its trace.
    #[inline]
    pub(crate) fn is_broken_below(&self, voxel: usize) -> bool {
        self.weight[1][voxel] & CUT_BELOW != 0
    }
}

/// On every trace, between which samples τ jumps at a horizon, as the middle between them; NaN where it does not. `None`
/// where it jumps nowhere. Where a trace has it twice, the upper one counts.
pub(crate) fn jumps(horizon: &KnownHorizon, [nx, ny, nz]: [usize; 3]) -> Option<Vec<f32>> {
    let mut all = vec![f32::NAN; nx * ny];
    let mut any = false;
    for (trace, above) in horizon.jumps(ny).filter(|(_, above)| *above >= 0.0 && *above < (nz - 1) as f32) {
        // The least of a number and NaN is the number.
        all[trace] = all[trace].min(above + 0.5);
        any = true;
    }
    any.then_some(all)
}

/// Leaves little of the links whose ends lie on different sides of a jump.
fn weaken([a, b]: [f32; 2], dips: &[i16], weights: &mut [u8]) {
    if a.is_nan() || b.is_nan() {
        return;
    }
    for z in 0..dips.len() {
        let half = 0.5 * f32::from(dips[z]) * DIP_STEP;
        if (z as f32 - half > a) != (z as f32 + half > b) {
            let marks = weights[z] & CUT_BELOW;
            weights[z] = (f32::from(weights[z] & !CUT_BELOW) * THROUGH).round() as u8 | marks;
        }
    }
}

/// Marks the sample of a trace below which τ jumps.
fn mark_jump(at: f32, weights: &mut [u8]) {
    if at.is_finite() {
        weights[at as usize] |= CUT_BELOW;
    }
}

/// Dips and weights of one pair of traces, without faults.
fn fill(shared: &[(f32, f32)], dips: &mut [i16], weights: &mut [u8]) {
    let nz = dips.len();
    let mut below = 0;
    for z in 0..nz {
        let at = z as f32;
        while below < shared.len() && shared[below].0 < at {
            below += 1;
        }
        let (p, w) = dip_at(shared, below, at);
        let stored = (p / DIP_STEP).round().clamp(f32::from(i16::MIN), f32::from(i16::MAX));
        let half = 0.5 * stored * DIP_STEP;
        let inside = |z: f32| z >= 0.0 && z <= (nz - 1) as f32;
        dips[z] = stored as i16;
        weights[z] = if inside(at - half) && inside(at + half) { (w / WEIGHT_STEP).round() as u8 } else { 0 };
    }
}

/// Takes the weight of links whose four nodes do not lie on one side of a fault.
fn cut_links(cut: &Cut, a: [usize; 2], b: [usize; 2], dips: &[i16], weights: &mut [u8]) {
    for z in 0..dips.len() {
        let half = 0.5 * f32::from(dips[z]) * DIP_STEP;
        let near = cut.side(a, z as f32);
        if near.is_nan() && cut.side(b, z as f32).is_nan() || near.abs() > NEAR_FAULT + half.abs() {
            continue;
        }
        let (za, zb) = ((z as f32 - half).floor(), (z as f32 + half).floor());
        let ends = [(a, za), (a, za + 1.0), (b, zb), (b, zb + 1.0)];
        let mut sides = ends.map(|(trace, z)| cut.side(trace, z)).into_iter().filter(|side| !side.is_nan());
        let Some(first) = sides.next() else { continue };
        if sides.any(|side| (side > 0.0) != (first > 0.0)) {
            weights[z] = 0;
        }
    }
}

/// Marks the samples of a trace below which a fault passes.
fn mark_below(cut: &Cut, trace: [usize; 2], weights: &mut [u8]) {
    for z in 1..weights.len() {
        if cut.separates(trace, z as f32 - 1.0, trace, z as f32) {
            weights[z - 1] |= CUT_BELOW;
        }
    }
}
