//! i and j followed once more along ∇k, where k was changed after they were found ([`crate::tips`]).
//!
//! Curves are traced as for a flow ([`crate::flow::lines`]), on the columns and levels of the grid, but only where one can
//! have passed a column that was changed; elsewhere i and j stay. They also stay where the grid is not computed on all
//! sides, and beside creases, which curves do not pass.

use crate::columns::RegionColumns;
use crate::compute::level_range;
use crate::flow::lines;
use crate::flow::sigma::{FlowLattice, SigmaLayer};
use crate::grid::PINCHED;
use crate::layer::LayerKind;
use crate::metric::Metric;
use crate::plan::Method;
use crate::{LayerModel, RegionGrid};
use survey::{Cancelled, Progress};

/// Follows i and j of a grid again after k has changed in some columns (`[x][y]`). `columns` are those that it is filled in.
///
/// # Errors
/// [`Cancelled`].
pub(crate) fn retrace<M: LayerModel + ?Sized>(
    model: &M,
    metric: &Metric,
    grid: &mut RegionGrid,
    method: Method,
    columns: &RegionColumns,
    changed: &[usize],
    progress: &Progress,
) -> Result<(), Cancelled> {
    let (levels, block) = (grid.levels, grid.region.block);
    let first = match method {
        Method::Flow(flow) => flow.first_level(levels),
        Method::Closest(LayerKind::AboveBottom(_)) => 0,
        Method::Closest(LayerKind::BelowTop(_)) => levels - 1,
        Method::Closest(LayerKind::Ratio | LayerKind::Vertical) | Method::Unfolded => return Ok(()),
    };
    if changed.is_empty() {
        return Ok(());
    }
    let bottom = |x: f32, y: f32| grid.bottom.z(model, block, x, y);
    let top = |x: f32, y: f32| grid.top.z(model, block, x, y);
    let lattice = FlowLattice { origin: grid.origin, spacing: [1.0; 2], size: grid.size };
    let layer = SigmaLayer::new(lattice, levels, [&bottom, &top], metric);
    // The first and last level that were computed in each column.
    let computed = |node: usize| {
        if matches!(method, Method::Flow(_)) {
            return Some((0, levels - 1));
        }
        let [x, y] = lattice.place(node).map(|at| at as i32);
        let (z, thickness) = (bottom(x as f32, y as f32), layer.thickness(node));
        let depths = columns.depths_at([x, y]).filter(|_| thickness >= PINCHED)?;
        Some(level_range(levels, z, thickness, depths))
    };
    let computed: Vec<Option<(usize, usize)>> = (0..grid.size[0] * grid.size[1]).map(computed).collect();
    let is_known = |node: usize, level: usize| {
        computed[node].is_some_and(|(low, high)| (low..=high).contains(&level))
            && !grid.is_crease(node * levels + level)
    };
    let reached = reached(grid, changed);
    let is_traced = |node: usize, level: usize| {
        let inner = if level > first { level - 1 } else { level + 1 };
        reached[node] && around(grid.size, node).all(|near| is_known(near, level) && is_known(near, inner))
    };
    let k: Vec<f32> = grid.offsets.iter().enumerate().map(|(n, offset)| layer.v(n % levels) + offset[2]).collect();
    let mut places: Vec<[f32; 2]> = grid.offsets.iter().map(|&[x, y, _]| [x, y]).collect();
    for node in (0..reached.len()).filter(|&node| reached[node] && is_known(node, first)) {
        places[node * levels + first] = [0.0; 2];
    }
    lines::trace(&layer, &k, first, is_traced, &mut places, progress)?;
    grid.offsets.iter_mut().zip(places).for_each(|(offset, [x, y])| [offset[0], offset[1]] = [x, y]);
    Ok(())
}

/// The columns whose curves can pass one that has changed: where the box around a column and its ends has one.
fn reached(grid: &RegionGrid, changed: &[usize]) -> Vec<bool> {
    let [nx, ny] = grid.size;
    // Counts of changed columns before (x, y).
    let mut before = vec![0u32; (nx + 1) * (ny + 1)];
    changed.iter().for_each(|&n| before[(n / ny + 1) * (ny + 1) + n % ny + 1] = 1);
    for n in (ny + 1..before.len()).filter(|n| n % (ny + 1) != 0) {
        before[n] += before[n - 1] + before[n - ny - 1] - before[n - ny - 2];
    }
    let is_reached = |(n, column): (usize, &[[f32; 3]])| {
        let far = |axis: usize| column.iter().map(|offset| offset[axis].abs()).fold(0.0, f32::max) as usize + 2;
        let range = |at: usize, far: usize, count: usize| (at.saturating_sub(far), (at + far + 1).min(count));
        let ((west, east), (south, north)) = (range(n / ny, far(0), nx), range(n % ny, far(1), ny));
        let count = |x: usize, y: usize| before[x * (ny + 1) + y];
        count(east, north) + count(west, south) > count(west, north) + count(east, south)
    };
    grid.offsets.chunks(grid.levels).enumerate().map(is_reached).collect()
}

/// A column and those beside it, of so many.
fn around([nx, ny]: [usize; 2], node: usize) -> impl Iterator<Item = usize> {
    let near = |at: usize, count: usize| at.saturating_sub(1)..(at + 2).min(count);
    near(node / ny, nx).flat_map(move |x| near(node % ny, ny).map(move |y| x * ny + y))
}
