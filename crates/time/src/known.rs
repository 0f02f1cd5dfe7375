//! The last steps: τ is made monotone on every trace, and hidden where it is not known.

use crate::hubs::Hubs;
use crate::isotonic::{Pools, regress};
use crate::links::Links;
use crate::solve::Tie;
use crate::start;
use rayon::prelude::*;
use survey::Volume;

/// Weight of a voxel without a vertex in the regression.
const PLAIN_WEIGHT: f32 = 0.1;

/// Turns s into τ, made monotone on every trace between faults; returns how many voxels changed.
pub fn make_monotone(s: &mut [f32], hubs: &Hubs, links: &Links) -> usize {
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

/// Makes τ NaN on dead traces, farther than `reach` samples from every vertex of its trace and of the traces beside it,
/// and in parts that neither patches nor ties join to the largest; returns how many voxels are left.
pub fn hide_unknown(
    tau: &mut [f32],
    hubs: &Hubs,
    links: &Links,
    ties: &[Tie],
    volume: &Volume<f32>,
    reach: usize,
) -> usize {
    let [nx, ny, nz] = hubs.size;
    let mut joined = start::neighbours(hubs, links);
    joined.extend(start::tied(hubs, ties, None));
    let mut parts = start::parts(hubs.len(), &joined);
    let part: Vec<u32> = (0..hubs.len() as u32).map(|hub| parts.find(hub)).collect();
    let mut count = vec![0usize; hubs.len()];
    hubs.hub.iter().for_each(|&hub| count[part[hub as usize] as usize] += 1);
    let largest = (0..count.len()).max_by_key(|&n| (count[n], std::cmp::Reverse(n))).unwrap_or(0) as u32;
    let belongs = |v: usize| part[hubs.hub[v] as usize] == largest;
    tau.par_chunks_mut(ny * nz)
        .enumerate()
        .map(|(x, line)| {
            let (mut near, mut left) = (vec![false; nz], 0);
            for (y, tau) in line.chunks_mut(nz).enumerate() {
                near.fill(false);
                if volume.is_live(x, y) {
                    for (x, y) in [(x, y), (x.wrapping_sub(1), y), (x + 1, y), (x, y.wrapping_sub(1)), (x, y + 1)] {
                        if x < nx && y < ny {
                            for v in hubs.on_trace(x * ny + y).filter(|&v| belongs(v)) {
                                let at = hubs.z[v].round() as usize;
                                near[at.saturating_sub(reach)..(at + reach + 1).min(nz)].fill(true);
                            }
                        }
                    }
                }
                for (tau, near) in tau.iter_mut().zip(&near) {
                    *tau = if *near { *tau } else { f32::NAN };
                    left += usize::from(*near);
                }
            }
            left
        })
        .sum()
}
