//! What stands beside and below a printed picture: legend, scale bar, and what a reader must know.
//!
//! Lengths are millimetres on paper. Bars hold where the projection is parallel; with a perspective they hold in the middle of the block, and the
//! caption says so.

use crate::state::camera;
use glam::DVec2;
use image::{Rgba, RgbaImage, imageops};
use project::error::ProjectError;
use render::{Projection, Scene};
use survey::{SurveyGeometry, VerticalUnit};
use ttf::text::{draw_text, measure_text};
use ttf::{Colour, TextureLibrary};

/// Width of the legend.
pub(super) const LEGEND_MM: f64 = 44.0;
/// Width and height of a swatch in it, and the distance from one to the next.
const SWATCH_MM: [f64; 2] = [11.0, 6.5];
const PITCH_MM: f64 = 9.0;
/// The same for a line of the horizons' legend.
const LINE_MM: f64 = 6.0;
/// Height of the strip below the block.
pub(super) const STRIP_MM: f64 = 13.0;
/// Height of lettering: 8 points.
const LETTER_MM: f64 = 2.9;
pub(super) const MARGIN_MM: f64 = 3.0;
/// Part of the picture's width that a scale bar may take.
const BAR_SHARE: f64 = 0.3;
const INK: Colour = Colour::new(0x23, 0x1f, 0x1b);

/// Pattern and name of each layer, youngest on top.
pub(super) fn layers(
    sheet: &mut RgbaImage,
    [left, top]: [f64; 2],
    px: &impl Fn(f64) -> f64,
    styles: &[ttf::LayerStyle],
    library: &TextureLibrary,
) -> Result<(), ProjectError> {
    let right = f64::from(sheet.width()) - px(MARGIN_MM);
    for (row, style) in styles.iter().enumerate() {
        let y = top + px(PITCH_MM) * row as f64;
        let swatch = crate::views::swatch::draw(
            style,
            library,
            SWATCH_MM.map(|side| px(side).round().max(2.0) as u32),
            px(1.0) as f32,
        )?;
        frame(sheet, [left, y], [f64::from(swatch.width()), f64::from(swatch.height())], px(0.2));
        imageops::overlay(sheet, &swatch, left.round() as i64, y.round() as i64);
        let x = left + px(SWATCH_MM[0] + 2.0);
        letter(sheet, [x, y + px(SWATCH_MM[1] * 0.5 + LETTER_MM * 0.35)], right - x, px(LETTER_MM), &style.layer);
    }
    Ok(())
}

/// Colour and name of each horizon, youngest on top.
pub(super) fn horizons(
    sheet: &mut RgbaImage,
    [left, top]: [f64; 2],
    px: &impl Fn(f64) -> f64,
    horizons: &[(Colour, String)],
) {
    let right = f64::from(sheet.width()) - px(MARGIN_MM);
    for (row, (colour, name)) in horizons.iter().enumerate() {
        let y = top + px(LINE_MM) * (row as f64 + 0.5);
        fill(sheet, [left, y - px(0.5)], [px(SWATCH_MM[0]), px(1.0)], *colour);
        let x = left + px(SWATCH_MM[0] + 2.0);
        letter(sheet, [x, y + px(LETTER_MM * 0.35)], right - x, px(LETTER_MM), name);
    }
}

/// A line of lettering, smaller where there is not enough room.
fn letter(sheet: &mut RgbaImage, [x, baseline]: [f64; 2], room: f64, size: f64, text: &str) {
    let width = f64::from(measure_text(size as f32, text).width_px);
    let size = if width > room { size * (room / width).max(0.5) } else { size };
    draw_text(sheet, [x as f32, baseline as f32], size as f32, INK, text);
}

fn fill(sheet: &mut RgbaImage, [x, y]: [f64; 2], [width, height]: [f64; 2], colour: Colour) {
    let [r, g, b] = colour.rgb;
    let end = [(x + width).round().max(x.round() + 1.0), (y + height).round().max(y.round() + 1.0)];
    for row in y.round().max(0.0) as u32..(end[1] as u32).min(sheet.height()) {
        for column in x.round().max(0.0) as u32..(end[0] as u32).min(sheet.width()) {
            sheet.put_pixel(column, row, Rgba([r, g, b, 255]));
        }
    }
}

fn frame(sheet: &mut RgbaImage, [x, y]: [f64; 2], [width, height]: [f64; 2], line: f64) {
    fill(sheet, [x - line, y - line], [width + 2.0 * line, height + 2.0 * line], INK);
}

/// The largest of 1, 2, 5 × 10ⁿ that is not larger.
fn round_length(longest: f64) -> f64 {
    let decade = 10f64.powf(longest.log10().floor());
    [5.0, 2.0, 1.0].into_iter().map(|factor| factor * decade).find(|length| *length <= longest).unwrap_or(decade)
}

/// The scale of a block drawn in so many pixels, in the strip that begins at `top`.
pub(super) fn scale_bars(
    sheet: &mut RgbaImage,
    top: f64,
    px: &impl Fn(f64) -> f64,
    scene: &Scene,
    geometry: &SurveyGeometry,
) {
    let size = DVec2::new(f64::from(scene.size_px[0]), f64::from(scene.size_px[1]));
    let middle = scene.box_in(geometry).centre();
    let px_per_m = camera::scale_at(&camera::view(scene, geometry, size), middle);
    let longest_m = size.x * BAR_SHARE / px_per_m;
    if !(longest_m > 0.0 && longest_m.is_finite()) {
        return;
    }
    let length_m = round_length(longest_m);
    let (left, y) = (px(MARGIN_MM), top + px(4.0));
    let length = length_m * px_per_m;
    fill(sheet, [left, y], [length, px(0.35)], INK);
    for end in [left, left + length] {
        fill(sheet, [end - px(0.15), y - px(0.9)], [px(0.3), px(2.1)], INK);
    }
    let text = if length_m >= 1000.0 { format!("{} km", length_m / 1000.0) } else { format!("{length_m} m") };
    letter(sheet, [left, y + px(1.6 + LETTER_MM)], length.max(px(20.0)), px(LETTER_MM), &text);
    let at = left + length + px(8.0);
    letter(
        sheet,
        [at, y + px(LETTER_MM * 0.35)],
        f64::from(sheet.width()) - at - px(MARGIN_MM),
        px(LETTER_MM),
        &caption(scene, geometry),
    );
}

/// What a reader must know to read lengths.
fn caption(scene: &Scene, geometry: &SurveyGeometry) -> String {
    let mut text = format!("vertical exaggeration {}", scene.exaggeration);
    if geometry.vertical.unit == VerticalUnit::Milliseconds {
        text += &format!(" at {} m/s", geometry.velocity_m_s);
    }
    if matches!(scene.camera.projection, Projection::Perspective { .. }) {
        text += "; lengths hold in the middle of the block";
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bars_have_round_lengths() {
        for (longest, said) in [(1.0, 1.0), (1.99, 1.0), (4.9, 2.0), (7.0, 5.0), (1234.0, 1000.0), (0.3, 0.2)] {
            assert!((round_length(longest) - said).abs() < 1e-9, "{longest}");
        }
    }

    #[test]
    fn the_caption_says_what_time_was_turned_into_depth_with() {
        let geometry = SurveyGeometry::regular([9, 9, 9], 25.0, 4.0, VerticalUnit::Milliseconds);
        let scene = Scene { exaggeration: 2.5, ..Scene::default() };
        assert_eq!(caption(&scene, &geometry), "vertical exaggeration 2.5 at 2000 m/s");
    }
}
