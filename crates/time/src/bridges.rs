//! Islands in which a level leaves its reflection, and what is laid over them.
//!
//! A sliver between two small faults that were not found keeps a time of its own: the level steps off its reflection at one
//! edge of it and back at the other, which prints as a notch. Where all around such an island the level is on its
//! reflection, and a surface from rim to rim lies on it inside, too, that surface is the better boundary. The amplitudes
//! decide: a fault with a throw has nothing on the way across. Space: voxels.

use crate::levels::{ALIKE, beside};
use crate::solve::interpolate;
use survey::Volume;

/// Share of the traces up to which an island is one, and the least count of its nodes.
const LARGEST: f64 = 0.02;
const SMALLEST: usize = 12;
/// Traces around an island that it drags along.
const DRAGGED: usize = 2;
/// Share of the nodes of an island on which the surface from rim to rim must be on the reflection, and by how much more of
/// them than the level was.
const LEAST_ALIKE: f64 = 0.75;
const LEAST_GAIN: f64 = 0.4;
/// Sweeps in which the surface over an island settles, and by how much each goes too far.
const SWEEPS: usize = 400;
const OVER: f32 = 1.7;

/// Lays sheets of a level, samples on each trace and NaN where there is none, over the islands in which they leave the
/// reflection that they follow. Returns which nodes of each moved.
///
/// ```
/// use survey::Volume;
/// use time::bridge;
///
/// // A reflection at sample 20 that the level leaves by seven samples on a part of the traces.
/// let trace = |n: usize| (-((n % 40) as f32 - 20.0).powi(2) / 4.0).exp();
/// let volume = Volume::from_samples([60, 50, 40], (0..60 * 50 * 40).map(trace).collect())?;
/// let is_off = |n: usize| (25..30).contains(&(n / 50)) && (20..28).contains(&(n % 50));
/// let mut sheets = [(0..60 * 50).map(|n| if is_off(n) { 27.0 } else { 20.0 }).collect::<Vec<f32>>()];
/// assert!(bridge(&mut sheets, &volume)[0][27 * 50 + 24]);
/// assert!(sheets[0].iter().all(|at| (at - 20.0).abs() < 0.1));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn bridge(sheets: &mut [Vec<f32>], volume: &Volume<f32>) -> Vec<Vec<bool>> {
    let [nx, ny, _] = volume.size();
    let amplitude = |n: usize, at: f32| Some(interpolate(volume.trace(n / ny, n % ny), at)).filter(|a| a.is_finite());
    let nodes = || sheets.iter().flat_map(|sheet| sheet.iter().enumerate()).filter(|(_, at)| at.is_finite());
    let sum: f64 = nodes().filter_map(|(n, at)| amplitude(n, *at)).map(f64::from).sum();
    let sign = if sum < 0.0 { -1.0 } else { 1.0 };
    let on = |n: usize, at: f32| beside(volume.trace(n / ny, n % ny), at, sign);
    let strong: Vec<f64> = nodes().map(|(n, at)| f64::from(on(n, *at))).filter(|a| a.is_finite()).collect();
    let least = ALIKE * (strong.iter().sum::<f64>() / strong.len().max(1) as f64) as f32;
    let is_on = |n: usize, at: f32| on(n, at) >= least;
    sheets.iter_mut().map(|sheet| Islands { sheet, size: [nx, ny], is_on: &is_on }.bridged()).collect()
}

/// A sheet, and whether a trace has the reflection at a depth.
struct Islands<'a> {
    sheet: &'a mut [f32],
    size: [usize; 2],
    is_on: &'a dyn Fn(usize, f32) -> bool,
}

impl Islands<'_> {
    /// Lays the sheet over its islands; which nodes moved.
    fn bridged(&mut self) -> Vec<bool> {
        let is_off: Vec<bool> =
            self.sheet.iter().enumerate().map(|(n, at)| at.is_finite() && !(self.is_on)(n, *at)).collect();
        let mut moved = vec![false; is_off.len()];
        let mut seen: Vec<bool> = is_off.iter().map(|off| !off).collect();
        let largest = (LARGEST * is_off.len() as f64) as usize;
        for n in 0..is_off.len() {
            if seen[n] {
                continue;
            }
            let island = self.around(n, &mut seen);
            if island.len() >= SMALLEST && island.len() <= largest {
                self.lay_over(&island, &mut moved);
            }
        }
        moved
    }

    /// The nodes that have not been seen and are joined to one, which are seen then.
    fn around(&self, first: usize, seen: &mut [bool]) -> Vec<usize> {
        seen[first] = true;
        let mut island = vec![first];
        let mut next = 0;
        while next < island.len() {
            for m in self.beside(island[next]) {
                if !std::mem::replace(&mut seen[m], true) {
                    island.push(m);
                }
            }
            next += 1;
        }
        island
    }

    /// Lays a surface from rim to rim over an island, if it lies on the reflection there.
    fn lay_over(&mut self, island: &[usize], moved: &mut [bool]) {
        let mut is_inside = vec![false; self.sheet.len()];
        island.iter().for_each(|n| is_inside[*n] = true);
        let mut all = island.to_vec();
        let mut from = 0;
        for _ in 0..DRAGGED {
            let to = all.len();
            for n in from..to {
                for m in self.beside(all[n]).filter(|m| self.sheet[*m].is_finite()) {
                    if !std::mem::replace(&mut is_inside[m], true) {
                        all.push(m);
                    }
                }
            }
            from = to;
        }
        all.sort_unstable();
        let before: Vec<f32> = all.iter().map(|n| self.sheet[*n]).collect();
        let share =
            |sheet: &[f32]| all.iter().filter(|n| (self.is_on)(**n, sheet[**n])).count() as f64 / all.len() as f64;
        let was = share(self.sheet);
        let mut laid = self.sheet.to_vec();
        for _ in 0..SWEEPS {
            for &n in &all {
                let beside = self.beside(n).map(|m| laid[m]).filter(|at| at.is_finite());
                let (sum, count) = beside.fold((0.0, 0.0), |(sum, count), at| (sum + at, count + 1.0));
                if count > 0.0 {
                    laid[n] += OVER * (sum / count - laid[n]);
                }
            }
        }
        let is = share(&laid);
        if is >= LEAST_ALIKE && is >= was + LEAST_GAIN {
            for (n, before) in all.into_iter().zip(before) {
                moved[n] |= laid[n] != before;
                self.sheet[n] = laid[n];
            }
        }
    }

    /// The four neighbours of a node.
    fn beside(&self, n: usize) -> impl Iterator<Item = usize> + use<> {
        let [nx, ny] = self.size;
        let (x, y) = (n / ny, n % ny);
        let at = [(x > 0, n.wrapping_sub(ny)), (x + 1 < nx, n + ny), (y > 0, n.wrapping_sub(1)), (y + 1 < ny, n + 1)];
        at.into_iter().filter_map(|(is_there, m)| is_there.then_some(m))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const SIZE: [usize; 3] = [60, 50, 80];

    /// A reflection at a depth on each trace.
    fn reflecting(depth: impl Fn(usize, usize) -> f32) -> Volume<f32> {
        let mut volume = Volume::filled(SIZE, 0.0f32);
        for (x, y) in (0..SIZE[0]).flat_map(|x| (0..SIZE[1]).map(move |y| (x, y))) {
            for (z, sample) in volume.trace_mut(x, y).iter_mut().enumerate() {
                *sample = -(-(z as f32 - depth(x, y)).powi(2) / 6.0).exp();
            }
        }
        volume
    }

    fn sheet(depth: impl Fn(usize, usize) -> f32) -> Vec<f32> {
        (0..SIZE[0] * SIZE[1]).map(|n| depth(n / SIZE[1], n % SIZE[1])).collect()
    }

    fn is_island(x: usize, y: usize) -> bool {
        (20..28).contains(&x) && (15..22).contains(&y)
    }

    #[test]
    fn a_notch_in_a_dipping_level_is_laid_on_its_trough() {
        let truth = |x: usize, y: usize| 20.0 + 0.4 * x as f32 + 0.2 * y as f32;
        let volume = reflecting(truth);
        let mut sheets = [sheet(|x, y| truth(x, y) + if is_island(x, y) { 8.0 } else { 0.0 })];
        let moved = bridge(&mut sheets, &volume);
        for (n, at) in sheets[0].iter().enumerate() {
            let (x, y) = (n / SIZE[1], n % SIZE[1]);
            assert!((at - truth(x, y)).abs() < 0.05, "{x} {y}: {at}, not {}", truth(x, y));
            assert!(moved[0][n] || !is_island(x, y));
        }
    }

    #[test]
    fn a_level_stays_where_nothing_reflects_on_the_way_across() {
        // The block in the midst is truly six samples deeper, and the level is eight deeper than that.
        let truth = |x: usize, y: usize| 30.0 + if is_island(x, y) { 6.0 } else { 0.0 };
        let level = |x: usize, y: usize| truth(x, y) + if is_island(x, y) { 8.0 } else { 0.0 };
        let mut sheets = [sheet(level)];
        let moved = bridge(&mut sheets, &reflecting(truth));
        assert!(moved[0].iter().all(|moved| !moved) && sheets[0] == sheet(level));
        // Nor where it is on its reflection, where the island is large, or where there is no level.
        let half = |x: usize, _: usize| if x < 30 { 20.0 } else { 28.0 };
        for (level, truth) in [(sheet(half), reflecting(half)), (sheet(half), reflecting(|_, _| 20.0))] {
            let mut sheets = [level.clone(), vec![f32::NAN; level.len()]];
            let moved = bridge(&mut sheets, &truth);
            assert!(moved.iter().flatten().all(|moved| !moved) && sheets[0] == level);
        }
    }
}
