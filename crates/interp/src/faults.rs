//! Faults proposed from the horizons assembled so far.
//!
//! A tracked horizon ends at a fault and continues behind it, higher or lower. So:
//!
//! 1. `edges`: the rims of each horizon's pieces, each with the direction out of the piece and the plane of
//!    the piece there. `bends` adds places where a horizon was tracked across a fault.
//! 2. `pairs`: rims that face one another with an offset. The middle of a pair lies on the fault; the offset
//!    of the two planes there is the throw. Rims without an offset belong to holes.
//! 3. `traces`: pairs of one horizon that follow one another along strike, with throws of one sign, form the
//!    trace of the fault on that horizon. Traces on several horizons that lie one above the other on one
//!    steep surface form one fault.
//! 4. `surface`: a smooth surface through the pairs, the least-squares quadratic of the distance across
//!    strike as a function of strike and depth. Along strike it is extended to where the linearly
//!    extrapolated throw is 0, or to the outer boundary if its traces reach it. Up and down it is extended to
//!    the next horizon that passes it unbroken, or through the volume.
//!
//! Pairs that lie on a fault of the project (`known`) are removed before step 3, so that such a fault is not
//! proposed again.
//!
//! Proposals are sorted by the area of the offset, i.e. the throw along their traces, summed over horizons
//! ([`Proposal::offset_m2`]), largest first. On real surveys many proposals are small, at noisy picks,
//! scatter about their surface, or fit a surface on which the data have no break. These are minor and come
//! last.
//!
//! Semblance is evidence, not a source: a proposal states its mean on the surface and on both sides of it. It
//! gives a fault its dip where a single horizon cannot. A proposal that only consists of bends of a single
//! horizon is dropped unless semblance is lower on it than on both sides. Spaces: rims and pairs are in
//! voxels, surfaces in metres.

mod bends;
mod edges;
mod pairs;
mod repeats;
mod surface;
#[cfg(test)]
mod tests;
mod traces;

pub(crate) use pairs::Pair;
pub use repeats::Repeat;

use crate::reassembly::VoxelSheet;
use glam::{DVec2, DVec3};
use model::FaultNetwork;
use serde::{Deserialize, Serialize};
use survey::{Cancelled, Fault, Progress, SurveyGeometry, TriangleMesh, Volume};

/// Settings of the search for faults.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct ProposeSettings {
    /// Largest distance between two facing rims, traces; default 14. It limits the heave of a flat fault with
    /// a large throw.
    pub reach: usize,
    /// Smallest throw, samples; default 2. Smaller ones are lost in the noise of tracked rims.
    pub min_throw: f32,
    /// Shortest trace on a horizon, traces; default 12.
    pub min_length: f32,
    /// Smallest dip in metric space, degrees; default 30.
    pub min_dip_deg: f64,
}

impl Default for ProposeSettings {
    fn default() -> Self {
        Self { reach: 14, min_throw: 2.0, min_length: 12.0, min_dip_deg: 30.0 }
    }
}

/// A horizon in which faults are searched.
#[derive(Debug, Clone, Copy)]
pub struct Evidence<'a> {
    /// Name of the horizon.
    pub name: &'a str,
    /// Its sheets, assembled with or without faults.
    pub sheets: &'a [VoxelSheet],
}

/// A fault proposed from horizons.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Proposal {
    /// Number by which it is accepted, from 1 in the order of the proposals.
    pub id: u32,
    /// A default name.
    pub name: String,
    /// Its surface, in world coordinates.
    pub mesh: TriangleMesh,
    /// Direction of its strike, degrees clockwise from north, in [0, 180).
    pub strike_deg: f64,
    /// Mean dip, degrees.
    pub dip_deg: f64,
    /// Whether the hanging wall has moved up.
    pub reverse: bool,
    /// Median and 95 % quantile of its throw, vertical units.
    pub throw: [f64; 2],
    /// Inline and crossline numbers of the two ends of its trace at middle depth.
    pub ends: [[f64; 2]; 2],
    /// Shallowest and deepest vertical value of its surface.
    pub depth: [f64; 2],
    /// Names of the horizons that it offsets; none where it was found in the volume.
    pub horizons: Vec<String>,
    /// Count of pairs of rim nodes on it, or of cells of its surface.
    pub support: usize,
    /// RMS distance of these pairs from its surface, m.
    pub misfit_m: f64,
    /// Area of the offset, m²: the throw along its traces, summed over horizons.
    #[serde(default)]
    pub offset_m2: f64,
    /// Area of its surface, m².
    #[serde(default)]
    pub area_m2: f64,
    /// How sure its two sides make it, 0 to 1; `None` where no volume was there to measure.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub evidence: Option<f32>,
    /// Whether it is one of the many small proposals, its pairs scatter, or the data show no break on it.
    #[serde(default)]
    pub is_minor: bool,
    /// Whether beds end at it while no throw makes its two sides match: a great fault may do that, and a boundary of rock.
    #[serde(default)]
    pub is_cut: bool,
    /// Mean semblance on it and on both sides of it, if there was a semblance volume.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub semblance: Option<[f32; 2]>,
}

impl Proposal {
    /// What it rests on, in words.
    pub fn rests_on(&self) -> String {
        let mut text = if self.is_cut {
            "beds end at it, but no throw makes its two sides match: it may be a fault, or a boundary of rock"
                .to_owned()
        } else if self.horizons.is_empty() {
            "its two sides match after the throw".to_owned()
        } else {
            format!("{} pairs on {}, {:.0} m off", self.support, self.horizons.join(", "), self.misfit_m)
        };
        if let Some(evidence) = self.evidence.filter(|_| !self.is_cut) {
            text += &format!(", evidence {evidence:.2}");
        }
        text
    }

    /// Its sense and throw in words; `symbol` is the unit of throws.
    pub fn throw_in_words(&self, symbol: &str) -> String {
        if self.is_cut {
            return "cut without a throw".to_owned();
        }
        let kind = if self.reverse { "reverse" } else { "normal" };
        format!("{kind}, throw {:.0} {symbol} (up to {:.0})", self.throw[0], self.throw[1])
    }

    /// The proposal as a fault of the given name.
    pub fn fault(&self, name: &str) -> Fault {
        Fault::new(name, self.mesh.clone())
    }
}

/// The result of [`propose_faults`].
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct FoundFaults {
    /// New faults, largest first and minor ones last.
    pub proposals: Vec<Proposal>,
    /// Known faults that were found again and are not proposed, largest first.
    pub repeats: Vec<Repeat>,
}

/// Largest share of the total offset that the smallest proposals together hold to be minor.
const MINOR: f64 = 0.2;
/// RMS distance of pairs from their surface above which a proposal is minor, traces. Large faults of the
/// Penobscot survey are up to 2.7 off, where tracking follows an event of the graben.
const SCATTER: f64 = 3.0;
/// Least difference of the mean semblance beside and on a fault that consists of bends of a single horizon.
const BREAK: f32 = 0.02;

/// Searches for faults that offset `horizons`, other than those of `known`. `semblance` is a volume of the
/// survey's size.
///
/// Cost: a window of [`ProposeSettings::reach`] around each rim node.
///
/// # Errors
/// [`Cancelled`].
///
/// # Examples
///
/// ```
/// use interp::faults::{Evidence, ProposeSettings, propose_faults};
/// use interp::reassembly::VoxelSheet;
/// use model::FaultNetwork;
/// use survey::{Progress, SurveyGeometry, VerticalUnit};
///
/// // A flat horizon that is 6 samples (60 m) deeper from inline index 30 on: a fault with that throw.
/// let geometry = SurveyGeometry::regular([60, 60, 60], 25.0, 10.0, VerticalUnit::Metres);
/// let mut sheet = VoxelSheet::empty(0, 60 * 60);
/// for (trace, z) in sheet.z.iter_mut().enumerate() {
///     *z = if trace / 60 < 30 { 20.0 } else { 26.0 };
/// }
/// let horizons = [Evidence { name: "H", sheets: &[sheet] }];
/// let (known, settings) = (FaultNetwork::none(), ProposeSettings::default());
/// let found = propose_faults(&horizons, &geometry, &known, None, &settings, &Progress::silent())?;
/// assert_eq!(found.proposals.len(), 1);
/// assert!((found.proposals[0].throw[0] - 60.0).abs() < 1e-3);
/// # Ok::<(), survey::Cancelled>(())
/// ```
pub fn propose_faults(
    horizons: &[Evidence],
    geometry: &SurveyGeometry,
    known: &FaultNetwork,
    semblance: Option<&Volume<f32>>,
    settings: &ProposeSettings,
    progress: &Progress,
) -> Result<FoundFaults, Cancelled> {
    let [nx, ny, _] = geometry.size();
    let metric = geometry.metric_from_voxel();
    progress.begin("searching for faults", horizons.len() as u64);
    let mut known = repeats::Known::of(known, geometry);
    let mut found = Vec::new();
    for (h, horizon) in horizons.iter().enumerate() {
        let pieces = edges::HorizonRims::of(horizon.sheets, [nx, ny]);
        let mut pairs = pairs::facing(&pieces, h, settings);
        pairs.extend(bends::of(horizon.sheets, [nx, ny], h, settings));
        found.extend(traces::along_strike(known.others(pairs), settings));
        progress.step(1)?;
    }
    let clusters = traces::across_horizons(found, metric, settings);
    let mut proposals = Vec::new();
    for cluster in clusters {
        progress.check()?;
        let Some(surface) = surface::FittedFault::through(&cluster, geometry, semblance, settings) else { continue };
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
    Ok(FoundFaults { proposals, repeats })
}

/// Sorts, numbers and names proposals. Three kinds are minor: the smallest ones that together hold at most
/// [`MINOR`] of the total offset (of the proposals and of the known faults found again), those whose pairs
/// are more than [`SCATTER`] traces off their surface, and those on which semblance is not lower than beside.
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

/// The proposal of a surface.
fn describe(
    surface: &surface::FittedFault,
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
    let mesh = surface.mesh(geometry);
    let area_m2 = area_m2(&mesh, geometry);
    let bearing = strike.x.atan2(strike.y).to_degrees().rem_euclid(180.0);
    Proposal {
        id: 0,
        name: String::new(),
        mesh,
        strike_deg: bearing,
        dip_deg: (1.0 / run.max(1e-9)).atan().to_degrees(),
        // The hanging wall is the side towards which the fault dips.
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
        area_m2,
        evidence: None,
        is_minor: false,
        is_cut: false,
        semblance: semblance.map(|volume| surface::semblance_on(surface, geometry, volume)),
    }
}

/// Area of a mesh in world coordinates, m².
fn area_m2(mesh: &TriangleMesh, geometry: &SurveyGeometry) -> f64 {
    let metric = geometry.metric_from_voxel();
    let at = |n: u32| metric * geometry.voxel_from_world(mesh.vertices[n as usize]);
    mesh.triangles.iter().map(|&[a, b, c]| 0.5 * (at(b) - at(a)).cross(at(c) - at(a)).length()).sum()
}

/// A voxel position in metres.
fn metres(metric: glam::DMat3, p: [f32; 3]) -> DVec3 {
    metric * DVec3::new(f64::from(p[0]), f64::from(p[1]), f64::from(p[2]))
}
