//! How a horizon was assembled: its log of picks, in the order they were made.
//!
//! The horizon's sheets are primary data. The log tells how they were made, and it is what is needed to move
//! a pick later or to make the same picks again on another extraction. Places are line numbers and vertical
//! values, so that they can be read and typed.

use interp::assembly::{Fingerprint, Operation};
use interp::holes::FillSettings;
use serde::{Deserialize, Serialize};
use ttf::Colour;

/// The log of a horizon.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Assembly {
    /// Colour it is shown in.
    pub colour: Colour,
    /// How its holes are filled; absent: they stay.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub fill: Option<FillSettings>,
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
    /// Whether its node is part of the horizon or is taken out of it.
    #[serde(default)]
    pub operation: Operation,
    /// Leaf at that place.
    pub leaf: u32,
    /// Levels climbed above it.
    pub up: u32,
    /// Key of the extraction that leaf and levels are of.
    pub extraction: String,
    /// What the node was.
    pub node: Fingerprint,
}

/// A fault that is being drawn: sticks as they were picked. With two or more sticks there is a fault of that
/// name.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct FaultSticks {
    /// Name of the fault.
    pub fault: String,
    /// Sticks, each a list of inline, crossline, vertical value.
    pub sticks: Vec<Vec<[f64; 3]>>,
}
