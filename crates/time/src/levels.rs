//! The levels of τ that stand out, and the character of what lies between them: what a picture without interpretation
//! is made of.

use crate::isochron::isochron;
use crate::logs::Log;
use rayon::prelude::*;
use survey::Volume;

/// A level of τ at which amplitudes are strong and alike on most traces.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Level {
    /// The value of τ.
    pub time: f32,
    /// Share of the live traces that it crosses.
    pub coverage: f64,
    /// Mean amplitude along it, over the root mean square of the volume; negative for a trough.
    pub strength: f32,
}

/// The character of the reflections between two levels.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Character {
    /// Root mean square amplitude, over that of the volume.
    pub strength: f32,
    /// Share of the energy that is the same on all traces at one τ: 1 for continuous beds, 0 for chaos.
    pub continuity: f32,
}

/// Least share of the traces that a level crosses.
const LEAST_COVERAGE: f64 = 0.5;

/// Least mean amplitude along a level, over the root mean square of the volume: less is chaos.
const LEAST_STRENGTH: f32 = 0.3;

/// The log of a volume, its root mean square amplitude, and the count of its live traces.
fn whole(tau: &Volume<f32>, volume: &Volume<f32>) -> (Log, f32, usize) {
    let [nx, ny, _] = tau.size();
    let known = tau.samples().iter().filter(|t| t.is_finite());
    let range = known.fold([f32::INFINITY, f32::NEG_INFINITY], |[a, b], t| [a.min(*t), b.max(*t)]);
    let range = if range[0] <= range[1] { range } else { [0.0, 0.0] };
    let lines: Vec<(Log, f64, usize, usize)> = (0..nx)
        .into_par_iter()
        .map(|x| {
            let (mut log, mut energy, mut count, mut live) = (Log::new(range[0], range[1]), 0.0f64, 0, 0);
            for y in (0..ny).filter(|&y| volume.is_live(x, y)) {
                live += 1;
                for (time, amplitude) in tau.trace(x, y).iter().zip(volume.trace(x, y)) {
                    if time.is_finite() && amplitude.is_finite() {
                        log.add(*time, *amplitude);
                        energy += f64::from(amplitude * amplitude);
                        count += 1;
                    }
                }
            }
            (log, energy, count, live)
        })
        .collect();
    let (mut log, mut energy, mut count, mut live) = (Log::new(range[0], range[1]), 0.0, 0, 0);
    for (part, e, n, traces) in &lines {
        log.add_log(part);
        energy += e;
        count += n;
        live += traces;
    }
    (log, (energy / count.max(1) as f64).sqrt() as f32, live)
}

/// Chooses up to `count` levels by strength and coverage, at least half of an even spacing apart; ascending.
pub fn strongest_levels(tau: &Volume<f32>, volume: &Volume<f32>, count: usize) -> Vec<Level> {
    let (log, rms, live) = whole(tau, volume);
    let bins: Vec<(f32, f32)> = log.means(0.25 * live as f32).collect();
    let (Some(first), Some(last)) = (bins.first(), bins.last()) else { return Vec::new() };
    let apart = (last.0 - first.0) / (2.0 * count.max(1) as f32);
    let is_top = |n: &usize| bins[*n].1.abs() >= bins[n - 1].1.abs() && bins[*n].1.abs() > bins[n + 1].1.abs();
    let ny = tau.size()[1];
    let mut levels: Vec<Level> = (1..bins.len().saturating_sub(1))
        .filter(is_top)
        .map(|n| {
            let mut traces: Vec<usize> = isochron(tau, bins[n].0)
                .crossings
                .iter()
                .map(|at| usize::from(at.x) * ny + usize::from(at.y))
                .collect();
            traces.dedup();
            let coverage = traces.len() as f64 / live.max(1) as f64;
            Level { time: bins[n].0, coverage, strength: bins[n].1 / rms.max(f32::MIN_POSITIVE) }
        })
        .filter(|level| level.coverage >= LEAST_COVERAGE && level.strength.abs() >= LEAST_STRENGTH)
        .collect();
    let score = |level: &Level| f64::from(level.strength.abs()) * level.coverage.powi(2);
    levels.sort_by(|a, b| score(b).total_cmp(&score(a)));
    let mut chosen: Vec<Level> = Vec::new();
    for level in levels {
        if chosen.len() < count && chosen.iter().all(|other| (other.time - level.time).abs() >= apart) {
            chosen.push(level);
        }
    }
    chosen.sort_by(|a, b| a.time.total_cmp(&b.time));
    chosen
}

/// The character of each part of τ between ascending times, that above the first and that below the last included.
pub fn characters(tau: &Volume<f32>, volume: &Volume<f32>, times: &[f32]) -> Vec<Character> {
    let (log, rms, live) = whole(tau, volume);
    let of = |time: f32| times.partition_point(|other| *other <= time);
    let mut stacked = vec![(0.0f64, 0usize); times.len() + 1];
    for (time, mean) in log.means(0.25 * live as f32) {
        let sum = &mut stacked[of(time)];
        *sum = (sum.0 + f64::from(mean * mean), sum.1 + 1);
    }
    let mut energy = vec![(0.0f64, 0usize); times.len() + 1];
    for (time, amplitude) in tau.samples().iter().zip(volume.samples()) {
        if time.is_finite() && amplitude.is_finite() {
            let sum = &mut energy[of(*time)];
            *sum = (sum.0 + f64::from(amplitude * amplitude), sum.1 + 1);
        }
    }
    let mean = |(sum, count): (f64, usize)| sum / count.max(1) as f64;
    energy
        .into_iter()
        .zip(stacked)
        .map(|(energy, stacked)| Character {
            strength: (mean(energy).sqrt() / f64::from(rms).max(1e-30)) as f32,
            continuity: (mean(stacked) / mean(energy).max(1e-30)).min(1.0) as f32,
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_strongest_reflectors_are_the_levels_and_chaos_is_told_from_beds() {
        // τ = z − x/4; strong peaks at τ 12 and 40, a weak one at 30; below 48 every trace has its own amplitudes.
        let size = [20, 20, 80];
        let (mut tau, mut volume) = (Volume::filled(size, 0.0f32), Volume::filled(size, 0.0f32));
        let mut state = 7u32;
        for x in 0..20 {
            for y in 0..20 {
                for z in 0..80 {
                    let t = z as f32 - 0.25 * x as f32;
                    tau.trace_mut(x, y)[z] = t;
                    let bed = |at: f32, height: f32| height * (-(t - at).powi(2) / 4.0).exp();
                    state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
                    let noise = (state >> 8) as f32 / (1 << 23) as f32 - 1.0;
                    let chaos = if t > 48.0 { noise } else { 0.0 };
                    volume.trace_mut(x, y)[z] = bed(12.0, 1.0) + bed(30.0, 0.3) - bed(40.0, 1.2) + chaos;
                }
            }
        }
        let levels = strongest_levels(&tau, &volume, 2);
        let times: Vec<f32> = levels.iter().map(|level| level.time).collect();
        assert!((times[0] - 12.0).abs() < 0.6 && (times[1] - 40.0).abs() < 0.6, "{times:?}");
        assert!(levels[0].strength > 0.0 && levels[1].strength < 0.0 && levels[0].coverage == 1.0);
        let found = characters(&tau, &volume, &[48.0]);
        assert!(found[0].continuity > 0.9 && found[1].continuity < 0.1, "{found:?}");
        assert!(strongest_levels(&Volume::filled(size, f32::NAN), &volume, 3).is_empty());
    }
}
