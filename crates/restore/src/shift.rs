//! How far each block moves on the map, so that the cut-offs of the restored horizon meet.
//!
//! Each block b has a field u_b(x, y) on a coarse grid. It minimises
//!
//! ```text
//! Σ_b ∫ w |∇u_b|² dA  +  W Σ_ties (u_B(b) − u_A(a) − (a − b))²  +  ε ∫_{b₀} |u|² dA
//! ```
//!
//! A block moves as one where its ties let it (∇u = 0 costs nothing) and is strained as little as possible where the heave
//! changes along a fault, as it does towards a tip. w is 1 inside the block and small outside of it, so that what a block does
//! not hold does not hold it. The largest block, b₀, stays where it is in the mean. Both components are solved by conjugate
//! gradients.

use crate::ties::Tie;
use glam::{DVec2, DVec3};
use model::StructuralModel;
use rayon::prelude::*;
use survey::{Cancelled, HeightField, Progress};

/// Cells of the coarse grid along its longer side.
const CELLS: f64 = 32.0;
/// Weight of strain outside of a block.
const OUTSIDE: f64 = 0.02;
/// Weight of a tie (W), against strain over a cell.
const TIED: f64 = 20.0;
/// Weight that keeps the largest block in place (ε), and any other, so that one without ties has a place at all.
const ANCHOR: f64 = 1e-4;
const LOOSE: f64 = 1e-9;
/// Steps of conjugate gradients, at most, and the residual that is small enough.
const MOST_STEPS: usize = 3000;
const SOLVED: f64 = 1e-9;
/// Steps towards the place that a place came from.
const BACK_STEPS: usize = 24;

/// The coarse grid over the sheets of a model.
#[derive(Debug, Clone, Copy)]
struct Coarse {
    /// Voxel x, y of node (0, 0).
    origin: DVec2,
    /// Voxels between nodes.
    spacing: DVec2,
    size: [usize; 2],
}

impl Coarse {
    fn over(model: &StructuralModel) -> Self {
        let sheet = model.sheet(0, 0);
        let origin = DVec2::new(f64::from(sheet.origin[0]), f64::from(sheet.origin[1]));
        let extent = DVec2::new(sheet.size[0] as f64 - 1.0, sheet.size[1] as f64 - 1.0);
        let voxel_m = DVec2::new(model.metric().x_axis.length(), model.metric().y_axis.length());
        let cell_m = (extent * voxel_m).max_element() / CELLS;
        let cells = (extent * voxel_m / cell_m).ceil().max(DVec2::splat(3.0));
        Self { origin, spacing: extent / cells, size: [cells.x as usize + 1, cells.y as usize + 1] }
    }

    fn count(&self) -> usize {
        self.size[0] * self.size[1]
    }

    fn node_at(&self, voxel: DVec2) -> DVec2 {
        (voxel - self.origin) / self.spacing
    }

    fn voxel(&self, node: DVec2) -> DVec2 {
        self.origin + node * self.spacing
    }

    /// The nodes around a place and their weights, bilinear.
    fn weights(&self, voxel: DVec2) -> [(usize, f64); 4] {
        let last = DVec2::new(self.size[0] as f64 - 1.0, self.size[1] as f64 - 1.0);
        let at = self.node_at(voxel).clamp(DVec2::ZERO, last);
        let low = at.floor().min(last - 1.0);
        let f = at - low;
        let n = low.x as usize * self.size[1] + low.y as usize;
        [
            (n, (1.0 - f.x) * (1.0 - f.y)),
            (n + 1, (1.0 - f.x) * f.y),
            (n + self.size[1], f.x * (1.0 - f.y)),
            (n + self.size[1] + 1, f.x * f.y),
        ]
    }
}

/// The movement of each block on the map.
#[derive(Debug, Clone)]
pub(crate) struct Shift {
    coarse: Coarse,
    /// Of each block, along x and y, voxels.
    fields: Vec<[HeightField; 2]>,
}

impl Shift {
    /// The movement that closes `ties`; `depth` is that of the restored horizon in a block at voxel (x, y), and `largest` the
    /// block that stays.
    pub(crate) fn closing(
        model: &StructuralModel,
        ties: &[Tie],
        depth: &(dyn Fn(u16, DVec2) -> f64 + Sync),
        largest: u16,
        progress: &Progress,
    ) -> Result<Self, Cancelled> {
        let coarse = Coarse::over(model);
        let count = coarse.count();
        let blocks = model.block_count();
        let still = || HeightField { origin: [0, 0], size: coarse.size, z: vec![0.0; count] };
        if ties.iter().all(|tie| tie.apart().length() == 0.0) {
            return Ok(Self { coarse, fields: (0..blocks).map(|_| [still(), still()]).collect() });
        }
        let system = System::new(model, &coarse, ties, depth, largest);
        let of_axis =
            |axis: usize| system.solve(&ties.iter().map(|tie| -tie.apart()[axis]).collect::<Vec<_>>(), progress);
        let (x, y) = (of_axis(0)?, of_axis(1)?);
        let field = |all: &[f64], block: usize| HeightField {
            z: all[block * count..(block + 1) * count].iter().map(|z| *z as f32).collect(),
            ..still()
        };
        Ok(Self { coarse, fields: (0..blocks).map(|block| [field(&x, block), field(&y, block)]).collect() })
    }

    /// How far a block moves at a present place, voxels.
    pub(crate) fn at(&self, block: u16, voxel: DVec2) -> DVec2 {
        let node = self.coarse.node_at(voxel);
        let [x, y] = &self.fields[usize::from(block)];
        DVec2::new(f64::from(x.z_at(node.x as f32, node.y as f32)), f64::from(y.z_at(node.x as f32, node.y as f32)))
    }

    /// The present place of what comes to lie at a restored one.
    pub(crate) fn back(&self, block: u16, restored: DVec2) -> DVec2 {
        let mut from = restored;
        for _ in 0..BACK_STEPS {
            let next = restored - self.at(block, from);
            let is_there = (next - from).length_squared() < 1e-12;
            from = next;
            if is_there {
                break;
            }
        }
        from
    }

    /// The change of area at a present place: det(1 + ∇u) − 1.
    pub(crate) fn dilation(&self, block: u16, voxel: DVec2) -> f64 {
        let step = 0.25 * self.coarse.spacing;
        let along =
            |axis: DVec2, h: f64| (self.at(block, voxel + axis * h) - self.at(block, voxel - axis * h)) / (2.0 * h);
        let (dx, dy) = (along(DVec2::X, step.x), along(DVec2::Y, step.y));
        (1.0 + dx.x) * (1.0 + dy.y) - dx.y * dy.x - 1.0
    }
}

/// The equations of one component.
struct System<'a> {
    count: usize,
    unknowns: usize,
    /// Of each block, the edges of the grid and their weights.
    edges: Vec<(u32, u32, f64)>,
    ties: &'a [Tie],
    /// The unknowns of each tie with their coefficients.
    rows: Vec<[(usize, f64); 8]>,
    held: Vec<f64>,
}

impl<'a> System<'a> {
    fn new(
        model: &StructuralModel,
        coarse: &Coarse,
        ties: &'a [Tie],
        depth: &(dyn Fn(u16, DVec2) -> f64 + Sync),
        largest: u16,
    ) -> Self {
        let (count, [nu, nv], blocks) = (coarse.count(), coarse.size, model.block_count());
        let of_block = |block: usize| {
            let block = block as u16;
            let weight = |a: usize, b: usize| {
                let place = |n: usize| DVec2::new((n / nv) as f64, (n % nv) as f64);
                let middle = coarse.voxel(0.5 * (place(a) + place(b)));
                let p = middle.extend(depth(block, middle)).as_vec3();
                if model.faults().holds(block, p) { 1.0 } else { OUTSIDE }
            };
            let base = usize::from(block) * count;
            let mut edges = Vec::with_capacity(2 * count);
            for n in 0..count {
                for (inside, m) in [(n / nv + 1 < nu, n + nv), (n % nv + 1 < nv, n + 1)] {
                    if inside {
                        edges.push(((base + n) as u32, (base + m) as u32, weight(n, m)));
                    }
                }
            }
            edges
        };
        let edges: Vec<_> = (0..blocks).into_par_iter().flat_map_iter(of_block).collect();
        let row = |tie: &Tie| {
            let mut row = [(0, 0.0); 8];
            for (side, sign) in [(0, -1.0), (1, 1.0)] {
                let base = usize::from(tie.blocks[side]) * count;
                for (k, (n, weight)) in coarse.weights(tie.at[side]).into_iter().enumerate() {
                    row[4 * side + k] = (base + n, sign * weight);
                }
            }
            row
        };
        let held = |n: usize| if n / count == usize::from(largest) { ANCHOR } else { LOOSE };
        let unknowns = blocks * count;
        Self {
            count,
            unknowns,
            edges,
            ties,
            rows: ties.iter().map(row).collect(),
            held: (0..unknowns).map(held).collect(),
        }
    }

    fn applied(&self, u: &[f64]) -> Vec<f64> {
        let mut out: Vec<f64> = u.iter().zip(&self.held).map(|(u, held)| u * held).collect();
        for &(a, b, weight) in &self.edges {
            let (a, b) = (a as usize, b as usize);
            let pull = weight * (u[a] - u[b]);
            out[a] += pull;
            out[b] -= pull;
        }
        for (row, tie) in self.rows.iter().zip(self.ties) {
            let off: f64 = row.iter().map(|(n, c)| c * u[*n]).sum();
            row.iter().for_each(|(n, c)| out[*n] += TIED * tie.weight * c * off);
        }
        out
    }

    fn diagonal(&self) -> Vec<f64> {
        let mut diagonal = self.held.clone();
        for &(a, b, weight) in &self.edges {
            diagonal[a as usize] += weight;
            diagonal[b as usize] += weight;
        }
        for (row, tie) in self.rows.iter().zip(self.ties) {
            row.iter().for_each(|(n, c)| diagonal[*n] += TIED * tie.weight * c * c);
        }
        diagonal
    }

    /// The component that gives each tie what it is `wanted` to.
    fn solve(&self, wanted: &[f64], progress: &Progress) -> Result<Vec<f64>, Cancelled> {
        let mut right = vec![0.0; self.unknowns];
        for ((row, tie), wanted) in self.rows.iter().zip(self.ties).zip(wanted) {
            row.iter().for_each(|(n, c)| right[*n] += TIED * tie.weight * c * wanted);
        }
        let diagonal = self.diagonal();
        let dot = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
        let scaled = |r: &[f64]| r.iter().zip(&diagonal).map(|(r, d)| r / d).collect::<Vec<f64>>();
        let mut u = self.start(wanted);
        let first = self.applied(&u);
        let mut residual: Vec<f64> = right.iter().zip(&first).map(|(r, a)| r - a).collect();
        let mut towards = scaled(&residual);
        let mut along = towards.clone();
        let mut rho = dot(&residual, &towards);
        let small = SOLVED * SOLVED * dot(&right, &scaled(&right));
        for _ in 0..MOST_STEPS {
            if rho <= small {
                break;
            }
            progress.check()?;
            let image = self.applied(&along);
            let step = rho / dot(&along, &image).max(f64::MIN_POSITIVE);
            u.iter_mut().zip(&along).for_each(|(u, p)| *u += step * p);
            residual.iter_mut().zip(&image).for_each(|(r, a)| *r -= step * a);
            towards = scaled(&residual);
            let next = dot(&residual, &towards);
            let turn = next / rho;
            along.iter_mut().zip(&towards).for_each(|(p, z)| *p = z + turn * *p);
            rho = next;
        }
        Ok(u)
    }

    /// Blocks that move as one, from block to block along the heaviest ties: the right answer where heave is constant.
    fn start(&self, wanted: &[f64]) -> Vec<f64> {
        let blocks = self.unknowns / self.count;
        let mut between = std::collections::BTreeMap::<(u16, u16), DVec3>::new();
        for (tie, wanted) in self.ties.iter().zip(wanted) {
            let [a, b] = tie.blocks;
            *between.entry((a, b)).or_default() += tie.weight * DVec3::new(1.0, *wanted, 0.0);
            *between.entry((b, a)).or_default() += tie.weight * DVec3::new(1.0, -*wanted, 0.0);
        }
        let anchor = (0..blocks).max_by(|a, b| self.held[a * self.count].total_cmp(&self.held[b * self.count]));
        let mut moved: Vec<Option<f64>> = vec![None; blocks];
        if let Some(anchor) = anchor {
            moved[anchor] = Some(0.0);
        }
        loop {
            let open = between
                .iter()
                .filter(|((a, b), _)| moved[usize::from(*a)].is_some() && moved[usize::from(*b)].is_none());
            let Some(((a, b), sum)) = open.max_by(|a, b| a.1.x.total_cmp(&b.1.x)) else { break };
            moved[usize::from(*b)] = moved[usize::from(*a)].map(|from| from + sum.y / sum.x);
        }
        (0..self.unknowns).map(|n| moved[n / self.count].unwrap_or(0.0)).collect()
    }
}
