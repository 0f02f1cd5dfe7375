//! Faults: steep planes along which links speak for a break.
//!
//! A fault whose throw is near a whole period joins wrong reflectors without a visible step, but not along all of its surface: what one
//! link cannot tell, hundreds along a plane can. The evidence E of links (see `evidence`) is summed over pieces of planes, for
//! every place and every orientation, and the best orientation counts:
//!
//! `L(x, y, z) = max over strike, dip of Σ (E − T)` over the plane through (x, y, z), 17 traces along strike × 52 samples down.
//!
//! Planes within 45° of the y axis are scanned with the links along x, the others with those along y. Scanning
//! orientations for the greatest mean is Hale's (2013, "Methods to compute fault images, extract fault surfaces, and estimate fault throws
//! from 3D seismic images"); he scans the semblance of a volume, we the links that decide, at a
//! tenth of the values. A link is cut where L is positive enough and a ridge across the plane. All sums are of whole numbers, so their order does not
//! matter.

use super::evidence::{Noise, begins};
use super::links::{Links, NEXT_X, NEXT_Y, NONE};
use crate::extrema::Extrema;
use rayon::prelude::*;

/// Samples of a cell: within it the steepest plane scanned shifts by one and a half traces.
const CELL_SAMPLES: usize = 4;
/// Traces along strike of a cell.
const CELL_TRACES: usize = 2;
/// Cells before and after the middle along strike.
const HALF_STRIKE: isize = 4;
/// Cells above and below the middle.
const HALF_DIP: isize = 6;
/// Strikes: traces across a trace along, in steps of a quarter from −1 to 1.
const STRIKES: std::ops::RangeInclusive<isize> = -4..=4;
const STRIKE_STEP: f32 = 0.25;
/// Dips: traces across a sample down, in steps of 0.06 from −0.36 to 0.36.
const DIPS: std::ops::RangeInclusive<isize> = -6..=6;
const DIP_STEP: f32 = 0.06;
/// Cells by which rows are longer than the volume at both ends, so that shifted sums need no tests.
const MARGIN: usize = 24;

/// T, in quarters: 2.25 where noise alone makes 1 on average.
const THRESHOLD: i16 = 9;

/// Greatest E that a link counts with, in quarters: many links that speak a little outweigh a few that speak loudly.
const CAP: i16 = 24;

/// A link is on the ridge when its L is at least this share of the greatest within two traces across.
const RIDGE: f32 = 0.7;

/// Traces across within which the ridge is looked for.
const RIDGE_REACH: usize = 2;

/// The cells that the evidence of the links along one axis is summed in: `[along][down][across]`, across including margins.
struct Grid {
    along: usize,
    down: usize,
    width: usize,
    cells: Vec<i16>,
}

impl Grid {
    fn empty(across: usize, along: usize, samples: usize) -> Self {
        let (along, down) = (along.div_ceil(CELL_TRACES), samples.div_ceil(CELL_SAMPLES));
        let width = across + 2 * MARGIN;
        Self { along, down, width, cells: vec![0; along * down * width] }
    }

    fn index(&self, across: usize, along: usize, z: f32) -> usize {
        let down = (z.max(0.0) as usize / CELL_SAMPLES).min(self.down - 1);
        ((along / CELL_TRACES) * self.down + down) * self.width + MARGIN + across
    }

    fn row(&self, along: usize, down: usize) -> &[i16] {
        let start = (along * self.down + down) * self.width;
        &self.cells[start..start + self.width]
    }
}

/// Sums `from` shifted by `shift` into `into`, margins apart.
fn add_shifted(into: &mut [i16], from: &[i16], shift: isize) {
    let count = into.len() - 2 * MARGIN;
    let start = (MARGIN as isize + shift) as usize;
    for (sum, value) in into[MARGIN..MARGIN + count].iter_mut().zip(&from[start..start + count]) {
        *sum = sum.saturating_add(*value);
    }
}

/// L of every cell.
fn scan(grid: &Grid) -> Grid {
    let mut best = Grid { cells: vec![0; grid.cells.len()], ..*grid };
    let slab = grid.down * grid.width;
    best.cells.par_chunks_mut(slab.max(1)).enumerate().for_each(|(along, best)| {
        let mut striking = vec![0i16; slab];
        let mut sum = vec![0i16; grid.width];
        for strike in STRIKES {
            striking.fill(0);
            for step in -HALF_STRIKE..=HALF_STRIKE {
                let Some(other) = along.checked_add_signed(step).filter(|&other| other < grid.along) else { continue };
                let shift = (STRIKE_STEP * (strike * step) as f32 * CELL_TRACES as f32).round() as isize;
                for down in 0..grid.down {
                    add_shifted(&mut striking[down * grid.width..][..grid.width], grid.row(other, down), shift);
                }
            }
            for dip in DIPS {
                for down in 0..grid.down {
                    sum.fill(0);
                    for step in -HALF_DIP..=HALF_DIP {
                        let Some(other) = down.checked_add_signed(step).filter(|&other| other < grid.down) else {
                            continue;
                        };
                        let shift = (DIP_STEP * (dip * step) as f32 * CELL_SAMPLES as f32).round() as isize;
                        add_shifted(&mut sum, &striking[other * grid.width..][..grid.width], shift);
                    }
                    for (best, sum) in best[down * grid.width..][..grid.width].iter_mut().zip(&sum) {
                        *best = (*best).max(*sum);
                    }
                }
            }
        }
    });
    best
}

/// For each kind, whether the links to x + 1 and y + 1 of each extremum cross a fault: L of at least `least`.
pub(super) fn cuts(kinds: &[(&Extrema, &Links, &[[u8; 2]], &Noise)], least: f32) -> Vec<Vec<[bool; 2]>> {
    let mut cut: Vec<Vec<[bool; 2]>> = kinds.iter().map(|(extrema, ..)| vec![[false; 2]; extrema.len()]).collect();
    let Some((first, ..)) = kinds.first() else { return cut };
    let [nx, ny, nz] = first.size;
    for axis in 0..2 {
        let (across, along) = if axis == 0 { (nx, ny) } else { (ny, nx) };
        let mut grid = Grid::empty(across, along, nz);
        for (extrema, links, evidence, noise) in kinds {
            collect(&mut grid, extrema, links, evidence, noise, axis);
        }
        let likelihood = scan(&grid);
        drop(grid);
        for ((extrema, ..), cut) in kinds.iter().zip(&mut cut) {
            extrema.split_inlines(cut).into_par_iter().enumerate().for_each(|(x, line)| {
                let first = extrema.on_inline(x).start;
                for y in 0..ny {
                    let (across, along) = if axis == 0 { (x, y) } else { (y, x) };
                    for v in extrema.on_trace(x, y) {
                        line[v - first][axis] =
                            on_ridge(&likelihood, likelihood.index(across, along, extrema.z[v]), least);
                    }
                }
            });
        }
    }
    cut
}

/// Adds the evidence of the links along `axis` of one kind. A pass over the links on one thread: cheap beside the scan.
fn collect(grid: &mut Grid, extrema: &Extrema, links: &Links, evidence: &[[u8; 2]], noise: &Noise, axis: usize) {
    let [nx, ny, _] = extrema.size;
    let direction = [NEXT_X, NEXT_Y][axis];
    let last = [nx, ny][axis] - 1;
    for x in 0..nx {
        for y in 0..ny {
            let (across, along) = if axis == 0 { (x, y) } else { (y, x) };
            for v in extrema.on_trace(x, y) {
                let value = i16::from(evidence[v][axis]).min(CAP);
                if across < last && (value > 0 || links.to[direction][v] != NONE) {
                    let index = grid.index(across, along, extrema.z[v]);
                    grid.cells[index] = grid.cells[index].saturating_add(value - THRESHOLD);
                }
                if across > 0 && begins(extrema, links, v, noise)[axis] {
                    let index = grid.index(across - 1, along, extrema.z[v]);
                    grid.cells[index] = grid.cells[index].saturating_add(CAP - THRESHOLD);
                }
            }
        }
    }
}

/// Whether the cell at `index` is high enough and on a ridge.
fn on_ridge(likelihood: &Grid, index: usize, least: f32) -> bool {
    let here = likelihood.cells[index];
    if f32::from(here) < 4.0 * least {
        return false;
    }
    let around = &likelihood.cells[index - RIDGE_REACH..=index + RIDGE_REACH];
    let top = around.iter().copied().max().unwrap_or(here);
    f32::from(here) >= RIDGE * f32::from(top)
}
