//! Horizons as levels of one function: what scattered points of several horizons tell together.
//!
//! Along a series of conformable horizons, age increases from one to the next wherever one goes, also through an
//! overturned limb, where the older rock lies above. So one function τ is looked for that has one value on each horizon:
//!
//! ```text
//! minimise  Σ |second differences of τ|²  +  w² Σ (τ(p) − v_h)²  over the points p of every horizon h,
//! v = 0 on the youngest horizon, 1 on the oldest, the others unknown
//! ```
//!
//! as implicit geological modelling does (C. Lajaunie, G. Courrioux, L. Manuel, "Foliation fields and 3D cartography in
//! geology", Mathematical Geology 29(4), 1997; L. Grose et al., "LoopStructural 1.0", Geosci. Model Dev. 14, 2021). The
//! order alone tells which side is which, so no normals are needed. τ breaks at faults and is one beyond their tips
//! ([`super::cut_lattice::CutLattice`]). It is solved from coarse to fine, then resampled to the voxels.

use super::LevelSurface;
use super::cut_lattice::{CutLattice, resampled};
use super::least_squares::Equations;
use crate::FaultNetwork;
use glam::{DMat3, Vec3};
use rayon::prelude::*;
use std::sync::Arc;
use survey::LevelField;
use survey::progress::{Cancelled, Progress};

/// Nodes of the finest lattice.
const NODES: f64 = 60_000.0;
/// Nodes beyond its faults at which a block is solved, too.
const AROUND: usize = 3;
/// How much a point counts beside a second difference.
const POINT_WEIGHT: f64 = 25.0;
/// Coarser lattices before the finest, each of twice the spacing of the next.
const COARSER: u32 = 2;
/// Steps of the solver on each lattice, and the share of the first gradient at which it stops.
const MOST_STEPS: usize = 400;
const TOLERANCE: f64 = 1e-5;

/// A point of a horizon.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct SeriesPoint {
    /// Position in the series, 0 = youngest.
    pub horizon: usize,
    /// Voxel position.
    pub p: Vec3,
    /// Its fault block.
    pub block: u16,
}

/// What is asked of a series.
pub(super) struct Series<'a> {
    /// The points of all its horizons.
    pub points: &'a [SeriesPoint],
    /// Number of horizons, at least 2.
    pub horizons: usize,
    /// The faults that break it.
    pub faults: &'a FaultNetwork,
    /// Voxels of the volume.
    pub size: [usize; 3],
    /// From voxels to metres.
    pub metric: DMat3,
}

/// τ on a lattice, and its value on each horizon.
struct SeriesSolution {
    /// At the nodes of the lattice, for each block.
    fields: Vec<LevelField>,
    levels: Vec<f64>,
}

impl Series<'_> {
    /// The surfaces, `[horizon][block]`.
    ///
    /// # Errors
    /// The user cancelled.
    pub(super) fn surfaces(&self, progress: &Progress) -> Result<Vec<Vec<LevelSurface>>, Cancelled> {
        let mut solution: Option<SeriesSolution> = None;
        for level in (0..=COARSER).rev() {
            solution = Some(self.solve(f64::from(1u32 << level), solution.as_ref(), progress)?);
        }
        let Some(solution) = solution else { return Ok(Vec::new()) };
        let fields: Vec<Arc<LevelField>> = (0..solution.fields.len())
            .into_par_iter()
            .map(|block| {
                let holds = |p: Vec3| usize::from(self.faults.block_at(p)) == block;
                Arc::new(resampled(&solution.fields[block], self.size, 1.0, holds))
            })
            .collect();
        let scale_m = self.metres_per_unit(&fields);
        let surface = |horizon: usize, block: usize| LevelSurface {
            field: Arc::clone(&fields[block]),
            at: solution.levels[horizon] as f32,
            scale_m,
            own: self.points.iter().filter(|q| q.horizon == horizon && usize::from(q.block) == block).count(),
        };
        Ok((0..self.horizons).map(|h| (0..fields.len()).map(|b| surface(h, b)).collect()).collect())
    }

    /// τ on a lattice whose spacing is `coarseness` times the finest.
    fn solve(
        &self,
        coarseness: f64,
        before: Option<&SeriesSolution>,
        progress: &Progress,
    ) -> Result<SeriesSolution, Cancelled> {
        let nodes = CutLattice::nodes_around(self.size, self.metric, NODES, coarseness);
        let mut near =
            CutLattice::near_blocks(self.faults, nodes, AROUND, |node| Some(self.faults.block_at(nodes.place(node))));
        // A block that is thinner than the spacing may have points and no node.
        for point in self.points {
            nodes.around(point.p).for_each(|node| near[usize::from(point.block)][node] = true);
        }
        let lattice = CutLattice::of(self.faults, nodes, |block, node| near[block][node]);
        let first_level = lattice.unknowns as u32;
        let mut equations = Equations::default();
        lattice.add_smoothness(1.0, &mut equations);
        for point in self.points {
            let value = lattice.value(usize::from(point.block), point.p);
            // The youngest lies at 0, the oldest at 1, the others where they fit best.
            match point.horizon {
                0 => equations.add(POINT_WEIGHT, value, [0.0]),
                h if h + 1 == self.horizons => equations.add(POINT_WEIGHT, value, [1.0]),
                h => {
                    let level = (first_level + h as u32 - 1, -1.0);
                    equations.add(POINT_WEIGHT, value.into_iter().chain([level]), [0.0]);
                }
            }
        }
        let mut guess = lattice.guess(|block, p| match before {
            Some(before) => [f64::from(before.fields[block].value(p))],
            None => [f64::from((p.z / self.size[2] as f32).clamp(0.0, 1.0))],
        });
        for h in 1..self.horizons - 1 {
            guess.push([before.map_or(h as f64 / (self.horizons - 1) as f64, |before| before.levels[h])]);
        }
        let mut values = equations.solve(guess, TOLERANCE, MOST_STEPS, progress)?;
        let between = values.split_off(lattice.unknowns);
        let levels = [[0.0]].into_iter().chain(between).chain([[1.0]]).map(|[level]| level).collect();
        Ok(SeriesSolution { fields: lattice.spread(&values, 0), levels })
    }

    /// Metres along ∇τ for a unit of τ: the median over the points.
    fn metres_per_unit(&self, fields: &[Arc<LevelField>]) -> f32 {
        let metric_from_covector = self.metric.inverse().transpose();
        let mut rates: Vec<f64> = self
            .points
            .iter()
            .map(|q| (metric_from_covector * fields[usize::from(q.block)].sample(q.p).1.as_dvec3()).length())
            .filter(|rate| *rate > 0.0)
            .collect();
        rates.sort_by(f64::total_cmp);
        rates.get(rates.len() / 2).map_or(1.0, |rate| (1.0 / rate) as f32)
    }
}
