//! For every voxel the closest leaf and its distance (P-horiz 4.3): the distance to the closest point **on
//! the triangles**, not to voxels or vertices, up to a greatest distance.
//!
//! The result is exact: every triangle that could be closer than the closest one so far is tested, none is
//! approximated. The volume is computed some inlines at a time, in blocks of columns:
//!
//! 1. `index`: the triangles near these inlines, by cell of the lattice and interval of depth. A triangle
//!    lies within one cell, so if a column is `h` away from a cell, a run of samples is at least `√(h² +
//!    gap²)` away from all its triangles.
//! 2. `search`: down a column, start with an upper bound from the column's own extrema and from the previous
//!    column (distances differ by at most 1 between neighbours). Then test the triangles of the four cells
//!    around the column, then those of every cell and interval that the bound cannot exclude.
//! 3. `triangle`: the distances of several samples of a column to one triangle at once.
//!
//! Of leaves at the same distance the lesser id is the closest, so blocks, bounds and threads do not change
//! the result. Space: voxels, with all axes alike.
//!
//! # Encoding
//!
//! A distance is one byte, `round(254 · d / max_distance)`; 255 means beyond. With the default of 10 voxels
//! the error is less than 0.02 voxels.

mod index;
mod search;
#[cfg(test)]
mod tests;
mod triangle;

use crate::error::InterpError;
use crate::forest::Forest;
pub(crate) use index::{BRICK as ROW_CELLS, CellRow, cell_triangle};
use index::{CellIndex, TriangleLists};
use rayon::prelude::*;
use search::ColumnBlock;
use serde::{Deserialize, Serialize};
use std::ops::Range;
use survey::Progress;
pub use survey::candidates::BEYOND;
use system::wide::widest;
pub(crate) use triangle::CellTriangle;

/// The code of the greatest distance.
const FARTHEST: f32 = 254.0;

/// Largest value of the greatest distance, voxels: the search is made for short distances.
const LIMIT: f32 = 64.0;

/// Inlines computed at a time. More need more memory for their index, fewer make threads wait for one
/// another.
const LINES: usize = 64;

/// Crosslines of a block, which one thread computes. The first column of a line has no previous column.
const BLOCK: usize = 32;

/// Settings of the distances.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct DistanceSettings {
    /// Greatest distance, voxels, at most 64. Default 10, as in the paper. The error of a coded distance is
    /// at most 1/508 of it.
    pub max_distance: f32,
}

impl Default for DistanceSettings {
    fn default() -> Self {
        Self { max_distance: 10.0 }
    }
}

impl DistanceSettings {
    /// Checks the greatest distance.
    pub(crate) fn check(&self) -> Result<(), InterpError> {
        if self.max_distance > 0.0 && self.max_distance <= LIMIT {
            return Ok(());
        }
        Err(InterpError::Setting {
            setting: "max_distance",
            value: self.max_distance.into(),
            expected: "a number of voxels above 0 and up to 64",
        })
    }

    /// The byte that encodes a distance in voxels.
    ///
    /// ```
    /// use candidates::DistanceSettings;
    ///
    /// let settings = DistanceSettings { max_distance: 10.0 };
    /// assert_eq!(settings.encode(5.0), 127);
    /// assert_eq!(settings.decode(127), Some(5.0));
    /// assert_eq!(settings.decode(settings.encode(10.1)), None);
    /// ```
    pub fn encode(&self, distance: f32) -> u8 {
        if distance <= self.max_distance { (distance * (FARTHEST / self.max_distance)).round() as u8 } else { BEYOND }
    }

    /// The distance in voxels that a byte encodes; `None` for [`BEYOND`].
    pub fn decode(&self, code: u8) -> Option<f32> {
        (code != BEYOND).then(|| f32::from(code) * (self.max_distance / FARTHEST))
    }
}

/// Distances and leaf ids of a box of columns over all samples: `[inline][crossline][sample]`.
#[derive(Debug, Clone, PartialEq)]
pub struct CandidateColumns {
    /// Inline indices.
    pub x: Range<usize>,
    /// Crossline indices.
    pub y: Range<usize>,
    /// Coded distances (see [`DistanceSettings::decode`]).
    pub distance: Vec<u8>,
    /// Leaf ids, 0 where the distance is [`BEYOND`].
    pub leaf: Vec<u32>,
}

/// Computes the distances to the leaves of a forest, for any part of the volume.
///
/// Memory: 4 bytes a triangle, and while it computes some 20 bytes for each triangle near the current
/// inlines.
///
/// # Examples
///
/// ```
/// use candidates::{DistanceSettings, Extremum, Forest, ForestSettings, LeafDistances, Surface, Surfaces, Vertex};
/// use survey::Progress;
///
/// // One cell of four traces with two triangles at sample 2.
/// let corner = |x, y| Vertex { x, y, z: 2.0 };
/// let surfaces = Surfaces {
///     size: [2, 2, 8],
///     vertices: vec![corner(0, 0), corner(0, 1), corner(1, 0), corner(1, 1)],
///     triangles: vec![[0, 2, 1], [1, 2, 3]],
///     surfaces: vec![Surface { extremum: Extremum::Peak, vertices: 0..4, triangles: 0..2 }],
/// };
/// let forest = Forest::build(surfaces, &ForestSettings::default(), &Progress::silent())?;
/// let settings = DistanceSettings { max_distance: 4.0 };
/// let found = LeafDistances::new(&forest, &settings)?.columns(0..1, 0..1, &Progress::silent())?;
/// // On a trace, the distance is that in depth; sample 7 is farther than 4 voxels from the leaf.
/// assert_eq!(settings.decode(found.distance[4]), Some(2.0));
/// assert_eq!(found.leaf, [1, 1, 1, 1, 1, 1, 1, 0]);
/// # Ok::<(), candidates::InterpError>(())
/// ```
pub struct LeafDistances<'a> {
    forest: &'a Forest,
    settings: DistanceSettings,
    lists: TriangleLists,
}

impl<'a> LeafDistances<'a> {
    /// Prepares the search.
    ///
    /// # Errors
    /// [`InterpError::Setting`], and [`InterpError::MalformedSurfaces`] when a triangle spans more than one cell of the
    /// lattice.
    pub fn new(forest: &'a Forest, settings: &DistanceSettings) -> Result<Self, InterpError> {
        settings.check()?;
        Ok(Self { forest, settings: settings.clone(), lists: TriangleLists::new(forest)? })
    }

    /// Computes the columns of a box of inline indices `x` and crossline indices `y`, in parallel.
    ///
    /// # Errors
    /// [`InterpError::Cancelled`].
    ///
    /// # Panics
    /// When the box is not inside the volume.
    pub fn columns(
        &self,
        x: Range<usize>,
        y: Range<usize>,
        progress: &Progress,
    ) -> Result<CandidateColumns, InterpError> {
        self.columns_of(x, y, &mut CellIndex::new(self.forest.surfaces.size), progress)
    }

    /// [`LeafDistances::columns`] with an index that has not advanced beyond `x`.
    fn columns_of(
        &self,
        x: Range<usize>,
        y: Range<usize>,
        index: &mut CellIndex,
        progress: &Progress,
    ) -> Result<CandidateColumns, InterpError> {
        let size @ [nx, ny, nz] = self.forest.surfaces.size;
        assert!(x.end <= nx && y.end <= ny, "columns {x:?} {y:?} of {nx} x {ny}");
        let count = x.len() * y.len() * nz;
        let (mut distance, mut leaf) = (vec![BEYOND; count], vec![0u32; count]);
        if count == 0 {
            return Ok(CandidateColumns { x, y, distance, leaf });
        }
        let row = y.len() * nz;
        let reach = self.settings.max_distance.ceil() as usize + 1;
        for first in x.clone().step_by(LINES) {
            let lines = first..(first + LINES).min(x.end);
            progress.check()?;
            index.advance(self.forest, &self.lists, first.saturating_sub(reach)..lines.end + reach);
            let index = &*index;
            let at = (first - x.start) * row..(lines.end - x.start) * row;
            let mut parts: Vec<BlockRows<'_>> = (y.clone().step_by(BLOCK)).map(|_| Vec::new()).collect();
            let rows = distance[at.clone()].chunks_mut(row).zip(leaf[at].chunks_mut(row));
            for (distances, leaves) in rows {
                let blocks = distances.chunks_mut(BLOCK * nz).zip(leaves.chunks_mut(BLOCK * nz));
                parts.iter_mut().zip(blocks).for_each(|(part, row)| part.push(row));
            }
            parts.into_par_iter().enumerate().with_max_len(1).try_for_each(|(n, rows)| {
                let from = y.start + n * BLOCK;
                let columns = from..(from + BLOCK).min(y.end);
                progress.check()?;
                let done = (lines.len() * columns.len()) as u64;
                widest(ColumnBlock { size, settings: &self.settings, index, x: lines.clone(), y: columns, rows });
                Ok::<(), InterpError>(progress.step(done)?)
            })?;
        }
        Ok(CandidateColumns { x, y, distance, leaf })
    }

    /// Computes the whole volume, `lines` inlines at a time, and passes each part to `take`. `lines` changes
    /// only the memory.
    ///
    /// # Errors
    /// [`InterpError::Cancelled`], and errors of `take`.
    pub fn slabs<E: From<InterpError>>(
        &self,
        lines: usize,
        progress: &Progress,
        mut take: impl FnMut(CandidateColumns) -> Result<(), E>,
    ) -> Result<(), E> {
        let [nx, ny, _] = self.forest.surfaces.size;
        progress.begin("measuring distances to surfaces", (nx * ny) as u64);
        let mut index = CellIndex::new(self.forest.surfaces.size);
        for first in (0..nx).step_by(lines.max(1)) {
            take(self.columns_of(first..(first + lines.max(1)).min(nx), 0..ny, &mut index, progress)?)?;
        }
        Ok(())
    }
}

/// Rows of a block: distances and leaf ids of each.
type BlockRows<'a> = Vec<(&'a mut [u8], &'a mut [u32])>;

/// Distances and leaf ids of columns among triangles that are given with their cells, in rows of [`ROW_CELLS`], in a volume
/// of `size`. Columns and cells count from the same trace.
///
/// # Errors
/// [`InterpError::Cancelled`].
pub(crate) fn columns_among(
    size: [usize; 3],
    settings: &DistanceSettings,
    cells: Vec<CellRow>,
    x: Range<usize>,
    y: Range<usize>,
    progress: &Progress,
) -> Result<CandidateColumns, InterpError> {
    let nz = size[2];
    let count = x.len() * y.len() * nz;
    let (mut distance, mut leaf) = (vec![BEYOND; count], vec![0u32; count]);
    let row = y.len() * nz;
    if count > 0 {
        let index = &CellIndex::of_cells(size, cells);
        progress.check()?;
        let mut parts: Vec<BlockRows<'_>> = y.clone().step_by(BLOCK).map(|_| Vec::new()).collect();
        for (distances, leaves) in distance.chunks_mut(row).zip(leaf.chunks_mut(row)) {
            let blocks = distances.chunks_mut(BLOCK * nz).zip(leaves.chunks_mut(BLOCK * nz));
            parts.iter_mut().zip(blocks).for_each(|(part, row)| part.push(row));
        }
        parts.into_par_iter().enumerate().with_max_len(1).try_for_each(|(n, rows)| {
            let from = y.start + n * BLOCK;
            progress.check()?;
            let columns = from..(from + BLOCK).min(y.end);
            widest(ColumnBlock { size, settings, index, x: x.clone(), y: columns, rows });
            Ok::<(), InterpError>(())
        })?;
    }
    Ok(CandidateColumns { x, y, distance, leaf })
}
