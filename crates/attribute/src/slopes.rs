//! Slopes of the reflections, by least squares over a neighbourhood: how many samples deeper they are on the next inline,
//! and on the next crossline.
//!
//! ```text
//! p₀ = −⟨g_x g_z⟩ / ⟨g_z²⟩,      p ← p − ⟨δ g_z⟩ / ⟨g_z²⟩,      δ = ½ [g(x+1, z+p) − g(x−1, z−p)]
//! ```
//!
//! with ⟨ ⟩ a Gaussian over [`TRACES`] and [`SAMPLES`], and g_z the mean along the slope. The first is the structure
//! tensor's; the other, in [`ROUNDS`], compares neighbours along the present slope, so that steep reflections, which
//! gradients alias, are followed. Unlike
//! [`super::dip()`], which is sharper, these slopes run smoothly past a fault instead of climbing it: what measures faults
//! needs them. Differences with a missing value are left out of both sums. Space: samples a line.

use super::dip::{DipVolumes, like};
use super::error::AttributeError;
use rayon::prelude::*;
use survey::{Progress, Volume};

/// Standard deviation of the neighbourhood along lines, traces, and its reach.
const TRACES: (f32, usize) = (1.5, 3);
/// The same in depth, samples.
const SAMPLES: (f32, usize) = (4.0, 9);
/// Rounds of refinement.
const ROUNDS: usize = 4;
/// Steepest slope, samples a line.
const STEEPEST: f32 = 6.0;
/// Lines that are computed together.
const BLOCK: usize = 16;
/// Lines beyond a box that the slopes in it depend on.
pub(super) const REACH: usize = (TRACES.1 + 1) * (ROUNDS + 1);

/// Finds the slopes of a volume. Lines are computed in parallel; the result is the same on any number of threads. Memory:
/// two volumes of float32 beside the input, and some lines.
///
/// # Errors
/// [`AttributeError::Cancelled`].
pub fn slopes(volume: &Volume<f32>, progress: &Progress) -> Result<DipVolumes, AttributeError> {
    let [nx, _, _] = volume.size();
    progress.begin("slopes", (2 * (ROUNDS + 1) * nx.div_ceil(BLOCK)) as u64);
    let inline = one_way(volume, true, progress)?;
    let crossline = one_way(volume, false, progress)?;
    Ok(DipVolumes { inline: like(volume, inline), crossline: like(volume, crossline) })
}

/// Slopes along one axis.
fn one_way(volume: &Volume<f32>, along_inlines: bool, progress: &Progress) -> Result<Vec<f32>, AttributeError> {
    let [nx, ny, nz] = volume.size();
    let mut found = vec![0.0f32; nx * ny * nz];
    if nx < 2 && along_inlines || ny < 2 && !along_inlines || nz < 4 {
        return Ok(found);
    }
    for _ in 0..=ROUNDS {
        let pairs = |x: usize, y: usize, out: &mut [f32]| {
            let place = |by: isize| {
                let (x, y) = match along_inlines {
                    true => (x.checked_add_signed(by), Some(y)),
                    false => (Some(x), y.checked_add_signed(by)),
                };
                let (x, y) = x.zip(y).filter(|&(x, y)| x < nx && y < ny && volume.is_live(x, y))?;
                Some(volume.trace(x, y))
            };
            let here = volume.trace(x, y);
            let sides = [(place(-1), -1.0f32), (place(1), 1.0)];
            let slope = &found[(x * ny + y) * nz..(x * ny + y + 1) * nz];
            let (num, den) = out.split_at_mut(nz);
            let known = sides.iter().filter(|(trace, _)| trace.is_some()).count() as f32;
            for z in 1..nz - 1 {
                // How it changes across, per line, and down, both along the present slope.
                let mut across = 0.0;
                let mut down = here[z + 1] - here[z - 1];
                for (trace, sign) in sides {
                    let Some(trace) = trace else { continue };
                    let [value, step] = cubic(trace, z as f32 + sign * slope[z]);
                    across += sign * (value - here[z]);
                    down += step;
                }
                let down = down / (2.0 + known);
                let product = across / known.max(1.0) * down;
                if product.is_finite() {
                    num[z] = product;
                    den[z] = down * down;
                }
            }
        };
        let change = fitted([nx, ny, nz], &pairs, progress)?;
        let steepest = |slope: f32| slope.clamp(-STEEPEST, STEEPEST);
        found.par_iter_mut().zip(change).for_each(|(slope, change)| *slope = steepest(*slope - change));
    }
    Ok(found)
}

/// A trace of at least four samples at a fractional one, and its change in a sample there, by the cubic through the four
/// around; the end beyond its ends.
#[inline]
fn cubic(trace: &[f32], at: f32) -> [f32; 2] {
    let at = at.clamp(0.0, (trace.len() - 1) as f32);
    let n = (at as usize).clamp(1, trace.len() - 3);
    let t = at - n as f32;
    let Some(&[a, b, c, d]) = trace[n - 1..].first_chunk() else { return [0.0; 2] };
    // Its terms about b, from Lagrange's weights for the nodes −1, 0, 1, 2.
    let first = -a / 3.0 - 0.5 * b + c - d / 6.0;
    let second = 0.5 * (a + c) - b;
    let third = (d - a) / 6.0 + 0.5 * (b - c);
    [b + t * (first + t * (second + t * third)), first + t * (2.0 * second + 3.0 * t * third)]
}

/// Weights of a Gaussian from its middle outwards.
pub(super) fn gaussian((sigma, reach): (f32, usize)) -> Vec<f32> {
    (0..=reach).map(|n| (-0.5 * (n as f32 / sigma).powi(2)).exp()).collect()
}

/// `out[z] += Σ w(|k|) values[z + k]`, without what lies beyond the ends.
pub(super) fn smoothed(values: &[f32], weights: &[f32], out: &mut [f32]) {
    let count = values.len();
    for (k, &weight) in weights.iter().enumerate().take(count) {
        out[k..].iter_mut().zip(values).for_each(|(out, value)| *out += weight * value);
        if k > 0 {
            out[..count - k].iter_mut().zip(&values[k..]).for_each(|(out, value)| *out += weight * value);
        }
    }
}

/// ⟨a⟩ / ⟨b⟩ at every voxel, where `pairs` writes a and b of a trace, one after the other.
fn fitted(
    [nx, ny, nz]: [usize; 3],
    pairs: &(dyn Fn(usize, usize, &mut [f32]) + Sync),
    progress: &Progress,
) -> Result<Vec<f32>, AttributeError> {
    let (lateral, down) = (gaussian(TRACES), gaussian(SAMPLES));
    let reach = TRACES.1;
    let mut all = vec![0.0f32; nx * ny * nz];
    all.par_chunks_mut(BLOCK * ny * nz).enumerate().try_for_each(|(block, out)| {
        let first = block * BLOCK;
        let lines = first.saturating_sub(reach)..(first + BLOCK + reach).min(nx);
        let width = 2 * nz;
        let mut smooth = vec![0.0f32; lines.len() * ny * width];
        let mut raw = vec![0.0f32; ny * width];
        let mut pair = vec![0.0f32; width];
        for (x, smooth) in lines.clone().zip(smooth.chunks_mut(ny * width)) {
            raw.fill(0.0);
            for (y, raw) in raw.chunks_mut(width).enumerate() {
                pair.fill(0.0);
                pairs(x, y, &mut pair);
                for (pair, raw) in pair.chunks(nz).zip(raw.chunks_mut(nz)) {
                    smoothed(pair, &down, raw);
                }
            }
            for (y, smooth) in smooth.chunks_mut(width).enumerate() {
                for other in y.saturating_sub(reach)..(y + reach + 1).min(ny) {
                    let weight = lateral[other.abs_diff(y)];
                    smooth.iter_mut().zip(&raw[other * width..]).for_each(|(sum, value)| *sum += weight * value);
                }
            }
        }
        for (line, out) in out.chunks_mut(ny * nz).enumerate() {
            let x = first + line;
            for (y, out) in out.chunks_mut(nz).enumerate() {
                pair.fill(0.0);
                for other in x.saturating_sub(reach)..(x + reach + 1).min(nx) {
                    let weight = lateral[other.abs_diff(x)];
                    let row = ((other - lines.start) * ny + y) * width;
                    pair.iter_mut().zip(&smooth[row..]).for_each(|(sum, value)| *sum += weight * value);
                }
                for (z, out) in out.iter_mut().enumerate() {
                    let (num, den) = (pair[z], pair[nz + z]);
                    *out = if den > f32::MIN_POSITIVE { num / den } else { 0.0 };
                }
            }
        }
        progress.step(1)
    })?;
    Ok(all)
}
