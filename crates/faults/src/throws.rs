//! The throw over a whole surface, and whether it is a fault: its two sides match after one shift, do not without, and beds
//! just beside it need none.

use crate::grow::{dilated, largest};
use crate::sheet::{Quadratic, Sheet, WIDTH, blurred};
use crate::sides::{FAR, PairSums, Sides};
use attribute::likelihood::ROW;
use rayon::prelude::*;

/// Samples and traces to either side that a window compares.
const DOWN: usize = 12;
const ALONG: usize = 2;
/// What a step of one sample between cells costs, and a greater one.
const STEP: f32 = 0.08;
const JUMP: f32 = 0.4;
/// Distance of the copies of the surface on which beds must run through, traces.
const BESIDE: f32 = 5.0;
/// Distance from the smooth throw within which one agrees, samples.
const SAME_THROW: f64 = 3.0;
/// What a throw that does not hold farther away counts, and how much more one that does: a narrow graben is near its other
/// side.
const HOLDS: [f32; 2] = [0.3, 1.2];
/// Least likeness of beds beside a fault.
const BEDDED: f32 = 0.3;
/// Least smoothed gain where there is a fault.
const TOLD: f32 = 0.12;

/// What the two sides of a surface tell at a cell.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CellOffset {
    /// Samples; positive where the side across strike lies deeper.
    pub throw: f32,
    /// Gain in correlation by the throw.
    pub gain: f32,
    /// Correlation after the throw.
    pub matched: f32,
    /// Correlation after the throw of beds farther away; NaN where there are none.
    pub far: f32,
    /// Correlation without.
    pub straight: f32,
    /// Correlation without a shift on copies of the surface to either side.
    pub beside: [f32; 2],
}

/// What the two sides of a surface tell.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Offsets {
    /// Of each cell of the sheet; `None` where it is not there or a side is missing.
    pub cells: Vec<Option<CellOffset>>,
    /// Mean gain in correlation by the throw.
    pub mean_gain: f32,
    /// Mean correlation after the throw.
    pub matched: f32,
    /// The same of beds farther away.
    pub far: f32,
    /// Share of the cells with a throw of at least two samples of the commoner sign.
    pub one_sign: f32,
    /// Mean correlation without a shift on copies to either side.
    pub beside: [f32; 2],
    /// The lesser of these, less that on the surface.
    pub contrast: f32,
    /// Greatest throw that was looked for, samples.
    pub greatest: f32,
    /// Median throw, samples.
    pub median: f32,
    /// The throw, without its sign, that a tenth of them exceed, samples.
    pub upper_decile: f32,
    /// Share of the throws near one that varies smoothly over the surface.
    pub constant: f32,
}

/// The amplitudes on both sides, on traces along strike and samples.
struct Panels {
    lines: usize,
    depth: usize,
    first: [i32; 2],
    sides: [Vec<f32>; 2],
}

/// Reads both sides of a surface, moved by `off` traces across.
fn panels(sides: Sides<'_>, sheet: &Sheet, greatest: usize, off: f32) -> Panels {
    let nz = sides.volume.size()[2];
    let width = WIDTH as i32;
    let first = [sheet.low[0] * width, (sheet.low[1] * ROW as i32 - (greatest / 2 + DOWN + 1) as i32).max(0)];
    let last = ((sheet.low[1] + sheet.cells[1] as i32) * ROW as i32 + (greatest / 2 + DOWN + 1) as i32).min(nz as i32);
    let (lines, depth) = (sheet.cells[0] * width as usize, (last - first[1]).max(0) as usize);
    // Rows are read as far as a window may reach from a cell that is there.
    let reach = (DOWN + greatest / 2).div_ceil(ROW) + 1;
    let near = dilated(&sheet.there, sheet.cells, reach);
    let both = [-1.0f32, 1.0].map(|sign| {
        let mut all = vec![f32::NAN; lines * depth];
        all.par_chunks_mut(depth.max(1)).enumerate().for_each(|(line, out)| {
            let u = (first[0] + line as i32) as f32;
            for (k, out) in out.iter_mut().enumerate() {
                let z = (first[1] + k as i32) as f32;
                let cell = ((u / WIDTH).round() as i32 - sheet.low[0]).clamp(0, sheet.cells[0] as i32 - 1) as usize;
                let row = ((z / ROW as f32).round() as i32 - sheet.low[1]).clamp(0, sheet.cells[1] as i32 - 1) as usize;
                if !near[cell * sheet.cells[1] + row] {
                    continue;
                }
                let slope = 0.5 * (sheet.height_at(u + 1.0, z) - sheet.height_at(u - 1.0, z));
                let (along, across) = (sheet.frame.along, sheet.frame.across);
                let normal = [across[0] - slope * along[0], across[1] - slope * along[1]];
                let length = normal[0].hypot(normal[1]);
                let at = sheet.frame.lines(u, sheet.height_at(u, z) + off);
                *out = sides.beside(at, normal.map(|c| sign * c / length), z);
            }
        });
        all
    });
    Panels { lines, depth, first, sides: both }
}

impl Panels {
    /// Correlation of windows around the cells of a sheet under a shift; NaN where a cell is not there or a side is missing.
    fn correlations(&self, sheet: &Sheet, lag: i32) -> Vec<f32> {
        let (up, down) = (lag.div_euclid(2) as isize, (lag - lag.div_euclid(2)) as isize);
        let columns: Vec<Vec<PairSums>> = (0..self.lines)
            .map(|line| {
                let row = line * self.depth;
                let value = |side: usize, k: isize| {
                    let inside = k >= 0 && (k as usize) < self.depth;
                    if inside { self.sides[side][row + k as usize] } else { f32::NAN }
                };
                let mut sums = vec![PairSums::default(); self.depth + 1];
                for k in 0..self.depth {
                    let (a, b) = (value(0, k as isize - up), value(1, k as isize + down));
                    let (a, b) = if (a * b).is_finite() { (a, b) } else { (0.0, 0.0) };
                    let before = sums[k];
                    sums[k + 1] = PairSums {
                        product: before.product + a * b,
                        left: before.left + a * a,
                        right: before.right + b * b,
                    };
                }
                sums
            })
            .collect();
        (0..sheet.height.len())
            .map(|n| {
                if !sheet.there[n] {
                    return f32::NAN;
                }
                let line = (n / sheet.cells[1]) * WIDTH as usize;
                let k = (sheet.low[1] + (n % sheet.cells[1]) as i32) * ROW as i32 - self.first[1];
                let low = (k - DOWN as i32).clamp(0, self.depth as i32) as usize;
                let high = (k + DOWN as i32 + 1).clamp(0, self.depth as i32) as usize;
                let mut sums = PairSums::default();
                for column in &columns[line.saturating_sub(ALONG)..(line + ALONG + 1).min(self.lines)] {
                    sums.product += column[high].product - column[low].product;
                    sums.left += column[high].left - column[low].left;
                    sums.right += column[high].right - column[low].right;
                }
                if sums.left > 0.0 && sums.right > 0.0 { sums.correlation() } else { f32::NAN }
            })
            .collect()
    }
}

/// Mean correlation without a shift on a surface, and on copies of it to either side.
pub(crate) fn likeness(sides: Sides<'_>, sheet: &Sheet) -> [f32; 3] {
    [0.0, -BESIDE, BESIDE].map(|off| {
        let all = panels(sides, sheet, 2, off).correlations(sheet, 0);
        let known: Vec<f32> = all.into_iter().filter(|value| value.is_finite()).collect();
        known.iter().sum::<f32>() / known.len().max(1) as f32
    })
}

/// Measures a surface. `greatest` is the greatest throw, samples.
pub(crate) fn offsets(sides: Sides<'_>, sheet: &Sheet, greatest: i32) -> Offsets {
    let on = panels(sides, sheet, greatest as usize, 0.0);
    let all: Vec<Vec<f32>> = (-greatest..=greatest).into_par_iter().map(|lag| on.correlations(sheet, lag)).collect();
    let at = |lag: i32, n: usize| all[(lag + greatest) as usize][n];
    let chosen = matched(&all, sheet);
    let beside: Vec<Vec<f32>> =
        [-BESIDE, BESIDE].into_iter().map(|off| panels(sides, sheet, 2, off).correlations(sheet, 0)).collect();
    // Whether the throw holds farther from the fault, where an error of the slopes would have grown.
    let beyond = panels(Sides { off: FAR, ..sides }, sheet, greatest as usize, 0.0);
    let mut lags: Vec<usize> = chosen.iter().flatten().copied().collect();
    lags.sort_unstable();
    lags.dedup();
    let far: Vec<Vec<f32>> = lags.par_iter().map(|&lag| beyond.correlations(sheet, lag as i32 - greatest)).collect();
    let far_at = |lag: usize, n: usize| lags.binary_search(&lag).map_or(f32::NAN, |of| far[of][n]);
    let count = sheet.height.len();
    let mut found = Offsets { cells: vec![None; count], greatest: greatest as f32, ..Offsets::default() };
    for n in 0..count {
        let Some(lag) = chosen[n] else { continue };
        let far = far_at(lag, n);
        let lag = lag as i32 - greatest;
        let whole = (-1..=1).map(|lag| at(lag, n)).fold(0.0f32, f32::max);
        let matched = at(lag, n);
        let beside = [beside[0][n], beside[1][n]];
        found.cells[n] =
            Some(CellOffset { throw: lag as f32, gain: matched - whole, matched, far, straight: at(0, n), beside });
    }
    found
}

impl Offsets {
    /// Where the surface has a throw: the largest part in which the gain, smoothed, is enough.
    pub(crate) fn told(&self, sheet: &Sheet) -> Vec<bool> {
        let known: Vec<f32> = self.cells.iter().map(|cell| f32::from(u8::from(cell.is_some()))).collect();
        let gain: Vec<f32> = self.cells.iter().map(|cell| cell.map_or(0.0, |cell| cell.gain)).collect();
        let (gain, known) = (blurred(&gain, sheet.cells), blurred(&known, sheet.cells));
        let told: Vec<bool> =
            (0..gain.len()).map(|n| sheet.there[n] && known[n] > 0.0 && gain[n] / known[n] >= TOLD).collect();
        largest(&told, sheet.cells)
    }

    /// How sure it is that a surface is a fault, 0 to 1: the share of the match that the throw brings, the share of the
    /// likeness beside it that is lost on it, twice, how much of it agrees in sense and amount, and less where the throw does
    /// not hold farther away, as that of wrong slopes does not. 0 where beds beside it do not match themselves, and where the
    /// throw lies at the end of what was looked for.
    pub fn evidence(&self) -> f32 {
        let least = self.beside[0].min(self.beside[1]);
        if least < BEDDED || self.matched <= 0.0 || self.median.abs() >= self.greatest - 1.0 {
            return 0.0;
        }
        let lost = (self.contrast / least).clamp(0.0, 1.0);
        let holds = (HOLDS[0] + HOLDS[1] * (self.far / self.matched).max(0.0)).min(1.0);
        (self.mean_gain / self.matched).clamp(0.0, 1.0) * lost * lost * self.one_sign * self.constant * holds
    }

    /// Sums up what lies where a sheet is.
    pub(crate) fn summarize(&mut self, sheet: &Sheet) {
        let cells: Vec<CellOffset> =
            self.cells.iter().zip(&sheet.there).filter(|(_, there)| **there).filter_map(|(cell, _)| *cell).collect();
        let count = cells.len().max(1) as f32;
        let mean = |of: &dyn Fn(&CellOffset) -> f32| cells.iter().map(of).sum::<f32>() / count;
        self.mean_gain = mean(&|cell| cell.gain);
        self.matched = mean(&|cell| cell.matched);
        let known: Vec<f32> = cells.iter().map(|cell| cell.far).filter(|far| far.is_finite()).collect();
        self.far = known.iter().sum::<f32>() / known.len().max(1) as f32;
        let straight = mean(&|cell| cell.straight);
        let side = |n: usize| {
            let there: Vec<f32> = cells.iter().map(|cell| cell.beside[n]).filter(|value| value.is_finite()).collect();
            there.iter().sum::<f32>() / there.len().max(1) as f32
        };
        self.beside = [side(0), side(1)];
        self.contrast = self.beside[0].min(self.beside[1]) - straight;
        let mut throws: Vec<f32> = cells.iter().map(|cell| cell.throw).collect();
        throws.sort_by(f32::total_cmp);
        self.median = throws.get(throws.len() / 2).copied().unwrap_or(0.0);
        let mut sizes: Vec<f32> = throws.iter().map(|throw| throw.abs()).collect();
        sizes.sort_by(f32::total_cmp);
        self.upper_decile = sizes.get(9 * sizes.len() / 10).copied().unwrap_or(0.0);
        let share = |is: &dyn Fn(f32) -> bool| throws.iter().filter(|&&t| is(t)).count() as f32 / count;
        self.one_sign = share(&|t| t >= 2.0).max(share(&|t| t <= -2.0));
        let points: Vec<[f64; 4]> = (0..self.cells.len())
            .filter(|&n| sheet.there[n])
            .filter_map(|n| {
                let [u, z] = sheet.place(n).map(f64::from);
                self.cells[n].map(|cell| [u, z, f64::from(cell.throw), 1.0])
            })
            .collect();
        let smooth = Quadratic::through(&points);
        let near = points.iter().filter(|p| (p[2] - smooth.at(p[0], p[1])).abs() <= SAME_THROW).count();
        self.constant = near as f32 / count;
    }
}

/// The lag of each cell that matches best together with its neighbours: semi-global matching over four directions
/// (Hirschmüller 2008).
fn matched(all: &[Vec<f32>], sheet: &Sheet) -> Vec<Option<usize>> {
    let (lags, cells) = (all.len(), sheet.cells);
    let count = cells[0] * cells[1];
    let is_known = |n: usize| all.iter().all(|of_lag| of_lag[n].is_finite());
    let known: Vec<bool> = (0..count).map(|n| sheet.there[n] && is_known(n)).collect();
    let mut total = vec![0.0f32; count * lags];
    let mut walk = |along: bool, forward: bool| {
        let (lines, length) = if along { (cells[1], cells[0]) } else { (cells[0], cells[1]) };
        for line in 0..lines {
            let mut before: Option<Vec<f32>> = None;
            for k in 0..length {
                let k = if forward { k } else { length - 1 - k };
                let n = if along { k * cells[1] + line } else { line * cells[1] + k };
                if !known[n] {
                    before = None;
                    continue;
                }
                let cost = |lag: usize| -all[lag][n];
                let here: Vec<f32> = match &before {
                    None => (0..lags).map(cost).collect(),
                    Some(before) => {
                        let least = before.iter().copied().fold(f32::INFINITY, f32::min);
                        (0..lags)
                            .map(|lag| {
                                let mut best = before[lag].min(least + JUMP);
                                if lag > 0 {
                                    best = best.min(before[lag - 1] + STEP);
                                }
                                if lag + 1 < lags {
                                    best = best.min(before[lag + 1] + STEP);
                                }
                                cost(lag) + best - least
                            })
                            .collect()
                    }
                };
                total[n * lags..(n + 1) * lags].iter_mut().zip(&here).for_each(|(sum, value)| *sum += value);
                before = Some(here);
            }
        }
    };
    for along in [false, true] {
        for forward in [false, true] {
            walk(along, forward);
        }
    }
    (0..count)
        .map(|n| {
            let costs = &total[n * lags..(n + 1) * lags];
            known[n].then(|| (0..lags).min_by(|&a, &b| costs[a].total_cmp(&costs[b])).unwrap_or(lags / 2))
        })
        .collect()
}
