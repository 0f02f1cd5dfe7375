//! Verifies an array as a whole: every file is there, can be decoded, and fits its checksums. All that is damaged is
//! found, not just the first of it.

use super::array::StoredArray;
use super::error::StoreError;
use super::layout::grid_index;
use super::sample::StoredSample;
use rayon::prelude::*;
use std::path::Path;
use survey::progress::Progress;

/// How many places of damage are named one by one.
const TOLD: usize = 4;

/// What is damaged in the arrays of a group, in their order.
#[derive(Debug, Default)]
pub(super) struct DamageFindings {
    damaged: Vec<(String, String)>,
    /// The first failure that says nothing of what a file holds.
    unread: Option<StoreError>,
}

impl DamageFindings {
    /// Notes damage, and that a file cannot be read now.
    ///
    /// # Errors
    /// Any other error, such as that the user cancelled.
    fn note(&mut self, array: &StoredArray, error: StoreError) -> Result<(), StoreError> {
        let reason = match error {
            StoreError::Damaged { reason, .. } => reason,
            error if error.says_nothing() => {
                self.unread.get_or_insert(error);
                return Ok(());
            }
            error @ StoreError::Io { .. } => match std::error::Error::source(&error) {
                Some(cause) => format!("{error}: {cause}"),
                None => error.to_string(),
            },
            other => return Err(other),
        };
        self.damaged.push((array.name().to_owned(), reason));
        Ok(())
    }

    /// # Errors
    /// [`StoreError::Damaged`] with how many places are damaged, and the first of them, if there are any; otherwise why a
    /// file could not be read.
    pub(super) fn into_result(self, group: &Path) -> Result<(), StoreError> {
        let damaged = &self.damaged;
        let Some((first, reason)) = damaged.first() else { return self.unread.map_or(Ok(()), Err) };
        let reason = if damaged.len() == 1 {
            reason.clone()
        } else {
            let told = damaged.iter().take(TOLD).map(|(array, reason)| match array == first {
                true => reason.clone(),
                false => format!("array \"{array}\": {reason}"),
            });
            let more = damaged.len().saturating_sub(TOLD);
            let rest = if more == 0 { String::new() } else { format!("; and {more} more") };
            format!("{} bricks or files are damaged: {}{rest}", damaged.len(), told.collect::<Vec<_>>().join("; "))
        };
        Err(StoreError::damaged(group, first, reason))
    }
}

impl StoredArray {
    /// Reads every file of the array, whatever its type, and verifies every checksum. Memory: one file for each
    /// thread.
    pub(super) fn verify(&self, progress: &Progress) -> Result<(), StoreError> {
        let mut findings = DamageFindings::default();
        self.find_damage(&mut findings, progress)?;
        findings.into_result(self.group())
    }

    /// The same, with the damage of several arrays in one account.
    pub(super) fn find_damage(&self, findings: &mut DamageFindings, progress: &Progress) -> Result<(), StoreError> {
        match self.type_name().as_str() {
            "int8" => self.find_damage_as::<i8>(findings, progress),
            "uint8" => self.find_damage_as::<u8>(findings, progress),
            "int16" => self.find_damage_as::<i16>(findings, progress),
            "uint16" => self.find_damage_as::<u16>(findings, progress),
            "int32" => self.find_damage_as::<i32>(findings, progress),
            "uint32" => self.find_damage_as::<u32>(findings, progress),
            "float64" => self.find_damage_as::<f64>(findings, progress),
            // What is no number of ours is refused with its type.
            _ => self.find_damage_as::<f32>(findings, progress),
        }
    }

    fn find_damage_as<T: StoredSample>(
        &self,
        findings: &mut DamageFindings,
        progress: &Progress,
    ) -> Result<(), StoreError> {
        let edge = self.file_shape()?;
        let counts: Vec<usize> = self.shape().iter().zip(&edge).map(|(&n, &edge)| n.div_ceil(edge)).collect();
        let count: usize = counts.iter().product();
        progress.begin(&format!("checking {}", self.label()), count as u64);
        let files = (0..count).into_par_iter().map(|n| {
            let index = grid_index(n, &counts);
            let found = match (self.shards(), index.as_slice()) {
                (Some(shards), &[x, y, z]) => shards.damage::<T>([x, y, z]),
                _ => {
                    let start: Vec<usize> = index.iter().zip(&edge).map(|(&i, &edge)| i * edge).collect();
                    let room = start.iter().zip(self.shape()).zip(&edge);
                    let size: Vec<usize> = room.map(|((&start, &n), &edge)| edge.min(n - start)).collect();
                    self.read_box::<T>(&start, &size).err().into_iter().collect()
                }
            };
            progress.step(1)?;
            Ok(found)
        });
        let errors: Vec<Vec<StoreError>> = files.collect::<Result<_, StoreError>>()?;
        errors.into_iter().flatten().try_for_each(|error| findings.note(self, error))
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

    /// A stored volume of this size, in a folder of its own.
    fn written(size: [usize; 3]) -> (tempfile::TempDir, PathBuf) {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.zarr");
        let samples = (0..size.iter().product::<usize>()).map(|n| (n % 1009) as f32 + 1.0).collect();
        let volume = Volume::from_samples(size, samples).unwrap();
        let geometry = SurveyGeometry::regular(size, 25.0, 4.0, VerticalUnit::Milliseconds);
        write_volume(&path, &volume, &VolumeInfo::of(geometry), &Progress::silent()).unwrap();
        (folder, path)
    }

    #[test]
    fn a_flipped_byte_anywhere_in_the_samples_is_found() {
        let (_folder, path) = written([70, 9, 66]);
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

    #[test]
    fn every_damaged_brick_is_counted_and_the_first_are_named() {
        let (_folder, path) = written([130, 130, 66]);
        let data: Vec<_> = files(&path.join("0")).into_iter().filter(|file| !file.ends_with("zarr.json")).collect();
        let (first, length) = (&data[0], fs::metadata(&data[0]).unwrap().len() as usize);
        let mut content = fs::read(first).unwrap();
        // Nowhere near a brick's own edge, so that each belongs to another one.
        let brick = 64 * 64 * 64 * 4;
        let places: Vec<usize> = (0..length / brick).map(|n| n * brick + brick / 3).collect();
        assert!(places.len() >= 6, "{length} bytes in {}", first.display());
        for &place in &places {
            content[place] ^= 8;
        }
        fs::write(first, content).unwrap();
        // Another array of the same volume is damaged as well.
        let coarse = files(&path.join("1")).into_iter().find(|file| !file.ends_with("zarr.json")).unwrap();
        fs::write(&coarse, "").unwrap();
        let error = StoredVolume::open(&path).unwrap().verify(&Progress::silent()).unwrap_err().to_string();
        let count = places.len() + 1;
        assert!(error.contains(&format!("{count} bricks or files are damaged")), "{error}");
        assert!(error.contains("brick [0, 0, 0]") && error.contains(&format!("and {} more", count - 4)), "{error}");
    }
}
