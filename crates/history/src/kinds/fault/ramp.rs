//! A fault that steps up from one level to another on a ramp: its hanging wall bends as it passes (fault-bend fold).
//!
//! Rock moves parallel to the fault beneath it, everywhere by the same length, and turns where it crosses the bisector of a
//! bend. A place has the height n above the fault and the length S along a line at that height; S = S′ + slip. Lengths
//! along such lines, the thickness of beds that lay along the flats, and area in section are kept.
//!
//! At the height n a bend by the angle β shortens or lengthens each of its two sides by n tan(β/2).

use glam::{DVec2, DVec3};

/// A polygon in (u, depth) from the left to the right, level at its ends unless it has no flat.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Ramp {
    /// Bends, and the tangent of half of the angle by which the fault turns down there.
    bends: Vec<(DVec2, f64)>,
    /// Direction of each piece, one more than bends.
    ways: Vec<DVec2>,
    /// Slip, positive down the ramp.
    slip: f64,
    /// Movement along strike, m.
    along: f64,
}

impl Ramp {
    /// A ramp through u = 0 at depth 0; depths of its flats below that place, where there are some.
    pub(crate) fn new(dip_deg: f64, upper: Option<f64>, lower: Option<f64>, slip: f64, along: f64) -> Self {
        let (sin, cos) = dip_deg.to_radians().sin_cos();
        let (ramp, half) = (DVec2::new(cos, sin), (0.5 * dip_deg.to_radians()).tan());
        let mut made = Self { bends: Vec::new(), ways: Vec::new(), slip, along };
        if let Some(depth) = upper {
            made.ways.push(DVec2::X);
            made.bends.push((ramp * (depth / sin), half));
        }
        made.ways.push(ramp);
        if let Some(depth) = lower {
            made.bends.push((ramp * (depth / sin), -half));
            made.ways.push(DVec2::X);
        }
        made
    }

    /// Which piece a place belongs to, its length along the piece from the bend before (from the bend after it for the
    /// first), and its height above it.
    fn on_piece(&self, p: DVec2) -> (usize, f64, f64) {
        let is_past = |n: &usize| (p - self.bends[*n].0).dot(self.ways[*n] + self.ways[*n + 1]) > 0.0;
        let piece = (0..self.bends.len()).rev().find(is_past).map_or(0, |n| n + 1);
        let way = self.ways[piece];
        let from = self.bends.get(piece.saturating_sub(1)).map_or(DVec2::ZERO, |bend| bend.0);
        let offset = p - from;
        (piece, offset.dot(way), offset.dot(DVec2::new(way.y, -way.x)))
    }

    /// Height above the fault, positive in the hanging wall.
    pub(crate) fn offset(&self, local: DVec3) -> f64 {
        self.on_piece(DVec2::new(local.x, local.z)).2
    }

    /// Where a piece begins and ends at a height, as lengths from its first bend.
    fn ends(&self, piece: usize, height: f64) -> [f64; 2] {
        let half = |n: usize| self.bends[n].1 * height;
        if self.bends.is_empty() {
            return [f64::NEG_INFINITY, f64::INFINITY];
        }
        if piece == 0 {
            return [f64::NEG_INFINITY, half(0)];
        }
        let end = match self.bends.get(piece) {
            Some(bend) => bend.0.distance(self.bends[piece - 1].0) + half(piece),
            None => f64::INFINITY,
        };
        [-half(piece - 1), end]
    }

    fn moved(&self, local: DVec3, by: f64, along: f64) -> DVec3 {
        let (mut piece, mut s, height) = self.on_piece(DVec2::new(local.x, local.z));
        let mut left = by;
        // From piece to piece, as far as the slip reaches.
        for _ in 0..=self.bends.len() {
            let [start, end] = self.ends(piece, height);
            let to = s + left;
            if to > end && piece + 1 < self.ways.len() {
                left -= end - s;
                piece += 1;
                s = self.ends(piece, height)[0];
            } else if to < start && piece > 0 {
                left -= start - s;
                piece -= 1;
                s = self.ends(piece, height)[1];
            } else {
                s = to;
                break;
            }
        }
        let from = self.bends.get(piece.saturating_sub(1)).map_or(DVec2::ZERO, |bend| bend.0);
        let way = self.ways[piece];
        let p = from + way * s + DVec2::new(way.y, -way.x) * height;
        DVec3::new(p.x, local.y + along, p.y)
    }

    pub(crate) fn undo(&self, local: DVec3, is_hanging: bool) -> DVec3 {
        if is_hanging { self.moved(local, -self.slip, -self.along) } else { local }
    }

    pub(crate) fn apply(&self, local: DVec3, is_hanging: bool) -> DVec3 {
        if is_hanging { self.moved(local, self.slip, self.along) } else { local }
    }

    /// The line of the fault in (u, depth), as far as `far` to both sides.
    pub(crate) fn trace(&self, far: f64) -> Vec<DVec2> {
        let first = self.bends.first().map_or(DVec2::ZERO, |bend| bend.0) - self.ways[0] * far;
        let last = self.bends.last().map_or(DVec2::ZERO, |bend| bend.0) + self.ways[self.ways.len() - 1] * far;
        std::iter::once(first).chain(self.bends.iter().map(|bend| bend.0)).chain([last]).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rock_that_climbs_the_ramp_keeps_its_height_above_the_fault() {
        let ramp = Ramp::new(25.0, Some(-300.0), Some(300.0), -800.0, 0.0);
        for n in 0..400 {
            let q = DVec3::new(f64::from(n) * 12.0 - 2000.0, 3.0, 250.0 - f64::from(n % 40) * 10.0);
            if ramp.offset(q) <= 0.0 {
                continue;
            }
            let p = ramp.apply(q, true);
            assert!((ramp.offset(p) - ramp.offset(q)).abs() < 1e-9, "{q}");
            assert!((ramp.undo(p, true) - q).length() < 1e-8, "{q} {p}");
        }
        // On the upper flat rock moves level, and by the whole slip.
        let far = DVec3::new(-3000.0, 0.0, -400.0);
        assert!((ramp.apply(far, true) - (far - DVec3::X * 800.0)).length() < 1e-9);
    }
}
