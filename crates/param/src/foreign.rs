//! A parameterization that another program computed: i, j, k, layer and block at the samples of a lattice, as
//! GeoChron-like models give them.
//!
//! Where a layer is comes from the interpretation alone, so that boundaries stay sharp; the file says how its rock is
//! mapped to flat space. Its values become the offsets of the stratigraphic grids (see [`crate::grid`]): differences from
//! x, y and the vertical fraction v vary little, so interpolating them near a boundary, from the samples of the region
//! alone, is exact wherever the map is straight.
//!
//! Where horizons are no height fields, i and j become an unfolding and k stays the share of the distances from both
//! surfaces.

use crate::columns::RegionColumns;
use crate::grid::{PINCHED, RegionGrid};
use crate::metric::Metric;
use crate::plan::{Method, Planner};
use crate::unfold::Unfolded;
use crate::voxels::{NO_REGION, corner_aligned};
use crate::{KDefinition, LayerModel, ParamError, ParamSettings, Parameterization, Region, VoxelParameterization};
use glam::Vec3;
use rayon::prelude::*;
use std::sync::Arc;
use survey::{LevelField, Progress};

/// The share of the samples that may lie in another layer than the interpretation says: those at boundaries.
const MOST_ELSEWHERE: f64 = 0.05;
/// Voxels between the nodes of unfoldings.
const UNFOLDED_STEP: f32 = 2.0;

/// What was taken from a parameterization of another program.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Taken {
    /// Share of its samples whose layer is that of the interpretation, 0 to 1.
    pub agreeing: f64,
    /// Share of the grids' nodes that lie beside its samples; the others continue what is nearest.
    pub covered: f64,
}

impl Parameterization {
    /// The parameterization of a model whose i, j and k are those of `found`.
    ///
    /// Memory: 18 bytes a sample of `found` with what it holds itself, while it runs, and 12 bytes a node.
    ///
    /// # Errors
    /// [`ParamError::OtherLayers`] when it is not of this interpretation, [`ParamError::NoValues`] when a layer has none
    /// in it, and as [`Parameterization::compute`].
    pub fn of_volumes<M: LayerModel + ?Sized>(
        model: &M,
        found: &VoxelParameterization,
        settings: &ParamSettings,
        progress: &Progress,
    ) -> Result<(Self, Taken), ParamError> {
        let (size, layers, blocks) = (model.size(), model.layer_count(), model.block_count());
        if size.contains(&0) || found.size.contains(&0) {
            return Err(ParamError::VolumeSize { size: found.size });
        }
        // The drawn horizons bound every grid.
        let settings = ParamSettings {
            definitions: vec![KDefinition::DistanceRatio; layers],
            flow_wave_m: 0.0,
            ..settings.clone()
        };
        let metric = Metric::new(model.metric(), settings.exaggeration)?;
        let planner = Planner::new(model, &settings, &metric);
        let planned = Self::plan(model, &planner, progress)?;
        let samples = Samples::of(model, found, &planned, progress)?;
        let agreeing = samples.agreeing;
        if agreeing < 1.0 - MOST_ELSEWHERE {
            return Err(ParamError::OtherLayers { share: 1.0 - agreeing, layers });
        }
        if let Some(n) = samples.counts.iter().position(|[all, own]| *all > 0 && *own == 0) {
            return Err(ParamError::NoValues { layer: n % layers });
        }
        let mut grids = Vec::with_capacity(layers * blocks);
        let (mut nodes, mut covered) = (0, 0);
        progress.begin("taking i, j, k", planned.len() as u64);
        for (mut grid, method, touched) in planned {
            let is_unfolded = method == Method::Unfolded;
            if is_unfolded || !touched.depths.is_empty() {
                let [all, known] = if is_unfolded {
                    samples.unfold(model, &mut grid)
                } else {
                    samples.fill(model, &mut grid, &touched)
                };
                nodes += all;
                covered += known;
            }
            grids.push(grid);
            progress.step(1)?;
        }
        let covered = covered as f64 / nodes.max(1) as f64;
        let cost = crate::ComputeCost::default();
        Ok((Self { size, layers, blocks, grids, cost }, Taken { agreeing, covered }))
    }
}

/// The samples of the file as offsets of the regions that they lie in.
struct Samples {
    size: [usize; 3],
    volume: [usize; 3],
    /// Region of each sample as the interpretation has it, where the file has values of the same layer.
    region: Vec<Option<Region>>,
    /// `[dx, dy, dk]` as in [`RegionGrid::offsets`].
    offsets: Vec<[f32; 3]>,
    /// Share of the samples with values whose layer is that of the interpretation.
    agreeing: f64,
    /// How many samples lie in each region, and how many of them have values of its layer, in the order of the grids.
    counts: Vec<[u64; 2]>,
}

impl Samples {
    fn of<M: LayerModel + ?Sized>(
        model: &M,
        found: &VoxelParameterization,
        planned: &[(RegionGrid, Method, RegionColumns)],
        progress: &Progress,
    ) -> Result<Self, ParamError> {
        let (size, volume, layers) = (found.size, model.size(), model.layer_count());
        let count = size.iter().product::<usize>();
        let (mut regions, mut offsets) = (vec![None; count], vec![[0.0f32; 3]; count]);
        let slab = size[1] * size[2];
        progress.begin("comparing layers", size[0] as u64);
        let rows = regions.par_chunks_mut(slab).zip(offsets.par_chunks_mut(slab)).enumerate();
        let rows = rows.map(|(px, (regions, offsets))| {
            let (mut given, mut counts) = (0u64, vec![[0u64; 2]; planned.len()]);
            for n in 0..slab {
                let at = px * slab + n;
                let p = place([px, n / size[2], n % size[2]], size, volume);
                let region = model.region_at(p);
                let index = usize::from(region.block) * layers + usize::from(region.layer);
                counts[index][0] += 1;
                let layer = found.layer.samples()[at];
                let [i, j, k] = [&found.i, &found.j, &found.k].map(|values| values.samples()[at]);
                if layer == NO_REGION || !(i.is_finite() && j.is_finite() && k.is_finite()) {
                    continue;
                }
                given += 1;
                if region.layer == layer {
                    counts[index][1] += 1;
                    let [nx, ny] = [0, 1].map(|axis: usize| volume[axis].saturating_sub(1).max(1) as f32);
                    offsets[n] = [i * nx - p.x, j * ny - p.y, k - fraction(model, &planned[index].0, p)];
                    regions[n] = Some(region);
                }
            }
            progress.step(1)?;
            Ok::<_, ParamError>((given, counts))
        });
        let none = || (0, vec![[0; 2]; planned.len()]);
        let (given, counts) = rows.try_reduce(none, |(n, a), (m, b)| {
            let sums = a.into_iter().zip(b).map(|([a, c], [b, d])| [a + b, c + d]);
            Ok((n + m, sums.collect()))
        })?;
        let same: u64 = counts.iter().map(|[_, own]| own).sum();
        // Without any value it is no other layers' but empty, which the counts tell.
        let agreeing = if given == 0 { 1.0 } else { same as f64 / given as f64 };
        Ok(Self { size, volume, region: regions, offsets, agreeing, counts })
    }

    /// The offsets of a region at a voxel position, from the samples around it that lie in the region.
    fn at(&self, region: Region, p: Vec3) -> Option<[f32; 3]> {
        let mut low = [0; 3];
        let mut part = [0.0f32; 3];
        for axis in 0..3 {
            let scale = (self.size[axis] - 1) as f32 / self.volume[axis].saturating_sub(1).max(1) as f32;
            let at = (p[axis] * scale).clamp(0.0, (self.size[axis] - 1) as f32);
            low[axis] = (at as usize).min(self.size[axis].saturating_sub(2));
            part[axis] = at - low[axis] as f32;
        }
        let (mut sum, mut weights) = ([0.0; 3], 0.0);
        for corner in 0..8 {
            let mut weight = 1.0;
            let mut index = low;
            for axis in 0..3 {
                let second = corner >> axis & 1;
                index[axis] = (low[axis] + second).min(self.size[axis] - 1);
                weight *= if second == 1 { part[axis] } else { 1.0 - part[axis] };
            }
            let n = (index[0] * self.size[1] + index[1]) * self.size[2] + index[2];
            if weight > 0.0 && self.region[n] == Some(region) {
                (0..3).for_each(|m| sum[m] += weight * self.offsets[n][m]);
                weights += weight;
            }
        }
        (weights > 0.0).then(|| sum.map(|sum| sum / weights))
    }

    /// Fills the nodes of a grid; returns how many there are and how many lie beside samples.
    fn fill<M: LayerModel + ?Sized>(&self, model: &M, grid: &mut RegionGrid, touched: &RegionColumns) -> [usize; 2] {
        // A level for each sample along the trace, so that nothing that the file says is lost.
        let finer = self.size[2] as f32 / self.volume[2] as f32;
        let thickest = touched.columns().map(|(_, [x, y], _)| thickness(model, grid, x, y)).fold(0.0, f32::max);
        let most = 2.0 * self.volume[2] as f32;
        grid.levels = grid.levels.max((thickest.min(most) * finer).ceil() as usize + 1);
        let ([_, ny], levels, region) = (grid.size, grid.levels, grid.region);
        let mut nodes: Vec<Option<[f32; 3]>> = vec![None; grid.size[0] * ny * levels];
        nodes.par_chunks_mut(levels).enumerate().for_each(|(column, nodes)| {
            let [x, y] = [grid.origin[0] + (column / ny) as i32, grid.origin[1] + (column % ny) as i32];
            let (bottom, thickness) = (grid.bottom.node(model, region.block, x, y), thickness(model, grid, x, y));
            for (level, node) in nodes.iter_mut().enumerate() {
                let z = bottom - thickness * level as f32 / (levels - 1) as f32;
                *node = self.at(region, Vec3::new(x as f32, y as f32, z));
            }
        });
        let known = nodes.iter().flatten().count();
        let all = nodes.len();
        spread(&mut nodes, [grid.size[0], ny, levels]);
        grid.creases = vec![0; all.div_ceil(64)];
        grid.offsets = nodes.into_iter().map(Option::unwrap_or_default).collect();
        [all, known]
    }

    /// Gives an unfolded region its i and j.
    fn unfold<M: LayerModel + ?Sized>(&self, model: &M, grid: &mut RegionGrid) -> [usize; 2] {
        let last = Vec3::from_array(model.size().map(|n| n.saturating_sub(1) as f32));
        let size = (last / UNFOLDED_STEP).ceil().to_array().map(|n| n as usize + 1).map(|n| n.max(2));
        let origin = Vec3::ZERO;
        let mut nodes: Vec<Option<[f32; 3]>> = (0..size.iter().product::<usize>())
            .into_par_iter()
            .map(|n| {
                let index = [n / (size[1] * size[2]), n / size[2] % size[1], n % size[2]];
                let p = origin + Vec3::from_array(index.map(|n| n as f32)) * UNFOLDED_STEP;
                self.at(grid.region, p).map(|[dx, dy, _]| [p.x + dx, p.y + dy, 0.0])
            })
            .collect();
        let known = nodes.iter().flatten().count();
        spread(&mut nodes, size);
        let field = |which: usize| LevelField {
            origin,
            step: Vec3::splat(UNFOLDED_STEP),
            size,
            values: nodes.iter().map(|node| node.map_or(0.0, |node| node[which])).collect(),
        };
        grid.unfolded = Some(Arc::new(Unfolded { places: [field(0), field(1)], log_weight: None }));
        [known, known]
    }
}

/// Voxel position of a sample of a lattice over a volume.
fn place(index: [usize; 3], size: [usize; 3], volume: [usize; 3]) -> Vec3 {
    Vec3::from_array(std::array::from_fn(|axis| corner_aligned(index[axis], size[axis], volume[axis])))
}

/// The vertical fraction between the sheets of a grid.
fn fraction<M: LayerModel + ?Sized>(model: &M, grid: &RegionGrid, p: Vec3) -> f32 {
    let bottom = grid.bottom.z(model, grid.region.block, p.x, p.y);
    let thickness = bottom - grid.top.z(model, grid.region.block, p.x, p.y);
    if thickness < PINCHED { 0.5 } else { ((bottom - p.z) / thickness).clamp(0.0, 1.0) }
}

/// Voxels between the sheets of a grid at a column.
fn thickness<M: LayerModel + ?Sized>(model: &M, grid: &RegionGrid, x: i32, y: i32) -> f32 {
    grid.bottom.node(model, grid.region.block, x, y) - grid.top.node(model, grid.region.block, x, y)
}

/// Gives nodes without a value the mean of their neighbours', from the known ones outwards; first along the last axis.
fn spread(nodes: &mut [Option<[f32; 3]>], size: [usize; 3]) {
    // Along a column the nearest value, so that what is above or below the samples continues them.
    for column in nodes.chunks_mut(size[2].max(1)) {
        let known: Vec<usize> = (0..column.len()).filter(|&n| column[n].is_some()).collect();
        let (Some(&first), Some(&last)) = (known.first(), known.last()) else { continue };
        let mut nearest = column[first];
        for node in &mut column[..=last] {
            nearest = node.or(nearest);
            *node = nearest;
        }
        (last..column.len()).for_each(|n| column[n] = column[last]);
    }
    let (row, all) = (size[1] * size[2], nodes.len());
    let beside = |column: usize| {
        let (x, y) = (column / row, column % row / size[2]);
        let before = [(x > 0).then(|| column - row), (y > 0).then(|| column - size[2])];
        let after = [(x + 1 < size[0]).then(|| column + row), (y + 1 < size[1]).then(|| column + size[2])];
        before.into_iter().chain(after).flatten()
    };
    let mut edge: Vec<usize> = (0..all).step_by(size[2].max(1)).filter(|&column| nodes[column].is_some()).collect();
    while !edge.is_empty() {
        let mut next: Vec<usize> = edge.iter().flat_map(|&column| beside(column)).collect();
        next.retain(|&column| nodes[column].is_none());
        next.sort_unstable();
        next.dedup();
        let means: Vec<Vec<Option<[f32; 3]>>> = next
            .iter()
            .map(|&column| {
                let mean = |z: usize| {
                    let known = beside(column).filter_map(|from| nodes[from + z]);
                    let (sum, count) = known.fold(([0.0; 3], 0.0f32), |(sum, count), value| {
                        (std::array::from_fn(|m| sum[m] + value[m]), count + 1.0)
                    });
                    (count > 0.0).then(|| sum.map(|sum| sum / count))
                };
                (0..size[2]).map(mean).collect()
            })
            .collect();
        for (&column, values) in next.iter().zip(means) {
            nodes[column..column + size[2]].copy_from_slice(&values);
        }
        edge = next;
    }
}
