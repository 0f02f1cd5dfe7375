//! Growing surfaces over extrema (P-horiz 4), the paper's way and ours.
//!
//! The paper grows from every voxel in turn, so its result depends on the order of seeds. Ours defines the surfaces as a *set*:
//! which extrema are linked, which links are cut, which cells are complete and which are connected is decided
//! from the extrema alone, never from who came first, so threads, slabs and tiles cannot matter.
//!
//! | step | ours, in |
//! |---|---|
//! | extrema, refined below the sample | [`crate::extrema`] |
//! | mutual best links between neighbouring traces, guided by the dip | `links`, `dip` |
//! | how much each link speaks for a break, beside the volume's own noise and what is usual around it | `evidence`, `surroundings` |
//! | side lobes told from reflectors by what lies above and below them; links between the two speak for a break | `lobes` |
//! | faults: planes along which many links do; they cut links | `planes` |
//! | closed cells, the opening of the least width, connected windows | `cells` |
//! | what is left over goes to the surface that it fits best | `flood` |
//! | pieces that meet along most of their common boundary are joined | `merge` |
//! | triangles | `assemble` |
//!
//! Surfaces are connected over necks of `core_width` traces first; what the flood does not reach is connected over necks of `min_front_width`.
//!
//! Peaks, troughs and zero crossings never link to one another. Space: voxels.

mod assemble;
mod cells;
mod dip;
mod evidence;
mod flood;
mod links;
mod lobes;
mod merge;
mod ours;
mod paper;
mod planes;
#[cfg(test)]
mod real_tests;
mod smoothing;
mod surroundings;
#[cfg(test)]
mod tests;
mod union_find;

use crate::extrema::{ExtremaError, find_extrema};
use crate::surfaces::{Extremum, Surfaces};
use rayon::prelude::*;
use serde::{Deserialize, Serialize};
use survey::source::SlabSource;
use survey::{Progress, Volume};

/// How surfaces are grown.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Method {
    /// As a set: independent of order, threads and tiles.
    #[default]
    Ours,
    /// Fronts from every voxel in turn, each visited once (P-horiz 4).
    Paper,
}

/// What to grow, and how.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct GrowSettings {
    /// Ours by default.
    pub method: Method,
    /// What surfaces follow; peaks and troughs by default. They never link to one another.
    pub extrema: Vec<Extremum>,
    /// Traces: surfaces and connections narrower than this are not grown. Default 4 (P-horiz 4); at least 2.
    pub min_front_width: usize,
    /// Traces: surfaces that meet in a neck narrower than this stay apart, and share what lies between them; narrow
    /// surfaces are grown all the same. Default 10: leaks across faults are rarely wider. At most `min_front_width` turns it off.
    pub core_width: usize,
    /// Least evidence along a plane for it to be a fault that cuts surfaces (see `planes`). Default 25; the less, the more cuts.
    /// Infinite turns the search for faults off.
    pub fault_evidence: f32,
    /// Share of its height that an extremum must have of its own, and not as another's side lobe, to be a reflector's (see `lobes`).
    /// Default 0.4; 0 tells no lobes. Needs peaks and troughs both.
    pub lobe_share: f32,
    /// Share of the boundary of two pieces of a surface that must speak for joining them (see `merge`). Default 0.4; the less, the fewer and
    /// larger surfaces. More than 1 joins none.
    pub join_share: f32,
    /// Inlines read at a time; does not change the result. Default 16.
    pub slab_inlines: usize,
}

impl Default for GrowSettings {
    fn default() -> Self {
        Self {
            method: Method::Ours,
            extrema: vec![Extremum::Peak, Extremum::Trough],
            min_front_width: 4,
            core_width: 10,
            fault_evidence: 25.0,
            lobe_share: 0.4,
            join_share: 0.4,
            slab_inlines: 16,
        }
    }
}

/// Why no surfaces could be grown.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum GrowError<E = std::convert::Infallible> {
    /// The front width makes no sense.
    #[error("the least front width is {found} traces; give at least 2 (4 is a good choice)")]
    FrontWidth {
        /// Asked for.
        found: usize,
    },
    /// The share of a boundary makes no sense.
    #[error("{found} is no share of a boundary; give 0.4 (a good choice) to 1, or more to join nothing")]
    JoinShare {
        /// Asked for.
        found: f32,
    },
    /// The evidence asked of a fault makes no sense.
    #[error("{found} is no evidence to ask of a fault; give 25 (a good choice) to 200, or `inf` to look for none")]
    FaultEvidence {
        /// Asked for.
        found: f32,
    },
    /// Nothing to follow.
    #[error("no kind of extremum to grow on; ask for peaks, troughs or zero crossings")]
    NoExtrema,
    /// The lattice is too large for its surfaces.
    #[error("{lines} lines are more than {} that surfaces can number; extract a part of the volume", u16::MAX)]
    TooManyLines {
        /// Inlines or crosslines.
        lines: usize,
    },
    /// The extrema could not be found.
    #[error(transparent)]
    Extrema(#[from] ExtremaError<E>),
    /// Stopped by the user.
    #[error(transparent)]
    Cancelled(#[from] survey::Cancelled),
}

/// Grows all surfaces of a volume in memory; see [`grow_slabs`].
///
/// # Errors
/// [`GrowError`] when the settings make no sense or the user cancels.
pub fn grow_surfaces(
    volume: &Volume<f32>,
    settings: &GrowSettings,
    progress: &Progress,
) -> Result<Surfaces, GrowError> {
    grow_slabs(volume, settings, progress)
}

/// Grows all surfaces of a volume that is read slab by slab. A volume in which nothing is to be followed (constant, dead, one
/// trace, thinner than the front width) has no surfaces.
///
/// # Errors
/// [`GrowError`] when the settings make no sense, the source fails or the user cancels.
pub fn grow_slabs<S: SlabSource>(
    source: &S,
    settings: &GrowSettings,
    progress: &Progress,
) -> Result<Surfaces, GrowError<S::Error>> {
    if settings.min_front_width < 2 {
        return Err(GrowError::FrontWidth { found: settings.min_front_width });
    }
    if settings.join_share.is_nan() || settings.join_share <= 0.0 {
        return Err(GrowError::JoinShare { found: settings.join_share });
    }
    if settings.fault_evidence.is_nan() || settings.fault_evidence <= 0.0 {
        return Err(GrowError::FaultEvidence { found: settings.fault_evidence });
    }
    let mut kinds = settings.extrema.clone();
    kinds.sort_unstable();
    kinds.dedup();
    if kinds.is_empty() {
        return Err(GrowError::NoExtrema);
    }
    let size = source.size();
    let lines = size[0].max(size[1]);
    if lines > usize::from(u16::MAX) {
        return Err(GrowError::TooManyLines { lines });
    }
    if size.contains(&0) {
        return Ok(Surfaces { size, ..Surfaces::default() });
    }
    let extrema = find_extrema(source, &kinds, settings.slab_inlines, progress)?;
    if settings.method == Method::Ours {
        return Ok(ours::grow(&extrema, settings, progress)?);
    }
    let grown: Vec<Surfaces> = extrema
        .par_iter()
        .map(|extrema| paper::grow(extrema, settings.min_front_width, progress))
        .collect::<Result<_, _>>()?;
    progress.check()?;
    Ok(assemble::joined(size, &grown))
}
