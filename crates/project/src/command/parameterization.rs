//! i, j, k from another program, or k from geologic time, in place of those computed here.

use super::{Effect, ProjectError};
use crate::content;
use crate::derived;
use crate::document::{Origin, ParameterizationEntry};
use crate::folder::Draft;
use crate::interpretation::solid::{self, SolidModel};
use crate::interpretation::times::time_volume;
use interp::reassembly::from_horizon;
use model::{FaultNetwork, StructuralModel};
use param::{Parameterization, VoxelParameterization, corner_aligned};
use rayon::prelude::*;
use serde::{Deserialize, Serialize};
use std::path::PathBuf;
use store::{ParameterizationVolumes, StoredParameterization};
use survey::{Progress, Volume};

/// Takes i, j, k from a file, or k from geologic time, or computes them here again.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct SetParameterization {
    /// A Zarr v3 group with arrays i, j, k, layer and block; `None`: computed here.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub from: Option<PathBuf>,
    /// Whether k is the fraction of geologic time between the two horizons of a layer.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub by_time: bool,
}

/// Most samples at which k is taken from geologic time; of a larger survey every second, every fourth, ... along an axis.
const MOST_SAMPLES: usize = 1 << 24;

impl SetParameterization {
    pub(super) fn execute(&self, draft: &mut Draft, progress: &Progress) -> Result<Effect, ProjectError> {
        if self.by_time {
            return by_time(draft, progress);
        }
        let Some(path) = &self.from else {
            draft.document.parameterization = None;
            return Ok(Effect::Changed { summary: "i, j, k computed here".to_owned() });
        };
        let volumes = StoredParameterization::open_foreign(path)?.read(progress)?;
        let arrays = derived::voxels_of(volumes);
        let size = arrays.size;
        let name = path.file_stem().map_or_else(String::new, |stem| stem.to_string_lossy().into_owned());
        let reading = format!("i, j, k, layer and block at {} x {} x {}", size[0], size[1], size[2]);
        let origin = super::imported(path, reading)?;
        let model = draft.facts().get(&SolidModel, progress)?;
        keep(draft, &model, arrays, (name, path.display().to_string()), origin, progress)
    }
}

/// Tries arrays on the interpretation, then stores them in the project.
fn keep(
    draft: &mut Draft,
    model: &StructuralModel,
    arrays: VoxelParameterization,
    (name, what): (String, String),
    origin: Origin,
    progress: &Progress,
) -> Result<Effect, ProjectError> {
    // Tried on the interpretation before anything is written.
    let settings = solid::param_settings(&draft.document);
    let (_, taken) = Parameterization::of_volumes(model, &arrays, &settings, progress)?;
    let (file, new) = draft.generation("parameterizations", &name, "zarr")?;
    let volumes =
        ParameterizationVolumes { i: arrays.i, j: arrays.j, k: arrays.k, layer: arrays.layer, block: arrays.block };
    let hash = content::hash_parameterization(&volumes);
    store::write_parameterization(&new, &volumes, &hash, progress)?;
    draft.document.parameterization = Some(ParameterizationEntry { name, file, hash, origin });
    let summary = format!(
        "i, j, k of {what}: {:.1} % of its samples lie in the same layer, {:.1} % of the nodes beside one",
        100.0 * taken.agreeing,
        100.0 * taken.covered
    );
    Ok(Effect::Changed { summary })
}

/// k from geologic time; i and j are those computed here. Every picture draws with them.
fn by_time(draft: &mut Draft, progress: &Progress) -> Result<Effect, ProjectError> {
    let geometry = draft.document.frame()?.clone();
    let entry = time_volume(&draft.document)?.clone();
    let tau = content::read_volume(draft.root(), &entry, &geometry, progress)?;
    let model = draft.facts().get(&SolidModel, progress)?;
    let settings = solid::param_settings(&draft.document);
    let own = Parameterization::compute(&*model, &settings, progress)?;
    let mut size = geometry.size();
    while size.iter().product::<usize>() > MOST_SAMPLES {
        size = size.map(|count| count.div_ceil(2));
    }
    let mut arrays = own.voxel_volumes(&*model, size, progress)?;
    let mut times = Vec::new();
    for entry in &draft.document.horizons {
        let horizon = content::read_horizon(draft.root(), entry, progress)?;
        let sheets = from_horizon(&horizon, &geometry, &FaultNetwork::none());
        let ny = geometry.size()[1];
        let nodes = sheets.iter().flat_map(|sheet| sheet.z.iter().enumerate());
        let mut along: Vec<f32> =
            nodes.map(|(trace, z)| time_at(tau.trace(trace / ny, trace % ny), *z)).filter(|t| t.is_finite()).collect();
        along.sort_by(f32::total_cmp);
        times.push(along.get(along.len() / 2).copied());
    }
    let share = set_k(&mut arrays, &tau, &times);
    let origin = Origin::TimeFraction { of: entry.name.clone() };
    let what = format!("{}, {:.1} % of the samples between two horizons by geologic time", entry.name, 100.0 * share);
    keep(draft, &model, arrays, ("time".to_owned(), what), origin, progress)
}

/// τ at a fractional sample of a trace; NaN where it is not known and outside.
fn time_at(trace: &[f32], z: f32) -> f32 {
    let last = trace.len() - 1;
    if !(z >= 0.0 && z <= last as f32) {
        return f32::NAN;
    }
    let low = (z as usize).min(last);
    let share = z - low as f32;
    // What follows a sample does not matter at the sample itself, where it may be unknown.
    if share == 0.0 { trace[low] } else { trace[low] + share * (trace[low + 1] - trace[low]) }
}

/// Sets k between two horizons to the fraction of τ between theirs, from the base up; where τ is not known, and in the
/// layers above the first and below the last horizon, it stays. `times` are those of the horizons, the youngest first.
/// Returns the share of the samples between two horizons that were set.
fn set_k(arrays: &mut VoxelParameterization, tau: &Volume<f32>, times: &[Option<f32>]) -> f64 {
    let (size, from) = (arrays.size, tau.size());
    let slab = size[1] * size[2];
    let layers = arrays.layer.samples().par_chunks(slab);
    let counts: Vec<[usize; 2]> = arrays
        .k
        .samples_mut()
        .par_chunks_mut(slab)
        .zip(layers)
        .enumerate()
        .map(|(x, (k, layer))| {
            let mut counts = [0, 0];
            for (n, (k, &layer)) in k.iter_mut().zip(layer).enumerate() {
                // Layer 0 is the deepest: it has the last horizon on top.
                let Some(top) = times.len().checked_sub(usize::from(layer) + 1) else { continue };
                let (Some(Some(base)), Some(young)) = (times.get(top + 1), times[top]) else { continue };
                let place = [x, n / size[2], n % size[2]];
                let at = [0, 1, 2].map(|axis| corner_aligned(place[axis], size[axis], from[axis]));
                let trace = tau.trace(at[0].round() as usize, at[1].round() as usize);
                let share = (base - time_at(trace, at[2])) / (base - young);
                counts[1] += 1;
                if share.is_finite() && *base > young {
                    *k = share.clamp(0.0, 1.0);
                    counts[0] += 1;
                }
            }
            counts
        })
        .collect();
    let [set, all] = counts.into_iter().fold([0, 0], |a, b| [a[0] + b[0], a[1] + b[1]]);
    set as f64 / all.max(1) as f64
}

#[cfg(test)]
mod tests {
    use super::*;
    use param::NO_REGION;

    #[test]
    fn k_is_the_fraction_of_time_between_the_horizons_of_a_layer() {
        let size = [1, 1, 8];
        // Three layers of two, four and two samples; τ runs twice as fast in the upper half of the middle one.
        let layer = vec![2, 2, 1, 1, 1, 1, 0, NO_REGION];
        let tau = Volume::from_samples(size, vec![0.0, 1.0, 2.0, 6.0, 10.0, 12.0, f32::NAN, 20.0]).unwrap();
        let floats = || Volume::filled(size, 0.25f32);
        let mut arrays = VoxelParameterization {
            size,
            i: floats(),
            j: floats(),
            k: floats(),
            layer: Volume::from_samples(size, layer).unwrap(),
            block: Volume::filled(size, 0),
        };
        assert_eq!(set_k(&mut arrays, &tau, &[Some(2.0), Some(12.0)]), 1.0);
        assert_eq!(arrays.k.samples(), [0.25, 0.25, 1.0, 0.6, 0.2, 0.0, 0.25, 0.25]);
        let mut unknown = arrays.clone();
        assert_eq!(set_k(&mut unknown, &Volume::filled(size, f32::NAN), &[Some(2.0), Some(12.0)]), 0.0);
        assert_eq!(unknown, arrays);
    }
}
