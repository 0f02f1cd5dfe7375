//! Distances without creases. Where two places of a surface are as near, as in the core of a fold, its distance has a
//! crease, and patterns that follow it break there. A crease is no part of the surface: beds die out away from it. So away
//! from the surface the distance is averaged, over a width that grows with the distance; on and near the surface it stays
//! exact.
//!
//! The averages are taken on lattices, each of twice the spacing of the one before. Functions that are linear in space are
//! not changed, nor is the side of a surface on which a place lies.

use glam::DMat3;
use rayon::prelude::*;
use survey::LevelField;
use survey::progress::{Cancelled, Progress};

/// Width of the average as a share of the distance.
const SHARE: f32 = 0.5;
/// The averaged distance is at least and at most so many times the exact one.
const CHANGE: [f32; 2] = [0.5, 1.5];
/// A lattice of fewer nodes along an axis is not halved.
const FEWEST: usize = 5;

/// Rounds off the creases of a signed distance in metres. Memory: up to 12 bytes a node while it runs,
/// beside those of the field.
pub(super) fn round_off(field: &mut LevelField, metric: DMat3, progress: &Progress) -> Result<(), Cancelled> {
    let steps_m = [0, 1, 2].map(|axis: usize| metric.col(axis).length() as f32 * field.step[axis]);
    let exact = NodeLattice { size: field.size, steps_m, values: std::mem::take(&mut field.values) };
    let rounded = exact.rounded(progress)?;
    field.values = match rounded {
        None => exact.values,
        Some(mut values) => {
            values.par_iter_mut().zip(&exact.values).for_each(|(value, &exact)| {
                let [a, b] = CHANGE.map(|times| times * exact);
                *value = value.clamp(a.min(b), a.max(b));
            });
            values
        }
    };
    Ok(())
}

/// A function at the nodes of a lattice.
struct NodeLattice {
    size: [usize; 3],
    /// Metres between nodes.
    steps_m: [f32; 3],
    /// `[x][y][z]`.
    values: Vec<f32>,
}

impl NodeLattice {
    /// The function, averaged over its width where that is more than a step; `None` where it is nowhere.
    fn rounded(&self, progress: &Progress) -> Result<Option<Vec<f32>>, Cancelled> {
        progress.check()?;
        let step_m = self.steps_m.into_iter().fold(0.0, f32::max);
        // 1 where the width is a step or less, 0 where it is two or more.
        let own = |value: f32| {
            let t = (2.0 - SHARE * value.abs() / step_m).clamp(0.0, 1.0);
            t * t * (3.0 - 2.0 * t)
        };
        if self.values.par_iter().all(|&value| own(value) >= 1.0) {
            return Ok(None);
        }
        let Some(halved) = self.halved() else { return Ok(None) };
        let coarse = halved.rounded(progress)?.unwrap_or(halved.values);
        let mut averaged = doubled(coarse, halved.size, self.size);
        averaged.par_iter_mut().zip(&self.values).for_each(|(averaged, &value)| {
            *averaged += own(value) * (value - *averaged);
        });
        Ok(Some(averaged))
    }

    /// The averages at half the nodes along the axes of the closest nodes; `None` where there are too few.
    fn halved(&self) -> Option<Self> {
        let may = |axis: usize| self.size[axis] >= FEWEST;
        let closest = (0..3).filter(|&axis| may(axis)).map(|axis| self.steps_m[axis]).fold(f32::INFINITY, f32::min);
        let mut found: Option<Self> = None;
        for axis in (0..3).filter(|&axis| may(axis) && self.steps_m[axis] < 1.5 * closest) {
            let from = found.as_ref().unwrap_or(self);
            let (mut size, mut steps_m) = (from.size, from.steps_m);
            size[axis] = (size[axis] - 1).div_ceil(2) + 1;
            steps_m[axis] *= 2.0;
            let weights = [1.0, 4.0, 6.0, 4.0, 1.0].map(|weight: f32| weight / 16.0);
            let terms = |n: usize| (2 * n as isize - 2..).zip(weights).collect();
            let values = along(&from.values, from.size, axis, size[axis], terms);
            found = Some(Self { size, steps_m, values });
        }
        found
    }
}

/// The function of a halved lattice at the nodes of the one before, by cubic splines.
fn doubled(mut values: Vec<f32>, mut from: [usize; 3], to: [usize; 3]) -> Vec<f32> {
    for axis in 0..3 {
        if from[axis] == to[axis] {
            continue;
        }
        let terms = |n: usize| {
            let at = (n / 2) as isize;
            match n % 2 {
                0 => vec![(at - 1, 0.125), (at, 0.75), (at + 1, 0.125)],
                _ => vec![(at, 0.5), (at + 1, 0.5)],
            }
        };
        values = along(&values, from, axis, to[axis], terms);
        from[axis] = to[axis];
    }
    values
}

/// Weighted sums along an axis of a lattice. Beyond its ends the function goes on as it came: a slope stays a slope.
fn along(
    values: &[f32],
    size: [usize; 3],
    axis: usize,
    count: usize,
    terms: impl Fn(usize) -> Vec<(isize, f32)> + Sync,
) -> Vec<f32> {
    let inner: usize = size[axis + 1..].iter().product();
    let outer: usize = size[..axis].iter().product();
    let last = size[axis] as isize - 1;
    // Rows of values that are as far along the axis, and their weights.
    let of_row = |n: usize| -> Vec<(usize, f32)> {
        let inside = |at: isize| at.clamp(0, last) as usize;
        let row = |(at, weight): (isize, f32)| match at {
            ..0 => vec![(0, 2.0 * weight), (inside(-at), -weight)],
            at if at > last => vec![(last as usize, 2.0 * weight), (inside(2 * last - at), -weight)],
            at => vec![(at as usize, weight)],
        };
        terms(n).into_iter().flat_map(row).collect()
    };
    let rows: Vec<Vec<(usize, f32)>> = (0..count).map(of_row).collect();
    let mut found = vec![0.0; outer * count * inner];
    // Whole lines at once where rows are single values.
    let at_once = if inner == 1 { count } else { 1 };
    found.par_chunks_mut(at_once * inner).enumerate().for_each(|(chunk, found)| {
        let first = chunk * at_once;
        for (row, found) in found.chunks_mut(inner).enumerate() {
            let (block, n) = ((first + row) / count, (first + row) % count);
            for &(at, weight) in &rows[n] {
                let from = &values[(block * size[axis] + at) * inner..][..inner];
                found.iter_mut().zip(from).for_each(|(sum, value)| *sum += weight * value);
            }
        }
    });
    found
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::{DVec3, Vec3};

    /// Nodes of 20 × 20 × 10 m.
    fn field(size: [usize; 3], of: impl Fn(DVec3) -> f64) -> LevelField {
        let steps = DVec3::new(20.0, 20.0, 10.0);
        let place = |n: usize| {
            DVec3::new((n / (size[1] * size[2])) as f64, (n / size[2] % size[1]) as f64, (n % size[2]) as f64)
        };
        let values = (0..size.iter().product()).map(|n| of(place(n) * steps) as f32).collect();
        LevelField { origin: Vec3::ZERO, step: Vec3::ONE, size, values }
    }

    fn rounded(size: [usize; 3], of: impl Fn(DVec3) -> f64) -> (LevelField, LevelField) {
        let exact = field(size, of);
        let mut rounded = exact.clone();
        let metric = DMat3::from_diagonal(DVec3::new(20.0, 20.0, 10.0));
        round_off(&mut rounded, metric, &Progress::silent()).unwrap();
        (exact, rounded)
    }

    #[test]
    fn distance_from_a_plane_stays_exact() {
        for size in [[41, 30, 77], [7, 64, 33], [3, 4, 100]] {
            let normal = DVec3::new(0.3, -0.5, 0.8).normalize();
            let (exact, rounded) = rounded(size, |p| normal.dot(p) - 40.0);
            let worst = exact.values.iter().zip(&rounded.values).map(|(a, b)| (a - b).abs()).fold(0.0, f32::max);
            assert!(worst < 0.01, "{size:?}: {worst} m");
        }
    }

    #[test]
    fn creases_are_rounded_wider_with_distance_and_sides_stay() {
        // The distance inside a ridge of two planes of 45°: its crease rises from the ridge.
        let ridge = |p: DVec3| std::f64::consts::FRAC_1_SQRT_2 * (p.z - 300.0 - (p.x - 400.0).abs());
        let (exact, rounded) = rounded([41, 9, 141], ridge);
        for (node, (&before, &after)) in exact.values.iter().zip(&rounded.values).enumerate() {
            assert!(before == after || (before < 0.0) == (after < 0.0), "{node}: {before} {after}");
            assert!(before.abs() > 39.0 || before == after, "{node}: {before} {after}");
        }
        // The slope across the crease turns by 1.4 within a voxel before; after, over a width that grows with the distance.
        let turn = |field: &LevelField, z: usize| {
            let at = |x: usize| field.values[(x * 9 + 4) * 141 + z];
            (at(21) - 2.0 * at(20) + at(19)) / 20.0
        };
        assert!(turn(&exact, 120) < -1.4);
        let turns: Vec<f32> = [50, 80, 120].map(|z| turn(&rounded, z)).to_vec();
        assert!(turns[0] > -1.0 && turns[1] > -0.45 && turns[2] > -0.25, "{turns:?}");
        assert!(turns.iter().all(|&turn| turn < -0.01), "{turns:?}");
    }
}
