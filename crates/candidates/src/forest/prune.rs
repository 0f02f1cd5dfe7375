//! From the list of merges to a tree whose leaves have a minimum size.
//!
//! Seen from the root, a node with one half below the minimum is contracted into its larger half, and the
//! small half goes to the neighbouring leaf whose cost increases least. A node of at least the minimum whose
//! halves are both below it is a leaf.

use super::dual::{Patches, find};
use super::moments::Moments;
use std::ops::Range;

/// Not in a leaf yet, or not in a tree.
const NONE: u32 = u32::MAX;

/// A node of one surface's tree; indices and ranges are those of the surface.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct PrunedNode {
    pub(crate) parent: Option<u32>,
    pub(crate) children: Option<[u32; 2]>,
    pub(crate) triangles: Range<u32>,
}

/// One surface's tree, each node before its children.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct PrunedTree {
    pub(crate) nodes: Vec<PrunedNode>,
    /// Triangles in the order of the leaves; empty when they keep their order.
    pub(crate) order: Vec<u32>,
}

impl PrunedTree {
    /// A tree that is one leaf.
    pub(crate) fn leaf(triangles: u32) -> Self {
        Self { nodes: vec![PrunedNode { parent: None, children: None, triangles: 0..triangles }], order: Vec::new() }
    }
}

/// The state of a part that is large enough: a leaf, or a node of two halves.
#[derive(Clone, Copy)]
enum Branch {
    Leaf(u32),
    Halves([u32; 2]),
}

struct Pruning<'a> {
    patches: &'a Patches,
    min_leaf: u32,
    /// Union–find over patches, after the merges so far.
    parent: Vec<u32>,
    /// Triangles of each part.
    counts: Vec<u32>,
    /// The patches of a part below the minimum, as a linked list: from its id along `next` to `last`.
    next: Vec<u32>,
    last: Vec<u32>,
    /// Branch of each part that is large enough.
    branch: Vec<u32>,
    branches: Vec<Branch>,
    leaf_of: Vec<u32>,
    leaf_moments: Vec<Moments>,
}

/// Replays the merges of a surface and prunes their tree. The surface has at least `min_leaf` triangles.
pub(crate) fn prune(patches: &Patches, merges: &[[u32; 2]], min_leaf: u32) -> PrunedTree {
    let count = patches.len();
    let mut pruning = Pruning {
        patches,
        min_leaf,
        parent: (0..count as u32).collect(),
        counts: patches.counts.clone(),
        next: vec![NONE; count],
        last: (0..count as u32).collect(),
        branch: vec![NONE; count],
        branches: Vec::new(),
        leaf_of: vec![NONE; count],
        leaf_moments: Vec::new(),
    };
    for patch in 0..count as u32 {
        pruning.settle(patch);
    }
    for &[low, high] in merges {
        pruning.merge(low, high);
    }
    // Every merge names the lesser part first, so all end in patch 0.
    let root = pruning.branch[0];
    assert_ne!(root, NONE, "a surface of at least one leaf has a root");
    pruning.emit(root)
}

impl Pruning<'_> {
    fn merge(&mut self, low: u32, high: u32) {
        let [a, b] = [low as usize, high as usize];
        let branches = [self.branch[a], self.branch[b]];
        match branches {
            [NONE, NONE] => {
                self.next[self.last[a] as usize] = high;
                self.last[a] = self.last[b];
            }
            [NONE, large] => {
                self.give(low, high);
                self.branch[a] = large;
            }
            [_, NONE] => self.give(high, low),
            halves => {
                self.branch[a] = self.branches.len() as u32;
                self.branches.push(Branch::Halves(halves));
            }
        }
        self.counts[a] += self.counts[b];
        self.parent[b] = low;
        self.settle(low);
    }

    /// Makes a part a leaf if it is large enough and is none yet.
    fn settle(&mut self, part: u32) {
        if self.branch[part as usize] != NONE || self.counts[part as usize] < self.min_leaf {
            return;
        }
        let leaf = self.leaf_moments.len() as u32;
        self.branch[part as usize] = self.branches.len() as u32;
        self.branches.push(Branch::Leaf(leaf));
        self.leaf_moments.push(Moments::EMPTY);
        self.assign(part, leaf);
    }

    /// Adds the patches of a small part to a leaf.
    fn assign(&mut self, part: u32, leaf: u32) {
        let mut patch = part;
        while patch != NONE {
            self.leaf_of[patch as usize] = leaf;
            let sum = &mut self.leaf_moments[leaf as usize];
            *sum = sum.union(&self.patches.moments[patch as usize]);
            patch = self.next[patch as usize];
        }
    }

    /// Adds a small part to the neighbouring leaf of a large part that stays the flattest.
    fn give(&mut self, small: u32, large: u32) {
        let mut leaves: Vec<u32> = Vec::new();
        let mut moments = Moments::EMPTY;
        let mut patch = small;
        while patch != NONE {
            moments = moments.union(&self.patches.moments[patch as usize]);
            for &neighbour in self.patches.neighbours_of(patch) {
                let leaf = self.leaf_of[neighbour as usize];
                if leaf != NONE && !leaves.contains(&leaf) && find(&mut self.parent, neighbour) == large {
                    leaves.push(leaf);
                }
            }
            patch = self.next[patch as usize];
        }
        let growth = |&leaf: &u32| {
            let leaf = &self.leaf_moments[leaf as usize];
            leaf.union(&moments).cost() - leaf.cost()
        };
        let best = leaves.into_iter().min_by(|a, b| growth(a).total_cmp(&growth(b)).then(a.cmp(b)));
        let leaf = best.unwrap_or_else(|| self.first_leaf(self.branch[large as usize]));
        self.assign(small, leaf);
    }

    /// The first leaf under a branch, for pieces that touch none.
    fn first_leaf(&self, mut branch: u32) -> u32 {
        loop {
            match self.branches[branch as usize] {
                Branch::Leaf(leaf) => return leaf,
                Branch::Halves([first, _]) => branch = first,
            }
        }
    }

    /// Writes the tree, each node before its children, and the triangles leaf by leaf.
    fn emit(&self, root: u32) -> PrunedTree {
        let mut of_leaf = vec![0u32; self.leaf_moments.len()];
        for (&leaf, &count) in self.leaf_of.iter().zip(&self.patches.counts) {
            of_leaf[leaf as usize] += count;
        }
        // Halves were made before the branches they belong to.
        let mut totals = Vec::with_capacity(self.branches.len());
        for branch in &self.branches {
            totals.push(match *branch {
                Branch::Leaf(leaf) => of_leaf[leaf as usize],
                Branch::Halves([a, b]) => totals[a as usize] + totals[b as usize],
            });
        }
        let mut nodes: Vec<PrunedNode> = Vec::new();
        let mut starts = vec![0u32; of_leaf.len()];
        let mut stack = vec![(root, None::<(u32, usize)>)];
        let mut start = 0;
        while let Some((branch, above)) = stack.pop() {
            let index = nodes.len() as u32;
            if let Some((parent, side)) = above
                && let Some(children) = &mut nodes[parent as usize].children
            {
                children[side] = index;
            }
            let triangles = start..start + totals[branch as usize];
            let parent = above.map(|(parent, _)| parent);
            let children = match self.branches[branch as usize] {
                Branch::Leaf(leaf) => {
                    starts[leaf as usize] = start;
                    start = triangles.end;
                    None
                }
                Branch::Halves([a, b]) => {
                    stack.push((b, Some((index, 1))));
                    stack.push((a, Some((index, 0))));
                    Some([index; 2])
                }
            };
            nodes.push(PrunedNode { parent, children, triangles });
        }
        let mut order = vec![0u32; start as usize];
        for (triangle, &patch) in self.patches.of_triangle.iter().enumerate() {
            let at = &mut starts[self.leaf_of[patch as usize] as usize];
            order[*at as usize] = triangle as u32;
            *at += 1;
        }
        PrunedTree { nodes, order }
    }
}
