//! Horizons that are levels of geologic time.

use super::horizon::{Age, insert_made};
use super::{Effect, Noun, ProjectError};
use crate::derived::FaultBlocks;
use crate::document::{Chooser, Document, HorizonQuery, Origin, QueryBorder};
use crate::folder::Draft;
use crate::interpretation::assembly;
use crate::interpretation::times::Times;
use ::time::{Crossing, Doubt, Event, Node, Reflections, Seed, Support, bridge, isochron};
use glam::{DVec2, Vec3};
use interp::Extremum;
use model::FaultNetwork;
use rayon::prelude::*;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use survey::{Horizon, NodeGrid, Progress, Quality, Sheet, SurveyGeometry, Volume};

/// The level of geologic time that a horizon is.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum TimeLevel {
    /// The one through this inline, crossline and vertical value, or through the reflection beside it.
    Through([f64; 3]),
    /// The one of this value, samples. It stays where it is beside reflections, which is smoother than what was tracked.
    Of(f32),
    /// The same, of a value that the program chose.
    Chosen(f32),
}

/// Adds a horizon that is a level of geologic time. A place of a horizon that was picked by time corrects it around that
/// place.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct PickByTime {
    /// Which level.
    pub level: TimeLevel,
    /// Name of the new horizon.
    pub horizon: String,
}

/// The report of a horizon that was picked by time.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct PickedByTime {
    /// The horizon.
    pub horizon: String,
    /// Position in the stratigraphy, 0 = youngest.
    pub position: usize,
    /// The value of geologic time, samples.
    pub time: f32,
    /// Number of sheets, one for each fault block.
    pub sheets: usize,
    /// Number of places that it goes through.
    pub seeds: usize,
    /// Number of nodes on patches of a reflection that lie along the level.
    pub tracked: usize,
    /// Number of nodes on another reflection close to the level.
    pub snapped: usize,
    /// Number of nodes between reflections.
    pub between: usize,
    /// Number of nodes beyond a fault or a jump across which nothing tells that it is the same reflection.
    pub assumed: usize,
    /// Share of the survey's traces that it covers, 0 to 1.
    pub coverage: f64,
    /// What is asked about them; a place there decides.
    pub queries: Vec<HorizonQuery>,
}

impl std::fmt::Display for PickedByTime {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let Self { horizon, tracked, snapped, between, coverage, sheets, .. } = self;
        let places = if self.seeds > 1 { format!(" through {} places", self.seeds) } else { String::new() };
        write!(
            f,
            "horizon '{horizon}' by geologic time{places}: {:.1} % of the traces in {sheets} sheets, {tracked} nodes on \
             its reflection (tracked), {snapped} on one close by (snapped), {between} between reflections (filled)",
            100.0 * coverage
        )?;
        if self.assumed > 0 {
            write!(f, ", {} assumed (extrapolated)", self.assumed)?;
        }
        self.queries.iter().try_for_each(|query| write!(f, "\n{query}"))
    }
}

impl PickByTime {
    pub(super) fn execute(&self, draft: &mut Draft, progress: &Progress) -> Result<Effect, ProjectError> {
        let corrected = self.corrected(&draft.document)?;
        let geometry = draft.document.frame()?.clone();
        let times = Times::load(draft.facts(), progress)?;
        let Times { tau, reflections, .. } = times.as_ref();
        let blocks = draft.facts().get(&FaultBlocks, progress)?;
        let earlier = corrected.map_or(&[][..], |index| draft.document.horizons[index].origin.seeds());
        let value = |time: f32, chosen_by| (level(tau, time, reflections), Origin::Level { time, chosen_by });
        let (event, origin) = match self.level {
            TimeLevel::Through(at) => {
                let seeds = [earlier, &[at]].concat();
                through(seeds, &draft.document, &times)?
            }
            TimeLevel::Of(time) => value(time, Chooser::Person),
            TimeLevel::Chosen(time) => value(time, Chooser::Program),
        };
        if event.nodes.is_empty() {
            return Err(ProjectError::NoIsochron { time: event.time });
        }
        let voxels = origin.seeds().iter().map(|at| voxel(*at, &geometry)).collect::<Result<Vec<_>, _>>()?;
        let mut sheets = sheets(&event, &geometry, &blocks, &voxels);
        if matches!(self.level, TimeLevel::Chosen(_)) {
            lay_over_islands(&mut sheets, &times.amplitudes, &geometry);
        }
        let count = |quality: Quality| -> usize {
            sheets.iter().flat_map(|sheet| &sheet.quality).filter(|found| **found == quality).count()
        };
        let tracked = count(Quality::Tracked) + count(Quality::Picked);
        let (snapped, between) = (count(Quality::Snapped), count(Quality::Filled));
        let (assumed, queries) = (count(Quality::Extrapolated), origin.queries().to_vec());
        let mut traces: Vec<[u16; 2]> = event.nodes.iter().map(|at| [at.x, at.y]).collect();
        traces.dedup();
        let coverage = traces.len() as f64 / (tau.size()[0] * tau.size()[1]) as f64;
        let (sheet_count, time) = (sheets.len(), event.time);
        let horizon = Horizon::new(self.horizon.clone(), sheets);
        let seeds = origin.seeds().len();
        if let Some(corrected) = corrected {
            let made = &mut draft.document.horizons[corrected];
            (made.origin, made.refined) = (origin, Vec::new());
            assembly::put(draft, &horizon, None, None, progress)?;
        } else {
            insert_made(draft, &horizon, &Age::ByDepth, origin, progress)?;
        }
        let position = draft.document.position(Noun::Horizon, &self.horizon)?;
        Ok(Effect::PickedByTime(PickedByTime {
            horizon: self.horizon.clone(),
            position,
            time,
            seeds,
            sheets: sheet_count,
            tracked,
            snapped,
            between,
            assumed,
            coverage,
            queries,
        }))
    }

    /// The horizon that another place corrects; `None` for a new one.
    fn corrected(&self, document: &Document) -> Result<Option<usize>, ProjectError> {
        let known = document.horizons.iter().position(|entry| entry.name == self.horizon);
        let by_time = known.filter(|&index| !document.horizons[index].origin.seeds().is_empty());
        match (by_time, &self.level) {
            (Some(index), TimeLevel::Through(_)) => Ok(Some(index)),
            _ => document.check_new_name(Noun::Horizon, &self.horizon).map(|()| None),
        }
    }
}

/// A place as trace and fractional sample.
fn voxel(at: [f64; 3], geometry: &SurveyGeometry) -> Result<Seed, ProjectError> {
    let place = geometry.voxel_from_lines(at[0], at[1]).round();
    let z = geometry.vertical.index_of(at[2]);
    let [nx, ny, nz] = geometry.size();
    let inside = |at: f64, count: usize| at >= 0.0 && at <= (count - 1) as f64;
    if inside(place.x, nx) && inside(place.y, ny) && inside(z, nz) {
        Ok(Seed { trace: [place.x as usize, place.y as usize], z: z as f32 })
    } else {
        Err(ProjectError::outside(at, geometry))
    }
}

/// The event through places, each on the reflection beside it if there is one, and what nothing tells of it.
fn through(seeds: Vec<[f64; 3]>, document: &Document, times: &Times) -> Result<(Event, Origin), ProjectError> {
    let Times { tau, amplitudes, reflections, cuts } = times;
    let (geometry, names) = (document.frame()?, document.names(Noun::Fault));
    let voxels = seeds.iter().map(|at| voxel(*at, geometry)).collect::<Result<Vec<_>, _>>()?;
    // The last is the new one.
    let unknown = ProjectError::TimeUnknown { at: seeds.last().copied().unwrap_or_default() };
    let mut event = reflections.event(tau, &voxels, cuts).ok_or(unknown)?;
    let all = event.nodes.len().max(1) as f64;
    let query = |doubt: Doubt| {
        let beyond = match doubt.fault {
            None => QueryBorder::Jump,
            Some(fault) => names.get(fault).cloned().map_or(QueryBorder::FoundFault, QueryBorder::Fault),
        };
        let lines = geometry.lines_from_voxel(DVec2::new(doubt.place.trace[0] as f64, doubt.place.trace[1] as f64));
        let at = [lines.x, lines.y, geometry.vertical.value_at(f64::from(doubt.place.z))];
        HorizonQuery { beyond, at, share: doubt.nodes as f64 / all }
    };
    let queries = event.examine(reflections, &voxels, cuts, amplitudes).into_iter().map(query).collect();
    Ok((event, Origin::ByTime { seeds, queries }))
}

/// A level of time as it is, which is smoother than what was tracked; its nodes tell which reflections it passes.
fn level(tau: &Volume<f32>, time: f32, reflections: &Reflections) -> Event {
    let crossings = isochron(tau, time).crossings;
    let near = |at: &Crossing, kind| reflections.nearest([at.x.into(), at.y.into()], at.z, kind, SNAP_REACH);
    let mut counts: BTreeMap<Extremum, usize> = BTreeMap::new();
    for found in crossings.iter().step_by(KIND_STEP).filter_map(|at| near(at, None)) {
        *counts.entry(found.kind).or_default() += 1;
    }
    let kind = counts.into_iter().max_by_key(|(kind, count)| (*count, std::cmp::Reverse(*kind))).map(|(kind, _)| kind);
    let nodes = crossings.iter().map(|at| {
        let is_there = kind.is_some_and(|kind| near(at, Some(kind)).is_some());
        Node { x: at.x, y: at.y, z: at.z, support: if is_there { Support::Snapped } else { Support::Between } }
    });
    Event { time, kind, nodes: nodes.collect() }
}

/// The sheets of a level of time as it is, smoothed.
pub(super) fn level_sheets(times: &Times, time: f32, geometry: &SurveyGeometry, blocks: &FaultNetwork) -> Vec<Sheet> {
    sheets(&level(&times.tau, time, &times.reflections), geometry, blocks, &[])
}

/// Distance from a level within which it passes a reflection, samples.
const SNAP_REACH: f32 = 1.5;
/// Crossings between those at which it is asked what a level follows.
const KIND_STEP: usize = 37;

/// The sheets of an event, one for each fault block. Where it crosses a trace twice in a block, the upper counts. Without
/// seeds the sheets are smoothed.
fn sheets(event: &Event, geometry: &SurveyGeometry, blocks: &FaultNetwork, seeds: &[Seed]) -> Vec<Sheet> {
    let grid = NodeGrid::of_survey(geometry);
    let mut sheets: BTreeMap<u16, Sheet> = BTreeMap::new();
    for at in &event.nodes {
        let (x, y) = (usize::from(at.x), usize::from(at.y));
        let block = blocks.block_at(Vec3::new(x as f32, y as f32, at.z));
        let sheet = sheets.entry(block).or_insert_with(|| Sheet {
            block: None,
            ..Sheet::new(grid, vec![f32::NAN; grid.count[0] * grid.count[1]], Quality::Hole)
        });
        let node = x * grid.count[1] + y;
        if sheet.depth[node].is_finite() {
            continue;
        }
        sheet.depth[node] = geometry.vertical.value_at(f64::from(at.z)) as f32;
        let is_seed = |seed: &Seed| seed.trace == [x, y] && (seed.z - at.z).abs() <= SEED_OFF;
        sheet.quality[node] = match at.support {
            _ if seeds.iter().any(is_seed) => Quality::Picked,
            Support::Tracked => Quality::Tracked,
            Support::Snapped => Quality::Snapped,
            Support::Between => Quality::Filled,
            Support::Assumed => Quality::Extrapolated,
        };
    }
    if seeds.is_empty() {
        sheets.values_mut().for_each(smooth);
    }
    sheets.into_values().collect()
}

/// Lays the sheets of a level that was chosen for its reflection over the islands in which they leave it.
fn lay_over_islands(sheets: &mut [Sheet], amplitudes: &Volume<f32>, geometry: &SurveyGeometry) {
    let sample = |depth: &f32| geometry.vertical.index_of(f64::from(*depth)) as f32;
    let mut samples: Vec<Vec<f32>> = sheets.iter().map(|sheet| sheet.depth.iter().map(sample).collect()).collect();
    let moved = bridge(&mut samples, amplitudes);
    for ((sheet, samples), moved) in sheets.iter_mut().zip(samples).zip(moved) {
        for n in (0..moved.len()).filter(|n| moved[*n]) {
            sheet.depth[n] = geometry.vertical.value_at(f64::from(samples[n])) as f32;
            sheet.quality[n] = Quality::Filled;
        }
    }
}

/// Distance between a place that was pointed at and the node that it made, samples.
const SEED_OFF: f32 = 3.0;

/// Nodes to either side over which a level of a picture is smoothed.
const SMOOTHED: usize = 3;

/// Replaces every depth by the median of those around it, each continued to its place along the slope there: steps stay,
/// single spikes go, and a steep flank keeps its slope up to where it ends.
fn smooth(sheet: &mut Sheet) {
    let [nu, nv] = sheet.grid.count;
    let depth = &sheet.depth;
    let range = |at: usize, count: usize| at.saturating_sub(SMOOTHED)..(at + SMOOTHED + 1).min(count);
    let smoothed = |n: usize| {
        if !depth[n].is_finite() {
            return f32::NAN;
        }
        let (u, v) = (n / nv, n % nv);
        let (us, vs) = (range(u, nu), range(v, nv));
        let places = || us.clone().flat_map(|u| vs.clone().map(move |v| (u, v)));
        let step = |to: usize, from: usize| depth[to] - depth[from];
        let along_u = median(places().filter(|(u, _)| u + 1 < us.end).map(|(u, v)| step((u + 1) * nv + v, u * nv + v)));
        let along_v = median(places().filter(|(_, v)| v + 1 < vs.end).map(|(u, v)| step(u * nv + v + 1, u * nv + v)));
        let [along_u, along_v] = [along_u, along_v].map(|slope| slope.unwrap_or(0.0));
        let continued = places()
            .map(|(i, j)| depth[i * nv + j] - along_u * (i as f32 - u as f32) - along_v * (j as f32 - v as f32));
        median(continued).unwrap_or(depth[n])
    };
    sheet.depth = (0..nu * nv).into_par_iter().map(smoothed).collect();
}

/// The median of those that are finite; `None` without any.
fn median(values: impl Iterator<Item = f32>) -> Option<f32> {
    let mut finite: Vec<f32> = values.filter(|value| value.is_finite()).collect();
    finite.sort_by(f32::total_cmp);
    finite.get(finite.len() / 2).copied()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Project;
    use crate::command::{Command, ComputeTime, PickFault, Rename};
    use crate::fixture::extracted;
    use ::time::TimeSettings;
    use survey::VerticalUnit;

    #[test]
    fn smoothing_takes_spikes_and_keeps_steps_and_the_slope_of_a_steep_flank_up_to_its_ends() {
        let geometry = SurveyGeometry::regular([30, 20, 200], 25.0, 4.0, VerticalUnit::Metres);
        // A flank of 12 m a trace with a step of 40 m, a hole, an end across it, and two spikes.
        let truth = |u: usize, v: usize| 12.0 * u as f32 - 5.0 * v as f32 + if u < 14 { 0.0 } else { 40.0 };
        let is_there = |u: usize, v: usize| u + v < 44 && !((4..7).contains(&u) && v < 6);
        let depths = |u: usize, v: usize| match (u, v) {
            (9, 11) | (20, 4) => truth(u, v) + 60.0,
            _ if is_there(u, v) => truth(u, v),
            _ => f32::NAN,
        };
        let all = (0..30).flat_map(|u| (0..20).map(move |v| depths(u, v))).collect();
        let mut sheet = Sheet::new(NodeGrid::of_survey(&geometry), all, Quality::Filled);
        smooth(&mut sheet);
        for (u, v) in (0..30).flat_map(|u| (0..20).map(move |v| (u, v))) {
            let found = sheet.depth[u * 20 + v];
            assert_eq!(found.is_finite(), is_there(u, v));
            assert!(!is_there(u, v) || (found - truth(u, v)).abs() < 0.01, "{u} {v}: {found}, not {}", truth(u, v));
        }
    }

    /// Whatever is drawn, a horizon, through a place of it.
    fn click(project: &mut Project, at: [f64; 3]) -> PickedByTime {
        let pick = PickByTime { level: TimeLevel::Through(at), horizon: "Chalk".to_owned() };
        let Effect::PickedByTime(done) = project.apply(&Command::PickByTime(pick), &Progress::silent()).unwrap() else {
            panic!("another effect");
        };
        done
    }

    #[test]
    fn what_both_sides_of_a_fault_do_not_tell_is_asked_kept_with_the_horizon_and_decided_by_a_click_there() {
        let folder = tempfile::tempdir().unwrap();
        let (size, quiet) = ([48, 32, 96], Progress::silent());
        let geometry = SurveyGeometry::regular(size, 25.0, 10.0, VerticalUnit::Metres);
        let mut volume = Volume::filled(size, 0.0f32);
        for (n, sample) in volume.samples_mut().iter_mut().enumerate() {
            let [x, y, z] = [n / 96 / 32, n / 96 % 32, n % 96].map(|at| at as f32);
            // Peaks every ten samples, all alike, six samples deeper beyond the fault.
            let t = z - 0.2 * y - if x > 23.5 { 6.0 } else { 0.0 };
            *sample = (t * std::f32::consts::TAU / 10.0).cos();
        }
        let mut project = extracted(folder.path(), &geometry, &volume);
        let at = |x: f64, y: f64, z: f64| {
            let lines = geometry.lines_from_voxel(DVec2::new(x, y));
            [lines.x, lines.y, geometry.vertical.value_at(z)]
        };
        let sticks = [0.0, 31.0].map(|y| vec![at(23.5, y, 0.0), at(23.5, y, 95.0)]).to_vec();
        let fault = PickFault { name: "Fault 2".to_owned(), sticks };
        let time = ComputeTime { name: "time".to_owned(), settings: TimeSettings::default(), memory_bytes: None };
        for command in [Command::PickFault(fault), Command::Time(time)] {
            project.apply(&command, &quiet).unwrap();
        }
        let told = click(&mut project, at(8.0, 16.0, 43.2));
        assert_eq!(told.queries.len(), 1);
        assert_eq!(told.queries[0].beyond, QueryBorder::Fault("Fault 2".to_owned()));
        assert!(
            told.assumed > 600 && told.to_string().contains("which reflection is it beyond \"Fault 2\"?"),
            "{told}"
        );
        let rename = Rename { noun: Noun::Fault, from: "Fault 2".to_owned(), to: "Main".to_owned() };
        project.apply(&Command::Rename(rename), &quiet).unwrap();
        let kept = project.document().horizons[0].origin.queries();
        assert_eq!(
            kept.iter().map(|query| &query.beyond).collect::<Vec<_>>(),
            [&QueryBorder::Fault("Main".to_owned())]
        );
        let decided = click(&mut project, at(40.0, 16.0, 59.2));
        assert_eq!((decided.queries.len(), decided.assumed), (0, 0), "{decided}");
        assert!(project.document().horizons[0].origin.queries().is_empty());
    }
}
