//! From a volume to horizon candidates: surfaces, their trees, and for every voxel the closest leaf.
//!
//! [`extract`] keeps the result in memory; [`extract_into`] hands it over slab by slab, for volumes larger than memory
//! too: growing reads slabs ([`SlabSource`]), and of distances one slab is in memory at a time. Both give the same
//! candidates. Space: voxels.

#[cfg(test)]
mod tests;

use crate::distance::{DistanceSettings, LeafDistances};
use crate::error::InterpError;
use crate::extrema::ExtremaError;
use crate::forest::{Forest, ForestSettings};
use crate::grow::{Grow, GrowError, GrowSettings, grow_slabs, grow_slabs_by};
use crate::surfaces::Surfaces;
use serde::{Deserialize, Serialize};
use std::fmt;
use std::time::Instant;
use survey::Progress;
use survey::candidates::{CandidateBox, CandidateInfo, CandidateSink};
use survey::source::{SlabSource, SourceError};

/// Settings of an extraction.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct ExtractSettings {
    /// Settings of growing.
    pub grow: GrowSettings,
    /// Settings of the surface trees.
    pub forest: ForestSettings,
    /// Settings of the distances.
    pub distance: DistanceSettings,
}

/// Wall-clock time by stage, seconds.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
pub struct StageSeconds {
    /// Extrema, links, surfaces.
    pub growing: f64,
    /// Surface trees.
    pub trees: f64,
    /// Distances and leaf ids.
    pub distances: f64,
    /// Writing; 0 when nothing was written.
    pub storing: f64,
    /// The whole extraction.
    pub total: f64,
}

/// A summary of an extraction.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct ExtractReport {
    /// The settings used.
    pub settings: ExtractSettings,
    /// Count of surfaces.
    pub surfaces: usize,
    /// Count of leaves of their trees.
    pub leaves: usize,
    /// Count of surfaces with fewer triangles than the minimum of a leaf; each of them is one leaf.
    pub undersized: usize,
    /// Count of triangles.
    pub triangles: usize,
    /// Count of vertices.
    pub vertices: usize,
    /// Count of triangles of the largest surface.
    pub largest: usize,
    /// Share of the voxels that have a leaf within the greatest distance, 0 to 1.
    pub within_reach: f64,
    /// Bytes of a leaf id: 2, or 4 with more than 65 535 leaves.
    pub leaf_id_bytes: usize,
    /// Time by stage; `None` in a report that was stored, since the same extraction stores the same bytes.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub seconds: Option<StageSeconds>,
}

impl ExtractReport {
    /// A sentence that says why there is no surface; `None` when there are surfaces.
    pub fn nothing_found(&self) -> Option<String> {
        (self.surfaces == 0).then(|| {
            format!(
                "no surface at least {} traces wide was found: the volume is constant, dead or narrower than \
                 that, or it has none of the extrema that were followed",
                self.settings.grow.min_front_width
            )
        })
    }
}

impl fmt::Display for ExtractReport {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if let Some(sentence) = self.nothing_found() {
            return writeln!(f, "{sentence}");
        }
        writeln!(
            f,
            "{} surfaces with {} triangles, the largest with {}; {} leaves, of which {} are whole surfaces below {} triangles",
            self.surfaces,
            self.triangles,
            self.largest,
            self.leaves,
            self.undersized,
            self.settings.forest.min_leaf_triangles
        )?;
        writeln!(
            f,
            "{:.1} % of the voxels lie within {} voxels of a surface",
            self.within_reach * 100.0,
            self.settings.distance.max_distance
        )?;
        if self.leaf_id_bytes > 2 {
            writeln!(f, "there are more than 65535 leaves, so their ids take four bytes a voxel instead of two")?;
        }
        let Some(StageSeconds { growing, trees, distances, storing, total }) = self.seconds else { return Ok(()) };
        writeln!(
            f,
            "growing {growing:.2} s, trees {trees:.2} s, distances {distances:.2} s, storing {storing:.2} s: {total:.2} s"
        )
    }
}

/// The candidates of a volume, in memory.
#[derive(Debug, Clone, PartialEq)]
pub struct Extraction {
    /// The surfaces and their trees.
    pub forest: Forest,
    /// The closest leaf of every voxel. Memory: 5 bytes a voxel.
    pub candidates: CandidateBox,
    /// The summary.
    pub report: ExtractReport,
}

/// Extracts the candidates of a volume.
///
/// # Errors
/// [`InterpError`]: a setting is out of range, the source fails, or the user cancels. Finding no surface is no
/// error.
///
/// # Examples
///
/// ```
/// use candidates::{ExtractSettings, extract};
/// use survey::{Progress, Volume};
///
/// // One flat reflector, a peak at sample 10, on 20 × 20 traces.
/// let mut volume = Volume::filled([20, 20, 21], 0.0f32);
/// for (n, sample) in volume.samples_mut().iter_mut().enumerate() {
///     *sample = 5.0 - ((n % 21) as f32 - 10.0).abs();
/// }
/// let found = extract(&volume, &ExtractSettings::default(), &Progress::silent())?;
/// assert_eq!((found.report.surfaces, found.report.leaves), (1, 1));
/// // With 254 codes for 10 voxels, sample 15 is 127 codes away from the leaf.
/// assert_eq!((found.candidates.distance[15], found.candidates.leaf[15]), (127, 1));
/// # Ok::<(), candidates::InterpError>(())
/// ```
pub fn extract<S>(source: &S, settings: &ExtractSettings, progress: &Progress) -> Result<Extraction, InterpError>
where
    S: SlabSource,
    GrowError<S::Error>: std::error::Error + Send + Sync + 'static,
{
    let start = Instant::now();
    let grown = || grow_slabs(source, &settings.grow, progress);
    let (forest, mut report, mut seconds) = build_forest(grown, settings, progress)?;
    let measuring = Instant::now();
    let [nx, ny, _] = source.size();
    let distances = LeafDistances::new(&forest, &settings.distance)?;
    progress.begin("measuring distances to surfaces", (nx * ny) as u64);
    let all = distances.columns(0..nx, 0..ny, progress)?;
    drop(distances);
    let reached = all.leaf.iter().filter(|&&leaf| leaf != 0).count();
    report.within_reach = reached as f64 / all.leaf.len().max(1) as f64;
    seconds.distances = measuring.elapsed().as_secs_f64();
    seconds.total = start.elapsed().as_secs_f64();
    report.seconds = Some(seconds);
    let candidates = CandidateBox { size: source.size(), distance: all.distance, leaf: all.leaf };
    Ok(Extraction { forest, candidates, report })
}

/// Extracts the candidates of a volume slab by slab into a sink, which `begin` makes for a size and a count of leaves;
/// `key` identifies source and settings, and `grow` is the method that the settings name.
///
/// # Errors
/// As [`extract`], and [`InterpError::Sink`]; the sink is then dropped before its end.
pub fn extract_into<S, K>(
    begin: impl FnOnce([usize; 3], usize) -> Result<K, SourceError>,
    key: &str,
    source: &S,
    settings: &ExtractSettings,
    grow: Grow,
    progress: &Progress,
) -> Result<ExtractReport, InterpError>
where
    S: SlabSource,
    GrowError<S::Error>: std::error::Error + Send + Sync + 'static,
    K: CandidateSink,
{
    let start = Instant::now();
    let grown = || grow_slabs_by(grow, source, &settings.grow, progress);
    let (forest, mut report, mut seconds) = build_forest(grown, settings, progress)?;
    let size = source.size();
    let mut sink = begin(size, forest.leaf_count()).map_err(InterpError::Sink)?;
    let measuring = Instant::now();
    let distances = LeafDistances::new(&forest, &settings.distance)?;
    let (mut reached, mut storing) = (0, 0.0);
    distances.slabs(sink.slab_inlines(), progress, |slab| {
        let writing = Instant::now();
        reached += slab.leaf.iter().filter(|&&leaf| leaf != 0).count();
        sink.write_slab(slab.x.start, &slab.distance, &slab.leaf, progress).map_err(InterpError::Sink)?;
        storing += writing.elapsed().as_secs_f64();
        Ok::<(), InterpError>(())
    })?;
    drop(distances);
    seconds.distances = measuring.elapsed().as_secs_f64() - storing;
    report.within_reach = reached as f64 / size.iter().product::<usize>().max(1) as f64;
    let writing = Instant::now();
    let tables = forest.tables();
    let info = CandidateInfo {
        key: key.to_owned(),
        size,
        max_distance: settings.distance.max_distance,
        leaves: forest.leaf_count(),
        report: report.clone(),
    };
    drop(forest);
    sink.finish(&info, &tables, progress).map_err(InterpError::Sink)?;
    seconds.storing = storing + writing.elapsed().as_secs_f64();
    seconds.total = start.elapsed().as_secs_f64();
    report.seconds = Some(seconds);
    Ok(report)
}

/// Grows the surfaces and builds their trees.
fn build_forest<E>(
    grown: impl FnOnce() -> Result<Surfaces, GrowError<E>>,
    settings: &ExtractSettings,
    progress: &Progress,
) -> Result<(Forest, ExtractReport, StageSeconds), InterpError>
where
    GrowError<E>: std::error::Error + Send + Sync + 'static,
{
    let start = Instant::now();
    let surfaces = grown().map_err(|error| match error {
        GrowError::Cancelled(cancelled) | GrowError::Extrema(ExtremaError::Cancelled(cancelled)) => cancelled.into(),
        other => InterpError::Growing(Box::new(other)),
    })?;
    let growing = start.elapsed().as_secs_f64();
    let largest = surfaces.surfaces.iter().map(|part| part.triangles.len()).max().unwrap_or(0);
    let forest = Forest::build(surfaces, &settings.forest, progress)?;
    let undersized =
        forest.roots.iter().filter(|&&root| forest.is_undersized(root, settings.forest.min_leaf_triangles));
    let report = ExtractReport {
        settings: settings.clone(),
        surfaces: forest.roots.len(),
        leaves: forest.leaf_count(),
        undersized: undersized.count(),
        triangles: forest.surfaces.triangles.len(),
        vertices: forest.surfaces.vertices.len(),
        largest,
        within_reach: 0.0,
        leaf_id_bytes: if forest.leaf_count() > usize::from(u16::MAX) { 4 } else { 2 },
        seconds: None,
    };
    let trees = start.elapsed().as_secs_f64() - growing;
    Ok((forest, report, StageSeconds { growing, trees, ..StageSeconds::default() }))
}
