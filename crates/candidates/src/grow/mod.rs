//! Growing surfaces over extrema (P-horiz 4).
//!
//! The paper grows from every voxel in turn, so its result depends on the order of the seeds. Our method
//! defines the surfaces as a *set*: which extrema are linked, which links are cut, which cells are complete
//! and which are connected follows from the extrema alone and not from any order of visits. Threads, slabs
//! and tiles therefore cannot change the result.
//!
//! | step of our method | module |
//! |---|---|
//! | extrema, refined between samples | [`crate::extrema`] |
//! | mutual best links between neighbouring traces, guided by the dip | `links`, `dip` |
//! | evidence of each link for a break, relative to the volume's noise and to the surroundings | `evidence`, `surroundings` |
//! | side lobes are distinguished from reflectors by the extrema above and below; links between the two are breaks | `lobes` |
//! | fault planes: planes along which many links show breaks; they cut links | `planes` |
//! | closed cells, morphological opening by the least width, connected windows | `cells` |
//! | extrema left over go to the surface that fits best | `flood` |
//! | pieces that are linked along most of their common boundary are joined | `merge` |
//! | triangles | `assemble` |
//!
//! Surfaces are first connected over necks of at least `core_width` traces (their *cores*); what the flood
//! does not reach is then connected over necks of at least `min_front_width`.
//!
//! Peaks, troughs and zero crossings never link to one another. Space: voxels.

pub(crate) mod assemble;
pub(crate) mod cells;
pub(crate) mod dip;
pub(crate) mod evidence;
pub(crate) mod flood;
pub(crate) mod links;
pub(crate) mod lobes;
pub(crate) mod merge;
pub(crate) mod ours;
pub(crate) mod planes;
#[cfg(test)]
mod real_tests;
pub(crate) mod smoothing;
pub(crate) mod surroundings;
#[cfg(test)]
mod tests;
mod union_find;

use crate::extrema::{Extrema, ExtremaError, find_extrema};
pub use ours::grow as as_set;
pub use union_find::UnionFind;

use crate::surfaces::{Extremum, Surfaces};
use serde::{Deserialize, Serialize};
use survey::source::SlabSource;
use survey::{Cancelled, Progress, Volume};

/// The method of growing.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Method {
    /// As a set: the result is independent of order, threads and tiles.
    #[default]
    Ours,
    /// Fronts from every voxel in turn; each voxel is visited once (P-horiz 4). A baseline, which the crate `reference`
    /// has.
    Paper,
}

/// What a method does: surfaces from the extrema of each kind, of which there is at least one, all of one volume.
pub type Grow = fn(&[Extrema], &GrowSettings, &Progress) -> Result<Surfaces, Cancelled>;

/// Settings of growing.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct GrowSettings {
    /// The method; ours by default.
    pub method: Method,
    /// Kinds of extrema that surfaces follow; peaks and troughs by default. Kinds never link to one another.
    pub extrema: Vec<Extremum>,
    /// Least width of a surface and of its connections, traces. Default 4 (P-horiz 4); at least 2.
    pub min_front_width: usize,
    /// Width of a neck below which surfaces stay apart and share what lies between them, traces. Narrow
    /// surfaces are grown all the same. Default 10: leaks across faults are rarely wider. A value of at most
    /// `min_front_width` turns this off.
    pub core_width: usize,
    /// Least evidence along a plane for it to be a fault that cuts surfaces (see `planes`). Default 25. A
    /// smaller value makes more cuts, an infinite one turns the search for faults off.
    pub fault_evidence: f32,
    /// Least share of its height that an extremum of a reflector must have of its own, i.e. not as the side
    /// lobe of another extremum (see `lobes`). Default 0.4; 0 turns this off. Needs both peaks and troughs.
    pub lobe_share: f32,
    /// Share of the common boundary of two pieces that must be linked for them to be joined (see `merge`).
    /// Default 0.4. A smaller value gives fewer and larger surfaces; above 1 nothing is joined.
    pub join_share: f32,
    /// Count of inlines read at a time. Does not change the result. Default 16.
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

impl GrowSettings {
    /// The kinds to follow in a volume of `size`, each once and in order, after a check of all settings.
    ///
    /// # Errors
    /// [`GrowError`] when a setting is out of range or the volume has too many lines.
    pub(crate) fn kinds_in<E>(&self, size: [usize; 3]) -> Result<Vec<Extremum>, GrowError<E>> {
        if self.min_front_width < 2 {
            return Err(GrowError::FrontWidth { found: self.min_front_width });
        }
        if self.join_share.is_nan() || self.join_share <= 0.0 {
            return Err(GrowError::JoinShare { found: self.join_share });
        }
        if self.fault_evidence.is_nan() || self.fault_evidence <= 0.0 {
            return Err(GrowError::FaultEvidence { found: self.fault_evidence });
        }
        let mut kinds = self.extrema.clone();
        kinds.sort_unstable();
        kinds.dedup();
        let lines = size[0].max(size[1]);
        if kinds.is_empty() {
            return Err(GrowError::NoExtrema);
        }
        if lines > usize::from(u16::MAX) {
            return Err(GrowError::TooManyLines { lines });
        }
        Ok(kinds)
    }
}

/// Why no surfaces could be grown.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum GrowError<E = std::convert::Infallible> {
    /// [`GrowSettings::min_front_width`] is out of range.
    #[error("the least front width is {found} traces; give at least 2 (4 is a good choice)")]
    FrontWidth {
        /// The value given.
        found: usize,
    },
    /// [`GrowSettings::join_share`] is out of range.
    #[error(
        "the share of a boundary that joins pieces is {found}; give 0.4 (a good choice) to 1, or more to join nothing"
    )]
    JoinShare {
        /// The value given.
        found: f32,
    },
    /// [`GrowSettings::fault_evidence`] is out of range.
    #[error(
        "the least evidence for a fault is {found}; give 25 (a good choice) to 200, or infinity to look for no faults"
    )]
    FaultEvidence {
        /// The value given.
        found: f32,
    },
    /// [`GrowSettings::extrema`] is empty.
    #[error("there is no kind of extremum to follow; give peaks, troughs or zero crossings")]
    NoExtrema,
    /// The volume has more lines than the indices of vertices can number.
    #[error("{lines} lines are more than the {} that can be numbered; extract a part of the volume", u16::MAX)]
    TooManyLines {
        /// Count of inlines or crosslines.
        lines: usize,
    },
    /// The method is none of this crate.
    #[error("the published method of growing is a baseline and no part of this library; grow by `ours`")]
    Published,
    /// The extrema could not be found.
    #[error(transparent)]
    Extrema(#[from] ExtremaError<E>),
    /// The user cancelled.
    #[error(transparent)]
    Cancelled(#[from] Cancelled),
}

/// Grows all surfaces of a volume in memory; see [`grow_slabs`].
///
/// # Errors
/// [`GrowError`] when a setting is out of range or the user cancels.
///
/// # Examples
///
/// ```
/// use candidates::{GrowSettings, grow_surfaces};
/// use survey::{Cancelled, Progress, Volume};
///
/// // One flat reflector, a peak at sample 10, on 20 × 20 traces.
/// let mut volume = Volume::filled([20, 20, 21], 0.0f32);
/// for (n, sample) in volume.samples_mut().iter_mut().enumerate() {
///     *sample = 5.0 - ((n % 21) as f32 - 10.0).abs();
/// }
/// let found = grow_surfaces(&volume, &GrowSettings::default(), &Progress::silent())?;
/// assert_eq!(found.surfaces.len(), 1);
/// assert!(found.vertices.iter().all(|vertex| (vertex.z - 10.0).abs() < 1e-4));
/// // Two triangles in each of 19 × 19 cells.
/// assert_eq!((found.vertices.len(), found.triangles.len()), (400, 722));
/// # Ok::<(), candidates::GrowError>(())
/// ```
pub fn grow_surfaces(
    volume: &Volume<f32>,
    settings: &GrowSettings,
    progress: &Progress,
) -> Result<Surfaces, GrowError> {
    grow_slabs(volume, settings, progress)
}

/// Grows all surfaces of a volume that is read slab by slab. A volume without anything to follow (constant,
/// dead, a single trace, narrower than the front width) has no surfaces.
///
/// # Errors
/// [`GrowError`] when a setting is out of range, the method is the published one, the source fails or the user cancels.
pub fn grow_slabs<S: SlabSource>(
    source: &S,
    settings: &GrowSettings,
    progress: &Progress,
) -> Result<Surfaces, GrowError<S::Error>> {
    match settings.method {
        Method::Ours => grow_slabs_by(as_set, source, settings, progress),
        Method::Paper => Err(GrowError::Published),
    }
}

/// [`grow_slabs`] by a method that is given, whatever the settings name.
///
/// # Errors
/// [`GrowError`] when a setting is out of range, the source fails or the user cancels.
pub fn grow_slabs_by<S: SlabSource>(
    grow: Grow,
    source: &S,
    settings: &GrowSettings,
    progress: &Progress,
) -> Result<Surfaces, GrowError<S::Error>> {
    let size = source.size();
    let kinds = settings.kinds_in(size)?;
    if size.contains(&0) {
        return Ok(Surfaces { size, ..Surfaces::default() });
    }
    let extrema = find_extrema(source, &kinds, settings.slab_inlines, progress)?;
    Ok(grow(&extrema, settings, progress)?)
}
