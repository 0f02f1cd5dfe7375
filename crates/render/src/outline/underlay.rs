//! Edges of a block that is rendered as a volume: those at the back are drawn behind the media, those at the
//! front over them.
//!
//! The picture is drawn without a background. Background and back edges are composited below it afterwards,
//! in linear light as the media are.

use super::stroke::stroke_lines;
use crate::resolved_scene::ResolvedScene;
use crate::shade::{encoded, linear};
use glam::{DVec2, DVec3, Vec3};
use image::{Rgba, RgbaImage};

/// Composites the background and the back edges below a picture.
pub(super) fn underlay(resolved: &ResolvedScene, image: &mut RgbaImage) {
    let background = resolved.scene.background.rgba().map(|c| (c * 255.0 + 0.5) as u8);
    let mut below = RgbaImage::from_pixel(image.width(), image.height(), Rgba(background));
    stroke_lines(&mut below, &resolved.scene.outlines.edges, &back_edges(resolved));
    for (pixel, below) in image.pixels_mut().zip(below.pixels()) {
        pixel.0 = over(pixel.0, below.0);
    }
}

/// The edges of the roaming box that meet at the corner farthest from the camera, pixels.
fn back_edges(resolved: &ResolvedScene) -> Vec<Vec<DVec2>> {
    let block = resolved.roaming_box;
    let towards = resolved.view.towards_camera(block.centre());
    let farthest = DVec3::select(towards.cmpgt(DVec3::ZERO), block.low(), block.high());
    let nearest = DVec3::select(towards.cmpgt(DVec3::ZERO), block.high(), block.low());
    (0..3)
        .map(|axis| {
            let mut end = farthest;
            end[axis] = nearest[axis];
            vec![resolved.view.project(farthest), resolved.view.project(end)]
        })
        .collect()
}

/// Composites straight RGBA over straight RGBA in linear light.
fn over(above: [u8; 4], below: [u8; 4]) -> [u8; 4] {
    match (above[3], below[3]) {
        (255, _) => return above,
        (0, _) => return below,
        _ => {}
    }
    let unit = |c: [u8; 4]| c.map(|byte| f32::from(byte) / 255.0);
    let (a, b) = (unit(above), unit(below));
    let colour = |c: [f32; 4]| linear(Vec3::new(c[0], c[1], c[2]));
    let alpha = a[3] + b[3] * (1.0 - a[3]);
    let sum = colour(a) * a[3] + colour(b) * (b[3] * (1.0 - a[3]));
    let byte = |c: f32| (c.clamp(0.0, 1.0) * 255.0 + 0.5) as u8;
    let [red, green, blue] = encoded(sum / alpha).to_array().map(byte);
    [red, green, blue, byte(alpha)]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn half_of_white_over_black_is_half_as_much_light() {
        assert_eq!(over([255, 255, 255, 255], [0, 0, 0, 255]), [255; 4]);
        assert_eq!(over([9, 9, 9, 0], [1, 2, 3, 4]), [1, 2, 3, 4]);
        let [grey, _, _, alpha] = over([255, 255, 255, 128], [0, 0, 0, 255]);
        assert!(alpha == 255 && grey.abs_diff(188) <= 1, "{grey}");
    }
}
