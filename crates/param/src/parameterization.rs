//! The parameterization of a whole model: one [`RegionGrid`] per layer and fault block.

use crate::columns::{ColumnScan, RegionColumns};
use crate::compute::{self, ComputeCost};
use crate::flow;
use crate::grid::{FlatPoint, RegionGrid, SheetSource};
use crate::metric::Metric;
use crate::plan::{self, Method, Planner};
use crate::tips::{self, Tips};
use crate::unfold::{self, Unfolded, Unfolding};
use crate::{LayerModel, ParamError, ParamSettings, Region};
use glam::Vec3;
use rayon::prelude::*;
use std::sync::Arc;
use survey::{HeightField, Progress};

/// The flat coordinates of every point of a model.
///
/// Lookups use the regions and sheets of the model, so they take the model that was parameterized as an
/// argument.
#[derive(Debug, Clone)]
pub struct Parameterization {
    /// Counts of voxels of the model.
    pub size: [usize; 3],
    /// Count of layers.
    pub layers: usize,
    /// Count of fault blocks.
    pub blocks: usize,
    /// The grids; region (layer, block) has index `block · layers + layer`.
    pub grids: Vec<RegionGrid>,
    /// Processor time of the computation; the only part that differs from run to run.
    pub cost: ComputeCost,
}

impl Parameterization {
    /// Computes the parameterization of a model.
    ///
    /// Cost: about 1 µs a node on one core. Nodes ≈ voxels / `level_spacing`, more where fault blocks overlap
    /// on the map. Memory: 12 bytes a node, and 1 byte more while it runs.
    ///
    /// # Errors
    /// [`ParamError`]: a setting is out of range, the model is degenerate, or the user cancelled.
    pub fn compute<M: LayerModel + ?Sized>(
        model: &M,
        settings: &ParamSettings,
        progress: &Progress,
    ) -> Result<Self, ParamError> {
        let (size, layers, blocks) = (model.size(), model.layer_count(), model.block_count());
        settings.validate(layers)?;
        if size.contains(&0) || layers == 0 || blocks == 0 {
            return Err(ParamError::Empty { size });
        }
        let metric = Metric::new(model.metric(), settings.exaggeration)?;
        let planner = Planner::new(model, settings, &metric);
        let region = |n: usize| Region { layer: (n % layers) as u16, block: (n / layers) as u16 };
        let mut touched = Vec::with_capacity(layers * blocks);
        let mut planned = Vec::with_capacity(layers * blocks);
        for (grid, method, columns) in Self::plan(model, &planner, progress)? {
            planned.push((grid, method));
            touched.push(columns);
        }
        let is_unfolded = |layer: &u16| {
            let of_layer = planned.iter().skip(usize::from(*layer)).step_by(layers);
            of_layer.into_iter().any(|(_, method)| *method == Method::Unfolded)
        };
        let folded: Vec<u16> = (0..layers as u16).filter(is_unfolded).collect();
        let grid_of = |of: Region| &planned[usize::from(of.block) * layers + usize::from(of.layer)].0;
        let weights = planner.log_weights(&folded, grid_of, progress)?;
        let weight_of = |of: Region| weights[usize::from(of.layer)].get(usize::from(of.block));
        let rise = |p: Vec3, of: Region| grid_of(of).level_k_by(model, weight_of(of), p);
        // Between two surfaces of any shape a vertical line says nothing of the thickness: it is how fast k rises.
        let thickness_m: Vec<Option<f64>> = (0..layers)
            .map(|layer| {
                let of_layer = || (0..blocks).map(move |block| block * layers + layer);
                let closed =
                    of_layer().filter(|&n| planned[n].1 == Method::Unfolded && planned[n].0.thickness_m.is_none());
                let rates = closed.flat_map(|n| {
                    let region = region(n);
                    planned[n].0.rises(model, &metric, weight_of(region), &touched[n], region)
                });
                // The geometric mean: a fold thickens as many beds as it thins.
                let (count, sum) = rates.fold((0.0, 0.0), |(count, sum), rate| (count + 1.0, sum - rate.ln()));
                (count > 0.0).then(|| (sum / count).exp())
            })
            .collect();
        // [layer][block]
        let mut unfolded: Vec<Vec<Unfolding>> = vec![Vec::new(); layers];
        let places = unfold::unfold(model, &metric, &folded, rise, progress)?;
        for (&layer, of_layer) in folded.iter().zip(places) {
            let layer = usize::from(layer);
            let mut own = weights[layer].iter().cloned();
            let with_weight = |places| Arc::new(Unfolded { places, log_weight: own.next() });
            unfolded[layer] = of_layer.into_iter().map(with_weight).collect();
        }
        let mut cost = ComputeCost::default();
        let mut grids = Vec::with_capacity(layers * blocks);
        let methods: Vec<Method> = planned.iter().map(|(_, method)| *method).collect();
        for (n, (mut grid, method)) in planned.into_iter().enumerate() {
            let (touched, block) = (&touched[n], region(n).block);
            if touched.depths.is_empty() && method != Method::Unfolded {
                grids.push(grid);
                continue;
            }
            let spent = match method {
                Method::Closest(kind) => {
                    let layer = planner.layer(&grid, touched, kind);
                    compute::fill(&mut grid, &layer, touched, settings.trace_tolerance, progress)?
                }
                Method::Flow(flow) => {
                    let (bottom, top) = (grid.bottom.clone(), grid.top.clone());
                    let bottom = |x: f32, y: f32| bottom.z(model, block, x, y);
                    let top = |x: f32, y: f32| top.z(model, block, x, y);
                    flow::fill(&mut grid, flow, planner.stride, &metric, [&bottom, &top], progress)?
                }
                Method::Unfolded => {
                    grid.thickness_m = grid.thickness_m.or(thickness_m[n % layers]);
                    grid.unfolded = unfolded[n % layers].get(usize::from(block)).cloned();
                    ComputeCost::default()
                }
            };
            cost.closest_points += spent.closest_points;
            cost.traces += spent.traces;
            grids.push(grid);
        }
        for layer in 0..layers {
            let mut of_layer: Vec<&mut RegionGrid> = grids.iter_mut().skip(layer).step_by(layers).collect();
            let columns: Vec<_> = (layer..layers * blocks)
                .step_by(layers)
                .map(|n| planner.is_joined(region(n), methods[n]).then(|| (&touched[n], methods[n])))
                .collect();
            tips::join(model, &metric, &mut of_layer, &columns, progress)?;
        }
        Ok(Self { size, layers, blocks, grids, cost })
    }

    /// What is to be computed for each region, in the order of the grids, and the columns that it occupies.
    pub(crate) fn plan<M: LayerModel + ?Sized>(
        model: &M,
        planner: &Planner<M>,
        progress: &Progress,
    ) -> Result<Vec<(RegionGrid, Method, RegionColumns)>, ParamError> {
        let (layers, blocks) = (model.layer_count(), model.block_count());
        let scan = ColumnScan::of(model, progress)?;
        let region = |n: usize| Region { layer: (n % layers) as u16, block: (n / layers) as u16 };
        let touched: Vec<RegionColumns> = (0..layers * blocks)
            .into_par_iter()
            .map(|n| {
                let region = region(n);
                let (bottom, top) = plan::horizons(model, n % layers);
                let field = |horizon: &usize| model.level(*horizon, region.block).is_none();
                let (bottom, top) = (bottom.filter(field), top.filter(field));
                let node = |horizon: Option<usize>, x, y, open| {
                    horizon.map_or(open, |horizon| model.sheet(horizon, region.block).node(x, y))
                };
                scan.touched(region, |x, y| (node(bottom, x, y, f32::INFINITY), node(top, x, y, f32::NEG_INFINITY)))
            })
            .collect();
        drop(scan);
        let rows: usize = touched.iter().map(|region| region.size[0]).sum();
        progress.begin("parameterizing", rows as u64);
        let mut reaches = vec![1.0f32; layers];
        for (n, touched) in touched.iter().enumerate() {
            let reach = &mut reaches[n % layers];
            *reach = reach.max(planner.farthest(region(n), touched));
        }
        let of_layer = |layer: usize| touched.iter().skip(layer).step_by(layers).collect::<Vec<_>>();
        let tips = Tips::of(model);
        let companions: Vec<Vec<Vec<u16>>> =
            (0..layers).into_par_iter().map(|layer| tips.companions(&of_layer(layer))).collect();
        let planned = (0..layers * blocks).into_par_iter().map(|n| {
            let (layer, region) = (n % layers, region(n));
            planner.plan(region, &of_layer(layer), &companions[layer][usize::from(region.block)], reaches[layer])
        });
        Ok(planned.collect())
    }

    /// The grid of a region.
    ///
    /// # Panics
    /// When the model has no such layer or block.
    pub fn grid(&self, region: Region) -> &RegionGrid {
        let (layer, block) = (usize::from(region.layer), usize::from(region.block));
        assert!(
            layer < self.layers && block < self.blocks,
            "{region:?} of {} layers, {} blocks",
            self.layers,
            self.blocks
        );
        &self.grids[block * self.layers + layer]
    }

    /// Flat coordinates of a voxel position: the exact lookup. Every position has an answer: outside the
    /// volume, the region is the one that the model gives and the offsets are those of the nearest column.
    pub fn lookup<M: LayerModel + ?Sized>(&self, model: &M, p: Vec3) -> FlatPoint {
        self.lookup_in(model, p, model.region_at(p)).0
    }

    /// Flat coordinates of a voxel position in the (extended) parameterization of `region`, and the Jacobian
    /// ∂(i, j, k)/∂(x, y, z) per voxel.
    ///
    /// # Panics
    /// As [`Parameterization::grid`].
    pub fn lookup_in<M: LayerModel + ?Sized>(&self, model: &M, p: Vec3, region: Region) -> (FlatPoint, [[f32; 3]; 3]) {
        self.grid(region).lookup(model, self.size, p)
    }

    /// Whether the parameterization of `region` has a crease (a jump of the closest point) next to voxel `p`.
    pub(crate) fn is_near_crease<M: LayerModel + ?Sized>(&self, model: &M, p: Vec3, region: Region) -> bool {
        self.grid(region).is_near_crease(model, p)
    }

    /// The sheets that are the parameterization's own ([`SheetSource::Calm`]), each once, in the order of the grids.
    pub fn calm_sheets(&self) -> Vec<Arc<HeightField>> {
        let mut found: Vec<Arc<HeightField>> = Vec::new();
        for sheet in self.grids.iter().flat_map(|grid| [&grid.bottom, &grid.top]) {
            if let SheetSource::Calm(sheet) = &sheet.of
                && !found.iter().any(|known| Arc::ptr_eq(known, sheet))
            {
                found.push(Arc::clone(sheet));
            }
        }
        found
    }

    /// The unfoldings of the grids, each once, in the order of the grids.
    pub fn unfoldings(&self) -> Vec<Unfolding> {
        let mut found: Vec<Unfolding> = Vec::new();
        for unfolded in self.grids.iter().filter_map(|grid| grid.unfolded.as_ref()) {
            if !found.iter().any(|known| Arc::ptr_eq(known, unfolded)) {
                found.push(Arc::clone(unfolded));
            }
        }
        found
    }

    /// Memory of all grids, their sheets and unfoldings, bytes.
    pub fn bytes(&self) -> usize {
        let unfolded = self.unfoldings();
        let unfolded = unfolded.iter().flat_map(|own| own.fields()).map(|field| size_of_val(field.values.as_slice()));
        let sheets = self.calm_sheets().iter().map(|sheet| size_of_val(sheet.z.as_slice())).sum::<usize>();
        self.grids.iter().map(RegionGrid::bytes).sum::<usize>() + sheets + unfolded.sum::<usize>()
    }
}
