//! Lines on the ground: which are left out.

use super::*;

#[test]
fn specks_go_and_lines_in_pieces_stay() {
    let at = |x: f64| DVec2::new(x, 7.25);
    // Ten pieces of four pixels that meet, a single one, and two that meet beside it.
    let chain = (0..10).map(|n| vec![at(4.0 * f64::from(n)), at(4.0 * f64::from(n) + 4.0)]);
    let alone = vec![at(100.0), at(109.0)];
    let pair = [vec![at(200.0), at(205.0)], vec![at(209.0), at(205.0)]];
    let lines: Vec<_> = chain.clone().chain([alone]).chain(pair).collect();
    assert_eq!(without_specks(lines.clone(), 10.0), chain.collect::<Vec<_>>());
    assert_eq!(without_specks(lines.clone(), 0.0), lines);
}

#[test]
fn small_gaps_of_a_trace_are_closed_and_others_stay() {
    let at = |x: f64| DVec2::new(x, 3.0);
    // Pieces that meet, a gap of two pixels, and one of twenty.
    let lines =
        vec![vec![at(0.0), at(5.0)], vec![at(5.1), at(9.0)], vec![at(11.0), at(20.0)], vec![at(40.0), at(50.0)]];
    let closed = bridged(lines.clone(), 4.0);
    assert_eq!(closed.len(), 5);
    let mut bridge: Vec<f64> = closed[4].iter().map(|end| end.x).collect();
    bridge.sort_by(f64::total_cmp);
    assert_eq!(bridge, [9.0, 11.0]);
    assert_eq!(bridged(lines.clone(), 1.0), lines);
}
