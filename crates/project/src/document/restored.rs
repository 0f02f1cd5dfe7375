//! What a restored interpretation was restored from, and what is said with every picture of it.

use restore::Datum;
use serde::{Deserialize, Serialize};
use survey::VerticalUnit;

/// What an interpretation was restored from.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct RestoredEntry {
    /// The name of the other project.
    pub from: String,
    /// The horizon that was restored.
    pub to: String,
    /// How it lies.
    #[serde(default)]
    pub datum: Datum,
    /// Its depth in the middle of the survey, vertical unit.
    pub depth: f64,
}

impl RestoredEntry {
    /// What a figure says: how it was restored, and what it is not.
    pub fn words(&self, unit: VerticalUnit) -> String {
        let lies = match self.datum {
            Datum::Flat => "level".to_owned(),
            Datum::Regional => "at its regional slope".to_owned(),
            Datum::Dipping { dip, direction } => format!("dipping {dip}° towards {direction}°"),
        };
        format!(
            "{} restored to {}, {lies} at {:.0} {}. Kinematic: not balanced, not decompacted.",
            self.from,
            self.to,
            self.depth,
            unit.symbol()
        )
    }
}
