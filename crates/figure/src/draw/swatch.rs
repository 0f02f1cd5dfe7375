//! A piece of a layer as it is drawn: colour and pattern, for legends and wells ([`shown`]) and lists ([`draw`]).

use glam::DVec2;
use image::{Rgba, RgbaImage};
use page::Rect;
use page::list::{
    Cap, Group, GroupKind, Ink, Item, POINTS_PER_INCH, POINTS_PER_MM, Path, PathItem, Picture, Rule, Segment, Stroke,
};
use ttf::drawing::{TileDrawing, TilePaint, TileSegment, TileShape};
use ttf::{Colour, LayerStyle, TextureLibrary};

/// Tiles that are printed smaller than this have no lines of their own, points.
const LEAST_TILE_PT: f64 = 2.0;

/// A layer's style over a rectangle as paths, its base at the lower edge; tiles have their printed size. `None` where a
/// pattern has no drawing.
///
/// # Errors
/// A pattern that the library does not have, or a drawing that cannot be read.
pub fn items(style: &LayerStyle, library: &TextureLibrary, rect: Rect) -> Result<Option<Vec<Item>>, ttf::TtfError> {
    let mut items: Vec<Item> = vec![PathItem::filled(Path::rect(rect), style.colour).into()];
    for interval in &style.intervals {
        let index = library.index_of(&interval.texture, &format!("layer `{}`", style.layer))?;
        let tile_pt = library.pattern(index).tile_mm.map(|side| f64::from(side) * POINTS_PER_MM);
        let drawing = library.drawing(index)?.filter(|_| tile_pt.iter().all(|side| *side >= LEAST_TILE_PT));
        let Some(drawing) = drawing else { return Ok(None) };
        let [low, high] = interval.k.map(|k| rect.max.y - f64::from(k) * rect.height());
        let band = Rect::new(DVec2::new(rect.min.x, high), DVec2::new(rect.max.x, low));
        let ground = interval.colour.map(|colour| PathItem::filled(Path::rect(band), colour).into());
        let origin = DVec2::new(rect.min.x, rect.max.y);
        let pattern = tiled(&drawing, DVec2::from_array(tile_pt), origin, band, style.ink, interval.opacity);
        let group = Group::new(GroupKind::Part, "pattern").clipped(Path::rect(band));
        items.push(group.with(ground.into_iter().chain(pattern)).into());
    }
    Ok(Some(items))
}

/// A layer's style over a rectangle, as paths where its patterns have drawings and as an image at `dpi` where not.
///
/// # Errors
/// A pattern that does not draw.
pub fn shown(style: &LayerStyle, library: &TextureLibrary, rect: Rect, dpi: f64) -> Result<Vec<Item>, ttf::TtfError> {
    if let Some(items) = items(style, library, rect)? {
        return Ok(items);
    }
    let px_per_pt = dpi / POINTS_PER_INCH;
    let size_px = [rect.width(), rect.height()].map(|side| (side * px_per_pt).round().max(2.0) as u32);
    let drawn = draw(style, library, size_px, (px_per_pt * POINTS_PER_MM) as f32)?;
    Ok(vec![Picture::in_rect(drawn, rect).into()])
}

/// A tile over a band, repeated from an origin to the right and upwards: an item for each of its shapes.
fn tiled(
    drawing: &TileDrawing,
    tile_pt: DVec2,
    origin: DVec2,
    band: Rect,
    ink: Option<Colour>,
    opacity: f32,
) -> Vec<Item> {
    let item = |shape: &TileShape| {
        let place = |[u, v]: [f64; 2]| origin + DVec2::new(u, -v) * tile_pt;
        let reach = match &shape.paint {
            TilePaint::Line { width, .. } => 0.5 * width,
            TilePaint::Area { .. } => 0.0,
        };
        // Copies that touch the band, from tile to tile.
        let [low, high] = shape.bounds().map(DVec2::from_array);
        let first = DVec2::new(band.min.x - origin.x, origin.y - band.max.y) / tile_pt - high - reach;
        let last = DVec2::new(band.max.x - origin.x, origin.y - band.min.y) / tile_pt - low + reach;
        let mut path = Path::default();
        for n in first.y.ceil() as i64..=last.y.floor() as i64 {
            for m in first.x.ceil() as i64..=last.x.floor() as i64 {
                let at = |[u, v]: [f64; 2]| place([u + m as f64, v + n as f64]);
                path.segments.extend(shape.path.iter().map(|segment| match *segment {
                    TileSegment::Move(p) => Segment::Move(at(p)),
                    TileSegment::Line(p) => Segment::Line(at(p)),
                    TileSegment::Cubic(a, b, p) => Segment::Cubic(at(a), at(b), at(p)),
                    TileSegment::Close => Segment::Close,
                }));
            }
        }
        let colour = ink.unwrap_or_else(|| Colour::from_unit(shape.colour));
        let ink = Ink::glass(colour, shape.opacity * opacity);
        let drawn = match &shape.paint {
            TilePaint::Area { even_odd } => {
                let rule = if *even_odd { Rule::EvenOdd } else { Rule::NonZero };
                PathItem { rule, ..PathItem::filled(path, ink) }
            }
            TilePaint::Line { width, dashes, round } => {
                let dashes = dashes.iter().map(|dash| dash * tile_pt.x).collect();
                let cap = if *round { Cap::Round } else { Cap::Butt };
                PathItem::stroked(path, Stroke { dashes, cap, ..Stroke::new(width * tile_pt.x, ink) })
            }
        };
        Item::from(drawn)
    };
    drawing.shapes.iter().map(item).collect()
}

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
    let ink = style.ink.map(Colour::to_unit);
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
    use page::DisplayList;

    /// The same swatch as paths and as texels, in a lattice of blocks of pixels.
    #[test]
    fn paths_show_what_texels_show() {
        let library = TextureLibrary::builtin().unwrap();
        let rect = Rect::sized(DVec2::ZERO, DVec2::new(60.0, 36.0));
        for pattern in library.patterns() {
            let mut style = LayerStyle::textured("a", pattern.colour, &pattern.name);
            style.intervals[0].k = [0.25, 1.0];
            let mut page = DisplayList::new(rect.size());
            page.items = items(&style, &library, rect).unwrap().expect("a pattern with a drawing");
            let paths = page::raster(&page, 288.0).unwrap();
            let texels = draw(&style, &library, [240, 144], (4.0 * POINTS_PER_MM) as f32).unwrap();
            let mean = |image: &RgbaImage, left: u32, top: u32| {
                let pixels = (0..144).map(|n| f32::from(image.get_pixel(left + n % 12, top + n / 12).0[0]));
                pixels.sum::<f32>() / 144.0
            };
            let off = (0..20 * 12).map(|n| {
                let (left, top) = (n % 20 * 12, n / 20 * 12);
                (mean(&paths, left, top) - mean(&texels, left, top)).abs()
            });
            let off: Vec<f32> = off.collect();
            let mean_off = off.iter().sum::<f32>() / off.len() as f32;
            assert!(mean_off < 3.0, "{}: {mean_off} grey levels apart", pattern.name);
        }
    }

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
