//! Where the minimisation starts: times of the hubs alone, then straight lines between them along every trace.
//!
//! Two hubs k, l that follow one another on n traces, on average d samples apart, should differ by d:
//! `Σ n (c_l − c_k − d)²` is least, over thousands of unknowns instead of millions. Where thickness varies this is
//! off by a part of the variation, which the dips then mend.

use crate::hubs::Hubs;
use crate::links::{Links, THROUGH};
use crate::solve::Tie;
use interp::UnionFind;
use rayon::prelude::*;
use survey::{Cancelled, Progress};

/// Two hubs that follow one another on some traces, or that are beside two points of one time.
#[derive(Debug, Clone, Copy)]
pub(crate) struct HubNeighbours {
    /// The upper and the lower hub.
    pub hubs: [u32; 2],
    /// Count of traces, or weight.
    count: f32,
    /// Mean distance down, samples.
    distance: f32,
}

/// What lies between a vertex and the next of its trace.
#[derive(Clone, Copy, PartialEq)]
enum Gap {
    /// A fault, or there is none.
    Nothing,
    /// Beds.
    Beds,
    /// An unconformity.
    Jump,
}

/// The pairs of hubs that follow one another on a trace without a fault between them, ascending.
pub(crate) fn neighbours(hubs: &Hubs, links: &Links) -> Vec<HubNeighbours> {
    let [_, ny, nz] = hubs.size;
    let mut below = vec![Gap::Nothing; hubs.z.len()];
    hubs.split_inlines(&mut below).into_par_iter().enumerate().for_each(|(x, below)| {
        let first = hubs.on_inline(x).start;
        for trace in x * ny..(x + 1) * ny {
            let own = hubs.on_trace(trace);
            for (v, w) in own.clone().zip(own.skip(1)).filter(|&(v, w)| hubs.hub[v] != hubs.hub[w]) {
                let mut between = hubs.z[v] as usize..(hubs.z[w].ceil() as usize).min(nz - 1);
                if !between.clone().any(|z| links.is_cut_below(trace * nz + z)) {
                    let jumps = between.any(|z| links.is_broken_below(trace * nz + z));
                    below[v - first] = if jumps { Gap::Jump } else { Gap::Beds };
                }
            }
        }
    });
    let of_hub = |hub: usize| {
        let own = hubs.of_hub(hub).iter().map(|&v| v as usize).filter(|&v| below[v] != Gap::Nothing);
        let mut found: Vec<(u32, f32, bool)> =
            own.map(|v| (hubs.hub[v + 1], hubs.z[v + 1] - hubs.z[v], below[v] == Gap::Jump)).collect();
        // Stable: sums have the order of the traces.
        found.sort_by_key(|(next, _, _)| *next);
        let pair = |same: &[(u32, f32, bool)]| {
            let sum: f64 = same.iter().map(|(_, distance, _)| f64::from(*distance)).sum();
            // Through an unconformity distances tell next to nothing.
            let through = same.iter().filter(|(_, _, jumps)| *jumps).count();
            let count = (same.len() - through) as f32 + THROUGH * through as f32;
            HubNeighbours { hubs: [hub as u32, same[0].0], count, distance: (sum / same.len() as f64) as f32 }
        };
        found.chunk_by(|a, b| a.0 == b.0).map(pair).collect::<Vec<_>>()
    };
    (0..hubs.len()).into_par_iter().flat_map_iter(of_hub).collect()
}

/// The same for the hubs beside the two ends of ties.
///
/// The distance is that of two points of one time; with the times of the vertices, it is what their times lack.
pub(crate) fn tied(hubs: &Hubs, ties: &[Tie], times: Option<&[f32]>) -> Vec<HubNeighbours> {
    let nearest = |trace: u32, z: f32| {
        let own = hubs.on_trace(trace as usize);
        own.min_by(|&v, &w| (hubs.z[v] - z).abs().total_cmp(&(hubs.z[w] - z).abs()))
            .filter(|&v| (hubs.z[v] - z).abs() < TIED_REACH)
    };
    let pair = |tie: &Tie| {
        let (v, w) = (nearest(tie.trace[0], tie.z[0])?, nearest(tie.trace[1], tie.z[1])?);
        let between = (tie.z[0] - hubs.z[v]) - (tie.z[1] - hubs.z[w]);
        let distance = between - times.map_or(0.0, |times| times[w] - times[v]);
        (hubs.hub[v] != hubs.hub[w]).then(|| HubNeighbours {
            hubs: [hubs.hub[v], hubs.hub[w]],
            count: tie.weight,
            distance,
        })
    };
    ties.iter().filter_map(pair).collect()
}

/// Distance of a hub from the end of a tie up to which the tie holds for it, samples.
const TIED_REACH: f32 = 8.0;

/// The smallest hub of the connected part to which each hub belongs.
pub(crate) fn parts(count: usize, neighbours: &[HubNeighbours]) -> UnionFind {
    let mut sets = UnionFind::new(count);
    for pair in neighbours {
        sets.union(pair.hubs[0], pair.hubs[1]);
    }
    sets
}

/// Most steps of the small minimisation.
const MOST_STEPS: usize = 2000;

/// The times of all hubs that fit the distances of neighbours best. Hubs that no neighbour joins have no common zero.
pub(crate) fn hub_times(count: usize, neighbours: &[HubNeighbours]) -> Vec<f64> {
    let mut diagonal = vec![1e-9f64; count];
    let mut residual = vec![0.0f64; count];
    for &HubNeighbours { hubs: [a, b], count, distance } in neighbours {
        let (a, b, n) = (a as usize, b as usize, f64::from(count));
        diagonal[a] += n;
        diagonal[b] += n;
        residual[a] -= n * f64::from(distance);
        residual[b] += n * f64::from(distance);
    }
    let size = |r: &[f64]| r.iter().zip(&diagonal).map(|(r, d)| r * r / d).sum::<f64>();
    let mut times = vec![0.0f64; count];
    let mut direction: Vec<f64> = residual.iter().zip(&diagonal).map(|(r, d)| r / d).collect();
    let mut now = size(&residual);
    let enough = 1e-10 * now;
    for _ in 0..MOST_STEPS {
        if now <= enough {
            break;
        }
        let mut image = vec![0.0f64; count];
        for &HubNeighbours { hubs: [a, b], count, .. } in neighbours {
            let (a, b) = (a as usize, b as usize);
            let e = f64::from(count) * (direction[b] - direction[a]);
            image[a] -= e;
            image[b] += e;
        }
        let along: f64 = direction.iter().zip(&image).map(|(d, i)| d * i).sum();
        if along <= 0.0 {
            break;
        }
        let step = now / along;
        times.iter_mut().zip(&direction).for_each(|(t, d)| *t += step * d);
        residual.iter_mut().zip(&image).for_each(|(r, i)| *r -= step * i);
        let next = size(&residual);
        let keep = next / now;
        direction.iter_mut().zip(residual.iter().zip(&diagonal)).for_each(|(p, (r, d))| *p = r / d + keep * *p);
        now = next;
    }
    times
}

/// The correction of the times of hubs that ties ask for: neighbours keep their distances as well as they can.
pub(crate) fn corrections(count: usize, neighbours: &[HubNeighbours], tied: &[HubNeighbours]) -> Vec<f64> {
    let mut all: Vec<HubNeighbours> =
        neighbours.iter().map(|pair| HubNeighbours { count: STIFFNESS * pair.count, distance: 0.0, ..*pair }).collect();
    all.extend(tied);
    hub_times(count, &all)
}

/// Weight of the distance of neighbouring hubs on one trace in a correction; a tie has 1.
const STIFFNESS: f32 = 0.05;

/// Adds to every voxel what `value` says at the vertices: linear between the vertices of a trace, constant beyond them,
/// not across faults.
///
/// # Errors
/// [`Cancelled`].
pub(crate) fn add_between(
    hubs: &Hubs,
    links: &Links,
    value: impl Fn(usize) -> f32 + Sync,
    s: &mut [f32],
    progress: &Progress,
) -> Result<(), Cancelled> {
    let [_, ny, nz] = hubs.size;
    s.par_chunks_mut(ny * nz).enumerate().try_for_each(|(x, line)| {
        progress.check()?;
        for (y, s) in line.chunks_mut(nz).enumerate() {
            let trace = x * ny + y;
            let mut from = 0;
            for z in 0..nz {
                if z + 1 == nz || links.is_cut_below(trace * nz + z) {
                    let inside = |v: &usize| hubs.z[*v] >= from as f32 - 0.5 && hubs.z[*v] < z as f32 + 0.5;
                    let known: Vec<(f32, f32)> =
                        hubs.on_trace(trace).filter(inside).map(|v| (hubs.z[v], value(v))).collect();
                    fill(&known, from, &mut s[from..=z]);
                    from = z + 1;
                }
            }
        }
        Ok(())
    })
}

/// Adds to a part of a trace that begins at sample `from`.
fn fill(known: &[(f32, f32)], from: usize, s: &mut [f32]) {
    let mut below = 0;
    for (n, s) in s.iter_mut().enumerate() {
        let z = (from + n) as f32;
        while below < known.len() && known[below].0 < z {
            below += 1;
        }
        *s += match (below.checked_sub(1).map(|n| known[n]), known.get(below).copied()) {
            (Some((za, a)), Some((zb, b))) => a + (z - za) / (zb - za).max(1e-3) * (b - a),
            (Some((_, only)), None) | (None, Some((_, only))) => only,
            (None, None) => 0.0,
        };
    }
}
