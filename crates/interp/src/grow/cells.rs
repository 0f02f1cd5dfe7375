//! From links to labelled surfaces: closed cells, the opening of the least width, connected windows.
//!
//! A cell is closed when going x then y arrives where y then x does. With w the least front width, a *window* is a block of
//! (w − 1)² closed cells, i.e. w × w traces; the union of all windows is the morphological opening of the surface by that
//! width. Two windows shifted by one trace are connected: so a neck narrower than w traces does not connect, as in the paper a border
//! narrower than w ends. Components are numbered by their first window. A vertex belongs to the component with the most windows
//! among those that cover it (ties: the first).

use super::links::{BACK_X, BACK_Y, Links, NEXT_X, NEXT_Y, NONE};
use super::union_find::UnionFind;
use crate::extrema::Extrema;
use rayon::prelude::*;

/// Extrema handled at a time by one thread.
const GRAIN: usize = 1 << 14;

/// The component of each extremum (the index of its first window), or [`NONE`].
pub(super) fn label(extrema: &Extrema, links: &Links, broken: &[[bool; 2]], min_front_width: usize) -> Vec<u32> {
    let cells = min_front_width - 1;
    let windows = windows(extrema.len(), links, broken, cells);
    let mut sets = UnionFind::new(extrema.len());
    for v in 0..extrema.len() as u32 {
        if !windows[v as usize] {
            continue;
        }
        for direction in [NEXT_X, NEXT_Y] {
            let next = links.to[direction][v as usize];
            if next != NONE && windows[next as usize] {
                sets.union(v, next);
            }
        }
    }
    let mut label = vec![NONE; extrema.len()];
    let mut count = vec![0u32; extrema.len()];
    for v in 0..extrema.len() as u32 {
        if windows[v as usize] {
            let set = sets.find(v);
            label[v as usize] = set;
            count[set as usize] += 1;
        }
    }
    // Each round carries labels one trace along x and y.
    for _ in 0..cells {
        label = carried(&label, &count, links);
    }
    label
}

/// Whether the cell that begins at `a` is closed and none of its four links is broken.
fn is_open(links: &Links, broken: &[[bool; 2]], a: u32) -> bool {
    links.closed(a).is_some_and(|[a, b, c, _]| {
        !(broken[a as usize][0] || broken[a as usize][1] || broken[b as usize][1] || broken[c as usize][0])
    })
}

/// Whether each extremum is the first corner of a complete window.
fn windows(count: usize, links: &Links, broken: &[[bool; 2]], cells: usize) -> Vec<bool> {
    let mut complete: Vec<bool> =
        (0..count as u32).into_par_iter().with_min_len(GRAIN).map(|v| is_open(links, broken, v)).collect();
    for _ in 1..cells {
        let smaller = complete;
        complete = (0..count as u32)
            .into_par_iter()
            .with_min_len(GRAIN)
            .map(|v| {
                smaller[v as usize]
                    && links.closed(v).is_some_and(|cell| cell[1..].iter().all(|&c| smaller[c as usize]))
            })
            .collect();
    }
    complete
}

/// The best label among a vertex and those behind it in x, y and both.
fn carried(label: &[u32], count: &[u32], links: &Links) -> Vec<u32> {
    let better = |a: u32, b: u32| {
        if a == NONE || b == NONE {
            return a.min(b);
        }
        let windows = |label: u32| (count[label as usize], std::cmp::Reverse(label));
        if windows(b) > windows(a) { b } else { a }
    };
    let of = |v: u32| if v == NONE { NONE } else { label[v as usize] };
    let back = |direction: usize, v: u32| if v == NONE { NONE } else { links.to[direction][v as usize] };
    (0..label.len() as u32)
        .into_par_iter()
        .with_min_len(GRAIN)
        .map(|v| {
            let (x, y) = (back(BACK_X, v), back(BACK_Y, v));
            let both = back(BACK_Y, x);
            let both = if both != NONE && both == back(BACK_X, y) { both } else { NONE };
            better(better(of(v), of(x)), better(of(y), of(both)))
        })
        .collect()
}
