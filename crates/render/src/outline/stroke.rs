//! Strokes polylines over a picture.

use super::{NOMINAL_SIDE_PX, Stroke};
use glam::DVec2;
use image::RgbaImage;
use tiny_skia::{LineCap, LineJoin, Paint, PathBuilder, Pixmap, Transform};

/// Strokes polylines as a single shape, so that crossings are not darker.
pub(super) fn stroke_lines(image: &mut RgbaImage, stroke: &Stroke, lines: &[Vec<DVec2>]) {
    let (width, height) = image.dimensions();
    let scale = width.min(height) as f32 / NOMINAL_SIDE_PX;
    let mut builder = PathBuilder::new();
    for line in lines.iter().filter(|line| line.len() > 1) {
        for (n, point) in line.iter().enumerate() {
            let (x, y) = (point.x as f32, point.y as f32);
            if n == 0 { builder.move_to(x, y) } else { builder.line_to(x, y) }
        }
    }
    let (Some(path), Some(mut coverage)) = (builder.finish(), Pixmap::new(width, height)) else { return };
    if stroke.width_px <= 0.0 {
        return;
    }
    let pen = tiny_skia::Stroke {
        width: stroke.width_px * scale,
        line_cap: LineCap::Round,
        line_join: LineJoin::Round,
        ..tiny_skia::Stroke::default()
    };
    let mut paint = Paint::default();
    paint.set_color_rgba8(255, 255, 255, 255);
    coverage.stroke_path(&path, &paint, &pen, Transform::identity(), None);
    for (pixel, covered) in image.pixels_mut().zip(coverage.pixels()) {
        if covered.alpha() > 0 {
            pixel.0 = over(pixel.0, stroke.colour.rgb, f32::from(covered.alpha()) / 255.0);
        }
    }
}

/// Composites an opaque colour at a coverage over a straight RGBA pixel.
fn over(below: [u8; 4], colour: [u8; 3], coverage: f32) -> [u8; 4] {
    let alpha_below = f32::from(below[3]) / 255.0;
    let alpha = coverage + alpha_below * (1.0 - coverage);
    let mix = |n: usize| {
        let above = f32::from(colour[n]) * coverage;
        ((above + f32::from(below[n]) * alpha_below * (1.0 - coverage)) / alpha + 0.5) as u8
    };
    [mix(0), mix(1), mix(2), (alpha * 255.0 + 0.5) as u8]
}
