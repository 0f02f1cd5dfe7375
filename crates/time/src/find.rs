//! Faults found before any horizon exists: surfaces along which patches end.
//!
//! Where a patch goes on to the next trace there is no fault between them; where it ends there may be. The evidence of a
//! cell is `ends − GOES_ON · (patches that go on)`. A fault is the quadratic
//!
//! `across = a + b u + c v + d u² + e v²`,  u along its lines and v down, both from −1 to 1,
//!
//! with the most evidence in a band along it: planes of all places, strikes and dips are scanned, the best is bent, its
//! throw found where it is certain, its [`extent`] from both, and what it explains is taken away before the next one.
//! Space: voxels.

use crate::cuts::{Across, Cut};
use crate::extent::{Misfits, extent};
use crate::hubs::Hubs;
use crate::links::Links;
use crate::throws::{Throw, throw_of};
use interp::Surfaces;
use rayon::prelude::*;
use survey::{Cancelled, Progress, Volume};

/// Lines and samples of a cell.
const CELL: [usize; 2] = [4, 4];
/// What a patch that goes on counts, against one that ends.
const GOES_ON: f32 = 0.45;
/// Steepest strike, traces across over traces along, and its steps.
const STRIKE: (f32, i32) = (0.5, 8);
/// Gentlest dip, traces across a sample, and its steps.
const DIP: (f32, i32) = (0.5, 10);
/// Least share of the lines and samples that a fault reaches over.
const LEAST_SHARE: f32 = 0.12;
/// Least mean evidence of a cell in which a fault is certain.
const CERTAIN: f32 = 0.35;
/// Most faults across either axis.
const MOST: usize = 6;
/// Traces beside a fault in which evidence is its own.
const OWN: f32 = 4.0;
/// Cells along and down over which the extent of a fault is decided.
const EXTENT: [usize; 2] = [3, 4];

/// Cells along the shorter side of a fault that are looked at in every plane.
const SCANNED: usize = 20;
/// Planes whose evidence is summed over all cells, and those that are bent.
const MOST_SUMMED: usize = 400;
const MOST_BENT: usize = 12;

/// Evidence `[line cell][sample cell][across]`.
struct FaultEvidence {
    lines: usize,
    samples: usize,
    cells: [usize; 2],
    width: usize,
    values: Vec<f32>,
}

impl FaultEvidence {
    fn new(hubs: &Hubs, across: Across) -> Self {
        let [nx, ny, nz] = hubs.size;
        let (width, lines) = if across == Across::Inlines { (nx, ny) } else { (ny, nx) };
        let cells = [lines.div_ceil(CELL[0]), nz.div_ceil(CELL[1])];
        let mut values = vec![0.0f32; cells[0] * cells[1] * width];
        let trace = |at: usize, line: usize| if across == Across::Inlines { at * ny + line } else { line * ny + at };
        values.par_chunks_mut(cells[1] * width).enumerate().for_each(|(cell, values)| {
            for line in cell * CELL[0]..((cell + 1) * CELL[0]).min(lines) {
                for at in 0..width - 1 {
                    let (a, b) = (trace(at, line), trace(at + 1, line));
                    for (here, there) in [(a, b), (b, a)] {
                        for v in hubs.on_trace(here) {
                            let goes_on = hubs.on_trace(there).any(|w| hubs.hub[w] == hubs.hub[v]);
                            let down = (hubs.z[v] as usize / CELL[1]).min(cells[1] - 1);
                            values[down * width + at] += if goes_on { -GOES_ON } else { 1.0 };
                        }
                    }
                }
            }
        });
        Self { lines, samples: nz, cells, width, values }
    }

    /// u and v of a cell.
    fn scaled(&self, along: usize, down: usize) -> [f32; 2] {
        let scaled = |n: usize, count: usize| 2.0 * (n as f32 + 0.5) / count as f32 - 1.0;
        [scaled(along, self.cells[0]), scaled(down, self.cells[1])]
    }

    /// The evidence of a cell in a band of two traces around a place across.
    #[inline]
    fn at(&self, along: usize, down: usize, place: f32) -> f32 {
        // The link from trace n to n + 1 is crossed at n + 1/2.
        let place = place - 0.5;
        if !(place >= 0.0 && place < (self.width - 2) as f32) {
            return 0.0;
        }
        let (low, row) = (place as usize, (along * self.cells[1] + down) * self.width);
        self.values[row + low] + self.values[row + low + 1]
    }

    fn sum(&self, terms: &[f32; 5]) -> f32 {
        self.sum_of_every(1, terms)
    }

    /// The evidence of every n-th cell along and down.
    fn sum_of_every(&self, step: usize, terms: &[f32; 5]) -> f32 {
        let mut sum = 0.0;
        for along in (0..self.cells[0]).step_by(step) {
            for down in (0..self.cells[1]).step_by(step) {
                let [u, v] = self.scaled(along, down);
                sum += self.at(along, down, quadratic(terms, u, v)).max(-2.0);
            }
        }
        sum
    }

    /// The plane with the most evidence, bent.
    fn best(&self) -> ([f32; 5], f32) {
        let (half_along, half_down) = (0.5 * self.lines as f32, 0.5 * self.samples as f32);
        let planes: Vec<[f32; 5]> = (-STRIKE.1..=STRIKE.1)
            .flat_map(|b| (-DIP.1..=DIP.1).map(move |c| (b, c)))
            .flat_map(|(b, c)| {
                let b = b as f32 / STRIKE.1 as f32 * STRIKE.0 * half_along;
                let c = c as f32 / DIP.1 as f32 * DIP.0 * half_down;
                (0..self.width).step_by(2).map(move |a| [a as f32, b, c, 0.0, 0.0])
            })
            .collect();
        // Some of the cells tell which planes are worth all of them.
        let step = (self.cells[0].min(self.cells[1]) / SCANNED).max(1);
        let rough: Vec<f32> = planes.par_iter().map(|terms| self.sum_of_every(step, terms)).collect();
        let mut order: Vec<usize> = (0..planes.len()).collect();
        order.sort_by(|&m, &n| rough[n].total_cmp(&rough[m]).then(m.cmp(&n)));
        order.truncate(MOST_SUMMED);
        let mut summed: Vec<(usize, f32)> = order.into_par_iter().map(|n| (n, self.sum(&planes[n]))).collect();
        summed.sort_by(|a, b| b.1.total_cmp(&a.1).then(a.0.cmp(&b.0)));
        summed.truncate(MOST_BENT);
        let bent: Vec<([f32; 5], f32)> = summed.into_par_iter().map(|(n, sum)| self.bend(planes[n], sum)).collect();
        bent.into_iter().fold(([0.0; 5], f32::NEG_INFINITY), |best, next| if next.1 > best.1 { next } else { best })
    }

    fn bend(&self, mut terms: [f32; 5], mut sum: f32) -> ([f32; 5], f32) {
        for step in [4.0f32, 2.0, 1.0, 0.5] {
            for _ in 0..5 {
                let before = sum;
                for n in 0..5 {
                    for change in [step, -step] {
                        let mut other = terms;
                        other[n] += change;
                        let found = self.sum(&other);
                        if found > sum {
                            (terms, sum) = (other, found);
                        }
                    }
                }
                if sum <= before {
                    break;
                }
            }
        }
        (terms, sum)
    }

    /// The evidence of each cell along a fault.
    fn along(&self, terms: &[f32; 5]) -> Vec<f32> {
        let value = |n: usize| {
            let (along, down) = (n / self.cells[1], n % self.cells[1]);
            let [u, v] = self.scaled(along, down);
            self.at(along, down, quadratic(terms, u, v))
        };
        (0..self.cells[0] * self.cells[1]).map(value).collect()
    }

    /// The fault as a cut, where `is_there` of its cell.
    fn cut(&self, across: Across, terms: &[f32; 5], is_there: impl Fn(usize) -> bool) -> Cut {
        let scaled = |n: usize, count: usize| 2.0 * (n as f32 + 0.5) / count as f32 - 1.0;
        Cut::new(across, self.lines, self.samples, |line, z| {
            let place = quadratic(terms, scaled(line, self.lines), scaled(z, self.samples));
            let count = self.width as f32;
            let is_there = is_there((line / CELL[0]) * self.cells[1] + z / CELL[1]);
            if is_there && place > -count && place < 2.0 * count { place } else { f32::NAN }
        })
    }

    /// The cells of a fault whose surroundings along it have enough evidence.
    fn extent(&self, terms: &[f32; 5], least: f32) -> Vec<bool> {
        let all = self.along(terms);
        (0..all.len())
            .map(|n| {
                let (along, down) = (n / self.cells[1], n % self.cells[1]);
                let range =
                    |at: usize, reach: usize, count: usize| at.saturating_sub(reach)..(at + reach + 1).min(count);
                let (mut sum, mut count) = (0.0, 0);
                for a in range(along, EXTENT[0], self.cells[0]) {
                    for d in range(down, EXTENT[1], self.cells[1]) {
                        sum += all[a * self.cells[1] + d];
                        count += 1;
                    }
                }
                sum / count as f32 > least
            })
            .collect()
    }

    /// Takes away what a fault explains.
    fn explain(&mut self, terms: &[f32; 5]) {
        for along in 0..self.cells[0] {
            for down in 0..self.cells[1] {
                let [u, v] = self.scaled(along, down);
                let place = quadratic(terms, u, v);
                let row = (along * self.cells[1] + down) * self.width;
                for at in 0..self.width {
                    if (at as f32 + 0.5 - place).abs() <= OWN {
                        self.values[row + at] = self.values[row + at].min(0.0);
                    }
                }
            }
        }
    }
}

fn quadratic(t: &[f32; 5], u: f32, v: f32) -> f32 {
    t[0] + t[1] * u + t[2] * v + t[3] * u * u + t[4] * v * v
}

/// A fault that was found.
#[derive(Debug, Clone, PartialEq)]
pub struct FoundFault {
    /// Where it runs.
    pub cut: Cut,
    /// Its throw; `None` where one of its sides lies outside the volume.
    pub throw: Option<Throw>,
    /// Count of patches that end at it, more than go on.
    pub ends: usize,
}

impl FoundFault {
    /// Whether most of it lies within a few traces of a known fault.
    pub fn is_on(&self, known: &Cut) -> bool {
        let there = self.cut.place.iter().filter(|place| place.is_finite()).count();
        let near = |(a, b): &(&f32, &f32)| (**a - **b).abs() <= OWN;
        known.across == self.cut.across && 2 * self.cut.place.iter().zip(&known.place).filter(near).count() > there
    }
}

/// Finds the faults of a volume from the ends of patches, and how far they reach from what lies beside them.
///
/// Patches of fewer than `fewest` vertices do not count.
///
/// # Errors
/// [`Cancelled`].
pub fn find_faults(
    volume: &Volume<f32>,
    surfaces: &Surfaces,
    fewest: usize,
    progress: &Progress,
) -> Result<Vec<FoundFault>, Cancelled> {
    let [nx, ny, nz] = surfaces.size;
    if nx.min(ny) < 16 || nz < 16 {
        return Ok(Vec::new());
    }
    let hubs = Hubs::new(surfaces, &[], fewest, 1.0);
    let links = Links::new(&hubs, &[], &[]);
    let mut found = Vec::new();
    for across in [Across::Inlines, Across::Crosslines] {
        let mut evidence = FaultEvidence::new(&hubs, across);
        progress.begin("looking for faults", MOST as u64);
        for _ in 0..MOST {
            progress.step(1)?;
            let (terms, _) = evidence.best();
            let certain = evidence.extent(&terms, CERTAIN);
            let share = certain.iter().filter(|cell| **cell).count() as f32 / certain.len() as f32;
            if share < LEAST_SHARE {
                break;
            }
            let sure = evidence.cut(across, &terms, |cell| certain[cell]);
            let throw = throw_of(volume, &links, &sure);
            let ends = evidence.along(&terms);
            let extent = match &throw {
                Some(throw) => {
                    let whole = evidence.cut(across, &terms, |_| true);
                    let misfits = Misfits::new(volume, &links, &whole, throw, CELL);
                    extent(&misfits.gain(EXTENT), &ends, evidence.cells, EXTENT)
                }
                None => evidence.extent(&terms, 0.0),
            };
            let cut = evidence.cut(across, &terms, |cell| extent[cell]);
            let ends =
                ends.iter().zip(&extent).filter(|(_, is_there)| **is_there).map(|(ends, _)| ends.max(0.0)).sum::<f32>();
            found.push(FoundFault { cut, throw, ends: ends as usize });
            evidence.explain(&terms);
        }
    }
    Ok(found)
}
