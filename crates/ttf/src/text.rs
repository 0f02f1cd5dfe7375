//! Text drawn into images, for the contact sheet and for legends, in an upright sans-serif face.
//!
//! The face is Ubuntu Light (Ubuntu Font Licence 1.0), embedded through `epaint_default_fonts`. Characters that it lacks
//! are set in the faces that a person gave ([`Faces`]), and are drawn as the missing-glyph box where none has them. A
//! line is set once ([`set`]): right-to-left and joined scripts as Unicode asks. Glyphs are outlined by `skrifa`,
//! covered exactly, and composited on sRGB-encoded values. [`outline_text`] gives the same lettering as curves, for
//! whoever turns it, strokes it or writes it as vectors; [`crate::subset`] gives a face itself, for files that carry it
//! along.

mod face;
mod line;
mod pieces;

pub use face::{Face, Faces};
pub use line::{Glyph, Line, measured, set};
pub use pieces::{Piece, pieces};

pub(crate) use face::OpenFace;
#[cfg(test)]
pub(crate) use face::embedded_open;

use ab_glyph_rasterizer::{Rasterizer, point};
use image::RgbaImage;

use crate::Colour;

/// Exponent of the coverage: dark text in a light face looks too thin without it.
const COVERAGE_EXPONENT: f32 = 0.75;
/// A line that takes more pixels than this to either side is not drawn.
const MOST_SIDE_PX: f32 = 16384.0;

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
    let Line { width, heights: [above, below], .. } = set(text);
    TextExtent { width_px: width * size_px, ascent_px: above * size_px, descent_px: below * size_px }
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
    let curves = outline_text(size_px, text);
    let places = || curves.iter().flat_map(|curve| curve.places().iter().copied());
    let low = places().fold([f32::MAX; 2], |low, p| [low[0].min(p[0]), low[1].min(p[1])]);
    let high = places().fold([f32::MIN; 2], |high, p| [high[0].max(p[0]), high[1].max(p[1])]);
    let corner = [0, 1].map(|axis| (at_px[axis] + low[axis]).floor() - 1.0);
    let size = [0, 1].map(|axis| (at_px[axis] + high[axis]).ceil() + 1.0 - corner[axis]);
    if !size.iter().all(|side| *side > 0.0 && *side < MOST_SIDE_PX) {
        return;
    }
    let mut rasterizer = Rasterizer::new(size[0] as usize + 1, size[1] as usize + 1);
    let at = |p: [f32; 2]| point(at_px[0] + p[0] - corner[0], at_px[1] + p[1] - corner[1]);
    for curve in &curves {
        match *curve {
            TextCurve::Line([a, b]) => rasterizer.draw_line(at(a), at(b)),
            TextCurve::Quad([a, b, c]) => rasterizer.draw_quad(at(a), at(b), at(c)),
            TextCurve::Cubic([a, b, c, d]) => rasterizer.draw_cubic(at(a), at(b), at(c), at(d)),
        }
    }
    rasterizer.for_each_pixel_2d(|dx, dy, coverage| {
        let pixel = [corner[0] + dx as f32, corner[1] + dy as f32];
        let inside =
            pixel[0] >= 0.0 && pixel[1] >= 0.0 && pixel[0] < image.width() as f32 && pixel[1] < image.height() as f32;
        if inside && coverage > 0.0 {
            let target = image.get_pixel_mut(pixel[0] as u32, pixel[1] as u32);
            blend(&mut target.0, colour, ink_of_coverage(coverage));
        }
    });
}

/// Whether a face of this thread has a glyph for a character, or it needs none; one that all lack is drawn as a box.
///
/// ```
/// use ttf::text::is_known;
/// assert!(is_known('ø') && is_known('Ж') && !is_known('石') && !is_known('ح'));
/// ```
pub fn is_known(character: char) -> bool {
    line::is_invisible(character) || Faces::current().holder(character).is_some()
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

impl TextCurve {
    /// Its places: the ends, with the control points between them.
    pub fn places(&self) -> &[[f32; 2]] {
        match self {
            Self::Line(places) => places,
            Self::Quad(places) => places,
            Self::Cubic(places) => places,
        }
    }

    /// The same with every place elsewhere.
    fn placed(self, place: impl Fn([f32; 2]) -> [f32; 2]) -> Self {
        match self {
            Self::Line(places) => Self::Line(places.map(place)),
            Self::Quad(places) => Self::Quad(places.map(place)),
            Self::Cubic(places) => Self::Cubic(places.map(place)),
        }
    }
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
    outline(size_px, &set(text))
}

/// The contours of a line that is set, as [`outline_text`] gives them.
pub fn outline(size_px: f32, line: &Line) -> Vec<TextCurve> {
    let faces = Faces::current();
    let mut curves = Vec::new();
    for (number, glyphs) in line.by_face() {
        let Some(open) = faces.face(number).open() else { continue };
        let per_unit = size_px / open.units_per_em;
        for glyph in glyphs {
            let place =
                |p: [f32; 2]| [glyph.at[0] * size_px + p[0] * per_unit, -(glyph.at[1] * size_px + p[1] * per_unit)];
            curves.extend(open.contours(glyph.id).into_iter().map(|curve| curve.placed(place)));
        }
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
