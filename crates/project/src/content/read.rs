//! Reads bulk data by the entries of a project.

use crate::document::{FaultEntry, HorizonEntry, VolumeEntry, WellEntry};
use crate::error::ProjectError;
use crate::folder::at_hand;
use glam::DVec3;
use std::path::Path;
use store::{self, StoredVolume};
use survey::{Fault, Horizon, Progress, SurveyGeometry, Volume, Well};

/// Reads a well of the project in `root`.
///
/// # Errors
/// Data are missing or damaged.
pub fn read_well(root: &Path, entry: &WellEntry) -> Result<Well, ProjectError> {
    let well = store::read_well(&at_hand(root, &entry.file))?;
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

/// Reads a volume of the project in `root`, whose lattice is `frame` where the volume has none of its own.
///
/// # Errors
/// Those of [`open_volume`], or cancelled.
pub fn read_volume(
    root: &Path,
    entry: &VolumeEntry,
    frame: &SurveyGeometry,
    progress: &Progress,
) -> Result<Volume<f32>, ProjectError> {
    Ok(open_volume(root, entry, frame)?.read_f32(0, progress)?)
}

/// Reads a volume like [`read_volume`] at the finest level of its pyramid that fits into this many bytes, or at the
/// coarsest where none does; returns the level, too.
///
/// # Errors
/// Data are missing or damaged, or the user cancelled.
pub fn read_volume_within(
    root: &Path,
    entry: &VolumeEntry,
    frame: &SurveyGeometry,
    bytes: u64,
    progress: &Progress,
) -> Result<(Volume<f32>, usize), ProjectError> {
    let stored = open_volume(root, entry, frame)?;
    let fits = |level: &usize| stored.size(*level).iter().map(|&n| n as u64).product::<u64>() * 4 <= bytes;
    let level = (0..stored.level_count()).find(fits).unwrap_or(stored.level_count() - 1);
    Ok((stored.read_f32(level, progress)?, level))
}

/// Reads a horizon of the project in `root`.
///
/// # Errors
/// Data are missing or damaged, or the user cancelled.
pub fn read_horizon(root: &Path, entry: &HorizonEntry, progress: &Progress) -> Result<Horizon, ProjectError> {
    let horizon = store::read_horizon(&at_hand(root, &entry.file), progress)?;
    Ok(Horizon { name: entry.name.clone(), ..horizon })
}

/// Reads a fault of the project in `root`.
///
/// # Errors
/// Data are missing or damaged.
pub fn read_fault(root: &Path, entry: &FaultEntry) -> Result<Fault, ProjectError> {
    let fault = store::read_fault(&at_hand(root, &entry.file))?;
    Ok(Fault { name: entry.name.clone(), truncated_by: entry.truncated_by.clone(), ..fault })
}

/// The triangles of a fault in voxels.
pub fn fault_triangles(fault: &Fault, geometry: &SurveyGeometry) -> Vec<[DVec3; 3]> {
    let vertices: Vec<DVec3> = fault.mesh.vertices.iter().map(|vertex| geometry.voxel_from_world(*vertex)).collect();
    fault.mesh.triangles.iter().map(|corners| corners.map(|v| vertices[v as usize])).collect()
}
