//! Colours of leaves by their id, and what faces show of horizon candidates: without them nobody can judge an extraction.
//!
//! Hues follow the id through the golden ratio's fractional multiples, so that neighbours in number are far apart in hue, whatever number of
//! ids there is; brightness and saturation take three steps each. sRGB-encoded.

use glam::Vec3;
use serde::{Deserialize, Serialize};

/// What the faces of rock show.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum FaceData {
    /// The illustration and the raw data, as the blend says.
    #[default]
    Rock,
    /// Horizon candidates in the colours of their leaves, over that.
    Leaves,
    /// Distance to the nearest candidate: white on it, darker with distance, black beyond (P-horiz, figure 4).
    Distance,
}

/// Half of a leaf's thickness on a face, voxels.
pub const HALF_WIDTH: f32 = 0.8;
/// Over which it fades, voxels.
pub const FADE: f32 = 0.5;
/// Distance that is black, voxels.
pub const BLACK_AT: f32 = 10.0;
/// How far aside a leaf's border is looked for, voxels.
pub const BORDER: f32 = 0.75;
/// Farther from its surface a sample says nothing of borders, voxels.
pub const BORDER_REACH: f32 = 0.75;
/// Samples that another leaf may lie above or below on a neighbouring trace to be the same surface; the leaf itself may rise or fall by twice that.
pub const BORDER_STEP: usize = 1;
/// Factor on the colour of a border between leaves.
pub const BORDER_TONE: f32 = 0.35;

/// The colour of a leaf.
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

/// How much of a face a candidate at this distance covers.
pub fn cover(distance: f32) -> f32 {
    ((HALF_WIDTH - distance) / FADE + 0.5).clamp(0.0, 1.0)
}

/// The grey of a distance.
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
