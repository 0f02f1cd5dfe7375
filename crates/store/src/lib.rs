//! The store: volumes, horizons, faults and parameterizations on disk, in Zarr v3 that other programs open too.
//!
//! ```text
//! volumes/NAME.zarr               write_volume, write_blocks, resume_blocks, StoredVolume
//! horizons/NAME.zarr              write_horizon, read_horizon
//! faults/NAME.json                write_fault, read_fault
//! wells/NAME.json                 write_well, read_well
//! derived/parameterization.zarr   write_parameterization, StoredParameterization
//! derived/candidates.zarr         CandidateWriter, StoredCandidates
//! ```
//!
//! Everything is written under another name beside its place, synced and renamed at the very end ([`Replacement`]): a
//! crash, a cancelled write or a full disk leaves what was there before.
//!
//! Volumes that do not fit into memory come from whoever implements [`survey::source::BlockSource`], candidates through
//! [`survey::candidates::CandidateSink`]; neither is known here by name. The array library (zarrs) is known to `array`
//! and `sample` alone, and to no other crate.
//!
//! Deliberately absent: files of other programs, what a project is, any computation on what is stored but pyramids and
//! their ranges.

mod array;
mod candidates;
mod error;
mod fault;
mod header;
mod horizon;
mod ingest;
mod layout;
mod parameterization;
mod pyramid;
mod ranges;
mod replacement;
mod sample;
mod shard;
#[cfg(test)]
mod tests;
mod volume;
mod volume_info;
mod well;

pub use array::{ArrayWriter, StoredArray, read_group, write_array, write_group};
pub use candidates::{CandidateWriter, StoredCandidates};
pub use error::StoreError;
pub use fault::{read_fault, write_fault};
pub use header::VERSION;
pub use horizon::{read_horizon, write_horizon};
pub use ingest::{Ingested, MEMORY_BYTES, resume_blocks, write_blocks, write_volume};
pub use layout::{BRICK, Layout};
pub use parameterization::{NO_ID, ParameterizationVolumes, StoredParameterization, write_parameterization};
pub use replacement::{Replacement, replace_file};
pub use sample::StoredSample;
pub use volume::StoredVolume;
pub use volume_info::VolumeInfo;
pub use well::{read_well, write_well};
