//! Rock that is changed below a depth: `kind = "metamorphism"`. Beds stay where they are; their rock is another one.

use crate::context::Context;
use crate::error::HistoryError;
use crate::fields::{Fields, Within};
use glam::DVec3;

/// A change of rock below a depth.
#[derive(Debug, Clone, PartialEq)]
pub struct Metamorphism {
    /// Depth below which rock is changed, m.
    pub below_m: f64,
    /// Rock that it becomes.
    pub rock: String,
    /// How far below its place the front still is.
    lowered_m: f64,
    reach_m: f64,
}

impl Metamorphism {
    pub(crate) fn read(fields: &Fields<'_>, context: &Context<'_>) -> Result<Self, HistoryError> {
        let below_m = fields.number("below", Within::Any, "the depth in m below which rock is changed")?;
        let rock = context.rock_or(fields, "rock", "schist")?;
        Ok(Self { below_m, rock, lowered_m: 0.0, reach_m: (context.size.z - below_m).max(0.0) })
    }

    pub(crate) fn progressed(&self, share: f64) -> Self {
        Self { lowered_m: (1.0 - share) * self.reach_m, ..self.clone() }
    }

    pub(crate) fn changes(&self, p: DVec3) -> bool {
        p.z > self.below_m + self.lowered_m
    }
}
