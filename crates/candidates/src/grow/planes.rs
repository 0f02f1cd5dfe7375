//! Fault planes: steep planes along which links show breaks.
//!
//! A fault whose throw is near a whole period joins wrong reflectors without a visible step, but not on all
//! of its surface. What one link cannot show, hundreds along a plane can. The evidence E of links (see
//! `evidence`) is summed over pieces of planes at every place and in every orientation, and the best
//! orientation counts:
//!
//! `L(x, y, z) = max over strike, dip of Σ (E − T)` over the plane through (x, y, z), 17 traces along strike
//! × 52 samples down.
//!
//! Planes within 45° of the y axis are scanned with the links along x, the others with those along y.
//! Scanning orientations for the greatest mean follows D. Hale ("Methods to compute fault images, extract
//! fault surfaces, and estimate fault throws from 3D seismic images", Geophysics 78, 2013). He scans the
//! semblance of a volume; we scan the links that decide, a tenth as many values. A link is cut where L is
//! large enough and a ridge across the plane. All sums are of integers, so their order does not matter.

use super::evidence::{Noise, begins};
use super::links::{Links, NEXT_X, NEXT_Y, NONE};
use crate::extrema::Extrema;
use rayon::prelude::*;
use survey::{Cancelled, Progress};
use system::wide::{Wide, widest};

/// Samples of a cell: within it the steepest scanned plane shifts by one and a half traces.
const CELL_SAMPLES: usize = 4;
/// Traces of a cell along strike.
pub(crate) const CELL_TRACES: usize = 2;
/// Cells of a plane before and after its middle along strike.
const HALF_STRIKE: isize = 4;
/// Cells of a plane above and below its middle.
const HALF_DIP: isize = 6;
/// Strikes in steps of [`STRIKE_STEP`]: traces across per trace along, from −1 to 1.
const STRIKES: std::ops::RangeInclusive<isize> = -4..=4;
const STRIKE_STEP: f32 = 0.25;
/// Dips in steps of [`DIP_STEP`]: traces across per sample down, from −0.36 to 0.36.
const DIPS: std::ops::RangeInclusive<isize> = -6..=6;
const DIP_STEP: f32 = 0.06;
/// Cells by which rows are longer than the volume at both ends, so that shifted sums need no bounds tests.
const MARGIN: usize = 24;

/// T, in quarters: 2.25, where noise alone makes 1 on average.
const THRESHOLD: i16 = 9;

/// Greatest E with which a link counts, in quarters: many links with a little evidence outweigh a few with a
/// lot.
const CAP: i16 = 24;

/// A link is on the ridge when its L is at least this share of the greatest L within [`RIDGE_REACH`] traces
/// across.
const RIDGE: f32 = 0.7;

/// Distance across within which the ridge is searched, traces.
const RIDGE_REACH: usize = 2;

/// Progress steps of the search in a volume of `size`.
pub(crate) fn steps(size: [usize; 3]) -> usize {
    size[0].div_ceil(CELL_TRACES) + size[1].div_ceil(CELL_TRACES)
}

/// Sums of the evidence of the links along one axis, in cells `[along][down][across]`; across includes
/// margins.
struct EvidenceGrid {
    along: usize,
    down: usize,
    width: usize,
    cells: Vec<i16>,
}

impl EvidenceGrid {
    fn empty(across: usize, along: usize, samples: usize) -> Self {
        let (along, down) = (along.div_ceil(CELL_TRACES), samples.div_ceil(CELL_SAMPLES));
        let width = across + 2 * MARGIN;
        Self { along, down, width, cells: vec![0; along * down * width] }
    }

    fn index(&self, across: usize, along: usize, z: f32) -> usize {
        ((along / CELL_TRACES) * self.down + interval(z, self.down)) * self.width + MARGIN + across
    }
}

/// Count of cells that are summed at once.
const CELLS: usize = 64;

/// L of every cell.
fn scan(grid: &EvidenceGrid, progress: &Progress) -> Result<EvidenceGrid, Cancelled> {
    let mut best = EvidenceGrid { cells: vec![0; grid.cells.len()], ..*grid };
    let slab = grid.down * grid.width;
    best.cells.par_chunks_mut(slab.max(1)).enumerate().try_for_each_init(
        || vec![0i16; slab],
        |striking, (along, best)| {
            widest(Scan { grid, along, striking, best });
            progress.step(1)
        },
    )?;
    Ok(best)
}

/// The scan of all planes through the cells at one place along strike.
struct Scan<'a> {
    grid: &'a EvidenceGrid,
    along: usize,
    /// Scratch memory for sums along strike.
    striking: &'a mut [i16],
    best: &'a mut [i16],
}

impl Wide for Scan<'_> {
    type Output = ();

    #[inline(always)]
    fn run(self) {
        let Self { grid, along, striking, best } = self;
        let width = grid.width;
        // First cell of row `other`, shifted.
        let start = |other: usize, shift: f32| ((other * width + MARGIN) as isize + shift.round() as isize) as usize;
        let mut rows = Vec::with_capacity((2 * HALF_STRIKE.max(HALF_DIP) + 1) as usize);
        for strike in STRIKES {
            for down in 0..grid.down {
                rows.clear();
                for step in -HALF_STRIKE..=HALF_STRIKE {
                    let other = along.checked_add_signed(step).filter(|&other| other < grid.along);
                    let shift = STRIKE_STEP * (strike * step) as f32 * CELL_TRACES as f32;
                    rows.extend(other.map(|other| start(other * grid.down + down, shift)));
                }
                let row = &mut striking[down * width + MARGIN..(down + 1) * width - MARGIN];
                row.fill(i16::MIN);
                raise(row, &grid.cells, &rows);
            }
            for dip in DIPS {
                for down in 0..grid.down {
                    rows.clear();
                    for step in -HALF_DIP..=HALF_DIP {
                        let other = down.checked_add_signed(step).filter(|&other| other < grid.down);
                        let shift = DIP_STEP * (dip * step) as f32 * CELL_SAMPLES as f32;
                        rows.extend(other.map(|other| start(other, shift)));
                    }
                    raise(&mut best[down * width + MARGIN..(down + 1) * width - MARGIN], striking, &rows);
                }
            }
        }
    }
}

/// Raises `best` to the sums of the rows of `cells` that begin at `rows`, where those are greater.
#[inline(always)]
fn raise(best: &mut [i16], cells: &[i16], rows: &[usize]) {
    let Some(last) = best.len().checked_sub(CELLS) else {
        (0..best.len()).for_each(|at| raise_at::<1>(best, cells, rows, at));
        return;
    };
    // The last group may overlap the one before; taking a maximum twice changes nothing.
    (0..best.len()).step_by(CELLS).for_each(|at| raise_at::<CELLS>(best, cells, rows, at.min(last)));
}

#[inline(always)]
fn raise_at<const N: usize>(best: &mut [i16], cells: &[i16], rows: &[usize], at: usize) {
    let mut sums = [0i16; N];
    for row in rows {
        let from = cells[row + at..].first_chunk::<N>().expect("margins keep shifted rows inside the cells");
        for n in 0..N {
            sums[n] = sums[n].saturating_add(from[n]);
        }
    }
    let best = best[at..].first_chunk_mut::<N>().expect("a group lies inside its row");
    for n in 0..N {
        best[n] = best[n].max(sums[n]);
    }
}

/// For each kind, whether the links to x + 1 and y + 1 of each extremum cross a fault, i.e. have an L of at
/// least `least` on a ridge.
///
/// # Errors
/// [`Cancelled`] by the user.
pub(crate) fn cuts(
    kinds: &[(&Extrema, &Links, &[[u8; 2]], &Noise)],
    least: f32,
    progress: &Progress,
) -> Result<Vec<Vec<[bool; 2]>>, Cancelled> {
    let mut cut: Vec<Vec<[bool; 2]>> = kinds.iter().map(|(extrema, ..)| vec![[false; 2]; extrema.len()]).collect();
    for axis in 0..2 {
        cuts_along(axis, kinds, least, &mut cut, progress)?;
    }
    Ok(cut)
}

/// How far along each axis, traces, what is known of links decides which links along `axis` are cut: the planes' reach
/// across with the ridge, and along strike.
pub(crate) fn reach(axis: usize) -> [usize; 2] {
    let (steps, across) = (HALF_STRIKE as usize * CELL_TRACES, |slope: f32, cells: isize, edge: usize| {
        (slope * (cells as usize * edge) as f32).ceil() as usize
    });
    let strike = across(STRIKE_STEP * *STRIKES.end() as f32, HALF_STRIKE, CELL_TRACES);
    let dip = across(DIP_STEP * *DIPS.end() as f32, HALF_DIP, CELL_SAMPLES);
    let (across, along) = (strike + dip + 1 + RIDGE_REACH + 2, steps + CELL_TRACES + 1);
    if axis == 0 { [across, along] } else { [along, across] }
}

/// [`cuts`] along one axis.
///
/// # Errors
/// [`Cancelled`] by the user.
pub(crate) fn cuts_along(
    axis: usize,
    kinds: &[(&Extrema, &Links, &[[u8; 2]], &Noise)],
    least: f32,
    cut: &mut [Vec<[bool; 2]>],
    progress: &Progress,
) -> Result<(), Cancelled> {
    let Some((first, ..)) = kinds.first() else { return Ok(()) };
    let [nx, ny, nz] = first.size;
    let (across, along) = if axis == 0 { (nx, ny) } else { (ny, nx) };
    let mut grid = EvidenceGrid::empty(across, along, nz);
    for (extrema, links, evidence, noise) in kinds {
        collect(&mut grid, extrema, links, evidence, noise, axis);
    }
    let likelihood = scan(&grid, progress)?;
    drop(grid);
    for ((extrema, ..), cut) in kinds.iter().zip(cut) {
        extrema.split_inlines(cut).into_par_iter().enumerate().for_each(|(x, line)| {
            let first = extrema.on_inline(x).start;
            for y in 0..ny {
                let (across, along) = if axis == 0 { (x, y) } else { (y, x) };
                for v in extrema.on_trace(x, y) {
                    line[v - first][axis] = on_ridge(&likelihood, likelihood.index(across, along, extrema.z[v]), least);
                }
            }
        });
    }
    Ok(())
}

/// Adds the evidence of the links of one kind along `axis`.
fn collect(
    grid: &mut EvidenceGrid,
    extrema: &Extrema,
    links: &Links,
    evidence: &[[u8; 2]],
    noise: &Noise,
    axis: usize,
) {
    let [nx, ny, _] = extrema.size;
    let direction = [NEXT_X, NEXT_Y][axis];
    let (across_count, along_count) = if axis == 0 { (nx, ny) } else { (ny, nx) };
    let EvidenceGrid { down, width, .. } = *grid;
    grid.cells.par_chunks_mut((down * width).max(1)).enumerate().for_each(|(cell, slab)| {
        let add = |slab: &mut [i16], across: usize, z: f32, value: i16| {
            let at = &mut slab[interval(z, down) * width + MARGIN + across];
            *at = at.saturating_add(value);
        };
        for along in cell * CELL_TRACES..((cell + 1) * CELL_TRACES).min(along_count) {
            for across in 0..across_count {
                let (x, y) = if axis == 0 { (across, along) } else { (along, across) };
                for v in extrema.on_trace(x, y) {
                    let value = i16::from(evidence[v][axis]).min(CAP);
                    if across + 1 < across_count && (value > 0 || links.to[direction][v] != NONE) {
                        add(slab, across, extrema.z[v], value - THRESHOLD);
                    }
                    if across > 0 && begins(extrema, links, v, noise)[axis] {
                        add(slab, across - 1, extrema.z[v], CAP - THRESHOLD);
                    }
                }
            }
        }
    });
}

/// The cell, counted down, that contains a depth.
fn interval(z: f32, down: usize) -> usize {
    (z.max(0.0) as usize / CELL_SAMPLES).min(down - 1)
}

/// Whether L at cell `index` is large enough and on a ridge.
fn on_ridge(likelihood: &EvidenceGrid, index: usize, least: f32) -> bool {
    let here = likelihood.cells[index];
    if f32::from(here) < 4.0 * least {
        return false;
    }
    let around = &likelihood.cells[index - RIDGE_REACH..=index + RIDGE_REACH];
    let top = around.iter().copied().fold(here, i16::max);
    f32::from(here) >= RIDGE * f32::from(top)
}
