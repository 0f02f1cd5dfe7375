//! RGBA transfer functions for raw data: a piecewise linear map from a value to colour and opacity (P-illus
//! 4.3, 5).
//!
//! A value is first scaled to the domain, `t = clamp((value − low)/(high − low), 0, 1)`. Colour and opacity
//! are interpolated between the two stops around t, on sRGB-encoded straight values. A missing value (NaN) is
//! transparent black, `[0, 0, 0, 0]`.

use serde::{Deserialize, Serialize};

use crate::layer::{check_unit, opaque};
use crate::{Colour, ColourMap, TtfError};

/// A piecewise linear function from a value to straight RGBA.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct RgbaFunction {
    /// The values of the first and the last stop. Values outside are clamped.
    pub domain: [f32; 2],
    /// Stops at rising positions: the first at 0, the last at 1.
    pub stops: Vec<RgbaStop>,
}

/// One stop of an [`RgbaFunction`].
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct RgbaStop {
    /// Position in the domain: 0 = its low end, 1 = its high end.
    pub at: f32,
    /// The colour there.
    pub colour: Colour,
    /// The opacity there, in [0, 1]. Default 1.
    #[serde(default = "opaque")]
    pub opacity: f32,
}

impl RgbaFunction {
    /// A colour map over a range of values, opaque.
    pub fn over(map: ColourMap, domain: [f32; 2]) -> Self {
        let stops = map.stops().into_iter().map(|(at, colour)| RgbaStop { at, colour, opacity: 1.0 }).collect();
        Self { domain, stops }
    }

    /// A colour map centred on zero and clipped at ±`clip`, usually the 99th percentile of the absolute value
    /// ([`symmetric_clip`]). Amplitudes need a centred map, since their sign has a meaning.
    ///
    /// ```
    /// use ttf::{ColourMap, RgbaFunction};
    /// let function = RgbaFunction::centred(ColourMap::Grey, 2000.0);
    /// let middle = function.evaluate(0.0);
    /// assert!((middle[0] - 0.5).abs() < 1e-6 && middle[3] == 1.0);
    /// ```
    pub fn centred(map: ColourMap, clip: f32) -> Self {
        Self::over(map, [-clip, clip])
    }

    /// Straight RGBA in [0, 1] for a value; transparent black for NaN.
    pub fn evaluate(&self, value: f32) -> [f32; 4] {
        if value.is_nan() || self.stops.is_empty() {
            return [0.0; 4];
        }
        let [low, high] = self.domain;
        let t = ((value - low) / (high - low)).clamp(0.0, 1.0);
        let after = self.stops.partition_point(|stop| stop.at <= t).clamp(1, self.stops.len());
        let left = self.stops[after - 1];
        let right = self.stops[after.min(self.stops.len() - 1)];
        let span = right.at - left.at;
        let fraction = if span > 0.0 { (t - left.at) / span } else { 0.0 };
        let mix = |a: f32, b: f32| a + (b - a) * fraction;
        let (a, b) = (left.colour.to_unit(), right.colour.to_unit());
        [mix(a[0], b[0]), mix(a[1], b[1]), mix(a[2], b[2]), mix(left.opacity, right.opacity)]
    }

    /// The function sampled at `count` evenly spaced values of the domain, ends included: a lookup table for
    /// volume rendering.
    ///
    /// ```
    /// use ttf::{ColourMap, RgbaFunction};
    /// let table = RgbaFunction::over(ColourMap::Grey, [0.0, 10.0]).bake(3);
    /// assert_eq!(table, [[1.0, 1.0, 1.0, 1.0], [0.5, 0.5, 0.5, 1.0], [0.0, 0.0, 0.0, 1.0]]);
    /// ```
    pub fn bake(&self, count: usize) -> Vec<[f32; 4]> {
        let [low, high] = self.domain;
        let last = count.saturating_sub(1).max(1) as f32;
        (0..count).map(|index| self.evaluate(low + (high - low) * index as f32 / last)).collect()
    }

    /// Checks that the function can be evaluated.
    ///
    /// # Errors
    /// An empty or infinite domain; fewer than two stops; positions that do not rise from 0 to 1; opacities
    /// outside [0, 1].
    pub fn validate(&self, place: &str) -> Result<(), TtfError> {
        let [low, high] = self.domain;
        if !(low.is_finite() && high.is_finite() && low < high) {
            return Err(TtfError::BadDomain { place: place.to_owned(), low, high });
        }
        let bad = |fact: String| Err(TtfError::BadStops { place: place.to_owned(), fact });
        if self.stops.len() < 2 {
            return bad(format!("it has {} stop(s)", self.stops.len()));
        }
        if self.stops[0].at != 0.0 || self.stops[self.stops.len() - 1].at != 1.0 {
            return bad("its first stop is not at 0 or its last not at 1".to_owned());
        }
        if let Some(pair) =
            self.stops.windows(2).find(|pair| pair[0].at.is_nan() || pair[1].at.is_nan() || pair[0].at > pair[1].at)
        {
            return bad(format!("stop {} follows stop {}", pair[1].at, pair[0].at));
        }
        self.stops.iter().try_for_each(|stop| check_unit(place, "a stop's opacity", stop.opacity))
    }
}

/// The absolute value that `fraction` (for example 0.99) of the samples do not exceed: where a centred
/// function is clipped. Samples that are not finite are ignored. Returns `None` if no sample remains or all
/// are zero.
///
/// ```
/// let samples: Vec<f32> = (-100..=100).map(|value| value as f32).collect();
/// assert_eq!(ttf::symmetric_clip(&samples, 0.99), Some(99.0));
/// ```
pub fn symmetric_clip(samples: &[f32], fraction: f32) -> Option<f32> {
    let mut sizes: Vec<f32> = samples.iter().filter(|sample| sample.is_finite()).map(|sample| sample.abs()).collect();
    let last = sizes.len().checked_sub(1)?;
    let rank = ((last as f64 * f64::from(fraction.clamp(0.0, 1.0))).round() as usize).min(last);
    let (_, value, _) = sizes.select_nth_unstable_by(rank, f32::total_cmp);
    let value = *value;
    (value > 0.0).then_some(value)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn ramp() -> RgbaFunction {
        RgbaFunction {
            domain: [10.0, 20.0],
            stops: vec![
                RgbaStop { at: 0.0, colour: Colour::BLACK, opacity: 0.0 },
                RgbaStop { at: 0.25, colour: Colour::WHITE, opacity: 1.0 },
                RgbaStop { at: 1.0, colour: Colour::new(255, 0, 0), opacity: 0.5 },
            ],
        }
    }

    #[test]
    fn it_is_linear_between_stops_and_clamped_outside() {
        let function = ramp();
        assert_eq!(function.evaluate(0.0), [0.0, 0.0, 0.0, 0.0]);
        assert_eq!(function.evaluate(11.25), [0.5, 0.5, 0.5, 0.5]);
        assert_eq!(function.evaluate(12.5), [1.0, 1.0, 1.0, 1.0]);
        let between = function.evaluate(16.25);
        for (found, expected) in between.into_iter().zip([1.0, 0.5, 0.5, 0.75]) {
            assert!((found - expected).abs() < 1e-6, "{between:?}");
        }
        assert_eq!(function.evaluate(20.0), [1.0, 0.0, 0.0, 0.5]);
        assert_eq!(function.evaluate(1e9), [1.0, 0.0, 0.0, 0.5]);
        assert_eq!(function.evaluate(f32::NAN), [0.0; 4]);
    }

    #[test]
    fn a_step_is_two_stops_at_one_place() {
        let mut function = ramp();
        function.stops.insert(2, RgbaStop { at: 0.25, colour: Colour::BLACK, opacity: 1.0 });
        function.validate("x").unwrap();
        assert_eq!(function.evaluate(12.5), [0.0, 0.0, 0.0, 1.0]);
        assert!(function.evaluate(12.4999)[0] > 0.99);
    }

    #[test]
    fn baked_ends_are_the_ends() {
        let table = ramp().bake(9);
        assert_eq!(table[0], ramp().evaluate(10.0));
        assert_eq!(table[2], ramp().evaluate(12.5));
        assert_eq!(table[8], ramp().evaluate(20.0));
    }

    #[test]
    fn bad_functions_are_refused() {
        let refuses = |change: fn(&mut RgbaFunction)| {
            let mut function = ramp();
            change(&mut function);
            assert!(function.validate("x").is_err());
        };
        refuses(|function| function.domain = [1.0, 1.0]);
        refuses(|function| function.domain = [f32::NAN, 1.0]);
        refuses(|function| function.stops.truncate(1));
        refuses(|function| function.stops[1].at = 2.0);
        refuses(|function| function.stops[1].at = f32::NAN);
        refuses(|function| function.stops[2].at = 0.9);
        refuses(|function| function.stops[1].opacity = 1.5);
        ramp().validate("x").unwrap();
    }

    #[test]
    fn the_clip_ignores_what_is_no_number() {
        assert_eq!(symmetric_clip(&[f32::NAN, -3.0, 1.0, f32::INFINITY], 1.0), Some(3.0));
        assert_eq!(symmetric_clip(&[], 0.99), None);
        assert_eq!(symmetric_clip(&[0.0, 0.0], 0.99), None);
    }
}
