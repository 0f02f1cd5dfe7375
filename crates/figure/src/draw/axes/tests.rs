//! Numbers along axes: at their values, none twice, none outside the room.

use super::*;

fn axis(ends: [f64; 2]) -> Axis {
    Axis { name: "inline".into(), ends, at: [100.0, 300.0], least_step: 1.0 }
}

#[test]
fn numbers_stand_at_their_values_also_where_lines_count_down() {
    for ends in [[1000.0, 1160.0], [1160.0, 1000.0]] {
        let ticks = axis(ends).ticks([100.0, 300.0], 44.0);
        assert!(ticks.len() >= 3, "{ticks:?}");
        for tick in &ticks {
            let value: f64 = tick.text.parse().unwrap();
            let share = (value - ends[0]) / (ends[1] - ends[0]);
            assert!((tick.at - (100.0 + 200.0 * share)).abs() < 1e-9);
        }
    }
}

#[test]
fn only_what_is_seen_has_numbers_and_a_single_line_has_none_twice() {
    let seen = axis([0.0, 200.0]).ticks([150.0, 200.0], 10.0);
    assert!(seen.iter().all(|tick| (150.0..=200.0).contains(&tick.at)) && !seen.is_empty());
    assert!(axis([7.0, 7.0]).ticks([100.0, 300.0], 44.0).is_empty());
    let few = axis([1.0, 3.0]).ticks([100.0, 300.0], 10.0);
    assert_eq!(few.iter().map(|tick| tick.text.as_str()).collect::<Vec<_>>(), ["1", "2", "3"]);
}

#[test]
fn no_number_leaves_the_room() {
    let whole = Rect::new(DVec2::new(60.0, 10.0), DVec2::new(303.0, 210.0));
    let body = Rect::new(DVec2::new(100.0, 40.0), DVec2::new(300.0, 200.0));
    let down = Axis { name: "Two-way time (ms)".into(), ends: [0.0, 2000.0], at: [40.0, 200.0], least_step: 0.0 };
    let group = drawn(whole, body, [&axis([0.0, 2000.0]), &down]);
    for item in &group.items {
        if let page::list::Item::Text(text) = item {
            let bounds = text.bounds();
            assert!(bounds.min.x >= whole.min.x - 0.01 && bounds.max.x <= whole.max.x + 0.01, "{text:?}");
        }
    }
}
