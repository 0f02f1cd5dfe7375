//! The parameterization of a whole model: one [`RegionGrid`] per layer and fault block.

use crate::compute::{self, ComputeCost};
use crate::grid::{FlatPoint, RegionGrid, SheetRef};
use crate::layer::{Layer, LayerKind};
use crate::metric::Metric;
use crate::surface::Surface;
use crate::touched::{Touched, touched_columns};
use crate::{KDefinition, LayerModel, ParamError, ParamSettings, Region};
use glam::Vec3;
use survey::{HeightField, Progress};

/// Fewest levels of a grid: the cubic along columns wants four.
const FEWEST_LEVELS: usize = 5;

/// k, i and j of every point of a model.
///
/// Lookups ask the model for the region and for its sheets, so the model that was parameterized has to be passed along.
#[derive(Debug, Clone)]
pub struct Parameterization {
    /// Counts of voxels of the model.
    pub size: [usize; 3],
    /// Count of layers.
    pub layers: usize,
    /// Count of fault blocks.
    pub blocks: usize,
    /// Index `block · layers + layer`.
    pub grids: Vec<RegionGrid>,
    /// What it cost; the only part that differs from run to run.
    pub cost: ComputeCost,
}

impl Parameterization {
    /// Parameterizes a model.
    ///
    /// Cost: about 1 µs a node on one core; nodes ≈ voxels / `level_spacing`, more where fault blocks overlap in the map.
    /// Memory: 12 bytes a node, while it runs 1 byte more.
    ///
    /// # Errors
    /// [`ParamError`]: a setting out of range, a degenerate model, or cancelled.
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
        let touched = touched_columns(model, progress)?;
        let rows: usize = touched.iter().map(|region| region.size[0]).sum();
        progress.begin("parameterizing", rows as u64);
        let reach: Vec<f32> = (0..layers)
            .map(|layer| {
                (0..blocks)
                    .map(|block| reach(model, settings, layer, block, &touched[block * layers + layer]))
                    .fold(1.0, f32::max)
            })
            .collect();
        let mut cost = ComputeCost::default();
        let mut grids = Vec::with_capacity(layers * blocks);
        for block in 0..blocks {
            for layer in 0..layers {
                let touched = &touched[block * layers + layer];
                let region = Region { layer: layer as u16, block: block as u16 };
                let (mut grid, sheets) = plan(model, settings, &metric, region, touched, reach[layer]);
                if !touched.wanted.is_empty() {
                    let spent =
                        compute::fill(&mut grid, &sheets(), touched, size[2], settings.trace_tolerance, progress)?;
                    cost.closest_points += spent.closest_points;
                    cost.traces += spent.traces;
                }
                grids.push(grid);
            }
        }
        Ok(Self { size, layers, blocks, grids, cost })
    }

    /// The grid of a region.
    pub fn grid(&self, region: Region) -> &RegionGrid {
        let index = usize::from(region.block) * self.layers + usize::from(region.layer);
        &self.grids[index.min(self.grids.len() - 1)]
    }

    /// Flat coordinates of a voxel position: the exact path. Total: a point outside the volume is looked up in the region
    /// that the model says it is in, with the offsets of the nearest column.
    pub fn lookup<M: LayerModel + ?Sized>(&self, model: &M, p: Vec3) -> FlatPoint {
        self.lookup_in(model, p, model.region_at(p)).0
    }

    /// Flat coordinates of a voxel position by the (extended) parameterization of a given region, with the Jacobian
    /// ∂(i, j, k)/∂(x, y, z) per voxel.
    pub fn lookup_in<M: LayerModel + ?Sized>(&self, model: &M, p: Vec3, region: Region) -> (FlatPoint, [[f32; 3]; 3]) {
        self.grid(region).lookup(model, self.size, p)
    }

    /// Whether the parameterization has a crease (a jump of a closest point) beside voxel `p` of a region.
    pub fn is_near_crease<M: LayerModel + ?Sized>(&self, model: &M, p: Vec3, region: Region) -> bool {
        self.grid(region).is_near_crease(model, p)
    }

    /// Bytes held by all grids.
    pub fn bytes(&self) -> usize {
        self.grids.iter().map(RegionGrid::bytes).sum()
    }
}

/// Horizons at the bottom and top of a layer.
fn horizons(layer: usize, layers: usize) -> (Option<usize>, Option<usize>) {
    ((layer > 0).then(|| layers - 1 - layer), (layer + 1 < layers).then(|| layers - 2 - layer))
}

/// Voxels from a layer's reference sheet to the farthest place of the region, along the vertical: what the reference
/// thickness of open and parallel layers has to cover. The distance is never longer than the vertical.
fn reach<M: LayerModel + ?Sized>(
    model: &M,
    settings: &ParamSettings,
    layer: usize,
    block: usize,
    touched: &Touched,
) -> f32 {
    let layers = model.layer_count();
    let (bottom, top) = horizons(layer, layers);
    let last = model.size()[2].saturating_sub(1) as f32;
    let sheet = |horizon| model.sheet(horizon, block as u16);
    let height = |x: i32, y: i32| match (settings.definition(layer, layers), bottom, top) {
        (_, None, None) => last,
        (_, Some(bottom), None) => sheet(bottom).node(x, y).min(last),
        (_, None, Some(top)) => last - sheet(top).node(x, y).max(0.0),
        (Some(KDefinition::DistanceRatio) | None, ..) => 0.0,
        (_, Some(bottom), Some(top)) => sheet(bottom).node(x, y).min(last) - sheet(top).node(x, y).max(0.0),
    };
    wanted_columns(touched).map(|[x, y]| height(x, y)).fold(0.0, f32::max)
}

fn wanted_columns(touched: &Touched) -> impl Iterator<Item = [i32; 2]> {
    let [_, ny] = touched.size;
    touched
        .wanted
        .iter()
        .enumerate()
        .filter(|(_, wanted)| **wanted)
        .map(move |(n, _)| [touched.origin[0] + (n / ny) as i32, touched.origin[1] + (n % ny) as i32])
}

/// The empty grid of a region, and how to make its sheets.
fn plan<'a, M: LayerModel + ?Sized>(
    model: &'a M,
    settings: &ParamSettings,
    metric: &'a Metric,
    region: Region,
    touched: &'a Touched,
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
    let thickest = wanted_columns(touched)
        .map(|[x, y]| node(bottom, x, y) - node(top, x, y))
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
        Some(horizon) => Surface::new(model.sheet(horizon, region.block), sheet.shift),
        None => Surface::new(&HeightField::from_fn(touched.origin, touched.size, |_, _| 0.0), sheet.shift),
    };
    (grid, move || Layer { bottom: surface(bottom), top: surface(top), kind, metric: *metric })
}
