//! Faults proposed where none are interpreted, from the horizons assembled so far.
//!
//! A tracked horizon ends at a fault and goes on behind it, higher or lower. So:
//!
//! 1. `edges`: the rims of each horizon's pieces, with the way out and the plane the piece lies in there.
//! 2. `pairs`: rims that face one another with an offset. The middle of a pair lies on the fault; the offset of the two planes there is the
//!    throw. Rims without an offset are those of holes.
//! 3. `traces`: pairs of one horizon that follow one another along strike, with throws of one sign, are the fault's trace on it; traces on several
//!    horizons that lie one above the other on one steep surface are one fault.
//! 4. `surface`: a smooth surface through them, the least squares quadratic of the distance across strike over strike and depth.
//!    It goes on to where the throw, continued linearly, is nothing; to the walls that its traces reach; up and down to the next
//!    horizon that passes it unbroken, or through the volume.
//!
//!
//! Pairs that lie on a fault of the project (`known`) are taken out before 3: it is not proposed again.
//!
//! Proposals come largest first, by the area of what they tore apart: the throw along their traces, summed over horizons ([`Proposal::offset_m2`]). On real
//! surveys many are small, where picks are noisy, scatter about their surface, or fit one without a break in the data: those are minor and come last.
//!
//! Semblance is evidence, not a source: its mean on the surface is told beside that on both sides of it. It gives a fault its dip where a single
//! horizon cannot, and what is a bend of one horizon and nothing else is left out unless semblance is less on it than beside. Spaces: rims and pairs are voxel, surfaces
//! metric (m).

mod bends;
mod edges;
mod known;
mod pairs;
mod surface;
#[cfg(test)]
mod tests;
mod traces;

pub use known::Repeat;
pub use pairs::Pair;

use crate::reassembly::VoxelSheet;
use glam::{DVec2, DVec3};
use model::FaultNetwork;
use serde::{Deserialize, Serialize};
use survey::{Cancelled, Fault, Progress, SurveyGeometry, TriangleMesh, Volume};

/// How faults are looked for.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct ProposeSettings {
    /// Farthest that two facing rims may be apart, traces; default 14. The heave of a flat fault with a large throw is the limit.
    pub reach: usize,
    /// Smallest throw, samples; default 2. Smaller ones are lost in the noise of tracked rims.
    pub min_throw: f32,
    /// Shortest trace on a horizon, traces; default 12.
    pub min_length: f32,
    /// Smallest dip, degrees (in metres); default 30.
    pub min_dip_deg: f64,
}

impl Default for ProposeSettings {
    fn default() -> Self {
        Self { reach: 14, min_throw: 2.0, min_length: 12.0, min_dip_deg: 30.0 }
    }
}

/// A horizon as evidence.
#[derive(Debug, Clone, Copy)]
pub struct Evidence<'a> {
    /// Its name.
    pub name: &'a str,
    /// Its sheets, assembled without faults or with them.
    pub sheets: &'a [VoxelSheet],
}

/// A fault that horizons speak for.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Proposal {
    /// Number by which it is accepted, from 1; the largest first.
    pub id: u32,
    /// A name to begin with.
    pub name: String,
    /// Its surface in the world.
    pub mesh: TriangleMesh,
    /// Direction it strikes in, degrees clockwise from north, below 180.
    pub strike_deg: f64,
    /// Mean dip, degrees.
    pub dip_deg: f64,
    /// Whether the hanging wall has moved up.
    pub reverse: bool,
    /// Median throw and the one that 95 % do not exceed, vertical units.
    pub throw: [f64; 2],
    /// Inline and crossline numbers of the two ends of its trace at middle depth.
    pub ends: [[f64; 2]; 2],
    /// Shallowest and deepest vertical value of its surface.
    pub depth: [f64; 2],
    /// Names of the horizons that it offsets.
    pub horizons: Vec<String>,
    /// Facing pairs of rim nodes that speak for it.
    pub support: usize,
    /// RMS distance of these from its surface, m.
    pub misfit_m: f64,
    /// Throw along its traces, summed over horizons: the area of what it tore apart, m².
    #[serde(default)]
    pub offset_m2: f64,
    /// Whether it is one of the many small ones, its pairs scatter, or the data show no break on it.
    #[serde(default)]
    pub is_minor: bool,
    /// Mean semblance on it and on both sides of it, if there was a volume.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub semblance: Option<[f32; 2]>,
}

impl Proposal {
    /// The fault, under the name it is accepted by.
    pub fn fault(&self, name: &str) -> Fault {
        Fault { name: name.to_owned(), mesh: self.mesh.clone(), truncated_by: None }
    }
}

/// What was found.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct Found {
    /// New faults, the largest first, minor ones last.
    pub proposals: Vec<Proposal>,
    /// Known faults that were found again, and are not proposed, the largest first.
    pub repeats: Vec<Repeat>,
}

/// Share of all offset that small proposals hold together, at most.
const MINOR: f64 = 0.2;
/// RMS distance of pairs from their surface above which a proposal is minor, traces; large faults of Penobscot are up to 2.7 off, where tracking follows an
/// event of the graben.
const SCATTER: f64 = 3.0;
/// How much less semblance is on a fault that only bends one horizon than beside it.
const BREAK: f32 = 0.02;

/// Looks for faults that offset `horizons`, other than those of `known`. `semblance` is a volume of the survey's size.
///
/// Cost: a window of [`ProposeSettings::reach`] around each rim node.
///
/// # Errors
/// [`Cancelled`].
pub fn propose_faults(
    horizons: &[Evidence],
    geometry: &SurveyGeometry,
    known: &FaultNetwork,
    semblance: Option<&Volume<f32>>,
    settings: &ProposeSettings,
    progress: &Progress,
) -> Result<Found, Cancelled> {
    let [nx, ny, _] = geometry.size();
    let metric = geometry.metric_from_voxel();
    progress.begin("looking for faults", horizons.len() as u64);
    let mut known = known::Known::of(known, geometry);
    let mut found = Vec::new();
    for (h, horizon) in horizons.iter().enumerate() {
        let pieces = edges::Pieces::of(horizon.sheets, [nx, ny]);
        let mut pairs = pairs::facing(&pieces, h, settings);
        pairs.extend(bends::of(horizon.sheets, [nx, ny], h, settings));
        found.extend(traces::along_strike(known.others(pairs), settings));
        progress.step(1)?;
    }
    let clusters = traces::across_horizons(found, metric, settings);
    let mut proposals = Vec::new();
    for cluster in clusters {
        progress.check()?;
        let Some(surface) = surface::Surface::through(&cluster, geometry, semblance, settings) else { continue };
        let surface = surface.extended(&cluster, horizons, geometry);
        let proposal = describe(&surface, &cluster, horizons, geometry, semblance);
        let seen = proposal.semblance.is_none_or(|[on, beside]| on < beside - BREAK);
        if seen || proposal.horizons.len() > 1 || !cluster.iter().all(|pair| pair.bend) {
            proposals.push(proposal);
        }
    }
    let repeats = known.repeats();
    let bin_m = 0.5 * (metric.x_axis.length() + metric.y_axis.length());
    rank(&mut proposals, repeats.iter().map(|repeat| repeat.offset_m2).sum(), bin_m);
    Ok(Found { proposals, repeats })
}

/// Sorts, numbers and names proposals. Minor are the last of them that together hold no more than [`MINOR`] of all offset, theirs and what known faults
/// repeated, those whose pairs are more than [`SCATTER`] traces off their surface, and those on which semblance is no less than beside.
fn rank(proposals: &mut [Proposal], repeated: f64, bin_m: f64) {
    proposals.sort_by(|a, b| b.offset_m2.total_cmp(&a.offset_m2));
    let mut rest: f64 = proposals.iter().map(|proposal| proposal.offset_m2).sum();
    let all = rest + repeated;
    for proposal in proposals.iter_mut() {
        let whole = proposal.semblance.is_some_and(|[on, beside]| on >= beside);
        proposal.is_minor = whole || proposal.misfit_m > SCATTER * bin_m || rest <= MINOR * all;
        rest -= proposal.offset_m2;
    }
    proposals.sort_by_key(|proposal| proposal.is_minor);
    for (n, proposal) in proposals.iter_mut().enumerate() {
        proposal.id = n as u32 + 1;
        proposal.name = format!("Fault {}", n + 1);
    }
}

/// Everything to be said of a surface.
fn describe(
    surface: &surface::Surface,
    cluster: &[Pair],
    horizons: &[Evidence],
    geometry: &SurveyGeometry,
    semblance: Option<&Volume<f32>>,
) -> Proposal {
    let mut throws: Vec<f64> = cluster.iter().map(|pair| f64::from(pair.throw.abs())).collect();
    throws.sort_by(f64::total_cmp);
    let interval = geometry.vertical.interval;
    let mut names: Vec<usize> = cluster.iter().map(|pair| pair.horizon).collect();
    names.sort_unstable();
    names.dedup();
    let (dips_to_positive, run) = surface.run();
    let side = cluster.iter().map(|pair| surface.throw_across(pair)).sum::<f64>();
    let strike = surface.strike();
    let bearing = strike.x.atan2(strike.y).to_degrees().rem_euclid(180.0);
    Proposal {
        id: 0,
        name: String::new(),
        mesh: surface.mesh(geometry),
        strike_deg: bearing,
        dip_deg: (1.0 / run.max(1e-9)).atan().to_degrees(),
        // The hanging wall is the side it dips to.
        reverse: (side > 0.0) != dips_to_positive,
        throw: [throws[throws.len() / 2] * interval, throws[throws.len() * 95 / 100] * interval],
        ends: surface.ends().map(|p| {
            let voxel = geometry.metric_from_voxel().inverse() * p;
            geometry.lines_from_voxel(DVec2::new(voxel.x, voxel.y)).to_array()
        }),
        depth: surface.depths_m().map(|z| geometry.vertical.value_at(z / geometry.sample_m())),
        horizons: names.iter().map(|&h| horizons[h].name.to_owned()).collect(),
        support: cluster.len(),
        misfit_m: surface.misfit_m,
        offset_m2: surface.offset_m2(cluster, geometry),
        is_minor: false,
        semblance: semblance.map(|volume| surface::semblance_on(surface, geometry, volume)),
    }
}

/// A voxel position in metres.
fn metres(metric: glam::DMat3, p: [f32; 3]) -> DVec3 {
    metric * DVec3::new(f64::from(p[0]), f64::from(p[1]), f64::from(p[2]))
}
