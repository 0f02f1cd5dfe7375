//! Lines that meet become one.

use super::*;

fn at(points: &[[f64; 2]]) -> Vec<DVec2> {
    points.iter().map(|p| DVec2::from_array(*p)).collect()
}

#[test]
fn pieces_become_one_line_in_either_direction() {
    let pieces = vec![at(&[[1.0, 0.0], [2.0, 0.0]]), at(&[[1.0, 0.0], [0.0, 0.0]]), at(&[[3.0, 1.0], [2.0, 0.0]])];
    assert_eq!(joined(&pieces), [at(&[[0.0, 0.0], [1.0, 0.0], [2.0, 0.0], [3.0, 1.0]])]);
}

#[test]
fn a_ring_closes_and_a_fork_stays_open() {
    let ring = vec![at(&[[0.0, 0.0], [1.0, 0.0]]), at(&[[1.0, 0.0], [1.0, 1.0]]), at(&[[1.0, 1.0], [0.0, 0.0]])];
    let ring = joined(&ring);
    assert_eq!((ring.len(), ring[0].len()), (1, 4));
    assert_eq!(ring[0].first(), ring[0].last());
    let fork = vec![at(&[[0.0, 0.0], [1.0, 0.0]]), at(&[[1.0, 0.0], [2.0, 1.0]]), at(&[[1.0, 0.0], [2.0, -1.0]])];
    assert_eq!(joined(&fork), fork);
}
