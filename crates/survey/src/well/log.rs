//! Curves measured along a well.

use serde::{Deserialize, Serialize};

/// Curves with a common axis of measured depth.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct LogSet {
    /// Where it came from, in words.
    pub source: String,
    /// Measured depths, m, increasing.
    pub md_m: Vec<f64>,
    /// The curves.
    pub curves: Vec<Curve>,
}

/// A measured curve.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Curve {
    /// Short name as in the file, for example `GR`.
    pub name: String,
    /// Unit as in the file, for example `GAPI`.
    pub unit: String,
    /// Description as in the file.
    pub description: String,
    /// One value per measured depth; NaN (null on disk) where nothing was measured.
    #[serde(with = "with_holes")]
    pub values: Vec<f32>,
}

impl LogSet {
    /// The curve of that name; upper and lower case are the same.
    pub fn curve(&self, name: &str) -> Option<&Curve> {
        self.curves.iter().find(|c| c.name.eq_ignore_ascii_case(name))
    }

    /// A curve's value at a measured depth (m), linear between its samples; NaN in gaps and beyond the ends.
    pub fn value_at_md(&self, curve: &Curve, md_m: f64) -> f32 {
        let after = self.md_m.partition_point(|m| *m <= md_m);
        if after == 0 || (after == self.md_m.len() && self.md_m.last() != Some(&md_m)) {
            return f32::NAN;
        }
        let before = after - 1;
        if self.md_m[before] == md_m {
            return curve.values[before];
        }
        let f = ((md_m - self.md_m[before]) / (self.md_m[after] - self.md_m[before])) as f32;
        curve.values[before] + f * (curve.values[after] - curve.values[before])
    }
}

/// JSON has no NaN, so a missing value is written as null.
mod with_holes {
    use serde::{Deserialize, Deserializer, Serializer};

    pub(super) fn serialize<S: Serializer>(values: &[f32], serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_seq(values.iter().map(|v| v.is_finite().then_some(*v)))
    }

    pub(super) fn deserialize<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Vec<f32>, D::Error> {
        let values: Vec<Option<f32>> = Vec::deserialize(deserializer)?;
        Ok(values.into_iter().map(|v| v.unwrap_or(f32::NAN)).collect())
    }
}
