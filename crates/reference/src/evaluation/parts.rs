//! The parts of a true horizon that are connected without a jump.
//!
//! A node is the horizon on one trace in one fault block. Nodes of neighbouring traces (sharing an edge of
//! the lattice) are connected in one block, and across the boundary of two blocks where the fault between
//! them is only the extension of a fault beyond its tip. Erosion, faults and the outer boundary separate
//! parts.

use glam::DVec3;
use interp::UnionFind;
use rayon::prelude::*;
use serde::Serialize;
use std::collections::VecDeque;
use synth::SynthTruth;

/// A connected part of a true horizon.
#[derive(Debug, Clone, Default, PartialEq, Serialize)]
pub struct HorizonPart {
    /// Fault blocks in which it lies.
    pub blocks: Vec<u16>,
    /// Count of its nodes: traces, counted once per block.
    pub nodes: usize,
    /// Count of nodes with a vertex within the tolerance.
    pub covered: usize,
}

impl HorizonPart {
    /// Share of its nodes that are covered.
    pub fn coverage(&self) -> f64 {
        super::share(self.covered, self.nodes)
    }
}

/// The part of each node of a true horizon.
#[derive(Debug, Clone, PartialEq)]
pub struct Parts {
    traces: usize,
    /// HorizonPart of node block·traces + trace; `NONE` where the horizon does not exist.
    part: Vec<u32>,
    blocks: Vec<Vec<u16>>,
}

/// No node.
const NONE: u32 = u32::MAX;

impl Parts {
    /// Finds the parts of horizon `horizon` (index into [`SynthTruth::horizons`]).
    pub fn of(truth: &SynthTruth, horizon: usize) -> Self {
        let [nx, ny, _] = truth.size;
        let (traces, blocks) = (nx * ny, truth.block_count());
        let exists: Vec<bool> = (0..blocks * traces)
            .into_par_iter()
            .map(|node| {
                let (block, trace) = (node / traces, node % traces);
                truth.exists(horizon, block as u16, (trace / ny) as f64, (trace % ny) as f64)
            })
            .collect();
        let mut sets = UnionFind::new(blocks * traces);
        let open = |fault: usize, y: usize| !truth.fault_is_real(fault, DVec3::new(0.0, y as f64, 0.0));
        for (node, _) in exists.iter().enumerate().filter(|(_, exists)| **exists) {
            let (block, trace) = (node / traces, node % traces);
            let (x, y) = (trace / ny, trace % ny);
            let neighbours = [(x + 1 < nx).then(|| (trace + ny, y)), (y + 1 < ny).then(|| (trace + 1, y + 1))];
            for (next, next_y) in neighbours.into_iter().flatten() {
                // Blocks b and b + 1 are on the two sides of fault b.
                let above = (block + 1 < blocks && open(block, y) && open(block, next_y)).then_some(block + 1);
                let below = (block > 0 && open(block - 1, y) && open(block - 1, next_y)).then(|| block - 1);
                for other in [Some(block), above, below].into_iter().flatten() {
                    if exists[other * traces + next] {
                        sets.union(node as u32, (other * traces + next) as u32);
                    }
                }
            }
        }
        let mut part = vec![NONE; exists.len()];
        let mut found: Vec<Vec<u16>> = Vec::new();
        for node in 0..exists.len() {
            if !exists[node] {
                continue;
            }
            let root = sets.find(node as u32) as usize;
            if part[root] == NONE {
                part[root] = found.len() as u32;
                found.push(Vec::new());
            }
            part[node] = part[root];
            let blocks = &mut found[part[node] as usize];
            let block = (node / traces) as u16;
            if blocks.last() != Some(&block) {
                blocks.push(block);
            }
        }
        Self { traces, part, blocks: found }
    }

    /// The parts without the nodes for which `is_taken(inline index, crossline index, sample index)` is true.
    pub fn without(
        &self,
        truth: &SynthTruth,
        horizon: usize,
        is_taken: impl Fn(usize, usize, f64) -> bool + Sync,
    ) -> Self {
        let ny = truth.size[1];
        let left = self.part.par_iter().enumerate().map(|(node, &part)| {
            let (x, y) = (node % self.traces / ny, node % ny);
            let z = || truth.sheet_z(horizon, (node / self.traces) as u16, x as f64, y as f64);
            if part == NONE || is_taken(x, y, z()) { NONE } else { part }
        });
        Self { part: left.collect(), ..self.clone() }
    }

    /// A point in the middle of each part of at least `fewest` nodes, voxels: where someone who sees the
    /// horizon would pick it.
    pub fn middles(&self, truth: &SynthTruth, horizon: usize, fewest: usize) -> Vec<DVec3> {
        let [nx, ny, _] = truth.size;
        let neighbours = |node: usize| {
            let (x, y) = (node % self.traces / ny, node % ny);
            [
                (x > 0).then(|| node - ny),
                (x + 1 < nx).then(|| node + ny),
                (y > 0).then(|| node - 1),
                (y + 1 < ny).then(|| node + 1),
            ]
        };
        // A flood from the rim inwards; the node of a part that is reached last is its middle.
        let mut left: Vec<bool> = self.part.iter().map(|&part| part != NONE).collect();
        let on_rim = |node: usize| neighbours(node).iter().any(|next| next.is_none_or(|next| self.part[next] == NONE));
        let mut queue: VecDeque<usize> = (0..left.len()).filter(|&node| left[node] && on_rim(node)).collect();
        queue.iter().for_each(|&node| left[node] = false);
        let mut found = vec![(0usize, 0usize); self.blocks.len()];
        while let Some(node) = queue.pop_front() {
            let part = &mut found[self.part[node] as usize];
            *part = (part.0 + 1, node);
            for next in neighbours(node).into_iter().flatten() {
                if std::mem::replace(&mut left[next], false) {
                    queue.push_back(next);
                }
            }
        }
        let place = |node: usize| {
            let (x, y) = ((node % self.traces / ny) as f64, (node % ny) as f64);
            DVec3::new(x, y, truth.sheet_z(horizon, (node / self.traces) as u16, x, y))
        };
        found.into_iter().filter(|(nodes, _)| *nodes >= fewest).map(|(_, node)| place(node)).collect()
    }

    /// All parts, with all counts at 0.
    pub fn empty(&self) -> Vec<HorizonPart> {
        self.blocks.iter().map(|blocks| HorizonPart { blocks: blocks.clone(), ..HorizonPart::default() }).collect()
    }

    /// The part of the node on `trace` (x·crosslines + y) in `block`; `None` where the horizon does not
    /// exist.
    pub fn at(&self, trace: usize, block: u16) -> Option<usize> {
        let part = self.part[usize::from(block) * self.traces + trace];
        (part != NONE).then_some(part as usize)
    }
}
