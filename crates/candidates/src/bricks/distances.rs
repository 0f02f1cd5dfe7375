//! The stage `distances`: the closest leaf of every voxel, in columns of traces ([`crate::distance`]).

use super::Bricks;
use super::run::BYTES_A_TRIANGLE;
use super::tiles::{Area, Halo, Tiling};
use super::trees::{Leaf, LeafRoom};
use crate::distance::{CandidateColumns, CellRow, ROW_CELLS, columns_among};
use crate::error::InterpError;
use std::ops::Range;
use survey::Progress;

/// Edge of a column, traces: that of the files in which candidates are stored.
pub(super) const COLUMN: usize = 128;

/// Least inlines of a column that are searched together.
const LEAST_LINES: usize = 8;

/// Bytes that the search takes for each triangle near its inlines: 20 as they are read, with room to grow, and 16 in each
/// interval of depth that the triangle reaches into.
const BYTES_NEAR: u64 = 52;

/// Triangles in a voxel, where there are many.
const DENSE: f64 = 0.7;

impl Bricks<'_> {
    /// The columns of the survey.
    pub(crate) fn columns(&self) -> Tiling {
        Tiling { size: [self.size[0], self.size[1]], edge: [COLUMN; 2] }
    }

    /// Distances and leaf ids of a column.
    pub(crate) fn distances(&self, column: usize, progress: &Progress) -> Result<(), InterpError> {
        let area = self.columns().area(column);
        let nz = self.size[2];
        let reach = self.settings.distance.max_distance.ceil() as usize + 2;
        // As many inlines as fit with those around them, which are searched again for the next ones.
        let triangles_a_line = DENSE * (area.y.len() + 2 * reach) as f64 * nz as f64;
        let fitting = (self.together * BYTES_A_TRIANGLE / BYTES_NEAR) as f64 / triangles_a_line;
        let most = (fitting as usize).saturating_sub(2 * reach).clamp(LEAST_LINES, COLUMN);
        let lines = area.x.len().div_ceil(area.x.len().div_ceil(most));
        let samples = area.traces() * nz;
        let (mut distance, mut leaf) = (Vec::<u8>::with_capacity(samples), Vec::<u32>::with_capacity(samples));
        let around = self.columns().with_halo(&area, Halo::around(reach));
        let leaves = self.forest()?.leaves_within(&around.x, &around.y)?;
        for first in area.x.clone().step_by(lines) {
            progress.check()?;
            let strip = Area { x: first..(first + lines).min(area.x.end), y: area.y.clone() };
            let around = self.columns().with_halo(&strip, Halo::around(reach));
            let cells = self.cells_within(&leaves, &around)?;
            let size = [around.x.len(), around.y.len(), nz];
            let local = |range: &Range<usize>, from: usize| range.start - from..range.end - from;
            let (x, y) = (local(&strip.x, around.x.start), local(&strip.y, around.y.start));
            let found = columns_among(size, &self.settings.distance, cells, x, y, progress)?;
            distance.extend(found.distance);
            leaf.extend(found.leaf);
        }
        let reached = leaf.iter().filter(|&&leaf| leaf != 0).count() as u32;
        self.write("reached", column, &[reached])?;
        self.write("distance", column, &distance)?;
        self.write_rows("leaf", column, leaf.into_iter().map(|leaf| [leaf]))
    }

    /// The triangles of leaves whose cells lie in an area, by cell of the area, in rows of [`ROW_CELLS`].
    fn cells_within(&self, leaves: &[(usize, u32, Leaf)], Area { x, y }: &Area) -> Result<Vec<CellRow>, InterpError> {
        let dense = (DENSE * (ROW_CELLS * y.len() * self.size[2]) as f64) as usize;
        let mut rows: Vec<CellRow> = (0..x.len().div_ceil(ROW_CELLS)).map(|_| Vec::with_capacity(dense)).collect();
        let mut room = LeafRoom::default();
        for (batch, id, leaf) in leaves.iter().filter(|(.., leaf)| leaf.meets(x, y)) {
            self.cells_of(*batch, leaf, *id, &mut room, |[cell_x, cell_y], triangle| {
                if x.contains(&cell_x) && y.contains(&cell_y) {
                    let at = [cell_x - x.start, cell_y - y.start];
                    rows[at[0] / ROW_CELLS].push((at.map(|cell| cell as u16), triangle));
                }
            })?;
        }
        Ok(rows)
    }

    /// Count of columns of 128 × 128 traces, numbered along crosslines first.
    pub fn column_count(&self) -> usize {
        self.columns().count()
    }

    /// A column, once the stage has run.
    ///
    /// # Errors
    /// An array cannot be read.
    pub fn column(&self, column: usize) -> Result<CandidateColumns, InterpError> {
        let Area { x, y } = self.columns().area(column);
        let distance: Vec<u8> = self.read("distance", column)?;
        let leaf = bytemuck::cast_vec(self.read_rows::<1>("leaf", column, distance.len())?);
        Ok(CandidateColumns { x, y, distance, leaf })
    }
}
