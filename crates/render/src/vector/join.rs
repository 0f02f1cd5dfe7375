//! Lines in pieces, joined where they meet.

use glam::DVec2;
use std::collections::HashMap;

/// Ends closer than about this meet, pixels.
const MEETING_PX: f64 = 0.02;

/// Joins lines end to end where exactly two meet; a line that comes back to its beginning repeats it.
pub(super) fn joined(lines: &[Vec<DVec2>]) -> Vec<Vec<DVec2>> {
    let key = |p: DVec2| (p / MEETING_PX).round().as_i64vec2().to_array();
    let mut meeting: HashMap<[i64; 2], Vec<usize>> = HashMap::new();
    for (n, line) in lines.iter().enumerate() {
        for end in [line.first(), line.last()].into_iter().flatten() {
            meeting.entry(key(*end)).or_default().push(n);
        }
    }
    let next = |at: DVec2, from: usize, used: &[bool]| match meeting.get(&key(at)).map(Vec::as_slice) {
        Some([a, b]) => [*a, *b].into_iter().find(|n| *n != from && !used[*n]),
        _ => None,
    };
    let mut used = vec![false; lines.len()];
    let mut joined = Vec::new();
    for n in 0..lines.len() {
        if used[n] || lines[n].is_empty() {
            continue;
        }
        used[n] = true;
        let mut line = lines[n].clone();
        // Onwards from its end, then from its beginning.
        for _ in 0..2 {
            let mut last = n;
            while let Some(end) = line.last().copied()
                && let Some(other) = next(end, last, &used)
            {
                used[other] = true;
                last = other;
                let piece = &lines[other];
                let is_forwards = piece.first().is_some_and(|first| key(*first) == key(end));
                if is_forwards {
                    line.extend(piece.iter().skip(1));
                } else {
                    line.extend(piece.iter().rev().skip(1));
                }
            }
            line.reverse();
        }
        joined.push(line);
    }
    joined
}

#[cfg(test)]
mod tests {
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
}
