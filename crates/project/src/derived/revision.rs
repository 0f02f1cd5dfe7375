//! Revisions of the methods that compute derived data. They are part of every key, so that a result of an
//! earlier method is not mistaken for one of the present method.
//!
//! Whoever changes a method so that its results change raises its revision. A test compares a fingerprint of a small
//! result of each method with its revision, and fails when one changes without the other.

/// The structural model: fault blocks, extension of horizons, contacts.
pub(crate) const MODEL: u32 = 4;

/// The parameterization.
pub(crate) const PARAMETERIZATION: u32 = 9;

/// Horizon candidates: extrema, growing, surface trees, distances.
pub(crate) const EXTRACTION: u32 = 2;

/// Proposed faults.
pub const PROPOSALS: u32 = 2;

/// Faults found in the volume.
pub(crate) const FOUND_FAULTS: u32 = 2;

#[cfg(test)]
mod tests;
