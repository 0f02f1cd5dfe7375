//! A plane, on which the hanging wall slips as a whole, or most at the centre of an ellipse and not at all at its tip line.
//!
//! With a tip, both walls move by half of the slip, which dies out towards the tip line and away from the fault:
//!
//! ```text
//! p = q ± ½ s (1 − r²)² exp(−(w/W)²)        r = |(v / a, b / c)|
//! ```
//!
//! v is measured along strike, b down the dip, w off the plane; a and c are the half axes of the ellipse. The way back is
//! a solve along the direction of slip, monotone as long as 0.77 |s| is less than the shorter half axis.

use crate::solve::root;
use glam::{DVec2, DVec3};

/// Greatest slope of (1 − r²)², at r = 1/√3.
const STEEPEST: f64 = 1.54;

/// A plane in (u, v, depth), u towards its dip, and the slip of its hanging wall.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Plane {
    /// Unit vector down the dip.
    down: DVec3,
    /// Unit vector into the hanging wall.
    normal: DVec3,
    /// Slip of the hanging wall.
    slip: DVec3,
    tip: Option<Tip>,
}

/// Where a fault ends.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Tip {
    /// Half axes along strike and down the dip, m.
    pub half: DVec2,
    /// Distance off the fault over which its slip dies out, m.
    pub reach: f64,
}

impl Plane {
    /// A plane that dips by an angle; slip down the dip, and along strike.
    pub(crate) fn new(dip_deg: f64, slip_m: f64, along_m: f64, tip: Option<Tip>) -> Self {
        let (sin, cos) = if dip_deg == 90.0 { (1.0, 0.0) } else { dip_deg.to_radians().sin_cos() };
        let down = DVec3::new(cos, 0.0, sin);
        Self { down, normal: DVec3::new(sin, 0.0, -cos), slip: down * slip_m + DVec3::Y * along_m, tip }
    }

    /// Whether the way back has one answer everywhere.
    pub(crate) fn is_gentle(&self) -> bool {
        self.tip.is_none_or(|tip| 0.5 * STEEPEST * self.slip.length() < 0.98 * tip.half.min_element())
    }

    /// Distance from the plane, positive in the hanging wall.
    pub(crate) fn offset(&self, local: DVec3) -> f64 {
        local.dot(self.normal)
    }

    /// Share of the slip that is there at a place.
    fn share(&self, tip: &Tip, local: DVec3) -> f64 {
        let r = DVec2::new(local.y, local.dot(self.down)) / tip.half;
        let off = self.offset(local) / tip.reach;
        (1.0 - r.length_squared()).max(0.0).powi(2) * (-off * off).exp()
    }

    pub(crate) fn undo(&self, local: DVec3, is_hanging: bool) -> DVec3 {
        let Some(tip) = &self.tip else { return if is_hanging { local - self.slip } else { local } };
        let slip = if is_hanging { 0.5 } else { -0.5 } * self.slip;
        let share = root(0.0, 1.0, 1e-13, |share| share - self.share(tip, local - slip * share));
        local - slip * share
    }

    pub(crate) fn apply(&self, local: DVec3, is_hanging: bool) -> DVec3 {
        match &self.tip {
            None if is_hanging => local + self.slip,
            None => local,
            Some(tip) => local + if is_hanging { 0.5 } else { -0.5 } * self.slip * self.share(tip, local),
        }
    }

    /// The line of the fault in (u, depth), between two depths.
    pub(crate) fn trace(&self, depths: [f64; 2]) -> Vec<DVec2> {
        depths.map(|z| DVec2::new(z * self.down.x / self.down.z, z)).to_vec()
    }

    /// Where it ends.
    pub(crate) fn tip(&self) -> Option<&Tip> {
        self.tip.as_ref()
    }
}
