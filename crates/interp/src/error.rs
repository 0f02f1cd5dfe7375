//! What can stand against an extraction or an assembly.

use survey::Cancelled;
use survey::source::SourceError;

/// A failure of this crate.
#[derive(Debug, thiserror::Error)]
pub enum Error {
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
    /// More triangles than ids of 32 bits can name.
    #[error("{triangles} triangles are more than the {limit} this program can number; extract a part of the volume")]
    TooManyTriangles {
        /// Triangles found.
        triangles: usize,
        /// Most that can be numbered.
        limit: usize,
    },
    /// A leaf was asked for that the forest does not have.
    #[error("there is no leaf {leaf}; leaves are numbered from 1 to {count}")]
    NoSuchLeaf {
        /// Id asked for.
        leaf: u32,
        /// Leaves there are.
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
    /// A setting that means nothing.
    #[error("{setting} = {value} cannot be; it must be {expected}")]
    Setting {
        /// Its name.
        setting: &'static str,
        /// What was given.
        value: f64,
        /// What can be given.
        expected: &'static str,
    },
}
