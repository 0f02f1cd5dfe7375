//! From labelled extrema to [`Surfaces`]: the triangles of the cells whose corners share a label.
//!
//! A closed cell of four corners makes two triangles, split along the diagonal that is less steep; three
//! corners make one. The order of surfaces, vertices and triangles follows from the extrema alone.
//!
//! The vertices and triangles of a surface on one inline are contiguous in the result, so once they are
//! counted the inlines are written in parallel. Triangles are made three times (to find the extrema they use,
//! to count, to write), which is cheaper than storing them.

use super::links::{Links, NONE};
use crate::extrema::Extrema;
use crate::surfaces::{Surface, Surfaces, Vertex};
use rayon::prelude::*;
use survey::{Cancelled, Progress};

/// The extrema of one kind with their labels; [`NONE`] where there is no surface.
pub(crate) struct Labelled<'e> {
    pub(crate) extrema: &'e Extrema,
    pub(crate) links: Links,
    pub(crate) labels: Vec<u32>,
}

/// One kind of extremum with its surfaces numbered.
struct Numbered<'e> {
    extrema: &'e Extrema,
    links: Links,
    /// Number of the surface of each extremum that a triangle uses, otherwise [`NONE`]. Surfaces are numbered
    /// in the order of their first vertices.
    numbers: Vec<u32>,
    /// First vertex of each surface.
    firsts: Vec<Vertex>,
    /// Index in the result of each vertex that has been written.
    places: Vec<u32>,
}

/// Counts of a surface on one inline: vertices, and triangles of the cells that begin there.
#[derive(Clone, Copy)]
struct Count {
    surface: u32,
    inline: u32,
    counts: [u32; 2],
}

/// The part of the result that belongs to one surface on one inline.
struct InlineSlot<'s> {
    surface: u32,
    /// Index of the first vertex.
    first: u32,
    vertices: &'s mut [Vertex],
    triangles: &'s mut [[u32; 3]],
}

/// Progress steps of [`surfaces`] per inline.
pub(crate) const STEPS: usize = 3;

/// The surfaces of all kinds, ordered by their first vertex (ties: in the order given).
///
/// # Errors
/// [`Cancelled`] by the user.
pub(crate) fn surfaces(size: [usize; 3], kinds: Vec<Labelled<'_>>, progress: &Progress) -> Result<Surfaces, Cancelled> {
    let lines = size[0] as u64;
    let mut kinds: Vec<Numbered> = kinds.into_par_iter().map(Numbered::new).collect();
    progress.step(lines)?;
    let counts: Vec<Vec<Count>> = kinds.par_iter().map(Numbered::count).collect();
    progress.step(lines)?;
    let mut order: Vec<(usize, usize)> =
        kinds.iter().enumerate().flat_map(|(kind, of)| (0..of.firsts.len()).map(move |s| (kind, s))).collect();
    order.sort_by(|&(kind_a, a), &(kind_b, b)| {
        let (a, b) = (kinds[kind_a].firsts[a], kinds[kind_b].firsts[b]);
        (a.x, a.y).cmp(&(b.x, b.y)).then(a.z.total_cmp(&b.z))
    });
    let total = |which: usize| counts.iter().flatten().map(|count| count.counts[which] as usize).sum::<usize>();
    let mut all = Surfaces {
        size,
        vertices: vec![Vertex { x: 0, y: 0, z: 0.0 }; total(0)],
        triangles: vec![[0; 3]; total(1)],
        surfaces: Vec::with_capacity(order.len()),
    };
    // The result is divided piece by piece, in its order.
    let mut parts: Vec<Vec<Vec<InlineSlot>>> =
        kinds.iter().map(|_| (0..size[0]).map(|_| Vec::new()).collect::<Vec<_>>()).collect();
    let starts: Vec<Vec<usize>> = counts.iter().zip(&kinds).map(|(counts, kind)| kind.starts(counts)).collect();
    let (mut vertices, mut triangles) = (all.vertices.as_mut_slice(), all.triangles.as_mut_slice());
    let mut reached = [0u32; 2];
    for (kind, surface) in order {
        let begin = reached;
        for count in &counts[kind][starts[kind][surface]..starts[kind][surface + 1]] {
            let (own, rest) = std::mem::take(&mut vertices).split_at_mut(count.counts[0] as usize);
            vertices = rest;
            let (faces, rest) = std::mem::take(&mut triangles).split_at_mut(count.counts[1] as usize);
            triangles = rest;
            let part = InlineSlot { surface: surface as u32, first: reached[0], vertices: own, triangles: faces };
            parts[kind][count.inline as usize].push(part);
            reached = [reached[0] + count.counts[0], reached[1] + count.counts[1]];
        }
        all.surfaces.push(Surface {
            extremum: kinds[kind].extrema.kind,
            vertices: begin[0]..reached[0],
            triangles: begin[1]..reached[1],
        });
    }
    kinds.par_iter_mut().zip(&mut parts).for_each(|(kind, parts)| kind.write_vertices(parts));
    progress.step(lines)?;
    kinds.par_iter().zip(parts).for_each(|(kind, parts)| kind.write_triangles(parts));
    Ok(all)
}

impl<'e> Numbered<'e> {
    /// Numbers the surfaces of a kind.
    fn new(labelled: Labelled<'e>) -> Self {
        let Labelled { extrema, links, labels: mut numbers } = labelled;
        // Whether a cell that begins on the same inline uses an extremum, and one that begins on the inline
        // before.
        let [mut here, mut ahead] = [(); 2].map(|()| vec![false; extrema.len()]);
        let lines =
            extrema.split_inlines(&mut here).into_iter().zip(extrema.split_inlines(&mut ahead).into_iter().skip(1));
        lines.collect::<Vec<_>>().into_par_iter().enumerate().for_each(|(x, (here, ahead))| {
            let line = extrema.on_inline(x);
            for a in line.clone() {
                for corner in CellTriangles::new(extrema, &links, &numbers, a as u32).triangles().iter().flatten() {
                    let corner = *corner as usize;
                    if corner < line.end {
                        here[corner - line.start] = true;
                    } else {
                        ahead[corner - line.end] = true;
                    }
                }
            }
        });
        let mut ranks = vec![NONE; extrema.len()];
        let mut firsts = Vec::new();
        let [nx, ny, _] = extrema.size;
        for trace in 0..nx * ny {
            let [x, y] = [trace / ny, trace % ny];
            for v in extrema.on_trace(x, y) {
                if !(here[v] | ahead[v]) {
                    numbers[v] = NONE;
                    continue;
                }
                let rank = &mut ranks[numbers[v] as usize];
                if *rank == NONE {
                    *rank = firsts.len() as u32;
                    firsts.push(Vertex { x: x as u16, y: y as u16, z: extrema.z[v] });
                }
                numbers[v] = *rank;
            }
        }
        Self { extrema, links, numbers, firsts, places: ranks }
    }

    /// The triangles of the cell that begins at an extremum.
    fn cell(&self, a: usize) -> CellTriangles {
        CellTriangles::new(self.extrema, &self.links, &self.numbers, a as u32)
    }

    /// The counts of each surface on each inline, ordered by surface.
    fn count(&self) -> Vec<Count> {
        let none = || vec![[0u32; 2]; self.firsts.len()];
        let mut counts: Vec<Count> = (0..self.extrema.size[0])
            .into_par_iter()
            .map_init(none, |counts, x| {
                let mut met = Vec::new();
                for v in self.extrema.on_inline(x) {
                    let surface = self.numbers[v];
                    if surface != NONE {
                        let count = &mut counts[surface as usize];
                        if count[0] == 0 && count[1] == 0 {
                            met.push(surface);
                        }
                        count[0] += 1;
                    }
                    // Two corners of any triangle lie on this inline, so its surface is met here too.
                    let cell = self.cell(v);
                    if cell.count > 0 {
                        let count = &mut counts[self.numbers[cell.triangles[0][0] as usize] as usize];
                        if count[0] == 0 && count[1] == 0 {
                            met.push(self.numbers[cell.triangles[0][0] as usize]);
                        }
                        count[1] += cell.count as u32;
                    }
                }
                let take = |surface: u32| Count {
                    surface,
                    inline: x as u32,
                    counts: std::mem::take(&mut counts[surface as usize]),
                };
                met.into_iter().map(take).collect::<Vec<_>>()
            })
            .flatten_iter()
            .collect();
        counts.par_sort_unstable_by_key(|count| (count.surface, count.inline));
        counts
    }

    /// Where the counts of each surface begin, and the end of the last.
    fn starts(&self, counts: &[Count]) -> Vec<usize> {
        let surfaces = 0..=self.firsts.len() as u32;
        surfaces.map(|surface| counts.partition_point(|count| count.surface < surface)).collect()
    }

    /// Writes the vertices, inline by inline.
    fn write_vertices(&mut self, parts: &mut [Vec<InlineSlot<'_>>]) {
        let Self { extrema, numbers, firsts, places, .. } = self;
        let none = || vec![[0usize; 2]; firsts.len()];
        let lines = extrema.split_inlines(places).into_par_iter().zip(parts).enumerate();
        lines.for_each_init(none, |at, (x, (places, parts))| {
            let start = extrema.on_inline(x).start;
            parts.iter().enumerate().for_each(|(n, part)| at[part.surface as usize] = [n, 0]);
            for y in 0..extrema.size[1] {
                for v in extrema.on_trace(x, y) {
                    if numbers[v] == NONE {
                        continue;
                    }
                    let [part, reached] = &mut at[numbers[v] as usize];
                    let part = &mut parts[*part];
                    part.vertices[*reached] = Vertex { x: x as u16, y: y as u16, z: extrema.z[v] };
                    places[v - start] = part.first + *reached as u32;
                    *reached += 1;
                }
            }
        });
    }

    /// Writes the triangles, inline by inline.
    fn write_triangles(&self, parts: Vec<Vec<InlineSlot<'_>>>) {
        let none = || vec![[0usize; 2]; self.firsts.len()];
        parts.into_par_iter().enumerate().for_each_init(none, |at, (x, mut parts)| {
            parts.iter().enumerate().for_each(|(n, part)| at[part.surface as usize] = [n, 0]);
            for v in self.extrema.on_inline(x) {
                for triangle in self.cell(v).triangles() {
                    let [part, reached] = &mut at[self.numbers[triangle[0] as usize] as usize];
                    parts[*part].triangles[*reached] = triangle.map(|corner| self.places[corner as usize]);
                    *reached += 1;
                }
            }
        });
    }
}

/// The triangles of a cell.
pub(crate) struct CellTriangles {
    triangles: [[u32; 3]; 2],
    count: usize,
    /// Its corners one after the other around it: `a`, the next along x, the next along both, the next along y.
    pub(crate) ring: [u32; 4],
    /// Which triangles of [`SHAPES`] they make.
    pub(crate) shape: usize,
}

/// The triangles that a cell may be made of, by places in its ring: one where a corner is of another surface, otherwise two,
/// split along either diagonal.
pub(crate) const SHAPES: [&[[usize; 3]]; 6] =
    [&[[1, 2, 3]], &[[2, 3, 0]], &[[3, 0, 1]], &[[0, 1, 2]], &[[0, 1, 2], [0, 2, 3]], &[[0, 1, 3], [1, 2, 3]]];

impl CellTriangles {
    /// The triangles of the cell that begins at `a`.
    pub(crate) fn new(extrema: &Extrema, links: &Links, labels: &[u32], a: u32) -> Self {
        let none = Self { triangles: [[0; 3]; 2], count: 0, ring: [0; 4], shape: 0 };
        let Some([a, b, c, d]) = links.closed(a) else { return none };
        let label = |v: u32| labels[v as usize];
        let ring = [a, b, d, c];
        // The label that most corners have.
        let Some(most) =
            ring.iter().map(|&v| label(v)).find(|&l| l != NONE && ring.iter().filter(|&&v| label(v) == l).count() >= 3)
        else {
            return none;
        };
        let steep = |v: u32, w: u32| (extrema.z[v as usize] - extrema.z[w as usize]).abs();
        let split = || if steep(a, d) <= steep(b, c) { 4 } else { 5 };
        let shape = ring.iter().position(|&v| label(v) != most).unwrap_or_else(split);
        let mut triangles = [[0; 3]; 2];
        for (triangle, places) in triangles.iter_mut().zip(SHAPES[shape]) {
            *triangle = places.map(|place| ring[place]);
        }
        Self { triangles, count: SHAPES[shape].len(), ring, shape }
    }

    /// They, none for a cell that is not closed.
    pub(crate) fn triangles(&self) -> &[[u32; 3]] {
        &self.triangles[..self.count]
    }
}
