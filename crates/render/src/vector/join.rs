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
mod tests;
