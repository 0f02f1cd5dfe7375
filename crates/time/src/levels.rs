//! The levels of τ that stand out, and the character of what lies between them: what a picture without interpretation
//! is made of.

use crate::isochron::crossings;
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
    /// Mean amplitude of its reflection, over the root mean square of the volume; negative for a trough.
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

/// Distance from a level within which a trace has its reflection, samples: τ is a little off here and there.
const BESIDE: f32 = 1.5;
/// Share of the mean amplitude along a level from which on a trace has the reflection, too.
pub(crate) const ALIKE: f32 = 0.4;

/// The strongest amplitude of a sign on a trace beside a depth; −∞ where there is none.
pub(crate) fn beside(trace: &[f32], at: f32, sign: f32) -> f32 {
    let low = (at - BESIDE).ceil().max(0.0) as usize;
    let high = ((at + BESIDE).floor().max(0.0) as usize).min(trace.len() - 1);
    trace.get(low..=high).into_iter().flatten().map(|a| sign * a).fold(f32::NEG_INFINITY, f32::max)
}

/// Thickness of a layer that can be seen in a picture, as a share of the samples, and least share of the traces of two levels
/// on which what lies between them has it.
const SEEN_THICKNESS: f32 = 0.025;
const LEAST_SEEN: f64 = 0.7;

/// A level that may be chosen.
struct Candidate {
    level: Level,
    /// Its depth on each trace, NaN where there is none.
    depth: Vec<f32>,
    /// Share of the traces that it crosses on which its reflection is.
    continuity: f64,
}

impl Candidate {
    /// A level of a time at which amplitudes have a sign on the average. On each trace it has the strongest amplitude of that
    /// sign beside it, so that a strong reflection along which τ is a sample off here and there counts as what it is.
    fn new(tau: &Volume<f32>, volume: &Volume<f32>, time: f32, sign: f32, rms: f32, live: usize) -> Self {
        let [nx, ny, _] = tau.size();
        let on = |trace: usize| {
            let (x, y) = (trace / ny, trace % ny);
            let at = crossings(tau.trace(x, y), time).next().filter(|_| volume.is_live(x, y))?;
            let amplitude = beside(volume.trace(x, y), at, sign);
            amplitude.is_finite().then_some((at, amplitude))
        };
        let all: Vec<Option<(f32, f32)>> = (0..nx * ny).into_par_iter().map(on).collect();
        let crossed = all.iter().flatten().count();
        let mean = all.iter().flatten().map(|(_, a)| f64::from(*a)).sum::<f64>() / crossed.max(1) as f64;
        let alike = all.iter().flatten().filter(|(_, a)| f64::from(*a) >= f64::from(ALIKE) * mean).count();
        let level = Level {
            time,
            coverage: crossed as f64 / live.max(1) as f64,
            strength: sign * mean as f32 / rms.max(f32::MIN_POSITIVE),
        };
        let depth = all.iter().map(|at| at.map_or(f32::NAN, |(at, _)| at)).collect();
        Self { level, depth, continuity: alike as f64 / crossed.max(1) as f64 }
    }

    /// Strong, on most traces, and of one sign on them.
    fn score(&self) -> f64 {
        f64::from(self.level.strength.abs()) * (self.level.coverage * self.continuity).powi(2)
    }

    /// Whether the rock between two levels is a layer that can be seen on most of their traces.
    fn leaves_a_layer(&self, other: &Self, nz: usize) -> bool {
        let both =
            self.depth.iter().zip(&other.depth).map(|(a, b)| (a - b).abs()).filter(|thickness| thickness.is_finite());
        let count = both.clone().count();
        let seen = both.filter(|thickness| *thickness >= SEEN_THICKNESS * nz as f32).count();
        count > 0 && seen as f64 >= LEAST_SEEN * count as f64
    }
}

/// Least distance of two levels, as a share of an even spacing. More of it spreads layers over the survey, but leaves out the
/// second of two strong reflections that lie close together, as the top and the base of a chalk do.
const LEAST_SPACING: f32 = 0.25;

/// Chooses up to `count` levels by strength, coverage and continuity, at least a quarter of an even spacing apart and so that
/// what lies between two of them is no sliver; ascending. Cost: one pass over τ for each reflection of the survey.
pub fn strongest_levels(tau: &Volume<f32>, volume: &Volume<f32>, count: usize) -> Vec<Level> {
    let (log, rms, live) = whole(tau, volume);
    let bins: Vec<(f32, f32)> = log.means(0.25 * live as f32).collect();
    let (Some(first), Some(last)) = (bins.first(), bins.last()) else { return Vec::new() };
    let apart = LEAST_SPACING * (last.0 - first.0) / (count + 1) as f32;
    let is_top = |n: &usize| bins[*n].1.abs() >= bins[n - 1].1.abs() && bins[*n].1.abs() > bins[n + 1].1.abs();
    let least = LEAST_STRENGTH * rms;
    let mut candidates: Vec<Candidate> = (1..bins.len().saturating_sub(1))
        .filter(|n| is_top(n) && bins[*n].1.abs() >= least)
        .map(|n| Candidate::new(tau, volume, bins[n].0, bins[n].1.signum(), rms, live))
        .filter(|candidate| candidate.level.coverage >= LEAST_COVERAGE)
        .collect();
    candidates.sort_by(|a, b| b.score().total_cmp(&a.score()));
    let nz = tau.size()[2];
    let mut chosen: Vec<Candidate> = Vec::new();
    for candidate in candidates {
        let is_apart = |other: &Candidate| {
            (other.level.time - candidate.level.time).abs() >= apart && candidate.leaves_a_layer(other, nz)
        };
        if chosen.len() < count && chosen.iter().all(is_apart) {
            chosen.push(candidate);
        }
    }
    chosen.sort_by(|a, b| a.level.time.total_cmp(&b.level.time));
    chosen.into_iter().map(|candidate| candidate.level).collect()
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
    fn a_strong_reflector_close_to_a_stronger_one_is_chosen_and_a_sliver_is_not() {
        // Strong reflectors at τ 60 and 72, a weaker one at 20. Below 72 one follows at 84 that comes to lie on it on most
        // traces: what lies between them is a sliver.
        let size = [24, 24, 120];
        let (mut tau, mut volume) = (Volume::filled(size, 0.0f32), Volume::filled(size, 0.0f32));
        for (x, y) in (0..24).flat_map(|x| (0..24).map(move |y| (x, y))) {
            // Depth of a time: the twelve samples below 72 are squeezed into a half of one beyond inline 6.
            let squeezed = if x > 6 { 11.5 } else { 0.0 };
            let depth = |t: f32| t - squeezed * ((t - 72.0) / 12.0).clamp(0.0, 1.0);
            for z in 0..120 {
                let mut time = 0.0;
                while depth(time) < z as f32 {
                    time += 0.05;
                }
                tau.trace_mut(x, y)[z] = time;
                let bed = |at: f32, height: f32| height * (-(z as f32 - depth(at)).powi(2) / 4.0).exp();
                volume.trace_mut(x, y)[z] = bed(20.0, 0.6) + bed(60.0, 1.2) - bed(72.0, 1.0) - bed(84.0, 0.9);
            }
        }
        let times: Vec<f32> = strongest_levels(&tau, &volume, 3).iter().map(|level| level.time).collect();
        assert_eq!(times.len(), 3, "{times:?}");
        let is_near = |n: usize, at: f32| (times[n] - at).abs() < 1.5;
        assert!(is_near(0, 20.0) && is_near(1, 60.0) && (is_near(2, 72.0) || is_near(2, 84.0)), "{times:?}");
    }

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
