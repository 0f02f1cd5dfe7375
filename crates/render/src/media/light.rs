//! Occlusion and emission carried through the media from slice to slice (P-horiz 5.1, DESIGN 3.5).
//!
//! Slices are planes of equal depth, front to back, Δ apart, each a grid of *cells* of fixed size; on slice i
//!
//! ```text
//! Oᵢ = G∗Oᵢ₋₁ + aᵢ              λᵢ = 1/(1 + s·G∗Oᵢ₋₁)
//! Eᵢ = G∗Eᵢ₋₁·(1 − αᵢ) + eᵢ     eᵢ = αᵢ · emitted colour
//! ```
//!
//! where G is a Gaussian of variance σ₀²·Δ/Δ₀, αᵢ = 1 − (1 − α₀)^(Δ/Δ₀). The paper composites each slice as it is made. We keep
//! λ and E of every slice in a *light volume* and draw the picture by rays through it ([`super::march`]). So light is computed at the resolution of the
//! data, whatever the picture's, rays may be supersampled, tiled, skip empty space and end early, and faces behind the media are lit as well.
//! The stored value belongs to the front of a slice and is interpolated in depth.
//!
//! **Departure**: aᵢ = α₀·Δ/Δ₀ where the paper has αᵢ. Both agree at one slice a unit. With αᵢ the occlusion behind something opaque grows with
//! the number of slices in it, since each adds 1; the linear form adds the same for any number.
//!
//! G is the 3 × 3 kernel [v/2, 1 − v, v/2] squared, v its variance in cells, at most ½ by the choice of the cell; variances add, so that after a few
//! slices it is a Gaussian. Nothing comes in from outside the grid.

use super::field::{Field, Matter, Place};
use super::march::stretches;
use super::table::{NO_DATA_BELOW, absorbed};
use super::{Faces, Occlusion, Shading};
use crate::camera::View;
use crate::visible::{Ray, Solid};
use crate::voxel_box::VoxelBox;
use glam::{DVec2, DVec3, Mat3, Vec2, Vec3};
use rayon::prelude::*;
use survey::{Cancelled, Progress};

/// Cells kept free around the block, so that light may leave it sideways.
const MARGIN: f64 = 3.0;

/// Where slices and cells lie, and how much light spreads between them.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LightGrid {
    /// Cells to the right, up, and slices; there is one value more than slices in depth.
    pub size: [usize; 3],
    /// View coordinates of the lower left corner of the first cell, m or tangents.
    pub low: DVec2,
    /// Side of a cell in view coordinates.
    pub cell: f64,
    /// Depth of the front of the first slice, m.
    pub near: f64,
    /// Thickness of a slice, m.
    pub slice: f64,
    /// The same in units of length.
    pub slice_units: f32,
    /// Variance of the blur over a slice at the first depth, cells².
    pub variance: f32,
    /// Whether cells grow with depth.
    pub perspective: bool,
    /// Factor on the occlusion.
    pub strength: f32,
}

impl LightGrid {
    /// The grid for a box.
    pub fn new(occlusion: &Occlusion, view: &View, roaming_box: &VoxelBox, unit_m: f64) -> Self {
        let (linear, shift) = view.eye_from_voxel();
        let perspective = view.is_perspective();
        let eyes = roaming_box.corners().map(|c| linear * c + shift);
        let flat = eyes.map(|e| if perspective { e.truncate() / e.z.max(1e-9) } else { e.truncate() });
        let low = flat.iter().copied().fold(DVec2::INFINITY, DVec2::min);
        let high = flat.iter().copied().fold(DVec2::NEG_INFINITY, DVec2::max);
        let near = eyes.iter().map(|e| e.z).fold(f64::INFINITY, f64::min);
        let far = eyes.iter().map(|e| e.z).fold(f64::NEG_INFINITY, f64::max);
        let slices = ((far - near) / unit_m * f64::from(occlusion.slices_per_voxel)).ceil().max(1.0);
        let slice = (far - near) / slices;
        let spread_m = f64::from(occlusion.spread) * unit_m;
        // A cell is a unit or more, and wide enough for the widest slice that is asked for: half of its variance.
        let nearest = if perspective { near.max(1e-9) } else { 1.0 };
        let wanted = unit_m.max(spread_m * (2.0 * (slice / unit_m).max(1.0)).sqrt()) / nearest;
        let widest = (high - low).max_element();
        let cell = wanted.max(widest / (f64::from(occlusion.max_cells) - 2.0 * MARGIN));
        let low = low - MARGIN * cell;
        let cells = ((high - low) / cell + MARGIN).ceil();
        let variance = (spread_m / (cell * nearest)).powi(2) * slice / unit_m;
        Self {
            size: [cells.x as usize, cells.y as usize, slices as usize],
            low,
            cell,
            near,
            slice,
            slice_units: (slice / unit_m) as f32,
            variance: variance as f32,
            perspective,
            strength: occlusion.strength,
        }
    }

    /// Weight of each neighbour along an axis at a slice: half of the variance there.
    pub fn side_weight(&self, slice: usize) -> f32 {
        let ratio = if self.perspective { self.near.max(1e-9) / self.depth(slice as f64 + 0.5) } else { 1.0 };
        (0.5 * self.variance * (ratio * ratio) as f32).min(0.25)
    }

    fn depth(&self, slices: f64) -> f64 {
        self.near + slices * self.slice
    }
}

/// λ and E of every cell at the front of every slice.
pub struct LightVolume {
    /// Where they are.
    pub grid: LightGrid,
    lambda: Vec<f32>,
    emission: Option<Vec<Vec3>>,
    /// Cell coordinates and slice from voxel positions, before the division by depth in a perspective.
    linear: Mat3,
    shift: Vec3,
}

/// A column of cells along the view: its ray per metre of depth, and its stretches of matter by depth.
struct Column {
    origin: Vec3,
    direction: Vec3,
    towards: Vec3,
    stretches: Vec<([f32; 2], Place)>,
}

impl LightVolume {
    /// Carries the light of a scene; `None` for one without occlusion.
    ///
    /// # Errors
    /// Cancelled.
    pub fn new(
        field: &Field,
        view: &View,
        solid: &Solid,
        roaming_box: &VoxelBox,
        progress: &Progress,
    ) -> Result<Option<Self>, Cancelled> {
        let Shading::Occlusion(occlusion) = field.shading else { return Ok(None) };
        let grid = LightGrid::new(&occlusion, view, roaming_box, f64::from(field.unit_m));
        let [nu, nv, slices] = grid.size;
        let cells = nu * nv;
        let emits = field.horizons.as_ref().is_some_and(|h| h.horizons.iter().any(|one| one.emission > 0.0));
        let columns: Vec<Column> = (0..cells).into_par_iter().map(|n| column(field, view, solid, &grid, n)).collect();
        // Every value is written below, by the threads: zeros cost nothing until then.
        let mut lambda = vec![0.0f32; cells * (slices + 1)];
        let mut emission = emits.then(|| vec![Vec3::ZERO; cells * (slices + 1)]);
        let mut occluded = vec![0.0f32; cells];
        let mut blurred = vec![0.0f32; cells];
        let mut glow = vec![Vec3::ZERO; if emits { cells } else { 0 }];
        let mut blurred_glow = glow.clone();
        progress.begin("light", slices as u64);
        for slice in 0..=slices {
            let side = grid.side_weight(slice);
            blur(&occluded, &mut blurred, nu, side);
            let own = &mut lambda[slice * cells..(slice + 1) * cells];
            own.par_chunks_mut(CHUNK).zip(blurred.par_chunks(CHUNK)).for_each(|(own, blurred)| {
                for (to, o) in own.iter_mut().zip(blurred) {
                    *to = 1.0 / (1.0 + grid.strength * o);
                }
            });
            if let Some(emission) = &mut emission {
                blur(&glow, &mut blurred_glow, nu, side);
                emission[slice * cells..(slice + 1) * cells].copy_from_slice(&blurred_glow);
            }
            if slice == slices {
                break;
            }
            let ends = [grid.depth(slice as f64) as f32, grid.depth(slice as f64 + 1.0) as f32];
            if emits {
                let light = occluded.par_chunks_mut(CHUNK).zip(glow.par_chunks_mut(CHUNK));
                light.enumerate().for_each(|(chunk, (occluded, glow))| {
                    for (n, (o, e)) in occluded.iter_mut().zip(glow).enumerate() {
                        let cell = chunk * CHUNK + n;
                        let (gain, alpha, emitted) = columns[cell].slice(field, ends, grid.slice_units);
                        *o = blurred[cell] + gain;
                        *e = blurred_glow[cell] * (1.0 - alpha) + emitted;
                    }
                });
            } else {
                occluded.par_chunks_mut(CHUNK).enumerate().for_each(|(chunk, occluded)| {
                    for (n, o) in occluded.iter_mut().enumerate() {
                        let cell = chunk * CHUNK + n;
                        *o = blurred[cell] + columns[cell].slice(field, ends, grid.slice_units).0;
                    }
                });
            }
            progress.step(1)?;
        }
        let (linear, shift) = cells_from_voxel(view, &grid);
        Ok(Some(Self { grid, lambda, emission, linear, shift }))
    }

    /// λ + E at a voxel position: the light that falls there.
    #[inline(always)]
    pub fn at(&self, p: Vec3) -> Vec3 {
        let mut q = self.linear * p + self.shift;
        if self.grid.perspective {
            let depth = (q.z * self.grid.slice as f32 + self.grid.near as f32).max(1e-9);
            let low = self.grid.low.as_vec2() / self.grid.cell as f32 + Vec2::splat(0.5);
            q = (q.truncate() / depth - low).extend(q.z);
        }
        let [nu, nv, slices] = self.grid.size;
        let last = Vec3::new((nu - 1) as f32, (nv - 1) as f32, slices as f32);
        let q = q.clamp(Vec3::ZERO, last);
        // Cut to integers: these are not negative, and rounding down would be a call.
        let cell = |axis: usize| (q[axis] as i32).min((last[axis] as i32 - 1).max(0));
        let [x, y, z] = [cell(0), cell(1), cell(2)];
        let f = q - Vec3::new(x as f32, y as f32, z as f32);
        let du = usize::from(nu > 1);
        let dv = if nv > 1 { nu } else { 0 };
        let start = (z as usize * nv + y as usize) * nu + x as usize;
        let dw = nu * nv;
        let values = &self.lambda[start..];
        let mix = |a: f32, b: f32, t: f32| a + (b - a) * t;
        let row = |at: usize| mix(values[at], values[at + du], f.x);
        let plane = |at: usize| mix(row(at), row(at + dv), f.y);
        let lambda = Vec3::splat(mix(plane(0), plane(dw), f.z));
        match &self.emission {
            None => lambda,
            Some(emission) => {
                let values = &emission[start..];
                let row = |at: usize| values[at].lerp(values[at + du], f.x);
                let plane = |at: usize| row(at).lerp(row(at + dv), f.y);
                lambda + plane(0).lerp(plane(dw), f.z)
            }
        }
    }
}

/// The map from voxel positions to cell coordinates (integers at cell centres) and slice fronts; in a perspective x and y are in cells times depth, counted
/// from the axis.
pub fn cells_from_voxel(view: &View, grid: &LightGrid) -> (Mat3, Vec3) {
    let (linear, shift) = view.eye_from_voxel();
    let scale = DVec3::new(1.0 / grid.cell, 1.0 / grid.cell, 1.0 / grid.slice);
    let origin = if grid.perspective {
        DVec3::new(0.0, 0.0, grid.near)
    } else {
        DVec3::new(grid.low.x + 0.5 * grid.cell, grid.low.y + 0.5 * grid.cell, grid.near)
    };
    let linear = glam::DMat3::from_diagonal(scale) * linear;
    (linear.as_mat3(), ((shift - origin) * scale).as_vec3())
}

/// Cells that one task computes.
const CHUNK: usize = 4096;

/// The cell's own column.
fn column(field: &Field, view: &View, solid: &Solid, grid: &LightGrid, n: usize) -> Column {
    let [nu, _, _] = grid.size;
    let flat = grid.low + DVec2::new((n % nu) as f64 + 0.5, (n / nu) as f64 + 0.5) * grid.cell;
    let (origin, direction) = view.depth_ray(flat);
    let norm = direction.length();
    let ray = Ray { origin: origin.as_vec3(), direction: (direction / norm).as_vec3() };
    let mut list = Vec::new();
    stretches(solid, &ray, [f32::MIN, f32::INFINITY], |stretch| {
        if stretch.place == Place::CutOut || field.faces != Faces::All {
            list.push((stretch.t.map(|t| t / norm as f32), stretch.place));
        }
    });
    let towards = -(field.display_from_voxel * ray.direction).normalize_or_zero();
    Column { origin: ray.origin, direction: direction.as_vec3(), towards, stretches: list }
}

impl Column {
    /// What a slice between two depths adds: occlusion, opacity, and light given off.
    fn slice(&self, field: &Field, ends: [f32; 2], units: f32) -> (f32, f32, Vec3) {
        let mut sum = (0.0, 0.0, Vec3::ZERO);
        for &([from, to], place) in &self.stretches {
            let (from, to) = (from.max(ends[0]), to.min(ends[1]));
            if to <= from {
                continue;
            }
            let p = self.origin + self.direction * (0.5 * (from + to));
            let word = field.bricks.word(field.bricks.at(p));
            let shift = if place == Place::CutOut { 8 } else { 0 };
            if word >> shift & 255 != 0 {
                continue;
            }
            let length = units * (to - from) / (ends[1] - ends[0]);
            if let Some(medium) = field.plain(place) {
                let value = medium.sample(p);
                if value > NO_DATA_BELOW {
                    let entry = medium.table.index(value);
                    let alpha = absorbed(medium.table.extinctions[entry] * length);
                    sum.0 += medium.table.opacities[entry] * length;
                    sum.1 += alpha * (1.0 - sum.1);
                }
                continue;
            }
            let Matter { extinction, emission, .. } = field.at(p, place, word, self.towards);
            if extinction <= 0.0 {
                continue;
            }
            let alpha = absorbed(extinction * length);
            sum.0 += absorbed(extinction) * length;
            sum.1 += alpha * (1.0 - sum.1);
            sum.2 += emission * alpha;
        }
        sum
    }
}

/// The 3 × 3 kernel with this weight to either side, row by row.
fn blur<T>(from: &[T], to: &mut [T], width: usize, side: f32)
where
    T: Copy + Send + Sync + Default + std::ops::Add<Output = T> + std::ops::Mul<f32, Output = T>,
{
    let middle = 1.0 - 2.0 * side;
    let rows = from.len() / width;
    to.par_chunks_mut(width * 16).enumerate().for_each(|(block, to)| {
        let mut column = vec![T::default(); width + 2];
        for (n, to) in to.chunks_mut(width).enumerate() {
            let y = block * 16 + n;
            let row = |y: usize| &from[y * width..(y + 1) * width];
            for (sum, value) in column[1..].iter_mut().zip(row(y)) {
                *sum = *value * middle;
            }
            for neighbour in [y.checked_sub(1), (y + 1 < rows).then_some(y + 1)].into_iter().flatten() {
                for (sum, value) in column[1..].iter_mut().zip(row(neighbour)) {
                    *sum = *sum + *value * side;
                }
            }
            for (x, to) in to.iter_mut().enumerate() {
                *to = column[x + 1] * middle + (column[x] + column[x + 2]) * side;
            }
        }
    });
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn blurring_spreads_by_its_variance() {
        let width = 41;
        let mut field = vec![0.0f32; width * width];
        field[20 * width + 20] = 1.0;
        let mut next = field.clone();
        for _ in 0..9 {
            blur(&field, &mut next, width, 0.2);
            std::mem::swap(&mut field, &mut next);
        }
        let total: f32 = field.iter().sum();
        let variance: f32 = field.iter().enumerate().map(|(n, v)| v * ((n % width) as f32 - 20.0).powi(2)).sum();
        assert!((total - 1.0).abs() < 1e-5 && (variance - 9.0 * 0.4).abs() < 1e-4, "{total} {variance}");
    }
}
