//! How a horizon was assembled: its log of picks, in the order they were made.
//!
//! The horizon's sheets are primary data. The log records how they were made; with it a pick can be moved later, or the
//! same picks repeated on another extraction. Places are line numbers and vertical values, so that they can be read and
//! typed.

use super::Document;
use interp::assembly::{Fingerprint, Operation};
use interp::holes::FillSettings;
use interp::refine::{SmoothSettings, TrackSettings};
use serde::{Deserialize, Serialize};
use ttf::Colour;

/// The log of a horizon.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Assembly {
    /// Colour it is shown in.
    pub colour: Colour,
    /// How its holes are filled; `None`: they stay.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub fill: Option<FillSettings>,
    /// How it is smoothed after that; `None`: it is as picked.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub smooth: Option<SmoothSettings>,
    /// Its picks, first to last.
    pub picks: Vec<PickEntry>,
    /// What was drawn or tracked of it without candidates, first to last.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub drawn: Vec<DrawnEntry>,
}

impl Assembly {
    /// The numbers of its picks and of what was drawn.
    pub(crate) fn numbers(&self) -> impl Iterator<Item = u32> {
        self.picks.iter().map(|pick| pick.id).chain(self.drawn.iter().map(|drawn| drawn.id))
    }
}

impl Document {
    /// A number that no pick has yet, and nothing that was drawn.
    pub(crate) fn next_pick_id(&self) -> u32 {
        let logs = self.horizons.iter().filter_map(|entry| entry.assembly.as_ref());
        logs.flat_map(Assembly::numbers).max().unwrap_or(0) + 1
    }
}

/// A part of a horizon that was drawn or tracked.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct DrawnEntry {
    /// Unique in the project, among picks too.
    pub id: u32,
    /// What was done.
    pub part: Drawn,
}

/// What is added to a horizon where there is no candidate. Places are inline, crossline, vertical value.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case", deny_unknown_fields)]
pub enum Drawn {
    /// A line, with a node on each trace that it crosses, in place of what was there.
    Line {
        /// Its corners.
        points: Vec<[f64; 3]>,
        /// Whether its nodes are laid on the nearest peak or trough.
        #[serde(default)]
        snap: bool,
    },
    /// The reflection at a place, as far as it can be followed, where there is nothing yet.
    Tracked {
        /// The place.
        at: [f64; 3],
        /// How far.
        #[serde(default)]
        window: TrackSettings,
    },
}

impl Drawn {
    /// The first place of it.
    pub fn place(&self) -> [f64; 3] {
        match self {
            Self::Line { points, .. } => points.first().copied().unwrap_or_default(),
            Self::Tracked { at, .. } => *at,
        }
    }

    /// What it is: a line, or tracked.
    pub fn noun(&self) -> &'static str {
        match self {
            Self::Line { .. } => "line",
            Self::Tracked { .. } => "tracking",
        }
    }
}

/// One pick.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct PickEntry {
    /// Unique in the project.
    pub id: u32,
    /// Inline, crossline and vertical value of the place picked.
    pub at: [f64; 3],
    /// Whether its node is added to the horizon or removed from it.
    #[serde(default)]
    pub operation: Operation,
    /// The leaf at that place.
    pub leaf: u32,
    /// Levels climbed above it.
    pub up: u32,
    /// Key of the extraction that leaf and levels refer to.
    pub extraction: String,
    /// A fingerprint of the node.
    pub node: Fingerprint,
}

/// A fault that is drawn as sticks. From two sticks on there is a fault of that name.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct FaultSticks {
    /// Name of the fault.
    pub fault: String,
    /// Sticks, each a list of inline, crossline, vertical value.
    pub sticks: Vec<Vec<[f64; 3]>>,
}
