//! Results that are computed from a project and stored beside it, so that nothing is computed twice and nothing
//! outdated is used.
//!
//! ```text
//! derived/blocks-KEY.bin          the faults continued through the volume, and the blocks between them
//! derived/found-faults-KEY.bin    the faults that are found in the volume
//! derived/grids-KEY.bin           the parameterization as lookups use it (one grid per layer and fault block)
//! derived/parameterization.zarr   the same sampled on a lattice: i, j, k, layer, block, for other programs; its key inside
//! ```
//!
//! A key is the BLAKE3 hash of everything the result depends on: the revision of the method ([`revision`]), the survey
//! geometry, the hashes of the faults, for the parameterization those of the horizons and their contacts, and the
//! settings. A file with another key is not read. Undoing a change therefore finds the earlier result again, as long as
//! it is among the last few that are stored. Everything here may be deleted, and a result that cannot be stored (the
//! disk is full, the project is read-only) is used all the same.

mod blocks;
mod file;
mod found;
mod grids;
pub mod revision;
mod scratch;

pub(crate) use blocks::blocks_key;
pub use blocks::{FaultBlocks, keep_blocks, load_blocks};
pub(crate) use found::FINDING_BYTES;
pub use found::FoundFaults;
pub use grids::{holds_volumes, keep_grids, load_grids, volumes_path};
pub(crate) use grids::{keep_volumes, load_volumes, model_key, parameterization_key, voxels_of};

pub(crate) use file::verify_kept;
pub(crate) use scratch::{RESUMABLE, Scratch, abandoned, remove_finished, remove_leftovers, remove_resumable};

use serde::Serialize;

/// The key of a result that is computed from `inputs`, which hold numbers and strings only: these always serialise.
pub(crate) fn key_of(inputs: &impl Serialize) -> String {
    hash_of(inputs).to_hex()[..32].to_owned()
}

/// The same as a number, never 0.
pub(crate) fn number_of(inputs: &impl Serialize) -> u64 {
    let [a, b, c, d, e, f, g, h, ..] = *hash_of(inputs).as_bytes();
    u64::from_le_bytes([a, b, c, d, e, f, g, h]) | 1
}

fn hash_of(inputs: &impl Serialize) -> blake3::Hash {
    blake3::hash(&serde_json::to_vec(inputs).unwrap_or_default())
}
