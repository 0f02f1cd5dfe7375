//! Pages whose pixels are known in closed form.

use super::*;
use crate::Rect;
use crate::list::{Across, GroupKind, Ink, Path, PathItem, Stroke, Text, Upright};
use glam::DVec2;
use image::Rgba;
use ttf::Colour;

fn page(items: impl IntoIterator<Item = Item>) -> DisplayList {
    let mut list = DisplayList::new(DVec2::new(72.0, 48.0));
    list.items.extend(items);
    list
}

/// Black on white, as an area in square points.
fn ink(list: &DisplayList, dpi: f64) -> f64 {
    let image = raster(list, dpi).unwrap();
    let covered: f64 = image.pixels().map(|pixel| 1.0 - f64::from(pixel.0[0]) / 255.0).sum();
    covered * (72.0 / dpi).powi(2)
}

#[test]
fn a_line_covers_its_width_times_its_length() {
    let from = DVec2::new(10.3, 8.7);
    for (turn, width) in [(0.0, 2.0), (0.0, 0.4), (0.37, 1.5), (1.1, 0.7), (0.37, 0.25)] {
        let to = from + 32.0 * DVec2::from_angle(turn);
        let line = PathItem::stroked(Path::line(&[from, to]), Stroke::new(width, Ink::BLACK));
        for dpi in [72.0, 300.0] {
            let found = ink(&page([line.clone().into()]), dpi) / 32.0;
            // Edges are placed to an eighth of a pixel, lines thinner than a pixel by their tone.
            let eighth = 0.125 * 72.0 / dpi;
            assert!((found - width).abs() < (0.03 * width).max(1.5 * eighth), "{width} at {turn}, {dpi} dpi: {found}");
        }
    }
}

/// The page is painted in bands of rows: a line that crosses from one to the next is the line that crosses none.
#[test]
fn thin_lines_pass_from_band_to_band_without_specks() {
    let drawn = |down: f64| {
        let mut list = DisplayList::new(DVec2::new(240.0, 240.0));
        for n in 0..12 {
            let from = DVec2::new(10.0, 100.3 + 3.7 * f64::from(n) - down);
            let line: Vec<DVec2> =
                (0..80).map(|m| from + DVec2::new(2.7, 0.11 * f64::from(n)) * f64::from(m)).collect();
            list.items.push(PathItem::stroked(Path::line(&line), Stroke::new(0.6, Ink::BLACK).round()).into());
        }
        raster(&list, 72.0).unwrap()
    };
    let (across, within) = (drawn(0.0), drawn(60.0));
    for (x, y) in (0..240).flat_map(|x| (120..136).map(move |y| (x, y))) {
        let [a, b] = [across.get_pixel(x, y).0[0], within.get_pixel(x, y - 60).0[0]];
        assert!(a.abs_diff(b) < 24, "{a} for {b} at {x}, {y}");
    }
}

#[test]
fn dashes_cover_their_share_and_dots_are_discs() {
    let line = Path::line(&[DVec2::new(6.0, 20.0), DVec2::new(66.0, 20.0)]);
    let dashed = PathItem::stroked(line.clone(), Stroke::new(2.0, Ink::BLACK).dashed(4.0, 2.0));
    assert!((ink(&page([dashed.into()]), 300.0) / 80.0 - 1.0).abs() < 0.02);
    let dotted = PathItem::stroked(line, Stroke::new(2.0, Ink::BLACK).dotted(6.0));
    // From 0 to 60 every 6 points: ten discs and perhaps the last.
    let discs = ink(&page([dotted.into()]), 300.0) / std::f64::consts::PI;
    assert!((9.5..11.3).contains(&discs), "{discs}");
}

#[test]
fn fills_follow_their_rule_and_opacity() {
    let rect = |low: f64, high: f64| Path::rect(Rect::new(DVec2::splat(low), DVec2::splat(high)));
    let mut ring = rect(4.0, 24.0);
    ring.segments.extend(rect(8.0, 20.0).segments);
    let filled = PathItem::filled(ring.clone(), Ink::BLACK);
    let holed = PathItem { rule: crate::list::Rule::EvenOdd, ..filled.clone() };
    assert!((ink(&page([filled.into()]), 72.0) - 400.0).abs() < 0.01);
    assert!((ink(&page([holed.into()]), 72.0) - 256.0).abs() < 0.01);
    let glass = PathItem::filled(rect(4.0, 24.0), Ink::glass(Colour::BLACK, 0.25));
    assert!((ink(&page([glass.into()]), 72.0) - 100.0).abs() < 1.0);
}

#[test]
fn nothing_is_drawn_outside_a_clip_or_the_clip_around_it() {
    let all = PathItem::filled(Path::rect(Rect::new(DVec2::ZERO, DVec2::new(72.0, 48.0))), Ink::BLACK);
    let outer = Rect::new(DVec2::new(10.0, 10.0), DVec2::new(40.0, 30.0));
    let inner = Rect::new(DVec2::new(30.0, 20.0), DVec2::new(60.0, 40.0));
    let group = |rect: Rect, item: Item| Group::new(GroupKind::Panel, "").clipped(Path::rect(rect)).with([item]);
    let clipped = page([group(outer, group(inner, all.into()).into()).into()]);
    let image = raster(&clipped, 72.0).unwrap();
    for (x, y, pixel) in image.enumerate_pixels() {
        let inside = (30..40).contains(&x) && (20..30).contains(&y);
        assert_eq!(pixel.0[0], if inside { 0 } else { 255 }, "{x} {y}");
    }
}

#[test]
fn pixels_of_an_image_are_exact() {
    let image = RgbaImage::from_fn(5, 4, |x, y| Rgba([50 * x as u8, 60 * y as u8, (7 * x + 11 * y) as u8, 255]));
    let corner = DVec2::new(9.0, 5.0);
    for (side, sampling_nearest) in [(6.0, true), (1.0, false), (1.0, true)] {
        let rect = Rect::sized(corner, side * DVec2::new(5.0, 4.0));
        let picture = Picture::in_rect(image.clone(), rect);
        let picture = if sampling_nearest { picture.nearest() } else { picture };
        let drawn = raster(&page([picture.into()]), 72.0).unwrap();
        for (x, y, pixel) in drawn.enumerate_pixels() {
            let at = (DVec2::new(f64::from(x), f64::from(y)) + 0.5 - corner) / side;
            let inside = at.min_element() >= 0.0 && at.x < 5.0 && at.y < 4.0;
            let expected = if inside { *image.get_pixel(at.x as u32, at.y as u32) } else { Rgba([255; 4]) };
            assert_eq!(*pixel, expected, "{x} {y} at {side}");
        }
    }
}

#[test]
fn an_image_made_smaller_is_averaged() {
    // A chequer of single pixels: any sample alone would be black or white.
    let chequer = RgbaImage::from_fn(96, 96, |x, y| {
        let tone = 255 * ((x + y) % 2) as u8;
        Rgba([tone, tone, tone, 255])
    });
    let small = Picture::in_rect(chequer, Rect::sized(DVec2::splat(8.0), DVec2::splat(24.0)));
    let drawn = raster(&page([small.into()]), 72.0).unwrap();
    for y in 10..30 {
        for x in 10..30 {
            assert!(drawn.get_pixel(x, y).0[0].abs_diff(128) < 6);
        }
    }
}

#[test]
fn text_takes_the_room_it_was_measured_at() {
    let at = DVec2::new(36.0, 24.0);
    let text = Text::new(at, "1200 ms").sized(9.0).anchored(Across::Middle, Upright::Middle).inked(Ink::BLACK);
    let expected = text.bounds();
    let drawn = raster(&page([text.clone().into()]), 300.0).unwrap();
    let dark = |pixel: &Rgba<u8>| pixel.0[0] < 128;
    let inked: Vec<DVec2> = drawn
        .enumerate_pixels()
        .filter(|(_, _, pixel)| dark(pixel))
        .map(|(x, y, _)| DVec2::new(f64::from(x), f64::from(y)) * 72.0 / 300.0)
        .collect();
    assert!(inked.iter().all(|place| expected.contains(*place)));
    let low = inked.iter().fold(DVec2::INFINITY, |low, place| low.min(*place));
    let high = inked.iter().fold(DVec2::NEG_INFINITY, |high, place| high.max(*place));
    // Side bearings are less than a point; figures are centred.
    assert!(expected.max.x - high.x < 1.2 && low.x - expected.min.x < 1.2, "{low} {high} {expected:?}");
    assert!((0.5 * (low.y + high.y) - at.y).abs() < 0.3, "{low} {high}");
    // Turned by a quarter it takes the same ink.
    let turned = page([text.clone().turned(90.0).into()]);
    assert!((ink(&turned, 300.0) / ink(&page([text.into()]), 300.0) - 1.0).abs() < 0.02);
}

#[test]
fn a_halo_lies_under_its_letters_and_around_them() {
    let black = PathItem::filled(Path::rect(Rect::new(DVec2::ZERO, DVec2::new(72.0, 48.0))), Ink::BLACK);
    let text = Text::new(DVec2::new(10.0, 30.0), "Iii").sized(12.0).inked(Ink::BLACK).haloed(1.5, Ink::WHITE);
    let drawn = raster(&page([black.into(), text.clone().into()]), 150.0).unwrap();
    let light: Vec<DVec2> = drawn
        .enumerate_pixels()
        .filter(|(_, _, pixel)| pixel.0[0] > 200)
        .map(|(x, y, _)| DVec2::new(f64::from(x), f64::from(y)) * 72.0 / 150.0)
        .collect();
    assert!(light.len() > 200);
    assert!(light.iter().all(|place| text.bounds().grown(0.5).contains(*place)));
}

#[test]
fn the_same_page_is_the_same_bytes_on_one_thread_and_four_and_sizes_are_printed_sizes() {
    let mut items: Vec<Item> = Vec::new();
    for n in 0..40 {
        let at = DVec2::new(36.0, 24.0) + 20.0 * DVec2::from_angle(f64::from(n));
        items.push(PathItem::stroked(Path::circle(at, 9.0), Stroke::new(0.6, Ink::glass(Colour::BLACK, 0.5))).into());
        items.push(Text::new(at, format!("{n}")).turned(7.0 * f64::from(n)).into());
    }
    let list = page(items);
    let on = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| raster(&list, 600.0).unwrap())
    };
    let one = on(1);
    assert_eq!(one.dimensions(), (600, 400));
    assert!(one == on(4));
    assert!(matches!(raster(&list, 0.1), Err(PageError::PageSize { .. })));
    assert!(matches!(raster(&list, f64::NAN), Err(PageError::PageSize { .. })));
    assert!(matches!(raster(&list, 1e6), Err(PageError::PageSize { .. })));
}

#[test]
fn a_page_without_paper_is_clear_where_nothing_is_drawn() {
    let mut list =
        page([
            PathItem::filled(Path::rect(Rect::sized(DVec2::ZERO, DVec2::splat(10.0))), Colour::new(200, 10, 20)).into()
        ]);
    list.paper = None;
    let image = raster(&list, 72.0).unwrap();
    assert_eq!((image.get_pixel(5, 5).0, image.get_pixel(20, 20).0), ([200, 10, 20, 255], [0; 4]));
}
