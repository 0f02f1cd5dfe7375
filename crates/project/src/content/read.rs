//! Reads bulk data by the entries of a project.
//!
//! Whatever is read whole is compared with the hash that its entry records, so that data which were changed or damaged
//! outside of the program are never shown as the project's own. An entry without a hash, from a project that recorded
//! none, is believed. A part of a volume is read without that: its bricks have checksums of their own.

use super::{hash_fault, hash_horizon, hash_parameterization, hash_stored, hash_well};
use crate::document::{FaultEntry, HorizonEntry, ParameterizationEntry, TextureEntry, VolumeEntry, WellEntry};
use crate::error::{Noun, ProjectError};
use crate::folder::at_hand;
use glam::DVec3;
use std::path::{Path, PathBuf};
use store::{self, ParameterizationVolumes, StoredParameterization, StoredVolume};
use survey::{Fault, Horizon, Progress, SurveyGeometry, Volume, Well};
use system::file;
use system::file::FileAction;

/// Compares the hash of what was read with the one that was recorded; an empty one is not known.
fn compare(path: &Path, noun: Noun, name: &str, expected: &str, found: String) -> Result<(), ProjectError> {
    if expected.is_empty() || found == expected {
        return Ok(());
    }
    let (path, name, expected) = (path.to_owned(), name.to_owned(), expected.to_owned());
    Err(ProjectError::OtherContent { path, noun, name, expected, found })
}

/// Reads a well of the project in `root`.
///
/// # Errors
/// Data are missing or damaged, [`ProjectError::OtherContent`] if they are not those that were recorded.
pub fn read_well(root: &Path, entry: &WellEntry) -> Result<Well, ProjectError> {
    let path = at_hand(root, &entry.file);
    let well = store::read_well(&path)?;
    let found =
        hash_well(&well).map_err(|error| ProjectError::Malformed { path: path.clone(), detail: error.to_string() })?;
    compare(&path, Noun::Well, &entry.name, &entry.hash, found)?;
    Ok(Well { name: entry.name.clone(), ..well })
}

/// Opens a volume of the project in `root`, whose lattice is `frame` where the volume has none of its own.
///
/// # Errors
/// Missing or damaged data, [`ProjectError::OtherSize`] where they are not of the size that the project says.
pub fn open_volume(root: &Path, entry: &VolumeEntry, frame: &SurveyGeometry) -> Result<StoredVolume, ProjectError> {
    let stored = StoredVolume::open(&at_hand(root, &entry.file))?;
    let expected = entry.geometry.as_ref().unwrap_or(frame).size();
    let found = stored.size(0);
    if found == expected {
        Ok(stored)
    } else {
        Err(ProjectError::OtherSize { name: entry.name.clone(), expected, found })
    }
}

/// Opens a volume like [`open_volume`] and makes sure that its samples are those that were recorded. Cost: one read of
/// a few bytes for each file of the volume. It relies on the checksums of bricks, which whoever reads them compares.
///
/// # Errors
/// Those of [`open_volume`], [`ProjectError::OtherContent`] if the samples are not those that were recorded.
pub fn open_recorded(root: &Path, entry: &VolumeEntry, frame: &SurveyGeometry) -> Result<StoredVolume, ProjectError> {
    let stored = open_volume(root, entry, frame)?;
    check_volume(root, entry, &stored)?;
    Ok(stored)
}

fn check_volume(root: &Path, entry: &VolumeEntry, stored: &StoredVolume) -> Result<(), ProjectError> {
    compare(&at_hand(root, &entry.file), Noun::Volume, &entry.name, &entry.hash, hash_stored(stored)?)
}

/// Reads a volume of the project in `root`, whose lattice is `frame` where the volume has none of its own.
///
/// # Errors
/// Those of [`open_recorded`], or cancelled.
pub(crate) fn read_volume(
    root: &Path,
    entry: &VolumeEntry,
    frame: &SurveyGeometry,
    progress: &Progress,
) -> Result<Volume<f32>, ProjectError> {
    read_level(root, entry, frame, 0, progress)
}

/// Reads a volume like [`read_volume`] at a level of its pyramid.
///
/// # Errors
/// Those of [`open_recorded`], or cancelled; at a coarser level the samples are not compared with what was recorded.
pub(crate) fn read_level(
    root: &Path,
    entry: &VolumeEntry,
    frame: &SurveyGeometry,
    level: usize,
    progress: &Progress,
) -> Result<Volume<f32>, ProjectError> {
    let stored = open_volume(root, entry, frame)?;
    // The hash covers the samples themselves, not the averages of coarser levels.
    if level == 0 {
        check_volume(root, entry, &stored)?;
    }
    Ok(stored.read_f32(level, progress)?)
}

/// Reads a horizon of the project in `root`.
///
/// # Errors
/// Data are missing or damaged, [`ProjectError::OtherContent`] if they are not those that were recorded, or the user
/// cancelled.
pub fn read_horizon(root: &Path, entry: &HorizonEntry, progress: &Progress) -> Result<Horizon, ProjectError> {
    let path = at_hand(root, &entry.file);
    let horizon = store::read_horizon(&path, progress)?;
    compare(&path, Noun::Horizon, &entry.name, &entry.hash, hash_horizon(&horizon))?;
    Ok(Horizon { name: entry.name.clone(), ..horizon })
}

/// Reads a fault of the project in `root`.
///
/// # Errors
/// Data are missing or damaged, [`ProjectError::OtherContent`] if they are not those that were recorded.
pub fn read_fault(root: &Path, entry: &FaultEntry) -> Result<Fault, ProjectError> {
    let path = at_hand(root, &entry.file);
    let fault = store::read_fault(&path)?;
    compare(&path, Noun::Fault, &entry.name, &entry.hash, hash_fault(&fault))?;
    Ok(Fault { name: entry.name.clone(), truncated_by: entry.truncated_by.clone(), grown_m: entry.grown_m, ..fault })
}

/// Reads the parameterization of another program that the project in `root` keeps.
///
/// # Errors
/// Data are missing or damaged, [`ProjectError::OtherContent`] if they are not those that were recorded, or the user
/// cancelled.
pub(crate) fn read_parameterization(
    root: &Path,
    entry: &ParameterizationEntry,
    progress: &Progress,
) -> Result<ParameterizationVolumes, ProjectError> {
    let path = at_hand(root, &entry.file);
    let volumes = StoredParameterization::open(&path)?.read(progress)?;
    compare(&path, Noun::Parameterization, &entry.name, &entry.hash, hash_parameterization(&volumes))?;
    Ok(volumes)
}

/// The path of a tile of the project in `root`, whose bytes are those that were recorded.
///
/// # Errors
/// It is missing, [`ProjectError::OtherContent`] if it is not what was recorded.
pub(crate) fn texture_path(root: &Path, entry: &TextureEntry) -> Result<PathBuf, ProjectError> {
    let path = at_hand(root, &entry.file);
    if !entry.hash.is_empty() {
        compare(&path, Noun::Texture, &entry.name, &entry.hash, hash_file(&path)?)?;
    }
    Ok(path)
}

/// BLAKE3 of a small file's bytes.
pub(crate) fn hash_file(path: &Path) -> Result<String, ProjectError> {
    let bytes = file::read(path, file::MAX_DOCUMENT_BYTES)
        .map_err(|source| ProjectError::io(FileAction::Read, path, source))?;
    Ok(blake3::hash(&bytes).to_hex().to_string())
}

/// The triangles of a fault in voxels.
pub fn fault_triangles(fault: &Fault, geometry: &SurveyGeometry) -> Vec<[DVec3; 3]> {
    let vertices: Vec<DVec3> = fault.mesh.vertices.iter().map(|vertex| geometry.voxel_from_world(*vertex)).collect();
    fault.mesh.triangles.iter().map(|corners| corners.map(|v| vertices[v as usize])).collect()
}
