//! Seeds: ridges whose two sides match after a shift and not without one, linked where they lie on one surface.

use crate::ridges::Ridge;
use crate::sides::{self, PairSums, Sides};
use attribute::likelihood::{Plane, ROW, crossed};
use interp::UnionFind;
use rayon::prelude::*;
use std::collections::HashMap;
use survey::{Cancelled, Progress, SurveyGeometry};

/// Samples down the dip to either side that are compared.
const DOWN: isize = 12;
/// Samples that are compared.
const WINDOW: usize = (2 * DOWN + 1) as usize;
/// Traces along strike to either side.
const ALONG: isize = 2;
/// Least shift that is a throw, samples.
const LEAST_THROW: i32 = 3;
/// Least gain by the shift, and least correlation after it.
const GAIN: f32 = 0.2;
const MATCH: f32 = 0.6;
/// Links: traces apart, samples apart, traces off each other's planes, cosine of the angle of strikes, samples of throw.
const APART: f32 = 2.9;
const BELOW: f32 = 6.0;
const OFF_PLANE: f32 = 1.2;
const STRIKES: f32 = 0.866;
const THROWS: f32 = 3.0;
/// Fewest seeds of a surface.
const FEWEST: usize = 30;

/// A ridge with a throw.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Seed {
    /// Its number among the ridges.
    pub(crate) ridge: usize,
    /// Samples that the side towards `across` lies deeper.
    pub(crate) throw: f32,
}

/// Traces beyond a ridge that its throw depends on, but for slopes.
pub(crate) fn reach(geometry: &SurveyGeometry, greatest: i32) -> usize {
    crossed(geometry, DOWN as usize + greatest as usize / 2 + 1) + ALONG as usize + sides::REACH + 1
}

/// Measures the ridges of a chequerboard and returns those with a throw.
///
/// # Errors
/// [`Cancelled`].
pub(crate) fn seeds(
    sides: Sides<'_>,
    ridges: &[Ridge],
    greatest: i32,
    progress: &Progress,
) -> Result<Vec<Seed>, Cancelled> {
    let is_chosen = |ridge: &Ridge| {
        let [x, y, z] = ridge.at.map(|at| at as usize);
        (x + y + z / ROW).is_multiple_of(2)
    };
    some(sides, ridges, greatest, &is_chosen, progress)
}

/// Measures all ridges and returns those with a throw.
///
/// # Errors
/// [`Cancelled`].
pub(crate) fn all(
    sides: Sides<'_>,
    ridges: &[Ridge],
    greatest: i32,
    progress: &Progress,
) -> Result<Vec<Seed>, Cancelled> {
    some(sides, ridges, greatest, &|_| true, progress)
}

fn some(
    sides: Sides<'_>,
    ridges: &[Ridge],
    greatest: i32,
    is_chosen: &(dyn Fn(&Ridge) -> bool + Sync),
    progress: &Progress,
) -> Result<Vec<Seed>, Cancelled> {
    /// Ridges between reports.
    const TOGETHER: usize = 4096;
    progress.begin("throws", ridges.len().div_ceil(TOGETHER) as u64);
    let of_part = |(part, ridges): (usize, &[Ridge])| {
        progress.step(1)?;
        let seed =
            |(n, ridge)| throw_at(sides, ridge, greatest).map(|throw| Seed { ridge: part * TOGETHER + n, throw });
        Ok(ridges.iter().enumerate().filter(|(_, ridge)| is_chosen(ridge)).filter_map(seed).collect::<Vec<Seed>>())
    };
    let parts: Vec<Vec<Seed>> =
        ridges.par_chunks(TOGETHER).enumerate().map(of_part).collect::<Result<_, Cancelled>>()?;
    Ok(parts.concat())
}

/// The throw that makes both sides of a ridge match, if they need one.
fn throw_at(sides: Sides<'_>, ridge: &Ridge, greatest: i32) -> Option<f32> {
    let plane = ridge.plane;
    let reach = DOWN + (greatest as isize + 1) / 2;
    let depth = (2 * reach + 1) as usize;
    let back = plane.across.map(|c| -c);
    let mut values = [Vec::new(), Vec::new()];
    for (values, across) in values.iter_mut().zip([back, plane.across]) {
        for j in -ALONG..=ALONG {
            for w in -reach..=reach {
                let off = plane.run * w as f32;
                let at = |axis: usize| ridge.at[axis] + off * plane.across[axis] + j as f32 * plane.along[axis];
                values.push(sides.beside([at(0), at(1)], across, ridge.at[2] + w as f32));
            }
        }
    }
    // What is missing counts as nothing.
    values.iter_mut().flatten().for_each(|value| *value = if value.is_finite() { *value } else { 0.0 });
    let [left, right] = &values;
    let squares = values.each_ref().map(|values| running_squares(values, depth));
    let lines = (2 * ALONG + 1) as usize;
    let correlation = |lag: i32| {
        let (up, down) = (lag.div_euclid(2) as isize, (lag - lag.div_euclid(2)) as isize);
        let [from_left, from_right] = [reach - DOWN - up, reach - DOWN + down].map(|first| first as usize);
        let mut sums = PairSums::default();
        for line in 0..lines {
            let [a, b] = [from_left, from_right].map(|first| line * depth + first);
            sums.product += product(&left[a..a + WINDOW], &right[b..b + WINDOW]);
            let energy = |side: usize, first: usize| {
                let row = &squares[side][line * (depth + 1)..];
                row[first + WINDOW] - row[first]
            };
            sums.left += energy(0, from_left);
            sums.right += energy(1, from_right);
        }
        sums.correlation()
    };
    let whole = (-1..=1).map(correlation).fold(0.0f32, f32::max);
    let (mut best, mut throw) = (MATCH, 0);
    for lag in (-greatest..=greatest).filter(|lag| lag.abs() >= LEAST_THROW) {
        let found = correlation(lag);
        if found > best {
            (best, throw) = (found, lag);
        }
    }
    (throw != 0 && best - whole > GAIN).then_some(throw as f32)
}

/// For each row of `depth` values, the sums of their squares up to each, from 0 on.
fn running_squares(values: &[f32], depth: usize) -> Vec<f32> {
    let mut sums = Vec::with_capacity(values.len() / depth * (depth + 1));
    for row in values.chunks(depth) {
        let mut sum = 0.0;
        sums.push(sum);
        sums.extend(row.iter().map(|value| {
            sum += value * value;
            sum
        }));
    }
    sums
}

/// Σ a b, in eight lanes.
#[inline]
fn product(a: &[f32], b: &[f32]) -> f32 {
    let mut lanes = [0.0f32; 8];
    let (a, b) = (a.chunks_exact(8), b.chunks_exact(8));
    let rest: f32 = a.remainder().iter().zip(b.remainder()).map(|(a, b)| a * b).sum();
    for (a, b) in a.zip(b) {
        for (lane, (a, b)) in lanes.iter_mut().zip(a.iter().zip(b)) {
            *lane += a * b;
        }
    }
    lanes.iter().sum::<f32>() + rest
}

/// Groups of seeds that lie on one surface, most evidence first.
pub(crate) fn linked(ridges: &[Ridge], seeds: &[Seed]) -> Vec<Vec<usize>> {
    let at = |n: usize| &ridges[seeds[n].ridge];
    let is_one_throw = |n: usize, m: usize, turn: f32| {
        // Strikes half a turn apart are one, seen from the other side.
        let throw = if turn < 0.0 { -seeds[m].throw } else { seeds[m].throw };
        (seeds[n].throw - throw).abs() <= THROWS
    };
    joined(seeds.len(), at, is_one_throw, FEWEST)
}

/// Groups of at least `fewest` of `count` ridges that lie on one surface, the largest first; `may_join` is asked of two whose
/// planes are one, with the cosine between their strikes.
pub(crate) fn joined<'a>(
    count: usize,
    at: impl Fn(usize) -> &'a Ridge,
    may_join: impl Fn(usize, usize, f32) -> bool,
    fewest: usize,
) -> Vec<Vec<usize>> {
    let mut bins: HashMap<[i32; 3], Vec<usize>> = HashMap::new();
    let bin = |at: [f32; 3]| [(at[0] / APART) as i32, (at[1] / APART) as i32, (at[2] / BELOW) as i32];
    for n in 0..count {
        bins.entry(bin(at(n).at)).or_default().push(n);
    }
    let mut sets = UnionFind::new(count);
    for n in 0..count {
        let [i, j, k] = bin(at(n).at);
        for near in (0..27).map(|m| [i + m / 9 - 1, j + m / 3 % 3 - 1, k + m % 3 - 1]) {
            for &m in bins.get(&near).into_iter().flatten().filter(|&&m| m < n) {
                if on_one_plane(at(n), at(m)).is_some_and(|turn| may_join(n, m, turn)) {
                    sets.union(n as u32, m as u32);
                }
            }
        }
    }
    let mut groups: HashMap<u32, Vec<usize>> = HashMap::new();
    for n in 0..count {
        groups.entry(sets.find(n as u32)).or_default().push(n);
    }
    let mut groups: Vec<Vec<usize>> = groups.into_values().filter(|group| group.len() >= fewest).collect();
    groups.sort_by(|a, b| b.len().cmp(&a.len()).then(a[0].cmp(&b[0])));
    groups
}

/// The cosine between the strikes of two ridges that lie on each other's planes.
fn on_one_plane(a: &Ridge, b: &Ridge) -> Option<f32> {
    let apart = [b.at[0] - a.at[0], b.at[1] - a.at[1], b.at[2] - a.at[2]];
    let turn = a.plane.along[0] * b.plane.along[0] + a.plane.along[1] * b.plane.along[1];
    let off = |plane: &Plane| (apart[0] * plane.across[0] + apart[1] * plane.across[1] - plane.run * apart[2]).abs();
    let are_near = apart[0].hypot(apart[1]) <= APART && apart[2].abs() <= BELOW;
    let are_one = are_near && turn.abs() >= STRIKES && off(&a.plane) <= OFF_PLANE && off(&b.plane) <= OFF_PLANE;
    are_one.then_some(turn)
}
