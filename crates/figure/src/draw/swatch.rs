//! A piece of a layer as it is drawn: colour and pattern, for legends and wells ([`shown`]) and lists ([`draw`]).

use glam::DVec2;
use image::{Rgba, RgbaImage};
use page::list::{
    Cap, Group, GroupKind, Ink, Item, POINTS_PER_INCH, POINTS_PER_MM, Path, PathItem, Picture, Rule, Segment, Stroke,
};
use page::{DisplayList, Rect};
use ttf::drawing::{TileDrawing, TilePaint, TileSegment, TileShape, bounds};
use ttf::{Colour, LayerStyle, TextureLibrary};

/// Where a swatch's sides show what they cut, from and to this far within them, points; the frame lies over what is nearer.
const EDGE_PT: [f64; 2] = [0.25, 1.75];
/// Dashes and dots of which less than this share would be seen are left out, unless they are longer than the second share of a
/// tile: a line goes on in the next tile.
const LEAST_SHOWN: f64 = 0.4;
const LONG: f64 = 0.5;
/// Pixels a point at which that is looked at.
const EDGE_PX_PER_PT: f64 = 4.0;

/// Tiles that are printed smaller than this have no lines of their own, points.
const LEAST_TILE_PT: f64 = 2.0;

/// A layer's style over a rectangle as paths, its base at the lower edge; tiles have their printed size. `None` where a
/// pattern has no drawing.
///
/// # Errors
/// A pattern that the library does not have, or a drawing that cannot be read.
pub fn items(style: &LayerStyle, library: &TextureLibrary, rect: Rect) -> Result<Option<Vec<Item>>, ttf::TtfError> {
    tiled_from(style, library, rect, 0.0, |_, _, _| DVec2::new(rect.min.x, rect.max.y))
}

/// The same with the corner of a tile where `origin` says for a tile's drawing, its size and the band that it fills, and
/// without what is cut off to less than a share of it.
fn tiled_from(
    style: &LayerStyle,
    library: &TextureLibrary,
    rect: Rect,
    least_shown: f64,
    origin: impl Fn(&TileDrawing, DVec2, Rect) -> DVec2,
) -> Result<Option<Vec<Item>>, ttf::TtfError> {
    let mut items: Vec<Item> = vec![PathItem::filled(Path::rect(rect), style.colour).into()];
    for interval in &style.intervals {
        let index = library.index_of(&interval.texture, &format!("layer `{}`", style.layer))?;
        let tile_pt = library.pattern(index).tile_mm.map(|side| f64::from(side) * POINTS_PER_MM);
        let drawing = library.drawing(index)?.filter(|_| tile_pt.iter().all(|side| *side >= LEAST_TILE_PT));
        let Some(drawing) = drawing else { return Ok(None) };
        let [low, high] = interval.k.map(|k| rect.max.y - f64::from(k) * rect.height());
        let band = Rect::new(DVec2::new(rect.min.x, high), DVec2::new(rect.max.x, low));
        let ground = interval.colour.map(|colour| PathItem::filled(Path::rect(band), colour).into());
        let tile_pt = DVec2::from_array(tile_pt);
        let origin = origin(&drawing, tile_pt, band);
        let tiles = Tiles { drawing: &drawing, tile_pt, origin, least_shown };
        let pattern = tiles.over(band, style.ink, interval.opacity);
        let group = Group::new(GroupKind::Part, "pattern").clipped(Path::rect(band));
        items.push(group.with(ground.into_iter().chain(pattern)).into());
    }
    Ok(Some(items))
}

/// A layer's style over a rectangle, as paths where its patterns have drawings and as an image at `dpi` where not. Paths
/// lie so that the rectangle's sides cut off as little as can be.
///
/// # Errors
/// A pattern that does not draw.
pub fn shown(style: &LayerStyle, library: &TextureLibrary, rect: Rect, dpi: f64) -> Result<Vec<Item>, ttf::TtfError> {
    if let Some(items) = tiled_from(style, library, rect, LEAST_SHOWN, least_cut)? {
        return Ok(items);
    }
    let px_per_pt = dpi / POINTS_PER_INCH;
    let size_px = [rect.width(), rect.height()].map(|side| (side * px_per_pt).round().max(2.0) as u32);
    let drawn = draw(style, library, size_px, (px_per_pt * POINTS_PER_MM) as f32)?;
    Ok(vec![Picture::in_rect(drawn, rect).into()])
}

/// A tile repeated from an origin to the right and upwards.
struct Tiles<'a> {
    drawing: &'a TileDrawing,
    tile_pt: DVec2,
    origin: DVec2,
    /// Dashes and dots are left out of which less than this share would be seen.
    least_shown: f64,
}

impl Tiles<'_> {
    /// What lies over a band: an item for each shape of the tile.
    fn over(&self, band: Rect, ink: Option<Colour>, opacity: f32) -> Vec<Item> {
        self.drawing.shapes.iter().map(|shape| self.copies(shape, band, ink, opacity)).collect()
    }

    fn copies(&self, shape: &TileShape, band: Rect, ink: Option<Colour>, opacity: f32) -> Item {
        let place = |[u, v]: [f64; 2]| self.origin + DVec2::new(u, -v) * self.tile_pt;
        let reach = match &shape.paint {
            TilePaint::Line { width, .. } => 0.5 * width,
            TilePaint::Area { .. } => 0.0,
        };
        // In tiles, from the left and upwards.
        let within = [
            DVec2::new(band.min.x - self.origin.x, self.origin.y - band.max.y) / self.tile_pt,
            DVec2::new(band.max.x - self.origin.x, self.origin.y - band.min.y) / self.tile_pt,
        ];
        let mut path = Path::default();
        for line in shape.lines() {
            let [low, high] = bounds(line).map(DVec2::from_array);
            let (low, high) = (low - reach, high + reach);
            // Copies that touch the band, from tile to tile.
            let (first, last) = (within[0] - high, within[1] - low);
            for n in first.y.ceil() as i64..=last.y.floor() as i64 {
                for m in first.x.ceil() as i64..=last.x.floor() as i64 {
                    let by = DVec2::new(m as f64, n as f64);
                    let seen = ((high + by).min(within[1]) - (low + by).max(within[0])) / (high - low);
                    let is_cut = seen.cmplt(DVec2::splat(self.least_shown)) & (high - low).cmplt(DVec2::splat(LONG));
                    if is_cut.any() {
                        continue;
                    }
                    let at = |p: [f64; 2]| place((DVec2::from_array(p) + by).to_array());
                    path.segments.extend(line.iter().map(|segment| match *segment {
                        TileSegment::Move(p) => Segment::Move(at(p)),
                        TileSegment::Line(p) => Segment::Line(at(p)),
                        TileSegment::Cubic(a, b, p) => Segment::Cubic(at(a), at(b), at(p)),
                        TileSegment::Close => Segment::Close,
                    }));
                }
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
                let dashes = dashes.iter().map(|dash| dash * self.tile_pt.x).collect();
                let cap = if *round { Cap::Round } else { Cap::Butt };
                PathItem::stroked(path, Stroke { dashes, cap, ..Stroke::new(width * self.tile_pt.x, ink) })
            }
        };
        Item::from(drawn)
    }
}

/// Where the corner of a tile lies so that the least ink is just within a band's sides: dashes that are cut there look like
/// specks, and lines along them like a heavier frame. All places of the tile are tried, in steps of half a point.
fn least_cut(drawing: &TileDrawing, tile_pt: DVec2, band: Rect) -> DVec2 {
    let corner = DVec2::new(band.min.x, band.max.y);
    let tile = Rect::sized(DVec2::ZERO, tile_pt);
    let mut page = DisplayList::new(tile.size());
    let tiles = Tiles { drawing, tile_pt, origin: DVec2::new(0.0, tile_pt.y), least_shown: 0.0 };
    page.items = tiles.over(tile, Some(Colour::BLACK), 1.0);
    let Ok(inked) = page::raster(&page, EDGE_PX_PER_PT * POINTS_PER_INCH) else { return corner };
    let (width, height) = (inked.width() as i64, inked.height() as i64);
    let px = |pt: f64| (pt * EDGE_PX_PER_PT).round() as i64;
    let (columns, rows) = (px(band.width()), px(band.height()));
    let edge = px(EDGE_PT[0])..px(EDGE_PT[1]);
    let dark = |x: i64, y: i64| 255 - u64::from(inked.get_pixel(x as u32, y as u32).0[0]);
    let along_rows: Vec<_> = (0..height).map(|y| RunningSum::of((0..width).map(|x| dark(x, y)))).collect();
    let along_columns: Vec<_> = (0..width).map(|x| RunningSum::of((0..height).map(|y| dark(x, y)))).collect();
    // Of the pixels just within the four sides.
    let ink = |(right, down): (i64, i64)| -> u64 {
        let [left, top] = [(-right).rem_euclid(width), (height - rows - down).rem_euclid(height)];
        let row = |y: i64| along_rows[(top + y).rem_euclid(height) as usize].cyclic(left, columns);
        let column = |x: i64| along_columns[(left + x).rem_euclid(width) as usize].cyclic(top, rows);
        edge.clone().map(|n| row(n) + row(rows - 1 - n) + column(n) + column(columns - 1 - n)).sum()
    };
    let step = px(0.5).max(1) as usize;
    let places = (0..height).step_by(step).flat_map(|down| (0..width).step_by(step).map(move |right| (right, down)));
    let (right, down) = places.min_by_key(|place| ink(*place)).unwrap_or_default();
    corner + DVec2::new(right as f64, down as f64) / EDGE_PX_PER_PT
}

/// The sums of the first values of a list, from none of them to all.
struct RunningSum(Vec<u64>);

impl RunningSum {
    fn of(values: impl Iterator<Item = u64>) -> Self {
        let mut sums = vec![0];
        sums.extend(values.scan(0, |sum, value| {
            *sum += value;
            Some(*sum)
        }));
        Self(sums)
    }

    /// The sum of `count` values from `first` on, where the list begins anew behind its end.
    fn cyclic(&self, first: i64, count: i64) -> u64 {
        let (values, first) = (self.0.len() - 1, first as usize);
        let (laps, rest) = (count as usize / values, count as usize % values);
        let (all, last) = (self.0[values], first + rest);
        let part = match last.checked_sub(values) {
            None => self.0[last] - self.0[first],
            Some(over) => all - self.0[first] + self.0[over],
        };
        laps as u64 * all + part
    }
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

    #[test]
    fn a_sum_round_a_list_is_that_of_its_values() {
        let values = [7, 0, 255, 31, 4];
        let sums = RunningSum::of(values.into_iter());
        for first in 0..values.len() {
            for count in 0..17 {
                let expected: u64 = (first..first + count).map(|n| values[n % values.len()]).sum();
                assert_eq!(sums.cyclic(first as i64, count as i64), expected, "{count} from {first}");
            }
        }
    }

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

    /// Dashes, dots and beds end within a legend's swatch or go through its frame; no scraps of them lie along it.
    #[test]
    fn sides_of_a_swatch_cut_off_little() {
        let library = TextureLibrary::builtin().unwrap();
        let rect = Rect::sized(DVec2::ZERO, DVec2::new(30.0, 17.0));
        let ink = |items: Vec<Item>| {
            let mut page = DisplayList::new(rect.size());
            page.items = items;
            let drawn = page::raster(&page, 288.0).unwrap();
            let rows = (1..7).chain(61..67).flat_map(|y| (0..120).map(move |x| (x, y)));
            rows.map(|(x, y)| 255.0 - f64::from(drawn.get_pixel(x, y).0[0])).sum::<f64>() / 255.0
        };
        let black_on_white =
            |name: &str| LayerStyle { ink: Some(Colour::BLACK), ..LayerStyle::textured("a", Colour::WHITE, name) };
        let (mut before, mut after) = (0.0, 0.0);
        for name in ["shale", "marl", "limestone", "sandstone-bedded", "siltstone", "shale-sandy"] {
            let style = black_on_white(name);
            let [from_corner, placed] = [
                ink(items(&style, &library, rect).unwrap().unwrap()),
                ink(shown(&style, &library, rect, 288.0).unwrap()),
            ];
            assert!(placed <= from_corner + 12.0, "{name}: {placed} of {from_corner} pixels of ink");
            (before, after) = (before + from_corner, after + placed);
        }
        assert!(after < 0.5 * before, "{after} of {before}");
        // The tile's height leaves no row of beds without ink, but dashes lie clear of the upper and the lower side.
        assert!(ink(shown(&black_on_white("marl"), &library, rect, 288.0).unwrap()) < 100.0);
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
