//! Counts the picks that a horizon takes: until 95 % of its nodes are covered, with at least 98 % of the
//! picked vertices within a sample of it.
//!
//! A pick is one seed and one climb. Two interpreters are simulated:
//!
//! - The **oracle** knows the truth and always takes the node, at any level of any tree, that covers most of
//!   what is not covered yet without reducing the precision below the required one. It is a greedy bound of
//!   what the trees allow.
//! - The **replay** knows where the horizon is, as someone does who sees it on a section, and nothing else.
//!   It puts its seed into the middle of the largest gap and climbs to the highest valid node. It stands for
//!   a user who never corrects a pick.
//!
//! Space: voxels.

use super::{EvaluateSettings, Parts, TruthIndex, share};
use candidates::Forest;
use glam::Vec3;
use interp::assembly::{ClimbSettings, Selection, highest_valid, leaf_at};
use model::FaultNetwork;
use rayon::prelude::*;
use serde::Serialize;
use std::collections::VecDeque;
use survey::{Cancelled, Progress};
use synth::SynthTruth;

/// Conditions for a horizon to be complete, and settings of picks.
#[derive(Debug, Clone, PartialEq)]
pub struct PickSettings {
    /// Required share of covered nodes; default 0.95.
    pub coverage: f64,
    /// Required share of the picked vertices that lie on the horizon; default 0.98.
    pub precision: f64,
    /// Most picks of one horizon; default 60.
    pub most_picks: usize,
    /// Distance from a seed within which a leaf is found, voxels; default 1.5.
    pub max_distance: f32,
    /// Limits of the climbs of the replay.
    pub climb: ClimbSettings,
}

impl Default for PickSettings {
    fn default() -> Self {
        Self { coverage: 0.95, precision: 0.98, most_picks: 60, max_distance: 1.5, climb: ClimbSettings::default() }
    }
}

/// The result of one interpreter.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct PickCount {
    /// Count of picks.
    pub picks: usize,
    /// Share of the horizon's nodes covered.
    pub coverage: f64,
    /// Share of the picked vertices that lie on the horizon.
    pub precision: f64,
    /// Whether coverage and precision are as required.
    pub reached: bool,
}

/// The picks of one horizon.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct PickScore {
    /// Name of the horizon.
    pub name: String,
    /// Count of its parts; each takes at least one pick.
    pub parts: usize,
    /// The interpreter who knows the truth.
    pub oracle: PickCount,
    /// The interpreter who does not.
    pub replay: PickCount,
}

/// Simulates both interpreters on every horizon. `blocks` are the interpreted faults; [`FaultNetwork::none`]
/// for raw data. `index` is of the same truth.
///
/// # Errors
/// [`Cancelled`].
pub fn count_picks(
    forest: &Forest,
    truth: &SynthTruth,
    index: &TruthIndex,
    blocks: &FaultNetwork,
    evaluate: &EvaluateSettings,
    settings: &PickSettings,
    progress: &Progress,
) -> Result<Vec<PickScore>, Cancelled> {
    progress.begin("picking", truth.horizons.len() as u64);
    let score = |(h, horizon): (usize, &synth::TruthHorizon)| {
        let target = PickTarget::of(forest, truth, index, h, evaluate.tolerance);
        let parts = Parts::of(truth, h);
        let mut sizes = vec![0; parts.empty().len()];
        for &n in &target.events {
            let event = index.events()[n];
            if let Some(part) = parts.at(index.trace_of(n), event.block) {
                sizes[part] += 1;
            }
        }
        let score = PickScore {
            name: horizon.name.clone(),
            parts: sizes.into_iter().filter(|&size| size >= evaluate.min_part_traces).count(),
            oracle: target.oracle(settings),
            replay: target.replay(blocks, settings, progress)?,
        };
        progress.step(1)?;
        Ok(score)
    };
    truth.horizons.par_iter().enumerate().map(score).collect()
}

/// A horizon to pick.
struct PickTarget<'a> {
    forest: &'a Forest,
    index: &'a TruthIndex,
    blocks: usize,
    /// Its nodes: indices of events, ascending.
    events: Vec<usize>,
    /// The node (an index into `events`) on which each vertex lies, or `NONE`.
    on: Vec<u32>,
}

/// No node.
const NONE: u32 = u32::MAX;

/// Radius (traces) around a seed without a result in which no other seed is tried.
const DEAD_RADIUS: usize = 3;

/// The nodes and vertices picked so far.
struct PickedSet {
    covered: Vec<bool>,
    count: usize,
    seen: Vec<bool>,
    vertices: usize,
    on: usize,
}

impl<'a> PickTarget<'a> {
    fn of(forest: &'a Forest, truth: &SynthTruth, index: &'a TruthIndex, horizon: usize, tolerance: f32) -> Self {
        let wanted = index.reflector_index(truth.reflector_of(horizon)).expect("the index is of this truth");
        let is_wanted = |n: &usize| usize::from(index.events()[*n].reflector) == wanted;
        let events: Vec<usize> = (0..index.events().len()).filter(is_wanted).collect();
        let on = forest.surfaces.vertices.iter().map(|vertex| {
            let near = index.range_near(usize::from(vertex.x), usize::from(vertex.y), vertex.z, tolerance);
            let closest = near.filter(is_wanted).min_by(|&a, &b| {
                let off = |n: usize| (index.events()[n].z - vertex.z).abs();
                off(a).total_cmp(&off(b))
            });
            closest.map_or(NONE, |n| events.binary_search(&n).expect("events has all wanted ones") as u32)
        });
        let on = on.collect();
        Self { forest, index, blocks: truth.block_count(), events, on }
    }

    fn nothing(&self) -> PickedSet {
        PickedSet {
            covered: vec![false; self.events.len()],
            count: 0,
            seen: vec![false; self.on.len()],
            vertices: 0,
            on: 0,
        }
    }

    /// Adds a node of the forest to the picked ones.
    fn take(&self, picked: &mut PickedSet, node: u32) {
        let range = self.forest.nodes[node as usize].triangles.clone();
        let corners = &self.forest.surfaces.triangles[range.start as usize..range.end as usize];
        for &v in corners.iter().flatten() {
            if std::mem::replace(&mut picked.seen[v as usize], true) {
                continue;
            }
            picked.vertices += 1;
            let on = self.on[v as usize];
            if on != NONE {
                picked.on += 1;
                picked.count += usize::from(!std::mem::replace(&mut picked.covered[on as usize], true));
            }
        }
    }

    fn count(&self, picks: usize, picked: &PickedSet, settings: &PickSettings) -> PickCount {
        let (coverage, precision) = (share(picked.count, self.events.len()), share(picked.on, picked.vertices));
        let reached = coverage >= settings.coverage && precision >= settings.precision;
        PickCount { picks, coverage, precision, reached }
    }

    fn oracle(&self, settings: &PickSettings) -> PickCount {
        let forest = self.forest;
        // For each leaf: the horizon's nodes that it covers, and the counts of its vertices on the horizon
        // and in total.
        let leaves: Vec<(Vec<u32>, u64, u64)> = forest
            .leaves
            .par_iter()
            .map(|&node| {
                let range = forest.nodes[node as usize].triangles.clone();
                let mut vertices: Vec<u32> =
                    forest.surfaces.triangles[range.start as usize..range.end as usize].concat();
                vertices.sort_unstable();
                vertices.dedup();
                let all = vertices.len() as u64;
                let mut on: Vec<u32> = vertices.iter().map(|&v| self.on[v as usize]).filter(|&n| n != NONE).collect();
                let hits = on.len() as u64;
                on.sort_unstable();
                on.dedup();
                (on, hits, all)
            })
            .collect();
        let first = |triangle: u32| {
            forest.leaves.partition_point(|&leaf| forest.nodes[leaf as usize].triangles.start < triangle)
        };
        let spans: Vec<[usize; 2]> =
            forest.nodes.iter().map(|node| [first(node.triangles.start), first(node.triangles.end)]).collect();
        let sums = |of: &dyn Fn(usize) -> u64| {
            let mut sums = vec![0u64];
            (0..leaves.len()).for_each(|leaf| sums.push(sums[leaf] + of(leaf)));
            sums
        };
        let (hits, all) = (sums(&|leaf| leaves[leaf].1), sums(&|leaf| leaves[leaf].2));
        let mut picked = self.nothing();
        let mut picks = 0;
        while picks < settings.most_picks && share(picked.count, self.events.len()) < settings.coverage {
            let new = |leaf: usize| leaves[leaf].0.iter().filter(|&&n| !picked.covered[n as usize]).count() as u64;
            let fresh = sums(&new);
            let gain = |node: usize| {
                let [from, to] = spans[node];
                let (on, vertices) = (hits[to] - hits[from], all[to] - all[from]);
                let precise =
                    (picked.on as u64 + on) as f64 >= settings.precision * (picked.vertices as u64 + vertices) as f64;
                if precise { fresh[to] - fresh[from] } else { 0 }
            };
            let best = (0..spans.len()).max_by_key(|&node| (gain(node), std::cmp::Reverse(node)));
            let Some(best) = best.filter(|&node| gain(node) > 0) else { break };
            self.take(&mut picked, best as u32);
            picks += 1;
        }
        self.count(picks, &picked, settings)
    }

    fn replay(
        &self,
        blocks: &FaultNetwork,
        settings: &PickSettings,
        progress: &Progress,
    ) -> Result<PickCount, Cancelled> {
        let mut picked = self.nothing();
        let mut selected = Selection::default();
        let mut dead = vec![false; self.events.len()];
        let mut picks = 0;
        while picks < settings.most_picks && share(picked.count, self.events.len()) < settings.coverage {
            progress.check()?;
            let Some(seed) = self.middle_of_largest_gap(&picked.covered, &dead) else { break };
            let [x, y] = self.place(seed);
            let at = Vec3::new(x as f32, y as f32, self.index.events()[self.events[seed]].z);
            let hit = leaf_at(self.forest, at, settings.max_distance);
            let hit = hit.ok().filter(|hit| !selected.contains(hit.triangle));
            let Some(hit) = hit else {
                for (n, dead) in dead.iter_mut().enumerate() {
                    let [i, j] = self.place(n);
                    *dead |= i.abs_diff(x) <= DEAD_RADIUS && j.abs_diff(y) <= DEAD_RADIUS;
                }
                continue;
            };
            let node = highest_valid(self.forest, hit.leaf, &selected, blocks, &settings.climb).node;
            selected.insert(self.forest.nodes[node as usize].triangles.clone());
            self.take(&mut picked, node);
            picks += 1;
        }
        Ok(self.count(picks, &picked, settings))
    }

    /// Trace of node `n`.
    fn place(&self, n: usize) -> [usize; 2] {
        let trace = self.index.trace_of(self.events[n]);
        let ny = self.index.size()[1];
        [trace / ny, trace % ny]
    }

    /// The uncovered node that is farthest inside a gap of such nodes. The outer boundary ends a gap.
    fn middle_of_largest_gap(&self, covered: &[bool], dead: &[bool]) -> Option<usize> {
        let [nx, ny, _] = self.index.size();
        let mut node_of = vec![NONE; self.blocks * nx * ny];
        let slot = |n: usize| {
            let event = self.index.events()[self.events[n]];
            usize::from(event.block) * nx * ny + self.index.trace_of(self.events[n])
        };
        for n in (0..covered.len()).filter(|&n| !covered[n] && !dead[n]) {
            node_of[slot(n)] = n as u32;
        }
        let neighbours = |s: usize| {
            let (x, y) = (s % (nx * ny) / ny, s % ny);
            [(x > 0).then(|| s - ny), (x + 1 < nx).then(|| s + ny), (y > 0).then(|| s - 1), (y + 1 < ny).then(|| s + 1)]
        };
        let mut left: Vec<bool> = node_of.iter().map(|&n| n != NONE).collect();
        // A flood from the rim inwards; the node that is reached last is the middle.
        let mut queue: VecDeque<usize> = VecDeque::new();
        for (s, &inside) in left.iter().enumerate() {
            if inside && neighbours(s).iter().any(|next| next.is_none_or(|next| node_of[next] == NONE)) {
                queue.push_back(s);
            }
        }
        queue.iter().for_each(|&s| left[s] = false);
        let mut last = None;
        while let Some(s) = queue.pop_front() {
            last = Some(s);
            for next in neighbours(s).into_iter().flatten() {
                if std::mem::replace(&mut left[next], false) {
                    queue.push_back(next);
                }
            }
        }
        last.map(|s| node_of[s] as usize)
    }
}
