//! Revisions of what computes derived data, part of every key: a result of an earlier method is not taken for one of today's.
//!
//! Whoever changes a method so that its results change raises its revision. A test holds a fingerprint of a small result of each
//! method beside its revision, and fails when one changes without the other.

/// The structural model: fault blocks, extension of horizons, contacts.
pub const MODEL: u32 = 1;

/// The parameterization.
pub const PARAMETERIZATION: u32 = 1;

/// Horizon candidates: extrema, growing, surface trees, distances.
pub const EXTRACTION: u32 = 1;

/// Proposed faults.
pub const PROPOSALS: u32 = 1;
