//! k as the flow of a layer: smooth everywhere, and without creases.
//!
//! [`fill`] computes k on a lattice in (x, y, v) between the two sheets of a region, by [`harmonic`] or as v itself;
//! [`lines`] follows the curves along ∇k from every node to the middle; both are interpolated into the region's
//! stratigraphic grid. k is 0 and 1 on the sheets by construction, at any resolution of the lattice.
//!
//! The sheets are calm: [`calm`] takes off what is smaller than a pattern's tile. The boundary of the layer, where it is
//! drawn, stays the horizon as it was picked.

pub mod calm;
pub mod harmonic;
pub mod lines;
pub mod sigma;

use crate::compute::ComputeCost;
use crate::grid::RegionGrid;
use crate::metric::Metric;
use harmonic::Ends;
use rayon::prelude::*;
use sigma::SigmaLayer;
use std::time::Instant;
use survey::{Cancelled, Progress};

/// Voxels between the nodes of the lattice. k and the curves are smooth: on folds 80 voxels long, angles off by more than
/// 1° are no more frequent than with one node a voxel.
const STRIDE: usize = 2;

/// How k runs between the sheets of a region.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Flow {
    /// ∇²k = 0.
    Harmonic(Ends),
    /// k = v, the vertical fraction.
    Vertical,
}

/// Fills `grid.offsets` from a flow between two sheets, given by voxel z at a voxel column.
///
/// # Errors
/// [`Cancelled`].
pub fn fill(
    grid: &mut RegionGrid,
    flow: Flow,
    metric: &Metric,
    bottom: impl Fn(i32, i32) -> f32,
    top: impl Fn(i32, i32) -> f32,
    progress: &Progress,
) -> Result<ComputeCost, Cancelled> {
    let levels = grid.levels;
    let end: [i32; 2] = std::array::from_fn(|n| grid.origin[n] + grid.size[n] as i32);
    let layer = |stride: usize| SigmaLayer::new([grid.origin, end], stride, levels, &bottom, &top, metric);
    let start = Instant::now();
    let (lattice, k) = match flow {
        Flow::Harmonic(ends) => harmonic::solve(STRIDE, ends, layer, progress)?,
        Flow::Vertical => {
            let lattice = layer(STRIDE);
            let k = harmonic::first_guess(&lattice, Ends::Both);
            (lattice, k)
        }
    };
    let solved = Instant::now();
    let lines = lines::to_middle(&lattice, &k, progress)?;
    let nodes: Vec<[f32; 3]> =
        lines.iter().zip(&k).enumerate().map(|(n, (d, k))| [d[0], d[1], k - lattice.v(n % levels)]).collect();
    grid.offsets = sampled(grid, &lattice, &nodes, progress)?;
    grid.creases = vec![0; grid.offsets.len().div_ceil(64)];
    let threads = rayon::current_num_threads() as u32;
    Ok(ComputeCost { closest_points: (solved - start) * threads, traces: solved.elapsed() * threads })
}

/// The nodes of the lattice interpolated at all columns of the grid, by cubics.
fn sampled(
    grid: &RegionGrid,
    lattice: &SigmaLayer,
    nodes: &[[f32; 3]],
    progress: &Progress,
) -> Result<Vec<[f32; 3]>, Cancelled> {
    let ([nx, ny], levels) = (grid.size, grid.levels);
    let mut offsets = vec![[0.0f32; 3]; nx * ny * levels];
    let place = |axis: usize, n: usize| {
        let at = (grid.origin[axis] - lattice.origin[axis]) as usize + n;
        // The lattice reaches one node past the grid.
        let cell = (at / lattice.stride).min(lattice.size[axis] - 2);
        (cell, lines::catmull_rom((at - cell * lattice.stride) as f32 / lattice.stride as f32))
    };
    offsets.par_chunks_mut(ny * levels).enumerate().try_for_each(|(x, row)| {
        let (cell_x, wx) = place(0, x);
        for (y, column) in row.chunks_mut(levels).enumerate() {
            let (cell_y, wy) = place(1, y);
            for (a, wx) in wx.iter().enumerate() {
                let u = (cell_x + a).saturating_sub(1).min(lattice.size[0] - 1);
                for (b, wy) in wy.iter().enumerate() {
                    let weight = wx * wy;
                    if weight == 0.0 {
                        continue;
                    }
                    let v = (cell_y + b).saturating_sub(1).min(lattice.size[1] - 1);
                    let from = (u * lattice.size[1] + v) * levels;
                    for (out, node) in column.iter_mut().zip(&nodes[from..from + levels]) {
                        out.iter_mut().zip(node).for_each(|(out, node)| *out += weight * node);
                    }
                }
            }
        }
        progress.step(1)
    })?;
    Ok(offsets)
}
