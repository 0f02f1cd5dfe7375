//! For every voxel the closest leaf, and how far it is (P-horiz 4.3): distances to the closest point **on the triangles**, not to
//! voxels or vertices, up to a greatest distance.
//!
//! Exact by construction: every triangle that could be closer than what is known already is tested, none is approximated. The
//! volume is worked some lines at a time, in blocks of columns:
//!
//! 1. `index`: the triangles around the lines, by cell of the lattice and interval of depth. A triangle lies within one cell, so a column is
//!    `h` away from all triangles of a cell, and a run of samples at least `√(h² + gap²)`.
//! 2. `search`: down a column, an upper bound from its own extrema and from the column before (distances differ by at most 1 between neighbours),
//!    then the triangles of the four cells around it, then those of every cell and interval that the bound cannot exclude.
//! 3. `triangle`: the distance of several samples of a column to one triangle at once.
//!
//! The lesser leaf id wins a tie, so blocks, bounds and threads leave no trace in the result. Space: voxels, all axes alike.
//!
//! # Encoding
//!
//! A distance is one byte, `round(254 · d / max_distance)`; 255 is beyond. With the default of 10 voxels it is off by less than 0.02.

mod index;
mod search;
#[cfg(test)]
mod tests;
mod triangle;

use crate::error::Error;
use crate::forest::Forest;
use crate::lanes::widest;
use index::{CellIndex, TriangleLists};
use rayon::prelude::*;
use search::Block;
use serde::{Deserialize, Serialize};
use std::ops::Range;
use survey::Progress;
pub use survey::candidates::BEYOND;

/// The code of the greatest distance.
const FARTHEST: f32 = 254.0;

/// Greatest distance that may be asked for, voxels: the search is made for short ones.
const LIMIT: f32 = 64.0;

/// Inlines that are worked on at a time: more need more memory for their index, fewer keep threads waiting for one another.
const LINES: usize = 64;

/// Crosslines of a block, which one thread works on. The first column of a line knows nothing of its neighbour.
const BLOCK: usize = 32;

/// How distances are computed.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct DistanceSettings {
    /// Greatest distance that is told, voxels, at most 64. Default 10, as in the paper; the error of a coded distance is a 508th of it.
    pub max_distance: f32,
}

impl Default for DistanceSettings {
    fn default() -> Self {
        Self { max_distance: 10.0 }
    }
}

impl DistanceSettings {
    /// The byte for a distance in voxels.
    pub fn encode(&self, distance: f32) -> u8 {
        if distance <= self.max_distance { (distance * (FARTHEST / self.max_distance)).round() as u8 } else { BEYOND }
    }

    /// The distance in voxels of a byte; `None` for [`BEYOND`].
    pub fn decode(&self, code: u8) -> Option<f32> {
        (code != BEYOND).then(|| f32::from(code) * (self.max_distance / FARTHEST))
    }
}

/// Distances and leaf ids of a box of columns, `[inline][crossline][sample]`, with all samples of each.
#[derive(Debug, Clone, PartialEq)]
pub struct CandidateColumns {
    /// Inline indices.
    pub x: Range<usize>,
    /// Crossline indices.
    pub y: Range<usize>,
    /// Coded distances.
    pub distance: Vec<u8>,
    /// Leaf ids, 0 where the distance is [`BEYOND`].
    pub leaf: Vec<u32>,
}

/// Distances of a forest, ready to be computed for any part of the volume.
///
/// Memory: 4 bytes a triangle, and while it computes some 20 bytes for each triangle near the lines that it works on.
pub struct LeafDistances<'a> {
    forest: &'a Forest,
    settings: DistanceSettings,
    lists: TriangleLists,
}

impl<'a> LeafDistances<'a> {
    /// Prepares the search.
    ///
    /// # Errors
    /// [`Error::Setting`], and [`Error::MalformedSurfaces`] when a triangle spans more than one cell of the lattice.
    pub fn new(forest: &'a Forest, settings: &DistanceSettings) -> Result<Self, Error> {
        if !(settings.max_distance > 0.0 && settings.max_distance <= LIMIT) {
            return Err(Error::Setting {
                setting: "max_distance",
                value: settings.max_distance.into(),
                expected: "a number of voxels above 0 and up to 64",
            });
        }
        Ok(Self { forest, settings: settings.clone(), lists: TriangleLists::new(forest)? })
    }

    /// Computes the columns of a box, block by block on all threads.
    ///
    /// # Errors
    /// [`Error::Cancelled`].
    ///
    /// # Panics
    /// When the box is not inside the volume.
    pub fn columns(&self, x: Range<usize>, y: Range<usize>, progress: &Progress) -> Result<CandidateColumns, Error> {
        self.columns_of(x, y, &mut CellIndex::new(self.forest.surfaces.size), progress)
    }

    /// [`LeafDistances::columns`] with an index that has not been further on.
    fn columns_of(
        &self,
        x: Range<usize>,
        y: Range<usize>,
        index: &mut CellIndex,
        progress: &Progress,
    ) -> Result<CandidateColumns, Error> {
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
                widest(Block { size, settings: &self.settings, index, x: lines.clone(), y: columns, rows });
                Ok::<(), Error>(progress.step(done)?)
            })?;
        }
        Ok(CandidateColumns { x, y, distance, leaf })
    }

    /// Computes the whole volume, `lines` inlines at a time, and hands over each part as it is done; `lines` changes nothing but the memory.
    ///
    /// # Errors
    /// [`Error::Cancelled`], and whatever `take` answers.
    pub fn slabs<E: From<Error>>(
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

/// Lines of a block: distances and leaf ids of each.
type BlockRows<'a> = Vec<(&'a mut [u8], &'a mut [u32])>;
