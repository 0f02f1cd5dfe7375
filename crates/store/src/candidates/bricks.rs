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
use super::{CandidateWriter, KIND, LeafWriter, halve, level_name, levels, widened};
use rayon::prelude::*;
use serde::Serialize;
use std::ops::Range;
use std::path::Path;
use survey::candidates::{BEYOND, CandidateInfo, ForestCounts, ForestRows};
use survey::progress::Progress;
use survey::source::SourceError;

impl CandidateWriter {
    /// Writes the files of a column, whose first inline and crossline are multiples of a file's sides:
    /// `[inline][crossline][sample]`, as far as the volume goes.
    ///
    /// # Errors
    /// [`StoreError`], [`StoreError::SizeMismatch`] if the samples are not a column.
    pub fn write_column(
        &self,
        lines: [Range<usize>; 2],
        distance: &[u8],
        leaf: &[u32],
        progress: &Progress,
    ) -> Result<(), StoreError> {
        write_column(&self.distance, &self.leaf, lines, (distance, leaf), progress)
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
        for level in 1..levels(size) {
            create_level(group, level, size, info.leaves)?;
            let files = LevelFiles::open(group, level, size, info.leaves, None)?;
            progress.begin(&format!("storing level {level}"), files.count() as u64);
            (0..files.count()).into_par_iter().with_max_len(1).try_for_each(|n| {
                files.write(n)?;
                Ok::<(), StoreError>(progress.step(1)?)
            })?;
        }
        write_group(group, "forest", serde_json::Map::new())?;
        let counts = forest.counts();
        for table in CandidateTable::ALL {
            table.create(group, counts)?;
            let count = table.file_count(counts);
            progress.begin(&format!("writing {}", table.name()), count as u64);
            for n in 0..count {
                table.write(group, n, forest, None)?;
                progress.step(1)?;
            }
        }
        write_header(group, KIND, info)?;
        replacement.commit()
    }
}

/// Writes the files of a column.
pub(super) fn write_column(
    to_distance: &ArrayWriter<u8>,
    to_leaf: &LeafWriter,
    [x, y]: [Range<usize>; 2],
    (distance, leaf): (&[u8], &[u32]),
    progress: &Progress,
) -> Result<(), StoreError> {
    let (edge, nz) = (to_distance.layout().file_shape(), to_distance.layout().shape[2]);
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
        to_distance.write_shard(&index, gather(distance, &size, &start, edge))?;
        to_leaf.write_shard(&index, gather(leaf, &size, &start, edge))?;
    }
    Ok(())
}

/// Voxels of a level.
pub(super) fn size_of_level(size: [usize; 3], level: usize) -> [usize; 3] {
    (0..level).fold(size, |size, _| halved(size))
}

/// Writes the metadata of a level of the pyramid.
pub(super) fn create_level(group: &Path, level: usize, size: [usize; 3], leaves: usize) -> Result<(), StoreError> {
    write_group(group, &format!("pyramid/{level}"), serde_json::Map::new())?;
    let layout = ArrayLayout::volume(size_of_level(size, level));
    ArrayWriter::create(group, &level_name(level, "distance"), layout.clone(), BEYOND)?;
    LeafWriter::create(group, &level_name(level, "leaf"), layout, leaves)?;
    Ok(())
}

/// The files of a level of the pyramid, each made from those of the level before that it covers.
pub(super) struct LevelFiles {
    fine: [usize; 3],
    size: [usize; 3],
    layout: ArrayLayout,
    fine_distance: StoredArray,
    fine_leaf: StoredArray,
    distance: ArrayWriter<u8>,
    leaf: LeafWriter,
}

impl LevelFiles {
    /// Opens a level whose metadata are written, and the level before. `apart` is where files are written before they have
    /// their place, if other processes write the level too.
    pub(super) fn open(
        group: &Path,
        level: usize,
        size: [usize; 3],
        leaves: usize,
        apart: Option<&Path>,
    ) -> Result<Self, StoreError> {
        let open = |array: &str| StoredArray::open(group, &level_name(level - 1, array));
        let layout = ArrayLayout::volume(size_of_level(size, level));
        Ok(Self {
            fine: size_of_level(size, level - 1),
            size: size_of_level(size, level),
            fine_distance: open("distance")?,
            fine_leaf: open("leaf")?,
            distance: ArrayWriter::of_created(group, &level_name(level, "distance"), layout.clone(), BEYOND, apart)?,
            leaf: LeafWriter::open(group, &level_name(level, "leaf"), layout.clone(), leaves, apart)?,
            layout,
        })
    }

    /// Count of files.
    pub(super) fn count(&self) -> usize {
        self.layout.file_counts().iter().product()
    }

    /// Makes a file.
    pub(super) fn write(&self, n: usize) -> Result<(), StoreError> {
        let Self { fine, size, .. } = self;
        let (counts, edge) = (self.layout.file_counts(), self.layout.file_shape());
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
            let of_distance = self.fine_distance.read_box::<u8>(&first, &around)?;
            let of_leaf = if self.fine_leaf.holds::<u16>() {
                widened(&self.fine_leaf.read_box::<u16>(&first, &around)?)
            } else {
                self.fine_leaf.read_box::<u32>(&first, &around)?
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
        self.distance.write_shard(&index, gather(&distances, &inside, &[0; 3], edge))?;
        self.leaf.write_shard(&index, gather(&leaf_ids, &inside, &[0; 3], edge))
    }
}

/// A table of surfaces and trees, in files of some rows each.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum CandidateTable {
    Trace,
    Z,
    Triangles,
    Surfaces,
    Nodes,
}

impl CandidateTable {
    pub(super) const ALL: [Self; 5] = [Self::Trace, Self::Z, Self::Triangles, Self::Surfaces, Self::Nodes];

    fn name(self) -> &'static str {
        ["forest/trace", "forest/z", "forest/triangles", "forest/surfaces", "forest/nodes"][self as usize]
    }

    fn layout(self, counts: ForestCounts) -> ArrayLayout {
        let ForestCounts { vertices, triangles, surfaces, nodes } = counts;
        let (rows, columns) = match self {
            Self::Trace => (vertices, 2),
            Self::Z => (vertices, 1),
            Self::Triangles => (triangles, 3),
            Self::Surfaces => (surfaces, 5),
            Self::Nodes => (nodes, 6),
        };
        super::table_layout(rows, columns)
    }

    /// Count of files.
    pub(super) fn file_count(self, counts: ForestCounts) -> usize {
        self.layout(counts).file_counts()[0]
    }

    /// Writes the metadata.
    pub(super) fn create(self, group: &Path, counts: ForestCounts) -> Result<(), StoreError> {
        let (name, layout) = (self.name(), self.layout(counts));
        match self {
            Self::Trace => ArrayWriter::<u16>::create(group, name, layout, 0).map(drop),
            Self::Z => ArrayWriter::create(group, name, layout, f32::FILL).map(drop),
            Self::Triangles | Self::Surfaces | Self::Nodes => {
                ArrayWriter::<u32>::create(group, name, layout, 0).map(drop)
            }
        }
    }

    /// Writes a file; for `apart` see [`LevelFiles::open`].
    pub(super) fn write(
        self,
        group: &Path,
        file: usize,
        forest: &dyn ForestRows,
        apart: Option<&Path>,
    ) -> Result<(), StoreError> {
        let to = TableFile { name: self.name(), layout: self.layout(forest.counts()), group, file, apart };
        match self {
            Self::Trace => to.write(|rows| Ok(forest.trace(rows)?.into_flattened())),
            Self::Z => to.write(|rows| forest.z(rows)),
            Self::Triangles => to.write(|rows| Ok(forest.triangles(rows)?.into_flattened())),
            Self::Surfaces => to.write(|rows| Ok(forest.surfaces(rows)?.into_flattened())),
            Self::Nodes => to.write(|rows| Ok(forest.nodes(rows)?.into_flattened())),
        }
    }
}

/// A file of a table.
struct TableFile<'a> {
    name: &'static str,
    layout: ArrayLayout,
    group: &'a Path,
    file: usize,
    apart: Option<&'a Path>,
}

impl TableFile<'_> {
    fn write<T: StoredSample>(
        self,
        read: impl Fn(Range<usize>) -> Result<Vec<T>, SourceError>,
    ) -> Result<(), StoreError> {
        let (shape, rows) = (self.layout.file_shape().to_vec(), self.layout.shape[0]);
        let first = self.file * shape[0];
        let source = |source| StoreError::Source { path: self.group.to_owned(), source };
        let mut values = read(first..(first + shape[0]).min(rows)).map_err(source)?;
        values.resize(shape.iter().product(), T::FILL);
        let writer = ArrayWriter::of_created(self.group, self.name, self.layout, T::FILL, self.apart)?;
        let index: &[usize] = if shape.len() == 1 { &[self.file] } else { &[self.file, 0] };
        writer.write_shard(index, values)
    }
}
