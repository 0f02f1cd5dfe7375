//! Contours of round values, cell by cell (marching squares).
//!
//! Along each side of a cell a value between its ends is placed by linear interpolation; a cell's two or
//! four places are joined, and cells' pieces to lines. A cell that a fault passes through has none: contours end at
//! faults, and go on beyond their tips.

use super::Contour;
use super::grid::Grid;
use glam::DVec2;
use std::collections::{BTreeMap, HashMap};

/// Contours that a map aims at.
const CONTOURS: f64 = 14.0;
/// Shortest contour that goes around, traces: a ring of radius 2, no more than smoothing averages over.
const SPECK: f64 = 12.0;
/// Every so manyeth contour is an index contour: heavier, with its value; of the second where there would be fewer than
/// [`INDEXED`] values.
const INDEX_EVERY: [i64; 2] = [5, 2];
const INDEXED: usize = 3;

/// A round distance between contours.
pub(super) fn interval(spread: f64) -> f64 {
    let wanted = spread / CONTOURS;
    let decade = 10f64.powf(wanted.log10().floor());
    [1.0, 2.0, 5.0, 10.0].into_iter().map(|factor| factor * decade).find(|step| *step >= wanted).unwrap_or(decade)
}

/// Corners that a cell's sides go from and to, around it; each the same way for both cells that share it,
/// so that contours meet exactly.
const SIDES: [[usize; 2]; 4] = [[0, 1], [1, 2], [3, 2], [0, 3]];

/// Where a contour crosses a side between two neighbouring traces: the first of them, and whether the other
/// is the next inline.
pub(super) type Crossing = (usize, bool);

/// All contours, each in one piece from rim to rim or around.
pub(super) fn contours(grid: &Grid, range: [f64; 2], interval: f64) -> Vec<Contour> {
    let mut levels: BTreeMap<i64, Vec<[(Crossing, DVec2); 2]>> = BTreeMap::new();
    let [nx, ny] = grid.size;
    for x in 0..nx.saturating_sub(1) {
        for y in 0..ny.saturating_sub(1) {
            let n = x * ny + y;
            let sides = [(n, 0), (n, 1), (n + ny, 1), (n + 1, 0)];
            if !sides.into_iter().all(|(n, way)| grid.is_joined(n, way)) {
                continue;
            }
            let values = [(x, y), (x + 1, y), (x + 1, y + 1), (x, y + 1)].map(|(x, y)| grid.at(x, y).value);
            let low = values.into_iter().fold(f64::INFINITY, f64::min);
            let high = values.into_iter().fold(f64::NEG_INFINITY, f64::max);
            let mut level = (low.max(range[0]) / interval).ceil() as i64;
            while level as f64 * interval <= high {
                let value = level as f64 * interval;
                let places = crossings([x, y], ny, values, value);
                levels.entry(level).or_default().extend(places.chunks_exact(2).map(|pair| [pair[0], pair[1]]));
                level += 1;
            }
        }
    }
    let of_every = |every: i64| levels.keys().filter(|level| *level % every == 0).count();
    let every = if of_every(INDEX_EVERY[0]) >= INDEXED { INDEX_EVERY[0] } else { INDEX_EVERY[1] };
    let of_level = |(level, pieces): (i64, Vec<[(Crossing, DVec2); 2]>)| {
        let contour = move |line| Contour { line, value: level as f64 * interval, is_index: level % every == 0 };
        joined(&pieces).into_iter().filter(|line| !is_speck(line)).map(contour)
    };
    levels.into_iter().flat_map(of_level).collect()
}

/// Where the contour of a value crosses the sides of the cell whose first trace is `[x, y]`, two or four times; `ny` traces
/// lie along an inline, and the corners' values go around the cell.
pub(super) fn crossings([x, y]: [usize; 2], ny: usize, values: [f64; 4], value: f64) -> Vec<(Crossing, DVec2)> {
    let corners = [(x, y), (x + 1, y), (x + 1, y + 1), (x, y + 1)].map(|(x, y)| DVec2::new(x as f64, y as f64));
    let sides = [(x * ny + y, true), ((x + 1) * ny + y, false), (x * ny + y + 1, true), (x * ny + y, false)];
    let crossed = SIDES.into_iter().zip(sides).filter_map(|([from, to], side)| {
        let (a, b) = (values[from], values[to]);
        ((a < value) != (b < value)).then(|| (side, corners[from].lerp(corners[to], (value - a) / (b - a))))
    });
    crossed.collect()
}

/// Whether a contour only goes around a few traces: picks that stand out, and no shape of the horizon.
fn is_speck(line: &[DVec2]) -> bool {
    let length: f64 = line.windows(2).map(|step| step[0].distance(step[1])).sum();
    line.first() == line.last() && length < SPECK
}

/// Pieces that meet at a crossing as lines; one that goes around ends where it began.
pub(super) fn joined(pieces: &[[(Crossing, DVec2); 2]]) -> Vec<Vec<DVec2>> {
    let mut at: HashMap<Crossing, Vec<usize>> = HashMap::new();
    for (n, piece) in pieces.iter().enumerate() {
        piece.iter().for_each(|(crossing, _)| at.entry(*crossing).or_default().push(n));
    }
    let mut taken = vec![false; pieces.len()];
    let mut lines = Vec::new();
    // Lines with ends begin at one; what is left goes around.
    let is_end = |piece: &[(Crossing, DVec2); 2]| piece.iter().position(|(crossing, _)| at[crossing].len() == 1);
    let ends = (0..pieces.len()).filter_map(|n| Some((n, is_end(&pieces[n])?)));
    for (first, from) in ends.chain((0..pieces.len()).map(|n| (n, 0))) {
        if taken[first] {
            continue;
        }
        let mut line = vec![pieces[first][from].1];
        let mut next = Some((first, from));
        while let Some((n, from)) = next {
            taken[n] = true;
            let (crossing, place) = pieces[n][1 - from];
            line.push(place);
            let other = at[&crossing].iter().copied().find(|&m| !taken[m]);
            next = other.map(|m| (m, usize::from(pieces[m][0].0 != crossing)));
        }
        lines.push(line);
    }
    lines
}

#[cfg(test)]
mod tests {
    use super::super::grid::MapNode;
    use super::*;

    fn grid_of(size: [usize; 2], value: impl Fn(f64, f64) -> f64 + Sync) -> Grid {
        Grid::by(size, |x, y| MapNode { value: value(x as f64, y as f64), is_torn: [false; 2], is_open: false })
    }

    #[test]
    fn contours_of_a_dipping_plane_lie_on_it() {
        let plane = |x: f64, y: f64| 100.0 + 3.0 * x - 2.0 * y;
        let found = contours(&grid_of([20, 15], plane), [72.0, 157.0], 10.0);
        // One line a value: 80 to 150.
        let values: Vec<f64> = found.iter().map(|contour| contour.value).collect();
        assert_eq!(values, (8..=15).map(|n| 10.0 * f64::from(n)).collect::<Vec<_>>());
        for contour in &found {
            assert!(contour.line.iter().all(|p| (plane(p.x, p.y) - contour.value).abs() < 1e-9));
        }
        let index: Vec<f64> = found.iter().filter(|contour| contour.is_index).map(|contour| contour.value).collect();
        // Every fifth would be 100 and 150.
        assert_eq!(index, [80.0, 100.0, 120.0, 140.0]);
    }

    #[test]
    fn contours_of_a_cone_go_around_it() {
        let cone = |x: f64, y: f64| (x - 14.0).hypot(y - 15.0);
        let found = contours(&grid_of([30, 31], cone), [0.0, 12.0], 5.0);
        let rings: Vec<&Contour> = found.iter().filter(|contour| contour.value < 12.0).collect();
        assert_eq!(rings.iter().map(|ring| ring.value).collect::<Vec<_>>(), [5.0, 10.0]);
        for ring in rings {
            assert_eq!(ring.line.first(), ring.line.last());
            let length: f64 = ring.line.windows(2).map(|step| step[0].distance(step[1])).sum();
            let around = std::f64::consts::TAU * ring.value;
            assert!((length / around - 1.0).abs() < 0.03, "{length} of {around}");
        }
    }

    #[test]
    fn a_flat_horizon_has_no_contour_and_a_hole_has_none_around_it() {
        assert!(contours(&grid_of([9, 9], |_, _| 55.0), [55.0, 55.0], 10.0).is_empty());
        let holed = grid_of([9, 9], |x, y| if (x, y) == (4.0, 4.0) { f64::NAN } else { 10.0 * x });
        let near = |place: &DVec2| (*place - DVec2::splat(4.0)).abs().max_element() < 1.0;
        let found = contours(&holed, [0.0, 80.0], 5.0);
        assert!(!found.iter().any(|contour| contour.line.iter().any(near)));
        // The one through the hole is in two parts.
        assert_eq!(found.iter().filter(|contour| contour.value == 40.0).count(), 2);
    }

    #[test]
    fn one_pick_that_stands_out_has_no_contour() {
        let spike = |height: f64| move |x: f64, y: f64| if (x, y) == (6.0, 6.0) { height } else { 0.01 * x };
        assert!(contours(&grid_of([13, 13], spike(30.0)), [0.0, 30.0], 5.0).is_empty());
        let hill = |x: f64, y: f64| 30.0 - 5.0 * (x - 6.0).hypot(y - 6.0);
        assert!(contours(&grid_of([13, 13], hill), [0.0, 30.0], 5.0).iter().any(|contour| contour.value == 15.0));
    }

    #[test]
    fn intervals_are_round() {
        for (spread, said) in [(140.0, 10.0), (100.0, 10.0), (15.0, 2.0), (3000.0, 500.0)] {
            assert_eq!(interval(spread), said);
        }
    }
}
