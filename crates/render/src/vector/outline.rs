//! A pattern cut off at the outline of its area, so that no path of it leaves its layer or crosses a fault.
//!
//! Lines are parted where they cross the outline (even-odd rule). Of an area that crosses it, the part within is kept:
//! the outline clipped by each convex part of the area (I. E. Sutherland and G. W. Hodgman, "Reentrant polygon
//! clipping", 1974), which takes any outline and turns as the area does. Lines with dashes are left whole, since parting
//! them would shift their dashes, and are hidden by the clip that writers set.
//!
//! Space: pixels.

use super::{PatternPaint, Polyline};
use glam::DVec2;
use survey::block::convex_parts;

/// Sides of an outline are found by rows of about so many pixels, of which there are no more than so many.
const ROW_PX: f64 = 4.0;
const MOST_ROWS: f64 = 4096.0;
/// An area of more corners is left whole.
const MOST_CORNERS: usize = 400;
/// What is left of areas below this is nothing, square pixels.
const LEAST: f64 = 1e-6;

/// The outline of an area, even-odd.
pub(super) struct Outline<'a> {
    rings: &'a [Vec<DVec2>],
    low: f64,
    step: f64,
    /// The sides that pass through each row.
    rows: Vec<Vec<[DVec2; 2]>>,
}

impl<'a> Outline<'a> {
    pub(super) fn new(rings: &'a [Vec<DVec2>]) -> Self {
        let ys = || rings.iter().flatten().map(|p| p.y);
        let (low, high) = (ys().fold(f64::INFINITY, f64::min), ys().fold(f64::NEG_INFINITY, f64::max));
        let count = ((high - low) / ROW_PX).ceil().clamp(1.0, MOST_ROWS);
        let step = ((high - low) / count).max(f64::MIN_POSITIVE);
        let mut outline = Self { rings, low, step, rows: vec![Vec::new(); count as usize] };
        for ring in rings {
            for n in 0..ring.len() {
                let side = [ring[n], ring[(n + 1) % ring.len()]];
                for row in outline.rows_between(side[0].y, side[1].y) {
                    outline.rows[row].push(side);
                }
            }
        }
        outline
    }

    fn rows_between(&self, a: f64, b: f64) -> std::ops::Range<usize> {
        let row = |y: f64| ((y - self.low) / self.step).floor();
        let (first, last) = (row(a.min(b)), row(a.max(b)));
        // Neither holds for NaN. Sides along the lower end belong to the last row.
        let count = self.rows.len();
        let is_within = last >= 0.0 && first <= count as f64;
        if !is_within {
            return 0..0;
        }
        (first.max(0.0) as usize).min(count - 1)..(last as usize + 1).min(count)
    }

    /// Whether a place lies within.
    fn holds(&self, p: DVec2) -> bool {
        let Some(row) = self.rows_between(p.y, p.y).next() else { return false };
        let crossed = self.rows[row]
            .iter()
            .filter(|[a, b]| (a.y <= p.y) != (b.y <= p.y) && a.x + (b.x - a.x) * (p.y - a.y) / (b.y - a.y) > p.x);
        crossed.count() % 2 == 1
    }

    /// Where a straight line crosses the outline, as shares of it, in order.
    fn crossings(&self, a: DVec2, b: DVec2) -> Vec<f64> {
        let step = b - a;
        let (low, high) = (a.min(b), a.max(b));
        let mut found: Vec<f64> = Vec::new();
        for row in self.rows_between(a.y, b.y) {
            for [p, q] in &self.rows[row] {
                let is_near = p.min(*q).cmple(high).all() && p.max(*q).cmpge(low).all();
                let turn = step.perp_dot(q - p);
                if !is_near || turn == 0.0 {
                    continue;
                }
                let (along, across) = ((p - a).perp_dot(q - p) / turn, (p - a).perp_dot(step) / turn);
                if (0.0..=1.0).contains(&along) && (0.0..=1.0).contains(&across) {
                    found.push(along);
                }
            }
        }
        found.sort_by(f64::total_cmp);
        found.dedup();
        found
    }

    /// Pieces of a pattern that look alike, cut off at the outline.
    pub(super) fn cut(&self, paint: &PatternPaint, lines: Vec<Polyline>) -> Vec<Polyline> {
        match paint {
            PatternPaint::Line { dashes_px, .. } if !dashes_px.is_empty() => lines,
            PatternPaint::Line { .. } => lines.into_iter().flat_map(|line| self.cut_line(line)).collect(),
            PatternPaint::Area { .. } => lines.into_iter().flat_map(|area| self.cut_area(area)).collect(),
        }
    }

    /// The parts of a line within.
    fn cut_line(&self, line: Polyline) -> Vec<Polyline> {
        let Some(first) = line.points.first().copied() else { return Vec::new() };
        let closing = line.closed.then_some(first);
        let points: Vec<DVec2> = line.points.iter().copied().chain(closing).collect();
        let crossings: Vec<Vec<f64>> = points.windows(2).map(|pair| self.crossings(pair[0], pair[1])).collect();
        if crossings.iter().all(Vec::is_empty) {
            return if self.holds(first) { vec![line] } else { Vec::new() };
        }
        let mut parts: Vec<Vec<DVec2>> = Vec::new();
        let mut is_open = false;
        let mut is_within = self.holds(first);
        for (pair, crossings) in points.windows(2).zip(&crossings) {
            let at = |share: f64| pair[0].lerp(pair[1], share);
            let ends: Vec<f64> = [0.0].into_iter().chain(crossings.iter().copied()).chain([1.0]).collect();
            for between in ends.windows(2).filter(|between| between[1] > between[0] || crossings.is_empty()) {
                if !crossings.is_empty() {
                    is_within = self.holds(at(0.5 * (between[0] + between[1])));
                }
                match (is_within, parts.last_mut().filter(|_| is_open)) {
                    (true, Some(part)) => part.push(at(between[1])),
                    (true, None) => parts.push(vec![at(between[0]), at(between[1])]),
                    (false, _) => {}
                }
                is_open = is_within;
            }
        }
        // A closed line begins in the middle of a part.
        if line.closed && is_open && parts.len() > 1 && parts[0].first() == Some(&first) {
            let begin = parts.remove(0);
            if let Some(last) = parts.last_mut() {
                last.extend(begin.into_iter().skip(1));
            }
        }
        parts.into_iter().map(|points| Polyline { points, closed: false }).collect()
    }

    /// The parts of an area within.
    fn cut_area(&self, area: Polyline) -> Vec<Polyline> {
        let points = &area.points;
        let Some(first) = points.first().copied() else { return Vec::new() };
        let sides = (0..points.len()).map(|n| (points[n], points[(n + 1) % points.len()]));
        if !sides.into_iter().any(|(a, b)| !self.crossings(a, b).is_empty()) {
            // It may lie around a piece of the outline.
            let (low, high) = bounds(points);
            let is_within = |[p, _]: &[DVec2; 2]| p.cmpgt(low).all() && p.cmplt(high).all();
            let is_around = || self.rows_between(low.y, high.y).any(|row| self.rows[row].iter().any(is_within));
            return if self.holds(first) || is_around() { vec![area] } else { Vec::new() };
        }
        if points.len() > MOST_CORNERS {
            return vec![area];
        }
        let is_left = twice_area(points) > 0.0;
        let turned: Vec<DVec2> = if is_left { points.clone() } else { points.iter().rev().copied().collect() };
        let parts: Vec<Vec<DVec2>> = match is_convex(&turned) {
            true => vec![turned],
            false => {
                let parts = convex_parts(&turned).into_iter();
                let parts: Vec<Vec<DVec2>> = parts.map(|part| part.into_iter().map(|n| turned[n]).collect()).collect();
                // An area that crosses itself has no such parts.
                let whole = twice_area(&turned);
                let sum: f64 = parts.iter().map(|part| twice_area(part)).sum();
                if parts.iter().any(|part| !is_convex(part)) || (sum - whole).abs() > 1e-6 * whole {
                    return vec![area];
                }
                parts
            }
        };
        let mut kept = Vec::new();
        for part in &parts {
            let (low, high) = bounds(part);
            for ring in self.rings {
                let (ring_low, ring_high) = bounds(ring);
                if !(ring_low.cmple(high).all() && ring_high.cmpge(low).all()) {
                    continue;
                }
                let mut points = clipped(ring, part);
                if points.len() < 3 || twice_area(&points).abs() < 2.0 * LEAST {
                    continue;
                }
                if !is_left {
                    points.reverse();
                }
                kept.push(Polyline { points, closed: true });
            }
        }
        kept
    }
}

fn bounds(points: &[DVec2]) -> (DVec2, DVec2) {
    points.iter().fold((DVec2::INFINITY, DVec2::NEG_INFINITY), |(low, high), p| (low.min(*p), high.max(*p)))
}

fn twice_area(points: &[DVec2]) -> f64 {
    (0..points.len()).map(|n| points[n].perp_dot(points[(n + 1) % points.len()])).sum()
}

/// Whether a polygon with its inside on the left is convex.
fn is_convex(points: &[DVec2]) -> bool {
    let count = points.len();
    let size = bounds(points).1.distance(bounds(points).0);
    (0..count).all(|n| {
        let [a, b, c] = [points[n], points[(n + 1) % count], points[(n + 2) % count]];
        (b - a).perp_dot(c - b) >= -1e-9 * size * size
    })
}

/// A ring within a convex polygon that has its inside on the left.
pub(super) fn clipped(ring: &[DVec2], convex: &[DVec2]) -> Vec<DVec2> {
    let mut points = ring.to_vec();
    for n in 0..convex.len() {
        let (corner, along) = (convex[n], convex[(n + 1) % convex.len()] - convex[n]);
        let inside = |p: DVec2| along.perp_dot(p - corner);
        let mut kept = Vec::with_capacity(points.len().min(64) + 2);
        for m in 0..points.len() {
            let (a, b) = (points[m], points[(m + 1) % points.len()]);
            let (at_a, at_b) = (inside(a), inside(b));
            if at_a >= 0.0 {
                kept.push(a);
            }
            if (at_a >= 0.0) != (at_b >= 0.0) {
                kept.push(a.lerp(b, at_a / (at_a - at_b)));
            }
        }
        points = kept;
        if points.len() < 3 {
            return Vec::new();
        }
    }
    points
}

#[cfg(test)]
mod tests;
