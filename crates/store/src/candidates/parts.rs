//! Candidates that several processes write together, each the files that are assigned to it: the bytes are those of
//! [`CandidateWriter`](super::CandidateWriter), whoever writes what, in whatever order and however often.
//!
//! ```text
//! create         the empty arrays of all levels and tables, once surfaces and trees are counted
//! write_column   the files of a column of traces        any process, any order
//! halve          a file of a further level              after all files of the level before
//! write_rows     a file of a table                      any process, any order
//! finish         the facts, without which nothing can be opened
//! ```
//!
//! A file has its place only when it is complete. What a lost process left lies in `.apart`, which `finish` removes.
//! Memory: a column, or a file and its bytes. Every call works on one thread.

use super::super::array::{APART, ArrayWriter, new_apart, write_group};
use super::super::error::StoreError;
use super::super::header::write_header;
use super::super::layout::{ArrayLayout, grid_index};
use super::bricks::{CandidateTable, LevelFiles, create_level, size_of_level, write_column};
use super::{KIND, LeafWriter, level_name, levels};
use serde::Serialize;
use std::fs;
use std::ops::Range;
use std::path::{Path, PathBuf};
use survey::candidates::{BEYOND, CandidateInfo, ForestCounts, ForestRows};
use survey::progress::Progress;
use system::file::FileAction;

/// Candidates that are being written file by file. All processes state the same.
#[derive(Debug, Clone)]
pub struct CandidateParts {
    /// The folder that becomes the group.
    pub path: PathBuf,
    /// Voxels along each axis.
    pub size: [usize; 3],
    /// The largest leaf id that will occur.
    pub leaves: usize,
    /// Rows of the tables.
    pub counts: ForestCounts,
}

impl CandidateParts {
    /// Writes the metadata of all arrays; what is there is written again.
    ///
    /// # Errors
    /// The disk does not take it.
    pub fn create(&self) -> Result<(), StoreError> {
        let group = &self.path;
        fs::create_dir_all(group).map_err(|source| StoreError::io(FileAction::Written, group, source))?;
        write_group(group, "", serde_json::Map::new())?;
        let layout = ArrayLayout::volume(self.size);
        ArrayWriter::create(group, "distance", layout.clone(), BEYOND)?;
        LeafWriter::create(group, "leaf", layout, self.leaves)?;
        write_group(group, "pyramid", serde_json::Map::new())?;
        (1..self.level_count()).try_for_each(|level| create_level(group, level, self.size, self.leaves))?;
        write_group(group, "forest", serde_json::Map::new())?;
        CandidateTable::ALL.into_iter().try_for_each(|table| table.create(group, self.counts))
    }

    /// Levels of the pyramid, the full one included.
    pub fn level_count(&self) -> usize {
        levels(self.size)
    }

    /// Count of files of a level.
    pub fn file_count(&self, level: usize) -> usize {
        ArrayLayout::volume(size_of_level(self.size, level)).file_counts().iter().product()
    }

    /// Writes the files of a column; see [`CandidateWriter::write_column`](super::CandidateWriter::write_column).
    ///
    /// # Errors
    /// [`StoreError`], [`StoreError::SizeMismatch`] if the samples are not a column.
    pub fn write_column(&self, lines: [Range<usize>; 2], distance: &[u8], leaf: &[u32]) -> Result<(), StoreError> {
        let (layout, apart) = (ArrayLayout::volume(self.size), new_apart(&self.path));
        let to_distance = ArrayWriter::of_created(&self.path, "distance", layout.clone(), BEYOND, Some(&apart))?;
        let to_leaf = LeafWriter::open(&self.path, "leaf", layout, self.leaves, Some(&apart))?;
        write_column(&to_distance, &to_leaf, lines, (distance, leaf), &Progress::silent())?;
        remove(&apart);
        Ok(())
    }

    /// Makes a file of a further level from those of the level before.
    ///
    /// # Errors
    /// A file of the level before is missing or damaged, or the disk does not take it.
    pub fn halve(&self, level: usize, file: usize) -> Result<(), StoreError> {
        let apart = new_apart(&self.path);
        LevelFiles::open(&self.path, level, self.size, self.leaves, Some(&apart))?.write(file)?;
        remove(&apart);
        Ok(())
    }

    /// Count of files of all tables.
    pub fn table_files(&self) -> usize {
        CandidateTable::ALL.into_iter().map(|table| table.file_count(self.counts)).sum()
    }

    /// Writes a file of the tables.
    ///
    /// # Errors
    /// The rows cannot be read, or the disk does not take them.
    pub fn write_rows(&self, mut file: usize, forest: &dyn ForestRows) -> Result<(), StoreError> {
        let apart = new_apart(&self.path);
        for table in CandidateTable::ALL {
            let count = table.file_count(self.counts);
            if file < count {
                table.write(&self.path, file, forest, Some(&apart))?;
                break;
            }
            file -= count;
        }
        remove(&apart);
        Ok(())
    }

    /// Completes the candidates.
    ///
    /// # Errors
    /// A file of a level was not written, or the disk does not take it.
    pub fn finish<R: Serialize>(&self, info: &CandidateInfo<R>) -> Result<(), StoreError> {
        for level in 0..self.level_count() {
            let counts = ArrayLayout::volume(size_of_level(self.size, level)).file_counts();
            for n in 0..self.file_count(level) {
                let key = grid_index(n, &counts).iter().map(usize::to_string).collect::<Vec<_>>().join("/");
                let is_there = |array| self.path.join(level_name(level, array)).join("c").join(&key).is_file();
                if !is_there("distance") || !is_there("leaf") {
                    return Err(StoreError::Unfinished { path: self.path.clone() });
                }
            }
        }
        remove(&self.path.join(APART));
        write_header(&self.path, KIND, info)
    }
}

/// Removes a folder; what cannot be removed now is removed at the end.
fn remove(folder: &Path) {
    let _ = fs::remove_dir_all(folder);
}

#[cfg(test)]
mod tests {
    use super::super::tests::{info, tables, volume};
    use super::*;
    use crate::{CandidateWriter, StoredCandidates};
    use std::collections::BTreeMap;
    use survey::candidates::ForestTables;
    use survey::source::SourceError;

    /// Tables whose rows are read some at a time.
    struct Rows(ForestTables);

    impl ForestRows for Rows {
        fn counts(&self) -> ForestCounts {
            let ForestTables { z, triangles, surfaces, nodes, .. } = &self.0;
            let [vertices, triangles] = [z.len(), triangles.len()];
            ForestCounts { vertices, triangles, surfaces: surfaces.len(), nodes: nodes.len() }
        }

        fn trace(&self, rows: Range<usize>) -> Result<Vec<[u16; 2]>, SourceError> {
            Ok(self.0.trace[rows].to_vec())
        }

        fn z(&self, rows: Range<usize>) -> Result<Vec<f32>, SourceError> {
            Ok(self.0.z[rows].to_vec())
        }

        fn triangles(&self, rows: Range<usize>) -> Result<Vec<[u32; 3]>, SourceError> {
            Ok(self.0.triangles[rows].to_vec())
        }

        fn surfaces(&self, rows: Range<usize>) -> Result<Vec<[u32; 5]>, SourceError> {
            Ok(self.0.surfaces[rows].to_vec())
        }

        fn nodes(&self, rows: Range<usize>) -> Result<Vec<[u32; 6]>, SourceError> {
            Ok(self.0.nodes[rows].to_vec())
        }
    }

    fn contents(folder: &Path, below: &Path, found: &mut BTreeMap<PathBuf, Vec<u8>>) {
        for entry in fs::read_dir(below).unwrap() {
            let path = entry.unwrap().path();
            if path.is_dir() {
                contents(folder, &path, found);
            } else {
                found.insert(path.strip_prefix(folder).unwrap().to_owned(), fs::read(&path).unwrap());
            }
        }
    }

    #[test]
    fn files_written_by_many_in_any_order_are_those_of_one() {
        let rows = Rows(tables());
        for (size, leaves) in [([150, 140, 70], 900), ([130, 20, 129], 70_000)] {
            let folder = tempfile::tempdir().unwrap();
            let (whole, parted) = (folder.path().join("whole.zarr"), folder.path().join("parted.zarr"));
            let (distance, leaf) = volume(size, leaves);
            let column = |x: &Range<usize>, y: &Range<usize>| {
                let traces = || x.clone().flat_map(|x| y.clone().map(move |y| (x * size[1] + y) * size[2]));
                let distances: Vec<u8> = traces().flat_map(|at| distance[at..at + size[2]].to_vec()).collect();
                (distances, traces().flat_map(|at| leaf[at..at + size[2]].to_vec()).collect::<Vec<u32>>())
            };
            let lines = |axis: usize| (0..size[axis]).step_by(128).map(move |at| at..(at + 128).min(size[axis]));
            let silent = Progress::silent();
            let writer = CandidateWriter::create(&whole, size, leaves).unwrap();
            for (x, y) in lines(0).flat_map(|x| lines(1).map(move |y| (x.clone(), y))) {
                let (distance, leaf) = column(&x, &y);
                writer.write_column([x, y], &distance, &leaf, &silent).unwrap();
            }
            writer.finish_columns(&info(size, leaves), &rows, &silent).unwrap();

            let parts = CandidateParts { path: parted.clone(), size, leaves, counts: rows.counts() };
            parts.create().unwrap();
            assert!(StoredCandidates::open(&parted).is_err(), "not complete");
            assert!(matches!(parts.finish(&info(size, leaves)), Err(StoreError::Unfinished { .. })));
            let mut columns: Vec<_> = lines(0).flat_map(|x| lines(1).map(move |y| (x.clone(), y))).collect();
            columns.reverse();
            columns.push(columns[0].clone());
            for (x, y) in columns {
                let (distance, leaf) = column(&x, &y);
                assert!(parts.write_column([x.clone(), y.clone()], &distance[1..], &leaf).is_err());
                parts.write_column([x, y], &distance, &leaf).unwrap();
            }
            // The empty arrays are written again by a task that is repeated.
            parts.create().unwrap();
            for level in 1..parts.level_count() {
                (0..parts.file_count(level)).rev().chain([0]).for_each(|file| parts.halve(level, file).unwrap());
            }
            (0..parts.table_files()).rev().for_each(|file| parts.write_rows(file, &rows).unwrap());
            // What a lost process has left.
            fs::create_dir_all(new_apart(&parts.path)).unwrap();
            parts.finish(&info(size, leaves)).unwrap();
            let (mut one, mut other) = (BTreeMap::new(), BTreeMap::new());
            contents(&whole, &whole, &mut one);
            contents(&parted, &parted, &mut other);
            assert_eq!(one.keys().collect::<Vec<_>>(), other.keys().collect::<Vec<_>>());
            assert!(one == other, "the same bytes");
        }
    }
}
