//! Letters: covered exactly, pixel by pixel, whatever their turn.

use crate::list::{Ink, Text};
use ab_glyph_rasterizer::{Rasterizer, point};
use glam::DVec2;
use tiny_skia::{Mask, Paint, PixmapMut};
use ttf::text::{TextCurve, ink_of_coverage, outline_text};

/// A line of text as shares of ink.
pub(super) struct Lettering {
    /// Pixel of the page that the upper left share belongs to.
    corner: [i64; 2],
    width: usize,
    shares: Vec<f32>,
    ink: Ink,
}

impl Lettering {
    pub(super) fn of(text: &Text, scale: f64) -> Self {
        let curves = curves_px(text, scale);
        let all = || curves.iter().flat_map(|curve| places(curve).iter().copied());
        let low = all().fold(DVec2::INFINITY, |low, p| low.min(DVec2::from_array(p)));
        let high = all().fold(DVec2::NEG_INFINITY, |high, p| high.max(DVec2::from_array(p)));
        let mut letters = Self { corner: [0; 2], width: 0, shares: Vec::new(), ink: text.ink };
        if !(low.is_finite() && high.is_finite()) {
            return letters;
        }
        // One pixel around: the rasteriser wants everything well inside.
        let corner = low.floor() - 1.0;
        let size = (high.ceil() + 1.0 - corner).min(DVec2::splat(f64::from(super::MOST_SIDE_PX)));
        let [width, height] = [size.x as usize + 1, size.y as usize + 1];
        let mut rasterizer = Rasterizer::new(width, height);
        let at = |p: [f64; 2]| point((p[0] - corner.x) as f32, (p[1] - corner.y) as f32);
        for curve in &curves {
            match *curve {
                CurvePx::Line([a, b]) => rasterizer.draw_line(at(a), at(b)),
                CurvePx::Quad([a, b, c]) => rasterizer.draw_quad(at(a), at(b), at(c)),
                CurvePx::Cubic([a, b, c, d]) => rasterizer.draw_cubic(at(a), at(b), at(c), at(d)),
            }
        }
        letters.corner = [corner.x as i64, corner.y as i64];
        letters.width = width;
        letters.shares = vec![0.0; width * height];
        rasterizer.for_each_pixel(|n, coverage| letters.shares[n] = ink_of_coverage(coverage));
        letters
    }

    pub(super) fn paint(&self, pixmap: &mut PixmapMut, top: f32, mask: Option<&Mask>) {
        let [width, height] = [i64::from(pixmap.width()), i64::from(pixmap.height())];
        let data = pixmap.data_mut();
        for (n, share) in self.shares.iter().enumerate().filter(|(_, share)| **share > 0.0) {
            let x = self.corner[0] + (n % self.width) as i64;
            let y = self.corner[1] + (n / self.width) as i64 - top as i64;
            if x < 0 || y < 0 || x >= width || y >= height {
                continue;
            }
            let at = (y * width + x) as usize;
            let kept = mask.map_or(1.0, |mask| f32::from(mask.data()[at]) / 255.0);
            let alpha = share * self.ink.opacity * kept;
            let pixel = &mut data[4 * at..4 * at + 4];
            let [r, g, b] = self.ink.colour.rgb;
            for (channel, ink) in pixel.iter_mut().zip([r, g, b, 255]) {
                *channel = (f32::from(ink) * alpha + f32::from(*channel) * (1.0 - alpha) + 0.5) as u8;
            }
        }
    }
}

/// The rim around letters, as a stroke of their contours.
pub(super) fn halo(text: &Text, scale: f64) -> Option<(tiny_skia::Path, tiny_skia::Stroke, Paint<'static>)> {
    let (path, stroke) = text.rim()?;
    let (drawn, paint) = super::paths::stroke(&stroke, scale)?;
    Some((super::paths::trace(&path, scale)?, drawn, paint))
}

/// A piece of a contour in pixels of the page.
enum CurvePx {
    Line([[f64; 2]; 2]),
    Quad([[f64; 2]; 3]),
    Cubic([[f64; 2]; 4]),
}

fn places(curve: &CurvePx) -> &[[f64; 2]] {
    match curve {
        CurvePx::Line(places) => places,
        CurvePx::Quad(places) => places,
        CurvePx::Cubic(places) => places,
    }
}

fn curves_px(text: &Text, scale: f64) -> Vec<CurvePx> {
    text.straight().iter().flat_map(|line| straight_curves_px(line, scale)).collect()
}

fn straight_curves_px(text: &Text, scale: f64) -> Vec<CurvePx> {
    let (start, turn) = text.baseline();
    let place = |p: [f32; 2]| ((start + turn.rotate(DVec2::new(f64::from(p[0]), f64::from(p[1])))) * scale).to_array();
    let curve = |curve: TextCurve| match curve {
        TextCurve::Line(places) => CurvePx::Line(places.map(place)),
        TextCurve::Quad(places) => CurvePx::Quad(places.map(place)),
        TextCurve::Cubic(places) => CurvePx::Cubic(places.map(place)),
    };
    outline_text(text.size as f32, &text.text).into_iter().map(curve).collect()
}
