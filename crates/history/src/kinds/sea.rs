//! Water up to a level: `kind = "sea"`. Where there is no rock below the level, there is water.

use crate::error::HistoryError;
use crate::fields::{Fields, Within};

/// A level of water.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Sea {
    /// Depth of its surface, m.
    pub level_m: f64,
}

impl Sea {
    pub(crate) fn read(fields: &Fields<'_>) -> Result<Self, HistoryError> {
        Ok(Self { level_m: fields.or("level", Within::Any, 0.0)? })
    }
}
