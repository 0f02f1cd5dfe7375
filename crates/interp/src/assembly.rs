//! Assembly of horizons from the nodes of surface trees (P-horiz 5.3): pick a voxel, climb the tree, add or
//! remove the node.
//!
//! - A **pick** starts at the leaf closest to a point ([`leaf_at`]) and climbs from there, by a count of
//!   levels or to the highest node that does not overlap itself ([`highest_valid`]).
//! - A **horizon** is the result of its picks, applied in order to a [`Selection`] of triangles. It depends
//!   only on the list of picks, so any of them can be moved up or down its tree later.
//! - An **overlap** is a trace that has two vertices in one fault block. No horizon has that, so an overlap
//!   means that surfaces were merged wrongly. Without interpreted faults there is only one block, and the two
//!   sides of a reverse fault overlap rightly. Therefore overlaps are reported and not refused.
//! - A [`Fingerprint`] records what a node was; a replay on another extraction compares nodes with it.
//! - [`conflicts()`] finds where horizons contradict one another.
//!
//! P-horiz leaves the choice of the level to the user, who recognises wrong overlaps by their shadows.
//! [`highest_valid`] counts them. Space: voxels.
//!
//! # Examples
//!
//! ```
//! use glam::Vec3;
//! use interp::assembly::{ClimbSettings, Operation, Selection, assemble, highest_valid, leaf_at};
//! use interp::{Extremum, Forest, ForestSettings, Surface, Surfaces, Vertex};
//! use survey::Progress;
//! use model::FaultNetwork;
//!
//! // A plane at sample 5 over 9 × 17 traces, 256 triangles, in leaves of at least 64.
//! let vertices = (0..9 * 17).map(|n| Vertex { x: n / 17, y: n % 17, z: 5.0 }).collect();
//! let cells = (0..8u32).flat_map(|x| (0..16).map(move |y| x * 17 + y));
//! let triangles: Vec<_> = cells.flat_map(|v| [[v, v + 17, v + 1], [v + 1, v + 17, v + 18]]).collect();
//! let plane = Surface { extremum: Extremum::Peak, vertices: 0..153, triangles: 0..256 };
//! let surfaces = Surfaces { size: [9, 17, 10], vertices, triangles, surfaces: vec![plane] };
//! let settings = ForestSettings { min_leaf_triangles: 64, ..ForestSettings::default() };
//! let forest = Forest::build(surfaces, &settings, &Progress::silent())?;
//!
//! // A pick 0.5 samples below the plane finds a leaf; nothing overlaps, so the climb ends at the root.
//! let hit = leaf_at(&forest, Vec3::new(3.0, 8.0, 5.5), 2.0)?;
//! assert!((hit.distance - 0.5).abs() < 1e-5);
//! let (none, blocks) = (Selection::default(), FaultNetwork::none());
//! let climbed = highest_valid(&forest, hit.leaf, &none, &blocks, &ClimbSettings::default());
//! assert_eq!((climbed.node, climbed.stopped_by), (forest.roots[0], None));
//!
//! // Adding the whole plane and removing the leaf leaves the rest.
//! let leaf = forest.node_of_leaf(hit.leaf)?;
//! let left = assemble(&forest, [(climbed.node, Operation::Add), (leaf, Operation::Remove)]);
//! assert_eq!(left.len(), 256 - forest.nodes[leaf as usize].triangles.len());
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod climb;
mod conflicts;
mod error;
mod fingerprint;
mod nearest;
mod occupancy;
mod selection;
#[cfg(test)]
mod tests;

pub use climb::{ClimbSettings, Climbed, highest_valid, node_above};
pub use conflicts::{Conflict, ConflictSettings, NamedSheets, conflicts};
pub use error::AssemblyError;
pub use fingerprint::{Fingerprint, NodeFit};
pub use nearest::{ClosestLeaf, leaf_at};
pub use occupancy::{Occupancy, Overlap};
pub use selection::Selection;

use crate::forest::Forest;
use serde::{Deserialize, Serialize};

/// The effect of a pick on its horizon.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Operation {
    /// The node is added to the horizon.
    #[default]
    Add,
    /// The node is removed from the horizon.
    Remove,
}

/// The triangles that are selected after a list of picks (node and operation), applied in order.
///
/// # Panics
/// When the forest has no such node.
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

/// Ids of the leaves whose triangles are selected, ascending.
pub fn selected_leaves(forest: &Forest, selection: &Selection) -> Vec<u32> {
    let leaves = (1u32..).zip(&forest.leaves);
    let selected = leaves.filter(|(_, node)| selection.contains(forest.nodes[**node as usize].triangles.start));
    selected.map(|(id, _)| id).collect()
}

/// Id of the leaf that contains a triangle.
pub(crate) fn leaf_of(forest: &Forest, triangle: u32) -> u32 {
    forest.leaves.partition_point(|&node| forest.nodes[node as usize].triangles.start <= triangle) as u32
}
