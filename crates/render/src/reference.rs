//! The CPU reference: what the GPU passes must reproduce, written for clarity.
//!
//! Each pixel takes `samples` × `samples` rays on a regular grid. A ray finds the first point of the block
//! ([`crate::visible`]), which is coloured and averaged with its pixel's others on sRGB-encoded, alpha-weighted values.

use crate::camera::ViewRay;
use crate::error::RenderError;
use crate::frame::Frame;
use crate::inputs::Inputs;
use crate::media::interleaved::{halves, interleave};
use crate::media::light::LightVolume;
use crate::media::light_grid::Asked;
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
/// Pixels along a side of what is traced together.
const BLOCK: usize = 8;
/// Tiles drawn before they are put into the picture.
const TILES_AT_ONCE: usize = 4096;

fn draw(frame: &Frame, progress: &Progress) -> Result<RgbaImage, RenderError> {
    let light = match &frame.field {
        Some(field) => {
            let asked = if frame.tubes.is_some() { Asked::Everywhere } else { Asked::Block };
            LightVolume::new(field, &frame.view, &frame.solid, &frame.roaming_box, asked, progress)?
        }
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
                let mut pixels = vec![[0; 4]; ((right - left) * (bottom - top)) as usize];
                for y in (top..bottom).step_by(BLOCK) {
                    for x in (left..right).step_by(BLOCK) {
                        let (across, down) = ((right - x).min(BLOCK as u32), (bottom - y).min(BLOCK as u32));
                        for (n, pixel) in (0..).zip(block(frame, light.as_ref(), [x, y], [across, down])) {
                            let (column, row) = (x - left + n % across, y - top + n / across);
                            pixels[(row * (right - left) + column) as usize] = pixel;
                        }
                    }
                }
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

/// The averaged colours of a block of pixels, straight 8-bit RGBA, row by row.
fn block(frame: &Frame, light: Option<&LightVolume>, [left, top]: [u32; 2], [across, down]: [u32; 2]) -> Vec<[u8; 4]> {
    let samples = frame.scene.samples;
    let per_pixel = samples * samples;
    let rays: Vec<ViewRay> = (0..across * down * per_pixel)
        .map(|n| {
            let (pixel, sub) = (n / per_pixel, n % per_pixel);
            let corner = DVec2::new(f64::from(left + pixel % across), f64::from(top + pixel / across));
            let offset = DVec2::new(f64::from(sub % samples) + 0.5, f64::from(sub / samples) + 0.5);
            frame.view.ray(corner + offset / f64::from(samples))
        })
        .collect();
    let colours = trace(frame, light, &rays);
    let average = |colours: &[Vec4]| {
        let sum: Vec4 = colours.iter().map(|colour| (colour.truncate() * colour.w).extend(colour.w)).sum();
        straight_bytes(sum / per_pixel as f32)
    };
    colours.chunks(per_pixel as usize).map(average).collect()
}

/// 8-bit straight RGBA of a premultiplied colour.
fn straight_bytes(premultiplied: Vec4) -> [u8; 4] {
    let alpha = premultiplied.w;
    let rgb = if alpha > 0.0 { premultiplied.truncate() / alpha } else { premultiplied.truncate() };
    rgb.extend(alpha).to_array().map(|c| (c.clamp(0.0, 1.0) * 255.0 + 0.5) as u8)
}
