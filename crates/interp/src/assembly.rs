//! Assembly of horizons from the nodes of surface trees (P-horiz 5.3): pick a voxel, climb, add or take away.
//!
//! - A **pick** starts at the leaf closest to a place ([`leaf_at`]) and climbs from there, by levels or to the highest node that does not lie
//!   twice over a trace ([`highest_valid`]).
//! - A **horizon** is what its picks, in order, put into and take out of a [`Selection`] of triangles. It depends on the list of picks alone, so
//!   that any of them can be moved up or down its tree later.
//! - An **overlap** is a trace that has two vertices in one fault block: no horizon does, so something was merged that should not be. Without
//!   interpreted faults there is one block, and the two sides of a reverse fault overlap rightly; hence overlaps are told, not refused.
//! - A [`Fingerprint`] remembers what a node was; a replay on another extraction compares.
//! - [`conflicts`] says where horizons contradict one another.
//!
//! P-horiz leaves the choice of the level to the user, who sees wrong overlaps by their shadows. `highest_valid` sees them by counting.
//! Space: voxels.

mod climb;
mod conflicts;
mod error;
mod fingerprint;
mod nearest;
mod occupancy;
mod selection;
#[cfg(test)]
pub(crate) mod tests;

pub use climb::{ClimbSettings, Climbed, highest_valid, node_above};
pub use conflicts::{Conflict, ConflictSettings, NamedSheets, conflicts};
pub use error::AssemblyError;
pub use fingerprint::{Fingerprint, Fit};
pub use nearest::{Hit, leaf_at};
pub use occupancy::{Occupancy, Overlap};
pub use selection::Selection;

use crate::forest::Forest;
use serde::{Deserialize, Serialize};

/// What a pick does to its horizon.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Operation {
    /// Its node becomes part of the horizon.
    #[default]
    Add,
    /// Its node is taken out of the horizon.
    Remove,
}

/// The triangles that a list of picks leaves selected.
pub fn assemble(forest: &Forest, picks: impl IntoIterator<Item = (u32, Operation)>) -> Selection {
    let mut selection = Selection::default();
    for (node, operation) in picks {
        let range = forest.nodes[node as usize].triangles.clone();
        match operation {
            Operation::Add => selection.insert(range),
            Operation::Remove => selection.remove(&range),
        }
    }
    selection
}

/// Ids of the leaves that a selection holds, ascending.
pub fn selected_leaves(forest: &Forest, selection: &Selection) -> Vec<u32> {
    let leaves = (1u32..).zip(&forest.leaves);
    let held = leaves.filter(|(_, node)| selection.contains(forest.nodes[**node as usize].triangles.start));
    held.map(|(id, _)| id).collect()
}

/// Id of the leaf that owns a triangle.
pub(crate) fn leaf_of(forest: &Forest, triangle: u32) -> u32 {
    forest.leaves.partition_point(|&node| forest.nodes[node as usize].triangles.start <= triangle) as u32
}
