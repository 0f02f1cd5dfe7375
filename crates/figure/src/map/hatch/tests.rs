//! What is not picked is outlined and hatched, and nothing else.

use super::super::grid::MapNode;
use super::*;

#[test]
fn an_open_rectangle_has_four_sides_and_lines_within_them() {
    let inside = |x: usize, y: usize| (3..7).contains(&x) && (2..5).contains(&y);
    let grid = Grid::by([10, 8], |x, y| MapNode { value: 1.0, is_torn: [false; 2], is_open: inside(x, y) });
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
    assert!(hatching(&Grid::by([9, 9], |_, _| MapNode { value: 1.0, is_torn: [false; 2], is_open: false })).is_empty());
}
