//! The CPU reference, which the shaders must reproduce; written for clarity.
//!
//! Each pixel casts `samples` × `samples` rays on a regular grid. A ray finds the first point of the block
//! ([`crate::visible`]) and its colour. The colours of a pixel are averaged as sRGB-encoded values weighted
//! by alpha.

use crate::cache::Kept;
use crate::camera::ViewRay;
use crate::error::RenderError;
use crate::inputs::Inputs;
use crate::kept_points::{KeptPoints, PicturePoints};
use crate::media::light::LightVolume;
use crate::media::light_grid::Asked;
use crate::media::stripes::{halves, interleave};
use crate::outline::draw::{OutlineLines, draw as draw_outlines, draw_lines};
use crate::resolved_scene::ResolvedScene;
use crate::scene::Scene;
use crate::shade::{stopping_points, trace};
use glam::{DVec2, Vec4};
use image::RgbaImage;
use rayon::prelude::*;
use survey::Progress;

/// Draws the scene on the CPU.
///
/// ```
/// use render::{Background, Inputs, NamedVolume, Outlines, Scene};
/// use survey::{Progress, SurveyGeometry, VerticalUnit, Volume};
/// use ttf::{Colour, ColourMap, RawColour, RgbaFunction};
/// let geometry = SurveyGeometry::regular([4, 4, 4], 10.0, 10.0, VerticalUnit::Metres);
/// // A volume of the value 0 in a grey map over -1 … 1: every pixel of the block is half grey.
/// let volume = Volume::filled([4, 4, 4], 0.0f32);
/// let volumes = [NamedVolume::whole("seismic", &volume)];
/// let scene = Scene {
///     size_px: [16, 12],
///     samples: 1,
///     raw: Some(RawColour::new("seismic", RgbaFunction::centred(ColourMap::Grey, 1.0))),
///     background: Background::Colour(Colour::BLACK),
///     outlines: Outlines::none(),
///     ..Scene::default()
/// };
/// let image = render::reference::render(&scene, &Inputs::raw(&geometry, &volumes), &Progress::silent()).unwrap();
/// assert_eq!(image.get_pixel(8, 6).0, [128, 128, 128, 255]);
/// assert_eq!(image.get_pixel(0, 0).0, [0, 0, 0, 255]);
/// ```
///
/// # Errors
/// A scene that cannot be drawn, missing inputs, or cancellation.
pub fn render(scene: &Scene, inputs: &Inputs, progress: &Progress) -> Result<RgbaImage, RenderError> {
    CpuRenderer::default().render(scene, inputs, progress)
}

/// The CPU renderer. It keeps what it has computed from the data while [`Inputs::data_key`] stays the same.
#[derive(Debug, Default)]
pub struct CpuRenderer {
    kept: Kept,
    points: KeptPoints,
}

impl CpuRenderer {
    /// One that also keeps what rays hit, in at most so many bytes: a picture whose styles alone have changed is coloured
    /// again without looking for it.
    pub fn keeping_points(max_bytes: usize) -> Self {
        Self { points: KeptPoints::within(max_bytes), ..Self::default() }
    }

    /// Draws the scene.
    ///
    /// # Errors
    /// A scene that cannot be drawn, missing inputs, or cancellation.
    pub fn render(&mut self, scene: &Scene, inputs: &Inputs, progress: &Progress) -> Result<RgbaImage, RenderError> {
        if let Some(([first, second], stripes)) = halves(scene) {
            let first = self.render(&first, inputs, progress)?;
            return Ok(interleave(first, &self.render(&second, inputs, progress)?, stripes));
        }
        let resolved = ResolvedScene::new(scene, inputs, &mut self.kept)?;
        let points = self.points.of(&resolved, inputs, BLOCK as u32);
        draw(&resolved, points.as_deref(), progress)
    }
}

/// Side of the tile that one task draws, pixels.
const TILE: u32 = 32;
/// Side of the block of pixels that is traced together.
const BLOCK: usize = 8;
/// Number of tiles that are drawn before they are copied into the picture.
const TILES_AT_ONCE: usize = 4096;

fn draw(
    resolved: &ResolvedScene,
    points: Option<&PicturePoints>,
    progress: &Progress,
) -> Result<RgbaImage, RenderError> {
    let light = match &resolved.field {
        Some(field) => {
            let asked = if resolved.tubes.is_some() { Asked::Everywhere } else { Asked::Block };
            LightVolume::new(field, &resolved.view, &resolved.solid, &resolved.roaming_box, asked, progress)?
        }
        None => None,
    };
    let [width, height] = resolved.scene.size_px;
    let across = width.div_ceil(TILE);
    let tiles = across * height.div_ceil(TILE);
    progress.begin("render", u64::from(tiles));
    let mut image = RgbaImage::new(width, height);
    // A limited number at a time, so that a large picture is not held in memory twice.
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
                        for (n, pixel) in (0..).zip(block(resolved, (light.as_ref(), points), [x, y], [across, down])) {
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
    match points {
        Some(points) => draw_lines(resolved, points.lines(|| OutlineLines::of(resolved)), &mut image),
        None => draw_outlines(resolved, &mut image),
    }
    Ok(image)
}

/// The averaged colours of a block of pixels, 8-bit straight RGBA, row by row.
fn block(
    resolved: &ResolvedScene,
    (light, points): (Option<&LightVolume>, Option<&PicturePoints>),
    [left, top]: [u32; 2],
    [across, down]: [u32; 2],
) -> Vec<[u8; 4]> {
    let samples = resolved.scene.samples;
    let per_pixel = samples * samples;
    let ray = |n: u32| {
        let (pixel, sub) = (n / per_pixel, n % per_pixel);
        let corner = DVec2::new(f64::from(left + pixel % across), f64::from(top + pixel / across));
        let offset = DVec2::new(f64::from(sub % samples) + 0.5, f64::from(sub / samples) + 0.5);
        resolved.view.ray(corner + offset / f64::from(samples))
    };
    let rays = || (0..across * down * per_pixel).map(ray).collect::<Vec<ViewRay>>();
    let colours = match points {
        Some(points) => points.block([left, top], || stopping_points(resolved, &rays())).colours(resolved),
        None => trace(resolved, light, &rays()),
    };
    if colours.is_empty() {
        let background = Vec4::from_array(resolved.background);
        let all = (background.truncate() * background.w).extend(background.w);
        return vec![straight_bytes(all); (across * down) as usize];
    }
    let average = |colours: &[Vec4]| {
        let sum: Vec4 = colours.iter().map(|colour| (colour.truncate() * colour.w).extend(colour.w)).sum();
        straight_bytes(sum / per_pixel as f32)
    };
    colours.chunks(per_pixel as usize).map(average).collect()
}

/// Converts a premultiplied colour to 8-bit straight RGBA.
fn straight_bytes(premultiplied: Vec4) -> [u8; 4] {
    let alpha = premultiplied.w;
    let rgb = if alpha > 0.0 { premultiplied.truncate() / alpha } else { premultiplied.truncate() };
    rgb.extend(alpha).to_array().map(|c| (c.clamp(0.0, 1.0) * 255.0 + 0.5) as u8)
}
