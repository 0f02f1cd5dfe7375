//! Splits several depths at one node into single-valued sheets, each of which is continuous.
//!
//! Across a reverse fault a horizon has two depths at one trace. Continuity decides which of the two continues into
//! which neighbour: (a) values at nodes with several depths are joined with those of their neighbours in order of
//! increasing depth difference, but never so that one group has two values at a node; (b) every other node goes to the
//! group from which it is reached over the smallest sum of depth differences (Dijkstra); (c) groups that meet are
//! joined, smoothest contact first, if they have no node in common; (d) the remaining groups are packed into as few
//! sheets as possible, the largest first.

use std::cmp::Ordering;
use std::collections::{BinaryHeap, HashMap, HashSet};

/// Values per node: those of node n are `z[offsets[n]..offsets[n + 1]]`.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct NodeValues {
    pub offsets: Vec<u32>,
    pub z: Vec<f32>,
}

impl NodeValues {
    /// Groups (node, value) pairs by node; values of a node closer than `tolerance` become their mean.
    /// Returns, for every pair, the index of its value in `z`.
    ///
    /// # Errors
    /// [`Crowded`], since what follows compares every depth of a node with every depth of its neighbours.
    pub(crate) fn group(nodes: usize, pairs: &[(usize, f32)], tolerance: f32) -> Result<(Self, Vec<u32>), Crowded> {
        let mut order: Vec<u32> = (0..pairs.len() as u32).collect();
        order.sort_by(|&a, &b| {
            let (a, b) = (&pairs[a as usize], &pairs[b as usize]);
            a.0.cmp(&b.0).then(a.1.total_cmp(&b.1))
        });
        let mut values = Self { offsets: vec![0; nodes + 1], z: Vec::new() };
        let mut element = vec![0; pairs.len()];
        let mut at = 0;
        while at < order.len() {
            let (node, first) = pairs[order[at] as usize];
            let run = order[at..]
                .iter()
                .take_while(|&&o| pairs[o as usize].0 == node && pairs[o as usize].1 - first <= tolerance)
                .count();
            let sum: f64 = order[at..at + run].iter().map(|&o| f64::from(pairs[o as usize].1)).sum();
            for &o in &order[at..at + run] {
                element[o as usize] = values.z.len() as u32;
            }
            // A value that is alone at its node is kept bit for bit.
            values.z.push(if run == 1 { first } else { (sum / run as f64) as f32 });
            values.offsets[node + 1] += 1;
            if values.offsets[node + 1] as usize > MAX_DEPTHS {
                return Err(Crowded);
            }
            at += run;
        }
        for n in 0..nodes {
            values.offsets[n + 1] += values.offsets[n];
        }
        Ok((values, element))
    }

    fn of(&self, node: usize) -> std::ops::Range<usize> {
        self.offsets[node] as usize..self.offsets[node + 1] as usize
    }

    /// Count of nodes with more than one value.
    pub(crate) fn multivalued(&self) -> usize {
        (1..self.offsets.len()).filter(|&n| self.offsets[n] - self.offsets[n - 1] > 1).count()
    }
}

/// Most depths at one node: a stack of thrusts has a few.
pub(super) const MAX_DEPTHS: usize = 32;

/// A node has more than [`MAX_DEPTHS`].
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Crowded;

/// Groups that may be joined if they have no node in common.
struct Groups {
    parent: Vec<u32>,
    /// The nodes with several values at which the group of a root has a value.
    nodes: Vec<HashSet<u32>>,
}

impl Groups {
    fn root(&mut self, mut a: u32) -> u32 {
        while self.parent[a as usize] != a {
            self.parent[a as usize] = self.parent[self.parent[a as usize] as usize];
            a = self.parent[a as usize];
        }
        a
    }

    fn join(&mut self, a: u32, b: u32) {
        let (a, b) = (self.root(a), self.root(b));
        if a == b {
            return;
        }
        let (small, large) = if self.nodes[a as usize].len() < self.nodes[b as usize].len() { (a, b) } else { (b, a) };
        if self.nodes[small as usize].iter().any(|n| self.nodes[large as usize].contains(n)) {
            return;
        }
        let moved = std::mem::take(&mut self.nodes[small as usize]);
        self.nodes[large as usize].extend(moved);
        self.parent[small as usize] = large;
    }
}

/// A value waiting to be claimed by a group.
struct Claim {
    cost: f32,
    element: u32,
    group: u32,
}

impl Ord for Claim {
    fn cmp(&self, other: &Self) -> Ordering {
        // The greatest entry of the heap is the cheapest; ties are broken by number, so that the result does not depend
        // on the heap.
        other.cost.total_cmp(&self.cost).then(other.element.cmp(&self.element)).then(other.group.cmp(&self.group))
    }
}

impl PartialOrd for Claim {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl PartialEq for Claim {
    fn eq(&self, other: &Self) -> bool {
        self.cmp(other) == Ordering::Equal
    }
}

/// The label of a value that no group has reached.
const NO_GROUP: u32 = u32::MAX;

impl Eq for Claim {}

/// The sheet of every value, from 0. `neighbours(n)` are the nodes next to n. O(n log n).
pub(super) fn split(values: &NodeValues, neighbours: &dyn Fn(usize) -> Vec<usize>) -> Vec<u16> {
    let nodes = values.offsets.len() - 1;
    let multi: Vec<usize> = (0..nodes).filter(|&n| values.of(n).len() > 1).collect();
    if multi.is_empty() {
        return vec![0; values.z.len()];
    }
    let difference = |a: usize, b: usize| (values.z[a] - values.z[b]).abs();

    // (a) Join what is continuous among the nodes with several values.
    let mut index = HashMap::new();
    let mut members = Vec::new();
    for &n in &multi {
        for e in values.of(n) {
            index.insert(e, members.len() as u32);
            members.push((n, e));
        }
    }
    let mut groups = Groups {
        parent: (0..members.len() as u32).collect(),
        nodes: members.iter().map(|&(n, _)| HashSet::from([n as u32])).collect(),
    };
    let mut edges = Vec::new();
    for &n in &multi {
        for m in neighbours(n).into_iter().filter(|&m| m > n && values.of(m).len() > 1) {
            for a in values.of(n) {
                edges.extend(values.of(m).map(|b| (difference(a, b), index[&a], index[&b])));
            }
        }
    }
    edges.sort_by(|a, b| a.0.total_cmp(&b.0).then((a.1, a.2).cmp(&(b.1, b.2))));
    edges.iter().for_each(|&(_, a, b)| groups.join(a, b));

    // (b) Every other value goes to the group it is reached from most smoothly.
    let none = NO_GROUP;
    let mut label = vec![none; values.z.len()];
    let mut heap = BinaryHeap::new();
    for (n, &(_, e)) in members.iter().enumerate() {
        heap.push(Claim { cost: 0.0, element: e as u32, group: groups.root(n as u32) });
    }
    let node_of: Vec<u32> = (0..nodes).flat_map(|n| values.of(n).map(move |_| n as u32)).collect();
    // A step costs a little even where it is level, so that groups spread evenly.
    let (low, high) = values.z.iter().fold((f32::MAX, f32::MIN), |(l, h), &z| (l.min(z), h.max(z)));
    let level = 1e-4 * (high - low).max(f32::MIN_POSITIVE);
    while let Some(Claim { cost, element, group }) = heap.pop() {
        if label[element as usize] != none {
            continue;
        }
        label[element as usize] = group;
        for m in neighbours(node_of[element as usize] as usize) {
            if let [only] = *values.of(m).collect::<Vec<_>>()
                && label[only] == none
            {
                heap.push(Claim {
                    cost: cost + difference(element as usize, only) + level,
                    element: only as u32,
                    group,
                });
            }
        }
    }

    // (c) Join groups that meet smoothly and have no node in common.
    let mut contacts: HashMap<(u32, u32), (f64, u32)> = HashMap::new();
    for n in 0..nodes {
        for m in neighbours(n).into_iter().filter(|&m| m > n) {
            for a in values.of(n) {
                for b in values.of(m) {
                    let (x, y) = (label[a], label[b]);
                    if x != y && x != none && y != none {
                        let contact = contacts.entry((x.min(y), x.max(y))).or_default();
                        *contact = (contact.0 + f64::from(difference(a, b)), contact.1 + 1);
                    }
                }
            }
        }
    }
    let mut contacts: Vec<_> =
        contacts.into_iter().map(|(pair, (sum, count))| (sum / f64::from(count), pair)).collect();
    contacts.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
    contacts.iter().for_each(|&(_, (a, b))| groups.join(a, b));

    // (d) Pack what is left into sheets.
    pack(&mut groups, &mut label)
}

/// Packs groups into sheets, the largest first, and returns the sheet of every value; values that no group
/// reaches go to the first sheet.
fn pack(groups: &mut Groups, label: &mut [u32]) -> Vec<u16> {
    let mut sizes: HashMap<u32, usize> = HashMap::new();
    for l in label.iter_mut().filter(|l| **l != NO_GROUP) {
        *l = groups.root(*l);
        *sizes.entry(*l).or_default() += 1;
    }
    let mut roots: Vec<_> = sizes.into_iter().collect();
    roots.sort_by(|a, b| b.1.cmp(&a.1).then(a.0.cmp(&b.0)));
    let mut sheets: Vec<HashSet<u32>> = Vec::new();
    let mut sheet_of = HashMap::new();
    for (root, _) in roots {
        let own = &groups.nodes[root as usize];
        let free = sheets.iter().position(|taken| own.iter().all(|n| !taken.contains(n)));
        let sheet = free.unwrap_or_else(|| {
            sheets.push(HashSet::new());
            sheets.len() - 1
        });
        sheets[sheet].extend(own);
        sheet_of.insert(root, sheet as u16);
    }
    label.iter().map(|l| sheet_of.get(l).copied().unwrap_or(0)).collect()
}

/// The four neighbours of a node of a `[u][v]` grid.
pub(super) fn grid_neighbours(count: [usize; 2]) -> impl Fn(usize) -> Vec<usize> {
    move |node| {
        let (u, v) = (node / count[1], node % count[1]);
        let mut found = Vec::with_capacity(4);
        if u > 0 {
            found.push(node - count[1]);
        }
        if v > 0 {
            found.push(node - 1);
        }
        if v + 1 < count[1] {
            found.push(node + 1);
        }
        if u + 1 < count[0] {
            found.push(node + count[1]);
        }
        found
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A ramp overthrust onto itself: for u < 12 the footwall at 100 + u, for u ≥ 8 the hanging wall at 60 +
    /// u.
    fn overthrust() -> (NodeValues, Vec<u32>, Vec<(usize, f32)>) {
        let count = [20, 6];
        let mut pairs = Vec::new();
        for u in 0..count[0] {
            for v in 0..count[1] {
                let wiggle = 0.3 * ((u * 7 + v * 3) % 5) as f32;
                if u < 12 {
                    pairs.push((u * count[1] + v, 100.0 + u as f32 + wiggle));
                }
                if u >= 8 {
                    pairs.push((u * count[1] + v, 60.0 + u as f32 + wiggle));
                }
            }
        }
        let (values, element) = NodeValues::group(count[0] * count[1], &pairs, 0.05).unwrap();
        (values, element, pairs)
    }

    #[test]
    fn an_overthrust_becomes_hanging_wall_and_footwall() {
        let (values, element, pairs) = overthrust();
        assert_eq!(values.multivalued(), 24);
        let sheet = split(&values, &grid_neighbours([20, 6]));
        let of = |p: usize| sheet[element[p] as usize];
        let foot = of(0);
        for (p, (node, z)) in pairs.iter().enumerate() {
            let is_foot = *z >= 100.0;
            assert_eq!(of(p) == foot, is_foot, "node {node}, depth {z}");
        }
    }

    #[test]
    fn two_separate_overlaps_still_need_only_two_sheets() {
        // Blocks at depth 0, 50, 0 along u, overlapping by two nodes each.
        let mut pairs = Vec::new();
        for u in 0..30usize {
            for v in 0..3 {
                let node = u * 3 + v;
                for (range, z) in [(0..11, 0.0), (9..21, 50.0), (19..30, 0.0)] {
                    if range.contains(&u) {
                        pairs.push((node, z + 0.01 * u as f32));
                    }
                }
            }
        }
        let (values, _) = NodeValues::group(90, &pairs, 0.001).unwrap();
        let sheet = split(&values, &grid_neighbours([30, 3]));
        assert_eq!(sheet.iter().max(), Some(&1));
    }

    #[test]
    fn equal_values_of_a_node_are_one() {
        let (values, element) = NodeValues::group(2, &[(1, 5.0), (0, 1.0), (1, 5.02), (1, 9.0)], 0.05).unwrap();
        assert_eq!(values.offsets, [0, 1, 3]);
        assert_eq!(element, [1, 0, 1, 2]);
        assert!((values.z[1] - 5.01).abs() < 1e-6);
        assert_eq!(values.multivalued(), 1);
    }

    #[test]
    fn a_node_with_too_many_depths_is_refused() {
        let stack = |count: usize| (0..count).map(|n| (0, n as f32)).collect::<Vec<_>>();
        NodeValues::group(1, &stack(MAX_DEPTHS), 0.1).unwrap();
        assert_eq!(NodeValues::group(1, &stack(MAX_DEPTHS + 1), 0.1), Err(Crowded));
    }
}
