//! Turns the options of an extraction into settings.

use super::args::ExtractArgs;
use super::interpretation::{bytes, word};
use super::request::{Request, Usage};
use interp::{DistanceSettings, ExtractSettings, Extremum, ForestSettings, GrowSettings, Method};
use project::command::Extract;

/// The words for what surfaces can follow.
const KINDS: [(&str, Extremum); 3] = [("peak", Extremum::Peak), ("trough", Extremum::Trough), ("zero", Extremum::Zero)];

pub(super) fn extract(typed: ExtractArgs) -> Result<Request, Usage> {
    let method = word("--method", &typed.method, &[("ours", Method::Ours), ("paper", Method::Paper)])?;
    let kinds = typed.extrema.split(',').map(|kind| word("--extrema", kind.trim(), &KINDS));
    let grow = GrowSettings {
        method,
        extrema: kinds.collect::<Result<_, _>>()?,
        min_front_width: typed.min_front_width,
        join_share: typed.join_share,
        fault_evidence: typed.fault_evidence,
        ..GrowSettings::default()
    };
    let settings = ExtractSettings {
        grow,
        forest: ForestSettings { min_leaf_triangles: typed.min_leaf_triangles, ..ForestSettings::default() },
        distance: DistanceSettings { max_distance: typed.max_distance },
    };
    let memory_bytes = bytes("--memory", typed.memory.as_deref())?;
    let extract = Extract { volume: typed.volume, settings, memory_bytes, just_stored: false };
    Ok(Request::Extract { project: typed.project, extract })
}
