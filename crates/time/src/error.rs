//! Errors of geologic time.

use survey::Cancelled;

/// Why geologic time could not be computed.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum TimeError {
    /// The user cancelled.
    #[error(transparent)]
    Cancelled(#[from] Cancelled),
    /// Candidates and amplitudes are not of the same volume.
    #[error("the candidates are those of a volume of {candidates:?} samples, not of {volume:?}; extract again")]
    Size {
        /// `[inlines, crosslines, samples]` of the candidates.
        candidates: [usize; 3],
        /// `[inlines, crosslines, samples]` of the volume.
        volume: [usize; 3],
    },
    /// It does not fit into memory.
    #[error(transparent)]
    Memory(#[from] system::memory::NotEnough),
}
