//! A lattice of unknowns that is cut by faults: one unknown at each node for the blocks that are one there.
//!
//! Every block has a value at every node, also beyond its faults. At a node beside the interpreted part of a fault the
//! two sides have values of their own; at a node beside its virtual part, beyond the tip, they share one. So what is
//! solved on the lattice breaks at a fault, and the break dies out towards its tip.

use super::distance::NodeBox;
use super::least_squares::Equations;
use crate::FaultNetwork;
use glam::{DMat3, DVec3, Vec3};
use rayon::prelude::*;
use survey::LevelField;

/// Voxels around the volume in which levels are defined.
pub(super) const MARGIN: f32 = 4.0;

/// The unknown where none is wanted.
const NONE: u32 = u32::MAX;

/// The lattice.
#[derive(Debug, Clone)]
pub struct CutLattice {
    /// Its nodes.
    pub nodes: NodeBox,
    /// Number of fault blocks.
    pub blocks: usize,
    /// The unknown of each block at each node, `[block][node]`.
    unknown: Vec<u32>,
    /// Number of unknowns.
    pub unknowns: usize,
}

/// Unknowns and their weights in a value or a slope.
pub(crate) type Terms = [(u32, f64); 8];

impl CutLattice {
    /// The nodes around a volume, about so many, their spacing the same in metres along each axis where that is not finer
    /// than the voxels, times `coarseness`.
    pub fn nodes_around(size: [usize; 3], metric: DMat3, nodes: f64, coarseness: f64) -> NodeBox {
        let low = Vec3::splat(-MARGIN);
        let high = Vec3::from_array(size.map(|n| n as f32 - 1.0)) + MARGIN;
        Self::nodes_between(low, high, metric, nodes, coarseness, 1.0)
    }

    /// The same between two corners, voxels, at a spacing of at least `finest` voxels times `coarseness`.
    pub fn nodes_between(low: Vec3, high: Vec3, metric: DMat3, nodes: f64, coarseness: f64, finest: f64) -> NodeBox {
        let lengths = [0, 1, 2].map(|axis| metric.col(axis).length());
        let extent = (high - low).as_dvec3();
        let volume_m = (0..3).map(|axis| extent[axis] * lengths[axis]).product::<f64>();
        let spacing_m = (volume_m / nodes).cbrt() * coarseness;
        let step = Vec3::from_array(lengths.map(|length| (spacing_m / length).max(coarseness * finest) as f32));
        NodeBox::covering(low, high, step)
    }

    /// The unknowns of each block at the nodes for which `is_wanted(block, node)` holds.
    pub fn of(faults: &FaultNetwork, nodes: NodeBox, is_wanted: impl Fn(usize, usize) -> bool + Sync) -> Self {
        let signatures = faults.signatures();
        let blocks = faults.block_count();
        // For each node, the first block that each block shares its value with.
        let shared: Vec<Vec<u16>> = (0..nodes.count())
            .into_par_iter()
            .map(|node| {
                if !(0..blocks).any(|block| is_wanted(block, node)) {
                    return Vec::new();
                }
                let p = nodes.place(node).as_dvec3();
                let is_virtual = |f: usize| u64::from(faults.surfaces()[f].extent_at(p) < 0.0) << f;
                let beyond: u64 = (0..faults.surfaces().len()).map(is_virtual).sum();
                let mut first: Vec<u16> = (0..blocks as u16).collect();
                for b in 0..blocks {
                    for c in 0..b {
                        let (own, other) = (signatures[b], signatures[c]);
                        let between = (own.bits ^ other.bits) & own.care & other.care;
                        if between & !beyond == 0 {
                            let (low, high) = (first[c].min(first[b]), first[c].max(first[b]));
                            first.iter_mut().filter(|f| **f == high).for_each(|f| *f = low);
                        }
                    }
                }
                first
            })
            .collect();
        let mut unknown = vec![NONE; blocks * nodes.count()];
        let mut unknowns = 0;
        for (node, first) in shared.iter().enumerate() {
            for block in (0..first.len()).filter(|&block| is_wanted(block, node)) {
                let at = |block: usize| block * nodes.count() + node;
                let known = (0..block).find(|&other| first[other] == first[block] && unknown[at(other)] != NONE);
                unknown[at(block)] = known.map_or(unknowns as u32, |other| unknown[at(other)]);
                unknowns += usize::from(known.is_none());
            }
        }
        Self { nodes, blocks, unknown, unknowns }
    }

    /// For each block, the nodes that `holds` gives to it, and those up to `around` nodes from them.
    pub fn near_blocks(
        faults: &FaultNetwork,
        nodes: NodeBox,
        around: usize,
        holds: impl Fn(usize) -> Option<u16> + Send + Sync,
    ) -> Vec<Vec<bool>> {
        let of_node: Vec<Option<u16>> = (0..nodes.count()).into_par_iter().map(holds).collect();
        let near = |block: usize| {
            let mut near: Vec<bool> = of_node.iter().map(|of| of.map(usize::from) == Some(block)).collect();
            for _ in 0..around {
                let inside = near.clone();
                for node in (0..nodes.count()).filter(|&node| inside[node]) {
                    nodes.beside(node).for_each(|m| near[m] = true);
                }
            }
            near
        };
        (0..faults.block_count()).into_par_iter().map(near).collect()
    }

    /// The unknown of a block at a node, [`u32::MAX`] where none is wanted.
    pub fn unknown(&self, block: usize, node: usize) -> u32 {
        self.unknown[block * self.nodes.count() + node]
    }

    /// The first node of the cell around a voxel position, and the fractions inside it.
    fn cell(&self, p: Vec3) -> (usize, DVec3) {
        let NodeBox { origin, step, size } = self.nodes;
        let at = ((p - origin) / step).as_dvec3().max(DVec3::ZERO);
        let index = [0, 1, 2].map(|axis| (at[axis] as usize).min(size[axis] - 2));
        let fraction = (at - DVec3::from_array(index.map(|n| n as f64))).min(DVec3::ONE);
        ((index[0] * size[1] + index[1]) * size[2] + index[2], fraction)
    }

    /// The corners of the cell that begins at `node`: 4·x + 2·y + z.
    fn corners(&self, block: usize, node: usize) -> [u32; 8] {
        let (x, y) = (self.nodes.size[1] * self.nodes.size[2], self.nodes.size[2]);
        [0, 1, y, y + 1, x, x + 1, x + y, x + y + 1].map(|offset| self.unknown(block, node + offset))
    }

    /// Whether all nodes around a voxel position have an unknown of a block.
    pub fn is_known(&self, block: usize, p: Vec3) -> bool {
        let NodeBox { origin, step, size } = self.nodes;
        let at = (p - origin) / step;
        let end = Vec3::from_array(size.map(|n| (n - 1) as f32));
        at.cmpge(Vec3::ZERO).all() && at.cmple(end).all() && !self.corners(block, self.cell(p).0).contains(&NONE)
    }

    /// The value of a block at a voxel position, trilinear. All nodes around it must be wanted.
    pub fn value(&self, block: usize, p: Vec3) -> Terms {
        let (node, f) = self.cell(p);
        let weight = |n: usize| {
            let side = |bit: usize, t: f64| if n & bit == 0 { 1.0 - t } else { t };
            side(4, f.x) * side(2, f.y) * side(1, f.z)
        };
        let corners = self.corners(block, node);
        std::array::from_fn(|n| (corners[n], weight(n)))
    }

    /// A first guess of all unknowns: a function of the voxel position in a block.
    pub fn guess<const N: usize>(&self, value: impl Fn(usize, Vec3) -> [f64; N]) -> Vec<[f64; N]> {
        let mut guess = vec![[0.0; N]; self.unknowns];
        for block in 0..self.blocks {
            for node in 0..self.nodes.count() {
                if let Some(at) = guess.get_mut(self.unknown(block, node) as usize) {
                    *at = value(block, self.nodes.place(node));
                }
            }
        }
        guess
    }

    /// One of the solutions at all nodes of each block; nodes that were not wanted continue their neighbours.
    pub fn spread<const N: usize>(&self, values: &[[f64; N]], which: usize) -> Vec<LevelField> {
        let NodeBox { origin, step, size } = self.nodes;
        let field = |block: usize| {
            let at = |node: usize| {
                values.get(self.unknown(block, node) as usize).map_or(f32::NAN, |value| value[which] as f32)
            };
            let mut found: Vec<f32> = (0..self.nodes.count()).map(at).collect();
            let mut edge: Vec<usize> = (0..found.len()).filter(|&node| found[node].is_finite()).collect();
            while !edge.is_empty() {
                let mut next: Vec<usize> = edge.iter().flat_map(|&node| self.nodes.beside(node)).collect();
                next.retain(|&node| found[node].is_nan());
                next.sort_unstable();
                next.dedup();
                let mean = |&node: &usize| {
                    let known = self.nodes.beside(node).map(|m| found[m]).filter(|value| value.is_finite());
                    let (sum, count) = known.fold((0.0, 0.0), |(sum, count), value| (sum + value, count + 1.0));
                    sum / count
                };
                let means: Vec<f32> = next.iter().map(mean).collect();
                next.iter().zip(means).for_each(|(&node, value)| found[node] = value);
                edge = next;
            }
            found.iter_mut().filter(|value| value.is_nan()).for_each(|value| *value = 0.0);
            LevelField { origin, step, size, values: found }
        };
        (0..self.blocks).into_par_iter().map(field).collect()
    }

    /// The first node of every cell in which `block` has corners that no block before it has all of.
    pub fn cells(&self, block: usize) -> impl Iterator<Item = usize> + '_ {
        let size = self.nodes.size;
        (0..self.nodes.count()).filter(move |&node| {
            let index = self.nodes.index(node);
            let inside = (0..3).all(|axis| index[axis] + 1 < size[axis]);
            inside && {
                let own = self.corners(block, node);
                !own.contains(&NONE) && (0..block).all(|other| self.corners(other, node) != own)
            }
        })
    }

    /// The slope at the middle of a cell along a metric direction, per metre.
    pub fn slope(&self, block: usize, node: usize, direction: DVec3, voxel_from_metric: DMat3) -> Terms {
        let along = voxel_from_metric * direction / self.nodes.step.as_dvec3();
        let corners = self.corners(block, node);
        std::array::from_fn(|n| {
            let sign = |bit: usize| if n & bit == 0 { -0.25 } else { 0.25 };
            (corners[n], along.x * sign(4) + along.y * sign(2) + along.z * sign(1))
        })
    }

    /// The slope at a voxel position along a metric direction, per metre.
    pub(crate) fn slope_at(&self, block: usize, p: Vec3, direction: DVec3, voxel_from_metric: DMat3) -> Terms {
        let along = voxel_from_metric * direction / self.nodes.step.as_dvec3();
        let (node, f) = self.cell(p);
        let corners = self.corners(block, node);
        std::array::from_fn(|n| {
            let side = |bit: usize, t: f64| if n & bit == 0 { 1.0 - t } else { t };
            let sign = |bit: usize| if n & bit == 0 { -1.0 } else { 1.0 };
            let [x, y, z] = [side(4, f.x), side(2, f.y), side(1, f.z)];
            (corners[n], along.x * sign(4) * y * z + along.y * sign(2) * x * z + along.z * sign(1) * x * y)
        })
    }

    /// The middle of a cell, voxels.
    pub fn middle(&self, node: usize) -> Vec3 {
        self.nodes.place(node) + 0.5 * self.nodes.step
    }

    /// Adds the second differences of all blocks, which are 0 where the solution is as straight as can be.
    pub fn add_smoothness<const N: usize>(&self, weight: f64, equations: &mut Equations<N>) {
        let size = self.nodes.size;
        let strides = [size[1] * size[2], size[2], 1];
        for block in 0..self.blocks {
            for node in 0..self.nodes.count() {
                let index = self.nodes.index(node);
                let mut add = |nodes: &[(usize, f64)], weight: f64| {
                    let of = |block: usize| nodes.iter().map(move |&(n, _)| self.unknown(block, n));
                    // What a block shares with one before it was added there.
                    if of(block).all(|n| n != NONE) && (0..block).all(|other| of(other).ne(of(block))) {
                        equations.add(weight, nodes.iter().map(|&(n, c)| (self.unknown(block, n), c)), [0.0; N]);
                    }
                };
                for axis in 0..3 {
                    if index[axis] > 0 && index[axis] + 1 < size[axis] {
                        let s = strides[axis];
                        add(&[(node - s, 1.0), (node, -2.0), (node + s, 1.0)], weight);
                    }
                    let other = (axis + 1) % 3;
                    if index[axis] + 1 < size[axis] && index[other] + 1 < size[other] {
                        let (s, t) = (strides[axis], strides[other]);
                        let corners = [(node, 1.0), (node + s, -1.0), (node + t, -1.0), (node + s + t, 1.0)];
                        add(&corners, weight * std::f64::consts::SQRT_2);
                    }
                }
            }
        }
    }
}

/// Values at coarse nodes as the Catmull–Rom tricubic of them, at nodes `step` voxels apart around the part of a volume of
/// `size` that `holds` coarse nodes.
pub fn resampled(coarse: &LevelField, size: [usize; 3], step: f32, holds: impl Fn(Vec3) -> bool) -> LevelField {
    let nodes = NodeBox { origin: coarse.origin, step: coarse.step, size: coarse.size };
    let held = (0..nodes.count()).map(|node| nodes.place(node)).filter(|&p| holds(p));
    let (mut low, mut high) = held.fold((Vec3::INFINITY, Vec3::NEG_INFINITY), |(l, h), p| (l.min(p), h.max(p)));
    if low.x > high.x {
        (low, high) = (Vec3::ZERO, Vec3::ONE);
    }
    let around = nodes.step.max(Vec3::splat(MARGIN)).ceil();
    let limit = Vec3::from_array(size.map(|n| n as f32 - 1.0)) + MARGIN;
    let low = (low - around).floor().max(Vec3::splat(-MARGIN));
    let high = (high + around).ceil().min(limit).max(low + 1.0);
    let fine = NodeBox::covering(low, high, Vec3::splat(step));
    let at = |[x, y, z]: [usize; 3]| f64::from(coarse.values[(x * nodes.size[1] + y) * nodes.size[2] + z]);
    let value = |node: usize| tricubic(nodes, fine.place(node), at) as f32;
    let values = (0..fine.count()).into_par_iter().map(value).collect();
    LevelField { origin: low, step: fine.step, size: fine.size, values }
}

/// The Catmull–Rom tricubic of values at the nodes of a box; nodes beyond it continue the last two.
fn tricubic(nodes: NodeBox, p: Vec3, at: impl Fn([usize; 3]) -> f64) -> f64 {
    let place = ((p - nodes.origin) / nodes.step).as_dvec3();
    let cell = [0, 1, 2].map(|axis| (place[axis].max(0.0) as usize).min(nodes.size[axis] - 2));
    let weights: [[(usize, f64); 4]; 3] = std::array::from_fn(|axis| {
        let t = (place[axis] - cell[axis] as f64).clamp(0.0, 1.0);
        let (t2, t3) = (t * t, t * t * t);
        let mut w = [
            0.5 * (-t3 + 2.0 * t2 - t),
            0.5 * (3.0 * t3 - 5.0 * t2 + 2.0),
            0.5 * (-3.0 * t3 + 4.0 * t2 + t),
            0.5 * (t3 - t2),
        ];
        let (c, last) = (cell[axis], nodes.size[axis] - 1);
        // A node beyond the box: 2 · border − the one inside.
        if c == 0 {
            w = [0.0, w[1] + 2.0 * w[0], w[2] - w[0], w[3]];
        }
        if c + 2 > last {
            w = [w[0], w[1] - w[3], w[2] + 2.0 * w[3], 0.0];
        }
        std::array::from_fn(|n| ((c + n).saturating_sub(1).min(last), w[n]))
    });
    let mut sum = 0.0;
    for (x, wx) in weights[0] {
        for (y, wy) in weights[1] {
            let row: f64 = weights[2].iter().map(|&(z, wz)| wz * at([x, y, z])).sum();
            sum += wx * wy * row;
        }
    }
    sum
}
