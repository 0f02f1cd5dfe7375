//! Harmonic k between surfaces of any shape: ∇²k = 0, as steady heat flows from one to the other ([`crate::flow`] has it
//! between height fields).
//!
//! What is solved on a lattice is neither 0 nor 1 exactly on surfaces that pass between its nodes. So not k is kept, but
//! the weight w by which it differs from the ratio r of the distances from both surfaces:
//!
//! ```text
//! k = r w / (r w + 1 − r)        ln w = ln(k / (1 − k)) − ln(r / (1 − r))
//! ```
//!
//! w is positive and smooth, so k is 0 and 1 on the surfaces at any resolution of the lattice, and rises from one to the
//! other. Beyond them it goes on with the slope that it has there.
//!
//! # The equations
//! Second differences along the three axes (lines are taken to be perpendicular), with arms that end on a surface where
//! one passes between two nodes (G. H. Shortley and R. Weller, "The numerical solution of Laplace's equation", Journal of
//! Applied Physics 9, 1938). At the sides of the volume, and a little beyond faults, k goes on as r does: a literal
//! ∂k/∂n = 0 would turn every bed until it meets that face at a right angle. Beyond the tips of faults the blocks are one
//! ([`CutLattice`]).
//!
//! Nodes of one colour of a chequerboard are relaxed after those of the other, so that the result does not depend on the
//! number of threads.

use crate::{LayerModel, Region};
use glam::Vec3;
use model::{CutLattice, FaultNetwork, NodeBox};
use rayon::prelude::*;
use survey::LevelField;
use survey::progress::{Cancelled, Progress};

/// Nodes of the lattice around the volume.
const NODES: f64 = 250_000.0;
/// Nodes around the layer that are solved with it.
const AROUND: usize = 3;
/// The shortest arm, as a share of the spacing.
const SHORTEST: f64 = 0.05;
/// Over-relaxation: how much of the way to its solution a node goes.
const OVER: f64 = 1.6;
/// Relaxations, at most, and the change of k at which they end.
const MOST: usize = 400;
const TOLERANCE: f64 = 2e-5;
/// Nearer to a surface than this share of the layer, w is that of nodes farther away: there r and k differ by too little.
const NEAR: f64 = 0.04;
/// The largest ln w.
const LARGEST: f64 = 3.0;

/// An equation of the lattice: diagonal · k = right + Σ coefficient · k of others.
#[derive(Default)]
struct Row {
    diagonal: f64,
    right: f64,
    others: Vec<(u32, f64)>,
}

/// ln w of one layer in each block. `ratio` is r at a voxel place, of a region and continued beyond it.
pub(crate) fn log_weights<M: LayerModel + ?Sized>(
    model: &M,
    layer: u16,
    ratio: impl Fn(Vec3, Region) -> f32 + Sync,
    progress: &Progress,
) -> Result<Vec<LevelField>, Cancelled> {
    let none = FaultNetwork::none();
    let faults = model.faults().unwrap_or(&none);
    let last = Vec3::from_array(model.size().map(|n| n as f32 - 1.0));
    let nodes = CutLattice::nodes_around(model.size(), model.metric(), NODES, 1.0);
    let holds = |node: usize| {
        let region = model.region_at(nodes.place(node).clamp(Vec3::ZERO, last));
        (region.layer == layer).then_some(region.block)
    };
    let near = CutLattice::near_blocks(faults, nodes, AROUND, holds);
    let lattice = CutLattice::of(faults, nodes, |block, node| near[block][node]);
    // r where it is asked for: at nodes that are solved, and beside them.
    let of_block = |block: usize| {
        let region = Region { layer, block: block as u16 };
        let is_wide = |node: usize| near[block][node] || nodes.beside(node).any(|m| near[block][m]);
        let at = |node: usize| if is_wide(node) { f64::from(ratio(nodes.place(node), region)) } else { f64::NAN };
        (0..nodes.count()).into_par_iter().map(at).collect()
    };
    let ratios: Vec<Vec<f64>> = (0..lattice.blocks).map(of_block).collect();
    let steps = [0, 1, 2].map(|axis| model.metric().col(axis).length() * f64::from(nodes.step[axis]));
    let mut rows: Vec<Row> = (0..lattice.unknowns).map(|_| Row::default()).collect();
    let mut places: Vec<[f64; 2]> = vec![[f64::NAN; 2]; lattice.unknowns];
    let mut colours: [Vec<usize>; 2] = [Vec::new(), Vec::new()];
    for (block, ratios) in ratios.iter().enumerate() {
        for (node, &r) in ratios.iter().enumerate().filter(|(_, r)| is_inside(**r)) {
            let unknown = lattice.unknown(block, node) as usize;
            let Some(row) = rows.get_mut(unknown) else { continue };
            if places[unknown][0].is_nan() {
                places[unknown] = [r; 2];
                colours[nodes.index(node).iter().sum::<usize>() % 2].push(unknown);
            }
            (0..3).for_each(|axis| row.add(&lattice, block, node, ratios, axis, steps[axis]));
        }
    }
    relax(&rows, &colours, &mut places, progress)?;
    let weight = |[r, k]: &[f64; 2]| {
        let is_clear = (NEAR..=1.0 - NEAR).contains(r);
        let odds = |share: f64| (share / (1.0 - share)).ln();
        [if is_clear { (odds(k.clamp(1e-3, 0.999)) - odds(*r)).clamp(-LARGEST, LARGEST) } else { f64::NAN }]
    };
    let weights: Vec<[f64; 1]> = places.iter().map(weight).collect();
    let fields = lattice.spread(&weights, 0);
    Ok(fields.iter().zip(&near).map(|(field, near)| cropped(field, nodes, near)).collect())
}

fn is_inside(r: f64) -> bool {
    r > 0.0 && r < 1.0
}

impl Row {
    /// Adds the second difference along an axis.
    fn add(&mut self, lattice: &CutLattice, block: usize, node: usize, ratios: &[f64], axis: usize, step: f64) {
        let nodes = lattice.nodes;
        let stride = [nodes.size[1] * nodes.size[2], nodes.size[2], 1][axis];
        let index = nodes.index(node)[axis];
        let beside =
            [(index > 0).then(|| node.wrapping_sub(stride)), (index + 1 < nodes.size[axis]).then_some(node + stride)];
        let own = ratios[node];
        let known = beside.map(|m| m.map(|m| ratios[m]).filter(|r| r.is_finite()));
        let arms = known.map(|r| match r {
            Some(r) if r <= 0.0 => (own / (own - r)).max(SHORTEST),
            Some(r) if r >= 1.0 => ((1.0 - own) / (r - own)).max(SHORTEST),
            _ => 1.0,
        });
        let sum = arms[0] + arms[1];
        for side in 0..2 {
            let coefficient = 2.0 / (arms[side] * sum * step * step);
            let unknown = beside[side].map_or(u32::MAX, |m| lattice.unknown(block, m));
            match known[side] {
                Some(r) if !is_inside(r) => {
                    self.diagonal += coefficient;
                    self.right += if r >= 1.0 { coefficient } else { 0.0 };
                }
                Some(_) if (unknown as usize) < lattice.unknowns => {
                    self.diagonal += coefficient;
                    self.others.push((unknown, coefficient));
                }
                // k goes on as r does; where not even r is known, as on the other side.
                Some(r) => self.right += coefficient * (r - own),
                None => self.right += coefficient * known[1 - side].map_or(0.0, |r| own - r),
            }
        }
    }
}

/// Relaxes k, the second of each place, from r, the first.
fn relax(
    rows: &[Row],
    colours: &[Vec<usize>; 2],
    places: &mut [[f64; 2]],
    progress: &Progress,
) -> Result<(), Cancelled> {
    for _ in 0..MOST {
        progress.check()?;
        let mut largest = 0.0f64;
        for colour in colours {
            let solved = |&unknown: &usize| {
                let row = &rows[unknown];
                if row.diagonal <= 0.0 {
                    return places[unknown][1];
                }
                let others: f64 = row.others.iter().map(|&(other, c)| c * places[other as usize][1]).sum();
                let exact = (row.right + others) / row.diagonal;
                let before = places[unknown][1];
                (before + OVER * (exact - before)).clamp(0.0, 1.0)
            };
            let next: Vec<f64> = colour.par_iter().map(solved).collect();
            for (&unknown, k) in colour.iter().zip(next) {
                largest = largest.max((k - places[unknown][1]).abs());
                places[unknown][1] = k;
            }
        }
        if largest < TOLERANCE {
            break;
        }
    }
    Ok(())
}

/// The part of a field around the nodes that are near a layer.
fn cropped(field: &LevelField, nodes: NodeBox, near: &[bool]) -> LevelField {
    let (mut low, mut high) = ([usize::MAX; 3], [0; 3]);
    for node in (0..near.len()).filter(|&node| near[node]) {
        let index = nodes.index(node);
        low = [0, 1, 2].map(|axis| low[axis].min(index[axis]));
        high = [0, 1, 2].map(|axis| high[axis].max(index[axis]));
    }
    if low[0] == usize::MAX {
        return LevelField { size: [2; 3], values: vec![0.0; 8], ..field.clone() };
    }
    let high: [usize; 3] = std::array::from_fn(|axis| high[axis].max(low[axis] + 1).min(nodes.size[axis] - 1));
    let low: [usize; 3] = std::array::from_fn(|axis| low[axis].min(high[axis] - 1));
    let size: [usize; 3] = std::array::from_fn(|axis| high[axis] - low[axis] + 1);
    let first = (low[0] * nodes.size[1] + low[1]) * nodes.size[2] + low[2];
    let value = |n: usize| {
        let [x, y, z] = [n / (size[1] * size[2]), n / size[2] % size[1], n % size[2]];
        field.values[first + (x * nodes.size[1] + y) * nodes.size[2] + z]
    };
    let values = (0..size.iter().product()).map(value).collect();
    LevelField { origin: nodes.place(first), step: field.step, size, values }
}

/// k and its derivatives per voxel, from r and its, and ln w and its.
pub(crate) fn weighed((r, to_r): (f32, Vec3), (log, to_log): (f32, Vec3)) -> (f32, Vec3) {
    let w = log.exp();
    let within = r.clamp(0.0, 1.0);
    let sum = within * w + 1.0 - within;
    let k = within * w / sum;
    let slope = (to_r + to_log * (within * (1.0 - within))) * (w / (sum * sum));
    let beyond = if r < 0.0 { r * w } else { (r - within) / w };
    (k + beyond, slope)
}

#[cfg(test)]
mod tests;
