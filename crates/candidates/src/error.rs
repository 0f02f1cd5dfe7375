//! Errors of an extraction.

use survey::Cancelled;
use survey::source::SourceError;

/// Why an extraction failed.
#[derive(Debug, thiserror::Error)]
pub enum InterpError {
    /// The user cancelled.
    #[error(transparent)]
    Cancelled(#[from] Cancelled),
    /// The arrays of a set of surfaces contradict each other.
    #[error("surface {surface} is malformed: {fact}; grow the surfaces again")]
    MalformedSurfaces {
        /// Index of the surface.
        surface: usize,
        /// What is wrong.
        fact: &'static str,
    },
    /// There are more triangles than 32-bit ids can number.
    #[error("{triangles} triangles are more than the {limit} that can be numbered; extract a part of the volume")]
    TooManyTriangles {
        /// Count of triangles found.
        triangles: usize,
        /// Largest count that can be numbered.
        limit: usize,
    },
    /// The forest has no leaf of this id.
    #[error("there is no leaf {leaf}; leaves are numbered from 1 to {count}")]
    NoSuchLeaf {
        /// The requested id.
        leaf: u32,
        /// Count of leaves.
        count: usize,
    },
    /// Surfaces could not be grown.
    #[error(transparent)]
    Growing(Box<dyn std::error::Error + Send + Sync>),
    /// The volume could not be read.
    #[error("the volume could not be read: {0}")]
    Source(#[source] SourceError),
    /// An array that stages exchange could not be read or written.
    #[error(transparent)]
    Arrays(SourceError),
    /// An array that stages exchange does not hold what was written.
    #[error("the intermediate array {array} is damaged; remove it and all others, and extract again")]
    DamagedArray {
        /// Name of the array.
        array: String,
    },
    /// The method cannot be done in bricks.
    #[error(
        "the published method depends on the order of its seeds and needs the volume in one piece; grow by `ours`, or give more memory"
    )]
    WholeOnly,
    /// Another program is at the same work.
    #[error("another program extracts the same candidates at the moment; wait until it has finished")]
    DoneElsewhere,
    /// The stated memory is too small for a single brick.
    #[error("{stated} bytes of memory are too few for bricks of {samples} samples a trace; state at least {least}")]
    TooLittleMemory {
        /// Bytes stated.
        stated: u64,
        /// Samples of a trace.
        samples: usize,
        /// Bytes needed.
        least: u64,
    },
    /// Candidates could not be handed over.
    #[error(transparent)]
    Sink(SourceError),
    /// Stored trees contradict each other.
    #[error("the stored surface trees are damaged: {fact}; delete them and extract again")]
    DamagedForest {
        /// What is wrong.
        fact: &'static str,
    },
    /// A setting is out of its range.
    #[error("{setting} is {value}; it must be {expected}")]
    Setting {
        /// Name of the setting.
        setting: &'static str,
        /// Value of the setting.
        value: f64,
        /// Range of the setting.
        expected: &'static str,
    },
}
