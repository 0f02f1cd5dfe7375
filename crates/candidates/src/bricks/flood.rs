//! Stages that give extrema without a surface to surfaces next to them: `basins`, `divides`, `flooded`, `layers`,
//! `trimmed` ([`crate::grow::flood`]), once for cores and once for all.
//!
//! The flood is a minimum spanning forest of links, in the order of (evidence, index, axis), whose roots are the
//! surfaces. A spanning forest is decided piece by piece: no link that is the greatest of a circle within a brick is
//! part of it. So a brick finds its own forest and hands on only what a path through the brick can depend on: the tree
//! between extrema with links across a face (*gates*), whose branches without a gate are cut off and whose chains are
//! one link each, with the greatest place of the chain. The merged trees and the links across faces have the same
//! forest as the whole survey. It tells which of a brick's links are no part of it, and the label of each gate.

use super::Bricks;
use super::patch::{Patch, Values};
use super::tiles::Halo;
use crate::error::InterpError;
use crate::grow::UnionFind;
use crate::grow::flood::{LAYERED, OUTSKIRTS, PASSABLE, near};
use crate::grow::links::{NEXT_X, NEXT_Y, NONE};
use bytemuck::{Pod, Zeroable};
use rayon::prelude::*;
use std::collections::{BTreeMap, HashMap};

/// Which of the two floods.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Flood {
    /// From the cores of surfaces.
    Cores,
    /// From everything that has a surface by then.
    All,
}

impl Flood {
    fn prefix(self) -> &'static str {
        match self {
            Self::Cores => "cores",
            Self::All => "all",
        }
    }
}

/// Stands in front of a label where otherwise the index of an extremum is.
const LABEL: u64 = 1 << 32;

/// The place of a link in the order of the flood.
type Key = u64;

fn key_of(evidence: u8, index: u32, axis: usize) -> Key {
    u64::from(evidence) << 40 | u64::from(index) << 1 | axis as u64
}

fn axis_of(key: Key) -> usize {
    (key & 1) as usize
}

fn index_of(key: Key) -> u32 {
    (key >> 1) as u32
}

/// A link, or a chain of links, between two ends: indices of extrema, or labels.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Pod, Zeroable)]
#[repr(C)]
struct Branch {
    key: Key,
    ends: [u64; 2],
}

/// The forest of a brick's own links, and what lies across its faces.
struct Basin {
    patch: Patch,
    /// Labels before the flood.
    labels: Vec<u32>,
    indices: Vec<u32>,
    /// Links of the forest between places, in their order; a labelled end stands for its label.
    forest: Vec<(Key, [u32; 2])>,
    /// Links across faces to the next bricks.
    across: Vec<Branch>,
    /// Places of extrema without a surface that have a link across a face.
    gates: Vec<u32>,
}

impl Bricks<'_> {
    fn name_of(&self, flood: Flood, array: &str, kind: usize) -> String {
        self.name(&format!("{}-{array}", flood.prefix()), kind)
    }

    /// Labels before a flood.
    fn rooted(&self, flood: Flood, patch: &Patch) -> Result<Vec<u32>, InterpError> {
        match flood {
            Flood::Cores => self.unflooded("core", patch),
            Flood::All if self.has_cores() => self.values("rooted", patch),
            Flood::All => self.unflooded("narrow", patch),
        }
    }

    /// The forest of a brick.
    fn basin(&self, flood: Flood, kind: usize, brick: usize, halo: Halo) -> Result<Basin, InterpError> {
        let patch = self.patch(kind, brick, halo, Values::None)?;
        let links = self.links_on(&patch)?;
        let evidence: Vec<[u8; 2]> = self.values("evidence", &patch)?;
        let labels = self.rooted(flood, &patch)?;
        let (indices, own) = (patch.indices(), patch.is_own());
        let end = |v: u32| match labels[v as usize] {
            NONE => u64::from(indices[v as usize]),
            label => LABEL | u64::from(label),
        };
        // By evidence; those of the same evidence are met in their order.
        let (mut inside, mut across) = (vec![Vec::new(); usize::from(PASSABLE) + 1], Vec::new());
        let mut is_gate = vec![false; labels.len()];
        for v in 0..labels.len() as u32 {
            for (axis, direction) in [NEXT_X, NEXT_Y].into_iter().enumerate() {
                let (next, evidence) = (links.to[direction][v as usize], evidence[v as usize][axis]);
                if next == NONE || evidence > PASSABLE {
                    continue;
                }
                let open = [v, next].map(|end| labels[end as usize] == NONE);
                let owned = [v, next].map(|end| own[end as usize]);
                if open == [false; 2] || owned == [false; 2] {
                    continue;
                }
                let key = key_of(evidence, indices[v as usize], axis);
                if owned == [true; 2] {
                    inside[usize::from(evidence)].push((key, [v, next]));
                    continue;
                }
                for (end, _) in
                    [v, next].into_iter().zip(open.into_iter().zip(owned)).filter(|(_, is)| *is == (true, true))
                {
                    is_gate[end as usize] = true;
                }
                if owned[0] {
                    across.push(Branch { key, ends: [end(v), end(next)] });
                }
            }
        }
        let forest = spanning(&labels, inside.into_iter().flatten());
        let gates = (0..labels.len() as u32).filter(|&v| is_gate[v as usize]).collect();
        Ok(Basin { patch, labels, indices, forest, across, gates })
    }

    /// What paths through a brick depend on.
    pub(crate) fn basins(&self, flood: Flood, brick: usize) -> Result<(), InterpError> {
        for kind in 0..self.kinds.len() {
            let basin = self.basin(flood, kind, brick, Halo::around(1))?;
            let mut branches = basin.branches();
            branches.extend(&basin.across);
            let gates: Vec<u32> = basin.gates.iter().map(|&v| basin.indices[v as usize]).collect();
            let mut forest = vec![0u8; basin.labels.len()];
            basin.forest.iter().for_each(|&(key, [v, _])| forest[v as usize] |= 1 << axis_of(key));
            self.keep(&format!("{}-forest", flood.prefix()), &basin.patch, &forest)?;
            self.write(&self.name_of(flood, "branches", kind), brick, &branches)?;
            self.write(&self.name_of(flood, "gates", kind), brick, &gates)?;
        }
        Ok(())
    }

    /// Finds the forest of all branches. For each brick: the keys of its links that are no part of it, and the label of
    /// each of its gates.
    pub(crate) fn divides(&self, flood: Flood) -> Result<(), InterpError> {
        self.each_kind(|kind| {
            let (branches_name, gates_name) =
                (self.name_of(flood, "branches", kind), self.name_of(flood, "gates", kind));
            let mut all: Vec<(Branch, u32)> = Vec::new();
            for brick in 0..self.tiles.count() {
                all.extend(self.read::<Branch>(&branches_name, brick)?.into_iter().map(|b| (b, brick as u32)));
            }
            all.par_sort_unstable();
            let mut ends: Vec<u64> = all.iter().flat_map(|(branch, _)| branch.ends).collect();
            ends.par_sort_unstable();
            ends.dedup();
            let place = |end: u64| ends.binary_search(&end).map(|at| at as u32).unwrap_or(NONE);
            let mut label: Vec<u32> =
                ends.iter().map(|&end| if end & LABEL == 0 { NONE } else { end as u32 }).collect();
            let mut sets = UnionFind::new(ends.len());
            let mut outside: Vec<Vec<Key>> = vec![Vec::new(); self.tiles.count()];
            for (Branch { key, ends }, brick) in all {
                let [a, b] = ends.map(|end| sets.find(place(end)));
                let labels = [a, b].map(|set| label[set as usize]);
                if a == b || !labels.contains(&NONE) {
                    outside[brick as usize].push(key);
                } else {
                    let root = sets.union(a, b);
                    label[root as usize] = labels[0].min(labels[1]);
                }
            }
            for (brick, keys) in outside.into_iter().enumerate() {
                let gates: Vec<u32> = self.read(&gates_name, brick)?;
                let of_gate = |index: u32| match place(u64::from(index)) {
                    NONE => NONE,
                    at => label[sets.find(at) as usize],
                };
                let labels: Vec<u32> = gates.into_iter().map(of_gate).collect();
                self.write(&self.name_of(flood, "outside", kind), brick, &keys)?;
                self.write(&self.name_of(flood, "gate-labels", kind), brick, &labels)?;
            }
            Ok(())
        })
    }

    /// Labels of a brick's own extrema after a flood: of the gate or the surface that their part of the forest leads to.
    fn filled(&self, flood: Flood, patch: &Patch) -> Result<Vec<u32>, InterpError> {
        let of = |array: &str| self.name_of(flood, array, patch.kind);
        let mut labels = self.rooted(flood, patch)?;
        let mut forest: Vec<u8> = self.values(&format!("{}-forest", flood.prefix()), patch)?;
        let indices = patch.indices();
        let place = |index: u32| indices.binary_search(&index).ok();
        for key in self.read::<Key>(&of("outside"), patch.brick)? {
            if let Some(v) = place(index_of(key)) {
                forest[v] &= !(1 << axis_of(key));
            }
        }
        let links = self.links_on(patch)?;
        let (mut sets, mut found) = (UnionFind::new(labels.len()), labels.clone());
        for (v, in_forest) in forest.into_iter().enumerate().filter(|(_, axes)| *axes != 0) {
            for axis in (0..2).filter(|axis| in_forest >> axis & 1 != 0) {
                let [a, b] = [v as u32, links.to[[NEXT_X, NEXT_Y][axis]][v]].map(|end| sets.find(end));
                let label = found[a as usize].min(found[b as usize]);
                found[sets.union(a, b) as usize] = label;
            }
        }
        let gates: Vec<u32> = self.read(&of("gates"), patch.brick)?;
        let gate_labels: Vec<u32> = self.read(&of("gate-labels"), patch.brick)?;
        for (gate, label) in gates.into_iter().filter_map(place).zip(gate_labels) {
            let root = sets.find(gate as u32) as usize;
            found[root] = found[root].min(label);
        }
        for (v, label) in labels.iter_mut().enumerate().filter(|(_, label)| **label == NONE) {
            *label = found[sets.find(v as u32) as usize];
        }
        Ok(labels)
    }

    /// Labels after the flood, and how often each lies on its traces.
    pub(crate) fn flooded(&self, flood: Flood, brick: usize) -> Result<(), InterpError> {
        for kind in 0..self.kinds.len() {
            let patch = self.patch(kind, brick, Halo::default(), Values::None)?;
            let labels = self.filled(flood, &patch)?;
            // Last trace (counted from 1), traces, how often on a trace again.
            let mut layers: HashMap<u32, [u32; 3]> = HashMap::new();
            for (n, (_, places, _)) in patch.own_traces().enumerate() {
                let trace = n as u32 + 1;
                for &label in labels[places].iter().filter(|&&label| label != NONE) {
                    let [last, traces, again] = layers.entry(label).or_default();
                    if *last == trace {
                        *again += 1;
                    } else {
                        (*last, *traces) = (trace, *traces + 1);
                    }
                }
            }
            let mut layers: Vec<[u32; 3]> =
                layers.into_iter().map(|(label, [_, traces, again])| [label, traces, again]).collect();
            layers.sort_unstable();
            self.keep(&format!("{}-flooded", flood.prefix()), &patch, &labels)?;
            self.write(&self.name_of(flood, "layers", kind), brick, &layers)?;
        }
        Ok(())
    }

    /// The labels that lie over themselves, ascending.
    pub(crate) fn layers(&self, flood: Flood) -> Result<(), InterpError> {
        self.each_kind(|kind| {
            let mut all: BTreeMap<u32, [u32; 2]> = BTreeMap::new();
            for brick in 0..self.tiles.count() {
                for [label, traces, again] in self.read::<[u32; 3]>(&self.name_of(flood, "layers", kind), brick)? {
                    let sum = all.entry(label).or_default();
                    *sum = [sum[0] + traces, sum[1] + again];
                }
            }
            let over: Vec<u32> = all
                .into_iter()
                .filter(|(_, [traces, again])| again * LAYERED > *traces)
                .map(|(label, _)| label)
                .collect();
            self.write(&self.name_of(flood, "layered", kind), 0, &over)
        })
    }

    /// Takes back what a flood gave to surfaces that lie over themselves, but for what is near; after the flood of cores
    /// the narrow surfaces take what is left.
    pub(crate) fn trimmed(&self, flood: Flood, brick: usize) -> Result<(), InterpError> {
        for kind in 0..self.kinds.len() {
            let over: Vec<u32> = self.read(&self.name_of(flood, "layered", kind), 0)?;
            let halo = if over.is_empty() { Halo::default() } else { Halo::around(OUTSKIRTS + 1) };
            let patch = self.patch(kind, brick, halo, Values::None)?;
            let mut labels: Vec<u32> = self.values(&format!("{}-flooded", flood.prefix()), &patch)?;
            if !over.is_empty() {
                let (links, evidence) = (self.links(&patch)?, self.values::<[u8; 2]>("evidence", &patch)?);
                let rooted: Vec<bool> = self.rooted(flood, &patch)?.into_iter().map(|label| label != NONE).collect();
                for (label, near) in labels.iter_mut().zip(near(&links, &evidence, &rooted)) {
                    if !near && *label != NONE && over.binary_search(label).is_ok() {
                        *label = NONE;
                    }
                }
            }
            if flood == Flood::Cores {
                let narrow = self.unflooded("narrow", &patch)?;
                labels
                    .iter_mut()
                    .zip(narrow)
                    .for_each(|(core, narrow)| *core = if *core == NONE { narrow } else { *core });
            }
            let name = if flood == Flood::Cores { "rooted" } else { "label" };
            self.keep(name, &patch, &labels)?;
        }
        Ok(())
    }
}

/// The spanning forest of links in their order, where each labelled extremum is a root.
fn spanning(labels: &[u32], links: impl Iterator<Item = (Key, [u32; 2])>) -> Vec<(Key, [u32; 2])> {
    let mut sets = UnionFind::new(labels.len());
    let mut rooted: Vec<bool> = labels.iter().map(|&label| label != NONE).collect();
    let joins = |&(_, [a, b]): &(Key, [u32; 2])| {
        let [a, b] = [sets.find(a), sets.find(b)];
        if a == b || (rooted[a as usize] && rooted[b as usize]) {
            return false;
        }
        let either = rooted[a as usize] || rooted[b as usize];
        rooted[sets.union(a, b) as usize] = either;
        true
    };
    links.filter(joins).collect()
}

impl Basin {
    /// The forest between gates and labels: no branch without a gate, and chains as one link with their greatest key.
    fn branches(&self) -> Vec<Branch> {
        let count = self.labels.len();
        let is_open = |v: u32| self.labels[v as usize] == NONE;
        // Trees without a gate do not matter to others.
        let mut sets = UnionFind::new(count);
        for &(_, [a, b]) in self.forest.iter().filter(|(_, ends)| ends.iter().all(|&end| is_open(end))) {
            sets.union(a, b);
        }
        let (mut has_gate, mut is_gate) = (vec![false; count], vec![false; count]);
        for &gate in &self.gates {
            has_gate[sets.find(gate) as usize] = true;
            is_gate[gate as usize] = true;
        }
        // Links by their open ends; a link to a label has one.
        let matters = |ends: &[u32; 2], sets: &mut UnionFind| {
            ends.iter().any(|&end| is_open(end) && has_gate[sets.find(end) as usize])
        };
        let tree: Vec<(Key, [u32; 2])> =
            self.forest.iter().filter(|(_, ends)| matters(ends, &mut sets)).copied().collect();
        drop(sets);
        let mut around: HashMap<u32, Vec<u32>> = HashMap::new();
        for (n, (_, ends)) in tree.iter().enumerate() {
            ends.iter().filter(|&&end| is_open(end)).for_each(|&end| around.entry(end).or_default().push(n as u32));
        }
        let mut tree: Vec<Option<(Key, [u32; 2])>> = tree.into_iter().map(Some).collect();
        let mut waiting: Vec<u32> = around.keys().copied().filter(|&v| !is_gate[v as usize]).collect();
        waiting.sort_unstable();
        while let Some(v) = waiting.pop() {
            let Some(links) = around.get_mut(&v) else { continue };
            links.retain(|&n| tree[n as usize].is_some_and(|(_, ends)| ends.contains(&v)));
            let other = |n: u32| tree[n as usize].map(|(key, [a, b])| (key, if a == v { b } else { a }));
            match links.as_slice() {
                [] => {}
                &[only] => {
                    let end = other(only).map(|(_, end)| end);
                    tree[only as usize] = None;
                    waiting.extend(end.filter(|&end| is_open(end) && !is_gate[end as usize]));
                }
                &[one, two] => {
                    let (Some((key, a)), Some((more, b))) = (other(one), other(two)) else { continue };
                    tree[one as usize] = Some((key.max(more), [a, b]));
                    tree[two as usize] = None;
                    // The far end of the second link now has the first one.
                    if let Some(links) = around.get_mut(&b) {
                        links.push(one);
                    }
                }
                _ => continue,
            }
            around.remove(&v);
        }
        let end = |v: u32| match self.labels[v as usize] {
            NONE => u64::from(self.indices[v as usize]),
            label => LABEL | u64::from(label),
        };
        tree.into_iter().flatten().map(|(key, ends)| Branch { key, ends: ends.map(end) }).collect()
    }
}
