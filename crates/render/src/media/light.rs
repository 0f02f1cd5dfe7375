//! Occlusion shading: occlusion and emission propagated through the media from slice to slice (P-horiz 5.1).
//!
//! Slices are planes of equal depth, Δ apart, front to back. Each is a grid of *cells* of a fixed size. On
//! slice i
//!
//! ```text
//! Oᵢ = G∗Oᵢ₋₁ + aᵢ              λᵢ = 1/(1 + s·G∗Oᵢ₋₁)
//! Eᵢ = G∗Eᵢ₋₁·(1 − αᵢ) + eᵢ     eᵢ = αᵢ · emitted colour
//! ```
//!
//! where G is a Gaussian of variance σ₀²·Δ/Δ₀ and αᵢ = 1 − (1 − α₀)^(Δ/Δ₀). The paper composites each slice
//! as it is computed. We keep λ and E of every slice in a *light volume* and draw the picture by rays through
//! it ([`super::march`]). So light is computed at the resolution of the data, whatever that of the picture.
//! Rays may be supersampled, drawn in tiles, skip empty space and end early, and faces behind the media are
//! lit as well. A value belongs to the front of its slice and is interpolated in depth.
//!
//! **Departure**: aᵢ = α₀·Δ/Δ₀ where the paper has αᵢ. Both agree at one slice per unit. With αᵢ, the
//! occlusion behind something opaque grows with the number of slices in it, since each adds 1; the linear
//! form adds the same for any number.
//!
//! G is the 3 × 3 kernel [v/2, 1 − v, v/2] squared, where v is its variance in cells, at most ½ by the choice
//! of the cell. Variances add, so the kernel approaches a Gaussian after a few slices. No light enters from
//! outside the grid. The module `slices` computes this on the CPU.

use super::Shading;
use super::field::MediaField;
use super::light_grid::{Asked, LightGrid, cells_from_voxel};
use super::slices::{Carried, carry};
use crate::camera::View;
use crate::visible::Solid;
use glam::{Mat3, Vec2, Vec3};
use survey::block::VoxelBox;
use survey::{Cancelled, Progress};

/// λ and E at the front of every slice, for the cells that matter.
pub struct LightVolume {
    grid: LightGrid,
    carried: Carried,
    /// Map from voxel positions to cell coordinates and slices, before the division by depth in a
    /// perspective.
    linear: Mat3,
    shift: Vec3,
}

impl LightVolume {
    /// Propagates the light of a scene; `None` for a scene without occlusion.
    ///
    /// # Errors
    /// [`Cancelled`].
    pub fn new(
        field: &MediaField,
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

    /// λ + E at a voxel position: the light that arrives there.
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
        // Truncated, since the numbers are not negative and `floor` would be a library call.
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

    /// The cells around a position at the front of a slice. Windows are at least two cells wide and high.
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

/// Indices of the first of the two cells in each row around a position, and the fractions between the cells.
struct Corners {
    rows: [usize; 2],
    f: Vec2,
}
