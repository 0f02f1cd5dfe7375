//! k as the flow of a layer: smooth everywhere, and without creases.
//!
//! [`fill`] computes k on a lattice in (x, y, v) between the two sheets of a region, by [`harmonic`] or as v itself;
//! [`lines`] follows the curves along ∇k from every node to one level; both are interpolated into the region's
//! stratigraphic grid. k is 0 and 1 on the sheets by construction, at any resolution of the lattice.
//!
//! The sheets are calm: [`calm`] takes off what is smaller than a pattern's tile. The boundary of the layer, where it is
//! drawn, stays the horizon as it was picked.

pub(crate) mod calm;
pub(crate) mod harmonic;
pub(crate) mod lines;
pub(crate) mod sigma;

use crate::compute::ComputeCost;
use crate::grid::RegionGrid;
use crate::metric::Metric;
use harmonic::{Ends, Spacing};
use rayon::prelude::*;
use sigma::{FlowLattice, SigmaLayer};
use std::time::Instant;
use survey::{Cancelled, Progress};

/// Voxels between the nodes of the lattice, by the length (voxels) of the shortest waves of its sheets: eight nodes a wave,
/// but at most 4 voxels. Where the sheets are not calm it is 2, with which angles on folds 80 voxels long are as exact as
/// with 1.
pub(crate) fn stride(wave: f64) -> usize {
    ((wave / 8.0) as usize).clamp(2, 4)
}

/// Where (i, j) of an open layer are the place itself: the share of the way from its horizon to the far plane. Lines of flow
/// spread or crowd most at the horizon; a level nearer to it leaves half of that for either side.
const OPEN_FIRST: f32 = 0.2;

/// How k runs between the sheets of a region.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Flow {
    /// Along the directions of ∇²k = 0.
    Smooth(Ends, Spacing),
    /// k = v, the vertical fraction.
    Vertical,
}

impl Flow {
    /// The level, of so many, on which (i, j) are the place itself: the middle one of a closed layer.
    pub(crate) fn first_level(self, levels: usize) -> usize {
        let last = levels - 1;
        let from_horizon = (OPEN_FIRST * last as f32).round() as usize;
        match self {
            Self::Smooth(Ends::Bottom(_), _) => from_horizon,
            Self::Smooth(Ends::Top(_), _) => last - from_horizon,
            Self::Smooth(Ends::Both, _) | Self::Vertical => last / 2,
        }
    }
}

/// Fills `grid.offsets` from a flow between two sheets (bottom, top), given by voxel z at voxel (x, y).
///
/// # Errors
/// [`Cancelled`].
pub(crate) fn fill(
    grid: &mut RegionGrid,
    flow: Flow,
    stride: usize,
    metric: &Metric,
    sheets: [&(dyn Fn(f32, f32) -> f32 + Sync); 2],
    progress: &Progress,
) -> Result<ComputeCost, Cancelled> {
    let levels = grid.levels;
    let finest = FlowLattice::new(grid.origin, grid.size, stride);
    let layer = |lattice: FlowLattice| SigmaLayer::new(lattice, levels, sheets, metric);
    let start = Instant::now();
    let (layer, k) = match flow {
        Flow::Smooth(ends, spacing) => harmonic::solve(finest, ends, spacing, layer, progress)?,
        Flow::Vertical => {
            let layer = layer(finest);
            let k = harmonic::first_guess(&layer, Ends::Both);
            (layer, k)
        }
    };
    let solved = Instant::now();
    let mut lines = vec![[0.0f32; 2]; k.len()];
    lines::trace(&layer, &k, flow.first_level(levels), |_, _| true, &mut lines, progress)?;
    let nodes: Vec<[f32; 3]> =
        lines.iter().zip(&k).enumerate().map(|(n, (d, k))| [d[0], d[1], k - layer.v(n % levels)]).collect();
    grid.offsets = sampled(grid, &layer.lattice, stride, &nodes, progress)?;
    grid.creases = vec![0; grid.offsets.len().div_ceil(64)];
    let threads = rayon::current_num_threads() as u32;
    Ok(ComputeCost { closest_points: (solved - start) * threads, traces: solved.elapsed() * threads })
}

/// The nodes of the lattice interpolated at all columns of the grid, by cubics.
fn sampled(
    grid: &RegionGrid,
    lattice: &FlowLattice,
    stride: usize,
    nodes: &[[f32; 3]],
    progress: &Progress,
) -> Result<Vec<[f32; 3]>, Cancelled> {
    let ([nx, ny], levels) = (grid.size, grid.levels);
    let mut offsets = vec![[0.0f32; 3]; nx * ny * levels];
    let place = |axis: usize, n: usize| {
        let at = (grid.origin[axis] - lattice.origin[axis]) as usize + n;
        // The lattice reaches one node past the grid.
        let cell = (at / stride).min(lattice.size[axis] - 2);
        (cell, lines::catmull_rom((at - cell * stride) as f32 / stride as f32))
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
