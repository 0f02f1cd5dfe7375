//! The nodes of an event by trace, and their neighbours.

use crate::event::Node;

/// Traces to either side along a row over which the dip is told.
const DIP_REACH: usize = 4;

/// Nodes by trace.
pub(super) struct Grid<'a> {
    /// The nodes, ordered by trace.
    pub nodes: &'a [Node],
    starts: Vec<u32>,
    /// Counts of inlines and crosslines.
    pub count: [usize; 2],
}

impl<'a> Grid<'a> {
    pub(super) fn new(nodes: &'a [Node], count: [usize; 2]) -> Self {
        let mut starts = vec![0u32; count[0] * count[1] + 1];
        for node in nodes {
            starts[usize::from(node.x) * count[1] + usize::from(node.y) + 1] += 1;
        }
        for n in 1..starts.len() {
            starts[n] += starts[n - 1];
        }
        Self { nodes, starts, count }
    }

    /// The nodes on a trace.
    pub(super) fn on(&self, [x, y]: [usize; 2]) -> std::ops::Range<usize> {
        let trace = x * self.count[1] + y;
        self.starts[trace] as usize..self.starts[trace + 1] as usize
    }

    /// The trace of a node.
    pub(super) fn trace(&self, n: usize) -> [usize; 2] {
        [usize::from(self.nodes[n].x), usize::from(self.nodes[n].y)]
    }

    /// The node on the trace `steps` on from that of a node along an axis that is closest to a depth.
    pub(super) fn beside(&self, n: usize, axis: usize, steps: isize, z: f32) -> Option<usize> {
        let mut trace = self.trace(n);
        trace[axis] = trace[axis].checked_add_signed(steps).filter(|at| *at < self.count[axis])?;
        let off = |m: &usize| (self.nodes[*m].z - z).abs();
        self.on(trace).min_by(|a, b| off(a).total_cmp(&off(b)))
    }

    /// The median step of depth along an axis around a pair of neighbours, the pair itself and what a fault cuts left out.
    pub(super) fn dip(&self, n: usize, axis: usize) -> f32 {
        let mut steps = Vec::with_capacity(2 * DIP_REACH);
        let (mut at, mut m) = (Some(n), 0);
        while let (Some(here), true) = (at, m < DIP_REACH) {
            let next = self.beside(here, axis, -1, self.nodes[here].z);
            steps.extend(next.map(|next| self.nodes[here].z - self.nodes[next].z));
            (at, m) = (next, m + 1);
        }
        let (mut at, mut m) = (self.beside(n, axis, 1, self.nodes[n].z), 0);
        while let (Some(here), true) = (at, m < DIP_REACH) {
            let next = self.beside(here, axis, 1, self.nodes[here].z);
            steps.extend(next.map(|next| self.nodes[next].z - self.nodes[here].z));
            (at, m) = (next, m + 1);
        }
        steps.sort_by(f32::total_cmp);
        steps.get(steps.len() / 2).copied().unwrap_or(0.0)
    }
}
