//! The whole block rises or, for a negative amount, subsides: `kind = "uplift"`.

use crate::deformation::Deformation;
use crate::error::HistoryError;
use crate::fields::{Fields, Within};
use glam::DVec3;

/// A vertical movement of everything.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Uplift {
    /// How far up, m.
    pub amount_m: f64,
}

impl Uplift {
    pub(crate) fn read(fields: &Fields<'_>) -> Result<Self, HistoryError> {
        let amount_m = fields.number("amount", Within::Any, "how far the block rises in m; negative: it subsides")?;
        Ok(Self { amount_m })
    }

    pub(crate) fn progressed(&self, share: f64) -> Self {
        Self { amount_m: self.amount_m * share }
    }
}

impl Deformation for Uplift {
    fn undo(&self, p: DVec3, _: i8) -> DVec3 {
        p + DVec3::Z * self.amount_m
    }

    fn apply(&self, q: DVec3, _: i8) -> DVec3 {
        q - DVec3::Z * self.amount_m
    }
}
