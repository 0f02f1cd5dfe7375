//! Where values on a grid lie between two levels, as rings.
//!
//! Each cell is two triangles on which the value is linear. What a triangle has of the band is convex; pieces side by
//! side cancel the edges that they share, since a crossing of a grid edge is computed from that edge alone, and what is
//! left is traced.

use glam::DVec2;
use std::collections::BTreeMap;

/// The rings of the places with `levels[0]` ≤ value < `levels[1]`, in cells of a grid with `cells` cells along x and y.
/// `value` gives the value at a node; a cell with one that is not finite, or that `has` leaves out, has no part. Rings
/// turn from x to y, holes the other way.
///
/// ```
/// // A value that grows along x from 0 to 4: a band from 1 to 2.5.
/// let rings = model::section::band([4, 3], |x, _| x as f64, |_, _| true, [1.0, 2.5]);
/// let all = || rings.iter().flatten();
/// assert_eq!(rings.len(), 1);
/// assert!(all().all(|p| p.x >= 1.0 && p.x <= 2.5 && p.y >= 0.0 && p.y <= 3.0));
/// ```
pub fn band(
    cells: [usize; 2],
    value: impl Fn(usize, usize) -> f64,
    has: impl Fn(usize, usize) -> bool,
    levels: [f64; 2],
) -> Vec<Vec<DVec2>> {
    let mut edges: BTreeMap<(ExactPlace, ExactPlace), [DVec2; 2]> = BTreeMap::new();
    for x in 0..cells[0] {
        for y in (0..cells[1]).filter(|y| has(x, *y)) {
            let node = |dx: usize, dy: usize| (DVec2::new((x + dx) as f64, (y + dy) as f64), value(x + dx, y + dy));
            let [a, b, c, d] = [node(0, 0), node(1, 0), node(1, 1), node(0, 1)];
            if ![a, b, c, d].iter().all(|(_, value)| value.is_finite()) {
                continue;
            }
            for triangle in [[a, b, c], [a, c, d]] {
                let piece = clipped(&triangle, levels);
                for n in 0..piece.len() {
                    let (from, to) = (piece[n], piece[(n + 1) % piece.len()]);
                    let (k, l) = (key(from), key(to));
                    if k != l && edges.remove(&(l, k)).is_none() {
                        edges.insert((k, l), [from, to]);
                    }
                }
            }
        }
    }
    traced(edges)
}

/// A place, exactly.
type ExactPlace = [u64; 2];

fn key(at: DVec2) -> ExactPlace {
    // Zero has one sign.
    [(at.x + 0.0).to_bits(), (at.y + 0.0).to_bits()]
}

/// The part of a triangle between two levels.
fn clipped(triangle: &[(DVec2, f64); 3], [low, high]: [f64; 2]) -> Vec<DVec2> {
    let mut piece = Vec::new();
    for n in 0..3 {
        let (a, b) = (triangle[n], triangle[(n + 1) % 3]);
        if a.1 >= low && a.1 < high {
            piece.push(a.0);
        }
        // Neighbours meet the same edge from its other end: both take it from the same one.
        let (first, last) = if (a.0.x, a.0.y) < (b.0.x, b.0.y) { (a, b) } else { (b, a) };
        let crosses = |level: &f64| (a.1 < *level) != (b.1 < *level);
        let place = |level: f64| first.0.lerp(last.0, ((level - first.1) / (last.1 - first.1)).clamp(0.0, 1.0));
        let order = if a.1 < b.1 { [low, high] } else { [high, low] };
        piece.extend(order.into_iter().filter(crosses).map(place));
    }
    piece.dedup();
    piece
}

/// Chains edges into rings; points on a straight line are left out.
fn traced(mut edges: BTreeMap<(ExactPlace, ExactPlace), [DVec2; 2]>) -> Vec<Vec<DVec2>> {
    let mut rings = Vec::new();
    while let Some(((begin, mut at), [first, second])) = edges.pop_first() {
        let mut ring = vec![first, second];
        while at != begin {
            let next = edges.range((at, [0; 2])..=(at, [u64::MAX; 2])).next().map(|(key, _)| *key);
            let Some(key) = next else { break };
            ring.extend(edges.remove(&key).map(|[_, to]| to));
            at = key.1;
        }
        ring.pop();
        let count = ring.len();
        let bends = |n: &usize| {
            let [before, here, after] = [ring[(n + count - 1) % count], ring[*n], ring[(n + 1) % count]];
            (here - before).perp_dot(after - here).abs() > 1e-9
        };
        let kept: Vec<DVec2> = (0..count).filter(bends).map(|n| ring[n]).collect();
        if kept.len() > 2 {
            rings.push(kept);
        }
    }
    rings
}

#[cfg(test)]
mod tests {
    use super::*;

    fn area(rings: &[Vec<DVec2>]) -> f64 {
        let of = |ring: &Vec<DVec2>| {
            (0..ring.len()).map(|n| 0.5 * ring[n].perp_dot(ring[(n + 1) % ring.len()])).sum::<f64>()
        };
        rings.iter().map(of).sum()
    }

    #[test]
    fn a_ring_between_two_circles_has_a_hole() {
        let radius = |x: usize, y: usize| (DVec2::new(x as f64, y as f64) - 20.0).length();
        let rings = band([40, 40], radius, |_, _| true, [8.0, 15.0]);
        assert_eq!(rings.len(), 2);
        let expected = std::f64::consts::PI * (15.0 * 15.0 - 8.0 * 8.0);
        assert!((area(&rings) - expected).abs() < 0.01 * expected, "{}", area(&rings));
    }

    #[test]
    fn bands_side_by_side_fill_the_whole_once() {
        let wave = |x: usize, y: usize| 0.1 * y as f64 + 0.3 * (0.4 * x as f64).sin();
        let levels = [f64::from(f32::MIN), 0.0, 0.25, 0.5, f64::from(f32::MAX)];
        let parts: f64 =
            levels.windows(2).map(|pair| area(&band([30, 10], wave, |_, _| true, [pair[0], pair[1]]))).sum();
        assert!((parts - 300.0).abs() < 1e-6, "{parts}");
        assert!(band([30, 10], wave, |_, _| true, [5.0, 6.0]).is_empty());
        let half = band([30, 10], |_, _| 0.0, |x, _| x < 15, [-1.0, 1.0]);
        assert_eq!((half.len(), half[0].len(), area(&half)), (1, 4, 150.0));
    }
}
