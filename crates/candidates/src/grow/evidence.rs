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
pub(crate) const MOST: u8 = 100;

/// E made by noise alone, in quarters.
pub(crate) const FROM_NOISE: f32 = 4.0;

/// Greatest E that counts in the mean around a place, in quarters.
pub(crate) const LOUD: u8 = 24;

/// f: misfit that interpolation and curvature can make, samples.
const LEAST_MISFIT: f32 = 0.08;

/// g: relative change of amplitude from trace to trace that is no sign of a break.
const LEAST_CHANGE: f32 = 0.05;

/// Median of the absolute value of a normal variable, in standard deviations.
const MEDIAN_OVER_SIGMA: f32 = 0.6745;

/// One in this many extrema is used to measure the noise.
pub(crate) const SPARSE: usize = 7;

/// Width of the classes of dip, samples a trace.
const DIP_CLASS: f32 = 0.25;

/// Count of classes of dip; the last one is open.
pub(crate) const DIP_CLASSES: usize = 13;

/// Quantiles of the amplitudes that separate the classes of amplitude.
pub(crate) const HEIGHT_SHARES: [f32; HEIGHT_CLASSES - 1] = [0.5, 0.7, 0.82, 0.9, 0.95, 0.98];

/// Count of classes of amplitude.
pub(crate) const HEIGHT_CLASSES: usize = 7;

/// Least count of links in a class; a class with fewer takes the value of the next less steep one.
const LEAST_LINKS: usize = 64;

/// The effect of noise on the links of one kind of extremum.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Noise {
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
    pub(crate) fn measure(extrema: &Extrema, links: &Links, dips: &[[f32; 2]]) -> Self {
        let steps = height_steps(extrema);
        let mut places: [Vec<f32>; DIP_CLASSES] = Default::default();
        let mut changes: [[Vec<f32>; DIP_CLASSES]; HEIGHT_CLASSES] = Default::default();
        for v in (0..extrema.len()).step_by(SPARSE) {
            each_sample(extrema, links, dips, &steps, v, |[dip, height], [place, change]| {
                places[dip].push(place);
                changes[height][dip].push(change);
            });
        }
        Self::of_medians(steps, places.each_mut().map(|values| Median::of(values)), |height, dip| {
            Median::of(&mut changes[height][dip])
        })
    }

    /// The noise from the medians of each class; a class with too few links takes the value of the one before it.
    pub(crate) fn of_medians(
        steps: [f32; HEIGHT_CLASSES - 1],
        places: [Median; DIP_CLASSES],
        mut changes: impl FnMut(usize, usize) -> Median,
    ) -> Self {
        let mut noise = Self { places: [0.0; _], steps, changes: [[0.0; _]; _] };
        for (dip, place) in places.into_iter().enumerate() {
            let before = dip.checked_sub(1).map(|before| noise.places[before]);
            noise.places[dip] = place.sigma_or(before);
            for height in 0..HEIGHT_CLASSES {
                let before = match (dip, height) {
                    (1.., _) => Some(noise.changes[height][dip - 1]),
                    (0, 1..) => Some(noise.changes[height - 1][0]),
                    _ => None,
                };
                noise.changes[height][dip] = changes(height, dip).sigma_or(before);
            }
        }
        noise
    }

    /// The noise as numbers, and back.
    pub(crate) fn to_numbers(&self) -> Vec<f32> {
        let mut numbers = self.places.to_vec();
        numbers.extend(self.steps);
        numbers.extend(self.changes.as_flattened());
        numbers
    }

    /// The noise that [`Noise::to_numbers`] wrote down; `None` for another count of numbers.
    pub(crate) fn of_numbers(numbers: &[f32]) -> Option<Self> {
        let (places, rest) = numbers.split_first_chunk()?;
        let (steps, rest) = rest.split_first_chunk()?;
        let changes = rest.as_chunks().0.try_into().ok()?;
        Some(Self { places: *places, steps: *steps, changes })
    }

    /// c and s of a link at a dip; `amplitude` is the larger one of its extrema.
    fn of(&self, amplitude: f32, dip: f32) -> [f32; 2] {
        let dip = class(dip);
        [self.places[dip], self.changes[height_class(&self.steps, amplitude)][dip]]
    }

    /// s of the weaker half of the extrema where reflectors are flat: the effect of noise on a height.
    pub(crate) fn least_change(&self) -> f32 {
        self.changes[0][0]
    }

    /// s of an amplitude where reflectors are flat.
    fn change(&self, amplitude: f32) -> f32 {
        self.changes[height_class(&self.steps, amplitude)][0]
    }
}

/// The median of the absolute values of a class.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Median {
    /// Count of values.
    pub(crate) count: usize,
    /// The one in the middle; 0 when there are none.
    pub(crate) middle: f32,
}

impl Median {
    fn of(values: &mut [f32]) -> Self {
        let middle = values.len() / 2;
        let found = (!values.is_empty()).then(|| *values.select_nth_unstable_by(middle, f32::total_cmp).1);
        Self { count: values.len(), middle: found.unwrap_or(0.0) }
    }

    /// The standard deviation.
    pub(crate) fn sigma(self) -> f32 {
        self.middle / MEDIAN_OVER_SIGMA
    }

    /// The standard deviation, or that of the class `before` it when it has too few links.
    fn sigma_or(self, before: Option<f32>) -> f32 {
        before.filter(|_| self.count < LEAST_LINKS).unwrap_or_else(|| self.sigma())
    }
}

/// Calls `found([class of dip, class of height], [place, change])` for each link of an extremum to the next traces.
pub(crate) fn each_sample(
    extrema: &Extrema,
    links: &Links,
    dips: &[[f32; 2]],
    steps: &[f32; HEIGHT_CLASSES - 1],
    v: usize,
    mut found: impl FnMut([usize; 2], [f32; 2]),
) {
    for (axis, direction) in [NEXT_X, NEXT_Y].into_iter().enumerate() {
        let next = links.to[direction][v];
        if next == NONE {
            continue;
        }
        let next = next as usize;
        let (a, b) = (extrema.amplitude[v], extrema.amplitude[next]);
        let place = misfit(extrema, dips, v, next, axis).abs() / uncertainty(a, b);
        found([class(dips[v][axis]), height_class(steps, a.max(b))], [place, (a - b).abs()]);
    }
}

/// Amplitudes between the classes, at the quantiles of [`HEIGHT_SHARES`].
fn height_steps(extrema: &Extrema) -> [f32; HEIGHT_CLASSES - 1] {
    let mut sample: Vec<f32> = extrema.amplitude.iter().step_by(SPARSE).copied().collect();
    sample.sort_unstable_by(f32::total_cmp);
    HEIGHT_SHARES.map(|share| sample.get(rank(share, sample.len())).copied().unwrap_or(f32::INFINITY))
}

/// The place of a quantile among `count` ascending values.
pub(crate) fn rank(share: f32, count: usize) -> usize {
    (share * count as f32) as usize
}

/// Class of an amplitude.
fn height_class(steps: &[f32; HEIGHT_CLASSES - 1], amplitude: f32) -> usize {
    steps.iter().filter(|&&step| amplitude > step).count()
}

/// Class of a dip.
fn class(dip: f32) -> usize {
    ((dip.abs() / DIP_CLASS) as usize).min(DIP_CLASSES - 1)
}

/// (1/a² + 1/b²)^½.
fn uncertainty(a: f32, b: f32) -> f32 {
    let (a, b) = (1.0 / a, 1.0 / b);
    (a * a + b * b).sqrt()
}

/// Misfit of a link to the dips at its ends, samples.
#[inline]
pub(crate) fn misfit(extrema: &Extrema, dips: &[[f32; 2]], v: usize, next: usize, axis: usize) -> f32 {
    extrema.z[next] - extrema.z[v] - 0.5 * (dips[v][axis] + dips[next][axis])
}

/// Rounds of the binomial 1-2-1 across the link; 8 rounds have a standard deviation of two traces.
pub(crate) const ROUNDS: usize = 8;

/// Least variance of smoothed values, so that rounding errors of clean data do not count as evidence.
const LEAST_VARIANCE: f32 = 0.1;

/// Greatest square with which a misfit or a change of amplitude counts.
const MOST_SQUARE: f32 = 25.0;

/// E of the links to x + 1 and y + 1 of each extremum, in quarters. An extremum without such a link has
/// [`MOST`] when it is strong and 0 when it is weak.
pub(crate) fn evidence(
    extrema: &Extrema,
    links: &Links,
    dips: &[[f32; 2]],
    noise: &Noise,
    scratch: &mut SmoothingScratch,
    progress: &Progress,
) -> Result<Vec<[u8; 2]>, Cancelled> {
    let mut found = vec![[0u8; 2]; extrema.len()];
    for axis in 0..2 {
        smoothed_breaks(extrema, links, dips, noise, axis, scratch, progress)?;
        let signed = &scratch.values;
        let variance = [0, 1].map(|which| {
            let sample = signed.iter().step_by(SPARSE).filter(|s| s[2] > 0.0);
            let mut sample: Vec<f32> = sample.map(|s| (s[which] / s[2]).abs()).collect();
            variance(Median::of(&mut sample))
        });
        found.par_iter_mut().with_min_len(1 << 14).enumerate().for_each(|(v, found)| {
            let [misfit, change, weight, _] = signed[v];
            let is_linked = links.to[2 * axis][v] != NONE;
            found[axis] =
                quarters(is_linked, extrema.amplitude[v], noise, [misfit / weight, change / weight], variance);
        });
        beside_surroundings(extrema, links, &mut found, axis);
        progress.step(extrema.size[0] as u64)?;
    }
    Ok(found)
}

/// The variance of smoothed values.
pub(crate) fn variance(median: Median) -> f32 {
    median.sigma().powi(2).max(LEAST_VARIANCE)
}

/// Misfits and changes of amplitude, smoothed across the links along `axis`, into `scratch.values`: both times a weight,
/// and the weight.
pub(crate) fn smoothed_breaks(
    extrema: &Extrema,
    links: &Links,
    dips: &[[f32; 2]],
    noise: &Noise,
    axis: usize,
    scratch: &mut SmoothingScratch,
    progress: &Progress,
) -> Result<(), Cancelled> {
    scratch.resize(extrema.len());
    signed_breaks(extrema, links, dips, noise, axis, &mut scratch.values);
    smoothing::along(extrema, links, 1 - axis, ROUNDS, scratch, progress)
}

/// E of a link, in quarters, from its smoothed misfit and change of amplitude.
pub(crate) fn quarters(
    is_linked: bool,
    amplitude: f32,
    noise: &Noise,
    [misfit, change]: [f32; 2],
    variance: [f32; 2],
) -> u8 {
    if !is_linked {
        return if is_strong(amplitude, noise) { MOST } else { 0 };
    }
    let square = |ratio: f32, variance: f32| (ratio.powi(2) / variance).min(MOST_SQUARE);
    (4.0 * 0.5 * (square(misfit, variance[0]) + square(change, variance[1])) + 0.5) as u8
}

/// Evidence divided by the mean around it, where that is above what noise makes.
pub(crate) fn beside(value: u8, mean: f32) -> u8 {
    (f32::from(value) / (mean / FROM_NOISE).max(1.0) + 0.5) as u8
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
                let value = &mut line[v - first][axis];
                *value = beside(*value, usual.at(x, y, extrema.z[v]));
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
pub(crate) fn is_strong(amplitude: f32, noise: &Noise) -> bool {
    amplitude > 5.0 * noise.change(amplitude)
}

/// Along x and along y, whether an extremum is strong and has no partner behind it.
#[inline]
pub(crate) fn begins(extrema: &Extrema, links: &Links, v: usize, noise: &Noise) -> [bool; 2] {
    [BACK_X, BACK_Y].map(|back| links.to[back][v] == NONE && is_strong(extrema.amplitude[v], noise))
}
