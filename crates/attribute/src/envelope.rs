//! Envelope: the strength of the reflections, whatever their phase.
//!
//! The analytic signal a = u + iH(u) has the trace as its real part and its Hilbert transform as the
//! imaginary one (Taner, Koehler and Sheriff 1979); its magnitude is the envelope, which is A(z) for
//! A(z)·cos(kz + φ) as long as A varies slowly compared with the cosine. In the frequency domain, a doubles
//! the positive frequencies of u and removes the negative ones. The trace is mirrored beyond both ends (over
//! 64 samples, or its length) before the transform, which treats it as periodic, so that the two ends of the
//! trace do not touch.
//!
//! Samples that are NaN have a NaN envelope; in the transform the trace is mirrored into them from both sides, as beyond
//! its ends. A constant trace c has the envelope |c|.

use super::dip::like;
use super::error::AttributeError;
use rayon::prelude::*;
use rustfft::num_complex::Complex32;
use rustfft::{Fft, FftPlanner};
use std::sync::Arc;
use survey::progress::Progress;
use survey::volume::Volume;

/// Largest number of samples that are mirrored at each end.
const MIRRORED: usize = 64;

/// Computes the envelope of every trace, inlines in parallel. Memory: two volumes of float32 beside the
/// input.
///
/// # Errors
/// [`AttributeError::Cancelled`].
///
/// # Examples
/// The envelope of a cosine is its amplitude:
/// ```
/// use std::f32::consts::TAU;
/// use survey::{progress::Progress, volume::Volume};
///
/// let cosine: Vec<f32> = (0..240).map(|z| 3.0 * (TAU * z as f32 / 12.0).cos()).collect();
/// let volume = Volume::from_samples([1, 1, 240], cosine)?;
/// let strength = attribute::envelope(&volume, &Progress::silent())?;
/// assert!(strength.trace(0, 0)[80..160].iter().all(|a| (a - 3.0).abs() < 0.06));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn envelope(volume: &Volume<f32>, progress: &Progress) -> Result<Volume<f32>, AttributeError> {
    let [nx, ny, nz] = volume.size();
    let mut out = vec![0.0f32; nx * ny * nz];
    progress.begin("envelope", nx as u64);
    if !out.is_empty() {
        let transform = Hilbert::new(nz);
        out.par_chunks_mut(ny * nz).enumerate().try_for_each(|(x, line)| {
            let mut work = transform.work();
            for (y, out) in line.chunks_mut(nz).enumerate().filter(|&(y, _)| volume.is_live(x, y)) {
                transform.envelope(volume.trace(x, y), &mut work, out);
            }
            progress.step(1)
        })?;
    }
    Ok(like(volume, out))
}

/// The transform of traces of one length.
struct Hilbert {
    forward: Arc<dyn Fft<f32>>,
    inverse: Arc<dyn Fft<f32>>,
    length: usize,
}

/// Room for one trace.
struct TraceRoom {
    filled: Vec<f32>,
    signal: Vec<Complex32>,
    scratch: Vec<Complex32>,
}

impl Hilbert {
    fn new(samples: usize) -> Self {
        let pad = samples.min(MIRRORED);
        let length = good_length(samples + 2 * pad);
        let mut planner = FftPlanner::new();
        Self { forward: planner.plan_fft_forward(length), inverse: planner.plan_fft_inverse(length), length }
    }

    fn work(&self) -> TraceRoom {
        let scratch = self.forward.get_inplace_scratch_len().max(self.inverse.get_inplace_scratch_len());
        let filled = Vec::new();
        TraceRoom {
            filled,
            signal: vec![Complex32::default(); self.length],
            scratch: vec![Complex32::default(); scratch],
        }
    }

    fn envelope(&self, trace: &[f32], work: &mut TraceRoom, out: &mut [f32]) {
        let samples = trace.len();
        fill(trace, &mut work.filled);
        let at = |n: usize| work.filled[n];
        // The tail is split between both mirrors, which meet in the middle of it.
        for (n, value) in work.signal.iter_mut().enumerate() {
            let source = if n < samples {
                n
            } else if n < samples + (self.length - samples) / 2 {
                (2 * samples - 1 - n.min(2 * samples - 1)).min(samples - 1)
            } else {
                (self.length - 1 - n).min(samples - 1)
            };
            *value = Complex32::new(at(source), 0.0);
        }
        self.forward.process_with_scratch(&mut work.signal, &mut work.scratch);
        let scale = 1.0 / self.length as f32;
        let half = self.length / 2;
        for (n, value) in work.signal.iter_mut().enumerate() {
            *value *= match n {
                0 => scale,
                n if n == half && self.length.is_multiple_of(2) => scale,
                n if n < half + self.length % 2 => 2.0 * scale,
                _ => 0.0,
            };
        }
        self.inverse.process_with_scratch(&mut work.signal, &mut work.scratch);
        for ((out, value), sample) in out.iter_mut().zip(&work.signal).zip(trace) {
            *out = if sample.is_finite() { value.norm() } else { f32::NAN };
        }
    }
}

/// A trace that is mirrored into its gaps, over [`MIRRORED`] samples at most, and 0 beyond.
fn fill(trace: &[f32], filled: &mut Vec<f32>) {
    filled.clear();
    filled.extend_from_slice(trace);
    let mut from = 0;
    while let Some(start) = (from..trace.len()).find(|&n| !trace[n].is_finite()) {
        let end = (start..trace.len()).find(|&n| trace[n].is_finite()).unwrap_or(trace.len());
        for (n, value) in filled.iter_mut().enumerate().take(end).skip(start) {
            // As far on the other side of the nearer edge of the gap as `n` is on this one.
            let source = match n - start < end - 1 - n && start > 0 || end == trace.len() {
                true => (n - start < MIRRORED).then(|| (2 * start).checked_sub(n + 1)).flatten(),
                false => (end - 1 - n < MIRRORED).then_some(2 * end - 1 - n),
            };
            *value = source.and_then(|source| trace.get(source)).copied().filter(|a| a.is_finite()).unwrap_or(0.0);
        }
        from = end;
    }
}

/// The least length of at least `least` whose only prime factors are 2, 3 and 5.
fn good_length(least: usize) -> usize {
    let is_good = |mut n: usize| {
        for factor in [2, 3, 5] {
            while n.is_multiple_of(factor) {
                n /= factor;
            }
        }
        n == 1
    };
    (least.max(1)..).find(|&n| is_good(n)).unwrap_or(least)
}
