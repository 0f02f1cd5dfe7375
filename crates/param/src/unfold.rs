//! (i, j) of layers whose horizons are no height fields: overturned limbs have several depths over one place on the map,
//! so the map cannot tell them apart. They are unfolded by arc length instead.
//!
//! With n the unit normal of the layering (towards k), a the axis about which it is folded, t ⟂ a, n in the layer, the
//! two functions u (along t) and v (along a) are those that minimise
//!
//! ```text
//! ∫ w²(∇u·n)² + (∇u·t − 1)² + (∇u·a)²   and   ∫ w²(∇v·n)² + (∇v·a − 1)² + (∇v·t)²
//! ```
//!
//! so lengths along a layer are kept as far as can be, and u, v do not change across it (as the coordinates of J.-L.
//! Mallet, "Space–time mathematical framework for sedimentary geology", Mathematical Geology 36(1), 2004). The axis is
//! the direction that the normals have least of. Faults break u and v, beyond their tips they are one
//! ([`model::CutLattice`]).
//!
//! That keeps lengths, but least squares weigh them against angles. So it is taken in the middle of the layer alone, and
//! carried from there along ∇k ([`crate::transport`]).
//!
//! Lengths are in metres, u and v are stored in voxels along x and y.

use crate::metric::Metric;
use crate::transport::{self, Held};
use crate::tricubic;
use crate::{LayerModel, Region};
use glam::{DMat3, DVec3, Vec3};
use model::{CutLattice, Equations, FaultNetwork};
use rayon::prelude::*;
use std::sync::Arc;
use survey::LevelField;
use survey::progress::{Cancelled, Progress};

/// What a region between surfaces of any shape has besides their distances. Memory: 8 bytes a node of the lattice, and 4 a
/// node of the weight's.
#[derive(Debug, Clone, PartialEq)]
pub struct Unfolded {
    /// The unfolded place of every voxel: i·(Nx − 1) and j·(Ny − 1).
    pub places: [LevelField; 2],
    /// ln w of k = r w / (r w + 1 − r), r the ratio of the distances from both surfaces; none where k is r itself.
    pub log_weight: Option<LevelField>,
}

impl Unfolded {
    /// All its fields, in this order.
    pub fn fields(&self) -> impl Iterator<Item = &LevelField> {
        self.places.iter().chain(&self.log_weight)
    }
}

/// The same, shared.
pub type Unfolding = Arc<Unfolded>;

/// Nodes of the lattice around the volume; a layer is solved on those that it holds.
const NODES: f64 = 100_000.0;
/// Nodes around the layer that are solved with it.
const AROUND: usize = 3;
/// Nodes of an unfolding around the volume, at most; they are no closer than [`FINEST`] cube roots of a voxel.
const FINE_NODES: f64 = 1_000_000.0;
const FINEST: f64 = 0.7;
/// Voxels around the volume in which the levels of horizons are defined.
const MARGIN: f32 = 4.0;
/// Weight w of what changes across the layering.
const ACROSS: f64 = 6.0;
/// Weight of second differences, in units of slope.
const SMOOTH: f64 = 0.08;
/// Weight with which u and v are held to x and y where nothing else holds them, as a slope over the volume.
const HELD: f64 = 1e-3;
/// Coarser lattices before the finest, each of twice the spacing of the next.
const COARSER: u32 = 2;
/// Steps of the solver on each lattice, and the share of the first gradient at which it stops.
const MOST_STEPS: usize = 200;
const TOLERANCE: f64 = 1e-3;
/// Normals nearer to the fold axis than this (sine) say nothing about the direction along the layer.
const ALONG_AXIS: f64 = 0.2;

/// What was solved for a layer.
struct Solved {
    lattice: CutLattice,
    /// u and v in metres at the nodes of the lattice, for each block.
    fields: [Vec<LevelField>; 2],
}

/// The unfolding of each of `layers` in each block. `rise` is k and its derivatives per voxel at a voxel place, of a region
/// and continued beyond it.
pub(crate) fn unfold<M: LayerModel + ?Sized>(
    model: &M,
    metric: &Metric,
    layers: &[u16],
    rise: impl Fn(Vec3, Region) -> (f32, Vec3) + Sync,
    progress: &Progress,
) -> Result<Vec<Vec<[LevelField; 2]>>, Cancelled> {
    if layers.is_empty() {
        return Ok(Vec::new());
    }
    let metres = metric.scaled_from_voxel() * metric.unit_m;
    let size = model.size();
    let last = Vec3::from_array(size.map(|n| n as f32 - 1.0));
    let region_near = |p: Vec3| model.region_at(p.clamp(Vec3::ZERO, last));
    let solved = solve(model, metric, layers, &rise, progress)?;
    let voxels = size.iter().product::<usize>() as f64;
    let count = FINE_NODES.min(voxels / FINEST.powi(3));
    let fine = CutLattice::nodes_between(Vec3::splat(-MARGIN), last + MARGIN, metres, count, 1.0, 0.5);
    let held = Held::of(fine, region_near);
    // A step from node to node.
    let longest = metric.length_squared(fine.step / 3.0f32.sqrt()).sqrt();
    let lengths = [0, 1].map(|axis| metres.col(axis).length() as f32);
    progress.begin("carrying", layers.len() as u64);
    let of_layer = |(&layer, solved): (&u16, &Solved)| {
        let of_block = |block: usize| {
            let region = Region { layer, block: block as u16 };
            let on_lattice = |p: Vec3| {
                [0, 1].map(|which: usize| tricubic::sample(&solved.fields[which][block], p).0 / lengths[which])
            };
            let is_known = |p: Vec3| solved.lattice.is_known(block, p);
            let in_middle = |p: Vec3| on_lattice(transport::middle(metric, longest, p, |p| rise(p, region), is_known));
            held.fields(region, in_middle, on_lattice)
        };
        let unfoldings = (0..model.block_count()).into_par_iter().map(of_block).collect();
        progress.step(1)?;
        Ok(unfoldings)
    };
    layers.par_iter().zip(&solved).map(of_layer).collect()
}

/// u and v by least squares, for each layer.
fn solve<M: LayerModel + ?Sized>(
    model: &M,
    metric: &Metric,
    layers: &[u16],
    rise: &(impl Fn(Vec3, Region) -> (f32, Vec3) + Sync),
    progress: &Progress,
) -> Result<Vec<Solved>, Cancelled> {
    let none = FaultNetwork::none();
    let faults = model.faults().unwrap_or(&none);
    let metres = metric.scaled_from_voxel() * metric.unit_m;
    let covector = metres.inverse().transpose();
    let last = Vec3::from_array(model.size().map(|n| n as f32 - 1.0));
    let mut found: Vec<Option<Solved>> = layers.iter().map(|_| None).collect();
    progress.begin("unfolding", layers.len() as u64 * u64::from(COARSER + 1));
    for level in (0..=COARSER).rev() {
        let nodes = CutLattice::nodes_around(model.size(), metres, NODES, f64::from(1u32 << level));
        let of_node: Vec<Region> = (0..nodes.count())
            .into_par_iter()
            .map(|node| model.region_at(nodes.place(node).clamp(Vec3::ZERO, last)))
            .collect();
        let of_layer = |(&layer, before): (&u16, Option<Solved>)| {
            let holds = |node: usize| (of_node[node].layer == layer).then(|| of_node[node].block);
            let near = CutLattice::near_blocks(faults, nodes, AROUND, holds);
            let lattice = CutLattice::of(faults, nodes, |block, node| near[block][node]);
            let normal = |block: usize, node: usize| {
                let p = lattice.middle(node);
                if !(p.cmpge(Vec3::ZERO).all() && p.cmple(last).all()) {
                    return None;
                }
                let (own, at) = (Region { layer, block: block as u16 }, model.region_at(p));
                // Beyond its faults a layer is continued.
                let (k, slope) = rise(p, own);
                let is_within = at == own || (at.block != own.block && (0.0..=1.0).contains(&k));
                is_within.then(|| (covector * slope.as_dvec3()).try_normalize()).flatten()
            };
            let of_block = |block: usize| {
                let normal = &normal;
                lattice.cells(block).map(move |node| (block, node, normal(block, node)))
            };
            let cells: Vec<Cell> = (0..lattice.blocks).flat_map(of_block).collect();
            let frame = Frame::of(metres, cells.iter().filter_map(|(_, _, normal)| *normal));
            let problem = Problem { lattice: &lattice, cells: &cells, frame: &frame, metres };
            let solved = problem.solve(before.as_ref().map(|before| &before.fields), progress)?;
            progress.step(1)?;
            let fields = [0, 1].map(|which| lattice.spread(&solved, which));
            Ok(Some(Solved { lattice, fields }))
        };
        found = layers.par_iter().zip(found).map(of_layer).collect::<Result<_, Cancelled>>()?;
    }
    Ok(found.into_iter().flatten().collect())
}

/// A cell of the lattice: block, first node, and the metric normal of the layering at its middle.
type Cell = (usize, usize, Option<DVec3>);

/// What is solved on one lattice.
struct Problem<'a> {
    lattice: &'a CutLattice,
    cells: &'a [Cell],
    frame: &'a Frame,
    metres: DMat3,
}

impl Problem<'_> {
    /// u and v in metres, from what was found on a coarser lattice. Their equations differ in the right sides alone.
    fn solve(&self, before: Option<&[Vec<LevelField>; 2]>, progress: &Progress) -> Result<Vec<[f64; 2]>, Cancelled> {
        let (lattice, voxel) = (self.lattice, self.metres.inverse());
        let step = |axis: usize| self.metres.col(axis).length() * f64::from(lattice.nodes.step[axis]);
        let spacing_m = (0..3).map(step).fold(0.0, f64::max);
        let extent_m = (0..3).map(|axis| step(axis) * lattice.nodes.size[axis] as f64).fold(0.0, f64::max);
        let mut equations = Equations::default();
        lattice.add_smoothness(SMOOTH / spacing_m, &mut equations);
        for &(block, node, normal) in self.cells {
            let Some(n) = normal else { continue };
            let mut slope = |direction: DVec3, weight: f64, right: [f64; 2]| {
                equations.add(weight, lattice.slope(block, node, direction, voxel), right);
            };
            slope(n, ACROSS, [0.0; 2]);
            if let Some([along_u, along_v]) = self.frame.along(n) {
                slope(along_u, 1.0, [1.0, 0.0]);
                slope(along_v, 1.0, [0.0, 1.0]);
            }
        }
        let on_map = lattice.guess(|_, p| {
            let p = self.metres * p.as_dvec3();
            [p.dot(self.frame.x), p.dot(self.frame.y)]
        });
        for (unknown, &at) in on_map.iter().enumerate() {
            equations.add(HELD / extent_m, [(unknown as u32, 1.0)], at);
        }
        let guess = match before {
            Some(coarse) => lattice.guess(|block, p| [0, 1].map(|n: usize| f64::from(coarse[n][block].value(p)))),
            None => on_map,
        };
        equations.solve(guess, TOLERANCE, MOST_STEPS, progress)
    }
}

/// Directions of a folded volume: the survey's own axes, and the axis of the folds.
struct Frame {
    /// Unit vectors along the inlines' and the crosslines' index.
    x: DVec3,
    y: DVec3,
    /// The fold axis, and whether u (rather than v) runs along it.
    axis: DVec3,
    axis_is_u: bool,
}

impl Frame {
    fn of(metres: DMat3, normals: impl Iterator<Item = DVec3>) -> Self {
        let (x, y) = (metres.x_axis.normalize(), metres.y_axis.normalize());
        let mut scatter = DMat3::from_diagonal(DVec3::splat(1e-9));
        let mut count: f64 = 1e-9;
        for n in normals {
            scatter += DMat3::from_cols(n * n.x, n * n.y, n * n.z);
            count += 1.0;
        }
        // Inverse iteration from y: where the layers are level, any horizontal axis is as good.
        let shifted = scatter * (1.0 / count) + DMat3::from_diagonal(DVec3::splat(1e-6));
        let inverse = shifted.inverse();
        let axis = (0..40).fold(y, |axis, _| (inverse * axis).normalize_or(y));
        let axis_is_u = axis.dot(x).abs() > axis.dot(y).abs();
        let towards = if axis_is_u { x } else { y };
        Self { x, y, axis: if axis.dot(towards) < 0.0 { -axis } else { axis }, axis_is_u }
    }

    /// The directions of u and v in a layer with normal `n`; `None` where the normal lies along the axis.
    fn along(&self, n: DVec3) -> Option<[DVec3; 2]> {
        let around = self.axis.cross(n);
        if around.length() < ALONG_AXIS {
            return None;
        }
        let around = around.normalize();
        let axis = n.cross(around).normalize();
        let axis = if axis.dot(self.axis) < 0.0 { -axis } else { axis };
        // Where the layer lies right way up and level, u runs along x and v along y.
        let up = -DVec3::Z;
        let level = self.axis.cross(up);
        let other = if self.axis_is_u { self.y } else { self.x };
        let around = if level.dot(other) < 0.0 { -around } else { around };
        Some(if self.axis_is_u { [axis, around] } else { [around, axis] })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn directions_turn_with_the_layer_around_the_axis() {
        // Folded about the crosslines' axis.
        let normal = |turn: f64| DVec3::new(turn.sin(), 0.0, -turn.cos());
        let turns = || (0..20).map(|n| f64::from(n) * 0.1 - 0.4);
        let frame = Frame::of(DMat3::IDENTITY, turns().map(normal));
        assert!(!frame.axis_is_u && frame.axis.abs_diff_eq(DVec3::Y, 1e-6), "{}", frame.axis);
        for turn in turns() {
            let [u, v] = frame.along(normal(turn)).unwrap();
            assert!(v.abs_diff_eq(DVec3::Y, 1e-9));
            assert!(u.abs_diff_eq(DVec3::new(turn.cos(), 0.0, turn.sin()), 1e-9), "{turn}: {u}");
        }
        assert!(frame.along(DVec3::Y).is_none());
        // Level layers: u along x, v along y.
        let level = Frame::of(DMat3::IDENTITY, std::iter::repeat_n(-DVec3::Z, 9));
        let [u, v] = level.along(-DVec3::Z).unwrap();
        assert!(u.abs_diff_eq(DVec3::X, 1e-6) && v.abs_diff_eq(DVec3::Y, 1e-6), "{u} {v}");
    }
}
