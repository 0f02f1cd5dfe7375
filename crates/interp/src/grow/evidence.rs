//! The evidence of each link for a break: misfit to the dip and change of amplitude, in units of what noise
//! alone makes.
//!
//! Noise moves an extremum of height a by an amount proportional to 1/a. For a link with misfit r between
//! extrema of heights a and b
//!
//! `m = r/√(c²·(1/a² + 1/b²) + f²)`, `h = (b − a)/√(s² + g²·max(a, b)²)`, `E = ½·m̄²/var m̄ + ½·h̄²/var h̄`
//!
//! c and s are measured in the volume: medians over its links in classes of dip (s in classes of amplitude
//! too). The bar is a binomial over the surface *across* the link: along a fault misfits keep their sign and
//! add up, while noise cancels. Variances are measured (by medians) too, so that E is about 1 on a continuous
//! reflector at any signal-to-noise ratio. f and g keep rounding errors of clean data from counting as
//! evidence. A strong extremum without a partner has the greatest E. E is stored in quarters, at most
//! [`MOST`].
use super::links::{BACK_X, BACK_Y, Links, NEXT_X, NEXT_Y, NONE};
use super::smoothing::{self, Four, SmoothingScratch};
use super::surroundings::Surroundings;
use crate::extrema::Extrema;
use rayon::prelude::*;
use survey::{Cancelled, Progress};

/// Greatest E, in quarters.
pub(super) const MOST: u8 = 100;

/// E made by noise alone, in quarters.
const FROM_NOISE: f32 = 4.0;

/// Greatest E that counts in the mean around a place, in quarters.
const LOUD: u8 = 24;

/// f: misfit that interpolation and curvature can make, samples.
const LEAST_MISFIT: f32 = 0.08;

/// g: relative change of amplitude from trace to trace that is no sign of a break.
const LEAST_CHANGE: f32 = 0.05;

/// Median of the absolute value of a normal variable, in standard deviations.
const MEDIAN_OVER_SIGMA: f32 = 0.6745;

/// One in this many extrema is used to measure the noise.
const SPARSE: usize = 7;

/// Width of the classes of dip, samples a trace.
const DIP_CLASS: f32 = 0.25;

/// Count of classes of dip; the last one is open.
const DIP_CLASSES: usize = 13;

/// Quantiles of the amplitudes that separate the classes of amplitude.
const HEIGHT_SHARES: [f32; HEIGHT_CLASSES - 1] = [0.5, 0.7, 0.82, 0.9, 0.95, 0.98];

/// Count of classes of amplitude.
const HEIGHT_CLASSES: usize = 7;

/// Least count of links in a class; a class with fewer takes the value of the next less steep one.
const LEAST_LINKS: usize = 64;

/// The effect of noise on the links of one kind of extremum.
#[derive(Debug, Clone)]
pub(super) struct Noise {
    /// c for each class of dip, amplitude × samples.
    places: [f32; DIP_CLASSES],
    /// Least amplitude of each class but the first.
    steps: [f32; HEIGHT_CLASSES - 1],
    /// s for each class of amplitude and of dip, amplitude.
    changes: [[f32; DIP_CLASSES]; HEIGHT_CLASSES],
}

impl Noise {
    /// Measures the noise on the links of every seventh extremum, in classes of dip: noise that is similar on
    /// neighbouring traces at one depth moves the extrema of a flat reflector together and those of a dipping
    /// one apart. Changes of amplitude are also measured in classes of amplitude: besides noise, which is
    /// added to all samples alike, the strength of a reflector varies, and it varies more the stronger the
    /// reflector is.
    pub(super) fn measure(extrema: &Extrema, links: &Links, dips: &[[f32; 2]]) -> Self {
        let steps = height_steps(extrema);
        let mut places: [Vec<f32>; DIP_CLASSES] = Default::default();
        let mut changes: [[Vec<f32>; DIP_CLASSES]; HEIGHT_CLASSES] = Default::default();
        for v in (0..extrema.len()).step_by(SPARSE) {
            for (axis, direction) in [NEXT_X, NEXT_Y].into_iter().enumerate() {
                let next = links.to[direction][v];
                if next == NONE {
                    continue;
                }
                let next = next as usize;
                let (a, b) = (extrema.amplitude[v], extrema.amplitude[next]);
                let dip = class(dips[v][axis]);
                places[dip].push(misfit(extrema, dips, v, next, axis).abs() / uncertainty(a, b));
                changes[height_class(&steps, a.max(b))][dip].push((a - b).abs());
            }
        }
        let mut noise = Self { places: [0.0; _], steps, changes: [[0.0; _]; _] };
        for dip in 0..DIP_CLASSES {
            let before = dip.checked_sub(1).map(|before| noise.places[before]);
            noise.places[dip] = measured(&mut places[dip], before);
            for (height, changes) in changes.iter_mut().enumerate() {
                let before = match (dip, height) {
                    (1.., _) => Some(noise.changes[height][dip - 1]),
                    (0, 1..) => Some(noise.changes[height - 1][0]),
                    _ => None,
                };
                noise.changes[height][dip] = measured(&mut changes[dip], before);
            }
        }
        noise
    }

    /// c and s of a link at a dip; `amplitude` is the larger one of its extrema.
    fn of(&self, amplitude: f32, dip: f32) -> [f32; 2] {
        let dip = class(dip);
        [self.places[dip], self.changes[height_class(&self.steps, amplitude)][dip]]
    }

    /// s of the weaker half of the extrema where reflectors are flat: the effect of noise on a height.
    pub(super) fn least_change(&self) -> f32 {
        self.changes[0][0]
    }

    /// s of an amplitude where reflectors are flat.
    fn change(&self, amplitude: f32) -> f32 {
        self.changes[height_class(&self.steps, amplitude)][0]
    }
}

/// The standard deviation of a class, or that of the class `before` it when it has too few links.
fn measured(values: &mut [f32], before: Option<f32>) -> f32 {
    before.filter(|_| values.len() < LEAST_LINKS).unwrap_or_else(|| sigma(values))
}

/// Amplitudes between the classes, at the quantiles of [`HEIGHT_SHARES`].
fn height_steps(extrema: &Extrema) -> [f32; HEIGHT_CLASSES - 1] {
    let mut sample: Vec<f32> = extrema.amplitude.iter().step_by(SPARSE).copied().collect();
    sample.sort_unstable_by(f32::total_cmp);
    HEIGHT_SHARES.map(|share| sample.get((share * sample.len() as f32) as usize).copied().unwrap_or(f32::INFINITY))
}

/// Class of an amplitude.
fn height_class(steps: &[f32; HEIGHT_CLASSES - 1], amplitude: f32) -> usize {
    steps.iter().filter(|&&step| amplitude > step).count()
}

/// Class of a dip.
fn class(dip: f32) -> usize {
    ((dip.abs() / DIP_CLASS) as usize).min(DIP_CLASSES - 1)
}

/// Standard deviation, from the median of absolute values.
fn sigma(values: &mut [f32]) -> f32 {
    if values.is_empty() {
        return 0.0;
    }
    let middle = values.len() / 2;
    *values.select_nth_unstable_by(middle, f32::total_cmp).1 / MEDIAN_OVER_SIGMA
}

/// (1/a² + 1/b²)^½.
fn uncertainty(a: f32, b: f32) -> f32 {
    let (a, b) = (1.0 / a, 1.0 / b);
    (a * a + b * b).sqrt()
}

/// Misfit of a link to the dips at its ends, samples.
#[inline]
pub(super) fn misfit(extrema: &Extrema, dips: &[[f32; 2]], v: usize, next: usize, axis: usize) -> f32 {
    extrema.z[next] - extrema.z[v] - 0.5 * (dips[v][axis] + dips[next][axis])
}

/// Rounds of the binomial 1-2-1 across the link; 8 rounds have a standard deviation of two traces.
const ROUNDS: usize = 8;

/// Least variance of smoothed values, so that rounding errors of clean data do not count as evidence.
const LEAST_VARIANCE: f32 = 0.1;

/// Greatest square with which a misfit or a change of amplitude counts.
const MOST_SQUARE: f32 = 25.0;

/// E of the links to x + 1 and y + 1 of each extremum, in quarters. An extremum without such a link has
/// [`MOST`] when it is strong and 0 when it is weak.
pub(super) fn evidence(
    extrema: &Extrema,
    links: &Links,
    dips: &[[f32; 2]],
    noise: &Noise,
    scratch: &mut SmoothingScratch,
    progress: &Progress,
) -> Result<Vec<[u8; 2]>, Cancelled> {
    let mut found = vec![[0u8; 2]; extrema.len()];
    scratch.resize(extrema.len());
    for axis in 0..2 {
        signed_breaks(extrema, links, dips, noise, axis, &mut scratch.values);
        smoothing::along(extrema, links, 1 - axis, ROUNDS, scratch, progress)?;
        let signed = &scratch.values;
        let variance = [0, 1].map(|which| {
            let mut sample: Vec<f32> =
                signed.iter().step_by(SPARSE).filter(|s| s[2] > 0.0).map(|s| (s[which] / s[2]).abs()).collect();
            sigma(&mut sample).powi(2).max(LEAST_VARIANCE)
        });
        found.par_iter_mut().with_min_len(1 << 14).enumerate().for_each(|(v, found)| {
            let [misfit, change, weight, _] = signed[v];
            found[axis] = if links.to[2 * axis][v] == NONE {
                if is_strong(extrema.amplitude[v], noise) { MOST } else { 0 }
            } else {
                let square = |sum: f32, variance: f32| ((sum / weight).powi(2) / variance).min(MOST_SQUARE);
                (4.0 * 0.5 * (square(misfit, variance[0]) + square(change, variance[1])) + 0.5) as u8
            };
        });
        beside_surroundings(extrema, links, &mut found, axis);
        progress.step(extrema.size[0] as u64)?;
    }
    Ok(found)
}

/// Divides evidence by the mean around it.
fn beside_surroundings(extrema: &Extrema, links: &Links, found: &mut [[u8; 2]], axis: usize) {
    let linked = |v: usize| links.to[2 * axis][v] != NONE;
    let usual = Surroundings::new(extrema, |v| linked(v).then(|| found[v][axis].min(LOUD)));
    let ny = extrema.size[1];
    extrema.split_inlines(found).into_par_iter().enumerate().for_each(|(x, line)| {
        let first = extrema.on_inline(x).start;
        for y in 0..ny {
            for v in extrema.on_trace(x, y).filter(|&v| linked(v)) {
                let usual = usual.at(x, y, extrema.z[v]) / FROM_NOISE;
                let value = &mut line[v - first][axis];
                *value = (f32::from(*value) / usual.max(1.0) + 0.5) as u8;
            }
        }
    });
}

/// Misfit and change of amplitude of each link along `axis` in units of the noise, and a weight that is 1
/// where there is a link.
fn signed_breaks(extrema: &Extrema, links: &Links, dips: &[[f32; 2]], noise: &Noise, axis: usize, signed: &mut [Four]) {
    let next = &links.to[2 * axis];
    signed.par_iter_mut().with_min_len(1 << 14).enumerate().for_each(|(v, signed)| {
        *signed = [0.0; 4];
        if next[v] == NONE {
            return;
        }
        let next = next[v] as usize;
        let (a, b) = (extrema.amplitude[v], extrema.amplitude[next]);
        let [place, change] = noise.of(a.max(b), dips[v][axis]);
        let off = misfit(extrema, dips, v, next, axis) / length(place * uncertainty(a, b), LEAST_MISFIT);
        let change = (b - a) / length(change, LEAST_CHANGE * a.max(b));
        *signed = [off.clamp(-9.0, 9.0), change.clamp(-9.0, 9.0), 1.0, 0.0];
    });
}

/// (a² + b²)^½ as the C library's `hypotf` gives it: computed in double precision.
fn length(a: f32, b: f32) -> f32 {
    let (a, b) = (f64::from(a), f64::from(b));
    (a * a + b * b).sqrt() as f32
}

/// Whether an extremum is too strong to be noise.
#[inline]
pub(super) fn is_strong(amplitude: f32, noise: &Noise) -> bool {
    amplitude > 5.0 * noise.change(amplitude)
}

/// Along x and along y, whether an extremum is strong and has no partner behind it.
#[inline]
pub(super) fn begins(extrema: &Extrema, links: &Links, v: usize, noise: &Noise) -> [bool; 2] {
    [BACK_X, BACK_Y].map(|back| links.to[back][v] == NONE && is_strong(extrema.amplitude[v], noise))
}
