//! Upright rectangles on a page.

use glam::DVec2;
use serde::{Deserialize, Serialize};

/// A rectangle, points; y down.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Rect {
    /// Upper left corner.
    pub min: DVec2,
    /// Lower right corner.
    pub max: DVec2,
}

impl Rect {
    /// From corner to corner.
    pub const fn new(min: DVec2, max: DVec2) -> Self {
        Self { min, max }
    }

    /// From its upper left corner, with a size.
    pub fn sized(min: DVec2, size: DVec2) -> Self {
        Self { min, max: min + size }
    }

    /// Its width.
    pub fn width(&self) -> f64 {
        self.max.x - self.min.x
    }

    /// Its height.
    pub fn height(&self) -> f64 {
        self.max.y - self.min.y
    }

    /// Width and height.
    pub fn size(&self) -> DVec2 {
        self.max - self.min
    }

    /// Its middle.
    pub fn centre(&self) -> DVec2 {
        0.5 * (self.min + self.max)
    }

    /// Whether it has a width and a height.
    pub fn is_proper(&self) -> bool {
        self.size().min_element() > 0.0 && self.min.is_finite() && self.max.is_finite()
    }

    /// Whether a place lies in it or on its edge.
    pub fn contains(&self, place: DVec2) -> bool {
        place.cmpge(self.min).all() && place.cmple(self.max).all()
    }

    /// Whether the two have a place in common.
    pub fn meets(&self, other: &Self) -> bool {
        self.min.cmple(other.max).all() && other.min.cmple(self.max).all()
    }

    /// The smallest rectangle around this and a place.
    #[must_use]
    pub fn around(&self, place: DVec2) -> Self {
        Self { min: self.min.min(place), max: self.max.max(place) }
    }

    /// Larger by this much on each side; smaller where it is negative.
    #[must_use]
    pub fn grown(&self, by: f64) -> Self {
        Self { min: self.min - by, max: self.max + by }
    }

    /// Without a margin at the left, the top, the right and the bottom.
    #[must_use]
    pub fn inside(&self, [left, top, right, bottom]: [f64; 4]) -> Self {
        Self { min: self.min + DVec2::new(left, top), max: self.max - DVec2::new(right, bottom) }
    }

    /// The parts to the left and to the right of a share of its width.
    pub fn split_across(&self, share: f64) -> [Self; 2] {
        let x = self.min.x + share * self.width();
        [Self { min: self.min, max: DVec2::new(x, self.max.y) }, Self { min: DVec2::new(x, self.min.y), max: self.max }]
    }

    /// The parts above and below a share of its height.
    pub fn split_down(&self, share: f64) -> [Self; 2] {
        let y = self.min.y + share * self.height();
        [Self { min: self.min, max: DVec2::new(self.max.x, y) }, Self { min: DVec2::new(self.min.x, y), max: self.max }]
    }

    /// The largest rectangle of a shape (width : height) in its middle.
    #[must_use]
    pub fn fitted(&self, shape: DVec2) -> Self {
        let size = shape * (self.size() / shape).min_element();
        Self::sized(self.centre() - 0.5 * size, size)
    }
}
