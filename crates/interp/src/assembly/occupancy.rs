//! Which traces are occupied: a horizon may have one vertex per trace and fault block.
//!
//! Memory: 4 bytes a trace, 8 bytes per added vertex, and one bit per vertex of the extraction.

use crate::surfaces::Surfaces;
use glam::Vec3;
use model::FaultNetwork;
use std::ops::Range;

/// Where sheets lie over one another.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Overlap {
    /// Count of vertices that share trace and fault block with an earlier vertex.
    pub traces: usize,
    /// Count of those that share it with a vertex added before `Occupancy::set_apart`.
    pub beside: usize,
    /// The largest distance between two such vertices, samples.
    pub apart: f32,
    /// Voxel position of the vertex with that distance: inline index, crossline index, sample.
    pub at_voxel: [f32; 3],
}

impl Overlap {
    /// Counts a vertex that lies so far, samples, from another one of its trace.
    pub(crate) fn add(&mut self, apart: f32, at_voxel: [f32; 3]) {
        self.traces += 1;
        if apart > self.apart {
            (self.apart, self.at_voxel) = (apart, at_voxel);
        }
    }
}

/// No entry.
const NONE: u32 = u32::MAX;

/// The vertices added so far, by trace.
pub struct Occupancy<'a> {
    surfaces: &'a Surfaces,
    blocks: &'a FaultNetwork,
    seen: Vec<u64>,
    /// First entry of each trace, or `NONE`.
    heads: Vec<u32>,
    entries: Vec<TraceVertex>,
    /// Count of entries added before [`Occupancy::set_apart`].
    others: usize,
    overlap: Overlap,
}

/// A vertex in the list of its trace.
struct TraceVertex {
    z: f32,
    block: u16,
    next: u32,
}

impl<'a> Occupancy<'a> {
    /// An occupancy without vertices.
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

    /// Sets apart the vertices added so far: overlaps with them are counted in [`Overlap::beside`].
    pub(crate) fn set_apart(&mut self) {
        self.others = self.entries.len();
    }

    /// Adds the vertices of a range of triangles. A vertex that was added before is skipped.
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
                        (self.overlap.apart, self.overlap.at_voxel) = (apart, place.to_array());
                    }
                }
                at = entry.next;
            }
            self.overlap.traces += usize::from(taken);
            self.overlap.beside += usize::from(beside);
            self.entries.push(TraceVertex { z: vertex.z, block, next: self.heads[trace] });
            self.heads[trace] = self.entries.len() as u32 - 1;
        }
    }

    /// Count of vertices added.
    pub fn vertices(&self) -> usize {
        self.entries.len()
    }

    /// The overlap of the added vertices.
    pub fn overlap(&self) -> Overlap {
        self.overlap
    }
}
