//! What can go wrong while an attribute is computed.

use survey::progress::Cancelled;

/// Why an attribute could not be computed.
#[derive(Debug, thiserror::Error)]
pub enum AttributeError {
    /// A setting outside its range.
    #[error("{name} is {found}; choose a value from {least} to {most}")]
    Setting {
        /// Which setting.
        name: &'static str,
        /// What was asked for.
        found: usize,
        /// Smallest that makes sense.
        least: usize,
        /// Largest that makes sense.
        most: usize,
    },
    /// Two volumes that should lie on one lattice do not.
    #[error(
        "the dips lie on a lattice of {found:?} and the volume on one of {expected:?}; compute the dips from this volume"
    )]
    Lattice {
        /// Size of the volume.
        expected: [usize; 3],
        /// Size of the dips.
        found: [usize; 3],
    },
    /// Stopped by the user.
    #[error(transparent)]
    Cancelled(#[from] Cancelled),
}

/// Refuses a setting outside `least ..= most`.
pub(super) fn check(name: &'static str, found: usize, least: usize, most: usize) -> Result<(), AttributeError> {
    if (least..=most).contains(&found) { Ok(()) } else { Err(AttributeError::Setting { name, found, least, most }) }
}
