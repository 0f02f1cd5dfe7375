//! Dashes along a line.

use super::*;

#[test]
fn dashes_follow_the_line_around_its_corners() {
    let corner = [DVec2::ZERO, DVec2::new(5.0, 0.0), DVec2::new(5.0, 5.0)];
    let dashes = dashed(&corner, [4.0, 2.0]);
    assert_eq!(dashes.len(), 2);
    assert_eq!(dashes[0], [DVec2::ZERO, DVec2::new(4.0, 0.0)]);
    assert_eq!(dashes[1], [DVec2::new(5.0, 1.0), DVec2::new(5.0, 5.0)]);
    let length: f64 = dashed(&corner, [1.0, 1.5]).iter().map(|dash| dash[0].distance(dash[dash.len() - 1])).sum();
    assert!((length - 4.0).abs() < 1e-9, "{length}");
    assert!(dashed(&[], [1.0, 1.0]).is_empty());
}
