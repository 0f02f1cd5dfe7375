//! Throws: how far the layering is offset across a fault, found by comparing its two sides in depth.
//!
//! Beside the fault, at every line along it and every sample, a few traces are stacked along the dip. That gives a panel
//! A₋(line, z) on the lower side across and A₊(line, z) on the upper. The throw T is a quadratic of line and depth; it is
//! the one for which A₋(line, z − T/2) and A₊(line, z + T/2) correlate best. Comparing the whole fault at once tells
//! apart throws that differ by a reflector, which single traces cannot. The margin is by how much the best throw
//! correlates better than any that differs from it by more than a few samples. Space: voxels.

use crate::cuts::{Across, Cut};
use crate::links::{DIP_STEP, Links};
use crate::solve::{Tie, interpolate};
use rayon::prelude::*;
use survey::Volume;

/// Distance of the first trace of a panel from the fault, traces.
pub(crate) const FIRST: f32 = 1.5;
/// Count of traces that are stacked.
const STACKED: usize = 5;
/// Samples within which amplitudes are brought to one level.
const LEVEL_WINDOW: usize = 24;
/// Greatest throw that is looked for, as a share of the samples; in thin volumes up to [`THIN`] samples, as far as half of
/// the volume.
const GREATEST_SHARE: f32 = 0.16;
const THIN: f32 = 20.0;
/// Throws that differ by less are the same one in the margin, samples.
const SAME_THROW: f32 = 3.0;
/// What a throw that varies costs, for each squared sample.
const BEND_COST: f32 = 5e-4;
/// Least share of the fault that must overlap under a throw.
const LEAST_OVERLAP: f32 = 0.4;

/// The side of a fault: towards lower or towards higher indices across.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Side {
    /// Lower indices.
    Lower,
    /// Higher indices.
    Upper,
}

/// The trace `distance` traces beside a fault at a line and a sample; `None` outside the volume and where there is no
/// fault.
pub(crate) fn beside(
    cut: &Cut,
    size: [usize; 3],
    line: usize,
    z: usize,
    side: Side,
    distance: f32,
) -> Option<[usize; 2]> {
    let place = cut.place[line * cut.size[1] + z];
    let across = match side {
        Side::Lower => (place - distance).floor(),
        Side::Upper => (place + distance).ceil(),
    };
    let count = size[if cut.across == Across::Inlines { 0 } else { 1 }];
    (across >= 0.0 && across < count as f32).then(|| cut.trace(across as usize, line))
}

/// Stacked amplitudes beside a fault, `[line][sample]`; NaN where there are none.
fn panel(volume: &Volume<f32>, links: &Links, cut: &Cut, side: Side) -> Vec<f32> {
    let size = volume.size();
    let [lines, nz] = cut.size;
    let axis = if cut.across == Across::Inlines { 0 } else { 1 };
    let mut all = vec![f32::NAN; lines * nz];
    all.par_chunks_mut(nz).enumerate().for_each(|(line, out)| {
        for (z, out) in out.iter_mut().enumerate() {
            let Some(first) = beside(cut, size, line, z, side, FIRST) else { continue };
            let [mut across, _] = cut.split(first);
            let (mut at, mut sum, mut count) = (z as f32, 0.0, 0);
            for _ in 0..STACKED {
                let [x, y] = cut.trace(across, line);
                sum += interpolate(volume.trace(x, y), at);
                count += 1;
                // One trace away from the fault, along the dip.
                let (from, sign) = match side {
                    Side::Lower if across > 0 => (across - 1, -1.0),
                    Side::Upper if across + 1 < size[axis] => (across, 1.0),
                    _ => break,
                };
                let [x, y] = cut.trace(from, line);
                let voxel = (x * size[1] + y) * nz + (at.round().max(0.0) as usize).min(nz - 1);
                at += sign * f32::from(links.dip[axis][voxel]) * DIP_STEP;
                across = if side == Side::Lower { across - 1 } else { across + 1 };
            }
            *out = sum / count as f32;
        }
        level(out);
    });
    all
}

/// Stacked amplitudes on the lower and on the upper side.
pub(crate) fn sides(volume: &Volume<f32>, links: &Links, cut: &Cut) -> [Vec<f32>; 2] {
    [Side::Lower, Side::Upper].map(|side| panel(volume, links, cut, side))
}

/// Brings the amplitudes of a trace to one level.
fn level(trace: &mut [f32]) {
    let power: Vec<f32> = trace.iter().map(|a| if a.is_finite() { a * a } else { 0.0 }).collect();
    let whole: f32 = power.iter().sum::<f32>() / power.len() as f32;
    for z in 0..trace.len() {
        let window = &power[z.saturating_sub(LEVEL_WINDOW)..(z + LEVEL_WINDOW + 1).min(power.len())];
        let mean = window.iter().sum::<f32>() / window.len() as f32;
        trace[z] /= (mean + 0.1 * whole + f32::MIN_POSITIVE).sqrt();
    }
}

/// The throw of a fault, samples, as a quadratic of line and depth; positive where the upper side across lies deeper.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Throw {
    /// Of 1, u, v, u², u·v, v², with u and v from −1 to 1 along the lines and down.
    terms: [f32; 6],
    /// Correlation of both sides, −1 to 1.
    pub correlation: f32,
    /// By how much that is more than the correlation of any other throw.
    pub margin: f32,
    size: [usize; 2],
}

impl Throw {
    /// The throw at a line and a sample, samples.
    pub fn at(&self, line: usize, z: f32) -> f32 {
        quadratic(&self.terms, self.size, line, z)
    }
}

/// A quadratic at a line and a depth.
fn quadratic(terms: &[f32; 6], size: [usize; 2], line: usize, z: f32) -> f32 {
    at_depth(on_line(terms, size[0], line), scaled(z, size[1]))
}

/// A quadratic on one line, as one of depth: the terms of 1, v and v².
fn on_line(terms: &[f32; 6], lines: usize, line: usize) -> [f32; 3] {
    let u = scaled(line as f32, lines);
    [terms[0] + u * (terms[1] + u * terms[3]), terms[2] + u * terms[4], terms[5]]
}

/// A quadratic of depth at v.
#[inline]
fn at_depth([constant, slope, bend]: [f32; 3], v: f32) -> f32 {
    constant + v * (slope + v * bend)
}

/// From −1 at the first of `count` to 1 at the last.
fn scaled(at: f32, count: usize) -> f32 {
    2.0 * at / (count.max(2) - 1) as f32 - 1.0
}

/// Two sides to compare.
struct Panels {
    size: [usize; 2],
    sides: [Vec<f32>; 2],
    /// Every so many lines are compared.
    step: usize,
}

impl Panels {
    /// Correlation under a throw, a little less where little overlaps; −1 where less than enough does.
    fn score(&self, terms: &[f32; 6]) -> f32 {
        let nz = self.size[1];
        let (mut all, mut there) = (PairSums::default(), 0usize);
        for line in (0..self.size[0]).step_by(self.step) {
            let row = line * nz..(line + 1) * nz;
            let (a, b) = (&self.sides[0][row.clone()], &self.sides[1][row]);
            let on_line = on_line(terms, self.size[0], line);
            for z in 0..nz {
                there += usize::from(a[z].is_finite() || b[z].is_finite());
                let throw = at_depth(on_line, scaled(z as f32, nz));
                add(&mut all, products(a, b, z as f32, 0.5 * throw));
            }
        }
        scored(all, there as f32, terms)
    }

    /// How well the best rival of a throw correlates: of other throws that were found, and of the same throw moved by more
    /// than a few samples, so that there always is one. Nothing that hardly overlaps is a rival.
    fn rival(&self, terms: &[f32; 6], greatest: f32, found: &[([f32; 6], f32)]) -> f32 {
        let differs = |(other, _): &&([f32; 6], f32)| (other[0] - terms[0]).abs() > SAME_THROW;
        let moved = |constant: f32| self.score(&[constant, terms[1], terms[2], terms[3], terms[4], terms[5]]);
        let most = greatest as i32;
        let constants = (-most..=most).map(|n| n as f32).filter(|n| (n - terms[0]).abs() > SAME_THROW);
        let moved = constants.map(moved).fold(0.0, f32::max);
        found.iter().filter(differs).map(|(_, score)| *score).fold(moved, f32::max)
    }

    /// Improves a throw term by term.
    fn refine(&self, mut terms: [f32; 6], mut score: f32) -> ([f32; 6], f32) {
        for step in [2.0f32, 1.0, 0.5, 0.25] {
            for _ in 0..6 {
                let before = score;
                for n in 0..6 {
                    for change in [step, -step] {
                        let mut other = terms;
                        other[n] += change;
                        let found = self.score(&other);
                        if found > score + 1e-5 {
                            (terms, score) = (other, found);
                        }
                    }
                }
                if score <= before {
                    break;
                }
            }
        }
        (terms, score)
    }
}

/// Samples of a window of depth that has one shift while throws are scanned, and steps of a shift in a sample.
const WINDOW: usize = 8;
const SHIFT_STEPS: f32 = 2.0;

/// The sums of a score over windows of lines for every shift, so that a throw is scored by looking them up: throws are
/// scanned by the thousand, and only the best are scored exactly.
struct Shifts {
    size: [usize; 2],
    /// Greatest shift, in steps.
    most: isize,
    /// Every so many lines are in it.
    step: usize,
    /// `[line][window][shift]`.
    sums: Vec<PairSums>,
    /// Samples that either side has.
    there: f32,
}

impl Shifts {
    /// The sums of panels for shifts of up to `greatest` samples.
    fn new(panels: &Panels, greatest: f32) -> Self {
        let [lines, nz] = panels.size;
        let step = 2 * panels.step;
        let most = (greatest * SHIFT_STEPS).ceil() as isize;
        let width = (2 * most + 1) as usize;
        let (windows, taken) = (nz.div_ceil(WINDOW), lines.div_ceil(step));
        let mut sums = vec![PairSums::default(); taken * windows * width];
        let row = |side: usize, line: usize| &panels.sides[side][line * nz..(line + 1) * nz];
        sums.par_chunks_mut(windows * width).enumerate().for_each(|(n, sums)| {
            let (a, b) = (row(0, n * step), row(1, n * step));
            for (window, sums) in sums.chunks_mut(width).enumerate() {
                for (shift, sums) in sums.iter_mut().enumerate() {
                    let half = 0.5 * (shift as isize - most) as f32 / SHIFT_STEPS;
                    for z in window * WINDOW..((window + 1) * WINDOW).min(nz) {
                        add(sums, products(a, b, z as f32, half));
                    }
                }
            }
        });
        let has_any =
            |line: usize| row(0, line).iter().zip(row(1, line)).filter(|(a, b)| a.is_finite() || b.is_finite());
        let there = (0..lines).step_by(step).map(|line| has_any(line).count()).sum::<usize>() as f32;
        Self { size: panels.size, most, step, sums, there }
    }

    /// About the score of a throw.
    fn score(&self, terms: &[f32; 6]) -> f32 {
        let [lines, nz] = self.size;
        let width = (2 * self.most + 1) as usize;
        let windows = nz.div_ceil(WINDOW);
        let mut all = PairSums::default();
        for (n, line) in (0..lines).step_by(self.step).enumerate() {
            let on_line = on_line(terms, lines, line);
            for window in 0..windows {
                let v = scaled((window * WINDOW) as f32 + 0.5 * (WINDOW - 1) as f32, nz);
                let shift = (at_depth(on_line, v) * SHIFT_STEPS).round() as isize;
                if shift.abs() <= self.most {
                    add(&mut all, self.sums[(n * windows + window) * width + (shift + self.most) as usize]);
                }
            }
        }
        scored(all, self.there, terms)
    }
}

/// Σ a b, Σ a², Σ b² and the count of pairs.
type PairSums = [f32; 4];

#[inline]
fn add(sums: &mut PairSums, more: PairSums) {
    sums.iter_mut().zip(more).for_each(|(sum, more)| *sum += more);
}

/// What the amplitudes of both sides half a throw above and below a sample add; nothing where one of them has none there.
#[inline]
fn products(a: &[f32], b: &[f32], z: f32, half: f32) -> PairSums {
    let (za, zb) = (z - half, z + half);
    if za.min(zb) < 0.0 || za.max(zb) > (a.len() - 1) as f32 {
        return PairSums::default();
    }
    let (a, b) = (interpolate(a, za), interpolate(b, zb));
    if a.is_finite() && b.is_finite() { [a * b, a * a, b * b, 1.0] } else { PairSums::default() }
}

/// The score of a throw from its sums and how many samples there are: the correlation, a
/// little less where little overlaps, −1 where less than enough does.
fn scored([product, lower, upper, both]: PairSums, there: f32, terms: &[f32; 6]) -> f32 {
    let bend = BEND_COST * terms[1..].iter().map(|term| term * term).sum::<f32>();
    let overlap = both / there.max(1.0);
    if overlap < LEAST_OVERLAP { -1.0 } else { product / (lower * upper).sqrt().max(1e-9) * overlap.powf(0.25) - bend }
}

/// Lines along a fault that are compared, about; half of them while throws are scanned.
const LINES: usize = 48;
/// Count of throws that are scored exactly, and of those that are refined.
const CONSIDERED: usize = 40;
const REFINED: usize = 6;

/// Finds the throw of a fault; `None` where one of its sides is nowhere inside the volume.
pub(crate) fn throw_of(volume: &Volume<f32>, links: &Links, cut: &Cut) -> Option<Throw> {
    let sides = sides(volume, links, cut);
    if sides.iter().any(|side| side.iter().all(|a| a.is_nan())) {
        return None;
    }
    let step = cut.size[0].div_ceil(LINES).max(1);
    let panels = Panels { size: cut.size, sides, step };
    let samples = cut.size[1] as f32;
    let greatest = (GREATEST_SHARE * samples).max(THIN.min(0.5 * samples)).floor();
    let steps = |most: f32, step: f32| {
        let count = (most / step).floor() as i32;
        (-count..=count).map(move |n| n as f32 * step)
    };
    let slopes = [greatest * 0.75, greatest * 0.5];
    let starts: Vec<[f32; 6]> = steps(greatest, 1.0)
        .flat_map(|a| {
            steps(slopes[0], 3.0).flat_map(move |b| steps(slopes[1], 3.0).map(move |c| [a, b, c, 0.0, 0.0, 0.0]))
        })
        .filter(|terms| terms[0].abs() + 0.5 * (terms[1].abs() + terms[2].abs()) <= 1.2 * greatest)
        .collect();
    let shifts = Shifts::new(&panels, 1.2 * greatest);
    let mut found: Vec<([f32; 6], f32)> = starts.into_par_iter().map(|terms| (terms, shifts.score(&terms))).collect();
    found.sort_by(|a, b| b.1.total_cmp(&a.1));
    let mut chosen: Vec<[f32; 6]> = Vec::new();
    for (terms, _) in found {
        let is_new = |other: &[f32; 6]| (0..3).any(|n| (terms[n] - other[n]).abs() > SAME_THROW);
        if chosen.len() < CONSIDERED && chosen.iter().all(is_new) {
            chosen.push(terms);
        }
    }
    let mut chosen: Vec<([f32; 6], f32)> = chosen.into_par_iter().map(|terms| (terms, panels.score(&terms))).collect();
    chosen.sort_by(|a, b| b.1.total_cmp(&a.1));
    chosen.truncate(REFINED);
    let mut refined: Vec<([f32; 6], f32)> =
        chosen.into_par_iter().map(|(terms, score)| panels.refine(terms, score)).collect();
    refined.sort_by(|a, b| b.1.total_cmp(&a.1));
    let (terms, correlation) = *refined.first()?;
    let margin = correlation - panels.rival(&terms, greatest, &refined);
    Some(Throw { terms, correlation, margin, size: cut.size })
}

/// Ties across a fault under a throw, every `step` lines and samples.
pub(crate) fn ties(cut: &Cut, size: [usize; 3], throw: &Throw, step: [usize; 2], weight: f32) -> Vec<Tie> {
    let [lines, nz] = cut.size;
    let mut ties = Vec::new();
    for line in (0..lines).step_by(step[0]) {
        for z in (0..nz).step_by(step[1]) {
            let half = 0.5 * throw.at(line, z as f32);
            let depths = [z as f32 - half, z as f32 + half];
            if depths.iter().any(|&z| z < 0.0 || z > (nz - 1) as f32) {
                continue;
            }
            let [a, b] = [(Side::Lower, depths[0]), (Side::Upper, depths[1])]
                .map(|(side, z)| beside(cut, size, line, z.round() as usize, side, FIRST));
            if let (Some([xa, ya]), Some([xb, yb])) = (a, b) {
                let trace = [(xa * size[1] + ya) as u32, (xb * size[1] + yb) as u32];
                ties.push(Tie { trace, z: depths, weight });
            }
        }
    }
    ties
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_throw_is_not_clear_where_beds_repeat_though_no_other_was_found() {
        let size = [12, 120];
        let panels = |wave: &dyn Fn(f32) -> f32| {
            let side = |shift: f32| (0..12 * 120).map(|n| wave((n % 120) as f32 + shift)).collect();
            Panels { size, sides: [side(3.0), side(-3.0)], step: 1 }
        };
        let terms = [6.0, 0.0, 0.0, 0.0, 0.0, 0.0];
        let margin = |panels: &Panels| panels.score(&terms) - panels.rival(&terms, 19.0, &[]);
        let repeating = margin(&panels(&|z| (z * std::f32::consts::TAU / 10.0).sin()));
        let telling = margin(&panels(&|z| (0.31 * z + 0.05 * (0.23 * z).sin() * z).sin()));
        assert!(repeating < 0.1 && telling > 0.3, "{repeating} {telling}");
    }

    #[test]
    fn a_throw_of_whole_samples_is_scored_alike_by_what_was_looked_up() {
        let size = [24, 96];
        let wave = |line: usize, z: f32| (0.31 * z + 0.1 * (0.07 * z).sin() * z + 0.05 * line as f32).sin();
        let side = |shift: f32| -> Vec<f32> {
            let there = |n: usize| if n % 96 < 4 { f32::NAN } else { wave(n / 96, (n % 96) as f32 + shift) };
            (0..24 * 96).map(there).collect()
        };
        let panels = Panels { size, sides: [side(3.0), side(-3.0)], step: 1 };
        let every_second = Panels { size, sides: panels.sides.clone(), step: 2 };
        let shifts = Shifts::new(&panels, 20.0);
        let mut best = (f32::NEG_INFINITY, 0.0);
        for throw in (-10..=10).map(|n| 2.0 * n as f32) {
            let terms = [throw, 0.0, 0.0, 0.0, 0.0, 0.0];
            let (found, meant) = (shifts.score(&terms), every_second.score(&terms));
            assert!((found - meant).abs() < 1e-3, "{throw}: {found} {meant}");
            if found > best.0 {
                best = (found, throw);
            }
        }
        assert_eq!(best.1, 6.0);
        // One that varies is scored within windows, which is about the same.
        let terms = [6.0, 1.0, 1.5, 0.0, 0.5, 0.0];
        assert!((shifts.score(&terms) - every_second.score(&terms)).abs() < 0.1);
    }
}
