//! What the user says about a file that is written, and what was done.

use serde::{Deserialize, Serialize};

/// What happens to a rotated grid in a format that holds none.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum WhenRotated {
    /// It is resampled onto an unrotated grid, and the report says so.
    #[default]
    Resample,
    /// It is refused.
    Refuse,
}

/// What the user says about a file that is written.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(default)]
pub struct ExportOptions {
    /// What happens to a rotated grid in a format that holds none (ZMAP+, CPS-3).
    pub when_rotated: WhenRotated,
}

/// What was written.
#[derive(Debug, Clone, Default, PartialEq, Serialize)]
pub struct ExportReport {
    /// Nodes with a depth.
    pub nodes: usize,
    /// What the user should know, one sentence each.
    pub notes: Vec<String>,
}
