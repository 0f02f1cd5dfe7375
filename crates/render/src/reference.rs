//! The CPU reference: what the GPU passes must reproduce, written for clarity.
//!
//! Each pixel takes `samples` × `samples` rays on a regular grid. A ray finds the first point of the block
//! ([`crate::visible`]), which is coloured and averaged with its pixel's others on sRGB-encoded, alpha-weighted values.

use crate::error::RenderError;
use crate::frame::Frame;
use crate::inputs::Inputs;
use crate::media::interleaved::{halves, interleave};
use crate::media::light::LightVolume;
use crate::media::prepared::Preparations;
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
    CpuRenderer::default().render(scene, inputs, progress)
}

/// The CPU renderer, keeping what it learnt of the data while [`Inputs::version`] stays the same.
#[derive(Debug, Default)]
pub struct CpuRenderer {
    kept: Preparations,
}

impl CpuRenderer {
    /// Draws the scene.
    ///
    /// # Errors
    /// A scene without a picture, missing inputs, or cancellation.
    pub fn render(&mut self, scene: &Scene, inputs: &Inputs, progress: &Progress) -> Result<RgbaImage, RenderError> {
        if let Some(([first, second], stripes)) = halves(scene) {
            let first = self.render(&first, inputs, progress)?;
            return Ok(interleave(first, &self.render(&second, inputs, progress)?, stripes));
        }
        draw(&Frame::new(scene, inputs, &mut self.kept)?, progress)
    }
}

/// Pixels along a side of what one task draws.
const TILE: u32 = 32;
/// Tiles drawn before they are put into the picture.
const TILES_AT_ONCE: usize = 4096;

fn draw(frame: &Frame, progress: &Progress) -> Result<RgbaImage, RenderError> {
    let light = match &frame.field {
        Some(field) => LightVolume::new(field, &frame.view, &frame.solid, &frame.roaming_box, progress)?,
        None => None,
    };
    let [width, height] = frame.scene.size_px;
    let across = width.div_ceil(TILE);
    let tiles = across * height.div_ceil(TILE);
    progress.begin("render", u64::from(tiles));
    let mut image = RgbaImage::new(width, height);
    // Some at a time, so that large pictures are not held twice.
    for first in (0..tiles).step_by(TILES_AT_ONCE) {
        let drawn: Vec<(u32, u32, Vec<[u8; 4]>)> = (first..tiles.min(first + TILES_AT_ONCE as u32))
            .into_par_iter()
            .map(|tile| {
                let (left, top) = (tile % across * TILE, tile / across * TILE);
                let (right, bottom) = ((left + TILE).min(width), (top + TILE).min(height));
                let places = (top..bottom).flat_map(|y| (left..right).map(move |x| (x, y)));
                let pixels = places.map(|(x, y)| pixel(frame, light.as_ref(), x, y)).collect();
                progress.step(1).map(|()| (left, top, pixels))
            })
            .collect::<Result<_, _>>()?;
        for (left, top, pixels) in drawn {
            let columns = TILE.min(width - left);
            for (n, pixel) in (0u32..).zip(pixels) {
                image.put_pixel(left + n % columns, top + n / columns, image::Rgba(pixel));
            }
        }
    }
    outline::draw(frame, &mut image);
    Ok(image)
}

/// The averaged colour of one pixel, straight 8-bit RGBA.
fn pixel(frame: &Frame, light: Option<&LightVolume>, x: u32, y: u32) -> [u8; 4] {
    let samples = frame.scene.samples;
    let mut sum = Vec4::ZERO;
    for sub_y in 0..samples {
        for sub_x in 0..samples {
            let offset = DVec2::new(f64::from(sub_x) + 0.5, f64::from(sub_y) + 0.5) / f64::from(samples);
            let view_ray = frame.view.ray(DVec2::new(f64::from(x), f64::from(y)) + offset);
            let colour = trace(frame, light, &view_ray);
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
