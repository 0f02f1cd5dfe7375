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
