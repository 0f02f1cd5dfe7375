//! Reads volumes of a project for pictures: whole, at a coarser level where that does not fit into memory, or only the
//! cells in which faces and sections take samples.

use crate::content;
use crate::derived;
use crate::document::VolumeEntry;
use crate::error::ProjectError;
use crate::facts::{Facts, Query};
use crate::placement;
use glam::{Vec2, Vec3};
use rayon::prelude::*;
use render::places::Places;
use render::{NamedVolume, Samples, VoxelBox};
use std::ops::Range;
use std::sync::Arc;
use store::{BRICK, StoredVolume};
use survey::sparse_volume::CELL;
use survey::{Progress, SparseVolume, Volume};

/// Volumes up to this size are read whole, bytes: that is quick, and what follows may need all of it.
pub(crate) const SMALL_BYTES: u64 = 64 << 20;

/// Bricks that are read before they are taken apart.
const BRICKS_TOGETHER: usize = 16;

/// A volume of the project and its place.
pub struct LoadedVolume {
    /// Its name.
    pub name: String,
    /// Its samples.
    pub samples: Arc<LoadedSamples>,
    /// Voxel positions of its first and last sample.
    pub covers: VoxelBox,
    /// A hash of what was read, and from what.
    pub(crate) key: String,
}

/// Samples of a volume.
pub enum LoadedSamples {
    /// All.
    Whole(Volume<f32>),
    /// Those on faces and sections.
    Sparse(SparseVolume),
}

impl LoadedSamples {
    /// Counts of samples along each axis.
    fn size(&self) -> [usize; 3] {
        match self {
            Self::Whole(volume) => volume.size(),
            Self::Sparse(volume) => volume.size(),
        }
    }
}

impl LoadedVolume {
    /// In the form that renderers take.
    pub fn named(&self) -> NamedVolume<'_> {
        let volume = match &*self.samples {
            LoadedSamples::Whole(volume) => Samples::Whole(volume),
            LoadedSamples::Sparse(volume) => Samples::Sparse(volume),
        };
        NamedVolume { name: &self.name, volume, covers: self.covers }
    }

    /// All samples, if they are there.
    pub fn whole(&self) -> Option<&Volume<f32>> {
        match &*self.samples {
            LoadedSamples::Whole(volume) => Some(volume),
            LoadedSamples::Sparse(_) => None,
        }
    }

    /// Whether samples were asked for that were not read.
    pub(crate) fn has_missed(&self) -> bool {
        matches!(&*self.samples, LoadedSamples::Sparse(volume) if volume.has_missed())
    }
}

/// How volumes are read.
pub(crate) struct Reading<'a> {
    /// Most memory for the samples of each, bytes.
    pub bytes: u64,
    /// Where samples are taken; `None`: anywhere.
    pub places: Option<&'a Places<'a>>,
    /// Volumes up to this size are read whole, bytes.
    pub small_bytes: u64,
    /// Volumes of which all samples are needed in any case.
    pub whole: &'a [&'a str],
}

/// All samples of a volume at a level of its pyramid.
struct SamplesAt<'a> {
    entry: &'a VolumeEntry,
    level: usize,
}

impl Query for SamplesAt<'_> {
    const WHAT: &'static str = "samples";
    type Answer = LoadedSamples;

    fn key(&self, _: Facts<'_>) -> Result<String, ProjectError> {
        Ok(derived::key_of(&(&self.entry.file, &self.entry.hash, self.level)))
    }

    fn compute(&self, facts: Facts<'_>, progress: &Progress) -> Result<LoadedSamples, ProjectError> {
        let frame = facts.document.frame()?;
        content::read_level(facts.root, self.entry, frame, self.level, progress).map(LoadedSamples::Whole)
    }

    fn bytes(samples: &LoadedSamples) -> usize {
        samples.size().iter().product::<usize>() * size_of::<f32>()
    }
}

/// Reads the volumes that are `wanted` and not in memory; warns of those that are shown coarser than they are.
///
/// # Errors
/// Data are damaged, or the user cancelled.
pub(crate) fn read_volumes(
    facts: Facts<'_>,
    wanted: &[&str],
    reading: &Reading,
    progress: &Progress,
) -> Result<Vec<LoadedVolume>, ProjectError> {
    let geometry = facts.document.frame()?;
    let mut volumes = Vec::new();
    for entry in facts.document.volumes.iter().filter(|entry| wanted.contains(&entry.name.as_str())) {
        let lattice = entry.geometry.as_ref().unwrap_or(geometry);
        let covers = placement::covers(geometry, lattice)
            .map_err(|source| ProjectError::Placement { name: entry.name.clone(), source })?;
        let places = reading.places.filter(|_| !reading.whole.contains(&entry.name.as_str()));
        let Read { samples, level, key } = read_samples(facts, entry, &covers, places, reading, progress)?;
        if level > 0 {
            let apart = 1 << level;
            progress.warn(format!(
                "volume {} is shown by one sample in {apart} along each axis, to fit into memory",
                entry.name
            ));
        }
        let covers = at_level(covers, lattice.size(), samples.size(), level);
        volumes.push(LoadedVolume { name: entry.name.clone(), samples, covers, key });
    }
    Ok(volumes)
}

/// Samples of a volume, their level and their key.
struct Read {
    samples: Arc<LoadedSamples>,
    level: usize,
    key: String,
}

/// A volume, or its samples at some places, at the finest level that is in memory or fits into it.
fn read_samples(
    facts: Facts<'_>,
    entry: &VolumeEntry,
    covers: &VoxelBox,
    places: Option<&Places>,
    &Reading { bytes, small_bytes, .. }: &Reading,
    progress: &Progress,
) -> Result<Read, ProjectError> {
    let all = |level: usize| SamplesAt { entry, level };
    if let Some(samples) = facts.held(&all(0))? {
        return Ok(Read { samples, level: 0, key: all(0).key(facts)? });
    }
    let frame = facts.document.frame()?;
    let stored = content::open_volume(facts.root, entry, frame)?;
    let bytes_at = |level: usize| stored.size(level).iter().map(|&n| n as u64).product::<u64>() * 4;
    if let Some(places) = places.filter(|_| bytes_at(0) > small_bytes) {
        content::open_recorded(facts.root, entry, frame)?;
        for level in 0..stored.level_count() {
            let size = stored.size(level);
            let wanted = wanted_cells(size, &at_level(*covers, stored.size(0), size, level), places);
            if SparseVolume::bytes(size, wanted.iter().filter(|wanted| **wanted).count()) <= bytes {
                let cells = blake3::hash(bytemuck::cast_slice(&wanted));
                let key = derived::key_of(&(all(level).key(facts)?, cells.to_hex().as_str()));
                let samples = Arc::new(LoadedSamples::Sparse(read_sparse(&stored, level, &wanted, progress)?));
                return Ok(Read { samples, level, key });
            }
        }
    }
    let mut level = stored.level_count() - 1;
    for finer in 0..level {
        if bytes_at(finer) <= bytes || facts.held(&all(finer))?.is_some() {
            level = finer;
            break;
        }
    }
    Ok(Read { samples: facts.get(&all(level), progress)?, level, key: all(level).key(facts)? })
}

/// The cells of a volume, `[x][y][z]`, in which interpolation at the places takes samples.
fn wanted_cells(size: [usize; 3], covers: &VoxelBox, places: &Places) -> Vec<bool> {
    let counts = SparseVolume::cell_counts(size);
    let low = covers.low().as_vec3();
    let last = Vec3::from_array(size.map(|count| count.saturating_sub(1) as f32));
    let step = covers.extent().as_vec3() / last.max(Vec3::ONE);
    // Voxels between which interpolation takes samples of a cell: those up to its neighbours.
    let between = |axis: usize, cell: usize| {
        let ends = [(cell * CELL) as f32 - 1.0, ((cell + 1) * CELL) as f32];
        ends.map(|at| low[axis] + at * step[axis])
    };
    let mut wanted = vec![false; counts.iter().product()];
    wanted.par_chunks_mut(counts[2]).enumerate().for_each(|(column, wanted)| {
        let [x, y] = [between(0, column / counts[1]), between(1, column % counts[1])];
        for depths in places.depths([Vec2::new(x[0], y[0]), Vec2::new(x[1], y[1])]) {
            let cell = |depth: f32| (depth - low.z) / step.z / CELL as f32;
            let first = (cell(depths[0] - step.z).floor().max(0.0) as usize).min(counts[2] - 1);
            let end = ((cell(depths[1] + step.z).floor().max(0.0)) as usize).min(counts[2] - 1);
            wanted[first..=end].fill(true);
        }
    });
    wanted
}

/// Reads the cells that are wanted of a level.
fn read_sparse(
    stored: &StoredVolume,
    level: usize,
    wanted: &[bool],
    progress: &Progress,
) -> Result<SparseVolume, ProjectError> {
    let size = stored.size(level);
    let live = stored.live_at(level);
    let mut sparse = SparseVolume::new(size, wanted, live);
    let boxes = boxes(size, wanted);
    progress.begin("reading samples of faces", boxes.len() as u64);
    for together in boxes.chunks(BRICKS_TOGETHER) {
        let read = |&(start, part): &([usize; 3], [usize; 3])| {
            progress.step(1)?;
            Ok::<_, ProjectError>((start, stored.read_box_f32(level, start, part)?))
        };
        for (start, part) in together.par_iter().map(read).collect::<Result<Vec<_>, _>>()? {
            sparse.fill(start, &part);
        }
    }
    Ok(sparse)
}

/// The box of the wanted cells in each brick that has any: where it begins, and its size.
fn boxes(size: [usize; 3], wanted: &[bool]) -> Vec<([usize; 3], [usize; 3])> {
    /// Cells of a brick along each axis.
    const CELLS: usize = BRICK / CELL;
    let counts = SparseVolume::cell_counts(size);
    let bricks = size.map(|count| count.div_ceil(BRICK));
    let range = |axis: usize, brick: usize| brick * CELLS..((brick + 1) * CELLS).min(counts[axis]);
    let wanted_in = |n: usize| {
        let brick = [n / bricks[2] / bricks[1], n / bricks[2] % bricks[1], n % bricks[2]];
        let own: [Range<usize>; 3] = std::array::from_fn(|axis| range(axis, brick[axis]));
        let (mut low, mut high) = ([usize::MAX; 3], [0; 3]);
        for x in own[0].clone() {
            for y in own[1].clone() {
                for z in own[2].clone().filter(|z| wanted[(x * counts[1] + y) * counts[2] + z]) {
                    for (axis, at) in [x, y, z].into_iter().enumerate() {
                        (low[axis], high[axis]) = (low[axis].min(at), high[axis].max(at + 1));
                    }
                }
            }
        }
        (high[0] > 0).then(|| {
            let start = low.map(|cell| cell * CELL);
            (start, std::array::from_fn(|axis| (high[axis] * CELL).min(size[axis]) - start[axis]))
        })
    };
    (0..bricks.iter().product()).into_par_iter().filter_map(wanted_in).collect()
}

/// Voxel positions of the first and last sample at a level of a pyramid, whose sample m lies at m·2^level of the full
/// volume.
fn at_level(covers: VoxelBox, full: [usize; 3], size: [usize; 3], level: usize) -> VoxelBox {
    let max = |axis: usize| {
        let share = ((size[axis].saturating_sub(1)) << level) as f64 / full[axis].saturating_sub(1).max(1) as f64;
        covers.min[axis] + (covers.max[axis] - covers.min[axis]) * if level == 0 { 1.0 } else { share }
    };
    VoxelBox { min: covers.min, max: [max(0), max(1), max(2)] }
}

#[cfg(test)]
mod tests;
