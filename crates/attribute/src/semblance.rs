//! Dip-steered semblance: how similar neighbouring traces are along the reflections. It is 1 on any plane
//! wave and low where a fault or the edge of a channel breaks the reflections.
//!
//! ```text
//! S = Σ_w (Σ_t u_t(z+w))² / Σ_w M Σ_t u_t(z+w)²,      u_t(z) = u(x+i, y+j, z + p·i + q·j)
//! ```
//!
//! over the M live traces t = (i, j) of a square around the sample, and over a window of samples w (Marfurt,
//! Kirlin, Farmer and Bahorich 1998, with the dips p, q of [`super::dip()`] instead of a search). We depart
//! from the paper in that every sample of the window is steered by its own dip: the stack over traces is made
//! once per sample and then summed over the window, at a seventh of the cost.
//!
//! Between samples, traces are interpolated by cubics through four samples. Missing values (a dead trace, a
//! NaN, or outside the volume) are left out of both sums, so that the edge of the survey does not look like a
//! fault. Where there is no amplitude, and on a volume of one trace, the semblance is 1. A sample that is NaN
//! has a NaN semblance, a dead trace has 0.

use super::dip::{DipVolumes, like};
use super::error::{AttributeError, check};
use super::window::WindowSum;
use rayon::prelude::*;
use serde::{Deserialize, Serialize};
use survey::progress::Progress;
use survey::volume::Volume;

/// How the semblance of a volume is computed.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct SemblanceSettings {
    /// Traces to either side along both axes (1 to 8): 1 is a square of 3×3. Default 1.
    pub half_width: usize,
    /// Samples of the window above and below (0 to 64). A smaller window is sharper, a larger one is steadier
    /// at zero crossings. Default 4.
    pub half_window: usize,
}

impl Default for SemblanceSettings {
    fn default() -> Self {
        Self { half_width: 1, half_window: 4 }
    }
}

/// Computes the semblance of a volume along its dips. Inlines are computed in parallel, and the result is the
/// same on any number of threads. Memory: two volumes of float32 beside the input.
///
/// # Errors
/// [`AttributeError::Setting`], [`AttributeError::Lattice`] when the dips belong to another volume,
/// [`AttributeError::Cancelled`].
///
/// # Examples
/// Flat reflections are the same on all traces, so that their semblance is 1:
/// ```
/// use attribute::{DipSettings, SemblanceSettings, dip, semblance};
/// use survey::{progress::Progress, volume::Volume};
///
/// let flat: Vec<f32> = (0..25 * 64).map(|n| ((n % 64) as f32 * 0.5).cos()).collect();
/// let volume = Volume::from_samples([5, 5, 64], flat)?;
/// let progress = Progress::silent();
/// let dips = dip(&volume, &DipSettings::default(), &progress)?;
/// let found = semblance(&volume, &dips, &SemblanceSettings::default(), &progress)?;
/// assert!((found.at(2, 2, 32) - 1.0).abs() < 1e-3);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn semblance(
    volume: &Volume<f32>,
    dips: &DipVolumes,
    settings: &SemblanceSettings,
    progress: &Progress,
) -> Result<Volume<f32>, AttributeError> {
    check("the half width", settings.half_width, 1, 8)?;
    check("the half window", settings.half_window, 0, 64)?;
    for part in [&dips.inline, &dips.crossline] {
        if part.size() != volume.size() {
            return Err(AttributeError::Lattice { expected: volume.size(), found: part.size() });
        }
    }
    let [nx, ny, nz] = volume.size();
    let mut out = vec![0.0f32; nx * ny * nz];
    progress.begin("semblance", nx as u64);
    if !out.is_empty() {
        out.par_chunks_mut(ny * nz).enumerate().try_for_each(|(x, line)| {
            let mut stack = TraceStack::new(nz, settings.half_window);
            for (y, out) in line.chunks_mut(nz).enumerate().filter(|&(y, _)| volume.is_live(x, y)) {
                stack.clear();
                stack.add_around(volume, dips, [x, y], settings.half_width);
                stack.semblance(volume.trace(x, y), out);
            }
            progress.step(1)
        })?;
    }
    Ok(like(volume, out))
}

/// Sums over traces at each sample of one trace, with room for the window at both ends.
pub(super) struct TraceStack {
    half_window: usize,
    sum: Vec<f32>,
    squares: Vec<f32>,
    count: Vec<f32>,
    terms: [Vec<f32>; 2],
    windowed: [Vec<f32>; 2],
    window: WindowSum,
}

impl TraceStack {
    pub(super) fn new(samples: usize, half_window: usize) -> Self {
        let zeros = || vec![0.0f32; samples];
        let padded = || vec![0.0f32; samples + 2 * half_window];
        Self {
            half_window,
            sum: zeros(),
            squares: zeros(),
            count: zeros(),
            terms: [padded(), padded()],
            windowed: [zeros(), zeros()],
            window: WindowSum::default(),
        }
    }

    pub(super) fn clear(&mut self) {
        for part in [&mut self.sum, &mut self.squares, &mut self.count] {
            part.fill(0.0);
        }
    }

    /// Adds the traces of a square, along the reflections through the one in its middle.
    pub(super) fn add_around(
        &mut self,
        volume: &Volume<f32>,
        dips: &DipVolumes,
        [x, y]: [usize; 2],
        half_width: usize,
    ) {
        let [nx, ny, _] = volume.size();
        let (p, q) = (dips.inline.trace(x, y), dips.crossline.trace(x, y));
        let reach = half_width as isize;
        for (i, j) in (-reach..=reach).flat_map(|i| (-reach..=reach).map(move |j| (i, j))) {
            let place = x.checked_add_signed(i).zip(y.checked_add_signed(j));
            let Some((tx, ty)) = place.filter(|&(tx, ty)| tx < nx && ty < ny && volume.is_live(tx, ty)) else {
                continue;
            };
            if (i, j) == (0, 0) {
                self.add_straight(volume.trace(tx, ty));
            } else {
                self.add_steered(volume.trace(tx, ty), p, q, i as f32, j as f32);
            }
        }
    }

    /// The square of the mean of the traces at each sample, or the mean of their squares.
    pub(super) fn terms(&self, squared_mean: bool, out: &mut [f32]) {
        let of = |sum: f32, squares: f32, count: f32| match count {
            0.0 => 0.0,
            count if squared_mean => (sum / count) * (sum / count),
            count => squares / count,
        };
        let terms = self.sum.iter().zip(&self.squares).zip(&self.count);
        out.iter_mut().zip(terms).for_each(|(out, ((&sum, &squares), &count))| *out = of(sum, squares, count));
    }

    fn add_straight(&mut self, trace: &[f32]) {
        for (z, &value) in trace.iter().enumerate() {
            self.add(z, value);
        }
    }

    fn add_steered(&mut self, trace: &[f32], p: &[f32], q: &[f32], i: f32, j: f32) {
        for z in 0..self.sum.len() {
            self.add(z, value_at(trace, z, i * p[z] + j * q[z]));
        }
    }

    fn add(&mut self, z: usize, value: f32) {
        let is_number = value.is_finite();
        let value = if is_number { value } else { 0.0 };
        self.sum[z] += value;
        self.squares[z] += value * value;
        self.count[z] += f32::from(u8::from(is_number));
    }

    fn semblance(&mut self, centre: &[f32], out: &mut [f32]) {
        let (n, width) = (self.half_window, 2 * self.half_window + 1);
        let [above, below] = &mut self.terms;
        for z in 0..self.sum.len() {
            above[z + n] = self.sum[z] * self.sum[z];
            below[z + n] = self.count[z] * self.squares[z];
        }
        for (terms, windowed) in self.terms.iter().zip(&mut self.windowed) {
            self.window.sum_into(terms, width, windowed);
        }
        for (z, out) in out.iter_mut().enumerate() {
            let (above, below) = (self.windowed[0][z], self.windowed[1][z]);
            *out = match below {
                _ if !centre[z].is_finite() => f32::NAN,
                below if below > 0.0 => (above / below).min(1.0),
                _ => 1.0,
            };
        }
    }
}

/// A trace `shift` samples below sample `z`, by the cubic through the four samples around; NaN beyond its
/// ends, and where the dip is.
fn value_at(trace: &[f32], z: usize, shift: f32) -> f32 {
    let whole = shift.floor();
    let t = shift - whole;
    let at = z as isize + whole as isize;
    let last = trace.len() as isize - 1;
    if t.is_nan() || at < 0 || at > last || (at == last && t > 0.0) {
        return f32::NAN;
    }
    let at = at as usize;
    if t == 0.0 {
        return trace[at];
    }
    let (b, c) = (trace[at], trace[at + 1]);
    if at == 0 || at + 2 >= trace.len() {
        return b + t * (c - b);
    }
    let (a, d) = (trace[at - 1], trace[at + 2]);
    let (s, r, u) = (t + 1.0, t - 1.0, t - 2.0);
    // Lagrange's weights for the nodes −1, 0, 1, 2.
    -t * r * u / 6.0 * a + s * r * u / 2.0 * b - s * t * u / 2.0 * c + s * t * r / 6.0 * d
}
