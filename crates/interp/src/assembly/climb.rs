//! Climbing a tree: by a count of levels, or to the highest node that is still a single sheet.

use super::error::AssemblyError;
use super::occupancy::{Occupancy, Overlap};
use super::selection::Selection;
use crate::forest::Forest;
use model::FaultNetwork;

/// Limits of a climb.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ClimbSettings {
    /// Share of a node's vertices that may lie over others of the node in one fault block. Noise makes a few,
    /// where a front passes above or below an error and meets itself again; a reflector merged with another
    /// overlaps by far more. Default 0.02.
    pub tolerated_share: f64,
    /// Share of a node's vertices that may lie over the selected triangles. Where a fault is not interpreted,
    /// or not exactly where it is, the two sides of a reverse fault lie over one another in a strip; another
    /// reflector lies over all of it. Default 0.1.
    pub tolerated_beside: f64,
}

impl Default for ClimbSettings {
    fn default() -> Self {
        Self { tolerated_share: 0.02, tolerated_beside: 0.1 }
    }
}

/// The end of a climb.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Climbed {
    /// Index of the highest node reached.
    pub node: u32,
    /// Its level above the leaf.
    pub up: u32,
    /// Overlap that the next higher node would add, which ended the climb; `None` at the root.
    pub stopped_by: Option<Overlap>,
}

/// The node `up` levels above a leaf.
///
/// # Errors
/// [`AssemblyError::NoLeaf`] and [`AssemblyError::BeyondRoot`].
pub fn node_above(forest: &Forest, leaf: u32, up: u32) -> Result<u32, AssemblyError> {
    let place = (leaf as usize).checked_sub(1).and_then(|place| forest.leaves.get(place));
    let mut node = *place.ok_or(AssemblyError::NoLeaf { leaf, leaves: forest.leaves.len() })?;
    for levels in 0..up {
        node = forest.nodes[node as usize].parent.ok_or(AssemblyError::BeyondRoot { leaf, levels, up })?;
    }
    Ok(node)
}

/// The highest node above `leaf` that lies at most once over each trace of a fault block, both by itself and
/// together with the `selected` triangles, within the limits of `settings`. The leaf itself if its parent
/// already overlaps too much.
///
/// An overlap only grows on the way up, so the first node with too much of it ends the climb. Cost: the
/// triangles of that node.
///
/// # Panics
/// When the forest has no leaf of this id.
pub fn highest_valid(
    forest: &Forest,
    leaf: u32,
    selected: &Selection,
    blocks: &FaultNetwork,
    settings: &ClimbSettings,
) -> Climbed {
    let mut occupancy = Occupancy::new(&forest.surfaces, blocks);
    for range in selected.ranges() {
        occupancy.add(range.clone());
    }
    // The overlap of the selection with itself is not the node's.
    let before = (occupancy.vertices(), occupancy.overlap());
    occupancy.set_apart();
    let mut node = forest.leaves[leaf as usize - 1];
    let mut added = forest.nodes[node as usize].triangles.clone();
    occupancy.add(added.clone());
    let mut up = 0;
    while let Some(parent) = forest.nodes[node as usize].parent {
        let wider = forest.nodes[parent as usize].triangles.clone();
        occupancy.add(wider.start..added.start);
        occupancy.add(added.end..wider.end);
        let overlap = occupancy.overlap();
        let vertices = (occupancy.vertices() - before.0) as f64;
        let beside = overlap.beside - before.1.beside;
        let traces = overlap.traces - before.1.traces;
        let itself = (traces - beside) as f64;
        if itself > settings.tolerated_share * vertices || beside as f64 > settings.tolerated_beside * vertices {
            return Climbed { node, up, stopped_by: Some(Overlap { traces, beside, ..overlap }) };
        }
        (node, added, up) = (parent, wider, up + 1);
    }
    Climbed { node, up, stopped_by: None }
}
