//! What was not picked, to be hatched: an outline around its traces and oblique lines over them. Space:
//! voxel x and y.

use super::grid::Grid;
use glam::DVec2;

/// Hatching lines across the longer side of a map.
const LINES: usize = 90;

/// Outline and hatching of the open traces, in pieces; each trace stands for the square of one trace around it.
pub(super) fn hatching(grid: &Grid) -> Vec<[DVec2; 2]> {
    let [nx, ny] = grid.size;
    let is_open = |x: usize, y: usize| x < nx && y < ny && grid.at(x, y).is_open;
    if !grid.nodes().iter().any(|node| node.is_open) {
        return Vec::new();
    }
    let mut pieces = Vec::new();
    let corner = |x: usize, y: usize| DVec2::new(x as f64 - 0.5, y as f64 - 0.5);
    // Sides between an open trace and one that is not, as long as they go straight on.
    for y in 0..=ny {
        let is_side = |x: usize| is_open(x, y) != (y > 0 && is_open(x, y - 1));
        pieces.extend(runs(nx, is_side).map(|[from, to]| [corner(from, y), corner(to, y)]));
    }
    for x in 0..=nx {
        let is_side = |y: usize| is_open(x, y) != (x > 0 && is_open(x - 1, y));
        pieces.extend(runs(ny, is_side).map(|[from, to]| [corner(x, from), corner(x, to)]));
    }
    let every = nx.max(ny).div_ceil(LINES).max(2);
    for sum in (0..nx + ny).step_by(every) {
        let is_on = |x: usize| x <= sum && is_open(x, sum - x);
        let place = |x: usize| DVec2::new(x as f64 - 0.5, sum as f64 - x as f64 + 0.5);
        pieces.extend(runs(nx, is_on).map(|[from, to]| [place(from), place(to)]));
    }
    pieces
}

/// First and end of each run of numbers below `count` for which something is so.
fn runs(count: usize, is_so: impl Fn(usize) -> bool) -> impl Iterator<Item = [usize; 2]> {
    let mut next = 0;
    std::iter::from_fn(move || {
        let from = (next..count).find(|&n| is_so(n))?;
        next = (from..count).find(|&n| !is_so(n)).unwrap_or(count);
        Some([from, next])
    })
}

#[cfg(test)]
mod tests;
