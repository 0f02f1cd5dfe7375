//! Text drawn into images, for the contact sheet and for legends, in one upright sans-serif face.
//!
//! The face is Ubuntu Light (Ubuntu Font Licence 1.0), embedded through `epaint_default_fonts`. Glyphs are
//! outlined by `ab_glyph` with exact area coverage, kerned, and composited on sRGB-encoded values. Text runs
//! left to right only. A character that the face lacks is drawn as its missing-glyph box.
//! [`outline_text`] gives the same lettering as curves, for whoever turns it, strokes it or writes it as vectors;
//! [`crate::subset`] gives the face itself, for files that carry it along.

use std::sync::OnceLock;

use ab_glyph::{Font, FontRef, OutlineCurve, PxScale, ScaleFont};
use image::RgbaImage;

use crate::Colour;

/// Exponent of the coverage: dark text in a light face looks too thin without it.
const COVERAGE_EXPONENT: f32 = 0.75;

/// The extent of a line of text.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TextExtent {
    /// Advance from the first glyph's origin to the end.
    pub width_px: f32,
    /// From the baseline up to the top of the tallest letters.
    pub ascent_px: f32,
    /// From the baseline down to the foot of the lowest letters.
    pub descent_px: f32,
}

/// The extent of a line of text at a font size (pixels per em).
///
/// ```
/// let small = ttf::text::measure_text(10.0, "limestone");
/// let large = ttf::text::measure_text(20.0, "limestone");
/// assert!((large.width_px - 2.0 * small.width_px).abs() < 1e-3);
/// ```
pub fn measure_text(size_px: f32, text: &str) -> TextExtent {
    let scaled = face().as_scaled(scale(size_px));
    let mut width_px = 0.0;
    let mut previous = None;
    for character in text.chars() {
        let glyph = scaled.glyph_id(character);
        width_px += previous.map_or(0.0, |before| scaled.kern(before, glyph)) + scaled.h_advance(glyph);
        previous = Some(glyph);
    }
    TextExtent { width_px, ascent_px: scaled.ascent(), descent_px: -scaled.descent() }
}

/// Draws a line of text. `at_px` is the left end of its baseline (x right, y down), `size_px` the font size
/// (pixels per em). Parts outside the image are not drawn.
///
/// ```
/// use ttf::text::draw_text;
/// let mut image = image::RgbaImage::from_pixel(40, 20, image::Rgba([255; 4]));
/// let blank = image.clone();
/// draw_text(&mut image, [100.0, 15.0], 12.0, ttf::Colour::BLACK, "outside");
/// assert!(image == blank);
/// draw_text(&mut image, [2.0, 15.0], 12.0, ttf::Colour::BLACK, "I");
/// assert!(image != blank);
/// ```
pub fn draw_text(image: &mut RgbaImage, at_px: [f32; 2], size_px: f32, colour: Colour, text: &str) {
    let scaled = face().as_scaled(scale(size_px));
    let mut x = at_px[0];
    let mut previous = None;
    for character in text.chars() {
        let glyph_id = scaled.glyph_id(character);
        x += previous.map_or(0.0, |before| scaled.kern(before, glyph_id));
        let glyph = glyph_id.with_scale_and_position(scale(size_px), ab_glyph::point(x, at_px[1]));
        if let Some(outline) = scaled.outline_glyph(glyph) {
            let corner = outline.px_bounds().min;
            outline.draw(|dx, dy, coverage| {
                let pixel = [corner.x + dx as f32, corner.y + dy as f32];
                let inside = pixel[0] >= 0.0
                    && pixel[1] >= 0.0
                    && pixel[0] < image.width() as f32
                    && pixel[1] < image.height() as f32;
                if inside {
                    let target = image.get_pixel_mut(pixel[0] as u32, pixel[1] as u32);
                    blend(&mut target.0, colour, ink_of_coverage(coverage));
                }
            });
        }
        x += scaled.h_advance(glyph_id);
        previous = Some(glyph_id);
    }
}

/// Whether the face has a glyph for a character; one that it lacks is drawn as a box.
///
/// ```
/// use ttf::text::is_known;
/// assert!(is_known('ø') && is_known('Ж') && !is_known('石') && !is_known('ح'));
/// ```
pub fn is_known(character: char) -> bool {
    face().glyph_id(character).0 != 0
}

/// A piece of a glyph's contour; contours are closed and follow one another.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum TextCurve {
    /// A straight line.
    Line([[f32; 2]; 2]),
    /// A quadratic Bézier curve: start, control point, end.
    Quad([[f32; 2]; 3]),
    /// A cubic Bézier curve: start, two control points, end.
    Cubic([[f32; 2]; 4]),
}

/// The contours of a line of text at a font size (per em), x right and y down from the left end of its baseline.
///
/// The advance is that of [`measure_text`]. Fill by the non-zero rule; [`ink_of_coverage`] gives the tone that
/// [`draw_text`] draws with.
///
/// ```
/// use ttf::text::{TextCurve, outline_text};
/// // The letter I of this face is one upright stem: straight lines that end where they begin.
/// let stem = outline_text(100.0, "I");
/// assert!(stem.iter().all(|curve| matches!(curve, TextCurve::Line(_))));
/// let (TextCurve::Line([begin, _]), TextCurve::Line([_, end])) = (stem[0], stem[stem.len() - 1]) else { panic!() };
/// assert_eq!(begin, end);
/// ```
pub fn outline_text(size_px: f32, text: &str) -> Vec<TextCurve> {
    let face = face();
    let scaled = face.as_scaled(scale(size_px));
    let per_unit = size_px / face.units_per_em().unwrap_or(1000.0);
    let (mut x, mut previous) = (0.0, None);
    let mut curves = Vec::new();
    for character in text.chars() {
        let glyph = scaled.glyph_id(character);
        x += previous.map_or(0.0, |before| scaled.kern(before, glyph));
        if let Some(outline) = face.outline(glyph) {
            let place = |p: ab_glyph::Point| [x + p.x * per_unit, -p.y * per_unit];
            curves.extend(outline.curves.iter().map(|curve| match *curve {
                OutlineCurve::Line(a, b) => TextCurve::Line([a, b].map(place)),
                OutlineCurve::Quad(a, b, c) => TextCurve::Quad([a, b, c].map(place)),
                OutlineCurve::Cubic(a, b, c, d) => TextCurve::Cubic([a, b, c, d].map(place)),
            }));
        }
        x += scaled.h_advance(glyph);
        previous = Some(glyph);
    }
    curves
}

/// The share of ink where a glyph covers this share of a pixel: light faces look too thin without it.
pub fn ink_of_coverage(coverage: f32) -> f32 {
    coverage.clamp(0.0, 1.0).powf(COVERAGE_EXPONENT)
}

/// Composites a colour at a coverage over a pixel with straight alpha.
fn blend(pixel: &mut [u8; 4], colour: Colour, coverage: f32) {
    let below = f32::from(pixel[3]) / 255.0 * (1.0 - coverage);
    let alpha = coverage + below;
    if alpha <= 0.0 {
        return;
    }
    for (channel, top) in pixel.iter_mut().zip(colour.rgb) {
        let mixed = (f32::from(top) * coverage + f32::from(*channel) * below) / alpha;
        *channel = mixed.round() as u8;
    }
    pixel[3] = (alpha * 255.0).round() as u8;
}

/// The face.
pub(crate) fn face() -> &'static FontRef<'static> {
    static FACE: OnceLock<FontRef<'static>> = OnceLock::new();
    FACE.get_or_init(|| {
        FontRef::try_from_slice(epaint_default_fonts::UBUNTU_LIGHT)
            .expect("the embedded face is a constant of the program, and a test parses it")
    })
}

/// `ab_glyph` scales by the height of the face; sizes here are per em, as in typography.
fn scale(size_px: f32) -> PxScale {
    let face = face();
    let per_em = face.units_per_em().expect("the embedded face states its units per em");
    PxScale::from(size_px * face.height_unscaled() / per_em)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn page() -> RgbaImage {
        RgbaImage::from_pixel(120, 40, image::Rgba([255, 255, 255, 255]))
    }

    fn darkest_columns(image: &RgbaImage) -> Vec<u32> {
        (0..image.width()).filter(|&x| (0..image.height()).any(|y| image.get_pixel(x, y).0[0] < 128)).collect()
    }

    #[test]
    fn ink_stays_within_the_measured_extent() {
        let mut image = page();
        let extent = measure_text(20.0, "Hagel");
        draw_text(&mut image, [10.0, 28.0], 20.0, Colour::BLACK, "Hagel");
        let columns = darkest_columns(&image);
        assert!(columns[0] >= 10 && columns[0] <= 14, "{}", columns[0]);
        let end = columns[columns.len() - 1] as f32;
        assert!(end <= 10.0 + extent.width_px && end > 10.0 + extent.width_px - 4.0);
        for (_, y, pixel) in image.enumerate_pixels() {
            let outside = (y as f32) < 27.0 - extent.ascent_px || y as f32 > 28.0 + extent.descent_px;
            assert!(!(outside && pixel.0[0] < 250));
        }
    }

    #[test]
    fn text_outside_the_image_is_left_out_and_odd_characters_do_no_harm() {
        let mut image = page();
        draw_text(&mut image, [-500.0, -500.0], 20.0, Colour::BLACK, "gone");
        draw_text(&mut image, [110.0, 39.0], 20.0, Colour::BLACK, "cut");
        draw_text(&mut image, [f32::NAN, 3.0], 20.0, Colour::BLACK, "nan");
        draw_text(&mut image, [0.0, 20.0], 12.0, Colour::BLACK, "Ø å \u{1f30b} \n\t");
        assert_eq!(image.dimensions(), (120, 40));
        assert_eq!(measure_text(12.0, "").width_px, 0.0);
    }

    #[test]
    fn lettering_on_nothing_has_its_own_colour() {
        let mut image = RgbaImage::new(40, 40);
        draw_text(&mut image, [5.0, 30.0], 30.0, Colour::new(200, 10, 20), "I");
        let solid = image.pixels().max_by_key(|pixel| pixel.0[3]).unwrap();
        assert_eq!(&solid.0[..3], &[200, 10, 20]);
    }
}
