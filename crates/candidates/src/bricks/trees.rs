//! The stage `trees`: whole surfaces, put together from their bricks, some at a time, each cut into its tree
//! ([`crate::forest`]); and the tables of all of them.
//!
//! A task numbers vertices, triangles, nodes and leaves from 0. What comes before it is added when they are read, so
//! tasks know nothing of one another and their size does not matter.

use super::Bricks;
use super::row_code::{self, Stretch};
use super::triangles::{Corner, CornersOfCell, Member, Outline, ring_of};
use crate::distance::CellTriangle;
use crate::error::InterpError;
use crate::forest;
use crate::grow::assemble::SHAPES;
use crate::surfaces::{Extremum, Vertex};
use bytemuck::{Pod, Zeroable};
use std::ops::Range;
use survey::Progress;
use survey::candidates::{ForestCounts, ForestRows};
use survey::source::SourceError;

/// Stands for "none" in a table.
const NONE: u32 = u32::MAX;

/// A leaf: the cells that its triangles span, and where they are.
#[derive(Debug, Clone, Copy, PartialEq, Pod, Zeroable)]
#[repr(C)]
pub(crate) struct Leaf {
    /// Least cell along x and y, and the greatest.
    cells: [[u16; 2]; 2],
    /// First of its task's triangles, and the end.
    triangles: [u32; 2],
    /// Its triangles in `tree-triangles`: numbers of the task's vertices.
    code: Stretch,
    /// Its vertices in `tree-corners`, as its triangles need them: the number among the task's, then as in [`Corner`].
    corners: Stretch,
}

impl Leaf {
    /// Whether the box that its cells span meets a box of cells.
    pub(crate) fn meets(&self, x: &Range<usize>, y: &Range<usize>) -> bool {
        let [low, high] = self.cells.map(|cell| cell.map(usize::from));
        let meets = |axis: usize, range: &Range<usize>| low[axis] < range.end && high[axis] >= range.start;
        meets(0, x) && meets(1, y)
    }
}

/// What a task makes.
#[derive(Default)]
struct Made {
    trace: Vec<[u16; 2]>,
    z: Vec<f32>,
    surfaces: Vec<[u32; 5]>,
    nodes: Vec<[u32; 6]>,
    leaves: Vec<Leaf>,
    /// Code of the triangles of leaves.
    triangles: Vec<u8>,
    /// Code of the vertices of leaves.
    corners: Vec<u8>,
    /// Count of triangles.
    reached: u32,
}

impl Bricks<'_> {
    /// Count of tasks.
    pub(crate) fn batches(&self) -> Result<usize, InterpError> {
        Ok(self.count::<u32>("batches", 0)?.saturating_sub(1))
    }

    /// Builds the trees of some surfaces.
    pub(crate) fn trees(&self, batch: usize, progress: &Progress) -> Result<(), InterpError> {
        let mut range = [0u32; 2];
        self.read_at("batches", 0, batch, &mut range)?;
        let mut outlines = vec![Outline::zeroed(); (range[1] - range[0]) as usize];
        self.read_at("surfaces", 0, range[0] as usize, &mut outlines)?;
        let mut made = Made::default();
        let count = outlines.iter().map(|outline| outline.counts[0] as usize).sum();
        made.trace.reserve_exact(count);
        made.z.reserve_exact(count);
        for (outline, surface) in outlines.into_iter().zip(range[0]..) {
            progress.check()?;
            let (vertices, triangles) = self.surface(&outline)?;
            self.plant(&mut made, surface, outline.kind, &vertices, triangles, progress)?;
        }
        self.write("tree-trace", batch, &made.trace)?;
        self.write("tree-z", batch, &made.z)?;
        self.write("tree-triangles", batch, &made.triangles)?;
        self.write("tree-surfaces", batch, &made.surfaces)?;
        self.write("tree-nodes", batch, &made.nodes)?;
        self.write("tree-corners", batch, &made.corners)?;
        self.write("tree-leaves", batch, &made.leaves)
    }

    /// A surface out of its bricks: vertices in the order of traces, triangles in that of their cells.
    fn surface(&self, outline: &Outline) -> Result<(Vec<Vertex>, Vec<[u32; 3]>), InterpError> {
        let mut members = vec![Member::zeroed(); (outline.members[1] - outline.members[0]) as usize];
        self.read_at("members", 0, outline.members[0] as usize, &mut members)?;
        let [corners_name, cells_name] = ["corners", "cells"].map(|array| self.name(array, outline.kind as usize));
        let mut corners: Vec<Corner> = Vec::with_capacity(outline.counts[0] as usize);
        let mut cells: Vec<CornersOfCell> =
            Vec::with_capacity(members.iter().map(|member| member.cells.rows as usize).sum());
        let mut room = Vec::new();
        for Member { brick, vertices, cells: own } in &members {
            self.rows_of(&corners_name, *brick as usize, vertices, &mut room, &mut corners)?;
            self.rows_of(&cells_name, *brick as usize, own, &mut room, &mut cells)?;
        }
        if members.len() > 1 {
            // Those of each brick ascend, which a stable sort makes use of.
            corners.sort_by_key(|[index, ..]| *index);
            cells.sort_by_key(|[index, ..]| *index);
        }
        let mut finder = Finder { corners: &corners, near: [0; 2] };
        let mut triangles = Vec::with_capacity(outline.counts[1] as usize);
        let damaged = || InterpError::DamagedArray { array: cells_name.clone() };
        for cell in cells {
            let shape = SHAPES.get(cell[4] as usize).ok_or_else(damaged)?;
            // Only corners that a triangle uses are vertices.
            let ring = ring_of(cell).map(|index| finder.place(index));
            for places in *shape {
                let [a, b, c] = places.map(|place| ring[place]);
                triangles.push([a.ok_or_else(damaged)?, b.ok_or_else(damaged)?, c.ok_or_else(damaged)?]);
            }
        }
        let vertices = corners.iter().map(|&[_, x, y, z]| vertex_of([x, y, z])).collect();
        Ok((vertices, triangles))
    }

    /// Cuts a surface into its tree, and adds both to what the task makes.
    fn plant(
        &self,
        made: &mut Made,
        surface: u32,
        kind: u32,
        vertices: &[Vertex],
        mut triangles: Vec<[u32; 3]>,
        progress: &Progress,
    ) -> Result<(), InterpError> {
        let tree = forest::tree(vertices, &mut triangles, &self.settings.forest, progress)?;
        let [node, vertex, triangle] = [made.nodes.len() as u32, made.z.len() as u32, made.reached];
        // The vertices of a leaf, and the leaf that each vertex was met in last, counted from 1.
        let (mut numbers, mut met) = (Vec::new(), vec![0u32; vertices.len()]);
        for own in &tree.nodes {
            let [a, b] = own.children.map_or([NONE; 2], |children| children.map(|child| node + child));
            let [first, end] = [own.triangles.start + triangle, own.triangles.end + triangle];
            made.nodes.push([own.parent.map_or(NONE, |parent| node + parent), a, b, surface, first, end]);
            if own.children.is_none() {
                let triangles = &triangles[own.triangles.start as usize..own.triangles.end as usize];
                let mut cells = [[u16::MAX; 2], [0; 2]];
                for corners in triangles {
                    let [a, b, c] = corners.map(|v| vertices[v as usize]);
                    for (axis, at) in [a.x.min(b.x).min(c.x), a.y.min(b.y).min(c.y)].into_iter().enumerate() {
                        cells[0][axis] = cells[0][axis].min(at);
                        cells[1][axis] = cells[1][axis].max(at);
                    }
                }
                numbers.clear();
                let leaf = made.leaves.len() as u32 + 1;
                let is_new = |&v: &u32| std::mem::replace(&mut met[v as usize], leaf) != leaf;
                numbers.extend(triangles.as_flattened().iter().copied().filter(is_new));
                let corner = |&v: &u32| {
                    let Vertex { x, y, z } = vertices[v as usize];
                    [v + vertex, x.into(), y.into(), z.to_bits()]
                };
                let corners = row_code::add(numbers.iter().map(corner), &mut made.corners);
                let numbered = triangles.iter().map(|corners| corners.map(|v| v + vertex));
                let code = row_code::add(numbered, &mut made.triangles);
                made.leaves.push(Leaf { cells, triangles: [first, end], code, corners });
            }
        }
        made.trace.extend(vertices.iter().map(|v| [v.x, v.y]));
        made.z.extend(vertices.iter().map(|v| v.z));
        made.reached += triangles.len() as u32;
        let number = match self.kinds[kind as usize] {
            Extremum::Peak => 0,
            Extremum::Trough => 1,
            Extremum::Zero => 2,
        };
        made.surfaces.push([number, vertex, made.z.len() as u32, triangle, made.reached]);
        Ok(())
    }

    /// The triangles of a leaf near columns, as the search for distances takes them: `put` gets the cell of each.
    pub(super) fn cells_of(
        &self,
        batch: usize,
        leaf: &Leaf,
        id: u32,
        room: &mut LeafRoom,
        mut put: impl FnMut([usize; 2], CellTriangle),
    ) -> Result<(), InterpError> {
        let LeafRoom { code, triangles, corners, places } = room;
        triangles.clear();
        corners.clear();
        self.rows_of("tree-triangles", batch, &leaf.code, code, triangles)?;
        self.rows_of("tree-corners", batch, &leaf.corners, code, corners)?;
        let damaged = || InterpError::DamagedArray { array: "tree-corners".to_owned() };
        let numbers = || corners.iter().map(|[number, ..]| *number);
        let (Some(first), Some(last)) = (numbers().min(), numbers().max()) else { return Err(damaged()) };
        // What other leaves left in it is not asked for: triangles have no vertices but those of their own leaf.
        places.resize(places.len().max((last - first) as usize + 1), 0);
        numbers().zip(0..).for_each(|(number, place)| places[(number - first) as usize] = place);
        for numbers in triangles {
            let mut vertices = [Vertex { x: 0, y: 0, z: 0.0 }; 3];
            for (vertex, number) in vertices.iter_mut().zip(numbers) {
                let place = *places.get(number.wrapping_sub(first) as usize).ok_or_else(damaged)?;
                let [_, x, y, z] = *corners.get(place as usize).ok_or_else(damaged)?;
                *vertex = vertex_of([x, y, z]);
            }
            let (cell, triangle) = crate::distance::cell_triangle(vertices, id);
            put(cell, triangle);
        }
        Ok(())
    }

    /// The tables of all surfaces and trees, once the stage has run.
    ///
    /// # Errors
    /// An array cannot be read.
    pub fn forest(&self) -> Result<BrickForest<'_>, InterpError> {
        let batches = self.batches()?;
        let mut starts = vec![ForestCounts::default()];
        let mut leaves = vec![0];
        for batch in 0..batches {
            let before = starts[batch];
            let surfaces = self.count::<[u32; 5]>("tree-surfaces", batch)?;
            let mut last = [[0; 5]];
            self.read_at("tree-surfaces", batch, surfaces.saturating_sub(1), &mut last)?;
            starts.push(ForestCounts {
                vertices: before.vertices + self.count::<f32>("tree-z", batch)?,
                triangles: before.triangles + last[0][4] as usize,
                surfaces: before.surfaces + surfaces,
                nodes: before.nodes + self.count::<[u32; 6]>("tree-nodes", batch)?,
            });
            leaves.push(leaves[batch] + self.count::<Leaf>("tree-leaves", batch)?);
        }
        let count = leaves[batches];
        if count > forest::MAX_TRIANGLES {
            return Err(InterpError::TooManyTriangles { triangles: count, limit: forest::MAX_TRIANGLES });
        }
        Ok(BrickForest { bricks: self, starts, leaves })
    }
}

/// A vertex of its trace and the bits of its z.
fn vertex_of([x, y, z]: [u32; 3]) -> Vertex {
    Vertex { x: x as u16, y: y as u16, z: f32::from_bits(z) }
}

/// Room for one leaf after the other.
#[derive(Default)]
pub(super) struct LeafRoom {
    code: Vec<u8>,
    triangles: Vec<[u32; 3]>,
    corners: Vec<Corner>,
    /// The place of each vertex among the leaf's, from the first on.
    places: Vec<u32>,
}

/// Finds vertices by their index; those asked for follow one another on two lines.
struct Finder<'a> {
    corners: &'a [Corner],
    near: [usize; 2],
}

/// Vertices looked at before and behind the last one.
const NEAR: usize = 8;

impl Finder<'_> {
    fn place(&mut self, index: u32) -> Option<u32> {
        let is_at = |at: &usize| self.corners.get(*at).is_some_and(|[own, ..]| *own == index);
        if let Some((near, at)) =
            self.near.iter_mut().find_map(|near| [*near, *near + 1].into_iter().find(is_at).map(|at| (near, at)))
        {
            *near = at;
            return Some(at as u32);
        }
        for near in &mut self.near {
            let from = near.saturating_sub(NEAR);
            let around = &self.corners[from..(*near + NEAR).min(self.corners.len())];
            if let (Some([first, ..]), Some([last, ..])) = (around.first(), around.last())
                && (first..=last).contains(&&index)
            {
                *near = from + around.iter().position(|[own, ..]| *own == index)?;
                return Some(*near as u32);
            }
        }
        let found = self.corners.binary_search_by_key(&index, |[own, ..]| *own).ok()?;
        // The cursor on the nearer line goes there.
        let farther = usize::from(self.near[0].abs_diff(found) > self.near[1].abs_diff(found));
        self.near[farther] = found;
        Some(found as u32)
    }
}

/// The tables of surfaces and trees of an extraction in bricks.
pub struct BrickForest<'a> {
    bricks: &'a Bricks<'a>,
    /// What comes before each task, and the counts of all.
    starts: Vec<ForestCounts>,
    /// Leaves before each task, and the count of all.
    leaves: Vec<usize>,
}

impl BrickForest<'_> {
    /// Count of leaves.
    pub fn leaf_count(&self) -> usize {
        self.leaves[self.leaves.len() - 1]
    }

    /// The leaves with cells in a box of cells, with their ids and the task that made them, each with its triangles.
    pub(crate) fn leaves_within(
        &self,
        x: &Range<usize>,
        y: &Range<usize>,
    ) -> Result<Vec<(usize, u32, Leaf)>, InterpError> {
        let mut found = Vec::new();
        for batch in 0..self.starts.len() - 1 {
            let leaves: Vec<Leaf> = self.bricks.read("tree-leaves", batch)?;
            for (leaf, id) in leaves.into_iter().zip(self.leaves[batch] as u32 + 1..) {
                if leaf.meets(x, y) {
                    found.push((batch, id, leaf));
                }
            }
        }
        Ok(found)
    }

    /// Rows of a table; `count` tells how many there are by a task's start, `moved` adds it to a row.
    fn rows<T: Pod>(
        &self,
        array: &str,
        range: Range<usize>,
        count: impl Fn(&ForestCounts) -> usize,
        moved: impl Fn(&ForestCounts, &mut T),
    ) -> Result<Vec<T>, SourceError> {
        let mut rows = vec![T::zeroed(); range.len()];
        let mut at = range.start;
        while at < range.end {
            let batch = self.starts.partition_point(|start| count(start) <= at) - 1;
            let (start, end) = (count(&self.starts[batch]), count(&self.starts[batch + 1]).min(range.end));
            let out = &mut rows[at - range.start..end - range.start];
            self.bricks.read_at(array, batch, at - start, out)?;
            out.iter_mut().for_each(|row| moved(&self.starts[batch], row));
            at = end;
        }
        Ok(rows)
    }
}

impl ForestRows for BrickForest<'_> {
    fn counts(&self) -> ForestCounts {
        self.starts[self.starts.len() - 1]
    }

    fn trace(&self, rows: Range<usize>) -> Result<Vec<[u16; 2]>, SourceError> {
        self.rows("tree-trace", rows, |counts| counts.vertices, |_, _| {})
    }

    fn z(&self, rows: Range<usize>) -> Result<Vec<f32>, SourceError> {
        self.rows("tree-z", rows, |counts| counts.vertices, |_, _| {})
    }

    fn triangles(&self, rows: Range<usize>) -> Result<Vec<[u32; 3]>, SourceError> {
        let mut found = Vec::with_capacity(rows.len());
        let (mut code, mut own) = (Vec::new(), Vec::new());
        while found.len() < rows.len() {
            let at = rows.start + found.len();
            let batch = self.starts.partition_point(|start| start.triangles <= at) - 1;
            let ForestCounts { triangles: start, vertices, .. } = self.starts[batch];
            let leaves: Vec<Leaf> = self.bricks.read("tree-leaves", batch)?;
            let first = leaves.partition_point(|leaf| start + leaf.triangles[1] as usize <= at);
            let before = found.len();
            for leaf in &leaves[first..] {
                let [from, end] = leaf.triangles.map(|triangle| start + triangle as usize);
                if from >= rows.end {
                    break;
                }
                own.clear();
                self.bricks.rows_of("tree-triangles", batch, &leaf.code, &mut code, &mut own)?;
                let asked = rows.start.max(from) - from..rows.end.min(end) - from;
                let asked = own.get(asked).ok_or("triangles of a leaf are missing")?;
                found.extend(asked.iter().map(|corners: &[u32; 3]| corners.map(|corner| corner + vertices as u32)));
            }
            if found.len() == before {
                return Err("triangles of a surface are missing".into());
            }
        }
        Ok(found)
    }

    fn surfaces(&self, rows: Range<usize>) -> Result<Vec<[u32; 5]>, SourceError> {
        self.rows(
            "tree-surfaces",
            rows,
            |counts| counts.surfaces,
            |before, [_, v, w, t, u]: &mut [u32; 5]| {
                [v, w].into_iter().for_each(|vertex| *vertex += before.vertices as u32);
                [t, u].into_iter().for_each(|triangle| *triangle += before.triangles as u32);
            },
        )
    }

    fn nodes(&self, rows: Range<usize>) -> Result<Vec<[u32; 6]>, SourceError> {
        self.rows(
            "tree-nodes",
            rows,
            |counts| counts.nodes,
            |before, [parent, a, b, _, t, u]: &mut [u32; 6]| {
                for node in [parent, a, b].into_iter().filter(|node| **node != NONE) {
                    *node += before.nodes as u32;
                }
                [t, u].into_iter().for_each(|triangle| *triangle += before.triangles as u32);
            },
        )
    }
}
