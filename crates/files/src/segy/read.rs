//! Reads a whole volume from a SEG-Y file: traces are decoded in parallel.

use rayon::prelude::*;
use serde::Serialize;

use super::error::{SegyError, SegyProblem};
use super::file::SegyFile;
use super::info::SegyInfo;
use survey::geometry::SurveyGeometry;
use survey::progress::Progress;
use survey::volume::Volume;
use system::huge_pages::zeroed;

/// Inlines that are read together where the file is sorted by crosslines.
const INLINES_TOGETHER: usize = 16;

/// Amplitudes of the live traces.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Amplitudes {
    /// Smallest.
    pub min: f32,
    /// Largest.
    pub max: f32,
    /// Mean.
    pub mean: f64,
    /// Root mean square.
    pub rms: f64,
    /// Samples of live traces.
    pub samples: u64,
    /// Samples that were no numbers in the file: no data.
    pub non_finite: u64,
}

/// A volume that was read.
#[derive(Debug, Clone, PartialEq)]
pub struct SegyVolume {
    /// Its lattice, in ms or m.
    pub geometry: SurveyGeometry,
    /// Its samples; 0 where there is no live trace.
    pub volume: Volume<f32>,
    /// Its amplitudes.
    pub amplitudes: Amplitudes,
    /// What the file holds.
    pub info: SegyInfo,
}

/// Sums over a part of the volume.
#[derive(Debug, Clone, Copy)]
struct SampleSums {
    min: f32,
    max: f32,
    sum: f64,
    sum_sq: f64,
    samples: u64,
    non_finite: u64,
}

impl SampleSums {
    const NONE: Self =
        Self { min: f32::INFINITY, max: f32::NEG_INFINITY, sum: 0.0, sum_sq: 0.0, samples: 0, non_finite: 0 };

    /// Adds in lanes, which the compiler turns into vector instructions; their order is fixed. Runs of 64
    /// samples are summed in `f32`, whose rounding averages out, where their squares are in its range; else
    /// in `f64`.
    fn add_trace(&mut self, trace: &[f32]) {
        if trace.iter().fold(false, |found, value| found | value.is_nan()) {
            let known: Vec<f32> = trace.iter().copied().filter(|value| !value.is_nan()).collect();
            return self.add_numbers(&known);
        }
        self.add_numbers(trace);
    }

    /// The same of samples none of which is missing.
    fn add_numbers(&mut self, trace: &[f32]) {
        const LANES: usize = 8;
        const RUN: usize = 64;
        /// Squares of amplitudes in between neither overflow nor vanish.
        const SAFE: std::ops::Range<f32> = 1e-12..1e15;
        let (mut mins, mut maxs) = ([f32::INFINITY; LANES], [f32::NEG_INFINITY; LANES]);
        let (chunks, rest) = trace.as_chunks::<LANES>();
        for chunk in chunks {
            for lane in 0..LANES {
                // Without the care for NaN of `f32::min`: none are left here.
                mins[lane] = if chunk[lane] < mins[lane] { chunk[lane] } else { mins[lane] };
                maxs[lane] = if chunk[lane] > maxs[lane] { chunk[lane] } else { maxs[lane] };
            }
        }
        let min = mins.into_iter().chain(rest.iter().copied()).fold(f32::INFINITY, f32::min);
        let max = maxs.into_iter().chain(rest.iter().copied()).fold(f32::NEG_INFINITY, f32::max);
        if SAFE.contains(&max.abs().max(min.abs())) {
            for run in trace.chunks(RUN) {
                let (chunks, rest) = run.as_chunks::<LANES>();
                let (mut sums, mut sums_sq) = ([0.0_f32; LANES], [0.0_f32; LANES]);
                for chunk in chunks {
                    for lane in 0..LANES {
                        sums[lane] += chunk[lane];
                        sums_sq[lane] += chunk[lane] * chunk[lane];
                    }
                }
                self.sum += sums.iter().chain(rest).map(|&v| f64::from(v)).sum::<f64>();
                self.sum_sq += sums_sq.iter().map(|&v| f64::from(v)).sum::<f64>();
                self.sum_sq += rest.iter().map(|&v| f64::from(v) * f64::from(v)).sum::<f64>();
            }
        } else {
            self.sum += trace.iter().map(|&v| f64::from(v)).sum::<f64>();
            self.sum_sq += trace.iter().map(|&v| f64::from(v) * f64::from(v)).sum::<f64>();
        }
        self.min = self.min.min(min);
        self.max = self.max.max(max);
        self.samples += trace.len() as u64;
    }

    fn add(self, other: Self) -> Self {
        Self {
            min: self.min.min(other.min),
            max: self.max.max(other.max),
            sum: self.sum + other.sum,
            sum_sq: self.sum_sq + other.sum_sq,
            samples: self.samples + other.samples,
            non_finite: self.non_finite + other.non_finite,
        }
    }

    fn amplitudes(self) -> Amplitudes {
        let count = self.samples.max(1) as f64;
        let range = if self.samples > 0 { [self.min, self.max] } else { [0.0; 2] };
        Amplitudes {
            min: range[0],
            max: range[1],
            mean: self.sum / count,
            rms: (self.sum_sq / count).sqrt(),
            samples: self.samples,
            non_finite: self.non_finite,
        }
    }
}

impl SegyFile {
    /// Decodes inlines `first_inline..` into `out`, `[inline][crossline][sample]`, as many as fit: for
    /// volumes that are read in parts. Returns the amplitudes of that part; the same on any number of
    /// threads.
    ///
    /// # Errors
    /// [`SegyProblem::Cancelled`], and those of [`SegyFile::read_trace`].
    pub(crate) fn read_inlines(
        &self,
        first_inline: usize,
        out: &mut [f32],
        progress: &Progress,
    ) -> Result<Amplitudes, SegyError> {
        let [_, crosslines, samples] = self.size();
        // In a file that is sorted by crosslines, traces of neighbouring inlines lie side by side.
        let together = if self.info().sorted_by == "inline" { 1 } else { INLINES_TOGETHER };
        let sums: Vec<Vec<SampleSums>> = out
            .par_chunks_mut(together * crosslines * samples)
            .enumerate()
            .map_init(Vec::new, |room, (index, inlines)| {
                let sums = self.read_group(first_inline + index * together, inlines, room)?;
                let places = (inlines.len() / samples.max(1)) as u64;
                progress.step(places).map_err(|cancelled| SegyProblem::from(cancelled).in_file(&self.path))?;
                Ok(sums)
            })
            .collect::<Result<_, SegyError>>()?;
        // In order, so that the last bit does not depend on the threads.
        Ok(sums.into_iter().flatten().fold(SampleSums::NONE, SampleSums::add).amplitudes())
    }

    /// Decodes a few inlines; returns the sums of each.
    fn read_group(
        &self,
        first_inline: usize,
        out: &mut [f32],
        room: &mut Vec<u8>,
    ) -> Result<Vec<SampleSums>, SegyError> {
        let [_, crosslines, samples] = self.size();
        let inlines = out.len().div_ceil(crosslines * samples).max(1);
        let mut traces = Vec::with_capacity(out.len() / samples.max(1));
        for (place, out) in out.chunks_mut(samples).enumerate() {
            match self.trace_at(first_inline + place / crosslines, place % crosslines) {
                Some(trace) => traces.push((trace, out)),
                None => out.fill(0.0),
            }
        }
        let mut sums = vec![SampleSums::NONE; inlines];
        // The sums of an inline are those of its traces in the order of crosslines. Where the file has that order,
        // a trace is summed while it is in the processor's cache.
        let is_in_order = inlines == 1 && traces.is_sorted_by_key(|(trace, _)| *trace);
        traces.sort_unstable_by_key(|(trace, _)| *trace);
        let mut non_finite = 0;
        self.read_in_order(&mut traces, room, |trace, bytes, out| {
            non_finite += self.decode(trace, bytes, out) as u64;
            if is_in_order && !self.is_dead(trace) {
                sums[0].add_trace(out);
            }
        })?;
        if !is_in_order {
            for (inline, (sums, out)) in sums.iter_mut().zip(out.chunks(crosslines * samples)).enumerate() {
                for (crossline, trace) in out.chunks(samples).enumerate() {
                    if self.is_live(first_inline + inline, crossline) {
                        sums.add_trace(trace);
                    }
                }
            }
        }
        sums[0].non_finite = non_finite;
        Ok(sums)
    }

    /// Which places hold a live trace, `[inline][crossline]`; none if all do.
    pub fn live(&self) -> Option<Vec<bool>> {
        let [inlines, crosslines, _] = self.size();
        let live: Vec<bool> =
            (0..inlines * crosslines).map(|place| self.is_live(place / crosslines, place % crosslines)).collect();
        live.contains(&false).then_some(live)
    }

    /// Reads the whole volume.
    ///
    /// # Errors
    /// [`SegyProblem::SingleTrace`] for a file of one trace, [`SegyProblem::Cancelled`],
    /// [`SegyProblem::Changed`] for a file that another program writes to, and those of
    /// [`SegyFile::read_trace`].
    pub fn read(&self, progress: &Progress) -> Result<SegyVolume, SegyError> {
        let geometry = self.geometry()?;
        let size = geometry.size();
        progress.begin("reading traces", (size[0] * size[1]) as u64);
        let mut volume = Volume::from_samples(size, zeroed(size.iter().product())).map_err(|mismatch| {
            SegyProblem::SizeMismatch { volume: size, geometry: mismatch.size }.in_file(&self.path)
        })?;
        let amplitudes = self.read_inlines(0, volume.samples_mut(), progress)?;
        self.check_unchanged()?;
        let mut info = self.info().clone();
        if amplitudes.non_finite > 0 {
            let warning = format!("{} samples are not numbers (NaN or infinite): no data", amplitudes.non_finite);
            progress.warn(&warning);
            info.warnings.push(warning.into());
        }
        let live = self.live();
        volume.set_live(live).map_err(|mismatch| {
            SegyProblem::SizeMismatch { volume: size, geometry: mismatch.size }.in_file(&self.path)
        })?;
        Ok(SegyVolume { geometry, volume, amplitudes, info })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sums_are_those_of_double_precision_at_any_scale() {
        for scale in [1e-30_f32, 1e-14, 1.0, 32_000.0, 1e16, 1e30] {
            for count in [1, 7, 8, 63, 64, 65, 500] {
                let trace: Vec<f32> = (0..count).map(|k| scale * ((k * 37 % 101) as f32 / 50.0 - 0.9)).collect();
                let mut sums = SampleSums::NONE;
                sums.add_trace(&trace);
                let exact = |of: fn(f64) -> f64| trace.iter().map(|&v| of(f64::from(v))).sum::<f64>();
                let size = f64::from(scale);
                assert!((sums.sum - exact(|v| v)).abs() < 1e-6 * size * f64::from(count), "{scale} {count}");
                assert!(
                    (sums.sum_sq - exact(|v| v * v)).abs() < 1e-6 * size * size * f64::from(count),
                    "{scale} {count}"
                );
                assert_eq!(sums.min, trace.iter().copied().fold(f32::INFINITY, f32::min));
                assert_eq!(sums.max, trace.iter().copied().fold(f32::NEG_INFINITY, f32::max));
            }
        }
    }
}
