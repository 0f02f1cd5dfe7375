//! A piece of a layer as it is drawn: colour and pattern, for legends and lists.

use image::{Rgba, RgbaImage};
use ttf::{LayerStyle, TextureLibrary};

/// Samples a pixel along each axis.
const SAMPLES: u32 = 2;

/// A layer's style over a rectangle, its base at the lower edge; tiles have their printed size at `px_per_mm`.
///
/// # Errors
/// A pattern that the library does not have or cannot rasterise.
pub fn draw(
    style: &LayerStyle,
    library: &TextureLibrary,
    [width, height]: [u32; 2],
    px_per_mm: f32,
) -> Result<RgbaImage, ttf::TtfError> {
    let place = format!("layer `{}`", style.layer);
    let mut textures = Vec::new();
    for interval in &style.intervals {
        let index = library.index_of(&interval.texture, &place)?;
        textures.push((library.texture(index)?, library.pattern(index).tile_mm));
    }
    let ink = style.ink.map(ttf::Colour::to_unit);
    let mut image = RgbaImage::new(width, height);
    for (x, y, pixel) in image.enumerate_pixels_mut() {
        let mut sum = [0.0f32; 3];
        for sub in 0..SAMPLES * SAMPLES {
            let offset = [sub % SAMPLES, sub / SAMPLES].map(|n| (n as f32 + 0.5) / SAMPLES as f32);
            // From the lower left corner, v up.
            let at = [x as f32 + offset[0], height as f32 - y as f32 - offset[1]];
            let k = at[1] / height as f32;
            let interval = style
                .intervals
                .iter()
                .zip(&textures)
                .find(|(interval, _)| k >= interval.k[0] && (k < interval.k[1] || interval.k[1] >= 1.0));
            let ground = interval.and_then(|(interval, _)| interval.colour).unwrap_or(style.colour).to_unit();
            let mut colour = ground;
            if let Some((interval, (texture, tile_mm))) = interval {
                let per_px = tile_mm.map(|side| 1.0 / (side * px_per_mm));
                let step = per_px.map(|p| p / SAMPLES as f32);
                let texel = texture.sample([at[0] * per_px[0], at[1] * per_px[1]], [step[0], 0.0], [0.0, step[1]]);
                // Texels are premultiplied.
                for channel in 0..3 {
                    let drawn = ink.map_or(texel[channel], |ink| ink[channel] * texel[3]);
                    colour[channel] += (drawn - colour[channel] * texel[3]) * interval.opacity;
                }
            }
            (0..3).for_each(|channel| sum[channel] += colour[channel]);
        }
        let count = (SAMPLES * SAMPLES) as f32;
        let [r, g, b] = sum.map(|channel| (channel / count * 255.0 + 0.5).clamp(0.0, 255.0) as u8);
        *pixel = Rgba([r, g, b, 255]);
    }
    Ok(image)
}

#[cfg(test)]
mod tests {
    use super::*;
    use ttf::Colour;

    #[test]
    fn a_plain_layer_is_its_colour_and_a_pattern_has_ink() {
        let library = TextureLibrary::builtin().unwrap();
        let plain = LayerStyle::plain("a", Colour::new(10, 20, 30));
        assert!(draw(&plain, &library, [8, 6], 4.0).unwrap().pixels().all(|p| p.0 == [10, 20, 30, 255]));
        let bricks = LayerStyle::textured("a", Colour::WHITE, "limestone");
        let drawn = draw(&bricks, &library, [60, 40], 4.0).unwrap();
        assert!(drawn.pixels().any(|p| p.0[0] < 100) && drawn.pixels().any(|p| p.0[0] > 240));
    }
}
