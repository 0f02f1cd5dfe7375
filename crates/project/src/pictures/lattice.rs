//! i, j, k, layer and block at every sample of a lattice, written in boxes of whole files: the bytes do not depend on the
//! boxes, so that any stated memory, any number of threads and any number of processes give the same.
//!
//! Memory, beside the model and the grids that are sampled: for each thread, the samples of a file (128³ of them at most)
//! of all five arrays, and one file while it is compressed.

use crate::pictures::load::Rock;
use crate::{Project, ProjectError, derived};
use param::ParamError;
use rayon::ThreadPoolBuilder;
use std::path::Path;
use store::{ArrayLayout, ParameterizationVolumes, ParameterizationWriter};
use survey::Progress;
use survey::geometry::{GeometryError, MAX_VOXELS};
use system::memory;

/// Bytes that a thread holds for each sample of a file: its share of the box, 16, and a file of floats before and after
/// compression, with what compresses it.
const BYTES_A_SAMPLE: u64 = 32;

/// Bytes that are freed and kept for what comes next, where memory is stated.
const KEPT_BYTES: u64 = 16 << 20;

impl Rock {
    /// Samples the parameterization on a lattice of `size` that spans the survey, in at most so many bytes of memory
    /// (without a bound, as all threads need), and keeps it in the project.
    ///
    /// # Errors
    /// [`ParamError::TooLittleMemory`], the size has no samples, the disk does not take them, or the user cancelled.
    pub fn keep_voxels(
        &self,
        project: &Project,
        size: [usize; 3],
        memory_bytes: Option<u64>,
        progress: &Progress,
    ) -> Result<(), ProjectError> {
        if size.contains(&0) {
            return Err(ParamError::VolumeSize { size }.into());
        }
        let places = size.iter().try_fold(1u64, |n, &count| n.checked_mul(count as u64));
        if places.is_none_or(|places| places > MAX_VOXELS) {
            let [inlines, crosslines, samples] = size;
            return Err(GeometryError::TooLarge { inlines, crosslines, samples }.into());
        }
        derived::keep_volumes(project.root(), |group| {
            let threads = sampling_threads(size, memory_bytes)?;
            let writer = self.begin_voxels(group, size)?;
            if memory_bytes.is_some() {
                memory::share_freed_memory(threads, KEPT_BYTES);
            }
            let write = || self.write_all(&writer, threads, progress);
            match ThreadPoolBuilder::new().num_threads(threads).build() {
                Ok(pool) => pool.install(write),
                Err(_) => write(),
            }
        })
    }

    /// Begins the sampled parameterization in the folder `group`.
    ///
    /// # Errors
    /// The disk does not take it.
    pub fn begin_voxels(&self, group: &Path, size: [usize; 3]) -> Result<ParameterizationWriter, ProjectError> {
        let counts = [self.parameterization.layers, self.parameterization.blocks];
        Ok(ParameterizationWriter::create(group, size, counts, &self.key)?)
    }

    /// Samples and writes a box of files.
    ///
    /// # Errors
    /// There is no such box, the disk does not take it, or the user cancelled.
    pub fn write_voxels(
        &self,
        writer: &ParameterizationWriter,
        place: [usize; 3],
        files: [usize; 3],
        progress: &Progress,
    ) -> Result<(), ProjectError> {
        let (start, part) = writer.samples_of(place, files);
        let sampled = self.parameterization.voxel_box(&*self.model, writer.size(), start, part, &progress.muted())?;
        let volumes = ParameterizationVolumes {
            i: sampled.i,
            j: sampled.j,
            k: sampled.k,
            layer: sampled.layer,
            block: sampled.block,
        };
        Ok(writer.write(place, &volumes, progress)?)
    }

    fn write_all(
        &self,
        writer: &ParameterizationWriter,
        threads: usize,
        progress: &Progress,
    ) -> Result<(), ProjectError> {
        let counts = writer.file_counts();
        let files = box_of(threads, counts);
        progress.begin("sampling i, j, k", counts.iter().product::<usize>() as u64);
        for x in (0..counts[0]).step_by(files[0]) {
            for y in (0..counts[1]).step_by(files[1]) {
                for z in (0..counts[2]).step_by(files[2]) {
                    let place = [x, y, z];
                    let here = std::array::from_fn(|axis| files[axis].min(counts[axis] - place[axis]));
                    self.write_voxels(writer, place, here, progress)?;
                }
            }
        }
        Ok(())
    }
}

/// How many threads sample i, j, k on a lattice of `size` with so much memory; without a bound, all.
///
/// # Errors
/// [`ParamError::TooLittleMemory`].
pub fn sampling_threads(size: [usize; 3], memory_bytes: Option<u64>) -> Result<usize, ParamError> {
    let all = rayon::current_num_threads();
    let Some(stated) = memory_bytes else { return Ok(all) };
    let file = ArrayLayout::volume(size).file_shape().iter().map(|&n| n as u64).product::<u64>();
    let least = file * BYTES_A_SAMPLE;
    match (stated / least.max(1)).min(all as u64) {
        0 => Err(ParamError::TooLittleMemory { stated, least }),
        threads => Ok(threads as usize),
    }
}

/// A box of at most `most` files: as deep, then as wide as it may be.
fn box_of(most: usize, counts: [usize; 3]) -> [usize; 3] {
    let z = counts[2].min(most.max(1));
    let y = counts[1].min(most / z).max(1);
    [counts[0].min(most / (y * z)).max(1), y, z]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_box_has_at_most_as_many_files_as_there_are_threads() {
        assert_eq!(box_of(1, [3, 3, 3]), [1, 1, 1]);
        assert_eq!(box_of(2, [3, 3, 3]), [1, 1, 2]);
        assert_eq!(box_of(7, [3, 3, 3]), [1, 2, 3]);
        assert_eq!(box_of(64, [3, 2, 3]), [3, 2, 3]);
        assert_eq!(box_of(16, [9, 9, 2]), [1, 8, 2]);
    }

    #[test]
    fn too_little_memory_is_told_with_what_is_needed() {
        let least = 128u64.pow(3) * BYTES_A_SAMPLE;
        assert_eq!(sampling_threads([200; 3], Some(least)), Ok(1));
        let error = sampling_threads([200; 3], Some(least - 1)).unwrap_err();
        assert_eq!(error, ParamError::TooLittleMemory { stated: least - 1, least });
        assert!(error.to_string().contains("at least 64M"), "{error}");
        // A small lattice is one small file.
        assert!(sampling_threads([20, 30, 20], Some(1 << 20)).is_ok());
    }
}
