//! How a horizon was assembled: its log of picks, in the order they were made.
//!
//! The horizon's sheets are primary data. The log records how they were made; with it a pick can be moved later, or the
//! same picks repeated on another extraction. Places are line numbers and vertical values, so that they can be read and
//! typed.

use interp::assembly::{Fingerprint, Operation};
use interp::holes::FillSettings;
use refine::SmoothSettings;
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
