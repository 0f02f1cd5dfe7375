//! The store of a project on disk. Arrays (volumes, horizons, candidates, parameterizations) are in Zarr v3,
//! which other programs can open; faults and wells are in JSON.
//!
//! ```text
//! volumes/NAME.zarr               write_volume, write_blocks, resume_blocks, link_volume, VolumeParts, StoredVolume
//! horizons/NAME.zarr              write_horizon, read_horizon
//! faults/NAME.json                write_fault, read_fault
//! wells/NAME.json                 write_well, read_well
//! derived/parameterization.zarr   write_parameterization, StoredParameterization
//! derived/candidates.zarr         CandidateWriter, CandidateParts, StoredCandidates
//! ```
//!
//! Everything is written under a temporary name in the same folder, synced, and renamed at the very end
//! ([`Replacement`]). After a crash, a cancelled write or a full disk, the previous state is still there.
//! [`resume_blocks`] is the exception: it writes in place, so that an interrupted write can be continued; so do
//! [`VolumeParts`] and [`CandidateParts`], with which several processes write one volume, or one set of candidates.
//!
//! Volumes that do not fit into memory come from a [`survey::source::BlockSource`], and candidates arrive
//! through [`survey::candidates::CandidateSink`]. Only the modules `array` and `sample` use the array library
//! (zarrs); no other crate does.
//!
//! Deliberately absent: files of other programs, the notion of a project, and any computation on the stored
//! data except pyramids and value ranges.
//!
//! ```
//! use store::{StoredVolume, VolumeInfo};
//! use survey::{Progress, SurveyGeometry, VerticalUnit, Volume};
//!
//! let folder = tempfile::tempdir()?;
//! let path = folder.path().join("amplitude.zarr");
//! let geometry = SurveyGeometry::regular([2, 3, 4], 25.0, 4.0, VerticalUnit::Milliseconds);
//! let volume = Volume::from_samples([2, 3, 4], (0..24_u8).map(f32::from).collect())?;
//! store::write_volume(&path, &volume, &VolumeInfo::of(geometry), &Progress::silent())?;
//!
//! let stored = StoredVolume::open(&path)?;
//! assert_eq!(stored.read::<f32>(0, &Progress::silent())?, volume);
//! assert_eq!(stored.read_box::<f32>(0, [1, 0, 0], [1, 1, 4])?.samples(), [12.0, 13.0, 14.0, 15.0]);
//! assert_eq!(stored.brick_ranges(0)?, ([1, 1, 1], vec![[0.0, 23.0]]));
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod array;
mod block_file;
mod candidates;
mod capacity;
mod coordinates;
mod error;
mod fault;
mod file_place;
mod header;
mod horizon;
mod ingest;
mod layout;
mod links;
mod object_storage;
mod parameterization;
mod parts;
mod pyramid;
mod ranges;
mod replacement;
mod sample;
mod scratch;
mod shard;
#[cfg(test)]
mod tests;
mod verify;
mod volume;
mod volume_info;
mod well;

pub use candidates::{CandidateParts, CandidateWriter, StoredCandidates, surface_batches};
pub use error::StoreError;
pub use fault::{read_fault, write_fault};
pub use header::VERSION;
pub use horizon::{read_horizon, write_horizon};
pub use ingest::{Ingested, MEMORY_BYTES, resume_blocks, write_blocks, write_volume};
pub use layout::{ArrayLayout, BRICK};
pub use links::link_volume;
pub use parameterization::{
    ParameterizationVolumes, ParameterizationWriter, StoredParameterization, write_parameterization,
};
pub use parts::VolumeParts;
pub use ranges::IndexedRanges;
pub use replacement::{Replacement, replace_file};
pub use sample::StoredSample;
pub use scratch::FolderArrays;
pub use volume::StoredVolume;
pub use volume_info::VolumeInfo;
pub use well::{read_well, write_well};
