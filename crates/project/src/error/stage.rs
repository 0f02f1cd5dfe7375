//! Why a block cannot be shown at a stage of its geological history.

use super::ProjectError;

/// Why there is no block at a stage.
#[derive(Debug, thiserror::Error)]
pub enum StageError {
    /// A project without a geological history.
    #[error("the project was not made from a geological history, so that it has no stages")]
    NoHistory,
    /// A stage before the first event or after the last.
    #[error(
        "there is no stage {asked}: the history has {events} events, so that stages lie above 0 and up to {events}"
    )]
    Beyond {
        /// What was asked for.
        asked: f64,
        /// How many events there are.
        events: usize,
    },
    /// A stage at which there is no rock in the block.
    #[error("at stage {stage} there is no rock in the block yet")]
    Bare {
        /// The stage.
        stage: f64,
    },
    /// A stage that cannot be made.
    #[error("the block at stage {stage} ({event}) cannot be made: {source}")]
    Block {
        /// The stage.
        stage: f64,
        /// The event that is under way or has just happened.
        event: String,
        /// Why.
        source: Box<ProjectError>,
    },
}

impl StageError {
    pub(super) fn advice(&self) -> Option<&'static str> {
        match self {
            Self::NoHistory => {
                Some("make a block from a text of events: `petroglyph create BLOCK.petro --history FILE.toml`")
            }
            Self::Beyond { .. } => Some("stage 2 is the block after its second event, 2.5 after half of the third"),
            Self::Bare { .. } => Some("ask for a later stage"),
            Self::Block { source, .. } => source.advice(),
        }
    }
}
