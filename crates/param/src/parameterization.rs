//! The parameterization of a whole model: one [`RegionGrid`] per layer and fault block.

use crate::compute::{self, ComputeCost};
use crate::grid::{FlatPoint, RegionGrid, SheetRef};
use crate::layer::{Layer, LayerKind};
use crate::metric::Metric;
use crate::surface::BicubicSheet;
use crate::touched::{ColumnScan, RegionColumns};
use crate::{KDefinition, LayerModel, ParamError, ParamSettings, Region};
use glam::Vec3;
use rayon::prelude::*;
use survey::{HeightField, Progress};

/// Fewest levels of a grid; the cubic along a column uses four.
const FEWEST_LEVELS: usize = 5;

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
        let scan = ColumnScan::of(model, progress)?;
        let touched: Vec<RegionColumns> = (0..layers * blocks)
            .into_par_iter()
            .map(|n| {
                let region = Region { layer: (n % layers) as u16, block: (n / layers) as u16 };
                let (bottom, top) = horizons(n % layers, layers);
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
            let region = Region { layer: (n % layers) as u16, block: (n / layers) as u16 };
            let reach = &mut reaches[n % layers];
            *reach = reach.max(farthest(model, settings, region, touched));
        }
        let mut cost = ComputeCost::default();
        let mut grids = Vec::with_capacity(layers * blocks);
        for block in 0..blocks {
            for layer in 0..layers {
                let touched = &touched[block * layers + layer];
                let region = Region { layer: layer as u16, block: block as u16 };
                let (mut grid, sheets) = plan(model, settings, &metric, region, touched, reaches[layer]);
                if !touched.depths.is_empty() {
                    let spent = compute::fill(&mut grid, &sheets(), touched, settings.trace_tolerance, progress)?;
                    cost.closest_points += spent.closest_points;
                    cost.traces += spent.traces;
                }
                grids.push(grid);
            }
        }
        Ok(Self { size, layers, blocks, grids, cost })
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
    pub fn is_near_crease<M: LayerModel + ?Sized>(&self, model: &M, p: Vec3, region: Region) -> bool {
        self.grid(region).is_near_crease(model, p)
    }

    /// Memory of all grids, bytes.
    pub fn bytes(&self) -> usize {
        self.grids.iter().map(RegionGrid::bytes).sum()
    }
}

/// Horizons at the bottom and the top of a layer.
fn horizons(layer: usize, layers: usize) -> (Option<usize>, Option<usize>) {
    ((layer > 0).then(|| layers - 1 - layer), (layer + 1 < layers).then(|| layers - 2 - layer))
}

/// Vertical distance (voxels) from the reference sheet of an open or parallel layer to the farthest point of
/// the region; the reference thickness has to cover it. The shortest distance to the sheet is never longer.
fn farthest<M: LayerModel + ?Sized>(
    model: &M,
    settings: &ParamSettings,
    region: Region,
    touched: &RegionColumns,
) -> f32 {
    let layers = model.layer_count();
    let layer = usize::from(region.layer);
    let (bottom, top) = horizons(layer, layers);
    let last = model.size()[2].saturating_sub(1) as f32;
    let node = |horizon: usize, [x, y]: [i32; 2]| model.sheet(horizon, region.block).node(x, y);
    // An open layer reaches to the edge of the volume, a closed one as far as the region was found.
    let met = |column: [i32; 2], z: f32| model.region_at(Vec3::new(column[0] as f32, column[1] as f32, z)) == region;
    let step = 2.0;
    let depths_met = |column: [i32; 2], depths: [f32; 2]| {
        let (low, high) = (depths[0].max(0.0), depths[1].min(last));
        (0..=((high - low) / step) as usize).map(move |n| low + n as f32 * step).filter(move |&z| met(column, z))
    };
    let height = |column: [i32; 2], depths: [f32; 2]| match (settings.definition(layer, layers), bottom, top) {
        (_, Some(bottom), None) => node(bottom, column).min(last),
        (_, None, Some(top)) => last - node(top, column).max(0.0),
        (Some(KDefinition::ParallelToBottom), Some(bottom), _) => {
            depths_met(column, depths).next().map_or(0.0, |z| node(bottom, column) - z + step)
        }
        (Some(KDefinition::ParallelToTop), _, Some(top)) => {
            depths_met(column, depths).last().map_or(0.0, |z| z - node(top, column) + step)
        }
        _ => 0.0,
    };
    touched.columns().map(|(_, column, depths)| height(column, depths)).fold(0.0, f32::max)
}

/// The empty grid of a region, and a function that makes its sheets.
fn plan<'a, M: LayerModel + ?Sized>(
    model: &'a M,
    settings: &ParamSettings,
    metric: &'a Metric,
    region: Region,
    touched: &'a RegionColumns,
    reach: f32,
) -> (RegionGrid, impl FnOnce() -> Layer + 'a) {
    let layers = model.layer_count();
    let (bottom, top) = horizons(usize::from(region.layer), layers);
    let last = model.size()[2].saturating_sub(1) as f32;
    let at = |horizon, shift| SheetRef { horizon, shift };
    let thickness = reach * metric.vertical_step();
    let definition = settings.definition(usize::from(region.layer), layers);
    let (kind, bottom, top) = match (definition, bottom, top) {
        (Some(KDefinition::DistanceRatio), Some(_), Some(_)) => (LayerKind::Ratio, at(bottom, 0.0), at(top, 0.0)),
        (Some(KDefinition::ParallelToTop), _, Some(_)) | (_, None, Some(_)) => {
            (LayerKind::BelowTop(thickness), at(top, reach), at(top, 0.0))
        }
        (_, Some(_), _) => (LayerKind::AboveBottom(thickness), at(bottom, 0.0), at(bottom, -reach)),
        (_, None, None) => (LayerKind::Vertical, at(None, last.max(1.0)), at(None, 0.0)),
    };
    let node = move |sheet: SheetRef, x, y| {
        sheet.horizon.map_or(0.0, |horizon| model.sheet(horizon, region.block).node(x, y)) + sheet.shift
    };
    let thickest = touched
        .columns()
        .map(|(_, [x, y], _)| node(bottom, x, y) - node(top, x, y))
        .fold(0.0, f32::max)
        .min(4.0 * (last + 1.0));
    let levels = ((thickest / settings.level_spacing).ceil() as usize + 1).max(FEWEST_LEVELS);
    let thickness_m = match kind {
        LayerKind::AboveBottom(thickness) | LayerKind::BelowTop(thickness) => {
            Some(f64::from(thickness) * metric.unit_m)
        }
        LayerKind::Ratio | LayerKind::Vertical => None,
    };
    let grid = RegionGrid {
        region,
        origin: touched.origin,
        size: touched.size,
        levels: if kind == LayerKind::Vertical { 3 } else { levels },
        bottom,
        top,
        thickness_m,
        offsets: Vec::new(),
        creases: Vec::new(),
    };
    let surface = move |sheet: SheetRef| match sheet.horizon {
        Some(horizon) => BicubicSheet::new(model.sheet(horizon, region.block), sheet.shift),
        None => BicubicSheet::new(&HeightField::from_fn(touched.origin, touched.size, |_, _| 0.0), sheet.shift),
    };
    (grid, move || Layer { bottom: surface(bottom), top: surface(top), kind, metric: *metric })
}
