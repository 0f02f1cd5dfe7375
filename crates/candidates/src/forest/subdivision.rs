//! Cutting a leaf further, for an interpreter who wants less than a leaf.

use super::{Forest, ForestSettings, Node, tree};
use crate::error::InterpError;
use survey::Progress;

/// The tree inside a leaf. The same forest, leaf and size always give the same tree.
#[derive(Debug, Clone, PartialEq)]
pub struct Subtree {
    /// Id of the leaf.
    pub leaf: u32,
    /// Its triangles (indices of [`Surfaces::triangles`](crate::Surfaces::triangles)), in the order of the
    /// parts.
    pub triangles: Vec<u32>,
    /// Nodes, the leaf first, each before its children. `parent` and `children` are indices of this list;
    /// ranges are those of [`Subtree::triangles`].
    pub nodes: Vec<Node>,
}

impl Forest {
    /// Cuts a leaf into parts of at least `min_triangles`, starting from its single triangles.
    ///
    /// # Errors
    /// [`InterpError::NoSuchLeaf`], [`InterpError::Setting`] when `min_triangles` is 0.
    pub fn split(&self, leaf: u32, min_triangles: u32) -> Result<Subtree, InterpError> {
        if min_triangles == 0 {
            return Err(InterpError::Setting { setting: "min_triangles", value: 0.0, expected: "at least 1" });
        }
        let node = &self.nodes[self.node_of_leaf(leaf)? as usize];
        let range = node.triangles.start as usize..node.triangles.end as usize;
        let mut triangles = self.surfaces.triangles[range].to_vec();
        let settings = ForestSettings { min_leaf_triangles: min_triangles, start_cells: 0 };
        let pruned = tree(&self.surfaces.vertices, &mut triangles, &settings, &Progress::silent())?;
        let nodes = pruned.nodes.into_iter().map(|part| Node {
            parent: part.parent,
            children: part.children,
            surface: node.surface,
            triangles: part.triangles,
        });
        let order = match pruned.order.is_empty() {
            true => (node.triangles.start..node.triangles.end).collect(),
            false => pruned.order.iter().map(|&n| node.triangles.start + n).collect(),
        };
        Ok(Subtree { leaf, triangles: order, nodes: nodes.collect() })
    }
}
