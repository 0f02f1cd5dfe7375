//! Which traces are taken: one vertex a trace and fault block is what a horizon may have.
//!
//! Memory: 4 bytes a trace, 8 a vertex that was added, a bit a vertex of the extraction.

use crate::surfaces::Surfaces;
use glam::Vec3;
use model::FaultNetwork;
use serde::Serialize;
use std::ops::Range;

/// Where sheets lie over one another.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize)]
pub struct Overlap {
    /// Vertices that share trace and fault block with one that was there before.
    pub traces: usize,
    /// Those of them that share it with a vertex of before [`Occupancy::set_apart`].
    pub beside: usize,
    /// The largest distance between two such vertices, samples.
    pub apart: f32,
    /// Where that is: inline index, crossline index, sample.
    pub at: [f32; 3],
}

/// No entry.
const NONE: u32 = u32::MAX;

/// The vertices added so far, by trace.
pub struct Occupancy<'a> {
    surfaces: &'a Surfaces,
    blocks: &'a FaultNetwork,
    seen: Vec<u64>,
    /// First entry of each trace.
    heads: Vec<u32>,
    entries: Vec<Entry>,
    /// Entries before this one are of others.
    others: usize,
    overlap: Overlap,
}

/// A vertex on its trace.
struct Entry {
    z: f32,
    block: u16,
    next: u32,
}

impl<'a> Occupancy<'a> {
    /// Nothing added yet.
    pub fn new(surfaces: &'a Surfaces, blocks: &'a FaultNetwork) -> Self {
        Self {
            surfaces,
            blocks,
            seen: vec![0; surfaces.vertices.len().div_ceil(64)],
            heads: vec![NONE; surfaces.size[0] * surfaces.size[1]],
            entries: Vec::new(),
            others: 0,
            overlap: Overlap::default(),
        }
    }

    /// What was added so far is others', and overlaps with it are counted apart.
    pub fn set_apart(&mut self) {
        self.others = self.entries.len();
    }

    /// Adds the vertices of triangles; those added before count once.
    pub fn add(&mut self, triangles: Range<u32>) {
        let surfaces = self.surfaces;
        for &v in surfaces.triangles[triangles.start as usize..triangles.end as usize].iter().flatten() {
            let (word, bit) = (v as usize / 64, 1u64 << (v % 64));
            if self.seen[word] & bit != 0 {
                continue;
            }
            self.seen[word] |= bit;
            let vertex = surfaces.vertices[v as usize];
            let place = Vec3::new(f32::from(vertex.x), f32::from(vertex.y), vertex.z);
            let block = self.blocks.block_at(place);
            let trace = usize::from(vertex.x) * surfaces.size[1] + usize::from(vertex.y);
            let mut at = self.heads[trace];
            let (mut taken, mut beside) = (false, false);
            while at != NONE {
                let entry = &self.entries[at as usize];
                if entry.block == block {
                    taken = true;
                    beside |= (at as usize) < self.others;
                    let apart = (entry.z - vertex.z).abs();
                    if apart > self.overlap.apart {
                        (self.overlap.apart, self.overlap.at) = (apart, place.to_array());
                    }
                }
                at = entry.next;
            }
            self.overlap.traces += usize::from(taken);
            self.overlap.beside += usize::from(beside);
            self.entries.push(Entry { z: vertex.z, block, next: self.heads[trace] });
            self.heads[trace] = self.entries.len() as u32 - 1;
        }
    }

    /// Count of vertices added.
    pub fn vertices(&self) -> usize {
        self.entries.len()
    }

    /// Where what was added lies over itself.
    pub fn overlap(&self) -> Overlap {
        self.overlap
    }
}
