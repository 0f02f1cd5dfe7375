//! Harmonic k: ∇²k = 0 between two sheets, as steady heat flows from one to the other.
//!
//! k = 0 on the bottom sheet and 1 on the top one. Where a layer is open, the missing sheet is a plane far away, through
//! which the flow is even: ∂k/∂n = 1/T. There, k is the distance to a calm horizon over the reference thickness T;
//! roughness of length λ has died out by exp(−2πd/λ) at the distance d, as in the upward continuation of a potential
//! field.
//!
//! Each fault block is solved alone, on sheets that continue past its faults and the outer boundary. At the sides k
//! continues as the sheets do (∂(k − v)/∂x = 0 at constant v). A literal ∂k/∂n = 0 on an inclined fault or on the side of
//! a block of dipping beds would turn every bed until it meets that face at a right angle.
//!
//! The lattice is solved from coarse to fine ([`STAGES`]). On each stage, columns of nodes are solved exactly one after the
//! other while their neighbours are kept (line relaxation), in four colours, so that the result does not depend on the
//! number of threads. A layer is thin, so most of the coupling is within its columns.

use super::sigma::SigmaLayer;
use rayon::prelude::*;
use survey::{Cancelled, Progress};

/// Strides of the stages over that of the finest, and the relaxations on each.
pub const STAGES: [(usize, usize); 5] = [(16, 96), (8, 48), (4, 24), (2, 12), (1, 6)];

/// Where k is known.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Ends {
    /// On both sheets.
    Both,
    /// On the bottom sheet. Beyond the top, k grows by this much per voxel along z.
    Bottom(f32),
    /// On the top sheet. Beyond the bottom, k falls by this much per voxel along z.
    Top(f32),
}

impl Ends {
    /// k of parallel beds in a column of this thickness.
    fn guess(self, v: f32, thickness: f32) -> f32 {
        match self {
            Self::Both => v,
            Self::Bottom(rate) => v * thickness * rate,
            Self::Top(rate) => 1.0 - (1.0 - v) * thickness * rate,
        }
    }

    /// By how much `guess` grows for a voxel of thickness.
    fn guess_slope(self, v: f32) -> f32 {
        match self {
            Self::Both => 0.0,
            Self::Bottom(rate) => v * rate,
            Self::Top(rate) => (v - 1.0) * rate,
        }
    }
}

/// Solves for k at the nodes of `layer(stride)`, `[x][y][level]`; `finest` is the last stride.
///
/// # Errors
/// [`Cancelled`].
pub fn solve(
    finest: usize,
    ends: Ends,
    layer: impl Fn(usize) -> SigmaLayer,
    progress: &Progress,
) -> Result<(SigmaLayer, Vec<f32>), Cancelled> {
    let mut coarse: Option<(SigmaLayer, Vec<f32>)> = None;
    for (factor, sweeps) in STAGES {
        let layer = layer(finest * factor);
        let mut k = match &coarse {
            None => first_guess(&layer, ends),
            Some((known, k)) => refined(&layer, known, k, ends),
        };
        for _ in 0..sweeps {
            progress.check()?;
            relax(&layer, ends, &mut k);
        }
        coarse = Some((layer, k));
    }
    Ok(coarse.expect("there are stages"))
}

/// Parallel beds.
pub fn first_guess(layer: &SigmaLayer, ends: Ends) -> Vec<f32> {
    let at = |n: usize| ends.guess(layer.v(n % layer.levels), layer.thickness(n / layer.levels));
    (0..layer.size[0] * layer.size[1] * layer.levels).map(at).collect()
}

/// The departure from parallel beds, interpolated linearly to a finer lattice.
fn refined(fine: &SigmaLayer, coarse: &SigmaLayer, k: &[f32], ends: Ends) -> Vec<f32> {
    let levels = fine.levels;
    let mut out = first_guess(fine, ends);
    let place = |axis: usize, n: usize| {
        let voxel = fine.origin[axis] + (n * fine.stride) as i32;
        let at = (voxel - coarse.origin[axis]) as f32 / coarse.stride as f32;
        let at = at.clamp(0.0, (coarse.size[axis] - 1) as f32);
        let cell = (at as usize).min(coarse.size[axis] - 2);
        (cell, at - cell as f32)
    };
    out.par_chunks_mut(levels).enumerate().for_each(|(node, column)| {
        let ((x, fx), (y, fy)) = (place(0, node / fine.size[1]), place(1, node % fine.size[1]));
        for (a, wx) in [(0, 1.0 - fx), (1, fx)] {
            for (b, wy) in [(0, 1.0 - fy), (1, fy)] {
                let from = (x + a) * coarse.size[1] + y + b;
                for (level, value) in column.iter_mut().enumerate() {
                    let parallel = ends.guess(coarse.v(level), coarse.thickness(from));
                    *value += wx * wy * (k[from * levels + level] - parallel);
                }
            }
        }
    });
    out
}

/// One relaxation of all columns.
pub fn relax(layer: &SigmaLayer, ends: Ends, k: &mut [f32]) {
    let ([nx, ny], levels) = (layer.size, layer.levels);
    for colour in 0..4 {
        let columns: Vec<usize> = (colour / 2..nx)
            .step_by(2)
            .flat_map(|x| (colour % 2..ny).step_by(2).map(move |y| x * ny + y))
            .collect();
        let solved: Vec<Vec<f32>> = columns.par_iter().map(|&node| column(layer, ends, k, node)).collect();
        for (node, column) in columns.into_iter().zip(solved) {
            k[node * levels..(node + 1) * levels].copy_from_slice(&column);
        }
    }
}

/// The four columns beside a node, or what stands for them outside.
struct Beside<'a> {
    k: &'a [f32],
    levels: usize,
    ends: Ends,
    nodes: [[Option<usize>; 2]; 2],
    /// Step of the thickness from the node to the next one along each axis.
    growth: [f32; 2],
}

impl Beside<'_> {
    /// k before and after the node along an axis.
    #[inline]
    fn pair(&self, axis: usize, level: usize) -> [f32; 2] {
        let at = |node: usize| self.k[node * self.levels + level];
        let v = level as f32 / (self.levels - 1) as f32;
        // Outside, k − guess is that of the other side.
        let mirrored = |node: usize, sign: f32| at(node) + sign * 2.0 * self.growth[axis] * self.ends.guess_slope(v);
        match self.nodes[axis] {
            [Some(before), Some(after)] => [at(before), at(after)],
            [None, Some(after)] => [mirrored(after, -1.0), at(after)],
            [Some(before), None] => [at(before), mirrored(before, 1.0)],
            [None, None] => unreachable!("a lattice has at least three nodes along each axis"),
        }
    }
}

/// The column that solves ∇²k = 0 at its levels while its neighbours stay.
fn column(layer: &SigmaLayer, ends: Ends, k: &[f32], node: usize) -> Vec<f32> {
    let levels = layer.levels;
    let (h, step) = (layer.stride as f32, layer.v(1));
    let (per_h, per_step) = (1.0 / h, 1.0 / step);
    let growth = layer.thickness_slope(node).map(|slope| slope * h);
    let beside = Beside { k, levels, ends, nodes: [layer.beside(node, 0), layer.beside(node, 1)], growth };
    let metric = layer.inverse;
    let (xx, yy, xy) = (metric.x_axis.x * per_h * per_h, metric.y_axis.y * per_h * per_h, metric.x_axis.y);
    let mixed = |level: usize| match beside.nodes {
        // In a sheared survey only, and only inside.
        [[Some(west), Some(east)], [Some(_), Some(_)]] if xy != 0.0 => {
            let at = |node: usize| k[node * levels + level];
            0.5 * xy * per_h * per_h * (at(east + 1) - at(east - 1) - at(west + 1) + at(west - 1))
        }
        _ => 0.0,
    };
    let [tx, ty] = layer.thickness_slope(node);
    // Rows of the tridiagonal system: below, diagonal, above, right-hand side.
    let row = |level: usize| -> [f32; 4] {
        let is_far = |last: bool| match ends {
            Ends::Both => None,
            Ends::Bottom(rate) => (last && level + 1 == levels).then_some(rate),
            Ends::Top(rate) => (!last && level == 0).then_some(rate),
        };
        let far = is_far(true).or(is_far(false));
        if (level == 0 || level + 1 == levels) && far.is_none() {
            return [0.0, 1.0, 0.0, if level == 0 { 0.0 } else { 1.0 }];
        }
        let terms = layer.terms(node, level);
        let [west, east] = beside.pair(0, level);
        let [south, north] = beside.pair(1, level);
        let lateral = xx * (west + east) + yy * (south + north) + mixed(level);
        let across = terms.across * per_step * per_step;
        let diagonal = -2.0 * (across + xx + yy);
        if let Some(rate) = far {
            // ∂k/∂n is that of parallel beds; a level outside continues k accordingly.
            let slopes = [(east - west) * 0.5 * per_h, (north - south) * 0.5 * per_h];
            let along = terms.cross.x * slopes[0] + terms.cross.y * slopes[1];
            let normal = layer.thickness(node) * rate - along / terms.across;
            let twist = 2.0 * (terms.cross.x * tx + terms.cross.y * ty) * rate;
            let sign = if level == 0 { -1.0 } else { 1.0 };
            let known = lateral + twist + terms.drift * normal + sign * 2.0 * across * step * normal;
            return if level == 0 { [0.0, diagonal, 2.0 * across, -known] } else { [2.0 * across, diagonal, 0.0, -known] };
        }
        let [west_low, east_low] = beside.pair(0, level - 1);
        let [west_high, east_high] = beside.pair(0, level + 1);
        let [south_low, north_low] = beside.pair(1, level - 1);
        let [south_high, north_high] = beside.pair(1, level + 1);
        let twist = terms.cross.x * (east_high - east_low - west_high + west_low)
            + terms.cross.y * (north_high - north_low - south_high + south_low);
        // Limited so that both off-diagonals stay positive.
        let drift = (0.5 * terms.drift * per_step).clamp(-0.95 * across, 0.95 * across);
        [across - drift, diagonal, across + drift, -(lateral + 0.5 * per_h * per_step * twist)]
    };
    tridiagonal(levels, row)
}

/// Thomas' algorithm.
fn tridiagonal(count: usize, row: impl Fn(usize) -> [f32; 4]) -> Vec<f32> {
    let mut above = vec![0.0f32; count];
    let mut value = vec![0.0f32; count];
    let (mut last_above, mut last_value) = (0.0, 0.0);
    for n in 0..count {
        let [low, diagonal, high, right] = row(n);
        let scale = 1.0 / (diagonal - low * last_above);
        (last_above, last_value) = (high * scale, (right - low * last_value) * scale);
        (above[n], value[n]) = (last_above, last_value);
    }
    for n in (0..count - 1).rev() {
        value[n] -= above[n] * value[n + 1];
    }
    value
}
