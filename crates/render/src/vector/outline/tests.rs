//! Polygons that are cut by one another.

use super::*;

fn ring(points: &[[f64; 2]]) -> Vec<DVec2> {
    points.iter().copied().map(DVec2::from_array).collect()
}

fn line(points: &[[f64; 2]]) -> Polyline {
    Polyline { points: ring(points), closed: false }
}

/// A square with a square hole.
fn frame() -> Vec<Vec<DVec2>> {
    vec![
        ring(&[[0.0, 0.0], [90.0, 0.0], [90.0, 90.0], [0.0, 90.0]]),
        ring(&[[30.0, 30.0], [30.0, 60.0], [60.0, 60.0], [60.0, 30.0]]),
    ]
}

#[test]
fn a_line_is_parted_at_the_outline_and_around_holes() {
    let rings = frame();
    let outline = Outline::new(&rings);
    let cut = |line: Polyline| {
        let parts = outline.cut_line(line);
        parts
            .iter()
            .map(|part| [part.points[0], part.points[part.points.len() - 1]])
            // Rounding aside.
            .map(|ends| ends.map(|end| (end * 1e9).round().to_array().map(|number| number / 1e9)))
            .collect::<Vec<_>>()
    };
    assert_eq!(cut(line(&[[-10.0, 45.0], [100.0, 45.0]])), [[[0.0, 45.0], [30.0, 45.0]], [[60.0, 45.0], [90.0, 45.0]]]);
    assert_eq!(cut(line(&[[5.0, 5.0], [20.0, 9.0]])), [[[5.0, 5.0], [20.0, 9.0]]]);
    assert!(cut(line(&[[35.0, 35.0], [50.0, 50.0]])).is_empty() && cut(line(&[[95.0, 1.0], [99.0, 80.0]])).is_empty());
    // A closed line that leaves and comes back is one open line that goes on over its beginning.
    let square = Polyline { points: ring(&[[80.0, 10.0], [80.0, 20.0], [100.0, 20.0], [100.0, 10.0]]), closed: true };
    let parts = outline.cut_line(square);
    assert_eq!(parts.len(), 1);
    assert_eq!(parts[0].points, ring(&[[90.0, 10.0], [80.0, 10.0], [80.0, 20.0], [90.0, 20.0]]));
    assert!(!parts[0].closed);
}

/// A line that enters through any side, of squares whose heights are and are not whole rows.
#[test]
fn a_line_that_comes_from_outside_is_kept_from_where_it_enters() {
    for high in [90.0, 92.0, 93.7, 3.0, 100.0 / 3.0] {
        let rings = vec![ring(&[[0.0, 0.0], [90.0, 0.0], [90.0, high], [0.0, high]])];
        let outline = Outline::new(&rings);
        let middle = [45.0, 0.5 * high];
        for (from, enters) in [
            ([45.0, high + 7.0], [45.0, high]),
            ([45.0, -7.0], [45.0, 0.0]),
            ([-7.0, 0.5 * high], [0.0, 0.5 * high]),
            ([97.0, 0.5 * high], [90.0, 0.5 * high]),
        ] {
            let parts = outline.cut_line(line(&[from, middle]));
            assert_eq!(parts.len(), 1, "from {from:?} into a height of {high}");
            assert!(parts[0].points[0].distance(DVec2::from_array(enters)) < 1e-9);
        }
    }
}

/// The area of what is left is known.
#[test]
fn an_area_keeps_its_part_within_whichever_way_it_turns() {
    let rings = frame();
    let outline = Outline::new(&rings);
    // A square over the hole's corner, and an L over the outer corner, both ways round.
    let square = ring(&[[50.0, 50.0], [70.0, 50.0], [70.0, 70.0], [50.0, 70.0]]);
    let ell = ring(&[[80.0, 80.0], [100.0, 80.0], [100.0, 85.0], [85.0, 85.0], [85.0, 100.0], [80.0, 100.0]]);
    for (shape, left) in [(square, 300.0), (ell, 75.0)] {
        for is_reversed in [false, true] {
            let mut points = shape.clone();
            if is_reversed {
                points.reverse();
            }
            let kept = outline.cut_area(Polyline { points: points.clone(), closed: true });
            let sum: f64 = kept.iter().map(|part| twice_area(&part.points)).sum();
            assert!((sum - 2.0 * left * twice_area(&points).signum()).abs() < 1e-9, "{sum} of {left}");
        }
    }
    let inside = Polyline { points: ring(&[[5.0, 5.0], [9.0, 5.0], [9.0, 9.0]]), closed: true };
    assert_eq!(outline.cut_area(inside.clone()), [inside]);
    let beside = Polyline { points: ring(&[[40.0, 40.0], [44.0, 40.0], [44.0, 44.0]]), closed: true };
    assert!(outline.cut_area(beside).is_empty());
}
