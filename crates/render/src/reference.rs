//! The CPU reference: what the GPU passes must reproduce, written for clarity.
//!
//! Each pixel takes `samples` × `samples` rays on a regular grid. A ray finds the first point of the block
//! ([`crate::visible`]), which is coloured and averaged with its pixel's others on sRGB-encoded, alpha-weighted values.

use crate::error::RenderError;
use crate::frame::Frame;
use crate::inputs::Inputs;
use crate::outline;
use crate::scene::Scene;
use crate::shade::trace;
use glam::{DVec2, Vec4};
use image::RgbaImage;
use rayon::prelude::*;
use survey::Progress;

/// Draws the scene on the CPU.
///
/// # Errors
/// A scene without a picture, missing inputs, or cancellation.
pub fn render(scene: &Scene, inputs: &Inputs, progress: &Progress) -> Result<RgbaImage, RenderError> {
    let frame = Frame::new(scene, inputs)?;
    let [width, height] = scene.size_px;
    progress.begin("render", u64::from(height));
    let rows: Vec<Vec<u8>> = (0..height)
        .into_par_iter()
        .map(|y| {
            let row = (0..width).flat_map(|x| pixel(&frame, x, y)).collect();
            progress.step(1).map(|()| row)
        })
        .collect::<Result<_, _>>()?;
    // The rows fill the image by construction.
    let mut image = RgbaImage::from_raw(width, height, rows.concat()).unwrap_or_default();
    outline::draw(&frame, &mut image);
    Ok(image)
}

/// The averaged colour of one pixel, straight 8-bit RGBA.
fn pixel(frame: &Frame, x: u32, y: u32) -> [u8; 4] {
    let samples = frame.scene.samples;
    let mut sum = Vec4::ZERO;
    for sub_y in 0..samples {
        for sub_x in 0..samples {
            let offset = DVec2::new(f64::from(sub_x) + 0.5, f64::from(sub_y) + 0.5) / f64::from(samples);
            let view_ray = frame.view.ray(DVec2::new(f64::from(x), f64::from(y)) + offset);
            let colour = trace(frame, &view_ray);
            sum += (colour.truncate() * colour.w).extend(colour.w);
        }
    }
    straight_bytes(sum / (samples * samples) as f32)
}

/// 8-bit straight RGBA of a premultiplied colour.
fn straight_bytes(premultiplied: Vec4) -> [u8; 4] {
    let alpha = premultiplied.w;
    let rgb = if alpha > 0.0 { premultiplied.truncate() / alpha } else { premultiplied.truncate() };
    rgb.extend(alpha).to_array().map(|c| (c.clamp(0.0, 1.0) * 255.0 + 0.5) as u8)
}
