//! The quality of an extraction, measured against a synthetic survey's truth.
//!
//! For each true horizon, with a tolerance of one sample along the trace:
//!
//! - **coverage**: the share of its nodes (a node is the horizon on one trace in one fault block) that have a
//!   vertex of some surface within the tolerance. It is also given for each part that faults, erosion and the
//!   outer boundary leave connected.
//! - **precision**: the share of on-horizon vertices among all vertices of the surfaces whose majority is
//!   this horizon. Surfaces that have fewer than half of their vertices on reflectors, such as those along
//!   side lobes, belong to no horizon.
//! - **purity**, *per surface*: of a surface's vertices that lie on any true reflector, the share on the
//!   reflector that has most of them. The figure of a horizon is the vertex-weighted mean over the surfaces
//!   whose majority it is; the least pure large surface is given too.
//!
//! The same figures over *all* reflectors, named or not, are steadier. Side lobes of the wavelet are extrema
//! on no reflector, so surfaces along them do not count. Space: voxels.

mod parts;
mod picks;
#[cfg(test)]
mod tests;
mod truth;

pub use parts::{HorizonPart, Parts};
pub use picks::{PickCount, PickScore, PickSettings, count_picks};
pub use truth::{TruthEvent, TruthIndex};

use candidates::Surfaces;
use rayon::prelude::*;
use serde::Serialize;
use synth::SynthTruth;

/// Tolerances of [`evaluate`].
#[derive(Debug, Clone, PartialEq)]
pub struct EvaluateSettings {
    /// Largest distance along the trace at which a vertex lies on a horizon, samples; default 1.
    pub tolerance: f32,
    /// Least count of triangles of a large surface; default 500.
    pub large_triangles: usize,
    /// Least count of traces of a part of a horizon; default 64, an island of 8 × 8 traces.
    pub min_part_traces: usize,
}

impl Default for EvaluateSettings {
    fn default() -> Self {
        Self { tolerance: 1.0, large_triangles: 500, min_part_traces: 64 }
    }
}

/// The score of one surface.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct SurfaceScore {
    /// Index of the surface.
    pub surface: usize,
    /// Count of its triangles.
    pub triangles: usize,
    /// Count of its vertices.
    pub vertices: usize,
    /// Count of vertices on any reflector.
    pub on_any: usize,
    /// Count of vertices on the majority reflector.
    pub on_majority: usize,
    /// The reflector with most of its vertices, an index into `TruthIndex::reflectors`; `None` when no
    /// vertex lies on one.
    #[serde(skip)]
    pub majority: Option<usize>,
}

impl SurfaceScore {
    /// Share of the majority among the vertices on any reflector; 1 where there are none.
    pub fn purity(&self) -> f64 {
        share(self.on_majority, self.on_any)
    }
}

/// The score of one true horizon, or of all reflectors together.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct HorizonScore {
    /// Name of the horizon.
    pub name: String,
    /// Count of its nodes: traces, counted once per fault block.
    pub nodes: usize,
    /// Count of nodes with a vertex within the tolerance.
    pub covered: usize,
    /// Its parts of at least [`EvaluateSettings::min_part_traces`], largest first.
    pub parts: Vec<HorizonPart>,
    /// Count of surfaces whose majority it is.
    pub surfaces: usize,
    /// Count of their vertices.
    pub vertices: usize,
    /// Count of their vertices that lie on it.
    pub on_it: usize,
    /// Vertex-weighted mean of the purities of these surfaces.
    pub purity: f64,
    /// The least pure of the large ones among them.
    pub worst: Option<SurfaceScore>,
}

impl HorizonScore {
    /// Share of its nodes that are covered.
    pub fn coverage(&self) -> f64 {
        share(self.covered, self.nodes)
    }

    /// Share of the vertices of its surfaces that lie on it.
    pub fn precision(&self) -> f64 {
        share(self.on_it, self.vertices)
    }

    /// The coverage of its least covered part; 1 without parts.
    pub(crate) fn least_part(&self) -> f64 {
        self.parts.iter().map(HorizonPart::coverage).fold(1.0, f64::min)
    }
}

/// The scores of an extraction.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Evaluation {
    /// The score of each named horizon, youngest first.
    pub horizons: Vec<HorizonScore>,
    /// The score of all reflectors inside the volume together; it has no parts.
    pub all: HorizonScore,
    /// The score of each surface.
    #[serde(skip)]
    pub surfaces: Vec<SurfaceScore>,
}

/// Measures `surfaces` against `truth`. Time: about a second at 256³; memory: 16 bytes per true event, 4 per
/// vertex.
///
/// ```
/// use candidates::Surfaces;
/// use reference::{EvaluateSettings, evaluate};
/// use survey::Progress;
/// use synth::{SynthSettings, Synthetic};
///
/// // Without surfaces nothing is covered, and nothing is wrong either.
/// let settings = SynthSettings { size: [24, 24, 48], snr: None, ..SynthSettings::default() };
/// let survey = Synthetic::generate(&settings, &Progress::silent())?;
/// let none = Surfaces { size: [24, 24, 48], ..Surfaces::default() };
/// let found = evaluate(&none, &survey.truth, &EvaluateSettings::default());
/// assert_eq!((found.all.coverage(), found.all.precision()), (0.0, 1.0));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn evaluate(surfaces: &Surfaces, truth: &SynthTruth, settings: &EvaluateSettings) -> Evaluation {
    evaluate_with(surfaces, truth, &TruthIndex::new(truth), settings)
}

/// [`evaluate`] with an index of the same truth, for several extractions of one survey.
pub fn evaluate_with(
    surfaces: &Surfaces,
    truth: &SynthTruth,
    index: &TruthIndex,
    settings: &EvaluateSettings,
) -> Evaluation {
    let scores: Vec<SurfaceScore> = (0..surfaces.surfaces.len())
        .into_par_iter()
        .map(|surface| score_surface(surfaces, surface, index, settings.tolerance))
        .collect();
    let covered = covered_events(surfaces, index, settings.tolerance);
    let mut horizons = Vec::with_capacity(truth.horizons.len());
    for (h, horizon) in truth.horizons.iter().enumerate() {
        let reflector = index.reflector_index(truth.reflector_of(h)).expect("the index is of this truth");
        let parts = Parts::of(truth, h);
        let mut score = sum_up(horizon.name.clone(), &scores, settings, |majority| majority == reflector);
        let mut found: Vec<HorizonPart> = parts.empty();
        for (trace, events) in index.traces() {
            for n in events {
                let event = index.events()[n];
                if usize::from(event.reflector) != reflector {
                    continue;
                }
                score.nodes += 1;
                score.covered += usize::from(covered[n]);
                if let Some(part) = parts.at(trace, event.block) {
                    found[part].nodes += 1;
                    found[part].covered += usize::from(covered[n]);
                }
            }
        }
        found.retain(|part| part.nodes >= settings.min_part_traces);
        found.sort_by_key(|part| std::cmp::Reverse(part.nodes));
        score.parts = found;
        horizons.push(score);
    }
    let mut all = sum_up("all reflectors".to_owned(), &scores, settings, |_| true);
    all.nodes = covered.len();
    all.covered = covered.iter().filter(|&&covered| covered).count();
    Evaluation { horizons, all, surfaces: scores }
}

/// The precision and purity of the surfaces whose majority reflector is `wanted`.
fn sum_up(
    name: String,
    scores: &[SurfaceScore],
    settings: &EvaluateSettings,
    wanted: impl Fn(usize) -> bool,
) -> HorizonScore {
    let of_reflectors = |score: &&SurfaceScore| 2 * score.on_any >= score.vertices;
    let own = || scores.iter().filter(of_reflectors).filter(|score| score.majority.is_some_and(&wanted));
    let vertices = own().map(|score| score.vertices).sum();
    let weighted: f64 = own().map(|score| score.purity() * score.vertices as f64).sum();
    let large = own().filter(|score| score.triangles >= settings.large_triangles);
    HorizonScore {
        name,
        nodes: 0,
        covered: 0,
        parts: Vec::new(),
        surfaces: own().count(),
        vertices,
        on_it: own().map(|score| score.on_majority).sum(),
        purity: if vertices == 0 { 1.0 } else { weighted / vertices as f64 },
        worst: large.min_by(|a, b| a.purity().total_cmp(&b.purity())).copied(),
    }
}

/// The score of one surface.
fn score_surface(surfaces: &Surfaces, surface: usize, index: &TruthIndex, tolerance: f32) -> SurfaceScore {
    let found = &surfaces.surfaces[surface];
    let vertices = &surfaces.vertices[found.vertices.start as usize..found.vertices.end as usize];
    let mut votes = vec![0u32; index.reflectors().len()];
    let mut on_any = 0;
    for vertex in vertices {
        let mut any = false;
        for event in index.near(usize::from(vertex.x), usize::from(vertex.y), vertex.z, tolerance) {
            // Where two reflectors lie within the tolerance, the vertex lies on both.
            votes[usize::from(event.reflector)] += 1;
            any = true;
        }
        on_any += usize::from(any);
    }
    let most = (0..votes.len()).max_by_key(|&n| (votes[n], std::cmp::Reverse(n))).filter(|&n| votes[n] > 0);
    SurfaceScore {
        surface,
        triangles: found.triangles.len(),
        vertices: vertices.len(),
        on_any,
        // At most one count per vertex: a trace meets a reflector twice only across a reverse fault.
        on_majority: most.map_or(0, |n| votes[n] as usize).min(on_any),
        majority: most,
    }
}

/// Which true events have a vertex within the tolerance.
fn covered_events(surfaces: &Surfaces, index: &TruthIndex, tolerance: f32) -> Vec<bool> {
    let mut covered = vec![false; index.events().len()];
    for vertex in &surfaces.vertices {
        for n in index.range_near(usize::from(vertex.x), usize::from(vertex.y), vertex.z, tolerance) {
            covered[n] = true;
        }
    }
    covered
}

/// `part / whole`; 1 if both are 0.
fn share(part: usize, whole: usize) -> f64 {
    if whole == 0 { 1.0 } else { part as f64 / whole as f64 }
}

impl std::fmt::Display for Evaluation {
    /// A table for a terminal.
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        writeln!(
            f,
            "{:<16} {:>6} {:>9} {:>11} {:>10} {:>8} {:>9} {:>7}",
            "horizon", "parts", "coverage", "least part", "precision", "purity", "surfaces", "worst"
        )?;
        for score in self.horizons.iter().chain([&self.all]) {
            let worst = score.worst.map_or("-".to_owned(), |worst| format!("{:.3}", worst.purity()));
            writeln!(
                f,
                "{:<16} {:>6} {:>9.4} {:>11.4} {:>10.4} {:>8.4} {:>9} {:>7}",
                score.name,
                score.parts.len(),
                score.coverage(),
                score.least_part(),
                score.precision(),
                score.purity,
                score.surfaces,
                worst
            )?;
        }
        Ok(())
    }
}
