//! Gives extrema that belong to no surface yet to the surfaces beside them.
//!
//! What the cuts and the opening leave out is assigned along the minimum spanning forest of the links, in order of their evidence for a
//! break (ties by index), with every surface a root: two surfaces never join. A watershed on links, so a set again.

use super::links::{Links, NEXT_X, NEXT_Y, NONE};
use super::union_find::UnionFind;
use rayon::prelude::*;

/// Greatest evidence, in quarters, of a link that is followed.
const PASSABLE: u8 = 48;

/// Extends `labels` over links.
pub(super) fn flood(links: &Links, evidence: &[[u8; 2]], labels: &mut [u32]) {
    let mut edges: Vec<u64> = (0..labels.len())
        .into_par_iter()
        .with_min_len(1 << 14)
        .flat_map_iter(|v| {
            let labels = &*labels;
            [NEXT_X, NEXT_Y].into_iter().enumerate().filter_map(move |(axis, direction)| {
                let next = links.to[direction][v];
                let open = next != NONE
                    && evidence[v][axis] <= PASSABLE
                    && (labels[v] == NONE || labels[next as usize] == NONE);
                open.then(|| u64::from(evidence[v][axis]) << 40 | (v as u64) << 1 | axis as u64)
            })
        })
        .collect();
    edges.par_sort_unstable();
    let mut sets = UnionFind::new(labels.len());
    for edge in edges {
        let (v, axis) = (((edge & ((1 << 40) - 1)) >> 1) as u32, (edge & 1) as usize);
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
}
