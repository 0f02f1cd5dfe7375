//! A page as pixels, at any resolution.
//!
//! Items are prepared once in pixels of the whole page and then painted in bands of rows, which threads
//! share; bands have the same height whatever the number of threads, so the bytes are the same. Paths are
//! filled and stroked by `tiny-skia`, anti-aliased; letters are covered exactly (`ab_glyph_rasterizer`);
//! images are averaged where they are made smaller. Everything is composited on sRGB-encoded values.

mod glyphs;
mod paths;
mod pictures;
mod png;
#[cfg(test)]
mod tests;
mod tiff;

pub use self::png::png;
pub(crate) use self::png::{APNG, PNG};
pub(crate) use tiff::TIFF;
pub use tiff::tiff;

use crate::Rect;
use crate::error::PageError;
use crate::list::{DisplayList, Group, Item, POINTS_PER_INCH, Picture};
use glyphs::Lettering;
use image::RgbaImage;
use rayon::prelude::*;
use tiny_skia::{FillRule, Mask, Paint, Pixmap, PixmapMut, Stroke, Transform};

/// Rows that are painted at a time.
const BAND: usize = 128;
/// Rows above and below them that are painted as well and left out: lines thinner than a pixel leave specks where they cross
/// the first row of a picture of `tiny-skia`.
const BESIDE: usize = 2;
/// Places on the page nearer than this are one, points.
const ON_PAGE_PT: f64 = 1e-6;
/// Longest side of a page, pixels.
pub(crate) const MOST_SIDE_PX: u32 = 32_768;

/// Draws a page at a resolution, dots an inch.
///
/// The picture is `size · dpi / 72` pixels wide and high, rounded. Straight alpha; a page without paper is
/// transparent where nothing is drawn.
///
/// # Errors
/// [`PageError::PageSize`] where that is nothing or more than `MOST_SIDE_PX`.
pub fn raster(list: &DisplayList, dpi: f64) -> Result<RgbaImage, PageError> {
    let scale = dpi / POINTS_PER_INCH;
    let [width, height] = size_px(list, dpi)?;
    if let Some(picture) = lone(list, [width, height]) {
        return Ok(picture.clone());
    }
    let mut page = Prepared { ops: Vec::new(), clips: Vec::new(), scale };
    list.faces.scope(|| list.items.iter().for_each(|item| page.add(item, None)));
    let paper = list.paper.map(paths::colour);
    let mut image = RgbaImage::new(width, height);
    let stride = width as usize * 4;
    image.par_chunks_mut(stride * BAND).enumerate().for_each(|(n, rows)| {
        let height = (rows.len() / stride + 2 * BESIDE) as u32;
        let Some(mut pixmap) = Pixmap::new(width, height) else { return };
        let top = (n * BAND) as f32 - BESIDE as f32;
        let mut band = Band { pixmap: pixmap.as_mut(), top, masks: vec![None; page.clips.len()] };
        if let Some(paper) = paper {
            band.pixmap.fill(paper);
        }
        page.ops.iter().for_each(|op| band.paint(op, &page));
        rows.copy_from_slice(&pixmap.data()[stride * BESIDE..][..rows.len()]);
        rows.chunks_exact_mut(4).for_each(straighten);
    });
    Ok(image)
}

/// The size that [`raster`] draws a page in.
///
/// # Errors
/// As [`raster`].
pub fn size_px(list: &DisplayList, dpi: f64) -> Result<[u32; 2], PageError> {
    let size = (list.size * dpi / POINTS_PER_INCH).round();
    let most = f64::from(MOST_SIDE_PX);
    if !(size.min_element() >= 1.0 && size.max_element() <= most) {
        return Err(PageError::PageSize { size_px: size.to_array(), most: MOST_SIDE_PX });
    }
    Ok([size.x as u32, size.y as u32])
}

/// The picture that a page holds and nothing else, if it fills the page pixel by pixel: its own bytes are kept, also where
/// it is half transparent.
fn lone(list: &DisplayList, size_px: [u32; 2]) -> Option<&RgbaImage> {
    let bounds = list.bounds();
    let is_all = |rect: Rect| {
        (rect.min - bounds.min).abs().max_element().max((rect.max - bounds.max).abs().max_element()) < ON_PAGE_PT
    };
    let mut items = &list.items;
    let picture = loop {
        match &items[..] {
            [Item::Group(group)] if group.clip.as_ref().is_none_or(|clip| clip.as_rect().is_some_and(is_all)) => {
                items = &group.items;
            }
            [Item::Picture(picture)] => break picture,
            _ => return None,
        }
    };
    let [a, _, c, _] = picture.corners();
    let is_own = is_all(Rect::new(a, c)) && [picture.pixels.width(), picture.pixels.height()] == size_px;
    let is_seen = || list.paper.is_none() || picture.pixels.pixels().all(|pixel| pixel.0[3] == u8::MAX);
    (is_own && is_seen()).then_some(&*picture.pixels)
}

/// From premultiplied to straight alpha.
fn straighten(pixel: &mut [u8]) {
    let alpha = u32::from(pixel[3]);
    if alpha == 255 || alpha == 0 {
        return;
    }
    for channel in &mut pixel[..3] {
        *channel = ((u32::from(*channel) * 255 + alpha / 2) / alpha).min(255) as u8;
    }
}

/// What is painted, in pixels of the whole page.
struct Prepared<'a> {
    ops: Vec<Op<'a>>,
    clips: Vec<Clip>,
    scale: f64,
}

/// A clip, within another one if it has one.
struct Clip {
    path: tiny_skia::Path,
    parent: Option<usize>,
}

/// Something to paint.
struct Op<'a> {
    what: What<'a>,
    /// First and last row that it may touch.
    rows: [f32; 2],
    clip: Option<usize>,
}

enum What<'a> {
    Fill(tiny_skia::Path, FillRule, Paint<'static>),
    Stroke(tiny_skia::Path, Stroke, Paint<'static>),
    Picture(&'a Picture),
    Letters(Lettering),
}

impl<'a> Prepared<'a> {
    fn add(&mut self, item: &'a Item, clip: Option<usize>) {
        match item {
            Item::Group(group) => self.add_group(group, clip),
            Item::Path(path) => {
                let Some(traced) = paths::trace(&path.path, self.scale) else { return };
                let bounds = traced.bounds();
                if let Some(ink) = path.fill {
                    let what = What::Fill(traced.clone(), paths::rule(path.rule), paths::paint(ink));
                    self.ops.push(Op { what, rows: [bounds.top(), bounds.bottom()], clip });
                }
                if let Some(stroke) = &path.stroke
                    && let Some((drawn, ink)) = paths::stroke(stroke, self.scale)
                {
                    let reach = drawn.width + 1.0;
                    let rows = [bounds.top() - reach, bounds.bottom() + reach];
                    self.ops.push(Op { what: What::Stroke(traced, drawn, ink), rows, clip });
                }
            }
            Item::Picture(picture) => {
                let rows = picture.corners().map(|corner| (corner.y * self.scale) as f32);
                let rows = [rows.into_iter().fold(f32::MAX, f32::min), rows.into_iter().fold(f32::MIN, f32::max)];
                self.ops.push(Op { what: What::Picture(picture), rows, clip });
            }
            Item::Text(text) => {
                let bounds = text.bounds();
                let rows = [bounds.min.y, bounds.max.y].map(|y| (y * self.scale) as f32);
                let rows = [rows[0] - 1.0, rows[1] + 1.0];
                if let Some((rim, stroke, ink)) = glyphs::halo(text, self.scale) {
                    self.ops.push(Op { what: What::Stroke(rim, stroke, ink), rows, clip });
                }
                self.ops.push(Op { what: What::Letters(Lettering::of(text, self.scale)), rows, clip });
            }
        }
    }

    fn add_group(&mut self, group: &'a Group, clip: Option<usize>) {
        let own = group.clip.as_ref().map(|path| paths::trace(path, self.scale));
        let clip = match own {
            None => clip,
            // An empty clip hides everything.
            Some(None) => return,
            Some(Some(path)) => {
                self.clips.push(Clip { path, parent: clip });
                Some(self.clips.len() - 1)
            }
        };
        for item in &group.items {
            self.add(item, clip);
        }
    }
}

/// Some rows of the page; premultiplied.
struct Band<'a> {
    pixmap: PixmapMut<'a>,
    top: f32,
    masks: Vec<Option<Mask>>,
}

impl Band<'_> {
    fn paint(&mut self, op: &Op, page: &Prepared) {
        if op.rows[1] < self.top || op.rows[0] > self.top + self.pixmap.height() as f32 {
            return;
        }
        if let Some(clip) = op.clip {
            self.mask(clip, page);
        }
        let mask = op.clip.and_then(|clip| self.masks[clip].as_ref());
        let shift = Transform::from_translate(0.0, -self.top);
        match &op.what {
            What::Fill(path, rule, paint) => self.pixmap.fill_path(path, paint, *rule, shift, mask),
            What::Stroke(path, stroke, paint) => self.pixmap.stroke_path(path, paint, stroke, shift, mask),
            What::Picture(picture) => pictures::paint(&mut self.pixmap, picture, page.scale, self.top, mask),
            What::Letters(letters) => letters.paint(&mut self.pixmap, self.top, mask),
        }
    }

    /// Makes the mask of a clip and of all it lies in.
    fn mask(&mut self, clip: usize, page: &Prepared) {
        if self.masks[clip].is_some() {
            return;
        }
        let Clip { path, parent } = &page.clips[clip];
        let shift = Transform::from_translate(0.0, -self.top);
        let mask = match parent {
            Some(parent) => {
                self.mask(*parent, page);
                self.masks[*parent].clone().map(|mut mask| {
                    mask.intersect_path(path, FillRule::Winding, true, shift);
                    mask
                })
            }
            None => Mask::new(self.pixmap.width(), self.pixmap.height()).map(|mut mask| {
                mask.fill_path(path, FillRule::Winding, true, shift);
                mask
            }),
        };
        self.masks[clip] = mask;
    }
}
