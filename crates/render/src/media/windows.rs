//! The part of each slice of light that must be computed.
//!
//! Light spreads by one cell per slice, so only a *window* of the grid is computed: the cells that rays
//! through the block read, and the cells from which light reaches those in a later slice, as far as light has
//! spread. Cells outside are never read or are zero, so the result is exact.

use super::light_grid::{Asked, LightGrid};
use crate::camera::View;
use glam::{DVec2, DVec3};
use survey::block::VoxelBox;

/// A rectangle of cells of a slice.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct CellWindow {
    /// First cell to the right and upwards.
    pub low: [usize; 2],
    /// One past the last cell.
    pub high: [usize; 2],
}

impl CellWindow {
    const NONE: Self = Self { low: [usize::MAX; 2], high: [0; 2] };

    pub(super) fn size(&self) -> [usize; 2] {
        [0, 1].map(|axis| self.high[axis].saturating_sub(self.low[axis]))
    }

    /// The smallest window that contains both.
    fn hull(self, other: Self) -> Self {
        Self {
            low: [0, 1].map(|axis| self.low[axis].min(other.low[axis])),
            high: [0, 1].map(|axis| self.high[axis].max(other.high[axis])),
        }
    }

    /// The intersection.
    fn meet(self, other: Self) -> Self {
        let low = [0, 1].map(|axis: usize| self.low[axis].max(other.low[axis]));
        let high = [0, 1].map(|axis: usize| self.high[axis].min(other.high[axis]));
        if low[0] < high[0] && low[1] < high[1] { Self { low, high } } else { Self::NONE }
    }

    /// The window grown by one cell on every side, within the grid.
    fn grown(self, grid: &LightGrid) -> Self {
        if self == Self::NONE {
            return self;
        }
        Self {
            low: self.low.map(|low| low.saturating_sub(1)),
            high: [0, 1].map(|axis| (self.high[axis] + 1).min(grid.size[axis])),
        }
    }
}

/// The window at the front of every slice, and at the back of the last.
pub(super) fn windows(grid: &LightGrid, view: &View, roaming_box: &VoxelBox, asked: Asked) -> Vec<CellWindow> {
    let slices = grid.size[2];
    let whole = CellWindow { low: [0; 2], high: [grid.size[0], grid.size[1]] };
    // The cells around the part of the block in each slice.
    let sections: Vec<CellWindow> = match asked {
        Asked::Everywhere => vec![whole; slices],
        Asked::Block => (0..slices).map(|slice| section(grid, view, roaming_box, slice)).collect(),
    };
    let section = |slice: usize| sections.get(slice).copied().unwrap_or(CellWindow::NONE);
    let read = |front: usize| section(front).hull(front.checked_sub(1).map_or(CellWindow::NONE, section));
    // The cells that light has reached, front to back; then the cells that are still needed, back to front.
    let mut lit = CellWindow::NONE;
    let reached: Vec<CellWindow> = (0..=slices)
        .map(|front| {
            lit = lit.grown(grid).hull(section(front));
            lit
        })
        .collect();
    let mut wanted = CellWindow::NONE;
    let mut windows = vec![CellWindow::NONE; slices + 1];
    for front in (0..=slices).rev() {
        let needed = wanted.grown(grid);
        wanted = read(front).hull(needed);
        windows[front] = read(front).hull(needed.meet(reached[front]));
    }
    windows
}

/// The cells around the part of the block in a slice: those that interpolation reads, and one more for
/// rounding.
fn section(grid: &LightGrid, view: &View, roaming_box: &VoxelBox, slice: usize) -> CellWindow {
    let (linear, shift) = view.eye_from_voxel();
    let eyes = roaming_box.corners().map(|corner| linear * corner + shift);
    let depths = [slice, slice + 1].map(|n| grid.near + n as f64 * grid.slice);
    let (mut low, mut high) = (DVec2::INFINITY, DVec2::NEG_INFINITY);
    let mut add = |eye: DVec3| {
        let flat = if grid.perspective { eye.truncate() / eye.z.max(1e-9) } else { eye.truncate() };
        let cell = (flat - grid.low) / grid.cell - 0.5;
        (low, high) = (low.min(cell), high.max(cell));
    };
    // The slice cuts a convex polyhedron out of the block. Its corners lie on the edges of the block;
    // diagonals add no points outside.
    for (n, a) in eyes.iter().enumerate() {
        for b in &eyes[n + 1..] {
            let (near, far) = if a.z <= b.z { (a, b) } else { (b, a) };
            let (from, to) = (near.z.max(depths[0]), far.z.min(depths[1]));
            if from <= to {
                let place = |depth: f64| {
                    let length = far.z - near.z;
                    if length > 0.0 { *near + (*far - *near) * ((depth - near.z) / length) } else { *near }
                };
                add(place(from));
                add(place(to));
                if far.z == near.z {
                    add(*far);
                }
            }
        }
    }
    let cell = |v: f64, axis: usize| v.clamp(0.0, grid.size[axis] as f64) as usize;
    CellWindow {
        low: [cell(low.x.floor() - 1.0, 0), cell(low.y.floor() - 1.0, 1)],
        high: [cell(high.x.floor() + 3.0, 0), cell(high.y.floor() + 3.0, 1)],
    }
}
