//! A parameterization of rock whose flat coordinates are known at every place, such as that of a geological history.
//!
//! Nothing is traced and no flow is solved: the nodes of the stratigraphic grids ([`crate::grid`]) take i, j and k as they
//! are. A grid lies between the sheets that are surfaces of its rock's own bedding. Where one of them is not (an
//! unconformity cut the bed off, or it fills what lay below it), the grid is measured from the other one alone, and k in the
//! reference thickness of such a layer.
//!
//! Where a horizon is no height field, i and j become an unfolding and k stays the share of the distances from both
//! surfaces.

use crate::columns::RegionColumns;
use crate::compute::level_range;
use crate::grid::{PINCHED, RegionGrid};
use crate::metric::Metric;
use crate::plan::{self, Method, Planner};
use crate::unfold::Unfolded;
use crate::{ComputeCost, KDefinition, LayerModel, ParamError, ParamSettings, Parameterization, Region};
use glam::Vec3;
use rayon::prelude::*;
use std::sync::Arc;
use survey::{LevelField, Progress};

/// Rock whose flat coordinates are known at every place.
pub trait KnownPlaces: Sync {
    /// i·(Nx − 1), j·(Ny − 1) and k at voxel position `p`, as if the rock of the region went on there; `None` where the region
    /// has none that is known.
    fn place(&self, region: Region, p: Vec3) -> Option<Vec3>;

    /// Metres from k = 0 to k = 1; `None` for rock without beds, whose k is then the vertical fraction.
    fn thickness_m(&self, region: Region) -> Option<f64>;
}

/// A sheet whose k is this near to 0 or 1 is a surface of the bed.
const OWN_K: f32 = 0.02;
/// The share of its places at which it has to be.
const OWN_SHARE: f64 = 0.95;
/// Voxels between the nodes of unfoldings, and around the volume.
const UNFOLDED_STEP: f32 = 2.0;
const MARGIN: f32 = 4.0;

impl Parameterization {
    /// The parameterization of a model whose i, j and k are known.
    ///
    /// Memory: 12 bytes a node.
    ///
    /// # Errors
    /// As [`Parameterization::compute`].
    pub fn of_known<M: LayerModel + ?Sized>(
        model: &M,
        known: &impl KnownPlaces,
        settings: &ParamSettings,
        progress: &Progress,
    ) -> Result<Self, ParamError> {
        let (size, layers, blocks) = (model.size(), model.layer_count(), model.block_count());
        settings.validate(layers)?;
        if size.contains(&0) || layers == 0 || blocks == 0 {
            return Err(ParamError::Empty { size });
        }
        let metric = Metric::new(model.metric(), settings.exaggeration)?;
        let definitions = (0..layers).map(|layer| definition(model, known, layer)).collect();
        let settings = ParamSettings { definitions, flow_wave_m: 0.0, ..settings.clone() };
        let planner = Planner::new(model, &settings, &metric);
        let planned = Self::plan(model, &planner, progress)?;
        let mut grids = Vec::with_capacity(planned.len());
        for (mut grid, method, touched) in planned {
            let definition = settings.definition(usize::from(grid.region.layer), layers).unwrap_or_default();
            if method == Method::Unfolded {
                if grid.thickness_m.is_none() {
                    let rates = grid.rises(model, &metric, None, &touched, grid.region);
                    let count = rates.len().max(1) as f64;
                    grid.thickness_m = Some((-rates.iter().map(|rate| rate.ln()).sum::<f64>() / count).exp());
                }
                grid.unfolded = Some(unfolded(model, known, grid.region));
            } else if !touched.depths.is_empty() {
                fill(model, known, &mut grid, definition, &touched);
            }
            progress.step(touched.size[0] as u64)?;
            grids.push(grid);
        }
        Ok(Self { size, layers, blocks, grids, cost: ComputeCost::default() })
    }
}

/// Which of the sheets around a layer are surfaces of its own bedding.
fn definition<M: LayerModel + ?Sized>(model: &M, known: &impl KnownPlaces, layer: usize) -> KDefinition {
    let (bottom, top) = plan::horizons(model, layer);
    let [nx, ny, nz] = model.size();
    let is_own = |horizon: Option<usize>, k: f32| {
        let Some(horizon) = horizon else { return false };
        let (mut all, mut own) = (0usize, 0usize);
        for block in 0..model.block_count() as u16 {
            let region = Region { layer: layer as u16, block };
            if known.thickness_m(region).is_none() || model.level(horizon, block).is_some() {
                continue;
            }
            for (x, y) in (0..nx).step_by(5).flat_map(|x| (0..ny).step_by(5).map(move |y| (x as f32, y as f32))) {
                let p = Vec3::new(x, y, model.sheet(horizon, block).z_at(x, y));
                // Where the layer itself is: elsewhere its sheets do not matter.
                let inside = p + Vec3::Z * if k > 0.5 { 0.5 } else { -0.5 };
                if inside.z < 0.0 || inside.z > (nz - 1) as f32 || model.region_at(inside) != region {
                    continue;
                }
                all += 1;
                own += usize::from(known.place(region, p).is_some_and(|place| (place.z - k).abs() < OWN_K));
            }
        }
        own as f64 >= OWN_SHARE * all as f64
    };
    match (is_own(bottom, 0.0), is_own(top, 1.0)) {
        (true, true) => KDefinition::DistanceRatio,
        (true, false) => KDefinition::ParallelToBottom,
        (false, _) => KDefinition::ParallelToTop,
    }
}

/// Fills the nodes of a grid.
fn fill<M: LayerModel + ?Sized>(
    model: &M,
    known: &impl KnownPlaces,
    grid: &mut RegionGrid,
    definition: KDefinition,
    touched: &RegionColumns,
) {
    let ([_, ny], levels, region) = (grid.size, grid.levels, grid.region);
    // k of the bed in the reference thickness of a layer that is measured from one sheet.
    let scaled = |k: f32| match (known.thickness_m(region), grid.thickness_m) {
        (Some(of_bed), Some(of_layer)) if definition == KDefinition::ParallelToBottom => k * (of_bed / of_layer) as f32,
        (Some(of_bed), Some(of_layer)) => 1.0 - (1.0 - k) * (of_bed / of_layer) as f32,
        _ => k,
    };
    let is_bedded = known.thickness_m(region).is_some();
    let mut offsets = vec![[0.0f32; 3]; grid.size[0] * ny * levels];
    offsets.par_chunks_mut(levels).enumerate().filter(|(column, _)| touched.is_wanted(*column)).for_each(
        |(column, offsets)| {
            let [x, y] = [grid.origin[0] + (column / ny) as i32, grid.origin[1] + (column % ny) as i32];
            let bottom = grid.bottom.node(model, region.block, x, y);
            let thickness = bottom - grid.top.node(model, region.block, x, y);
            let offset = |z: f32, v: Option<f32>| {
                let place = known.place(region, Vec3::new(x as f32, y as f32, z)).filter(|place| place.is_finite());
                let dk = |k: f32| v.filter(|_| is_bedded).map_or(0.0, |v| scaled(k) - v);
                place.map_or([0.0; 3], |place| [place.x - x as f32, place.y - y as f32, dk(place.z)])
            };
            if thickness < PINCHED {
                offsets.fill(offset(bottom, None));
                return;
            }
            let (first, last) = level_range(levels, bottom, thickness, touched.depths[column]);
            for (level, of_level) in offsets.iter_mut().enumerate().take(last + 1).skip(first) {
                let v = level as f32 / (levels - 1) as f32;
                *of_level = offset(bottom - thickness * v, Some(v));
            }
            let (low, high) = (offsets[first], offsets[last]);
            offsets[..first].fill(low);
            offsets[last + 1..].fill(high);
        },
    );
    grid.creases = vec![0; offsets.len().div_ceil(64)];
    grid.offsets = offsets;
}

/// i and j of a region between surfaces of any shape.
fn unfolded<M: LayerModel + ?Sized>(model: &M, known: &impl KnownPlaces, region: Region) -> Arc<Unfolded> {
    let last = Vec3::from_array(model.size().map(|n| n.saturating_sub(1) as f32));
    let origin = Vec3::splat(-MARGIN);
    let size = ((last + 2.0 * MARGIN) / UNFOLDED_STEP).ceil().to_array().map(|n| n as usize + 1);
    let places: Vec<Vec3> = (0..size.iter().product::<usize>())
        .into_par_iter()
        .map(|n| {
            let index = [n / (size[1] * size[2]), n / size[2] % size[1], n % size[2]];
            let p = origin + Vec3::from_array(index.map(|n| n as f32)) * UNFOLDED_STEP;
            known.place(region, p).filter(|place| place.is_finite()).unwrap_or(p)
        })
        .collect();
    let field = |axis: usize| LevelField {
        origin,
        step: Vec3::splat(UNFOLDED_STEP),
        size,
        values: places.iter().map(|place| place[axis]).collect(),
    };
    Arc::new(Unfolded { places: [field(0), field(1)], log_weight: None })
}
