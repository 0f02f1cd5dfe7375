//! Conversion of a forest to the tables of the store and back.

use super::{Forest, Node, check};
use crate::error::InterpError;
use crate::surfaces::{Extremum, Surface, Surfaces, Vertex};
use survey::candidates::ForestTables;

/// Stands for "none" in a table.
const NONE: u32 = u32::MAX;

/// Kinds of extremum by their number in a table.
const KINDS: [Extremum; 3] = [Extremum::Peak, Extremum::Trough, Extremum::Zero];

impl Forest {
    /// The forest as tables.
    pub fn tables(&self) -> ForestTables {
        let Surfaces { vertices, triangles, surfaces, .. } = &self.surfaces;
        let kind = |extremum| match extremum {
            Extremum::Peak => 0,
            Extremum::Trough => 1,
            Extremum::Zero => 2,
        };
        ForestTables {
            trace: vertices.iter().map(|v| [v.x, v.y]).collect(),
            z: vertices.iter().map(|v| v.z).collect(),
            triangles: triangles.clone(),
            surfaces: surfaces
                .iter()
                .map(|part| {
                    let Surface { extremum, vertices, triangles } = part;
                    [kind(*extremum), vertices.start, vertices.end, triangles.start, triangles.end]
                })
                .collect(),
            nodes: self
                .nodes
                .iter()
                .map(|node| {
                    let [a, b] = node.children.unwrap_or([NONE; 2]);
                    [node.parent.unwrap_or(NONE), a, b, node.surface, node.triangles.start, node.triangles.end]
                })
                .collect(),
        }
    }

    /// The forest that tables describe, in a volume of `size`.
    ///
    /// # Errors
    /// [`InterpError::DamagedForest`] or [`InterpError::MalformedSurfaces`] when they contradict each other.
    pub fn from_tables(tables: ForestTables, size: [usize; 3]) -> Result<Self, InterpError> {
        let damaged = |fact| Err(InterpError::DamagedForest { fact });
        if tables.trace.len() != tables.z.len() {
            return damaged("vertices have not as many traces as depths");
        }
        let vertices = tables.trace.iter().zip(&tables.z).map(|(&[x, y], &z)| Vertex { x, y, z }).collect();
        let mut surfaces = Surfaces { size, vertices, triangles: tables.triangles, surfaces: Vec::new() };
        for [kind, first_vertex, end_vertex, first, end] in tables.surfaces {
            let Some(&extremum) = KINDS.get(kind as usize) else { return damaged("a surface is of no known kind") };
            surfaces.surfaces.push(Surface { extremum, vertices: first_vertex..end_vertex, triangles: first..end });
        }
        check(&surfaces)?;
        let mut forest = Self { surfaces, ..Self::default() };
        let triangles = forest.surfaces.triangles.len() as u32;
        let reached = forest.read_nodes(tables.nodes, forest.surfaces.surfaces.len(), triangles)?;
        if forest.roots.len() != forest.surfaces.surfaces.len() || reached != triangles {
            return damaged("there are not as many trees as surfaces");
        }
        Ok(forest)
    }

    /// The trees that rows of nodes describe, without vertices and triangles: enough to climb, and to tell
    /// leaves.
    ///
    /// # Errors
    /// [`InterpError::DamagedForest`] when they contradict each other.
    pub fn of_nodes(nodes: Vec<[u32; 6]>) -> Result<Self, InterpError> {
        let mut forest = Self::default();
        forest.read_nodes(nodes, usize::MAX, u32::MAX)?;
        Ok(forest)
    }

    /// Takes rows of nodes; answers the end of the last leaf's triangles.
    fn read_nodes(&mut self, nodes: Vec<[u32; 6]>, surfaces: usize, triangles: u32) -> Result<u32, InterpError> {
        let damaged = |fact| Err(InterpError::DamagedForest { fact });
        let count = nodes.len() as u32;
        for (index, [parent, a, b, surface, first, end]) in nodes.into_iter().enumerate() {
            let index = index as u32;
            let below = |child: u32| child > index && child < count;
            let leaf = a == NONE && b == NONE;
            if !(leaf || below(a) && below(b)) || !(parent == NONE || parent < index) {
                return damaged("a node stands before its parent");
            }
            if surface as usize >= surfaces || first > end || end > triangles {
                return damaged("a node has triangles that are not there");
            }
            if parent == NONE {
                self.roots.push(index);
            }
            if leaf {
                self.leaves.push(index);
            }
            self.nodes.push(Node {
                parent: (parent != NONE).then_some(parent),
                children: (!leaf).then_some([a, b]),
                surface,
                triangles: first..end,
            });
        }
        let mut reached = 0;
        for &leaf in &self.leaves {
            let range = &self.nodes[leaf as usize].triangles;
            if range.start != reached {
                return damaged("leaves do not follow one another");
            }
            reached = range.end;
        }
        Ok(reached)
    }
}
