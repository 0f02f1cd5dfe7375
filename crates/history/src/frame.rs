//! Coordinates across and along a direction on the map.

use glam::{DVec2, DVec3};

/// A place and a direction on the map: `u` across it, to the right of who looks along it, `v` along it, depth below the
/// place.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Frame {
    /// Where (0, 0, 0) is.
    pub at: DVec3,
    /// Unit vector across, to the right.
    pub across: DVec2,
    /// Unit vector along.
    pub along: DVec2,
}

impl Frame {
    /// Along a trend, degrees clockwise from north, through a place.
    pub(crate) fn new(at: DVec3, trend_deg: f64) -> Self {
        let (sin, cos) = trend_deg.to_radians().sin_cos();
        // Whole right angles give whole numbers, so that boundaries of blocks are met exactly.
        let whole = |value: f64| if value.abs() < 1e-15 { 0.0 } else { value };
        let (sin, cos) = (whole(sin), whole(cos));
        Self { at, across: DVec2::new(cos, -sin), along: DVec2::new(sin, cos) }
    }

    /// (u, v, depth below the place) of a place.
    #[inline]
    pub(crate) fn local(&self, p: DVec3) -> DVec3 {
        let offset = p - self.at;
        let map = offset.truncate();
        DVec3::new(map.dot(self.across), map.dot(self.along), offset.z)
    }

    /// The place at (u, v, depth below the place).
    #[inline]
    pub(crate) fn place(&self, local: DVec3) -> DVec3 {
        self.at + (self.across * local.x + self.along * local.y).extend(local.z)
    }

    /// A direction in (u, v, depth).
    pub(crate) fn direction(&self, local: DVec3) -> DVec3 {
        (self.across * local.x + self.along * local.y).extend(local.z)
    }
}

/// Turns (u, depth) so that what was level dips by an angle towards positive u.
#[inline]
pub(crate) fn turned(u: f64, z: f64, (sin, cos): (f64, f64)) -> (f64, f64) {
    (u * cos - z * sin, u * sin + z * cos)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn east_lies_across_north_and_places_come_back() {
        let frame = Frame::new(DVec3::new(10.0, 20.0, 5.0), 0.0);
        assert_eq!(frame.local(DVec3::new(13.0, 24.0, 6.0)), DVec3::new(3.0, 4.0, 1.0));
        let oblique = Frame::new(DVec3::new(1.0, 2.0, 3.0), 37.0);
        let p = DVec3::new(-4.0, 9.0, 11.0);
        assert!((oblique.place(oblique.local(p)) - p).length() < 1e-12);
        // A level line that is turned by 30 degrees lies deeper towards positive u.
        let (u, z) = turned(10.0, 0.0, 30f64.to_radians().sin_cos());
        assert!(u > 0.0 && (z / u - 30f64.to_radians().tan()).abs() < 1e-12);
    }
}
