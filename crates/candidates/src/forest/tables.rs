//! Conversion of a forest to the tables of the store and back.

use super::{Forest, Node, check, check_corners, check_ranges};
use crate::error::InterpError;
use crate::surfaces::{Extremum, Surface, Surfaces, Vertex};
use std::ops::Range;
use survey::candidates::{ForestCounts, ForestTables};

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
        surfaces.surfaces = tables.surfaces.into_iter().map(surface_of).collect::<Result<_, _>>()?;
        check(&surfaces)?;
        let mut forest = Self { surfaces, ..Self::default() };
        let triangles = forest.surfaces.triangles.len() as u32;
        let reached = forest.read_nodes(tables.nodes, forest.surfaces.surfaces.len(), triangles)?;
        if forest.roots.len() != forest.surfaces.surfaces.len() || reached != triangles {
            return damaged("there are not as many trees as surfaces");
        }
        Ok(forest)
    }

    /// Checks what [`Forest::from_tables`] does of tables that may be larger than memory: `read` is asked for triangles, some
    /// at a time.
    ///
    /// # Errors
    /// As [`Forest::from_tables`], and those of `read`.
    pub fn check_tables<E: From<InterpError>>(
        counts: ForestCounts,
        surfaces: Vec<[u32; 5]>,
        nodes: Vec<[u32; 6]>,
        mut read: impl FnMut(Range<usize>) -> Result<Vec<[u32; 3]>, E>,
    ) -> Result<(), E> {
        /// Triangles that are read at a time, about.
        const TOGETHER: usize = 1 << 20;
        let damaged = |fact| E::from(InterpError::DamagedForest { fact });
        let surfaces = surfaces.into_iter().map(surface_of).collect::<Result<Vec<_>, _>>()?;
        check_ranges(&surfaces, counts.vertices, counts.triangles)?;
        let mut forest = Self::default();
        let triangles = u32::try_from(counts.triangles).map_err(|_| damaged("it has too many triangles"))?;
        let reached = forest.read_nodes(nodes, surfaces.len(), triangles)?;
        if forest.roots.len() != surfaces.len() || reached != triangles {
            return Err(damaged("there are not as many trees as surfaces"));
        }
        drop(forest);
        let (mut held, mut first) = (Vec::new(), 0);
        for (surface, part) in surfaces.iter().enumerate() {
            let mut own = part.triangles.start as usize..part.triangles.end as usize;
            while !own.is_empty() {
                if own.start >= first + held.len() {
                    first = own.start;
                    held = read(first..(first + TOGETHER).min(counts.triangles))?;
                }
                let here = own.start..own.end.min(first + held.len());
                if here.is_empty() {
                    return Err(damaged("there are fewer triangles than it states"));
                }
                check_corners(surface, part, &held[here.start - first..here.end - first])?;
                own.start = here.end;
            }
        }
        Ok(())
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

/// A surface out of its row.
fn surface_of([kind, first_vertex, end_vertex, first, end]: [u32; 5]) -> Result<Surface, InterpError> {
    let fact = "a surface is of no known kind";
    let extremum = *KINDS.get(kind as usize).ok_or(InterpError::DamagedForest { fact })?;
    Ok(Surface { extremum, vertices: first_vertex..end_vertex, triangles: first..end })
}
