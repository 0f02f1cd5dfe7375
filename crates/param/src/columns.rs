//! Which voxel columns each region occupies, and over which depths: its grid is computed only there.
//!
//! The region is sampled along every column each [`STRIDE`] samples: which blocks the column crosses, over
//! which depths, and which layers occur. Depths are widened by the stride and by those of the columns around
//! ([`MARGIN`]), so that every interpolation inside a region has its neighbours. A layer is computed in a
//! column if it was found within [`REACH`] columns. It is also computed where its sheets lie in the block's
//! depths but are so close together that sampling could have missed it. A layer that an unconformity removed
//! is not computed.

use crate::{LayerModel, Region};
use glam::Vec3;
use rayon::prelude::*;
use survey::{Cancelled, Progress};

/// Distance between samples of the region along a column, voxels.
const STRIDE: usize = 4;
/// Columns around a column whose depths are added to its own.
const MARGIN: usize = 3;
/// Columns within which a layer must have been found.
const REACH: usize = 8;
/// A layer thinner than this (voxels) may exist although no sample found it.
const THIN: f32 = 2.0 * STRIDE as f32;

/// Range of depths in one column, voxel z; empty when the first is larger.
pub(crate) type Depths = [f32; 2];
/// The empty range.
const NOWHERE: Depths = [f32::INFINITY, f32::NEG_INFINITY];

/// The blocks and layers found in all columns, on the survey widened by [`MARGIN`] columns on every side.
pub(crate) struct ColumnScan {
    size: [usize; 2],
    layers: usize,
    /// Range of depths per block, `[x][y]`.
    depths: Vec<Vec<Depths>>,
    /// Per region (`block · layers + layer`), `[x][y]`: whether it was found within [`REACH`] columns.
    met: Vec<Vec<bool>>,
}

/// The columns that one region occupies.
#[derive(Debug, Clone)]
pub(crate) struct RegionColumns {
    /// First column of the bounding box.
    pub origin: [i32; 2],
    /// Size of the bounding box, columns; 0 when the region occupies none.
    pub size: [usize; 2],
    /// Range of depths to compute per column of the box, `[x][y]`.
    pub depths: Vec<Depths>,
    /// Columns beyond the region, per column of the box, where the box was grown.
    beyond: Vec<u8>,
}

impl RegionColumns {
    /// Whether column n of the box is to be computed.
    pub(crate) fn is_wanted(&self, n: usize) -> bool {
        self.depths[n][0] <= self.depths[n][1]
    }

    /// The range of depths to compute in a voxel column, if any.
    pub(crate) fn depths_at(&self, column: [i32; 2]) -> Option<Depths> {
        let n = self.index(column)?;
        self.is_wanted(n).then(|| self.depths[n])
    }

    fn index(&self, column: [i32; 2]) -> Option<usize> {
        let [x, y] = [0, 1].map(|axis| usize::try_from(column[axis] - self.origin[axis]).unwrap_or(usize::MAX));
        (x < self.size[0] && y < self.size[1]).then(|| x * self.size[1] + y)
    }

    /// The same with so many columns more around each, within a survey of so many columns and its margin, and so many samples
    /// above and below.
    pub(crate) fn grown(&self, columns: usize, samples: f32, survey: [usize; 2]) -> Self {
        if self.size[0] == 0 {
            return self.clone();
        }
        let (grown, margin) = (columns as i32, MARGIN as i32);
        let origin = [0, 1].map(|n| (self.origin[n] - grown).max(-margin).min(self.origin[n]));
        let size = [0, 1].map(|n| {
            let end = self.origin[n] + self.size[n] as i32;
            ((end + grown).min(survey[n] as i32 + margin).max(end) - origin[n]) as usize
        });
        let union = |a: Depths, b: Depths| [a[0].min(b[0]), a[1].max(b[1])];
        let place = |n: usize| [origin[0] + (n / size[1]) as i32, origin[1] + (n % size[1]) as i32];
        let own = |n: usize| self.depths_at(place(n)).map_or(NOWHERE, |[low, high]| [low - samples, high + samples]);
        let mut depths: Vec<Depths> = (0..size[0] * size[1]).map(own).collect();
        let mut beyond: Vec<u8> =
            depths.iter().map(|depths| if depths[0] <= depths[1] { 0 } else { u8::MAX }).collect();
        for step in 0..columns as u8 {
            let reached: Vec<(usize, Depths)> = (0..depths.len())
                .filter(|&n| beyond[n] == u8::MAX)
                .filter_map(|n| {
                    let near = around(size, n).filter(|&m| beyond[m] == step).map(|m| depths[m]);
                    near.reduce(union).map(|depths| (n, depths))
                })
                .collect();
            for (n, range) in reached {
                (depths[n], beyond[n]) = (range, step + 1);
            }
        }
        Self { origin, size, depths, beyond }
    }

    /// How many columns beyond the region a voxel column lies that is to be computed; `None` where none is.
    pub(crate) fn steps_beyond(&self, column: [i32; 2]) -> Option<usize> {
        let n = self.index(column)?;
        self.is_wanted(n).then(|| self.beyond.get(n).map_or(0, |steps| usize::from(*steps)))
    }

    /// The columns to be computed: index in the box, voxel column, range of depths.
    pub(crate) fn columns(&self) -> impl Iterator<Item = (usize, [i32; 2], Depths)> {
        let ny = self.size[1];
        (0..self.depths.len()).filter(|&n| self.is_wanted(n)).map(move |n| {
            let column = [self.origin[0] + (n / ny) as i32, self.origin[1] + (n % ny) as i32];
            (n, column, self.depths[n])
        })
    }
}

impl ColumnScan {
    /// Samples the regions of all columns of a model.
    ///
    /// # Errors
    /// [`Cancelled`].
    pub(crate) fn of<M: LayerModel + ?Sized>(model: &M, progress: &Progress) -> Result<Self, Cancelled> {
        let [nx, ny, nz] = model.size();
        let (layers, blocks) = (model.layer_count(), model.block_count());
        let (wide_x, wide_y) = (nx + 2 * MARGIN, ny + 2 * MARGIN);
        let mut depths = vec![NOWHERE; blocks * wide_x * wide_y];
        let mut met = vec![false; layers * blocks * wide_x * wide_y];
        progress.begin("finding the regions", wide_x as u64);
        // Both arrays are in the order [x][y][block …] here; one task is one row of x.
        depths
            .par_chunks_mut(wide_y * blocks)
            .zip(met.par_chunks_mut(wide_y * layers * blocks))
            .enumerate()
            .try_for_each(|(u, (depths, met))| {
                for v in 0..wide_y {
                    // Columns outside the volume repeat the column at its boundary.
                    let [x, y] = [(u, nx), (v, ny)].map(|(n, count)| n.saturating_sub(MARGIN).min(count - 1) as f32);
                    for z in (0..nz).step_by(STRIDE).chain([nz - 1]) {
                        let Region { layer, block } = model.region_at(Vec3::new(x, y, z as f32));
                        let (layer, block) = (usize::from(layer), usize::from(block));
                        if layer < layers && block < blocks {
                            let range = &mut depths[v * blocks + block];
                            *range = [range[0].min(z as f32), range[1].max(z as f32)];
                            met[(v * blocks + block) * layers + layer] = true;
                        }
                    }
                }
                progress.step(1)
            })?;
        let size = [wide_x, wide_y];
        let depths = (0..blocks)
            .into_par_iter()
            .map(|block| {
                let one: Vec<Depths> = depths.iter().skip(block).step_by(blocks).copied().collect();
                let union = |a: Depths, b: Depths| [a[0].min(b[0]), a[1].max(b[1])];
                let mut wide = widen(size, &one, MARGIN, union);
                for range in &mut wide {
                    *range = [range[0] - STRIDE as f32, range[1] + STRIDE as f32];
                }
                wide
            })
            .collect();
        let regions = layers * blocks;
        let met = (0..regions)
            .into_par_iter()
            .map(|region| {
                let one: Vec<bool> = met.iter().skip(region).step_by(regions).copied().collect();
                widen(size, &one, REACH, |a, b| a | b)
            })
            .collect();
        Ok(Self { size, layers, depths, met })
    }

    /// The columns of a region whose sheets lie at `sheets(x, y)` = (bottom, top), voxel z.
    pub(crate) fn touched(&self, region: Region, sheets: impl Fn(i32, i32) -> (f32, f32)) -> RegionColumns {
        let [nx, ny] = self.size;
        let (layer, block) = (usize::from(region.layer), usize::from(region.block));
        let met = &self.met[block * self.layers + layer];
        let margin = MARGIN as i32;
        let wanted = |n: usize| -> Depths {
            let range = self.depths[block][n];
            let (bottom, top) = sheets((n / ny) as i32 - margin, (n % ny) as i32 - margin);
            let overlaps = range[0] <= bottom + 1.0 && range[1] >= top - 1.0;
            let thin = (bottom - top).abs() < THIN;
            if met[n] || (overlaps && thin) { range } else { NOWHERE }
        };
        let all: Vec<Depths> = (0..nx * ny).map(wanted).collect();
        let mut low = [usize::MAX; 2];
        let mut high = [0; 2];
        for n in (0..nx * ny).filter(|&n| all[n][0] <= all[n][1]) {
            let at = [n / ny, n % ny];
            low = [low[0].min(at[0]), low[1].min(at[1])];
            high = [high[0].max(at[0]), high[1].max(at[1])];
        }
        if low[0] == usize::MAX {
            return RegionColumns { origin: [0; 2], size: [0; 2], depths: Vec::new(), beyond: Vec::new() };
        }
        for axis in 0..2 {
            // At least two columns, so that there is a cell to interpolate in.
            if low[axis] == high[axis] {
                (low[axis], high[axis]) = (low[axis].saturating_sub(1), low[axis].max(1));
            }
        }
        let size: [usize; 2] = std::array::from_fn(|axis| high[axis] - low[axis] + 1);
        let depths = (low[0]..=high[0]).flat_map(|x| all[x * ny + low[1]..=x * ny + high[1]].iter().copied()).collect();
        RegionColumns { origin: low.map(|n| n as i32 - margin), size, depths, beyond: Vec::new() }
    }
}

/// The eight columns around column n of a box.
fn around([nx, ny]: [usize; 2], n: usize) -> impl Iterator<Item = usize> {
    let (x, y) = (n / ny, n % ny);
    let near = |at: usize, count: usize| at.saturating_sub(1)..(at + 2).min(count);
    near(x, nx).flat_map(move |x| near(y, ny).map(move |y| x * ny + y)).filter(move |&m| m != n)
}

/// The union of the values in a square of 2·radius + 1 columns around each column.
fn widen<T: Copy>(size: [usize; 2], values: &[T], radius: usize, union: impl Fn(T, T) -> T) -> Vec<T> {
    let [nx, ny] = size;
    let pass = |from: &[T], along: usize, stride: usize| -> Vec<T> {
        (0..from.len())
            .map(|n| {
                let at = n / stride % along;
                let (low, high) = (at.saturating_sub(radius), (at + radius).min(along - 1));
                (low..=high).map(|m| from[n + m * stride - at * stride]).reduce(&union).unwrap_or(from[n])
            })
            .collect()
    };
    pass(&pass(values, ny, 1), nx, ny)
}
