//! Logs: mean amplitude as a function of τ, and the warp that makes one log fit another.
//!
//! Inside a block τ is known up to one increasing function, so many traces stack into one log with little noise. Two
//! logs A, B of the same beds differ by a shift δ(t) that changes slowly; it maximises
//!
//! `−Σ (A(t) − B(t + δ(t)))²  with  |δ| ≤ most  and  |∂δ/∂t| ≤ 1/4`
//!
//! found by dynamic programming over knots four samples apart (after H. Sakoe and S. Chiba, IEEE Transactions on
//! Acoustics, Speech, and Signal Processing 26, 1978, for speech). Unit: samples of τ.

/// Width of a bin, samples.
pub(crate) const BIN: f32 = 0.5;
/// Bins between knots.
const KNOT: usize = 8;
/// Bins by which δ may change from knot to knot: a slope of 1/4.
const MOST_CHANGE: i32 = 2;
/// Bins to either side of a knot that count for it.
const WINDOW: usize = 12;
/// Bins within which amplitudes are brought to one level.
const LEVEL: usize = 48;
/// What a shift costs for each sample of it, as a part of a perfect fit: keeps silent places where they are.
const COST: f32 = 0.003;

/// Energy below which there is nothing to compare; the mean is about 1.
const SILENCE: f32 = 0.1;

/// A log that is being stacked.
#[derive(Debug, Clone)]
pub(crate) struct Log {
    first: f32,
    sum: Vec<f32>,
    count: Vec<f32>,
}

impl Log {
    /// An empty log from `first` to `last`.
    pub(crate) fn new(first: f32, last: f32) -> Self {
        let bins = ((last - first) / BIN).ceil().max(1.0) as usize + 2;
        Self { first, sum: vec![0.0; bins], count: vec![0.0; bins] }
    }

    /// Adds an amplitude at a time.
    #[inline]
    pub(crate) fn add(&mut self, time: f32, amplitude: f32) {
        let at = (time - self.first) / BIN;
        if !(at >= 0.0 && at < (self.sum.len() - 1) as f32 && amplitude.is_finite()) {
            return;
        }
        let low = at as usize;
        let share = at - low as f32;
        for (bin, share) in [(low, 1.0 - share), (low + 1, share)] {
            self.sum[bin] += share * amplitude;
            self.count[bin] += share;
        }
    }

    /// Adds another log of the same times.
    pub(crate) fn add_log(&mut self, other: &Self) {
        self.sum.iter_mut().zip(&other.sum).for_each(|(a, b)| *a += b);
        self.count.iter_mut().zip(&other.count).for_each(|(a, b)| *a += b);
    }

    /// Time and mean amplitude of every bin to which at least `least` amplitudes were added.
    pub(crate) fn means(&self, least: f32) -> impl Iterator<Item = (f32, f32)> + '_ {
        let bins = self.sum.iter().zip(&self.count).enumerate().filter(move |(_, (_, count))| **count >= least);
        bins.map(|(n, (sum, count))| (self.first + n as f32 * BIN, sum / count))
    }

    /// Mean amplitudes of the bins, brought to one level; 0 where less than `least` amplitudes were added.
    fn levelled(&self, least: f32) -> Vec<f32> {
        let mut mean: Vec<f32> =
            self.sum.iter().zip(&self.count).map(|(s, c)| if *c >= least { s / c } else { 0.0 }).collect();
        let power: Vec<f32> = mean.iter().map(|a| a * a).collect();
        let filled = mean.iter().filter(|a| **a != 0.0).count().max(1);
        let whole = power.iter().sum::<f32>() / filled as f32;
        for n in 0..mean.len() {
            let window = &power[n.saturating_sub(LEVEL)..(n + LEVEL + 1).min(power.len())];
            let here = window.iter().sum::<f32>() / window.len() as f32;
            mean[n] /= (here + 0.1 * whole + f32::MIN_POSITIVE).sqrt();
        }
        mean
    }

    /// Fits `other` to this log: the shift δ for which `self(t)` is `other(t + δ(t))`, of at most `most` samples.
    pub(crate) fn fit(&self, other: &Self, most: f32, least: f32) -> Warp {
        let (a, b) = (self.levelled(least), other.levelled(least));
        let reach = (most / BIN) as i32;
        let states = (2 * reach + 1) as usize;
        let knots = a.len().div_ceil(KNOT) + 1;
        let at = |log: &[f32], n: i32| if n >= 0 { log.get(n as usize).copied().unwrap_or(0.0) } else { 0.0 };
        // Both amplitudes around a knot under a shift, with the weights of a window.
        let around = |knot: usize, state: usize| {
            let (knot, shift) = ((knot * KNOT) as i32, state as i32 - reach);
            let (a, b) = (&a, &b);
            (-(WINDOW as i32)..=WINDOW as i32).map(move |d| {
                let weight = (1.0 - d.abs() as f32 / (WINDOW + 1) as f32) / (WINDOW + 1) as f32;
                (weight, at(a, knot + d), at(b, knot + d + shift))
            })
        };
        // How well each shift fits around each knot.
        let fit: Vec<f32> = (0..knots * states)
            .map(|n| {
                let misfit: f32 = around(n / states, n % states).map(|(w, a, b)| w * (a - b) * (a - b)).sum();
                let shift = (n % states) as f32 - reach as f32;
                -0.5 * misfit - COST * shift.abs() * BIN
            })
            .collect();
        let (mut best, mut from) = (fit[..states].to_vec(), vec![0i8; knots * states]);
        for knot in 1..knots {
            let before = best.clone();
            for state in 0..states {
                let mut top = f32::NEG_INFINITY;
                for change in [0, -1, 1, -MOST_CHANGE, MOST_CHANGE] {
                    let last = state as i32 + change;
                    if (0..states as i32).contains(&last) && before[last as usize] > top {
                        top = before[last as usize];
                        from[knot * states + state] = change as i8;
                    }
                }
                best[state] = top + fit[knot * states + state];
            }
        }
        let mut state = (0..states).fold(0, |top, n| if best[n] > best[top] { n } else { top });
        let (mut shift, mut quality) = (vec![0.0f32; knots], vec![0.0f32; knots]);
        for knot in (0..knots).rev() {
            let here = |n: usize| fit[knot * states + n];
            // The top of the parabola through the neighbours lies between bins.
            let mut fraction = 0.0;
            if state > 0 && state + 1 < states {
                let (l, m, r) = (here(state - 1), here(state), here(state + 1));
                let bend = l - 2.0 * m + r;
                if bend < 0.0 && m >= l && m >= r {
                    fraction = (0.5 * (l - r) / bend).clamp(-0.5, 0.5);
                }
            }
            shift[knot] = (state as f32 - reach as f32 + fraction) * BIN;
            let (mut product, mut energy) = (0.0f32, SILENCE);
            for (w, a, b) in around(knot, state) {
                product += w * a * b;
                energy += 0.5 * w * (a * a + b * b);
            }
            quality[knot] = product / energy;
            state = (state as i32 + i32::from(from[knot * states + state])) as usize;
        }
        Warp { first: self.first, shift, quality }
    }
}

/// A shift that depends on τ.
#[derive(Debug, Clone)]
pub(crate) struct Warp {
    first: f32,
    shift: Vec<f32>,
    quality: Vec<f32>,
}

impl Warp {
    fn read(&self, values: &[f32], time: f32) -> f32 {
        let at = ((time - self.first) / (BIN * KNOT as f32)).clamp(0.0, (values.len() - 1) as f32);
        let low = (at as usize).min(values.len().saturating_sub(2));
        values[low] + (at - low as f32) * (values[(low + 1).min(values.len() - 1)] - values[low])
    }

    /// δ at a time.
    pub(crate) fn shift(&self, time: f32) -> f32 {
        self.read(&self.shift, time)
    }

    /// How well the logs fit there: about 1 where they are equal, 0 where they have nothing in common.
    pub(crate) fn quality(&self, time: f32) -> f32 {
        self.read(&self.quality, time)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A log of made-up beds, seen through a shift.
    fn log(shift: impl Fn(f32) -> f32) -> Log {
        let mut log = Log::new(0.0, 120.0);
        for n in 0..1200 {
            let t = n as f32 * 0.1;
            let u = t - shift(t);
            log.add(t, (u * 0.7).sin() + (u * 0.41 + 1.0).sin() + 0.6 * (u * 1.13 + 2.0).cos());
        }
        log
    }

    #[test]
    fn a_warp_finds_a_shift_that_grows_slowly() {
        let a = log(|_| 0.0);
        let b = log(|t| 2.0 + 0.02 * t);
        let warp = a.fit(&b, 8.0, 1.0);
        for t in [20.0, 40.0, 60.0, 80.0, 100.0f32] {
            // b(t + δ) is a(t) where δ = 2 + 0.02 (t + δ).
            let expected = (2.0 + 0.02 * t) / 0.98;
            assert!((warp.shift(t) - expected).abs() <= BIN, "at {t}: {} for {expected}", warp.shift(t));
        }
        let none = a.fit(&a, 8.0, 1.0);
        assert!((2..22).all(|n| none.shift(5.0 * n as f32).abs() < 0.2));
    }
}
