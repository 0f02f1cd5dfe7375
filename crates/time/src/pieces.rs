//! Pieces of an event, and whether what lies beyond a seam is the same reflection.
//!
//! An event falls into pieces at faults, and where it jumps by half a period or more between neighbouring traces. Along a
//! seam between two pieces the traces of either side, flattened on the event, are stacked a few traces away from it:
//! A(line, d) and B(line, d), d samples from the event. If both sides are one reflection they correlate best as they are,
//!
//! ```text
//! C(l) = Σ A(d − l/2) B(d + l/2) / √(Σ A² Σ B²)     over the lines along the seam and |d| up to a few periods,
//! ```
//!
//! by a margin over every other shift of more than a few samples. A piece is told where seams that are clear in this sense
//! join it to a seed; beyond the others the event is an assumption. Space: voxels.

mod grid;
mod likeness;
mod mending;

use crate::cuts::Cut;
use crate::event::{Event, Node, Seed, Support};
use crate::reflections::Reflections;
use grid::Grid;
use likeness::{Pairs, correlations, half_period};
use mending::{ROUNDS, mended};
use rayon::prelude::*;
use std::collections::BTreeMap;
use survey::Volume;

/// By how much both sides of a seam must correlate better than under any other shift, and at least, so that it is clear.
const CLEAR: f32 = 0.02;
const LEAST_LIKENESS: f32 = 0.4;
/// Count of nodes below which a piece behind a jump is a stray, and share of the traces from which on one is asked about.
const FEWEST: usize = 40;
const ASKED: f64 = 0.01;
/// Distance of the node of a seed from it, samples.
const AT_SEED: f32 = 3.0;

/// A part of an event that nothing tells to be the same reflection: a place in it answers.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Doubt {
    /// The number of the fault beyond which it lies; `None`: the event jumps there.
    pub fault: Option<usize>,
    /// A place in its midst, on what is assumed there.
    pub place: Seed,
    /// Count of its nodes.
    pub nodes: usize,
}

/// A seam between two pieces.
struct Seam {
    pieces: [u32; 2],
    /// The fault that lies between; `None`: a jump.
    fault: Option<usize>,
    /// Count of the pairs of nodes on both of its sides.
    pairs: usize,
    /// Correlation of both sides as they are, and under the best other shift.
    correlation: [f32; 2],
}

impl Seam {
    fn is_clear(&self) -> bool {
        let [own, rival] = self.correlation;
        own >= LEAST_LIKENESS && own >= rival + CLEAR
    }
}

/// The pieces of an event.
struct Pieces {
    /// The piece of each node.
    of: Vec<u32>,
    /// Count of the nodes of each piece.
    sizes: Vec<usize>,
    seams: Vec<Seam>,
    /// Pairs of neighbours of one piece between which it jumps all the same.
    inner: Vec<[u32; 2]>,
}

impl Event {
    /// Compares both sides of its seams with the amplitudes: what nothing joins to a seed becomes
    /// [`Support::Assumed`] and is told, the largest part first. Where it jumps within a fault block, strays and the ends of
    /// jumps are laid on the reflection that lies on the plane of their neighbours, or on that plane, or left out.
    ///
    /// Cost: one pass over its nodes and the faults, and some hundred traces along each seam.
    pub fn examine(
        &mut self,
        reflections: &Reflections,
        seeds: &[Seed],
        cuts: &[Cut],
        volume: &Volume<f32>,
    ) -> Vec<Doubt> {
        let pieces = Pieces::of(self, cuts, volume);
        let [nx, ny, _] = volume.size();
        let seeded: Vec<usize> = (0..self.nodes.len())
            .filter(|&n| {
                let Node { x, y, z, .. } = self.nodes[n];
                let is_here = |seed: &Seed| seed.trace == [x, y].map(usize::from) && (seed.z - z).abs() <= AT_SEED;
                seeds.iter().any(is_here)
            })
            .collect();
        if seeded.is_empty() {
            return Vec::new();
        }
        let is_told = pieces.told(seeded.iter().map(|n| pieces.of[*n]));
        let fewest = ((ASKED * (nx * ny) as f64) as usize).max(FEWEST);
        let asked = (0..pieces.sizes.len()).filter(|&piece| !is_told[piece] && pieces.sizes[piece] >= fewest);
        let mut doubts: Vec<Doubt> = asked.map(|piece| self.doubt(&pieces, piece as u32, &is_told)).collect();
        doubts.sort_by_key(|doubt| std::cmp::Reverse(doubt.nodes));
        let mut is_left_out = pieces.strays(self.nodes.len(), &is_told);
        seeded.iter().for_each(|n| is_left_out[*n] = false);
        for (node, piece) in self.nodes.iter_mut().zip(&pieces.of) {
            if !is_told[*piece as usize] {
                node.support = Support::Assumed;
            }
        }
        for _ in 0..ROUNDS {
            let grid = Grid::new(&self.nodes, [nx, ny]);
            let out: Vec<usize> = (0..self.nodes.len()).filter(|n| is_left_out[*n]).collect();
            let is_kept = |n: usize| !is_left_out[n] && self.nodes[n].support != Support::Assumed;
            let mend = |n: usize| Some((n, mended(&grid, n, is_kept, self.kind, reflections, cuts)?));
            let mended: Vec<(usize, (f32, Support))> = out.into_par_iter().filter_map(mend).collect();
            if mended.is_empty() {
                break;
            }
            for (n, (z, support)) in mended {
                (self.nodes[n].z, self.nodes[n].support, is_left_out[n]) = (z, support, false);
            }
        }
        let mut left_out = is_left_out.into_iter();
        self.nodes.retain(|_| !left_out.next().unwrap_or(false));
        self.nodes.sort_by(|a, b| (a.x, a.y).cmp(&(b.x, b.y)).then(a.z.total_cmp(&b.z)));
        doubts
    }

    /// What is not known of a piece: beyond which fault it lies, the one that most of its rim is at, and its midst.
    fn doubt(&self, pieces: &Pieces, piece: u32, is_told: &[bool]) -> Doubt {
        let own = pieces.seams.iter().filter(|seam| seam.pieces.contains(&piece));
        let beyond = own.max_by_key(|seam| (seam.pieces.iter().any(|other| is_told[*other as usize]), seam.pairs));
        let nodes: Vec<&Node> =
            self.nodes.iter().zip(&pieces.of).filter(|(_, of)| **of == piece).map(|at| at.0).collect();
        let mean =
            |of: fn(&Node) -> u16| nodes.iter().map(|node| f64::from(of(node))).sum::<f64>() / nodes.len() as f64;
        let middle = [mean(|node| node.x), mean(|node| node.y)];
        let off = |node: &&&Node| (f64::from(node.x) - middle[0]).hypot(f64::from(node.y) - middle[1]);
        let place = nodes.iter().min_by(|a, b| off(a).total_cmp(&off(b)));
        let place = place.map_or(Seed { trace: [0; 2], z: 0.0 }, |Node { x, y, z, .. }| Seed {
            trace: [*x, *y].map(usize::from),
            z: *z,
        });
        Doubt { fault: beyond.and_then(|seam| seam.fault), place, nodes: nodes.len() }
    }
}

impl Pieces {
    /// Which pieces clear seams join to some of them.
    fn told(&self, from: impl Iterator<Item = u32>) -> Vec<bool> {
        let mut is_told = vec![false; self.sizes.len()];
        let mut open: Vec<u32> = from.collect();
        while let Some(piece) = open.pop() {
            if !std::mem::replace(&mut is_told[piece as usize], true) {
                let clear = self.seams.iter().filter(|seam| seam.pieces.contains(&piece) && seam.is_clear());
                open.extend(clear.flat_map(|seam| seam.pieces));
            }
        }
        is_told
    }

    /// Which nodes are left out: those of small pieces behind jumps that nothing tells, and both ends of a jump in a piece.
    fn strays(&self, count: usize, is_told: &[bool]) -> Vec<bool> {
        let mut jumps = vec![false; self.sizes.len()];
        for seam in self.seams.iter().filter(|seam| seam.fault.is_none()) {
            seam.pieces.iter().for_each(|piece| jumps[*piece as usize] = true);
        }
        let is_stray = |piece: usize| jumps[piece] && !is_told[piece] && self.sizes[piece] < FEWEST;
        let mut out: Vec<bool> = (0..count).map(|n| is_stray(self.of[n] as usize)).collect();
        self.inner.iter().flatten().for_each(|n| out[*n as usize] = true);
        out
    }

    /// Takes an event apart.
    fn of(event: &Event, cuts: &[Cut], volume: &Volume<f32>) -> Self {
        let half = half_period(event, volume);
        let grid = Grid::new(&event.nodes, [volume.size()[0], volume.size()[1]]);
        // What lies between each node and the next along each axis.
        let between: Vec<[Option<(u32, Between)>; 2]> = (0..event.nodes.len())
            .into_par_iter()
            .map(|n| {
                [0, 1].map(|axis| {
                    let z = event.nodes[n].z;
                    let next = grid.beside(n, axis, 1, z)?;
                    let other = event.nodes[next].z;
                    let (a, b) = (grid.trace(n), grid.trace(next));
                    let between = match cuts.iter().position(|cut| cut.separates(a, z, b, other)) {
                        Some(fault) => Between::Fault(fault),
                        None if (other - z).abs() < half => Between::Nothing,
                        None if (other - z - grid.dip(n, axis)).abs() < half => Between::Nothing,
                        None => Between::Jump,
                    };
                    Some((next as u32, between))
                })
            })
            .collect();
        let mut sets = interp::UnionFind::new(event.nodes.len());
        for (n, both) in between.iter().enumerate() {
            for (next, _) in both.iter().flatten().filter(|(_, between)| *between == Between::Nothing) {
                sets.union(n as u32, *next);
            }
        }
        let mut number: BTreeMap<u32, u32> = BTreeMap::new();
        let (mut of, mut sizes) = (Vec::with_capacity(event.nodes.len()), Vec::new());
        for n in 0..event.nodes.len() {
            let piece = *number.entry(sets.find(n as u32)).or_insert_with(|| {
                sizes.push(0);
                sizes.len() as u32 - 1
            });
            of.push(piece);
            sizes[piece as usize] += 1;
        }
        let mut found: BTreeMap<([u32; 2], Option<usize>), Pairs> = BTreeMap::new();
        let mut inner = Vec::new();
        for (n, both) in between.iter().enumerate() {
            for (next, between) in both.iter().flatten() {
                let [a, b] = [of[n], of[*next as usize]];
                let fault = match between {
                    Between::Fault(fault) => Some(*fault),
                    Between::Jump => None,
                    Between::Nothing => continue,
                };
                if a == b && fault.is_none() {
                    inner.push([n as u32, *next]);
                } else if a != b {
                    let (pieces, pair) = if a < b { ([a, b], [n as u32, *next]) } else { ([b, a], [*next, n as u32]) };
                    found.entry((pieces, fault)).or_default().push(pair);
                }
            }
        }
        let seams = found.into_par_iter().map(|((pieces, fault), pairs)| {
            let correlation = correlations(&grid, &of, &pairs, volume);
            Seam { pieces, fault, pairs: pairs.len(), correlation }
        });
        Self { seams: seams.collect(), of, sizes, inner }
    }
}

/// What lies between two neighbouring nodes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Between {
    Nothing,
    Fault(usize),
    Jump,
}
