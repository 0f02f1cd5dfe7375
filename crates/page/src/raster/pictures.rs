//! Images: sampled at the middle of each pixel of the page, averaged where they are made smaller,
//! anti-aliased at their edges.

use crate::list::{Picture, Sampling};
use glam::{DMat2, DVec2};
use tiny_skia::{FillRule, FilterQuality, Mask, Paint, PathBuilder, Pattern, Pixmap, PixmapMut, SpreadMode, Transform};

/// Most samples along an axis that a pixel is averaged from.
const MOST_SAMPLES: f64 = 16.0;

/// Paints the part of an image that lies in some rows of the page.
pub(super) fn paint(pixmap: &mut PixmapMut, picture: &Picture, scale: f64, top: f32, mask: Option<&Mask>) {
    let corners = picture.corners().map(|corner| corner * scale - DVec2::new(0.0, f64::from(top)));
    let low = corners.into_iter().fold(DVec2::INFINITY, DVec2::min).floor().max(DVec2::ZERO);
    let size = DVec2::new(f64::from(pixmap.width()), f64::from(pixmap.height()));
    let high = corners.into_iter().fold(DVec2::NEG_INFINITY, DVec2::max).ceil().min(size);
    let room = high - low;
    let Some(sampler) = Sampler::new(picture, scale) else { return };
    if !(room.min_element() >= 1.0 && picture.pixels.width() > 0 && picture.pixels.height() > 0) {
        return;
    }
    let Some(mut layer) = Pixmap::new(room.x as u32, room.y as u32) else { return };
    let width = layer.width() as usize;
    for (n, pixel) in layer.data_mut().chunks_exact_mut(4).enumerate() {
        let at = low + DVec2::new((n % width) as f64 + 0.5, (n / width) as f64 + 0.5);
        pixel.copy_from_slice(&sampler.at(at + DVec2::new(0.0, f64::from(top))));
    }
    let mut area = PathBuilder::new();
    for (n, corner) in corners.iter().enumerate() {
        let (x, y) = (snapped(corner.x), snapped(corner.y));
        if n == 0 { area.move_to(x, y) } else { area.line_to(x, y) }
    }
    area.close();
    let Some(area) = area.finish() else { return };
    let shift = Transform::from_translate(low.x as f32, low.y as f32);
    let shader = Pattern::new(layer.as_ref(), SpreadMode::Pad, FilterQuality::Nearest, 1.0, shift);
    let paint = Paint { shader, anti_alias: true, ..Paint::default() };
    pixmap.fill_path(&area, &paint, FillRule::Winding, Transform::identity(), mask);
}

/// A place on the pixel grid that is meant to lie on it: rounding alone makes no half-covered edge.
fn snapped(x: f64) -> f32 {
    let near = x.round();
    (if (x - near).abs() < 1e-3 { near } else { x }) as f32
}

/// The image seen from the page.
struct Sampler<'a> {
    picture: &'a Picture,
    /// From pixels of the page to pixels of the image.
    image_from_page: DMat2,
    corner: DVec2,
    /// Samples along each axis that a pixel of the page is averaged from.
    samples: [usize; 2],
}

impl<'a> Sampler<'a> {
    fn new(picture: &'a Picture, scale: f64) -> Option<Self> {
        let size = DVec2::new(f64::from(picture.pixels.width()), f64::from(picture.pixels.height()));
        let page_from_image = DMat2::from_cols(picture.right * scale / size.x, picture.down * scale / size.y);
        let area = page_from_image.determinant().abs();
        if area.is_nan() || area <= 1e-12 {
            return None;
        }
        let image_from_page = page_from_image.inverse();
        let step = [image_from_page.x_axis.length(), image_from_page.y_axis.length()];
        let samples = match picture.sampling {
            Sampling::Smooth => step.map(|step| if step > 1.2 { step.ceil().min(MOST_SAMPLES) as usize } else { 1 }),
            Sampling::Nearest => [1; 2],
        };
        Some(Self { picture, image_from_page, corner: picture.corner * scale, samples })
    }

    /// Premultiplied colour of a pixel of the page, given its middle.
    fn at(&self, middle: DVec2) -> [u8; 4] {
        let mut sum = [0.0; 4];
        let [across, down] = self.samples;
        for n in 0..across * down {
            let share =
                DVec2::new(((n % across) as f64 + 0.5) / across as f64, ((n / across) as f64 + 0.5) / down as f64);
            let at = self.image_from_page * (middle + share - 0.5 - self.corner);
            let found = match self.picture.sampling {
                Sampling::Nearest => self.pixel(at.floor()),
                Sampling::Smooth => self.between(at - 0.5),
            };
            (0..4).for_each(|channel| sum[channel] += found[channel]);
        }
        sum.map(|channel| (channel / (across * down) as f64 + 0.5) as u8)
    }

    /// Between four pixels; `at` counts from the middle of the first.
    fn between(&self, at: DVec2) -> [f64; 4] {
        let low = at.floor();
        let share = at - low;
        // Rounding alone leaves a pixel of the page on a pixel of the image what it is.
        let share = DVec2::select((share - share.round()).abs().cmplt(DVec2::splat(1e-6)), share.round(), share);
        let rows = [0.0, 1.0].map(|dy| [0.0, 1.0].map(|dx| self.pixel(low + DVec2::new(dx, dy))));
        [0, 1, 2, 3].map(|channel| {
            let row = rows.map(|row| row[0][channel] + (row[1][channel] - row[0][channel]) * share.x);
            row[0] + (row[1] - row[0]) * share.y
        })
    }

    /// Premultiplied; the edge goes on beyond it.
    fn pixel(&self, at: DVec2) -> [f64; 4] {
        let image = &self.picture.pixels;
        let x = at.x.clamp(0.0, f64::from(image.width() - 1)) as u32;
        let y = at.y.clamp(0.0, f64::from(image.height() - 1)) as u32;
        let [r, g, b, a] = image.get_pixel(x, y).0.map(f64::from);
        [r * a / 255.0, g * a / 255.0, b * a / 255.0, a]
    }
}
