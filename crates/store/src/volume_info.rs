//! Facts about a stored volume, besides its samples.

use super::error::StoreError;
use super::header::read_header;
use serde::{Deserialize, Serialize};
use std::path::Path;
use survey::Quantity;
use survey::geometry::SurveyGeometry;

/// Kind of the group.
pub(super) const KIND: &str = "volume";

/// Facts about a volume, besides its samples.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct VolumeInfo {
    /// Its lattice.
    pub geometry: SurveyGeometry,
    /// What was measured.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub quantity: Option<Quantity>,
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
    /// What the volume at `path` says of itself; nothing else of it is read.
    ///
    /// # Errors
    /// There is no volume.
    pub fn read(path: &Path) -> Result<Self, StoreError> {
        read_header(path, KIND, "a volume")
    }

    /// The facts of a volume of which only the lattice is known.
    pub fn of(geometry: SurveyGeometry) -> Self {
        Self { geometry, quantity: None, unit: None, polarity: None, source: None }
    }
}
