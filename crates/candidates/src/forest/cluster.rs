//! Hierarchical clustering along chains of cheapest neighbours (see [`super`] for why this makes the greedy
//! tree).
//!
//! From any part, go to its cheapest neighbour until two parts choose each other; merge them; continue from
//! the part before. Pairs are ordered by (cost, lesser id, greater id), where the id of a part is its least
//! patch, so every step goes strictly down and the result is unique. A surface of many patches is first
//! clustered in separate square regions. There only those parts are merged that have all their neighbours
//! inside, so these merges are among the ones that the whole surface would make. Cost: about three chain
//! steps a merge, each with as many cost evaluations as a part has neighbours, six on average.

use super::dual::{Patches, find};
use super::moments::Moments;
use rayon::prelude::*;
use std::cmp::Reverse;
use std::collections::BinaryHeap;
use survey::{Cancelled, Progress};

/// Count of patches from which a surface is first clustered in regions. Below it, one thread needs some
/// milliseconds.
pub(crate) const REGIONAL: usize = 1 << 13;

/// Edge of a region, voxels: about a thousand patches, so that few of them touch its border.
const REGION: f64 = 64.0;

/// Merges between two checks for cancellation.
const CHECK_EVERY: usize = 1 << 12;

/// Stands in a list of neighbours for all those outside the region.
const OUTSIDE: u32 = u32::MAX;

/// Merges all parts of a surface into one. A merge `[a, b]`, a < b, puts part b into part a; a part is named
/// by its least patch.
pub(crate) fn cluster(patches: &Patches, progress: &Progress) -> Result<Vec<[u32; 2]>, Cancelled> {
    let mut merges = Vec::with_capacity(patches.len());
    let mut clusters = if patches.len() < REGIONAL {
        Clusters::of_all(patches)
    } else {
        let regions = regions(patches);
        let parts = regions.par_iter().map(|own| cluster_region(patches, own, progress));
        let parts: Vec<MergedRegion> = parts.collect::<Result<_, Cancelled>>()?;
        Clusters::after(patches, &parts, &mut merges)
    };
    clusters.merge_chains(&mut merges, progress)?;
    join_separate(patches, &mut clusters.parent, &mut merges);
    Ok(merges)
}

/// Patches of each square region that is not empty.
fn regions(patches: &Patches) -> Vec<Vec<u32>> {
    let key = |patch: u32| {
        let [x, y, _] = patches.moments[patch as usize].centroid;
        [(x / REGION) as u32, (y / REGION) as u32]
    };
    let mut order: Vec<u32> = (0..patches.len() as u32).collect();
    order.sort_by_cached_key(|&patch| (key(patch), patch));
    order.chunk_by(|&a, &b| key(a) == key(b)).map(<[u32]>::to_vec).collect()
}

/// The result of one region, in ids of the surface.
struct MergedRegion {
    merges: Vec<[u32; 2]>,
    /// The remaining parts: id, moments, and neighbours as patches of the surface.
    left: Vec<(u32, Moments, Vec<u32>)>,
}

/// Merges the parts that have all their neighbours in the region.
fn cluster_region(patches: &Patches, own: &[u32], progress: &Progress) -> Result<MergedRegion, Cancelled> {
    progress.check()?;
    // `own` ascends, so local ids keep the order of the surface's.
    let local = |patch: u32| own.binary_search(&patch).map_or(OUTSIDE, |n| n as u32);
    let lists = own.iter().map(|&patch| patches.neighbours_of(patch).iter().map(|&q| local(q)));
    let moments = own.iter().map(|&patch| patches.moments[patch as usize]).collect();
    let mut clusters = Clusters::new(moments, lists);
    let mut merges = Vec::new();
    clusters.merge_chains(&mut merges, progress)?;
    // Every outside patch next to a part is a neighbour of one of its patches.
    let mut outside: Vec<Vec<u32>> = vec![Vec::new(); own.len()];
    for (n, &patch) in own.iter().enumerate() {
        let root = find(&mut clusters.parent, n as u32) as usize;
        outside[root].extend(patches.neighbours_of(patch).iter().filter(|&&q| local(q) == OUTSIDE));
    }
    let mut left = Vec::new();
    for n in 0..own.len() as u32 {
        if clusters.parent[n as usize] == n {
            clusters.compact(n);
            let inside = clusters.list(n).iter().filter(|&&q| q != OUTSIDE).map(|&q| own[q as usize]);
            let mut neighbours: Vec<u32> = inside.collect();
            neighbours.append(&mut outside[n as usize]);
            left.push((own[n as usize], clusters.moments[n as usize], neighbours));
        }
    }
    let merges = merges.into_iter().map(|pair| pair.map(|n| own[n as usize])).collect();
    Ok(MergedRegion { merges, left })
}

/// The parts of a surface while they are merged.
pub(crate) struct Clusters {
    /// Union–find over patches; a root is the least patch of its part.
    parent: Vec<u32>,
    /// Moments of each root's part.
    moments: Vec<Moments>,
    /// Cost of each root's part.
    costs: Vec<f64>,
    /// First entry and count of each root's neighbours in `arena`. The entries may be outdated or repeated.
    lists: Vec<[u32; 2]>,
    arena: Vec<u32>,
    /// The part for which a neighbour was last seen, to skip repetitions.
    seen: Vec<u32>,
    mark: u32,
}

/// The cheapest neighbour of a part.
enum Nearest {
    /// The part has no neighbour.
    Alone,
    /// Some neighbours lie outside the region.
    Unknown,
    /// The part that is cheapest to merge with.
    Part(u32),
}

impl Clusters {
    fn new(moments: Vec<Moments>, neighbours: impl Iterator<Item = impl Iterator<Item = u32>>) -> Self {
        let count = moments.len();
        let (mut lists, mut arena) = (Vec::with_capacity(count), Vec::with_capacity(12 * count));
        for list in neighbours {
            let start = arena.len() as u32;
            arena.extend(list);
            lists.push([start, arena.len() as u32 - start]);
        }
        let parent = (0..count as u32).collect();
        let costs = moments.iter().map(Moments::cost).collect();
        Self { parent, moments, costs, lists, arena, seen: vec![0; count], mark: 0 }
    }

    pub(crate) fn of_all(patches: &Patches) -> Self {
        let lists = (0..patches.len() as u32).map(|patch| patches.neighbours_of(patch).iter().copied());
        Self::new(patches.moments.clone(), lists)
    }

    /// The state after the merges of all regions.
    fn after(patches: &Patches, regions: &[MergedRegion], merges: &mut Vec<[u32; 2]>) -> Self {
        let count = patches.len();
        let mut all = Self::new(vec![Moments::EMPTY; count], (0..count).map(|_| std::iter::empty()));
        for region in regions {
            for &[a, b] in &region.merges {
                all.parent[b as usize] = a;
                merges.push([a, b]);
            }
            for (id, moments, neighbours) in &region.left {
                all.moments[*id as usize] = *moments;
                all.costs[*id as usize] = moments.cost();
                all.lists[*id as usize] = [all.arena.len() as u32, neighbours.len() as u32];
                all.arena.extend(neighbours);
            }
        }
        all
    }

    fn list(&self, part: u32) -> &[u32] {
        let [start, count] = self.lists[part as usize];
        &self.arena[start as usize..(start + count) as usize]
    }

    /// Updates the list of a part's neighbours.
    fn compact(&mut self, part: u32) {
        let [start, count] = self.lists[part as usize];
        self.mark += 1;
        let mut kept = start as usize;
        let mut outside = false;
        for at in start as usize..(start + count) as usize {
            if self.arena[at] == OUTSIDE {
                outside = true;
                continue;
            }
            let neighbour = find(&mut self.parent, self.arena[at]);
            if neighbour != part && self.seen[neighbour as usize] != self.mark {
                self.seen[neighbour as usize] = self.mark;
                self.arena[kept] = neighbour;
                kept += 1;
            }
        }
        if outside {
            self.arena[kept] = OUTSIDE;
            kept += 1;
        }
        self.lists[part as usize][1] = (kept - start as usize) as u32;
    }

    fn nearest(&mut self, part: u32) -> Nearest {
        if self.list(part).last() == Some(&OUTSIDE) {
            return Nearest::Unknown;
        }
        self.compact(part);
        if self.list(part).last() == Some(&OUTSIDE) {
            return Nearest::Unknown;
        }
        // A union costs at least as much as both parts together, so starting with the cheapest part excludes
        // most others.
        let list = self.list(part);
        let cheapest = list.iter().copied().min_by(|&a, &b| self.costs[a as usize].total_cmp(&self.costs[b as usize]));
        let mut best: Option<(f64, u32)> = None;
        for other in cheapest.into_iter().chain(list.iter().copied().filter(|&other| Some(other) != cheapest)) {
            let (low, high) = (part.min(other) as usize, part.max(other) as usize);
            let union = self.moments[low].union(&self.moments[high]);
            if best.is_some_and(|(least, _)| self.costs[low] + self.costs[high] - union.doubt() > least) {
                continue;
            }
            let cost = union.cost();
            // With one part fixed, pairs of equal cost are ordered by the other part.
            if best.is_none_or(|(least, id)| cost < least || (cost == least && other < id)) {
                best = Some((cost, other));
            }
        }
        best.map_or(Nearest::Alone, |(_, other)| Nearest::Part(other))
    }

    /// Merges two parts; the lesser id remains.
    fn merge(&mut self, a: u32, b: u32) -> [u32; 2] {
        let (low, high) = (a.min(b), a.max(b));
        self.moments[low as usize] = self.moments[low as usize].union(&self.moments[high as usize]);
        self.costs[low as usize] = self.moments[low as usize].cost();
        self.parent[high as usize] = low;
        let start = self.arena.len() as u32;
        for part in [low, high] {
            let [from, count] = self.lists[part as usize].map(|n| n as usize);
            self.arena.extend_from_within(from..from + count);
        }
        self.lists[low as usize] = [start, self.arena.len() as u32 - start];
        self.compact(low);
        self.arena.truncate((start + self.lists[low as usize][1]) as usize);
        [low, high]
    }

    /// Merges until no chain can continue.
    pub(crate) fn merge_chains(&mut self, merges: &mut Vec<[u32; 2]>, progress: &Progress) -> Result<(), Cancelled> {
        let mut chain: Vec<u32> = Vec::new();
        let mut in_chain = vec![false; self.parent.len()];
        for start in 0..self.parent.len() as u32 {
            if self.parent[start as usize] != start {
                continue;
            }
            chain.push(start);
            while let Some(&top) = chain.last() {
                in_chain[top as usize] = true;
                let Nearest::Part(next) = self.nearest(top) else {
                    chain.drain(..).for_each(|part| in_chain[part as usize] = false);
                    break;
                };
                if chain.len() > 1 && chain[chain.len() - 2] == next {
                    for part in chain.drain(chain.len() - 2..) {
                        in_chain[part as usize] = false;
                    }
                    let merged = self.merge(top, next);
                    merges.push(merged);
                    if chain.is_empty() {
                        chain.push(merged[0]);
                    }
                    if merges.len().is_multiple_of(CHECK_EVERY) {
                        progress.check()?;
                    }
                } else if in_chain[next as usize] {
                    // Only rounding can make a merged part cheaper for the rest of the chain than the part it
                    // followed: start the chain again.
                    chain.drain(..).for_each(|part| in_chain[part as usize] = false);
                    chain.push(top);
                } else {
                    chain.push(next);
                }
            }
        }
        Ok(())
    }
}

/// Joins pieces that share no edge (they touch in a vertex or not at all), always the two with the fewest
/// triangles.
fn join_separate(patches: &Patches, parent: &mut [u32], merges: &mut Vec<[u32; 2]>) {
    let mut counts = vec![0u64; parent.len()];
    for patch in 0..parent.len() as u32 {
        counts[find(parent, patch) as usize] += u64::from(patches.counts[patch as usize]);
    }
    let roots = (0..parent.len()).filter(|&n| parent[n] as usize == n);
    let mut pieces: BinaryHeap<Reverse<(u64, u32)>> = roots.map(|n| Reverse((counts[n], n as u32))).collect();
    while let Some(Reverse((few, a))) = pieces.pop() {
        let Some(Reverse((more, b))) = pieces.pop() else { break };
        merges.push([a.min(b), a.max(b)]);
        pieces.push(Reverse((few + more, a.min(b))));
    }
}
