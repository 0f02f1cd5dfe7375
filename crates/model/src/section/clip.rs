//! From cells to pieces: triangles are clipped by faults and sheets.

use super::plane::SectionPlane;
use crate::{Below, Region, StructuralModel};
use glam::{DVec2, DVec3};
use rayon::prelude::*;
use std::collections::HashMap;

/// What an edge of a piece is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Tag {
    /// Between pieces of one region.
    Inner,
    /// On the rectangle's outline.
    Frame,
    /// On a fault; the chord it is part of.
    Fault { fault: u8, chord: u32 },
    /// On a sheet.
    Horizon { horizon: u16 },
}

/// A directed edge with a region on its left (turning from s to t).
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Edge {
    pub from: u32,
    pub to: u32,
    pub tag: Tag,
    pub region: Region,
}

/// All edges of all pieces, except those between uniform cells.
pub(super) struct Arrangement {
    /// (s, t) of each vertex.
    pub positions: Vec<DVec2>,
    pub edges: Vec<Edge>,
}

/// Crossings of one chord by horizons of different blocks closer than this are one, voxels: beyond a fault's
/// tip the sheets on both sides are the same but for rounding.
const WELD: f64 = 2e-3;

/// What is known of a corner: sides of all faults, its block, and below which sheets of the block it lies.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
struct CornerState {
    bits: u64,
    block: u16,
    below: Below,
}

#[derive(Clone, Copy)]
struct ClippedPiece {
    v: [u32; 3],
    /// Tag of the edge from v\[i\] to v\[i + 1\].
    tag: [Tag; 3],
    bits: u64,
    /// For horizons before `next`: those that it lies below.
    below: Below,
    /// The next horizon to be clipped by; all between the last and this one lie on one side of it.
    next: Option<usize>,
}

/// A surface to clip by.
#[derive(Clone, Copy, PartialEq, Eq, Hash)]
enum ClipSurface {
    Fault(u8),
    Sheet { horizon: u16, block: u16 },
}

struct Clipper<'a> {
    model: &'a StructuralModel,
    plane: &'a SectionPlane,
    cells: [usize; 2],
    positions: Vec<DVec2>,
    corners: Vec<CornerState>,
    /// Fault sides of vertices after the corners.
    cut_bits: Vec<u64>,
    /// Below which sheets of a block a vertex after the corners lies.
    cut_below: HashMap<(u32, u16), Below>,
    /// The vertex where an edge (lower vertex first) meets a surface.
    cuts: HashMap<(u32, u32, ClipSurface), u32>,
    /// The chord between two vertices on a fault.
    chords: HashMap<(u32, u32), u32>,
    chord_ends: Vec<[u32; 2]>,
    /// Vertices where sheets meet a chord, with the sheet's block.
    crossings: HashMap<u32, Vec<(u32, u16)>>,
    pieces: Vec<(ClippedPiece, Region)>,
}

/// Divides the rectangle of `plane` into regions.
pub(super) fn arrange(model: &StructuralModel, plane: &SectionPlane) -> Arrangement {
    let cells = plane.cells();
    let [ns, nt] = cells;
    let st =
        |i: usize, j: usize| DVec2::new(plane.extent[0] * i as f64 / ns as f64, plane.extent[1] * j as f64 / nt as f64);
    let positions: Vec<DVec2> = (0..=ns).flat_map(|i| (0..=nt).map(move |j| st(i, j))).collect();
    let corners: Vec<CornerState> = positions.par_iter().map(|&p| corner(model, plane.voxel(p))).collect();
    let uniform: Vec<Option<Region>> = (0..ns * nt)
        .map(|c| {
            let n = c / nt * (nt + 1) + c % nt;
            let first = corners[n];
            let same = [n + 1, n + nt + 1, n + nt + 2].iter().all(|&m| corners[m] == first);
            same.then(|| Region { layer: model.rules().layer(&first.below), block: first.block })
        })
        .collect();
    let mut clipper = Clipper {
        model,
        plane,
        cells,
        positions,
        corners,
        cut_bits: Vec::new(),
        cut_below: HashMap::new(),
        cuts: HashMap::new(),
        chords: HashMap::new(),
        chord_ends: Vec::new(),
        crossings: HashMap::new(),
        pieces: Vec::new(),
    };
    for (c, _) in uniform.iter().enumerate().filter(|(_, u)| u.is_none()) {
        clipper.divide(c / nt, c % nt);
    }
    clipper.finish(&uniform)
}

fn corner(model: &StructuralModel, p: DVec3) -> CornerState {
    let p = p.as_vec3();
    let bits = model.faults().bits_at(p);
    let block = model.faults().block_of(bits);
    CornerState { bits, block, below: model.below_at(p, block) }
}

impl Clipper<'_> {
    /// Halves cell (i, j) and clips both triangles by everything.
    fn divide(&mut self, i: usize, j: usize) {
        let [ns, nt] = self.cells;
        let id = |i: usize, j: usize| (i * (nt + 1) + j) as u32;
        let (a, b, c, d) = (id(i, j), id(i + 1, j), id(i + 1, j + 1), id(i, j + 1));
        let frame = |on: bool| if on { Tag::Frame } else { Tag::Inner };
        let whole = |v, tag| ClippedPiece { v, tag, bits: 0, below: Below::default(), next: None };
        let mut pieces = vec![
            whole([a, b, c], [frame(j == 0), frame(i + 1 == ns), Tag::Inner]),
            whole([a, c, d], [Tag::Inner, frame(j + 1 == nt), frame(i == 0)]),
        ];
        for fault in 0..self.model.faults().surfaces().len() as u8 {
            let mut next = Vec::with_capacity(pieces.len());
            for piece in pieces {
                self.clip(piece, ClipSurface::Fault(fault), &mut next);
            }
            pieces = next;
        }
        for piece in pieces {
            let block = self.model.faults().block_of(piece.bits);
            let mut parts = vec![self.up_to_next(piece, 0, block)];
            // Horizons in order, each through all parts that it divides.
            while let Some(horizon) = parts.iter().filter_map(|part| part.next).min() {
                let mut divided = Vec::with_capacity(parts.len() + 2);
                for part in parts {
                    if part.next == Some(horizon) {
                        let first = divided.len();
                        self.clip(part, ClipSurface::Sheet { horizon: horizon as u16, block }, &mut divided);
                        for new in &mut divided[first..] {
                            *new = self.up_to_next(*new, horizon + 1, block);
                        }
                    } else {
                        divided.push(part);
                    }
                }
                parts = divided;
            }
            let rules = self.model.rules();
            self.pieces.extend(parts.into_iter().map(|p| (p, Region { layer: rules.layer(&p.below), block })));
        }
    }

    /// Finds the next horizon from `first` on that divides a piece; the piece lies on one side of those before it.
    fn up_to_next(&mut self, mut piece: ClippedPiece, first: usize, block: u16) -> ClippedPiece {
        let below = piece.v.map(|v| self.below(v, block));
        piece.below.take_from(first, &below[0]);
        piece.next = Below::first_between(below.each_ref(), first);
        piece
    }

    /// Appends the parts of `piece` on both sides of `cut`.
    fn clip(&mut self, piece: ClippedPiece, cut: ClipSurface, out: &mut Vec<ClippedPiece>) {
        let side = piece.v.map(|v| self.is_positive(v, cut));
        let marked = |mut piece: ClippedPiece, positive: bool| {
            match cut {
                ClipSurface::Fault(f) => piece.bits |= u64::from(positive) << f,
                ClipSurface::Sheet { horizon, .. } => piece.below = piece.below.with(usize::from(horizon), positive),
            }
            piece
        };
        if side[0] == side[1] && side[1] == side[2] {
            out.push(marked(piece, side[0]));
            return;
        }
        // Turn the triangle so that its first vertex is alone on its side.
        let lone = (0..3).find(|&i| side[i] != side[(i + 1) % 3] && side[i] != side[(i + 2) % 3]).unwrap_or(0);
        let at = |i: usize| (lone + i) % 3;
        let (v, tag) = ([0, 1, 2].map(|i| piece.v[at(i)]), [0, 1, 2].map(|i| piece.tag[at(i)]));
        let p = self.cut_edge(v[0], v[1], tag[0], cut);
        let q = self.cut_edge(v[2], v[0], tag[2], cut);
        let contour = match cut {
            ClipSurface::Sheet { horizon, .. } => Tag::Horizon { horizon },
            ClipSurface::Fault(fault) => {
                let count = self.chord_ends.len() as u32;
                let chord = *self.chords.entry((p.min(q), p.max(q))).or_insert(count);
                if chord == count {
                    self.chord_ends.push([p.min(q), p.max(q)]);
                }
                Tag::Fault { fault, chord }
            }
        };
        let part = |v, tag| ClippedPiece { v, tag, ..piece };
        out.push(marked(part([v[0], p, q], [tag[0], contour, tag[2]]), side[lone]));
        // The other side is a quadrilateral p, v1, v2, q.
        out.push(marked(part([p, v[1], v[2]], [tag[0], tag[1], Tag::Inner]), !side[lone]));
        out.push(marked(part([p, v[2], q], [Tag::Inner, tag[2], contour]), !side[lone]));
    }

    /// The vertex where edge (a, b) meets `cut`.
    fn cut_edge(&mut self, a: u32, b: u32, tag: Tag, cut: ClipSurface) -> u32 {
        let (low, high) = (a.min(b), a.max(b));
        if let Some(&v) = self.cuts.get(&(low, high, cut)) {
            return v;
        }
        let (p, q) = (self.positions[low as usize], self.positions[high as usize]);
        let positive = self.is_positive(low, cut);
        let t = root(|t| self.value(p.lerp(q, t), cut), positive);
        let v = self.positions.len() as u32;
        let st = p.lerp(q, t);
        self.positions.push(st);
        self.cut_bits.push(self.model.faults().bits_at(self.plane.voxel(st).as_vec3()));
        self.cuts.insert((low, high, cut), v);
        if let (Tag::Fault { chord, .. }, ClipSurface::Sheet { block, .. }) = (tag, cut) {
            self.crossings.entry(chord).or_default().push((v, block));
        }
        v
    }

    /// The function whose zero is the surface, at (s, t).
    fn value(&self, st: DVec2, cut: ClipSurface) -> f64 {
        let p = self.plane.voxel(st);
        match cut {
            ClipSurface::Fault(f) => self.model.faults().surfaces()[usize::from(f)].side(p),
            ClipSurface::Sheet { horizon, block } => match self.model.level(usize::from(horizon), block) {
                Some(level) => f64::from(level.offset_m(p.as_vec3())),
                None => p.z - f64::from(self.model.sheet(usize::from(horizon), block).z_at(p.x as f32, p.y as f32)),
            },
        }
    }

    fn is_positive(&mut self, v: u32, cut: ClipSurface) -> bool {
        let corner = self.corners.get(v as usize);
        match (cut, corner) {
            (ClipSurface::Fault(f), Some(corner)) => corner.bits >> f & 1 == 1,
            (ClipSurface::Fault(f), None) => self.cut_bits[v as usize - self.corners.len()] >> f & 1 == 1,
            (ClipSurface::Sheet { horizon, block }, _) => self.below(v, block).has(usize::from(horizon)),
        }
    }

    /// Below which sheets of a block a vertex lies.
    fn below(&mut self, v: u32, block: u16) -> Below {
        if let Some(corner) = self.corners.get(v as usize).filter(|corner| corner.block == block) {
            return corner.below;
        }
        let p = self.plane.voxel(self.positions[v as usize]).as_vec3();
        *self.cut_below.entry((v, block)).or_insert_with(|| self.model.below_at(p, block))
    }

    /// Collects the edges of all pieces, with the crossings of a chord inserted on both of its sides.
    fn finish(mut self, uniform: &[Option<Region>]) -> Arrangement {
        let voxel = self.plane.s_axis.length().min(self.plane.t_axis.length());
        let mut alias: HashMap<u32, u32> = HashMap::new();
        let mut on_chord: Vec<Vec<(f64, u32)>> = vec![Vec::new(); self.chord_ends.len()];
        for (chord, ends) in self.chord_ends.iter().enumerate() {
            let Some(crossings) = self.crossings.get(&(chord as u32)) else { continue };
            let [a, b] = ends.map(|v| self.positions[v as usize]);
            let along = |v: u32| (self.positions[v as usize] - a).dot(b - a);
            let mut sorted: Vec<(f64, u32, u16)> = crossings.iter().map(|&(v, block)| (along(v), v, block)).collect();
            sorted.sort_by(|x, y| x.0.total_cmp(&y.0).then(x.1.cmp(&y.1)));
            let mut last: Option<(u32, u16)> = None;
            for (at, v, block) in sorted {
                let near = |w: u32| self.positions[v as usize].distance(self.positions[w as usize]) * voxel < WELD;
                match last {
                    Some((w, of)) if of != block && near(w) => {
                        alias.insert(v, w);
                        last = None;
                    }
                    _ => {
                        on_chord[chord].push((at, v));
                        last = Some((v, block));
                    }
                }
            }
        }
        let mut edges = Vec::new();
        for (piece, region) in &self.pieces {
            for i in 0..3 {
                let ends = [piece.v[i], piece.v[(i + 1) % 3]];
                let ends = ends.map(|v| alias.get(&v).copied().unwrap_or(v));
                self.add(ends, piece.tag[i], *region, &on_chord, &mut edges);
            }
        }
        let [ns, nt] = self.cells;
        for (c, region) in uniform.iter().enumerate() {
            let Some(region) = *region else { continue };
            let (i, j) = (c / nt, c % nt);
            let id = |i: usize, j: usize| (i * (nt + 1) + j) as u32;
            let (p, q, r, s) = (id(i, j), id(i + 1, j), id(i + 1, j + 1), id(i, j + 1));
            let sides = [
                (p, q, (j > 0).then(|| c - 1)),
                (q, r, (i + 1 < ns).then(|| c + nt)),
                (r, s, (j + 1 < nt).then(|| c + 1)),
                (s, p, (i > 0).then(|| c - nt)),
            ];
            for (from, to, beside) in sides {
                match beside {
                    None => edges.push(Edge { from, to, tag: Tag::Frame, region }),
                    Some(other) if uniform[other] != Some(region) => {
                        edges.push(Edge { from, to, tag: Tag::Inner, region });
                    }
                    Some(_) => {}
                }
            }
        }
        Arrangement { positions: std::mem::take(&mut self.positions), edges }
    }

    /// Adds the edge between `ends`, divided where sheets of either side meet its chord.
    fn add(&self, ends: [u32; 2], tag: Tag, region: Region, on_chord: &[Vec<(f64, u32)>], edges: &mut Vec<Edge>) {
        let [from, to] = ends;
        if from == to {
            return;
        }
        let mut last = from;
        if let Tag::Fault { chord, .. } = tag {
            let [a, b] = self.chord_ends[chord as usize].map(|v| self.positions[v as usize]);
            let along = |v: u32| (self.positions[v as usize] - a).dot(b - a);
            let (start, end) = (along(from), along(to));
            let (low, high) = (start.min(end), start.max(end));
            let between: Vec<u32> = on_chord[chord as usize]
                .iter()
                .filter(|&&(at, v)| at > low && at < high && v != from && v != to)
                .map(|&(_, v)| v)
                .collect();
            let mut push = |v: u32| {
                edges.push(Edge { from: last, to: v, tag, region });
                last = v;
            };
            if start < end {
                between.into_iter().for_each(&mut push);
            } else {
                between.into_iter().rev().for_each(&mut push);
            }
        }
        edges.push(Edge { from: last, to, tag, region });
    }
}

/// Where `f` changes sign in [0, 1]: secant steps that keep the bracket (Illinois), then halving. `positive`
/// is the side that 0 was found to lie on; an end that is on the surface but for rounding is the root.
fn root(f: impl Fn(f64) -> f64, positive: bool) -> f64 {
    let (mut a, mut b) = (0.0, 1.0);
    let (mut fa, mut fb) = (f(a), f(b));
    if (fa >= 0.0) != positive {
        return a;
    }
    if (fb >= 0.0) == positive {
        return b;
    }
    let mut kept = 0;
    for step in 0..60 {
        let secant = (a * fb - b * fa) / (fb - fa);
        let inside = secant > a && secant < b;
        let m = if inside && step < 20 { secant } else { 0.5 * (a + b) };
        let fm = f(m);
        if fm.abs() < 1e-7 || b - a < 1e-9 {
            return m;
        }
        if (fm >= 0.0) == (fa >= 0.0) {
            (a, fa) = (m, fm);
            if kept == 1 {
                fb *= 0.5;
            }
            kept = 1;
        } else {
            (b, fb) = (m, fm);
            if kept == 2 {
                fa *= 0.5;
            }
            kept = 2;
        }
    }
    0.5 * (a + b)
}
