//! The visible part of the stratigraphic grids, on the GPU.
//!
//! Faces are planes and the ground is a surface, so of each column only the levels around them are needed; a
//! whole parameterization may be larger than a device can bind. Each column has an entry in a table: its
//! first node in the offsets, its first level, and their count (0: not visible). A range of levels includes
//! those that the cubic interpolation along a column needs beyond it. Around a horizontal plane or the
//! ground, a range covers those of the neighbouring columns, because the surface crosses other levels between
//! columns.
//!
//! Memory: 8 bytes per column of each region and 12 per visible node: a few per cent of the parameterization.

use super::layout::GridInfo;
use crate::error::RenderError;
use crate::gpu::Gpu;
use crate::outline::solid::{Face, faces};
use crate::resolved_scene::{ResolvedScene, shows_depths};
use glam::DVec3;
use model::StructuralModel;
use param::{Parameterization, RegionGrid, SheetRef, SheetSource};
use rayon::prelude::*;
use std::sync::Arc;
use survey::block::part_behind;
use ttf::tables::NONE;

/// Thickness below which a layer has no inside, voxels, as in `param` and the shader.
pub(super) const PINCHED: f32 = 1e-3;
/// Extra levels around a range, for rounding and for sheets that are curved between columns.
const SPARE_LEVELS: f32 = 1.0;
/// A plane that is this many levels outside a layer is not visible in it.
const FAR_LEVELS: f32 = 3.0;
/// A plane with less of its unit normal along z than this is a wall: it crosses many levels from column to column.
const STEEP: f32 = 0.3;

/// The parts of the grids that are visible: faces towards the camera, and the ground of a box.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct VisibleParts {
    faces: Vec<Face>,
    ground: Option<[DVec3; 2]>,
    /// Whether all of the inside of the block is needed.
    inside: bool,
}

impl VisibleParts {
    /// The visible parts of a scene.
    pub(super) fn of(resolved: &ResolvedScene) -> Self {
        let mut faces = faces(&resolved.solid, &resolved.view);
        faces.retain(|face| face.faces_camera);
        let ground = resolved.relief.as_ref().map(|_| resolved.solid.roaming_box.map(|corner| corner.as_dvec3()));
        Self { faces, ground, inside: shows_depths(resolved.scene) }
    }
}

/// The visible parts of the grids on the GPU.
pub(super) struct GridBuffers {
    pub infos: wgpu::Buffer,
    pub columns: wgpu::Buffer,
    pub offsets: wgpu::Buffer,
    pub seen: VisibleParts,
}

impl GridBuffers {
    /// Uploads what is visible. `unfolded` says where the pool of the model holds the unfolded layers.
    pub(super) fn new(
        gpu: &Gpu,
        model: &StructuralModel,
        param: &Parameterization,
        unfolded: &[[u32; 3]],
        seen: VisibleParts,
    ) -> Result<Self, RenderError> {
        let windows: Vec<Vec<LevelRange>> = param.grids.par_iter().map(|grid| windows(model, grid, &seen)).collect();
        let mut infos = Vec::new();
        let mut columns: Vec<[u32; 2]> = Vec::new();
        let mut offsets: Vec<[f32; 3]> = Vec::new();
        let (calm, unfoldings) = (param.calm_sheets(), param.unfoldings());
        let (horizons, blocks) = (param.layers - 1, param.blocks);
        // As `ModelBuffers` lays sheets out: those of the horizons, then the calm ones.
        let index = |grid: &RegionGrid, sheet: &SheetRef| match &sheet.of {
            SheetSource::Plane => NONE,
            SheetSource::Horizon(horizon) => (horizon * blocks + usize::from(grid.region.block)) as u32,
            SheetSource::Calm(sheet) => {
                let position = calm.iter().position(|known| Arc::ptr_eq(known, sheet));
                position.map_or(NONE, |position| (horizons * blocks + position) as u32)
            }
        };
        for (grid, windows) in param.grids.iter().zip(&windows) {
            let place = |of_layer| unfoldings.iter().position(|known| Arc::ptr_eq(known, of_layer));
            let fields = grid.unfolded.as_ref().and_then(place).map_or([NONE; 3], |n| unfolded[n]);
            let [unfolded_i, unfolded_j, log_weight] = fields;
            infos.push(GridInfo {
                origin: grid.origin,
                size: grid.size.map(|n| n as u32),
                levels: grid.levels as u32,
                first_column: columns.len() as u32,
                bottom_sheet: index(grid, &grid.bottom),
                top_sheet: index(grid, &grid.top),
                bottom_shift: grid.bottom.shift,
                top_shift: grid.top.shift,
                is_calm: u32::from(grid.is_calm()),
                unfolded_i,
                unfolded_j,
                log_weight,
                thickness_m: grid.thickness_m.map_or(1.0, |thickness| thickness as f32),
                padding: 0,
            });
            for (column, window) in windows.iter().enumerate() {
                let count = window.end.saturating_sub(window.first);
                columns.push([offsets.len() as u32, u32::from(window.first) | u32::from(count) << 16]);
                let start = column * grid.levels + usize::from(window.first);
                offsets.extend_from_slice(&grid.offsets[start..start + usize::from(count)]);
            }
        }
        if offsets.len() * 3 > gpu.buffer_floats || columns.len() * 2 > gpu.buffer_floats {
            return Err(RenderError::OutOfMemory {
                reason: format!("the visible faces need {} MiB of the parameterization", (offsets.len() * 12) >> 20),
            });
        }
        Ok(Self {
            infos: gpu.storage("grids", bytemuck::cast_slice(&infos)),
            columns: gpu.storage("columns", bytemuck::cast_slice(&columns)),
            offsets: gpu.storage("offsets", bytemuck::cast_slice(&offsets)),
            seen,
        })
    }
}

/// The visible levels of a column: `first..end`, none if they are equal.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
struct LevelRange {
    first: u16,
    end: u16,
}

impl LevelRange {
    const NONE: Self = Self { first: 0, end: 0 };

    fn join(&mut self, other: Self) {
        if self.first == self.end {
            *self = other;
        } else if other.first != other.end {
            *self = Self { first: self.first.min(other.first), end: self.end.max(other.end) };
        }
    }
}

/// The range of levels of each column of a grid, `[x][y]`.
fn windows(model: &StructuralModel, grid: &RegionGrid, seen: &VisibleParts) -> Vec<LevelRange> {
    let [nx, ny] = grid.size;
    let mut windows = vec![LevelRange::NONE; nx * ny];
    if windows.is_empty() || grid.offsets.is_empty() {
        return windows;
    }
    let whole = LevelRange { first: 0, end: grid.levels.min(usize::from(u16::MAX)) as u16 };
    if seen.inside {
        windows.fill(whole);
        return windows;
    }
    // The columns around an interval of positions along an axis, as the lookup clamps them.
    let around = |low: f64, high: f64, axis: usize| {
        let cell = |at: f64| {
            let last = (grid.size[axis] - 1) as f64;
            ((at - f64::from(grid.origin[axis])).clamp(0.0, last) as usize).min(grid.size[axis] - 2)
        };
        cell(low)..=cell(high) + 1
    };
    for face in &seen.faces {
        let [low, high] = face.bounds();
        let (normal, offset) = (face.plane.normal, face.plane.offset);
        if normal.z.abs() > STEEP {
            let z = |x: f32, y: f32| (offset - normal.x * x - normal.y * y) / normal.z;
            let columns = |axis| around(low[axis], high[axis], axis);
            add_windows(&mut windows, grid, &plane_levels(model, grid, z), columns(0), columns(1));
            continue;
        }
        // A wall crosses few of the columns around it.
        for x in around(low.x, high.x, 0) {
            let at = f64::from(grid.origin[0]) + x as f64;
            let slab = part_behind(&part_behind(&face.outline, |p| p.x - at - 1.0), |p| at - 1.0 - p.x);
            // Columns beyond the survey's grid stand for those at its border.
            let seen = if slab.is_empty() { &face.outline } else { &slab };
            let ys = seen.iter().map(|p| p.y);
            let (from, to) = ys.fold((f64::MAX, f64::MIN), |(from, to), y| (from.min(y), to.max(y)));
            for y in around(from, to, 1) {
                windows[x * ny + y].join(whole);
            }
        }
    }
    if let Some([low, high]) = seen.ground {
        let levels = plane_levels(model, grid, |x, y| model.horizon_z(0, grid.region.block, x, y));
        add_windows(&mut windows, grid, &levels, around(low.x, high.x, 0), around(low.y, high.y, 1));
    }
    windows
}

/// The level, not clamped, at which a surface crosses each column; NaN if the layer has no inside there.
fn plane_levels(model: &StructuralModel, grid: &RegionGrid, z: impl Fn(f32, f32) -> f32) -> Vec<f32> {
    let [_, ny] = grid.size;
    let sheet = |sheet: &SheetRef, x: f32, y: f32| sheet.z(model, grid.region.block, x, y);
    (0..grid.size[0] * ny)
        .map(|n| {
            let x = (grid.origin[0] + (n / ny) as i32) as f32;
            let y = (grid.origin[1] + (n % ny) as i32) as f32;
            let (bottom, top) = (sheet(&grid.bottom, x, y), sheet(&grid.top, x, y));
            let thickness = bottom - top;
            if thickness < PINCHED { f32::NAN } else { (bottom - z(x, y)) / thickness * (grid.levels - 1) as f32 }
        })
        .collect()
}

/// Extends the ranges of columns to the levels that a surface crosses in them and in their neighbours.
fn add_windows(
    windows: &mut [LevelRange],
    grid: &RegionGrid,
    levels: &[f32],
    xs: std::ops::RangeInclusive<usize>,
    ys: std::ops::RangeInclusive<usize>,
) {
    let [nx, ny] = grid.size;
    let last = (grid.levels - 1) as f32;
    for x in xs {
        for y in ys.clone() {
            let (mut low, mut high) = (f32::MAX, f32::MIN);
            for nx in x.saturating_sub(1)..=(x + 1).min(nx - 1) {
                for ny_ in y.saturating_sub(1)..=(y + 1).min(ny - 1) {
                    let level = levels[nx * ny + ny_];
                    // Where the layer has no inside, the lookup uses the middle level.
                    let level = if level.is_nan() { 0.5 * last } else { level };
                    (low, high) = (low.min(level), high.max(level));
                }
            }
            if high < -FAR_LEVELS || low > last + FAR_LEVELS {
                continue;
            }
            // The cell, one level below it, and two above.
            let first = (low - SPARE_LEVELS).clamp(0.0, last).floor() - 1.0;
            let end = (high + SPARE_LEVELS).clamp(0.0, last).floor() + 3.0;
            // At the ends, the cubic needs the last three levels.
            let first = first.min(last - 2.0).max(0.0);
            let end = end.max(3.0).min(last + 1.0);
            windows[x * ny + y].join(LevelRange { first: first as u16, end: end as u16 });
        }
    }
}
