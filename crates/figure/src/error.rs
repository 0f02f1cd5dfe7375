//! Why there is no figure.

use page::PageError;
use render::RenderError;

/// Why there is no figure.
#[derive(Debug, thiserror::Error)]
pub enum FigureError {
    /// The page could not be drawn or written.
    #[error(transparent)]
    Page(#[from] PageError),
    /// A page with no room for what is to be on it.
    #[error(
        "there is no room for {what} on a page of {:.1} x {:.1} cm; make the page larger, or leave legend and scale bar out",
        size_cm[0], size_cm[1]
    )]
    NoRoom {
        /// What does not fit.
        what: &'static str,
        /// Width and height, cm.
        size_cm: [f64; 2],
    },
    /// A figure of nothing, or of more parts than a page takes.
    #[error("a figure has one to four parts, this one has {found}")]
    Parts {
        /// How many it has.
        found: usize,
    },
    /// A section beside the survey.
    #[error("{what} {asked} lies outside the survey, which has {what} {first} to {last}")]
    Outside {
        /// "inline", "crossline" or the name of the vertical axis.
        what: &'static str,
        /// What was asked for.
        asked: f64,
        /// The survey's first line or value.
        first: f64,
        /// Its last.
        last: f64,
    },
    /// A fence with fewer than two corners apart from one another.
    #[error("a fence runs along a line of two corners or more that lie apart; this one has {corners}")]
    ShortFence {
        /// Corners that lie apart.
        corners: usize,
    },
    /// A map of a horizon that is not there, or whose horizons are in the wrong order.
    #[error("there is no map of {what}")]
    NoMap {
        /// What was asked for, in words.
        what: String,
    },
    /// A profile of a fault that is not there.
    #[error(
        "there is no fault named \"{fault}\"{}",
        if known.is_empty() { "; there are none".to_owned() } else { format!("; the faults are {}", known.join(", ")) }
    )]
    NoFault {
        /// The name that was asked for.
        fault: String,
        /// The names that there are.
        known: Vec<String>,
    },
    /// A profile of a fault without throws.
    #[error("there is no profile of {fault}: no horizon meets it from both sides where it was drawn")]
    NoThrow {
        /// The fault.
        fault: String,
    },
    /// Wells side by side of a project that has none.
    #[error("a correlation panel shows wells, and the project has none; add them with `petroglyph well add`")]
    NoWells,
    /// A well that is not there.
    #[error("there is no well named \"{well}\"; the wells are {}", known.join(", "))]
    NoWell {
        /// The name that was asked for.
        well: String,
        /// The names that there are.
        known: Vec<String>,
    },
    /// A well that does not reach the surface which is to be level.
    #[error(
        "well \"{well}\" does not meet {datum}, which is to be level; take another datum or leave the well out ({})",
        if tops.is_empty() { "it has no tops".to_owned() } else { format!("its tops: {}", tops.join(", ")) }
    )]
    NoDatum {
        /// The well.
        well: String,
        /// The surface.
        datum: String,
        /// The tops of the well.
        tops: Vec<String>,
    },
    /// A curve that no well has.
    #[error(
        "no well has a curve named \"{log}\"{}",
        if known.is_empty() { "; the wells have no curves".to_owned() } else { format!("; there are {}", known.join(", ")) }
    )]
    NoLog {
        /// The curve.
        log: String,
        /// The curves that there are.
        known: Vec<String>,
    },
    /// An axis without length.
    #[error("the axis of a correlation panel runs from a smaller to a larger value, not from {from} to {to}")]
    NoRange {
        /// Where it was to begin.
        from: f64,
        /// Where it was to end.
        to: f64,
    },
    /// An interpreter's view without an interpretation.
    #[error("the figure shows what an interpreter sees, but no interpretation was given")]
    NoInterpretation,
    /// The block could not be drawn.
    #[error(transparent)]
    Render(#[from] RenderError),
    /// A pattern could not be drawn.
    #[error(transparent)]
    Pattern(#[from] ttf::TtfError),
}
