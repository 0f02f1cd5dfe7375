//! The last steps: τ is made monotone on every trace, exact on picked horizons, and hidden where it is not known.

use crate::coherence::Coherence;
use crate::hubs::Hubs;
use crate::interpretation::KnownHorizon;
use crate::isotonic::{Pools, regress};
use crate::links::{Links, jumps};
use crate::solve::{Tie, interpolate};
use crate::start;
use rayon::prelude::*;
use survey::Volume;

/// Weight of a voxel without a vertex in the regression.
const PLAIN_WEIGHT: f32 = 0.1;

/// Turns s into τ, made monotone on every trace between faults; returns how many voxels changed.
pub(crate) fn make_monotone(s: &mut [f32], hubs: &Hubs, links: &Links) -> usize {
    let [_, ny, nz] = hubs.size;
    s.par_chunks_mut(ny * nz)
        .enumerate()
        .map(|(x, line)| {
            let (mut pools, mut weights, mut changed) = (Pools::default(), vec![0.0f32; nz], 0);
            for (y, tau) in line.chunks_mut(nz).enumerate() {
                let trace = x * ny + y;
                weights.fill(PLAIN_WEIGHT);
                for v in hubs.on_trace(trace) {
                    let weight = hubs.weight[v] * (hubs.of_hub(hubs.hub[v] as usize).len() as f32).ln();
                    weights[hubs.z[v].round() as usize] += weight;
                }
                tau.iter_mut().enumerate().for_each(|(z, s)| *s += z as f32);
                let mut from = 0;
                for z in 0..nz {
                    if z + 1 == nz || links.is_cut_below(trace * nz + z) {
                        changed += regress(&mut tau[from..=z], |n| weights[from + n], &mut pools);
                        from = z + 1;
                    }
                }
            }
            changed
        })
        .sum()
}

/// Share of the traces on which τ may decrease at an unconformity: what noise does.
const SQUEEZED: f32 = 0.02;

/// Moves what lies below each unconformity until τ decreases hardly anywhere across it: beds may be missing there, but none
/// come twice. Links through it, which are weak, put the beds below at the mean.
pub(crate) fn open_jumps(s: &mut [f32], size: [usize; 3], horizons: &[KnownHorizon]) {
    let [_, ny, nz] = size;
    for horizon in horizons {
        let Some(mut jumps) = jumps(horizon, size) else { continue };
        let known = jumps.iter().enumerate().filter(|(_, at)| at.is_finite());
        let mut steps: Vec<f32> = known
            .map(|(trace, at)| {
                let above = trace * nz + *at as usize;
                s[above + 1] + 1.0 - s[above]
            })
            .collect();
        steps.sort_by(f32::total_cmp);
        let lacking = -steps[(SQUEEZED * steps.len() as f32) as usize];
        if lacking <= 0.0 {
            continue;
        }
        fill(&mut jumps, ny);
        s.par_chunks_mut(nz).zip(&jumps).for_each(|(s, at)| {
            let below = s.iter_mut().enumerate().filter(|(z, _)| *z as f32 > *at);
            below.for_each(|(_, s)| *s += lacking);
        });
    }
}

/// Gives every trace the value of the closest one that has one, step by step.
fn fill(values: &mut [f32], ny: usize) {
    while values.iter().any(|value| value.is_nan()) {
        let before = values.to_vec();
        for (n, value) in values.iter_mut().enumerate().filter(|(_, value)| value.is_nan()) {
            let y = n % ny;
            let beside = [(y > 0).then(|| n - 1), (y + 1 < ny).then(|| n + 1), n.checked_sub(ny), Some(n + ny)];
            let known = beside.into_iter().flatten().filter_map(|m| before.get(m)).find(|other| other.is_finite());
            *value = known.copied().unwrap_or(f32::NAN);
        }
        if values.iter().zip(&before).all(|(a, b)| a.is_nan() == b.is_nan()) {
            return;
        }
    }
}

/// Samples from a picked horizon over which a correction dies out.
const FADE: f32 = 24.0;
/// Least step of τ over a sample at a picked horizon, so that it has a crossing of its own.
const LEAST_STEP: f32 = 0.02;

/// Gives all nodes of each picked horizon one time, the mean over them: what is between two is corrected in proportion,
/// what is beyond the last less and less, and τ stays monotone. Vertices of at least the weight `known` are such nodes.
pub(crate) fn pin(tau: &mut [f32], hubs: &Hubs, links: &Links, known: f32) {
    let [nx, ny, nz] = hubs.size;
    let mut sums = vec![(0.0f64, 0usize); hubs.len()];
    for trace in 0..nx * ny {
        for v in hubs.on_trace(trace).filter(|&v| hubs.weight[v] >= known) {
            let sum = &mut sums[hubs.hub[v] as usize];
            sum.0 += f64::from(interpolate(&tau[trace * nz..(trace + 1) * nz], hubs.z[v]));
            sum.1 += 1;
        }
    }
    if sums.iter().all(|(_, count)| *count == 0) {
        return;
    }
    tau.par_chunks_mut(ny * nz).enumerate().for_each(|(x, line)| {
        for (y, tau) in line.chunks_mut(nz).enumerate() {
            let trace = x * ny + y;
            let mut from = 0;
            for z in 0..nz {
                if z + 1 < nz && !links.is_cut_below(trace * nz + z) {
                    continue;
                }
                let mut nodes: Vec<(f32, f32)> = Vec::new();
                for v in hubs.on_trace(trace).filter(|&v| hubs.weight[v] >= known) {
                    let (sum, count) = sums[hubs.hub[v] as usize];
                    let (at, time) = (hubs.z[v] - from as f32, (sum / count as f64) as f32);
                    let inside = at >= 0.0 && at <= (z - from) as f32;
                    // Horizons that touch, or that the reflections put into another order, cannot both be met.
                    let low = |at: f32| at.floor().min((z - from) as f32 - 1.0);
                    let follows = nodes.last().is_none_or(|l| low(at) >= low(l.0) + 2.0 && time >= l.1 + LEAST_STEP);
                    if inside && follows {
                        nodes.push((at, time));
                    }
                }
                if !nodes.is_empty() {
                    bend(&mut tau[from..=z], &nodes);
                }
                from = z + 1;
            }
        }
    });
}

/// Bends a monotone part of a trace through nodes (sample, time), both ascending.
fn bend(tau: &mut [f32], nodes: &[(f32, f32)]) {
    let off: Vec<(f32, f32)> = nodes.iter().map(|&(z, time)| (z, time - interpolate(tau, z))).collect();
    // The step over the samples around each node, no more than half the way to its neighbours.
    let steps: Vec<f32> = (0..nodes.len())
        .map(|n| {
            let (z, time) = nodes[n];
            let low = (z as usize).min(tau.len().saturating_sub(2));
            let own = tau.get(low + 1).map_or(LEAST_STEP, |below| below - tau[low]).max(LEAST_STEP);
            let above = n.checked_sub(1).map_or(f32::INFINITY, |m| time - nodes[m].1);
            let below = nodes.get(n + 1).map_or(f32::INFINITY, |next| next.1 - time);
            own.min(0.5 * above).min(0.5 * below)
        })
        .collect();
    let mut below = 0;
    for (n, tau) in tau.iter_mut().enumerate() {
        let z = n as f32;
        while below < off.len() && off[below].0 < z {
            below += 1;
        }
        *tau += match (below.checked_sub(1).map(|n| off[n]), off.get(below).copied()) {
            (Some((za, a)), Some((zb, b))) => a + (z - za) / (zb - za) * (b - a),
            (Some((at, only)), None) | (None, Some((at, only))) => only * (1.0 - (z - at).abs() / FADE).max(0.0),
            (None, None) => 0.0,
        };
    }
    let mut floor = f32::NEG_INFINITY;
    let mut from = 0;
    for (&(z, time), step) in nodes.iter().zip(steps) {
        let low = (z as usize).min(tau.len().saturating_sub(2));
        let share = z - low as f32;
        tau[low] = time - share * step;
        if let Some(below) = tau.get_mut(low + 1) {
            *below = time + (1.0 - share) * step;
        }
        let ceiling = tau[low];
        for tau in &mut tau[from..low] {
            *tau = tau.max(floor).min(ceiling);
            floor = *tau;
        }
        (floor, from) = (tau[(low + 1).min(tau.len() - 1)], (low + 2).min(tau.len()));
    }
    for tau in &mut tau[from..] {
        *tau = tau.max(floor);
        floor = *tau;
    }
}

/// Makes τ NaN where reflections follow it hardly better than chance would, unless a picked horizon, whose vertices weigh
/// `known`, is within `reach` samples; returns how many voxels are left.
pub(crate) fn hide_chaos(tau: &mut [f32], hubs: &Hubs, volume: &Volume<f32>, reach: usize, known: f32) -> usize {
    let [_, ny, nz] = hubs.size;
    let coherence = Coherence::new(tau, volume);
    let lines = tau.par_chunks_mut(ny * nz).enumerate().map(|(x, line)| {
        let (mut told, mut left) = (vec![false; nz], 0);
        for (y, tau) in line.chunks_mut(nz).enumerate() {
            told.fill(false);
            for v in hubs.on_trace(x * ny + y).filter(|&v| hubs.weight[v] >= known) {
                told[around(hubs.z[v], reach, nz)].fill(true);
            }
            for ((tau, told), coherence) in tau.iter_mut().zip(&told).zip(coherence.on_trace(x, y)) {
                if !told && *coherence < COHERENT {
                    *tau = f32::NAN;
                }
                left += usize::from(tau.is_finite());
            }
        }
        left
    });
    lines.sum()
}

/// Correlation of traces along beds from which on time is known. Noise that patches happened to follow has less than
/// half of it; reflections with as much noise have about 0.5.
const COHERENT: f32 = 0.2;

/// The samples of a trace that are within `reach` of a fractional one.
fn around(z: f32, reach: usize, nz: usize) -> std::ops::Range<usize> {
    let at = z.round() as usize;
    at.saturating_sub(reach)..(at + reach + 1).min(nz)
}

/// Makes τ NaN on dead traces, at samples without data, farther than `reach` samples from every vertex of its trace and
/// of the traces beside it, and in parts that neither patches nor ties join to the largest.
pub(crate) fn hide_unknown(
    tau: &mut [f32],
    hubs: &Hubs,
    links: &Links,
    ties: &[Tie],
    volume: &Volume<f32>,
    reach: usize,
) {
    let [nx, ny, nz] = hubs.size;
    let mut joined = start::neighbours(hubs, links);
    joined.extend(start::tied(hubs, ties, None));
    let mut parts = start::parts(hubs.len(), &joined);
    let part: Vec<u32> = (0..hubs.len() as u32).map(|hub| parts.find(hub)).collect();
    let mut count = vec![0usize; hubs.len()];
    hubs.hub.iter().for_each(|&hub| count[part[hub as usize] as usize] += 1);
    let largest = (0..count.len()).max_by_key(|&n| (count[n], std::cmp::Reverse(n))).unwrap_or(0) as u32;
    let belongs = |v: usize| part[hubs.hub[v] as usize] == largest;
    tau.par_chunks_mut(ny * nz).enumerate().for_each(|(x, line)| {
        let mut near = vec![false; nz];
        for (y, tau) in line.chunks_mut(nz).enumerate() {
            near.fill(false);
            if volume.is_live(x, y) {
                for (x, y) in [(x, y), (x.wrapping_sub(1), y), (x + 1, y), (x, y.wrapping_sub(1)), (x, y + 1)] {
                    if x < nx && y < ny {
                        for v in hubs.on_trace(x * ny + y).filter(|&v| belongs(v)) {
                            near[around(hubs.z[v], reach, nz)].fill(true);
                        }
                    }
                }
            }
            for ((tau, near), sample) in tau.iter_mut().zip(&near).zip(volume.trace(x, y)) {
                *tau = if *near && sample.is_finite() { *tau } else { f32::NAN };
            }
        }
    });
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_bent_trace_goes_through_its_nodes_and_stays_monotone() {
        let mut tau: Vec<f32> = (0..40).map(|z| z as f32 + (z as f32 * 0.9).sin() * 0.9).collect();
        let nodes = [(8.4, 10.0), (10.5, 10.3), (21.0, 19.0), (30.75, 33.5)];
        bend(&mut tau, &nodes);
        for (z, time) in nodes {
            assert!((interpolate(&tau, z) - time).abs() < 1e-4, "{z}: {} for {time}", interpolate(&tau, z));
        }
        assert!(tau.windows(2).all(|pair| pair[0] <= pair[1]), "{tau:?}");
        // Far from its node a trace is what it was.
        let mut far: Vec<f32> = (0..80).map(|z| z as f32).collect();
        bend(&mut far, &[(10.0, 13.0)]);
        assert_eq!(far[60..], (60..80).map(|z| z as f32).collect::<Vec<_>>());
    }
}
