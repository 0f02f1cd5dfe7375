//! Two shadings side by side in one picture (P-horiz, figure 5): stripes shaded by gradients alternate with
//! stripes shaded by occlusion, so that the two can be compared on the same structure.
//!
//! Both pictures are drawn completely and then interleaved. Neither depends on the other, and every renderer
//! draws them in the same way.

use super::Shading;
use crate::scene::Scene;
use image::RgbaImage;

/// The two scenes of an interleaved scene, and the number of stripes.
pub(crate) fn halves(scene: &Scene) -> Option<([Scene; 2], u32)> {
    let Shading::Interleaved(settings) = scene.media.shading else { return None };
    let with = |shading| {
        let mut half = scene.clone();
        half.media.shading = shading;
        half
    };
    Some(([with(Shading::Phong(settings.phong)), with(Shading::Occlusion(settings.occlusion))], settings.stripes))
}

/// Takes every second stripe from the second picture.
pub(crate) fn interleave(mut first: RgbaImage, second: &RgbaImage, stripes: u32) -> RgbaImage {
    let width = u64::from(first.width().max(1));
    for (x, y, pixel) in first.enumerate_pixels_mut() {
        if u64::from(x) * u64::from(stripes) / width % 2 == 1 {
            *pixel = *second.get_pixel(x, y);
        }
    }
    first
}

#[cfg(test)]
mod tests {
    use super::*;
    use image::Rgba;

    #[test]
    fn stripes_take_turns() {
        let [a, b] = [1, 2].map(|v| RgbaImage::from_pixel(10, 2, Rgba([v; 4])));
        let both = interleave(a, &b, 4);
        let row: Vec<u8> = (0..10).map(|x| both.get_pixel(x, 1).0[0]).collect();
        assert_eq!(row, [1, 1, 1, 2, 2, 1, 1, 1, 2, 2]);
    }
}
