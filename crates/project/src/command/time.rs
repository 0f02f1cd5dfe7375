//! Geologic time as a volume of the project, and horizons that are its level surfaces.

use super::horizon::{Age, insert_made};
use super::{Effect, Noun, ProjectError};
use crate::content;
use crate::content::volume_facts::{self, Facts};
use crate::document::{Document, Polarity, Source, VolumeEntry};
use crate::folder::Draft;
use crate::interpretation::assembly;
use crate::interpretation::candidates::Candidates;
use ::time::{Crossing, Cut, Isochron, Reflections, TimeSettings, find_cuts, geologic_time, isochron};
use glam::Vec3;
use interp::Extremum;
use model::FaultNetwork;
use rayon::prelude::*;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use store::VolumeInfo;
use survey::{Horizon, NodeGrid, Progress, Quality, Sheet, SurveyGeometry, Volume};

/// What a volume of geologic time says that it holds.
const QUANTITY: &str = "geologic time";

/// Distance from an isochron within which a horizon goes to the reflection, samples.
const SNAP_REACH: f32 = 1.5;
/// The same for the place that was pointed at.
const SEED_REACH: f32 = 3.0;

/// Computes geologic time from the present extraction, its volume and the faults, and adds it to the project.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct ComputeTime {
    /// Name of the new volume.
    pub name: String,
    /// The settings.
    #[serde(default)]
    pub settings: TimeSettings,
}

/// The report of computed geologic time.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct TimeComputed {
    /// The new volume.
    pub volume: String,
    /// The volume of amplitudes.
    pub of: String,
    /// Number of drawn faults that cut it.
    pub faults: usize,
    /// Number of faults that were found, where none is drawn, and cut it.
    pub found: usize,
    /// Share of the voxels at which time is known, 0 to 1.
    pub known: f64,
}

impl std::fmt::Display for TimeComputed {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let Self { volume, of, faults, found, known } = self;
        let (faults, what) = if *faults > 0 { (faults, "drawn") } else { (found, "found") };
        write!(
            f,
            "volume '{volume}': geologic time of '{of}' across {faults} faults that were {what}, known at {:.1} % of the voxels",
            100.0 * known
        )?;
        if *known == 0.0 {
            write!(f, "; there are no candidates to find it from")?;
        }
        Ok(())
    }
}

impl ComputeTime {
    pub(super) fn execute(&self, draft: &mut Draft, progress: &Progress) -> Result<Effect, ProjectError> {
        draft.document.check_new_name(Noun::Volume, &self.name)?;
        let candidates = Candidates::load(draft.root(), &draft.document, progress)?;
        let from = amplitudes(&draft.document)?.clone();
        let geometry = draft.document.frame()?.clone();
        let volume = content::read_volume(draft.root(), &from, &geometry, progress)?;
        let network = assembly::blocks(draft.root(), &draft.document, progress)?;
        let drawn = Cut::of_network(&network, volume.size());
        let found_faults = if drawn.is_empty() {
            find_cuts(&candidates.forest.surfaces, self.settings.fewest_vertices, progress)?
        } else {
            Vec::new()
        };
        let (faults, found_count) = (drawn.len(), found_faults.len());
        let cuts = if drawn.is_empty() { found_faults } else { drawn };
        let found = geologic_time(&volume, &candidates.forest.surfaces, &cuts, &self.settings, progress)?;
        let (file, path) = draft.generation("volumes", &self.name, "zarr")?;
        let info = VolumeInfo {
            quantity: Some(QUANTITY.to_owned()),
            unit: Some("samples".to_owned()),
            source: Some(format!("{QUANTITY} of {}", from.name)),
            ..VolumeInfo::of(geometry)
        };
        store::write_volume(&path, &found.tau, &info, progress)?;
        let facts = Facts {
            name: self.name.clone(),
            file,
            polarity: Polarity::default(),
            source: Source {
                path: PathBuf::from(&from.file),
                bytes: from.source.bytes,
                reading: format!("{QUANTITY} of the volume {}", from.name),
            },
            geometry: None,
        };
        draft.document.volumes.push(volume_facts::entry(&path, facts, progress)?);
        Ok(Effect::TimeComputed(TimeComputed {
            volume: self.name.clone(),
            of: from.name,
            faults,
            found: found_count,
            known: found.known,
        }))
    }
}

/// The volume that the present extraction is of; the first on the project's lattice where that is not recorded.
fn amplitudes(document: &Document) -> Result<&VolumeEntry, ProjectError> {
    let extracted = document.extraction.as_ref().map(|entry| entry.volume.as_str());
    let named = document.volumes.iter().find(|entry| extracted == Some(entry.name.as_str()));
    named.or_else(|| document.volumes.iter().find(|entry| entry.geometry.is_none())).ok_or(ProjectError::NoVolume)
}

/// The newest volume of geologic time.
fn time_volume(root: &Path, document: &Document) -> Result<VolumeEntry, ProjectError> {
    for entry in document.volumes.iter().rev().filter(|entry| entry.geometry.is_none()) {
        let stored = content::open_volume(root, entry, document.frame()?)?;
        if stored.info().quantity.as_deref() == Some(QUANTITY) {
            return Ok(entry.clone());
        }
    }
    Err(ProjectError::NoTime)
}

/// Reads the newest geologic time and the amplitudes that it is of.
///
/// # Errors
/// [`ProjectError::NoTime`], data are damaged, or the user cancelled.
pub fn read_time(
    root: &Path,
    document: &Document,
    progress: &Progress,
) -> Result<(Volume<f32>, Volume<f32>), ProjectError> {
    let frame = document.frame()?;
    let tau = content::read_volume(root, &time_volume(root, document)?, frame, progress)?;
    Ok((tau, content::read_volume(root, amplitudes(document)?, frame, progress)?))
}

/// The level of geologic time that a horizon is.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum TimeLevel {
    /// The one through this inline, crossline and vertical value, or through the reflection beside it.
    Through([f64; 3]),
    /// The one of this value, samples. It stays where it is beside reflections, which is smoother than what was tracked.
    Of(f32),
}

/// Adds a horizon that is a level of geologic time.
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
    /// Number of nodes on a reflection.
    pub tracked: usize,
    /// Number of nodes between reflections.
    pub between: usize,
    /// Share of the survey's traces that it covers, 0 to 1.
    pub coverage: f64,
}

impl std::fmt::Display for PickedByTime {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let Self { horizon, tracked, between, coverage, sheets, .. } = self;
        write!(
            f,
            "horizon '{horizon}' by geologic time: {:.1} % of the traces in {sheets} sheets, {tracked} nodes on a \
             reflection (tracked), {between} between reflections (filled)",
            100.0 * coverage
        )
    }
}

impl PickByTime {
    pub(super) fn execute(&self, draft: &mut Draft, progress: &Progress) -> Result<Effect, ProjectError> {
        draft.document.check_new_name(Noun::Horizon, &self.horizon)?;
        let geometry = draft.document.frame()?.clone();
        let entry = time_volume(draft.root(), &draft.document)?;
        let tau = content::read_volume(draft.root(), &entry, &geometry, progress)?;
        let candidates = Candidates::load(draft.root(), &draft.document, progress)?;
        let blocks = assembly::blocks(draft.root(), &draft.document, progress)?;
        let reflections = Reflections::new(&candidates.forest.surfaces);
        let (seed, reading) = match self.level {
            TimeLevel::Through(at) => {
                let reading = format!("geologic time through inline {}, crossline {}, {}", at[0], at[1], at[2]);
                (seed(at, &geometry, &tau, &reflections)?, reading)
            }
            TimeLevel::Of(time) => (Seed { place: None, time, kind: None }, format!("geologic time {time}")),
        };
        let level = isochron(&tau, seed.time);
        if level.crossings.is_empty() {
            return Err(ProjectError::NoIsochron { time: seed.time });
        }
        let kind = seed.kind.or_else(|| kind_along(&level, &reflections));
        let snapped = |at: &Crossing| {
            let trace = [usize::from(at.x), usize::from(at.y)];
            kind.and_then(|kind| reflections.nearest(trace, at.z, Some(kind), SNAP_REACH)).map(|found| found.z)
        };
        let sheets = sheets(&level, &geometry, &blocks, snapped, &seed);
        let count = |quality: Quality| -> usize {
            sheets.iter().flat_map(|sheet| &sheet.quality).filter(|found| **found == quality).count()
        };
        let (tracked, between) = (count(Quality::Tracked) + count(Quality::Picked), count(Quality::Filled));
        let mut traces: Vec<[u16; 2]> = level.crossings.iter().map(|at| [at.x, at.y]).collect();
        traces.dedup();
        let coverage = traces.len() as f64 / (tau.size()[0] * tau.size()[1]) as f64;
        let source = Source { path: PathBuf::from(&entry.file), bytes: entry.source.bytes, reading };
        let count = sheets.len();
        let horizon = Horizon::new(self.horizon.clone(), sheets);
        let position = insert_made(draft, &horizon, &Age::ByDepth, source, progress)?;
        Ok(Effect::PickedByTime(PickedByTime {
            horizon: self.horizon.clone(),
            position,
            time: seed.time,
            sheets: count,
            tracked,
            between,
            coverage,
        }))
    }
}

/// Where a horizon begins.
struct Seed {
    /// The trace and the sample that were pointed at.
    place: Option<([usize; 2], f32)>,
    time: f32,
    /// What it follows.
    kind: Option<Extremum>,
}

/// The place that was pointed at, on the reflection beside it if there is one.
fn seed(
    at: [f64; 3],
    geometry: &SurveyGeometry,
    tau: &Volume<f32>,
    reflections: &Reflections,
) -> Result<Seed, ProjectError> {
    let place = geometry.voxel_from_lines(at[0], at[1]).round();
    let z = geometry.vertical.index_of(at[2]);
    let [nx, ny, nz] = tau.size();
    let inside = |at: f64, count: usize| at >= 0.0 && at <= (count - 1) as f64;
    if !(inside(place.x, nx) && inside(place.y, ny) && inside(z, nz)) {
        return Err(ProjectError::outside(at, geometry));
    }
    let trace = [place.x as usize, place.y as usize];
    let near = reflections.nearest(trace, z as f32, None, SEED_REACH);
    let z = near.map_or(z as f32, |found| found.z).clamp(0.0, (nz - 1) as f32);
    let (values, low) = (tau.trace(trace[0], trace[1]), (z as usize).min(nz.saturating_sub(2)));
    let time = values[low] + (z - low as f32) * (values[(low + 1).min(nz - 1)] - values[low]);
    if !time.is_finite() {
        return Err(ProjectError::TimeUnknown { at });
    }
    Ok(Seed { place: Some((trace, z)), time, kind: near.map(|found| found.kind) })
}

/// Traces between those at which it is asked what a level follows.
const KIND_STEP: usize = 37;

/// What a level follows at most traces; `None` where nothing reflects along it.
fn kind_along(level: &Isochron, reflections: &Reflections) -> Option<Extremum> {
    let mut counts: BTreeMap<Extremum, usize> = BTreeMap::new();
    for at in level.crossings.iter().step_by(KIND_STEP) {
        if let Some(found) = reflections.nearest([at.x.into(), at.y.into()], at.z, None, SNAP_REACH) {
            *counts.entry(found.kind).or_default() += 1;
        }
    }
    counts.into_iter().max_by_key(|(kind, count)| (*count, std::cmp::Reverse(*kind))).map(|(kind, _)| kind)
}

/// The sheets of an isochron, one for each fault block. Where it crosses a trace twice in a block, the upper counts.
fn sheets(
    level: &Isochron,
    geometry: &SurveyGeometry,
    blocks: &FaultNetwork,
    snapped: impl Fn(&Crossing) -> Option<f32>,
    seed: &Seed,
) -> Vec<Sheet> {
    let grid = NodeGrid::of_survey(geometry);
    let mut sheets: BTreeMap<u16, Sheet> = BTreeMap::new();
    for at in &level.crossings {
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
        let reflection = snapped(at);
        let z = reflection.filter(|_| seed.place.is_some()).unwrap_or(at.z);
        sheet.depth[node] = geometry.vertical.value_at(f64::from(z)) as f32;
        sheet.quality[node] = match reflection {
            _ if seed.place.is_some_and(|(trace, at)| trace == [x, y] && (z - at).abs() < 0.5) => Quality::Picked,
            Some(_) => Quality::Tracked,
            None => Quality::Filled,
        };
    }
    if seed.place.is_none() {
        sheets.values_mut().for_each(smooth);
    }
    sheets.into_values().collect()
}

/// Nodes to either side over which a level of a picture is smoothed.
const SMOOTHED: usize = 3;

/// Replaces every depth by the median of those around it: steps stay, single spikes go.
fn smooth(sheet: &mut Sheet) {
    let [nu, nv] = sheet.grid.count;
    let range = |at: usize, count: usize| at.saturating_sub(SMOOTHED)..(at + SMOOTHED + 1).min(count);
    let median = |n: usize| {
        let places = range(n / nv, nu).flat_map(|u| range(n % nv, nv).map(move |v| u * nv + v));
        let mut near: Vec<f32> = places.map(|n| sheet.depth[n]).filter(|depth| depth.is_finite()).collect();
        near.sort_by(f32::total_cmp);
        if sheet.depth[n].is_finite() { near[near.len() / 2] } else { f32::NAN }
    };
    sheet.depth = (0..nu * nv).into_par_iter().map(median).collect();
}
