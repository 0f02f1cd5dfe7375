//! Whether reflections follow computed time better than chance would: the correlation of traces along beds.
//!
//! Around a trace, those of a square are read at the depths that have the same time as its samples. With a_i what n such
//! traces hold, the correlation is that of all pairs,
//!
//! ```text
//! Σ_{i≠j} a_i a_j / ((n − 1) Σ a_i²)
//! ```
//!
//! numerator and denominator summed over a window along the trace and over neighbouring squares. It is 1 where traces
//! repeat one another and 0 in noise; where patches happened to follow noise it is a little more. Strong reflections
//! weigh more, so a weak bed between coherent ones is no gap. It is semblance with its expectation in noise taken off.

use rayon::prelude::*;
use survey::Volume;

/// Distance between the traces that are compared, and how many of them lie on either side.
const SPACING: usize = 2;
const BESIDE: isize = 2;
/// Distance between the centres of squares, traces.
const STEP: usize = 4;
/// Half the window, samples.
const HALF_WINDOW: usize = 12;

/// Correlation along beds on a grid of traces.
pub(crate) struct Coherence {
    /// Squares along inlines and crosslines.
    count: [usize; 2],
    nz: usize,
    /// `[square along inlines][square along crosslines][sample]`; 0 where there is nothing to compare.
    correlation: Vec<f32>,
}

impl Coherence {
    /// Compares traces along levels of `tau`, `[inline][crossline][sample]`, NaN where it is not known. Memory: half a byte
    /// a voxel. Cost: two sweeps over the volume.
    pub(crate) fn new(tau: &[f32], volume: &Volume<f32>) -> Self {
        let [nx, ny, nz] = volume.size();
        let count = [nx.div_ceil(STEP), ny.div_ceil(STEP)];
        let level = mean(volume, tau);
        let mut sums = vec![[0.0f32; 2]; count[0] * count[1] * nz];
        sums.par_chunks_mut(nz).enumerate().for_each(|(n, sums)| {
            let centre = [n / count[1], n % count[1]].map(|c| c * STEP + STEP / 2);
            let centre = [centre[0].min(nx - 1), centre[1].min(ny - 1)];
            sum_pairs(tau, volume, level, centre, sums);
            slide(sums);
        });
        let correlation = (0..sums.len()).into_par_iter().map(|n| {
            let (square, z) = (n / nz, n % nz);
            let around = |c: usize, count: usize| c.saturating_sub(1)..(c + 2).min(count);
            let (cx, cy) = (square / count[1], square % count[1]);
            let mut both = [0.0f32; 2];
            for (x, y) in around(cx, count[0]).flat_map(|x| around(cy, count[1]).map(move |y| (x, y))) {
                let own = sums[(x * count[1] + y) * nz + z];
                both = [both[0] + own[0], both[1] + own[1]];
            }
            if both[1] > 0.0 { both[0] / both[1] } else { 0.0 }
        });
        Self { count, nz, correlation: correlation.collect() }
    }

    /// The correlation at the samples of a trace.
    pub(crate) fn on_trace(&self, x: usize, y: usize) -> &[f32] {
        let from = (x / STEP * self.count[1] + y / STEP) * self.nz;
        &self.correlation[from..from + self.nz]
    }
}

/// The mean amplitude where time is known.
fn mean(volume: &Volume<f32>, tau: &[f32]) -> f32 {
    let line = (volume.size()[1] * volume.size()[2]).max(1);
    let lines = volume.samples().par_chunks(line).zip(tau.par_chunks(line)).map(|(amplitudes, tau)| {
        let known = amplitudes.iter().zip(tau).filter(|(_, time)| time.is_finite());
        known.fold((0.0f64, 0usize), |(sum, count), (a, _)| (sum + f64::from(*a), count + 1))
    });
    let lines: Vec<(f64, usize)> = lines.collect();
    let (sum, count) = lines.iter().fold((0.0, 0), |(sum, count), own| (sum + own.0, count + own.1));
    (sum / count.max(1) as f64) as f32
}

/// Numerator and denominator at every sample of the square around `centre`.
fn sum_pairs(tau: &[f32], volume: &Volume<f32>, level: f32, centre: [usize; 2], sums: &mut [[f32; 2]]) {
    let [nx, ny, nz] = volume.size();
    let times = |x: usize, y: usize| &tau[(x * ny + y) * nz..(x * ny + y + 1) * nz];
    let own = times(centre[0], centre[1]);
    // Of each sample: the count of traces that have its time, the sum of their amplitudes and that of the squares.
    let mut moments = vec![[0.0f32; 3]; nz];
    for (dx, dy) in (-BESIDE..=BESIDE).flat_map(|dx| (-BESIDE..=BESIDE).map(move |dy| (dx, dy))) {
        let at = |c: usize, d: isize| c.checked_add_signed(d * SPACING as isize);
        let (Some(x), Some(y)) = (at(centre[0], dx), at(centre[1], dy)) else { continue };
        if x >= nx || y >= ny {
            continue;
        }
        let (other, amplitudes) = (times(x, y), volume.trace(x, y));
        let mut low = 0;
        for (moments, &time) in moments.iter_mut().zip(own) {
            if let Some(at) = crossing(other, time, &mut low) {
                let amplitude = amplitudes[low] + at * (amplitudes[low + 1] - amplitudes[low]) - level;
                *moments = [moments[0] + 1.0, moments[1] + amplitude, moments[2] + amplitude * amplitude];
            }
        }
    }
    for (sums, [count, sum, squares]) in sums.iter_mut().zip(moments) {
        *sums = if count > 1.0 { [sum * sum - squares, (count - 1.0) * squares] } else { [0.0; 2] };
    }
}

/// Moves `low` to the sample above the crossing of `time` on a trace that is next to it; returns the share of the sample
/// below. `None` where the trace does not have that time, or not there.
fn crossing(trace: &[f32], time: f32, low: &mut usize) -> Option<f32> {
    if time.is_nan() {
        return None;
    }
    while *low + 2 < trace.len() && (trace[*low + 1] <= time || trace[*low + 1].is_nan()) {
        *low += 1;
    }
    while *low > 0 && trace[*low] > time {
        *low -= 1;
    }
    let (above, below) = (trace[*low], *trace.get(*low + 1)?);
    (above <= time && below > time).then(|| (time - above) / (below - above))
}

/// Sums over the window along the trace.
fn slide(sums: &mut [[f32; 2]]) {
    let nz = sums.len();
    let mut total = vec![[0.0f64; 2]; nz + 1];
    for (n, own) in sums.iter().enumerate() {
        total[n + 1] = [total[n][0] + f64::from(own[0]), total[n][1] + f64::from(own[1])];
    }
    for (z, sum) in sums.iter_mut().enumerate() {
        let (from, to) = (z.saturating_sub(HALF_WINDOW), (z + HALF_WINDOW + 1).min(nz));
        *sum = [0, 1].map(|n| (total[to][n] - total[from][n]) as f32);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A number that looks like noise, from -1 to 1.
    fn noise(n: usize) -> f32 {
        let mut state = n as u64 ^ 0x9E37_79B9_7F4A_7C15;
        for _ in 0..2 {
            state = (state ^ (state >> 31)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        }
        (state >> 40) as f32 / (1 << 23) as f32 - 1.0
    }

    /// Dipping beds with a share of noise, an offset, and their time.
    fn mixed(size: [usize; 3], share: f32) -> (Volume<f32>, Vec<f32>) {
        let [_, ny, nz] = size;
        let mut volume = Volume::filled(size, 0.0f32);
        let mut tau = Vec::new();
        for (n, sample) in volume.samples_mut().iter_mut().enumerate() {
            let (x, z) = ((n / nz / ny) as f32, (n % nz) as f32);
            let time = z - 0.6 * x;
            *sample = 5.0 + (1.0 - share) * (time * 0.5).sin() + share * noise(n);
            tau.push(time);
        }
        (volume, tau)
    }

    #[test]
    fn traces_that_repeat_one_another_correlate_and_noise_does_not() {
        let size = [40, 40, 96];
        let middle = |share: f32| {
            let (volume, tau) = mixed(size, share);
            Coherence::new(&tau, &volume).on_trace(20, 20)[48]
        };
        let (beds, half, noise) = (middle(0.0), middle(0.5), middle(1.0));
        assert!(beds > 0.98 && noise.abs() < 0.05, "{beds} {noise}");
        // A sine has a mean square of 1/2, the noise 1/3, and less between samples.
        assert!((0.6..0.8).contains(&half), "{half}");
    }

    #[test]
    fn time_that_does_not_follow_the_beds_has_no_coherence() {
        let (volume, tau) = mixed([40, 40, 96], 0.0);
        let flat: Vec<f32> = (0..tau.len()).map(|n| (n % 96) as f32).collect();
        let (along, across) = (Coherence::new(&tau, &volume), Coherence::new(&flat, &volume));
        assert!(across.on_trace(20, 20)[48] < 0.7 * along.on_trace(20, 20)[48]);
        let nowhere = Coherence::new(&vec![f32::NAN; tau.len()], &volume);
        assert!(nowhere.on_trace(20, 20).iter().all(|c| *c == 0.0));
    }
}
