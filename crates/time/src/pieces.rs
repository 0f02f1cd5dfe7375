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

use crate::cuts::Cut;
use crate::event::{Event, Node, Seed, Support};
use crate::reflections::Reflections;
use crate::solve::interpolate;
use interp::Extremum;
use rayon::prelude::*;
use std::collections::BTreeMap;
use survey::Volume;

/// Traces next to a seam that are left out, since beds are dragged there and patches end, and those that are stacked then.
const SKIPPED: usize = 1;
const STACKED: usize = 4;
/// Half the window of a comparison, samples.
const HALF_WINDOW: usize = 24;
/// Greatest shift of a rival, samples, and the least that is another reflection.
const MOST_SHIFT: usize = 20;
const SAME: usize = 3;
/// Lines of a seam that are compared at most, spread over it.
const MOST_LINES: usize = 64;
/// Least share of a window that must lie inside the volume.
const LEAST_OVERLAP: f32 = 0.5;
/// Traces to either side along a row over which the dip is told.
const DIP_REACH: usize = 4;

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
    /// [`Support::Assumed`] and is told, the largest part first; where it jumps within a fault block, strays and the ends of
    /// jumps are left out.
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
        doubts.sort_by(|a, b| b.nodes.cmp(&a.nodes));
        let mut is_left_out = pieces.strays(self.nodes.len(), &is_told);
        seeded.iter().for_each(|n| is_left_out[*n] = false);
        for (node, _) in self.nodes.iter_mut().zip(&pieces.of).filter(|(_, piece)| !is_told[**piece as usize]) {
            node.support = Support::Assumed;
        }
        for _ in 0..ROUNDS {
            let grid = Grid::new(&self.nodes, [nx, ny]);
            let out: Vec<usize> = (0..self.nodes.len()).filter(|n| is_left_out[*n]).collect();
            let is_kept = |n: usize| !is_left_out[n] && self.nodes[n].support != Support::Assumed;
            let mend = |n: usize| Some((n, mended(&grid, n, is_kept, self.kind, reflections, cuts)?));
            let mended: Vec<(usize, f32)> = out.into_par_iter().filter_map(mend).collect();
            if mended.is_empty() {
                break;
            }
            for (n, z) in mended {
                (self.nodes[n].z, self.nodes[n].support, is_left_out[n]) = (z, Support::Snapped, false);
            }
        }
        let mut left_out = is_left_out.into_iter();
        self.nodes.retain(|_| !left_out.next().unwrap_or(false));
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

/// Nodes by trace.
struct Grid<'a> {
    nodes: &'a [Node],
    starts: Vec<u32>,
    count: [usize; 2],
}

impl<'a> Grid<'a> {
    fn new(nodes: &'a [Node], count: [usize; 2]) -> Self {
        let mut starts = vec![0u32; count[0] * count[1] + 1];
        for node in nodes {
            starts[usize::from(node.x) * count[1] + usize::from(node.y) + 1] += 1;
        }
        for n in 1..starts.len() {
            starts[n] += starts[n - 1];
        }
        Self { nodes, starts, count }
    }

    fn on(&self, [x, y]: [usize; 2]) -> std::ops::Range<usize> {
        let trace = x * self.count[1] + y;
        self.starts[trace] as usize..self.starts[trace + 1] as usize
    }

    fn trace(&self, n: usize) -> [usize; 2] {
        [usize::from(self.nodes[n].x), usize::from(self.nodes[n].y)]
    }

    /// The node on the trace `steps` on from that of a node along an axis that is closest to a depth.
    fn beside(&self, n: usize, axis: usize, steps: isize, z: f32) -> Option<usize> {
        let mut trace = self.trace(n);
        trace[axis] = trace[axis].checked_add_signed(steps).filter(|at| *at < self.count[axis])?;
        let off = |m: &usize| (self.nodes[*m].z - z).abs();
        self.on(trace).min_by(|a, b| off(a).total_cmp(&off(b)))
    }

    /// The median step of depth along an axis around a pair of neighbours, the pair itself and what a fault cuts left out.
    fn dip(&self, n: usize, axis: usize) -> f32 {
        let mut steps = Vec::with_capacity(2 * DIP_REACH);
        let (mut at, mut m) = (Some(n), 0);
        while let (Some(here), true) = (at, m < DIP_REACH) {
            let next = self.beside(here, axis, -1, self.nodes[here].z);
            steps.extend(next.map(|next| self.nodes[here].z - self.nodes[next].z));
            (at, m) = (next, m + 1);
        }
        let (mut at, mut m) = (self.beside(n, axis, 1, self.nodes[n].z), 0);
        while let (Some(here), true) = (at, m < DIP_REACH) {
            let next = self.beside(here, axis, 1, self.nodes[here].z);
            steps.extend(next.map(|next| self.nodes[next].z - self.nodes[here].z));
            (at, m) = (next, m + 1);
        }
        steps.sort_by(f32::total_cmp);
        steps.get(steps.len() / 2).copied().unwrap_or(0.0)
    }
}

/// Half the period of the reflections around an event: the shift under which its traces, flattened on it, are least alike.
fn half_period(event: &Event, volume: &Volume<f32>) -> f32 {
    const AROUND: isize = HALF_WINDOW as isize;
    let step = (event.nodes.len() / 2000).max(1);
    let mut sums = [0.0f64; MOST_SHIFT + 1];
    for node in event.nodes.iter().step_by(step) {
        let trace = volume.trace(usize::from(node.x), usize::from(node.y));
        let last = (trace.len() - 1) as f32;
        let at = |d: isize| {
            let z = node.z + d as f32;
            if z >= 0.0 && z <= last { interpolate(trace, z) } else { 0.0 }
        };
        let window: Vec<f32> = (-AROUND..=AROUND).map(at).collect();
        let energy: f32 = window.iter().map(|a| a * a).sum();
        if energy > 0.0 && energy.is_finite() {
            for (lag, sum) in sums.iter_mut().enumerate() {
                let product: f32 = window.iter().zip(&window[lag..]).map(|(a, b)| a * b).sum();
                *sum += f64::from(product / energy);
            }
        }
    }
    let least = (2..MOST_SHIFT).find(|&lag| sums[lag] <= sums[lag - 1] && sums[lag] < sums[lag + 1]);
    least.unwrap_or(SAME).max(SAME) as f32
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
        let mut found: BTreeMap<([u32; 2], Option<usize>), Vec<[u32; 2]>> = BTreeMap::new();
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

/// Traces around a stray that tell where the event lies there, least share of them, and how far from their plane most of
/// them may lie, samples.
const MENDING: isize = 3;
const LEAST_AROUND: f32 = 0.4;
const FLAT: f32 = 1.5;
/// Distance from the plane of its neighbours within which a stray goes to a reflection, samples.
const MENDED: f32 = 2.0;
/// Rounds of mending: what was mended tells of what lies next to it.
const ROUNDS: usize = 4;

/// The reflection on the trace of a stray that lies on the plane of what is kept around it on the same side of every fault.
fn mended(
    grid: &Grid<'_>,
    stray: usize,
    is_kept: impl Fn(usize) -> bool,
    kind: Option<Extremum>,
    reflections: &Reflections,
    cuts: &[Cut],
) -> Option<f32> {
    let trace = grid.trace(stray);
    let mut around: Vec<[f32; 3]> = Vec::new();
    for (i, j) in (-MENDING..=MENDING).flat_map(|i| (-MENDING..=MENDING).map(move |j| (i, j))) {
        let at = [trace[0].checked_add_signed(i), trace[1].checked_add_signed(j)];
        let [Some(x), Some(y)] = at else { continue };
        if x >= grid.count[0] || y >= grid.count[1] || [x, y] == trace {
            continue;
        }
        let own = grid.on([x, y]).filter(|&n| is_kept(n)).map(|n| grid.nodes[n].z);
        let own = own.filter(|&z| !cuts.iter().any(|cut| cut.separates(trace, z, [x, y], z)));
        around.extend(own.map(|z| [i as f32, j as f32, z]));
    }
    let side = (2 * MENDING + 1) as f32;
    if (around.len() as f32) < LEAST_AROUND * side * side {
        return None;
    }
    // The plane z = a + b i + c j by least squares, once more without what lies far from it.
    let mut z = 0.0;
    for _ in 0..2 {
        let [a, b, c] = plane(&around)?;
        let off = |[i, j, at]: &[f32; 3]| (at - a - b * i - c * j).abs();
        let mut all: Vec<f32> = around.iter().map(off).collect();
        all.sort_by(f32::total_cmp);
        if all[all.len() / 2] > FLAT {
            return None;
        }
        around.retain(|place| off(place) <= 3.0 * FLAT);
        z = a;
    }
    reflections.nearest(trace, z, kind, MENDED).map(|found| found.z)
}

/// The plane through places, least squares; `None` where they lie on one line.
fn plane(places: &[[f32; 3]]) -> Option<[f32; 3]> {
    let count = places.len() as f32;
    let sum = |of: &dyn Fn(&[f32; 3]) -> f32| places.iter().map(of).sum::<f32>() / count;
    let [i, j, z] = [0, 1, 2].map(|n| sum(&|place| place[n]));
    let product = |a: usize, b: usize| {
        let mean = [i, j, z];
        sum(&|place| (place[a] - mean[a]) * (place[b] - mean[b]))
    };
    let (ii, ij, jj, iz, jz) = (product(0, 0), product(0, 1), product(1, 1), product(0, 2), product(1, 2));
    let determinant = ii * jj - ij * ij;
    if determinant < 1e-3 {
        return None;
    }
    let (b, c) = ((iz * jj - jz * ij) / determinant, (jz * ii - iz * ij) / determinant);
    Some([z - b * i - c * j, b, c])
}

/// The correlation of both sides of a seam as they are, and under the best other shift.
fn correlations(grid: &Grid<'_>, of: &[u32], pairs: &[[u32; 2]], volume: &Volume<f32>) -> [f32; 2] {
    const REACH: usize = HALF_WINDOW + MOST_SHIFT / 2;
    let step = pairs.len().div_ceil(MOST_LINES).max(1);
    // For each shift Σ ab, Σ a², Σ b², and how many samples there are, in half samples of depth.
    let mut sums = vec![[0.0f32; 4]; 2 * MOST_SHIFT + 1];
    for &[a, b] in pairs.iter().step_by(step) {
        let axis = usize::from(grid.trace(a as usize)[0] == grid.trace(b as usize)[0]);
        let sign: isize = if grid.trace(a as usize)[axis] < grid.trace(b as usize)[axis] { -1 } else { 1 };
        let (Some(a), Some(b)) =
            (stack(grid, of, a as usize, axis, sign, volume), stack(grid, of, b as usize, axis, -sign, volume))
        else {
            continue;
        };
        for (n, sums) in sums.iter_mut().enumerate() {
            let shift = n as isize - MOST_SHIFT as isize;
            // Half shifts fall between samples every second time.
            let (low, high) = (shift.div_euclid(2), shift - shift.div_euclid(2));
            for d in -(HALF_WINDOW as isize)..=HALF_WINDOW as isize {
                let at = |side: &[f32], d: isize| side[(d + REACH as isize + 1) as usize];
                let (a, b) = (at(&a, d - low), at(&b, d + high));
                if a.is_finite() && b.is_finite() {
                    *sums = [sums[0] + a * b, sums[1] + a * a, sums[2] + b * b, sums[3] + 1.0];
                }
            }
        }
    }
    let most = sums[MOST_SHIFT][3];
    let correlation = |[product, a, b, count]: [f32; 4]| {
        if count > 0.0 && count >= LEAST_OVERLAP * most { product / (a * b).sqrt().max(1e-9) } else { 0.0 }
    };
    let at = |n: usize| correlation(sums[n]);
    let own = (MOST_SHIFT - 1..=MOST_SHIFT + 1).map(at).fold(0.0, f32::max);
    let rival = (0..sums.len()).filter(|n| n.abs_diff(MOST_SHIFT) >= SAME).map(at).fold(0.0, f32::max);
    [own, rival]
}

/// Amplitudes around an event on one side of a seam, stacked on it and brought to one level; NaN outside the volume.
fn stack(grid: &Grid<'_>, of: &[u32], from: usize, axis: usize, sign: isize, volume: &Volume<f32>) -> Option<Vec<f32>> {
    const REACH: isize = (HALF_WINDOW + MOST_SHIFT / 2 + 1) as isize;
    let mut all = vec![0.0f32; 2 * REACH as usize + 1];
    let (mut node, mut count) = (from, 0);
    for n in 0..SKIPPED + STACKED {
        if n >= SKIPPED {
            let [x, y] = grid.trace(node);
            let (trace, z) = (volume.trace(x, y), grid.nodes[node].z);
            let last = (trace.len() - 1) as f32;
            for (sum, d) in all.iter_mut().zip(-REACH..=REACH) {
                let z = z + d as f32;
                *sum += if z >= 0.0 && z <= last { interpolate(trace, z) } else { f32::NAN };
            }
            count += 1;
        }
        match grid.beside(node, axis, sign, grid.nodes[node].z).filter(|next| of[*next] == of[from]) {
            Some(next) => node = next,
            None => break,
        }
    }
    let energy: f32 = all.iter().filter(|a| a.is_finite()).map(|a| a * a).sum();
    if count == 0 || energy <= 0.0 {
        return None;
    }
    all.iter_mut().for_each(|a| *a /= energy.sqrt());
    Some(all)
}
