//! The bulk data of a project: reads volumes, horizons, faults and wells by the project's entries, and computes the
//! hashes that identify them.

mod hash;
mod read;
pub(crate) mod volume_facts;

pub use hash::hash_fault;
pub(crate) use hash::{hash_horizon, hash_parameterization, hash_stored, hash_well};
pub(crate) use read::hash_file;
pub use read::{fault_triangles, open_recorded, open_volume, read_fault, read_horizon, read_well};
pub(crate) use read::{read_level, read_parameterization, read_volume, texture_path};
