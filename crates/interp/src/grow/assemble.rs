//! From labelled extrema to [`Surfaces`]: the triangles of the cells whose corners share a label.
//!
//! A closed cell of four corners makes two triangles, split along the diagonal that is less steep; three corners make one. The
//! order of surfaces, vertices and triangles follows from the extrema alone.

use super::links::{Links, NONE};
use crate::extrema::Extrema;
use crate::surfaces::{Surface, Surfaces, Vertex};
use rayon::prelude::*;

/// The surfaces of one kind.
pub(super) fn surfaces(extrema: &Extrema, links: &Links, labels: &[u32]) -> Surfaces {
    let [nx, ny, _] = extrema.size;
    let triangles: Vec<Vec<[u32; 3]>> =
        (0..nx).into_par_iter().map(|x| triangles_of_inline(extrema, links, labels, x)).collect();
    let mut used = vec![false; extrema.len()];
    for &corner in triangles.iter().flatten().flatten() {
        used[corner as usize] = true;
    }
    // Surfaces in the order of their first vertex.
    let mut rank = vec![NONE; extrema.len()];
    let mut counts: Vec<[u32; 2]> = Vec::new();
    for v in (0..extrema.len()).filter(|&v| used[v]) {
        let label = labels[v] as usize;
        if rank[label] == NONE {
            rank[label] = counts.len() as u32;
            counts.push([0, 0]);
        }
        counts[rank[label] as usize][0] += 1;
    }
    let surface_of = |v: u32| rank[labels[v as usize] as usize] as usize;
    for triangle in triangles.iter().flatten() {
        counts[surface_of(triangle[0])][1] += 1;
    }
    let mut reached = [0u32; 2];
    let mut listed = Vec::with_capacity(counts.len());
    let mut next = Vec::with_capacity(counts.len());
    for [vertices, faces] in counts {
        next.push(reached);
        listed.push(Surface {
            extremum: extrema.kind,
            vertices: reached[0]..reached[0] + vertices,
            triangles: reached[1]..reached[1] + faces,
        });
        reached = [reached[0] + vertices, reached[1] + faces];
    }
    let mut vertices = vec![Vertex { x: 0, y: 0, z: 0.0 }; reached[0] as usize];
    let mut place = vec![NONE; extrema.len()];
    for x in 0..nx {
        for y in 0..ny {
            for v in extrema.on_trace(x, y).filter(|&v| used[v]) {
                let at = &mut next[surface_of(v as u32)][0];
                vertices[*at as usize] = Vertex { x: x as u16, y: y as u16, z: extrema.z[v] };
                place[v] = *at;
                *at += 1;
            }
        }
    }
    let mut ordered = vec![[0u32; 3]; reached[1] as usize];
    for triangle in triangles.iter().flatten() {
        let at = &mut next[surface_of(triangle[0])][1];
        ordered[*at as usize] = triangle.map(|corner| place[corner as usize]);
        *at += 1;
    }
    Surfaces { size: extrema.size, vertices, triangles: ordered, surfaces: listed }
}

/// The triangles of the cells whose first corner lies on inline x.
fn triangles_of_inline(extrema: &Extrema, links: &Links, labels: &[u32], x: usize) -> Vec<[u32; 3]> {
    let mut triangles = Vec::new();
    for a in extrema.on_inline(x) {
        let a = a as u32;
        let Some([a, b, c, d]) = links.closed(a) else { continue };
        let label = |v: u32| labels[v as usize];
        let corners = [a, b, d, c];
        // The label that most corners have.
        let Some(most) = corners
            .iter()
            .map(|&v| label(v))
            .find(|&l| l != NONE && corners.iter().filter(|&&v| label(v) == l).count() >= 3)
        else {
            continue;
        };
        let steep = |v: u32, w: u32| (extrema.z[v as usize] - extrema.z[w as usize]).abs();
        if let Some(odd) = corners.iter().position(|&v| label(v) != most) {
            triangles.push([1, 2, 3].map(|step| corners[(odd + step) % 4]));
        } else if steep(a, d) <= steep(b, c) {
            triangles.extend([[a, b, d], [a, d, c]]);
        } else {
            triangles.extend([[a, b, c], [b, d, c]]);
        }
    }
    triangles
}

/// Surfaces of several kinds in one list, by their first vertex (ties: in the order given).
pub(super) fn joined(size: [usize; 3], parts: &[Surfaces]) -> Surfaces {
    let mut order: Vec<(usize, usize)> =
        parts.iter().enumerate().flat_map(|(kind, part)| (0..part.surfaces.len()).map(move |s| (kind, s))).collect();
    let first = |&(kind, surface): &(usize, usize)| {
        let part: &Surfaces = &parts[kind];
        let v = part.vertices[part.surfaces[surface].vertices.start as usize];
        (v.x, v.y, v.z)
    };
    order.sort_by(|a, b| {
        let (a, b) = (first(a), first(b));
        (a.0, a.1).cmp(&(b.0, b.1)).then(a.2.total_cmp(&b.2))
    });
    let mut all = Surfaces {
        size,
        vertices: Vec::with_capacity(parts.iter().map(|p| p.vertices.len()).sum()),
        triangles: Vec::with_capacity(parts.iter().map(|p| p.triangles.len()).sum()),
        surfaces: Vec::with_capacity(order.len()),
    };
    for (kind, surface) in order {
        let part = &parts[kind];
        let surface = &part.surfaces[surface];
        let (vertices, triangles) = (all.vertices.len() as u32, all.triangles.len() as u32);
        let range = |r: &std::ops::Range<u32>| r.start as usize..r.end as usize;
        all.vertices.extend_from_slice(&part.vertices[range(&surface.vertices)]);
        let moved = |corner: u32| corner - surface.vertices.start + vertices;
        all.triangles.extend(part.triangles[range(&surface.triangles)].iter().map(|t| t.map(moved)));
        all.surfaces.push(Surface {
            extremum: surface.extremum,
            vertices: vertices..all.vertices.len() as u32,
            triangles: triangles..all.triangles.len() as u32,
        });
    }
    all
}
