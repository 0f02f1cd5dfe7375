//! What is known of a stored volume beside its samples.

use serde::{Deserialize, Serialize};
use survey::geometry::SurveyGeometry;

/// Kind of the group.
pub(super) const KIND: &str = "volume";

/// What is known of a volume beside its samples.
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
    /// Nothing known but the lattice.
    pub fn of(geometry: SurveyGeometry) -> Self {
        Self { geometry, quantity: None, unit: None, polarity: None, source: None }
    }
}
