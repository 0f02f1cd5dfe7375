//! Extrema of every trace, refined between samples (P-horiz 4).
//!
//! A peak is a positive sample greater than both neighbours, a trough a negative one smaller than both, a
//! zero crossing the change from negative above to positive below. A plateau (common in 8-bit data) counts
//! once, at its middle. The position between samples is the analytic maximum (or zero) of a polynomial
//! through the nearest samples: see [`refine`]. A sample that is not finite is no extremum and no neighbour
//! of one; a dead trace has no extrema.
//!
//! Growing uses nothing of a volume but its extrema, about one in six samples. A volume that does not fit
//! into memory is therefore read once, slab by slab ([`SlabSource`]). Space: voxels. Memory: 8 bytes an
//! extremum, 4 a trace.

pub mod refine;

use crate::surfaces::Extremum;
use rayon::prelude::*;
use std::ops::Range;
use survey::Progress;
use survey::source::SlabSource;

/// The extrema of one kind, trace by trace in the order (x, y), from the top down.
#[derive(Debug, Clone, PartialEq)]
pub struct Extrema {
    /// `[inlines, crosslines, samples]` of the volume.
    pub size: [usize; 3],
    /// The kind of extremum.
    pub kind: Extremum,
    /// Index of the first extremum of each trace `[x·crosslines + y]`, and the total count as the last entry.
    pub offsets: Vec<u32>,
    /// Fractional sample index.
    pub z: Vec<f32>,
    /// Height of an extremum (positive for troughs too), or slope of a zero crossing, amplitude per sample.
    pub amplitude: Vec<f32>,
}

impl Extrema {
    /// Count of extrema.
    pub fn len(&self) -> usize {
        self.offsets.last().map_or(0, |&count| count as usize)
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Indices of the extrema on the trace at (x, y).
    #[inline]
    pub fn on_trace(&self, x: usize, y: usize) -> Range<usize> {
        let trace = x * self.size[1] + y;
        self.offsets[trace] as usize..self.offsets[trace + 1] as usize
    }

    /// Indices of the extrema on inline index x.
    #[inline]
    pub fn on_inline(&self, x: usize) -> Range<usize> {
        let ny = self.size[1];
        self.offsets[x * ny] as usize..self.offsets[(x + 1) * ny] as usize
    }

    /// Splits `values`, one per extremum, into one part per inline, to be written in parallel.
    pub(crate) fn split_inlines<'v, T>(&self, values: &'v mut [T]) -> Vec<&'v mut [T]> {
        let mut parts = Vec::with_capacity(self.size[0]);
        let mut rest = values;
        for x in 0..self.size[0] {
            let (part, after) = rest.split_at_mut(self.on_inline(x).len());
            parts.push(part);
            rest = after;
        }
        parts
    }
}

/// Why extrema could not be found.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum ExtremaError<E> {
    /// The source could not be read.
    #[error("the volume could not be read")]
    Source(#[source] E),
    /// The user cancelled.
    #[error(transparent)]
    Cancelled(#[from] survey::Cancelled),
    /// There are more extrema than 32-bit indices can number.
    #[error("{found} extrema of one kind are more than the {} that can be numbered; extract a part of the volume", u32::MAX - 1)]
    TooMany {
        /// Count of extrema found.
        found: usize,
    },
}

/// The extrema of one kind in one slab, and their count on each trace.
#[derive(Default)]
struct SlabExtrema {
    counts: Vec<u32>,
    z: Vec<f32>,
    amplitude: Vec<f32>,
}

/// Finds the extrema of each kind in `kinds`; the result has one entry per kind, in the same order.
/// `slab_inlines` inlines are read at a time. The result depends neither on that nor on the number of
/// threads. Cost: one pass over the samples.
///
/// # Errors
/// [`ExtremaError`] when the source fails, the user cancels, or there are 2³² − 1 or more extrema of a kind.
///
/// # Examples
///
/// ```
/// use candidates::extrema::find_extrema;
/// use candidates::Extremum;
/// use survey::{Progress, Volume};
///
/// // One trace, a parabola with its maximum at sample 3.25.
/// let trace = (0..8).map(|z| 10.0 - (z as f32 - 3.25).powi(2)).collect();
/// let volume = Volume::from_samples([1, 1, 8], trace)?;
/// let peaks = &find_extrema(&volume, &[Extremum::Peak], 16, &Progress::silent())?[0];
/// assert_eq!(peaks.on_trace(0, 0), 0..1);
/// assert!((peaks.z[0] - 3.25).abs() < 1e-4 && (peaks.amplitude[0] - 10.0).abs() < 1e-4);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn find_extrema<S: SlabSource>(
    source: &S,
    kinds: &[Extremum],
    slab_inlines: usize,
    progress: &Progress,
) -> Result<Vec<Extrema>, ExtremaError<S::Error>> {
    let size = source.size();
    let [nx, ny, _] = size;
    let slab_inlines = slab_inlines.max(1);
    progress.begin("extrema", nx as u64);
    let slabs: Vec<Vec<SlabExtrema>> = (0..nx.div_ceil(slab_inlines))
        .into_par_iter()
        .map(|slab| {
            let inlines = slab * slab_inlines..((slab + 1) * slab_inlines).min(nx);
            let mut found: Vec<SlabExtrema> = kinds.iter().map(|_| SlabExtrema::default()).collect();
            for part in &mut found {
                part.counts = vec![0; inlines.len() * ny];
            }
            let first = inlines.start;
            let read = source.read(inlines.clone(), &mut |x, y, trace| {
                for (kind, part) in kinds.iter().zip(&mut found) {
                    let before = part.z.len();
                    extrema_of_trace(trace, *kind, &mut |z, amplitude| {
                        part.z.push(z);
                        part.amplitude.push(amplitude);
                    });
                    part.counts[(x - first) * ny + y] = (part.z.len() - before) as u32;
                }
            });
            read.map_err(ExtremaError::Source)?;
            progress.step(inlines.len() as u64)?;
            Ok(found)
        })
        .collect::<Result<_, ExtremaError<S::Error>>>()?;
    let mut slabs: Vec<_> = slabs.into_iter().map(Vec::into_iter).collect();
    kinds
        .iter()
        .map(|&kind| {
            let parts = slabs.iter_mut().map(|slab| slab.next().expect("a slab has a part for each kind"));
            let parts: Vec<SlabExtrema> = parts.collect();
            let found = parts.iter().map(|part| part.z.len()).sum::<usize>();
            if found >= u32::MAX as usize {
                return Err(ExtremaError::TooMany { found });
            }
            let mut extrema = Extrema {
                size,
                kind,
                offsets: Vec::with_capacity(nx * ny + 1),
                z: Vec::with_capacity(found),
                amplitude: Vec::with_capacity(found),
            };
            extrema.offsets.push(0);
            let mut reached = 0;
            for part in parts {
                for count in part.counts {
                    reached += count;
                    extrema.offsets.push(reached);
                }
                extrema.z.extend(part.z);
                extrema.amplitude.extend(part.amplitude);
            }
            Ok(extrema)
        })
        .collect()
}

/// Calls `found(z, amplitude)` for each extremum of a trace, from the top down. z is a fractional sample
/// index.
pub fn extrema_of_trace(trace: &[f32], kind: Extremum, found: &mut impl FnMut(f32, f32)) {
    match kind {
        Extremum::Peak => maxima(trace, 1.0, found),
        Extremum::Trough => maxima(trace, -1.0, found),
        Extremum::Zero => crossings(trace, found),
    }
}

/// Positive maxima of `sign`·trace.
fn maxima(trace: &[f32], sign: f32, found: &mut impl FnMut(f32, f32)) {
    let count = trace.len();
    let mut z = 1;
    while z + 1 < count {
        let [before, here, after] = [trace[z - 1] * sign, trace[z] * sign, trace[z + 1] * sign];
        if !(here > 0.0 && here > before && here >= after) {
            z += 1;
            continue;
        }
        if here > after {
            if here.is_finite() && before.is_finite() && after.is_finite() {
                let (t, height) = refine::maximum(trace, z, sign);
                found(z as f32 + t, height);
            }
            z += 2;
            continue;
        }
        // A plateau is a maximum if the trace falls after its end.
        let mut end = z + 1;
        while end + 1 < count && trace[end + 1] * sign == here {
            end += 1;
        }
        if end + 1 < count && trace[end + 1] * sign < here && here.is_finite() && before.is_finite() {
            // Two equal samples have their maximum between them, higher than both; a longer plateau was
            // clipped.
            let (t, height) = if end == z + 1 {
                (0.5, refine::maximum(trace, z, sign).1)
            } else {
                (refine::clipped(trace, z, end, sign), here)
            };
            found(z as f32 + t, height);
        }
        z = end + 1;
    }
}

/// Zero crossings from negative to positive.
fn crossings(trace: &[f32], found: &mut impl FnMut(f32, f32)) {
    let count = trace.len();
    let mut z = 0;
    while z + 1 < count {
        if !(trace[z] < 0.0 && trace[z + 1] >= 0.0 && trace[z].is_finite() && trace[z + 1].is_finite()) {
            z += 1;
            continue;
        }
        let mut end = z + 1;
        while end < count && trace[end] == 0.0 {
            end += 1;
        }
        if end < count && trace[end] > 0.0 && trace[end].is_finite() {
            if end == z + 1 {
                let (t, slope) = refine::crossing(trace, z);
                found(z as f32 + t, slope);
            } else {
                let rise = f64::from(trace[end]) - f64::from(trace[z]);
                found(0.5 * (z + end) as f32, (rise / (end - z) as f64) as f32);
            }
        }
        z = end;
    }
}

#[cfg(test)]
mod tests;
