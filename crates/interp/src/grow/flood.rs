//! Gives extrema that belong to no surface yet to the surfaces beside them.
//!
//! What the cuts and the opening leave out is assigned along the minimum spanning forest of the links, in order of their evidence for a
//! break (ties by index), with every surface a root: two surfaces never join. A watershed on links, so a set again.
//!
//! Where reflectors are chaotic, in salt or between many small faults, such a flood spirals from layer to layer. A surface that comes to lie over itself
//! keeps of what it was given only what is near it; the rest is for others, or for none.

use super::links::{Links, NEXT_X, NEXT_Y, NONE};
use super::union_find::UnionFind;
use crate::extrema::Extrema;
use survey::{Cancelled, Progress};

/// Greatest evidence, in quarters, of a link that is followed.
const PASSABLE: u8 = 48;

/// One trace of so many of a surface that it lies on twice, and it lies over itself.
const LAYERED: u32 = 20;

/// Links that a surface which lies over itself keeps of what it was given.
const OUTSKIRTS: usize = 10;

/// Links between two looks at whether the user cancelled.
const CHECK_EVERY: usize = 1 << 18;

/// Extends `labels` over links.
///
/// # Errors
/// [`Cancelled`] by the user.
pub(super) fn flood(
    extrema: &Extrema,
    links: &Links,
    evidence: &[[u8; 2]],
    labels: &mut [u32],
    progress: &Progress,
) -> Result<(), Cancelled> {
    let rooted: Vec<bool> = labels.iter().map(|&label| label != NONE).collect();
    let edges = edges(links, evidence, labels);
    let mut sets = UnionFind::new(labels.len());
    for (n, edge) in edges.into_iter().enumerate() {
        if n.is_multiple_of(CHECK_EVERY) {
            progress.check()?;
        }
        let (v, axis) = ((edge >> 1) as u32, (edge & 1) as usize);
        let next = links.to[[NEXT_X, NEXT_Y][axis]][v as usize];
        let (a, b) = (sets.find(v), sets.find(next));
        if a == b {
            continue;
        }
        let (of_a, of_b) = (labels[a as usize], labels[b as usize]);
        if of_a == NONE || of_b == NONE {
            let root = sets.union(a, b);
            labels[root as usize] = of_a.min(of_b);
        }
    }
    for v in 0..labels.len() as u32 {
        if labels[v as usize] == NONE {
            labels[v as usize] = labels[sets.find(v) as usize];
        }
    }
    progress.check()?;
    let layered = layered(extrema, labels);
    if layered.contains(&true) {
        let near = near(links, evidence, rooted);
        for (label, near) in labels.iter_mut().zip(near) {
            if !near && *label != NONE && layered[*label as usize] {
                *label = NONE;
            }
        }
    }
    progress.check()
}

/// Which labels lie over themselves.
fn layered(extrema: &Extrema, labels: &[u32]) -> Vec<bool> {
    let mut counts = vec![[0u32; 2]; labels.len()];
    let [nx, ny, _] = extrema.size;
    let mut here: Vec<u32> = Vec::new();
    for (x, y) in (0..nx).flat_map(|x| (0..ny).map(move |y| (x, y))) {
        here.clear();
        here.extend(labels[extrema.on_trace(x, y)].iter().filter(|&&label| label != NONE));
        here.sort_unstable();
        for (n, &label) in here.iter().enumerate() {
            counts[label as usize][usize::from(n > 0 && here[n - 1] == label)] += 1;
        }
    }
    counts.into_iter().map(|[traces, twice]| twice * LAYERED > traces).collect()
}

/// Which extrema are at most [`OUTSKIRTS`] passable links from one that is `near` to begin with.
fn near(links: &Links, evidence: &[[u8; 2]], mut near: Vec<bool>) -> Vec<bool> {
    let mut front: Vec<u32> = (0..near.len() as u32).filter(|&v| near[v as usize]).collect();
    for _ in 0..OUTSKIRTS {
        let mut next_front = Vec::new();
        for &v in &front {
            for axis in 0..2 {
                let (next, back) = (links.to[2 * axis][v as usize], links.to[2 * axis + 1][v as usize]);
                for (from, to) in [(v, next), (back, back)] {
                    if to != NONE && !near[to as usize] && evidence[from as usize][axis] <= PASSABLE {
                        near[to as usize] = true;
                        next_front.push(to);
                    }
                }
            }
        }
        front = next_front;
    }
    near
}

/// The links that may be followed to an extremum without a surface, by evidence, each as `v << 1 | axis`.
fn edges(links: &Links, evidence: &[[u8; 2]], labels: &[u32]) -> Vec<u64> {
    // They are met in the order of the extrema, so it is enough to count.
    let mut starts = [0usize; PASSABLE as usize + 2];
    each_edge(links, evidence, labels, |evidence, _| starts[evidence as usize + 1] += 1);
    for n in 1..starts.len() {
        starts[n] += starts[n - 1];
    }
    let mut edges = vec![0u64; starts[starts.len() - 1]];
    each_edge(links, evidence, labels, |evidence, edge| {
        let at = &mut starts[evidence as usize];
        edges[*at] = edge;
        *at += 1;
    });
    edges
}

/// Calls `found(evidence, edge)` for each of those links, in the order of the extrema.
#[inline]
fn each_edge(links: &Links, evidence: &[[u8; 2]], labels: &[u32], mut found: impl FnMut(u8, u64)) {
    for v in 0..labels.len() {
        for (axis, direction) in [NEXT_X, NEXT_Y].into_iter().enumerate() {
            let (next, evidence) = (links.to[direction][v], evidence[v][axis]);
            if next != NONE && evidence <= PASSABLE && (labels[v] == NONE || labels[next as usize] == NONE) {
                found(evidence, (v as u64) << 1 | axis as u64);
            }
        }
    }
}
