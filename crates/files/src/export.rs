//! Options for writing a file, and the report of what was written.

use serde::{Deserialize, Serialize};

/// How a rotated grid is written in a format that cannot represent it.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum WhenRotated {
    /// It is resampled onto an unrotated grid, and the report says so.
    #[default]
    Resample,
    /// It is refused.
    Refuse,
}

/// Options for writing a file.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(default)]
pub struct ExportOptions {
    /// How a rotated grid is written in a format that cannot represent it (ZMAP+, CPS-3).
    pub when_rotated: WhenRotated,
}

/// The report of what was written.
#[derive(Debug, Clone, Default, PartialEq, Serialize)]
pub struct ExportReport {
    /// Nodes with a depth.
    pub nodes: usize,
    /// What the user should know, one sentence each.
    pub notes: Vec<String>,
}
