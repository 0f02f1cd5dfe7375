//! Events: a level of τ together with the reflections that it runs along.
//!
//! A level of τ alone is as exact as τ. Where a patch of a reflection lies along most of the level, the event goes
//! through all of the patch, also where τ is a few samples off; beside other reflections of its kind it goes to them;
//! elsewhere it is the level. With more than one seed the level varies from place to place (`claims`): a further seed
//! corrects what the first got wrong around it, and in another fault block all of the block; what lies along the first
//! seed's own patch stays. Nothing is solved for again. Space: voxels.

use crate::claims::{Along, Holding, levels};
use crate::cuts::Cut;
use crate::isochron::crossings;
use crate::reflections::Reflections;
use crate::solve::interpolate;
use interp::{Extremum, UnionFind};
use rayon::prelude::*;
use serde::{Deserialize, Serialize};
use survey::Volume;

/// What holds a node of an event.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
pub enum Support {
    /// A patch of a reflection that lies along the level, or that a seed lies on.
    Tracked,
    /// A reflection of the same kind within one and a half samples of the level.
    Snapped,
    /// The level of τ alone.
    Between,
    /// Beyond a fault or a jump across which nothing tells that it is the same reflection ([`Event::examine`]).
    Assumed,
}

/// A node of an event.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Node {
    /// Inline index.
    pub x: u16,
    /// Crossline index.
    pub y: u16,
    /// Fractional sample.
    pub z: f32,
    /// What holds it.
    pub support: Support,
}

/// A place that an event is to go through.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Seed {
    /// Inline and crossline index.
    pub trace: [usize; 2],
    /// Fractional sample.
    pub z: f32,
}

/// An event: nodes ordered by (x, y, z). Between two faults a trace has one at most.
#[derive(Debug, Clone, PartialEq)]
pub struct Event {
    /// τ at the first seed, samples.
    pub time: f32,
    /// What it follows; `None` where nothing reflects along it.
    pub kind: Option<Extremum>,
    /// Its nodes.
    pub nodes: Vec<Node>,
}

/// Distance from the level within which an event goes to a reflection, samples.
const SNAP_REACH: f32 = 1.5;
/// Distance from a seed within which it goes to a reflection, samples.
const SEED_REACH: f32 = 3.0;
/// What a sample of distance from the seed counts against a share of the traces.
const FARTHER: f32 = 0.15;
/// What it counts that there is no reflection on the seed's own trace.
const BARE: f32 = 0.05;
/// Score below which nothing reflects where a seed points.
const LEAST_ALONG: f32 = 0.2;
/// Distance from the level within which a vertex of a patch speaks for the patch, samples.
const ALONG: f32 = 2.0;
/// Distance from the level beyond which a vertex speaks against its patch, and is left where it is, samples.
const OFF: f32 = 6.0;
/// Least share of the vertices of a patch that lie along the level.
const LEAST_SHARE: f64 = 0.6;
/// Traces between two patches up to which one goes on in the other.
const JOINING: usize = 2;
/// Traces around a seed within which its patch tells its time.
const SEED_AROUND: usize = 8;
/// What a seed may point at: a reflection, or the level through the seed.
#[derive(Debug, Clone, Copy)]
struct SeedTarget {
    z: f32,
    kind: Option<Extremum>,
    hub: Option<u32>,
}

/// The level of an event on a trace, and what it follows there.
#[derive(Debug, Clone, Copy)]
struct TraceLevel {
    time: f32,
    kind: Option<Extremum>,
}

/// A seed that was looked at.
struct PlacedSeed {
    seed: Seed,
    hub: Option<u32>,
    kind: Option<Extremum>,
    time: f32,
}

impl Reflections {
    /// The event through seeds in τ, a volume that is NaN where time is not known; the first seed says what it follows, a
    /// further one only where nothing of that kind reflects beside it.
    /// `None` where time is not known at a seed, and without seeds.
    ///
    /// Cost: one pass over τ and the vertices of all candidates.
    pub fn event(&self, tau: &Volume<f32>, seeds: &[Seed], cuts: &[Cut]) -> Option<Event> {
        let mut placed: Vec<PlacedSeed> = Vec::new();
        for seed in seeds {
            let target = self.target(tau, seed, placed.first().map(|first| first.kind));
            placed.push(self.place(tau, seed, &target)?);
        }
        let first = placed.first()?;
        let own: Vec<u32> = placed.iter().filter_map(|seed| seed.hub).collect();
        if placed.len() == 1 {
            let of_all = |_| TraceLevel { time: first.time, kind: first.kind };
            return Some(self.along(tau, of_all, first.time, first.kind, &own));
        }
        let mut holdings: Vec<Holding> = placed.iter().map(|seed| self.holding(tau, seed)).collect();
        holdings[0].others = self.patches_along(tau, first, &holdings[0].depth, cuts);
        let level = levels(&holdings, cuts, [tau.size()[0], tau.size()[1]]);
        let on = |trace: usize| TraceLevel { time: level[trace].0, kind: placed[level[trace].1].kind };
        Some(self.along(tau, on, first.time, first.kind, &own))
    }

    /// What a seed points at. The reflections within reach on its trace, and the level through the seed itself, are
    /// compared by the share of the traces around it on which a reflection of their kind lies on their level, less their
    /// distance: a patch that noise broke at the seed is found by what lies around. `kind` is that of the first seed.
    fn target(&self, tau: &Volume<f32>, seed: &Seed, kind: Option<Option<Extremum>>) -> SeedTarget {
        let hubs = self.hubs();
        let [nx, ny, nz] = hubs.size;
        let [x, y] = seed.trace;
        let own = hubs.on_trace(x * ny + y).filter(|&v| (hubs.z[v] - seed.z).abs() <= SEED_REACH);
        let mut targets: Vec<SeedTarget> = own
            .map(|v| SeedTarget { z: hubs.z[v], kind: Some(hubs.kind[hubs.hub[v] as usize]), hub: Some(hubs.hub[v]) })
            .collect();
        let plain = SeedTarget { z: seed.z.clamp(0.0, (nz - 1) as f32), kind: None, hub: None };
        targets.extend(
            [Extremum::Peak, Extremum::Trough, Extremum::Zero].map(|kind| SeedTarget { kind: Some(kind), ..plain }),
        );
        let score = |target: &SeedTarget| {
            let time = interpolate(tau.trace(x, y), target.z);
            let (mut on, mut all) = (0.0f32, 0.0f32);
            for (x, y) in around(seed, [nx, ny]) {
                for at in crossings(tau.trace(x, y), time) {
                    on += f32::from(self.nearest([x, y], at, target.kind, SNAP_REACH).is_some());
                    all += 1.0;
                }
            }
            let bare = if target.hub.is_none() { BARE } else { 0.0 };
            on / all.max(1.0) - FARTHER * (target.z - seed.z).abs() - bare
        };
        let scored: Vec<(f32, &SeedTarget)> = targets.iter().map(|target| (score(target), target)).collect();
        let best_of = |is: &dyn Fn(&SeedTarget) -> bool| {
            scored.iter().filter(|(_, target)| is(target)).copied().max_by(|a, b| a.0.total_cmp(&b.0))
        };
        // What the first seed follows, if it reflects beside this one.
        let alike = kind.flatten().and_then(|kind| {
            let is_beside = |target: &SeedTarget| target.kind == Some(kind) && (target.z - seed.z).abs() <= SNAP_REACH;
            best_of(&is_beside).filter(|(score, _)| *score >= LEAST_ALONG)
        });
        match alike.or_else(|| best_of(&|_| true)) {
            Some((score, target)) if score >= LEAST_ALONG => *target,
            _ => SeedTarget { kind: kind.flatten(), ..plain },
        }
    }

    /// The time of a seed: the median over its patch around it.
    fn place(&self, tau: &Volume<f32>, seed: &Seed, target: &SeedTarget) -> Option<PlacedSeed> {
        let hubs = self.hubs();
        let [nx, ny, _] = hubs.size;
        let [x, y] = seed.trace;
        let mut time = interpolate(tau.trace(x, y), target.z);
        if let Some(hub) = target.hub {
            let mut times: Vec<f32> = around(seed, [nx, ny])
                .flat_map(|(x, y)| hubs.on_trace(x * ny + y).map(move |v| (x, y, v)))
                .filter(|&(_, _, v)| hubs.hub[v] == hub)
                .map(|(x, y, v)| interpolate(tau.trace(x, y), hubs.z[v]))
                .filter(|time| time.is_finite())
                .collect();
            times.sort_by(f32::total_cmp);
            time = times.get(times.len() / 2).copied().unwrap_or(time);
        }
        let seed = Seed { z: target.z, ..*seed };
        time.is_finite().then_some(PlacedSeed { seed, hub: target.hub, kind: target.kind, time })
    }

    /// What a seed holds: its trace, and where its patch lies along its level.
    fn holding(&self, tau: &Volume<f32>, PlacedSeed { seed, hub, time, .. }: &PlacedSeed) -> Holding {
        let hubs = self.hubs();
        let [nx, ny, _] = hubs.size;
        let crossing = |trace: usize| crossings(tau.trace(trace / ny, trace % ny), *time).next();
        let along: Vec<Option<f32>> = (0..nx * ny).into_par_iter().map(crossing).collect();
        let is_held = |trace: &usize| {
            let Some(level) = along[*trace] else { return false };
            hubs.on_trace(*trace).any(|v| Some(hubs.hub[v]) == *hub && (hubs.z[v] - level).abs() <= OFF)
        };
        let patch = (0..nx * ny).filter(is_held).collect();
        let depth = along.iter().map(|level| level.unwrap_or(seed.z)).collect();
        Holding { time: *time, hub: *hub, trace: seed.trace[0] * ny + seed.trace[1], patch, others: Vec::new(), depth }
    }

    /// The patches but a seed's own that lie along the seed's level, which crosses each trace at a depth.
    fn patches_along(
        &self,
        tau: &Volume<f32>,
        PlacedSeed { hub, kind, time, .. }: &PlacedSeed,
        depth: &[f32],
        cuts: &[Cut],
    ) -> Vec<Along> {
        let hubs = self.hubs();
        let levels = self.levels(tau, |_| *time);
        let belongs = self.belonging(&levels, |_| *kind);
        let mut patches = vec![Vec::new(); hubs.len()];
        for (trace, levels) in levels.iter().enumerate() {
            for v in hubs.on_trace(trace).filter(|&v| belongs[hubs.hub[v] as usize]) {
                if off(levels, hubs.z[v]) <= OFF {
                    patches[hubs.hub[v] as usize].push(trace);
                }
            }
        }
        let Some(own) = hub else {
            let kept = patches.into_iter().filter(|patch| !patch.is_empty());
            return kept.map(|traces| Along { traces, is_joined: true }).collect();
        };
        let joined = self.joined(&patches, *own as usize, depth, cuts);
        patches[*own as usize].clear();
        let kept = patches.into_iter().zip(joined).filter(|(patch, _)| !patch.is_empty());
        kept.map(|(traces, is_joined)| Along { traces, is_joined }).collect()
    }

    /// Which patches, by their traces, steps from trace to trace along the level join to one of them.
    fn joined(&self, patches: &[Vec<usize>], own: usize, depth: &[f32], cuts: &[Cut]) -> Vec<bool> {
        let hubs = self.hubs();
        let [nx, ny, _] = hubs.size;
        // On each trace the patch that is closest to the level, and how far below it it lies.
        let mut at: Vec<Option<(u32, f32)>> = vec![None; nx * ny];
        for (hub, traces) in patches.iter().enumerate() {
            for &trace in traces {
                let off =
                    hubs.on_trace(trace).filter(|&v| hubs.hub[v] as usize == hub).map(|v| hubs.z[v] - depth[trace]);
                let Some(off) = off.min_by(|a, b| a.abs().total_cmp(&b.abs())) else { continue };
                if at[trace].is_none_or(|(_, other)| off.abs() < other.abs()) {
                    at[trace] = Some((hub as u32, off));
                }
            }
        }
        let mut sets = UnionFind::new(patches.len());
        for trace in 0..nx * ny {
            let Some((hub, off)) = at[trace] else { continue };
            let (x, y) = (trace / ny, trace % ny);
            for i in x..(x + JOINING + 1).min(nx) {
                for j in y.saturating_sub(JOINING)..(y + JOINING + 1).min(ny) {
                    let Some((other, there)) = at[i * ny + j].filter(|(other, _)| *other != hub) else { continue };
                    let [za, zb] = [depth[trace] + off, depth[i * ny + j] + there];
                    let is_apart = cuts.iter().any(|cut| cut.separates([x, y], za, [i, j], zb));
                    if (off - there).abs() <= SNAP_REACH && !is_apart {
                        sets.union(hub, other);
                    }
                }
            }
        }
        let first = sets.find(own as u32);
        (0..patches.len() as u32).map(|hub| sets.find(hub) == first).collect()
    }

    /// Where a level that may vary from trace to trace crosses each trace.
    fn levels(&self, tau: &Volume<f32>, level: impl Fn(usize) -> f32 + Sync) -> Vec<Vec<f32>> {
        let [nx, ny, _] = self.hubs().size;
        let on = |trace: usize| crossings(tau.trace(trace / ny, trace % ny), level(trace)).collect();
        (0..nx * ny).into_par_iter().map(on).collect()
    }

    /// Which patches of the kind that is followed on their traces lie along a level with most of their vertices.
    fn belonging(&self, levels: &[Vec<f32>], kind: impl Fn(usize) -> Option<Extremum>) -> Vec<bool> {
        let hubs = self.hubs();
        // For each patch, how many of its vertices lie along the level, and how many have a level on their trace at all.
        let mut counts = vec![[0u32; 2]; hubs.len()];
        for (trace, levels) in levels.iter().enumerate() {
            for v in hubs.on_trace(trace).filter(|&v| kind(trace) == Some(hubs.kind[hubs.hub[v] as usize])) {
                let off = off(levels, hubs.z[v]);
                let count = &mut counts[hubs.hub[v] as usize];
                count[0] += u32::from(off <= ALONG);
                count[1] += u32::from(off.is_finite());
            }
        }
        let most = |[along, there]: [u32; 2]| along > 0 && f64::from(along) >= LEAST_SHARE * f64::from(there);
        counts.into_iter().map(most).collect()
    }

    /// The event along a level that may vary from trace to trace.
    fn along(
        &self,
        tau: &Volume<f32>,
        on: impl Fn(usize) -> TraceLevel + Sync,
        time: f32,
        kind: Option<Extremum>,
        own: &[u32],
    ) -> Event {
        let hubs = self.hubs();
        let [nx, ny, _] = hubs.size;
        let levels = self.levels(tau, |trace| on(trace).time);
        let belongs = self.belonging(&levels, |trace| on(trace).kind);
        let nodes = (0..nx * ny)
            .into_par_iter()
            .flat_map_iter(|trace| {
                let kind = on(trace).kind;
                let nearest = |at: f32, reach: f32, patch: bool| {
                    hubs.on_trace(trace)
                        .filter(|&v| kind == Some(hubs.kind[hubs.hub[v] as usize]) && (hubs.z[v] - at).abs() <= reach)
                        .filter(|&v| !patch || belongs[hubs.hub[v] as usize] || own.contains(&hubs.hub[v]))
                        .min_by(|&v, &w| (hubs.z[v] - at).abs().total_cmp(&(hubs.z[w] - at).abs()))
                        .map(|v| hubs.z[v])
                };
                let mut nodes: Vec<Node> = levels[trace]
                    .iter()
                    .map(|&at| {
                        let tracked = nearest(at, OFF, true).map(|z| (z, Support::Tracked));
                        let snapped = || nearest(at, SNAP_REACH, false).map(|z| (z, Support::Snapped));
                        let (z, support) = tracked.or_else(snapped).unwrap_or((at, Support::Between));
                        Node { x: (trace / ny) as u16, y: (trace % ny) as u16, z, support }
                    })
                    .collect();
                nodes.dedup_by(|b, a| a.z >= b.z);
                nodes
            })
            .collect();
        Event { time, kind, nodes }
    }
}

/// Distance of a sample from the level closest to it, samples; infinite where there is none.
fn off(levels: &[f32], z: f32) -> f32 {
    levels.iter().map(|at| (at - z).abs()).min_by(f32::total_cmp).unwrap_or(f32::INFINITY)
}

/// The traces around a seed.
fn around(seed: &Seed, count: [usize; 2]) -> impl Iterator<Item = (usize, usize)> {
    let [x, y] = [0, 1].map(|axis| {
        let at = seed.trace[axis];
        at.saturating_sub(SEED_AROUND)..(at + SEED_AROUND + 1).min(count[axis])
    });
    x.flat_map(move |x| y.clone().map(move |y| (x, y)))
}
