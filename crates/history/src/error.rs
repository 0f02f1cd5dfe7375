//! What is wrong with the text of a history, where, and what is meant.

use crate::names::offered;

/// Why a text tells no history. Every message names the line.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[error("line {line}: {problem}")]
pub struct HistoryError {
    /// Line of the text, counted from 1.
    pub line: usize,
    /// What is wrong there.
    pub problem: Problem,
}

/// What is wrong with a line of a history.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum Problem {
    /// The text is not TOML.
    #[error("the text cannot be read as TOML: {said}")]
    Syntax {
        /// What the reader said.
        said: String,
    },
    /// Something necessary is missing.
    #[error("{of} needs `{key}`, {meaning}")]
    Missing {
        /// What it is missing of.
        of: String,
        /// The key.
        key: &'static str,
        /// What the key states.
        meaning: &'static str,
    },
    /// A key that the kind of event has not.
    #[error("{of} has no `{found}`; {}", offered(.alike, "its keys", .keys))]
    UnknownKey {
        /// What has no such key.
        of: String,
        /// The key that was found.
        found: String,
        /// Keys that are like it.
        alike: Vec<String>,
        /// All keys.
        keys: Vec<String>,
    },
    /// A word that is none of those that may stand there.
    #[error("{what} cannot be \"{found}\"; {}", offered(.alike, "it may be", .known))]
    UnknownWord {
        /// What the word states.
        what: String,
        /// The word.
        found: String,
        /// Words that are like it.
        alike: Vec<String>,
        /// All words.
        known: Vec<String>,
    },
    /// A name that no rock has.
    #[error("no rock is called \"{found}\"; {}", offered(.alike, "names are those of the", &["CGI vocabulary".to_owned()]))]
    UnknownRock {
        /// The name.
        found: String,
        /// Rocks whose names are like it.
        alike: Vec<String>,
    },
    /// A value of another type.
    #[error("`{key}` is {wanted}, found {found}")]
    Type {
        /// The key.
        key: String,
        /// What it is.
        wanted: &'static str,
        /// What was found.
        found: String,
    },
    /// A number outside of what makes sense.
    #[error("`{key}` = {found} {why}")]
    Range {
        /// The key.
        key: String,
        /// The number.
        found: f64,
        /// Which numbers it may be, and why.
        why: String,
    },
    /// Two things with one name.
    #[error("\"{name}\" is also the name of {other} at line {first}; give one of them another `name`")]
    SameName {
        /// The name.
        name: String,
        /// What has it already.
        other: &'static str,
        /// Where.
        first: usize,
    },
    /// Two keys that say the same.
    #[error("`{one}` and `{other}` state the same; leave one of them out")]
    Twice {
        /// One key.
        one: &'static str,
        /// The other.
        other: &'static str,
    },
    /// No events.
    #[error("a history needs events: begin with [[events]], kind = \"beds\"")]
    NoEvents,
    /// More events than are followed.
    #[error("{found} events are more than a history may have, {most}")]
    TooManyEvents {
        /// Count of events.
        found: usize,
        /// The most.
        most: usize,
    },
    /// More of something than is followed.
    #[error("{found} {what} are more than a history may have, {most}")]
    TooMany {
        /// What.
        what: &'static str,
        /// How many were found.
        found: usize,
        /// The most.
        most: usize,
    },
    /// The first event lays down no rock.
    #[error("the oldest event is {found}, but there is no rock yet: begin with kind = \"beds\"")]
    NoRock {
        /// The kind of the first event.
        found: &'static str,
    },
    /// A bed that is not there in the end, or never was.
    #[error("the bed \"{name}\" is nowhere in the block: {why}")]
    Vanished {
        /// Name of the bed.
        name: String,
        /// What took it away, and what to change.
        why: String,
    },
    /// Slip beyond the block.
    #[error(
        "a slip of {slip_m:.0} m is larger than the block, which is {block_m:.0} m across: nothing of one side would be \
         left beside the other; state a smaller slip or a larger `size`"
    )]
    SlipBeyondBlock {
        /// The slip.
        slip_m: f64,
        /// The longest edge of the block.
        block_m: f64,
    },
    /// A fold whose beds would cross themselves.
    #[error(
        "the fold is tighter than its beds allow: at its hinges the radius is {radius_m:.0} m, and the beds that stay \
         parallel lie up to {reach_m:.0} m from its middle, where they would cross themselves; state a smaller \
         `amplitude`, a longer `wavelength`, `zone = [top, base]` with fewer beds, or leave out `style`"
    )]
    TooTight {
        /// The smallest radius of curvature.
        radius_m: f64,
        /// How far beds lie from the surface that is bent.
        reach_m: f64,
    },
    /// Numbers that do not fit together.
    #[error("{said}")]
    Unfit {
        /// What does not fit, and what to change.
        said: String,
    },
}

impl Problem {
    /// At a line.
    pub(crate) fn at(self, line: usize) -> HistoryError {
        HistoryError { line, problem: self }
    }
}
