//! Scalar texture transfer functions (P-illus 4.2): map the value of a named volume to a texture, frequency
//! factors and an opacity.
//!
//! Functions form an ordered stack and are composited over the layer's texture, first to last. Intervals are
//! half-open, `[low, high)`. A sample without data (NaN) lies in no interval, so what is below remains
//! visible. The frequency is that of the layer at that place times `factor`, so a scalar texture that crosses
//! from a thin to a thick layer deforms with them.
//!
//! Departure: our patterns are ink on a transparent ground, where the paper's tiles are opaque. An interval
//! with a `colour` is opaque: opacity 1 covers the layer, as in the paper. Without a `colour` only the ink is
//! drawn over the layer.

use serde::{Deserialize, Serialize};

use crate::layer::{check_overlap, check_unit, opaque};
use crate::{Colour, Frequency, TextureLibrary, TtfError};

/// One scalar texture transfer function, bound to a volume by name.
///
/// ```
/// let function: ttf::ScalarTtf = toml::from_str("volume = 'impedance'\nintervals = [{ range = [2.0, 5.0], texture = 'sand' }]").unwrap();
/// assert_eq!(function.interval_at(2.0).unwrap().texture, "sand");
/// assert!(function.interval_at(5.0).is_none() && function.interval_at(f32::NAN).is_none());
/// ```
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ScalarTtf {
    /// Name of the scalar volume.
    pub volume: String,
    /// Textures by value.
    #[serde(default)]
    pub intervals: Vec<ScalarInterval>,
}

/// A texture over a range of values.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ScalarInterval {
    /// Half-open range of values, `[low, high)`, in the volume's unit; `-inf` and `inf` are allowed.
    pub range: [f32; 2],
    /// Name of the texture in the library.
    pub texture: String,
    /// Factors on the layer's horizontal and vertical frequency. Default 1, 1.
    #[serde(default = "same_frequency")]
    pub factor: [f32; 2],
    /// Opacity over what is below, in [0, 1]. Default 1.
    #[serde(default = "opaque")]
    pub opacity: f32,
    /// Background of the texture. Absent: ink only.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub colour: Option<Colour>,
    /// Replaces the colour of the ink. Absent: the texture keeps its own colours.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub ink: Option<Colour>,
}

fn same_frequency() -> [f32; 2] {
    [1.0, 1.0]
}

impl ScalarTtf {
    /// The interval that holds `value`; none for NaN.
    pub fn interval_at(&self, value: f32) -> Option<&ScalarInterval> {
        self.intervals.iter().find(|interval| value >= interval.range[0] && value < interval.range[1])
    }

    /// Checks that this can be drawn.
    ///
    /// # Errors
    /// Intervals that are empty, reversed or overlap; factors or opacities outside their range; unknown
    /// textures.
    pub fn validate(&self, library: &TextureLibrary) -> Result<(), TtfError> {
        let place = format!("scalar function on `{}`", self.volume);
        for interval in &self.intervals {
            let [low, high] = interval.range;
            if low.is_nan() || high.is_nan() || low >= high {
                return Err(TtfError::BadValueInterval { volume: self.volume.clone(), low, high });
            }
            check_unit(&place, "the texture's opacity", interval.opacity)?;
            Frequency { horizontal: 1.0, vertical: 1.0 }.scaled(interval.factor).validate(&place)?;
            library.index_of(&interval.texture, &place)?;
        }
        check_overlap(&place, self.intervals.iter().map(|interval| interval.range))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn function() -> ScalarTtf {
        toml::from_str(
            r#"
            volume = "impedance"
            intervals = [
                { range = [-inf, 2.0], texture = "shale" },
                { range = [2.0, 5.0], texture = "sand", factor = [2.0, 0.5], opacity = 0.5 },
            ]"#,
        )
        .unwrap()
    }

    #[test]
    fn intervals_are_half_open_and_nan_is_in_none() {
        let function = function();
        assert_eq!(function.interval_at(1.999).unwrap().texture, "shale");
        assert_eq!(function.interval_at(2.0).unwrap().texture, "sand");
        assert!(function.interval_at(5.0).is_none());
        assert!(function.interval_at(f32::NAN).is_none());
    }

    #[test]
    fn toml_round_trips_and_typing_errors_are_refused() {
        let function = function();
        let text = toml::to_string(&function).unwrap();
        assert_eq!(toml::from_str::<ScalarTtf>(&text).unwrap(), function);
        assert!(toml::from_str::<ScalarTtf>("volume = 'a'\nintervalls = []").is_err());
    }
}
