//! The steps of geologic time, in order.

use crate::cut::Cut;
use crate::error::TimeError;
use crate::hubs::Hubs;
use crate::isotonic::{Pools, regress};
use crate::links::Links;
use crate::solve::{System, Tie};
use crate::start;
use crate::throws::{Throw, throw_of, ties};
use interp::Surfaces;
use rayon::prelude::*;
use serde::{Deserialize, Serialize};
use survey::{Progress, Volume};

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
    /// Most steps of one minimisation. Default 60.
    pub most_steps: usize,
    /// Residual at which a minimisation ends, as a part of that at the start. Default 0.01.
    pub tolerance: f64,
}

impl Default for TimeSettings {
    fn default() -> Self {
        Self {
            fewest_vertices: 30,
            hub_weight: 1.0,
            steepness_weight: 1e-4,
            bend_weight: 0.01,
            most_steps: 60,
            tolerance: 1e-2,
        }
    }
}

/// Geologic time of a volume.
#[derive(Debug, Clone, PartialEq)]
pub struct GeologicTime {
    /// τ in samples, NaN where it is not known.
    pub tau: Volume<f32>,
    /// Share of the voxels at which τ did not increase downwards before it was made to.
    pub not_monotone: f64,
    /// Steps of the minimisations.
    pub steps: usize,
}

/// Misfit, in samples, at which a vertex counts half in the second minimisation.
const MISFIT: f32 = 1.5;

/// Computes geologic time from the candidates of a volume of amplitudes and the faults that cut it.
///
/// # Errors
/// [`TimeError`].
pub fn geologic_time(
    volume: &Volume<f32>,
    surfaces: &Surfaces,
    cuts: &[Cut],
    settings: &TimeSettings,
    progress: &Progress,
) -> Result<GeologicTime, TimeError> {
    let [nx, ny, nz] = surfaces.size;
    let mut hubs = Hubs::new(surfaces, cuts, settings.fewest_vertices, settings.hub_weight);
    let links = Links::new(&hubs, cuts);
    let mut near = start::neighbours(&hubs, &links);
    let ties = spanning_ties(volume, &hubs, &links, cuts, &mut near);
    let times = start::hub_times(hubs.len(), &near);
    let mut s = start::between_hubs(&hubs, &links, &times, progress)?;
    let mut steps = 0;
    progress.begin("solving for geologic time", 2 * settings.most_steps as u64);
    for round in 0..2 {
        let system = System {
            hubs: &hubs,
            links: &links,
            ties: &ties,
            anchors: &[],
            smoothness: [settings.steepness_weight, settings.bend_weight],
        };
        steps += system.minimise(&mut s, settings.most_steps, settings.tolerance, progress)?;
        if round == 0 {
            let times = system.at_vertices(&s, 1.0);
            let means = hubs.means(&times);
            for (v, time) in times.iter().enumerate() {
                let off = (time - means[hubs.hub[v] as usize]) / MISFIT;
                hubs.weight[v] = settings.hub_weight / (1.0 + off * off).powi(2);
            }
        }
    }
    let changed = make_monotone(&mut s, &hubs, &links);
    let tau = Volume::from_samples([nx, ny, nz], s).unwrap_or_else(|_| Volume::filled([nx, ny, nz], f32::NAN));
    Ok(GeologicTime { tau, not_monotone: changed as f64 / (nx * ny * nz).max(1) as f64, steps })
}

/// Steps between ties along a fault, lines and samples.
const TIE_STEP: [usize; 2] = [2, 4];
/// Weight of a tie: one for eight links.
const TIE_WEIGHT: f32 = 1.0;

/// Finds the throws of the faults and ties the parts that only these join, the surest first.
fn spanning_ties(
    volume: &Volume<f32>,
    hubs: &Hubs,
    links: &Links,
    cuts: &[Cut],
    near: &mut Vec<start::Neighbours>,
) -> Vec<Tie> {
    let mut throws: Vec<(usize, Throw)> =
        cuts.iter().enumerate().filter_map(|(f, cut)| Some((f, throw_of(volume, links, cut)?))).collect();
    throws.sort_by(|a, b| b.1.margin.total_cmp(&a.1.margin));
    let mut parts = start::parts(hubs.len(), near);
    let mut all = Vec::new();
    for (f, throw) in throws {
        if std::env::var("TRACE").is_ok() {
            let [l, z] = cuts[f].size;
            let t: Vec<f32> = [(0, 0.2), (0, 0.8), (l / 2, 0.5), (l - 1, 0.2), (l - 1, 0.8)].iter().map(|&(l, f)| throw.at(l, f * z as f32)).collect();
            eprintln!("fault {f}: correlation {:.3}, margin {:.3}, throws {t:?}", throw.correlation, throw.margin);
        }
        let ties = ties(&cuts[f], hubs.size, &throw, TIE_STEP, TIE_WEIGHT);
        let tied = start::tied(hubs, &ties);
        let joining = tied.iter().filter(|pair| parts.find(pair.hubs[0]) != parts.find(pair.hubs[1])).count();
        if 2 * joining > tied.len() {
            for pair in &tied {
                parts.union(pair.hubs[0], pair.hubs[1]);
            }
            near.extend(tied);
            all.extend(ties);
        }
    }
    all
}

/// Turns s into τ, made monotone on every trace between faults; returns how many voxels changed.
fn make_monotone(s: &mut [f32], hubs: &Hubs, links: &Links) -> usize {
    let [_, ny, nz] = hubs.size;
    s.par_chunks_mut(ny * nz)
        .enumerate()
        .map(|(x, line)| {
            let (mut pools, mut weights, mut changed) = (Pools::default(), vec![0.0f32; nz], 0);
            for (y, tau) in line.chunks_mut(nz).enumerate() {
                let trace = x * ny + y;
                weights.fill(0.1);
                for v in hubs.on_trace(trace) {
                    let weight = hubs.weight[v] * (hubs.of_hub(hubs.hub[v] as usize).len() as f32).ln();
                    weights[hubs.z[v].round() as usize] += weight;
                }
                tau.iter_mut().enumerate().for_each(|(z, s)| *s += z as f32);
                let mut from = 0;
                for z in 0..nz {
                    if z + 1 == nz || links.is_cut_below(trace * nz + z) {
                        changed += regress(&mut tau[from..=z], |n| weights[from + n], &mut pools);
                        from = z + 1;
                    }
                }
            }
            changed
        })
        .sum()
}
