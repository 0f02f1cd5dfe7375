//! How often a tile repeats across the block.
//!
//! A frequency counts repeats: `horizontal` over i in [0, 1], `vertical` over k in [0, 1] (P-illus 4.1).
//! Along j the same tile repeats `horizontal · extent_j / extent_i` times, so that a pattern has the same
//! size on both pairs of side faces.

use serde::{Deserialize, Serialize};

use crate::TtfError;

/// Repeats of a tile over the unit range of i (horizontal) and of k (vertical).
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Frequency {
    /// Repeats over i in [0, 1].
    pub horizontal: f32,
    /// Repeats over k in [0, 1], the thickness of one layer.
    pub vertical: f32,
}

impl Frequency {
    /// The frequency at which a tile of `tile_m` metres (width, height) is printed undistorted in a block
    /// `extent_i_m` metres long, in a layer with a mean thickness of `thickness_m` metres.
    ///
    /// ```
    /// let frequency = ttf::Frequency::for_tile(6000.0, 300.0, [150.0, 150.0]);
    /// assert_eq!(frequency, ttf::Frequency { horizontal: 40.0, vertical: 2.0 });
    /// ```
    pub fn for_tile(extent_i_m: f32, thickness_m: f32, tile_m: [f32; 2]) -> Self {
        Self { horizontal: extent_i_m / tile_m[0], vertical: thickness_m / tile_m[1] }
    }

    /// The frequency multiplied by the factors of a scalar function (P-illus 4.2).
    pub fn scaled(self, factor: [f32; 2]) -> Self {
        Self { horizontal: self.horizontal * factor[0], vertical: self.vertical * factor[1] }
    }

    /// Checks that both numbers are finite and positive.
    ///
    /// # Errors
    /// [`TtfError::BadFrequency`] naming `place`.
    pub fn validate(self, place: &str) -> Result<(), TtfError> {
        let usable = |value: f32| value.is_finite() && value > 0.0;
        if usable(self.horizontal) && usable(self.vertical) {
            return Ok(());
        }
        Err(TtfError::BadFrequency { place: place.to_owned(), horizontal: self.horizontal, vertical: self.vertical })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn factors_multiply_each_axis() {
        let layer = Frequency { horizontal: 12.0, vertical: 3.0 };
        assert_eq!(layer.scaled([0.5, 2.0]), Frequency { horizontal: 6.0, vertical: 6.0 });
    }

    #[test]
    fn only_positive_finite_numbers_pass() {
        for bad in [0.0, -1.0, f32::NAN, f32::INFINITY] {
            assert!(Frequency { horizontal: bad, vertical: 1.0 }.validate("x").is_err());
            assert!(Frequency { horizontal: 1.0, vertical: bad }.validate("x").is_err());
        }
        assert!(Frequency { horizontal: 0.1, vertical: 40.0 }.validate("x").is_ok());
    }
}
