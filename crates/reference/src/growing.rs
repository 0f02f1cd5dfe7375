//! The paper's method of growing (P-horiz 4): fronts from every extremum in turn.
//!
//! The surface of a seed grows border by border. The next border is every extremum that has not been visited
//! yet, lies on one of the eight traces around a point of the current border, and touches it: its sample is
//! at most one away. A border falls into pieces of points that touch one another, and a piece narrower than
//! `min_front_width` ends there; its points stay visited. "Voxels are visited only once to avoid intersecting
//! and overlapping surfaces", so the result depends on the order of seeds: here that of memory, by x, then y,
//! then z. The borders are triangulated with those before them: every cell of four neighbouring traces whose
//! corners belong to the two borders and touch makes its triangles.
//!
//! The paper leaves two questions open. How large is the first border? (Here: the seed and its ring
//! together.) Is touching judged by samples or by refined depths? (Here: by refined depths, 1.5 samples, so
//! that a reflector that rises by one sample and a little more is not torn.) Steeper reflectors fall apart,
//! as they do in the paper.

#[cfg(test)]
mod tests;

use candidates::grow::{Grow, as_set};
use candidates::{Extrema, GrowSettings, Method, Surface, Surfaces, Vertex};
use rayon::prelude::*;
use survey::{Cancelled, Progress};

/// No place among the members of a surface.
const NONE: u32 = u32::MAX;

/// Greatest difference in depth of extrema that touch, samples.
const TOUCH: f32 = 1.5;

/// The extrema of one kind, and which of them have been visited.
struct Fronts<'e> {
    extrema: &'e Extrema,
    /// Trace of each extremum.
    trace: Vec<u32>,
    /// The border in which each extremum was reached, counted over all surfaces; 0: not visited.
    border: Vec<u32>,
}

impl Fronts<'_> {
    /// Calls `found` for every extremum of the traces around `v` that touches it.
    fn around(&self, v: u32, mut found: impl FnMut(u32)) {
        let [nx, ny, _] = self.extrema.size;
        let trace = self.trace[v as usize] as usize;
        let (x, y) = (trace / ny, trace % ny);
        let z = self.extrema.z[v as usize];
        for nearby_x in x.saturating_sub(1)..(x + 2).min(nx) {
            for nearby_y in y.saturating_sub(1)..(y + 2).min(ny) {
                if (nearby_x, nearby_y) == (x, y) {
                    continue;
                }
                if let Some(other) = self.touching(nearby_x, nearby_y, z) {
                    found(other);
                }
            }
        }
    }

    /// The extremum of the trace at (x, y) closest to depth z, if it touches.
    fn touching(&self, x: usize, y: usize, z: f32) -> Option<u32> {
        let range = self.extrema.on_trace(x, y);
        let depths = &self.extrema.z[range.clone()];
        let below = depths.partition_point(|&d| d < z);
        [below.checked_sub(1), Some(below)]
            .into_iter()
            .flatten()
            .filter(|&at| at < depths.len() && (depths[at] - z).abs() <= TOUCH)
            .min_by(|&a, &b| (depths[a] - z).abs().total_cmp(&(depths[b] - z).abs()))
            .map(|at| (range.start + at) as u32)
    }
}

/// The function of a method, the published one or ours.
pub fn method(method: Method) -> Grow {
    match method {
        Method::Ours => as_set,
        Method::Paper => grow,
    }
}

/// Grows the surfaces of all kinds, each by itself.
///
/// # Errors
/// [`Cancelled`] by the user.
pub fn grow(extrema: &[Extrema], settings: &GrowSettings, progress: &Progress) -> Result<Surfaces, Cancelled> {
    let of_kind = |extrema: &Extrema| grow_kind(extrema, settings.min_front_width, progress);
    let grown: Vec<Surfaces> = extrema.par_iter().map(of_kind).collect::<Result<_, _>>()?;
    progress.check()?;
    Ok(joined(&grown))
}

/// Grows the surfaces of one kind.
fn grow_kind(extrema: &Extrema, min_front_width: usize, progress: &Progress) -> Result<Surfaces, Cancelled> {
    let [nx, ny, _] = extrema.size;
    let mut fronts = Fronts { extrema, trace: Vec::with_capacity(extrema.len()), border: vec![0; extrema.len()] };
    for x in 0..nx {
        for y in 0..ny {
            fronts.trace.extend(extrema.on_trace(x, y).map(|_| (x * ny + y) as u32));
        }
    }
    let mut found = Surfaces { size: extrema.size, ..Surfaces::default() };
    let mut borders = 0;
    for x in 0..nx {
        progress.check()?;
        for seed in extrema.on_inline(x) {
            if fronts.border[seed] == 0 {
                grow_from(&mut fronts, seed as u32, min_front_width, &mut borders, &mut found);
            }
        }
    }
    Ok(found)
}

/// Grows the surface of one seed and adds it to `found` if it has triangles.
fn grow_from(fronts: &mut Fronts, seed: u32, width: usize, borders: &mut u32, found: &mut Surfaces) {
    *borders += 1;
    fronts.border[seed as usize] = *borders;
    let mut members = vec![seed];
    let mut current = vec![seed];
    let mut is_seed = true;
    while !current.is_empty() {
        *borders += 1;
        let mut next = Vec::new();
        for &v in &current {
            let mut reached = Vec::new();
            fronts.around(v, |other| reached.push(other));
            for other in reached {
                if fronts.border[other as usize] == 0 {
                    fronts.border[other as usize] = *borders;
                    next.push(other);
                }
            }
        }
        let pieces = pieces(fronts, &next, *borders);
        current = pieces.into_iter().filter(|piece| piece.len() + usize::from(is_seed) >= width).flatten().collect();
        current.sort_unstable();
        members.extend_from_slice(&current);
        is_seed = false;
    }
    if members.len() >= 3 {
        triangulate(fronts, members, found);
    }
}

/// The pieces of a border: sets of points that touch one another within the border.
fn pieces(fronts: &Fronts, border: &[u32], number: u32) -> Vec<Vec<u32>> {
    let mut order: Vec<u32> = border.to_vec();
    order.sort_unstable();
    let mut taken = vec![false; order.len()];
    let mut found = Vec::new();
    for first in 0..order.len() {
        if taken[first] {
            continue;
        }
        taken[first] = true;
        let mut piece = vec![order[first]];
        let mut reached = 0;
        while reached < piece.len() {
            fronts.around(piece[reached], |other| {
                if fronts.border[other as usize] == number
                    && let Ok(at) = order.binary_search(&other)
                    && !taken[at]
                {
                    taken[at] = true;
                    piece.push(other);
                }
            });
            reached += 1;
        }
        found.push(piece);
    }
    found
}

/// Triangulates the cells between the members of a surface. The corners of a cell belong to at most three
/// consecutive borders; two borders of one surface meet only where one grew from the other.
fn triangulate(fronts: &Fronts, mut members: Vec<u32>, found: &mut Surfaces) {
    let [nx, ny, _] = fronts.extrema.size;
    members.sort_unstable();
    let place = |v: u32| members.binary_search(&v).map_or(NONE, |at| at as u32);
    let mut triangles = Vec::new();
    let mut used = vec![false; members.len()];
    for &a in &members {
        let trace = fronts.trace[a as usize] as usize;
        let (x, y) = (trace / ny, trace % ny);
        if x + 1 >= nx || y + 1 >= ny {
            continue;
        }
        let z = fronts.extrema.z[a as usize];
        let corner = |x: usize, y: usize, z: f32| {
            fronts
                .touching(x, y, z)
                .filter(|&v| place(v) != NONE && fronts.border[v as usize].abs_diff(fronts.border[a as usize]) <= 2)
        };
        let (b, c) = (corner(x + 1, y, z), corner(x, y + 1, z));
        let d = b
            .and_then(|b| corner(x + 1, y + 1, fronts.extrema.z[b as usize]))
            .or_else(|| c.and_then(|c| corner(x + 1, y + 1, fronts.extrema.z[c as usize])));
        let mut add = |corners: [u32; 3]| {
            let corners = corners.map(place);
            corners.iter().for_each(|&at| used[at as usize] = true);
            triangles.push(corners);
        };
        match (b, c, d) {
            (Some(b), Some(c), Some(d)) => {
                add([a, b, c]);
                add([b, d, c]);
            }
            (Some(b), Some(c), None) => add([a, b, c]),
            (Some(b), None, Some(d)) => add([a, b, d]),
            (None, Some(c), Some(d)) => add([a, d, c]),
            _ => {}
        }
    }
    if triangles.is_empty() {
        return;
    }
    let (first_vertex, first_triangle) = (found.vertices.len() as u32, found.triangles.len() as u32);
    let mut renumbered = vec![NONE; members.len()];
    for (at, &v) in members.iter().enumerate().filter(|&(at, _)| used[at]) {
        renumbered[at] = found.vertices.len() as u32;
        let trace = fronts.trace[v as usize] as usize;
        found.vertices.push(Vertex { x: (trace / ny) as u16, y: (trace % ny) as u16, z: fronts.extrema.z[v as usize] });
    }
    found.triangles.extend(triangles.iter().map(|corners| corners.map(|at| renumbered[at as usize])));
    found.surfaces.push(Surface {
        extremum: fronts.extrema.kind,
        vertices: first_vertex..found.vertices.len() as u32,
        triangles: first_triangle..found.triangles.len() as u32,
    });
}

/// The surfaces of several kinds in one list, ordered by their first vertex (ties: in the order given).
fn joined(parts: &[Surfaces]) -> Surfaces {
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
        size: parts.first().map_or([0; 3], |part| part.size),
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
