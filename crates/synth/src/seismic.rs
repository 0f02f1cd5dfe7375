//! The seismic and impedance volumes of a model.
//!
//! The seismic is a convolutional model that is evaluated analytically: trace(z) = Σ rᵢ·w(z − zᵢ) over the
//! reflectors of the vertical line, with the Ricker wavelet `w(t) = (1 − 2π²t²)·exp(−π²t²)`, t in
//! wavelengths. Fault planes themselves do not reflect. The wavelet is zero-phase and not stretched by dip,
//! so that an isolated reflector is an extremum at exactly its depth.
//!
//! The noise is white, convolved with the same wavelet along z (and so limited to its band), then smoothed
//! across inlines and crosslines by a Gaussian, and scaled so that RMS signal / RMS noise is the ratio asked
//! for, over the whole volume.
//!
//! Both are made a few inlines at a time ([`SeismicLines`]). The ratio needs the noise of the whole volume before the first
//! line is known: noise that takes more than 64 MB is therefore made twice. Memory: the lines that are asked for, as many
//! lines of noise and eight more.

use super::random::{key, normal_at};
use super::truth::SynthTruth;
use glam::DVec3;
use rayon::prelude::*;
use std::collections::BTreeMap;
use std::f64::consts::PI;
use std::ops::Range;
use survey::progress::{Cancelled, Progress};

/// Amplitude of a reflectivity of 1.
pub(crate) const AMPLITUDE: f64 = 10_000.0;

/// Reach of the wavelet in wavelengths: beyond, it is less than 10⁻⁵.
const REACH: f64 = 1.3;

/// Standard deviation of the lateral smoothing of noise, traces.
const LATERAL_SIGMA: f64 = 1.25;

/// The Ricker wavelet of unit height; t in wavelengths.
pub(super) fn ricker(t: f64) -> f64 {
    let square = (PI * t).powi(2);
    (1.0 - 2.0 * square) * (-square).exp()
}

/// Noise of a volume up to this size is kept, bytes; of a larger one it is made twice.
const KEPT_BYTES: usize = 64 << 20;

/// Bytes of the lines that are made at a time, about.
const TOGETHER_BYTES: usize = 64 << 20;

/// The seismic of a survey, made a few inlines at a time.
pub struct SeismicLines<'a> {
    truth: &'a SynthTruth,
    noise: Option<ScaledNoise>,
}

/// Noise and the factor that gives it its level.
struct ScaledNoise {
    noise: BandNoise,
    scale: f32,
}

impl<'a> SeismicLines<'a> {
    /// Prepares the seismic; with noise, its level is measured, which takes as long as making all of it once.
    pub(super) fn new(
        truth: &'a SynthTruth,
        snr: Option<f64>,
        seed: u64,
        progress: &Progress,
    ) -> Result<Self, Cancelled> {
        let Some(snr) = snr else { return Ok(Self { truth, noise: None }) };
        let [nx, ny, nz] = truth.size;
        let mut noise = BandNoise::new(truth, seed);
        let (mut signal_squares, mut noise_squares) = (Vec::with_capacity(nx), Vec::with_capacity(nx));
        let squares = |values: &[f32]| values.iter().map(|&v| f64::from(v) * f64::from(v)).sum::<f64>();
        progress.begin("noise", nx as u64);
        for lines in blocks(nx, lines_together(truth.size)) {
            noise.make(&lines);
            let of_line = |x: usize| {
                progress.step(1)?;
                let mut values = vec![0.0f32; ny * nz];
                signal(truth, x, &mut values);
                Ok([squares(&values), squares(&noise.across(x))])
            };
            let found = lines.into_par_iter().map(of_line).collect::<Result<Vec<_>, Cancelled>>()?;
            signal_squares.extend(found.iter().map(|[signal, _]| signal));
            noise_squares.extend(found.iter().map(|[_, noise]| noise));
        }
        let count = nx * ny * nz;
        let ratio = root_mean_square(&signal_squares, count) / root_mean_square(&noise_squares, count);
        Ok(Self { truth, noise: Some(ScaledNoise { noise, scale: (ratio / snr) as f32 }) })
    }

    /// How many inlines are best made at a time.
    pub fn together(&self) -> usize {
        lines_together(self.truth.size)
    }

    /// The samples of some inlines, `[inline][crossline][sample]`. Ranges that follow one another cost least.
    pub fn lines(&mut self, inlines: Range<usize>) -> Vec<f32> {
        let [_, ny, nz] = self.truth.size;
        if let Some(noise) = &mut self.noise {
            noise.noise.make(&inlines);
        }
        let mut samples = vec![0.0f32; inlines.len() * ny * nz];
        samples.par_chunks_mut(ny * nz).zip(inlines).for_each(|(values, x)| {
            signal(self.truth, x, values);
            if let Some(ScaledNoise { noise, scale }) = &self.noise {
                values.iter_mut().zip(noise.across(x)).for_each(|(value, noise)| *value += scale * noise);
            }
        });
        samples
    }
}

/// Ranges of at most `together` lines that follow one another.
pub(super) fn blocks(count: usize, together: usize) -> impl Iterator<Item = Range<usize>> {
    (0..count).step_by(together).map(move |first| first..(first + together).min(count))
}

/// Count of lines of about [`TOGETHER_BYTES`].
fn lines_together([nx, ny, nz]: [usize; 3]) -> usize {
    (TOGETHER_BYTES / (ny * nz * size_of::<f32>()).max(1)).clamp(1, nx.max(1))
}

/// Adds the noise-free seismic of inline `x`.
fn signal(truth: &SynthTruth, x: usize, line: &mut [f32]) {
    let nz = truth.size[2];
    let wavelength = truth.wavelength_m / truth.step_m.z;
    for (y, trace) in line.chunks_mut(nz).enumerate() {
        for (z, reflectivity) in truth.reflectors(x as f64, y as f64) {
            let first = (z - REACH * wavelength).ceil().max(0.0) as usize;
            let last = (z + REACH * wavelength).floor().min(nz as f64 - 1.0);
            if last < 0.0 {
                continue;
            }
            for (sample, value) in trace.iter_mut().enumerate().take(last as usize + 1).skip(first) {
                *value += (AMPLITUDE * reflectivity * ricker((sample as f64 - z) / wavelength)) as f32;
            }
        }
    }
}

/// Root mean square; the same bits at any thread count because lines are added in order.
fn root_mean_square(line_sums: &[f64], count: usize) -> f64 {
    (line_sums.iter().sum::<f64>() / count as f64).sqrt()
}

/// Noise without its level: white, filtered along z and along y, line by line; smoothed across inlines when it is asked
/// for.
struct BandNoise {
    size: [usize; 3],
    key: u64,
    wavelet: Vec<f32>,
    /// Of the lateral smoothing.
    weights: Vec<f32>,
    /// The lines that are there, by their index.
    lines: BTreeMap<usize, Vec<f32>>,
    /// Whether lines that were passed stay.
    is_kept: bool,
}

impl BandNoise {
    fn new(truth: &SynthTruth, seed: u64) -> Self {
        let wavelength = truth.wavelength_m / truth.step_m.z;
        let reach = (REACH * wavelength).ceil() as usize;
        let value = |n: usize| ricker((n as f64 - reach as f64) / wavelength) as f32;
        Self {
            size: truth.size,
            key: key(seed, 4),
            wavelet: (0..=2 * reach).map(value).collect(),
            weights: lateral_weights(),
            lines: BTreeMap::new(),
            is_kept: truth.size.iter().product::<usize>() * size_of::<f32>() <= KEPT_BYTES,
        }
    }

    /// Makes the lines that [`BandNoise::across`] needs for these inlines, and forgets others.
    fn make(&mut self, inlines: &Range<usize>) {
        let reach = self.weights.len() / 2;
        // Lines beyond the outer boundary are mirrored into this range.
        let needed = inlines.start.saturating_sub(reach)..(inlines.end + reach).min(self.size[0]);
        if !self.is_kept {
            self.lines.retain(|x, _| needed.contains(x));
        }
        let missing: Vec<usize> = needed.filter(|x| !self.lines.contains_key(x)).collect();
        let made: Vec<(usize, Vec<f32>)> = missing.into_par_iter().map(|x| (x, self.line(x))).collect();
        self.lines.extend(made);
    }

    /// Line x, filtered along z and along y.
    fn line(&self, x: usize) -> Vec<f32> {
        let [_, ny, nz] = self.size;
        let padded = nz + self.wavelet.len() - 1;
        let mut white = vec![0.0f32; padded];
        let mut banded = vec![0.0f32; ny * nz];
        for (y, trace) in banded.chunks_mut(nz).enumerate() {
            let first = ((x * ny + y) * padded) as u64;
            for (n, value) in white.iter_mut().enumerate() {
                *value = normal_at(self.key, first + n as u64);
            }
            for (lag, &weight) in self.wavelet.iter().enumerate() {
                for (value, &raw) in trace.iter_mut().zip(&white[lag..]) {
                    *value += weight * raw;
                }
            }
        }
        let mut line = vec![0.0f32; ny * nz];
        for (y, trace) in line.chunks_mut(nz).enumerate() {
            for (lag, &weight) in self.weights.iter().enumerate() {
                let from = mirrored(y, lag, self.weights.len() / 2, ny) * nz;
                for (value, &raw) in trace.iter_mut().zip(&banded[from..from + nz]) {
                    *value += weight * raw;
                }
            }
        }
        line
    }

    /// Line x, smoothed across inlines; the lines that it needs are there.
    fn across(&self, x: usize) -> Vec<f32> {
        let [nx, ny, nz] = self.size;
        let mut sum = vec![0.0f32; ny * nz];
        for (lag, &weight) in self.weights.iter().enumerate() {
            let line = &self.lines[&mirrored(x, lag, self.weights.len() / 2, nx)];
            for (value, &raw) in sum.iter_mut().zip(line) {
                *value += weight * raw;
            }
        }
        sum
    }
}

/// Gaussian weights for lags −r … r.
fn lateral_weights() -> Vec<f32> {
    let reach = (3.0 * LATERAL_SIGMA).ceil() as i32;
    (-reach..=reach).map(|lag| (-0.5 * (f64::from(lag) / LATERAL_SIGMA).powi(2)).exp() as f32).collect()
}

/// Index of a neighbour, mirrored at the outer boundary of the volume.
fn mirrored(index: usize, lag: usize, reach: usize, count: usize) -> usize {
    let last = count as i64 - 1;
    let mut at = index as i64 + lag as i64 - reach as i64;
    while at < 0 || at > last {
        at = if at < 0 { -at } else { 2 * last - at };
    }
    at as usize
}

/// Acoustic impedance of inline `x` on a lattice of its own of `[crosslines, samples]`; `voxel_at` gives the seismic voxel
/// of a lattice point and `cell` the height of one of its samples in seismic voxels, over which the blocky truth is
/// averaged.
pub(super) fn impedance(
    truth: &SynthTruth,
    [crosslines, samples]: [usize; 2],
    cell: f64,
    voxel_at: impl Fn(DVec3) -> DVec3 + Sync,
    x: usize,
) -> Vec<f32> {
    /// Points averaged in a cell.
    const POINTS: usize = 4;
    let value = |n: usize| {
        let p = voxel_at(DVec3::new(x as f64, (n / samples) as f64, (n % samples) as f64));
        let offset = |point: usize| cell * ((point as f64 + 0.5) / POINTS as f64 - 0.5);
        let sum: f64 = (0..POINTS).map(|point| truth.impedance_at(p + DVec3::Z * offset(point))).sum();
        (sum / POINTS as f64) as f32
    };
    (0..crosslines * samples).map(value).collect()
}
