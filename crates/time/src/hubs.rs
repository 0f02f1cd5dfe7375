//! Hubs: patches of surfaces, cut at faults, whose vertices all have one time.
//!
//! A patch that was tracked across a fault would tie the wrong beds together, so patches are cut where an edge of
//! a triangle crosses a fault, and vertices within a trace of a fault are left out. What stays connected is a hub.
//! Vertices are kept in the order of the traces, top down. Memory: 20 bytes a vertex; there is about one for every four
//! voxels of a well-reflecting volume, and fewer elsewhere.

use crate::cut::Cut;
use interp::{Extremum, Surfaces, UnionFind};
use rayon::prelude::*;
use std::ops::Range;

/// Marks a vertex that belongs to no hub.
const NONE: u32 = u32::MAX;

/// The vertices of all hubs, by trace, and the vertices of each hub.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Hubs {
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
    pub fn new(surfaces: &Surfaces, cuts: &[Cut], fewest: usize, weight: f32) -> Self {
        let vertices = &surfaces.vertices;
        let mut sets = UnionFind::new(vertices.len());
        let place = |v: u32| {
            let vertex = &vertices[v as usize];
            ([usize::from(vertex.x), usize::from(vertex.y)], vertex.z)
        };
        for triangle in &surfaces.triangles {
            for (a, b) in [(0, 1), (1, 2), (2, 0)] {
                let (a, b) = (triangle[a], triangle[b]);
                let ((ta, za), (tb, zb)) = (place(a), place(b));
                if !cuts.iter().any(|cut| cut.separates(ta, za, tb, zb)) {
                    sets.union(a, b);
                }
            }
        }
        let beside = |v: u32| {
            let (trace, z) = place(v);
            cuts.iter().any(|cut| cut.side(trace, z).abs() < 1.0)
        };
        let mut count = vec![0u32; vertices.len()];
        let mut set: Vec<u32> = (0..vertices.len() as u32).map(|v| sets.find(v)).collect();
        for v in 0..vertices.len() as u32 {
            if beside(v) {
                set[v as usize] = NONE;
            } else {
                count[set[v as usize] as usize] += 1;
            }
        }
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
        let kept = set.into_iter().enumerate().filter_map(|(v, s)| {
            let hub = if s == NONE { NONE } else { hub_of_set[s as usize] };
            (hub != NONE).then_some((v as u32, hub))
        });
        Self::by_trace(surfaces, kept.collect(), kind, weight)
    }

    /// Puts vertices with their hubs into the order of the traces.
    fn by_trace(surfaces: &Surfaces, mut kept: Vec<(u32, u32)>, kind: Vec<Extremum>, weight: f32) -> Self {
        let size = surfaces.size;
        let of = |v: u32| &surfaces.vertices[v as usize];
        let trace = |v: u32| usize::from(of(v).x) * size[1] + usize::from(of(v).y);
        kept.par_sort_unstable_by(|a, b| {
            trace(a.0).cmp(&trace(b.0)).then(of(a.0).z.total_cmp(&of(b.0).z)).then(a.0.cmp(&b.0))
        });
        let mut starts = vec![0u32; size[0] * size[1] + 1];
        for &(v, _) in &kept {
            starts[trace(v) + 1] += 1;
        }
        for n in 1..starts.len() {
            starts[n] += starts[n - 1];
        }
        let mut hubs = Self {
            size,
            starts,
            z: kept.iter().map(|&(v, _)| of(v).z).collect(),
            hub: kept.iter().map(|&(_, hub)| hub).collect(),
            weight: vec![weight; kept.len()],
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
    pub fn len(&self) -> usize {
        self.kind.len()
    }

    /// The vertices of trace `x·crosslines + y`.
    #[inline]
    pub fn on_trace(&self, trace: usize) -> Range<usize> {
        self.starts[trace] as usize..self.starts[trace + 1] as usize
    }

    /// The vertices of the inline `x`.
    pub fn on_inline(&self, x: usize) -> Range<usize> {
        let ny = self.size[1];
        self.starts[x * ny] as usize..self.starts[(x + 1) * ny] as usize
    }

    /// The vertices of a hub, in the order of the traces.
    pub fn of_hub(&self, hub: usize) -> &[u32] {
        &self.order[self.hub_starts[hub] as usize..self.hub_starts[hub + 1] as usize]
    }

    /// The weighted mean of a value of the vertices of each hub.
    pub fn means(&self, value: &[f32]) -> Vec<f32> {
        (0..self.len())
            .into_par_iter()
            .map(|hub| {
                let (mut sum, mut weights) = (0.0f64, 0.0f64);
                for &v in self.of_hub(hub) {
                    let w = f64::from(self.weight[v as usize]);
                    sum += w * f64::from(value[v as usize]);
                    weights += w;
                }
                if weights > 0.0 { (sum / weights) as f32 } else { 0.0 }
            })
            .collect()
    }

    /// Splits an array with one entry a vertex into those of each inline.
    pub fn split_inlines<'a, T>(&self, mut all: &'a mut [T]) -> Vec<&'a mut [T]> {
        let mut parts = Vec::with_capacity(self.size[0]);
        for x in 0..self.size[0] {
            let (part, rest) = all.split_at_mut(self.on_inline(x).len());
            parts.push(part);
            all = rest;
        }
        parts
    }

    /// Gives every hub the number `into[hub]`, counted from 0 without gaps; hubs of one number become one.
    pub fn relabel(&mut self, into: &[u32]) {
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
