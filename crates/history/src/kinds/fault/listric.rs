//! A fault that flattens downwards onto a level detachment; its hanging wall collapses onto it and rolls over.
//!
//! ```text
//! F(u) = D (1 − exp(−u tan δ / D))        u = F⁻¹ continues straight above the place where the dip is δ
//! ```
//!
//! The hanging wall is drawn away by the heave h and sinks along planes of shear until it lies on the fault again. Along
//! such a plane, c = u + z cot α (α the dip of the planes, 90° for vertical ones), the fault lies at the depth G(c):
//!
//! ```text
//! c = c′ + h        z = z′ + G(c) − G(c′)
//! ```
//!
//! Area in section is kept, since each plane moves as a whole.

use crate::solve::root;
use glam::{DVec2, DVec3};

/// The curve in (u, depth), and how far the hanging wall is drawn away.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Listric {
    /// Tangent of the dip at u = 0.
    steep: f64,
    /// Depth of the detachment below u = 0, m.
    detachment: f64,
    /// Cotangent of the dip of the planes of shear, which dip against the fault.
    cot: f64,
    /// Heave, m.
    heave: f64,
    /// Movement along strike, m.
    along: f64,
}

impl Listric {
    /// With a slip that is measured along the fault from u = 0.
    pub(crate) fn new(dip_deg: f64, detachment: f64, shear_deg: f64, slip_m: f64, along: f64) -> Self {
        let cot = if shear_deg == 90.0 { 0.0 } else { 1.0 / shear_deg.to_radians().tan() };
        let mut made = Self { steep: dip_deg.to_radians().tan(), detachment, cot, heave: 0.0, along };
        let length = |heave: f64| made.arc(made.u_of(heave));
        let most = 2.0 * slip_m + slip_m.signum() * made.cot * detachment;
        made.heave = if slip_m == 0.0 { 0.0 } else { root(0.0, most, 1e-10, |heave| length(heave) - slip_m) };
        made
    }

    /// Depth of the fault.
    fn depth(&self, u: f64) -> f64 {
        if u <= 0.0 { u * self.steep } else { self.detachment * (1.0 - (-u * self.steep / self.detachment).exp()) }
    }

    /// Depth of the fault along a plane of shear.
    fn along_shear(&self, c: f64) -> f64 {
        if self.cot == 0.0 {
            return self.depth(c);
        }
        if c <= 0.0 {
            return c * self.steep / (1.0 + self.steep * self.cot);
        }
        root(0.0, self.detachment, 1e-11, |z| z - self.depth(c - z * self.cot))
    }

    /// u where a plane of shear meets the fault.
    fn u_of(&self, c: f64) -> f64 {
        c - self.along_shear(c) * self.cot
    }

    /// Length of the fault from 0 to u, with its sign: ∫ √(1 + F′²) du, whose closed form is √ and artanh of F′.
    fn arc(&self, u: f64) -> f64 {
        let root_at = |slope: f64| slope.hypot(1.0);
        if u <= 0.0 {
            return u * root_at(self.steep);
        }
        // With t = F′ = tan δ e^(−u tan δ / D), du = −D / tan δ · dt / t.
        let t = self.steep * (-u * self.steep / self.detachment).exp();
        let primitive = |t: f64| root_at(t) - (1.0 / t).asinh();
        self.detachment / self.steep * (primitive(self.steep) - primitive(t))
    }

    /// Height of a place above the fault, positive in the hanging wall: m along a vertical.
    pub(crate) fn offset(&self, local: DVec3) -> f64 {
        (self.depth(local.x) - local.z) / self.steep.hypot(1.0)
    }

    pub(crate) fn undo(&self, local: DVec3, is_hanging: bool) -> DVec3 {
        self.moved(local, is_hanging, -1.0)
    }

    pub(crate) fn apply(&self, local: DVec3, is_hanging: bool) -> DVec3 {
        self.moved(local, is_hanging, 1.0)
    }

    fn moved(&self, local: DVec3, is_hanging: bool, sign: f64) -> DVec3 {
        if !is_hanging || self.heave == 0.0 && self.along == 0.0 {
            return local;
        }
        let c = local.x + local.z * self.cot;
        let to = c + sign * self.heave;
        let z = local.z + self.along_shear(to) - self.along_shear(c);
        DVec3::new(to - z * self.cot, local.y + sign * self.along, z)
    }

    /// The line of the fault in (u, depth), down to where it is level within a hundredth of its depth.
    pub(crate) fn trace(&self, above: f64, far: f64) -> Vec<DVec2> {
        const POINTS: usize = 48;
        let first = -above / self.steep;
        let point = |n: usize| {
            let share = n as f64 / POINTS as f64;
            let u = if n == 0 { first } else { far * share * share };
            DVec2::new(u, self.depth(u))
        };
        (0..=POINTS).map(point).collect()
    }

    /// Slip along the fault that lowers a bed at u = 0 by this throw.
    pub(crate) fn slip_of_throw(dip_deg: f64, detachment: f64, throw: f64) -> f64 {
        let made = Self { steep: dip_deg.to_radians().tan(), detachment, cot: 0.0, heave: 0.0, along: 0.0 };
        if throw <= 0.0 {
            return throw / dip_deg.to_radians().sin();
        }
        let left = (1.0 - throw / detachment).max(1e-6);
        made.arc(-detachment / made.steep * left.ln())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lengths_along_the_fault_are_those_of_a_polygon() {
        let fault = Listric::new(65.0, 1500.0, 90.0, 300.0, 0.0);
        let h = 0.01;
        let polygon: f64 =
            (0..80_000).map(|n| (fault.depth(h * f64::from(n + 1)) - fault.depth(h * f64::from(n))).hypot(h)).sum();
        assert!((fault.arc(800.0) - polygon).abs() < 1e-5, "{} {polygon}", fault.arc(800.0));
        // What was at u = 0 lies 300 m along the fault.
        let moved = fault.apply(DVec3::ZERO, true);
        assert!((fault.arc(moved.x) - 300.0).abs() < 1e-6 && fault.offset(moved).abs() < 1e-9);
        let thrown = Listric::new(65.0, 1500.0, 90.0, Listric::slip_of_throw(65.0, 1500.0, 400.0), 0.0);
        assert!((thrown.apply(DVec3::ZERO, true).z - 400.0).abs() < 1e-6);
    }

    #[test]
    fn inclined_planes_of_shear_leave_the_hanging_wall_on_the_fault() {
        let fault = Listric::new(60.0, 1200.0, 55.0, 350.0, 0.0);
        for u in [10.0, 200.0, 900.0, 2500.0] {
            let on = DVec3::new(u, 0.0, fault.depth(u));
            assert!(fault.offset(fault.apply(on, true)).abs() < 1e-7, "{u}");
            let inside = on - DVec3::Z * 150.0;
            assert!((fault.undo(fault.apply(inside, true), true) - inside).length() < 1e-7);
        }
        assert!((fault.arc(fault.apply(DVec3::ZERO, true).x) - 350.0).abs() < 1e-6);
    }
}
