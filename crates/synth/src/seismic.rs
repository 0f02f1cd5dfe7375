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
//! Memory: 8 bytes per voxel while noise is made, 4 afterwards.

use super::random::{key, normal_at};
use super::truth::SynthTruth;
use glam::DVec3;
use rayon::prelude::*;
use std::f64::consts::PI;
use survey::progress::{Cancelled, Progress};
use survey::volume::Volume;

/// Amplitude of a reflectivity of 1.
pub const AMPLITUDE: f64 = 10_000.0;

/// Reach of the wavelet in wavelengths: beyond, it is less than 10⁻⁵.
const REACH: f64 = 1.3;

/// Standard deviation of the lateral smoothing of noise, traces.
const LATERAL_SIGMA: f64 = 1.25;

/// The Ricker wavelet of unit height; t in wavelengths.
pub(super) fn ricker(t: f64) -> f64 {
    let square = (PI * t).powi(2);
    (1.0 - 2.0 * square) * (-square).exp()
}

/// The noise-free seismic.
pub(super) fn signal(truth: &SynthTruth, progress: &Progress) -> Result<Volume<f32>, Cancelled> {
    let [nx, ny, nz] = truth.size;
    let wavelength = truth.wavelength_m / truth.step_m.z;
    let mut volume = Volume::filled(truth.size, 0.0f32);
    progress.begin("synthetic seismic", nx as u64);
    volume.samples_mut().par_chunks_mut(ny * nz).enumerate().try_for_each(|(x, slab)| {
        for (y, trace) in slab.chunks_mut(nz).enumerate() {
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
        progress.step(1)
    })?;
    Ok(volume)
}

/// Root mean square; the same bits at any thread count because slabs are added in order.
fn root_mean_square(slab_sums: &[f64], count: usize) -> f64 {
    (slab_sums.iter().sum::<f64>() / count as f64).sqrt()
}

/// Adds noise to `volume` at the given signal-to-noise ratio.
pub(super) fn add_noise(
    volume: &mut Volume<f32>,
    wavelength: f64,
    snr: f64,
    seed: u64,
    progress: &Progress,
) -> Result<(), Cancelled> {
    let [nx, ny, nz] = volume.size();
    let slab = ny * nz;
    let weights = lateral_weights();
    progress.begin("noise", 3 * nx as u64);
    let noise = noise_slabs(volume.size(), wavelength, seed, &weights, progress)?;
    let squares = |values: &[f32]| values.iter().map(|&v| f64::from(v) * f64::from(v)).sum::<f64>();
    let signal_squares: Vec<f64> = volume.samples().par_chunks(slab).map(squares).collect();
    let across = |x: usize| across_slabs(&noise, slab, nx, x, &weights);
    let noise_squares = (0..nx)
        .into_par_iter()
        .map(|x| {
            progress.step(1)?;
            Ok(squares(&across(x)))
        })
        .collect::<Result<Vec<f64>, Cancelled>>()?;
    let count = nx * slab;
    let scale = (root_mean_square(&signal_squares, count) / root_mean_square(&noise_squares, count) / snr) as f32;
    volume.samples_mut().par_chunks_mut(slab).enumerate().try_for_each(|(x, values)| {
        for (value, noise) in values.iter_mut().zip(across(x)) {
            *value += scale * noise;
        }
        progress.step(1)
    })
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

/// White noise, filtered along z and along y, slab by slab.
fn noise_slabs(
    [nx, ny, nz]: [usize; 3],
    wavelength: f64,
    seed: u64,
    weights: &[f32],
    progress: &Progress,
) -> Result<Vec<f32>, Cancelled> {
    let key = key(seed, 4);
    let reach = (REACH * wavelength).ceil() as usize;
    let wavelet: Vec<f32> = (0..=2 * reach).map(|n| ricker((n as f64 - reach as f64) / wavelength) as f32).collect();
    let mut noise = vec![0.0f32; nx * ny * nz];
    noise.par_chunks_mut(ny * nz).enumerate().try_for_each(|(x, slab)| {
        let padded = nz + 2 * reach;
        let mut white = vec![0.0f32; padded];
        let mut banded = vec![0.0f32; ny * nz];
        for (y, trace) in banded.chunks_mut(nz).enumerate() {
            let first = ((x * ny + y) * padded) as u64;
            for (n, value) in white.iter_mut().enumerate() {
                *value = normal_at(key, first + n as u64);
            }
            for (lag, &weight) in wavelet.iter().enumerate() {
                for (value, &raw) in trace.iter_mut().zip(&white[lag..]) {
                    *value += weight * raw;
                }
            }
        }
        for (y, trace) in slab.chunks_mut(nz).enumerate() {
            for (lag, &weight) in weights.iter().enumerate() {
                let from = mirrored(y, lag, weights.len() / 2, ny) * nz;
                for (value, &raw) in trace.iter_mut().zip(&banded[from..from + nz]) {
                    *value += weight * raw;
                }
            }
        }
        progress.step(1)
    })?;
    Ok(noise)
}

/// Slab x of the noise, smoothed across inlines.
fn across_slabs(noise: &[f32], slab: usize, nx: usize, x: usize, weights: &[f32]) -> Vec<f32> {
    let mut sum = vec![0.0f32; slab];
    for (lag, &weight) in weights.iter().enumerate() {
        let from = mirrored(x, lag, weights.len() / 2, nx) * slab;
        for (value, &raw) in sum.iter_mut().zip(&noise[from..from + slab]) {
            *value += weight * raw;
        }
    }
    sum
}

/// Acoustic impedance on a lattice of its own; `voxel_at` gives the seismic voxel of a lattice point and
/// `cell` the height of one of its samples in seismic voxels, over which the blocky truth is averaged.
pub(super) fn impedance(
    truth: &SynthTruth,
    size: [usize; 3],
    cell: f64,
    voxel_at: impl Fn(DVec3) -> DVec3 + Sync,
    progress: &Progress,
) -> Result<Volume<f32>, Cancelled> {
    /// Points averaged in a cell.
    const POINTS: usize = 4;
    let [nx, ny, nz] = size;
    let mut volume = Volume::filled(size, 0.0f32);
    progress.begin("acoustic impedance", nx as u64);
    volume.samples_mut().par_chunks_mut(ny * nz).enumerate().try_for_each(|(x, slab)| {
        for (n, value) in slab.iter_mut().enumerate() {
            let p = voxel_at(DVec3::new(x as f64, (n / nz) as f64, (n % nz) as f64));
            let offset = |point: usize| cell * ((point as f64 + 0.5) / POINTS as f64 - 0.5);
            let sum: f64 = (0..POINTS).map(|point| truth.impedance_at(p + DVec3::Z * offset(point))).sum();
            *value = (sum / POINTS as f64) as f32;
        }
        progress.step(1)
    })?;
    Ok(volume)
}
