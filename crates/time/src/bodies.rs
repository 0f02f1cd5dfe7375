//! Isolated bodies: a strong event of limited extent that meets another one all around its rim.
//!
//! A flat spot ends where it meets the top of the gas above it, and the top of a build-up where it comes down to its
//! base; beds run on. So a body is told by two patches: one that ends within the survey on all sides, and one above or
//! below it from which it is farthest in its midst and closest at its rim, in every direction. Layers that thin
//! towards one side, fragments of beds between faults and lenses of noise do not close all around, and a trough of
//! beds below an erosion surface sags more than what lies over it bulges. Of all pairs at one place the body is the
//! one that is strongest for how far it closes. Levels of time cannot draw it: each goes on beyond the rim, as a drape
//! over the beds there.
//!
//! Not told: bodies that reach the edge of the survey or a fault's zone along more than a tenth of their rim, whose
//! event is broken into patches that each cover little of it, and those with one reflection alone.

mod plan;

use crate::hubs::Hubs;
use crate::reflections::Reflections;
use plan::Plan;
use rayon::prelude::*;
use std::collections::BTreeMap;
use std::f32::consts::PI;
use survey::Volume;

/// A body between two events that meet at its rim.
#[derive(Debug, Clone, PartialEq)]
pub struct Body {
    /// The traces on which it has a thickness, ordered.
    pub columns: Vec<Column>,
    /// Mean amplitude of its stronger event, over the root mean square of the volume.
    pub strength: f32,
}

/// A body on one trace.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Column {
    /// Inline and crossline index.
    pub trace: [usize; 2],
    /// Fractional sample of its top.
    pub top: f32,
    /// Fractional sample of its base.
    pub base: f32,
}

/// Fewest and largest share of the traces of a patch that bounds a body.
const FEWEST_TRACES: usize = 100;
const LARGEST_SHARE: f64 = 0.5;
/// Traces from the rim to the midst of a body, at least.
const LEAST_DEPTH: usize = 5;
/// Half the width of a gap in a patch that is closed, traces.
const CLOSED: usize = 2;
/// Traces along the edge of the survey that belong to it.
const EDGE: usize = 2;
/// Share of the rim that may lie at the edge of the survey.
const MOST_EDGE: f64 = 0.1;
/// Least strength of the stronger and of the weaker event, over the root mean square amplitude.
const LEAST_STRENGTH: f32 = 1.5;
const LEAST_OTHER: f32 = 0.7;
/// Share of a patch's traces on which the other event is known, and on which it is on one side.
const LEAST_SHARED: f64 = 0.7;
const LEAST_ON_SIDE: f64 = 0.97;
/// Traces from the rim that tell how close the events come to one another.
const RIM: usize = 3;
/// Share of the greatest distance from the rim from which on traces are the midst.
const MIDST: f32 = 0.6;
/// Least thickness in the midst, samples.
const LEAST_THICKNESS: f32 = 4.0;
/// Thickness at the rim, as a share of that in the midst, at most: on the whole, and in each direction.
const MOST_AT_RIM: f32 = 0.55;
const MOST_IN_DIRECTION: f32 = 0.65;
/// Directions in which the rim is looked at, and how many of them close at least.
const DIRECTIONS: usize = 16;
const LEAST_CLOSED: usize = 14;
/// Least correlation of thickness and distance from the rim.
const LEAST_CORRELATION: f32 = 0.75;
/// Share of a body's traces on which a stronger body may lie.
const MOST_SHARED: f64 = 0.1;
/// Thickness of a body at its thinnest, samples.
const THINNEST: f32 = 0.5;

/// A patch that ends within the survey on all sides.
struct Island {
    plan: Plan,
    /// Steps from the rim of each cell.
    depth: Vec<usize>,
    /// Fractional sample on each cell, NaN where it has a gap.
    z: Vec<f32>,
}

/// An event that bounds a body with an island.
struct Other {
    hub: u32,
    /// Distance down to it on cells of the island, samples.
    down: Vec<(usize, f32)>,
}

impl Reflections {
    /// The isolated bodies of a volume, the strongest first; none shares a place with another.
    ///
    /// Cost: for each patch of a middling size, the candidates on its traces.
    pub fn bodies(&self, volume: &Volume<f32>) -> Vec<Body> {
        let hubs = self.hubs();
        let strength = strengths(hubs, volume);
        let mut found: Vec<(f32, Body)> = (0..hubs.len())
            .into_par_iter()
            .filter(|&hub| strength[hub] >= LEAST_OTHER)
            .filter_map(|hub| body_of(hubs, hub, &strength, volume))
            .collect();
        found.sort_by(|(a, _), (b, _)| b.total_cmp(a));
        let mut chosen: Vec<Body> = Vec::new();
        for (_, body) in found {
            if !chosen.iter().any(|other| other.shares(&body)) {
                chosen.push(body);
            }
        }
        chosen
    }
}

impl Body {
    /// Whether it takes up more than a little of the room of another one.
    fn shares(&self, other: &Self) -> bool {
        let own: BTreeMap<[usize; 2], &Column> = self.columns.iter().map(|column| (column.trace, column)).collect();
        let meets =
            |column: &&Column| own.get(&column.trace).is_some_and(|own| own.top < column.base && column.top < own.base);
        other.columns.iter().filter(meets).count() as f64 > MOST_SHARED * other.columns.len() as f64
    }

    /// Takes the samples of a volume in the body, and so many above and below it, away: they are NaN afterwards.
    pub fn blank(&self, volume: &mut Volume<f32>, beside: f32) {
        let nz = volume.size()[2];
        for Column { trace: [x, y], top, base } in &self.columns {
            let first = (top - beside).ceil().max(0.0) as usize;
            let end = ((base + beside).floor().max(-1.0) + 1.0) as usize;
            volume.trace_mut(*x, *y)[first.min(nz)..end.min(nz)].fill(f32::NAN);
        }
    }
}

/// Mean amplitude along each hub, over the root mean square of the volume.
fn strengths(hubs: &Hubs, volume: &Volume<f32>) -> Vec<f32> {
    let [_, ny, nz] = hubs.size;
    let (energy, count) = volume
        .samples()
        .iter()
        .filter(|sample| sample.is_finite())
        .fold((0.0f64, 0u64), |(energy, count), sample| (energy + f64::from(sample * sample), count + 1));
    let rms = (energy / count.max(1) as f64).sqrt().max(f64::MIN_POSITIVE) as f32;
    let amplitudes: Vec<f32> = (0..hubs.size[0] * ny)
        .flat_map(|trace| hubs.on_trace(trace).map(move |v| (trace, v)))
        .map(|(trace, v)| volume.at(trace / ny, trace % ny, (hubs.z[v].round().max(0.0) as usize).min(nz - 1)))
        .map(|amplitude| if amplitude.is_finite() { amplitude } else { 0.0 })
        .collect();
    hubs.means(&amplitudes).into_iter().map(|mean| mean.abs() / rms).collect()
}

/// The body that a patch bounds, with the strengths of its events together, as far as they close.
fn body_of(hubs: &Hubs, hub: usize, strength: &[f32], volume: &Volume<f32>) -> Option<(f32, Body)> {
    let island = Island::of(hubs, hub, volume)?;
    let others = island.others(hubs, hub);
    let (evidence, best) = others
        .iter()
        .filter(|other| strength[other.hub as usize] >= LEAST_OTHER)
        .filter(|other| strength[hub].max(strength[other.hub as usize]) >= LEAST_STRENGTH)
        .filter_map(|other| {
            let closes = island.closes(&other.down)?;
            Some((closes * (strength[hub] + strength[other.hub as usize]), other))
        })
        .max_by(|(a, _), (b, _)| a.total_cmp(b))?;
    let body = Body { columns: island.columns(&best.down), strength: strength[hub].max(strength[best.hub as usize]) };
    (!body.columns.is_empty()).then_some((evidence, body))
}

impl Island {
    /// A patch, if it is one.
    fn of(hubs: &Hubs, hub: usize, volume: &Volume<f32>) -> Option<Self> {
        let [nx, ny, _] = hubs.size;
        let vertices = hubs.of_hub(hub);
        let most = LARGEST_SHARE * (nx * ny) as f64;
        if vertices.len() < FEWEST_TRACES || vertices.len() as f64 > most {
            return None;
        }
        let traces: Vec<[usize; 2]> = vertices.iter().map(|&v| hubs.trace_of(v)).map(|n| [n / ny, n % ny]).collect();
        let plan = Plan::around(&traces, CLOSED + 1, [nx, ny]);
        let mut z = vec![f32::NAN; plan.covers.len()];
        for (trace, &v) in traces.iter().zip(vertices) {
            z[plan.cell(*trace)] = hubs.z[v as usize];
        }
        let plan = plan.closed(CLOSED).whole();
        let depth = plan.depths([nx, ny]);
        let rim: Vec<usize> = (0..depth.len()).filter(|&cell| plan.covers[cell] && depth[cell] == 1).collect();
        let is_edge = |cell: &&usize| {
            let [x, y] = plan.trace(**cell);
            let beside = [x.saturating_sub(EDGE), (x + EDGE).min(nx - 1)].map(|x| volume.is_live(x, y));
            let across = [y.saturating_sub(EDGE), (y + EDGE).min(ny - 1)].map(|y| volume.is_live(x, y));
            let is_at = |at: usize, count: usize| at < EDGE || at + EDGE >= count;
            is_at(x, nx) || is_at(y, ny) || !beside.into_iter().chain(across).all(|live| live)
        };
        let at_edge = rim.iter().filter(is_edge).count();
        let is_island = at_edge as f64 <= MOST_EDGE * rim.len() as f64
            && depth.iter().max().is_some_and(|deepest| *deepest >= LEAST_DEPTH);
        is_island.then_some(Self { plan, depth, z })
    }

    /// The events that lie above or below most of it.
    fn others(&self, hubs: &Hubs, own: usize) -> Vec<Other> {
        let ny = hubs.size[1];
        let known: Vec<usize> =
            (0..self.z.len()).filter(|&cell| self.plan.covers[cell] && self.z[cell].is_finite()).collect();
        let mut others: BTreeMap<u32, Vec<(usize, f32)>> = BTreeMap::new();
        for &cell in &known {
            let [x, y] = self.plan.trace(cell);
            for v in hubs.on_trace(x * ny + y).filter(|&v| hubs.hub[v] as usize != own) {
                others.entry(hubs.hub[v]).or_default().push((cell, hubs.z[v] - self.z[cell]));
            }
        }
        let lies_along = |down: &[(usize, f32)]| {
            let below = down.iter().filter(|(_, down)| *down > 0.0).count();
            let on_side = below.max(down.len() - below) as f64;
            down.len() as f64 >= LEAST_SHARED * known.len() as f64 && on_side >= LEAST_ON_SIDE * down.len() as f64
        };
        others.into_iter().filter(|(_, down)| lies_along(down)).map(|(hub, down)| Other { hub, down }).collect()
    }

    /// How far another event closes towards the rim, up to 1 where they meet; `None` where their distance is not greatest in
    /// the midst and least at the rim, in every direction.
    fn closes(&self, down: &[(usize, f32)]) -> Option<f32> {
        let deepest = self.depth.iter().copied().max().unwrap_or(0) as f32;
        let thickness = |is_counted: &dyn Fn(usize) -> bool| {
            median(down.iter().filter(|(cell, _)| is_counted(*cell)).map(|(_, down)| down.abs()).collect())
        };
        let is_rim = |cell: usize| (1..=RIM).contains(&self.depth[cell]);
        let midst = thickness(&|cell| self.depth[cell] as f32 >= MIDST * deepest)?;
        let rim = thickness(&is_rim)?;
        if midst < LEAST_THICKNESS || rim > MOST_AT_RIM * midst {
            return None;
        }
        let covered = (0..self.depth.len()).filter(|&cell| self.plan.covers[cell]);
        let count = covered.clone().count() as f32;
        let [x, y] =
            covered.map(|cell| self.plan.trace(cell)).fold([0.0; 2], |[a, b], [x, y]| [a + x as f32, b + y as f32]);
        let centre = [x / count, y / count];
        let direction = |cell: usize| {
            let [x, y] = self.plan.trace(cell);
            let turn = (y as f32 - centre[1]).atan2(x as f32 - centre[0]) / (2.0 * PI) + 0.5;
            (turn * DIRECTIONS as f32) as usize % DIRECTIONS
        };
        let closed = (0..DIRECTIONS)
            .filter_map(|n| thickness(&|cell| is_rim(cell) && direction(cell) == n))
            .filter(|at_rim| *at_rim <= MOST_IN_DIRECTION * midst)
            .count();
        let pairs = down.iter().map(|(cell, down)| [self.depth[*cell] as f32, down.abs()]);
        let is_closed = closed >= LEAST_CLOSED && correlation(pairs) >= LEAST_CORRELATION && self.bulges(down, deepest);
        is_closed.then_some(1.0 - rim / midst)
    }

    /// Whether the upper event rises more from the rim to the midst than the lower one falls: a mound, not a trough.
    fn bulges(&self, down: &[(usize, f32)], deepest: f32) -> bool {
        let middle = |is_counted: &dyn Fn(f32) -> bool| {
            let counted = down.iter().filter(|(cell, _)| is_counted(self.depth[*cell] as f32));
            median(counted.map(|(cell, down)| self.z[*cell] + 0.5 * down).collect())
        };
        let midst = middle(&|depth| depth >= MIDST * deepest);
        let rim = middle(&|depth| depth >= 1.0 && depth <= RIM as f32);
        midst.zip(rim).is_some_and(|(midst, rim)| midst <= rim)
    }

    /// The body between it and another event, on every trace of it.
    fn columns(&self, down: &[(usize, f32)]) -> Vec<Column> {
        let is_below = down.iter().map(|(_, down)| f64::from(*down)).sum::<f64>() > 0.0;
        let mut other = vec![f32::NAN; self.z.len()];
        for (cell, down) in down {
            other[*cell] = self.z[*cell] + down;
        }
        let (own, other) = (self.plan.filled(self.z.clone()), self.plan.filled(other));
        let (top, base) = if is_below { (own, other) } else { (other, own) };
        let cells = (0..top.len()).filter(|&cell| self.plan.covers[cell]);
        cells
            .map(|cell| Column {
                trace: self.plan.trace(cell),
                top: top[cell],
                base: base[cell].max(top[cell] + THINNEST),
            })
            .filter(|column| column.top.is_finite() && column.base.is_finite())
            .collect()
    }
}

/// The median; `None` of less than two values.
fn median(mut values: Vec<f32>) -> Option<f32> {
    values.sort_by(f32::total_cmp);
    (values.len() > 1).then(|| values[values.len() / 2])
}

/// The correlation of two values.
fn correlation(pairs: impl Iterator<Item = [f32; 2]> + Clone) -> f32 {
    let count = pairs.clone().count().max(1) as f64;
    let sums = pairs.clone().fold([0.0f64; 2], |[a, b], [x, y]| [a + f64::from(x), b + f64::from(y)]);
    let means = sums.map(|sum| sum / count);
    let moments = pairs.fold([0.0f64; 3], |[xx, xy, yy], [x, y]| {
        let (x, y) = (f64::from(x) - means[0], f64::from(y) - means[1]);
        [xx + x * x, xy + x * y, yy + y * y]
    });
    let scale = (moments[0] * moments[2]).sqrt();
    if scale > 0.0 { (moments[1] / scale) as f32 } else { 0.0 }
}
