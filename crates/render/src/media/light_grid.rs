//! The grid of slices and cells in which light is propagated, and its position in voxel space.

use super::Occlusion;
use crate::camera::View;
use glam::{DMat3, DVec2, DVec3, Mat3, Vec3};
use survey::block::VoxelBox;

/// Width of the free border around the block, cells, so that light can leave it sideways.
const MARGIN: f64 = 3.0;

/// The positions of slices and cells, and the variance of the blur between slices.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct LightGrid {
    /// Number of cells to the right, of cells upwards, and of slices. In depth there is one value more than
    /// slices.
    pub size: [usize; 3],
    /// View coordinates of the lower left corner of the first cell, m or tangents.
    pub low: DVec2,
    /// Side of a cell in view coordinates.
    pub cell: f64,
    /// Depth of the front of the first slice, m.
    pub near: f64,
    /// Thickness of a slice, m.
    pub slice: f64,
    /// Thickness of a slice in units of length.
    pub slice_units: f32,
    /// Variance of the blur over a slice at the nearest depth, cells².
    pub variance: f32,
    /// Whether cells grow with depth, as they do in a perspective.
    pub perspective: bool,
    /// Factor on the occlusion.
    pub strength: f32,
}

impl LightGrid {
    /// The grid for a box.
    pub(crate) fn new(occlusion: &Occlusion, view: &View, roaming_box: &VoxelBox, unit_m: f64) -> Self {
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
        // A cell is at least one unit wide, and wide enough for the variance of the thickest slice to be at
        // most half of its square.
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
    pub(crate) fn side_weight(&self, slice: usize) -> f32 {
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
    /// Only in the roaming box.
    Block,
    /// Beside the roaming box too, as for wells that come out of it.
    Everywhere,
}

/// The map from voxel positions to cell coordinates (integers at cell centres) and fronts of slices. In a
/// perspective, x and y are in cells times depth, measured from the axis.
pub(crate) fn cells_from_voxel(view: &View, grid: &LightGrid) -> (Mat3, Vec3) {
    let (linear, shift) = view.eye_from_voxel();
    let scale = DVec3::new(1.0 / grid.cell, 1.0 / grid.cell, 1.0 / grid.slice);
    let origin = if grid.perspective {
        DVec3::new(0.0, 0.0, grid.near)
    } else {
        DVec3::new(grid.low.x + 0.5 * grid.cell, grid.low.y + 0.5 * grid.cell, grid.near)
    };
    let linear = DMat3::from_diagonal(scale) * linear;
    (linear.as_mat3(), ((shift - origin) * scale).as_vec3())
}
