//! Legends of any length.

use super::*;
use page::list::Item;
use ttf::Colour;

fn texts(group: &Group, into: &mut Vec<Text>) {
    for item in &group.items {
        match item {
            Item::Text(text) => into.push(text.clone()),
            Item::Group(group) => texts(group, into),
            _ => {}
        }
    }
}

#[test]
fn names_stay_in_the_room_and_apart_and_large_enough_however_many_there_are() {
    let library = TextureLibrary::builtin().unwrap();
    for (count, height) in [(1, 200.0), (5, 200.0), (60, 200.0), (60, 330.0), (1000, 300.0)] {
        let style = |n: usize| {
            let name = if n == 0 { "Top".to_owned() } else { format!("layer {n} of a long and winding name") };
            LayerStyle::plain(&name, Colour::WHITE)
        };
        let styles: Vec<LayerStyle> = (0..count).map(style).collect();
        let lines = [LegendLine::new("Fault", GroupKind::Fault, Stroke::new(1.0, INK))];
        let legend = Legend { layers: Some((&styles, &library)), horizons: &[], lines: &lines, dpi: 100.0 };
        let page = DVec2::new(480.0, height);
        let width = legend.width(page, 170.0);
        let room = Rect::sized(DVec2::new(480.0 - width, 10.0), DVec2::new(width, height));
        let mut found = Vec::new();
        texts(&legend.drawn(room).unwrap(), &mut found);
        match found.last().unwrap().text.strip_prefix("and ") {
            // What has no room is counted.
            Some(more) => {
                let more: usize = more.strip_suffix(" more").unwrap().parse().unwrap();
                assert!(found.len() - 1 + more == count + 1 && found.len() > 25, "{} and {more}", found.len());
            }
            None => assert_eq!(found.len(), count + 1),
        }
        assert!(count < 1000 || found.len() < count);
        for (n, text) in found.iter().enumerate() {
            assert!(text.size >= LEAST_TEXT_PT && text.size == found[0].size, "{} of {count}", text.size);
            let bounds = text.bounds();
            assert!(bounds.max.x <= room.max.x + 0.1 && bounds.max.y <= room.max.y + 2.0, "{count}: {bounds:?}");
            let inner = |text: &Text| text.outline().bounds().unwrap();
            assert!(found[..n].iter().all(|other| !inner(other).meets(&inner(text))), "{count}: {}", text.text);
        }
    }
}

#[test]
fn across_a_page_all_entries_stand_in_columns_of_like_height() {
    let lines: Vec<LegendLine> = (0..7)
        .map(|n| LegendLine::new(&format!("Fault {n} (named)"), GroupKind::Fault, Stroke::new(1.0, INK)))
        .collect();
    let legend = Legend { layers: None, horizons: &[], lines: &lines, dpi: 100.0 };
    let own = legend.column(TEXT_PT) + COLUMN_GAP_PT;
    // Seven lines in three columns are three lines high, and in one column seven.
    assert_eq!(legend.across(3.0 * own), (3, 3.0 * PITCH_PT[1]));
    let (columns, height) = legend.across(3.0 * own);
    let drawn = legend.drawn_across(Rect::sized(DVec2::ZERO, DVec2::new(3.0 * own, height)), columns).unwrap();
    assert_eq!(drawn.items.len(), 7);
    // Two columns fit where letters are small and brackets go; one alone where there is no room.
    assert_eq!(legend.across(1.8 * own).0, 2);
    assert_eq!(legend.across(0.5 * own), (1, 7.0 * PITCH_PT[1]));
}
