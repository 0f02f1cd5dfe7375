//! Colours as they are written (`#rrggbb`, sRGB) and how they are composited.
//!
//! All functions work on sRGB-*encoded* values, so that a PNG of ours and an SVG or HTML page composited by a
//! browser show the same colours (`c = top·a + bottom·(1 − a)` on encoded values).

use serde::{Deserialize, Serialize};

use crate::TtfError;

/// An opaque sRGB colour, eight bits a channel, written `#rrggbb`.
///
/// ```
/// let sand: ttf::Colour = "#e8c98a".parse().unwrap();
/// assert_eq!(sand, ttf::Colour::new(0xe8, 0xc9, 0x8a));
/// assert_eq!(sand.to_string(), "#e8c98a");
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(try_from = "String", into = "String")]
pub struct Colour {
    /// Red, green, blue, sRGB-encoded.
    pub rgb: [u8; 3],
}

impl Colour {
    /// White.
    pub const WHITE: Self = Self::new(255, 255, 255);
    /// Black.
    pub const BLACK: Self = Self::new(0, 0, 0);

    /// A colour from its three channels.
    pub const fn new(red: u8, green: u8, blue: u8) -> Self {
        Self { rgb: [red, green, blue] }
    }

    /// The channels in [0, 1], sRGB-encoded.
    pub fn to_unit(self) -> [f32; 3] {
        self.rgb.map(|channel| f32::from(channel) / 255.0)
    }

    /// The nearest eight-bit colour. Channels are clamped to [0, 1]; NaN becomes 0.
    pub fn from_unit(rgb: [f32; 3]) -> Self {
        Self { rgb: rgb.map(|channel| (channel.clamp(0.0, 1.0) * 255.0).round() as u8) }
    }

    /// Relative luminance Y in [0, 1] (Rec. 709 weights on linear light): the tone in greyscale print.
    pub fn luminance(self) -> f32 {
        let [r, g, b] = self.to_unit().map(linear_from_srgb);
        0.2126 * r + 0.7152 * g + 0.0722 * b
    }
}

/// Linear light from an sRGB-encoded channel (IEC 61966-2-1).
///
/// ```
/// assert!((ttf::linear_from_srgb(0.5) - 0.214_041).abs() < 1e-5);
/// assert!((ttf::srgb_from_linear(ttf::linear_from_srgb(0.5)) - 0.5).abs() < 1e-6);
/// ```
pub fn linear_from_srgb(encoded: f32) -> f32 {
    if encoded <= 0.040_45 { encoded / 12.92 } else { ((encoded + 0.055) / 1.055).powf(2.4) }
}

/// sRGB-encoded channel from linear light (IEC 61966-2-1).
pub fn srgb_from_linear(linear: f32) -> f32 {
    if linear <= 0.003_130_8 { linear * 12.92 } else { 1.055 * linear.powf(1.0 / 2.4) - 0.055 }
}

impl std::str::FromStr for Colour {
    type Err = TtfError;

    fn from_str(text: &str) -> Result<Self, TtfError> {
        let bad = || TtfError::BadColour { text: text.to_owned() };
        let digits = text.strip_prefix('#').ok_or_else(bad)?;
        if digits.len() != 6 || !digits.bytes().all(|byte| byte.is_ascii_hexdigit()) {
            return Err(bad());
        }
        let value = u32::from_str_radix(digits, 16).map_err(|_| bad())?;
        let [_, red, green, blue] = value.to_be_bytes();
        Ok(Self::new(red, green, blue))
    }
}

impl TryFrom<String> for Colour {
    type Error = TtfError;

    fn try_from(text: String) -> Result<Self, TtfError> {
        text.parse()
    }
}

impl From<Colour> for String {
    fn from(colour: Colour) -> Self {
        colour.to_string()
    }
}

impl std::fmt::Display for Colour {
    fn fmt(&self, formatter: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let [red, green, blue] = self.rgb;
        write!(formatter, "#{red:02x}{green:02x}{blue:02x}")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn text_round_trips_and_bad_text_is_refused() {
        for text in ["#000000", "#ffffff", "#12ab9f"] {
            assert_eq!(text.parse::<Colour>().unwrap().to_string(), text);
        }
        for text in ["", "#fff", "12ab9f", "#12ab9g", "#12ab9f0", "#+1ab9f", "#éa"] {
            assert!(text.parse::<Colour>().is_err(), "{text}");
        }
    }

    #[test]
    fn encoding_round_trips_and_hits_the_standard_middle() {
        for step in 0..=255_u8 {
            let encoded = f32::from(step) / 255.0;
            assert!((srgb_from_linear(linear_from_srgb(encoded)) - encoded).abs() < 1e-6);
        }
        assert!((linear_from_srgb(0.5) - 0.214_041).abs() < 1e-5);
        assert!((Colour::WHITE.luminance() - 1.0).abs() < 1e-6);
    }
}
