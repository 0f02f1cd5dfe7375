//! The contact sheet: every texture of a library at printed size on its colour, with its name and FGDC number
//! below.

use std::collections::BTreeMap;
use std::sync::Arc;

use image::{Rgba, RgbaImage};

use crate::text::{draw_text, measure_text};
use crate::{Colour, Pattern, Texture, TextureLibrary, TtfError};

/// Pixels per millimetre (220 dpi): patterns are as large as in a figure printed at that resolution.
const PIXELS_PER_MM: f32 = 220.0 / 25.4;
/// Width and height of a swatch.
const SWATCH_MM: [f32; 2] = [42.0, 29.0];
/// Space between columns, and below a swatch for its two lines of text.
const GAP_MM: [f32; 2] = [4.0, 11.5];
/// Margin around the sheet.
const MARGIN_MM: f32 = 6.0;
/// Swatches in a row.
const COLUMNS: usize = 6;
/// Samples per pixel along each axis.
const SUPERSAMPLES: u32 = 2;

const LETTERS: Colour = Colour::new(0x23, 0x1f, 0x1b);
const SMALL_LETTERS: Colour = Colour::new(0x66, 0x60, 0x58);

/// Draws all textures of a library as swatches at printed size (220 dpi), six in a row, in catalogue order.
///
/// # Errors
/// A drawing that cannot be rasterised.
pub fn contact_sheet(library: &TextureLibrary) -> Result<RgbaImage, TtfError> {
    contact_sheet_beside(library, &BTreeMap::new())
}

/// A drawing to look at beside one of ours: its pixels, and the printed width and height of its tile in millimetres.
pub type TileBeside = (Arc<Texture>, [f32; 2]);

/// Draws [`contact_sheet`], and in the right half of a swatch, on white, the tile of the same FGDC number in `beside`.
///
/// # Errors
/// A drawing that cannot be rasterised.
pub fn contact_sheet_beside(
    library: &TextureLibrary,
    beside: &BTreeMap<u16, TileBeside>,
) -> Result<RgbaImage, TtfError> {
    let px = |mm: f32| (mm * PIXELS_PER_MM).round() as u32;
    let rows = library.len().div_ceil(COLUMNS).max(1);
    let pitch = [SWATCH_MM[0] + GAP_MM[0], SWATCH_MM[1] + GAP_MM[1]];
    let width = px(2.0 * MARGIN_MM + pitch[0] * COLUMNS as f32 - GAP_MM[0]);
    let height = px(2.0 * MARGIN_MM + pitch[1] * rows as f32);
    let mut sheet = RgbaImage::from_pixel(width, height, Rgba([255, 255, 255, 255]));
    for (index, pattern) in library.patterns().enumerate() {
        let left = px(MARGIN_MM + pitch[0] * (index % COLUMNS) as f32);
        let top = px(MARGIN_MM + pitch[1] * (index / COLUMNS) as f32);
        let [wide, high] = SWATCH_MM.map(px);
        let other = pattern.fgdc.and_then(|number| beside.get(&number));
        let own = if other.is_some() { wide / 2 } else { wide };
        let background = pattern.colour.to_unit();
        draw_swatch(
            &mut sheet,
            [left, top],
            [own, high],
            background,
            (library.texture(index)?.as_ref(), pattern.tile_mm),
        );
        if let Some((texture, tile_mm)) = other {
            draw_swatch(&mut sheet, [left + own, top], [wide - own, high], [1.0; 3], (texture, *tile_mm));
        }
        label(&mut sheet, [left as f32, (top + px(SWATCH_MM[1])) as f32], pattern);
    }
    Ok(sheet)
}

fn draw_swatch(
    sheet: &mut RgbaImage,
    corner: [u32; 2],
    size: [u32; 2],
    background: [f32; 3],
    (texture, tile_mm): (&Texture, [f32; 2]),
) {
    let step = tile_mm.map(|side| 1.0 / (side * PIXELS_PER_MM * SUPERSAMPLES as f32));
    for y in 0..size[1] {
        for x in 0..size[0] {
            let edge = x == 0 || y == 0 || x == size[0] - 1 || y == size[1] - 1;
            let colour = if edge {
                LETTERS
            } else {
                let mut sum = [0.0; 3];
                for sample in 0..SUPERSAMPLES * SUPERSAMPLES {
                    let u = (x * SUPERSAMPLES + sample % SUPERSAMPLES) as f32 + 0.5;
                    let v = ((size[1] - y) * SUPERSAMPLES - sample / SUPERSAMPLES) as f32 - 0.5;
                    let texel = texture.sample([u * step[0], v * step[1]], [step[0], 0.0], [0.0, -step[1]]);
                    for channel in 0..3 {
                        sum[channel] += texel[channel] + background[channel] * (1.0 - texel[3]);
                    }
                }
                Colour::from_unit(sum.map(|channel| channel / (SUPERSAMPLES * SUPERSAMPLES) as f32))
            };
            let [r, g, b] = colour.rgb;
            sheet.put_pixel(corner[0] + x, corner[1] + y, Rgba([r, g, b, 255]));
        }
    }
}

fn label(sheet: &mut RgbaImage, [x, y]: [f32; 2], pattern: &Pattern) {
    let width = SWATCH_MM[0] * PIXELS_PER_MM;
    let size = 3.1 * PIXELS_PER_MM;
    let needed = measure_text(size, &pattern.title).width_px;
    let fitted = size * (width / needed).min(1.0);
    draw_text(sheet, [x, y + 4.0 * PIXELS_PER_MM], fitted, LETTERS, &pattern.title);
    let second = match pattern.fgdc {
        Some(number) => format!("{number}  {}", pattern.name),
        None => pattern.name.clone(),
    };
    draw_text(sheet, [x, y + 7.6 * PIXELS_PER_MM], 2.5 * PIXELS_PER_MM, SMALL_LETTERS, &second);
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_sheet_shows_every_pattern_on_its_colour() {
        let library = TextureLibrary::builtin().unwrap();
        let sheet = contact_sheet(&library).unwrap();
        for (index, pattern) in library.patterns().enumerate() {
            let at = |mm: f32, pitch: f32, step: usize| ((MARGIN_MM + pitch * step as f32 + mm) * PIXELS_PER_MM) as u32;
            let left = at(0.0, SWATCH_MM[0] + GAP_MM[0], index % COLUMNS);
            let top = at(0.0, SWATCH_MM[1] + GAP_MM[1], index / COLUMNS);
            let mut sum = [0.0; 3];
            let (wide, high) = (360, 240);
            for y in 0..high {
                for x in 0..wide {
                    let pixel = sheet.get_pixel(left + 2 + x, top + 2 + y).0;
                    (0..3).for_each(|c| sum[c] += f32::from(pixel[c]) / (255.0 * (wide * high) as f32));
                }
            }
            let expected = library.texture(index).unwrap().average_over(pattern.colour.to_unit(), None);
            for channel in 0..3 {
                assert!((sum[channel] - expected[channel]).abs() < 0.03, "{}: {sum:?} {expected:?}", pattern.name);
            }
        }
    }
}
