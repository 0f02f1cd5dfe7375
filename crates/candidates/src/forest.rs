//! Surface trees (P-horiz 4): each grown surface is cut into a binary hierarchy of ever flatter parts.
//!
//! The method is hierarchical face clustering (M. Attene, B. Falcidieno, M. Spagnuolo, "Hierarchical mesh
//! segmentation based on fitting primitives", The Visual Computer 22, 2006) with planes as the only
//! primitive: neighbouring parts whose union is flattest are merged first, until one is left. The cost of a
//! union S is its un-normalised squared distance to its best-fit plane and a tie-break,
//!
//! ```text
//! cost(S) = min over planes ∫_S d² dA + 1e-12 · area(S),
//! ```
//!
//! and the first term is the smallest eigenvalue of the central second moment of S (see `moments`).
//!
//! **Departure: no priority queue.** No plane fits a larger set better, so cost(S ∪ T) ≥ cost(S), and the
//! cost of joining A ∪ B with C is never below the lesser of those of joining A or B with C. For such
//! (reducible) costs, merging any two parts that are each other's cheapest neighbour makes the same tree as
//! the greedy order of the queue, in whatever order it is done. So we follow chains of cheapest neighbours
//! (`cluster`). Parts of one large surface can then be merged on several threads, and the tree depends
//! neither on the threads nor on the order.
//!
//! **Departure: the start.** Clustering starts from the connected triangles of small square tiles
//! ([`ForestSettings::start_cells`]) instead of single triangles; a leaf contains some sixty of these. A test
//! compares the total cost of the leaves with that of trees from single triangles.
//!
//! Trees are pruned to leaves of [`ForestSettings::min_leaf_triangles`] (`prune`). Triangles are ordered so
//! that every node of a tree owns one contiguous range: a node is its range, and its parent is a wider range.
//! Space: voxels.

mod cluster;
mod dual;
mod level;
mod moments;
pub(crate) mod prune;
mod subdivision;
mod tables;
#[cfg(test)]
pub(crate) mod tests;

use crate::error::InterpError;
use crate::surfaces::{Surface, Surfaces, Vertex};
use prune::PrunedTree;
use rayon::prelude::*;
use serde::{Deserialize, Serialize};
use std::ops::Range;
use survey::{Cancelled, Progress};

pub use subdivision::Subtree;

/// Largest count of triangles of a forest: the distance search uses two bits of a leaf id for itself.
pub(crate) const MAX_TRIANGLES: usize = (1 << 30) - 1;

/// Settings of surface trees.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct ForestSettings {
    /// Least count of triangles of a leaf; a surface with fewer is a single leaf. Default 500, as in the
    /// paper.
    pub min_leaf_triangles: u32,
    /// Edge of the square tiles whose connected triangles start as one part, in cells of the lattice. 0
    /// starts from single triangles, as the paper does, and takes six times as long. Default 2: eight
    /// triangles.
    pub start_cells: u16,
}

impl Default for ForestSettings {
    fn default() -> Self {
        Self { min_leaf_triangles: 500, start_cells: 2 }
    }
}

/// A node of a surface tree: a part of a surface.
#[derive(Debug, Clone, PartialEq)]
pub struct Node {
    /// The node of which it is one half; `None` for a whole surface.
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
/// A leaf is a *candidate*, the smallest part that can be picked. Leaf ids are unique in the volume and count
/// from 1 in the order of the triangles; 0 means no leaf. The same surfaces make the same forest on any
/// number of threads.
///
/// # Examples
///
/// ```
/// use candidates::{Extremum, Forest, ForestSettings, Surface, Surfaces, Vertex};
/// use survey::Progress;
///
/// // A plane at sample 5 over 9 × 17 traces, two triangles a cell: 2 · 8 · 16 = 256.
/// let vertices = (0..9 * 17).map(|n| Vertex { x: n / 17, y: n % 17, z: 5.0 }).collect();
/// let cells = (0..8u32).flat_map(|x| (0..16).map(move |y| x * 17 + y));
/// let triangles: Vec<_> = cells.flat_map(|v| [[v, v + 17, v + 1], [v + 1, v + 17, v + 18]]).collect();
/// let plane = Surface { extremum: Extremum::Peak, vertices: 0..153, triangles: 0..256 };
/// let surfaces = Surfaces { size: [9, 17, 10], vertices, triangles, surfaces: vec![plane] };
///
/// let settings = ForestSettings { min_leaf_triangles: 64, ..ForestSettings::default() };
/// let forest = Forest::build(surfaces, &settings, &Progress::silent())?;
/// // One binary tree: one node fewer between the leaves than there are leaves.
/// assert_eq!(forest.roots, [0]);
/// assert_eq!(forest.nodes.len(), 2 * forest.leaf_count() - 1);
/// assert_eq!(forest.nodes[0].triangles, 0..256);
/// assert!(forest.leaves.iter().all(|&leaf| forest.nodes[leaf as usize].triangles.len() >= 64));
/// # Ok::<(), candidates::InterpError>(())
/// ```
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Forest {
    /// The surfaces, with their triangles in the order of the leaves.
    pub surfaces: Surfaces,
    /// Nodes of all trees. Those of a tree are contiguous, each before its children.
    pub nodes: Vec<Node>,
    /// Root of each surface, an index into `nodes`.
    pub roots: Vec<u32>,
    /// Node of each leaf: `leaves[id − 1]` is an index into `nodes`.
    pub leaves: Vec<u32>,
}

impl Forest {
    /// Builds the trees of `surfaces` and puts the triangles into the order of the leaves.
    ///
    /// Cost: time and memory proportional to the triangles (about 40 bytes per triangle of the surfaces in
    /// work at the same time).
    ///
    /// # Errors
    /// [`InterpError::Setting`], [`InterpError::MalformedSurfaces`] when ranges or indices contradict each other,
    /// [`InterpError::TooManyTriangles`], [`InterpError::Cancelled`].
    pub fn build(mut surfaces: Surfaces, settings: &ForestSettings, progress: &Progress) -> Result<Self, InterpError> {
        check_settings(settings)?;
        check(&surfaces)?;
        progress.begin("building surface trees", surfaces.triangles.len() as u64);
        let Surfaces { vertices, triangles, surfaces: parts, .. } = &mut surfaces;
        // Largest first, so that the threads finish together.
        let mut jobs = jobs(triangles, parts.iter().map(|part| part.triangles.len()));
        jobs.sort_by_key(|job| (std::cmp::Reverse(job.1.len()), job.0));
        let mut trees = jobs
            .into_par_iter()
            .with_max_len(1)
            .map(|(surface, triangles)| {
                let tree = tree(vertices, triangles, settings, progress)?;
                progress.step(triangles.len() as u64)?;
                Ok((surface, tree))
            })
            .collect::<Result<Vec<_>, Cancelled>>()?;
        trees.sort_by_key(|(surface, _)| *surface);
        let mut forest = Self { surfaces, ..Self::default() };
        for (surface, tree) in trees {
            forest.plant(surface as u32, &tree);
        }
        Ok(forest)
    }

    /// Adds the tree of a surface.
    fn plant(&mut self, surface: u32, tree: &PrunedTree) {
        let (root, first) = (self.nodes.len() as u32, self.surfaces.surfaces[surface as usize].triangles.start);
        self.roots.push(root);
        for (n, node) in tree.nodes.iter().enumerate() {
            if node.children.is_none() {
                self.leaves.push(root + n as u32);
            }
            self.nodes.push(Node {
                parent: node.parent.map(|parent| root + parent),
                children: node.children.map(|children| children.map(|child| root + child)),
                surface,
                triangles: first + node.triangles.start..first + node.triangles.end,
            });
        }
    }

    /// Count of leaves, which is also the greatest leaf id.
    pub fn leaf_count(&self) -> usize {
        self.leaves.len()
    }

    /// Index of the node of a leaf.
    ///
    /// # Errors
    /// [`InterpError::NoSuchLeaf`].
    pub fn node_of_leaf(&self, leaf: u32) -> Result<u32, InterpError> {
        let index = (leaf as usize).wrapping_sub(1);
        self.leaves.get(index).copied().ok_or(InterpError::NoSuchLeaf { leaf, count: self.leaves.len() })
    }

    /// Ids of the leaves under a node. They are consecutive.
    pub fn leaves_under(&self, node: u32) -> Range<u32> {
        let range = &self.nodes[node as usize].triangles;
        let before =
            |end: u32| self.leaves.partition_point(|&leaf| self.nodes[leaf as usize].triangles.start < end) as u32 + 1;
        before(range.start)..before(range.end)
    }

    /// Id of the leaf that contains a triangle.
    #[inline]
    pub(crate) fn leaf_of_triangle(&self, triangle: u32) -> u32 {
        self.leaves.partition_point(|&leaf| self.nodes[leaf as usize].triangles.start <= triangle) as u32
    }

    /// Nodes from `node` up to its root, beginning with `node`.
    pub fn climb(&self, node: u32) -> impl Iterator<Item = u32> {
        std::iter::successors(Some(node), |&node| self.nodes[node as usize].parent)
    }

    /// Whether a node is a whole surface with fewer than `min_leaf_triangles` triangles.
    pub(crate) fn is_undersized(&self, node: u32, min_leaf_triangles: u32) -> bool {
        let node = &self.nodes[node as usize];
        node.parent.is_none() && (node.triangles.len() as u64) < u64::from(min_leaf_triangles)
    }
}

/// Checks the settings of trees.
pub(crate) fn check_settings(settings: &ForestSettings) -> Result<(), InterpError> {
    if settings.min_leaf_triangles == 0 {
        return Err(InterpError::Setting { setting: "min_leaf_triangles", value: 0.0, expected: "at least 1" });
    }
    Ok(())
}

/// The triangles of each surface, with its index.
fn jobs(mut triangles: &mut [[u32; 3]], counts: impl Iterator<Item = usize>) -> Vec<(usize, &mut [[u32; 3]])> {
    let mut jobs = Vec::new();
    for (surface, count) in counts.enumerate() {
        let (these, rest) = triangles.split_at_mut(count);
        jobs.push((surface, these));
        triangles = rest;
    }
    jobs
}

/// Builds the tree of one surface and puts its triangles into the order of its leaves.
pub(crate) fn tree(
    vertices: &[Vertex],
    triangles: &mut [[u32; 3]],
    settings: &ForestSettings,
    progress: &Progress,
) -> Result<PrunedTree, Cancelled> {
    if (triangles.len() as u64) < 2 * u64::from(settings.min_leaf_triangles) {
        return Ok(PrunedTree::leaf(triangles.len() as u32));
    }
    let patches = dual::patches(vertices, triangles, settings.start_cells);
    progress.check()?;
    let merges = cluster::cluster(&patches, progress)?;
    let tree = prune::prune(&patches, &merges, settings.min_leaf_triangles);
    let ordered: Vec<[u32; 3]> = tree.order.iter().map(|&triangle| triangles[triangle as usize]).collect();
    triangles.copy_from_slice(&ordered);
    Ok(tree)
}

/// Checks the ranges and indices on which everything else relies.
fn check(surfaces: &Surfaces) -> Result<(), InterpError> {
    let triangles = surfaces.triangles.len();
    if triangles > MAX_TRIANGLES {
        return Err(InterpError::TooManyTriangles { triangles, limit: MAX_TRIANGLES });
    }
    check_ranges(&surfaces.surfaces, surfaces.vertices.len(), triangles)?;
    for (surface, part) in surfaces.surfaces.iter().enumerate() {
        check_corners(surface, part, &surfaces.triangles[part.triangles.start as usize..part.triangles.end as usize])?;
    }
    Ok(())
}

/// Checks that surfaces follow one another and have all of so many vertices and triangles.
fn check_ranges(surfaces: &[Surface], vertices: usize, triangles: usize) -> Result<(), InterpError> {
    let (mut vertex, mut triangle) = (0, 0);
    for (surface, part) in surfaces.iter().enumerate() {
        let bad = |fact| Err(InterpError::MalformedSurfaces { surface, fact });
        if part.vertices.start != vertex || part.vertices.end < vertex {
            return bad("its vertices do not follow those of the surface before");
        }
        if part.triangles.start != triangle || part.triangles.end < triangle {
            return bad("its triangles do not follow those of the surface before");
        }
        (vertex, triangle) = (part.vertices.end, part.triangles.end);
        if vertex as usize > vertices || triangle as usize > triangles {
            return bad("it ends after the arrays do");
        }
    }
    if vertex as usize != vertices || triangle as usize != triangles {
        let fact = "vertices or triangles follow that belong to no surface";
        return Err(InterpError::MalformedSurfaces { surface: surfaces.len(), fact });
    }
    Ok(())
}

/// Checks that triangles have corners of their own surface.
fn check_corners(surface: usize, part: &Surface, own: &[[u32; 3]]) -> Result<(), InterpError> {
    if own.iter().flatten().any(|corner| !part.vertices.contains(corner)) {
        let fact = "a triangle has a corner that is not its own";
        return Err(InterpError::MalformedSurfaces { surface, fact });
    }
    Ok(())
}
