//! The whole block is turned about a level axis: `kind = "tilt"`.
//!
//! The axis runs through the block's centre at depth 0, or through `at`, across the direction of the dip. What was level
//! dips by the angle afterwards; nothing changes its shape.

use crate::context::Context;
use crate::deformation::Deformation;
use crate::error::HistoryError;
use crate::fields::{Fields, Within};
use crate::frame::{Frame, turned};
use glam::DVec3;

/// A rotation about a level axis.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Tilt {
    /// Dip of what was level, degrees.
    pub dip_deg: f64,
    /// Where it dips to, degrees clockwise from north.
    pub direction_deg: f64,
    /// Along the direction of the dip.
    frame: Frame,
}

impl Tilt {
    pub(crate) fn new(at: DVec3, dip_deg: f64, direction_deg: f64) -> Self {
        Self { dip_deg, direction_deg, frame: Frame::new(at, direction_deg) }
    }

    pub(crate) fn read(fields: &Fields<'_>, context: &Context<'_>) -> Result<Self, HistoryError> {
        let dip =
            fields.number("dip", Within::Between(-90.0, 90.0), "how steeply level beds dip afterwards, degrees")?;
        let meaning = "where they dip to, degrees clockwise from north";
        let direction = fields.number("direction", Within::Between(-360.0, 360.0), meaning)?;
        Ok(Self::new(fields.place("at", context.centre())?, dip, direction))
    }

    pub(crate) fn progressed(&self, share: f64) -> Self {
        Self { dip_deg: self.dip_deg * share, ..*self }
    }

    fn by(&self, p: DVec3, deg: f64) -> DVec3 {
        let local = self.frame.local(p);
        let (v, z) = turned(local.y, local.z, deg.to_radians().sin_cos());
        self.frame.place(DVec3::new(local.x, v, z))
    }
}

impl Deformation for Tilt {
    fn undo(&self, p: DVec3, _: i8) -> DVec3 {
        self.by(p, -self.dip_deg)
    }

    fn apply(&self, q: DVec3, _: i8) -> DVec3 {
        self.by(q, self.dip_deg)
    }
}
