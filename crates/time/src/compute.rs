//! The steps of geologic time, in order.

use crate::cuts::Cut;
use crate::error::TimeError;
use crate::finish::{hide_chaos, hide_unknown, make_monotone, open_jumps, pin};
use crate::hubs::{Hubs, KNOWN};
use crate::interpretation::{Interpretation, KnownHorizon, Place};
use crate::links::Links;
use crate::matches::Timed;
use crate::merge::merge;
use crate::solve::{Room, System, Tie};
use crate::start;
use crate::throws::{Throw, throw_of, ties};
use interp::Surfaces;
use serde::{Deserialize, Serialize};
use survey::{Progress, Volume};
use system::huge_pages;

/// Settings of geologic time.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct TimeSettings {
    /// Least count of vertices of a patch that is used. Smaller ones are mostly noise. Default 30.
    pub fewest_vertices: usize,
    /// Weight W of a vertex. Default 1, as much as a link.
    pub hub_weight: f32,
    /// e₁: weight of the first difference of s along a trace. More of it keeps τ from collapsing where patches leak;
    /// less lets thickness vary. Default 1e-4.
    pub steepness_weight: f32,
    /// e₂: weight of the second difference of s along a trace. Default 0.01.
    pub bend_weight: f32,
    /// Farthest distance from a patch, in samples, at which τ is known. Default 16: two wavelengths.
    pub reach: usize,
    /// Most steps of one minimisation. Default 60.
    pub most_steps: usize,
    /// Residual at which a minimisation ends, as a part of that at the start. Default 0.005.
    pub tolerance: f64,
}

impl Default for TimeSettings {
    fn default() -> Self {
        Self {
            fewest_vertices: 30,
            hub_weight: 1.0,
            steepness_weight: 1e-4,
            bend_weight: 0.01,
            reach: 16,
            most_steps: 60,
            tolerance: 5e-3,
        }
    }
}

/// Geologic time of a volume.
#[derive(Debug, Clone, PartialEq)]
pub struct GeologicTime {
    /// τ in samples, NaN where it is not known.
    pub tau: Volume<f32>,
    /// Share of the voxels at which it is known.
    pub known: f64,
    /// Share of the voxels at which τ did not increase downwards before it was made to.
    pub not_monotone: f64,
    /// Steps of the minimisations.
    pub steps: usize,
}

/// Misfit, in samples, at which a vertex counts half in the second minimisation.
const MISFIT: f32 = 1.5;

/// Computes geologic time of a volume of amplitudes from its candidates and from what was interpreted.
///
/// No link crosses a fault; a picked horizon has one τ, at which τ jumps where it is an unconformity.
///
/// τ is not known, and NaN, on dead traces, at samples without data, farther than [`TimeSettings::reach`] from every
/// patch, in parts of the volume that no patch and no fault with a throw joins to the largest, and where traces correlate
/// along it no better than noise does. Without candidates it is known nowhere.
///
/// Memory: at most 40 bytes a voxel beside the volume and its candidates, at its peak while s is solved for. The result
/// does not depend on the number of threads. Cost: some hundred sweeps over the volume where there are faults.
///
/// # Errors
/// [`TimeError`].
///
/// # Examples
/// ```
/// use interp::{GrowSettings, grow_surfaces};
/// use survey::{Progress, Volume};
/// use time::{Interpretation, TimeSettings, geologic_time};
///
/// // Reflections that deepen by half a sample a trace.
/// let mut volume = Volume::filled([24, 24, 48], 0.0f32);
/// for (n, sample) in volume.samples_mut().iter_mut().enumerate() {
///     let (x, z) = ((n / 48 / 24) as f32, (n % 48) as f32);
///     *sample = ((z - 0.5 * x) * 0.7).sin();
/// }
/// let surfaces = grow_surfaces(&volume, &GrowSettings::default(), &Progress::silent())?;
/// let nothing = Interpretation::default();
/// let found = geologic_time(&volume, &surfaces, &nothing, &TimeSettings::default(), &Progress::silent())?;
/// // Ten traces on, the same time lies five samples deeper.
/// assert!((found.tau.at(15, 12, 29) - found.tau.at(5, 12, 24)).abs() < 0.05);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn geologic_time(
    volume: &Volume<f32>,
    surfaces: &Surfaces,
    interpretation: &Interpretation,
    settings: &TimeSettings,
    progress: &Progress,
) -> Result<GeologicTime, TimeError> {
    let size = volume.size();
    if surfaces.size != size {
        return Err(TimeError::Size { candidates: surfaces.size, volume: size });
    }
    system::memory::check("geologic time", &size, BYTES_A_VOXEL)?;
    let mut solution = TimeSolution::start(volume, surfaces, interpretation, settings, progress)?;
    if solution.hubs.len() == 0 {
        return Ok(GeologicTime { tau: Volume::filled(size, f32::NAN), known: 0.0, not_monotone: 0.0, steps: 0 });
    }
    solution.minimise("solving for geologic time", progress)?;
    solution.weigh_vertices();
    if !interpretation.cuts.is_empty() {
        for round in ROUNDS {
            solution.match_faults(&round, progress)?;
            solution.merge(round.merge);
            solution.minimise("matching both sides of faults", progress)?;
        }
    }
    solution.finish()
}

/// Memory that is needed for each voxel beside the volume and its candidates.
pub(crate) const BYTES_A_VOXEL: usize = 40;

/// What one round of matching does.
struct Round {
    /// Lines of a stretch of a fault, about; all of them where that is more than there are.
    stretch: usize,
    /// Greatest shift between the logs of both sides, samples.
    most: f32,
    /// Difference of time up to which hubs become one, samples.
    merge: Option<f64>,
}

/// The rounds: the whole fault first, then stretches.
const ROUNDS: [Round; 3] = [
    Round { stretch: usize::MAX, most: 8.0, merge: None },
    Round { stretch: 40, most: 3.0, merge: Some(0.75) },
    Round { stretch: 40, most: 2.0, merge: Some(1.5) },
];

/// A solution on its way.
struct TimeSolution<'a> {
    volume: &'a Volume<f32>,
    cuts: &'a [Cut],
    horizons: &'a [KnownHorizon],
    /// Places of one time in two wells.
    wells: Vec<Tie>,
    settings: &'a TimeSettings,
    hubs: Hubs,
    links: Links,
    ties: Vec<Tie>,
    s: Vec<f32>,
    room: Room,
    steps: usize,
}

impl<'a> TimeSolution<'a> {
    /// Hubs, links, throws, and s from the hubs alone.
    fn start(
        volume: &'a Volume<f32>,
        surfaces: &Surfaces,
        interpretation: &'a Interpretation,
        settings: &'a TimeSettings,
        progress: &Progress,
    ) -> Result<Self, TimeError> {
        let Interpretation { cuts, horizons, same } = interpretation;
        let hubs = Hubs::new(surfaces, cuts, settings.fewest_vertices, settings.hub_weight)
            .with_horizons(horizons, settings.hub_weight);
        let links = Links::new(&hubs, cuts, horizons);
        let ny = surfaces.size[1];
        let tie = |pair: &[Place; 2]| Tie {
            trace: pair.map(|at| (at.trace[0] * ny + at.trace[1]) as u32),
            z: pair.map(|at| at.z),
            weight: WELL_WEIGHT,
        };
        let wells: Vec<Tie> = same.iter().map(tie).collect();
        let mut near = start::neighbours(&hubs, &links);
        near.extend(start::tied(&hubs, &wells, None));
        let ties = spanning_ties(volume, &hubs, &links, cuts, &mut near);
        let times = start::hub_times(hubs.len(), &near);
        let mut s = huge_pages::zeroed(surfaces.size.iter().product());
        let of_hub = |v: usize| times[hubs.hub[v] as usize] as f32 - hubs.z[v];
        start::add_between(&hubs, &links, of_hub, &mut s, progress)?;
        Ok(Self { volume, cuts, horizons, wells, settings, hubs, links, ties, s, room: Room::default(), steps: 0 })
    }

    fn system(&self) -> System<'_> {
        System {
            hubs: &self.hubs,
            links: &self.links,
            ties: &self.ties,
            anchors: &[],
            smoothness: [self.settings.steepness_weight, self.settings.bend_weight],
        }
    }

    /// Moves s to the minimum.
    fn minimise(&mut self, stage: &str, progress: &Progress) -> Result<(), TimeError> {
        progress.begin(stage, self.settings.most_steps as u64);
        let mut s = std::mem::take(&mut self.s);
        let mut room = std::mem::take(&mut self.room);
        let TimeSettings { most_steps, tolerance, .. } = *self.settings;
        let done = self.system().minimise(&mut s, &mut room, most_steps, tolerance, progress);
        (self.s, self.room) = (s, room);
        self.steps += done?;
        Ok(())
    }

    /// τ at the vertices.
    fn vertex_times(&self) -> Vec<f32> {
        self.system().at_vertices(&self.s)
    }

    /// Takes weight from the vertices that do not fit their hub.
    fn weigh_vertices(&mut self) {
        let times = self.vertex_times();
        let means = self.hubs.means(&times);
        let is_known = self.settings.hub_weight * KNOWN;
        for (v, time) in times.iter().enumerate() {
            let off = (time - means[self.hubs.hub[v] as usize]) / MISFIT;
            if self.hubs.weight[v] < is_known {
                self.hubs.weight[v] = self.settings.hub_weight / (1.0 + off * off).powi(2);
            }
        }
    }

    /// Joins hubs of nearly one time.
    fn merge(&mut self, tolerance: Option<f64>) {
        if let Some(tolerance) = tolerance {
            let times = self.vertex_times();
            merge(&mut self.hubs, &self.links, &times, tolerance);
        }
    }

    /// τ, monotone, and NaN where it is not known.
    fn finish(mut self) -> Result<GeologicTime, TimeError> {
        drop(std::mem::take(&mut self.room));
        let size = self.volume.size();
        let voxels = size.iter().product::<usize>().max(1) as f64;
        open_jumps(&mut self.s, size, self.horizons);
        let changed = make_monotone(&mut self.s, &self.hubs, &self.links);
        pin(&mut self.s, &self.hubs, &self.links, self.settings.hub_weight * KNOWN);
        let reach = self.settings.reach;
        let ties = [self.ties, self.wells].concat();
        hide_unknown(&mut self.s, &self.hubs, &self.links, &ties, self.volume, reach);
        let picked = self.settings.hub_weight * KNOWN;
        let known = hide_chaos(&mut self.s, &self.hubs, self.volume, reach, picked);
        let mut tau = Volume::filled(size, f32::NAN);
        tau.samples_mut().copy_from_slice(&self.s);
        let not_monotone = changed as f64 / voxels;
        Ok(GeologicTime { tau, known: known as f64 / voxels, not_monotone, steps: self.steps })
    }

    /// Ties what matches across the faults, and corrects the hubs by it.
    fn match_faults(&mut self, round: &Round, progress: &Progress) -> Result<(), TimeError> {
        let timed = Timed { volume: self.volume, s: &self.s };
        let mut ties = Vec::new();
        for cut in self.cuts {
            progress.check()?;
            let stretches = (cut.size[0] / round.stretch).max(1);
            ties.extend(timed.ties(cut, stretches, round.most, TIE_STEP, TIE_WEIGHT));
        }
        self.ties = ties;
        let times = self.vertex_times();
        let mut tied = start::tied(&self.hubs, &self.ties, Some(&times));
        tied.extend(start::tied(&self.hubs, &self.wells, Some(&times)));
        let near = start::neighbours(&self.hubs, &self.links);
        let more = start::corrections(self.hubs.len(), &near, &tied);
        let mut s = std::mem::take(&mut self.s);
        let done =
            start::add_between(&self.hubs, &self.links, |v| more[self.hubs.hub[v] as usize] as f32, &mut s, progress);
        self.s = s;
        Ok(done?)
    }
}

/// Weight of a pair of tops: as many traces would speak against it.
const WELL_WEIGHT: f32 = 200.0;
/// Steps between ties along a fault, lines and samples.
const TIE_STEP: [usize; 2] = [2, 4];
/// Weight of a tie: one for eight links.
const TIE_WEIGHT: f32 = 1.0;

/// Margin of a throw that is believed though patches join both sides somewhere: a few that leak through a gap of the
/// fault must not decide.
const CLEAR: f32 = 0.1;

/// Finds the throws of the faults; ties where they are clear, and the parts that only they join, the surest first.
fn spanning_ties(
    volume: &Volume<f32>,
    hubs: &Hubs,
    links: &Links,
    cuts: &[Cut],
    near: &mut Vec<start::HubNeighbours>,
) -> Vec<Tie> {
    let mut throws: Vec<(usize, Throw)> =
        cuts.iter().enumerate().filter_map(|(f, cut)| Some((f, throw_of(volume, links, cut)?))).collect();
    throws.sort_by(|a, b| b.1.margin.total_cmp(&a.1.margin));
    let mut parts = start::parts(hubs.len(), near);
    let mut all = Vec::new();
    for (f, throw) in throws {
        let ties = ties(&cuts[f], hubs.size, &throw, TIE_STEP, TIE_WEIGHT);
        let tied = start::tied(hubs, &ties, None);
        let joining = tied.iter().filter(|pair| parts.find(pair.hubs[0]) != parts.find(pair.hubs[1])).count();
        if 2 * joining > tied.len() || throw.margin >= CLEAR {
            for pair in &tied {
                parts.union(pair.hubs[0], pair.hubs[1]);
            }
            near.extend(tied);
            all.extend(ties);
        }
    }
    all
}
