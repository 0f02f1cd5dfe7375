//! Triangles by where they are.
//!
//! Coarsely for the whole volume: bins of 16 × 16 cells, as lists of triangle numbers. Finely for the surroundings of one
//! block: bricks of 4 × 4 cells and 8 samples, in a brick by cell, so that an empty brick is passed over at once. A triangle stands in
//! every interval of depth that it reaches into, so steep ones need no allowance.

use super::triangle::CellTriangle;
use crate::error::Error;
use crate::forest::Forest;
use std::ops::Range;

/// Edge of a bin, cells.
const BIN: usize = 16;

/// Edge of a brick, cells.
pub(super) const BRICK: usize = 4;

/// Cells of a brick.
const CELLS: usize = BRICK * BRICK;

/// Samples of an interval of depth.
pub(super) const INTERVAL: usize = 8;

/// The triangles of each bin, ascending.
pub(super) struct TriangleBins {
    counts: [usize; 2],
    starts: Vec<u32>,
    triangles: Vec<u32>,
}

/// Near corner of the cell that a triangle lies in.
fn cell(forest: &Forest, triangle: [u32; 3]) -> [usize; 2] {
    let [a, b, c] = triangle.map(|v| forest.surfaces.vertices[v as usize]);
    [a.x.min(b.x).min(c.x).into(), a.y.min(b.y).min(c.y).into()]
}

impl TriangleBins {
    pub(super) fn new(forest: &Forest) -> Result<Self, Error> {
        let [nx, ny, _] = forest.surfaces.size;
        let counts = [nx.div_ceil(BIN), ny.div_ceil(BIN)];
        let all = &forest.surfaces.triangles;
        let bin = |triangle: &[u32; 3]| {
            let [x, y] = cell(forest, *triangle);
            (x / BIN) * counts[1] + y / BIN
        };
        let mut starts = vec![0u32; counts[0] * counts[1] + 1];
        for (n, triangle) in all.iter().enumerate() {
            if !within_a_cell(forest, *triangle) {
                let surface = forest.surfaces.surfaces.partition_point(|part| part.triangles.end as usize <= n);
                let fact = "a triangle does not lie within one cell of the lattice with its corners on three traces";
                return Err(Error::MalformedSurfaces { surface, fact });
            }
            starts[bin(triangle) + 1] += 1;
        }
        for n in 1..starts.len() {
            starts[n] += starts[n - 1];
        }
        let mut ends = starts.clone();
        let mut triangles = vec![0u32; all.len()];
        for (n, triangle) in all.iter().enumerate() {
            let at = &mut ends[bin(triangle)];
            triangles[*at as usize] = n as u32;
            *at += 1;
        }
        Ok(Self { counts, starts, triangles })
    }

    /// Bins that have cells in a range of columns, as ranges of triangle lists.
    fn around(&self, x: &Range<usize>, y: &Range<usize>) -> impl Iterator<Item = &[u32]> {
        let bins = |range: &Range<usize>, count: usize| range.start / BIN..range.end.div_ceil(BIN).min(count);
        let columns = bins(y, self.counts[1]);
        bins(x, self.counts[0])
            .flat_map(move |i| columns.clone().map(move |j| i * self.counts[1] + j))
            .map(|bin| &self.triangles[self.starts[bin] as usize..self.starts[bin + 1] as usize])
    }
}

/// Whether a triangle is what the search relies on.
fn within_a_cell(forest: &Forest, triangle: [u32; 3]) -> bool {
    let [nx, ny, _] = forest.surfaces.size;
    let corners = triangle.map(|v| forest.surfaces.vertices[v as usize]);
    let [x, y] = cell(forest, triangle);
    let near = |v: &crate::surfaces::Vertex| {
        let (v_x, v_y) = (usize::from(v.x), usize::from(v.y));
        v_x - x < 2 && v_y - y < 2 && v_x < nx && v_y < ny && v.z.is_finite()
    };
    let [a, b, c] = corners.map(|v| (v.x, v.y));
    corners.iter().all(near) && a != b && b != c && c != a
}

/// The triangles around a block.
pub(super) struct CellIndex {
    /// Near corner of the first brick, cells, a multiple of the brick.
    origin: [usize; 2],
    /// Bricks along x, y, z.
    pub(super) counts: [usize; 3],
    /// First triangle of each (brick, cell); one more at the end.
    starts: Vec<u32>,
    triangles: Vec<CellTriangle>,
    /// Least and greatest z of the triangles of each brick.
    z_ranges: Vec<[f32; 2]>,
}

/// The triangles of a brick.
pub(super) struct Brick<'a> {
    /// First triangle of each cell; one more at the end.
    starts: &'a [u32],
    triangles: &'a [CellTriangle],
    /// Least and greatest z; `None` when it is empty.
    pub(super) z_range: Option<[f32; 2]>,
}

impl<'a> Brick<'a> {
    /// Triangles of a cell: row · 4 + column of it.
    pub(super) fn in_cell(&self, cell: usize) -> &'a [CellTriangle] {
        &self.triangles[self.starts[cell] as usize..self.starts[cell + 1] as usize]
    }
}

impl CellIndex {
    /// Indexes the cells of the columns `x`, `y`.
    pub(super) fn new(forest: &Forest, bins: &TriangleBins, x: Range<usize>, y: Range<usize>) -> Self {
        let origin = [x.start / BRICK * BRICK, y.start / BRICK * BRICK];
        let nz = forest.surfaces.size[2];
        let counts =
            [(x.end - origin[0]).div_ceil(BRICK), (y.end - origin[1]).div_ceil(BRICK), nz.div_ceil(INTERVAL).max(1)];
        let mut index = Self { origin, counts, starts: Vec::new(), triangles: Vec::new(), z_ranges: Vec::new() };
        let mut starts = vec![0u32; counts.iter().product::<usize>() * CELLS + 1];
        index.each(forest, bins, &x, &y, |at, _| starts[at + 1] += 1);
        for n in 1..starts.len() {
            starts[n] += starts[n - 1];
        }
        let mut ends = starts.clone();
        let mut triangles = vec![CellTriangle::default(); starts[starts.len() - 1] as usize];
        let mut z_ranges = vec![[f32::INFINITY, f32::NEG_INFINITY]; counts.iter().product()];
        index.each(forest, bins, &x, &y, |at, triangle| {
            triangles[ends[at] as usize] = triangle;
            ends[at] += 1;
            let ([high, low], range) = (triangle.z_range(), &mut z_ranges[at / CELLS]);
            *range = [range[0].min(high), range[1].max(low)];
        });
        index.z_ranges = z_ranges;
        index.starts = starts;
        index.triangles = triangles;
        index
    }

    /// Visits every triangle of the cells at every place where it stands.
    fn each(
        &self,
        forest: &Forest,
        bins: &TriangleBins,
        x: &Range<usize>,
        y: &Range<usize>,
        mut visit: impl FnMut(usize, CellTriangle),
    ) {
        for list in bins.around(x, y) {
            // Triangles ascend, and so do the leaves they are in.
            let (mut leaf, mut end) = (0, 0);
            for &n in list {
                let corners = forest.surfaces.triangles[n as usize];
                let [cell_x, cell_y] = cell(forest, corners);
                if !(x.contains(&cell_x) && y.contains(&cell_y)) {
                    continue;
                }
                if n >= end {
                    leaf = forest.leaf_of_triangle(n);
                    end = forest.nodes[forest.leaves[leaf as usize - 1] as usize].triangles.end;
                }
                let triangle = cell_triangle(forest, corners, [cell_x, cell_y], leaf);
                let [top, bottom] = triangle.z_range().map(|z| self.interval(z));
                for interval in top..=bottom {
                    visit(self.place(cell_x, cell_y, interval), triangle);
                }
            }
        }
    }

    /// Interval that a depth lies in; the first and last reach to infinity.
    #[inline(always)]
    pub(super) fn interval(&self, z: f32) -> usize {
        // The conversion saturates at 0.
        ((z / INTERVAL as f32) as usize).min(self.counts[2] - 1)
    }

    /// Index into `starts` of a cell in an interval.
    fn place(&self, x: usize, y: usize, interval: usize) -> usize {
        let [x, y] = [x - self.origin[0], y - self.origin[1]];
        let brick = ((x / BRICK) * self.counts[1] + y / BRICK) * self.counts[2] + interval;
        brick * CELLS + (x % BRICK) * BRICK + y % BRICK
    }

    /// Triangles of a cell, interval by interval from the top; none where the cell is not indexed.
    #[inline(always)]
    pub(super) fn below(&self, x: usize, y: usize) -> impl Iterator<Item = (usize, &[CellTriangle])> {
        let end = [0, 1].map(|axis| self.origin[axis] + self.counts[axis] * BRICK);
        let is_inside = (self.origin[0]..end[0]).contains(&x) && (self.origin[1]..end[1]).contains(&y);
        let starts = if is_inside { &self.starts[self.place(x, y, 0)..] } else { &[] };
        let ends = starts.get(1..).unwrap_or_default();
        let lists = starts.iter().zip(ends).step_by(CELLS).take(self.counts[2]);
        lists.enumerate().map(|(n, (&start, &end))| (n, &self.triangles[start as usize..end as usize]))
    }

    /// A brick, by its number along x and y in the volume, and the interval of depth.
    pub(super) fn brick(&self, x: usize, y: usize, interval: usize) -> Brick<'_> {
        let [x, y] = [x - self.origin[0] / BRICK, y - self.origin[1] / BRICK];
        let brick = (x * self.counts[1] + y) * self.counts[2] + interval;
        let starts = &self.starts[brick * CELLS..(brick + 1) * CELLS + 1];
        let is_empty = starts[0] == starts[CELLS];
        Brick { starts, triangles: &self.triangles, z_range: (!is_empty).then(|| self.z_ranges[brick]) }
    }

    /// Bricks, numbered in the volume, that have cells within `reach` of a column.
    pub(super) fn bricks_within(&self, column: [usize; 2], reach: usize) -> [Range<usize>; 2] {
        [0, 1].map(|axis| {
            let first = self.origin[axis] / BRICK;
            let from = (column[axis].saturating_sub(reach) / BRICK).max(first);
            from..((column[axis] + reach) / BRICK + 1).min(first + self.counts[axis])
        })
    }
}

/// A triangle as the search wants it.
fn cell_triangle(forest: &Forest, corners: [u32; 3], cell: [usize; 2], leaf: u32) -> CellTriangle {
    // z by far in x, far in y.
    let mut z = [[f32::NAN; 2]; 2];
    for corner in corners {
        let vertex = forest.surfaces.vertices[corner as usize];
        z[usize::from(vertex.x) - cell[0]][usize::from(vertex.y) - cell[1]] = vertex.z;
    }
    // The corner between the others is opposite to the one that is missing.
    let missing = [(0, 0), (0, 1), (1, 0)].into_iter().find(|&(x, y)| z[x][y].is_nan()).unwrap_or((1, 1));
    let (x, y) = (1 - missing.0, 1 - missing.1);
    CellTriangle { z: [z[x][y], z[1 - x][y], z[x][1 - y]], code: leaf << 2 | (x << 1 | y) as u32 }
}
