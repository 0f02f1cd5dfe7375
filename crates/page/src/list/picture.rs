//! Images on a page.

use crate::Rect;
use glam::DVec2;
use image::RgbaImage;
use serde::{Deserialize, Deserializer, Serialize, Serializer};
use std::sync::Arc;

/// An image laid on a parallelogram.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Picture {
    /// Straight RGBA, sRGB-encoded; shared, so that copying a page is cheap.
    #[serde(with = "pixels")]
    pub pixels: Arc<RgbaImage>,
    /// Where the image's upper left corner lies.
    pub corner: DVec2,
    /// From there to its upper right corner.
    pub right: DVec2,
    /// From there to its lower left corner.
    pub down: DVec2,
    /// What lies between the pixels' middles.
    pub sampling: Sampling,
}

/// What lies between the middles of an image's pixels.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Sampling {
    /// Colours that go over into one another.
    #[default]
    Smooth,
    /// Squares of one colour.
    Nearest,
}

impl Picture {
    /// An image that fills an upright rectangle.
    pub fn in_rect(pixels: impl Into<Arc<RgbaImage>>, rect: Rect) -> Self {
        let right = DVec2::new(rect.width(), 0.0);
        let down = DVec2::new(0.0, rect.height());
        Self { pixels: pixels.into(), corner: rect.min, right, down, sampling: Sampling::Smooth }
    }

    /// An image whose pixels are samples: the middle of the first lies at `first`, that of the last of the
    /// first row at `first + right`, and so on. Half a pixel hangs over on each side; a clip cuts it off.
    pub fn of_samples(pixels: impl Into<Arc<RgbaImage>>, first: DVec2, right: DVec2, down: DVec2) -> Self {
        let pixels = pixels.into();
        let step = |whole: DVec2, count: u32| whole / f64::from(count.saturating_sub(1).max(1));
        let (x, y) = (step(right, pixels.width()), step(down, pixels.height()));
        let corner = first - 0.5 * (x + y);
        let (right, down) = (x * f64::from(pixels.width()), y * f64::from(pixels.height()));
        Self { pixels, corner, right, down, sampling: Sampling::Smooth }
    }

    /// The same with squares for pixels.
    #[must_use]
    pub fn nearest(mut self) -> Self {
        self.sampling = Sampling::Nearest;
        self
    }

    /// Its corners, clockwise from the upper left one of the image.
    pub fn corners(&self) -> [DVec2; 4] {
        [self.corner, self.corner + self.right, self.corner + self.right + self.down, self.corner + self.down]
    }
}

/// Pixels as width, height and bytes.
mod pixels {
    use super::*;
    use serde::de::Error;

    pub(super) fn serialize<S: Serializer>(pixels: &Arc<RgbaImage>, serializer: S) -> Result<S::Ok, S::Error> {
        (pixels.width(), pixels.height(), pixels.as_raw()).serialize(serializer)
    }

    pub(super) fn deserialize<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Arc<RgbaImage>, D::Error> {
        let (width, height, bytes) = <(u32, u32, Vec<u8>)>::deserialize(deserializer)?;
        let count = bytes.len();
        let image = RgbaImage::from_raw(width, height, bytes);
        image.map(Arc::new).ok_or_else(|| D::Error::custom(format!("{count} bytes are no {width} x {height} pixels")))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn samples_lie_in_the_middles_of_their_pixels() {
        let image = RgbaImage::new(5, 3);
        let picture = Picture::of_samples(image, DVec2::new(10.0, 20.0), DVec2::new(40.0, 0.0), DVec2::new(0.0, 20.0));
        assert_eq!(picture.corner, DVec2::new(5.0, 15.0));
        assert_eq!(picture.corners()[2], DVec2::new(55.0, 45.0));
    }
}
