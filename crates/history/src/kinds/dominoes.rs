//! Blocks between parallel faults that turn like books on a shelf: `kind = "dominoes"`.
//!
//! The faults dip by δ before and by δ − ω afterwards, and the blocks between them turn by ω the other way. Blocks keep
//! their shape and touch one another, so that the distance across the faults stays, and along the level through `at` they
//! spread from a to a′ = a sin δ / sin(δ − ω).

use crate::context::Context;
use crate::deformation::Deformation;
use crate::error::HistoryError;
use crate::fields::{Fields, Within};
use crate::frame::{Frame, turned};
use glam::DVec3;

/// Turned blocks.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Dominoes {
    /// Dip of the faults before, degrees.
    pub dip_deg: f64,
    /// By how much blocks turn, degrees.
    pub rotation_deg: f64,
    /// Distance between faults before, along the level, m.
    pub spacing_m: f64,
    frame: Frame,
}

/// Blocks are numbered within this many of the one at `at`.
const MOST: f64 = 100.0;

impl Dominoes {
    pub(crate) fn read(fields: &Fields<'_>, context: &Context<'_>) -> Result<Self, HistoryError> {
        let dip_deg = fields.or("dip", Within::Between(20.0, 89.0), 60.0)?;
        let rotation_deg =
            fields.number("rotation", Within::Between(-60.0, 60.0), "by how many degrees its blocks turn")?;
        let spacing_m = fields.number("spacing", Within::Positive, "the distance between its faults in m")?;
        if !(10.0..=89.0).contains(&(dip_deg - rotation_deg)) {
            let left = dip_deg - rotation_deg;
            let said = format!("after it the faults would dip by {left:.0} degrees; they may dip from 10 to 89");
            return Err(fields.unfit("rotation", said));
        }
        if context.longest() / spacing_m > MOST {
            return Err(
                fields.unfit("spacing", format!("these are more than {MOST:.0} faults; state a larger `spacing`"))
            );
        }
        let frame = Frame::new(fields.place("at", context.centre())?, fields.or("strike", Within::Any, 0.0)?);
        Ok(Self { dip_deg, rotation_deg, spacing_m, frame })
    }

    pub(crate) fn progressed(&self, share: f64) -> Self {
        Self { rotation_deg: self.rotation_deg * share, ..*self }
    }

    /// The corners of each fault afterwards, so far as faults lie within `reach` of `at`.
    pub(crate) fn planes(&self, reach: f64) -> Vec<[DVec3; 4]> {
        let (dip, spacing) = self.faults(true);
        let most = (reach / spacing).ceil().min(MOST) as i32;
        let plane = |n: i32| {
            let corner = |v: f64, z: f64| self.frame.place(DVec3::new(f64::from(n) * spacing + z / dip.tan(), v, z));
            [corner(-reach, -reach), corner(-reach, reach), corner(reach, reach), corner(reach, -reach)]
        };
        (-most..=most).map(plane).collect()
    }

    /// Dip and spacing before, or after.
    fn faults(&self, is_after: bool) -> (f64, f64) {
        let (before, after) = (self.dip_deg.to_radians(), (self.dip_deg - self.rotation_deg).to_radians());
        if is_after { (after, self.spacing_m * before.sin() / after.sin()) } else { (before, self.spacing_m) }
    }

    fn block(&self, p: DVec3, is_after: bool) -> i8 {
        let (local, (dip, spacing)) = (self.frame.local(p), self.faults(is_after));
        ((local.x - local.z / dip.tan()) / spacing).floor().clamp(-MOST, MOST) as i8
    }

    fn moved(&self, p: DVec3, block: i8, is_back: bool) -> DVec3 {
        let local = self.frame.local(p);
        let [from, to] = [is_back, !is_back].map(|is_after| f64::from(block) * self.faults(is_after).1);
        let turn = if is_back { self.rotation_deg } else { -self.rotation_deg };
        let (u, z) = turned(local.x - from, local.z, turn.to_radians().sin_cos());
        self.frame.place(DVec3::new(to + u, local.y, z))
    }
}

impl Deformation for Dominoes {
    fn side(&self, p: DVec3) -> i8 {
        self.block(p, true)
    }

    fn side_before(&self, q: DVec3) -> i8 {
        self.block(q, false)
    }

    fn undo(&self, p: DVec3, side: i8) -> DVec3 {
        self.moved(p, side, true)
    }

    fn apply(&self, q: DVec3, side: i8) -> DVec3 {
        self.moved(q, side, false)
    }
}
