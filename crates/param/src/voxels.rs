//! The parameterization sampled on a lattice: the arrays i, j, k, layer and block of a project on disk.
//!
//! Along an axis, sample p of M lies at voxel p·(N−1)/(M−1) of N (the lattice is corner-aligned with the
//! volume). Values are *evaluated* there by the exact lookup, not resampled.
//!
//! Memory: 16 bytes a sample.

use crate::grid::{PINCHED, RegionGrid, cubic, split};
use crate::{LayerModel, ParamError, Parameterization, Region};
use glam::Vec3;
use rayon::prelude::*;
use survey::{Progress, Volume};

/// Layer and block of a sample that belongs to no region.
pub const NO_REGION: u16 = u16::MAX;

/// i, j, k and the region at every sample of a lattice that spans the survey.
#[derive(Debug, Clone, PartialEq)]
pub struct VoxelParameterization {
    /// Counts of samples `[inlines, crosslines, samples]`.
    pub size: [usize; 3],
    /// Inline coordinate, NaN where there is no region.
    pub i: Volume<f32>,
    /// Crossline coordinate, likewise.
    pub j: Volume<f32>,
    /// 0 on the bottom of the sample's layer, 1 on its top.
    pub k: Volume<f32>,
    /// Layer, 0 = deepest; [`NO_REGION`] for none.
    pub layer: Volume<u16>,
    /// Fault block; [`NO_REGION`] for none.
    pub block: Volume<u16>,
}

/// Voxel position of sample `sample` of `samples` in a corner-aligned lattice over `voxels` voxels.
///
/// ```
/// // Five samples over nine voxels: every second voxel.
/// let at: Vec<f32> = (0..5).map(|sample| param::corner_aligned(sample, 5, 9)).collect();
/// assert_eq!(at, [0.0, 2.0, 4.0, 6.0, 8.0]);
/// ```
pub fn corner_aligned(sample: usize, samples: usize, voxels: usize) -> f32 {
    if samples < 2 { 0.0 } else { (sample as f64 * (voxels - 1) as f64 / (samples - 1) as f64) as f32 }
}

impl Parameterization {
    /// Samples the parameterization on a lattice of `size` `[inlines, crosslines, samples]` that spans the
    /// survey. [`Self::size`] gives one sample a voxel. Samples of no region hold NaN and [`NO_REGION`].
    ///
    /// # Errors
    /// [`ParamError::VolumeSize`] when a side is 0, [`ParamError::Cancelled`].
    pub fn voxel_volumes<M: LayerModel + ?Sized>(
        &self,
        model: &M,
        size: [usize; 3],
        progress: &Progress,
    ) -> Result<VoxelParameterization, ParamError> {
        self.voxel_box(model, size, [0; 3], size, progress)
    }

    /// The part of [`Self::voxel_volumes`] that begins at sample `start` and has `part` samples: the same values.
    ///
    /// # Errors
    /// [`ParamError::VolumeSize`] when a side is 0 or the part reaches beyond the lattice, [`ParamError::Cancelled`].
    pub fn voxel_box<M: LayerModel + ?Sized>(
        &self,
        model: &M,
        size: [usize; 3],
        start: [usize; 3],
        part: [usize; 3],
        progress: &Progress,
    ) -> Result<VoxelParameterization, ParamError> {
        let is_inside = |axis: usize| start[axis].checked_add(part[axis]).is_some_and(|end| end <= size[axis]);
        if part.contains(&0) || !(0..3).all(is_inside) {
            return Err(ParamError::VolumeSize { size: part });
        }
        let mut out = VoxelParameterization {
            size: part,
            i: Volume::filled(part, f32::NAN),
            j: Volume::filled(part, f32::NAN),
            k: Volume::filled(part, f32::NAN),
            layer: Volume::filled(part, NO_REGION),
            block: Volume::filled(part, NO_REGION),
        };
        progress.begin("sampling i, j, k", part[0] as u64);
        let depth = |pz: usize| corner_aligned(start[2] + pz, size[2], self.size[2]);
        let depths: Vec<f32> = (0..part[2]).map(depth).collect();
        let slab = part[1] * part[2];
        let values = out.i.samples_mut().par_chunks_mut(slab).zip(out.j.samples_mut().par_chunks_mut(slab));
        let values = values.zip(out.k.samples_mut().par_chunks_mut(slab));
        let ids = out.layer.samples_mut().par_chunks_mut(slab).zip(out.block.samples_mut().par_chunks_mut(slab));
        values.zip(ids).enumerate().try_for_each(|(px, (((i, j), k), (layer, block)))| {
            let x = corner_aligned(start[0] + px, size[0], self.size[0]);
            for py in 0..part[1] {
                let y = corner_aligned(start[1] + py, size[1], self.size[1]);
                let mut trace = TraceSheets::default();
                model.regions_down(x, y, &depths, &mut |pz, region| {
                    if usize::from(region.layer) >= self.layers || usize::from(region.block) >= self.blocks {
                        return;
                    }
                    let value = trace.at(self, model, region, Vec3::new(x, y, depths[pz]));
                    let n = py * part[2] + pz;
                    (i[n], j[n], k[n]) = (value[0], value[1], value[2]);
                    (layer[n], block[n]) = (region.layer, region.block);
                });
            }
            progress.step(1)
        })?;
        Ok(out)
    }
}

/// The sheet heights of the current region while a trace is followed down.
#[derive(Default)]
struct TraceSheets {
    region: Option<Region>,
    bottom: f32,
    thickness: f32,
}

impl TraceSheets {
    fn at<M: LayerModel + ?Sized>(&mut self, param: &Parameterization, model: &M, region: Region, p: Vec3) -> [f32; 3] {
        let grid = param.grid(region);
        if grid.unfolded.is_some() {
            let (flat, _) = grid.lookup(model, param.size, p);
            return [flat.i, flat.j, flat.k];
        }
        if self.region != Some(region) {
            self.bottom = grid.bottom.z(model, region.block, p.x, p.y);
            self.thickness = self.bottom - grid.top.z(model, region.block, p.x, p.y);
            self.region = Some(region);
        }
        let v = if self.thickness < PINCHED { 0.5 } else { (self.bottom - p.z) / self.thickness };
        let v = if grid.is_calm() { v } else { v.clamp(0.0, 1.0) };
        let [dx, dy, dk] = grid.offset(p.x, p.y, v);
        let scale = [0, 1].map(|axis: usize| 1.0 / param.size[axis].saturating_sub(1).max(1) as f32);
        // Beyond a calm sheet, up to the horizon that is drawn, k stays that of the horizon.
        let k = if grid.is_calm() { (v + dk).clamp(0.0, 1.0) } else { v + dk };
        [(p.x + dx) * scale[0], (p.y + dy) * scale[1], k]
    }
}

impl RegionGrid {
    /// The offsets of [`RegionGrid::lookup`] without their derivatives; columns of no weight are skipped.
    fn offset(&self, x: f32, y: f32, v: f32) -> [f32; 3] {
        if self.offsets.is_empty() {
            return [0.0; 3];
        }
        let (cx, fx) = split(x - self.origin[0] as f32, self.size[0]);
        let (cy, fy) = split(y - self.origin[1] as f32, self.size[1]);
        let (cell, fraction) = split(v * (self.levels - 1) as f32, self.levels);
        let mut sum = [0.0; 3];
        for (a, wx) in [(0, 1.0 - fx), (1, fx)] {
            for (b, wy) in [(0, 1.0 - fy), (1, fy)] {
                if wx * wy > 0.0 {
                    let start = self.node(cx + a, cy + b, 0);
                    let (value, _) = cubic(&self.offsets[start..start + self.levels], cell, fraction);
                    for n in 0..3 {
                        sum[n] += wx * wy * value[n];
                    }
                }
            }
        }
        sum
    }
}
