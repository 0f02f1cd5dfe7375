//! Decides whether two pictures of one scene agree, apart from edges.
//!
//! Edges are found in the *reference* picture alone: they are the pixels of which a channel differs from that
//! of one of the eight neighbours by more than [`EDGE_STEP`]. At an edge, rounding by a millionth of a voxel
//! may choose the other side; elsewhere it must not show.
//!
//! The pictures must come from different renderers, since a comparison of a picture with itself cannot fail.
//! A test shows that wrong pictures are recognised.

use image::RgbaImage;

/// Channel difference of neighbours above which a pixel is an edge.
pub(crate) const EDGE_STEP: u8 = 24;
/// Largest channel difference that counts as equal.
pub(crate) const EQUAL: u8 = 2;
/// Largest fraction of all pixels that may differ, all of them on edges.
pub(crate) const EDGE_SHARE: f64 = 0.005;

/// The result of a comparison.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct PictureComparison {
    /// Largest channel difference at pixels that are not edges.
    pub worst_off_edges: u8,
    /// The pixel with that difference.
    pub worst_at: [u32; 2],
    /// Fraction of all pixels that are edges of the reference.
    pub edge_share: f64,
    /// Fraction of all pixels that are edges and differ by more than [`EQUAL`].
    pub differing_edge_share: f64,
}

impl PictureComparison {
    /// Whether the pictures agree: within [`EQUAL`] off the edges, and at most [`EDGE_SHARE`] of all pixels
    /// differ on them.
    pub(crate) fn agrees(&self) -> bool {
        self.worst_off_edges <= EQUAL && self.differing_edge_share <= EDGE_SHARE
    }
}

/// Compares a picture with the reference. Returns `None` if their sizes differ or they are empty.
pub(crate) fn compare(reference: &RgbaImage, picture: &RgbaImage) -> Option<PictureComparison> {
    if reference.dimensions() != picture.dimensions() || reference.is_empty() {
        return None;
    }
    let (width, height) = reference.dimensions();
    let mut found =
        PictureComparison { worst_off_edges: 0, worst_at: [0; 2], edge_share: 0.0, differing_edge_share: 0.0 };
    let share = 1.0 / (f64::from(width) * f64::from(height));
    for (x, y, pixel) in reference.enumerate_pixels() {
        let difference = step(pixel.0, picture.get_pixel(x, y).0);
        if is_edge(reference, x, y) {
            found.edge_share += share;
            found.differing_edge_share += if difference > EQUAL { share } else { 0.0 };
        } else if difference > found.worst_off_edges {
            (found.worst_off_edges, found.worst_at) = (difference, [x, y]);
        }
    }
    Some(found)
}

/// Largest channel difference of two pixels.
fn step(a: [u8; 4], b: [u8; 4]) -> u8 {
    a.into_iter().zip(b).map(|(a, b)| a.abs_diff(b)).fold(0, u8::max)
}

fn is_edge(image: &RgbaImage, x: u32, y: u32) -> bool {
    let (width, height) = image.dimensions();
    let here = image.get_pixel(x, y).0;
    (y.saturating_sub(1)..=(y + 1).min(height - 1)).any(|ny| {
        (x.saturating_sub(1)..=(x + 1).min(width - 1)).any(|nx| step(here, image.get_pixel(nx, ny).0) > EDGE_STEP)
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use image::Rgba;

    fn picture() -> RgbaImage {
        // A grey ramp with one hard edge.
        RgbaImage::from_fn(100, 80, |x, y| {
            let v = if x < 50 { 200 } else { 40 + (y / 4) as u8 };
            Rgba([v, v, v, 255])
        })
    }

    #[test]
    fn the_same_picture_from_elsewhere_agrees() {
        let found = compare(&picture(), &picture()).unwrap();
        assert!(found.agrees() && found.worst_off_edges == 0);
        assert!((found.edge_share - 0.02).abs() < 1e-9);
    }

    #[test]
    fn wrong_pictures_are_told_apart() {
        let spoilt = |change: fn(&mut RgbaImage)| {
            let mut image = picture();
            change(&mut image);
            compare(&picture(), &image).unwrap().agrees()
        };
        assert!(spoilt(|_| ()));
        assert!(!spoilt(|image| image.get_pixel_mut(10, 10).0[1] += 3));
        assert!(!spoilt(|image| image.pixels_mut().for_each(|p| p.0[0] -= 10)));
        // The edge is one pixel farther left, so every row differs there.
        assert!(!spoilt(|image| (0..80).for_each(|y| *image.get_pixel_mut(49, y) = Rgba([40, 40, 40, 255]))));
        assert!(!spoilt(|image| *image = image::imageops::flip_horizontal(image)));
        assert!(compare(&picture(), &RgbaImage::new(99, 80)).is_none());
    }
}
