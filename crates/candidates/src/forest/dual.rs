//! The dual graph of a surface, and the small parts from which clustering starts.
//!
//! Triangles that share an edge are neighbours. An edge of more than two triangles (of a surface that
//! branches) joins each of them with the next. Parts are the connected triangles within square tiles of the
//! lattice, so two sheets of one surface over the same tile are two parts.

use super::moments::Moments;
use crate::surfaces::Vertex;

/// Parts of a surface and their neighbours.
pub(crate) struct Patches {
    /// Part of each triangle.
    pub(crate) of_triangle: Vec<u32>,
    /// Triangles of each part.
    pub(crate) counts: Vec<u32>,
    /// Moments of each part.
    pub(crate) moments: Vec<Moments>,
    /// Neighbours of part p: `neighbours[starts[p]..starts[p + 1]]`, ascending.
    pub(crate) starts: Vec<u32>,
    /// See `starts`.
    pub(crate) neighbours: Vec<u32>,
}

impl Patches {
    pub(crate) fn len(&self) -> usize {
        self.counts.len()
    }

    #[inline]
    pub(crate) fn neighbours_of(&self, patch: u32) -> &[u32] {
        &self.neighbours[self.starts[patch as usize] as usize..self.starts[patch as usize + 1] as usize]
    }
}

/// Cuts a surface into parts of at most `cells` × `cells` cells, or into single triangles when `cells` is 0.
pub(crate) fn patches(vertices: &[Vertex], triangles: &[[u32; 3]], cells: u16) -> Patches {
    let edges = dual_edges(triangles);
    let of_triangle = match cells {
        0 => (0..triangles.len() as u32).collect(),
        cells => connected_in_tiles(vertices, triangles, &edges, cells),
    };
    let count = of_triangle.iter().max().map_or(0, |&last| last as usize + 1);
    let (mut counts, mut moments) = (vec![0u32; count], vec![Moments::EMPTY; count]);
    for (triangle, &patch) in triangles.iter().zip(&of_triangle) {
        let corners = triangle.map(|v| {
            let v = vertices[v as usize];
            [f64::from(v.x), f64::from(v.y), f64::from(v.z)]
        });
        let patch = patch as usize;
        moments[patch] = moments[patch].union(&Moments::of_triangle(corners));
        counts[patch] += 1;
    }
    let across = edges.iter().map(|edge| edge.map(|t| of_triangle[t as usize])).filter(|[a, b]| a != b);
    let (starts, neighbours) = adjacency(count, across);
    Patches { of_triangle, counts, moments, starts, neighbours }
}

/// Pairs of triangles that share an edge.
fn dual_edges(triangles: &[[u32; 3]]) -> Vec<[u32; 2]> {
    let first = triangles.iter().flatten().copied().min().unwrap_or(0);
    let count = triangles.iter().flatten().max().map_or(0, |&last| (last - first) as usize + 1);
    let edges = |t: &[u32; 3]| [[t[0], t[1]], [t[1], t[2]], [t[2], t[0]]].map(|[a, b]| [a.min(b), a.max(b)]);
    // Edges by their lower vertex, as (higher vertex, triangle).
    let mut starts = vec![0u32; count + 1];
    for edge in triangles.iter().flat_map(edges) {
        starts[(edge[0] - first) as usize + 1] += 1;
    }
    for n in 0..count {
        starts[n + 1] += starts[n];
    }
    let mut ends = starts.clone();
    let mut entries = vec![[0u32; 2]; 3 * triangles.len()];
    for (index, triangle) in triangles.iter().enumerate() {
        for [low, high] in edges(triangle) {
            let at = &mut ends[(low - first) as usize];
            entries[*at as usize] = [high, index as u32];
            *at += 1;
        }
    }
    let mut pairs = Vec::with_capacity(3 * triangles.len() / 2);
    for n in 0..count {
        let around = &mut entries[starts[n] as usize..starts[n + 1] as usize];
        around.sort_unstable();
        for two in around.windows(2) {
            if two[0][0] == two[1][0] && two[0][1] != two[1][1] {
                pairs.push([two[0][1], two[1][1]]);
            }
        }
    }
    pairs
}

/// Part of each triangle; parts are numbered by their first triangle.
fn connected_in_tiles(vertices: &[Vertex], triangles: &[[u32; 3]], edges: &[[u32; 2]], cells: u16) -> Vec<u32> {
    let tile = |triangle: &[u32; 3]| {
        let corners = triangle.map(|v| vertices[v as usize]);
        let low = |axis: fn(&Vertex) -> u16| {
            let [a, b, c] = corners.each_ref().map(axis);
            a.min(b).min(c) / cells
        };
        (u32::from(low(|v| v.x)) << 16) | u32::from(low(|v| v.y))
    };
    let tiles: Vec<u32> = triangles.iter().map(tile).collect();
    let mut parent: Vec<u32> = (0..triangles.len() as u32).collect();
    for &[a, b] in edges {
        if tiles[a as usize] == tiles[b as usize] {
            join(&mut parent, a, b);
        }
    }
    // The root is the least triangle of its set, so it comes first.
    let mut count = 0;
    for triangle in 0..parent.len() {
        let root = parent[triangle] as usize;
        if root == triangle {
            // From here on, the entry of the root is the number of the part.
            parent[triangle] = count;
            count += 1;
        } else {
            parent[triangle] = parent[root];
        }
    }
    parent
}

/// Root of an element, with path halving.
#[inline]
pub(crate) fn find(parent: &mut [u32], mut element: u32) -> u32 {
    while parent[element as usize] != element {
        let above = parent[parent[element as usize] as usize];
        parent[element as usize] = above;
        element = above;
    }
    element
}

/// Joins two sets under the lesser root.
fn join(parent: &mut [u32], a: u32, b: u32) {
    let (a, b) = (find(parent, a), find(parent, b));
    parent[a.max(b) as usize] = a.min(b);
}

/// Lists of neighbours, ascending and without repetition.
fn adjacency(count: usize, pairs: impl Iterator<Item = [u32; 2]> + Clone) -> (Vec<u32>, Vec<u32>) {
    let mut starts = vec![0u32; count + 1];
    for [a, b] in pairs.clone() {
        starts[a as usize + 1] += 1;
        starts[b as usize + 1] += 1;
    }
    for n in 0..count {
        starts[n + 1] += starts[n];
    }
    let mut ends = starts.clone();
    let mut neighbours = vec![0u32; starts[count] as usize];
    for [a, b] in pairs {
        for [from, to] in [[a, b], [b, a]] {
            neighbours[ends[from as usize] as usize] = to;
            ends[from as usize] += 1;
        }
    }
    let mut kept = 0;
    for n in 0..count {
        let (start, end) = (starts[n] as usize, ends[n] as usize);
        neighbours[start..end].sort_unstable();
        starts[n] = kept;
        for at in start..end {
            if at == start || neighbours[at] != neighbours[kept as usize - 1] {
                neighbours[kept as usize] = neighbours[at];
                kept += 1;
            }
        }
    }
    starts[count] = kept;
    neighbours.truncate(kept as usize);
    (starts, neighbours)
}
