//! Colours of leaves by their id, and how faces show horizon candidates, so that an extraction can be judged.
//!
//! Hues are fractional multiples of the golden ratio, so that leaves with consecutive ids differ in hue,
//! however many ids there are. Brightness and saturation take three steps each. sRGB-encoded.

use glam::Vec3;
use serde::{Deserialize, Serialize};

/// What the faces of the block show.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum FaceData {
    /// The illustration blended with the raw data.
    #[default]
    Rock,
    /// The same, and over it the horizon candidates in the colours of their leaves.
    Leaves,
    /// Distance to the nearest candidate: white on it, darker with distance, black beyond `BLACK_AT`
    /// (P-horiz, figure 4).
    Distance,
    /// How much patterns are distorted ([`crate::distortion`]).
    Distortion,
}

impl FaceData {
    /// Whether the faces show horizon candidates.
    pub fn shows_candidates(self) -> bool {
        matches!(self, Self::Leaves | Self::Distance)
    }
}

/// Half of the thickness of a leaf on a face, voxels.
pub(crate) const HALF_WIDTH: f32 = 0.8;
/// Width over which the edge of a leaf fades, voxels.
pub(crate) const FADE: f32 = 0.5;
/// Distance that is shown as black, voxels.
pub(crate) const BLACK_AT: f32 = 10.0;
/// How far to the side the border of a leaf is searched for, voxels.
pub(crate) const BORDER: f32 = 0.75;
/// Largest distance from its surface of a sample that counts in the search for borders, voxels.
pub(crate) const BORDER_REACH: f32 = 0.75;
/// Largest difference in depth between neighbouring traces, samples, at which another leaf counts as the
/// continuation of a surface. The same leaf may rise or fall by twice that.
pub(crate) const BORDER_STEP: usize = 1;
/// Factor on the colour at the border between leaves.
pub(crate) const BORDER_TONE: f32 = 0.35;

/// The colour of a leaf.
///
/// ```
/// let [a, b] = [1, 2].map(render::leaves::leaf_colour);
/// assert!((a - b).length() > 0.2);
/// assert!(a.min_element() >= 0.0 && a.max_element() <= 1.0);
/// ```
pub fn leaf_colour(id: u32) -> Vec3 {
    let hash = id.wrapping_mul(0x9e37_79b9);
    let hue = (hash >> 8) as f32 / 16_777_216.0 * 6.0;
    let saturation = 0.5 + 0.15 * (hash % 3) as f32;
    let value = 0.98 - 0.12 * (hash / 3 % 3) as f32;
    let channel = |shift: f32| {
        let k = (shift + hue) % 6.0;
        value - value * saturation * k.min(4.0 - k).clamp(0.0, 1.0)
    };
    Vec3::new(channel(5.0), channel(3.0), channel(1.0))
}

/// Fraction of a face that a candidate at this distance covers.
pub fn cover(distance: f32) -> f32 {
    ((HALF_WIDTH - distance) / FADE + 0.5).clamp(0.0, 1.0)
}

/// The grey value that shows a distance.
pub fn distance_tone(distance: f32) -> f32 {
    (1.0 - distance / BLACK_AT).clamp(0.0, 1.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn leaves_next_in_number_look_different() {
        for id in 1..2000 {
            let (a, b) = (leaf_colour(id), leaf_colour(id + 1));
            assert!((a - b).length() > 0.2, "{id}: {a} {b}");
            assert!(a.min_element() >= 0.0 && a.max_element() <= 1.0);
        }
    }

    #[test]
    fn tones_fall_with_distance() {
        assert_eq!((distance_tone(0.0), distance_tone(5.0), distance_tone(12.0)), (1.0, 0.5, 0.0));
        assert_eq!((cover(0.0), cover(HALF_WIDTH), cover(2.0)), (1.0, 0.5, 0.0));
    }
}
