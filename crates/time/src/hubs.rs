//! Hubs: patches of surfaces, cut at faults, whose vertices all have one time.
//!
//! A patch that was tracked across a fault would tie the wrong beds together, so patches are cut where an edge of
//! a triangle crosses a fault, and vertices within a trace of a fault are left out. What stays connected is a hub.
//! A picked horizon is a hub of its own, whose vertices weigh [`KNOWN`] times as much; patches along it follow.
//! Vertices are kept in the order of the traces, top down. Memory: 20 bytes a vertex; there is about one for every four
//! voxels of a well-reflecting volume, and fewer elsewhere.

use crate::cuts::Cut;
use crate::interpretation::KnownHorizon;
use interp::{Extremum, Surfaces, UnionFind};
use rayon::prelude::*;
use std::ops::Range;

/// Marks a vertex that belongs to no hub.
const NONE: u32 = u32::MAX;

/// Weight of a vertex of a picked horizon, over that of a patch.
pub(crate) const KNOWN: f32 = 16.0;
/// Distance from a picked horizon within which a vertex of a patch tells what it follows, samples.
const ON_HORIZON: f32 = 0.75;

/// Parts of the vertices that are summed by themselves: however many threads there are, sums have one order.
const BLOCKS: usize = 16;

/// A vertex on its way into a hub.
#[derive(Clone, Copy)]
struct HubVertex {
    trace: u32,
    z: f32,
    hub: u32,
    weight: f32,
}

/// The edges of a triangle, by its corners.
const EDGES: [[usize; 2]; 3] = [[0, 1], [1, 2], [2, 0]];
/// Count of faults whose sides fit into one word.
const AT_ONCE: usize = u32::BITS as usize;

/// Where faults lie between and beside the vertices of surfaces.
struct Sides {
    /// Bit n of a triangle: a fault lies between the ends of the edge n of [`EDGES`].
    apart: Vec<u8>,
    /// Whether a vertex lies within a trace of a fault.
    beside: Vec<bool>,
}

impl Sides {
    fn of(surfaces: &Surfaces, cuts: &[Cut]) -> Self {
        let mut apart = vec![0u8; surfaces.triangles.len()];
        let mut beside = vec![false; surfaces.vertices.len()];
        for cuts in cuts.chunks(AT_ONCE) {
            // The faults above which each vertex lies, and those below which it does; neither where there is no fault.
            let sides: Vec<[u32; 2]> = surfaces
                .vertices
                .par_iter()
                .zip(&mut beside)
                .map(|(vertex, beside)| {
                    let trace = [usize::from(vertex.x), usize::from(vertex.y)];
                    cuts.iter().enumerate().fold([0, 0], |[above, below], (n, cut)| {
                        let side = cut.side(trace, vertex.z);
                        *beside |= side.abs() < 1.0;
                        [above | u32::from(side > 0.0) << n, below | u32::from(side <= 0.0) << n]
                    })
                })
                .collect();
            surfaces.triangles.par_iter().zip(&mut apart).for_each(|(triangle, apart)| {
                for (n, edge) in EDGES.into_iter().enumerate() {
                    let [a, b] = edge.map(|corner| sides[triangle[corner] as usize]);
                    *apart |= u8::from(a[0] & b[1] | a[1] & b[0] != 0) << n;
                }
            });
        }
        Self { apart, beside }
    }
}

/// The vertices of all hubs, by trace, and the vertices of each hub.
#[derive(Debug, Clone, Default, PartialEq)]
pub(crate) struct Hubs {
    /// `[inlines, crosslines, samples]`.
    pub size: [usize; 3],
    /// First vertex of each trace, and the end of the last.
    starts: Vec<u32>,
    /// Fractional sample of each vertex; within a trace from the top down.
    pub z: Vec<f32>,
    /// Hub of each vertex.
    pub hub: Vec<u32>,
    /// Weight W of each vertex.
    pub weight: Vec<f32>,
    /// What each hub follows.
    pub kind: Vec<Extremum>,
    /// Vertices in the order of their hubs.
    order: Vec<u32>,
    /// First entry of each hub in `order`, and the end of the last.
    hub_starts: Vec<u32>,
}

impl Hubs {
    /// Cuts surfaces into hubs of at least `fewest` vertices.
    pub(crate) fn new(surfaces: &Surfaces, cuts: &[Cut], fewest: usize, weight: f32) -> Self {
        let vertices = &surfaces.vertices;
        let Sides { apart, beside } = Sides::of(surfaces, cuts);
        let mut sets = UnionFind::new(vertices.len());
        for (triangle, apart) in surfaces.triangles.iter().zip(apart) {
            for (n, [a, b]) in EDGES.into_iter().enumerate() {
                if apart >> n & 1 == 0 {
                    sets.union(triangle[a], triangle[b]);
                }
            }
        }
        let mut count = vec![0u32; vertices.len()];
        let mut set: Vec<u32> = (0..vertices.len() as u32).map(|v| sets.find(v)).collect();
        for (set, beside) in set.iter_mut().zip(beside) {
            if beside {
                *set = NONE;
            } else {
                count[*set as usize] += 1;
            }
        }
        drop(sets);
        let mut hub_of_set = vec![NONE; vertices.len()];
        let mut kind = Vec::new();
        for surface in &surfaces.surfaces {
            for &s in &set[surface.vertices.start as usize..surface.vertices.end as usize] {
                if s != NONE && hub_of_set[s as usize] == NONE && count[s as usize] as usize >= fewest {
                    hub_of_set[s as usize] = kind.len() as u32;
                    kind.push(surface.extremum);
                }
            }
        }
        let ny = surfaces.size[1];
        let kept = set.into_iter().enumerate().filter_map(|(v, s)| {
            let hub = if s == NONE { NONE } else { hub_of_set[s as usize] };
            let vertex = &vertices[v];
            let trace = (usize::from(vertex.x) * ny + usize::from(vertex.y)) as u32;
            (hub != NONE).then_some(HubVertex { trace, z: vertex.z, hub, weight })
        });
        let kept: Vec<HubVertex> = kept.collect();
        drop((count, hub_of_set));
        Self::by_trace(surfaces.size, kept, kind)
    }

    /// The same with picked horizons as hubs of their own, each following what most of its nodes lie on.
    pub(crate) fn with_horizons(self, horizons: &[KnownHorizon], weight: f32) -> Self {
        if horizons.iter().all(|horizon| horizon.nodes.is_empty()) {
            return self;
        }
        let [nx, ny, nz] = self.size;
        let mut kind = self.kind.clone();
        let traces = (0..nx * ny).flat_map(|trace| self.on_trace(trace).map(move |v| (trace as u32, v)));
        let mut entries: Vec<HubVertex> = traces
            .map(|(trace, v)| HubVertex { trace, z: self.z[v], hub: self.hub[v], weight: self.weight[v] })
            .collect();
        for horizon in horizons.iter().filter(|horizon| !horizon.nodes.is_empty()) {
            let mut counts = [(Extremum::Peak, 0), (Extremum::Trough, 0), (Extremum::Zero, 0)];
            for node in &horizon.nodes {
                let trace = node.trace[0] * ny + node.trace[1];
                for v in self.on_trace(trace).filter(|&v| (self.z[v] - node.z).abs() <= ON_HORIZON) {
                    let follows = self.kind[self.hub[v] as usize];
                    counts.iter_mut().filter(|(kind, _)| *kind == follows).for_each(|(_, count)| *count += 1);
                }
                let z = horizon.sample_of(node).clamp(0.0, (nz - 1) as f32);
                entries.push(HubVertex { trace: trace as u32, z, hub: kind.len() as u32, weight: KNOWN * weight });
            }
            kind.push(counts.into_iter().fold(counts[0], |best, next| if next.1 > best.1 { next } else { best }).0);
        }
        Self::by_trace(self.size, entries, kind)
    }

    /// Puts vertices into the order of the traces.
    fn by_trace(size: [usize; 3], mut kept: Vec<HubVertex>, kind: Vec<Extremum>) -> Self {
        // Stable, so that vertices of one place keep their order.
        kept.par_sort_by(|a, b| a.trace.cmp(&b.trace).then(a.z.total_cmp(&b.z)));
        let mut starts = vec![0u32; size[0] * size[1] + 1];
        for entry in &kept {
            starts[entry.trace as usize + 1] += 1;
        }
        for n in 1..starts.len() {
            starts[n] += starts[n - 1];
        }
        let mut hubs = Self {
            size,
            starts,
            z: kept.iter().map(|entry| entry.z).collect(),
            hub: kept.iter().map(|entry| entry.hub).collect(),
            weight: kept.iter().map(|entry| entry.weight).collect(),
            kind,
            ..Self::default()
        };
        hubs.index();
        hubs
    }

    /// Lists the vertices of each hub anew.
    fn index(&mut self) {
        self.hub_starts = vec![0; self.kind.len() + 1];
        for &hub in &self.hub {
            self.hub_starts[hub as usize + 1] += 1;
        }
        for n in 1..self.hub_starts.len() {
            self.hub_starts[n] += self.hub_starts[n - 1];
        }
        let mut next = self.hub_starts.clone();
        self.order = vec![0; self.hub.len()];
        for (v, &hub) in self.hub.iter().enumerate() {
            self.order[next[hub as usize] as usize] = v as u32;
            next[hub as usize] += 1;
        }
    }

    /// Count of hubs.
    pub(crate) fn len(&self) -> usize {
        self.kind.len()
    }

    /// The vertices of trace `x·crosslines + y`.
    #[inline]
    pub(crate) fn on_trace(&self, trace: usize) -> Range<usize> {
        self.starts[trace] as usize..self.starts[trace + 1] as usize
    }

    /// The trace `x·crosslines + y` of a vertex.
    pub(crate) fn trace_of(&self, v: u32) -> usize {
        self.starts.partition_point(|start| *start <= v) - 1
    }

    /// The vertices of the inline `x`.
    pub(crate) fn on_inline(&self, x: usize) -> Range<usize> {
        let ny = self.size[1];
        self.starts[x * ny] as usize..self.starts[(x + 1) * ny] as usize
    }

    /// The vertices of a hub, in the order of the traces.
    pub(crate) fn of_hub(&self, hub: usize) -> &[u32] {
        &self.order[self.hub_starts[hub] as usize..self.hub_starts[hub + 1] as usize]
    }

    /// The weighted mean of a value of the vertices of each hub. Memory: 16 bytes a hub for each of [`BLOCKS`].
    pub(crate) fn means(&self, value: &[f32]) -> Vec<f32> {
        let block = value.len().div_ceil(BLOCKS).max(1);
        let blocks = value.par_chunks(block).zip(self.weight.par_chunks(block)).zip(self.hub.par_chunks(block));
        let parts: Vec<Vec<[f64; 2]>> = blocks
            .map(|((value, weight), hub)| {
                let mut sums = vec![[0.0; 2]; self.len()];
                for ((&value, &weight), &hub) in value.iter().zip(weight).zip(hub) {
                    let [sum, weights] = &mut sums[hub as usize];
                    *sum += f64::from(weight) * f64::from(value);
                    *weights += f64::from(weight);
                }
                sums
            })
            .collect();
        let mean = |hub: usize| {
            let add = |[a, b]: [f64; 2], part: &Vec<[f64; 2]>| [a + part[hub][0], b + part[hub][1]];
            let [sum, weights] = parts.iter().fold([0.0; 2], add);
            if weights > 0.0 { (sum / weights) as f32 } else { 0.0 }
        };
        (0..self.len()).into_par_iter().map(mean).collect()
    }

    /// Splits an array with one entry a vertex into those of each inline.
    pub(crate) fn split_inlines<'a, T>(&self, mut all: &'a mut [T]) -> Vec<&'a mut [T]> {
        let mut parts = Vec::with_capacity(self.size[0]);
        for x in 0..self.size[0] {
            let (part, rest) = all.split_at_mut(self.on_inline(x).len());
            parts.push(part);
            all = rest;
        }
        parts
    }

    /// Gives every hub the number `into[hub]`, counted from 0 without gaps; hubs of one number become one.
    pub(crate) fn relabel(&mut self, into: &[u32]) {
        let count = into.iter().map(|&hub| hub as usize + 1).max().unwrap_or(0);
        let mut kind = vec![Extremum::Peak; count];
        for (hub, &to) in into.iter().enumerate() {
            kind[to as usize] = self.kind[hub];
        }
        self.hub.iter_mut().for_each(|hub| *hub = into[*hub as usize]);
        self.kind = kind;
        self.index();
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::cuts::Across;
    use interp::Vertex;

    #[test]
    fn sides_of_many_faults_are_those_of_each() {
        // Faults at every third place, by turns across either axis, each with a gap, more than fit into one word.
        let cut = |n: usize| {
            let across = if n.is_multiple_of(2) { Across::Inlines } else { Across::Crosslines };
            let place = move |line: usize, z: usize| {
                if (line + n).is_multiple_of(7) { f32::NAN } else { 1.5 * n as f32 + 0.2 * z as f32 }
            };
            Cut::new(across, 70, 9, place)
        };
        let cuts: Vec<Cut> = (0..40).map(cut).collect();
        let vertex =
            |n: usize| Vertex { x: (n / 2 % 70) as u16, y: (n * 5 / 4 % 70) as u16, z: (n * 29 % 80) as f32 / 10.0 };
        let vertices: Vec<Vertex> = (0..300).map(vertex).collect();
        let triangles = (0..298u32).map(|n| [n, n + 1, n + 2]).collect();
        let surfaces = Surfaces { size: [70, 70, 9], vertices, triangles, ..Surfaces::default() };
        let found = Sides::of(&surfaces, &cuts);
        let place = |v: u32| {
            let Vertex { x, y, z } = surfaces.vertices[v as usize];
            ([usize::from(x), usize::from(y)], z)
        };
        for (triangle, apart) in surfaces.triangles.iter().zip(&found.apart) {
            for (n, edge) in EDGES.into_iter().enumerate() {
                let [(a, za), (b, zb)] = edge.map(|corner| place(triangle[corner]));
                let meant = cuts.iter().any(|cut| cut.separates(a, za, b, zb));
                assert_eq!(apart >> n & 1 == 1, meant);
            }
        }
        for (v, beside) in found.beside.iter().enumerate() {
            let (trace, z) = place(v as u32);
            assert_eq!(*beside, cuts.iter().any(|cut| cut.side(trace, z).abs() < 1.0));
        }
        assert!(
            found.beside.contains(&false) && found.apart.contains(&0) && found.apart.iter().any(|edges| *edges != 0)
        );
    }
}
