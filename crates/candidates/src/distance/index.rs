//! An index of triangles by position.
//!
//! A brick spans 4 × 4 cells and 8 samples and holds its triangles by cell, so that an empty brick is skipped
//! at once and a cell is found from any depth. A triangle is stored in every interval of depth that it
//! reaches into, so steep triangles need no special handling. For the whole volume only lists of triangle
//! numbers per row of bricks exist. Bricks are made for those rows that the current inlines can reach, each
//! row once.

use super::triangle::CellTriangle;
use crate::error::InterpError;
use crate::forest::Forest;
use crate::surfaces::Vertex;
use rayon::prelude::*;
use std::collections::VecDeque;
use std::ops::Range;

/// Edge of a brick, cells.
pub(crate) const BRICK: usize = 4;

/// Triangles of a row of bricks, each with its cell.
pub(crate) type CellRow = Vec<([u16; 2], CellTriangle)>;

/// Cells of a brick.
const CELLS: usize = BRICK * BRICK;

/// Samples of an interval of depth.
pub(crate) const INTERVAL: usize = 8;

/// Count of triangles put into lists at a time.
const CHUNK: usize = 1 << 16;

/// The triangles of each row of bricks, ascending.
pub(crate) struct TriangleLists {
    chunks: Vec<TriangleList>,
}

/// The triangles of each row of bricks, for one range of triangles.
struct TriangleList {
    /// Start of each row, and the end of the last.
    starts: Vec<u32>,
    triangles: Vec<u32>,
}

/// Near corner of the cell that contains a triangle.
fn cell(forest: &Forest, triangle: [u32; 3]) -> [usize; 2] {
    let [a, b, c] = triangle.map(|v| forest.surfaces.vertices[v as usize]);
    [a.x.min(b.x).min(c.x).into(), a.y.min(b.y).min(c.y).into()]
}

impl TriangleLists {
    pub(crate) fn new(forest: &Forest) -> Result<Self, InterpError> {
        let all = &forest.surfaces.triangles;
        let chunks = (0..all.len().div_ceil(CHUNK)).into_par_iter();
        let chunks = chunks.map(|n| TriangleList::new(forest, n * CHUNK..((n + 1) * CHUNK).min(all.len())));
        Ok(Self { chunks: chunks.collect::<Result<_, InterpError>>()? })
    }

    fn of_row(&self, row: usize) -> impl Iterator<Item = u32> {
        let list = move |chunk: &TriangleList| chunk.starts[row] as usize..chunk.starts[row + 1] as usize;
        self.chunks.iter().flat_map(move |chunk| chunk.triangles[list(chunk)].iter().copied())
    }
}

impl TriangleList {
    fn new(forest: &Forest, range: Range<usize>) -> Result<Self, InterpError> {
        let mut starts = vec![0u32; forest.surfaces.size[0].div_ceil(BRICK) + 1];
        let mut rows = Vec::with_capacity(range.len());
        for n in range.clone() {
            let triangle = forest.surfaces.triangles[n];
            if !within_a_cell(forest, triangle) {
                let surface = forest.surfaces.surfaces.partition_point(|part| part.triangles.end as usize <= n);
                let fact = "a triangle does not lie within one cell of the lattice with its corners on three traces";
                return Err(InterpError::MalformedSurfaces { surface, fact });
            }
            let row = cell(forest, triangle)[0] / BRICK;
            starts[row + 1] += 1;
            rows.push(row as u32);
        }
        for n in 1..starts.len() {
            starts[n] += starts[n - 1];
        }
        let mut ends = starts.clone();
        let mut triangles = vec![0u32; range.len()];
        for (n, row) in range.zip(rows) {
            let at = &mut ends[row as usize];
            triangles[*at as usize] = n as u32;
            *at += 1;
        }
        Ok(Self { starts, triangles })
    }
}

/// Whether a triangle lies in the lattice, within one cell, with its corners on three traces.
fn within_a_cell(forest: &Forest, triangle: [u32; 3]) -> bool {
    let [nx, ny, _] = forest.surfaces.size;
    let corners = triangle.map(|v| forest.surfaces.vertices[v as usize]);
    let [x, y] = cell(forest, triangle);
    let near = |v: &Vertex| {
        let (v_x, v_y) = (usize::from(v.x), usize::from(v.y));
        v_x - x < 2 && v_y - y < 2 && v_x < nx && v_y < ny && v.z.is_finite()
    };
    let [a, b, c] = corners.map(|v| (v.x, v.y));
    corners.iter().all(near) && a != b && b != c && c != a
}

/// The triangles near the current inlines, by row of bricks.
pub(crate) struct CellIndex {
    /// Number of the first row that exists.
    first: usize,
    rows: VecDeque<BrickRow>,
    /// Counts of rows of the volume, of bricks in a row, and of intervals of depth.
    counts: [usize; 3],
}

/// A row of bricks.
struct BrickRow {
    /// Start of each (brick along y, interval, cell), and the end of the last.
    starts: Vec<u32>,
    triangles: Vec<CellTriangle>,
    /// Least and greatest z of the triangles of each brick.
    z_ranges: Vec<[f32; 2]>,
}

/// The triangles of a brick.
pub(crate) struct Brick<'a> {
    /// Start of each cell, and the end of the last.
    starts: &'a [u32],
    triangles: &'a [CellTriangle],
    /// Least and greatest z; `None` when it is empty.
    pub(crate) z_range: Option<[f32; 2]>,
}

impl<'a> Brick<'a> {
    /// The triangles of a cell, numbered row · 4 + column within the brick.
    #[inline(always)]
    pub(crate) fn in_cell(&self, cell: usize) -> &'a [CellTriangle] {
        &self.triangles[self.starts[cell] as usize..self.starts[cell + 1] as usize]
    }
}

/// The triangles of a cell.
#[derive(Clone, Copy, Default)]
pub(crate) struct Cell<'a> {
    /// Starts, beginning with the first interval.
    starts: &'a [u32],
    triangles: &'a [CellTriangle],
}

impl<'a> Cell<'a> {
    /// The triangles in an interval of depth.
    #[inline(always)]
    pub(crate) fn within(&self, interval: usize) -> &'a [CellTriangle] {
        match self.starts.get(interval * CELLS..interval * CELLS + 2) {
            Some(&[start, end]) => &self.triangles[start as usize..end as usize],
            _ => &[],
        }
    }
}

impl CellIndex {
    /// An index for a volume of `size`, without rows.
    pub(crate) fn new(size: [usize; 3]) -> Self {
        let counts = [size[0].div_ceil(BRICK), size[1].div_ceil(BRICK), size[2].div_ceil(INTERVAL).max(1)];
        Self { first: 0, rows: VecDeque::new(), counts }
    }

    /// An index of triangles that are given with their cells, row by row.
    pub(crate) fn of_cells(size: [usize; 3], rows: Vec<CellRow>) -> Self {
        let mut index = Self::new(size);
        let [_, bricks, intervals] = index.counts;
        let made = rows.into_iter().map(|row| {
            let cells = row.into_iter().map(|(cell, triangle)| (cell.map(usize::from), triangle));
            BrickRow::of_cells(cells, [bricks, intervals])
        });
        index.rows = made.collect();
        index
    }

    /// Advances to the inlines `x`, which must lie beyond all earlier ones: makes the rows of their cells and
    /// drops the rows before.
    pub(crate) fn advance(&mut self, forest: &Forest, lists: &TriangleLists, x: Range<usize>) {
        let from = x.start / BRICK;
        while self.first < from && self.rows.pop_front().is_some() {
            self.first += 1;
        }
        if self.rows.is_empty() {
            self.first = from;
        }
        let missing = self.first + self.rows.len()..x.end.div_ceil(BRICK).min(self.counts[0]);
        let [_, bricks, intervals] = self.counts;
        let made = missing.into_par_iter().with_max_len(1);
        let made: Vec<BrickRow> = made.map(|row| BrickRow::new(forest, lists, row, [bricks, intervals])).collect();
        self.rows.extend(made);
    }

    /// Count of intervals of depth.
    pub(crate) fn intervals(&self) -> usize {
        self.counts[2]
    }

    /// The interval that contains a depth; the first and the last are open.
    #[inline(always)]
    pub(crate) fn interval(&self, z: f32) -> usize {
        interval(z, self.counts[2])
    }

    /// The triangles of a cell; none where there is no such cell.
    #[inline(always)]
    pub(crate) fn cell(&self, x: usize, y: usize) -> Cell<'_> {
        let Some(row) = (x / BRICK).checked_sub(self.first).and_then(|row| self.rows.get(row)) else {
            return Cell::default();
        };
        let start = y / BRICK * self.counts[2] * CELLS + (x % BRICK) * BRICK + y % BRICK;
        // The slice continues into later bricks, which are never requested.
        Cell { starts: row.starts.get(start..).unwrap_or_default(), triangles: &row.triangles }
    }

    /// A brick, by its numbers along x and y in the volume and its interval of depth.
    #[inline(always)]
    pub(crate) fn brick(&self, x: usize, y: usize, interval: usize) -> Brick<'_> {
        let row = &self.rows[x - self.first];
        let brick = y * self.counts[2] + interval;
        let starts = &row.starts[brick * CELLS..(brick + 1) * CELLS + 1];
        let is_empty = starts[0] == starts[CELLS];
        Brick { starts, triangles: &row.triangles, z_range: (!is_empty).then(|| row.z_ranges[brick]) }
    }

    /// The bricks, numbered in the volume, that have cells within `reach` of a column.
    #[inline(always)]
    pub(crate) fn bricks_within(&self, column: [usize; 2], reach: usize) -> [Range<usize>; 2] {
        let around = |at: usize, within: Range<usize>| {
            (at.saturating_sub(reach) / BRICK).max(within.start)..((at + reach) / BRICK + 1).min(within.end)
        };
        [around(column[0], self.first..self.first + self.rows.len()), around(column[1], 0..self.counts[1])]
    }
}

/// The interval, of `count`, that contains a depth.
#[inline(always)]
fn interval(z: f32, count: usize) -> usize {
    // The conversion to i32 saturates.
    ((z * (1.0 / INTERVAL as f32)) as i32).max(0).min(count as i32 - 1) as usize
}

impl BrickRow {
    fn new(forest: &Forest, lists: &TriangleLists, row: usize, counts: [usize; 2]) -> Self {
        // Triangles ascend, and so do their leaves.
        let (mut leaf, mut end) = (0, 0);
        let found = lists.of_row(row).map(|n| {
            if n >= end {
                leaf = forest.leaf_of_triangle(n);
                end = forest.nodes[forest.leaves[leaf as usize - 1] as usize].triangles.end;
            }
            cell_triangle(forest.surfaces.triangles[n as usize].map(|v| forest.surfaces.vertices[v as usize]), leaf)
        });
        Self::of_cells(found, counts)
    }

    /// A row of triangles with their cells.
    fn of_cells(cells: impl Iterator<Item = ([usize; 2], CellTriangle)>, [bricks, intervals]: [usize; 2]) -> Self {
        let mut starts = vec![0u32; bricks * intervals * CELLS + 1];
        let mut found: Vec<(u32, CellTriangle)> = Vec::new();
        let span = |triangle: &CellTriangle| triangle.z_range().map(|z| interval(z, intervals));
        for ([x, y], triangle) in cells {
            let first = y / BRICK * intervals * CELLS + (x % BRICK) * BRICK + y % BRICK;
            let [top, bottom] = span(&triangle);
            for interval in top..=bottom {
                starts[first + interval * CELLS + 1] += 1;
            }
            found.push((first as u32, triangle));
        }
        for n in 1..starts.len() {
            starts[n] += starts[n - 1];
        }
        let mut ends = starts.clone();
        let mut triangles = vec![CellTriangle::default(); starts[starts.len() - 1] as usize];
        let mut z_ranges = vec![[f32::INFINITY, f32::NEG_INFINITY]; bricks * intervals];
        for (first, triangle) in found {
            let [top, bottom] = span(&triangle);
            for interval in top..=bottom {
                let at = first as usize + interval * CELLS;
                triangles[ends[at] as usize] = triangle;
                ends[at] += 1;
                let ([high, low], range) = (triangle.z_range(), &mut z_ranges[at / CELLS]);
                *range = [range[0].min(high), range[1].max(low)];
            }
        }
        Self { starts, triangles, z_ranges }
    }
}

/// A triangle in the form that the search uses, with the near corner of its cell.
pub(crate) fn cell_triangle(corners: [Vertex; 3], leaf: u32) -> ([usize; 2], CellTriangle) {
    let [a, b, c] = corners;
    let cell: [usize; 2] = [a.x.min(b.x).min(c.x).into(), a.y.min(b.y).min(c.y).into()];
    // z by far in x, far in y.
    let mut z = [[f32::NAN; 2]; 2];
    for vertex in corners {
        z[usize::from(vertex.x) - cell[0]][usize::from(vertex.y) - cell[1]] = vertex.z;
    }
    // The corner between the others is opposite to the missing one.
    let missing = [(0, 0), (0, 1), (1, 0)].into_iter().find(|&(x, y)| z[x][y].is_nan()).unwrap_or((1, 1));
    let (x, y) = (1 - missing.0, 1 - missing.1);
    (cell, CellTriangle { z: [z[x][y], z[1 - x][y], z[x][1 - y]], code: leaf << 2 | (x << 1 | y) as u32 })
}
