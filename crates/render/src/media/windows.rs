//! The part of each slice of light that matters.
//!
//! Light spreads by one cell a slice, so of the grid only a *window* is computed: cells that rays through the block read there, and cells from which light still gets to
//! such by a later slice, as far as any light has come. Cells outside are never read or are zero: nothing is left out.

use super::light_grid::{Asked, LightGrid};
use crate::camera::View;
use crate::voxel_box::VoxelBox;
use glam::{DVec2, DVec3};

/// A rectangle of cells of a slice.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Window {
    /// First cell to the right and up.
    pub low: [usize; 2],
    /// One behind the last.
    pub high: [usize; 2],
}

impl Window {
    const NONE: Self = Self { low: [usize::MAX; 2], high: [0; 2] };

    pub fn size(&self) -> [usize; 2] {
        [0, 1].map(|axis| self.high[axis].saturating_sub(self.low[axis]))
    }

    /// The smallest around both.
    fn hull(self, other: Self) -> Self {
        Self {
            low: [0, 1].map(|axis| self.low[axis].min(other.low[axis])),
            high: [0, 1].map(|axis| self.high[axis].max(other.high[axis])),
        }
    }

    /// What both have.
    fn meet(self, other: Self) -> Self {
        let low = [0, 1].map(|axis: usize| self.low[axis].max(other.low[axis]));
        let high = [0, 1].map(|axis: usize| self.high[axis].min(other.high[axis]));
        if low[0] < high[0] && low[1] < high[1] { Self { low, high } } else { Self::NONE }
    }

    /// With its neighbours.
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

/// The window of every front, from the first slice's to the last's back.
pub(super) fn windows(grid: &LightGrid, view: &View, roaming_box: &VoxelBox, asked: Asked) -> Vec<Window> {
    let slices = grid.size[2];
    let whole = Window { low: [0; 2], high: [grid.size[0], grid.size[1]] };
    // The cells around what the block takes of each slice.
    let sections: Vec<Window> = match asked {
        Asked::Everywhere => vec![whole; slices],
        Asked::Block => (0..slices).map(|slice| section(grid, view, roaming_box, slice)).collect(),
    };
    let section = |slice: usize| sections.get(slice).copied().unwrap_or(Window::NONE);
    let read = |front: usize| section(front).hull(front.checked_sub(1).map_or(Window::NONE, section));
    // What light has come to, from the front on; what still matters, from the back on.
    let mut lit = Window::NONE;
    let reached: Vec<Window> = (0..=slices)
        .map(|front| {
            lit = lit.grown(grid).hull(section(front));
            lit
        })
        .collect();
    let mut wanted = Window::NONE;
    let mut windows = vec![Window::NONE; slices + 1];
    for front in (0..=slices).rev() {
        let needed = wanted.grown(grid);
        wanted = read(front).hull(needed);
        windows[front] = read(front).hull(needed.meet(reached[front]));
    }
    windows
}

/// The cells around the part of the block in a slice: those of any point's interpolation, and one more for rounding.
fn section(grid: &LightGrid, view: &View, roaming_box: &VoxelBox, slice: usize) -> Window {
    let (linear, shift) = view.eye_from_voxel();
    let eyes = roaming_box.corners().map(|corner| linear * corner + shift);
    let depths = [slice, slice + 1].map(|n| grid.near + n as f64 * grid.slice);
    let (mut low, mut high) = (DVec2::INFINITY, DVec2::NEG_INFINITY);
    let mut add = |eye: DVec3| {
        let flat = if grid.perspective { eye.truncate() / eye.z.max(1e-9) } else { eye.truncate() };
        let cell = (flat - grid.low) / grid.cell - 0.5;
        (low, high) = (low.min(cell), high.max(cell));
    };
    // The slice cuts a convex polyhedron out of the block, whose corners lie on edges between its corners (and on diagonals, which adds none outside).
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
    Window {
        low: [cell(low.x.floor() - 1.0, 0), cell(low.y.floor() - 1.0, 1)],
        high: [cell(high.x.floor() + 3.0, 0), cell(high.y.floor() + 3.0, 1)],
    }
}
