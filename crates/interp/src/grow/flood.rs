//! Gives extrema that belong to no surface yet to the surfaces beside them.
//!
//! What the cuts and the opening leave out is assigned along the minimum spanning forest of the links, in order of their evidence for a
//! break (ties by index), with every surface a root: two surfaces never join. A watershed on links, so a set again.

use super::links::{Links, NEXT_X, NEXT_Y, NONE};
use super::union_find::UnionFind;
use survey::{Cancelled, Progress};

/// Greatest evidence, in quarters, of a link that is followed.
const PASSABLE: u8 = 48;

/// Links between two looks at whether the user cancelled.
const CHECK_EVERY: usize = 1 << 18;

/// Extends `labels` over links.
///
/// # Errors
/// [`Cancelled`] by the user.
pub(super) fn flood(
    links: &Links,
    evidence: &[[u8; 2]],
    labels: &mut [u32],
    progress: &Progress,
) -> Result<(), Cancelled> {
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
    progress.check()
}

/// The links that may be followed to an extremum without a surface, by evidence, each as `v << 1 | axis`.
fn edges(links: &Links, evidence: &[[u8; 2]], labels: &[u32]) -> Vec<u64> {
    let visit = |found: &mut dyn FnMut(u8, u64)| {
        for v in 0..labels.len() {
            for (axis, direction) in [NEXT_X, NEXT_Y].into_iter().enumerate() {
                let (next, evidence) = (links.to[direction][v], evidence[v][axis]);
                if next != NONE && evidence <= PASSABLE && (labels[v] == NONE || labels[next as usize] == NONE) {
                    found(evidence, (v as u64) << 1 | axis as u64);
                }
            }
        }
    };
    // They are met in the order of the extrema, so it is enough to count.
    let mut starts = [0usize; PASSABLE as usize + 2];
    visit(&mut |evidence, _| starts[evidence as usize + 1] += 1);
    for n in 1..starts.len() {
        starts[n] += starts[n - 1];
    }
    let mut edges = vec![0u64; starts[starts.len() - 1]];
    visit(&mut |evidence, edge| {
        let at = &mut starts[evidence as usize];
        edges[*at] = edge;
        *at += 1;
    });
    edges
}
