//! Facts about a stored volume, besides its samples.

use serde::{Deserialize, Serialize};
use survey::geometry::SurveyGeometry;

/// Kind of the group.
pub(super) const KIND: &str = "volume";

/// Facts about a volume, besides its samples.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct VolumeInfo {
    /// Its lattice.
    pub geometry: SurveyGeometry,
    /// What was measured: "amplitude", "acoustic impedance", …
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub quantity: Option<String>,
    /// Unit of the samples.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub unit: Option<String>,
    /// "normal" (SEG: more impedance below is positive) or "reverse".
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub polarity: Option<String>,
    /// Where it came from.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub source: Option<String>,
}

impl VolumeInfo {
    /// The facts of a volume of which only the lattice is known.
    pub fn of(geometry: SurveyGeometry) -> Self {
        Self { geometry, quantity: None, unit: None, polarity: None, source: None }
    }
}
