//! The nearest other point on a map, by a grid of cells that hold one point on average.

use glam::{DVec2, IVec2};

/// Cells are looked at up to this many rings away: bins sixteen times as long as wide still find their long
/// step.
const MAX_RINGS: i32 = 24;

/// Points sorted into cells. Memory: 4 bytes per point and 4 bytes per cell.
pub(crate) struct PointGrid<'a> {
    points: &'a [DVec2],
    low: DVec2,
    cell: f64,
    size: IVec2,
    /// Where the points of a cell begin in `order`.
    starts: Vec<u32>,
    order: Vec<u32>,
}

impl<'a> PointGrid<'a> {
    pub(crate) fn of(points: &'a [DVec2]) -> Self {
        let low = points.iter().copied().fold(DVec2::INFINITY, DVec2::min);
        let high = points.iter().copied().fold(DVec2::NEG_INFINITY, DVec2::max);
        let extent = (high - low).max(DVec2::ZERO);
        let count = points.len().max(1) as f64;
        // Points on a line have no area; then there are as many cells along it.
        let cell = (extent.x * extent.y / count).sqrt().max(extent.max_element() / count).max(f64::MIN_POSITIVE);
        let size = (extent / cell).floor().as_ivec2() + IVec2::ONE;
        let mut grid = Self { points, low, cell, size, starts: Vec::new(), order: vec![0; points.len()] };
        let mut starts = vec![0_u32; size.x as usize * size.y as usize + 1];
        for &point in points {
            starts[grid.cell_of(grid.place_of(point)) + 1] += 1;
        }
        for cell in 1..starts.len() {
            starts[cell] += starts[cell - 1];
        }
        let mut next = starts.clone();
        for (index, &point) in points.iter().enumerate() {
            let slot = &mut next[grid.cell_of(grid.place_of(point))];
            grid.order[*slot as usize] = index as u32;
            *slot += 1;
        }
        grid.starts = starts;
        grid
    }

    fn place_of(&self, point: DVec2) -> IVec2 {
        ((point - self.low) / self.cell).floor().as_ivec2().clamp(IVec2::ZERO, self.size - IVec2::ONE)
    }

    fn cell_of(&self, place: IVec2) -> usize {
        place.x as usize * self.size.y as usize + place.y as usize
    }

    /// The step from a point to the nearest one elsewhere whose step is accepted; none within the rings.
    pub(crate) fn nearest(&self, point: usize, accept: impl Fn(DVec2) -> bool) -> Option<DVec2> {
        let from = self.points[point];
        let centre = self.place_of(from);
        let mut best: Option<DVec2> = None;
        for ring in 0..=MAX_RINGS {
            // All points of further rings are at least so far away.
            if best.is_some_and(|best| best.length() <= f64::from(ring - 1) * self.cell) {
                break;
            }
            for x in (centre.x - ring).max(0)..=(centre.x + ring).min(self.size.x - 1) {
                let is_side = (x - centre.x).abs() == ring;
                for y in (centre.y - ring).max(0)..=(centre.y + ring).min(self.size.y - 1) {
                    if !is_side && (y - centre.y).abs() != ring {
                        continue;
                    }
                    let cell = self.cell_of(IVec2::new(x, y));
                    for &other in &self.order[self.starts[cell] as usize..self.starts[cell + 1] as usize] {
                        let step = self.points[other as usize] - from;
                        let is_nearer = best.is_none_or(|best| step.length_squared() < best.length_squared());
                        if step != DVec2::ZERO && is_nearer && accept(step) {
                            best = Some(step);
                        }
                    }
                }
            }
        }
        best
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_nearest_is_that_of_brute_force() {
        let mut state = 1_u64;
        let mut random = || {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (state >> 40) as f64 / (1 << 24) as f64
        };
        let points: Vec<DVec2> = (0..300).map(|_| DVec2::new(1000.0 * random(), 300.0 * random())).collect();
        let grid = PointGrid::of(&points);
        for (index, &from) in points.iter().enumerate() {
            let brute = |accept: &dyn Fn(DVec2) -> bool| {
                points
                    .iter()
                    .map(|&p| p - from)
                    .filter(|&d| d != DVec2::ZERO && accept(d))
                    .map(|d| d.length())
                    .fold(f64::INFINITY, f64::min)
            };
            assert_eq!(grid.nearest(index, |_| true).unwrap().length(), brute(&|_| true));
            let right = |d: DVec2| d.x > 20.0;
            let expected = brute(&right);
            if expected < 200.0 {
                assert_eq!(grid.nearest(index, right).unwrap().length(), expected);
            }
        }
    }

    #[test]
    fn points_on_a_line_or_in_one_place_are_no_trouble() {
        let line: Vec<DVec2> = (0..50).map(|k| DVec2::new(12.5 * f64::from(k), 0.0)).collect();
        assert_eq!(PointGrid::of(&line).nearest(7, |_| true).unwrap().length(), 12.5);
        let place = vec![DVec2::ONE; 9];
        assert_eq!(PointGrid::of(&place).nearest(3, |_| true), None);
    }
}
