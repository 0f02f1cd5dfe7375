//! Removes the pairs that lie on known faults.
//!
//! A pair only says that its fault passes between two rims. It lies on a known fault if that fault, as the
//! structural model extends it, passes between the rims or within [`REACH`] traces of one of them, strikes as
//! the pair does, and has not ended there: neither at another fault, nor at its tip along strike by more than
//! the same distance. Above and below the interpreted part a fault counts as continuing, because someone who
//! drew it on a few sections seldom drew all its depth, and a second surface beside the extended one would
//! cut slivers off the blocks. Such pairs are removed before the others are grouped into traces. So the
//! continuation beyond a known fault's tip is still proposed, while the remains of a trace beside a known
//! fault are not, unless they are long enough by themselves.

use super::Pair;
use glam::{DVec2, DVec3, Vec3};
use model::{FaultNetwork, FaultSurface};
use serde::{Deserialize, Serialize};
use std::collections::{BTreeMap, BTreeSet};
use survey::SurveyGeometry;

/// Largest distance of the rims of a pair from a known fault, traces: one and a half times the error of the
/// proposals of interpreted faults.
const REACH: f64 = 5.0;
/// Least cosine between the directions across of a pair and of a known fault; rims zigzag, so 45° off is
/// still parallel.
const PARALLEL: f64 = 0.7;

/// A known fault that was found again in the horizons.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Repeat {
    /// Name of the fault.
    pub fault: String,
    /// Count of pairs that lie on it.
    pub support: usize,
    /// Share of its length along which there are such pairs.
    pub along: f64,
    /// Median distance of their rims from it, traces; 0 where it passes between them.
    pub off_traces: f64,
    /// Their median throw, vertical units.
    pub throw: f64,
    /// Area of the offset, m²: the throw along their traces, summed over horizons.
    pub offset_m2: f64,
}

/// Known faults, their ends along strike, and the pairs found on them.
pub(super) struct Known<'a> {
    network: &'a FaultNetwork,
    geometry: &'a SurveyGeometry,
    /// First and last cell of the interpreted part along strike, per fault.
    ends: Vec<[f64; 2]>,
    on: Vec<On>,
}

/// A pair on a known fault.
struct On {
    fault: usize,
    /// Distance of the fault from the segment between the rims, traces.
    off: f64,
    /// Cell along the fault's strike.
    along: f64,
    pair: Pair,
}

impl On {
    fn throw(&self) -> f64 {
        f64::from(self.pair.throw.abs())
    }
}

impl<'a> Known<'a> {
    pub(super) fn of(network: &'a FaultNetwork, geometry: &'a SurveyGeometry) -> Self {
        Self {
            network,
            geometry,
            ends: network.surfaces().iter().map(|fault| ends(fault, geometry)).collect(),
            on: Vec::new(),
        }
    }

    /// Keeps the pairs that lie on a known fault and returns the others.
    pub(super) fn others(&mut self, pairs: Vec<Pair>) -> Vec<Pair> {
        let mut others = Vec::with_capacity(pairs.len());
        for pair in pairs {
            match self.nearest(&pair) {
                Some((fault, off, along)) => self.on.push(On { fault, off, along, pair }),
                None => others.push(pair),
            }
        }
        others
    }

    /// The fault on which a pair lies, its distance (traces), and the cell along strike.
    fn nearest(&self, pair: &Pair) -> Option<(usize, f64, f64)> {
        let place = Vec3::from_array(pair.at);
        let faults = self.network.surfaces().iter().enumerate();
        let near = faults.filter_map(|(f, fault)| {
            let p = place.as_dvec3();
            let gradient = fault.side_gradient(p).truncate();
            let (side, steep) = (fault.side(p), gradient.length());
            let parallel = gradient.dot(pair.across.as_dvec2()).abs() >= PARALLEL * steep;
            // From the segment between the rims.
            let off = (side.abs() / steep.max(1e-9) - 0.5 * f64::from(pair.heave.abs())).max(0.0);
            let reach = REACH * per_trace(fault, gradient.perp());
            let along = fault.frame(p).x;
            let within = along >= self.ends[f][0] - reach && along <= self.ends[f][1] + reach;
            let exists = self.network.truncation()[f].is_none()
                || self.network.existing(self.network.bits_at(place)) >> f & 1 == 1;
            (parallel && within && exists && off <= REACH).then_some((f, off, along))
        });
        near.min_by(|a, b| a.1.total_cmp(&b.1))
    }

    /// The known faults that were found again, largest first.
    pub(super) fn repeats(&self) -> Vec<Repeat> {
        let mut repeats: Vec<Repeat> = (0..self.ends.len()).filter_map(|fault| self.repeat(fault)).collect();
        repeats.sort_by(|a, b| b.offset_m2.total_cmp(&a.offset_m2));
        repeats
    }

    fn repeat(&self, fault: usize) -> Option<Repeat> {
        let surface = &self.network.surfaces()[fault];
        let metric = self.geometry.metric_from_voxel();
        let bin_m = 0.5 * (metric.x_axis.length() + metric.y_axis.length());
        let on = || self.on.iter().filter(|on| on.fault == fault);
        let median = |value: fn(&On) -> f64| {
            let mut values: Vec<f64> = on().map(value).collect();
            values.sort_by(f64::total_cmp);
            values.get(values.len() / 2).copied()
        };
        let (off_traces, throw_samples) = (median(|on| on.off)?, median(On::throw)?);
        let mut bins: BTreeMap<(usize, i64), (f64, f64)> = BTreeMap::new();
        for on in on() {
            let bin = (on.along * surface.spacing_m / bin_m).floor() as i64;
            let (sum, count) = bins.entry((on.pair.horizon, bin)).or_default();
            *sum += on.throw() * self.geometry.sample_m();
            *count += 1.0;
        }
        let seen: BTreeSet<i64> = bins.keys().map(|(_, bin)| *bin).collect();
        let length = (self.ends[fault][1] - self.ends[fault][0]) * surface.spacing_m / bin_m;
        Some(Repeat {
            fault: surface.name.clone(),
            support: on().count(),
            along: (seen.len() as f64 / length.max(1.0)).min(1.0),
            off_traces,
            throw: throw_samples * self.geometry.vertical.interval,
            offset_m2: bins.values().map(|(sum, count)| sum / count * bin_m).sum(),
        })
    }
}

/// Cells of a fault's grid along strike that a trace in direction `along` (voxels) spans.
fn per_trace(fault: &FaultSurface, along: DVec2) -> f64 {
    (fault.frame_from_voxel * along.normalize_or_zero().extend(0.0)).truncate().length()
}

/// First and last cell along strike (u) in which a fault was interpreted, within the survey.
fn ends(fault: &FaultSurface, geometry: &SurveyGeometry) -> [f64; 2] {
    let field = &fault.extent;
    let voxel_from_frame = fault.frame_from_voxel.inverse();
    let [nx, ny, _] = geometry.size().map(|count| count as f64 - 0.5);
    let place = |n: usize| {
        let (i, j) = ((n / field.size[1]) as f64, (n % field.size[1]) as f64);
        let [u, v] = [i + f64::from(field.origin[0]), j + f64::from(field.origin[1])];
        let voxel = voxel_from_frame * (DVec3::new(u, v, f64::from(fault.surface.z[n])) - fault.frame_offset);
        let inside = voxel.x >= -0.5 && voxel.y >= -0.5 && voxel.x <= nx && voxel.y <= ny;
        inside.then_some(u)
    };
    let real = field.z.iter().enumerate().filter(|(_, extent)| **extent >= 0.0);
    real.filter_map(|(n, _)| place(n))
        .fold([f64::INFINITY, f64::NEG_INFINITY], |[first, last], u| [first.min(u), last.max(u)])
}
