//! Pages as PDF, taken apart again.

use super::*;
use crate::list::{Group, GroupKind, Halo, Ink, Path, PathItem, Picture, Stroke, Text};
use flate2::read::ZlibDecoder;
use glam::DVec2;
use image::{Rgba, RgbaImage};
use std::io::Read;
use std::sync::Arc;

/// The objects of a file by number: what is written of each before its stream, and its stream, inflated.
struct Objects(Vec<(String, Vec<u8>)>);

impl Objects {
    /// Reads a file by its table of places, which must lead to every object.
    fn of(file: &[u8]) -> Self {
        let find = |bytes: &[u8], what: &[u8]| bytes.windows(what.len()).position(|at| at == what);
        let rfind = |what: &[u8]| file.windows(what.len()).rposition(|at| at == what).unwrap();
        let number = |at: usize| {
            file[at..].iter().take_while(|b| b.is_ascii_digit()).fold(0, |n, b| 10 * n + usize::from(b - 48))
        };
        let table = number(rfind(b"startxref\n") + 10);
        let lines: Vec<&str> = std::str::from_utf8(&file[table..rfind(b"trailer")]).unwrap().lines().collect();
        assert_eq!(lines[0], "xref");
        let mut objects = Vec::new();
        for line in &lines[3..] {
            let object = &file[line[..10].parse::<usize>().unwrap()..];
            let end = find(object, b"endobj").unwrap();
            let text = |bytes: &[u8]| String::from_utf8_lossy(bytes).split_whitespace().collect::<Vec<_>>().join(" ");
            let stream = match find(&object[..end], b"stream\n") {
                None => (text(&object[..end]), Vec::new()),
                Some(begin) => {
                    let mut inflated = Vec::new();
                    ZlibDecoder::new(&object[begin + 7..]).read_to_end(&mut inflated).unwrap();
                    (text(&object[..begin]), inflated)
                }
            };
            objects.push(stream);
        }
        Self(objects)
    }

    fn text(&self, number: usize) -> &str {
        &self.0[number - 1].0
    }

    fn all_with(&self, what: &str) -> Vec<&(String, Vec<u8>)> {
        self.0.iter().filter(|(text, _)| text.contains(what)).collect()
    }

    /// The operators of the page.
    fn drawn(&self) -> String {
        String::from_utf8_lossy(&self.0[3].1).into_owned()
    }
}

fn square() -> PathItem {
    PathItem::filled(Path::circle(DVec2::splat(20.0), 10.0), Ink::BLACK)
}

#[test]
fn groups_are_layers_of_a_viewer_nested_as_on_the_page() {
    let mut page = DisplayList::new(DVec2::splat(50.0));
    let chalk = Group::new(GroupKind::Layer, "Chalk").with([square().into()]);
    let part = Group::new(GroupKind::Part, "pattern").clipped(Path::circle(DVec2::ONE, 9.0)).with([square().into()]);
    let marl = Group::new(GroupKind::Layer, "(Marl) \\ 白垩").with([part.into()]);
    let empty = Group::new(GroupKind::Fault, "nothing");
    let again = chalk.clone();
    let block = Group::new(GroupKind::Panel, "block").with([chalk.into(), marl.into(), again.into(), empty.into()]);
    let legend = Group::new(GroupKind::Annotation, "legend").with([square().into()]);
    page.items.extend([block.into(), legend.into()]);
    let objects = Objects::of(&pdf(&page, "t").unwrap());
    let groups = objects.all_with("/Type /OCG");
    assert_eq!(groups.len(), 4);
    assert!(groups[1].0.contains("/Name (Chalk)"), "{}", groups[1].0);
    // "(Marl) \ 白垩" in UTF-16.
    assert!(groups[2].0.contains("/Name <FEFF0028004D00610072006C00290020005C0020767D57A9>"), "{}", groups[2].0);
    // On top first; what is in a group follows it.
    let numbers: Vec<usize> =
        objects.0.iter().enumerate().filter(|(_, (text, _))| text.contains("/Type /OCG")).map(|(n, _)| n + 1).collect();
    let [block, chalk, marl, legend] = numbers[..] else { panic!("{numbers:?}") };
    let order = format!("/Order [{legend} 0 R {block} 0 R [{marl} 0 R {chalk} 0 R]]");
    assert!(objects.text(1).contains(&order), "{}", objects.text(1));
    let drawn = objects.drawn();
    assert_eq!([drawn.matches("BDC").count(), drawn.matches("EMC").count()], [5, 5]);
    // Both groups of one name are one layer.
    assert_eq!(drawn.matches("/OC /L1 BDC").count(), 2, "{drawn}");
    assert_eq!(drawn.matches("W\n").count(), 1);
}

/// MuPDF tells groups apart by what they say.
#[test]
fn layers_of_one_name_in_different_groups_are_told_apart() {
    let mut page = DisplayList::new(DVec2::splat(50.0));
    for outer in ["block", "legend"] {
        let chalk = Group::new(GroupKind::Layer, "Chalk").with([square().into()]);
        page.items.push(Group::new(GroupKind::Panel, outer).with([chalk.into()]).into());
    }
    let objects = Objects::of(&pdf(&page, "t").unwrap());
    let chalk = objects.all_with("/Name (Chalk)");
    let said = |n: usize| chalk[n].0.split_once(" obj ").unwrap().1;
    assert_eq!(chalk.len(), 2);
    assert_ne!(said(0), said(1));
}

#[test]
fn text_is_text_in_the_glyphs_that_it_needs() {
    let mut page = DisplayList::new(DVec2::splat(100.0));
    for name in ["A < B & (C) \\", "白垩", "الطباشير", "A\u{7}"] {
        page.items.push(Text::new(DVec2::splat(10.0), name).into());
    }
    page.items.push(Text::new(DVec2::splat(60.0), "A").turned(-90.0).haloed(1.0, Ink::WHITE).into());
    let objects = Objects::of(&pdf(&page, "t").unwrap());
    let mut streams = objects.0.iter().map(|(_, stream)| String::from_utf8_lossy(stream));
    let meanings = streams.rfind(|stream| stream.contains("begincmap")).unwrap();
    // Numbers in the order of characters: control characters have no meaning, the blank is 2.
    for (character, number) in [(' ', 2), ('&', 3), ('A', 7), ('白', 19)] {
        let line = format!("<{number:04X}> <{:04X}>", u32::from(character));
        assert!(meanings.contains(&line), "{line} in {meanings}");
    }
    assert!(!meanings.contains("<0001> "));
    let drawn = objects.drawn();
    assert_eq!(drawn.matches("Tj").count(), 5);
    // Read upwards; the rim is a path.
    assert!(drawn.contains("0 -1 -1 0 60 60 Tm"), "{drawn}");
    assert_eq!(drawn.matches("\nS\n").count(), 1);
    let [(_, font)] = objects.all_with("/Length1")[..] else { panic!("one font") };
    assert_eq!(font[..4], [0, 1, 0, 0]);
    let without = Objects::of(&pdf(&DisplayList::new(DVec2::splat(9.0)), "t").unwrap());
    assert!(without.all_with("/Font").is_empty());
}

#[test]
fn words_on_a_slope_are_read_as_words() {
    let spans = |text: &str, turn_deg: f64| {
        let mut page = DisplayList::new(DVec2::splat(100.0));
        page.items.push(Text { turn_deg, ..Text::new(DVec2::splat(50.0), text) }.into());
        Objects::of(&pdf(&page, "t").unwrap()).drawn().matches("/ActualText").count()
    };
    assert_eq!([0.0, 90.0, -90.0, 20.0].map(|turn_deg| spans("Crossline", turn_deg)), [0, 0, 0, 1]);
    // As it is written, and turned round for readers that turn it back.
    assert_eq!([0.0, 20.0].map(|turn_deg| spans("\u{627}\u{628}", turn_deg)), [2, 2]);
}

#[test]
fn readers_that_turn_letters_from_right_to_left_round_read_them_as_they_are_written() {
    // As poppler does: from each letter that runs from right to left up to the next that runs the other way.
    let turns = |text: &str| {
        let is_left = |c: &char| matches!(c, '\u{590}'..='\u{8ff}');
        let is_right = |c: &char| (c.is_alphanumeric() && !is_left(c)) || *c == '\u{200e}';
        let letters: Vec<char> = text.chars().collect();
        let (mut read, mut at) = (String::new(), 0);
        while at < letters.len() {
            let plain = letters[at..].iter().take_while(|c| !is_left(c)).count();
            read.extend(&letters[at..at + plain]);
            at += plain;
            let turned = letters[at..].iter().take_while(|c| !is_right(c)).count();
            read.extend(letters[at..at + turned].iter().rev());
            at += turned;
        }
        read.replace('\u{200e}', "")
    };
    for name in ["Marl", "", "אבן חול", "حجر جيري طباشيري", "طين Mb-2 أعلى", "F1, אב (ג) 45 m", "אב 12 גד", "אבן (חול)"]
    {
        let written = content::turned_round(name);
        // A closing bracket at the very end stays behind the letters.
        assert_eq!(turns(&written), name, "{written:?}");
        assert!(name == turns(name) || written != name);
    }
}

#[test]
fn letters_along_a_curve_are_set_one_by_one_and_read_as_a_word() {
    let mut page = DisplayList::new(DVec2::splat(100.0));
    let curve = [DVec2::new(0.0, 60.0), DVec2::new(50.0, 40.0), DVec2::new(100.0, 60.0)];
    page.items.push(Text::new(DVec2::ZERO, "Marl").along(&curve, 50.0).into());
    let drawn = Objects::of(&pdf(&page, "t").unwrap()).drawn();
    assert!(drawn.contains("/ActualText (Marl)"), "{drawn}");
    assert_eq!([drawn.matches(" Tm").count(), drawn.matches(" Tj").count()], [4, 4]);
    assert_eq!(drawn.matches("BDC").count(), drawn.matches("EMC").count());
}

#[test]
fn opacity_widths_and_dashes_hold_for_one_path() {
    let mut page = DisplayList { paper: None, ..DisplayList::new(DVec2::splat(50.0)) };
    let glass = PathItem { fill: Some(Ink::glass(ttf::Colour::BLACK, 0.25)), ..square() };
    let dots = PathItem::stroked(Path::line(&[DVec2::ZERO, DVec2::ONE]), Stroke::new(0.3, Ink::BLACK).dotted(2.0));
    page.items.extend([glass.into(), dots.into(), square().into()]);
    let objects = Objects::of(&pdf(&page, "t").unwrap());
    let drawn = objects.drawn();
    assert_eq!([drawn.matches("q\n").count(), drawn.matches("Q").count()], [2, 2], "{drawn}");
    assert!(drawn.contains("[0 2] 0 d") && drawn.contains("0.3 w") && drawn.contains("1 J"), "{drawn}");
    assert!(objects.text(3).contains("/ca 0.25 /CA 0.25"), "{}", objects.text(3));
}

#[test]
fn a_picture_is_written_once_and_keeps_its_transparency() {
    let mut page = DisplayList::new(DVec2::new(60.0, 40.0));
    let pixels = Arc::new(RgbaImage::from_fn(3, 2, |x, y| Rgba([x as u8 * 40, y as u8 * 90, 7, 255 - 100 * x as u8])));
    let place = crate::Rect::new(DVec2::new(10.0, 5.0), DVec2::new(40.0, 25.0));
    for _ in 0..2 {
        page.items.push(Picture::in_rect(Arc::clone(&pixels), place).into());
    }
    let objects = Objects::of(&pdf(&page, "t").unwrap());
    // The first row at the upper edge: the unit square's lower left corner is the picture's.
    assert_eq!(objects.drawn().matches("30 0 0 -20 10 25 cm").count(), 2, "{}", objects.drawn());
    let images = objects.all_with("/Subtype /Image");
    assert_eq!(images.len(), 2);
    let unfiltered = |(text, rows): &(String, Vec<u8>), channels: usize| -> Vec<u8> {
        assert!(text.contains("/Predictor 15"), "{text}");
        let mut pixels: Vec<u8> = Vec::new();
        let width = 3 * channels;
        for (n, row) in rows.chunks_exact(width + 1).enumerate() {
            for at in 0..width {
                let left = if at < channels { 0 } else { pixels[n * width + at - channels] };
                let above = if n == 0 { 0 } else { pixels[(n - 1) * width + at] };
                let corner = if n == 0 || at < channels { 0 } else { pixels[(n - 1) * width + at - channels] };
                let paeth = || {
                    let guess = i32::from(left) + i32::from(above) - i32::from(corner);
                    [left, above, corner].into_iter().min_by_key(|c| (guess - i32::from(*c)).abs()).unwrap()
                };
                let mean = ((u16::from(left) + u16::from(above)) / 2) as u8;
                let guess = [0, left, above, mean, paeth()][usize::from(row[0])];
                pixels.push(row[at + 1].wrapping_add(guess));
            }
        }
        pixels
    };
    let of = |channels: std::ops::Range<usize>| {
        pixels.pixels().flat_map(|p| p.0[channels.clone()].to_vec()).collect::<Vec<u8>>()
    };
    assert_eq!(unfiltered(images[1], 1), of(3..4));
    assert_eq!(unfiltered(images[0], 3), of(0..3));
    assert!(images[0].0.contains("/SMask"));
    let opaque = Arc::new(RgbaImage::from_pixel(1, 1, Rgba([9, 9, 9, 255])));
    page.items = vec![Picture::in_rect(opaque, place).nearest().into()];
    let objects = Objects::of(&pdf(&page, "t").unwrap());
    let [(text, _)] = objects.all_with("/Subtype /Image")[..] else { panic!("one image") };
    assert!(!text.contains("/SMask") && text.contains("/Interpolate false"), "{text}");
}

#[test]
fn the_same_page_gives_the_same_bytes_and_says_what_it_is() {
    let page = || {
        let mut page = DisplayList::new(DVec2::splat(28.35));
        page.items
            .push(Text { halo: Some(Halo { width: 1.0, ink: Ink::WHITE }), ..Text::new(DVec2::ONE, "1 cm") }.into());
        page
    };
    let file = pdf(&page(), "Nørdsee <a> & (b").unwrap();
    assert_eq!(file, pdf(&page(), "Nørdsee <a> & (b").unwrap());
    let objects = Objects::of(&file);
    assert!(objects.text(3).contains("/MediaBox [0 0 28.35 28.35]"), "{}", objects.text(3));
    let [(information, _)] = objects.all_with("/Producer")[..] else { panic!("one record") };
    assert!(information.contains(CREATOR) && !information.contains("Date"), "{information}");
}
