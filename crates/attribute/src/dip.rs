//! Dip of the reflections at every sample: how many samples deeper they are on the next inline, and on the
//! next crossline.
//!
//! Three neighbouring traces u₋, u, u₊ are compared along a straight line of slope l through the sample,
//!
//! ```text
//! n(l) = Σ_w u(z+w)·(u₊(z+w+l) + u₋(z+w−l)),   coherence(l) = 2 n(l) / Σ_w (2u² + u₊² + u₋²)
//! ```
//!
//! over a window of samples w and the neighbouring lines; the integer l of greatest coherence wins. On a
//! plane wave of slope p the coherence is 1 at l = p. It is an even function of l − p, because the two
//! neighbours mirror each other, and close to a cosine. The cosine through its values at l−1, l and l+1 gives
//! the fraction (Céspedes and others 1995, on time delays of ultrasound). Unlike the gradients of a structure
//! tensor, correlation over whole samples is not aliased by steep dips, as long as a reflection moves by less
//! than half a wavelength from trace to trace.
//!
//! Products with a missing value (a dead trace, a NaN, or outside the volume) are left out of both sums. A
//! sample that is NaN has a NaN dip. The dip is 0 on a dead trace, and where the amplitude is zero or
//! constant.
//!
//! Dips are in samples per line (voxel space) and positive where reflections deepen with the line's index.

use super::error::{AttributeError, check};
use super::window::WindowSum;
use rayon::prelude::*;
use serde::{Deserialize, Serialize};
use survey::progress::Progress;
use survey::volume::Volume;

/// How the dips of a volume are found.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct DipSettings {
    /// Steepest dip looked for, samples per line (1 to 32). A larger value costs time and lets steep noise
    /// win; it should stay below half a wavelength. Default 4.
    pub max_dip: usize,
    /// Samples of the window above and below (1 to 64): about half a wavelength. A larger window is steadier
    /// and blurs more. Default 6.
    pub half_window: usize,
    /// Lines of the window to either side, perpendicular to the direction of the dip (0 to 4). Default 1.
    pub half_width: usize,
}

impl Default for DipSettings {
    fn default() -> Self {
        Self { max_dip: 4, half_window: 6, half_width: 1 }
    }
}

impl DipSettings {
    /// Lines beyond a box that the dips in it depend on.
    pub fn reach(&self) -> usize {
        self.half_width.max(1)
    }

    pub(super) fn validate(&self) -> Result<(), AttributeError> {
        check("the steepest dip", self.max_dip, 1, 32)?;
        check("the half window", self.half_window, 1, 64)?;
        check("the half width", self.half_width, 0, 4)
    }
}

/// Dips of a volume, on its lattice and with its mask.
#[derive(Debug, Clone, PartialEq)]
pub struct DipVolumes {
    /// Samples by which the reflections are deeper on the next inline.
    pub inline: Volume<f32>,
    /// Samples by which the reflections are deeper on the next crossline.
    pub crossline: Volume<f32>,
}

/// Finds the dips of a volume. Lines are computed in parallel, and the result is the same on any number of
/// threads. Memory: three volumes of float32 beside the input.
///
/// # Errors
/// [`AttributeError::Setting`], [`AttributeError::Cancelled`].
///
/// # Examples
/// Plane reflections that deepen by 1.5 samples per inline:
/// ```
/// use attribute::{DipSettings, dip};
/// use std::f32::consts::TAU;
/// use survey::{progress::Progress, volume::Volume};
///
/// let mut volume = Volume::filled([5, 5, 64], 0.0f32);
/// for x in 0..5 {
///     for y in 0..5 {
///         for (z, sample) in volume.trace_mut(x, y).iter_mut().enumerate() {
///             *sample = (TAU * (z as f32 - 1.5 * x as f32) / 12.0).cos();
///         }
///     }
/// }
/// let dips = dip(&volume, &DipSettings::default(), &Progress::silent())?;
/// assert!((dips.inline.at(2, 2, 32) - 1.5).abs() < 0.02);
/// assert!(dips.crossline.at(2, 2, 32).abs() < 0.02);
/// # Ok::<(), attribute::AttributeError>(())
/// ```
pub fn dip(volume: &Volume<f32>, settings: &DipSettings, progress: &Progress) -> Result<DipVolumes, AttributeError> {
    settings.validate()?;
    let [nx, ny, _] = volume.size();
    progress.begin("dips", (nx + ny) as u64);
    let inline = along_inlines(volume, settings, progress)?;
    let crossline = along_crosslines(volume, settings, progress)?;
    Ok(DipVolumes { inline: like(volume, inline), crossline: like(volume, crossline) })
}

/// Samples on the lattice of another volume, with its mask.
pub(super) fn like(volume: &Volume<f32>, samples: Vec<f32>) -> Volume<f32> {
    // Samples and mask fit: they were made for a volume of this size.
    let mut out = Volume::from_samples(volume.size(), samples).unwrap_or_else(|_| Volume::filled(volume.size(), 0.0));
    let _ = out.set_live(volume.live().map(<[bool]>::to_vec));
    out
}

pub(super) fn along_inlines(
    volume: &Volume<f32>,
    settings: &DipSettings,
    progress: &Progress,
) -> Result<Vec<f32>, AttributeError> {
    let [nx, ny, nz] = volume.size();
    let mut dips = vec![0.0f32; nx * ny * nz];
    if dips.is_empty() {
        return Ok(dips);
    }
    let trace = |y: usize, x: usize| volume.is_live(x, y).then(|| volume.trace(x, y));
    dips.par_chunks_mut(ny * nz).enumerate().try_for_each(|(x, out)| {
        scan_line(settings, [ny, nx], x, trace, out);
        progress.step(1)
    })?;
    Ok(dips)
}

pub(super) fn along_crosslines(
    volume: &Volume<f32>,
    settings: &DipSettings,
    progress: &Progress,
) -> Result<Vec<f32>, AttributeError> {
    let [nx, ny, nz] = volume.size();
    let mut dips = vec![0.0f32; nx * ny * nz];
    if dips.is_empty() {
        return Ok(dips);
    }
    let trace = |x: usize, y: usize| volume.is_live(x, y).then(|| volume.trace(x, y));
    let lines: Vec<Vec<f32>> = (0..ny)
        .into_par_iter()
        .map(|y| {
            let mut out = vec![0.0f32; nx * nz];
            scan_line(settings, [nx, ny], y, trace, &mut out);
            progress.step(1)?;
            Ok::<_, AttributeError>(out)
        })
        .collect::<Result<_, _>>()?;
    dips.par_chunks_mut(ny * nz).enumerate().for_each(|(x, out)| {
        for (y, trace) in out.chunks_mut(nz).enumerate() {
            trace.copy_from_slice(&lines[y][x * nz..(x + 1) * nz]);
        }
    });
    Ok(dips)
}

/// Dips across the line `here` at all of its traces; `trace(along, across)` gives the live ones, of `[along,
/// across]` in all.
fn scan_line<'a>(
    settings: &DipSettings,
    [along_count, across_count]: [usize; 2],
    here: usize,
    trace: impl Fn(usize, usize) -> Option<&'a [f32]>,
    out: &mut [f32],
) {
    let samples = out.len() / along_count;
    let half_width = settings.half_width;
    let mut scan = LagScan::new(settings, samples);
    let mut rows: Vec<WindowSums> = (0..=2 * half_width).map(|_| WindowSums::new(scan.lags * samples)).collect();
    let mut total = WindowSums::new(scan.lags * samples);
    let mut ready = 0;
    for along in 0..along_count {
        let last = (along + half_width).min(along_count - 1);
        while ready <= last {
            let before = here.checked_sub(1).and_then(|across| trace(ready, across));
            let after = (here + 1 < across_count).then(|| trace(ready, here + 1)).flatten();
            scan.compare([before, trace(ready, here), after], &mut rows[ready % (2 * half_width + 1)]);
            ready += 1;
        }
        let Some(centre) = trace(along, here) else { continue };
        total.clear();
        for row in along.saturating_sub(half_width)..=last {
            total.add(&rows[row % (2 * half_width + 1)]);
        }
        scan.pick(&total, centre, &mut out[along * samples..(along + 1) * samples]);
    }
}

/// Sums over the window, `[lag][sample]`.
struct WindowSums {
    /// Σ u (u₊ + u₋), over the pairs that exist.
    product: Vec<f32>,
    /// Σ u² for each of those pairs.
    centre: Vec<f32>,
    /// Σ u₊² + u₋² of those pairs.
    neighbours: Vec<f32>,
}

impl WindowSums {
    fn new(length: usize) -> Self {
        Self { product: vec![0.0; length], centre: vec![0.0; length], neighbours: vec![0.0; length] }
    }

    fn clear(&mut self) {
        for sums in [&mut self.product, &mut self.centre, &mut self.neighbours] {
            sums.fill(0.0);
        }
    }

    fn add(&mut self, other: &Self) {
        let add = |sums: &mut [f32], others: &[f32]| sums.iter_mut().zip(others).for_each(|(a, b)| *a += b);
        add(&mut self.product, &other.product);
        add(&mut self.centre, &other.centre);
        add(&mut self.neighbours, &other.neighbours);
    }
}

/// A trace with room at both ends, and where it has values.
#[derive(Default)]
struct Padded {
    values: Vec<f32>,
    there: Vec<f32>,
}

impl Padded {
    fn take(&mut self, trace: Option<&[f32]>, pad: usize, samples: usize) {
        for part in [&mut self.values, &mut self.there] {
            part.clear();
            part.resize(samples + 2 * pad, 0.0);
        }
        let inside = pad..pad + samples;
        let Some(trace) = trace else { return };
        for ((value, there), &sample) in self.values[inside.clone()].iter_mut().zip(&mut self.there[inside]).zip(trace)
        {
            let is_number = sample.is_finite();
            *value = if is_number { sample } else { 0.0 };
            *there = f32::from(u8::from(is_number));
        }
    }
}

/// Lags a coherence must gain to be preferred to a smaller dip.
const TIE: f32 = 1e-6;

/// The comparison of three traces over all lags.
struct LagScan {
    samples: usize,
    half_window: usize,
    /// Greatest lag of which the coherence is needed: one more than the steepest dip.
    reach: usize,
    lags: usize,
    padded: [Padded; 3],
    terms: [Vec<f32>; 3],
    window: WindowSum,
    best: Vec<f32>,
    best_lag: Vec<i32>,
}

impl LagScan {
    fn new(settings: &DipSettings, samples: usize) -> Self {
        let reach = settings.max_dip + 1;
        let length = samples + 2 * settings.half_window;
        Self {
            samples,
            half_window: settings.half_window,
            reach,
            lags: 2 * reach + 1,
            padded: Default::default(),
            terms: std::array::from_fn(|_| vec![0.0; length]),
            window: WindowSum::default(),
            best: vec![0.0; samples],
            best_lag: vec![0; samples],
        }
    }

    /// Windowed sums of the trace before, here and after, for every lag.
    fn compare(&mut self, traces: [Option<&[f32]>; 3], out: &mut WindowSums) {
        if traces[1].is_none() {
            out.clear();
            return;
        }
        let (reach, pad) = (self.reach, self.reach + self.half_window);
        for (padded, trace) in self.padded.iter_mut().zip(traces) {
            padded.take(trace, pad, self.samples);
        }
        let [before, here, after] = &self.padded;
        let length = self.samples + 2 * self.half_window;
        let (u, m) = (&here.values[reach..reach + length], &here.there[reach..reach + length]);
        for lag in 0..self.lags {
            // The lag is `lag − reach`: the trace after is read that much deeper, the one before that much
            // shallower.
            let (down, up) = (lag, 2 * reach - lag);
            let (p, pm) = (&after.values[down..down + length], &after.there[down..down + length]);
            let (q, qm) = (&before.values[up..up + length], &before.there[up..up + length]);
            let [product, centre, neighbours] = &mut self.terms;
            for i in 0..length {
                product[i] = u[i] * (p[i] + q[i]);
                centre[i] = u[i] * u[i] * (pm[i] + qm[i]);
                neighbours[i] = m[i] * (p[i] * p[i] + q[i] * q[i]);
            }
            let part = lag * self.samples..(lag + 1) * self.samples;
            let width = 2 * self.half_window + 1;
            self.window.sum_into(product, width, &mut out.product[part.clone()]);
            self.window.sum_into(centre, width, &mut out.centre[part.clone()]);
            self.window.sum_into(neighbours, width, &mut out.neighbours[part]);
        }
    }

    /// The dip of greatest coherence at each sample.
    fn pick(&mut self, sums: &WindowSums, centre: &[f32], out: &mut [f32]) {
        let (samples, reach) = (self.samples, self.reach as i32);
        self.best.fill(TIE);
        self.best_lag.fill(0);
        // Small dips first: of equals, the smaller wins.
        for step in 0..reach {
            for lag in [step, -step] {
                let part = ((lag + reach) as usize * samples)..((lag + reach + 1) as usize * samples);
                let terms = sums.product[part.clone()]
                    .iter()
                    .zip(&sums.centre[part.clone()])
                    .zip(&sums.neighbours[part])
                    .zip(self.best.iter_mut().zip(self.best_lag.iter_mut()));
                for (((product, centre), neighbours), (best, best_lag)) in terms {
                    let coherence = 2.0 * product / (centre + neighbours + f32::MIN_POSITIVE);
                    let is_better = coherence > *best + TIE;
                    *best = if is_better { coherence } else { *best };
                    *best_lag = if is_better { lag } else { *best_lag };
                }
            }
        }
        for (z, dip) in out.iter_mut().enumerate() {
            let lag = self.best_lag[z];
            let at = |lag: i32| {
                let n = (lag + reach) as usize * samples + z;
                sums.product[n] / (sums.centre[n] + sums.neighbours[n] + f32::MIN_POSITIVE)
            };
            *dip = if !centre[z].is_finite() {
                f32::NAN
            } else if self.best[z] <= TIE {
                0.0
            } else {
                lag as f32 + fraction([at(lag - 1), at(lag), at(lag + 1)])
            };
        }
    }
}

/// Where a cosine through three equidistant values has its top, from the middle one; within a sample.
fn fraction([before, here, after]: [f32; 3]) -> f32 {
    let slope = after - before;
    if slope == 0.0 || here <= 0.0 {
        return 0.0;
    }
    let cosine = (before + after) / (2.0 * here);
    let offset = if cosine.abs() < 0.9999 {
        let sine = (1.0 - cosine * cosine).sqrt();
        (slope / (2.0 * here * sine)).atan() / cosine.acos()
    } else {
        let curvature = 2.0 * here - before - after;
        if curvature > 0.0 { slope / (2.0 * curvature) } else { 0.0 }
    };
    offset.clamp(-1.0, 1.0)
}
