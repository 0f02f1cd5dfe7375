//! Surface trees (P-horiz 4): each grown surface cut into a binary hierarchy of ever flatter parts.
//!
//! Triangles are ordered so that every node of a tree owns one contiguous range: a node is its range, climbing widens it.

use crate::surfaces::Surfaces;
use std::ops::Range;

/// A part of a surface.
#[derive(Debug, Clone, PartialEq)]
pub struct Node {
    /// The node it is half of; `None` for a whole surface.
    pub parent: Option<u32>,
    /// Its two halves; `None` for a leaf.
    pub children: Option<[u32; 2]>,
    /// Index of its surface in [`Surfaces::surfaces`].
    pub surface: u32,
    /// Its triangles, as a range of [`Surfaces::triangles`].
    pub triangles: Range<u32>,
}

/// The trees of all surfaces of an extraction.
///
/// Leaf ids are unique over the volume and count from 1 in the order of the triangles; 0 means no leaf.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Forest {
    /// The surfaces, their triangles in the order of the leaves.
    pub surfaces: Surfaces,
    /// Nodes of all trees.
    pub nodes: Vec<Node>,
    /// Root of each surface: index into `nodes`.
    pub roots: Vec<u32>,
    /// Node of each leaf: `leaves[id − 1]` is an index into `nodes`.
    pub leaves: Vec<u32>,
}
