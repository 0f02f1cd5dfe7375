//! Pages as SVG, read back and drawn by another program.

use super::*;
use crate::Rect;
use crate::list::{Path, Upright};
use glam::DVec2;
use image::{Rgba, RgbaImage};
use resvg::{tiny_skia, usvg};
use std::sync::Arc;
use ttf::Colour;

fn rect(low: [f64; 2], high: [f64; 2]) -> Rect {
    Rect::new(DVec2::from_array(low), DVec2::from_array(high))
}

/// A page of paths: fills of both rules, strokes, dashes, clips within clips.
fn page() -> DisplayList {
    let mut page = DisplayList::new(DVec2::new(120.0, 90.0));
    let ring = |path: &mut Path, low: f64, high: f64| {
        path.segments.extend(Path::rect(rect([low, low], [high, high])).segments);
    };
    let mut frame = Path::default();
    ring(&mut frame, 10.3, 40.0);
    ring(&mut frame, 18.0, 31.7);
    let frame = PathItem { rule: Rule::EvenOdd, ..PathItem::filled(frame, Colour::new(200, 40, 20)) };
    let circle = PathItem::filled(Path::circle(DVec2::new(70.0, 30.0), 17.5), Ink::glass(Colour::new(0, 80, 160), 0.5));
    let circle = circle.outlined(Stroke::new(2.5, Colour::BLACK).dashed(6.0, 3.0));
    let dots = PathItem::stroked(
        Path::line(&[DVec2::new(5.0, 80.0), DVec2::new(115.0, 60.0)]),
        Stroke::new(3.0, Colour::BLACK).dotted(7.0),
    );
    let square = PathItem::filled(Path::rect(rect([60.0, 50.0], [110.0, 85.0])), Colour::new(40, 160, 90));
    let inner = Group::new(GroupKind::Part, "inner").clipped(Path::circle(DVec2::new(85.0, 67.0), 22.0));
    let outer = Group::new(GroupKind::Layer, "Chalk").clipped(Path::rect(rect([66.0, 40.0], [104.0, 82.0])));
    page.items.push(outer.with([inner.with([square.into()]).into()]).into());
    page.items.extend([frame.into(), circle.into(), dots.into()]);
    page
}

fn drawn(svg: &str, scale: f32) -> RgbaImage {
    let tree = usvg::Tree::from_str(svg, &usvg::Options::default()).unwrap();
    // usvg counts in pixels of 1/96 inch.
    let scale = scale * 0.75;
    let [width, height] = [tree.size().width(), tree.size().height()].map(|side| (side * scale).round() as u32);
    let mut pixels = tiny_skia::Pixmap::new(width, height).unwrap();
    resvg::render(&tree, tiny_skia::Transform::from_scale(scale, scale), &mut pixels.as_mut());
    let straight = pixels.pixels().iter().flat_map(|pixel| {
        let colour = pixel.demultiply();
        [colour.red(), colour.green(), colour.blue(), colour.alpha()]
    });
    RgbaImage::from_raw(width, height, straight.collect()).unwrap()
}

#[test]
fn another_program_draws_the_same_page() {
    let page = page();
    let ours = crate::raster(&page, 288.0).unwrap();
    let theirs = drawn(&svg(&page, "test").unwrap(), 4.0);
    assert_eq!(ours.dimensions(), theirs.dimensions());
    let off = |a: &Rgba<u8>, b: &Rgba<u8>| (0..4).map(|n| a.0[n].abs_diff(b.0[n])).max().unwrap();
    let wrong = ours.pixels().zip(theirs.pixels()).filter(|(a, b)| off(a, b) > 40).count();
    // Edges of paths, whose places are rounded to a hundredth of a point.
    assert!(wrong * 500 < ours.pixels().len(), "{wrong} of {}", ours.pixels().len());
    let inked = ours.pixels().filter(|pixel| pixel.0 != [255; 4]).count();
    assert!(inked * 4 > ours.pixels().len());
}

#[test]
fn a_page_without_paper_is_transparent() {
    let page = DisplayList { paper: None, ..page() };
    let image = drawn(&svg(&page, "test").unwrap(), 1.0);
    assert_eq!(image.get_pixel(1, 1).0[3], 0);
}

#[test]
fn what_draws_nothing_is_left_out() {
    let mut page = DisplayList { paper: None, ..DisplayList::new(DVec2::splat(50.0)) };
    let line = |end: DVec2| Path::line(&[DVec2::ZERO, end]);
    page.items.push(PathItem::stroked(line(DVec2::new(f64::NAN, 1.0)), Stroke::new(1.0, Ink::BLACK)).into());
    page.items.push(PathItem::stroked(line(DVec2::ONE), Stroke::new(0.0, Ink::BLACK)).into());
    page.items.push(Text::new(DVec2::ZERO, " ").into());
    page.items.push(Group::new(GroupKind::Layer, "empty").into());
    assert!(svg(&page, "t").unwrap().ends_with("<title>t</title>\n</svg>\n"));
    page.items.push(PathItem::stroked(line(DVec2::ONE), Stroke::new(1.0, Ink::BLACK)).into());
    assert!(svg(&page, "t").unwrap().contains("<path"));
}

#[test]
fn names_are_labels_as_they_are_and_identifiers_once() {
    let mut page = DisplayList::new(DVec2::splat(50.0));
    for name in ["Top <Chalk> & \"co\"", "top chalk co", "白垩", "الطباشير"] {
        let mut group = Group::new(GroupKind::Horizon, name);
        group.push(PathItem::filled(Path::rect(page.bounds()), Colour::BLACK));
        page.items.push(group.into());
    }
    let svg = svg(&page, "a <b> & c").unwrap();
    let document = usvg::roxmltree::Document::parse(&svg).unwrap();
    let groups: Vec<_> = document.descendants().filter(|node| node.has_tag_name("g")).collect();
    let label = |node: &usvg::roxmltree::Node| {
        node.attribute(("http://www.inkscape.org/namespaces/inkscape", "label")).unwrap().to_owned()
    };
    assert_eq!(label(&groups[0]), "Top <Chalk> & \"co\"");
    let ids: Vec<&str> = groups.iter().map(|node| node.attribute("id").unwrap()).collect();
    assert_eq!(ids, ["horizon-top-chalk-co", "horizon-top-chalk-co-2", "horizon-白垩", "horizon-الطباشير"]);
    let title = document.descendants().find(|node| node.has_tag_name("title")).unwrap();
    assert_eq!(title.text(), Some("a <b> & c"));
}

#[test]
fn text_stays_text() {
    let mut page = DisplayList::new(DVec2::splat(50.0));
    let line = Text::new(DVec2::new(25.0, 25.0), "A < B & \u{7}C").sized(8.0);
    page.items.push(line.clone().anchored(crate::list::Across::End, Upright::Baseline).turned(-90.0).into());
    let svg = svg(&page, "t").unwrap();
    let document = usvg::roxmltree::Document::parse(&svg).unwrap();
    let text = document.descendants().find(|node| node.has_tag_name("text")).unwrap();
    assert_eq!(text.text(), Some("A < B & C"));
    assert_eq!(text.attribute("transform"), Some("rotate(-90 25 25)"));
    let x: f64 = text.attribute("x").unwrap().parse().unwrap();
    assert!((x - (25.0 - line.width())).abs() < 0.006);
}

/// Programs that place the first letter alone set a bent line straight along its chord.
#[test]
fn a_bent_line_is_turned_as_a_whole_and_its_letters_about_that() {
    let mut page = DisplayList::new(DVec2::splat(100.0));
    let slope = [DVec2::new(10.0, 20.0), DVec2::new(80.0, 90.0)];
    page.items.push(Text::new(DVec2::ZERO, "Marl").along(&slope, 40.0).into());
    let svg = svg(&page, "t").unwrap();
    let document = usvg::roxmltree::Document::parse(&svg).unwrap();
    let text = document.descendants().find(|node| node.has_tag_name("text")).unwrap();
    assert!(text.attribute("transform").unwrap().starts_with("rotate(45 "));
    assert_eq!(text.attribute("rotate"), Some("0 0 0 0"));
    let ys: Vec<&str> = text.attribute("y").unwrap().split(' ').collect();
    assert!(ys.iter().all(|y| *y == ys[0]), "{ys:?}");
}

#[test]
fn letters_come_with_the_page() {
    let mut page = DisplayList::new(DVec2::splat(50.0));
    assert!(!svg(&page, "t").unwrap().contains("@font-face"));
    page.items.push(Text::new(DVec2::splat(20.0), "Chalk").into());
    let svg = svg(&page, "t").unwrap();
    let document = usvg::roxmltree::Document::parse(&svg).unwrap();
    let style = document.descendants().find(|node| node.has_tag_name("style")).unwrap().text().unwrap();
    let file = style.split("base64,").nth(1).unwrap().split('\'').next().unwrap();
    // A TrueType font with the box and five letters: version 1.0, ten tables.
    assert!(file.starts_with(&STANDARD.encode([0, 1, 0, 0, 0, 10])) && file.len() < 6000, "{}", file.len());
}

#[test]
fn a_picture_is_written_once_and_laid_on_its_corners() {
    let mut page = DisplayList::new(DVec2::splat(50.0));
    let pixels = Arc::new(RgbaImage::new(3, 3));
    for _ in 0..3 {
        page.items.push(Picture::in_rect(Arc::clone(&pixels), page.bounds()).into());
    }
    let svg = svg(&page, "t").unwrap();
    assert_eq!((svg.matches("<image").count(), svg.matches("<use").count()), (1, 3));
    // A square of one unit over the whole page.
    assert!(svg.contains(r#"transform="matrix(50.0000 0.0000 0.0000 50.0000 0.0000 0.0000)""#), "{svg}");
}
