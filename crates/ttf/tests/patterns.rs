//! The pattern library as a whole: every catalogue entry has a drawing, is seamless, and differs from the
//! others.

use std::path::Path;

use resvg::{tiny_skia, usvg};
use ttf::TextureLibrary;

/// Pixels of a tile in these tests.
const SIDE: u32 = 256;

fn parse(svg: &str) -> usvg::Tree {
    usvg::Tree::from_str(svg, &usvg::Options::default()).expect("the drawing parses")
}

/// Alpha of two drawings of the same SIDE × SIDE window, which is centred on a corner of the tile. The first
/// is cut from the repeated tile; the second is drawn from the geometry at nine places, without cutting.
fn tiled_and_uncut(svg: &str) -> (Vec<u8>, Vec<u8>) {
    let tree = parse(svg);
    let scale = SIDE as f32 / tree.size().width();
    let mut tile = tiny_skia::Pixmap::new(SIDE, SIDE).unwrap();
    resvg::render(&tree, tiny_skia::Transform::from_scale(scale, scale), &mut tile.as_mut());
    // usvg clips a drawing at its view box; a view box of nine tiles shows what lies beyond. usvg counts in
    // pixels of 1/96 inch, the drawings in points of 1/72.
    let side = (tree.size().width() * 0.75).round();
    let frame = format!("viewBox=\"0 0 {side} {side}\"");
    let size = format!("width=\"{side}pt\" height=\"{side}pt\"");
    let wide_frame = format!("viewBox=\"{} {} {} {}\"", -side, -side, 3.0 * side, 3.0 * side);
    let wide_size = format!("width=\"{0}pt\" height=\"{0}pt\"", 3.0 * side);
    assert!(svg.contains(&frame) && svg.contains(&size), "unexpected frame");
    let uncut_tree = parse(&svg.replace(&frame, &wide_frame).replace(&size, &wide_size));
    let half = SIDE as f32 / 2.0;
    let mut uncut = tiny_skia::Pixmap::new(SIDE, SIDE).unwrap();
    let uncut_scale = 3.0 * SIDE as f32 / uncut_tree.size().width();
    for step in 0..9 {
        let shift = |index: i32| (index - 2) as f32 * SIDE as f32 + half;
        let place =
            tiny_skia::Transform::from_scale(uncut_scale, uncut_scale).post_translate(shift(step % 3), shift(step / 3));
        resvg::render(&uncut_tree, place, &mut uncut.as_mut());
    }
    let pixel = |x: u32, y: u32| tile.pixel((x + SIDE / 2) % SIDE, (y + SIDE / 2) % SIDE).unwrap().alpha();
    let tiled = (0..SIDE * SIDE).map(|index| pixel(index % SIDE, index / SIDE)).collect();
    (tiled, uncut.pixels().iter().map(|pixel| pixel.alpha()).collect())
}

/// Number of pixels that are solid ink in one drawing and empty in the other. Values in between do not count:
/// the second drawing overlays copies, which darkens the soft edges of strokes.
fn misfits(svg: &str) -> usize {
    let (tiled, uncut) = tiled_and_uncut(svg);
    let differ = |a: u8, b: u8| a >= 250 && b <= 20;
    tiled.iter().zip(&uncut).filter(|&(&a, &b)| differ(a, b) || differ(b, a)).count()
}

#[test]
fn every_pattern_is_seamless() {
    let library = TextureLibrary::builtin().unwrap();
    for index in 0..library.len() {
        let svg = library.svg(index).unwrap();
        let name = &library.pattern(index).name;
        assert_eq!(misfits(svg), 0, "{name} does not close over its edges");
    }
}

#[test]
fn the_seam_test_sees_a_piece_cut_off_at_an_edge() {
    let closed = r##"<svg xmlns="http://www.w3.org/2000/svg" width="60pt" height="60pt" viewBox="0 0 60 60">
        <circle cx="0" cy="30" r="5"/><circle cx="60" cy="30" r="5"/></svg>"##;
    assert_eq!(misfits(closed), 0);
    let cut = closed.replace(r#"<circle cx="60" cy="30" r="5"/>"#, "");
    assert!(misfits(&cut) > 20);
}

#[test]
fn every_drawing_is_in_the_catalogue_once_and_every_entry_makes_sense() {
    let library = TextureLibrary::builtin().unwrap();
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../textures");
    let files = std::fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path());
    let drawings = files.filter(|path| path.extension().is_some_and(|extension| extension == "svg"));
    let mut drawn: Vec<String> = drawings.map(|path| path.file_stem().unwrap().to_str().unwrap().to_owned()).collect();
    let mut named: Vec<String> = library.patterns().map(|pattern| pattern.name.clone()).collect();
    drawn.sort_unstable();
    named.sort_unstable();
    assert_eq!(drawn, named);
    let coded = library.patterns().filter(|pattern| pattern.fgdc.is_some()).count();
    assert!(coded >= 95, "{coded} patterns of the standard");
    let mut numbers: Vec<u16> = library.patterns().filter_map(|pattern| pattern.fgdc).collect();
    assert!(numbers.iter().all(|number| (601..=686).contains(number) || (701..=733).contains(number)));
    let all = numbers.len();
    numbers.sort_unstable();
    numbers.dedup();
    assert_eq!(numbers.len(), all, "an FGDC number is used twice");
    for (index, pattern) in library.patterns().enumerate() {
        let size = parse(library.svg(index).unwrap()).size();
        // usvg counts in pixels of 1/96 inch.
        for (drawn, stated) in [size.width(), size.height()].into_iter().zip(pattern.tile_mm) {
            assert!((drawn * 25.4 / 96.0 - stated).abs() < 0.01, "{}: {drawn}", pattern.name);
        }
        assert!(!pattern.title.is_empty() && pattern.description.ends_with('.'));
    }
}

#[test]
fn every_pattern_shows_its_layers_colour_and_no_two_are_alike() {
    let library = TextureLibrary::builtin().unwrap();
    let textures: Vec<_> = (0..library.len()).map(|index| library.texture(index).unwrap()).collect();
    for (index, texture) in textures.iter().enumerate() {
        let name = &library.pattern(index).name;
        let cover = texture.mean()[3];
        let expected = match name.as_str() {
            "plain" => 0.0..=0.0,
            "coal" => 0.85..=0.97,
            "coal-bony" => 0.6..=0.85,
            _ => 0.03..=0.45,
        };
        assert!(expected.contains(&cover), "{name} covers {cover}");
    }
    // Compared at 32 x 32: the mean difference of cover between any two.
    for first in 0..textures.len() {
        for second in first + 1..textures.len() {
            let (a, b) = (&textures[first].levels()[4], &textures[second].levels()[4]);
            let difference =
                a.iter().zip(b).map(|(a, b)| f32::from(a[3].abs_diff(b[3]))).sum::<f32>() / (255.0 * a.len() as f32);
            let names = [&library.pattern(first).name, &library.pattern(second).name];
            assert!(difference > 0.02, "{names:?}: {difference}");
        }
    }
}

#[test]
fn stipple_is_even() {
    // In a window of a third of the tile the cover stays near the mean: there are no clumps and no gaps.
    let library = TextureLibrary::builtin().unwrap();
    for name in ["sand", "granite", "gravel"] {
        let texture = library.texture(library.find(name).unwrap()).unwrap();
        let level = &texture.levels()[5];
        let (side, window) = (16_usize, 5_usize);
        let mean = texture.mean()[3];
        for corner in 0..side * side {
            let sum: f32 = (0..window * window)
                .map(|cell| {
                    let x = (corner % side + cell % window) % side;
                    let y = (corner / side + cell / window) % side;
                    f32::from(level[y * side + x][3]) / 255.0
                })
                .sum();
            let share = sum / (window * window) as f32 / mean;
            assert!((0.75..1.25).contains(&share), "{name}: {share} of the mean at {corner}");
        }
    }
}
