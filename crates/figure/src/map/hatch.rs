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
mod tests {
    use super::super::grid::MapNode;
    use super::*;

    #[test]
    fn an_open_rectangle_has_four_sides_and_lines_within_them() {
        let inside = |x: usize, y: usize| (3..7).contains(&x) && (2..5).contains(&y);
        let grid = Grid::by([10, 8], |x, y| MapNode { value: 1.0, block: 0, is_open: inside(x, y) });
        let pieces = hatching(&grid);
        let is_straight = |piece: &[DVec2; 2]| piece[0].x == piece[1].x || piece[0].y == piece[1].y;
        let (sides, lines): (Vec<[DVec2; 2]>, Vec<[DVec2; 2]>) = pieces.into_iter().partition(is_straight);
        let length: f64 = sides.iter().map(|[from, to]| from.distance(*to)).sum();
        assert_eq!((sides.len(), length), (4, 2.0 * (4.0 + 3.0)));
        assert!(!lines.is_empty());
        let (low, high) = (DVec2::new(2.5, 1.5), DVec2::new(6.5, 4.5));
        assert!(lines.iter().flatten().all(|end| end.cmpge(low).all() && end.cmple(high).all()));
    }

    #[test]
    fn what_was_picked_is_not_hatched() {
        assert!(hatching(&Grid::by([9, 9], |_, _| MapNode { value: 1.0, block: 0, is_open: false })).is_empty());
    }
}
