//! What is computed for each region: its sheets, levels and reference thickness, and the method.

use crate::columns::RegionColumns;
use crate::flow;
use crate::flow::calm::calm;
use crate::flow::harmonic::{Ends, FarBeds, Spacing};
use crate::grid::{RegionGrid, SheetRef, SheetSource};
use crate::layer::{Layer, LayerKind};
use crate::metric::Metric;
use crate::surface::BicubicSheet;
use crate::tips;
use crate::weight;
use crate::{KDefinition, LayerModel, ParamSettings, Region};
use glam::{DMat3, DVec3, Vec3};
use rayon::prelude::*;
use std::sync::Arc;
use survey::{Cancelled, HeightField, LevelField, Progress};

/// Fewest levels of a grid; the cubic along a column uses four.
const FEWEST_LEVELS: usize = 5;
/// How far beyond an open layer the plane lies through which its flow is even, in reference thicknesses.
const BEYOND: f32 = 0.25;
/// Share of the waves that calm sheets are without over which it is averaged how near those of two blocks are.
const SHARED: f64 = 0.5;

/// How a region is computed.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Method {
    /// By closest points ([`crate::compute`]).
    Closest(LayerKind),
    /// As a flow ([`crate::flow`]).
    Flow(flow::Flow),
    /// By arc length, k from the surfaces themselves ([`crate::unfold`]).
    Unfolded,
}

/// Horizons at the bottom and the top of a layer. Bodies bound nothing: they cut what is there, and inside them the rock
/// is not layered.
pub(crate) fn horizons<M: LayerModel + ?Sized>(model: &M, layer: usize) -> (Option<usize>, Option<usize>) {
    let layers = model.layer_count();
    let top = (layer + 1 < layers).then(|| layers - 2 - layer);
    if top.is_some_and(|top| model.is_body(top)) {
        return (None, None);
    }
    ((layers - 1 - layer..layers - 1).find(|&h| !model.is_body(h)), top)
}

/// Whether a horizon at the bottom or the top of a region is no height field.
pub(crate) fn is_unfolded<M: LayerModel + ?Sized>(model: &M, region: Region) -> bool {
    let (bottom, top) = horizons(model, usize::from(region.layer));
    [bottom, top].into_iter().flatten().any(|h| model.level(h, region.block).is_some())
}

/// Plans the regions of a model.
pub(crate) struct Planner<'a, M: ?Sized> {
    model: &'a M,
    settings: &'a ParamSettings,
    metric: &'a Metric,
    /// Calm sheets by `horizon · blocks + block`; empty where the flow follows the horizons exactly.
    calm: Vec<Arc<HeightField>>,
    /// Voxels between the nodes on which flows are solved.
    pub stride: usize,
}

impl<'a, M: LayerModel + ?Sized> Planner<'a, M> {
    /// Prepares the sheets of a model.
    pub(crate) fn new(model: &'a M, settings: &'a ParamSettings, metric: &'a Metric) -> Self {
        let (layers, blocks) = (model.layer_count(), model.block_count());
        let is_calm = |layer| !matches!(settings.definition(layer, layers), None | Some(KDefinition::DistanceRatio));
        let steps = model.metric();
        let wave = [0, 1].map(|axis| settings.flow_wave_m / steps.col(axis).length());
        let calm = if settings.flow_wave_m > 0.0 && (0..layers).any(is_calm) {
            let of_horizon = |horizon: usize| {
                let drawn: Vec<&HeightField> = (0..blocks as u16).map(|block| model.sheet(horizon, block)).collect();
                let calm = drawn.par_iter().map(|sheet| calm(sheet, wave)).collect();
                tips::mean_of_sheets(&drawn, calm, wave.map(|wave| wave * SHARED))
            };
            (0..layers - 1).into_par_iter().flat_map(of_horizon).map(Arc::new).collect()
        } else {
            Vec::new()
        };
        Self { model, settings, metric, calm, stride: flow::stride(wave[0].min(wave[1])) }
    }

    fn definition(&self, region: Region) -> Option<KDefinition> {
        self.settings.definition(usize::from(region.layer), self.model.layer_count())
    }

    /// The sheet of a horizon that a definition of k is measured from.
    fn source(&self, horizon: usize, region: Region) -> SheetSource {
        let calm = self.calm.get(horizon * self.model.block_count() + usize::from(region.block));
        match (self.definition(region), calm) {
            (Some(KDefinition::DistanceRatio), _) | (_, None) => SheetSource::Horizon(horizon),
            (_, Some(calm)) => SheetSource::Calm(Arc::clone(calm)),
        }
    }

    /// The unshifted sheets at the bottom and the top of a region.
    fn sheets(&self, region: Region) -> (Option<SheetRef>, Option<SheetRef>) {
        let (bottom, top) = horizons(self.model, usize::from(region.layer));
        let sheet = |horizon| SheetRef { of: self.source(horizon, region), shift: 0.0 };
        (bottom.map(sheet), top.map(sheet))
    }

    /// Vertical distance (voxels) from the reference sheet of an open or parallel layer to the farthest point of
    /// the region; the reference thickness has to cover it. The shortest distance to the sheet is never longer.
    pub(crate) fn farthest(&self, region: Region, touched: &RegionColumns) -> f32 {
        if is_unfolded(self.model, region) {
            return self.farthest_unfolded(region, touched);
        }
        let (bottom, top) = self.sheets(region);
        let last = self.model.size()[2].saturating_sub(1) as f32;
        let node = |sheet: &SheetRef, [x, y]: [i32; 2]| sheet.node(self.model, region.block, x, y);
        // An open layer reaches to the edge of the volume, a closed one as far as the region was found.
        let met =
            |column: [i32; 2], z: f32| self.model.region_at(Vec3::new(column[0] as f32, column[1] as f32, z)) == region;
        let step = 2.0;
        let depths_met = |column: [i32; 2], depths: [f32; 2]| {
            let (low, high) = (depths[0].max(0.0), depths[1].min(last));
            (0..=((high - low) / step) as usize).map(move |n| low + n as f32 * step).filter(move |&z| met(column, z))
        };
        // Where rock is gone, copies of a sheet go on from where it was, at most a volume's height outside of it.
        let beyond = match self.definition(region).unwrap_or_default() {
            KDefinition::Flow | KDefinition::Harmonic => 0.0,
            _ => last,
        };
        let height = |column: [i32; 2], depths: [f32; 2]| match (self.definition(region), &bottom, &top) {
            (_, Some(bottom), None) => node(bottom, column).min(last + beyond),
            (_, None, Some(top)) => last - node(top, column).max(-beyond),
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

    /// [`Planner::farthest`] from a surface of any shape: metres as vertical voxels.
    fn farthest_unfolded(&self, region: Region, touched: &RegionColumns) -> f32 {
        let horizon = match self.measured_from(region) {
            (Some(h), None) | (None, Some(h)) => h,
            _ => return 0.0,
        };
        let vertical = self.model.metric().z_axis.length() as f32;
        let offset_m = |p: Vec3| match self.model.level(horizon, region.block) {
            Some(level) => level.offset_m(p),
            None => (p.z - self.model.sheet(horizon, region.block).z_at(p.x, p.y)) * vertical,
        };
        let last = self.model.size()[2].saturating_sub(1) as f32;
        let columns = touched.columns().step_by(7);
        let offsets = columns.flat_map(|(_, [x, y], _)| {
            let place = move |n: usize| Vec3::new(x as f32, y as f32, (n * 4) as f32);
            let inside = (0..=(last / 4.0) as usize).map(place).filter(|&p| self.model.region_at(p) == region);
            inside.map(|p| offset_m(p).abs())
        });
        offsets.fold(0.0, f32::max) / vertical
    }

    /// The horizons at the bottom and the top of a layer between surfaces of any shape from which its k is measured: both,
    /// or the one to which it is parallel.
    fn measured_from(&self, region: Region) -> (Option<usize>, Option<usize>) {
        match (horizons(self.model, usize::from(region.layer)), self.definition(region)) {
            ((Some(bottom), Some(_)), Some(KDefinition::ParallelToBottom)) => (Some(bottom), None),
            ((Some(_), Some(top)), Some(KDefinition::ParallelToTop)) => (None, Some(top)),
            (both, _) => both,
        }
    }

    /// The empty grid of a region, the method that fills it, and the columns that it is filled in. `of_layer` has the columns of each block,
    /// `companions` the blocks that this one meets beyond tips, and itself ([`tips::Tips::companions`]). `reach` is the
    /// largest of [`Planner::farthest`] over the layer.
    pub(crate) fn plan(
        &self,
        region: Region,
        of_layer: &[&RegionColumns],
        companions: &[u16],
        reach: f32,
    ) -> (RegionGrid, Method, RegionColumns) {
        use KDefinition::{DistanceRatio, Flow, Harmonic, ParallelToBottom, ParallelToTop, Proportional};
        use flow::Flow::{Smooth, Vertical};
        let touched = of_layer[usize::from(region.block)];
        let last = self.model.size()[2].saturating_sub(1) as f32;
        let thickness = reach * self.metric.vertical_step();
        let parts = || companions.iter().map(|&block| (Region { block, ..region }, of_layer[usize::from(block)]));
        let definition = self.definition(region).unwrap_or_default();
        let spacing = if definition == Harmonic { Spacing::Harmonic } else { Spacing::Even };
        let shifted = |sheet: &SheetRef, shift: f32| SheetRef { shift, ..sheet.clone() };
        let plane = |shift| SheetRef { of: SheetSource::Plane, shift };
        let (method, bottom, top) = match (self.sheets(region), definition) {
            _ if is_unfolded(self.model, region) => {
                let (bottom, top) = self.measured_from(region);
                let sheet =
                    |h: Option<usize>| h.map_or(plane(0.0), |h| SheetRef { of: SheetSource::Horizon(h), shift: 0.0 });
                (Method::Unfolded, sheet(bottom), sheet(top))
            }
            ((None, None), _) => (Method::Closest(LayerKind::Vertical), plane(last.max(1.0)), plane(0.0)),
            ((Some(bottom), Some(top)), DistanceRatio) => (Method::Closest(LayerKind::Ratio), bottom, top),
            ((Some(bottom), Some(top)), Flow | Harmonic) => {
                (Method::Flow(Smooth(Ends::Both, Spacing::Harmonic)), bottom, top)
            }
            ((Some(bottom), None), Flow | Harmonic) => {
                let (plane, far) = self.far_plane(parts, reach, -1.0);
                (Method::Flow(Smooth(Ends::Bottom(far), spacing)), bottom, plane)
            }
            ((None, Some(top)), Flow | Harmonic) => {
                let (plane, far) = self.far_plane(parts, reach, 1.0);
                (Method::Flow(Smooth(Ends::Top(far), spacing)), plane, top)
            }
            ((Some(bottom), Some(top)), Proportional) => (Method::Flow(Vertical), bottom, top),
            ((Some(bottom), None), Proportional) => (Method::Flow(Vertical), bottom.clone(), shifted(&bottom, -reach)),
            ((None, Some(top)), Proportional) => (Method::Flow(Vertical), shifted(&top, reach), top),
            ((_, Some(top)), ParallelToTop) | ((None, Some(top)), ParallelToBottom | DistanceRatio) => {
                (Method::Closest(LayerKind::BelowTop(thickness)), shifted(&top, reach), top)
            }
            ((Some(bottom), _), ParallelToBottom | ParallelToTop | DistanceRatio) => {
                (Method::Closest(LayerKind::AboveBottom(thickness)), bottom.clone(), shifted(&bottom, -reach))
            }
        };
        let is_open = matches!(self.measured_from(region), (Some(_), None) | (None, Some(_)));
        let is_vertical = method == Method::Closest(LayerKind::Vertical);
        let thickness = if is_vertical { last.max(1.0) * self.metric.vertical_step() } else { thickness };
        let is_parallel =
            is_vertical || matches!(method, Method::Closest(LayerKind::AboveBottom(_) | LayerKind::BelowTop(_)));
        let filled = self.filled(touched, companions);
        let grid = RegionGrid {
            region,
            origin: filled.origin,
            size: if method == Method::Unfolded { [0; 2] } else { filled.size },
            levels: self.levels(region, &filled, method, &bottom, &top),
            bottom,
            top,
            thickness_m: (is_open || is_parallel).then(|| f64::from(thickness) * self.metric.unit_m),
            offsets: Vec::new(),
            creases: Vec::new(),
            unfolded: None,
        };
        (grid, method, filled)
    }

    /// The columns of a region, and those beyond it in which a block that goes on there takes the mean with it.
    fn filled(&self, touched: &RegionColumns, companions: &[u16]) -> RegionColumns {
        if companions.len() < 2 {
            return touched.clone();
        }
        let ([nx, ny, _], steps) = (self.model.size(), self.model.metric());
        let samples = tips::length_m(self.model) / steps.z_axis.length();
        touched.grown(tips::GROWN, samples as f32, [nx, ny])
    }

    /// ln w of the layers between surfaces of any shape in which k is harmonic, `[layer][block]`; none of the others.
    pub(crate) fn log_weights<'g>(
        &self,
        unfolded: &[u16],
        grid_of: impl Fn(Region) -> &'g RegionGrid + Sync,
        progress: &Progress,
    ) -> Result<Vec<Vec<LevelField>>, Cancelled> {
        let mut weights = vec![Vec::new(); self.model.layer_count()];
        for &layer in unfolded {
            let region = Region { layer, block: 0 };
            let is_closed = matches!(self.measured_from(region), (Some(_), Some(_)));
            if is_closed && self.definition(region) == Some(KDefinition::Harmonic) {
                let ratio = |p: Vec3, region: Region| grid_of(region).level_ratio(self.model, p).0;
                weights[usize::from(layer)] = weight::log_weights(self.model, layer, ratio, progress)?;
            }
        }
        Ok(weights)
    }

    /// Whether a region takes the mean with others beyond the tips of faults: the published definition stays as it is.
    pub(crate) fn is_joined(&self, region: Region, method: Method) -> bool {
        let is_published = self.definition(region) == Some(KDefinition::DistanceRatio);
        !is_published && !matches!(method, Method::Unfolded | Method::Closest(LayerKind::Vertical))
    }

    /// Count of levels of a region: odd for a flow, which has a middle one.
    fn levels(
        &self,
        region: Region,
        touched: &RegionColumns,
        method: Method,
        bottom: &SheetRef,
        top: &SheetRef,
    ) -> usize {
        let last = self.model.size()[2].saturating_sub(1) as f32;
        let node = |sheet: &SheetRef, x, y| sheet.node(self.model, region.block, x, y);
        let thickest = touched
            .columns()
            .map(|(_, [x, y], _)| node(bottom, x, y) - node(top, x, y))
            .fold(0.0, f32::max)
            .min(4.0 * (last + 1.0));
        let levels = ((thickest / self.settings.level_spacing).ceil() as usize + 1).max(FEWEST_LEVELS);
        match method {
            Method::Closest(LayerKind::Vertical) | Method::Unfolded => 3,
            Method::Closest(_) => levels,
            Method::Flow(_) => levels | 1,
        }
    }

    /// A plane along the trend of an open layer's horizon, beyond the region (`side` −1: above, 1: below), and the
    /// beds parallel to it: one for all `parts` (regions and their columns) of rock that faults do not sever.
    fn far_plane<'c, Parts>(&self, parts: impl Fn() -> Parts, reach: f32, side: f32) -> (SheetRef, FarBeds)
    where
        Parts: Iterator<Item = (Region, &'c RegionColumns)>,
    {
        let last = self.model.size()[2].saturating_sub(1) as f32;
        let nodes = || {
            parts().flat_map(|(region, touched)| {
                let (bottom, top) = self.sheets(region);
                let sheet = if side < 0.0 { bottom } else { top };
                let node = move |[x, y]: [i32; 2]| {
                    let z = sheet.as_ref().map_or(0.0, |sheet| sheet.node(self.model, region.block, x, y));
                    ([x, y], z)
                };
                touched.columns().map(move |(_, column, _)| node(column))
            })
        };
        let ([cx, cy], [px, py, p0]) = trend(nodes);
        let plane = |x: i32, y: i32| p0 + px * (x - cx) as f32 + py * (y - cy) as f32;
        let edge = if side < 0.0 { 0.0 } else { last };
        let shift = nodes().fold(0.0f32, |shift, ([x, y], z)| {
            let beyond_volume = side * (edge - plane(x, y)) + BEYOND * reach;
            let beyond_sheet = side * (z - plane(x, y)) + 2.0 * BEYOND * reach;
            shift.max(beyond_volume).max(beyond_sheet)
        });
        // A height field goes on evenly past its nodes.
        let far = HeightField::from_fn([cx, cy], [2, 2], |x, y| plane(x, y) + side * shift);
        let normal = Vec3::new(px, py, -1.0);
        let length = normal.dot(self.metric.raise(normal)).sqrt();
        let density = 1.0 / (reach * self.metric.vertical_step());
        let beds = FarBeds { rate: density / length, density };
        (SheetRef { of: SheetSource::Calm(Arc::new(far)), shift: 0.0 }, beds)
    }

    /// The sheets of a planned region as surfaces on which closest points are found.
    pub(crate) fn layer(&self, grid: &RegionGrid, touched: &RegionColumns, kind: LayerKind) -> Layer {
        let surface = |sheet: &SheetRef| match sheet.sheet(self.model, grid.region.block) {
            Some(field) => BicubicSheet::new(field, sheet.shift),
            None => BicubicSheet::new(&HeightField::from_fn(touched.origin, touched.size, |_, _| 0.0), sheet.shift),
        };
        Layer { bottom: surface(&grid.bottom), top: surface(&grid.top), kind, metric: *self.metric }
    }
}

/// The plane that fits nodes (voxel x, y; z) best: the column at their centre, and the slopes along x and y and the height
/// there.
fn trend<Nodes: Iterator<Item = ([i32; 2], f32)>>(nodes: impl Fn() -> Nodes) -> ([i32; 2], [f32; 3]) {
    let far = ([i32::MAX; 2], [i32::MIN; 2]);
    let (low, high) = nodes()
        .fold(far, |(low, high), (at, _)| ([0, 1].map(|n| at[n].min(low[n])), [0, 1].map(|n| at[n].max(high[n]))));
    if low[0] > high[0] {
        return ([0; 2], [0.0; 3]);
    }
    let [cx, cy] = [0, 1].map(|n| low[n] + (high[n] - low[n] + 1) / 2);
    let (mut normal, mut right) = (DMat3::ZERO, DVec3::ZERO);
    for ([x, y], z) in nodes() {
        let row = DVec3::new(f64::from(x - cx), f64::from(y - cy), 1.0);
        normal += DMat3::from_cols(row * row.x, row * row.y, row);
        right += row * f64::from(z);
    }
    let count = normal.z_axis.z;
    // One column, or one row of them, has no slope across.
    if normal.determinant() < 1e-6 * count.powi(3) {
        return ([cx, cy], [0.0, 0.0, (right.z / count) as f32]);
    }
    ([cx, cy], (normal.inverse() * right).as_vec3().to_array())
}
