//! Candidates that arrive column by column, with tables of any length, in bounded memory.
//!
//! The files are those that slabs make. Each level of the pyramid is made from the files of the level before, a box of
//! 128³ voxels at a time on each thread.

use super::super::array::{ArrayWriter, StoredArray, write_group};
use super::super::error::StoreError;
use super::super::header::write_header;
use super::super::layout::{ArrayLayout, BRICK, gather, grid_index};
use super::super::pyramid::halved;
use super::super::sample::StoredSample;
use super::{CandidateWriter, KIND, LeafWriter, ROWS, halve, level_name, levels, widened};
use rayon::prelude::*;
use serde::Serialize;
use std::ops::Range;
use std::path::Path;
use survey::candidates::{BEYOND, CandidateInfo, ForestRows};
use survey::progress::Progress;
use survey::source::SourceError;

impl CandidateWriter {
    /// Inlines and crosslines of a column: those of its files.
    pub fn column_shape(&self) -> [usize; 2] {
        let shape = self.distance.layout().file_shape();
        [shape[0], shape[1]]
    }

    /// Writes the files of a column, whose first inline and crossline are multiples of [`CandidateWriter::column_shape`]:
    /// `[inline][crossline][sample]`, as far as the volume goes.
    ///
    /// # Errors
    /// [`StoreError`], [`StoreError::SizeMismatch`] if the samples are not a column.
    pub fn write_column(
        &self,
        [x, y]: [Range<usize>; 2],
        distance: &[u8],
        leaf: &[u32],
        progress: &Progress,
    ) -> Result<(), StoreError> {
        let (edge, nz) = (self.distance.layout().file_shape(), self.size[2]);
        let size = [x.len(), y.len(), nz];
        let expected = size.iter().product();
        let found = distance.len().min(leaf.len());
        let fits = x.start.is_multiple_of(edge[0]) && y.start.is_multiple_of(edge[1]) && x.len() <= edge[0];
        if found != expected || !fits || y.len() > edge[1] {
            return Err(StoreError::SizeMismatch { what: "a column of candidates", expected, found });
        }
        for z in 0..nz.div_ceil(edge[2]) {
            progress.check()?;
            let (index, start) = ([x.start / edge[0], y.start / edge[1], z], [0, 0, z * edge[2]]);
            self.distance.write_shard(&index, gather(distance, &size, &start, edge))?;
            self.leaf.write_shard(&index, gather(leaf, &size, &start, edge))?;
        }
        Ok(())
    }

    /// Completes candidates whose columns are all written: the pyramid, the tables and the facts. Everything is then
    /// renamed to the target.
    ///
    /// # Errors
    /// [`StoreError`]; the target is then what it was before.
    pub fn finish_columns<R: Serialize>(
        self,
        info: &CandidateInfo<R>,
        forest: &dyn ForestRows,
        progress: &Progress,
    ) -> Result<(), StoreError> {
        let Self { replacement, size, .. } = self;
        let group = replacement.path();
        write_group(group, "pyramid", serde_json::Map::new())?;
        let mut fine = size;
        for level in 1..levels(size) {
            write_group(group, &format!("pyramid/{level}"), serde_json::Map::new())?;
            write_level(group, level, fine, info.leaves, progress)?;
            fine = halved(fine);
        }
        write_group(group, "forest", serde_json::Map::new())?;
        let counts = forest.counts();
        let table = Table { group, path: replacement.path(), progress };
        table.write("trace", counts.vertices, 2, |rows| Ok(forest.trace(rows)?.into_flattened()))?;
        table.write("z", counts.vertices, 1, |rows| forest.z(rows))?;
        table.write("triangles", counts.triangles, 3, |rows| Ok(forest.triangles(rows)?.into_flattened()))?;
        table.write("surfaces", counts.surfaces, 5, |rows| Ok(forest.surfaces(rows)?.into_flattened()))?;
        table.write("nodes", counts.nodes, 6, |rows| Ok(forest.nodes(rows)?.into_flattened()))?;
        write_header(group, KIND, info)?;
        replacement.commit()
    }
}

/// Writes a level from the files of the level before.
fn write_level(
    group: &Path,
    level: usize,
    fine: [usize; 3],
    leaves: usize,
    progress: &Progress,
) -> Result<(), StoreError> {
    let open = |array: &str| StoredArray::open(group, &level_name(level - 1, array));
    let (fine_distance, fine_leaf) = (open("distance")?, open("leaf")?);
    let size = halved(fine);
    let layout = ArrayLayout::volume(size);
    let distance = ArrayWriter::create(group, &level_name(level, "distance"), layout.clone(), BEYOND)?;
    let leaf = LeafWriter::create(group, &level_name(level, "leaf"), layout.clone(), leaves)?;
    let (counts, edge) = (layout.file_counts(), layout.file_shape().to_vec());
    let count: usize = counts.iter().product();
    progress.begin(&format!("storing level {level}"), count as u64);
    (0..count).into_par_iter().with_max_len(1).try_for_each(|n| {
        let index = grid_index(n, &counts);
        let start = [0, 1, 2].map(|axis| index[axis] * edge[axis]);
        let inside = [0, 1, 2].map(|axis| edge[axis].min(size[axis] - start[axis]));
        let total = inside.iter().product();
        let (mut distances, mut leaf_ids) = (vec![BEYOND; total], vec![0u32; total]);
        for part in 0..inside.iter().map(|n| n.div_ceil(BRICK)).product() {
            let place = grid_index(part, &inside.map(|n| n.div_ceil(BRICK)));
            let from = [0, 1, 2].map(|axis| place[axis] * BRICK);
            let own = [0, 1, 2].map(|axis| BRICK.min(inside[axis] - from[axis]));
            let first = [0, 1, 2].map(|axis| 2 * (start[axis] + from[axis]));
            let around = [0, 1, 2].map(|axis| (2 * own[axis]).min(fine[axis] - first[axis]));
            let of_distance = fine_distance.read_box::<u8>(&first, &around)?;
            let of_leaf = if fine_leaf.holds::<u16>() {
                widened(&fine_leaf.read_box::<u16>(&first, &around)?)
            } else {
                fine_leaf.read_box::<u32>(&first, &around)?
            };
            let room = own.iter().product();
            let (mut half_distance, mut half_leaf) = (vec![BEYOND; room], vec![0u32; room]);
            halve(around, &of_distance, &of_leaf, &mut half_distance, &mut half_leaf);
            for (row, (x, y)) in (0..own[0]).flat_map(|x| (0..own[1]).map(move |y| (x, y))).enumerate() {
                let to = ((from[0] + x) * inside[1] + from[1] + y) * inside[2] + from[2];
                let row = row * own[2]..(row + 1) * own[2];
                distances[to..to + own[2]].copy_from_slice(&half_distance[row.clone()]);
                leaf_ids[to..to + own[2]].copy_from_slice(&half_leaf[row]);
            }
        }
        distance.write_shard(&index, gather(&distances, &inside, &[0; 3], &edge))?;
        leaf.write_shard(&index, gather(&leaf_ids, &inside, &[0; 3], &edge))?;
        Ok(progress.step(1)?)
    })
}

/// Writes tables some rows at a time.
struct Table<'a> {
    group: &'a Path,
    path: &'a Path,
    progress: &'a Progress,
}

impl Table<'_> {
    fn write<T: StoredSample>(
        &self,
        name: &str,
        rows: usize,
        columns: usize,
        read: impl Fn(Range<usize>) -> Result<Vec<T>, SourceError> + Sync,
    ) -> Result<(), StoreError> {
        let layout = super::table_layout(rows, columns);
        let writer = ArrayWriter::create(self.group, &format!("forest/{name}"), layout, T::FILL)?;
        let chunk = writer.layout().file_shape()[0];
        self.progress.begin(&format!("writing {name}"), rows.div_ceil(chunk) as u64);
        for (n, first) in (0..rows).step_by(ROWS.min(chunk)).enumerate() {
            let source = |source| StoreError::Source { path: self.path.to_owned(), source };
            let mut values = read(first..(first + chunk).min(rows)).map_err(source)?;
            values.resize(chunk * columns, T::FILL);
            let index: &[usize] = if columns == 1 { &[n] } else { &[n, 0] };
            writer.write_shard(index, values)?;
            self.progress.step(1)?;
        }
        Ok(())
    }
}
