//! A thin-plate spline for all fault blocks at once: a shape that they share, and what each has of its own.
//!
//! z_b(p) = s(p) + t_b(p), the most probable surfaces through the observations if s and t_b are independent random fields
//! with the covariance of a thin plate, k(r) = 2r² ln r − r² + 1 for places within a unit distance (Williams & Fitzgibbon,
//! "Gaussian process implicit surfaces", 2007), t_b a share of it; a dip of s, the level of each t_b, and of some blocks
//! its dip are free (universal kriging). So the surface bends least, parallel beds on both sides of a fault cost nothing,
//! and a throw that changes along a fault costs more than a bend of both sides.
//!
//! An observation is the depth of a block at a place, or that two blocks have the same one. Spaces: places of a map whose
//! diagonal is 1; depths in any unit.

use glam::DVec2;
use std::collections::{BTreeMap, BTreeSet};

/// The variance of what a block has of its own, of that of the shared shape.
const OWN: f64 = 0.25;
/// What is added to the variance of a depth and of a tie, so that near observations do not fight.
const NUGGET: f64 = 1e-9;
const TIE_NUGGET: f64 = 1e-7;
/// What holds directions that no observation tells, of a free term's own entry: a dip that all blocks may share is no dip
/// of one of them.
const RIDGE: f64 = 1e-13;
const OWN_DIP_RIDGE: f64 = 1e-9;

/// Something that is known of the surfaces: the sum of their depths at places, times weights.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Observation {
    /// Place, block, weight.
    pub terms: Vec<(DVec2, u16, f64)>,
    value: f64,
    nugget: f64,
}

impl Observation {
    /// A block's depth at a place.
    pub(super) fn point(place: DVec2, block: u16, z: f64) -> Self {
        Self { terms: vec![(place, block, 1.0)], value: z, nugget: NUGGET }
    }

    /// Two blocks have one depth at a place.
    pub(super) fn tie(place: DVec2, [a, b]: [u16; 2]) -> Self {
        Self { terms: vec![(place, a, 1.0), (place, b, -1.0)], value: 0.0, nugget: TIE_NUGGET }
    }
}

/// The surfaces of all blocks that were observed.
#[derive(Debug, Clone)]
pub(super) struct BlockSpline {
    /// Place, index of the block, coefficient.
    terms: Vec<(DVec2, usize, f64)>,
    blocks: Vec<u16>,
    /// Level and dip of each block.
    drift: Vec<[f64; 3]>,
}

/// The covariance of a thin plate at a distance.
fn covariance(square: f64) -> f64 {
    if square <= 1e-30 { 1.0 } else { square * square.ln() - square + 1.0 }
}

impl BlockSpline {
    /// The surfaces through observations; the blocks of `own_dip` have a dip of their own.
    pub(super) fn through(observations: &[Observation], own_dip: &BTreeSet<u16>) -> Self {
        let blocks: BTreeSet<u16> = observations.iter().flat_map(|o| o.terms.iter().map(|term| term.1)).collect();
        let blocks: Vec<u16> = blocks.into_iter().collect();
        let index: BTreeMap<u16, usize> = blocks.iter().enumerate().map(|(n, block)| (*block, n)).collect();
        let dips: Vec<u16> = own_dip.iter().copied().filter(|block| index.contains_key(block)).collect();
        let count = observations.len();
        let between = |a: &Observation, b: &Observation| -> f64 {
            let pairs = a.terms.iter().flat_map(|p| b.terms.iter().map(move |q| (p, q)));
            pairs
                .map(|(p, q)| {
                    let own = if p.1 == q.1 { OWN } else { 0.0 };
                    p.2 * q.2 * (1.0 + own) * covariance(p.0.distance_squared(q.0))
                })
                .sum()
        };
        let mut matrix = vec![0.0; count * count];
        for (n, a) in observations.iter().enumerate() {
            for (m, b) in observations[..=n].iter().enumerate() {
                matrix[n * count + m] = between(a, b);
            }
            matrix[n * count + n] += a.nugget;
        }
        factorise(&mut matrix, count);
        // The columns of what is free: level of each block, dip of all, dip of some.
        let width = blocks.len() + 2 + 2 * dips.len();
        let middle = observations.iter().flat_map(|o| &o.terms).map(|term| term.0).sum::<DVec2>()
            / observations.iter().map(|o| o.terms.len()).sum::<usize>().max(1) as f64;
        let free = |o: &Observation| {
            let mut row = vec![0.0; width];
            for (place, block, weight) in &o.terms {
                let at = *place - middle;
                row[index[block]] += weight;
                row[blocks.len()] += weight * at.x;
                row[blocks.len() + 1] += weight * at.y;
                if let Some(n) = dips.iter().position(|dip| dip == block) {
                    row[blocks.len() + 2 + 2 * n] += weight * at.x;
                    row[blocks.len() + 3 + 2 * n] += weight * at.y;
                }
            }
            row
        };
        let rows: Vec<Vec<f64>> = observations.iter().map(free).collect();
        let columns: Vec<Vec<f64>> =
            (0..width).map(|c| solve(&matrix, count, rows.iter().map(|row| row[c]).collect())).collect();
        let values = solve(&matrix, count, observations.iter().map(|o| o.value).collect());
        let mut normal = vec![0.0; width * width];
        let mut right = vec![0.0; width];
        for a in 0..width {
            for b in 0..=a {
                normal[a * width + b] = (0..count).map(|n| rows[n][a] * columns[b][n]).sum();
            }
            right[a] = (0..count).map(|n| rows[n][a] * values[n]).sum();
        }
        for n in 0..width {
            let ridge = if n < blocks.len() + 2 { RIDGE } else { OWN_DIP_RIDGE };
            let entry = &mut normal[n * width + n];
            *entry += (ridge * *entry).max(1e-13);
        }
        factorise(&mut normal, width);
        let free = solve(&normal, width, right);
        let coefficient = |n: usize| values[n] - (0..width).map(|c| columns[c][n] * free[c]).sum::<f64>();
        let coefficients: Vec<f64> = (0..count).map(coefficient).collect();
        let terms = observations.iter().zip(&coefficients).flat_map(|(o, c)| {
            o.terms.iter().map(|(place, block, weight)| (*place, index[block], weight * c)).collect::<Vec<_>>()
        });
        let terms = terms.collect();
        let drift = |(n, block): (usize, &u16)| {
            let mut dip = [free[blocks.len()], free[blocks.len() + 1]];
            if let Some(own) = dips.iter().position(|dip| dip == block) {
                dip[0] += free[blocks.len() + 2 + 2 * own];
                dip[1] += free[blocks.len() + 3 + 2 * own];
            }
            [free[n] - dip[0] * middle.x - dip[1] * middle.y, dip[0], dip[1]]
        };
        let drift = blocks.iter().enumerate().map(drift).collect();
        Self { terms, blocks, drift }
    }

    /// The blocks that were observed.
    pub(super) fn blocks(&self) -> impl Iterator<Item = u16> + '_ {
        self.blocks.iter().copied()
    }

    /// The depth of a block at a place; of one that was not observed, NaN.
    pub(super) fn at(&self, place: DVec2, block: u16) -> f64 {
        self.all_at(place).into_iter().find(|(other, _)| *other == block).map_or(f64::NAN, |(_, z)| z)
    }

    /// The depth of each block at a place.
    pub(super) fn all_at(&self, place: DVec2) -> Vec<(u16, f64)> {
        let (mut shared, mut own) = (0.0, vec![0.0; self.blocks.len()]);
        for (at, block, coefficient) in &self.terms {
            let covered = coefficient * covariance(place.distance_squared(*at));
            shared += covered;
            own[*block] += OWN * covered;
        }
        let level = |drift: &[f64; 3]| drift[0] + drift[1] * place.x + drift[2] * place.y;
        let each = self.blocks.iter().zip(&self.drift).zip(own);
        each.map(|((block, drift), own)| (*block, level(drift) + shared + own)).collect()
    }
}

/// Replaces the lower triangle of a positive definite matrix by its Cholesky factor.
fn factorise(matrix: &mut [f64], count: usize) {
    for n in 0..count {
        let (before, rest) = matrix.split_at_mut(n * count);
        let row = &mut rest[..=n];
        for m in 0..n {
            let other = &before[m * count..m * count + m + 1];
            let sum: f64 = row[..m].iter().zip(&other[..m]).map(|(a, b)| a * b).sum();
            row[m] = (row[m] - sum) / other[m];
        }
        let sum: f64 = row[..n].iter().map(|a| a * a).sum();
        row[n] = (row[n] - sum).max(1e-14).sqrt();
    }
}

/// The solution for a factorised matrix.
fn solve(factor: &[f64], count: usize, mut right: Vec<f64>) -> Vec<f64> {
    for n in 0..count {
        let row = &factor[n * count..n * count + n];
        let sum: f64 = row.iter().zip(&right).map(|(a, b)| a * b).sum();
        right[n] = (right[n] - sum) / factor[n * count + n];
    }
    for n in (0..count).rev() {
        right[n] /= factor[n * count + n];
        let value = right[n];
        for (m, entry) in factor[n * count..n * count + n].iter().enumerate() {
            right[m] -= entry * value;
        }
    }
    right
}
