//! Harmonic k: ∇²k = 0 between two sheets, as steady heat flows from one to the other.
//!
//! k = 0 on the bottom sheet and 1 on the top one. Where a layer is open, the missing sheet is a plane far away, through
//! which the flow is even: ∂k/∂n = 1/T. There, k is the distance to a calm horizon over the reference thickness T;
//! roughness of length λ has died out by exp(−2πd/λ) at the distance d, as in the upward continuation of a potential
//! field.
//!
//! # Even spacing
//! In an open layer nothing forces beds to crowd over a crest and to spread in a trough, as they do by 1 + 2πa/λ over
//! waves of the height a. There, the heat method for distances (K. Crane, C. Weischedel, M. Wardetzky, "Geodesics in
//! heat", ACM Transactions on Graphics 32, 2013) keeps the directions of the harmonic field u and makes their length even:
//!
//! ```text
//! ∇²k = ∇·X        X = ∇u/(|∇u| T)        k = 0 on the horizon
//! ```
//!
//! Crowding halves, and roughness still dies out, by (1 + πd/λ) exp(−2πd/λ).
//!
//! Each fault block is solved alone, on sheets that continue past its faults and the outer boundary. At the sides k
//! continues as the sheets do (∂(k − v)/∂x = 0 at constant v). A literal ∂k/∂n = 0 on an inclined fault or on the side of
//! a block of dipping beds would turn every bed until it meets that face at a right angle.
//!
//! The lattice is solved from coarse to fine ([`STAGES`]). On each stage, columns of nodes are solved exactly one after the
//! other while their neighbours are kept (line relaxation), in four colours, so that the result does not depend on the
//! number of threads. A layer is thin, so most of the coupling is within its columns.

use super::sigma::{FlowLattice, SigmaLayer};
use glam::Vec3;
use rayon::prelude::*;
use survey::{Cancelled, Progress};

/// Spacing of the stages over that of the finest, and the most relaxations on each.
const STAGES: [(usize, usize); 5] = [(16, 300), (8, 200), (4, 100), (2, 80), (1, 80)];
/// Over-relaxation: how much of the way to its solution a column goes. Thick layers, which couple farther than a relaxation
/// reaches, gain from values above 1; from 2 on nothing converges.
const OVER: f32 = 1.7;
/// Relaxations end when no k changes by more than this. A tenth of it changes no measured figure.
const TOLERANCE: f32 = 2e-5;

/// Where k is known.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Ends {
    /// On both sheets.
    Both,
    /// On the bottom sheet; beyond the top, beds are parallel.
    Bottom(FarBeds),
    /// On the top sheet; beyond the bottom, beds are parallel.
    Top(FarBeds),
}

/// Parallel beds far from the horizon of an open layer.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct FarBeds {
    /// Growth of k for a voxel along z.
    pub rate: f32,
    /// |∇k| in the scaled metric: one over the reference thickness.
    pub density: f32,
}

impl Ends {
    /// k of parallel beds in a column of this thickness.
    fn guess(self, v: f32, thickness: f32) -> f32 {
        match self {
            Self::Both => v,
            Self::Bottom(far) => v * thickness * far.rate,
            Self::Top(far) => 1.0 - (1.0 - v) * thickness * far.rate,
        }
    }

    /// By how much `guess` grows for a voxel of thickness.
    fn guess_slope(self, v: f32) -> f32 {
        match self {
            Self::Both => 0.0,
            Self::Bottom(far) => v * far.rate,
            Self::Top(far) => (v - 1.0) * far.rate,
        }
    }
}

/// How the lengths of ∇k are chosen.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Spacing {
    /// As ∇²k = 0 gives them.
    Harmonic,
    /// As even as the directions allow, in an open layer.
    Even,
}

/// Solves for k at the nodes of the finest lattice, `[x][y][level]`. `layer` is the layer on a lattice.
///
/// # Errors
/// [`Cancelled`].
pub(crate) fn solve(
    finest: FlowLattice,
    ends: Ends,
    spacing: Spacing,
    layer: impl Fn(FlowLattice) -> SigmaLayer,
    progress: &Progress,
) -> Result<(SigmaLayer, Vec<f32>), Cancelled> {
    let density = match (spacing, ends) {
        (Spacing::Even, Ends::Bottom(far) | Ends::Top(far)) => Some(far.density),
        _ => None,
    };
    let (first, _) = STAGES[0];
    let mut known = layer(finest.coarser(first));
    let mut harmonic = first_guess(&known, ends);
    let mut even = density.map(|_| harmonic.clone());
    for (factor, sweeps) in STAGES {
        let finer = layer(finest.coarser(factor));
        harmonic = refined(&finer, &known, &harmonic, ends);
        even = even.map(|even| refined(&finer, &known, &even, ends));
        known = finer;
        relax(&known, ends, None, &mut harmonic, sweeps, progress)?;
        if let (Some(even), Some(density)) = (&mut even, density) {
            let source = divergence(&known, &harmonic, density);
            relax(&known, ends, Some(&source), even, sweeps, progress)?;
        }
    }
    Ok((known, even.unwrap_or(harmonic)))
}

/// ∇·X at all nodes, for the field X that has the direction of ∇u and this length in the scaled metric.
fn divergence(layer: &SigmaLayer, u: &[f32], density: f32) -> Vec<f32> {
    let levels = layer.levels;
    let field: Vec<Vec3> = (0..u.len())
        .into_par_iter()
        .map(|n| {
            let gradient = layer.gradient(u, n / levels, n % levels);
            let raised = layer.inverse * gradient;
            let squared = gradient.dot(raised);
            if squared > 0.0 { raised * (density / squared.sqrt()) } else { Vec3::ZERO }
        })
        .collect();
    (0..u.len())
        .into_par_iter()
        .map(|n| {
            let (node, level) = (n / levels, n % levels);
            let slope = layer.terms(node, level).slope;
            let along = |axis: usize| layer.difference(node, axis, |node| field[node * levels + level][axis]);
            let rise = |axis: usize| layer.rise(level, |level| field[node * levels + level][axis]);
            along(0) + along(1) + (0..3).map(|axis| slope[axis] * rise(axis)).sum::<f32>()
        })
        .collect()
}

/// Parallel beds.
pub(crate) fn first_guess(layer: &SigmaLayer, ends: Ends) -> Vec<f32> {
    let at = |n: usize| ends.guess(layer.v(n % layer.levels), layer.thickness(n / layer.levels));
    (0..layer.lattice.size[0] * layer.lattice.size[1] * layer.levels).map(at).collect()
}

/// The departure from parallel beds, interpolated linearly to a finer lattice.
fn refined(fine: &SigmaLayer, coarse: &SigmaLayer, k: &[f32], ends: Ends) -> Vec<f32> {
    let levels = fine.levels;
    let mut out = first_guess(fine, ends);
    let place = |axis: usize, n: usize| {
        let last = (coarse.lattice.size[axis] - 1) as f32;
        let at = (n as f32 * fine.lattice.spacing[axis] / coarse.lattice.spacing[axis]).min(last);
        let cell = (at as usize).min(coarse.lattice.size[axis] - 2);
        (cell, at - cell as f32)
    };
    out.par_chunks_mut(levels).enumerate().for_each(|(node, column)| {
        let ((x, fx), (y, fy)) = (place(0, node / fine.lattice.size[1]), place(1, node % fine.lattice.size[1]));
        for (a, wx) in [(0, 1.0 - fx), (1, fx)] {
            for (b, wy) in [(0, 1.0 - fy), (1, fy)] {
                let from = (x + a) * coarse.lattice.size[1] + y + b;
                for (level, value) in column.iter_mut().enumerate() {
                    let parallel = ends.guess(coarse.v(level), coarse.thickness(from));
                    *value += wx * wy * (k[from * levels + level] - parallel);
                }
            }
        }
    });
    out
}

/// Relaxes all columns towards ∇²k = `source`, or 0, at most `most` times.
fn relax(
    layer: &SigmaLayer,
    ends: Ends,
    source: Option<&[f32]>,
    k: &mut [f32],
    most: usize,
    progress: &Progress,
) -> Result<(), Cancelled> {
    let ([nx, ny], levels) = (layer.lattice.size, layer.levels);
    for _ in 0..most {
        progress.check()?;
        let mut change = 0.0f32;
        for colour in 0..4 {
            let rows = (colour / 2..nx).step_by(2);
            let columns: Vec<usize> = rows.flat_map(|x| (colour % 2..ny).step_by(2).map(move |y| x * ny + y)).collect();
            let solved: Vec<Vec<f32>> = columns.par_iter().map(|&node| column(layer, ends, source, k, node)).collect();
            for (node, column) in columns.into_iter().zip(solved) {
                let old = &mut k[node * levels..(node + 1) * levels];
                for (old, new) in old.iter_mut().zip(column) {
                    change = change.max((new - *old).abs());
                    *old += OVER * (new - *old);
                }
            }
        }
        if change < TOLERANCE {
            break;
        }
    }
    Ok(())
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

/// The column that solves ∇²k = `source` at its levels while its neighbours stay.
fn column(layer: &SigmaLayer, ends: Ends, source: Option<&[f32]>, k: &[f32], node: usize) -> Vec<f32> {
    let levels = layer.levels;
    let source = |level: usize| source.map_or(0.0, |source| source[node * levels + level]);
    let ([hx, hy], step) = (layer.lattice.spacing, layer.v(1));
    let ([per_x, per_y], per_step) = ([1.0 / hx, 1.0 / hy], 1.0 / step);
    let [tx, ty] = layer.thickness_slope(node);
    let growth = [tx * hx, ty * hy];
    let beside = Beside { k, levels, ends, nodes: [layer.beside(node, 0), layer.beside(node, 1)], growth };
    let metric = layer.inverse;
    let (xx, yy, xy) = (metric.x_axis.x * per_x * per_x, metric.y_axis.y * per_y * per_y, metric.x_axis.y);
    let mixed = |level: usize| match beside.nodes {
        // In a sheared survey only, and only inside.
        [[Some(west), Some(east)], [Some(_), Some(_)]] if xy != 0.0 => {
            let at = |node: usize| k[node * levels + level];
            0.5 * xy * per_x * per_y * (at(east + 1) - at(east - 1) - at(west + 1) + at(west - 1))
        }
        _ => 0.0,
    };
    // Rows of the tridiagonal system: below, diagonal, above, right-hand side.
    let row = |level: usize| -> [f32; 4] {
        let is_far = |last: bool| match ends {
            Ends::Both => None,
            Ends::Bottom(far) => (last && level + 1 == levels).then_some(far.rate),
            Ends::Top(far) => (!last && level == 0).then_some(far.rate),
        };
        let far = is_far(true).or(is_far(false));
        if (level == 0 || level + 1 == levels) && far.is_none() {
            return [0.0, 1.0, 0.0, if level == 0 { 0.0 } else { 1.0 }];
        }
        let terms = layer.terms(node, level);
        let [west, east] = beside.pair(0, level);
        let [south, north] = beside.pair(1, level);
        let lateral = xx * (west + east) + yy * (south + north) + mixed(level) - source(level);
        let across = terms.across * per_step * per_step;
        let diagonal = -2.0 * (across + xx + yy);
        if let Some(rate) = far {
            // ∂k/∂n is that of parallel beds; a level outside continues k accordingly.
            let slopes = [(east - west) * 0.5 * per_x, (north - south) * 0.5 * per_y];
            let along = terms.cross.x * slopes[0] + terms.cross.y * slopes[1];
            let normal = layer.thickness(node) * rate - along / terms.across;
            let twist = 2.0 * (terms.cross.x * tx + terms.cross.y * ty) * rate;
            let sign = if level == 0 { -1.0 } else { 1.0 };
            let known = lateral + twist + terms.drift * normal + sign * 2.0 * across * step * normal;
            return if level == 0 {
                [0.0, diagonal, 2.0 * across, -known]
            } else {
                [2.0 * across, diagonal, 0.0, -known]
            };
        }
        let [west_low, east_low] = beside.pair(0, level - 1);
        let [west_high, east_high] = beside.pair(0, level + 1);
        let [south_low, north_low] = beside.pair(1, level - 1);
        let [south_high, north_high] = beside.pair(1, level + 1);
        let twist = terms.cross.x * per_x * (east_high - east_low - west_high + west_low)
            + terms.cross.y * per_y * (north_high - north_low - south_high + south_low);
        // Limited so that both off-diagonals stay positive.
        let drift = (0.5 * terms.drift * per_step).clamp(-0.95 * across, 0.95 * across);
        [across - drift, diagonal, across + drift, -(lateral + 0.5 * per_step * twist)]
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::metric::Metric;
    use glam::{DMat3, DVec3};

    const LEVELS: usize = 7;

    fn sheared() -> Metric {
        let metric =
            DMat3::from_cols(DVec3::new(12.0, 2.0, 0.0), DVec3::new(-3.0, 14.0, 0.0), DVec3::new(0.0, 0.0, 10.0));
        Metric::new(metric, 1.0).unwrap()
    }

    /// Steep, bent sheets whose distance varies by a factor of three.
    fn bent(lattice: FlowLattice) -> SigmaLayer {
        let bottom = |x: f32, y: f32| 20.0 + 0.6 * x + 2.0 * (0.9 * y).sin();
        let top = |x: f32, y: f32| 12.0 - 0.2 * x + 1.5 * (0.7 * (x + y)).cos();
        SigmaLayer::new(lattice, LEVELS, [&bottom, &top], &sheared())
    }

    fn lattice() -> FlowLattice {
        FlowLattice::new([0, 0], [6, 5], 1)
    }

    /// Solves `matrix · x = right` by elimination with pivots.
    fn eliminate(mut matrix: Vec<Vec<f64>>, mut right: Vec<f64>) -> Vec<f64> {
        let count = right.len();
        for n in 0..count {
            let pivot = (n..count).max_by(|&a, &b| matrix[a][n].abs().total_cmp(&matrix[b][n].abs())).unwrap();
            matrix.swap(n, pivot);
            right.swap(n, pivot);
            for row in n + 1..count {
                let factor = matrix[row][n] / matrix[n][n];
                let taken = matrix[n].clone();
                for (entry, above) in matrix[row].iter_mut().zip(taken).skip(n) {
                    *entry -= factor * above;
                }
                right[row] -= factor * right[n];
            }
        }
        for n in (0..count).rev() {
            let known: f64 = (n + 1..count).map(|column| matrix[n][column] * right[column]).sum();
            right[n] = (right[n] - known) / matrix[n][n];
        }
        right
    }

    #[test]
    fn relaxation_arrives_at_the_dense_solution() {
        let far = FarBeds { rate: 0.05, density: 0.05 };
        for ends in [Ends::Both, Ends::Bottom(far), Ends::Top(far)] {
            let (layer, found) = solve(lattice(), ends, Spacing::Harmonic, bent, &Progress::silent()).unwrap();
            let nodes = layer.lattice.size[0] * layer.lattice.size[1];
            // All columns from their neighbours at once is an affine map k ↦ M k + c; its fixed point is the solution.
            let map =
                |k: &[f32]| -> Vec<f32> { (0..nodes).flat_map(|node| column(&layer, ends, None, k, node)).collect() };
            let count = found.len();
            let constant = map(&vec![0.0; count]);
            let mut matrix = vec![vec![0.0; count]; count];
            for unknown in 0..count {
                let mut unit = vec![0.0; count];
                unit[unknown] = 1.0;
                for (row, (value, constant)) in map(&unit).iter().zip(&constant).enumerate() {
                    matrix[row][unknown] = f64::from(u8::from(row == unknown)) - f64::from(value - constant);
                }
            }
            let exact = eliminate(matrix, constant.iter().map(|&value| f64::from(value)).collect());
            let worst = found.iter().zip(&exact).map(|(a, b)| (f64::from(*a) - b).abs()).fold(0.0, f64::max);
            assert!(worst < 4e-3, "{ends:?}: off by {worst}");
            // Parallel beds alone are no solution here.
            let guess = first_guess(&layer, ends);
            let away = guess.iter().zip(&exact).map(|(a, b)| (f64::from(*a) - b).abs()).fold(0.0, f64::max);
            assert!(away > 0.02, "{ends:?}: {away}");
        }
    }

    #[test]
    fn k_rises_from_sheet_to_sheet() {
        let (layer, k) = solve(lattice(), Ends::Both, Spacing::Harmonic, bent, &Progress::silent()).unwrap();
        for column in k.chunks(layer.levels) {
            assert_eq!((column[0], column[LEVELS - 1]), (0.0, 1.0));
            assert!(column.windows(2).all(|pair| pair[0] < pair[1]), "{column:?}");
        }
    }
}
