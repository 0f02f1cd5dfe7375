//! Where the curves along ∇k cross one level of their layer (P-illus 3.1: its middle), for all nodes at once.
//!
//! In (x, y, v) the curve through a point moves by w = (H∇k)ₓᵧ / (∇v·H∇k) voxels for a unit of v. From the level where the
//! offset d to the crossing is 0, levels are visited outwards:
//!
//! ```text
//! d(p, v) = δ + d(p + δ, v')        δ = ½ (w(p, v) + w(p + w Δv, v')) Δv
//! ```
//!
//! with v' the next level towards the first (Heun's method; d is interpolated by cubics). Each level is one lookup a
//! node, where a trace of its own for each node takes one for every level on its way. As the curves of a solved k neither
//! cross nor jump, there are no creases.

use super::sigma::SigmaLayer;
use rayon::prelude::*;
use survey::{Cancelled, Progress};

/// Puts the offset in voxels (x, y) from each node to the crossing of its curve with the level `first` into `offsets`,
/// `[x][y][level]`, where `is_traced` (node, level) says so. The others are taken as they are, and so is `first`.
///
/// # Errors
/// [`Cancelled`].
pub(crate) fn trace(
    layer: &SigmaLayer,
    k: &[f32],
    first: usize,
    is_traced: impl Fn(usize, usize) -> bool + Sync,
    offsets: &mut [[f32; 2]],
    progress: &Progress,
) -> Result<(), Cancelled> {
    let levels = layer.levels;
    let nodes = layer.lattice.size[0] * layer.lattice.size[1];
    let speeds = |level: usize| -> Vec<[f32; 2]> {
        (0..nodes).into_par_iter().map(|node| speed(layer, k, node, level)).collect()
    };
    let (above, below) = (first + 1..levels, (0..first).rev());
    for (outwards, order) in [(1isize, above.collect::<Vec<_>>()), (-1, below.collect())] {
        // Offsets and speeds of the level that was visited last.
        let mut known: Vec<[f32; 2]> = (0..nodes).map(|node| offsets[node * levels + first]).collect();
        let mut ahead = speeds(first);
        let step = -(outwards as f32) * layer.v(1);
        for level in order {
            progress.check()?;
            let own = speeds(level);
            let traced = |node: usize| {
                if !is_traced(node, level) {
                    return offsets[node * levels + level];
                }
                let w = own[node];
                let second = linear(layer, &ahead, node, w.map(|w| w * step));
                let delta: [f32; 2] = std::array::from_fn(|n| 0.5 * (w[n] + second[n]) * step);
                let rest = cubic(layer, &known, node, delta);
                std::array::from_fn(|n| delta[n] + rest[n])
            };
            let here: Vec<[f32; 2]> = (0..nodes).into_par_iter().map(traced).collect();
            here.iter().enumerate().for_each(|(node, offset)| offsets[node * levels + level] = *offset);
            (known, ahead) = (here, own);
        }
    }
    Ok(())
}

/// w at a node: voxels along x and y for a unit of v.
fn speed(layer: &SigmaLayer, k: &[f32], node: usize, level: usize) -> [f32; 2] {
    let gradient = layer.gradient(k, node, level);
    let raised = layer.inverse * gradient;
    let climb = layer.terms(node, level).slope.dot(raised);
    // k rises through the layer; where it does not by rounding alone, the layer has no extent.
    if climb > 1e-12 { [raised.x / climb, raised.y / climb] } else { [0.0; 2] }
}

/// The cell and fraction of a node moved by voxels, along one axis.
#[inline]
fn moved(layer: &SigmaLayer, node: usize, by: f32, axis: usize) -> (isize, f32) {
    let ny = layer.lattice.size[1];
    let n = if axis == 0 { node / ny } else { node % ny };
    let at = (n as f32 + by / layer.lattice.spacing[axis]).clamp(0.0, (layer.lattice.size[axis] - 1) as f32);
    let cell = (at as usize).min(layer.lattice.size[axis] - 2);
    (cell as isize, at - cell as f32)
}

fn linear(layer: &SigmaLayer, values: &[[f32; 2]], node: usize, by: [f32; 2]) -> [f32; 2] {
    let ((x, fx), (y, fy)) = (moved(layer, node, by[0], 0), moved(layer, node, by[1], 1));
    weighted(layer, values, [x, y], &[1.0 - fx, fx], &[1.0 - fy, fy])
}

fn cubic(layer: &SigmaLayer, values: &[[f32; 2]], node: usize, by: [f32; 2]) -> [f32; 2] {
    let ((x, fx), (y, fy)) = (moved(layer, node, by[0], 0), moved(layer, node, by[1], 1));
    weighted(layer, values, [x - 1, y - 1], &catmull_rom(fx), &catmull_rom(fy))
}

/// Catmull–Rom weights at fraction t of a cell.
#[inline]
pub(crate) fn catmull_rom(t: f32) -> [f32; 4] {
    let (t2, t3) = (t * t, t * t * t);
    [0.5 * (2.0 * t2 - t - t3), 0.5 * (3.0 * t3 - 5.0 * t2 + 2.0), 0.5 * (4.0 * t2 + t - 3.0 * t3), 0.5 * (t3 - t2)]
}

/// The sum of node values from `first` on with weights along x and y; nodes outside repeat the border.
#[inline]
fn weighted(layer: &SigmaLayer, values: &[[f32; 2]], first: [isize; 2], wx: &[f32], wy: &[f32]) -> [f32; 2] {
    let [nx, ny] = layer.lattice.size.map(|n| n as isize);
    let mut sum = [0.0; 2];
    for (a, wx) in (0..).zip(wx) {
        let row = (first[0] + a).clamp(0, nx - 1) * ny;
        for (b, wy) in (0..).zip(wy) {
            let value = values[(row + (first[1] + b).clamp(0, ny - 1)) as usize];
            sum = [sum[0] + wx * wy * value[0], sum[1] + wx * wy * value[1]];
        }
    }
    sum
}
