//! The stage `trees`: whole surfaces, put together from their bricks, some at a time, each cut into its tree
//! ([`crate::forest`]); and the tables of all of them.
//!
//! A task numbers vertices, triangles, nodes and leaves from 0. What comes before it is added when they are read, so
//! tasks know nothing of one another and their size does not matter.

use super::Bricks;
use super::triangles::{Corner, Member, Outline};
use crate::error::InterpError;
use crate::forest;
use crate::surfaces::{Extremum, Vertex};
use bytemuck::{Pod, Zeroable};
use std::ops::Range;
use survey::Progress;
use survey::candidates::{ForestCounts, ForestRows};
use survey::source::SourceError;

/// Stands for "none" in a table.
const NONE: u32 = u32::MAX;

/// A triangle as the search for distances takes it, with its cell.
#[derive(Debug, Clone, Copy, PartialEq, Pod, Zeroable)]
#[repr(C)]
pub(crate) struct Cell {
    pub(crate) x: u16,
    pub(crate) y: u16,
    /// See [`crate::distance::CellTriangle`].
    pub(crate) z: [f32; 3],
    pub(crate) corner: u32,
}

/// A leaf: the cells that its triangles span, and where they are.
#[derive(Debug, Clone, Copy, PartialEq, Pod, Zeroable)]
#[repr(C)]
pub(crate) struct Leaf {
    /// Least cell along x and y, and the greatest.
    pub(crate) cells: [[u16; 2]; 2],
    pub(crate) triangles: [u32; 2],
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
    triangles: Vec<[u32; 3]>,
    surfaces: Vec<[u32; 5]>,
    nodes: Vec<[u32; 6]>,
    cells: Vec<Cell>,
    leaves: Vec<Leaf>,
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
        self.write("tree-cells", batch, &made.cells)?;
        self.write("tree-leaves", batch, &made.leaves)
    }

    /// A surface out of its bricks: vertices in the order of traces, triangles in that of their cells.
    fn surface(&self, outline: &Outline) -> Result<(Vec<Vertex>, Vec<[u32; 3]>), InterpError> {
        let mut members = vec![Member::zeroed(); (outline.members[1] - outline.members[0]) as usize];
        self.read_at("members", 0, outline.members[0] as usize, &mut members)?;
        let kind = outline.kind as usize;
        let mut corners = vec![Corner::zeroed(); outline.counts[0] as usize];
        let mut triangles = vec![[0u32; 3]; outline.counts[1] as usize];
        let mut reached = [0; 2];
        for Member { brick, vertices, triangles: own } in &members {
            let [v, t] = [vertices, own].map(|range| (range[1] - range[0]) as usize);
            let out = &mut corners[reached[0]..reached[0] + v];
            self.read_at(&self.name("corners", kind), *brick as usize, vertices[0] as usize, out)?;
            let out = &mut triangles[reached[1]..reached[1] + t];
            self.read_at(&self.name("faces", kind), *brick as usize, own[0] as usize, out)?;
            reached = [reached[0] + v, reached[1] + t];
        }
        let whole = members.len() == 1;
        if !whole {
            // Those of each brick ascend, which a stable sort makes use of.
            corners.sort_by_key(|corner| corner.index);
        }
        let mut finder = Finder { corners: &corners, near: [0; 2] };
        for corner in triangles.as_flattened_mut() {
            *corner = finder.place(*corner).ok_or_else(|| InterpError::DamagedArray { array: "faces".to_owned() })?;
        }
        if !whole {
            // All triangles of one cell are of one brick, in their order.
            let trace = |triangle: [u32; 3]| {
                let [a, b, c] = triangle.map(|v| corners[v as usize]);
                u32::from(a.x.min(b.x).min(c.x)) << 16 | u32::from(a.y.min(b.y).min(c.y))
            };
            let mut placed: Vec<(u32, [u32; 3])> = triangles.into_iter().map(|own| (trace(own), own)).collect();
            placed.sort_by_key(|(trace, _)| *trace);
            triangles = placed.into_iter().map(|(_, own)| own).collect();
        }
        let vertices = corners.iter().map(|corner| Vertex { x: corner.x, y: corner.y, z: corner.z }).collect();
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
        let [node, vertex, triangle] = [made.nodes.len(), made.z.len(), made.triangles.len()].map(|n| n as u32);
        for own in &tree.nodes {
            let [a, b] = own.children.map_or([NONE; 2], |children| children.map(|child| node + child));
            let [first, end] = [own.triangles.start + triangle, own.triangles.end + triangle];
            made.nodes.push([own.parent.map_or(NONE, |parent| node + parent), a, b, surface, first, end]);
            if own.children.is_none() {
                let mut cells = [[u16::MAX; 2], [0; 2]];
                for corners in &triangles[own.triangles.start as usize..own.triangles.end as usize] {
                    let cell = cell_of(vertices, *corners);
                    for (axis, at) in [cell.x, cell.y].into_iter().enumerate() {
                        cells[0][axis] = cells[0][axis].min(at);
                        cells[1][axis] = cells[1][axis].max(at);
                    }
                    made.cells.push(cell);
                }
                made.leaves.push(Leaf { cells, triangles: [first, end] });
            }
        }
        made.trace.extend(vertices.iter().map(|v| [v.x, v.y]));
        made.z.extend(vertices.iter().map(|v| v.z));
        made.triangles.extend(triangles.iter().map(|corners| corners.map(|v| v + vertex)));
        let number = match self.kinds[kind as usize] {
            Extremum::Peak => 0,
            Extremum::Trough => 1,
            Extremum::Zero => 2,
        };
        let (end_vertex, end) = (made.z.len() as u32, made.triangles.len() as u32);
        made.surfaces.push([number, vertex, end_vertex, triangle, end]);
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
            starts.push(ForestCounts {
                vertices: before.vertices + self.count::<f32>("tree-z", batch)?,
                triangles: before.triangles + self.count::<[u32; 3]>("tree-triangles", batch)?,
                surfaces: before.surfaces + self.count::<[u32; 5]>("tree-surfaces", batch)?,
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

/// The cell of a triangle.
fn cell_of(vertices: &[Vertex], corners: [u32; 3]) -> Cell {
    let corners = corners.map(|v| vertices[v as usize]);
    let (cell, triangle) = crate::distance::cell_triangle(corners, 0);
    Cell { x: cell[0] as u16, y: cell[1] as u16, z: triangle.z, corner: triangle.code }
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
        for near in &mut self.near {
            let from = near.saturating_sub(NEAR);
            let around = &self.corners[from..(*near + NEAR).min(self.corners.len())];
            if let (Some(first), Some(last)) = (around.first(), around.last())
                && (first.index..=last.index).contains(&index)
            {
                *near = from + around.iter().position(|corner| corner.index == index)?;
                return Some(*near as u32);
            }
        }
        let found = self.corners.binary_search_by_key(&index, |corner| corner.index).ok()?;
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
        self.rows(
            "tree-triangles",
            rows,
            |counts| counts.triangles,
            |before, row: &mut [u32; 3]| {
                row.iter_mut().for_each(|corner| *corner += before.vertices as u32);
            },
        )
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
