//! Assigns extrema without a surface to the surfaces next to them.
//!
//! What the cuts and the opening leave out is assigned along the minimum spanning forest of the links, in
//! order of their evidence for a break (ties by index). Every surface is a root, so two surfaces never join.
//! This is a watershed on links, and its result is again independent of any order of visits.
//!
//! Where reflectors are chaotic, in salt or between many small faults, such a flood spirals from layer to
//! layer. A surface that comes to lie over itself keeps only those of the assigned extrema that are near it;
//! the others go to other surfaces or to none.

use super::links::{Links, NEXT_X, NEXT_Y, NONE};
use super::union_find::UnionFind;
use crate::extrema::Extrema;
use survey::{Cancelled, Progress};

/// Greatest evidence, in quarters, of a link that is followed.
pub(crate) const PASSABLE: u8 = 48;

/// A surface lies over itself if it lies twice on more than one in this many of its traces.
pub(crate) const LAYERED: u32 = 20;

/// Distance in links within which a surface that lies over itself keeps assigned extrema.
pub(crate) const OUTSKIRTS: usize = 10;

/// Links between two checks for cancellation.
const CHECK_EVERY: usize = 1 << 18;

/// Extends `labels` along links.
///
/// # Errors
/// [`Cancelled`] by the user.
pub(crate) fn flood(
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
    let layers = Layers::count(extrema, labels);
    if layers.any {
        let near = near(links, evidence, &rooted);
        for (label, near) in labels.iter_mut().zip(near) {
            if !near && *label != NONE && layers.over_itself(*label) {
                *label = NONE;
            }
        }
    }
    progress.check()
}

/// How often each label lies on its traces.
struct Layers {
    /// For each label: its last trace (counted from 1), its count of traces, and how often it lies on a trace
    /// again.
    counts: Vec<[u32; 3]>,
    /// Whether some label lies over itself.
    any: bool,
}

impl Layers {
    fn count(extrema: &Extrema, labels: &[u32]) -> Self {
        let mut layers = Self { counts: vec![[0; 3]; labels.len()], any: false };
        let [nx, ny, _] = extrema.size;
        let mut met: Vec<u32> = Vec::new();
        for (x, y) in (0..nx).flat_map(|x| (0..ny).map(move |y| (x, y))) {
            let trace = (x * ny + y) as u32 + 1;
            for &label in labels[extrema.on_trace(x, y)].iter().filter(|&&label| label != NONE) {
                let [last, traces, again] = &mut layers.counts[label as usize];
                if *last == trace {
                    *again += 1;
                } else {
                    if *last == 0 {
                        met.push(label);
                    }
                    (*last, *traces) = (trace, *traces + 1);
                }
            }
        }
        layers.any = met.into_iter().any(|label| layers.over_itself(label));
        layers
    }

    /// Whether a label lies again on too many of its traces.
    fn over_itself(&self, label: u32) -> bool {
        let [_, traces, again] = self.counts[label as usize];
        again * LAYERED > traces
    }
}

/// Which extrema are at most [`OUTSKIRTS`] passable links away from one of `rooted`.
pub(crate) fn near(links: &Links, evidence: &[[u8; 2]], rooted: &[bool]) -> Vec<bool> {
    // Calls `found` for each extremum that a passable link joins to `v`; links lead both ways.
    let around = |v: u32, found: &mut dyn FnMut(u32)| {
        for (axis, to) in links.to.as_chunks::<2>().0.iter().enumerate() {
            let [next, back] = [to[0][v as usize], to[1][v as usize]];
            for (from, to) in [(v, next), (back, back)] {
                if to != NONE && evidence[from as usize][axis] <= PASSABLE {
                    found(to);
                }
            }
        }
    };
    // The first step starts at the extrema without a root, which are fewer than those with one.
    let mut near = rooted.to_vec();
    let mut front = Vec::new();
    for v in (0..rooted.len() as u32).filter(|&v| !rooted[v as usize]) {
        around(v, &mut |to| near[v as usize] |= rooted[to as usize]);
        if near[v as usize] {
            front.push(v);
        }
    }
    for _ in 1..OUTSKIRTS {
        let mut next_front = Vec::new();
        for &v in &front {
            around(v, &mut |to| {
                if !near[to as usize] {
                    near[to as usize] = true;
                    next_front.push(to);
                }
            });
        }
        front = next_front;
    }
    near
}

/// The passable links to an extremum without a surface, in order of their evidence, each as `v << 1 | axis`.
fn edges(links: &Links, evidence: &[[u8; 2]], labels: &[u32]) -> Vec<u64> {
    // They are visited in the order of the extrema, so a counting sort suffices.
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

/// Calls `found(evidence, edge)` for each passable link to an extremum without a surface, in the order of the
/// extrema.
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
