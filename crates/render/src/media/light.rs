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
//! slices it is a Gaussian. Nothing comes in from outside the grid. How it is carried on the processor: the module `slices`.

use super::field::Field;
use super::slices::{Carried, carry};
use super::{Occlusion, Shading};
use crate::camera::View;
use crate::visible::Solid;
use crate::voxel_box::VoxelBox;
use glam::{DVec2, DVec3, Mat3, Vec2, Vec3};
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

/// Where the light volume will be read.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Asked {
    /// In the roaming box.
    Block,
    /// Beside it too, as at wells that come out of it.
    Everywhere,
}

/// λ and E of the cells that matter at the front of every slice.
pub struct LightVolume {
    grid: LightGrid,
    carried: Carried,
    /// Cell coordinates and slice from voxel positions, before the division by depth in a perspective.
    linear: Mat3,
    shift: Vec3,
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
        asked: Asked,
        progress: &Progress,
    ) -> Result<Option<Self>, Cancelled> {
        let Shading::Occlusion(occlusion) = field.shading else { return Ok(None) };
        let grid = LightGrid::new(&occlusion, view, roaming_box, f64::from(field.unit_m));
        let carried = carry(field, view, solid, roaming_box, &grid, asked, progress)?;
        let (linear, shift) = cells_from_voxel(view, &grid);
        Ok(Some(Self { grid, carried, linear, shift }))
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
        let slice = (q.z as i32).min((last.z as i32 - 1).max(0));
        let depth = q.z - slice as f32;
        let front = self.corners(slice as usize, q.x, q.y);
        let back = self.corners(slice as usize + 1, q.x, q.y);
        let mix = |a: f32, b: f32, t: f32| a + (b - a) * t;
        let value = |corners: &Corners| {
            let (a, b) = (&self.carried.lambda[corners.rows[0]..][..2], &self.carried.lambda[corners.rows[1]..][..2]);
            mix(mix(a[0], a[1], corners.f.x), mix(b[0], b[1], corners.f.x), corners.f.y)
        };
        let lambda = Vec3::splat(mix(value(&front), value(&back), depth));
        match &self.carried.emission {
            None => lambda,
            Some(emission) => {
                let value = |corners: &Corners| {
                    let row = |at: usize| emission[at].lerp(emission[at + 1], corners.f.x);
                    row(corners.rows[0]).lerp(row(corners.rows[1]), corners.f.y)
                };
                lambda + value(&front).lerp(value(&back), depth)
            }
        }
    }

    /// The cells around a place at the front of a slice; windows are at least two cells wide and high.
    #[inline(always)]
    fn corners(&self, slice: usize, x: f32, y: f32) -> Corners {
        let (window, start) = (&self.carried.windows[slice], self.carried.starts[slice]);
        let [x0, y0] = [(x as i32).max(0) as usize, (y as i32).max(0) as usize];
        let x0 = x0.min(window.high[0] - 2).max(window.low[0]);
        let y0 = y0.min(window.high[1] - 2).max(window.low[1]);
        let width = window.high[0] - window.low[0];
        let first = start + (y0 - window.low[1]) * width + (x0 - window.low[0]);
        let f = Vec2::new(x - x0 as f32, y - y0 as f32).clamp(Vec2::ZERO, Vec2::ONE);
        Corners { rows: [first, first + width], f }
    }
}

/// Where the four cells around a place begin in the lists, row by row, and its place between them.
struct Corners {
    rows: [usize; 2],
    f: Vec2,
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
