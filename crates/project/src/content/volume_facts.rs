//! The facts that a project keeps about a stored volume, found by reading as little of it as necessary.

use crate::content;
use crate::document::{Id, Origin, Polarity, VolumeEntry};
use crate::error::ProjectError;
use rayon::prelude::*;
use std::path::Path;
use store::{BRICK, StoredVolume};
use survey::{Progress, SurveyGeometry};

/// Share of the samples that lie within the range of colours.
const SHOWN_SHARE: f32 = 0.99;

/// Number of samples that gives a percentile to three digits; more would only take longer.
const SAMPLES_ENOUGH: usize = 1 << 20;

/// Number of bricks that gives about the same where each of them costs a request.
const BRICKS_ENOUGH: usize = 16;

/// The facts of a new volume that do not come from its samples.
pub(crate) struct Facts {
    pub(crate) name: String,
    /// Relative to the project's folder.
    pub(crate) file: String,
    pub(crate) polarity: Polarity,
    pub(crate) origin: Origin,
    /// Its own lattice, if it differs from the project's.
    pub(crate) geometry: Option<SurveyGeometry>,
}

/// The entry of the volume stored at `path`.
pub(crate) fn entry(path: &Path, facts: Facts, progress: &Progress) -> Result<VolumeEntry, ProjectError> {
    let stored = StoredVolume::open(path)?;
    let (_, ranges) = stored.brick_ranges(0)?;
    let lowest = ranges.iter().map(|range| range[0]).filter(|low| !low.is_nan()).fold(f32::INFINITY, f32::min);
    Ok(VolumeEntry {
        id: Id::default(),
        hash: content::hash_stored(&stored)?,
        clip: clip_of(&stored, progress)?,
        lowest: if lowest.is_finite() { lowest } else { 0.0 },
        name: facts.name,
        file: facts.file,
        polarity: facts.polarity,
        quantity: stored.info().quantity.clone(),
        origin: facts.origin,
        geometry: facts.geometry,
    })
}

/// The value that most samples of live traces do not exceed in magnitude, estimated on evenly spread traces; 1 where
/// all are zero; of a volume in object storage, on a few bricks.
fn clip_of(stored: &StoredVolume, progress: &Progress) -> Result<f32, ProjectError> {
    let values =
        if stored.is_linked() { values_of_bricks(stored, progress)? } else { values_of_traces(stored, progress)? };
    Ok(ttf::symmetric_clip(&values, SHOWN_SHARE).unwrap_or(1.0))
}

/// The values of evenly spread bricks: an eighth of them, at most [`BRICKS_ENOUGH`]. Coarser levels do not have the same
/// amplitudes: they are smooth.
fn values_of_bricks(stored: &StoredVolume, progress: &Progress) -> Result<Vec<f32>, ProjectError> {
    let size = stored.size(0);
    let [nx, ny, nz] = size.map(|count| count.div_ceil(BRICK));
    let count = nx * ny * nz;
    let wanted = (count / 8).clamp(count.min(4), BRICKS_ENOUGH);
    let read = |n: usize| -> Result<Vec<f32>, ProjectError> {
        progress.check()?;
        let brick = (2 * n + 1) * count / (2 * wanted);
        let start = [brick / (ny * nz), brick / nz % ny, brick % nz].map(|place| place * BRICK);
        let part = std::array::from_fn(|axis| BRICK.min(size[axis] - start[axis]));
        let samples = stored.read_box_f32(0, start, part)?.into_samples();
        Ok(samples.into_iter().filter(|value| value.is_finite()).collect())
    };
    Ok((0..wanted).into_par_iter().map(read).collect::<Result<Vec<_>, _>>()?.concat())
}

/// The values of evenly spread live traces.
fn values_of_traces(stored: &StoredVolume, progress: &Progress) -> Result<Vec<f32>, ProjectError> {
    let [_, crosslines, samples] = stored.size(0);
    let live: Vec<usize> =
        stored.live().iter().enumerate().filter(|(_, live)| **live).map(|(place, _)| place).collect();
    let traces = (SAMPLES_ENOUGH / samples.max(1)).max(1);
    let step = live.len().div_ceil(traces).max(1);
    let chosen: Vec<usize> = live.into_iter().step_by(step).collect();
    let read = |place: &usize| -> Result<Vec<f32>, ProjectError> {
        progress.check()?;
        let trace = stored.read_box_f32(0, [place / crosslines, place % crosslines, 0], [1, 1, samples])?;
        Ok(trace.samples().iter().copied().filter(|value| value.is_finite()).collect())
    };
    Ok(chosen.par_iter().map(read).collect::<Result<Vec<_>, _>>()?.concat())
}
