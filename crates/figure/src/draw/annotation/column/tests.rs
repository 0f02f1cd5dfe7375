//! Names in a column: in order, apart, and as near as they can be to what they name.

use super::*;
use page::Rect;

#[test]
fn places_move_apart_around_their_mean_and_stay_where_they_are_free() {
    assert_eq!(apart(&[10.0, 30.0, 60.0], 10.0, [0.0, 100.0]), [10.0, 30.0, 60.0]);
    // Three that want one place stand around it; the fourth is far enough away.
    assert_eq!(apart(&[50.0, 50.0, 50.0, 80.0], 10.0, [0.0, 100.0]), [40.0, 50.0, 60.0, 80.0]);
    // Bounds hold.
    assert_eq!(apart(&[0.0, 0.0, 0.0], 10.0, [5.0, 100.0]), [5.0, 15.0, 25.0]);
    assert_eq!(apart(&[99.0, 99.0], 10.0, [0.0, 95.0]), [85.0, 95.0]);
}

#[test]
fn a_thousand_layers_have_as_many_names_as_there_is_room_for_and_no_leaders_cross() {
    let end = |n: usize, count: usize| LayerEnd {
        at: DVec2::new(100.0, 40.0 + 120.0 * n as f64 / count as f64),
        thick: if n % 7 == 3 { 2.0 } else { 1.0 },
        name: format!("Layer {n}"),
    };
    for (count, expected) in [(6, 6..=6), (1000, 15..=21)] {
        let mut room = LabelRoom::new(Rect::sized(DVec2::ZERO, DVec2::new(200.0, 200.0)));
        let groups = placed((0..count).map(|n| end(n, count)).collect(), 105.0, &mut room);
        assert!(expected.contains(&groups.len()), "{} of {count}", groups.len());
        let texts: Vec<Text> = groups.iter().filter_map(named).collect();
        assert_eq!(texts.len(), groups.len());
        for pair in texts.windows(2) {
            assert!(pair[1].at.y - pair[0].at.y > LEAST_TEXT_PT, "names in order and apart");
            let number = |text: &Text| text.text.rsplit(' ').next().unwrap().parse::<usize>().unwrap();
            assert!(number(&pair[0]) < number(&pair[1]));
        }
        assert!(texts.iter().all(|text| text.bounds().min.x > 105.0 && text.bounds().max.y < 200.0));
        if count > 100 {
            assert!(texts.iter().all(|text| text.text.rsplit(' ').next().unwrap().parse::<usize>().unwrap() % 7 == 3));
        }
    }
}

#[test]
fn names_without_room_are_left_out() {
    let ends = vec![LayerEnd { at: DVec2::new(100.0, 50.0), thick: 2.0, name: "A very long name".into() }];
    let mut room = LabelRoom::new(Rect::sized(DVec2::ZERO, DVec2::new(130.0, 200.0)));
    assert!(placed(ends, 105.0, &mut room).is_empty());
}

fn named(group: &Group) -> Option<Text> {
    group.items.iter().find_map(|item| match item {
        page::list::Item::Text(text) => Some(text.clone()),
        _ => None,
    })
}
