//! Verifies an array as a whole: every file is there, can be decoded, and fits its checksums.

use super::array::StoredArray;
use super::error::StoreError;
use super::layout::grid_index;
use super::sample::StoredSample;
use rayon::prelude::*;
use survey::progress::Progress;

impl StoredArray {
    /// Reads every file of the array, whatever its type, and verifies every checksum. Memory: one file for each
    /// thread.
    pub(super) fn verify(&self, progress: &Progress) -> Result<(), StoreError> {
        match self.type_name().as_str() {
            "int8" => self.verify_as::<i8>(progress),
            "uint8" => self.verify_as::<u8>(progress),
            "int16" => self.verify_as::<i16>(progress),
            "uint16" => self.verify_as::<u16>(progress),
            "int32" => self.verify_as::<i32>(progress),
            "uint32" => self.verify_as::<u32>(progress),
            // What is no number of ours is refused with its type.
            _ => self.verify_as::<f32>(progress),
        }
    }

    fn verify_as<T: StoredSample>(&self, progress: &Progress) -> Result<(), StoreError> {
        let edge = self.file_shape()?;
        let counts: Vec<usize> = self.shape().iter().zip(&edge).map(|(&n, &edge)| n.div_ceil(edge)).collect();
        let count: usize = counts.iter().product();
        progress.begin(&format!("checking {}", self.label()), count as u64);
        (0..count).into_par_iter().try_for_each(|n| {
            let index = grid_index(n, &counts);
            match (self.shards(), index.as_slice()) {
                (Some(shards), &[x, y, z]) => shards.verify::<T>([x, y, z])?,
                _ => {
                    let start: Vec<usize> = index.iter().zip(&edge).map(|(&i, &edge)| i * edge).collect();
                    let room = start.iter().zip(self.shape()).zip(&edge);
                    let size: Vec<usize> = room.map(|((&start, &n), &edge)| edge.min(n - start)).collect();
                    self.read_box::<T>(&start, &size)?;
                }
            }
            Ok(progress.step(1)?)
        })
    }

    /// The array as `GROUP/NAME`, for people.
    fn label(&self) -> String {
        let path = self.path();
        let mut parts = path.iter().rev().map(|part| part.to_string_lossy());
        match (parts.next(), parts.next()) {
            (Some(name), Some(group)) => format!("{group}/{name}"),
            _ => path.display().to_string(),
        }
    }
}

#[cfg(test)]
mod tests {
    use crate::{StoredVolume, VolumeInfo, write_volume};
    use std::fs;
    use std::path::{Path, PathBuf};
    use survey::{Progress, SurveyGeometry, VerticalUnit, Volume};

    fn files(folder: &Path) -> Vec<PathBuf> {
        let mut found = Vec::new();
        for entry in fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path()) {
            if entry.is_dir() { found.extend(files(&entry)) } else { found.push(entry) }
        }
        found
    }

    #[test]
    fn a_flipped_byte_anywhere_in_the_samples_is_found() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.zarr");
        let size = [70, 9, 66];
        let samples = (0..size.iter().product::<usize>()).map(|n| (n % 1009) as f32 + 1.0).collect();
        let volume = Volume::from_samples(size, samples).unwrap();
        let geometry = SurveyGeometry::regular(size, 25.0, 4.0, VerticalUnit::Milliseconds);
        write_volume(&path, &volume, &VolumeInfo::of(geometry), &Progress::silent()).unwrap();
        let is_whole = || StoredVolume::open(&path).and_then(|stored| stored.verify(&Progress::silent())).is_ok();
        assert!(is_whole());
        let data = files(&path).into_iter().filter(|file| !file.ends_with("zarr.json"));
        for file in data {
            let good = fs::read(&file).unwrap();
            // Level 0 and 1, the mask, the ranges: the middle, which may be padding, and the last byte.
            for at in [good.len() / 2, good.len() - 1] {
                let mut bad = good.clone();
                bad[at] ^= 4;
                fs::write(&file, &bad).unwrap();
                assert!(!is_whole(), "byte {at} of {}", file.display());
            }
            fs::write(&file, &good).unwrap();
        }
        assert!(is_whole());
    }
}
