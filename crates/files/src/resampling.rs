//! Resamples a horizon onto an unrotated grid for the formats that need one: ZMAP+ and CPS-3.
//!
//! A grid whose axes run along X and Y is kept node for node, turned or mirrored as the format requires. Any other grid
//! is sampled bilinearly at square nodes, at least as far apart as its own, over the box around its nodes with a depth;
//! a new node next to a hole is a hole. Resampling is exact on a plane; between nodes it follows the surface that
//! pictures show.

use super::Format;
use super::error::FormatError;
use super::export::{ExportOptions, WhenRotated};
use super::irap;
use super::write::WriteFailure;
use glam::DVec2;
use std::borrow::Cow;
use survey::horizon::{Horizon, NodeGrid, Quality, Sheet};

/// Largest number of nodes of a resampled grid; beyond it the nodes are placed farther apart.
const MAX_NODES: f64 = 1.6e7;

/// The horizon on a grid with u along +X and v along +Y, and what was done to it.
pub(super) fn of<'a>(
    horizon: &'a Horizon,
    format: Format,
    options: &ExportOptions,
) -> Result<(Cow<'a, Horizon>, Vec<String>), FormatError> {
    let refused = |why: String, instead: &'static str| FormatError::NotRepresentable {
        name: horizon.name.clone(),
        format,
        why,
        instead,
    };
    let sheet = match irap::one_sheet(horizon) {
        Ok(sheet) => sheet,
        Err(WriteFailure::NotRepresentable(why, instead)) => return Err(refused(why, instead)),
        Err(WriteFailure::Io(source)) => {
            return Err(FormatError::Io { action: "write", file: std::path::PathBuf::new(), source });
        }
    };
    let alone = |sheet: Sheet| Cow::Owned(Horizon::new(horizon.name.clone(), vec![sheet]));
    if let Some(turned) = along_axes(&sheet) {
        return Ok((alone(turned), Vec::new()));
    }
    let degrees = sheet.grid.u_step.to_angle().to_degrees();
    if options.when_rotated == WhenRotated::Refuse {
        return Err(FormatError::Rotated { name: horizon.name.clone(), format, degrees });
    }
    let Some(resampled) = resample(&sheet) else {
        return Err(refused("it has no node with a depth".into(), "check the horizon"));
    };
    let [nu, nv] = resampled.grid.count;
    let note = format!(
        "the grid is rotated by {degrees:.3} degrees, which the format cannot hold: resampled bilinearly onto \
         {nu} x {nv} nodes of {:.3} m; irap, csv, opendtect and tsurf keep the nodes as they are",
        resampled.grid.u_step.x
    );
    Ok((alone(resampled), vec![note]))
}

/// The same nodes with u along +X and v along +Y; `None` if the axes do not run along X and Y.
fn along_axes(sheet: &Sheet) -> Option<Sheet> {
    let NodeGrid { origin, u_step, v_step, count: [nu, nv] } = sheet.grid;
    let along = |step: DVec2, axis: DVec2, count: usize| {
        // The far end must be within a thousandth of a bin of its place on an unrotated grid.
        step.perp_dot(axis).abs() * count as f64 <= 1e-3 * step.length()
    };
    let straight = along(u_step, DVec2::X, nu) && along(v_step, DVec2::Y, nv);
    let swapped = along(u_step, DVec2::Y, nu) && along(v_step, DVec2::X, nv);
    if !(straight || swapped) {
        return None;
    }
    let (x_step, y_step, nx, ny) = if straight { (u_step.x, v_step.y, nu, nv) } else { (v_step.x, u_step.y, nv, nu) };
    let index = |i: usize, j: usize| {
        let i = if x_step < 0.0 { nx - 1 - i } else { i };
        let j = if y_step < 0.0 { ny - 1 - j } else { j };
        if straight { i * nv + j } else { j * nv + i }
    };
    let order: Vec<usize> = (0..nx).flat_map(|i| (0..ny).map(move |j| (i, j))).map(|(i, j)| index(i, j)).collect();
    let low = |first: f64, step: f64, count: usize| first + (step * (count as f64 - 1.0)).min(0.0);
    let grid = NodeGrid {
        origin: DVec2::new(low(origin.x, x_step, nx), low(origin.y, y_step, ny)),
        u_step: DVec2::new(x_step.abs(), 0.0),
        v_step: DVec2::new(0.0, y_step.abs()),
        count: [nx, ny],
    };
    let depth = order.iter().map(|&n| sheet.depth[n]).collect();
    let quality = order.iter().map(|&n| sheet.quality[n]).collect();
    Some(Sheet { block: sheet.block, grid, depth, quality })
}

fn resample(sheet: &Sheet) -> Option<Sheet> {
    let nv = sheet.grid.count[1];
    let known = sheet.depth.iter().enumerate().filter(|(_, z)| z.is_finite());
    let world = known.map(|(n, _)| sheet.grid.world_at(DVec2::new((n / nv) as f64, (n % nv) as f64)));
    let (low, high) = world.fold((DVec2::INFINITY, DVec2::NEG_INFINITY), |(l, h), w| (l.min(w), h.max(w)));
    if !low.is_finite() {
        return None;
    }
    let size = high - low;
    let finest = sheet.grid.u_step.length().min(sheet.grid.v_step.length());
    let step = finest.max((size.x * size.y / MAX_NODES).sqrt()).max(size.max_element() / MAX_NODES);
    let count = [size.x, size.y].map(|s| (s / step + 1e-9).floor() as usize + 1).map(|n| n.max(2));
    let grid = NodeGrid { origin: low, u_step: DVec2::new(step, 0.0), v_step: DVec2::new(0.0, step), count };
    let depth: Vec<f32> = (0..count[0] * count[1])
        .map(|n| {
            let node = DVec2::new((n / count[1]) as f64, (n % count[1]) as f64);
            sheet.depth_at_node(sheet.grid.node_at(grid.world_at(node)))
        })
        .collect();
    Some(Sheet::new(grid, depth, Quality::Filled))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn plane(grid: NodeGrid) -> Sheet {
        let nv = grid.count[1];
        let depth = (0..grid.count[0] * nv)
            .map(|n| grid.world_at(DVec2::new((n / nv) as f64, (n % nv) as f64)))
            .map(|w| (100.0 + 0.5 * w.x - 0.25 * w.y) as f32)
            .collect();
        Sheet::new(grid, depth, Quality::Picked)
    }

    #[test]
    fn turned_and_mirrored_grids_keep_their_nodes() {
        for (u, v) in [
            (DVec2::new(10.0, 0.0), DVec2::new(0.0, 20.0)),
            (DVec2::new(0.0, 10.0), DVec2::new(20.0, 0.0)),
            (DVec2::new(0.0, -10.0), DVec2::new(20.0, 0.0)),
            (DVec2::new(-10.0, 0.0), DVec2::new(0.0, -20.0)),
        ] {
            let sheet = plane(NodeGrid { origin: DVec2::new(500.0, 300.0), u_step: u, v_step: v, count: [4, 3] });
            let turned = along_axes(&sheet).unwrap();
            assert_eq!(turned.depth, plane(turned.grid).depth, "{u} {v}");
            assert!(turned.grid.u_step.x > 0.0 && turned.grid.v_step.y > 0.0);
        }
    }

    #[test]
    fn a_rotated_plane_is_the_same_plane() {
        let u = DVec2::from_angle(0.5) * 10.0;
        let sheet =
            plane(NodeGrid { origin: DVec2::new(500.0, 300.0), u_step: u, v_step: u.perp() * 2.0, count: [40, 30] });
        assert!(along_axes(&sheet).is_none());
        let resampled = resample(&sheet).unwrap();
        let wanted = plane(resampled.grid);
        assert!(resampled.node_count() > 1500, "{}", resampled.node_count());
        for (a, b) in resampled.depth.iter().zip(&wanted.depth).filter(|(a, _)| a.is_finite()) {
            assert!((a - b).abs() < 1e-3, "{a} {b}");
        }
    }
}
