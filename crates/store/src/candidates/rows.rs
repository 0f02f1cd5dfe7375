//! Tables of surfaces and trees, some rows at a time, for whoever does not need, or cannot hold, all of them.

use super::StoredCandidates;
use crate::array::StoredArray;
use crate::error::StoreError;
use crate::sample::StoredSample;
use std::collections::BTreeSet;
use std::ops::Range;
use survey::Progress;
use survey::candidates::{ForestCounts, ForestTables};

/// Rows of a table that are read at a time.
const TOGETHER: usize = 1 << 20;

/// Ranges of surfaces, of which rows of `forest/surfaces` are given, that have about a million triangles together; a larger
/// one stands alone.
pub fn surface_batches(surfaces: &[[u32; 5]]) -> Vec<Range<usize>> {
    let mut batches: Vec<Range<usize>> = Vec::new();
    let mut waiting = 0;
    for (n, [_, _, _, first, end]) in surfaces.iter().enumerate() {
        let own = end.saturating_sub(*first) as usize;
        match batches.last_mut() {
            Some(last) if waiting + own <= TOGETHER => {
                last.end = n + 1;
                waiting += own;
            }
            _ => {
                batches.push(n..n + 1);
                waiting = own;
            }
        }
    }
    batches
}

impl StoredCandidates {
    /// Counts of rows.
    ///
    /// # Errors
    /// [`StoreError`].
    pub fn forest_counts(&self) -> Result<ForestCounts, StoreError> {
        let rows = |name: &str| Ok::<usize, StoreError>(self.table_array(name)?.shape().first().copied().unwrap_or(0));
        Ok(ForestCounts {
            vertices: rows("trace")?,
            triangles: rows("triangles")?,
            surfaces: rows("surfaces")?,
            nodes: rows("nodes")?,
        })
    }

    /// Inline and crossline index of some vertices.
    ///
    /// # Errors
    /// [`StoreError`].
    pub fn read_traces(&self, rows: Range<usize>) -> Result<Vec<[u16; 2]>, StoreError> {
        self.rows("trace", rows)
    }

    /// Fractional sample index of some vertices.
    ///
    /// # Errors
    /// [`StoreError`].
    pub fn read_depths(&self, rows: Range<usize>) -> Result<Vec<f32>, StoreError> {
        Ok(self.rows::<f32, 1>("z", rows)?.into_iter().map(|[z]| z).collect())
    }

    /// Vertices of some triangles.
    ///
    /// # Errors
    /// [`StoreError`].
    pub fn read_triangles(&self, rows: Range<usize>) -> Result<Vec<[u32; 3]>, StoreError> {
        self.rows("triangles", rows)
    }

    /// All surfaces: rows of `forest/surfaces`.
    ///
    /// # Errors
    /// [`StoreError`].
    pub fn read_surfaces(&self, progress: &Progress) -> Result<Vec<[u32; 5]>, StoreError> {
        self.table("surfaces", progress)
    }

    /// All surfaces and trees, but vertices and triangles of some surfaces alone; the others have none. Surfaces, nodes and
    /// leaves keep their numbers, vertices and triangles do not.
    ///
    /// # Errors
    /// [`StoreError`].
    pub fn read_forest_of(&self, wanted: &BTreeSet<u32>, progress: &Progress) -> Result<ForestTables, StoreError> {
        let mut tables = ForestTables {
            surfaces: self.read_surfaces(progress)?,
            nodes: self.read_nodes(progress)?,
            ..ForestTables::default()
        };
        let damaged = || StoreError::damaged(self.path(), "forest/surfaces", "a surface ends before it begins");
        // By surface: the first triangle in the file, and here; and whether it is wanted.
        let mut moved = Vec::with_capacity(tables.surfaces.len());
        progress.begin("reading surfaces", wanted.len() as u64);
        for (row, index) in tables.surfaces.iter_mut().zip(0u32..) {
            let [_, first_vertex, end_vertex, first, end] = *row;
            let here = [tables.z.len() as u32, tables.triangles.len() as u32];
            moved.push((first, here[1], wanted.contains(&index)));
            if wanted.contains(&index) {
                progress.step(1)?;
                if end_vertex < first_vertex || end < first {
                    return Err(damaged());
                }
                let vertices = first_vertex as usize..end_vertex as usize;
                tables.trace.extend(self.read_traces(vertices.clone())?);
                tables.z.extend(self.read_depths(vertices)?);
                let triangles = self.read_triangles(first as usize..end as usize)?.into_iter();
                // A corner of another surface stays one that is not there.
                let corner = |v: u32| v.checked_sub(first_vertex).map_or(u32::MAX, |v| v.saturating_add(here[0]));
                tables.triangles.extend(triangles.map(|corners| corners.map(corner)));
            }
            row[1..].copy_from_slice(&[here[0], tables.z.len() as u32, here[1], tables.triangles.len() as u32]);
        }
        for row in &mut tables.nodes {
            let Some(&(first, here, is_wanted)) = moved.get(row[3] as usize) else { continue };
            for end in &mut row[4..] {
                *end = if is_wanted { end.saturating_sub(first).saturating_add(here) } else { here };
            }
        }
        Ok(tables)
    }

    /// A whole table.
    pub(super) fn table<T: StoredSample, const N: usize>(
        &self,
        name: &str,
        progress: &Progress,
    ) -> Result<Vec<[T; N]>, StoreError> {
        let array = self.table_array(name)?;
        let count = array.shape().first().copied().unwrap_or(0);
        array.check_memory(array.shape(), size_of::<T>())?;
        let mut rows = Vec::with_capacity(count);
        progress.begin(&format!("reading {name}"), count.div_ceil(TOGETHER) as u64);
        for first in (0..count).step_by(TOGETHER) {
            rows.extend(self.rows_of::<T, N>(&array, first..(first + TOGETHER).min(count))?);
            progress.step(1)?;
        }
        Ok(rows)
    }

    fn rows<T: StoredSample, const N: usize>(&self, name: &str, rows: Range<usize>) -> Result<Vec<[T; N]>, StoreError> {
        self.rows_of(&self.table_array(name)?, rows)
    }

    fn rows_of<T: StoredSample, const N: usize>(
        &self,
        array: &StoredArray,
        rows: Range<usize>,
    ) -> Result<Vec<[T; N]>, StoreError> {
        if rows.is_empty() {
            return Ok(Vec::new());
        }
        let columns = array.shape().get(1).copied();
        if columns.unwrap_or(1) != N {
            let reason = format!("it has {:?}, not {N} columns", array.shape());
            let array = array.name().to_owned();
            return Err(StoreError::damaged(self.path(), &array, reason));
        }
        let values = match columns {
            None => array.read_box::<T>(&[rows.start], &[rows.len()])?,
            Some(_) => array.read_box::<T>(&[rows.start, 0], &[rows.len(), N])?,
        };
        Ok(values.as_chunks::<N>().0.to_vec())
    }

    fn table_array(&self, name: &str) -> Result<StoredArray, StoreError> {
        StoredArray::open(self.path(), &format!("forest/{name}"))
    }
}

#[cfg(test)]
mod tests {
    use super::super::tests::{info, volume};
    use super::super::{CandidateWriter, StoredCandidates};
    use super::*;
    use survey::candidates::CandidateSink;

    /// Three surfaces of two, one and three triangles, the last of which has two leaves.
    fn tables() -> ForestTables {
        const NONE: u32 = u32::MAX;
        ForestTables {
            trace: (0..12).map(|n| [n, 2 * n]).collect(),
            z: (0..12u8).map(|n| f32::from(n) / 2.0).collect(),
            triangles: vec![[0, 1, 2], [1, 2, 3], [4, 5, 6], [7, 8, 9], [8, 9, 10], [9, 10, 11]],
            surfaces: vec![[0, 0, 4, 0, 2], [1, 4, 7, 2, 3], [2, 7, 12, 3, 6]],
            nodes: vec![
                [NONE, NONE, NONE, 0, 0, 2],
                [NONE, NONE, NONE, 1, 2, 3],
                [NONE, 3, 4, 2, 3, 6],
                [2, NONE, NONE, 2, 3, 4],
                [2, NONE, NONE, 2, 4, 6],
            ],
        }
    }

    #[test]
    fn surfaces_are_read_together_up_to_a_million_triangles() {
        let of = |triangles: [usize; 5]| {
            let mut reached = 0;
            let row = |own: usize| {
                reached += own as u32;
                [0, 0, 0, reached - own as u32, reached]
            };
            surface_batches(&triangles.map(row))
        };
        assert_eq!(of([9, 9, 9, 9, 9]), vec![0..5; 1]);
        assert_eq!(of([TOGETHER / 2, TOGETHER / 2, 1, 3 * TOGETHER, 1]), [0..2, 2..3, 3..4, 4..5]);
        assert!(surface_batches(&[]).is_empty());
    }

    #[test]
    fn wanted_surfaces_come_with_their_vertices_and_the_others_are_empty() {
        let folder = tempfile::tempdir().unwrap();
        let (path, silent, size) = (folder.path().join("candidates.zarr"), Progress::silent(), [2, 2, 3]);
        let (distance, leaf) = volume(size, 4);
        let mut writer = CandidateWriter::create(&path, size, 4).unwrap();
        writer.write_slab(0, &distance, &leaf, &silent).unwrap();
        writer.finish(&info(size, 4), &tables(), &silent).unwrap();
        let stored = StoredCandidates::open(&path).unwrap();
        let all = BTreeSet::from([0, 1, 2]);
        assert_eq!(stored.read_forest_of(&all, &silent).unwrap(), tables());
        assert_eq!(stored.read_forest(&silent).unwrap(), tables());
        let part = stored.read_forest_of(&BTreeSet::from([0, 2]), &silent).unwrap();
        assert_eq!(part.surfaces, [[0, 0, 4, 0, 2], [1, 4, 4, 2, 2], [2, 4, 9, 2, 5]]);
        assert_eq!(part.triangles, [[0, 1, 2], [1, 2, 3], [4, 5, 6], [5, 6, 7], [6, 7, 8]]);
        assert_eq!((&part.trace[4], part.z[4]), (&[7, 14], 3.5));
        let ranges: Vec<[u32; 2]> = part.nodes.iter().map(|row| [row[4], row[5]]).collect();
        assert_eq!(ranges, [[0, 2], [2, 2], [2, 5], [2, 3], [3, 5]]);
        let counts = ForestCounts { vertices: 12, triangles: 6, surfaces: 3, nodes: 5 };
        assert_eq!(stored.forest_counts().unwrap(), counts);
        assert_eq!(stored.read_triangles(2..4).unwrap(), [[4, 5, 6], [7, 8, 9]]);
        assert!(stored.read_triangles(5..9).is_err());
    }
}
