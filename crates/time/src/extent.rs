//! How far a found fault reaches: where its two sides fit better with its throw than without.
//!
//! The ends of patches tell where a fault is, but not all of it: where its throw is close to the distance of
//! two reflectors, patches go on across it as if nothing were there. With the throw T known, both sides beside the fault
//! tell the rest. The misfit of both sides under a shift, over a window of lines and samples, is
//!
//! `Σ (A₋(z − T/2) − A₊(z + T/2))² / Σ (A₋² + A₊²)`
//!
//! and the gain is by how much it is less under the best shift near the throw than under none: positive where the rock
//! is offset, negative where it goes on. Where the throw is about nothing, it says nothing, and the ends of patches
//! decide. A fault has no holes: what lies between two of its cells on a line, or at a depth,
//! belongs to it. Space: voxels.

use crate::cuts::Cut;
use crate::links::Links;
use crate::solve::interpolate;
use crate::throws::{Throw, sides};
use rayon::prelude::*;
use survey::Volume;

/// What a cell's mean evidence of ended patches counts beside its gain.
const ENDS: f32 = 0.25;
/// By how much the throw may differ from place to place, and the steps of it, samples.
const VARIED: [f32; 9] = [-6.0, -4.5, -3.0, -1.5, 0.0, 1.5, 3.0, 4.5, 6.0];
/// Shifts that are no throw, samples.
const NO_THROW: [f32; 3] = [-1.0, 0.0, 1.0];
/// Count of shifts.
const SHIFTS: usize = VARIED.len() + NO_THROW.len();

/// How badly both sides of a fault fit under each shift, in every cell; `[line cell][sample cell]`.
pub(crate) struct Misfits {
    cells: [usize; 2],
    /// Squared differences under each of [`VARIED`] and [`NO_THROW`], each over the energy of both sides, and how many
    /// samples there were.
    sums: Vec<([f32; SHIFTS], f32)>,
}

impl Misfits {
    /// The misfits of a fault that is given a place everywhere.
    pub(crate) fn new(volume: &Volume<f32>, links: &Links, whole: &Cut, throw: &Throw, cell: [usize; 2]) -> Self {
        let [lines, nz] = whole.size;
        let [lower, upper] = sides(volume, links, whole);
        let cells = [lines.div_ceil(cell[0]), nz.div_ceil(cell[1])];
        let last = (nz - 1) as f32;
        let of_cell = |n: usize| {
            let (along, down) = (n / cells[1], n % cells[1]);
            let (mut misfit, mut energy, mut count) = ([0.0f32; SHIFTS], [0.0f32; SHIFTS], 0.0f32);
            for line in along * cell[0]..((along + 1) * cell[0]).min(lines) {
                let (a, b) = (&lower[line * nz..(line + 1) * nz], &upper[line * nz..(line + 1) * nz]);
                for z in down * cell[1]..((down + 1) * cell[1]).min(nz) {
                    if !(a[z].is_finite() && b[z].is_finite()) {
                        continue;
                    }
                    count += 1.0;
                    let throw = throw.at(line, z as f32);
                    let shifts = VARIED.iter().map(|change| throw + change).chain(NO_THROW);
                    for (n, shift) in shifts.enumerate() {
                        let depths = [z as f32 - 0.5 * shift, z as f32 + 0.5 * shift].map(|z| z.clamp(0.0, last));
                        let (a, b) = (interpolate(a, depths[0]), interpolate(b, depths[1]));
                        if a.is_finite() && b.is_finite() {
                            misfit[n] += (a - b) * (a - b);
                            energy[n] += a * a + b * b;
                        }
                    }
                }
            }
            for n in 0..SHIFTS {
                misfit[n] = if energy[n] > 0.0 { count * misfit[n] / energy[n] } else { count };
            }
            (misfit, count)
        };
        Self { cells, sums: (0..cells[0] * cells[1]).into_par_iter().map(of_cell).collect() }
    }

    /// By how much the best throw within `reach` cells of each cell fits better than none; 0 where a side is missing.
    pub(crate) fn gain(&self, reach: [usize; 2]) -> Vec<f32> {
        let cells = self.cells;
        let around = |n: usize| {
            let (mut sums, mut count) = ([0.0f32; SHIFTS], 0.0f32);
            for m in around(n, cells, reach) {
                sums.iter_mut().zip(&self.sums[m].0).for_each(|(sum, more)| *sum += more);
                count += self.sums[m].1;
            }
            let least = |sums: &[f32]| sums.iter().copied().fold(f32::INFINITY, f32::min);
            let (with, without) = (least(&sums[..VARIED.len()]), least(&sums[VARIED.len()..]));
            if count > 0.0 { (without - with) / count } else { 0.0 }
        };
        (0..self.sums.len()).map(around).collect()
    }
}

/// The cells within `reach` of a cell.
fn around(n: usize, cells: [usize; 2], reach: [usize; 2]) -> impl Iterator<Item = usize> {
    let range = |at: usize, reach: usize, count: usize| at.saturating_sub(reach)..(at + reach + 1).min(count);
    let down = range(n % cells[1], reach[1], cells[1]);
    range(n / cells[1], reach[0], cells[0]).flat_map(move |a| down.clone().map(move |d| a * cells[1] + d))
}

/// The cells of a fault: those whose gain and whose evidence of ended patches within `reach` cells speak for it, and
/// what lies between them.
pub(crate) fn extent(gain: &[f32], ends: &[f32], cells: [usize; 2], reach: [usize; 2]) -> Vec<bool> {
    let speaks = |n: usize| {
        let (sum, count) = around(n, cells, reach).fold((0.0, 0.0), |(sum, count), m| (sum + ends[m], count + 1.0));
        gain[n] + ENDS * sum / count > 0.0
    };
    let found: Vec<bool> = (0..cells[0] * cells[1]).map(speaks).collect();
    without_holes(&largest(&found, cells), cells)
}

/// The largest connected part.
fn largest(found: &[bool], cells: [usize; 2]) -> Vec<bool> {
    let mut sets = interp::UnionFind::new(found.len());
    for n in 0..found.len() {
        let (along, down) = (n / cells[1], n % cells[1]);
        if along + 1 < cells[0] && found[n] && found[n + cells[1]] {
            sets.union(n as u32, (n + cells[1]) as u32);
        }
        if down + 1 < cells[1] && found[n] && found[n + 1] {
            sets.union(n as u32, (n + 1) as u32);
        }
    }
    let set: Vec<u32> = (0..found.len() as u32).map(|n| sets.find(n)).collect();
    let mut count = vec![0usize; found.len()];
    set.iter().zip(found).filter(|(_, found)| **found).for_each(|(&set, _)| count[set as usize] += 1);
    let most = (0..count.len()).max_by_key(|&n| (count[n], std::cmp::Reverse(n))).unwrap_or(0) as u32;
    set.iter().zip(found).map(|(&set, &found)| found && set == most).collect()
}

/// Adds what lies between two cells of a line or of a depth, until nothing is left between.
fn without_holes(found: &[bool], cells: [usize; 2]) -> Vec<bool> {
    let mut whole = found.to_vec();
    loop {
        let mut changed = false;
        let lines = (0..cells[0]).map(|along| (along * cells[1], 1, cells[1]));
        let depths = (0..cells[1]).map(|down| (down, cells[1], cells[0]));
        for (first, step, count) in lines.chain(depths) {
            let at = |n: usize| first + n * step;
            let Some(from) = (0..count).find(|&n| whole[at(n)]) else { continue };
            let to = (0..count).rev().find(|&n| whole[at(n)]).unwrap_or(from);
            for n in from..=to {
                changed |= !whole[at(n)];
                whole[at(n)] = true;
            }
        }
        if !changed {
            return whole;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_fault_has_no_holes_and_one_part() {
        let picture = ["#..#....", "#.##...#", "..#....."];
        let found: Vec<bool> = picture.iter().flat_map(|row| row.chars().map(|c| c == '#')).collect();
        let whole =
            extent(&found.iter().map(|f| if *f { 1.0 } else { -1.0 }).collect::<Vec<_>>(), &[0.0; 24], [3, 8], [0, 0]);
        let drawn: String = whole.iter().map(|f| if *f { '#' } else { '.' }).collect();
        assert_eq!(drawn, "...#......##......#.....");
        let ring = [1.0, 1.0, 1.0, 1.0, -1.0, 1.0, 1.0, 1.0, 1.0];
        assert!(extent(&ring, &[0.0; 9], [3, 3], [0, 0]).iter().all(|found| *found));
    }
}
