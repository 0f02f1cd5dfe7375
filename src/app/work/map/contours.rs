//! Contours of round values, cell by cell (marching squares): along each side a value between the ends is placed by linear interpolation, and a
//! cell's two or four places are joined. A cell with corners in different fault blocks has none: contours end at faults.

use super::ContourPiece;
use super::grid::Grid;
use glam::DVec2;

/// Contours that a map aims at.
const CONTOURS: f64 = 14.0;
/// Every so manyeth contour is an index contour: heavier, with its value.
const INDEX_EVERY: i64 = 5;

/// A round distance between contours.
pub(super) fn interval(spread: f64) -> f64 {
    let wanted = spread / CONTOURS;
    let decade = 10f64.powf(wanted.log10().floor());
    [1.0, 2.0, 5.0, 10.0].into_iter().map(|factor| factor * decade).find(|step| *step >= wanted).unwrap_or(decade)
}

pub(super) fn contours(grid: &Grid, range: [f64; 2], interval: f64) -> Vec<ContourPiece> {
    let mut pieces = Vec::new();
    let [nx, ny] = grid.size;
    for x in 0..nx.saturating_sub(1) {
        for y in 0..ny.saturating_sub(1) {
            let corners = [(x, y), (x + 1, y), (x + 1, y + 1), (x, y + 1)];
            let found = corners.map(|(x, y)| grid.at(x, y));
            let is_whole = found.iter().all(|node| node.value.is_finite() && node.block == found[0].block);
            if !is_whole {
                continue;
            }
            let values = found.map(|node| node.value);
            let low = values.into_iter().fold(f64::INFINITY, f64::min);
            let high = values.into_iter().fold(f64::NEG_INFINITY, f64::max);
            let mut level = (low.max(range[0]) / interval).ceil() as i64;
            while level as f64 * interval <= high {
                let value = level as f64 * interval;
                let mut places = Vec::with_capacity(4);
                for side in 0..4 {
                    let (a, b) = (values[side], values[(side + 1) % 4]);
                    if (a < value) != (b < value) {
                        let share = (value - a) / (b - a);
                        let place = |(x, y): (usize, usize)| DVec2::new(x as f64, y as f64);
                        places.push(place(corners[side]).lerp(place(corners[(side + 1) % 4]), share));
                    }
                }
                for pair in places.chunks_exact(2) {
                    pieces.push(ContourPiece { ends: [pair[0], pair[1]], value, is_index: level % INDEX_EVERY == 0 });
                }
                level += 1;
            }
        }
    }
    pieces
}

#[cfg(test)]
mod tests {
    use super::super::grid::Node;
    use super::*;

    fn grid_of(size: [usize; 2], value: impl Fn(f64, f64) -> f64) -> Grid {
        Grid::by(size, |x, y| Node { value: value(x as f64, y as f64), block: 0, is_open: false })
    }

    #[test]
    fn contours_of_a_dipping_plane_lie_on_it() {
        let plane = |x: f64, y: f64| 100.0 + 3.0 * x - 2.0 * y;
        let pieces = contours(&grid_of([20, 15], plane), [72.0, 157.0], 10.0);
        assert!(!pieces.is_empty());
        for piece in pieces {
            for end in piece.ends {
                assert!((plane(end.x, end.y) - piece.value).abs() < 1e-9);
            }
        }
    }

    #[test]
    fn a_flat_horizon_has_no_contour_and_a_hole_has_none_around_it() {
        assert!(contours(&grid_of([9, 9], |_, _| 55.0), [55.0, 55.0], 10.0).is_empty());
        let holed = grid_of([9, 9], |x, y| if (x, y) == (4.0, 4.0) { f64::NAN } else { 10.0 * x });
        let near =
            |piece: &ContourPiece| piece.ends.iter().all(|end| (*end - DVec2::splat(4.0)).abs().max_element() < 1.0);
        assert!(!contours(&holed, [0.0, 80.0], 5.0).iter().any(near));
    }

    #[test]
    fn intervals_are_round() {
        for (spread, said) in [(140.0, 10.0), (100.0, 10.0), (15.0, 2.0), (3000.0, 500.0)] {
            assert_eq!(interval(spread), said);
        }
    }
}
