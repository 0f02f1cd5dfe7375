//! Stages from labels to surfaces: `triangles`, `order` ([`crate::grow::assemble`]).
//!
//! A brick makes the triangles of the cells that begin on its traces, and lists its vertices that any triangle uses,
//! surface by surface. Vertices are named by their index in the survey until a whole surface is put together.

use super::Bricks;
use super::patch::Patch;
use super::tiles::Halo;
use crate::error::InterpError;
use crate::grow::assemble::CellTriangles;
use crate::grow::links::NONE;
use crate::surfaces::Vertex;
use bytemuck::{Pod, Zeroable};
use std::collections::BTreeMap;

/// Triangles of the surfaces whose trees one task builds, unless one surface has more: few seconds of work, so that many
/// workers have enough tasks.
const TRIANGLES_OF_A_TASK: u64 = 1 << 20;

/// A vertex as bricks hand it on.
#[derive(Debug, Clone, Copy, PartialEq, Pod, Zeroable)]
#[repr(C)]
pub(crate) struct Corner {
    /// Its index among the extrema of the survey.
    pub(crate) index: u32,
    pub(crate) x: u16,
    pub(crate) y: u16,
    pub(crate) z: f32,
}

/// What a brick has of a surface: ranges of its arrays of vertices and of triangles.
#[derive(Debug, Clone, Copy, PartialEq, Pod, Zeroable)]
#[repr(C)]
pub(crate) struct Group {
    pub(crate) label: u32,
    pub(crate) vertices: [u32; 2],
    pub(crate) triangles: [u32; 2],
    /// The first vertex, if there is one.
    first: [u32; 3],
}

/// A surface of the whole survey, in its place.
#[derive(Debug, Clone, Copy, PartialEq, Pod, Zeroable)]
#[repr(C)]
pub(crate) struct Outline {
    pub(crate) kind: u32,
    pub(crate) label: u32,
    /// Counts of vertices and triangles.
    pub(crate) counts: [u32; 2],
    /// First member, and the end, of the list of [`Member`]s.
    pub(crate) members: [u32; 2],
}

/// What one brick has of a surface.
#[derive(Debug, Clone, Copy, PartialEq, Pod, Zeroable)]
#[repr(C)]
pub(crate) struct Member {
    pub(crate) brick: u32,
    pub(crate) vertices: [u32; 2],
    pub(crate) triangles: [u32; 2],
}

/// A surface while its parts are gathered: its first vertex, counts of vertices and triangles, and its members.
type Whole = (Option<Vertex>, [u64; 2], Vec<Member>);

impl Bricks<'_> {
    /// The vertices and triangles of a brick.
    pub(crate) fn triangles(&self, brick: usize) -> Result<(), InterpError> {
        for kind in 0..self.kinds.len() {
            let patch = self.patch(kind, brick, Halo::around(1))?;
            let (links, labels) = (self.links(&patch)?, self.joined_labels(&patch)?);
            let (indices, own) = (patch.indices(), patch.is_own());
            let mut used = vec![false; labels.len()];
            let mut triangles: Vec<(u32, [u32; 3])> = Vec::new();
            for (v, is_own) in own.into_iter().enumerate() {
                for triangle in CellTriangles::new(&patch.extrema, &links, &labels, v as u32).triangles() {
                    triangle.iter().for_each(|&corner| used[corner as usize] = true);
                    if is_own {
                        triangles.push((labels[triangle[0] as usize], triangle.map(|corner| indices[corner as usize])));
                    }
                }
            }
            // Stable, so that the order of cells stays.
            triangles.sort_by_key(|(label, _)| *label);
            let mut corners: Vec<(u32, Corner)> = Vec::new();
            for ([x, y], v, index) in patch.own_extrema().filter(|&(_, v, _)| used[v] && labels[v] != NONE) {
                corners.push((labels[v], Corner { index, x: x as u16, y: y as u16, z: patch.extrema.z[v] }));
            }
            corners.sort_by_key(|(label, _)| *label);
            self.write_groups(&patch, &corners, &triangles)?;
        }
        Ok(())
    }

    fn write_groups(
        &self,
        patch: &Patch,
        corners: &[(u32, Corner)],
        triangles: &[(u32, [u32; 3])],
    ) -> Result<(), InterpError> {
        let mut groups: BTreeMap<u32, Group> = BTreeMap::new();
        let empty = |label: u32| Group { label, vertices: [0; 2], triangles: [0; 2], first: [u32::MAX, 0, 0] };
        let mut reached = 0;
        for same in corners.chunk_by(|a, b| a.0 == b.0) {
            let group = groups.entry(same[0].0).or_insert_with(|| empty(same[0].0));
            let Corner { x, y, z, .. } = same[0].1;
            group.first = [x.into(), y.into(), z.to_bits()];
            group.vertices = [reached, reached + same.len() as u32];
            reached += same.len() as u32;
        }
        reached = 0;
        for same in triangles.chunk_by(|a, b| a.0 == b.0) {
            let group = groups.entry(same[0].0).or_insert_with(|| empty(same[0].0));
            group.triangles = [reached, reached + same.len() as u32];
            reached += same.len() as u32;
        }
        let name = |array: &str| self.name(array, patch.kind);
        self.write(&name("corners"), patch.brick, &corners.iter().map(|(_, corner)| *corner).collect::<Vec<_>>())?;
        self.write(&name("faces"), patch.brick, &triangles.iter().map(|(_, triangle)| *triangle).collect::<Vec<_>>())?;
        self.write(&name("groups"), patch.brick, &groups.into_values().collect::<Vec<_>>())
    }

    /// Puts the surfaces of all kinds into their order, by their first vertex, and tells which bricks have parts of them
    /// and which are built together.
    pub(crate) fn order(&self) -> Result<(), InterpError> {
        // By kind and label: the first vertex, counts, and members.
        let mut all: BTreeMap<(usize, u32), Whole> = BTreeMap::new();
        for kind in 0..self.kinds.len() {
            for brick in 0..self.tiles.count() {
                for Group { label, vertices, triangles, first: [x, y, z] } in
                    self.read::<Group>(&self.name("groups", kind), brick)?
                {
                    let (first, counts, members) = all.entry((kind, label)).or_default();
                    counts[0] += u64::from(vertices[1] - vertices[0]);
                    counts[1] += u64::from(triangles[1] - triangles[0]);
                    members.push(Member { brick: brick as u32, vertices, triangles });
                    if x != u32::MAX {
                        let vertex = Vertex { x: x as u16, y: y as u16, z: f32::from_bits(z) };
                        let before = |other: &Vertex| {
                            (other.x, other.y).cmp(&(vertex.x, vertex.y)).then(other.z.total_cmp(&vertex.z)).is_le()
                        };
                        *first = first.filter(before).or(Some(vertex));
                    }
                }
            }
        }
        let total = |which: usize| all.values().map(|(_, counts, _)| counts[which]).sum::<u64>();
        let (limit, triangles) = (u32::MAX as usize - 1, total(1).max(total(0)) as usize);
        if triangles > limit {
            return Err(InterpError::TooManyTriangles { triangles, limit });
        }
        let mut surfaces: Vec<_> = all.into_iter().collect();
        // Stable: of equal vertices the first kind comes first.
        surfaces.sort_by(|(_, (a, ..)), (_, (b, ..))| {
            let key = |vertex: &Option<Vertex>| vertex.map_or((u16::MAX, u16::MAX, f32::MAX), |v| (v.x, v.y, v.z));
            let (a, b) = (key(a), key(b));
            (a.0, a.1).cmp(&(b.0, b.1)).then(a.2.total_cmp(&b.2))
        });
        let (mut outlines, mut members, mut batches) = (Vec::new(), Vec::new(), vec![0u32]);
        let mut waiting = 0;
        for (n, ((kind, label), (_, counts, own))) in surfaces.into_iter().enumerate() {
            if waiting > 0 && waiting + counts[1] > self.together.min(TRIANGLES_OF_A_TASK) {
                batches.push(n as u32);
                waiting = 0;
            }
            waiting += counts[1];
            let first = members.len() as u32;
            members.extend(own);
            let (kind, counts, end) = (kind as u32, counts.map(|count| count as u32), members.len() as u32);
            outlines.push(Outline { kind, label, counts, members: [first, end] });
        }
        if !outlines.is_empty() {
            batches.push(outlines.len() as u32);
        }
        self.write("surfaces", 0, &outlines)?;
        self.write("members", 0, &members)?;
        self.write("batches", 0, &batches)
    }
}
