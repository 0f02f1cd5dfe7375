//! Fault likelihood: how much less alike the traces are along a steep plane through a sample than a whole reflection would
//! leave them (Hale 2013), with the strike and the dip of that plane.
//!
//! ```text
//! N = (Σ g / n)²,   D = Σ g² / n           over 3×3 traces, along the slopes of the reflections
//! S = ⟨N⟩ / ⟨D⟩,     f = 1 − S⁸             ⟨ ⟩ along a plane: [`ALONG`] traces along strike, [`DOWN`] samples down dip
//! ```
//!
//! Of the planes of all strikes and dips, the one of the smallest S counts. Dips are measured in metres: from the vertical
//! to 45 degrees, in steps in which a plane moves by at most a tenth of a trace for a sample down. After smoothing down the
//! trace, every third sample holds all there is: the scan works on such rows. Space: voxels; planes in traces across strike
//! for a sample down.

use super::dip::{DipVolumes, like};
use super::error::AttributeError;
use super::semblance::TraceStack;
use super::slopes::{self, gaussian, smoothed};
use rayon::prelude::*;
use std::f32::consts::PI;
use survey::{Progress, SurveyGeometry, Volume};

/// Samples between rows.
pub const ROW: usize = 3;
/// Strikes that are scanned, evenly over half a turn.
const STRIKES: usize = 12;
/// Standard deviation of the plane along strike, traces, and its reach.
const ALONG: (f32, usize) = (4.0, 8);
/// The same down its dip, samples, in taps of [`TAP`] rows.
const DOWN: (f32, usize) = (12.0, 4);
/// Rows between the taps down the dip.
const TAP: usize = 2;
/// Standard deviation of the smoothing down a trace before that, samples, and its reach.
const VERTICAL: (f32, usize) = (3.0, 7);
/// Gentlest dip, degrees.
const GENTLEST_DEG: f64 = 45.0;
/// Greatest step between dips, traces a sample.
const STEP: f32 = 0.1;
/// Flattest plane, traces a sample: beyond it, its taps leave the neighbourhood.
const FLATTEST: f32 = 1.2;

/// A steep plane through a voxel.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Plane {
    /// Along strike, a unit vector of traces.
    pub along: [f32; 2],
    /// Across strike, a quarter turn on.
    pub across: [f32; 2],
    /// Traces across strike for a sample down.
    pub run: f32,
}

/// Likelihood and planes at every [`ROW`]-th sample.
#[derive(Debug, Clone, PartialEq)]
pub struct Likelihood {
    /// Lines and rows.
    pub size: [usize; 3],
    /// f, 0 to 1, `[inline][crossline][row]`.
    pub value: Vec<f32>,
    /// Of each, the number of its plane.
    plane: Vec<u8>,
    /// All planes.
    planes: Vec<Plane>,
}

impl Likelihood {
    /// The plane at a row.
    pub fn plane(&self, n: usize) -> Plane {
        self.planes[usize::from(self.plane[n])]
    }

    /// f beside a trace, between its four neighbours; `None` outside.
    pub fn beside(&self, x: f32, y: f32, row: usize) -> Option<f32> {
        let [nx, ny, rows] = self.size;
        if !(x >= 0.0 && y >= 0.0 && x <= (nx - 1) as f32 && y <= (ny - 1) as f32) {
            return None;
        }
        let (i, j) = ((x as usize).min(nx.saturating_sub(2)), (y as usize).min(ny.saturating_sub(2)));
        let (s, t) = (x - i as f32, y - j as f32);
        let at = |i: usize, j: usize| self.value[(i.min(nx - 1) * ny + j.min(ny - 1)) * rows + row];
        let line = |i: usize| at(i, j) * (1.0 - t) + at(i, j + 1) * t;
        Some(line(i) * (1.0 - s) + line(i + 1) * s)
    }
}

/// A trace beside another, and its weight.
#[derive(Clone, Copy)]
struct Tap {
    by: [isize; 2],
    rows: isize,
    weight: f32,
}

/// Spreads a place between traces over its neighbours.
fn spread(x: f32, y: f32, rows: isize, weight: f32, taps: &mut Vec<Tap>) {
    let (i, j) = (x.floor(), y.floor());
    let (s, t) = (x - i, y - j);
    for (di, wi) in [(0, 1.0 - s), (1, s)] {
        for (dj, wj) in [(0, 1.0 - t), (1, t)] {
            if wi * wj > 1e-4 {
                taps.push(Tap { by: [i as isize + di, j as isize + dj], rows, weight: weight * wi * wj });
            }
        }
    }
}

/// Steps from trace to trace along strike, in whole lines of the axis that it follows more.
fn along_taps(along: [f32; 2]) -> Vec<Tap> {
    let major = along[0].abs().max(along[1].abs());
    let step = [along[0] / major, along[1] / major];
    let mut taps = Vec::new();
    for k in -(ALONG.1 as isize)..=ALONG.1 as isize {
        let distance = k as f32 / major;
        if distance.abs() <= ALONG.1 as f32 {
            let weight = (-0.5 * (distance / ALONG.0).powi(2)).exp();
            spread(k as f32 * step[0], k as f32 * step[1], 0, weight, &mut taps);
        }
    }
    taps
}

fn down_taps(plane: &Plane) -> Vec<Tap> {
    let mut taps = Vec::new();
    for m in -(DOWN.1 as isize)..=DOWN.1 as isize {
        let rows = m * TAP as isize;
        let samples = rows as f32 * ROW as f32;
        let (weight, off) = ((-0.5 * (samples / DOWN.0).powi(2)).exp(), plane.run * samples);
        spread(off * plane.across[0], off * plane.across[1], rows, weight, &mut taps);
    }
    taps
}

/// The planes of a strike.
fn planes_of(strike: usize, geometry: &SurveyGeometry) -> Vec<Plane> {
    let angle = PI * strike as f32 / STRIKES as f32;
    let (along, across) = ([angle.cos(), angle.sin()], [-angle.sin(), angle.cos()]);
    let metric = geometry.metric_from_voxel();
    let trace_m = (metric.x_axis * f64::from(across[0]) + metric.y_axis * f64::from(across[1])).length();
    let flattest = (geometry.sample_m() / GENTLEST_DEG.to_radians().tan() / trace_m.max(1e-9)) as f32;
    let flattest = flattest.min(FLATTEST);
    let steps = (flattest / STEP).ceil().max(2.0) as i32;
    (-steps..=steps).map(|n| Plane { along, across, run: flattest * n as f32 / steps as f32 }).collect()
}

/// Traces that the flattest plane crosses in some samples.
pub fn crossed(geometry: &SurveyGeometry, samples: usize) -> usize {
    let run = (0..STRIKES).flat_map(|strike| planes_of(strike, geometry)).map(|plane| plane.run).fold(0.0, f32::max);
    (run * samples as f32).ceil() as usize
}

/// Lines beyond a box that the likelihood in it depends on, the slopes included.
pub fn reach(geometry: &SurveyGeometry) -> usize {
    slopes::REACH + 1 + ALONG.1 + 1 + crossed(geometry, DOWN.1 * TAP * ROW) + 1
}

/// The fault likelihood of a volume at every sample, 0 to 1, along its own slopes; see [`likelihood`]. NaN where the sample
/// is missing.
///
/// # Errors
/// [`AttributeError::Cancelled`].
///
/// # Examples
/// Beds that are offset by five samples between inlines 15 and 16:
/// ```
/// use attribute::fault_likelihood;
/// use survey::{Progress, SurveyGeometry, VerticalUnit, Volume};
///
/// let geometry = SurveyGeometry::regular([32, 32, 64], 25.0, 10.0, VerticalUnit::Metres);
/// let mut volume = Volume::filled([32, 32, 64], 0.0f32);
/// for (n, sample) in volume.samples_mut().iter_mut().enumerate() {
///     let (x, z) = (n / 64 / 32, (n % 64) as f32);
///     let depth = if x < 16 { z } else { z - 5.0 };
///     *sample = (0.7 * depth).sin() + (0.43 * depth).cos();
/// }
/// let found = fault_likelihood(&volume, &geometry, &Progress::silent())?;
/// assert!(found.at(15, 16, 32) > 0.9 && found.at(3, 16, 32) < 0.1);
/// # Ok::<(), attribute::AttributeError>(())
/// ```
pub fn fault_likelihood(
    volume: &Volume<f32>,
    geometry: &SurveyGeometry,
    progress: &Progress,
) -> Result<Volume<f32>, AttributeError> {
    let slopes = slopes::slopes(volume, progress)?;
    let found = likelihood(volume, &slopes, geometry, progress)?;
    drop(slopes);
    let [_, _, nz] = volume.size();
    let rows = found.size[2];
    let mut samples = vec![0.0f32; volume.samples().len()];
    if nz > 0 {
        let traces = volume.samples().par_chunks(nz);
        samples.par_chunks_mut(nz).zip(found.value.par_chunks(rows)).zip(traces).for_each(|((out, rows), trace)| {
            for (z, (out, sample)) in out.iter_mut().zip(trace).enumerate() {
                if !sample.is_finite() {
                    *out = f32::NAN;
                    continue;
                }
                let (row, t) = (z / ROW, (z % ROW) as f32 / ROW as f32);
                let next = rows[(row + 1).min(rows.len() - 1)];
                *out = rows[row] + t * (next - rows[row]);
            }
        });
    }
    Ok(like(volume, samples))
}

/// Scans a volume for faults along its slopes. Lines are computed in parallel; the result is the same on any number of
/// threads. Memory: 9 bytes a voxel beside the volume and its slopes.
///
/// # Errors
/// [`AttributeError::Lattice`] when the slopes belong to another volume, [`AttributeError::Cancelled`].
pub fn likelihood(
    volume: &Volume<f32>,
    slopes: &DipVolumes,
    geometry: &SurveyGeometry,
    progress: &Progress,
) -> Result<Likelihood, AttributeError> {
    for part in [&slopes.inline, &slopes.crossline] {
        if part.size() != volume.size() {
            return Err(AttributeError::Lattice { expected: volume.size(), found: part.size() });
        }
    }
    let [nx, ny, nz] = volume.size();
    let rows = nz.div_ceil(ROW);
    progress.begin("fault likelihood", (nx * (1 + 2 * STRIKES)) as u64);
    let pairs = coherences(volume, slopes, progress)?;
    let mut least = vec![f32::INFINITY; nx * ny * rows];
    let mut plane = vec![0u8; nx * ny * rows];
    let mut planes = Vec::new();
    let width = 2 * rows;
    let mut smooth = vec![0.0f32; nx * ny * width];
    for strike in 0..STRIKES {
        let of_strike = planes_of(strike, geometry);
        let taps = along_taps(of_strike[0].along);
        smooth.par_chunks_mut(ny * width).enumerate().try_for_each(|(x, line)| {
            line.fill(0.0);
            for (y, out) in line.chunks_mut(width).enumerate() {
                sum(&pairs, [nx, ny, rows], [x, y], &taps, out);
            }
            progress.step(1)
        })?;
        let first = planes.len();
        let dips: Vec<Vec<Tap>> = of_strike.iter().map(down_taps).collect();
        least.par_chunks_mut(ny * rows).zip(plane.par_chunks_mut(ny * rows)).enumerate().try_for_each(
            |(x, (least, plane))| {
                let mut out = vec![0.0f32; width];
                for (y, (least, plane)) in least.chunks_mut(rows).zip(plane.chunks_mut(rows)).enumerate() {
                    for (n, taps) in dips.iter().enumerate() {
                        out.fill(0.0);
                        sum(&smooth, [nx, ny, rows], [x, y], taps, &mut out);
                        let (above, below) = out.split_at(rows);
                        let number = (first + n) as u8;
                        for ((least, plane), (above, below)) in
                            least.iter_mut().zip(plane.iter_mut()).zip(above.iter().zip(below))
                        {
                            let ratio = if *below > f32::MIN_POSITIVE { above / below } else { 1.0 };
                            let is_less = ratio < *least;
                            *least = if is_less { ratio } else { *least };
                            *plane = if is_less { number } else { *plane };
                        }
                    }
                }
                progress.step(1)
            },
        )?;
        planes.extend(of_strike);
    }
    least.par_iter_mut().for_each(|least| *least = 1.0 - least.clamp(0.0, 1.0).powi(8));
    Ok(Likelihood { size: [nx, ny, rows], value: least, plane, planes })
}

/// N and D at each row, smoothed down the trace, one after the other for each trace.
fn coherences(volume: &Volume<f32>, slopes: &DipVolumes, progress: &Progress) -> Result<Vec<f32>, AttributeError> {
    let [nx, ny, nz] = volume.size();
    let rows = nz.div_ceil(ROW);
    let down = gaussian(VERTICAL);
    let mut pairs = vec![0.0f32; nx * ny * 2 * rows];
    pairs.par_chunks_mut(ny * 2 * rows).enumerate().try_for_each(|(x, line)| {
        let mut stack = TraceStack::new(nz, 0);
        let (mut terms, mut smooth) = (vec![0.0f32; nz], vec![0.0f32; nz]);
        for (y, out) in line.chunks_mut(2 * rows).enumerate().filter(|&(y, _)| volume.is_live(x, y)) {
            stack.clear();
            stack.add_around(volume, slopes, [x, y], 1);
            for (squared, out) in [true, false].into_iter().zip(out.chunks_mut(rows)) {
                stack.terms(squared, &mut terms);
                smooth.fill(0.0);
                smoothed(&terms, &down, &mut smooth);
                out.iter_mut().zip(smooth.iter().step_by(ROW)).for_each(|(out, value)| *out = *value);
            }
        }
        progress.step(1)
    })?;
    Ok(pairs)
}

/// Adds what lies under the taps around a trace.
fn sum(pairs: &[f32], [nx, ny, rows]: [usize; 3], [x, y]: [usize; 2], taps: &[Tap], out: &mut [f32]) {
    for tap in taps {
        let place = x.checked_add_signed(tap.by[0]).zip(y.checked_add_signed(tap.by[1]));
        let Some((tx, ty)) = place.filter(|&(tx, ty)| tx < nx && ty < ny) else { continue };
        let from = &pairs[(tx * ny + ty) * 2 * rows..(tx * ny + ty + 1) * 2 * rows];
        let skip = tap.rows.unsigned_abs();
        if skip >= rows {
            continue;
        }
        for (out, from) in out.chunks_mut(rows).zip(from.chunks(rows)) {
            let (out, from) = if tap.rows < 0 { (&mut out[skip..], from) } else { (out, &from[skip..]) };
            out.iter_mut().zip(from).for_each(|(out, from)| *out += tap.weight * from);
        }
    }
}
