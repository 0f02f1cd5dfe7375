//! The stratigraphic grid of one region: offsets from (x, y, v) to (i, j, k), and the lookup in it.
//!
//! v is the vertical fraction between the layer's sheets: 0 on the bottom sheet and 1 on the top sheet.
//! Columns of the grid are voxel columns, levels are evenly spaced in v. A node stores
//!
//! ```text
//! dx = i·(Nx−1) − x      dy = j·(Ny−1) − y      dk = k − v
//! ```
//!
//! dk = 0 on both sheets of a closed layer, so horizons are exact by construction at any resolution. A lookup
//! computes v from the two sheets, interpolates each of the four columns around by the cubic through four
//! levels, and interpolates bilinearly between the columns. (Along v the cubic gives gradients several times
//! better than linear interpolation at the same memory.) The Jacobian follows by the chain rule. Everything
//! is computed in f32 and in this order, so that a shader can do the same.
//!
//! Memory: 12 bytes a node and one bit for the crease flag.

use crate::columns::RegionColumns;
use crate::metric::Metric;
use crate::tricubic;
use crate::unfold::Unfolding;
use crate::weight;
use crate::{LayerModel, Region};
use glam::Vec3;
use std::sync::Arc;
use survey::{HeightField, LevelField};

/// A layer thinner than this (voxels) counts as pinched out: its offsets are 0 and v is ½.
pub(crate) const PINCHED: f32 = 1e-3;

/// Columns and samples between the places at which the rise of k is measured.
const RISES_EVERY: usize = 5;

/// A sheet that v is measured from: that of a horizon in the region's block, a calm one, or a horizontal plane,
/// shifted vertically.
#[derive(Debug, Clone, PartialEq)]
pub struct SheetRef {
    /// What is shifted.
    pub of: SheetSource,
    /// Voxels added to z (positive is down).
    pub shift: f32,
}

/// What a [`SheetRef`] shifts.
#[derive(Debug, Clone, PartialEq)]
pub enum SheetSource {
    /// The plane z = 0.
    Plane,
    /// The sheet of a horizon of the model, as it is drawn.
    Horizon(usize),
    /// A sheet of the parameterization's own, calmer than the horizon that is drawn.
    Calm(Arc<HeightField>),
}

impl SheetRef {
    /// Voxel z at voxel (x, y), and its slopes (∂z/∂x, ∂z/∂y).
    pub fn sample<M: LayerModel + ?Sized>(&self, model: &M, block: u16, x: f32, y: f32) -> (f32, [f32; 2]) {
        let Some(sheet) = self.sheet(model, block) else { return (self.shift, [0.0; 2]) };
        let sample = sheet.sample(x, y);
        (sample.z + self.shift, sample.gradient.to_array())
    }

    /// The sheet before it is shifted; `None` for the plane z = 0.
    pub fn sheet<'a, M: LayerModel + ?Sized>(&'a self, model: &'a M, block: u16) -> Option<&'a HeightField> {
        match &self.of {
            SheetSource::Plane => None,
            SheetSource::Horizon(horizon) => Some(model.sheet(*horizon, block)),
            SheetSource::Calm(sheet) => Some(sheet),
        }
    }

    /// Voxel z at a voxel column.
    pub fn node<M: LayerModel + ?Sized>(&self, model: &M, block: u16, x: i32, y: i32) -> f32 {
        self.sheet(model, block).map_or(0.0, |sheet| sheet.node(x, y)) + self.shift
    }

    /// Whether this is a sheet that the drawn horizon may lie beyond.
    pub fn is_calm(&self) -> bool {
        matches!(self.of, SheetSource::Calm(_))
    }

    /// Voxel z at voxel (x, y).
    pub fn z<M: LayerModel + ?Sized>(&self, model: &M, block: u16, x: f32, y: f32) -> f32 {
        self.sheet(model, block).map_or(0.0, |sheet| sheet.z_at(x, y)) + self.shift
    }
}

/// Flat coordinates of a point.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FlatPoint {
    /// Inline coordinate: 0 … 1 over the volume, may lie outside near the outer boundary.
    pub i: f32,
    /// Crossline coordinate, likewise.
    pub j: f32,
    /// 0 on the bottom of the layer, 1 on its top.
    pub k: f32,
    /// The region whose grid was used.
    pub region: Region,
}

/// The parameterization of one layer in one fault block.
#[derive(Debug, Clone, PartialEq)]
pub struct RegionGrid {
    /// The layer and fault block.
    pub region: Region,
    /// Voxel column of grid column (0, 0).
    pub origin: [i32; 2],
    /// Counts of columns along x and y; 0 when the region occupies no voxel column.
    pub size: [usize; 2],
    /// Count of levels: 3 where k is the vertical fraction, otherwise at least 5.
    pub levels: usize,
    /// Where v = 0.
    pub bottom: SheetRef,
    /// Where v = 1. In an open or parallel layer one of the two is the other shifted by the reference
    /// thickness.
    pub top: SheetRef,
    /// Reference thickness in metres (k = 0 … 1) of an open, parallel or unlayered layer, or one between surfaces of any
    /// shape.
    pub thickness_m: Option<f64>,
    /// `[dx, dy, dk]` per node `[x][y][level]`; dx and dy in voxels.
    pub offsets: Vec<[f32; 3]>,
    /// One bit per node, 64 a word, in the order of `offsets`. It is set where a closest point jumped along
    /// the node's trace, or the trace did not arrive at the middle.
    pub creases: Vec<u64>,
    /// (i, j) where a horizon of the layer is no height field. The grid then has no nodes; k follows from `bottom` and
    /// `top`, of which [`SheetSource::Plane`] stands for none.
    pub unfolded: Option<Unfolding>,
}

impl RegionGrid {
    /// Index of a node in [`RegionGrid::offsets`].
    #[inline]
    pub fn node(&self, x: usize, y: usize, level: usize) -> usize {
        (x * self.size[1] + y) * self.levels + level
    }

    /// Whether the trace of a node met a crease.
    pub fn is_crease(&self, node: usize) -> bool {
        self.creases[node / 64] >> (node % 64) & 1 == 1
    }

    /// Whether a node of the cell around voxel `p` met a crease.
    pub(crate) fn is_near_crease<M: LayerModel + ?Sized>(&self, model: &M, p: Vec3) -> bool {
        if self.offsets.is_empty() {
            return false;
        }
        let (v, _) = self.level_fraction(model, p);
        let at = [p.x - self.origin[0] as f32, p.y - self.origin[1] as f32, v * (self.levels - 1) as f32];
        let counts = [self.size[0], self.size[1], self.levels];
        // The cell and one more node on each side, because gradients are measured over a distance.
        let range = |axis: usize| {
            let low = (at[axis] - 1.0).max(0.0) as usize;
            low.min(counts[axis] - 1)..=((at[axis] + 2.0).max(0.0) as usize).min(counts[axis] - 1)
        };
        range(0).any(|x| range(1).any(|y| range(2).any(|level| self.is_crease(self.node(x, y, level)))))
    }

    /// Memory of the grid, bytes.
    pub fn bytes(&self) -> usize {
        self.offsets.len() * size_of::<[f32; 3]>() + self.creases.len() * size_of::<u64>()
    }

    /// v at `p`, clamped to the layer unless its sheets are calm, and its voxel derivative.
    fn level_fraction<M: LayerModel + ?Sized>(&self, model: &M, p: Vec3) -> (f32, Vec3) {
        let block = self.region.block;
        let (bottom, bottom_slope) = self.bottom.sample(model, block, p.x, p.y);
        let (top, top_slope) = self.top.sample(model, block, p.x, p.y);
        let thickness = bottom - top;
        if thickness < PINCHED {
            return (0.5, Vec3::ZERO);
        }
        let inverse = 1.0 / thickness;
        let v = (bottom - p.z) * inverse;
        let along = |axis: usize| (bottom_slope[axis] * (1.0 - v) + top_slope[axis] * v) * inverse;
        let slope = Vec3::new(along(0), along(1), -inverse);
        (if self.is_calm() { v } else { v.clamp(0.0, 1.0) }, slope)
    }

    /// k between surfaces of any shape, continued beyond them, and its voxel derivative: [`RegionGrid::level_ratio`], or
    /// what its weight makes of it.
    pub(crate) fn level_k<M: LayerModel + ?Sized>(&self, model: &M, p: Vec3) -> (f32, Vec3) {
        let weight = self.unfolded.as_ref().and_then(|unfolded| unfolded.log_weight.as_ref());
        self.level_k_by(model, weight, p)
    }

    /// The same by this weight.
    pub(crate) fn level_k_by<M: LayerModel + ?Sized>(
        &self,
        model: &M,
        log_weight: Option<&LevelField>,
        p: Vec3,
    ) -> (f32, Vec3) {
        let ratio = self.level_ratio(model, p);
        log_weight.map_or(ratio, |field| weight::weighed(ratio, tricubic::sample(field, p)))
    }

    /// The share of the distances from both surfaces, or of the reference thickness where one is missing, continued beyond
    /// them; and its voxel derivative.
    pub(crate) fn level_ratio<M: LayerModel + ?Sized>(&self, model: &M, p: Vec3) -> (f32, Vec3) {
        let block = self.region.block;
        let below = |sheet: &SheetRef| match sheet.of {
            SheetSource::Horizon(horizon) => Some(match model.level(horizon, block) {
                // The trilinear field decides on regions, whose slopes jump from cell to cell.
                Some(level) => {
                    let (value, slope) = tricubic::sample(&level.field, p);
                    ((value - level.at) * level.scale_m, slope * level.scale_m)
                }
                None => {
                    let (z, [x, y]) = sheet.sample(model, block, p.x, p.y);
                    let vertical = model.metric().z_axis.length() as f32;
                    ((p.z - z) * vertical, Vec3::new(-x, -y, 1.0) * vertical)
                }
            }),
            _ => None,
        };
        let thickness = self.thickness_m.map_or(1.0, |thickness| thickness as f32);
        match (below(&self.bottom), below(&self.top)) {
            (Some((bottom, to_bottom)), Some((top, to_top))) => {
                // Distances from both, positive in the layer: −bottom and top.
                let sum = top - bottom;
                if sum.abs() < PINCHED {
                    return (0.5, Vec3::ZERO);
                }
                (-bottom / sum, (to_top * bottom - to_bottom * top) / (sum * sum))
            }
            (Some((bottom, slope)), None) => (-bottom / thickness, -slope / thickness),
            (None, Some((top, slope))) => (1.0 - top / thickness, -slope / thickness),
            (None, None) => (0.5, Vec3::ZERO),
        }
    }

    /// How fast k rises at places of the region, per metre.
    pub(crate) fn rises<M: LayerModel + ?Sized>(
        &self,
        model: &M,
        metric: &Metric,
        log_weight: Option<&LevelField>,
        touched: &RegionColumns,
        region: Region,
    ) -> Vec<f64> {
        let last = model.size()[2].saturating_sub(1);
        let covector = (metric.scaled_from_voxel() * metric.unit_m).inverse().transpose();
        let columns = touched.columns().step_by(RISES_EVERY);
        let places = columns.flat_map(|(_, [x, y], _)| {
            (0..=last).step_by(RISES_EVERY).map(move |z| Vec3::new(x as f32, y as f32, z as f32))
        });
        let inside = places.filter(|&p| model.region_at(p) == region);
        inside
            .map(|p| (covector * self.level_k_by(model, log_weight, p).1.as_dvec3()).length())
            .filter(|rate| *rate > 0.0)
            .collect()
    }

    /// Whether the layer is drawn with boundaries of its own: v then goes on beyond the sheets, and the offsets stay as
    /// they are on them.
    pub fn is_calm(&self) -> bool {
        self.bottom.is_calm() || self.top.is_calm()
    }

    /// Offsets and their derivatives along (x, y, v) at a column position and vertical fraction: cubic along
    /// four columns, then bilinear between them. Positions outside the grid take the nearest column.
    pub(crate) fn interpolate(&self, x: f32, y: f32, v: f32) -> ([f32; 3], [[f32; 3]; 3]) {
        if self.offsets.is_empty() {
            return ([0.0; 3], [[0.0; 3]; 3]);
        }
        let (cx, fx) = split(x - self.origin[0] as f32, self.size[0]);
        let (cy, fy) = split(y - self.origin[1] as f32, self.size[1]);
        let scale = (self.levels - 1) as f32;
        let (cell, fraction) = split(v * scale, self.levels);
        let scale = if (0.0..=1.0).contains(&v) { scale } else { 0.0 };
        let column = |a: usize, b: usize| {
            let start = self.node(cx + a, cy + b, 0);
            cubic(&self.offsets[start..start + self.levels], cell, fraction)
        };
        let corners = [column(0, 0), column(0, 1), column(1, 0), column(1, 1)];
        let mix = |low: f32, high: f32, t: f32| low + (high - low) * t;
        let mut value = [0.0; 3];
        let mut slope = [[0.0; 3]; 3];
        for n in 0..3 {
            let at = corners.map(|(value, _)| value[n]);
            let rise = corners.map(|(_, rise)| rise[n]);
            let (low, high) = (mix(at[0], at[1], fy), mix(at[2], at[3], fy));
            value[n] = mix(low, high, fx);
            slope[n] = [
                high - low,
                mix(at[1] - at[0], at[3] - at[2], fx),
                mix(mix(rise[0], rise[1], fy), mix(rise[2], rise[3], fy), fx) * scale,
            ];
        }
        (value, slope)
    }

    /// A voxel column of the grid.
    ///
    /// # Panics
    /// Outside the grid.
    pub(crate) fn column<M: LayerModel + ?Sized>(&self, model: &M, [x, y]: [i32; 2]) -> GridColumn<'_> {
        let [u, v] = [x - self.origin[0], y - self.origin[1]].map(|at| at as usize);
        let start = self.node(u, v, 0);
        let bottom = self.bottom.node(model, self.region.block, x, y);
        let thickness = bottom - self.top.node(model, self.region.block, x, y);
        GridColumn { offsets: &self.offsets[start..start + self.levels], bottom, thickness }
    }

    /// Flat coordinates of voxel `p` in this region's parameterization, and their Jacobian ∂(i, j, k)/∂(x, y,
    /// z) per voxel. `model` is the one that was parameterized and `volume` its [`LayerModel::size`].
    pub fn lookup<M: LayerModel + ?Sized>(&self, model: &M, volume: [usize; 3], p: Vec3) -> (FlatPoint, [[f32; 3]; 3]) {
        if let Some(unfolded) = &self.unfolded {
            return self.lookup_unfolded(unfolded, model, volume, p);
        }
        let (v, v_slope) = self.level_fraction(model, p);
        let ([dx, dy, dk], slope) = self.interpolate(p.x, p.y, v);
        let [si, sj] = [0, 1].map(|axis: usize| 1.0 / volume[axis].saturating_sub(1).max(1) as f32);
        let row = |n: usize, unit: Vec3, scale: f32| {
            ((unit + Vec3::new(slope[n][0], slope[n][1], 0.0) + v_slope * slope[n][2]) * scale).to_array()
        };
        let flat = FlatPoint { i: (p.x + dx) * si, j: (p.y + dy) * sj, k: v + dk, region: self.region };
        (flat, [row(0, Vec3::X, si), row(1, Vec3::Y, sj), row(2, v_slope, 1.0)])
    }
}

impl RegionGrid {
    fn lookup_unfolded<M: LayerModel + ?Sized>(
        &self,
        unfolded: &Unfolding,
        model: &M,
        volume: [usize; 3],
        p: Vec3,
    ) -> (FlatPoint, [[f32; 3]; 3]) {
        let (k, k_slope) = self.level_k(model, p);
        let is_closed = [&self.bottom, &self.top].iter().all(|sheet| matches!(sheet.of, SheetSource::Horizon(_)));
        let k = if is_closed { k.clamp(0.0, 1.0) } else { k };
        let [(i, i_slope), (j, j_slope)] = [0, 1].map(|axis: usize| {
            let unit = 1.0 / volume[axis].saturating_sub(1).max(1) as f32;
            let (value, slope) = tricubic::sample(&unfolded.places[axis], p);
            (value * unit, slope * unit)
        });
        let flat = FlatPoint { i, j, k, region: self.region };
        (flat, [i_slope.to_array(), j_slope.to_array(), k_slope.to_array()])
    }
}

/// One voxel column of a [`RegionGrid`].
pub(crate) struct GridColumn<'a> {
    offsets: &'a [[f32; 3]],
    bottom: f32,
    thickness: f32,
}

impl GridColumn<'_> {
    /// What is added to (x, y, v) at voxel z, where v is measured between other sheets.
    pub(crate) fn offsets(&self, z: f32, v: f32) -> Vec3 {
        let own_v = if self.thickness < PINCHED { 0.5 } else { (self.bottom - z) / self.thickness };
        let (cell, fraction) = split(own_v * (self.offsets.len() - 1) as f32, self.offsets.len());
        let ([dx, dy, dk], _) = cubic(self.offsets, cell, fraction);
        Vec3::new(dx, dy, own_v + dk - v)
    }
}

/// Cell and fraction of a position among `count` nodes, clamped to the nodes. `count` is at least 2.
#[inline]
pub(crate) fn split(at: f32, count: usize) -> (usize, f32) {
    let at = at.clamp(0.0, (count - 1) as f32);
    let cell = (at as usize).min(count - 2);
    (cell, at - cell as f32)
}

/// Value and slope (per level) of a column's curve between levels `cell` and `cell + 1`: Catmull–Rom through
/// four levels. Beyond the ends, the missing level continues the parabola through the last three.
#[inline]
pub(crate) fn cubic(column: &[[f32; 3]], cell: usize, t: f32) -> ([f32; 3], [f32; 3]) {
    let last = column.len() - 1;
    let (b, c) = (column[cell], column[cell + 1]);
    let mut value = [0.0; 3];
    let mut slope = [0.0; 3];
    for n in 0..3 {
        let (b, c) = (b[n], c[n]);
        let a = if cell > 0 { column[cell - 1][n] } else { 3.0 * (b - c) + column[cell + 2][n] };
        let d = if cell + 2 <= last { column[cell + 2][n] } else { 3.0 * (c - b) + column[cell - 1][n] };
        let (linear, square, cube) = (c - a, 2.0 * a - 5.0 * b + 4.0 * c - d, 3.0 * (b - c) + d - a);
        value[n] = b + 0.5 * t * (linear + t * (square + t * cube));
        slope[n] = 0.5 * (linear + t * (2.0 * square + 3.0 * t * cube));
    }
    (value, slope)
}
