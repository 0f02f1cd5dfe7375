//! Scale bars across and upright.

use super::*;

#[test]
fn bars_have_round_lengths() {
    for (longest, said) in [(1.0, 1.0), (1.99, 1.0), (4.9, 2.0), (7.0, 5.0), (1234.0, 1000.0), (0.3, 0.2)] {
        assert!((round_length(longest) - said).abs() < 1e-9, "{longest}");
    }
    assert_eq!([length_text(500.0), length_text(2000.0)], ["500 m", "2 km"]);
}

#[test]
fn a_bar_is_as_long_on_paper_as_it_says() {
    let strip = Rect::sized(DVec2::ZERO, DVec2::new(400.0, STRIP_PT));
    let group = drawn(strip, Some(0.1), None, "");
    let page::list::Item::Path(bar) = &group.items[0] else { panic!("no bar") };
    // 120 points are 1200 m: 1 km is 100 points.
    assert!((bar.path.bounds().unwrap().width() - 100.0).abs() < 1e-9);
    let texts: Vec<_> = group.items.iter().filter(|item| matches!(item, page::list::Item::Text(_))).collect();
    assert_eq!(texts.len(), 2);
    // Of 21 points, 20 are 200 ms at a tenth of a point each.
    let both = drawn(strip, Some(0.1), Some((0.1, "ms")), "vertical exaggeration 2");
    let bars: Vec<Rect> = both
        .items
        .iter()
        .filter_map(|item| match item {
            page::list::Item::Path(bar) => bar.path.bounds(),
            _ => None,
        })
        .collect();
    assert!(bars.len() == 4 && (bars[2].height() - 20.0).abs() < 1e-9 && strip.contains(bars[2].max));
    let said =
        |text: &str| both.items.iter().any(|item| matches!(item, page::list::Item::Text(own) if own.text == text));
    assert!(said("200 ms") && said("1 km"));
    // Seen from straight above a block has no height.
    assert_eq!(drawn(strip, Some(0.1), Some((0.0, "m")), "").items.len(), group.items.len());
}

#[test]
fn the_caption_says_what_time_was_turned_into_depth_with() {
    let geometry = SurveyGeometry::regular([9, 9, 9], 25.0, 4.0, VerticalUnit::Milliseconds);
    let scene = Scene { exaggeration: 2.5, ..Scene::default() };
    assert_eq!(block_caption(&scene, &geometry), "vertical exaggeration 2.5 at 2000 m/s");
}

#[test]
fn a_caption_without_room_is_abbreviated_and_then_left_out() {
    let said = |width: f64| {
        let strip = Rect::sized(DVec2::ZERO, DVec2::new(width, STRIP_PT));
        let group = drawn(strip, None, None, "vertical exaggeration 2.5");
        group.items.into_iter().find_map(|item| match item {
            page::list::Item::Text(text) => Some(text.text),
            _ => None,
        })
    };
    assert_eq!(said(200.0).as_deref(), Some("vertical exaggeration 2.5"));
    assert_eq!(said(40.0).as_deref(), Some("V.E. 2.5"));
    assert_eq!(said(4.0), None);
}

#[test]
fn a_long_caption_takes_two_lines_within_its_strip() {
    let caption = "vertical exaggeration 2.5 at 2000 m/s; lengths hold in the middle of the block";
    let strip = Rect::sized(DVec2::new(10.0, 50.0), DVec2::new(180.0, STRIP_PT));
    let group = drawn(strip, None, None, caption);
    let texts: Vec<&Text> = group
        .items
        .iter()
        .filter_map(|item| match item {
            page::list::Item::Text(text) => Some(text),
            _ => None,
        })
        .collect();
    assert_eq!(texts.len(), 2);
    let said: Vec<&str> = texts.iter().map(|text| text.text.as_str()).collect();
    assert_eq!(said.join(" "), caption.replace("vertical exaggeration", "V.E."));
    assert!(texts[0].bounds().max.y <= texts[1].bounds().min.y + 0.5);
    assert!(texts.iter().all(|text| strip.contains(text.bounds().min) && strip.contains(text.bounds().max)));
}
