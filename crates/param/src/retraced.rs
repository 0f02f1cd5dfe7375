//! i and j of a flow followed once more along ∇k, where k was changed after they were found ([`crate::joined`]).
//!
//! Curves are traced as for a flow ([`crate::flow::lines`]), on the columns and levels of the grid, but only where one can
//! have passed a column that was changed; elsewhere i and j stay. Definitions parallel to a horizon are not traced again:
//! their k has creases in the cores of folds, across which numerical gradients lead curves astray.

use crate::flow::sigma::{FlowLattice, SigmaLayer};
use crate::flow::{Flow, lines};
use crate::metric::Metric;
use crate::{LayerModel, RegionGrid};
use survey::{Cancelled, Progress};

/// Follows i and j of a grid again after k has changed in some columns (`[x][y]`).
///
/// # Errors
/// [`Cancelled`].
pub fn retrace<M: LayerModel + ?Sized>(
    model: &M,
    metric: &Metric,
    grid: &mut RegionGrid,
    flow: Flow,
    changed: &[usize],
    progress: &Progress,
) -> Result<(), Cancelled> {
    if changed.is_empty() {
        return Ok(());
    }
    let (levels, block) = (grid.levels, grid.region.block);
    let first = flow.first_level(levels);
    let bottom = |x: f32, y: f32| grid.bottom.z(model, block, x, y);
    let top = |x: f32, y: f32| grid.top.z(model, block, x, y);
    let lattice = FlowLattice { origin: grid.origin, spacing: [1.0; 2], size: grid.size };
    let layer = SigmaLayer::new(lattice, levels, [&bottom, &top], metric);
    let reached = reached(grid, changed);
    let k: Vec<f32> = grid.offsets.iter().enumerate().map(|(n, offset)| layer.v(n % levels) + offset[2]).collect();
    let mut places: Vec<[f32; 2]> = grid.offsets.iter().map(|&[x, y, _]| [x, y]).collect();
    for node in (0..reached.len()).filter(|&node| reached[node]) {
        places[node * levels + first] = [0.0; 2];
    }
    lines::trace(&layer, &k, first, |node, _| reached[node], &mut places, progress)?;
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
