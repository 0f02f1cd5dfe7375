//! Stages from labels to surfaces: `triangles`, `order` ([`crate::grow::assemble`]).
//!
//! A brick makes the triangles of the cells that begin on its traces, and lists its vertices that any triangle uses,
//! surface by surface. Vertices are named by their index in the survey until a whole surface is put together.

use super::Bricks;
use super::patch::Values;
use super::row_code::{Coder, Stretch};
use super::tiles::Halo;
use crate::error::InterpError;
use crate::grow::assemble::CellTriangles;
use crate::grow::links::{Links, NEXT_X, NEXT_Y, NONE};
use crate::surfaces::Vertex;
use bytemuck::{Pod, Zeroable};
use std::collections::{BTreeMap, HashMap};

/// Triangles of the surfaces whose trees one task builds, unless one surface has more: few seconds of work, so that many
/// workers have enough tasks.
const TRIANGLES_OF_A_TASK: u64 = 1 << 20;

/// A vertex as bricks hand it on: its index among the extrema of the survey, its trace, and the bits of its z.
pub(crate) type Corner = [u32; 4];

/// A cell as bricks hand it on: the index of its first corner a, how much further the next along x and the next along y
/// are, how much further than the next along x the one along both is, and its number in
/// [`SHAPES`](crate::grow::assemble::SHAPES).
pub(crate) type CornersOfCell = [u32; 5];

/// The corners of a cell, one after the other around it ([`CellTriangles::ring`]).
pub(crate) fn ring_of([a, b, c, d, _]: CornersOfCell) -> [u32; 4] {
    let next = a.wrapping_add(b);
    [a, next, next.wrapping_add(d), a.wrapping_add(c)]
}

/// The cell with such corners.
fn cell_of(ring: [u32; 4], shape: usize) -> CornersOfCell {
    let [a, b, d, c] = ring;
    [a, b.wrapping_sub(a), c.wrapping_sub(a), d.wrapping_sub(b), shape as u32]
}

/// What a brick has of a surface.
#[derive(Debug, Clone, Copy, PartialEq, Pod, Zeroable)]
#[repr(C)]
pub(crate) struct Group {
    label: u32,
    /// The trace of the first vertex and the bits of its z, if there is one.
    first: [u32; 3],
    /// Its [`Corner`]s.
    vertices: Stretch,
    /// Its [`CornersOfCell`]s.
    cells: Stretch,
    /// Count of their triangles.
    triangles: u64,
}

/// A [`Group`] while it is gathered.
struct Part {
    label: u32,
    first: Option<[u32; 3]>,
    corners: Coder<4>,
    cells: Coder<5>,
    triangles: u64,
}

/// Number of the part of a surface that each extremum belongs to, and the parts, still empty.
fn parts(labels: &[u32], links: &Links) -> (Vec<u32>, Vec<Part>) {
    let (mut part_of, mut parts, mut known) = (vec![NONE; labels.len()], Vec::new(), HashMap::new());
    for (v, &label) in labels.iter().enumerate().filter(|(_, label)| **label != NONE) {
        if part_of[v] == NONE {
            part_of[v] = *known.entry(label).or_insert_with(|| {
                parts.push(Part {
                    label,
                    first: None,
                    corners: Coder::default(),
                    cells: Coder::default(),
                    triangles: 0,
                });
                parts.len() as u32 - 1
            });
        }
        // Most are found along links, which is faster than by their labels.
        for next in [NEXT_X, NEXT_Y].map(|direction| links.to[direction][v]).into_iter().filter(|next| *next != NONE) {
            if labels[next as usize] == label {
                part_of[next as usize] = part_of[v];
            }
        }
    }
    (part_of, parts)
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
    pub(crate) brick: u64,
    pub(crate) vertices: Stretch,
    pub(crate) cells: Stretch,
}

/// A surface while its parts are gathered: its first vertex, counts of vertices and triangles, and its members.
type Whole = (Option<Vertex>, [u64; 2], Vec<Member>);

impl Bricks<'_> {
    /// The vertices and triangles of a brick.
    pub(crate) fn triangles(&self, brick: usize) -> Result<(), InterpError> {
        for kind in 0..self.kinds.len() {
            let patch = self.patch(kind, brick, Halo::around(1), Values::Depths)?;
            let (links, labels) = (self.links_on(&patch)?, self.joined_labels(&patch)?);
            let (indices, own) = (patch.indices(), patch.is_own());
            let (part_of, mut parts) = parts(&labels, &links);
            let mut used = vec![false; labels.len()];
            for (v, is_own) in own.into_iter().enumerate() {
                let cell = CellTriangles::new(&patch.extrema, &links, &labels, v as u32);
                cell.triangles().as_flattened().iter().for_each(|&corner| used[corner as usize] = true);
                if let (true, Some([corner, ..])) = (is_own, cell.triangles().first()) {
                    let part = &mut parts[part_of[*corner as usize] as usize];
                    part.cells.push(cell_of(cell.ring.map(|corner| indices[corner as usize]), cell.shape));
                    part.triangles += cell.triangles().len() as u64;
                }
            }
            for ([x, y], v, index) in patch.own_extrema().filter(|&(_, v, _)| used[v] && labels[v] != NONE) {
                let part = &mut parts[part_of[v] as usize];
                let place = [x as u32, y as u32, patch.extrema.z[v].to_bits()];
                part.first.get_or_insert(place);
                part.corners.push([index, place[0], place[1], place[2]]);
            }
            parts.retain(|part| part.first.is_some() || part.triangles > 0);
            parts.sort_unstable_by_key(|part| part.label);
            let (mut corners, mut cells) = (Vec::new(), Vec::new());
            let groups: Vec<Group> = parts
                .into_iter()
                .map(|part| Group {
                    label: part.label,
                    first: part.first.unwrap_or([u32::MAX, 0, 0]),
                    vertices: part.corners.append_to(&mut corners),
                    cells: part.cells.append_to(&mut cells),
                    triangles: part.triangles,
                })
                .collect();
            self.write(&self.name("corners", kind), brick, &corners)?;
            self.write(&self.name("cells", kind), brick, &cells)?;
            self.write(&self.name("groups", kind), brick, &groups)?;
        }
        Ok(())
    }

    /// Puts the surfaces of all kinds into their order, by their first vertex, and tells which bricks have parts of them
    /// and which are built together.
    pub(crate) fn order(&self) -> Result<(), InterpError> {
        // By kind and label: the first vertex, counts, and members.
        let mut all: BTreeMap<(usize, u32), Whole> = BTreeMap::new();
        for kind in 0..self.kinds.len() {
            for brick in 0..self.tiles.count() {
                for Group { label, first: [x, y, z], vertices, cells, triangles } in
                    self.read::<Group>(&self.name("groups", kind), brick)?
                {
                    let (first, counts, members) = all.entry((kind, label)).or_default();
                    *counts = [counts[0] + vertices.rows, counts[1] + triangles];
                    members.push(Member { brick: brick as u64, vertices, cells });
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
