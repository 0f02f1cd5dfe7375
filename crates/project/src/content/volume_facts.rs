//! The facts that a project keeps about a stored volume, found by reading as little of it as necessary.

use crate::content;
use crate::document::{Polarity, Source, VolumeEntry};
use crate::error::ProjectError;
use rayon::prelude::*;
use std::path::Path;
use store::StoredVolume;
use survey::{Progress, SurveyGeometry};

/// Share of the samples that lie within the range of colours.
const SHOWN_SHARE: f32 = 0.99;

/// Number of samples that gives a percentile to three digits; more would only take longer.
const SAMPLES_ENOUGH: usize = 1 << 20;

/// The facts of a new volume that do not come from its samples.
pub(crate) struct Facts {
    pub(crate) name: String,
    /// Relative to the project's folder.
    pub(crate) file: String,
    pub(crate) polarity: Polarity,
    pub(crate) source: Source,
    /// Its own lattice, if it differs from the project's.
    pub(crate) geometry: Option<SurveyGeometry>,
}

/// The entry of the volume stored at `path`.
pub(crate) fn entry(path: &Path, facts: Facts, progress: &Progress) -> Result<VolumeEntry, ProjectError> {
    let stored = StoredVolume::open(path)?;
    let (_, ranges) = stored.brick_ranges(0)?;
    let lowest = ranges.iter().map(|range| range[0]).filter(|low| !low.is_nan()).fold(f32::INFINITY, f32::min);
    Ok(VolumeEntry {
        hash: content::hash_stored(&stored)?,
        clip: clip_of(&stored, progress)?,
        lowest: if lowest.is_finite() { lowest } else { 0.0 },
        name: facts.name,
        file: facts.file,
        polarity: facts.polarity,
        source: facts.source,
        geometry: facts.geometry,
    })
}

/// The value that most samples of live traces do not exceed in magnitude, estimated on evenly spread traces; 1 where
/// all are zero. Of a volume in object storage it is estimated on the coarsest level, so that few bricks are read.
fn clip_of(stored: &StoredVolume, progress: &Progress) -> Result<f32, ProjectError> {
    if stored.is_linked() {
        let coarsest = stored.read_f32(stored.level_count() - 1, progress)?;
        let values: Vec<f32> = coarsest.samples().iter().copied().filter(|value| value.is_finite()).collect();
        return Ok(ttf::symmetric_clip(&values, SHOWN_SHARE).unwrap_or(1.0));
    }
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
    let values = chosen.par_iter().map(read).collect::<Result<Vec<_>, _>>()?.concat();
    Ok(ttf::symmetric_clip(&values, SHOWN_SHARE).unwrap_or(1.0))
}
